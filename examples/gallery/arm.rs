//! The 7-axis arm out of its URDF file falls from a bent pose.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{Constant, System, mbg};
use nalgebra::SVector;

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, picture, shade};
use crate::run::{over, run};
use crate::space::{Place, View};

mbg! {
    include "examples/arm/panda.mbg";

    /// The arm on its stand, its joints damped; what is seen are the places of its links.
    pub(crate) model Falling {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 base[6];
        Sf ground[6] { flow: 0.0 } -> base;
        arm: Panda { initial: [0.4, 0.5, 0.0, -1.8, 0.3, 2.0, 0.6] } (base);
        output shoulder[3]: m = arm.panda_link2_position;
        output elbow[3]: m = arm.panda_link4_position;
        output wrist[3]: m = arm.panda_link5_position;
        output hand[3]: m = arm.panda_link7_position;
    }
}

/// From the base over shoulder, elbow and wrist to the hand.
fn places(output: &[f64]) -> Vec<Place> {
    let joints = output.chunks(3).map(|place| [place[0], place[1], place[2]]);
    std::iter::once([0.0; 3]).chain(joints).collect()
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let arm = Falling::<f64>::new(FallingParameters::default())?;
    let idle = Constant(SVector::from([]));
    let found = run(&arm, &idle, arm.initial_state(), 3.0, 3000)?;
    let view = View::from(-55.0, 18.0);
    let mut space = Panel::view("Every 0.05 s of the first second").weight(0.9);
    for shot in found.iter().take(1001).step_by(50) {
        let color = shade(GREY, BLUE, shot.time);
        space = space.stroke(color, 0.8, 1, view.path(&places(shot.output.as_slice())));
    }
    let way: Vec<Place> = found
        .iter()
        .map(|it| places(it.output.as_slice())[4])
        .collect();
    let foot = (0..=60).map(|k| {
        let (sine, cosine) = (f64::from(k) * 6.0).to_radians().sin_cos();
        [0.1 * cosine, 0.1 * sine, 0.0]
    });
    space = space
        .stroke(GREY, 1.0, 2, view.path(&foot.collect::<Vec<Place>>()))
        .line("hand, 3 s", ORANGE, view.path(&way))
        .stroke(GREY, 1.0, 3, view.path(&places(found[0].output.as_slice())));
    let coordinate = |axis: usize| over(&found, move |it| it.output[9 + axis]);
    let hand = Panel::new("Hand", "time in s", "place in m")
        .line("x", BLUE, coordinate(0))
        .line("y", ORANGE, coordinate(1))
        .line("z", GREEN, coordinate(2));
    picture(
        path,
        "A 7-axis arm out of a URDF file falls from a bent pose",
        450,
        &[space, hand],
    )
}
