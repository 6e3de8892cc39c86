//! Which of some symbols the nodes of the graph depend on.

use rustc_hash::FxHashMap;

use super::expression::{Expression, Operation, Symbol};
use super::pool::Pool;
use super::substitute::visit;
use crate::bits::Bits;

/// What expressions depend on, and all that they are worked out from.
pub struct Dependence {
    /// Looked up, never iterated.
    sets: FxHashMap<usize, Bits>,
    pairs: usize,
}

impl Dependence {
    /// Of expressions on symbols, which are numbered by their places.
    #[must_use]
    pub fn of(pool: &Pool, expressions: &[Expression], symbols: &[Symbol]) -> Self {
        let places = symbols.iter().enumerate().map(|(place, it)| (*it, place));
        let places: FxHashMap<Symbol, usize> = places.collect();
        let mut sets: FxHashMap<usize, Bits> = FxHashMap::default();
        let mut nodes = Vec::new();
        let mut free = 0;
        visit(pool, expressions, |node, operation| {
            let mut own = Bits::default();
            if let Operation::Symbol(symbol) = operation
                && let Some(place) = places.get(symbol)
            {
                own.insert(*place);
                free += 1;
            }
            sets.insert(node.node(), own);
            nodes.push(node);
        });
        // Operands come before what uses them, but unknowns before what they are found from.
        nodes.sort_unstable();
        let mut is_settled = false;
        while !is_settled {
            is_settled = true;
            for node in &nodes {
                let mut set = sets[&node.node()].clone();
                for cause in pool.causes(*node).iter() {
                    set.join(&sets[&cause.node()]);
                }
                let known = sets.entry(node.node()).or_default();
                is_settled &= *known == set;
                *known = set;
            }
        }
        let pairs = nodes.iter().map(|node| sets[&node.node()].len());
        let pairs = pairs.sum::<usize>() - free;
        Self { sets, pairs }
    }

    /// The symbols that one of the expressions depends on, by place.
    pub fn places(&self, expression: Expression) -> impl Iterator<Item = usize> + '_ {
        self.sets
            .get(&expression.node())
            .into_iter()
            .flat_map(Bits::iter)
    }

    /// Pairs of an operation and a symbol that it depends on: about as many operations do the derivatives take, entry by entry.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::{Implicit, Kind, Matrix, Method};

    fn places(dependence: &Dependence, expression: Expression) -> Vec<usize> {
        dependence.places(expression).collect()
    }

    #[test]
    fn operations_count_once_for_each_symbol() {
        let mut pool = Pool::new();
        let [x, y, z] = [0, 1, 2].map(|state| pool.symbol(Symbol::State(state)));
        let product = pool.multiply(x, y);
        let sum = pool.add(product, z);
        let sine = pool.sine(z);
        let symbols = [0, 1].map(Symbol::State);
        let found = Dependence::of(&pool, &[sum, sine, x], &symbols);
        assert_eq!(places(&found, sum), [0, 1]);
        assert_eq!(places(&found, sine), []);
        assert_eq!(places(&found, x), [0]);
        assert_eq!(found.pairs(), 4, "two each of the product and the sum");
    }

    #[test]
    fn unknowns_depend_on_what_they_are_found_from() {
        let mut pool = Pool::new();
        let [x, y] = [0, 1].map(|state| pool.symbol(Symbol::State(state)));
        let solution = |pool: &mut Pool, number: usize, right: Expression| {
            let unknown = pool.symbol(Symbol::Unknown(number));
            pool.define(Implicit {
                unknowns: vec![number],
                method: Method::Linear {
                    matrix: Matrix::new(1, 1, vec![y]),
                    right: vec![right],
                    kind: Kind::Regular,
                },
            });
            unknown
        };
        // The first unknown is numbered before the second, from which it is found.
        let second = pool.symbol(Symbol::Unknown(1));
        let first = solution(&mut pool, 0, second);
        let doubled = pool.add(first, first);
        solution(&mut pool, 1, x);
        let symbols = [0, 1].map(Symbol::State);
        let found = Dependence::of(&pool, &[doubled], &symbols);
        assert_eq!(places(&found, doubled), [0, 1]);
    }
}
