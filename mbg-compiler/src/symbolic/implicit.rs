//! Unknowns that equations give, and not expressions.
//!
//! An iteration finds the numbers; what depends on them is symbolic all the same. With residuals `F(z, x) = 0` the
//! unknowns `z` are symbols on which later expressions stand, and their derivatives follow from the implicit function
//! theorem, `∂z/∂x = −(∂F/∂z)⁻¹ ∂F/∂x`, whatever way the numbers were found.

use super::expression::{Expression, Symbol};
use super::matrix::Matrix;
use super::pool::Pool;

/// As many equations as unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Implicit {
    /// Numbers of the unknowns, which are [`Symbol::Unknown`]s.
    pub unknowns: Vec<usize>,
    /// What the unknowns make zero.
    pub residuals: Vec<Expression>,
    /// Derivatives of the residuals, by rows, with respect to the unknowns, by columns.
    pub jacobian: Matrix,
    /// How the unknowns are found.
    pub method: Method,
}

/// How unknowns are found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Method {
    /// By Newton's iteration.
    Newton {
        /// The inverse of the Jacobian.
        inverse: Matrix,
    },
    /// The equations are linear, `S z = b`, with a symmetric positive semidefinite matrix that may be singular: the
    /// unknowns are those of least norm.
    LeastNorm {
        /// The right side `b`.
        right: Vec<Expression>,
        /// Whether the unknowns are derivatives of others; they are not differentiated again.
        slope: bool,
    },
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

    /// Unknowns of least norm of `matrix · z = right`.
    pub fn least_norm(
        pool: &mut Pool,
        unknowns: Vec<usize>,
        matrix: Matrix,
        right: Vec<Expression>,
        slope: bool,
    ) -> Self {
        let symbols = unknowns.iter().copied().map(Symbol::Unknown);
        let values = symbols.map(|symbol| pool.symbol(symbol)).collect();
        let product = matrix.times(pool, &Matrix::column(values));
        let residuals = product
            .entries
            .iter()
            .zip(&right)
            .map(|(sum, right)| pool.subtract(*sum, *right))
            .collect();
        Self {
            unknowns,
            residuals,
            jacobian: matrix,
            method: Method::LeastNorm { right, slope },
        }
    }

    /// Everything a solve evaluates: residuals or right sides, then the derivatives of residuals by rows.
    #[must_use]
    pub fn evaluated(&self) -> Vec<Expression> {
        let first = match &self.method {
            Method::Newton { .. } => &self.residuals,
            Method::LeastNorm { right, .. } => right,
        };
        [&first[..], &self.jacobian.entries].concat()
    }
}
