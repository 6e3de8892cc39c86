//! Rows of four-bars, which turn over through the position in which all links lie on one line.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, states};
use crate::references::errors::apart;
use crate::references::four_bar::{DURATION, RATE, tip};

mbg! {
    include "tests/models/mechanisms/two_four_bars.mbg";

    #[derivative]
    pub(crate) model FourBar {
        causality componentwise;
        gravity [0.0, -9.81];
        row: Row { loops: 1 } ();
    }

    #[derivative]
    pub(crate) model FourBars5 {
        causality componentwise;
        gravity [0.0, -9.81];
        row: Row { loops: 5 } ();
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
