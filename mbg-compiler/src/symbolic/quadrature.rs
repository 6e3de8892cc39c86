//! Energy of a storage whose law is given as effort or flow: `∫₀¹ y(a + s (x − a))·(x − a) ds`, along the ray from a state `a`.

use std::ops::Range;

use super::expression::{Expression, Operation, Symbol};
use super::pool::Pool;
use super::substitute::Substitution;

/// Nodes for laws that are no polynomials; exact to degree 31, and to round-off for smooth laws in a moderate range.
const NODES: usize = 16;

/// The energy by Gauss–Legendre quadrature; exact when the law is a polynomial, with just as many nodes as it needs; none if the law
/// divides by zero on the ray.
pub(crate) fn energy(
    pool: &mut Pool,
    states: &Range<usize>,
    law: &[Expression],
    start: &[Expression],
) -> Option<Expression> {
    let way = |pool: &mut Pool, state: usize| {
        let symbol = pool.symbol(Symbol::State(state));
        pool.subtract(symbol, start[state - states.start])
    };
    let degree = largest_degree(pool, states, law);
    let count = degree.map_or(NODES, |degree| (degree as usize / 2 + 1).min(NODES));
    let mut total = Expression::ZERO;
    for (node, weight) in gauss_legendre(count) {
        let (node, weight) = (exact(pool, node)?, exact(pool, weight)?);
        let mut substitution = Substitution::new();
        for (state, start) in states.clone().zip(start) {
            let way = way(pool, state);
            let scaled = pool.multiply(node, way);
            let place = pool.add(scaled, *start);
            substitution.set(Symbol::State(state), place);
        }
        for (row, state) in law.iter().zip(states.clone()) {
            let value = substitution.apply(pool, *row)?;
            let way = way(pool, state);
            let product = pool.multiply(value, way);
            let term = pool.multiply(weight, product);
            total = pool.add(total, term);
        }
    }
    Some(total)
}

/// Whether the quadrature has no error but that of rounding.
pub(crate) fn is_exact(pool: &Pool, states: &Range<usize>, law: &[Expression]) -> bool {
    largest_degree(pool, states, law).is_some_and(|degree| (degree as usize) < 2 * NODES - 1)
}

/// The largest degree, if all rows are polynomials.
fn largest_degree(pool: &Pool, states: &Range<usize>, law: &[Expression]) -> Option<u32> {
    let mut degrees = law.iter().map(|row| degree(pool, *row, states));
    degrees.try_fold(0, |a, b| b.map(|b| a.max(b)))
}

fn exact(pool: &mut Pool, value: f64) -> Option<Expression> {
    let doubled = value * 2.0;
    if doubled.fract() == 0.0 {
        let (numerator, two) = (pool.integer(doubled as i64), pool.integer(2));
        return pool.divide(numerator, two);
    }
    Some(pool.irrational(value))
}

/// Degree as a polynomial in the states, if it is one.
fn degree(pool: &Pool, expression: Expression, states: &Range<usize>) -> Option<u32> {
    Some(match pool.operation(expression) {
        Operation::Constant(_) => 0,
        Operation::Symbol(Symbol::State(state)) if states.contains(state) => 1,
        Operation::Symbol(_) => 0,
        Operation::Add(a, b) => degree(pool, *a, states)?.max(degree(pool, *b, states)?),
        Operation::Multiply(a, b) => degree(pool, *a, states)? + degree(pool, *b, states)?,
        Operation::Divide(a, b) if degree(pool, *b, states) == Some(0) => degree(pool, *a, states)?,
        operation => {
            let constant = operation
                .operands()
                .iter()
                .all(|part| degree(pool, *part, states) == Some(0));
            return constant.then_some(0);
        }
    })
}

/// Nodes and weights on [0, 1], by Newton's method on the Legendre polynomial.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let order = count as f64;
    let pair = |index: usize| {
        let mut x = (std::f64::consts::PI * (index as f64 + 0.75) / (order + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..64 {
            let (mut previous, mut current) = (1.0, x);
            for k in 2..=count {
                let k = k as f64;
                (previous, current) = (
                    current,
                    ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k,
                );
            }
            slope = order * (x * current - previous) / (x * x - 1.0);
            x -= current / slope;
        }
        ((1.0 - x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    if count == 1 {
        vec![(0.5, 1.0)]
    } else {
        (0..count).map(pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_integrates_polynomials() {
        for count in 1..=NODES {
            let nodes = gauss_legendre(count);
            let integral: f64 = nodes
                .iter()
                .map(|(x, w)| w * x.powi(2 * count as i32 - 1))
                .sum();
            assert!(
                (integral - 1.0 / (2 * count) as f64).abs() < 1e-14,
                "{count}: {integral}"
            );
        }
    }
}
