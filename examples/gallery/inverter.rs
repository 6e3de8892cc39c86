//! An inverter with sine-triangle modulation, from the state to which it settles on.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{Adaptive, Dop853, Integrator, PeriodicTrim, mbg};

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, picture};

mbg! { include "examples/gallery/inverter.mbg"; }

/// Of the sines, s.
const TURN: f64 = 0.02;

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let inverter = Inverter::<f64>::new(InverterParameters::default())?;
    let solver = Adaptive::new(Dop853, 1e-9, 1e-9);
    let cycle = PeriodicTrim::new(&inverter, &solver, TURN).solve()?;
    let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) / 2000.0 * TURN).collect();
    let (mut currents, mut voltage) = ([const { Vec::new() }; 3], Vec::new());
    solver.sample_outputs(&inverter, &(), 0.0, cycle.state, &times, |t, _, y| {
        for (current, value) in currents.iter_mut().zip(y.iter()) {
            current.push((1e3 * t, *value));
        }
        voltage.push((1e3 * t, y[3]));
    })?;
    // The first harmonic of a leg is that of its sine: 0.8 · 300 V at 50 Hz, behind 2 Ω and 20 mH.
    let (resistance, reactance) = (2.0_f64, 100.0 * std::f64::consts::PI * 0.02);
    let (amplitude, lag) = (
        240.0 / resistance.hypot(reactance),
        reactance.atan2(resistance),
    );
    let wave = (0..=20).map(|k| f64::from(k) / 20.0);
    let harmonic = wave.map(|part| {
        let angle = std::f64::consts::TAU * part;
        (1e3 * TURN * part, amplitude * (angle - lag).sin())
    });
    let [first, second, third] = currents;
    let phases = Panel::new("Currents", "time in ms", "current in A")
        .line("first phase", BLUE, first)
        .line("second", ORANGE, second)
        .line("third", GREEN, third)
        .dots("first harmonic", GREY, harmonic.collect());
    let leg =
        Panel::new("First phase", "time in ms", "voltage in V").line("voltage", BLUE, voltage);
    picture(
        path,
        "An inverter with sine-triangle modulation at 1 kHz",
        400,
        &[phases, leg],
    )
}
