//! What an equation is once it is differentiated: linear in rates.

use std::collections::BTreeMap;

use crate::symbolic::{Expression, Pool};

/// A sum of unknowns with coefficients, and what is known.
pub(super) struct Linear {
    pub(super) terms: BTreeMap<usize, Expression>,
    pub(super) constant: Expression,
    /// An input whose own derivative would be needed.
    pub(super) input: Option<usize>,
}

impl Default for Linear {
    fn default() -> Self {
        Self {
            terms: BTreeMap::new(),
            constant: Expression::ZERO,
            input: None,
        }
    }
}

impl Linear {
    pub(super) fn add(&mut self, pool: &mut Pool, unknown: usize, coefficient: Expression) {
        let known = self.terms.entry(unknown).or_insert(Expression::ZERO);
        *known = pool.add(*known, coefficient);
    }

    pub(super) fn add_scaled(&mut self, pool: &mut Pool, other: &Self, factor: Expression) {
        for (unknown, coefficient) in &other.terms {
            let scaled = pool.multiply(*coefficient, factor);
            self.add(pool, *unknown, scaled);
        }
        let scaled = pool.multiply(other.constant, factor);
        self.constant = pool.add(self.constant, scaled);
        self.input = self.input.or(other.input);
    }
}
