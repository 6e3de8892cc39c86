//! Runs with slopes across thresholds at which a law jumps: a step ends there.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::{Polynomial, Step};
use super::integrator::Integrator;
use super::method::{Span, along};
use super::problem::Problem;
use super::{Stopped, less, seen};
use crate::course::sooner;
use crate::{Input, Real, System};

/// How near a jump is looked for, in lengths of the step that went over it.
const NARROW: f64 = 1e-9;
/// The part of the way to a jump that steps go; the rest of it is a straight line, once it is no more than so many times as near.
const BEFORE: f64 = 1.0 - 1e-6;
const STRAIGHT: f64 = 10.0;
/// Times are apart by so many units of the last place.
const PLACES: f64 = 8.0;
/// A law jumps if it differs by more than this part of itself, or so many units of the last place.
const JUMP: f64 = 1e-7;
const JUMP_PLACES: f64 = 64.0;
/// What is met so soon again, in ways over the jump, is one on which the motion stays.
const SOON: f64 = 1e3;
/// So many thresholds of one step are looked at, and so often a jump is come nearer to.
const MOST: usize = 16;
/// So often the place of a threshold is narrowed, or the way beyond it doubled.
const NARROWINGS: u32 = 100;

/// A state at a time.
type Place<T, const N: usize> = (T, SVector<T, N>);

/// A jump within a step that has been taken.
struct Jump<T, const N: usize> {
    /// Where the step began.
    start: Place<T, N>,
    /// How far ahead of that the jump is thought to be.
    ahead: f64,
    /// How long the step was.
    length: f64,
}

/// Runs over one piece of the input, where slopes are carried along, and ends a step wherever a law jumps at a state.
///
/// What changes when the law jumps changes what comes behind: by the difference of the derivatives at both sides, times by how much
/// later it is (Aizerman and Gantmakher, *Quarterly Journal of Mechanics and Applied Mathematics* 11 (1958), 224–241). A run whose
/// step ends there, at a time with the slopes of that, and whose next step begins there, has it so.
pub(super) fn piece_over_jumps<D, T, S, I, const N: usize, const M: usize, const P: usize>(
    integrator: &D,
    problem: &mut Problem<'_, T, S, I, N, M, P>,
    (start, end): (T, T),
    x: SVector<T, N>,
    observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
) -> Result<ControlFlow<(), SVector<T, N>>, Stopped>
where
    D: Integrator<N> + ?Sized,
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let mut way = Way::new((start, x));
    loop {
        match way.follow(integrator, problem, end, observer)? {
            Followed::Over => continue,
            Followed::There => {}
            Followed::Left => return Ok(ControlFlow::Break(())),
        }
        let Some(jump) = way.near.take() else {
            return Ok(ControlFlow::Continue(way.here.1));
        };
        let (t, x) = way.here;
        let slope = problem.slope(t, &x);
        let length = jump.length;
        let Some(rest) = way.rest(problem, &slope, jump) else {
            continue;
        };
        let beyond = problem.beyond(&way.here, length, (rest, &slope));
        way.watched = seen(t + rest) + SOON * beyond;
        if less(t + rest, end) {
            match problem.cross(way.here, (rest, beyond, &slope), end, observer)? {
                ControlFlow::Continue(next) => way.here = next,
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
            }
        }
    }
}

/// How far a run has come.
struct Way<T, const N: usize> {
    here: Place<T, N>,
    /// A jump that it comes nearer to.
    near: Option<Jump<T, N>>,
    /// How often it did so.
    tries: usize,
    /// Jumps are met from this time on.
    watched: f64,
}

/// Why a run has not gone on.
enum Followed {
    /// It is where it was to go.
    There,
    /// A step has gone over a jump.
    Over,
    /// The observer has broken off.
    Left,
}

impl<T: Real, const N: usize> Way<T, N> {
    fn new(here: Place<T, N>) -> Self {
        Self {
            here,
            near: None,
            tries: 0,
            watched: f64::NEG_INFINITY,
        }
    }

    /// Goes on to the end, or almost to a jump that is near.
    fn follow<D, S, I, const M: usize, const P: usize>(
        &mut self,
        integrator: &D,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        end: T,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Followed, Stopped>
    where
        D: Integrator<N> + ?Sized,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let (t, x) = self.here;
        let target = match &self.near {
            Some(jump) => end.min(t + T::from_f64(BEFORE * jump.ahead)),
            None => end,
        };
        if !less(t, target) {
            return Ok(Followed::There);
        }
        let mut found = None;
        let mut memory = problem.memory;
        let mut beside = problem.beside();
        let done = integrator.piece(problem, (t, target), x, &mut |step| {
            beside.memory = memory;
            found = beside.jump_within(step, self.watched);
            if found.is_some() {
                return ControlFlow::Break(());
            }
            memory = step.memory();
            observer(step)
        })?;
        Ok(match (done, found) {
            (ControlFlow::Continue(next), _) => {
                self.here = (target, next);
                Followed::There
            }
            (ControlFlow::Break(()), None) => Followed::Left,
            (ControlFlow::Break(()), Some(jump)) => {
                problem.statistics.steps -= 1;
                problem.statistics.rejected += 1;
                problem.memory = memory;
                (self.here, self.near) = (jump.start, Some(jump));
                Followed::Over
            }
        })
    }

    /// How long it is to a jump that is almost met; none if it is not there, or is to be come nearer to.
    fn rest<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        slope: &SVector<T, N>,
        jump: Jump<T, N>,
    ) -> Option<T>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.tries += 1;
        let near = problem.apart(self.here.0, jump.length);
        let rest = problem.straight_to_threshold(&self.here, slope, jump.length);
        let Some(rest) = rest.filter(|_| self.tries <= MOST) else {
            self.watched = seen(self.here.0) + jump.ahead + SOON * near;
            self.tries = 0;
            return None;
        };
        if seen(rest) > STRAIGHT * near {
            let ahead = seen(rest);
            self.near = Some(Jump { ahead, ..jump });
            return None;
        }
        self.tries = 0;
        Some(rest)
    }
}

impl<'a, T, S, I, const N: usize, const M: usize, const P: usize> Problem<'a, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    /// The first jump of a law at a state that a step has gone over, but for those before a time.
    fn jump_within(
        &mut self,
        step: &mut Step<'_, T, N, S::Memory>,
        watched: f64,
    ) -> Option<Jump<T, N>> {
        let start = (step.start(), *step.first());
        let end = (step.end(), *step.state());
        let length = seen(end.0 - start.0);
        let mut from = start;
        for _ in 0..MOST {
            self.reached(&from, &end)?;
            let [before, behind] = self.narrowed(step, from, end);
            if seen(before.0) >= watched && self.jumps(&before, &behind) {
                return Some(Jump {
                    start,
                    ahead: seen(before.0 - start.0),
                    length,
                });
            }
            from = behind;
        }
        None
    }

    /// The sides of the first threshold within a part of a step, next to each other.
    fn narrowed(
        &self,
        step: &mut Step<'_, T, N, S::Memory>,
        first: Place<T, N>,
        last: Place<T, N>,
    ) -> [Place<T, N>; 2] {
        let [mut before, mut behind] = [first, last];
        let width = self.apart(behind.0, seen(behind.0 - before.0));
        for round in 0..NARROWINGS {
            let open = seen(behind.0 - before.0);
            if open <= width {
                break;
            }
            let ahead = self.reached(&before, &behind).map_or(0.0, seen);
            // By the rate, then from behind, and by halves where neither comes nearer.
            let part = match round % 3 {
                0 => ahead + 0.5 * width,
                1 => open - width,
                _ => 0.5 * open,
            };
            let time = before.0 + T::from_f64(part);
            if !less(before.0, time) || !less(time, behind.0) {
                continue;
            }
            let inner = (time, step.at(time));
            match self.reached(&before, &inner) {
                Some(_) => behind = inner,
                None => before = inner,
            }
        }
        // One of them may be at the threshold itself, where a law is that of one side alone.
        let aside = T::from_f64(width);
        let earlier = before.0 - aside;
        if less(first.0, earlier) {
            before = (earlier, step.at(earlier));
        }
        let later = behind.0 + aside;
        if less(later, last.0) {
            behind = (later, step.at(later));
        }
        [before, behind]
    }

    /// Whether the derivative differs between two places next to each other.
    fn jumps(&mut self, before: &Place<T, N>, behind: &Place<T, N>) -> bool {
        let [a, b] = [before, behind].map(|(time, state)| self.slope(*time, state));
        let part = JUMP.max(JUMP_PLACES * T::EPSILON);
        let mut pairs = a.iter().zip(&b);
        pairs.any(|(a, b)| (*b - *a).magnitude() > part * (a.magnitude() + b.magnitude()))
    }

    /// How long behind a place the first threshold between it and another one is passed, if one is, by how states change from one
    /// to the other.
    fn reached(&self, from: &Place<T, N>, to: &Place<T, N>) -> Option<T> {
        let slope = (to.1 - from.1).map(|change| change / (to.0 - from.0));
        self.reached_with(from, to, &slope)
    }

    /// How long a straight line goes on from a place to a threshold, within the length of a step.
    fn straight_to_threshold(
        &self,
        from: &Place<T, N>,
        slope: &SVector<T, N>,
        length: f64,
    ) -> Option<T> {
        let length = T::from_f64(length);
        let to = (from.0 + length, along(&from.1, length, slope));
        self.reached_with(from, &to, slope)
    }

    fn reached_with(
        &self,
        from: &Place<T, N>,
        to: &Place<T, N>,
        slope: &SVector<T, N>,
    ) -> Option<T> {
        let inputs = [from, to].map(|it| self.input.value(it.0, self.since));
        let mut memory = self.memory;
        let lasting = to.0 - from.0;
        let mut first: Option<T> = None;
        self.system.courses(
            (from.0, &from.1, slope, &inputs[0]),
            (to.0, &to.1, slope, &inputs[1]),
            &mut memory,
            |course| {
                let times = [first, course.reached(lasting)].into_iter().flatten();
                first = times.reduce(sooner);
            },
        );
        first
    }

    /// How far apart times within a step so long are told from each other.
    fn apart(&self, t: T, length: f64) -> f64 {
        (NARROW * length).max(PLACES * T::EPSILON * t.magnitude())
    }

    /// How far a straight line goes on behind a threshold, which a step so long has passed, until it is passed in numbers, too.
    fn beyond(&self, from: &Place<T, N>, length: f64, (rest, slope): (T, &SVector<T, N>)) -> f64 {
        let mut beyond = PLACES * T::EPSILON * from.0.magnitude().max(length);
        for _ in 0..NARROWINGS {
            let way = rest + T::from_f64(beyond);
            let to = (from.0 + way, along(&from.1, way, slope));
            if self.reached_with(from, &to, slope).is_some() {
                break;
            }
            beyond *= 2.0;
        }
        beyond
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
        let next = self.arrive(until, x + change, &ahead)?;
        // Of the change itself: beside the state it may be little more than rounding.
        let mut line = || Polynomial::straight(&x, change);
        let span = Span {
            start,
            end: until,
            length,
        };
        let mut step = Step::new(span, (x, next), self.memory, &mut line);
        Ok(match observer(&mut step) {
            ControlFlow::Continue(()) => ControlFlow::Continue((until, next)),
            ControlFlow::Break(()) => ControlFlow::Break(()),
        })
    }
}
