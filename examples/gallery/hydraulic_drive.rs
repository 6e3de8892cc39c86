//! A hydraulic cylinder is driven out against a load.

#[path = "../hydraulic_drive/model.rs"]
#[allow(dead_code, unreachable_pub)]
mod model;

use std::error::Error;
use std::path::Path;

use mbg_runtime::{Pulse, System};
use model::{Drive, DriveParameters};
use nalgebra::SVector;

use crate::draw::{BLUE, GREEN, ORANGE, PURPLE, Panel, picture};
use crate::run::{over, run};

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let drive = Drive::<f64>::new(DriveParameters::default())?;
    let load = Pulse {
        amplitude: SVector::from([5e3]),
        start: 0.6,
        end: 1.0,
    };
    let found = run(&drive, &load, drive.initial_state(), 1.5, 3000)?;
    let pressure = |place: usize| over(&found, |it| it.output[place] / 1e6);
    let pressures = Panel::new("Pressures", "time in s", "pressure in MPa")
        .line("supply", BLUE, pressure(0))
        .line("head", ORANGE, pressure(1))
        .line("back", GREEN, pressure(2));
    let travel = Panel::new("Rod", "time in s", "travel in mm").line(
        "travel",
        PURPLE,
        over(&found, |it| 1e3 * it.output[3]),
    );
    picture(
        path,
        "A hydraulic cylinder meets a load of 5 kN from 0.6 s to 1 s",
        400,
        &[pressures, travel],
    )
}
