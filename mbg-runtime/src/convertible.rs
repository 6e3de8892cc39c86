//! A model with its numbers in another scalar.

use nalgebra::{SMatrix, SVector};

use crate::{Columns, Dual, Real, System};

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

    /// The output matrix `∂y/∂x`, as observers and filters take it at every sample, exact but for rounding: the outputs on
    /// [`Dual`] numbers with the slopes along four states at once. A nonlinear algebraic loop is solved from zero.
    ///
    /// ```
    /// use mbg_runtime::{Convertible, System, mbg};
    /// use nalgebra::{Matrix1x2, SVector};
    ///
    /// mbg! {
    ///     /// A pendulum whose tip a camera sees.
    ///     model Pendulum {
    ///         1 joint {
    ///             I rod { inertia: 0.5 }
    ///             C weight { effort: 20.0 * sin(q) }
    ///         }
    ///         output height: m = -2.0 * cos(weight.q);
    ///     }
    /// }
    ///
    /// let pendulum = Pendulum::<f64>::new(PendulumParameters::default())?;
    /// let state = SVector::from([0.0, 0.5]);
    /// let seen = pendulum.output_jacobian_state(0.0, &state, &SVector::zeros());
    /// assert!((seen - Matrix1x2::new(0.0, 2.0 * f64::sin(0.5))).norm() < 1e-15);
    /// # Ok::<(), mbg_runtime::ParameterError>(())
    /// ```
    fn output_jacobian_state(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
    ) -> SMatrix<T, P, N> {
        let (system, u) = (self.converted(Dual::unchanging), u.map(Dual::unchanging));
        slopes(x, |x| {
            system.output(Dual::unchanging(t), x, &u, &mut Default::default())
        })
    }

    /// The feedthrough matrix `∂y/∂u` likewise.
    fn output_jacobian_input(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
    ) -> SMatrix<T, P, M> {
        let (system, x) = (self.converted(Dual::unchanging), x.map(Dual::unchanging));
        slopes(u, |u| {
            system.output(Dual::unchanging(t), &x, u, &mut Default::default())
        })
    }
}

/// A number with its slopes along several components at once.
type Several<T> = Dual<T, <T as Real>::Stages>;

/// The derivatives of a function by each component.
fn slopes<T: Real, const K: usize, const P: usize>(
    at: &SVector<T, K>,
    function: impl Fn(&SVector<Several<T>, K>) -> SVector<Several<T>, P>,
) -> SMatrix<T, P, K> {
    let mut matrix = SMatrix::<T, P, K>::from_element(T::from_f64(0.0));
    let together = <T::Stages as Columns<T>>::COUNT;
    let unchanging: SVector<Several<T>, K> = at.map(Dual::unchanging);
    for first in (0..K).step_by(together) {
        let mut at = unchanging;
        for (direction, component) in at.iter_mut().skip(first).take(together).enumerate() {
            let unit = |column| T::from_f64(if column == direction { 1.0 } else { 0.0 });
            component.slope = T::Stages::from_columns(unit);
        }
        let results = function(&at);
        let columns = matrix.column_iter_mut().skip(first).take(together);
        for (direction, mut column) in columns.enumerate() {
            for (entry, result) in column.iter_mut().zip(&results) {
                *entry = *result.slope.as_columns().get(direction).unwrap_or(entry);
            }
        }
    }
    matrix
}
