//! Sums and products in the order in which most of them is shared.
//!
//! A node keeps the first form in which its function was built. Where it is `(a + b) + d`, nothing else needs `a + b`,
//! and `a + d` is computed anyway, it becomes `(a + d) + b`, and one addition is saved; products likewise.

use super::expression::{Expression, Operation, Rate};
use super::pool::Pool;
use super::uses::Uses;

/// Reorders, again and again, whatever is computed for the roots.
pub fn share(pool: &mut Pool, roots: &[Expression]) {
    let mut uses = Uses::of(pool, roots);
    let mut changed = true;
    while changed {
        changed = false;
        for node in pool.nodes() {
            let is_needed = uses.count(node) > 0;
            changed |= is_needed && reorder(pool, &mut uses, node);
        }
    }
}

/// Whether a sum or product of three was put together in another order.
fn reorder(pool: &mut Pool, uses: &mut Uses, node: Expression) -> bool {
    for (inner, last) in ends(pool, node) {
        if uses.count(inner) != 1 || pool.rate(inner) != Rate::Varying {
            continue;
        }
        for (rest, first) in ends(pool, inner) {
            // Operands come before what uses them, so nothing comes to depend on itself.
            let is_there = |known: &Expression| {
                let is_earlier = known.node() < node.node() && known.node() != inner.node();
                is_earlier && uses.count(*known) > 0
            };
            let is_sum = matches!(pool.operation(node), Operation::Add(..));
            let is_same = is_sum == matches!(pool.operation(inner), Operation::Add(..));
            let images = [first, last].map(|part| pool.image(part));
            let known = if is_sum {
                pool.find(images[0].plus(images[1]))
            } else {
                pool.find(images[0].times(images[1]))
            };
            if let Some(known) = known.filter(is_there).filter(|_| is_same)
                && let Some(form) = form(pool.operation(node), known, rest)
            {
                pool.reform(node, form);
                uses.add(pool, known);
                uses.add(pool, rest);
                uses.remove(pool, inner);
                uses.remove(pool, last);
                return true;
            }
        }
    }
    false
}

/// A sum or product of two other parts, if it can be written so.
fn form(operation: &Operation, a: Expression, b: Expression) -> Option<Operation> {
    match operation {
        Operation::Add(..) if !a.is_negative() => Some(Operation::Add(a, b)),
        Operation::Add(..) if !b.is_negative() => Some(Operation::Add(b, a)),
        Operation::Multiply(..) if !a.is_negative() && !b.is_negative() => {
            Some(Operation::Multiply(a, b))
        }
        _ => None,
    }
}

/// Both ways in which a sum or product has two parts.
fn ends(pool: &Pool, expression: Expression) -> Vec<(Expression, Expression)> {
    match *pool.operation(expression) {
        Operation::Add(a, b) => {
            let [a, b] = [a, b].map(|part| part.flipped(expression.is_negative()));
            vec![(a, b), (b, a)]
        }
        Operation::Multiply(a, b) => vec![(a, b), (b, a)],
        _ => Vec::new(),
    }
}
