//! Models next to a state, against closed forms, differences and runs.

use std::f64::consts::TAU;

use mbg_runtime::{
    Adaptive, Constant, Convertible, Dop853, Dual, Integrator, Linearised, Real, Rk4, Smooth,
    System, Trim, Trouble, mbg,
};
use nalgebra::{Complex, ComplexField, SMatrix, SVector};

use crate::references::errors::larger;
use crate::references::quarter_car;

mbg! {
    include "examples/gallery/quarter_car.mbg";
    include "examples/gallery/flying.mbg";

    /// A pendulum in a wind whose force is an output, too: one that is fed through.
    model Weathervane {
        param inertia: kg*m^2 = 0.5;
        input wind: N;
        1 joint {
            I vane { inertia: inertia }
            C weight { effort: 20.0 * sin(q), initial: 0.7 }
            R bearing { effort: 0.1 * f + 0.05 * f * abs(f) }
        }
        Se gust { effort: wind } -> TF arm { flow: 2.0 } -> joint;
        output load[2] = [wind * cos(weight.q), exp(0.3 * weight.q) * joint.f];
    }

    /// What nothing damps.
    model Ringing {
        input force;
        1 mesh { I mass { inertia: 2.0 } C spring { stiffness: 8.0 } Se push { effort: force } }
        output speed = mesh.f;
    }

    /// Two springs whose strokes are one, but for where they start.
    model Beside {
        input force;
        1 mesh { I mass { inertia: 2.0 } C soft { stiffness: 3.0 } C hard { stiffness: 5.0 } R oil { resistance: 1.0 } }
        Se push { effort: force } -> mesh;
        output place = soft.q;
    }

    /// A store that is filled through a diode and a resistor, whose current is found by iteration.
    model Filled {
        input voltage: V;
        0 source; 0 between; 0 store; 0 ground;
        Se supply { effort: voltage } -> source;
        Se earth { effort: 0.0 } -> ground;
        valve: Diode { saturation: 1e-12, thermal: 0.025 } (source, between);
        wire: Resistor { resistance: 10.0 } (between, store);
        full: Capacitor { capacitance: 1e-3 } (store, ground);
        output drop: V = valve.voltage;
        output current: A = valve.current;
    }

    /// A tank that drains by a square root of its level, or whose level is measured by one alone.
    model Draining {
        0 tank { C level { effort: q, initial: 1.0 } R outlet { flow: sqrt(e) } }
    }
    model Measured {
        input inflow;
        0 tank { C level { effort: q, initial: 1.0 } R outlet { flow: e } Sf feed { flow: inflow } }
        output speed = sqrt(level.q);
    }

    /// Pulled through the attitude in which its gimbals lock.
    model Locking {
        input torque[3]: N*m;
        1 frame[6];
        flying: Flying { orientation: angles, inertia: diag(1.0, 2.0, 1.5) } (frame);
        Se pull[3] { effort: torque } -> frame[0..3];
        output rates[3]: rad/s = frame.f[0..3];
    }
}

#[test]
fn response_of_a_quarter_car_is_that_by_hand() {
    let model = QuarterCar::<f64>::new(QuarterCarParameters::default()).unwrap();
    let (rest, still) = (model.initial_state(), SVector::zeros());
    let linear = Linearised::of(&model, 0.0, &rest, &still).unwrap();
    let mut worst = 0.0;
    for step in 1..=200 {
        let frequency = TAU * 0.1 * f64::from(step);
        let response = linear.response(frequency).unwrap();
        for (output, expected) in quarter_car::response(frequency).into_iter().enumerate() {
            let found = response[(2 + output, 0)];
            worst = larger(worst, (found - expected).modulus() / expected.modulus());
            // Places are integrals of speeds.
            let place = response[(output, 0)] * Complex::new(0.0, frequency);
            worst = larger(worst, (place - expected).modulus() / expected.modulus());
        }
    }
    assert!(worst < 1e-12, "{worst:e}");
}

/// Each matrix against differences of what it is the slope of.
#[test]
fn matrices_are_slopes() {
    let model = Weathervane::<f64>::new(WeathervaneParameters::default()).unwrap();
    let (x, u) = (SVector::from([0.4, 0.6]), SVector::from([1.5]));
    let linear = Linearised::of(&model, 0.0, &x, &u).unwrap();
    let values = |x: &SVector<f64, 2>, u: &SVector<f64, 1>| {
        let slope = model.derivative(0.0, x, u, &mut ());
        (slope, model.output(0.0, x, u, &mut ()))
    };
    let h = 1e-6;
    let mut worst = 0.0;
    let mut compare = |ends: [(SVector<f64, 2>, SVector<f64, 2>); 2],
                       found: [SVector<f64, 2>; 2]| {
        let [behind, ahead] = ends;
        let expected = [
            (ahead.0 - behind.0) / (2.0 * h),
            (ahead.1 - behind.1) / (2.0 * h),
        ];
        for (found, expected) in found.iter().zip(expected) {
            worst = larger(worst, (found - expected).amax());
        }
    };
    for column in 0..2 {
        let step = SVector::from_fn(|row, _| if row == column { h } else { 0.0 });
        let ends = [values(&(x - step), &u), values(&(x + step), &u)];
        let columns = [linear.state.column(column), linear.output.column(column)];
        compare(ends, columns.map(|column| column.into_owned()));
    }
    let step = SVector::from([h]);
    let ends = [values(&x, &(u - step)), values(&x, &(u + step))];
    compare(
        ends,
        [linear.input.column(0), linear.feedthrough.column(0)].map(|it| it.into_owned()),
    );
    assert!(worst < 1e-8, "{worst:e}");
    assert!(
        linear.feedthrough[(0, 0)] == x[1].cos(),
        "what is fed through"
    );
}

/// A run with a small input swings as the response says.
/// One column after the other, on dual numbers.
fn columns<const K: usize, const P: usize>(
    at: &SVector<f64, K>,
    function: impl Fn(&SVector<Dual<f64>, K>) -> SVector<Dual<f64>, P>,
) -> SMatrix<f64, P, K> {
    let mut columns = SMatrix::<f64, P, K>::zeros();
    for component in 0..K {
        let mut at = at.map(Dual::constant);
        at[component].slope = 1.0;
        columns.set_column(component, &function(&at).map(|it| it.slope));
    }
    columns
}

/// With more states than are taken at once.
#[test]
fn matrices_of_outputs_are_their_columns() {
    let model = Locking::<f64>::new(LockingParameters::default()).unwrap();
    let (x, u) = (
        SVector::from_fn(|k, _| 0.2 + 0.1 * k as f64),
        SVector::from([1.0, 2.0, -0.5]),
    );
    let several = model.converted(Dual::constant);
    let found = model.output_jacobian_state(0.0, &x, &u);
    let expected = columns(&x, |x| {
        several.output(Dual::constant(0.0), x, &u.map(Dual::constant), &mut ())
    });
    assert!((found - expected).amax() < 1e-15, "{found}{expected}");
    assert!(expected.amax() > 0.1);
}

/// The derivatives of a step and those of the same step on dual numbers.
#[track_caller]
fn assert_transition<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    x: &SVector<f64, N>,
    u: &SVector<f64, M>,
) where
    S: Convertible<f64, N, M, P>,
{
    let h = 0.05;
    let found = Rk4::transition(model, 0.3, x, u, h, &mut Default::default());
    let dual = model.converted(Dual::constant);
    let step = |x: &SVector<Dual<f64>, N>, u: &SVector<Dual<f64>, M>| {
        let [t, h] = [0.3, h].map(Dual::constant);
        Rk4::step(&dual, t, x, u, h, &mut Default::default())
    };
    let (fixed_x, fixed_u) = (x.map(Dual::constant), u.map(Dual::constant));
    let end = Rk4::step(model, 0.3, x, u, h, &mut Default::default());
    let state = columns(x, |x| step(x, &fixed_u));
    let input = columns(u, |u| step(&fixed_x, u));
    assert!((found.end - end).amax() < 1e-14 * (1.0 + end.amax()));
    assert!((found.state - state).amax() < 1e-13 * (1.0 + state.amax()));
    assert!((found.input - input).amax() < 1e-13 * (1.0 + input.amax()));
    assert!((state - SMatrix::identity()).amax() > 0.01 && input.amax() > 1e-4);
}

#[test]
fn derivatives_of_a_step_are_those_of_dual_numbers() {
    let vane = Weathervane::new(WeathervaneParameters::default()).unwrap();
    assert_transition(&vane, &SVector::from([0.4, 0.6]), &SVector::from([1.5]));
    let flying = Locking::new(LockingParameters::default()).unwrap();
    let state = SVector::from_fn(|k, _| 0.2 + 0.1 * k as f64);
    assert_transition(&flying, &state, &SVector::from([1.0, 2.0, -0.5]));
    let filled = Filled::new(FilledParameters::default()).unwrap();
    assert_transition(&filled, &SVector::from([1e-4]), &SVector::from([2.0]));
}

#[test]
fn a_run_swings_as_the_response_says() {
    let model = Weathervane::<f64>::new(WeathervaneParameters::default()).unwrap();
    let (frequency, amplitude) = (5.0, 1e-4);
    let rest = SVector::zeros();
    let linear = Linearised::of(&model, 0.0, &rest, &SVector::zeros()).unwrap();
    let response = linear.response(frequency).unwrap();
    // Starts on the swing itself: x = Im((jω − A)⁻¹ B a).
    let states = Linearised {
        output: SMatrix::identity(),
        feedthrough: SMatrix::zeros(),
        ..linear
    };
    let start = states
        .response(frequency)
        .unwrap()
        .map(|it| amplitude * it.im);
    let push = Smooth(|t: f64| SVector::from([amplitude * (frequency * t).sin()]));
    let times: Vec<f64> = (0..=40).map(|k| 0.05 * f64::from(k)).collect();
    let mut worst = 0.0;
    Adaptive::new(Dop853, 1e-12, 1e-18)
        .sample(&model, &push, 0.0, start, &times, |t, x| {
            let u = SVector::from([amplitude * (frequency * t).sin()]);
            let found = model.output(t, x, &u, &mut ());
            let turned = Complex::new((frequency * t).cos(), (frequency * t).sin());
            for (found, response) in found.iter().zip(response.iter()) {
                worst = larger(worst, (found / amplitude - (response * turned).im).abs());
            }
        })
        .unwrap();
    // What is left is of the order of the amplitude.
    assert!(worst < 2e-4, "{worst:e}");
}

#[test]
fn there_is_no_response_at_a_pole() {
    let model = Ringing::<f64>::new(RingingParameters::default()).unwrap();
    let linear = Linearised::of(&model, 0.0, &model.initial_state(), &SVector::zeros()).unwrap();
    assert_eq!(linear.response(2.0), None);
    let near = linear.response(1.0).unwrap()[(0, 0)];
    assert_eq!([near.re, near.im], [0.0, 1.0 / 6.0]);
    let poles = linear.poles().unwrap();
    assert!(
        poles
            .iter()
            .all(|pole| pole.re.abs() < 1e-15 && (pole.im.abs() - 2.0).abs() < 1e-15)
    );
}

#[test]
fn a_singular_attitude_is_refused_by_name() {
    let model = Locking::<f64>::new(LockingParameters::default()).unwrap();
    let place = |name: &str| {
        let states = <Locking as System<f64, _, _, _>>::META.states;
        states
            .iter()
            .position(|state| state.name.ends_with(name))
            .unwrap()
    };
    let mut x = model.initial_state();
    x[place("angle.y")] = std::f64::consts::FRAC_PI_2;
    let refused = Linearised::of(&model, 0.0, &x, &SVector::zeros()).unwrap_err();
    assert!(matches!(refused, Trouble::Singular { .. }), "{refused}");
    x[place("angle.y")] = 1.0;
    assert!(Linearised::of(&model, 0.0, &x, &SVector::zeros()).is_ok());
}

#[test]
fn what_has_no_finite_slope_is_told_by_its_place() {
    let draining = Draining::<f64>::new(DrainingParameters::default()).unwrap();
    let measured = Measured::<f64>::new(MeasuredParameters::default()).unwrap();
    let places = [
        (
            Linearised::of(&draining, 0.0, &SVector::from([0.0]), &SVector::zeros()).unwrap_err(),
            ("level.q", "level.q"),
        ),
        (
            Linearised::of(&measured, 0.0, &SVector::from([0.0]), &SVector::zeros()).unwrap_err(),
            ("speed", "level.q"),
        ),
    ];
    for (refused, (of, by)) in places {
        assert_eq!(refused, Trouble::JacobianNotFinite { of, by });
    }
    // An output that nobody asks for does not keep from a point.
    let empty = Trim::new(&measured).state(&SVector::from([0.0])).solve();
    assert_eq!(empty.unwrap().state, SVector::from([0.0]));
}

#[test]
fn a_state_that_is_no_number_is_told() {
    let model = Draining::<f64>::new(DrainingParameters::default()).unwrap();
    let state = "level.q";
    for level in [f64::NAN, f64::INFINITY] {
        let x = SVector::from([level]);
        let trouble = System::trouble(&model, 0.0, &x, &SVector::zeros(), &());
        assert_eq!(trouble, Some(Trouble::NotFinite { state }));
        let refused = Linearised::of(&model, 0.0, &x, &SVector::zeros()).unwrap_err();
        assert_eq!(refused, Trouble::NotFinite { state });
    }
}

#[test]
fn single_precision_agrees_with_double() {
    let model = QuarterCar::<f32>::new(QuarterCarParameters::default()).unwrap();
    let (rest, still) = (model.initial_state(), SVector::zeros());
    let linear = Linearised::of(&model, 0.0, &rest, &still).unwrap();
    let response = linear.response(f32::from_f64(10.0)).unwrap();
    for (output, expected) in quarter_car::response(10.0).into_iter().enumerate() {
        let found = response[(2 + output, 0)];
        let found = Complex::new(f64::from(found.re), f64::from(found.im));
        assert!((found - expected).modulus() < 1e-5 * expected.modulus());
    }
}

#[test]
fn what_depends_on_each_other_has_a_pole_at_rest() {
    let model = Beside::<f64>::new(BesideParameters::default()).unwrap();
    let linear = Linearised::of(&model, 0.0, &model.initial_state(), &SVector::zeros()).unwrap();
    assert_eq!(linear.response(0.0), None);
    let still = linear.response(1e-6).unwrap()[(0, 0)];
    assert!((still - Complex::from(1.0 / 8.0)).modulus() < 1e-6);
}

/// The slope of a diode's law stands in for a resistance.
#[test]
fn what_is_iterated_has_the_slopes_of_its_law() {
    let model = Filled::<f64>::new(FilledParameters::default()).unwrap();
    let (drop, held) = (0.6, 1.5);
    let leakage = 1e-12;
    let forward = 1e-12 * f64::exp_m1(drop / 0.025);
    let current = forward + leakage * drop;
    let own = 1.0 / ((forward + 1e-12) / 0.025 + leakage);
    let (x, u) = (
        SVector::from([1e-3 * held]),
        SVector::from([held + drop + 10.0 * current]),
    );
    let linear = Linearised::of(&model, 0.0, &x, &u).unwrap();
    let whole = 10.0 + own;
    let expected = [
        (linear.input[(0, 0)], 1.0 / whole),
        (linear.state[(0, 0)], -1e3 / whole),
        (linear.feedthrough[(0, 0)], own / whole),
        (linear.feedthrough[(1, 0)], 1.0 / whole),
        (linear.output[(0, 0)], -1e3 * own / whole),
        (linear.output[(1, 0)], -1e3 / whole),
    ];
    for (found, expected) in expected {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }
    let refused = Linearised::of(&model, 0.0, &x, &SVector::from([f64::NAN])).unwrap_err();
    assert!(matches!(refused, Trouble::Unsolved { .. }), "{refused}");
}

/// A mass on a spring whose force is held, over less than a millionth and over thirty of its periods.
#[test]
fn from_sample_to_sample_a_model_is_its_closed_form() {
    fn check<T: Real>(period: f64, tolerance: f64) {
        let number = T::from_f64;
        let parameters = RingingParameters::default();
        let model = Ringing::<T>::new(parameters).unwrap();
        let (x, u) = (model.initial_state(), SVector::from([number(0.0)]));
        let linear = Linearised::of(&model, number(0.0), &x, &u).unwrap();
        let (transition, push) = linear.held(number(period)).unwrap();
        let (sine, cosine) = (2.0 * period).sin_cos();
        // Momentum and stroke, of 2 kg at 2 rad/s; 1 − cos without cancellation.
        let rise = 2.0 * period.sin() * period.sin();
        let expected = [
            cosine,
            0.25 * sine,
            -4.0 * sine,
            cosine,
            0.5 * sine,
            rise / 8.0,
        ];
        let found = transition.iter().chain(push.iter());
        for (found, expected) in found.zip(expected) {
            let error = (*found - number(expected)).magnitude();
            assert!(
                error <= tolerance * expected.abs().max(1e-12),
                "{period} {error:e}"
            );
        }
    }
    check::<f64>(1e-6, 1e-14);
    check::<f64>(0.3, 1e-14);
    check::<f64>(100.0, 1e-12);
    check::<f32>(0.3, 1e-6);
}

/// Stiff tyre, soft suspension.
#[test]
fn from_sample_to_sample_a_car_is_its_run() {
    let car = QuarterCar::<f64>::new(QuarterCarParameters::default()).unwrap();
    let (start, none) = (car.initial_state(), SVector::from([0.0]));
    let linear = Linearised::of(&car, 0.0, &start, &none).unwrap();
    let period = 0.05;
    let (transition, push) = linear.held(period).unwrap();
    let mut state = SVector::from_fn(|k, _| 0.1 * (k as f64 + 1.0));
    let u = SVector::from([0.3]);
    let expected = transition * state + push * u;
    let rest = car.derivative(0.0, &SVector::zeros(), &none, &mut ());
    assert!(rest.norm() == 0.0, "linear");
    Adaptive::new(Dop853, 1e-13, 1e-13)
        .integrate(&car, &Constant(u), 0.0, period, state, |step| {
            state = *step.state()
        })
        .unwrap();
    assert!(
        (state - expected).norm() < 1e-11 * expected.norm(),
        "{state} {expected}"
    );
    let endless = Linearised {
        state: linear.state * f64::INFINITY,
        ..linear
    };
    assert!(endless.held(period).is_none());
}

/// Noise that pushes a mass on a spring, over less than a millionth and over thirty of its periods.
#[test]
fn noise_from_sample_to_sample_is_its_closed_form() {
    let model = Ringing::<f64>::new(RingingParameters::default()).unwrap();
    let (x, u) = (model.initial_state(), SVector::from([0.0]));
    let linear = Linearised::of(&model, 0.0, &x, &u).unwrap();
    let density = 0.3;
    for (period, tolerance) in [(1e-3, 1e-13), (0.3, 1e-14), (100.0, 1e-12)] {
        let found = linear.noise(&SMatrix::from([[density]]), period).unwrap();
        let sine = f64::sin(4.0 * period);
        let product = f64::sin(2.0 * period) * f64::sin(2.0 * period) / 16.0;
        // Momentum and stroke, of 2 kg at 2 rad/s; the last cancels out over a short period, but for period³ / 12.
        let stroke = (4.0 * period - sine) / 128.0;
        let expected =
            SMatrix::from([[0.5 * period + sine / 8.0, product], [product, stroke]]) * density;
        for (found, expected) in found.iter().zip(expected.iter()) {
            let error = (found - expected).abs() / expected.abs();
            assert!(
                error < tolerance.max(1e-16 * period / expected),
                "{period} {error:e}"
            );
        }
    }
}

/// Over a long time the covariance of a car on a rough road is what its dampers hold it at, and its heights go with the road.
#[test]
fn noise_over_a_long_time_is_at_rest() {
    let car = QuarterCar::<f64>::new(QuarterCarParameters::default()).unwrap();
    let (start, none) = (car.initial_state(), SVector::from([0.0]));
    let linear = Linearised::of(&car, 0.0, &start, &none).unwrap();
    let density = 0.04;
    let source = linear.input * linear.input.transpose() * density;
    let covariance = linear.noise(&SMatrix::from([[density]]), 1e3).unwrap();
    let change = linear.state * covariance;
    let mut rate = change + change.transpose() + source;
    for height in rate.fixed_view_mut::<2, 2>(4, 4).iter_mut() {
        *height -= density;
    }
    let terms = linear.state.abs() * covariance.abs();
    assert!(rate.norm() < 1e-14 * terms.norm(), "{rate}");
    let endless = Linearised {
        state: linear.state * f64::INFINITY,
        ..linear
    };
    assert!(endless.noise(&SMatrix::from([[0.04]]), 1.0).is_none());
}
