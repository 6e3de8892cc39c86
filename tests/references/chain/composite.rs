//! Forward dynamics by the mass matrix, in the axes of the world.
//!
//! Kane's equations: with the partial velocities `∂v_c/∂q̇ₖ = aₖ × (c − oₖ)` and `∂ω/∂q̇ₖ = aₖ` of every link below
//! joint `k` at `oₖ` with the axis `aₖ`,
//!
//! ```text
//! Mⱼₖ = Σ m ∂vⱼ · ∂vₖ + ∂ωⱼ · I ∂ωₖ
//! bₖ  = Σ ∂vₖ · m (a₀ − g) + ∂ωₖ · (I α₀ + ω × I ω),   with the accelerations a₀, α₀ at q̈ = 0
//! M q̈ = τ − b
//! ```

use nalgebra::{Matrix3, Vector3};

use super::{DAMPING, GRAVITY, INERTIA_ACROSS, INERTIA_ALONG, LENGTH, MASS, axis};
use crate::references::dense;

/// A link in the axes of the world, with the accelerations at `q̈ = 0`.
struct Link {
    /// Axis and place of the joint that holds it.
    axis: Vector3<f64>,
    joint: Vector3<f64>,
    centre: Vector3<f64>,
    velocity: Vector3<f64>,
    acceleration: Vector3<f64>,
    omega: Vector3<f64>,
    alpha: Vector3<f64>,
    inertia: Matrix3<f64>,
}

fn rotation(axis: usize, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    match axis {
        0 => Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c),
        _ => Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c),
    }
}

fn links(q: &[f64], v: &[f64]) -> Vec<Link> {
    let mut axes = Matrix3::identity();
    let (mut joint, mut velocity, mut acceleration) =
        (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
    let (mut omega, mut alpha) = (Vector3::zeros(), Vector3::zeros());
    let own = Matrix3::from_diagonal(&Vector3::new(INERTIA_ACROSS, INERTIA_ACROSS, INERTIA_ALONG));
    let mut links = Vec::new();
    for (i, (q, v)) in q.iter().zip(v).enumerate() {
        axes *= rotation(axis(i), *q);
        let axis = axes.column(axis(i)).into_owned();
        alpha += omega.cross(&(axis * *v));
        omega += axis * *v;
        let at = |place: f64| {
            let arm: Vector3<f64> = axes * Vector3::new(0.0, 0.0, place);
            (
                joint + arm,
                velocity + omega.cross(&arm),
                acceleration + alpha.cross(&arm) + omega.cross(&omega.cross(&arm)),
            )
        };
        let centre = at(-LENGTH / 2.0);
        let next = at(-LENGTH);
        links.push(Link {
            axis,
            joint,
            centre: centre.0,
            velocity: centre.1,
            acceleration: centre.2,
            omega,
            alpha,
            inertia: axes * own * axes.transpose(),
        });
        (joint, velocity, acceleration) = next;
    }
    links
}

/// `q̈` of the chain.
pub(crate) fn accelerations(q: &[f64], v: &[f64], torque: &[f64]) -> Vec<f64> {
    let links = links(q, v);
    let n = q.len();
    let mut matrix = vec![vec![0.0; n]; n];
    let mut right: Vec<f64> = torque
        .iter()
        .zip(v)
        .map(|(torque, v)| torque - DAMPING * v)
        .collect();
    let gravity = Vector3::new(0.0, 0.0, -GRAVITY);
    for (i, link) in links.iter().enumerate() {
        let partial: Vec<_> = links[..=i]
            .iter()
            .map(|above| (above.axis.cross(&(link.centre - above.joint)), above.axis))
            .collect();
        let force = MASS * (link.acceleration - gravity);
        let torque = link.inertia * link.alpha + link.omega.cross(&(link.inertia * link.omega));
        for (j, (velocity, omega)) in partial.iter().enumerate() {
            right[j] -= velocity.dot(&force) + omega.dot(&torque);
            for (k, other) in partial.iter().enumerate() {
                matrix[j][k] +=
                    MASS * velocity.dot(&other.0) + omega.dot(&(link.inertia * other.1));
            }
        }
    }
    dense::solve(matrix, right)
}

/// Total energy, zero at rest in the height of joint 0.
pub(crate) fn energy(q: &[f64], v: &[f64]) -> f64 {
    links(q, v)
        .iter()
        .map(|link| {
            0.5 * MASS * link.velocity.norm_squared()
                + 0.5 * link.omega.dot(&(link.inertia * link.omega))
                + MASS * GRAVITY * link.centre.z
        })
        .sum()
}
