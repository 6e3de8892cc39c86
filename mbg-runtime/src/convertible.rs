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
    /// [`Dual`] numbers, with the slopes along four states at once in a release build. A nonlinear algebraic loop is solved from zero.
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
        slopes::<T, Together<T>, N, P>(x, |x| {
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
        slopes::<T, Together<T>, M, P>(u, |u| {
            system.output(Dual::unchanging(t), &x, u, &mut Default::default())
        })
    }
}

/// Slopes along several components at once. Where nothing is optimised all numbers of a function are on the stack, and there it
/// is one component after the other.
#[cfg(not(debug_assertions))]
pub(crate) type Together<T> = <T as Real>::Stages;
#[cfg(debug_assertions)]
pub(crate) type Together<T> = T;

/// The derivatives of a function by each component, of as many at once as `L` has columns.
fn slopes<T: Real, L: Columns<T>, const K: usize, const P: usize>(
    at: &SVector<T, K>,
    function: impl Fn(&SVector<Dual<T, L>, K>) -> SVector<Dual<T, L>, P>,
) -> SMatrix<T, P, K> {
    let mut matrix = SMatrix::<T, P, K>::from_element(T::from_f64(0.0));
    for first in (0..K).step_by(L::COUNT) {
        let results = function(&along(at, first));
        keep_slopes(&mut matrix, first, &results);
    }
    matrix
}

/// A vector with slopes by its components from this one on, as many as there are columns.
pub(crate) fn along<T: Real, L: Columns<T>, const K: usize>(
    at: &SVector<T, K>,
    first: usize,
) -> SVector<Dual<T, L>, K> {
    let [zero, one] = [0.0, 1.0].map(T::from_f64);
    let mut at = at.map(Dual::unchanging);
    for (direction, component) in at.iter_mut().skip(first).take(L::COUNT).enumerate() {
        component.slope = L::from_columns(|it| if it == direction { one } else { zero });
    }
    at
}

/// Puts the slopes of results into the columns of a matrix from this one on.
pub(crate) fn keep_slopes<T: Real, L: Columns<T>, const K: usize, const P: usize>(
    matrix: &mut SMatrix<T, P, K>,
    first: usize,
    results: &SVector<Dual<T, L>, P>,
) {
    let columns = matrix.column_iter_mut().skip(first).take(L::COUNT);
    for (direction, mut column) in columns.enumerate() {
        for (entry, result) in column.iter_mut().zip(results) {
            *entry = *result.slope.as_columns().get(direction).unwrap_or(entry);
        }
    }
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;
    use crate::Four;

    /// Of more components than go side by side, and no multiple of these.
    #[test]
    fn slopes_along_several_components_are_those_along_each() {
        let calls = Cell::new(0);
        let at = SVector::<f64, 11>::from_fn(|row, _| row as f64 - 4.5);
        let found = slopes::<_, Four<f64>, 11, 2>(&at, |x| {
            calls.set(calls.get() + 1);
            SVector::from([x.dot(x), x[3] * x[10]])
        });
        assert_eq!(calls.get(), 3);
        assert_eq!(found.row(0), (2.0 * at).transpose());
        let product = SVector::<f64, 11>::from_fn(|row, _| match row {
            3 => at[10],
            10 => at[3],
            _ => 0.0,
        });
        assert_eq!(found.row(1), product.transpose());
        let alone = slopes::<_, f64, 11, 2>(&at, |x| SVector::from([x.dot(x), x[3] * x[10]]));
        assert_eq!(found, alone);
    }
}
