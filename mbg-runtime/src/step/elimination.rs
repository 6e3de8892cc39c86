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
#[derive(Clone, Copy)]
pub struct Shifted<E, const N: usize> {
    /// In its rows also those by a plan.
    factors: Factors<E, N>,
    planned: bool,
}

impl<E: Element, const N: usize> Shifted<E, N> {
    /// Nothing yet.
    #[inline(always)]
    pub fn empty() -> Self {
        Self {
            factors: Factors::empty(),
            planned: false,
        }
    }

    /// Of `diagonal · I − scale · matrix`, a matrix of the system's pattern.
    #[inline(never)]
    pub fn new<S, const M: usize, const P: usize>(
        diagonal: E,
        scale: E::Part,
        matrix: &SMatrix<E::Part, N, N>,
    ) -> Self
    where
        S: System<E::Part, N, M, P>,
    {
        let mut shifted = Self::empty();
        shifted.factorise::<S, M, P>(diagonal, scale, matrix);
        shifted
    }

    /// The same in the place of what has been before: nothing is copied.
    #[inline(always)]
    pub fn factorise<S, const M: usize, const P: usize>(
        &mut self,
        diagonal: E,
        scale: E::Part,
        matrix: &SMatrix<E::Part, N, N>,
    ) where
        S: System<E::Part, N, M, P>,
    {
        let zero = E::Part::from_f64(0.0);
        let entry = |row: usize, column: usize| {
            // Where this is not written out, a check of the place stays: it must not panic.
            let element = matrix.get((row, column)).copied().unwrap_or(zero);
            let element = E::from_part(-(scale * element));
            if row == column {
                element + diagonal
            } else {
                element
            }
        };
        let rows = &mut self.factors.rows;
        self.planned = match plan::<S, E::Part, N, M, P>() {
            Some(_) if S::UNROLLED => S::eliminate(entry, rows),
            Some(plan) => eliminate(plan, entry, rows),
            None => false,
        };
        if !self.planned {
            self.factors.factorise(entry);
        }
    }

    /// Whether they are by the system's plan.
    pub fn is_planned(&self) -> bool {
        self.planned
    }

    /// The `x` of `A x = right`.
    #[inline]
    pub fn solve<S, const M: usize, const P: usize>(&self, right: [E; N]) -> [E; N]
    where
        S: System<E::Part, N, M, P>,
    {
        // Asked first for the plan, so that of a model without one nothing is asked.
        match plan::<S, E::Part, N, M, P>() {
            Some(plan) if self.planned => {
                let mut x = right;
                if S::UNROLLED {
                    S::substitute(&self.factors.rows, &mut x);
                } else {
                    substitute(plan, &self.factors.rows, &mut x);
                }
                x
            }
            _ => self.factors.solve(right),
        }
    }
}

/// The system's plan of elimination.
#[inline(always)]
fn plan<S, T, const N: usize, const M: usize, const P: usize>() -> Option<&'static Elimination>
where
    S: System<T, N, M, P>,
    T: Real,
{
    const {
        match S::SPARSITY {
            Some(sparsity) => sparsity.elimination.as_ref(),
            None => None,
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

/// `A = L U` by a plan, rows and columns as in `A`; the pivots' reciprocals are kept in their place. Whether all pivots
/// hold.
fn eliminate<E: Element, const N: usize>(
    plan: &Elimination,
    entry: impl Fn(usize, usize) -> E,
    rows: &mut [[E; N]; N],
) -> bool {
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
    sound
}

/// A solution by the factors of a plan.
fn substitute<E: Element, const N: usize>(plan: &Elimination, rows: &[[E; N]; N], x: &mut [E; N]) {
    for i in places(plan.order) {
        let terms = places(plan.lower[i]);
        x[i] = terms.fold(x[i], |rest, j| rest.less(rows[i][j], x[j]));
    }
    for i in places(plan.order).rev() {
        let terms = places(plan.upper[i]);
        x[i] = terms.fold(x[i], |rest, j| rest.less(rows[i][j], x[j])) * rows[i][i];
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
            let entry = |row: usize, column: usize| matrix[row][column];
            let plan = plan(filled);
            let mut rows = [[0.0; N]; N];
            assert!(eliminate(plan, entry, &mut rows));
            let mut found = right;
            substitute(plan, &rows, &mut found);
            let mut factors = Factors::empty();
            factors.factorise(entry);
            for (found, dense) in found.iter().zip(factors.solve(right)) {
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
            let holds = |pivot: f64| eliminate(plan(filled), entry(pivot), &mut [[0.0; N]; N]);
            assert!(holds(1.0));
            assert!(!holds(1e-6));
            assert!(!holds(0.0));
        }
    }
}
