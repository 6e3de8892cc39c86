//! The cheapest formulation of a reduced system.
//!
//! The inertia that belongs to its independent rates may be worked out and factorised in two orders, with the same
//! pivots. From the leaves to the base each joint is released as soon as nothing is left that it carries (articulated
//! bodies, Featherstone 1983), which costs as much for each body however many there are. Or the bodies are first brought
//! together as if no joint could move (composite bodies, Walker and Orin 1982), and all joints are released at the end,
//! which costs less where few follow one another. So both are worked out and counted, unless many do.

use super::{Failure, Solution, solve};
use crate::equations::Scalars;
use crate::symbolic::substitute::operations;
use crate::symbolic::{Expression, Pool};

/// When the independent rates are eliminated.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Formulation {
    /// Each with what it carries.
    Articulated,
    /// After everything else.
    Composite,
}

/// Most joints from base to leaf with which both formulations are counted: longer chains cost more as composite bodies,
/// and counting takes as long as solving.
const FEW: usize = 6;

/// Solves a reduced system by the formulation that takes fewer operations.
pub(super) fn cheapest(scalars: &Scalars, pool: &mut Pool) -> Result<Solution, Failure> {
    if !(2..=FEW).contains(&scalars.deepest) {
        return solve(scalars, Formulation::Articulated, pool);
    }
    // Equal functions are one node of a pool, so that each formulation needs its own.
    let mut other = pool.clone();
    let articulated = solve(scalars, Formulation::Articulated, pool)?;
    if let Ok(composite) = solve(scalars, Formulation::Composite, &mut other)
        && cost(scalars, &composite, &other) < cost(scalars, &articulated, pool)
    {
        *pool = other;
        return Ok(composite);
    }
    Ok(articulated)
}

/// Operations of the independent rates.
fn cost(scalars: &Scalars, solution: &Solution, pool: &Pool) -> usize {
    let independent = scalars.independent.values();
    let rates: Vec<Expression> = independent
        .map(|rate| solution.values[rate.unknown])
        .collect();
    operations(pool, &rates)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::diagnostics::Diagnostics;
    use crate::structure::{reduce, select};
    use crate::syntax::ast::Item;
    use crate::{elaborate, equations, network, syntax};

    /// The reduced equations of a chain in space, on hinges about x and y in turn.
    fn chain(links: usize) -> (Scalars, Pool) {
        let text = format!(
            "#[derivative]
            model Chain {{
                causality componentwise;
                gravity [0.0, 0.0, -9.81];
                ends: for k in 0..{links} + 1 {{ 1 end[6]; }}
                Sf fixed[6] {{ flow: 0.0 }} -> ends[0].end;
                links: for k in 0..{links} {{
                    1 rod[6];
                    hinge: Revolute {{ axis: k % 2 }} (ends[k].end, rod);
                    body: Body {{
                        mass: 2.0, inertia: diag(0.3, 0.4, 0.5), centre: [0.1, 0.2, -0.5]
                    }} (rod);
                    length: Offset {{ by: [0.0, 0.0, -1.0] }} (rod, ends[k+1].end);
                }}
            }}"
        );
        let mut diagnostics = Diagnostics::new();
        let source = syntax::parse(text.parse().unwrap(), &mut diagnostics);
        let Some(Item::Model(model)) = source.items.last() else {
            panic!("a model was written")
        };
        let mut pool = Pool::new();
        let components = elaborate::component_table(&source);
        let mut elaborated =
            elaborate::elaborate(model, &components, &mut pool, &mut diagnostics).unwrap();
        let network = network::Network::of(&elaborated.graph, &mut pool);
        let scalars = equations::form(&elaborated, &network, &mut pool);
        let lost = select(&elaborated, &scalars, &mut pool, &mut diagnostics).unwrap();
        let reduction =
            reduce(&mut elaborated, scalars, &lost, &mut pool, &mut diagnostics).unwrap();
        (reduction.scalars, pool)
    }

    /// The pool's images are equal if the functions are.
    #[test]
    fn formulations_are_the_same_functions() {
        for links in 2..=4 {
            let (scalars, pool) = chain(links);
            let rates = |formulation| {
                let mut pool = pool.clone();
                let solution = solve(&scalars, formulation, &mut pool).ok().unwrap();
                let independent = scalars.independent.values();
                let images: Vec<_> = independent
                    .map(|rate| pool.image(solution.values[rate.unknown]))
                    .collect();
                (images, cost(&scalars, &solution, &pool))
            };
            let (articulated, composite) = (
                rates(Formulation::Articulated),
                rates(Formulation::Composite),
            );
            assert_eq!(articulated.0, composite.0);
            assert_ne!(articulated.1, composite.1, "both are what they are called");
        }
    }

    #[test]
    fn the_cheaper_one_is_taken() {
        let (scalars, pool) = chain(2);
        let costs = [Formulation::Articulated, Formulation::Composite].map(|formulation| {
            let mut pool = pool.clone();
            let solution = solve(&scalars, formulation, &mut pool).ok().unwrap();
            cost(&scalars, &solution, &pool)
        });
        let mut pool = pool;
        let solution = cheapest(&scalars, &mut pool).ok().unwrap();
        assert_eq!(
            cost(&scalars, &solution, &pool),
            costs.into_iter().min().unwrap()
        );
        assert!(costs[1] < costs[0], "{costs:?}");
    }
}
