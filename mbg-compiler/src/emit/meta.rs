//! Metadata and documentation of a model.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use crate::compile::{Compiled, Routines};
use crate::diagnostics::listing;
use crate::drawing;
use crate::elaborate::{Condition, Variable};

/// Lines of documentation that follow the user's own.
pub(super) fn documentation(compiled: &Compiled) -> Vec<String> {
    let model = &compiled.model;
    let states: Vec<&Variable> = compiled
        .states
        .iter()
        .map(|state| &model.states[*state].variable)
        .collect();
    let inputs: Vec<&Variable> = model.inputs.iter().collect();
    let outputs: Vec<&Variable> = model.outputs.iter().map(|it| &it.variable).collect();
    let operations = compiled.operations(Routines::DERIVATIVE);
    let mut lines = vec![
        String::new(),
        format!("{operations} operations per derivative."),
        String::new(),
        "| | | names in order |".to_owned(),
        "|---|---|---|".to_owned(),
    ];
    for (kind, variables) in [("states", states), ("inputs", inputs), ("outputs", outputs)] {
        let names = variables.iter().map(|variable| variable.name.clone());
        let names = match variables.len() {
            0 => "none".to_owned(),
            _ => listing(names),
        };
        lines.push(format!("| {kind} | {} | {names} |", variables.len()));
    }
    if !compiled.conditioning.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "Singular where one of these is zero: `{}`.",
            compiled.conditioning.join("`, `")
        ));
    }
    if !compiled.eliminated.is_empty() {
        let relations = compiled.eliminated.iter();
        let relations = relations.map(|(state, value)| format!("{state} = {value}"));
        lines.push(String::new());
        lines.push(format!(
            "No states, because they follow from others: {}.",
            listing(relations)
        ));
    }
    for found in &compiled.loops {
        let through = found.through.join("`, `");
        let size = found.variables;
        let solver = match found.iterated {
            0 => "linear".to_owned(),
            1 => "Newton iteration on one of them".to_owned(),
            count => format!("Newton iteration on {count} of them"),
        };
        lines.push(String::new());
        lines.push(format!(
            "Algebraic loop of {size} variables through `{through}`: {solver}."
        ));
    }
    for assumption in assumptions(compiled) {
        lines.push(String::new());
        lines.push(assumption);
    }
    lines.into_iter().map(spaced).collect()
}

/// As it stands behind `///`.
pub(super) fn spaced(line: String) -> String {
    if line.is_empty() {
        line
    } else {
        format!(" {line}")
    }
}

fn assumptions(compiled: &Compiled) -> Vec<String> {
    compiled
        .checks
        .iter()
        .map(|check| {
            let must = match check.condition {
                Condition::NonZero => "not be zero",
                Condition::Positive => "be positive",
                Condition::NotNegative => "not be negative",
            };
            format!("`{}` must {must}: {}.", check.name, check.reason)
        })
        .collect()
}

/// The constant `META`.
pub(super) fn constant(compiled: &Compiled) -> TokenStream {
    let model = &compiled.model;
    let name = model.name.to_string();
    let variable =
        |name: &str, unit: &str| quote!(mbg_runtime::Variable { name: #name, unit: #unit });
    let variables = |list: &[&Variable]| -> Vec<TokenStream> {
        list.iter()
            .map(|entry| variable(&entry.name, &entry.unit))
            .collect()
    };
    let parameters: Vec<_> = model
        .parameters
        .iter()
        .map(|entry| variable(&entry.variable.name, &entry.variable.unit))
        .collect();
    let states: Vec<_> = compiled
        .states
        .iter()
        .map(|state| &model.states[*state].variable)
        .collect();
    let states = variables(&states);
    let inputs = variables(&model.inputs.iter().collect::<Vec<_>>());
    let outputs = variables(
        &model
            .outputs
            .iter()
            .map(|output| &output.variable)
            .collect::<Vec<_>>(),
    );
    let bonds = bonds(compiled);
    let (dependent, conditioning, notes) =
        (&compiled.dependent, &compiled.conditioning, &compiled.notes);
    let assumptions = assumptions(compiled);
    let loops = loops(compiled);
    let eliminated = compiled.eliminated.iter().map(
        |(state, relation)| quote!(mbg_runtime::Eliminated { state: #state, relation: #relation }),
    );
    let closures = model.graph.closures.iter().map(|closure| &closure.name);
    let operations = operations(compiled);
    let diagram = drawing::diagram(&model.graph, &compiled.strokes);
    quote! {
        &mbg_runtime::Meta {
            name: #name,
            parameters: &[#(#parameters),*],
            states: &[#(#states),*],
            inputs: &[#(#inputs),*],
            outputs: &[#(#outputs),*],
            bonds: &[#(#bonds),*],
            dependent: &[#(#dependent),*],
            eliminated: &[#(#eliminated),*],
            conditioning: &[#(#conditioning),*],
            loops: &[#(#loops),*],
            closures: &[#(#closures),*],
            assumptions: &[#(#assumptions),*],
            notes: &[#(#notes),*],
            operations: #operations,
            diagram: #diagram,
        }
    }
}

fn loops(compiled: &Compiled) -> impl Iterator<Item = TokenStream> {
    compiled.loops.iter().map(|found| {
        let (through, variables) = (&found.through, Literal::usize_suffixed(found.variables));
        let class = if found.resistive {
            quote!(Resistive)
        } else {
            quote!(Structural)
        };
        let solver = match found.iterated {
            0 => quote!(Linear),
            unknowns => {
                let unknowns = Literal::usize_suffixed(unknowns);
                quote!(Newton { unknowns: #unknowns, iterations: mbg_runtime::__private::ITERATIONS })
            }
        };
        quote! {
            mbg_runtime::Loop {
                through: &[#(#through),*], class: mbg_runtime::LoopClass::#class, variables: #variables, solver: mbg_runtime::Solver::#solver,
            }
        }
    })
}

fn operations(compiled: &Compiled) -> TokenStream {
    let count = |routine: usize| Literal::usize_suffixed(compiled.operations(routine));
    let [
        derivative,
        output,
        derivative_and_jacobian,
        jacobian_input,
        energy,
        power,
    ] = [
        Routines::DERIVATIVE,
        Routines::OUTPUT,
        Routines::DERIVATIVE_AND_JACOBIAN,
        Routines::JACOBIAN_INPUT,
        Routines::ENERGY,
        Routines::POWER,
    ]
    .map(count);
    let angles = Literal::usize_suffixed(compiled.program.routines[Routines::DERIVATIVE].angles());
    quote! {
        mbg_runtime::Operations {
            derivative: #derivative, output: #output, derivative_and_jacobian: #derivative_and_jacobian,
            jacobian_input: #jacobian_input, energy: #energy, power: #power, angles: #angles,
        }
    }
}

fn bonds(compiled: &Compiled) -> Vec<TokenStream> {
    let graph = &compiled.model.graph;
    graph
        .bonds
        .iter()
        .enumerate()
        .map(|(index, bond)| {
            let (from, to) = (graph.end_name(&bond.from), graph.end_name(&bond.to));
            let dimension = Literal::usize_suffixed(bond.dimension);
            let strokes = compiled.strokes.get(index).map(|at_to| {
                let stroke = if *at_to { quote!(mbg_runtime::Stroke::To) } else { quote!(mbg_runtime::Stroke::From) };
                vec![stroke; bond.dimension]
            });
            let strokes = strokes.into_iter().flatten();
            quote! {
                mbg_runtime::Bond { from: #from, to: #to, dimension: #dimension, strokes: &[#(#strokes),*] }
            }
        })
        .collect()
}
