//! States that count as true, because two methods agree on them.

use core::fmt;

use mbg_runtime::{
    Adaptive, Auto, Dop853, Estimating, Input, Integrator, Method, Picked, Radau5, Rodas5P,
    Stopped, System, Tsit5,
};
use nalgebra::SVector;

use crate::Problem;

/// A solution that two methods agree on.
#[derive(Clone, Debug)]
pub struct Reference<const N: usize> {
    /// The states at the times of the problem.
    pub states: Vec<SVector<f64, N>>,
    /// The method that computed it and the one that verified it.
    pub methods: [&'static str; 2],
    /// The tolerance at which both ran.
    pub tolerance: f64,
    /// The largest relative difference between the two; smaller errors cannot be told apart.
    pub agreement: f64,
    /// Whether the problem is stiff.
    pub stiff: bool,
    /// What errors of each state are divided by.
    pub sizes: [f64; N],
}

/// No two methods agree on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unverified {
    /// How far apart they were at best; none if no two came to the end.
    pub best: Option<f64>,
    /// How well they had to agree.
    pub needed: f64,
    /// What stopped a run, if one was stopped.
    pub stopped: Option<Stopped>,
}

impl fmt::Display for Unverified {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "no reference: two methods must agree within {:e}",
            self.needed
        )?;
        if let Some(best) = self.best {
            write!(formatter, ", at best they are {best:.1e} apart")?;
        }
        match self.stopped {
            Some(stopped) => write!(formatter, "; a run {stopped}"),
            None => Ok(()),
        }
    }
}

impl core::error::Error for Unverified {}

/// Tolerances for references, the tightest first.
const TOLERANCES: [f64; 6] = [1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8];

impl<const N: usize> Reference<N> {
    pub(crate) fn new<S, I, const M: usize, const P: usize>(
        problem: &Problem<'_, S, I, N, M, P>,
    ) -> Result<Self, Unverified>
    where
        S: System<f64, N, M, P>,
        I: Input<f64, M>,
    {
        let auto = Auto {
            nominal: problem.sizes(),
            ..Auto::new(1e-9, 1e-9)
        };
        let (start, end) = (problem.start, problem.end());
        let picked = auto
            .choose(problem.system, problem.input, start, end, problem.state)
            .map(|choice| choice.method);
        match picked {
            Ok(Picked::Rodas5P | Picked::Radau5 | Picked::Radau9) => Self::stiff(problem),
            // Some problems become stiff on their way.
            _ => Self::agreed(problem, (Dop853, Tsit5), false).or_else(|_| Self::stiff(problem)),
        }
    }

    fn stiff<S, I, const M: usize, const P: usize>(
        problem: &Problem<'_, S, I, N, M, P>,
    ) -> Result<Self, Unverified>
    where
        S: System<f64, N, M, P>,
        I: Input<f64, M>,
    {
        Self::agreed(problem, (Radau5, Rodas5P), true)
    }

    /// The solution at the tightest tolerance at which both methods agree well enough.
    fn agreed<S, I, A, B, const M: usize, const P: usize>(
        problem: &Problem<'_, S, I, N, M, P>,
        (first, second): (A, B),
        stiff: bool,
    ) -> Result<Self, Unverified>
    where
        S: System<f64, N, M, P>,
        I: Input<f64, M>,
        A: Estimating,
        B: Estimating,
    {
        let mut unverified = Unverified {
            best: None,
            needed: problem.agreement,
            stopped: None,
        };
        for tolerance in TOLERANCES {
            let runs = run(problem, first, tolerance)
                .and_then(|states| Ok((states, run(problem, second, tolerance)?)));
            let (states, others) = match runs {
                Ok(runs) => runs,
                Err(stopped) => {
                    unverified.stopped = Some(stopped);
                    continue;
                }
            };
            let sizes = sizes(problem, &states);
            let agreement = distance(&states, &others, &sizes);
            if agreement <= problem.agreement {
                return Ok(Self {
                    states,
                    methods: [<A as Method>::NAME, <B as Method>::NAME],
                    tolerance,
                    agreement,
                    stiff,
                    sizes,
                });
            }
            unverified.best = Some(
                unverified
                    .best
                    .map_or(agreement, |best| best.min(agreement)),
            );
        }
        Err(unverified)
    }
}

fn run<S, I, A, const N: usize, const M: usize, const P: usize>(
    problem: &Problem<'_, S, I, N, M, P>,
    method: A,
    tolerance: f64,
) -> Result<Vec<SVector<f64, N>>, Stopped>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    A: Estimating,
{
    let solver = Adaptive {
        nominal: problem.sizes(),
        ..Adaptive::new(method, tolerance, tolerance)
    };
    let (start, state) = (problem.start, problem.state);
    let mut states = Vec::with_capacity(problem.times.len());
    let keep = |_t: f64, x: &SVector<f64, N>| states.push(*x);
    solver.sample(
        problem.system,
        problem.input,
        start,
        state,
        &problem.times,
        keep,
    )?;
    Ok(states)
}

/// The largest size of each state, at least its nominal size; 1 for a state that is always zero.
fn sizes<S, I, const N: usize, const M: usize, const P: usize>(
    problem: &Problem<'_, S, I, N, M, P>,
    states: &[SVector<f64, N>],
) -> [f64; N] {
    core::array::from_fn(|state| {
        let nominal = problem.nominal.map_or(0.0, |sizes| sizes[state]);
        let largest = states
            .iter()
            .fold(nominal, |largest, x| largest.max(x[state].abs()));
        if largest > 0.0 { largest } else { 1.0 }
    })
}

/// The largest difference of a state relative to its size; infinite when one is missing or not a number.
pub(crate) fn distance<const N: usize>(
    found: &[SVector<f64, N>],
    expected: &[SVector<f64, N>],
    sizes: &[f64; N],
) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let mut largest = 0.0_f64;
    for (found, expected) in found.iter().zip(expected) {
        for (state, size) in sizes.iter().enumerate() {
            let apart = (found[state] - expected[state]).abs() / size;
            largest = largest.max(if apart.is_nan() { f64::INFINITY } else { apart });
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_relative_to_sizes() {
        let [found, expected] = [[1.0, 1000.0], [1.5, 1010.0]].map(|x| [SVector::from(x)]);
        assert_eq!(distance(&found, &expected, &[1.0, 1000.0]), 0.5);
        assert_eq!(distance(&found, &expected, &[1.0, 10.0]), 1.0);
        assert_eq!(distance(&found, &[], &[1.0; 2]), f64::INFINITY);
        let lost = [SVector::from([f64::NAN, 1010.0])];
        assert_eq!(distance(&lost, &expected, &[1.0; 2]), f64::INFINITY);
    }
}
