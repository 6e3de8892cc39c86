//! Turning a block with half the operations.
//!
//! Where rates are those of a turned frame, `x = R k`, elimination turns a block `Z` between such rates and efforts
//! into `Rᵀ Z R`. As two products that costs 24 operations, 21 if `Z` is symmetric. For `Z = [a b; c d]` and with
//! `w = s (d − a) − cos (b + c)` it costs eleven, or ten: `a' = a + s w`, `b' = −cos w − c`, `c' = −cos w − b`,
//! `d' = d − s w`. These forms are put into the pool beforehand, where elimination finds them by their values.

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
    let planes: Vec<Plane> = turned
        .iter()
        .flat_map(|first| {
            turned
                .iter()
                .filter_map(move |second| Plane::of(first, second))
        })
        .collect();
    for rows in &planes {
        for columns in planes.iter().filter(|columns| columns.turn == rows.turn) {
            block(pool, system, conjugates, [rows, columns]);
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

/// Two rates that turn in their plane: `x = c k + s l`, `y = c l − s k`.
struct Plane {
    rates: [usize; 2],
    /// `c` and `s`, the latter without a sign.
    turn: [Expression; 2],
}

impl Plane {
    fn of((x, first): &(usize, Turned), (y, second): &(usize, Turned)) -> Option<Self> {
        let is_turn = first.columns == second.columns
            && first.first == second.second
            && first.second == second.first.negated();
        let is_forward = !first.second.is_negative();
        let rates = if is_forward { [*x, *y] } else { [*y, *x] };
        is_turn.then_some(Self {
            rates,
            turn: [first.first, first.second.magnitude()],
        })
    }
}

/// The block between the efforts that come with the rates of one plane, and the rates of another.
fn block(
    pool: &mut Pool,
    system: &System,
    conjugates: &BTreeMap<usize, Conjugate>,
    [rows, columns]: [&Plane; 2],
) {
    let [x, y] = rows.rates;
    let firsts = balances(system, &conjugates[&x], columns.rates);
    let seconds = balances(system, &conjugates[&y], columns.rates);
    for upper in firsts {
        for lower in &seconds {
            forms(pool, rows.turn, [upper, *lower]);
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

fn forms(pool: &mut Pool, [cosine, sine]: [Expression; 2], [[a, b], [c, d]]: [[Expression; 2]; 2]) {
    let difference = pool.subtract(d, a);
    let across = pool.multiply(sine, difference);
    let along = if b == c {
        let double = pool.add(cosine, cosine);
        pool.multiply(double, b)
    } else {
        let sum = pool.add(b, c);
        pool.multiply(cosine, sum)
    };
    let w = pool.subtract(across, along);
    let lift = pool.multiply(sine, w);
    pool.add(a, lift);
    pool.subtract(d, lift);
    let mixed = pool.multiply(cosine, w);
    pool.add(mixed, b);
    pool.add(mixed, c);
}
