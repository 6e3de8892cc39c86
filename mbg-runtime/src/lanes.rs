//! Several numbers in one scalar: a model built for `f64x4` runs four times at once.
//!
//! The types are those of the crate `wide`. Lanes may differ in states, inputs and parameters. Each lane gives, bit for bit, what
//! the model gives for its numbers alone, whatever is in the others, nonlinear loops included. Where a mechanism is closed by
//! iteration this holds but for rounding, since all lanes iterate until the last one is done.
//!
//! The instructions are decided when the program is compiled: with `-C target-cpu=x86-64-v3` or `native` four `f64` or eight `f32`
//! are one register; without such a flag two are needed, and the gain is half as large. With the feature `dispatch` the module
//! `batch` chooses them when the program runs.
//!
//! Lanes of a run share its times and steps. A step ends where a law jumps in any lane, or an input does, so that each is as exact as
//! alone; an [`Adaptive`](crate::Adaptive) run keeps its tolerance in all of them. A lane that stays at a threshold, as dry friction
//! by `sign(f)` does that holds, holds up the others: run it alone, or let the law rise over a width, see [`Fixed`](crate::Fixed).
//! [`until`](crate::Integrator::until) ends at the event of the first lane.
//!
//! A batch is a slice of states whose scalars are lanes: each state variable holds the numbers of some runs side by side.
//! `nalgebra` has no zero for lanes: `SVector::repeat(f64x4::from_f64(0.0))` is a vector of zeros.
//!
//! ```
//! use mbg_runtime::lanes::{Lanes, f64x4, pack, unpack};
//! use mbg_runtime::Real;
//! use nalgebra::SVector;
//!
//! let runs = [0.1, 0.2, 0.3, 0.4].map(|angle| SVector::from([angle, 1.0]));
//! let batch: Vec<SVector<f64x4, 2>> = runs.chunks(f64x4::COUNT).map(pack).collect();
//! let sines = batch[0].map(f64x4::sin);
//! assert_eq!(unpack(&sines, 2), runs[2].map(|number: f64| Real::sin(number)));
//! ```

use nalgebra::SVector;
// Links in their documentation lead to places of their own crate.
#[doc(no_inline)]
pub use wide::{f32x8, f32x16, f64x4, f64x8};

use crate::exponential::{self, Exponent};
use crate::sine::{self, Angle};
use crate::{Columns, FUSED, Real};

/// A scalar of several numbers.
pub trait Lanes: Real {
    /// How many there are.
    const COUNT: usize;

    /// Lanes with what `number` gives for each.
    fn from_lanes(number: impl FnMut(usize) -> Self::Lane) -> Self;
    /// The number in a lane; NaN where there is no such lane.
    #[inline]
    fn lane(self, lane: usize) -> Self::Lane {
        let number = self.in_lane(lane);
        number.unwrap_or_else(|| Self::Lane::from_f64(f64::NAN))
    }
}

/// Columns side by side. Where there are fewer than lanes, the last is repeated; without any all is zero.
#[must_use]
pub fn pack<L: Lanes, const N: usize>(columns: &[SVector<L::Lane, N>]) -> SVector<L, N> {
    let last = columns.len().saturating_sub(1);
    SVector::from_fn(|row, _| {
        L::from_lanes(|lane| match columns.get(lane.min(last)) {
            Some(column) => column[row],
            None => L::Lane::from_f64(0.0),
        })
    })
}

/// The column in a lane; NaN where there is no such lane.
pub fn unpack<L: Lanes, const N: usize>(
    columns: &SVector<L, N>,
    lane: usize,
) -> SVector<L::Lane, N> {
    SVector::from_fn(|row, _| columns[row].lane(lane))
}

macro_rules! lane_by_lane {
    ($scalar:ident: $($name:ident),*; $($pair:ident),*) => {
        $(
            #[inline]
            fn $name(self) -> Self {
                Self::new(self.to_array().map(<$scalar as Real>::$name))
            }
        )*
        $(
            #[inline]
            fn $pair(self, other: Self) -> Self {
                let (first, second) = (self.to_array(), other.to_array());
                Self::from_lanes(|lane| <$scalar as Real>::$pair(first[lane], second[lane]))
            }
        )*
    };
}

macro_rules! lanes {
    ($lanes:ident, $scalar:ident, $count:literal, $constants:ident, $unsigned:ident, $bits:literal, $fraction:literal) => {
        impl Lanes for $lanes {
            const COUNT: usize = $count;

            #[inline]
            fn from_lanes(number: impl FnMut(usize) -> $scalar) -> Self {
                Self::new(core::array::from_fn(number))
            }
        }

        impl Columns<$scalar> for $lanes {
            const COUNT: usize = $count;

            #[inline]
            fn whole(value: $scalar) -> Self {
                Self::splat(value)
            }

            #[inline]
            fn as_columns(&self) -> &[$scalar] {
                self.as_array()
            }

            #[inline]
            fn from_columns(number: impl FnMut(usize) -> $scalar) -> Self {
                Self::from_lanes(number)
            }
        }

        impl Real for $lanes {
            type Lane = $scalar;
            type Columns = Self;
            type Stages = crate::Four<Self>;

            const SINGULAR: f64 = <$scalar as Real>::SINGULAR;
            const EPSILON: f64 = <$scalar as Real>::EPSILON;

            #[inline]
            fn from_f64(value: f64) -> Self {
                Self::splat(value as $scalar)
            }

            #[inline]
            fn from_lane(number: $scalar) -> Self {
                Self::splat(number)
            }

            #[inline]
            fn in_lane(self, lane: usize) -> Option<$scalar> {
                self.to_array().get(lane).copied()
            }

            #[inline]
            fn multiply_add(self, factor: Self, addend: Self) -> Self {
                if FUSED {
                    self.mul_add(factor, addend)
                } else {
                    self * factor + addend
                }
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                sine::sin_cos(self)
            }

            #[inline]
            fn sines_cosines<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
                sine::sines_cosines(angles, sine::moderate)
            }

            lane_by_lane!($scalar: tan, asin, acos, ln; atan2, pow);

            #[inline]
            fn exp(self) -> Self {
                exponential::exp(self)
            }

            #[inline]
            fn tanh(self) -> Self {
                exponential::tanh(self)
            }

            #[inline]
            fn sqrt(self) -> Self {
                $lanes::sqrt(self)
            }

            #[inline]
            fn fraction(self) -> Self {
                self - $lanes::floor(self)
            }

            #[inline]
            fn abs(self) -> Self {
                $lanes::abs(self)
            }

            #[inline]
            fn sign(self) -> Self {
                let (zero, one) = (Self::ZERO, Self::ONE);
                let negative = self.simd_lt(zero).select(-one, self);
                zero.simd_lt(self).select(one, negative)
            }

            #[inline]
            fn min(self, other: Self) -> Self {
                (self.simd_lt(other) | self.is_nan()).select(self, other)
            }

            #[inline]
            fn max(self, other: Self) -> Self {
                (other.simd_lt(self) | self.is_nan()).select(self, other)
            }

            #[inline]
            fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
                self.simd_lt(bound).select(yes, no)
            }
        }

        impl Angle for $lanes {
            sine::$constants!(FUSED);

            #[inline(always)]
            fn is_within(self, largest: f64) -> bool {
                $lanes::abs(self).simd_le(Self::splat(largest as $scalar)).all()
            }

            #[cold]
            fn far(self) -> (Self, Self) {
                let found = self.to_array().map(Real::sin_cos);
                (Self::new(found.map(|it| it.0)), Self::new(found.map(|it| it.1)))
            }

            #[inline(always)]
            fn turned(shifted: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let number = wide::$unsigned::splat;
                let quadrants = shifted.to_bits();
                let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
                let exchange = (sine ^ cosine) & (number(0) - (quadrants & number(1)));
                let sine_sign = (quadrants & number(2)) << ($bits - 2);
                let cosine_sign = ((quadrants + number(1)) & number(2)) << ($bits - 2);
                (
                    Self::from_bits((sine ^ exchange) ^ sine_sign),
                    Self::from_bits((cosine ^ exchange) ^ cosine_sign),
                )
            }
        }

        impl Exponent for $lanes {
            exponential::$constants!();

            #[cold]
            fn extreme(self) -> Self {
                Self::new(self.to_array().map(Real::exp))
            }

            #[inline(always)]
            fn doubled(self, shifted: Self) -> Self {
                Self::from_bits(self.to_bits() + (shifted.to_bits() << $fraction))
            }
        }
    };
}

lanes!(f64x4, f64, 4, double, u64x4, 64, 52);
lanes!(f64x8, f64, 8, double, u64x8, 64, 52);
lanes!(f32x8, f32, 8, single, u32x8, 32, 23);
lanes!(f32x16, f32, 16, single, u32x16, 32, 23);

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::solve::lanes::random;

    /// What is computed of two numbers: every function and every operation.
    pub(crate) fn everything<T: Real>(a: T, b: T) -> [T; 23] {
        let mut sum = a;
        sum += b;
        sum -= a;
        let (sine, cosine) = a.sin_cos();
        [
            a + b,
            a - b,
            a * b,
            a / b,
            -a,
            sum,
            a.multiply_add(b, a),
            sine,
            cosine,
            a.tan(),
            a.asin(),
            a.acos(),
            a.atan2(b),
            a.exp(),
            a.ln(),
            a.sqrt(),
            a.tanh(),
            a.fraction(),
            a.abs() + a.sign(),
            a.min(b),
            a.max(b),
            a.select_less(b, T::from_f64(1.0), b),
            a.abs().pow(b),
        ]
    }

    /// Numbers of all sizes, some of them special.
    pub(crate) fn numbers() -> impl FnMut() -> f64 {
        let special = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            1e-40,
            7e4,
            -3e8,
            1e30,
        ];
        let mut random = random();
        move || {
            let place = ((random() + 1.0) * 20.0) as usize;
            let scale = 10.0_f64.powf(3.0 * random());
            special.get(place).copied().unwrap_or(scale * random())
        }
    }

    /// Lanes against each of their numbers alone.
    fn assert_lanes<L: Lanes>()
    where
        L::Lane: Into<f64>,
    {
        let mut number = numbers();
        for _ in 0..2000 {
            let [a, b] = [0, 1].map(|_| L::from_lanes(|_| L::Lane::from_f64(number())));
            let together = everything(a, b);
            for lane in 0..L::COUNT {
                let (a, b) = (a.lane(lane), b.lane(lane));
                let alone = everything(a, b);
                for (place, (together, alone)) in together.iter().zip(alone).enumerate() {
                    let (together, alone): (f64, f64) = (together.lane(lane).into(), alone.into());
                    let same = together.to_bits() == alone.to_bits();
                    let neither = together.is_nan() && alone.is_nan();
                    assert!(
                        same || neither,
                        "{place} of {a:?}, {b:?}: {together} is not {alone}"
                    );
                }
            }
        }
    }

    #[test]
    fn every_lane_gives_the_bits_of_its_number_alone() {
        assert_lanes::<f64x4>();
        assert_lanes::<f64x8>();
        assert_lanes::<f32x8>();
        assert_lanes::<f32x16>();
    }

    #[test]
    fn find_asks_lanes_in_order() {
        let lanes = f32x8::from_lanes(|lane| lane as f32);
        assert_eq!(lanes.find(|number| number > 2.5), Some(3.0));
        assert_eq!(lanes.find(|number| number > 8.0), None);
    }

    #[test]
    fn columns_come_out_as_they_went_in() {
        let columns = [1.0, 2.0, 3.0].map(|number| SVector::from([number, -number]));
        let packed: SVector<f64x4, 2> = pack(&columns);
        for (lane, column) in [(0, 0), (1, 1), (2, 2), (3, 2)] {
            assert_eq!(unpack(&packed, lane), columns[column]);
        }
        assert!(packed[0].lane(4).is_nan());
        assert_eq!(pack::<f64x4, 2>(&[])[1], f64x4::ZERO);
    }
}
