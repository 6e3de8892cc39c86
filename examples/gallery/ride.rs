//! The frequency response of a quarter of a car.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use mbg_runtime::{Linearised, System};
use nalgebra::{Complex, ComplexField, SVector};

use crate::draw::{BLUE, ORANGE, Panel, Point, picture};
use crate::quarter_car::{QuarterCar, QuarterCarParameters};
use crate::references::quarter_car::response;

/// Amplitudes over frequencies in Hz.
fn amplitudes(responses: &[(f64, Complex<f64>)]) -> Vec<Point> {
    let point = |(hertz, response): &(f64, Complex<f64>)| (*hertz, response.modulus());
    responses.iter().map(point).collect()
}

/// Phases in degrees over frequencies in Hz, without jumps.
fn phases(responses: &[(f64, Complex<f64>)]) -> Vec<Point> {
    let mut last = 0.0;
    let mut point = |(hertz, response): &(f64, Complex<f64>)| {
        let turned = response.argument().to_degrees() - last;
        last += turned - 360.0 * (turned / 360.0).round();
        (*hertz, last)
    };
    responses.iter().map(&mut point).collect()
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let car = QuarterCar::<f64>::new(QuarterCarParameters::default())?;
    let rest = car.initial_state();
    let linear =
        Linearised::of(&car, 0.0, &rest, &SVector::zeros()).map_err(|it| it.to_string())?;
    let over = |count: u32, of: &dyn Fn(f64) -> Option<Complex<f64>>| -> Vec<_> {
        let hertz = (1..=count).map(|k| 20.0 * f64::from(k) / f64::from(count));
        hertz
            .filter_map(|hertz| Some((hertz, of(TAU * hertz)?)))
            .collect()
    };
    let mut amplitude = Panel::new("Amplitude", "frequency in Hz", "speed by that of the road");
    let mut phase = Panel::new("Phase", "frequency in Hz", "phase in degrees");
    for (output, name, by_hand, color) in [
        (0, "body", "body, by hand", BLUE),
        (1, "wheel", "wheel, by hand", ORANGE),
    ] {
        let line = over(800, &|frequency| {
            Some(linear.response(frequency)?[(2 + output, 0)])
        });
        let dots = over(20, &|frequency| Some(response(frequency)[output]));
        amplitude =
            amplitude
                .line(name, color, amplitudes(&line))
                .dots(by_hand, color, amplitudes(&dots));
        phase = phase
            .line(name, color, phases(&line))
            .dots(by_hand, color, phases(&dots));
    }
    picture(
        path,
        "What a quarter of a car makes of the road at each frequency",
        400,
        &[amplitude, phase],
    )
}
