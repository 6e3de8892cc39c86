//! Dry friction.

use mbg_compare::{Comparison, Problem};
use mbg_runtime::{Adaptive, Integrator, Method, Radau5, Rodas5P, Stopped, System};
use nalgebra::SVector;

use super::models::{Belt, BeltParameters};
use super::{Expected, Found, Line, larger};

/// With this force to break away.
#[allow(clippy::expect_used, reason = "its own constants suit it")]
fn belt(breakaway: f64) -> Belt<f64> {
    Belt::new(BeltParameters {
        breakaway,
        ..BeltParameters::default()
    })
    .expect("forces and speeds above zero")
}

/// A block on a belt, with Coulomb's and with Stribeck's curve.
pub(crate) fn dry() -> Vec<Line> {
    let mut lines = Vec::new();
    for (case, breakaway) in [
        ("Coulomb friction on a belt", 2.0),
        ("Stribeck friction, stick and slip", 4.0),
    ] {
        let belt = belt(breakaway);
        let problem = Problem::new(case, &belt, &(), (0.0, 10.0), belt.initial_state())
            .at((1..=100).map(|k| 0.1 * f64::from(k)).collect::<Vec<_>>())
            .nominal([1.0, 0.1]);
        let comparison: Result<Comparison<'_, _, _, 2, 0, 1>, _> = Comparison::new(problem);
        fn run(
            belt: &Belt<f64>,
            comparison: &Comparison<'_, Belt<f64>, (), 2, 0, 1>,
            solver: &impl Integrator<2>,
        ) -> Result<Found, Stopped> {
            let (times, reference) = (&comparison.problem().times, comparison.reference());
            let (mut error, mut rows) = (0.0_f64, reference.states.iter());
            let statistics =
                solver.sample(belt, &(), 0.0, belt.initial_state(), times, |_t, x| {
                    if let Some(row) = rows.next() {
                        let apart: SVector<f64, 2> = x - row;
                        for (apart, size) in apart.iter().zip(reference.sizes) {
                            error = larger(error, apart.abs() / size);
                        }
                    }
                })?;
            Ok(Found::new(error, statistics))
        }
        let (radau, rodas) = (
            Adaptive::new(Radau5, 1e-7, 1e-8),
            Adaptive::new(Rodas5P, 1e-7, 1e-8),
        );
        let expected = Expected::Within(1e-4);
        let reference = "two methods at 1e-8";
        lines.push(Line::run((case, Radau5::NAME, reference), expected, || {
            comparison
                .as_ref()
                .map_or(Ok(Found::NONE), |it| run(&belt, it, &radau))
        }));
        lines.push(Line::run(
            (case, Rodas5P::NAME, reference),
            expected,
            || {
                comparison
                    .as_ref()
                    .map_or(Ok(Found::NONE), |it| run(&belt, it, &rodas))
            },
        ));
    }
    lines
}
