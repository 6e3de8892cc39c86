//! What can be asked of everything that integrates.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::Step;
use super::event::Direction;
use super::jumps::{Ran, Runs, walk_over_jumps};
use super::over::Place;
use super::problem::Problem;
use super::slide::{Nowhere, Walked};
use super::sliding::Rooms;
use super::surfaces::{AnySurfaces, Surface};
use super::{Cause, Statistics, Stopped, check_result, check_times, less, piece_end, seen};
use crate::{Input, Real, System};

/// Where and when a run until an event has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Arrival<T, const N: usize> {
    /// The time of the event, or the end.
    pub time: T,
    /// The state there; at an event it is interpolated, with loops closed.
    pub state: SVector<T, N>,
    /// Whether it ended at the event, not at the end of the time.
    pub found: bool,
    /// What the run took.
    pub statistics: Statistics,
}

/// A method with its step size or tolerance: [`Fixed`](super::Fixed), [`Adaptive`](super::Adaptive) or
/// [`Auto`](super::Auto).
///
/// It runs a model in one of four ways: [`integrate`](Self::integrate) shows each step to an observer, [`sample`](Self::sample)
/// gives the state at given times, [`sample_outputs`](Self::sample_outputs) the outputs, too, and [`until`](Self::until) ends at an
/// event.
///
/// Every run
///
/// - starts by closing the loops of the system, and closes them after every step ([`System::close`]);
/// - ends a step at each jump of the input and starts anew after it, however close the next one is;
/// - asks [`System::trouble`] at the start, after each step and after each jump;
/// - begins without the memory of former runs: the first solve of a nonlinear algebraic loop starts at zero. Where such a loop has
///   several solutions, that may be another one than at the end of the run before.
///
/// From then on each solve begins where the one before ended, so that a run stays on its branch of such a loop. Outputs that are
/// worked out from the state with a new memory may be those of another branch: take them by
/// [`sample_outputs`](Integrator::sample_outputs), or begin with [`Step::memory`].
pub trait Integrator<const N: usize> {
    /// Refuses settings that cannot be met.
    #[doc(hidden)]
    fn check_settings<T: Real>(&self, t0: T, t1: T) -> Result<(), Stopped>;

    /// Runs over one piece of the input, from closed loops; gives the state at its end unless the observer breaks off.
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no integrator is written outside")]
    fn piece<T, S, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        ends: (T, T),
        x: SVector<T, N>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), SVector<T, N>>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized;

    /// Runs from `t0` to `t1` until the observer breaks off.
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no integrator is written outside")]
    fn run<T, S, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        (t0, t1): (T, T),
        mut x: SVector<T, N>,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<(), Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut since = t0;
        while less(since, t1) {
            let end = piece_end(problem.system, problem.input, since, t1)?;
            problem.enter((since, end));
            let done = match T::HAS_SLOPES {
                true => over_jumps(self, problem, ((since, x), end), observer),
                false => self.piece(problem, (since, end), x, observer),
            };
            match done.map_err(|stopped| problem.of_input(stopped))? {
                ControlFlow::Continue(next) => x = next,
                ControlFlow::Break(()) => return Ok(()),
            }
            since = end;
        }
        Ok(())
    }

    /// Runs from `t0` to `t1`; `observer` is given each step with its dense output.
    ///
    /// # Errors
    ///
    /// See [`Cause`]: a trouble of the model, a state, derivative or Jacobian that is not finite, a step that became too small or
    /// failed, too many steps.
    fn integrate<T, S, I, const M: usize, const P: usize>(
        &self,
        system: &S,
        input: &I,
        t0: T,
        t1: T,
        x0: SVector<T, N>,
        mut observer: impl FnMut(&mut Step<'_, T, N, S::Memory>),
    ) -> Result<Statistics, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let (mut problem, x) = begin(self, system, input, (t0, t1), x0)?;
        self.run(&mut problem, (t0, t1), x, &mut |step| {
            observer(step);
            ControlFlow::Continue(())
        })?;
        Ok(problem.statistics)
    }

    /// Runs from `t0` to the last of `times`, which must ascend; `observer` is given the state at each of them.
    ///
    /// Between the ends of steps the state is interpolated. The times have no influence on the steps, except that the last step
    /// ends at the last of them.
    ///
    /// # Errors
    ///
    /// As [`Integrator::integrate`], and times that do not ascend or begin before `t0`.
    fn sample<T, S, I, const M: usize, const P: usize>(
        &self,
        system: &S,
        input: &I,
        t0: T,
        x0: SVector<T, N>,
        times: &[T],
        mut observer: impl FnMut(T, &SVector<T, N>),
    ) -> Result<Statistics, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        sample(self, system, input, (t0, times), x0, |t, x, _known| {
            observer(t, x);
        })
    }

    /// As [`sample`](Self::sample), and `observer` is given the outputs, too, for the input at that time. Where a nonlinear loop
    /// has several solutions, they are on the branch of the run. Where the motion stays at a threshold of the laws, laws have their
    /// mean there: friction that holds has the force that holds.
    ///
    /// # Errors
    ///
    /// As [`Integrator::sample`].
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
    ///
    /// mbg! {
    ///     /// A comparator that charges a capacitor until this reaches half of its own output.
    ///     model Astable {
    ///         0 out; 0 minus; 0 plus; 0 ground { Se earth { effort: 0.0 } }
    ///         Se comparator { effort: 10.0 * tanh(1000.0 * (plus.e - minus.e)) } -> out;
    ///         r: Resistor { resistance: 1e4 } (out, minus);
    ///         c: Capacitor { capacitance: 1e-7, initial: 0.1 } (minus, ground);
    ///         above: Resistor { resistance: 1e4 } (out, plus);
    ///         below: Resistor { resistance: 1e4 } (plus, ground);
    ///         output switched: V = out.e;
    ///     }
    /// }
    ///
    /// let model = Astable::<f64>::new(AstableParameters::default())?;
    /// let times: Vec<f64> = (0..100).map(|k| f64::from(k) * 1e-4).collect();
    /// let solver = Adaptive::new(Dop853, 1e-8, 1e-15);
    /// solver.sample_outputs(&model, &(), 0.0, model.initial_state(), &times, |_t, _x, y| {
    ///     assert!(y[0].abs() > 9.9);
    /// })?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn sample_outputs<T, S, I, const M: usize, const P: usize>(
        &self,
        system: &S,
        input: &I,
        t0: T,
        x0: SVector<T, N>,
        times: &[T],
        mut observer: impl FnMut(T, &SVector<T, N>, &SVector<T, P>),
    ) -> Result<Statistics, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let whole = times.last().map_or(0.0, |last| seen(*last - t0));
        sample(self, system, input, (t0, times), x0, |t, x, known| {
            let (mut memory, surfaces) = known;
            let y = match surfaces {
                Some(surfaces) if S::HAS_COURSES => {
                    let known = (surfaces, &mut memory);
                    S::Room::output((system, input), (t, whole), x, known)
                }
                _ => system.output(t, x, &input.at(t), &mut memory),
            };
            observer(t, x, &y);
        })
    }

    /// Runs from `t0` until `guard` goes through zero, at the latest until `t1`; `observer` is given the steps up to the
    /// event, at which the last one ends.
    ///
    /// The time of the event is found as [`Step::crossing`] describes, in a bounded number of evaluations of the guard. To
    /// go on, change the state and run again from there. A guard that is zero at the start, or beyond it by rounding, counts only
    /// when it comes back to zero. If it does so within a hundred thousandth of the first step, that is missed, with all that
    /// follows: a ball that bounces falls through the floor when its flights have become that short. Let it rest before.
    ///
    /// A guard that reads a nonlinear loop with several solutions begins with [`Step::memory`] of the step before, which the
    /// observer leaves in a [`Cell`](core::cell::Cell) for it.
    ///
    /// # Errors
    ///
    /// As [`Integrator::integrate`], and a guard that is not a number.
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::{Adaptive, Direction, Integrator, Stopped, System, Tsit5};
    ///
    /// /// When the first state becomes negative.
    /// fn landing<const P: usize>(model: &impl System<f64, 2, 0, P>) -> Result<Option<f64>, Stopped> {
    ///     let solver = Adaptive::new(Tsit5, 1e-8, 1e-10);
    ///     let start = model.initial_state();
    ///     let height = (Direction::Falling, |_t, x: &nalgebra::SVector<f64, 2>| x[0]);
    ///     let arrival = solver.until(model, &(), 0.0, 10.0, start, height, |_step| ())?;
    ///     Ok(arrival.found.then_some(arrival.time))
    /// }
    /// ```
    #[allow(
        clippy::too_many_arguments,
        reason = "the arguments of a run, and an event"
    )]
    fn until<T, S, I, const M: usize, const P: usize>(
        &self,
        system: &S,
        input: &I,
        t0: T,
        t1: T,
        x0: SVector<T, N>,
        (direction, mut guard): (Direction, impl FnMut(T, &SVector<T, N>) -> T),
        mut observer: impl FnMut(&mut Step<'_, T, N, S::Memory>),
    ) -> Result<Arrival<T, N>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let (mut problem, x) = begin(self, system, input, (t0, t1), x0)?;
        let (mut time, mut state, mut found) = (t1, x, false);
        let mut undefined = None;
        // What is interpolated leaves closed loops by the error of the step. The next run begins on them, and there the guard
        // must have gone through zero, or it would do so once more.
        let closed = |t: T, x: &SVector<T, N>| system.close(t, *x, &input.at(t), &[]).unwrap_or(*x);
        self.run(&mut problem, (t0, t1), x, &mut |step| {
            match step.search(direction, |t, x| guard(t, &closed(t, x))) {
                Ok(None) => {}
                Ok(Some(crossing)) => {
                    (time, found) = (crossing, true);
                    let there = step.at(crossing);
                    step.cut(crossing, closed(crossing, &there));
                }
                Err(time) => {
                    undefined = Some(time);
                    return ControlFlow::Break(());
                }
            }
            state = *step.state();
            observer(step);
            if found {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        if let Some(time) = undefined {
            return Err(Stopped::new(time, Cause::Guard));
        }
        Ok(Arrival {
            time,
            state,
            found,
            statistics: problem.statistics,
        })
    }
}

/// An integrator that runs over parts of a piece.
struct Parts<'a, D: ?Sized>(&'a D);

impl<D: Integrator<N> + ?Sized, T: Real, const N: usize> Runs<T, N> for Parts<'_, D> {
    fn to<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        ((start, x), end): (Place<T, N>, T),
        _watched: f64,
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<Ran<T, N>, Stopped>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        Ok(match self.0.piece(problem, (start, end), x, observer)? {
            ControlFlow::Continue(x) => Ran::To(x),
            ControlFlow::Break(()) => Ran::Left,
        })
    }

    fn length(&self) -> f64 {
        0.0
    }

    fn watched(&mut self, _t: T) -> f64 {
        f64::NEG_INFINITY
    }
}

/// Runs over a piece of the input, where slopes are carried along, and ends steps where laws jump.
fn over_jumps<D, T, S, I, const N: usize, const M: usize, const P: usize>(
    integrator: &D,
    problem: &mut Problem<'_, T, S, I, N, M, P>,
    ends: (Place<T, N>, T),
    observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
) -> Result<ControlFlow<(), SVector<T, N>>, Stopped>
where
    D: Integrator<N> + ?Sized,
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    // Where the next piece begins, it is found that a motion stays there.
    Ok(
        match walk_over_jumps(&mut Parts(integrator), problem, ends, Nowhere, observer)? {
            Walked::Ended(x) | Walked::Stays((_, x), _) => ControlFlow::Continue(x),
            Walked::Left => ControlFlow::Break(()),
        },
    )
}

/// Refuses a sample whose time is not finite, before the start or before the last sample.
fn check_sample<T: Real>(time: T, (t0, last): (T, T)) -> Result<(), Stopped> {
    let refused = |at: T, what| Err(Stopped::new(at, Cause::Argument(what)));
    if !seen(time - t0).is_finite() {
        let what =
            "the times of the start and of samples must be finite, and so must their distance";
        return refused(t0, what);
    }
    if less(time, t0) {
        return refused(time, "no sample may be before the start");
    }
    if less(time, last) {
        return refused(time, "the times of samples must ascend");
    }
    Ok(())
}

/// Runs over the last of the times and gives the state at each, with what the run remembers of nonlinear loops, and the thresholds
/// at which the motion stays.
fn sample<D, T, S, I, const N: usize, const M: usize, const P: usize>(
    integrator: &D,
    system: &S,
    input: &I,
    (t0, times): (T, &[T]),
    x0: SVector<T, N>,
    mut observer: impl FnMut(T, &SVector<T, N>, (S::Memory, Option<&[Surface<T>]>)),
) -> Result<Statistics, Stopped>
where
    D: Integrator<N> + ?Sized,
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let mut last = t0;
    for &time in times {
        check_sample(time, (t0, last))?;
        last = time;
    }
    let (mut problem, x) = begin(integrator, system, input, (t0, last), x0)?;
    let mut rest = times;
    let may_stay = S::HAS_COURSES && times.first().is_some_and(|it| !less(t0, *it));
    let surfaces = may_stay.then(|| problem.at_start((t0, x))).flatten();
    // Of a time that is the start but for its slopes the first step tells.
    let is_start = |time: T| !less(t0, time) && (!T::HAS_SLOPES || time == t0 || !less(t0, last));
    while let [time, others @ ..] = rest
        && is_start(*time)
    {
        let surfaces = surfaces.as_ref().map(AnySurfaces::as_slice);
        observer(*time, &x, (problem.memory, surfaces));
        rest = others;
    }
    integrator.run(&mut problem, (t0, last), x, &mut |step| {
        while let [time, others @ ..] = rest
            && !less(step.end(), *time)
        {
            let known = (step.memory(), step.surfaces);
            let x = match less(*time, step.end()) {
                true => step.at(*time),
                false => step.at_end(*time),
            };
            observer(*time, &x, known);
            rest = others;
        }
        ControlFlow::Continue(())
    })?;
    Ok(problem.statistics)
}

/// Checks what a run is given, and closes the loops of its start.
#[allow(
    clippy::type_complexity,
    reason = "a problem has the parameters of a system"
)]
pub(super) fn begin<'a, D, T, S, I, const N: usize, const M: usize, const P: usize>(
    integrator: &D,
    system: &'a S,
    input: &'a I,
    (t0, t1): (T, T),
    x0: SVector<T, N>,
) -> Result<(Problem<'a, T, S, I, N, M, P>, SVector<T, N>), Stopped>
where
    D: Integrator<N> + ?Sized,
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    check_times(t0, t1)?;
    integrator.check_settings(t0, t1)?;
    let problem = Problem::new(system, input, (t0, t1));
    check_result(system, t0, &x0, &problem.memory)?;
    let x = problem.close(t0, x0)?;
    Ok((problem, x))
}
