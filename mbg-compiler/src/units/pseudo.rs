//! Pseudo bonds that are drawn as true ones: temperature times heat flow is no power, so that their units come out
//! wrong by powers of a kelvin.

use std::collections::BTreeSet;

use super::dimension::Dimension;
use crate::diagnostics::listing;
use crate::elaborate::claims::{Claim, Claims, Subject};
use crate::elaborate::{Elaborated, Place, StateRate};
use crate::graph::{BondGraph, ElementId, End, JunctionId, OriginId};
use crate::symbolic::{Operation, Pool, Symbol};

/// Whether two units, or what they are but for others, differ as temperature and heat flow make them.
pub(super) fn is_thermal([left, right]: [&Dimension; 2]) -> bool {
    right.over(left).is_power_of_kelvin()
}

/// What to type where effort times flow is no power at junctions and at those bonded to them; none where all are marked.
pub(super) fn advice(graph: &BondGraph, junctions: &[JunctionId]) -> Option<String> {
    let reached = joined(graph, junctions);
    let written = reached.iter().map(|id| {
        let junction = &graph.junctions[id.0];
        format!("{} pseudo", junction.declaration(junction.kind))
    });
    // A junction in a loop or in a component is written once, however many there are.
    let mut seen = BTreeSet::new();
    let written = listing(written.filter(|it| seen.insert(it.clone())));
    (!reached.is_empty()).then(|| {
        format!(
            "write {written} where effort times flow is no power, as temperature times heat flow"
        )
    })
}

/// Junctions and those bonded to them, without those that are marked.
pub(super) fn joined(graph: &BondGraph, junctions: &[JunctionId]) -> Vec<JunctionId> {
    let mut reached: Vec<JunctionId> = Vec::new();
    let mut open = junctions.to_vec();
    while let Some(id) = open.pop() {
        if graph.junctions[id.0].pseudo || reached.contains(&id) {
            continue;
        }
        reached.push(id);
        for bond in &graph.bonds {
            if let (End::Junction(from, _), End::Junction(to, _)) = (&bond.from, &bond.to)
                && [from, to].contains(&&id)
            {
                open.extend([*from, *to]);
            }
        }
    }
    reached.sort_unstable();
    reached
}

/// The junctions at both ends of what has an origin.
pub(super) fn ends(graph: &BondGraph, origin: OriginId) -> Vec<JunctionId> {
    let bonds = graph.bonds.iter().filter(|bond| bond.origin == origin);
    let ends = bonds.flat_map(|bond| [&bond.from, &bond.to]);
    ends.filter_map(junction).collect()
}

/// The junctions that a claim is about.
pub(super) fn places(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    claim: &Claim,
) -> Vec<JunctionId> {
    let graph = &model.graph;
    match &claim.subject {
        Subject::Word(id, _) => around(graph, *id),
        Subject::Start(states) | Subject::Rate(states) => {
            let storages = model.states[states.clone()].iter();
            let storages = storages.filter_map(|state| match state.rate {
                StateRate::Storage(id, _) => Some(id),
                _ => None,
            });
            storages.flat_map(|id| around(graph, id)).collect()
        }
        Subject::Declared(..) => {
            let read = claim
                .entries
                .iter()
                .filter_map(|it| match pool.operation(*it) {
                    Operation::Symbol(Symbol::Signal(number)) => {
                        Some(claims.signals.list()[*number].1)
                    }
                    _ => None,
                });
            let read = read.flat_map(|place| match place {
                Place::Junction(id) => vec![id],
                Place::Port(id) => around(graph, id),
            });
            read.collect()
        }
        _ => Vec::new(),
    }
}

/// The junctions to which an element is bonded.
pub(super) fn around(graph: &BondGraph, id: ElementId) -> Vec<JunctionId> {
    let own = |end: &End| matches!(end, End::OnePort(other) | End::In(other) | End::Out(other) if *other == id);
    let bonds = graph.bonds.iter().filter_map(|bond| match bond {
        bond if own(&bond.from) => junction(&bond.to),
        bond if own(&bond.to) => junction(&bond.from),
        _ => None,
    });
    bonds.collect()
}

fn junction(end: &End) -> Option<JunctionId> {
    match end {
        End::Junction(id, _) => Some(*id),
        _ => None,
    }
}
