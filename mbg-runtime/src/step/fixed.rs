//! Steps of constant length.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::dense::Step;
use super::explicit::Rk4;
use super::integrator::{Integrator, begin};
use super::method::{Method, along};
use super::on_grid::{OnGrid, summed};
use super::problem::Problem;
use super::slide::Walk;
use super::{Cause, Statistics, Stopped, seen};
use crate::{Input, Real, System};

/// A method at steps of constant length.
///
/// # Length of the steps
///
/// Steps end on the grid `t0 + k · h`, which starts anew at each jump of the input. The step before a jump, or before `t1`, is
/// shortened to end there. Where `h` divides the time up to there but for rounding, all steps are equal and no tiny one remains:
/// their length is `h` if the time is `n · h` to the last bit, else next to `h`. So the state advances by exactly the time that is
/// asked for, however many pieces a run has and however its times are rounded.
///
/// # Steps that are too long
///
/// Nothing estimates an error here. With an explicit method whose step is too long for the fastest mode, the state grows from step
/// to step. Such a run ends without an error, with numbers of any size; [`NotFinite`](crate::Trouble::NotFinite) is returned only
/// once one overflows. Look at the states, at [`System::energy`], or at how they change with half the step; or take
/// [`Adaptive`](super::Adaptive).
///
/// # Kinks and jumps of laws
///
/// Where a stiff law has a kink, as where a diode beside a coil begins to block, a step of a method that uses a Jacobian may fail.
/// It is then halved until its stages are found and finite, and the observer is given each part. Methods of Radau then follow the
/// kink. Those of Rosenbrock take a part that fails, too, by Euler's implicit method, where the error of that is less than a
/// thousandth of what states have been; the midpoint rule comes as near to the kink as a tenth of that.
///
/// Where a law jumps because a state goes through a threshold, as with a relay, a contact or dry friction by `sign(f)`, the step
/// ends there and another one begins, up to the end of the step of the grid: no stage is beyond the jump, and the method keeps its
/// order. It goes over kinks, as where a contact begins without a jump, by an error of the order of h², whatever the order of the
/// method. On [`Dual`](crate::Dual) numbers it ends at those kinks at which slopes jump. Where the motion leads back to the
/// threshold from both sides, it stays there, see [`Adaptive`](super::Adaptive): friction holds. Along one threshold a step takes about
/// three times the evaluations.
///
/// Within a step of the grid, at most 64 steps are begun, so that a loop with a clock of its own knows the longest time of a tick:
/// each tick is a run of one step, from zero to `h`.
///
/// Lanes share their steps, which end where a law jumps in any of them. A lane in which the motion stays goes over the threshold to and
/// fro, by an error of the order of the step, and an output is that of one side there. [`Rk4::step`] goes over all jumps. For both, let
/// a law rise over a width.
///
/// ```
/// use mbg_runtime::{Constant, Fixed, Integrator, Rk4, System, mbg};
///
/// mbg! {
///     /// A slide on which dry friction of 1 N acts.
///     model Slide {
///         input force: N;
///         1 motion { I slide { inertia: 2.0 } R guide { effort: 1.0 * sign(f) } Se motor { effort: force } }
///     }
/// }
///
/// let model = Slide::<f32>::new(SlideParameters::default())?;
/// let tick = Fixed::new(Rk4, 1e-3);
/// let mut state = model.initial_state();
/// for force in [0.9, 2.0, 0.5, 0.5, 0.5] {
///     let input = Constant([force].into());
///     tick.integrate(&model, &input, 0.0, 1e-3, state, |step| state = *step.state())?;
/// }
/// // It holds, is torn loose for a tick, and comes to rest.
/// assert!(state[0].abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A law that is steep in one place without a kink and flat beside it, such as dry friction by `tanh`, needs a method of Radau, or
/// [`Adaptive`](super::Adaptive) steps. A step of Rosenbrock that starts where it is flat does not see the steep place, and gives a
/// wrong motion of a block that sticks and slips.
///
/// Next to a singular position of closed loops, a step whose stages are not found is replaced by one of [`Dop853`](super::Dop853)
/// with closed stages, if that is off by no more than 1e-5 of what states have been.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Fixed, Gauss6, Integrator, Stopped, System};
/// use nalgebra::SVector;
///
/// /// The state after 1000 seconds.
/// fn coast<const P: usize>(model: &impl System<f64, 7, 0, P>) -> Result<SVector<f64, 7>, Stopped> {
///     let solver = Fixed::new(Gauss6::default(), 1e-2).compensated();
///     let mut last = model.initial_state();
///     solver.integrate(model, &(), 0.0, 1000.0, last, |step| last = *step.state())?;
///     Ok(last)
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed<Method> {
    /// The method.
    pub method: Method,
    /// Length of a step.
    pub step: f64,
    /// Whether the rounding error of each sum is kept and added to the next step (Kahan's summation).
    pub compensated: bool,
}

impl<M: Method> Fixed<M> {
    /// A method at steps of this length.
    #[must_use]
    pub const fn new(method: M, step: f64) -> Self {
        Self {
            method,
            step,
            compensated: false,
        }
    }

    /// The same with compensated sums: for `f32`, and for long runs of conservative systems.
    #[must_use]
    pub const fn compensated(self) -> Self {
        Self {
            compensated: true,
            ..self
        }
    }
}

#[allow(private_interfaces, reason = "no integrator is written outside")]
impl<Scheme: Method, const N: usize> Integrator<N> for Fixed<Scheme> {
    fn check_settings<T: Real>(&self, t0: T, t1: T) -> Result<(), Stopped> {
        if !self.step.is_finite() || self.step <= 0.0 {
            let what = "the step must be finite and larger than zero";
            return Err(Stopped::new(t0, Cause::Argument(what)));
        }
        if self.step <= 4.0 * T::EPSILON * t0.magnitude().max(t1.magnitude()) {
            let what = "the step is lost in the rounding of so large times: take a longer one, f64, or pieces from zero";
            return Err(Stopped::new(t0, Cause::Argument(what)));
        }
        Ok(())
    }

    // In a caller of several methods their matrices would be on the stack side by side.
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
        OnGrid::new(self, (start, end)).over_piece(problem, ((start, x), end), observer)
    }
}

impl Rk4 {
    /// Runs from `t0` to `t1` in steps of `h`, as [`Fixed`] with [`Rk4`] does; `observer` is given the time and the state at the
    /// start and at the end of each step.
    ///
    /// A loop with a clock of its own takes [`Rk4::step`]: in single precision, times that are summed up step by step drift away,
    /// and after half an hour a millisecond is lost in their rounding. In the same way an angle that grows without bound loses
    /// digits, and closed loops then gape: where the model reads only its sine and cosine, take whole turns off the state between
    /// two steps.
    ///
    /// # Errors
    ///
    /// A trouble, a state that is not finite, a step that is not positive or too small for time to advance by it.
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::{Input, Pulse, Rk4, Stopped, System};
    /// use nalgebra::SVector;
    ///
    /// /// Pushes the model for half a second and gives the state after two.
    /// fn push<const P: usize>(model: &impl System<f64, 2, 1, P>) -> Result<SVector<f64, 2>, Stopped> {
    ///     let input = Pulse { amplitude: SVector::from([10.0]), start: 0.5, end: 1.0 };
    ///     let mut last = model.initial_state();
    ///     Rk4::fixed(model, &input, 0.0, 2.0, 1e-3, last, |_t, x| last = *x)?;
    ///     Ok(last)
    /// }
    /// ```
    pub fn fixed<T, S, I, const N: usize, const M: usize, const P: usize>(
        system: &S,
        input: &I,
        t0: T,
        t1: T,
        h: T,
        x0: SVector<T, N>,
        mut observer: impl FnMut(T, &SVector<T, N>),
    ) -> Result<Statistics, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let fixed = Fixed::new(Self, seen(h));
        let (mut problem, x) = begin(&fixed, system, input, (t0, t1), x0)?;
        observer(t0, &x);
        fixed.run(&mut problem, (t0, t1), x, &mut |step| {
            observer(step.end(), step.state());
            ControlFlow::Continue(())
        })?;
        Ok(problem.statistics)
    }

    /// One step of length `h` from `t` with the input held at `u`, for loops that have their own clock, with the least code
    /// and stack. For a model without attitudes and closed loops it gives the same bits as [`Fixed`] does over a time `t1 - t0`
    /// that is `n · h` to the last bit, where [`FUSED`](crate::FUSED) does not hold.
    ///
    /// Nothing is closed and nothing is checked: unless each step is followed by [`System::close`], attitudes drift from rotations
    /// and closed loops open. Ask [`System::trouble`], which also tells of a state that is not finite.
    ///
    /// ```
    /// use mbg_runtime::{Rk4, System, Trouble};
    /// use nalgebra::SVector;
    ///
    /// /// What a loop does at each tick of its clock.
    /// fn tick<S, const N: usize, const M: usize, const P: usize>(
    ///     model: &S,
    ///     (t, x): (f32, &SVector<f32, N>),
    ///     u: &SVector<f32, M>,
    ///     memory: &mut S::Memory,
    /// ) -> Result<SVector<f32, N>, Trouble>
    /// where
    ///     S: System<f32, N, M, P>,
    /// {
    ///     let h = 1e-3;
    ///     let next = model.close(t + h, Rk4::step(model, t, x, u, h, memory), u, &[])?;
    ///     model.trouble(t + h, &next, u, memory).map_or(Ok(next), Err)
    /// }
    /// ```
    #[must_use]
    #[inline]
    pub fn step<T, S, const N: usize, const M: usize, const P: usize>(
        system: &S,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        h: T,
        memory: &mut S::Memory,
    ) -> SVector<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
    {
        along(x, h, &mean_slope(system, t, x, u, h, memory))
    }

    /// [`Rk4::step`] with compensated sums: `lost` is zero before the first step and goes from each step to the next.
    #[must_use]
    #[inline]
    pub fn compensated_step<T, S, const N: usize, const M: usize, const P: usize>(
        system: &S,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        h: T,
        lost: &mut SVector<T, N>,
        memory: &mut S::Memory,
    ) -> SVector<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
    {
        let slope = mean_slope(system, t, x, u, h, memory);
        summed(x, &slope.map(|slope| h * slope), lost)
    }
}

/// The weighted mean of the four slopes of a step of length `h` from `t` with the input held at `u`.
#[inline(always)]
fn mean_slope<T, S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    t: T,
    x: &SVector<T, N>,
    u: &SVector<T, M>,
    h: T,
    memory: &mut S::Memory,
) -> SVector<T, N>
where
    T: Real,
    S: System<T, N, M, P>,
{
    let mut mean = SVector::from_element(T::from_f64(0.0));
    let (mut stage, mut at) = (*x, t);
    // One evaluation in a loop takes a quarter of the code of four in a row, and less stack.
    for (weight, ahead) in stages(h) {
        let slope = system.derivative(at, &stage, u, memory);
        mean = along(&mean, weight, &slope);
        stage = along(x, ahead, &slope);
        at = t + ahead;
    }
    mean
}

/// The weight of each slope in the mean, and how far ahead the next stage lies, which behind the last is not used.
#[inline(always)]
pub(super) fn stages<T: Real>(h: T) -> [(T, T); 4] {
    let (sixth, third) = (T::from_f64(1.0 / 6.0), T::from_f64(1.0 / 3.0));
    let half = T::from_f64(0.5) * h;
    [(sixth, half), (third, half), (third, h), (sixth, h)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::models::{Blocked, Explosion, Oscillator, Pushed};
    use crate::{Constant, Dual, Pulse, Smooth, Trouble};

    fn last<T: Real>(h: T, t1: T, input: &impl Input<T, 1>) -> (SVector<T, 2>, Statistics) {
        let mut last = SVector::from([T::from_f64(1.0), T::from_f64(0.0)]);
        let statistics = Rk4::fixed(&Oscillator, input, T::from_f64(0.0), t1, h, last, |_, x| {
            last = *x
        })
        .unwrap();
        (last, statistics)
    }

    #[test]
    fn order_is_four() {
        let error = |h| {
            let (x, _) = last(h, 2.0, &Smooth(|t: f64| SVector::from([(2.0 * t).cos()])));
            // ẍ + x = cos 2t, from (1, 0).
            (x[0] - (4.0 / 3.0 * 2.0_f64.cos() - 4.0_f64.cos() / 3.0)).abs()
        };
        let order = (error(0.05) / error(0.025)).log2();
        assert!((order - 4.0).abs() < 0.2, "{order}");
    }

    #[test]
    fn step_that_divides_up_to_rounding_leaves_no_tiny_step() {
        for (h, t1, count) in [
            (0.1, 0.3, 3),
            (0.1, 0.1 + 0.2, 3),
            (0.1, 1.0, 10),
            (1e-3, 100.0, 100_000),
        ] {
            assert_eq!(last(h, t1, &()).1.steps, count, "{h} {t1}");
        }
        for (h, t1, count) in [(0.1_f32, 0.3, 3), (0.1, 1.0, 10), (1e-3, 100.0, 100_000)] {
            assert_eq!(last(h, t1, &()).1.steps, count, "{h} {t1}");
        }
        assert_eq!(last(0.1, 0.35, &()).1.steps, 4);
        assert_eq!(last(1.0, 0.35, &()).1.steps, 1);
        assert_eq!(last(1.0, 0.0, &()).1.steps, 0);
    }

    #[test]
    fn times_are_the_grid_restarted_at_jumps() {
        let input = Pulse {
            amplitude: SVector::from([1.0]),
            start: 0.25,
            end: 0.5,
        };
        let mut times = std::vec::Vec::new();
        Rk4::fixed(
            &Oscillator,
            &input,
            0.0,
            0.7,
            0.1,
            SVector::from([0.0, 0.0]),
            |t, _| times.push(t),
        )
        .unwrap();
        let expected = [0.0, 0.1, 0.2, 0.25, 0.35, 0.45, 0.5, 0.6, 0.7];
        assert_eq!(times.len(), expected.len());
        assert!(
            times
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-15),
            "{times:?}"
        );
        assert_eq!((times[3], times[6], times[8]), (0.25, 0.5, 0.7));
    }

    /// ẍ + x = 1 within the pulse and 0 outside, from (1, 0), by a run and by steps to the beat of a clock.
    #[cfg(feature = "lanes")]
    #[test]
    fn pulses_at_times_of_their_own_in_each_lane_are_met() {
        use crate::lanes::{Lanes, f64x4};

        let (h, ticks) = (0.01, 300);
        let times = [[0.5, 2.0], [1.0, 1.5], [-1.0, 0.25], [2.5, f64::INFINITY]];
        let [start, end] = [0, 1].map(|place| f64x4::from_lanes(|lane| times[lane][place]));
        let amplitude = SVector::from([f64x4::from_f64(1.0)]);
        let pulse = Pulse {
            amplitude,
            start,
            end,
        };
        let time = |tick: i32| f64::from(tick) * h;
        let (run, _) = last(f64x4::from_f64(h), f64x4::from_f64(time(ticks)), &pulse);
        let mut ticked = SVector::from([1.0, 0.0].map(f64x4::from_f64));
        for t in (0..ticks).map(|tick| f64x4::from_f64(time(tick))) {
            let h = f64x4::from_f64(h);
            ticked = Rk4::step(&Oscillator, t, &ticked, &pulse.at(t), h, &mut ());
        }
        for (lane, [start, end]) in times.into_iter().enumerate() {
            let since = |begin: f64| (time(ticks) - f64::max(begin, 0.0)).max(0.0);
            let [pushed, left] = [start, end].map(since);
            let expected = [
                time(ticks).cos() + left.cos() - pushed.cos(),
                pushed.sin() - left.sin() - time(ticks).sin(),
            ];
            for found in [run, ticked] {
                let error = (found.map(|it| it.lane(lane)) - SVector::from(expected)).amax();
                assert!(error < 1e-8, "{lane}: {error:e}");
            }
        }
    }

    #[test]
    fn jump_within_rounding_of_the_end_takes_no_step() {
        let pulse = |start, end| Pulse {
            amplitude: SVector::from([1.0]),
            start,
            end,
        };
        // 0.1 + 0.2 is the number next to 0.3.
        assert_eq!(last(0.1, 0.1 + 0.2, &pulse(-1.0, 0.3)).1.steps, 3);
        let (x, _) = last(0.1, 0.1 + 0.2, &pulse(-1.0, 0.3));
        // ẍ + x = 1 from (1, 0) rests.
        assert!((x - SVector::from([1.0, 0.0])).norm() < 1e-15);
        // Behind the start there is no piece that could go on to the jump.
        assert_eq!(last(0.1, 0.3, &pulse(0.1 + 0.2 - 0.3, 7.0)).1.steps, 4);
    }

    #[test]
    fn pulse_off_the_grid_keeps_the_order() {
        let (start, end, t1) = (0.123_4, 1.037_7, 2.0);
        let input = Pulse {
            amplitude: SVector::from([3.0]),
            start,
            end,
        };
        let exact = f64::cos(t1) + 3.0 * (f64::cos(t1 - end) - f64::cos(t1 - start));
        let error = |h| (last(h, t1, &input).0[0] - exact).abs();
        let order = (error(0.05) / error(0.0125)).log2() / 2.0;
        assert!((order - 4.0).abs() < 0.2, "{order}");
        assert!(error(1e-3) < 1e-12);
    }

    #[test]
    fn runs_on_dual_numbers() {
        // The derivative of the end with respect to the initial displacement is the free oscillation.
        let mut last = SVector::from([Dual::variable(1.0), Dual::constant(0.0)]);
        let time = Dual::constant;
        Rk4::fixed(
            &Oscillator,
            &(),
            time(0.0),
            time(2.0),
            time(0.01),
            last,
            |_, x| last = *x,
        )
        .unwrap();
        assert!((last[0].slope - 2.0_f64.cos()).abs() < 1e-8);
        assert!((last[1].slope + 2.0_f64.sin()).abs() < 1e-8);
    }

    /// Ends of so many steps in a run and one by one, plain and compensated.
    fn ends<T: Real>(t0: f64, h: f64, count: u32) -> [[SVector<T, 2>; 2]; 2] {
        let [t0, h] = [t0, h].map(T::from_f64);
        let t1 = t0 + T::from_f64(f64::from(count)) * h;
        let start = SVector::from([0.3, -0.7].map(T::from_f64));
        let u = SVector::from([T::from_f64(2.0)]);
        let solver = Fixed::new(Rk4, seen(h));
        let runs = [solver, solver.compensated()].map(|solver| {
            let mut end = start;
            solver
                .integrate(&Oscillator, &Constant(u), t0, t1, start, |step| {
                    end = *step.state()
                })
                .unwrap();
            end
        });
        let zero = SVector::from_element(T::from_f64(0.0));
        let (mut plain, mut compensated, mut lost) = (start, start, zero);
        for _ in 0..count {
            plain = Rk4::step(&Oscillator, t0, &plain, &u, h, &mut ());
            compensated =
                Rk4::compensated_step(&Oscillator, t0, &compensated, &u, h, &mut lost, &mut ());
        }
        [runs, [plain, compensated]]
    }

    #[test]
    fn single_steps_are_those_of_a_run_to_the_last() {
        fn compare<T: Real>(t0: f64, h: f64, count: u32) {
            let [runs, singles] = ends::<T>(t0, h, count);
            // Runs multiply and add in one rounding where the processor does, single steps in two everywhere.
            let same = runs == singles || crate::FUSED;
            assert!(same, "{t0} {h} {count}: {runs:?} {singles:?}");
            for (run, single) in runs.iter().zip(&singles) {
                let distance = (run - single)
                    .iter()
                    .fold(0.0, |largest: f64, it| largest.max(it.magnitude()));
                assert!(distance <= f64::from(count) * T::EPSILON, "{distance:e}");
            }
        }
        for (h, count) in [(1e-3, 1000), (1e-2, 1000), (1e-2, 30_000), (0.1, 3)] {
            compare::<f32>(0.0, h, count);
            compare::<f64>(0.0, h, count);
        }
        for t0 in [-0.7, 1e3, 1e6, 1e9] {
            compare::<f64>(t0, 0.015_625, 1000);
        }
        compare::<f64>(1e9, 1e-3, 1000);
        let [[plain, compensated], _] = ends::<f32>(0.0, 0.007_812_5, 128);
        assert_ne!(plain, compensated);
    }

    /// What follows from an input that changes at every sample: rounding of the times must not add up.
    #[test]
    fn pieces_are_as_long_as_their_times_are_apart() {
        fn advanced<T: Real>(t0: f64, samples: u32, every: f64) -> (T, T) {
            let time = |k: u32| T::from_f64(t0 + every * f64::from(k));
            let number = T::from_f64;
            let mut x = SVector::from([number(0.0)]);
            let solver = Fixed::new(Rk4, every).compensated();
            let mut expected = number(0.0);
            for k in 0..samples {
                // Times of samples in a row round to either side in turns.
                let push = SVector::from([number(if k % 2 == 0 { 0.875 } else { 1.125 })]);
                let span = (time(k), time(k + 1));
                expected += push[0] * (span.1 - span.0);
                let input = Constant(push);
                solver
                    .integrate(&Pushed, &input, span.0, span.1, x, |step| x = *step.state())
                    .unwrap();
            }
            (x[0], expected)
        }
        let (moved, expected) = advanced::<f64>(1.7e9, 2000, 1e-3);
        assert!((moved - expected).abs() < 1e-11, "{moved} {expected}");
        let (moved, expected) = advanced::<f32>(0.0, 20_000, 1e-3);
        assert!((moved - expected).abs() < 1e-2, "{moved} {expected}");
    }

    #[test]
    fn a_shorter_last_step_meets_the_end_far_from_zero() {
        let (t0, way) = (1e9, 1.000_5);
        let mut last = SVector::from([1.0, 0.0]);
        let t1 = t0 + way;
        Fixed::new(Rk4, 1e-3)
            .integrate(&Oscillator, &(), t0, t1, last, |step| last = *step.state())
            .unwrap();
        let error = last[0] - f64::cos(t1 - t0);
        assert!(error.abs() < 1e-12, "{error:e}");
    }

    #[test]
    fn stops_name_the_reason() {
        let stopped = Rk4::fixed(
            &Explosion,
            &(),
            0.0,
            20.0,
            0.1,
            SVector::from([0.5, 1.0]),
            |_, _| (),
        )
        .unwrap_err();
        assert_eq!(
            stopped.cause,
            Cause::Trouble(Trouble::NotFinite { state: "growth" })
        );
        assert!(stopped.time > 1.0 && stopped.time < 3.0, "{stopped}");
        assert!(
            std::format!("{stopped}").ends_with(": state `growth` or its derivative is not finite")
        );

        let mut seen = 0.0;
        let stopped = Rk4::fixed(
            &Blocked,
            &(),
            0.0,
            2.0,
            0.125,
            SVector::from([1.0]),
            |t, _| seen = t,
        )
        .unwrap_err();
        assert_eq!(stopped.time, 1.0);
        assert!(
            matches!(stopped.cause, Cause::Trouble(Trouble::Singular { name: "block", value }) if value.abs() < 1e-15)
        );
        assert_eq!(seen, 1.0);
        assert!(std::format!("{stopped}").starts_with("stopped at t = 1: block is "));
    }

    #[test]
    fn arguments_are_checked() {
        let run = |t0: f64, t1: f64, h: f64, x: f64| {
            Rk4::fixed(
                &Oscillator,
                &(),
                t0,
                t1,
                h,
                SVector::from([x, 0.0]),
                |_, _| (),
            )
            .unwrap_err()
            .cause
        };
        for h in [0.0, -1.0, 1e-17, f64::NAN, f64::INFINITY] {
            assert!(matches!(run(0.0, 1.0, h, 0.0), Cause::Argument(_)));
        }
        for (t0, t1) in [(1.0, 0.0), (0.0, f64::NAN), (f64::NEG_INFINITY, 0.0)] {
            assert!(matches!(run(t0, t1, 0.1, 0.0), Cause::Argument(_)));
        }
        assert_eq!(
            run(0.0, 1.0, 0.1, f64::NAN),
            Cause::Trouble(Trouble::NotFinite {
                state: "displacement"
            })
        );
    }
}
