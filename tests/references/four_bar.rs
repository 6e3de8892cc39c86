//! `N` four-bars in a row: problem A02 of the multibody benchmarks of IFToMM.
//!
//! `N + 1` cranks A₀B₀ … A_N B_N stand on the ground at x = 0, 1, …, N, and `N` couplers join B₀ B₁ … B_N. All
//! `2N + 1` links are uniform rods of 1 m and 1 kg, gravity is 9.81 N/kg along −y. At the start the cranks stand
//! upright and B₀ moves with 1 m/s along +x. Duration 20 s for N = 40 in the specification; N = 2 and 10 s are in use,
//! too. Recorded: place and velocity of B₀. Allowed errors 1e-1 (low precision) and 1e-3 (high precision), over 400
//! instants and relative to at least 1e-3.
//!
//! Source: `lim.ii.udc.es/mbsbenchmark/dist/A02/A02_specification.xml`; González, Dopico, Lugrís, Cuadrado, *A
//! benchmarking system for MBS simulation software*, Multibody System Dynamics 16 (2006); N = 2 also in
//! `MBSbenchmarksInOpenSim` (University of Padova) and in Exudyn's `fourBarMechanismIftomm.py`. The published time
//! history, `A02_solution_data.txt`, was not to be had.
//!
//! # Reference
//!
//! Where the cranks lie on the ground the position is singular: the degree of freedom jumps from 1 to N + 1. The motion
//! that is continued smoothly keeps all cranks parallel, at an angle `θ` from the x axis; the couplers do not turn.
//!
//! ```text
//! T = ½ ((N + 1)/3 + N) m l² θ̇²        V = ((N + 1)/2 + N) m g l sin θ
//! θ̈ = −κ (g/l) cos θ,   κ = 3 (3N + 1) / (2 (4N + 1))
//! ```
//! a pendulum, for which nothing is singular. It turns over: θ̇ never vanishes.

use std::f64::consts::FRAC_PI_2;

use super::integrate::integrate;

/// Length of a link in m.
pub(crate) const LENGTH: f64 = 1.0;
/// Mass of a link in kg.
pub(crate) const MASS: f64 = 1.0;
/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.81;
/// Angle of the cranks at the start in rad.
pub(crate) const ANGLE: f64 = FRAC_PI_2;
/// Rate of the cranks at the start in rad/s: B₀ moves with 1 m/s along +x.
pub(crate) const RATE: f64 = -1.0;
/// Duration in s.
pub(crate) const DURATION: f64 = 20.0;
/// Loops of the specification.
pub(crate) const LOOPS: usize = 40;
/// Allowed error of high precision.
pub(crate) const TOLERANCE: f64 = 1e-3;

fn weight(loops: usize) -> (f64, f64) {
    let n = loops as f64;
    ((n + 1.0) / 3.0 + n, (n + 1.0) / 2.0 + n)
}

/// Total energy in J, zero at rest on the ground.
pub(crate) fn energy(loops: usize, angle: f64, rate: f64) -> f64 {
    let (inertia, moment) = weight(loops);
    MASS * LENGTH * (0.5 * inertia * LENGTH * rate * rate + moment * GRAVITY * angle.sin())
}

/// Angle and rate of the cranks at time `t`.
pub(crate) fn motion(loops: usize, t: f64) -> [f64; 2] {
    let (inertia, moment) = weight(loops);
    let factor = moment / inertia * GRAVITY / LENGTH;
    let steps = (20.0 * t).ceil().max(1.0) as usize;
    integrate(
        |_, [angle, rate]| [*rate, -factor * angle.cos()],
        (0.0, t),
        steps,
        [ANGLE, RATE],
    )
}

/// Place and velocity of B₀ at time `t`.
pub(crate) fn tip(loops: usize, t: f64) -> [[f64; 2]; 2] {
    let [angle, rate] = motion(loops, t);
    let (sine, cosine) = angle.sin_cos();
    [
        [LENGTH * cosine, LENGTH * sine],
        [-LENGTH * sine * rate, LENGTH * cosine * rate],
    ]
}

#[cfg(test)]
mod tests {
    use super::super::planar::{Body, Mechanism, Point, term};
    use super::*;

    #[test]
    fn energy_is_kept_over_the_horizon() {
        for loops in [1, 2, LOOPS] {
            let [angle, rate] = motion(loops, DURATION);
            let start = energy(loops, ANGLE, RATE);
            let change = energy(loops, angle, rate) - start;
            assert!(change.abs() < 1e-12 * start, "{loops} {change:e}");
        }
        assert!((energy(2, ANGLE, RATE) - (3.5 * 9.81 + 1.5)).abs() < 1e-13);
    }

    #[test]
    fn two_loops_agree_with_a_published_run() {
        // Exudyn, N = 2 at 10 s in steps of 2.5e-4 and 1.25e-4, extrapolated to zero for its order of two.
        let extrapolate = |coarse: f64, fine: f64| fine + (fine - coarse) / 3.0;
        let place = [
            extrapolate(0.3284552113, 0.3284573768),
            extrapolate(0.9445195467, 0.9445187937),
        ];
        let velocity = [
            extrapolate(1.423045728, 1.423050003),
            extrapolate(-0.4948619021, -0.4948670827),
        ];
        let [found, speed] = tip(2, 10.0);
        for i in 0..2 {
            assert!((found[i] - place[i]).abs() < 1e-7, "{found:?} {place:?}");
            assert!(
                (speed[i] - velocity[i]).abs() < 1e-7,
                "{speed:?} {velocity:?}"
            );
        }
    }

    #[test]
    fn it_is_the_mechanism_with_three_bars() {
        let bar = |terms: &[(f64, usize)], turn: usize| {
            let unit = |index: usize| std::array::from_fn(|i| if i == index { 1.0 } else { 0.0 });
            Body {
                mass: MASS,
                inertia: MASS * LENGTH * LENGTH / 12.0,
                centre: Point {
                    origin: [if turn == 2 { LENGTH } else { 0.0 }, 0.0],
                    terms: terms.iter().map(|(l, i)| term(*l, 0.0, unit(*i))).collect(),
                },
                turn: unit(turn),
            }
        };
        let closing = bar(&[(1.0, 0), (1.0, 1), (-1.0, 2)], 0).centre;
        let mechanism = Mechanism::<3> {
            bodies: vec![
                bar(&[(0.5, 0)], 0),
                bar(&[(1.0, 0), (0.5, 1)], 1),
                bar(&[(0.5, 2)], 2),
            ],
            closings: vec![Point {
                origin: [-LENGTH, 0.0],
                ..closing
            }],
            gravity: GRAVITY,
        };
        let (angle, rate) = (0.9, -2.0);
        let q = [angle, 0.0, angle];
        let v = [rate, 0.0, rate];
        let (a, _) = mechanism.accelerations(&q, &v, [0.0; 3]);
        let expected = -1.2 * GRAVITY * f64::cos(angle);
        assert!(
            (a[0] - expected).abs() < 1e-12 && a[1].abs() < 1e-12,
            "{a:?} {expected}"
        );
        assert!((mechanism.energy(&q, &v) - energy(1, angle, rate)).abs() < 1e-12);
    }
}
