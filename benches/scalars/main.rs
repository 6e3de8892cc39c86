//! Time of one derivative of the inertial navigation system by scalar: libm's sine against this crate's, rounded products
//! against fused ones, one number against lanes.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench --bench scalars` prints the table; all scalars take turns in each round,
//! so that ratios hold on a machine that is not quiet. `… -- SCALAR COUNT` evaluates so often and prints nothing else:
//! the difference of two counts under `valgrind --tool=callgrind` gives the instructions of one evaluation.

#[path = "../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;
#[path = "../../tests/references/noise.rs"]
mod noise;
mod plain;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use mbg_runtime::lanes::{Lanes, f32x8, f32x16, f64x4, f64x8};
use mbg_runtime::{FUSED, ParameterError, Real, System};
use models::{Ins, InsParameters};
use nalgebra::SVector;
use noise::noise;
use plain::Plain;

/// States that take turns.
const STATES: usize = 64;
/// Turns over all states in a round.
const TURNS: usize = 60;
/// Rounds, of which the median counts.
const ROUNDS: usize = 301;

type Scene<T> = (SVector<T, 9>, SVector<T, 3>);

/// Evaluates the derivative so often, at states that take turns.
type Run = Box<dyn Fn(usize)>;

/// A scalar under its name: how many states one evaluation is for, and the run.
struct Contestant {
    name: &'static str,
    count: usize,
    run: Run,
}

/// A run on states that `number` makes of numbers.
fn contestant<T: Real>(
    name: &'static str,
    count: usize,
    number: impl Fn(&mut dyn FnMut() -> f64) -> T,
) -> Result<Contestant, ParameterError> {
    let model = Ins::<T>::new(InsParameters::default())?;
    let mut random = noise(1);
    let scales = [1e3, 1e3, 1e3, 10.0, 10.0, 10.0, 0.5, 0.5, 0.5];
    let mut scaled = |scale: f64| number(&mut || scale * random());
    let scenes: Vec<Scene<T>> = (0..STATES)
        .map(|_| {
            let x = SVector::from(scales.map(&mut scaled));
            (x, SVector::from([100.0; 3].map(&mut scaled)))
        })
        .collect();
    let run = move |evaluations: usize| {
        for (x, u) in scenes.iter().cycle().take(evaluations) {
            let (x, u) = black_box((x, u));
            black_box(model.derivative(T::from_f64(0.0), x, u, &mut ()));
        }
    };
    Ok(Contestant {
        name,
        count,
        run: Box::new(run),
    })
}

fn alone<T: Real>(name: &'static str) -> Result<Contestant, ParameterError> {
    contestant(name, 1, |random| T::from_f64(random()))
}

fn together<L: Lanes>(name: &'static str) -> Result<Contestant, ParameterError> {
    contestant(name, L::COUNT, |random| {
        L::from_lanes(|_| L::Lane::from_f64(random()))
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() -> Result<(), Box<dyn Error>> {
    let contestants = [
        alone::<f64>("f64")?,
        alone::<Plain<true>>("f64, libm")?,
        alone::<Plain<false>>("f64, rounded")?,
        alone::<f32>("f32")?,
        together::<f64x4>("f64x4")?,
        together::<f64x8>("f64x8")?,
        together::<f32x8>("f32x8")?,
        together::<f32x16>("f32x16")?,
    ];
    let mut arguments = std::env::args().skip(1).filter(|it| it != "--bench");
    if let (Some(name), Some(count)) = (arguments.next(), arguments.next()) {
        let found = contestants.iter().find(|it| it.name == name);
        (found.ok_or("no such scalar")?.run)(count.parse()?);
        return Ok(());
    }
    let mut times = vec![Vec::new(); contestants.len()];
    let mut ratios = vec![Vec::new(); contestants.len()];
    for _ in 0..ROUNDS {
        for (number, contestant) in contestants.iter().enumerate() {
            let start = Instant::now();
            (contestant.run)(STATES * TURNS);
            let states = (STATES * TURNS * contestant.count) as f64;
            times[number].push(start.elapsed().as_secs_f64() * 1e9 / states);
            let (time, one) = (times[number].last(), times[0].last());
            if let (Some(time), Some(one)) = (time, one) {
                ratios[number].push(time / one);
            }
        }
    }
    println!("derivative of the INS, fused products: {FUSED}; medians of {ROUNDS} rounds\n");
    println!("{:<16}{:>14}{:>10}", "scalar", "ns per state", "ratio");
    for ((contestant, times), ratios) in contestants.iter().zip(times).zip(ratios) {
        let (time, ratio) = (median(times), median(ratios));
        println!("{:<16}{time:>14.1}{ratio:>10.2}", contestant.name);
    }
    Ok(())
}
