//! The compass walker of Goswami, Thuilot and Espiau, *A study of the passive gait of a compass-like biped robot: symmetry
//! and chaos*, Int. J. Robotics Research 17 (1998), 1282–1301, by hand.
//!
//! Two legs of length `l = a + b` carry `m` at `a` above the foot, and `M` at the hip. With the angles `s` of the leg on the
//! ground and `w` of the other one against the normal of a slope `φ`, counted towards its top,
//!
//! ```text
//! T = ½ (m a² + (M + m) l²) ṡ² − m l b cos(s − w) ṡ ẇ + ½ m b² ẇ²
//! V = (m a + (M + m) l) g cos(s − φ) − m b g cos(w − φ)
//! ```
//!
//! The foot strikes where `s + w = 0`. It stays, and the other one is let go: what meets the walker there is an impulse at
//! the foot that strikes, so that the angular momentum of all about that foot goes on, and that of the leg that is let go
//! about the hip. Slope 3°, `m = 5 kg`, `M = 10 kg`, `a = b = 0.5 m`: there the paper finds a period of 0.734 s and steps of
//! 0.535 m.

use nalgebra::{Matrix2, Vector2};

use super::integrate::integrate;

/// Of the slope, in rad.
pub(crate) const SLOPE: f64 = 3.0 / 180.0 * std::f64::consts::PI;
/// In m/s².
const GRAVITY: f64 = 9.81;
/// Masses of a leg and at the hip in kg.
const MASS: [f64; 2] = [5.0, 10.0];
/// From the foot to the mass of a leg, and on to the hip, in m.
const LENGTH: [f64; 2] = [0.5, 0.5];
/// Length of a step of the search for a strike in s.
const STEP: f64 = 0.02;

/// `[ṡ, ẇ, s̈, ẅ]` at `[s, w, ṡ, ẇ]`.
fn derivative([s, w, s_rate, w_rate]: &[f64; 4]) -> [f64; 4] {
    let ([m, hip], [a, b]) = (MASS, LENGTH);
    let l = a + b;
    let (sine, cosine) = (s - w).sin_cos();
    let coupling = m * l * b;
    let inertia = Matrix2::new(
        m * a * a + (hip + m) * l * l,
        -coupling * cosine,
        -coupling * cosine,
        m * b * b,
    );
    let weight = Vector2::new(
        (m * a + (hip + m) * l) * GRAVITY * (s - SLOPE).sin(),
        -m * b * GRAVITY * (w - SLOPE).sin(),
    );
    let centrifugal = coupling * sine * Vector2::new(w_rate * w_rate, -s_rate * s_rate);
    let rates = inertia.try_inverse().unwrap() * (weight + centrifugal);
    [*s_rate, *w_rate, rates.x, rates.y]
}

/// Energy of the motion in J.
pub(crate) fn kinetic([s, w, s_rate, w_rate]: &[f64; 4]) -> f64 {
    let ([m, hip], [a, b]) = (MASS, LENGTH);
    let l = a + b;
    0.5 * (m * a * a + (hip + m) * l * l) * s_rate * s_rate
        - m * l * b * (s - w).cos() * s_rate * w_rate
        + 0.5 * m * b * b * w_rate * w_rate
}

/// Energy of gravity in J, with heights above the foot on the ground.
fn potential([s, w, ..]: &[f64; 4]) -> f64 {
    let ([m, hip], [a, b]) = (MASS, LENGTH);
    let l = a + b;
    (m * a + (hip + m) * l) * GRAVITY * (s - SLOPE).cos() - m * b * GRAVITY * (w - SLOPE).cos()
}

/// From the foot of a leg to its hip, of length one, and how it changes with the angle.
fn along(angle: f64) -> [Vector2<f64>; 2] {
    let (sine, cosine) = angle.sin_cos();
    [Vector2::new(-sine, cosine), Vector2::new(-cosine, -sine)]
}

/// The angles and rates behind a strike, with the legs in exchanged roles.
pub(crate) fn strike([s, w, s_rate, w_rate]: [f64; 4]) -> [f64; 4] {
    let ([m, hip], [a, b]) = (MASS, LENGTH);
    let l = a + b;
    let ([old, old_turning], [new, new_turning]) = (along(s), along(w));
    // Seen from the hip.
    let (old_mass, new_mass, foot) = (-b * old, -b * new, -l * new);
    // Of all about the foot that strikes, and of the leg that stood about the hip: by velocities of the hip and of both legs.
    let momenta = |top: Vector2<f64>, stood: Vector2<f64>, struck: Vector2<f64>| {
        let about_foot = m * (old_mass - foot).perp(&stood) + m * (new_mass - foot).perp(&struck)
            - hip * foot.perp(&top);
        Vector2::new(about_foot, m * old_mass.perp(&stood))
    };
    let top = l * s_rate * old_turning;
    let before = momenta(
        top,
        a * s_rate * old_turning,
        top - b * w_rate * new_turning,
    );
    let after = |new_rate: f64, old_rate: f64| {
        let top = l * new_rate * new_turning;
        momenta(
            top,
            top - b * old_rate * old_turning,
            a * new_rate * new_turning,
        )
    };
    let by_rates = Matrix2::from_columns(&[after(1.0, 0.0), after(0.0, 1.0)]);
    let rates = by_rates.try_inverse().unwrap() * before;
    [w, s, rates.x, rates.y]
}

/// The state this long after a start.
pub(crate) fn at(time: f64, start: [f64; 4]) -> [f64; 4] {
    let steps = (time / STEP).ceil().max(1.0) as usize;
    integrate(|_, x| derivative(x), (0.0, time), steps, start)
}

/// When the foot in the air strikes, and the state there.
pub(crate) fn swing(start: [f64; 4]) -> (f64, [f64; 4]) {
    let ahead = |time, x| integrate(|_, x| derivative(x), (0.0, time), 1, x);
    let strikes = |[s, w, ..]: &[f64; 4]| s < w && s + w <= 0.0;
    let (mut time, mut state) = (0.0, start);
    while !strikes(&ahead(STEP, state)) {
        state = ahead(STEP, state);
        time += STEP;
        assert!(time < 2.0, "the walker falls");
    }
    let (mut early, mut late) = (0.0, STEP);
    for _ in 0..60 {
        let middle = 0.5 * (early + late);
        if strikes(&ahead(middle, state)) {
            late = middle;
        } else {
            early = middle;
        }
    }
    (time + late, ahead(late, state))
}

/// The period of the gait that others come to, and the state at its start.
pub(crate) fn cycle() -> (f64, [f64; 4]) {
    let mut start = [0.271, -0.271, -1.092, -0.377];
    for _ in 0..60 {
        start = strike(swing(start).1);
    }
    (swing(start).0, start)
}

/// From foot to foot in m.
pub(crate) fn stride([s, ..]: &[f64; 4]) -> f64 {
    2.0 * (LENGTH[0] + LENGTH[1]) * s.sin().abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gait_is_the_published_one() {
        let (period, start) = cycle();
        assert!((period - 0.734).abs() < 5e-4, "{period}");
        assert!((stride(&start) - 0.535).abs() < 5e-4, "{}", stride(&start));
    }

    /// A strike takes what the walker comes down by in a step, and nothing else changes its energy.
    #[test]
    fn strikes_take_what_the_slope_gives() {
        let (_, start) = cycle();
        let end = swing(start).1;
        let energy = |x: &[f64; 4]| kinetic(x) + potential(x);
        assert!((energy(&end) - energy(&start)).abs() < 1e-10);
        let down = (2.0 * MASS[0] + MASS[1]) * GRAVITY * stride(&start) * SLOPE.sin();
        let taken = kinetic(&end) - kinetic(&strike(end));
        assert!((taken - down).abs() < 1e-9, "{taken} {down}");
    }
}
