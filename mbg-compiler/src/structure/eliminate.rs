//! Sparse elimination of a block, level by level.

use std::collections::{BTreeMap, BTreeSet};

use crate::symbolic::linear::{Elimination, back_substitute};
use crate::symbolic::{Expression, Matrix, Pool, Rate, RestSolver, Step, Substitution};

/// A constant that is smaller than this beside others is no pivot: rounding errors may grow by the square of the ratio.
const SMALL: f64 = 0.1;

/// Linear equations by rows, which shrink as unknowns are eliminated.
pub(super) struct System {
    rows: Vec<BTreeMap<usize, Expression>>,
    right: Vec<Expression>,
    /// Rows that hold each column.
    columns: Vec<BTreeSet<usize>>,
    /// Rows and columns that are left.
    open_rows: BTreeSet<usize>,
    open_columns: BTreeSet<usize>,
    steps: Vec<Step>,
}

/// Why a pivot was not taken: it is identically zero.
pub(super) struct Vanished;

impl System {
    /// `matrix · x = right`.
    pub(super) fn of(matrix: &Matrix, right: Vec<Expression>) -> Self {
        let row = |row| {
            let entries = (0..matrix.columns).map(|column| (column, matrix.at(row, column)));
            entries
                .filter(|(_, value)| *value != Expression::ZERO)
                .collect()
        };
        Self::new((0..matrix.rows).map(row).collect(), right)
    }

    /// `Σ rows · x = right`.
    pub(super) fn new(rows: Vec<BTreeMap<usize, Expression>>, right: Vec<Expression>) -> Self {
        let size = rows.len();
        let mut columns = vec![BTreeSet::new(); size];
        for (row, entries) in rows.iter().enumerate() {
            for column in entries.keys() {
                columns[*column].insert(row);
            }
        }
        Self {
            rows,
            right,
            columns,
            open_rows: (0..size).collect(),
            open_columns: (0..size).collect(),
            steps: Vec::new(),
        }
    }

    /// Eliminates, among the rows and columns given, whatever an admitted constant pivot can: the one that fills in
    /// least first (Markowitz 1957).
    pub(super) fn eliminate_constants(
        &mut self,
        pool: &mut Pool,
        rows: &BTreeSet<usize>,
        columns: &BTreeSet<usize>,
        admitted: &dyn Fn(usize, usize) -> bool,
    ) -> Result<(), Vanished> {
        let mut is_wanted = vec![false; self.size()];
        // An elimination puts no column into a row that held none of them.
        let mut holding = BTreeSet::new();
        for column in columns {
            is_wanted[*column] = true;
            holding.extend(self.rows_with(*column).filter(|row| rows.contains(row)));
        }
        let wanted = |row, column: usize| is_wanted[column] && admitted(row, column);
        while let Some((row, column)) =
            self.pivot(pool, holding.iter().copied(), Rate::Constant, &wanted)
        {
            self.eliminate(pool, row, column)?;
            holding.remove(&row);
        }
        Ok(())
    }

    /// A pivot in one of the rows given, which are open, that changes so often at most: constants before parameters before
    /// what varies, then the one that fills in least.
    pub(super) fn pivot(
        &self,
        pool: &Pool,
        rows: impl Iterator<Item = usize>,
        most: Rate,
        admitted: &dyn Fn(usize, usize) -> bool,
    ) -> Option<(usize, usize)> {
        let mut best = None;
        for row in rows {
            for (column, entry) in &self.rows[row] {
                if pool.rate(*entry) > most || !admitted(row, *column) {
                    continue;
                }
                let rate = self.rate(pool, row, *column);
                if rate > most {
                    continue;
                }
                let found = (rate, self.fill(row, *column), row, *column);
                // None is better, and what comes later stands behind it.
                if found.0 == Rate::Constant && found.1 == 0 {
                    return Some((row, *column));
                }
                if best.is_none_or(|best| found < best) {
                    best = Some(found);
                }
            }
        }
        best.map(|(_, _, row, column)| (row, column))
    }

    /// How often an entry changes, as a pivot: a constant that is small beside others in its row and in its column counts as if
    /// it varied. What is divided by it carries their rounding errors, as many times larger. Of an entry that is no constant
    /// the size is not known, and taken to be one.
    pub(super) fn rate(&self, pool: &Pool, row: usize, column: usize) -> Rate {
        let size = |entry| pool.constant_value(entry).map_or(1.0, f64::abs);
        let entry = self.entry(row, column);
        let own = size(entry);
        let is_small_beside = |other: f64| own < SMALL * other;
        let is_small = || {
            let mut others = self.rows[row].values().map(|it| size(*it));
            let above = self.rows_with(column);
            let mut above = above.map(|it| size(self.entry(it, column)));
            others.any(is_small_beside) && above.any(is_small_beside)
        };
        match pool.rate(entry) {
            Rate::Constant if own < SMALL && is_small() => Rate::Varying,
            rate => rate,
        }
    }

    /// How many entries a pivot there fills in at most.
    pub(super) fn fill(&self, row: usize, column: usize) -> usize {
        (self.rows[row].len() - 1) * (self.columns[column].len() - 1)
    }

    /// Rows that are left.
    pub(super) fn open(&self) -> &BTreeSet<usize> {
        &self.open_rows
    }

    /// The right side of a row.
    pub(super) fn right(&self, row: usize) -> Expression {
        self.right[row]
    }

    /// Replaces symbols everywhere.
    pub(super) fn replace(
        &mut self,
        pool: &mut Pool,
        substitution: &mut Substitution,
    ) -> Result<(), Vanished> {
        let entries = self.rows.iter_mut().flat_map(BTreeMap::values_mut);
        for expression in entries.chain(&mut self.right) {
            *expression = substitution.apply(pool, *expression).ok_or(Vanished)?;
        }
        Ok(())
    }

    /// The coefficient of an unknown in a row.
    pub(super) fn entry(&self, row: usize, column: usize) -> Expression {
        self.rows[row]
            .get(&column)
            .copied()
            .unwrap_or(Expression::ZERO)
    }

    /// Makes a row equal to something else.
    pub(super) fn set_right(&mut self, row: usize, right: Expression) {
        self.right[row] = right;
    }

    /// Makes an entry of an open row another one.
    pub(super) fn set(&mut self, row: usize, column: usize, value: Expression) {
        if value == Expression::ZERO {
            self.rows[row].remove(&column);
            self.columns[column].remove(&row);
        } else {
            self.rows[row].insert(column, value);
            self.columns[column].insert(row);
        }
    }

    /// Number of unknowns.
    pub(super) fn size(&self) -> usize {
        self.rows.len()
    }

    /// The entries of a row.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (usize, Expression)> + '_ {
        self.rows[row]
            .iter()
            .map(|(column, value)| (*column, *value))
    }

    /// Open rows that hold a column.
    pub(super) fn rows_with(&self, column: usize) -> impl Iterator<Item = usize> + '_ {
        self.columns[column].iter().copied()
    }

    /// Eliminates `column` from every other open row with the pivot in `row`.
    pub(super) fn eliminate(
        &mut self,
        pool: &mut Pool,
        row: usize,
        column: usize,
    ) -> Result<(), Vanished> {
        let pivot = self.entry(row, column);
        let pivot_row = self.rows[row].clone();
        self.open_rows.remove(&row);
        self.open_columns.remove(&column);
        for inner in pivot_row.keys() {
            self.columns[*inner].remove(&row);
        }
        let others: Vec<usize> = std::mem::take(&mut self.columns[column])
            .into_iter()
            .collect();
        let mut factors = Vec::with_capacity(others.len());
        for other in others {
            let entry = self.rows[other].remove(&column).unwrap_or(Expression::ZERO);
            let factor = pool.divide(entry, pivot).ok_or(Vanished)?;
            for (inner, value) in pivot_row.iter().filter(|(inner, _)| **inner != column) {
                let product = pool.multiply(factor, *value);
                let reduced = pool.subtract(self.entry(other, *inner), product);
                if reduced == Expression::ZERO {
                    self.rows[other].remove(inner);
                    self.columns[*inner].remove(&other);
                } else {
                    self.rows[other].insert(*inner, reduced);
                    self.columns[*inner].insert(other);
                }
            }
            let product = pool.multiply(factor, self.right[row]);
            self.right[other] = pool.subtract(self.right[other], product);
            factors.push((other, factor));
        }
        let others = pivot_row.into_iter().filter(|(other, _)| *other != column);
        self.steps.push(Step::Pivot(Elimination {
            row,
            column,
            pivot,
            others: others.collect(),
            factors,
        }));
        Ok(())
    }

    /// Eliminates as many columns as there are rows given by the inverse of their block. What these rows have in other columns
    /// and at the right, `solver` has solved for.
    pub(super) fn eliminate_together(
        &mut self,
        pool: &mut Pool,
        (rows, columns): (&[usize], &[usize]),
        solver: RestSolver,
        others: &[(usize, Vec<Expression>)],
        right: &[Expression],
    ) -> Result<(), Vanished> {
        for (place, row) in rows.iter().enumerate() {
            for column in columns {
                self.set(*row, *column, Expression::ZERO);
            }
            self.set(*row, columns[place], Expression::ONE);
            for (other, solved) in others {
                self.set(*row, *other, solved[place]);
            }
            self.set_right(*row, right[place]);
        }
        self.steps.push(Step::Inverse {
            rows: rows.to_vec(),
            solver,
        });
        let mut pairs = rows.iter().zip(columns);
        pairs.try_for_each(|(row, column)| self.eliminate(pool, *row, *column))
    }

    /// What is left, as a dense system: columns, matrix, right side.
    pub(super) fn rest(&self) -> (Vec<usize>, Matrix, Vec<Expression>) {
        let columns: Vec<usize> = self.open_columns.iter().copied().collect();
        let mut entries = Vec::with_capacity(columns.len() * self.open_rows.len());
        for row in &self.open_rows {
            entries.extend(columns.iter().map(|column| self.entry(*row, *column)));
        }
        let right = self.open_rows.iter().map(|row| self.right[*row]).collect();
        let matrix = Matrix::new(self.open_rows.len(), columns.len(), entries);
        (columns, matrix, right)
    }

    /// All unknowns, given those that were left.
    pub(super) fn back_substitute(
        &self,
        pool: &mut Pool,
        columns: &[usize],
        values: &[Expression],
    ) -> Result<Vec<Expression>, Vanished> {
        let mut solution = vec![Expression::ZERO; self.rows.len()];
        for (column, value) in columns.iter().zip(values) {
            solution[*column] = *value;
        }
        back_substitute(pool, &self.steps, &self.right, &mut solution).ok_or(Vanished)?;
        Ok(solution)
    }

    /// The equations as they are.
    pub(super) fn equations(&self) -> (Vec<BTreeMap<usize, Expression>>, Vec<Expression>) {
        (self.rows.clone(), self.right.clone())
    }

    /// How unknowns were eliminated.
    pub(super) fn into_steps(self) -> Vec<Step> {
        self.steps
    }
}
