//! Verdict and conflict as diagnostics.
//!
//! Stable macros cannot attach notes to other places, so every element that takes part gets an error of its own with
//! the same chain; each element gets at most one.

use std::collections::BTreeSet;

use super::conflict::Conflict;
use super::explain::{self, Chain};
use super::uniform::Verdict;
use super::words;
use crate::codes;
use crate::diagnostics::{Code, Diagnostic, Diagnostics, error, listing};
use crate::graph::{Bond, BondGraph, ElementId, End, OriginId, Rule};

const COMPONENTWISE: &str = "`causality componentwise;` in the model, for one stroke per component instead of one per multibond";
const JACOBIAN: &str = "or give the joint one square Jacobian: `gimbals -> MTF jacobian { flow: jacobian_xyz(spring.q) } -> joint;`";

/// Reports every storage that is forced into derivative causality and not marked `#[derivative]`, then the elements
/// that force it.
pub fn diagnose(graph: &BondGraph, verdict: &Verdict, diagnostics: &mut Diagnostics) {
    let rejected = verdict
        .dependent
        .iter()
        .filter(|id| !graph.elements[id.0].derivative);
    let chains: Vec<Chain> = rejected
        .filter_map(|id| explain::explain(graph, verdict, *id))
        .collect();
    let mut reported: BTreeSet<ElementId> = chains.iter().map(|chain| chain.storage).collect();
    for chain in &chains {
        diagnostics.report(storage_error(graph, verdict, chain));
    }
    for chain in chains.iter().filter(|chain| !chain.integral.is_empty()) {
        for id in chain.integral.iter().chain(&chain.fixed) {
            if reported.insert(*id) {
                diagnostics.report(involved_error(graph, chain, *id));
            }
        }
    }
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

fn storage_error(graph: &BondGraph, verdict: &Verdict, chain: &Chain) -> Diagnostic {
    let id = chain.storage;
    let mut report = error(
        codes::STORAGE_DERIVATIVE,
        graph.origins.span(graph.elements[id.0].origin),
        headline(graph, id),
    );
    report.notes = chain_notes(graph, chain);
    report.notes.extend(choice(graph, verdict, chain));
    let element = &graph.elements[id.0];
    let mark = format!(
        "or `#[derivative]` before the element, `#[derivative] {} {} {{ … }}`, to accept it",
        words::symbol(element.kind),
        element.name.rsplit('.').next().unwrap_or_default(),
    );
    report = report.help(COMPONENTWISE).help(mark);
    for fixed in &chain.fixed {
        if let Some(help) = resistor_help(graph, *fixed) {
            report = report.help(help);
        }
    }
    if explain::blocks_axes(graph, &chain.fixed) {
        report.help(JACOBIAN)
    } else {
        report
    }
}

fn chain_notes(graph: &BondGraph, chain: &Chain) -> Vec<String> {
    let mut notes: Vec<String> = chain.steps.iter().map(|step| step.text.clone()).collect();
    if !chain.path.is_empty() {
        notes.push(format!("path: {}", chain.path));
    }
    let (id, variable) = (chain.storage, imposed(graph, chain.storage));
    let own = format!("the {variable} of `{}`", name(graph, id));
    match (chain.integral.is_empty(), chain.fixed.is_empty()) {
        (true, true) => {}
        (true, false) => notes.push(format!(
            "{own} depends on no storage, only on {}",
            names(graph, &chain.fixed)
        )),
        (false, true) => notes.push(format!(
            "{own} depends on the state of {}",
            names(graph, &chain.integral)
        )),
        (false, false) => notes.push(format!(
            "{own} depends on the state of {}, because of {}",
            names(graph, &chain.integral),
            names(graph, &chain.fixed)
        )),
    }
    notes
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
    report.notes = chain_notes(graph, chain);
    report
}

/// Reports a conflict at each element that takes part, or at the junction where the rules fail.
pub fn conflict_diagnostics(graph: &BondGraph, conflict: &Conflict, diagnostics: &mut Diagnostics) {
    let mut origins: Vec<OriginId> = conflict
        .elements
        .iter()
        .map(|id| graph.elements[id.0].origin)
        .collect();
    let junction = conflict.junction.map(|id| graph.junctions[id.0].origin);
    if conflict.code == codes::NO_ASSIGNMENT {
        origins.splice(0..0, junction);
    }
    if origins.is_empty() {
        let anything = graph.junctions.first().map(|junction| junction.origin);
        let anything = anything.or(graph.elements.first().map(|element| element.origin));
        origins.extend(anything.or(graph.bonds.first().map(|bond| bond.origin)));
    }
    let mut reported = BTreeSet::new();
    for origin in origins {
        if reported.insert(origin) {
            let mut report = error(
                conflict.code,
                graph.origins.span(origin),
                conflict_message(graph, conflict),
            );
            report.notes = conflict
                .chain
                .iter()
                .map(|step| step.text.clone())
                .collect();
            if reported.len() == 1 {
                report.helps = conflict_helps(graph, conflict);
            }
            diagnostics.report(report);
        }
    }
}

fn conflict_message(graph: &BondGraph, conflict: &Conflict) -> String {
    if !conflict.proven() {
        return "no assignment of strokes was found before the search reached its limit".to_owned();
    }
    let culprit = conflict.elements.first().copied();
    let place = conflict.junction.map_or_else(String::new, |id| {
        format!(" at `{}`", graph.junctions[id.0].name)
    });
    match culprit {
        Some(id) if conflict.code != codes::NO_ASSIGNMENT => {
            fixed_message(graph, id, conflict, &place)
        }
        _ => format!("no assignment of strokes satisfies the rules{place}"),
    }
}

fn fixed_message(graph: &BondGraph, id: ElementId, conflict: &Conflict, place: &str) -> String {
    let element = &graph.elements[id.0];
    let (kind, name) = (words::kind_name(graph, id), &element.name);
    match element.rule {
        Rule::Gyroscopic => {
            format!(
                "{kind} `{name}` would have to give its flow, but its skew 3x3 matrix has rank 2 and no inverse"
            )
        }
        Rule::Transformer { .. } | Rule::Gyrator { .. } => {
            format!(
                "{kind} `{name}` would have to run backward, but {}",
                words::dimensions(element.rule)
            )
        }
        Rule::ResistanceOnly => {
            format!(
                "{kind} `{name}` would have to give its flow, but its law gives the effort and has no inverse"
            )
        }
        Rule::ConductanceOnly => {
            format!(
                "{kind} `{name}` would have to give its effort, but its law gives the flow and has no inverse"
            )
        }
        _ => format!(
            "the fixed causalities of {} contradict each other{place}",
            names(graph, &conflict.elements)
        ),
    }
}

fn resistor_help(graph: &BondGraph, id: ElementId) -> Option<String> {
    let name = &graph.elements[id.0].name;
    match graph.elements[id.0].rule {
        Rule::ResistanceOnly => Some(format!(
            "or write the law of `{name}` for the flow: `flow: …` in terms of `e`"
        )),
        Rule::ConductanceOnly => Some(format!(
            "or write the law of `{name}` for the effort: `effort: …` in terms of `f`"
        )),
        _ => None,
    }
}

fn conflict_helps(graph: &BondGraph, conflict: &Conflict) -> Vec<String> {
    if !conflict.proven() {
        return vec![COMPONENTWISE.to_owned()];
    }
    let place = conflict
        .junction
        .map_or("the junction", |id| &graph.junctions[id.0].name);
    let mut helps = vec![match conflict.code {
        code if code == codes::SOURCES_CONFLICT => {
            format!("remove one of {}", names(graph, &conflict.elements))
        }
        code if code == codes::GYROSCOPIC_INVERSE => {
            format!(
                "give `{place}` its flow from an inertia: `I body {{ inertia: …, gyroscopic }}`"
            )
        }
        _ => free_element(graph, conflict, place),
    }];
    helps.extend(
        conflict
            .elements
            .iter()
            .filter_map(|id| resistor_help(graph, *id)),
    );
    helps.push(format!("or {COMPONENTWISE}"));
    if explain::blocks_axes(graph, &conflict.elements) {
        helps.push(JACOBIAN.to_owned());
    }
    helps
}

/// An element that would leave the junction a choice.
fn free_element(graph: &BondGraph, conflict: &Conflict, place: &str) -> String {
    let law = match conflict.junction.map(|id| graph.junctions[id.0].kind) {
        Some(crate::graph::JunctionKind::Zero) => "resistance",
        _ => "conductance",
    };
    format!(
        "attach a resistor to `{place}`, which leaves the choice open: `R damper {{ {law}: … }}`"
    )
}

/// Whether a code belongs to a conflict.
#[must_use]
pub fn is_conflict(code: Code) -> bool {
    [
        codes::SOURCES_CONFLICT,
        codes::NO_ASSIGNMENT,
        codes::GYROSCOPIC_INVERSE,
        codes::RECTANGULAR_INVERSE,
        codes::FIXED_RESISTOR,
    ]
    .contains(&code)
}
