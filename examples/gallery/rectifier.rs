//! A half-wave rectifier.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::references::rectifier;
use crate::run::{over, run};

mbg! { include "examples/gallery/rectifier.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let model = Rectifier::<f64>::new(RectifierParameters::default())?;
    let found = run(&model, &(), model.initial_state(), 0.06, 3000)?;
    let voltages = Panel::new("Voltages", "time in ms", "voltage in V")
        .line(
            "source",
            GREY,
            milli(over(&found, |it| 10.0 * (100.0 * PI * it.time).sin())),
        )
        .line("capacitor", BLUE, milli(over(&found, |it| it.output[0])))
        .dots("reference", ORANGE, milli(rectifier::REFERENCE.to_vec()));
    let current = Panel::new("Current", "time in ms", "current in mA").line(
        "diode",
        ORANGE,
        milli(over(&found, |it| 1e3 * it.output[1])),
    );
    picture(
        path,
        "A rectifier: the diode and its resistor are a nonlinear algebraic loop",
        400,
        &[voltages, current],
    )
}

/// Times in ms.
pub(crate) fn milli(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.into_iter().map(|(t, y)| (1e3 * t, y)).collect()
}
