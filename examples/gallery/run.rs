//! A model from its start to an end, at equal times.

use mbg_runtime::{Adaptive, Dop853, Input, Integrator, Stopped, System};
use nalgebra::SVector;

use crate::draw::Point;

/// What a run shows at one time.
pub(crate) struct Instant<const N: usize, const P: usize> {
    pub(crate) time: f64,
    pub(crate) state: SVector<f64, N>,
    pub(crate) output: SVector<f64, P>,
}

/// Runs with an adaptive method of order 8 from a state, at this many times after the start.
///
/// # Errors
/// As the stepper.
pub(crate) fn run<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    start: SVector<f64, N>,
    end: f64,
    count: u32,
) -> Result<Vec<Instant<N, P>>, Stopped>
where
    S: System<f64, N, M, P>,
{
    let times: Vec<f64> = (0..=count)
        .map(|k| end * f64::from(k) / f64::from(count))
        .collect();
    let (mut instants, mut memory) = (Vec::new(), S::Memory::default());
    Adaptive::new(Dop853, 1e-12, 1e-15).sample(
        model,
        input,
        0.0,
        start,
        &times,
        |time, state| {
            let output = model.output(time, state, &input.at(time), &mut memory);
            instants.push(Instant {
                time,
                state: *state,
                output,
            });
        },
    )?;
    Ok(instants)
}

/// A value over time.
pub(crate) fn over<const N: usize, const P: usize>(
    instants: &[Instant<N, P>],
    value: impl Fn(&Instant<N, P>) -> f64,
) -> Vec<Point> {
    instants
        .iter()
        .map(|instant| (instant.time, value(instant)))
        .collect()
}

/// The places of the states with names that end so.
pub(crate) fn states<S, const N: usize, const M: usize, const P: usize>(
    _: &S,
    end: &str,
) -> Vec<usize>
where
    S: System<f64, N, M, P>,
{
    let named = |place: &usize| S::META.states[*place].name.ends_with(end);
    (0..N).filter(named).collect()
}
