//! Factors of `d I − s ∂f/∂x`: by a plan of elimination where there is one and its pivots hold, else with a search for
//! pivots.
//!
//! A plan names the elements that can differ from zero, by the pattern of the Jacobian. Models up to a few thousand
//! products have it written out, which takes a fifth of the time of a loop over it; what it needs on the way stays in
//! registers. Beyond, the loop keeps the code small. Either serves real and complex numbers alike.

use nalgebra::{SMatrix, SVector};

use super::linear::{Element, Factors};
use crate::sparsity::Elimination;
use crate::{Real, System};

/// Factors of `d I − s ∂f/∂x` of a system.
pub enum Shifted<E, const N: usize> {
    /// By a plan, written out.
    Unrolled([[E; N]; N]),
    /// By a plan.
    Planned(Planned<E, N>),
    /// With a search for pivots.
    Pivoted(Factors<E, N>),
}

impl<E: Element, const N: usize> Shifted<E, N> {
    /// Of `diagonal · I − scale · matrix`, a matrix of the system's pattern.
    #[inline(always)]
    pub fn new<S, const M: usize, const P: usize>(
        diagonal: E,
        scale: E::Part,
        matrix: &SMatrix<E::Part, N, N>,
    ) -> Self
    where
        S: System<E::Part, N, M, P>,
    {
        let entry = |row: usize, column: usize| {
            let element = E::from_part(-(scale * matrix[(row, column)]));
            if row == column {
                element + diagonal
            } else {
                element
            }
        };
        if S::UNROLLED {
            let mut rows = [[E::zero(); N]; N];
            if S::eliminate(entry, &mut rows) {
                return Self::Unrolled(rows);
            }
        } else if let Some(plan) = S::SPARSITY.and_then(|sparsity| sparsity.elimination.as_ref())
            && let Some(factors) = Planned::new(plan, entry)
        {
            return Self::Planned(factors);
        }
        Self::Pivoted(Factors::new(core::array::from_fn(|row| {
            core::array::from_fn(|column| entry(row, column))
        })))
    }

    /// The `x` of `A x = right`.
    #[inline]
    pub fn solve<S, const M: usize, const P: usize>(&self, right: [E; N]) -> [E; N]
    where
        S: System<E::Part, N, M, P>,
    {
        match self {
            Self::Unrolled(rows) => {
                let mut x = right;
                S::substitute(rows, &mut x);
                x
            }
            Self::Planned(factors) => factors.solve(right),
            Self::Pivoted(factors) => factors.solve(right),
        }
    }
}

impl<T: Real, const N: usize> Shifted<T, N> {
    /// The `x` of `A x = right`, as vectors.
    #[inline]
    pub fn solved<S, const M: usize, const P: usize>(&self, right: &SVector<T, N>) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
    {
        SVector::from(self.solve::<S, M, P>(right.data.0[0]))
    }
}

/// Largest size of a row's elements.
#[inline]
pub fn largest<E: Element, const K: usize>(row: [E; K]) -> f64 {
    row.iter()
        .fold(0.0, |largest, element| largest.max(element.size()))
}

/// Whether a pivot is not too small beside its column, by the multiplier and the largest elements of the pivot's row and
/// of the multiplier's.
///
/// Rows count as scaled to a largest element of one, so that their units do not matter. A pivot may then be smaller than
/// an element below it by the fourth root of the precision: so much of the precision elimination may lose.
#[inline]
pub fn holds<E: Element>(factor: E, pivot_row: f64, row: f64) -> bool {
    factor.size() * pivot_row * Real::sqrt(<E::Part as Real>::SINGULAR) <= row
}

/// `A = L U` by a plan, rows and columns as in `A`; the pivots' reciprocals are kept in their place.
pub struct Planned<E, const N: usize> {
    rows: [[E; N]; N],
    plan: &'static Elimination,
}

impl<E: Element, const N: usize> Planned<E, N> {
    /// Nothing where a pivot does not hold.
    fn new(plan: &'static Elimination, entry: impl Fn(usize, usize) -> E) -> Option<Self> {
        let mut rows = [[E::zero(); N]; N];
        let mut sizes = [0.0; N];
        let mut sound = true;
        for i in places(plan.order) {
            let (lower, upper) = (plan.lower[i], plan.upper[i]);
            let mut row = [E::zero(); N];
            row[i] = entry(i, i);
            let mut size = row[i].size();
            for j in places(lower).chain(places(upper)) {
                row[j] = entry(i, j);
                size = size.max(row[j].size());
            }
            for k in places(lower) {
                let above = &rows[k];
                let factor = row[k] * above[k];
                row[k] = factor;
                sound &= holds(factor, sizes[k], size);
                for j in places(plan.upper[k]) {
                    row[j] = row[j].less(factor, above[j]);
                }
            }
            row[i] = row[i].reciprocal();
            (rows[i], sizes[i]) = (row, size);
        }
        sound.then_some(Self { rows, plan })
    }

    fn solve(&self, right: [E; N]) -> [E; N] {
        let Self { rows, plan } = self;
        let mut x = right;
        for i in places(plan.order) {
            let terms = places(plan.lower[i]);
            x[i] = terms.fold(x[i], |rest, j| rest.less(rows[i][j], x[j]));
        }
        for i in places(plan.order).rev() {
            let terms = places(plan.upper[i]);
            x[i] = terms.fold(x[i], |rest, j| rest.less(rows[i][j], x[j])) * rows[i][i];
        }
        x
    }
}

/// Numbers of states as indices.
fn places(states: &'static [u16]) -> impl DoubleEndedIterator<Item = usize> {
    states.iter().map(|state| usize::from(*state))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::lanes::random;
    use std::boxed::Box;
    use std::vec::Vec;

    const N: usize = 12;
    type Filled = [[bool; N]; N];

    /// The plan in the order of the states.
    fn plan(mut filled: Filled) -> &'static Elimination {
        for pivot in 0..N {
            let above = filled[pivot];
            for row in filled.iter_mut().skip(pivot + 1).filter(|row| row[pivot]) {
                for column in pivot..N {
                    row[column] |= above[column];
                }
            }
        }
        let rows = |right: bool| -> &'static [&'static [u16]] {
            let row = |row: usize| -> &'static [u16] {
                let columns = (0..N).filter(|column| *column != row && (*column > row) == right);
                let found = columns.filter(|column| filled[row][*column]);
                found.map(|column| column as u16).collect::<Vec<_>>().leak()
            };
            (0..N).map(row).collect::<Vec<_>>().leak()
        };
        Box::leak(Box::new(Elimination {
            order: (0..N as u16).collect::<Vec<_>>().leak(),
            lower: rows(false),
            upper: rows(true),
        }))
    }

    #[test]
    fn plans_of_random_patterns_solve_as_pivots_do() {
        let mut random = random();
        for _ in 0..100 {
            let filled: Filled = core::array::from_fn(|_| core::array::from_fn(|_| random() > 0.5));
            let mut matrix = [[0.0; N]; N];
            for (row, entries) in matrix.iter_mut().enumerate() {
                for (column, entry) in entries.iter_mut().enumerate() {
                    if row == column || filled[row][column] {
                        *entry = random() + if row == column { 8.0 } else { 0.0 };
                    }
                }
            }
            let right: [f64; N] = core::array::from_fn(|_| random());
            let found = Planned::new(plan(filled), |row, column| matrix[row][column]);
            let found = found.unwrap().solve(right);
            for (found, dense) in found.iter().zip(Factors::new(matrix).solve(right)) {
                assert!((found - dense).abs() < 1e-13, "{found} {dense}");
            }
        }
    }

    #[test]
    fn a_small_pivot_does_not_hold_whatever_the_units() {
        let filled = [[true; N]; N];
        for unit in [1e-12, 1.0, 1e12] {
            let entry = |pivot: f64| {
                move |row: usize, column: usize| match (row, column) {
                    (0, 0) => unit * pivot,
                    (0, _) => unit,
                    (row, column) if row == column => 20.0,
                    _ => 1.0,
                }
            };
            assert!(Planned::<f64, N>::new(plan(filled), entry(1.0)).is_some());
            assert!(Planned::<f64, N>::new(plan(filled), entry(1e-6)).is_none());
            assert!(Planned::<f64, N>::new(plan(filled), entry(0.0)).is_none());
        }
    }
}
