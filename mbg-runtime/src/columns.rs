//! Several numbers side by side: of columns or rows of a Jacobian, or of stages of a step.

use crate::Real;

/// Numbers that belong to several columns or rows of a matrix of `T`, or to the stages of a step ([`Real::Stages`]).
///
/// [`Real::Columns`] says how many columns a scalar takes at once. With the feature `lanes` `f64` takes eight where the
/// target has AVX-512 and four elsewhere, and `f32` eight; otherwise it is one.
pub trait Columns<T: Real>: Real {
    /// How many columns.
    const COUNT: usize;
    /// The same number in all columns.
    fn whole(value: T) -> Self;
    /// The numbers by column.
    fn as_columns(&self) -> &[T];
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
    fn as_columns(&self) -> &[T] {
        core::slice::from_ref(self)
    }

    #[inline]
    fn from_columns(mut number: impl FnMut(usize) -> T) -> Self {
        number(0)
    }
}
