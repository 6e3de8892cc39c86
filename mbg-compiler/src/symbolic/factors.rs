//! Integration of products by what their factors are: polynomials beside a power of a distance, or beside an exponential, a
//! sine or a cosine.

use super::affine::affine;
use super::antiderivative::Integration;
use super::differentiate::Differentiator;
use super::expression::{Expression, Function, Operation};
use super::substitute::Substitution;

/// Most factors of a product.
const MOST: usize = 64;

/// A factor, and whether it is divided by.
type Factor = (Expression, bool);

impl Integration<'_> {
    /// Of a polynomial in factors that multiplies something else.
    pub(super) fn by_factors(&mut self, product: Expression) -> Option<Expression> {
        let factors = self.apart(product)?;
        let (affine, others): (Vec<Factor>, Vec<Factor>) = factors
            .into_iter()
            .partition(|(factor, is_divisor)| !is_divisor && self.slope(*factor).is_some());
        if affine.is_empty() {
            return None;
        }
        let (free, varying): (Vec<Factor>, Vec<Factor>) = others
            .into_iter()
            .partition(|(factor, _)| self.is_free(*factor));
        let coefficient = self.product_of_factors(&free)?;
        let affine: Vec<_> = affine.into_iter().map(|(factor, _)| factor).collect();
        let found = match varying[..] {
            [] => return None,
            [(wave, false)] if self.is_wave(wave) => self.by_parts(&affine, wave)?,
            _ => self.around_its_place(&affine, &varying)?,
        };
        Some(self.pool.multiply(coefficient, found))
    }

    fn product_of_factors(&mut self, factors: &[Factor]) -> Option<Expression> {
        let mut sides = [Expression::ONE; 2];
        for (factor, is_divisor) in factors {
            let side = &mut sides[usize::from(*is_divisor)];
            *side = self.pool.multiply(*side, *factor);
        }
        self.pool.divide(sides[0], sides[1])
    }

    /// Factors, and whether they are divided by.
    fn apart(&self, product: Expression) -> Option<Vec<Factor>> {
        let mut found = Vec::new();
        let mut pending = vec![(product, false)];
        while let Some((factor, is_divisor)) = pending.pop() {
            if found.len() + pending.len() > MOST {
                return None;
            }
            let parts = match *self.pool.operation(factor) {
                Operation::Multiply(a, b) => [(a, is_divisor), (b, is_divisor)],
                Operation::Divide(a, b) => [(a, is_divisor), (b, !is_divisor)],
                _ => {
                    found.push((factor, is_divisor));
                    continue;
                }
            };
            let [(first, is_first_divisor), second] = parts;
            let first = first.flipped(factor.is_negative());
            pending.extend([(first, is_first_divisor), second]);
        }
        Some(found)
    }

    /// Factors beside a power of the distance from a place are a polynomial in that distance.
    ///
    /// How the terms grow is worked out from the factors: a product of them may be known in a form that does not show it.
    fn around_its_place(
        &mut self,
        affine_ones: &[Expression],
        others: &[Factor],
    ) -> Option<Expression> {
        let growth = self.growth_of_factors(others)?;
        let (base, _) = growth.base?;
        let symbol = self.symbol;
        let (slope, rest) = affine(self.pool, base, symbol, |it| *it == symbol)?;
        let mut there = Substitution::new();
        there.set(symbol, self.pool.divide(rest.negated(), slope)?);
        let mut coefficients = vec![Expression::ONE];
        for factor in affine_ones {
            let value = there.apply(self.pool, *factor)?;
            let steepness = self.slope(*factor)?;
            let steepness = self.pool.divide(steepness, slope)?;
            let mut next = vec![Expression::ZERO; coefficients.len() + 1];
            for (degree, coefficient) in coefficients.into_iter().enumerate() {
                for (degree, share) in [(degree, value), (degree + 1, steepness)] {
                    let term = self.pool.multiply(coefficient, share);
                    next[degree] = self.pool.add(next[degree], term);
                }
            }
            coefficients = next;
        }
        let mut power = self.product_of_factors(others)?;
        let mut degree = growth.degree;
        let mut total = Expression::ZERO;
        for coefficient in coefficients {
            let integral = self.of_power(power, base, degree)?;
            let term = self.pool.multiply(coefficient, integral);
            total = self.pool.add(total, term);
            power = self.pool.multiply(power, base);
            degree = self.pool.add(degree, Expression::ONE);
        }
        Some(total)
    }

    /// Whether its antiderivatives of any order are multiples of it, or of its derivative.
    fn is_wave(&mut self, factor: Expression) -> bool {
        let argument = match self.pool.operation(factor) {
            Operation::Sine(angle) | Operation::Cosine(angle) => *angle,
            Operation::Call(Function::Exp, arguments) => arguments[0],
            _ => return false,
        };
        self.slope(argument).is_some()
    }

    /// `∫ f g = f G − ∫ f' G`, which ends since the degree of `f` falls.
    fn by_parts(&mut self, factors: &[Expression], wave: Expression) -> Option<Expression> {
        let factor = factors
            .iter()
            .fold(Expression::ONE, |a, b| self.pool.multiply(a, *b));
        let integral = self.part(wave)?;
        let slope = Differentiator::new(self.symbol).derivative(self.pool, factor);
        let [whole, rest] = [factor, slope].map(|it| self.pool.multiply(it, integral));
        let rest = self.part(rest)?;
        Some(self.pool.subtract(whole, rest))
    }

    /// Of the logarithm of a product of affine factors: the sum of theirs.
    pub(super) fn logarithm_of_product(&mut self, product: Expression) -> Option<Expression> {
        let mut total = Expression::ZERO;
        for (factor, is_divisor) in self.apart(product)? {
            let size = self.pool.call(Function::Abs, &[factor]);
            let integral = if self.is_free(factor) {
                let logarithm = self.pool.call(Function::Ln, &[size]);
                self.of(logarithm)?
            } else {
                let known = self.changes.len();
                let value = self.logarithm(factor, size);
                let integral = self.inner(factor, value, factor)?;
                // By itself, since others may be infinite on the way.
                let logarithm = self.pool.call(Function::Ln, &[size]);
                self.guarded(logarithm, integral, known)
            };
            total = self.pool.add(total, integral.flipped(is_divisor));
        }
        Some(total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Pool;
    use crate::symbolic::growth::tests::assert_integrated;

    const THERE: [[f64; 2]; 2] = [[-0.9, 0.8], [0.0, 0.5]];

    fn one_and(pool: &mut Pool, x: Expression) -> Expression {
        pool.add(Expression::ONE, x)
    }

    #[test]
    fn polynomials_beside_a_power_are_integrated() {
        // x / (1 + |x|)
        assert_integrated(&THERE, |pool, x, _| {
            let size = pool.call(Function::Abs, &[x]);
            let sum = one_and(pool, size);
            pool.divide(x, sum).expect("a quotient")
        });
        // (a x² + x) / (1 + x)³
        assert_integrated(&THERE, |pool, x, a| {
            let square = pool.multiply(x, x);
            let product = pool.multiply(a, square);
            let (sum, cube) = (pool.add(product, x), one_and(pool, x));
            let cube = pool.power(cube, 3).expect("a power");
            pool.divide(sum, cube).expect("a quotient")
        });
        // x (x − a) (1 + x)^1.4 and −x / √(2 + 2 x)
        assert_integrated(&THERE, |pool, x, a| {
            let (sum, exponent) = (one_and(pool, x), pool.literal("1.4").expect("a number"));
            let power = pool.real_power(sum, exponent).expect("a power");
            let way = pool.subtract(x, a);
            let [product, twice] =
                [(x, way), (Expression::ONE, sum)].map(|(a, b)| pool.multiply(a, b));
            let first = pool.multiply(product, power);
            let twice = pool.add(twice, sum);
            let root = pool.call(Function::Sqrt, &[twice]);
            let second = pool.divide(x, root).expect("a quotient");
            pool.subtract(first, second)
        });
    }

    #[test]
    fn polynomials_beside_waves_are_integrated() {
        // x exp(−x), and (x² − 3) exp(a x − 1)
        assert_integrated(&THERE, |pool, x, a| {
            let falling = pool.call(Function::Exp, &[x.negated()]);
            let first = pool.multiply(x, falling);
            let (square, three, product) =
                (pool.multiply(x, x), pool.integer(3), pool.multiply(a, x));
            let factor = pool.subtract(square, three);
            let exponent = pool.subtract(product, Expression::ONE);
            let rising = pool.call(Function::Exp, &[exponent]);
            let second = pool.multiply(factor, rising);
            pool.add(first, second)
        });
        // x sin x − x² (x − a) cos(1 + x)
        assert_integrated(&THERE, |pool, x, a| {
            let (sine, angle, way) = (pool.sine(x), one_and(pool, x), pool.subtract(x, a));
            let cosine = pool.cosine(angle);
            let square = pool.multiply(x, x);
            let cube = pool.multiply(square, way);
            let (first, second) = (pool.multiply(x, sine), pool.multiply(cube, cosine));
            pool.subtract(first, second)
        });
    }

    #[test]
    fn powers_of_waves_are_integrated() {
        for exponent in [2, 3, 4, 7] {
            assert_integrated(&THERE, |pool, x, a| {
                let (product, angle) = (pool.multiply(a, x), one_and(pool, x));
                let (sine, cosine) = (pool.sine(product), pool.cosine(angle));
                let [sine, cosine] =
                    [sine, cosine].map(|it| pool.power(it, exponent).expect("a power"));
                pool.subtract(sine, cosine)
            });
        }
    }

    #[test]
    fn logarithms_of_quotients_are_integrated() {
        // ln((1 + x) / (1 − x))
        assert_integrated(&THERE, |pool, x, _| {
            let (above, below) = (one_and(pool, x), one_and(pool, x.negated()));
            let ratio = pool.divide(above, below).expect("a quotient");
            pool.call(Function::Ln, &[ratio])
        });
        // ln(a / (x − 2)²)
        assert_integrated(&THERE, |pool, x, a| {
            let two = pool.integer(2);
            let way = pool.subtract(x, two);
            let square = pool.multiply(way, way);
            let ratio = pool.divide(a, square).expect("a quotient");
            pool.call(Function::Ln, &[ratio])
        });
    }
}
