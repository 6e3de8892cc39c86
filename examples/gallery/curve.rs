//! Curves of a panel.

use std::error::Error;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Pictures are drawn this many times larger than they are shown: the backend knows whole pixels only.
pub(crate) const SCALE: u32 = 4;

/// A point of a panel.
pub(crate) type Point = (f64, f64);
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub(crate) type Failure = Box<dyn Error>;

#[derive(Clone, Copy)]
pub(crate) enum Style {
    /// Of a width.
    Line(u32),
    Dashes,
    /// Of a radius.
    Dots(u32),
}

pub(crate) struct Curve {
    /// What the legend says; nothing for a curve that it leaves out.
    pub(crate) name: String,
    pub(crate) color: RGBAColor,
    pub(crate) style: Style,
    pub(crate) points: Vec<Point>,
}

impl Curve {
    /// Draws it where a unit along and upwards is so many pixels.
    pub(crate) fn draw(&self, chart: &mut Chart, unit: [f64; 2]) -> Result<(), Failure> {
        match self.style {
            Style::Line(width) => {
                let style = self.color.stroke_width(SCALE * width);
                chart.draw_series(LineSeries::new(self.thinned(unit), style))?;
            }
            Style::Dashes => {
                let style = self.color.stroke_width(SCALE * 2);
                let points = self.thinned(unit);
                chart.draw_series(DashedLineSeries::new(points, SCALE * 6, SCALE * 5, style))?;
            }
            Style::Dots(radius) => {
                let dot = |at| Circle::new(at, SCALE * radius, self.color.filled());
                chart.draw_series(self.points.iter().copied().map(dot))?;
            }
        }
        Ok(())
    }

    /// The points without those that are less than a pixel of the picture from the one before.
    fn thinned(&self, unit: [f64; 2]) -> Vec<Point> {
        let near = |a: Point, b: Point| {
            let apart = f64::hypot((a.0 - b.0) * unit[0], (a.1 - b.1) * unit[1]);
            apart < f64::from(SCALE)
        };
        let mut kept: Vec<Point> = Vec::new();
        for point in &self.points {
            if kept.last().is_none_or(|last| !near(*last, *point)) {
                kept.push(*point);
            }
        }
        if let Some(last) = self.points.last() {
            kept.push(*last);
        }
        kept
    }

    /// What the legend shows of it, 24 pixels long.
    pub(crate) fn sample(&self, area: &Area, x: i32, y: i32) -> Result<(), Failure> {
        let pixel = SCALE as i32;
        let line = |from: i32, to: i32, width| {
            let ends = vec![(pixel * from, pixel * y), (pixel * to, pixel * y)];
            PathElement::new(ends, self.color.stroke_width(SCALE * width))
        };
        match self.style {
            Style::Line(width) => area.draw(&line(x, x + 24, width))?,
            Style::Dashes => {
                for start in [0, 9, 18] {
                    area.draw(&line(x + start, x + start + 6, 2))?;
                }
            }
            Style::Dots(radius) => {
                let at = (pixel * (x + 12), pixel * y);
                area.draw(&Circle::new(at, SCALE * radius, self.color.filled()))?;
            }
        }
        Ok(())
    }
}
