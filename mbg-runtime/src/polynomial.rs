//! Sine and cosine in single precision without double-precision arithmetic.
//!
//! The functions of `libm` for `f32` compute in `f64`, which a processor with a single-precision unit alone has to
//! emulate. Reduction by Cody and Waite with π/2 in three parts; polynomials of Cephes' `sinf` and `cosf`.

/// The angle in rad up to which the reduction is good to rounding.
const LARGEST: f32 = 1000.0;

/// Sine and cosine; absolute error below 1.5e-7.
#[cfg_attr(any(test, feature = "std"), allow(dead_code))]
#[inline]
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    if angle.abs() <= LARGEST {
        reduced(angle)
    } else {
        libm::sincosf(angle)
    }
}

/// Branch-free, for angles up to [`LARGEST`].
fn reduced(angle: f32) -> (f32, f32) {
    /// 1.5 · 2²³: what is added to it loses its fraction.
    const MAGIC: f32 = 12_582_912.0;
    let shifted = angle * core::f32::consts::FRAC_2_PI + MAGIC;
    let quadrant = shifted.to_bits();
    let turns = shifted - MAGIC;
    let y = angle - turns * 1.570_312_5 - turns * 4.837_513e-4 - turns * 7.549_79e-8;

    let z = y * y;
    let sine = y + y * z * (-1.666_665_5e-1 + z * (8.332_161e-3 + z * -1.951_529_6e-4));
    let cosine =
        1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));

    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let exchange = (sine ^ cosine) & (quadrant & 1).wrapping_neg();
    let sine_sign = (quadrant & 2) << 30;
    let cosine_sign = (quadrant.wrapping_add(1) & 2) << 30;
    (
        f32::from_bits((sine ^ exchange) ^ sine_sign),
        f32::from_bits((cosine ^ exchange) ^ cosine_sign),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_stays_at_rounding_level() {
        let mut worst: f64 = 0.0;
        for k in -100_000..=100_000 {
            let angle = k as f32 * 0.01;
            let (sine, cosine) = sin_cos(angle);
            let (sine_exact, cosine_exact) = f64::from(angle).sin_cos();
            worst = worst.max((f64::from(sine) - sine_exact).abs());
            worst = worst.max((f64::from(cosine) - cosine_exact).abs());
        }
        assert!(worst < 1.5e-7, "{worst:e}");
    }

    #[test]
    fn large_angles_and_nan_are_left_to_libm() {
        for angle in [1000.5, -3e8, f32::MAX] {
            assert_eq!(sin_cos(angle), libm::sincosf(angle));
        }
        assert!(sin_cos(f32::NAN).0.is_nan());
        assert!(sin_cos(f32::INFINITY).1.is_nan());
    }
}
