//! A choice of method by what is known of a problem.

use core::fmt;
use core::ops::ControlFlow;

use nalgebra::{SMatrix, SVector};

use super::adaptive::Adaptive;
use super::dense::Step;
use super::explicit::{Dop853, Tsit5};
use super::integrator::{Integrator, begin};
use super::method::Method;
use super::modes::{bound, fastest};
use super::problem::Problem;
use super::radau::{Radau5, Radau9};
use super::rosenbrock::Rodas5P;
use super::{Stopped, piece_end, seen};
use crate::{Input, Real, System};

/// Integrates with a method that it picks for each piece between two jumps of the input.
///
/// A problem counts as stiff if the fastest mode decays by more than 200 rad within the piece, and by 10 rad more for each state, or if
/// it oscillates and turns by more than 10 000 rad.
///
/// | at the start of the piece | method |
/// |---|---|
/// | stiff; the relative tolerance is at most 1e-5 | [`Radau9`] |
/// | stiff, to a larger tolerance; the fastest mode oscillates | [`Radau5`] |
/// | stiff, to a larger tolerance; the fastest mode decays | [`Rodas5P`] |
/// | not stiff; the relative tolerance is above 1e-4, or no mode can move as much as 1 rad within the piece | [`Tsit5`] |
/// | else | [`Dop853`] |
///
/// The fastest mode is the largest eigenvalue of the exact Jacobian, or the largest pair, found by a fixed number of steps of
/// the power method; where many modes are about as fast, it is exact within a factor of two. [`Auto::choose`] tells what is picked
/// and why.
///
/// What a problem is may change, or be other than the angle tells: a long run of what oscillates slowly goes through a large angle,
/// and what decays fast within a short one need not be worth following. While many steps are left, the fastest mode is looked at after
/// 50 steps, and again whenever half of the steps so far, at least 50, have been added. Where steps of a method for smooth problems go
/// on average through more than 2.5 rad of it, stability keeps them short: the rest of the piece goes on with a method for stiff
/// problems, if it goes through as much as counts as stiff where a mode decays. Where those of a method for stiff problems go through
/// less, the rest goes on with one for smooth problems.
///
/// # Stack
///
/// A run allocates nothing: all it works with is on the stack. Methods for smooth problems keep some tens of vectors there, those
/// for stiff problems keep matrices of `8 N²` bytes each, for `N` states in `f64`. Measured in optimised builds:
///
/// | method | matrices | 400 states |
/// |---|---|---|
/// | [`Rodas4`](crate::Rodas4), [`Rodas5P`], [`Ros2`](crate::Ros2) | 2 | 2.8 MB |
/// | [`ImplicitMidpoint`](crate::ImplicitMidpoint) | 2 | 2.8 MB |
/// | [`Radau5`] | 4 | 5.5 MB |
/// | [`Radau9`] | 6 | 8.1 MB |
/// | `Auto` | one more than what it picks | 1.2 MB more |
///
/// Where steps of an implicit method are checked in between, see [`Adaptive`], it takes one more. With their results,
/// [`Linearised::of`](crate::Linearised::of) takes 7, [`Linearised::held`](crate::Linearised::held) 11, and
/// [`Trim::solve`](crate::Trim::solve) 13. Builds without optimisation copy more and take three to four times as much.
///
/// The main thread has 8 MB on most systems; others, such as those of tests, have 2 MB. A larger model overflows the stack, and the
/// process is aborted. Run it in a thread of its own then, by `std::thread::Builder::new().stack_size(256 << 20).spawn(…)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Auto<'a> {
    /// Tolerance relative to the size of a state.
    pub relative: f64,
    /// Tolerance where a state is near zero, relative to its nominal size.
    pub absolute: f64,
    /// Nominal sizes of the states, in their order, such as from [`Meta::nominal`](crate::Meta::nominal); a state without one has
    /// size 1.
    pub nominal: &'a [f64],
    /// No step is longer, as of [`Adaptive::longest`].
    pub longest: f64,
    /// No more steps than these, as of [`Adaptive::most`].
    pub most: u64,
}

/// A method and why it was picked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Choice {
    /// The method.
    pub method: Picked,
    /// Why.
    pub reason: Reason,
    /// The fastest mode, in rad/s.
    pub fastest: f64,
    /// How long the input has no jump, in s.
    pub horizon: f64,
}

/// A method that [`Auto`] picks from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[allow(missing_docs, reason = "named after the methods")]
pub enum Picked {
    Tsit5,
    Dop853,
    Rodas5P,
    Radau5,
    Radau9,
}

impl Picked {
    /// Whether it is for stiff problems.
    const fn is_for_stiff(self) -> bool {
        matches!(self, Self::Rodas5P | Self::Radau5 | Self::Radau9)
    }
}

/// Why [`Auto`] picked a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// Stiff, to a tight tolerance.
    StiffTight,
    /// Stiff, the fastest mode oscillates, or does not decay alone.
    StiffOscillation,
    /// Stiff, the fastest mode decays.
    StiffDecay,
    /// Little happens before the next jump.
    ShortPiece,
    /// Not stiff, to a loose tolerance.
    Loose,
    /// Not stiff, over a long piece, to a tolerance that is not loose.
    NotStiff,
}

impl fmt::Display for Choice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let method = match self.method {
            Picked::Tsit5 => Tsit5::NAME,
            Picked::Dop853 => Dop853::NAME,
            Picked::Rodas5P => Rodas5P::NAME,
            Picked::Radau5 => Radau5::NAME,
            Picked::Radau9 => Radau9::NAME,
        };
        let reason = match self.reason {
            Reason::StiffTight => "stiff, and the tolerance is tight",
            Reason::StiffOscillation => "stiff, and the fastest mode oscillates",
            Reason::StiffDecay => "stiff, and the fastest mode decays",
            Reason::ShortPiece => "not stiff, and little happens before the next jump",
            Reason::Loose => "not stiff, and the tolerance is loose",
            Reason::NotStiff => "not stiff",
        };
        let Self {
            fastest, horizon, ..
        } = self;
        write!(
            formatter,
            "{method}: {reason}; fastest mode {fastest:.1e} rad/s, {horizon:.1e} s without a jump"
        )
    }
}

impl Auto<'_> {
    /// Picks methods for these relative and absolute tolerances, with no limit to the step and at most a million steps.
    #[must_use]
    pub const fn new(relative: f64, absolute: f64) -> Self {
        Self {
            relative,
            absolute,
            nominal: &[],
            longest: f64::INFINITY,
            most: 1_000_000,
        }
    }

    /// What is picked for the piece that begins at `t0`.
    ///
    /// # Errors
    ///
    /// Times or states that are not finite, a loop that cannot be closed at the start.
    pub fn choose<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        system: &S,
        input: &I,
        t0: T,
        t1: T,
        x0: SVector<T, N>,
    ) -> Result<Choice, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let (mut problem, x) = begin(self, system, input, (t0, t1), x0)?;
        let end = piece_end(system, input, t0, t1)?;
        Ok(self.pick(&mut problem, (t0, end), &x, true))
    }

    /// What to begin with, and why. The fastest mode is known but for a bound unless it `tells`, where that is all the same.
    // The Jacobian leaves the stack before the method begins.
    #[inline(never)]
    fn pick<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (start, end): (T, T),
        x: &SVector<T, N>,
        tells: bool,
    ) -> Choice
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut jacobian = SMatrix::from_element(T::from_f64(0.0));
        problem.jacobian((start, x), None, &mut jacobian);
        let horizon = seen(end - start);
        // Most pieces of a run with many jumps are short, and no mode is to be looked for there.
        let bound = bound(&jacobian, S::SPARSITY);
        let (fastest, decays) = match tells || bound * horizon > pays::<N>() {
            true => fastest(&jacobian, S::SPARSITY),
            false => (bound, false),
        };
        let stiff = if decays { pays::<N>() } else { STIFF };
        let (method, reason) = if fastest * horizon > stiff {
            self.stiff(decays)
        } else if bound * horizon < SHORT {
            (Picked::Tsit5, Reason::ShortPiece)
        } else {
            self.smooth()
        };
        Choice {
            method,
            reason,
            fastest,
            horizon,
        }
    }

    /// The method for a problem that is not stiff, on a long way.
    fn smooth(&self) -> (Picked, Reason) {
        if self.relative > LOOSE {
            (Picked::Tsit5, Reason::Loose)
        } else {
            (Picked::Dop853, Reason::NotStiff)
        }
    }

    /// The method for a stiff problem whose fastest mode decays or oscillates.
    fn stiff(&self, decays: bool) -> (Picked, Reason) {
        if self.relative <= STIFF_TIGHT {
            (Picked::Radau9, Reason::StiffTight)
        } else if decays {
            (Picked::Rodas5P, Reason::StiffDecay)
        } else {
            (Picked::Radau5, Reason::StiffOscillation)
        }
    }

    fn with<M>(&self, method: M) -> Adaptive<'_, M> {
        Adaptive {
            nominal: self.nominal,
            longest: self.longest,
            most: self.most,
            ..Adaptive::new(method, self.relative, self.absolute)
        }
    }
}

/// An angle of a fastest mode that does not decay, in rad, above which it is likely not to be followed.
const STIFF: f64 = 1e4;
/// Up to this relative tolerance the method of high order pays where a problem is stiff.
const STIFF_TIGHT: f64 = 1e-5;
/// An angle of all modes within which long steps do not pay.
const SHORT: f64 = 1.0;
/// Above this relative tolerance the method of low order pays.
const LOOSE: f64 = 1e-4;

#[allow(private_interfaces, reason = "no integrator is written outside")]
impl<const N: usize> Integrator<N> for Auto<'_> {
    fn check_settings<T: Real>(&self, t0: T, t1: T) -> Result<(), Stopped> {
        Integrator::<N>::check_settings(&self.with(Tsit5), t0, t1)
    }

    fn piece<T, S, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (start, end): (T, T),
        x: SVector<T, N>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), SVector<T, N>>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut method = self.pick(problem, (start, end), &x, false).method;
        let (system, input, since) = (problem.system, problem.input, problem.since);
        let mut looks = Looks::from(seen(start));
        let mut here = (start, x);
        loop {
            let (ends, x) = ((here.0, end), here.1);
            let mut other = None;
            let mut watch = |step: &mut Step<'_, T, N, S::Memory>| {
                observer(step)?;
                let t = step.end();
                let Some(length) = looks.after_step(seen(t), seen(end)) else {
                    return ControlFlow::Continue(());
                };
                here = (t, *step.state());
                let u = input.value(t, since);
                let (fastest, decays) = fastest_at(system, t, &here.1, &u, step.memory());
                let is_followed = fastest * length < FOLLOWED;
                let pays = fastest * seen(end - t) > pays::<N>();
                other = match (method.is_for_stiff(), is_followed) {
                    (true, true) => Some(self.smooth().0),
                    (false, false) if pays => Some(self.stiff(decays).0),
                    _ => return ControlFlow::Continue(()),
                };
                ControlFlow::Break(())
            };
            let ended = match method {
                Picked::Tsit5 => self.with(Tsit5).piece(problem, ends, x, &mut watch),
                Picked::Dop853 => self.with(Dop853).piece(problem, ends, x, &mut watch),
                Picked::Rodas5P => self.with(Rodas5P).piece(problem, ends, x, &mut watch),
                Picked::Radau5 => self.with(Radau5).piece(problem, ends, x, &mut watch),
                Picked::Radau9 => self.with(Radau9).piece(problem, ends, x, &mut watch),
            };
            problem.statistics.jacobians += core::mem::take(&mut looks.count);
            method = match other {
                Some(other) => other,
                None => return ended,
            };
        }
    }
}

/// An angle of the fastest mode, in rad, that no step of a method for smooth problems goes through while errors of that mode keep
/// it short, and that is within the bound of stability of them all.
const FOLLOWED: f64 = 2.5;
/// An angle of the fastest mode, in rad, above which it pays to take a method for stiff problems where that mode is not followed: its
/// steps, of which matrices are the larger part where there are many states, are worth so many of the others.
const fn pays<const N: usize>() -> f64 {
    200.0 + 10.0 * N as f64
}

/// When the fastest mode is looked at in a run.
struct Looks {
    count: u64,
    /// Steps taken.
    steps: u64,
    /// Where it was looked at last, in steps and in time.
    last: (u64, f64),
}

impl Looks {
    /// The least number of steps between two, and a share of those taken.
    const APART: u64 = 50;
    const SHARE: u64 = 3;
    /// There is none before so few steps that are left.
    const LEFT: f64 = 150.0;

    const fn from(start: f64) -> Self {
        Self {
            count: 0,
            steps: 0,
            last: (0, start),
        }
    }

    /// The mean length of the steps since the last look, if it is time for another one after a step up to there.
    fn after_step(&mut self, time: f64, end: f64) -> Option<f64> {
        self.steps += 1;
        let (steps, since) = self.last;
        let taken = self.steps - steps;
        let length = (time - since) / taken as f64;
        let is_due = taken >= Self::APART.max(self.steps / Self::SHARE);
        (is_due && end - time >= Self::LEFT * length).then(|| {
            self.last = (self.steps, time);
            self.count += 1;
            length
        })
    }
}

/// What [`fastest`] tells of the Jacobian there.
#[inline(never)]
fn fastest_at<T, S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    t: T,
    x: &SVector<T, N>,
    u: &SVector<T, M>,
    mut memory: S::Memory,
) -> (f64, bool)
where
    T: Real,
    S: System<T, N, M, P>,
{
    let mut derivative = SVector::from_element(T::from_f64(0.0));
    let mut jacobian = SMatrix::from_element(T::from_f64(0.0));
    system.derivative_and_jacobian_into(t, x, u, &mut memory, &mut derivative, &mut jacobian);
    fastest(&jacobian, S::SPARSITY)
}
