//! Determinants of larger matrices, without a division: nothing vanishes on the way where the determinant does not.
//!
//! The coefficients of the characteristic polynomial follow from those of one row and column less: S. J. Berkowitz, *On
//! computing the determinant in small parallel time using a small number of processors*, Inf. Process. Lett. 18 (1984).
//! That takes n⁴/4 products, where minors take 2ⁿ.

use super::expression::Expression;
use super::matrix::Matrix;
use super::pool::Pool;

/// The determinant of a square matrix.
pub fn determinant(pool: &mut Pool, matrix: &Matrix) -> Expression {
    let mut polynomial = vec![Expression::ONE];
    for size in 0..matrix.rows {
        let factors = factors(pool, matrix, size);
        polynomial = (0..size + 2)
            .map(|degree| {
                let terms: Vec<Expression> = (0..=degree.min(size))
                    .map(|it| pool.multiply(factors[degree - it], polynomial[it]))
                    .collect();
                pool.sum(&terms)
            })
            .collect();
    }
    polynomial[matrix.rows].flipped(matrix.rows % 2 == 1)
}

/// By what the polynomial of the leading part of a size is multiplied for one row `r` and column `c` more, with `a` where
/// these meet: 1, −a, and −r Mᵏ c with the leading part M.
fn factors(pool: &mut Pool, matrix: &Matrix, size: usize) -> Vec<Expression> {
    let mut column: Vec<Expression> = (0..size).map(|row| matrix.at(row, size)).collect();
    let mut factors = vec![Expression::ONE, matrix.at(size, size).negated()];
    for _ in 0..size {
        factors.push(row_times(pool, matrix, size, &column).negated());
        column = (0..size)
            .map(|row| row_times(pool, matrix, row, &column))
            .collect();
    }
    factors
}

/// The first entries of a row times a column.
fn row_times(pool: &mut Pool, matrix: &Matrix, row: usize, column: &[Expression]) -> Expression {
    let terms: Vec<Expression> = column
        .iter()
        .enumerate()
        .map(|(place, entry)| pool.multiply(matrix.at(row, place), *entry))
        .collect();
    pool.sum(&terms)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Symbol;

    #[test]
    fn without_division_the_determinant_is_that_by_minors() {
        for size in 1..6 {
            let mut pool = Pool::new();
            let entries = (0..size * size)
                .map(|place| match place % 4 {
                    3 => Expression::ZERO,
                    _ => pool.symbol(Symbol::State(place)),
                })
                .collect();
            let matrix = Matrix::new(size, size, entries);
            let expected = matrix.determinant(&mut pool);
            assert_eq!(determinant(&mut pool, &matrix), expected);
        }
    }

    #[test]
    fn a_matrix_without_a_diagonal_has_a_determinant() {
        let mut pool = Pool::new();
        let entries = (0..64)
            .map(|place| match place / 8 + place % 8 {
                7 => pool.symbol(Symbol::State(place)),
                _ => Expression::ZERO,
            })
            .collect();
        let found = determinant(&mut pool, &Matrix::new(8, 8, entries));
        let states: Vec<Expression> = (0..8)
            .map(|row| pool.symbol(Symbol::State(8 * row + 7 - row)))
            .collect();
        let product = states.into_iter().fold(Expression::ONE, |product, state| {
            pool.multiply(product, state)
        });
        assert_eq!(found, product);
    }
}
