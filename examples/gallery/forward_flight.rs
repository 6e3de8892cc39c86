//! A rotor in forward flight: how its blades flap, which pitch keeps it level, and up to which speed they stay on their way.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use mbg_runtime::{Adaptive, Constant, Cycle, Dop853, Integrator, PeriodicTrim, System, mbg};
use nalgebra::{Matrix2, Vector2};

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, Point, picture};

mbg! { include "examples/gallery/blade.mbg"; }

/// The mean over a turn of what the model sums up as the lift of a blade.
const LIFT: f64 = 0.03;
const TURN: f64 = TAU / 30.0;
const SOLVER: Adaptive<'static, Dop853> = Adaptive::new(Dop853, 1e-9, 1e-9);

fn blade(advance: f64) -> Result<Blade<f64>, Box<dyn Error>> {
    Ok(Blade::new(BladeParameters {
        advance,
        ..Default::default()
    })?)
}

/// The flap angle over a turn, in degrees, with a pitch that is the same all around.
fn flapping(advance: f64) -> Result<Vec<Point>, Box<dyn Error>> {
    let blade = blade(advance)?;
    let cycle = PeriodicTrim::new(&blade, &SOLVER, TURN)
        .fix("lateral")
        .fix("longitudinal")
        .grows("lifted", LIFT * TURN)
        .free("back")
        .free("aside")
        .solve()?;
    let times: Vec<f64> = (0..=180).map(|k| f64::from(k) / 180.0 * TURN).collect();
    let mut points = Vec::new();
    let input = Constant(cycle.input);
    SOLVER.sample_outputs(&blade, &input, 0.0, cycle.state, &times, |t, _, y| {
        points.push((360.0 * t / TURN, y[0].to_degrees()));
    })?;
    Ok(points)
}

/// The pitch with which the rotor carries its load and does not lean.
fn level(advance: f64) -> Result<[f64; 3], Box<dyn Error>> {
    let blade = blade(advance)?;
    let cycle = PeriodicTrim::new(&blade, &SOLVER, TURN)
        .grows("lifted", LIFT * TURN)
        .solve()?;
    Ok(cycle.input.map(f64::to_degrees).into())
}

/// The size of the largest multiplier of the flapping, which the pitch has no influence on.
fn multiplier(advance: f64) -> Result<f64, Box<dyn Error>> {
    let blade = blade(advance)?;
    let mut trim = PeriodicTrim::new(&blade, &SOLVER, TURN);
    for name in ["collective", "lateral", "longitudinal"] {
        trim = trim.fix(name);
    }
    for name in ["lifted", "back", "aside"] {
        trim = trim.free(name);
    }
    let Cycle { monodromy, .. } = trim.solve()?;
    let places = ["blade.p", "centrifugal.q"].map(|name| Blade::<f64>::META.state(name));
    let [Some(rate), Some(angle)] = places else {
        return Err("a state has another name".into());
    };
    Ok(largest(&Matrix2::new(
        monodromy[(angle, angle)],
        monodromy[(angle, rate)],
        monodromy[(rate, angle)],
        monodromy[(rate, rate)],
    )))
}

/// The same of the equation written by hand, in steps of a two thousandth of a turn by the method of Runge and Kutta.
fn by_hand(advance: f64) -> f64 {
    let slope = |azimuth: f64, x: Vector2<f64>| {
        let strips = (0..20).map(|k| {
            let place = (f64::from(k) + 0.5) / 20.0;
            let ahead = place + advance * azimuth.sin();
            -place * ahead.abs() * (place * x[1] + advance * azimuth.cos() * x[0]) / 20.0
        });
        Vector2::new(x[1], 4.0 * strips.sum::<f64>() - x[0])
    };
    let h = TAU / 2000.0;
    let after_a_turn = |mut x: Vector2<f64>| {
        for k in 0..2000 {
            let at = f64::from(k) * h;
            let a = slope(at, x);
            let b = slope(at + 0.5 * h, x + 0.5 * h * a);
            let c = slope(at + 0.5 * h, x + 0.5 * h * b);
            let d = slope(at + h, x + h * c);
            x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
        x
    };
    let columns = [Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0)];
    largest(&Matrix2::from_columns(&columns.map(after_a_turn)))
}

/// The size of the larger eigenvalue.
fn largest(matrix: &Matrix2<f64>) -> f64 {
    let (half, product) = (0.5 * matrix.trace(), matrix.determinant());
    let square = half * half - product;
    if square < 0.0 {
        product.sqrt()
    } else {
        half.abs() + square.sqrt()
    }
}

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let mut flaps = Panel::new(
        "Pitch the same all around",
        "azimuth in °",
        "flap angle in °",
    );
    for (advance, color) in [(0.0, GREY), (0.2, BLUE), (0.4, ORANGE)] {
        flaps = flaps.line(&format!("μ = {advance}"), color, flapping(advance)?);
    }
    let pitches = (0..=25).map(|k| 0.02 * f64::from(k));
    let pitches = pitches.map(|advance| Ok((advance, level(advance)?)));
    let pitches: Vec<(f64, [f64; 3])> = pitches.collect::<Result<_, Box<dyn Error>>>()?;
    let pitch = |place: usize| pitches.iter().map(|it| (it.0, it.1[place])).collect();
    let swash_plate = Panel::new(
        "Pitch that keeps the rotor level",
        "advance ratio μ",
        "pitch in °",
    )
    .line("collective", BLUE, pitch(0))
    .line("lateral", GREEN, pitch(1))
    .line("longitudinal", ORANGE, pitch(2));
    let found = (0..=100).map(|k| 0.025 * f64::from(k));
    let found = found.map(|advance| Ok((advance, multiplier(advance)?)));
    let found = found.collect::<Result<_, Box<dyn Error>>>()?;
    let hand = (0..=20).map(|k| 0.125 * f64::from(k));
    let stability = Panel::new(
        "Flapping behind a turn",
        "advance ratio μ",
        "largest multiplier",
    )
    .line("found", BLUE, found)
    .dots("by hand", GREY, hand.map(|it| (it, by_hand(it))).collect())
    .dashes(
        "neither grows nor decays",
        ORANGE,
        vec![(0.0, 1.0), (2.5, 1.0)],
    );
    picture(
        path,
        "A blade of a rotor in forward flight",
        400,
        &[flaps, swash_plate, stability],
    )
}
