//! A 7-axis arm, converted from its URDF file and included, falls from a bent pose: nothing drives it.
//!
//! `cargo run --release --example arm`

#[allow(unreachable_pub)]
mod model;

use std::error::Error;

use mbg_runtime::{Adaptive, Constant, Dop853, Integrator, System};
use nalgebra::SVector;

use model::{Arm, ArmParameters};

fn main() -> Result<(), Box<dyn Error>> {
    let model = Arm::new(ArmParameters::default())?;
    let meta = <Arm as System<f64, 14, 7, 3>>::META;
    println!("states: {}", meta.states.len());
    println!("eliminated: {}", meta.eliminated.len());
    println!("operations per derivative: {}", meta.operations.derivative);
    println!("angles under sine and cosine: {}\n", meta.operations.angles);
    let idle = SVector::<f64, 7>::zeros();
    let times: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    let solver = Adaptive::new(Dop853, 1e-10, 1e-11);
    println!("time / s    hand x / m    hand y / m    hand z / m    kinetic energy / J");
    solver.sample(
        &model,
        &Constant(idle),
        0.0,
        model.initial_state(),
        &times,
        |t, x| {
            let [a, b, c] = model.output(t, x, &idle, &mut ()).into();
            let kinetic = model.energy(t, x);
            println!("{t:8.1}{a:14.6}{b:14.6}{c:14.6}{kinetic:22.6}");
        },
    )?;
    Ok(())
}
