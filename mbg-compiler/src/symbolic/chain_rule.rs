//! Integration by substitution, the chain rule read backwards: of `h(u) u'` it is `H(u)`, where `H` is an
//! antiderivative of `h`.

use std::collections::BTreeMap;

use super::antiderivative::Integration;
use super::differentiate::Differentiator;
use super::expression::{Expression, Function, Operation, Symbol};
use super::field::Image;
use super::products::number;
use super::substitute::{Substitution, replace, visit};

/// Largest exponent of a factor.
const LARGEST: u32 = 256;

impl Integration<'_> {
    /// By the first function inside the expression that fits.
    pub(super) fn by_substitution(&mut self, expression: Expression) -> Option<Expression> {
        let mut slopes = Differentiator::new(self.symbol);
        for inner in self.inners(expression) {
            self.inner_left = self.inner_left.checked_sub(1)?;
            let slope = slopes.derivative(self.pool, inner);
            if let Some(found) = self.by_inner(expression, inner, slope) {
                return Some(found);
            }
        }
        None
    }

    /// What functions, products and quotients inside the expression are of, unless it is affine in the symbol.
    fn inners(&mut self, expression: Expression) -> Vec<Expression> {
        let mut inners = Vec::new();
        visit(self.pool, &[expression], |_, operation| {
            if !matches!(operation, Operation::Add(..)) {
                inners.extend(operation.operands().iter().map(|it| it.magnitude()));
            }
        });
        let mut found = Vec::new();
        for inner in inners {
            if !found.contains(&inner)
                && !self.is_free(inner)
                && self.is_continuous(inner)
                && self.slope(inner).is_none()
            {
                found.push(inner);
            }
        }
        found
    }

    /// Whether it has no jumps and no poles, over which the antiderivative would have another constant.
    fn is_continuous(&self, inner: Expression) -> bool {
        use Function::{Atan2, Fraction, Pow, SelectLess, Sign, Tan};
        let mut jumping = Vec::new();
        visit(self.pool, &[inner], |_, operation| match operation {
            Operation::Divide(_, divisor) => jumping.push(*divisor),
            Operation::Call(Sign | Tan | Atan2 | Fraction | SelectLess, arguments) => {
                jumping.extend(arguments);
            }
            // With an exponent below zero it has a pole.
            Operation::Call(Pow, arguments) => {
                let exponent = self.pool.constant_value(arguments[1]);
                if exponent.is_none_or(|it| it < 0.0) {
                    jumping.push(arguments[0]);
                }
            }
            _ => {}
        });
        jumping.into_iter().all(|it| self.is_free(it))
    }

    fn by_inner(
        &mut self,
        expression: Expression,
        inner: Expression,
        slope: Expression,
    ) -> Option<Expression> {
        let name = Symbol::Unknown(self.pool.fresh_unknown());
        let named = self.pool.symbol(name);
        let mut parts = vec![(inner, named)];
        if let Operation::Call(Function::Sqrt, arguments) = self.pool.operation(inner) {
            let argument = arguments[0];
            parts.push((argument, self.pool.multiply(named, named)));
        }
        let whole = replace(self.pool, expression, &parts)?;
        let slope = replace(self.pool, slope, &parts)?;
        let factors = self.quotient_without_symbol(whole, slope)?;
        let mut there = Substitution::new();
        let base = self.base.and_then(|base| {
            there.set(self.symbol, base);
            there.apply(self.pool, inner)
        });
        let outside = (
            std::mem::replace(&mut self.symbol, name),
            std::mem::replace(&mut self.base, base),
        );
        let known = self.changes.len();
        let found = self.of_factors(factors);
        (self.symbol, self.base) = outside;
        let mut back = Substitution::new();
        back.set(name, inner);
        self.replace_in_changes(known, &mut back)?;
        back.apply(self.pool, found?)
    }

    /// Factors of the quotient with their exponents, if none of them reads the symbol once equal ones are cancelled and
    /// the rest is a number.
    fn quotient_without_symbol(
        &mut self,
        dividend: Expression,
        divisor: Expression,
    ) -> Option<BTreeMap<Expression, i32>> {
        let mut exponents: BTreeMap<Expression, i32> = BTreeMap::new();
        // Last nodes first, so that each is taken apart once, with all its exponents.
        let mut pending = BTreeMap::from([(dividend.magnitude(), 1_i32)]);
        *pending.entry(divisor.magnitude()).or_insert(0) -= 1;
        let mut rest = Image::ONE;
        if dividend.is_negative() != divisor.is_negative() {
            rest = rest.negated();
        }
        while let Some((factor, exponent)) = pending.pop_last() {
            let (a, b, sign) = match *self.pool.operation(factor) {
                Operation::Multiply(a, b) => (a, b, 1),
                Operation::Divide(a, b) => (a, b, -1),
                _ => {
                    *exponents.entry(factor).or_insert(0) += exponent;
                    continue;
                }
            };
            for (part, exponent) in [(a, exponent), (b, sign * exponent)] {
                if part.is_negative() && exponent % 2 != 0 {
                    rest = rest.negated();
                }
                let sum = pending.entry(part.magnitude()).or_insert(0);
                *sum += exponent;
                if sum.unsigned_abs() > LARGEST {
                    return None;
                }
            }
        }
        exponents.retain(|_, exponent| *exponent != 0);
        for (factor, exponent) in &exponents {
            if self.is_free(*factor) {
                continue;
            }
            let image = self.pool.image(*factor);
            let image = if *exponent < 0 {
                image.inverted()?
            } else {
                image
            };
            for _ in 0..exponent.unsigned_abs() {
                rest = rest.times(image);
            }
        }
        let number = number(self.pool, rest)?;
        exponents.retain(|factor, _| self.is_free(*factor));
        *exponents.entry(number).or_insert(0) += 1;
        Some(exponents)
    }

    /// An antiderivative of a product of powers, of which those without the symbol come before it.
    fn of_factors(&mut self, factors: BTreeMap<Expression, i32>) -> Option<Expression> {
        let mut free = [Expression::ONE; 2];
        let mut varying = [Expression::ONE; 2];
        for (factor, exponent) in factors {
            let power = self.pool.power(factor, exponent.abs())?;
            let side = if self.is_free(factor) {
                &mut free
            } else {
                &mut varying
            };
            let product = &mut side[usize::from(exponent < 0)];
            *product = self.pool.multiply(*product, power);
        }
        let is_divided = self.is_divided;
        self.is_divided |= self.may_vanish(free[1]);
        let [free, varying] = [free, varying].map(|[a, b]| self.pool.divide(a, b));
        let integral = varying.and_then(|varying| self.part(varying));
        self.is_divided = is_divided;
        Some(self.pool.multiply(free?, integral?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::{Evaluation, Pool, antiderivative};

    const X: Symbol = Symbol::State(0);
    const A: Symbol = Symbol::Parameter(0);

    /// Derivatives of antiderivatives are the laws, on both sides of zero and there.
    fn assert_integrated(law: impl Fn(&mut Pool, Expression) -> Expression) {
        let mut pool = Pool::new();
        let x = pool.symbol(X);
        let law = law(&mut pool, x);
        let found = antiderivative(&mut pool, law, X).expect("it has an antiderivative");
        let at = |expression: Expression, x: f64| {
            let symbol = |symbol| match symbol {
                X => x,
                A => 0.7,
                other => panic!("{other:?} is left"),
            };
            Evaluation::new(&symbol).value(&pool, expression)
        };
        for x in [-2.5, -1.0, -0.3, 0.0, 0.3, 1.0, 2.5] {
            // By differences, since the pool would find the law again by its image.
            let step = 1e-3;
            let difference = |step: f64| (at(found, x + step) - at(found, x - step)) / (2.0 * step);
            let slope = (4.0 * difference(step / 2.0) - difference(step)) / 3.0;
            let expected = at(law, x);
            let tolerance = 1e-9 * (1.0 + expected.abs());
            assert!(
                (slope - expected).abs() < tolerance,
                "{slope}, not {expected} at {x}"
            );
        }
    }

    /// `1 + x²`
    fn round(pool: &mut Pool, x: Expression) -> Expression {
        let square = pool.multiply(x, x);
        pool.add(Expression::ONE, square)
    }

    fn bell(pool: &mut Pool, x: Expression) -> Expression {
        let square = pool.multiply(x, x);
        let bell = pool.call(Function::Exp, &[square.negated()]);
        pool.multiply(x, bell)
    }

    /// `a x / √(1 + (x / a)²)`
    fn saturating(pool: &mut Pool, x: Expression) -> Expression {
        let a = pool.symbol(A);
        let ratio = pool.divide(x, a).expect("a quotient");
        let round = round(pool, ratio);
        let root = pool.call(Function::Sqrt, &[round]);
        let product = pool.multiply(a, x);
        pool.divide(product, root).expect("a quotient")
    }

    #[test]
    fn laws_are_integrated_by_what_is_inside() {
        assert_integrated(bell);
        assert_integrated(saturating);
        assert_integrated(|pool, x| {
            let round = round(pool, x);
            pool.divide(x, round).expect("a quotient")
        });
        // x / (u √u)
        assert_integrated(|pool, x| {
            let round = round(pool, x);
            let root = pool.call(Function::Sqrt, &[round]);
            let product = pool.multiply(round, root);
            pool.divide(x, product).expect("a quotient")
        });
        // sin³ cos, and tanh of 1 − x² times x
        assert_integrated(|pool, x| {
            let (sine, cosine) = (pool.sine(x), pool.cosine(x));
            let cube = pool.power(sine, 3).expect("a power");
            pool.multiply(cosine, cube)
        });
        assert_integrated(|pool, x| {
            let square = pool.multiply(x, x);
            let rest = pool.subtract(Expression::ONE, square);
            let inside = pool.call(Function::Tanh, &[rest]);
            pool.multiply(x, inside)
        });
    }

    #[test]
    fn derivatives_may_be_sums_and_multiples() {
        // (x + 1/2) exp(−x² − x)
        assert_integrated(|pool, x| {
            let half = pool.literal("0.5").expect("a number");
            let square = pool.multiply(x, x);
            let sum = pool.add(square, x);
            let bell = pool.call(Function::Exp, &[sum.negated()]);
            let factor = pool.add(x, half);
            pool.multiply(factor, bell)
        });
    }

    #[test]
    fn terms_are_integrated_each_in_its_way() {
        assert_integrated(|pool, x| {
            let (bell, saturating) = (bell(pool, x), saturating(pool, x));
            let (sine, size) = (pool.sine(x), pool.call(Function::Tanh, &[x]));
            pool.sum(&[bell, sine, saturating.negated(), x, size])
        });
        // One on each side of a place
        assert_integrated(|pool, x| {
            let place = pool.literal("0.5").expect("a number");
            let (bell, sine) = (bell(pool, x), pool.sine(x));
            pool.call(Function::SelectLess, &[place, x, bell, sine])
        });
    }

    #[test]
    fn what_jumps_is_no_inner_function() {
        let mut pool = Pool::new();
        let x = pool.symbol(X);
        // The arc tangent of 1 / x jumps at zero, and its derivative −1 / (1 + x²) does not.
        let reciprocal = pool.divide(Expression::ONE, x).expect("a quotient");
        let angle = pool.call(Function::Atan2, &[reciprocal, Expression::ONE]);
        let slope = Differentiator::new(X).derivative(&mut pool, angle);
        let tangent = pool.call(Function::Tanh, &[angle]);
        let law = pool.multiply(slope, tangent);
        assert_eq!(antiderivative(&mut pool, law, X), None);
    }
}
