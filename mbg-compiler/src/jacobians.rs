//! Stage 5c, Jacobians: entry by entry, or where these would be long, what several columns at once are worked out from.
//!
//! Input: the rates of the states. Output: a [`Request`] to the program. Written out, every entry has the structural
//! zeros of its column and needs no multiplication by one; but code that runs only once is read from memory as slowly as
//! it is long. So from a certain length on there is one list of steps for any direction in which variables change. It
//! is run for as many columns at once as the scalar has lanes, until all columns are there.

use std::collections::BTreeMap;

use crate::elaborate::{Elaborated, StateRate};
use crate::graph::ElementKind;
use crate::program::{Request, Slopes};
use crate::symbolic::substitute::operations;
use crate::symbolic::{Differentiator, Expression, Pool, Symbol, jacobian};

/// Largest product of variables and operations of the derivative up to which a Jacobian is written out.
const WRITTEN_OUT: usize = 8_000;

/// The derivative of `rates` by `variables`; written out, its entries follow by rows what `before` it is returned.
pub fn request(
    pool: &mut Pool,
    before: &[Expression],
    rates: &[Expression],
    variables: &[Symbol],
    groups: &[Vec<usize>],
) -> Request {
    if variables.len() * operations(pool, rates) <= WRITTEN_OUT {
        let entries = jacobian(pool, rates, variables).entries;
        return Request::from([before, &entries].concat());
    }
    let columns = groups.iter();
    Request {
        results: before.to_vec(),
        columns: columns
            .map(|group| slopes(pool, rates, variables, group))
            .collect(),
    }
}

/// How rates change where only some of the variables do.
fn slopes(
    pool: &mut Pool,
    rates: &[Expression],
    variables: &[Symbol],
    changing: &[usize],
) -> Slopes {
    let direction = changing.iter();
    let direction: BTreeMap<Symbol, Expression> = direction
        .map(|place| (variables[*place], pool.symbol(Symbol::Slope(*place))))
        .collect();
    let mut differentiator = Differentiator::along(direction);
    let rates = rates.iter();
    Slopes {
        variables: changing.to_vec(),
        rates: rates
            .map(|rate| differentiator.derivative(pool, *rate))
            .collect(),
    }
}

/// The places of displacements and those of all other states. What displacements change is long, since everything turns
/// with them; by momenta and rates it is short.
#[must_use]
pub fn groups(model: &Elaborated, states: &[usize]) -> Vec<Vec<usize>> {
    let displacement = |place: &usize| match model.states[states[*place]].rate {
        StateRate::Storage(id, _) => model.graph.elements[id.0].kind == ElementKind::C,
        StateRate::Expression(_) => true,
        StateRate::Unknown(_) => false,
    };
    let (displacements, others): (Vec<usize>, Vec<usize>) =
        (0..states.len()).partition(displacement);
    let groups = [displacements, others].into_iter();
    groups.filter(|group| !group.is_empty()).collect()
}
