//! Random models with `#[derivative]`: as many states are lost as the rank says, and what the program tells of every
//! port satisfies every equation of the graph.
//!
//! The program is taken at its word: efforts, flows and states of all ports are its outputs, and their time derivatives
//! those along the rates that it returns, by dual numbers. They must obey the laws of the elements, each lost storage
//! must change by its own effort or flow, and there must be efforts and flows of the inner bonds that satisfy the
//! junctions and two-ports. Since no state is lost without need, nothing else does.

mod models;
mod reduction {
    pub(crate) mod dual;
    pub(crate) mod graph;
    pub(crate) mod truth;
}

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use reduction::graph::{Entry, Graph, Kind, Law, Link};
use reduction::truth;

fn law(number: usize, inertia: bool, diagonal: i64, coupling: i64) -> Law {
    match number {
        0..4 => Law::Inverse { diagonal, coupling },
        4..7 if !inertia => Law::Direct { diagonal, coupling },
        7 => Law::Cubic { factor: diagonal },
        _ => Law::Affine {
            factor: diagonal,
            offset: coupling,
        },
    }
}

fn entry(kind: usize, value: i64, variable: usize, variables: usize) -> Entry {
    match kind {
        0..3 => Entry::Whole(value),
        3 => Entry::Shifted(value, variable % variables),
        4 => Entry::Sine(variable % variables),
        _ => Entry::Cosine(variable % variables),
    }
}

/// The part of two junctions that a bond joins: where it begins in each, and its dimension.
fn place(graph: &Graph, junction: usize, start: usize, count: usize) -> (usize, usize, usize) {
    let dimension = graph.dimension(junction);
    let start = start % dimension;
    (
        junction,
        start,
        (1 + count % dimension).min(dimension - start),
    )
}

type PortSeed = (
    (usize, usize, usize),
    (usize, usize),
    (i64, i64),
    bool,
    (usize, usize),
);
type LinkSeed = (
    (usize, usize),
    (usize, usize),
    (usize, usize),
    usize,
    Vec<(usize, i64, usize)>,
);

fn add_port(graph: &mut Graph, junctions: usize, seed: PortSeed) {
    let ((at, start, count), (kind, number), (diagonal, coupling), outward, (form, variable)) =
        seed;
    let place = place(graph, at % junctions, start, count);
    // Sources know time and the input only.
    let drive = entry(form, diagonal, variable, 2);
    let kind = match kind {
        0..4 => Kind::Inertia(law(number, true, diagonal, coupling)),
        4..7 => Kind::Compliance(law(number, false, diagonal, coupling)),
        7..9 => Kind::Resistor(diagonal),
        9 => Kind::Effort(drive),
        _ => Kind::Flow(drive),
    };
    graph.port(place, kind, outward);
}

fn add_link(graph: &mut Graph, (from, to): (usize, usize), seed: LinkSeed) {
    let (_, (start, count), (other, width), kind, entries) = seed;
    let left = place(graph, from, start, count);
    let right = place(graph, to, other, width);
    let kind = match kind {
        0..3 => Link::Bond,
        3..6 => Link::Transformer,
        _ => Link::Gyrator,
    };
    if kind == Link::Bond {
        let count = left.2.min(right.2);
        graph.link(
            kind,
            (left.0, left.1, count),
            (right.0, right.1, count),
            &[],
        );
        return;
    }
    let variables = graph.variables.len();
    let entries: Vec<Entry> = entries[..left.2 * right.2]
        .iter()
        .map(|(form, value, variable)| entry(*form, *value, *variable, variables))
        .collect();
    graph.link(kind, left, right, &entries);
}

fn graph() -> impl Strategy<Value = Graph> {
    let junctions = prop::collection::vec((any::<bool>(), 1..4_usize, any::<bool>()), 2..6);
    let port = (
        (0..6_usize, 0..3_usize, 0..3_usize),
        (0..11_usize, 0..8_usize),
        (2..5_i64, 0..2_i64),
        any::<bool>(),
        (0..6_usize, 0..6_usize),
    );
    let coefficient = (0..6_usize, -3..4_i64, 0..64_usize);
    let link = (
        (0..6_usize, 1..6_usize),
        (0..3_usize, 0..3_usize),
        (0..3_usize, 0..3_usize),
        0..7_usize,
        prop::collection::vec(coefficient, 9),
    );
    let ports = prop::collection::vec(port, 3..9);
    let tree = prop::collection::vec(link.clone(), 5);
    let links = prop::collection::vec(link, 0..3);
    let integrals = prop::collection::vec(0..6_usize, 0..3);
    (junctions, ports, integrals, tree, links).prop_map(
        |(junctions, ports, integrals, tree, links)| {
            let mut graph = Graph::new();
            let count = junctions.len();
            for (zero, dimension, coordinate) in junctions {
                graph.junction(zero, dimension, coordinate);
            }
            for port in ports {
                add_port(&mut graph, count, port);
            }
            for junction in integrals {
                graph.integral(junction % count);
            }
            for (to, seed) in (1..count).zip(tree) {
                add_link(&mut graph, (seed.0.0 % to, to), seed);
            }
            for seed in links {
                let (from, step) = (seed.0.0 % count, 1 + seed.0.1 % (count - 1));
                add_link(&mut graph, (from, (from + step) % count), seed);
            }
            graph
        },
    )
}

#[test]
fn survey() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let count: usize = std::env::var("CASES").map_or(300, |it| it.parse().unwrap());
    let mut fates = std::collections::BTreeMap::new();
    let mut wrongs = 0;
    for _ in 0..count {
        let (graph, uniform, reversed) = (graph(), any::<bool>(), any::<bool>())
            .new_tree(&mut runner)
            .unwrap()
            .current();
        let result = std::panic::catch_unwind(|| truth::hold(&graph, uniform, reversed))
            .unwrap_or(Err("panic".to_owned()));
        match result {
            Ok(fate) => *fates.entry(fate).or_insert(0) += 1,
            Err(wrong) => {
                wrongs += 1;
                let size = graph.text(!uniform, reversed).len();
                println!("=== {size} {wrong}\n{}", graph.text(!uniform, reversed));
            }
        }
    }
    println!("{fates:#?} wrong {wrongs}");
}
