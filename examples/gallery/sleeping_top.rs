//! A top that stands upright sleeps when it turns fast enough.

use std::error::Error;
use std::path::Path;

use mbg_runtime::System;

use crate::draw::{BLUE, GREEN, GREY, ORANGE, PURPLE, Panel, picture};
use crate::orientation::SLEEPING;
use crate::run::{over, run};
use crate::top::{TopQuaternion, TopQuaternionParameters, axis};

/// Above this rate the upright top is stable: √(4 · 0.8 kg m² · 5 N m) / 0.3 kg m².
const LIMIT: f64 = 40.0 / 3.0;

/// Tilt in degrees.
fn tilt(quaternion: &[f64]) -> f64 {
    let [x, y, z] = axis(quaternion);
    x.hypot(y).atan2(z).to_degrees()
}

fn turning(rate: f64) -> Result<TopQuaternion, mbg_runtime::ParameterError> {
    TopQuaternion::new(TopQuaternionParameters { tilt: 0.01, rate })
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let mut falls = Panel::new("Started at 0.57°", "time in s", "tilt in °");
    for (rate, color) in [(12.0, PURPLE), (13.2, BLUE), (13.4, GREEN), (14.0, ORANGE)] {
        let top = turning(rate)?;
        let found = run(&top, &(), top.initial_state(), 20.0, 2000)?;
        let points = over(&found, |it| tilt(&it.output.as_slice()[3..7]));
        falls = falls.line(&format!("{rate} rad/s"), color, points);
    }
    let known = SLEEPING.iter().map(|row| (row.0, tilt(&row.2))).collect();
    falls = falls.dots("elliptic functions", GREY, known);

    let mut largest = Vec::new();
    for step in 0..=80 {
        let rate = 8.0 + 0.1 * f64::from(step);
        let top = turning(rate)?;
        let found = run(&top, &(), top.initial_state(), 20.0, 2000)?;
        let tilts = found.iter().map(|it| tilt(&it.output.as_slice()[3..7]));
        largest.push((rate, tilts.fold(0.0, f64::max)));
    }
    let highest = largest.iter().map(|it| it.1).fold(0.0, f64::max);
    let fork = Panel::new("Largest tilt", "rate in rad/s", "tilt in °")
        .dashes(
            "stable above 13.33 rad/s",
            GREY,
            vec![(LIMIT, 0.0), (LIMIT, highest)],
        )
        .line("over 20 s", BLUE, largest)
        .weight(0.8);
    picture(
        path,
        "An upright top sleeps above a rate, and falls and rises below it",
        400,
        &[falls, fork],
    )
}
