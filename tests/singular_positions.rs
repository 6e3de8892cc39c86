//! Adaptive steps through positions in which the closing equations of a mechanism become dependent.
#![allow(unreachable_pub, clippy::unwrap_used)]

use mbg_runtime::{Adaptive, Integrator, System, Tsit5, mbg};
use nalgebra::SVector;

mbg! { include "tests/models/mechanisms/two_four_bars.mbg"; }

/// Two four-bars over 10 s, from 200 rates of the cranks: every run arrives, and energy stays to the tolerance.
#[test]
fn adaptive_steps_pass_singular_positions() {
    let system = FourBars2::new(FourBars2Parameters::default()).unwrap();
    let meta = FourBars2::<f64>::META;
    let balance = meta
        .outputs
        .iter()
        .position(|it| it.name.ends_with("balance"));
    let total = |x: &SVector<f64, 10>| {
        let output = system.output(0.0, x, &SVector::zeros(), &mut ());
        system.energy(0.0, x) + output[balance.unwrap()]
    };
    for tolerance in [1e-6, 1e-8] {
        let solver = Adaptive::new(Tsit5, tolerance, tolerance);
        let mut worst = 0.0_f64;
        for trial in 0..200 {
            let rate = 0.5 + 0.05 * f64::from(trial);
            let mut start = system.initial_state();
            let states = meta.states.iter().enumerate();
            let rates = states.filter(|(_, it)| it.name.ends_with("rate.f"));
            for (link, (place, _)) in rates.enumerate() {
                start[place] = if link <= 2 { rate } else { -rate };
            }
            let mut last = start;
            solver
                .integrate(&system, &(), 0.0, 10.0, start, |step| last = *step.state())
                .unwrap();
            worst = worst.max((total(&last) / total(&start) - 1.0).abs());
        }
        println!("{tolerance:e}: energy {worst:.1e}");
        assert!(worst < 50.0 * tolerance, "{tolerance:e}: {worst:e}");
    }
}
