//! Stage 5c, Jacobians: entry by entry, or where these would be long, by sweeps.
//!
//! Input: the rates of the states. Output: a [`Request`] to the program, and where the Jacobian can differ from zero. Written
//! out, every entry has the structural zeros of its column and needs no multiplication by one; but code that runs only
//! once is read from memory as slowly as it is long. So from a certain length on there are [sweeps](crate::sweeps): one list of
//! steps is run for as many directions at once as the scalar has lanes, until all columns or rows are there.

use crate::elaborate::{Elaborated, StateRate};
use crate::graph::ElementKind;
use crate::program::{Request, Slopes};
use crate::sparsity::{self, Pattern};
use crate::sweeps::Wanted;
use crate::symbolic::substitute::operations;
use crate::symbolic::{Dependence, Expression, Pool, Symbol, jacobian};

/// Largest product of variables and operations of the derivative up to which a Jacobian is written out without a
/// comparison.
const SHORT: usize = 8_000;

/// Largest number of pairs of an operation and a variable that it depends on up to which it may be written out at all.
const LONGEST: usize = 16_000;

/// The derivative of `rates` by `variables`; written out, its entries follow by rows what `before` it is returned.
pub fn request(
    pool: &mut Pool,
    before: &[Expression],
    rates: &[Expression],
    variables: &[Symbol],
    groups: &[Vec<usize>],
) -> (Request, Pattern) {
    let own = operations(pool, rates);
    if variables.len() * own <= SHORT {
        return written_out(pool, before, rates, variables);
    }
    let dependence = Dependence::of(pool, rates, variables);
    let rows = |rate: &Expression| dependence.places(*rate).collect();
    let pattern: Pattern = rates.iter().map(rows).collect();
    let wanted = Wanted {
        rates,
        variables,
        pattern: &pattern,
    };
    let sweeps = cheapest(pool, &wanted, groups);
    if dependence.pairs() <= LONGEST {
        let together = wanted.steps(pool, &sweeps);
        let written = written_out(pool, before, rates, variables);
        if wanted.beside(pool, &written.0.results) <= together {
            return written;
        }
    }
    let results = before.to_vec();
    (Request { results, sweeps }, pattern)
}

/// Sweeps forwards for each group of variables, or one backwards, whichever take less.
fn cheapest(pool: &mut Pool, wanted: &Wanted, groups: &[Vec<usize>]) -> Vec<Slopes> {
    let mut other = pool.clone();
    let forward = groups.iter().map(|group| wanted.forward(pool, group));
    let forward: Vec<Slopes> = forward.collect();
    let Some(reverse) = wanted.reverse(&mut other) else {
        return forward;
    };
    let reverse = vec![reverse];
    if wanted.changing_steps(&other, &reverse) < wanted.changing_steps(pool, &forward) {
        *pool = other;
        return reverse;
    }
    forward
}

/// Entry by entry.
fn written_out(
    pool: &mut Pool,
    before: &[Expression],
    rates: &[Expression],
    variables: &[Symbol],
) -> (Request, Pattern) {
    let entries = jacobian(pool, rates, variables).entries;
    let pattern = sparsity::of_entries(&entries, variables.len());
    (Request::from([before, &entries].concat()), pattern)
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
