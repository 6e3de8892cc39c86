//! Heat on pseudo bonds.

use mbg_runtime::{Constant, Rk4, System, mbg};
use nalgebra::SVector;

mbg! {
    include "examples/gallery/layers.mbg";

    /// Two bodies that exchange heat.
    pub(crate) model Pair {
        0 hot pseudo;
        0 cold pseudo;
        first: HeatCapacity { capacity: 400.0, initial: 360.0 } (hot);
        second: HeatCapacity { capacity: 900.0, initial: 290.0 } (cold);
        wall: Conduction { conductance: 2.5 } (hot, cold);
        output temperatures[2]: K = [first.temperature, second.temperature];
        output heat_flow: W = wall.heat_flow;
    }

    /// A resistor heats its case, which loses heat to the air.
    pub(crate) model Heater {
        param voltage: V = 12.0;
        param resistance: ohm = 6.0;
        0 plus;
        0 minus;
        Se supply { effort: voltage } -> plus;
        Se earth { effort: 0.0 } -> minus;
        wire: Resistor { resistance: resistance } (plus, minus);
        0 case pseudo;
        0 air pseudo;
        Se weather { effort: 293.15 } -> air;
        loss: HeatSource { power: wire.voltage * wire.current } (case);
        metal: HeatCapacity { capacity: 50.0, initial: 293.15 } (case);
        surface: Conduction { conductance: 0.8 } (case, air);
        output temperature: K = metal.temperature;
    }
}

fn none() -> Constant<f64, 0> {
    Constant(SVector::zeros())
}

#[test]
fn two_bodies_reach_one_temperature() {
    let model = Pair::<f64>::new(PairParameters::default()).unwrap();
    let end = 300.0;
    let mut last = model.initial_state();
    Rk4::fixed(&model, &none(), 0.0, end, 0.1, last, |_, x| last = *x).unwrap();
    let found = model.output(end, &last, &SVector::zeros(), &mut Default::default());
    // The mean stays, the difference decays.
    let mean = (400.0 * 360.0 + 900.0 * 290.0) / 1300.0;
    let difference = 70.0 * f64::exp(-2.5 * (1.0 / 400.0 + 1.0 / 900.0) * end);
    let expected = [
        mean + difference * 900.0 / 1300.0,
        mean - difference * 400.0 / 1300.0,
        2.5 * difference,
    ];
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-10 * expected,
            "{found} {expected}"
        );
    }
}

#[test]
fn heat_is_no_energy_times_temperature() {
    let model = Pair::<f64>::new(PairParameters::default()).unwrap();
    let x = model.initial_state();
    assert_eq!(model.energy(0.0, &x), 0.0);
    let power = model.power(0.0, &x, &SVector::zeros(), &mut Default::default());
    assert_eq!((power.supplied, power.dissipated), (0.0, 0.0));
    assert_eq!(x.as_slice(), [400.0 * 360.0, 900.0 * 290.0]);
}

#[test]
fn what_a_resistor_loses_heats_its_case() {
    let model = Heater::<f64>::new(HeaterParameters::default()).unwrap();
    let end = 40.0;
    let mut last = model.initial_state();
    Rk4::fixed(&model, &none(), 0.0, end, 0.05, last, |_, x| last = *x).unwrap();
    let found = model.output(end, &last, &SVector::zeros(), &mut Default::default())[0];
    let expected = 293.15 + 24.0 / 0.8 * (1.0 - f64::exp(-0.8 / 50.0 * end));
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    // The power of the circuit is counted, that of the heat is not: it is the same.
    let power = model.power(0.0, &last, &SVector::zeros(), &mut Default::default());
    assert!((power.supplied - 24.0).abs() < 1e-13 && (power.dissipated - 24.0).abs() < 1e-13);
}

#[test]
fn a_wall_of_layers_comes_to_its_straight_line() {
    let model = Layers::<f64>::new(LayersParameters::default()).unwrap();
    let (time, mut early) = (20.0, None);
    let mut last = model.initial_state();
    Rk4::fixed(&model, &none(), 0.0, 3000.0, 0.5, last, |t, x| {
        last = *x;
        if t == time {
            let output = model.output(t, x, &SVector::zeros(), &mut Default::default());
            early = Some(output[0]);
        }
    })
    .unwrap();
    let output = model.output(3000.0, &last, &SVector::zeros(), &mut Default::default());
    assert!((output[0] - 285.0).abs() < 1e-10, "{}", output[0]);
    assert!((output[1] - 4.0 * 2.0).abs() < 1e-10, "{}", output[1]);
    // The middle against the modes of the chain: T_k = Σ c_m sin(m π k / 10) exp(-4 λ_m t / 30), λ = 2 - 2 cos(m π / 10).
    let pi = std::f64::consts::PI;
    let mode = |m: f64| {
        let start: f64 = (1..10)
            .map(f64::from)
            .map(|k| (-20.0 + 2.0 * k) * f64::sin(m * pi * k / 10.0) / 5.0)
            .sum();
        let decay = f64::exp(-4.0 / 30.0 * (2.0 - 2.0 * f64::cos(m * pi / 10.0)) * time);
        start * f64::sin(m * pi / 2.0) * decay
    };
    let expected = 285.0 + (1..10).map(|m| mode(f64::from(m))).sum::<f64>();
    let error = (early.unwrap() - expected).abs();
    assert!(error < 1e-7, "{error:e} of {expected}");
}
