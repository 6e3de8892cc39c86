//! Methods of integration beside those of other crates: tables, pictures, and ratios of time at equal error.
//!
//! `cd benchmarks/methods && cargo run --release`; `cargo run --release -- robertson` runs one problem.

#[path = "../../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;
mod peers;
#[path = "../../../examples/methods/problems.rs"]
#[allow(dead_code)]
mod problems;

use std::error::Error;
use std::f64::consts::FRAC_PI_2;

use mbg_compare::{Comparison, Problem, compare};
use mbg_runtime::{Input, System};
use models::{Ins, InsParameters, gust};
use nalgebra::SVector;
use peers::Peers;
use problems::{RigidBody, Robertson, StiffPin, VanDerPol, Written};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Runs the peers on what ours have run on, prints and draws, and gives the ratio at an error of 1e-6.
fn against<S, I, const N: usize, const M: usize, const P: usize>(
    problem: Problem<'_, S, I, N, M, P>,
    file: &str,
    small: f64,
) -> Result<String>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    let title = problem.title.clone();
    let mut comparison: Comparison<'_, S, I, N, M, P> = compare(problem)?;
    let ours: Vec<String> = comparison
        .methods()
        .iter()
        .map(|it| (*it).to_owned())
        .collect();
    if comparison.reference().stiff {
        Peers::new(&mut comparison, 1.0).numeris_stiff();
        Peers::new(&mut comparison, small).numeris_stiff();
    } else {
        let mut peers = Peers::new(&mut comparison, small);
        peers.numeris_smooth();
        peers.ode_solvers_smooth();
    }
    println!("{comparison}");
    std::fs::create_dir_all("out")?;
    comparison.draw(format!("out/{file}.svg"))?;
    let best = |of_ours: bool| {
        let methods = comparison.methods().into_iter();
        let of_side = methods.filter(|it| ours.iter().any(|name| name == it) == of_ours);
        of_side
            .filter_map(|method| Some((method, comparison.time_to(method, 1e-6)?)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (Some((mine, own)), Some((theirs, other))) = (best(true), best(false)) else {
        return Ok(format!("{title:<40} no method of one side comes to 1e-6"));
    };
    Ok(format!(
        "{title:<40}{mine:<14}{:>9.1} µs    {theirs:<34}{:>9.1} µs{:>8.2}",
        own * 1e6,
        other * 1e6,
        own / other
    ))
}

fn main() -> Result<()> {
    let wanted = std::env::args().nth(1);
    let wants = |name: &str| wanted.as_deref().is_none_or(|it| it == name);
    let mut lines = Vec::new();
    if wants("ins") {
        let model = Ins::new(InsParameters::default())?;
        let gust = gust(0.1);
        let title = "INS in a gust of 0.1 s, 10 s";
        let problem = Problem::new(title, &model, &gust, (0.0, 10.0), model.initial_state());
        lines.push(against::<_, _, 9, 3, 3>(problem, "ins", 1e-4)?);
    }
    if wants("body") {
        let start = SVector::from([1e-4, 10.0, 6e-4, 1.0, 0.0, 0.0, 0.0]);
        let title = "rigid body near its middle axis, 100 s";
        let problem =
            Problem::new(title, &Written(RigidBody), &(), (0.0, 100.0), start).nominal([1.0; 7]);
        lines.push(against(problem, "rigid_body", 1.0)?);
    }
    if wants("pin") {
        let pin = Written(StiffPin {
            stiffness: 1e8,
            damping: 1e3,
        });
        let start = SVector::from([0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0]);
        let title = "pendulum on a pin of 1e8 N/m, 5 s";
        let problem = Problem::new(title, &pin, &(), (0.0, 5.0), start)
            .nominal([1e-7, 1e-7, 1.0, 1e-3, 1e-3, 1.0]);
        lines.push(against(problem, "stiff_pin", 1e-6)?);
    }
    if wants("van_der_pol") {
        let start = SVector::from([2.0, 0.0]);
        let title = "Van der Pol, 1e-6, 2 s";
        let problem = Problem::new(title, &Written(VanDerPol), &(), (0.0, 2.0), start);
        lines.push(against(problem, "van_der_pol", 1e-3)?);
    }
    if wants("robertson") {
        let start = SVector::from([1.0, 0.0, 0.0]);
        let title = "Robertson, 1e5 s";
        let problem = Problem::new(title, &Written(Robertson), &(), (0.0, 1e5), start)
            .nominal([1.0, 1e-5, 1.0]);
        lines.push(against(problem, "robertson", 1e-4)?);
    }
    println!("best of ours and best of others at an error of 1e-6\n");
    for line in lines {
        println!("{line}");
    }
    Ok(())
}
