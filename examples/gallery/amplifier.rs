//! The two-transistor amplifier of the test set for initial value problems.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{Smooth, System, mbg};
use nalgebra::SVector;

use crate::draw::{BLUE, GREEN, GREY, ORANGE, PURPLE, Panel, picture};
use crate::rectifier::milli;
use crate::references::transistor_amplifier;
use crate::run::{over, run};

mbg! { include "examples/gallery/amplifier.mbg"; }

fn signal(t: f64) -> SVector<f64, 1> {
    SVector::from([transistor_amplifier::input(t)])
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let amplifier = Amplifier::<f64>::new(AmplifierParameters::default())?;
    let start = amplifier.initial_state();
    let found = run(&amplifier, &Smooth(signal), start, 0.2, 4000)?;
    let node = |place: usize| milli(over(&found, |it| it.output[place]));
    let known = transistor_amplifier::REFERENCE
        .map(|(t, nodes)| (t, nodes[7]))
        .to_vec();
    let ends = Panel::new("What goes in and comes out", "time in ms", "voltage in V")
        .line("load", BLUE, node(7))
        .line(
            "signal",
            ORANGE,
            milli(over(&found, |it| signal(it.time)[0])),
        )
        .dots("reference", GREY, milli(known));
    let nodes = Panel::new("Around the second transistor", "time in ms", "voltage in V")
        .line("collector", GREEN, node(6))
        .line("base", PURPLE, node(4))
        .line("emitter", GREY, node(5));
    picture(
        path,
        "Two transistors settle to their working point, 0.1 V at 100 Hz",
        400,
        &[ends, nodes],
    )
}
