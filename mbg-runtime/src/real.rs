//! The scalar that generated code and steppers are written in.

use core::cell::Cell;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Whether [`Real::multiply_add`] rounds once: where the target has the instruction, with the feature `std` and without
/// the feature `reproducible`.
///
/// A fused multiply-add is faster and changes results in their last digits. Without the standard library stable Rust
/// has no way to ask for it.
pub const FUSED: bool = cfg!(all(
    any(test, feature = "std"),
    not(feature = "reproducible"),
    any(
        target_feature = "fma",
        all(target_arch = "aarch64", target_feature = "neon")
    )
));

/// A real number, a lane of several, or a dual number.
///
/// There is no ordering, so that lanes and dual numbers can implement it: a choice is a [`Real::select_less`].
/// No function panics; outside of its domain a function gives NaN, as the functions of `f64` do.
///
/// | type | elementary functions |
/// |---|---|
/// | `f64`, `f32` | sine, cosine, exponential and hyperbolic tangent of this crate; others of the standard library with `std` and without `reproducible`, else of the crate `libm` |
/// | lanes, with the feature `lanes` | those of this crate likewise, all lanes at once; others lane by lane |
/// | [`Dual<T>`](crate::Dual) | those of `T`, with their slopes |
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// What each of its lanes is: itself where it is one number, and of [`Dual`](crate::Dual) numbers what their values are.
    type Lane: Real<Lane = Self::Lane> + PartialOrd + Into<f64>;
    /// What several columns or rows of a Jacobian are worked out in at once.
    type Columns: crate::Columns<Self>;
    /// Four of them side by side, as the stages of a step are: lanes where the feature `lanes` has them, else
    /// [`Four`](crate::Four), which takes one after the other.
    type Stages: crate::Columns<Self>;

    /// Below this a normalised determinant counts as singular: the square root of the precision.
    const SINGULAR: f64;
    /// Distance from 1 to the next number.
    const EPSILON: f64;

    /// Whether it carries slopes, as [`Dual`](crate::Dual) does.
    const HAS_SLOPES: bool = false;

    /// The nearest number to a constant of the model.
    fn from_f64(value: f64) -> Self;
    /// The same number in every lane.
    fn from_lane(number: Self::Lane) -> Self;
    /// The number in a lane; none behind the last.
    fn in_lane(self, lane: usize) -> Option<Self::Lane>;
    /// The first lane, seen as `f64`, for which `test` holds.
    ///
    /// Lanes are asked in order, each once, until one passes. `number.find(|_| true)` is the first lane.
    #[inline]
    fn find(self, test: impl Fn(f64) -> bool) -> Option<f64> {
        let lanes = (0..).map_while(|lane| self.in_lane(lane));
        lanes.map(Into::into).find(|lane| test(*lane))
    }
    /// Absolute value, seen as `f64`; of several lanes the largest, and NaN when one is.
    fn magnitude(self) -> f64 {
        let largest = Cell::new(0.0_f64);
        self.find(|lane| {
            if lane.is_nan() || lane.abs() > largest.get() {
                largest.set(lane.abs());
            }
            lane.is_nan()
        });
        largest.get()
    }
    /// The slope along one of the directions in which it carries any, seen as `f64` as [`magnitude`](Self::magnitude) is; none
    /// beyond the last.
    #[doc(hidden)]
    fn slope_along(self, _direction: usize) -> Option<f64> {
        None
    }
    /// This number with the slopes of another one, if it carries any.
    #[doc(hidden)]
    fn with_slopes_of(self, _other: Self) -> Self {
        self
    }
    /// `self · factor + addend`, rounded once where [`FUSED`] holds, else twice.
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    /// Sine and cosine of an angle in radians, in one call.
    ///
    /// The same without branches for every angle up to 51000 rad in double and 1600 rad in single precision, where the
    /// error is below 2e-16 and 1.6 units of the last place, or 1.19e-7 and 2.5 units. Larger angles take `libm`. The
    /// sine of −0 is 0.
    fn sin_cos(self) -> (Self, Self);
    /// Sines and cosines of several angles at once: evaluated side by side, with one test for those that are large.
    fn sines_cosines<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
        let both = angles.map(Self::sin_cos);
        (both.map(|it| it.0), both.map(|it| it.1))
    }
    /// Sine.
    #[inline]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine.
    #[inline]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Tangent.
    fn tan(self) -> Self;
    /// Arc sine, in [−π/2, π/2]; NaN outside of [−1, 1].
    fn asin(self) -> Self;
    /// Arc cosine, in [0, π]; NaN outside of [−1, 1].
    fn acos(self) -> Self;
    /// Angle of the vector (`x`, `self`), in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// Exponential.
    ///
    /// The same without branches where the result is a normal number, up to exponents of 708 in double and 87 in single
    /// precision, with an error below one unit of the last place, 1.04 in single precision. Larger ones take `libm`.
    fn exp(self) -> Self;
    /// Natural logarithm; NaN for negative numbers.
    fn ln(self) -> Self;
    /// `self` to the power of `exponent`; NaN for negative numbers, unless the exponent is whole.
    fn pow(self, exponent: Self) -> Self;
    /// Square root; NaN for negative numbers.
    fn sqrt(self) -> Self;
    /// Hyperbolic tangent, within 2.75 units of the last place.
    fn tanh(self) -> Self;
    /// What is left beyond the next whole number below, in [0, 1] since it is rounded; NaN for an infinite number.
    fn fraction(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// −1, 0 or 1, and NaN for NaN.
    fn sign(self) -> Self;
    /// The smaller of two; NaN when either is, so that no NaN gets lost in a limiter.
    fn min(self, other: Self) -> Self;
    /// The larger of two; NaN when either is.
    fn max(self, other: Self) -> Self;
    /// This number, which is a zero of `residual` but for rounding, with the slopes of that zero.
    ///
    /// Only dual numbers have slopes; any other number stays as it is, and `residual` is not asked.
    fn root_of(self, _residual: impl FnMut(Self) -> Self) -> Self {
        self
    }
    /// `yes` where `self < bound`, else `no`: one of the two in each lane. Of a scalar that gives what is between them where
    /// a comparison is not decided, such as an interval, nonlinear loops are not solved.
    fn select_less(self, bound: Self, yes: Self, no: Self) -> Self;
}
