//! Bricard's mechanism: problem A04 of the multibody benchmarks of IFToMM.
//!
//! Five rods of 1 m and 1 kg with a square section of 0.1 m, joined by six revolute joints at P₁ … P₆, along the edges
//! of a cube; P₁ and P₆ are on the ground. Grübler's count gives no degree of freedom, there is one: a constraint is
//! redundant in every position. Gravity is 9.81 N/kg along −y. From rest, 10 s; recorded: P₃.
//!
//! | joint | place at the start in m | axis at the start |
//! |---|---|---|
//! | P₁ | (0, 0, 0), ground | y |
//! | P₂ | (1, 0, 0) | z |
//! | P₃ | (1, −1, 0) | x |
//! | P₄ | (1, −1, 1) | y |
//! | P₅ | (0, −1, 1) | z |
//! | P₆ | (0, 0, 1), ground | x |
//!
//! Source: González, Dopico, Lugrís, Cuadrado, *A benchmarking system for MBS simulation software*, Multibody System
//! Dynamics 16 (2006), `lim.ii.udc.es/mbsbenchmark/dist/A04`; numbers from `MBSbenchmarksInOpenSim` (University of
//! Padova), places and axes also from Exudyn's `bricardMechanism.py`. The published time history and its tolerance were
//! not to be had; the published figure shows P₃ back at (1, −1, 0) after about 5 s, with y up to −0.866 and z down to
//! −0.5 on the way.
//!
//! # Reference
//!
//! All links are equal and all twists are right angles, so the angles between successive links alternate between two
//! values `θ` and `φ` with
//!
//! ```text
//! cos θ + cos φ + cos θ cos φ = 0
//! ```
//! (Chen, You, Tarnai, *Threefold-symmetric Bricard linkages for deployable structures*, Int. J. Solids Structures 42
//! (2005), eq. (3) at a twist of 90°.) Both are −90° at the start. `θ`, the angle at P₁, P₃ and P₅, swings between ±90°,
//! where `φ` stays in [−120°, −90°] and depends on it smoothly. The equation of motion is that of Kane for the one
//! coordinate `θ`.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

use super::integrate::integrate;

/// Length of a rod in m.
pub(crate) const LENGTH: f64 = 1.0;
/// Mass of a rod in kg.
pub(crate) const MASS: f64 = 1.0;
/// Side of a rod's square section in m.
pub(crate) const SIDE: f64 = 0.1;
/// Inertias about the centre of mass across and along a rod in kg m².
pub(crate) const INERTIA: [f64; 2] = [
    MASS * (LENGTH * LENGTH + SIDE * SIDE) / 12.0,
    MASS * SIDE * SIDE / 6.0,
];
/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.81;
/// `θ` at the start in rad; the rate is zero.
pub(crate) const ANGLE: f64 = -FRAC_PI_2;
/// Duration in s.
pub(crate) const DURATION: f64 = 10.0;
/// Total energy in J, zero with all centres of mass at y = 0.
pub(crate) const ENERGY: f64 = -MASS * GRAVITY * 3.0;

/// The other angle, and its first and second derivative by `θ`.
fn other(angle: f64) -> [f64; 3] {
    let (sine, cosine) = angle.sin_cos();
    let other = -(-cosine / (1.0 + cosine)).acos();
    let (s, c) = other.sin_cos();
    let denominator = s * (1.0 + cosine);
    let first = -sine * (1.0 + c) / denominator;
    let second = -(cosine * (1.0 + c) - 2.0 * sine * s * first
        + first * first * c * (1.0 + cosine))
        / denominator;
    [other, first, second]
}

/// A rod, with derivatives by `θ`.
struct Rod {
    /// The joint at its end.
    end: Vector3<f64>,
    centre: Vector3<f64>,
    /// Velocity of the centre and angular velocity per `θ̇`.
    velocity: Vector3<f64>,
    omega: Vector3<f64>,
    /// Their parts per `θ̇²` at `θ̈ = 0`.
    acceleration: Vector3<f64>,
    alpha: Vector3<f64>,
    inertia: Matrix3<f64>,
}

fn turned(v: &Vector3<f64>, axis: &Vector3<f64>, angle: f64) -> Vector3<f64> {
    angle.cos() * v + angle.sin() * axis.cross(v)
}

fn rods(angle: f64) -> Vec<Rod> {
    let [other, first, second] = other(angle);
    let [
        mut joint,
        mut velocity,
        mut acceleration,
        mut omega,
        mut alpha,
    ] = [Vector3::zeros(); 5];
    // The link on the ground leads from P₆ to P₁.
    let mut along = -Vector3::z();
    let mut axis = Vector3::y();
    let mut rods = Vec::new();
    for index in 0..5 {
        let [turn, rate, bend] = if index % 2 == 0 {
            [angle, 1.0, 0.0]
        } else {
            [other, first, second]
        };
        alpha += omega.cross(&(rate * axis)) + bend * axis;
        omega += rate * axis;
        along = turned(&along, &axis, turn);
        let at = |place: f64| {
            let arm = place * along;
            (
                joint + arm,
                velocity + omega.cross(&arm),
                acceleration + alpha.cross(&arm) + omega.cross(&omega.cross(&arm)),
            )
        };
        let (middle, end) = (at(0.5 * LENGTH), at(LENGTH));
        rods.push(Rod {
            end: end.0,
            centre: middle.0,
            velocity: middle.1,
            omega,
            acceleration: middle.2,
            alpha,
            inertia: INERTIA[0] * Matrix3::identity()
                + (INERTIA[1] - INERTIA[0]) * along * along.transpose(),
        });
        (joint, velocity, acceleration) = end;
        // Twists of ±90°, in turn.
        axis = if index % 2 == 0 {
            along.cross(&axis)
        } else {
            axis.cross(&along)
        };
    }
    rods
}

/// `θ̈` in rad/s².
pub(crate) fn acceleration(angle: f64, rate: f64) -> f64 {
    let gravity = Vector3::new(0.0, -GRAVITY, 0.0);
    let (mut inertia, mut force) = (0.0, 0.0);
    for rod in rods(angle) {
        inertia += MASS * rod.velocity.norm_squared() + rod.omega.dot(&(rod.inertia * rod.omega));
        let square = rate * rate;
        let moment = rod.inertia * rod.alpha + rod.omega.cross(&(rod.inertia * rod.omega));
        force += MASS * rod.velocity.dot(&(gravity - square * rod.acceleration))
            - square * rod.omega.dot(&moment);
    }
    force / inertia
}

/// Total energy in J.
pub(crate) fn energy(angle: f64, rate: f64) -> f64 {
    rods(angle)
        .iter()
        .map(|rod| {
            let inertia =
                MASS * rod.velocity.norm_squared() + rod.omega.dot(&(rod.inertia * rod.omega));
            0.5 * inertia * rate * rate + MASS * GRAVITY * rod.centre.y
        })
        .sum()
}

/// P₂ to P₆ in m.
pub(crate) fn joints(angle: f64) -> [[f64; 3]; 5] {
    let rods = rods(angle);
    std::array::from_fn(|i| rods[i].end.into())
}

/// `θ` and `θ̇` at time `t`.
pub(crate) fn motion(t: f64) -> [f64; 2] {
    let steps = (12.0 * t).ceil().max(1.0) as usize;
    integrate(
        |_, [angle, rate]| [*rate, acceleration(*angle, *rate)],
        (0.0, t),
        steps,
        [ANGLE, 0.0],
    )
}

/// The recorded point P₃ at time `t` in m.
pub(crate) fn recorded(t: f64) -> [f64; 3] {
    joints(motion(t)[0])[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: [f64; 3], expected: [f64; 3], tolerance: f64) -> bool {
        found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < tolerance)
    }

    #[test]
    fn it_closes_in_every_position() {
        let start = [
            [1.0, 0.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, -1.0, 1.0],
            [0.0, -1.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        for (found, expected) in joints(ANGLE).into_iter().zip(start) {
            assert!(close(found, expected, 1e-15), "{found:?} {expected:?}");
        }
        for k in -9..=9 {
            let angle = f64::from(k) * FRAC_PI_2 / 9.0;
            assert!(
                close(joints(angle)[4], [0.0, 0.0, 1.0], 1e-14),
                "{angle} {:?}",
                joints(angle)[4]
            );
            let last = &rods(angle)[4];
            assert!(last.velocity.norm() < 10.0, "{angle}");
        }
    }

    #[test]
    fn energy_is_kept() {
        assert!((energy(ANGLE, 0.0) - ENERGY).abs() < 1e-14);
        for t in [1.0, DURATION] {
            let [angle, rate] = motion(t);
            assert!(
                (energy(angle, rate) - ENERGY).abs() < 1e-10,
                "{t} {}",
                energy(angle, rate) - ENERGY
            );
        }
    }

    #[test]
    fn moves_as_the_published_figure_shows() {
        let (half, full) = (recorded(2.5), recorded(5.0));
        println!("Bricard: P₃ at 2.5 and 5 s: {half:?} {full:?}");
        assert!(close(half, [-1.0, -1.0, 0.0], 0.02), "{half:?}");
        assert!(close(full, [1.0, -1.0, 0.0], 0.02), "{full:?}");
        assert!(close(recorded(1.25), [0.0, -0.866, -0.5], 0.05));
    }
}
