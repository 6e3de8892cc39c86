//! A double pendulum, written by hand.

use std::f64::consts::FRAC_PI_2;

use mbg_runtime::{Real, Variable};
use nalgebra::SVector;

use super::problems::{Law, state};

/// Two uniform rods of 1 kg and 1 m on pins: absolute angles from the downward vertical, and their rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoublePendulum;

impl DoublePendulum {
    /// Both nearly level, at rest.
    pub(crate) fn start() -> SVector<f64, 4> {
        SVector::from([FRAC_PI_2, FRAC_PI_2 + 0.1, 0.0, 0.0])
    }
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
