//! A car starts on a hill by its clutch, and is held there by its brake.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};

mbg! { include "examples/gallery/hill_start.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let car = HillStart::<f64>::new(HillStartParameters::default())?;
    let found = run(&car, &(), car.initial_state(), 6.0, 3000)?;
    let line = |output: usize| over(&found, |it| it.output[output]);
    let most = line(5).into_iter().step_by(60).collect();
    let speeds = Panel::new("Speeds", "time in s", "speed in rad/s")
        .line("wheels, times the gear of 14", GREEN, line(2))
        .line("clutch plate", ORANGE, line(1))
        .line("engine", BLUE, line(0));
    let torques = Panel::new("Dry friction", "time in s", "torque in N m")
        .line("brake, behind the gear of 14", GREEN, line(4))
        .line("clutch", BLUE, line(3))
        .dots("most that the clutch takes", GREY, most);
    picture(
        path,
        "A car starts on a hill: what slips is caught, and what rests is held",
        400,
        &[speeds, torques],
    )
}
