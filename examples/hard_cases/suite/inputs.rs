//! The gust of the paper, told of and not told of.

use mbg_runtime::{
    Adaptive, Dop853, Estimating, Input, Integrator, Radau5, Smooth, Stopped, System, Tsit5,
};
use nalgebra::Vector3;

use super::ins::gust as declared;
use super::ins_reference::PULSE;
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
