//! Inertia that a body hands on to the one that carries it.
//!
//! Mass on the axis of a hinge moves alike whether it turns with the hinge or not. So a body may hand on whatever a thin rod
//! on the axis can be: mass, first moment along it, and moment of inertia across it. The body that carries it has ten such
//! numbers anyway, and the hinge's own is left with seven, of which none is a mass: the least set of parameters that
//! tells the motion (Gautier and Khalil, *IEEE Transactions on Robotics and Automation* 6 (1990), 368–373). No rate is
//! another then, and the efforts in between are given back.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, Law, Mass, across};
use super::eliminate::System;
use super::hinges::Paths;
use super::inertia::Distribution;
use super::shift::{Given, Motion};
use super::tensor::Vector;
use super::tree::{Columns, Tree};
use crate::symbolic::{Expression, Pool};

/// Hands on what saves products, from the leaves to the base. Gives the efforts as they were before, in order.
pub(super) fn regroup(
    pool: &mut Pool,
    system: &mut System,
    tree: &Tree,
    rates: &[Given],
    motion: &Motion,
    mut bodies: Vec<Body>,
) -> Vec<Given> {
    let ranks = rates.iter().enumerate();
    let ranks: BTreeMap<usize, usize> = ranks.map(|(rank, given)| (given.unknown, rank)).collect();
    bodies.sort_by_key(|body| Reverse(ranks.get(&body.mass.omega[0]).copied()));
    let paths = Paths::of(rates);
    let mut changed = BTreeSet::new();
    for number in 0..bodies.len() {
        if let Some(hinge) = paths.hinge(pool, &bodies, number)
            && hinge.is_of_one(pool, motion, &bodies[hinge.carrier])
        {
            let (own, carrier) = (bodies[number].inertia, bodies[hinge.carrier].inertia);
            let (kept, handed) = hinge.split(pool, &own);
            let carried = carrier.plus(pool, &handed);
            let before = own.products(pool) + carrier.without_mass().products(pool);
            // Its mass a carrier hands on in turn.
            let after = kept.products(pool) + carried.without_mass().products(pool);
            if kept != own && after <= before {
                bodies[number].inertia = kept;
                bodies[hinge.carrier].inertia = carried;
                changed.extend([number, hinge.carrier]);
            }
        }
    }
    let changed: Vec<&Body> = changed.iter().map(|number| &bodies[*number]).collect();
    let Some(before) = efforts(system, tree, &changed) else {
        return Vec::new();
    };
    for body in changed {
        body.write(pool, system, motion);
    }
    before
}

impl Body {
    /// Writes its laws about the origin instead of the mass: the force adds nothing to its moment then.
    fn write(&self, pool: &mut Pool, system: &mut System, motion: &Motion) {
        for (row, force) in &self.levers {
            system.set(*row, *force, Expression::ZERO);
        }
        let Mass { omega, origin, .. } = self.mass;
        let Distribution {
            mass,
            first,
            second,
        } = self.inertia;
        let tensor = motion.tensor(&omega);
        let base = self.base(pool, motion);
        let forwards = across(&first);
        let backwards = forwards.map(|row| row.map(Expression::negated));
        for (k, law) in self.moment.iter().enumerate() {
            let products = [0, 1, 2].map(|it| pool.multiply(forwards[k][it], base[it]));
            let straight = pool.sum(&products);
            let turning = tensor.moment(pool, k, &second);
            let turned = omega.into_iter().zip(second[k]);
            let moved = origin.into_iter().flatten().zip(forwards[k]);
            let known = pool.add(straight, turning);
            law.write(system, turned.chain(moved), known);
        }
        let Some(origin) = origin else {
            return;
        };
        for (k, law) in self.mass.force.iter().enumerate() {
            let straight = pool.multiply(mass, base[k]);
            let turning = tensor.acceleration(pool, k, &first);
            let moved = [(self.mass.centre[k], Expression::ZERO), (origin[k], mass)];
            let turned = omega.into_iter().zip(backwards[k]);
            let known = pool.add(straight, turning);
            law.write(system, turned.chain(moved), known);
        }
    }

    /// The acceleration of the frame's origin in the motion that rates are counted from.
    pub(super) fn base(&self, pool: &mut Pool, motion: &Motion) -> Vector {
        let Mass {
            omega, origin, arm, ..
        } = &self.mass;
        if let Some(origin) = origin {
            return origin.map(|rate| motion.rate(rate));
        }
        let tensor = motion.tensor(omega);
        [0, 1, 2].map(|k| {
            let more = tensor.acceleration(pool, k, arm);
            pool.subtract(motion.rate(self.mass.centre[k]), more)
        })
    }
}

impl Law {
    /// Lets the effort be a sum of other unknowns, and of what is known.
    fn write(
        &self,
        system: &mut System,
        terms: impl Iterator<Item = (usize, Expression)>,
        known: Expression,
    ) {
        let is_negative = system.entry(self.row, self.effort).is_negative();
        for (column, value) in terms {
            system.set(self.row, column, value.flipped(!is_negative));
        }
        system.set_right(self.row, known.flipped(is_negative));
    }
}

/// The efforts that are others when bodies have new laws, as they follow without them, in order: none if a law reads one, or
/// if they do not follow from each other.
fn efforts(system: &System, tree: &Tree, bodies: &[&Body]) -> Option<Vec<Given>> {
    let laws = bodies.iter().flat_map(|body| {
        let Mass { origin, force, .. } = &body.mass;
        let force = origin.map_or(&[][..], |_| force);
        body.moment.iter().chain(force)
    });
    let laws = laws.map(|law| Given::of(system, law.row, law.effort));
    let mut given: Vec<Given> = laws.collect::<Option<_>>()?;
    let known = given.iter().map(|law| law.unknown);
    let Passed { rows, mut open } = Passed::from(system, tree, known.collect())?;
    let is_next = |row: &usize, open: &Columns| {
        let mut unknown = system.row(*row).filter(|(column, _)| open.contains(column));
        let next = unknown.next().filter(|_| unknown.next().is_none());
        next.and_then(|(effort, _)| Given::of(system, *row, effort))
    };
    let mut pending: Vec<usize> = rows.iter().copied().collect();
    while let Some(row) = pending.pop() {
        if let Some(next) = is_next(&row, &open) {
            open.remove(&next.unknown);
            pending.extend(
                system
                    .rows_with(next.unknown)
                    .filter(|it| rows.contains(it)),
            );
            given.push(next);
        }
    }
    open.is_empty().then_some(given)
}

/// What passes some efforts on, and efforts that are open there.
struct Passed {
    rows: BTreeSet<usize>,
    open: Columns,
}

impl Passed {
    /// None if a law gives an effort from another.
    fn from(system: &System, tree: &Tree, mut known: Columns) -> Option<Self> {
        let (mut rows, mut open) = (BTreeSet::new(), Columns::new());
        let mut pending: Vec<usize> = known.iter().copied().collect();
        while let Some(effort) = pending.pop() {
            for row in system.rows_with(effort) {
                let columns = system.row(row).map(|(column, _)| column);
                let mut others = columns.filter(|it| *it != effort && tree.is_effort(*it));
                if !tree.passes_on(row) {
                    others.next().is_none().then_some(())?;
                    known.insert(effort);
                } else if rows.insert(row) {
                    let new = others.filter(|it| !known.contains(it) && open.insert(*it));
                    pending.extend(new);
                }
            }
        }
        open.retain(|effort| !known.contains(effort));
        Some(Self { rows, open })
    }
}
