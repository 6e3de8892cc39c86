//! Where frames are, as polynomials of time: their velocities and accelerations are coefficients.

use nalgebra::{Matrix3, SMatrix, Vector3};

/// Coefficients of 1, t and t².
pub(crate) type Polynomial<T> = [T; 3];

/// Axes and place of a frame in the world.
#[derive(Clone)]
pub(crate) struct Pose {
    pub(crate) axes: Polynomial<Matrix3<f64>>,
    pub(crate) place: Polynomial<Vector3<f64>>,
}

impl Pose {
    pub(crate) fn ground() -> Self {
        Self {
            axes: steady(Matrix3::identity()),
            place: steady(Vector3::zeros()),
        }
    }

    /// The frame at a point that is given in axes of this one.
    pub(crate) fn moved(&self, arm: &Polynomial<Vector3<f64>>) -> Self {
        let arm = product(&self.axes, arm);
        Self {
            place: [0, 1, 2].map(|k| self.place[k] + arm[k]),
            ..self.clone()
        }
    }

    /// The frame whose axes are turned against these.
    pub(crate) fn turned(&self, turn: &Polynomial<Matrix3<f64>>) -> Self {
        Self {
            axes: product(&self.axes, turn),
            ..self.clone()
        }
    }

    /// At another point of the same body.
    pub(crate) fn at(&self, arm: Vector3<f64>) -> Self {
        self.moved(&steady(arm))
    }

    /// At another point of the same body, with other axes.
    pub(crate) fn mounted(&self, arm: Vector3<f64>, tilt: Matrix3<f64>) -> Self {
        self.at(arm).turned(&steady(tilt))
    }

    /// Angular velocity and acceleration in own axes: from Ṙ = R ω̃ follows R̈ = R (ω̇̃ + ω̃²), of which ω̃² is symmetric.
    pub(crate) fn spin(&self) -> [Vector3<f64>; 2] {
        let inward = self.axes[0].transpose();
        [
            axial(&(inward * self.axes[1])),
            axial(&(inward * self.axes[2] * 2.0)),
        ]
    }

    pub(crate) fn velocity(&self) -> Vector3<f64> {
        self.place[1]
    }

    pub(crate) fn acceleration(&self) -> Vector3<f64> {
        self.place[2] * 2.0
    }

    /// A direction that is fixed to the body, in the world.
    pub(crate) fn direction(&self, own: Vector3<f64>) -> Polynomial<Vector3<f64>> {
        self.axes.map(|axes| axes * own)
    }
}

/// What does not change.
pub(crate) fn steady<const N: usize>(value: SMatrix<f64, 3, N>) -> Polynomial<SMatrix<f64, 3, N>> {
    [value, SMatrix::zeros(), SMatrix::zeros()]
}

/// A rotation that begins at `start` and goes on by exp of the vector `rate t + change t²`.
pub(crate) fn turning(
    start: Matrix3<f64>,
    rate: Vector3<f64>,
    change: Vector3<f64>,
) -> Polynomial<Matrix3<f64>> {
    let (rate, change) = (rate.cross_matrix(), change.cross_matrix());
    [start, start * rate, start * (change + rate * rate / 2.0)]
}

fn product<const N: usize>(
    left: &Polynomial<Matrix3<f64>>,
    right: &Polynomial<SMatrix<f64, 3, N>>,
) -> Polynomial<SMatrix<f64, 3, N>> {
    [
        left[0] * right[0],
        left[0] * right[1] + left[1] * right[0],
        left[0] * right[2] + left[1] * right[1] + left[2] * right[0],
    ]
}

/// The product of vectors.
pub(crate) fn dot(
    left: &Polynomial<Vector3<f64>>,
    right: &Polynomial<Vector3<f64>>,
) -> Polynomial<f64> {
    [
        left[0].dot(&right[0]),
        left[0].dot(&right[1]) + left[1].dot(&right[0]),
        left[0].dot(&right[2]) + left[1].dot(&right[1]) + left[2].dot(&right[0]),
    ]
}

/// The vector of what is skew in a matrix.
fn axial(of: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(
        of[(2, 1)] - of[(1, 2)],
        of[(0, 2)] - of[(2, 0)],
        of[(1, 0)] - of[(0, 1)],
    ) / 2.0
}
