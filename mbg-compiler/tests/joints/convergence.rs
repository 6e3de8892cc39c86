//! Compliant joints become ideal ones: the error of the motion falls as 1/stiffness.

use mbg_compiler::compile::Routines;

use crate::scene::{Scene, is_planar};

/// How long bodies move before they are compared.
const DURATION: f64 = 0.2;

/// Joints on which a body falls such that its weight loads blocked axes, and what is compared.
const JOINTS: &[(&str, &str, &str)] = &[
    ("Fixed", "offset: [0.1, 0.0, 0.0]", "sunk.z"),
    ("Revolute", "axis: 1", "joint.angle"),
    ("Prismatic", "axis: 1, tilt: rot_x(0.6)", "sunk.z"),
    ("Cylindrical", "axis: 0, tilt: rot_y(0.6)", "joint.angle"),
    ("Universal", "first: 2, second: 1", "joint.angle.y"),
    ("Planar", "axis: 2, tilt: rot_x(0.6)", "sunk.z"),
    ("Spherical", "", "joint.angle.y"),
    (
        "Spherical",
        "orientation: quaternion",
        "joint.quaternion[2]",
    ),
    ("PlanarRevolute", "", "joint.angle"),
    ("PlanarPrismatic", "direction: -0.7", "sunk.z"),
];

/// What `joint` carries, in a scene that shows `seen` and the way `sunk` of the frame b in its own axes.
fn scene(joint: &str, arguments: &str, seen: &str) -> Scene {
    let (size, gravity, carried) = if is_planar(joint) {
        let carried = "integral sunk[3] = b.f;
            reach: PlanarOffset { x: 0.3 } (b, c);
            body: PlanarBody { mass: 1.0, inertia: 0.2 } (c);";
        (3, "[0.0, -9.81]", carried)
    } else {
        let carried = "integral sunk[3] = b.f[3..6];
            b -> c;
            body: Body { mass: 1.0, inertia: diag(0.2, 0.3, 0.4), centre: [0.3, 0.1, 0.0] } (c);";
        (6, "[0.0, 0.0, -9.81]", carried)
    };
    Scene::of(&format!(
        "#[derivative] model Falling {{
            causality componentwise;
            gravity {gravity};
            1 ground[{size}]; 1 b[{size}]; 1 c[{size}];
            Sf fixed[{size}] {{ flow: 0.0 }} -> ground;
            joint: {joint} {{ {arguments} }} (ground, b);
            {carried}
            output seen = {seen};
        }}"
    ))
}

/// What is seen in the end, after `steps` steps from the start.
fn end(scene: &Scene, steps: usize) -> f64 {
    let state = scene.after(scene.start(), DURATION / steps as f64, steps);
    scene.run(Routines::OUTPUT, &state)[0]
}

/// As [`end`], with blocked axes that are damped so much that they do not ring.
fn compliant(joint: &str, arguments: &str, seen: &str, stiffness: f64) -> f64 {
    let damping = 2.0 * stiffness.sqrt();
    let mut words = vec![
        ("blocked_stiffness", stiffness),
        ("blocked_damping", damping),
    ];
    if !["PlanarRevolute", "Spherical"].contains(&joint) {
        words.push(("blocked_torsional_stiffness", stiffness));
        words.push(("blocked_torsional_damping", damping));
    }
    let words: String = words
        .iter()
        .map(|(word, value)| format!(", {word}: {value:?}"))
        .collect();
    let arguments = format!("blocked: compliant{words}, {arguments}");
    // A step is a small part of the time in which the damping stops the lightest inertia.
    let steps = (DURATION * damping * 20.0).max(200.0) as usize;
    end(&scene(joint, &arguments, seen), steps)
}

#[test]
fn the_error_of_a_compliant_joint_falls_with_its_stiffness() {
    for (joint, arguments, seen) in JOINTS {
        let ideal = end(&scene(joint, arguments, seen), 200);
        let errors = [1e4, 1e5, 1e6, 1e7]
            .map(|stiffness| (compliant(joint, arguments, seen, stiffness) - ideal).abs());
        let slopes = [0, 1, 2].map(|decade| (errors[decade + 1] / errors[decade]).log10());
        let errors = errors.map(|error| format!("{error:.2e}"));
        println!("{joint}: errors {errors:?}, slopes {slopes:.3?}");
        assert!(
            slopes.iter().all(|slope| (slope + 1.0).abs() < 0.05),
            "{joint}: {slopes:?}"
        );
    }
}
