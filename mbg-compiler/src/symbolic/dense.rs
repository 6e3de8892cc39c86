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

/// The pivots of a matrix, for many right sides.
pub struct Pivots {
    steps: Vec<Pivot>,
    /// What is left, of a size for the adjugate.
    rest: Matrix,
}

struct Pivot {
    row: usize,
    column: usize,
    pivot: Expression,
    /// By what multiples of the row the others are made smaller.
    factors: Vec<Expression>,
    /// The row without its pivot.
    entries: Vec<Expression>,
}

impl Pivots {
    /// As [`dense`] takes them.
    pub fn of(pool: &mut Pool, matrix: &Matrix) -> Option<Self> {
        let (mut steps, mut rest) = (Vec::new(), matrix.clone());
        while rest.rows > ADJUGATE {
            let (row, column) = pivot(pool, &rest)?;
            let pivot = rest.at(row, column);
            let columns = (0..rest.rows).filter(|inner| *inner != column);
            let entries: Vec<_> = columns.map(|inner| rest.at(row, inner)).collect();
            let size = entries.len();
            let (mut factors, mut smaller) = (Vec::new(), Vec::new());
            for other in (0..rest.rows).filter(|other| *other != row) {
                let factor = pool.divide(rest.at(other, column), pivot)?;
                factors.push(factor);
                let columns = (0..rest.rows).filter(|inner| *inner != column);
                for (inner, entry) in columns.zip(&entries) {
                    let product = pool.multiply(factor, *entry);
                    smaller.push(pool.subtract(rest.at(other, inner), product));
                }
            }
            rest = Matrix::new(size, size, smaller);
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

    /// What [`dense`] gives.
    pub fn solve(&self, pool: &mut Pool, right: &[Expression]) -> Option<Vec<Expression>> {
        let mut right = right.to_vec();
        let mut held = Vec::new();
        for step in &self.steps {
            let own = right.remove(step.row);
            for (other, factor) in right.iter_mut().zip(&step.factors) {
                let product = pool.multiply(*factor, own);
                *other = pool.subtract(*other, product);
            }
            held.push(own);
        }
        let mut divisor = Expression::ONE;
        let mut values = dense(pool, &self.rest, &right, &mut divisor)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Symbol;

    #[test]
    fn pivots_solve_as_equations_by_themselves_do() {
        let mut pool = Pool::new();
        let mut state = 0..;
        let mut entry = |pool: &mut Pool, is_there: bool| match is_there {
            true => pool.symbol(Symbol::State(state.next().unwrap_or(0))),
            false => Expression::ZERO,
        };
        // A ring of five, of which the last entry is a number.
        let places = (0..25).map(|place| (place / 5, place % 5));
        let near = |(row, column): (usize, usize)| (row + 6 - column) % 5 < 3;
        let mut entries: Vec<_> = places.map(|it| entry(&mut pool, near(it))).collect();
        entries[24] = Expression::ONE;
        let matrix = Matrix::new(5, 5, entries);
        let pivots = Pivots::of(&mut pool, &matrix).unwrap();
        for row in 0..5 {
            let mut unit = vec![Expression::ZERO; 5];
            unit[row] = Expression::ONE;
            let mut divisor = Expression::ONE;
            let alone = dense(&mut pool, &matrix, &unit, &mut divisor);
            let before = pool.len();
            assert_eq!(pivots.solve(&mut pool, &unit), alone);
            assert_eq!(pool.len(), before, "nothing is worked out twice");
        }
    }
}
