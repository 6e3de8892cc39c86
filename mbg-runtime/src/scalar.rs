//! `f64` and `f32` as [`Real`].

use crate::Real;

/// Functions of one and two arguments: from the standard library where there is one and its last digits may differ from one
/// system to another, else from `libm`.
macro_rules! elementary {
    ($scalar:ident: $($name:ident = $bare:ident),*; $($pair:ident = $own:ident | $pair_bare:ident),*) => {
        $(
            #[inline]
            fn $name(self) -> Self {
                #[cfg(all(any(test, feature = "std"), not(feature = "reproducible")))]
                return $scalar::$name(self);
                #[cfg(not(all(any(test, feature = "std"), not(feature = "reproducible"))))]
                return libm::$bare(self);
            }
        )*
        $(
            #[inline]
            fn $pair(self, other: Self) -> Self {
                #[cfg(all(any(test, feature = "std"), not(feature = "reproducible")))]
                return $scalar::$own(self, other);
                #[cfg(not(all(any(test, feature = "std"), not(feature = "reproducible"))))]
                return libm::$pair_bare(self, other);
            }
        )*
    };
}

/// What `f64` and `f32` have in common.
macro_rules! ordered {
    ($scalar:ident, $lanes:ident) => {
        const EPSILON: f64 = $scalar::EPSILON as f64;

        #[inline]
        fn from_f64(value: f64) -> Self {
            value as $scalar
        }

        #[inline]
        fn from_lane(number: Self) -> Self {
            number
        }

        #[inline]
        fn in_lane(self, lane: usize) -> Option<Self> {
            (lane == 0).then_some(self)
        }

        #[inline]
        fn magnitude(self) -> f64 {
            f64::from(self.abs())
        }

        #[inline]
        fn multiply_add(self, factor: Self, addend: Self) -> Self {
            #[cfg(any(test, feature = "std"))]
            if crate::FUSED {
                return $scalar::mul_add(self, factor, addend);
            }
            self * factor + addend
        }

        #[inline]
        fn sin_cos(self) -> (Self, Self) {
            crate::sine::sin_cos(self)
        }

        // Without wide registers the steps are shorter when the sines stay a call.
        #[cfg_attr(target_feature = "avx", inline(always))]
        #[cfg_attr(not(target_feature = "avx"), inline)]
        fn sines_cosines<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
            #[cfg(all(feature = "lanes", target_feature = "avx"))]
            return crate::sine::sines_cosines_in::<crate::lanes::$lanes, _, K>(angles);
            #[cfg(not(all(feature = "lanes", target_feature = "avx")))]
            crate::sine::sines_cosines(angles, crate::sine::moderate)
        }

        #[inline]
        fn exp(self) -> Self {
            crate::exponential::exp(self)
        }

        #[inline]
        fn tanh(self) -> Self {
            crate::exponential::tanh(self)
        }

        #[inline]
        fn fraction(self) -> Self {
            #[cfg(any(test, feature = "std"))]
            return self - $scalar::floor(self);
            #[cfg(not(any(test, feature = "std")))]
            return self - libm::Libm::<$scalar>::floor(self);
        }

        #[inline]
        fn abs(self) -> Self {
            $scalar::abs(self)
        }

        #[inline]
        fn sign(self) -> Self {
            if self > 0.0 {
                1.0
            } else if self < 0.0 {
                -1.0
            } else {
                self
            }
        }

        #[inline]
        fn min(self, other: Self) -> Self {
            if self < other || self.is_nan() {
                self
            } else {
                other
            }
        }

        #[inline]
        fn max(self, other: Self) -> Self {
            if self > other || self.is_nan() {
                self
            } else {
                other
            }
        }

        #[inline]
        fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
            if self < bound { yes } else { no }
        }
    };
}

impl Real for f64 {
    type Lane = Self;
    #[cfg(all(feature = "lanes", target_feature = "avx512f"))]
    type Columns = crate::lanes::f64x8;
    #[cfg(all(feature = "lanes", not(target_feature = "avx512f")))]
    type Columns = crate::lanes::f64x4;
    #[cfg(not(feature = "lanes"))]
    type Columns = Self;
    #[cfg(feature = "lanes")]
    type Stages = crate::lanes::f64x4;
    #[cfg(not(feature = "lanes"))]
    type Stages = crate::Four<Self>;
    const SINGULAR: f64 = 1.490_116_119_384_765_6e-8;

    ordered!(f64, f64x4);
    elementary!(f64: tan = tan, asin = asin, acos = acos, ln = log, sqrt = sqrt; atan2 = atan2 | atan2, pow = powf | pow);
}

impl Real for f32 {
    type Lane = Self;
    #[cfg(feature = "lanes")]
    type Columns = crate::lanes::f32x8;
    #[cfg(not(feature = "lanes"))]
    type Columns = Self;
    type Stages = crate::Four<Self>;
    const SINGULAR: f64 = 3.452_669_830_012_439_4e-4;

    ordered!(f32, f32x8);
    elementary!(f32: tan = tanf, asin = asinf, acos = acosf, ln = logf, sqrt = sqrtf; atan2 = atan2 | atan2f, pow = powf | powf);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_is_the_square_root_of_the_precision() {
        assert_eq!(<f64 as Real>::SINGULAR, <f64 as Real>::EPSILON.sqrt());
        assert_eq!(<f32 as Real>::SINGULAR, <f32 as Real>::EPSILON.sqrt());
    }

    #[test]
    fn signs_and_choices_do_not_lose_a_nan() {
        assert_eq!([3.0, 0.0, -2.0].map(Real::sign), [1.0, 0.0, -1.0]);
        assert!(Real::sign(f64::NAN).is_nan());
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN)] {
            assert!(Real::min(a, b).is_nan());
            assert!(Real::max(a, b).is_nan());
        }
        assert_eq!((Real::min(1.0, 2.0), Real::max(1.0, 2.0)), (1.0, 2.0));
        assert_eq!(1.0.select_less(2.0, 10.0, 20.0), 10.0);
        assert_eq!(2.0.select_less(2.0, 10.0, 20.0), 20.0);
        assert_eq!(f32::NAN.select_less(2.0, 10.0, 20.0), 20.0);
    }

    #[test]
    fn find_gives_the_number_that_passes() {
        assert_eq!(0.5_f32.find(|lane| lane < 1.0), Some(0.5));
        assert_eq!(0.5_f32.find(|lane| lane > 1.0), None);
    }
}
