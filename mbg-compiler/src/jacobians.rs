//! Stage 5c, Jacobians: entry by entry, or where these would be long, what several columns at once are worked out from.
//!
//! Input: the rates of the states. Output: a [`Request`] to the program, and where the Jacobian can differ from zero. Written
//! out, every entry has the structural zeros of its column and needs no multiplication by one; but code that runs only
//! once is read from memory as slowly as it is long. So from a certain length on there is one list of steps for any
//! direction in which variables change: one alone, or several of which no two are in one rate. It is run for as many
//! directions at once as the scalar has lanes, until all columns are there.

use std::collections::BTreeMap;

use crate::bits::Bits;
use crate::elaborate::{Elaborated, StateRate};
use crate::graph::ElementKind;
use crate::program::{Column, Direction, Request, Slopes};
use crate::sparsity::{self, Pattern};
use crate::symbolic::substitute::operations;
use crate::symbolic::{Dependence, Differentiator, Expression, Pool, Symbol, jacobian};

/// Largest product of variables and operations of the derivative up to which a Jacobian is written out without a
/// comparison.
const SHORT: usize = 8_000;

/// Largest number of pairs of an operation and a variable that it depends on up to which it may be written out at all.
const LONGEST: usize = 16_000;

/// As many directions at once take as long as one step of a long code that is written out: what columns read is kept in
/// memory. Measured on arms, walkers and chains for AVX2 and AVX-512.
const TOGETHER: usize = 4;

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
    let columns = groups.iter().map(|group| Slopes {
        directions: directions(&pattern, group),
        rates: slopes(pool, rates, variables, group),
    });
    let columns: Vec<Slopes> = columns.collect();
    if dependence.pairs() <= LONGEST {
        let beside =
            |pool: &Pool, others: &[Expression]| operations(pool, &[rates, others].concat()) - own;
        let passes = |it: &Slopes| it.directions.len().div_ceil(TOGETHER);
        let together = columns
            .iter()
            .map(|it| passes(it) * beside(pool, &it.rates));
        let together: usize = together.sum();
        let written = written_out(pool, before, rates, variables);
        if beside(pool, &written.0.results) <= together {
            return written;
        }
    }
    let results = before.to_vec();
    (Request { results, columns }, pattern)
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

/// Columns that share no row, together: each goes with the first with which it can (Curtis, Powell and Reid, *J. Inst. Maths
/// Applics* 13 (1974), 117–119).
fn directions(pattern: &Pattern, variables: &[usize]) -> Vec<Direction> {
    let mut directions: Vec<(Bits, Direction)> = Vec::new();
    for variable in variables.iter().copied() {
        let rows = 0..pattern.len();
        let rows: Vec<usize> = rows
            .filter(|row| pattern[*row].contains(&variable))
            .collect();
        let own: Bits = rows.iter().copied().collect();
        let column = Column { variable, rows };
        match directions.iter_mut().find(|(taken, _)| !taken.meets(&own)) {
            Some((taken, direction)) => {
                taken.join(&own);
                direction.push(column);
            }
            None => directions.push((own, vec![column])),
        }
    }
    directions
        .into_iter()
        .map(|(_, direction)| direction)
        .collect()
}

/// How rates change where only some of the variables do.
fn slopes(
    pool: &mut Pool,
    rates: &[Expression],
    variables: &[Symbol],
    changing: &[usize],
) -> Vec<Expression> {
    let direction = changing.iter();
    let direction: BTreeMap<Symbol, Expression> = direction
        .map(|place| (variables[*place], pool.symbol(Symbol::Slope(*place))))
        .collect();
    let mut differentiator = Differentiator::along(direction);
    let rates = rates.iter();
    rates
        .map(|rate| differentiator.derivative(pool, *rate))
        .collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn variables(directions: &[Direction]) -> Vec<Vec<usize>> {
        let of = |direction: &Direction| direction.iter().map(|it| it.variable).collect();
        directions.iter().map(of).collect()
    }

    #[test]
    fn neighbours_in_a_row_change_alone() {
        let row = |k: usize| (k.saturating_sub(1)..(k + 2).min(7)).collect();
        let pattern: Pattern = (0..7).map(row).collect();
        let found = directions(&pattern, &[0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(variables(&found), [vec![0, 3, 6], vec![1, 4], vec![2, 5]]);
        assert_eq!(found[0][1].rows, [2, 3, 4]);
        assert_eq!(
            variables(&directions(&pattern, &[1, 2, 5])),
            [vec![1, 5], vec![2]]
        );
    }
}
