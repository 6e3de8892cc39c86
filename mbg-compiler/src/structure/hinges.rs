//! Joints that turn bodies among the equations: what carries each, and about which axis.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, Mass};
use super::carried::{Triple, dot, is_orthonormal, length};
use super::inertia::Distribution;
use super::shift::{Given, Motion};
use super::tensor::Vector;
use crate::symbolic::field::Image;
use crate::symbolic::{Expression, Pool, Rate};

/// Coefficients of rates.
type Sum = BTreeMap<usize, Expression>;

/// A hinge, or a joint about several axes, between a body and the one that carries it.
pub(super) struct Hinge {
    /// The number of the carrier.
    pub(super) carrier: usize,
    /// The axis of the body that stays in place in both, and its direction in those of the carrier.
    axis: Option<(usize, Vector)>,
    /// From the carrier's origin to the joint.
    arm: Vector,
    /// The rates of the joint's velocity.
    place: Triple,
    /// From the carrier's axes to those in which they are.
    turn: [Vector; 3],
}

impl Hinge {
    /// What the body keeps, and what its carrier gets.
    pub(super) fn split(
        &self,
        pool: &mut Pool,
        own: &Distribution,
    ) -> (Distribution, Distribution) {
        let mut unit = [Expression::ZERO; 3];
        let (mut first, mut across) = (Expression::ZERO, Expression::ZERO);
        let mut direction = unit;
        if let Some((axis, there)) = self.axis {
            unit[axis] = Expression::ONE;
            first = own.first[axis];
            across = own.along(pool, axis);
            direction = there;
        }
        let here = Distribution::rod(pool, &unit, own.mass, first, across);
        let there = Distribution::rod(pool, &direction, own.mass, first, across);
        (own.minus(pool, &here), there.moved(pool, &self.arm))
    }

    /// Whether rates of both bodies are counted from one motion. Where a frame's origin is at rest, those of its mass may be
    /// counted from one that a force on the mass belongs to.
    pub(super) fn is_of_one(&self, pool: &mut Pool, motion: &Motion, carrier: &Body) -> bool {
        let base = carrier.base(pool, motion);
        let tensor = motion.tensor(&carrier.mass.omega);
        let there = [0, 1, 2].map(|k| {
            let more = tensor.acceleration(pool, k, &self.arm);
            pool.image(base[k]).plus(pool.image(more))
        });
        let rate = |k: usize| pool.image(motion.rate(self.place[k]));
        (0..3).all(|k| dot(&self.turn[k].map(|it| pool.image(it)), &there) == rate(k))
    }
}

/// A frame that differs from that of a body by the turning of a joint.
struct Seat {
    /// Its rates.
    omega: Triple,
    origin: Triple,
    /// From its axes to those of the body.
    turn: [Vector; 3],
    /// The body's rates of turning by those of the seat and by independent ones.
    body: [Sum; 3],
}

/// How rates follow from each other.
pub(super) struct Paths<'a> {
    given: BTreeMap<usize, &'a Given>,
}

impl<'a> Paths<'a> {
    pub(super) fn of(rates: &'a [Given]) -> Self {
        Self {
            given: rates.iter().map(|given| (given.unknown, given)).collect(),
        }
    }

    /// The joint between a body and its carrier, if it is one that turns only.
    pub(super) fn hinge(&self, pool: &mut Pool, bodies: &[Body], number: usize) -> Option<Hinge> {
        let seat = self.seat(pool, &bodies[number])?;
        let is_frame = |column: &usize| bodies.iter().any(|body| body.has(*column));
        let turned = self.by_frames(pool, &seat.omega, &is_frame)?;
        let moved = self.by_frames(pool, &seat.origin, &is_frame)?;
        let carrier = bodies
            .iter()
            .position(|body| columns(&turned).any(|it| body.mass.omega.contains(&it)))?;
        let Mass { omega, origin, .. } = bodies[carrier].mass;
        let mut turning = columns(&turned).filter(|it| self.given.contains_key(it));
        let is_alone = turning.all(|it| omega.contains(&it))
            && columns(&moved).all(|it| bodies[carrier].has(it));
        let turn = matrix(&turned, &omega);
        let moves_alike = origin.is_none_or(|origin| matrix(&moved, &origin) == turn);
        if !is_alone || !moves_alike {
            return None;
        }
        is_orthonormal(&images(pool, &turn))?;
        let lever = product(pool, &transposed(&turn), &matrix(&moved, &omega));
        let axis = (0..3).find(|axis| self.is_axis(pool, &seat, &turned, *axis));
        let axis = axis.map(|axis| (axis, product(pool, &[seat.turn[axis]; 1], &turn)[0]));
        Some(Hinge {
            carrier,
            axis,
            arm: length(&lever)?,
            place: seat.origin,
            turn,
        })
    }

    /// The frame from which a body turns.
    fn seat(&self, pool: &mut Pool, body: &Body) -> Option<Seat> {
        let start = |rate: usize| BTreeMap::from([(rate, Expression::ONE)]);
        let origin = body.mass.origin?;
        let [mut turned, mut moved] = [body.mass.omega, origin].map(|it| it.map(start));
        let varies = |pool: &Pool, column: usize| {
            body.has(column) || self.steps(column).any(|it| pool.rate(it) == Rate::Varying)
        };
        let next = |pool: &Pool, turned: &[Sum; 3], moved: &[Sum; 3]| {
            let mut columns = columns(turned).chain(columns(moved));
            columns.find(|column| varies(pool, *column))
        };
        while let Some(column) = next(pool, &turned, &moved) {
            let sums = turned.iter_mut().chain(&mut moved);
            sums.for_each(|sum| self.expand(pool, sum, column));
        }
        let is_given = |column: &usize| self.given.contains_key(column);
        let omega: BTreeSet<usize> = columns(&turned).filter(is_given).collect();
        let omega: Triple = Vec::from_iter(omega).try_into().ok()?;
        let turn = matrix(&turned, &omega);
        is_orthonormal(&images(pool, &turn))?;
        let moving: BTreeSet<usize> = columns(&moved).collect();
        let like = |k: usize| {
            let mut moving = moving.iter().copied();
            moving.find(|it| (0..3).all(|row| coefficient(&moved[row], *it) == turn[row][k]))
        };
        let origin = [like(0)?, like(1)?, like(2)?];
        let is_whole = moving.len() == 3 && moving.iter().all(is_given);
        is_whole.then_some(Seat {
            omega,
            origin,
            turn,
            body: turned,
        })
    }

    /// A vector's rates by those of frames, if nothing turns on the way.
    fn by_frames(
        &self,
        pool: &mut Pool,
        rates: &Triple,
        is_frame: &dyn Fn(&usize) -> bool,
    ) -> Option<[Sum; 3]> {
        let mut sums = rates.map(|rate| BTreeMap::from([(rate, Expression::ONE)]));
        let is_inner = |column: &usize| self.given.contains_key(column) && !is_frame(column);
        let next = |sums: &[Sum; 3]| columns(sums).find(is_inner);
        while let Some(column) = next(&sums) {
            if self.steps(column).any(|it| pool.rate(it) == Rate::Varying) {
                return None;
            }
            sums.iter_mut()
                .for_each(|sum| self.expand(pool, sum, column));
        }
        Some(sums)
    }

    /// Whether the body turns about one of its axes alone, and the axis stays in place in the seat too.
    fn is_axis(&self, pool: &Pool, seat: &Seat, turned: &[Sum; 3], axis: usize) -> bool {
        let is_steady = |value: &Expression| pool.rate(*value) != Rate::Varying;
        let sums = seat.body.iter().chain(turned);
        let free: BTreeSet<usize> = sums
            .flat_map(|sum| sum.keys().copied())
            .filter(|column| !self.given.contains_key(column))
            .collect();
        let rate = |row: usize, column: usize| {
            let own = pool.image(coefficient(&seat.body[row], column));
            (0..3).fold(own, |sum, k| {
                let turn = pool.image(seat.turn[row][k]);
                sum.plus(turn.times(pool.image(coefficient(&turned[k], column))))
            })
        };
        let others = (0..3).filter(|row| *row != axis);
        let mut rates = others.flat_map(|row| free.iter().map(move |it| (row, *it)));
        seat.turn[axis].iter().all(is_steady) && rates.all(|(row, it)| rate(row, it) == Image::ZERO)
    }

    /// The coefficients by which a rate follows from others.
    fn steps(&self, column: usize) -> impl Iterator<Item = Expression> + '_ {
        let given = self.given.get(&column).into_iter();
        given.flat_map(|given| given.terms.iter().map(|(_, value)| *value))
    }

    /// Replaces a rate by those from which it follows.
    fn expand(&self, pool: &mut Pool, sum: &mut Sum, column: usize) {
        let Some(factor) = sum.remove(&column) else {
            return;
        };
        for (other, value) in self.given.get(&column).into_iter().flat_map(|it| &it.terms) {
            let product = pool.multiply(factor, *value);
            let entry = sum.entry(*other).or_insert(Expression::ZERO);
            *entry = pool.add(*entry, product);
        }
        sum.retain(|_, value| *value != Expression::ZERO);
    }
}

fn columns(sums: &[Sum; 3]) -> impl Iterator<Item = usize> + '_ {
    sums.iter().flat_map(|sum| sum.keys().copied())
}

fn coefficient(sum: &Sum, column: usize) -> Expression {
    sum.get(&column).copied().unwrap_or(Expression::ZERO)
}

fn matrix(sums: &[Sum; 3], columns: &Triple) -> [Vector; 3] {
    [0, 1, 2].map(|row| columns.map(|column| coefficient(&sums[row], column)))
}

fn images(pool: &Pool, matrix: &[Vector; 3]) -> [[Image; 3]; 3] {
    matrix.map(|row| row.map(|entry| pool.image(entry)))
}

fn transposed(matrix: &[Vector; 3]) -> [Vector; 3] {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[column][row]))
}

fn product<const N: usize>(pool: &mut Pool, a: &[Vector; N], b: &[Vector; 3]) -> [Vector; N] {
    a.map(|row| {
        [0, 1, 2].map(|column| {
            let products = [0, 1, 2].map(|k| pool.multiply(row[k], b[k][column]));
            pool.sum(&products)
        })
    })
}
