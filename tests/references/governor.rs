//! The stiff flyball governor: problem A05 of the multibody benchmarks of IFToMM.
//!
//! A shaft turns freely about z, which points up. A slider moves along it, at the height `s`. Two rods are pinned to the
//! shaft at (±0.05, 0, 1) m and hang at `α` below the horizontal, a point mass at the end of each. Two springs with
//! dampers lead from the middle of the rods to (±0.05, 0, s) on the slider. Shaft and rods are 1 × 0.01 × 0.01 m, the
//! slider is a cube of 0.1 m, all of 3000 kg/m³. At the start `s = 0.5 m`, `α = 30°`, the springs are relaxed, and all
//! turns with 2π rad/s. Duration 10 s; recorded: `s`.
//!
//! Source: González, Dopico, Lugrís, Cuadrado, *A benchmarking system for MBS simulation software*, Multibody System
//! Dynamics 16 (2006), `lim.ii.udc.es/mbsbenchmark/dist/A05`; numbers from `MBSbenchmarksInOpenSim` (University of
//! Padova). The published time history and its tolerance were not to be had; its figure shows `s` swing between 0.500
//! and 0.743 m, with about 9.8 swings in 10 s. (Exudyn's `stiffFlyballGovernor.py` takes a spring and damper of 0.005
//! times these and 0.16 · 2π rad/s: another problem.)
//!
//! # Reference
//!
//! The angular momentum `J(α) ω` about the shaft is kept, so `α` and `s` remain. With the length `L` of a spring and
//! `F = K (L − L₀) + C L̇`:
//!
//! ```text
//! J(α) = J₀ + 2 [Iₗ sin² α + Iₜ cos² α + m (a + ½ l cos α)² + M (a + l cos α)²]
//! 2 (Iₜ + m l²/4 + M l²) α̈ = ½ J'(α) ω² + 2 g l (½ m + M) cos α − 2 F ∂L/∂α
//! mₛ s̈ = −mₛ g − 2 F ∂L/∂s
//! ```

use std::f64::consts::{FRAC_PI_6, TAU};

use super::integrate::runge_kutta;

/// Density of shaft, rods and slider in kg/m³.
pub(crate) const DENSITY: f64 = 3000.0;
/// Length of shaft and rods in m.
pub(crate) const LENGTH: f64 = 1.0;
/// Side of their square sections in m.
pub(crate) const SIDE: f64 = 0.01;
/// Side of the slider in m; the pins and the springs' ends are half of it from the axis.
pub(crate) const SLIDER: f64 = 0.1;
/// Mass of shaft and of a rod in kg.
pub(crate) const ROD_MASS: f64 = DENSITY * LENGTH * SIDE * SIDE;
/// Mass of the slider in kg.
pub(crate) const SLIDER_MASS: f64 = DENSITY * SLIDER * SLIDER * SLIDER;
/// Mass of a ball in kg.
pub(crate) const BALL_MASS: f64 = 5.0;
/// Stiffness of a spring in N/m.
pub(crate) const STIFFNESS: f64 = 8e5;
/// Damping in N s/m.
pub(crate) const DAMPING: f64 = 4e4;
/// Length of a relaxed spring in m.
pub(crate) const RELAXED: f64 = 0.5;
/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.81;
/// `[α, s, α̇, ṡ]` at the start.
pub(crate) const START: [f64; 4] = [FRAC_PI_6, 0.5, 0.0, 0.0];
/// Rate of the shaft at the start in rad/s.
pub(crate) const RATE: f64 = TAU;
/// Duration in s.
pub(crate) const DURATION: f64 = 10.0;

/// Inertia of a rod along it.
const ALONG: f64 = ROD_MASS * SIDE * SIDE / 6.0;
/// Inertia of a rod across it.
const ACROSS: f64 = ROD_MASS * (LENGTH * LENGTH + SIDE * SIDE) / 12.0;
/// Inertia of a rod with its ball about the pin.
const SWINGING: f64 = ACROSS + (0.25 * ROD_MASS + BALL_MASS) * LENGTH * LENGTH;
/// First moment of a rod with its ball about the pin.
const MOMENT: f64 = (0.5 * ROD_MASS + BALL_MASS) * LENGTH;

/// Inertia about the shaft, and its derivative by `α`.
fn spinning(angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    let [rod, ball] = [0.5, 1.0].map(|place| 0.5 * SLIDER + place * LENGTH * cosine);
    let fixed = ALONG + SLIDER_MASS * SLIDER * SLIDER / 6.0;
    [
        fixed
            + 2.0
                * (ALONG * sine * sine
                    + ACROSS * cosine * cosine
                    + ROD_MASS * rod * rod
                    + BALL_MASS * ball * ball),
        4.0 * sine
            * ((ALONG - ACROSS) * cosine - LENGTH * (0.5 * ROD_MASS * rod + BALL_MASS * ball)),
    ]
}

/// Rate of the shaft in rad/s.
pub(crate) fn rate(angle: f64) -> f64 {
    RATE * spinning(START[0])[0] / spinning(angle)[0]
}

/// Length of a spring, its derivatives by `α` and `s`.
fn spring(angle: f64, height: f64) -> [f64; 3] {
    let (sine, cosine) = angle.sin_cos();
    let half = 0.5 * LENGTH;
    let (x, z) = (half * cosine, LENGTH - half * sine - height);
    let length = x.hypot(z);
    [
        length,
        -half * (x * sine + z * cosine) / length,
        -z / length,
    ]
}

/// `[α̇, ṡ, α̈, s̈]`.
pub(crate) fn derivative([angle, height, swing, speed]: &[f64; 4]) -> [f64; 4] {
    let [length, by_angle, by_height] = spring(*angle, *height);
    let force = STIFFNESS * (length - RELAXED) + DAMPING * (by_angle * swing + by_height * speed);
    let centrifugal = 0.5 * spinning(*angle)[1] * rate(*angle).powi(2);
    let weight = 2.0 * GRAVITY * MOMENT * angle.cos();
    [
        *swing,
        *speed,
        (centrifugal + weight - 2.0 * force * by_angle) / (2.0 * SWINGING),
        -GRAVITY - 2.0 * force * by_height / SLIDER_MASS,
    ]
}

/// Total energy in J, zero with rods and slider at z = 1 and z = 0; the dampers take from it.
pub(crate) fn energy([angle, height, swing, speed]: &[f64; 4]) -> f64 {
    let [length, ..] = spring(*angle, *height);
    0.5 * spinning(*angle)[0] * rate(*angle).powi(2)
        + SWINGING * swing * swing
        + 0.5 * SLIDER_MASS * speed * speed
        + SLIDER_MASS * GRAVITY * height
        - 2.0 * MOMENT * GRAVITY * angle.sin()
        + STIFFNESS * (length - RELAXED).powi(2)
}

/// Power that the dampers take in W.
pub(crate) fn dissipation([angle, height, swing, speed]: &[f64; 4]) -> f64 {
    let [_, by_angle, by_height] = spring(*angle, *height);
    2.0 * DAMPING * (by_angle * swing + by_height * speed).powi(2)
}

/// `[α, s, α̇, ṡ]` at `end` from `x` at `start`, in steps of at most 5e-5 s, and the energy lost on the way.
///
/// The dampers' time constant is about 1e-4 s.
pub(crate) fn motion(x: [f64; 4], (start, end): (f64, f64)) -> ([f64; 4], f64) {
    let steps = ((end - start) / 5e-5).ceil() as usize;
    let [angle, height, swing, speed, lost] = runge_kutta(
        |_, [angle, height, swing, speed, _]| {
            let x = [*angle, *height, *swing, *speed];
            let [a, b, c, d] = derivative(&x);
            [a, b, c, d, dissipation(&x)]
        },
        (start, end),
        steps,
        [x[0], x[1], x[2], x[3], 0.0],
    );
    ([angle, height, swing, speed], lost)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_are_relaxed_at_the_start() {
        assert!((spring(START[0], START[1])[0] - RELAXED).abs() < 1e-15);
        assert!((ROD_MASS - 0.3).abs() < 1e-15 && (SLIDER_MASS - 3.0).abs() < 1e-14);
    }

    #[test]
    fn moves_as_the_published_figure_shows() {
        let (mut x, mut lost, mut highest, mut lowest) = (START, 0.0, 0.0_f64, 1.0_f64);
        let mut printed = vec![];
        for k in 0..100 {
            let (next, loss) = motion(x, (0.1 * f64::from(k), 0.1 * f64::from(k + 1)));
            (x, lost) = (next, lost + loss);
            (highest, lowest) = (highest.max(x[1]), lowest.min(x[1]));
            if [0, 4, 9, 49, 99].contains(&k) {
                printed.push((0.1 * f64::from(k + 1), x[1]));
            }
        }
        println!(
            "governor: s at {printed:?}, lost {lost:e} J of {:e}",
            energy(&START)
        );
        assert!(
            (highest - 0.743).abs() < 2e-3 && lowest > 0.4985,
            "{highest} {lowest}"
        );
        assert!((x[1] - 0.62).abs() < 1e-2, "{}", x[1]);
        assert!((energy(&START) - energy(&x) - lost).abs() < 1e-8 * energy(&START));
    }
}
