//! A cart with rods in a plane, of components of the library, against Lagrange's equations for any number of rods.
#![allow(clippy::unwrap_used)]

mod models;
#[path = "../../tests/references"]
#[allow(dead_code)]
mod references {
    pub(crate) mod cart;
    pub(crate) mod crane;
    pub(crate) mod dense;
    pub(crate) mod integrate;
}

use std::f64::consts::FRAC_PI_2;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_runtime::Dual;
use models::dual::{Point, evaluate};
use references::cart::Cart;

const CART: &str = "#[derivative]
model Cart {
    input force: N;
    gravity [0.0, -9.81];
    let rods = 4;
    ends: for k in 0..rods + 1 { 1 end[3]; }
    1 ground[3] { Sf fixed { flow: 0.0 } }
    slide: PlanarPrismatic { force: force } (ground, ends[0].end);
    body: PlanarBody { mass: 2.0, inertia: 1.0 } (ends[0].end);
    links: for k in 0..rods {
        1 top[3];
        1 middle[3];
        hinge: PlanarRevolute {} (ends[k].end, top);
        half: PlanarOffset { x: 0.5 } (top, middle);
        body: PlanarBody { mass: 1.0, inertia: 1.0 / 12.0 } (middle);
        whole: PlanarOffset { x: 1.0 } (top, ends[k+1].end);
        output angle: rad = hinge.angle_b;
        output rate: rad/s = hinge.rate.f;
    }
    output speed: m/s = slide.rate.f;
}";

/// Outputs with their derivatives in time.
fn outputs(model: &Compiled, state: &[f64], force: f64) -> Vec<Dual<f64>> {
    let run = |routine, along: &[f64]| {
        let dual = |(value, slope): (&f64, &f64)| Dual {
            value: *value,
            slope: *slope,
        };
        let state: Vec<Dual<f64>> = state.iter().zip(along).map(dual).collect();
        let point = Point {
            parameters: &[],
            time: Dual::constant(0.0),
            state: &state,
            input: &[Dual::constant(force)],
        };
        evaluate(&model.program, routine, &point)
    };
    let rates = run(Routines::DERIVATIVE, &vec![0.0; state.len()]);
    let rates: Vec<f64> = rates.iter().map(|rate| rate.value).collect();
    run(Routines::OUTPUT, &rates)
}

#[test]
fn any_number_of_rods_moves_as_lagrange_says() {
    for rods in 1..9 {
        let model = models::compiled(&CART.replace("rods = 4", &format!("rods = {rods}")));
        assert_eq!(model.states.len(), 2 * rods + 1, "nothing reads the travel");
        let mut worst = 0.0_f64;
        for seed in 0..20 {
            let some = |place: usize| (1.3 * place as f64 + 0.7 * f64::from(seed) + 0.4).sin();
            // At first everything is at rest and in line, where a careless pivot would vanish.
            let value = |place| if seed == 0 { 0.0 } else { 2.0 * some(place) };
            let state: Vec<f64> = (0..model.states.len()).map(value).collect();
            let force = 3.0 * some(99);
            let told = outputs(&model, &state, force);
            let (mut angles, mut rates) = (Vec::new(), Vec::new());
            let (mut rate, mut change) = (0.0, 0.0);
            let mut found = vec![told[2 * rods].slope];
            for rod in told[..2 * rods].chunks(2) {
                rate += rod[1].value;
                change += rod[1].slope;
                angles.push(rod[0].value + FRAC_PI_2);
                rates.push(rate);
                found.push(change);
            }
            let expected = Cart::uniform(2.0, rods).accelerations(&angles, &rates, force);
            let size = expected.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
            for (found, expected) in found.iter().zip(&expected) {
                let error = (found - expected).abs() / size;
                assert!(error < 1e-11, "{rods} rods: {error:e}");
                worst = worst.max(error);
            }
        }
        let operations = model.program.routines[Routines::DERIVATIVE].operations();
        println!("{rods} rods: {worst:.1e}, {operations} operations");
    }
}
