//! Two uniform rods in a plane, 1 kg and 1 m each, on pins without friction.
//!
//! Absolute angles `θ₁`, `θ₂` from the downward vertical. With `d = θ₁ − θ₂`, `m` and `l` of both rods and
//! `T = ½ (4/3) m l² θ̇₁² + ½ (1/3) m l² θ̇₂² + ½ m l² cos d θ̇₁ θ̇₂`,
//! `V = −(3/2) m g l cos θ₁ − ½ m g l cos θ₂`:
//!
//! ```text
//! (4/3) θ̈₁ + ½ cos d θ̈₂ + ½ sin d θ̇₂² + (3/2) (g/l) sin θ₁ = 0
//! (1/3) θ̈₂ + ½ cos d θ̈₁ − ½ sin d θ̇₁² +   ½  (g/l) sin θ₂ = 0
//! ```
//! The motion is chaotic: errors grow by a factor of about 1e15 in the ten seconds.

use std::f64::consts::FRAC_PI_2;

/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.81;
/// `[θ₁, θ₂, θ̇₁, θ̇₂]` at the start.
pub(crate) const START: [f64; 4] = [FRAC_PI_2, FRAC_PI_2 + 0.1, 0.0, 0.0];
/// Time in s, then `[θ₁, θ₂, θ̇₁, θ̇₂]`: extrapolation in 34 digits, good to all digits here (the last row to 2.7e-15).
pub(crate) const REFERENCE: [(f64, [f64; 4]); 7] = [
    (
        0.25,
        [
            1.2030440170886854,
            1.736040444800662,
            -2.688950474079394,
            -0.12959041175159294,
        ],
    ),
    (
        0.5,
        [
            0.472843616856967,
            1.06228077076131,
            -2.31790724381266,
            -6.205546883116014,
        ],
    ),
    (
        1.0,
        [
            -1.2227184813349268,
            -0.7809835101114824,
            -3.3847495607791878,
            -0.8134464087292044,
        ],
    ),
    (
        2.0,
        [
            -0.022931962458306383,
            0.2847513017030851,
            -2.1424547968829506,
            13.573223559426962,
        ],
    ),
    (
        3.0,
        [
            1.041133959009684,
            0.9914342038897637,
            -3.463921444008628,
            -1.3369496642352605,
        ],
    ),
    (
        5.0,
        [
            1.2125285328715913,
            1.1021901326099746,
            4.672294109849525,
            -4.0692004329682225,
        ],
    ),
    (
        10.0,
        [
            0.29938102613156276,
            -3.2046871099229746,
            -3.8216863111175137,
            -0.04606471343066789,
        ],
    ),
];

/// `[θ̇₁, θ̇₂, θ̈₁, θ̈₂]`.
pub(crate) fn derivative([first, second, v, w]: &[f64; 4]) -> [f64; 4] {
    let (sine, cosine) = (first - second).sin_cos();
    let a = -0.5 * sine * w * w - 1.5 * GRAVITY * first.sin();
    let b = 0.5 * sine * v * v - 0.5 * GRAVITY * second.sin();
    let determinant = 4.0 / 9.0 - 0.25 * cosine * cosine;
    [
        *v,
        *w,
        (a / 3.0 - 0.5 * cosine * b) / determinant,
        (4.0 / 3.0 * b - 0.5 * cosine * a) / determinant,
    ]
}

/// Total energy in J, zero at rest with both rods horizontal.
pub(crate) fn energy([first, second, v, w]: &[f64; 4]) -> f64 {
    2.0 / 3.0 * v * v + w * w / 6.0 + 0.5 * (first - second).cos() * v * w
        - GRAVITY * (1.5 * first.cos() + 0.5 * second.cos())
}

#[cfg(test)]
mod tests {
    use super::super::integrate::integrate;
    use super::*;
    use crate::references::cart::Cart;

    #[test]
    fn equations_give_the_reference() {
        let (mut time, mut x) = (0.0, START);
        for (next, expected) in REFERENCE {
            x = integrate(
                |_, x| derivative(x),
                (time, next),
                ((next - time) * 200.0) as usize,
                x,
            );
            time = next;
            if time <= 5.0 {
                for (x, expected) in x.iter().zip(expected) {
                    assert!((x - expected).abs() < 1e-9, "{time} {x} {expected}");
                }
            }
        }
        assert!((energy(&x) - energy(&START)).abs() < 1e-11);
    }

    #[test]
    fn it_is_a_cart_that_stands() {
        let [first, second, v, w] = [0.3, -1.1, 0.7, 2.0];
        let cart = Cart::uniform(f64::INFINITY, 2).accelerations(&[first, second], &[v, w], 0.0);
        let [_, _, a, b] = derivative(&[first, second, v, w]);
        assert!((cart[1] - a).abs() < 1e-13 && (cart[2] - b).abs() < 1e-13);
    }
}
