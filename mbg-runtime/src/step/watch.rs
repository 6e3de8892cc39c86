//! Checks after each step.

use nalgebra::SVector;

use super::outcome::{Cause, Stopped};
use crate::{Input, Real, System};

/// Whether the run may go on from this state: every state is finite and the model is not in trouble.
///
/// The input is that of the piece in which the step was made.
pub(super) fn inspect<T, const N: usize, const M: usize, const P: usize, S, I>(
    (system, input): (&S, &I),
    (time, x): (f64, &SVector<T, N>),
    piece: usize,
    memory: &S::Memory,
) -> Result<(), Stopped>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M>,
{
    finite::<T, N, M, P, S>(time, x)?;
    let clock = T::from_f64(time);
    match system.trouble(clock, x, &input.value(piece, clock), memory) {
        Some(trouble) => Err(Stopped { time, cause: Cause::Trouble(trouble) }),
        None => Ok(()),
    }
}

/// An error that names the first state that is infinite or NaN in any lane.
pub(super) fn finite<T, const N: usize, const M: usize, const P: usize, S>(
    time: f64,
    x: &SVector<T, N>,
) -> Result<(), Stopped>
where
    T: Real,
    S: System<T, N, M, P>,
{
    match x.iter().position(|value| value.find(|lane| !lane.is_finite()).is_some()) {
        Some(index) => {
            let state = S::META.states.get(index).map_or("?", |variable| variable.name);
            Err(Stopped { time, cause: Cause::NotFinite { state } })
        }
        None => Ok(()),
    }
}
