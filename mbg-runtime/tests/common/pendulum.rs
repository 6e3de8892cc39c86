use mbg_runtime::{Meta, Operations, Power, Real, System, Variable};
use nalgebra::{SMatrix, SVector};

/// A damped pendulum of 1 kg and 1 m, driven by a torque: `q̇ = p`, `ṗ = u − g sin q − d p`.
#[derive(Clone, Copy, Debug)]
pub struct Pendulum<T = f64> {
    /// In m/s².
    pub gravity: T,
    /// In N·m·s/rad.
    pub damping: T,
}

impl<T: Real> System<T, 2, 1, 1> for Pendulum<T> {
    const META: &'static Meta = &Meta {
        name: "Pendulum",
        parameters: &[
            Variable { name: "gravity", unit: "m/s^2" },
            Variable { name: "damping", unit: "N*m*s/rad" },
        ],
        states: &[
            Variable { name: "bob.q", unit: "rad" },
            Variable { name: "bob.p", unit: "N*m*s" },
        ],
        inputs: &[Variable { name: "torque", unit: "N*m" }],
        outputs: &[Variable { name: "angle", unit: "rad" }],
        bonds: &[],
        dependent: &[],
        conditioning: &[],
        assumptions: &[],
        notes: &[],
        operations: Operations {
            derivative: 5,
            output: 0,
            jacobian_state: 2,
            jacobian_input: 0,
            energy: 6,
            power: 3,
            angles: 1,
        },
        diagram: "",
    };
    type Memory = ();
    type Conditioning = [T; 0];

    fn initial_state(&self) -> SVector<T, 2> {
        SVector::from([T::from_f64(1.0), T::from_f64(0.0)])
    }

    fn derivative(&self, _t: T, x: &SVector<T, 2>, u: &SVector<T, 1>, _memory: &mut ()) -> SVector<T, 2> {
        SVector::from([x[1], u[0] - self.gravity * x[0].sin() - self.damping * x[1]])
    }

    fn output(&self, _t: T, x: &SVector<T, 2>, _u: &SVector<T, 1>, _memory: &mut ()) -> SVector<T, 1> {
        SVector::from([x[0]])
    }

    fn jacobian_state(&self, _t: T, x: &SVector<T, 2>, _u: &SVector<T, 1>, _memory: &mut ()) -> SMatrix<T, 2, 2> {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        SMatrix::from([[zero, -(self.gravity * x[0].cos())], [one, -self.damping]])
    }

    fn jacobian_input(&self, _t: T, _x: &SVector<T, 2>, _u: &SVector<T, 1>, _memory: &mut ()) -> SMatrix<T, 2, 1> {
        SMatrix::from([[T::from_f64(0.0), T::from_f64(1.0)]])
    }

    fn energy(&self, _t: T, x: &SVector<T, 2>) -> T {
        T::from_f64(0.5) * x[1] * x[1] + self.gravity * (T::from_f64(1.0) - x[0].cos())
    }

    fn power(&self, _t: T, x: &SVector<T, 2>, u: &SVector<T, 1>, _memory: &mut ()) -> Power<T> {
        Power { supplied: u[0] * x[1], dissipated: self.damping * x[1] * x[1] }
    }

    fn conditioning(&self, _t: T, _x: &SVector<T, 2>, _u: &SVector<T, 1>) -> [T; 0] {
        []
    }
}
