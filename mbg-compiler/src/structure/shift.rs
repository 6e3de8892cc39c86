//! Rates counted from a motion that is known beforehand.
//!
//! With no acceleration of any independent rate a system still moves by its velocity products. That motion follows
//! from the base to the leaves by the rows that give the rates; counted from it those rows have no right side, and no
//! velocity product is carried along on the way back.

use std::collections::BTreeMap;

use super::bodies::{Body, Frame};
use super::carried::{Carried, End, Triple};
use super::eliminate::System;
use super::moments::Moment;
use super::regrouping::regroup;
use super::tensor::Tensor;
use super::tree::Tree;
use crate::symbolic::field::Image;
use crate::symbolic::{Expression, Pool};

/// What the shifted unknowns were: each as a sum of others and what is known, in order.
pub(super) struct Shift {
    rows: Vec<Given>,
}

/// `unknown = Σ coefficient · other + constant`.
pub(super) struct Given {
    pub(super) unknown: usize,
    pub(super) terms: Vec<(usize, Expression)>,
    pub(super) constant: Expression,
}

impl Given {
    /// Solves a row for a column that is there once, with or without a sign.
    pub(super) fn of(system: &System, row: usize, unknown: usize) -> Option<Self> {
        let own = system.entry(row, unknown);
        (own.magnitude() == Expression::ONE).then(|| Self {
            unknown,
            terms: system
                .row(row)
                .filter(|(other, _)| *other != unknown)
                .map(|(other, value)| (other, value.flipped(!own.is_negative())))
                .collect(),
            constant: system.right(row).flipped(own.is_negative()),
        })
    }

    /// The image of the value with another constant.
    pub(super) fn image(
        &self,
        pool: &Pool,
        constant: Expression,
        values: &dyn Fn(usize) -> Expression,
    ) -> Image {
        let terms = self.terms.iter();
        terms.fold(pool.image(constant), |sum, (other, coefficient)| {
            sum.plus(pool.image(*coefficient).times(pool.image(values(*other))))
        })
    }

    fn value(&self, pool: &mut Pool, values: &dyn Fn(usize) -> Expression) -> Expression {
        self.plus(pool, self.constant, values)
    }

    /// The value with another constant.
    fn plus(
        &self,
        pool: &mut Pool,
        constant: Expression,
        values: &dyn Fn(usize) -> Expression,
    ) -> Expression {
        let terms = self.terms.iter();
        terms.fold(constant, |sum, (other, coefficient)| {
            let product = pool.multiply(*coefficient, values(*other));
            pool.add(sum, product)
        })
    }
}

/// The motion that rates are counted from.
pub(super) struct Motion<'a> {
    velocity: &'a dyn Fn(usize) -> Expression,
    rates: BTreeMap<usize, Expression>,
}

impl Motion<'_> {
    pub(super) fn rate(&self, column: usize) -> Expression {
        self.rates.get(&column).copied().unwrap_or(Expression::ZERO)
    }

    pub(super) fn tensor(&self, omega: &Triple) -> Tensor {
        Tensor {
            omega: omega.map(self.velocity),
            alpha: omega.map(|rate| self.rate(rate)),
        }
    }

    /// What is at the end of an arm.
    fn end(&self, pool: &mut Pool, end: &End) -> Expression {
        let tensor = self.tensor(&end.omega);
        let more = tensor.acceleration(pool, end.component, &end.arm);
        let from = end.from.map_or(Expression::ZERO, |it| self.rate(it));
        pool.add(from, more)
    }
}

impl Shift {
    /// Shifts all rates of a block. None, and nothing is done, if a rate is not given with the coefficient one, or if
    /// rates follow from each other in a circle.
    pub(super) fn of(
        pool: &mut Pool,
        system: &mut System,
        tree: &Tree,
        (vectors, frames): (&[Triple], &[Frame]),
        velocity: &dyn Fn(usize) -> Expression,
    ) -> Option<Self> {
        let mut rows = tree.base_to_leaves(system)?;
        let carried = Carried::of(pool, system, tree, (vectors, frames), &rows, velocity);
        let mut motion = Motion {
            velocity,
            rates: BTreeMap::new(),
        };
        for given in &rows {
            let left = carried.left.get(&given.unknown);
            let constant = *left.unwrap_or(&given.constant);
            let rate = |column: usize| motion.rate(column);
            let end = carried.ends.get(&given.unknown);
            let by_arm = end.map(|end| motion.end(pool, end));
            // What an arm adds that slides or changes its length is more.
            let value = match by_arm {
                Some(value) if pool.image(value) == given.image(pool, constant, &rate) => value,
                _ => given.plus(pool, constant, &rate),
            };
            motion.rates.insert(given.unknown, value);
            system.set_right(tree.conjugates[&given.unknown].row, Expression::ZERO);
        }
        for inertia in &carried.inertias {
            system.set_right(inertia.balance, inertia.left);
        }
        let taken = carried.inertias.iter().map(|inertia| inertia.balance);
        let moments = Moment::all(pool, system, tree, vectors, velocity, taken.collect());
        for row in system
            .open()
            .iter()
            .copied()
            .filter(|row| tree.given_by(*row).is_none())
            .collect::<Vec<_>>()
        {
            let entries: Vec<(usize, Expression)> = system.row(row).collect();
            let right = entries
                .iter()
                .fold(system.right(row), |right, (column, value)| {
                    let product = pool.multiply(*value, motion.rate(*column));
                    pool.subtract(right, product)
                });
            system.set_right(row, right);
        }
        let bodies = Body::all(pool, system, tree, (vectors, frames), &carried, &moments);
        let mut laws = Vec::new();
        for moment in moments {
            let tensor = motion.tensor(&moment.omega);
            laws.extend(moment.shift(pool, system, &tensor));
        }
        laws.extend(carried.inertias.into_iter().filter_map(|it| it.law));
        let mut all = regroup(pool, system, tree, &rows, &motion, bodies);
        all.append(&mut rows);
        all.append(&mut laws);
        Some(Self { rows: all })
    }

    /// Counts the solution from zero again.
    pub(super) fn undo(&self, pool: &mut Pool, solution: &mut [Expression]) {
        for given in &self.rows {
            solution[given.unknown] = given.value(pool, &|column| solution[column]);
        }
    }
}
