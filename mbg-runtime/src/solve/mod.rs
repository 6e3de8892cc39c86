//! Small solves of fixed size: nonlinear loops, multipliers of constraints, and the way back onto constraints.
//!
//! Everything is bounded: the number of iterations is fixed, nothing is allocated and nothing panics. A result says
//! whether it can be trusted. Decisions (pivots, rank, damping) are taken lane by lane, so that lanes give what each
//! would give alone, as far as they run at all: a loop ends when every lane has ended. Dual numbers decide by their
//! values.

mod definite;
mod dense;
mod flags;
#[cfg(test)]
pub(crate) mod lanes;
mod least_norm;
mod memory;
mod newton;
mod project;
mod rows;
mod symmetric;

pub use dense::Regular;
pub use least_norm::{LeastNorm, Semidefinite, least_norm};
pub use memory::{LoopMemory, Memory, Outcome};
pub use newton::{ITERATIONS, Solved, newton};
pub use project::{Projected, project, project_velocity};
pub(crate) use project::{project_from, ranks};
pub(crate) use rows::{Row, Rows, Sizes};
pub use symmetric::Symmetric;

use crate::{Columns, Real};

/// Whether a property holds in every lane.
fn everywhere<T: Real>(number: T, holds: impl Fn(f64) -> bool) -> bool {
    number.find(|lane| !holds(lane)).is_none()
}

/// Largest absolute value of all lanes; NaN when one is.
fn largest<T: Real>(numbers: impl IntoIterator<Item = T>) -> T {
    numbers
        .into_iter()
        .fold(T::from_f64(0.0), |largest, number| {
            largest.max(number.abs())
        })
}

/// `Σ aᵢ bᵢ`.
fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter()
        .zip(b)
        .fold(T::from_f64(0.0), |sum, (a, b)| sum + *a * *b)
}

/// Two numbers, exchanged in the lanes where `first < second`.
fn exchanged<T: Real>(first: T, second: T, (a, b): (T, T)) -> (T, T) {
    (
        first.select_less(second, b, a),
        first.select_less(second, a, b),
    )
}

/// An order that may differ from lane to lane: the places that the elements came from.
#[derive(Clone, Copy, Debug)]
struct Order<T, const K: usize>([T; K]);

impl<T: Real, const K: usize> Order<T, K> {
    fn unchanged() -> Self {
        Self(core::array::from_fn(|place| T::from_f64(place as f64)))
    }

    /// Exchanges two elements in the lanes where `first < second`.
    fn exchange(&mut self, (first, second): (T, T), i: usize, k: usize) {
        (self.0[i], self.0[k]) = exchanged(first, second, (self.0[i], self.0[k]));
    }

    /// Whether element `i` came from `place`: below zero in the lanes where it did.
    fn differs(&self, i: usize, place: usize) -> T {
        (self.0[i] - T::from_f64(place as f64)).abs() - T::from_f64(0.5)
    }

    /// Elements in this order.
    fn apply<X: Columns<T>>(&self, elements: &[X; K]) -> [X; K] {
        let zero = X::from_f64(0.0);
        core::array::from_fn(|i| {
            (0..K).fold(zero, |found, place| {
                X::whole(self.differs(i, place)).select_less(zero, elements[place], found)
            })
        })
    }

    /// Elements back in the order that they came from.
    fn undo(&self, elements: &[T; K]) -> [T; K] {
        let zero = T::from_f64(0.0);
        core::array::from_fn(|place| {
            (0..K).fold(zero, |found, i| {
                self.differs(i, place).select_less(zero, elements[i], found)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector};

    use super::*;

    type Right = [<f64 as Real>::Columns; 3];

    #[test]
    fn each_of_several_right_sides_has_the_solution_that_it_has_alone() {
        let mut random = lanes::random();
        let mut drawn = || <<f64 as Real>::Columns as Columns<f64>>::from_columns(|_| random());
        let right: Right = core::array::from_fn(|_| drawn());
        let check = |columns: Right, alone: &dyn Fn(&SVector<f64, 3>) -> SVector<f64, 3>| {
            for column in 0..<<f64 as Real>::Columns as Columns<f64>>::COUNT {
                let of = |it: &Right| SVector::from(it.map(|row| row.as_columns()[column]));
                assert_eq!(of(&columns), alone(&of(&right)), "{column}");
            }
        };
        let definite = SMatrix::from([[3.0, 1.0, 0.5], [1.0, 2.0, -0.4], [0.5, -0.4, 1.0]]);
        let mixed = SMatrix::from([[0.0, 1.0, 0.5], [1.0, 2.0, -0.4], [0.5, -0.4, -1.0]]);
        let twice = SMatrix::from([[1.0, 1.0, 0.5], [1.0, 1.0, 0.5], [0.5, 0.5, 1.0]]);
        for matrix in [definite, -definite, mixed] {
            let factors = Symmetric::new(matrix);
            check(factors.columns(&right), &|right| factors.solution(right));
            let factors = Regular::new(matrix);
            check(factors.columns(&right), &|right| factors.solution(right));
        }
        for matrix in [definite, twice] {
            let factors = Semidefinite::new(matrix);
            check(factors.columns(&right), &|right| factors.solution(right));
        }
    }
}
