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
    type Lane = T::Lane;
    type Columns = Self;
    type Stages = Four<Self>;

    const SINGULAR: f64 = T::SINGULAR;
    const EPSILON: f64 = T::EPSILON;

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self([T::from_f64(value); 4])
    }

    #[inline]
    fn from_lane(number: T::Lane) -> Self {
        Self([T::from_lane(number); 4])
    }

    fn in_lane(self, lane: usize) -> Option<T::Lane> {
        let of = |number: T| (0..).map_while(move |lane| number.in_lane(lane));
        self.0.into_iter().flat_map(of).nth(lane)
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

    one_by_one!(tan, asin, acos, exp, ln, sqrt, tanh, fraction, abs, sign; atan2, pow, min, max);

    #[inline]
    fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
        Self(array::from_fn(|place| {
            self.0[place].select_less(bound.0[place], yes.0[place], no.0[place])
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_is_what_it_is_alone() {
        let (a, b) = ([0.3, -0.7, 0.0, 2.5], [1.5, -0.2, -3.0, 2.5]);
        let (first, second) = (Four(a), Four(b));
        // The sign of what is no number is nobody's.
        let bits = |numbers: [f64; 4]| numbers.map(|it| (!it.is_nan()).then_some(it.to_bits()));
        macro_rules! each {
            ($($name:ident),*; $($pair:ident),*) => {
                $( assert_eq!(bits(Real::$name(first).0), bits(a.map(Real::$name)), stringify!($name)); )*
                $(
                    let alone = [0, 1, 2, 3].map(|place| Real::$pair(a[place], b[place]));
                    assert_eq!(bits(Real::$pair(first, second).0), bits(alone), stringify!($pair));
                )*
            };
        }
        each!(sin, cos, tan, asin, acos, exp, ln, sqrt, tanh, fraction, abs, sign; atan2, pow, min, max);
        let with = |operator: fn(f64, f64) -> f64| [0, 1, 2, 3].map(|k| operator(a[k], b[k]));
        assert_eq!((first + second).0, with(|a, b| a + b));
        assert_eq!((first - second).0, with(|a, b| a - b));
        assert_eq!((first * second).0, with(|a, b| a * b));
        assert_eq!((first / second).0, with(|a, b| a / b));
        assert_eq!((-first).0, a.map(|a| -a));
        assert_eq!(
            first.multiply_add(second, first).0,
            with(|a, b| a.multiply_add(b, a))
        );
        assert_eq!(
            first.select_less(second, first, -second).0,
            with(|a, b| if a < b { a } else { -b })
        );
        let mut sum = first;
        sum += second;
        sum -= first;
        assert_eq!(sum.0, with(|a, b| (a + b) - a));
        assert_eq!(first.find(|number| number < 0.0), Some(-0.7));
        assert_eq!(first.find(|number| number > 3.0), None);
        assert_eq!(
            [0, 3, 4].map(|lane| first.in_lane(lane)),
            [Some(0.3), Some(2.5), None]
        );
        assert_eq!(Four::from_lane(2.0), Four([2.0; 4]));
    }

    #[cfg(feature = "lanes")]
    #[test]
    fn lanes_of_lanes_follow_each_other() {
        use crate::lanes::{Lanes, f64x4};

        let number = |part: usize, lane: usize| (4 * part + lane) as f64;
        let all = Four([0, 1, 2, 3].map(|part| f64x4::from_lanes(|lane| number(part, lane))));
        for place in 0..16 {
            assert_eq!(all.in_lane(place), Some(place as f64));
        }
        assert_eq!(all.in_lane(16), None);
    }
}
