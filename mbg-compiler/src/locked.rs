//! Inertias that cannot move though nothing is held: those between gears whose ratios contradict each other.

use std::collections::BTreeSet;

use crate::codes;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::elaborate::Elaborated;
use crate::graph::{BondGraph, ElementId, ElementKind, End, JunctionId, JunctionKind, Law};
use crate::loose::is_idle;
use crate::structure::Solved;
use crate::symbolic::Expression;

/// Junctions that bonds and two-ports join.
#[derive(Default)]
struct Part {
    junctions: BTreeSet<JunctionId>,
    one_ports: BTreeSet<ElementId>,
    /// Those between 1-junctions at which nothing flows.
    two_ports: BTreeSet<ElementId>,
    /// Whether something may hold it on purpose: a source, a node that is open, a loop.
    is_held: bool,
}

/// Warns of those whose flow is zero whatever acts on them.
pub(crate) fn warn(model: &Elaborated, solved: &Solved, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    let mut seen: BTreeSet<JunctionId> = BTreeSet::new();
    for junction in (0..graph.junctions.len()).map(JunctionId) {
        if seen.contains(&junction) {
            continue;
        }
        let part = part(graph, solved, junction);
        seen.extend(&part.junctions);
        let is_locked = |id: &&ElementId| {
            let element = &graph.elements[id.0];
            element.kind == ElementKind::I
                && is_idle(solved, **id)
                && !element.own_name().starts_with('_')
        };
        let locked: Vec<&ElementId> = part.one_ports.iter().filter(is_locked).collect();
        let Some(first) = locked.first().filter(|_| !part.is_held) else {
            continue;
        };
        let name = |id: &ElementId| graph.elements[id.0].name.clone();
        let names = listing(locked.iter().map(|id| name(id)));
        let message = format!("the flow of {names} is zero, whatever acts there");
        let span = graph.origins.span(graph.elements[first.0].origin);
        let report = error(codes::NO_EFFECT, span, message);
        diagnostics.warn(match part.two_ports.len() {
            0 | 1 => report,
            _ => report.help(format!(
                "{} hold each other where their ratios contradict each other: leave one of them out",
                listing(part.two_ports.iter().map(name))
            )),
        });
    }
}

/// What a junction is joined with.
fn part(graph: &BondGraph, solved: &Solved, first: JunctionId) -> Part {
    let mut part = Part::default();
    let mut open = vec![first];
    while let Some(id) = open.pop() {
        if !part.junctions.insert(id) {
            continue;
        }
        let mut bonds = 0;
        for mut far in graph.across(id) {
            bonds += 1;
            let mut passed = Vec::new();
            while let End::In(two_port) | End::Out(two_port) = far {
                passed.push(*two_port);
                let Some(next) = graph.beyond(far) else { break };
                far = next;
            }
            match far {
                End::Junction(other, _) => {
                    if [id, *other].iter().all(|it| is_still(graph, solved, *it)) {
                        part.two_ports.extend(passed);
                    }
                    open.push(*other);
                }
                End::OnePort(element) => {
                    part.one_ports.insert(*element);
                    part.is_held |= holds(graph, *element);
                }
                End::In(_) | End::Out(_) => {}
                End::Border => part.is_held = true,
            }
        }
        part.is_held |= bonds == 1 && graph.junctions[id.0].kind == JunctionKind::Zero;
    }
    part
}

/// Whether the flow of a 1-junction is zero whatever the state.
fn is_still(graph: &BondGraph, solved: &Solved, id: JunctionId) -> bool {
    let mut flows = solved.scalars.common[id.0].iter();
    graph.junctions[id.0].kind == JunctionKind::One
        && flows.all(|flow| solved.solution.values[*flow] == Expression::ZERO)
}

/// Whether a source says that a flow is zero.
fn holds(graph: &BondGraph, id: ElementId) -> bool {
    let element = &graph.elements[id.0];
    let is_zero = |flows: &[Expression]| flows.contains(&Expression::ZERO);
    element.kind == ElementKind::Sf && matches!(&element.law, Law::Source(flows) if is_zero(flows))
}
