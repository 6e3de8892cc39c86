//! Meshes of the junction structure that say something twice: their gain is one (class 5 of van Dijk and Breedveld
//! 1991), so that one equation follows from the others and some variables stay undetermined.

use std::collections::BTreeMap;

use super::floating::report_floating;
use crate::codes;
use crate::compile::text;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::elaborate::Elaborated;
use crate::equations::{Equation, Owner, Scalars};
use crate::symbolic::{Expression, Pool, field};

/// A sum of unknowns over the field, or of equations.
type Combination = BTreeMap<usize, u64>;

/// Reports a part that floats, or else the first mesh of gain one, or else that the structure leaves something
/// undetermined.
pub(super) fn report(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) {
    if report_floating(model, scalars, pool, diagnostics) {
        return;
    }
    let message = "the junction structure leaves efforts or flows undetermined";
    let mut report = error(codes::SINGULAR_JUNCTIONS, model.name.span(), message);
    if let Some(mesh) = all(scalars, is_structure, pool).into_iter().next() {
        let unknowns = mesh
            .iter()
            .flat_map(|row| scalars.equations[*row].terms.keys());
        let mut names: Vec<String> = unknowns
            .map(|unknown| scalars.names[*unknown].clone())
            .filter(|name| !name.is_empty())
            .collect();
        names.sort();
        names.dedup();
        report = report.note(match mesh.len() {
            1 => "one of its equations says nothing: what it is about cancels".to_owned(),
            count if names.is_empty() => format!(
                "{count} of its equations say the same thing twice, about bonds between junctions"
            ),
            count => format!(
                "{count} of its equations say the same thing twice, about {}",
                listing(names)
            ),
        });
        if let Some(gains) = gains(scalars, &mesh) {
            let written = |value| text(model, scalars, pool, value);
            let ratio = |(top, bottom)| match (top, bottom) {
                (top, Expression::ONE) => written(top),
                (top, bottom) => format!("{} / ({})", written(top), written(bottom)),
            };
            let gains: Vec<String> = gains.into_iter().map(ratio).collect();
            report = report.note(format!(
                "they form a mesh whose gain is one: {}",
                gains.join(" · ")
            ));
        }
        report =
            report.help("take one bond of the mesh away: what it says follows from the others");
    }
    diagnostics.report(report);
}

/// Whether an equation is that of a junction or a two-port.
pub(super) fn is_structure(equation: &Equation) -> bool {
    equation.owner == Owner::Structure
}

/// For each of these rows that is a combination of others, the equations of all of them, itself included.
pub(super) fn all(
    scalars: &Scalars,
    counts: impl Fn(&Equation) -> bool,
    pool: &Pool,
) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    let mut leads: BTreeMap<usize, (Combination, Combination)> = BTreeMap::new();
    let equations = scalars.equations.iter().enumerate();
    for (number, equation) in equations.filter(|(_, it)| counts(it)) {
        let image = |(unknown, value): (&usize, &Expression)| (*unknown, pool.image(*value).0[0]);
        let mut row: Combination = equation.terms.iter().map(image).collect();
        let mut origin = Combination::from([(number, 1)]);
        while let Some((&lead, &value)) = row.first_key_value() {
            let Some((pivot, from)) = leads.get(&lead) else {
                break;
            };
            let factor = field::multiply(value, field::invert(pivot[&lead]).unwrap_or(0));
            subtract(&mut row, pivot, factor);
            subtract(&mut origin, from, factor);
        }
        match row.first_key_value() {
            Some((&lead, _)) => drop(leads.insert(lead, (row, origin))),
            None => found.push(origin.into_keys().collect()),
        }
    }
    found
}

fn subtract(row: &mut Combination, other: &Combination, factor: u64) {
    for (unknown, value) in other {
        let known = row.get(unknown).copied().unwrap_or(0);
        match field::subtract(known, field::multiply(factor, *value)) {
            0 => drop(row.remove(unknown)),
            rest => drop(row.insert(*unknown, rest)),
        }
    }
}

/// The ratios along a mesh in which every equation joins two variables, without those that are one.
fn gains(scalars: &Scalars, mesh: &[usize]) -> Option<Vec<(Expression, Expression)>> {
    let mut left: Vec<&BTreeMap<usize, Expression>> = mesh
        .iter()
        .map(|row| &scalars.equations[*row].terms)
        .collect();
    let mut current = *left.first()?.first_key_value()?.0;
    let mut gains = Vec::new();
    while let Some(position) = left.iter().position(|terms| terms.contains_key(&current)) {
        let terms = left.swap_remove(position);
        let mut others = terms.iter().filter(|(unknown, _)| **unknown != current);
        let ((next, coefficient), None) = (others.next()?, others.next()) else {
            return None;
        };
        // `c x + d y = 0` is `y = −(c/d) x`.
        let negative = coefficient.is_negative();
        let gain = (
            terms[&current].negated().flipped(negative),
            coefficient.flipped(negative),
        );
        if gain.0 != gain.1 {
            gains.push(gain);
        }
        current = *next;
    }
    (left.is_empty() && !gains.is_empty()).then_some(gains)
}
