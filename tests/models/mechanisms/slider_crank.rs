//! Slider-cranks that turn over: a planar one of equal links, which passes both dead centres and, where both links
//! lie on one another, a singular position; and the spatial one of the benchmarks.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, states};
use crate::references::errors::apart;
use crate::references::integrate::integrate;
use crate::references::slider_crank::{DURATION, RATE, angle, slider};

mbg! {
    include "tests/models/mechanisms/slider_crank.mbg";

    /// Crank and rod are of 1 m and 1 kg, the slider of 1 kg.
    #[derivative]
    pub(crate) model PlanarSliderCrank {
        causality componentwise;
        1 ground[3]; 1 elbow[3]; 1 tip[3]; 1 block[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        crank: PlanarLink { mass: 1.0, inertia: 1.0 / 12, centre: [0.5, 0.0], end: [1.0, 0.0] } (ground, elbow);
        rod: PlanarLink {
            mass: 1.0, inertia: 1.0 / 12, centre: [0.5, 0.0], end: [1.0, 0.0]
        } (elbow, tip);
        slide: PlanarPrismatic { initial: 2.0 } (ground, block);
        slide.rate -> I slider { inertia: 1.0 };
        let open = rod.position_b - slide.position_b;
        close tip[1..3] -> block[1..3] by multipliers, displacement: open;
        output gap[2]: m = open;
        output point[2] = [crank.hinge.angle, slide.travel];
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
