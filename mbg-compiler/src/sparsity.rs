//! The pattern of `∂f/∂x`, and a plan of Gaussian elimination on it.
//!
//! Input: which states each rate depends on. Output: the order in which implicit methods eliminate the states of
//! `d I − s ∂f/∂x`, with the patterns of `L` and `U`. What kinematics repeat, such as one row per displacement that holds
//! nothing but its velocity, costs next to nothing in that order without being recognised.

use std::collections::{BTreeMap, BTreeSet};

use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Matrix, Pool, Symbol};

/// The columns of each row that can differ from zero.
pub type Pattern = Vec<BTreeSet<usize>>;

/// A plan of elimination with pivots on the diagonal; all numbers are those of states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Elimination {
    /// In which order the states are eliminated.
    pub order: Vec<usize>,
    /// By row the columns left of the diagonal, in order of elimination.
    pub lower: Vec<Vec<usize>>,
    /// By row the columns right of the diagonal, ascending.
    pub upper: Vec<Vec<usize>>,
}

/// The entries of a Jacobian that are not zero.
#[must_use]
pub fn of_entries(jacobian: &Matrix) -> Pattern {
    let rows = (0..jacobian.rows).map(|row| {
        let columns = 0..jacobian.columns;
        columns.filter(move |column| jacobian.at(row, *column) != Expression::ZERO)
    });
    rows.map(BTreeSet::from_iter).collect()
}

/// What rates depend on.
#[must_use]
pub fn of_dependence(pool: &Pool, rates: &[Expression], states: &[Symbol]) -> Pattern {
    let numbered = states.iter().enumerate();
    let places: BTreeMap<Symbol, usize> = numbered.map(|(place, state)| (*state, place)).collect();
    let row = |rate: &Expression| {
        let found = symbols(pool, &[*rate]);
        found.iter().filter_map(|it| places.get(it).copied()).collect()
    };
    rates.iter().map(row).collect()
}

impl Elimination {
    /// The plan for a pattern, whose diagonal always counts as filled: next comes the state whose elimination touches
    /// the fewest elements (Markowitz, *Management Science* 3 (1957), 255–269), of several the first.
    #[must_use]
    pub fn of(pattern: &Pattern) -> Self {
        let size = pattern.len();
        let mut rows = pattern.clone();
        let mut columns = vec![BTreeSet::new(); size];
        for (row, entries) in rows.iter_mut().enumerate() {
            entries.remove(&row);
            for column in entries.iter() {
                columns[*column].insert(row);
            }
        }
        let mut left: BTreeSet<usize> = (0..size).collect();
        let mut plan = Self {
            order: Vec::with_capacity(size),
            lower: vec![Vec::new(); size],
            upper: vec![Vec::new(); size],
        };
        let touched = |state: &usize, rows: &Pattern, columns: &Pattern| {
            rows[*state].len() * columns[*state].len()
        };
        while let Some(pivot) = left
            .iter()
            .copied()
            .min_by_key(|state| touched(state, &rows, &columns))
        {
            left.remove(&pivot);
            plan.order.push(pivot);
            let above = std::mem::take(&mut rows[pivot]);
            let below = std::mem::take(&mut columns[pivot]);
            for row in &below {
                plan.lower[*row].push(pivot);
                rows[*row].remove(&pivot);
                let filled = above.iter().filter(|column| *column != row);
                rows[*row].extend(filled);
            }
            for column in &above {
                columns[*column].remove(&pivot);
                let filled = below.iter().filter(|row| *row != column);
                columns[*column].extend(filled);
            }
            plan.upper[pivot] = above.into_iter().collect();
        }
        plan
    }

    /// Products that the factorisation subtracts, with one for each multiplier.
    #[must_use]
    pub fn operations(&self) -> usize {
        let multipliers = self.lower.iter().flatten();
        multipliers.map(|column| 1 + self.upper[*column].len()).sum()
    }

    /// Products that a solution takes.
    #[must_use]
    pub fn elements(&self) -> usize {
        let both = self.lower.iter().chain(&self.upper);
        self.order.len() + both.map(Vec::len).sum::<usize>()
    }
}
