//! Replacing symbols by expressions.

use rustc_hash::FxHashMap;

use super::expression::{Expression, Operation, Symbol};
use super::pool::Pool;
use super::walk::Rewritten;

/// Replaces symbols; what it does not know stays.
#[derive(Default)]
pub struct Substitution {
    values: FxHashMap<Symbol, Expression>,
    known: Rewritten,
}

impl Substitution {
    /// Nothing replaced yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Replaces `symbol` by `value` from now on; `value` must hold no symbol that is replaced.
    pub fn set(&mut self, symbol: Symbol, value: Expression) {
        self.values.insert(symbol, value);
        self.known.clear();
    }

    /// The value given for a symbol.
    #[must_use]
    pub fn get(&self, symbol: Symbol) -> Option<Expression> {
        self.values.get(&symbol).copied()
    }

    /// The expression with every known symbol replaced; none if that divides by zero.
    #[must_use]
    pub fn apply(&mut self, pool: &mut Pool, expression: Expression) -> Option<Expression> {
        let values = &self.values;
        self.known
            .rewrite(pool, expression, |pool, known, whole, operation| {
                rebuild(pool, values, known, whole, operation)
            })
    }
}

/// An expression with parts replaced by others; none if that divides by zero.
#[must_use]
pub fn replace(
    pool: &mut Pool,
    whole: Expression,
    parts: &[(Expression, Expression)],
) -> Option<Expression> {
    let none = FxHashMap::default();
    let mut known = Rewritten::default();
    for (part, by) in parts {
        known.set(*part, *by);
    }
    known.rewrite(pool, whole, |pool, known, whole, operation| {
        rebuild(pool, &none, known, whole, operation)
    })
}

fn rebuild(
    pool: &mut Pool,
    values: &FxHashMap<Symbol, Expression>,
    known: &Rewritten,
    whole: Expression,
    operation: &Operation,
) -> Option<Expression> {
    Some(match operation {
        Operation::Constant(_) => whole,
        Operation::Symbol(symbol) => values.get(symbol).copied().unwrap_or(whole),
        Operation::Add(a, b) => pool.add(known.of(*a), known.of(*b)),
        Operation::Multiply(a, b) => pool.multiply(known.of(*a), known.of(*b)),
        Operation::Divide(a, b) => pool.divide(known.of(*a), known.of(*b))?,
        Operation::Sine(a) => pool.sine(known.of(*a)),
        Operation::Cosine(a) => pool.cosine(known.of(*a)),
        Operation::Call(function, arguments) => {
            let arguments: Vec<_> = arguments
                .iter()
                .map(|argument| known.of(*argument))
                .collect();
            pool.call(*function, &arguments)
        }
    })
}

/// The symbols that expressions depend on, in order of first sight by depth; what an unknown depends on included.
#[must_use]
pub fn symbols(pool: &Pool, expressions: &[Expression]) -> Vec<Symbol> {
    let mut found = Vec::new();
    visit(pool, expressions, |_, operation| {
        if let Operation::Symbol(symbol) = operation {
            found.push(*symbol);
        }
    });
    found
}

/// Whether an expression depends on one of some symbols; looks no further than to the first of them.
pub fn depends(pool: &Pool, expression: Expression, is_one: impl Fn(&Symbol) -> bool) -> bool {
    let mut seen = vec![false; pool.len()];
    let mut pending = vec![expression];
    while let Some(current) = pending.pop() {
        if std::mem::replace(&mut seen[current.node()], true) {
            continue;
        }
        if matches!(pool.operation(current), Operation::Symbol(symbol) if is_one(symbol)) {
            return true;
        }
        pending.extend(pool.causes(current).iter().rev());
    }
    false
}

/// How many operations the expressions take, shared ones once.
#[must_use]
pub fn operations(pool: &Pool, expressions: &[Expression]) -> usize {
    let mut count = 0;
    visit(pool, expressions, |_, operation| {
        let free = matches!(operation, Operation::Symbol(_) | Operation::Constant(_));
        count += usize::from(!free);
    });
    count
}

/// Each node that the expressions depend on, once.
pub fn visit<'a>(
    pool: &'a Pool,
    expressions: &[Expression],
    mut each: impl FnMut(Expression, &'a Operation),
) {
    let mut seen = vec![false; pool.len()];
    let mut pending: Vec<Expression> = expressions.iter().rev().copied().collect();
    while let Some(current) = pending.pop() {
        if std::mem::replace(&mut seen[current.node()], true) {
            continue;
        }
        each(current.magnitude(), pool.operation(current));
        pending.extend(pool.causes(current).iter().rev());
    }
}
