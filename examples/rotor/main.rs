//! Ground resonance: the lag of four blades on hinges, seen from a mast that slides on springs, meets the frequency of
//! the mast. Frequencies and growth come from the exact Jacobian at the steady rotation, in coordinates of all blades
//! that do not turn with the hub (Coleman and Feingold, NACA Report 1351, 1958), beside linear theory.
//!
//! `cargo run --release --example rotor` prints them and draws `docs/rotor.svg`.

mod model;
mod picture;
#[path = "../../tests/references/rotor.rs"]
#[allow(dead_code, reason = "tests ask for more of it")]
mod theory;

use std::error::Error;
use std::path::Path;

use mbg_runtime::System;
use model::{Sliding, SlidingParameters};
use nalgebra::{Complex, DMatrix, SVector};
use theory::{Rotor, in_axes_of_the_mast, matched, modulus};

/// One eigenvalue.
struct Mode {
    name: String,
    theory: Complex<f64>,
    found: Complex<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let meta = Sliding::<f64>::META;
    println!(
        "{} states, {} operations per derivative, {} with the Jacobian",
        meta.states.len(),
        meta.operations.derivative,
        meta.operations.derivative_and_jacobian
    );
    for speed in [30.0, 45.0] {
        table(speed)?;
    }
    let speeds = (0..=120).map(|step| 0.5 * f64::from(step));
    let sweep = speeds.map(|speed| Ok((speed, modes(speed)?)));
    let sweep: Vec<(f64, Vec<Mode>)> = sweep.collect::<Result<_, Box<dyn Error>>>()?;
    let worst = sweep.iter().flat_map(|(_, modes)| modes);
    let worst = worst
        .map(|mode| modulus(mode.found - mode.theory))
        .fold(0.0, f64::max);
    println!("largest distance of an eigenvalue at speeds of 0 to 60 rad/s: {worst:.1e} 1/s");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rotor.svg");
    picture::draw(&path, &sweep)
}

/// The same rotor in theory.
fn theory(parameters: &SlidingParameters) -> Rotor {
    let length = 4.7;
    let flat = 20.0 * length * length / 12.0;
    Rotor {
        blades: 4,
        speed: parameters.speed,
        offset: 0.3,
        mass: 20.0,
        centre: length / 2.0,
        inertia: [0.3, flat, flat + 0.3],
        stiffness: [6000.0, 2000.0, 8000.0],
        mast_mass: parameters.mass,
        mast_stiffness: parameters.stiffness,
    }
}

/// Eigenvalues at a speed, those of theory and those of the model.
fn modes(speed: f64) -> Result<Vec<Mode>, Box<dyn Error>> {
    let parameters = SlidingParameters {
        speed,
        ..Default::default()
    };
    let expected = theory(&parameters).eigenvalues();
    let model = Sliding::new(parameters)?;
    let x = model.initial_state();
    let jacobian = model.jacobian_state(0.0, &x, &SVector::from([]), &mut ());
    let jacobian = DMatrix::from_row_slice(x.len(), x.len(), jacobian.transpose().as_slice());
    let shaft = place("blades.rotor.shaft.angle")?;
    let found = in_axes_of_the_mast(&jacobian, &families()?, x[shaft], speed)
        .remove_row(shaft)
        .remove_column(shaft)
        .complex_eigenvalues();
    let values: Vec<Complex<f64>> = expected.iter().map(|(_, value)| *value).collect();
    let pairs = matched(&values, found.as_slice());
    let modes = expected.into_iter().zip(pairs);
    Ok(modes
        .map(|((name, _), (theory, found))| Mode {
            name,
            theory,
            found,
        })
        .collect())
}

/// The places of the same state of all blades.
fn families() -> Result<Vec<Vec<usize>>, Box<dyn Error>> {
    let mut families = Vec::new();
    for state in ["spring.q", "rate.f"] {
        for axis in ["x", "y", "z"] {
            let of = |blade: usize| {
                place(&format!(
                    "blades.rotor.blades[{blade}].blade.about_{axis}.{state}"
                ))
            };
            families.push((0..4).map(of).collect::<Result<_, _>>()?);
        }
    }
    Ok(families)
}

fn place(name: &str) -> Result<usize, Box<dyn Error>> {
    let place = Sliding::<f64>::META.state(name);
    place.ok_or_else(|| format!("no state `{name}`").into())
}

fn table(speed: f64) -> Result<(), Box<dyn Error>> {
    println!("\nspeed {speed} rad/s");
    let titles = ["frequency", "theory", "growth", "theory", "distance"];
    let units = ["rad/s", "rad/s", "1/s", "1/s", "1/s"];
    for row in [titles, units] {
        let cells: String = row.map(|cell| format!("{cell:>14}")).concat();
        println!("{:<28}{cells}", "");
    }
    for mode in modes(speed)?.iter().step_by(2) {
        println!(
            "{:<28}{:>14.8}{:>14.8}{:>14.8}{:>14.8}{:>14.1e}",
            mode.name,
            mode.found.im.abs(),
            mode.theory.im.abs(),
            rounded(mode.found.re),
            rounded(mode.theory.re),
            modulus(mode.found - mode.theory)
        );
    }
    Ok(())
}

/// To the digits that are printed, such that zero has no sign.
fn rounded(growth: f64) -> f64 {
    (1e8 * growth).round() / 1e8 + 0.0
}
