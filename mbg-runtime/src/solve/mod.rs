//! Small solves of fixed size: nonlinear loops, multipliers of constraints, and the way back onto constraints.
//!
//! Everything is bounded: the number of iterations is fixed, nothing is allocated and nothing panics. A result says
//! whether it can be trusted. Decisions (pivots, rank, damping) are taken lane by lane, so that lanes give what each
//! would give alone, as far as they run at all: a loop ends when every lane has ended. Dual numbers decide by their
//! values.

mod definite;
mod dense;
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
pub(crate) use project::{project_of_rank, ranks};
pub(crate) use rows::{Row, Rows};
pub use symmetric::Symmetric;

use crate::Real;

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

/// An order that may differ from lane to lane.
#[derive(Clone, Copy, Debug)]
struct Order<T, const K: usize> {
    /// The places that the elements came from.
    places: [T; K],
    /// The same as long as lanes do not differ, as a single one never does: looking for places takes as long as a solve.
    common: Option<[usize; K]>,
}

impl<T: Real, const K: usize> Order<T, K> {
    fn unchanged() -> Self {
        Self {
            places: core::array::from_fn(|place| T::from_f64(place as f64)),
            common: Some(core::array::from_fn(|place| place)),
        }
    }

    /// Exchanges two elements in the lanes where `first < second`.
    fn exchange(&mut self, (first, second): (T, T), i: usize, k: usize) {
        let pair = (self.places[i], self.places[k]);
        (self.places[i], self.places[k]) = exchanged(first, second, pair);
        match &mut self.common {
            Some(common) if everywhere(second - first, |by| by > 0.0) => common.swap(i, k),
            common => *common = None,
        }
    }

    /// Whether element `i` came from `place`: below zero in the lanes where it did.
    fn differs(&self, i: usize, place: usize) -> T {
        (self.places[i] - T::from_f64(place as f64)).abs() - T::from_f64(0.5)
    }

    /// Elements in this order.
    fn apply(&self, elements: &[T; K]) -> [T; K] {
        let zero = T::from_f64(0.0);
        if let Some(common) = &self.common {
            return common.map(|place| elements.get(place).copied().unwrap_or(zero));
        }
        core::array::from_fn(|i| {
            (0..K).fold(zero, |found, place| {
                self.differs(i, place)
                    .select_less(zero, elements[place], found)
            })
        })
    }

    /// Elements back in the order that they came from.
    fn undo(&self, elements: &[T; K]) -> [T; K] {
        let zero = T::from_f64(0.0);
        if let Some(common) = &self.common {
            let mut back = [zero; K];
            for (place, element) in common.iter().zip(elements) {
                back.get_mut(*place)
                    .into_iter()
                    .for_each(|it| *it = *element);
            }
            return back;
        }
        core::array::from_fn(|place| {
            (0..K).fold(zero, |found, i| {
                self.differs(i, place).select_less(zero, elements[i], found)
            })
        })
    }
}
