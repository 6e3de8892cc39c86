//! The stiff flyball governor of the benchmarks.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, ORANGE, Panel, picture};
use crate::run::{over, run, states};

mbg! { include "tests/models/mechanisms/governor.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let governor = Governor::<f64>::new(GovernorParameters::default())?;
    let rate = states(&governor, "bearing.rate.f")[0];
    let travel = states(&governor, "slide.travel")[0];
    let mut start = governor.initial_state();
    start[rate] = TAU;
    let found = run(&governor, &(), start, 5.0, 2000)?;
    let slider = Panel::new("Slider", "time in s", "height in m").line(
        "height",
        BLUE,
        over(&found, |it| it.state[travel]),
    );
    let shaft = Panel::new("Shaft", "time in s", "rate in rad/s").line(
        "rate",
        ORANGE,
        over(&found, |it| it.state[rate]),
    );
    picture(
        path,
        "A flyball governor: the balls rise, the shaft slows down",
        400,
        &[slider, shaft],
    )
}
