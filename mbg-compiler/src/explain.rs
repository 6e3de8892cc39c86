//! Every stage of a text as plain text, for people and for snapshots.
//!
//! Nothing is decided here: the stages are run one after the other, and each result is printed by its own `dump`.

use std::collections::BTreeMap;

use proc_macro2::{Span, TokenStream};

use crate::causality::outlook::Outlook;
use crate::compile::{self, Compiled, Routines};
use crate::diagnostics::Diagnostics;
use crate::elaborate::{self, Elaborated};
use crate::equations::{self, Scalars};
use crate::inclusion::Read;
use crate::network::Network;
use crate::structure::{self, Formulation, Solution};
use crate::symbolic::{Expression, Method, Pool};
use crate::syntax::ast::{Component, Item, Model};
use crate::{drawing, program, syntax};

/// Prints what each stage makes of the tokens between the braces of `mbg! { … }`, and at the end what is wrong, with its
/// place as the caller spells it. What they include is read by `read`.
///
/// # Errors
///
/// The same text, where something is wrong.
pub fn explain(
    tokens: TokenStream,
    read: &Read<'_>,
    place: &dyn Fn(Span) -> String,
) -> Result<String, String> {
    let mut diagnostics = Diagnostics::new();
    let (mut text, _) = crate::located(tokens, read, &mut diagnostics, &all_stages);
    for diagnostic in diagnostics.list() {
        let report = format!("{}: {}", place(diagnostic.span), diagnostic.text());
        text += &section("error", &report);
    }
    for warning in diagnostics.warnings() {
        let report = format!("{}: {}", place(warning.span), warning.text());
        text += &section("warning", &report);
    }
    if diagnostics.any() {
        Err(text)
    } else {
        Ok(text)
    }
}

fn all_stages(tokens: TokenStream, diagnostics: &mut Diagnostics) -> String {
    let source = syntax::parse(tokens, diagnostics);
    let mut text = section("syntax", &syntax::dump(&source));
    let components = elaborate::component_table(&source);
    elaborate::warn(&source, diagnostics);
    let sound = !diagnostics.any();
    for item in &source.items {
        let Item::Model(model) = item else { continue };
        if !sound {
            continue;
        }
        text += &stages(model, &components);
        if let Some(compiled) = compile::compile(model, &components, diagnostics) {
            text += &programs(&compiled);
        }
    }
    text
}

fn section(title: &str, body: &str) -> String {
    format!("==== {title}\n{}\n\n", body.trim_end())
}

/// The stages up to the first that fails; what is wrong is reported when the model is compiled as a whole.
fn stages(model: &Model, components: &BTreeMap<String, &Component>) -> String {
    let mut ignored = Diagnostics::new();
    let mut pool = Pool::new();
    let mut text = String::new();
    let Some(model) = elaborate::elaborate(model, components, &mut pool, &mut ignored) else {
        return text;
    };
    text += &section(&format!("graph of {}", model.name), &model.graph.dump());
    if let Some(drawn) = drawing::judge(&model.graph, &|| Outlook::Soluble, &mut ignored) {
        text += &section("causality", &drawing::diagram(&model.graph, &drawn.strokes));
    }
    let network = Network::of(&model.graph, &mut pool);
    let scalars = equations::form(&model, &network, &mut pool);
    text += &section("equations", &equation_lines(&model, &scalars, &pool));
    if let Ok(solution) = structure::solve(&scalars, Formulation::Articulated, &mut pool) {
        text += &section(
            "structure",
            &value_lines(&model, &scalars, &solution, &pool),
        );
    }
    text
}

/// One equation a line: what is summed to zero.
fn equation_lines(model: &Elaborated, scalars: &Scalars, pool: &Pool) -> String {
    let mut text = String::new();
    for equation in &scalars.equations {
        let mut terms: Vec<String> = equation
            .terms
            .iter()
            .map(|(unknown, coefficient)| {
                let unknown = compile::unknown_text(scalars, *unknown);
                match *coefficient {
                    Expression::ONE => unknown,
                    other if other == Expression::ONE.negated() => format!("-{unknown}"),
                    other => match compile::text(model, scalars, pool, other) {
                        sum if sum.contains(' ') => format!("({sum}) {unknown}"),
                        atom => format!("{atom} {unknown}"),
                    },
                }
            })
            .collect();
        if equation.constant != Expression::ZERO {
            terms.push(compile::text(model, scalars, pool, equation.constant));
        }
        text += &format!("0 = {}\n", terms.join(" + ").replace("+ -", "- "));
    }
    text
}

/// One unknown a line, then what is divided by.
fn value_lines(model: &Elaborated, scalars: &Scalars, solution: &Solution, pool: &Pool) -> String {
    let mut text = String::new();
    for (unknown, value) in solution.values.iter().enumerate() {
        let value = compile::text(model, scalars, pool, *value);
        text += &format!("{} = {value}\n", compile::unknown_text(scalars, unknown));
    }
    for implicit in pool.implicit() {
        if let Method::Newton { residuals, .. } = &implicit.method {
            for residual in residuals {
                let zero = compile::text(model, scalars, pool, *residual);
                text += &format!("iterated: 0 = {zero}\n");
            }
        }
    }
    for inverted in &solution.conditioning {
        let divisor = compile::text(model, scalars, pool, inverted.normalised);
        text += &format!("inverted: {divisor}\n");
    }
    text
}

fn programs(compiled: &Compiled) -> String {
    let routines = &compiled.program.routines;
    section("folded", &program::dump(&compiled.program.folded))
        + &section(
            "derivative",
            &program::dump(&routines[Routines::DERIVATIVE]),
        )
        + &section("output", &program::dump(&routines[Routines::OUTPUT]))
        + &section("operations", &operations(compiled))
        + &notes(compiled)
}

/// What a user should know, if there is something.
fn notes(compiled: &Compiled) -> String {
    if compiled.notes.is_empty() {
        return String::new();
    }
    section("notes", &compiled.notes.join("\n"))
}

/// What each function costs.
fn operations(compiled: &Compiled) -> String {
    let functions = [
        ("derivative", Routines::DERIVATIVE),
        ("output", Routines::OUTPUT),
        ("derivative_and_jacobian", Routines::DERIVATIVE_AND_JACOBIAN),
        ("jacobian_input", Routines::JACOBIAN_INPUT),
        ("energy", Routines::ENERGY),
        ("power", Routines::POWER),
        ("conditioning", Routines::CONDITIONING),
    ];
    let lines = functions.map(|(name, number)| {
        let count = compiled.operations(number);
        format!("{name:<24}{count:>6}")
    });
    lines.join("\n")
}
