//! Random small vector graphs against brute force over all strokes.

use std::collections::BTreeSet;

use proptest::prelude::*;
use proptest::strategy::Union;

use super::enumerate::{Options, enumerate};
use super::fixtures::Builder;
use super::outlook::Outlook;
use super::strokes::Stroke;
use super::uniform::verdict;
use crate::graph::{BondGraph, ElementId, ElementKind, End, JunctionKind, Rule};

/// Effort enters each end of each bond, or does not.
fn enters(strokes: &[Stroke], bond: usize, side: Stroke) -> bool {
    strokes[bond] == side
}

/// The rules of causality, stated a second time and component by component.
fn admissible(graph: &BondGraph, strokes: &[Stroke]) -> bool {
    let mut ends = Vec::new();
    for (index, bond) in graph.bonds.iter().enumerate() {
        ends.push((&bond.from, enters(strokes, index, Stroke::From)));
        ends.push((&bond.to, enters(strokes, index, Stroke::To)));
    }
    for (id, junction) in graph.junctions.iter().enumerate() {
        for component in 0..junction.dimension {
            let efforts: Vec<bool> = ends
                .iter()
                .filter(|(end, _)| matches!(end, End::Junction(j, range) if j.0 == id && range.contains(&component)))
                .map(|(_, effort)| *effort)
                .collect();
            let wanted = junction.kind == JunctionKind::Zero;
            if efforts.iter().filter(|effort| **effort == wanted).count() != 1 {
                return false;
            }
        }
    }
    graph.elements.iter().enumerate().all(|(id, element)| {
        let at = |wanted: End| {
            ends.iter()
                .filter(move |(end, _)| **end == wanted)
                .map(|(_, effort)| *effort)
        };
        let id = ElementId(id);
        let mut port = at(End::OnePort(id));
        let (input, output) = (at(End::In(id)).next(), at(End::Out(id)).next());
        match element.rule {
            Rule::EffortOut | Rule::ResistanceOnly | Rule::Gyroscopic => port.all(|effort| !effort),
            Rule::FlowOut | Rule::ConductanceOnly => port.all(|effort| effort),
            Rule::Transformer { invertible, .. } => {
                input != output && (invertible || input == Some(false))
            }
            Rule::Gyrator { invertible, .. } => {
                input == output && (invertible || input == Some(false))
            }
            _ => true,
        }
    })
}

/// All and unmarked dependent storages.
fn cost(graph: &BondGraph, strokes: &[Stroke]) -> (usize, usize) {
    let mut cost = (0, 0);
    for (index, bond) in graph.bonds.iter().enumerate() {
        for (end, side) in [(&bond.from, Stroke::From), (&bond.to, Stroke::To)] {
            let End::OnePort(id) = end else { continue };
            let element = &graph.elements[id.0];
            let effort = enters(strokes, index, side);
            let dependent = match element.kind {
                ElementKind::I => !effort,
                ElementKind::C => effort,
                _ => false,
            };
            cost.0 += usize::from(dependent);
            cost.1 += usize::from(dependent && !element.derivative);
        }
    }
    cost
}

fn brute_force(graph: &BondGraph) -> BTreeSet<Vec<Stroke>> {
    let bonds = graph.bonds.len();
    let strokes = |bits: usize| -> Vec<Stroke> {
        (0..bonds)
            .map(|bond| {
                if bits >> bond & 1 == 1 {
                    Stroke::To
                } else {
                    Stroke::From
                }
            })
            .collect()
    };
    (0..1_usize << bonds)
        .map(strokes)
        .filter(|strokes| admissible(graph, strokes))
        .collect()
}

/// What a random graph is made of: numbers that the builder takes modulo what is there.
#[derive(Clone, Debug)]
struct Recipe {
    junctions: Vec<(bool, usize)>,
    links: Vec<(usize, usize, usize, bool)>,
    ports: Vec<(usize, usize, usize, bool)>,
}

fn recipe() -> impl Strategy<Value = Recipe> {
    let junctions = prop::collection::vec((any::<bool>(), 1..4_usize), 1..5);
    let links = prop::collection::vec((0..5_usize, 0..5_usize, 0..8_usize, any::<bool>()), 0..4);
    let wanted: Vec<(u32, BoxedStrategy<usize>)> =
        vec![(6, (0..4_usize).boxed()), (2, (4..9_usize).boxed())];
    let ports = prop::collection::vec(
        (
            Union::new_weighted(wanted),
            0..5_usize,
            0..6_usize,
            any::<bool>(),
        ),
        1..7,
    );
    (junctions, links, ports).prop_map(|(junctions, links, ports)| Recipe {
        junctions,
        links,
        ports,
    })
}

const RULES: [Rule; 9] = [
    Rule::PreferFlowOut,
    Rule::PreferFlowOut,
    Rule::PreferEffortOut,
    Rule::Either,
    Rule::EffortOut,
    Rule::FlowOut,
    Rule::ResistanceOnly,
    Rule::ConductanceOnly,
    Rule::Gyroscopic,
];

/// The whole junction or some of its components.
fn some(builder: &Builder, junction: usize, choice: usize) -> End {
    let dimension = builder.graph.junctions[junction].dimension;
    let range = match choice % 3 {
        0 => 0..dimension,
        1 => 0..dimension.div_ceil(2),
        _ => dimension / 2..dimension,
    };
    End::Junction(crate::graph::JunctionId(junction), range)
}

fn build(recipe: &Recipe) -> BondGraph {
    let mut builder = Builder::new();
    for (index, (zero, dimension)) in recipe.junctions.iter().enumerate() {
        let kind = if *zero {
            JunctionKind::Zero
        } else {
            JunctionKind::One
        };
        builder.junction(kind, &format!("j{index}"), *dimension);
    }
    let count = recipe.junctions.len();
    // A tree first, so that graphs hang together, then what the recipe adds.
    let tree = (1..count).map(|to| (to - 1, to, recipe.junctions[to].1, true));
    for (index, (from, to, choice, invertible)) in
        tree.chain(recipe.links.iter().copied()).enumerate()
    {
        let (from, to) = (
            some(&builder, from % count, choice),
            some(&builder, to % count, choice / 2),
        );
        let name = format!("t{index}");
        match choice % 4 {
            0 | 1 => _ = builder.bond(from, to),
            2 => _ = builder.transformer(&name, if invertible { (3, 3) } else { (3, 1) }, from, to),
            _ => {
                let rule = Rule::Gyrator {
                    rows: 3,
                    columns: 3,
                    invertible,
                };
                let id = builder.element(ElementKind::MGY, &name, rule);
                builder.bond(from, End::In(id));
                builder.bond(End::Out(id), to);
            }
        }
    }
    for (index, (rule, junction, choice, marked)) in recipe.ports.iter().enumerate() {
        let end = some(&builder, junction % count, *choice);
        let id = builder.port(&format!("e{index}"), RULES[*rule], end);
        builder.graph.elements[id.0].derivative = *marked;
    }
    builder.graph
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_verdict_is_as_good_as_brute_force(recipe in recipe()) {
        let graph = build(&recipe);
        prop_assume!(graph.bonds.len() <= 14);
        let all = brute_force(&graph);
        let least = all.iter().map(|strokes| cost(&graph, strokes)).min();
        match verdict(&graph) {
            Ok(verdict) => {
                prop_assert!(verdict.proven_optimal);
                prop_assert!(admissible(&graph, &verdict.strokes));
                prop_assert_eq!(Some(cost(&graph, &verdict.strokes)), least);
                prop_assert_eq!(Some(verdict.dependent.len()), least.map(|cost| cost.0));
                let again = super::uniform::verdict(&graph).expect("as before");
                prop_assert_eq!(again.record, verdict.record);
            }
            Err(conflict) => {
                prop_assert_eq!(least, None);
                prop_assert!(conflict.proven());
            }
        }
    }

    #[test]
    fn enumeration_is_brute_force(recipe in recipe()) {
        let graph = build(&recipe);
        prop_assume!(graph.bonds.len() <= 12);
        let found = enumerate(&graph, &Options::default());
        prop_assert!(found.complete);
        let strokes: Vec<Vec<Stroke>> = found.assignments.into_iter().map(|assignment| assignment.strokes).collect();
        let count = strokes.len();
        let set: BTreeSet<Vec<Stroke>> = strokes.into_iter().collect();
        prop_assert_eq!(set.len(), count);
        prop_assert_eq!(set, brute_force(&graph));
    }

    #[test]
    fn every_rejection_is_reported_once_per_element(recipe in recipe()) {
        let graph = build(&recipe);
        let mut diagnostics = crate::diagnostics::Diagnostics::new();
        match verdict(&graph) {
            Ok(verdict) => {
                super::report::diagnose(&graph, &verdict, &Outlook::Soluble, &mut diagnostics);
                let rejected = verdict.dependent.iter().filter(|id| !graph.elements[id.0].derivative).count();
                prop_assert_eq!(rejected > 0, diagnostics.any());
                prop_assert!(diagnostics.list().len() <= graph.elements.len());
            }
            Err(conflict) => {
                super::report::conflict_diagnostics(&graph, &conflict, &Outlook::Soluble, &mut diagnostics);
                prop_assert!(diagnostics.any());
            }
        }
    }
}
