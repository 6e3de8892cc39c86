//! Dry friction.

use mbg_compare::{Comparison, Problem};
use mbg_runtime::{Adaptive, Dop853, Estimating, Integrator, Radau5, Rodas5P, Stopped, System};
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

/// A block on a belt, with friction that creeps at rest and with such that holds.
pub(crate) fn dry() -> Vec<Line> {
    let lines = [
        creeping("Coulomb friction on a belt", 2.0),
        creeping("Stribeck friction, stick and slip", 4.0),
        holding("Coulomb friction that holds", 2.0),
        holding("Stribeck friction that holds", 4.0),
    ];
    lines.into_iter().flatten().collect()
}

/// A method to seven digits.
fn line<S: System<f64, 2, 0, 1>, M: Estimating>(
    method: M,
    (case, expected): (&'static str, Expected),
    belt: &S,
    comparison: Option<&Comparison<'_, S, (), 2, 0, 1>>,
) -> Line {
    Line::run((case, M::NAME, "two methods at 1e-8"), expected, || {
        run(belt, comparison, &Adaptive::new(method, 1e-7, 1e-8))
    })
}

#[allow(clippy::expect_used, reason = "its own constants suit it")]
fn creeping(case: &'static str, breakaway: f64) -> [Line; 2] {
    let parameters = BeltParameters {
        breakaway,
        ..BeltParameters::default()
    };
    let belt = Belt::<f64>::new(parameters).expect("forces and speeds above zero");
    let (comparison, of) = (compared(case, &belt), (case, Expected::Within(1e-4)));
    [
        line(Radau5, of, &belt, comparison.as_ref()),
        line(Rodas5P, of, &belt, comparison.as_ref()),
    ]
}

#[allow(clippy::expect_used, reason = "its own constants suit it")]
fn holding(case: &'static str, breakaway: f64) -> [Line; 2] {
    let parameters = HoldingBeltParameters {
        breakaway,
        ..HoldingBeltParameters::default()
    };
    let belt = HoldingBelt::<f64>::new(parameters).expect("forces and speeds above zero");
    let (comparison, of) = (compared(case, &belt), (case, Expected::Within(1e-5)));
    [
        line(Dop853, of, &belt, comparison.as_ref()),
        line(Rodas5P, of, &belt, comparison.as_ref()),
    ]
}
