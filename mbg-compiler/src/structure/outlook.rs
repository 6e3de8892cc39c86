//! What becomes of a model whose storages depend on each other, tried out.

use super::{Formulation, resolve, solve};
use crate::causality::outlook::Outlook;
use crate::diagnostics::Diagnostics;
use crate::elaborate::Elaborated;
use crate::equations;
use crate::network::Network;
use crate::symbolic::Pool;

/// What is told once every storage is marked `#[derivative]`.
#[must_use]
pub fn outlook(model: &Elaborated, pool: &Pool) -> Outlook {
    let (mut model, mut pool) = (model.clone(), pool.clone());
    for element in &mut model.graph.elements {
        element.derivative = true;
    }
    let network = Network::of(&model.graph, &mut pool);
    let scalars = equations::form(&model, &network, &mut pool);
    let first = solve(&scalars, Formulation::Articulated, &mut pool);
    let mut told = Diagnostics::new();
    let solved = resolve(&mut model, scalars, first, &mut pool, &mut told);
    match told.list() {
        [first, ..] if solved.is_none() => Outlook::Refused(Box::new(first.clone())),
        _ => Outlook::Acceptable,
    }
}
