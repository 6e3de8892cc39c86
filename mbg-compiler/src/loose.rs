//! Junctions that a bond leads to and nothing else: a node without its ground, a wall without its source.
//!
//! Such a 0-junction has no flow, and such a 1-junction no effort. That takes a branch, a spring or a gear of three shafts
//! behind the bond out of the model, of which it is warned; and where storages lose their states by it, it is the first way
//! out. A circuit whose ground is missing may close among its nodes: then nothing flows through its source.

use crate::causality::ways::hold;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::elaborate::{Elaborated, Place};
use crate::graph::{
    BondGraph, ElementId, ElementKind, End, JunctionId, JunctionKind, Law, Rule, instance_of,
};
use crate::locked;
use crate::structure::Solved;
use crate::symbolic::Expression;

/// A junction, and what it takes out of the model.
struct Loose {
    id: JunctionId,
    dead: String,
    /// The kind of a junction of which as much is zero.
    like: JunctionKind,
}

/// Warns of those whose effort or flow nobody asks for, or else of sources and inertias that can do nothing.
pub(crate) fn warn(model: &Elaborated, solved: &Solved, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    let mut is_told = false;
    for Loose { id, dead, like } in all(graph) {
        let junction = &graph.junctions[id.0];
        if is_read(model, Place::Junction(id)) || junction.own_name().starts_with('_') {
            continue;
        }
        let own = match junction.kind {
            JunctionKind::Zero => "flows through",
            JunctionKind::One => "acts on",
        };
        let behind = match (junction.kind, like) {
            (JunctionKind::Zero, JunctionKind::Zero) => format!("nor through `{dead}`"),
            (JunctionKind::One, JunctionKind::Zero) => {
                format!("and nothing flows through `{dead}`")
            }
            (_, JunctionKind::One) => format!("nor does `{dead}` act"),
        };
        let name = &junction.name;
        let message = format!("nothing {own} `{name}`, which has one bond, {behind}");
        let report = error(
            codes::LOOSE_END,
            graph.origins.span(junction.origin),
            message,
        );
        diagnostics.warn(report.help(holding(graph, id)));
        is_told = true;
    }
    if !is_told && !warn_of_sources(model, solved, diagnostics) {
        locked::warn(model, solved, diagnostics);
    }
}

/// Warns of effort sources at nodes through which nothing flows, whatever the state, and whose effort nobody asks for; whether
/// there are such.
fn warn_of_sources(model: &Elaborated, solved: &Solved, diagnostics: &mut Diagnostics) -> bool {
    let graph = &model.graph;
    let mut is_told = false;
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
        is_told = true;
    }
    is_told
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
pub(crate) fn is_idle(solved: &Solved, id: ElementId) -> bool {
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
        let (dead, like) = dead(graph, id)?;
        Some(Loose { id, dead, like })
    });
    loose.collect()
}

/// What the only bond of a junction takes out of the model, and the kind of a junction of which as much is zero.
fn dead(graph: &BondGraph, id: JunctionId) -> Option<(String, JunctionKind)> {
    let mut far = graph.across(id);
    let (Some(mut far), None) = (far.next(), far.next()) else {
        return None;
    };
    // Where it is zero, so it is behind a transformer; behind a gyrator the flow is zero for the effort.
    let mut kind = graph.junctions[id.0].kind;
    while let End::In(two_port) | End::Out(two_port) = far {
        kind = behind(&graph.elements[two_port.0].rule, kind)?;
        far = graph.beyond(far)?;
    }
    let dead = match far {
        End::OnePort(element) => {
            let element = &graph.elements[element.0];
            (element.kind == ElementKind::R).then(|| element.name.clone())
        }
        End::Junction(other, _) => {
            let takes_out = kind == JunctionKind::Zero
                || has_law(graph, far)
                || (!graph.junctions[id.0].coordinate && branches(graph, far));
            let other = &graph.junctions[other.0];
            (kind != other.kind && takes_out).then(|| other.name.clone())
        }
        _ => None,
    };
    dead.map(|dead| (dead, kind))
}

/// The kind of a junction of which as much is zero behind a two-port, if all of it is.
fn behind(rule: &Rule, kind: JunctionKind) -> Option<JunctionKind> {
    match (rule, kind) {
        (
            Rule::Transformer {
                invertible: true, ..
            },
            kind,
        ) => Some(kind),
        (
            Rule::Gyrator {
                invertible: true, ..
            },
            JunctionKind::One,
        ) => Some(JunctionKind::Zero),
        (
            Rule::Gyrator {
                invertible: true, ..
            },
            JunctionKind::Zero,
        ) => Some(JunctionKind::One),
        _ => None,
    }
}

/// Whether a storage or a resistor gives the effort or takes the flow of a junction; a 0-junction without one is free to
/// have none, as an axis of a joint is.
fn has_law(graph: &BondGraph, junction: &End) -> bool {
    let End::Junction(id, _) = junction else {
        return false;
    };
    graph.across(*id).any(|far| {
        matches!(far, End::OnePort(element)
            if matches!(graph.elements[element.0].kind, ElementKind::C | ElementKind::R))
    })
}

/// Whether a junction joins two others beside the one that it is told of: a gear does, of which one shaft is loose.
fn branches(graph: &BondGraph, junction: &End) -> bool {
    let End::Junction(id, range) = junction else {
        return false;
    };
    let bonds = graph.bonds.iter();
    let ends = bonds.flat_map(|bond| [&bond.from, &bond.to]);
    let meets = |end: &&End| {
        matches!(end, End::Junction(other, own)
            if other == id && own.start < range.end && range.start < own.end)
    };
    ends.filter(meets).count() > 2
}
