//! Steps whose length follows from their error.

use core::ops::Range;

use nalgebra::SVector;

use super::control::{Controller, first_guess, first_step};
use super::dense::Dense;
use super::largest_lane;
use super::outcome::{Cause, Finished, Statistics, Stopped};
use super::tsit5::Stages;
use super::watch::{finite, inspect};
use crate::{Input, Real, System};

/// The pair of Tsitouras, orders 5 and 4, with error control and dense output: the method for smooth models.
///
/// Each step costs six evaluations; the start and every jump of the input cost two more. The error that is estimated
/// is that of one step, as a root mean square over the states in units of
/// `absolute + relative · max(|x before|, |x after|)`; the error of a run is larger, in a stable model by about the
/// number of steps in its memory. With lanes, the worst lane decides for all.
///
/// Steps end exactly at the jumps that the input declares and start afresh there, with a slope, a starting step and a
/// control of their own.
///
/// # Example
///
/// ```
/// # mod model { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/pendulum.rs")); }
/// # use model::Pendulum;
/// use mbg_runtime::{Adaptive, Pulse, System};
/// use nalgebra::SVector;
///
/// let pendulum = Pendulum { gravity: 9.81, damping: 0.1 };
/// let push = Pulse { amplitude: SVector::from([2.0]), start: 1.0, end: 1.1 };
/// let stepper = Adaptive { longest_step: 0.5, ..Adaptive::new(1e-9, 1e-9) };
/// let times = (0..=100).map(|k| 0.1 * f64::from(k));
/// let mut printed = 0;
/// let end = stepper.sample(&pendulum, &push, 0.0..10.0, &pendulum.initial_state(), times, |_t, _x| printed += 1)?;
/// assert_eq!(printed, 101);
/// assert!(end.statistics.steps < 200);
/// # Ok::<(), mbg_runtime::Stopped>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive<A = f64> {
    /// Error allowed where a state is near zero, in the unit of the state: one number for all states, or an array.
    pub absolute: A,
    /// Error allowed as a part of the state.
    pub relative: f64,
    /// Length of the very first step; by default it follows from the first two slopes.
    pub first_step: Option<f64>,
    /// No step is longer; infinite by default. To be set to the shortest feature of an input that declares no jumps.
    pub longest_step: f64,
    /// Steps and refused steps together after which a run stops; a million by default.
    pub most_steps: u64,
}

/// Absolute tolerances: one `f64` for all states, or an array or a vector with one for each.
pub trait Absolute<const N: usize> {
    /// The tolerance of the state `index`.
    fn component(&self, index: usize) -> f64;
}

impl<const N: usize> Absolute<N> for f64 {
    fn component(&self, _index: usize) -> f64 {
        *self
    }
}

impl<const N: usize> Absolute<N> for [f64; N] {
    fn component(&self, index: usize) -> f64 {
        self.get(index).copied().unwrap_or_default()
    }
}

impl<const N: usize> Absolute<N> for SVector<f64, N> {
    fn component(&self, index: usize) -> f64 {
        self.get(index).copied().unwrap_or_default()
    }
}

impl<A> Adaptive<A> {
    /// Control with these tolerances and no other limits than a million steps.
    pub const fn new(absolute: A, relative: f64) -> Self {
        Self { absolute, relative, first_step: None, longest_step: f64::INFINITY, most_steps: 1_000_000 }
    }

    /// Steps through a span of time, and calls `observe` with each accepted step. An empty span makes no step.
    ///
    /// # Errors
    ///
    /// [`Cause::Trouble`], checked at the start and after each accepted step, before it is observed;
    /// [`Cause::NotFinite`] when no step, however short, leads to a finite state; [`Cause::StepTooSmall`] when none
    /// meets the tolerance, as before a singularity or when it is below the precision of the scalar;
    /// [`Cause::TooManySteps`].
    pub fn run<T, const N: usize, const M: usize, const P: usize, S, I>(
        &self,
        system: &S,
        input: &I,
        span: Range<f64>,
        x: &SVector<T, N>,
        mut observe: impl FnMut(&Dense<'_, T, N>),
    ) -> Result<Finished<T, N>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
        A: Absolute<N>,
    {
        let memory = S::Memory::default();
        let mut place = Place { time: span.start, x: *x, memory, statistics: Statistics::default() };
        inspect((system, input), (place.time, x), input.piece(place.time).index, &memory)?;
        let mut first = self.first_step;
        while place.time < span.end {
            let piece = input.piece(place.time);
            let end = piece.end_before(place.time, span.end);
            let leg = Leg { system, input, piece: piece.index, end };
            self.cross(&leg, &mut place, first.take(), &mut observe)?;
        }
        Ok(Finished { time: place.time, state: place.x, statistics: place.statistics })
    }

    /// Steps through a span of time, and calls `observe` with the state at each of the given times inside it.
    ///
    /// The times must ascend; both ends of the span belong to it. The states come from [`Dense::at`], so that the
    /// times have no influence on the steps.
    ///
    /// # Errors
    ///
    /// As [`Adaptive::run`].
    #[expect(clippy::too_many_arguments, reason = "a run and where to look at it")]
    pub fn sample<T, const N: usize, const M: usize, const P: usize, S, I>(
        &self,
        system: &S,
        input: &I,
        span: Range<f64>,
        x: &SVector<T, N>,
        times: impl IntoIterator<Item = f64>,
        mut observe: impl FnMut(f64, &SVector<T, N>),
    ) -> Result<Finished<T, N>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
        A: Absolute<N>,
    {
        let mut times = times.into_iter().skip_while(|time| *time < span.start).peekable();
        while let Some(time) = times.next_if(|time| *time == span.start) {
            observe(time, x);
        }
        self.run(system, input, span, x, |step| {
            while let Some(time) = times.next_if(|time| *time <= step.end()) {
                observe(time, &step.at(time));
            }
        })
    }

    /// Steps to the end of a smooth piece of the input.
    fn cross<T, const N: usize, const M: usize, const P: usize, S, I>(
        &self,
        leg: &Leg<'_, S, I>,
        place: &mut Place<T, N, S::Memory>,
        first: Option<f64>,
        observe: &mut impl FnMut(&Dense<'_, T, N>),
    ) -> Result<(), Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
        A: Absolute<N>,
    {
        let mut slope = leg.derivative(T::from_f64(place.time), &place.x, &mut place.memory);
        place.statistics.evaluations += 1;
        let mut h = first.unwrap_or_else(|| self.starting_step(leg, place, &slope));
        let mut control = Controller::new();
        while place.time < leg.end {
            let end = leg.step_end(place.time, h.min(self.longest_step));
            let length = end - place.time;
            self.check_limits(place, length)?;

            let mut memory = place.memory;
            let derivative = |t, x: &SVector<T, N>| leg.derivative(t, x, &mut memory);
            let (t, step) = (T::from_f64(place.time), T::from_f64(length));
            let stages = Stages::new(derivative, t, &place.x, step, slope);
            place.statistics.evaluations += 6;

            let error = self.error::<T, N, M, P, S>(place, &stages, length);
            if error <= 1.0 {
                inspect((leg.system, leg.input), (end, &stages.end), leg.piece, &memory)?;
                observe(&Dense { start: place.time, end, x: &place.x, stages: &stages });
                slope = stages.slopes[6];
                place.statistics.steps += 1;
                (place.time, place.x, place.memory) = (end, stages.end, memory);
                h = control.accept(length, error);
            } else {
                place.statistics.rejected += 1;
                h = control.refuse(length, error);
                if h <= T::EPSILON * place.time.abs().max(f64::MIN_POSITIVE) {
                    finite::<T, N, M, P, S>(place.time, &stages.end)?;
                    return Err(place.stopped(Cause::StepTooSmall));
                }
            }
        }
        Ok(())
    }

    fn check_limits<T, const N: usize, Memory>(
        &self,
        place: &Place<T, N, Memory>,
        length: f64,
    ) -> Result<(), Stopped> {
        if place.statistics.steps + place.statistics.rejected >= self.most_steps {
            Err(place.stopped(Cause::TooManySteps))
        } else if length > 0.0 {
            Ok(())
        } else {
            Err(place.stopped(Cause::StepTooSmall))
        }
    }

    /// Norm of the estimated error of a step; NaN when the step leads to a state that is not finite.
    fn error<T, const N: usize, const M: usize, const P: usize, S>(
        &self,
        place: &Place<T, N, S::Memory>,
        stages: &Stages<T, N>,
        length: f64,
    ) -> f64
    where
        T: Real,
        S: System<T, N, M, P>,
        A: Absolute<N>,
    {
        if finite::<T, N, M, P, S>(place.time, &stages.end).is_err() {
            return f64::NAN;
        }
        length * self.norm(&stages.error(), &place.x, &stages.end)
    }

    /// Hairer's starting step, at the cost of one evaluation.
    fn starting_step<T, const N: usize, const M: usize, const P: usize, S, I>(
        &self,
        leg: &Leg<'_, S, I>,
        place: &mut Place<T, N, S::Memory>,
        slope: &SVector<T, N>,
    ) -> f64
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
        A: Absolute<N>,
    {
        let x = &place.x;
        let slope_norm = self.norm(slope, x, x);
        let longest = self.longest_step.min(leg.end - place.time);
        let guess = first_guess(self.norm(x, x, x), slope_norm).min(longest);
        let h = T::from_f64(guess);
        let ahead = x.zip_map(slope, |x, slope| x + h * slope);
        let mut memory = place.memory;
        let then = leg.derivative(T::from_f64(place.time) + h, &ahead, &mut memory);
        place.statistics.evaluations += 1;
        let change = then.zip_map(slope, |then, now| then - now);
        first_step(guess, slope_norm, self.norm(&change, x, x) / guess)
    }

    /// Root mean square over the states, in units of the tolerance, of the worst lane.
    fn norm<T: Real, const N: usize>(
        &self,
        values: &SVector<T, N>,
        before: &SVector<T, N>,
        after: &SVector<T, N>,
    ) -> f64
    where
        A: Absolute<N>,
    {
        /// Where both tolerances are zero, an error of zero is still within them.
        const LEAST: f64 = 1e-30;
        let relative = T::from_f64(self.relative);
        let mut sum = T::from_f64(0.0);
        for (index, ((value, before), after)) in values.iter().zip(before).zip(after).enumerate() {
            let absolute = T::from_f64(self.absolute.component(index).max(LEAST));
            let part = *value / (absolute + relative * before.abs().max(after.abs()));
            sum += part * part;
        }
        (largest_lane(sum) / N.max(1) as f64).sqrt()
    }
}

/// A smooth piece of the input, up to a jump or the end of the run.
struct Leg<'a, S, I> {
    system: &'a S,
    input: &'a I,
    piece: usize,
    end: f64,
}

impl<S, I> Leg<'_, S, I> {
    fn derivative<T, const N: usize, const M: usize, const P: usize>(
        &self,
        t: T,
        x: &SVector<T, N>,
        memory: &mut S::Memory,
    ) -> SVector<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.system.derivative(t, x, &self.input.value(self.piece, t), memory)
    }

    /// Where a step of about `h` ends: at the end of the leg when that is nearer, or farther by a hundredth.
    fn step_end(&self, time: f64, h: f64) -> f64 {
        if time + 1.01 * h >= self.end { self.end } else { time + h }
    }
}

/// How far a run has come.
struct Place<T, const N: usize, Memory> {
    time: f64,
    x: SVector<T, N>,
    memory: Memory,
    statistics: Statistics,
}

impl<T, const N: usize, Memory> Place<T, N, Memory> {
    fn stopped(&self, cause: Cause) -> Stopped {
        Stopped { time: self.time, cause }
    }
}
