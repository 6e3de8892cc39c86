//! Random models with `#[derivative]`: as many states are lost as the rank says, and what the program tells of every
//! port satisfies every equation of the graph.
//!
//! The program is taken at its word: efforts, flows and states of all ports are its outputs, and their time derivatives
//! those along the rates that it returns, by dual numbers. They must obey the laws of the elements, each lost storage
//! must change by its own effort or flow, and there must be efforts and flows of the inner bonds that satisfy the
//! junctions and two-ports. Since no state is lost without need, nothing else does.

mod models;
mod rank;
mod reduction {
    pub(crate) mod elements;
    pub(crate) mod graph;
    pub(crate) mod truth;
}

use std::cell::Cell;

use mbg_compiler::compile::Routines;
use mbg_compiler::program::{self, Arguments};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use reduction::elements::{Entry, Kind, Law};
use reduction::graph::{Drawing, Graph, Link, Verdict};
use reduction::truth::{self, Fate};

use models::compiled;

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
    // Sources know time and the input only; the rate of the input is unknown, and a flow's may be asked for.
    let drive = |variables| entry(form, diagonal, variable, variables);
    let kind = match kind {
        0..4 => Kind::Inertia(law(number, true, diagonal, coupling)),
        4..7 => Kind::Compliance(law(number, false, diagonal, coupling)),
        7..9 if graph.resistive => Kind::Resistor(diagonal),
        7..9 => graph.load(place.0),
        9 => Kind::Effort(drive(2)),
        _ => Kind::Flow(drive(1)),
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
    let ports = prop::collection::vec(port, 4..10);
    let tree = prop::collection::vec(link.clone(), 5);
    let links = prop::collection::vec(link, 0..2);
    let integrals = prop::collection::vec(0..6_usize, 0..3);
    (junctions, ports, integrals, tree, links, any::<bool>()).prop_map(
        |(junctions, ports, integrals, tree, links, resistive)| {
            let mut graph = Graph::new(resistive);
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
            graph.complete();
            graph
        },
    )
}

/// Random models, of which at least one in six loses states and is accepted.
fn survey(cases: u32) {
    let config = ProptestConfig {
        cases,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let mut runner =
        TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let (dependent, even) = (Cell::new(0), Cell::new(0));
    let strategy = (graph(), any::<bool>(), any::<bool>());
    let result = runner.run(&strategy, |(graph, uniform, reversed)| {
        let drawing = Drawing {
            uniform,
            reversed,
            coordinates: true,
        };
        match truth::hold(&graph, drawing) {
            Ok(Fate::Satisfied(Verdict::Dependent(1..))) => dependent.set(dependent.get() + 1),
            Ok(_) => {}
            Err(wrong) => {
                let message = format!("{wrong}\n{}", graph.text(drawing));
                return Err(TestCaseError::fail(message));
            }
        }
        if graph.resistive {
            return Ok(());
        }
        let compared = truth::is_even(&graph, uniform).map_err(TestCaseError::fail)?;
        even.set(even.get() + u32::from(compared));
        Ok(())
    });
    if let Err(failure) = result {
        panic!("{failure}");
    }
    assert!(even.get() * 6 > cases, "{} of {cases}", even.get());
    assert!(
        dependent.get() * 6 > cases,
        "{} of {cases}",
        dependent.get()
    );
}

/// No row of the junctions by itself tells of what such storages follow from the states: sums of rows do, in which voltages of
/// nodes or currents into them cancel.
#[test]
fn what_depends_through_sums_of_rows_is_eliminated() {
    let rate = |statements: &str| {
        let text = format!(
            "#[derivative] model M {{ causality componentwise; input u;
             0 ground; Se earth {{ effort: 0.0 }} -> ground; 0 plus; Se source {{ effort: u }} -> plus; {statements} }}"
        );
        let model = compiled(&text);
        assert_eq!((model.states.len(), model.notes.as_slice()), (1, &[][..]));
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &[0.6],
            input: &[5.0],
        };
        program::evaluate(&model.program, Routines::DERIVATIVE, &arguments)[0]
    };
    // Capacitors beside each other, none of whose nodes is held: R i = u − q / C, and a part of the current is q̇.
    let current = (5.0 - 0.6 / 2.0) / (3.0 + 7.0);
    let beside = rate(
        "0 a; 0 b; first: Resistor { resistance: 3.0 } (plus, a);
         one: Capacitor { capacitance: 2.0 } (a, b); other: Capacitor { capacitance: 6.0 } (a, b);
         second: Resistor { resistance: 7.0 } (b, ground);",
    );
    assert!((beside - 2.0 / (2.0 + 6.0) * current).abs() < 1e-15);
    // Coils on both sides of resistors beside each other: (L + M) i̇ = u − R i, of which L i̇ is ṗ.
    let voltage = 5.0 - 2.0 * 0.6 / 4.0;
    let between = rate(
        "0 a; 0 b; one: Inductor { inductance: 4.0 } (plus, a);
         first: Resistor { resistance: 3.0 } (a, b); second: Resistor { resistance: 6.0 } (a, b);
         other: Inductor { inductance: 1.0 } (b, ground);",
    );
    assert!((between - 4.0 / (4.0 + 1.0) * voltage).abs() < 1e-15);
}

#[test]
fn programs_satisfy_their_graphs() {
    survey(300);
}

/// Takes minutes: `cargo test --release -p mbg-compiler --features long --test reduction`.
#[cfg(feature = "long")]
#[test]
fn thousands_of_programs_satisfy_their_graphs() {
    survey(20_000);
}
