//! Symmetric definite systems that are far from singular: short code without exchanges, and other factors where they are not.

use nalgebra::{SMatrix, SVector};

use super::everywhere;
use crate::{Columns, Real};

/// `L D Lᵀ` of a symmetric matrix.
#[derive(Clone, Debug)]
pub(super) struct Definite<T, const K: usize> {
    /// `L` below the diagonal, the reciprocals of `D` on it.
    lower: [[T; K]; K],
    /// 1 in the lanes that are regular, else 0. In the others the factors mean nothing.
    regular: T,
}

impl<T: Real, const K: usize> Definite<T, K> {
    /// Regular are lanes in which each pivot is above a bound for its diagonal element, both by this sign: one or minus one.
    #[inline]
    pub(super) fn new(matrix: &SMatrix<T, K, K>, sign: T, bound: impl Fn(T) -> T) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let mut lower = matrix.transpose().data.0;
        let mut regular = one;
        for k in 0..K {
            let (diagonal, pivot) = (sign * matrix[(k, k)], sign * lower[k][k]);
            regular = bound(diagonal).select_less(pivot, regular, zero);
            let inverse = one / lower[k][k];
            lower[k][k] = inverse;
            for i in k + 1..K {
                // The rows from i on still hold L D in column k, those above already L.
                let (above, rest) = lower.split_at_mut(i);
                let row = &mut rest[0];
                let (other, factor) = (-row[k], row[k] * inverse);
                for j in k + 1..i {
                    row[j] = other.multiply_add(above[j][k], row[j]);
                }
                row[i] = other.multiply_add(factor, row[i]);
                row[k] = factor;
            }
        }
        Self { lower, regular }
    }

    #[inline]
    fn solve<X: Columns<T>>(&self, right: [X; K]) -> [X; K] {
        let lower = |row: usize, column: usize| X::whole(self.lower[row][column]);
        let mut x = right;
        for i in 0..K {
            for k in 0..i {
                x[i] = (-lower(i, k)).multiply_add(x[k], x[i]);
            }
        }
        for (i, x) in x.iter_mut().enumerate() {
            *x = *x * lower(i, i);
        }
        for k in (0..K).rev() {
            for i in 0..k {
                x[i] = (-lower(k, i)).multiply_add(x[k], x[i]);
            }
        }
        x
    }
}

/// Of a matrix of which every lane, no lane or some lanes are regular as [`Definite`] tells.
#[derive(Clone, Debug)]
pub(super) enum Factors<T, Other, const K: usize> {
    Definite(Definite<T, K>),
    Other(Other),
    Both(Definite<T, K>, Other),
}

impl<T: Real, Other, const K: usize> Factors<T, Other, K> {
    /// With others for what is not regular.
    ///
    /// Left to itself a compiler keeps both kinds in memory where one of two rows takes less time than that.
    #[inline(always)]
    pub(super) fn of(definite: Definite<T, K>, other: impl FnOnce() -> Other) -> Self {
        let all_are = |flag| everywhere(definite.regular, |it| it == flag);
        if all_are(1.0) {
            Self::Definite(definite)
        } else if all_are(0.0) {
            Self::Other(other())
        } else {
            Self::Both(definite, other())
        }
    }

    /// The solution, in each lane by its factors.
    #[inline(always)]
    pub(super) fn solution(
        &self,
        right: &SVector<T, K>,
        by_other: impl Fn(&Other, &SVector<T, K>) -> SVector<T, K>,
    ) -> SVector<T, K> {
        match self {
            Self::Definite(definite) => SVector::from(definite.solve(right.data.0[0])),
            Self::Other(other) => by_other(other, right),
            Self::Both(definite, other) => {
                let half = T::from_f64(0.5);
                let own = SVector::from(definite.solve(right.data.0[0]));
                by_other(other, right).zip_map(&own, |other, own| {
                    definite.regular.select_less(half, other, own)
                })
            }
        }
    }

    /// The solutions for several right sides, one after the other where not all lanes are regular.
    #[inline(always)]
    pub(super) fn columns(
        &self,
        right: &[T::Columns; K],
        by_other: impl Fn(&Other, &SVector<T, K>) -> SVector<T, K>,
    ) -> [T::Columns; K] {
        match self {
            Self::Definite(definite) => definite.solve(*right),
            _ => one_by_one(right, |right| self.solution(right, &by_other)),
        }
    }
}

/// Solutions for several right sides, one after the other.
#[cold]
#[inline(never)]
fn one_by_one<T: Real, const K: usize>(
    right: &[T::Columns; K],
    solution: impl Fn(&SVector<T, K>) -> SVector<T, K>,
) -> [T::Columns; K] {
    let mut solved = *right;
    for column in 0..<T::Columns as Columns<T>>::COUNT {
        let values = solution(&SVector::from_fn(|row, _| right[row].as_columns()[column]));
        for (solved, value) in solved.iter_mut().zip(values.iter()) {
            let before = *solved;
            *solved = Columns::<T>::from_columns(|other| {
                if other == column {
                    *value
                } else {
                    before.as_columns()[other]
                }
            });
        }
    }
    solved
}
