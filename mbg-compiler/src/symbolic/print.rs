//! Expressions as text, for documentation, messages and dumps.

use super::expression::{Expression, Operation, Symbol};
use super::pool::Pool;

/// Prints expressions with the names that a model gives to symbols.
pub struct Printer<'a> {
    pool: &'a Pool,
    name: &'a dyn Fn(Symbol) -> String,
}

/// How tightly a printed expression binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Atom,
}

/// Longest text that is still worth reading; what is deeper is shown as `…`.
const DEPTH: usize = 12;

impl<'a> Printer<'a> {
    /// With names for symbols.
    #[must_use]
    pub fn new(pool: &'a Pool, name: &'a dyn Fn(Symbol) -> String) -> Self {
        Self { pool, name }
    }

    /// The expression in infix notation.
    #[must_use]
    pub fn text(&self, expression: Expression) -> String {
        self.at_depth(expression, DEPTH).0
    }

    fn operand(&self, expression: Expression, at_least: Binding, depth: usize) -> String {
        let (text, binding) = self.at_depth(expression, depth);
        if binding < at_least {
            format!("({text})")
        } else {
            text
        }
    }

    fn at_depth(&self, expression: Expression, depth: usize) -> (String, Binding) {
        if depth == 0 {
            return ("…".to_owned(), Binding::Atom);
        }
        if let Operation::Add(a, b) = self.pool.operation(expression)
            && expression.is_negative()
            && b.is_negative()
        {
            let (b, a) = (
                self.operand(b.magnitude(), Binding::Sum, depth - 1),
                self.operand(*a, Binding::Product, depth - 1),
            );
            return (format!("{b} - {a}"), Binding::Sum);
        }
        if expression.is_negative() {
            return (
                format!(
                    "-{}",
                    self.operand(expression.magnitude(), Binding::Product, depth)
                ),
                Binding::Sum,
            );
        }
        let depth = depth - 1;
        match self.pool.operation(expression) {
            Operation::Constant(value) => (number(*value), Binding::Atom),
            Operation::Symbol(symbol) => ((self.name)(*symbol), Binding::Atom),
            Operation::Add(a, b) => {
                let first = self.operand(*a, Binding::Sum, depth);
                let sign = if b.is_negative() { '-' } else { '+' };
                let least = if b.is_negative() {
                    Binding::Product
                } else {
                    Binding::Sum
                };
                (
                    format!(
                        "{first} {sign} {}",
                        self.operand(b.magnitude(), least, depth)
                    ),
                    Binding::Sum,
                )
            }
            Operation::Multiply(a, b) => {
                let (a, b) = (
                    self.operand(*a, Binding::Product, depth),
                    self.operand(*b, Binding::Product, depth),
                );
                (format!("{a} {b}"), Binding::Product)
            }
            Operation::Divide(a, b) => {
                let (a, b) = (
                    self.operand(*a, Binding::Product, depth),
                    self.operand(*b, Binding::Atom, depth),
                );
                (format!("{a}/{b}"), Binding::Product)
            }
            Operation::Sine(a) => (
                format!("sin({})", self.at_depth(*a, depth).0),
                Binding::Atom,
            ),
            Operation::Cosine(a) => (
                format!("cos({})", self.at_depth(*a, depth).0),
                Binding::Atom,
            ),
            Operation::Call(function, arguments) => {
                let arguments: Vec<_> = arguments
                    .iter()
                    .map(|argument| self.at_depth(*argument, depth).0)
                    .collect();
                (
                    format!("{}({})", function.name(), arguments.join(", ")),
                    Binding::Atom,
                )
            }
        }
    }
}

/// A number as short as it can be read back.
#[must_use]
pub fn number(value: f64) -> String {
    let plain = format!("{value}");
    let scientific = format!("{value:e}");
    if plain.len() <= scientific.len() + 2 {
        plain
    } else {
        scientific
    }
}
