//! A conflict as diagnostics.
//!
//! As with [dependent storages](super::report), each element that takes part gets one error with the same chain.

use std::collections::BTreeSet;

use super::conflict::Conflict;
use super::explain;
use super::report::{COMPONENTWISE, JACOBIAN, alternatives, resistor_help};
use super::words;
use crate::codes;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::graph::{BondGraph, ElementId, End, JunctionKind, OriginId, Rule};

/// Reports a conflict at each fixed element that takes part, or where the rules fail.
pub fn conflict_diagnostics(graph: &BondGraph, conflict: &Conflict, diagnostics: &mut Diagnostics) {
    let mut reported = BTreeSet::new();
    for origin in origins(graph, conflict) {
        if reported.insert(origin) {
            let message = message(graph, conflict);
            let mut report = error(conflict.code, graph.origins.span(origin), message);
            report.notes = conflict
                .chain
                .iter()
                .map(|step| step.text.clone())
                .collect();
            if reported.len() == 1 {
                report.helps = alternatives(helps(graph, conflict));
            }
            diagnostics.report(report);
        }
    }
}

fn origins(graph: &BondGraph, conflict: &Conflict) -> Vec<OriginId> {
    let mut origins = Vec::new();
    if let (Some(End::Junction(id, _)), codes::NO_ASSIGNMENT) = (conflict.place(), conflict.code) {
        origins.push(graph.junctions[id.0].origin);
    }
    origins.extend(
        conflict
            .elements()
            .iter()
            .map(|id| graph.elements[id.0].origin),
    );
    if origins.is_empty() {
        // No fixed element and no junction: two-ports in a ring, or a search that gave up.
        let bonds = conflict.bonds.iter().map(|id| graph.bonds[id.0].origin);
        let anything = bonds.chain(graph.junctions.iter().map(|junction| junction.origin));
        origins.extend(
            anything
                .chain(graph.bonds.iter().map(|bond| bond.origin))
                .next(),
        );
    }
    origins
}

fn message(graph: &BondGraph, conflict: &Conflict) -> String {
    if !conflict.proven() {
        return "no assignment of strokes was found before the search reached its limit".to_owned();
    }
    let place = conflict
        .place()
        .map_or_else(String::new, |end| format!(" at `{}`", graph.end_name(&end)));
    match conflict.elements().first() {
        Some(id) if conflict.code != codes::NO_ASSIGNMENT => fixed_message(graph, *id)
            .unwrap_or_else(|| {
                let names = names(graph, &conflict.elements());
                format!("the fixed causalities of {names} contradict each other{place}")
            }),
        _ => format!("no assignment of strokes satisfies the rules{place}"),
    }
}

fn names(graph: &BondGraph, ids: &[ElementId]) -> String {
    listing(ids.iter().map(|id| graph.elements[id.0].name.clone()))
}

/// What an element that is no source would have to do.
fn fixed_message(graph: &BondGraph, id: ElementId) -> Option<String> {
    let element = &graph.elements[id.0];
    let demand = match element.rule {
        Rule::Gyroscopic => {
            "give its flow, but its skew 3x3 matrix has rank 2 and no inverse".to_owned()
        }
        Rule::Transformer { .. } | Rule::Gyrator { .. } => {
            format!("run backward, but {}", words::dimensions(element.rule))
        }
        Rule::ResistanceOnly => {
            "give its flow, but its law gives the effort and has no inverse".to_owned()
        }
        Rule::ConductanceOnly => {
            "give its effort, but its law gives the flow and has no inverse".to_owned()
        }
        _ => return None,
    };
    Some(format!(
        "{} `{}` would have to {demand}",
        words::kind_name(graph, id),
        element.name
    ))
}

fn helps(graph: &BondGraph, conflict: &Conflict) -> Vec<String> {
    if !conflict.proven() {
        return vec![COMPONENTWISE.to_owned()];
    }
    let elements = conflict.elements();
    let mut helps: Vec<String> = elements
        .iter()
        .filter_map(|id| resistor_help(graph, *id))
        .collect();
    let end = conflict.place();
    let place = end
        .as_ref()
        .map_or_else(|| "junction".to_owned(), |end| graph.end_name(end));
    helps.push(match (conflict.code, end) {
        (codes::SOURCES_CONFLICT, _) => format!("remove one of {}", names(graph, &elements)),
        (codes::GYROSCOPIC_INVERSE, _) => {
            format!("give `{place}` its flow from an inertia: `I body {{ inertia: …, gyroscopic }}`")
        }
        (_, Some(End::Junction(id, _))) if graph.junctions[id.0].kind == JunctionKind::Zero => {
            format!("attach a resistor that can give the effort: `{place} -> R damper {{ resistance: … }};`")
        }
        _ => format!("attach a resistor that can give the flow: `{place} -> R damper {{ conductance: … }};`"),
    });
    helps.push(COMPONENTWISE.to_owned());
    if explain::blocks_axes(graph, &elements) {
        helps.push(JACOBIAN.to_owned());
    }
    helps
}
