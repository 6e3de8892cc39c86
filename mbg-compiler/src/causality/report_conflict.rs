//! A conflict as diagnostics.
//!
//! As with [dependent storages](super::report), the element to blame gets the whole chain and the ways out, and each
//! other element that takes part its own steps.

use super::conflict::Conflict;
use super::explain;
use super::outlook::Outlook;
use super::report::{
    COMPONENTWISE, JACOBIAN, alternatives, may_be_rewritten, own_steps, resistor_help,
};
use super::strokes::Site;
use super::ways::{Between, held_or_heavy, hold, is_bare, summed, through, turned};
use super::words;
use crate::codes;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::graph::{
    BondGraph, ElementId, End, JunctionId, JunctionKind, OriginId, Rule, instance_of,
};

/// Reports a conflict where the rules fail or at the element to blame, then at each fixed element that takes part.
pub fn conflict_diagnostics(
    graph: &BondGraph,
    conflict: &Conflict,
    outlook: &Outlook,
    diagnostics: &mut Diagnostics,
) {
    let Some(first) = origin(graph, conflict) else {
        return;
    };
    let mut report = error(
        conflict.code,
        graph.origins.span(first),
        message(graph, conflict),
    );
    let steps = conflict.chain.iter();
    report.notes = steps.map(|step| step.text.clone()).collect();
    report.helps = alternatives(helps(graph, conflict, outlook));
    diagnostics.report(report);
    for id in conflict.elements() {
        let element = &graph.elements[id.0];
        if element.origin != first {
            let kind = words::kind_name(graph, id);
            let message = format!(
                "{kind} `{}` takes part in the conflict{}",
                element.name,
                place(graph, conflict)
            );
            let mut report = error(conflict.code, graph.origins.span(element.origin), message);
            report.notes = own_steps(graph, id, &conflict.chain, graph.origins.path(first));
            diagnostics.report(report);
        }
    }
}

/// Where the whole chain is told.
fn origin(graph: &BondGraph, conflict: &Conflict) -> Option<OriginId> {
    if let (Some(End::Junction(id, _)), codes::NO_ASSIGNMENT) = (conflict.place(), conflict.code) {
        return Some(graph.junctions[id.0].origin);
    }
    if let Some(id) = conflict.elements().first() {
        return Some(graph.elements[id.0].origin);
    }
    // No fixed element and no junction: two-ports in a ring, or a search that gave up.
    let bonds = conflict.bonds.iter().map(|id| graph.bonds[id.0].origin);
    let junctions = graph.junctions.iter().map(|junction| junction.origin);
    let all = graph.bonds.iter().map(|bond| bond.origin);
    bonds.chain(junctions).chain(all).next()
}

/// ` at `joint``, where there is a place.
fn place(graph: &BondGraph, conflict: &Conflict) -> String {
    let at = |end: End| format!(" at `{}`", graph.end_name(&end));
    conflict.place().map_or_else(String::new, at)
}

fn message(graph: &BondGraph, conflict: &Conflict) -> String {
    if !conflict.proven() {
        return "no assignment of strokes was found before the search reached its limit".to_owned();
    }
    let place = place(graph, conflict);
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

fn helps(graph: &BondGraph, conflict: &Conflict, outlook: &Outlook) -> Vec<String> {
    if !conflict.proven() {
        return vec![COMPONENTWISE.to_owned()];
    }
    if let Some(frame) = bare_frame(graph, conflict) {
        let componentwise = outlook.is_soluble().then(|| COMPONENTWISE.to_owned());
        let ways = held_or_heavy(graph, frame).into_iter();
        return ways.chain(componentwise).collect();
    }
    let elements = conflict.elements();
    let mut helps = Vec::new();
    if conflict.code == codes::FIXED_RESISTOR {
        helps.extend(holding(graph, conflict));
        if outlook.is_soluble() {
            helps.push(COMPONENTWISE.to_owned());
        }
    }
    let laws = elements
        .iter()
        .filter(|id| may_be_rewritten(graph, **id, outlook));
    helps.extend(laws.filter_map(|id| resistor_help(graph, *id)));
    let end = conflict.place();
    let place = end
        .as_ref()
        .map_or_else(|| "junction".to_owned(), |end| graph.end_name(end));
    let uneven = match (conflict.code, &end) {
        (codes::NO_ASSIGNMENT, Some(place)) => storage_over(graph, place),
        _ => None,
    };
    if let Some(storage) = uneven {
        helps.extend(outlook.componentwise(&graph.elements[storage.0]));
        helps.extend(imposing(graph, &elements));
        return helps;
    }
    let imposed = match conflict.code {
        codes::RECTANGULAR_INVERSE => imposing(graph, &elements),
        _ => None,
    };
    let behind_source = usize::from(imposed.is_some());
    // Beside a source nothing can give what it imposes.
    let end = without_source(graph, conflict).or(end);
    let place = end.as_ref().map_or(place, |end| graph.end_name(end));
    helps.push(imposed.unwrap_or_else(|| match (conflict.code, end) {
        (codes::SOURCES_CONFLICT, _) => format!("remove one of {}", names(graph, &elements)),
        (codes::GYROSCOPIC_INVERSE, _) => {
            format!("give `{place}` its flow from an inertia: `{place} -> I rotor {{ inertia: … }};`")
        }
        (_, Some(End::Junction(id, _))) if graph.junctions[id.0].kind == JunctionKind::Zero => {
            format!("attach a resistor that can give the effort: `{place} -> R damper {{ resistance: … }};`")
        }
        _ => format!("attach a resistor that can give the flow: `{place} -> R damper {{ conductance: … }};`"),
    }));
    if conflict.code == codes::SOURCES_CONFLICT {
        helps.extend(summed(graph, &elements));
    }
    if conflict.code == codes::RECTANGULAR_INVERSE {
        helps.extend(elements.iter().find_map(|id| turned(graph, *id)));
    }
    if outlook.is_soluble() && conflict.code != codes::FIXED_RESISTOR {
        helps.push(COMPONENTWISE.to_owned());
    }
    if outlook.is_acceptable() && accepts_dependence(graph) {
        helps.insert(behind_source, COMPONENTWISE.to_owned());
    }
    if explain::blocks_axes(graph, &elements) {
        helps.push(JACOBIAN.to_owned());
    }
    helps
}

/// Whether every storage may follow from others, as under a model's `#[derivative]`.
fn accepts_dependence(graph: &BondGraph) -> bool {
    let mut storages = graph.elements.iter().filter(|it| it.has_states());
    storages.all(|storage| storage.derivative)
}

/// The frame that nothing holds, where the conflict is that no bond gives it its flow.
fn bare_frame(graph: &BondGraph, conflict: &Conflict) -> Option<JunctionId> {
    match (conflict.code, conflict.place()) {
        (codes::NO_ASSIGNMENT, Some(End::Junction(id, _))) if is_bare(graph, id) => Some(id),
        _ => None,
    }
}

/// A source at the first node of a conflict that may lack one, such as a tank between a pump and a valve.
fn holding(graph: &BondGraph, conflict: &Conflict) -> Option<String> {
    let mut sites = conflict.sites.iter();
    sites.find_map(|site| match site {
        Site::Junction(id, components) if joins_components(graph, *id) => {
            let name = &graph.junctions[id.0].name;
            let source = hold(graph, *id, components.clone());
            Some(format!(
                "hold `{name}`, where it is a ground or a tank: {source}"
            ))
        }
        _ => None,
    })
}

/// Whether a junction is a node of the model itself that has components around it and nothing else.
fn joins_components(graph: &BondGraph, id: JunctionId) -> bool {
    let junction = &graph.junctions[id.0];
    let mut far = graph.across(id).map(|far| graph.end_name(far));
    let is_node = junction.kind == JunctionKind::Zero && junction.dimension == 1;
    is_node && instance_of(&junction.name).is_none() && far.all(|far| instance_of(&far).is_some())
}

/// The first junction of a conflict at which a resistor more gives what the laws of others take, and no source gives it.
fn without_source(graph: &BondGraph, conflict: &Conflict) -> Option<End> {
    let rules = conflict
        .elements()
        .into_iter()
        .map(|id| graph.elements[id.0].rule);
    let wanted = rules.into_iter().find_map(|rule| match rule {
        Rule::ResistanceOnly => Some(JunctionKind::One),
        Rule::ConductanceOnly => Some(JunctionKind::Zero),
        _ => None,
    })?;
    let is_source = |end: &End| match end {
        End::OnePort(id) => matches!(graph.elements[id.0].rule, Rule::EffortOut | Rule::FlowOut),
        _ => false,
    };
    conflict.sites.iter().find_map(|site| match site {
        Site::Junction(id, components)
            if graph.junctions[id.0].kind == wanted && !graph.across(*id).any(is_source) =>
        {
            Some(End::Junction(*id, components.clone()))
        }
        _ => None,
    })
}

/// A storage that would give a place what it lacks, but not with one stroke: elsewhere on its bond that is imposed.
fn storage_over(graph: &BondGraph, place: &End) -> Option<ElementId> {
    let End::Junction(junction, components) = place else {
        return None;
    };
    let gives = match graph.junctions[junction.0].kind {
        JunctionKind::Zero => Rule::PreferEffortOut,
        JunctionKind::One => Rule::PreferFlowOut,
    };
    let covers = |end: &End| matches!(end, End::Junction(id, range) if id == junction && range.contains(&components.start));
    graph.bonds.iter().find_map(|bond| {
        let element = match (&bond.from, &bond.to) {
            (other, End::OnePort(id)) | (End::OnePort(id), other) if covers(other) => *id,
            _ => return None,
        };
        (graph.elements[element.0].rule == gives).then_some(element)
    })
}

/// Where a source imposes what a storage would give: how it can act without imposing it.
fn imposing(graph: &BondGraph, elements: &[ElementId]) -> Option<String> {
    let mut elements = elements.iter();
    elements.find_map(|id| through(graph, *id, Between::Storage))
}
