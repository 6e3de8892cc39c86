//! Frequency response of a quarter of a car, body and wheel on strut and tyre, by hand.
//!
//! ```text
//! (m_b s² + d s + k) v_b = (d s + k) v_w
//! (m_w s² + d s + k + k_t) v_w = (d s + k) v_b + k_t v_road
//! ```

use nalgebra::Complex;

/// Mass of the body in kg.
pub(crate) const SPRUNG: f64 = 300.0;
/// Mass of the wheel in kg.
pub(crate) const UNSPRUNG: f64 = 40.0;
/// Stiffness of the strut in N/m.
pub(crate) const SPRING: f64 = 16e3;
/// Damping of the strut in N s/m.
pub(crate) const DAMPER: f64 = 1200.0;
/// Stiffness of the tyre in N/m.
pub(crate) const TYRE: f64 = 190e3;

/// Speeds of body and wheel for the road's at a frequency in rad/s.
pub(crate) fn response(frequency: f64) -> [Complex<f64>; 2] {
    let s = Complex::new(0.0, frequency);
    let strut = s * DAMPER + SPRING;
    let body = s * s * SPRUNG + strut;
    let wheel = s * s * UNSPRUNG + strut + TYRE;
    let determinant = body * wheel - strut * strut;
    [strut * TYRE / determinant, body * TYRE / determinant]
}
