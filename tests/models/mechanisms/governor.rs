//! The stiff flyball governor: open loops, which two springs with dampers lead across.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task, states};
use crate::references::errors::apart;
use crate::references::governor::{DURATION, RATE, START, motion};

mbg! {
    include "tests/models/mechanisms/governor.mbg";
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
