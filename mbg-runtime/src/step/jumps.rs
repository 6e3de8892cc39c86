//! Runs across thresholds at which a law jumps: a step ends there.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::Step;
use super::over::{Place, SOON};
use super::problem::Problem;
use super::slide::{Ends, Walked, WalkedOf};
use super::tolerance::{NOISE, Sizes};
use super::{Stopped, less, seen};
use crate::lane::lane;
use crate::{Input, Real, System};

/// The part of the way to a jump that steps leave, at least and at most: by how much its place may be off, which is less the nearer it
/// is beside the step that met it. Stages that are beyond it would lead back.
const LEFT: [f64; 2] = [1e-6, 0.1];
/// A rate jumps if it differs by more than this part of what it is made of, or so many units of the last place.
const JUMP: [f64; 2] = [1e-7, 64.0];
/// So many thresholds of one step are looked at.
const MOST: usize = 16;
/// So often a jump is come nearer to: an argument that itself jumps there is at a threshold on a line beyond that before it is there.
const TRIES: usize = 48;
/// The part of a step that goes on from where it has met a jump that is none.
const SHORTER: f64 = 0.5;
/// So often the place of a threshold is narrowed.
const NARROWINGS: u32 = 100;

/// By which part of what it is made of a rate differs that jumps.
pub(super) fn least_jump<T: Real>() -> f64 {
    let [part, places] = JUMP;
    part.max(places * T::EPSILON)
}

/// A jump within a step that has been tried.
pub(super) struct Jump<T, const N: usize> {
    /// Where the step began.
    pub(super) start: Place<T, N>,
    /// How far ahead of that the jump is thought to be.
    pub(super) ahead: f64,
    /// How long the step was.
    pub(super) length: f64,
    /// Whether no more is known than that a line leads there.
    pub(super) is_guess: bool,
}

impl<T, const N: usize> Jump<T, N> {
    /// How much of the way to it a step is to leave that ends before it.
    fn left(&self) -> f64 {
        let [least, most] = LEFT;
        self.ahead * (self.ahead / self.length).max(least).min(most)
    }
}

/// How far a run over a part of a piece has come.
pub(super) enum Ran<T, const N: usize> {
    /// To the end of it, with the state there.
    To(SVector<T, N>),
    /// The observer has broken off.
    Left,
    /// A step is lost, by a jump that it seems to have met.
    Met(Jump<T, N>),
}

/// Which thresholds a step ends at.
#[derive(Clone, Copy)]
pub(super) enum Counted {
    /// All.
    All,
    /// Those at which a rate jumps.
    Jumps,
    /// Those at which the slope of a rate jumps, too, as that of a law with a kink does.
    Kinks,
}

/// What runs over parts of a piece of the input.
pub(super) trait Runs<T: Real, const N: usize> {
    /// Runs from a place to a time, on the lookout for jumps from another one on.
    fn to<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        place_and_end: (Place<T, N>, T),
        watched: f64,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Ran<T, N>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized;

    /// How long steps are, but where they end before something; zero where that is not known.
    fn length(&self) -> f64;

    /// From which time on jumps are met, where it was asked before how often.
    fn watched(&mut self, t: T) -> f64;
}

/// Runs over a piece of the input, or as far as to thresholds at which walks end, and ends a step wherever a law
/// jumps at a state.
///
/// So no stage is beyond a jump, and slopes know of it. What changes when a law jumps changes what comes behind: by the difference of
/// the derivatives at both sides, times by how much later it is (Aizerman and Gantmakher, *Quarterly Journal of Mechanics and Applied
/// Mathematics* 11 (1958), 224–241). A run whose step ends there, at a time with the slopes of that, and whose next step begins there,
/// has it so.
pub(super) fn walk_over_jumps<R, T, S, I, const N: usize, const M: usize, const P: usize>(
    runs: &mut R,
    problem: &mut Problem<'_, T, S, I, N, M, P>,
    (here, end): (Place<T, N>, T),
    ends: impl Ends<T, S, I, N, M, P>,
    observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
) -> Result<WalkedOf<T, S, N, M, P>, Stopped>
where
    R: Runs<T, N>,
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let mut way = Way::new(here, runs.length());
    loop {
        way.watched = way.watched.max(runs.watched(way.here.0));
        match way.follow(runs, problem, (end, ends), observer)? {
            Followed::Over => continue,
            Followed::There => {}
            Followed::Left => return Ok(Walked::Left),
        }
        let Some(jump) = way.near.take() else {
            return Ok(Walked::Ended(way.here.1));
        };
        let here = problem.point(way.here);
        if let Some(surfaces) = ends.at(problem, &here) {
            return Ok(Walked::Stays(way.here, surfaces));
        }
        way.sizes.note(&here.state);
        let tolerance = way.sizes.tolerance(NOISE * T::EPSILON);
        if let Some(rest) = ends.rest(problem, &here, (jump.length, end, &tolerance), observer)? {
            return Ok(rest);
        }
        let length = jump.length;
        let Some(rest) = way.rest(problem, &here.slope, jump) else {
            if !less(way.here.0, end) {
                // There is no way left on which to come nearer.
                way.near = None;
            }
            if way.near.is_none()
                && let Some(surfaces) = ends.behind(problem, &here)
            {
                return Ok(Walked::Stays(way.here, surfaces));
            }
            continue;
        };
        let ahead = (rest, length, end);
        match problem.beyond_threshold(&here, ahead, ends, observer)? {
            ControlFlow::Continue((next, watched)) => {
                way.here = (next.time, next.state);
                way.watched = watched;
            }
            ControlFlow::Break(walked) => return Ok(walked),
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
    /// How long steps are, but where they end before something.
    usual: f64,
    /// How long the step was that met a jump last.
    taken: f64,
    /// How large states have been that were looked at.
    sizes: Sizes<N>,
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
    fn new(here: Place<T, N>, usual: f64) -> Self {
        let mut sizes = Sizes::new();
        sizes.note(&here.1);
        Self {
            here,
            near: None,
            tries: 0,
            watched: f64::NEG_INFINITY,
            usual,
            taken: 0.0,
            sizes,
        }
    }

    /// Goes on to the end, or almost to a jump that is near.
    fn follow<R, S, I, const M: usize, const P: usize>(
        &mut self,
        runs: &mut R,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (end, ends): (T, impl Ends<T, S, I, N, M, P>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Followed, Stopped>
    where
        R: Runs<T, N>,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let t = self.here.0;
        let target = match &self.near {
            Some(jump) => {
                // At the jump itself laws may be those behind it.
                let left = jump.left().max(problem.apart(t, jump.length));
                end.min(t + T::from_f64(jump.ahead - left))
            }
            None => end,
        };
        if !less(t, target) {
            return Ok(Followed::There);
        }
        let mut found = None;
        let counted = self.counted(ends.are_all());
        let mut memory = problem.memory;
        let mut beside = problem.beside();
        let done = runs.to(problem, (self.here, target), self.watched, &mut |step| {
            beside.memory = memory;
            found = beside.jump_within(step, self.watched, counted);
            if found.is_some() {
                return ControlFlow::Break(());
            }
            memory = step.memory();
            observer(step)
        })?;
        Ok(match (done, found) {
            (Ran::To(next), _) => {
                self.here = (target, next);
                Followed::There
            }
            (Ran::Met(jump), _) => {
                self.meet(jump);
                Followed::Over
            }
            (Ran::Left, None) => Followed::Left,
            (Ran::Left, Some(jump)) => {
                problem.statistics.steps -= 1;
                problem.statistics.rejected += 1;
                problem.memory = memory;
                self.meet(jump);
                Followed::Over
            }
        })
    }

    /// Steps whose length follows the error are short enough for slopes at a kink. Those of constant length are not: which stages are
    /// beyond it does not change with where it is, so that slopes would be wrong by a part of what changes within a step.
    fn counted(&self, are_all: bool) -> Counted {
        match are_all {
            true => Counted::All,
            false if T::HAS_SLOPES && self.usual > 0.0 => Counted::Kinks,
            false => Counted::Jumps,
        }
    }

    /// Comes nearer to a jump that a step has met: how near is near enough goes by the first step that has.
    fn meet(&mut self, jump: Jump<T, N>) {
        let before = self.near.as_ref().map_or(self.usual, |near| near.length);
        let length = jump.length.max(before);
        self.taken = jump.length;
        self.here = jump.start;
        self.near = Some(Jump { length, ..jump });
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
        if next.is_none() && self.tries <= TRIES {
            let ahead = problem.straight_to_threshold(&self.here, slope, jump.length);
            if let Some(ahead) = ahead {
                let start = self.here;
                self.near = Some(Jump {
                    start,
                    ahead,
                    ..jump
                });
                return None;
            }
        }
        if next.is_none() && (!jump.is_guess || self.tries > TRIES) {
            let apart = problem.apart(self.here.0, jump.length);
            self.watched = seen(jump.start.0) + jump.ahead + SOON * apart;
            // What is not where it was seen is told better by a shorter step.
            let ahead = SHORTER * self.taken;
            self.near = (ahead > apart).then_some(Jump {
                start: self.here,
                ahead,
                is_guess: true,
                ..jump
            });
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
    /// The first jump of a law at a state that a step has gone over, but for those before a time; or the first threshold of all.
    pub(super) fn jump_within(
        &mut self,
        step: &mut Step<'_, T, N, S::Memory>,
        watched: f64,
        counted: Counted,
    ) -> Option<Jump<T, N>> {
        if step.is_clear || step.surfaces.is_some() {
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
            if seen(before.0) >= watched && self.counts(&before, &behind, counted) {
                return Some(Jump {
                    start,
                    ahead: seen(before.0 - start.0),
                    length,
                    is_guess: false,
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
        let width = T::Lane::from_f64(self.apart(behind.0, seen(behind.0 - before.0)));
        let [zero, half] = [0.0, 0.5].map(T::Lane::from_f64);
        for round in 0..NARROWINGS {
            let open = lane(behind.0 - before.0);
            if open <= width {
                break;
            }
            // By the rate, then from behind, and by halves where neither comes nearer.
            let part = match round % 3 {
                0 => self.reached(&before, &behind).map_or(zero, lane) + half * width,
                1 => open - width,
                _ => half * open,
            };
            let time = before.0 + T::from_lane(part);
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
        let aside = T::from_lane(width);
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

    /// Whether a threshold between two places next to each other counts: the derivative differs in any lane, or its slopes do.
    fn counts(&mut self, before: &Place<T, N>, behind: &Place<T, N>, counted: Counted) -> bool {
        if matches!(counted, Counted::All) {
            return true;
        }
        let [a, b] = [before, behind].map(|(time, state)| self.slope(*time, state));
        let part = T::from_f64(least_jump::<T>());
        let mut pairs = a.iter().zip(&b);
        pairs.any(|(a, b)| {
            let more = (*b - *a).abs() - part * (a.abs() + b.abs());
            more.find(|it| it > 0.0).is_some()
                || (matches!(counted, Counted::Kinks) && bends(*a, *b))
        })
    }
}

/// Whether a number has another slope than one next to it, along any direction.
fn bends<T: Real>(a: T, b: T) -> bool {
    let slopes = |direction| match [b - a, a, b].map(|it| it.slope_along(direction)) {
        [Some(change), Some(before), Some(behind)] => Some([change, before + behind]),
        _ => None,
    };
    let mut directions = (0..).map_while(slopes);
    directions.any(|[change, both]| change > least_jump::<T>() * both)
}
