//! The solution of a model's equations, by whatever it takes.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use super::floating::bare_frame;
use super::zero::zero_law;
use super::{Failure, Selection, Solution, Undetermined, block_names, formulation, reduce, select};
use crate::codes;
use crate::compile::text;
use crate::diagnostics::{Diagnostic, Diagnostics, error, listing};
use crate::elaborate::Elaborated;
use crate::equations::{Equation, Owner, Scalars};
use crate::graph::{ElementId, outermost_instance};
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
    let mut told = Diagnostics::new();
    let Some(selection) = select(model, &scalars, pool, &mut told) else {
        let reports = match bare_frame(model, &scalars, pool).or_else(|| zero_law(model, pool)) {
            Some(report) => vec![report],
            None => told.list().to_vec(),
        };
        reports.into_iter().for_each(|it| diagnostics.report(it));
        return None;
    };
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
            report_unheld(model, &selection, diagnostics);
            None
        }
    }
}

/// Storages between which something moves without inertia, or is held twice: the joint that moves so, where there is one.
fn report_unheld(model: &Elaborated, selection: &Selection, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    let lost: BTreeSet<ElementId> = selection.lost.iter().map(|lost| lost.element).collect();
    let names = listing(lost.iter().map(|id| graph.elements[id.0].name.clone()));
    let dependent = lost.first().map(|id| graph.elements[id.0].origin);
    let idle = selection.idle.first().map(|id| &graph.junctions[id.0]);
    let span = match idle.map(|it| it.origin).or(dependent) {
        Some(origin) => graph.origins.span(origin),
        None => model.name.span(),
    };
    let message = format!("the efforts between dependent storages are undetermined: at {names}");
    let report = error(codes::SINGULAR_JUNCTIONS, span, message);
    diagnostics.report(match idle {
        Some(idle) => {
            let joint = outermost_instance(&idle.name, None).unwrap_or(&idle.name);
            moves_without_inertia(report, joint)
        }
        None => report
            .note("something there moves without inertia, or is held twice")
            .help("give every frame that can turn or move by itself a body with an inertia")
            .help("or put a `Cut` in the place of one of two joints that hold one motion"),
    });
}

/// What is missing behind a joint on whose motion nothing heavy depends.
pub(super) fn moves_without_inertia(report: Diagnostic, joint: &str) -> Diagnostic {
    report
        .note(format!("what `{joint}` leads to can move without moving any inertia"))
        .help(format!(
            "give the frame behind `{joint}` a body with an inertia: a `PointMass` has none about the lines through it"
        ))
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
