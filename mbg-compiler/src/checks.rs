//! Stage 5c, checks: what `new` asks of the parameters.

use crate::compile::text;
use crate::elaborate::{Condition, Elaborated};
use crate::equations::Scalars;
use crate::graph::Law;
use crate::structure::Solution;
use crate::symbolic::{Expression, Operation, Pool, Rate};

/// A check that `new` makes.
pub struct Check {
    /// The parameter, or the expression of parameters.
    pub name: String,
    /// What must hold.
    pub condition: Condition,
    /// Why.
    pub reason: String,
}

/// What `new` checks beyond that every parameter is finite.
pub fn of(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    pool: &Pool,
) -> (Vec<Check>, Vec<Expression>) {
    let mut checks = Vec::new();
    let mut checked: Vec<Expression> = Vec::new();
    let mut add = |expression: Expression, condition: Condition, reason: String| {
        if pool.rate(expression) == Rate::Parameter && !checked.contains(&expression) {
            checks.push(Check {
                name: text(model, scalars, pool, expression),
                condition,
                reason,
            });
            checked.push(expression);
        }
    };
    for assumption in &model.assumptions {
        add(
            assumption.expression,
            assumption.condition,
            assumption.reason.clone(),
        );
    }
    for (expression, condition) in &solution.assumptions {
        add(
            *expression,
            *condition,
            "the chosen causality divides by it".to_owned(),
        );
    }
    for divisor in divisors(model, pool) {
        add(
            divisor,
            Condition::NonZero,
            "a law divides by it".to_owned(),
        );
    }
    (checks, checked)
}

/// Divisors of parameters alone in the laws of storages.
fn divisors(model: &Elaborated, pool: &Pool) -> Vec<Expression> {
    let mut roots: Vec<Expression> = Vec::new();
    for element in &model.graph.elements {
        match &element.law {
            Law::Storage(storage) => roots.extend(&storage.coenergy),
            Law::Source(values) | Law::EffortLaw(values) | Law::FlowLaw(values) => {
                roots.extend(values)
            }
            Law::Resistance(matrix) | Law::Conductance(matrix) => roots.extend(&matrix.entries),
            _ => {}
        }
    }
    let mut found = Vec::new();
    let mut seen = vec![false; pool.len()];
    while let Some(current) = roots.pop() {
        if std::mem::replace(&mut seen[current.node()], true) {
            continue;
        }
        let operation = pool.operation(current);
        if let Operation::Divide(_, divisor) = operation
            && pool.rate(*divisor) == Rate::Parameter
        {
            found.push(divisor.magnitude());
        }
        roots.extend(operation.operands());
    }
    found.sort_unstable();
    found
}
