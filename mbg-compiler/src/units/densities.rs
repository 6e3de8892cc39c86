//! Laws per area or per volume: a voltage times a current per area is no power, though all their units agree.

use std::collections::BTreeMap;

use super::dimension::Dimension;
use super::report::unit_text;
use super::{Otherwise, checked, pseudo, watt};
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::elaborate::Elaborated;
use crate::elaborate::claims::Claims;
use crate::graph::JunctionId;
use crate::symbolic::{Pool, Symbol};

/// What to tell in the place of all else where units agree as soon as such junctions are marked.
pub(super) fn report(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
) -> Option<Diagnostic> {
    let graph = &model.graph;
    let all: Vec<JunctionId> = (0..graph.junctions.len()).map(JunctionId).collect();
    let units = agreeing(model, claims, pool, declared, &all)?;
    let dense = all.into_iter().zip(&units).filter(|(id, [effort, flow])| {
        let power = effort.times(flow).over(&watt());
        !graph.junctions[id.0].pseudo
            && [[0, -2, 0, 0, 0, 0, 0], [0, -3, 0, 0, 0, 0, 0]]
                .iter()
                .any(|per| power == Dimension::of(*per))
    });
    let (dense, units): (Vec<JunctionId>, Vec<&[Dimension; 2]>) = dense.unzip();
    let (first, [effort, flow]) = (*dense.first()?, *units.first()?);
    let advice = pseudo::advice(graph, &dense)?;
    agreeing(
        model,
        claims,
        pool,
        declared,
        &pseudo::joined(graph, &dense),
    )?;
    let junction = &graph.junctions[first.0];
    let message = format!(
        "the effort of `{}` is {} and its flow {}: their product is no power",
        junction.name,
        unit_text(effort),
        unit_text(flow)
    );
    let span = graph.origins.span(junction.origin);
    Some(error(codes::UNIT_MISMATCH, span, message).help(advice))
}

/// Efforts and flows of the junctions with these marked as those of pseudo bonds; none if units do not agree then.
fn agreeing(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
    marked: &[JunctionId],
) -> Option<Vec<[Dimension; 2]>> {
    let mut model = model.clone();
    for id in marked {
        model.graph.junctions[id.0].pseudo = true;
    }
    let mut told = Diagnostics::new();
    let as_written = Otherwise::default();
    let units = checked(
        &model,
        claims,
        pool,
        declared.clone(),
        &as_written,
        &mut told,
    );
    (!told.any()).then_some(units)
}
