//! A heavy top: the way of its axis over the sphere.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::orientation::TOP;
use crate::run::{run, states};
use crate::space::{Place, View, on_sphere, sphere};

mbg! { include "examples/gallery/top.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let top = TopQuaternion::<f64>::new(TopQuaternionParameters::default())?;
    let view = View::from(-60.0, 52.0);
    let mut panels = Vec::new();
    for (title, precession) in [
        ("Let go: cusps", 0.0),
        ("Pushed back: loops", -1.2),
        ("Pushed on: waves", 0.35),
    ] {
        let mut start = top.initial_state();
        let across = states(&top, "rate.f.y")[0];
        start[across] = precession * 0.6_f64.sin();
        let found = run(&top, &(), start, 9.0, 3000)?;
        let way: Vec<Place> = found
            .iter()
            .map(|it| axis(&it.output.as_slice()[3..7]))
            .collect();
        let mut panel = sphere(Panel::view(title), view);
        panel = panel.stroke(GREY, 0.9, 2, view.path(&[[0.0; 3], way[0]]));
        panel = on_sphere(panel, view, BLUE, 2, 1.0, &way);
        if precession == 0.0 {
            let known: Vec<Place> = TOP
                .iter()
                .filter(|row| row.0 < 9.0)
                .map(|row| axis(&row.2))
                .collect();
            panel = panel.dots("elliptic functions", ORANGE, view.path(&known));
        }
        panels.push(panel);
    }
    picture(
        path,
        "The axis of a heavy top on the sphere, 25 rad/s, tilted by 0.6 rad",
        400,
        &panels,
    )
}

/// The z axis of a body with this quaternion.
pub(crate) fn axis(quaternion: &[f64]) -> Place {
    let [w, x, y, z] = [0, 1, 2, 3].map(|part| quaternion[part]);
    [
        2.0 * (x * z + w * y),
        2.0 * (y * z - w * x),
        w * w - x * x - y * y + z * z,
    ]
}
