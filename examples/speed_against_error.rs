//! Speed against error on the inertial navigation system: RK4 over steps, adaptive methods over tolerances.
//!
//! `cargo run --release --example speed_against_error`

#[path = "ins/models.rs"]
#[allow(dead_code)]
mod models;
#[path = "ins/reference.rs"]
#[allow(dead_code)]
mod reference;

use std::error::Error;
use std::time::Instant;

use mbg_runtime::{Adaptive, Dop853, Integrator, Rk4, Statistics, Stopped, System, Tsit5};
use models::{Ins, InsParameters, gust};
use nalgebra::SVector;
use plotters::prelude::*;

/// One measurement.
struct Point {
    setting: String,
    error: f64,
    evaluations: u64,
    microseconds: f64,
}

type State = SVector<f64, 9>;

/// Error of the angles over all instants of the reference, relative to the largest of each; NaN if one is missing.
fn error(found: &[(f64, State)]) -> f64 {
    let mut worst = 0.0_f64;
    for axis in 0..3 {
        let scale = reference::PULSE
            .iter()
            .map(|instant| instant.alpha[axis].abs())
            .fold(0.0, f64::max);
        for instant in &reference::PULSE {
            let Some((_, x)) = found
                .iter()
                .find(|(time, _)| (time - instant.time).abs() < 1e-9)
            else {
                return f64::NAN;
            };
            worst = worst.max((x[6 + axis] - instant.alpha[axis]).abs() / scale);
        }
    }
    worst
}

/// Runs once for the error and often for the time; the median counts.
fn measure(
    setting: String,
    run: impl Fn(&mut Vec<(f64, State)>) -> Result<Statistics, Stopped>,
) -> Result<Point, Stopped> {
    let mut found = Vec::new();
    let statistics = run(&mut found)?;
    let mut times: Vec<f64> = (0..31)
        .map(|_| {
            let start = Instant::now();
            found.clear();
            let _ = std::hint::black_box(run(&mut found));
            start.elapsed().as_secs_f64() * 1e6
        })
        .collect();
    times.sort_by(f64::total_cmp);
    Ok(Point {
        setting,
        error: error(&found),
        evaluations: statistics.evaluations,
        microseconds: times[15],
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let model = Ins::new(InsParameters::default())?;
    let gust = gust(0.1);
    let start = model.initial_state();
    let times: Vec<f64> = reference::PULSE
        .iter()
        .map(|instant| instant.time)
        .collect();
    let mut fixed = Vec::new();
    for step in [0.1, 0.05, 0.02, 0.01, 0.001] {
        fixed.push(measure(format!("h = {step}"), |found| {
            Rk4::fixed(&model, &gust, 0.0, 20.0, step, start, |t, x| {
                found.push((t, *x))
            })
        })?);
    }
    let mut tsit5 = Vec::new();
    let mut dop853 = Vec::new();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let setting = || format!("rtol = {tolerance:e}");
        tsit5.push(measure(setting(), |found| {
            let solver = Adaptive::new(Tsit5, tolerance, tolerance * 1e-4);
            solver.sample(&model, &gust, 0.0, start, &times, |t, x| {
                found.push((t, *x))
            })
        })?);
        dop853.push(measure(setting(), |found| {
            let solver = Adaptive::new(Dop853, tolerance, tolerance * 1e-4);
            solver.sample(&model, &gust, 0.0, start, &times, |t, x| {
                found.push((t, *x))
            })
        })?);
    }
    let series = [("RK4", &fixed), ("Tsit5", &tsit5), ("Dop853", &dop853)];
    println!("gimbal angles of the INS, 0 to 20 s, gust of 0.1 s, median of 31 runs\n");
    println!(
        "{:<10}{:<16}{:>12}{:>14}{:>14}",
        "method", "setting", "error", "evaluations", "time / µs"
    );
    for (method, points) in &series {
        for point in *points {
            println!(
                "{method:<10}{:<16}{:>12.1e}{:>14}{:>14.1}",
                point.setting, point.error, point.evaluations, point.microseconds
            );
        }
    }
    std::fs::create_dir_all("out")?;
    draw(&series)?;
    println!("\nwrote out/speed_against_error.svg");
    Ok(())
}

fn draw(series: &[(&str, &Vec<Point>)]) -> Result<(), Box<dyn Error>> {
    let all = || series.iter().flat_map(|(_, points)| points.iter());
    let low = all().map(|point| point.error).fold(f64::INFINITY, f64::min) / 3.0;
    let high = all().map(|point| point.error).fold(0.0, f64::max) * 3.0;
    let slowest = all().map(|point| point.microseconds).fold(0.0, f64::max) * 2.0;
    let fastest = all()
        .map(|point| point.microseconds)
        .fold(f64::INFINITY, f64::min)
        / 2.0;
    let root = SVGBackend::new("out/speed_against_error.svg", (860, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(
            "Speed against error: gimbal angles of the INS, 0 to 20 s",
            ("sans-serif", 20),
        )
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(72)
        .build_cartesian_2d((fastest..slowest).log_scale(), (low..high).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("CPU time in µs")
        .y_desc("largest relative error")
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .light_line_style(WHITE)
        .draw()?;
    for ((name, points), color) in series.iter().zip([
        RGBColor(0, 90, 160),
        RGBColor(200, 80, 0),
        RGBColor(0, 130, 90),
    ]) {
        let line: Vec<(f64, f64)> = points
            .iter()
            .map(|point| (point.microseconds, point.error))
            .collect();
        chart
            .draw_series(LineSeries::new(line, color.stroke_width(2)).point_size(4))?
            .label(*name)
            .legend(move |(x, y)| {
                PathElement::new(vec![(x, y), (x + 22, y)], color.stroke_width(2))
            });
    }
    chart
        .configure_series_labels()
        .border_style(BLACK.mix(0.4))
        .background_style(WHITE.mix(0.9))
        .draw()?;
    root.present()?;
    Ok(())
}
