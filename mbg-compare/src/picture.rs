//! The picture: error against time, evaluations and steps.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::{Comparison, Measured};

const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 90, 160),
    RGBColor(200, 80, 0),
    RGBColor(0, 130, 90),
    RGBColor(150, 40, 130),
    RGBColor(120, 120, 0),
    RGBColor(200, 0, 60),
    RGBColor(90, 90, 90),
    RGBColor(0, 150, 190),
];

/// An axis of work: its name with unit, and how it is read off.
type Axis = (&'static str, fn(&Measured) -> f64);

const AXES: [Axis; 3] = [
    ("CPU time in µs", |it| it.time * 1e6),
    ("evaluations of the derivative", |it| it.evaluations as f64),
    ("steps, rejected ones included", |it| it.steps as f64),
];

/// A series of measurements with its name.
type Series<'a> = (&'a str, Vec<Measured>);

impl<S, I, const N: usize, const M: usize, const P: usize> Comparison<'_, S, I, N, M, P> {
    /// Writes a picture in SVG with three panels: the error against the time of the processor, the evaluations of the
    /// derivative and the steps, all axes logarithmic.
    ///
    /// # Errors
    ///
    /// The file cannot be written, or there is nothing to draw.
    pub fn draw(&self, path: impl AsRef<Path>) -> Result<(), Box<dyn Error>> {
        let mut series: Vec<Series<'_>> = self
            .methods()
            .into_iter()
            .map(|method| (method, self.series(method)))
            .collect();
        for (_, points) in &mut series {
            points.retain(|point| point.error > 0.0);
        }
        series.retain(|(_, points)| !points.is_empty());
        if series.is_empty() {
            return Err("no run came to its end, so there is nothing to draw".into());
        }
        let root = SVGBackend::new(path.as_ref(), (1320, 480)).into_drawing_area();
        root.fill(&WHITE)?;
        let titled = root.titled(
            &format!("Speed against error: {}", self.problem().title),
            ("sans-serif", 20),
        )?;
        for (place, (panel, axis)) in titled.split_evenly((1, 3)).iter().zip(AXES).enumerate() {
            panel_of(panel, &series, axis, self.reference().agreement, place == 0)?;
        }
        root.present()?;
        Ok(())
    }
}

/// From half the smallest to twice the largest.
fn range(values: impl Iterator<Item = f64> + Clone) -> core::ops::Range<f64> {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(0.0, f64::max);
    0.5 * low..2.0 * high
}

fn panel_of(
    panel: &DrawingArea<SVGBackend<'_>, Shift>,
    series: &[Series<'_>],
    (name, work): Axis,
    agreement: f64,
    legend: bool,
) -> Result<(), Box<dyn Error>> {
    let all = series.iter().flat_map(|(_, points)| points);
    let works = range(all.clone().map(work));
    let errors = range(all.map(|point| point.error));
    let mut chart = ChartBuilder::on(panel)
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(works.clone().log_scale(), errors.clone().log_scale())?;
    chart
        .configure_mesh()
        .x_desc(name)
        .y_desc("largest relative error")
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .x_labels(6)
        .light_line_style(WHITE)
        .draw()?;
    if errors.contains(&agreement) {
        let limit = [(works.start, agreement), (works.end, agreement)];
        let dashes = DashedLineSeries::new(limit, 6, 4, BLACK.mix(0.5).into());
        let entry = chart.draw_series(dashes)?;
        entry
            .label("certainty of the reference")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 22, y)], BLACK.mix(0.5)));
    }
    for ((name, points), colour) in series.iter().zip(COLOURS.iter().cycle()) {
        let line = points.iter().map(|point| (work(point), point.error));
        chart
            .draw_series(LineSeries::new(line, colour.stroke_width(2)).point_size(3))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], colour.stroke_width(2)));
    }
    if legend {
        chart
            .configure_series_labels()
            .border_style(BLACK.mix(0.4))
            .background_style(WHITE.mix(0.9))
            .draw()?;
    }
    Ok(())
}
