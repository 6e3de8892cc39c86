//! The exponential and the hyperbolic tangent, the same evaluation for every scalar and for lanes of them.
//!
//! Multiples of ln 2 are subtracted as Cody and Waite did, the first part so short that its multiples are exact. A
//! polynomial gives the exponential of the rest, |r| ≤ ln(2) / 2, and the number of multiples is added to the exponent of the
//! result. There is no branch but one for results that would not be normal numbers, and for NaN, which go to `libm` one by
//! one. The tangent has no branch at all. Nothing is computed in a wider type than the scalar's.
//!
//! `tools/constants.py` derives the constants. Errors found are below 0.93 units of the last place of an exponential and below
//! 2.75 of a tangent, with rounded products and with fused ones, over millions of numbers.

use crate::Real;
use crate::sine::{Angle, every, linear, multiply, multiply_add};

/// What the evaluation needs of a scalar beyond its arithmetic.
pub(crate) trait Exponent: Angle {
    /// The exponent up to which results are normal numbers, with either sign.
    const GREATEST: f64;
    /// ln 2 in two parts.
    const LN_2: [f64; 2];
    /// From here on a hyperbolic tangent is one.
    const STRAIGHT: f64;

    /// Lane by lane by `libm`.
    fn extreme(self) -> Self;
    /// (exp r − 1 − r) / r².
    fn rest<const K: usize>(r: [Self; K]) -> [Self; K];
    /// The number times two to the power that the lowest bits of `shifted` are.
    fn doubled(self, shifted: Self) -> Self;
}

/// The exponential.
#[inline(always)]
pub(crate) fn exp<T: Exponent>(x: T) -> T {
    if x.is_within(T::GREATEST) {
        let [power] = moderate([x]);
        power
    } else {
        x.extreme()
    }
}

/// The hyperbolic tangent: `t / (t + 2)` with `t = exp 2|x| − 1`, of which nothing cancels where x is small.
#[inline(always)]
pub(crate) fn tanh<T: Exponent>(x: T) -> T {
    let double = (x.abs() + x.abs()).min(T::from_f64(2.0 * T::STRAIGHT));
    let ([shifted], [rest]) = parts([double]);
    let power = T::from_f64(1.0).doubled(shifted);
    let t = power.multiply_add(rest, power - T::from_f64(1.0));
    x.sign() * (t / (t + T::from_f64(2.0)))
}

#[inline(always)]
fn moderate<T: Exponent, const K: usize>(x: [T; K]) -> [T; K] {
    let (shifted, mut powers) = parts(x);
    for k in 0..K {
        powers[k] = (powers[k] + T::from_f64(1.0)).doubled(shifted[k]);
    }
    powers
}

/// What holds the number of multiples of ln 2 in its lowest bits, and the exponential of the rest less one.
#[inline(always)]
fn parts<T: Exponent, const K: usize>(x: [T; K]) -> ([T; K], [T; K]) {
    let shifted = multiply_add(x, every(core::f64::consts::LOG2_E), every(T::SHIFT));
    let mut multiples = shifted;
    for multiples in &mut multiples {
        *multiples -= T::from_f64(T::SHIFT);
    }
    let [first, last] = T::LN_2;
    let near = multiply_add(multiples, every(-first), x);
    let r = multiply_add(multiples, every(-last), near);
    // The rounding of r is in its powers alone.
    let lost = multiply(multiples, every(-last));
    let mut powers = multiply_add(multiply(r, r), T::rest(r), lost);
    for k in 0..K {
        powers[k] += near[k];
    }
    (shifted, powers)
}

/// Polynomial of degree 9 in r.
#[inline(always)]
pub(crate) fn nonic<T: Real, const K: usize>(
    [a, b, c, d, e, f, g, h, i, j]: [f64; 10],
    r: [T; K],
) -> [T; K] {
    let squares = multiply(r, r);
    let upper = crate::sine::quintic([e, f, g, h, i, j], r);
    let lower = multiply_add(squares, linear(c, d, r), linear(a, b, r));
    multiply_add(multiply(squares, squares), upper, lower)
}

/// Polynomial of degree 4 in r.
#[inline(always)]
pub(crate) fn quartic<T: Real, const K: usize>([a, b, c, d, e]: [f64; 5], r: [T; K]) -> [T; K] {
    let squares = multiply(r, r);
    let upper = multiply_add(squares, every(e), linear(c, d, r));
    multiply_add(squares, upper, linear(a, b, r))
}

/// The constants of double precision, for `f64` and its lanes.
macro_rules! double {
    () => {
        const GREATEST: f64 = 708.0;
        const STRAIGHT: f64 = 22.0;
        const LN_2: [f64; 2] = [6.931_471_805_598_903e-1, 5.497_923_018_708_371e-14];

        #[inline(always)]
        fn rest<const K: usize>(r: [Self; K]) -> [Self; K] {
            let coefficients = [
                5.000_000_000_000_011e-1,
                1.666_666_666_666_644_6e-1,
                4.166_666_666_652_646e-2,
                8.333_333_333_469_391e-3,
                1.388_888_894_443_881_6e-3,
                1.984_126_956_304_020_7e-4,
                2.480_149_249_539_676_5e-5,
                2.755_753_852_703_834_2e-6,
                2.763_038_164_221_515_6e-7,
                2.501_362_396_594_674_5e-8,
            ];
            $crate::exponential::nonic(coefficients, r)
        }
    };
}

/// The constants of single precision, for `f32` and its lanes.
macro_rules! single {
    () => {
        const GREATEST: f64 = 87.0;
        const STRAIGHT: f64 = 11.0;
        const LN_2: [f64; 2] = [6.931_457_52e-1, 1.428_606_77e-6];

        #[inline(always)]
        fn rest<const K: usize>(r: [Self; K]) -> [Self; K] {
            let coefficients = [
                4.999_999_4e-1,
                1.666_651_67e-1,
                4.166_810_21e-2,
                8.369_226_01e-3,
                1.384_001_57e-3,
            ];
            $crate::exponential::quartic(coefficients, r)
        }
    };
}

macro_rules! exponent {
    ($scalar:ident, $constants:ident, $extreme:path, $fraction:literal) => {
        impl Exponent for $scalar {
            $constants!();

            #[cold]
            fn extreme(self) -> Self {
                $extreme(self)
            }

            #[inline(always)]
            fn doubled(self, shifted: Self) -> Self {
                let power = shifted.to_bits() << $fraction;
                Self::from_bits(self.to_bits().wrapping_add(power))
            }
        }
    };
}

#[cfg(feature = "lanes")]
pub(crate) use {double, single};

exponent!(f64, double, libm::exp, 52);
exponent!(f32, single, libm::expf, 23);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twofold::{Twofold, error, next, spread};

    /// ln 2 in parts of 40 bits.
    const PARTS: [f64; 4] = [
        0.6931471805601177,
        -1.7239444525610826e-13,
        -4.0086561055199505e-26,
        -2.193143648751616e-39,
    ];

    /// By its series.
    fn exact(x: f64) -> Twofold {
        let multiples = (x * core::f64::consts::LOG2_E).round();
        let r = PARTS.iter().fold(Twofold(x, 0.0), |r, part| {
            r.plus(Twofold(-multiples * part, 0.0))
        });
        let (mut sum, mut term) = (Twofold(1.0, 0.0), Twofold(1.0, 0.0));
        for n in 1..24 {
            term = term.times(r).over(f64::from(n));
            sum = sum.plus(term);
        }
        let scale = 2.0_f64.powi(multiples as i32);
        Twofold(sum.0 * scale, sum.1 * scale)
    }

    fn worst<T: Exponent + Into<f64>>(numbers: impl Iterator<Item = T>, bits: i32) -> f64 {
        let errors = numbers.map(|x| error(exp(x).into(), exact(x.into()), bits)[0]);
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn double_precision_stays_within_its_bounds() {
        for largest in [1e-3, 0.35, 1.0, 30.0, 600.0] {
            let found = worst(spread(largest), 52);
            assert!(found < 0.93, "{largest}: {found}");
        }
    }

    #[test]
    fn single_precision_stays_within_its_bounds() {
        for largest in [1e-3, 0.35, 1.0, 87.0] {
            let found = worst(spread(largest).map(|x| x as f32), 23);
            assert!(found < 0.93, "{largest}: {found}");
        }
        // Where the rest of the multiples of ln 2 was added before its powers, these were the worst of all.
        let found = worst([59.300_01_f32, -70.998_886].into_iter(), 23);
        assert!(found < 0.93, "{found}");
    }

    /// The largest error of the hyperbolic tangent, in units of the last place.
    fn worst_tangent<T: Exponent + Into<f64>>(numbers: impl Iterator<Item = T>, bits: i32) -> f64 {
        let errors = numbers.map(|x| {
            let less = |by: f64| exact(2.0 * x.into()).plus(Twofold(by, 0.0));
            let (above, below) = (less(-1.0), less(1.0));
            let quotient = above.over(below.0);
            // The divisor's second part changes it by the factor 1 − d.
            let d = below.1 / below.0;
            let exact = quotient.plus(Twofold(-quotient.0 * d, 0.0));
            error(tanh(x).into(), exact, bits)[0]
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn tangents_stay_within_their_bounds() {
        for largest in [0.3, 1.0, 25.0] {
            let found = worst_tangent(spread(largest).chain([0.030_706_022_933_614_067]), 52);
            assert!(found < 2.75, "{largest}: {found}");
            let found = worst_tangent(spread(largest).map(|x| x as f32), 23);
            assert!(found < 2.7, "{largest}: {found}");
        }
    }

    #[test]
    fn tangents_keep_signs_and_what_is_no_number() {
        for x in [0.0_f64, 5e-324, 1e-310] {
            assert_eq!(tanh(x).to_bits(), x.to_bits());
            assert_eq!(tanh(-x).to_bits(), (-x).to_bits());
        }
        for x in [22.0, 1e3, f64::MAX, f64::INFINITY] {
            assert_eq!([tanh(x), tanh(-x)], [1.0, -1.0]);
            assert_eq!([tanh(x as f32), tanh(-x as f32)], [1.0, -1.0]);
        }
        assert!(tanh(f64::NAN).is_nan() && tanh(f32::NAN).is_nan());
    }

    #[test]
    fn zero_and_what_is_tiny_give_one() {
        for x in [0.0, -0.0, 5e-324, -1e-310, 1e-17] {
            assert_eq!(exp(x), 1.0);
            assert_eq!(exp(x as f32), 1.0);
        }
    }

    /// On both sides of where the evaluation ends.
    #[test]
    fn extremes_have_their_power_too() {
        for x in [
            708.0,
            709.7,
            710.0,
            -708.0,
            -740.0,
            -746.0,
            f64::MAX,
            f64::MIN,
        ] {
            for x in [x, next(x, -1), next(x, 1)] {
                let (found, expected) = (exp(x), libm::exp(x));
                let same = found == expected || (found / expected - 1.0).abs() < 3e-16;
                assert!(same, "{x}: {found:e} is not {expected:e}");
            }
        }
        for x in [
            87.0_f32,
            88.7,
            88.8,
            -87.0,
            -100.0,
            -104.0,
            f32::MAX,
            f32::MIN,
        ] {
            let (found, expected) = (exp(x), libm::expf(x));
            let same = found == expected || (found / expected - 1.0).abs() < 2e-7;
            assert!(same, "{x}: {found:e} is not {expected:e}");
        }
        assert_eq!(
            [f64::INFINITY, f64::NEG_INFINITY].map(exp),
            [f64::INFINITY, 0.0]
        );
        assert!(exp(f64::NAN).is_nan() && exp(f32::NAN).is_nan());
    }
}
