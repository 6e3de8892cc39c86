//! Chaos, closed loops near singular positions, and impacts.

use std::f64::consts::PI;

use mbg_runtime::{
    Adaptive, Direction, Dop853, Integrator, Radau9, Statistics, Stopped, System, Tsit5,
};
use nalgebra::SVector;

use super::double_pendulum::DoublePendulum;
use super::models::{FourBars2, FourBars2Parameters, Parallelogram, ParallelogramParameters};
use super::problems::{Oscillator, Written};
use super::{Expected, Found, Line, apart, larger};

/// Errors grow up to a million times within 10 s, those of the reference too.
pub(crate) fn double_pendulum() -> Vec<Line> {
    // By a Taylor series in multiple precision.
    let expected = [
        0.299_381_026_131_562_8,
        -3.204_687_109_922_974_6,
        -3.821_686_311_117_514,
        -0.046_064_713_430_667_89,
    ];
    let start = DoublePendulum::start();
    let run = |tolerance: f64| {
        let mut last = start;
        let solver = Adaptive::new(Dop853, tolerance, tolerance);
        let keep = |step: &mut mbg_runtime::Step<'_, f64, 4>| last = *step.state();
        let statistics = solver.integrate(&Written(DoublePendulum), &(), 0.0, 10.0, start, keep)?;
        Ok(Found::new(apart(last.as_slice(), &expected), statistics))
    };
    let case = "chaotic double pendulum, 10 s";
    let reference = "multiple precision";
    vec![
        Line::run(
            (case, "Dop853 at 1e-8", reference),
            Expected::Within(1e-2),
            || run(1e-8),
        ),
        Line::run(
            (case, "Dop853 at 1e-12", reference),
            Expected::Within(1e-6),
            || run(1e-12),
        ),
    ]
}

/// Energy over 10 s, from 200 rates of the cranks at which the loops pass positions where their equations become
/// dependent; every run must arrive.
fn energy(solver: &impl Integrator<10>) -> Result<Found, Stopped> {
    let Ok(system) = FourBars2::new(FourBars2Parameters::default()) else {
        return Ok(Found::NONE);
    };
    let meta = FourBars2::<f64>::META;
    let balance = meta
        .outputs
        .iter()
        .position(|it| it.name.ends_with("balance"))
        .unwrap_or(0);
    let total = |x: &SVector<f64, 10>| {
        system.energy(0.0, x) + system.output(0.0, x, &SVector::zeros(), &mut ())[balance]
    };
    let mut found = Found {
        error: 0.0,
        steps: 0,
    };
    for trial in 0..200 {
        let rate = 0.5 + 0.05 * f64::from(trial);
        let mut start = system.initial_state();
        let states = meta.states.iter().enumerate();
        let rates = states.filter(|(_, it)| it.name.ends_with("rate.f"));
        for (link, (place, _)) in rates.enumerate() {
            start[place] = if link <= 2 { rate } else { -rate };
        }
        let mut last = start;
        let keep = |step: &mut mbg_runtime::Step<'_, f64, 10>| last = *step.state();
        let statistics = solver.integrate(&system, &(), 0.0, 10.0, start, keep)?;
        let change = (total(&last) / total(&start) - 1.0).abs();
        found.error = larger(found.error, change);
        found.steps += statistics.steps + statistics.rejected;
    }
    Ok(found)
}

/// The angles of both cranks of a parallelogram after 20 s: through the lines in which it may turn over they stay equal.
fn parallelogram(solver: &impl Integrator<6>) -> Result<Found, Stopped> {
    let Ok(system) = Parallelogram::new(ParallelogramParameters::default()) else {
        return Ok(Found::NONE);
    };
    // By a Taylor series in multiple precision, of the pendulum that it then is.
    let expected = [-2.840_397_499_998_357; 2];
    let start = system.initial_state();
    let mut last = start;
    let keep = |step: &mut mbg_runtime::Step<'_, f64, 6>| last = *step.state();
    let statistics = solver.integrate(&system, &(), 0.0, 20.0, start, keep)?;
    let angles = system.output(20.0, &last, &SVector::zeros(), &mut ());
    Ok(Found::new(apart(angles.as_slice(), &expected), statistics))
}

/// Two four-bars that turn over, and a parallelogram that might.
pub(crate) fn singular_loops() -> Vec<Line> {
    let case = "four-bars through singular lines";
    let parallel = "parallelogram through its lines";
    vec![
        Line::run(
            (parallel, "Dop853 at 1e-8", "multiple precision"),
            Expected::Within(1e-5),
            || parallelogram(&Adaptive::new(Dop853, 1e-8, 1e-8)),
        ),
        Line::run(
            (parallel, "Radau 9 at 1e-8", "multiple precision"),
            Expected::Within(1e-5),
            || parallelogram(&Adaptive::new(Radau9, 1e-8, 1e-8)),
        ),
        Line::run(
            (case, "Tsit5 at 1e-6", "energy"),
            Expected::Within(5e-5),
            || energy(&Adaptive::new(Tsit5, 1e-6, 1e-6)),
        ),
        Line::run(
            (case, "Tsit5 at 1e-8", "energy"),
            Expected::Within(5e-7),
            || energy(&Adaptive::new(Tsit5, 1e-8, 1e-8)),
        ),
    ]
}

/// A mass on a spring that a wall throws back with 0.8 of its speed, ten times over.
pub(crate) fn impacts() -> Vec<Line> {
    let run = || {
        let solver = Adaptive::new(Dop853, 1e-12, 1e-14);
        let (mut t, mut x, mut speed) = (0.0, SVector::from([1.0, 0.0]), 1.0);
        let (mut error, mut sum) = (0.0_f64, Statistics::default());
        for impact in 0..10 {
            let event = (Direction::Falling, |_t: f64, x: &SVector<f64, 2>| x[0]);
            let arrival = solver.until(&Written(Oscillator), &(), t, 100.0, x, event, |_| ())?;
            let expected = PI * (0.5 + f64::from(impact));
            let found = [arrival.time, arrival.state[1]];
            error = larger(error, apart(&found, &[expected, -speed]));
            sum.steps += arrival.statistics.steps;
            (t, x) = (arrival.time, arrival.state);
            x[1] *= -0.8;
            speed *= 0.8;
        }
        Ok(Found::new(error, sum))
    };
    vec![Line::run(
        ("ten impacts as events", "Dop853", "closed form"),
        Expected::Within(1e-9),
        run,
    )]
}
