//! How often what is computed is needed.

use super::expression::Expression;
use super::pool::Pool;

/// How many nodes and roots need each node.
pub(super) struct Uses {
    counts: Vec<usize>,
}

impl Uses {
    /// Of what is computed for the roots.
    pub(super) fn of(pool: &Pool, roots: &[Expression]) -> Self {
        let counts = vec![0; pool.len()];
        let mut uses = Self { counts };
        for root in roots {
            uses.add(pool, *root);
        }
        uses
    }

    /// How many need an expression; none needs what came into the pool later.
    pub(super) fn count(&self, expression: Expression) -> usize {
        self.counts.get(expression.node()).copied().unwrap_or(0)
    }

    /// One more needs an expression; gives how many nodes are needed now that were not.
    pub(super) fn add(&mut self, pool: &Pool, expression: Expression) -> usize {
        if self.counts.len() < pool.len() {
            self.counts.resize(pool.len(), 0);
        }
        let mut nodes = 0;
        let mut pending = vec![expression];
        while let Some(current) = pending.pop() {
            self.counts[current.node()] += 1;
            if self.counts[current.node()] == 1 {
                nodes += 1;
                pending.extend_from_slice(&pool.causes(current));
            }
        }
        nodes
    }

    /// One less needs an expression; gives how many nodes no longer are needed.
    pub(super) fn remove(&mut self, pool: &Pool, expression: Expression) -> usize {
        let mut nodes = 0;
        let mut pending = vec![expression];
        while let Some(current) = pending.pop() {
            self.counts[current.node()] -= 1;
            if self.counts[current.node()] == 0 {
                nodes += 1;
                pending.extend_from_slice(&pool.causes(current));
            }
        }
        nodes
    }
}
