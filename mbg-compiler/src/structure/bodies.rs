//! Rigid bodies among the equations.

use super::carried::{Carried, End, Triple};
use super::eliminate::System;
use super::inertia::Distribution;
use super::moments::Moment;
use super::shift::Given;
use super::tensor::Vector;
use super::tree::Tree;
use crate::symbolic::field::Image;
use crate::symbolic::{Expression, Pool};

/// A body whose mass is at the origin of its frame, or at the end of an arm.
pub(super) struct Body {
    pub(super) mass: Mass,
    /// Mass and moments about the frame's origin.
    pub(super) inertia: Distribution,
    /// What gives its moment about the mass, by component.
    pub(super) moment: [Law; 3],
    /// Rows, and columns there, by which the force on the mass adds to the moment.
    pub(super) levers: Vec<(usize, usize)>,
}

/// The rates of a frame: those with which it turns, and those of its origin's velocity if none of them is known.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    pub(super) omega: Triple,
    pub(super) origin: Option<Triple>,
}

/// A mass in a frame.
#[derive(Clone, Copy)]
pub(super) struct Mass {
    /// The rates with which the frame turns.
    pub(super) omega: Triple,
    /// The rates of the velocity of the frame's origin; none if it is at rest.
    pub(super) origin: Option<Triple>,
    /// Those of the mass.
    pub(super) centre: Triple,
    pub(super) arm: Vector,
    amount: Expression,
    /// What gives the force on it.
    pub(super) force: [Law; 3],
    /// Whether the force counts as one that the frame puts on the mass.
    is_inward: bool,
    /// The same force where an arm passes it on, and whether its sign is the other.
    passed: [Option<(usize, bool)>; 3],
}

/// An effort and the row that gives it from rates.
#[derive(Clone, Copy)]
pub(super) struct Law {
    pub(super) effort: usize,
    pub(super) row: usize,
}

impl Body {
    /// Those of a block, each alone in its frame.
    pub(super) fn all(
        pool: &mut Pool,
        system: &System,
        tree: &Tree,
        (vectors, frames): (&[Triple], &[Frame]),
        carried: &Carried,
        moments: &[Moment],
    ) -> Vec<Self> {
        let masses: Vec<Mass> = vectors
            .iter()
            .filter_map(|centre| Mass::at(system, tree, carried, frames, *centre))
            .collect();
        let mut bodies = Vec::new();
        for moment in moments {
            let mut own = masses.iter().filter(|mass| mass.omega == moment.omega);
            if let (Some(mass), None) = (own.next(), own.next())
                && let Some(levers) = mass.levers(pool, system, moment)
            {
                bodies.push(Self::of(pool, *mass, moment, levers));
            }
        }
        bodies
    }

    fn of(pool: &mut Pool, mass: Mass, moment: &Moment, levers: Vec<(usize, usize)>) -> Self {
        let at_centre = Distribution {
            mass: mass.amount,
            first: [Expression::ZERO; 3],
            second: moment.inertia,
        };
        let law = |k: usize| Law {
            effort: moment.efforts[k].law.unknown,
            row: moment.efforts[k].row,
        };
        Self {
            inertia: at_centre.moved(pool, &mass.arm),
            moment: [0, 1, 2].map(law),
            levers,
            mass,
        }
    }

    /// Whether a rate is one of the frame's.
    pub(super) fn has(&self, rate: usize) -> bool {
        let mut origin = self.mass.origin.iter().flatten();
        self.mass.omega.contains(&rate) || origin.any(|it| *it == rate)
    }
}

impl Mass {
    /// The mass with these rates.
    fn at(
        system: &System,
        tree: &Tree,
        carried: &Carried,
        frames: &[Frame],
        centre: Triple,
    ) -> Option<Self> {
        let masses: Vec<(usize, &Given)> = all(centre, |rate| {
            let mut inertias = carried.inertias.iter();
            let inertia = inertias.find(|it| it.rate == rate && it.left == Expression::ZERO)?;
            Some((inertia.balance, inertia.law.as_ref()?))
        })?;
        let amount = masses[0].1.terms[0].1;
        let law = |k: usize| {
            let (balance, law) = masses[k];
            let effort = law.unknown;
            let row = system.rows_with(effort).find(|row| *row != balance)?;
            Some(Law { effort, row })
        };
        let own = |k: usize| system.entry(masses[k].0, masses[k].1.unknown);
        let passed = |k: usize| {
            let (balance, law) = masses[k];
            let mut others = system
                .row(balance)
                .filter(|(column, _)| *column != law.unknown);
            let (Some((effort, other)), None) = (others.next(), others.next()) else {
                return None;
            };
            let is_same = other.magnitude() == Expression::ONE;
            (tree.passes_on(balance) && is_same).then_some((effort, own(k) == other))
        };
        let (omega, origin, arm) = place(system, tree, carried, frames, centre)?;
        let is_one = (0..3).all(|k| {
            masses[k].1.terms[0].1 == amount
                && own(k).magnitude() == Expression::ONE
                && own(k) == own(0)
        });
        let found = Self {
            omega,
            origin,
            centre,
            arm,
            amount,
            is_inward: own(0).is_negative(),
            force: [law(0)?, law(1)?, law(2)?],
            passed: [passed(0), passed(1), passed(2)],
        };
        is_one.then_some(found)
    }

    /// The entries by which the force on the mass adds to the body's moment about its centre, if that is `arm × force`.
    fn levers(&self, pool: &Pool, system: &System, moment: &Moment) -> Option<Vec<(usize, usize)>> {
        let mut levers = Vec::new();
        for (effort, expected) in moment.efforts.iter().zip(across(&self.arm)) {
            let own = system.entry(effort.balance, effort.law.unknown);
            let mut found = [Image::ZERO; 3];
            for (column, value) in system.row(effort.balance) {
                if let Some((row, parts)) = self.lever(pool, system, effort.balance, column) {
                    let value = pool.image(value);
                    found = [0, 1, 2].map(|k| found[k].plus(value.times(parts[k])));
                    let forces = self.passed.iter().flatten();
                    levers.extend(forces.map(|(force, _)| (row, *force)));
                }
            }
            let expected = expected.map(|entry| pool.image(entry.flipped(own.is_negative())));
            let is_alike = own.is_negative() == self.is_inward;
            if !is_alike || own.magnitude() != Expression::ONE || found != expected {
                return None;
            }
        }
        Some(levers)
    }

    /// The row that gives an effort in a balance from the force alone, and the coefficients of the latter's components:
    /// that of a two-port, or the balance itself.
    fn lever(
        &self,
        pool: &Pool,
        system: &System,
        balance: usize,
        effort: usize,
    ) -> Option<(usize, [Image; 3])> {
        let part = |column: usize, value: Image| {
            self.passed.iter().enumerate().find_map(|(place, passed)| {
                let is_reversed = passed.filter(|(force, _)| *force == column)?.1;
                let mut parts = [Image::ZERO; 3];
                parts[place] = if is_reversed { value.negated() } else { value };
                Some(parts)
            })
        };
        if let Some(parts) = part(effort, Image::ONE) {
            return Some((balance, parts));
        }
        system.rows_with(effort).find_map(|row| {
            let divisor = pool.image(system.entry(row, effort)).negated().inverted()?;
            let mut parts = [Image::ZERO; 3];
            for (column, value) in system.row(row).filter(|(column, _)| *column != effort) {
                let more = part(column, pool.image(value).times(divisor))?;
                parts = [0, 1, 2].map(|k| parts[k].plus(more[k]));
            }
            Some((row, parts))
        })
    }
}

/// Where the mass with these rates is: the rates with which its frame turns, those of the frame's origin, and the arm.
fn place(
    system: &System,
    tree: &Tree,
    carried: &Carried,
    frames: &[Frame],
    centre: Triple,
) -> Option<(Triple, Option<Triple>, Vector)> {
    let moved = centre.map(|rate| cause(system, tree, rate));
    let is_at = |frame: &&Frame| [Some(centre), Some(moved)].contains(&frame.origin);
    if let Some(frame) = frames.iter().find(is_at) {
        return Some((frame.omega, frame.origin, [Expression::ZERO; 3]));
    }
    let ends: Vec<&End> = all(centre, |rate| carried.ends.get(&rate))?;
    let is_one = (0..3).all(|k| {
        let is_same = ends[k].omega == ends[0].omega && ends[k].arm == ends[0].arm;
        is_same && ends[k].component == k
    });
    let origin: Option<Vec<usize>> = ends.iter().map(|end| end.from).collect();
    let origin = origin.and_then(|it| it.try_into().ok());
    is_one.then_some((ends[0].omega, origin, ends[0].arm))
}

/// Something of each rate of a vector.
fn all<T>(rates: Triple, of: impl Fn(usize) -> Option<T>) -> Option<Vec<T>> {
    rates.into_iter().map(of).collect()
}

/// The rate that a rate is by the row that gives it; itself if it is no other.
fn cause(system: &System, tree: &Tree, rate: usize) -> usize {
    let row = tree.conjugates.get(&rate).map(|conjugate| conjugate.row);
    let given = row.and_then(|row| Given::of(system, row, rate));
    match given.as_ref().map(|given| &*given.terms) {
        Some([(other, Expression::ONE)]) => *other,
        _ => rate,
    }
}

/// The matrix that gives `vector × another`.
pub(super) fn across(vector: &Vector) -> [Vector; 3] {
    let [x, y, z] = *vector;
    let zero = Expression::ZERO;
    [
        [zero, z.negated(), y],
        [z, zero, x.negated()],
        [y.negated(), x, zero],
    ]
}
