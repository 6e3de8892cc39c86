//! Steps of constant length along their grid, which end at jumps of the laws.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::crossing::Across;
use super::dense::{Part, Step};
use super::fixed::Fixed;
use super::grid::{FINEST, Grid, Parts};
use super::jumps::{Counted, Jump, Ran, Runs, walk_over_jumps};
use super::method::{Method, Start, Stepper};
use super::over::{Place, straight};
use super::problem::Problem;
use super::slide::{Ends, Walk, Walked, WalkedOf, WhereALaneStays};
use super::thresholds::Point;
use super::{Cause, Stopped, check_result, less, seen};
use crate::course::{FARTHER, sooner};
use crate::{Input, Real, System};

/// A method along its grid.
pub(super) struct OnGrid<'a, Scheme, T> {
    fixed: &'a Fixed<Scheme>,
    grid: Grid<T>,
    /// The end of a step of the grid that was asked for, and how often.
    asked: (f64, u32),
    /// Where a step was lost, and how often.
    lost: (f64, u32),
    /// Whether it is on the lookout for jumps.
    looks: bool,
}

impl<'a, Scheme, T: Real> OnGrid<'a, Scheme, T> {
    /// From one time to another.
    pub(super) fn new(fixed: &'a Fixed<Scheme>, (start, end): (T, T)) -> Self {
        Self {
            fixed,
            grid: Grid::new(start, end, T::from_f64(fixed.step)),
            asked: (f64::NEG_INFINITY, 0),
            lost: (f64::NEG_INFINITY, 0),
            looks: false,
        }
    }
}

/// So often it is begun anew within a step of the grid at most.
const ENDS: u32 = 64;

impl<Scheme: Method, T: Real, const N: usize> Walk<T, N> for OnGrid<'_, Scheme, T> {
    const LOOKS_WITHIN: bool = false;

    fn walk<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (here, end): (Place<T, N>, T),
        ends: impl Ends<T, S, I, N, M, P>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<WalkedOf<T, S, N, M, P>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if !S::HAS_COURSES {
            return self.over(problem, (here, end), observer);
        }
        if here.0.in_lane(1).is_some() {
            return self.walk_in_lanes(problem, (here, end), observer);
        }
        self.looks = true;
        walk_over_jumps(self, problem, (here, end), ends, observer)
    }
}

impl<Scheme: Method, T: Real> OnGrid<'_, Scheme, T> {
    /// Runs to the end of the piece, not on the lookout for jumps.
    fn over<S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        place_and_end: (Place<T, N>, T),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<WalkedOf<T, S, N, M, P>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.looks = false;
        Ok(
            match self.to(problem, place_and_end, f64::NEG_INFINITY, observer)? {
                Ran::To(x) => Walked::Ended(x),
                _ => Walked::Left,
            },
        )
    }

    /// Lanes share their steps, which end where a law jumps in any of them. Where one of them stays they do not go along the threshold,
    /// but over it up to the end of the step of the grid: it is led back in the next one.
    fn walk_in_lanes<S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (mut here, end): (Place<T, N>, T),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<WalkedOf<T, S, N, M, P>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        loop {
            self.looks = true;
            let way = (here, end);
            let walked = walk_over_jumps(self, problem, way, WhereALaneStays, observer)?;
            let Walked::Stays(place, _) = walked else {
                return Ok(walked);
            };
            let until = sooner(end, self.grid.end_of_step(place.0));
            match self.over(problem, (place, until), observer)? {
                Walked::Ended(x) if less(until, end) => here = (until, x),
                walked => return Ok(walked),
            }
        }
    }
}

impl<Scheme: Method, T: Real, const N: usize> Runs<T, N> for OnGrid<'_, Scheme, T> {
    fn to<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        ((mut t, mut x), end): (Place<T, N>, T),
        watched: f64,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Ran<T, N>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut work = Scheme::Work::<T, N>::new(&self.fixed.method);
        let mut across = Across::new();
        let mut lost = SVector::from_element(T::from_f64(0.0));
        while let Some(whole) = self.grid.step_between(t, end) {
            let mut parts = Parts::of(whole);
            while let Some(span) = parts.next() {
                t = span.start;
                across.note::<S, M, P>(&x);
                let slope = problem.slope(t, &x);
                problem.check(t, &x, &slope)?;
                let from = Start {
                    again: parts.again,
                    is_part: parts.size < FINEST,
                    ..Start::of(span, x, slope)
                };
                let memory = problem.memory;
                let mut trial = work.attempt(problem, &from, None);
                let other = across.instead_of(&trial, problem, &from, memory);
                let is_across = other.is_some();
                if let Some(other) = other {
                    (trial, work) = (other, Stepper::new(&self.fixed.method));
                }
                if !trial.error.is_finite() {
                    let jacobian = work.place_of_jacobian(&from);
                    problem.statistics.rejected += 1;
                    let takes_jacobian = jacobian.is_some();
                    let tried = (&from, self.fixed.step, memory);
                    let near = match self.looks && !often(&mut self.lost, seen(t)) {
                        true => near(problem, &mut across, tried, takes_jacobian),
                        false => Near::Nothing,
                    };
                    if near.may_be_halved(takes_jacobian) && parts.halve() {
                        problem.memory = memory;
                        continue;
                    }
                    if let Near::Jump(jump) | Near::Threshold(jump) = near {
                        problem.memory = memory;
                        return Ok(Ran::Met(jump));
                    }
                    check_result(problem.system, t, &trial.change, &problem.memory)
                        .map_err(|stopped| problem.traced(stopped, &from, jacobian))?;
                    return Err(Stopped::new(t, Cause::Diverged));
                }
                let looks = S::HAS_COURSES && self.looks;
                let is_clear = looks && is_clear(problem, &from, &trial.change);
                if looks
                    && !is_clear
                    && let Some(jump) =
                        touched(problem, (&from, &trial.change, self.fixed.step), watched)
                {
                    problem.memory = memory;
                    return Ok(Ran::Met(jump));
                }
                x = if self.fixed.compensated {
                    summed(&x, &trial.change, &mut lost)
                } else {
                    x + trial.change
                };
                t = span.end;
                check_result(problem.system, t, &x, &problem.memory).map_err(|stopped| {
                    problem.traced(stopped, &from, work.place_of_jacobian(&from))
                })?;
                x = problem.close(t, x)?;
                problem.statistics.steps += 1;
                let memory = problem.memory;
                let mut dense = |_| match is_across {
                    true => Part::whole(across.polynomial(problem, &from, &x)),
                    false => Part::whole(work.polynomial(problem, &from, (&x, None))),
                };
                let mut step = Step::new(span, (from.x, x), memory, &mut dense);
                step.is_clear = is_clear;
                if observer(&mut step).is_break() {
                    return Ok(Ran::Left);
                }
                problem.memory = memory;
                parts.take();
            }
        }
        Ok(Ran::To(x))
    }

    fn length(&self) -> f64 {
        self.fixed.step
    }

    fn watched(&mut self, t: T) -> f64 {
        let end = seen(self.grid.end_of_step(t));
        match often(&mut self.asked, end) {
            true => end,
            false => f64::NEG_INFINITY,
        }
    }
}

/// Whether something is at the same time again, and that too often.
fn often(before: &mut (f64, u32), time: f64) -> bool {
    *before = match *before {
        (same, times) if same == time => (time, times.saturating_add(1)),
        _ => (time, 0),
    };
    before.1 > ENDS
}

/// What a step that is lost has ahead.
enum Near<T, const N: usize> {
    /// A jump of a law.
    Jump(Jump<T, N>),
    /// A threshold, as far as the line from the start tells.
    Threshold(Jump<T, N>),
    Nothing,
}

impl<T, const N: usize> Near<T, N> {
    /// Whether the step is to be tried in halves; one that takes no Jacobian finds its stages no better for it elsewhere.
    const fn may_be_halved(&self, takes_jacobian: bool) -> bool {
        match self {
            Self::Jump(_) => false,
            Self::Threshold(_) => true,
            Self::Nothing => takes_jacobian,
        }
    }
}

/// How much of its way an argument may have missed by how its rate changes within a step: where the line from the start leads almost to
/// a threshold, and where it begins beside one.
const ASTRAY: [f64; 2] = [1e-3, 1e-2];

/// The line from the start of a step, or of a part of one, to a threshold of the laws, if it comes to one within a length; of arguments
/// that are open.
fn line_to_threshold<T, S, I, const N: usize, const M: usize, const P: usize>(
    problem: &Problem<'_, T, S, I, N, M, P>,
    (from, whole): (&Start<T, N>, f64),
    way: f64,
    is_open: impl Fn(usize) -> bool,
) -> Option<Jump<T, N>>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let start = (from.span.start, from.x);
    let [first, last] = straight(&start, &from.slope, T::from_f64(way));
    let mut number = 0;
    let ahead = problem.soonest(&first, &last, |course, lasting| {
        let is_open = is_open(number);
        number += 1;
        course.within(lasting).filter(|_| is_open)
    })?;
    Some(Jump {
        start,
        ahead,
        length: whole,
        is_guess: true,
    })
}

/// Whether a step, and the line from its start, go over no threshold.
#[inline(always)]
fn is_clear<T, S, I, const N: usize, const M: usize, const P: usize>(
    problem: &Problem<'_, T, S, I, N, M, P>,
    from: &Start<T, N>,
    change: &SVector<T, N>,
) -> bool
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let [first, last] =
        [(from.span.start, from.x), (from.span.end, from.x + change)].map(|(time, state)| Point {
            time,
            state,
            slope: from.slope,
        });
    let mut is_clear = true;
    problem.courses(&first, &last, |course, lasting| {
        is_clear &= course.is_clear(lasting);
    });
    is_clear
}

/// A threshold that a step seems to have met at its stages, though it has not taken the argument over it: where the line from its start
/// leads, or almost, as a jump leads back; or where what begins beside one has not gone as it should have. Not before a time.
fn touched<T, S, I, const N: usize, const M: usize, const P: usize>(
    problem: &mut Problem<'_, T, S, I, N, M, P>,
    (from, change, whole): (&Start<T, N>, &SVector<T, N>, f64),
    watched: f64,
) -> Option<Jump<T, N>>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let length = seen(from.span.length);
    let end = (from.span.end, from.x + change);
    let passed = problem.met(&(from.span.start, from.x), &end);
    let is_open = |number| !passed.contains(number);
    let line = line_to_threshold(problem, (from, whole), FARTHER * length, is_open);
    let [almost, beside] = ASTRAY;
    let least = if line.is_some() { almost } else { beside };
    let met = line.filter(|line| line.ahead <= length).or_else(|| {
        let start = (from.span.start, from.x);
        is_led_back(problem, (&start, &end), (least, is_open)).then(|| astray(from, whole))
    });
    met.filter(|met| seen(met.start.0) + met.ahead >= watched)
}

/// Whether an argument that is open has missed such a part of the way that it should have gone by its rates at both ends of a step.
#[cold]
fn is_led_back<T, S, I, const N: usize, const M: usize, const P: usize>(
    problem: &mut Problem<'_, T, S, I, N, M, P>,
    (start, end): (&Place<T, N>, &Place<T, N>),
    (least, is_open): (f64, impl Fn(usize) -> bool),
) -> bool
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let memory = problem.memory;
    let [first, last] = [*start, *end].map(|place| problem.point(place));
    problem.memory = memory;
    let (mut is_led_back, mut number) = (false, 0);
    problem.courses(&first, &last, |course, lasting| {
        is_led_back |=
            course.is_astray(lasting, least) && is_open(number) && !course.is_clear(lasting);
        number += 1;
    });
    is_led_back
}

/// What there is ahead of a step that is lost: stages on both sides of a jump are not found, and another method goes over it.
#[cold]
#[inline(never)]
fn near<T, S, I, const N: usize, const M: usize, const P: usize>(
    problem: &mut Problem<'_, T, S, I, N, M, P>,
    across: &mut Across<T, N>,
    (from, whole, memory): (&Start<T, N>, f64, S::Memory),
    takes_jacobian: bool,
) -> Near<T, N>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let length = seen(from.span.length);
    let line = line_to_threshold(problem, (from, whole), 2.0 * length, |_| true);
    // What a Jacobian is lost by is told.
    if line.is_none() && takes_jacobian {
        return Near::Nothing;
    }
    let tried = core::mem::replace(&mut problem.memory, memory);
    let mut beside = problem.beside();
    let change = across.over(problem, from).change;
    let end = from.x + change;
    let mut dense = |_| Part::whole(across.polynomial(problem, from, &end));
    let mut step = Step::new(from.span, (from.x, end), memory, &mut dense);
    let jump = beside.jump_within(&mut step, f64::NEG_INFINITY, Counted::Jumps);
    problem.memory = tried;
    // Sweeps may have been beyond one to which neither leads.
    let beside = || (!is_clear(problem, from, &change)).then(|| astray(from, whole));
    let threshold = || line.or_else(beside).map_or(Near::Nothing, Near::Threshold);
    jump.map_or_else(threshold, Near::Jump)
}

/// A jump that the stages of a step seem to have met before its end.
fn astray<T: Real, const N: usize>(from: &Start<T, N>, whole: f64) -> Jump<T, N> {
    Jump {
        start: (from.span.start, from.x),
        ahead: 0.5 * seen(from.span.length),
        length: whole,
        is_guess: true,
    }
}

/// `x + change`, where `lost` is what rounding took off the sums before.
pub(super) fn summed<T: Real, const N: usize>(
    x: &SVector<T, N>,
    change: &SVector<T, N>,
    lost: &mut SVector<T, N>,
) -> SVector<T, N> {
    let whole = change + *lost;
    let sum = x + whole;
    *lost = x.zip_zip_map(&sum, &whole, |x, sum, whole| (x - sum) + whole);
    sum
}
