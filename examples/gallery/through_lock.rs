//! A body is pulled through the attitude in which gimbals lock, its orientation held as a quaternion.

use std::error::Error;
use std::path::Path;

use mbg_runtime::attitude::rotation_from_quaternion;
use mbg_runtime::{System, mbg};
use nalgebra::Vector4;

use crate::draw::{BLUE, GREEN, GREY, ORANGE, PURPLE, Panel, picture};
use crate::orientation::{THROUGH_LOCK, through_lock};
use crate::run::{Instant, over, run};

mbg! { include "examples/gallery/flying.mbg"; }

/// Where gimbals about x, y and z divide: the cosine of the middle angle.
fn cosine(it: &Instant<10, 7>) -> f64 {
    let turn = rotation_from_quaternion(&Vector4::from_fn(|part, _| it.output[3 + part]));
    turn[(0, 0)].hypot(turn[(0, 1)])
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let body = PulledQuaternion::<f64>::new(PulledQuaternionParameters::default())?;
    let end = THROUGH_LOCK.iter().map(|row| row.0).fold(0.0, f64::max);
    let found = run(&body, &through_lock(), body.initial_state(), end, 3000)?;
    let mut parts = Panel::new("Quaternion", "time in s", "component").weight(1.2);
    let names = ["w", "x", "y", "z"];
    let colors = [PURPLE, BLUE, ORANGE, GREEN];
    for (part, (name, color)) in names.into_iter().zip(colors).enumerate() {
        parts = parts.line(name, color, over(&found, |it| it.output[3 + part]));
    }
    let known = THROUGH_LOCK
        .iter()
        .flat_map(|(t, _, quaternion)| quaternion.map(|part| (*t, part)));
    let parts = parts.dots("reference", GREY, known.collect());
    let gimbals = Panel::new(
        "What gimbals would divide by",
        "time in s",
        "|cos(middle angle)|",
    )
    .line("zero where they lock", ORANGE, over(&found, cosine));
    picture(
        path,
        "A body is pulled through gimbal lock",
        400,
        &[parts, gimbals],
    )
}
