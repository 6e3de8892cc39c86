//! Problems written by hand, for measurements of methods.

use std::f64::consts::FRAC_PI_2;

use mbg_runtime::{Dual, Meta, Operations, Power, Real, Room, System, Variable};
use nalgebra::{SMatrix, SVector};

/// A right-hand side, which does not read the time; its Jacobians follow on dual numbers.
pub(crate) trait Law<const N: usize, const M: usize> {
    /// Names of the states.
    const STATES: &'static [Variable];

    /// The derivative.
    fn slope<T: Real>(&self, x: &SVector<T, N>, u: &SVector<T, M>) -> SVector<T, N>;
}

/// A law as a system.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Written<L>(pub L);

impl<T: Real, L: Law<N, M>, const N: usize, const M: usize> System<T, N, M, 0> for Written<L> {
    const META: &'static Meta = &Meta {
        name: "written by hand",
        parameters: &[],
        states: L::STATES,
        inputs: &[],
        outputs: &[],
        bonds: &[],
        dependent: &[],
        eliminated: &[],
        conditioning: &[],
        loops: &[],
        closures: &[],
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
    };
    const AUTONOMOUS: bool = true;
    type Memory = ();
    type Conditioning = [T; 0];
    type Room = Room<0>;

    fn initial_state(&self) -> SVector<T, N> {
        SVector::from_element(T::from_f64(0.0))
    }

    #[inline]
    fn derivative(&self, _: T, x: &SVector<T, N>, u: &SVector<T, M>, _: &mut ()) -> SVector<T, N> {
        self.0.slope(x, u)
    }

    #[inline]
    fn derivatives(
        &self,
        _: T::Stages,
        x: &SVector<T::Stages, N>,
        u: &SVector<T::Stages, M>,
        _: &mut (),
    ) -> SVector<T::Stages, N> {
        self.0.slope(x, u)
    }

    fn output(&self, _: T, _: &SVector<T, N>, _: &SVector<T, M>, _: &mut ()) -> SVector<T, 0> {
        SVector::from_element(T::from_f64(0.0))
    }

    fn jacobian_state(
        &self,
        _: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        _: &mut (),
    ) -> SMatrix<T, N, N> {
        let u = u.map(Dual::constant);
        let mut jacobian = SMatrix::<T, N, N>::from_element(T::from_f64(0.0));
        for column in 0..N {
            let mut x = x.map(Dual::constant);
            x[column].slope = T::from_f64(1.0);
            jacobian.set_column(column, &self.0.slope(&x, &u).map(|it| it.slope));
        }
        jacobian
    }

    fn jacobian_input(
        &self,
        _: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        _: &mut (),
    ) -> SMatrix<T, N, M> {
        let x = x.map(Dual::constant);
        let mut jacobian = SMatrix::<T, N, M>::from_element(T::from_f64(0.0));
        for column in 0..M {
            let mut u = u.map(Dual::constant);
            u[column].slope = T::from_f64(1.0);
            jacobian.set_column(column, &self.0.slope(&x, &u).map(|it| it.slope));
        }
        jacobian
    }

    fn derivative_time(
        &self,
        _: T,
        _: &SVector<T, N>,
        _: &SVector<T, M>,
        _: &mut (),
        _: T,
    ) -> SVector<T, N> {
        SVector::from_element(T::from_f64(0.0))
    }

    fn energy(&self, _: T, _: &SVector<T, N>) -> T {
        T::from_f64(0.0)
    }

    fn power(&self, _: T, _: &SVector<T, N>, _: &SVector<T, M>, _: &mut ()) -> Power<T> {
        let nothing = T::from_f64(0.0);
        Power {
            supplied: nothing,
            dissipated: nothing,
        }
    }

    fn conditioning(&self, _: T, _: &SVector<T, N>, _: &SVector<T, M>) -> [T; 0] {
        []
    }
}

/// A state without a unit.
pub(crate) const fn state(name: &'static str) -> Variable {
    Variable { name, unit: "" }
}

/// `ẍ + x = u`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillator;

impl Law<2, 1> for Oscillator {
    const STATES: &'static [Variable] = &[state("way"), state("velocity")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0] - x[0]])
    }
}

/// `ẍ + sin x = 0`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pendulum;

impl Law<2, 0> for Pendulum {
    const STATES: &'static [Variable] = &[state("angle"), state("rate")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        SVector::from([x[1], -x[0].sin()])
    }
}

/// Hunters and hunted, after Lotka and Volterra.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hunters;

impl Law<2, 0> for Hunters {
    const STATES: &'static [Variable] = &[state("hunted"), state("hunters")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let one = T::from_f64(1.0);
        SVector::from([x[0] * (one - x[1]), x[1] * (x[0] - one)])
    }
}

/// A free rigid body with the principal inertias 1, 2 and 3: momentum in its own axes and quaternion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RigidBody;

impl RigidBody {
    /// Energy and the norm of the momentum, of a state in any precision.
    pub(crate) fn invariants<T: Real>(x: &SVector<T, 7>) -> [T; 2] {
        let [a, b, c] = [x[0] * x[0], x[1] * x[1], x[2] * x[2]];
        let energy = a * T::from_f64(0.5) + b * T::from_f64(0.25) + c * T::from_f64(1.0 / 6.0);
        [energy, (a + b + c).sqrt()]
    }
}

impl Law<7, 0> for RigidBody {
    const STATES: &'static [Variable] = &[
        state("h.x"),
        state("h.y"),
        state("h.z"),
        state("q.w"),
        state("q.x"),
        state("q.y"),
        state("q.z"),
    ];

    fn slope<T: Real>(&self, x: &SVector<T, 7>, _: &SVector<T, 0>) -> SVector<T, 7> {
        let half = T::from_f64(0.5);
        let [h1, h2, h3, w, i, j, k] = x.data.0[0];
        let [a, b, c] = [h1, half * h2, T::from_f64(1.0 / 3.0) * h3];
        SVector::from([
            h2 * c - h3 * b,
            h3 * a - h1 * c,
            h1 * b - h2 * a,
            -(half * (i * a + j * b + k * c)),
            half * (w * a + j * c - k * b),
            half * (w * b + k * a - i * c),
            half * (w * c + i * b - j * a),
        ])
    }
}

/// A pendulum whose torque follows its angle within so many seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Follower(pub f64);

impl Law<3, 0> for Follower {
    const STATES: &'static [Variable] = &[state("angle"), state("rate"), state("torque")];

    fn slope<T: Real>(&self, x: &SVector<T, 3>, _: &SVector<T, 0>) -> SVector<T, 3> {
        let [angle, rate, torque] = x.data.0[0];
        let behind = torque + angle.sin();
        SVector::from([rate, torque, -(behind * T::from_f64(1.0 / self.0))])
    }
}

/// The problem of Kaps: `x = e^{-2t}`, `y = e^{-t}` whatever the small number is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kaps(pub f64);

impl Law<2, 0> for Kaps {
    const STATES: &'static [Variable] = &[state("x"), state("y")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let stiffness = T::from_f64(1.0 / self.0);
        let [x, y] = x.data.0[0];
        let behind = x - y * y;
        SVector::from([
            -(T::from_f64(2.0) * x) - stiffness * behind,
            x - y * (T::from_f64(1.0) + y),
        ])
    }
}

/// Van der Pol's oscillator with the parameter 1e-6.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VanDerPol;

impl VanDerPol {
    /// The state after 2 s from (2, 0), published (Mazzia and Magherini, *Test Set for Initial Value Problem Solvers*,
    /// 2008).
    pub(crate) const AFTER_2_S: [f64; 2] = [1.706_167_732_170_469, -0.892_809_701_024_812_5];
}

impl Law<2, 0> for VanDerPol {
    const STATES: &'static [Variable] = &[state("x"), state("y")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let one = T::from_f64(1.0);
        let slope = ((one - x[0] * x[0]) * x[1] - x[0]) * T::from_f64(1e6);
        SVector::from([x[1], slope])
    }
}

/// Robertson's reactions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Robertson;

impl Law<3, 0> for Robertson {
    const STATES: &'static [Variable] = &[state("a"), state("b"), state("c")];

    fn slope<T: Real>(&self, x: &SVector<T, 3>, _: &SVector<T, 0>) -> SVector<T, 3> {
        let first = T::from_f64(0.04) * x[0];
        let second = T::from_f64(1e4) * x[1] * x[2];
        let third = T::from_f64(3e7) * x[1] * x[1];
        SVector::from([second - first, first - second - third, third])
    }
}

/// A rod of eight parts, warmed and cooled at one end at 1 rad/s: the two states of that, and temperatures of the parts.
#[derive(Clone, Copy)]
pub(crate) struct Warmed;

impl Law<10, 0> for Warmed {
    const STATES: &'static [Variable] = &[state(""); 10];

    fn slope<T: Real>(&self, x: &SVector<T, 10>, _: &SVector<T, 0>) -> SVector<T, 10> {
        let at = |place: usize| x.get(place).copied().unwrap_or(T::from_f64(0.0));
        SVector::from_fn(|place, _| match place {
            0 => x[1],
            1 => -x[0],
            _ => T::from_f64(100.0) * (at(place - 1) - x[place] - x[place] + at(place + 1)),
        })
    }
}

/// A rod of 1 m and 1 kg that hangs by a spring and a damper at its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StiffPin {
    /// Stiffness in N/m.
    pub stiffness: f64,
    /// Damping in N s/m.
    pub damping: f64,
}

impl StiffPin {
    /// Two pins, and angle and rate of the rod after 5 s from [`StiffPin::level`], computed with more digits.
    pub(crate) const AFTER_5_S: [(Self, [f64; 2]); 2] = [
        (
            Self {
                stiffness: 1e6,
                damping: 2e3,
            },
            [-1.366922113009797, 2.440936668346874],
        ),
        (
            Self {
                stiffness: 1e12,
                damping: 2e6,
            },
            [-1.366714573477783, 2.44223685380214],
        ),
    ];

    /// Level and at rest.
    pub(crate) fn level() -> SVector<f64, 6> {
        SVector::from([0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0])
    }

    /// Nominal sizes of the states: the pin gives as much as under the weight.
    pub(crate) fn nominal(&self) -> [f64; 6] {
        let small = 9.81 / self.stiffness;
        [small, small, 1.0, 1e-3, 1e-3, 1.0]
    }
}

impl Law<6, 0> for StiffPin {
    const STATES: &'static [Variable] = &[
        state("pin.x"),
        state("pin.y"),
        state("angle"),
        state("velocity.x"),
        state("velocity.y"),
        state("rate"),
    ];

    fn slope<T: Real>(&self, x: &SVector<T, 6>, _: &SVector<T, 0>) -> SVector<T, 6> {
        let [px, py, angle, vx, vy, rate] = x.data.0[0];
        let [k, c] = [self.stiffness, self.damping].map(T::from_f64);
        let (fx, fy) = (-(k * px) - c * vx, -(k * py) - c * vy);
        let (sin, cos) = angle.sin_cos();
        let half = T::from_f64(0.5);
        let turning = -(T::from_f64(6.0) * (sin * fy + cos * fx));
        let inward = half * rate * rate;
        SVector::from([
            vx,
            vy,
            rate,
            fx - half * turning * cos + inward * sin,
            fy - T::from_f64(9.81) - half * turning * sin - inward * cos,
            turning,
        ])
    }
}
