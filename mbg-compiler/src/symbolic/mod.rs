//! Symbolic expressions.

/// A handle to an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Expression(u32);

/// A dense matrix of expressions, by rows.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Entries by rows.
    pub entries: Vec<Expression>,
}

/// A product of matrices, kept as factors.
#[derive(Clone, Debug)]
pub struct Product;
