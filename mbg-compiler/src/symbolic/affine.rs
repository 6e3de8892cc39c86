//! Taking apart what is affine in a symbol.

use super::differentiate::Differentiator;
use super::expression::{Expression, Symbol};
use super::pool::Pool;
use super::substitute::{Substitution, symbols};

/// `(slope, rest)` with `expression = slope · symbol + rest`; none unless the slope is free of all symbols that are
/// `unknown`, or if the rest divides by zero.
#[must_use]
pub fn affine(
    pool: &mut Pool,
    expression: Expression,
    symbol: Symbol,
    unknown: impl Fn(&Symbol) -> bool,
) -> Option<(Expression, Expression)> {
    let slope = Differentiator::new(symbol).derivative(pool, expression);
    if symbols(pool, &[slope]).iter().any(unknown) {
        return None;
    }
    let mut absent = Substitution::new();
    absent.set(symbol, Expression::ZERO);
    Some((slope, absent.apply(pool, expression)?))
}
