//! What an imposed variable is computed from.
//!
//! Input: a graph with all its strokes. Output: the integral storages, sources and dependent storages from which
//! effort or flow of a bond follows without integration: the ends of its zero-order causal paths (van Dijk &
//! Breedveld 1991). Vector bonds are followed as a whole, so the result may name an element that only another
//! component depends on, and never misses one.

use std::collections::BTreeSet;
use std::ops::Range;

use super::strokes::Stroke;
use crate::graph::{BondGraph, BondId, ElementId, End, JunctionKind, Rule};

/// The elements at the ends of the zero-order causal paths, each in order of declaration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dependence {
    /// Storages in integral causality, whose state matters.
    pub states: BTreeSet<ElementId>,
    /// Sources.
    pub sources: BTreeSet<ElementId>,
    /// Storages in derivative causality, whose rate of change matters.
    pub rates: BTreeSet<ElementId>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Variable {
    Effort,
    Flow,
}

/// What the variable that a one-port receives is computed from.
#[must_use]
pub fn received(graph: &BondGraph, strokes: &[Stroke], element: ElementId) -> Dependence {
    let mut found = Dependence::default();
    let mut seen = BTreeSet::new();
    let ends = Ends::new(graph);
    let mut open: Vec<Signal> = Vec::new();
    for &(bond, side) in &ends.elements[element.0] {
        let effort = strokes[bond.0] == side;
        open.push((
            bond,
            if effort {
                Variable::Effort
            } else {
                Variable::Flow
            },
        ));
    }
    while let Some(signal) = open.pop() {
        if !seen.insert(signal) {
            continue;
        }
        let (bond, variable) = signal;
        match giver(graph, strokes, signal) {
            End::Border => {}
            End::OnePort(id) => one_port(graph, *id, signal, &mut found, &mut open),
            End::In(id) | End::Out(id) => {
                let gyrates = matches!(graph.elements[id.0].rule, Rule::Gyrator { .. });
                let wanted = if gyrates {
                    opposite(variable)
                } else {
                    variable
                };
                let others = ends.elements[id.0]
                    .iter()
                    .filter(|(other, _)| *other != bond);
                open.extend(others.map(|(other, _)| (*other, wanted)));
            }
            End::Junction(id, range) => {
                let kind = graph.junctions[id.0].kind;
                open.extend(junction(
                    kind,
                    range,
                    signal,
                    &ends.junctions[id.0],
                    strokes,
                ));
            }
        }
    }
    found
}

/// The end that imposes a variable: effort comes from the end without the stroke, flow from the end with it.
fn giver<'a>(graph: &'a BondGraph, strokes: &[Stroke], (id, variable): Signal) -> &'a End {
    let bond = &graph.bonds[id.0];
    if (strokes[id.0] == Stroke::To) == (variable == Variable::Flow) {
        &bond.to
    } else {
        &bond.from
    }
}

/// Effort or flow of a bond.
type Signal = (BondId, Variable);

/// What a one-port computes the variable that it gives from: nothing but itself, or the variable that it receives.
fn one_port(
    graph: &BondGraph,
    id: ElementId,
    signal: Signal,
    found: &mut Dependence,
    open: &mut Vec<Signal>,
) {
    let (bond, variable) = signal;
    match graph.elements[id.0].rule {
        Rule::EffortOut | Rule::FlowOut => _ = found.sources.insert(id),
        rule @ (Rule::PreferEffortOut | Rule::PreferFlowOut) => {
            let integral = (rule == Rule::PreferFlowOut) == (variable == Variable::Flow);
            let storages = if integral {
                &mut found.states
            } else {
                &mut found.rates
            };
            storages.insert(id);
        }
        _ => open.push((bond, opposite(variable))),
    }
}

/// What a junction computes a variable from: the common variable from the one bond that imposes it, the other from
/// all other bonds.
fn junction<'a>(
    kind: JunctionKind,
    range: &'a Range<usize>,
    (bond, variable): Signal,
    bonds: &'a [(BondId, Stroke, Range<usize>)],
    strokes: &'a [Stroke],
) -> impl Iterator<Item = Signal> + 'a {
    let common = if kind == JunctionKind::Zero {
        Variable::Effort
    } else {
        Variable::Flow
    };
    let needed = move |(other, side, other_range): &&(BondId, Stroke, Range<usize>)| {
        let overlaps = other_range.start < range.end && range.start < other_range.end;
        let imposes = (strokes[other.0] == *side) == (common == Variable::Effort);
        *other != bond && overlaps && (variable != common || imposes)
    };
    bonds
        .iter()
        .filter(needed)
        .map(move |(other, ..)| (*other, variable))
}

fn opposite(variable: Variable) -> Variable {
    match variable {
        Variable::Effort => Variable::Flow,
        Variable::Flow => Variable::Effort,
    }
}

/// The bonds at each element and junction, with the side at which they end there.
struct Ends {
    elements: Vec<Vec<(BondId, Stroke)>>,
    junctions: Vec<Vec<(BondId, Stroke, Range<usize>)>>,
}

impl Ends {
    fn new(graph: &BondGraph) -> Self {
        let mut ends = Self {
            elements: vec![Vec::new(); graph.elements.len()],
            junctions: vec![Vec::new(); graph.junctions.len()],
        };
        for (index, bond) in graph.bonds.iter().enumerate() {
            for (end, side) in [(&bond.from, Stroke::From), (&bond.to, Stroke::To)] {
                match end {
                    End::OnePort(id) | End::In(id) | End::Out(id) => {
                        ends.elements[id.0].push((BondId(index), side));
                    }
                    End::Junction(id, range) => {
                        ends.junctions[id.0].push((BondId(index), side, range.clone()));
                    }
                    End::Border => {}
                }
            }
        }
        ends
    }
}
