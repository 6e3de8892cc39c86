//! Momenta at the start, from the flows that coordinates are given there.
//!
//! Where the momenta of bodies are independent they are the states, and the rate of a joint between them follows. With
//! time zero, no inputs and all else at its start, flows are affine in momenta of linear laws, so that the momenta which
//! give the flows solve linear equations, as many as there are coordinates. Nothing is changed where a momentum was
//! given itself, where a law is not linear, or where there is no single solution.

use std::collections::{BTreeMap, BTreeSet};

use super::eliminate::System;
use super::{Solved, blocks, matching};
use crate::elaborate::{Assumption, Condition, Elaborated, StateRate};
use crate::graph::ElementKind;
use crate::start::Start;
use crate::symbolic::dense::{ADJUGATE, dense};
use crate::symbolic::differentiate::jacobian;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Matrix, Pool, Substitution, Symbol};

/// A flow that is given for the start and depends on momenta that are not.
struct Wanted {
    flow: Expression,
    given: Expression,
    momenta: BTreeSet<usize>,
}

/// Gives the momenta among the `states` a start with which flows are what they are said to be.
pub fn starting_momenta(
    model: &mut Elaborated,
    solved: &Solved,
    states: &[usize],
    pool: &mut Pool,
) {
    for block in connected(wanted(model, solved, states, pool)) {
        let momenta = block.iter().flat_map(|it| it.momenta.iter().copied());
        let momenta: Vec<usize> = momenta.collect::<BTreeSet<_>>().into_iter().collect();
        if is_met(model, &block, pool) {
            continue;
        }
        let Some((starts, divisors)) = solution(model, &block, &momenta, pool) else {
            continue;
        };
        for (state, start) in momenta.into_iter().zip(starts) {
            model.states[state].initial = start;
        }
        model
            .assumptions
            .extend(divisors.into_iter().map(|expression| Assumption {
                expression,
                condition: Condition::NonZero,
                reason: "momenta at the start are divided by it".to_owned(),
            }));
    }
}

fn wanted(model: &Elaborated, solved: &Solved, states: &[usize], pool: &Pool) -> Vec<Wanted> {
    let is_momentum = |state: &usize| {
        let state = &model.states[*state];
        let is_stored = matches!(state.rate, StateRate::Storage(id, _) if model.graph.elements[id.0].kind == ElementKind::I);
        is_stored && !state.is_given
    };
    let free: BTreeSet<usize> = states.iter().copied().filter(is_momentum).collect();
    let junctions = model.graph.junctions.iter().zip(&solved.scalars.common);
    let given = junctions.flat_map(|(junction, flows)| junction.initial_flow.iter().zip(flows));
    let wanted = given.map(|(given, flow)| {
        let flow = solved.solution.values[*flow];
        let read = symbols(pool, &[flow]).into_iter();
        let momenta = read.filter_map(|symbol| match symbol {
            Symbol::State(state) if free.contains(&state) => Some(state),
            _ => None,
        });
        Wanted {
            flow,
            given: *given,
            momenta: momenta.collect(),
        }
    });
    wanted.filter(|it| !it.momenta.is_empty()).collect()
}

/// Those that share momenta, together.
fn connected(wanted: Vec<Wanted>) -> Vec<Vec<Wanted>> {
    let mut blocks: Vec<Vec<Wanted>> = Vec::new();
    for flow in wanted {
        let shares = |block: &mut Vec<Wanted>| {
            let mut others = block.iter();
            others.any(|it| !it.momenta.is_disjoint(&flow.momenta))
        };
        let mut block: Vec<Wanted> = blocks.extract_if(.., shares).flatten().collect();
        block.push(flow);
        blocks.push(block);
    }
    blocks
}

/// Whether nothing moves, as it should: with default parameters and with others, since a default may be zero.
fn is_met(model: &Elaborated, block: &[Wanted], pool: &Pool) -> bool {
    let rests = |parameters: Vec<f64>| {
        let start = Start::with(model, parameters, pool);
        block.iter().all(|it| start.value(pool, it.flow) == 0.0)
    };
    let defaults = model.parameters.iter().map(|it| it.default);
    let others = defaults.clone().enumerate();
    let others = others.map(|(number, value)| value + 0.1 + 0.01 * number as f64);
    block.iter().all(|it| it.given == Expression::ZERO)
        && rests(defaults.collect())
        && rests(others.collect())
}

/// Linear equations that momenta solve.
struct Equations {
    rows: Vec<BTreeMap<usize, Expression>>,
    right: Vec<Expression>,
}

/// The momenta, and what was divided by; none if they are not the only solution of linear equations, or if more of them
/// depend on each other than have a solution by determinants.
fn solution(
    model: &Elaborated,
    block: &[Wanted],
    momenta: &[usize],
    pool: &mut Pool,
) -> Option<(Vec<Expression>, Vec<Expression>)> {
    let Equations { rows, mut right } = equations(model, block, momenta, pool)?;
    let incidence: Vec<Vec<usize>> = rows
        .iter()
        .map(|row| row.keys().copied().collect())
        .collect();
    let column_of = matching::perfect(&incidence, momenta.len())?;
    let mut values = vec![Expression::ZERO; momenta.len()];
    let mut divisors = Vec::new();
    for own in blocks::ordered(&incidence, &column_of) {
        let columns: Vec<usize> = own.iter().map(|row| column_of[*row]).collect();
        let mut entries = Vec::with_capacity(own.len() * own.len());
        for row in &own {
            for (column, slope) in rows[*row].iter().filter(|it| !columns.contains(it.0)) {
                let product = pool.multiply(*slope, values[*column]);
                right[*row] = pool.subtract(right[*row], product);
            }
            let entry = |column| rows[*row].get(column).copied().unwrap_or(Expression::ZERO);
            entries.extend(columns.iter().map(entry));
        }
        let matrix = Matrix::new(own.len(), own.len(), entries);
        let wanted: Vec<Expression> = own.iter().map(|row| right[*row]).collect();
        let (found, divisor) = whole(pool, &matrix, wanted)?;
        for (column, value) in columns.iter().zip(found) {
            values[*column] = value;
        }
        divisors.push(divisor);
    }
    Some((values, divisors))
}

/// Solves what depends on each other by constant pivots and a determinant, which alone may vanish for some parameters.
fn whole(
    pool: &mut Pool,
    matrix: &Matrix,
    right: Vec<Expression>,
) -> Option<(Vec<Expression>, Expression)> {
    let mut system = System::of(matrix, right);
    let all: BTreeSet<usize> = (0..system.size()).collect();
    system
        .eliminate_constants(pool, &all, &all, &|_, _| true)
        .ok()?;
    let (columns, rest, right) = system.rest();
    if columns.len() > ADJUGATE {
        return None;
    }
    let mut divisor = Expression::ONE;
    let values = match columns.len() {
        0 => Vec::new(),
        _ => dense(pool, &rest, &right, &mut divisor)?,
    };
    let values = system.back_substitute(pool, &columns, &values).ok()?;
    Some((values, divisor))
}

/// The equations at the start; none if they are not linear.
fn equations(
    model: &Elaborated,
    block: &[Wanted],
    momenta: &[usize],
    pool: &mut Pool,
) -> Option<Equations> {
    let flows: Vec<Expression> = block.iter().map(|it| it.flow).collect();
    let read = symbols(pool, &flows);
    if read.iter().any(|it| matches!(it, Symbol::Unknown(_))) {
        return None;
    }
    let by: Vec<Symbol> = momenta.iter().copied().map(Symbol::State).collect();
    let slopes = jacobian(pool, &flows, &by).entries;
    if symbols(pool, &slopes).iter().any(|it| by.contains(it)) {
        return None;
    }
    let mut at_start = at_start(model, momenta, &read);
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    for (wanted, slopes) in block.iter().zip(slopes.chunks(momenta.len())) {
        let mut row = BTreeMap::new();
        for (column, slope) in slopes.iter().enumerate() {
            row.insert(column, at_start.apply(pool, *slope)?);
        }
        row.retain(|_, slope| *slope != Expression::ZERO);
        rows.push(row);
        let without = at_start.apply(pool, wanted.flow)?;
        right.push(pool.subtract(wanted.given, without));
    }
    Some(Equations { rows, right })
}

/// Puts everything at its start, and these momenta at zero.
fn at_start(model: &Elaborated, momenta: &[usize], read: &[Symbol]) -> Substitution {
    let mut substitution = Substitution::new();
    for symbol in read {
        let value = match symbol {
            Symbol::State(state) if !momenta.contains(state) => model.states[*state].initial,
            Symbol::State(_) | Symbol::Input(_) | Symbol::Time => Expression::ZERO,
            _ => continue,
        };
        substitution.set(*symbol, value);
    }
    substitution
}
