//! A mass on a hardening spring: the smallest model, stepped at a fixed rate.

use std::error::Error;

use mbg_runtime::{Constant, Rk4, System, mbg};
use nalgebra::SVector;

mbg! {
    /// A mass, a hardening spring and a damper, driven by a force.
    pub model Oscillator {
        param mass: kg = 2.0;
        param stiffness: N/m = 50.0;
        param hardening: N/m^3 = 400.0;
        param damping: N*s/m = 1.5;
        input force: N;

        1 velocity {
            I body { inertia: mass }
            C spring { effort: stiffness * q + hardening * powi(q, 3), initial: 0.1 }
            R damper { resistance: damping }
            Se drive { effort: force }
        }
        output position: m = spring.q;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let model = Oscillator::new(OscillatorParameters::default())?;
    println!("{}\n", <Oscillator as System<f64, 2, 1, 1>>::META.diagram);
    println!("{:>6} {:>12} {:>12}", "t / s", "position / m", "energy / J");
    let still = Constant(SVector::from([0.0]));
    Rk4::fixed(
        &model,
        &still,
        0.0,
        1.0,
        0.1,
        model.initial_state(),
        |t, x| {
            let position = model.output(t, x, &SVector::zeros(), &mut ())[0];
            println!("{t:>6.1} {position:>12.6} {:>12.6}", model.energy(t, x));
        },
    )?;
    Ok(())
}
