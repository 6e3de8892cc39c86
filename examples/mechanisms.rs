//! Published mechanisms with closed loops over their published horizons.
//!
//! `cargo run --release --example mechanisms`

#[path = "../tests/models/mechanisms/mod.rs"]
#[allow(unreachable_pub, clippy::unwrap_used)]
mod mechanisms;
#[path = "../tests/references/mod.rs"]
mod references;

use mechanisms::{Figures, andrews, bricard, four_bars, governor, slider_crank};

fn main() {
    println!(
        "{:21}{:>7}{:>6}{:>5}{:>11}{:>8}{:>8}{:>9}{:>9}{:>9}{:>9}",
        "mechanism",
        "states",
        "loops",
        "rank",
        "operations",
        "end / s",
        "steps",
        "point",
        "gap",
        "energy",
        "time / s"
    );
    for run in [
        andrews::run,
        four_bars::run1,
        four_bars::run2,
        four_bars::run5,
        slider_crank::planar,
        slider_crank::spatial,
        bricard::run,
        governor::run,
    ] {
        print(&run());
    }
}

fn print(found: &Figures) {
    println!(
        "{:21}{:>7}{:>6}{:>5}{:>11}{:>8}{:>8}{:>9.1e}{:>9.1e}{:>9.1e}{:>9.2}",
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
