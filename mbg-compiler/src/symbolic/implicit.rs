//! Unknowns that equations give, and not expressions.
//!
//! An iteration finds the numbers; what depends on them is symbolic all the same. With residuals `F(z, x) = 0` the
//! unknowns `z` are symbols on which later expressions stand, and their derivatives follow from the implicit function
//! theorem, `∂z/∂x = −(∂F/∂z)⁻¹ ∂F/∂x`, whatever way the numbers were found.

use super::expression::{Expression, Symbol};
use super::matrix::Matrix;

/// As many equations as unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Implicit {
    /// Numbers of the unknowns, which are [`Symbol::Unknown`]s.
    pub unknowns: Vec<usize>,
    /// How the unknowns are found.
    pub method: Method,
}

/// How unknowns are found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Method {
    /// By Newton's iteration.
    Newton {
        /// What the unknowns make zero.
        residuals: Vec<Expression>,
        /// Derivatives of the residuals, by rows, with respect to the unknowns, by columns.
        jacobian: Matrix,
        /// The inverse of the Jacobian.
        inverse: Matrix,
    },
    /// The equations are linear, `A z = b`, and solved with numbers.
    Linear {
        /// The matrix `A`.
        matrix: Matrix,
        /// The right side `b`.
        right: Vec<Expression>,
        /// What the matrix is like.
        kind: Kind,
    },
    /// The equations have the matrix of an earlier definition of the kind before, and a right side of their own. Such
    /// are the derivatives of its unknowns; they are not differentiated again.
    Slope {
        /// Number of the earlier definition.
        of: usize,
        /// The right side.
        right: Vec<Expression>,
    },
}

/// What is known of a matrix of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Symmetric and positive semidefinite; it may be singular, and the unknowns are those of least norm.
    Semidefinite,
    /// Regular in general, with pivots that are chosen when the numbers are known.
    Regular,
    /// The same, and symmetric: where all pivots are positive in order, as those of inertias are, none is chosen.
    Symmetric,
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

    /// Everything a solve evaluates: residuals, then their derivatives by rows; or right sides, then the matrix by rows
    /// unless an earlier definition has it.
    #[must_use]
    pub fn evaluated(&self) -> Vec<Expression> {
        match &self.method {
            Method::Newton {
                residuals,
                jacobian,
                ..
            } => [&residuals[..], &jacobian.entries].concat(),
            Method::Linear { matrix, right, .. } => [&right[..], &matrix.entries].concat(),
            Method::Slope { right, .. } => right.clone(),
        }
    }

    /// The earlier definition whose matrix it uses.
    #[must_use]
    pub fn earlier(&self) -> Option<usize> {
        match self.method {
            Method::Slope { of, .. } => Some(of),
            Method::Newton { .. } | Method::Linear { .. } => None,
        }
    }
}
