//! Blocks that hold unknowns of their own in coefficients and right sides.
//!
//! Unknowns are eliminated as far as division by constants allows; what is left is defined by as many residuals, and
//! the program finds it by a Newton iteration. Kept are preferably the arguments of the nonlinear laws themselves: an
//! argument is given up only for others that are zero together with it, so that an iteration that starts at zero
//! starts where exponentials are moderate.

use std::collections::{BTreeMap, BTreeSet};

use super::eliminate::System;
use super::solve::{Solver, places};
use super::{Failure, Loop, Undetermined};
use crate::symbolic::dense::{ADJUGATE, Pivots};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{
    Expression, Implicit, Matrix, Method, Pool, Rate, Substitution, Symbol, affine, jacobian,
};

impl Solver<'_> {
    /// Solves a block in which signals of its own unknowns stand.
    pub(super) fn by_tearing(
        &mut self,
        equations: &[usize],
        unknowns: &[usize],
    ) -> Result<(), Failure> {
        let mut tearing = self.torn(equations, unknowns)?;
        while let Some((row, column)) = tearing.pivot(self.pool) {
            self.note(tearing.system.entry(row, column), &[]);
            tearing.eliminate(self.pool, row, column)?;
        }
        let Tearing { system, held, .. } = tearing;
        let (columns, matrix, right) = system.rest();
        let iterated = held.iter().any(|held| !held.is_empty());
        let left: Vec<usize> = columns.iter().map(|column| unknowns[*column]).collect();
        let values = if iterated && !left.is_empty() {
            self.define(left, &matrix, &right, unknowns)?
        } else {
            self.linear(System::of(&matrix, right), &left, &[])?.0
        };
        if unknowns.len() > 1 || iterated {
            self.solution.loops.push(Loop {
                equations: equations.to_vec(),
                unknowns: unknowns.to_vec(),
                iterated: if iterated { columns.len() } else { 0 },
            });
        }
        let values = system.back_substitute(self.pool, &columns, &values)?;
        self.store(unknowns, values);
        Ok(())
    }

    /// The equations, with symbols for the block's own unknowns.
    fn torn<'b>(
        &mut self,
        equations: &[usize],
        unknowns: &'b [usize],
    ) -> Result<Tearing<'b>, Failure> {
        for unknown in unknowns {
            let symbol = self.pool.symbol(Symbol::Unknown(*unknown));
            self.show(*unknown, symbol);
        }
        let place = places(unknowns);
        let (mut rows, mut right, mut held) = (Vec::new(), Vec::new(), Vec::new());
        for equation in equations {
            let (mut row, mut rest) =
                self.sparse_row(&self.scalars.equations[*equation], &place)?;
            linearise(self.pool, &place, &mut row, &mut rest);
            held.push(own_symbols(self.pool, &place, &row, rest));
            rows.push(row);
            right.push(rest.negated());
        }
        let laws = (0..held.len())
            .filter(|row| !held[*row].is_empty())
            .collect();
        Ok(Tearing {
            unknowns,
            system: System::new(rows, right),
            held,
            laws,
        })
    }

    /// Tells the pool which residuals give the unknowns that are left; gives their symbols.
    fn define(
        &mut self,
        left: Vec<usize>,
        matrix: &Matrix,
        right: &[Expression],
        unknowns: &[usize],
    ) -> Result<Vec<Expression>, Failure> {
        let symbols: Vec<Symbol> = left.iter().copied().map(Symbol::Unknown).collect();
        let values: Vec<Expression> = symbols
            .iter()
            .map(|symbol| self.pool.symbol(*symbol))
            .collect();
        let sums = matrix.times(self.pool, &Matrix::column(values.clone()));
        let residuals: Vec<Expression> = sums
            .entries
            .iter()
            .zip(right)
            .map(|(sum, right)| self.pool.subtract(*sum, *right))
            .collect();
        let jacobian = jacobian(self.pool, &residuals, &symbols);
        let Some(inverse) = inverted(self.pool, &jacobian) else {
            return Err(Failure::Undetermined(Box::new(Undetermined {
                unknowns: unknowns.to_vec(),
                left,
                residuals,
                jacobian,
            })));
        };
        self.pool.define(Implicit {
            unknowns: left,
            method: Method::Newton {
                residuals,
                jacobian,
                inverse,
            },
        });
        Ok(values)
    }
}

/// The inverse of a matrix; none if it is singular.
fn inverted(pool: &mut Pool, matrix: &Matrix) -> Option<Matrix> {
    let size = matrix.rows;
    let pivots = Pivots::of(pool, matrix)?;
    let mut inverse = Vec::with_capacity(size * size);
    for row in 0..size {
        let mut unit = vec![Expression::ZERO; size];
        unit[row] = Expression::ONE;
        inverse.extend(pivots.solve(pool, &unit, &mut Expression::ONE.clone())?);
    }
    Some(Matrix::new(size, size, inverse).transpose())
}

/// The block's own unknown behind a symbol, by place.
fn own(place: &BTreeMap<usize, usize>, symbol: &Symbol) -> Option<usize> {
    match symbol {
        Symbol::Unknown(unknown) => place.get(unknown).copied(),
        _ => None,
    }
}

/// Where a symbol enters linearly, now that what is known is put in, it becomes an ordinary unknown.
fn linearise(
    pool: &mut Pool,
    place: &BTreeMap<usize, usize>,
    row: &mut BTreeMap<usize, Expression>,
    rest: &mut Expression,
) {
    for symbol in symbols(pool, &[*rest]) {
        let Some(column) = own(place, &symbol) else {
            continue;
        };
        let unknown = |symbol: &Symbol| own(place, symbol).is_some();
        if let Some((slope, without)) = affine(pool, *rest, symbol, unknown) {
            let known = row.remove(&column).unwrap_or(Expression::ZERO);
            let sum = pool.add(known, slope);
            if sum != Expression::ZERO {
                row.insert(column, sum);
            }
            *rest = without;
        }
    }
}

/// Places of the unknowns that a row holds as symbols.
fn own_symbols(
    pool: &Pool,
    place: &BTreeMap<usize, usize>,
    row: &BTreeMap<usize, Expression>,
    rest: Expression,
) -> BTreeSet<usize> {
    let parts: Vec<Expression> = row.values().copied().chain([rest]).collect();
    let found = symbols(pool, &parts);
    found
        .iter()
        .filter_map(|symbol| own(place, symbol))
        .collect()
}

/// A block that is being made smaller.
struct Tearing<'a> {
    unknowns: &'a [usize],
    system: System,
    /// Columns that coefficients and right side of each row hold as symbols.
    held: Vec<BTreeSet<usize>>,
    /// Rows that hold symbols and are as they were written.
    laws: BTreeSet<usize>,
}

impl Tearing<'_> {
    /// The next pivot, if there is one that is worth it; among equals the one that fills in least (Markowitz 1957).
    fn pivot(&self, pool: &Pool) -> Option<(usize, usize)> {
        let entering: BTreeSet<usize> = self.held.iter().flatten().copied().collect();
        let large = self.system.open().len() > ADJUGATE;
        let mut best = None;
        for row in self.system.open() {
            let linear = self.held[*row].is_empty();
            let homogeneous = self.system.right(*row) == Expression::ZERO;
            for (column, _) in self.system.row(*row) {
                let enters = entering.contains(&column);
                let class = match (self.system.rate(pool, *row, column), linear, enters) {
                    // A law gives its result more exactly than a balance of large numbers does.
                    (Rate::Constant, false, false) if self.laws.contains(row) => 0,
                    (Rate::Constant, true, false) => 1,
                    (Rate::Constant, true, true) if homogeneous => 2,
                    (Rate::Constant, false, false) => 3,
                    // A large iteration is worth an assumption about parameters.
                    (Rate::Parameter, true, false) if large => 4,
                    (Rate::Parameter, false, false) if large => 5,
                    _ => continue,
                };
                let candidate = (class, self.system.fill(*row, column), *row, column);
                if best.is_none_or(|best| candidate < best) {
                    best = Some(candidate);
                }
            }
        }
        best.map(|(_, _, row, column)| (row, column))
    }

    fn eliminate(&mut self, pool: &mut Pool, row: usize, column: usize) -> Result<(), Failure> {
        let own = self.held[row].clone();
        for other in self.system.rows_with(column) {
            self.held[other].extend(&own);
            self.laws.remove(&other);
        }
        if self.held.iter().any(|held| held.contains(&column)) {
            self.replace(pool, row, column)?;
        }
        self.system.eliminate(pool, row, column)?;
        Ok(())
    }

    /// Puts what a homogeneous row says of an unknown in the place of its symbol.
    fn replace(&mut self, pool: &mut Pool, row: usize, column: usize) -> Result<(), Failure> {
        let pivot = self.system.entry(row, column);
        let others = self.system.row(row);
        let others: Vec<(usize, Expression)> =
            others.filter(|(other, _)| *other != column).collect();
        let mut sum = Expression::ZERO;
        for (other, coefficient) in &others {
            let symbol = pool.symbol(Symbol::Unknown(self.unknowns[*other]));
            let term = pool.multiply(*coefficient, symbol);
            sum = pool.subtract(sum, term);
        }
        let value = pool.divide(sum, pivot).ok_or(Failure::Singular)?;
        let mut substitution = Substitution::new();
        substitution.set(Symbol::Unknown(self.unknowns[column]), value);
        self.system.replace(pool, &mut substitution)?;
        for held in &mut self.held {
            if held.remove(&column) {
                held.extend(others.iter().map(|(other, _)| *other));
            }
        }
        Ok(())
    }
}
