//! Taking apart what is affine in symbols.

use super::differentiate::Differentiator;
use super::expression::{Expression, Function, Operation, Symbol};
use super::matrix::Matrix;
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

/// `(A, b)` with `rows = A · symbols + b`; none unless A and b are free of the symbols.
#[must_use]
pub fn linear_part(
    pool: &mut Pool,
    rows: &[Expression],
    symbols: &[Symbol],
) -> Option<(Matrix, Vec<Expression>)> {
    let (mut entries, mut rests) = (Vec::new(), Vec::new());
    for row in rows {
        let mut rest = *row;
        for symbol in symbols {
            let (slope, without) = affine(pool, rest, *symbol, |it| symbols.contains(it))?;
            entries.push(slope);
            rest = without;
        }
        rests.push(rest);
    }
    Some((Matrix::new(rows.len(), symbols.len(), entries), rests))
}

/// What decides between the values of functions that jump.
fn conditions(pool: &Pool, expression: Expression) -> Vec<Expression> {
    let mut found = Vec::new();
    visit(pool, &[expression], |_, operation| match operation {
        Operation::Call(Function::Sign | Function::Fraction, arguments) => found.extend(arguments),
        Operation::Call(Function::SelectLess, arguments) => found.extend(&arguments[..2]),
        _ => {}
    });
    found
}
