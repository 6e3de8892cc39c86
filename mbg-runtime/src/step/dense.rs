//! The state inside a step.

use nalgebra::SVector;

use super::tsit5::{Stages, inside};
use crate::Real;

/// An accepted step, with the state at any time inside it: order 4, continuous with its slope from step to step.
#[derive(Clone, Copy, Debug)]
pub struct Dense<'a, T, const N: usize> {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) x: &'a SVector<T, N>,
    pub(super) stages: &'a Stages<T, N>,
}

impl<T: Real, const N: usize> Dense<'_, T, N> {
    /// Time at which the step starts.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Time at which the step ends.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The state at the end of the step.
    pub fn state(&self) -> &SVector<T, N> {
        &self.stages.end
    }

    /// The state at a time from `start` to `end`; exact at both. No evaluation is made. Outside of the step this
    /// extrapolates, with an error that grows fast.
    pub fn at(&self, time: f64) -> SVector<T, N> {
        if time == self.end {
            return self.stages.end;
        }
        let h = self.end - self.start;
        let slope = inside(&self.stages.slopes, (time - self.start) / h);
        let h = T::from_f64(h);
        self.x.zip_map(&slope, |x, slope| x + h * slope)
    }
}
