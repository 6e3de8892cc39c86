//! Linear forms read backwards.

use std::collections::BTreeMap;

use rustc_hash::FxHashSet;

use super::expression::{Expression, Function, Operation, Symbol};
use super::implicit::{Implicit, Kind, Method};
use super::pool::Pool;

/// Of forms that are linear in [`Symbol::Slope`]s, each with a weight: by what each slope is multiplied in the weighted sum of
/// them, by its place. None where a form is not made of sums, products, quotients, choices and solves with symmetric matrices.
///
/// Each step of the forms is gone through once, whatever number of slopes there are: that takes as many products as the
/// forms themselves (Speelpenning, *Compiling Fast Partial Derivatives of Functions Given by Algorithms* (1980)).
pub fn transposed(
    pool: &mut Pool,
    forms: &[(Expression, Expression)],
) -> Option<BTreeMap<usize, Expression>> {
    let mut backwards = Backwards {
        linear: linear(pool, forms),
        weights: BTreeMap::new(),
    };
    for (form, weight) in forms {
        backwards.add(pool, *form, *weight);
    }
    let mut slopes = BTreeMap::new();
    while let Some((node, weight)) = backwards.weights.pop_last() {
        match pool.operation(node) {
            Operation::Symbol(Symbol::Slope(place)) => {
                slopes.insert(*place, weight);
            }
            _ => backwards.pass_on(pool, node, weight)?,
        }
    }
    Some(slopes)
}

struct Backwards {
    /// The nodes that depend on a slope; looked up, never iterated.
    linear: FxHashSet<Expression>,
    /// By what nodes are multiplied that are still to be gone through. What uses a node comes behind it.
    weights: BTreeMap<Expression, Expression>,
}

impl Backwards {
    fn is_linear(&self, expression: Expression) -> bool {
        self.linear.contains(&expression.magnitude())
    }

    fn add(&mut self, pool: &mut Pool, to: Expression, weight: Expression) {
        if self.is_linear(to) {
            let sum = self.weights.entry(to.magnitude());
            let sum = sum.or_insert(Expression::ZERO);
            *sum = pool.add(*sum, weight.flipped(to.is_negative()));
        }
    }

    /// Gives the weight of a node to its operands.
    fn pass_on(&mut self, pool: &mut Pool, node: Expression, weight: Expression) -> Option<()> {
        match pool.operation(node).clone() {
            Operation::Add(a, b) => {
                self.add(pool, a, weight);
                self.add(pool, b, weight);
            }
            Operation::Multiply(a, b) => {
                let (of, factor) = if self.is_linear(a) { (a, b) } else { (b, a) };
                let product = self.fixed(factor)?;
                let product = pool.multiply(weight, product);
                self.add(pool, of, product);
            }
            Operation::Divide(a, b) => {
                let divisor = self.fixed(b)?;
                let quotient = pool.divide(weight, divisor)?;
                self.add(pool, a, quotient);
            }
            Operation::Call(Function::SelectLess, arguments) => {
                let [a, b, yes, no] = arguments[..].try_into().ok()?;
                let [a, b] = [self.fixed(a)?, self.fixed(b)?];
                let chosen = [a, b, weight, Expression::ZERO];
                let chosen = pool.call(Function::SelectLess, &chosen);
                self.add(pool, yes, chosen);
                let left = [a, b, Expression::ZERO, weight];
                let left = pool.call(Function::SelectLess, &left);
                self.add(pool, no, left);
            }
            Operation::Symbol(symbol) => {
                let number = pool.place(symbol)?.number;
                self.weights.insert(node, weight);
                self.pass_on_solution(pool, number)?;
            }
            Operation::Constant(_)
            | Operation::Sine(_)
            | Operation::Cosine(_)
            | Operation::Call(..) => return None,
        }
        Some(())
    }

    /// Gives the weights of a solution to the right side: those of `z = A⁻¹ b` by the same equations, if `A` is symmetric.
    ///
    /// The unknowns follow each other, so that no other node adds to the weight of one any more.
    fn pass_on_solution(&mut self, pool: &mut Pool, number: usize) -> Option<()> {
        let solution = pool.implicit()[number].clone();
        let Method::Slope { of, right } = solution.method else {
            return None;
        };
        let Method::Linear {
            kind: Kind::Semidefinite | Kind::Symmetric,
            ..
        } = pool.implicit()[of].method
        else {
            return None;
        };
        let unknowns = solution.unknowns.iter();
        let weights = unknowns.map(|unknown| {
            let unknown = pool.symbol(Symbol::Unknown(*unknown));
            self.weights.remove(&unknown).unwrap_or(Expression::ZERO)
        });
        let weights: Vec<Expression> = weights.collect();
        let implicit = Implicit {
            unknowns: weights.iter().map(|_| pool.fresh_unknown()).collect(),
            method: Method::Slope { of, right: weights },
        };
        let symbols: Vec<Symbol> = implicit.symbols().collect();
        pool.define(implicit);
        for (symbol, right) in symbols.into_iter().zip(right) {
            let weight = pool.symbol(symbol);
            self.add(pool, right, weight);
        }
        Some(())
    }

    /// The expression, if it does not depend on a slope.
    fn fixed(&self, expression: Expression) -> Option<Expression> {
        (!self.is_linear(expression)).then_some(expression)
    }
}

/// The nodes of the forms that depend on a slope.
fn linear(pool: &Pool, forms: &[(Expression, Expression)]) -> FxHashSet<Expression> {
    let mut nodes = FxHashSet::default();
    let mut pending: Vec<Expression> = forms.iter().map(|(form, _)| form.magnitude()).collect();
    while let Some(node) = pending.pop() {
        if nodes.insert(node) {
            let causes = slope_causes(pool, node);
            pending.extend(causes.iter().map(|it| it.magnitude()));
        }
    }
    let mut nodes: Vec<Expression> = nodes.into_iter().collect();
    nodes.sort_unstable();
    let mut linear = FxHashSet::default();
    for node in nodes {
        let is_slope = matches!(pool.operation(node), Operation::Symbol(Symbol::Slope(_)));
        let causes = slope_causes(pool, node);
        if is_slope || causes.iter().any(|it| linear.contains(&it.magnitude())) {
            linear.insert(node);
        }
    }
    linear
}

/// What a node depends on that may depend on a slope: not the matrices of solves.
fn slope_causes(pool: &Pool, node: Expression) -> Vec<Expression> {
    let Operation::Symbol(symbol) = pool.operation(node) else {
        return pool.operation(node).operands().to_vec();
    };
    let definition = pool.place(*symbol).map(|it| &pool.implicit()[it.number]);
    match definition.map(|it| &it.method) {
        Some(Method::Slope { right, .. }) => right.clone(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::{Differentiator, Evaluation, Matrix};

    fn slope(pool: &mut Pool, place: usize) -> Expression {
        pool.symbol(Symbol::Slope(place))
    }

    /// Two forms of three slopes, with a part in common.
    fn forms(pool: &mut Pool) -> [Expression; 2] {
        let [x, y] = [0, 1].map(|state| pool.symbol(Symbol::State(state)));
        let [a, b, c] = [0, 1, 2].map(|place| slope(pool, place));
        let common = pool.multiply(x, a);
        let common = pool.subtract(common, b);
        let quotient = pool.divide(common, y).unwrap();
        let first = pool.add(quotient, c);
        let chosen = pool.call(Function::SelectLess, &[x, y, common, c]);
        let sine = pool.sine(x);
        let second = pool.multiply(chosen, sine);
        let second = pool.subtract(second, a);
        [first, second]
    }

    /// What the weighted sum takes from each slope, by the rules of differentiation.
    fn expected(pool: &mut Pool, weighted: &[(Expression, Expression)]) -> Vec<Expression> {
        let from = |place| {
            let mut differentiator = Differentiator::new(Symbol::Slope(place));
            weighted
                .iter()
                .fold(Expression::ZERO, |sum, (form, weight)| {
                    let slope = differentiator.derivative(pool, *form);
                    let product = pool.multiply(slope, *weight);
                    pool.add(sum, product)
                })
        };
        (0..3).map(from).collect()
    }

    #[test]
    fn a_weighted_sum_takes_from_each_slope_what_its_derivative_says() {
        let mut pool = Pool::new();
        let forms = forms(&mut pool);
        let weights = [2, 3].map(|state| pool.symbol(Symbol::State(state)));
        let weighted: Vec<_> = forms.into_iter().zip(weights).collect();
        let found = transposed(&mut pool, &weighted).unwrap();
        let expected = expected(&mut pool, &weighted);
        assert_eq!(found.len(), 3);
        for y in [0.3, 2.0] {
            let at = |symbol| match symbol {
                Symbol::State(state) => [0.7, y, 1.1, -0.4][state],
                _ => f64::NAN,
            };
            let mut at = Evaluation::new(&at);
            for (place, expected) in expected.iter().enumerate() {
                let [found, expected] = [found[&place], *expected].map(|it| at.value(&pool, it));
                assert!((found - expected).abs() < 1e-14, "{place} at y = {y}");
            }
        }
    }

    #[test]
    fn what_is_not_linear_is_not_read_backwards() {
        let mut pool = Pool::new();
        let [a, b] = [0, 1].map(|place| slope(&mut pool, place));
        let weight = pool.symbol(Symbol::State(0));
        let product = pool.multiply(a, b);
        let quotient = pool.divide(weight, a).unwrap();
        let size = pool.call(Function::Abs, &[b]);
        let chosen = pool.call(Function::SelectLess, &[a, weight, b, weight]);
        for form in [product, quotient, size, chosen] {
            assert_eq!(transposed(&mut pool, &[(form, weight)]), None);
        }
    }

    /// Two unknowns of equations with a matrix of this kind, whose right side is two slopes.
    fn solution(pool: &mut Pool, kind: Kind) -> [Expression; 2] {
        let entries = [2, 1, 1, 3].map(|number| pool.integer(number));
        let matrix = Matrix::new(2, 2, entries.to_vec());
        let solve = |pool: &mut Pool, method| {
            let unknowns = [pool.fresh_unknown(), pool.fresh_unknown()];
            pool.define(Implicit {
                unknowns: unknowns.to_vec(),
                method,
            });
            unknowns.map(|unknown| pool.symbol(Symbol::Unknown(unknown)))
        };
        let right = [0, 1].map(|state| pool.symbol(Symbol::State(state)));
        let right = right.to_vec();
        solve(
            pool,
            Method::Linear {
                matrix,
                right,
                kind,
            },
        );
        let right = [0, 1].map(|place| slope(pool, place)).to_vec();
        solve(pool, Method::Slope { of: 0, right })
    }

    #[test]
    fn solutions_with_a_symmetric_matrix_are_those_for_the_weights() {
        let mut pool = Pool::new();
        let [_, second] = solution(&mut pool, Kind::Symmetric);
        let weight = pool.symbol(Symbol::State(2));
        let found = transposed(&mut pool, &[(second, weight)]).unwrap();
        let added = pool.implicit().last().unwrap().clone();
        let right = vec![Expression::ZERO, weight];
        assert_eq!(added.method, Method::Slope { of: 0, right });
        let unknowns: Vec<_> = added.symbols().map(|it| pool.symbol(it)).collect();
        assert_eq!([found[&0], found[&1]], unknowns[..]);

        let mut pool = Pool::new();
        let [first, _] = solution(&mut pool, Kind::Regular);
        assert_eq!(transposed(&mut pool, &[(first, Expression::ONE)]), None);
    }
}
