//! Steps that end at a threshold of the laws which a longer one has gone over in vain.

use nalgebra::SVector;

use super::crossing::Taken;
use super::method::{Start, Trial};
use super::problem::Problem;
use super::seen;
use super::thresholds::Point;
use crate::{Input, Real, System};

/// The parts of the way to a threshold that steps go, the first first: what is known of the way becomes more exact.
const PARTS: [f64; 4] = [0.9, 0.99, 1.0 - 1e-6, 1.0 - 1e-6];
/// How much farther than thought the threshold may be.
const FARTHEST: f64 = 20.0;
/// What a refused step is shortened by where there was no threshold after all.
const SHORTER: f64 = 0.2;
/// So often a threshold is come nearer to.
const MOST: usize = 12;

/// A step that was refused may be one that goes over a threshold of a choice, behind which the laws are others. Instead of shorter and
/// shorter ones until one is short enough to go over it, the next ones end almost there, and a straight line of next to no length
/// leads over it.
pub(super) struct Approach {
    /// How far ahead the threshold is thought to be.
    ahead: Option<f64>,
    /// The length of the first step that went over it, and when that would have ended.
    length: f64,
    until: f64,
    /// The length of the one that went over it last, but for those that were to come nearer.
    last: f64,
    /// How often its place was estimated, and how many steps have come nearer to it.
    tries: usize,
    nearer: usize,
    /// None is met before this time.
    pub(super) watched: f64,
}

/// Where a run stands beside a threshold.
pub(super) enum Come<T> {
    /// It comes near none.
    Away,
    /// It comes nearer to one.
    Nearer,
    /// Next to one: so long it is a straight line.
    There(T),
    /// Where none is ahead after all; the next step is to be so long at most.
    Lost(f64),
}

impl Approach {
    pub(super) const fn new() -> Self {
        Self {
            ahead: None,
            length: 0.0,
            until: f64::NEG_INFINITY,
            last: 0.0,
            tries: 0,
            nearer: 0,
            watched: f64::NEG_INFINITY,
        }
    }

    /// The length to try instead of this one.
    pub(super) fn length(&self, length: f64) -> f64 {
        let part = PARTS.get(self.nearer).or(PARTS.last()).unwrap_or(&1.0);
        self.ahead.map_or(length, |ahead| length.min(part * ahead))
    }

    /// Whether a step has met a threshold that can be come nearer to.
    #[cold]
    pub(super) fn meets<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: &SVector<T, N>,
    ) -> bool
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let [from, to] = ends(start, end, &start.slope);
        let ahead = problem.soonest(&from, &to, |course, lasting| course.within(lasting));
        let is_late = |ahead: f64| {
            seen(from.time) + ahead >= self.watched && ahead > problem.apart(from.time, 0.0)
        };
        self.tries < MOST && ahead.is_some_and(is_late)
    }

    /// Where the run stands behind a step that was refused: maybe since it went over a threshold.
    #[cold]
    pub(super) fn refuse<T, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        trial: &Trial<T, N>,
        taken: &Taken<T, N>,
    ) -> Come<T>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let length = seen(start.span.length);
        let [from, to] = ends(start, &(start.x + trial.change), &start.slope);
        let ahead = match taken {
            // A jump that leads back is met by the line from the start, though stages behind it bend the way back before it.
            Taken::Nothing => problem
                .soonest(&from, &to, |course, lasting| course.within(lasting))
                .or_else(|| {
                    let place = (from.time, from.state);
                    problem.straight_to_threshold(&place, &from.slope, length)
                }),
            _ => None,
        };
        let ahead = ahead.filter(|ahead| seen(from.time) + ahead >= self.watched);
        if ahead.is_none() || self.tries >= MOST {
            self.leave();
            return Come::Away;
        }
        // How near is near goes by the step that has met it, not by what is left of that where one that came nearer was refused.
        if self.ahead.is_none() {
            self.last = length;
            if seen(from.time) >= self.until {
                (self.length, self.until) = (length, seen(to.time));
            }
        }
        if let Some(there) = self.arrive(problem, &from) {
            return there;
        }
        // What is no nearer than times are told apart is not there after all.
        self.ahead = ahead.filter(|ahead| *ahead > problem.apart(from.time, 0.0));
        self.tries += 1;
        if self.ahead.is_none() {
            self.leave();
            return Come::Away;
        }
        Come::Nearer
    }

    /// Where it stands behind a step that was taken.
    #[inline]
    pub(super) fn take<T, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: (&SVector<T, N>, &SVector<T, N>),
    ) -> Come<T>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        match self.ahead {
            None => Come::Away,
            Some(_) => self.come_nearer(problem, &ends(start, end.0, end.1)),
        }
    }

    /// The same behind one that was to come nearer to a threshold.
    #[cold]
    fn come_nearer<T, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        [from, to]: &[Point<T, N>; 2],
    ) -> Come<T>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let left = self.ahead.unwrap_or(0.0) - seen(to.time - from.time);
        self.nearer += 1;
        self.tries += 1;
        let places = [from, to].map(|it| (it.time, it.state));
        let is_over = problem
            .reached_with(&places[0], &places[1], &from.slope)
            .is_some();
        if is_over {
            self.leave();
            return Come::Away;
        }
        if let Some(there) = self.arrive(problem, to) {
            return there;
        }
        let farthest = FARTHEST * left.max(problem.apart(to.time, self.length));
        let ahead = problem.soonest(from, to, |course, lasting| course.behind(lasting));
        self.ahead = ahead.filter(|ahead| *ahead <= farthest && self.tries <= MOST);
        match self.ahead {
            Some(_) => Come::Nearer,
            None => {
                self.leave();
                Come::Lost(SHORTER * self.last)
            }
        }
    }

    /// Whether a place is next to a threshold.
    fn arrive<T, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        here: &Point<T, N>,
    ) -> Option<Come<T>>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let place = (here.time, here.state);
        let rest = problem.next_threshold(&place, &here.slope, self.length)?;
        self.leave();
        Some(Come::There(rest))
    }

    fn leave(&mut self) {
        (self.ahead, self.tries, self.nearer) = (None, 0, 0);
    }
}

/// The ends of a step, with the state and the derivative at the second one.
fn ends<T: Real, const N: usize>(
    start: &Start<T, N>,
    state: &SVector<T, N>,
    slope: &SVector<T, N>,
) -> [Point<T, N>; 2] {
    let (first, last) = (start.span.start, start.span.end);
    [(first, start.x, start.slope), (last, *state, *slope)].map(|(time, state, slope)| Point {
        time,
        state,
        slope,
    })
}
