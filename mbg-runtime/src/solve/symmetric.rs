//! Symmetric systems, most of which are positive definite, as those of inertias.

use nalgebra::{SMatrix, SVector};

use super::definite::{Definite, Factors};
use super::dense::Regular;
use crate::Real;

/// A regular symmetric matrix as `L D Lᵀ` where its pivots in order are all positive or all negative, as they are where it is
/// positive or negative definite; otherwise as [`Regular`].
///
/// Of a definite matrix the factors are as exact as those with exchanges, whatever the units of its rows (Higham, *Accuracy and
/// Stability of Numerical Algorithms*, 2nd ed., 10.1), and no pivot is looked for. A pivot has the sign of the first
/// diagonal element when with that sign it is larger than the square root of the precision times its own diagonal element, so
/// that nothing needs to be known of the matrix beforehand. Each lane has the factors that it would have alone.
#[derive(Clone, Debug)]
pub struct Symmetric<T, const K: usize>(Factors<T, Regular<T, K>, K>);

impl<T: Real, const K: usize> Symmetric<T, K> {
    /// Factorises a matrix, of which only the elements below and on the diagonal count where it is definite.
    #[must_use]
    #[inline]
    pub fn new(matrix: SMatrix<T, K, K>) -> Self {
        let [minus, zero, one, singular] = [-1.0, 0.0, 1.0, T::SINGULAR].map(T::from_f64);
        let sign = match matrix.get((0, 0)) {
            Some(first) => first.select_less(zero, minus, one),
            None => one,
        };
        let definite = Definite::new(&matrix, sign, |element| singular * element);
        Self(Factors::of(definite, || general(matrix)))
    }

    /// The `x` of `A x = right`.
    #[must_use]
    #[inline]
    pub fn solution(&self, right: &SVector<T, K>) -> SVector<T, K> {
        self.0.solution(right, Regular::solution)
    }

    /// The same for several right sides, as many as the scalar takes [columns](crate::Columns) at once.
    #[must_use]
    #[inline]
    pub fn columns(&self, right: &[T::Columns; K]) -> [T::Columns; K] {
        self.0.columns(right, Regular::solution)
    }
}

#[cold]
#[inline(never)]
fn general<T: Real, const K: usize>(matrix: SMatrix<T, K, K>) -> Regular<T, K> {
    Regular::new(matrix)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;
    use crate::solve::lanes::{Pair, random};

    /// A positive definite matrix, with rows in units that differ by powers of ten.
    fn definite(random: &mut impl FnMut() -> f64, decades: i32) -> SMatrix<f64, 6, 6> {
        let factor = SMatrix::<f64, 6, 6>::from_fn(|_, _| random());
        let gram = factor * factor.transpose() + SMatrix::identity();
        let unit = |place: usize| 10f64.powi(decades * (place as i32 % 3));
        SMatrix::from_fn(|i, j| gram[(i, j)] * unit(i) * unit(j))
    }

    #[test]
    fn units_of_rows_do_no_harm() {
        let mut random = random();
        for decades in [0, 3, 8, -8, 50] {
            let matrix = definite(&mut random, decades);
            let x =
                SVector::from_fn(|i, _| (1.0 + i as f64) / 10f64.powi(decades * (i as i32 % 3)));
            let factors = Symmetric::new(matrix);
            assert!(matches!(factors.0, Factors::Definite(_)), "{decades}");
            let found = factors.solution(&(matrix * x));
            let error = found.zip_map(&x, |found, x| (found / x - 1.0).abs()).max();
            assert!(error < 1e-12, "{decades} {error:e}");
        }
    }

    #[test]
    fn what_is_not_definite_is_exchanged() {
        let matrix = SMatrix::from([[0.0, 2.0, 1.0], [2.0, -1.0, 0.5], [1.0, 0.5, 1e-3]]);
        let x = SVector::from([1.0, -2.0, 3.0]);
        let found = Symmetric::new(matrix).solution(&(matrix * x));
        assert!((found - x).norm() < 1e-14, "{found}");
    }

    #[test]
    fn a_negative_definite_matrix_is_not_exchanged() {
        let negative = -definite(&mut random(), 3);
        let right = SVector::from([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let factors = Symmetric::new(negative);
        assert!(matches!(factors.0, Factors::Definite(_)));
        let (found, expected) = (factors.solution(&right), Symmetric::new(-negative));
        assert_eq!(found, -expected.solution(&right));
    }

    #[test]
    fn a_singular_matrix_gives_nothing_finite() {
        let matrix: SMatrix<f64, 2, 2> = SMatrix::from([[1.0, 2.0], [2.0, 4.0]]);
        let x = Symmetric::new(matrix).solution(&SVector::from([1.0, 1.0]));
        assert!(x.iter().all(|x| !x.is_finite()), "{x}");
    }

    #[test]
    fn lanes_have_what_each_would_have_alone() {
        let mut random = random();
        let right = SVector::from([1.0, -2.0, 3.0, 0.5, 0.0, 1.0]);
        let positive = definite(&mut random, 0);
        for other in [definite(&mut random, 2), -positive] {
            let matrix = positive.zip_map(&other, |a, b| Pair([a, b]));
            let both = Symmetric::new(matrix).solution(&right.map(|it| Pair([it, it])));
            for (lane, alone) in [positive, other].into_iter().enumerate() {
                let alone = Symmetric::new(alone).solution(&right);
                assert_eq!(both.map(|it| it.0[lane]), alone);
            }
        }
    }

    #[test]
    fn slopes_are_those_of_the_inverse() {
        // x = b / a, with a second equation beside it.
        let [a, b] = [(4.0_f64, 1.0), (6.0, 5.0)].map(|(value, slope)| Dual { value, slope });
        let zero = Dual::constant(0.0);
        let matrix = SMatrix::from([[a, zero], [zero, a]]);
        let found = Symmetric::new(matrix).solution(&SVector::from([b, zero]))[0];
        assert!((found.value - 1.5).abs() < 1e-15, "{found:?}");
        assert!(
            (found.slope - (5.0 * 4.0 - 6.0) / 16.0).abs() < 1e-15,
            "{found:?}"
        );
    }
}
