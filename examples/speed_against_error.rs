//! Speed against error, on an inertial navigation system, a pendulum on a stiff pin and an arm with seven axes: tables,
//! and pictures in `out/`.
//!
//! `cargo run --release --example speed_against_error`; names of problems (`ins`, `pendulum`, `arm`) run these alone.

#[path = "arm/model.rs"]
#[allow(unreachable_pub)]
mod arm;
#[path = "ins/models.rs"]
#[allow(dead_code)]
mod models;
#[path = "methods/problems.rs"]
#[allow(dead_code)]
mod problems;

use std::error::Error;

use arm::{Arm, ArmParameters};
use mbg_compare::{Comparison, Problem, compare};
use mbg_runtime::{Constant, Gauss6, ImplicitMidpoint, Input, Rk4, Ros2, System};
use models::{Ins, InsParameters, gust};
use nalgebra::SVector;
use problems::{StiffPin, Written};

/// Prints the table and draws the picture.
fn report<S, I, const N: usize, const M: usize, const P: usize>(
    comparison: &Comparison<'_, S, I, N, M, P>,
    file: &str,
) -> Result<(), Box<dyn Error>>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    std::fs::create_dir_all("out")?;
    let path = format!("out/speed_against_error_{file}.svg");
    comparison.draw(&path)?;
    println!("{comparison}\nwrote {path}\n");
    Ok(())
}

fn navigation() -> Result<(), Box<dyn Error>> {
    let model = Ins::new(InsParameters::default())?;
    let gust = gust(0.1);
    let title = "INS in a gust of 0.1 s";
    let problem = Problem::new(title, &model, &gust, (0.0, 20.0), model.initial_state())
        .at([1.1, 2.0, 5.0, 10.0, 20.0]);
    let mut comparison = compare::<_, _, 9, 3, 3>(problem)?;
    comparison.over_steps(Rk4, &[0.1, 0.05, 0.02, 0.01]);
    comparison.over_steps(Gauss6::default(), &[0.5, 0.2, 0.1]);
    report(&comparison, "ins")
}

fn pendulum() -> Result<(), Box<dyn Error>> {
    let pin = Written(StiffPin {
        stiffness: 1e8,
        damping: 1e3,
    });
    let start = StiffPin::level();
    let title = "pendulum on a pin of 1e8 N/m";
    let problem = Problem::new(title, &pin, &(), (0.0, 5.0), start)
        .nominal([1e-7, 1e-7, 1.0, 1e-3, 1e-3, 1.0]);
    let mut comparison = compare(problem)?;
    let steps = [1e-2, 3e-3, 1e-3, 3e-4];
    comparison.over_steps(Ros2, &steps);
    comparison.over_steps(ImplicitMidpoint::default(), &steps);
    report(&comparison, "pendulum")
}

fn arm() -> Result<(), Box<dyn Error>> {
    let model = Arm::new(ArmParameters::default())?;
    let idle = Constant(SVector::<f64, 7>::zeros());
    let title = "falling arm with seven axes";
    let problem = Problem::new(title, &model, &idle, (0.0, 0.5), model.initial_state());
    let mut comparison = compare::<_, _, 14, 7, 3>(problem)?;
    comparison.over_steps(Rk4, &[1e-2, 5e-3, 2e-3, 1e-3]);
    report(&comparison, "arm")
}

fn main() -> Result<(), Box<dyn Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    type Task = (&'static str, fn() -> Result<(), Box<dyn Error>>);
    let tasks: [Task; 3] = [("ins", navigation), ("pendulum", pendulum), ("arm", arm)];
    for (name, task) in tasks {
        if wanted.is_empty() || wanted.iter().any(|it| it == name) {
            task()?;
        }
    }
    Ok(())
}
