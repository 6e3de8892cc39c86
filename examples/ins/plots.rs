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
    /// Dashes instead of a line.
    pub dashed: bool,
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
        let stride = (curve.samples.len() / 800).max(1);
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
    let root = SVGBackend::new(path, (860, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
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
    for (curve, points) in curves.iter().zip(data) {
        let color = COLORS[curve.color % COLORS.len()];
        let style = color.stroke_width(if curve.dashed { 3 } else { 2 });
        let series = if curve.dashed {
            chart.draw_series(DashedLineSeries::new(points, 7, 7, style))?
        } else {
            chart.draw_series(LineSeries::new(points, style))?
        };
        let dashed = curve.dashed;
        series.label(curve.name.clone()).legend(move |(x, y)| {
            let end = if dashed { x + 8 } else { x + 22 };
            PathElement::new(vec![(x, y), (end, y)], style)
        });
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .border_style(BLACK.mix(0.4))
        .background_style(WHITE.mix(0.9))
        .label_font(("sans-serif", 13))
        .draw()?;
    root.present()?;
    Ok(())
}
