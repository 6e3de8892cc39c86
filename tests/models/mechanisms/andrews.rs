//! Andrews' squeezing mechanism: seven bodies, three loops in a plane, a motor and a spring.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task};
use crate::references::andrews::REFERENCE;
use crate::references::errors::larger;

mbg! {
    /// Lengths, masses and angles at the start are those of the reference.
    #[derivative]
    pub(crate) model Andrews {
        causality componentwise;
        let anchor = [-0.06934, -0.00227];
        let pivot = [-0.03635, 0.03273];

        1 ground[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        1 end1[3]; 1 end2[3]; 1 end3[3]; 1 end4[3]; 1 end5[3]; 1 end6[3]; 1 end7[3];
        k1: PlanarLink {
            mass: 0.04325, inertia: 2.194e-6, centre: [92e-5, 0.0], end: [7e-3, 0.0],
            initial: -0.06171389001427645, torque: 33e-3
        } (ground, end1);
        k2: PlanarLink {
            mass: 0.00365, inertia: 4.410e-7, centre: [-115e-4, 0.0], end: [-28e-3, 0.0]
        } (end1, end2);
        k3: PlanarLink {
            mass: 0.02373, inertia: 5.255e-6, centre: [1874e-5, 1043e-5], end: [0.0, -35e-3],
            initial: 0.45527981916307037, position_a: pivot
        } (ground, end3);
        k5: PlanarLink {
            mass: 0.07050, inertia: 1.169e-5, centre: [2308e-5, 916e-5], end: [4e-2, 0.0],
            initial: 0.48736497954384256, position_a: anchor
        } (ground, end5);
        k4: PlanarLink {
            mass: 0.00706, inertia: 5.667e-7, centre: [0.0, -579e-5], end: [0.0, -2e-2],
            initial: 0.22266839016588588
        } (end5, end4);
        k7: PlanarLink {
            mass: 0.05498, inertia: 1.912e-5, centre: [1228e-5, 449e-5], end: [0.0, -4e-2],
            initial: 1.2305474445498212, position_a: anchor
        } (ground, end7);
        k6: PlanarLink {
            mass: 0.00706, inertia: 5.667e-7, centre: [579e-5, 0.0], end: [2e-2, 0.0],
            initial: -0.22266839016588588
        } (end7, end6);

        let open3 = k2.position_b - k3.position_b;
        let open4 = k2.position_b - k4.position_b;
        let open6 = k2.position_b - k6.position_b;
        close end2[1..3] -> end3[1..3] by multipliers, displacement: open3;
        close end2[1..3] -> end4[1..3] by multipliers, displacement: open4;
        close end2[1..3] -> end6[1..3] by multipliers, displacement: open6;

        // The spring supplies its force as a function of the place, so that its energy is no state.
        1 hook[3];
        arm: PlanarOffset { x: 2e-2, y: -18e-3 } (k3.foot, hook);
        let drawn = arm.position_b - [0.014, 0.072];
        let length = sqrt(powi(drawn.x, 2) + powi(drawn.y, 2));
        Se spring[2] { effort: 4530.0 * (0.07785 / length - 1.0) * drawn } -> hook[1..3];

        output gap[6]: m = [open3.x, open3.y, open4.x, open4.y, open6.x, open6.y];
        output balance: J = 0.5 * 4530.0 * powi(length - 0.07785, 2) - 33e-3 * k1.hinge.angle;
        output point[7]: rad = [
            k1.hinge.angle, k2.hinge.angle, k3.hinge.angle, k4.hinge.angle, k5.hinge.angle, k6.hinge.angle,
            k7.hinge.angle
        ];
    }
}

pub(crate) fn run() -> Figures {
    let system = Andrews::new(AndrewsParameters::default()).unwrap();
    let start = system.initial_state();
    let task = Task {
        mechanism: "Andrews' squeezer",
        system,
        start,
        horizon: 0.03,
        instants: 6,
        method: Method::Pair(1e-11),
    };
    task.run(|t, angles| {
        let instant = REFERENCE
            .iter()
            .find(|instant| (instant.time - t).abs() < 1e-9)
            .unwrap();
        let errors = angles
            .iter()
            .zip(instant.angles)
            .map(|(angle, expected)| angle / expected - 1.0);
        errors.map(f64::abs).fold(0.0, larger)
    })
}
