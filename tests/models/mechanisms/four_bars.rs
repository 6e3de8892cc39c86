//! Rows of four-bars, which turn over through the position in which all links lie on one line.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, apart, states};
use crate::references::four_bar::{DURATION, RATE, tip};

mbg! {
    /// Cranks on the ground 1 m apart, and couplers between their tips; all links are rods of 1 m and 1 kg.
    component Row(port ground[3]) {
        param loops;
        cranks: for k in 0..loops + 1 {
            1 tip[3];
            link: PlanarLink {
                mass: 1.0, inertia: 1.0 / 12, centre: [0.5, 0.0], end: [1.0, 0.0],
                initial: 1.5707963267948966, position_a: [k, 0.0]
            } (ground, tip);
            let height = link.position_centre.y + if k > 0 { cranks[k-1].height } else { 0.0 };
        }
        couplers: for k in 0..loops {
            1 tip[3];
            link: PlanarLink {
                mass: 1.0, inertia: 1.0 / 12, centre: [0.5, 0.0], end: [1.0, 0.0],
                initial: -1.5707963267948966,
                angle_a: cranks[k].link.angle_b, position_a: cranks[k].link.position_b
            } (cranks[k].tip, tip);
            let open = link.position_b - cranks[k+1].link.position_b;
            close tip[1..3] -> cranks[k+1].tip[1..3] by multipliers, displacement: open;
            let height = link.position_centre.y + if k > 0 { couplers[k-1].height } else { cranks[loops].height };
            output gap[2]: m = open;
        }
        output balance: J = 9.81 * couplers[loops-1].height;
        output point[2]: m = cranks[0].link.position_b;
    }

    #[derivative]
    pub(crate) model FourBar {
        causality componentwise;
        gravity [0.0, -9.81];
        1 ground[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        row: Row { loops: 1 } (ground);
    }

    #[derivative]
    pub(crate) model FourBars2 {
        causality componentwise;
        gravity [0.0, -9.81];
        1 ground[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        row: Row { loops: 2 } (ground);
    }

    #[derivative]
    pub(crate) model FourBars5 {
        causality componentwise;
        gravity [0.0, -9.81];
        1 ground[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        row: Row { loops: 5 } (ground);
    }
}

fn run<S, const N: usize, const P: usize>(
    mechanism: &'static str,
    loops: usize,
    system: S,
) -> Figures
where
    S: System<f64, N, 0, P>,
{
    let mut start = system.initial_state();
    states(S::META, "rate.f")
        .iter()
        .enumerate()
        .for_each(|(link, rate)| {
            start[*rate] = if link <= loops { RATE } else { -RATE };
        });
    let task = Task {
        mechanism,
        system,
        start,
        horizon: DURATION,
        instants: 20,
        method: Method::Fixed(1e-3),
    };
    task.run(|t, point| apart(point, &tip(loops, t)[0]))
}

pub(crate) fn run1() -> Figures {
    run(
        "four-bar",
        1,
        FourBar::new(FourBarParameters::default()).unwrap(),
    )
}
pub(crate) fn run2() -> Figures {
    run(
        "2 four-bars",
        2,
        FourBars2::new(FourBars2Parameters::default()).unwrap(),
    )
}
pub(crate) fn run5() -> Figures {
    run(
        "5 four-bars",
        5,
        FourBars5::new(FourBars5Parameters::default()).unwrap(),
    )
}
