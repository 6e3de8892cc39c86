//! What is left of linear equations where loops are closed: `G M⁻¹ Gᵀ λ = b`, for the multipliers λ.
//!
//! All other unknowns are eliminated first, by pivots that do not vary, and what is left of them block by block: each
//! irreducible one by its determinant, or with numbers where it is large. No pivot that varies is taken out of a block of
//! several rows. Of a body that flies the balance of forces is in axes that turn with it and its rates may be in those of
//! its joint: then a pivot is mass times a component of a rotation matrix, which is zero at some attitudes, where the block
//! is as regular as anywhere.

use std::collections::BTreeMap;

use super::eliminate::System;
use super::solve::{Solver, places};
use super::tree::Columns;
use super::{Failure, blocks, matching};
use crate::symbolic::dense::{ADJUGATE, dense};
use crate::symbolic::{Expression, Kind, Linear, Matrix, Pool, Rate, Rest, RestSolver};

/// Rows with the columns that they are solved for, as many.
struct Block {
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Solver<'_> {
    /// The multipliers, whose matrix may be singular at any state.
    pub(super) fn multipliers(
        &mut self,
        system: &mut System,
        equations: &[usize],
        unknowns: &[usize],
    ) -> Result<(Rest, Vec<Expression>), Failure> {
        let (rows, columns) = self.constraints(equations, unknowns);
        self.eliminate_others(system, &rows, &columns)?;
        let (rows, columns) = effective(system, rows, columns);
        let matrix = part(system, &rows, &columns);
        let right = rows.iter().map(|row| system.right(*row)).collect();
        let numbers = columns.iter().map(|column| unknowns[*column]).collect();
        let negated = vec![true; rows.len()];
        let equations = (matrix, right, Kind::Semidefinite);
        Ok(self.by_numbers((rows, columns), numbers, equations, negated))
    }

    /// The rows of a block that constrain loops, and the columns of their multipliers.
    fn constraints(&self, equations: &[usize], unknowns: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let place = places(unknowns);
        let closures = self.scalars.closures.iter();
        let multipliers = closures.flat_map(|closure| &closure.multipliers);
        let constraints = multipliers.filter_map(|unknown| {
            let constrains = |equation: &usize| {
                self.scalars.equations[*equation].about == [*unknown; 2]
                    && self.scalars.equations[*equation].level.is_none()
            };
            Some((equations.iter().position(constrains)?, *place.get(unknown)?))
        });
        constraints.unzip()
    }

    /// Eliminates all columns but those of the multipliers, whose rows are left.
    fn eliminate_others(
        &mut self,
        system: &mut System,
        rows: &[usize],
        columns: &[usize],
    ) -> Result<(), Failure> {
        let rows: Columns = rows.iter().copied().collect();
        let columns: Columns = columns.iter().copied().collect();
        let outside = |_, column| !columns.contains(&column);
        let steady = |pool: &Pool, system: &System| {
            let others = system.open().difference(&rows).copied();
            system.pivot(pool, others, Rate::Parameter, &outside)
        };
        while let Some((row, column)) = steady(self.pool, system) {
            self.note(system.entry(row, column), &[]);
            system.eliminate(self.pool, row, column)?;
        }
        let others = system.open().difference(&rows).copied().collect();
        let blocks = irreducible(system, others, &columns).ok_or(Failure::Singular)?;
        blocks
            .iter()
            .try_for_each(|block| self.eliminate_block(system, block))
    }

    /// Eliminates what is solved for as a whole.
    fn eliminate_block(&mut self, system: &mut System, block: &Block) -> Result<(), Failure> {
        let Block { rows, columns } = block;
        if let ([row], [column]) = (&rows[..], &columns[..]) {
            self.note(system.entry(*row, *column), &[]);
            return Ok(system.eliminate(self.pool, *row, *column)?);
        }
        let matrix = part(system, rows, columns);
        let right = rows.iter().map(|row| system.right(*row)).collect();
        let (solver, right) = self.solver(&matrix, right).ok_or(Failure::Singular)?;
        let held = rows.iter().flat_map(|row| system.row(*row));
        let held = held.map(|(column, _)| column);
        let others: Columns = held.filter(|it| !columns.contains(it)).collect();
        let mut solved = Vec::with_capacity(others.len());
        for other in others {
            let column: Vec<Expression> =
                rows.iter().map(|row| system.entry(*row, other)).collect();
            let values = solver.solve(self.pool, column.clone());
            let values = values.ok_or(Failure::Singular)?;
            self.remember(&matrix, column, &solver, &values);
            solved.push((other, values));
        }
        let places = (&rows[..], &columns[..]);
        Ok(system.eliminate_together(self.pool, places, solver, &solved, &right)?)
    }

    /// How equations are solved, and their solution; what that divides by is noted. None if it always is zero.
    fn solver(
        &mut self,
        matrix: &Matrix,
        right: Vec<Expression>,
    ) -> Option<(RestSolver, Vec<Expression>)> {
        if matrix.rows <= ADJUGATE {
            let mut divisor = Expression::ONE;
            let values = dense(self.pool, matrix, &right, &mut divisor)?;
            self.note(divisor, &[]);
            return Some((RestSolver::Dense(matrix.clone()), values));
        }
        let distance = self.distance(matrix)?;
        self.note(distance, &[]);
        let fresh = right.iter().map(|_| self.pool.fresh_unknown()).collect();
        let equations = (matrix.clone(), right.clone());
        let (rest, values) = self.regular(all(matrix), fresh, equations);
        self.remember(matrix, right, &rest.solver, &values);
        Some((rest.solver, values))
    }

    /// Lets numbers have slopes by the equations that gave them: sums of them may be put together in other ways than in the
    /// solution of the whole, whose slopes are known.
    fn remember(
        &mut self,
        matrix: &Matrix,
        right: Vec<Expression>,
        solver: &RestSolver,
        values: &[Expression],
    ) {
        if matches!(solver, RestSolver::Dense(_)) {
            return;
        }
        let entries = matrix.entries.chunks(matrix.columns);
        let entries = entries.map(|row| row.iter().copied().enumerate().collect());
        let (rows, columns) = all(matrix);
        self.pool.solved(Linear {
            matrix: entries.collect(),
            right,
            steps: Vec::new(),
            rest: Rest {
                rows,
                columns,
                solver: solver.clone(),
            },
            values: values.to_vec(),
        });
    }
}

/// The constraints that something can break. Multipliers of others, such as those across a linkage in a plane whose joints are
/// in space, change nothing and are zero: of all solutions that of least norm is wanted.
fn effective(system: &System, rows: Vec<usize>, columns: Vec<usize>) -> (Vec<usize>, Vec<usize>) {
    let is_zero = |row: usize, column: usize| system.entry(row, column) == Expression::ZERO;
    let acts = |(own_row, own_column): &(usize, usize)| {
        system.right(*own_row) != Expression::ZERO
            || columns.iter().any(|column| !is_zero(*own_row, *column))
            || rows.iter().any(|row| !is_zero(*row, *own_column))
    };
    let pairs = rows.iter().copied().zip(columns.iter().copied());
    pairs.filter(acts).unzip()
}

/// All rows and columns of a matrix.
fn all(matrix: &Matrix) -> (Vec<usize>, Vec<usize>) {
    ((0..matrix.rows).collect(), (0..matrix.columns).collect())
}

/// The entries of a system in some of its rows and columns.
fn part(system: &System, rows: &[usize], columns: &[usize]) -> Matrix {
    let places = rows
        .iter()
        .flat_map(|row| columns.iter().map(move |column| (*row, *column)));
    let entries = places.map(|(row, column)| system.entry(row, column));
    Matrix::new(rows.len(), columns.len(), entries.collect())
}

/// The irreducible blocks of some rows without the columns given, in order of solution; none if there are not as many other
/// columns as rows, or two rows are about the same column alone.
fn irreducible(system: &System, rows: Vec<usize>, without: &Columns) -> Option<Vec<Block>> {
    let inside = |row: &usize| {
        let columns = system.row(*row).map(|(column, _)| column);
        columns.filter(|column| !without.contains(column))
    };
    let columns: Columns = rows.iter().flat_map(inside).collect();
    let place: BTreeMap<usize, usize> = columns.iter().copied().zip(0..).collect();
    let columns: Vec<usize> = columns.into_iter().collect();
    let incidence = rows.iter().map(|row| inside(row).map(|it| place[&it]));
    let incidence: Vec<Vec<usize>> = incidence.map(Iterator::collect).collect();
    let own = matching::perfect(&incidence, columns.len())?;
    let blocks = blocks::ordered(&incidence, &own).into_iter();
    let blocks = blocks.map(|block| Block {
        rows: block.iter().map(|it| rows[*it]).collect(),
        columns: block.iter().map(|it| columns[own[*it]]).collect(),
    });
    Some(blocks.collect())
}
