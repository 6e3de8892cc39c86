//! What is short beside the steps over rest: the gust of the paper, told of and not told of, and laws that pulse.

use mbg_runtime::{
    Adaptive, Dop853, Estimating, Input, Integrator, Radau5, Smooth, Stopped, System, Tsit5,
};
use nalgebra::Vector3;

use super::ins::gust as declared;
use super::ins_reference::PULSE;
use super::models::{
    Cam, CamParameters, Rubbed, RubbedParameters, Sledge, SledgeParameters, Slide, SlideParameters,
};
use super::stiffness::ins_model;
use super::{Expected, Found, Line, apart};

fn angles(solver: &impl Integrator<9>, input: &impl Input<f64, 3>) -> Result<Found, Stopped> {
    let model = ins_model();
    let start = model.initial_state();
    let mut last = start;
    let keep = |step: &mut mbg_runtime::Step<'_, f64, 9>| last = *step.state();
    let end = &PULSE[PULSE.len() - 1];
    let statistics = solver.integrate(&model, input, 0.0, end.time, start, keep)?;
    Ok(Found::new(
        apart(&last.as_slice()[6..9], &end.alpha),
        statistics,
    ))
}

fn both<S: Estimating>(method: S, lines: &mut Vec<Line>) {
    // Momenta, then angles.
    let nominal = [1e4, 1e4, 1e4, 1.0, 1.0, 1.0, 1e-2, 1e-2, 1e-2];
    let solver = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(method, 1e-8, 1e-8)
    };
    let reference = "multiple precision";
    lines.push(Line::run(
        ("gust, its jumps declared", S::NAME, reference),
        Expected::Within(1e-6),
        || angles(&solver, &declared(0.1)),
    ));
    let undeclared = Smooth(|t: f64| {
        if (1.0..1.1).contains(&t) {
            Vector3::new(5000.0, 1000.0, 10000.0)
        } else {
            Vector3::zeros()
        }
    });
    lines.push(Line::run(
        ("gust, its jumps undeclared", S::NAME, reference),
        Expected::Within(1e-4),
        || angles(&solver, &undeclared),
    ));
}

/// Of the gust a run at rest would see nothing in its long steps.
pub(crate) fn gust() -> Vec<Line> {
    let mut lines = Vec::new();
    both(Tsit5, &mut lines);
    both(Dop853, &mut lines);
    both(Radau5, &mut lines);
    lines
}

/// A slide that is held back at three places of its way, 30 s at rest otherwise.
fn slide(solver: &impl Integrator<2>) -> Result<Found, Stopped> {
    #[allow(clippy::expect_used, reason = "its own constants suit it")]
    let model = Slide::<f64>::new(SlideParameters::default()).expect("a width above zero");
    let mut last = model.initial_state();
    let statistics = solver.integrate(&model, &(), 0.0, 30.0, last, |step| last = *step.state())?;
    // Its energy falls by the work of a range, a triangle and another one.
    let energy = 8.0 - 10.0 * 0.2 - 20.0 * 0.1 - 10.0 * 0.15;
    Ok(Found::new(
        (last[0] - f64::sqrt(2.0 * energy)).abs(),
        statistics,
    ))
}

/// A shaft that a cam holds back for 1 % of each round.
fn cam(solver: &impl Integrator<2>) -> Result<Found, Stopped> {
    #[allow(clippy::expect_used, reason = "it has no parameter")]
    let model = Cam::<f64>::new(CamParameters::default()).expect("no parameter");
    let mut last = model.initial_state();
    let statistics = solver.integrate(&model, &(), 0.0, 10.0, last, |step| last = *step.state())?;
    let [rate, angle] = [last[0], last[1]];
    // It begins on the top of the cam, and ends between two.
    let rounds = (angle / core::f64::consts::TAU).floor();
    let way = f64::acos(0.999) * (1.0 + 2.0 * rounds);
    Ok(Found::new(
        (rate - (400.0 - 2.0 * way).sqrt()).abs(),
        statistics,
    ))
}

/// A sledge that is held back near two posts beside its way, 30 s at rest otherwise.
fn sledge(solver: &impl Integrator<4>) -> Result<Found, Stopped> {
    #[allow(clippy::expect_used, reason = "its own constants suit it")]
    let model = Sledge::<f64>::new(SledgeParameters::default()).expect("a width above zero");
    let mut last = model.initial_state();
    let statistics = solver.integrate(&model, &(), 0.0, 30.0, last, |step| last = *step.state())?;
    // Its energy falls by the work along two chords.
    let energy = 8.0 - 5.0 * 0.8 - 8.0 * 0.3;
    Ok(Found::new(
        (last[0] - f64::sqrt(2.0 * energy)).abs(),
        statistics,
    ))
}

/// A block that rubs on a floor, for fifty turns.
fn rubbed(solver: &impl Integrator<2>) -> Result<Found, Stopped> {
    #[allow(clippy::expect_used, reason = "it has no parameter")]
    let model = Rubbed::<f64>::new(RubbedParameters::default()).expect("no parameter");
    let mut last = model.initial_state();
    let end = (50.0 + 1.0 / 3.0) * core::f64::consts::PI;
    let statistics = solver.integrate(&model, &(), 0.0, end, last, |step| last = *step.state())?;
    // Each half swing is 0.2 m shorter, about a place 0.1 m beside the middle.
    let expected = 0.1 + (10.3 - 0.2 * 50.0 - 0.1) * 0.5;
    Ok(Found::new((last[1] - expected).abs(), statistics))
}

fn pulsing<S: Estimating>(method: S, lines: &mut Vec<Line>) {
    let solver = Adaptive::new(method, 1e-8, 1e-8);
    lines.push(Line::run(
        ("short ranges of a long way", S::NAME, "the work of forces"),
        Expected::Within(1e-5),
        || slide(&solver),
    ));
    lines.push(Line::run(
        ("posts beside a long way", S::NAME, "the work of forces"),
        Expected::Within(1e-5),
        || sledge(&solver),
    ));
    lines.push(Line::run(
        ("a cam on a free shaft", S::NAME, "the work of torques"),
        Expected::Within(1e-4),
        || cam(&solver),
    ));
    lines.push(Line::run(
        ("friction at fifty turns", S::NAME, "swings in closed form"),
        Expected::Within(1e-5),
        || rubbed(&solver),
    ));
}

/// Laws that pulse over a state, while nothing else moves.
pub(crate) fn pulses() -> Vec<Line> {
    let mut lines = Vec::new();
    pulsing(Tsit5, &mut lines);
    pulsing(Dop853, &mut lines);
    pulsing(Radau5, &mut lines);
    lines
}
