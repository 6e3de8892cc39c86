//! Junctions that a bond leads to and nothing else: a node without its ground, a wall without its source.
//!
//! Such a 0-junction has no flow, and such a 1-junction no effort. That takes a branch or a spring behind the bond out of
//! the model, of which it is warned; and where storages lose their states by it, it is the first way out. A circuit whose
//! ground is missing may close among its nodes: then nothing flows through its source.

use crate::causality::ways::hold;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::elaborate::{Elaborated, Place};
use crate::graph::{
    BondGraph, ElementId, ElementKind, End, JunctionId, JunctionKind, Law, instance_of,
};
use crate::structure::Solved;
use crate::symbolic::Expression;

/// A junction, and what it takes out of the model.
struct Loose {
    id: JunctionId,
    dead: String,
}

/// Warns of those whose effort or flow nobody asks for.
pub(crate) fn warn(model: &Elaborated, solved: &Solved, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    let mut is_told = false;
    for Loose { id, dead } in all(graph) {
        let junction = &graph.junctions[id.0];
        if is_read(model, Place::Junction(id)) || junction.own_name().starts_with('_') {
            continue;
        }
        let message = match junction.kind {
            JunctionKind::Zero => format!(
                "nothing flows through `{}`, which has one bond, nor through `{dead}`",
                junction.name
            ),
            JunctionKind::One => format!(
                "nothing acts on `{}`, which has one bond, nor does `{dead}` act",
                junction.name
            ),
        };
        let report = error(
            codes::LOOSE_END,
            graph.origins.span(junction.origin),
            message,
        );
        diagnostics.warn(report.help(holding(graph, id)));
        is_told = true;
    }
    if !is_told {
        warn_of_sources(model, solved, diagnostics);
    }
}

/// Warns of effort sources at nodes through which nothing flows, whatever the state, and whose effort nobody asks for.
fn warn_of_sources(model: &Elaborated, solved: &Solved, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    for bond in &graph.bonds {
        let (End::OnePort(id), End::Junction(node, _)) = (&bond.from, &bond.to) else {
            continue;
        };
        let asked = [Place::Junction(*node), Place::Port(*id)];
        let is_asked = asked.into_iter().any(|place| is_read(model, place));
        if is_asked || !is_driven(graph, *id, *node) || !is_idle(solved, *id) {
            continue;
        }
        let element = &graph.elements[id.0];
        let span = graph.origins.span(element.origin);
        let name = &element.name;
        let message = format!("nothing flows through `{name}`, whatever the state");
        let report = error(codes::NO_EFFECT, span, message);
        let ground = ground_of(graph, *node).map(|id| holding(graph, id));
        diagnostics.warn(match ground {
            Some(held) => report.help(format!("if its circuit lacks a ground, {held}")),
            None => report,
        });
    }
}

/// Whether a law or an output asks for an effort or a flow there.
fn is_read(model: &Elaborated, asked: Place) -> bool {
    let mut read = model.signals.list().iter();
    read.any(|(_, place, _)| *place == asked)
}

/// Whether an effort source that is not zero drives a node.
fn is_driven(graph: &BondGraph, source: ElementId, node: JunctionId) -> bool {
    let element = &graph.elements[source.0];
    let is_node = graph.junctions[node.0].kind == JunctionKind::Zero;
    let is_zero = |efforts: &[Expression]| efforts.iter().all(|it| *it == Expression::ZERO);
    is_node
        && element.kind == ElementKind::Se
        && matches!(&element.law, Law::Source(efforts) if !is_zero(efforts))
}

/// Whether the flow of a one-port is zero whatever the state.
fn is_idle(solved: &Solved, id: ElementId) -> bool {
    let mut flow = solved.scalars.ports[&id].flow.iter();
    flow.all(|unknown| solved.solution.values[*unknown] == Expression::ZERO)
}

/// The last node beside one that no source holds.
fn ground_of(graph: &BondGraph, node: JunctionId) -> Option<JunctionId> {
    let own = &graph.junctions[node.0];
    let is_held = |id: JunctionId| {
        let mut far = graph.across(id);
        far.any(
            |far| matches!(far, End::OnePort(it) if graph.elements[it.0].kind == ElementKind::Se),
        )
    };
    let is_like = |id: &JunctionId| {
        let other = &graph.junctions[id.0];
        (other.kind, other.dimension) == (own.kind, own.dimension)
            && instance_of(&other.name) == instance_of(&own.name)
    };
    let mut nodes = (0..graph.junctions.len()).map(JunctionId).filter(is_like);
    nodes.rfind(|id| !is_held(*id))
}

/// The sources that are missing, as ways out.
pub(crate) fn holdings(graph: &BondGraph) -> Vec<String> {
    all(graph).iter().map(|it| holding(graph, it.id)).collect()
}

fn holding(graph: &BondGraph, id: JunctionId) -> String {
    let junction = &graph.junctions[id.0];
    let source = hold(graph, id, 0..junction.dimension);
    format!("hold `{}`: {source}", junction.name)
}

fn all(graph: &BondGraph) -> Vec<Loose> {
    let junctions = (0..graph.junctions.len()).map(JunctionId);
    let loose = junctions.filter_map(|id| {
        Some(Loose {
            id,
            dead: dead(graph, id)?,
        })
    });
    loose.collect()
}

/// What the only bond of a junction takes out of the model.
fn dead(graph: &BondGraph, id: JunctionId) -> Option<String> {
    let junction = &graph.junctions[id.0];
    let mut far = graph.across(id);
    let (Some(far), None) = (far.next(), far.next()) else {
        return None;
    };
    match far {
        End::OnePort(element) => {
            let element = &graph.elements[element.0];
            (element.kind == ElementKind::R).then(|| element.name.clone())
        }
        End::Junction(other, _) => {
            let (own, other) = (junction.kind, &graph.junctions[other.0]);
            let is_dead = own != other.kind && (own == JunctionKind::Zero || has_law(graph, far));
            is_dead.then(|| other.name.clone())
        }
        _ => None,
    }
}

/// Whether a storage or a resistor gives the effort or takes the flow of a junction; a 0-junction without one is free to
/// have none, as an axis of a joint is.
fn has_law(graph: &BondGraph, junction: &End) -> bool {
    let End::Junction(id, _) = junction else {
        return false;
    };
    let mut bonds = graph.bonds.iter();
    bonds.any(|bond| match [&bond.from, &bond.to] {
        [End::Junction(other, _), End::OnePort(element)]
        | [End::OnePort(element), End::Junction(other, _)] => {
            let kind = graph.elements[element.0].kind;
            other == id && matches!(kind, ElementKind::C | ElementKind::R)
        }
        _ => false,
    })
}
