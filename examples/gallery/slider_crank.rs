//! The spatial slider-crank of the benchmarks.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture, shade};
use crate::references::slider_crank;
use crate::run::{over, run, states};
use crate::space::{Place, View};

mbg! { include "tests/models/mechanisms/slider_crank.mbg"; }

/// Where the crank turns, at 0.1 m beside and 0.12 m above the slider's rail, and its tip.
fn crank(angle: f64) -> [Place; 2] {
    let (sine, cosine) = angle.sin_cos();
    [
        [0.0, 0.1, 0.12],
        [0.0, 0.1 - 0.08 * sine, 0.12 + 0.08 * cosine],
    ]
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let mechanism = SpatialSliderCrank::<f64>::new(SpatialSliderCrankParameters::default())?;
    let [angle, rate] = ["bearing.angle", "bearing.rate.f"].map(|name| states(&mechanism, name)[0]);
    let mut start = mechanism.initial_state();
    start[rate] = 6.0;
    let start = mechanism
        .close(0.0, start, &[].into(), &[angle, rate])
        .map_err(|open| open.to_string())?;
    let found = run(&mechanism, &(), start, 5.0, 5000)?;
    let point = mechanism_point(&mechanism);

    let view = View::from(-28.0, 22.0);
    let mut space = Panel::view("Every 0.03 s of the first 0.57 s");
    for shot in found.iter().take(571).step_by(30) {
        let [foot, tip] = crank(shot.output[point]);
        let slider = [shot.output[point + 1], 0.0, 0.0];
        let color = shade(GREY, BLUE, shot.time / 0.57);
        space = space.stroke(color, 0.55, 1, view.path(&[foot, tip, slider]));
    }
    let tips: Vec<Place> = found.iter().map(|it| crank(it.output[point])[1]).collect();
    let travel = over(&found, |it| it.output[point + 1]);
    let low = travel.iter().map(|it| it.1).fold(f64::INFINITY, f64::min);
    let high = travel.iter().map(|it| it.1).fold(0.0, f64::max);
    space = space
        .line("tip of the crank", ORANGE, view.path(&tips))
        .dashes(
            "rail",
            GREY,
            view.path(&[[low - 0.03, 0.0, 0.0], [high + 0.03, 0.0, 0.0]]),
        );
    let slide = Panel::new("Slider", "time in s", "place in mm").line(
        "slider",
        BLUE,
        travel.into_iter().map(|(t, x)| (t, 1e3 * x)).collect(),
    );
    let known = (0..=20).map(|k| 0.25 * f64::from(k));
    let known = known.map(|t| (t, 1e3 * slider_crank::slider(slider_crank::angle(t))));
    let slide = slide.dots("reduced by hand", GREY, known.collect());
    picture(
        path,
        "A crank in space drives a slider",
        430,
        &[space, slide],
    )
}

/// Where the recorded angle of the crank is among the outputs; the place of the slider is next to it.
fn mechanism_point<S, const N: usize, const M: usize, const P: usize>(_: &S) -> usize
where
    S: System<f64, N, M, P>,
{
    let outputs = S::META.outputs.iter();
    outputs
        .take_while(|output| !output.name.starts_with("point"))
        .count()
}
