//! Rooted trees and the order conditions that they stand for; for the tests of tableaux.
//!
//! Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993), II.2; for Rosenbrock's
//! methods Hairer and Wanner II, IV.7: a vertex with one branch is reached through `α + γ`, others through `α`.

use std::vec;
use std::vec::Vec;

/// A rooted tree: the trees at its root, in descending order.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Tree(Vec<Tree>);

impl Tree {
    /// Number of vertices.
    pub(super) fn order(&self) -> usize {
        1 + self.0.iter().map(Self::order).sum::<usize>()
    }

    /// γ(t).
    pub(super) fn density(&self) -> f64 {
        self.0.iter().map(Self::density).product::<f64>() * self.order() as f64
    }

    /// The elementary weight of each stage.
    pub(super) fn weights(&self, several: &[Vec<f64>], single: &[Vec<f64>]) -> Vec<f64> {
        let matrix = if self.0.len() == 1 { single } else { several };
        let mut weights = vec![1.0; matrix.len()];
        for branch in &self.0 {
            let inner = branch.weights(several, single);
            for (weight, row) in weights.iter_mut().zip(matrix) {
                *weight *= row.iter().zip(&inner).map(|(a, b)| a * b).sum::<f64>();
            }
        }
        weights
    }
}

/// All rooted trees of at most this order.
pub(super) fn trees(order: usize) -> Vec<Tree> {
    let mut known = vec![Tree(Vec::new())];
    for vertices in 2..=order {
        let smaller = known.clone();
        let mut roots = Vec::new();
        forests(
            vertices - 1,
            smaller.len(),
            &smaller,
            &mut Vec::new(),
            &mut roots,
        );
        known.extend(roots.into_iter().map(Tree));
    }
    known
}

/// All descending lists of trees with so many vertices together, from the first `bound` of them.
fn forests(
    vertices: usize,
    bound: usize,
    trees: &[Tree],
    chosen: &mut Vec<Tree>,
    found: &mut Vec<Vec<Tree>>,
) {
    if vertices == 0 {
        found.push(chosen.clone());
        return;
    }
    for place in (0..bound).rev() {
        let tree = &trees[place];
        if tree.order() <= vertices {
            chosen.push(tree.clone());
            forests(vertices - tree.order(), place + 1, trees, chosen, found);
            chosen.pop();
        }
    }
}

/// A method as its order conditions see it.
pub(super) struct Scheme {
    /// `α`, and `α + γ` for methods of Rosenbrock.
    pub(super) several: Vec<Vec<f64>>,
    pub(super) single: Vec<Vec<f64>>,
}

impl Scheme {
    /// Largest residual of the conditions of one order, for a result `Σ bᵢ kᵢ` after the fraction `s` of a step.
    pub(super) fn residual(&self, result: &[f64], order: usize, s: f64) -> f64 {
        let of_order = trees(order)
            .into_iter()
            .filter(|tree| tree.order() == order);
        of_order.fold(0.0, |largest: f64, tree| {
            let weights = tree.weights(&self.several, &self.single);
            let sum: f64 = weights.iter().zip(result).map(|(a, b)| a * b).sum();
            largest.max((sum - s.powi(order as i32) / tree.density()).abs())
        })
    }

    /// Asserts that a result has exactly this order.
    pub(super) fn assert_order(
        &self,
        name: &str,
        result: &[f64],
        order: usize,
        s: f64,
        within: f64,
    ) {
        for lower in 1..=order {
            let residual = self.residual(result, lower, s);
            assert!(
                residual < within,
                "{name}, s = {s}: {residual:e} at order {lower}"
            );
        }
        let residual = self.residual(result, order + 1, s);
        assert!(
            residual > 10.0 * within,
            "{name} has a higher order than {order}"
        );
    }
}

#[test]
fn trees_are_as_many_as_known() {
    let counts = (1..=8).map(|order| {
        let of_order = trees(8).into_iter().filter(|tree| tree.order() == order);
        of_order.count()
    });
    assert_eq!(counts.collect::<Vec<_>>(), [1, 1, 2, 4, 9, 20, 48, 115]);
}
