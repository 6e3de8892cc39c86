//! Turning a symmetric block with half the operations.
//!
//! Where two rates are those of a turned frame, `x = R k`, elimination turns the block `Z` between them and the efforts
//! that do work on them into `Rᵀ Z R`. As two products that costs 21 operations. With `w = σ (d − a) − 2 c b` it costs
//! ten: `a' = a + σ w`, `b' = −c w − b`, `d' = d − σ w`. These forms are put into the pool beforehand, where elimination
//! finds them by their values.

use std::collections::{BTreeMap, BTreeSet};

use super::eliminate::System;
use super::tree::{Conjugate, Tree};
use crate::symbolic::{Expression, Pool};

/// Prepares whatever is turned when the columns given are eliminated.
pub(super) fn prepare(pool: &mut Pool, system: &System, tree: &Tree, columns: &BTreeSet<usize>) {
    let conjugates = &tree.conjugates;
    let turned: Vec<(usize, Turned)> = columns
        .iter()
        .filter_map(|column| {
            let row = conjugates.get(column)?.row;
            Some((*column, Turned::of(pool, system, row, *column)?))
        })
        .collect();
    for (position, (x, first)) in turned.iter().enumerate() {
        for (y, second) in &turned[position + 1..] {
            if first.columns == second.columns
                && first.first == second.second
                && first.second == second.first.negated()
            {
                block(pool, system, conjugates, [*x, *y], first);
            }
        }
    }
}

/// `x = first · k + second · l`.
struct Turned {
    columns: [usize; 2],
    first: Expression,
    second: Expression,
}

impl Turned {
    fn of(pool: &mut Pool, system: &System, row: usize, column: usize) -> Option<Self> {
        let own = pool.constant_value(system.entry(row, column))?;
        let others: Vec<(usize, Expression)> = system
            .row(row)
            .filter(|(other, _)| *other != column)
            .collect();
        let [(k, first), (l, second)] = others[..] else {
            return None;
        };
        (own.abs() == 1.0).then_some(Self {
            columns: [k, l],
            first: first.flipped(own > 0.0),
            second: second.flipped(own > 0.0),
        })
    }
}

fn block(
    pool: &mut Pool,
    system: &System,
    conjugates: &BTreeMap<usize, Conjugate>,
    [x, y]: [usize; 2],
    turned: &Turned,
) {
    let firsts = balances(system, &conjugates[&x], [x, y]);
    let seconds = balances(system, &conjugates[&y], [x, y]);
    for [a, b] in firsts {
        for [symmetric, d] in &seconds {
            if b == *symmetric && a != *d {
                forms(pool, turned, a, b, *d);
            }
        }
    }
}

/// The coefficients of both rates in the rows that give the effort that comes with one of them.
fn balances(system: &System, conjugate: &Conjugate, columns: [usize; 2]) -> Vec<[Expression; 2]> {
    let Some(effort) = conjugate.effort else {
        return Vec::new();
    };
    system
        .rows_with(effort)
        .filter(|row| system.entry(*row, effort).magnitude() == Expression::ONE)
        .map(|row| {
            let flip = system.entry(row, effort).is_negative();
            columns.map(|column| system.entry(row, column).flipped(flip))
        })
        .filter(|entries| *entries != [Expression::ZERO; 2])
        .collect()
}

fn forms(pool: &mut Pool, turned: &Turned, a: Expression, b: Expression, d: Expression) {
    let (c, sigma) = (turned.first, turned.second);
    let difference = pool.subtract(d, a);
    let across = pool.multiply(sigma, difference);
    let double = pool.add(b, b);
    let along = pool.multiply(c, double);
    let w = pool.subtract(across, along);
    let lift = pool.multiply(sigma, w);
    pool.add(a, lift);
    pool.subtract(d, lift);
    let mixed = pool.multiply(c, w);
    pool.add(mixed, b);
}
