//! Scalars that fill a register of an instruction set chosen when the program runs.
//!
//! Everything here is inlined into the function that has the instructions. A function that is not would still compute the
//! same, by a call for each operation.

use core::cell::Cell;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{Bytes, Select, Simd, SimdBase, SimdFloat, SimdMask};

use crate::exponential::{self, Exponent};
use crate::lanes::{f32x16, f64x8};
use crate::sine::{self, Angle};
use crate::{Four, Real};

/// An instruction set, proven to be there.
///
/// A constant of a model has no operand that could carry the proof, so that the thread keeps it. Each time it is asked for
/// it is the same, which compilers know: a function looks once.
pub trait Proven: Simd {
    /// Keeps the proof in this thread.
    fn keep(self);
    /// The proof that this thread keeps.
    fn kept() -> Self;
}

macro_rules! proven {
    ($($set:ident in $cell:ident),*) => { $(
        std::thread_local! {
            static $cell: Cell<Option<$set>> = const { Cell::new(None) };
        }

        impl Proven for $set {
            fn keep(self) {
                $cell.set(Some(self));
            }

            #[inline(always)]
            fn kept() -> Self {
                match $cell.get() {
                    Some(proof) => proof,
                    None => unproven(),
                }
            }
        }
    )* };
}

proven!(Avx2 in AVX2, Avx512 in AVX512);

/// Never reached: registers are made of blocks alone, and `vectorised` keeps the proof before it has any.
#[cold]
#[inline(never)]
fn unproven() -> ! {
    unreachable!("registers outside of a batch")
}

/// Runs a function with the instructions of a set.
pub(super) fn vectorised<S: Proven>(set: S, function: impl FnOnce()) {
    set.keep();
    set.vectorize(function);
}

/// A scalar that holds a part of a block of lanes.
pub trait Registers<L>: Real {
    /// How many fill a block.
    const PARTS: usize;
    /// A part of a block.
    fn part(block: &L, number: usize) -> Self;
    /// Puts it back where it was.
    fn put(self, block: &mut L, number: usize);
}

macro_rules! operators {
    ($name:ident: $($operator:ident $function:ident $sign:tt),*) => { $(
        impl<S: Proven> $operator for $name<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }
    )* };
}

macro_rules! one_by_one {
    ($($function:ident),*) => { $(
        #[inline(always)]
        fn $function(self) -> Self {
            self.each(Real::$function)
        }
    )* };
}

macro_rules! registers {
    ($name:ident, $block:ident, $scalar:ident, $native:ident, $constants:ident, $bits:literal, $fraction:literal) => {
        /// As many numbers as a register holds.
        #[derive(Clone, Copy, Debug)]
        pub struct $name<S: Proven>(S::$native);

        impl<S: Proven> Registers<$block> for $name<S> {
            const PARTS: usize = <$block as crate::lanes::Lanes>::COUNT / <S::$native as SimdBase<S>>::LEN;

            #[inline(always)]
            fn part(block: &$block, number: usize) -> Self {
                let length = <S::$native as SimdBase<S>>::LEN;
                let numbers = &block.as_array()[number * length..][..length];
                Self(SimdBase::from_slice(S::kept(), numbers))
            }

            #[inline(always)]
            fn put(self, block: &mut $block, number: usize) {
                let length = <S::$native as SimdBase<S>>::LEN;
                let numbers = &mut block.as_mut_array()[number * length..][..length];
                self.0.store_slice(numbers);
            }
        }

        impl<S: Proven> $name<S> {
            /// One number after the other.
            #[inline(always)]
            fn each(mut self, function: impl Fn($scalar) -> $scalar) -> Self {
                for number in self.0.as_mut_slice() {
                    *number = function(*number);
                }
                self
            }
        }

        impl<S: Proven> PartialEq for $name<S> {
            fn eq(&self, other: &Self) -> bool {
                self.0.as_slice() == other.0.as_slice()
            }
        }

        operators!($name: Add add +, Sub sub -, Mul mul *, Div div /);

        impl<S: Proven> Neg for $name<S> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl<S: Proven> AddAssign for $name<S> {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }

        impl<S: Proven> SubAssign for $name<S> {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }

        impl<S: Proven> Real for $name<S> {
            type Lane = $scalar;
            type Columns = Self;
            type Stages = Four<Self>;

            const SINGULAR: f64 = <$scalar as Real>::SINGULAR;
            const EPSILON: f64 = <$scalar as Real>::EPSILON;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                Self(SimdBase::splat(S::kept(), value as $scalar))
            }

            #[inline]
            fn from_lane(number: $scalar) -> Self {
                Self(SimdBase::splat(S::kept(), number))
            }

            #[inline]
            fn in_lane(self, lane: usize) -> Option<$scalar> {
                self.0.as_slice().get(lane).copied()
            }

            #[inline(always)]
            fn multiply_add(self, factor: Self, addend: Self) -> Self {
                if cfg!(feature = "reproducible") {
                    self * factor + addend
                } else {
                    Self(self.0.mul_add(factor.0, addend.0))
                }
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                sine::sin_cos(self)
            }

            #[inline(always)]
            fn sines_cosines<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
                sine::sines_cosines(
                    angles,
                    #[inline(always)]
                    |angles| sine::moderate(angles),
                )
            }

            one_by_one!(tan, asin, acos, ln);

            #[inline(always)]
            fn atan2(mut self, x: Self) -> Self {
                for (y, x) in self.0.as_mut_slice().iter_mut().zip(x.0.as_slice()) {
                    *y = Real::atan2(*y, *x);
                }
                self
            }

            #[inline(always)]
            fn pow(mut self, exponent: Self) -> Self {
                for (x, n) in self.0.as_mut_slice().iter_mut().zip(exponent.0.as_slice()) {
                    *x = Real::pow(*x, *n);
                }
                self
            }

            #[inline(always)]
            fn exp(self) -> Self {
                exponential::exp(self)
            }

            #[inline(always)]
            fn tanh(self) -> Self {
                exponential::tanh(self)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }

            #[inline(always)]
            fn fraction(self) -> Self {
                Self(self.0 - self.0.floor())
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }

            #[inline(always)]
            fn sign(self) -> Self {
                let (zero, one) = (Self::from_f64(0.0), Self::from_f64(1.0));
                zero.select_less(self, one, self.select_less(zero, -one, self))
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self((self.0.simd_lt(other.0) | self.0.is_nan()).select(self.0, other.0))
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self((other.0.simd_lt(self.0) | self.0.is_nan()).select(self.0, other.0))
            }

            #[inline(always)]
            fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
                Self(self.0.simd_lt(bound.0).select(yes.0, no.0))
            }
        }

        impl<S: Proven> Angle for $name<S> {
            sine::$constants!(!cfg!(feature = "reproducible"));

            #[inline(always)]
            fn is_within(self, largest: f64) -> bool {
                self.0.abs().simd_le(largest as $scalar).all_true()
            }

            #[cold]
            #[inline(never)]
            fn far(self) -> (Self, Self) {
                (self.each(Real::sin), self.each(Real::cos))
            }

            #[inline(always)]
            fn turned(shifted: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let quadrants = shifted.0.to_bits();
                let (sine, cosine) = (sine.0.to_bits(), cosine.0.to_bits());
                let zero = quadrants ^ quadrants;
                let exchange = (sine ^ cosine) & (zero - (quadrants & 1));
                let sine_sign = (quadrants & 2) << ($bits - 2_u32);
                let cosine_sign = ((quadrants + 1) & 2) << ($bits - 2_u32);
                (
                    Self(((sine ^ exchange) ^ sine_sign).bitcast()),
                    Self(((cosine ^ exchange) ^ cosine_sign).bitcast()),
                )
            }
        }

        impl<S: Proven> Exponent for $name<S> {
            exponential::$constants!();

            #[cold]
            #[inline(never)]
            fn extreme(self) -> Self {
                self.each(Real::exp)
            }

            #[inline(always)]
            fn doubled(self, shifted: Self) -> Self {
                let power = shifted.0.to_bits() << $fraction;
                Self((self.0.to_bits() + power).bitcast())
            }
        }
    };
}

registers!(Doubles, f64x8, f64, f64s, double, 64, 52_u32);
registers!(Singles, f32x16, f32, f32s, single, 32, 23_u32);

#[cfg(test)]
mod tests;
