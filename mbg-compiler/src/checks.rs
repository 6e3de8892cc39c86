//! Stage 5c, checks: what `new` asks of the parameters.

use crate::divisors;
use crate::elaborate::{Condition, Elaborated};
use crate::equations::Scalars;
use crate::graph::{Element, Law};
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
                name: divisors::name(model, scalars, pool, expression),
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
    for (divisor, element) in of_laws(model, pool) {
        let reason = format!("the law of `{}` divides by it", element.name);
        add(divisor, Condition::NonZero, reason);
    }
    (checks, checked)
}

/// Divisors of parameters alone in the laws of elements, each with the first element that has it.
fn of_laws<'a>(model: &'a Elaborated, pool: &Pool) -> Vec<(Expression, &'a Element)> {
    let mut found = Vec::new();
    let mut seen = vec![false; pool.len()];
    for element in &model.graph.elements {
        let mut roots: Vec<Expression> = match &element.law {
            Law::Storage(storage) => storage.coenergy.clone(),
            Law::Source(values) | Law::EffortLaw(values) | Law::FlowLaw(values) => values.clone(),
            Law::Resistance(matrix) | Law::Conductance(matrix) => matrix.entries.clone(),
            _ => Vec::new(),
        };
        while let Some(current) = roots.pop() {
            if std::mem::replace(&mut seen[current.node()], true) {
                continue;
            }
            let operation = pool.operation(current);
            if let Operation::Divide(_, divisor) = operation
                && pool.rate(*divisor) == Rate::Parameter
            {
                found.push((divisor.magnitude(), element));
            }
            roots.extend_from_slice(&operation.operands());
        }
    }
    found.sort_by_key(|(divisor, _)| *divisor);
    found
}
