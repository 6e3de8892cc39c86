//! Units of expressions.

use std::collections::BTreeMap;

use super::dimension::{Dimension, Ratio, Unknowns};
use crate::symbolic::{Expression, Function, Operation, Pool, Symbol};

/// What is known of an expression's unit.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Measure {
    /// Made of whole numbers alone: it has the unit that its place asks for. As a factor it counts.
    Number,
    /// This one, which may be unknown.
    Of(Dimension),
}

impl Measure {
    fn pure() -> Self {
        Self::Of(Dimension::pure())
    }

    /// As a factor.
    fn factor(&self) -> Dimension {
        match self {
            Self::Number => Dimension::pure(),
            Self::Of(dimension) => dimension.clone(),
        }
    }
}

/// Two units that must be one and are not.
#[derive(Clone, Debug)]
pub(super) enum Mismatch {
    /// Terms of a sum, or what a function compares.
    Terms([Expression; 2], [Dimension; 2]),
    /// The argument of a function of pure numbers.
    Argument(&'static str, Expression, Dimension),
}

/// The units of the expressions of a pool, as far as they are known.
pub(super) struct Inference<'a> {
    pub(super) pool: &'a Pool,
    pub(super) symbols: BTreeMap<Symbol, Dimension>,
    pub(super) unknowns: Unknowns,
    measures: Vec<Option<Measure>>,
}

impl<'a> Inference<'a> {
    pub(super) fn new(
        pool: &'a Pool,
        symbols: BTreeMap<Symbol, Dimension>,
        unknowns: Unknowns,
    ) -> Self {
        Self {
            pool,
            symbols,
            unknowns,
            measures: vec![None; pool.len()],
        }
    }

    /// The unit of an expression; mistakes inside are found once, and what they make has an unknown unit.
    pub(super) fn measure(&mut self, root: Expression, mistakes: &mut Vec<Mismatch>) -> Measure {
        let mut open = vec![root];
        while let Some(&current) = open.last() {
            if self.measures[current.node()].is_some() {
                open.pop();
                continue;
            }
            let operands = self.pool.operation(current).operands();
            let missing = operands
                .iter()
                .filter(|it| self.measures[it.node()].is_none());
            let before = open.len();
            open.extend(missing);
            if open.len() == before {
                self.measures[current.node()] = Some(self.combine(current, mistakes));
                open.pop();
            }
        }
        self.known(root)
    }

    fn known(&self, expression: Expression) -> Measure {
        let known = self.measures[expression.node()].clone();
        known.unwrap_or(Measure::Number)
    }

    /// From the units of the operands, all of which are known.
    fn combine(&mut self, expression: Expression, mistakes: &mut Vec<Mismatch>) -> Measure {
        let product = |a: &Measure, b: &Measure, exponent| match (a, b) {
            (Measure::Number, Measure::Number) => Measure::Number,
            _ => Measure::Of(a.factor().times_power(&b.factor(), exponent)),
        };
        match self.pool.operation(expression) {
            Operation::Constant(_) => Measure::Number,
            Operation::Symbol(symbol) => {
                let known = self.symbols.get(symbol).cloned();
                Measure::Of(known.unwrap_or_else(|| self.unknowns.fresh()))
            }
            Operation::Add(a, b) => self.alike(*a, *b, mistakes),
            Operation::Multiply(a, b) => product(&self.known(*a), &self.known(*b), Ratio::ONE),
            Operation::Divide(a, b) => product(&self.known(*a), &self.known(*b), Ratio::MINUS),
            Operation::Sine(angle) => self.argument("sin", *angle, mistakes),
            Operation::Cosine(angle) => self.argument("cos", *angle, mistakes),
            Operation::Call(function, arguments) => self.call(*function, arguments, mistakes),
        }
    }

    fn call(
        &mut self,
        function: Function,
        arguments: &[Expression],
        mistakes: &mut Vec<Mismatch>,
    ) -> Measure {
        match (function, arguments) {
            (Function::Abs, [a]) => self.known(*a),
            (Function::Sign, _) => Measure::pure(),
            (Function::Sqrt, [a]) => match self.known(*a) {
                Measure::Number => Measure::Number,
                Measure::Of(unit) => Measure::Of(Dimension::pure().times_power(&unit, Ratio::HALF)),
            },
            (Function::Pow, [base, exponent]) => self.power(*base, *exponent, mistakes),
            (Function::Min | Function::Max, [a, b]) => self.alike(*a, *b, mistakes),
            (Function::Atan2, [a, b]) => {
                self.alike(*a, *b, mistakes);
                Measure::pure()
            }
            (Function::SelectLess, [a, b, yes, no]) => {
                self.alike(*a, *b, mistakes);
                self.alike(*yes, *no, mistakes)
            }
            _ => {
                for argument in arguments {
                    self.argument(function.name(), *argument, mistakes);
                }
                Measure::pure()
            }
        }
    }

    /// The unit of a power: that of the base to a known exponent, or else both are pure numbers.
    fn power(
        &mut self,
        base: Expression,
        exponent: Expression,
        mistakes: &mut Vec<Mismatch>,
    ) -> Measure {
        let known = self.pool.constant_value(exponent).and_then(Ratio::nearest);
        match (self.known(base), known) {
            (Measure::Number, Some(_)) => Measure::Number,
            (Measure::Of(unit), Some(power)) => {
                Measure::Of(Dimension::pure().times_power(&unit, power))
            }
            (_, None) => {
                self.argument(Function::Pow.name(), base, mistakes);
                self.argument(Function::Pow.name(), exponent, mistakes)
            }
        }
    }

    /// The unit of two values that are added or compared.
    fn alike(&mut self, a: Expression, b: Expression, mistakes: &mut Vec<Mismatch>) -> Measure {
        match (self.known(a), self.known(b)) {
            (Measure::Number, other) | (other, Measure::Number) => other,
            (Measure::Of(left), Measure::Of(right)) => {
                if self.unknowns.equate(&left, &right) {
                    return Measure::Of(left);
                }
                let units = [&left, &right].map(|unit| self.unknowns.reduce(unit));
                mistakes.push(Mismatch::Terms([a, b], units));
                Measure::Of(self.unknowns.fresh())
            }
        }
    }

    /// The argument of a function of pure numbers.
    fn argument(
        &mut self,
        function: &'static str,
        argument: Expression,
        mistakes: &mut Vec<Mismatch>,
    ) -> Measure {
        if let Measure::Of(unit) = self.known(argument)
            && !self.unknowns.equate(&unit, &Dimension::pure())
        {
            let unit = self.unknowns.reduce(&unit);
            mistakes.push(Mismatch::Argument(function, argument, unit));
        }
        Measure::pure()
    }
}
