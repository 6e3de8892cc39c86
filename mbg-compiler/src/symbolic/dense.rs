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
    Pivots::of(pool, matrix)?.solve(pool, right, divisor)
}

/// A matrix that is made smaller by pivots, for many right sides.
pub struct Pivots {
    steps: Vec<Pivot>,
    /// What is left, of a size for the adjugate.
    rest: Matrix,
}

/// The elimination of one unknown.
struct Pivot {
    row: usize,
    column: usize,
    pivot: Expression,
    /// What multiples of the row are taken from the others.
    factors: Vec<Expression>,
    /// The row without its pivot.
    entries: Vec<Expression>,
}

impl Pivots {
    /// None if the matrix is singular.
    pub fn of(pool: &mut Pool, matrix: &Matrix) -> Option<Self> {
        let (mut steps, mut rest) = (Vec::new(), matrix.clone());
        while rest.rows > ADJUGATE {
            let (row, column) = pivot(pool, &rest)?;
            let pivot = rest.at(row, column);
            let columns = (0..rest.rows).filter(|inner| *inner != column);
            let columns: Vec<usize> = columns.collect();
            let entries: Vec<_> = columns.iter().map(|inner| rest.at(row, *inner)).collect();
            let (mut factors, mut smaller) = (Vec::new(), Vec::new());
            for other in (0..rest.rows).filter(|other| *other != row) {
                let factor = pool.divide(rest.at(other, column), pivot)?;
                for (inner, entry) in columns.iter().zip(&entries) {
                    let product = pool.multiply(factor, *entry);
                    smaller.push(pool.subtract(rest.at(other, *inner), product));
                }
                factors.push(factor);
            }
            rest = Matrix::new(columns.len(), columns.len(), smaller);
            steps.push(Pivot {
                row,
                column,
                pivot,
                factors,
                entries,
            });
        }
        Some(Self { steps, rest })
    }

    /// Solves for a right side, as [`dense`] does.
    pub fn solve(
        &self,
        pool: &mut Pool,
        right: &[Expression],
        divisor: &mut Expression,
    ) -> Option<Vec<Expression>> {
        let mut right = right.to_vec();
        let mut held = Vec::new();
        for step in &self.steps {
            *divisor = pool.multiply(*divisor, step.pivot);
            let own = right.remove(step.row);
            for (other, factor) in right.iter_mut().zip(&step.factors) {
                let product = pool.multiply(*factor, own);
                *other = pool.subtract(*other, product);
            }
            held.push(own);
        }
        let mut values = by_adjugate(pool, &self.rest, &right, divisor)?;
        for (step, mut numerator) in self.steps.iter().zip(held).rev() {
            for (entry, value) in step.entries.iter().zip(&values) {
                let product = pool.multiply(*entry, *value);
                numerator = pool.subtract(numerator, product);
            }
            values.insert(step.column, pool.divide(numerator, step.pivot)?);
        }
        Some(values)
    }
}

fn by_adjugate(
    pool: &mut Pool,
    matrix: &Matrix,
    right: &[Expression],
    divisor: &mut Expression,
) -> Option<Vec<Expression>> {
    if matrix.rows == 1 {
        *divisor = pool.multiply(*divisor, matrix.at(0, 0));
        let value = pool.divide(right[0], matrix.at(0, 0))?;
        return Some(vec![value]);
    }
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
