//! Momenta at the start, from the flows that coordinates are given there.
//!
//! Where the momenta of bodies are independent they are the states, and the rate of a joint between them follows. With
//! time zero, no inputs and all else at its start, flows are affine in momenta of linear laws, so that the momenta which
//! give the flows solve linear equations, as many as there are coordinates. Nothing is changed where a momentum was
//! given itself, where a law is not linear, or where there is no single solution.

use std::collections::{BTreeMap, BTreeSet};

use super::Solved;
use super::eliminate::System;
use crate::elaborate::{Elaborated, StateRate};
use crate::graph::ElementKind;
use crate::start::Start;
use crate::symbolic::differentiate::jacobian;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Pool, Rate, Substitution, Symbol};

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
    for block in blocks(wanted(model, solved, states, pool)) {
        let momenta = block.iter().flat_map(|it| it.momenta.iter().copied());
        let momenta: Vec<usize> = momenta.collect::<BTreeSet<_>>().into_iter().collect();
        if is_met(model, &block, pool) {
            continue;
        }
        let starts = solution(model, &block, &momenta, pool).unwrap_or_default();
        for (state, start) in momenta.into_iter().zip(starts) {
            model.states[state].initial = start;
        }
    }
}

fn wanted(model: &Elaborated, solved: &Solved, states: &[usize], pool: &Pool) -> Vec<Wanted> {
    let is_momentum = |state: &usize| {
        let state = &model.states[*state];
        let is_stored = matches!(state.rate, StateRate::Storage(id, _) if model.graph.elements[id.0].kind == ElementKind::I);
        is_stored && state.initial == Expression::ZERO
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
fn blocks(wanted: Vec<Wanted>) -> Vec<Vec<Wanted>> {
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

/// Whether nothing moves, as it should.
fn is_met(model: &Elaborated, block: &[Wanted], pool: &Pool) -> bool {
    let start = Start::of(model, pool);
    let rests = |it: &Wanted| it.given == Expression::ZERO && start.value(pool, it.flow) == 0.0;
    block.iter().all(rests)
}

/// The momenta; none if they are not the only solution of linear equations.
fn solution(
    model: &Elaborated,
    block: &[Wanted],
    momenta: &[usize],
    pool: &mut Pool,
) -> Option<Vec<Expression>> {
    let flows: Vec<Expression> = block.iter().map(|it| it.flow).collect();
    let read = symbols(pool, &flows);
    if block.len() != momenta.len() || read.iter().any(|it| matches!(it, Symbol::Unknown(_))) {
        return None;
    }
    let by: Vec<Symbol> = momenta.iter().copied().map(Symbol::State).collect();
    let slopes = jacobian(pool, &flows, &by).entries;
    let is_linear = symbols(pool, &slopes).iter().all(|it| !by.contains(it));
    let mut at_start = at_start(model, momenta, &read);
    let mut rows = Vec::with_capacity(block.len());
    let mut right = Vec::with_capacity(block.len());
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
    let mut system = System::new(rows, right);
    let steady = |pool: &Pool, system: &System| {
        let open = system.open().iter().copied();
        system.pivot(pool, open, Rate::Parameter, &|_, _| true)
    };
    while let Some((row, column)) = steady(pool, &system) {
        system.eliminate(pool, row, column).ok()?;
    }
    let is_regular = is_linear && system.open().is_empty();
    is_regular.then(|| system.back_substitute(pool, &[], &[]).ok())?
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
