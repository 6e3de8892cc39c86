//! Energies of storages whose law is given as effort or flow.

use proc_macro2::Span;

use super::expressions::Result;
use super::laws::Reader;
use super::rays::is_integrable;
use crate::codes;
use crate::diagnostics::error;
use crate::graph::{Integral, component_name};
use crate::symbolic::substitute::symbols;
use crate::symbolic::vanishing::is_regular;
use crate::symbolic::{
    Differentiator, Evaluation, Expression, Operation, Rate, Substitution, Symbol, antiderivative,
    quadrature,
};

/// How near to zero a law is looked at that starts there: nearer than the sizes of what is built.
const NEAR: f64 = 1e-12;

impl Reader<'_, '_, '_> {
    /// The energy of a law that is no multiple of the state, and how it is found: in closed form as far as there is one, by a
    /// quadrature of what is left. What is stored by pseudo bonds is no energy, so that their laws need none.
    pub(super) fn potential(
        &mut self,
        law: &[Expression],
        span: Span,
    ) -> Result<(Expression, Integral)> {
        if self.is_pseudo() {
            return Ok((Expression::ZERO, Integral::Exact));
        }
        self.check_potential(law, span)?;
        let zero = vec![Expression::ZERO; law.len()];
        if quadrature::is_exact(self.pool, &self.own.states, law) {
            return Ok((self.quadrature(law, &zero, span)?, Integral::Exact));
        }
        let (mut closed, left) = self.closed(law);
        if left == zero {
            return Ok((closed, Integral::Exact));
        }
        let (rest, integral) = if self.has_integral_from_zero(&left)? {
            (self.quadrature(&left, &zero, span)?, Integral::FromZero)
        } else if self.has_integral_from_zero(law)? {
            // The poles of its summands cancel.
            let whole = self.quadrature(law, &zero, span)?;
            return Ok((whole, Integral::FromZero));
        } else if let Some(start) = self.regular_start(law)? {
            let mut at_start = Substitution::new();
            for (state, start) in self.own.states.clone().zip(&start) {
                at_start.set(Symbol::State(state), *start);
            }
            let before = at_start.apply(self.pool, closed);
            closed = self
                .pool
                .subtract(closed, before.unwrap_or(Expression::ZERO));
            (self.quadrature(&left, &start, span)?, Integral::FromStart)
        } else {
            return self.has_no_integral(span);
        };
        Ok((self.pool.add(closed, rest), integral))
    }

    /// Whether effort times flow is no power at the storage.
    pub(super) fn is_pseudo(&self) -> bool {
        self.lookup.graph.is_pseudo(self.own.element)
    }

    fn quadrature(
        &mut self,
        law: &[Expression],
        start: &[Expression],
        span: Span,
    ) -> Result<Expression> {
        quadrature::energy(self.pool, &self.own.states, law, start).ok_or_else(|| {
            let message = format!("the law of `{}` divides by zero", self.element.name);
            Box::new(error(codes::NOT_FINITE, span, message))
        })
    }

    fn has_no_integral<T>(&self, span: Span) -> Result<T> {
        let message = format!(
            "the energy of `{}` is not known: its law has no integral from zero, and no finite value at the start",
            self.element.name
        );
        let report = error(codes::NOT_FINITE, span, message);
        Err(Box::new(report.help(
            "give an `initial: …` where the law is finite, from which its energy is counted then, or write `energy: …`; sums \
             of powers of a distance, such as `powi(a / q, 2)` or `pow(q - a, -1.5)`, are integrated from anywhere",
        )))
    }

    /// Whether the law has an integral from zero to the start, for default values of parameters. From a start at zero that
    /// is asked near it, on both sides.
    fn has_integral_from_zero(&mut self, law: &[Expression]) -> Result<bool> {
        let start = self.start(law)?.unwrap_or_default();
        let ends: Vec<f64> = start.iter().map(|it| self.usual(*it, &[])).collect();
        if ends.iter().any(|end| *end != 0.0) {
            return Ok(is_integrable(|part| self.power_along(law, &ends, part)));
        }
        let is_regular = |side: f64| {
            let ends = vec![side * NEAR; law.len()];
            let value = |part| self.power_along(law, &ends, part);
            // Many laws are defined on one side alone.
            value(0.5).is_nan() || is_integrable(value)
        };
        Ok(is_regular(1.0) && is_regular(-1.0))
    }

    /// The sum of the sizes of what is integrated, at a part of the way from zero to the end.
    fn power_along(&self, law: &[Expression], ends: &[f64], part: f64) -> f64 {
        let states: Vec<f64> = ends.iter().map(|end| part * end).collect();
        let rows = law.iter().zip(ends);
        rows.map(|(row, end)| (self.usual(*row, &states) * end).abs())
            .sum()
    }

    /// A value at states of the storage, for default values of parameters, and somewhere else.
    fn usual(&self, expression: Expression, states: &[f64]) -> f64 {
        let value = |symbol| match symbol {
            Symbol::Parameter(index) => self.lookup.parameters.get(index).map(|it| it.default),
            Symbol::State(state) => {
                let own = state.checked_sub(self.own.states.start);
                own.and_then(|own| states.get(own)).copied()
            }
            _ => None,
        };
        Evaluation::new(&|symbol| value(symbol).unwrap_or(0.5)).value(self.pool, expression)
    }

    /// The state at the start, if it is given in numbers and parameters.
    fn start(&mut self, law: &[Expression]) -> Result<Option<Vec<Expression>>> {
        let start = self.initial(law)?;
        let is_fixed = |it: &Expression| self.pool.rate(*it) != Rate::Varying;
        Ok(start.filter(|start| start.iter().all(is_fixed)))
    }

    /// The state at the start, if the law is finite there.
    fn regular_start(&mut self, law: &[Expression]) -> Result<Option<Vec<Expression>>> {
        let start = self.start(law)?;
        Ok(start.filter(|start| {
            let states: Vec<f64> = start.iter().map(|it| self.usual(*it, &[])).collect();
            law.iter().all(|row| self.usual(*row, &states).is_finite())
        }))
    }

    /// The energy, in closed form, of those summands of a law that have one, and what is left of the law.
    fn closed(&mut self, law: &[Expression]) -> (Expression, Vec<Expression>) {
        let mut energies = Vec::new();
        let mut left = Vec::new();
        for (row, state) in law.iter().zip(self.own.states.clone()) {
            if let Some(energy) = self.integral(*row, state) {
                energies.push(energy);
                left.push(Expression::ZERO);
                continue;
            }
            let mut others = Vec::new();
            for term in self.summands(*row) {
                match self.integral(term, state) {
                    Some(energy) => energies.push(energy),
                    None => others.push(term),
                }
            }
            left.push(self.pool.sum(&others));
        }
        (self.pool.sum(&energies), left)
    }

    /// What an expression is the sum of, where factors that no state of the storage changes are multiplied out.
    fn summands(&mut self, expression: Expression) -> Vec<Expression> {
        let is_fixed = |reader: &Self, it: Expression| {
            let read = symbols(reader.pool, &[it]);
            let mut states = reader.own.states.clone().map(Symbol::State);
            !states.any(|state| read.contains(&state))
        };
        let scaled = match *self.pool.operation(expression) {
            Operation::Add(a, b) => [a, b].map(|it| self.summands(it)).concat(),
            Operation::Multiply(a, b) if is_fixed(self, a) || is_fixed(self, b) => {
                let (factor, sum) = if is_fixed(self, a) { (a, b) } else { (b, a) };
                let terms = self.summands(sum).into_iter();
                terms.map(|term| self.pool.multiply(factor, term)).collect()
            }
            Operation::Divide(sum, divisor) if is_fixed(self, divisor) => {
                let terms = self.summands(sum).into_iter();
                let terms: Option<_> = terms.map(|term| self.pool.divide(term, divisor)).collect();
                terms.unwrap_or_else(|| vec![expression.magnitude()])
            }
            _ => vec![expression.magnitude()],
        };
        let is_negative = expression.is_negative();
        let terms = scaled.into_iter();
        terms.map(|term| term.flipped(is_negative)).collect()
    }

    /// The energy in closed form of what reads no other state of the storage than its own. It is counted from the state zero,
    /// if it has a value there.
    fn integral(&mut self, row: Expression, state: usize) -> Option<Expression> {
        let others = |it: &Symbol| matches!(it, Symbol::State(other) if self.own.states.contains(other) && *other != state);
        if symbols(self.pool, &[row]).iter().any(others) {
            return None;
        }
        let energy = antiderivative(self.pool, row, Symbol::State(state))?;
        let mut at_rest = Substitution::new();
        at_rest.set(Symbol::State(state), Expression::ZERO);
        let start = at_rest.apply(self.pool, energy);
        let start = start.filter(|it| is_regular(self.pool, *it));
        let start = start.unwrap_or(Expression::ZERO);
        Some(self.pool.subtract(energy, start))
    }

    /// A storage has an energy only if a law's derivatives across its components are equal.
    fn check_potential(&mut self, law: &[Expression], span: Span) -> Result<()> {
        let states = self.own.states.clone();
        // Only what a component reads of others, since most laws of large vectors read nothing.
        let crossed = |row: usize| {
            let read = symbols(self.pool, &[law[row]]).into_iter();
            let columns = read.filter_map(|symbol| match symbol {
                Symbol::State(state) if states.contains(&state) => Some(state - states.start),
                _ => None,
            });
            let pairs: Vec<_> = columns
                .filter(|it| *it != row)
                .map(|it| (row, it))
                .collect();
            pairs
        };
        let crossed: Vec<_> = (0..law.len()).flat_map(crossed).collect();
        let mut slope = |row: usize, column: usize| {
            let state = Symbol::State(states.start + column);
            Differentiator::new(state).derivative(self.pool, law[row])
        };
        for (row, column) in crossed {
            if slope(row, column) != slope(column, row) {
                return self.creates_energy([column, row], span);
            }
        }
        Ok(())
    }

    fn creates_energy<T>(&self, components: [usize; 2], span: Span) -> Result<T> {
        let size = self.own.dimension;
        let [first, second] = components.map(|component| component_name(component, size));
        let message = format!(
            "the law of `{}` would create energy: its component {second} changes with {first} otherwise than its \
             component {first} with {second}",
            self.element.name
        );
        let report = error(codes::EXPRESSION, span, message);
        Err(Box::new(
            report
                .help("write `energy: …`, from which the law follows by differentiation")
                .help(
                    "or where effort times flow is no power write `pseudo` behind the name of its junction",
                ),
        ))
    }
}
