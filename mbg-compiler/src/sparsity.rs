//! The pattern of `∂f/∂x`, and a plan of Gaussian elimination on it.
//!
//! Input: which states each rate depends on. Output: the order in which implicit methods eliminate the states of
//! `d I − s ∂f/∂x`, with the patterns of `L` and `U`. What kinematics repeat, such as one row per displacement that holds
//! nothing but its velocity, costs next to nothing in that order without being recognised.

use std::collections::BTreeSet;

use crate::symbolic::Expression;

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

/// The entries of a Jacobian by rows of a length that are not zero.
#[must_use]
pub fn of_entries(entries: &[Expression], columns: usize) -> Pattern {
    let filled = |row: &[Expression]| {
        let places = 0..row.len();
        places
            .filter(|place| row[*place] != Expression::ZERO)
            .collect()
    };
    entries.chunks(columns.max(1)).map(filled).collect()
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
        multipliers
            .map(|column| 1 + self.upper[*column].len())
            .sum()
    }

    /// Products that a solution takes.
    #[must_use]
    pub fn elements(&self) -> usize {
        let both = self.lower.iter().chain(&self.upper);
        self.order.len() + both.map(Vec::len).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pattern(rows: &[&[usize]]) -> Pattern {
        let rows = rows.iter().map(|row| row.iter().copied().collect());
        rows.collect()
    }

    #[test]
    fn an_arrow_does_not_fill() {
        let plan = Elimination::of(&pattern(&[&[0, 1, 2, 3], &[0, 1], &[0, 2], &[0, 3]]));
        assert_eq!(plan.order, [1, 2, 0, 3]);
        assert_eq!((plan.operations(), plan.elements()), (6, 10));
    }

    #[test]
    fn kinematics_cost_nothing() {
        // Displacements 0 and 1 are the integrals of 2 and 3, on which nothing depends but through them.
        let plan = Elimination::of(&pattern(&[&[2], &[3], &[2, 3], &[2, 3]]));
        assert_eq!(plan.operations(), 2);
    }

    proptest! {
        /// Elimination in the order of the plan, by numbers, leaves nothing beside the patterns of `L` and `U`.
        #[test]
        fn every_pattern_is_eliminated(
            size in 1_usize..12,
            seed in proptest::collection::vec(any::<(bool, bool, i8)>(), 144),
        ) {
            let filled = |row: usize, column: usize| {
                let (a, b, _) = seed[12 * row + column];
                a && b
            };
            let entry = |row: usize, column: usize| {
                let number = f64::from(seed[12 * row + column].2) / 128.0 + 0.003;
                if row == column { 20.0 + number } else if filled(row, column) { number } else { 0.0 }
            };
            let row = |row: usize| (0..size).filter(|column| filled(row, *column)).collect();
            let plan = Elimination::of(&(0..size).map(row).collect());
            let sorted: BTreeSet<usize> = plan.order.iter().copied().collect();
            prop_assert_eq!(sorted.len(), size);
            let mut a: Vec<Vec<f64>> = (0..size).map(|row| (0..size).map(|column| entry(row, column)).collect()).collect();
            for (place, pivot) in plan.order.iter().copied().enumerate() {
                let rest = &plan.order[place + 1..];
                for row in rest.iter().copied() {
                    prop_assert!(a[row][pivot] == 0.0 || plan.lower[row].contains(&pivot));
                    prop_assert!(a[pivot][row] == 0.0 || plan.upper[pivot].contains(&row));
                    let factor = a[row][pivot] / a[pivot][pivot];
                    for column in rest.iter().copied() {
                        a[row][column] -= factor * a[pivot][column];
                    }
                }
            }
            for row in &plan.lower {
                let places: Vec<_> = row.iter().map(|it| plan.order.iter().position(|other| other == it)).collect();
                prop_assert!(places.is_sorted());
            }
        }
    }
}
