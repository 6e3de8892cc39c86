//! A DC motor starts a geared load on a flexible shaft, which is braked after 0.2 s.

#[path = "../dc_motor/model.rs"]
#[allow(dead_code, unreachable_pub)]
mod model;

use std::error::Error;
use std::path::Path;

use mbg_runtime::System;
use model::{Motor, MotorParameters, REFERENCE, brake};

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let motor = Motor::<f64>::new(MotorParameters::default())?;
    let found = run(&motor, &brake(), motor.initial_state(), 0.5, 2000)?;
    let shown = REFERENCE.iter().filter(|it| it.time <= 0.5);
    let current = Panel::new("Armature", "time in s", "current in A")
        .line("current", BLUE, over(&found, |it| it.output[0]))
        .dots(
            "matrix exponential",
            GREY,
            shown.map(|it| (it.time, it.output[0])).collect(),
        );
    let speed = Panel::new("Shaft", "time in s", "speed in rad/s")
        .line(
            "motor, behind the gear of 20",
            ORANGE,
            over(&found, |it| it.output[1] / 20.0),
        )
        .line("load", BLUE, over(&found, |it| it.output[2]));
    picture(
        path,
        "A DC motor starts a load, which is braked from 0.2 s on",
        400,
        &[current, speed],
    )
}
