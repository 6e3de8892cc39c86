//! Newton's iteration for a few equations, halving steps that do not help.

use nalgebra::{SMatrix, SVector};

use crate::Real;

/// Most evaluations of residual and Jacobian.
pub const ITERATIONS: usize = 100;

/// Steps shorter than this are not tried.
const SHORTEST: f64 = 1e-6;

/// What an iteration has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Solved<T, const K: usize> {
    /// The last point.
    pub(super) solution: SVector<T, K>,
    /// Largest residual there, each in units of its row of the Jacobian and of the unknowns.
    pub(super) residual: f64,
    /// Evaluations that it took.
    pub(super) iterations: usize,
    /// Whether the residuals are zero but for rounding.
    pub(super) converged: bool,
}

/// Makes the residuals zero, beginning at `start`.
///
/// It has converged when the next step is nothing but rounding, or when it is small and the residuals become no smaller
/// by it. That step is made all the same, so that the slopes of dual numbers are right as well.
pub(super) fn newton<T: Real, const K: usize>(
    start: SVector<T, K>,
    evaluate: impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
) -> Solved<T, K> {
    let mut point = start;
    let mut scale = start.map(|z| seen(z.abs()));
    let (mut residual, mut jacobian) = evaluate(&point);
    let mut iterations = 1;
    loop {
        let mut step = divided(jacobian, residual);
        if residual.iter().all(|value| seen(*value) == 0.0)
            && step.iter().any(|step| seen(*step).is_nan())
        {
            // At a solution where the Jacobian does not exist.
            step = step.map(|_| T::from_f64(0.0));
        }
        scale.zip_apply(&point, |scale, z| *scale = scale.max(seen(z.abs())));
        let relative = largest(&step, &scale);
        let end = |converged: bool, iterations: usize| Solved {
            solution: point - step,
            residual: relative,
            iterations,
            converged,
        };
        if relative <= 4.0 * T::EPSILON || iterations >= ITERATIONS {
            return end(relative <= 4.0 * T::EPSILON, iterations);
        }
        let before = norm(&residual, &jacobian);
        let mut factor = 1.0;
        loop {
            let trial = point.zip_map(&step, |z, step| z - T::from_f64(factor) * step);
            let (trial_residual, trial_jacobian) = evaluate(&trial);
            iterations += 1;
            if norm(&trial_residual, &jacobian) <= (1.0 - 0.1 * factor) * before {
                (point, residual, jacobian) = (trial, trial_residual, trial_jacobian);
                break;
            }
            if relative < T::SINGULAR || factor < SHORTEST || iterations >= ITERATIONS {
                let small = largest(&step, &scale.map(|scale| scale + 1.0)) < T::SINGULAR;
                return end(small, iterations);
            }
            factor *= 0.5;
        }
    }
}

fn seen<T: Real>(value: T) -> f64 {
    value.find(|_| true).unwrap_or(f64::NAN)
}

/// Largest step in units of what the unknown has been; NaN when one is.
fn largest<T: Real, const K: usize>(step: &SVector<T, K>, scale: &SVector<f64, K>) -> f64 {
    let mut largest = 0.0;
    for (step, scale) in step.iter().zip(scale.iter()) {
        let error = seen(step.abs()) / (scale + f64::MIN_POSITIVE);
        if error.is_nan() || error > largest {
            largest = error;
        }
        if error.is_nan() {
            break;
        }
    }
    largest
}

/// Sum of residuals, each over the sum of its row of the Jacobian.
fn norm<T: Real, const K: usize>(residual: &SVector<T, K>, jacobian: &SMatrix<T, K, K>) -> f64 {
    let row = |row: usize| {
        let sum: f64 = jacobian
            .row(row)
            .iter()
            .map(|entry| seen(entry.abs()))
            .sum();
        seen(residual[row].abs()) / (sum + f64::MIN_POSITIVE)
    };
    (0..K).map(row).sum()
}

/// `J⁻¹ r` by elimination with row pivots.
fn divided<T: Real, const K: usize>(
    mut jacobian: SMatrix<T, K, K>,
    mut residual: SVector<T, K>,
) -> SVector<T, K> {
    for column in 0..K {
        let mut largest = column;
        for row in column + 1..K {
            if seen(jacobian[(row, column)].abs()) > seen(jacobian[(largest, column)].abs()) {
                largest = row;
            }
        }
        jacobian.swap_rows(column, largest);
        residual.swap_rows(column, largest);
        for row in 0..K {
            if row != column {
                let factor = jacobian[(row, column)] / jacobian[(column, column)];
                for inner in column..K {
                    let above = jacobian[(column, inner)];
                    jacobian[(row, inner)] -= factor * above;
                }
                let above = residual[column];
                residual[row] -= factor * above;
            }
        }
    }
    SVector::from_fn(|row, _| residual[row] / jacobian[(row, row)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_far_from_its_root() {
        let solved = newton(SVector::from([0.0]), |z: &SVector<f64, 1>| {
            let exponential = f64::exp(z[0] / 0.025);
            let residual = 1e-12 * (exponential - 1.0) - (10.0 - z[0]) / 10.0;
            (
                SVector::from([residual]),
                SMatrix::from([[1e-12 / 0.025 * exponential + 0.1]]),
            )
        });
        assert!(solved.converged, "{solved:?}");
        let current = (10.0 - solved.solution[0]) / 10.0;
        let expected = 0.025 * f64::ln(current / 1e-12 + 1.0);
        assert!(f64::abs(solved.solution[0] - expected) < 1e-14);
    }
}
