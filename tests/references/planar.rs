//! Mechanisms in a plane whose points are sums of turning links.
//!
//! With `e(a) = (cos a, sin a)` a point is `p = p₀ + Σ lᵢ e(cᵢ · q + phaseᵢ)`. Its Jacobian and its acceleration at
//! `q̈ = 0` follow at once: `∂p/∂q = Σ lᵢ n(…) cᵢᵀ` with `n = e'`, and `−Σ lᵢ e(…) (cᵢ · q̇)²`. Lagrange's equations of
//! the first kind are then
//!
//! ```text
//! M q̈ + Gᵀ λ = f − Σ m Jᵀ a₀        G q̈ = −g₀        M = Σ m JᵀJ + I c cᵀ
//! ```

use super::dense;

/// A turning link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term<const N: usize> {
    length: f64,
    phase: f64,
    turn: [f64; N],
}

/// `length · e(turn · q + phase)`.
pub(crate) fn term<const N: usize>(length: f64, phase: f64, turn: [f64; N]) -> Term<N> {
    Term {
        length,
        phase,
        turn,
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A sum of links from a fixed origin.
#[derive(Clone, Debug)]
pub(crate) struct Point<const N: usize> {
    /// Where the links begin.
    pub(crate) origin: [f64; 2],
    /// The links.
    pub(crate) terms: Vec<Term<N>>,
}

impl<const N: usize> Point<N> {
    /// Place in m.
    pub(crate) fn position(&self, q: &[f64; N]) -> [f64; 2] {
        self.terms.iter().fold(self.origin, |[x, y], term| {
            let (sine, cosine) = (dot(&term.turn, q) + term.phase).sin_cos();
            [x + term.length * cosine, y + term.length * sine]
        })
    }

    /// For each coordinate the derivative of x and y.
    pub(crate) fn jacobian(&self, q: &[f64; N]) -> [[f64; 2]; N] {
        let mut jacobian = [[0.0; 2]; N];
        for term in &self.terms {
            let (sine, cosine) = (dot(&term.turn, q) + term.phase).sin_cos();
            for (column, turn) in jacobian.iter_mut().zip(term.turn) {
                column[0] -= term.length * sine * turn;
                column[1] += term.length * cosine * turn;
            }
        }
        jacobian
    }

    /// Acceleration at `q̈ = 0`.
    fn bias(&self, q: &[f64; N], v: &[f64; N]) -> [f64; 2] {
        self.terms.iter().fold([0.0; 2], |[x, y], term| {
            let (sine, cosine) = (dot(&term.turn, q) + term.phase).sin_cos();
            let square = dot(&term.turn, v).powi(2) * term.length;
            [x - cosine * square, y - sine * square]
        })
    }
}

/// A rigid body.
#[derive(Clone, Debug)]
pub(crate) struct Body<const N: usize> {
    /// In kg.
    pub(crate) mass: f64,
    /// About the centre of mass, in kg m².
    pub(crate) inertia: f64,
    /// Centre of mass.
    pub(crate) centre: Point<N>,
    /// Its angle is `turn · q`.
    pub(crate) turn: [f64; N],
}

/// Bodies and loops; gravity along −y.
#[derive(Clone, Debug)]
pub(crate) struct Mechanism<const N: usize> {
    /// The bodies.
    pub(crate) bodies: Vec<Body<N>>,
    /// Points that stay at zero.
    pub(crate) closings: Vec<Point<N>>,
    /// In m/s².
    pub(crate) gravity: f64,
}

impl<const N: usize> Mechanism<N> {
    /// What is left open of each loop, x before y.
    pub(crate) fn closing(&self, q: &[f64; N]) -> Vec<f64> {
        self.closings
            .iter()
            .flat_map(|point| point.position(q))
            .collect()
    }

    /// `q̈` and `λ` under generalised forces besides gravity. The constraints must be independent.
    pub(crate) fn accelerations(
        &self,
        q: &[f64; N],
        v: &[f64; N],
        forces: [f64; N],
    ) -> ([f64; N], Vec<f64>) {
        let size = N + 2 * self.closings.len();
        let mut matrix = vec![vec![0.0; size]; size];
        let mut right = vec![0.0; size];
        right[..N].copy_from_slice(&forces);
        for body in &self.bodies {
            let jacobian = body.centre.jacobian(q);
            let bias = body.centre.bias(q, v);
            for i in 0..N {
                let force = jacobian[i][0] * bias[0] + jacobian[i][1] * (bias[1] + self.gravity);
                right[i] -= body.mass * force;
                for j in 0..N {
                    matrix[i][j] += body.mass * dot(&jacobian[i], &jacobian[j])
                        + body.inertia * body.turn[i] * body.turn[j];
                }
            }
        }
        for (index, point) in self.closings.iter().enumerate() {
            let jacobian = point.jacobian(q);
            let bias = point.bias(q, v);
            for component in 0..2 {
                let row = N + 2 * index + component;
                right[row] = -bias[component];
                for i in 0..N {
                    matrix[row][i] = jacobian[i][component];
                    matrix[i][row] = jacobian[i][component];
                }
            }
        }
        let solution = dense::solve(matrix, right);
        (std::array::from_fn(|i| solution[i]), solution[N..].to_vec())
    }

    /// Kinetic energy and that of gravity in J, zero at rest with all centres of mass at y = 0.
    pub(crate) fn energy(&self, q: &[f64; N], v: &[f64; N]) -> f64 {
        self.bodies
            .iter()
            .map(|body| {
                let jacobian = body.centre.jacobian(q);
                let speed = |component: usize| -> f64 {
                    (0..N).map(|i| jacobian[i][component] * v[i]).sum()
                };
                let omega = dot(&body.turn, v);
                0.5 * body.mass * (speed(0).powi(2) + speed(1).powi(2))
                    + 0.5 * body.inertia * omega * omega
                    + body.mass * self.gravity * body.centre.position(q)[1]
            })
            .sum()
    }
}
