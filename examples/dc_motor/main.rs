//! A DC motor starts a geared load, which is braked after 0.2 s: electrical and mechanical domain in one graph.
//!
//! `cargo run --release --example dc_motor`

mod model;

use std::error::Error;
use std::fmt::Display;

use mbg_runtime::{Adaptive, Dop853, Integrator, System};
use model::{Motor, MotorParameters, REFERENCE, brake, error};
use nalgebra::SVector;

fn main() -> Result<(), Box<dyn Error>> {
    let motor = Motor::new(MotorParameters::default())?;
    let meta = <Motor as System<f64, 4, 1, 4>>::META;
    println!("{}\n", meta.diagram);
    println!(
        "{:>8}{}{:>10}",
        "time",
        row(meta.outputs.iter().map(|output| output.name)),
        "error"
    );
    println!(
        "{:>8}{}",
        "s",
        row(meta.outputs.iter().map(|output| output.unit))
    );
    let times = REFERENCE.map(|instant| instant.time);
    let mut reference = REFERENCE.iter();
    Adaptive::new(Dop853, 1e-10, 1e-13).sample(
        &motor,
        &brake(),
        0.0,
        motor.initial_state(),
        &times,
        |time, x| {
            let output = motor.output(time, x, &SVector::zeros(), &mut ());
            let error = reference
                .next()
                .map_or(f64::NAN, |instant| error(&output, instant));
            let values = row(output.iter().map(|value| format!("{value:.8}")));
            println!("{time:>8}{values}{error:>10.1e}");
        },
    )?;
    println!(
        "\nerror: the largest of the four, relative to the solution by the matrix exponential"
    );
    Ok(())
}

/// Cells of one width.
fn row<T: Display>(cells: impl Iterator<Item = T>) -> String {
    cells.map(|cell| format!("{cell:>16}")).collect()
}
