//! Systems for the tests of integrators.

use nalgebra::{SMatrix, SVector};

use crate::{Meta, Operations, Power, Real, Room, System, Variable};

const fn meta(states: &'static [Variable], conditioning: &'static [&'static str]) -> Meta {
    Meta {
        name: "Test",
        parameters: &[],
        states,
        inputs: &[],
        outputs: &[],
        bonds: &[],
        dependent: &[],
        conditioning,
        loops: &[],
        closures: &[],
        eliminated: &[],
        assumptions: &[],
        notes: &[],
        operations: Operations {
            derivative: 0,
            output: 0,
            derivative_and_jacobian: 0,
            jacobian_input: 0,
            energy: 0,
            power: 0,
            angles: 0,
        },
        diagram: "",
    }
}

/// A system of which the integrators' tests need `derivative` and `conditioning` alone.
macro_rules! system {
    (
        $(#[$doc:meta])*
        $name:ident[$states:literal, $inputs:literal, $blocks:literal]: [$($state:literal),*], [$($block:literal),*];
        |$t:ident, $x:ident, $u:ident| $derivative:expr;
        $conditioning:expr
    ) => {
        $(#[$doc])*
        pub(super) struct $name;

        impl<T: Real> System<T, $states, $inputs, 0> for $name {
            const META: &'static Meta = &meta(&[$(Variable { name: $state, unit: "" }),*], &[$($block),*]);
            const AUTONOMOUS: bool = true;
            type Memory = ();
            type Conditioning = [T; $blocks];
            type Room = Room<0>;

            fn initial_state(&self) -> SVector<T, $states> {
                SVector::from_element(T::from_f64(0.0))
            }

            fn derivative(
                &self,
                $t: T,
                $x: &SVector<T, $states>,
                $u: &SVector<T, $inputs>,
                _memory: &mut (),
            ) -> SVector<T, $states> {
                $derivative
            }

            fn output(&self, _: T, _: &SVector<T, $states>, _: &SVector<T, $inputs>, _: &mut ()) -> SVector<T, 0> {
                SVector::from_element(T::from_f64(0.0))
            }

            fn jacobian_state(
                &self,
                _: T,
                _: &SVector<T, $states>,
                _: &SVector<T, $inputs>,
                _: &mut (),
            ) -> SMatrix<T, $states, $states> {
                SMatrix::from_element(T::from_f64(f64::NAN))
            }

            fn jacobian_input(
                &self,
                _: T,
                _: &SVector<T, $states>,
                _: &SVector<T, $inputs>,
                _: &mut (),
            ) -> SMatrix<T, $states, $inputs> {
                SMatrix::from_element(T::from_f64(f64::NAN))
            }

            fn energy(&self, _: T, _: &SVector<T, $states>) -> T {
                T::from_f64(f64::NAN)
            }

            fn power(
                &self,
                _: T,
                _: &SVector<T, $states>,
                _: &SVector<T, $inputs>,
                _: &mut (),
            ) -> Power<T> {
                Power { supplied: T::from_f64(f64::NAN), dissipated: T::from_f64(f64::NAN) }
            }

            #[allow(unused_variables)]
            fn conditioning(
                &self,
                $t: T,
                $x: &SVector<T, $states>,
                $u: &SVector<T, $inputs>,
            ) -> Self::Conditioning {
                $conditioning
            }
        }
    };
}

system! {
    /// `ẍ + x = u`.
    Oscillator[2, 1, 0]: ["displacement", "velocity"], [];
    |_t, x, u| SVector::from([x[1], u[0] - x[0]]);
    []
}

system! {
    /// `ẋ = x²` next to a constant: infinite at `1 / x(0)`.
    Explosion[2, 0, 0]: ["growth", "constant"], [];
    |_t, x, _u| SVector::from([x[0] * x[0], T::from_f64(0.0)]);
    []
}

system! {
    /// `ẋ = -1`, with a block that is singular at `x = 0` in the middle of smooth motion.
    Blocked[1, 0, 1]: ["way"], ["block"];
    |_t, x, _u| SVector::from([T::from_f64(-1.0) + T::from_f64(0.0) * x[0]]);
    [x[0]]
}

system! {
    /// `ẋ = u`.
    Pushed[1, 1, 0]: ["way"], [];
    |_t, _x, u| *u;
    []
}
