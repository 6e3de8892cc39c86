//! Integration of choices, and of what holds some.

use super::affine::affine;
use super::antiderivative::Integration;
use super::expression::{Expression, Function, Operation};
use super::substitute::{Substitution, replace, visit};
use super::vanishing::MOST_CHOICES;

/// All values of the symbol on one side of a place.
#[derive(Clone, Copy)]
pub(super) struct Side {
    place: Expression,
    is_above: bool,
}

/// How much further than the state kinks are where a closed form that is counted from them is left, twice.
const FAR: i64 = 1024;

/// Where the two sides of a choice are equal.
pub(super) struct Meeting {
    pub(super) difference: Expression,
    /// Of the difference.
    pub(super) slope: Expression,
    pub(super) place: Expression,
}

impl Integration<'_> {
    /// A choice inside an expression is one between two expressions: `u |u|` is `-u²` where `u < 0`, else `u²`.
    ///
    /// All choices that change where it does are made with it, and those beside powers, roots and logarithms before those inside
    /// of them. One that was left, such as the sign in `sign(u) f(|u|)`, would later be counted from there inside of others, of
    /// which one may have no value there: a root beyond a gap.
    pub(super) fn split(&mut self, expression: Expression) -> Option<Expression> {
        let mut parts = Vec::new();
        let mut limited = Vec::new();
        visit(self.pool, &[expression], |part, operation| {
            if let Some(choice) = choice_of(operation) {
                parts.push((part, choice));
            }
            if let Operation::Call(Function::Pow | Function::Sqrt | Function::Ln, arguments) =
                operation
            {
                limited.extend_from_slice(arguments);
            }
        });
        let mut inside = Vec::new();
        visit(self.pool, &limited, |part, _| inside.push(part));
        let differences: Vec<_> = parts
            .iter()
            .map(|(_, [a, b, ..])| self.pool.subtract(*a, *b))
            .collect();
        let mut known = Vec::new();
        for (place, difference) in differences.iter().enumerate() {
            if self.is_free(*difference) || self.slope(*difference).is_some() {
                known.push(place);
            }
        }
        let is_beside = |place: &&usize| !inside.contains(&parts[**place].0);
        let first = *known.iter().find(is_beside).or(known.first())?;
        let (_, [a, b, ..]) = parts[first];
        let mut branches = [Vec::new(), Vec::new()];
        for ((part, [_, _, c, d]), difference) in parts.into_iter().zip(&differences) {
            let values = if *difference == differences[first] {
                [c, d]
            } else if *difference == differences[first].negated() {
                [d, c]
            } else {
                continue;
            };
            for (branch, value) in branches.iter_mut().zip(values) {
                branch.push((part, value));
            }
        }
        let c = replace(self.pool, expression, &branches[0])?;
        let d = replace(self.pool, expression, &branches[1])?;
        self.choice(a, b, c, d)
    }

    /// Of `c` where `a < b`, else of `d`; both are counted from where they meet, which takes a value there.
    pub(super) fn choice(
        &mut self,
        a: Expression,
        b: Expression,
        c: Expression,
        d: Expression,
    ) -> Option<Expression> {
        let difference = self.pool.subtract(a, b);
        if self.is_free(difference) {
            let [c, d] = [self.of(c)?, self.of(d)?];
            return Some(self.pool.call(Function::SelectLess, &[a, b, c, d]));
        }
        let symbol = self.symbol;
        let (slope, rest) = affine(self.pool, difference, symbol, |it| *it == symbol)?;
        let place = self.pool.divide(rest.negated(), slope)?;
        let meeting = Meeting {
            difference,
            slope,
            place,
        };
        if let Some(found) = self.tried(|it| it.choice_that_may_vanish([c, d], &meeting))
            && self.parts == 0
        {
            return Some(found);
        }
        let known = self.changes.len();
        let is_deep = self.choices == MOST_CHOICES && self.may_vanish(slope);
        self.parts += usize::from(is_deep);
        let branches = self.branches_from(place, slope, [c, d]);
        self.parts -= usize::from(is_deep);
        let [c, d] = branches?;
        if self.parts > 0 || is_deep {
            // What begins where the branches meet says nothing of the whole, over which there are kinks unless they are far.
            self.changes.truncate(known);
            let near = self.share(difference, 1, FAR)?;
            self.must_change(slope, near);
        }
        Some(self.pool.call(Function::SelectLess, &[a, b, c, d]))
    }

    /// Of the branches of a choice, counted from where they meet.
    pub(super) fn branches_from(
        &mut self,
        place: Expression,
        slope: Expression,
        [c, d]: [Expression; 2],
    ) -> Option<[Expression; 2]> {
        let rises = self.pool.constant_value(slope).map(|slope| slope > 0.0);
        let side = |is_above| Some(Side { place, is_above });
        let c = self.counted_from(place, rises.and_then(|rises| side(!rises)), c)?;
        let d = self.counted_from(place, rises.and_then(side), d)?;
        Some([c, d])
    }

    /// Of an expression that counts on one side alone, where that is known, and whose integral begins at a place.
    fn beside(
        &mut self,
        place: Expression,
        side: Option<Side>,
        expression: Expression,
    ) -> Option<Expression> {
        let before = self.base.replace(place);
        self.sides.extend(side);
        let found = self.of(expression);
        self.sides
            .truncate(self.sides.len() - usize::from(side.is_some()));
        self.base = before;
        found
    }

    /// The antiderivative that is zero at a place; of what may have no value there, at the next place at which it counts.
    fn counted_from(
        &mut self,
        place: Expression,
        side: Option<Side>,
        expression: Expression,
    ) -> Option<Expression> {
        let mut found = self.beside(place, side, expression)?;
        let mut start = self.at(place, found);
        if start.is_none_or(|it| self.is_limited(it)) {
            let counting = self.nearest(place);
            if counting != place {
                found = self.beside(counting, side, expression)?;
                start = self.at(counting, found);
            }
        }
        Some(self.pool.subtract(found, start?))
    }

    /// The place that is nearest to another on the sides where what is integrated counts.
    pub(super) fn nearest(&mut self, place: Expression) -> Expression {
        let sides = self.sides.clone();
        sides.into_iter().fold(place, |nearest, side| {
            let further = if side.is_above {
                Function::Max
            } else {
                Function::Min
            };
            if self.is_beyond(nearest, further, side.place) {
                return nearest;
            }
            self.pool.call(further, &[nearest, side.place])
        })
    }

    /// Whether a place is chosen to be no nearer than another.
    fn is_beyond(&self, place: Expression, further: Function, other: Expression) -> bool {
        place == other
            || matches!(
                self.pool.operation(place),
                Operation::Call(function, places)
                    if *function == further && !place.is_negative()
                        && places.iter().any(|it| self.is_beyond(*it, further, other))
            )
    }

    /// The value at a place, if it is known to have one.
    pub(super) fn at(&mut self, place: Expression, expression: Expression) -> Option<Expression> {
        let mut there = Substitution::new();
        there.set(self.symbol, place);
        let value = there.apply(self.pool, expression)?;
        (!self.is_infinite(value)).then_some(value)
    }

    /// Whether there is a root, a power or a logarithm in it, which some parameters have no value for.
    pub(super) fn is_limited(&self, expression: Expression) -> bool {
        let mut found = false;
        visit(self.pool, &[expression], |_, operation| {
            found |= matches!(
                operation,
                Operation::Call(Function::Pow | Function::Sqrt | Function::Ln, _)
            );
        });
        found
    }

    /// Whether a part of it has no finite value for any parameters: calls of constants are numbers otherwise.
    fn is_infinite(&self, expression: Expression) -> bool {
        let is_constant = |it: &Expression| self.pool.constant_value(*it).is_some();
        let mut found = false;
        visit(self.pool, &[expression], |_, operation| {
            if let Operation::Call(_, arguments) = operation {
                found |= arguments.iter().all(is_constant);
            }
        });
        found
    }
}

/// `[a, b, c, d]` of what is `c` where `a < b`, else `d`.
pub(crate) fn choice_of(operation: &Operation) -> Option<[Expression; 4]> {
    let Operation::Call(function, arguments) = operation else {
        return None;
    };
    Some(match (function, &arguments[..]) {
        (Function::Min, &[a, b]) => [a, b, a, b],
        (Function::Max, &[a, b]) => [a, b, b, a],
        (Function::SelectLess, &[a, b, c, d]) => [a, b, c, d],
        (Function::Abs, &[u]) => [u, Expression::ZERO, u.negated(), u],
        (Function::Sign, &[u]) => [
            u,
            Expression::ZERO,
            Expression::ONE.negated(),
            Expression::ONE,
        ],
        _ => return None,
    })
}
