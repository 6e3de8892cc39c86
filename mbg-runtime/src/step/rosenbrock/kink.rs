//! Parts of steps of constant length across kinks of stiff laws.
//!
//! Where a diode beside a coil begins to block, the stages of a method that linearises at the start of its step are those of a
//! law that the other side of the kink does not have. It lands on the wrong side again and again, and short steps follow short
//! steps. Euler's implicit method, solved to the end, knows the law where it arrives.

use nalgebra::SVector;

use super::{Stages, Tabulated};
use crate::step::method::{Span, Start};
use crate::step::problem::Problem;
use crate::{Input, Real, System};

/// Newton's method is given up after so many sweeps.
const SWEEPS: u32 = 8;
/// A state is found when a sweep moves it by so small a part of what states have been and become.
const FOUND: f64 = 1e-6;
/// What a sweep leaves of the equations is less than this part of what it found.
const SHRINKS: f64 = 0.5;
/// One step and two of half its length may be apart by so large a part of it.
const APART: f64 = 1e-3;

impl<A: Tabulated<S>, T: Real, const N: usize, const S: usize> Stages<A, T, N, S> {
    /// What two steps of half the length add to the state, where one of the whole length agrees with them. A whole step of the
    /// grid is halved first, which may be all that it needs.
    pub(super) fn across<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
    ) -> Option<SVector<T, N>>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if !start.is_part {
            return None;
        }
        self.is_across = true;
        let whole = self.euler(problem, &start.span, &start.x)?;
        let mut end = start.x;
        for half in start.span.halves() {
            end = self.euler(problem, &half, &end)?;
        }
        let apart = self
            .sizes
            .between(&start.x, &(end - start.x))
            .norm(&(end - whole));
        (apart < APART).then(|| end - start.x)
    }

    /// The state behind a step of Euler's implicit method.
    fn euler<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        span: &Span<T>,
        x: &SVector<T, N>,
    ) -> Option<SVector<T, N>>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let one = T::from_f64(1.0);
        let inverse = one / span.length;
        let memory = problem.memory;
        let mut end = *x;
        let [mut moved, mut found] = [f64::INFINITY; 2];
        for _ in 0..=SWEEPS {
            // Loops go on from the start, not from where a sweep strayed to.
            problem.memory = memory;
            let slope = problem.slope(span.end, &end);
            let lacking = slope.zip_zip_map(&end, x, |slope, end, x| slope - inverse * (end - x));
            let measure = self.sizes.between(x, &(end - x));
            let left = measure.norm(&lacking.map(|lacking| span.length * lacking));
            // Where the slope is far steeper than what follows sweeps are short that leave as much as they found.
            if moved < FOUND && (left < FOUND || left < SHRINKS * found) {
                return Some(end);
            }
            problem.jacobian((span.end, &end), Some(span.length), &mut self.jacobian);
            problem.statistics.factorisations += 1;
            self.factors
                .factorise::<Y, M, P>(inverse, one, &self.jacobian);
            let change = self.factors.solved::<Y, M, P>(&lacking);
            end += change;
            (moved, found) = (measure.norm(&change), left);
        }
        None
    }
}
