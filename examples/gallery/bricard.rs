//! Bricard's mechanism.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, picture, shade};
use crate::references::bricard;
use crate::run::{over, run, states};
use crate::space::{Place, View};

mbg! { include "tests/models/mechanisms/bricard.mbg"; }

/// The six joints with these angles of the hinges, from one on the ground to the other.
fn joints(angles: &[f64]) -> Vec<Place> {
    let mut axes = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
    let twist = Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    let mut place = Vector3::zeros();
    let mut places = vec![[0.0; 3]];
    for (rod, angle) in angles.iter().enumerate() {
        let turned = axes * Rotation3::from_axis_angle(&Vector3::y_axis(), *angle);
        place += turned.column(0);
        places.push(place.into());
        axes = turned
            * if rod % 2 == 0 {
                twist
            } else {
                twist.transpose()
            };
    }
    places
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let mechanism = Bricard::<f64>::new(BricardParameters::default())?;
    let found = run(&mechanism, &(), mechanism.initial_state(), 10.0, 2000)?;
    let angles = states(&mechanism, "hinge.angle");
    let shown = |it: &crate::run::Instant<10, 9>| {
        let angles: Vec<f64> = angles.iter().map(|place| it.state[*place]).collect();
        joints(&angles)
    };
    // y is upwards.
    let upright =
        |places: &[Place]| -> Vec<Place> { places.iter().map(|[x, y, z]| [*z, *x, *y]).collect() };
    let view = View::from(35.0, 20.0);
    let mut space = Panel::view("Every 0.25 s of the first 2.5 s");
    for shot in found.iter().take(501).step_by(50) {
        let color = shade(GREY, BLUE, shot.time / 2.5);
        space = space.stroke(color, 0.8, 1, view.path(&upright(&shown(shot))));
    }
    let way: Vec<Place> = found.iter().map(|it| shown(it)[2]).collect();
    let start = shown(&found[0]);
    space = space
        .line("joint P₃", ORANGE, view.path(&upright(&way)))
        .stroke(GREY, 1.0, 3, view.path(&upright(&start)))
        .dots(
            "on the ground",
            GREY,
            view.path(&upright(&[start[0], start[5]])),
        );
    let known = (0..=10).map(f64::from);
    let known = known
        .flat_map(|t| bricard::recorded(t).map(|value| (t, value)))
        .collect();
    let coordinate = |axis: usize| over(&found, move |it| it.output[6 + axis]);
    let place = Panel::new("Joint P₃", "time in s", "place in m")
        .line("x", BLUE, coordinate(0))
        .line("y", ORANGE, coordinate(1))
        .line("z", GREEN, coordinate(2))
        .dots("reduced by hand", GREY, known);
    picture(
        path,
        "Bricard's mechanism moves though one of its constraints is redundant",
        430,
        &[space, place],
    )
}
