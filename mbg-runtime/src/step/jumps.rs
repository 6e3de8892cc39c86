//! Runs with slopes across thresholds at which a law jumps: a step ends there.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::Step;
use super::integrator::Integrator;
use super::over::{Place, SOON};
use super::problem::Problem;
use super::{Stopped, less, seen};
use crate::{Input, Real, System};

/// The part of the way to a jump that steps go.
const BEFORE: f64 = 1.0 - 1e-6;
/// A law jumps if it differs by more than this part of itself, or so many units of the last place.
const JUMP: f64 = 1e-7;
const JUMP_PLACES: f64 = 64.0;
/// So many thresholds of one step are looked at, and so often a jump is come nearer to.
const MOST: usize = 16;
/// So often the place of a threshold is narrowed.
const NARROWINGS: u32 = 100;

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
        match problem.over_threshold((way.here, (rest, &slope)), (length, end), observer)? {
            ControlFlow::Continue(next) => (way.here, way.watched) = next,
            ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
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
        let next = problem.next_threshold(&self.here, slope, jump.length);
        if next.is_none() && self.tries <= MOST {
            let rest = problem.straight_to_threshold(&self.here, slope, jump.length);
            if let Some(ahead) = rest.map(seen).filter(|ahead| *ahead > 0.0) {
                self.near = Some(Jump { ahead, ..jump });
                return None;
            }
        }
        if next.is_none() {
            let apart = problem.apart(self.here.0, jump.length);
            self.watched = seen(self.here.0) + jump.ahead + SOON * apart;
        }
        self.tries = 0;
        next
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
        if step.surfaces.is_some() {
            // Where it stays at thresholds the derivative is that along them.
            return None;
        }
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
}
