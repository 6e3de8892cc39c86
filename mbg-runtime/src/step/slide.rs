//! Runs along thresholds at which a motion stays.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::adaptive::Adaptive;
use super::dense::Step;
use super::event::Direction;
use super::method::Estimating;
use super::over::Place;
use super::problem::Problem;
use super::sliding::Sliding;
use super::surfaces::Surfaces;
use super::thresholds::Point;
use super::{Stopped, less, seen};
use crate::{Input, Real, System};

/// How far a run has come.
pub(super) enum Walked<T, const N: usize> {
    /// To the end, with the state there.
    Ended(SVector<T, N>),
    /// The observer has broken off.
    Left,
    /// To a place next to thresholds at which the motion may stay.
    Stays(Place<T, N>, Surfaces<T>),
}

/// Where a run goes on behind a threshold, with when the next may be met, if it does.
type Beyond<T, const N: usize> = ControlFlow<Walked<T, N>, (Point<T, N>, f64)>;

impl<T, S, I, const N: usize, const M: usize, const P: usize> Problem<'_, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    /// Goes over a threshold that is so far ahead, after a step so long has gone over it in vain, unless the motion is said to stay
    /// there.
    pub(super) fn beyond_threshold(
        &mut self,
        here: &Point<T, N>,
        (rest, length, end): (T, f64, T),
        stays: &impl Fn(&mut Self, &Point<T, N>, &Surfaces<T>) -> bool,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Beyond<T, N>, Stopped> {
        let way = ((here.time, here.state), (rest, &here.slope));
        let over = self.over_threshold(way, (length, end), observer)?;
        let ControlFlow::Continue(((time, state), watched)) = over else {
            return Ok(ControlFlow::Break(Walked::Left));
        };
        if !less(time, end) {
            return Ok(ControlFlow::Break(Walked::Ended(state)));
        }
        let slope = self.slope(time, &state);
        let next = Point { time, state, slope };
        if S::HAS_COURSES {
            let passed = self.between(here, &next);
            if passed.count() > 0 && stays(self, &next, &passed) {
                return Ok(ControlFlow::Break(Walked::Stays((time, state), passed)));
            }
        }
        Ok(ControlFlow::Continue((next, watched)))
    }

    /// Whether the motion stays at some of these thresholds.
    #[cold]
    pub(super) fn stays(&mut self, here: &Point<T, N>, surfaces: &Surfaces<T>) -> bool {
        let (mut x, mut memory) = (here.state, self.memory);
        let model = (self.system, self.input);
        let times = (self.since, self.inside, self.whole);
        let place = (here.time, &mut x);
        let known = (&mut memory, &mut self.statistics.evaluations);
        Sliding::settled(model, times, place, *surfaces, known).is_some()
    }
}

impl<Scheme: Estimating> Adaptive<'_, Scheme> {
    /// Goes on from a place next to thresholds that the motion may not leave, along these, until it leaves all or is at the end.
    // Not side by side on the stack with the run that has come there.
    #[inline(never)]
    pub(super) fn slide<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (mut here, end): (Place<T, N>, T),
        mut surfaces: Surfaces<T>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Place<T, N>>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        while less(here.0, end) {
            let model = (problem.system, problem.input);
            let times = (problem.since, problem.inside, problem.whole);
            let mut memory = problem.memory;
            let (t, x) = (here.0, &mut here.1);
            let known = (&mut memory, &mut problem.statistics.evaluations);
            let Some(sliding) = Sliding::settled(model, times, (t, x), surfaces, known) else {
                break;
            };
            surfaces = sliding.surfaces;
            let mut along = problem.of(&sliding);
            let (mut left, mut undone) = (None, 0);
            let walked = self.walk(&mut along, (here, end), |_, _, _| true, &mut |step| {
                let hold = |t: T, x: &SVector<T, N>, memory: S::Memory| {
                    sliding.hold(t, x, &mut { memory })
                };
                let (start, memory) = ((step.start(), *step.first()), step.memory());
                let holds = less(T::from_f64(0.0), hold(start.0, &start.1, memory));
                if !holds {
                    (left, undone) = (Some(start), 1);
                    return ControlFlow::Break(());
                }
                let crossing = step.crossing(Direction::Falling, |t, x| hold(t, x, memory));
                if let Some(time) = crossing {
                    let there = sliding.landed(time, &step.at(time), &memory);
                    step.cut(time, there);
                    left = Some((time, there));
                }
                step.surfaces = Some(surfaces);
                sliding.heed(seen(step.end() - step.start()));
                match observer(step) {
                    ControlFlow::Continue(()) if left.is_some() => ControlFlow::Break(()),
                    ControlFlow::Break(()) => {
                        left = None;
                        ControlFlow::Break(())
                    }
                    goes_on => goes_on,
                }
            })?;
            (problem.statistics, problem.memory) = (along.statistics, along.memory);
            (problem.probes, problem.conditioning) = (along.probes, along.conditioning);
            problem.statistics.evaluations += sliding.evaluations.get();
            problem.statistics.steps -= undone;
            problem.statistics.rejected += undone;
            match (walked, left) {
                (Walked::Ended(x), _) => here = (end, x),
                (Walked::Stays(place, others), _) => {
                    here = place;
                    others.iter().for_each(|other| surfaces.add(*other));
                }
                (Walked::Left, Some(place)) => here = place,
                (Walked::Left, None) => return Ok(ControlFlow::Break(())),
            }
        }
        Ok(ControlFlow::Continue(here))
    }
}
