//! Runs of methods, their errors and their work.

use std::hint::black_box;
use std::time::{Duration, Instant};

use mbg_runtime::{
    Adaptive, Estimating, Fixed, Input, Integrator, Method, Statistics, Stopped, System,
};
use nalgebra::SVector;

use crate::Problem;
use crate::reference::{Reference, Unverified, distance};

/// Methods on one problem.
#[derive(Clone, Debug)]
pub struct Comparison<'a, S, I, const N: usize, const M: usize, const P: usize> {
    problem: Problem<'a, S, I, N, M, P>,
    reference: Reference<N>,
    points: Vec<Point>,
}

/// A method at one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The method.
    pub method: String,
    /// Its tolerance or step, as `rtol = 1e-6` or `h = 0.01`.
    pub setting: String,
    /// What came of it, or what stopped it.
    pub outcome: Result<Measured, String>,
}

/// What a run found and took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The largest error over all states and times, relative to the sizes of [`Reference`].
    pub error: f64,
    /// Time of the processor in seconds: the shortest of several runs, which others disturb least.
    pub time: f64,
    /// Evaluations of the derivative.
    pub evaluations: u64,
    /// Steps, rejected ones included.
    pub steps: u64,
}

/// A setting is run for so long, and so often at least and at most.
const PATIENCE: Duration = Duration::from_millis(60);
const RUNS: [u32; 2] = [5, 200];

impl<'a, S, I, const N: usize, const M: usize, const P: usize> Comparison<'a, S, I, N, M, P>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    /// Works out the reference.
    ///
    /// # Errors
    ///
    /// No two methods agree on it.
    pub fn new(problem: Problem<'a, S, I, N, M, P>) -> Result<Self, Unverified> {
        let reference = Reference::new(&problem)?;
        Ok(Self {
            problem,
            reference,
            points: Vec::new(),
        })
    }

    /// Runs a method at tolerances: relative ones, and absolute ones in units of the sizes of the states.
    pub fn over_tolerances<A: Estimating>(&mut self, method: A, tolerances: &[f64]) {
        for &tolerance in tolerances {
            let sizes = self.reference.sizes;
            let solver = Adaptive {
                nominal: &sizes,
                ..Adaptive::new(method, tolerance, tolerance)
            };
            self.integrator(A::NAME, &format!("rtol = {tolerance:e}"), &solver);
        }
    }

    /// Runs a method at steps of constant length.
    pub fn over_steps<A: Method>(&mut self, method: A, steps: &[f64]) {
        for &step in steps {
            self.integrator(A::NAME, &format!("h = {step}"), &Fixed::new(method, step));
        }
    }

    /// Runs an integrator of `mbg-runtime` as it is set.
    pub fn integrator(&mut self, method: &str, setting: &str, solver: &impl Integrator<N>) {
        let (system, input) = (self.problem.system, self.problem.input);
        let (start, state) = (self.problem.start, self.problem.state);
        let run = |times: &[f64], states: &mut Vec<SVector<f64, N>>| {
            solver
                .sample(system, input, start, state, times, |_t, x| states.push(*x))
                .map_err(|stopped: Stopped| stopped.to_string())
        };
        self.solver(method, setting, run);
    }

    /// Runs a solver from elsewhere: it is given the times and pushes the state at each.
    pub fn solver(
        &mut self,
        method: &str,
        setting: &str,
        run: impl Fn(&[f64], &mut Vec<SVector<f64, N>>) -> Result<Statistics, String>,
    ) {
        let outcome = self.measure(run);
        self.points.push(Point {
            method: method.to_owned(),
            setting: setting.to_owned(),
            outcome,
        });
    }

    fn measure(
        &self,
        run: impl Fn(&[f64], &mut Vec<SVector<f64, N>>) -> Result<Statistics, String>,
    ) -> Result<Measured, String> {
        let times = &self.problem.times;
        let mut states = Vec::with_capacity(times.len());
        let statistics = run(times, &mut states)?;
        let error = distance(&states, &self.reference.states, &self.reference.sizes);
        let begin = Instant::now();
        let (mut shortest, mut runs) = (f64::INFINITY, 0);
        while runs < RUNS[0] || (runs < RUNS[1] && begin.elapsed() < PATIENCE) {
            states.clear();
            let start = Instant::now();
            let _ = black_box(run(black_box(times), &mut states));
            shortest = shortest.min(start.elapsed().as_secs_f64());
            runs += 1;
        }
        Ok(Measured {
            error,
            time: shortest,
            evaluations: statistics.evaluations,
            steps: statistics.steps + statistics.rejected,
        })
    }
}

impl<'a, S, I, const N: usize, const M: usize, const P: usize> Comparison<'a, S, I, N, M, P> {
    /// What was integrated.
    pub fn problem(&self) -> &Problem<'a, S, I, N, M, P> {
        &self.problem
    }

    /// What errors are measured against.
    pub fn reference(&self) -> &Reference<N> {
        &self.reference
    }

    /// All measurements, in the order in which they were made.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Methods in the order in which they came.
    pub fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for point in &self.points {
            if !methods.contains(&point.method.as_str()) {
                methods.push(&point.method);
            }
        }
        methods
    }

    /// Finite errors and the work for them, the largest error first.
    pub fn series(&self, method: &str) -> Vec<Measured> {
        let of_method = self.points.iter().filter(|point| point.method == method);
        let mut series: Vec<Measured> = of_method
            .filter_map(|point| point.outcome.as_ref().ok().copied())
            .filter(|measured| measured.error.is_finite())
            .collect();
        series.sort_by(|a, b| b.error.total_cmp(&a.error));
        series
    }

    /// The time in seconds that a method takes to an error, between two settings along a power law; none where no
    /// setting comes to that error.
    pub fn time_to(&self, method: &str, error: f64) -> Option<f64> {
        time_to(&self.series(method), error)
    }
}

/// The time to an error in a series with the largest error first.
fn time_to(series: &[Measured], error: f64) -> Option<f64> {
    let mut best: Option<f64> = None;
    let mut take = |time: f64| best = Some(best.map_or(time, |best| best.min(time)));
    for pair in series.windows(2) {
        let [coarse, fine] = [pair[0], pair[1]];
        if coarse.error >= error && fine.error <= error && fine.error > 0.0 {
            let span = (coarse.error / fine.error).ln();
            let part = if span > 0.0 {
                (coarse.error / error).ln() / span
            } else {
                0.0
            };
            take(coarse.time * (fine.time / coarse.time).powf(part));
        }
    }
    for point in series.iter().filter(|point| point.error <= error) {
        take(point.time);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_lie_along_a_power_law() {
        let point = |(error, time)| Measured {
            error,
            time,
            evaluations: 0,
            steps: 0,
        };
        let series = [(1e-3, 1.0), (1e-5, 4.0), (1e-6, 32.0), (1e-9, 30.0)].map(point);
        let times = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-10].map(|error| time_to(&series, error));
        let expected = [1.0, 1.0, 2.0, 4.0, 30.0];
        for (found, expected) in times.iter().zip(expected) {
            assert!((found.unwrap() - expected).abs() < 1e-12, "{times:?}");
        }
        assert_eq!(times[5], None);
    }
}
