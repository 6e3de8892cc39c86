//! A wall of ten layers between two rooms, on pseudo bonds.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};
use plotters::style::RGBColor;

use crate::draw::{BLUE, ORANGE, Panel, picture, shade};
use crate::run::{over, run};

mbg! { include "examples/gallery/layers.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let wall = Layers::<f64>::new(LayersParameters::default())?;
    let found = run(&wall, &(), wall.initial_state(), 800.0, 800)?;
    let mut profile = Panel::new(
        "Through the wall",
        "layer from inside to outside",
        "temperature in °C",
    );
    let times = [2, 10, 40, 120, 300, 800];
    for (place, time) in times.into_iter().enumerate() {
        let part = place as f64 / (times.len() - 1) as f64;
        let color: RGBColor = shade(BLUE, ORANGE, part);
        let temperatures = &found[time].output.as_slice()[2..];
        let points = (0..).zip(temperatures);
        let points = points.map(|(side, kelvin)| (f64::from(side), kelvin - 273.15));
        profile = profile.line(&format!("{time} s"), color, points.collect());
    }
    let inside = |it: &crate::run::Instant<9, 13>| 4.0 * (it.output[2] - it.output[3]);
    let flow = Panel::new("Heat flow", "time in s", "heat flow in W")
        .line("in", ORANGE, over(&found, inside))
        .line("out", BLUE, over(&found, |it| it.output[1]));
    picture(
        path,
        "A wall of ten layers, heated from one side",
        400,
        &[profile, flow],
    )
}
