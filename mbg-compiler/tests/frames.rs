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
      help: let a joint lead to it from a frame that an `Sf` holds, such as a `Free`
      help: write `gravity_at: gravity` where that of the world is meant
    ");
    // Held in some components alone, a frame turns as it likes.
    let pinned = "Sf pin[3] { flow: 0.0 } -> a[3..6];";
    insta::assert_snapshot!(floating(&format!("{pinned} {body}")), @"
    7:49 `body` needs `gravity_at`, which nothing tells at its frame [MBG0214]
      this is inside `Body`, a component of the library
      help: let a joint lead to it from a frame that an `Sf` holds, such as a `Free`
      help: write `gravity_at: gravity` where that of the world is meant
    ");
    let spun = "Sf spin[3] { flow: 1.0 } -> a[0..3];";
    assert_eq!(floating(&format!("{pinned} {spun} {body}")), "");
    let given = body.replace("1.0 }", "1.0, gravity_at: gravity }");
    assert_eq!(floating(&given), "");
    let plane = "model M { 1 a[3]; 1 b[3]; body: PlanarBody { mass: 1.0, inertia: 1.0 } (a); rod: PlanarOffset { x: 1.0 } (a, b); }";
    insta::assert_snapshot!(told(plane), @"
    1:77 `rod` needs `angle_a`, which nothing tells at its frame [MBG0214]
      this is inside `PlanarOffset`, a component of the library
      help: let a joint lead to it from a frame that an `Sf` holds
      help: write `angle_a: 0.0` where that of the world is meant
    ");
    // Without weight nobody asks where a joint is.
    let weightless = "model M { 1 a[6]; 1 b[6]; body: Body { mass: 1.0, inertia: 1.0 } (a); hinge: Revolute { axis: 0 } (a, b); }";
    assert_eq!(told(weightless), "");
}

#[test]
fn a_joint_that_leads_the_wrong_way_is_told() {
    let body = "body: Body { mass: 1.0, inertia: 1.0, centre: [0.0, 0.0, 0.5] } (a);";
    let hung = format!("hinge: Revolute {{ axis: 0 }} (a, ground); {body}");
    insta::assert_snapshot!(told(&scene("a[6]", &hung)), @"
    7:54 `body` needs `gravity_at`, which nothing tells at its frame [MBG0214]
      this is inside `Body`, a component of the library
      help: exchange the frames of `hinge`: it hands on from the first to the second
      help: write `gravity_at: gravity` where that of the world is meant
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
      help: write `orientation_at: 1.0` where that of the world is meant
    ");
}
