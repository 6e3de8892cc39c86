//! How mass is distributed in a frame.

use super::tensor::Vector;
use crate::symbolic::{Expression, Pool};

/// Mass, first moment and moment of inertia about the origin of a frame, in its axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Distribution {
    pub(super) mass: Expression,
    pub(super) first: Vector,
    pub(super) second: [Vector; 3],
}

impl Distribution {
    /// A thin rod on an axis through the origin, whose direction is a unit vector: its first moment along the axis, and
    /// the moment of inertia across it.
    pub(super) fn rod(
        pool: &mut Pool,
        axis: &Vector,
        mass: Expression,
        first: Expression,
        across: Expression,
    ) -> Self {
        let mut second = [[Expression::ZERO; 3]; 3];
        for (row, entries) in second.iter_mut().enumerate() {
            for (column, entry) in entries.iter_mut().enumerate() {
                let product = pool.multiply(axis[row], axis[column]);
                let part = pool.subtract(unit(row, column), product);
                *entry = pool.multiply(across, part);
            }
        }
        Self {
            mass,
            first: axis.map(|part| pool.multiply(first, part)),
            second,
        }
    }

    /// The same in a frame in which the origin is somewhere else.
    pub(super) fn moved(&self, pool: &mut Pool, to: &Vector) -> Self {
        let mut moved = *self;
        let twice = pool.integer(2);
        let along = dot(pool, &self.first, to);
        let along = pool.multiply(twice, along);
        let square = dot(pool, to, to);
        let square = pool.multiply(self.mass, square);
        let trace = pool.add(along, square);
        for row in 0..3 {
            let shift = pool.multiply(self.mass, to[row]);
            moved.first[row] = pool.add(self.first[row], shift);
            for column in 0..3 {
                let whole = pool.multiply(unit(row, column), trace);
                let there = pool.multiply(moved.first[row], to[column]);
                let back = pool.multiply(to[row], self.first[column]);
                let parts = [
                    self.second[row][column],
                    whole,
                    there.negated(),
                    back.negated(),
                ];
                moved.second[row][column] = pool.sum(&parts);
            }
        }
        moved
    }

    /// The second moment along an axis, `½ tr(J) − J_xx` for x.
    pub(super) fn along(&self, pool: &mut Pool, axis: usize) -> Expression {
        let [own, next, last] = [0, 1, 2].map(|k| self.second[(axis + k) % 3][(axis + k) % 3]);
        let parts = [next, last, own.negated()];
        let double = pool.sum(&parts);
        let two = pool.integer(2);
        pool.divide(double, two).unwrap_or(Expression::ZERO)
    }

    pub(super) fn without_mass(&self) -> Self {
        Self {
            mass: Expression::ZERO,
            ..*self
        }
    }

    /// How many products its forces and moments take of the motion of its frame, as `Tensor` has them.
    pub(super) fn products(&self, pool: &mut Pool) -> usize {
        let count = |values: &[Expression]| {
            let free = [Expression::ZERO, Expression::ONE];
            let paid = values.iter().filter(|it| !free.contains(&it.magnitude()));
            paid.count()
        };
        let along = [0, 1, 2].map(|axis| self.along(pool, axis));
        let [[_, xy, zx], [_, _, yz], _] = self.second;
        3 * count(&[self.mass])
            + 5 * count(&self.first)
            + 2 * count(&along)
            + 3 * count(&[xy, yz, zx])
    }

    /// Both together.
    pub(super) fn plus(&self, pool: &mut Pool, other: &Self) -> Self {
        self.with(other, &mut |a, b| pool.add(a, b))
    }

    /// What is left without another.
    pub(super) fn minus(&self, pool: &mut Pool, other: &Self) -> Self {
        self.with(other, &mut |a, b| pool.subtract(a, b))
    }

    fn with(
        &self,
        other: &Self,
        operation: &mut dyn FnMut(Expression, Expression) -> Expression,
    ) -> Self {
        let mut vector = |a: &Vector, b: &Vector| [0, 1, 2].map(|k| operation(a[k], b[k]));
        Self {
            first: vector(&self.first, &other.first),
            second: [0, 1, 2].map(|k| vector(&self.second[k], &other.second[k])),
            mass: operation(self.mass, other.mass),
        }
    }
}

fn unit(row: usize, column: usize) -> Expression {
    if row == column {
        Expression::ONE
    } else {
        Expression::ZERO
    }
}

fn dot(pool: &mut Pool, a: &Vector, b: &Vector) -> Expression {
    let products = [0, 1, 2].map(|k| pool.multiply(a[k], b[k]));
    pool.sum(&products)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Symbol;

    fn symbols(pool: &mut Pool, first: usize) -> Vector {
        [0, 1, 2].map(|k| pool.symbol(Symbol::Parameter(first + k)))
    }

    /// Masses at points.
    fn of_points(pool: &mut Pool, points: &[(Expression, Vector)]) -> Distribution {
        let nothing = Distribution {
            mass: Expression::ZERO,
            first: [Expression::ZERO; 3],
            second: [[Expression::ZERO; 3]; 3],
        };
        points.iter().fold(nothing, |sum, (mass, place)| {
            let square = dot(pool, place, place);
            let entry = |pool: &mut Pool, row: usize, column: usize| {
                let whole = pool.multiply(unit(row, column), square);
                let product = pool.multiply(place[row], place[column]);
                let arm = pool.subtract(whole, product);
                pool.multiply(*mass, arm)
            };
            let point = Distribution {
                mass: *mass,
                first: place.map(|part| pool.multiply(*mass, part)),
                second: [0, 1, 2].map(|row| [0, 1, 2].map(|column| entry(pool, row, column))),
            };
            sum.plus(pool, &point)
        })
    }

    /// The pool finds what is equal, so that these are equalities of functions.
    #[test]
    fn a_distribution_is_the_sum_over_its_points_wherever_the_origin_is() {
        let mut pool = Pool::new();
        let pool = &mut pool;
        let masses = symbols(pool, 0);
        let to = symbols(pool, 3);
        let places = [6, 9, 12].map(|first| symbols(pool, first));
        let shifted = places.map(|place| [0, 1, 2].map(|k| pool.add(place[k], to[k])));
        let points = |places: [Vector; 3]| Vec::from_iter(masses.into_iter().zip(places));
        let (here, there) = (
            of_points(pool, &points(places)),
            of_points(pool, &points(shifted)),
        );
        assert_eq!(here.moved(pool, &to), there);
        assert_eq!(there.minus(pool, &here).plus(pool, &here), there);
    }

    /// Of two masses on an axis.
    #[test]
    fn a_rod_is_what_lies_on_its_axis() {
        let mut pool = Pool::new();
        let pool = &mut pool;
        let [mass, other, _] = symbols(pool, 0);
        let [length, reach, _] = symbols(pool, 3);
        let axis = [Expression::ZERO, Expression::ONE, Expression::ZERO];
        let at = |pool: &mut Pool, length| axis.map(|part| pool.multiply(part, length));
        let places = [at(pool, length), at(pool, reach)];
        let points = of_points(pool, &[(mass, places[0]), (other, places[1])]);
        let rod = Distribution::rod(
            pool,
            &axis,
            points.mass,
            points.first[1],
            points.second[0][0],
        );
        assert_eq!(rod, points);
        assert_eq!(rod.along(pool, 1), rod.second[0][0]);
        assert_eq!([0, 2].map(|it| rod.along(pool, it)), [Expression::ZERO; 2]);
    }

    #[test]
    fn what_has_fewer_numbers_takes_fewer_products() {
        let mut pool = Pool::new();
        let pool = &mut pool;
        let [mass, first, across] = symbols(pool, 0);
        let axis = [Expression::ZERO, Expression::ONE, Expression::ZERO];
        let rod = Distribution::rod(pool, &axis, mass, first, across);
        assert_eq!(rod.products(pool), 3 + 5 + 2);
        let light = Distribution::rod(pool, &axis, Expression::ONE, Expression::ZERO, across);
        assert_eq!(light.products(pool), 2);
        let places = [3, 6].map(|first| symbols(pool, first));
        let general = of_points(pool, &[(mass, places[0]), (first, places[1])]);
        assert_eq!(general.products(pool), 3 + 15 + 6 + 9);
        assert_eq!(general.without_mass().products(pool), 15 + 6 + 9);
    }
}
