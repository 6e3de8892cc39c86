//! A step with its derivatives.

use nalgebra::{SMatrix, SVector};

use super::Rk4;
use super::fixed::stages;
use super::method::along;
use crate::linearised::{beside_one, product};
use crate::{Real, System};

/// A step, and how its end changes with its beginning and with the input: `δx⁺ = Φ δx + Γ δu`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition<T, const N: usize, const M: usize> {
    /// The state at the end.
    pub end: SVector<T, N>,
    /// The transition matrix `Φ = ∂x⁺/∂x`.
    pub state: SMatrix<T, N, N>,
    /// The input matrix `Γ = ∂x⁺/∂u`.
    pub input: SMatrix<T, N, M>,
}

impl Rk4 {
    /// [`Rk4::step`] with its derivatives, as filters and predictive controllers take them along a trajectory: those of the step
    /// itself, not of the motion it comes close to, exact but for rounding. The model's Jacobians are taken at the four stages.
    ///
    /// As by `step` nothing is closed and nothing is checked.
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::{Rk4, System, Transition, mbg};
    /// use nalgebra::SVector;
    ///
    /// mbg! {
    ///     /// A pendulum pushed by a torque.
    ///     model Pendulum {
    ///         input torque: N*m;
    ///         1 joint {
    ///             I rod { inertia: 0.5 }
    ///             C weight { effort: 20.0 * sin(q) }
    ///             Se push { effort: torque }
    ///         }
    ///     }
    /// }
    ///
    /// let pendulum = Pendulum::<f64>::new(PendulumParameters::default())?;
    /// let (state, torque) = (SVector::from([0.1, 0.5]), SVector::from([0.3]));
    /// let step = |torque| Rk4::step(&pendulum, 0.0, &state, &torque, 0.01, &mut ());
    /// let Transition { end, input, .. } = Rk4::transition(&pendulum, 0.0, &state, &torque, 0.01, &mut ());
    /// assert!((end - step(torque)).norm() < 1e-15);
    /// let more = SVector::from([1e-6]);
    /// let difference = (step(torque + more) - step(torque - more)) / 2e-6;
    /// assert!((input - difference).norm() < 1e-9);
    /// # Ok::<(), mbg_runtime::ParameterError>(())
    /// ```
    #[must_use]
    pub fn transition<T, S, const N: usize, const M: usize, const P: usize>(
        system: &S,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        h: T,
        memory: &mut S::Memory,
    ) -> Transition<T, N, M>
    where
        T: Real,
        S: System<T, N, M, P>,
    {
        let zero = T::from_f64(0.0);
        // Of the mean slope, and of the state at the stage.
        let (mut mean, mut mean_by_state, mut mean_by_input) = (
            SVector::from_element(zero),
            SMatrix::from_element(zero),
            SMatrix::from_element(zero),
        );
        let (mut stage, mut at) = (*x, t);
        let (mut by_state, mut by_input) = (
            beside_one(SMatrix::from_element(zero)),
            SMatrix::from_element(zero),
        );
        for (weight, ahead) in stages(h) {
            let (slope, jacobian) = system.derivative_and_jacobian(at, &stage, u, memory);
            let slope_by_state = product(&jacobian, &by_state);
            let slope_by_input =
                system.jacobian_input(at, &stage, u, memory) + product(&jacobian, &by_input);
            mean = along(&mean, weight, &slope);
            mean_by_state = along(&mean_by_state, weight, &slope_by_state);
            mean_by_input = along(&mean_by_input, weight, &slope_by_input);
            stage = along(x, ahead, &slope);
            by_state = beside_one(slope_by_state.map(|it| ahead * it));
            by_input = slope_by_input.map(|it| ahead * it);
            at = t + ahead;
        }
        Transition {
            end: along(x, h, &mean),
            state: beside_one(mean_by_state.map(|it| h * it)),
            input: mean_by_input.map(|it| h * it),
        }
    }
}
