//! What counts as a small error.

use nalgebra::SVector;

use super::magnitude;
use crate::Real;

/// Tolerances of each state.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance<const N: usize> {
    pub(super) relative: f64,
    pub(super) absolute: [f64; N],
}

impl<const N: usize> Tolerance<N> {
    /// The absolute tolerance is in units of the nominal sizes; a state without one has size 1.
    pub(super) fn new(relative: f64, absolute: f64, nominal: &[f64]) -> Self {
        let size = |state: usize| nominal.get(state).copied().unwrap_or(1.0);
        Self {
            relative,
            absolute: core::array::from_fn(|state| absolute * size(state)),
        }
    }

    /// Root of the mean square of `vector / (absolute + relative · |scale|)`.
    pub(super) fn norm<T: Real>(&self, vector: &SVector<T, N>, scale: &SVector<T, N>) -> f64 {
        let components = vector.iter().zip(scale.iter()).zip(&self.absolute);
        let sum = components.fold(0.0, |sum, ((component, scale), absolute)| {
            let quotient = magnitude(*component) / (absolute + self.relative * magnitude(*scale));
            sum + quotient * quotient
        });
        Real::sqrt(sum / N.max(1) as f64)
    }

    /// The same for a vector of many lengths: the larger of two states is the scale.
    pub(super) fn norm_between<T: Real>(
        &self,
        vector: &SVector<T, N>,
        x: &SVector<T, N>,
        change: &SVector<T, N>,
    ) -> f64 {
        let larger = x.zip_map(change, |x, change| x.abs().max((x + change).abs()));
        self.norm(vector, &larger)
    }
}
