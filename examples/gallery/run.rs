//! A model from its start to an end, at equal times.

use mbg_runtime::{Adaptive, Dop853, Input, Integrator, Stopped, System, Tsit5};
use nalgebra::SVector;

use crate::draw::Point;

/// What a run shows at one time.
pub(crate) struct Instant<const N: usize, const P: usize> {
    pub(crate) time: f64,
    pub(crate) state: SVector<f64, N>,
    pub(crate) output: SVector<f64, P>,
}

/// Runs with an adaptive method from a state, at this many times after the start.
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
    let mut instants = Vec::new();
    let observer = |time, state: &SVector<f64, N>, output: &SVector<f64, P>| {
        instants.push(Instant {
            time,
            state: *state,
            output: *output,
        });
    };
    // Order 5 gets through the positions in which a loop is singular, where long steps of order 8 may not.
    if S::META.closures.is_empty() {
        let method = Adaptive::new(Dop853, 1e-12, 1e-15);
        method.sample_outputs(model, input, 0.0, start, &times, observer)?;
    } else {
        let method = Adaptive::new(Tsit5, 1e-8, 1e-8);
        method.sample_outputs(model, input, 0.0, start, &times, observer)?;
    }
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
