//! Cuts: a tree of joints that is closed by one moves as the joint of the same kind does.

use mbg_compiler::compile::Routines;

use crate::rows;
use crate::scene::Scene;

/// A body that six joint axes leave free, and what is held of it.
fn scene(cut: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Held {{
            causality componentwise;
            gravity [0.5, 1.0, -9.81];
            1 ground[6]; 1 plate[6]; 1 lift[6]; 1 b[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            plane: Planar {{ axis: 2 }} (ground, plate);
            height: Prismatic {{
                axis: 2, gravity_a: plane.gravity_b, orientation_a: plane.orientation_b, position_a: plane.position_b
            }} (plate, lift);
            cross: Universal {{
                gravity_a: height.gravity_b, orientation_a: height.orientation_b, position_a: height.position_b
            }} (lift, b);
            {cut}
            body: Body {{
                mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, -0.3], gravity_at: cross.gravity_b
            }} (b);
            output spin[3] = b.f[0..3];
            output velocity[3] = b.f[3..6];
        }}"
    ))
}

fn closed(word: &str) -> Scene {
    scene(&format!(
        "cut: Cut {{
            joint: {word}, orientation_a: diag(1.0, 1.0, 1.0), orientation_b: cross.orientation_b,
            position_a: 0.0, position_b: cross.position_b
        }} (ground, b);"
    ))
}

/// How the flows of the body change, from a state in which it turns at a rate about the axis z, at the angle zero.
fn change(scene: &Scene, rate: f64) -> Vec<f64> {
    let mut state = vec![0.0; scene.model.states.len()];
    state[scene.place("plane.turning.f")] = rate;
    let rates = scene.run(Routines::DERIVATIVE, &state);
    scene.along(Routines::OUTPUT, &state, &rates)
}

#[test]
fn cuts_take_the_degrees_of_freedom_of_the_table() {
    let table = rows(3);
    assert_eq!(table.len(), 7);
    for row in table.iter().filter(|row| row[0] == "Cut") {
        let scene = closed(row[1]);
        assert_eq!(scene.velocities(), 6);
        let closings = scene.model.closed.each_ref().map(Vec::len);
        assert_eq!(closings, [row[2].parse().unwrap(); 2], "{}", row[1]);
    }
}
