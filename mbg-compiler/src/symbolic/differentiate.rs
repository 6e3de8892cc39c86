//! Derivatives, taken on the graph: each node once, never on an expanded tree.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::expression::{Expression, Function, Operation, Rate, Symbol};
use super::implicit::Method;
use super::linear::Linear;
use super::matrix::Matrix;
use super::pool::{Definition, Pool};
use super::rest::at_rest;
use super::substitute::{replace, symbols};
use super::walk::Rewritten;

/// Differentiates along one direction and remembers what it has done.
pub struct Differentiator {
    known: Rewritten,
    /// Derivatives of symbols; those that are not there do not change along the direction.
    slopes: BTreeMap<Symbol, Expression>,
    /// How many of the pool's definitions are known.
    defined: usize,
}

impl Differentiator {
    /// With respect to `symbol`.
    #[must_use]
    pub fn new(symbol: Symbol) -> Self {
        Self::along(BTreeMap::from([(symbol, Expression::ONE)]))
    }

    /// Along the direction in which symbols have these slopes, and all others none.
    #[must_use]
    pub fn along(slopes: BTreeMap<Symbol, Expression>) -> Self {
        Self {
            known: Rewritten::default(),
            slopes,
            defined: 0,
        }
    }

    /// The derivative.
    pub fn derivative(&mut self, pool: &mut Pool, expression: Expression) -> Expression {
        while let Some(definition) = pool.definitions().get(self.defined).cloned() {
            self.defined += 1;
            match definition {
                Definition::Implicit(number) => self.unknowns(pool, number),
                Definition::Linear(linear) => self.solution(pool, &linear),
            }
        }
        rewrite(&mut self.known, &self.slopes, pool, expression)
    }

    /// Adds the derivatives of unknowns that an iteration finds, by the implicit function theorem. Those of a linear
    /// solve come with the equations that it belongs to.
    fn unknowns(&mut self, pool: &mut Pool, number: usize) {
        let implicit = pool.implicit()[number].clone();
        let Method::Newton {
            residuals, inverse, ..
        } = &implicit.method
        else {
            return;
        };
        // While the unknowns have no derivative yet, this is the one by everything else.
        let mut others = Rewritten::default();
        let driven: Vec<Expression> = residuals
            .iter()
            .map(|residual| rewrite(&mut others, &self.slopes, pool, *residual))
            .collect();
        if driven.iter().all(|driven| *driven == Expression::ZERO) {
            return;
        }
        let right: Vec<Expression> = driven.into_iter().map(Expression::negated).collect();
        let slopes = inverse.times(pool, &Matrix::column(right)).entries;
        self.slopes.extend(implicit.symbols().zip(slopes));
    }

    /// Adds the derivatives of a solution of linear equations: `A z' = b' − A' z`.
    fn solution(&mut self, pool: &mut Pool, linear: &Linear) {
        let right = (0..linear.right.len()).map(|row| self.driven(pool, linear, row));
        let right: Vec<Expression> = right.collect();
        let slopes = if right.iter().all(|driven| *driven == Expression::ZERO) {
            right
        } else {
            match linear.solve(pool, right) {
                Some(slopes) => slopes,
                None => return,
            }
        };
        for (value, slope) in linear.values.iter().zip(slopes) {
            self.known.set(*value, slope);
        }
    }

    /// One row of `b' − A' z`.
    fn driven(&mut self, pool: &mut Pool, linear: &Linear, row: usize) -> Expression {
        let mut driven = rewrite(&mut self.known, &self.slopes, pool, linear.right[row]);
        for (column, coefficient) in &linear.matrix[row] {
            if pool.rate(*coefficient) == Rate::Constant
                || linear.values[*column] == Expression::ZERO
            {
                continue;
            }
            let slope = rewrite(&mut self.known, &self.slopes, pool, *coefficient);
            let product = pool.multiply(slope, linear.values[*column]);
            driven = pool.subtract(driven, product);
        }
        driven
    }
}

/// Derivatives of expressions, by rows, with respect to symbols, by columns; only what an expression holds is
/// differentiated.
pub fn jacobian(pool: &mut Pool, expressions: &[Expression], by: &[Symbol]) -> Matrix {
    let mut columns: BTreeMap<Symbol, (usize, Differentiator)> = by
        .iter()
        .enumerate()
        .map(|(column, symbol)| (*symbol, (column, Differentiator::new(*symbol))))
        .collect();
    let mut entries = vec![Expression::ZERO; expressions.len() * by.len()];
    for (row, expression) in expressions.iter().enumerate() {
        for symbol in symbols(pool, &[*expression]) {
            if let Some((column, derivative)) = columns.get_mut(&symbol) {
                entries[row * by.len() + *column] = derivative.derivative(pool, *expression);
            }
        }
    }
    Matrix::new(expressions.len(), by.len(), entries)
}

fn rewrite(
    known: &mut Rewritten,
    slopes: &BTreeMap<Symbol, Expression>,
    pool: &mut Pool,
    expression: Expression,
) -> Expression {
    known
        .rewrite(pool, expression, |pool, known, whole, operation| {
            Some(rule(pool, slopes, known, whole, operation))
        })
        .unwrap_or(Expression::ZERO)
}

fn rule(
    pool: &mut Pool,
    slopes: &BTreeMap<Symbol, Expression>,
    known: &Rewritten,
    whole: Expression,
    operation: &Operation,
) -> Expression {
    match operation {
        Operation::Constant(_) => Expression::ZERO,
        Operation::Symbol(symbol) => slopes.get(symbol).copied().unwrap_or(Expression::ZERO),
        Operation::Add(a, b) => {
            turned(pool, known, *a, *b).unwrap_or_else(|| pool.add(known.of(*a), known.of(*b)))
        }
        Operation::Multiply(a, b) => at_rest(pool, known, whole).unwrap_or_else(|| {
            let first = pool.multiply(known.of(*a), *b);
            let second = pool.multiply(*a, known.of(*b));
            pool.add(first, second)
        }),
        Operation::Divide(a, b) => {
            // (a/b)' = (a' − (a/b) b') / b shares the quotient itself.
            let shrink = pool.multiply(whole, known.of(*b));
            let numerator = pool.subtract(known.of(*a), shrink);
            pool.divide(numerator, *b).unwrap_or(Expression::ZERO)
        }
        Operation::Sine(a) => {
            let cosine = pool.cosine(*a);
            pool.multiply(cosine, known.of(*a))
        }
        Operation::Cosine(a) => {
            let sine = pool.sine(*a);
            pool.multiply(sine, known.of(*a)).negated()
        }
        Operation::Call(function, arguments) => at_rest(pool, known, whole)
            .unwrap_or_else(|| call_rule(pool, known, whole, *function, arguments)),
    }
}

/// The derivative of `a cos α + b sin α`, a component of a vector that is turned: where the angle changes, that is the
/// component at right angles to it, which often is there already.
fn turned(
    pool: &mut Pool,
    known: &Rewritten,
    first: Expression,
    second: Expression,
) -> Option<Expression> {
    let circular = |pool: &Pool, product: Expression| {
        let Operation::Multiply(a, b) = *pool.operation(product) else {
            return Vec::new();
        };
        let angle = |factor: Expression| match *pool.operation(factor) {
            Operation::Sine(angle) | Operation::Cosine(angle) => Some(angle),
            _ => None,
        };
        let both = [(a, b), (b, a)].into_iter();
        both.filter_map(|(factor, rest)| Some((angle(factor)?, factor, rest)))
            .collect()
    };
    let others = circular(pool, second);
    let (angle, [a, b]) = circular(pool, first)
        .into_iter()
        .find_map(|(angle, a, x)| {
            let (_, b, y) = others
                .iter()
                .find(|other| other.0 == angle && other.1 != a)?;
            Some((angle, [(first, a, x), (second, *b, *y)]))
        })?;
    let turning = known.of(angle);
    if turning == Expression::ZERO {
        return None;
    }
    let mut slope = Expression::ZERO;
    let mut across = Expression::ZERO;
    for (whole, factor, rest) in [a, b] {
        let changed = pool.multiply(factor, known.of(rest));
        slope = pool.add(slope, changed.flipped(whole.is_negative()));
        let quarter = match *pool.operation(factor) {
            Operation::Sine(angle) => pool.cosine(angle),
            _ => pool.sine(angle).negated(),
        };
        let moved = pool.multiply(quarter, rest);
        across = pool.add(across, moved.flipped(whole.is_negative()));
    }
    let moved = pool.multiply(across, turning);
    Some(pool.add(slope, moved))
}

fn call_rule(
    pool: &mut Pool,
    known: &Rewritten,
    whole: Expression,
    function: Function,
    arguments: &[Expression],
) -> Expression {
    let inner = known.of(arguments[0]);
    match function {
        Function::SelectLess => {
            let (yes, no) = (known.of(arguments[2]), known.of(arguments[3]));
            select(pool, arguments[0], arguments[1], yes, no)
        }
        Function::Min => select(
            pool,
            arguments[0],
            arguments[1],
            inner,
            known.of(arguments[1]),
        ),
        Function::Max => select(
            pool,
            arguments[1],
            arguments[0],
            inner,
            known.of(arguments[1]),
        ),
        Function::Atan2 => atan2_rule(pool, known, arguments[0], arguments[1]),
        Function::Pow => power_rule(pool, known, whole, arguments[0], arguments[1]),
        _ if inner == Expression::ZERO => Expression::ZERO,
        _ => {
            let outer = outer(pool, whole, function, arguments[0]);
            let is_steep = matches!(
                function,
                Function::Asin | Function::Acos | Function::Ln | Function::Sqrt
            );
            chain(pool, is_steep, outer, inner)
        }
    }
}

/// `outer inner` of a function, zero wherever choices make the inner derivative zero: there the outer one may be infinite, as
/// that of the root of `max(x, 0)` is. `is_steep` says whether it may be where the function itself is finite.
///
/// A choice that is a factor chooses between the product and zero, and so do those inside of what it chooses. Where choices
/// are added, the product counts where their sum is not zero; what is no number stays so.
fn chain(pool: &mut Pool, is_steep: bool, outer: Expression, inner: Expression) -> Expression {
    let Some((choice, [a, b, yes, no])) = vanishing(pool, inner) else {
        let product = pool.multiply(outer, inner);
        if !is_steep || !may_vanish(pool, inner) {
            return product;
        }
        let size = pool.call(Function::Abs, &[inner]);
        return select(pool, Expression::ZERO, size, product, inner);
    };
    let chosen = if yes == Expression::ZERO { no } else { yes };
    let inner = replace(pool, inner, &[(choice, chosen)]).unwrap_or(inner);
    let product = chain(pool, is_steep, outer, inner);
    if yes == Expression::ZERO {
        select(pool, a, b, yes, product)
    } else {
        select(pool, a, b, product, no)
    }
}

/// Whether choices may make a derivative zero everywhere around a place. A sum that changes with anything else crosses zero
/// at most.
fn may_vanish(pool: &Pool, derivative: Expression) -> bool {
    may_vanish_knowing(pool, derivative, &mut FxHashMap::default())
}

/// The same, each node once: terms of sums share what is in them.
fn may_vanish_knowing(
    pool: &Pool,
    derivative: Expression,
    known: &mut FxHashMap<usize, bool>,
) -> bool {
    if let Some(found) = known.get(&derivative.node()) {
        return *found;
    }
    let mut may_vanish = |part: Expression| may_vanish_knowing(pool, part, known);
    let found = match pool.operation(derivative) {
        Operation::Multiply(a, b) => may_vanish(*a) || may_vanish(*b),
        Operation::Divide(a, _) => may_vanish(*a),
        Operation::Add(a, b) => {
            let [first, second] = [a, b].map(|term| may_vanish(*term));
            let is_fixed = |term: &Expression| pool.rate(*term) != Rate::Varying;
            first && (second || is_fixed(b)) || second && is_fixed(a)
        }
        Operation::Call(Function::SelectLess, arguments) => arguments[2..]
            .iter()
            .any(|chosen| *chosen == Expression::ZERO || may_vanish(*chosen)),
        _ => false,
    };
    known.insert(derivative.node(), found);
    found
}

/// A factor that is a choice between something and zero, with what it compares and chooses from.
fn vanishing(pool: &Pool, product: Expression) -> Option<(Expression, [Expression; 4])> {
    match pool.operation(product) {
        Operation::Multiply(a, b) => vanishing(pool, *a).or_else(|| vanishing(pool, *b)),
        Operation::Divide(a, _) => vanishing(pool, *a),
        Operation::Call(Function::SelectLess, arguments) => {
            let arguments: [Expression; 4] = arguments[..].try_into().ok()?;
            arguments[2..]
                .contains(&Expression::ZERO)
                .then(|| (product.magnitude(), arguments))
        }
        _ => None,
    }
}

fn select(
    pool: &mut Pool,
    a: Expression,
    b: Expression,
    yes: Expression,
    no: Expression,
) -> Expression {
    if yes == no {
        yes
    } else {
        pool.call(Function::SelectLess, &[a, b, yes, no])
    }
}

fn atan2_rule(pool: &mut Pool, known: &Rewritten, y: Expression, x: Expression) -> Expression {
    let first = pool.multiply(x, known.of(y));
    let second = pool.multiply(y, known.of(x));
    let numerator = pool.subtract(first, second);
    let (xx, yy) = (pool.multiply(x, x), pool.multiply(y, y));
    let radius = pool.add(xx, yy);
    pool.divide(numerator, radius).unwrap_or(Expression::ZERO)
}

/// Of `x^p`: `p x^(p − 1) x' + x^p ln(x) p'`. The first is finite at zero where `p` is above 1, which no form with `x^p / x`
/// is.
fn power_rule(
    pool: &mut Pool,
    known: &Rewritten,
    whole: Expression,
    base: Expression,
    exponent: Expression,
) -> Expression {
    let before = pool.subtract(exponent, Expression::ONE);
    let slope = pool.real_power(base, before).unwrap_or(Expression::ZERO);
    let outer = pool.multiply(exponent, slope);
    let is_steep = pool.constant_value(exponent).is_none_or(|it| it < 1.0);
    let by_base = chain(pool, is_steep, outer, known.of(base));
    if known.of(exponent) == Expression::ZERO {
        return by_base;
    }
    let logarithm = pool.call(Function::Ln, &[base]);
    let factors = [whole, logarithm, known.of(exponent)];
    let by_exponent = factors
        .into_iter()
        .fold(Expression::ONE, |a, b| pool.multiply(a, b));
    pool.add(by_base, by_exponent)
}

/// Derivative of a function of one argument with respect to it, in terms of the value `whole` where that is
/// cheapest.
fn outer(pool: &mut Pool, whole: Expression, function: Function, a: Expression) -> Expression {
    let one = Expression::ONE;
    let quotient = |pool: &mut Pool, n, d| pool.divide(n, d).unwrap_or(Expression::ZERO);
    match function {
        Function::Exp => whole,
        Function::Ln => quotient(pool, one, a),
        Function::Abs => pool.call(Function::Sign, &[a]),
        Function::Sqrt => {
            let two = pool.integer(2);
            let (half, reciprocal) = (quotient(pool, one, two), quotient(pool, one, whole));
            pool.multiply(half, reciprocal)
        }
        Function::Tan => {
            let square = pool.multiply(whole, whole);
            pool.add(one, square)
        }
        Function::Tanh => {
            let square = pool.multiply(whole, whole);
            pool.subtract(one, square)
        }
        Function::Asin | Function::Acos => {
            let square = pool.multiply(a, a);
            let rest = pool.subtract(one, square);
            let root = pool.call(Function::Sqrt, &[rest]);
            quotient(pool, one, root).flipped(function == Function::Acos)
        }
        Function::Fraction => one,
        // The derivative of a step is zero wherever it exists; the others are handled by their own rules.
        Function::Sign
        | Function::Min
        | Function::Max
        | Function::Atan2
        | Function::Pow
        | Function::SelectLess => Expression::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotient_of_sine_and_cosine_is_one_plus_square() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let (sine, cosine) = (pool.sine(x), pool.cosine(x));
        let tangent = pool.divide(sine, cosine).unwrap();
        let slope = Differentiator::new(Symbol::State(0)).derivative(&mut pool, tangent);
        let square = pool.multiply(tangent, tangent);
        assert_eq!(slope, pool.add(Expression::ONE, square));
    }

    /// Below zero `max(x, 0)` does not change, whatever slope the functions of it have there.
    #[test]
    fn infinite_slopes_of_what_does_not_change_are_left_out() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let above = pool.call(Function::Max, &[x, Expression::ZERO]);
        let twice = pool.add(above, above);
        let root = pool.call(Function::Sqrt, &[twice]);
        let quarter = pool.literal("0.25").unwrap();
        let power = pool.real_power(above, quarter).unwrap();
        for function in [root, power] {
            let slope = Differentiator::new(Symbol::State(0)).derivative(&mut pool, function);
            let Operation::Call(Function::SelectLess, arguments) = pool.operation(slope) else {
                panic!("{:?}", pool.operation(slope));
            };
            assert_eq!(arguments[..2], [Expression::ZERO, x]);
            assert_eq!(arguments[3], Expression::ZERO);
        }
    }

    #[test]
    fn min_follows_the_smaller_argument() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let y = pool.symbol(Symbol::State(1));
        let smaller = pool.call(Function::Min, &[x, y]);
        let slope = Differentiator::new(Symbol::State(0)).derivative(&mut pool, smaller);
        assert_eq!(
            slope,
            pool.call(
                Function::SelectLess,
                &[x, y, Expression::ONE, Expression::ZERO]
            )
        );
    }
}
