//! A quarter of a car over a bump.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use mbg_runtime::{Smooth, System, mbg};
use nalgebra::SVector;

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};

mbg! { include "examples/gallery/quarter_car.mbg"; }

/// Time from the start of the bump over how long it takes, while the wheel is on it.
fn passed(t: f64) -> Option<f64> {
    let part = (t - 0.2) / 0.1;
    (0.0..1.0).contains(&part).then_some(part)
}

/// A cosine of 8 cm over 0.6 m, passed at 6 m/s: height in m.
fn height(t: f64) -> f64 {
    passed(t).map_or(0.0, |part| 0.04 * (1.0 - (2.0 * PI * part).cos()))
}

fn rate(t: f64) -> SVector<f64, 1> {
    let rate = |part| 0.04 * 20.0 * PI * f64::sin(2.0 * PI * part);
    SVector::from([passed(t).map_or(0.0, rate)])
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let car = QuarterCar::<f64>::new(QuarterCarParameters::default())?;
    let found = run(&car, &Smooth(rate), car.initial_state(), 2.0, 1000)?;
    let road = found
        .iter()
        .map(|it| (it.time, 1e3 * height(it.time)))
        .collect();
    let places = Panel::new("Places from rest", "time in s", "height in mm")
        .dashes("road", GREY, road)
        .line("wheel", ORANGE, over(&found, |it| 1e3 * it.output[1]))
        .line("body", BLUE, over(&found, |it| 1e3 * it.output[0]));
    let speeds = Panel::new("Speeds", "time in s", "speed in m/s")
        .line("wheel", ORANGE, over(&found, |it| it.output[3]))
        .line("body", BLUE, over(&found, |it| it.output[2]));
    picture(
        path,
        "A quarter of a car over a bump of 8 cm at 6 m/s",
        400,
        &[places, speeds],
    )
}
