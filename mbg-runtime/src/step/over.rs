//! A step straight over a threshold of the laws, from next to it.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::{Part, Polynomial, Step};
use super::method::{Span, Start, along};
use super::problem::Problem;
use super::thresholds::Point;
use super::{Stopped, less, seen};
use crate::course::sooner;
use crate::{Input, Real, System};

/// How near a threshold is looked for, in lengths of the step that went over it.
const NARROW: f64 = 1e-9;
/// What is left of the way to it is as good as straight where it is no more than so many times as near.
const STRAIGHT: f64 = 10.0;
/// Times are apart by so many units of the last place.
const PLACES: f64 = 8.0;
/// What is met so soon again, in ways beyond it, is one on which the motion stays.
pub(super) const SOON: f64 = 1e3;
/// So often the way beyond it is doubled.
const DOUBLINGS: u32 = 100;

/// A state at a time.
pub(super) type Place<T, const N: usize> = (T, SVector<T, N>);

/// The ends of a straight line.
pub(super) fn straight<T: Real, const N: usize>(
    from: &Place<T, N>,
    slope: &SVector<T, N>,
    way: T,
) -> [Point<T, N>; 2] {
    let to = (from.0 + way, along(&from.1, way, slope));
    [*from, to].map(|(time, state)| Point {
        time,
        state,
        slope: *slope,
    })
}

impl<'a, T, S, I, const N: usize, const M: usize, const P: usize> Problem<'a, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    /// How long behind a place the first threshold between it and another one is passed, if one is, by how states change from one
    /// to the other.
    pub(super) fn reached(&self, from: &Place<T, N>, to: &Place<T, N>) -> Option<T> {
        let slope = (to.1 - from.1).map(|change| change / (to.0 - from.0));
        self.reached_with(from, to, &slope)
    }

    /// How long a straight line goes on from a place to a threshold, within the length of a step; how arguments bend along it is minded,
    /// as that of a slip whose direction turns.
    pub(super) fn straight_to_threshold(
        &self,
        from: &Place<T, N>,
        slope: &SVector<T, N>,
        length: f64,
    ) -> Option<f64> {
        let [from, to] = straight(from, slope, T::from_f64(length));
        self.soonest(&from, &to, |course, lasting| course.within(lasting))
    }

    /// Whether a step begins beside a threshold, where a law may be a root.
    pub(super) fn begins_beside(&self, start: &Start<T, N>) -> bool {
        let Start { span, x, slope, .. } = start;
        let [from, to] = straight(&(span.start, *x), slope, span.length);
        let mut is_beside = false;
        self.courses(&from, &to, |course, lasting| {
            is_beside |= course.begins_beside(lasting);
        });
        is_beside
    }

    /// Whether an argument of choices hardly moves within a step that goes on as fast at its end.
    pub(super) fn is_held(
        &self,
        start: &Start<T, N>,
        (end, slope): (&SVector<T, N>, &SVector<T, N>),
    ) -> bool {
        let Start { span, x, .. } = start;
        let ends = [(span.start, *x, start.slope), (span.end, *end, *slope)];
        let [from, to] = ends.map(|(time, state, slope)| Point { time, state, slope });
        let mut is_held = false;
        self.courses(&from, &to, |course, lasting| {
            is_held |= course.is_held(lasting);
        });
        is_held
    }

    pub(super) fn reached_with(
        &self,
        from: &Place<T, N>,
        to: &Place<T, N>,
        slope: &SVector<T, N>,
    ) -> Option<T> {
        let [from, to] = [from, to].map(|it| Point {
            time: it.0,
            state: it.1,
            slope: *slope,
        });
        let mut first: Option<T> = None;
        self.courses(&from, &to, |course, lasting| {
            let times = [first, course.reached(lasting)].into_iter().flatten();
            first = times.reduce(sooner);
        });
        first
    }

    /// How long it is to a threshold that a step so long has gone over, if that is next to a place: the way there is as good as straight.
    pub(super) fn next_threshold(
        &self,
        from: &Place<T, N>,
        slope: &SVector<T, N>,
        length: f64,
    ) -> Option<T> {
        let next = T::from_f64(STRAIGHT * self.apart(from.0, length));
        let to = (from.0 + next, along(&from.1, next, slope));
        self.reached_with(from, &to, slope)
    }

    /// How far apart times within a step so long are told from each other.
    pub(super) fn apart(&self, t: T, length: f64) -> f64 {
        (NARROW * length).max(PLACES * T::EPSILON * t.magnitude())
    }

    /// How far a straight line goes on behind a threshold, which a step so long has passed, until it is passed in numbers, too.
    pub(super) fn beyond(
        &self,
        from: &Place<T, N>,
        length: f64,
        (rest, slope): (T, &SVector<T, N>),
    ) -> f64 {
        let beyond = PLACES * T::EPSILON * from.0.magnitude().max(length);
        let [two, mut beyond] = [2.0, beyond].map(T::Lane::from_f64);
        for _ in 0..DOUBLINGS {
            let way = rest + T::from_lane(beyond);
            let to = (from.0 + way, along(&from.1, way, slope));
            if self.reached_with(from, &to, slope).is_some() {
                break;
            }
            beyond = two * beyond;
        }
        beyond.into()
    }

    /// A step straight over a threshold that is so far ahead, if there is time left, and over which one so long was refused; and
    /// where it leads, with when the next may be met: what is met again before is one on which the motion stays.
    pub(super) fn over_threshold(
        &mut self,
        (here, (rest, slope)): (Place<T, N>, (T, &SVector<T, N>)),
        (length, end): (f64, T),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), (Place<T, N>, f64)>, Stopped> {
        let beyond = self.beyond(&here, length, (rest, slope));
        let watched = seen(here.0 + rest) + SOON * beyond;
        if !less(here.0 + rest, end) {
            return Ok(ControlFlow::Continue((here, watched)));
        }
        Ok(
            match self.cross(here, (rest, beyond, slope), end, observer)? {
                ControlFlow::Continue(next) => ControlFlow::Continue((next, watched)),
                ControlFlow::Break(()) => ControlFlow::Break(()),
            },
        )
    }

    /// A step straight over a jump that is so far ahead, and so far beyond it, if there is so much time left; and where it leads.
    fn cross(
        &mut self,
        (start, x): Place<T, N>,
        (rest, beyond, slope): (T, f64, &SVector<T, N>),
        end: T,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Place<T, N>>, Stopped> {
        let way = rest + T::from_f64(beyond);
        let mut change = slope.map(|slope| way * slope);
        let mut ahead = self.slope(start + way, &(x + change));
        let (mut until, mut length) = (start + way, way);
        if !less(until, end) {
            // It stays beyond the threshold, by rounding; what is left of the time changes with when the jump is.
            (until, length) = (end, end - start);
            let left = length - rest;
            change = along(&change, left - T::from_f64(seen(left)), &ahead);
            ahead = self.slope(end, &(x + change));
        }
        let end = until;
        self.straight_step((Span { start, end, length }, x), (change, ahead), observer)
    }

    /// A step along a line to a threshold, or over it, with the derivative at its end.
    pub(super) fn straight_step(
        &mut self,
        (span, x): (Span<T>, SVector<T, N>),
        (change, ahead): (SVector<T, N>, SVector<T, N>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Place<T, N>>, Stopped> {
        // So short a way opens no loop. What a motion stays at may be elsewhere behind the threshold: it is not brought there.
        let (end, next) = (span.end, x + change);
        self.statistics.steps += 1;
        self.check(end, &next, &ahead)?;
        // Of the change itself: beside the state it may be little more than rounding.
        let mut line = |_| Part::whole(Polynomial::straight(&x, change));
        let mut step = Step::new(span, (x, next), self.memory, &mut line);
        step.is_over = true;
        Ok(match observer(&mut step) {
            ControlFlow::Continue(()) => ControlFlow::Continue((end, next)),
            ControlFlow::Break(()) => ControlFlow::Break(()),
        })
    }
}
