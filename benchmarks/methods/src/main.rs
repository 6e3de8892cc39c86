//! Methods of integration beside those of other crates: tables, pictures, and ratios of time at equal error.
//!
//! `cd benchmarks/methods && cargo run --release`; `cargo run --release -- robertson` runs one problem. `./run` has
//! CVODE besides.

mod cvode;
#[path = "../../../examples/methods/double_pendulum.rs"]
mod double_pendulum;
#[path = "../../../benches/elimination/models.rs"]
#[allow(dead_code)]
mod elimination;
#[path = "../../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;
mod peers;
#[path = "../../../examples/methods/problems.rs"]
#[allow(dead_code)]
mod problems;
mod written;

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use std::time::Instant;

use cvode::Sundials;
use double_pendulum::DoublePendulum;
use elimination::{Dense, RingModulator, RingModulatorParameters, ring_nominal};
use mbg_compare::{Comparison, Measured, Problem, TOLERANCES, compare};
use mbg_runtime::{
    Adaptive, Estimating, Input, Integrator, Pirk16, Radau5, Radau9, Rodas4, Rodas5P, Statistics,
    System, Verner9, mbg,
};
use models::{Ins, InsParameters, gust};
use nalgebra::SVector;
use peers::{Ours, Peers, RightHandSide};
use problems::{RigidBody, Robertson, VanDerPol, Written};
use written::Navigation;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

mbg! { include "../../examples/gallery/stiff_pin.mbg"; }
use StiffPin as CompiledPin;

/// What is asked for at the end: the best of ours and of each group of others.
const ERROR: f64 = 1e-6;

/// What the problems are run with.
struct Run {
    sundials: Option<Sundials>,
    lines: Vec<String>,
}

impl Run {
    /// Runs the peers on what ours have run on, with a law of their own where there is one; prints, draws and keeps the
    /// ratio of the times.
    fn against<S, I, L, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: Problem<'_, S, I, N, M, P>,
        law: &L,
        file: &str,
        small: f64,
    ) -> Result<()>
    where
        S: System<f64, N, M, P>,
        I: Input<f64, M>,
        L: RightHandSide<N, M>,
    {
        let title = problem.title.clone();
        let mut comparison: Comparison<'_, S, I, N, M, P> = compare(problem)?;
        let stiff = comparison.reference().stiff;
        if stiff {
            // The absolute tolerances that others are given, besides those in units of the states' sizes.
            for small in [1.0, small] {
                absolute(&mut comparison, Rodas4, small);
                absolute(&mut comparison, Rodas5P, small);
                absolute(&mut comparison, Radau5, small);
                absolute(&mut comparison, Radau9, small);
            }
        } else {
            comparison.over_tolerances(Pirk16, &TOLERANCES);
            comparison.over_tolerances(Verner9, &TOLERANCES);
        }
        let ours = comparison.points().len();
        if stiff {
            Peers::new(&mut comparison, law, 1.0).numeris_stiff();
            Peers::new(&mut comparison, law, small).numeris_stiff();
        } else {
            let mut peers = Peers::new(&mut comparison, law, small);
            peers.numeris_smooth();
            peers.ode_solvers_smooth();
        }
        let crates = comparison.points().len();
        if let Some(sundials) = &self.sundials {
            if !stiff {
                cvode::cvode(sundials, &mut comparison, law, false);
            }
            cvode::cvode(sundials, &mut comparison, law, true);
        }
        println!("{comparison}");
        std::fs::create_dir_all("out")?;
        comparison.draw(format!("out/{file}.svg"))?;
        let mine = best(&comparison, 0..ours);
        self.lines.push(line(&title, &mine, mine.as_ref()));
        let rest = comparison.points().len();
        for others in [ours..crates, crates..rest] {
            if !others.is_empty() {
                let theirs = best(&comparison, others);
                self.lines.push(line("", &theirs, mine.as_ref()));
            }
        }
        Ok(())
    }
}

/// Runs a method with this absolute tolerance in units of the relative one, whatever the sizes of the states.
fn absolute<S, I, A, const N: usize, const M: usize, const P: usize>(
    comparison: &mut Comparison<'_, S, I, N, M, P>,
    method: A,
    small: f64,
) where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    A: Estimating,
{
    let name = format!("{}, atol {small:e} rtol", A::NAME);
    for tolerance in TOLERANCES {
        let solver = Adaptive::new(method, tolerance, tolerance * small);
        comparison.integrator(&name, &format!("rtol = {tolerance:e}"), &solver);
    }
}

/// A method with its time to the error, and what the nearest run that comes to it took.
struct Best {
    method: String,
    time: f64,
    nearest: Measured,
}

/// The fastest method of these points.
fn best<S, I, const N: usize, const M: usize, const P: usize>(
    comparison: &Comparison<'_, S, I, N, M, P>,
    points: Range<usize>,
) -> Option<Best>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    let methods = comparison.points()[points].iter().map(|it| &it.method);
    let found = methods.filter_map(|method| {
        let series = comparison.series(method);
        Some(Best {
            method: method.clone(),
            time: comparison.time_to(method, ERROR)?,
            nearest: *series.iter().find(|it| it.error <= ERROR)?,
        })
    });
    found.min_by(|a, b| a.time.total_cmp(&b.time))
}

/// A row: the method, its steps and evaluations, its time, and the ratio of our time to it.
fn line(title: &str, best: &Option<Best>, mine: Option<&Best>) -> String {
    let (Some(best), Some(mine)) = (best, mine) else {
        return format!("{title:<44}none comes to {ERROR:e}");
    };
    format!(
        "{title:<44}{:<30}{:>7}{:>8}{:>10.1}{:>8.3}",
        best.method,
        best.nearest.steps,
        best.nearest.evaluations,
        best.time * 1e6,
        mine.time / best.time
    )
}

/// The system written by hand, with the states numbered as the model's; it must agree with the model.
fn navigation(model: &Ins<f64>) -> Result<Navigation> {
    let states = <Ins<f64> as System<f64, 9, 3, 3>>::META.states;
    let begin = |part: &str| {
        let place = states.iter().position(|state| state.name.contains(part));
        place.ok_or(format!("the model has no state {part}"))
    };
    let order = [begin("spring")?, begin("hull")?, begin("body")?];
    let navigation = Navigation { order };
    let x = SVector::from_fn(|state, _| 0.1 + 0.03 * state as f64);
    let u = SVector::from([3.0, -2.0, 5.0]);
    let expected = model.derivative(0.0, &x, &u, &mut Default::default());
    let apart = (navigation.slope(0.0, &x, &u) - expected).norm() / expected.norm();
    if apart > 1e-13 {
        return Err(format!("the system by hand is {apart:e} off").into());
    }
    Ok(navigation)
}

/// The ring modulator with the plan of elimination and without, in turns; gives the ratio of the times.
fn ring_modulator() -> Result<String> {
    let model = RingModulator::new(RingModulatorParameters::default())?;
    let start: SVector<f64, 15> = System::<f64, 15, 0, 0>::initial_state(&model);
    let dense = Dense(model);
    let nominal = ring_nominal();
    let solver = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(Rodas5P, 1e-3, 1e-3)
    };
    let mut times = [[0.0; 2]; 5];
    let mut statistics = Statistics::default();
    for [planned, searched] in &mut times {
        let now = Instant::now();
        statistics = solver.integrate(&dense.0, &(), 0.0, 1e-3, start, |_step| ())?;
        *planned = now.elapsed().as_secs_f64();
        let now = Instant::now();
        solver.integrate(&dense, &(), 0.0, 1e-3, start, |_step| ())?;
        *searched = now.elapsed().as_secs_f64();
    }
    let [planned, searched] = [0, 1].map(|which| {
        let mut times = times.map(|round| round[which]);
        times.sort_by(f64::total_cmp);
        times[2]
    });
    Ok(format!(
        "{:<44}{:<30}{:>7}{:>8}{:>10.1}{:>8.3}",
        "ring modulator, 1 ms, against our dense LU",
        "Rodas5P",
        statistics.steps + statistics.rejected,
        statistics.evaluations,
        planned * 1e6,
        planned / searched
    ))
}

fn main() -> Result<()> {
    let wanted = std::env::args().nth(1);
    let wants = |name: &str| wanted.as_deref().is_none_or(|it| it == name);
    let mut run = Run {
        sundials: Sundials::from_environment()?,
        lines: Vec::new(),
    };
    if wants("ins") {
        let model = Ins::new(InsParameters::default())?;
        let navigation = navigation(&model)?;
        let start = System::<f64, 9, 3, 3>::initial_state(&model);
        for width in [0.1, 1.0] {
            let gust = gust(width);
            let problem = |title: &str| Problem::new(title, &model, &gust, (0.0, 10.0), start);
            let same = problem(&format!("INS in a gust of {width} s, 10 s"));
            let file = format!("ins_{width}");
            run.against(same, &Ours::<_, 3>(&model), &file, 1e-4)?;
            let product = problem("the same, others by matrices");
            run.against(product, &navigation, &format!("{file}_product"), 1e-4)?;
        }
    }
    if wants("body") {
        let body = Written(RigidBody);
        let start = SVector::from([1e-4, 10.0, 6e-4, 1.0, 0.0, 0.0, 0.0]);
        let title = "rigid body near its middle axis, 100 s";
        let problem = Problem::new(title, &body, &(), (0.0, 100.0), start).nominal([1.0; 7]);
        run.against(problem, &Ours::<_, 0>(&body), "rigid_body", 1.0)?;
    }
    if wants("double_pendulum") {
        let law = Written(DoublePendulum);
        let start = DoublePendulum::start();
        let title = "double pendulum, 5 s";
        let problem = Problem::new(title, &law, &(), (0.0, 5.0), start).nominal([1.0; 4]);
        run.against(problem, &Ours::<_, 0>(&law), "double_pendulum", 1.0)?;
    }
    if wants("pin") {
        let pin = Written(problems::StiffPin {
            stiffness: 1e8,
            damping: 1e3,
        });
        let start = SVector::from([0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0]);
        let title = "pendulum on a pin of 1e8 N/m, 5 s";
        let problem = Problem::new(title, &pin, &(), (0.0, 5.0), start)
            .nominal([1e-7, 1e-7, 1.0, 1e-3, 1e-3, 1.0]);
        run.against(problem, &Ours::<_, 0>(&pin), "stiff_pin", 1e-6)?;
    }
    if wants("compiled_pin") {
        let parameters = StiffPinParameters {
            stiffness: 1e8,
            damping: 1e3,
        };
        let pin = CompiledPin::new(parameters)?;
        let start = System::<f64, 6, 0, 4>::initial_state(&pin);
        let states = <CompiledPin<f64> as System<f64, 6, 0, 4>>::META.states;
        let nominal = std::array::from_fn(|state| match states[state].unit {
            "m" => 1e-7,
            "N*s" => 1e-3,
            _ => 1.0,
        });
        let title = "the same pin, compiled by mbg!";
        let problem = Problem::new(title, &pin, &(), (0.0, 5.0), start).nominal(nominal);
        run.against(problem, &Ours::<_, 4>(&pin), "compiled_pin", 1e-6)?;
    }
    if wants("van_der_pol") {
        let start = SVector::from([2.0, 0.0]);
        let title = "Van der Pol, 1e-6, 2 s";
        let law = Written(VanDerPol);
        let problem = Problem::new(title, &law, &(), (0.0, 2.0), start);
        run.against(problem, &Ours::<_, 0>(&law), "van_der_pol", 1e-3)?;
    }
    if wants("robertson") {
        let start = SVector::from([1.0, 0.0, 0.0]);
        let title = "Robertson, 1e5 s";
        let law = Written(Robertson);
        let problem = Problem::new(title, &law, &(), (0.0, 1e5), start).nominal([1.0, 1e-5, 1.0]);
        run.against(problem, &Ours::<_, 0>(&law), "robertson", 1e-4)?;
    }
    if wants("ring_modulator") {
        run.lines.push(ring_modulator()?);
    }
    println!(
        "to an error of {ERROR:e}: the best of ours, and what our time is of that of the best crate and of CVODE\n"
    );
    println!(
        "{:<44}{:<30}{:>7}{:>8}{:>10}{:>8}",
        "problem", "method", "steps", "evals", "time / µs", "ratio"
    );
    for line in run.lines {
        println!("{line}");
    }
    Ok(())
}
