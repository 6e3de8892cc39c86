//! Inertial forces of a rigid body by one tensor.
//!
//! In axes that turn at the rate ω, itself changing at the rate α, what is at r has the acceleration `B r` more than the
//! origin, with `B = [α×] + [ω×][ω×]`. A moment of inertia J resists turning with `J α + ω × J ω`, the sum of `r × B r`
//! over all mass, which takes fewer products of `B` and of `S = ½ tr(J) 1 − J` than of J. All arms and moments of a body
//! share `B`: Balafoutis, Patel and Misra, *IEEE Journal of Robotics and Automation* 4 (1988), 665–676.

use crate::symbolic::{Expression, Pool};

pub(super) type Vector = [Expression; 3];

/// `B`. Its entries are worked out as they are asked for; the pool knows them again.
pub(super) struct Tensor {
    pub(super) omega: Vector,
    pub(super) alpha: Vector,
}

impl Tensor {
    /// A component of `B r`.
    pub(super) fn acceleration(
        &self,
        pool: &mut Pool,
        component: usize,
        arm: &Vector,
    ) -> Expression {
        let mut sum = Expression::ZERO;
        for (column, length) in arm.iter().enumerate() {
            if *length != Expression::ZERO {
                let entry = self.entry(pool, component, column);
                let product = pool.multiply(entry, *length);
                sum = pool.add(sum, product);
            }
        }
        sum
    }

    /// The component about axis x of `J α + ω × J ω`, whichever axis that is:
    ///
    /// `S_yy B_zy − S_zz B_yz + J_xz B_yx − J_xy B_zx + J_yz (ω_y² − ω_z²)`.
    pub(super) fn moment(&self, pool: &mut Pool, x: usize, inertia: &[Vector; 3]) -> Expression {
        let [y, z] = others(x);
        let mut sum = self.along_axes(pool, x, inertia);
        for (row, column, is_added) in [(y, z, true), (z, y, false)] {
            let product = inertia[x][column];
            if product != Expression::ZERO {
                let entry = self.entry(pool, row, x).flipped(!is_added);
                let term = pool.multiply(product, entry);
                sum = pool.add(sum, term);
            }
        }
        if inertia[y][z] != Expression::ZERO {
            let [first, second] = [y, z].map(|axis| self.square(pool, axis));
            let difference = pool.subtract(first, second);
            let term = pool.multiply(inertia[y][z], difference);
            sum = pool.add(sum, term);
        }
        sum
    }

    /// `S_yy B_zy − S_zz B_yz`, of which `J_xx α_x` is left where both are equal.
    fn along_axes(&self, pool: &mut Pool, x: usize, inertia: &[Vector; 3]) -> Expression {
        let [y, z] = others(x);
        let [first, second] = [(y, z), (z, y)].map(|(own, other)| {
            let sum = pool.add(inertia[x][x], inertia[other][other]);
            let double = pool.subtract(sum, inertia[own][own]);
            let two = pool.integer(2);
            pool.divide(double, two).unwrap_or(Expression::ZERO)
        });
        if first == second {
            return pool.multiply(inertia[x][x], self.alpha[x]);
        }
        let [up, down] = [(z, y), (y, z)].map(|(row, column)| self.entry(pool, row, column));
        let (up, down) = (pool.multiply(first, up), pool.multiply(second, down));
        pool.subtract(up, down)
    }

    fn entry(&self, pool: &mut Pool, row: usize, column: usize) -> Expression {
        let [next, last] = others(row);
        if row == column {
            let squares = [next, last].map(|axis| self.square(pool, axis));
            return pool.sum(&squares).negated();
        }
        let product = pool.multiply(self.omega[row], self.omega[column]);
        if column == next {
            pool.subtract(product, self.alpha[last])
        } else {
            pool.add(product, self.alpha[next])
        }
    }

    fn square(&self, pool: &mut Pool, axis: usize) -> Expression {
        pool.multiply(self.omega[axis], self.omega[axis])
    }
}

/// The axes with which one makes a right hand.
fn others(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Symbol;

    fn cross(pool: &mut Pool, a: &Vector, b: &Vector) -> Vector {
        [0, 1, 2].map(|x| {
            let [y, z] = others(x);
            let (first, second) = (pool.multiply(a[y], b[z]), pool.multiply(a[z], b[y]));
            pool.subtract(first, second)
        })
    }

    fn states(pool: &mut Pool, first: usize) -> Vector {
        [0, 1, 2].map(|k| pool.symbol(Symbol::State(first + k)))
    }

    /// The pool finds what is equal, so that these are equalities of functions.
    #[test]
    fn arms_and_moments_are_those_of_the_vectors() {
        let mut pool = Pool::new();
        let pool = &mut pool;
        let (omega, alpha) = (states(pool, 0), states(pool, 3));
        let tensor = Tensor { omega, alpha };
        let arm = states(pool, 6);
        let (turned, changed) = (cross(pool, &omega, &arm), cross(pool, &alpha, &arm));
        let inward = cross(pool, &omega, &turned);
        let [xx, yy, zz] = states(pool, 9);
        let [xy, yz, zx] = states(pool, 12);
        for inertia in [
            [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]],
            [[xx, xy, zx], [xy, yy, yz], [zx, yz, yy]],
        ] {
            let along = |pool: &mut Pool, vector: &Vector| {
                inertia.map(|row| {
                    let products = [0, 1, 2].map(|k| pool.multiply(row[k], vector[k]));
                    pool.sum(&products)
                })
            };
            let momentum = along(pool, &omega);
            let (straight, turning) = (along(pool, &alpha), cross(pool, &omega, &momentum));
            for k in 0..3 {
                let expected = pool.add(straight[k], turning[k]);
                assert_eq!(tensor.moment(pool, k, &inertia), expected);
                let expected = pool.add(changed[k], inward[k]);
                assert_eq!(tensor.acceleration(pool, k, &arm), expected);
            }
        }
    }
}
