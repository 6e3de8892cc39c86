//! Transformers that should be gyrators, or the other way round, and laws that should be their inverses: the slips of which all
//! units behind a converter tell, far from it.

use std::collections::BTreeMap;

use proc_macro2::Span;

use super::dimension::Dimension;
use super::{Inverted, Otherwise, checked, expression_text, is_two_port};
use crate::diagnostics::Diagnostics;
use crate::elaborate::Elaborated;
use crate::elaborate::claims::{Claim, Claims, Subject};
use crate::graph::{ElementId, ElementKind};
use crate::symbolic::{Expression, Operation, Pool, Symbol};
use crate::syntax::words::{element_name, law_words};

/// How many converters are tried: each is the model once more.
const TRIED: usize = 32;

/// What to type where units agree as soon as one converter is another one; nothing where more than two would do, since none of
/// them is likely then.
pub(super) fn advice(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
) -> Vec<String> {
    let written = converters(model, claims);
    if written.len() > TRIED {
        return Vec::new();
    }
    let agrees = |trial: &Elaborated, inverted: &Inverted| {
        let mut told = Diagnostics::new();
        let otherwise = Otherwise {
            inverted: inverted.clone(),
            ..Otherwise::default()
        };
        checked(trial, claims, pool, declared.clone(), &otherwise, &mut told);
        !told.any()
    };
    let mut found = Vec::new();
    for (claim, ids) in &written {
        let swapped = swapped(model, ids);
        let inverted: Inverted = ids.iter().copied().collect();
        let kind = swapped.graph.elements[ids[0].0].kind;
        for (trial, inverted, kind) in [
            (model, &inverted, None),
            (&swapped, &Inverted::default(), Some(kind)),
            (&swapped, &inverted, Some(kind)),
        ] {
            if agrees(trial, inverted) {
                let path = &model.graph.elements[ids[0].0].name;
                let name = path.rsplit('.').next().unwrap_or(path);
                let is_inverse = !inverted.is_empty();
                let value = value(model, claims, pool, claim.entries[0], is_inverse);
                let kind = kind.unwrap_or(model.graph.elements[ids[0].0].kind);
                let (kind, law) = (element_name(kind), law_words(kind)[0]);
                found.push(format!(
                    "all units agree with `{kind} {name} {{ {law}: {value} }}`"
                ));
            }
        }
    }
    if found.len() > 2 {
        return Vec::new();
    }
    found
}

/// Two-ports of the user with a law of one entry, those together that a loop repeats.
fn converters<'a>(model: &Elaborated, claims: &'a Claims) -> Vec<(&'a Claim, Vec<ElementId>)> {
    let mut written: Vec<(&Claim, Vec<ElementId>)> = Vec::new();
    let place = |span: Span| format!("{span:?}");
    for claim in &claims.list {
        let Subject::Word(id, _) = &claim.subject else {
            continue;
        };
        let is_scalar = claim.entries.len() == 1 && claim.place.library.is_none();
        if !is_scalar || !is_two_port(&model.graph, *id) {
            continue;
        }
        let same = |it: &&mut (&Claim, _)| place(it.0.place.span) == place(claim.place.span);
        match written.iter_mut().find(same) {
            Some((_, ids)) => ids.push(*id),
            None => written.push((claim, vec![*id])),
        }
    }
    written
}

/// The model with these transformers as gyrators, or the other way round.
fn swapped(model: &Elaborated, ids: &[ElementId]) -> Elaborated {
    let mut model = model.clone();
    for id in ids {
        let kind = &mut model.graph.elements[id.0].kind;
        *kind = match kind {
            ElementKind::TF => ElementKind::GY,
            ElementKind::MTF => ElementKind::MGY,
            ElementKind::GY => ElementKind::TF,
            _ => ElementKind::MTF,
        };
    }
    model
}

/// A law or its inverse, as it is typed; what is no name alone stands as `…`.
fn value(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    law: Expression,
    is_inverse: bool,
) -> String {
    let text = |it| expression_text(model, claims, pool, it);
    let is_name = |text: &str| {
        text.chars()
            .all(|it| it.is_alphanumeric() || "_.[]".contains(it))
    };
    let law_text = text(law);
    if !is_inverse {
        return match is_name(&law_text) {
            true => law_text,
            false => "…".to_owned(),
        };
    }
    if let Operation::Divide(one, divisor) = pool.operation(law.magnitude())
        && !law.is_negative()
        && ["1", "1.0"].contains(&text(*one).as_str())
        && is_name(&text(*divisor))
    {
        return text(*divisor);
    }
    match is_name(&law_text) {
        true => format!("1 / {law_text}"),
        false => "1 / (…)".to_owned(),
    }
}
