//! Inputs over time.

mod sampled;

use nalgebra::SVector;

use crate::__private::next_of;
use crate::step::{less, seen};
use crate::{Dual, Real};

pub use sampled::{SampleError, Sampled};

/// An input `u(t)` of `M` numbers that is smooth except for jumps at times known in advance.
///
/// Integrators end a step at each jump and start anew behind it, so that no step straddles a jump. What lies between two jumps is
/// a piece. All stages of a step ask for the value on the piece of the step, which is continued up to and including its end, where
/// the next piece begins.
///
/// | input | value |
/// |---|---|
/// | `()` | zero |
/// | [`Constant`] | a constant |
/// | [`Pulse`] | a constant for a time, zero otherwise |
/// | [`Smooth`] | a function of time without jumps |
/// | [`Differentiable`] | the same on dual numbers, with its exact time derivative |
/// | [`Sampled`] | values at given times, held or joined by lines |
/// | [`Sum`] | two inputs added |
/// | `&I` | what `I` is |
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an input of {M} numbers for this scalar",
    note = "a closure becomes an input by `Smooth(|t| SVector::from([…]))`, numbers that stay by `Constant(SVector::from([…]))`",
    note = "it has as many numbers as the model has inputs; a model without any takes `()`"
)]
pub trait Input<T: Real, const M: usize> {
    /// The value at `t` on the piece that begins at, or covers, the time `since`.
    ///
    /// `since` is not later than `t`, and no jump lies between the two, though `t` may be the end of the piece or,
    /// by rounding, a little behind it; there the piece is continued.
    #[must_use]
    fn value(&self, t: T, since: T) -> SVector<T, M>;

    /// The first jump later than `t`. Runs refuse one that is not later, or not a number.
    #[must_use]
    fn next_jump(&self, t: T) -> Option<T>;

    /// The time derivative at `t` on the piece that begins at `since` and does not end within the time `ahead`.
    ///
    /// Methods for stiff problems ask for it. Unless it is given, it is a difference quotient over five values ahead,
    /// whose error falls with the fourth power of `ahead`, the length of the step. Of [`Differentiable`] and [`Sampled`] it
    /// is exact.
    #[must_use]
    fn rate(&self, t: T, since: T, ahead: T) -> SVector<T, M> {
        quotient(t, ahead, |t| self.value(t, since))
    }

    /// Whether the value stays the same between jumps; if it does, integrators do not look for jumps that are not declared.
    #[must_use]
    fn is_constant_between_jumps(&self) -> bool {
        false
    }

    /// The value at `t`; at a jump, the one after it.
    #[must_use]
    fn at(&self, t: T) -> SVector<T, M> {
        self.value(t, t)
    }
}

impl<T: Real, const M: usize, I: Input<T, M> + ?Sized> Input<T, M> for &I {
    fn value(&self, t: T, since: T) -> SVector<T, M> {
        (**self).value(t, since)
    }

    fn next_jump(&self, t: T) -> Option<T> {
        (**self).next_jump(t)
    }

    fn rate(&self, t: T, since: T, ahead: T) -> SVector<T, M> {
        (**self).rate(t, since, ahead)
    }

    fn is_constant_between_jumps(&self) -> bool {
        (**self).is_constant_between_jumps()
    }
}

impl<T: Real, const M: usize> Input<T, M> for () {
    fn value(&self, _t: T, _since: T) -> SVector<T, M> {
        zero()
    }

    fn next_jump(&self, _t: T) -> Option<T> {
        None
    }

    fn rate(&self, _t: T, _since: T, _ahead: T) -> SVector<T, M> {
        zero()
    }

    fn is_constant_between_jumps(&self) -> bool {
        true
    }
}

/// An input that stays as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant<T, const M: usize>(
    /// The value.
    pub SVector<T, M>,
);

impl<T: Real, const M: usize> Input<T, M> for Constant<T, M> {
    fn value(&self, _t: T, _since: T) -> SVector<T, M> {
        self.0
    }

    fn next_jump(&self, _t: T) -> Option<T> {
        None
    }

    fn rate(&self, _t: T, _since: T, _ahead: T) -> SVector<T, M> {
        zero()
    }

    fn is_constant_between_jumps(&self) -> bool {
        true
    }
}

/// A constant for `start ≤ t < end`, zero before and after; lanes may have times of their own. Runs refuse one that ends before it
/// starts, or whose times are not numbers.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Input, Pulse};
/// use nalgebra::SVector;
///
/// let push = Pulse { amplitude: SVector::from([2.0]), start: 1.0, end: 1.5 };
/// assert_eq!(push.at(1.0), SVector::from([2.0]));
/// assert_eq!(push.at(1.5), SVector::from([0.0]));
/// assert_eq!(push.next_jump(0.0), Some(1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse<T, const M: usize> {
    /// The value in between.
    pub amplitude: SVector<T, M>,
    /// The time of the first jump.
    pub start: T,
    /// The time of the second jump; if it is infinite, the pulse is a step.
    pub end: T,
}

impl<T: Real, const M: usize> Input<T, M> for Pulse<T, M> {
    fn value(&self, _t: T, since: T) -> SVector<T, M> {
        let zero = T::from_f64(0.0);
        self.amplitude.map(|it| {
            let before_end = since.select_less(self.end, it, zero);
            since.select_less(self.start, zero, before_end)
        })
    }

    fn next_jump(&self, t: T) -> Option<T> {
        let times = [self.start, self.end];
        let is_no_number = |time: T| time.find(f64::is_nan).is_some();
        if times.into_iter().any(is_no_number) || less(self.end, self.start) {
            // What is not a number is no jump; runs refuse it.
            return Some(T::from_f64(f64::NAN));
        }
        let never = T::from_f64(f64::INFINITY);
        let jumps = times.map(|time| self.start.select_less(self.end, time, never));
        next_of(t, &jumps, &[])
    }

    fn rate(&self, _t: T, _since: T, _ahead: T) -> SVector<T, M> {
        zero()
    }

    fn is_constant_between_jumps(&self) -> bool {
        true
    }
}

/// A function of time without jumps.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Input, Smooth};
/// use nalgebra::SVector;
///
/// let sway = Smooth(|t: f64| SVector::from([t.sin()]));
/// assert_eq!(sway.at(0.3), SVector::from([0.3_f64.sin()]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Smooth<F>(
    /// The function.
    pub F,
);

impl<T: Real, const M: usize, F: Fn(T) -> SVector<T, M>> Input<T, M> for Smooth<F> {
    fn value(&self, t: T, _since: T) -> SVector<T, M> {
        (self.0)(t)
    }

    fn next_jump(&self, _t: T) -> Option<T> {
        None
    }
}

/// A function of time without jumps, on dual numbers: its time derivative is exact.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Differentiable, Dual, Input, Real};
/// use nalgebra::SVector;
///
/// let sway = Differentiable(|t: Dual<f64>| SVector::from([t.sin()]));
/// assert_eq!(sway.at(0.3), SVector::from([0.3_f64.sin()]));
/// assert_eq!(sway.rate(0.3, 0.0, 1.0), SVector::from([0.3_f64.cos()]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Differentiable<F>(
    /// The function.
    pub F,
);

impl<T: Real, const M: usize, F> Input<T, M> for Differentiable<F>
where
    F: Fn(Dual<T>) -> SVector<Dual<T>, M>,
{
    fn value(&self, t: T, _since: T) -> SVector<T, M> {
        (self.0)(Dual::constant(t)).map(|it| it.value)
    }

    fn next_jump(&self, _t: T) -> Option<T> {
        None
    }

    fn rate(&self, t: T, _since: T, _ahead: T) -> SVector<T, M> {
        (self.0)(Dual::variable(t)).map(|it| it.slope)
    }
}

/// Two inputs added, with the jumps of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum<A, B>(
    /// One.
    pub A,
    /// The other.
    pub B,
);

impl<T: Real, const M: usize, A: Input<T, M>, B: Input<T, M>> Input<T, M> for Sum<A, B> {
    fn value(&self, t: T, since: T) -> SVector<T, M> {
        self.0
            .value(t, since)
            .zip_map(&self.1.value(t, since), |a, b| a + b)
    }

    fn next_jump(&self, t: T) -> Option<T> {
        match (self.0.next_jump(t), self.1.next_jump(t)) {
            // One that is not a number comes first, so that it is refused.
            (Some(a), Some(b)) => Some(if less(b, a) || seen(b).is_nan() { b } else { a }),
            (a, b) => a.or(b),
        }
    }

    fn rate(&self, t: T, since: T, ahead: T) -> SVector<T, M> {
        self.0.rate(t, since, ahead) + self.1.rate(t, since, ahead)
    }

    fn is_constant_between_jumps(&self) -> bool {
        self.0.is_constant_between_jumps() && self.1.is_constant_between_jumps()
    }
}

/// The derivative at `t` of what is smooth from `t` over the time `ahead`, from five values in its first sixteenth, or
/// farther apart where that is too short for time's last digits: then rounding would be all that differs.
pub(crate) fn quotient<T: Real, const K: usize>(
    t: T,
    ahead: T,
    value: impl FnMut(T) -> SVector<T, K>,
) -> SVector<T, K> {
    let [usual, most] = [64.0, 4.0].map(|part| ahead * T::from_f64(1.0 / part));
    let least = T::from_f64(2.0 * T::SINGULAR * t.magnitude());
    // As far as times can be apart, so that the values are where they are taken to be.
    let distance = (t + usual.max(least.min(most))) - t;
    if distance.magnitude() == 0.0 {
        return SVector::from_element(T::from_f64(0.0));
    }
    let times = [0.0, 1.0, 2.0, 3.0, 4.0].map(|part| t + T::from_f64(part) * distance);
    let [a, b, c, d, e] = times.map(value);
    let [p, q, r, s] = [48.0, -36.0, 16.0, -3.0].map(T::from_f64);
    let by = T::from_f64(1.0 / 12.0) / distance;
    // Differences first, so that a constant has no rate at all.
    let sum = (b - a).map(|it| p * it) + (c - a).map(|it| q * it);
    let sum = sum + (d - a).map(|it| r * it) + (e - a).map(|it| s * it);
    sum.map(|sum| by * sum)
}

fn zero<T: Real, const M: usize>() -> SVector<T, M> {
    SVector::from_element(T::from_f64(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each lane is pushed at its own time, and all end their steps there.
    #[cfg(feature = "lanes")]
    #[test]
    fn pulse_has_times_of_its_own_in_each_lane() {
        use crate::lanes::{Lanes, f64x4};

        let times = [[1.0, 3.0], [1.5, 2.0], [2.5, 2.5], [0.5, f64::INFINITY]];
        let [start, end] = [0, 1].map(|place| f64x4::from_lanes(|lane| times[lane][place]));
        let amplitude = SVector::from([f64x4::from([1.0, 2.0, 3.0, 4.0])]);
        let pulse = Pulse {
            amplitude,
            start,
            end,
        };
        for t in [0.0, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 9.0] {
            let found = pulse.at(f64x4::from_f64(t))[0];
            for (lane, [start, end]) in times.into_iter().enumerate() {
                let amplitude = SVector::from([amplitude[0].lane(lane)]);
                let alone = Pulse {
                    amplitude,
                    start,
                    end,
                };
                assert_eq!(found.lane(lane), alone.at(t)[0], "{t} {lane}");
            }
        }
        let mut jumps = std::vec::Vec::new();
        let mut t = f64x4::from_f64(0.0);
        while let Some(jump) = pulse.next_jump(t) {
            jumps.push(jump.lane(3));
            t = jump;
        }
        assert_eq!(jumps, [0.5, 1.0, 1.5, 2.0, 3.0]);
        // In one lane it ends before it starts, or has no time.
        for wrong in [0.25, f64::NAN] {
            let end = f64x4::from([3.0, wrong, 3.0, 3.0]);
            let jump = Pulse { end, ..pulse }.next_jump(f64x4::from_f64(9.0));
            assert!(jump.is_some_and(|it| it.lane(0).is_nan()));
        }
    }

    #[test]
    fn pulse_holds_from_its_start_up_to_its_end() {
        let pulse = Pulse {
            amplitude: SVector::from([3.0, -1.0]),
            start: 1.0,
            end: 2.0,
        };
        assert_eq!(pulse.at(0.999), SVector::from([0.0, 0.0]));
        assert_eq!(pulse.at(1.0), SVector::from([3.0, -1.0]));
        assert_eq!(pulse.at(2.0), SVector::from([0.0, 0.0]));
        // From the left.
        assert_eq!(pulse.value(1.0, 0.5), SVector::from([0.0, 0.0]));
        assert_eq!(pulse.value(2.0, 1.0), SVector::from([3.0, -1.0]));
        assert_eq!(
            [0.0, 1.0, 1.5, 2.0].map(|t| pulse.next_jump(t)),
            [Some(1.0), Some(2.0), Some(2.0), None]
        );
    }

    #[test]
    fn a_pulse_of_no_time_is_told() {
        let pulse = |start, end| Pulse {
            amplitude: SVector::from([3.0]),
            start,
            end,
        };
        let is_refused = |jump: Option<f64>| jump.is_some_and(f64::is_nan);
        assert!(is_refused(pulse(f64::NAN, 1.0).next_jump(0.0)));
        assert!(is_refused(pulse(1.0, f64::NAN).next_jump(0.0)));
        assert!(is_refused(pulse(2.0, 1.0).next_jump(0.0)));
        assert!(is_refused(pulse(2.0, 1.0).next_jump(3.0)));
        assert_eq!(pulse(2.0, 2.0).next_jump(0.0), None);
        for sum in [
            Sum(pulse(1.0, 2.0), pulse(f64::NAN, 2.0)),
            Sum(pulse(f64::NAN, 2.0), pulse(1.0, 2.0)),
        ] {
            assert!(is_refused(Input::<f64, 1>::next_jump(&sum, 0.0)));
        }
        assert_eq!(pulse(f64::INFINITY, f64::INFINITY).next_jump(0.0), None);
    }

    #[test]
    fn sums_have_the_jumps_of_both() {
        let pulse = |start, end| Pulse {
            amplitude: SVector::from([1.0]),
            start,
            end,
        };
        let sum = Sum(
            pulse(1.0, 3.0),
            Sum(&pulse(2.0, 4.0), Constant(SVector::from([0.5]))),
        );
        assert_eq!(
            [0.0, 1.0, 2.0, 3.0, 4.0].map(|t| sum.at(t)[0]),
            [0.5, 1.5, 2.5, 1.5, 0.5]
        );
        let jumps = [0.0, 1.0, 2.0, 3.0, 4.0].map(|t| Input::<f64, 1>::next_jump(&sum, t));
        assert_eq!(jumps, [Some(1.0), Some(2.0), Some(3.0), Some(4.0), None]);
        assert_eq!(Input::<f64, 2>::at(&(), 1.0), SVector::from([0.0, 0.0]));
    }
}
