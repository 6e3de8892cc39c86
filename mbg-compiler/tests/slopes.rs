//! Slopes of laws where a part of them has none: Jacobians are numbers wherever the law has a slope.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{self, Arguments};
use models::compiled;

/// The derivative of a model, and its Jacobian by rows.
fn entries(model: &Compiled, parameters: &[f64], state: &[f64]) -> Vec<f64> {
    let arguments = Arguments {
        parameters,
        time: 0.0,
        state,
        input: &[],
    };
    let routine = Routines::DERIVATIVE_AND_JACOBIAN;
    program::evaluate(&model.program, routine, &arguments)
}

/// A mass with a resistance of this law, in which `n` is a parameter.
fn resisted(law: &str) -> Compiled {
    compiled(&format!(
        "model M {{ param n = 0.75; 1 v {{ I m {{ inertia: 1.0 }} R r {{ effort: {law} }} }} }}"
    ))
}

/// A law, and places with its slopes there.
type Case<'a> = (&'a str, &'a [(f64, f64)]);

#[track_caller]
fn assert_slopes(cases: &[Case<'_>]) {
    for (law, slopes) in cases {
        let model = resisted(law);
        for (place, expected) in *slopes {
            let found = -entries(&model, &[0.75], &[*place])[1];
            assert!(
                found == *expected || (found - expected).abs() < 1e-14,
                "{law} at {place}: {found}, not {expected}"
            );
        }
    }
}

/// Infinite slopes of functions of what does not change are left out, however choices are nested and added.
#[test]
fn laws_are_flat_where_choices_make_them_so() {
    let (inf, steep) = (f64::INFINITY, 0.5 / 0.25_f64.sqrt());
    let arc = 1.0 / 0.75_f64.sqrt();
    assert_slopes(&[
        (
            "sqrt(min(max(f, 0.0), 1.0)) + 0.1 * f",
            &[(-1.0, 0.1), (0.25, steep + 0.1), (2.0, 0.1)],
        ),
        (
            "sqrt(max(min(f, 1.0), 0.0))",
            &[(-1.0, 0.0), (0.25, steep), (2.0, 0.0)],
        ),
        (
            "pow(min(max(f, 0.0), 1.0), 0.5)",
            &[(-1.0, 0.0), (0.25, steep)],
        ),
        (
            "asin(min(max(f, -1.0), 1.0))",
            &[(-2.0, 0.0), (0.5, arc), (2.0, 0.0)],
        ),
        (
            "acos(max(min(f, 1.0), -1.0))",
            &[(-2.0, 0.0), (0.5, -arc), (2.0, 0.0)],
        ),
        (
            "sqrt(max(f, 0.0) + max(f - 1.0, 0.0))",
            &[(-1.0, 0.0), (0.25, steep), (2.5, 0.5)],
        ),
        (
            "sqrt(interpolate(f, [-1.0, 0.0, 1.0, 2.0], [0.0, 0.0, 1.0, 1.0]))",
            &[(-0.5, 0.0), (0.25, steep), (1.5, 0.0)],
        ),
        (
            "sqrt(if f < -1.0 { -1.0 - f } else { max(f, 0.0) })",
            &[(-1.25, -steep), (-0.5, 0.0), (0.25, steep)],
        ),
        // Infinite slopes of what changes stay told.
        ("sqrt(f)", &[(0.0, inf)]),
        (
            "sqrt(0.0 - min(f, 0.0) + max(f, 0.0))",
            &[(-0.25, -steep), (0.25, steep)],
        ),
    ]);
}
