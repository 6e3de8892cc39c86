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

/// `atan(x)` is `atan2(x, 1)`, with the slope 1 / (1 + x²) however large `x` is.
#[test]
fn an_arc_tangent_has_its_slope() {
    let infinite = f64::INFINITY;
    let places = [0.0, 0.5, 2.0, -3.0, 1e200, infinite, -infinite];
    let slopes = places.map(|place| (place, 1.0 / (1.0 + place * place)));
    assert_slopes(&[("atan(f)", &slopes)]);
    for place in places {
        let found = -entries(&resisted("atan(f)"), &[0.75], &[place])[0];
        assert_eq!(found, place.atan());
    }
    let model = resisted("atan(f)");
    let routine = &model.program.routines[Routines::DERIVATIVE_AND_JACOBIAN];
    // The angle, a square, a sum and a quotient.
    assert_eq!(routine.operations(), 4);
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

/// A law whose slope at rest is zero has it there, although a power in it is infinitely steep.
#[test]
fn laws_are_flat_at_rest() {
    let blasius = 1.75 * 0.25_f64.powf(0.75);
    assert_slopes(&[
        (
            "f * sqrt(abs(f))",
            &[(0.0, 0.0), (-0.25, 0.75), (0.25, 0.75)],
        ),
        ("f * pow(abs(f), 0.5)", &[(0.0, 0.0), (0.25, 0.75)]),
        (
            "2.0 * f * pow(abs(f), 0.75)",
            &[(0.0, 0.0), (-0.25, 2.0 * blasius), (0.25, 2.0 * blasius)],
        ),
        (
            "f * pow(abs(3.0 * f), n)",
            &[(0.0, 0.0), (0.25, 3.0_f64.powf(0.75) * blasius)],
        ),
        (
            "pow(f * f, 0.75)",
            &[(0.0, 0.0), (-0.25, -0.75), (0.25, 0.75)],
        ),
        ("abs(f) * sqrt(abs(f)) + f", &[(0.0, 1.0), (-0.25, 0.25)]),
        (
            "(f - 1.0) * sqrt(abs(1.0 - f))",
            &[(1.0, 0.0), (1.25, 0.75)],
        ),
        ("sqrt(abs(f)) * pow(abs(f), 0.75)", &[(0.0, 0.0)]),
        // What is steep nowhere is left as it is.
        ("f * sqrt(f * f + 1.0)", &[(0.0, 1.0)]),
    ]);
}

/// Kinks and infinite slopes at rest are not made zero.
#[test]
fn slopes_that_laws_do_not_have_at_rest_stay_told() {
    for law in [
        "sqrt(abs(f))",
        "pow(f * f, 0.25)",
        "sqrt(f * f)",
        "sign(f) * sqrt(abs(f))",
    ] {
        let model = resisted(law);
        let found = entries(&model, &[0.75], &[0.0])[1];
        assert!(!found.is_finite(), "{law}: {found}");
    }
}

/// Drag along a vector, `√(fᵀ f) f`, has the slopes `(fᵀ f δ + f fᵀ) / √(fᵀ f)`, which vanish at rest.
#[test]
fn drag_of_a_vector_is_flat_at_rest() {
    for (law, power) in [
        ("sqrt(transpose(f) * f) * f", 0.5),
        ("pow(transpose(f) * f, 0.25) * f", 0.25),
    ] {
        let model = compiled(&format!(
            "model M {{ 1 v[3] {{ I m {{ inertia: 0.1 }} R r {{ effort: {law} }} }} }}"
        ));
        for momentum in [[0.0; 3], [0.03, 0.0, 0.0], [0.03, -0.04, 0.12]] {
            let found = entries(&model, &[], &momentum);
            let flow = momentum.map(|it| 10.0 * it);
            let square: f64 = flow.iter().map(|it| it * it).sum();
            for (row, column) in (0..9).map(|entry| (entry / 3, entry % 3)) {
                let own = if row == column {
                    square.powf(power)
                } else {
                    0.0
                };
                let least = f64::MIN_POSITIVE;
                let turned =
                    2.0 * power * flow[row] * flow[column] * square.powf(power) / square.max(least);
                let found = found[3 + 3 * row + column];
                let expected = -10.0 * (own + turned);
                assert!(
                    (found - expected).abs() < 1e-13,
                    "{law} at {flow:?}, {row} {column}: {found}, not {expected}"
                );
            }
        }
    }
}

/// Rates by mass action, written with chemical potentials, are products of amounts, also where nothing is left of one.
#[test]
fn mass_action_by_potentials_has_slopes_where_nothing_is_left() {
    let model = compiled(
        "model M { param heat = 2.5; param standard = 1.25;
            0 a { C ca { effort: heat * ln(q), initial: 1.0 } }
            0 b { C cb { effort: standard + heat * ln(q / 4.0), initial: 0.0 } }
            1 re[2] { R r { flow: [
                0.5 * (exp(2 * e[0] / heat) - exp(-e[1] / heat)),
                0.5 * (exp(2 * e[0] / heat) - exp(-e[1] / heat))
            ] } }
            a -> re[0]; re[1] -> b;
        }",
    );
    let back = 0.125 * 0.5_f64.exp();
    for [a, b] in [[0.75, 0.0], [0.0, 0.5], [0.25, -1e-9]] {
        let found = entries(&model, &[2.5, 1.25], &[a, b]);
        let rate = 0.5 * a * a - back * b;
        let expected = [-rate, rate, -a, back, a, -back];
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-15,
                "{a} {b}: {found}, not {expected}"
            );
        }
    }
}
