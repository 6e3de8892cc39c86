//! Stiff problems, long runs of conservative ones, and contacts.

use std::f64::consts::PI;

use mbg_runtime::{
    Adaptive, Dop853, Estimating, Fixed, Gauss6, ImplicitMidpoint, Integrator, Method, Radau5,
    Radau9, Real, Rodas4, Rodas5P, Ros2, Statistics, Step, System, Tsit5, Variable,
};
use nalgebra::SVector;

use crate::errors::{apart, larger};
use crate::problems::{Law, RigidBody, Robertson, StiffPin, VanDerPol, Written, state};

pub(crate) fn end<L, D, const N: usize>(
    law: L,
    solver: D,
    end: f64,
    start: SVector<f64, N>,
) -> (SVector<f64, N>, Statistics)
where
    L: Law<N, 0> + Copy,
    D: Integrator<N>,
{
    let mut last = start;
    let statistics = solver
        .integrate(&Written(law), &(), 0.0, end, start, |step| {
            last = *step.state()
        })
        .unwrap();
    (last, statistics)
}

fn pin_error<S: Estimating>(method: S, tolerance: f64, pin: usize) -> f64 {
    let (law, expected) = StiffPin::AFTER_5_S[pin];
    let nominal = law.nominal();
    let solver = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(method, tolerance, tolerance)
    };
    let (x, statistics) = end(law, solver, 5.0, StiffPin::level());
    let error = apart(&[x[2], x[5]], &expected);
    println!(
        "{:<12}k = {:e}, {tolerance:e}: error {error:.1e}, {statistics:?}",
        S::NAME,
        law.stiffness
    );
    error
}

#[test]
fn stiff_pins_at_a_tolerance() {
    for pin in [0, 1] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            assert!(pin_error(Radau5, tolerance, pin) < 20.0 * tolerance);
            assert!(pin_error(Radau9, tolerance, pin) < tolerance);
        }
        assert!(pin_error(Rodas5P, 1e-6, pin) < 1e-5);
        assert!(pin_error(Rodas4, 1e-5, pin) < 1e-4);
    }
}

#[test]
fn stiff_pins_at_a_fixed_step() {
    fn error<S: Method>(method: S, step: f64, pin: usize) -> f64 {
        let (law, expected) = StiffPin::AFTER_5_S[pin];
        let (x, _) = end(law, Fixed::new(method, step), 5.0, StiffPin::level());
        let error = apart(&[x[2], x[5]], &expected);
        println!(
            "{:<20}k = {:e}, h = {step}: error {error:.1e}",
            S::NAME,
            law.stiffness
        );
        error
    }
    for pin in [0, 1] {
        assert!(error(Ros2, 1e-3, pin) < 1e-3);
        assert!(error(ImplicitMidpoint::default(), 1e-3, pin) < 1e-4);
        assert!(error(Rodas4, 1e-3, pin) < 1e-5);
        assert!(error(Rodas5P, 1e-3, pin) < 1e-6);
        assert!(error(Radau5, 1e-3, pin) < 1e-6);
        // Stable at a step a hundred thousand times that of the fastest mode.
        assert!(error(Ros2, 1e-2, pin) < 0.1);
        assert!(error(ImplicitMidpoint::default(), 1e-2, pin) < 1e-2);
    }
}

/// In single precision, k = 1e8: stable at 10 ms, error at most 1e-4 at 1 ms after 2 s.
#[test]
fn a_stiff_pin_in_single_precision() {
    fn last<T: mbg_runtime::Real, S: Method>(method: S, step: f64) -> f64
    where
        Written<StiffPin>: System<T, 6, 0, 0>,
    {
        let law = StiffPin {
            stiffness: 1e8,
            damping: 1e3,
        };
        let number = T::from_f64;
        let mut last = StiffPin::level().map(number);
        Fixed::new(method, step)
            .compensated()
            .integrate(&Written(law), &(), number(0.0), number(2.0), last, |step| {
                last = *step.state()
            })
            .unwrap();
        last[2].find(|_| true).unwrap()
    }
    let reference = last::<f64, _>(Radau5, 1e-4);
    let ros2 = [1e-2, 1e-3].map(|step| (last::<f32, _>(Ros2, step) - reference).abs());
    let midpoint = [1e-2, 1e-3]
        .map(|step| (last::<f32, _>(ImplicitMidpoint { sweeps: 2 }, step) - reference).abs());
    println!("ROS2 {ros2:?}, implicit midpoint {midpoint:?}");
    assert!(ros2[0] < 0.05 && ros2[1] < 1e-4, "{ros2:?}");
    assert!(midpoint[0] < 1e-2 && midpoint[1] < 1e-4, "{midpoint:?}");
}

#[test]
fn van_der_pol() {
    fn error<S: Estimating>(method: S, tolerance: f64) -> f64 {
        let solver = Adaptive::new(method, tolerance, tolerance);
        let (x, statistics) = end(VanDerPol, solver, 2.0, SVector::from([2.0, 0.0]));
        let error = apart(x.as_slice(), &VanDerPol::AFTER_2_S);
        println!(
            "{:<12}{tolerance:e}: error {error:.1e}, {statistics:?}",
            S::NAME
        );
        error
    }
    for tolerance in [1e-4, 1e-6, 1e-8] {
        assert!(error(Radau5, tolerance) < 100.0 * tolerance);
        assert!(error(Radau9, tolerance) < tolerance);
        assert!(error(Rodas5P, tolerance) < 100.0 * tolerance);
        assert!(error(Rodas4, tolerance) < 100.0 * tolerance);
    }
}

/// Two families agree over eleven decades of time, and with the published value at 1e11.
#[test]
fn robertson() {
    fn found<S: Estimating>(method: S, tolerance: f64, time: f64) -> SVector<f64, 3> {
        let solver = Adaptive {
            nominal: &[1.0, 1e-6, 1.0],
            ..Adaptive::new(method, tolerance, tolerance * 1e-6)
        };
        let (x, statistics) = end(Robertson, solver, time, SVector::from([1.0, 0.0, 0.0]));
        println!(
            "{:<12}{tolerance:e}, t = {time:e}: {x:?} {statistics:?}",
            S::NAME
        );
        x
    }
    let published = SVector::from([
        0.208_334_014_970_122e-7,
        0.833_336_077_033_471_3e-13,
        0.999_999_979_166_505,
    ]);
    let apart = |a: SVector<f64, 3>, b: SVector<f64, 3>| {
        (0..3).fold(0.0, |apart: f64, row| {
            larger(apart, (a[row] / b[row] - 1.0).abs())
        })
    };
    assert!(apart(found(Radau5, 1e-8, 1e11), published) < 1e-5);
    assert!(apart(found(Radau9, 1e-8, 1e11), published) < 1e-5);
    assert!(apart(found(Rodas5P, 1e-8, 1e11), published) < 1e-5);
    let reference = found(Radau5, 1e-10, 1e5);
    assert!(apart(found(Rodas5P, 1e-9, 1e5), reference) < 1e-7);
    assert!(apart(found(Rodas4, 1e-7, 1e5), reference) < 1e-5);
}

/// The first steps are 1e-14 and less of a long run: times near zero are told apart in any precision.
#[test]
fn robertson_begins_a_long_run_in_single_precision() {
    let nominal = [1.0, 1e-5, 1.0];
    let start = SVector::from([1.0, 0.0, 0.0]);
    let tight = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(Radau9, 1e-9, 1e-12)
    };
    let (expected, _) = end(Robertson, tight, 1e9, start);
    let solver = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(Ros2, 1e-5, 1e-6)
    };
    let (mut last, start) = (SVector::from([0.0_f32; 3]), start.map(|it| it as f32));
    let note = |step: &mut Step<'_, f32, 3>| last = *step.state();
    let run = solver.integrate(&Written(Robertson), &(), 0.0, 1e9, start, note);
    println!("{run:?} {last} {expected}");
    assert!(run.is_ok(), "{run:?}");
    assert!(
        (last.map(f64::from) - expected).amax() < 1e-6,
        "{last} {expected}"
    );
}

/// 100 000 steps near the middle axis: energy, momentum and the norm of the quaternion stay.
#[test]
fn a_rigid_body_keeps_its_invariants_for_a_thousand_seconds() {
    let law = RigidBody;
    let start = SVector::from([1e-4, 10.0, 6e-4, 1.0, 0.0, 0.0, 0.0]);
    let [energy, momentum] = RigidBody::invariants(&start);
    let drift = |solver: Fixed<Gauss6>| {
        let (x, _) = end(law, solver, 1000.0, start);
        let [last, norm] = RigidBody::invariants(&x);
        let quaternion = x.fixed_rows::<4>(3).norm();
        let drift = [last / energy - 1.0, norm / momentum - 1.0, quaternion - 1.0].map(f64::abs);
        println!("{solver:?}: {drift:?}");
        drift
    };
    let exact = drift(Fixed::new(Gauss6::default(), 0.01).compensated());
    assert!(exact.iter().all(|drift| *drift < 1e-14), "{exact:?}");
    let swept = drift(Fixed::new(Gauss6 { sweeps: Some(3) }, 0.01).compensated());
    assert!(swept.iter().all(|drift| *drift < 1e-9), "{swept:?}");
}

/// Van der Pol's equation with so much damping; with none, a spring.
#[derive(Clone, Copy)]
struct Relaxation(f64);

impl Law<2, 0> for Relaxation {
    const STATES: &'static [Variable] = &[state("displacement"), state("rate")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let damping = T::from_f64(self.0) * (T::from_f64(1.0) - x[0] * x[0]);
        SVector::from([x[1], damping * x[1] - x[0]])
    }
}

/// Sweeps turn while they converge at steps of this length: the change of one is larger than that of the one before now and
/// then, long before nothing but rounding is left.
#[test]
fn sweeps_go_to_rounding_where_they_turn() {
    for length in [1.0, 1.05, 1.2, 1.5, 1.9] {
        let solver = Fixed::new(Gauss6::default(), length).compensated();
        let start = SVector::from([1.0, 0.0]);
        let (x, statistics) = end(Relaxation(0.0), solver, 1000.0 * length, start);
        let drift = (x.norm() - 1.0).abs();
        println!("steps of {length}: {drift:.1e}, {statistics:?}");
        assert!(drift < 1e-12, "{length}: {drift:e}");
    }
    // Collocation with five stages, which the same sweeps solve: exact to 4e-4 here.
    let law = Relaxation(3.5);
    let start = SVector::from([1.3, -0.4]);
    let strict = end(law, Adaptive::new(Dop853, 1e-12, 1e-12), 4.3, start).0;
    let found = end(law, Fixed::new(Radau9, 0.43), 4.3, start).0;
    assert!((found - strict).norm() < 2e-3, "{found:?} {strict:?}");
}

/// Two reactions that are almost in balance: forward and reverse rates cancel out but for some 1e-7 of each, and rounding is another
/// one in each equation (Enright and Pryce, *Two FORTRAN packages for assessing initial value methods*, ACM TOMS 13, 1987, problem F5).
#[derive(Clone, Copy)]
struct Balanced;

impl Law<4, 0> for Balanced {
    const STATES: &'static [Variable] = &[state("a"), state("b"), state("c"), state("d")];

    fn slope<T: Real>(&self, x: &SVector<T, 4>, _: &SVector<T, 0>) -> SVector<T, 4> {
        let of = T::from_f64;
        let (first, second) = (of(3.0) * x[0] * x[1], of(9.0) * x[0] * x[2]);
        let a = of(1e11) * (of(0.0012) * x[3] - first - second);
        SVector::from([
            a,
            of(2e7) * x[3] - of(3e11) * x[0] * x[1],
            of(1e11) * (of(0.001) * x[3] - second),
            -a,
        ])
    }
}

/// What rounding leaves of the rates no sweep makes smaller: it is more than sweeps may leave, and less than the tolerance.
#[test]
fn sweeps_end_where_only_rounding_is_left() {
    fn assert_cheap<S: Estimating>(method: S) {
        let start = SVector::from([3.365e-7, 8.261e-3, 1.642e-3, 9.38e-6]);
        let solver = Adaptive::new(method, 1e-9, 1e-19);
        let (x, statistics) = end(Balanced, solver, 100.0, start);
        println!("{}: {statistics:?} {x:?}", S::NAME);
        let expected = SVector::from([
            1.713564284685705e-07,
            0.003713563071171698,
            0.006189271785286162,
            9.54514357153137e-06,
        ]);
        let error = x
            .zip_map(&expected, |x, expected| (x / expected - 1.0).abs())
            .amax();
        assert!(error < 1e-8, "{}: {error:e}", S::NAME);
        assert!(
            statistics.steps + statistics.rejected < 1000,
            "{statistics:?}"
        );
    }
    assert_cheap(Radau5);
    assert_cheap(Radau9);
}

/// Sweeps to rounding take one more than what they need, and the Jacobian is as good in the next step.
#[test]
fn steps_of_radau_cost_little_where_the_law_is_linear() {
    fn assert_cheap<M: Method>(method: M, stages: u64, pairs: u64) {
        let start = SVector::from([1.0, 0.0]);
        let (x, statistics) = end(Relaxation(0.0), Fixed::new(method, 0.125), 100.0, start);
        println!("{}: {statistics:?}", M::NAME);
        let error = (x - SVector::from([f64::cos(100.0), -f64::sin(100.0)])).norm();
        assert!(error < 1e-4, "{}: {error:e}", M::NAME);
        assert_eq!((statistics.steps, statistics.rejected), (800, 0));
        assert_eq!(statistics.jacobians, 1);
        assert_eq!(statistics.factorisations, 1 + pairs);
        // The derivative at the start of a step, and two sweeps.
        let most = 800 * (1 + 2 * stages) + stages;
        assert!(statistics.evaluations <= most, "{statistics:?}");
    }
    assert_cheap(Radau5, 3, 1);
    assert_cheap(Radau9, 5, 2);
}

/// The pin is bent by a tenth of a micrometre, which is rounding beside its place in single precision.
#[test]
fn stiff_pins_in_single_precision_cost_no_more_than_in_double() {
    fn after<T: Real, M: Method>(method: M) -> (f64, Statistics) {
        let pin = StiffPin {
            stiffness: 1e8,
            damping: 1e3,
        };
        let [start, end] = [0.0, 2.0].map(T::from_f64);
        let level = StiffPin::level().map(T::from_f64);
        let mut last = level;
        let statistics = Fixed::new(method, 1e-3)
            .integrate(&Written(pin), &(), start, end, level, |step| {
                last = *step.state()
            })
            .unwrap();
        (last[2].find(|_| true).unwrap(), statistics)
    }
    fn compare<M: Method>(method: M) {
        let ((double, whole), (single, counts)) =
            (after::<f64, M>(method), after::<f32, M>(method));
        println!("{}: {double} {whole:?}, {single} {counts:?}", M::NAME);
        assert!((double - single).abs() < 1e-5, "{}", M::NAME);
        for statistics in [whole, counts] {
            assert_eq!((statistics.steps, statistics.rejected), (2000, 0));
            assert!(statistics.evaluations < 30 * statistics.steps);
        }
    }
    compare(Radau5);
    compare(Radau9);
}

/// A mass of 1 kg between a floor of 100 kN/m and a ceiling of the same above it, under gravity.
#[derive(Clone, Copy)]
struct Between {
    gravity: f64,
    ceiling: f64,
}

impl Between {
    const STIFFNESS: f64 = 1e5;
}

impl Law<2, 0> for Between {
    const STATES: &'static [Variable] = &[
        Variable {
            name: "height",
            unit: "",
        },
        Variable {
            name: "rate",
            unit: "",
        },
    ];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _u: &SVector<T, 0>) -> SVector<T, 2> {
        let zero = T::from_f64(0.0);
        let into_floor = x[0].min(zero);
        let into_ceiling = (x[0] - T::from_f64(self.ceiling)).max(zero);
        let force = T::from_f64(Self::STIFFNESS) * (into_floor + into_ceiling);
        SVector::from([x[1], -T::from_f64(self.gravity) - force])
    }
}

/// In free flight no estimate finds an error. One that straddles the begin or the end of a contact may be small by chance,
/// or filtered by a stiffness that is not there over most of the step. `Pirk8` and `Pirk16` are for smooth problems alone.
#[test]
fn contacts_behind_free_flight_are_met() {
    // Falls from 1 m: v for the way to the floor, (v + v) / g for each flight behind, and a contact of an oscillation about
    // the place of rest.
    let ball = Between {
        gravity: 9.81,
        ceiling: 2.0,
    };
    let (frequency, speed) = (f64::sqrt(Between::STIFFNESS), f64::sqrt(2.0 * 9.81));
    let contact = 2.0 / frequency * (0.5 * PI + f64::atan(9.81 / (frequency * speed)));
    let flight = 2.0 * speed / 9.81;
    let since = (5.0 - 0.5 * flight) % (contact + flight) - contact;
    let fallen = since * (speed - 0.5 * 9.81 * since);
    // From one wall to the other one, with half an oscillation at each.
    let (way, rate) = (0.2, 2.0);
    let shuttle = Between {
        gravity: 0.0,
        ceiling: way,
    };
    let wall = PI / frequency;
    let beyond = (3.0 + 0.5 * wall) % (way / rate + wall) - 0.5 * wall;
    let crossed = ((3.0 + 0.5 * wall) / (way / rate + wall)) as u32;
    let shuttled = if crossed.is_multiple_of(2) {
        rate * beyond
    } else {
        way - rate * beyond
    };
    let errors = |solver: &dyn Fn(Between, f64, SVector<f64, 2>) -> SVector<f64, 2>| {
        let bounced = solver(ball, 5.0, SVector::from([1.0, 0.0]));
        let returned = solver(shuttle, 3.0, SVector::from([0.0, rate]));
        [bounced[0] - fallen, returned[0] - shuttled].map(f64::abs)
    };
    fn with<S: Estimating>(
        method: S,
        tolerance: f64,
    ) -> impl Fn(Between, f64, SVector<f64, 2>) -> SVector<f64, 2> {
        move |law, time, start| {
            let solver = Adaptive::new(method, tolerance, 1e-3 * tolerance);
            end(law, solver, time, start).0
        }
    }
    for (name, tolerance, found) in [
        ("Radau5", 1e-4, errors(&with(Radau5, 1e-4))),
        ("Tsit5", 1e-8, errors(&with(Tsit5, 1e-8))),
        ("Dop853", 1e-8, errors(&with(Dop853, 1e-8))),
        ("Rodas5P", 1e-8, errors(&with(Rodas5P, 1e-8))),
        ("Radau5", 1e-8, errors(&with(Radau5, 1e-8))),
        ("Radau9", 1e-8, errors(&with(Radau9, 1e-8))),
    ] {
        println!("{name:<12}{tolerance:e}: errors {found:?}");
        let most = 1e3 * tolerance;
        assert!(found.iter().all(|error| *error < most), "{name} {found:?}");
    }
}
