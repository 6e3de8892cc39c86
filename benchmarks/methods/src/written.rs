//! Right-hand sides as one writes them by hand.

use std::f64::consts::FRAC_PI_2;

use mbg_runtime::{Real, Variable};
use nalgebra::{Matrix3, Rotation3, SVector, Vector3};

use crate::peers;
use crate::problems::Law;

/// Two uniform rods of 1 kg and 1 m on pins: absolute angles from the vertical and their rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoublePendulum;

impl DoublePendulum {
    /// Both nearly level, at rest.
    pub(crate) fn start() -> SVector<f64, 4> {
        SVector::from([FRAC_PI_2, FRAC_PI_2 + 0.1, 0.0, 0.0])
    }
}

const fn state(name: &'static str) -> Variable {
    Variable { name, unit: "" }
}

impl Law<4, 0> for DoublePendulum {
    const STATES: &'static [Variable] = &[
        state("first"),
        state("second"),
        state("first rate"),
        state("second rate"),
    ];

    fn slope<T: Real>(&self, x: &SVector<T, 4>, _: &SVector<T, 0>) -> SVector<T, 4> {
        let number = T::from_f64;
        let [first, second, v, w] = x.data.0[0];
        let (sine, cosine) = (first - second).sin_cos();
        let half = number(0.5);
        let a = -(half * sine * w * w) - number(1.5 * 9.81) * first.sin();
        let b = half * sine * v * v - number(0.5 * 9.81) * second.sin();
        let determinant = number(4.0 / 9.0) - number(0.25) * cosine * cosine;
        SVector::from([
            v,
            w,
            (number(1.0 / 3.0) * a - half * cosine * b) / determinant,
            (number(4.0 / 3.0) * b - half * cosine * a) / determinant,
        ])
    }
}

/// The inertial navigation system as matrices of `nalgebra`, with the sines of the standard library. States are the
/// angles of the gimbals and the momenta of fuselage and platform, numbered as `order` tells.
pub(crate) struct Navigation {
    /// Where the states of angles, fuselage and platform begin.
    pub(crate) order: [usize; 3],
}

impl peers::Law<9, 3> for Navigation {
    fn slope(&self, _t: f64, x: &SVector<f64, 9>, gust: &Vector3<f64>) -> SVector<f64, 9> {
        let [angles, hull, body] = self.order;
        let at = |place: usize| Vector3::new(x[place], x[place + 1], x[place + 2]);
        let (alpha, momentum, spin) = (at(angles), at(hull), at(body));
        let rate = momentum.component_div(&Vector3::new(1e4, 1e4, 5e3));
        let turning = spin / 10.0;
        let first = Rotation3::from_axis_angle(&Vector3::x_axis(), alpha.x);
        let second = first * Rotation3::from_axis_angle(&Vector3::y_axis(), alpha.y);
        let whole = second * Rotation3::from_axis_angle(&Vector3::z_axis(), alpha.z);
        let jacobian =
            Matrix3::from_columns(&[Vector3::x(), first * Vector3::y(), second * Vector3::z()]);
        let inverse = jacobian.try_inverse().unwrap_or_else(Matrix3::zeros);
        let rates = inverse * (whole * turning - rate);
        let effort = inverse.transpose() * (-1e-5 * alpha - 1e-5 * rates);
        let hull_slope = gust - 1e3 * rate - effort + momentum.cross(&rate);
        let body_slope = whole.inverse() * effort + spin.cross(&turning);
        let mut slope = SVector::<f64, 9>::zeros();
        slope.fixed_rows_mut::<3>(angles).copy_from(&rates);
        slope.fixed_rows_mut::<3>(hull).copy_from(&hull_slope);
        slope.fixed_rows_mut::<3>(body).copy_from(&body_slope);
        slope
    }
}
