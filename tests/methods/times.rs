//! Times of steps: state and time agree, and no piece of the input is too short.

use mbg_runtime::{
    Adaptive, Auto, Cause, Constant, Dop853, Estimating, Fixed, Input, Integrator, Pirk8, Pirk16,
    Pulse, Radau5, Radau9, Rk4, Rodas4, Rodas5P, Ros2, Smooth, Stopped, Tsit5, Variable, Verner9,
};
use nalgebra::SVector;

use crate::problems::{Law, Oscillator, Written};

/// `ẋ = u`.
#[derive(Clone, Copy)]
pub(super) struct Sum;

impl Law<1, 1> for Sum {
    const STATES: &'static [Variable] = &[Variable {
        name: "sum",
        unit: "",
    }];

    fn slope<T: mbg_runtime::Real>(&self, _: &SVector<T, 1>, u: &SVector<T, 1>) -> SVector<T, 1> {
        *u
    }
}

/// The rounding of time at the ends of many steps does not add up.
#[test]
fn state_and_time_agree_far_from_zero() {
    fn error<S: Estimating>(method: S) -> f64 {
        let (start, end) = (1e9, 1e9 + 0.03);
        let mut last = SVector::from([1.0, 0.0]);
        let solver = Adaptive {
            longest: 1e-5,
            ..Adaptive::new(method, 1e-9, 1e-9)
        };
        solver
            .integrate(&Written(Oscillator), &(), start, end, last, |step| {
                last = *step.state()
            })
            .unwrap();
        (last[1] + f64::sin(end - start)).abs()
    }
    let errors = [
        error(Tsit5),
        error(Dop853),
        error(Verner9),
        error(Pirk8),
        error(Pirk16),
        error(Ros2),
        error(Rodas4),
        error(Rodas5P),
        error(Radau5),
        error(Radau9),
    ];
    assert!(errors.iter().all(|error| *error < 1e-11), "{errors:?}");
}

#[test]
fn state_and_time_agree_in_single_precision() {
    let mut last = SVector::from([1.0_f32, 0.0]);
    let solver = Adaptive {
        longest: 0.01,
        ..Adaptive::new(Tsit5, 1e-4, 1e-5)
    };
    solver
        .integrate(&Written(Oscillator), &(), 0.0, 1000.0, last, |step| {
            last = *step.state()
        })
        .unwrap();
    let error = f64::from(last[0]) - f64::cos(1000.0);
    // What the sums of 100 000 states are rounded by.
    assert!(error.abs() < 2e-3, "{error}");
}

/// Times between the same powers of two are rounded alike, so that steps at the limit have few lengths, each with its factors.
#[test]
fn factors_serve_all_steps_of_one_length() {
    let solver = Adaptive {
        longest: 1e-3,
        ..Adaptive::new(Radau5, 1e-6, 1e-6)
    };
    let start = SVector::from([1.0, 0.0]);
    let statistics = solver
        .integrate(&Written(Oscillator), &(), 1e3, 1e3 + 2.0, start, |_| ())
        .unwrap();
    assert!(statistics.steps > 1900);
    assert!(statistics.factorisations < 40, "{statistics:?}");
}

/// The sum of one over a run.
fn counted(solver: impl Integrator<1>, start: f64, end: f64) -> Result<f64, Stopped> {
    let one = mbg_runtime::Constant(SVector::from([1.0]));
    let mut last = SVector::from([0.0]);
    solver.integrate(&Written(Sum), &one, start, end, last, |step| {
        last = *step.state()
    })?;
    Ok(last[0])
}

#[test]
fn no_run_is_too_short() {
    let adaptive = Adaptive::new(Tsit5, 1e-6, 1e-6);
    for start in [0.0, 1.0, -1e9, 1e9_f64] {
        let next = if start == 0.0 {
            1e-300
        } else {
            start.next_up()
        };
        let after = next.next_up().next_up();
        for end in [next, after, start + 1e-5] {
            let way = end - start;
            let assert_counts = |found: Result<f64, Stopped>| {
                let found = found.unwrap();
                assert!(
                    (found - way).abs() <= 1e-12 * way,
                    "{start} {way:e} {found:e}"
                );
            };
            assert_counts(counted(adaptive, start, end));
            assert_counts(counted(Auto::new(1e-6, 1e-6), start, end));
            assert_counts(counted(Adaptive::new(Radau5, 1e-6, 1e-6), start, end));
            assert_counts(counted(Fixed::new(Rk4, 1e-3), start, end));
        }
    }
}

/// One for a millisecond, zero for the next; the jumps are the nearest times of single precision.
struct Switched;

impl Switched {
    fn number(t: f32) -> i64 {
        (f64::from(t) * 1e3).round() as i64
    }
}

impl Input<f32, 1> for Switched {
    fn value(&self, _: f32, since: f32) -> SVector<f32, 1> {
        let is_on = Self::number(since) % 2 == 0;
        SVector::from([f32::from(u8::from(is_on))])
    }

    fn next_jump(&self, t: f32) -> Option<f32> {
        (Self::number(t)..)
            .map(|number| (number as f64 * 1e-3) as f32)
            .find(|jump| *jump > t)
    }

    fn is_constant_between_jumps(&self) -> bool {
        true
    }
}

/// Between two jumps are two to four times that single precision knows.
#[test]
fn every_jump_counts_however_coarse_time_is() {
    for start in [2049.0, 4097.0] {
        let end = start + 2.0_f32;
        let mut last = SVector::from([0.0]);
        Adaptive::new(Tsit5, 1e-4, 1e-5)
            .integrate(&Written(Sum), &Switched, start, end, last, |step| {
                last = *step.state()
            })
            .unwrap();
        assert!((last[0] - 1.0).abs() < 0.01, "{start}: {}", last[0]);
    }
}

/// An input that is chosen while running.
#[test]
fn inputs_may_be_of_different_types() {
    let quarter = Constant(SVector::from([0.25]));
    let (start, end) = (1.0, 1.5);
    let pulse = Pulse {
        amplitude: SVector::from([2.0]),
        start,
        end,
    };
    let inputs: [(&dyn Input<f64, 1>, f64); 2] = [(&quarter, 0.5), (&pulse, 1.0)];
    let begin = SVector::from([0.0]);
    for (input, way) in inputs {
        let mut sums = [begin; 3];
        let [first, second, third] = &mut sums;
        let system = &Written(Sum);
        Adaptive::new(Radau5, 1e-6, 1e-6)
            .integrate(system, input, 0.0, 2.0, begin, |step| {
                *first = *step.state()
            })
            .unwrap();
        Auto::new(1e-6, 1e-6)
            .sample(system, input, 0.0, begin, &[2.0], |_, x| *second = *x)
            .unwrap();
        Rk4::fixed(system, input, 0.0, 2.0, 0.1, begin, |_, x| *third = *x).unwrap();
        assert!(
            sums.iter().all(|sum| (sum[0] - way).abs() < 1e-12),
            "{sums:?}"
        );
    }
}

#[test]
fn a_pulse_that_ends_before_it_starts_is_refused() {
    let (start, end) = (1.5, 1.0);
    let pulse = Pulse {
        amplitude: SVector::from([2.0]),
        start,
        end,
    };
    let begin = SVector::from([0.0]);
    let run = Fixed::new(Rk4, 0.1).integrate(&Written(Sum), &pulse, 0.0, 2.0, begin, |_| ());
    assert!(matches!(run.unwrap_err().cause, Cause::Argument(_)));
}

#[test]
fn times_that_cannot_be_stepped_through_are_refused() {
    let solver = Adaptive::new(Tsit5, 1e-6, 1e-6);
    let too_far = counted(solver, -1e308, 1e308).unwrap_err();
    assert!(matches!(too_far.cause, Cause::Argument(_)), "{too_far}");
    let longest = 1e-17;
    let stuck = counted(Adaptive { longest, ..solver }, 1.0, 2.0).unwrap_err();
    assert_eq!((stuck.cause, stuck.time), (Cause::StepTooSmall, 1.0));
    // A first step may be any: time's own is the least.
    let first = Some(1e-300);
    let found = counted(Adaptive { first, ..solver }, 1.0, 2.0).unwrap();
    assert!((found - 1.0).abs() < 1e-12);
}

#[test]
fn times_of_samples_are_told_as_that() {
    let solver = Adaptive::new(Tsit5, 1e-6, 1e-6);
    let refused = |times: &[f64]| {
        let start = SVector::from([1.0, 0.0]);
        let run = solver.sample(&Written(Oscillator), &(), 1.0, start, times, |_, _| {});
        run.unwrap_err().to_string()
    };
    assert_eq!(
        refused(&[1.5, f64::NAN]),
        "stopped at t = 1: the times of the start and of samples must be finite, and so must their distance"
    );
    assert_eq!(
        refused(&[0.5]),
        "stopped at t = 0.5: no sample may be before the start"
    );
    assert_eq!(
        refused(&[2.0, 1.5]),
        "stopped at t = 1.5: the times of samples must ascend"
    );
}

/// Nobody tells of this pulse: no step may be longer than half of it.
#[test]
fn the_longest_step_of_an_automatic_choice_sees_a_short_pulse() {
    let length = 1e-3;
    let within = move |t: f64| (5.0..5.0 + length).contains(&t);
    let input = Smooth(move |t| SVector::from([if within(t) { 1.0 / length } else { 0.0 }]));
    let mut last = SVector::from([0.0, 0.0]);
    let solver = Auto {
        longest: 0.5 * length,
        ..Auto::new(1e-6, 1e-6)
    };
    solver
        .integrate(&Written(Oscillator), &input, 0.0, 10.0, last, |step| {
            last = *step.state()
        })
        .unwrap();
    let error = last[0] - f64::sin(5.0 - 0.5 * length);
    assert!(error.abs() < 1e-3, "{error}");
}

/// A run over many jumps of an input may need more steps than a million; how many is a setting.
#[test]
fn the_steps_of_an_automatic_choice_are_limited() {
    let input = Smooth(|_: f64| SVector::from([0.0]));
    let run = |most| {
        let solver = Auto {
            most,
            ..Auto::new(1e-6, 1e-6)
        };
        let start = SVector::from([1.0, 0.0]);
        solver.integrate(&Written(Oscillator), &input, 0.0, 10.0, start, |_| ())
    };
    let steps = run(1_000_000).unwrap().steps;
    let stopped = run(5).unwrap_err();
    assert!(
        steps > 5 && matches!(stopped.cause, Cause::TooManySteps { .. }),
        "{stopped}"
    );
    assert!(stopped.to_string().contains("`most`"), "{stopped}");
}
