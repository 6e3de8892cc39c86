//! Published mechanisms with closed loops over their published horizons: what each run shows, and the way of its point.
//!
//! `cargo run --release --example mechanisms`

#[path = "../tests/models/mechanisms/mod.rs"]
#[allow(unreachable_pub, clippy::unwrap_used)]
mod mechanisms;
#[path = "../tests/references/mod.rs"]
mod references;

use mechanisms::{Figures, andrews, bricard, four_bars, governor, slider_crank};

type Run = fn() -> Figures;

/// Each mechanism, and what its point is.
const RUNS: [(Run, &str); 8] = [
    (andrews::run, "seven angles / rad"),
    (four_bars::run1, "tip of the first crank / m"),
    (four_bars::run2, "tip of the first crank / m"),
    (four_bars::run5, "tip of the first crank / m"),
    (slider_crank::planar, "angle of the crank / rad, slider / m"),
    (
        slider_crank::spatial,
        "angle of the crank / rad, slider / m",
    ),
    (bricard::run, "joint P3 / m"),
    (
        governor::run,
        "slider / m, stretch less that of the geometry / m",
    ),
];

fn main() {
    println!(
        "mechanism              states  closing  rank  operations  end / s   steps    point      gap   energy  time / s"
    );
    let found = RUNS.map(|(run, point)| (run(), point));
    for (figures, _) in &found {
        print(figures);
    }
    for (figures, point) in &found {
        println!("\n{}: {point}", figures.mechanism);
        for (time, values) in &figures.trajectory {
            let values: String = values.iter().map(|value| format!("{value:13.8}")).collect();
            println!("{time:8.3} s{values}");
        }
    }
}

fn print(found: &Figures) {
    println!(
        "{:22}{:>7}{:>9}{:>6}{:>12}{:>9}{:>8}{:>9.1e}{:>9.1e}{:>9.1e}{:>10.2}",
        found.mechanism,
        found.meta.states.len(),
        found.closing[0],
        found.closing[1],
        found.meta.operations.derivative,
        found.horizon,
        found.steps,
        found.point,
        found.gap,
        found.energy,
        found.seconds
    );
}
