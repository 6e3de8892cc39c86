//! Two flywheels on one gearbox.
//!
//! With `ω₂ = r ω₁` the kinetic energy is `T = ½ (J₁ + r² J₂) ω₁²`, the power of the torques and of the bearings
//! `(τ₁ + r τ₂) ω₁ − (b₁ + r² b₂) ω₁²`, so
//!
//! ```text
//! (J₁ + r² J₂) ω̇₁ = τ₁ + r τ₂ − (b₁ + r² b₂) ω₁
//! ```
//! and `ω₁` approaches `(τ₁ + r τ₂) / (b₁ + r² b₂)` exponentially.

/// Flywheels, gearbox and bearings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flywheels {
    /// Inertias in kg m².
    pub(crate) inertia: [f64; 2],
    /// Damping of the bearings in N m s/rad.
    pub(crate) damping: [f64; 2],
    /// `ω₂ / ω₁`.
    pub(crate) ratio: f64,
}

impl Flywheels {
    /// Inertia seen from the first flywheel.
    pub(crate) fn inertia_seen(&self) -> f64 {
        self.inertia[0] + self.ratio * self.ratio * self.inertia[1]
    }

    fn damping_seen(&self) -> f64 {
        self.damping[0] + self.ratio * self.ratio * self.damping[1]
    }

    /// `ω̇₁` in rad/s².
    pub(crate) fn acceleration(&self, omega: f64, torque: [f64; 2]) -> f64 {
        (torque[0] + self.ratio * torque[1] - self.damping_seen() * omega) / self.inertia_seen()
    }

    /// `ω₁` at time `t` under constant torques, from `omega` at time 0.
    pub(crate) fn omega(&self, omega: f64, torque: [f64; 2], t: f64) -> f64 {
        let last = (torque[0] + self.ratio * torque[1]) / self.damping_seen();
        last + (omega - last) * (-self.damping_seen() / self.inertia_seen() * t).exp()
    }
}

#[test]
fn closed_form_solves_the_equation() {
    let flywheels = Flywheels {
        inertia: [2.0, 0.3],
        damping: [0.4, 0.1],
        ratio: -3.0,
    };
    let torque = [5.0, -1.0];
    let [omega] = super::integrate::integrate(
        |_, [omega]| [flywheels.acceleration(*omega, torque)],
        (0.0, 2.0),
        10,
        [1.5],
    );
    assert!((omega - flywheels.omega(1.5, torque, 2.0)).abs() < 1e-13);
}
