//! Pictures as SVG: panels side by side, each with its title, a legend that covers nothing, and axes with units.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(crate) use crate::curve::Point;
use crate::curve::{Area, Chart, Curve, Failure, SCALE, Style};

/// Colours that stay apart for colour-blind readers and in grey; the first three are those of the navigation system.
pub(crate) const BLUE: RGBColor = RGBColor(0, 90, 160);
pub(crate) const ORANGE: RGBColor = RGBColor(200, 80, 0);
pub(crate) const GREEN: RGBColor = RGBColor(30, 130, 70);
pub(crate) const PURPLE: RGBColor = RGBColor(130, 60, 150);
pub(crate) const GREY: RGBColor = RGBColor(120, 120, 120);

const TEXT: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(228, 228, 228);
/// Of a picture, in pixels.
const WIDTH: u32 = 960;
/// Left of titles.
const INDENT: i32 = 16;
/// From one row of a legend to the next.
const ROW: i32 = 20;

/// A colour between two: at 0 the first, at 1 the second.
pub(crate) fn shade(first: RGBColor, second: RGBColor, part: f64) -> RGBColor {
    let mix = |a: u8, b: u8| ((1.0 - part) * f64::from(a) + part * f64::from(b)).round() as u8;
    RGBColor(
        mix(first.0, second.0),
        mix(first.1, second.1),
        mix(first.2, second.2),
    )
}

/// Letters of this height in pixels.
fn letters<'a>(height: u32) -> TextStyle<'a> {
    ("sans-serif", SCALE * height).into_font().color(&TEXT)
}

fn write(area: &Area, text: &str, [x, y]: [i32; 2], height: u32) -> Result<(), Failure> {
    let at = (SCALE as i32 * x, SCALE as i32 * y);
    Ok(area.draw(&Text::new(text.to_owned(), at, letters(height)))?)
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
    curves: Vec<Curve>,
    labels: Vec<(String, Point)>,
}

impl Panel {
    /// Values over an axis.
    pub(crate) fn new(title: &str, along: &str, upwards: &str) -> Self {
        Self {
            title: title.to_owned(),
            axes: Some([along.to_owned(), upwards.to_owned()]),
            equal: false,
            weight: 1.0,
            curves: Vec::new(),
            labels: Vec::new(),
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

    /// A line with its name.
    pub(crate) fn line(self, name: &str, color: RGBColor, points: Vec<Point>) -> Self {
        self.curve(name, color.to_rgba(), Style::Line(2), points)
    }

    /// A line with gaps.
    pub(crate) fn dashes(self, name: &str, color: RGBColor, points: Vec<Point>) -> Self {
        self.curve(name, color.to_rgba(), Style::Dashes, points)
    }

    /// A line without a name, of an opacity and a width.
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
    pub(crate) fn dots(self, name: &str, color: RGBColor, points: Vec<Point>) -> Self {
        self.curve(name, color.to_rgba(), Style::Dots(4), points)
    }

    /// A word at a point.
    pub(crate) fn label(mut self, text: &str, at: Point) -> Self {
        self.labels.push((text.to_owned(), at));
        self
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

    /// Where the legend shows each curve that it names, in an area of a width in pixels.
    fn legend(&self, width: i32) -> Vec<(&Curve, [i32; 2])> {
        let (mut x, mut y) = (INDENT, 34);
        let mut placed = Vec::new();
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            let wide = 44 + 7 * curve.name.chars().count() as i32;
            if x + wide > width && x > INDENT {
                (x, y) = (INDENT, y + ROW);
            }
            placed.push((curve, [x, y]));
            x += wide;
        }
        placed
    }

    /// Draws it with its axes from so many pixels below its top.
    fn draw(&self, area: &Area, below: i32) -> Result<(), Failure> {
        write(area, &self.title, [INDENT, 4], 15)?;
        for (curve, [x, y]) in self.legend(shown_width(area)) {
            curve.sample(area, x, y)?;
            write(area, &curve.name, [x + 30, y - 7], 13)?;
        }
        let (_, area) = area.split_vertically(SCALE as i32 * below);
        let labels = if self.axes.is_some() {
            [40, 62]
        } else {
            [8, 8]
        };
        let (width, height) = area.dim_in_pixel();
        let inside = [
            f64::from(width - SCALE * (labels[1] + 24)),
            f64::from(height - SCALE * (labels[0] + 16)),
        ];
        let [x, y] = self.ranges(inside);
        let mut chart = ChartBuilder::on(&area)
            .margin_top(SCALE * 8)
            .margin_bottom(SCALE * 8)
            .margin_left(SCALE * 4)
            .margin_right(SCALE * 20)
            .x_label_area_size(SCALE * labels[0])
            .y_label_area_size(SCALE * labels[1])
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        self.mesh(&mut chart, [width, height].map(|side| side / SCALE))?;
        let unit = [inside[0] / (x.1 - x.0), inside[1] / (y.1 - y.0)];
        for curve in &self.curves {
            curve.draw(&mut chart, unit)?;
        }
        let style = letters(14).pos(Pos::new(HPos::Center, VPos::Center));
        let words = self.labels.iter();
        chart.draw_series(words.map(|(text, at)| Text::new(text.clone(), *at, style.clone())))?;
        Ok(())
    }

    fn mesh(&self, chart: &mut Chart, [width, height]: [u32; 2]) -> Result<(), Failure> {
        let Some([along, upwards]) = &self.axes else {
            return Ok(());
        };
        // What is left of a step by rounding is no digit.
        let digits = |value: &f64| format!("{}", (value * 1e6).round() / 1e6 + 0.0);
        chart
            .configure_mesh()
            .x_desc(along)
            .y_desc(upwards)
            .x_labels((width / 80).clamp(3, 8) as usize)
            .y_labels((height / 45).clamp(4, 8) as usize)
            .x_label_formatter(&digits)
            .y_label_formatter(&digits)
            .bold_line_style(FAINT.stroke_width(SCALE))
            .light_line_style(WHITE.mix(0.0))
            .axis_style(GREY.stroke_width(SCALE))
            .set_all_tick_mark_size(SCALE * 4)
            .label_style(letters(12))
            .axis_desc_style(letters(14))
            .draw()?;
        Ok(())
    }

    /// The ranges of both axes in an area of this size.
    fn ranges(&self, inside: [f64; 2]) -> [Point; 2] {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let wider = |(low, high): Point, by: f64| (low - by, high + by);
        let extent = |values: &mut dyn Iterator<Item = f64>, part: f64| {
            let nothing = (f64::INFINITY, f64::NEG_INFINITY);
            let all = values.fold(nothing, |(low, high), value| {
                (low.min(value), high.max(value))
            });
            wider(all, part * (all.1 - all.0).max(f64::MIN_POSITIVE))
        };
        let x = extent(
            &mut points().map(|point| point.0),
            if self.equal { 0.05 } else { 0.0 },
        );
        let y = extent(&mut points().map(|point| point.1), 0.05);
        if !self.equal {
            return [x, y];
        }
        let scale = f64::max((x.1 - x.0) / inside[0], (y.1 - y.0) / inside[1]);
        let fill =
            |range: Point, pixels: f64| wider(range, (scale * pixels - (range.1 - range.0)) / 2.0);
        [fill(x, inside[0]), fill(y, inside[1])]
    }
}

/// How wide a legend may be, in pixels of the picture.
fn shown_width(area: &Area) -> i32 {
    (area.dim_in_pixel().0 / SCALE) as i32 - INDENT
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
    let large = (SCALE * WIDTH, SCALE * height);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, large).into_drawing_area();
        root.fill(&WHITE)?;
        write(&root, title, [INDENT, 12], 19)?;
        let (_, mut rest) = root.split_vertically(SCALE * 40);
        let whole: f64 = panels.iter().map(|panel| panel.weight).sum();
        let mut areas = Vec::new();
        for panel in panels {
            let wide = f64::from(large.0) * panel.weight / whole;
            let (area, next) = rest.split_horizontally(wide as i32);
            areas.push(area);
            rest = next;
        }
        // All diagrams begin below the longest legend.
        let legends = panels.iter().zip(&areas).flat_map(|(panel, area)| {
            let placed = panel.legend(shown_width(area));
            placed.into_iter().map(|(_, [_, y])| y + 12)
        });
        let below = legends.max().unwrap_or(24);
        for (panel, area) in panels.iter().zip(&areas) {
            panel.draw(area, below)?;
        }
        root.present()?;
    }
    let size = |(width, height)| format!("width=\"{width}\" height=\"{height}\"");
    let text = text.replacen(&size(large), &size((WIDTH, height)), 1);
    std::fs::write(path, text)?;
    Ok(())
}
