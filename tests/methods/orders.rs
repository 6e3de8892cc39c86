//! Orders of convergence, at the ends of steps and in between.

use mbg_runtime::{
    Adaptive, Differentiable, Dop853, Dual, Estimating, Fixed, Gauss6, ImplicitMidpoint, Input,
    Integrator, Method, Pirk8, Pirk16, Radau5, Radau9, Real, Rk4, Rodas4, Rodas5P, Ros2, Smooth,
    Tsit5, Verner9,
};
use nalgebra::SVector;

use crate::problems::{Follower, Hunters, Kaps, Law, Oscillator, Pendulum, RigidBody, Written};

/// A problem with its solution at `END`.
struct Task<L, I, const N: usize> {
    law: L,
    input: I,
    /// States at the start and at the end; several, so that no order is seen by chance.
    runs: Vec<[SVector<f64, N>; 2]>,
}

const END: f64 = 2.0;

/// The end by Gauss's method in short steps with compensated sums.
fn solved<L: Law<N, M> + Copy, I: Input<f64, M>, const N: usize, const M: usize>(
    law: L,
    input: I,
    starts: [SVector<f64, N>; 3],
) -> Task<L, I, N> {
    let run = |start| {
        let mut end = start;
        Fixed::new(Gauss6::default(), 1e-3)
            .compensated()
            .integrate(&Written(law), &input, 0.0, END, start, |step| {
                end = *step.state()
            })
            .unwrap();
        [start, end]
    };
    let runs = starts.map(run).to_vec();
    Task { law, input, runs }
}

fn pendulum() -> Task<Pendulum, (), 2> {
    let starts = [[1.5, 3.0], [2.5, -4.0], [0.2, 5.0]];
    solved(Pendulum, (), starts.map(SVector::from))
}

fn hunters() -> Task<Hunters, (), 2> {
    let starts = [[2.0, 1.0], [3.0, 2.0], [0.5, 4.0]];
    solved(Hunters, (), starts.map(SVector::from))
}

fn body() -> Task<RigidBody, (), 7> {
    let momenta = [[1.0, 1.0, 2.0], [2.0, -3.0, 1.0], [-1.0, 4.0, 5.0]];
    let starts = momenta.map(|[x, y, z]| SVector::from([x, y, z, 1.0, 0.0, 0.0, 0.0]));
    solved(RigidBody, (), starts)
}

/// `ẍ + x = cos 2t` from (1, 0).
fn exact(t: f64) -> SVector<f64, 2> {
    driven(2.0, t)
}

/// `ẍ + x = cos ωt` from (1, 0).
fn driven(frequency: f64, t: f64) -> SVector<f64, 2> {
    let gain = 1.0 / (1.0 - frequency * frequency);
    let angle = frequency * t;
    SVector::from([
        t.cos() + gain * (angle.cos() - t.cos()),
        -t.sin() - gain * (frequency * angle.sin() - t.sin()),
    ])
}

fn forced() -> Task<Oscillator, impl Input<f64, 1>, 2> {
    forced_at(2.0)
}

fn forced_at(frequency: f64) -> Task<Oscillator, impl Input<f64, 1>, 2> {
    Task {
        law: Oscillator,
        input: Differentiable(move |t: Dual<f64>| {
            SVector::from([(t * Dual::constant(frequency)).cos()])
        }),
        runs: vec![[0.0, END].map(|t| driven(frequency, t))],
    }
}

/// The slow motion of a stiff problem: that of the pendulum, up to the time constant.
fn follower() -> Task<Follower, (), 3> {
    let with_torque = |x: SVector<f64, 2>| SVector::from([x[0], x[1], -x[0].sin()]);
    Task {
        law: Follower(1e-12),
        input: (),
        runs: pendulum()
            .runs
            .iter()
            .map(|run| run.map(with_torque))
            .collect(),
    }
}

fn kaps() -> Task<Kaps, (), 2> {
    let exact = |t: f64| SVector::from([(-2.0 * t).exp(), (-t).exp()]);
    Task {
        law: Kaps(1e-10),
        input: (),
        runs: vec![[exact(0.0), exact(END)]],
    }
}

/// Errors at the end after so many steps, and their slope over the step.
fn slope<L, I, S, const N: usize, const M: usize>(
    task: &Task<L, I, N>,
    method: S,
    steps: [u32; 3],
) -> f64
where
    L: Law<N, M> + Copy,
    I: Input<f64, M>,
    S: Method,
{
    let errors = steps.map(|steps| {
        let fixed = Fixed::new(method, END / f64::from(steps)).compensated();
        let run = |[start, expected]: &[SVector<f64, N>; 2]| {
            let mut end = *start;
            fixed
                .integrate(&Written(task.law), &task.input, 0.0, END, end, |step| {
                    end = *step.state()
                })
                .unwrap();
            (end - expected).norm()
        };
        task.runs.iter().map(run).sum::<f64>()
    });
    let [most, .., least] = [steps[2], steps[1], steps[0]];
    let slope = (errors[0] / errors[2]).ln() / (f64::from(most) / f64::from(least)).ln();
    println!("{:<20}{steps:?} {errors:?} {slope:.2}", S::NAME);
    slope
}

fn assert_order<L, I, S, const N: usize, const M: usize>(
    problem: &str,
    task: &Task<L, I, N>,
    method: S,
    steps: [u32; 3],
) where
    L: Law<N, M> + Copy,
    I: Input<f64, M>,
    S: Method,
{
    assert_slope(problem, task, method, steps, S::ORDER);
}

fn assert_slope<L, I, S, const N: usize, const M: usize>(
    problem: &str,
    task: &Task<L, I, N>,
    method: S,
    steps: [u32; 3],
    order: u32,
) where
    L: Law<N, M> + Copy,
    I: Input<f64, M>,
    S: Method,
{
    let slope = slope(task, method, steps);
    let order = f64::from(order);
    assert!(
        (slope - order).abs() < 0.2,
        "{} on the {problem}: {slope:.2} in place of {order}",
        S::NAME
    );
}

#[test]
fn orders_on_nonlinear_oscillations() {
    let task = pendulum();
    assert_order("pendulum", &task, Rk4, [32, 64, 128]);
    assert_order("pendulum", &task, Tsit5, [64, 128, 256]);
    assert_order("pendulum", &task, Verner9, [6, 12, 24]);
    assert_order("pendulum", &task, Gauss6::default(), [8, 16, 32]);
    assert_order("pendulum", &task, Gauss6 { sweeps: Some(3) }, [32, 64, 128]);
    assert_order(
        "pendulum",
        &task,
        ImplicitMidpoint::default(),
        [64, 128, 256],
    );
    assert_order("pendulum", &task, Ros2, [64, 128, 256]);
    assert_order("pendulum", &task, Rodas5P, [16, 32, 64]);
    assert_order("pendulum", &task, Radau5, [16, 32, 64]);
    assert_order("pendulum", &task, Radau9, [8, 12, 16]);
    let task = hunters();
    assert_order("hunters", &task, Dop853, [4, 8, 16]);
    assert_order("hunters", &task, Verner9, [4, 8, 16]);
    assert_order("hunters", &task, Rodas4, [128, 256, 512]);
}

#[test]
fn orders_on_the_oscillator_with_an_input_over_time() {
    let task = forced();
    assert_order("oscillator", &task, Rk4, [32, 64, 128]);
    assert_order("oscillator", &task, Tsit5, [16, 32, 64]);
    assert_order("oscillator", &task, Dop853, [4, 8, 16]);
    assert_order("oscillator", &task, Gauss6::default(), [8, 16, 32]);
    assert_order("oscillator", &task, Gauss6 { sweeps: Some(3) }, [8, 16, 32]);
    assert_order(
        "oscillator",
        &task,
        ImplicitMidpoint::default(),
        [32, 64, 128],
    );
    assert_order("oscillator", &task, Ros2, [64, 128, 256]);
    assert_order("oscillator", &task, Rodas4, [16, 32, 64]);
    assert_order("oscillator", &task, Rodas5P, [16, 32, 64]);
    assert_order("oscillator", &task, Radau5, [16, 32, 64]);
    assert_order("oscillator", &task, Radau9, [4, 6, 8]);
}

#[test]
fn orders_of_methods_for_smooth_problems_on_the_rigid_body() {
    let task = body();
    assert_order("body", &task, Rk4, [32, 64, 128]);
    assert_order("body", &task, Tsit5, [64, 128, 256]);
    assert_order("body", &task, Dop853, [4, 8, 16]);
    assert_order("body", &task, Gauss6::default(), [8, 16, 32]);
    assert_order("body", &task, Gauss6 { sweeps: Some(3) }, [32, 64, 128]);
}

/// What the sweeps leave falls with the power 9. What the method misses, of order 8, is so small that it shows alone where
/// an input is much faster than the system.
#[test]
fn the_order_of_sweeps_hides_that_of_the_method_but_for_fast_inputs() {
    assert_slope("pendulum", &pendulum(), Pirk8, [8, 16, 32], 9);
    assert_slope("hunters", &hunters(), Pirk8, [7, 14, 28], 9);
    assert_slope("body", &body(), Pirk8, [8, 16, 32], 9);
    assert_slope("oscillator", &forced(), Pirk8, [4, 8, 16], 9);
    for frequency in [20.0, 40.0, 60.0] {
        let steps = [1, 2, 4].map(|times| times * frequency as u32);
        assert_order("driven oscillator", &forced_at(frequency), Pirk8, steps);
    }
}

/// Rounding leaves three lengths of steps at which an order of 16 shows at all, too long ones for the slope to be exact: the
/// order is proven beside the coefficients. Here it is not less, nor much more than the 18 of the sweeps.
#[test]
fn the_highest_order_shows_down_to_rounding() {
    let slopes = [
        slope(&pendulum(), Pirk16, [3, 4, 5]),
        slope(&hunters(), Pirk16, [5, 6, 7]),
        slope(&body(), Pirk16, [4, 5, 6]),
    ];
    assert!(
        slopes.iter().all(|slope| (16.0..19.0).contains(slope)),
        "{slopes:?}"
    );
}

#[test]
fn orders_of_methods_for_stiff_problems_on_stiff_ones() {
    let task = kaps();
    assert_order(
        "problem of Kaps",
        &task,
        ImplicitMidpoint::default(),
        [32, 64, 128],
    );
    assert_order("problem of Kaps", &task, Ros2, [64, 128, 256]);
    assert_order("problem of Kaps", &task, Rodas4, [16, 32, 64]);
    assert_order("problem of Kaps", &task, Radau5, [8, 16, 32]);
    assert_order("problem of Kaps", &task, Radau9, [2, 3, 4]);
    let task = follower();
    assert_order("follower", &task, Rodas5P, [16, 32, 64]);
    assert_order("follower", &task, Radau5, [16, 32, 64]);
}

/// A difference quotient in place of the exact rate of the input keeps the order.
#[test]
fn an_input_without_its_rate_keeps_the_order() {
    let exact = forced();
    let task = Task {
        law: exact.law,
        input: Smooth(|t: f64| SVector::from([(2.0 * t).cos()])),
        runs: exact.runs,
    };
    assert_order("oscillator", &task, Ros2, [64, 128, 256]);
    assert_order("oscillator", &task, Rodas4, [16, 32, 64]);
    assert_order("oscillator", &task, Rodas5P, [16, 32, 64]);
}

/// Largest error in between, which falls with the order of the dense output.
fn assert_dense_order<S: Method>(method: S, steps: [u32; 2]) {
    let task = forced();
    let errors = steps.map(|steps| {
        let mut largest = 0.0_f64;
        Fixed::new(method, END / f64::from(steps))
            .integrate(
                &Written(task.law),
                &task.input,
                0.0,
                END,
                task.runs[0][0],
                |step| {
                    assert_eq!(step.at(step.start()), *step.first());
                    assert!((step.at(step.end()) - step.state()).norm() < 1e-14);
                    for fraction in [0.1, 0.3, 0.5, 0.7, 0.9] {
                        let t = step.start() + fraction * (step.end() - step.start());
                        largest = largest.max((step.at(t) - exact(t)).norm());
                    }
                },
            )
            .unwrap();
        largest
    });
    let [few, many] = steps.map(f64::from);
    let slope = (errors[0] / errors[1]).ln() / (many / few).ln();
    println!("{:<20}{steps:?} {errors:?} {slope:.2}", S::NAME);
    assert!(
        (slope - f64::from(S::DENSE_ORDER)).abs() < 0.3,
        "{}: {slope:.2} in place of {}",
        S::NAME,
        S::DENSE_ORDER
    );
}

#[test]
fn orders_in_between() {
    assert_dense_order(Rk4, [32, 64]);
    assert_dense_order(Tsit5, [32, 64]);
    assert_dense_order(Dop853, [8, 16]);
    assert_dense_order(Pirk8, [16, 32]);
    assert_dense_order(Pirk16, [4, 8]);
    assert_dense_order(Gauss6::default(), [32, 64]);
    assert_dense_order(ImplicitMidpoint::default(), [64, 128]);
    assert_dense_order(Ros2, [128, 256]);
    assert_dense_order(Rodas4, [32, 64]);
    assert_dense_order(Rodas5P, [32, 64]);
    assert_dense_order(Radau5, [32, 64]);
    assert_dense_order(Radau9, [8, 16]);
}

/// With the same steps, compensated sums in single precision lose less.
#[test]
fn compensated_sums_keep_single_precision() {
    let error = |fixed: Fixed<Rk4>| {
        let mut last = SVector::from([1.0_f32, 0.0]);
        fixed
            .integrate(&Written(Oscillator), &(), 0.0, 20.0, last, |step| {
                last = *step.state()
            })
            .unwrap();
        (last.map(f64::from) - SVector::from([20.0_f64.cos(), -20.0_f64.sin()])).norm()
    };
    let plain = error(Fixed::new(Rk4, 1.0 / 1024.0));
    let compensated = error(Fixed::new(Rk4, 1.0 / 1024.0).compensated());
    println!("plain {plain:.1e}, compensated {compensated:.1e}");
    assert!(
        compensated < 1e-6 && compensated < plain / 5.0,
        "{plain:e} {compensated:e}"
    );
}

#[test]
fn every_method_runs_in_single_precision() {
    fn error<S: Method>(method: S) -> f64 {
        let input = Smooth(|t: f32| SVector::from([(t + t).cos()]));
        let mut last = SVector::from([1.0_f32, 0.0]);
        Fixed::new(method, 1e-2)
            .compensated()
            .integrate(
                &Written(Oscillator),
                &input,
                0.0,
                END as f32,
                last,
                |step| last = *step.state(),
            )
            .unwrap();
        (last.map(f64::from) - exact(END)).norm()
    }
    let errors = [
        error(Rk4),
        error(Tsit5),
        error(Dop853),
        error(Verner9),
        error(Pirk8),
        error(Pirk16),
        error(Gauss6::default()),
        error(Gauss6 { sweeps: Some(3) }),
        error(Rodas4),
        error(Radau5),
        error(Radau9),
    ];
    println!("{errors:?}");
    assert!(errors.iter().all(|error| *error < 2e-6), "{errors:?}");
    // Its coefficients are large.
    assert!(error(Rodas5P) < 1e-5);
    let errors = [error(ImplicitMidpoint::default()), error(Ros2)];
    println!("{errors:?}");
    assert!(errors.iter().all(|error| *error < 2e-4), "{errors:?}");
}

/// The first derivative by the initial value, through the sweeps and factorisations of every family.
#[test]
fn every_family_runs_on_dual_numbers() {
    fn slope<S: Method>(method: S) -> f64 {
        let number = Dual::constant;
        let mut last = SVector::from([Dual::variable(1.0), number(0.0)]);
        Fixed::new(method, 1e-2)
            .integrate(
                &Written(Oscillator),
                &(),
                number(0.0),
                number(END),
                last,
                |step| last = *step.state(),
            )
            .unwrap();
        last[0].slope
    }
    let slopes = [
        slope(Dop853),
        slope(Verner9),
        slope(Pirk8),
        slope(Pirk16),
        slope(Rodas5P),
        slope(Gauss6::default()),
        slope(Radau5),
        slope(Radau9),
    ];
    for slope in slopes {
        assert!((slope - END.cos()).abs() < 1e-9, "{slopes:?}");
    }
}

/// Of a model at rest the values are exact at steps of any length, and its slopes are those of its neighbours.
#[test]
fn every_family_takes_steps_for_the_slopes_of_what_rests() {
    fn slopes<S: Estimating>(method: S) -> [f64; 2] {
        let number = Dual::constant;
        let start = SVector::from([Dual::variable(0.0), number(0.0)]);
        let mut last = start;
        Adaptive::new(method, 1e-9, 1e-9)
            .integrate(
                &Written(Oscillator),
                &(),
                number(0.0),
                number(10.0),
                start,
                |step| last = *step.state(),
            )
            .unwrap();
        last.map(|it| it.slope).into()
    }
    let all = [
        slopes(Tsit5),
        slopes(Dop853),
        slopes(Verner9),
        slopes(Pirk8),
        slopes(Pirk16),
        slopes(Ros2),
        slopes(Rodas4),
        slopes(Rodas5P),
        slopes(Radau5),
        slopes(Radau9),
    ];
    let (sine, cosine) = f64::sin_cos(10.0);
    for [way, velocity] in all {
        assert!((way - cosine).abs() < 1e-5, "{all:?}");
        assert!((velocity + sine).abs() < 1e-5, "{all:?}");
    }
}
