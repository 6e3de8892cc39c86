//! Stages 2d and 5b, displacements: those of storages that are told in terms of other states.
//!
//! The length of a spring between two bodies follows from where these are. A
//! `C spring { stiffness: 1e3, displacement: length - 0.2 }` has no state of its own then, stores its energy all the same, and
//! nothing drifts. That the displacement changes as the storage flows is proven as soon as the flows are known. Errors:
//! `MBG0216`, `MBG0218`, `MBG0309`.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use crate::answers::storage_rate;
use crate::closures::changes_by;
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::elaborate::Elaborated;
use crate::equations::Scalars;
use crate::graph::{Element, ElementId, End, Law, Storage, component_name, instance_of};
use crate::structure::Solution;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Pool, Substitution, Symbol};

/// Displacements that are told, by candidate state.
type Told = BTreeMap<usize, Expression>;

/// Writes displacements in terms of time and of states that are left, and lets them start where these do.
pub fn express(model: &mut Elaborated, pool: &mut Pool, diagnostics: &mut Diagnostics) {
    check_reads(model, pool, diagnostics);
    let mut told = told(model);
    // They may be told in terms of each other, but not in a circle.
    for _ in 0..told.len() {
        if told_by_another(&told, pool).is_none() {
            break;
        }
        let mut substitution = replacing(&told);
        for (state, value) in &mut told {
            match substitution.apply(pool, *value) {
                Some(replaced) => *value = replaced,
                None => return report_division(model, *state, diagnostics),
            }
        }
    }
    if let Some(state) = told_by_another(&told, pool) {
        let name = &model.states[state].variable.name;
        let message = format!("the displacement `{name}` is told by itself");
        return diagnostics.error(codes::CYCLE, model.states[state].span, message);
    }
    let mut at_start = Substitution::new();
    at_start.set(Symbol::Time, Expression::ZERO);
    for (state, entry) in model.states.iter().enumerate() {
        at_start.set(Symbol::State(state), entry.initial);
    }
    for (state, value) in &told {
        match at_start.apply(pool, *value) {
            Some(initial) => model.states[*state].initial = initial,
            None => return report_division(model, *state, diagnostics),
        }
    }
    for element in &mut model.graph.elements {
        if let Law::Storage(Storage {
            states,
            displacement: Some(entries),
            ..
        }) = &mut element.law
        {
            *entries = states.clone().map(|state| told[&state]).collect();
        }
    }
}

/// What replaces the states of such storages.
#[must_use]
pub fn substitution(model: &Elaborated) -> Substitution {
    replacing(&told(model))
}

/// Whether a candidate state is told, and so none.
#[must_use]
pub fn is_told(model: &Elaborated, state: usize) -> bool {
    let elements = storages(model);
    let mut told = elements.filter(|(_, _, storage)| storage.displacement.is_some());
    told.any(|(_, _, storage)| storage.states.contains(&state))
}

fn storages(model: &Elaborated) -> impl Iterator<Item = (ElementId, &Element, &Storage)> {
    let elements = model.graph.elements.iter().enumerate();
    elements.filter_map(|(id, element)| match &element.law {
        Law::Storage(storage) => Some((ElementId(id), element, storage)),
        _ => None,
    })
}

fn told(model: &Elaborated) -> Told {
    let entries = |(_, _, storage): (ElementId, &Element, &Storage)| {
        let entries = storage.displacement.iter().flatten().copied();
        storage.states.clone().zip(entries).collect::<Vec<_>>()
    };
    storages(model).flat_map(entries).collect()
}

/// The first that is told in terms of one that is told.
fn told_by_another(told: &Told, pool: &Pool) -> Option<usize> {
    let is_told = |it: &Symbol| matches!(it, Symbol::State(state) if told.contains_key(state));
    let reads = |(_, value): &(&usize, &Expression)| symbols(pool, &[**value]).iter().any(is_told);
    told.iter().find(reads).map(|(state, _)| *state)
}

fn replacing(told: &Told) -> Substitution {
    let mut substitution = Substitution::new();
    for (state, value) in told {
        substitution.set(Symbol::State(*state), *value);
    }
    substitution
}

fn report_division(model: &Elaborated, state: usize, diagnostics: &mut Diagnostics) {
    let name = &model.states[state].variable.name;
    let message = format!("the displacement `{name}` divides by zero");
    diagnostics.error(codes::NOT_FINITE, model.states[state].span, message);
}

/// Reports what displacements read and no rate is known of.
fn check_reads(model: &Elaborated, pool: &Pool, diagnostics: &mut Diagnostics) {
    for (_, element, storage) in storages(model) {
        let entries = storage.displacement.as_deref().unwrap_or_default();
        let what = symbols(pool, entries)
            .into_iter()
            .find_map(|symbol| match symbol {
                Symbol::Input(input) => Some(format!("the input `{}`", model.inputs[input].name)),
                Symbol::Signal(_) => Some("an effort or a flow".to_owned()),
                _ => None,
            });
        if let Some(what) = what {
            let name = &element.name;
            let message =
                format!("the displacement of `{name}` reads {what}, whose rate nothing knows");
            let report = error(codes::DISPLACEMENT, place(model, element), message);
            let known = "tell it in terms of states, of positions that components tell, or of `t`";
            diagnostics.report(match model.given_what_moves(name) {
                Some((notes, help)) => notes.iter().fold(report, Diagnostic::note).help(help),
                None => report.help(known),
            });
        }
    }
}

/// Reports displacements that do not change as their storages flow. `rates` are those of all candidate states.
pub fn check(
    model: &Elaborated,
    (scalars, solution): (&Scalars, &Solution),
    rates: &[Expression],
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) {
    let mut told_of = BTreeSet::new();
    for (id, element, storage) in storages(model) {
        let mut entries = storage.displacement.iter().flatten().enumerate();
        let other = entries.find(|(component, value)| {
            let flow = storage_rate(model, scalars, solution, id, *component);
            !changes_by(model, **value, &[flow], rates, pool)
        });
        // A component makes one mistake of what it is given, at all of its storages.
        if let Some((component, _)) = other
            && element.instance().is_none_or(|it| told_of.insert(it))
        {
            let name = &element.name;
            let whose = match storage.coenergy.len() {
                1 => "it".to_owned(),
                size => format!("its component {}", component_name(component, size)),
            };
            let message = format!("the displacement of `{name}` does not change as `{name}` flows");
            let report = error(codes::DISPLACEMENT, place(model, element), message);
            if let Some((notes, help)) = model.given_what_moves(name) {
                let report = notes.iter().fold(report, Diagnostic::note);
                diagnostics.report(report.help(help));
                continue;
            }
            let report = report.note(format!(
                "{whose} has another rate than the flow into `{name}`"
            ));
            let helps = match (element.instance(), outside(model, id, element)) {
                (None, _) => vec![
                    BOND.to_owned(),
                    "or leave `displacement` out: then it is a state".to_owned(),
                ],
                // What a component is given may change by itself.
                (Some(_), None) => vec![
                    "if a length that a component is given changes, give it the rate, too, as `rest_rate` of a `LineForce` \
                     whose `rest` is an integral of that"
                        .to_owned(),
                    BOND.to_owned(),
                ],
                (Some(_), Some(junction)) => {
                    let flow = storage_rate(model, scalars, solution, id, component);
                    vec![changing_with(model, junction, flow, rates, pool)]
                }
            };
            let mut report = report;
            report.helps = helps;
            diagnostics.report(report);
        }
    }
}

const BOND: &str = "bond it where the flow is the rate of what is told";

/// The junction of one component outside of the component in use that an element belongs to, where it is bonded to one.
fn outside<'m>(model: &'m Elaborated, id: ElementId, element: &Element) -> Option<&'m str> {
    let graph = &model.graph;
    let instance = element.instance()?;
    let junction = graph.bonds.iter().find_map(|bond| {
        match [(&bond.from, &bond.to), (&bond.to, &bond.from)]
            .into_iter()
            .find(|(end, _)| matches!(end, End::OnePort(own) if *own == id))?
        {
            (_, End::Junction(junction, _)) => Some(&graph.junctions[junction.0]),
            _ => None,
        }
    })?;
    let inside = junction.name.strip_prefix(instance);
    let is_inside = inside.is_some_and(|rest| rest.starts_with('.'));
    (!is_inside && junction.dimension == 1).then_some(&junction.name)
}

/// What to type where a displacement is not the one whose rate the flow of a junction is: a state that is, such as the angle of a
/// joint, or an integral.
fn changing_with(
    model: &Elaborated,
    junction: &str,
    flow: Expression,
    rates: &[Expression],
    pool: &mut Pool,
) -> String {
    let mut own: Vec<usize> = (0..model.states.len()).collect();
    let told = told(model);
    own.retain(|state| !told.contains_key(state) && rates[*state] != Expression::ZERO);
    // The angle of the joint itself comes first.
    let instance = instance_of(junction);
    own.sort_by_key(|state| instance_of(&model.states[*state].variable.name) != instance);
    let changing = own.into_iter().find(|state| {
        let value = pool.symbol(Symbol::State(*state));
        changes_by(model, value, &[flow], rates, pool)
    });
    match changing {
        Some(state) => {
            let name = &model.states[state].variable.name;
            format!("write `displacement: {name}`, which changes as `{junction}` flows")
        }
        None => {
            let name = format!("{}_way", junction.replace(['.', '[', ']'], "_"));
            format!("declare `integral {name} = {junction}.f;`, and write `displacement: {name}`")
        }
    }
}

fn place(model: &Elaborated, element: &Element) -> Span {
    model.graph.origins.span(element.origin)
}
