//! Derivatives of products that are flat at rest although a factor is infinitely steep there: friction `f |f|^0.75`, drag
//! `f √(fᵀ f)`.

use std::collections::BTreeMap;

use super::expression::{Expression, Function, Operation, Rate};
use super::pool::Pool;
use super::walk::Rewritten;

/// The least that a power is divided by: small enough to change nothing else, and a normal number in single precision.
const LEAST: &str = "1e-37";

/// Most terms of a sum that is looked at.
const MOST: usize = 16;

/// The orders by which a product vanishes with each of the factors that vary.
type Orders = BTreeMap<Expression, f64>;

/// The derivative of a product, or of a power alone, that holds a power `s^p` whose own derivative is infinite at `s = 0` where
/// that of the whole is zero. It has `p s^p / max(s, 10⁻³⁷)`, which is zero at zero, in the place of `p s^(p − 1)`. None if
/// there is no such power.
pub(super) fn at_rest(pool: &mut Pool, known: &Rewritten, whole: Expression) -> Option<Expression> {
    let factors = pool.factors(whole);
    let bases = factors.iter().map(|it| steep_base(pool, known, *it));
    let mut bases: Vec<Option<Expression>> = bases.collect();
    if bases.iter().all(Option::is_none) {
        return None;
    }
    let orders = orders(pool, whole);
    for base in &mut bases {
        *base = base.filter(|base| is_flat(pool, *base, &orders));
    }
    if bases.iter().all(Option::is_none) {
        return None;
    }
    let mut slope = Expression::ZERO;
    for (index, (factor, base)) in factors.iter().zip(&bases).enumerate() {
        let mut term = match base {
            Some(base) => {
                let outer = guarded(pool, *factor, *base)?;
                pool.multiply(outer, known.get(*base)?)
            }
            None => known.get(*factor)?,
        };
        for (other, factor) in factors.iter().enumerate() {
            if other != index {
                term = pool.multiply(term, *factor);
            }
        }
        slope = pool.add(slope, term);
    }
    Some(slope)
}

/// The base of a power that may be infinitely steep where its value is not infinite.
fn steep_base(pool: &Pool, known: &Rewritten, power: Expression) -> Option<Expression> {
    let (base, is_steep) = match pool.operation(power) {
        Operation::Call(Function::Sqrt, arguments) => (arguments[0], true),
        Operation::Call(Function::Pow, arguments) => {
            let constant = pool.constant_value(arguments[1]);
            let is_steep = constant.is_none_or(|it| 0.0 < it && it < 1.0);
            (
                arguments[0],
                is_steep && known.get(arguments[1])? == Expression::ZERO,
            )
        }
        _ => return None,
    };
    (is_steep && known.get(base)? != Expression::ZERO).then_some(base)
}

/// `p s^p / max(s, 10⁻³⁷)`.
fn guarded(pool: &mut Pool, power: Expression, base: Expression) -> Option<Expression> {
    let exponent = match pool.operation(power) {
        Operation::Call(Function::Pow, arguments) => arguments[1],
        _ => pool.literal("0.5")?,
    };
    let least = pool.literal(LEAST)?;
    let size = pool.call(Function::Max, &[base, least]);
    let quotient = pool.divide(power, size)?;
    Some(pool.multiply(exponent, quotient))
}

fn orders(pool: &Pool, product: Expression) -> Orders {
    let mut orders = Orders::new();
    add_orders(pool, product, 1.0, &mut orders);
    orders
}

/// Adds the orders of a power of a product. An exponent that is not known counts as just above zero: below zero the value at
/// rest is not a number, and the guarded derivative is none either.
fn add_orders(pool: &Pool, product: Expression, exponent: f64, orders: &mut Orders) {
    for factor in pool.factors(product) {
        match pool.operation(factor) {
            Operation::Call(Function::Abs, arguments) => {
                add_orders(pool, arguments[0], exponent, orders);
            }
            Operation::Call(Function::Sqrt, arguments) => {
                add_orders(pool, arguments[0], 0.5 * exponent, orders);
            }
            Operation::Call(Function::Pow, arguments) => {
                let inner = pool.constant_value(arguments[1]).unwrap_or(f64::EPSILON);
                add_orders(pool, arguments[0], inner * exponent, orders);
            }
            _ if pool.rate(factor) == Rate::Varying => {
                *orders.entry(factor).or_default() += exponent;
            }
            _ => {}
        }
    }
}

/// Whether a product of these orders has no slope where the base of one of its powers is zero.
///
/// So it is where it vanishes with each factor of the base by an order above 1. Where the base is a sum of squares, each of
/// their roots and the slope of the sum are bounded by the root of the sum, so that both count as that root.
fn is_flat(pool: &Pool, base: Expression, orders: &Orders) -> bool {
    let of = |factor: &Expression| orders.get(factor).copied().unwrap_or_default();
    let inside = self::orders(pool, base);
    if !inside.is_empty() && inside.keys().all(|factor| of(factor) > 1.0) {
        return true;
    }
    let holds = |root: &Orders| root.iter().all(|(factor, order)| of(factor) >= *order);
    roots(pool, base).is_some_and(|roots| {
        let beside = if roots.iter().any(holds) { 1.0 } else { 0.0 };
        2.0 * of(&base) + beside > 1.0
    })
}

/// The orders of the roots of a sum of squares; none if it is no such sum, or if one of them does not vary, so that the sum
/// does not vanish.
fn roots(pool: &Pool, sum: Expression) -> Option<Vec<Orders>> {
    let mut found = Vec::new();
    let mut pending = vec![sum];
    while let Some(term) = pending.pop() {
        if term.is_negative() || found.len() + pending.len() > MOST {
            return None;
        }
        if let Operation::Add(a, b) = *pool.operation(term) {
            pending.extend([a, b]);
            continue;
        }
        let factors = pool.factors(term);
        let is_square = |factor: &Expression| {
            let count = factors.iter().filter(|other| *other == factor).count();
            count % 2 == 0 || pool.constant_value(*factor).is_some()
        };
        if !factors.iter().all(is_square) {
            return None;
        }
        let mut root = Orders::new();
        add_orders(pool, term, 0.5, &mut root);
        if root.is_empty() {
            return None;
        }
        found.push(root);
    }
    Some(found)
}
