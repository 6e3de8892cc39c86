//! Functions that grow as a power of the distance from a place: products, quotients, roots and powers of what is affine and
//! vanishes there.
//!
//! Such a function `w` of degree `d` has `w' v = d w v'`, where `v` is affine and vanishes at the place, so that
//! `w v / ((d + 1) v')` is an antiderivative of it, on both sides.

use super::affine::affine;
use super::antiderivative::Integration;
use super::expression::{Expression, Function, Operation};

/// How a function grows with the distance from a place.
#[derive(Clone, Copy)]
pub(super) struct Growth {
    /// What vanishes there, and minus the place; none for what is the same everywhere.
    pub(super) base: Option<(Expression, Expression)>,
    pub(super) degree: Expression,
}

impl Integration<'_> {
    /// Of a power of the distance from a place, whatever its form.
    pub(super) fn by_degree(&mut self, expression: Expression) -> Option<Expression> {
        let growth = self.growth(expression)?;
        let (base, _) = growth.base?;
        self.of_power(expression, base, growth.degree)
    }

    /// Of what grows with a degree from where the base vanishes.
    pub(super) fn of_power(
        &mut self,
        power: Expression,
        base: Expression,
        degree: Expression,
    ) -> Option<Expression> {
        let next = self.pool.add(degree, Expression::ONE);
        let product = self.pool.multiply(power, base);
        let value = if next == Expression::ZERO {
            // The product is a constant on each side.
            let size = self.pool.call(Function::Abs, &[base]);
            let logarithm = self.pool.call(Function::Ln, &[size]);
            self.pool.multiply(product, logarithm)
        } else {
            self.over_degree(product, base, next)?
        };
        self.inner(base, value, base)
    }

    fn growth(&mut self, expression: Expression) -> Option<Growth> {
        self.left = self.left.checked_sub(1)?;
        if self.is_free(expression) {
            let (base, degree) = (None, Expression::ZERO);
            return Some(Growth { base, degree });
        }
        if let Some(found) = self.distance(expression) {
            return Some(found);
        }
        match self.pool.operation(expression).clone() {
            Operation::Multiply(a, b) if a == b => {
                let two = self.pool.integer(2);
                self.power_of(a, two)
            }
            Operation::Multiply(a, b) => self.growth_of_factors(&[(a, false), (b, false)]),
            Operation::Divide(a, b) => self.growth_of_factors(&[(a, false), (b, true)]),
            Operation::Call(function, arguments) => match (function, &arguments[..]) {
                (Function::Abs, &[u]) => self.growth(u),
                (Function::Sign, &[u]) => self.power_of(u, Expression::ZERO),
                (Function::Sqrt, &[u]) => {
                    let two = self.pool.integer(2);
                    let half = self.pool.divide(Expression::ONE, two)?;
                    self.power_of(u, half)
                }
                (Function::Pow, &[u, exponent]) => self.power_of(u, exponent),
                (Function::Exp, &[exponent]) => {
                    let (factor, argument) = self.logarithm_in(exponent)?;
                    self.power_of(argument, factor)
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// Of what is affine itself.
    fn distance(&mut self, expression: Expression) -> Option<Growth> {
        let symbol = self.symbol;
        let (slope, rest) = affine(self.pool, expression, symbol, |it| *it == symbol)?;
        let place = self.pool.divide(rest, slope)?;
        Some(Growth {
            base: Some((expression.magnitude(), place)),
            degree: Expression::ONE,
        })
    }

    /// Of the product, if both grow from one place.
    fn together(&mut self, a: Growth, b: Growth) -> Option<Growth> {
        if let (Some((_, place)), Some((_, other))) = (a.base, b.base)
            && place != other
        {
            return None;
        }
        Some(Growth {
            base: a.base.or(b.base),
            degree: self.pool.add(a.degree, b.degree),
        })
    }

    /// Of the product of factors, some of which are divided by.
    pub(super) fn growth_of_factors(&mut self, factors: &[(Expression, bool)]) -> Option<Growth> {
        let (base, degree) = (None, Expression::ZERO);
        let mut whole = Growth { base, degree };
        for (factor, is_divisor) in factors {
            let exponent = Expression::ONE.flipped(*is_divisor);
            let growth = self.power_of(*factor, exponent)?;
            whole = self.together(whole, growth)?;
        }
        Some(whole)
    }

    fn power_of(&mut self, base: Expression, exponent: Expression) -> Option<Growth> {
        if !self.is_free(exponent) {
            return None;
        }
        let Growth { base, degree } = self.growth(base)?;
        let degree = self.pool.multiply(degree, exponent);
        Some(Growth { base, degree })
    }

    /// `c` and `w` of `c ln w`.
    fn logarithm_in(&self, exponent: Expression) -> Option<(Expression, Expression)> {
        let argument = |it: Expression| match self.pool.operation(it) {
            Operation::Call(Function::Ln, arguments) if !it.is_negative() => Some(arguments[0]),
            _ => None,
        };
        let (factor, argument) = match *self.pool.operation(exponent) {
            Operation::Multiply(a, b) => match argument(a) {
                Some(found) => (b, found),
                None => (a, argument(b)?),
            },
            _ => (Expression::ONE, argument(exponent.magnitude())?),
        };
        Some((factor.flipped(exponent.is_negative()), argument))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::symbolic::{Differentiator, Evaluation, Pool, Symbol, antiderivative};

    const X: Symbol = Symbol::State(0);
    const A: Symbol = Symbol::Parameter(0);

    /// Over each interval the energy grows by the integral of the law, and its derivative is the law.
    pub(in crate::symbolic) fn assert_integrated(
        intervals: &[[f64; 2]],
        law: impl Fn(&mut Pool, Expression, Expression) -> Expression,
    ) {
        let mut pool = Pool::new();
        let (x, a) = (pool.symbol(X), pool.symbol(A));
        let law = law(&mut pool, x, a);
        let found = antiderivative(&mut pool, law, X).expect("it has an antiderivative");
        let slope = Differentiator::new(X).derivative(&mut pool, found);
        let at = |expression: Expression, x: f64| {
            let symbol = |symbol| if symbol == X { x } else { 0.7 };
            Evaluation::new(&symbol).value(&pool, expression)
        };
        for [from, to] in intervals {
            let count = 4096;
            let step = (to - from) / f64::from(count);
            // Simpson's rule.
            let parts = (0..count).map(|k| {
                let left = from + step * f64::from(k);
                let [a, b, c] = [0.0, 0.5, 1.0].map(|part| at(law, left + part * step));
                step / 6.0 * (a + 4.0 * b + c)
            });
            let (sum, growth) = (parts.sum::<f64>(), at(found, *to) - at(found, *from));
            assert!(
                (growth - sum).abs() < 1e-9 * (1.0 + sum.abs()),
                "{growth} and {sum} from {from} to {to}"
            );
            for place in [*from, 0.7 * from + 0.3 * to, *to] {
                let (slope, expected) = (at(slope, place), at(law, place));
                assert!(
                    (slope - expected).abs() <= 1e-12 * (1.0 + expected.abs()),
                    "{slope}, not {expected} at {place}"
                );
            }
        }
    }

    const BOTH_SIDES: [[f64; 2]; 2] = [[-2.5, -0.5], [0.4, 3.0]];

    fn decimal(pool: &mut Pool, text: &str) -> Expression {
        pool.literal(text).expect("a number")
    }

    #[test]
    fn powers_of_quotients_are_integrated() {
        for exponent in [-3, -1, 1, 2, 7, 13] {
            assert_integrated(&BOTH_SIDES, |pool, x, _| {
                let number = decimal(pool, "0.34");
                let ratio = pool.divide(number, x).expect("a quotient");
                pool.power(ratio, exponent).expect("a power")
            });
            // (a / (a x + 2))ⁿ, with its pole at −20 / 7
            assert_integrated(&[[-9.0, -3.5], [-2.0, 5.0]], |pool, x, a| {
                let (product, two) = (pool.multiply(a, x), pool.integer(2));
                let sum = pool.add(product, two);
                let ratio = pool.divide(a, sum).expect("a quotient");
                pool.power(ratio, exponent).expect("a power")
            });
        }
        // (a / x)^(-2.4) and (a / x)^a, on the side where they are defined
        assert_integrated(&[[0.4, 3.0]], |pool, x, a| {
            let exponent = decimal(pool, "2.4").negated();
            let ratio = pool.divide(a, x).expect("a quotient");
            let first = pool.real_power(ratio, exponent).expect("a power");
            let second = pool.real_power(ratio, a).expect("a power");
            pool.subtract(first, second)
        });
    }

    #[test]
    fn sums_and_multiples_of_powers_are_integrated() {
        // Lennard-Jones, a (2 (a / x)¹³ − (a / x)⁷)
        assert_integrated(&BOTH_SIDES, |pool, x, a| {
            let ratio = pool.divide(a, x).expect("a quotient");
            let [steep, flat] = [13, 7].map(|it| pool.power(ratio, it).expect("a power"));
            let two = pool.integer(2);
            let twice = pool.multiply(two, steep);
            let difference = pool.subtract(twice, flat);
            pool.multiply(a, difference)
        });
        // (1 − a / x)²
        assert_integrated(&BOTH_SIDES, |pool, x, a| {
            let ratio = pool.divide(a, x).expect("a quotient");
            let rest = pool.subtract(Expression::ONE, ratio);
            pool.power(rest, 2).expect("a power")
        });
    }

    #[test]
    fn factors_of_one_place_are_one_power() {
        // 1 / (x √|x|), and its multiple by the sign
        assert_integrated(&BOTH_SIDES, |pool, x, _| {
            let size = pool.call(Function::Abs, &[x]);
            let root = pool.call(Function::Sqrt, &[size]);
            let product = pool.multiply(x, root);
            let odd = pool.divide(Expression::ONE, product).expect("a quotient");
            let sign = pool.call(Function::Sign, &[x]);
            let even = pool.multiply(sign, odd);
            let two = pool.integer(2);
            let twice = pool.multiply(two, even);
            pool.add(odd, twice)
        });
        // 1 / |x|, and x² / (2 x)⁵
        assert_integrated(&BOTH_SIDES, |pool, x, _| {
            let size = pool.call(Function::Abs, &[x]);
            let first = pool.divide(Expression::ONE, size).expect("a quotient");
            let two = pool.integer(2);
            let (square, twice) = (pool.multiply(x, x), pool.multiply(two, x));
            let fifth = pool.power(twice, 5).expect("a power");
            let second = pool.divide(square, fifth).expect("a quotient");
            pool.add(first, second)
        });
        // (x − a) √(x − a) exp(a ln(2 x − 2 a))
        assert_integrated(&[[0.8, 3.0]], |pool, x, a| {
            let way = pool.subtract(x, a);
            let root = pool.call(Function::Sqrt, &[way]);
            let two = pool.integer(2);
            let twice = pool.multiply(two, way);
            let logarithm = pool.call(Function::Ln, &[twice]);
            let exponent = pool.multiply(a, logarithm);
            let power = pool.call(Function::Exp, &[exponent]);
            let product = pool.multiply(way, root);
            pool.multiply(product, power)
        });
    }
}
