//! Moments of bodies that turn.
//!
//! Besides `J α`, which a law of inertia gives, a turning body resists with `ω × J ω`, which stands in the balance of its
//! junction. Both together are a moment of its [`Tensor`]. So the efforts of the law are counted from `−ω × J ω`: a shift
//! by something known, which is made where the balances then hold nothing that was not there before.

use std::collections::{BTreeMap, BTreeSet};

use super::carried::Triple;
use super::eliminate::System;
use super::shift::Given;
use super::tensor::{Tensor, Vector};
use super::tree::Tree;
use crate::symbolic::field::Image;
use crate::symbolic::{Expression, Pool};

/// The moment of a body in its own axes.
pub(super) struct Moment {
    /// The rates that change the body's rate of turning.
    pub(super) omega: Triple,
    pub(super) inertia: [Vector; 3],
    /// By component.
    pub(super) efforts: [Effort; 3],
}

/// One of its components.
pub(super) struct Effort {
    /// The row that gives it, without what is known.
    pub(super) law: Given,
    pub(super) row: usize,
    /// The only other row that it is in, and what is left there.
    pub(super) balance: usize,
    left: Expression,
}

impl Moment {
    /// Those of a block in which rates have not yet been shifted, but for balances that are `taken`: what is left there
    /// is decided already.
    pub(super) fn all(
        pool: &Pool,
        system: &System,
        tree: &Tree,
        vectors: &[Triple],
        velocity: &dyn Fn(usize) -> Expression,
        taken: BTreeSet<usize>,
    ) -> Vec<Self> {
        let mut balances = Balances {
            system,
            taken,
            left: BTreeMap::new(),
        };
        let mut moments = Vec::new();
        for omega in vectors {
            let speeds = omega.map(|rate| pool.image(velocity(rate)));
            let moment = laws(system, tree, omega)
                .and_then(|laws| Self::of(pool, &balances, *omega, &speeds, &laws));
            for effort in moment.iter().flat_map(|it: &Self| &it.efforts) {
                balances.left.insert(effort.balance, effort.left);
            }
            moments.extend(moment);
        }
        moments
    }

    fn of(
        pool: &Pool,
        balances: &Balances,
        omega: Triple,
        speeds: &[Image; 3],
        laws: &[Law; 3],
    ) -> Option<Self> {
        ORDERS.iter().find_map(|order| {
            let inertia = order.map(|number| laws[number].row_of_inertia(&omega));
            let symmetric = |a: usize| (0..a).all(|b| inertia[a][b] == inertia[b][a]);
            let resists = |a: usize| inertia[a][a] != Expression::ZERO;
            let turning = gyroscopic(pool, speeds, &inertia);
            if !(0..3).all(|a| resists(a) && symmetric(a)) || turning == [Image::ZERO; 3] {
                return None;
            }
            let effort = |k: usize| laws[order[k]].effort(pool, balances, turning[k]);
            Some(Self {
                omega,
                inertia,
                efforts: [effort(0)?, effort(1)?, effort(2)?],
            })
        })
    }

    /// Counts the efforts anew, with the motion that rates are counted from; gives what they were.
    pub(super) fn shift(self, pool: &mut Pool, system: &mut System, motion: &Tensor) -> [Given; 3] {
        for (component, effort) in self.efforts.iter().enumerate() {
            let value = motion.moment(pool, component, &self.inertia);
            let own = system.entry(effort.row, effort.law.unknown);
            system.set_right(effort.row, value.flipped(own.is_negative()));
            system.set_right(effort.balance, effort.left);
        }
        self.efforts.map(|effort| effort.law)
    }
}

/// In which order three rows may belong to the axes.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

/// A row that gives one effort from the rates of one vector.
struct Law {
    row: usize,
    balance: usize,
    effort: usize,
    terms: Vec<(usize, Expression)>,
}

/// What is known in rows, as far as moments have changed it.
struct Balances<'a> {
    system: &'a System,
    taken: BTreeSet<usize>,
    left: BTreeMap<usize, Expression>,
}

impl Balances<'_> {
    fn right(&self, row: usize) -> Expression {
        let left = self.left.get(&row).copied();
        left.unwrap_or_else(|| self.system.right(row))
    }
}

/// The rows that give efforts from a vector of rates, if there are three of them with balances of their own.
fn laws(system: &System, tree: &Tree, omega: &Triple) -> Option<[Law; 3]> {
    let rows = omega.iter().flat_map(|rate| system.rows_with(*rate));
    let rows: BTreeSet<usize> = rows.filter(|row| tree.given_by(*row).is_none()).collect();
    let laws: Option<Vec<Law>> = rows
        .iter()
        .map(|row| law(system, tree, *row, omega))
        .collect();
    let laws: [Law; 3] = laws?.try_into().ok()?;
    let balances: BTreeSet<usize> = laws.iter().map(|law| law.balance).collect();
    (balances.len() == 3).then_some(laws)
}

fn law(system: &System, tree: &Tree, row: usize, omega: &Triple) -> Option<Law> {
    let mut efforts = system
        .row(row)
        .map(|(column, _)| column)
        .filter(|column| !omega.contains(column));
    let (effort, None) = (efforts.next()?, efforts.next()) else {
        return None;
    };
    let mut balances = system.rows_with(effort).filter(|other| *other != row);
    let (balance, None) = (balances.next()?, balances.next()) else {
        return None;
    };
    let given = Given::of(system, row, effort)?;
    // What closes a loop gives a rate from others.
    (given.constant == Expression::ZERO && !tree.is_given(effort)).then_some(Law {
        row,
        balance,
        effort,
        terms: given.terms,
    })
}

impl Law {
    fn row_of_inertia(&self, omega: &Triple) -> Vector {
        omega.map(|rate| {
            let term = self.terms.iter().find(|(column, _)| *column == rate);
            term.map_or(Expression::ZERO, |(_, value)| *value)
        })
    }

    /// The effort, if its balance holds this component of `ω × J ω`.
    fn effort(&self, pool: &Pool, balances: &Balances, turning: Image) -> Option<Effort> {
        if balances.taken.contains(&self.balance) {
            return None;
        }
        let factor = pool.image(balances.system.entry(self.balance, self.effort));
        let left = pool.image(balances.right(self.balance));
        Some(Effort {
            law: Given {
                unknown: self.effort,
                terms: self.terms.clone(),
                constant: Expression::ZERO,
            },
            row: self.row,
            balance: self.balance,
            left: pool.find(left.plus(factor.times(turning)))?,
        })
    }
}

/// `ω × J ω`.
fn gyroscopic(pool: &Pool, omega: &[Image; 3], inertia: &[Vector; 3]) -> [Image; 3] {
    let momentum = inertia.map(|row| {
        let products = row.iter().zip(omega);
        products.fold(Image::ZERO, |sum, (entry, speed)| {
            sum.plus(pool.image(*entry).times(*speed))
        })
    });
    [(1, 2), (2, 0), (0, 1)].map(|(y, z)| {
        let first = omega[y].times(momentum[z]);
        first.minus(omega[z].times(momentum[y]))
    })
}
