//! Antiderivatives in closed form, of what laws of storages are made of.

use super::affine::affine;
use super::choices::Side;
use super::expression::{Expression, Function, Operation, Symbol};
use super::pool::Pool;
use super::substitute::symbols;
use super::vanishing::Change;

/// Most expressions that are tried, where choices in choices double them.
const MOST: usize = 4000;

/// Most closed forms that are guarded, each of which takes a quadrature, where choices in choices double them.
const MOST_GUARDS: usize = 48;

/// An exponential, a sine or a cosine is nearly a polynomial while its argument changes by half of this.
pub(super) const WAVE: i64 = 4;

/// Most inner functions that are tried, each of which takes a walk through what it is in.
const MOST_INNER: usize = 500;

/// A function of a symbol whose derivative is the expression, continuous where the expression jumps; none where none is
/// known. Known are sums and multiples of: powers, sine, cosine, tangent and their arcs, exponential, logarithm, root and
/// hyperbolic tangent of what is affine in the symbol; products, quotients and powers of what is affine and vanishes at one
/// place; products of sums that are made of such when they are multiplied out; and all of these with choices, absolute
/// values and signs of what is affine anywhere in them. Further polynomials beside such a power, an exponential, a sine or a
/// cosine, whole powers and products of sines and cosines, and logarithms of products and quotients of what is affine. Products of the
/// derivative of a function with a function of it are integrated by that one.
///
/// Where it divides by what may vanish it is the integral from zero, see `vanishing`.
#[must_use]
pub fn antiderivative(
    pool: &mut Pool,
    expression: Expression,
    symbol: Symbol,
) -> Option<Expression> {
    let mut integration = Integration {
        pool,
        symbol,
        left: MOST,
        inner_left: MOST_INNER,
        sides: Vec::new(),
        base: Some(Expression::ZERO),
        parts: 0,
        is_divided: false,
        changes: Vec::new(),
        guards_left: MOST_GUARDS,
        choices: 0,
    };
    integration.of(expression)
}

pub(super) struct Integration<'a> {
    pub(super) pool: &'a mut Pool,
    pub(super) symbol: Symbol,
    /// How many more expressions are tried.
    pub(super) left: usize,
    /// How many more inner functions are tried.
    pub(super) inner_left: usize,
    /// Where what is integrated counts: beside these places.
    pub(super) sides: Vec<Side>,
    /// Where integrals begin whose closed form may fail, if that is known.
    pub(super) base: Option<Expression>,
    /// How many integrals this one is a part of that are no sums of such parts.
    pub(super) parts: usize,
    /// Whether the whole is divided by what may vanish.
    pub(super) is_divided: bool,
    /// What must change for the closed form to have a value.
    pub(super) changes: Vec<Change>,
    /// How many more closed forms are guarded.
    pub(super) guards_left: usize,
    /// How many choices with a place of their own for what may vanish this is a branch of.
    pub(super) choices: usize,
}

impl Integration<'_> {
    pub(super) fn of(&mut self, expression: Expression) -> Option<Expression> {
        self.left = self.left.checked_sub(1)?;
        if self.is_free(expression) {
            let symbol = self.pool.symbol(self.symbol);
            self.must_change(Expression::ONE, symbol);
            return Some(self.pool.multiply(expression, symbol));
        }
        let known = self.changes.len();
        let magnitude = expression.magnitude();
        let found = self
            .tried(|it| it.by_operation(expression))
            .or_else(|| self.tried(|it| it.by_degree(magnitude)))
            .or_else(|| self.tried(|it| it.by_factors(magnitude)))
            .or_else(|| self.tried(|it| it.split(magnitude)))
            .or_else(|| self.tried(|it| it.by_substitution(magnitude)))?;
        let found = self.guarded(magnitude, found, known);
        Some(found.flipped(expression.is_negative()))
    }

    /// What an attempt finds; one that fails leaves nothing behind.
    pub(super) fn tried(
        &mut self,
        attempt: impl FnOnce(&mut Self) -> Option<Expression>,
    ) -> Option<Expression> {
        let known = self.changes.len();
        let found = attempt(self);
        if found.is_none() {
            self.changes.truncate(known);
        }
        found
    }

    /// Of an expression without its sign, by what is done last in it.
    fn by_operation(&mut self, expression: Expression) -> Option<Expression> {
        match self.pool.operation(expression).clone() {
            Operation::Constant(_) => None,
            Operation::Symbol(_) => self.power(expression.magnitude(), 1),
            Operation::Add(a, b) => {
                let (a, b) = (self.of(a)?, self.of(b)?);
                Some(self.pool.add(a, b))
            }
            Operation::Multiply(a, b) => self.product(a, b),
            Operation::Divide(a, b) => self.quotient(a, b),
            Operation::Sine(angle) => {
                let cosine = self.pool.cosine(angle);
                let scale = self.pool.integer(WAVE);
                self.inner(angle, cosine.negated(), scale)
            }
            Operation::Cosine(angle) => {
                let sine = self.pool.sine(angle);
                let scale = self.pool.integer(WAVE);
                self.inner(angle, sine, scale)
            }
            Operation::Call(function, arguments) => self.call(function, &arguments),
        }
    }

    pub(super) fn is_free(&self, expression: Expression) -> bool {
        !symbols(self.pool, &[expression]).contains(&self.symbol)
    }

    /// The slope of what is affine in the symbol, and not free of it.
    pub(super) fn slope(&mut self, expression: Expression) -> Option<Expression> {
        let symbol = self.symbol;
        let (slope, _) = affine(self.pool, expression, symbol, |it| *it == symbol)?;
        (slope != Expression::ZERO).then_some(slope)
    }

    /// An antiderivative by the affine argument, over its slope. What is integrated is nearly a polynomial while the argument
    /// changes by half the scale, which counts where the integral begins.
    pub(super) fn inner(
        &mut self,
        argument: Expression,
        value: Expression,
        scale: Expression,
    ) -> Option<Expression> {
        let slope = self.slope(argument)?;
        let found = self.pool.divide(value, slope)?;
        self.must_change(slope, scale);
        Some(found)
    }

    fn product(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        for (factor, rest) in [(a, b), (b, a)] {
            if self.is_free(factor) {
                let rest = self.of(rest)?;
                return Some(self.pool.multiply(factor, rest));
            }
        }
        let base = self.base(a, b);
        base.and_then(|(base, exponent)| {
            self.tried(|it| it.power(base, exponent))
                .or_else(|| self.tried(|it| it.power_of_wave(base, exponent)))
        })
        .or_else(|| self.tried(|it| it.product_of_waves(a, b)))
        .or_else(|| self.tried(|it| it.distributed(a, b)))
        .or_else(|| self.tried(|it| it.distributed(b, a)))
    }

    /// A factor times a sum, or times a multiple of one.
    fn distributed(&mut self, factor: Expression, sum: Expression) -> Option<Expression> {
        let found = match self.pool.operation(sum).clone() {
            Operation::Add(a, b) => {
                let [a, b] = [a, b].map(|term| self.pool.multiply(factor, term));
                let (a, b) = (self.of(a)?, self.of(b)?);
                self.pool.add(a, b)
            }
            Operation::Multiply(a, b) if self.is_free(a) || self.is_free(b) => {
                let (multiple, rest) = if self.is_free(a) { (a, b) } else { (b, a) };
                let rest = self.pool.multiply(factor, rest);
                let rest = self.of(rest)?;
                self.pool.multiply(multiple, rest)
            }
            _ => return None,
        };
        Some(found.flipped(sum.is_negative()))
    }

    /// Base and exponent of a product of equal factors.
    fn base(&self, a: Expression, b: Expression) -> Option<(Expression, i32)> {
        let [a, b] = [a, b].map(|factor| match self.pool.operation(factor) {
            Operation::Multiply(c, d) => self.base(*c, *d),
            _ => Some((factor, 1)),
        });
        let ((base, more), (other, exponent)) = (a?, b?);
        (base == other).then_some((base, more + exponent))
    }

    /// `uⁿ⁺¹ / (n + 1)`, or `ln |u|`, over the slope of `u`.
    fn power(&mut self, base: Expression, exponent: i32) -> Option<Expression> {
        let value = if exponent == -1 {
            let size = self.pool.call(Function::Abs, &[base]);
            self.pool.call(Function::Ln, &[size])
        } else {
            let next = self.pool.integer(i64::from(exponent) + 1);
            let power = self.pool.power(base, exponent + 1)?;
            self.pool.divide(power, next)?
        };
        self.inner(base, value, base)
    }

    fn quotient(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        if self.is_free(b) {
            let value = self.of(a)?;
            return self.pool.divide(value, b);
        }
        if let Operation::Add(c, d) = *self.pool.operation(a) {
            let [c, d] = [c, d].map(|term| self.pool.divide(term, b));
            let (c, d) = (self.of(c?)?, self.of(d?)?);
            let sum = self.pool.add(c, d);
            return Some(sum.flipped(a.is_negative()));
        }
        if !self.is_free(a) {
            return None;
        }
        let (base, exponent) = match self.pool.operation(b) {
            Operation::Multiply(c, d) => self.base(*c, *d)?,
            _ => (b, 1),
        };
        let value = self.power(base, -exponent)?;
        Some(self.pool.multiply(a, value))
    }

    fn call(&mut self, function: Function, arguments: &[Expression]) -> Option<Expression> {
        let u = arguments[0];
        match function {
            Function::Exp => {
                let value = self.pool.call(Function::Exp, &[u]);
                let scale = self.pool.integer(WAVE);
                self.inner(u, value, scale)
            }
            Function::Ln => {
                let value = self.logarithm(u, u);
                self.inner(u, value, u)
                    .or_else(|| self.logarithm_of_product(u))
            }
            Function::Pow => {
                let next = self.pool.add(arguments[1], Expression::ONE);
                let power = self
                    .pool
                    .real_power(u, next)
                    .filter(|_| self.is_free(next))?;
                let value = self.over_degree(power, u, next)?;
                self.inner(u, value, u)
            }
            Function::Sqrt => {
                let root = self.pool.call(Function::Sqrt, &[u]);
                let product = self.pool.multiply(u, root);
                let value = self.share(product, 2, 3)?;
                self.inner(u, value, u)
            }
            Function::Abs => {
                let size = self.pool.call(Function::Abs, &[u]);
                let product = self.pool.multiply(u, size);
                let value = self.share(product, 1, 2)?;
                self.inner(u, value, u)
            }
            Function::Sign => {
                let value = self.pool.call(Function::Abs, &[u]);
                self.inner(u, value, u)
            }
            Function::Fraction => {
                // Of the whole number below, and of the fraction: without a jump.
                let fraction = self.pool.call(Function::Fraction, &[u]);
                let square = self.pool.multiply(fraction, fraction);
                let whole = self.pool.subtract(u, fraction);
                let sum = self.pool.add(whole, square);
                let value = self.share(sum, 1, 2)?;
                self.inner(u, value, Expression::ONE)
            }
            Function::Tan => {
                let cosine = self.pool.cosine(u);
                let size = self.pool.call(Function::Abs, &[cosine]);
                let value = self.pool.call(Function::Ln, &[size]);
                // As near as the next pole.
                self.inner(u, value.negated(), cosine)
            }
            Function::Tanh => {
                let value = self.logarithm_of_cosh(u)?;
                self.inner(u, value, Expression::ONE)
            }
            Function::Atan2 => self.arc_tangent(u, arguments[1]),
            Function::Min => self.choice(u, arguments[1], u, arguments[1]),
            Function::Max => self.choice(u, arguments[1], arguments[1], u),
            Function::SelectLess => self.choice(u, arguments[1], arguments[2], arguments[3]),
            Function::Asin | Function::Acos => {
                let value = self.arc(function, u);
                // No further than half the way to the ends.
                let square = self.pool.multiply(u, u);
                let rest = self.pool.subtract(Expression::ONE, square);
                let scale = self.share(rest, 1, 2)?;
                self.inner(u, value, scale)
            }
        }
    }

    /// `u ln u − u`, or `u ln |u| − u` with that size. At zero it is zero, the limit, where the product has no value.
    pub(super) fn logarithm(&mut self, u: Expression, size: Expression) -> Expression {
        let logarithm = self.pool.call(Function::Ln, &[size]);
        let product = self.pool.multiply(u, logarithm);
        let value = self.pool.subtract(product, u);
        let size = self.pool.call(Function::Abs, &[u]);
        let choice = [Expression::ZERO, size, value, u];
        self.pool.call(Function::SelectLess, &choice)
    }

    /// `u asin u + √(1 − u²)`, or `u acos u − √(1 − u²)`.
    fn arc(&mut self, function: Function, u: Expression) -> Expression {
        let angle = self.pool.call(function, &[u]);
        let [product, square] = [angle, u].map(|factor| self.pool.multiply(u, factor));
        let rest = self.pool.subtract(Expression::ONE, square);
        let root = self.pool.call(Function::Sqrt, &[rest]);
        let root = root.flipped(function == Function::Acos);
        self.pool.add(product, root)
    }

    pub(super) fn share(
        &mut self,
        value: Expression,
        numerator: i64,
        divisor: i64,
    ) -> Option<Expression> {
        let [numerator, divisor] = [numerator, divisor].map(|it| self.pool.integer(it));
        let product = self.pool.multiply(value, numerator);
        self.pool.divide(product, divisor)
    }

    /// `|u| + ln((1 + exp(−2 |u|)) / 2)`, which overflows nowhere.
    fn logarithm_of_cosh(&mut self, u: Expression) -> Option<Expression> {
        let size = self.pool.call(Function::Abs, &[u]);
        let twice = self.share(size, -2, 1)?;
        let falling = self.pool.call(Function::Exp, &[twice]);
        let sum = self.pool.add(falling, Expression::ONE);
        let half = self.share(sum, 1, 2)?;
        let rest = self.pool.call(Function::Ln, &[half]);
        Some(self.pool.add(size, rest))
    }

    /// `u atan(u / c) − c / 2 ln(u² + c²)`.
    fn arc_tangent(&mut self, u: Expression, c: Expression) -> Option<Expression> {
        if !self.is_free(c) {
            return None;
        }
        let angle = self.pool.call(Function::Atan2, &[u, c]);
        let [first, square, other] =
            [(u, angle), (u, u), (c, c)].map(|(a, b)| self.pool.multiply(a, b));
        let length = self.pool.add(square, other);
        let logarithm = self.pool.call(Function::Ln, &[length]);
        let product = self.pool.multiply(c, logarithm);
        let second = self.share(product, 1, 2)?;
        let value = self.pool.subtract(first, second);
        self.inner(u, value, c)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Evaluation;

    const X: Symbol = Symbol::State(0);

    /// What an antiderivative grows by between two places is the integral, by Simpson's rule.
    fn assert_integral(law: impl Fn(&mut Pool, Expression) -> Expression, [from, to]: [f64; 2]) {
        let mut pool = Pool::new();
        let x = pool.symbol(X);
        let law = law(&mut pool, x);
        let found = antiderivative(&mut pool, law, X).expect("it has an antiderivative");
        let at = |expression: Expression, x: f64| {
            let symbol = |_| x;
            Evaluation::new(&symbol).value(&pool, expression)
        };
        let intervals = 4096;
        let step = (to - from) / f64::from(intervals);
        let sum: f64 = (0..intervals)
            .map(|k| {
                let left = from + step * f64::from(k);
                let [a, b, c] = [0.0, 0.5, 1.0].map(|part| at(law, left + part * step));
                step / 6.0 * (a + 4.0 * b + c)
            })
            .sum();
        let growth = at(found, to) - at(found, from);
        assert!((growth - sum).abs() < 1e-9, "{growth} and {sum}");
    }

    fn affine_part(pool: &mut Pool, x: Expression) -> Expression {
        let (two, three) = (pool.integer(2), pool.integer(3));
        let product = pool.multiply(two, x);
        pool.subtract(three, product)
    }

    #[test]
    fn functions_of_what_is_affine_are_integrated() {
        use Function::{Abs, Exp, Ln, Sign, Sqrt, Tan, Tanh};
        for function in [Exp, Ln, Sqrt, Tan, Tanh, Abs, Sign] {
            let law = |pool: &mut Pool, x| {
                let u = affine_part(pool, x);
                pool.call(function, &[u])
            };
            assert_integral(law, [0.8, 1.2]);
        }
        let circular = |pool: &mut Pool, x| {
            let u = affine_part(pool, x);
            let (sine, cosine, one) = (pool.sine(u), pool.cosine(x), pool.integer(1));
            let angle = pool.call(Function::Atan2, &[u, one]);
            pool.sum(&[sine, cosine.negated(), angle])
        };
        assert_integral(circular, [-1.0, 2.5]);
        for arc in [Function::Asin, Function::Acos] {
            let law = |pool: &mut Pool, x| {
                let (u, four) = (affine_part(pool, x), pool.integer(4));
                let part = pool.divide(u, four).expect("a quotient");
                pool.call(arc, &[part])
            };
            assert_integral(law, [-0.25, 3.25]);
        }
    }

    #[test]
    fn powers_are_integrated() {
        for exponent in [-3, -2, -1, 1, 2, 5] {
            let law = |pool: &mut Pool, x| {
                let u = affine_part(pool, x);
                pool.power(u, exponent).expect("a power")
            };
            assert_integral(law, [-0.5, 1.0]);
        }
        // (1 / (1 − x))^1.4, and u^1.4
        let gas = |pool: &mut Pool, x| {
            let rest = pool.subtract(Expression::ONE, x);
            let ratio = pool.divide(Expression::ONE, rest).expect("a quotient");
            let exponent = pool.literal("1.4").expect("a number");
            let logarithm = pool.call(Function::Ln, &[ratio]);
            let product = pool.multiply(exponent, logarithm);
            pool.call(Function::Exp, &[product])
        };
        assert_integral(gas, [0.0, 0.7]);
        let power = |pool: &mut Pool, x| {
            let u = affine_part(pool, x);
            let exponent = pool.literal("1.4").expect("a number");
            let logarithm = pool.call(Function::Ln, &[u]);
            let product = pool.multiply(exponent, logarithm);
            pool.call(Function::Exp, &[product])
        };
        assert_integral(power, [0.0, 1.4]);
    }

    #[test]
    fn choices_are_continuous_where_they_change() {
        let play = |pool: &mut Pool, x| {
            let (gap, stiffness) = (pool.literal("0.25").expect("a number"), pool.integer(100));
            let beyond = pool.subtract(x, gap);
            let force = pool.multiply(stiffness, beyond);
            pool.call(Function::SelectLess, &[gap, x, force, Expression::ZERO])
        };
        assert_integral(play, [-0.5, 1.0]);
        let largest = |pool: &mut Pool, x| {
            let u = affine_part(pool, x);
            let larger = pool.call(Function::Max, &[u, x]);
            let smaller = pool.call(Function::Min, &[u, Expression::ZERO]);
            pool.subtract(larger, smaller)
        };
        assert_integral(largest, [-1.0, 3.0]);
    }

    /// `3 min(1/2, max(u, −1/4)) + u`.
    fn bent(pool: &mut Pool, u: Expression) -> Expression {
        let [low, high] = ["0.25", "0.5"].map(|it| pool.literal(it).expect("a number"));
        let raised = pool.call(Function::Max, &[u, low.negated()]);
        let inside = pool.call(Function::Min, &[high, raised]);
        let slope = pool.integer(3);
        let steep = pool.multiply(slope, inside);
        pool.add(steep, u)
    }

    #[test]
    fn choices_are_taken_apart_wherever_they_are() {
        assert_integral(
            |pool, x| {
                let bent = bent(pool, x);
                pool.multiply(x, bent)
            },
            [-1.0, 1.0],
        );
        assert_integral(
            |pool, x| {
                let size = pool.call(Function::Abs, &[x]);
                let (sign, bent) = (pool.call(Function::Sign, &[x]), bent(pool, size));
                pool.multiply(sign, bent)
            },
            [-1.0, 1.0],
        );
        assert_integral(
            |pool, x| {
                let inner = bent(pool, x);
                let outer = bent(pool, inner);
                pool.multiply(outer, inner)
            },
            [-1.0, 1.0],
        );
    }

    /// Of the teeth of a gear, which touch beyond half the gap on both sides: `k sign(x) max(|x| − g, 0)^1.5`.
    #[test]
    fn what_rises_beyond_a_gap_is_integrated() {
        assert_energy_beyond_a_gap(|_, x| x);
        // Within the gap the sign may change anywhere.
        assert_energy_beyond_a_gap(|pool, x| {
            let place = pool.literal("0.125").expect("a number");
            pool.subtract(x, place)
        });
    }

    fn assert_energy_beyond_a_gap(side: impl Fn(&mut Pool, Expression) -> Expression) {
        let mut pool = Pool::new();
        let [x, stiffness, gap] =
            [X, Symbol::Parameter(0), Symbol::Parameter(1)].map(|symbol| pool.symbol(symbol));
        let side = side(&mut pool, x);
        let [size, sign] = [(Function::Abs, x), (Function::Sign, side)]
            .map(|(function, argument)| pool.call(function, &[argument]));
        let way = pool.subtract(size, gap);
        let beyond = pool.call(Function::Max, &[way, Expression::ZERO]);
        let exponent = pool.literal("1.5").expect("a number");
        let power = pool.real_power(beyond, exponent).expect("a power");
        let factor = pool.multiply(stiffness, sign);
        let law = pool.multiply(factor, power);
        let found = antiderivative(&mut pool, law, X).expect("it has an antiderivative");
        let at = |x| value(&pool, found, x, 0.25);
        for (place, expected) in [(0.1, 0.0), (0.5, 0.125), (1.25, 4.0)] {
            for x in [place, -place] {
                let energy = at(x) - at(0.0);
                assert!((energy - expected).abs() < 1e-14, "{x}: {energy}");
            }
        }
    }

    /// The energy at `x` of a law with a stiffness of 10 and this gap.
    fn value(pool: &Pool, energy: Expression, x: f64, gap: f64) -> f64 {
        let symbol = |symbol| match symbol {
            X => x,
            Symbol::Parameter(0) => 10.0,
            _ => gap,
        };
        Evaluation::new(&symbol).value(pool, energy)
    }

    /// `k |x| √(x − g)` beyond a gap `g`, whichever its sign: within the gap the root has no value.
    #[test]
    fn what_changes_beside_the_place_where_a_law_begins_is_integrated() {
        let mut pool = Pool::new();
        let [x, stiffness, gap] =
            [X, Symbol::Parameter(0), Symbol::Parameter(1)].map(|symbol| pool.symbol(symbol));
        let way = pool.subtract(x, gap);
        let [size, root] = [(Function::Abs, x), (Function::Sqrt, way)]
            .map(|(function, argument)| pool.call(function, &[argument]));
        let factor = pool.multiply(stiffness, size);
        let force = pool.multiply(factor, root);
        let law = pool.call(Function::SelectLess, &[gap, x, force, Expression::ZERO]);
        let found = antiderivative(&mut pool, law, X).expect("it has an antiderivative");
        // ∫ x √(x − g) = 2/5 (x − g)^5/2 + 2/3 g (x − g)^3/2, with the other sign below zero.
        let beyond = |x: f64, gap: f64| {
            let way = (x - gap).max(0.0);
            0.4 * way.powf(2.5) + 2.0 / 3.0 * gap * way.powf(1.5)
        };
        for gap in [0.25, -0.25] {
            for x in [-1.0, -0.125, 0.0, 0.125, 0.5, 2.0] {
                let turned = beyond(f64::min(x, 0.0), gap);
                let expected = beyond(x.max(0.0), gap) - beyond(0.0, gap) - turned;
                let energy = value(&pool, found, x, gap) - value(&pool, found, -1.0, gap);
                assert!(
                    (energy - 10.0 * expected).abs() < 1e-14,
                    "{gap} {x}: {energy} and {expected}"
                );
            }
        }
    }

    #[test]
    fn what_is_infinite_where_choices_change_is_not_known() {
        // a / (x − b) beyond b, else 1
        let mut pool = Pool::new();
        let [x, a, b] =
            [X, Symbol::Parameter(0), Symbol::Parameter(1)].map(|symbol| pool.symbol(symbol));
        let way = pool.subtract(x, b);
        let force = pool.divide(a, way).expect("a quotient");
        let choice = [b, x, force, Expression::ONE];
        let law = pool.call(Function::SelectLess, &choice);
        assert_eq!(antiderivative(&mut pool, law, X), None);
    }

    #[test]
    fn what_is_not_known_is_none() {
        let mut pool = Pool::new();
        let x = pool.symbol(X);
        let sine = pool.sine(x);
        let rising = pool.call(Function::Exp, &[x]);
        let product = pool.multiply(rising, sine);
        assert_eq!(antiderivative(&mut pool, product, X), None);
        let nested = pool.call(Function::Exp, &[sine]);
        assert_eq!(antiderivative(&mut pool, nested, X), None);
    }
}
