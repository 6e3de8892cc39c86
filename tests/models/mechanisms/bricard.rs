//! Bricard's mechanism: five rods between six hinges, of whose equations one is redundant in every position.

use mbg_runtime::{System, mbg};

use super::{Figures, Method, Task};
use crate::references::bricard::{DURATION, recorded};
use crate::references::errors::apart;

mbg! {
    include "tests/models/mechanisms/bricard.mbg";
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
