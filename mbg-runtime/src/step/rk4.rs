//! The classical method of order 4.

use nalgebra::SVector;

use super::fixed::FixedStep;
use super::{advance, blend};
use crate::{Real, System};

/// The classical Runge–Kutta method: order 4, four evaluations of the derivative a step, no more and no less.
///
/// The four evaluations are at the start, twice in the middle and at the end of the step. Stable for oscillations up
/// to `ω h = 2.8` and decays up to `h / τ = 2.8`.
///
/// # Example
///
/// One step in a loop of one's own, such as a control task:
/// ```
/// # mod model { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/pendulum.rs")); }
/// # use model::Pendulum;
/// use mbg_runtime::{FixedStep, Rk4, System};
/// use nalgebra::SVector;
///
/// let pendulum = Pendulum { gravity: 9.81, damping: 0.1 };
/// let mut x = pendulum.initial_state();
/// let mut memory = ();
/// for k in 0..1000 {
///     let torque = SVector::from([0.2]); // held during the step
///     x = Rk4.step(&pendulum, 1e-3 * f64::from(k), &x, |_| torque, 1e-3, &mut memory);
/// }
/// assert!((x[0] + 0.930_857).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4;

impl FixedStep for Rk4 {
    const ORDER: u32 = 4;
    const EVALUATIONS: u64 = 4;

    fn increment<T, const N: usize, const M: usize, const P: usize, S>(
        &self,
        system: &S,
        t: T,
        x: &SVector<T, N>,
        input: impl Fn(T) -> SVector<T, M>,
        h: T,
        memory: &mut S::Memory,
    ) -> SVector<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
    {
        let middle = t + T::from_f64(0.5) * h;
        let end = t + h;
        let in_middle = input(middle);
        let k1 = system.derivative(t, x, &input(t), memory);
        let k2 = system.derivative(middle, &advance(x, h, (0.5, &k1), []), &in_middle, memory);
        let k3 = system.derivative(middle, &advance(x, h, (0.5, &k2), []), &in_middle, memory);
        let k4 = system.derivative(end, &advance(x, h, (1.0, &k3), []), &input(end), memory);
        const SIXTH: f64 = 1.0 / 6.0;
        const THIRD: f64 = 1.0 / 3.0;
        blend((SIXTH, &k1), [(THIRD, &k2), (THIRD, &k3), (SIXTH, &k4)]).map(|slope| h * slope)
    }
}
