//! What generated code refers to by absolute path. No part of the public interface.

pub use core;
pub use nalgebra::{SMatrix, SVector};

pub use crate::solve::ITERATIONS;
pub use crate::{
    Bond, Meta, Operations, ParameterError, Power, Real, Stroke, System, Trouble, Variable,
};

/// What the chosen causality relies on; each condition implies that the value is finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Neither infinite nor NaN.
    Finite,
    /// Finite and not zero, where the value is divided by.
    NonZero,
    /// Finite and larger than zero.
    Positive,
}

/// Checks a parameter, or an expression of parameters, in every lane.
pub fn check<T: Real>(
    name: &'static str,
    value: T,
    condition: Condition,
    reason: &'static str,
) -> Result<(), ParameterError> {
    let fails = |lane: f64| match condition {
        Condition::Finite => !lane.is_finite(),
        Condition::NonZero => !lane.is_finite() || lane == 0.0,
        Condition::Positive => !lane.is_finite() || lane <= 0.0,
    };
    match value.find(fails) {
        Some(value) => Err(ParameterError {
            name,
            value,
            reason,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions() {
        let passes = |value: f64| {
            [Condition::Finite, Condition::NonZero, Condition::Positive]
                .map(|it| check("r", value, it, "").is_ok())
        };
        assert_eq!(passes(1.0), [true, true, true]);
        assert_eq!(passes(-1.0), [true, true, false]);
        assert_eq!(passes(0.0), [true, false, false]);
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(passes(value), [false, false, false]);
        }
    }

    #[test]
    fn error_names_the_parameter_its_value_and_the_reason() {
        let error = check(
            "mass",
            -2.0_f32,
            Condition::Positive,
            "an inertia must be positive",
        )
        .unwrap_err();
        assert_eq!(
            std::format!("{error}"),
            "`mass` is -2e0: an inertia must be positive"
        );
    }
}
