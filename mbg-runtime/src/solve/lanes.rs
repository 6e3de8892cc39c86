//! Two lanes, to test that decisions are taken lane by lane.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::Real;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair(pub(super) [f64; 2]);

impl Pair {
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(function))
    }

    fn with(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        Self([function(a, c), function(b, d)])
    }
}

macro_rules! operators {
    ($($name:ident $method:ident $operator:tt),*) => { $(
        impl $name for Pair {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                self.with(other, |a, b| a $operator b)
            }
        }
    )* };
}

operators!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Pair {
    type Output = Self;

    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl AddAssign for Pair {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Pair {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

macro_rules! functions {
    ($($name:ident),*; $($pair:ident),*) => {
        $( fn $name(self) -> Self { self.each(Real::$name) } )*
        $( fn $pair(self, other: Self) -> Self { self.with(other, Real::$pair) } )*
    };
}

impl Real for Pair {
    type Lane = f64;
    type Columns = Self;
    type Stages = crate::Four<Self>;

    const SINGULAR: f64 = <f64 as Real>::SINGULAR;
    const EPSILON: f64 = <f64 as Real>::EPSILON;

    fn from_f64(value: f64) -> Self {
        Self([value; 2])
    }

    fn from_lane(number: f64) -> Self {
        Self([number; 2])
    }

    fn in_lane(self, lane: usize) -> Option<f64> {
        self.0.get(lane).copied()
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.each(f64::sin), self.each(f64::cos))
    }

    functions!(tan, asin, acos, exp, ln, sqrt, tanh, fraction, abs, sign; atan2, pow, min, max);

    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        Self([0, 1].map(|i| self.0[i].multiply_add(factor.0[i], addend.0[i])))
    }

    fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
        Self([0, 1].map(|i| self.0[i].select_less(bound.0[i], yes.0[i], no.0[i])))
    }
}

/// Numbers in (−1, 1), the same in every run: a linear congruence (Knuth, MMIX).
pub(crate) fn random() -> impl FnMut() -> f64 {
    let mut state: u64 = 1;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
