//! Steps whose length follows the error.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::approach::Come;
use super::control::Control;
use super::crossing::{Crossing, Taken};
use super::dense::Step;
use super::integrator::Integrator;
use super::method::{Estimating, Span, Start, Stepper, along};
use super::over::Place;
use super::pace::Pace;
use super::probes::PARTS;
use super::problem::Problem;
use super::slide::{Ends, Walk, Walked, WalkedOf};
use super::thresholds::Point;
use super::tolerance::Tolerance;
use super::watch::Watch;
use super::{Cause, Stopped, less, seen};
use crate::{Input, Real, System};

/// A method at steps whose length follows its estimate of the error.
///
/// A step is accepted when the root of the mean square of `error / (absolute · nominal + relative · |x|)` over all states is at
/// most 1. Steps end exactly on the jumps of the input and where laws change by time alone ([`System::next_change`]), and the
/// starting step is chosen anew after each.
///
/// # Control of the length
///
/// The length is controlled by the errors and lengths of the step and of the one before, with a proportional and an integral part,
/// for methods of Rosenbrock with a proportional part alone. An error that has grown is expected to go on growing; for explicit
/// methods only where nothing but its state drives the model, so that no pulse is stepped over (all in Gustafsson, *ACM
/// Transactions on Mathematical Software* 20 (1994), 496–517). The starting step follows from the first two derivatives, much as in
/// `dopri5` of Hairer, Nørsett and Wanner.
///
/// On [`Dual`](crate::Dual) numbers, slopes control the step, too, so that those of a model at rest are as exact as those of one
/// that moves. The slopes along each direction are a motion of their own. Its error is small enough when it is no larger part of
/// that motion than the larger tolerance, both in units of the tolerances of states. Slopes that are not finite do not count, nor
/// do any in steps that are no longer than a hundredth of that part of the run.
///
/// # What steps might miss
///
/// Declare the jumps of an input: those that are not declared cost rejected steps, and in single precision the digits of time may
/// be too few for what a stiff model does after one. The input is looked at between the ends of each step, so that no such jump is
/// stepped over while the system is at rest. What is shorter than a sixty-fourth of the longest step may still be missed;
/// [`Adaptive::longest`] is the remedy.
///
/// A model may pulse while all that drives it is smooth, as a rectifier does, whether the source is an input or its own
/// ([`System::AUTONOMOUS`] is `false`). Where an input varies between its jumps or the model depends on time, steps that are
/// long beside those before are therefore checked in between: model and dense output must have much the same derivative.
/// The checks are half as far apart as steps were when they last became short, and a 24th of the time since: what lasts
/// longer is seen, whether it comes once or recurs. At steps of much the same length there are no checks after a while. Where next
/// to nothing moves at the start, the first step is at most a 24th of the run.
///
/// An estimate of the error presumes a smooth solution, and may be small by chance where a pulse or a contact begins. So some steps
/// are checked at three points: in a driven model each step after a refused one, and in any model each step whose estimate has
/// grown by more than its length explains, and each at whose end a choice in the laws has changed ([`System::courses`]). A choice
/// may have two thresholds, such as the ends of a bump over which something rolls from rest. A step that passes both is looked into
/// for whatever lasts longer than its ten millionth part, and so is one in which the argument may come to a threshold and go back,
/// as the distance from a place does that is passed by.
///
/// # Laws that change
///
/// Where a step is refused that goes over such a threshold, the next ones end almost there instead of becoming shorter and shorter, a
/// straight line of at most a hundred millionth of the step leads over it, and the starting step is chosen anew behind it. So
/// friction, relays, cams and contacts cost about three short steps and a start each time that a law changes.
///
/// # Motion that stays at a threshold
///
/// Where a law jumps so that the motion leads back to the threshold from both sides, it stays there: dry friction that holds a load, a
/// clutch whose sides turn together, a controller that switches its force. From there on the state goes along the threshold, by the
/// mean of the derivatives at both sides that does not leave it (Filippov, *Differential Equations with Discontinuous Righthand
/// Sides*, Kluwer 1988, §4), or along up to 64 thresholds at once, by the share of each in the mean (Utkin, *Sliding Modes in
/// Control and Optimization*, Springer 1992, §2). At which of several thresholds it stays is a linear complementarity problem
/// (Murty, *Linear Complementarity*, Heldermann 1988): it may leave one where it meets another, and arguments may depend on each
/// other, as slips of clutches in a ring do. Steps end where a share is used up, as where a force tears a load loose.
///
/// Along a threshold, an evaluation takes one of the model on each side. So does a Jacobian, which neglects the curvature of the
/// argument and counts as dense. A block that friction stops:
///
/// ```
/// use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
///
/// mbg! {
///     /// A block of 1 kg on a floor, pulled by a spring.
///     model Held {
///         1 motion {
///             I block { inertia: 1.0 }
///             C spring { stiffness: 4.0, initial: 3.3 }
///             R floor { effort: 1.0 * sign(f) }
///         }
///         output friction: N = floor.e;
///     }
/// }
///
/// let model = Held::<f64>::new(HeldParameters::default())?;
/// let solver = Adaptive::new(Dop853, 1e-9, 1e-9);
/// solver.sample_outputs(&model, &(), 0.0, model.initial_state(), &[20.0], |_t, x, y| {
///     // Six swings, each 0.5 m less, and one of 0.1 m: friction holds the 0.8 N of the spring.
///     assert!(x[0] == 0.0 && (x[1] - 0.2).abs() < 1e-8 && (y[0] + 0.8).abs() < 1e-8);
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Example
///
/// ```
/// use mbg_runtime::{Adaptive, Integrator, Pulse, Stopped, System, Tsit5};
/// use nalgebra::SVector;
///
/// /// The first state at three times, the model being pushed for half a second.
/// fn push<const P: usize>(model: &impl System<f64, 2, 1, P>) -> Result<[f64; 3], Stopped> {
///     let input = Pulse { amplitude: SVector::from([10.0]), start: 0.5, end: 1.0 };
///     let solver = Adaptive::new(Tsit5, 1e-8, 1e-10);
///     let mut samples = [0.0; 3];
///     let mut slots = samples.iter_mut();
///     solver.sample(model, &input, 0.0, model.initial_state(), &[0.5, 1.0, 2.0], |_t, x| {
///         if let Some(slot) = slots.next() {
///             *slot = x[0];
///         }
///     })?;
///     Ok(samples)
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive<'a, Method> {
    /// The method.
    pub method: Method,
    /// Tolerance relative to the size of a state.
    ///
    /// Explicit methods reduce both tolerances where this one exceeds 1e-2, [`Pirk16`](super::Pirk16) where it exceeds 1e-4: at
    /// looser ones, steps become so long that what decays would grow.
    pub relative: f64,
    /// Tolerance where a state is near zero, relative to its nominal size.
    pub absolute: f64,
    /// Nominal sizes of the states, in their order, such as from [`Meta::nominal`](crate::Meta::nominal); a state without one has
    /// size 1.
    pub nominal: &'a [f64],
    /// The starting step; if `None`, it is chosen from the problem.
    pub first: Option<f64>,
    /// The longest step, but for the rounding of time.
    pub longest: f64,
    /// The most steps of the whole run, rejected ones included.
    pub most: u64,
}

impl<M> Adaptive<'_, M> {
    /// A method with these relative and absolute tolerances, no limit to the step and at most a million steps.
    #[must_use]
    pub const fn new(method: M, relative: f64, absolute: f64) -> Self {
        Self {
            method,
            relative,
            absolute,
            nominal: &[],
            first: None,
            longest: f64::INFINITY,
            most: 1_000_000,
        }
    }
}

#[allow(private_interfaces, reason = "no integrator is written outside")]
impl<Scheme: Estimating, const N: usize> Integrator<N> for Adaptive<'_, Scheme> {
    fn check_settings<T: Real>(&self, t0: T, _t1: T) -> Result<(), Stopped> {
        let positive = |number: f64| number > 0.0;
        let what = if !positive(self.absolute) || !self.absolute.is_finite() {
            "the absolute tolerance must be finite and larger than zero"
        } else if !(self.relative >= 0.0 && self.relative.is_finite()) {
            "the relative tolerance must be finite and not negative"
        } else if self.nominal.len() > N {
            "there are more nominal sizes than states"
        } else if !self
            .nominal
            .iter()
            .all(|it| positive(*it) && it.is_finite())
        {
            "the nominal sizes must be finite and larger than zero"
        } else if !positive(self.longest) || self.first.is_some_and(|first| !positive(first)) {
            "the first and the longest step must be larger than zero"
        } else {
            return Ok(());
        };
        Err(Stopped::new(t0, Cause::Argument(what)))
    }

    // In a caller of several methods, such as `Auto`, their matrices would be on the stack side by side.
    #[inline(never)]
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
        let mut steps = *self;
        steps.over_piece(problem, ((start, x), end), observer)
    }
}

impl<Scheme: Estimating, T: Real, const N: usize> Walk<T, N> for Adaptive<'_, Scheme> {
    const LOOKS_WITHIN: bool = true;

    fn walk<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        ((start, mut x), end): (Place<T, N>, T),
        ends: impl Ends<T, S, I, N, M, P>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<WalkedOf<T, S, N, M, P>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let tolerances = self.tolerances();
        let tolerance = Tolerance::new(tolerances.0, tolerances.1, self.nominal);
        let mut work = Scheme::Work::<T, N>::new(&self.method);
        let mut steps = Crossing::new((&self.method, &mut work), tolerances, self.nominal);
        let mut t = start;
        let mut slope = problem.slope(t, &x);
        problem.check(t, &x, &slope)?;
        let mut pace = Pace::new(self.begin(problem, (t, end), (&x, &slope), &tolerance));
        let mut watch = Watch::new(seen(end - start));
        let place = |time, state, slope| Point { time, state, slope };
        loop {
            self.check_count(problem, t, &pace.control)?;
            let length = steps.length(problem, &(t, x), (pace.control.length, pace.refused));
            if S::HAS_COURSES && pace.is_to_look() {
                let (here, way) = (place(t, x, slope), (length, end, &tolerance));
                if let Some(rest) = ends.rest(problem, &here, way, observer)? {
                    return Ok(rest);
                }
            }
            let length = pace.approach.length(length.min(self.longest));
            let (span, last) = next_span(t, end, length)?;
            if watch.is_blind(problem, &span) {
                problem.statistics.rejected += 1;
                pace.control.shorten(0.5 * seen(span.length));
                continue;
            }
            let from = Start {
                again: pace.again,
                ..Start::of(span, x, slope)
            };
            let memory = problem.memory;
            let wide = steps.tolerance::<S, M, P>().unwrap_or(tolerance);
            let used = &wide.over(seen(span.length) / problem.whole);
            let trial = steps.attempt(problem, &from, used);
            let taken = steps.taken(problem, &from, &trial, used);
            let come = match pace.met(problem, &from, taken, ends.are_all()) {
                Taken::Whole(known, ahead) => {
                    let next = problem.arrive(span.end, known, &ahead)?;
                    let memory = problem.memory;
                    let end = (&next, Some(ahead));
                    let mut dense = |place| steps.samples(problem, &from, end, used, place);
                    let mut step = Step::new(span, (x, next), memory, &mut dense);
                    if observer(&mut step).is_break() {
                        return Ok(Walked::Left);
                    }
                    problem.memory = memory;
                    if last {
                        return Ok(Walked::Ended(next));
                    }
                    let come = pace.accept(problem, &mut steps, (&from, &trial), (&next, &ahead));
                    (t, x, slope) = (span.end, next, ahead);
                    come
                }
                missed => {
                    problem.statistics.rejected += 1;
                    let tried = core::mem::replace(&mut problem.memory, memory);
                    let come = pace.refuse(problem, &steps, (&from, &trial), &missed);
                    if !is_told(pace.control.length, (t, end - start)) {
                        let (here, way) = (place(t, x, slope), (length, end, &tolerance));
                        let rest = ends.rest(problem, &here, way, observer)?;
                        let jacobian = steps.place_of_jacobian(&from);
                        let tried = (&from, &trial.change, &tried);
                        return rest.ok_or_else(|| problem.too_small(tried, jacobian));
                    }
                    come
                }
            };
            if let Come::There(rest) = come {
                let (here, way) = (place(t, x, slope), (rest, seen(span.length), end));
                let (next, watched) = match problem.beyond_threshold(&here, way, ends, observer)? {
                    ControlFlow::Continue(beyond) => beyond,
                    ControlFlow::Break(walked) => return Ok(walked),
                };
                (t, x, slope) = (next.time, next.state, next.slope);
                steps.renew();
                let control = self.begin(problem, (t, end), (&x, &slope), &tolerance);
                pace.begin(control, watched);
            }
        }
    }
}

impl<M: Estimating> Adaptive<'_, M> {
    /// The relative and the absolute tolerance that steps are controlled by.
    fn tolerances(&self) -> (f64, f64) {
        let tighter = (M::LOOSEST / self.relative).min(1.0);
        (tighter * self.relative, tighter * self.absolute)
    }

    /// Refuses to go on behind so many steps.
    fn check_count<T, S, I, const N: usize, const K: usize, const P: usize>(
        &self,
        problem: &Problem<'_, T, S, I, N, K, P>,
        t: T,
        control: &Control,
    ) -> Result<(), Stopped>
    where
        T: Real,
        S: System<T, N, K, P>,
        I: Input<T, K> + ?Sized,
    {
        let statistics = &problem.statistics;
        if statistics.steps.saturating_add(statistics.rejected) < self.most {
            return Ok(());
        }
        let next = control.length.min(self.longest);
        Err(Stopped::new(t, Cause::TooManySteps { next }))
    }

    /// How the length of steps is controlled from here on.
    fn begin<T, S, I, const N: usize, const K: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, K, P>,
        (start, end): (T, T),
        at_start: (&SVector<T, N>, &SVector<T, N>),
        tolerance: &Tolerance<N>,
    ) -> Control
    where
        T: Real,
        S: System<T, N, K, P>,
        I: Input<T, K> + ?Sized,
    {
        let first = self.first_step(problem, (start, end), at_start, tolerance);
        problem.probes.enter(seen(start), first);
        Control::new(M::ESTIMATE_ORDER, first, problem.is_left_alone())
    }

    /// The first step, no shorter than time resolves: it grows from there.
    fn first_step<T, S, I, const N: usize, const K: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, K, P>,
        (start, end): (T, T),
        at_start: (&SVector<T, N>, &SVector<T, N>),
        tolerance: &Tolerance<N>,
    ) -> f64
    where
        T: Real,
        S: System<T, N, K, P>,
        I: Input<T, K> + ?Sized,
    {
        let first = match self.first {
            Some(first) => first,
            None => self.starting_step(problem, (start, end), at_start, tolerance),
        };
        first.max(T::EPSILON * start.magnitude())
    }

    /// A step for which an explicit step of Euler's method is accurate, and the second derivative at its end.
    fn starting_step<T, S, I, const N: usize, const K: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, K, P>,
        (start, end): (T, T),
        (x, slope): (&SVector<T, N>, &SVector<T, N>),
        tolerance: &Tolerance<N>,
    ) -> f64
    where
        T: Real,
        S: System<T, N, K, P>,
        I: Input<T, K> + ?Sized,
    {
        let longest = seen(end - start).min(self.longest);
        // The rule compares derivatives of different order: its unit of time is the second, or for short runs a hundred of them.
        let unit = (100.0 * problem.whole.min(self.longest)).min(1.0);
        let measure = tolerance.around(x);
        let (state, first) = (measure.norm(x), unit * measure.norm(slope));
        let trial = if state <= 1e-5 || first <= 1e-5 {
            1e-6 * unit
        } else {
            0.01 * unit * state / first
        }
        .min(longest);
        // Over rest a step may be as long as the piece, unless input or model may do something in between: then it is a part that
        // is looked into, also where the state creeps by less than a tolerance.
        let way = first * (longest / unit);
        let most = match problem.is_left_alone() {
            true if way <= 1e-5 => longest,
            false if way <= 1.0 => (100.0 * trial).min(longest / PARTS),
            _ => 100.0 * trial,
        };
        let h = T::from_f64(trial);
        let memory = problem.memory;
        let ahead = problem.slope(start + h, &along(x, h, slope));
        problem.memory = memory;
        let second = unit * (unit / trial) * measure.norm(&(ahead - slope));
        let largest = first.max(second);
        let accurate = unit * Real::pow(0.01 / largest, 1.0 / f64::from(M::ESTIMATE_ORDER));
        // An infinite slope ahead gives zero or NaN; the first trial is safer then.
        let step = most.min(accurate).min(longest);
        if step > 0.0 && second.is_finite() {
            step
        } else {
            trial
        }
    }
}

/// No step is a smaller part of a run, near the time zero either. Times near zero are told apart in `f32` as they are in `f64`.
const LEAST: f64 = f64::EPSILON * f64::EPSILON;

/// Whether the end of a step so long is told from its start, in a run over such a time; that of NaN is not.
fn is_told<T: Real>(length: f64, (t, whole): (T, T)) -> bool {
    length > (10.0 * T::EPSILON * t.magnitude()).max(LEAST * seen(whole))
}

/// A step of this length, or up to the end where that is hardly farther; and whether it is the last.
///
/// It is as long as its times are apart, or the rounding of all times would add up to a state of another time.
fn next_span<T: Real>(start: T, end: T, length: f64) -> Result<(Span<T>, bool), Stopped> {
    let ahead = start + T::from_f64(length);
    let last = 1.01 * length >= seen(end - start) || !less(ahead, end);
    let end = if last { end } else { ahead };
    if !less(start, end) {
        return Err(Stopped::new(start, Cause::StepTooSmall));
    }
    let length = end - start;
    Ok((Span { start, end, length }, last))
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::step::models::{Blocked, Explosion, Oscillator};
    use crate::{Constant, Dual, Pulse, Smooth, Statistics, Trouble, Tsit5};

    const STRICT: Adaptive<'static, Tsit5> = Adaptive::new(Tsit5, 1e-10, 1e-12);

    /// `ẍ + x = cos 2t` from (1, 0).
    fn exact(t: f64) -> f64 {
        (4.0 * t.cos() - (2.0 * t).cos()) / 3.0
    }

    /// Errors at the ends of steps and in between, for steps of one length.
    fn errors(h: f64) -> (f64, f64) {
        let pair = Adaptive {
            first: Some(h),
            longest: h,
            ..Adaptive::new(Tsit5, 1e6, 1e6)
        };
        let input = Smooth(|t: f64| SVector::from([(2.0 * t).cos()]));
        let (mut ends, mut inside) = (0.0_f64, 0.0_f64);
        let statistics = pair.integrate(
            &Oscillator,
            &input,
            0.0,
            2.0,
            SVector::from([1.0, 0.0]),
            |step| {
                ends = (step.state()[0] - exact(step.end())).abs();
                assert_eq!(step.at(step.start()), *step.first());
                assert!((step.at(step.end()) - step.state()).norm() < 1e-15);
                for fraction in [0.2, 0.5, 0.7] {
                    let t = step.start() + fraction * (step.end() - step.start());
                    inside = inside.max((step.at(t)[0] - exact(t)).abs());
                }
            },
        );
        assert_eq!(statistics.unwrap().steps, (2.0 / h).round() as u64);
        (ends, inside)
    }

    #[test]
    fn order_is_five_at_the_ends_and_at_least_four_in_between() {
        let (coarse, fine) = (errors(0.1), errors(0.05));
        let order = (coarse.0 / fine.0).log2();
        assert!((order - 5.0).abs() < 0.3, "{order}");
        let order = (coarse.1 / fine.1).log2();
        assert!(order > 3.8, "{order}");
    }

    #[test]
    fn samples_meet_the_tolerance() {
        let input = Smooth(|t: f64| SVector::from([(2.0 * t).cos()]));
        let times: Vec<f64> = (0..=100).map(|k| f64::from(k) * 0.1).collect();
        let mut seen = Vec::new();
        let start = SVector::from([1.0, 0.0]);
        let statistics = STRICT.sample(&Oscillator, &input, 0.0, start, &times, |t, x| {
            assert!((x[0] - exact(t)).abs() < 1e-8, "{t} {}", x[0] - exact(t));
            seen.push(t);
        });
        assert_eq!(seen, times);
        let (attempts, evaluations) = attempts_and_evaluations(statistics);
        assert!(attempts > 50 && attempts < 1000, "{attempts}");
        // What drives the model is smooth, but the run must find that out.
        let probes = evaluations - (6 * attempts + 2);
        assert!(probes > 100 && probes < 220, "{probes}");
    }

    fn attempts_and_evaluations(statistics: Result<Statistics, Stopped>) -> (u64, u64) {
        let Statistics {
            steps,
            rejected,
            evaluations,
            ..
        } = statistics.unwrap();
        (steps + rejected, evaluations)
    }

    #[test]
    fn a_model_left_alone_is_not_probed() {
        let start = SVector::from([1.0, 0.0]);
        let input = Constant(SVector::from([0.3]));
        let statistics = STRICT.integrate(&Oscillator, &input, 0.0, 10.0, start, |_| ());
        let (attempts, evaluations) = attempts_and_evaluations(statistics);
        assert_eq!(evaluations, 6 * attempts + 2);
    }

    #[test]
    fn steps_end_on_jumps() {
        let (start, end, t1) = (0.123_4, 1.037_7, 2.0);
        let input = Pulse {
            amplitude: SVector::from([3.0]),
            start,
            end,
        };
        let exact = f64::cos(t1) + 3.0 * (f64::cos(t1 - end) - f64::cos(t1 - start));
        let mut ends = Vec::new();
        let mut last = SVector::from([1.0, 0.0]);
        STRICT
            .integrate(&Oscillator, &input, 0.0, t1, last, |step| {
                ends.push(step.end());
                last = *step.state();
            })
            .unwrap();
        assert!((last[0] - exact).abs() < 1e-9, "{}", last[0] - exact);
        assert!(ends.contains(&start) && ends.contains(&end) && ends.last() == Some(&t1));
        // Far from rest to rest: the jump is not missed however long the steps have become.
        let input = Pulse {
            amplitude: SVector::from([1.0]),
            start: 1e3,
            end: 1e3 + 1e-3,
        };
        let mut last = SVector::from([0.0, 0.0]);
        Adaptive::new(Tsit5, 1e-6, 1e-9)
            .integrate(&Oscillator, &input, 0.0, 1e3 + 1.0, last, |step| {
                last = *step.state()
            })
            .unwrap();
        assert!(
            (last[0] - 1e-3 * 0.9995_f64.sin()).abs() < 1e-8,
            "{}",
            last[0]
        );
    }

    #[test]
    fn rest_takes_one_step() {
        let rest = SVector::from([0.0, 0.0]);
        let statistics = STRICT.integrate(&Oscillator, &(), 0.0, 1e3, rest, |_| ());
        assert_eq!(statistics.map(|statistics| statistics.steps), Ok(1));
    }

    #[test]
    fn samples_at_the_start_at_jumps_and_twice() {
        let input = Pulse {
            amplitude: SVector::from([1.0]),
            start: 0.3,
            end: 0.6,
        };
        let times = [0.0, 0.0, 0.3, 0.6, 0.6, 0.1 + 0.5 + f64::EPSILON];
        let mut seen = Vec::new();
        let start = SVector::from([0.0, 0.0]);
        STRICT
            .sample(&Oscillator, &input, 0.0, start, &times, |t, x| {
                seen.push((t, x[0]))
            })
            .unwrap();
        assert_eq!(seen.iter().map(|(t, _)| *t).collect::<Vec<_>>(), times);
        let exact = [
            0.0,
            0.0,
            0.0,
            1.0 - 0.3_f64.cos(),
            1.0 - 0.3_f64.cos(),
            1.0 - 0.3_f64.cos(),
        ];
        assert!(
            seen.iter()
                .zip(exact)
                .all(|((_, x), exact)| (x - exact).abs() < 1e-9),
            "{seen:?}"
        );
        assert_eq!(
            STRICT.sample(&Oscillator, &input, 0.0, start, &[], |_, _| ()),
            Ok(Statistics::default())
        );
    }

    #[test]
    fn runs_in_single_precision_and_on_dual_numbers() {
        let mut last = SVector::from([1.0_f32, 0.0]);
        Adaptive::new(Tsit5, 1e-5, 1e-6)
            .integrate(&Oscillator, &(), 0.0, 2.0, last, |step| {
                last = *step.state()
            })
            .unwrap();
        assert!((last[0] - 2.0_f32.cos()).abs() < 1e-4);

        let mut last = SVector::from([Dual::variable(1.0), Dual::constant(0.0)]);
        STRICT
            .integrate(
                &Oscillator,
                &(),
                Dual::constant(0.0),
                Dual::constant(2.0),
                last,
                |step| last = *step.state(),
            )
            .unwrap();
        assert!((last[0].slope - 2.0_f64.cos()).abs() < 1e-9);
    }

    #[test]
    fn stops_name_the_reason() {
        let run = |pair: Adaptive<'_, Tsit5>| {
            pair.integrate(
                &Explosion,
                &(),
                0.0,
                20.0,
                SVector::from([0.5, 1.0]),
                |_| (),
            )
            .unwrap_err()
        };
        let stopped = run(STRICT);
        assert!((stopped.time - 2.0).abs() < 1e-3, "{stopped}");
        assert!(
            matches!(
                stopped.cause,
                Cause::StepTooSmall | Cause::Trouble(Trouble::NotFinite { state: "growth" })
            ),
            "{stopped}"
        );
        let stopped = run(Adaptive { most: 5, ..STRICT });
        assert!(
            matches!(stopped.cause, Cause::TooManySteps { next } if (1e-3..1.0).contains(&next)),
            "{stopped}"
        );
        assert!(matches!(
            run(Adaptive::new(Tsit5, 1e-6, 0.0)).cause,
            Cause::Argument(_)
        ));
        assert!(matches!(
            run(Adaptive::new(Tsit5, f64::NAN, 1e-6)).cause,
            Cause::Argument(_)
        ));

        let pair = Adaptive {
            first: Some(0.125),
            longest: 0.125,
            ..STRICT
        };
        let start = SVector::from([1.0]);
        let stopped = pair
            .integrate(&Blocked, &(), 0.0, 2.0, start, |_| ())
            .unwrap_err();
        assert!(
            matches!(
                stopped.cause,
                Cause::Trouble(Trouble::Singular { name: "block", .. })
            ),
            "{stopped}"
        );
        assert_eq!(stopped.time, 1.0);

        let start = SVector::from([1.0, f64::INFINITY]);
        let stopped = STRICT
            .integrate(&Oscillator, &(), 0.0, 2.0, start, |_| ())
            .unwrap_err();
        assert_eq!(
            stopped.cause,
            Cause::Trouble(Trouble::NotFinite { state: "velocity" })
        );
        for times in [&[1.0, 0.5][..], &[-1.0], &[f64::NAN]] {
            let stopped = STRICT.sample(
                &Oscillator,
                &(),
                0.0,
                SVector::from([1.0, 0.0]),
                times,
                |_, _| (),
            );
            assert!(matches!(stopped.unwrap_err().cause, Cause::Argument(_)));
        }
    }
}
