//! Sums that keep what rounding would drop.

use nalgebra::SVector;

use crate::Real;

/// A state that many small increments are added to, with what rounding has dropped so far.
///
/// Each addition costs six operations a component instead of one and leaves an error that does not grow with the
/// number of steps. In single precision that is decisive: the round-off of a plain sum soon exceeds the error of the
/// method. The algorithm is Knuth's two-sum with a carry (Møller, BIT 5, 1965).
///
/// # Example
///
/// ```
/// use mbg_runtime::Compensated;
/// use nalgebra::SVector;
///
/// let mut sum = Compensated::new(SVector::from([0.0_f32]));
/// for _ in 0..1_000_000 {
///     sum.add(&SVector::from([1e-6]));
/// }
/// assert_eq!(sum.value()[0], 1.0); // a plain sum gives 1.009
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensated<T, const N: usize> {
    value: SVector<T, N>,
    carry: SVector<T, N>,
}

impl<T: Real, const N: usize> Compensated<T, N> {
    /// A sum that starts at `value`.
    pub fn new(value: SVector<T, N>) -> Self {
        Self { value, carry: SVector::repeat(T::from_f64(0.0)) }
    }

    /// The rounded sum.
    pub fn value(&self) -> &SVector<T, N> {
        &self.value
    }

    /// Adds an increment.
    pub fn add(&mut self, increment: &SVector<T, N>) {
        self.carry.zip_apply(increment, |carry, increment| *carry += increment);
        let sum = self.value.zip_map(&self.carry, |value, addend| value + addend);
        let dropped = self.value.zip_zip_map(&self.carry, &sum, |value, addend, sum| {
            let added = sum - value;
            (value - (sum - added)) + (addend - added)
        });
        self.value = sum;
        self.carry = dropped;
    }
}
