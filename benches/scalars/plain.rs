//! `f64` with rounded products, and with the sine and cosine of the standard library if asked for.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use mbg_runtime::Real;

/// A number for comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plain<const LIBRARY: bool>(f64);

macro_rules! operators {
    ($($name:ident $method:ident $operator:tt),*) => { $(
        impl<const LIBRARY: bool> $name for Plain<LIBRARY> {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $operator other.0)
            }
        }
    )* };
}

operators!(Add add +, Sub sub -, Mul mul *, Div div /);

impl<const LIBRARY: bool> Neg for Plain<LIBRARY> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<const LIBRARY: bool> AddAssign for Plain<LIBRARY> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const LIBRARY: bool> SubAssign for Plain<LIBRARY> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

macro_rules! functions {
    ($($name:ident),*; $($pair:ident),*) => {
        $( fn $name(self) -> Self { Self(Real::$name(self.0)) } )*
        $( fn $pair(self, other: Self) -> Self { Self(Real::$pair(self.0, other.0)) } )*
    };
}

impl<const LIBRARY: bool> Real for Plain<LIBRARY> {
    type Lane = f64;
    type Columns = Self;
    type Stages = mbg_runtime::Four<Self>;

    const SINGULAR: f64 = <f64 as Real>::SINGULAR;
    const EPSILON: f64 = <f64 as Real>::EPSILON;

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self(value)
    }

    fn from_lane(number: f64) -> Self {
        Self(number)
    }

    fn in_lane(self, lane: usize) -> Option<f64> {
        self.0.in_lane(lane)
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = if LIBRARY {
            self.0.sin_cos()
        } else {
            Real::sin_cos(self.0)
        };
        (Self(sine), Self(cosine))
    }

    functions!(tan, asin, acos, exp, ln, sqrt, tanh, fraction, abs, sign; atan2, pow, min, max);

    fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
        Self(self.0.select_less(bound.0, yes.0, no.0))
    }
}
