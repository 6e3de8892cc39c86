//! Bricard's mechanism: five rods between six hinges, of whose equations one is redundant in every position.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, apart};
use crate::references::bricard::{DURATION, recorded};

mbg! {
    /// The axes of a rod's frame: x along it, y that of the hinge it turns about, z that of the next hinge. The last
    /// hinge is closed: the end of the last rod stays where it is, and its z axis along the world's x axis.
    #[derivative]
    pub(crate) model Bricard {
        causality componentwise;
        gravity [0.0, -9.81, 0.0];
        let along_ground = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
        let twist = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];

        1 ground[6]; 1 last_in_world[6]; 1 tilt[2]; 1 upright[2];
        Sf fixed[6] { flow: 0.0 } -> ground;
        Sf held[2] { flow: 0.0 } -> upright;
        joints: for k in 0..5 { 1 frame[6]; }
        onto: Turn { by: along_ground } (ground, joints[0].frame);
        rods: for k in 0..5 {
            1 rod[6]; 1 end[6];
            let orientation = if k == 0 { along_ground } else { rods[k-1].orientation_end };
            let down[3] = if k == 0 { onto.gravity_b } else { rods[k-1].down_end };
            let from[3] = if k == 0 { 0.0 } else { rods[k-1].arm.position_b };
            hinge: Revolute { axis: 1, initial: -1.5707963267948966, gravity_a: down, orientation_a: orientation }
                (joints[k].frame, rod);
            body: Body {
                mass: 1.0, inertia: diag(0.01 / 6, 1.01 / 12, 1.01 / 12), centre: [0.5, 0.0, 0.0],
                gravity_at: hinge.gravity_b
            } (rod);
            arm: Offset { by: [1.0, 0.0, 0.0], orientation: hinge.orientation_b, position_a: from } (rod, end);
            let height = 0.5 * (from.y + arm.position_b.y) + if k == 0 { 0.0 } else { rods[k-1].height };
            let by = if k % 2 == 0 { twist } else { transpose(twist) };
            let orientation_end = hinge.orientation_b * by;
            let down_end[3] = transpose(by) * hinge.gravity_b;
        }
        for k in 0..4 { turn: Turn { by: rods[k].by } (rods[k].end, joints[k+1].frame); }
        turn: Turn { by: transpose(rods[4].hinge.orientation_b) } (rods[4].end, last_in_world);

        let place = rods[4].arm.position_b - [0.0, 0.0, 1.0];
        let axis = rods[4].hinge.orientation_b * [0.0, 0.0, 1.0];
        // The rate of y and z of the axis: those of ω × axis.
        last_in_world[0..3] -> MTF tilting { flow: [[-axis.z, 0.0, axis.x], [axis.y, -axis.x, 0.0]] } -> tilt;
        close last_in_world[3..6] -> ground[3..6] by multipliers, displacement: place;
        close tilt -> upright by multipliers, displacement: [axis.y, axis.z];
        output gap[5] = [place.x, place.y, place.z, axis.y, axis.z];
        output balance: J = 9.81 * rods[4].height;
        output point[3]: m = rods[1].arm.position_b;
    }
}

pub(crate) fn run() -> Figures {
    let system = Bricard::new(BricardParameters::default()).unwrap();
    let start = system.initial_state();
    let task = Task {
        mechanism: "Bricard",
        system,
        start,
        horizon: DURATION,
        instants: 20,
        method: Method::Pair(1e-10),
    };
    task.run(|t, point| apart(point, &recorded(t)))
}
