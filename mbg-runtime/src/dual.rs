//! Numbers that carry their derivative.

use core::array;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::{Columns, Real};

/// A dual number `value + slope · ε` with `ε² = 0`: a number and its derivative along one direction, exact to rounding.
///
/// A model that is generic over its scalar gives a column of its Jacobian when it runs on dual numbers: set one
/// component's slope to 1 and read the slopes of the result. It serves to check symbolic Jacobians, and gives
/// derivatives of whole simulations with respect to a parameter or an initial value, through events too: the time and the
/// state that [`Integrator::until`](crate::Integrator::until) finds have the slopes of the event. So have the times at which an
/// input jumps, or a law by time, parameters and inputs, and those at which a law jumps because a state goes through a threshold: a
/// step ends there. Where a motion stays at a threshold, as a block does that dry friction by [`sign`](Real::sign) holds, slopes
/// are those of that motion. Slopes of slopes do not know how the motion bends at a threshold.
///
/// [`Adaptive`](crate::Adaptive) steps are short enough for the slopes, too, also where the model rests. So a run on dual numbers
/// may have more steps than one of the values alone.
///
/// Choices follow the value alone: [`Real::find`] and [`Real::select_less`] look at `value`, [`Real::sign`] has slope
/// zero, and at a kink ([`Real::abs`] at zero, equal arguments of [`Real::min`]) the slope is that of one side.
/// Where a function has no finite derivative (square root at zero, arc sine at ±1) the slope is infinite or NaN, but zero of
/// what does not change, such as `max(x, 0)` below zero.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Dual, Real};
///
/// // d/dx (x · sin x) = sin x + x · cos x
/// let x = Dual::variable(0.3);
/// let y = x * x.sin();
/// assert_eq!(y.value, 0.3 * 0.3_f64.sin());
/// assert!((y.slope - (0.3_f64.sin() + 0.3 * 0.3_f64.cos())).abs() < 1e-16);
/// ```
///
/// Vectors and matrices of `nalgebra` take them in sums, products, quotients by a number, zeros and ones. What needs the functions
/// of `nalgebra`'s own fields, such as a norm, an inverse or an eigenvalue, does not: a length is `v.dot(&v).sqrt()`.
///
/// ```
/// use mbg_runtime::{Dual, Real};
/// use nalgebra::{SMatrix, SVector};
///
/// // How fast the tip of an arm of 2 m, at an angle of 0.3, moves for each rad/s of the angle.
/// let (sine, cosine) = Dual::variable(0.3).sin_cos();
/// let turn = SMatrix::<_, 2, 2>::new(cosine, -sine, sine, cosine) * SMatrix::<_, 2, 2>::identity();
/// let tip = turn * SVector::from([2.0, 0.0]).map(Dual::constant) + SVector::<_, 2>::zeros();
/// let velocity = tip.map(|it| it.slope);
/// assert!((velocity - SVector::from([-2.0 * 0.3_f64.sin(), 2.0 * 0.3_f64.cos()])).norm() < 1e-15);
/// let length = tip.dot(&tip).sqrt();
/// assert!((length.value - 2.0).abs() < 1e-15 && length.slope.abs() < 1e-15);
/// ```
///
/// With [`Columns`] of `T` as the slope, a number carries its derivatives along several directions at once, and functions of the
/// value are evaluated only once for all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dual<T, L = T> {
    /// The number.
    pub value: T,
    /// Its derivative.
    pub slope: L,
}

impl<T: Real> Dual<T> {
    /// A number that does not depend on the variable: slope 0.
    #[must_use]
    pub fn constant(value: T) -> Self {
        Self {
            value,
            slope: T::from_f64(0.0),
        }
    }

    /// The variable itself: slope 1.
    #[must_use]
    pub fn variable(value: T) -> Self {
        Self {
            value,
            slope: T::from_f64(1.0),
        }
    }
}

impl<T: Real, L: Columns<T>> Dual<T, L> {
    /// A number that changes along no direction, however many there are; `constant` has one, so that nobody needs to say how many.
    pub(crate) fn unchanging(value: T) -> Self {
        Self {
            value,
            slope: L::from_f64(0.0),
        }
    }

    /// A function of this number by the chain rule.
    fn chain(self, value: T, derivative: T) -> Self {
        Self {
            value,
            slope: L::whole(derivative) * self.slope,
        }
    }

    /// The same of a function that is infinitely steep somewhere.
    fn steep_chain(self, value: T, derivative: T) -> Self {
        Self {
            value,
            slope: steep(derivative, self.slope),
        }
    }

    /// One of two slopes, as [`Real::select_less`] has it.
    fn slope_of_less(value: T, bound: T, yes: L, no: L) -> L {
        L::whole(value).select_less(L::whole(bound), yes, no)
    }
}

/// The slope of a function that is infinitely steep somewhere: where its argument does not change the function does not either.
/// Without a branch, and with the slopes of slopes, which may change where they are zero.
fn steep<T: Real, L: Columns<T>>(derivative: T, slope: L) -> L {
    let zero = T::from_f64(0.0);
    let infinite = T::from_f64(f64::INFINITY);
    let finite = derivative.abs().select_less(infinite, derivative, zero);
    let changes = L::from_f64(0.0).select_less(slope.abs(), L::whole(derivative), L::whole(finite));
    changes * slope
}

impl<T: Real, L: Columns<T>> Add for Dual<T, L> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<T: Real, L: Columns<T>> Sub for Dual<T, L> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
        }
    }
}

impl<T: Real, L: Columns<T>> Mul for Dual<T, L> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: (self.slope)
                .multiply_add(L::whole(other.value), L::whole(self.value) * other.slope),
        }
    }
}

impl<T: Real, L: Columns<T>> Div for Dual<T, L> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - L::whole(value) * other.slope) / L::whole(other.value),
        }
    }
}

impl<T: Real, L: Columns<T>> Neg for Dual<T, L> {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

impl<T: Real, L: Columns<T>> AddAssign for Dual<T, L> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real, L: Columns<T>> SubAssign for Dual<T, L> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Real, L: Columns<T>> MulAssign for Dual<T, L> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<T: Real, L: Columns<T>> DivAssign for Dual<T, L> {
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<T: Real, L: Columns<T>> Zero for Dual<T, L> {
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl<T: Real, L: Columns<T>> One for Dual<T, L> {
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl<T: Real, L: Columns<T>> Real for Dual<T, L> {
    type Lane = T::Lane;
    type Columns = Self;
    type Stages = crate::Four<Self>;

    const SINGULAR: f64 = T::SINGULAR;
    const EPSILON: f64 = T::EPSILON;
    const HAS_SLOPES: bool = true;

    fn from_f64(value: f64) -> Self {
        Self::unchanging(T::from_f64(value))
    }

    fn from_lane(number: T::Lane) -> Self {
        Self::unchanging(T::from_lane(number))
    }

    fn in_lane(self, lane: usize) -> Option<T::Lane> {
        self.value.in_lane(lane)
    }

    fn magnitude(self) -> f64 {
        self.value.magnitude()
    }

    fn slope_along(self, direction: usize) -> Option<f64> {
        let columns = self.slope.as_columns();
        match columns.get(direction) {
            Some(slope) => Some(slope.magnitude()),
            None => self.value.slope_along(direction - columns.len()),
        }
    }

    fn with_slopes_of(self, other: Self) -> Self {
        Self {
            value: self.value.with_slopes_of(other.value),
            slope: other.slope,
        }
    }

    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        let of_factor = (factor.slope).multiply_add(L::whole(self.value), addend.slope);
        Self {
            value: self.value.multiply_add(factor.value, addend.value),
            slope: (self.slope).multiply_add(L::whole(factor.value), of_factor),
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }

    fn sines_cosines<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
        let (sines, cosines) = T::sines_cosines(angles.map(|it| it.value));
        (
            array::from_fn(|place| angles[place].chain(sines[place], cosines[place])),
            array::from_fn(|place| angles[place].chain(cosines[place], -sines[place])),
        )
    }

    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.chain(tangent, T::from_f64(1.0) + tangent * tangent)
    }

    fn asin(self) -> Self {
        let one = T::from_f64(1.0);
        self.steep_chain(
            self.value.asin(),
            one / ((one - self.value) * (one + self.value)).sqrt(),
        )
    }

    fn acos(self) -> Self {
        let one = T::from_f64(1.0);
        self.steep_chain(
            self.value.acos(),
            -one / ((one - self.value) * (one + self.value)).sqrt(),
        )
    }

    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let slope =
            (L::whole(x.value) * self.slope - L::whole(self.value) * x.slope) / L::whole(square);
        Self {
            value: self.value.atan2(x.value),
            slope,
        }
    }

    fn pow(self, exponent: Self) -> Self {
        let before = self.value.pow(exponent.value - T::from_f64(1.0));
        let power = self.steep_chain(self.value.pow(exponent.value), exponent.value * before);
        if exponent.slope == L::from_f64(0.0) {
            return power;
        }
        Self {
            slope: power.slope + steep(power.value * self.value.ln(), exponent.slope),
            ..power
        }
    }

    fn exp(self) -> Self {
        let power = self.value.exp();
        self.chain(power, power)
    }

    fn ln(self) -> Self {
        self.steep_chain(self.value.ln(), T::from_f64(1.0) / self.value)
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.steep_chain(root, T::from_f64(0.5) / root)
    }

    fn tanh(self) -> Self {
        let tangent = self.value.tanh();
        let one = T::from_f64(1.0);
        self.chain(tangent, (one - tangent) * (one + tangent))
    }

    fn fraction(self) -> Self {
        Self {
            value: self.value.fraction(),
            ..self
        }
    }

    /// At zero with the slope above it: its mean with that below is zero, as of what does not change, and would hide that
    /// the root of it is infinitely steep.
    fn abs(self) -> Self {
        let zero = T::from_f64(0.0);
        Self {
            value: self.value.abs(),
            slope: Self::slope_of_less(self.value, zero, -self.slope, self.slope),
        }
    }

    fn sign(self) -> Self {
        Self::unchanging(self.value.sign())
    }

    fn min(self, other: Self) -> Self {
        let slope = Self::slope_of_less(self.value, other.value, self.slope, other.slope);
        Self {
            value: self.value.min(other.value),
            slope,
        }
    }

    fn max(self, other: Self) -> Self {
        let slope = Self::slope_of_less(other.value, self.value, self.slope, other.slope);
        Self {
            value: self.value.max(other.value),
            slope,
        }
    }

    /// The residual's slope stays zero: this number's own slope makes up for all others that it comes from.
    fn root_of(self, mut residual: impl FnMut(Self) -> Self) -> Self {
        let value = self
            .value
            .root_of(|value| residual(Self { value, ..self }).value);
        let mut left = |slope| residual(Self { value, slope }).slope;
        let of_others = left(L::from_f64(0.0));
        let of_own = left(L::from_f64(1.0)) - of_others;
        Self {
            value,
            slope: -of_others / of_own,
        }
    }

    fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
        Self {
            value: self.value.select_less(bound.value, yes.value, no.value),
            slope: Self::slope_of_less(self.value, bound.value, yes.slope, no.slope),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 4.0 * f64::EPSILON * (1.0 + a.abs().max(b.abs()))
    }

    /// `function` of a number with slope 2, against value and derivative in closed form.
    #[track_caller]
    fn assert_rule(function: fn(Dual<f64>) -> Dual<f64>, at: f64, value: f64, derivative: f64) {
        let result = function(Dual {
            value: at,
            slope: 2.0,
        });
        assert!(
            close(result.value, value),
            "value {} is not {value}",
            result.value
        );
        assert!(
            close(result.slope, 2.0 * derivative),
            "slope {} is not {}",
            result.slope,
            2.0 * derivative
        );
    }

    #[test]
    fn functions_of_one_argument() {
        for x in [-0.8_f64, 0.1, 0.6] {
            assert_rule(Real::sin, x, x.sin(), x.cos());
            assert_rule(Real::cos, x, x.cos(), -x.sin());
            assert_rule(Real::tan, x, x.tan(), x.cos().powi(-2));
            assert_rule(Real::asin, x, x.asin(), (1.0 - x * x).sqrt().recip());
            assert_rule(Real::acos, x, x.acos(), -(1.0 - x * x).sqrt().recip());
            assert_rule(Real::exp, x, x.exp(), x.exp());
            assert_rule(Real::tanh, x, x.tanh(), x.cosh().powi(-2));
            assert_rule(Real::fraction, x, x.rem_euclid(1.0), 1.0);
            assert_rule(Real::abs, x, x.abs(), x.signum());
            assert_rule(Real::sign, x, x.signum(), 0.0);
            assert_rule(|x| -x, x, -x, -1.0);
        }
        for x in [0.2_f64, 3.0] {
            assert_rule(Real::ln, x, x.ln(), x.recip());
            assert_rule(Real::sqrt, x, x.sqrt(), 0.5 / x.sqrt());
        }
    }

    #[test]
    fn functions_of_two_arguments() {
        let y = Dual {
            value: 0.7_f64,
            slope: 2.0,
        };
        let x = Dual {
            value: -0.4_f64,
            slope: 5.0,
        };
        let cases = [
            (y + x, 0.3, 7.0),
            (y - x, 1.1, -3.0),
            (y * x, -0.28, 2.0 * -0.4 + 0.7 * 5.0),
            (y / x, 0.7 / -0.4, (2.0 * -0.4 - 0.7 * 5.0) / 0.16),
            (
                y.atan2(x),
                0.7_f64.atan2(-0.4),
                (-0.4 * 2.0 - 0.7 * 5.0) / (0.16 + 0.49),
            ),
            (
                y.pow(x),
                0.7_f64.powf(-0.4),
                0.7_f64.powf(-0.4) * (5.0 * 0.7_f64.ln() - 0.4 * 2.0 / 0.7),
            ),
            (y.min(x), -0.4, 5.0),
            (x.min(y), -0.4, 5.0),
            (y.max(x), 0.7, 2.0),
            (x.max(y), 0.7, 2.0),
            (x.select_less(y, x, y), -0.4, 5.0),
            (y.select_less(x, x, y), 0.7, 2.0),
        ];
        for (index, (result, value, slope)) in cases.into_iter().enumerate() {
            assert!(
                close(result.value, value) && close(result.slope, slope),
                "case {index}: {result:?}"
            );
        }
        let mut sum = y;
        sum += x;
        sum -= y;
        assert!(close(sum.value, x.value) && close(sum.slope, x.slope));
    }

    /// Slopes along several directions, some of them zero, are those along each alone.
    #[test]
    fn several_slopes_at_once_are_those_of_each() {
        use crate::Four;

        let slopes = [[2.0, 0.0, -1.5, 0.0], [0.0, 3.0, 0.25, 0.0]];
        let several = |number: usize, value| Dual {
            value,
            slope: Four(slopes[number]),
        };
        let alone = |number: usize, value, direction: usize| Dual {
            value,
            slope: slopes[number][direction],
        };
        macro_rules! each {
            ($($function:expr),*) => { $(
                for (a, b) in [(0.6, 0.3), (-0.4, 0.7), (0.0, 0.5), (0.7, -0.4), (1.0, 1.0)] {
                    let found = $function(several(0, a), several(1, b));
                    for direction in 0..4 {
                        let expected = $function(alone(0, a, direction), alone(1, b, direction));
                        let bits = |it: f64| (!it.is_nan()).then_some(it.to_bits());
                        assert_eq!(bits(found.value), bits(expected.value));
                        assert_eq!(
                            bits(found.slope.0[direction]), bits(expected.slope),
                            "{} of {a} and {b} along {direction}", stringify!($function),
                        );
                    }
                }
            )* };
        }
        each!(
            |a, b| a + b,
            |a, b| a - b,
            |a, b| a * b,
            |a, b| a / b,
            |a, _| core::ops::Neg::neg(a),
            |a, b| Real::multiply_add(a, b, a),
            |a, _| Real::sin(a),
            |a, _| Real::cos(a),
            |a, _| Real::tan(a),
            |a, _| Real::asin(a),
            |a, _| Real::acos(a),
            Real::atan2,
            Real::pow,
            |a, _| Real::exp(a),
            |a, _| Real::ln(a),
            |a, _| Real::sqrt(a),
            |a, _| Real::tanh(a),
            |a, _| Real::fraction(a),
            |a, _| Real::abs(a),
            |a, _| Real::sign(a),
            Real::min,
            Real::max,
            |a, b| Real::select_less(a, b, b, a),
            |a, b| Real::root_of(a, |x| x * x - a * a + b - b)
        );
    }

    #[test]
    fn functions_of_what_does_not_change_do_not_change() {
        let [zero, one] = [0.0, 1.0].map(Dual::<f64>::constant);
        let quarter = Dual::constant(0.25);
        let flat = Dual::variable(-2.0).max(zero).min(one);
        for found in [flat.sqrt(), flat.pow(quarter), one.acos()] {
            assert_eq!((found.value, found.slope), (0.0, 0.0));
        }
        let arc = Dual::variable(2.0).max(-one).min(one).asin();
        assert_eq!(arc, Dual::constant(1.0_f64.asin()));
        // As a sum of two that do not change.
        let sum = flat + (Dual::variable(-2.0) - one).max(zero);
        assert_eq!(sum.sqrt(), zero);
    }

    /// Also of `|x|`, whose kink is no level place.
    #[test]
    fn infinite_slopes_of_what_changes_stay_told() {
        let rest = Dual::variable(0.0_f64);
        let quarter = Dual::constant(0.25);
        for found in [rest, rest.abs(), -rest.abs()].map(|it| [it.sqrt(), it.pow(quarter)]) {
            assert!(found.iter().all(|it| it.slope.is_infinite()), "{found:?}");
        }
        assert_eq!(Dual::variable(1.0_f64).asin().slope, f64::INFINITY);
        let unknown = Dual {
            value: 0.0_f64,
            slope: f64::NAN,
        };
        assert!(unknown.sqrt().slope.is_nan());
    }

    #[test]
    fn slopes_of_slopes_are_kept_where_those_are_zero() {
        // √(1 + x²) has the slopes x / √(1 + x²), and 1 at zero of that.
        let x = Dual {
            value: Dual::variable(0.0_f64),
            slope: Dual::constant(1.0),
        };
        let root = (x * x + Dual::from_f64(1.0)).sqrt();
        assert_eq!((root.slope.value, root.slope.slope), (0.0, 1.0));
    }

    #[test]
    fn second_derivatives_by_nesting() {
        let x = Dual {
            value: Dual::variable(0.5_f64),
            slope: Dual::constant(1.0),
        };
        let y = x * x * x.exp();
        let second = (0.25 + 4.0 * 0.5 + 2.0) * 0.5_f64.exp();
        assert!(close(y.slope.slope, second));
    }

    #[test]
    fn roots_have_the_slopes_of_implicit_functions() {
        // x² = a has dx/da = 1 / (2 x) and d²x/da² = −1 / (4 x³).
        let a = Dual {
            value: Dual::variable(9.0_f64),
            slope: Dual::constant(1.0),
        };
        let x = Dual::<Dual<f64>>::from_f64(3.0).root_of(|x| x * x - a);
        assert!(close(x.value.value, 3.0));
        assert!(close(x.value.slope, 1.0 / 6.0) && close(x.slope.value, 1.0 / 6.0));
        assert!(close(x.slope.slope, -1.0 / 108.0));
    }

    /// With the rule of products, and the zeros and ones of `nalgebra`.
    #[test]
    fn vectors_and_matrices_of_duals_are_those_of_numbers() {
        use nalgebra::{SMatrix, SVector};

        let number = |value, slope| Dual { value, slope };
        let matrix = SMatrix::<Dual<f64>, 3, 3>::from_fn(|i, j| {
            number((i + 2 * j) as f64, (2 * i) as f64 - j as f64)
        });
        let vector = SVector::from([number(1.0, 2.0), number(-3.0, 0.5), number(0.25, 1.0)]);
        let product = matrix * vector;
        let [values, slopes] = [matrix.map(|it| it.value), matrix.map(|it| it.slope)];
        let (value, slope) = (vector.map(|it| it.value), vector.map(|it| it.slope));
        assert_eq!(product.map(|it| it.value), values * value);
        assert_eq!(product.map(|it| it.slope), slopes * value + values * slope);
        assert_eq!(matrix * SMatrix::<_, 3, 3>::identity(), matrix);
        assert_eq!(matrix + SMatrix::zeros(), matrix);
        assert_eq!(matrix.tr_mul(&vector), matrix.transpose() * vector);
        assert_eq!(vector.dot(&vector), (vector.transpose() * vector)[0]);
        assert_eq!((vector / vector[0])[0], Dual::constant(1.0));
        assert_eq!(vector.cross(&vector), SVector::<_, 3>::zeros());
        assert_eq!((vector * vector[0]).sum(), vector.sum() * vector[0]);
        assert!(SVector::<Dual<f64>, 3>::zeros().iter().all(Zero::is_zero));
        assert!(!Dual::variable(0.0).is_zero());
    }

    #[test]
    fn constants_have_no_slope() {
        assert_eq!(
            Dual::<f64>::from_f64(3.0),
            Dual {
                value: 3.0,
                slope: 0.0
            }
        );
        assert_eq!(Dual::variable(3.0).find(|lane| lane == 3.0), Some(3.0));
    }
}
