//! Inputs given by values at times.

use core::fmt;

use nalgebra::SVector;

use super::{Input, zero};
use crate::Real;
use crate::step::{less, seen};

/// How many samples are looked at for the next jump, so that short runs over a long log take no longer than over a short one.
const NEAR: usize = 64;

/// Values at times: a recorded log, a schedule, set points.
///
/// Before the first time the first value holds, behind the last time the last one. Steps end where a held value changes
/// and where a line may have a kink; of samples that repeat the value before them only each 64th ends a step.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Input, SampleError, Sampled};
/// use nalgebra::SVector;
///
/// let times = [0.0, 0.5, 2.0];
/// let values = [0.0, 1.0, 4.0].map(|value| SVector::from([value]));
/// let held = Sampled::held(&times, &values)?;
/// let linear = Sampled::linear(&times, &values)?;
/// assert_eq!([0.4, 0.5, 1.0, 9.0].map(|t| held.at(t)[0]), [0.0, 1.0, 1.0, 4.0]);
/// assert_eq!([0.4, 0.5, 1.0, 9.0].map(|t| linear.at(t)[0]), [0.8, 1.0, 2.0, 4.0]);
/// assert_eq!(linear.next_jump(0.0), Some(0.5));
/// # Ok::<(), SampleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled<'a, T, const M: usize> {
    times: &'a [T],
    values: &'a [SVector<T, M>],
    is_linear: bool,
}

/// Why samples are no input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SampleError {
    /// There are none.
    Empty,
    /// There are not as many values as times.
    Lengths {
        /// How many times.
        times: usize,
        /// How many values.
        values: usize,
    },
    /// A time is not finite, or not the same in all lanes.
    Time {
        /// Which sample, from 0.
        index: usize,
    },
    /// A time is not later than the one before. Between lines one time may stand twice, which makes a jump.
    Order {
        /// Which sample, from 0.
        index: usize,
    },
    /// A value is not finite.
    Value {
        /// Which sample, from 0.
        index: usize,
    },
    /// The slope of the line to a sample is not finite.
    Slope {
        /// Which sample, from 0.
        index: usize,
    },
}

impl fmt::Display for SampleError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => formatter.write_str("there are no samples"),
            Self::Lengths { times, values } => {
                write!(formatter, "there are {times} times and {values} values")
            }
            Self::Time { index } => write!(
                formatter,
                "the time of sample {index} is not finite, or not the same in all lanes"
            ),
            Self::Order { index } => write!(
                formatter,
                "the time of sample {index} is not later than the one before"
            ),
            Self::Value { index } => write!(formatter, "the value of sample {index} is not finite"),
            Self::Slope { index } => write!(
                formatter,
                "the slope of the line to sample {index} is not finite"
            ),
        }
    }
}

impl core::error::Error for SampleError {}

impl<'a, T: Real, const M: usize> Sampled<'a, T, M> {
    /// Each value from its time up to the next one.
    ///
    /// # Errors
    ///
    /// There must be as many values as times, at least one, all finite, and each time later than the one before.
    pub fn held(times: &'a [T], values: &'a [SVector<T, M>]) -> Result<Self, SampleError> {
        Self {
            times,
            values,
            is_linear: false,
        }
        .checked()
    }

    /// Straight lines from each value to the next one. A time that stands twice makes a jump from the first value there to
    /// the second.
    ///
    /// # Errors
    ///
    /// As of [`held`](Self::held), but that a time may stand twice; and each line must have a finite slope.
    pub fn linear(times: &'a [T], values: &'a [SVector<T, M>]) -> Result<Self, SampleError> {
        Self {
            times,
            values,
            is_linear: true,
        }
        .checked()
    }

    fn checked(self) -> Result<Self, SampleError> {
        let [times, values] = [self.times.len(), self.values.len()];
        if times != values {
            return Err(SampleError::Lengths { times, values });
        }
        if times == 0 {
            return Err(SampleError::Empty);
        }
        let mut former: Option<Sample<T, M>> = None;
        let mut is_second = false;
        for (index, (&time, &value)) in self.times.iter().zip(self.values).enumerate() {
            let sample = Sample { time, value };
            if time
                .find(|lane| !lane.is_finite() || lane != seen(time))
                .is_some()
            {
                return Err(SampleError::Time { index });
            }
            if !are_finite(&value) {
                return Err(SampleError::Value { index });
            }
            if let Some(former) = former.replace(sample) {
                let is_later = less(former.time, time);
                let is_repeated = !is_later && !less(time, former.time);
                let is_jump = self.is_linear && is_repeated && !is_second;
                if !(is_later || is_jump) {
                    return Err(SampleError::Order { index });
                }
                let line = Line(former, sample);
                if self.is_linear && is_later && !line.is_finite() {
                    return Err(SampleError::Slope { index });
                }
                is_second = is_repeated;
            }
        }
        Ok(self)
    }

    /// How many samples are not later than `t`.
    fn passed(&self, t: T) -> usize {
        self.times.partition_point(|time| !less(t, *time))
    }

    /// The line on which `t` lies; none before the first sample, behind the last one, and where values are held.
    fn line(&self, t: T) -> Option<Line<T, M>> {
        let next = self.passed(t);
        let former = self.sample(next.checked_sub(1)?)?;
        Some(Line(former, self.sample(next)?)).filter(|_| self.is_linear)
    }

    fn sample(&self, index: usize) -> Option<Sample<T, M>> {
        let (&time, &value) = self.times.get(index).zip(self.values.get(index))?;
        Some(Sample { time, value })
    }

    /// Whether the value changes to a sample or, along a line, from it.
    fn is_jump(&self, index: usize) -> bool {
        let changes = |former: usize| {
            let next = self.values.get(former.saturating_add(1));
            next.is_some_and(|next| self.values.get(former) != Some(next))
        };
        index.checked_sub(1).is_some_and(changes) || self.is_linear && changes(index)
    }
}

impl<T: Real, const M: usize> Input<T, M> for Sampled<'_, T, M> {
    fn value(&self, t: T, since: T) -> SVector<T, M> {
        if let Some(line) = self.line(since) {
            return line.value(t);
        }
        let nearest = self.values.get(self.passed(since).saturating_sub(1));
        nearest.copied().unwrap_or_else(zero)
    }

    fn next_jump(&self, t: T) -> Option<T> {
        let next = self.passed(t);
        let mut near = self.times.iter().enumerate().skip(next).take(NEAR);
        let jump = near.clone().find(|(index, _)| self.is_jump(*index));
        let last = || near.nth(NEAR - 1);
        jump.or_else(last).map(|(_, time)| *time)
    }

    fn rate(&self, _t: T, since: T, _ahead: T) -> SVector<T, M> {
        self.line(since).map_or_else(zero, |line| line.slope())
    }

    fn is_constant_between_jumps(&self) -> bool {
        !self.is_linear
    }
}

#[derive(Clone, Copy)]
struct Sample<T, const M: usize> {
    time: T,
    value: SVector<T, M>,
}

/// From one sample to a later one, and on beyond it.
struct Line<T, const M: usize>(Sample<T, M>, Sample<T, M>);

impl<T: Real, const M: usize> Line<T, M> {
    fn value(&self, t: T) -> SVector<T, M> {
        let part = (t - self.0.time) / (self.1.time - self.0.time);
        let way = |a, b| a + part * (b - a);
        self.0.value.zip_map(&self.1.value, way)
    }

    fn slope(&self) -> SVector<T, M> {
        let length = self.1.time - self.0.time;
        let way = |a, b| (b - a) / length;
        self.0.value.zip_map(&self.1.value, way)
    }

    fn is_finite(&self) -> bool {
        (self.1.time - self.0.time).magnitude().is_finite() && are_finite(&self.slope())
    }
}

fn are_finite<T: Real, const M: usize>(vector: &SVector<T, M>) -> bool {
    vector.iter().all(|it| it.magnitude().is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dual, Sum};

    type Values<const N: usize> = [SVector<f64, 1>; N];

    fn values<const N: usize>(values: [f64; N]) -> Values<N> {
        values.map(|value| SVector::from([value]))
    }

    #[test]
    fn held_values_stay_up_to_the_next_sample() {
        let times = [1.0, 2.0, 4.0, 5.0];
        let values = values([3.0, -1.0, -1.0, 2.0]);
        let input = Sampled::held(&times, &values).unwrap();
        let at = [0.0, 1.0, 1.9, 2.0, 3.0, 4.0, 4.9, 5.0, 9.0].map(|t| input.at(t)[0]);
        assert_eq!(at, [3.0, 3.0, 3.0, -1.0, -1.0, -1.0, -1.0, 2.0, 2.0]);
        // Up to the end of a piece, and a rounding beyond.
        assert_eq!(input.value(2.0, 1.5)[0], 3.0);
        assert_eq!(input.value(5.0_f64.next_up(), 2.0)[0], -1.0);
        // Neither the first value nor one that stays is a jump.
        let jumps = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|t| input.next_jump(t));
        let five = Some(5.0);
        assert_eq!(jumps, [Some(2.0), Some(2.0), five, five, five, None]);
        assert_eq!(input.rate(1.5, 1.0, 0.1)[0], 0.0);
    }

    #[test]
    fn lines_run_from_sample_to_sample() {
        let times = [1.0, 2.0, 4.0, 5.0, 6.0, 7.0];
        let values = values([3.0, -1.0, 1.0, 1.0, 1.0, 0.0]);
        let input = Sampled::linear(&times, &values).unwrap();
        let at = [0.0, 1.0, 1.5, 2.0, 3.5, 4.5, 5.5, 6.5, 9.0].map(|t| input.at(t)[0]);
        assert_eq!(at, [3.0, 3.0, 1.0, -1.0, 0.5, 1.0, 1.0, 0.5, 0.0]);
        let rates = [0.0, 1.0, 2.0, 3.0, 4.0, 5.5, 6.0, 7.0].map(|t| input.rate(t, t, 0.1)[0]);
        assert_eq!(rates, [0.0, -4.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0]);
        // Each piece goes on beyond its end.
        assert_eq!(input.value(2.25, 1.5)[0], -2.0);
        assert_eq!(input.value(1.25, 0.5)[0], 3.0);
        assert_eq!(input.rate(2.0, 1.5, 0.1)[0], -4.0);
        // The sample at 5 lies on one line with its neighbours, which is level.
        let jumps = [0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0].map(|t| input.next_jump(t));
        let (six, seven) = (Some(6.0), Some(7.0));
        assert_eq!(
            jumps,
            [Some(1.0), Some(2.0), Some(4.0), six, six, seven, None]
        );
    }

    #[test]
    fn a_line_jumps_where_a_time_stands_twice() {
        let times = [0.0, 1.0, 1.0, 2.0];
        let values = values([0.0, 2.0, 5.0, 5.0]);
        let input = Sampled::linear(&times, &values).unwrap();
        assert_eq!([0.5, 1.0, 1.5].map(|t| input.at(t)[0]), [1.0, 5.0, 5.0]);
        assert_eq!(input.value(1.0, 0.5)[0], 2.0);
        assert_eq!(
            [0.5, 1.0].map(|t| input.next_jump(t)),
            [Some(1.0), None],
            "it is level behind the jump"
        );
        let both = Sum(input, Sampled::held(&times[2..], &values[2..]).unwrap());
        assert_eq!(both.value(1.0, 0.5)[0], 7.0);
    }

    #[test]
    fn no_more_than_a_few_samples_are_looked_at() {
        let times: [f64; 200] = core::array::from_fn(|index| index as f64);
        let mut values = values([1.0; 200]);
        values[150][0] = 2.0;
        let input = Sampled::held(&times, &values).unwrap();
        let jumps = [0.0, 64.0, 100.0, 150.0, 151.0].map(|t| input.next_jump(t));
        assert_eq!(
            jumps,
            [Some(64.0), Some(128.0), Some(150.0), Some(151.0), None]
        );
    }

    #[test]
    fn one_sample_is_a_constant() {
        let (times, values) = ([1.0], values([2.0]));
        for input in [
            Sampled::held(&times, &values),
            Sampled::linear(&times, &values),
        ] {
            let input = input.unwrap();
            assert_eq!([0.0, 1.0, 3.0].map(|t| input.at(t)[0]), [2.0; 3]);
            assert_eq!([0.0, 1.0, 3.0].map(|t| input.next_jump(t)), [None; 3]);
            assert!(input.at(f64::NAN)[0].is_finite());
        }
    }

    #[test]
    fn samples_that_are_no_input_are_refused() {
        use SampleError::{Empty, Lengths, Order, Slope, Time, Value};
        let both = |times: &[f64], values: &[f64]| {
            let values: std::vec::Vec<_> = values.iter().map(|it| SVector::from([*it])).collect();
            [
                Sampled::held(times, &values).err(),
                Sampled::linear(times, &values).err(),
            ]
        };
        let same = |error| [Some(error); 2];
        assert_eq!(both(&[], &[]), same(Empty));
        let (times, values) = (1, 2);
        assert_eq!(both(&[0.0], &[0.0, 1.0]), same(Lengths { times, values }));
        let index = 1;
        for time in [f64::NAN, f64::INFINITY] {
            assert_eq!(both(&[0.0, time], &[0.0, 1.0]), same(Time { index }));
        }
        assert_eq!(both(&[0.0, 1.0], &[0.0, f64::NAN]), same(Value { index }));
        assert_eq!(both(&[0.0, -1.0], &[0.0, 1.0]), same(Order { index }));
        assert_eq!(
            both(&[0.0, 0.0], &[0.0, 1.0]),
            [Some(Order { index }), None]
        );
        let thrice = both(&[0.0, 0.0, 0.0], &[0.0, 1.0, 2.0]);
        assert_eq!(thrice, [Some(Order { index }), Some(Order { index: 2 })]);
        for (times, values) in [([0.0, 1e-300], [0.0, 1e9]), ([-1e308, 1e308], [0.0, 1.0])] {
            assert_eq!(both(&times, &values), [None, Some(Slope { index })]);
        }
        let text = std::string::ToString::to_string(&Order { index });
        assert_eq!(
            text,
            "the time of sample 1 is not later than the one before"
        );
    }

    /// The slope by a sample's value, and by time.
    #[test]
    fn lines_have_slopes_on_dual_numbers() {
        let times = [1.0, 3.0].map(Dual::constant);
        let values = [Dual::constant(2.0), Dual::variable(6.0)].map(|it| SVector::from([it]));
        let input = Sampled::linear(&times, &values).unwrap();
        let since = Dual::constant(1.0);
        let found = input.value(Dual::constant(1.5), since)[0];
        assert_eq!((found.value, found.slope), (3.0, 0.25));
        let rate = input.rate(since, since, since)[0];
        assert_eq!((rate.value, rate.slope), (2.0, 0.5));
        let times = [Dual::constant(1.0), Dual::constant(3.0)];
        let values = [2.0, 6.0].map(|it| SVector::from([Dual::constant(it)]));
        let input = Sampled::linear(&times, &values).unwrap();
        assert_eq!(input.value(Dual::variable(2.5), since)[0].slope, 2.0);
    }
}
