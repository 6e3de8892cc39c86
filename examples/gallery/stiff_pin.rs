//! A pin that gives way: a stiff spring and a damper instead of a constraint.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::run::{over, run, states};

mbg! { include "examples/gallery/stiff_pin.mbg"; }

fn stiff(stiffness: f64) -> Result<StiffPin, mbg_runtime::ParameterError> {
    let damping = 2.0 * stiffness.sqrt();
    StiffPin::new(StiffPinParameters { stiffness, damping })
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let pin = stiff(1e6)?;
    let found = run(&pin, &(), pin.initial_state(), 0.02, 1000)?;
    let give = states(&pin, "spring.q");
    let sinking = |axis: usize| {
        let points = over(&found, |it| 1e6 * it.state[give[axis]]);
        points.into_iter().map(|(t, y)| (1e3 * t, y)).collect()
    };
    let layer = Panel::new(
        "The pin after the start, 1 MN/m",
        "time in ms",
        "displacement in µm",
    )
    .line("level", ORANGE, sinking(0))
    .line("upright", BLUE, sinking(1));

    let rigid = RigidPin::<f64>::new(RigidPinParameters::default())?;
    let ideal = run(&rigid, &(), rigid.initial_state(), 1.0, 10)?[10].output[0];
    let mut errors = Vec::new();
    for step in 0..=14 {
        let power = 5.5 + 0.25 * f64::from(step);
        let pin = stiff(10_f64.powf(power))?;
        let angle = run(&pin, &(), pin.initial_state(), 1.0, 10)?[10].output[0];
        errors.push((power, (angle - ideal).abs().log10()));
    }
    let (power, error) = errors[6];
    let slope = [5.5, 9.0].map(|end| (end, error - (end - power)));
    let order = Panel::new(
        "Against the ideal pin after 1 s",
        "log₁₀ of the stiffness in N/m",
        "log₁₀ of the error in rad",
    )
    .dashes("1/stiffness", GREY, slope.to_vec())
    .dots("error of the angle", BLUE, errors);
    picture(path, "A rod on a pin that gives way", 400, &[layer, order])
}
