//! Energy audits: what is stored is what was supplied less what was dissipated.

use mbg_runtime::{Constant, Input, System};
use nalgebra::SVector;

use super::behaviour::{Ladder, LadderParameters, Oscillator, OscillatorParameters};
use crate::dc_motor::{Motor, MotorParameters, brake};
use crate::ins::{Ins, InsParameters, gust};
use crate::references::errors::larger;

/// Runs RK4 with the energies supplied and dissipated as two more states; the input is constant in each step.
/// Gives the largest imbalance as a part of the energy supplied, or of that at the start if this is more.
pub(super) fn imbalance<const N: usize, const M: usize, const P: usize>(
    model: &impl System<f64, N, M, P>,
    input: &impl Input<f64, M>,
    h: f64,
    steps: u32,
) -> f64 {
    let mut x = model.initial_state();
    let start = model.energy(0.0, &x);
    let (mut supplied, mut dissipated) = (0.0, 0.0);
    let (mut most, mut worst) = (start.abs(), 0.0_f64);
    for step in 0..steps {
        let t = f64::from(step) * h;
        let u = input.at(t + h / 2.0);
        let rate = |t: f64, x: &SVector<f64, N>| {
            let power = model.power(t, x, &u, &mut Default::default());
            let slope = model.derivative(t, x, &u, &mut Default::default());
            (slope, power.supplied, power.dissipated)
        };
        let k1 = rate(t, &x);
        let k2 = rate(t + h / 2.0, &(x + k1.0 * (h / 2.0)));
        let k3 = rate(t + h / 2.0, &(x + k2.0 * (h / 2.0)));
        let k4 = rate(t + h, &(x + k3.0 * h));
        let mean = |a: f64, b: f64, c: f64, d: f64| h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        supplied += mean(k1.1, k2.1, k3.1, k4.1);
        dissipated += mean(k1.2, k2.2, k3.2, k4.2);
        x += (k1.0 + k2.0 * 2.0 + k3.0 * 2.0 + k4.0) * (h / 6.0);
        let balance = model.energy(t + h, &x) - start - supplied + dissipated;
        most = most.max(supplied.abs());
        worst = larger(worst, balance.abs());
    }
    worst / most
}

#[track_caller]
fn balanced(imbalance: f64) {
    assert!(imbalance < 1e-12, "{imbalance:e}");
}

#[test]
fn navigation_system_balances() {
    let model = Ins::new(InsParameters::default()).unwrap();
    balanced(imbalance(&model, &gust(0.1), 1e-3, 20_000));
}

#[test]
fn oscillator_balances() {
    let model = Oscillator::new(OscillatorParameters::default()).unwrap();
    let push = Constant(SVector::from([10.0]));
    balanced(imbalance(&model, &push, 2e-4, 25_000));
}

#[test]
fn motor_balances() {
    let model = Motor::new(MotorParameters::default()).unwrap();
    balanced(imbalance(&model, &brake(), 1e-6, 300_000));
}

#[test]
fn ladder_balances() {
    let model = Ladder::new(LadderParameters::default()).unwrap();
    balanced(imbalance(&model, &(), 1e-3, 5_000));
}
