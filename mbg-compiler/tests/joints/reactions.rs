//! Efforts that are read of joints: what they put on b, in the axes that the documentation says.

use mbg_compiler::compile::Routines;

use crate::rows;
use crate::scene::Scene;

/// The first components of the outputs against the others, in a state that moves.
#[track_caller]
fn alike(scene: &Scene) {
    let found = scene.run(Routines::OUTPUT, &scene.state(0));
    let (read, expected) = found.split_at(found.len() / 2);
    let felt = expected.iter().filter(|effort| effort.abs() > 1e-3);
    assert!(felt.count() >= expected.len() / 2, "{found:?}");
    for (read, expected) in read.iter().zip(expected) {
        assert!((read - expected).abs() < 1e-12, "{found:?}");
    }
}

/// What a joint from the ground to a body is said to put on it, and what goes into the body, which `turn` takes to the
/// axes that are said.
fn in_space(joint: &str, read: [&str; 2], turn: [&str; 2]) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Held {{
            causality componentwise;
            gravity [0.5, 1.0, -9.81];
            1 ground[6]; 1 end[6]; 1 b[6];
            0 into[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            let tilt = rot_x(0.4) * rot_z(-0.3);
            joint: {joint}, offset: [0.1, -0.2, 0.3], tilt: tilt }} (ground, end);
            end -> into;
            into -> b;
            body: Body {{
                mass: 2.0, inertia: [[1.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 3.0]],
                centre: [0.1, 0.2, -0.3], gravity_at: joint.gravity_b
            }} (b);
            let turn = transpose(tilt) * joint.orientation_b;
            output force[3] = joint.{};
            output moment[3] = joint.{};
            output force_on_b[3] = {} * into.e[3..6];
            output moment_on_b[3] = {} * into.e[0..3];
        }}",
        read[0], read[1], turn[0], turn[1]
    ))
}

#[test]
fn efforts_of_joints_are_those_on_b() {
    let table = rows(4);
    assert_eq!(table.len(), 6);
    for row in table {
        let joint = match row[0] {
            "Universal" => "Universal { first: 2, second: 0",
            "Spherical" => "Spherical { damping: 0.7",
            other => &format!("{other} {{ axis: 1"),
        };
        let moment = match row[3] {
            "the joint" => "turn",
            "the joint, the moment in those of the cross" => "transpose(joint.turn_first) * turn",
            other => panic!("{other}"),
        };
        alike(&in_space(joint, [row[1], row[2]], ["turn", moment]));
    }
    for word in ["quaternion", "matrix"] {
        let joint =
            format!("Spherical {{ damping: 0.7, initial: [0.3, 0.2, 0.1], orientation: {word}");
        let own = "diag(1.0, 1.0, 1.0)";
        let read = ["force.e", "rotation.moment.e"];
        alike(&in_space(&joint, read, ["turn", own]));
    }
}

/// What the joints and an offset of no length put on what they lead to.
#[test]
fn efforts_in_a_plane_are_those_on_b() {
    alike(&Scene::of(
        "#[derivative] model Held {
            causality componentwise;
            gravity [0.5, -9.81];
            1 ground[3]; 1 arm[3]; 1 sled[3]; 1 end[3]; 1 pin[3]; 1 b[3];
            0 before[3]; 0 after[3];
            Sf fixed[3] { flow: 0.0 } -> ground;
            hinge: PlanarRevolute (ground, arm);
            slide: PlanarPrismatic { direction: 0.7 } (arm, sled);
            sled -> after;
            after -> end;
            point: PlanarOffset { angle_a: slide.angle_b } (end, pin);
            pin -> before;
            before -> b;
            body: PlanarBody { mass: 2.0, inertia: 3.0 } (b);
            output pull[2] = slide.pull.e;
            output force[2] = point.force.e;
            output slid[2] = after.e[1..3];
            output held[2] = before.e[1..3];
        }",
    ));
}
