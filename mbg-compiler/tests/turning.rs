//! Inertias in axes that turn: what is warned of and told for them has the terms of Euler and Newton.
#![allow(clippy::unwrap_used)]

mod models;
mod told;

use mbg_compiler::compile::Routines;
use mbg_compiler::program::{Arguments, evaluate};
use models::compiled;
use told::{told, typed, warned};

/// A frame that floats, with an inertia on all of it and statements.
fn floating(statements: &str) -> String {
    format!(
        "model M {{ 1 g[6] {{ Sf still {{ flow: 0.0 }} }} 1 hull[6] {{ I m {{ inertia: diag(1.0, 2.0, 3.0, 4.0, 5.0, 6.0) }} }}
         free: Free {{ orientation: quaternion }} (g, hull); {statements} }}"
    )
}

/// The rates of the first states, which are set to these.
fn rates(text: &str, begin: &[f64]) -> Vec<f64> {
    let model = compiled(text);
    let mut state = vec![0.3; model.states.len()];
    state[..begin.len()].copy_from_slice(begin);
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    evaluate(&model.program, Routines::DERIVATIVE, &arguments)
}

fn cross(a: &[f64], b: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

#[test]
fn an_inertia_of_a_whole_frame_is_told_what_turns_its_momentum() {
    let warning = warned(&floating(""));
    assert!(
        warning.contains("nothing turns its momentum with them [MBG0412]"),
        "{warning}"
    );
    let terms = warning.split('`').nth(3).unwrap();
    assert_eq!(warned(&floating(terms)), "");
    let momentum = [0.5, -0.2, 0.7, 1.1, 0.4, -0.9];
    let found = rates(&floating(terms), &momentum);
    let flow: Vec<f64> = (0..6).map(|k| momentum[k] / (k + 1) as f64).collect();
    // Kirchhoff: dh/dt = -ω × h - v × p, dp/dt = -ω × p.
    let (turned, shifted) = (
        cross(&flow[..3], &momentum[..3]),
        cross(&flow[3..], &momentum[3..]),
    );
    let bent = cross(&flow[..3], &momentum[3..]);
    for k in 0..3 {
        assert!(
            (found[k] + turned[k] + shifted[k]).abs() < 1e-12,
            "{found:?}"
        );
        assert!((found[k + 3] + bent[k]).abs() < 1e-12, "{found:?}");
    }
}

/// Six components that are no frame, frames that cannot turn, and bodies of the library are not warned of.
#[test]
fn what_does_not_turn_is_not_warned_of() {
    let mass = "I m { inertia: diag(1.0, 1.0, 1.0, 2.0, 2.0, 2.0) }";
    let ground =
        "#[derivative] model M { causality componentwise; 1 g[6] { Sf still { flow: 0.0 } }";
    for text in [
        format!("model M {{ 1 axles[6] {{ {mass} }} }}"),
        format!("{ground} 1 a[6] {{ {mass} }} rail: Prismatic {{ axis: 0 }} (g, a); }}"),
        format!(
            "{ground} 1 a[6]; free: Free (g, a); body: Body {{ mass: 1.0, inertia: 2.0 }} (a); }}"
        ),
        format!(
            "{ground} 1 a[6]; free: Free (g, a); water: AddedMass {{ mass: 1.0, inertia: 2.0 }} (a); }}"
        ),
    ] {
        assert!(!warned(&text).contains("MBG0412"), "{text}");
    }
    // What the library turns is not the user's own.
    let beside = floating("body: Body { mass: 1.0, inertia: 2.0 } (hull);");
    let beside = beside.replace("I m", "#[derivative] I m");
    assert!(warned(&beside).contains("MBG0412"));
}

#[test]
fn an_euler_junction_elsewhere_than_at_an_angular_velocity_is_told_what_is_meant() {
    let frame = |junction: &str| floating(&format!("{junction} -> EJS e {{ momentum: m.p }};"));
    let terms = typed(&frame("hull"));
    assert_eq!(
        terms,
        [
            "hull[0..3] -> EJS e { momentum: m.p[0..3] }; hull[3..6] -> MGY e_coupling { effort: skew(m.p[3..6]) } -> hull[0..3];"
        ]
    );
    assert_eq!(told(&floating(&terms[0])), "");
    let ship = |terms: &str| {
        format!(
            "model M {{ 1 hull[3]; hull[0..2] -> I m {{ inertia: diag(2.0, 3.0) }}; hull[2] -> I j {{ inertia: 4.0 }}; {terms} }}"
        )
    };
    for slip in [
        "hull -> EJS e { momentum: m.p };",
        "hull[0..2] -> EJS e { momentum: m.p };",
    ] {
        let written = typed(&ship(slip)).remove(1);
        assert_eq!(
            written,
            "hull[0..2] -> MGY e { effort: [[-m.p.y, m.p.x]] } -> hull.z;"
        );
        // Kirchhoff again: dp/dt = -ω × p, dh/dt = -v × p.
        let found = rates(&ship(&written), &[0.6, -0.9, 0.8]);
        let (across, along, rate) = (-0.9, 0.6, 0.8 / 4.0);
        let expected = [
            across * rate,
            -along * rate,
            along * (across / 3.0) - across * (along / 2.0),
        ];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
    let plate = "1 hull[3]; ship: PlanarBody { mass: 1.0, inertia: 2.0 } (hull);";
    let told_so = told(&format!(
        "model M {{ {plate} hull -> EJS e {{ momentum: ship.body.p }}; }}"
    ));
    assert!(told_so.contains("remove `e`"), "{told_so}");
    // Three components that are no frame in a plane may be an angular velocity.
    let plate = "1 g[3] { Sf still { flow: 0.0 } } 1 hull[3]; hull -> I m { inertia: diag(2.0, 3.0, 4.0) };";
    let turned = "hull -> EJS e { momentum: m.p };";
    let hinge = "hinge: PlanarRevolute (g, hull);";
    let model = |parts: &str| {
        format!("#[derivative] model M {{ causality componentwise; {plate} {parts} }}")
    };
    let told_so = told(&model(&format!("{turned} {hinge}")));
    assert!(
        told_so.contains("`e` turns with an angular velocity in space, and `hull` is a frame in a plane [MBG0204]")
            && told_so.contains("remove `e`"),
        "{told_so}"
    );
    assert_eq!(told(&model(turned)), "");
    assert_eq!(told(&model(hinge)), "");
    let shaft = told("model M { 1 a { I m { inertia: 1.0 } EJS e { momentum: m.p } } }");
    assert!(
        shaft.contains("about one axis nothing turns with the angular velocity: remove `e`"),
        "{shaft}"
    );
}
