//! A cart with `n` uniform rods hanging one below the other, in a plane.
//!
//! With absolute angles `θₖ` from the downward vertical, positive towards `+x`, the centre of rod `k` is at
//! `x + Σ_{i<k} lᵢ sin θᵢ + ½ lₖ sin θₖ` and `−Σ_{i<k} lᵢ cos θᵢ − ½ lₖ cos θₖ`. With
//! `μₖ = lₖ (½ mₖ + Σ_{i>k} mᵢ)` Lagrange's equations are
//!
//! ```text
//! (M + Σ mₖ) ẍ + Σ μₖ cos θₖ θ̈ₖ = F + Σ μₖ sin θₖ θ̇ₖ²
//! μₖ cos θₖ ẍ + Σⱼ Jₖⱼ cos(θₖ − θⱼ) θ̈ⱼ = −Σⱼ Jₖⱼ sin(θₖ − θⱼ) θ̇ⱼ² − g μₖ sin θₖ
//!
//! Jₖₖ = mₖ lₖ² / 3 + lₖ² Σ_{i>k} mᵢ        Jₖⱼ = Jⱼₖ = lₖ μⱼ for k < j
//! ```

use super::dense;

/// Cart and rods, from the cart down.
#[derive(Clone, Debug)]
pub(crate) struct Cart {
    /// Mass of the cart in kg; infinite for a fixed one.
    pub(crate) mass: f64,
    /// Masses of the rods in kg.
    pub(crate) rods: Vec<f64>,
    /// Lengths of the rods in m.
    pub(crate) lengths: Vec<f64>,
    /// Gravity in m/s².
    pub(crate) gravity: f64,
}

impl Cart {
    /// `n` rods of 1 m and 1 kg.
    pub(crate) fn uniform(mass: f64, n: usize) -> Self {
        Self {
            mass,
            rods: vec![1.0; n],
            lengths: vec![1.0; n],
            gravity: 9.81,
        }
    }

    fn below(&self, k: usize) -> f64 {
        self.rods[k + 1..].iter().sum()
    }

    fn moment(&self, k: usize) -> f64 {
        self.lengths[k] * (0.5 * self.rods[k] + self.below(k))
    }

    fn inertia(&self, k: usize, j: usize) -> f64 {
        if k == j {
            self.lengths[k].powi(2) * (self.rods[k] / 3.0 + self.below(k))
        } else {
            self.lengths[k.min(j)] * self.moment(k.max(j))
        }
    }

    /// `ẍ`, then each `θ̈`.
    pub(crate) fn accelerations(&self, angles: &[f64], rates: &[f64], force: f64) -> Vec<f64> {
        let n = angles.len();
        let mut matrix = vec![vec![0.0; n + 1]; n + 1];
        let mut right = vec![0.0; n + 1];
        if self.mass.is_finite() {
            matrix[0][0] = self.mass + self.rods.iter().sum::<f64>();
            right[0] = force;
        } else {
            matrix[0][0] = 1.0;
        }
        for k in 0..n {
            let (sine, cosine) = angles[k].sin_cos();
            matrix[k + 1][0] = self.moment(k) * cosine;
            if self.mass.is_finite() {
                matrix[0][k + 1] = matrix[k + 1][0];
                right[0] += self.moment(k) * sine * rates[k] * rates[k];
            }
            right[k + 1] -= self.gravity * self.moment(k) * sine;
            for j in 0..n {
                let (sine, cosine) = (angles[k] - angles[j]).sin_cos();
                matrix[k + 1][j + 1] = self.inertia(k, j) * cosine;
                right[k + 1] -= self.inertia(k, j) * sine * rates[j] * rates[j];
            }
        }
        dense::solve(matrix, right)
    }

    /// Total energy in J, zero at rest with all rods in the height of the cart.
    pub(crate) fn energy(&self, speed: f64, angles: &[f64], rates: &[f64]) -> f64 {
        let mut joint = [speed, 0.0];
        let mut height = 0.0;
        let mut energy = if self.mass.is_finite() {
            0.5 * self.mass * speed * speed
        } else {
            0.0
        };
        for k in 0..angles.len() {
            let (sine, cosine) = angles[k].sin_cos();
            let half = 0.5 * self.lengths[k];
            let swing = [half * cosine * rates[k], half * sine * rates[k]];
            let centre = [joint[0] + swing[0], joint[1] + swing[1]];
            let inertia = self.rods[k] * self.lengths[k].powi(2) / 12.0;
            energy += 0.5 * self.rods[k] * (centre[0].powi(2) + centre[1].powi(2))
                + 0.5 * inertia * rates[k].powi(2)
                + self.rods[k] * self.gravity * (height - half * cosine);
            joint = [centre[0] + swing[0], centre[1] + swing[1]];
            height -= self.lengths[k] * cosine;
        }
        energy
    }
}

#[cfg(test)]
mod tests {
    use super::super::integrate::integrate;
    use super::*;

    #[test]
    fn energy_is_kept() {
        const N: usize = 4;
        let cart = Cart {
            mass: 2.0,
            rods: vec![1.0, 0.7, 1.3, 0.4],
            lengths: vec![0.5, 1.0, 0.8, 0.6],
            gravity: 9.81,
        };
        let energy = |x: &[f64; 2 * N + 2]| cart.energy(x[1], &x[2..2 + N], &x[2 + N..]);
        let start = [0.0, 0.3, 1.0, -0.4, 2.0, 0.1, 0.5, -1.0, 0.0, 2.0];
        let end = integrate(
            |_, x: &[f64; 2 * N + 2]| {
                let a = cart.accelerations(&x[2..2 + N], &x[2 + N..], 0.0);
                let mut slope = [0.0; 2 * N + 2];
                (slope[0], slope[1]) = (x[1], a[0]);
                slope[2..2 + N].copy_from_slice(&x[2 + N..]);
                slope[2 + N..].copy_from_slice(&a[1..]);
                slope
            },
            (0.0, 1.0),
            400,
            start,
        );
        let change = energy(&end) - energy(&start);
        assert!(change.abs() < 1e-11, "{change:e}");
    }

    #[test]
    fn one_rod_is_a_crane() {
        // A rod pinned at its end is a load at 2/3 of its length, of 3/4 of its mass, and the rest in the cart.
        let cart = Cart {
            mass: 2.0,
            rods: vec![0.8],
            lengths: vec![1.5],
            gravity: 9.81,
        };
        let crane = crate::references::crane::Crane {
            trolley: 2.2,
            load: 0.6,
            cable: 1.0,
            gravity: 9.81,
        };
        let found = cart.accelerations(&[0.7], &[1.1], 3.0);
        let [_, _, a, alpha] = crane.derivative(&[0.0, 0.7, 0.2, 1.1], 3.0);
        assert!((found[0] - a).abs() < 1e-14 && (found[1] - alpha).abs() < 1e-14);
    }
}
