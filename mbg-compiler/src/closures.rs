//! Stage 5b, closures: what must be zero for a loop to be closed, in positions and in flows.
//!
//! The multipliers hold the rates of the flows together. What integration lets drift apart is put back after a step,
//! by least norm: the displacement between both ends with the states it depends on, then the difference of the flows
//! with the states that are velocities or momenta. That the one is the derivative of the other is proven here, for
//! every state, but for what rounding leaves where rotations are written as numbers. Errors: `MBG0309`.

use std::collections::{BTreeMap, BTreeSet};

use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::elaborate::{Elaborated, StateRate};
use crate::equations::Scalars;
use crate::graph::{ElementKind, Law};
use crate::scaling::{SAMPLES, sample};
use crate::structure::{Solution, Solved};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{
    Differentiator, Evaluation, Expression, Matrix, Pool, Substitution, Symbol, jacobian,
};

/// What a sum may leave beside its terms where it would be zero but for rounding in numbers: those of a rotation are
/// taken with seven digits.
const ROUNDING: f64 = 1e-6;

/// One set of residuals with their derivatives by all states.
#[derive(Clone, Debug)]
pub struct Residuals {
    /// What is to be zero.
    pub values: Vec<Expression>,
    /// By rows, zero for states that stay as they are.
    pub jacobian: Matrix,
    /// The closure of each residual.
    pub closures: Vec<usize>,
}

impl Residuals {
    /// Values, then derivatives by rows.
    #[must_use]
    pub fn evaluated(&self) -> Vec<Expression> {
        [&self.values[..], &self.jacobian.entries].concat()
    }
}

/// Displacements of all closures that have one, in terms of the states.
#[must_use]
pub fn displacements(
    model: &Elaborated,
    substitution: &mut Substitution,
    pool: &mut Pool,
) -> Option<Vec<(usize, usize, Expression)>> {
    let mut found = Vec::new();
    for (number, closure) in model.graph.closures.iter().enumerate() {
        for (component, value) in closure.displacement.iter().flatten().enumerate() {
            found.push((number, component, substitution.apply(pool, *value)?));
        }
    }
    Some(found)
}

/// Reports displacements whose rate is not the difference of the flows. `rates` are those of all candidate states.
pub fn check(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    displacements: &[(usize, usize, Expression)],
    rates: &[Expression],
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) {
    let mut reported = None;
    for (number, component, displacement) in displacements {
        let [from, to] = scalars.closures[*number].flows[*component];
        let flows = [solution.values[from], solution.values[to].negated()];
        if reported != Some(number) && !changes_by(model, *displacement, &flows, rates, pool) {
            reported = Some(number);
            report(model, *number, *component, diagnostics);
        }
    }
}

/// Whether a displacement changes as some flows together do, whatever the states. `rates` are those of all candidate states.
pub fn changes_by(
    model: &Elaborated,
    displacement: Expression,
    flows: &[Expression],
    rates: &[Expression],
    pool: &mut Pool,
) -> bool {
    let mut terms: Vec<Expression> = flows.iter().map(|flow| flow.negated()).collect();
    for symbol in symbols(pool, &[displacement]) {
        let rate = match symbol {
            Symbol::State(state) => rates[state],
            Symbol::Time => Expression::ONE,
            _ => continue,
        };
        let slope = Differentiator::new(symbol).derivative(pool, displacement);
        terms.push(pool.multiply(slope, rate));
    }
    pool.sum(&terms) == Expression::ZERO || is_rounding(model, &terms, pool)
}

/// Whether a sum is zero but for rounding, at some states and with parameters beside their defaults, of which many are zero.
/// A turn `R` that is written as numbers leaves `R Rᵀ − 1`.
fn is_rounding(model: &Elaborated, terms: &[Expression], pool: &mut Pool) -> bool {
    let all: BTreeSet<usize> = (0..model.states.len()).collect();
    (0..SAMPLES).all(|number| {
        let states = sample(model, &all, number, pool);
        let beside = |value: f64, place: usize| {
            let part = (0.618 * (place + number + 1) as f64).fract();
            value + part * (1.0 + value.abs())
        };
        let symbol = |symbol| match symbol {
            Symbol::State(state) => pool.constant_value(states[&state]).unwrap_or(f64::NAN),
            Symbol::Parameter(index) => beside(model.parameters[index].default, index),
            Symbol::Input(index) => beside(0.0, index),
            Symbol::Time => beside(0.0, 0),
            Symbol::Signal(_) | Symbol::Unknown(_) | Symbol::Slope(_) => f64::NAN,
        };
        let mut evaluation = Evaluation::new(&symbol);
        let values = terms.iter().map(|term| evaluation.value(pool, *term));
        let (sum, size) = values.fold((0.0, 0.0), |(sum, size), value| {
            (sum + value, size + value.abs())
        });
        sum.abs() <= ROUNDING * size
    })
}

fn report(model: &Elaborated, number: usize, component: usize, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    let closure = &graph.closures[number];
    let dimension = graph.bonds[closure.bonds[0].0].dimension;
    let component = crate::graph::component_name(component, dimension);
    let message = format!(
        "the displacement of `{}` does not change as the flows of its ends do",
        closure.name
    );
    let report = error(
        codes::DISPLACEMENT,
        graph.origins.span(closure.origin),
        message,
    );
    if let Some((notes, help)) = model.given_what_moves(&closure.name) {
        let report = notes.iter().fold(report, Diagnostic::note);
        return diagnostics.report(report.help(help));
    }
    let report = report
        .note(format!("its component {component} has another rate than the flow of `from` less that of `to`"))
        .help("write `close a -> b by multipliers, displacement: position_of_a - position_of_b;` in the axes of the flows");
    diagnostics.report(report);
}

/// Residuals of the positions, with derivatives by the states that displacements depend on.
#[must_use]
pub fn positions(
    displacements: &[(usize, usize, Expression)],
    by: &[Symbol],
    pool: &mut Pool,
) -> Residuals {
    let values: Vec<Expression> = displacements.iter().map(|(_, _, value)| *value).collect();
    Residuals {
        jacobian: jacobian(pool, &values, by),
        values,
        closures: displacements.iter().map(|(number, _, _)| *number).collect(),
    }
}

/// Groups of displacements whose Jacobian has a rank of its own where all loops are closed, which `new` finds.
#[derive(Clone, Debug, Default)]
pub struct Ranks {
    /// The displacements of each group; the first has all of them.
    pub groups: Vec<Vec<usize>>,
    /// The group of the multipliers that a definition of the pool solves for, by its number.
    pub of: BTreeMap<usize, usize>,
}

/// The groups of those multipliers that are solved together, as far as each has a displacement.
#[must_use]
pub fn ranks(
    scalars: &Scalars,
    displacements: &[(usize, usize, Expression)],
    pool: &Pool,
) -> Ranks {
    let multiplier =
        |number: usize, component: usize| scalars.closures[number].multipliers[component];
    let rows: BTreeMap<usize, usize> = displacements
        .iter()
        .enumerate()
        .map(|(row, (number, component, _))| (multiplier(*number, *component), row))
        .collect();
    let mut ranks = Ranks::default();
    if !displacements.is_empty() {
        ranks.groups.push((0..displacements.len()).collect());
    }
    for (number, implicit) in pool.implicit().iter().enumerate() {
        let unknowns = implicit.unknowns.iter();
        let group: Option<Vec<usize>> = unknowns.map(|it| rows.get(it).copied()).collect();
        let Some(group) = group.filter(|it| !it.is_empty()) else {
            continue;
        };
        let known = ranks.groups.iter().position(|it| *it == group);
        let place = known.unwrap_or(ranks.groups.len());
        if known.is_none() {
            ranks.groups.push(group);
        }
        ranks.of.insert(number, place);
    }
    ranks
}

/// Leaves of derivatives by the entries of attitudes what is along them: a matrix X of orthonormal rows stays one to
/// first order when G is changed by G − ½ (G Xᵀ + X Gᵀ) X. `places` are the columns of each attitude's entries by row.
pub fn tangential(
    residuals: &mut Residuals,
    places: &[Vec<Vec<usize>>],
    by: &[Symbol],
    pool: &mut Pool,
) {
    for places in places {
        let (rows, columns) = (places.len(), places[0].len());
        let matrix = |entry: &mut dyn FnMut(usize) -> Expression| {
            let entries = places.iter().flatten().map(|place| entry(*place)).collect();
            Matrix::new(rows, columns, entries)
        };
        let x = matrix(&mut |place| pool.symbol(by[place]));
        for residual in 0..residuals.values.len() {
            let start = residual * by.len();
            let g = matrix(&mut |place| residuals.jacobian.entries[start + place]);
            let product = g.times(pool, &x.transpose());
            let pairs = product.entries.iter().zip(product.transpose().entries);
            let two = pool.integer(2);
            let halves = pairs.map(|(a, b)| {
                let sum = pool.add(*a, b);
                pool.divide(sum, two).unwrap_or(Expression::ZERO)
            });
            let across = Matrix::new(rows, rows, halves.collect()).times(pool, &x);
            for (entry, place) in places.iter().flatten().enumerate() {
                let along = pool.subtract(g.entries[entry], across.entries[entry]);
                residuals.jacobian.entries[start + place] = along;
            }
        }
    }
}

/// Residuals of the flows, and of these together with what is given for the start.
#[must_use]
pub fn rates(
    model: &Elaborated,
    solved: &Solved,
    by: &[Symbol],
    pool: &mut Pool,
) -> [Residuals; 2] {
    let flows = flows(model, &solved.scalars, &solved.solution, by, pool);
    let started = started(model, solved, &flows, by, pool);
    [flows, started]
}

/// Residuals of the flows, with derivatives by the states that are velocities or momenta.
fn flows(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    by: &[Symbol],
    pool: &mut Pool,
) -> Residuals {
    let (mut values, mut closures) = (Vec::new(), Vec::new());
    for (number, closure) in scalars.closures.iter().enumerate() {
        for [from, to] in &closure.flows {
            values.push(pool.subtract(solution.values[*from], solution.values[*to]));
            closures.push(number);
        }
    }
    moved(model, values, closures, by, pool)
}

/// Residuals with derivatives by the states that are velocities or momenta.
fn moved(
    model: &Elaborated,
    values: Vec<Expression>,
    closures: Vec<usize>,
    by: &[Symbol],
    pool: &mut Pool,
) -> Residuals {
    let mut jacobian = jacobian(pool, &values, by);
    for (column, symbol) in by.iter().enumerate() {
        if !moves(model, *symbol) {
            for row in 0..values.len() {
                jacobian.entries[row * by.len() + column] = Expression::ZERO;
            }
        }
    }
    Residuals {
        values,
        jacobian,
        closures,
    }
}

/// Residuals of the flows, and what flows and momenta are beside those that are given for the start, so that others follow
/// from them; nothing without loops, or where nothing is given. A rate of zero is not told from none; beside another
/// component that is not zero it is given.
fn started(
    model: &Elaborated,
    solved: &Solved,
    flows: &Residuals,
    by: &[Symbol],
    pool: &mut Pool,
) -> Residuals {
    let is_state = |symbol: &Symbol| !matches!(symbol, Symbol::State(_)) || by.contains(symbol);
    let mut given = Vec::new();
    for (found, wanted) in starts(model, solved, pool) {
        if wanted.iter().any(|it| *it != Expression::ZERO)
            && symbols(pool, &found).iter().all(is_state)
        {
            let pairs = found.into_iter().zip(wanted);
            given.extend(pairs.map(|(found, wanted)| pool.subtract(found, wanted)));
        }
    }
    if flows.values.is_empty() || given.is_empty() {
        return moved(model, Vec::new(), Vec::new(), by, pool);
    }
    // No closure has this number.
    let none = vec![model.graph.closures.len(); given.len()];
    let closures = [&flows.closures[..], &none].concat();
    let values = [flows.values.clone(), given].concat();
    moved(model, values, closures, by, pool)
}

/// Whether something drives the loops at the start, without inputs: flows of them that are not zero where nothing moves, by a
/// source that is a number, a parameter or a law of time. Rates must follow it then, whether one is given or not. What linear
/// equations give is zero at rest.
#[must_use]
pub fn are_driven(model: &Elaborated, flows: &Residuals, pool: &mut Pool) -> bool {
    let mut at_rest = Substitution::new();
    for symbol in symbols(pool, &flows.values) {
        let stays = matches!(symbol, Symbol::State(_) | Symbol::Parameter(_));
        if !stays || moves(model, symbol) {
            at_rest.set(symbol, Expression::ZERO);
        }
    }
    let mut values = flows.values.iter();
    values.any(|value| at_rest.apply(pool, *value) != Some(Expression::ZERO))
}

/// Flows of coordinates, and momenta that are given themselves, with what they are said to be at the start.
fn starts(
    model: &Elaborated,
    solved: &Solved,
    pool: &mut Pool,
) -> Vec<(Vec<Expression>, Vec<Expression>)> {
    let junctions = model.graph.junctions.iter().zip(&solved.scalars.common);
    let flows = junctions.map(|(junction, flows)| {
        let found = flows.iter().map(|flow| solved.solution.values[*flow]);
        (found.collect(), junction.initial_flow.clone())
    });
    let mut starts: Vec<_> = flows.collect();
    for element in &model.graph.elements {
        if let (ElementKind::I, Law::Storage(storage)) = (element.kind, &element.law) {
            let states = &model.states[storage.states.clone()];
            if states.iter().all(|it| it.is_given) {
                let found = storage.states.clone();
                let found = found.map(|state| pool.symbol(Symbol::State(state)));
                let wanted = states.iter().map(|it| it.initial).collect();
                starts.push((found.collect(), wanted));
            }
        }
    }
    starts
}

/// Whether a state is a velocity or a momentum.
fn moves(model: &Elaborated, symbol: Symbol) -> bool {
    let Symbol::State(state) = symbol else {
        return false;
    };
    match model.states[state].rate {
        StateRate::Unknown(_) => true,
        StateRate::Storage(id, _) => model.graph.elements[id.0].kind == ElementKind::I,
        StateRate::Expression(_) => false,
    }
}
