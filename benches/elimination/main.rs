//! Time of a factorisation and a solution by the plan of elimination against those with a search for pivots in all of the
//! matrix, and what that makes of a whole run.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench --bench elimination` prints the tables; both take turns in each round.

#[path = "../../examples/arm/model.rs"]
mod arm;
#[path = "../../examples/ins/models.rs"]
#[allow(dead_code)]
mod ins;
mod models;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use arm::{Arm, ArmParameters};
use ins::{Ins, InsParameters};
use mbg_runtime::__private::{Complex, Shifted};
use mbg_runtime::{Adaptive, Elimination, Estimating, Integrator, Radau5, Rodas4, Rodas5P, System};
use models::{
    Chain, ChainParameters, Dense, RingModulator, RingModulatorParameters, Row, RowParameters,
    ring_error, ring_nominal,
};
use nalgebra::SVector;

/// Rounds, of which the median counts.
const ROUNDS: usize = 41;

/// Medians of the time of each in s, taken in turns.
fn medians<const K: usize>(runs: [&dyn Fn(); K]) -> [f64; K] {
    let mut times = [[0.0; ROUNDS]; K];
    for round in 0..ROUNDS {
        for (times, run) in times.iter_mut().zip(&runs) {
            let start = Instant::now();
            run();
            times[round] = start.elapsed().as_secs_f64();
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    })
}

/// Products of a factorisation and of a solution.
fn products(elimination: &Elimination) -> [usize; 2] {
    let row = |column: &u16| 1 + elimination.upper[usize::from(*column)].len();
    let factors = elimination.lower.iter().copied().flatten().map(row).sum();
    let both = elimination.lower.iter().chain(elimination.upper);
    [
        factors,
        elimination.order.len() + both.map(|row| row.len()).sum::<usize>(),
    ]
}

/// A line: real and complex factors and solutions at the start.
fn line<S, const N: usize, const M: usize, const P: usize>(name: &str, system: &S)
where
    S: System<f64, N, M, P>,
{
    const TIMES: usize = 200;
    let x = system.initial_state();
    let u = SVector::zeros();
    let jacobian = system.jacobian_state(0.0, &x, &u, &mut S::Memory::default());
    let entries: usize = S::SPARSITY.map_or(0, |it| it.rows.iter().map(|row| row.len()).sum());
    let plan = S::SPARSITY.and_then(|it| it.elimination.as_ref());
    let dense = [(0..N).map(|rest| rest * (rest + 1)).sum(), N * N];
    let [factors, solution] = plan.map_or(dense, products);
    // As in a step of 1 ms at stiff problems, 10 ns in the circuit.
    let diagonal = if N == 15 { 1e8 } else { 1e3 };
    let pair = Complex {
        real: 0.7 * diagonal,
        imaginary: 0.8 * diagonal,
    };
    let sparse = Shifted::new::<S, M, P>(diagonal, 1.0, &jacobian);
    let pivoted = Shifted::new::<Dense<S>, M, P>(diagonal, 1.0, &jacobian);
    let sparse_pair = Shifted::new::<S, M, P>(pair, 1.0, &jacobian);
    let pivoted_pair = Shifted::new::<Dense<S>, M, P>(pair, 1.0, &jacobian);
    let (right, rights) = ([1.0; N], [pair; N]);
    fn repeat<R>(run: impl Fn() -> R) -> impl Fn() {
        move || {
            for _ in 0..TIMES {
                black_box(run());
            }
        }
    }
    let times = medians([
        &repeat(|| Shifted::new::<S, M, P>(diagonal, 1.0, black_box(&jacobian))),
        &repeat(|| Shifted::new::<Dense<S>, M, P>(diagonal, 1.0, black_box(&jacobian))),
        &repeat(|| black_box(&sparse).solve::<S, M, P>(black_box(right))),
        &repeat(|| black_box(&pivoted).solve::<Dense<S>, M, P>(black_box(right))),
        &repeat(|| Shifted::new::<S, M, P>(pair, 1.0, black_box(&jacobian))),
        &repeat(|| Shifted::new::<Dense<S>, M, P>(pair, 1.0, black_box(&jacobian))),
        &repeat(|| black_box(&sparse_pair).solve::<S, M, P>(black_box(rights))),
        &repeat(|| black_box(&pivoted_pair).solve::<Dense<S>, M, P>(black_box(rights))),
    ]);
    let times = times.map(|time| time * 1e9 / TIMES as f64);
    let planned = match sparse.is_planned() {
        true if S::UNROLLED => "written out",
        true => "loop",
        false => "dense",
    };
    println!(
        "{name:<16}{N:>4}{entries:>8}{factors:>8}{:>8}{solution:>8}{:>8}  {}  {planned}",
        dense[0],
        dense[1],
        times
            .chunks(2)
            .map(|pair| format!("{:>7.0}{:>7.0}", pair[0], pair[1]))
            .collect::<Vec<_>>()
            .join(" "),
    );
}

/// The ring modulator to 1 ms: error of the largest voltage, and the ratio of times.
fn run<E: Estimating>(method: E, tolerance: f64) -> Result<(), Box<dyn Error>> {
    let system = RingModulator::<f64>::new(RingModulatorParameters::default())?;
    let nominal = ring_nominal();
    let solver = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(method, tolerance, tolerance)
    };
    let end = |system: &dyn Fn(&mut SVector<f64, 15>)| {
        let mut last = SVector::zeros();
        system(&mut last);
        last
    };
    let sparse = |last: &mut SVector<f64, 15>| {
        let _ = solver.integrate(&system, &(), 0.0, 1e-3, system.initial_state(), |step| {
            *last = *step.state()
        });
    };
    let dense_system = Dense(system);
    let dense = |last: &mut SVector<f64, 15>| {
        let _ = solver.integrate(
            &dense_system,
            &(),
            0.0,
            1e-3,
            system.initial_state(),
            |step| *last = *step.state(),
        );
    };
    let error = ring_error(&end(&sparse));
    let statistics = solver.integrate(&system, &(), 0.0, 1e-3, system.initial_state(), |_| ())?;
    let times = medians([
        &|| {
            black_box(end(&sparse));
        },
        &|| {
            black_box(end(&dense));
        },
    ]);
    println!(
        "{:<12}{tolerance:>8.0e}{error:>10.1e}{:>8}{:>10.1}{:>10.1}{:>8.2}",
        E::NAME,
        statistics.steps,
        times[0] * 1e3,
        times[1] * 1e3,
        times[0] / times[1]
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("ns: factors and solution, real and complex, each by plan and dense");
    line("INS", &Ins::new(InsParameters::default())?);
    line("arm", &Arm::new(ArmParameters::default())?);
    line("chain of 16", &Chain::new(ChainParameters::default())?);
    line("row of 16", &Row::new(RowParameters::default())?);
    line(
        "ring modulator",
        &RingModulator::new(RingModulatorParameters::default())?,
    );
    println!(
        "ring modulator to 1 ms: tolerance, error / V, steps, time / ms by plan and dense, ratio"
    );
    for tolerance in [1e-3, 1e-4] {
        run(Rodas5P, tolerance)?;
        run(Rodas4, tolerance)?;
        run(Radau5, tolerance)?;
    }
    Ok(())
}
