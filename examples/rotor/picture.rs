//! Frequencies and growth over the speed of the rotor, as SVG.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::Mode;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Colours that colour-blind readers tell apart.
const WHIRL: RGBColor = RGBColor(200, 80, 0);
const COLLECTIVE: RGBColor = RGBColor(0, 90, 160);

/// Points over the speed of the rotor.
type Points = Vec<(f64, f64)>;

/// What is drawn: theory and model in one colour.
struct Curve {
    theory: Points,
    found: Points,
    color: RGBColor,
}

/// Draws rings for the model on lines for theory.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn draw(path: &Path, sweep: &[(f64, Vec<Mode>)]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (960, 760)).into_drawing_area();
    root.fill(&WHITE)?;
    let (plots, side) = root.split_horizontally(750);
    let (upper, lower) = plots.split_vertically(480);
    let title = "Lag of four blades, seen from a mast on springs";
    panel(
        &upper,
        title,
        "frequency in rad/s",
        100.0,
        &frequencies(sweep),
    )?;
    let title = "Ground resonance: growth of the fastest whirl";
    panel(&lower, title, "growth in 1/s", 4.0, &[growth(sweep)])?;
    legend(&side)?;
    root.present()?;
    Ok(())
}

/// The four whirls of mast and cyclic lag, from the one against the rotation to the fastest one with it: in this order
/// they go on without jumps, whatever each is mostly made of.
fn whirls(modes: &[Mode]) -> Vec<&Mode> {
    // Of each pair of conjugates one.
    let cyclic = |mode: &&Mode| {
        ["mast", "lag, regressive", "lag, progressive"]
            .iter()
            .any(|start| mode.name.starts_with(start))
    };
    let mut whirls: Vec<&Mode> = modes.iter().step_by(2).filter(cyclic).collect();
    whirls.sort_by(|a, b| a.theory.im.total_cmp(&b.theory.im));
    whirls
}

fn collective(modes: &[Mode]) -> Vec<&Mode> {
    let is_collective = |mode: &&Mode| mode.name == "lag, collective";
    modes.iter().filter(is_collective).take(1).collect()
}

fn frequencies(sweep: &[(f64, Vec<Mode>)]) -> Vec<Curve> {
    let curve = |select: fn(&[Mode]) -> Vec<&Mode>, rank: usize, color: RGBColor| {
        let points = |value: fn(&Mode) -> f64| {
            let modes = sweep
                .iter()
                .filter_map(|(speed, modes)| Some((*speed, *select(modes).get(rank)?)));
            modes.map(|(speed, mode)| (speed, value(mode))).collect()
        };
        Curve {
            theory: points(|mode| mode.theory.im.abs()),
            found: points(|mode| mode.found.im.abs()),
            color,
        }
    };
    let mut curves = vec![curve(collective, 0, COLLECTIVE)];
    curves.extend((0..4).map(|rank| curve(whirls, rank, WHIRL)));
    curves
}

fn growth(sweep: &[(f64, Vec<Mode>)]) -> Curve {
    let points = |value: fn(&Mode) -> f64| {
        let fastest = |modes: &[Mode]| whirls(modes).into_iter().map(value).fold(0.0, f64::max);
        let points = sweep.iter().map(|(speed, modes)| (*speed, fastest(modes)));
        points.collect()
    };
    Curve {
        theory: points(|mode| mode.theory.re),
        found: points(|mode| mode.found.re),
        color: WHIRL,
    }
}

fn legend(area: &Area) -> Result<(), Box<dyn Error>> {
    let rows = [
        ("mast and cyclic lag", Some(WHIRL)),
        ("collective lag", Some(COLLECTIVE)),
        ("Coleman and Feingold", Some(BLACK)),
        ("eigenvalues of the model", None),
    ];
    for (row, (name, line)) in rows.into_iter().enumerate() {
        let y = 60 + 24 * row as i32;
        match line {
            Some(color) => area.draw(&PathElement::new(
                vec![(0, y), (26, y)],
                color.stroke_width(2),
            ))?,
            None => area.draw(&Circle::new((13, y), 4, BLACK.stroke_width(1)))?,
        }
        area.draw(&Text::new(name, (34, y - 7), ("sans-serif", 14)))?;
    }
    Ok(())
}

fn panel(
    area: &Area,
    title: &str,
    axis: &str,
    high: f64,
    curves: &[Curve],
) -> Result<(), Box<dyn Error>> {
    let ends = curves.iter().flat_map(|curve| &curve.theory);
    let end = ends.map(|(speed, _)| *speed).fold(0.0, f64::max);
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
    for curve in curves {
        let line = curve.theory.iter().copied();
        chart.draw_series(LineSeries::new(line, curve.color.stroke_width(2)))?;
        let rings = curve.found.iter().copied().step_by(4);
        let ring = |at| Circle::new(at, 4, curve.color.stroke_width(1));
        chart.draw_series(rings.map(ring))?;
    }
    Ok(())
}
