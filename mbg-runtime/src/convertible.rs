//! A model with its numbers in another scalar.

use crate::{Real, System};

/// A model that is written for every scalar.
///
/// `mbg!` implements it for models without nonlinear algebraic loops.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a model whose numbers can be converted to another scalar",
    note = "`mbg!` makes such models, where they have no nonlinear algebraic loops"
)]
pub trait Convertible<T: Real, const N: usize, const M: usize, const P: usize>:
    System<T, N, M, P>
{
    /// The model of another scalar.
    type With<L: Real>: System<L, N, M, P, Memory = ()>;

    /// Whether the derivative is straight-line code: it solves no equations.
    const STRAIGHT: bool;

    /// The same model with each of its numbers converted.
    fn converted<L: Real>(&self, convert: impl Fn(T) -> L) -> Self::With<L>;
}
