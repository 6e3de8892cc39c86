//! A crane: a trolley of mass `M` under a force `F`, a load of mass `m` on a rigid cable of length `l`.
//!
//! With the place `x` of the trolley and the angle `θ` of the cable from the downward vertical, positive towards `+x`,
//! the load is at `(x + l sin θ, −l cos θ)` and
//!
//! ```text
//! T = ½ (M + m) ẋ² + m l cos θ ẋ θ̇ + ½ m l² θ̇²        V = −m g l cos θ
//!
//! (M + m) ẍ + m l cos θ θ̈ = F + m l sin θ θ̇²
//!   m l cos θ ẍ +   m l² θ̈ = −m g l sin θ
//! ```
//! The determinant of the mass matrix is `m l² (M + m sin² θ)`, which never vanishes.

/// Trolley, cable and load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crane {
    /// Mass of the trolley in kg.
    pub(crate) trolley: f64,
    /// Mass of the load in kg.
    pub(crate) load: f64,
    /// Length of the cable in m.
    pub(crate) cable: f64,
    /// Gravity in m/s².
    pub(crate) gravity: f64,
}

impl Crane {
    /// `[ẋ, θ̇, ẍ, θ̈]` at `[x, θ, ẋ, θ̇]`.
    pub(crate) fn derivative(&self, [_, angle, speed, rate]: &[f64; 4], force: f64) -> [f64; 4] {
        let (sine, cosine) = angle.sin_cos();
        let pull = force + self.load * sine * (self.cable * rate * rate + self.gravity * cosine);
        let a = pull / (self.trolley + self.load * sine * sine);
        let alpha = -(self.gravity * sine + a * cosine) / self.cable;
        [*speed, *rate, a, alpha]
    }

    /// Total energy in J, zero at rest with the load in the height of the trolley.
    pub(crate) fn energy(&self, [_, angle, speed, rate]: &[f64; 4]) -> f64 {
        let (sine, cosine) = angle.sin_cos();
        let load =
            (speed + self.cable * cosine * rate).powi(2) + (self.cable * sine * rate).powi(2);
        0.5 * self.trolley * speed * speed + 0.5 * self.load * load
            - self.load * self.gravity * self.cable * cosine
    }
}

#[test]
fn force_does_the_work() {
    let crane = Crane {
        trolley: 3.0,
        load: 1.2,
        cable: 2.0,
        gravity: 9.81,
    };
    let start = [0.0, 0.8, -0.5, 1.0];
    let end = super::integrate::integrate(|_, x| crane.derivative(x, 4.0), (0.0, 3.0), 60, start);
    let work = 4.0 * (end[0] - start[0]);
    let gained = crane.energy(&end) - crane.energy(&start);
    assert!((gained - work).abs() < 1e-11, "{gained} {work}");
}
