//! The identity test: whether two matrices of expressions are the same function.

use super::matrix::Matrix;
use super::pool::Pool;

/// Whether all entries agree, by exact evaluation at the points of [`super::field`].
///
/// A difference that is not identically zero is missed with a chance of about (degree / 2⁶¹)³.
#[must_use]
pub fn identical(pool: &Pool, a: &Matrix, b: &Matrix) -> bool {
    (a.rows, a.columns) == (b.rows, b.columns)
        && a.entries
            .iter()
            .zip(&b.entries)
            .all(|(a, b)| pool.image(*a) == pool.image(*b))
}
