//! Compares the accelerations of real robots and their derivatives with those of Pinocchio, and times both in turns: `run` says
//! how it is started.

mod cases;
mod pinocchio;

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use mbg_runtime::System;
use nalgebra::{SMatrix, SVector};

use cases::{Case, Cases};
use pinocchio::{Pinocchio, Way};

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
        "{:<24} {:<6} {:>6} {:>10} {}   linearised: {}",
        "robot",
        "base",
        "joints",
        "operations",
        Times::HEAD,
        Times::HEAD.trim_start()
    );
    compare_all(&comparison)?;
    println!(
        "\nForward dynamics at 64 states, medians of {rounds} rounds; difference: of all rates, relative to the largest\n\
         linearised: the same with the derivatives by states and by torques; difference: of how the rates change, likewise",
        rounds = comparison.rounds
    );
    Ok(())
}

struct Comparison<'a> {
    folder: &'a Path,
    rounds: usize,
}

/// Times in ns, and how far apart results are.
struct Times {
    ours: f64,
    theirs: f64,
    difference: f64,
}

impl Times {
    const HEAD: &str = "  ours/ns  Pinocchio/ns  ratio difference";
}

impl Display for Times {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let ratio = self.ours / self.theirs;
        write!(
            formatter,
            "{:>9.0} {:>13.0} {ratio:>6.2} {:>10.1e}",
            self.ours, self.theirs, self.difference
        )
    }
}

impl Comparison<'_> {
    fn compare<S: System<f64, N, M, P>, const N: usize, const M: usize, const P: usize>(
        &self,
        robot: &str,
        system: &S,
        memory: S::Memory,
    ) -> Result<(), Box<dyn Error>> {
        let names: Vec<&str> = S::META.states.iter().map(|state| state.name).collect();
        let cases = Cases::<N, M>::read(&self.folder.join(format!("{robot}.cases")), &names)?.list;
        let mut peer = Pinocchio::new(self.folder, robot)?;
        let rates = |case: &Case<N, M>| {
            system.derivative(0.0, &case.state, &case.input, &mut memory.clone())
        };
        let slopes = |case: &Case<N, M>, by_state: &mut SMatrix<f64, N, N>| {
            let (state, input, memory) = (&case.state, &case.input, &mut memory.clone());
            let mut derivative = SVector::zeros();
            system.derivative_and_jacobian_into(
                0.0,
                state,
                input,
                memory,
                &mut derivative,
                by_state,
            );
            let by_input = system.jacobian_input(0.0, state, input, memory);
            black_box((derivative, by_state));
            black_box(by_input)
        };
        let mut by_state = Box::new(SMatrix::zeros());
        let mut differences = [0.0_f64; 2];
        for case in &cases {
            let by_input = slopes(case, &mut by_state);
            let change = *by_state * case.change.0 + by_input * case.change.1;
            let found = [rates(case), change];
            let expected = [case.derivative, case.derivative_change];
            for ((found, expected), difference) in found.iter().zip(&expected).zip(&mut differences)
            {
                let apart = found - expected;
                let agrees = apart.norm() < DIFFERENCE * expected.norm();
                if !agrees {
                    return Err(format!("{robot}: the results differ by {apart}").into());
                }
                *difference = difference.max(apart.amax() / expected.amax());
            }
        }
        let samples = {
            let mut theirs = |way: Way, case: &Case<N, M>| {
                black_box(peer.acceleration(way, &case.position, &case.rates, &case.torques));
            };
            let mut samples = [const { Vec::new() }; 5];
            for _ in 0..self.rounds {
                samples[0].push(sample(&cases, |case| {
                    black_box(rates(case));
                }));
                samples[1].push(sample(&cases, |case| theirs(Way::Local, case)));
                samples[2].push(sample(&cases, |case| theirs(Way::World, case)));
                samples[3].push(sample(&cases, |case| {
                    slopes(case, &mut by_state);
                }));
                samples[4].push(sample(&cases, |case| theirs(Way::Slopes, case)));
            }
            samples
        };
        let [ours, local, world, our_slopes, their_slopes] = samples.map(median);
        let [difference, difference_of_slopes] = differences;
        let rates = Times {
            ours,
            theirs: local.min(world),
            difference,
        };
        let slopes = Times {
            ours: our_slopes,
            theirs: their_slopes,
            difference: difference_of_slopes,
        };
        let flies = names.iter().any(|name| name.starts_with("float."));
        println!(
            "{robot:<24} {:<6} {M:>6} {:>10} {rates}   {:>11} {slopes}",
            if flies { "flies" } else { "held" },
            S::META.operations.derivative,
            "",
        );
        Ok(())
    }
}

/// The time of one case in ns, of as many turns over all as a sample has.
fn sample<C>(cases: &[C], mut run: impl FnMut(&C)) -> f64 {
    let mut time = |turns: usize| {
        let start = Instant::now();
        for _ in 0..turns {
            cases.iter().for_each(&mut run);
        }
        start.elapsed().as_secs_f64() * 1e9
    };
    let turns = (SAMPLE / time(1)).ceil() as usize;
    time(turns) / (turns * cases.len()) as f64
}

fn median(mut samples: Vec<f64>) -> f64 {
    samples.sort_by(f64::total_cmp);
    samples[samples.len() / 2]
}
