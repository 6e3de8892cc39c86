//! What holds in one lane and not in another.

use super::everywhere;
use crate::Real;

/// A flag for each lane: 1 where it is set, else 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flags<T>(T);

impl<T: Real> Flags<T> {
    pub(super) fn all() -> Self {
        Self(T::from_f64(1.0))
    }

    pub(super) fn none() -> Self {
        Self(T::from_f64(0.0))
    }

    /// Where `number < bound`: of NaN in no lane.
    pub(super) fn less(number: T, bound: T) -> Self {
        Self(number.select_less(bound, T::from_f64(1.0), T::from_f64(0.0)))
    }

    /// Where `number ≤ bound`: of NaN, and of two infinities, in no lane.
    pub(super) fn at_most(number: T, bound: T) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let over = number - bound;
        Self(zero.select_less(over, zero, over.select_less(one, one, zero)))
    }

    /// Where a number is neither infinite nor NaN.
    pub(super) fn finite(number: T) -> Self {
        Self::less(number.abs(), T::from_f64(f64::INFINITY))
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }

    pub(super) fn or(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    pub(super) fn not(self) -> Self {
        Self(T::from_f64(1.0) - self.0)
    }

    /// `yes` where it is set, else `no`.
    pub(super) fn choose(self, yes: T, no: T) -> T {
        T::from_f64(0.5).select_less(self.0, yes, no)
    }

    pub(super) fn everywhere(self) -> bool {
        everywhere(self.0, |lane| lane == 1.0)
    }

    pub(super) fn nowhere(self) -> bool {
        everywhere(self.0, |lane| lane == 0.0)
    }
}
