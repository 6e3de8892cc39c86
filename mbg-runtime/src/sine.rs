//! Sine and cosine of one angle, the same evaluation for every scalar and for lanes of them.
//!
//! The angle is brought to |y| ≤ π/4 by Cody and Waite: multiples of π/2 are subtracted in parts so short that their
//! products are exact. In single precision a fused multiply-add does with fewer parts, of all bits. Then both polynomials
//! are evaluated, and exchanged and signed by the quadrant. There is no branch but one for angles beyond
//! [`Angle::LARGEST`], infinities and NaN, which go to `libm` one by one. Nothing is computed in a wider type than the
//! scalar's.
//!
//! `tools/constants.py` derives the constants. With rounded products the tests found errors of at most 1.6 units of the last
//! place and 1.7e-16 in double, 2.4 units and 1.1e-7 in single precision, over millions of angles.

use crate::Real;

/// What the evaluation needs of a scalar beyond its arithmetic.
pub(crate) trait Angle: Real {
    /// The angle in rad up to which the reduction is good to rounding.
    const LARGEST: f64;
    /// 1.5 · 2ᵐ with m the bits of the fraction: what is added to it loses its own fraction.
    const SHIFT: f64;
    /// π/2 in parts, but for the last one.
    const PARTS: &'static [f64];
    /// The last part of π/2.
    const LAST_PART: f64;

    /// Whether no lane is larger, whatever its sign, or NaN.
    fn is_within(self, largest: f64) -> bool;
    /// Lane by lane by `libm`.
    fn far(self) -> (Self, Self);
    /// With y the angle less its quadrants and z = y²: (sin y / y − 1) / z and cos y.
    fn polynomials<const K: usize>(z: [Self; K]) -> ([Self; K], [Self; K]);
    /// Sine and cosine from those of the reduced angle. The lowest bits of `shifted` are the number of quadrants.
    fn turned(shifted: Self, sine: Self, cosine: Self) -> (Self, Self);
}

/// Sine and cosine of an angle in rad.
#[inline(always)]
pub(crate) fn sin_cos<T: Angle>(angle: T) -> (T, T) {
    if angle.is_within(T::LARGEST) {
        let ([sine], [cosine]) = moderate([angle]);
        (sine, cosine)
    } else {
        angle.far()
    }
}

/// Sines and cosines of several angles in rad, by `evaluate` where none is far.
#[inline(always)]
pub(crate) fn sines_cosines<T: Angle, const K: usize>(
    angles: [T; K],
    evaluate: impl FnOnce([T; K]) -> ([T; K], [T; K]),
) -> ([T; K], [T; K]) {
    let is_moderate = |all: bool, angle: &T| all & angle.is_within(T::LARGEST);
    if angles.iter().fold(true, is_moderate) {
        evaluate(angles)
    } else {
        some_far(angles)
    }
}

#[cold]
#[inline(never)]
fn some_far<T: Angle, const K: usize>(angles: [T; K]) -> ([T; K], [T; K]) {
    let both = angles.map(sin_cos);
    (both.map(|it| it.0), both.map(|it| it.1))
}

/// As many angles at once as `L` has lanes, with one branch for all of them. Left to itself, a compiler finds some vectors in
/// [`moderate`] of single numbers, and many exchanges between them.
#[cfg(all(feature = "lanes", target_feature = "avx"))]
#[inline(always)]
pub(crate) fn sines_cosines_in<L, T, const K: usize>(angles: [T; K]) -> ([T; K], [T; K])
where
    L: Angle + crate::lanes::Lanes<Lane = T>,
    T: Angle,
{
    let (mut sines, mut cosines) = (angles, angles);
    for first in (0..K).step_by(L::COUNT) {
        let together = L::from_lanes(|lane| angles[(first + lane).min(K - 1)]);
        if !together.is_within(T::LARGEST) {
            return some_far(angles);
        }
        let ([sine], [cosine]) = moderate([together]);
        for (lane, place) in (first..K.min(first + L::COUNT)).enumerate() {
            (sines[place], cosines[place]) = (sine.lane(lane), cosine.lane(lane));
        }
    }
    (sines, cosines)
}

/// One operation after the other on all angles: each constant is loaded once, and several angles share a register.
#[inline(always)]
pub(crate) fn moderate<T: Angle, const K: usize>(angles: [T; K]) -> ([T; K], [T; K]) {
    let turns = every(core::f64::consts::FRAC_2_PI);
    let shifted = multiply_add(angles, turns, every(T::SHIFT));
    let mut quadrants = shifted;
    for quadrants in &mut quadrants {
        *quadrants -= T::from_f64(T::SHIFT);
    }
    // Powers do without the last part, which is below their rounding, and need not wait for it.
    let mut y = angles;
    for part in T::PARTS {
        y = multiply_add(quadrants, every(-part), y);
    }
    let z = multiply(y, y);
    let cubes = multiply(y, z);
    let y = multiply_add(quadrants, every(-T::LAST_PART), y);
    let (sines, mut cosines) = T::polynomials(z);
    let mut sines = multiply_add(cubes, sines, y);
    for k in 0..K {
        (sines[k], cosines[k]) = T::turned(shifted[k], sines[k], cosines[k]);
    }
    (sines, cosines)
}

// No function of `core` with a closure: it is inlined where compilers like it, and elsewhere lacks the instructions that are
// chosen when the program runs.

#[inline(always)]
pub(crate) fn every<T: Real, const K: usize>(number: f64) -> [T; K] {
    [T::from_f64(number); K]
}

#[inline(always)]
pub(crate) fn multiply<T: Real, const K: usize>(mut a: [T; K], b: [T; K]) -> [T; K] {
    for k in 0..K {
        a[k] = a[k] * b[k];
    }
    a
}

#[inline(always)]
pub(crate) fn multiply_add<T: Real, const K: usize>(mut a: [T; K], b: [T; K], c: [T; K]) -> [T; K] {
    for k in 0..K {
        a[k] = a[k].multiply_add(b[k], c[k]);
    }
    a
}

/// Polynomial of degree 5 in z, in three independent pairs.
#[inline(always)]
pub(crate) fn quintic<T: Real, const K: usize>([a, b, c, d, e, f]: [f64; 6], z: [T; K]) -> [T; K] {
    let squares = multiply(z, z);
    let upper = multiply_add(squares, linear(e, f, z), linear(c, d, z));
    multiply_add(squares, upper, linear(a, b, z))
}

/// Polynomial of degree 2 in z.
#[inline(always)]
pub(crate) fn quadratic<T: Real, const K: usize>([a, b, c]: [f64; 3], z: [T; K]) -> [T; K] {
    multiply_add(z, linear(b, c, z), every(a))
}

/// Polynomial of degree 1 in z.
#[inline(always)]
pub(crate) fn linear<T: Real, const K: usize>(a: f64, b: f64, z: [T; K]) -> [T; K] {
    multiply_add(z, every(b), every(a))
}

/// The constants of double precision, for `f64` and its lanes, whose multiply-add rounds once or twice: at the largest
/// angles parts of all bits would be as many.
macro_rules! double {
    ($fused:expr) => {
        const LARGEST: f64 = 51_000.0;
        const SHIFT: f64 = 6_755_399_441_055_744.0;
        const PARTS: &'static [f64] = &[1.570_796_326_792_333_3, 2.563_344_151_597_190_7e-12];
        const LAST_PART: f64 = -2.671_890_733_861_015_5e-24;

        #[inline(always)]
        fn polynomials<const K: usize>(z: [Self; K]) -> ([Self; K], [Self; K]) {
            let sine = [
                -1.666_666_666_666_663e-1,
                8.333_333_333_321_84e-3,
                -1.984_126_982_935_820_3e-4,
                2.755_731_353_820_664_7e-6,
                -2.505_073_429_859_918_6e-8,
                1.589_542_485_005_161_6e-10,
            ];
            let cosine = [
                4.166_666_666_666_66e-2,
                -1.388_888_888_887_457e-3,
                2.480_158_728_977_463e-5,
                -2.755_731_444_066_056e-7,
                2.087_573_576_741_426e-9,
                -1.136_031_838_303_257_7e-11,
            ];
            use $crate::sine::{linear, multiply, multiply_add, quintic};
            let (sine, cosine) = (quintic(sine, z), quintic(cosine, z));
            let parabola = linear(1.0, -0.5, z);
            (sine, multiply_add(multiply(z, z), cosine, parabola))
        }
    };
}

/// The constants of single precision, for `f32` and its lanes, whose multiply-add rounds once or twice.
macro_rules! single {
    ($fused:expr) => {
        const LARGEST: f64 = 1600.0;
        const SHIFT: f64 = 12_582_912.0;
        const PARTS: &'static [f64] = if $fused {
            &[1.570_796_37, -4.371_138_83e-8]
        } else {
            &[1.570_800_78, -4.454_515_87e-6, 6.077_272_02e-11]
        };
        const LAST_PART: f64 = -1.715_124_51e-15;

        #[inline(always)]
        fn polynomials<const K: usize>(z: [Self; K]) -> ([Self; K], [Self; K]) {
            let sine = [-1.666_665_52e-1, 8.332_202_21e-3, -1.952_111_2e-4];
            let cosine = [4.166_664_56e-2, -1.388_730_13e-3, 2.443_067_02e-5];
            use $crate::sine::{every, multiply_add, quadratic};
            let rest = multiply_add(z, quadratic(cosine, z), every(-0.5));
            (quadratic(sine, z), multiply_add(z, rest, every(1.0)))
        }
    };
}

macro_rules! angle {
    ($scalar:ident, $constants:ident, $far:path, $bits:literal) => {
        impl Angle for $scalar {
            $constants!(crate::FUSED);

            #[inline(always)]
            fn is_within(self, largest: f64) -> bool {
                self.abs() <= largest as $scalar
            }

            #[cold]
            fn far(self) -> (Self, Self) {
                $far(self)
            }

            #[inline(always)]
            fn turned(shifted: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let quadrants = shifted.to_bits();
                let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
                let exchange = (sine ^ cosine) & (quadrants & 1).wrapping_neg();
                let sine_sign = (quadrants & 2) << ($bits - 2);
                let cosine_sign = (quadrants.wrapping_add(1) & 2) << ($bits - 2);
                (
                    $scalar::from_bits((sine ^ exchange) ^ sine_sign),
                    $scalar::from_bits((cosine ^ exchange) ^ cosine_sign),
                )
            }
        }
    };
}

#[cfg(feature = "lanes")]
pub(crate) use {double, single};

angle!(f64, double, libm::sincos, 64);
angle!(f32, single, libm::sincosf, 32);

#[cfg(test)]
mod tests;
