//! What a sweep over all stages of a step does.

use nalgebra::SVector;

use super::Swept;
use crate::step::method::Start;
use crate::step::problem::Problem;
use crate::{Columns, Input, Real, System};

/// Numbers at all nodes but the first, by groups of four.
pub(super) type Nodes<T, const N: usize, const G: usize> = [SVector<<T as Real>::Stages, N>; G];

/// What stays the same over all sweeps of a step. Its functions are written out where they are called, or all of it would go
/// through memory.
pub(super) struct Sweep<T: Real, const N: usize, const M: usize, const S: usize, const G: usize> {
    weights: [[T::Stages; G]; S],
    /// The states at the nodes as far as the slope at the start makes them.
    pub(super) base: Nodes<T, N, G>,
    times: [T::Stages; G],
    inputs: [SVector<T::Stages, M>; G],
}

impl<T: Real, const N: usize, const M: usize, const S: usize, const G: usize> Sweep<T, N, M, S, G> {
    /// Over the step that begins there.
    #[inline(always)]
    pub(super) fn over<A, Y, I, const P: usize>(
        problem: &Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
    ) -> Self
    where
        A: Swept<S, G>,
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut weights = [[T::Stages::whole(start.span.length); G]; S];
        for (weights, of_node) in weights.iter_mut().zip(const { &A::TABLEAU.weights }) {
            for (weight, of_group) in weights.iter_mut().zip(of_node) {
                *weight = scaled::<T>(start.span.length, *of_group);
            }
        }
        let mut base: Nodes<T, N, G> = [start.x.map(T::Stages::whole); G];
        let mut times = [T::Stages::whole(start.span.start); G];
        for group in 0..G {
            for (base, slope) in base[group].iter_mut().zip(start.slope.iter()) {
                *base = weights[0][group].multiply_add(T::Stages::whole(*slope), *base);
            }
            times[group] = T::Stages::from_columns(|place| {
                let node = const { &A::TABLEAU.nodes }[4 * group + place + 1];
                start.span.at(T::from_f64(node))
            });
        }
        Self {
            weights,
            base,
            times,
            inputs: times.map(|times| problem.inputs(times)),
        }
    }

    /// Writes the slopes at the stages.
    #[inline(always)]
    pub(super) fn slopes<Y, I, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        stages: &Nodes<T, N, G>,
        slopes: &mut Nodes<T, N, G>,
    ) where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        for group in 0..G {
            problem.slopes(
                self.times[group],
                &stages[group],
                &self.inputs[group],
                &mut slopes[group],
            );
        }
    }

    /// Writes the states at the stages, from slopes there.
    #[inline(always)]
    pub(super) fn advance(&self, stages: &mut Nodes<T, N, G>, slopes: &Nodes<T, N, G>) {
        advance::<T, N, S, G>(stages, &self.base, &self.weights, slopes);
    }
}

/// Numbers of four stages times one of all.
#[inline]
pub(super) fn scaled<T: Real>(by: T, numbers: [f64; 4]) -> T::Stages {
    T::Stages::whole(by) * T::Stages::from_columns(|stage| T::from_f64(numbers[stage]))
}

/// `base` and the slopes of each state at all nodes but the first, weighted.
#[inline(always)]
pub(super) fn advance<T: Real, const N: usize, const S: usize, const G: usize>(
    stages: &mut Nodes<T, N, G>,
    base: &Nodes<T, N, G>,
    weights: &[[T::Stages; G]; S],
    slopes: &Nodes<T, N, G>,
) {
    for state in 0..N {
        let mut sums = [base[0][state]; G];
        for (sum, base) in sums.iter_mut().zip(base) {
            *sum = base[state];
        }
        let sums = summed::<T, N, S, G, G>(sums, weights, slopes, state);
        for (stages, sum) in stages.iter_mut().zip(sums) {
            stages[state] = sum;
        }
    }
}

/// `sums` and the slopes of a state at all nodes but the first, weighted.
///
/// All sums go on together, so that each slope is spread over a register once, and in two halves, so that fewer additions
/// wait for one another.
#[inline(always)]
pub(super) fn summed<T: Real, const N: usize, const S: usize, const G: usize, const K: usize>(
    mut sums: [T::Stages; K],
    weights: &[[T::Stages; K]; S],
    slopes: &Nodes<T, N, G>,
    state: usize,
) -> [T::Stages; K] {
    let middle = S / 2 + 1;
    let mut late = [T::Stages::from_f64(0.0); K];
    for node in 1..S {
        let slopes = slopes[(node - 1) / 4][state];
        let slope = T::Stages::whole(slopes.as_columns()[(node - 1) % 4]);
        for place in 0..K {
            let weight = weights[node][place];
            if node < middle {
                sums[place] = weight.multiply_add(slope, sums[place]);
            } else if node == middle {
                late[place] = weight * slope;
            } else {
                late[place] = weight.multiply_add(slope, late[place]);
            }
        }
    }
    for (sum, late) in sums.iter_mut().zip(late) {
        *sum += late;
    }
    sums
}

/// What is at one of the nodes but the first.
#[inline(always)]
pub(super) fn at<T: Real, const N: usize, const G: usize>(
    node: usize,
    numbers: &Nodes<T, N, G>,
) -> SVector<T, N> {
    numbers[(node - 1) / 4].map(|it| it.as_columns()[(node - 1) % 4])
}

/// What is at the end.
#[inline(always)]
pub(super) fn last<T: Real, const N: usize, const G: usize>(
    numbers: &Nodes<T, N, G>,
) -> SVector<T, N> {
    at::<T, N, G>(4 * G, numbers)
}
