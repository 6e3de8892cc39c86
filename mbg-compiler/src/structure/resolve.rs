//! The solution of a model's equations, by whatever it takes.

use std::collections::BTreeMap;

use proc_macro2::Span;

use super::{Failure, Solution, Undetermined, block_names, formulation, reduce, select};
use crate::codes;
use crate::compile::text;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::elaborate::Elaborated;
use crate::equations::{Equation, Owner, Scalars};
use crate::symbolic::{Expression, Pool};

/// Equations with their solution.
pub struct Solved {
    /// The equations, reduced where storages depend on each other.
    pub scalars: Scalars,
    /// Their solution.
    pub solution: Solution,
    /// Momentum or displacement of every state that was lost, in signals.
    pub momenta: BTreeMap<usize, Expression>,
}

/// The solution of the equations, with an index reduction where storages depend on each other and the `first` attempt
/// failed.
pub fn resolve(
    model: &mut Elaborated,
    scalars: Scalars,
    first: Result<Solution, Failure>,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Solved> {
    match first {
        Ok(solution) => {
            return Some(Solved {
                scalars,
                solution,
                momenta: BTreeMap::new(),
            });
        }
        Err(Failure::Undetermined(found)) => {
            report_undetermined(model, &scalars, pool, &found, diagnostics);
            return None;
        }
        Err(Failure::Singular) => {}
    }
    let selection = select(model, &scalars, pool, diagnostics)?;
    let reduction = reduce(model, scalars, &selection, pool, diagnostics)?;
    let scalars = reduction.scalars;
    match formulation::cheapest(&scalars, pool) {
        Ok(solution) => Some(Solved {
            scalars,
            solution,
            momenta: reduction.momenta,
        }),
        Err(Failure::Undetermined(found)) => {
            report_undetermined(model, &scalars, pool, &found, diagnostics);
            None
        }
        Err(Failure::Singular) => {
            let message = "the efforts between dependent storages are undetermined";
            diagnostics.error(codes::SINGULAR_JUNCTIONS, model.name.span(), message);
            None
        }
    }
}

/// A nonlinear loop whose Jacobian is identically singular: its equations, and the slopes that show it.
fn report_undetermined(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    found: &Undetermined,
    diagnostics: &mut Diagnostics,
) {
    let names = listing(block_names(scalars, &found.unknowns));
    let message = "a nonlinear algebraic loop does not determine its variables";
    let span = nonlinear_law(model, scalars, &found.unknowns);
    let mut report =
        error(codes::NONLINEAR_LOOP, span, message).note(format!("the loop runs through {names}"));
    for (row, residual) in found.residuals.iter().enumerate() {
        report = report.note(format!("0 = {}", text(model, scalars, pool, *residual)));
        for (column, unknown) in found.left.iter().enumerate() {
            let slope = text(model, scalars, pool, found.jacobian.at(row, column));
            let by = &scalars.names[*unknown];
            report = report.note(format!("  its derivative by `{by}` is {slope}"));
        }
    }
    diagnostics.report(
        report
            .note("the determinant of these derivatives is zero, whatever the state")
            .help(
                "put a storage into the loop: `I body { inertia: … }` at a 1-junction of it, or \
                 `C spring { stiffness: … }` at a 0-junction",
            ),
    );
}

/// Where the law stands in which unknowns of a loop enter nonlinearly.
fn nonlinear_law(model: &Elaborated, scalars: &Scalars, unknowns: &[usize]) -> Span {
    let graph = &model.graph;
    let nonlinear = |equation: &&Equation| equation.signals.iter().any(|it| unknowns.contains(it));
    match scalars.equations.iter().find(nonlinear).map(|it| it.owner) {
        Some(Owner::Element(id, _)) => graph.origins.span(graph.elements[id.0].origin),
        _ => model.name.span(),
    }
}
