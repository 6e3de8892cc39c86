//! Numeric values at one point.

use super::expression::{Expression, Operation, Symbol};
use super::pool::Pool;

/// Evaluates expressions at one point and remembers what it has done.
pub struct Evaluation<'a> {
    symbol: &'a dyn Fn(Symbol) -> f64,
    known: Vec<Option<f64>>,
}

impl<'a> Evaluation<'a> {
    /// At the point where symbols have these values.
    #[must_use]
    pub fn new(symbol: &'a dyn Fn(Symbol) -> f64) -> Self {
        Self {
            symbol,
            known: Vec::new(),
        }
    }

    /// The value; not finite where the expression has none.
    pub fn value(&mut self, pool: &Pool, expression: Expression) -> f64 {
        self.known.resize(pool.len(), None);
        let mut pending = vec![expression.magnitude()];
        while let Some(&current) = pending.last() {
            if self.known[current.node()].is_some() {
                pending.pop();
                continue;
            }
            let operation = pool.operation(current);
            let before = pending.len();
            for part in operation.operands().iter() {
                if self.known[part.node()].is_none() {
                    pending.push(part.magnitude());
                }
            }
            if pending.len() == before {
                self.known[current.node()] = Some(self.of_operation(operation));
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
