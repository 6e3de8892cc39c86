//! Points a few units in the last place away, which tell what of a number is rounding.

/// How many of them tell it.
pub(crate) const BESIDE: usize = 8;
/// What is rounding, in units of how far apart values are there.
pub(crate) const ROUNDING: f64 = 64.0;

/// A number as it is at one of these points, by its place among the numbers of a point: each stays on one side of where it is, since
/// a law may jump there.
pub(crate) fn aside(beside: usize, number: usize, value: f64) -> f64 {
    let units = (((number + 1) * (2 * beside + 3)) % 11 + 1) as f64;
    let sign = 1.0 - 2.0 * (number % 2) as f64;
    value * (1.0 + sign * units * f64::EPSILON)
}
