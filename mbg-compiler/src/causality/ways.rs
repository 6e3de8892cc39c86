//! Ways out that rewrite a part of the graph, with the text to type.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::graph::{
    Bond, BondGraph, ElementId, End, JunctionId, JunctionKind, Law, Rule, declaration, instance_of,
    outermost_instance,
};
use crate::symbolic::Expression;

use super::words;

/// What is put between a source and what it acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// A resistor, which leaves what is behind it free.
    Resistor,
    /// The storage of the other kind, which gives what is behind it the variable that the source gave.
    Storage,
}

/// How a source can act without imposing its variable; none for what is no source of the user's, or a ground.
#[must_use]
pub fn through(graph: &BondGraph, id: ElementId, between: Between) -> Option<String> {
    let element = &graph.elements[id.0];
    let is_zero =
        matches!(&element.law, Law::Source(rows) if rows.iter().all(|it| *it == Expression::ZERO));
    let (outer, inner) = match element.rule {
        Rule::FlowOut => (JunctionKind::One, JunctionKind::Zero),
        Rule::EffortOut => (JunctionKind::Zero, JunctionKind::One),
        _ => return None,
    };
    let (word, store) = match (between, element.rule) {
        (Between::Resistor, _) if is_zero || element.instance().is_some() => return None,
        (Between::Resistor, _) => ("resistor", "R resistor { resistance: … }"),
        (Between::Storage, Rule::FlowOut) => ("spring", "C spring { stiffness: … }"),
        (Between::Storage, _) => ("mass", "I mass { inertia: … }"),
    };
    let (far, dimension) = beside(graph, id)?;
    let place = graph.end_name(far);
    let driven = declaration(outer, "driven", dimension);
    let between = declaration(inner, "between", dimension);
    let name = &element.name;
    Some(format!(
        "remove `{name}`, or let it act through a {word}: bond it to `{driven};` and write \
         `{between} {{ {store} }} driven -> between; between -> {place};`"
    ))
}

/// How two sources of the user's at one junction, which impose the same on it, are added up.
#[must_use]
pub fn summed(graph: &BondGraph, sources: &[ElementId]) -> Option<String> {
    let [first, second] = sources else {
        return None;
    };
    let (place, dimension) = beside(graph, *first)?;
    if beside(graph, *second)? != (place, dimension) {
        return None;
    }
    let elements = [first, second].map(|id| &graph.elements[id.0]);
    let (kind, word) = match elements.map(|element| element.rule) {
        [Rule::FlowOut, Rule::FlowOut] => (JunctionKind::Zero, "flow"),
        [Rule::EffortOut, Rule::EffortOut] => (JunctionKind::One, "effort"),
        _ => return None,
    };
    if elements.iter().any(|element| element.instance().is_some()) {
        return None;
    }
    let sum = declaration(kind, &free_name(graph, "sum"), dimension);
    let written = elements.map(|element| {
        let (symbol, name) = (words::symbol(element.kind), &element.name);
        format!("{symbol} {name} {{ {word}: … }}")
    });
    Some(format!(
        "where their {word}s add up: `{sum} {{ {} }} {} -> {};`",
        written.join(" "),
        free_name(graph, "sum"),
        graph.end_name(place)
    ))
}

/// Where the bond of a one-port leads, and its dimension.
#[must_use]
pub fn beside(graph: &BondGraph, id: ElementId) -> Option<(&End, usize)> {
    let own = End::OnePort(id);
    let mut bonds = graph.bonds.iter();
    bonds.find_map(|bond| match bond {
        Bond { from, to, .. } if *from == own => Some((to, bond.dimension)),
        Bond { from, to, .. } if *to == own => Some((from, bond.dimension)),
        _ => None,
    })
}

/// What to do about inertias that depend on each other by the physics: this one moves by itself, behind a compliance.
#[must_use]
pub fn apart(graph: &BondGraph, id: ElementId) -> String {
    let element = &graph.elements[id.0];
    let place = beside(graph, id).filter(|_| element.instance().is_none());
    let Some((far, dimension)) = place else {
        return "give each inertia a junction of its own and put a compliance between them: \
            `a -> between; between -> b; 0 between { C spring { stiffness: … } }`"
            .to_owned();
    };
    let [own, between] =
        [format!("{}_own", element.name), "between".to_owned()].map(|name| free_name(graph, &name));
    let [junction, node] = [(JunctionKind::One, &own), (JunctionKind::Zero, &between)]
        .map(|(kind, name)| declaration(kind, name, dimension));
    let (symbol, name, place) = (
        words::symbol(element.kind),
        &element.name,
        graph.end_name(far),
    );
    format!(
        "give `{name}` a junction of its own and put a compliance between: in the place of `{symbol} {name}` write \
         `{junction} {{ {symbol} {name} {{ … }} }} {node} {{ C spring {{ stiffness: … }} }} {place} -> {between}; {between} -> {own};`"
    )
}

/// How a transformer without an inverse is written whose matrix was meant for the efforts.
#[must_use]
pub fn turned(graph: &BondGraph, id: ElementId) -> Option<String> {
    let element = &graph.elements[id.0];
    let Rule::Transformer { rows, columns, .. } = element.rule else {
        return None;
    };
    if rows == columns || element.instance().is_some() {
        return None;
    }
    let before = graph.bonds.iter().find(|bond| bond.to == End::In(id))?;
    let after = graph.bonds.iter().find(|bond| bond.from == End::Out(id))?;
    let [before, after] = [&before.from, &after.to].map(|end| graph.end_name(end));
    let (kind, name) = (words::symbol(element.kind), &element.name);
    Some(format!(
        "where its matrix takes the effort of `{before}` to that of `{after}`, turn it round: \
         `{after} -> {kind} {name} {{ flow: -transpose(…) }} -> {before};`"
    ))
}

/// A source that holds what the bonds at a junction have in common.
#[must_use]
pub fn hold(graph: &BondGraph, id: JunctionId, range: Range<usize>) -> String {
    let (symbol, word, field) = match graph.junctions[id.0].kind {
        JunctionKind::Zero => ("Se", "earth", "effort"),
        JunctionKind::One => ("Sf", "wall", "flow"),
    };
    let size = match range.len() {
        1 => String::new(),
        size => format!("[{size}]"),
    };
    let source = free_name(graph, word);
    let place = graph.end_name(&End::Junction(id, range));
    format!("`{symbol} {source}{size} {{ {field}: 0.0 }} -> {place};`")
}

/// Whether a 1-junction has no elements of its own and leads into one component in use alone.
#[must_use]
pub fn is_bare(graph: &BondGraph, id: JunctionId) -> bool {
    let junction = &graph.junctions[id.0];
    let own = instance_of(&junction.name);
    let neighbours: Option<Vec<&str>> = graph
        .across(id)
        .map(|far| match far {
            End::OnePort(_) | End::Border => None,
            End::In(id) | End::Out(id) => Some(graph.elements[id.0].name.as_str()),
            End::Junction(other, _) => Some(graph.junctions[other.0].name.as_str()),
        })
        .collect();
    let users = neighbours.map(|names| {
        let users = names.into_iter();
        users
            .filter_map(|name| outermost_instance(name, own))
            .collect()
    });
    junction.kind == JunctionKind::One
        && users.is_some_and(|users: BTreeSet<&str>| users.len() == 1)
}

/// What to do about a frame that nothing holds.
#[must_use]
pub fn held_or_heavy(graph: &BondGraph, frame: JunctionId) -> [String; 2] {
    let source = hold(graph, frame, 0..graph.junctions[frame.0].dimension);
    [
        format!("hold it, if it is at rest: {source}"),
        "give it an inertia, such as a body, if it moves by itself".to_owned(),
    ]
}

/// A name for a source that nothing has yet.
fn free_name(graph: &BondGraph, word: &str) -> String {
    let is_taken = |name: &str| {
        let junctions = graph.junctions.iter().map(|it| &it.name);
        let mut names = junctions.chain(graph.elements.iter().map(|it| &it.name));
        names.any(|known| known == name)
    };
    let numbered = (2..).map(|number| format!("{word}{number}"));
    let mut names = std::iter::once(word.to_owned()).chain(numbered);
    names
        .find(|name| !is_taken(name))
        .unwrap_or_else(|| word.to_owned())
}
