//! Factors of `d I − s J`: by a plan of elimination where there is one and its pivots hold, else with a search for pivots.
//!
//! A plan names the elements that can differ from zero, so that a small loop runs over them and over nothing else. It is
//! the same for real and complex numbers and needs no code of its own in a model.

use nalgebra::{SMatrix, SVector};

use super::linear::{Element, Factors};
use crate::sparsity::Elimination;
use crate::{Real, Sparsity};

/// Factors of `d I − s J`.
pub enum Shifted<E, const N: usize> {
    /// By a plan.
    Planned(Planned<E, N>),
    /// With a search for pivots.
    Pivoted(Factors<E, N>),
}

impl<E: Element, const N: usize> Shifted<E, N> {
    /// Of `diagonal · I − scale · matrix`, a matrix of this pattern.
    #[inline]
    pub fn new(
        sparsity: Option<&'static Sparsity>,
        diagonal: E,
        scale: E::Part,
        matrix: &SMatrix<E::Part, N, N>,
    ) -> Self {
        let plan = sparsity.and_then(|sparsity| sparsity.elimination.as_ref());
        match plan.and_then(|plan| Planned::new(plan, diagonal, scale, matrix)) {
            Some(factors) => Self::Planned(factors),
            None => Self::Pivoted(Factors::shifted(diagonal, scale, matrix)),
        }
    }

    /// The `x` of `A x = right`.
    #[inline]
    pub fn solve(&self, right: [E; N]) -> [E; N] {
        match self {
            Self::Planned(factors) => factors.solve(right),
            Self::Pivoted(factors) => factors.solve(right),
        }
    }
}

impl<T: Real, const N: usize> Shifted<T, N> {
    /// The `x` of `A x = right`, as vectors.
    #[inline]
    pub fn solved(&self, right: &SVector<T, N>) -> SVector<T, N> {
        SVector::from(self.solve(right.data.0[0]))
    }
}

/// `A = L U` by a plan, rows and columns as in `A`; the pivots' reciprocals are kept in their place.
pub struct Planned<E, const N: usize> {
    rows: [[E; N]; N],
    plan: &'static Elimination,
}

impl<E: Element, const N: usize> Planned<E, N> {
    /// Nothing where a pivot is too small beside its column.
    ///
    /// Rows count as scaled to a largest element of one, so that their units do not matter. A pivot may then be smaller
    /// than an element below it by the fourth root of the precision: so much of the precision elimination may lose.
    fn new(
        plan: &'static Elimination,
        diagonal: E,
        scale: E::Part,
        matrix: &SMatrix<E::Part, N, N>,
    ) -> Option<Self> {
        let smallest = Real::sqrt(<E::Part as Real>::SINGULAR);
        let zero = E::from_part(E::Part::from_f64(0.0));
        let mut rows = [[zero; N]; N];
        let mut sizes = [0.0; N];
        let mut holds = true;
        for i in places(plan.order) {
            let (lower, upper) = (plan.lower[i], plan.upper[i]);
            let mut row = [zero; N];
            row[i] = diagonal - E::from_part(scale * matrix[(i, i)]);
            let mut size = row[i].size();
            for j in places(lower).chain(places(upper)) {
                row[j] = E::from_part(-(scale * matrix[(i, j)]));
                size = size.max(row[j].size());
            }
            for k in places(lower) {
                let above = &rows[k];
                let factor = row[k] * above[k];
                row[k] = factor;
                holds &= factor.size() * sizes[k] * smallest <= size;
                for j in places(plan.upper[k]) {
                    row[j] = row[j] - factor * above[j];
                }
            }
            row[i] = row[i].reciprocal();
            (rows[i], sizes[i]) = (row, size);
        }
        holds.then_some(Self { rows, plan })
    }

    fn solve(&self, right: [E; N]) -> [E; N] {
        let Self { rows, plan } = self;
        let mut x = right;
        for i in places(plan.order) {
            let terms = places(plan.lower[i]);
            x[i] = terms.fold(x[i], |rest, j| rest - rows[i][j] * x[j]);
        }
        for i in places(plan.order).rev() {
            let terms = places(plan.upper[i]);
            x[i] = terms.fold(x[i], |rest, j| rest - rows[i][j] * x[j]) * rows[i][i];
        }
        x
    }
}

/// Numbers of states as indices.
fn places(states: &'static [u16]) -> impl DoubleEndedIterator<Item = usize> {
    states.iter().map(|state| usize::from(*state))
}
