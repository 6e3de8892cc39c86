//! The verdict as diagnostics.
//!
//! Stable macros cannot attach notes to other places, so every element that takes part gets an error of its own: the
//! dependent storage the whole chain and the ways out, the others their own steps of it. Each element gets at most one.

use std::collections::BTreeSet;

use super::dependence;
use super::explain::{self, Chain};
use super::outlook::Outlook;
pub use super::report_conflict::conflict_diagnostics;
use super::uniform::Verdict;
use super::ways::{Between, apart, through, turned};
use super::words::{self, ChainStep};
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error, listing};
use crate::graph::{Bond, BondGraph, Element, ElementId, ElementKind, End, Rule};

/// The first way out, where the drawing alone is at fault.
pub const COMPONENTWISE: &str = "write `causality componentwise;` in the model: one stroke per component instead of one per multibond";
/// The way out for joints that block some axes.
pub const JACOBIAN: &str = "replace the joints between two bodies `a` and `b` by one with a square Jacobian: \
    `1 gimbals[3] { C spring { … } R damper { … } } 0 joint[3]; a -> joint; \
    gimbals -> MTF jacobian { flow: jacobian_xyz(spring.q) } -> joint; \
    joint -> MTF turn { flow: transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z)) } -> b;`";

/// Longer chains are shortened.
const LONGEST_CHAIN: usize = 40;

/// Reports every storage that is forced into derivative causality and not marked `#[derivative]`, then the elements
/// that force it. What the same sources and two-ports force is told once.
pub fn diagnose(
    graph: &BondGraph,
    verdict: &Verdict,
    outlook: &Outlook,
    diagnostics: &mut Diagnostics,
) {
    let rejected = verdict
        .dependent
        .iter()
        .filter(|id| !graph.elements[id.0].derivative);
    let chains: Vec<Chain> = rejected
        .filter_map(|id| explain::explain(graph, verdict, *id))
        .collect();
    let mut reported: BTreeSet<ElementId> = chains.iter().map(|chain| chain.storage).collect();
    for (number, chain) in chains.iter().enumerate() {
        let alike = |other: &&Chain| has_one_cause(chain, other);
        if chains[..number].iter().any(|other| alike(&other)) {
            continue;
        }
        let others = chains[number + 1..].iter().filter(alike);
        let others: Vec<ElementId> = others.map(|other| other.storage).collect();
        diagnostics.report(storage_error(graph, verdict, chain, &others, outlook));
    }
    for chain in chains.iter().filter(|chain| !chain.integral.is_empty()) {
        for id in chain.integral.iter().chain(&chain.fixed) {
            if reported.insert(*id) {
                diagnostics.report(involved_error(graph, chain, *id));
            }
        }
    }
}

/// Whether the same elements alone force two storages.
fn has_one_cause(one: &Chain, other: &Chain) -> bool {
    let alone = |chain: &Chain| chain.integral.is_empty() && !chain.fixed.is_empty();
    alone(one) && alone(other) && one.fixed == other.fixed
}

fn name(graph: &BondGraph, id: ElementId) -> String {
    graph.elements[id.0].name.clone()
}

fn names<'a>(graph: &BondGraph, ids: impl IntoIterator<Item = &'a ElementId>) -> String {
    listing(ids.into_iter().map(|id| name(graph, *id)))
}

/// The bond at a one-port.
fn bond_of(graph: &BondGraph, id: ElementId) -> Option<&Bond> {
    graph
        .bonds
        .iter()
        .find(|bond| [&bond.from, &bond.to].contains(&&End::OnePort(id)))
}

/// `flow` for an inertia, `effort` for a compliance: what the storage would impose.
fn imposed(graph: &BondGraph, id: ElementId) -> &'static str {
    if graph.elements[id.0].rule == Rule::PreferFlowOut {
        "flow"
    } else {
        "effort"
    }
}

fn headline(graph: &BondGraph, id: ElementId) -> String {
    let variable = imposed(graph, id);
    let what = match bond_of(graph, id).map_or(1, |bond| bond.dimension) {
        1 => format!("its {variable} is imposed by the graph"),
        dimension => {
            format!("all {dimension} components of its {variable} are imposed by the graph")
        }
    };
    format!(
        "{} `{}` is forced into derivative causality: {what}",
        words::kind_name(graph, id),
        name(graph, id)
    )
}

fn storage_error(
    graph: &BondGraph,
    verdict: &Verdict,
    chain: &Chain,
    others: &[ElementId],
    outlook: &Outlook,
) -> Diagnostic {
    let id = chain.storage;
    let element = &graph.elements[id.0];
    let span = graph.origins.span(element.origin);
    let mut report = error(codes::STORAGE_DERIVATIVE, span, headline(graph, id));
    report.notes = chain_notes(graph, verdict, chain);
    report.notes.extend(choice(graph, verdict, chain));
    if !others.is_empty() {
        let others = names(graph, others);
        report.notes.push(format!("the same forces {others}"));
    }
    if outlook.loses_order() {
        report.notes.push(
            "component by component the equations have no solution either: a true loss of order, which no choice of \
             strokes mends"
                .to_owned(),
        );
    }
    report.notes.extend(outlook.notes());
    let helps = ways_out(graph, chain, others, outlook);
    report.helps = alternatives(helps);
    report
}

fn ways_out(
    graph: &BondGraph,
    chain: &Chain,
    others: &[ElementId],
    outlook: &Outlook,
) -> Vec<String> {
    let element = &graph.elements[chain.storage.0];
    let mut helps = Vec::new();
    if outlook.is_soluble() {
        helps.push(COMPONENTWISE.to_owned());
    }
    let storages = std::iter::once(&chain.storage).chain(others);
    helps.extend(outlook.acceptance(storages.map(|id| &graph.elements[id.0])));
    if !outlook.is_soluble() {
        if !chain.integral.is_empty() {
            // What follows from several states is no second one of any of them.
            if chain.integral.len() == 1 {
                helps.push(format!(
                    "merge the storages into one: `{}`",
                    written(element)
                ));
            }
            helps.push(match element.rule {
                Rule::PreferFlowOut => apart(graph, chain.storage),
                _ => {
                    let storages = [&chain.storage].into_iter().chain(&chain.integral);
                    let storages = storages.map(|id| &graph.elements[id.0]);
                    let owners = storages.map(|it| it.instance().unwrap_or(&it.name).to_owned());
                    format!("put a resistor in series with one of {}", listing(owners))
                }
            });
        } else {
            let mut fixed = chain.fixed.iter();
            let source = fixed.find_map(|id| Some((id, through(graph, *id, Between::Resistor)?)));
            if let Some((source, through)) = source {
                let storages = names(graph, std::iter::once(&chain.storage).chain(others));
                let felt = imposed(graph, chain.storage);
                let felt = if felt == "flow" { "effort" } else { "flow" };
                let is_storage =
                    |it: &Element| matches!(it.rule, Rule::PreferFlowOut | Rule::PreferEffortOut);
                let left = graph.elements.iter().filter(|it| is_storage(it)).count();
                // A model has a state.
                let is_own = element.instance().is_none() && left > 1 + others.len();
                let source = name(graph, *source);
                helps.extend(is_own.then(|| {
                    format!("remove {storages}, whose {felt} only `{source}` would feel")
                }));
                helps.push(through);
            }
        }
    }
    let resistors = chain.fixed.iter();
    let resistors = resistors.filter(|id| may_be_rewritten(graph, **id, outlook));
    helps.extend(resistors.filter_map(|id| resistor_help(graph, *id)));
    helps.extend(chain.fixed.iter().find_map(|id| turned(graph, *id)));
    helps.extend(gyrated(graph, chain));
    if explain::blocks_axes(graph, &chain.fixed) {
        helps.push(JACOBIAN.to_owned());
    }
    let known = helps.clone();
    let more = outlook.helps().into_iter();
    helps.extend(more.filter(|help| !known.contains(help)));
    helps
}

/// The only transformer of the user's between storages that depend on each other: it may have been meant to be a gyrator.
fn gyrated(graph: &BondGraph, chain: &Chain) -> Option<String> {
    let origins = chain.steps.iter().map(|step| step.origin);
    let origins: BTreeSet<_> = origins.collect();
    let elements = graph.elements.iter();
    let mut transformers = elements.filter(|it| {
        matches!(it.kind, ElementKind::TF | ElementKind::MTF) && origins.contains(&it.origin)
    });
    let (Some(only), None) = (transformers.next(), transformers.next()) else {
        return None;
    };
    if chain.integral.is_empty() || only.instance().is_some() {
        return None;
    }
    let name = &only.name;
    Some(format!(
        "where its effort goes with the flow on the other side, as of a motor, write `GY {name} {{ effort: … }}` in the place of \
         `{} {name}`",
        words::symbol(only.kind)
    ))
}

/// A storage as its statement begins.
fn written(element: &Element) -> String {
    match element.instance() {
        Some(instance) => format!("{instance}: …"),
        None => format!("{} {} {{ … }}", words::symbol(element.kind), element.name),
    }
}

fn chain_notes(graph: &BondGraph, verdict: &Verdict, chain: &Chain) -> Vec<String> {
    let mut notes = shortened(chain.steps.iter().map(|step| step.text.clone()).collect());
    if !chain.path.is_empty() {
        notes.push(format!("path: {}", chain.path));
    }
    let found = dependence::received(graph, &verdict.strokes, chain.storage);
    let variable = imposed(graph, chain.storage);
    let own = format!("the {variable} of `{}`", name(graph, chain.storage));
    let parts = [
        (["the state of", "the states of"], found.states),
        (["the source", "the sources"], found.sources),
        (
            ["the rate of change of", "the rates of change of"],
            found.rates,
        ),
    ];
    let parts: Vec<String> = parts
        .iter()
        .filter(|(_, ids)| !ids.is_empty())
        .map(|(what, ids)| format!("{} {}", what[usize::from(ids.len() > 1)], names(graph, ids)))
        .collect();
    if !parts.is_empty() {
        notes.push(format!("{own} is computed from {}", parts.join("; ")));
    }
    notes
}

/// A chain that nobody would read to its end keeps its beginning and its end.
fn shortened(mut steps: Vec<String>) -> Vec<String> {
    if steps.len() > LONGEST_CHAIN {
        let half = LONGEST_CHAIN / 2;
        let left_out = steps.len() - 2 * half;
        steps.splice(
            half..half + left_out,
            [format!("… {left_out} steps like these …")],
        );
    }
    steps
}

/// Why this storage and not another.
fn choice(graph: &BondGraph, verdict: &Verdict, chain: &Chain) -> Vec<String> {
    let own = name(graph, chain.storage);
    let mut notes = Vec::new();
    if !chain.spared.is_empty() {
        notes.push(format!(
            "integral causality of `{own}` would put {} into derivative causality",
            names(graph, &chain.spared)
        ));
    }
    let alternatives = explain::alternatives(graph, verdict, chain);
    if alternatives.is_empty() && verdict.proven_optimal {
        notes.push(format!(
            "no other storage of the chain could be dependent in the place of `{own}`"
        ));
    } else if !alternatives.is_empty() {
        notes.push(format!(
            "{} could be dependent in the place of `{own}`, at the same number of dependent storages; storages keep \
             integral causality in order of declaration, those under `#[derivative]` last",
            names(graph, &alternatives)
        ));
    }
    if !verdict.proven_optimal {
        notes.push(
            "the search ended before it was sure that fewer dependent storages are impossible"
                .to_owned(),
        );
    }
    notes
}

fn involved_error(graph: &BondGraph, chain: &Chain, id: ElementId) -> Diagnostic {
    let element = &graph.elements[id.0];
    let message = format!(
        "{} `{}` takes part in forcing {} `{}` into derivative causality",
        words::kind_name(graph, id),
        element.name,
        words::kind_name(graph, chain.storage),
        name(graph, chain.storage)
    );
    let mut report = error(
        codes::STORAGE_DERIVATIVE,
        graph.origins.span(element.origin),
        message,
    );
    report.notes = own_steps(graph, id, &chain.steps, &name(graph, chain.storage));
    report
}

/// The steps of a chain that an element brings in, and where the whole chain is told.
#[must_use]
pub fn own_steps(graph: &BondGraph, id: ElementId, steps: &[ChainStep], told: &str) -> Vec<String> {
    let origin = graph.elements[id.0].origin;
    let own = steps.iter().filter(|step| step.origin == origin);
    let whole = format!("the error at `{told}` tells the whole chain");
    let alone = |step: &ChainStep| step.text.trim_start_matches("but ").to_owned();
    own.map(alone).chain([whole]).collect()
}

/// Whether to tell how the law of a resistor can be written otherwise: not of one inside a component, such as a diode of the
/// library, where the equations have a solution as they are.
pub fn may_be_rewritten(graph: &BondGraph, id: ElementId, outlook: &Outlook) -> bool {
    !outlook.is_soluble() || graph.elements[id.0].instance().is_none()
}

/// The other law of a resistor that fits one causality only.
#[must_use]
pub fn resistor_help(graph: &BondGraph, id: ElementId) -> Option<String> {
    let name = &graph.elements[id.0].name;
    match graph.elements[id.0].rule {
        Rule::ResistanceOnly => Some(format!(
            "write the law of `{name}` for the flow: `flow: …` in terms of `e`"
        )),
        Rule::ConductanceOnly => Some(format!(
            "write the law of `{name}` for the effort: `effort: …` in terms of `f`"
        )),
        _ => None,
    }
}

/// Ways out as a list of alternatives.
#[must_use]
pub fn alternatives(helps: Vec<String>) -> Vec<String> {
    let or = |(index, help)| {
        if index == 0 {
            help
        } else {
            format!("or {help}")
        }
    };
    helps.into_iter().enumerate().map(or).collect()
}
