//! Sparse linear equations that have been eliminated symbolically, to be solved for other right sides.
//!
//! What depends on the solution is differentiated by the implicit function theorem: with `A z = b`, the derivative of
//! `z` by anything solves the same equations with the right side `b' − A' z`. The factors are those of the solution, and
//! no factorisation is ever differentiated.

use std::collections::BTreeMap;

use super::dense::dense;
use super::expression::{Expression, Symbol};
use super::implicit::{Implicit, Method};
use super::matrix::Matrix;
use super::pool::Pool;

/// What was done to equations.
#[derive(Clone, Debug)]
pub enum Step {
    /// One unknown was taken out of all other equations.
    Pivot(Elimination),
    /// Equations were multiplied by the inverse of their matrix for as many unknowns, each of which then is in one of them
    /// alone.
    Inverse {
        /// The equations, by place in the rows of the matrix.
        rows: Vec<usize>,
        /// How they were solved.
        solver: RestSolver,
    },
}

/// One unknown, taken out of all other equations.
#[derive(Clone, Debug)]
pub struct Elimination {
    /// The equation that gives it.
    pub row: usize,
    /// The unknown.
    pub column: usize,
    /// Its coefficient there.
    pub pivot: Expression,
    /// The other unknowns of that equation, with their coefficients.
    pub others: Vec<(usize, Expression)>,
    /// How many times that equation is taken from each other one.
    pub factors: Vec<(usize, Expression)>,
}

/// What eliminations have left, by place in rows and columns.
#[derive(Clone, Debug)]
pub struct Rest {
    /// Equations.
    pub rows: Vec<usize>,
    /// Unknowns.
    pub columns: Vec<usize>,
    /// How they are solved.
    pub solver: RestSolver,
}

/// How the rest is solved.
#[derive(Clone, Debug)]
pub enum RestSolver {
    /// By its dense matrix.
    Dense(Matrix),
    /// By the definition with this number, which is [`Method::Linear`].
    Numbers {
        /// The number.
        of: usize,
        /// Which equations have both sides negated there.
        negated: Vec<bool>,
    },
}

/// Equations `A z = b` with their solution.
#[derive(Clone, Debug)]
pub struct Linear {
    /// The coefficients by rows.
    pub matrix: Vec<BTreeMap<usize, Expression>>,
    /// The right side.
    pub right: Vec<Expression>,
    /// In order.
    pub steps: Vec<Step>,
    /// What is solved as a whole.
    pub rest: Rest,
    /// The solution.
    pub values: Vec<Expression>,
}

/// All unknowns, given those that were left in `solution`.
pub fn back_substitute(
    pool: &mut Pool,
    steps: &[Step],
    right: &[Expression],
    solution: &mut [Expression],
) -> Option<()> {
    let pivots = steps.iter().rev().filter_map(|step| match step {
        Step::Pivot(elimination) => Some(elimination),
        Step::Inverse { .. } => None,
    });
    for step in pivots {
        let mut rest = right[step.row];
        for (other, coefficient) in &step.others {
            if solution[*other] == Expression::ZERO {
                continue;
            }
            let product = pool.multiply(*coefficient, solution[*other]);
            rest = pool.subtract(rest, product);
        }
        solution[step.column] = pool.divide(rest, step.pivot)?;
    }
    Some(())
}

impl Linear {
    /// The solution with another right side; none if that divides by zero.
    pub fn solve(&self, pool: &mut Pool, mut right: Vec<Expression>) -> Option<Vec<Expression>> {
        for step in &self.steps {
            step.apply(pool, &mut right)?;
        }
        let left = self.rest.rows.iter().map(|row| right[*row]).collect();
        let values = self.rest.solver.solve(pool, left)?;
        let mut solution = vec![Expression::ZERO; right.len()];
        for (column, value) in self.rest.columns.iter().zip(values) {
            solution[*column] = value;
        }
        back_substitute(pool, &self.steps, &right, &mut solution)?;
        Some(solution)
    }
}

impl Step {
    /// Does to a right side what was done to the equations.
    fn apply(&self, pool: &mut Pool, right: &mut [Expression]) -> Option<()> {
        match self {
            Self::Pivot(step) if right[step.row] != Expression::ZERO => {
                for (other, factor) in &step.factors {
                    let product = pool.multiply(*factor, right[step.row]);
                    right[*other] = pool.subtract(right[*other], product);
                }
            }
            Self::Pivot(_) => {}
            Self::Inverse { rows, solver } => {
                let own = rows.iter().map(|row| right[*row]).collect();
                for (row, value) in rows.iter().zip(solver.solve(pool, own)?) {
                    right[*row] = value;
                }
            }
        }
        Some(())
    }
}

impl RestSolver {
    /// The solution with another right side; none if that divides by zero.
    pub fn solve(&self, pool: &mut Pool, right: Vec<Expression>) -> Option<Vec<Expression>> {
        if right.iter().all(|right| *right == Expression::ZERO) {
            return Some(right);
        }
        match self {
            Self::Dense(matrix) => dense(pool, matrix, &right, &mut Expression::ONE.clone()),
            Self::Numbers { of, negated } => {
                let unknowns: Vec<usize> = right.iter().map(|_| pool.fresh_unknown()).collect();
                let right = right.into_iter().zip(negated);
                let right = right.map(|(it, negated)| it.flipped(*negated)).collect();
                let method = Method::Slope { of: *of, right };
                let implicit = Implicit { unknowns, method };
                let symbols: Vec<Symbol> = implicit.symbols().collect();
                pool.define(implicit);
                let value = |symbol| pool.symbol(symbol);
                Some(symbols.into_iter().map(value).collect())
            }
        }
    }
}
