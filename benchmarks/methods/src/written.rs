//! A right-hand side as one writes it by hand.

use nalgebra::{Matrix3, Rotation3, SVector, Vector3};

use crate::peers::RightHandSide;

/// The inertial navigation system as matrices of `nalgebra`, with the sines of the standard library. States are the
/// angles of the gimbals and the momenta of fuselage and platform, numbered as `order` tells.
pub(crate) struct Navigation {
    /// Where the states of angles, fuselage and platform begin.
    pub(crate) order: [usize; 3],
}

impl RightHandSide<9, 3> for Navigation {
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
