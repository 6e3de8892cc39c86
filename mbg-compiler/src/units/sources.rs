//! Sources of flow that are given a position, such as the height of a road: the slip of which all units beside tell, far from it.

use std::collections::BTreeMap;

use super::dimension::Dimension;
use super::report::unit_text;
use super::{checked, expression_text, names, second};
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::elaborate::Elaborated;
use crate::elaborate::claims::{Claim, Claims, Subject};
use crate::graph::{BondGraph, ElementId, ElementKind, End};
use crate::symbolic::{Operation, Pool, Symbol};

/// What to tell in the place of all else where units agree as soon as one source says nothing, and what it is given is the flow
/// there times a second.
pub(super) fn report(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
) -> Option<Diagnostic> {
    let mut sources = claims.list.iter().enumerate();
    sources.find_map(|(position, claim)| {
        let id = source(model, claim)?;
        let given = match pool.operation(claim.entries[0].magnitude()) {
            Operation::Symbol(symbol) => declared.get(symbol)?,
            _ => return None,
        };
        let mut others = claims.clone();
        others.list.remove(position);
        let mut told = Diagnostics::new();
        let units = checked(
            model,
            &others,
            pool,
            declared.clone(),
            &Default::default(),
            &mut told,
        );
        let (junction, component) = at(&model.graph, id)?;
        let flow = &units.get(junction).filter(|_| component == 0)?[1];
        if told.any() || !flow.is_known() || given.over(flow) != second() {
            return None;
        }
        let path = &model.graph.elements[id.0].name;
        let name = path.rsplit('.').next().unwrap_or(path);
        let message = format!(
            "`flow` of `{name}` must be {} here, and this is {}",
            unit_text(flow),
            unit_text(given)
        );
        let value = expression_text(model, claims, pool, claim.entries[0]);
        let help = format!(
            "a source of flow is given the rate of what moves: in the place of `{value}` declare its rate, such as `input \
             {name}_rate: {};`, and write `flow: {name}_rate`",
            names::text(flow)
        );
        let report = error(codes::UNIT_MISMATCH, claim.place.span, message);
        Some(report.help(help))
    })
}

/// A source of flow of the user with one number.
fn source(model: &Elaborated, claim: &Claim) -> Option<ElementId> {
    let Subject::Word(id, _) = &claim.subject else {
        return None;
    };
    let is_plain = claim.entries.len() == 1 && claim.place.library.is_none();
    let is_source = model.graph.elements[id.0].kind == ElementKind::Sf;
    (is_plain && is_source).then_some(*id)
}

/// The junction at which an element stands, and the first of its components there.
fn at(graph: &BondGraph, id: ElementId) -> Option<(usize, usize)> {
    graph.bonds.iter().find_map(|bond| {
        match [(&bond.from, &bond.to), (&bond.to, &bond.from)]
            .into_iter()
            .find(|(end, _)| matches!(end, End::OnePort(own) if *own == id))?
        {
            (_, End::Junction(junction, range)) => Some((junction.0, range.start)),
            _ => None,
        }
    })
}
