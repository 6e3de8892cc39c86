//! The picture: error against time, evaluations and steps.

use std::error::Error;
use std::ops::Range;
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

const WIDTH: i32 = 1320;
/// From one row of the legend to the next.
const ROW: i32 = 24;
/// Left of the legend, and of the lines in it.
const INDENT: i32 = 76;
const CERTAINTY: &str = "certainty of the reference";

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
        series.retain(|(_, points)| !points.is_empty());
        if series.is_empty() {
            return Err("no run came to its end, so there is nothing to draw".into());
        }
        for (_, points) in &mut series {
            points.retain(|point| point.error > 0.0);
        }
        series.retain(|(_, points)| !points.is_empty());
        if series.is_empty() {
            return Err("all errors are zero, which has no place on a logarithmic axis".into());
        }
        let agreement = self.reference().agreement;
        let errors = range(all(&series).map(|point| point.error));
        let certainty = errors.contains(&agreement).then_some(agreement);
        let legend = legend(&series, certainty.is_some());
        let rows = legend.last().map_or(0, |(_, _, [_, y])| *y) + ROW;
        let root = SVGBackend::new(path.as_ref(), (WIDTH as u32, 480 + rows as u32));
        let root = root.into_drawing_area();
        root.fill(&WHITE)?;
        let (head, panels) = root.split_vertically(40 + rows);
        let title = format!("Speed against error: {}", self.problem().title);
        head.draw(&Text::new(title, (INDENT, 14), ("sans-serif", 22)))?;
        for (name, style, [x, y]) in legend {
            let y = y + 50;
            head.draw(&PathElement::new([(x, y), (x + 26, y)], style))?;
            head.draw(&Text::new(name, (x + 34, y - 8), ("sans-serif", 16)))?;
        }
        for (panel, axis) in panels.split_evenly((1, 3)).iter().zip(AXES) {
            panel_of(panel, &series, axis, &errors, certainty)?;
        }
        root.present()?;
        Ok(())
    }
}

/// From half the smallest to twice the largest of those that have a place on a logarithmic axis.
fn range(values: impl Iterator<Item = f64> + Clone) -> Range<f64> {
    let values = values.filter(|value| *value > 0.0);
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(0.0, f64::max);
    if low > high {
        return 1.0..10.0;
    }
    0.5 * low..2.0 * high
}

fn all<'a>(series: &'a [Series<'_>]) -> impl Iterator<Item = &'a Measured> + Clone {
    series.iter().flat_map(|(_, points)| points)
}

fn coloured<'a>(series: &'a [Series<'a>]) -> impl Iterator<Item = (&'a Series<'a>, ShapeStyle)> {
    let styles = COLOURS.iter().cycle().map(|colour| colour.stroke_width(2));
    series.iter().zip(styles)
}

/// Names and lines with the places where they stand, in rows as wide as the picture.
fn legend<'a>(series: &'a [Series<'a>], certainty: bool) -> Vec<(&'a str, ShapeStyle, [i32; 2])> {
    let methods = coloured(series).map(|((name, _), style)| (*name, style));
    let certainty = certainty.then(|| (CERTAINTY, faint()));
    let (mut x, mut y) = (INDENT, 0);
    let place = |(name, style): (&'a str, ShapeStyle)| {
        let wide = 60 + 9 * name.chars().count() as i32;
        if x + wide > WIDTH {
            (x, y) = (INDENT, y + ROW);
        }
        let at = [x, y];
        x += wide;
        (name, style, at)
    };
    methods.chain(certainty).map(place).collect()
}

fn faint() -> ShapeStyle {
    BLACK.mix(0.5).into()
}

fn panel_of(
    panel: &DrawingArea<SVGBackend<'_>, Shift>,
    series: &[Series<'_>],
    (name, work): Axis,
    errors: &Range<f64>,
    certainty: Option<f64>,
) -> Result<(), Box<dyn Error>> {
    let works = range(all(series).map(work));
    let mut chart = ChartBuilder::on(panel)
        .margin(12)
        .margin_right(28)
        .x_label_area_size(48)
        .y_label_area_size(70)
        .build_cartesian_2d(works.clone().log_scale(), errors.clone().log_scale())?;
    chart
        .configure_mesh()
        .x_desc(name)
        .y_desc("largest relative error")
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .x_labels(6)
        .light_line_style(WHITE)
        .draw()?;
    if let Some(certainty) = certainty {
        let limit = [(works.start, certainty), (works.end, certainty)];
        chart.draw_series(DashedLineSeries::new(limit, 6, 4, faint()))?;
    }
    for ((_, points), style) in coloured(series) {
        // What solvers from elsewhere do not tell is zero.
        let known = points.iter().filter(|point| work(point) > 0.0);
        let line = known.map(|point| (work(point), point.error));
        chart.draw_series(LineSeries::new(line, style).point_size(3))?;
    }
    Ok(())
}
