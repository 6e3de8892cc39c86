//! Laws of storages that are no states, solved for their momenta and displacements.

use crate::elaborate::{Condition, Elaborated};
use crate::graph::{ElementId, Law};
use crate::symbolic::{Expression, Matrix, Pool, Symbol, linear_part};

/// A storage's linear law `p = J (y − y₀)`, without entries for components that stay states beside it.
pub(super) struct Inverse {
    /// J.
    pub(super) matrix: Matrix,
    /// y₀.
    pub(super) offset: Vec<Expression>,
}

/// The inverse of a whole law.
pub(super) fn inverse(model: &Elaborated, pool: &mut Pool, id: ElementId) -> Option<Inverse> {
    let Law::Storage(storage) = &model.graph.elements[id.0].law else {
        return None;
    };
    let components: Vec<usize> = (0..storage.coenergy.len()).collect();
    inverse_in(model, pool, id, &components)
}

/// The inverse of a law in some components, in which it must be linear. Others are states still and may enter as they
/// like: the charge of a condenser follows from its voltage whatever the way of the plates does to it.
pub(super) fn inverse_in(
    model: &Elaborated,
    pool: &mut Pool,
    id: ElementId,
    components: &[usize],
) -> Option<Inverse> {
    let Law::Storage(storage) = &model.graph.elements[id.0].law else {
        return None;
    };
    let own: Vec<Symbol> = components
        .iter()
        .map(|component| Symbol::State(storage.states.start + component))
        .collect();
    let rows: Vec<Expression> = components.iter().map(|it| storage.coenergy[*it]).collect();
    let (matrix, rests) = linear_part(pool, &rows, &own)?;
    let inverted = matrix.inverse(pool)?;
    let size = storage.coenergy.len();
    let mut matrix = Matrix::new(size, size, vec![Expression::ZERO; size * size]);
    let mut offset = vec![Expression::ZERO; size];
    for (row, component) in components.iter().enumerate() {
        offset[*component] = rests[row];
        for (column, other) in components.iter().enumerate() {
            matrix.entries[component * size + other] = inverted.at(row, column);
        }
    }
    Some(Inverse { matrix, offset })
}

/// Whether a law is positive definite for all parameters that `new` accepts: its leading principal minors are positive
/// constants, or assumed positive.
pub(super) fn is_definite(model: &Elaborated, matrix: &Matrix, pool: &mut Pool) -> bool {
    let assumed = |expression: Expression| {
        model
            .assumptions
            .iter()
            .any(|known| known.expression == expression && known.condition == Condition::Positive)
    };
    (1..=matrix.rows).all(|size| {
        let minor = if matrix.is_diagonal() {
            matrix.at(size - 1, size - 1)
        } else {
            matrix.leading(size).determinant(pool)
        };
        match pool.constant_value(minor) {
            Some(value) => value > 0.0,
            None => assumed(minor),
        }
    })
}
