//! Bounded solves of nonlinear algebraic loops, and what a model remembers of them.

use nalgebra::{SMatrix, SVector};

use super::flags::Flags;
use super::newton::Found;
use crate::Real;

/// What a model keeps from one evaluation to the next; `()` for a model without bounded solves.
pub trait Memory: Copy + Default {
    /// Number of the first loop whose last solve did not converge, in the order of solution, and its residual.
    fn unsolved(&self) -> Option<(usize, f64)> {
        None
    }
}

impl Memory for () {}

/// How often a solve goes on at most from where it ended.
const FURTHER: usize = 2;

/// How the last solve of a loop ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// What is left, scaled.
    pub residual: f64,
    /// Evaluations of residual and Jacobian that it took.
    pub iterations: usize,
    /// Whether nothing but rounding is left.
    pub converged: bool,
}

/// Memory of a model with nonlinear algebraic loops: the unknowns of all of them, where the next solve begins, and how
/// the last solve of each ended.
///
/// A solve begins where the last one ended, at first at zero. If it fails, it begins again at zero and then at one,
/// where a law whose slope at zero is infinite has a finite one. A solve that fails all the same gives NaN, so that no
/// result can be mistaken for a solution, and leaves the start as it was. Of several lanes each is solved for itself, and those
/// that fail are NaN alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopMemory<T, const LOOPS: usize, const UNKNOWNS: usize> {
    unknowns: [T; UNKNOWNS],
    outcomes: [Outcome; LOOPS],
}

impl<T, const LOOPS: usize, const UNKNOWNS: usize> LoopMemory<T, LOOPS, UNKNOWNS> {
    /// How the last solve of each loop ended, in the order of solution.
    #[must_use]
    pub fn outcomes(&self) -> &[Outcome; LOOPS] {
        &self.outcomes
    }

    /// The same with other scalars; generated code calls it.
    #[doc(hidden)]
    pub fn map<U>(self, scalar: impl FnMut(T) -> U) -> LoopMemory<U, LOOPS, UNKNOWNS> {
        LoopMemory {
            unknowns: self.unknowns.map(scalar),
            outcomes: self.outcomes,
        }
    }
}

impl<T: Real, const LOOPS: usize, const UNKNOWNS: usize> Default
    for LoopMemory<T, LOOPS, UNKNOWNS>
{
    fn default() -> Self {
        let nothing = Outcome {
            residual: 0.0,
            iterations: 0,
            converged: true,
        };
        Self {
            unknowns: [T::from_f64(0.0); UNKNOWNS],
            outcomes: [nothing; LOOPS],
        }
    }
}

impl<T: Real, const LOOPS: usize, const UNKNOWNS: usize> Memory for LoopMemory<T, LOOPS, UNKNOWNS> {
    fn unsolved(&self) -> Option<(usize, f64)> {
        let failed = |(number, outcome): (usize, &Outcome)| {
            (!outcome.converged).then_some((number, outcome.residual))
        };
        self.outcomes.iter().enumerate().find_map(failed)
    }
}

impl<T: Real, const LOOPS: usize, const UNKNOWNS: usize> LoopMemory<T, LOOPS, UNKNOWNS> {
    /// Solves loop `number`, whose `K` unknowns begin at `first`; generated code calls it.
    #[doc(hidden)]
    pub fn solve<const K: usize>(
        &mut self,
        number: usize,
        first: usize,
        evaluate: impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) -> SVector<T, K> {
        let zero = SVector::<T, K>::from_element(T::from_f64(0.0));
        let mut start = zero;
        let last = self.unknowns.iter().skip(first);
        start
            .as_mut_slice()
            .iter_mut()
            .zip(last)
            .for_each(|(z, last)| *z = *last);
        let mut found = Found::nothing(start);
        found.attempt(start, Flags::all(), &evaluate);
        if !found.converged.and(found.settled).everywhere() {
            again(&mut found, start, &evaluate);
        }
        let converged = found.converged;
        if let Some(outcome) = self.outcomes.get_mut(number) {
            *outcome = Outcome {
                residual: found.residual.magnitude(),
                iterations: found.iterations,
                converged: converged.everywhere(),
            };
        }
        let next = self.unknowns.iter_mut().skip(first);
        next.zip(found.solution.as_slice())
            .for_each(|(next, z)| *next = converged.choose(*z, *next));
        if converged.everywhere() {
            return found.solution;
        }
        let nan = T::from_f64(f64::NAN);
        found.solution.map(|z| converged.choose(z, z * nan))
    }
}

/// Further attempts where the first one did not do: from zero, from one, and from where it ended.
#[cold]
#[inline(never)]
fn again<T: Real, const K: usize>(
    found: &mut Found<T, K>,
    start: SVector<T, K>,
    evaluate: &impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
) {
    let [zero, one] = [0.0, 1.0].map(|number| start.map(|_| T::from_f64(number)));
    for other in [zero, one] {
        if !found.converged.everywhere() && other != start {
            found.attempt(other, found.converged.not(), evaluate);
        }
    }
    // Where it ended it may be near; and a solution beside which values on the way were far larger is none yet.
    for _ in 0..FURTHER {
        let sure = found.converged.and(found.settled);
        if !sure.everywhere() {
            found.attempt(found.solution, sure.not(), evaluate);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::lanes::Pair;

    fn root(of: f64, memory: &mut LoopMemory<f64, 2, 3>) -> SVector<f64, 1> {
        memory.solve(1, 2, |z: &SVector<f64, 1>| {
            (
                SVector::from([z[0] * z[0] * z[0] + z[0] - of]),
                SMatrix::from([[3.0 * z[0] * z[0] + 1.0]]),
            )
        })
    }

    #[test]
    fn next_solve_begins_where_the_last_one_ended() {
        let mut memory = LoopMemory::default();
        assert!(f64::abs(root(10.0, &mut memory)[0] - 2.0) < 1e-15);
        let cold = memory.outcomes()[1].iterations;
        root(10.01, &mut memory);
        assert!(memory.outcomes()[1].iterations < cold);
        assert_eq!(memory.outcomes()[0].iterations, 0);
        assert_eq!(memory.unsolved(), None);
    }

    #[test]
    fn failure_gives_nan_and_is_remembered() {
        let mut memory = LoopMemory::default();
        root(10.0, &mut memory);
        let before = memory.unknowns;
        assert!(root(f64::NAN, &mut memory)[0].is_nan());
        assert!(matches!(memory.unsolved(), Some((1, _))));
        assert_eq!(memory.unknowns, before);
        root(10.0, &mut memory);
        assert_eq!(memory.unsolved(), None);
    }

    #[test]
    fn a_lane_that_fails_leaves_the_others_their_solutions() {
        let mut memory = LoopMemory::<Pair, 1, 1>::default();
        let mut root = |of| {
            let found = memory.solve(0, 0, |z: &SVector<Pair, 1>| {
                let square = z[0] * z[0];
                (
                    SVector::from([square * z[0] + z[0] - Pair(of)]),
                    SMatrix::from([[square + square + square + Pair([1.0; 2])]]),
                )
            });
            (found[0].0, memory.unsolved(), memory.unknowns[0].0)
        };
        root([10.0, 2.0]);
        let (found, unsolved, start) = root([f64::NAN, 30.0]);
        assert!(found[0].is_nan() && (found[1] - 3.0).abs() < 1e-15);
        assert!(unsolved.is_some());
        assert!((start[0] - 2.0).abs() < 1e-15 && start[1] == found[1]);
        let (found, unsolved, _) = root([2.0, 10.0]);
        assert!((found[0] - 1.0).abs() < 1e-15 && (found[1] - 2.0).abs() < 1e-15);
        assert_eq!(unsolved, None);
    }
}
