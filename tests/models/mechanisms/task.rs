//! One mechanism, run over its horizon.
//!
//! A model names its outputs alike: `gap` is what must stay zero for its loops to be closed, `balance` is what keeps
//! the sum with the energy stored constant, and `point` is compared with the reference.

use std::time::Instant;

use mbg_runtime::solve::least_norm;
use mbg_runtime::{Adaptive, Constant, Integrator, Meta, Rk4, Stopped, System, Tsit5};
use nalgebra::{SMatrix, SVector};

use crate::references::errors::larger;

/// What a run shows.
#[allow(dead_code, reason = "tests read less than the example prints")]
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
    /// The point at each time at which it is compared.
    pub(crate) trajectory: Vec<(f64, Vec<f64>)>,
    pub(crate) seconds: f64,
}

/// How a run gets ahead.
pub(crate) enum Method {
    /// By the adaptive pair with this tolerance.
    Pair(f64),
    /// By the method of Runge and Kutta with this step.
    Fixed(f64),
}

/// A mechanism and how it is run.
pub(crate) struct Task<S, const N: usize> {
    pub(crate) mechanism: &'static str,
    pub(crate) system: S,
    pub(crate) start: SVector<f64, N>,
    pub(crate) horizon: f64,
    /// How often the point is compared.
    pub(crate) instants: u32,
    pub(crate) method: Method,
}

/// What is read off a state.
struct Reading {
    gap: f64,
    energy: f64,
    point: Vec<f64>,
}

impl<S, const N: usize> Task<S, N> {
    /// Runs it; `error` is that of the point at a time.
    pub(crate) fn run<const P: usize>(&self, error: impl Fn(f64, &[f64]) -> f64) -> Figures
    where
        S: System<f64, N, 0, P>,
    {
        let begin = Instant::now();
        let gap = outputs(S::META, "gap");
        let mut x = self.start;
        let first = self.read(0.0, &x).energy;
        let mut figures = Figures {
            mechanism: self.mechanism,
            meta: S::META,
            closing: [gap.len(), 0],
            horizon: self.horizon,
            steps: 0,
            gap: 0.0,
            energy: 0.0,
            point: 0.0,
            trajectory: Vec::new(),
            seconds: 0.0,
        };
        let time = |instant: u32| self.horizon * f64::from(instant) / f64::from(self.instants);
        for instant in 0..self.instants {
            let (from, to) = (time(instant), time(instant + 1));
            let steps = self.advance((from, to), x, |t, next| {
                x = *next;
                let found = self.read(t, &x);
                figures.gap = larger(figures.gap, found.gap);
                figures.energy = larger(figures.energy, (found.energy / first - 1.0).abs());
            });
            figures.steps +=
                steps.unwrap_or_else(|stopped| panic!("{}: {stopped}", self.mechanism));
            let point = self.read(to, &x).point;
            figures.point = larger(figures.point, error(to, &point));
            figures.trajectory.push((to, point));
        }
        figures.closing[1] = self.rank(&x, &gap);
        figures.seconds = begin.elapsed().as_secs_f64();
        figures
    }

    fn advance<const P: usize>(
        &self,
        (from, to): (f64, f64),
        x: SVector<f64, N>,
        mut observer: impl FnMut(f64, &SVector<f64, N>),
    ) -> Result<u64, Stopped>
    where
        S: System<f64, N, 0, P>,
    {
        let input = Constant(SVector::zeros());
        let statistics = match self.method {
            Method::Pair(tolerance) => Adaptive::new(Tsit5, tolerance, tolerance).integrate(
                &self.system,
                &input,
                from,
                to,
                x,
                |step| observer(step.end(), step.state()),
            ),
            Method::Fixed(step) => Rk4::fixed(&self.system, &input, from, to, step, x, observer),
        };
        Ok(statistics?.steps)
    }

    fn read<const P: usize>(&self, t: f64, x: &SVector<f64, N>) -> Reading
    where
        S: System<f64, N, 0, P>,
    {
        let output = self
            .system
            .output(t, x, &SVector::zeros(), &mut S::Memory::default());
        let [gap, balance, point] = ["gap", "balance", "point"].map(|name| {
            outputs(S::META, name)
                .into_iter()
                .map(|place| output[place])
        });
        Reading {
            gap: gap.map(f64::abs).fold(0.0, larger),
            energy: self.system.energy(t, x) + balance.sum::<f64>(),
            point: point.collect(),
        }
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
