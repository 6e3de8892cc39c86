//! The walk that every rewriting of the graph shares.

use rustc_hash::FxHashMap;

use super::expression::{Expression, Operation};
use super::pool::Pool;

/// What nodes were rewritten to.
#[derive(Default)]
pub(super) struct Rewritten(FxHashMap<usize, Expression>);

impl Rewritten {
    /// What an expression was rewritten to, with its sign.
    pub(super) fn of(&self, expression: Expression) -> Expression {
        self.0[&expression.node()].flipped(expression.is_negative())
    }

    /// The same, if it was.
    pub(super) fn get(&self, expression: Expression) -> Option<Expression> {
        let rewritten = self.0.get(&expression.node())?;
        Some(rewritten.flipped(expression.is_negative()))
    }

    /// Says what an expression is rewritten to, unless that is known.
    pub(super) fn set(&mut self, expression: Expression, rewritten: Expression) {
        let rewritten = rewritten.flipped(expression.is_negative());
        self.0.entry(expression.node()).or_insert(rewritten);
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Rewrites `root` by `rule`, each node once and operands first, with a stack of its own, so that depth is no
    /// limit; none if the rule has no answer for a node.
    pub(super) fn rewrite(
        &mut self,
        pool: &mut Pool,
        root: Expression,
        rule: impl Fn(&mut Pool, &Self, Expression, &Operation) -> Option<Expression>,
    ) -> Option<Expression> {
        let mut pending = vec![(root.magnitude(), false)];
        while let Some((current, is_ready)) = pending.pop() {
            if !is_ready {
                if self.0.contains_key(&current.node()) {
                    continue;
                }
                pending.push((current, true));
                let operands = pool.operation(current).operands();
                pending.extend(operands.iter().map(|part| (part.magnitude(), false)));
                continue;
            }
            let operation = pool.operation(current).clone();
            let rewritten = rule(pool, self, current, &operation)?;
            self.0.insert(current.node(), rewritten);
        }
        Some(self.of(root))
    }
}
