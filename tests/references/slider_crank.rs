//! The spatial rigid slider-crank of the multibody benchmarks of IFToMM.
//!
//! A crank of 0.08 m turns about the x axis through A = (0, 0.1, 0.12) m; at `θ = 0` it points along +z, and it starts
//! there with 6 rad/s. A rod of 0.3 m leads from its tip B, a spherical joint, to C on a block that slides along the
//! x axis, a universal joint. Gravity is 9.81 m/s² along −z, there is no friction. Duration 5 s, recorded: place and
//! speed of the slider, and the angle of the crank. The crank turns over, so the slider passes both dead centres.
//!
//! Source: Masoudi, Uchida, Vilela, Luaces, Cuadrado, McPhee, *A Library of Computational Benchmark Problems for the
//! Multibody Dynamics Community*, ECCOMAS 2013, after Haug, *Computer Aided Kinematics and Dynamics of Mechanical
//! Systems*, vol. 1, 1989, pp. 396–401.
//!
//! Not stated there: where the centres of mass are, which axis of an inertia lies along its link, which axis of the
//! universal joint is fixed in the slider, and a tolerance of the result (the published run used 1e-4 in its
//! integrator). Runs of the library disagree accordingly; slider at 5 s in m:
//!
//! | Gonzalez | Masarati | Masoudi | Chaojie |
//! |---|---|---|---|
//! | 0.24076 | 0.25179 | 0.26101 | 0.27900 |
//!
//! Taken here: centres of mass in the middle of the links, the small inertias along them, the universal joint's fixed
//! axis along the slide. That gives 0.24072 at 5 s and stays within 4.3e-5 m of the run of Gonzalez.
//!
//! # Reference
//!
//! One degree of freedom: `T = ½ m(θ) θ̇²` and `θ̇ = √(2 (E − V(θ)) / m(θ))`, which keeps the energy exactly and never
//! vanishes. With `e = (C − B)/l` and a prime for `d/dθ`, the rod turns with `e × e'` across, and about itself with
//! `η' eₓ`, where `η' = (e_y e_z' − e_z e_y') / (e_y² + e_z²)` is the turn of the universal joint about x.

use nalgebra::Vector3;

use super::integrate::integrate;

/// Place of the crank's bearing in m.
pub(crate) const BEARING: [f64; 3] = [0.0, 0.1, 0.12];
/// Length of the crank in m.
pub(crate) const CRANK: f64 = 0.08;
/// Length of the rod in m.
pub(crate) const ROD: f64 = 0.3;
/// Masses of crank, rod and slider in kg.
pub(crate) const MASS: [f64; 3] = [0.12, 0.5, 2.0];
/// Inertias about the centre of mass across and along the crank in kg m².
pub(crate) const CRANK_INERTIA: [f64; 2] = [1e-4, 1e-5];
/// Inertias about the centre of mass across and along the rod in kg m².
pub(crate) const ROD_INERTIA: [f64; 2] = [4e-3, 4e-4];
/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.81;
/// Rate of the crank at the start in rad/s, at the angle 0.
pub(crate) const RATE: f64 = 6.0;
/// Duration in s.
pub(crate) const DURATION: f64 = 5.0;

/// Tip of the crank and slider, and their derivatives by the angle of the crank.
fn points(angle: f64) -> [Vector3<f64>; 4] {
    let (sine, cosine) = angle.sin_cos();
    let tip = Vector3::from(BEARING) + CRANK * Vector3::new(0.0, -sine, cosine);
    let slope = CRANK * Vector3::new(0.0, -cosine, -sine);
    let x = (ROD * ROD - tip.y * tip.y - tip.z * tip.z).sqrt();
    let speed = -(tip.y * slope.y + tip.z * slope.z) / x;
    [
        tip,
        Vector3::new(x, 0.0, 0.0),
        slope,
        Vector3::new(speed, 0.0, 0.0),
    ]
}

/// Place of the slider in m.
pub(crate) fn slider(angle: f64) -> f64 {
    points(angle)[1].x
}

/// Inertia seen from the crank in kg m².
pub(crate) fn inertia(angle: f64) -> f64 {
    let [tip, slider, tip_slope, slider_slope] = points(angle);
    let e = (slider - tip) / ROD;
    let slope = (slider_slope - tip_slope) / ROD;
    let turn = (e.y * slope.z - e.z * slope.y) / (e.y * e.y + e.z * e.z);
    let centre = 0.5 * (tip_slope + slider_slope);
    CRANK_INERTIA[0]
        + MASS[0] * (0.5 * CRANK).powi(2)
        + MASS[1] * centre.norm_squared()
        + ROD_INERTIA[0] * e.cross(&slope).norm_squared()
        + ROD_INERTIA[1] * (turn * e.x).powi(2)
        + MASS[2] * slider_slope.norm_squared()
}

/// Energy of gravity in J, zero at z = 0.
pub(crate) fn potential(angle: f64) -> f64 {
    let [tip, ..] = points(angle);
    GRAVITY * (MASS[0] * 0.5 * (tip.z + BEARING[2]) + MASS[1] * 0.5 * tip.z)
}

/// Total energy in J.
pub(crate) fn energy(angle: f64, rate: f64) -> f64 {
    0.5 * inertia(angle) * rate * rate + potential(angle)
}

/// Rate of the crank in rad/s.
pub(crate) fn rate(angle: f64) -> f64 {
    (2.0 * (energy(0.0, RATE) - potential(angle)) / inertia(angle)).sqrt()
}

/// Angle of the crank at time `t` in rad.
pub(crate) fn angle(t: f64) -> f64 {
    let steps = (120.0 * t).ceil().max(1.0) as usize;
    integrate(|_, [angle]| [rate(*angle)], (0.0, t), steps, [0.0])[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start() {
        // The slider at 0.2 m moves with 0.24 m/s, as Exudyn states.
        assert!((slider(0.0) - 0.2).abs() < 1e-15);
        assert!((points(0.0)[3].x * RATE - 0.24).abs() < 1e-15);
    }

    #[test]
    fn agrees_with_a_published_run() {
        // The run of Gonzalez, nine digits every 0.01 s, with an integrator's error that grows along the run.
        let mut worst: f64 = 0.0;
        for (t, expected) in [
            (4.33, 0.289872199),
            (4.55, 0.185003711),
            (4.9, 0.289954884),
            (5.0, 0.240761815),
        ] {
            worst = worst.max((slider(angle(t)) - expected).abs());
        }
        println!(
            "slider-crank: {} m at the end, against Gonzalez {worst:e} m",
            slider(angle(DURATION))
        );
        assert!(worst < 1e-4, "{worst:e}");
    }

    #[test]
    fn both_dead_centres_are_passed() {
        let turns = angle(DURATION) / std::f64::consts::TAU;
        assert!(turns > 8.0, "{turns}");
        let finer = integrate(|_, [angle]| [rate(*angle)], (0.0, DURATION), 1000, [0.0])[0];
        let error = angle(DURATION) - finer;
        assert!(error.abs() < 1e-10, "{error:e}");
    }
}
