//! Compares the accelerations of real robots with those of Pinocchio, and times both in turns: `run` says how it is started.

mod cases;
mod pinocchio;

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use mbg_runtime::System;

use cases::Cases;
use pinocchio::Pinocchio;

include!(concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/target/robots/models.rs"
));

/// About how long one sample is, in ns.
const SAMPLE: f64 = 100_000.0;
/// A difference of the rates that is no rounding, relative to their length.
const DIFFERENCE: f64 = 1e-9;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(folder), Some(rounds)) = (arguments.next(), arguments.next()) else {
        return Err("usage: robots FOLDER ROUNDS".into());
    };
    let comparison = Comparison {
        folder: Path::new(&folder),
        rounds: rounds.parse()?,
    };
    println!(
        "{:<24} {:<6} {:>6} {:>10} {:>8} {:>13} {:>6} {:>10}",
        "robot", "base", "joints", "operations", "ours/ns", "Pinocchio/ns", "ratio", "difference"
    );
    compare_all(&comparison)?;
    println!(
        "\nForward dynamics at 64 states, medians of {rounds} rounds; difference: of all rates, relative to the largest"
    );
    Ok(())
}

struct Comparison<'a> {
    folder: &'a Path,
    rounds: usize,
}

impl Comparison<'_> {
    /// Prints one line of the table.
    fn compare<S: System<f64, N, M, P>, const N: usize, const M: usize, const P: usize>(
        &self,
        name: &str,
        system: &S,
        memory: S::Memory,
    ) -> Result<(), Box<dyn Error>> {
        let names: Vec<&str> = S::META.states.iter().map(|state| state.name).collect();
        let cases = Cases::<N, M>::read(&self.folder.join(format!("{name}.cases")), &names)?;
        let mut peer = Pinocchio::new(self.folder, name)?;
        let mut difference = 0.0_f64;
        for case in &cases.list {
            let found = system.derivative(0.0, &case.state, &case.input, &mut memory.clone());
            let apart = found - case.derivative;
            let agrees = apart.norm() < DIFFERENCE * case.derivative.norm();
            if !agrees {
                return Err(format!("{name}: the rates differ by {apart}").into());
            }
            difference = difference.max(apart.amax() / case.derivative.amax());
        }
        let mut ours = || {
            for case in &cases.list {
                black_box(system.derivative(0.0, &case.state, &case.input, &mut memory.clone()));
            }
        };
        let [ours, local, world] = {
            let mut local = |world: bool| {
                for case in &cases.list {
                    black_box(peer.acceleration(world, &case.position, &case.rates, &case.torques));
                }
            };
            let mut samples = [const { Vec::new() }; 3];
            for _ in 0..self.rounds {
                samples[0].push(sample(cases.list.len(), &mut ours));
                samples[1].push(sample(cases.list.len(), &mut || local(false)));
                samples[2].push(sample(cases.list.len(), &mut || local(true)));
            }
            samples.map(median)
        };
        let theirs = local.min(world);
        let flies = names.iter().any(|name| name.starts_with("float."));
        println!(
            "{name:<24} {:<6} {M:>6} {:>10} {ours:>8.0} {theirs:>13.0} {:>6.2} {difference:>10.1e}",
            if flies { "flies" } else { "held" },
            S::META.operations.derivative,
            ours / theirs,
        );
        Ok(())
    }
}

/// The time of one state in ns, of as many turns over all as a sample has.
fn sample(states: usize, run: &mut dyn FnMut()) -> f64 {
    let time = |turns: usize, run: &mut dyn FnMut()| {
        let start = Instant::now();
        for _ in 0..turns {
            run();
        }
        start.elapsed().as_secs_f64() * 1e9
    };
    let turns = (SAMPLE / time(1, run)).ceil() as usize;
    time(turns, run) / (turns * states) as f64
}

fn median(mut samples: Vec<f64>) -> f64 {
    samples.sort_by(f64::total_cmp);
    samples[samples.len() / 2]
}
