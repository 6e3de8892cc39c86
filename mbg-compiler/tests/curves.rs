//! Curves in laws: `interpolate`.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::compile::Routines;
use mbg_compiler::program::{self, Arguments};
use models::{compiled, mistake};

/// A routine of a model at a state.
fn evaluated(text: &str, routine: usize, parameters: &[f64], state: &[f64]) -> Vec<f64> {
    let arguments = Arguments {
        parameters,
        time: 0.0,
        state,
        input: &[],
    };
    program::evaluate(&compiled(text).program, routine, &arguments)
}

/// A curve and the straight lines that it must be.
fn lines(points: &[(f64, f64)], x: f64) -> f64 {
    let next = points.iter().position(|(place, _)| x <= *place);
    let next = next.unwrap_or(points.len()).clamp(1, points.len() - 1);
    let [(a, u), (b, v)] = [points[next - 1], points[next]];
    u + (v - u) / (b - a) * (x - a)
}

const POINTS: [(f64, f64); 6] = [
    (-2.0, -3.0),
    (-1.0, -1.0),
    (0.5, 0.0),
    (1.0, 0.75),
    (2.0, 0.75),
    (4.0, 2.5),
];
const CURVE: &str = "[-2.0, -1, 0.5, 1, 2, 4.0], [-3, -1.0, 0, 0.75, 0.75, 2.5]";
const PLACES: [f64; 14] = [
    -9.0, -2.0, -1.5, -1.0, -0.2, 0.5, 0.6, 1.0, 1.3, 2.0, 2.7, 4.0, 4.5, 1e3,
];

#[test]
fn curves_are_lines_from_point_to_point() {
    let text = format!(
        "model M {{ 1 v {{ I m {{ inertia: 1.0 }} }} output y = interpolate(m.p, {CURVE}); }}"
    );
    for x in PLACES {
        let found = evaluated(&text, Routines::OUTPUT, &[], &[x])[0];
        let expected = lines(&POINTS, x);
        assert!(
            (found - expected).abs() <= 1e-15 * expected.abs(),
            "{x}: {found}, not {expected}"
        );
    }
}

/// Along a curve that rises, values near its zero keep their digits, however large others are.
#[test]
fn small_values_of_curves_are_exact() {
    let text = "model M { 1 v { I m { inertia: 1.0 } }
        output y = interpolate(m.p, [-700.0, -0.3, 0.1, 0.9], [-1100.0, -0.4, 0.0, 0.3]); }";
    for way in [1e-14, -1e-14, 1e-9, -1e-9] {
        let x = 0.1 + way;
        let found = evaluated(text, Routines::OUTPUT, &[], &[x])[0];
        let expected = (x - 0.1) * if way > 0.0 { 0.3 / 0.8 } else { 1.0 };
        // As exact as the place is.
        assert!((found - expected).abs() < 1e-16, "{way}: {found}");
    }
}

/// At a point itself the slope is that of one of the lines that meet there, the one before it.
#[test]
fn curves_have_the_slopes_of_their_lines() {
    let text = format!(
        "model M {{ 1 v {{ I m {{ inertia: 1.0 }} R r {{ effort: interpolate(f, {CURVE}) }} }} }}"
    );
    for x in PLACES {
        let jacobian = evaluated(&text, Routines::DERIVATIVE_AND_JACOBIAN, &[], &[x])[1];
        let below = x - 1e-6;
        let expected = (lines(&POINTS, below) - lines(&POINTS, x)) / 1e-6;
        assert!(
            (jacobian - expected).abs() < 1e-6,
            "{x}: {jacobian}, not {expected}"
        );
    }
}

/// Laws of a displacement with curves in them.
type Law = (&'static str, fn(f64) -> f64);

#[test]
fn energies_of_curves_are_in_closed_form() {
    let laws: [Law; 4] = [
        ("interpolate(2.0 * q + 0.5, …)", |q| {
            lines(&POINTS, 2.0 * q + 0.5)
        }),
        ("q * interpolate(q, …)", |q| q * lines(&POINTS, q)),
        ("sign(q) * interpolate(abs(q), …)", |q| {
            q.signum() * lines(&POINTS, q.abs())
        }),
        ("max(-0.1, interpolate(q, …))", |q| {
            lines(&POINTS, q).max(-0.1)
        }),
    ];
    for (law, effort) in laws {
        let law = law.replace('…', CURVE);
        let text =
            format!("model M {{ 1 v {{ C c {{ effort: {law} }} R r {{ resistance: 1.0 }} }} }}");
        assert!(compiled(&text).notes.is_empty(), "{law}");
        for x in [-3.0, -1.0, -0.5, 0.0, 0.1, 0.5, 1.0, 3.0] {
            let count = 100_000;
            let step = x / f64::from(count);
            // The midpoints of short pieces: exact but for those with a point inside.
            let expected: f64 = (0..count)
                .map(|k| step * effort(step * (f64::from(k) + 0.5)))
                .sum();
            let found = evaluated(&text, Routines::ENERGY, &[], &[x])[0];
            assert!(
                (found - expected).abs() < 1e-8 * (1.0 + expected.abs()),
                "{law} at {x}: {found}, not {expected}"
            );
        }
    }
}

/// Lines of one slope are one line, and a curve of them alone is a coefficient.
#[test]
fn lines_in_a_row_are_one() {
    let force = |law: &str| {
        let text = format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }}
             0 b {{ C c {{ stiffness: 3.0 }} R r {{ {law} }} }} a -> b; }}"
        );
        evaluated(&text, Routines::DERIVATIVE, &[], &[0.5, 0.7])
    };
    let curve = "effort: interpolate(f, [-1.0, 0.5, 2.0], [-2.0, 1.0, 4.0])";
    assert_eq!(force(curve), force("resistance: 2.0"));
}

#[test]
fn curves_take_parameters_and_named_vectors() {
    let text = "model M {
        param knee = 2.0; param top = 3.0;
        let places = [0.0, knee, knee + 1.0];
        let values = [0.0, top, top];
        1 v { I m { inertia: 1.0 } }
        output y = interpolate(m.p, places, values);
        output table = interpolate(m.p, [0.0, 1.0], [interpolate(t, [0.0, 1.0], [4.0, 5.0]), 7.0]);
    }";
    for (x, expected) in [(1.0, 1.5), (2.5, 3.0), (9.0, 3.0), (-1.0, -1.5)] {
        let found = evaluated(text, Routines::OUTPUT, &[2.0, 3.0], &[x]);
        assert_eq!(found, [expected, 4.0 + 3.0 * x], "{x}");
    }
    let model = compiled(text);
    let checks = model.checks.iter();
    let checks: Vec<_> = checks.map(|it| (&it.name[..], &it.reason[..])).collect();
    assert_eq!(checks, [("knee", "the places of a curve rise by it")]);
}

/// A component of a vector law each.
#[test]
fn curves_hold_for_each_component() {
    let text = "model M { 1 v[2] { I m { inertia: 1.0 } R r { effort: interpolate(f, [-1, 0, 1], [-1.0, 0.0, 3.0]) } } }";
    let found = evaluated(text, Routines::DERIVATIVE, &[], &[2.0, -2.0]);
    assert_eq!(found, [-6.0, 2.0]);
}

/// A resistor that is given the effort and has a law for the effort is found by iteration.
#[test]
fn a_resistor_with_a_curve_is_inverted() {
    let text = "model M {
        1 a { I m { inertia: 1.0 } }
        0 n { R r { effort: interpolate(f, [-1.0, 0.0, 1.0], [-1.0, 0.0, 3.0]) } R s { resistance: 2.0 } }
        a -> n;
    }";
    // Both share the flow: 2 (p − f) = u(f).
    for (momentum, expected) in [(5.0, 6.0), (-3.0, -2.0), (0.0, 0.0)] {
        let found = evaluated(text, Routines::DERIVATIVE, &[], &[momentum])[0];
        assert!((found + expected).abs() < 1e-12, "{momentum}: {found}");
    }
}

#[test]
fn mistakes_in_curves_are_told() {
    let curve = |arguments: &str| mistake(&format!("output y = interpolate({arguments});"));
    insta::assert_snapshot!(curve("t, [0.0, 1.0]"), @"2:12 expected `interpolate(x, places, values)` [MBG0213]");
    insta::assert_snapshot!(curve("t, [0.0, 1.0], [0.0, 1.0, 2.0]"), @"2:39 expected 2 values, one for each place, found 3 [MBG0204]");
    insta::assert_snapshot!(curve("t, [[0.0, 1.0], [n, 2.0], [9.0, -t]]"), @"
    2:12 expected `interpolate(x, places, values)` [MBG0213]
      help: write `interpolate(t, [0.0, n, 9.0], [1.0, 2.0, -t])`
    ");
    assert_eq!(
        curve("t, [[0.0, 1.0], [n, 2.0]]"),
        curve("t, [(0.0, 1.0), (n, 2.0)]")
    );
    insta::assert_snapshot!(curve("t, [0.0], [1.0]"), @"2:27 expected at least two points, found one [MBG0204]");
    insta::assert_snapshot!(curve("t, 0.0, [1.0]"), @"2:27 expected a vector such as `[0.0, 1.0]`, found a number [MBG0204]");
    insta::assert_snapshot!(curve("a.f, [0.0, 1.0], [1.0, 2.0]"), @"
    2:24 expected a number, found a vector of 3 [MBG0204]
      help: write one component, such as `a.f[0]`
    ");
    insta::assert_snapshot!(curve("t, [0.0, 1.0, 0.5], [1.0, 2.0, 3.0]"), @"
    2:38 expected a place beyond 1, found 0.5 [MBG0213]
      help: places rise: where they fall, write both vectors from their other ends
    ");
    insta::assert_snapshot!(curve("t, [0.0, n, n], [1.0, 2.0, 3.0]"), @"2:36 expected a place beyond the one before [MBG0213]");
    insta::assert_snapshot!(curve("t, [0.0, t], [1.0, 2.0]"), @"2:33 expected places of numbers and parameters alone [MBG0213]");
    insta::assert_snapshot!(curve("t, [0.0, 1e-300], [1.0, 1e300]"), @"2:48 the slope of the line to this value is not a finite number [MBG0216]");
    insta::assert_snapshot!(mistake("let xs = [1.0, 0.0]; output y = interpolate(t, xs, xs);"), @"
    2:48 expected a place beyond 1, found 0 [MBG0213]
      help: places rise: where they fall, write both vectors from their other ends
    ");
    let other = mistake("output y = interpolat(t, [0.0, 1.0], [1.0, 2.0]);");
    assert!(other.contains("did you mean `interpolate`?"), "{other}");
}
