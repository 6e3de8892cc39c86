//! Sums, products, quotients and powers in the forms that cost least at an evaluation.
//!
//! What is there already is found by its value, what changes seldom is gathered, and common factors are taken out where
//! that saves work.

use rustc_hash::FxHashSet;

use super::expression::{Expression, Function, Operation, Rate};
use super::field::Image;
use super::pool::Pool;

/// Whole exponents up to this are products.
pub const LARGEST_POWER: f64 = 64.0;

/// Most terms of an exponent that are looked at for logarithms.
const MOST_TERMS: usize = 16;

impl Pool {
    /// Sum.
    pub fn add(&mut self, a: Expression, b: Expression) -> Expression {
        if a == Expression::ZERO {
            return b;
        }
        if b == Expression::ZERO {
            return a;
        }
        let image = self.image(a).plus(self.image(b));
        if let Some(expression) = self.known(image, &[a, b]) {
            return expression;
        }
        if [a, b].map(|term| self.rate(term)) == [Rate::Constant; 2] {
            return self.put_sum(a, b);
        }
        if let Some(collected) = self.collect(a, b) {
            return collected;
        }
        if let Some(gathered) = self.gather(a, b) {
            return gathered;
        }
        self.put_sum(a, b)
    }

    /// The sum in this form, if there is none in another.
    fn put_sum(&mut self, a: Expression, b: Expression) -> Expression {
        if a == Expression::ZERO {
            return b;
        }
        if b == Expression::ZERO {
            return a;
        }
        let image = self.image(a).plus(self.image(b));
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return self.constant(x + y, image);
        }
        match (a.is_negative(), b.is_negative()) {
            (true, true) => self
                .intern(Operation::Add(a.negated(), b.negated()), image.negated())
                .negated(),
            (true, false) => self.intern(Operation::Add(b, a), image),
            _ => self.intern(Operation::Add(a, b), image),
        }
    }

    /// Terms that change seldom are gathered and added last: `(x + a) + (y + b)` is `(x + y) + (a + b)`.
    fn gather(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let (first, slow) = self.apart(a);
        let (second, other) = self.apart(b);
        let is_mixed = |fast, slow| fast != Expression::ZERO && slow != Expression::ZERO;
        if !is_mixed(first, slow) && !is_mixed(second, other) {
            return None;
        }
        let fast = self.add(first, second);
        let slow = self.add(slow, other);
        // Put down as it is: what is known under another form need not come apart again.
        Some(self.put_sum(fast, slow))
    }

    /// A sum as what changes often and what changes seldom.
    fn apart(&self, sum: Expression) -> (Expression, Expression) {
        if self.rate(sum) != Rate::Varying {
            return (Expression::ZERO, sum);
        }
        if let Operation::Add(first, second) = *self.operation(sum) {
            let [first, second] = [first, second].map(|term| term.flipped(sum.is_negative()));
            match (self.rate(first), self.rate(second)) {
                (Rate::Varying, Rate::Varying) => {}
                (Rate::Varying, _) => return (first, second),
                _ => return (second, first),
            }
        }
        (sum, Expression::ZERO)
    }

    /// The sum with a common factor taken out, where what remains in the brackets is known already or is computed once
    /// when a model is built: that is how `m cos² + m sin²` becomes `m`, and `a x y − b x y` becomes `(a − b) x y`.
    fn collect(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let left = self.factors(a);
        let mut right = self.factors(b);
        let mut common = Vec::new();
        let mut rest = Vec::new();
        for factor in left {
            match right.iter().position(|other| *other == factor) {
                Some(position) => common.push(right.swap_remove(position)),
                None => rest.push(factor),
            }
        }
        if common.is_empty() {
            return None;
        }
        let product = |pool: &Self, factors: &[Expression], negative: bool| {
            let start = if negative {
                Image::ONE.negated()
            } else {
                Image::ONE
            };
            factors
                .iter()
                .fold(start, |image, factor| image.times(pool.image(*factor)))
        };
        let image = product(self, &rest, a.is_negative());
        let image = image.plus(product(self, &right, b.is_negative()));
        let varies = |factor: &Expression| self.rate(*factor) == Rate::Varying;
        let whole = match self.known(image, &[a, b]) {
            Some(whole) => whole,
            None if rest.iter().chain(&right).any(varies) => return None,
            None => {
                let multiply = |pool: &mut Self, factors: Vec<Expression>, negative: bool| {
                    let start = Expression::ONE.flipped(negative);
                    factors
                        .into_iter()
                        .fold(start, |product, factor| pool.multiply(product, factor))
                };
                let left = multiply(self, rest, a.is_negative());
                let right = multiply(self, right, b.is_negative());
                // What is there already may be a product of more: factors would be taken out in turns without an end.
                let [before, after] = [[a, b], [left, right]]
                    .map(|terms| terms.map(|it| self.factors(it).len()).iter().sum::<usize>());
                let are_numbers = [left, right].map(|it| self.constant_value(it).is_some());
                if after < before || are_numbers == [true; 2] {
                    self.add(left, right)
                } else {
                    self.put_sum(left, right)
                }
            }
        };
        // A product with one of them that is there is not made again.
        let is_known = |factor: &Expression| {
            let image = self.image(whole).times(self.image(*factor));
            self.find(image).is_some()
        };
        let known = common.iter().position(is_known);
        let first = known.map(|position| common.swap_remove(position));
        let whole = first.map_or(whole, |first| self.multiply(whole, first));
        let common = common.into_iter().fold(Expression::ONE, |product, factor| {
            self.multiply(product, factor)
        });
        Some(self.multiply(whole, common))
    }

    /// Factors of a product, without their signs.
    pub(super) fn factors(&self, product: Expression) -> Vec<Expression> {
        let mut factors = Vec::new();
        let mut pending = vec![product.magnitude()];
        while let Some(current) = pending.pop() {
            match self.operation(current) {
                Operation::Multiply(a, b) if factors.len() + pending.len() < 16 => {
                    pending.extend([*a, *b]);
                }
                _ => factors.push(current),
            }
        }
        factors
    }

    /// Difference.
    pub fn subtract(&mut self, a: Expression, b: Expression) -> Expression {
        self.add(a, b.negated())
    }

    /// Sum of several, from the left.
    pub fn sum(&mut self, terms: &[Expression]) -> Expression {
        terms
            .iter()
            .fold(Expression::ZERO, |sum, term| self.add(sum, *term))
    }

    /// Product. Factors that change seldom are gathered: `a (b x)` is `(a b) x`, and `(a x) y` is `a (x y)` if `x y` is
    /// there.
    pub fn multiply(&mut self, a: Expression, b: Expression) -> Expression {
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        self.multiply_magnitudes(a, b).flipped(negative)
    }

    fn multiply_magnitudes(&mut self, a: Expression, b: Expression) -> Expression {
        if a == Expression::ZERO || b == Expression::ZERO {
            return Expression::ZERO;
        }
        if a == Expression::ONE {
            return b;
        }
        if b == Expression::ONE {
            return a;
        }
        let image = self.image(a).times(self.image(b));
        if let Some(expression) = self.known(image, &[a, b]) {
            return expression;
        }
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return self.constant(x * y, image);
        }
        let (slow, fast) = if self.rate(a) <= self.rate(b) {
            (a, b)
        } else {
            (b, a)
        };
        let (inner, first) = self.scaled(slow);
        let (outer, second) = self.scaled(fast);
        let is_mixed = |slow, fast| slow != Expression::ONE && fast != Expression::ONE;
        let product = match first {
            Expression::ONE => is_mixed(outer, second).then_some(second),
            _ if !is_mixed(inner, first) && !is_mixed(outer, second) => None,
            _ => self.find(self.image(first).times(self.image(second))),
        };
        if let Some(product) = product {
            let gathered = self.multiply(inner, outer);
            return self.multiply(gathered, product);
        }
        self.intern(Operation::Multiply(slow, fast), image)
    }

    /// A product as the factors that change seldom, and those that change often, without its sign.
    #[must_use]
    pub fn scaled(&self, product: Expression) -> (Expression, Expression) {
        if self.rate(product) != Rate::Varying {
            return (product, Expression::ONE);
        }
        match *self.operation(product) {
            Operation::Multiply(slow, fast) if self.rate(slow) != Rate::Varying => (slow, fast),
            _ => (Expression::ONE, product),
        }
    }

    /// Quotient; none if the divisor is identically zero.
    #[must_use]
    pub fn divide(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        let inverse = self.image(b).inverted()?;
        let image = self.image(a).times(inverse);
        if let Some(expression) = self.known(image, &[a, b]) {
            return Some(expression.flipped(negative));
        }
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return Some(self.constant(x / y, image).flipped(negative));
        }
        let quotient = if self.rate(b) < self.rate(a) {
            let reciprocal = self.divide(Expression::ONE, b)?;
            self.multiply(reciprocal, a)
        } else {
            self.intern(Operation::Divide(a, b), image)
        };
        Some(quotient.flipped(negative))
    }

    /// Integer power by repeated squaring; none for a negative power of zero.
    #[must_use]
    pub fn power(&mut self, base: Expression, exponent: i32) -> Option<Expression> {
        let mut result = Expression::ONE;
        let mut square = base;
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = self.multiply(result, square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.multiply(square, square);
            }
        }
        if exponent < 0 {
            self.divide(Expression::ONE, result)
        } else {
            Some(result)
        }
    }

    /// The exponential of a sum without the logarithms in it that whole numbers multiply: of `ln u + 2 ln v + w` it is
    /// `u v² e^w`. None if there are no such.
    ///
    /// Both are the same where the logarithms have values. The product goes on from there to zero, and below, where rounding
    /// takes an amount that is used up: rates that are proportional to it bring it back.
    pub(super) fn without_logarithms(&mut self, exponent: Expression) -> Option<Expression> {
        if !self.holds_logarithm(exponent) {
            return None;
        }
        let mut powers = Vec::new();
        let mut rest = Expression::ZERO;
        let mut pending = vec![(exponent, Expression::ONE)];
        while let Some((term, multiple)) = pending.pop() {
            let whole = |multiple| {
                let value = self.constant_value(multiple)?;
                (value.fract() == 0.0 && value.abs() <= LARGEST_POWER).then_some(value as i32)
            };
            let multiple = multiple.flipped(term.is_negative());
            match *self.operation(term) {
                Operation::Add(a, b) if powers.len() + pending.len() < MOST_TERMS => {
                    pending.extend([(b, multiple), (a, multiple)]);
                    continue;
                }
                Operation::Multiply(a, b) if self.holds_logarithm(b) => {
                    pending.push((b, self.multiply(multiple, a)));
                    continue;
                }
                Operation::Multiply(a, b) if self.holds_logarithm(a) => {
                    pending.push((a, self.multiply(multiple, b)));
                    continue;
                }
                Operation::Divide(a, b) if self.holds_logarithm(a) => {
                    pending.push((a, self.divide(multiple, b)?));
                    continue;
                }
                Operation::Call(Function::Ln, ref arguments) => {
                    if let Some(whole) = whole(multiple) {
                        powers.push((arguments[0], whole));
                        continue;
                    }
                }
                _ => {}
            }
            let term = self.multiply(term.magnitude(), multiple);
            rest = self.add(rest, term);
        }
        if powers.is_empty() {
            return None;
        }
        let mut product = match rest {
            Expression::ZERO => Expression::ONE,
            _ => self.call(Function::Exp, &[rest]),
        };
        for (base, whole) in powers {
            let power = self.power(base, whole.abs())?;
            product = if whole < 0 {
                self.divide(product, power)?
            } else {
                self.multiply(product, power)
            };
        }
        Some(product)
    }

    /// Whether a logarithm is among the terms of a sum, or the factors of a product.
    fn holds_logarithm(&self, sum: Expression) -> bool {
        let mut pending = vec![sum];
        let mut seen = FxHashSet::default();
        while let Some(term) = pending.pop() {
            match *self.operation(term) {
                Operation::Add(a, b) | Operation::Multiply(a, b)
                    if pending.len() < MOST_TERMS && seen.insert(term.node()) =>
                {
                    pending.extend([a, b]);
                }
                Operation::Divide(a, _) => pending.push(a),
                Operation::Call(Function::Ln, _) => return true,
                _ => {}
            }
        }
        false
    }

    /// Power with any exponent, of a base that is not negative unless the exponent is whole; none for a negative power of
    /// zero.
    #[must_use]
    pub fn real_power(&mut self, base: Expression, exponent: Expression) -> Option<Expression> {
        match self.constant_value(exponent) {
            Some(whole) if whole.fract() == 0.0 && whole.abs() <= LARGEST_POWER => {
                self.power(base, whole as i32)
            }
            Some(0.5) => Some(self.call(Function::Sqrt, &[base])),
            Some(negative) if negative < 0.0 && base == Expression::ZERO => None,
            _ => Some(self.call(Function::Pow, &[base, exponent])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Symbol;
    use super::*;

    #[test]
    fn a_sum_of_what_comes_to_numbers_is_a_number() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let [three, four] = [3, 4].map(|it| pool.integer(it));
        let parts = [pool.sine(x), pool.cosine(x)];
        let squares = parts.map(|it| pool.multiply(it, it));
        let left = pool.add(squares[0], three);
        let right = pool.add(squares[1], four);
        let sum = pool.add(left, right);
        assert_eq!(pool.constant_value(sum), Some(8.0));
    }

    #[test]
    fn what_varied_at_first_is_replaced_by_what_does_not() {
        let mut pool = Pool::new();
        let [x, p] = [Symbol::State(0), Symbol::Parameter(0)].map(|it| pool.symbol(it));
        let seven = pool.integer(7);
        let whole = pool.multiply(seven, x);
        for (part, rate) in [(Expression::ONE, Rate::Constant), (p, Rate::Parameter)] {
            let product = pool.multiply(part, x);
            let first = pool.divide(product, whole).unwrap();
            assert_eq!(pool.rate(first), Rate::Varying);
            let quotient = pool.divide(part, seven).unwrap();
            assert_eq!(pool.rate(quotient), rate);
            assert_eq!(pool.image(quotient), pool.image(first));
            assert_eq!(pool.divide(product, whole), Some(quotient));
        }
    }
}
