//! Published mechanisms with closed loops, built from the library and run over their published horizons.
//!
//! A model names its outputs alike: `gap` is what must stay zero for its loops to be closed, `balance` is what keeps
//! the sum with the energy stored constant, and `point` is compared with the reference.

pub(crate) mod andrews;
pub(crate) mod four_bars;

use std::time::Instant;

use mbg_runtime::solve::least_norm;
use mbg_runtime::{Constant, DormandPrince, Meta, System};
use nalgebra::{SMatrix, SVector};

/// What a run shows.
pub(crate) struct Figures {
    pub(crate) mechanism: &'static str,
    pub(crate) meta: &'static Meta,
    /// How many equations close the loops, and how many of them are independent at the end.
    pub(crate) closing: [usize; 2],
    pub(crate) horizon: f64,
    pub(crate) steps: u64,
    /// Largest gap after a step.
    pub(crate) gap: f64,
    /// Largest change of the total energy after a step, relative to that at the start.
    pub(crate) energy: f64,
    /// Largest error of the point.
    pub(crate) point: f64,
    pub(crate) seconds: f64,
}

/// A mechanism and how it is run.
pub(crate) struct Task<S, const N: usize> {
    pub(crate) mechanism: &'static str,
    pub(crate) system: S,
    pub(crate) start: SVector<f64, N>,
    pub(crate) horizon: f64,
    /// How often the point is compared.
    pub(crate) instants: u32,
    pub(crate) pair: DormandPrince,
}

impl<S, const N: usize> Task<S, N> {
    /// Runs it; `error` is that of the point at a time.
    pub(crate) fn run<const P: usize>(&self, error: impl Fn(f64, &[f64]) -> f64) -> Figures
    where
        S: System<f64, N, 0, P>,
    {
        let begin = Instant::now();
        let meta = S::META;
        let [gap, balance, point] = ["gap", "balance", "point"].map(|name| outputs(meta, name));
        let read = |t, x: &SVector<f64, N>| {
            let output = self
                .system
                .output(t, x, &SVector::zeros(), &mut S::Memory::default());
            let open = gap
                .iter()
                .fold(0.0, |open: f64, place| open.max(output[*place].abs()));
            let energy = self.system.energy(t, x) + output[balance[0]];
            let point: Vec<f64> = point.iter().map(|place| output[*place]).collect();
            (open, energy, point)
        };
        let (_, first, _) = read(0.0, &self.start);
        let mut x = self.start;
        let mut figures = Figures {
            mechanism: self.mechanism,
            meta,
            closing: [gap.len(), 0],
            horizon: self.horizon,
            steps: 0,
            gap: 0.0,
            energy: 0.0,
            point: 0.0,
            seconds: 0.0,
        };
        let time = |instant: u32| self.horizon * f64::from(instant) / f64::from(self.instants);
        for instant in 0..self.instants {
            let (from, to) = (time(instant), time(instant + 1));
            let input = Constant(SVector::zeros());
            let run = self
                .pair
                .integrate(&self.system, &input, from, to, x, |step| {
                    x = *step.state();
                    let (open, energy, _) = read(step.end(), &x);
                    figures.gap = figures.gap.max(open);
                    figures.energy = figures.energy.max(((energy - first) / first).abs());
                });
            figures.steps += run
                .unwrap_or_else(|stopped| panic!("{}: {stopped}", self.mechanism))
                .steps;
            figures.point = figures.point.max(error(to, &read(to, &x).2));
        }
        figures.closing[1] = self.rank(&x, &gap);
        figures.seconds = begin.elapsed().as_secs_f64();
        figures
    }

    /// How many of the equations that close the loops are independent.
    fn rank<const P: usize>(&self, x: &SVector<f64, N>, gap: &[usize]) -> usize
    where
        S: System<f64, N, 0, P>,
    {
        let output = |x: &SVector<f64, N>| {
            self.system
                .output(0.0, x, &SVector::zeros(), &mut S::Memory::default())
        };
        let mut slopes = SMatrix::<f64, P, N>::zeros();
        for state in 0..N {
            let mut step = SVector::zeros();
            step[state] = 1e-5;
            let difference = output(&(x + step)) - output(&(x - step));
            for row in gap {
                slopes[(*row, state)] = difference[*row] / 2e-5;
            }
        }
        least_norm(&(slopes * slopes.transpose()), &SVector::zeros()).rank
    }
}

/// The places of the outputs with this name, in any part of a model.
fn outputs(meta: &Meta, name: &str) -> Vec<usize> {
    let named = |path: &str| path.split(['.', '[']).any(|word| word == name);
    let places = meta.outputs.iter().enumerate();
    places
        .filter(|(_, output)| named(output.name))
        .map(|(place, _)| place)
        .collect()
}

/// The places of the states whose names end like this.
pub(crate) fn states(meta: &Meta, ending: &str) -> Vec<usize> {
    let places = meta.states.iter().enumerate();
    places
        .filter(|(_, state)| state.name.ends_with(ending))
        .map(|(place, _)| place)
        .collect()
}

/// The largest difference.
pub(crate) fn apart(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    found
        .iter()
        .zip(expected)
        .fold(0.0, |apart, (a, b)| apart.max((a - b).abs()))
}
