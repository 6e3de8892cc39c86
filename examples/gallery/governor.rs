//! The stiff flyball governor of the benchmarks.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::references::governor;
use crate::run::{over, run, states};

mbg! { include "tests/models/mechanisms/governor.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let model = Governor::<f64>::new(GovernorParameters::default())?;
    let rate = states(&model, "bearing.rate.f")[0];
    let travel = states(&model, "slide.travel")[0];
    let mut start = model.initial_state();
    start[rate] = TAU;
    let found = run(&model, &(), start, 5.0, 2000)?;
    let slider = Panel::new("Slider", "time in s", "height in m").line(
        "height",
        BLUE,
        over(&found, |it| it.state[travel]),
    );
    let known = (0..=20).map(|k| 0.25 * f64::from(k));
    let known = known.map(|t| (t, governor::motion(governor::START, (0.0, t)).0[1]));
    let slider = slider.dots("reduced by hand", GREY, known.collect());
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
