//! Scenes hold no more than they need, and bodies and loads do what they say.

use mbg_compiler::compile::Routines;

use crate::scene::Scene;

#[test]
fn a_scene_that_only_turns_has_no_translation() {
    let scene = Scene::of(
        "model Turning {
            1 hull[3] { I spin { inertia: diag(1.0, 2.0, 3.0), gyroscopic } R air { resistance: 0.1 } }
            Se motor { effort: 2.0 } -> hull.z;
        }",
    );
    assert_eq!(scene.names(), ["spin.p.x", "spin.p.y", "spin.p.z"]);
    // A body with a mass that is held at a point turns about it, and has no other state.
    let top = Scene::of(
        "#[derivative] model Top {
            causality componentwise;
            1 point[6];
            Sf fixed[3] { flow: 0.0 } -> point[3..6];
            body: Body { mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, -0.3] } (point);
        }",
    );
    assert_eq!(top.velocities(), 3);
    assert_eq!(top.displacements(), 0);
}

#[test]
fn a_scene_in_a_plane_has_no_third_dimension() {
    let scene = Scene::of(
        "model Flat {
            gravity [0.0, -9.81];
            1 plate[3];
            body: PlanarBody { mass: 2.0, inertia: 3.0 } (plate);
        }",
    );
    assert_eq!(
        scene.names(),
        ["body.spin.p", "body.body.p.x", "body.body.p.y"]
    );
    let junctions = &scene.model.model.graph.junctions;
    assert!(junctions.iter().all(|junction| junction.dimension <= 3));
}

/// What a body on a frame that swings does under something that pulls at it.
fn pulled(by: &str, gravity: &str) -> Vec<f64> {
    let scene = Scene::of(&format!(
        "#[derivative] model Pulled {{
            causality componentwise;
            {gravity}
            1 ground[6]; 1 b[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            joint: Universal (ground, b);
            body: Body {{ mass: 2.0, inertia: 3.0, centre: [0.1, 0.2, 0.3] }} (b);
            {by}
            output angle[2] = joint.angle;
        }}"
    ));
    scene.run(Routines::DERIVATIVE, &scene.state(2))
}

#[track_caller]
fn alike(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

#[test]
fn a_load_in_axes_of_the_world_pulls_as_gravity_does() {
    let weight = "1 tip[6]; arm: Offset { by: [0.1, 0.2, 0.3] } (b, tip);
        load: Load { axes: world, force: [0.0, 0.0, -19.62], orientation_at: joint.orientation_b } (tip);";
    let gravity = "gravity [0.0, 0.0, -9.81];";
    alike(&pulled(weight, ""), &pulled("", gravity));
}

#[test]
fn a_load_in_axes_of_the_body_turns_with_it() {
    let moment = "load: Load { moment: [0.3, -0.2, 0.5] } (b);";
    let turned = "load: Load {
        axes: world, moment: joint.orientation_b * [0.3, -0.2, 0.5], orientation_at: joint.orientation_b
    } (b);";
    alike(&pulled(moment, ""), &pulled(turned, ""));
    let moved = pulled(moment, "");
    assert!(
        moved
            .iter()
            .zip(pulled("", ""))
            .any(|(a, b)| (a - b).abs() > 1e-3)
    );
}

#[test]
fn a_point_mass_is_a_body_without_inertia() {
    let bob = |part: &str| {
        format!(
            "1 tip[6]; arm: Offset {{ by: [0.1, -0.2, 0.3] }} (b, tip); bob: {part} {{ mass: 1.5 {} }} (tip);",
            if part == "Body" {
                ", inertia: 1e-13"
            } else {
                ""
            }
        )
    };
    let gravity = "gravity [0.5, 1.0, -9.81];";
    alike(
        &pulled(&bob("PointMass"), gravity),
        &pulled(&bob("Body"), gravity),
    );
}

#[test]
fn in_a_plane_a_load_and_a_point_mass_do_the_same() {
    let change = |parts: &str, gravity: &str| {
        let scene = Scene::of(&format!(
            "#[derivative] model Swing {{
                causality componentwise;
                {gravity}
                1 ground[3]; 1 b[3]; 1 tip[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                hinge: PlanarRevolute {{ initial: 0.3 }} (ground, b);
                arm: PlanarOffset {{ x: 0.5, y: 0.1 }} (b, tip);
                {parts}
                output angle = hinge.angle;
            }}"
        ));
        scene.run(Routines::DERIVATIVE, &scene.state(2))
    };
    let rod = "rod: PlanarBody { mass: 1e-13, inertia: 0.7 } (b);";
    let bob = format!("{rod} bob: PlanarPointMass {{ mass: 2.0 }} (tip);");
    let found = change(&bob, "gravity [0.0, -9.81];");
    let weight = format!("{bob} load: PlanarLoad {{ axes: world, force: [0.0, -19.62] }} (tip);");
    alike(&change(&weight, ""), &found);
    let moment = format!("{bob} load: PlanarLoad {{ moment: 0.4 }} (b);");
    let force =
        format!("{bob} load: PlanarLoad {{ force: [0.0, 0.8], angle_at: hinge.angle }} (tip);");
    alike(&change(&moment, ""), &change(&force, ""));
}

#[test]
fn friction_falls_from_its_breakaway_to_its_sliding_value() {
    let scene = Scene::of(
        "model Sliding {
            1 block { I body { inertia: 2.0 } }
            rubbing: Friction { sliding: 3.0, breakaway: 5.0, speed: 0.01, stribeck_speed: 0.1 } (block);
        }",
    );
    for speed in [-0.4, -0.05, 0.0, 0.003, 0.1, 2.0_f64] {
        let curve = 3.0 + 2.0 * (-(speed / 0.1).powi(2)).exp();
        let expected = -curve * (speed / 0.01).tanh();
        alike(
            &scene.run(Routines::DERIVATIVE, &[2.0 * speed]),
            &[expected],
        );
    }
}

#[test]
fn joints_start_with_their_rates_and_springs_at_rest() {
    let scene = Scene::of(
        "#[derivative] model Start {
            causality componentwise;
            1 ground[6]; 1 b[6];
            Sf fixed[6] { flow: 0.0 } -> ground;
            joint: Universal { initial: [0.3, 0.2], initial_rates: [0.5, -0.4], stiffness: [3.0, 4.0], rest: [0.1, 0.7] }
                (ground, b);
            body: Body { mass: 2.0, inertia: 3.0, centre: [0.1, 0.2, 0.3] } (b);
            output angle[2] = joint.angle;
            output rate[2] = joint.rate.f;
        }",
    );
    let start = scene.start();
    alike(&scene.run(Routines::OUTPUT, &start), &[0.3, 0.2, 0.5, -0.4]);
    let spring = ["joint.spring.q.x", "joint.spring.q.y"].map(|name| start[scene.place(name)]);
    alike(&spring, &[0.2, -0.5]);
    // ½ 3 · 0.2² + ½ 4 · 0.5², beside what moves.
    let mut still = start;
    for name in ["joint.rate.f.x", "joint.rate.f.y"] {
        let place = scene.place(name);
        still[place] = 0.0;
    }
    alike(&scene.run(Routines::ENERGY, &still), &[0.56]);
}

#[test]
fn a_joint_in_a_plane_that_blocks_nothing_tells_where_a_body_is() {
    let scene = Scene::of(
        "model Thrown {
            gravity [0.3, -9.81];
            1 ground[3]; 1 b[3];
            Sf fixed[3] { flow: 0.0 } -> ground;
            free: PlanarFree {
                initial: 0.3, initial_rate: 0.5, initial_position: [1.0, 2.0], initial_velocity: [3.0, -4.0]
            } (ground, b);
            body: PlanarBody { mass: 2.0, inertia: 0.3 } (b);
            output place[3] = [free.angle, free.position.x, free.position.y];
            output flow[3] = b.f;
        }",
    );
    let start = scene.start();
    let expected = [0.3, 1.0, 2.0, 0.5, 3.0, -4.0];
    alike(&scene.run(Routines::OUTPUT, &start), &expected);
    let rates = scene.run(Routines::DERIVATIVE, &start);
    let changes = scene.along(Routines::OUTPUT, &start, &rates);
    alike(&changes, &[0.5, 3.0, -4.0, 0.0, 0.3, -9.81]);
}

/// Wherever it is counted from a body flies as it does alone, and what is between both pushes both.
#[test]
fn what_flies_in_a_plane_may_be_counted_from_what_turns() {
    let scene = |push: &str| {
        Scene::of(&format!(
            "#[derivative] model Thrown {{
                causality componentwise;
                gravity [0.3, -9.81];
                1 ground[3]; 1 arm[3]; 1 tip[3]; 1 b[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                hinge: PlanarRevolute (ground, arm);
                rod: PlanarOffset {{ x: 0.7, y: 0.2 }} (arm, tip);
                wheel: PlanarBody {{ mass: 1.0, inertia: 0.4 }} (arm);
                free: PlanarFree {{ {push} }} (tip, b);
                body: PlanarBody {{ mass: 2.0, inertia: 0.3 }} (b);
                output place[3] = [free.angle_b, free.position_b.x, free.position_b.y];
                output flow[3] = b.f;
                output swing[2] = [hinge.angle, arm.f[0]];
            }}"
        ))
    };
    let changes = |scene: &Scene, state: &[f64]| {
        let rates = scene.run(Routines::DERIVATIVE, state);
        scene.along(Routines::OUTPUT, state, &rates)
    };
    let free = scene("");
    let pushed = scene("force: [0.8, -0.3], torque: 0.9");
    assert_eq!(free.names(), pushed.names());
    for seed in 0..3 {
        let state = free.state(seed);
        let [moved, pushed] = [&free, &pushed].map(|scene| changes(scene, &state));
        let outputs = free.run(Routines::OUTPUT, &state);
        alike(&moved[..3], &outputs[3..6]);
        alike(&moved[3..], &[0.0, 0.3, -9.81, outputs[7], 0.0]);
        // Its axes are those of the arm, on which it pushes back at the place of the body.
        let (sin, cos) = outputs[6].sin_cos();
        let force = [0.8 * cos + 0.3 * sin, 0.8 * sin - 0.3 * cos];
        let moment = outputs[1] * force[1] - outputs[2] * force[0] + 0.9;
        let expected = [
            0.9 / 0.3,
            0.3 + force[0] / 2.0,
            force[1] / 2.0 - 9.81,
            outputs[7],
            -moment / 0.4,
        ];
        alike(&pushed[3..], &expected);
    }
}
