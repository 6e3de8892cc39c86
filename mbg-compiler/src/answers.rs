//! Stage 5b, answers: what the functions of a model return, in terms of its states.
//!
//! Input: the [`Solved`] equations. Output: [`Answers`]. Integrals and attitudes that nothing reads are left out here.
//! Errors: `MBG0216`, `MBG0309`.

use crate::closures;
use crate::codes;
use crate::diagnostics::Diagnostics;
use crate::displacements;
use crate::elaborate::{Elaborated, StateRate, Variable};
use crate::equations::Scalars;
use crate::graph::{ElementId, ElementKind, Law};
use crate::structure::{self, Solution, Solved};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Pool, Substitution, Symbol};

/// What the functions of the model return.
pub struct Answers {
    /// Candidate states that are states, in order.
    pub states: Vec<usize>,
    /// Their rates.
    pub rates: Vec<Expression>,
    /// Outputs in order.
    pub outputs: Vec<Expression>,
    /// Stored energy, that of pseudo bonds left out, as their power is.
    pub energy: Expression,
    /// Power from the sources.
    pub supplied: Expression,
    /// Power into the resistors.
    pub dissipated: Expression,
    /// Displacements of closures: number, component, value.
    pub displacements: Vec<(usize, usize, Expression)>,
    /// What each lost state is in terms of the others.
    pub eliminated: Vec<(usize, Expression)>,
}

impl Answers {
    /// Works them out; none if something was reported.
    pub fn of(
        model: &Elaborated,
        solved: &Solved,
        pool: &mut Pool,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let (scalars, solution) = (&solved.scalars, &solved.solution);
        let mut substitution = substitution(model, solved, pool)?;
        let mut replaced = |pool: &mut Pool, expression, variable: &Variable, span| {
            let value = substitution.apply(pool, expression);
            if value.is_none() {
                let message = format!("`{}` divides by zero, whatever the state", variable.name);
                diagnostics.error(codes::NOT_FINITE, span, message);
            }
            value
        };
        let all: Vec<Option<Expression>> = model
            .states
            .iter()
            .map(|state| match state.rate {
                StateRate::Storage(id, component) => {
                    Some(storage_rate(model, scalars, solution, id, component))
                }
                StateRate::Expression(rate) => replaced(pool, rate, &state.variable, state.span),
                StateRate::Unknown(rate) => Some(solution.values[rate]),
            })
            .collect();
        let outputs: Vec<Option<Expression>> = model
            .outputs
            .iter()
            .map(|output| replaced(pool, output.value, &output.variable, output.span))
            .collect();
        let all: Vec<Expression> = all.into_iter().collect::<Option<_>>()?;
        let outputs: Vec<Expression> = outputs.into_iter().collect::<Option<_>>()?;
        let displacements = closures::displacements(model, &mut substitution, pool)?;
        closures::check(
            model,
            scalars,
            solution,
            &displacements,
            &all,
            pool,
            diagnostics,
        );
        displacements::check(model, (scalars, solution), &all, pool, diagnostics);
        if diagnostics.any() {
            return None;
        }
        let (supplied, dissipated) = powers(model, scalars, solution, pool);
        let energy = energy(model, &mut substitution, pool, diagnostics)?;
        let mut told = vec![energy, supplied, dissipated];
        told.extend(&outputs);
        told.extend(displacements.iter().map(|(_, _, value)| *value));
        told.extend(solution.conditioning.iter().map(|it| it.normalised));
        let lost = |state: &usize| {
            solved.momenta.contains_key(state) || displacements::is_told(model, *state)
        };
        let states = kept(model, pool, &all, &told, &lost);
        let rates = states.iter().map(|state| all[*state]).collect();
        Some(Self {
            states,
            rates,
            outputs,
            energy,
            supplied,
            dissipated,
            displacements,
            eliminated: (0..model.states.len())
                .filter_map(|state| Some((state, substitution.get(Symbol::State(state))?)))
                .collect(),
        })
    }
}

/// What signals and lost states are, in terms of the states that are left.
fn substitution(model: &Elaborated, solved: &Solved, pool: &mut Pool) -> Option<Substitution> {
    let mut substitution = displacements::substitution(model);
    for (signal, value) in structure::signal_values(&solved.scalars, &solved.solution) {
        substitution.set(Symbol::Signal(signal), value);
    }
    let momenta: Vec<(usize, Expression)> = solved
        .momenta
        .iter()
        .map(|(state, momentum)| Some((*state, substitution.apply(pool, *momentum)?)))
        .collect::<Option<_>>()?;
    for (state, momentum) in momenta {
        substitution.set(Symbol::State(state), momentum);
    }
    Some(substitution)
}

/// `ṗ = e` or `q̇ = f`, with power into the storage.
pub fn storage_rate(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    id: ElementId,
    component: usize,
) -> Expression {
    let port = &scalars.ports[&id];
    if model.graph.elements[id.0].kind == ElementKind::I {
        solution.values[port.effort[component]].flipped(port.effort_reversed)
    } else {
        solution.values[port.flow[component]].flipped(port.flow_reversed)
    }
}

/// What storages hold, those of pseudo bonds left out; none if something was reported.
fn energy(
    model: &Elaborated,
    substitution: &mut Substitution,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Expression> {
    let mut energies = Vec::new();
    for (id, element) in model.graph.elements.iter().enumerate() {
        if let Law::Storage(storage) = &element.law
            && !model.graph.is_pseudo(ElementId(id))
        {
            let energy = substitution.apply(pool, storage.energy)?;
            let mut read = symbols(pool, &[energy]).into_iter();
            let input = read.find_map(|symbol| match symbol {
                Symbol::Input(input) => Some(input),
                _ => None,
            });
            if let Some(input) = input {
                structure::report_energy(model, element, input, diagnostics);
            }
            energies.push(energy);
        }
    }
    (!diagnostics.any()).then(|| pool.sum(&energies))
}

/// Storages, and the integrals and attitudes that their rates read, or what is `told`.
fn kept(
    model: &Elaborated,
    pool: &Pool,
    rates: &[Expression],
    told: &[Expression],
    lost: &dyn Fn(&usize) -> bool,
) -> Vec<usize> {
    let mut keep: Vec<bool> = model
        .states
        .iter()
        .enumerate()
        .map(|(state, entry)| !lost(&state) && !matches!(entry.rate, StateRate::Expression(_)))
        .collect();
    loop {
        let mut roots: Vec<Expression> = told.to_vec();
        roots.extend(
            rates
                .iter()
                .zip(&keep)
                .filter(|(_, keep)| **keep)
                .map(|(rate, _)| *rate),
        );
        let mut read: Vec<usize> = symbols(pool, &roots)
            .into_iter()
            .filter_map(|symbol| {
                if let Symbol::State(state) = symbol {
                    Some(state)
                } else {
                    None
                }
            })
            .filter(|state| !keep[*state])
            .collect();
        // Only a whole row of an attitude can be kept at length one.
        let rows = model.attitudes.iter().flat_map(|attitude| &attitude.rows);
        for row in rows {
            if row.iter().any(|state| read.contains(state)) {
                read.extend(row);
            }
        }
        if read.is_empty() {
            return (0..keep.len()).filter(|state| keep[*state]).collect();
        }
        read.into_iter().for_each(|state| keep[state] = true);
    }
}

/// Power supplied by sources and dissipated in resistors.
fn powers(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    pool: &mut Pool,
) -> (Expression, Expression) {
    let (mut supplied, mut dissipated) = (Expression::ZERO, Expression::ZERO);
    for (id, port) in &scalars.ports {
        let kind = model.graph.elements[id.0].kind;
        let source = matches!(kind, ElementKind::Se | ElementKind::Sf);
        if (!source && kind != ElementKind::R) || model.graph.is_pseudo(*id) {
            continue;
        }
        for (effort, flow) in port.effort.iter().zip(&port.flow) {
            let product = pool.multiply(solution.values[*effort], solution.values[*flow]);
            if source {
                supplied = pool.add(supplied, product.flipped(port.inward));
            } else {
                dissipated = pool.add(dissipated, product.flipped(!port.inward));
            }
        }
    }
    (supplied, dissipated)
}
