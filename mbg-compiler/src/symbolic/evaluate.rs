//! Numeric values at one point.

use std::collections::BTreeMap;

use super::expression::{Expression, Operation, Symbol};
use super::implicit::{Kind, Method, Place};
use super::pool::Pool;

/// Evaluates expressions at one point and remembers what it has done.
pub struct Evaluation<'a> {
    symbol: &'a dyn Fn(Symbol) -> f64,
    known: Vec<Option<f64>>,
    /// Unknowns of linear equations, by number of these.
    solved: BTreeMap<usize, Vec<f64>>,
}

impl<'a> Evaluation<'a> {
    /// At the point where symbols have these values.
    #[must_use]
    pub fn new(symbol: &'a dyn Fn(Symbol) -> f64) -> Self {
        Self {
            symbol,
            known: Vec::new(),
            solved: BTreeMap::new(),
        }
    }

    /// The value; not finite where the expression has none. What regular linear equations give is solved for.
    pub fn value(&mut self, pool: &Pool, expression: Expression) -> f64 {
        self.known.resize(pool.len(), None);
        let mut pending = vec![expression.magnitude()];
        while let Some(&current) = pending.last() {
            if self.known[current.node()].is_some() {
                pending.pop();
                continue;
            }
            let operation = pool.operation(current);
            let linear = linear(pool, operation);
            let before = pending.len();
            let equations = linear.map(|place| numbers(pool, place.number));
            let equations = equations.iter().flatten();
            for part in operation.operands().iter().chain(equations) {
                if self.known[part.node()].is_none() {
                    pending.push(part.magnitude());
                }
            }
            if pending.len() == before {
                self.known[current.node()] = Some(match linear {
                    Some(place) => self.of_equations(pool, place),
                    None => self.of_operation(operation),
                });
                pending.pop();
            }
        }
        self.of(expression)
    }

    fn of(&self, expression: Expression) -> f64 {
        let value = self.known[expression.node()].unwrap_or(f64::NAN);
        if expression.is_negative() {
            -value
        } else {
            value
        }
    }

    /// One unknown of linear equations, of which all numbers are known.
    fn of_equations(&mut self, pool: &Pool, place: Place) -> f64 {
        if let Some(solved) = self.solved.get(&place.number) {
            return solved[place.row];
        }
        let size = pool.implicit()[place.number].unknowns.len();
        let numbers = numbers(pool, place.number);
        let numbers: Vec<f64> = numbers.iter().map(|it| self.of(*it)).collect();
        let (right, matrix) = numbers.split_at(size);
        let solved = regular(right, matrix);
        let value = solved[place.row];
        self.solved.insert(place.number, solved);
        value
    }

    fn of_operation(&self, operation: &Operation) -> f64 {
        match operation {
            Operation::Constant(value) => *value,
            Operation::Symbol(symbol) => (self.symbol)(*symbol),
            Operation::Add(a, b) => self.of(*a) + self.of(*b),
            Operation::Multiply(a, b) => self.of(*a) * self.of(*b),
            Operation::Divide(a, b) => self.of(*a) / self.of(*b),
            Operation::Sine(a) => self.of(*a).sin(),
            Operation::Cosine(a) => self.of(*a).cos(),
            Operation::Call(function, arguments) => {
                let values: Vec<f64> = arguments.iter().map(|a| self.of(*a)).collect();
                function.evaluate(&values)
            }
        }
    }
}

/// The solution of `A z = b` with a matrix by rows: Gaussian elimination with pivots that are large in their rows.
pub(crate) fn regular(right: &[f64], matrix: &[f64]) -> Vec<f64> {
    let size = right.len();
    let mut rows: Vec<Vec<f64>> = (0..size)
        .map(|row| {
            let entries = &matrix[row * size..][..size];
            let largest = entries
                .iter()
                .fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
            let scaled = |entry: &f64| entry / largest;
            entries.iter().chain([&right[row]]).map(scaled).collect()
        })
        .collect();
    for column in 0..size {
        let largest = (column..size)
            .max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))
            .unwrap_or(column);
        rows.swap(column, largest);
        let pivot = rows[column].clone();
        for (row, entries) in rows.iter_mut().enumerate() {
            if row != column {
                let factor = entries[column] / pivot[column];
                for (entry, above) in entries.iter_mut().zip(&pivot) {
                    *entry -= factor * above;
                }
            }
        }
    }
    (0..size)
        .map(|row| rows[row][size] / rows[row][row])
        .collect()
}

/// The right side of linear equations and the matrix by rows, which may be that of earlier ones.
fn numbers(pool: &Pool, number: usize) -> Vec<Expression> {
    let implicit = &pool.implicit()[number];
    let mut numbers = implicit.evaluated();
    if let Some(earlier) = implicit.earlier() {
        let earlier = pool.implicit()[earlier].evaluated();
        numbers.extend_from_slice(&earlier[implicit.unknowns.len()..]);
    }
    numbers
}

/// Where an operation is an unknown of regular linear equations.
fn linear(pool: &Pool, operation: &Operation) -> Option<Place> {
    let Operation::Symbol(symbol) = operation else {
        return None;
    };
    let regular = |place: &Place| {
        let number = pool.implicit()[place.number].earlier();
        let method = &pool.implicit()[number.unwrap_or(place.number)].method;
        matches!(
            method,
            Method::Linear {
                kind: Kind::Regular | Kind::Symmetric,
                ..
            }
        )
    };
    pool.place(*symbol).filter(regular)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_that_of_the_formula() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let (sine, two) = (pool.sine(x), pool.integer(2));
        let product = pool.multiply(two, sine);
        let sum = pool.subtract(product, x);
        let at = |_| 0.5;
        assert_eq!(
            Evaluation::new(&at).value(&pool, sum),
            2.0 * 0.5f64.sin() - 0.5
        );
    }
}
