//! Integrals whose closed form divides by what parameters may make zero.
//!
//! `∫ cos(a x) dx` is `sin(a x) / a`, which has no value at `a = 0`, and next to nothing but rounding near there. But where such
//! a form fails, what is integrated hardly changes from where the integral begins, and a quadrature is exact to rounding. So
//! while integrating it is noted what must change for the closed form to hold, such as `a x`, and at run time that decides
//! between the two. The places of choices and the degrees of powers have their own ways.

use super::antiderivative::Integration;
use super::choices::Meeting;
use super::evaluate::Evaluation;
use super::expression::{Expression, Function, Operation, Symbol};
use super::pool::Pool;
use super::quadrature;
use super::substitute::Substitution;

/// Most choices in each other that have places of their own: each doubles what is in it, at two places.
pub(super) const MOST_CHOICES: usize = 2;

/// What an argument changes by from where the integral begins, and at what scale that counts.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Change {
    size: Expression,
    scale: Expression,
}

/// Whether it has a value, as a sample shows: beside that of equal symbols, whose difference would be zero.
#[must_use]
pub(crate) fn is_regular(pool: &Pool, expression: Expression) -> bool {
    let sample = |symbol| {
        let number = match symbol {
            Symbol::Parameter(number) | Symbol::State(number) | Symbol::Unknown(number) => number,
            _ => 0,
        };
        0.5 + 0.01 * (number as f64 * 0.618).fract()
    };
    Evaluation::new(&sample).value(pool, expression).is_finite()
}

impl Integration<'_> {
    /// Of a part of something that is integrated as a whole: parts may cancel.
    pub(super) fn part(&mut self, expression: Expression) -> Option<Expression> {
        self.parts += 1;
        let found = self.of(expression);
        self.parts -= 1;
        found
    }

    /// Notes that an argument with this slope must change, if that may vanish.
    pub(super) fn must_change(&mut self, slope: Expression, scale: Expression) {
        if !self.is_divided && !self.may_vanish(slope) {
            return;
        }
        if let Some(size) = self.way(slope)
            && let Some(scale) = self.size_at_base(scale)
        {
            self.changes.push(Change { size, scale });
        }
    }

    /// How much an argument with this slope changes from where the integral begins.
    fn way(&mut self, slope: Expression) -> Option<Expression> {
        let (base, symbol) = (self.base?, self.pool.symbol(self.symbol));
        let way = self.pool.subtract(symbol, base);
        let change = self.pool.multiply(slope, way);
        Some(self.pool.call(Function::Abs, &[change]))
    }

    fn size_at_base(&mut self, expression: Expression) -> Option<Expression> {
        let mut there = Substitution::new();
        there.set(self.symbol, self.base?);
        let value = there.apply(self.pool, expression)?;
        Some(self.pool.call(Function::Abs, &[value]))
    }

    /// The value where the integral begins, if it has one there, as a sample shows.
    fn at_base(&mut self, expression: Expression) -> Option<Expression> {
        let value = self.at(self.base?, expression)?;
        is_regular(self.pool, value).then_some(value)
    }

    /// Replaces symbols in what was noted last.
    pub(super) fn replace_in_changes(
        &mut self,
        known: usize,
        substitution: &mut Substitution,
    ) -> Option<()> {
        for change in &mut self.changes[known..] {
            for part in [&mut change.size, &mut change.scale] {
                *part = substitution.apply(self.pool, *part)?;
            }
        }
        Some(())
    }

    /// Whether it may be zero: a number is not, nor is what stands in its divisor alone.
    pub(super) fn may_vanish(&self, expression: Expression) -> bool {
        match self.pool.operation(expression) {
            Operation::Constant(_) => false,
            Operation::Multiply(a, b) => self.may_vanish(*a) || self.may_vanish(*b),
            Operation::Divide(a, _) => self.may_vanish(*a),
            _ => true,
        }
    }

    /// The closed form where all has changed that must, else a quadrature.
    pub(super) fn guarded(
        &mut self,
        expression: Expression,
        found: Expression,
        known: usize,
    ) -> Expression {
        if self.parts > 0 || self.changes.len() == known {
            return found;
        }
        let mut changes = self.changes.split_off(known);
        changes.dedup();
        self.chosen(expression, found, &changes).unwrap_or(found)
    }

    fn chosen(
        &mut self,
        expression: Expression,
        found: Expression,
        changes: &[Change],
    ) -> Option<Expression> {
        let base = self.base?;
        self.guards_left = self.guards_left.checked_sub(1)?;
        let start = self.at_base(found)?;
        if self.is_limited(start) && self.nearest(base) != base {
            return None;
        }
        let Symbol::State(state) = self.symbol else {
            return None;
        };
        let states = state..state + 1;
        let sum = quadrature::energy(self.pool, &states, &[expression], &[base])?;
        if quadrature::is_exact(self.pool, &states, &[expression]) {
            return Some(sum);
        }
        let closed = self.pool.subtract(found, start);
        let two = self.pool.integer(2);
        let chosen = changes.iter().fold(closed, |chosen, change| {
            let twice = self.pool.multiply(two, change.size);
            let choice = [change.scale, twice, chosen, sum];
            self.pool.call(Function::SelectLess, &choice)
        });
        Some(chosen)
    }

    /// `(p − p₀) / d` where a power `p` of a base has the degree `d` that may vanish. With the logarithm `l` of what the base grows by
    /// it is `l (p + p₀) / 2 · tanh(d l / 2) / (d l / 2)`, in which nothing cancels.
    pub(super) fn over_degree(
        &mut self,
        power: Expression,
        base: Expression,
        degree: Expression,
    ) -> Option<Expression> {
        let plain = self.pool.divide(power, degree)?;
        if !self.may_vanish(degree) {
            return Some(plain);
        }
        let found = self.by_logarithm(power, base, degree);
        Some(found.unwrap_or(plain))
    }

    fn by_logarithm(
        &mut self,
        power: Expression,
        base: Expression,
        degree: Expression,
    ) -> Option<Expression> {
        let (first, start) = (self.at_base(power)?, self.at_base(base)?);
        let ratio = self.pool.divide(base, start)?;
        // Not on the other side of where the base vanishes.
        let logarithm = self.pool.call(Function::Ln, &[ratio]);
        let product = self.pool.multiply(degree, logarithm);
        let half = self.share(product, 1, 2)?;
        let size = self.pool.call(Function::Abs, &[half]);
        let tangent = self.pool.call(Function::Tanh, &[half]);
        // Of what is zero the quotient is one.
        let [above, below] = [tangent, half].map(|part| {
            let choice = [Expression::ZERO, size, part, Expression::ONE];
            self.pool.call(Function::SelectLess, &choice)
        });
        let part = self.pool.divide(above, below)?;
        let [sum, difference] = [first, first.negated()].map(|it| self.pool.add(power, it));
        let mean = self.share(sum, 1, 2)?;
        let near = self.pool.multiply(logarithm, mean);
        let near = self.pool.multiply(near, part);
        let far = self.pool.divide(difference, degree)?;
        let choice = [size, Expression::ONE, near, far];
        Some(self.pool.call(Function::SelectLess, &choice))
    }

    /// Of a choice that changes where a difference vanishes whose slope may do so too. Where that place is not between the begin of
    /// the integral and the symbol, the branch that holds on both is counted from the begin.
    pub(super) fn choice_that_may_vanish(
        &mut self,
        branches: [Expression; 2],
        meeting: &Meeting,
    ) -> Option<Expression> {
        let base = self.base.filter(|_| self.may_vanish(meeting.slope))?;
        if self.choices == MOST_CHOICES {
            return None;
        }
        let known = self.changes.len();
        // Held while the symbol takes the value at the begin.
        let name = Symbol::Unknown(self.pool.fresh_unknown());
        let place = self.pool.symbol(name);
        self.choices += 1;
        let branches = self.branches_from(place, meeting.slope, branches);
        self.choices -= 1;
        let branches = branches?;
        let here = meeting.difference;
        let first = self.at(base, here)?;
        let start = [
            first,
            Expression::ZERO,
            self.at(base, branches[0])?,
            self.at(base, branches[1])?,
        ];
        let start = self.pool.call(Function::SelectLess, &start);
        if !is_regular(self.pool, start) {
            return None;
        }
        let sign = self.pool.call(Function::Sign, &[here]);
        let product = self.pool.multiply(sign, first);
        // One of them may be zero where the branches meet there.
        let sum = self.pool.add(here, first);
        let [nearest, difference] =
            [(meeting.place, base), (here, sum)].map(|(between, beside)| {
                let choice = [product, Expression::ZERO, between, beside];
                self.pool.call(Function::SelectLess, &choice)
            });
        let end = [difference, Expression::ZERO, branches[0], branches[1]];
        let end = self.pool.call(Function::SelectLess, &end);
        let growth = self.pool.subtract(end, start);
        let mut there = Substitution::new();
        there.set(name, nearest);
        self.replace_in_changes(known, &mut there)?;
        there.apply(self.pool, growth)
    }
}
