//! Four numbers in one scalar where no register takes them.

use core::array;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::{Columns, Real};

/// Four numbers, worked out one after the other.
///
/// [`Real::Stages`] of every scalar that has no lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Four<T>(pub(crate) [T; 4]);

impl<T: Real> Four<T> {
    #[inline]
    fn each(self, function: impl Fn(T) -> T) -> Self {
        Self(self.0.map(function))
    }

    #[inline]
    fn with(self, other: Self, function: impl Fn(T, T) -> T) -> Self {
        Self(array::from_fn(|place| {
            function(self.0[place], other.0[place])
        }))
    }
}

impl<T: Real> Columns<T> for Four<T> {
    const COUNT: usize = 4;

    #[inline]
    fn whole(value: T) -> Self {
        Self([value; 4])
    }

    #[inline]
    fn as_columns(&self) -> &[T] {
        &self.0
    }

    #[inline]
    fn from_columns(number: impl FnMut(usize) -> T) -> Self {
        Self(array::from_fn(number))
    }
}

macro_rules! operators {
    ($($operator:ident, $name:ident);*) => {
        $(
            impl<T: Real> $operator for Four<T> {
                type Output = Self;

                #[inline]
                fn $name(self, other: Self) -> Self {
                    self.with(other, T::$name)
                }
            }
        )*
    };
}

operators!(Add, add; Sub, sub; Mul, mul; Div, div);

impl<T: Real> Neg for Four<T> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        self.each(T::neg)
    }
}

impl<T: Real> AddAssign for Four<T> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Four<T> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

macro_rules! one_by_one {
    ($($name:ident),*; $($pair:ident),*) => {
        $(
            #[inline]
            fn $name(self) -> Self {
                self.each(T::$name)
            }
        )*
        $(
            #[inline]
            fn $pair(self, other: Self) -> Self {
                self.with(other, T::$pair)
            }
        )*
    };
}

impl<T: Real> Real for Four<T> {
    type Columns = Self;
    type Stages = Four<Self>;

    const SINGULAR: f64 = T::SINGULAR;
    const EPSILON: f64 = T::EPSILON;

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self([T::from_f64(value); 4])
    }

    fn find(self, test: impl Fn(f64) -> bool) -> Option<f64> {
        self.0.into_iter().find_map(|number| number.find(&test))
    }

    #[inline]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        Self(array::from_fn(|place| {
            self.0[place].multiply_add(factor.0[place], addend.0[place])
        }))
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sines, cosines) = T::sines_cosines(self.0);
        (Self(sines), Self(cosines))
    }

    one_by_one!(tan, asin, acos, exp, ln, sqrt, tanh, abs, sign; atan2, min, max);

    #[inline]
    fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
        Self(array::from_fn(|place| {
            self.0[place].select_less(bound.0[place], yes.0[place], no.0[place])
        }))
    }
}
