//! Steps of constant length.

use nalgebra::SVector;

use super::{
    Cause, Statistics, Stopped, advance, check_finite, check_result, check_times, closed, less,
    magnitude, piece_end, same_time, seen,
};
use crate::{Constant, Input, Real, System};

/// The classical method of Runge and Kutta, of order 4, with four evaluations a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4;

impl Rk4 {
    /// Runs from `t0` to `t1` in steps of `h`.
    ///
    /// The grid is `t0 + k · h`. It starts anew at each jump of the input; the step before a jump, or before `t1`, is
    /// shortened to end there. Where `h` divides the way up to rounding, all steps are equal and no tiny one remains.
    ///
    /// `observer` is given the start and the end of each step. The system is asked for [`System::trouble`] once a
    /// step, at its start.
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
        I: Input<T, M>,
    {
        check_times(t0, t1)?;
        let length = seen(h);
        if !length.is_finite() || length <= 0.0 {
            return Err(Stopped::new(
                t0,
                Cause::Argument("the step must be finite and larger than zero"),
            ));
        }
        if length <= 4.0 * T::EPSILON * magnitude(t0).max(magnitude(t1)) {
            return Err(Stopped::new(t0, Cause::StepTooSmall));
        }
        check_finite(system, t0, &x0)?;

        let mut statistics = Statistics::default();
        let mut memory = S::Memory::default();
        let mut x = closed(system, input, t0, x0)?;
        observer(t0, &x);

        let mut start = t0;
        while less(start, t1) {
            let end = piece_end(input, start, t1, length)?;
            if same_time(start, end, length) {
                start = end;
                continue;
            }
            let (count, step) = divide(start, end, h);
            let mut t = start;
            let mut index = 0;
            while index < count {
                index += 1;
                let next = if index == count {
                    end
                } else {
                    start + T::from_f64(index as f64) * step
                };
                let h = if index == count { end - t } else { step };

                let u = input.value(t, start);
                let k1 = system.derivative(t, &x, &u, &mut memory);
                if let Some(trouble) = system.trouble(t, &x, &u, &memory) {
                    return Err(Stopped::new(t, Cause::Trouble(trouble)));
                }
                x = finish(
                    system,
                    &|t| input.value(t, start),
                    (t, next, h),
                    &x,
                    &k1,
                    &mut memory,
                );
                check_result(system, next, &x, &memory)?;
                x = system
                    .close(next, x, &input.value(next, start), &[])
                    .map_err(|trouble| Stopped::new(next, Cause::Trouble(trouble)))?;
                t = next;
                statistics.steps += 1;
                statistics.evaluations += 4;
                observer(t, &x);
            }
            start = end;
        }
        Ok(statistics)
    }

    /// One step of length `h` from `t` with the input held at `u`, for loops that bring their own clock.
    ///
    /// Nothing is checked: ask [`System::trouble`] and look at the state where it matters.
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
        let input = Constant(*u);
        let k1 = system.derivative(t, x, u, memory);
        finish(
            system,
            &|t| input.value(t, t),
            (t, t + h, h),
            x,
            &k1,
            memory,
        )
    }
}

/// The remaining three stages and the new state.
fn finish<T, S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    input: &impl Fn(T) -> SVector<T, M>,
    (t, next, h): (T, T, T),
    x: &SVector<T, N>,
    k1: &SVector<T, N>,
    memory: &mut S::Memory,
) -> SVector<T, N>
where
    T: Real,
    S: System<T, N, M, P>,
{
    let middle = t + T::from_f64(0.5) * h;
    let u = input(middle);
    let k2 = system.derivative(middle, &advance(x, h, [(0.5, k1)]), &u, memory);
    let k3 = system.derivative(middle, &advance(x, h, [(0.5, &k2)]), &u, memory);
    let k4 = system.derivative(next, &advance(x, h, [(1.0, &k3)]), &input(next), memory);
    advance(
        x,
        h,
        [
            (1.0 / 6.0, k1),
            (1.0 / 3.0, &k2),
            (1.0 / 3.0, &k3),
            (1.0 / 6.0, &k4),
        ],
    )
}

/// Number and length of the steps from `start` to `end`: of length `h`, or what is next to it when `h` divides the
/// way up to rounding.
fn divide<T: Real>(start: T, end: T, h: T) -> (u64, T) {
    let ratio = seen((end - start) / h);
    let whole = ratio as u64;
    let rest = ratio - whole as f64;
    let times = magnitude(start).max(magnitude(end)) / seen(h);
    let rounding = (8.0 * T::EPSILON * (times + ratio)).min(0.25);
    let even = |count: u64| (count, (end - start) / T::from_f64(count as f64));
    if whole > 0 && rest <= rounding {
        even(whole)
    } else if rest >= 1.0 - rounding {
        even(whole.saturating_add(1))
    } else {
        (whole.saturating_add(1), h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::models::{Blocked, Explosion, Oscillator};
    use crate::{Dual, Pulse, Smooth, Trouble};

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

    #[test]
    fn jump_within_rounding_of_the_end_or_of_the_start_takes_no_step() {
        let pulse = |start, end| Pulse {
            amplitude: SVector::from([1.0]),
            start,
            end,
        };
        // 0.1 + 0.2 is the number next to 0.3.
        assert_eq!(last(0.1, 0.1 + 0.2, &pulse(-1.0, 0.3)).1.steps, 3);
        assert_eq!(last(0.1, 0.3, &pulse(0.1 + 0.2 - 0.3, 7.0)).1.steps, 3);
        let (x, _) = last(0.1, 0.1 + 0.2, &pulse(-1.0, 0.3));
        // ẍ + x = 1 from (1, 0) rests.
        assert!((x - SVector::from([1.0, 0.0])).norm() < 1e-15);
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

    #[test]
    fn single_step_is_that_of_the_run() {
        let x = SVector::from([0.3, -0.7]);
        let mut end = x;
        Rk4::fixed(
            &Oscillator,
            &Constant(SVector::from([2.0])),
            0.0,
            0.1,
            0.1,
            x,
            |_, x| end = *x,
        )
        .unwrap();
        assert_eq!(
            Rk4::step(&Oscillator, 0.0, &x, &SVector::from([2.0]), 0.1, &mut ()),
            end
        );
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
        assert_eq!(stopped.cause, Cause::NotFinite { state: "growth" });
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
        for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(run(0.0, 1.0, h, 0.0), Cause::Argument(_)));
        }
        for (t0, t1) in [(1.0, 0.0), (0.0, f64::NAN), (f64::NEG_INFINITY, 0.0)] {
            assert!(matches!(run(t0, t1, 0.1, 0.0), Cause::Argument(_)));
        }
        assert_eq!(run(0.0, 1.0, 1e-17, 0.0), Cause::StepTooSmall);
        assert_eq!(
            run(0.0, 1.0, 0.1, f64::NAN),
            Cause::NotFinite {
                state: "displacement"
            }
        );
    }
}
