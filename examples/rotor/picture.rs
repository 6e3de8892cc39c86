//! Frequencies and growth over the speed of the rotor, as SVG.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::Mode;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// What is drawn: the start of the names of its modes, its legend, and a colour that colour-blind readers tell apart.
const KINDS: [(&str, &str, RGBColor); 4] = [
    ("lag, c", "lag: collective", RGBColor(150, 150, 150)),
    ("lag, r", "lag: regressive", RGBColor(200, 80, 0)),
    ("lag, p", "lag: progressive", RGBColor(0, 90, 160)),
    ("mast", "mast on its springs", RGBColor(30, 130, 70)),
];

/// Draws rings for the model on lines for theory.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn draw(path: &Path, sweep: &[(f64, Vec<Mode>)]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (950, 760)).into_drawing_area();
    root.fill(&WHITE)?;
    let (plots, legend) = root.split_horizontally(750);
    let (upper, lower) = plots.split_vertically(480);
    panel(
        &upper,
        "Lag of four blades and a mast on springs: frequencies",
        "frequency in rad/s",
        80.0,
        sweep,
        |value| value.im.abs(),
    )?;
    panel(
        &lower,
        "Ground resonance",
        "growth in 1/s",
        4.0,
        sweep,
        |value| value.re.max(0.0),
    )?;
    let font = ("sans-serif", 14);
    for (row, (_, name, color)) in KINDS.iter().enumerate() {
        let y = 60 + 24 * row as i32;
        legend.draw(&PathElement::new(
            vec![(0, y), (26, y)],
            color.stroke_width(2),
        ))?;
        legend.draw(&Text::new(*name, (34, y - 7), font))?;
    }
    let y = 60 + 24 * KINDS.len() as i32;
    legend.draw(&PathElement::new(
        vec![(0, y), (26, y)],
        BLACK.stroke_width(2),
    ))?;
    legend.draw(&Text::new("Coleman, Feingold", (34, y - 7), font))?;
    legend.draw(&Circle::new((13, y + 24), 4, BLACK.stroke_width(1)))?;
    legend.draw(&Text::new("eigenvalues of the model", (34, y + 17), font))?;
    root.present()?;
    Ok(())
}

fn panel(
    area: &Area,
    title: &str,
    axis: &str,
    high: f64,
    sweep: &[(f64, Vec<Mode>)],
    value: impl Fn(nalgebra::Complex<f64>) -> f64,
) -> Result<(), Box<dyn Error>> {
    let end = sweep.iter().map(|(speed, _)| *speed).fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 20))
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..end, 0.0..high)?;
    chart
        .configure_mesh()
        .x_desc("speed of the rotor in rad/s")
        .y_desc(axis)
        .light_line_style(WHITE)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .draw()?;
    for (start, _, color) in KINDS {
        let count = sweep.first().map_or(0, |(_, modes)| modes.len());
        // Of each pair of conjugates one is drawn.
        for mode in (0..count).step_by(2) {
            let of = sweep
                .iter()
                .filter_map(|(speed, modes)| Some((*speed, modes.get(mode)?)));
            let of: Vec<(f64, &Mode)> = of
                .filter(|(_, mode)| mode.name.starts_with(start))
                .collect();
            let line = of.iter().map(|(speed, mode)| (*speed, value(mode.theory)));
            chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
            let rings = of
                .iter()
                .step_by(4)
                .map(|(speed, mode)| (*speed, value(mode.found)));
            chart.draw_series(rings.map(|at| Circle::new(at, 4, color.stroke_width(1))))?;
        }
    }
    Ok(())
}
