//! Steps whose length follows the error.

use nalgebra::SVector;

use super::{
    Cause, Statistics, Stopped, advance, check_finite, check_result, check_times, closed, less,
    magnitude, piece_end, same_time, seen, weighted,
};
use crate::scalar::power;
use crate::{Input, Real, System};

/// The pair of Dormand and Prince, of order 5 with an error estimate of order 4 and dense output of order 4.
///
/// Six evaluations a step, since the last stage of a step is the first of the next. Coefficients, step control (PI)
/// and starting step are those of `dopri5` by Hairer, Nørsett and Wanner. An error counts as small enough when the
/// root of the mean square of `error / (absolute + relative · |x|)` over all states is at most 1.
///
/// Steps end exactly on the jumps of the input, and the starting step is chosen anew behind each. With
/// [`Dual`](crate::Dual) numbers the values alone control the step.
///
/// # Example
///
/// ```
/// use mbg_runtime::{DormandPrince, Pulse, Stopped, System};
/// use nalgebra::SVector;
///
/// /// The first state at three times, the model being pushed for half a second.
/// fn push<const P: usize>(model: &impl System<f64, 2, 1, P>) -> Result<[f64; 3], Stopped> {
///     let input = Pulse { amplitude: SVector::from([10.0]), start: 0.5, end: 1.0 };
///     let pair = DormandPrince::new(1e-8, 1e-10);
///     let mut samples = [0.0; 3];
///     let mut slots = samples.iter_mut();
///     pair.sample(model, &input, 0.0, model.initial_state(), &[0.5, 1.0, 2.0], |_t, x| {
///         if let Some(slot) = slots.next() {
///             *slot = x[0];
///         }
///     })?;
///     Ok(samples)
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DormandPrince {
    /// Tolerance in units of the state.
    pub relative: f64,
    /// Tolerance where the state is near zero.
    pub absolute: f64,
    /// The starting step; chosen from the problem when there is none.
    pub first: Option<f64>,
    /// No step is longer.
    pub longest: f64,
    /// No more steps than these, rejected ones included.
    pub most: u64,
}

impl Default for DormandPrince {
    /// Tolerances 1e-6 and 1e-9.
    fn default() -> Self {
        Self::new(1e-6, 1e-9)
    }
}

/// A step with its dense output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dense<T, const N: usize> {
    start: T,
    end: T,
    length: T,
    /// Coefficients of the polynomial in the form of `dopri5`.
    coefficients: [SVector<T, N>; 5],
    state: SVector<T, N>,
}

impl<T: Real, const N: usize> Dense<T, N> {
    /// The time at which the step starts.
    pub fn start(&self) -> T {
        self.start
    }

    /// The time at which the step ends.
    pub fn end(&self) -> T {
        self.end
    }

    /// The state at the end, not interpolated.
    pub fn state(&self) -> &SVector<T, N> {
        &self.state
    }

    /// The state at a time of the step, interpolated with order 4; outside of the step an extrapolation.
    pub fn at(&self, t: T) -> SVector<T, N> {
        let s = (t - self.start) / self.length;
        let rest = T::from_f64(1.0) - s;
        let [c1, c2, c3, c4, c5] = &self.coefficients;
        let inner = c4.zip_map(c5, |a, b| a + rest * b);
        let inner = c3.zip_map(&inner, |a, b| a + s * b);
        let inner = c2.zip_map(&inner, |a, b| a + rest * b);
        c1.zip_map(&inner, |a, b| a + s * b)
    }
}

/// What a run carries from step to step.
struct Run<'a, T, S: System<T, N, M, P>, I, const N: usize, const M: usize, const P: usize>
where
    T: Real,
{
    system: &'a S,
    input: &'a I,
    statistics: Statistics,
    memory: S::Memory,
}

/// A step that has been tried.
struct Trial<T, const N: usize> {
    x: SVector<T, N>,
    slopes: [SVector<T, N>; 7],
    error: f64,
}

impl<T, S, I, const N: usize, const M: usize, const P: usize> Run<'_, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M>,
{
    /// The derivative on the piece of the input that begins at `since`.
    fn slope(&mut self, t: T, x: &SVector<T, N>, since: T) -> SVector<T, N> {
        self.statistics.evaluations += 1;
        self.system
            .derivative(t, x, &self.input.value(t, since), &mut self.memory)
    }

    /// Refuses a point where the state, the derivative or the model is in trouble.
    fn check(
        &self,
        t: T,
        x: &SVector<T, N>,
        slope: &SVector<T, N>,
        since: T,
    ) -> Result<(), Stopped> {
        if let Some(trouble) = self
            .system
            .trouble(t, x, &self.input.value(t, since), &self.memory)
        {
            return Err(Stopped::new(t, Cause::Trouble(trouble)));
        }
        check_finite(self.system, t, x)?;
        check_finite(self.system, t, slope)
    }

    /// The stages of a step from `t` to `end`, of length `h`.
    fn attempt(
        &mut self,
        (t, end, h): (T, T, T),
        x: &SVector<T, N>,
        k1: SVector<T, N>,
        since: T,
    ) -> Trial<T, N> {
        let mut stage =
            |fraction: f64, x: &SVector<T, N>| self.slope(t + T::from_f64(fraction) * h, x, since);
        let k2 = stage(0.2, &advance(x, h, [(0.2, &k1)]));
        let k3 = stage(0.3, &advance(x, h, [(3.0 / 40.0, &k1), (9.0 / 40.0, &k2)]));
        let k4 = stage(
            0.8,
            &advance(
                x,
                h,
                [(44.0 / 45.0, &k1), (-56.0 / 15.0, &k2), (32.0 / 9.0, &k3)],
            ),
        );
        let terms = [
            (19372.0 / 6561.0, &k1),
            (-25360.0 / 2187.0, &k2),
            (64448.0 / 6561.0, &k3),
            (-212.0 / 729.0, &k4),
        ];
        let k5 = stage(8.0 / 9.0, &advance(x, h, terms));
        let terms = [
            (9017.0 / 3168.0, &k1),
            (-355.0 / 33.0, &k2),
            (46732.0 / 5247.0, &k3),
            (49.0 / 176.0, &k4),
            (-5103.0 / 18656.0, &k5),
        ];
        let k6 = self.slope(end, &advance(x, h, terms), since);
        let terms = [
            (35.0 / 384.0, &k1),
            (500.0 / 1113.0, &k3),
            (125.0 / 192.0, &k4),
            (-2187.0 / 6784.0, &k5),
            (11.0 / 84.0, &k6),
        ];
        let next = advance(x, h, terms);
        let k7 = self.slope(end, &next, since);
        Trial {
            x: next,
            slopes: [k1, k2, k3, k4, k5, k6, k7],
            error: f64::NAN,
        }
    }
}

impl<T: Real, const N: usize> Trial<T, N> {
    /// The dense output of a step from `start` to `end`, of length `h`.
    fn dense(&self, (start, end, h): (T, T, T), x: &SVector<T, N>) -> Dense<T, N> {
        let [k1, _, k3, k4, k5, k6, k7] = &self.slopes;
        let change = self.x.zip_map(x, |new, old| new - old);
        let bend = k1.zip_map(&change, |slope, change| h * slope - change);
        let fourth = change.zip_zip_map(k7, &bend, |change, slope, bend| change - h * slope - bend);
        let fifth = weighted([
            (-12_715_105_075.0 / 11_282_082_432.0, k1),
            (87_487_479_700.0 / 32_700_410_799.0, k3),
            (-10_690_763_975.0 / 1_880_347_072.0, k4),
            (701_980_252_875.0 / 199_316_789_632.0, k5),
            (-1_453_857_185.0 / 822_651_844.0, k6),
            (69_997_945.0 / 29_380_423.0, k7),
        ])
        .map(|sum| h * sum);
        Dense {
            start,
            end,
            length: h,
            coefficients: [*x, change, bend, fourth, fifth],
            state: self.x,
        }
    }
}

impl DormandPrince {
    /// A pair with these relative and absolute tolerances, no limit to the step and at most a million steps.
    pub const fn new(relative: f64, absolute: f64) -> Self {
        Self {
            relative,
            absolute,
            first: None,
            longest: f64::INFINITY,
            most: 1_000_000,
        }
    }

    /// Runs from `t0` to `t1`; `observer` is given each step with its dense output.
    ///
    /// The system is asked for [`System::trouble`] at the start, after each step and behind each jump.
    ///
    /// # Errors
    ///
    /// A trouble, a state or derivative that is not finite, a step that became too small, too many steps.
    pub fn integrate<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        system: &S,
        input: &I,
        t0: T,
        t1: T,
        x0: SVector<T, N>,
        mut observer: impl FnMut(&Dense<T, N>),
    ) -> Result<Statistics, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        check_times(t0, t1)?;
        self.check_settings(t0)?;
        check_finite(system, t0, &x0)?;
        let span = seen(t1 - t0);
        let mut run = Run {
            system,
            input,
            statistics: Statistics::default(),
            memory: S::Memory::default(),
        };
        let mut x = closed(system, input, t0, x0)?;
        let mut since = t0;
        while less(since, t1) {
            let end = piece_end(input, since, t1, span)?;
            if !same_time(since, end, span) {
                x = self.piece(&mut run, (since, end), x, &mut observer)?;
            }
            since = end;
        }
        Ok(run.statistics)
    }

    /// Runs from `t0` to the last of `times`, which must ascend; `observer` is given the state at each of them.
    ///
    /// Between the ends of steps it is interpolated. The times have no influence on the steps, but for the last one,
    /// at which the last step ends.
    ///
    /// # Errors
    ///
    /// As [`DormandPrince::integrate`], and times that do not ascend or begin before `t0`.
    pub fn sample<T, S, I, const N: usize, const M: usize, const P: usize>(
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
        I: Input<T, M>,
    {
        let mut earlier = t0;
        for &time in times {
            check_times(t0, time)?;
            if less(time, earlier) {
                return Err(Stopped::new(
                    time,
                    Cause::Argument("the times of samples must ascend"),
                ));
            }
            earlier = time;
        }
        let mut rest = times;
        let mut last = x0;
        while let [time, others @ ..] = rest
            && !less(t0, *time)
        {
            observer(*time, &x0);
            rest = others;
        }
        let statistics = self.integrate(system, input, t0, earlier, x0, |dense| {
            while let [time, others @ ..] = rest
                && !less(dense.end, *time)
            {
                if less(*time, dense.end) {
                    observer(*time, &dense.at(*time));
                } else {
                    observer(*time, &dense.state);
                }
                rest = others;
            }
            last = dense.state;
        })?;
        // Left are times that differ from the end by rounding alone.
        for time in rest {
            observer(*time, &last);
        }
        Ok(statistics)
    }

    /// Runs over one piece of the input.
    fn piece<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        run: &mut Run<'_, T, S, I, N, M, P>,
        (since, end): (T, T),
        mut x: SVector<T, N>,
        observer: &mut impl FnMut(&Dense<T, N>),
    ) -> Result<SVector<T, N>, Stopped>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let mut t = since;
        let mut k1 = run.slope(t, &x, since);
        run.check(t, &x, &k1, since)?;
        let mut h = match self.first {
            Some(first) => first,
            None => self.starting_step(run, (since, end), &x, &k1),
        };
        let mut earlier_error = 1e-4;
        let mut after_rejection = false;
        loop {
            let Statistics {
                steps, rejected, ..
            } = run.statistics;
            if steps.saturating_add(rejected) >= self.most {
                return Err(Stopped::new(t, Cause::TooManySteps));
            }
            h = h.min(self.longest);
            let rest = end - t;
            let last = 1.01 * h >= seen(rest);
            let (next, length) = if last {
                (end, rest)
            } else {
                (t + T::from_f64(h), T::from_f64(h))
            };

            let memory = run.memory;
            let mut trial = run.attempt((t, next, length), &x, k1, since);
            trial.error = self.error(&x, &trial, length);
            // Limits of the change of step, and exponents of the control.
            let needed = power(trial.error, 0.2 - 0.75 * BETA);
            if trial.error <= 1.0 {
                run.statistics.steps += 1;
                let [.., k7] = &trial.slopes;
                run.check(next, &trial.x, k7, since)?;
                let u = run.input.value(next, since);
                trial.x = run
                    .system
                    .close(next, trial.x, &u, &[])
                    .map_err(|trouble| Stopped::new(next, Cause::Trouble(trouble)))?;
                observer(&trial.dense((t, next, length), &x));
                if last {
                    return Ok(trial.x);
                }
                let factor = (needed / power(earlier_error, BETA) / SAFETY).clamp(0.1, 5.0);
                let proposal = seen(length) / factor;
                h = if after_rejection {
                    proposal.min(h)
                } else {
                    proposal
                };
                earlier_error = trial.error.max(1e-4);
                after_rejection = false;
                (t, x, k1) = (next, trial.x, *k7);
            } else {
                run.statistics.rejected += 1;
                let tried = core::mem::replace(&mut run.memory, memory);
                after_rejection = true;
                let finite = trial.error.is_finite();
                h = seen(length)
                    / if finite {
                        (needed / SAFETY).min(5.0)
                    } else {
                        5.0
                    };
                let smallest =
                    T::EPSILON * (10.0 * magnitude(t)).max(T::EPSILON * seen(end - since));
                // Written so that a step of NaN is refused as well.
                if h.is_nan() || h <= smallest {
                    if !finite {
                        check_result(run.system, t, &trial.x, &tried)?;
                        for slope in &trial.slopes {
                            check_result(run.system, t, slope, &tried)?;
                        }
                    }
                    return Err(Stopped::new(t, Cause::StepTooSmall));
                }
            }
        }
    }

    /// The error of a step in units of the tolerance.
    fn error<T: Real, const N: usize>(&self, x: &SVector<T, N>, trial: &Trial<T, N>, h: T) -> f64 {
        let [k1, _, k3, k4, k5, k6, k7] = &trial.slopes;
        let error = weighted([
            (71.0 / 57600.0, k1),
            (-71.0 / 16695.0, k3),
            (71.0 / 1920.0, k4),
            (-17253.0 / 339_200.0, k5),
            (22.0 / 525.0, k6),
            (-1.0 / 40.0, k7),
        ]);
        let larger = x.zip_map(&trial.x, |old, new| old.abs().max(new.abs()));
        seen(h) * self.norm(&error, &larger)
    }

    /// Root of the mean square of `vector / (absolute + relative · |scale|)`.
    fn norm<T: Real, const N: usize>(&self, vector: &SVector<T, N>, scale: &SVector<T, N>) -> f64 {
        let mut sum = 0.0;
        for (component, scale) in vector.iter().zip(scale.iter()) {
            let quotient =
                magnitude(*component) / (self.absolute + self.relative * magnitude(*scale));
            sum += quotient * quotient;
        }
        Real::sqrt(sum / (N.max(1) as f64))
    }

    /// A step for which an explicit step of Euler's method is accurate, and the second derivative at its end.
    fn starting_step<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        run: &mut Run<'_, T, S, I, N, M, P>,
        (start, end): (T, T),
        x: &SVector<T, N>,
        slope: &SVector<T, N>,
    ) -> f64
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let longest = seen(end - start).min(self.longest);
        let (state, first) = (self.norm(x, x), self.norm(slope, x));
        let trial = if state <= 1e-5 || first <= 1e-5 {
            1e-6
        } else {
            0.01 * state / first
        }
        .min(longest);
        let h = T::from_f64(trial);
        let memory = run.memory;
        let ahead = run.slope(start + h, &advance(x, h, [(1.0, slope)]), start);
        run.memory = memory;
        let second = self.norm(&ahead.zip_map(slope, |a, b| a - b), x) / trial;
        let largest = first.max(second);
        let accurate = if largest <= 1e-15 {
            (trial * 1e-3).max(1e-6)
        } else {
            power(0.01 / largest, 0.2)
        };
        // An infinite slope ahead gives zero or NaN; the first trial is safer then.
        let step = (100.0 * trial).min(accurate).min(longest);
        if step > 0.0 && second.is_finite() {
            step
        } else {
            trial
        }
    }

    /// Refuses settings that cannot be met.
    fn check_settings<T: Real>(&self, t0: T) -> Result<(), Stopped> {
        let positive = |number: f64| number > 0.0;
        let what = if !positive(self.absolute) || !self.absolute.is_finite() {
            "the absolute tolerance must be finite and larger than zero"
        } else if !(self.relative >= 0.0 && self.relative.is_finite()) {
            "the relative tolerance must be finite and not negative"
        } else if !positive(self.longest) || self.first.is_some_and(|first| !positive(first)) {
            "the first and the longest step must be larger than zero"
        } else {
            return Ok(());
        };
        Err(Stopped::new(t0, Cause::Argument(what)))
    }
}

/// Weight of the step before in the control of the step.
const BETA: f64 = 0.04;
/// The next step is shorter than the error allows by this factor.
const SAFETY: f64 = 0.9;

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::step::models::{Blocked, Explosion, Oscillator};
    use crate::{Dual, Pulse, Smooth, Trouble};

    const STRICT: DormandPrince = DormandPrince::new(1e-10, 1e-12);

    /// `ẍ + x = cos 2t` from (1, 0).
    fn exact(t: f64) -> f64 {
        (4.0 * t.cos() - (2.0 * t).cos()) / 3.0
    }

    /// Errors at the ends of steps and in between, for steps of one length.
    fn errors(h: f64) -> (f64, f64) {
        let pair = DormandPrince {
            first: Some(h),
            longest: h,
            ..DormandPrince::new(1e6, 1e6)
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
                assert_eq!(step.at(step.start()), step.coefficients[0]);
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
        let Statistics {
            steps,
            rejected,
            evaluations,
        } = statistics.unwrap();
        assert!(steps > 50 && steps < 1000, "{steps}");
        assert_eq!(evaluations, 6 * (steps + rejected) + 2);
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
        DormandPrince::default()
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
        DormandPrince::new(1e-5, 1e-6)
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
        let run = |pair: DormandPrince| {
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
                Cause::StepTooSmall | Cause::NotFinite { state: "growth" }
            ),
            "{stopped}"
        );
        let stopped = run(DormandPrince { most: 5, ..STRICT });
        assert_eq!(stopped.cause, Cause::TooManySteps);
        assert!(matches!(
            run(DormandPrince::new(1e-6, 0.0)).cause,
            Cause::Argument(_)
        ));
        assert!(matches!(
            run(DormandPrince::new(f64::NAN, 1e-6)).cause,
            Cause::Argument(_)
        ));

        let pair = DormandPrince {
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
        assert_eq!(stopped.cause, Cause::NotFinite { state: "velocity" });
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
