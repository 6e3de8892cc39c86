//! Stage 5e, changes: the times at which a choice by time alone changes, as in `if t < start { 0.0 } else { 2.0 }`.

use crate::symbolic::choices::choice_of;
use crate::symbolic::substitute::{replace, symbols, visit};
use crate::symbolic::{Expression, Pool, Symbol, affine};

/// Most branches of choices within a condition that are tried.
const MOST: usize = 64;

/// Times, in terms of parameters, at which steps of integration end.
///
/// A choice by more than time, or by a wave of it, has none. Of a condition that is made of choices, such as that of
/// `min(max(t, 0.0), 1.0)`, each branch counts.
pub fn of(pool: &mut Pool, rates: &[Expression]) -> Vec<Expression> {
    let mut times = Vec::new();
    for (_, [a, b, ..]) in choices(pool, rates) {
        let difference = pool.subtract(a, b);
        let read = symbols(pool, &[difference]);
        let is_fixed = |it: &Symbol| matches!(it, Symbol::Time | Symbol::Parameter(_));
        if read.contains(&Symbol::Time) && read.iter().all(is_fixed) {
            zeros(pool, difference, &mut { MOST }, &mut times);
        }
    }
    times
}

/// What each choice in some expressions is, and what it is between.
fn choices(pool: &Pool, expressions: &[Expression]) -> Vec<(Expression, [Expression; 4])> {
    let mut found = Vec::new();
    visit(pool, expressions, |part, operation| {
        found.extend(choice_of(operation).map(|choice| (part, choice)));
    });
    found
}

/// Adds the times at which an expression of time and parameters is zero, if each of its branches is a line.
fn zeros(pool: &mut Pool, expression: Expression, left: &mut usize, times: &mut Vec<Expression>) {
    if *left == 0 {
        return;
    }
    *left -= 1;
    if let Some((part, [_, _, c, d])) = choices(pool, &[expression]).first().copied() {
        for branch in [c, d] {
            if let Some(chosen) = replace(pool, expression, &[(part, branch)]) {
                zeros(pool, chosen, left, times);
            }
        }
        return;
    }
    let is_time = |symbol: &Symbol| *symbol == Symbol::Time;
    let Some((slope, rest)) = affine(pool, expression, Symbol::Time, is_time) else {
        return;
    };
    let time = pool.divide(rest.negated(), slope);
    if let Some(time) = time.filter(|time| !times.contains(time)) {
        times.push(time);
    }
}
