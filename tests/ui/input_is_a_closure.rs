//! A closure is told with what makes an input of it.

use mbg_runtime::Input;
use nalgebra::SVector;

fn drive(_: impl Input<f64, 2>) {}

fn main() {
    drive(|t: f64| SVector::from([t, 0.0]));
}
