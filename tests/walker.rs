//! The compass walker: its strikes and its gait against equations written by hand.
#![allow(clippy::unwrap_used)]

#[path = "../examples/gallery/gait.rs"]
mod gait;
#[path = "references/mod.rs"]
mod references;

use gait::{Struck, StruckParameters, Walker, WalkerParameters};
use mbg_runtime::System;
use nalgebra::SVector;
use references::errors::apart;
use references::walker;

/// Angles of both legs against the normal and their rates, as the reference counts them.
fn of_legs(x: &SVector<f64, 4>) -> [f64; 4] {
    [x[0], x[0] + x[1], x[2], x[2] + x[3]]
}

fn models() -> (Walker<f64>, Struck<f64>) {
    let walker = Walker::new(WalkerParameters::default()).unwrap();
    let names = Walker::<f64>::META.states.iter().map(|state| state.name);
    assert!(names.eq(gait::STATES));
    (walker, Struck::new(StruckParameters::default()).unwrap())
}

#[test]
fn a_strike_changes_rates_as_angular_momenta_say() {
    let (walker, struck) = models();
    for before in [
        [-0.27, 0.27, -1.6, -1.7],
        [-0.1, 0.4, 0.3, -2.0],
        [0.2, -0.7, -1.0, 0.5],
    ] {
        let [s, w, s_rate, w_rate] = before;
        let state = SVector::from([s, w - s, s_rate, w_rate - s_rate]);
        let after = gait::strike(&walker, &struck, &state).unwrap();
        let error = apart(&of_legs(&after), &walker::strike(before));
        assert!(error < 1e-14, "{error:e}");
    }
}

#[test]
fn a_walker_comes_to_the_gait_of_the_reference() {
    let (walker, struck) = models();
    let mut start = walker.initial_state();
    for _ in 0..60 {
        let arrival = gait::swing(&walker, start, |_| ()).unwrap();
        start = gait::strike(&walker, &struck, &arrival.state).unwrap();
    }
    let (expected, known) = walker::cycle();
    let error = apart(&of_legs(&start), &known);
    assert!(error < 1e-12, "{error:e}");
    let arrival = gait::swing(&walker, start, |_| ()).unwrap();
    let period = arrival.time;
    assert!((period - expected).abs() < 1e-12, "{period} {expected}");
    // Both feet are on the slope.
    let places = walker.output(period, &arrival.state, &SVector::zeros(), &mut ());
    let stride = SVector::from([walker::stride(&known), 0.0]);
    assert!((places.fixed_rows::<2>(2) - stride).norm() < 1e-12);
}
