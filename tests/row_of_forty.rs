//! A row of forty four-bars: 162 states, 80 closing equations, all of which become dependent at once when the row turns
//! over through the position in which every link lies on one line.
//!
//! The model takes minutes to compile, so this is asked for by name:
//! `cargo test --release --features long --test row_of_forty -- --nocapture`
#![cfg(feature = "long")]
#![allow(unreachable_pub, clippy::unwrap_used)]

#[path = "references/mod.rs"]
mod references;
#[allow(dead_code, reason = "the adaptive pair is for smaller mechanisms")]
#[path = "models/mechanisms/task.rs"]
mod task;

use mbg_runtime::{System, mbg};
use nalgebra::SVector;
use references::errors::apart;
use references::four_bar::{DURATION, RATE, tip};
use task::{Method, Task, states};

const LOOPS: usize = 40;

mbg! {
    include "tests/models/mechanisms/row.mbg";

    #[derivative]
    pub(crate) model FourBars40 {
        causality componentwise;
        gravity [0.0, -9.81];
        row: Row { loops: 40 } ();
    }
}

/// The row, and its start.
fn row() -> (FourBars40, SVector<f64, 162>) {
    let system = FourBars40::new(FourBars40Parameters::default()).unwrap();
    let mut start = system.initial_state();
    let rates = states(FourBars40::<f64>::META, "rate.f");
    for (link, rate) in rates.into_iter().enumerate() {
        start[rate] = if link <= LOOPS { RATE } else { -RATE };
    }
    (system, start)
}

#[test]
fn its_jacobian_comes_from_dual_numbers() {
    on_a_large_stack(compare_jacobians);
}

fn compare_jacobians() {
    let (system, start) = row();
    let derivative = |x: &SVector<f64, 162>| system.derivative(0.0, x, &SVector::zeros(), &mut ());
    let (value, jacobian) = system.derivative_and_jacobian(0.0, &start, &SVector::zeros(), &mut ());
    assert_eq!(value, derivative(&start));
    let along = SVector::<f64, 162>::from_fn(|state, _| (1.3 * state as f64 + 0.4).sin());
    let difference =
        (derivative(&(start + along * 1e-6)) - derivative(&(start - along * 1e-6))) / 2e-6;
    let exact = jacobian * along;
    let error = (difference - exact).amax() / exact.amax();
    assert!(error < 1e-6, "{error:e}");
}

/// Matrices of 80 by 80 live on the stack, which in a test is otherwise 2 MB.
fn on_a_large_stack(run: fn()) {
    let thread = std::thread::Builder::new().stack_size(64 << 20);
    thread.spawn(run).unwrap().join().unwrap();
}

#[test]
fn forty_loops_pass_their_singular_position() {
    on_a_large_stack(run);
}

fn run() {
    let (system, start) = row();
    let meta = FourBars40::<f64>::META;
    let task = Task {
        mechanism: "40 four-bars",
        system,
        start,
        horizon: DURATION,
        instants: 20,
        method: Method::Fixed(1e-3),
    };
    let found = task.run(|t, point| apart(point, &tip(LOOPS, t)[0]));
    println!(
        "{}: {} states, rank {} of {}, {} operations, point {:.1e} m, gap {:.1e} m, energy {:.1e}, {:.1} s",
        found.mechanism,
        meta.states.len(),
        found.closing[1],
        found.closing[0],
        meta.operations.derivative,
        found.point,
        found.gap,
        found.energy,
        found.seconds
    );
    assert!(found.energy < 1e-8 && found.gap < 1e-12 && found.point < 1e-5);
}
