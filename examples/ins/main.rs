//! The inertial navigation system of Tod et al. (2013) in both architectures, against a reference, with Figures 10
//! and 11.
//!
//! `cargo run --release --example ins -- --pulse 0.1 --step 1e-3 --method rk4 --out out/ins`

mod models;
mod plots;
mod reference;
mod run;

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mbg_runtime::{Meta, System};
use models::{
    Ins, InsClassic, InsClassicObserved, InsClassicObservedParameters, InsObserved,
    InsObservedParameters, gust,
};
use plots::{Curve, Style};
use run::{Method, Sample, errors};

const HELP: &str = "\
usage: cargo run --release --example ins -- [options]

  --pulse SECONDS     width of the gust; there is a reference for 0.1 and for 1   (0.1)
  --method NAME       rk4: steps of constant length                               (rk4)
                      dop853: order 8 at a tolerance
  --step SECONDS      rk4: length of a step; dop853: time between two samples       (1e-3)
  --tolerance NUMBER  dop853: relative error of a step                              (1e-10)
  --out DIR           where CSV and figures go                                    (out/ins)
  --help              this text

examples:
  cargo run --release --example ins -- --pulse 1 --step 2e-3 --out out/hard
  cargo run --release --example ins -- --method dop853 --tolerance 1e-8 --step 1e-2";

struct Options {
    pulse: f64,
    method: Method,
    step: f64,
    out: PathBuf,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let (mut pulse, mut step, mut tolerance) = (0.1, 1e-3, None);
    let (mut method, mut out) = ("rk4".to_owned(), PathBuf::from("out/ins"));
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        if word == "--help" {
            println!("{HELP}");
            std::process::exit(0);
        }
        let value = words
            .next()
            .ok_or_else(|| format!("{word} needs a value\n\n{HELP}"))?;
        match word.as_str() {
            "--pulse" => pulse = number(&word, &value)?,
            "--step" => step = number(&word, &value)?,
            "--tolerance" => tolerance = Some(number(&word, &value)?),
            "--method" => method = value,
            "--out" => out = value.into(),
            _ => return Err(format!("option `{word}` is not known\n\n{HELP}").into()),
        }
    }
    let method = match (method.as_str(), tolerance) {
        ("rk4", None) => Method::Rk4,
        ("rk4", Some(_)) => return Err("--tolerance goes with --method dop853".into()),
        ("dop853", tolerance) => Method::Dop853(tolerance.unwrap_or(1e-10)),
        _ => return Err(format!("method `{method}` is not known\n\n{HELP}").into()),
    };
    Ok(Options {
        pulse,
        method,
        step,
        out,
    })
}

fn number(option: &str, text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err(format!("{option} takes a number above 0, not `{text}`")),
    }
}

fn main() -> ExitCode {
    match simulate() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn simulate() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let proposed = InsObserved::new(InsObservedParameters::default())?;
    let classic = InsClassicObserved::new(InsClassicObservedParameters::default())?;
    let wind = gust(options.pulse);
    let proposed = run::run(&proposed, options.method, &wind, options.step, 20.0)?;
    let classic = run::run(&classic, options.method, &wind, options.step, 20.0)?;
    print_programs();
    print_errors(&options, &proposed, &classic);
    std::fs::create_dir_all(&options.out)?;
    write_table(&options.out.join("trajectory.csv"), &proposed)?;
    draw_figures(&options.out, &proposed, &classic)?;
    println!(
        "\nwrote trajectory.csv, figure10.svg and figure11.svg to {}",
        options.out.display()
    );
    Ok(())
}

fn print_programs() {
    let proposed = <Ins as System<f64, 9, 3, 3>>::META;
    let classic = <InsClassic as System<f64, 9, 3, 3>>::META;
    println!("{:<34}{:>12}{:>12}", "", "Fig. 13", "Fig. 12");
    let line = |name: &str, value: fn(&Meta) -> String| {
        println!("{name:<34}{:>12}{:>12}", value(proposed), value(classic));
    };
    line("operations per derivative", |meta| {
        meta.operations.derivative.to_string()
    });
    line("angles under sine and cosine", |meta| {
        meta.operations.angles.to_string()
    });
    line("storages drawn dependent", |meta| {
        meta.dependent.len().to_string()
    });
    println!(
        "{:<24}{:>34}",
        "singular where",
        format!("{} = 0", proposed.conditioning.join(" or "))
    );
}

fn print_errors(options: &Options, proposed: &[Sample], classic: &[Sample]) {
    let reference = if options.pulse == 0.1 {
        &reference::PULSE[..]
    } else if options.pulse == 1.0 {
        &reference::LONG[..]
    } else {
        println!(
            "\nno reference for a gust of {} s; there is one for 0.1 and for 1",
            options.pulse
        );
        return;
    };
    let method = match options.method {
        Method::Rk4 => format!("rk4, h = {} s", options.step),
        Method::Dop853(tolerance) => format!("dop853, tolerance {tolerance:e}"),
    };
    println!("\nlargest error from 0 to 20 s, relative to the largest value; {method}");
    println!("{:<34}{:>12}{:>12}", "quantity", "Fig. 13", "Fig. 12");
    for ((name, first), (_, second)) in errors(proposed, reference)
        .into_iter()
        .zip(errors(classic, reference))
    {
        println!("{name:<34}{first:>12.1e}{second:>12.1e}");
    }
    let apart = proposed
        .iter()
        .zip(classic)
        .map(|(a, b)| (a.output - b.output).amax())
        .fold(0.0, f64::max);
    println!("{:<34}{apart:>12.1e}", "between the architectures");
}

fn write_table(path: &Path, samples: &[Sample]) -> Result<(), Box<dyn Error>> {
    let meta = <InsObserved as System<f64, 20, 3, 20>>::META;
    let names: Vec<&str> = meta.outputs.iter().map(|output| output.name).collect();
    let mut text = format!(
        "time,{},euler.x,euler.y,euler.z,beta.x,beta.y,beta.z\n",
        names.join(",")
    );
    for sample in samples {
        write!(text, "{}", sample.time)?;
        let all = sample
            .output
            .iter()
            .chain(sample.euler.iter())
            .chain(sample.beta.iter());
        for value in all {
            write!(text, ",{value:e}")?;
        }
        text.push('\n');
    }
    std::fs::write(path, text)?;
    Ok(())
}

fn draw_figures(out: &Path, proposed: &[Sample], classic: &[Sample]) -> Result<(), Box<dyn Error>> {
    let names = ["pitch", "roll", "yaw"];
    let mut figure10 = Vec::new();
    let mut figure11 = Vec::new();
    for (axis, name) in names.into_iter().enumerate() {
        let curve = |name: String, samples, value: Box<dyn Fn(&Sample) -> f64>, style| Curve {
            name,
            samples,
            value,
            color: axis,
            style,
        };
        for (figure, samples, style) in [
            ("Fig. 13", proposed, Style::Line),
            ("Fig. 12", classic, Style::Rings),
        ] {
            let estimate = Box::new(move |s: &Sample| s.output[13 + axis]);
            figure10.push(curve(format!("{name}, {figure}"), samples, estimate, style));
            let deviation = Box::new(move |s: &Sample| s.beta[axis]);
            let label = format!("β{}, {figure}", ["₁", "₂", "₃"][axis]);
            figure11.push(curve(label, samples, deviation, style));
        }
        figure10.push(curve(
            format!("{name}, Euler angle"),
            proposed,
            Box::new(move |s| s.euler[axis]),
            Style::Dashes,
        ));
    }
    plots::draw(
        &out.join("figure10.svg"),
        "Rotorcraft orientation by eq. (16), both architectures",
        "angle in rad",
        1.0,
        &figure10,
    )?;
    plots::draw(
        &out.join("figure11.svg"),
        "Deviation of the platform, both architectures",
        "angle in µrad",
        1e6,
        &figure11,
    )
}
