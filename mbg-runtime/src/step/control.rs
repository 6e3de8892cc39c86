//! The length of steps that follow the error.

use crate::Real;
use crate::scalar::power;

/// How the length of the next step follows the errors of this one and of the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// By proportion and integral.
    Proportional,
    /// The same where the error falls; where it has grown it goes on growing as fast. A step up to a fifth longer is not
    /// worth the work.
    Steady,
    /// By the error alone where it falls; where it has grown it goes on growing as fast.
    Trend,
}

/// Control of the length of steps.
pub(super) struct Control {
    pub(super) length: f64,
    /// How many times longer the next step may be, whatever the error allows.
    pub(super) growth: f64,
    /// The error to this power is what the length is to be divided by.
    exponent: f64,
    /// Logarithm of the error of the step before.
    before: f64,
    /// The smallest error that is remembered, to that power.
    least: f64,
    /// What the length of the step before was to be divided by, and that length; none at the start.
    last: Option<(f64, f64)>,
    after_rejection: bool,
}

impl Control {
    pub(super) fn new(order: u32, length: f64) -> Self {
        let exponent = 1.0 / f64::from(order);
        Self {
            length,
            growth: f64::INFINITY,
            exponent,
            least: Real::exp(exponent * LEAST),
            before: LEAST,
            last: None,
            after_rejection: false,
        }
    }

    #[inline]
    pub(super) fn accept(&mut self, length: f64, error: f64, rule: Rule) {
        // Single precision is enough for a length, and takes half the time.
        let error = f64::from(Real::ln(error as f32));
        let power = |error: f64| f64::from(Real::exp((self.exponent * error) as f32));
        let proportional = |before| power(PROPORTION * error - MEMORY * before);
        let needed = match rule {
            Rule::Proportional => proportional(self.before),
            Rule::Trend => self.by_trend(length, power(error), power(error)),
            Rule::Steady => self.by_trend(length, power(error), proportional(self.before)),
        };
        let proposal = length * (SAFETY / needed).min(self.growth).clamp(0.2, 10.0);
        self.length = if self.after_rejection {
            proposal.min(length)
        } else if rule == Rule::Steady && (1.0..=1.2).contains(&(proposal / length)) {
            length
        } else {
            proposal
        };
        self.before = error.max(LEAST);
        self.after_rejection = false;
    }

    /// What the length is to be divided by: `otherwise`, or more where the error has grown and goes on growing as fast.
    fn by_trend(&mut self, length: f64, needed: f64, otherwise: f64) -> f64 {
        let (before, last) = self.last.unwrap_or((needed, length));
        let trend = needed * last / (before * length);
        self.last = Some((needed.max(self.least), length));
        if trend > 1.0 {
            otherwise.max(needed * trend)
        } else {
            otherwise
        }
    }

    /// Takes back a step that does not see enough, for one of this length.
    pub(super) fn shorten(&mut self, length: f64) {
        self.length = length;
        self.after_rejection = true;
    }

    pub(super) fn reject(&mut self, length: f64, error: f64) {
        let shorter = if error.is_finite() {
            (power(error, PROPORTION * self.exponent) / SAFETY).min(5.0)
        } else {
            5.0
        };
        self.length = length / shorter;
        self.after_rejection = true;
    }
}

/// The next step is shorter than the error allows by this factor.
const SAFETY: f64 = 0.9;
/// Parts of the error of this step and of the one before in steady control.
const PROPORTION: f64 = 0.85;
const MEMORY: f64 = 0.2;
/// Logarithm of 1e-4, the smallest error that is remembered.
const LEAST: f64 = -9.210_340_371_976_182;

#[cfg(test)]
mod tests {
    use super::*;

    /// The length behind two steps of length 1 with these errors, at order 4.
    fn next(rule: Rule, errors: [f64; 2]) -> f64 {
        let mut control = Control::new(4, 1.0);
        for error in errors {
            control.accept(1.0, error, rule);
        }
        control.length
    }

    #[test]
    fn the_trend_of_the_error_goes_on_only_where_it_grows() {
        let allowed = |error| SAFETY / power(error, 0.25);
        let assert_next = |errors, expected: f64| {
            let found = next(Rule::Trend, errors);
            assert!(
                (found - expected).abs() < 1e-6 * expected,
                "{errors:?}: {found}"
            );
        };
        assert_next([1e-2, 1e-2], allowed(1e-2));
        assert_next([1e-1, 1e-2], allowed(1e-2));
        // Ten times the error counts as ten times more to come.
        assert_next([1e-2, 1e-1], allowed(1.0));
    }

    #[test]
    fn steady_steps_keep_their_length_over_a_small_gain() {
        let errors = [0.2, 0.3];
        let gain = next(Rule::Proportional, errors);
        assert!(gain > 1.0 && gain < 1.2, "{gain}");
        assert_eq!(next(Rule::Steady, errors), 1.0);
        let errors = [0.2, 1e-3];
        assert!(next(Rule::Proportional, errors) > 1.2);
        assert_eq!(next(Rule::Steady, errors), next(Rule::Proportional, errors));
    }

    #[test]
    fn steady_steps_heed_an_error_that_grows() {
        let errors = [1e-2, 0.5];
        assert_eq!(next(Rule::Steady, errors), next(Rule::Trend, errors));
        assert!(next(Rule::Steady, errors) < 0.7 * next(Rule::Proportional, errors));
    }

    #[test]
    fn no_step_grows_beyond_what_the_method_allows() {
        let mut control = Control::new(4, 1.0);
        control.growth = 1.5;
        control.accept(1.0, 1e-6, Rule::Steady);
        assert_eq!(control.length, 1.5);
    }

    #[test]
    fn no_step_grows_behind_a_rejection() {
        let mut control = Control::new(4, 1.0);
        control.reject(1.0, f64::NAN);
        assert_eq!(control.length, 0.2);
        control.accept(0.2, 1e-6, Rule::Trend);
        assert_eq!(control.length, 0.2);
        control.accept(0.2, 1e-6, Rule::Trend);
        assert!(control.length > 1.0);
    }
}
