//! What lies between the ends of a step, which slopes at the nodes alone tell less exactly than they tell the ends.

use nalgebra::SVector;

use super::sweep::{Sweep, last};
use super::{Slopes, Stages, Swept};
use crate::step::dense::{Part, Polynomial};
use crate::step::method::{Span, Start};
use crate::step::problem::Problem;
use crate::step::tolerance::Tolerance;
use crate::{Input, Real, System};

/// The most parts of a step.
const MOST: u32 = 16;

/// A change from sweep to sweep that is as good as none, in tolerances.
const SETTLED: f64 = 0.1;

impl<A, T, const N: usize, const S: usize, const G: usize> Stages<A, T, N, S, G>
where
    A: Swept<S, G>,
    T: Real,
{
    /// The polynomial over the step that was tried last, or over a part of it with this place.
    ///
    /// The ends are of twice the order of what is in between. Parts are so short that the polynomial over each is as exact, and
    /// begin and end with steps of the method.
    pub(super) fn part_at<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (start, end): (&Start<T, N>, &SVector<T, N>),
        tolerance: &Tolerance<N>,
        place: f64,
    ) -> Part<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let memory = problem.memory;
        let whole = Self::between(self.tried(), start, end);
        let count = Self::parts(problem, (start, end), &whole, tolerance);
        let part = if count == 1 {
            Part::whole(whole)
        } else {
            let number = (place * f64::from(count)).max(0.0) as u32;
            let number = number.min(count - 1);
            let from = self.part_way(problem, start, [number, count], tolerance);
            let (slopes, x) = self.over(problem, start, &from, tolerance);
            let end = if number + 1 == count { end } else { &x };
            let length = 1.0 / f64::from(count);
            let polynomial = Self::between(&slopes, &from, end);
            Part::of(polynomial, f64::from(number) * length, length)
        };
        problem.memory = memory;
        part
    }

    /// Of how many parts each has a polynomial that is within the tolerance.
    fn parts<Y, I, const M: usize, const P: usize>(
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (start, end): (&Start<T, N>, &SVector<T, N>),
        polynomial: &Polynomial<T, N>,
        tolerance: &Tolerance<N>,
    ) -> u32
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        // Slopes are met at the nodes, and missed most between those in the middle.
        let nodes = const { &A::TABLEAU.nodes };
        let place = T::from_f64(0.5 * (nodes[S / 2] + nodes[S / 2 + 1]));
        let missed = problem.missed(start, polynomial, place);
        let measure = tolerance.between(&start.x, &(end - start.x));
        let mut error = measure.norm(&missed) / S as f64;
        let mut count = 1;
        while error > 1.0 && count < MOST {
            count *= 2;
            error /= f64::from(2_u32.pow(S as u32 + 1));
        }
        count
    }

    /// The start of a part, counted from zero, of so many.
    fn part_way<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        [number, count]: [u32; 2],
        tolerance: &Tolerance<N>,
    ) -> Start<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let place = |number: u32| T::from_f64(f64::from(number) / f64::from(count));
        let span = |from: u32, to: u32| Span {
            start: start.span.at(place(from)),
            end: start.span.at(place(to)),
            length: place(to - from) * start.span.length,
        };
        let (mut x, mut slope) = (start.x, start.slope);
        if number > 0 {
            let before = Start {
                span: span(0, number),
                ..*start
            };
            (_, x) = self.over(problem, start, &before, tolerance);
            slope = problem.slope(before.span.end, &x);
        }
        Start {
            span: span(number, number + 1),
            x,
            slope,
            ..*start
        }
    }

    /// The slopes of a step over a part of the one that was tried last from `start`, and the state at its end.
    fn over<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        part: &Start<T, N>,
        tolerance: &Tolerance<N>,
    ) -> (Slopes<T, N, G>, SVector<T, N>)
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let memory = problem.memory;
        let whole = self.tried();
        let mut slopes = Slopes {
            length: part.span.length,
            first: part.slope,
            others: whole.others,
        };
        let ahead = (part.span.start - start.span.start) / whole.length;
        Self::predict(whole, ahead, &mut slopes);
        let sweep = Sweep::over::<A, _, _, P>(problem, part);
        let mut stages = sweep.base;
        sweep.advance(&mut stages, &slopes.others);
        let mut end = last::<T, N, G>(&stages);
        let measure = tolerance.between(&part.x, &(end - part.x));
        for _ in 0..A::SWEEPS[0] {
            problem.memory = memory;
            sweep.slopes(problem, &stages, &mut slopes.others);
            sweep.advance(&mut stages, &slopes.others);
            let change = last::<T, N, G>(&stages) - end;
            end += change;
            if measure.norm(&change) <= SETTLED {
                break;
            }
        }
        (slopes, end)
    }
}
