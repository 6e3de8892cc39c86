//! Time of a derivative in batches: one number after the other, lanes by the instructions that the program is compiled for,
//! and those by instructions chosen when it runs.
//!
//! `cargo bench --bench batches` is a program for every x86-64, `RUSTFLAGS="-C target-cpu=native" cargo bench --bench
//! batches` one for this processor. All take turns in each round; the shortest of the times counts.

use std::hint::black_box;
use std::time::Instant;

use mbg_runtime::batch::{Block, Instructions};
use mbg_runtime::lanes::{Lanes, f32x16, f64x4, f64x8};
use mbg_runtime::{Convertible, ParameterError, Real, System};
use nalgebra::SVector;

#[path = "../../examples/arm/model.rs"]
#[allow(unreachable_pub)]
mod arm;
#[path = "../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;
#[path = "../../tests/references/noise.rs"]
mod noise;

use arm::{Arm, ArmParameters};
use models::{Ins, InsParameters};
use noise::noise;

/// States of a batch.
const STATES: usize = 4096;
/// Rounds, of which the fastest counts.
const ROUNDS: usize = 301;

/// Evaluates a batch.
type Run = Box<dyn FnMut()>;

struct Contestant {
    name: String,
    run: Run,
}

/// States and inputs at random, and places for the rates.
struct Batch<T, const N: usize, const M: usize> {
    states: Vec<SVector<T, N>>,
    inputs: Vec<SVector<T, M>>,
    rates: Vec<SVector<T, N>>,
}

impl<T: Real, const N: usize, const M: usize> Batch<T, N, M> {
    fn new(count: usize, scales: [f64; N], number: impl Fn(&mut dyn FnMut() -> f64) -> T) -> Self {
        let mut random = noise(1);
        let mut scaled = |scale: f64| number(&mut || scale * random());
        let blocks = 0..STATES / count;
        let states: Vec<_> = blocks
            .map(|_| SVector::from(scales.map(&mut scaled)))
            .collect();
        Self {
            inputs: states
                .iter()
                .map(|_| SVector::from_fn(|_, _| scaled(1.0)))
                .collect(),
            rates: states.clone(),
            states,
        }
    }

    fn of_lanes(scales: [f64; N]) -> Self
    where
        T: Lanes,
    {
        Self::new(T::COUNT, scales, |random| {
            T::from_lanes(|_| T::Lane::from_f64(random()))
        })
    }
}

/// By the instructions that the program is compiled for.
fn compiled<T, S, const N: usize, const M: usize, const P: usize>(
    name: &str,
    model: S,
    mut batch: Batch<T, N, M>,
) -> Contestant
where
    T: Real,
    S: System<T, N, M, P, Memory = ()> + 'static,
{
    let run = move || {
        let model = black_box(&model);
        let scenes = batch.states.iter().zip(&batch.inputs);
        for ((x, u), rates) in scenes.zip(&mut batch.rates) {
            *rates = model.derivative(T::from_f64(0.0), x, u, &mut ());
        }
        black_box(&batch.rates);
    };
    Contestant {
        name: name.into(),
        run: Box::new(run),
    }
}

/// By each of the instructions that the processor has.
fn chosen<L, S, const N: usize, const M: usize, const P: usize>(
    name: &str,
    model: S,
    scales: [f64; N],
) -> impl Iterator<Item = Contestant>
where
    L: Block,
    S: Convertible<L, N, M, P, Memory = ()> + Copy + 'static,
{
    Instructions::available().map(move |instructions| {
        let mut batch = Batch::<L, N, M>::of_lanes(scales);
        let time = L::Lane::from_f64(0.0);
        let run = move || {
            let (
                model,
                Batch {
                    states,
                    inputs,
                    rates,
                },
            ) = (black_box(&model), &mut batch);
            instructions.derivatives(model, time, states, inputs, rates);
            black_box(rates);
        };
        Contestant {
            name: format!("{name}, {instructions}"),
            run: Box::new(run),
        }
    })
}

/// Nanoseconds per state, the least of all rounds.
fn times(contestants: &mut [Contestant]) -> Vec<f64> {
    let mut times = vec![f64::INFINITY; contestants.len()];
    for _ in 0..ROUNDS {
        for (contestant, time) in contestants.iter_mut().zip(&mut times) {
            let start = Instant::now();
            (contestant.run)();
            *time = time.min(start.elapsed().as_secs_f64() * 1e9 / STATES as f64);
        }
    }
    times
}

/// Prints a table of one model.
fn compare(scene: &str, mut contestants: Vec<Contestant>) {
    let times = times(&mut contestants);
    println!("{scene:<20}{:>14}", "ns per state");
    for (Contestant { name, .. }, time) in contestants.iter().zip(&times) {
        println!("  {name:<18}{time:>14.1}");
    }
}

macro_rules! contestants {
    ($model:ident, $parameters:ident, $scales:expr) => {{
        let mut contestants = vec![
            compiled(
                "f64",
                $model::new($parameters::default())?,
                Batch::new(1, $scales, |random| random()),
            ),
            compiled(
                "f64x4",
                $model::new($parameters::default())?,
                Batch::<f64x4, _, _>::of_lanes($scales),
            ),
        ];
        contestants.extend(chosen::<f64x8, _, _, _, _>(
            "f64x8",
            $model::new($parameters::default())?,
            $scales,
        ));
        contestants.extend(chosen::<f32x16, _, _, _, _>(
            "f32x16",
            $model::new($parameters::default())?,
            $scales,
        ));
        contestants
    }};
}

fn navigation() -> Result<Vec<Contestant>, ParameterError> {
    let scales = [1e3, 1e3, 1e3, 10.0, 10.0, 10.0, 0.5, 0.5, 0.5];
    Ok(contestants!(Ins, InsParameters, scales))
}

fn seven_axes() -> Result<Vec<Contestant>, ParameterError> {
    Ok(contestants!(Arm, ArmParameters, [1.0; 14]))
}

fn main() -> Result<(), ParameterError> {
    compare("INS", navigation()?);
    compare("7-axis arm", seven_axes()?);
    Ok(())
}
