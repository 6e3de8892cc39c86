//! Which entries of a Jacobian can differ from zero, and how it is eliminated.

/// The pattern of `∂f/∂x`, known at compile time.
///
/// Rows and columns are numbered as the states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sparsity {
    /// By row the columns, ascending, whose entries can differ from zero.
    pub rows: &'static [&'static [u16]],
    /// How implicit methods factorise `d I − s ∂f/∂x`; nothing where a search for pivots in all of it is as fast.
    pub elimination: Option<Elimination>,
}

/// A plan of Gaussian elimination with pivots on the diagonal.
///
/// `L` and `U` keep the numbers of the states. Their pattern is that of the matrix with whatever fills in; `mbg!` orders
/// by least fill (H. M. Markowitz, *Management Science* 3 (1957), 255–269).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Elimination {
    /// The states in the order in which they are eliminated.
    pub order: &'static [u16],
    /// By row the columns of `L` left of the diagonal, in order of elimination.
    pub lower: &'static [&'static [u16]],
    /// By row the columns of `U` right of the diagonal, in any order.
    pub upper: &'static [&'static [u16]],
}
