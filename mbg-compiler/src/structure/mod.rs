//! Stage 5, structure: which equation gives which unknown, in which order, and the solution.
//!
//! Input: [`Scalars`]. Output: a [`Solution`]: every unknown as an expression of states, inputs, parameters and time.
//! The equations are brought into block triangular form (Dulmage and Mendelsohn 1958; Duff and Reid 1978), which is
//! unique, and each irreducible block is solved by itself. **A block divides by constants and parameters, by inertias, and
//! by its own determinant**, or is solved with numbers where it is too large for that, so that the program's singular set
//! is that of the model. Closed loops may add that of what moves with the loops open, which is told likewise. Only slopes
//! through an iteration on more than three unknowns divide by pivots that nothing is known of. Errors: `MBG04xx`.

pub mod blocks;
mod bodies;
mod carried;
mod congruence;
mod echelon;
mod eliminate;
mod floating;
mod formulation;
mod hinges;
mod inertia;
mod inverse;
mod levels;
mod linear;
pub mod matching;
mod mesh;
mod moments;
mod multipliers;
mod nonlinear;
mod outlook;
mod reduction;
mod refused;
mod regrouping;
mod resolve;
mod rest;
mod selection;
mod shift;
mod solve;
mod starting;
mod tensor;
mod tree;
mod zero;

use std::collections::{BTreeMap, BTreeSet};

use crate::elaborate::Condition;
use crate::equations::{Equation, Inertia, Scalars};
use crate::symbolic::{Expression, Matrix, Pool};

pub use floating::report_floating;
pub use formulation::Formulation;
pub use outlook::outlook;
pub use reduction::{Reduction, reduce};
pub use refused::report_energy;
pub use resolve::{Solved, resolve};
pub use selection::{Lost, Selection, select};
pub use starting::starting_momenta;

/// Unknowns as expressions.
pub struct Solution {
    /// Value of each unknown.
    pub values: Vec<Expression>,
    /// Divisors that vary with the state, normalised.
    pub conditioning: Vec<Inverted>,
    /// Divisors that depend on parameters alone.
    pub assumptions: Vec<(Expression, Condition)>,
    /// Algebraic loops in order of solution.
    pub loops: Vec<Loop>,
}

/// A block of variables that depend on each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loop {
    /// Its equations, by number.
    pub equations: Vec<usize>,
    /// Its unknowns, by number.
    pub unknowns: Vec<usize>,
    /// How many of them an iteration finds; none where the block is linear.
    pub iterated: usize,
}

/// A block whose determinant varies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inverted {
    /// Its determinant over the norms of its rows.
    pub normalised: Expression,
    /// What it is inverted for, by number.
    pub unknowns: Vec<usize>,
}

/// Why there is no solution.
pub enum Failure {
    /// The equations are dependent: a storage, a source or the junction structure says something twice.
    Singular,
    /// A block in which unknowns enter nonlinearly, and which does not determine them.
    Undetermined(Box<Undetermined>),
}

/// A nonlinear block whose Jacobian is identically singular.
pub struct Undetermined {
    /// Its unknowns.
    pub unknowns: Vec<usize>,
    /// Those that are left after elimination.
    pub left: Vec<usize>,
    /// What they should make zero.
    pub residuals: Vec<Expression>,
    /// Derivatives of the residuals by those that are left.
    pub jacobian: Matrix,
}

/// Solves the equations; the formulation says how a reduced system is.
pub fn solve(
    scalars: &Scalars,
    formulation: Formulation,
    pool: &mut Pool,
) -> Result<Solution, Failure> {
    let multipliers: BTreeSet<usize> = scalars
        .closures
        .iter()
        .flat_map(|closure| closure.multipliers.iter().copied())
        .collect();
    // A constraint determines its multiplier even where it says nothing: that of least norm is zero then.
    let own_multiplier = |equation: &Equation| {
        let [multiplier, other] = equation.about;
        let constrains = multiplier == other && equation.level.is_none();
        (constrains && multipliers.contains(&multiplier)).then_some(multiplier)
    };
    let incidence: Vec<Vec<usize>> = scalars
        .equations
        .iter()
        .map(|equation| {
            let terms = equation.terms.keys().copied();
            terms.chain(own_multiplier(equation)).collect()
        })
        .collect();
    pool.forget();
    let mut all: Vec<Vec<usize>> = scalars
        .equations
        .iter()
        .map(|equation| {
            let unknowns = equation.unknowns();
            unknowns.chain(own_multiplier(equation)).collect()
        })
        .collect();
    // A law is turned round by iteration only where it must be.
    let matching = matching::perfect(&incidence, scalars.unknowns)
        .or_else(|| matching::perfect(&all, scalars.unknowns))
        .ok_or(Failure::Singular)?;
    // What a reduced system eliminates level by level is one block, whatever could be split off: a multiplier, too, even
    // where one end of its loop is fixed and its effort comes last.
    let levelled: Vec<usize> = (0..all.len())
        .filter(|row| {
            let unknown = matching[*row];
            scalars.turns[unknown].is_some() || multipliers.contains(&unknown)
        })
        .collect();
    for (row, next) in levelled.iter().zip(levelled.iter().cycle().skip(1)) {
        all[*row].push(matching[*next]);
    }
    // What it divides by is proven by what moves, which must be known by then.
    if let Some(row) = levelled.first() {
        for rate in scalars.independent.values() {
            if let Inertia::Moved { storages, .. } = &rate.inertia {
                all[*row].extend(storages.iter().flatten());
            }
        }
    }
    let order = blocks::ordered(&all, &matching);
    solve::blocks(scalars, formulation, &matching, &order, pool)
}

/// The value of each signal, with its sign.
#[must_use]
pub fn signal_values(scalars: &Scalars, solution: &Solution) -> BTreeMap<usize, Expression> {
    scalars
        .signals
        .iter()
        .enumerate()
        .map(|(number, (unknown, reversed))| (number, solution.values[*unknown].flipped(*reversed)))
        .collect()
}

/// Names of the elements and junctions whose variables are in a block, for people.
#[must_use]
pub fn block_names(scalars: &Scalars, unknowns: &[usize]) -> Vec<String> {
    unknowns
        .iter()
        .map(|unknown| scalars.names[*unknown].clone())
        .filter(|name| !name.is_empty())
        .collect()
}
