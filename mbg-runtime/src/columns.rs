//! Several columns of a Jacobian side by side.

use crate::Real;

/// Numbers that belong to several columns of a matrix of `T`.
///
/// [`Real::Columns`] says how many columns a scalar takes at once. With the feature `lanes` `f64` takes as many as one
/// register of the target holds, and `f32` eight; otherwise it is one.
pub trait Columns<T: Real>: Real {
    /// How many columns.
    const COUNT: usize;
    /// The same number in all columns.
    fn whole(value: T) -> Self;
    /// The number in a column; NaN where there is no such column.
    fn column(&self, column: usize) -> T;
    /// Numbers by column.
    fn from_columns(number: impl FnMut(usize) -> T) -> Self;
}

impl<T: Real> Columns<T> for T {
    const COUNT: usize = 1;

    #[inline]
    fn whole(value: T) -> Self {
        value
    }

    #[inline]
    fn column(&self, _: usize) -> T {
        *self
    }

    #[inline]
    fn from_columns(mut number: impl FnMut(usize) -> T) -> Self {
        number(0)
    }
}
