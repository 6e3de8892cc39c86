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

use mbg_runtime::{Meta, System};
use models::{
    Ins, InsClassic, InsClassicObserved, InsClassicObservedParameters, InsObserved,
    InsObservedParameters,
};
use plots::Curve;
use run::{Sample, errors};

const HELP: &str = "\
usage: cargo run --release --example ins -- [options]

  --pulse SECONDS   width of the gust            (0.1)
  --step SECONDS    step of the integrator       (1e-3)
  --method NAME     rk4                          (rk4)
  --out DIR         where CSV and figures go     (out/ins)

example: cargo run --release --example ins -- --pulse 1 --step 2e-3 --out out/hard";

struct Options {
    pulse: f64,
    step: f64,
    out: PathBuf,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut options = Options {
        pulse: 0.1,
        step: 1e-3,
        out: PathBuf::from("out/ins"),
    };
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
            "--pulse" => options.pulse = value.parse()?,
            "--step" => options.step = value.parse()?,
            "--method" if value == "rk4" => {}
            "--method" => return Err(format!("method `{value}` is not known\n\n{HELP}").into()),
            "--out" => options.out = value.into(),
            _ => return Err(format!("option `{word}` is not known\n\n{HELP}").into()),
        }
    }
    Ok(options)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let proposed = InsObserved::new(InsObservedParameters::default())?;
    let classic = InsClassicObserved::new(InsClassicObservedParameters::default())?;
    let proposed = run::run(&proposed, options.pulse, options.step, 20.0)?;
    let classic = run::run(&classic, options.pulse, options.step, 20.0)?;
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
        "singular where                    {} = 0",
        proposed.conditioning.join(" or ")
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
    println!(
        "\nlargest error from 0 to 20 s, relative to the largest value; rk4, h = {} s",
        options.step
    );
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
        let curve = |name: String, samples, value: Box<dyn Fn(&Sample) -> f64>, dashed| Curve {
            name,
            samples,
            value,
            color: axis,
            dashed,
        };
        figure10.push(curve(
            format!("{name}, eq. (16), Fig. 13"),
            proposed,
            Box::new(move |s| s.output[13 + axis]),
            false,
        ));
        figure10.push(curve(
            format!("{name}, eq. (16), Fig. 12"),
            classic,
            Box::new(move |s| s.output[13 + axis]),
            false,
        ));
        figure10.push(curve(
            format!("{name}, Euler angle"),
            proposed,
            Box::new(move |s| s.euler[axis]),
            true,
        ));
        let label = format!("beta {}", axis + 1);
        figure11.push(curve(
            format!("{label}, Fig. 13"),
            proposed,
            Box::new(move |s| s.beta[axis]),
            false,
        ));
        figure11.push(curve(
            format!("{label}, Fig. 12"),
            classic,
            Box::new(move |s| s.beta[axis]),
            true,
        ));
    }
    plots::draw(
        &out.join("figure10.svg"),
        "Rotorcraft orientation, both architectures",
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
