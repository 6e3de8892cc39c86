//! Resistors whose law has no inverse, where the equations need one.

use super::resolve::moves_without_inertia;
use super::{Failure, Formulation, solve};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::elaborate::Elaborated;
use crate::equations;
use crate::graph::{BondGraph, ElementId, End, Law, outermost_instance};
use crate::network::Network;
use crate::symbolic::{Expression, Matrix, Pool};

/// The resistor with which the equations have no solution, and with another law would have one.
pub(super) fn zero_law(model: &Elaborated, pool: &Pool) -> Option<Diagnostic> {
    let elements = model.graph.elements.iter().enumerate();
    let without_inverse = elements.filter(|(_, element)| match &element.law {
        Law::Resistance(matrix) | Law::Conductance(matrix) => {
            matrix.inverse(&mut pool.clone()).is_none()
        }
        _ => false,
    });
    let candidates: Vec<ElementId> = without_inverse.map(|(id, _)| ElementId(id)).collect();
    if candidates.is_empty() || !is_soluble(model, &candidates, pool) {
        return None;
    }
    let alone = candidates
        .iter()
        .find(|id| is_soluble(model, &[**id], pool));
    let culprit = *alone.unwrap_or(&candidates[0]);
    match &model.graph.elements[culprit.0].law {
        Law::Resistance(matrix) => Some(report(model, culprit, ["flow", "resistance"], matrix)),
        Law::Conductance(matrix) => Some(report(model, culprit, ["effort", "conductance"], matrix)),
        _ => None,
    }
}

/// Whether there is a solution where these resistors have the unit matrix.
fn is_soluble(model: &Elaborated, changed: &[ElementId], pool: &Pool) -> bool {
    let (mut model, mut pool) = (model.clone(), pool.clone());
    for id in changed {
        let law = &mut model.graph.elements[id.0].law;
        if let Law::Resistance(matrix) | Law::Conductance(matrix) = law {
            *matrix = Matrix::diagonal(&vec![Expression::ONE; matrix.rows]);
        }
    }
    let network = Network::of(&model.graph, &mut pool);
    let scalars = equations::form(&model, &network, &mut pool);
    let solved = solve(&scalars, Formulation::Articulated, &mut pool);
    !matches!(solved, Err(Failure::Singular))
}

fn report(
    model: &Elaborated,
    id: ElementId,
    [given, word]: [&str; 2],
    matrix: &Matrix,
) -> Diagnostic {
    let graph = &model.graph;
    let element = &graph.elements[id.0];
    let is_zero = matrix.entries.iter().all(|it| *it == Expression::ZERO);
    let what = if is_zero { "is zero" } else { "has no inverse" };
    let name = &element.name;
    let message =
        format!("resistor `{name}` would have to give its {given}, but its {word} {what}");
    let span = graph.origins.span(element.origin);
    let report = error(codes::FIXED_RESISTOR, span, message);
    if let Some(joint) = joint_of_damper(graph, id) {
        return moves_without_inertia(report, joint);
    }
    let taken = element.instance().unwrap_or(name);
    report.help(format!("give it another {word}, or take `{taken}` away"))
}

/// The joint whose free axis an element damps: without damping, only what has inertia can tell how that moves.
fn joint_of_damper(graph: &BondGraph, damper: ElementId) -> Option<&str> {
    let is_free_axis =
        |end: &End| matches!(end, End::Junction(id, _) if graph.junctions[id.0].coordinate);
    let mut bonds = graph.bonds.iter();
    bonds.find(|bond| bond.to == End::OnePort(damper) && is_free_axis(&bond.from))?;
    outermost_instance(&graph.elements[damper.0].name, None)
}
