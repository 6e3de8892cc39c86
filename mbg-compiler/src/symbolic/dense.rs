//! Dense linear equations with symbolic coefficients.

use super::expression::Expression;
use super::matrix::Matrix;
use super::pool::Pool;

/// Up to this size equations are solved by the adjugate, which divides by nothing but the determinant.
pub const ADJUGATE: usize = 3;

/// Solves `A x = b`; `divisor` is multiplied by what was divided by. More equations are made fewer by pivots, and one of
/// these that varies can vanish where the matrix is regular.
pub fn dense(
    pool: &mut Pool,
    matrix: &Matrix,
    right: &[Expression],
    divisor: &mut Expression,
) -> Option<Vec<Expression>> {
    let size = matrix.rows;
    if size == 1 {
        *divisor = pool.multiply(*divisor, matrix.at(0, 0));
        let value = pool.divide(right[0], matrix.at(0, 0))?;
        return Some(vec![value]);
    }
    if size <= ADJUGATE {
        return by_adjugate(pool, matrix, right, divisor);
    }
    by_pivot(pool, matrix, right, divisor)
}

fn by_adjugate(
    pool: &mut Pool,
    matrix: &Matrix,
    right: &[Expression],
    divisor: &mut Expression,
) -> Option<Vec<Expression>> {
    let determinant = matrix.determinant(pool);
    *divisor = pool.multiply(*divisor, determinant);
    let adjugate = matrix.adjugate(pool);
    let numerators = adjugate
        .times(pool, &Matrix::column(right.to_vec()))
        .entries;
    numerators
        .into_iter()
        .map(|numerator| pool.divide(numerator, determinant))
        .collect()
}

/// Eliminates one unknown and solves the rest.
fn by_pivot(
    pool: &mut Pool,
    matrix: &Matrix,
    right: &[Expression],
    divisor: &mut Expression,
) -> Option<Vec<Expression>> {
    let size = matrix.rows;
    let (row, column) = pivot(pool, matrix)?;
    let pivot = matrix.at(row, column);
    *divisor = pool.multiply(*divisor, pivot);
    let rows: Vec<usize> = (0..size).filter(|other| *other != row).collect();
    let columns: Vec<usize> = (0..size).filter(|other| *other != column).collect();
    let mut entries = Vec::with_capacity(rows.len() * columns.len());
    let mut rest = Vec::with_capacity(rows.len());
    for other in &rows {
        let factor = pool.divide(matrix.at(*other, column), pivot)?;
        for inner in &columns {
            let product = pool.multiply(factor, matrix.at(row, *inner));
            entries.push(pool.subtract(matrix.at(*other, *inner), product));
        }
        let product = pool.multiply(factor, right[row]);
        rest.push(pool.subtract(right[*other], product));
    }
    let smaller = Matrix::new(rows.len(), columns.len(), entries);
    let mut values = dense(pool, &smaller, &rest, divisor)?;
    let mut numerator = right[row];
    for (inner, value) in columns.iter().zip(&values) {
        let product = pool.multiply(matrix.at(row, *inner), *value);
        numerator = pool.subtract(numerator, product);
    }
    values.insert(column, pool.divide(numerator, pivot)?);
    Some(values)
}

/// Constants before parameters before what varies; among equals the one that fills in least (Markowitz 1957).
fn pivot(pool: &Pool, matrix: &Matrix) -> Option<(usize, usize)> {
    let size = matrix.rows;
    let filled = |row: usize, column: usize| matrix.at(row, column) != Expression::ZERO;
    let in_row: Vec<usize> = (0..size)
        .map(|row| (0..size).filter(|c| filled(row, *c)).count())
        .collect();
    let in_column: Vec<usize> = (0..size)
        .map(|column| (0..size).filter(|r| filled(*r, column)).count())
        .collect();
    (0..size)
        .flat_map(|row| (0..size).map(move |column| (row, column)))
        .filter(|(row, column)| filled(*row, *column))
        .min_by_key(|(row, column)| {
            let rate = pool.rate(matrix.at(*row, *column));
            (rate, (in_row[*row] - 1) * (in_column[*column] - 1))
        })
}
