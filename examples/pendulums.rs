//! A cart on a rail with three rods that hang one below the other, of components of the library: no body has a velocity
//! of its own, the compiler eliminates all of them but the rates of slide and hinges.
//!
//! `cargo run --release --example pendulums`

use std::error::Error;

use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
use nalgebra::SVector;

mbg! {
    /// Nothing drives it; the rods start in line, and level.
    #[derivative]
    pub model Pendulums {
        gravity [0.0, -9.81];
        let rods = 3;
        1 ground[3] { Sf fixed { flow: 0.0 } }
        ends: for k in 0..rods + 1 { 1 end[3]; }
        rail: PlanarPrismatic {} (ground, ends[0].end);
        cart: PlanarBody { mass: 2.0, inertia: 1.0 } (ends[0].end);
        links: for k in 0..rods {
            1 top[3];
            1 middle[3];
            hinge: PlanarRevolute {} (ends[k].end, top);
            half: PlanarOffset { x: 0.5 } (top, middle);
            body: PlanarBody { mass: 1.0, inertia: 1.0 / 12.0 } (middle);
            rod: PlanarOffset { x: 1.0 } (top, ends[k+1].end);
            let heights = half.position_b.y + if k == 0 { 0.0 } else { links[k-1].heights };
        }
        output cart: m = rail.travel;
        output tip[2]: m = links[rods-1].rod.position_b;
        output potential: J = 9.81 * links[rods-1].heights;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let model = Pendulums::new(PendulumsParameters::default())?;
    let meta = <Pendulums as System<f64, 8, 0, 4>>::META;
    let names: Vec<&str> = meta.states.iter().map(|state| state.name).collect();
    println!("states: {}", names.join(", "));
    println!("eliminated: {}", meta.eliminated.len());
    println!(
        "operations per derivative: {}\n",
        meta.operations.derivative
    );
    let titles = [
        "time / s",
        "cart / m",
        "tip x / m",
        "tip y / m",
        "drift / J",
    ];
    println!("{}", titles.map(|title| format!("{title:>12}")).concat());
    let times: Vec<f64> = (0..=10).map(|k| 0.5 * f64::from(k)).collect();
    let solver = Adaptive::new(Dop853, 1e-11, 1e-12);
    solver.sample(&model, &(), 0.0, model.initial_state(), &times, |t, x| {
        let [cart, tip_x, tip_y, potential] = model.output(t, x, &SVector::zeros(), &mut ()).into();
        // At the start both are zero.
        let drift = model.energy(t, x) + potential;
        println!("{t:>12.1}{cart:>12.6}{tip_x:>12.6}{tip_y:>12.6}{drift:>12.1e}");
    })?;
    Ok(())
}
