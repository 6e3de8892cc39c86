//! Times as bars on a logarithmic scale.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::contestant::OURS;
use crate::report::{Report, Row, SCENES};

const WIDTH: i32 = 930;
/// Where the bars begin and end.
const LEFT: i32 = 300;
const RIGHT: i32 = 870;
const TOP: i32 = 56;
const BAR: i32 = 15;
const GAP: i32 = 14;
/// The scale in powers of ten of a nanosecond.
const DECADES: [i32; 2] = [-1, 5];

const OUR_COLOUR: RGBColor = RGBColor(196, 62, 28);
const PEER_COLOUR: RGBColor = RGBColor(120, 140, 160);
const GRID_COLOUR: RGBColor = RGBColor(222, 222, 222);

fn place(time: f64) -> i32 {
    let part = (time.log10() - f64::from(DECADES[0])) / f64::from(DECADES[1] - DECADES[0]);
    LEFT + (part.clamp(0.0, 1.0) * f64::from(RIGHT - LEFT)) as i32
}

/// The fastest variant of each with its time, fastest first.
fn best<'a>(report: &'a Report, scene: &str) -> Vec<(&'a Row, f64)> {
    let mut kept: Vec<(&Row, f64)> = Vec::new();
    for row in report.of(scene) {
        if let Some(time) = row.time
            && kept.iter().all(|(other, _)| other.peer != row.peer)
        {
            kept.push((row, time));
        }
    }
    kept
}

fn style(size: i32, horizontal: HPos) -> TextStyle<'static> {
    ("sans-serif", size)
        .into_text_style(&(100, 100))
        .pos(Pos::new(horizontal, VPos::Center))
}

/// Draws the fastest variant of each for all scenes.
pub(crate) fn draw(report: &Report, path: &Path) -> Result<(), Box<dyn Error>> {
    let scenes: Vec<_> = SCENES
        .iter()
        .map(|scene| (scene, best(report, scene.name)))
        .collect();
    let bars: usize = scenes.iter().map(|(_, rows)| rows.len()).sum();
    let bottom = TOP + bars as i32 * BAR + scenes.len() as i32 * GAP;
    let area = SVGBackend::new(path, (WIDTH as u32, bottom as u32 + 40)).into_drawing_area();
    area.fill(&WHITE)?;
    let title = "Time of one evaluation in ns, fastest variant of each; shorter is better";
    area.draw(&Text::new(title, (WIDTH / 2, 22), style(17, HPos::Center)))?;
    for decade in DECADES[0]..=DECADES[1] {
        let time = 10_f64.powi(decade);
        let x = place(time);
        area.draw(&PathElement::new([(x, TOP - 6), (x, bottom)], GRID_COLOUR))?;
        area.draw(&Text::new(
            time.to_string(),
            (x, bottom + 14),
            style(13, HPos::Center),
        ))?;
    }
    let mut y = TOP;
    for (scene, rows) in &scenes {
        let middle = y + rows.len() as i32 * BAR / 2;
        area.draw(&Text::new(
            scene.title,
            (LEFT - 78, middle),
            style(13, HPos::Right),
        ))?;
        for (row, time) in rows {
            let (colour, end) = (
                if row.peer == OURS {
                    OUR_COLOUR
                } else {
                    PEER_COLOUR
                },
                place(*time),
            );
            area.draw(&Rectangle::new(
                [(LEFT, y + 1), (end, y + BAR - 2)],
                colour.filled(),
            ))?;
            let centre = y + BAR / 2;
            area.draw(&Text::new(
                row.peer.clone(),
                (LEFT - 6, centre),
                style(12, HPos::Right),
            ))?;
            let time = format!("{time:.*}", usize::from(*time < 100.0));
            area.draw(&Text::new(time, (end + 4, centre), style(12, HPos::Left)))?;
            y += BAR;
        }
        y += GAP;
    }
    area.present()?;
    Ok(())
}
