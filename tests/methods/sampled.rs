//! Inputs given by samples: each piece counts from its time to its end.

use mbg_runtime::{
    Adaptive, Auto, Dop853, Fixed, Integrator, Radau5, Real, Rk4, Rodas5P, Sampled, Statistics,
    Tsit5,
};
use nalgebra::SVector;

use super::times::Sum;
use crate::problems::Written;

/// A log of 1000 samples at times that are not evenly apart, with levels that stay for some of them.
fn log() -> (Vec<f64>, Vec<SVector<f64, 1>>) {
    let time = |k: f64| 0.01 * k + 0.004 * (1.7 * k).sin();
    let value = |k: f64| (3.0 * (0.02 * k).sin() + (0.9 * k).cos()).round();
    let numbers = (0..1000).map(f64::from);
    let values = numbers.clone().map(|k| SVector::from([value(k)]));
    (numbers.map(time).collect(), values.collect())
}

/// What the samples add up to from the first to the last, by the value over each piece.
fn area(times: &[f64], values: &[SVector<f64, 1>], mean: impl Fn(f64, f64) -> f64) -> f64 {
    let ends = times.windows(2).zip(values.windows(2));
    ends.map(|(t, u)| (t[1] - t[0]) * mean(u[0][0], u[1][0]))
        .sum()
}

/// The integral of an input over a run.
fn integral<T: Real>(
    solver: impl Integrator<1>,
    input: &Sampled<'_, T, 1>,
    [start, end]: [T; 2],
) -> (T, Statistics) {
    let mut last = SVector::from([T::from_f64(0.0)]);
    let run = solver.integrate(&Written(Sum), input, start, end, last, |step| {
        last = *step.state()
    });
    (last[0], run.unwrap())
}

#[test]
fn a_log_is_integrated_to_rounding() {
    let (times, values) = log();
    let held = Sampled::held(&times, &values).unwrap();
    let linear = Sampled::linear(&times, &values).unwrap();
    let (first, last) = (values[0][0], values[999][0]);
    // A second before the log and one behind it.
    let run = [times[0] - 1.0, times[999] + 1.0];
    let steps = area(&times, &values, |a, _| a) + first + last;
    let lines = area(&times, &values, |a, b| 0.5 * (a + b)) + first + last;
    let changes = |window: &[SVector<f64, 1>]| window[0] != window[1];
    let jumps = values.windows(2).filter(|it| changes(it)).count() as u64;
    assert!(jumps > 300 && jumps < 900, "{jumps}");
    for (input, expected) in [(&held, steps), (&linear, lines)] {
        let found = [
            integral(Fixed::new(Rk4, 0.5), input, run),
            integral(Adaptive::new(Dop853, 1e-6, 1e-6), input, run),
            integral(Adaptive::new(Tsit5, 1e-6, 1e-6), input, run),
            integral(Adaptive::new(Rodas5P, 1e-6, 1e-6), input, run),
            integral(Adaptive::new(Radau5, 1e-6, 1e-6), input, run),
            integral(Auto::new(1e-6, 1e-6), input, run),
        ];
        for (found, _) in found {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
    let (_, statistics) = integral(Fixed::new(Rk4, 20.0), &held, run);
    assert_eq!(statistics.steps, jumps + 1, "one for each piece");
}

#[test]
fn a_log_is_integrated_in_single_precision() {
    let (times, values) = log();
    let times: Vec<f32> = times.iter().map(|it| *it as f32).collect();
    let values: Vec<SVector<f32, 1>> = values.iter().map(|it| it.map(|it| it as f32)).collect();
    let wide: Vec<f64> = times.iter().map(|it| f64::from(*it)).collect();
    let tall: Vec<SVector<f64, 1>> = values.iter().map(|it| it.map(f64::from)).collect();
    let run = [times[0], times[999]];
    let held = Sampled::held(&times, &values).unwrap();
    let linear = Sampled::linear(&times, &values).unwrap();
    for (input, expected) in [
        (held, area(&wide, &tall, |a, _| a)),
        (linear, area(&wide, &tall, |a, b| 0.5 * (a + b))),
    ] {
        for found in [
            integral(Fixed::new(Rk4, 0.5), &input, run).0,
            integral(Adaptive::new(Dop853, 1e-4, 1e-5), &input, run).0,
            integral(Adaptive::new(Rodas5P, 1e-4, 1e-5), &input, run).0,
        ] {
            let error = f64::from(found) - expected;
            assert!(error.abs() < 1e-4, "{found} {expected}");
        }
    }
}
