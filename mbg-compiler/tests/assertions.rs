//! What models assert of their parameters.
#![allow(clippy::unwrap_used)]

mod models;
mod told;

use models::compiled;
use told::{told, typed};

/// A spring between two limits, which are given to it.
fn text(statement: &str, lower: &str, upper: &str) -> String {
    format!(
        "component Limits(port 1 v) {{ param lower; param upper; assert lower < upper; v -> C s {{ effort: 1.0 * min(max(q, lower), upper) }}; }}
         model M {{ param low = -1.0; param high = 2.0; param way: m = 3.0; param force: N = 1.0;
         1 v {{ I m {{ inertia: 1.0 }} C c {{ effort: force / way * (q + low - high) }} }}\nlimits: Limits {{ lower: {lower}, upper: {upper} }} (v); {statement} }}"
    )
}

#[test]
fn parameters_are_checked_by_new_and_numbers_while_compiling() {
    let model = compiled(&text(
        "assert low <= 0.0 && high != 3.0; assert 1 < 2;",
        "low",
        "high",
    ));
    let checks = model
        .checks
        .iter()
        .filter(|it| it.reason.contains("asserted"));
    let checks = checks.map(|it| {
        (
            it.name.as_str(),
            format!("{:?}", it.condition),
            it.reason.as_str(),
        )
    });
    let expected = [
        ("high - low", "Positive", "`lower < upper` is asserted"),
        ("-low", "NotNegative", "`low <= 0.0` is asserted"),
        ("high - 3", "NonZero", "`high != 3.0` is asserted"),
    ];
    let expected = expected.map(|(name, condition, reason)| (name, condition.to_owned(), reason));
    assert_eq!(checks.collect::<Vec<_>>(), expected);
    insta::assert_snapshot!(told(&text("", "2.0", "1.0")), @"1:63 `lower < upper` is asserted of `limits`, and these are 2.0 and 1.0 [MBG0213]");
    insta::assert_snapshot!(told(&text("assert 2 > 3;", "0.0", "1.0")), @"4:55 `2 > 3` is asserted, and these are 2.0 and 3.0 [MBG0213]");
    insta::assert_snapshot!(told(&text("assert 2 < 1;", "0.0", "1.0")), @"4:55 `2 < 1` is asserted, and these are 2.0 and 1.0 [MBG0213]");
}

#[test]
fn what_is_no_assertion_is_told() {
    for (statement, expected) in [
        ("assert low;", "assert a < b;"),
        ("assert low = 2.0;", "assert a < b;"),
    ] {
        let help = typed(&text(statement, "0.0", "1.0"));
        assert!(
            help.iter().any(|it| it == expected),
            "{statement}: {help:?}"
        );
    }
    insta::assert_snapshot!(told(&text("assert way < force;", "0.0", "1.0")), @"4:55 `way` is `m` and `force` is `N`: they are neither added nor compared [MBG0501]");
    insta::assert_snapshot!(told(&text("assert;", "0.0", "1.0")), @"4:54 expected a comparison after `assert`, found `;` [MBG0101]");
}

/// What the pages of the library say of parameters: laws would be no numbers, or push the wrong way, else.
#[test]
fn parts_of_the_library_tell_what_their_parameters_must_be() {
    let scene = |part: &str| {
        format!(
            "model M {{ 1 ground[3]; 1 tip[3]; 0 p; 0 r; 1 v; 1 w;
             Sf fixed[3] {{ flow: 0.0 }} -> ground; hinge: PlanarRevolute (ground, tip); bob: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (tip);
             r -> R leak {{ conductance: 1e-5 }}; p -> R other {{ conductance: 1e-5 }}; v -> I m {{ inertia: 1.0 }}; w -> I n {{ inertia: 1.0 }};
             part: {part}; }}"
        )
    };
    let parts = [
        (
            "(p, r)",
            "Orifice { area: 1e-4, transition: ",
            "transition > 0",
        ),
        ("(p, r)", "Orifice { area: 1e-4, density: ", "density > 0"),
        (
            "(p)",
            "Accumulator { precharge: 1e5, volume: ",
            "volume > 0",
        ),
        (
            "(p)",
            "Accumulator { volume: 1e-3, precharge: ",
            "precharge > 0",
        ),
        ("(p, r)", "Diode { thermal: ", "thermal > 0"),
        ("(v, w)", "Clutch { capacity: 1.0, speed: ", "speed > 0"),
        ("(v)", "Brake { capacity: 1.0, speed: ", "speed > 0"),
        ("(v, w)", "Freewheel { capacity: 1.0, speed: ", "speed > 0"),
        ("(v)", "Friction { sliding: 1.0, speed: ", "speed > 0"),
        (
            "(v, w)",
            "Gear { radius_a: 1.0, radius_b: ",
            "radius_b != 0",
        ),
        (
            "(v, w)",
            "Gear { blocked: compliant, radius_b: 1.0, radius_a: ",
            "radius_a != 0",
        ),
        (
            "(v, w)",
            "Rack { blocked: compliant, radius: ",
            "radius != 0",
        ),
        ("(ground, tip)", "PlanarRod { length: ", "length > 0"),
        (
            "(tip)",
            "PlanarContact { stiffness: 1e5, friction: 0.5, friction_speed: ",
            "speed > 0",
        ),
    ];
    for (ports, part, condition) in parts {
        let told = told(&scene(&format!("{part}0.0 }} {ports}")));
        assert!(
            told.contains(&format!("`{condition}` is asserted of")),
            "{part}: {told}"
        );
    }
    let full = "Accumulator { precharge: 1e5, volume: 1e-3, initial: 1e-3 } (p)";
    let full = told(&scene(full));
    assert!(
        full.contains("`initial < volume` is asserted of `part`, and these are 0.001 and 0.001"),
        "{full}"
    );
    // Those of a model are checked by `new`, and signals are what they are.
    let model = compiled(
        "model M { param laminar: Pa = 1e3; input density: kg/m^3; 0 p { C oil { stiffness: 1e9 } } 0 r { R leak { conductance: 1e-9 } }
         edge: Orifice { area: 1e-4, transition: laminar, density: density } (p, r); }",
    );
    let asserted = model
        .checks
        .iter()
        .filter(|it| it.reason.contains("asserted"));
    let asserted = asserted.map(|it| (it.name.as_str(), it.reason.as_str()));
    let expected = ("laminar", "`transition > 0` is asserted");
    assert_eq!(asserted.collect::<Vec<_>>(), [expected]);
}

/// What rubs or pushes by a negative number would drive what it touches.
#[test]
fn contacts_and_stops_take_power() {
    let scene = |words: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[3]; 1 leg[3]; Sf still[3] {{ flow: 0.0 }} -> ground;
             turn: PlanarRevolute (ground, leg); body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (leg);
             tip: PlanarContact {{ radius: 0.1, {words} }} (leg); }}"
        )
    };
    assert_eq!(
        told(&scene("stiffness: 1e4, friction: 0.5, dissipation: 1.0")),
        ""
    );
    for (words, broken) in [
        ("stiffness: 1e4, friction: -0.5", "friction >= 0"),
        ("stiffness: -1e4", "stiffness >= 0"),
        ("stiffness: 1e4, dissipation: -1.0", "dissipation >= 0"),
    ] {
        let text = told(&scene(words));
        assert!(text.contains(&format!("`{broken}` is asserted")), "{text}");
    }
}
