//! A compass that walks down a slope, and comes to its gait.

use std::error::Error;
use std::path::Path;

use mbg_runtime::System;
use nalgebra::SVector;

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, Point, picture};
use crate::gait::{Struck, StruckParameters, Walker, WalkerParameters, strike, swing};
use crate::references::walker;

/// Parts of a step that are shown.
const PARTS: u32 = 60;

/// Angle and rate of both legs, the one on the ground first.
fn legs(x: &SVector<f64, 4>) -> [Point; 2] {
    [(x[0], x[2]), (x[0] + x[1], x[2] + x[3])]
}

/// States at equal times of a step, up to the strike.
fn step(
    model: &Walker<f64>,
    start: SVector<f64, 4>,
) -> Result<Vec<SVector<f64, 4>>, Box<dyn Error>> {
    let end = swing(model, start, |_| ())?;
    let mut times = (0..PARTS).map(|k| end.time * f64::from(k) / f64::from(PARTS));
    let mut next = times.next();
    let mut states = Vec::new();
    swing(model, start, |step| {
        while let Some(time) = next.filter(|time| *time <= step.end()) {
            states.push(step.at(time));
            next = times.next();
        }
    })?;
    states.push(end.state);
    Ok(states)
}

/// A place beside a foot at some way down the slope, as it is seen.
fn seen(way: f64, place: &[f64]) -> Point {
    let (sine, cosine) = walker::SLOPE.sin_cos();
    let (x, y) = (way + place[0], place[1]);
    (x * cosine + y * sine, y * cosine - x * sine)
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let model = Walker::<f64>::new(WalkerParameters::default())?;
    let struck = Struck::<f64>::new(StruckParameters::default())?;

    // It starts faster than its gait.
    let mut start = model.initial_state();
    start[2] = -1.2;
    let mut steps = Vec::new();
    for _ in 0..40 {
        let states = step(&model, start)?;
        start = strike(&model, &struck, &states[states.len() - 1])?;
        steps.push(states);
    }

    let mut phases = Panel::new(
        "Rates of both legs: eight steps, and the gait",
        "angle against the normal of the slope in rad",
        "rate in rad/s",
    );
    let way = |states: &[SVector<f64, 4>], leg: usize| -> Vec<Point> {
        states.iter().map(|x| legs(x)[leg]).collect()
    };
    for states in &steps[..8] {
        for (leg, color) in [(0, BLUE), (1, ORANGE)] {
            phases = phases.stroke(color, 0.35, 1, way(states, leg));
        }
    }
    let gait = &steps[steps.len() - 1];
    phases = phases.line("leg on the ground", BLUE, way(gait, 0)).line(
        "leg in the air",
        ORANGE,
        way(gait, 1),
    );
    let (before, after) = (legs(&gait[gait.len() - 1]), legs(&start));
    phases = phases
        .dashes("strike", GREY, vec![before[0], after[1]])
        .dashes("", GREY, vec![before[1], after[0]]);
    let (period, known) = walker::cycle();
    let known = (0..=8).map(|k| walker::at(period * f64::from(k) / 8.0, known));
    let known = known.flat_map(|[s, w, s_rate, w_rate]| [(s, s_rate), (w, w_rate)]);
    phases = phases.dots("equations by hand", GREEN, known.collect());

    let mut side =
        Panel::plane("Four steps of the gait, in sixths", "x in m", "y in m").weight(1.1);
    let mut down = 0.0;
    for states in &steps[steps.len() - 4..] {
        let mut end = down;
        for (place, state) in states.iter().enumerate().step_by(10) {
            let shown = model.output(0.0, state, &SVector::zeros(), &mut ());
            let [foot, hip, toe] = [&[0.0; 2], &shown.as_slice()[..2], &shown.as_slice()[2..]]
                .map(|place| seen(down, place));
            let opacity = if place == 0 { 1.0 } else { 0.35 };
            side = side.stroke(ORANGE, opacity, 1, vec![hip, toe]).stroke(
                BLUE,
                opacity,
                1,
                vec![foot, hip],
            );
            end = down + shown[2];
        }
        down = end;
    }
    let ends = [-0.6, down + 0.1].map(|x| seen(x, &[0.0; 2]));
    side = side.line("slope of 3°", GREY, ends.to_vec());
    picture(
        path,
        "A compass walks down a slope, with nothing but its weight",
        430,
        &[phases, side],
    )
}
