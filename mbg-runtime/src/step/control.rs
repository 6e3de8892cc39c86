//! The length of steps that follow the error.

use crate::Real;
use crate::scalar::power;

/// Control of the length of the next step by the errors of this one and of the one before: steadily by proportion and
/// integral, or as the error per length goes on.
pub(super) struct Control {
    pub(super) length: f64,
    order: f64,
    exponent: f64,
    /// Weight of the step before.
    memory: f64,
    /// Logarithm of the error of the step before.
    before: f64,
    /// The length of the step before; none at the start.
    last: Option<f64>,
    after_rejection: bool,
}

impl Control {
    pub(super) fn new(order: u32, length: f64) -> Self {
        let order = f64::from(order);
        let memory = 0.2 / order;
        Self {
            length,
            order,
            exponent: 1.0 / order - 0.75 * memory,
            memory,
            before: LEAST,
            last: None,
            after_rejection: false,
        }
    }

    pub(super) fn accept(&mut self, length: f64, error: f64, steady: bool) {
        // Single precision is enough for a length, and takes half the time.
        let error = f64::from(Real::ln(error as f32));
        let exp = |exponent: f64| f64::from(Real::exp(exponent as f32));
        let needed = match self.last {
            _ if steady => exp(self.exponent * error - self.memory * self.before),
            Some(last) => {
                let root = exp(error / self.order);
                let trend = exp((error - self.before) / self.order) * last / length;
                root * if trend > 1.0 { trend } else { 1.0 }
            }
            None => exp(error / self.order),
        };
        let proposal = length / (needed / SAFETY).clamp(0.1, 5.0);
        self.length = if self.after_rejection {
            proposal.min(length)
        } else if steady && (1.0..=1.2).contains(&(proposal / length)) {
            length
        } else {
            proposal
        };
        self.before = error.max(LEAST);
        self.last = Some(length);
        self.after_rejection = false;
    }

    /// Takes back a step that has not been tried.
    pub(super) fn halve(&mut self, length: f64) {
        self.length = 0.5 * length;
        self.after_rejection = true;
    }

    pub(super) fn reject(&mut self, length: f64, error: f64) {
        let shorter = if error.is_finite() {
            (power(error, 1.0 / self.order) / SAFETY).min(5.0)
        } else {
            5.0
        };
        self.length = length / shorter;
        self.after_rejection = true;
    }
}

/// The next step is shorter than the error allows by this factor.
const SAFETY: f64 = 0.9;
/// Logarithm of 1e-4, the smallest error that is remembered.
const LEAST: f64 = -9.210_340_371_976_182;
