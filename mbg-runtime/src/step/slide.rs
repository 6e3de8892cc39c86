//! Runs along thresholds at which a motion stays.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::Step;
use super::event::Direction;
use super::method::Span;
use super::over::Place;
use super::problem::Problem;
use super::sliding::{Room, Rooms, Sliding};
use super::surfaces::{AnySurfaces, Surfaces, SurfacesOf, is_later};
use super::thresholds::Point;
use super::tolerance::Tolerance;
use super::{Cause, Stopped, less, seen};
use crate::{Input, Real, System};

/// How far a run has come.
pub(super) enum Walked<T, Surfaces, const N: usize> {
    /// To the end, with the state there.
    Ended(SVector<T, N>),
    /// The observer has broken off.
    Left,
    /// To a place next to thresholds at which the motion may stay.
    Stays(Place<T, N>, Surfaces),
}

/// How far a run over a system has come.
pub(super) type WalkedOf<T, S, const N: usize, const M: usize, const P: usize> =
    Walked<T, SurfacesOf<T, S, N, M, P>, N>;

/// At which thresholds a walk ends: at none unless it is told, but for those at which it comes to rest.
pub(super) trait Ends<T, S, I: ?Sized, const N: usize, const M: usize, const P: usize>:
    Copy
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M>,
{
    /// Whether it ends at those at which the motion comes to rest.
    const RESTS: bool = true;

    /// Whether those count at which no law jumps.
    fn are_all(self) -> bool {
        false
    }

    /// Of those between two points next to each other.
    fn between(
        self,
        _problem: &mut Problem<'_, T, S, I, N, M, P>,
        _points: [&Point<T, N>; 2],
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        None
    }

    /// Of those at which a point is, as far as numbers tell.
    fn at(
        self,
        _problem: &mut Problem<'_, T, S, I, N, M, P>,
        _here: &Point<T, N>,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        None
    }

    /// Of those at which a point is, where none that was come near to is ahead any more.
    fn behind(
        self,
        _problem: &mut Problem<'_, T, S, I, N, M, P>,
        _here: &Point<T, N>,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        None
    }

    /// Goes on to those at which the motion comes to rest within a step so long, and a tolerance.
    fn rest(
        self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        here: &Point<T, N>,
        way: (f64, T, &Tolerance<N>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Option<WalkedOf<T, S, N, M, P>>, Stopped> {
        match Self::RESTS {
            true => problem.come_to_rest(here, way, observer),
            false => Ok(None),
        }
    }
}

/// At none.
#[derive(Clone, Copy)]
pub(super) struct Nowhere;

impl<T, S, I, const N: usize, const M: usize, const P: usize> Ends<T, S, I, N, M, P> for Nowhere
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    const RESTS: bool = false;
}

/// At those at which the motion stays.
#[derive(Clone, Copy)]
pub(super) struct WhereItStays;

impl<T, S, I, const N: usize, const M: usize, const P: usize> Ends<T, S, I, N, M, P>
    for WhereItStays
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    fn between(
        self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        [from, to]: [&Point<T, N>; 2],
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        let passed = problem.met_between(from, to);
        passed.filter(|passed| problem.stays(to, *passed))
    }

    fn at(
        self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        here: &Point<T, N>,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        let met = problem.next_to(here);
        met.filter(|met| problem.stays(here, *met))
    }
}

/// At all that it meets. Beside thresholds at which a motion stays laws are asked a little off it: what it comes to is to be found
/// with these.
#[derive(Clone, Copy)]
pub(super) struct WhereItMeetsOne;

impl<T, S, I, const N: usize, const M: usize, const P: usize> Ends<T, S, I, N, M, P>
    for WhereItMeetsOne
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    // What a motion stays at may jump there.
    fn are_all(self) -> bool {
        true
    }

    fn between(
        self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        [from, to]: [&Point<T, N>; 2],
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        problem.between(from, to)
    }

    fn behind(
        self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        here: &Point<T, N>,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        problem.next_to(here)
    }
}

/// At those at which the motion of a lane stays: none of them is told, since others go on.
#[derive(Clone, Copy)]
pub(super) struct WhereALaneStays;

impl<T, S, I, const N: usize, const M: usize, const P: usize> Ends<T, S, I, N, M, P>
    for WhereALaneStays
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    const RESTS: bool = false;

    fn between(
        self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        [from, to]: [&Point<T, N>; 2],
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        let mut is_led_back = false;
        problem.courses(from, to, |course, _| is_led_back |= course.is_led_back());
        is_led_back.then(AnySurfaces::none)
    }
}

/// Where a run goes on behind a threshold, with when the next may be met, if it does.
type Beyond<T, S, const N: usize, const M: usize, const P: usize> =
    ControlFlow<WalkedOf<T, S, N, M, P>, (Point<T, N>, f64)>;

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
        ends: impl Ends<T, S, I, N, M, P>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Beyond<T, S, N, M, P>, Stopped> {
        let way = ((here.time, here.state), (rest, &here.slope));
        let over = self.over_threshold(way, (length, end), observer)?;
        let ControlFlow::Continue(((time, state), watched)) = over else {
            return Ok(ControlFlow::Break(Walked::Left));
        };
        if !less(time, end) {
            return Ok(ControlFlow::Break(Walked::Ended(state)));
        }
        let next = self.point((time, state));
        if S::HAS_COURSES
            && let Some(passed) = ends.between(self, [here, &next])
        {
            return Ok(ControlFlow::Break(Walked::Stays((time, state), passed)));
        }
        Ok(ControlFlow::Continue((next, watched)))
    }

    /// Goes on to thresholds that a step so long comes to and at which the motion stays, if what is left of the way is within what a
    /// tolerance allows: where laws have no slope there, such as roots, steps are held up beside them without end.
    #[cold]
    #[inline(never)]
    fn come_to_rest(
        &mut self,
        here: &Point<T, N>,
        (length, end, tolerance): (f64, T, &Tolerance<N>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Option<WalkedOf<T, S, N, M, P>>, Stopped> {
        let near = if S::HAS_COURSES {
            self.ahead(here, length)
        } else {
            None
        };
        let Some(near) = near else {
            return Ok(None);
        };
        let mut memory = self.memory;
        let (model, times) = (
            (self.system, self.input),
            (self.since, self.inside, self.whole),
        );
        let known = (&mut memory, &mut self.statistics.evaluations);
        let measure = tolerance.around(&here.state);
        let near = (near.as_slice(), &measure);
        let Some(rest) = S::Room::rest(model, times, here, near, known) else {
            return Ok(None);
        };
        let until = here.time + T::from_f64(rest.ahead);
        if !is_later(here.time, until) || !less(until, end) {
            return Ok(Some(Walked::Stays((here.time, rest.state), rest.surfaces)));
        }
        let span = Span {
            start: here.time,
            end: until,
            length: until - here.time,
        };
        let change = rest.state - here.state;
        let slope = self.slope(until, &rest.state);
        Ok(Some(
            match self.straight_step((span, here.state), (change, slope), observer)? {
                ControlFlow::Continue(place) => Walked::Stays(place, rest.surfaces),
                ControlFlow::Break(()) => Walked::Left,
            },
        ))
    }

    /// Whether the motion stays at some of these thresholds.
    #[cold]
    fn stays(&mut self, here: &Point<T, N>, surfaces: SurfacesOf<T, S, N, M, P>) -> bool {
        let (mut x, mut memory) = (here.state, self.memory);
        let model = (self.system, self.input);
        let times = (self.since, self.inside, self.whole);
        let place = (here.time, &mut x);
        let known = (&mut memory, &mut self.statistics.evaluations);
        S::Room::stays(model, times, place, surfaces, known)
    }
}

/// So often a motion is settled anew at one time: more is without end.
const SETTLED: u32 = 256;

/// How often a run has been settled since time has gone on.
pub(super) struct Settled<T> {
    time: T,
    count: u32,
}

impl<T: Real> Settled<T> {
    /// Once more, unless that is without end.
    fn again(&mut self, time: T) -> Result<(), Stopped> {
        (self.time, self.count) = match is_later(self.time, time) {
            true => (time, 0),
            false => (self.time, self.count + 1),
        };
        match self.count > SETTLED {
            true => Err(Stopped::new(time, Cause::StepTooSmall)),
            false => Ok(()),
        }
    }
}

/// What takes steps over a piece of the input.
pub(super) trait Walk<T: Real, const N: usize> {
    /// Whether a threshold may be left and met again within a step.
    const LOOKS_WITHIN: bool;

    /// Runs to the end of the piece, or as far as to thresholds at which walks end.
    fn walk<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        place_and_end: (Place<T, N>, T),
        ends: impl Ends<T, S, I, N, M, P>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<WalkedOf<T, S, N, M, P>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized;

    /// Runs over the piece, also along thresholds.
    fn over_piece<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (mut here, end): (Place<T, N>, T),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), SVector<T, N>>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut surfaces = match S::HAS_COURSES {
            true => problem.at_start(here),
            false => None,
        };
        let (time, count) = (here.0, 0);
        let mut settled = Settled { time, count };
        loop {
            if S::HAS_COURSES
                && let Some(surfaces) = surfaces
            {
                let known = (surfaces, &mut settled);
                match S::Room::slide(self, problem, (here, end), known, observer)? {
                    ControlFlow::Continue(place) => here = place,
                    ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
                }
                if !less(here.0, end) {
                    return Ok(ControlFlow::Continue(here.1));
                }
            }
            match self.walk(problem, (here, end), WhereItStays, observer)? {
                Walked::Ended(x) => return Ok(ControlFlow::Continue(x)),
                Walked::Left => return Ok(ControlFlow::Break(())),
                Walked::Stays(place, others) => (here, surfaces) = (place, Some(others)),
            }
        }
    }

    /// Goes on from a place next to thresholds that the motion may not leave, along these, until it leaves all or is at the end.
    // Not side by side on the stack with the run that has come there.
    #[inline(never)]
    fn slide<S, I, const M: usize, const P: usize, const K: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (mut here, end): (Place<T, N>, T),
        (mut surfaces, settled): (Surfaces<T, K>, &mut Settled<T>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Place<T, N>>, Stopped>
    where
        S: System<T, N, M, P, Room = Room<K>>,
        I: Input<T, M> + ?Sized,
    {
        while less(here.0, end) {
            settled.again(here.0)?;
            let model = (problem.system, problem.input);
            let times = (problem.since, problem.inside, problem.whole);
            let mut memory = problem.memory;
            let (t, x) = (here.0, &mut here.1);
            let known = (&mut memory, &mut problem.statistics.evaluations);
            let Some(sliding) = Sliding::settled(model, times, (t, x), surfaces, known) else {
                break;
            };
            let asked = core::mem::replace(&mut surfaces, sliding.all());
            let hold =
                |t: T, x: &SVector<T, N>, memory: S::Memory| sliding.hold(t, x, &mut { memory });
            let holds = |(t, x): Place<T, N>, memory| less(T::from_f64(0.0), hold(t, &x, memory));
            if !holds(here, memory) {
                problem.statistics.evaluations += sliding.evaluations.get();
                surfaces = problem.also_at_start(here, surfaces);
                continue;
            }
            let (mut along, mut left) = (problem.of(&sliding), None);
            let walked = self.walk(&mut along, (here, end), WhereItMeetsOne, &mut |step| {
                let (memory, end) = (step.memory(), (step.end(), *step.state()));
                // Behind a threshold that is met the motion may be elsewhere.
                if !step.is_over
                    && (Self::LOOKS_WITHIN || !holds(end, memory))
                    && let Some(time) = step.crossing(Direction::Falling, |t, x| hold(t, x, memory))
                {
                    let there = sliding.landed(time, &step.at(time), &memory);
                    step.cut(time, there);
                    left = Some((time, there));
                }
                let length = seen(step.end() - step.start());
                let goes_on = step.along(surfaces.as_slice(), &mut *observer);
                sliding.heed(length);
                match goes_on {
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
            match (walked, left) {
                (Walked::Ended(x), _) => here = (end, x),
                (Walked::Stays(place, others), _) => {
                    let is_news = others.without(asked.as_slice()).count() > 0;
                    let goes_on = is_news || less(here.0, place.0);
                    here = place;
                    // With those that are at their thresholds because these are.
                    surfaces = problem.also_at_start(place, surfaces.with(others.as_slice()));
                    if !goes_on {
                        break;
                    }
                }
                (Walked::Left, Some(place)) => {
                    surfaces = problem.also_at_start(place, surfaces);
                    here = place;
                }
                (Walked::Left, None) => return Ok(ControlFlow::Break(())),
            }
        }
        Ok(ControlFlow::Continue(here))
    }
}
