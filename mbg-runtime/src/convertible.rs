//! A model with its numbers in another scalar.

use crate::{Real, System};

/// A model that is written for every scalar.
///
/// `mbg!` implements it for all models.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a model whose numbers can be converted to another scalar",
    note = "`mbg!` makes such models"
)]
pub trait Convertible<T: Real, const N: usize, const M: usize, const P: usize>:
    System<T, N, M, P>
{
    /// The model of another scalar. What a model with nonlinear algebraic loops remembers is not taken along.
    type With<L: Real>: System<L, N, M, P>;

    /// Whether the derivative is straight-line code: it solves no equations.
    const STRAIGHT: bool;

    /// The same model with each of its numbers converted.
    fn converted<L: Real>(&self, convert: impl Fn(T) -> L) -> Self::With<L>;
}
