//! The stiff flyball governor: open loops, which two springs with dampers lead across.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, apart, states};
use crate::references::governor::{DURATION, RATE, START, motion};

mbg! {
    /// A rod with its ball, pinned to the shaft, and a spring with a damper from its middle to the slider. The frame of
    /// the rod has x along it; at the angle zero that is x of the shaft, turned by `side`.
    component Arm(port shaft[6], port slider[6]) {
        param side;
        param height: m;

        // Rod and ball are one rigid body.
        let mass = 0.3 + 5.0;
        let moment = 0.5 * 0.3 + 5.0;
        let across = 0.3 * 1.0001 / 12 + 0.25 * 0.3 + 5.0 - moment * moment / mass;

        1 beside[6]; 1 pin[6]; 1 rod[6]; 1 middle[6]; 1 head[6]; 1 below[6]; 1 foot[6];
        shaft_side: Turn { by: side } (shaft, beside);
        to_pin: Offset { by: [0.05, 0.0, 1.0] } (beside, pin);
        hinge: Revolute { axis: 1, initial: 0.5235987755982988 } (pin, rod);
        body: Body {
            mass: mass, inertia: diag(0.3 * 1e-4 / 6, across, across), centre: [moment / mass, 0.0, 0.0],
            gravity_at: hinge.gravity_b
        } (rod);

        to_middle: Offset { by: [0.5, 0.0, 0.0], orientation: hinge.turn, position_a: [0.05, 0.0, 1.0] } (rod, middle);
        aligned: Turn { by: transpose(hinge.turn) } (middle, head);
        slider_side: Turn { by: side } (slider, below);
        to_foot: Offset { by: [0.05, 0.0, 0.0], position_a: [0.0, 0.0, height] } (below, foot);
        let span = to_middle.position_b - to_foot.position_b;
        let length = sqrt(powi(span.x, 2) + powi(span.z, 2));

        0 between[3];
        1 stretch {
            C spring { stiffness: 8e5 }
            R damper { resistance: 4e4 }
        }
        head[3..6] -> between;
        between -> foot[3..6];
        between -> MTF along { flow: [[span.x / length, 0.0, span.z / length]] } -> stretch;
        integral lost: J = damper.e * damper.f;
        output balance: J = lost - 9.81 * moment * sin(hinge.angle);
    }

    #[derivative]
    pub(crate) model Governor {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 ground[6]; 1 shaft[6]; 1 slider[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        bearing: Revolute { axis: 2 } (ground, shaft);
        shaft[2] -> I spin { inertia: 0.3 * 1e-4 / 6 };
        slide: Prismatic { axis: 2, initial: 0.5 } (shaft, slider);
        block: Body { mass: 3.0, inertia: 3.0 * 0.01 / 6 } (slider);
        right: Arm { side: diag(1.0, 1.0, 1.0), height: slide.travel } (shaft, slider);
        left: Arm { side: diag(-1.0, -1.0, 1.0), height: slide.travel } (shaft, slider);
        output balance: J = 9.81 * 3.0 * slide.travel;
        // The springs must go along with the rods.
        output point[3]: m = [
            slide.travel, right.length - 0.5 - right.spring.q, left.length - 0.5 - left.spring.q
        ];
    }
}

pub(crate) fn run() -> Figures {
    let system = Governor::new(GovernorParameters::default()).unwrap();
    let mut start = system.initial_state();
    start[states(Governor::<f64>::META, "bearing.rate.f")[0]] = RATE;
    let task = Task {
        mechanism: "flyball governor",
        system,
        start,
        horizon: DURATION,
        instants: 10,
        method: Method::Pair(1e-9),
    };
    let reference = std::cell::Cell::new((0.0, START));
    task.run(|t, point| {
        let (before, x) = reference.get();
        let x = motion(x, (before, t)).0;
        reference.set((t, x));
        apart(point, &[x[1], 0.0, 0.0])
    })
}
