//! Hydraulics.

use mbg_runtime::{Adaptive, Constant, Dop853, Integrator, System, mbg};
use nalgebra::SVector;

use super::balance;
use crate::drive::{Drive, DriveParameters};
use crate::references::errors::larger;
use crate::references::integrate::integrate;

mbg! {
    /// A tank drains through a pipe and an orifice in series, which are an algebraic loop.
    pub(crate) model Drain {
        param area: m^2 = 1e-4;
        0 tank;
        0 between;
        0 outside;
        tank -> C level { compliance: 2e-8, initial: 1.0 };
        1 pipe { R wall { resistance: 5e6 } }
        tank -> pipe;
        pipe -> between;
        edge: Orifice { area: area, density: 1000.0, transition: 50.0 } (between, outside);
        Se air { effort: 0.0 } -> outside;
        output pressure: Pa = edge.pressure;
        output flow: m^3/s = edge.flow;
    }
}

/// The flow through an orifice, as its definition says.
fn orifice(area: f64, density: f64, transition: f64, p: f64) -> f64 {
    0.7 * area * f64::sqrt(2.0 / density) * p / (p * p + transition * transition).powf(0.25)
}

#[test]
fn an_orifice_is_turbulent_above_its_transition_and_laminar_below() {
    let exact = |p: f64| 0.7 * 1e-4 * f64::sqrt(2.0 * p / 1000.0);
    let part = |p: f64| orifice(1e-4, 1000.0, 50.0, p) / exact(p) - 1.0;
    assert!((part(500.0) + 0.0025).abs() < 1e-4, "{}", part(500.0));
    assert!(part(5e4).abs() < 1e-6);
}

#[test]
fn an_orifice_in_a_loop_is_solved_down_to_rest() {
    let model = Drain::<f64>::new(DrainParameters::default()).unwrap();
    let none = SVector::<f64, 0>::zeros();
    for volume in [-1.0, -1e-3, -1e-9, 0.0, 1e-15, 1e-9, 1e-6, 1e-3, 0.1, 1.0] {
        let x = SVector::from([volume]);
        let mut memory = Default::default();
        let found = model.output(0.0, &x, &none, &mut memory);
        assert!(model.trouble(0.0, &x, &none, &memory).is_none(), "{volume}");
        let (pressure, flow) = (found[0], found[1]);
        let whole = volume / 2e-8;
        let own = orifice(1e-4, 1000.0, 50.0, pressure);
        assert!(
            (flow - own).abs() <= 1e-10 * own.abs(),
            "{volume}: {flow} {own}"
        );
        let loss = whole - pressure - 5e6 * flow;
        assert!(loss.abs() <= 1e-9 * whole.abs(), "{volume}: {loss:e}");
        if volume == 0.0 {
            assert_eq!(found.as_slice(), [0.0, 0.0]);
        }
    }
}

#[test]
fn a_drained_tank_balances_and_comes_to_rest() {
    let model = Drain::<f64>::new(DrainParameters::default()).unwrap();
    let none = Constant(SVector::zeros());
    let (_, imbalance) = balance::run(&model, &none, 1e-3, 2_000);
    assert!(imbalance < 1e-9, "{imbalance:e}");
}

/// The drive by hand: volumes of the two chambers above rest, momentum, travel, fluid in the accumulator.
fn drive_by_hand(load: f64, [a, b, momentum, travel, fluid]: &[f64; 5]) -> [f64; 5] {
    let supply = 3e6 * (2e-3 / (2e-3 - fluid)).powf(1.4);
    let (head, back) = (1.4e9 / 4e-4 * a, 1.4e9 / 4e-4 * b);
    let inlet = orifice(6e-6, 870.0, 1e3, supply - head);
    let outlet = orifice(6e-6, 870.0, 1e3, back);
    let velocity = momentum / 250.0;
    [
        inlet - 2e-3 * velocity,
        1.2e-3 * velocity - outlet,
        2e-3 * head - 1.2e-3 * back - load - 900.0 * velocity - 2e4 * travel,
        velocity,
        1.5e-6 * 150.0 - 4e-11 * supply - inlet,
    ]
}

#[test]
fn a_hydraulic_drive_equals_its_derivation_by_hand() {
    let model = Drive::<f64>::new(DriveParameters::default()).unwrap();
    let load = 4e3;
    let input = Constant(SVector::from([load]));
    let (mut time, mut by_hand) = (0.0, [0.0, 0.0, 0.0, 0.0, 8e-4]);
    let mut worst = 0.0_f64;
    Adaptive::new(Dop853, 1e-11, 1e-16)
        .sample(
            &model,
            &input,
            0.0,
            model.initial_state(),
            &[0.02, 0.1, 0.4],
            |t, x| {
                let steps = ((t - time) * 1e5).round() as usize;
                by_hand = integrate(|_, x| drive_by_hand(load, x), (time, t), steps, by_hand);
                time = t;
                let [a, b, momentum, travel, fluid] = by_hand;
                let expected = [
                    3e6 * (2e-3 / (2e-3 - fluid)).powf(1.4),
                    1.4e9 / 4e-4 * a,
                    1.4e9 / 4e-4 * b,
                    travel,
                    momentum / 250.0,
                ];
                let found = model.output(t, x, &SVector::from([load]), &mut Default::default());
                for (found, expected) in found.iter().zip(expected) {
                    worst = larger(worst, ((found - expected) / expected).abs());
                }
            },
        )
        .unwrap();
    assert!(time == 0.4 && worst < 1e-9, "{worst:e}");
}

#[test]
fn a_hydraulic_drive_balances() {
    let model = Drive::<f64>::new(DriveParameters::default()).unwrap();
    let input = Constant(SVector::from([4e3]));
    let (_, imbalance) = balance::run(&model, &input, 1e-6, 20_000);
    assert!(imbalance < 1e-10, "{imbalance:e}");
}
