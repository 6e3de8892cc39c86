//! Slider-cranks that turn over: a planar one of equal links, which passes both dead centres and, where both links
//! lie on one another, a singular position; and the spatial one of the benchmarks.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, apart, states};
use crate::references::integrate::integrate;
use crate::references::slider_crank::{DURATION, RATE, angle, slider};

mbg! {
    /// Crank and rod are of 1 m and 1 kg, the slider of 1 kg.
    #[derivative]
    pub(crate) model PlanarSliderCrank {
        causality componentwise;
        1 ground[3]; 1 elbow[3]; 1 tip[3]; 1 block[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        crank: PlanarLink { mass: 1.0, inertia: 1.0 / 12, centre: [0.5, 0.0], end: [1.0, 0.0] } (ground, elbow);
        rod: PlanarLink {
            mass: 1.0, inertia: 1.0 / 12, centre: [0.5, 0.0], end: [1.0, 0.0],
            angle_a: crank.angle_b, position_a: crank.position_b
        } (elbow, tip);
        slide: PlanarPrismatic { initial: 2.0 } (ground, block);
        slide.rate -> I slider { inertia: 1.0 };
        let open = rod.position_b - slide.position_b;
        close tip[1..3] -> block[1..3] by multipliers, displacement: open;
        output gap[2]: m = open;
        output point[2] = [crank.hinge.angle, slide.travel];
    }

    /// The rod hangs on the slider by a universal joint; its other end meets the tip of the crank.
    #[derivative]
    pub(crate) model SpatialSliderCrank {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 ground[6]; 1 crank[6]; 1 tip[6]; 1 block[6]; 1 cross[6]; 1 rod[6]; 1 end[6];
        1 tip_in_world[6]; 1 end_in_world[6];
        Sf fixed[6] { flow: 0.0 } -> ground;

        bearing: Revolute { axis: 0 } (ground, crank);
        crank_body: Body {
            mass: 0.12, inertia: diag(1e-4, 1e-4, 1e-5), centre: [0.0, 0.0, 0.04], gravity_at: bearing.gravity_b
        } (crank);
        crank_arm: Offset {
            by: [0.0, 0.0, 0.08], orientation: bearing.orientation_b, position_a: [0.0, 0.1, 0.12]
        } (crank, tip);
        tip_turn: Turn { by: transpose(bearing.orientation_b) } (tip, tip_in_world);

        slide: Prismatic { axis: 0, initial: 0.2 } (ground, block);
        slide.rate -> I slider { inertia: 2.0 };
        roll: Revolute { axis: 0, initial: -0.4636476090008061 } (block, cross);
        pitch: Revolute {
            axis: 1, initial: 0.8410686705679303, gravity_a: roll.gravity_b, orientation_a: roll.orientation_b
        } (cross, rod);
        rod_body: Body {
            mass: 0.5, inertia: diag(4e-4, 4e-3, 4e-3), centre: [-0.15, 0.0, 0.0], gravity_at: pitch.gravity_b
        } (rod);
        rod_arm: Offset { by: [-0.3, 0.0, 0.0], orientation: pitch.orientation_b, position_a: slide.arm } (rod, end);
        end_turn: Turn { by: transpose(pitch.orientation_b) } (end, end_in_world);

        let open = crank_arm.position_b - rod_arm.position_b;
        close tip_in_world[3..6] -> end_in_world[3..6] by multipliers, displacement: open;
        output gap[3]: m = open;
        let height = crank_arm.position_b.z;
        output balance: J = 9.81 * (0.06 * (height + 0.12) + 0.25 * height);
        output point[2] = [bearing.angle, slide.travel];
    }
}

/// Rate of the planar crank at the start in rad/s.
const PLANAR_RATE: f64 = 2.0;

/// Angle of the planar crank at time `t`: the energy `½ (2/3 + 6 sin² θ) θ̇²` is that of the start, in kg and m.
fn planar_angle(t: f64) -> f64 {
    let rate = |angle: f64| PLANAR_RATE / (1.0 + 9.0 * angle.sin().powi(2)).sqrt();
    let steps = (40.0 * t).ceil() as usize;
    integrate(|_, [angle]| [rate(*angle)], (0.0, t), steps, [0.0])[0]
}

pub(crate) fn planar() -> Figures {
    let system = PlanarSliderCrank::new(PlanarSliderCrankParameters::default()).unwrap();
    let mut start = system.initial_state();
    let rates = [
        ("crank.hinge.rate.f", PLANAR_RATE),
        ("rod.hinge.rate.f", -2.0 * PLANAR_RATE),
    ];
    for (name, rate) in rates {
        start[states(PlanarSliderCrank::<f64>::META, name)[0]] = rate;
    }
    let task = Task {
        mechanism: "slider-crank",
        system,
        start,
        horizon: 20.0,
        instants: 20,
        method: Method::Fixed(1e-3),
    };
    task.run(|t, point| {
        let angle = planar_angle(t);
        apart(point, &[angle, 2.0 * angle.cos()])
    })
}

pub(crate) fn spatial() -> Figures {
    let system = SpatialSliderCrank::new(SpatialSliderCrankParameters::default()).unwrap();
    let meta = SpatialSliderCrank::<f64>::META;
    let mut start = system.initial_state();
    let crank = ["bearing.angle", "bearing.rate.f"].map(|name| states(meta, name)[0]);
    start[crank[1]] = RATE;
    let start = system.close(0.0, start, &[].into(), &crank).unwrap();
    let task = Task {
        mechanism: "spatial slider-crank",
        system,
        start,
        horizon: DURATION,
        instants: 20,
        method: Method::Pair(1e-10),
    };
    task.run(|t, point| {
        let angle = angle(t);
        apart(point, &[angle, slider(angle)])
    })
}
