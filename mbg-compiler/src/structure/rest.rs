//! What is left of linear equations, solved as a whole: by the adjugate where it is small, else with numbers.

use super::Failure;
use super::eliminate::System;
use super::solve::Solver;
use super::tree::Tree;
use crate::symbolic::dense::{ADJUGATE, dense};
use crate::symbolic::{
    Expression, Function, Implicit, Kind, Linear, Matrix, Method, Pool, Rate, Rest, RestSolver,
    Symbol,
};

/// What linear equations were divided by.
#[derive(Clone, Copy)]
struct Divisor {
    /// The product of pivots that do not vary.
    pivots: Expression,
    /// By what was left then.
    last: Expression,
}

impl Divisor {
    const ONE: Self = Self {
        pivots: Expression::ONE,
        last: Expression::ONE,
    };
}

impl Solver<'_> {
    /// What is left when no level has it, solved as a whole: the rest and its values.
    pub(super) fn rest(
        &mut self,
        system: &mut System,
        tree: &Tree,
        unknowns: &[usize],
    ) -> Result<(Rest, Vec<Expression>), Failure> {
        let rows = system.open().clone();
        let columns = (0..system.size()).collect();
        let allowed = |row, column| tree.allows(row, column);
        system.eliminate_constants(self.pool, &rows, &columns, &allowed)?;
        let mut divisor = Divisor::ONE;
        let solved = self.whole(system, unknowns, &allowed, &mut divisor)?;
        self.note_last(divisor, &[]);
        Ok(solved)
    }

    /// Solves linear equations, whose rows have norms: the values, and what was divided by.
    pub(super) fn linear(
        &mut self,
        mut system: System,
        unknowns: &[usize],
        norms: &[Expression],
    ) -> Result<(Vec<Expression>, Expression), Failure> {
        let (matrix, right) = system.equations();
        let mut divisor = Divisor::ONE;
        let (rest, values) = self.whole(&mut system, unknowns, &|_, _| true, &mut divisor)?;
        match rest.solver {
            RestSolver::Numbers { .. } => self.note_last(divisor, &[]),
            RestSolver::Dense(_) => self.note_last(divisor, norms),
        }
        let divisor = self.pool.multiply(divisor.pivots, divisor.last);
        let values = system.back_substitute(self.pool, &rest.columns, &values)?;
        // What was found by numbers has slopes by these equations alone; expressions are differentiated themselves.
        if matches!(rest.solver, RestSolver::Numbers { .. }) {
            self.pool.solved(Linear {
                matrix,
                right,
                steps: system.into_steps(),
                rest,
                values: values.clone(),
            });
        }
        Ok((values, divisor))
    }

    /// What is left of a system, and its values. Where it is large, pivots that do not vary make it smaller. What is
    /// large all the same is solved with numbers: no pivot that varies is known not to vanish at some state at which the
    /// block is regular.
    fn whole(
        &mut self,
        system: &mut System,
        unknowns: &[usize],
        allowed: &dyn Fn(usize, usize) -> bool,
        divisor: &mut Divisor,
    ) -> Result<(Rest, Vec<Expression>), Failure> {
        let steady = |pool: &Pool, system: &System| {
            system.pivot(
                pool,
                system.open().iter().copied(),
                Rate::Parameter,
                allowed,
            )
        };
        while system.open().len() > ADJUGATE
            && let Some((row, column)) = steady(self.pool, system)
        {
            let pivot = system.entry(row, column);
            // In the determinant of the whole it may cancel.
            self.note(pivot, &[]);
            divisor.pivots = self.pool.multiply(divisor.pivots, pivot);
            system.eliminate(self.pool, row, column)?;
        }
        let rows: Vec<usize> = system.open().iter().copied().collect();
        let (columns, matrix, right) = system.rest();
        if rows.len() > ADJUGATE {
            let (rows, matrix) = symmetric(rows, matrix);
            let right = rows.iter().map(|row| system.right(*row)).collect();
            *divisor = Divisor {
                last: self.distance(&matrix).ok_or(Failure::Singular)?,
                ..Divisor::ONE
            };
            let numbers = columns.iter().map(|column| unknowns[*column]).collect();
            return Ok(self.regular((rows, columns), numbers, (matrix, right)));
        }
        let values = if rows.is_empty() {
            Vec::new()
        } else {
            dense(self.pool, &matrix, &right, &mut divisor.last).ok_or(Failure::Singular)?
        };
        let solver = RestSolver::Dense(matrix);
        let rest = Rest {
            rows,
            columns,
            solver,
        };
        Ok((rest, values))
    }

    /// Remembers what was divided by beside the pivots, each of which is remembered. Where it varies and norms tell its size,
    /// it is the determinant with them. Otherwise their product would say no more, and in single precision that of ten
    /// resistances of a kiloohm, or of inertias of a crane, is beyond all numbers.
    fn note_last(&mut self, divisor: Divisor, norms: &[Expression]) {
        let varies = self.pool.rate(divisor.last) == Rate::Varying;
        let pivots = if varies && !norms.is_empty() {
            divisor.pivots
        } else {
            Expression::ONE
        };
        let noted = self.pool.multiply(pivots, divisor.last);
        self.note(noted, norms);
    }

    /// How far a matrix of numbers is from a singular one, unless it always is one: the reciprocal of the largest component of
    /// a solution, with rows and columns scaled to a largest entry of about one. A determinant would say less: rounding errors
    /// of one by ten rows are larger than many a regular one.
    pub(super) fn distance(&mut self, matrix: &Matrix) -> Option<Expression> {
        if !matrix.is_regular(self.pool) {
            return None;
        }
        let size = matrix.rows;
        let mut columns = vec![Expression::ZERO; size];
        let mut right = Vec::with_capacity(size);
        for row in 0..size {
            let entries = &matrix.entries[row * size..][..size];
            let largest = self.largest(entries);
            for (scale, entry) in columns.iter_mut().zip(entries) {
                let entry = self.pool.divide(*entry, largest)?;
                *scale = self.largest(&[*scale, entry]);
            }
            // No two are alike: a right side that is as special as the matrix would have a solution where others have none.
            let part = format!("{:.3}", 0.5 + (0.618 * (row + 1) as f64).fract());
            let part = self.pool.literal(&part)?;
            right.push(self.pool.multiply(part, largest));
        }
        let unknowns: Vec<usize> = (0..size).map(|_| self.pool.fresh_unknown()).collect();
        let (kind, negated) = match matrix.signs_of_symmetry() {
            Some(signs) => (Kind::Symmetric, signs),
            None => (Kind::Regular, vec![false; size]),
        };
        let right = right.into_iter().zip(&negated);
        let implicit = Implicit {
            unknowns,
            method: Method::Linear {
                matrix: matrix.with_rows_negated(&negated),
                right: right.map(|(it, negated)| it.flipped(*negated)).collect(),
                kind,
            },
        };
        let symbols: Vec<Symbol> = implicit.symbols().collect();
        self.pool.define(implicit);
        let solution: Vec<Expression> = symbols
            .into_iter()
            .zip(columns)
            .map(|(symbol, scale)| {
                let value = self.pool.symbol(symbol);
                self.pool.multiply(scale, value)
            })
            .collect();
        let largest = self.largest(&solution);
        self.pool.divide(Expression::ONE, largest)
    }

    /// The largest magnitude of some expressions.
    fn largest(&mut self, expressions: &[Expression]) -> Expression {
        let mut largest = Expression::ZERO;
        for expression in expressions {
            if *expression == Expression::ZERO {
                continue;
            }
            let size = self.pool.call(Function::Abs, &[*expression]);
            largest = match largest {
                Expression::ZERO => size,
                _ => self.pool.call(Function::Max, &[largest, size]),
            };
        }
        largest
    }

    /// Leaves equations with a regular matrix to be solved with numbers: what is left, and its values.
    pub(super) fn regular(
        &mut self,
        places: (Vec<usize>, Vec<usize>),
        unknowns: Vec<usize>,
        (matrix, right): (Matrix, Vec<Expression>),
    ) -> (Rest, Vec<Expression>) {
        let (kind, negated) = match matrix.signs_of_symmetry() {
            Some(signs) => (Kind::Symmetric, signs.into_iter().map(|it| !it).collect()),
            None => (Kind::Regular, vec![true; matrix.rows]),
        };
        self.by_numbers(places, unknowns, (matrix, right, kind), negated)
    }

    /// Leaves equations, of which some get both sides negated, to be solved with numbers: what is left, and its values.
    pub(super) fn by_numbers(
        &mut self,
        (rows, columns): (Vec<usize>, Vec<usize>),
        unknowns: Vec<usize>,
        (matrix, right, kind): (Matrix, Vec<Expression>, Kind),
        negated: Vec<bool>,
    ) -> (Rest, Vec<Expression>) {
        let right = right.into_iter().zip(&negated);
        let method = Method::Linear {
            matrix: matrix.with_rows_negated(&negated),
            right: right.map(|(it, negated)| it.flipped(*negated)).collect(),
            kind,
        };
        let implicit = Implicit { unknowns, method };
        let symbols: Vec<Symbol> = implicit.symbols().collect();
        let of = self.pool.implicit().len();
        let solver = RestSolver::Numbers { of, negated };
        self.pool.define(implicit);
        let values = symbols
            .into_iter()
            .map(|symbol| self.pool.symbol(symbol))
            .collect();
        let rest = Rest {
            rows,
            columns,
            solver,
        };
        (rest, values)
    }
}

/// Rows with their matrix in an order in which it is symmetric but for signs, if there is one.
fn symmetric(rows: Vec<usize>, matrix: Matrix) -> (Vec<usize>, Matrix) {
    let Some(order) = matrix.order_of_symmetry() else {
        return (rows, matrix);
    };
    let matrix = matrix.with_rows(&order);
    (order.into_iter().map(|row| rows[row]).collect(), matrix)
}
