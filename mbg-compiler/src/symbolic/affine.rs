//! Taking apart what is affine in a symbol.

use super::differentiate::Differentiator;
use super::expression::{Expression, Function, Operation, Symbol};
use super::pool::Pool;
use super::substitute::{Substitution, symbols, visit};

/// `(slope, rest)` with `expression = slope · symbol + rest`; none unless the slope is free of all symbols that are
/// `unknown` and no condition turns on the symbol, or if the rest divides by zero.
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
    // A function that jumps has the same slope on both sides.
    if symbols(pool, &conditions(pool, expression)).contains(&symbol) {
        return None;
    }
    let mut absent = Substitution::new();
    absent.set(symbol, Expression::ZERO);
    Some((slope, absent.apply(pool, expression)?))
}

/// What decides between the values of functions that jump.
fn conditions(pool: &Pool, expression: Expression) -> Vec<Expression> {
    let mut found = Vec::new();
    visit(pool, &[expression], |operation| match operation {
        Operation::Call(Function::Sign, arguments) => found.extend(arguments),
        Operation::Call(Function::SelectLess, arguments) => found.extend(&arguments[..2]),
        _ => {}
    });
    found
}
