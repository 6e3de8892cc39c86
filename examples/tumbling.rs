//! The tumbling of a free body about its middle axis of inertia, which Dzhanibekov saw of a wing nut in orbit: it flips
//! over again and again. Its orientation passes every attitude, so it is held as a quaternion, and for comparison as a
//! rotation matrix.
//!
//! `cargo run --release --example tumbling`

use std::error::Error;

use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
use nalgebra::SVector;

mbg! {
    include "examples/tumbling.mbg";

    /// Nine states for the orientation.
    pub model TumblingMatrix {
        1 turning[3];
        nut: Nut (turning);
        attitude turn = matrix(turning.f);
        output axis[3] = turn * [0.0, 1.0, 0.0];
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let quaternion = Tumbling::new(TumblingParameters::default())?;
    let matrix = TumblingMatrix::new(TumblingMatrixParameters::default())?;
    let (solver, nothing) = (Adaptive::new(Dop853, 1e-13, 1e-18), SVector::from([]));
    let times: Vec<f64> = (0..=20).map(|k| 2.0 * f64::from(k)).collect();

    let mut axes = Vec::new();
    solver.sample(&matrix, &(), 0.0, matrix.initial_state(), &times, |t, x| {
        axes.push(matrix.output(t, x, &nothing, &mut ()));
    })?;

    let titles = [
        "time / s",
        "ω_y / rad/s",
        "length - 1",
        "energy",
        "momentum",
        "matrix",
    ];
    println!("{}", titles.map(|title| format!("{title:>13}")).concat());
    let x0 = quaternion.initial_state();
    let energy = quaternion.energy(0.0, &x0);
    let momentum = quaternion
        .output(0.0, &x0, &nothing, &mut ())
        .fixed_rows::<3>(6)
        .into_owned();
    let mut axes = axes.iter();
    solver.sample(&quaternion, &(), 0.0, x0, &times, |t, x| {
        let output = quaternion.output(t, x, &nothing, &mut ());
        let length = x.fixed_rows::<4>(3).norm() - 1.0;
        let lost = quaternion.energy(t, x) / energy - 1.0;
        let turned = (output.fixed_rows::<3>(6) - momentum).norm() / momentum.norm();
        let apart = axes
            .next()
            .map_or(f64::NAN, |axis| (output.fixed_rows::<3>(3) - axis).norm());
        let rate = output[1];
        println!("{t:>13.1}{rate:>13.6}{length:>13.1e}{lost:>13.1e}{turned:>13.1e}{apart:>13.1e}");
    })?;
    println!(
        "\nenergy and momentum: relative changes; momentum in axes of the world; matrix: distance of the y axes"
    );
    Ok(())
}
