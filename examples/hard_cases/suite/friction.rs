//! Dry friction.

use mbg_compare::{Comparison, Problem};
use mbg_runtime::{Adaptive, Dop853, Integrator, Method, Radau5, Rodas5P, Stopped, System};
use nalgebra::SVector;

use super::models::{Belt, BeltParameters, HoldingBelt, HoldingBeltParameters};
use super::{Expected, Found, Line, larger};

/// Samples of a block on a belt, from rest.
fn compared<'a, S: System<f64, 2, 0, 1>>(
    case: &'static str,
    belt: &'a S,
) -> Option<Comparison<'a, S, (), 2, 0, 1>> {
    let problem = Problem::new(case, belt, &(), (0.0, 10.0), belt.initial_state())
        .at((1..=100).map(|k| 0.1 * f64::from(k)).collect::<Vec<_>>())
        .nominal([1.0, 0.1]);
    Comparison::new(problem).ok()
}

/// How far the samples of a method are from the reference, in sizes of the states.
fn run<S: System<f64, 2, 0, 1>>(
    belt: &S,
    comparison: Option<&Comparison<'_, S, (), 2, 0, 1>>,
    solver: &impl Integrator<2>,
) -> Result<Found, Stopped> {
    let Some(comparison) = comparison else {
        return Ok(Found::NONE);
    };
    let (times, reference) = (&comparison.problem().times, comparison.reference());
    let (mut error, mut rows) = (0.0_f64, reference.states.iter());
    let statistics = solver.sample(belt, &(), 0.0, belt.initial_state(), times, |_t, x| {
        if let Some(row) = rows.next() {
            let apart: SVector<f64, 2> = x - row;
            for (apart, size) in apart.iter().zip(reference.sizes) {
                error = larger(error, apart.abs() / size);
            }
        }
    })?;
    Ok(Found::new(error, statistics))
}

const REFERENCE: &str = "two methods at 1e-8";

/// A block on a belt, with friction that creeps at rest and with such that holds.
pub(crate) fn dry() -> Vec<Line> {
    let mut lines = Vec::new();
    for (case, breakaway) in [
        ("Coulomb friction on a belt", 2.0),
        ("Stribeck friction, stick and slip", 4.0),
    ] {
        creeping(case, breakaway, &mut lines);
    }
    for (case, breakaway) in [
        ("Coulomb friction that holds", 2.0),
        ("Stribeck friction that holds", 4.0),
    ] {
        holding(case, breakaway, &mut lines);
    }
    lines
}

#[allow(clippy::expect_used, reason = "its own constants suit it")]
fn creeping(case: &'static str, breakaway: f64, lines: &mut Vec<Line>) {
    let belt = Belt::<f64>::new(BeltParameters {
        breakaway,
        ..BeltParameters::default()
    })
    .expect("forces and speeds above zero");
    let comparison = compared(case, &belt);
    let expected = Expected::Within(1e-4);
    let radau = Adaptive::new(Radau5, 1e-7, 1e-8);
    let rodas = Adaptive::new(Rodas5P, 1e-7, 1e-8);
    lines.push(Line::run((case, Radau5::NAME, REFERENCE), expected, || {
        run(&belt, comparison.as_ref(), &radau)
    }));
    lines.push(Line::run(
        (case, Rodas5P::NAME, REFERENCE),
        expected,
        || run(&belt, comparison.as_ref(), &rodas),
    ));
}

#[allow(clippy::expect_used, reason = "its own constants suit it")]
fn holding(case: &'static str, breakaway: f64, lines: &mut Vec<Line>) {
    let belt = HoldingBelt::<f64>::new(HoldingBeltParameters {
        breakaway,
        ..HoldingBeltParameters::default()
    })
    .expect("forces and speeds above zero");
    let comparison = compared(case, &belt);
    let expected = Expected::Within(1e-5);
    let dormand = Adaptive::new(Dop853, 1e-7, 1e-8);
    let rodas = Adaptive::new(Rodas5P, 1e-7, 1e-8);
    lines.push(Line::run((case, Dop853::NAME, REFERENCE), expected, || {
        run(&belt, comparison.as_ref(), &dormand)
    }));
    lines.push(Line::run(
        (case, Rodas5P::NAME, REFERENCE),
        expected,
        || run(&belt, comparison.as_ref(), &rodas),
    ));
}
