//! Angles that are shown but not states.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector4};

/// Angles (a, b, c) of a rotation `Rx(a) Ry(b) Rz(c)`, in rad; principal branch, |b| ≤ π/2.
pub(crate) fn euler_xyz(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let a = (-rotation[(1, 2)]).atan2(rotation[(2, 2)]);
    let b = rotation[(0, 2)].atan2(rotation[(1, 2)].hypot(rotation[(2, 2)]));
    let c = (-rotation[(0, 1)]).atan2(rotation[(0, 0)]);
    Vector3::new(a, b, c)
}

/// The rotation of a quaternion (w, x, y, z): takes body components to inertial ones.
pub(crate) fn rotation_of(quaternion: &Vector4<f64>) -> Matrix3<f64> {
    let [w, x, y, z] = [quaternion[0], quaternion[1], quaternion[2], quaternion[3]];
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
        .to_rotation_matrix()
        .into_inner()
}
