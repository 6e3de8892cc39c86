//! What is stored is what was supplied less what was dissipated.

use mbg_runtime::{Input, System};
use nalgebra::SVector;

use crate::references::errors::larger;

/// Runs RK4 with the energies supplied and dissipated as two more states. Gives the state at the end and the largest
/// imbalance as a part of the energy supplied, or of that at the start if this is more.
pub(super) fn run<const N: usize, const M: usize, const P: usize>(
    model: &impl System<f64, N, M, P>,
    input: &impl Input<f64, M>,
    h: f64,
    steps: u32,
) -> (SVector<f64, N>, f64) {
    let mut x = model.initial_state();
    let mut memory = Default::default();
    let start = model.energy(0.0, &x);
    let (mut gained, mut most, mut worst) = (0.0, start.abs(), 0.0_f64);
    for step in 0..steps {
        let t = f64::from(step) * h;
        let mut rate = |t: f64, x: &SVector<f64, N>| {
            let u = input.at(t);
            let power = model.power(t, x, &u, &mut memory);
            let slope = model.derivative(t, x, &u, &mut memory);
            (slope, power.supplied - power.dissipated)
        };
        let k1 = rate(t, &x);
        let k2 = rate(t + h / 2.0, &(x + k1.0 * (h / 2.0)));
        let k3 = rate(t + h / 2.0, &(x + k2.0 * (h / 2.0)));
        let k4 = rate(t + h, &(x + k3.0 * h));
        gained += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
        x += (k1.0 + k2.0 * 2.0 + k3.0 * 2.0 + k4.0) * (h / 6.0);
        let energy = model.energy(t + h, &x);
        most = most.max(energy.abs());
        worst = larger(worst, (energy - start - gained).abs());
    }
    (x, worst / most)
}
