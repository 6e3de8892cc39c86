//! A mass on a hardening spring: the smallest model, stepped at a fixed rate.
use mbg_runtime::{System, mbg};
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

fn main() {
    let model =
        Oscillator::<f64>::new(OscillatorParameters::default()).expect("defaults are sound");
    let meta = <Oscillator<f64> as System<f64, 2, 1, 1>>::META;
    println!("{}\n{}", meta.name, meta.diagram);
    let x: SVector<f64, 2> = System::initial_state(&model);
    println!(
        "{:?} {:?}",
        x,
        System::derivative(&model, 0.0, &x, &SVector::<f64, 1>::zeros(), &mut ())
    );
    println!("energy {}", System::<f64, 2, 1, 1>::energy(&model, 0.0, &x));
    println!("{meta:#?}");
}
