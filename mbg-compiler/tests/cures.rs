//! Mistakes of people who know another tool: each says what to type, and with that typed nothing is told any more.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told};

/// A body that floats in space, with more beside it.
fn floating(free: &str, more: &str) -> String {
    format!(
        "model M {{ causality componentwise; input u; 1 ground[6]; 1 hull[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
         free: Free {{ {free} }} (ground, hull); body: Body {{ mass: 1.0, inertia: diag(1.0, 1.0, 1.0) }} (hull);
         {more} }}"
    )
}

/// The first help of the first mistake.
fn first_help(text: &str) -> String {
    let diagnostics = diagnose(text);
    let helps = diagnostics.list().first().unwrap().helps.clone();
    helps.into_iter().next().unwrap_or_default()
}

/// The texts in backticks of the first help of the first mistake.
fn first_typed(text: &str) -> Vec<String> {
    let help = first_help(text);
    let typed = help.split('`').skip(1).step_by(2);
    typed.map(str::to_owned).collect()
}

#[test]
fn a_load_at_a_point_stands_at_an_offset() {
    let load = |frames: &str, load: &str| {
        let more = format!("{frames} load: Load {{ force: [0.0, 0.0, u] {load};");
        floating("", &more)
    };
    let typed = first_typed(&load("", ", at: [0.1, 0.0, 0.0] } (hull)"));
    assert_eq!(
        typed,
        [
            "1 load_at[6]; load_arm: Offset { by: [0.1, 0.0, 0.0] } (hull, load_at);",
            "load",
            "load_at"
        ]
    );
    assert_eq!(told(&load(&typed[0], "} (load_at)")), "");
    let planar = |frames: &str, load: &str| {
        format!(
            "model M {{ causality componentwise; input u; 1 hull[3]; body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (hull);
             {frames} load: PlanarLoad {{ axes: body, angle_at: 0.0, force: [0.0, u] {load}; }}"
        )
    };
    let typed = first_typed(&planar("", ", at: [0.1, 0.2] } (hull)"));
    assert_eq!(
        typed[0],
        "1 load_at[3]; load_arm: PlanarOffset { x: 0.1, y: 0.2 } (hull, load_at);"
    );
}

#[test]
fn components_are_told_that_fit_and_are_near() {
    let scene = |size: usize, joint: &str| {
        format!(
            "#[derivative] model M {{ 1 g[{size}]; 1 a[{size}]; Sf fixed[{size}] {{ flow: 0.0 }} -> g;
             h: {joint} (g, a); body: {}Body {{ mass: 1.0, inertia: 1.0 }} (a); }}",
            if size == 3 { "Planar" } else { "" }
        )
    };
    assert_eq!(first_typed(&scene(3, "PlanarHinge"))[0], "PlanarRevolute");
    assert_eq!(first_typed(&scene(3, "Hinge"))[0], "PlanarRevolute");
    assert_eq!(told(&scene(3, "PlanarRevolute")), "");
    assert_eq!(first_typed(&scene(6, "Hinge { axis: 2 }"))[0], "Revolute");
    assert_eq!(told(&scene(6, "Revolute { axis: 2 }")), "");
    for far in ["PID { gain: 1.0 }", "Controller { gain: 1.0 }"] {
        insta::allow_duplicates! {
            insta::assert_snapshot!(
                first_help(&floating("", &format!("control: {far} (hull);"))),
                @"the page `library` of the documentation of `mbg_runtime` lists the components that there are"
            );
        }
    }
}

#[test]
fn an_element_that_is_called_as_a_component_is_written_as_an_element() {
    let scene = |part: &str| {
        format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ R r {{ resistance: 1.0 }} }} 1 c[3] {{ I n {{ inertia: 1.0 }} }} {part} }}"
        )
    };
    for (called, written) in [
        (
            "x: C { stiffness: 2.0 } (a);",
            "a -> C x { stiffness: 2.0 };",
        ),
        ("x: Se { effort: 2.0 } (a);", "Se x { effort: 2.0 } -> a;"),
        (
            "x: TF { flow: 2.0 } (a, b);",
            "a -> TF x { flow: 2.0 } -> b;",
        ),
        (
            "x: EJS { momentum: n.p } (c);",
            "c -> EJS x { momentum: n.p };",
        ),
    ] {
        let typed = first_typed(&scene(called));
        assert_eq!(typed.last().unwrap(), written);
        assert_eq!(
            told(&scene(written).replace(
                "1 b { R r { resistance: 1.0 } }",
                match called.contains("TF") {
                    true => "1 b { R r { resistance: 1.0 } }",
                    false => "",
                }
            )),
            ""
        );
    }
    assert_eq!(first_typed(&scene("x: C (a);"))[1], "a -> C x { … };");
}
