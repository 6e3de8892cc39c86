//! A hydraulic cylinder is driven out, held up by a load, and let go: pressures, travel and where the energy went.
//!
//! `cargo run --release --example hydraulic_drive`

mod model;

use std::error::Error;

use mbg_runtime::{Adaptive, Dop853, Integrator, Pulse, System};
use model::{Drive, DriveParameters};
use nalgebra::SVector;

const TIMES: [f64; 12] = [
    0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.62, 0.8, 1.0, 1.5,
];

fn main() -> Result<(), Box<dyn Error>> {
    let drive = Drive::new(DriveParameters::default())?;
    let columns = [
        "time", "supply", "head", "back", "travel", "velocity", "energy",
    ];
    let units = ["s", "MPa", "MPa", "MPa", "m", "m/s", "kJ"];
    println!("{}\n{}", row(&columns), row(&units));
    Adaptive::new(Dop853, 1e-9, 1e-12).sample(
        &drive,
        &load(),
        0.0,
        drive.initial_state(),
        &TIMES,
        |time, x| {
            let output = drive.output(time, x, &SVector::zeros(), &mut Default::default());
            let cells = [
                format!("{time:.2}"),
                format!("{:.4}", output[0] / 1e6),
                format!("{:.4}", output[1] / 1e6),
                format!("{:.4}", output[2] / 1e6),
                format!("{:.6}", output[3]),
                format!("{:.6}", output[4]),
                format!("{:.5}", drive.energy(time, x) / 1e3),
            ];
            println!("{}", row(&cells));
        },
    )?;
    Ok(())
}

/// The rod meets 5 kN between 0.6 s and 1 s.
fn load() -> Pulse<f64, 1> {
    Pulse {
        amplitude: SVector::from([5e3]),
        start: 0.6,
        end: 1.0,
    }
}

/// Cells of one width.
fn row<T: AsRef<str>>(cells: &[T]) -> String {
    let cells = cells.iter().map(|cell| format!("{:>11}", cell.as_ref()));
    cells.collect()
}
