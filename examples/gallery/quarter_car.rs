//! A quarter of a car over a bump.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use mbg_runtime::{Input, System, mbg};
use nalgebra::SVector;

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};

mbg! { include "examples/gallery/quarter_car.mbg"; }

/// A cosine of 8 cm over 0.6 m, passed at 6 m/s.
struct Bump {
    start: f64,
    end: f64,
}

const BUMP: Bump = Bump {
    start: 0.2,
    end: 0.3,
};

impl Bump {
    /// What is passed at a time as an angle, from 0 to 2π; nothing before and after.
    fn angle(&self, t: f64, since: f64) -> f64 {
        if since < self.start || since >= self.end {
            return 0.0;
        }
        2.0 * PI * (t - self.start) / (self.end - self.start)
    }

    /// Height in m.
    fn height(&self, t: f64) -> f64 {
        0.04 * (1.0 - self.angle(t, t).cos())
    }
}

impl Input<f64, 1> for Bump {
    fn value(&self, t: f64, since: f64) -> SVector<f64, 1> {
        let rate = 2.0 * PI / (self.end - self.start);
        SVector::from([0.04 * rate * self.angle(t, since).sin()])
    }

    fn next_jump(&self, t: f64) -> Option<f64> {
        [self.start, self.end].into_iter().find(|jump| *jump > t)
    }
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let car = QuarterCar::<f64>::new(QuarterCarParameters::default())?;
    let found = run(&car, &BUMP, car.initial_state(), 1.5, 3000)?;
    let places = Panel::new("Places from rest", "time in s", "height in mm")
        .dashes("road", GREY, over(&found, |it| 1e3 * BUMP.height(it.time)))
        .line("wheel", ORANGE, over(&found, |it| 1e3 * it.output[1]))
        .line("body", BLUE, over(&found, |it| 1e3 * it.output[0]));
    let speeds = Panel::new("Speeds", "time in s", "speed in m/s")
        .line("wheel", ORANGE, over(&found, |it| it.output[3]))
        .line("body", BLUE, over(&found, |it| it.output[2]));
    picture(
        path,
        "A quarter of a car over a bump of 8 cm at 6 m/s",
        400,
        &[places, speeds],
    )
}
