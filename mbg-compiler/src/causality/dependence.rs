//! What an imposed variable is computed from.
//!
//! Input: a graph with all its strokes. Output: the integral storages, sources and dependent storages from which
//! effort or flow of a bond follows without integration: the ends of its zero-order causal paths (van Dijk &
//! Breedveld 1991). Vector bonds are followed as a whole, so the result may name an element that only another
//! component depends on, and never misses one.

use std::collections::BTreeSet;

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
    let mut open = Vec::new();
    let ends = Ends::new(graph);
    for &(bond, side) in &ends.elements[element.0] {
        let variable = if strokes[bond.0] == side { Variable::Effort } else { Variable::Flow };
        open.push((bond, variable));
    }
    while let Some((bond, variable)) = open.pop() {
        if !seen.insert((bond, variable)) {
            continue;
        }
        // Effort comes from the end without the stroke, flow from the end with it.
        let stroke = strokes[bond.0];
        let giver = if variable == Variable::Effort { stroke.opposite() } else { stroke };
        let end = match giver {
            Stroke::From => &graph.bonds[bond.0].from,
            Stroke::To => &graph.bonds[bond.0].to,
        };
        match end {
            End::Border => {}
            End::OnePort(id) => match graph.elements[id.0].rule {
                Rule::EffortOut | Rule::FlowOut => _ = found.sources.insert(*id),
                Rule::PreferEffortOut | Rule::PreferFlowOut => {
                    let integral = (graph.elements[id.0].rule == Rule::PreferFlowOut) == (variable == Variable::Flow);
                    _ = if integral { found.states.insert(*id) } else { found.rates.insert(*id) };
                }
                _ => open.push((bond, opposite(variable))),
            },
            End::In(id) | End::Out(id) => {
                let gyrates = matches!(graph.elements[id.0].rule, Rule::Gyrator { .. });
                let wanted = if gyrates { opposite(variable) } else { variable };
                let others = ends.elements[id.0].iter().filter(|(other, _)| *other != bond);
                open.extend(others.map(|(other, _)| (*other, wanted)));
            }
            End::Junction(id, range) => {
                let common = match graph.junctions[id.0].kind {
                    JunctionKind::Zero => Variable::Effort,
                    JunctionKind::One => Variable::Flow,
                };
                for (other, side, other_range) in &ends.junctions[id.0] {
                    let overlaps = other_range.start < range.end && range.start < other_range.end;
                    // The common variable comes from the one bond that imposes it, the other is a sum.
                    let imposes = (strokes[other.0] == *side) == (common == Variable::Effort);
                    if *other != bond && overlaps && (variable != common || imposes) {
                        open.push((*other, variable));
                    }
                }
            }
        }
    }
    found
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
    junctions: Vec<Vec<(BondId, Stroke, std::ops::Range<usize>)>>,
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
