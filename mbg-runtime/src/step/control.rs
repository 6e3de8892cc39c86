//! The length of the next step from the error of the last one.
//!
//! E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993, section
//! II.4; the proportional–integral form and its constants as in their code DOPRI5, and section IV.2 of volume II.

use crate::scalar::power;

/// Proportional–integral control of an error whose norm is 1 at the tolerance, for a method of order 5.
#[derive(Clone, Copy, Debug)]
pub(super) struct Controller {
    /// Norm of the error of the last accepted step.
    last: f64,
    /// Whether the last attempt was refused: the next step must not be longer then.
    refused: bool,
}

impl Controller {
    const INTEGRAL: f64 = 0.04;
    const PROPORTIONAL: f64 = 0.2 - 0.75 * Self::INTEGRAL;
    const SAFETY: f64 = 0.9;
    const SHRINK: f64 = 0.2;
    const GROW: f64 = 10.0;
    const LEAST: f64 = 1e-4;

    pub(super) fn new() -> Self {
        Self { last: Self::LEAST, refused: false }
    }

    /// The next step after one of length `h` whose error passed.
    pub(super) fn accept(&mut self, h: f64, error: f64) -> f64 {
        let smoothed = power(error, Self::PROPORTIONAL) / power(self.last, Self::INTEGRAL);
        let factor = (Self::SAFETY / smoothed).clamp(Self::SHRINK, Self::GROW);
        let next = if self.refused { h * factor.min(1.0) } else { h * factor };
        self.last = error.max(Self::LEAST);
        self.refused = false;
        next
    }

    /// The next attempt after one of length `h` whose error, perhaps NaN or infinite, did not pass.
    pub(super) fn refuse(&mut self, h: f64, error: f64) -> f64 {
        self.refused = true;
        let factor = Self::SAFETY / power(error, Self::PROPORTIONAL);
        if factor > Self::SHRINK { h * factor } else { h * Self::SHRINK }
    }
}

/// The first step from the norms, in units of the tolerance, of the state and its slope.
pub(super) fn first_guess(state: f64, slope: f64) -> f64 {
    if state < 1e-5 || slope < 1e-5 || !slope.is_finite() { 1e-6 } else { 0.01 * state / slope }
}

/// The first step from its first guess and the norms of slope and curvature.
pub(super) fn first_step(guess: f64, slope: f64, curvature: f64) -> f64 {
    let largest = slope.max(curvature);
    let step = if largest <= 1e-15 { (guess * 1e-3).max(1e-6) } else { power(0.01 / largest, 0.2) };
    step.min(100.0 * guess)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_grow_and_shrink_within_limits() {
        let mut control = Controller::new();
        assert_eq!(control.accept(1.0, 0.0), 10.0);
        assert!((control.accept(1.0, 1.0) - 0.9 * 1e-4_f64.powf(0.04)).abs() < 1e-12);
        assert_eq!(control.refuse(1.0, 1e9), 0.2);
        assert_eq!(control.accept(1.0, 0.0), 1.0);
        assert_eq!(control.accept(1.0, 0.0), 10.0);
    }

    #[test]
    fn a_step_that_went_out_of_bounds_is_shortened_as_far_as_it_goes() {
        let mut control = Controller::new();
        assert_eq!(control.refuse(1.0, f64::NAN), 0.2);
        assert_eq!(control.refuse(1.0, f64::INFINITY), 0.2);
    }

    #[test]
    fn first_step_of_a_system_at_rest_is_short() {
        assert_eq!(first_step(first_guess(0.0, 0.0), 0.0, 0.0), 1e-6);
        assert!(first_step(first_guess(1e3, 1e3), 1e3, 1e3) <= 1.0);
    }
}
