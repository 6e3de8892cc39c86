//! Models from texts, as far as a stage, or everything that was reported with its place.
#![allow(dead_code, clippy::unwrap_used)]

pub(crate) mod dual;

use std::fmt::Write;

use mbg_compiler::compile::{Compiled, Routines, compile};
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::elaborate::{self, Elaborated};
use mbg_compiler::equations;
use mbg_compiler::graph::BondId;
use mbg_compiler::network::Network;
use mbg_compiler::program::{self, Arguments};
use mbg_compiler::structure::{self, Formulation, Solved};
use mbg_compiler::symbolic::print::Printer;
use mbg_compiler::symbolic::{Pool, Symbol};
use mbg_compiler::syntax::ast::{Item, Model, Source};
use mbg_compiler::syntax::parse;

/// The last model of a text after elaboration, and the pool of its expressions.
pub(crate) fn elaborated(text: &str) -> Result<(Elaborated, Pool), String> {
    let mut pool = Pool::new();
    let model = stage(text, |model, source, diagnostics| {
        let components = elaborate::component_table(source);
        elaborate::elaborate(model, &components, &mut pool, diagnostics)
    })?;
    Ok((model, pool))
}

/// The equations of the last model of a text with their solution.
pub(crate) fn solved(text: &str) -> Result<(Elaborated, Solved, Pool), String> {
    let mut pool = Pool::new();
    let (model, solved) = stage(text, |model, source, diagnostics| {
        let components = elaborate::component_table(source);
        let mut model = elaborate::elaborate(model, &components, &mut pool, diagnostics)?;
        let network = Network::of(&model.graph, &mut pool);
        let scalars = equations::form(&model, &network, &mut pool);
        let first = structure::solve(&scalars, Formulation::Articulated, &mut pool);
        let solved = structure::resolve(&mut model, scalars, first, &mut pool, diagnostics)?;
        Some((model, solved))
    })?;
    Ok((model, solved, pool))
}

/// The last model of a text after all stages; it has no mistakes.
pub(crate) fn compiled(text: &str) -> Compiled {
    completed(text).unwrap_or_else(|reported| panic!("{reported}"))
}

/// The last model of a text after all stages.
pub(crate) fn completed(text: &str) -> Result<Compiled, String> {
    stage(text, |model, source, diagnostics| {
        compile(model, &elaborate::component_table(source), diagnostics)
    })
}

/// The last model of a text after all stages, or the codes of what was reported.
#[allow(dead_code, reason = "not every test file tries what may fail")]
pub(crate) fn attempted(text: &str) -> Result<Compiled, Vec<&'static str>> {
    let (model, diagnostics) = read(text, |model, source, diagnostics| {
        compile(model, &elaborate::component_table(source), diagnostics)
    });
    model.ok_or_else(|| diagnostics.list().iter().map(|it| it.code.text).collect())
}

/// Results of a routine at a state, at time zero and without inputs.
pub(crate) fn run(model: &Compiled, routine: usize, state: &[f64]) -> Vec<f64> {
    let arguments = Arguments {
        parameters: &[0.3; 1][..model.model.parameters.len()],
        time: 0.0,
        state,
        input: &[],
    };
    program::evaluate(&model.program, routine, &arguments)
}

/// Some state without any symmetry.
pub(crate) fn state(model: &Compiled) -> Vec<f64> {
    (0..model.states.len())
        .map(|place| (1.3 * place as f64 + 0.4).sin())
        .collect()
}

pub(crate) fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < tolerance,
            "found {found}, expected {expected}"
        );
    }
}

/// What the sources supply goes into the storages and the resistors, and nowhere else.
pub(crate) fn assert_lossless(model: &Compiled) {
    let (state, step) = (state(model), 1e-4);
    let rates = run(model, Routines::DERIVATIVE, &state);
    let energy = |along: f64| {
        let moved: Vec<f64> = state
            .iter()
            .zip(&rates)
            .map(|(x, rate)| x + along * rate)
            .collect();
        run(model, Routines::ENERGY, &moved)[0]
    };
    let power = run(model, Routines::POWER, &state);
    let stored = (energy(step) - energy(-step)) / (2.0 * step);
    assert_near(&[stored], &[power[0] - power[1]], 1e-6);
}

/// Errors of a model with one mass around the statements given.
pub(crate) fn mistake(statements: &str) -> String {
    let text =
        format!("model M {{ param n = 3.0; 1 a[3] {{ I m {{ inertia: 1.0 }} }}\n{statements} }}");
    elaborated(&text).err().unwrap_or_default()
}

/// Bonds, initial states and outputs of the flat graph.
pub(crate) fn flat(text: &str) -> String {
    let (model, pool) = elaborated(text).unwrap_or_else(|reported| panic!("{reported}"));
    let mut text = String::new();
    for bond in 0..model.graph.bonds.len() {
        let dimension = model.graph.bonds[bond].dimension;
        writeln!(
            text,
            "{} [{dimension}]",
            model.graph.bond_name(BondId(bond))
        )
        .unwrap();
    }
    let name = |symbol| match symbol {
        Symbol::Parameter(index) => model.parameters[index].variable.name.clone(),
        Symbol::State(index) => model.states[index].variable.name.clone(),
        other => format!("{other:?}"),
    };
    let printer = Printer::new(&pool, &name);
    for state in &model.states {
        let (name, initial) = (&state.variable.name, printer.text(state.initial));
        writeln!(text, "state {name} = {initial}").unwrap();
    }
    for output in &model.outputs {
        let (name, value) = (&output.variable.name, printer.text(output.value));
        writeln!(text, "output {name} = {value}").unwrap();
    }
    text
}

fn stage<T>(
    text: &str,
    stages: impl FnOnce(&Model, &Source, &mut Diagnostics) -> Option<T>,
) -> Result<T, String> {
    let (result, diagnostics) = read(text, stages);
    let reported = diagnostics.list().iter().map(|diagnostic| {
        let start = diagnostic.span.start();
        format!("{}:{} {}", start.line, start.column + 1, diagnostic.text())
    });
    result.ok_or_else(|| reported.collect::<Vec<_>>().join("\n"))
}

fn read<T>(
    text: &str,
    stages: impl FnOnce(&Model, &Source, &mut Diagnostics) -> Option<T>,
) -> (Option<T>, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let source = parse(text.parse().unwrap(), &mut diagnostics);
    let Some(Item::Model(model)) = source.items.last() else {
        panic!("a model was written")
    };
    let result = stages(model, &source, &mut diagnostics);
    (result, diagnostics)
}
