//! Pictures as SVG: panels side by side, each with its title, a legend that covers nothing, and axes with units.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Colours that stay apart for colour-blind readers and in grey; the first three are those of the navigation system.
pub(crate) const BLUE: RGBColor = RGBColor(0, 90, 160);
pub(crate) const ORANGE: RGBColor = RGBColor(200, 80, 0);
pub(crate) const GREEN: RGBColor = RGBColor(30, 130, 70);
pub(crate) const PURPLE: RGBColor = RGBColor(130, 60, 150);
pub(crate) const GREY: RGBColor = RGBColor(120, 120, 120);

/// A colour between two: at 0 the first, at 1 the second.
pub(crate) fn shade(first: RGBColor, second: RGBColor, part: f64) -> RGBColor {
    let mix = |a: u8, b: u8| ((1.0 - part) * f64::from(a) + part * f64::from(b)).round() as u8;
    RGBColor(
        mix(first.0, second.0),
        mix(first.1, second.1),
        mix(first.2, second.2),
    )
}

const TEXT: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(228, 228, 228);
const WIDTH: u32 = 960;
const TITLE: u32 = 40;
const ROW: i32 = 20;

/// A point of a panel.
pub(crate) type Point = (f64, f64);
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Failure = Box<dyn Error>;

#[derive(Clone, Copy)]
enum Style {
    Line(u32),
    Dashes,
    Dots(u32),
}

struct Curve {
    /// What the legend says; nothing for a curve that it leaves out.
    name: String,
    color: RGBAColor,
    style: Style,
    points: Vec<Point>,
}

/// One diagram of a picture.
pub(crate) struct Panel {
    title: String,
    /// What the axes say; none for a view of a body in space.
    axes: Option<[String; 2]>,
    /// Whether a metre is as long upwards as along.
    equal: bool,
    /// Its part of the width of the picture.
    weight: f64,
    range: Option<[Point; 2]>,
    curves: Vec<Curve>,
}

impl Panel {
    /// Values over an axis.
    pub(crate) fn new(title: &str, along: &str, upwards: &str) -> Self {
        Self {
            title: title.to_owned(),
            axes: Some([along.to_owned(), upwards.to_owned()]),
            equal: false,
            weight: 1.0,
            range: None,
            curves: Vec::new(),
        }
    }

    /// A plane in which lengths are seen.
    pub(crate) fn plane(title: &str, along: &str, upwards: &str) -> Self {
        Self {
            equal: true,
            ..Self::new(title, along, upwards)
        }
    }

    /// A view of space, without axes.
    pub(crate) fn view(title: &str) -> Self {
        Self {
            axes: None,
            ..Self::plane(title, "", "")
        }
    }

    /// Takes another part of the width than 1.
    pub(crate) fn weight(self, weight: f64) -> Self {
        Self { weight, ..self }
    }

    /// Shows these values along and upwards, whatever the curves need.
    pub(crate) fn range(self, along: Point, upwards: Point) -> Self {
        Self {
            range: Some([along, upwards]),
            ..self
        }
    }

    /// A line with its name.
    pub(crate) fn line(self, name: &str, color: RGBColor, points: Vec<Point>) -> Self {
        self.curve(name, color.to_rgba(), Style::Line(2), points)
    }

    /// A line with gaps.
    pub(crate) fn dashes(self, name: &str, color: RGBColor, points: Vec<Point>) -> Self {
        self.curve(name, color.to_rgba(), Style::Dashes, points)
    }

    /// A line without a name, of a width and an opacity.
    pub(crate) fn stroke(
        self,
        color: RGBColor,
        opacity: f64,
        width: u32,
        points: Vec<Point>,
    ) -> Self {
        self.curve("", color.mix(opacity), Style::Line(width), points)
    }

    /// Filled circles.
    pub(crate) fn dots(self, name: &str, color: RGBColor, radius: u32, points: Vec<Point>) -> Self {
        self.curve(name, color.to_rgba(), Style::Dots(radius), points)
    }

    fn curve(mut self, name: &str, color: RGBAColor, style: Style, points: Vec<Point>) -> Self {
        let name = name.to_owned();
        self.curves.push(Curve {
            name,
            color,
            style,
            points,
        });
        self
    }

    fn draw(&self, area: &Area) -> Result<(), Failure> {
        let (width, _) = area.dim_in_pixel();
        let font = ("sans-serif", 15).into_font().color(&TEXT);
        area.draw(&Text::new(self.title.clone(), (16, 4), font))?;
        let below = self.legend(area, width as i32 - 16)?;
        let (_, area) = area.split_vertically(below);
        let [label_x, label_y] = if self.axes.is_some() {
            [40, 62]
        } else {
            [8, 8]
        };
        let (width, height) = area.dim_in_pixel();
        let inside = [width - label_y - 24, height - label_x - 16].map(f64::from);
        let [x, y] = self.shown(inside);
        let mut chart = ChartBuilder::on(&area)
            .margin_top(8)
            .margin_bottom(8)
            .margin_left(4)
            .margin_right(20)
            .x_label_area_size(label_x)
            .y_label_area_size(label_y)
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        if let Some([along, upwards]) = &self.axes {
            let size = [width, height].map(|side| (side / 80).clamp(3, 8) as usize);
            chart
                .configure_mesh()
                .x_desc(along)
                .y_desc(upwards)
                .x_labels(size[0])
                .y_labels(size[1] + 2)
                .bold_line_style(FAINT)
                .light_line_style(WHITE)
                .axis_style(GREY)
                .label_style(("sans-serif", 12).into_font().color(&TEXT))
                .axis_desc_style(("sans-serif", 14).into_font().color(&TEXT))
                .draw()?;
        }
        self.curves
            .iter()
            .try_for_each(|curve| curve.draw(&mut chart))
    }

    /// Draws the legend in as many rows as it takes, and tells where it ends.
    fn legend(&self, area: &Area, width: i32) -> Result<i32, Failure> {
        let (mut x, mut y) = (16, 34);
        let font = ("sans-serif", 13).into_font().color(&TEXT);
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            let wide = 44 + 7 * curve.name.chars().count() as i32;
            if x + wide > width && x > 16 {
                (x, y) = (16, y + ROW);
            }
            curve.sample(area, x, y)?;
            area.draw(&Text::new(
                curve.name.clone(),
                (x + 30, y - 7),
                font.clone(),
            ))?;
            x += wide;
        }
        Ok(if x > 16 { y + 12 } else { 24 })
    }

    /// The ranges of both axes in an area of this size in pixels.
    fn shown(&self, inside: [f64; 2]) -> [Point; 2] {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let extent = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let wider = |(low, high): Point, by: f64| (low - by, high + by);
        let margin = |range: Point, part: f64| {
            let length = (range.1 - range.0).max(f64::MIN_POSITIVE);
            wider(range, part * length)
        };
        let [x, y] = self.range.unwrap_or_else(|| {
            let along = extent(&mut points().map(|point| point.0));
            let upwards = extent(&mut points().map(|point| point.1));
            [
                margin(along, if self.equal { 0.05 } else { 0.0 }),
                margin(upwards, 0.05),
            ]
        });
        if !self.equal {
            return [x, y];
        }
        let scale = f64::max((x.1 - x.0) / inside[0], (y.1 - y.0) / inside[1]);
        let fill =
            |range: Point, pixels: f64| wider(range, (scale * pixels - (range.1 - range.0)) / 2.0);
        [fill(x, inside[0]), fill(y, inside[1])]
    }
}

impl Curve {
    fn draw(&self, chart: &mut Chart) -> Result<(), Failure> {
        let points = self.points.iter().copied();
        match self.style {
            Style::Line(width) => {
                chart.draw_series(LineSeries::new(points, self.color.stroke_width(width)))?;
            }
            Style::Dashes => {
                let style = self.color.stroke_width(2);
                chart.draw_series(DashedLineSeries::new(points, 6, 5, style))?;
            }
            Style::Dots(radius) => {
                let dot = |at| Circle::new(at, radius, self.color.filled());
                chart.draw_series(points.map(dot))?;
            }
        }
        Ok(())
    }

    /// What the legend shows of it, 24 pixels long.
    fn sample(&self, area: &Area, x: i32, y: i32) -> Result<(), Failure> {
        let line = |from: i32, to: i32, width| {
            PathElement::new(vec![(from, y), (to, y)], self.color.stroke_width(width))
        };
        match self.style {
            Style::Line(width) => area.draw(&line(x, x + 24, width))?,
            Style::Dashes => {
                for start in [0, 9, 18] {
                    area.draw(&line(x + start, x + start + 6, 2))?;
                }
            }
            Style::Dots(radius) => {
                area.draw(&Circle::new((x + 12, y), radius, self.color.filled()))?;
            }
        }
        Ok(())
    }
}

/// Writes a picture of this height in pixels.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn picture(
    path: &Path,
    title: &str,
    height: u32,
    panels: &[Panel],
) -> Result<(), Failure> {
    let root = SVGBackend::new(path, (WIDTH, height)).into_drawing_area();
    root.fill(&WHITE)?;
    let font = ("sans-serif", 19).into_font().color(&TEXT);
    root.draw(&Text::new(title.to_owned(), (16, 12), font))?;
    let (_, mut rest) = root.split_vertically(TITLE);
    let whole: f64 = panels.iter().map(|panel| panel.weight).sum();
    for panel in panels {
        let wide = f64::from(WIDTH) * panel.weight / whole;
        let (area, next) = rest.split_horizontally(wide as i32);
        panel.draw(&area)?;
        rest = next;
    }
    root.present()?;
    Ok(())
}
