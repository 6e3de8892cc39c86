//! Unknowns that equations give, and not expressions.
//!
//! An iteration finds the numbers; what depends on them is symbolic all the same. With residuals `F(z, x) = 0` the
//! unknowns `z` are symbols on which later expressions stand, and their derivatives follow from the implicit function
//! theorem, `∂z/∂x = −(∂F/∂z)⁻¹ ∂F/∂x`, whatever way the numbers were found.

use super::matrix::Matrix;
use super::pool::{Expression, Symbol};

/// As many equations as unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Implicit {
    /// Numbers of the unknowns, which are [`Symbol::Unknown`]s.
    pub unknowns: Vec<usize>,
    /// What the unknowns make zero.
    pub residuals: Vec<Expression>,
    /// Derivatives of the residuals, by rows, with respect to the unknowns, by columns.
    pub jacobian: Matrix,
    /// Its inverse.
    pub inverse: Matrix,
}

/// One unknown of one [`Implicit`] of a pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the definition.
    pub number: usize,
    /// Which of its unknowns.
    pub row: usize,
}

impl Implicit {
    /// The symbols of the unknowns.
    pub fn symbols(&self) -> impl Iterator<Item = Symbol> {
        self.unknowns.iter().copied().map(Symbol::Unknown)
    }

    /// Everything an iteration evaluates: residuals, then their derivatives by rows.
    #[must_use]
    pub fn evaluated(&self) -> Vec<Expression> {
        [&self.residuals[..], &self.jacobian.entries].concat()
    }
}
