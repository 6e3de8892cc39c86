//! Gaussian elimination with partial pivoting.

use nalgebra::{SMatrix, SVector};

use super::{Order, dot, everywhere, exchanged, largest};
use crate::{Columns, Real};

/// A square matrix as `P D A = L U`: rows scaled by `D` to a largest element of one, then exchanged by `P` so that no
/// multiplier in `L` exceeds one (Golub and Van Loan, *Matrix Computations*, 4th ed., 3.4.1 and 3.5.2).
///
/// The scaling makes the pivots independent of the units of the rows, and each lane has its own. Steps of implicit methods
/// have factors without either, which may be complex. Of a singular matrix the solutions are not finite.
#[derive(Clone, Debug)]
pub struct Regular<T, const K: usize> {
    /// `U` above the diagonal, its reciprocals on it, `L` without its unit diagonal below.
    rows: [[T; K]; K],
    scale: [T; K],
    order: Order<T, K>,
}

impl<T: Real, const K: usize> Regular<T, K> {
    /// Factorises a matrix.
    #[must_use]
    pub fn new(matrix: SMatrix<T, K, K>) -> Self {
        let mut rows = matrix.transpose().data.0;
        let mut scale = [T::from_f64(1.0); K];
        for (row, scale) in rows.iter_mut().zip(&mut scale) {
            *scale = *scale / largest(*row);
            row.iter_mut()
                .for_each(|element| *element = *element * *scale);
        }
        let mut order = Order::unchanged();
        for k in 0..K {
            for i in k + 1..K {
                let sizes = (rows[k][k].abs(), rows[i][k].abs());
                if everywhere(sizes.0 - sizes.1, |difference| difference >= 0.0) {
                    continue;
                }
                let (above, below) = rows.split_at_mut(i);
                for (a, b) in below[0].iter_mut().zip(&mut above[k]) {
                    (*a, *b) = exchanged(sizes.0, sizes.1, (*a, *b));
                }
                order.exchange(sizes, i, k);
            }
            let pivot_row = rows[k];
            let inverse = T::from_f64(1.0) / pivot_row[k];
            rows[k][k] = inverse;
            for row in &mut rows[k + 1..] {
                let factor = row[k] * inverse;
                row[k] = factor;
                for (element, pivot) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                    *element -= factor * *pivot;
                }
            }
        }
        Self { rows, scale, order }
    }

    /// The `x` of `A x = right`.
    #[must_use]
    pub fn solution(&self, right: &SVector<T, K>) -> SVector<T, K> {
        SVector::from(self.solve(&right.data.0[0]))
    }

    /// The same for several right sides, as many as the scalar takes [columns](Columns) at once.
    #[must_use]
    pub fn columns(&self, right: &[T::Columns; K]) -> [T::Columns; K] {
        self.solve(right)
    }

    fn solve<X: Columns<T>>(&self, right: &[X; K]) -> [X; K] {
        let scaled = core::array::from_fn(|i| right[i] * X::whole(self.scale[i]));
        let mut x = self.order.apply(&scaled);
        let row = |i: usize| self.rows[i].map(X::whole);
        for i in 1..K {
            x[i] -= dot(&row(i)[..i], &x[..i]);
        }
        for i in (0..K).rev() {
            let row = row(i);
            x[i] = (x[i] - dot(&row[i + 1..], &x[i + 1..])) * row[i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::lanes::{Pair, random};

    #[test]
    fn solves_what_needs_pivots() {
        let matrix = SMatrix::from([[0.0, 2.0, 1e20], [1e-20, 1.0, 0.0], [3.0, 0.0, 1e20]]);
        let x = SVector::from([1.0, -2.0, 3.0]);
        let found = Regular::new(matrix).solution(&(matrix * x));
        assert!((found - x).norm() < 1e-14, "{found}");
    }

    #[test]
    fn a_singular_matrix_gives_nothing_finite() {
        let matrix: SMatrix<f64, 2, 2> = SMatrix::from([[1.0, 2.0], [2.0, 4.0]]);
        let x = Regular::new(matrix).solution(&SVector::from([1.0, 1.0]));
        assert!(x.iter().all(|x| !x.is_finite()), "{x}");
    }

    #[test]
    fn lanes_pivot_each_for_itself() {
        let mut random = random();
        for _ in 0..100 {
            let matrix = SMatrix::<_, 5, 5>::from_fn(|_, _| Pair([random(), random()]));
            let right = SVector::<_, 5>::from_fn(|_, _| Pair([random(), random()]));
            let both = Regular::new(matrix).solution(&right);
            for lane in 0..2 {
                let alone =
                    Regular::new(matrix.map(|it| it.0[lane])).solution(&right.map(|it| it.0[lane]));
                assert_eq!(both.map(|it| it.0[lane]), alone);
            }
        }
    }
}
