//! Two four-bars in a row turn over, through the position in which all links lie on one line.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREY, ORANGE, Panel, Point, picture, shade};
use crate::run::{over, run, states};

mbg! { include "tests/models/mechanisms/two_four_bars.mbg"; }

/// The tips of the cranks with these angles.
fn tips(angles: [f64; 3]) -> [Point; 3] {
    let feet = [0.0, 1.0, 2.0];
    [0, 1, 2].map(|crank| {
        let angle: f64 = angles[crank];
        (feet[crank] + angle.cos(), angle.sin())
    })
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let row = FourBars2::<f64>::new(FourBars2Parameters::default())?;
    let mut start = row.initial_state();
    for (link, rate) in states(&row, "rate.f").into_iter().enumerate() {
        start[rate] = if link <= 2 { -1.0 } else { 1.0 };
    }
    let found = run(&row, &(), start, 4.0, 4000)?;
    let places = states(&row, "angle");
    let shown =
        |state: &nalgebra::SVector<f64, 10>| tips([0, 1, 2].map(|crank| state[places[crank]]));
    let mut plane = Panel::plane("Every 0.1 s of the first 1.6 s", "x in m", "y in m").weight(1.2);
    for shot in found.iter().take(1601).step_by(100) {
        let tips = shown(&shot.state);
        let color = shade(GREY, BLUE, shot.time / 1.6);
        for (foot, tip) in [0.0, 1.0, 2.0].into_iter().zip(tips) {
            plane = plane.stroke(color, 0.7, 1, vec![(foot, 0.0), tip]);
        }
        plane = plane.stroke(color, 0.7, 1, tips.to_vec());
    }
    let way = |crank: usize| found.iter().map(|it| shown(&it.state)[crank]).collect();
    plane = plane
        .line("tips", ORANGE, way(0))
        .stroke(ORANGE, 1.0, 2, way(1))
        .stroke(ORANGE, 1.0, 2, way(2))
        .dots(
            "on the ground",
            GREY,
            vec![(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)],
        );

    let rates = states(&row, "rate.f");
    let flat: Vec<Point> = found
        .windows(2)
        .filter(|pair| {
            let [before, after] = [0, 1].map(|k| pair[k].state[places[0]].sin());
            before.signum() != after.signum()
        })
        .map(|pair| (pair[0].time, pair[0].state[rates[0]]))
        .collect();
    let rate = Panel::new("The cranks", "time in s", "rate in rad/s")
        .line("cranks", BLUE, over(&found, |it| it.state[rates[0]]))
        .dots("all links on one line", ORANGE, flat);
    picture(
        path,
        "Two four-bars in a row pass their singular position",
        440,
        &[plane, rate],
    )
}
