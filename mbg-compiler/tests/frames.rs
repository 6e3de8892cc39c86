//! What is known at a frame goes on from joint to joint.

mod models;

use mbg_compiler::compile::Routines;
use mbg_compiler::program::{Arguments, evaluate};
use models::{compiled, elaborated};

/// Derivatives and outputs in a state where nothing is zero.
fn values(text: &str) -> Vec<f64> {
    let model = compiled(text);
    let state: Vec<f64> = (1..=model.states.len()).map(|k| 0.1 * k as f64).collect();
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    let routines = [Routines::DERIVATIVE, Routines::OUTPUT];
    routines
        .map(|it| evaluate(&model.program, it, &arguments))
        .concat()
}

/// A scene with weight, of a ground and frames in space.
fn scene(frames: &str, statements: &str) -> String {
    format!(
        "#[derivative] model M {{
            causality componentwise;
            gravity [0.5, 1.0, -9.81];
            1 ground[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            1 {frames};
            {statements}
        }}"
    )
}

fn told(text: &str) -> String {
    elaborated(text).err().unwrap_or_default()
}

/// A hinge, an offset, a turn and a ball joint, with what each and a body are given.
fn limb([rod, bend, ball, body]: [&str; 4]) -> String {
    scene(
        "arm[6]; 1 end[6]; 1 bent[6]; 1 hand[6]",
        &format!(
            "hinge: Revolute {{ axis: 1, offset: [0.1, 0.2, 0.3] }} (ground, arm);
         rod: Offset {{ by: [1.0, 0.0, 0.0]{rod} }} (arm, end);
         bend: Turn {{ by: rot_z(0.3){bend} }} (end, bent);
         ball: Spherical {{ orientation: quaternion{ball} }} (bent, hand);
         body: Body {{ mass: 1.0, inertia: diag(1.0, 2.0, 3.0){body} }} (hand);
         output place[3] = ball.position_b;
         output x[3] = ball.orientation_b * [1.0, 0.0, 0.0];"
        ),
    )
}

#[test]
fn what_is_left_out_is_what_was_given() {
    let of = |joint: &str| {
        format!(
            ", gravity_a: {joint}.gravity_b, orientation_a: {joint}.orientation_b, position_a: {joint}.position_b"
        )
    };
    let given = limb([
        &of("hinge"),
        &of("rod"),
        &of("bend"),
        ", gravity_at: ball.gravity_b",
    ]);
    assert_eq!(values(&limb([""; 4])), values(&given));
    // What is given counts, and goes on.
    let other = limb(["", ", gravity_a: gravity", "", ""]);
    assert_ne!(values(&limb([""; 4])), values(&other));
}

#[test]
fn components_hand_on_what_is_inside_them() {
    let link = "component Link(port a[6], port b[6]) {
        1 rod[6];
        hinge: Revolute { axis: 0 } (a, rod);
        length: Offset { by: [0.0, 0.0, -1.0] } (rod, b);
        body: Body { mass: 1.0, inertia: 2.0, centre: [0.0, 0.1, -0.5] } (rod);
    }";
    let inside = scene(
        "b[6]; 1 c[6]",
        "first: Link (ground, b); second: Link (b, c);",
    );
    let outside = scene(
        "b[6]; 1 c[6]; 1 rod[6]; 1 stick[6]",
        "hinge: Revolute { axis: 0 } (ground, rod);
         length: Offset { by: [0.0, 0.0, -1.0] } (rod, b);
         body: Body { mass: 1.0, inertia: 2.0, centre: [0.0, 0.1, -0.5] } (rod);
         elbow: Revolute { axis: 0 } (b, stick);
         reach: Offset { by: [0.0, 0.0, -1.0] } (stick, c);
         load: Body { mass: 1.0, inertia: 2.0, centre: [0.0, 0.1, -0.5] } (stick);",
    );
    assert_eq!(values(&format!("{link} {inside}")), values(&outside));
}

#[test]
fn a_bond_between_junctions_makes_one_frame() {
    let bodies = |frame: &str| {
        format!(
            "hinge: Revolute {{ axis: 0 }} (ground, arm);
         body: Body {{ mass: 1.0, inertia: 2.0, centre: [0.0, 0.1, -0.5] }} ({frame});"
        )
    };
    let apart = scene(
        "arm[6]; 1 end[6]; 1 tip[6]",
        &(bodies("tip") + "arm -> end; end -> tip;"),
    );
    assert_eq!(values(&apart), values(&scene("arm[6]", &bodies("arm"))));
}

/// Two legs on the ground, and a beam that one of them leads to and a cut closes with the other.
#[test]
fn a_loop_is_known_by_the_shortest_way_from_the_ground() {
    let legs =
        "left: Revolute { axis: 0 } (ground, a); up: Offset { by: [0.0, 0.0, 1.0] } (a, top);
         right: Revolute { axis: 0, offset: [0.0, 1.0, 0.0] } (ground, b);";
    let across = "across: Revolute { axis: 0 } (top, beam);
         one: Body { mass: 1.0, inertia: 1.0 } (top); other: Body { mass: 1.0, inertia: 1.0 } (beam);";
    for statements in [
        format!("{legs} {across} cut: Cut (beam, b);"),
        format!("{across} {legs} cut: Cut (beam, b);"),
        // A joint back to where the way began defines nothing by itself.
        format!("back: Revolute {{ axis: 0 }} (beam, a); {across} {legs}"),
    ] {
        assert_eq!(
            told(&scene("a[6]; 1 b[6]; 1 top[6]; 1 beam[6]", &statements)),
            ""
        );
    }
}

#[test]
fn what_nothing_leads_to_must_be_given_where_it_is_needed() {
    let floating = |statements: &str| told(&scene("a[6]", statements));
    let body = "body: Body { mass: 1.0, inertia: 1.0 } (a);";
    insta::assert_snapshot!(floating(body), @"
    7:13 `body` needs `gravity_at`, which nothing tells at its frame [MBG0214]
      this is inside `Body`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[6] { flow: 0.0 } -> a;`
      help: or let a joint, such as `Free`, lead to it from a frame that is held
      help: or write `gravity_at: gravity` where that of the world is meant
    ");
    // Where it is held alone, a frame turns as it likes.
    let pinned = "Sf pin[3] { flow: 0.0 } -> a[3..6];";
    insta::assert_snapshot!(floating(&format!("{pinned} {body}")), @"
    7:49 `body` needs `gravity_at`, which nothing tells at its frame [MBG0214]
      this is inside `Body`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[6] { flow: 0.0 } -> a;`
      help: or let a joint, such as `Free`, lead to it from a frame that is held
      help: or write `gravity_at: gravity` where that of the world is meant
    ");
    let upright = "Sf upright[3] { flow: [0.0, 0, 0.0] } -> a[0..3];";
    assert_eq!(floating(&format!("{upright} {body}")), "");
    let given = body.replace("1.0 }", "1.0, gravity_at: gravity }");
    assert_eq!(floating(&given), "");
    let plane = "model M { 1 a[3]; 1 b[3]; body: PlanarBody { mass: 1.0, inertia: 1.0 } (a); rod: PlanarOffset { x: 1.0 } (a, b); }";
    insta::assert_snapshot!(told(plane), @"
    1:77 `rod` needs `angle_a`, which nothing tells at its frame [MBG0214]
      this is inside `PlanarOffset`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[3] { flow: 0.0 } -> a;`
      help: or let a joint, such as `PlanarFree`, lead to it from a frame that is held
      help: or write `angle_a: 0.0` where that of the world is meant
    ");
    // In a ring one joint that is given it is enough.
    let ring = "first: Revolute { axis: 0, gravity_a: gravity } (a, b); back: Revolute { axis: 0 } (b, a);";
    assert_eq!(told(&scene("a[6]; 1 b[6]", &format!("{ring} {body}"))), "");
    // Without weight nobody asks where a joint is.
    let weightless = "model M { 1 a[6]; 1 b[6]; body: Body { mass: 1.0, inertia: 1.0 } (a); hinge: Revolute { axis: 0 } (a, b); }";
    assert_eq!(told(weightless), "");
}

/// A slide on something tilted, with a body on it, the first of whose derivatives is the acceleration of the slide.
fn tilted(components: &str, tilt: &str) -> Vec<f64> {
    let slide = "slide: Prismatic { axis: 2 } (b, s); body: Body { mass: 1.0, inertia: 1.0 } (s);";
    let scene = scene("b[6]; 1 s[6]", &format!("{tilt} {slide}"));
    values(&format!("{components} {scene}"))
}

#[test]
fn what_is_told_has_the_dimension_that_is_asked_for() {
    let tilt = |dimension: &str| {
        format!(
            "component Tilt(port a[6], port b[6]) {{
                param gravity_a[3] = gravity;
                let gravity_b{dimension} = rot_x(1.0) * gravity_a;
                turn: Turn {{ by: rot_x(-1.0) }} (a, b);
            }}"
        )
    };
    let turn = tilted("", "turn: Turn { by: rot_x(-1.0) } (ground, b);");
    for dimension in ["", "[3]"] {
        let own = tilted(&tilt(dimension), "tilt: Tilt (ground, b);");
        assert_eq!(own, turn);
    }
    let text = scene(
        "b[6]",
        "tilt: Tilt (ground, b); body: Body { mass: 1.0, inertia: 1.0 } (b);",
    );
    let flat = tilt("").replace("rot_x(1.0) * gravity_a", "[1.0, 2.0]");
    insta::assert_snapshot!(told(&format!("{flat} {text}")), @"
    11:37 `gravity_at` has dimension 3, found a vector of 2 [MBG0204]
      it is what `tilt.gravity_b` tells
      this is inside `Body`, a component of the library
    ");
}

#[test]
fn a_component_with_one_port_knows_where_that_is() {
    let wall = "component Wall(port b[6]) {
        Sf hold[6] { flow: 0.0 } -> b;
        let gravity_b[3] = rot_x(1.0) * gravity;
    }";
    let turn = tilted("", "turn: Turn { by: rot_x(-1.0) } (ground, b);");
    assert_eq!(
        tilted(
            wall,
            "wall: Wall (b); ground -> R idle { resistance: 1.0 };"
        ),
        turn
    );
}

/// The name of one port ends in that of the other.
#[test]
fn a_parameter_asks_at_the_port_whose_whole_name_it_has() {
    let bob = "component Bob(port a[6], port tool_a[6]) {
        param gravity_tool_a[3] = gravity;
        body: Body { mass: 1.0, inertia: 1.0, centre: [0.0, 0.0, -1.0], gravity_at: gravity_tool_a } (tool_a);
        a -> R air { resistance: 1.0 };
    }";
    let on = |bob: &str| {
        let hinge = "1 b[6]; hinge: Revolute { axis: 0 } (ground, b);";
        scene(
            "a[6]",
            &format!("{hinge} Sf fixed_a[6] {{ flow: 0.0 }} -> a; {bob}"),
        )
    };
    let own = values(&format!("{bob} {}", on("bob: Bob (a, b);")));
    let plain = "body: Body { mass: 1.0, inertia: 1.0, centre: [0.0, 0.0, -1.0] } (b); a -> R air { resistance: 1.0 };";
    assert_eq!(own, values(&on(plain)));
}

#[test]
fn what_a_source_moves_is_known_by_what_leads_to_it() {
    let driven = |given: &str| {
        scene(
            "tool[6]; 1 bob[6]",
            &format!(
                "Sf drive[6] {{ flow: [0.3, 0.0, 0.0, 0.0, 0.0, 0.0] }} -> tool;
             free: Free {{ orientation: matrix }} (ground, tool);
             hinge: Revolute {{ axis: 0{given} }} (tool, bob);
             body: Body {{ mass: 1.0, inertia: 0.1, centre: [0.0, 0.0, -1.0] }} (bob);"
            ),
        )
    };
    assert_eq!(
        values(&driven("")),
        values(&driven(", gravity_a: free.gravity_b"))
    );
    let base = |flow: &str, output: &str| {
        told(&format!(
            "model M {{ 1 base[3]; 1 s[3]; Sf turn[3] {{ flow: {flow} }} -> base;
             slide: PlanarPrismatic {{ initial: 1.0 }} (base, s); body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (s); {output} }}"
        ))
    };
    insta::assert_snapshot!(base("[0.5, 0.0, 0.0]", ""), @"
    2:14 `slide` needs `angle_a`, which nothing tells at its frame [MBG0214]
      this is inside `PlanarPrismatic`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[3] { flow: 0.0 } -> base;`
      help: or let a joint, such as `PlanarFree`, lead to it from a frame that is held
      help: or write `angle_a: 0.0` where that of the world is meant
    ");
    // What does not turn keeps its angle, wherever it goes.
    assert_eq!(base("[0.0, sin(t), 0.0]", ""), "");
    insta::assert_snapshot!(base("[0.0, sin(t), 0.0]", "output place[2] = slide.position_b;"), @"
    2:14 `slide` needs `position_a`, which nothing tells at its frame [MBG0214]
      this is inside `PlanarPrismatic`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[3] { flow: 0.0 } -> base;`
      help: or let a joint, such as `PlanarFree`, lead to it from a frame that is held
      help: or write `position_a: 0.0` where that of the world is meant
    ");
}

/// Not the world's, but that of another one.
#[test]
fn gravity_may_be_given_at_one_frame_alone() {
    let moon = |given: &str| {
        let joint = format!("slide: Prismatic {{ axis: 2{given} }} (ground, b);");
        let body = "body: Body { mass: 1.0, inertia: 1.0 } (b);";
        let scene = scene("b[6]", &format!("{joint} {body}"));
        values(&scene.replace("gravity [0.5, 1.0, -9.81];", ""))
    };
    assert!(moon(", gravity_a: [0.0, 0.0, -1.62]").contains(&-1.62));
    assert!(!moon("").contains(&-1.62));
}

#[test]
fn a_joint_that_leads_the_wrong_way_is_told() {
    let body = "body: Body { mass: 1.0, inertia: 1.0, centre: [0.0, 0.0, 0.5] } (a);";
    let hung = format!("hinge: Revolute {{ axis: 0 }} (a, ground); {body}");
    insta::assert_snapshot!(told(&scene("a[6]", &hung)), @"
    7:54 `body` needs `gravity_at`, which nothing tells at its frame [MBG0214]
      this is inside `Body`, a component of the library
      help: exchange the frames of `hinge`: it hands on from the first to the second
      help: or write `gravity_at: gravity` where that of the world is meant
    ");
    let pulled = format!(
        "hinge: Revolute {{ axis: 0 }} (ground, a); {body}
         rod: Offset {{ by: [1.0, 0.0, 0.0] }} (b, a);
         load: Load {{ axes: world, force: [0.0, 0.0, 1.0] }} (b);"
    );
    insta::assert_snapshot!(told(&scene("a[6]; 1 b[6]", &pulled)), @"
    9:10 `load` needs `orientation_at`, which nothing tells at its frame [MBG0214]
      this is inside `Load`, a component of the library
      help: exchange the frames of `rod`: it hands on from the first to the second
      help: or write `orientation_at: 1.0` where that of the world is meant
    ");
}

#[test]
fn what_only_the_library_asks_must_be_known() {
    let hinge = "component Hinge(port a[6], port b[6]) {
        1 rate { I drum { inertia: 1.0 } }
        0 moment[3];
        a[0..3] -> moment;
        rate -> moment.x;
        moment -> b[0..3];
        a[3..6] -> b[3..6];
    }";
    let load = "hinge: Hinge (ground, b); load: Load { axes: world, moment: [0.0, 0.0, 1.0] } (b);";
    insta::assert_snapshot!(told(&format!("{hinge} {}", scene("b[6]", load))), @"
    14:39 `load` needs `orientation_at`, which nothing tells at its frame [MBG0214]
      this is inside `Load`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[6] { flow: 0.0 } -> b;`
      help: or let a joint, such as `Free`, lead to it from a frame that is held
      help: or write `orientation_at: 1.0` where that of the world is meant
    ");
}

/// A number is no direction: it would pull as much along x as along y.
#[test]
fn gravity_in_a_plane_has_a_direction() {
    for body in [
        "PlanarBody { mass: 1.0, inertia: 1.0 }",
        "PlanarPointMass { mass: 1.0 }",
    ] {
        let scene = |gravity: &str| {
            format!(
                "#[derivative] model M {{ causality componentwise; gravity {gravity}; 1 ground[3]; 1 arm[3];
                 Sf still[3] {{ flow: 0.0 }} -> ground; slide: PlanarPrismatic (ground, arm); body: {body} (arm); }}"
            )
        };
        for slip in ["-9.81", "[0.0, 0.0, -9.81]"] {
            let help = told(&scene(slip));
            assert!(
                help.contains("write `gravity [0.0, -9.81];` in the model"),
                "{help}"
            );
        }
        assert_eq!(told(&scene("[0.0, -9.81]")), "");
    }
}
