//! The length of steps that follow the error.

use crate::Real;

/// How the length of the next step follows the errors of this one and of the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// By proportion and integral. Where nothing drives the model, an error that has grown goes on growing as fast.
    Proportional,
    /// The same, whatever drives the model. A step up to a fifth longer is not worth the work.
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
    /// The length of the step before; zero at the start.
    last: f64,
    /// Whether nothing but the state drives the model.
    left_alone: bool,
    after_rejection: bool,
}

impl Control {
    pub(super) fn new(order: u32, length: f64, left_alone: bool) -> Self {
        Self {
            length,
            growth: f64::INFINITY,
            exponent: 1.0 / f64::from(order),
            before: LEAST,
            last: 0.0,
            left_alone,
            after_rejection: false,
        }
    }

    #[inline]
    pub(super) fn accept(&mut self, length: f64, error: f64, rule: Rule) {
        // Single precision is enough for a length, and takes half the time.
        let ln = |number: f64| f64::from(Real::ln(number as f32));
        let last = core::mem::replace(&mut self.last, length);
        let error = ln(error);
        let falling = match rule {
            Rule::Proportional | Rule::Steady => PROPORTION * error - MEMORY * self.before,
            Rule::Trend => error,
        };
        let mut needed = self.exponent * falling;
        if rule != Rule::Proportional || self.left_alone {
            // As much more again as from the step before to this one, apart from what its length explains.
            let growing = 2.0 * error - self.before;
            needed = needed.max(self.exponent * growing + ln(last / length));
        }
        let needed = f64::from(Real::exp(needed as f32));
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

    /// Takes back a step that does not see enough, for one of this length.
    pub(super) fn shorten(&mut self, length: f64) {
        self.length = length;
        self.after_rejection = true;
    }

    pub(super) fn reject(&mut self, length: f64, error: f64) {
        let shorter = if error.is_finite() {
            (Real::pow(error, PROPORTION * self.exponent) / SAFETY).min(5.0)
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

    /// The length behind two steps of length 1 with these errors, at order 4, of a model that is driven.
    fn next(rule: Rule, errors: [f64; 2]) -> f64 {
        behind(Control::new(4, 1.0, false), rule, errors)
    }

    fn behind(mut control: Control, rule: Rule, errors: [f64; 2]) -> f64 {
        for error in errors {
            control.accept(1.0, error, rule);
        }
        control.length
    }

    #[test]
    fn the_trend_of_the_error_goes_on_only_where_it_grows() {
        let allowed = |error| SAFETY / Real::pow(error, 0.25);
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
    fn steps_heed_an_error_that_grows_unless_something_drives_the_model() {
        let errors = [1e-2, 0.5];
        let trend = next(Rule::Trend, errors);
        assert!(trend < 0.7 * SAFETY / Real::pow(errors[1], 0.25));
        assert_eq!(next(Rule::Steady, errors), trend);
        assert!(next(Rule::Proportional, errors) > 1.4 * trend);
        let alone = Control::new(4, 1.0, true);
        assert_eq!(behind(alone, Rule::Proportional, errors), trend);
    }

    #[test]
    fn no_step_grows_beyond_what_the_method_allows() {
        let mut control = Control::new(4, 1.0, false);
        control.growth = 1.5;
        control.accept(1.0, 1e-6, Rule::Steady);
        assert_eq!(control.length, 1.5);
    }

    #[test]
    fn no_step_grows_behind_a_rejection() {
        let mut control = Control::new(4, 1.0, false);
        control.reject(1.0, f64::NAN);
        assert_eq!(control.length, 0.2);
        control.accept(0.2, 1e-6, Rule::Trend);
        assert_eq!(control.length, 0.2);
        control.accept(0.2, 1e-6, Rule::Trend);
        assert!(control.length > 1.0);
    }
}
