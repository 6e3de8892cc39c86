//! Figures 10 and 11 as SVG, with the file name and axes that a reader of the paper expects.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use crate::run::Sample;

/// One curve.
pub(crate) struct Curve<'a> {
    /// Legend.
    pub name: String,
    /// Points over time.
    pub samples: &'a [Sample],
    /// Value in rad.
    pub value: Box<dyn Fn(&Sample) -> f64>,
    /// Colour by number.
    pub color: usize,
    /// How it is drawn.
    pub style: Style,
}

/// How a curve is drawn, such that one is seen on top of another.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Style {
    /// A line.
    Line,
    /// A line with gaps.
    Dashes,
    /// A ring at every twentieth of the time.
    Rings,
}

/// Three colours that stay apart for colour-blind readers and in grey.
const COLORS: [RGBColor; 3] = [
    RGBColor(0, 90, 160),
    RGBColor(200, 80, 0),
    RGBColor(30, 130, 70),
];

/// Draws curves over time.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn draw(
    path: &Path,
    title: &str,
    axis: &str,
    scale: f64,
    curves: &[Curve],
) -> Result<(), Box<dyn Error>> {
    let points = |curve: &Curve| -> Vec<(f64, f64)> {
        let shown = if curve.style == Style::Rings { 20 } else { 800 };
        let stride = (curve.samples.len() / shown).max(1);
        curve
            .samples
            .iter()
            .step_by(stride)
            .map(|sample| (sample.time, scale * (curve.value)(sample)))
            .collect()
    };
    let data: Vec<Vec<(f64, f64)>> = curves.iter().map(points).collect();
    let all = data.iter().flatten();
    let (low, high) = all.fold((0.0_f64, 0.0_f64), |(low, high), (_, y)| {
        (low.min(*y), high.max(*y))
    });
    let end = data.iter().flatten().map(|(t, _)| *t).fold(0.0, f64::max);
    let margin = 0.05 * (high - low).max(f64::MIN_POSITIVE);
    let root = SVGBackend::new(path, (950, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    // The legend stands beside the curves, where it covers none.
    let (plot, legend) = root.split_horizontally(790);
    let mut chart = ChartBuilder::on(&plot)
        .caption(title, ("sans-serif", 20))
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..end, low - margin..high + margin)?;
    chart
        .configure_mesh()
        .x_desc("time in s")
        .y_desc(axis)
        .light_line_style(WHITE)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .draw()?;
    for (number, (curve, points)) in curves.iter().zip(data).enumerate() {
        let color = COLORS[curve.color % COLORS.len()];
        let y = 60 + 22 * number as i32;
        let sample = vec![(0, y), (26, y)];
        match curve.style {
            Style::Line => {
                let style = color.stroke_width(2);
                chart.draw_series(LineSeries::new(points, style))?;
                legend.draw(&PathElement::new(sample, style))?;
            }
            Style::Dashes => {
                let style = color.stroke_width(2);
                chart.draw_series(DashedLineSeries::new(points, 7, 5, style))?;
                for start in [0, 10, 20] {
                    legend.draw(&PathElement::new(vec![(start, y), (start + 6, y)], style))?;
                }
            }
            Style::Rings => {
                let ring = |at| Circle::new(at, 4, color.stroke_width(2));
                chart.draw_series(points.into_iter().map(ring))?;
                legend.draw(&Circle::new((13, y), 4, color.stroke_width(2)))?;
            }
        }
        let font = ("sans-serif", 14);
        legend.draw(&Text::new(curve.name.clone(), (34, y - 7), font))?;
    }
    root.present()?;
    Ok(())
}
