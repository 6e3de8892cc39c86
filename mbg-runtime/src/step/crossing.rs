//! Steps across singular positions of closed loops.

use core::cmp::Ordering;

use nalgebra::SVector;

use super::control::Control;
use super::dense::{Part, Polynomial};
use super::explicit::Dop853;
use super::method::{Estimating, Family, Start, Stepper, Trial};
use super::over::Place;
use super::problem::Problem;
use super::seen;
use super::tolerance::{Sizes, Tolerance};
use crate::{Input, Real, System};

/// What of a step is taken that has been tried.
pub(super) enum Taken<T, const N: usize> {
    /// All of it: the state and the derivative at its end.
    Whole(SVector<T, N>, SVector<T, N>),
    /// It is to be tried again up to this length, behind which something was missed.
    Until(f64),
    /// Its error is too large.
    Nothing,
}

/// A step that was refused so often may be one that meets a singular position.
const REFUSED: u32 = 2;
/// So may be one that is shorter than the steps before it by this factor.
const SHORT: f64 = 0.1;
/// By how much more forces answer to what is off the loops where one is near: by as much as it is nearer than at the steps before.
const NEARER: f64 = 3.0;
/// By what part of a step a state is moved off the loops to see that.
const OFF_LOOPS: f64 = 1e-4;
/// How much of the length of steps is remembered from step to step.
const REMEMBERED: f64 = 0.9;
/// What is tried, in lengths of the steps before: what a stage is off by depends on how near it comes.
const LENGTHS: [f64; 8] = [1.0, 1.5, 0.7, 2.2, 0.5, 3.0, 0.35, 4.0];
/// The least tolerances for which these are tried one after the other, in units of the root of the precision.
const DIGITS: [f64; 3] = [0.1, 1.0, 10.0];

/// Steps across a singular position of a closed loop, such as that of a parallelogram whose bars are in line, beside those of a
/// method.
///
/// Two branches of the motion meet there. Forces in the loop are those of an error of the state divided by the distance from
/// the position, so that stages of a step near it, which are off the loop by their own error, have large ones. The control of
/// the error answers with steps in proportion to the distance, which never cross; at the end rounding alone takes the loop from
/// its branch onto the other one. A step across is one of an explicit method whose stages are closed, about as long as the
/// steps before. Its error has rounding divided by the square of the distance in it, which the next closing takes away, so that
/// it is not asked for many more digits than half of those of the scalar.
///
/// Steps that are short for another reason, such as a valve that closes, are left to the method: forces then answer no more than before
/// to what is off the loops.
pub(super) struct Crossing<'a, Scheme: Family, T: Real, const N: usize> {
    method: &'a Scheme,
    work: &'a mut Scheme::Work<T, N>,
    explicit: <Dop853 as Family>::Work<T, N>,
    tolerances: [Tolerance<N>; DIGITS.len()],
    /// The length of the longest of the last steps.
    usual: f64,
    /// Where the last step began that was as long.
    far: Option<Place<T, N>>,
    /// How many steps across have been tried; none while the method itself steps.
    tried: usize,
    /// Whether the step at hand is one across.
    is_across: bool,
}

impl<'a, Scheme: Family, T: Real, const N: usize> Crossing<'a, Scheme, T, N> {
    /// Beside a method with these relative and absolute tolerances and nominal sizes.
    pub(super) fn new(
        (method, work): (&'a Scheme, &'a mut Scheme::Work<T, N>),
        (relative, absolute): (f64, f64),
        nominal: &[f64],
    ) -> Self {
        let tolerance = |part: f64| {
            let least = part * Real::sqrt(T::EPSILON);
            Tolerance::new(relative.max(least), absolute.max(least), nominal)
        };
        Self {
            method,
            work,
            explicit: Stepper::new(&Dop853),
            tolerances: DIGITS.map(tolerance),
            usual: 0.0,
            far: None,
            tried: 0,
            is_across: false,
        }
    }

    /// Whether the step at hand is one across; where there are no loops that is known while compiling.
    fn is_across<S, const M: usize, const P: usize>(&self) -> bool
    where
        S: System<T, N, M, P>,
    {
        !S::META.closures.is_empty() && self.is_across
    }

    /// The length to try from a place where the control has come to this one, after so many refusals.
    pub(super) fn length<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        here: &Place<T, N>,
        (length, refused): (f64, u32),
    ) -> f64
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let is_short = refused >= REFUSED || length < SHORT * self.usual;
        let begins = !S::META.closures.is_empty()
            && is_short
            && self.usual > 0.0
            && self.tried == 0
            && self.is_nearer(problem, here);
        let is_left = self.tried < LENGTHS.len() * DIGITS.len();
        self.is_across = !S::META.closures.is_empty() && (begins || self.tried > 0) && is_left;
        if !self.is_across {
            return length;
        }
        self.tried += 1;
        LENGTHS[(self.tried - 1) % LENGTHS.len()] * self.usual
    }

    /// Whether a place is nearer to a singular position than where steps were long, as far as can be told.
    #[cold]
    #[inline(never)]
    fn is_nearer<S, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        here: &Place<T, N>,
    ) -> bool
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let Some(far) = &self.far else {
            return true;
        };
        let way = here.1 - far.1;
        let [here, far] = [here, far].map(|place| self.answer(problem, place, &way));
        // Written so that what is no number is nearer.
        !matches!(
            here.partial_cmp(&(NEARER * far)),
            Some(Ordering::Less | Ordering::Equal)
        )
    }

    /// How much derivatives answer to what of a move, about along a way, is off the loops.
    fn answer<S, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (t, x): &Place<T, N>,
        way: &SVector<T, N>,
    ) -> f64
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let moved = SVector::from_fn(|state, _| {
            let part = ((7 * state + 3) % 11) as f64 / 11.0 - 0.5;
            x[state] + T::from_f64(OFF_LOOPS * part) * way[state]
        });
        let Ok(closed) = problem.close(*t, moved) else {
            return f64::NAN;
        };
        let memory = problem.memory;
        let [off, on] = [moved, closed].map(|x| problem.slope(*t, &x));
        problem.memory = memory;
        let measure = self.tolerances[0].around(x);
        measure.norm(&(off - on)) / measure.norm(&(moved - closed))
    }

    /// The tolerance of the step at hand, where it is one across.
    pub(super) fn tolerance<S, const M: usize, const P: usize>(&self) -> Option<Tolerance<N>>
    where
        S: System<T, N, M, P>,
    {
        if !self.is_across::<S, M, P>() {
            return None;
        }
        let place = self.tried.saturating_sub(1) / LENGTHS.len();
        self.tolerances.get(place).copied()
    }

    /// Tries a step, by the method unless it is one across.
    pub(super) fn attempt<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: &Tolerance<N>,
    ) -> Trial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        problem.closes_stages = self.is_across::<S, M, P>();
        if problem.closes_stages {
            self.explicit.attempt(problem, start, Some(tolerance))
        } else {
            self.work.attempt(problem, start, Some(tolerance))
        }
    }

    /// What of the step is taken that was tried last.
    pub(super) fn taken<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        trial: &Trial<T, N>,
        tolerance: &Tolerance<N>,
    ) -> Taken<T, N>
    where
        Scheme: Estimating,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        // Written so that a step of NaN is refused as well.
        if trial.error <= 1.0 {
            let next = start.x + trial.change;
            let slope = trial.slope;
            let ahead = slope.unwrap_or_else(|| problem.slope(start.span.end, &next));
            let dense = |problem: &mut _| self.polynomial(problem, start, (&next, Some(ahead)));
            match problem.clear_length::<Scheme>(start, (trial, &ahead), tolerance, dense) {
                None => Taken::Whole(next, ahead),
                Some(clear) => Taken::Until(clear),
            }
        } else {
            Taken::Nothing
        }
    }

    /// What is known in between of the step that was tried last.
    pub(super) fn polynomial<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if self.is_across::<S, M, P>() {
            self.explicit.polynomial(problem, start, end)
        } else {
            self.work.polynomial(problem, start, end)
        }
    }

    /// The same for what is read at a place of it, within a tolerance as the ends of the step are.
    pub(super) fn samples<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: (&SVector<T, N>, Option<SVector<T, N>>),
        tolerance: &Tolerance<N>,
        place: f64,
    ) -> Part<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if self.is_across::<S, M, P>() {
            self.explicit.samples(problem, start, end, tolerance, place)
        } else {
            self.work.samples(problem, start, end, tolerance, place)
        }
    }

    /// Where the step at hand takes its Jacobian.
    pub(super) fn place_of_jacobian(&self, start: &Start<T, N>) -> Option<(T, SVector<T, N>)> {
        self.work.place_of_jacobian(start)
    }

    /// Hands a refusal on to the control; what a step across is off by says nothing of the method's own.
    pub(super) fn reject<S, const M: usize, const P: usize>(
        &self,
        control: &mut Control,
        length: f64,
        error: f64,
    ) where
        S: System<T, N, M, P>,
    {
        if !self.is_across::<S, M, P>() {
            control.reject(length, error);
        }
    }

    /// Goes on behind a jump of the laws.
    pub(super) fn renew(&mut self) {
        renew(self.work, self.method);
    }

    /// Goes on behind a step.
    pub(super) fn accept<S, const M: usize, const P: usize>(
        &mut self,
        control: &mut Control,
        start: &Start<T, N>,
        error: f64,
    ) where
        S: System<T, N, M, P>,
    {
        let length = seen(start.span.length);
        let is_across = self.is_across::<S, M, P>();
        if !S::META.closures.is_empty() && length >= REMEMBERED * self.usual {
            self.far = Some((start.span.start, start.x));
        }
        // Where no step across was found the method's own is what is usual.
        let fails = self.tried > 0 && !is_across;
        self.usual = if fails {
            length
        } else {
            length.max(REMEMBERED * self.usual)
        };
        self.tried = 0;
        if is_across {
            renew(self.work, self.method);
            control.shorten(length);
        } else {
            control.growth = self.work.growth();
            control.accept(length, error, Scheme::RULE);
        }
    }
}

/// The same beside steps of constant length: where the stages of one are not found, since what is off the loops has no slopes to
/// go by there.
pub(super) struct Across<T: Real, const N: usize> {
    explicit: <Dop853 as Family>::Work<T, N>,
    sizes: Sizes<N>,
}

/// What such a step may be off by, in units of what states have been.
const OFF: f64 = 1e-5;

impl<T: Real, const N: usize> Across<T, N> {
    pub(super) fn new() -> Self {
        Self {
            explicit: Stepper::new(&Dop853),
            sizes: Sizes::new(),
        }
    }

    /// Notes where a step begins.
    pub(super) fn note<S, const M: usize, const P: usize>(&mut self, x: &SVector<T, N>)
    where
        S: System<T, N, M, P>,
    {
        if !S::META.closures.is_empty() {
            self.sizes.note(x);
        }
    }

    /// A step across instead of one that is lost, with what the run remembered before it.
    pub(super) fn instead_of<S, I, const M: usize, const P: usize>(
        &mut self,
        trial: &Trial<T, N>,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        memory: S::Memory,
    ) -> Option<Trial<T, N>>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if S::META.closures.is_empty() || trial.error.is_finite() {
            return None;
        }
        let tried = core::mem::replace(&mut problem.memory, memory);
        problem.closes_stages = true;
        let tolerance = self.sizes.tolerance(OFF);
        let across = self.explicit.attempt(problem, start, Some(&tolerance));
        problem.closes_stages = false;
        let found = across.error <= 1.0;
        if found {
            problem.statistics.rejected += 1;
        } else {
            problem.memory = tried;
        }
        found.then_some(across)
    }

    /// A step of the explicit method, wherever it goes over.
    pub(super) fn over<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
    ) -> Trial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.explicit.attempt(problem, start, None)
    }

    /// What is known in between of the step that was tried last, which ends at `x`.
    pub(super) fn polynomial<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        x: &SVector<T, N>,
    ) -> Polynomial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.explicit.polynomial(problem, start, (x, None))
    }
}

/// Forgets all steps, apart from the run: what is new is on the stack no longer than the call.
#[inline(never)]
fn renew<A, T: Real, const N: usize>(work: &mut impl Stepper<A, T, N>, method: &A) {
    *work = Stepper::new(method);
}
