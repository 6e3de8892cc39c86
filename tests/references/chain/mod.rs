//! The chain in space: links that hang one below the other, on revolute joints about x and y in turn.
//!
//! Joint `i` turns link `i` about its own x axis for even `i`, about its y axis for odd `i`. Joint 0 is at the origin,
//! every other one at `(0, 0, −length)` of the link above. At zero angles all axes are parallel to those of the world
//! and the chain hangs straight down. A link is a solid cylinder, its centre of mass at `(0, 0, −length/2)`. The torque
//! in joint `i` is `τᵢ − damping · q̇ᵢ`. Gravity points along −z.

pub(crate) mod articulated;
pub(crate) mod composite;
pub(crate) mod counting;

/// Length of a link in m.
pub(crate) const LENGTH: f64 = 1.0;
/// Mass of a link in kg.
pub(crate) const MASS: f64 = 1.0;
/// Inertia about the centre of mass, across the link, in kg m²: `m (3 r² + l²) / 12` with `r = 0.05 m`.
pub(crate) const INERTIA_ACROSS: f64 = 0.083_958_333_333_333_34;
/// Inertia about the centre of mass, along the link, in kg m²: `m r² / 2`.
pub(crate) const INERTIA_ALONG: f64 = 0.001_250_000_000_000_000_2;
/// Damping of a joint in N m s/rad.
pub(crate) const DAMPING: f64 = 0.1;
/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.81;

/// The axis of a joint: 0 for x, 1 for y.
pub(crate) fn axis(joint: usize) -> usize {
    joint % 2
}

/// Angles, rates and torques of `n` joints for tests, in the range of one rad, rad/s and N m.
pub(crate) fn sample(n: usize, seed: usize) -> [Vec<f64>; 3] {
    [0.0, 1.0, 2.0].map(|kind| {
        (0..n)
            .map(|i| (12.9898 * (i as f64 + 1.0) + 78.233 * kind + 3.7 * seed as f64).sin())
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recursion_equals_the_mass_matrix() {
        let mut worst: f64 = 0.0;
        for n in 1..=32 {
            for seed in 0..5 {
                let [q, v, torque] = sample(n, seed);
                let recursive = articulated::accelerations(LENGTH, &q, &v, &torque);
                let direct = composite::accelerations(&q, &v, &torque);
                let size = direct.iter().fold(1.0, |size: f64, a| size.max(a.abs()));
                for (a, b) in recursive.iter().zip(&direct) {
                    worst = worst.max((a - b).abs() / size);
                }
            }
        }
        println!("chain: recursion against mass matrix, n up to 32: {worst:e}");
        assert!(worst < 1e-12, "{worst:e}");
    }

    #[test]
    fn one_link_is_a_pendulum() {
        let inertia = INERTIA_ACROSS + MASS * LENGTH * LENGTH / 4.0;
        let expected =
            (0.3 - DAMPING * 0.7 - MASS * GRAVITY * LENGTH / 2.0 * 0.4_f64.sin()) / inertia;
        let found = articulated::accelerations(LENGTH, &[0.4], &[0.7], &[0.3])[0];
        assert!((found - expected).abs() < 1e-14);
    }

    #[test]
    fn power_balance() {
        // dH/dt = Σ (τ − d q̇) q̇, by a central difference along the motion.
        let [q, v, torque] = sample(6, 3);
        let a = articulated::accelerations(LENGTH, &q, &v, &torque);
        let h = 1e-5;
        let energy = |h: f64| {
            let at = |x: &[f64], slope: &[f64]| -> Vec<f64> {
                x.iter()
                    .zip(slope)
                    .map(|(x, slope)| x + h * slope)
                    .collect()
            };
            let middle: Vec<f64> = v.iter().zip(&a).map(|(v, a)| v + 0.5 * h * a).collect();
            composite::energy(&at(&q, &middle), &at(&v, &a))
        };
        let difference = (energy(h) - energy(-h)) / (2.0 * h);
        let supplied: f64 = v
            .iter()
            .zip(&torque)
            .map(|(v, torque)| (torque - DAMPING * v) * v)
            .sum();
        assert!(
            (difference - supplied).abs() < 1e-7,
            "{difference} {supplied}"
        );
    }
}
