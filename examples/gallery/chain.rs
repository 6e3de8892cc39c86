//! A chain of ten rods falls.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::double_pendulum::ends;
use crate::draw::{BLUE, GREY, ORANGE, Panel, picture, shade};
use crate::run::{over, run};

mbg! {
    include "examples/gallery/rods.mbg";

    /// Ten rods on a fixed pin.
    #[derivative]
    pub(crate) model Chain {
        gravity [0.0, -9.81];
        1 ground[3] { Sf fixed { flow: 0.0 } }
        chain: Rods { count: 10 } (ground);
    }
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let chain = Chain::<f64>::new(ChainParameters::default())?;
    let (end, each) = (2.4, 40);
    let found = run(&chain, &(), chain.initial_state(), end, 24 * each)?;
    let rods = |it: &crate::run::Instant<20, 20>| ends(&it.output.as_slice()[..10]);
    let mut plane = Panel::plane("Every 0.1 s for 2.4 s", "x in m", "y in m").weight(1.2);
    for shot in found.iter().step_by(each as usize) {
        plane = plane.stroke(shade(GREY, BLUE, shot.time / end), 0.9, 1, rods(shot));
    }
    let way = found.iter().map(|it| rods(it)[10]).collect();
    plane = plane.line("free end", ORANGE, way);
    let speed = over(&found, |it| {
        let (angles, rates) = it.output.as_slice().split_at(10);
        let [mut x, mut y] = [0.0; 2];
        for (angle, rate) in angles.iter().zip(rates) {
            (x, y) = (x - rate * angle.sin(), y + rate * angle.cos());
        }
        x.hypot(y)
    });
    let whip =
        Panel::new("The end whips", "time in s", "speed in m/s").line("free end", ORANGE, speed);
    picture(
        path,
        "A chain of ten rods, let go level",
        470,
        &[plane, whip],
    )
}
