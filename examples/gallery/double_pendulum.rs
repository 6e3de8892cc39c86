//! Two rods, chaotic.

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, Point, picture};
use crate::references::double_pendulum;
use crate::run::{run, states};

mbg! {
    include "examples/gallery/rods.mbg";

    /// Two rods on a fixed pin.
    #[derivative]
    pub(crate) model DoublePendulum {
        gravity [0.0, -9.81];
        1 ground[3] { Sf fixed { flow: 0.0 } }
        pendulum: Rods { count: 2, bend: 0.1 } (ground);
    }
}

/// The ends of rods of 1 m with these angles against the level, from the pin on.
pub(crate) fn ends(angles: &[f64]) -> Vec<Point> {
    let mut place = (0.0, 0.0);
    let next = angles.iter().map(|angle| {
        place = (place.0 + angle.cos(), place.1 + angle.sin());
        place
    });
    std::iter::once((0.0, 0.0)).chain(next).collect()
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let pendulum = DoublePendulum::<f64>::new(DoublePendulumParameters::default())?;
    let start = pendulum.initial_state();
    let found = run(&pendulum, &(), start, 10.0, 4000)?;
    let rods = |place: usize| ends(&found[place].output.as_slice()[..2]);
    let way = (0..found.len()).map(|place| rods(place)[2]).collect();
    // The reference counts its angles from the vertical.
    let known = double_pendulum::REFERENCE
        .iter()
        .map(|(_, [first, second, ..])| ends(&[first - FRAC_PI_2, second - FRAC_PI_2])[2]);
    let known = known.collect();
    let plane = Panel::plane("Way of the tip", "x in m", "y in m")
        .stroke(BLUE, 0.75, 1, way)
        .line("at the start", GREY, rods(0))
        .line("after 10 s", ORANGE, rods(4000))
        .dots("reference", GREEN, known);

    let mut away = Panel::new(
        "Distance to a neighbour",
        "time in s",
        "log₁₀ of the distance in m",
    )
    .weight(0.9);
    for (offset, name, color) in [
        (1e-9, "moved by 1e-9 rad", BLUE),
        (1e-6, "by 1e-6 rad", ORANGE),
    ] {
        let mut moved = start;
        moved[states(&pendulum, "angle")[0]] += offset;
        let other = run(&pendulum, &(), moved, 10.0, 4000)?;
        let distance = found.iter().zip(&other).map(|(a, b)| {
            let [a_tip, b_tip] = [a, b].map(|it| ends(&it.output.as_slice()[..2])[2]);
            (a.time, (a_tip.0 - b_tip.0).hypot(a_tip.1 - b_tip.1).log10())
        });
        away = away.line(name, color, distance.collect());
    }
    picture(
        path,
        "A double pendulum, let go level, for ten seconds",
        470,
        &[plane, away],
    )
}
