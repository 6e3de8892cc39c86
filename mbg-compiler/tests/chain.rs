//! The chain of rods on revolute joints, of components of the library: forward dynamics by what the compiler makes of
//! the bond graph against recursions that know nothing of it.
#![allow(clippy::unwrap_used)]

mod models;
#[path = "../../tests/references"]
#[allow(dead_code)]
mod references {
    pub(crate) mod chain;
    pub(crate) mod dense;
}

use std::f64::consts::{FRAC_PI_2, PI};

use mbg_compiler::compile::{Compiled, Routines};
use mbg_runtime::Dual;
use models::dual::{Point, evaluate};
use references::chain::{DAMPING, LENGTH, articulated, composite, sample};

const CHAIN: &str = include_str!("stages/chain.mbg");

fn chain(rods: usize) -> Compiled {
    models::compiled(&CHAIN.replace("rods = 4", &format!("rods = {rods}")))
}

/// Results of a routine at a state along a direction.
fn run(model: &Compiled, routine: usize, state: &[f64], along: &[f64]) -> Vec<Dual<f64>> {
    let dual = |(value, slope): (&f64, &f64)| Dual {
        value: *value,
        slope: *slope,
    };
    let state: Vec<Dual<f64>> = state.iter().zip(along).map(dual).collect();
    let point = Point {
        parameters: &[],
        time: Dual::constant(0.0),
        state: &state,
        input: &[],
    };
    evaluate(&model.program, routine, &point)
}

fn values(of: &[Dual<f64>]) -> Vec<f64> {
    of.iter().map(|it| it.value).collect()
}

/// The places of angles and rates among the states.
fn places(model: &Compiled, rods: usize) -> [Vec<usize>; 2] {
    let place = |name: String| {
        let mut names = model
            .states
            .iter()
            .map(|state| &model.model.states[*state].variable.name);
        names.position(|known| *known == name).unwrap()
    };
    ["angle", "rate.f"].map(|word| {
        (0..rods)
            .map(|link| place(format!("links[{link}].hinge.{word}")))
            .collect()
    })
}

/// A state with angles and rates in the range of one rad and rad/s.
fn state(places: &[Vec<usize>; 2], seed: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let rods = places[0].len();
    let [q, v, _] = sample(rods, seed);
    let mut state = vec![0.0; 2 * rods];
    for link in 0..rods {
        state[places[0][link]] = q[link];
        state[places[1][link]] = v[link];
    }
    (state, q, v)
}

/// The larger of both; what is not a number is larger than anything.
fn worse(worst: f64, error: f64) -> f64 {
    if error.is_nan() {
        f64::INFINITY
    } else {
        worst.max(error)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

#[test]
fn forward_dynamics_are_those_of_the_recursion() {
    for rods in [1, 2, 3, 4, 7, 8, 16, 32] {
        let model = chain(rods);
        assert_eq!(model.states.len(), 2 * rods, "angles and rates alone");
        let places = places(&model, rods);
        let mut worst = 0.0_f64;
        for seed in 0..20 {
            let (state, q, v) = state(&places, seed);
            let rates = values(&run(
                &model,
                Routines::DERIVATIVE,
                &state,
                &vec![0.0; 2 * rods],
            ));
            let expected = articulated::accelerations(LENGTH, &q, &v, &vec![0.0; rods]);
            let size = largest(&expected);
            for link in 0..rods {
                assert_eq!(rates[places[0][link]], v[link]);
                worst = worse(
                    worst,
                    (rates[places[1][link]] - expected[link]).abs() / size,
                );
            }
        }
        let operations = model.program.routines[Routines::DERIVATIVE].operations();
        println!("{rods:>2} rods: {worst:.1e}, {operations} operations");
        assert!(worst < 1e-11, "{rods} rods: {worst:e}");
    }
}

#[test]
fn energy_is_that_of_the_links_and_is_balanced() {
    for rods in [1, 2, 3, 4, 7, 8, 16] {
        let model = chain(rods);
        let places = places(&model, rods);
        // Of power against power, and of energy against energy.
        let (mut worst, mut off) = (0.0_f64, 0.0_f64);
        for seed in 0..20 {
            let (state, q, v) = state(&places, seed);
            let still = vec![0.0; 2 * rods];
            let rates = values(&run(&model, Routines::DERIVATIVE, &state, &still));
            let power = values(&run(&model, Routines::POWER, &state, &still));
            let energy = run(&model, Routines::ENERGY, &state, &rates)[0];
            let dissipated: f64 = v.iter().map(|v| DAMPING * v * v).sum();
            worst = worse(worst, (power[1] - dissipated).abs() / dissipated);
            // What gravity supplies and what the links store may nearly cancel.
            let gross: f64 = (0..2 * rods)
                .map(|place| {
                    let mut along = still.clone();
                    along[place] = rates[place];
                    run(&model, Routines::ENERGY, &state, &along)[0].slope.abs()
                })
                .sum();
            worst = worse(worst, (energy.slope - power[0] + power[1]).abs() / gross);
            // Weights are sources: without speed nothing is stored.
            let kinetic = composite::energy(&q, &v) - composite::energy(&q, &still[..rods]);
            off = worse(
                off,
                (energy.value - kinetic).abs() / composite::energy(&q, &v).abs().max(kinetic),
            );
        }
        println!("{rods:>2} rods: balance {worst:.1e}, energy {off:.1e}");
        assert!(
            worst < 1e-12 && off < 1e-12,
            "{rods} rods: {worst:e}, {off:e}"
        );
    }
}

#[test]
fn jacobians_are_exact() {
    for rods in [1, 2, 3, 4, 7, 8] {
        let model = chain(rods);
        let places = places(&model, rods);
        let size = 2 * rods;
        let mut worst = 0.0_f64;
        for seed in 0..5 {
            let (state, ..) = state(&places, seed);
            let both = values(&run(
                &model,
                Routines::DERIVATIVE_AND_JACOBIAN,
                &state,
                &vec![0.0; size],
            ));
            let ours = &both[size..];
            let scale = largest(ours);
            for column in 0..size {
                let mut along = vec![0.0; size];
                along[column] = 1.0;
                let slopes = run(&model, Routines::DERIVATIVE, &state, &along);
                for (row, slope) in slopes.iter().enumerate() {
                    worst = worse(
                        worst,
                        (ours[row * size + column] - slope.slope).abs() / scale,
                    );
                }
            }
        }
        println!("{rods:>2} rods: Jacobian {worst:.1e}");
        assert!(worst < 1e-11, "{rods} rods: {worst:e}");
    }
}
/// Chains that hang straight, and those with joints at right angles: where a careless pivot would vanish.
#[test]
fn nothing_vanishes_at_special_angles() {
    let mut worst = 0.0_f64;
    for rods in 1..9 {
        let model = chain(rods);
        let places = places(&model, rods);
        for angle in [0.0, 1e-6, FRAC_PI_2, PI] {
            for straight in [1, 2, 3] {
                let (mut state, mut q, v) = state(&places, straight);
                for link in (0..rods).filter(|link| link % straight == 0) {
                    q[link] = angle;
                    state[places[0][link]] = angle;
                }
                let still = vec![0.0; 2 * rods];
                let rates = values(&run(&model, Routines::DERIVATIVE, &state, &still));
                let expected = articulated::accelerations(LENGTH, &q, &v, &still[..rods]);
                let size = largest(&expected);
                for (place, expected) in places[1].iter().zip(&expected) {
                    let error = (rates[*place] - expected).abs() / size;
                    assert!(error < 1e-11, "{rods} rods, {angle}: {error:e}");
                    worst = worse(worst, error);
                }
            }
        }
    }
    println!("special angles: {worst:.1e}");
}
