//! Rotation matrices from and to angles and quaternions.
//!
//! A rotation matrix `R` takes the components of a vector in a body's axes to its components in the axes that the
//! body is seen from: `v = R v_body`. Elementary rotations are active: `Rx(a)` turns the y axis towards z.

use nalgebra::{SMatrix, SVector};

use crate::Real;

/// `R = Rx(a) Ry(b) Rz(c)` of the angles `[a, b, c]` in rad: about x first, then about the new y, then the newest z.
///
/// The columns are the body's axes after the three turns, seen from the axes before them.
#[must_use]
pub fn rotation_xyz<T: Real>(angles: &SVector<T, 3>) -> SMatrix<T, 3, 3> {
    let [[a, b, c]] = angles.data.0;
    let (sa, ca) = a.sin_cos();
    let (sb, cb) = b.sin_cos();
    let (sc, cc) = c.sin_cos();
    SMatrix::from([
        [cb * cc, ca * sc + sa * sb * cc, sa * sc - ca * sb * cc],
        [-(cb * sc), ca * cc - sa * sb * sc, sa * cc + ca * sb * sc],
        [sb, -(sa * cb), ca * cb],
    ])
}

/// The angles `[a, b, c]` in rad of `R = Rx(a) Ry(b) Rz(c)`, on the principal branch: `a` and `c` in (−π, π],
/// `|b| ≤ π/2`.
///
/// ```text
/// a = atan2(−R23, R33)
/// b = atan2(R13, R33 cos a − R23 sin a)
/// c = atan2(R21 cos a + R31 sin a, R22 cos a + R32 sin a)
/// ```
/// At `|b| = π/2` (gimbal lock) only `a ± c` is determined; the angles are then one of the triples that give `R`, in
/// exact arithmetic the one with `a = 0`. Nothing is divided by and no accuracy is lost near it.
///
/// ```
/// use mbg_runtime::attitude::{euler_xyz, rotation_xyz};
/// use nalgebra::SVector;
///
/// let angles: SVector<f64, 3> = SVector::from([0.3, -1.2, 2.0]);
/// assert!((euler_xyz(&rotation_xyz(&angles)) - angles).norm() < 1e-15);
/// ```
#[must_use]
pub fn euler_xyz<T: Real>(rotation: &SMatrix<T, 3, 3>) -> SVector<T, 3> {
    let [[_, r21, r31], [_, r22, r32], [r13, r23, r33]] = rotation.data.0;
    let a = (-r23).atan2(r33);
    let (sine, cosine) = a.sin_cos();
    let b = r13.atan2(r33 * cosine - r23 * sine);
    let c = (r21 * cosine + r31 * sine).atan2(r22 * cosine + r32 * sine);
    SVector::from([a, b, c])
}

/// The rotation matrix of the quaternion `[w, x, y, z]` that takes body axes to inertial ones:
/// `R v = q ∘ (0, v) ∘ q⁻¹`.
///
/// The quaternion is divided by its length, so that a drift of the length turns nothing. A quaternion of zeros gives
/// NaN.
#[must_use]
pub fn rotation_from_quaternion<T: Real>(quaternion: &SVector<T, 4>) -> SMatrix<T, 3, 3> {
    let [[w, x, y, z]] = quaternion.data.0;
    let one = T::from_f64(1.0);
    let scale = T::from_f64(2.0) / (w * w + x * x + y * y + z * z);
    SMatrix::from([
        [
            one - scale * (y * y + z * z),
            scale * (x * y + w * z),
            scale * (x * z - w * y),
        ],
        [
            scale * (x * y - w * z),
            one - scale * (x * x + z * z),
            scale * (y * z + w * x),
        ],
        [
            scale * (x * z + w * y),
            scale * (y * z - w * x),
            one - scale * (x * x + y * y),
        ],
    ])
}

/// Corrections of an orthonormalisation at most.
const CORRECTIONS: usize = 32;

/// The matrix next to `matrix` whose rows are orthonormal: with `R` rows a quaternion (1), or the first rows of a
/// rotation matrix (up to 3).
///
/// The matrix is brought to the length of the result, and then `X ← X + ½ (1 − X Xᵀ) X` is repeated, which converges
/// quadratically to the orthogonal factor of the polar decomposition (Björck and Bowie 1971). That is the nearest one,
/// so the correction is at right angles to every rotation of it: what a step of integration has turned is not turned
/// back. A matrix with linearly dependent rows has none, and one of zeros gives NaN.
///
/// ```
/// use mbg_runtime::attitude::orthonormal;
/// use nalgebra::SMatrix;
///
/// let quaternion: SMatrix<f64, 1, 4> = SMatrix::from([[3.0], [0.0], [4.0], [0.0]]);
/// assert!((orthonormal(&quaternion) - quaternion / 5.0).norm() < 1e-15);
/// ```
#[must_use]
pub fn orthonormal<T: Real, const R: usize, const C: usize>(
    matrix: &SMatrix<T, R, C>,
) -> SMatrix<T, R, C> {
    let half = T::from_f64(0.5);
    let dot = |x: &SMatrix<T, R, C>, a: usize, b: usize| {
        let products = (0..C).map(|column| x[(a, column)] * x[(b, column)]);
        products.fold(T::from_f64(0.0), |sum, product| sum + product)
    };
    let mut x = *matrix;
    let square = (0..R).fold(T::from_f64(0.0), |sum, row| sum + dot(&x, row, row));
    let scale = (T::from_f64(R as f64) / square).sqrt();
    x.apply(|entry| *entry = scale * *entry);
    for _ in 0..if R > 1 { CORRECTIONS } else { 0 } {
        let missing: SMatrix<T, R, R> = SMatrix::from_fn(|a, b| {
            let unit = T::from_f64(if a == b { 1.0 } else { 0.0 });
            half * (unit - dot(&x, a, b))
        });
        x = SMatrix::from_fn(|row, column| {
            let added = (0..R).map(|other| missing[(row, other)] * x[(other, column)]);
            added.fold(x[(row, column)], |sum, added| sum + added)
        });
        let largest = missing
            .iter()
            .fold(0.0, |largest: f64, entry| largest.max(entry.magnitude()));
        if largest * largest < T::EPSILON {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    fn about(axis: usize, angle: f64) -> SMatrix<f64, 3, 3> {
        let half = 0.5 * angle;
        let mut quaternion = SVector::from([half.cos(), 0.0, 0.0, 0.0]);
        quaternion[axis + 1] = half.sin();
        rotation_from_quaternion(&quaternion)
    }

    #[test]
    fn elementary_rotations_are_active() {
        let y = SVector::from([0.0, 1.0, 0.0]);
        assert!((about(0, FRAC_PI_2) * y - SVector::from([0.0, 0.0, 1.0])).norm() < 1e-15);
        let angle: f64 = 0.4;
        let expected = SVector::from([-angle.sin(), angle.cos(), 0.0]);
        assert!((about(2, angle) * y - expected).norm() < 1e-15);
    }

    #[test]
    fn three_turns_multiply_in_the_documented_order() {
        let (a, b, c) = (0.3, -0.7, 1.9);
        let product = about(0, a) * about(1, b) * about(2, c);
        assert!((rotation_xyz(&SVector::from([a, b, c])) - product).norm() < 1e-15);
    }

    #[test]
    fn angles_come_back_on_the_principal_branch() {
        for a in [-3.0, -0.5, 0.0, 2.0] {
            for b in [-1.57, -0.3, 0.0, 1.5] {
                for c in [-2.0, 0.0, 0.1, PI] {
                    let angles = SVector::from([a, b, c]);
                    let found = euler_xyz(&rotation_xyz(&angles));
                    let error = found - angles;
                    assert!(error[0].abs() + error[1].abs() < 1e-12, "{angles} {found}");
                    assert!(
                        ((error[2] / (2.0 * PI)).round() * 2.0 * PI - error[2]).abs() < 1e-12,
                        "{angles} {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn gimbal_lock_still_gives_the_rotation() {
        for b in [FRAC_PI_2, -FRAC_PI_2] {
            let rotation = rotation_xyz(&SVector::from([0.4, b, 1.1]));
            assert!((rotation_xyz(&euler_xyz(&rotation)) - rotation).norm() < 1e-15);
        }
        let exact = SMatrix::from([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
        assert_eq!(euler_xyz(&exact), SVector::from([0.0, FRAC_PI_2, 0.0]));
    }

    #[test]
    fn length_of_a_quaternion_does_not_matter() {
        let quaternion = SVector::from([0.5, -0.1, 0.7, 0.2]);
        let rotation = rotation_from_quaternion(&quaternion);
        assert!((rotation - rotation_from_quaternion(&(3.0 * quaternion))).norm() < 1e-15);
        assert!((rotation * rotation.transpose() - SMatrix::identity()).norm() < 1e-15);
        assert!((rotation.determinant() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn orthonormal_rows_are_those_next_to_it() {
        let rotation = rotation_xyz(&SVector::from([0.3, -0.7, 1.9]));
        let stretched = SMatrix::from([[1.1, 0.2, 0.0], [0.2, 0.7, -0.1], [0.0, -0.1, 1.3]]);
        // The symmetric positive factor of a polar decomposition is what is taken away.
        let found = orthonormal(&(rotation * stretched));
        assert!((found - rotation).norm() < 1e-14, "{found}");
        let unit = SMatrix::<f64, 3, 3>::identity();
        assert_eq!(orthonormal(&unit), unit);
        let quaternion: SMatrix<f32, 1, 4> = SMatrix::from([[3.0], [0.0], [-4.0], [0.0]]);
        assert!((orthonormal(&quaternion) - quaternion / 5.0).norm() < 1e-6);
    }

    #[test]
    fn what_was_turned_is_changed_to_second_order_only() {
        // To first order a quaternion turns at right angles to itself, and a rotation by a skew matrix.
        let quaternion: SMatrix<f64, 1, 4> = SMatrix::from([[0.5], [0.5], [-0.5], [0.5]]);
        let across: SMatrix<f64, 1, 4> = SMatrix::from([[0.5], [-0.5], [0.5], [0.5]]);
        let rotation = rotation_xyz(&SVector::from([0.3, -0.7, 1.9]));
        let skew = SMatrix::from([[0.0, 0.5, -0.4], [-0.5, 0.0, 0.3], [0.4, -0.3, 0.0]]);
        for size in [1e-2, 1e-4, 1e-6] {
            let turned = quaternion + size * across;
            assert!((orthonormal(&turned) - turned).norm() < size * size);
            let turned = rotation + size * (rotation * skew);
            assert!((orthonormal(&turned) - turned).norm() < size * size);
        }
    }

    #[test]
    fn two_rows_of_a_rotation() {
        let rotation = rotation_xyz(&SVector::from([0.3, -0.7, 1.9]));
        let rows: SMatrix<f64, 2, 3> = rotation.fixed_rows::<2>(1).into();
        let disturbed = rows + SMatrix::from([[1e-5, 2e-5], [-1e-5, 0.0], [3e-5, -1e-5]]);
        let found = orthonormal(&disturbed);
        assert!((found * found.transpose() - SMatrix::<f64, 2, 2>::identity()).norm() < 1e-15);
        assert!((found - rows).norm() <= (disturbed - rows).norm());
    }

    #[test]
    fn single_precision() {
        let angles = SVector::from([0.3_f32, -1.2, 2.0]);
        assert!((euler_xyz(&rotation_xyz(&angles)) - angles).norm() < 1e-6);
    }
}
