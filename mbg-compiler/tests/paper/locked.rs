//! One gimbal blocked: one component of one momentum is no state any more, and the motion is that of Newton and Euler
//! with one degree of freedom less.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{self, Arguments};
use mbg_runtime::Dual;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::language::{GIMBALS, REVOLUTES, System, compiled, library, texts};
use crate::models::dual::{Point, evaluate};

const COMPONENTS: [&str; 3] = ["x", "y", "z"];

/// The system with a joint whose gimbal `axis` is blocked.
fn locked(joint: &str, axis: usize) -> Compiled {
    let letter = COMPONENTS[axis];
    let (bond, angles) = if joint == GIMBALS {
        (
            "rates -> MTF jacobian".to_owned(),
            "joint.spring.q".to_owned(),
        )
    } else {
        let angles = COMPONENTS.map(|letter| format!("joint.{letter}.spring.q"));
        (
            format!("rel.{letter} -> C spring"),
            format!("[{}]", angles.join(", ")),
        )
    };
    let end = if joint == GIMBALS { "rates" } else { "rel" };
    let lock = format!("Sf lock {{ flow: 0.0 }} -> {end}.{letter}; {bond}");
    let library = library();
    assert_eq!(
        library.matches(&bond).count(),
        if joint == GIMBALS { 2 } else { 1 }
    );
    let system = System {
        mark: "#[derivative]",
        first: "causality componentwise;",
        ..System::free(joint)
    };
    let outputs = format!(
        "output hull[3] = hull.p; output body[3] = body.p; output angles[3] = {angles}; joint:"
    );
    let text = system.text().replacen("joint:", &outputs, 1);
    compiled(&library.replacen(&bond, &lock, 1), &text)
        .unwrap_or_else(|found| panic!("{:?}", texts(&found)))
}

/// Rates of fuselage and platform, rates of the gimbals, and angles: the two rates that are free, with the fuselage's,
/// are the five velocities.
struct Locked {
    axis: usize,
    inertia: SMatrix<f64, 6, 6>,
}

type Configuration = (Vector3<f64>, SVector<f64, 2>, Vector3<f64>);

impl Locked {
    fn new(axis: usize) -> Self {
        let inertia = SVector::<f64, 6>::from([1e4, 1e4, 5e3, 10.0, 10.0, 10.0]);
        Self {
            axis,
            inertia: SMatrix::from_diagonal(&inertia),
        }
    }

    /// The rates of all gimbals.
    fn rates(&self, free: &SVector<f64, 2>) -> Vector3<f64> {
        Vector3::from_fn(|row, _| match row.cmp(&self.axis) {
            std::cmp::Ordering::Less => free[row],
            std::cmp::Ordering::Equal => 0.0,
            std::cmp::Ordering::Greater => free[row - 1],
        })
    }

    /// `(ω_f, ω_p) = B (ω_f, α̇)`, and the part of its derivative that holds no acceleration.
    fn velocities(
        &self,
        (fuselage, free, angles): &Configuration,
    ) -> (SMatrix<f64, 6, 5>, SVector<f64, 6>, SVector<f64, 6>) {
        let ((s1, c1), (s2, c2)) = (angles[0].sin_cos(), angles[1].sin_cos());
        let rates = self.rates(free);
        let jacobian = Matrix3::new(1.0, 0.0, s2, 0.0, c1, -c2 * s1, 0.0, s1, c1 * c2);
        let by_first = Matrix3::new(0.0, 0.0, 0.0, 0.0, -s1, -c2 * c1, 0.0, c1, -s1 * c2);
        let by_second = Matrix3::new(0.0, 0.0, c2, 0.0, 0.0, s2 * s1, 0.0, 0.0, -c1 * s2);
        let change = by_first * rates[0] + by_second * rates[1];
        let turn = mbg_runtime::attitude::rotation_xyz(angles).transpose();
        let platform = turn * (fuselage + jacobian * rates);
        let relative = turn * jacobian * rates;
        let mut matrix = SMatrix::<f64, 6, 5>::zeros();
        matrix
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&Matrix3::identity());
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&turn);
        let columns = turn * jacobian;
        for (place, axis) in (0..3).filter(|axis| *axis != self.axis).enumerate() {
            matrix
                .fixed_view_mut::<3, 1>(3, 3 + place)
                .copy_from(&columns.column(axis));
        }
        let drift = turn * change * rates - relative.cross(&platform);
        let stack =
            |a: Vector3<f64>, b: Vector3<f64>| SVector::from([a.x, a.y, a.z, b.x, b.y, b.z]);
        (
            matrix,
            stack(*fuselage, platform),
            stack(Vector3::zeros(), drift),
        )
    }

    /// Rates of the configuration, and of the momenta: `BᵀMB u̇ = Bᵀ(τ − ω × Mω − M Ḃu)`.
    fn derivative(
        &self,
        x: &Configuration,
        gust: &Vector3<f64>,
    ) -> (Configuration, SVector<f64, 6>) {
        let (matrix, omega, drift) = self.velocities(x);
        let momentum = self.inertia * omega;
        let half = |vector: &SVector<f64, 6>, start: usize| {
            Vector3::new(vector[start], vector[start + 1], vector[start + 2])
        };
        let spun = half(&omega, 0).cross(&half(&momentum, 0));
        let torque = gust - half(&omega, 0) * 1e3 - spun;
        // The platform is isotropic: ω × Jω is zero, but would be rounding of Jω far above its torque.
        let forces = SVector::<f64, 6>::from([torque.x, torque.y, torque.z, 0.0, 0.0, 0.0]);
        let springs = -(x.2 + self.rates(&x.1)) * 1e-5;
        let mut right = matrix.transpose() * (forces - self.inertia * drift);
        for (place, axis) in (0..3).filter(|axis| *axis != self.axis).enumerate() {
            right[3 + place] += springs[axis];
        }
        let mass = matrix.transpose() * self.inertia * matrix;
        let change = mass
            .cholesky()
            .expect("the mass matrix is positive")
            .solve(&right);
        let configuration = (
            change.fixed_rows::<3>(0).into_owned(),
            change.fixed_rows::<2>(3).into_owned(),
            self.rates(&x.1),
        );
        (configuration, self.inertia * (matrix * change + drift))
    }
}

/// The rates of the states.
fn rates(model: &Compiled, state: &[f64], gust: &Vector3<f64>) -> Vec<f64> {
    let arguments = Arguments {
        parameters: &parameters(model),
        time: 0.0,
        state,
        input: gust.as_slice(),
    };
    program::evaluate(&model.program, Routines::DERIVATIVE, &arguments)
}

fn parameters(model: &Compiled) -> Vec<f64> {
    model.model.parameters.iter().map(|it| it.default).collect()
}

struct Told {
    hull: Vector3<f64>,
    body: Vector3<f64>,
    angles: Vector3<f64>,
    /// Time derivatives of both momenta.
    change: SVector<f64, 6>,
    /// dH/dt less what is supplied, plus what is dissipated, over the sum of what each component of the inertias takes:
    /// these cancel in dH/dt, and each is known to rounding alone.
    imbalance: f64,
}

/// What the program says at a state.
fn told(model: &Compiled, state: &[f64], gust: &Vector3<f64>) -> Told {
    let parameters = parameters(model);
    let run = |routine, along: &[f64]| {
        let state: Vec<Dual<f64>> = state
            .iter()
            .zip(along)
            .map(|(value, slope)| Dual {
                value: *value,
                slope: *slope,
            })
            .collect();
        let point = Point {
            parameters: &parameters,
            time: Dual::constant(0.0),
            state: &state,
            input: &[0, 1, 2].map(|axis| Dual::constant(gust[axis])),
        };
        evaluate(&model.program, routine, &point)
    };
    let rates = rates(model, state, gust);
    let outputs = run(Routines::OUTPUT, &rates);
    let energy = run(Routines::ENERGY, &rates)[0].slope;
    let power = run(Routines::POWER, &rates);
    let (supplied, dissipated) = (power[0].value, power[1].value);
    let vector = |start: usize| {
        Vector3::new(
            outputs[start].value,
            outputs[start + 1].value,
            outputs[start + 2].value,
        )
    };
    let flows = [
        vector(0).component_div(&Vector3::new(1e4, 1e4, 5e3)),
        vector(3) / 10.0,
    ];
    let change: SVector<f64, 6> = SVector::from_fn(|row, _| outputs[row].slope);
    let terms = (0..6).map(|row| (flows[row / 3][row % 3] * change[row]).abs());
    Told {
        hull: vector(0),
        body: vector(3),
        angles: vector(6),
        change,
        imbalance: (energy - supplied + dissipated).abs() / terms.sum::<f64>(),
    }
}

/// The configuration that has these momenta.
fn configuration(axis: usize, told: &Told) -> Configuration {
    let fuselage = told.hull.component_div(&Vector3::new(1e4, 1e4, 5e3));
    let ((s1, c1), (s2, c2)) = (told.angles[0].sin_cos(), told.angles[1].sin_cos());
    let jacobian = Matrix3::new(1.0, 0.0, s2, 0.0, c1, -c2 * s1, 0.0, s1, c1 * c2);
    let turn = mbg_runtime::attitude::rotation_xyz(&told.angles);
    let rates =
        jacobian.try_inverse().expect("it is regular here") * (turn * told.body / 10.0 - fuselage);
    let size = rates.amax().max(1.0);
    assert!(
        rates[axis].abs() < 1e-12 * size,
        "the locked gimbal turns: {:e}",
        rates[axis]
    );
    let free: Vec<f64> = (0..3)
        .filter(|place| *place != axis)
        .map(|place| rates[place])
        .collect();
    (fuselage, SVector::from([free[0], free[1]]), told.angles)
}

/// A sequence in [-1, 1), the same every time.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 5_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn conditioning(model: &Compiled, state: &[f64]) -> f64 {
    let state: Vec<Dual<f64>> = state.iter().map(|value| Dual::constant(*value)).collect();
    let point = Point {
        parameters: &parameters(model),
        time: Dual::constant(0.0),
        state: &state,
        input: &[Dual::constant(0.0); 3],
    };
    let values = evaluate(&model.program, Routines::CONDITIONING, &point);
    values
        .iter()
        .fold(1.0, |least, value| value.value.abs().min(least))
}

#[test]
fn one_component_is_lost_and_the_divisor_is_not_zero_at_rest() {
    for axis in 0..3 {
        for joint in [GIMBALS, REVOLUTES] {
            let model = locked(joint, axis);
            let momenta = model
                .states
                .iter()
                .filter(|state| model.model.states[**state].variable.name.contains(".p"));
            assert_eq!((model.states.len(), momenta.count()), (8, 5));
            let nominal = conditioning(&model, &[0.0; 8]);
            assert!(nominal > 0.1, "{nominal}");
        }
    }
}

#[test]
fn the_derivative_is_that_of_newton_and_euler() {
    let (mut next, mut worst, mut balance) = (noise(), 0.0_f64, 0.0_f64);
    for (joint, axis) in [GIMBALS, REVOLUTES]
        .into_iter()
        .flat_map(|joint| (0..3).map(move |axis| (joint, axis)))
    {
        let (model, reference) = (locked(joint, axis), Locked::new(axis));
        let mut tried = 0;
        while tried < 200 {
            let state: Vec<f64> = model
                .states
                .iter()
                .map(|state| {
                    let name = &model.model.states[*state].variable.name;
                    next()
                        * if name.starts_with("hull") {
                            1000.0
                        } else if name.starts_with("body") {
                            10.0
                        } else {
                            3.0
                        }
                })
                .collect();
            let gust = Vector3::from_fn(|_, _| 100.0 * next());
            if conditioning(&model, &state) < 0.1 {
                continue;
            }
            tried += 1;
            let told = told(&model, &state, &gust);
            if f64::cos(told.angles[1]).abs() < 0.1 {
                continue;
            }
            let (_, expected) = reference.derivative(&configuration(axis, &told), &gust);
            for start in [0, 3] {
                let (ours, theirs) = (
                    told.change.fixed_rows::<3>(start),
                    expected.fixed_rows::<3>(start),
                );
                let error = (ours - theirs).amax() / theirs.amax();
                assert!(error < 1e-10, "{joint}, {axis}: {error:e}");
                worst = worst.max(error);
            }
            assert!(
                told.imbalance < 1e-13,
                "{joint}, {axis}: {:e}",
                told.imbalance
            );
            balance = balance.max(told.imbalance);
        }
    }
    println!("locked gimbals: derivative {worst:e}, energy {balance:e}");
}

/// A step of the classical method of Runge and Kutta.
fn step<const N: usize>(
    x: &SVector<f64, N>,
    h: f64,
    slope: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let k1 = slope(x);
    let k2 = slope(&(x + k1 * (h / 2.0)));
    let k3 = slope(&(x + k2 * (h / 2.0)));
    let k4 = slope(&(x + k3 * h));
    x + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0)
}

#[test]
fn twenty_seconds_of_gust_are_those_of_newton_and_euler() {
    let h = 4e-3;
    for (joint, axis) in [GIMBALS, REVOLUTES]
        .into_iter()
        .flat_map(|joint| (0..3).map(move |axis| (joint, axis)))
    {
        let (model, reference) = (locked(joint, axis), Locked::new(axis));
        let mut ours = SVector::<f64, 8>::zeros();
        let mut theirs = SVector::<f64, 8>::zeros();
        let split = |x: &SVector<f64, 8>| -> Configuration {
            (
                x.fixed_rows::<3>(0).into_owned(),
                x.fixed_rows::<2>(3).into_owned(),
                x.fixed_rows::<3>(5).into_owned(),
            )
        };
        let (mut most, mut worst) = (SVector::<f64, 9>::zeros(), SVector::<f64, 9>::zeros());
        for number in 0..5000 {
            let blowing = (250..275).contains(&number);
            let gust = Vector3::new(5000.0, 1000.0, 10000.0) * f64::from(u8::from(blowing));
            ours = step(&ours, h, |x| {
                SVector::from_column_slice(&rates(&model, x.as_slice(), &gust))
            });
            theirs = step(&theirs, h, |x| {
                let (a, b, c) = reference.derivative(&split(x), &gust).0;
                SVector::from_iterator(a.iter().chain(&b).chain(&c).copied())
            });
            if number % 25 == 24 {
                let told = told(&model, ours.as_slice(), &gust);
                let (_, omega, _) = reference.velocities(&split(&theirs));
                let momentum = reference.inertia * omega;
                for row in 0..9 {
                    let (found, expected) = match row {
                        0..3 => (told.hull[row], momentum[row]),
                        3..6 => (told.body[row - 3], momentum[row]),
                        _ => (told.angles[row - 6], theirs[row - 1]),
                    };
                    most[row] = most[row].max(expected.abs());
                    let error = (found - expected).abs();
                    assert!(error.is_finite());
                    worst[row] = worst[row].max(error);
                }
            }
        }
        let error =
            |start: usize| worst.fixed_rows::<3>(start).amax() / most.fixed_rows::<3>(start).amax();
        let errors = [0, 3, 6].map(error);
        println!("{joint}, {} locked: {errors:?}", COMPONENTS[axis]);
        assert!(errors.iter().all(|error| *error < 1e-10), "{errors:?}");
    }
}
