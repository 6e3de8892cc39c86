//! A run as CSV on standard output: time, states, inputs and outputs, under the names and units that the model knows.
//!
//! `cargo run --release --example log_to_csv > log.csv`

use std::error::Error;

use mbg_runtime::{Adaptive, Dop853, Input, Integrator, Meta, Pulse, System, Variable, mbg};
use nalgebra::SVector;

mbg! {
    /// A motor turns a wheel, which dry friction holds until the motor is strong enough.
    pub(crate) model Motor {
        param friction: N*m = 0.05;
        input voltage: V;

        1 wire { Se supply { effort: voltage } R winding { resistance: 1.5 } I coil { inertia: 4e-3 } }
        1 shaft { I wheel { inertia: 2e-3 } R bearing { effort: friction * sign(f) } }
        wire -> GY motor { effort: 0.05 } -> shaft;
        integral angle: rad = shaft.f;

        output current: A = wire.f;
        output speed: rad/s = shaft.f;
        output turns = angle / 6.283185307179586;
        output held: N*m = bearing.e;
    }
}

/// 12 V for the first half second.
pub(crate) const SUPPLY: Pulse<f64, 1> = Pulse {
    amplitude: SVector::<f64, 1>::new(12.0),
    start: 0.0,
    end: 0.5,
};

fn main() -> Result<(), Box<dyn Error>> {
    let motor = Motor::new(MotorParameters::default())?;
    print!("{}", log(&motor, &SUPPLY, &times())?);
    Ok(())
}

/// Every tenth of a second for three seconds.
pub(crate) fn times() -> Vec<f64> {
    (0..=30).map(|tenth| f64::from(tenth) / 10.0).collect()
}

/// A run of any model from its start: a line of titles, and one for each of the times.
pub(crate) fn log<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    times: &[f64],
) -> Result<String, Box<dyn Error>>
where
    S: System<f64, N, M, P>,
{
    let mut table = titles(S::META).join(",");
    table.push('\n');
    let solver = Adaptive::new(Dop853, 1e-9, 1e-12);
    let start = model.initial_state();
    // Outputs by the run itself: friction that holds is told by no state.
    solver.sample_outputs(model, input, 0.0, start, times, |time, state, output| {
        let input = input.at(time);
        let numbers = state.iter().chain(&input).chain(output);
        let cells: Vec<String> = numbers.map(|number| format!("{number:e}")).collect();
        table += &format!("{time},{}\n", cells.join(","));
    })?;
    Ok(table)
}

/// The columns: time, and what the model calls its states, inputs and outputs.
fn titles(meta: &Meta) -> Vec<String> {
    let variables = [meta.states, meta.inputs, meta.outputs].concat();
    let titles = variables.iter().map(title);
    std::iter::once("time / s".to_owned())
        .chain(titles)
        .collect()
}

/// A name with its unit, where one is known.
fn title(variable: &Variable) -> String {
    let Variable { name, unit } = variable;
    match *unit {
        "" => (*name).to_owned(),
        unit => format!("{name} / {unit}"),
    }
}
