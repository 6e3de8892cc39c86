//! Back onto constraints.

use core::iter;

use nalgebra::{SMatrix, SVector};

use super::least_norm::{Semidefinite, rank};
use super::{dot, everywhere, largest};
use crate::Real;

/// Corrections at most.
const ITERATIONS: usize = 32;
/// What the first correction adds to `G Gᵀ`, in units of a bound of its eigenvalues.
const SOFTENING: f64 = 1e-4;
/// Dampings of one correction tried at most.
const DAMPINGS: usize = 16;

/// Where a projection ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected<T, const N: usize> {
    /// The point, or the velocity.
    pub point: SVector<T, N>,
    /// Largest absolute value of a constraint there.
    pub residual: T,
    /// The constraint that has it; of several lanes the first that is out of tolerance.
    pub worst: usize,
    /// Corrections taken.
    pub iterations: usize,
    /// Whether every constraint is within the tolerance, in every lane.
    pub converged: bool,
}

/// The point near `start` where `M` constraints `g(q) = 0` hold to `tolerance`.
///
/// `evaluate` gives `g` and its Jacobian `G = ∂g/∂q`. `tolerance` is in the units of `g` and must leave room for its
/// rounding. The correction is that of Gauss and Newton of least norm,
///
/// ```text
/// q ← q − Gᵀ (G Gᵀ)⁺ g
/// ```
/// with [`least_norm`](super::least_norm) for the pseudoinverse, so that redundant constraints and singular positions do no harm. It is
/// damped until `|g|` falls, which a short enough one always achieves unless `g` is at a local minimum. There are at
/// most 32 corrections; after a step of integration it takes one or two. Where it does not lower `|g|`, constraints are
/// first divided by the largest number of their rows, since momenta of small machines stand beside rates and lengths, and where
/// that does not do either, it is of least norm in coordinates that are multiplied by the largest number of their columns.
///
/// **Near a singular position** rounding in `g` divided by a small singular value `σ` of `G` moves the point by far
/// more than `g` itself, and the velocities that fit the point by as much over `σ²`. So the first correction is softened:
/// with 1e-4 of a bound of its eigenvalues added to `G Gᵀ` it leaves alone what cannot be told from rounding, and takes
/// away all but some 1e-4 of the rest. A point that is within the tolerance from the first gets this
/// correction, too, if it lowers `|g|`, or what is left would grow on the way to such a position.
///
/// **Holding a coordinate**: where a column of `G` is set to zero that coordinate stays as it is, so that consistent
/// initial values can be found from a part of them.
///
/// When [`converged`](Projected::converged) is false the constraints cannot be met from there, and
/// [`worst`](Projected::worst) says which of them is open widest.
///
/// # Example
///
/// ```
/// use mbg_runtime::solve::project;
/// use nalgebra::{SMatrix, SVector};
///
/// // Onto the unit circle.
/// let found = project(SVector::from([3.0, 4.0]), 1e-14, |q: &SVector<f64, 2>| {
///     let g = q[0] * q[0] + q[1] * q[1] - 1.0;
///     (SVector::from([g]), SMatrix::from([[2.0 * q[0]], [2.0 * q[1]]]))
/// });
/// assert!(found.converged);
/// assert!((found.point - SVector::from([0.6, 0.8])).norm() < 1e-14);
/// ```
#[must_use]
pub fn project<T: Real, const M: usize, const N: usize>(
    start: SVector<T, N>,
    tolerance: f64,
    evaluate: impl Fn(&SVector<T, N>) -> (SVector<T, M>, SMatrix<T, M, N>),
) -> Projected<T, N> {
    let rank = T::from_f64(M as f64);
    let residual = |point: &SVector<T, N>| evaluate(point).0;
    project_from(
        start,
        evaluate(&start),
        (tolerance, rank),
        (&evaluate, residual),
    )
}

/// The same from a point where `g` and `G` are known, if `G` has this rank at most wherever the constraints hold, see
/// [`ranks`]. The last function gives `g` alone.
pub(crate) fn project_from<T: Real, const M: usize, const N: usize>(
    start: SVector<T, N>,
    (mut residual, mut jacobian): (SVector<T, M>, SMatrix<T, M, N>),
    (tolerance, rank): (f64, T),
    (evaluate, residual_at): (
        impl Fn(&SVector<T, N>) -> (SVector<T, M>, SMatrix<T, M, N>),
        impl Fn(&SVector<T, N>) -> SVector<T, M>,
    ),
) -> Projected<T, N> {
    let mut point = start;
    // Of a point that is the last one no Jacobian is needed.
    let mut is_here = true;
    let mut iterations = 0;
    for softening in iter::once(SOFTENING).chain(iter::repeat_n(0.0, ITERATIONS - 1)) {
        let met = holds(&residual, tolerance);
        if holds(&residual, 0.0) || (met && softening == 0.0) {
            break;
        }
        if !is_here {
            jacobian = evaluate(&point).1;
            is_here = true;
        }
        let limits = if met { (0.0, 1) } else { (tolerance, DAMPINGS) };
        let along = |step| descend(&point, &residual, &step, limits, &residual_at);
        let next = along(correction(&jacobian, &residual, softening, rank)).or_else(|| {
            if met || softening > 0.0 {
                return None;
            }
            // A constraint of small numbers was taken for rounding of one of large numbers.
            let (rows, right) = in_proportion(&jacobian, &residual);
            along(correction(&rows, &right, 0.0, rank))
                .or_else(|| along(balanced_correction(&jacobian, &residual, rank)))
        });
        if let Some((next, left)) = next {
            iterations += 1;
            is_here = false;
            (point, residual) = (next, left);
        } else if met || softening == 0.0 {
            break;
        }
    }
    if T::HAS_SLOPES && holds(&residual, tolerance) {
        point = with_slopes(point, evaluate(&point), rank);
    }
    Projected::new(point, &residual, tolerance, iterations)
}

/// A point that is within the tolerance, with the slopes of one that stays so: what has corrected it may have been softened, or
/// nothing, and slopes are not within the tolerance then. The point itself is left alone.
fn with_slopes<T: Real, const M: usize, const N: usize>(
    point: SVector<T, N>,
    (residual, jacobian): (SVector<T, M>, SMatrix<T, M, N>),
    rank: T,
) -> SVector<T, N> {
    let step = correction(&jacobian, &residual, 0.0, rank);
    point.zip_map(&step, |q, step| q.with_slopes_of(q - step))
}

fn square<T: Real, const M: usize>(residual: &SVector<T, M>) -> T {
    dot(&residual.data.0[0], &residual.data.0[0])
}

/// The velocity next to `velocity` with `G v = b` to `tolerance`: `v ← v − Gᵀ (G Gᵀ)⁺ (G v − b)`.
///
/// `b` is zero unless a constraint depends on time. Two corrections are taken at most: the equations are linear.
#[must_use]
pub fn project_velocity<T: Real, const M: usize, const N: usize>(
    velocity: SVector<T, N>,
    tolerance: f64,
    jacobian: &SMatrix<T, M, N>,
    right: &SVector<T, M>,
) -> Projected<T, N> {
    let rows = jacobian.transpose().data.0;
    let open = |velocity: &SVector<T, N>| {
        SVector::<T, M>::from_fn(|i, _| dot(&rows[i], &velocity.data.0[0]) - right[i])
    };
    let (mut point, rank) = (velocity, T::from_f64(M as f64));
    let mut residual = open(&point);
    let mut iterations = 0;
    while iterations < 2 && !holds(&residual, tolerance) {
        iterations += 1;
        let step = correction(jacobian, &residual, 0.0, rank);
        point.zip_apply(&step, |v, step| *v -= step);
        residual = open(&point);
    }
    if T::HAS_SLOPES && holds(&residual, tolerance) {
        point = with_slopes(point, (residual, *jacobian), rank);
    }
    Projected::new(point, &residual, tolerance, iterations)
}

/// `Gᵀ (G Gᵀ + s)⁺ g`, where `s` is `softening` times the largest sum of the absolute values in a row, which no eigenvalue
/// exceeds.
fn correction<T: Real, const M: usize, const N: usize>(
    jacobian: &SMatrix<T, M, N>,
    residual: &SVector<T, M>,
    softening: f64,
    rank: T,
) -> SVector<T, N> {
    let mut square = gram(jacobian);
    let softening = T::from_f64(softening)
        * largest(
            (0..M).map(|i| (0..M).fold(T::from_f64(0.0), |sum, j| sum + square[(i, j)].abs())),
        );
    (0..M).for_each(|i| square[(i, i)] += softening);
    let multipliers = Semidefinite::of_rank(square, rank).solution(residual);
    SVector::from_fn(|j, _| dot(&jacobian.data.0[j], &multipliers.data.0[0]))
}

/// The correction of least norm where each coordinate is measured in what it does to the constraints: beside the momentum of a
/// light rod, of which the column is large in all rows, rates are rounding else.
fn balanced_correction<T: Real, const M: usize, const N: usize>(
    jacobian: &SMatrix<T, M, N>,
    residual: &SVector<T, M>,
    rank: T,
) -> SVector<T, N> {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let units = SVector::<T, N>::from_fn(|j, _| {
        let size = largest(jacobian.column(j).iter().copied());
        one / zero.select_less(size, size, one)
    });
    let columns = SMatrix::<T, M, N>::from_fn(|i, j| units[j] * jacobian[(i, j)]);
    let (rows, right) = in_proportion(&columns, residual);
    correction(&rows, &right, 0.0, rank).zip_map(&units, |step, unit| unit * step)
}

/// `G Gᵀ`. Most constraints depend on a few coordinates; what is zero has no slope either where it is left out.
fn gram<T: Real, const M: usize, const N: usize>(jacobian: &SMatrix<T, M, N>) -> SMatrix<T, M, M> {
    let zero = T::from_f64(0.0);
    let mut sums = [[zero; M]; M];
    for column in &jacobian.data.0 {
        for (sums, factor) in sums.iter_mut().zip(column) {
            if *factor == zero {
                continue;
            }
            for (sum, element) in sums.iter_mut().zip(column) {
                *sum += *factor * *element;
            }
        }
    }
    SMatrix::from(sums)
}

/// How far from the start constraints are looked at, in each coordinate.
const AROUND: f64 = 0.03;
/// At how many points.
const POINTS: usize = 4;

/// The rank that `G` has where the constraints hold, near `start`: of all of them, and of some, by their numbers.
///
/// Off these points it may be higher. In an overconstrained mechanism, such as that of Bennett, constraints are redundant
/// only where all of them hold; a small error makes them independent, and forces that nothing bounds would correct it. And
/// at a singular position it is lower, so that some points around the start are looked at. Where none can be closed it is
/// taken to be full.
pub(crate) fn ranks<T: Real, const M: usize, const N: usize, const B: usize>(
    start: &SVector<T, N>,
    tolerance: f64,
    groups: [&[usize]; B],
    evaluate: impl Fn(&SVector<T, N>) -> (SVector<T, M>, SMatrix<T, M, N>),
) -> [T; B] {
    let full = groups.map(|group| T::from_f64(group.len() as f64));
    let mut found = [T::from_f64(0.0); B];
    let mut closed_around = false;
    for point in 0..=POINTS {
        let moved = SVector::from_fn(|i, _| {
            let part = (0.618 * (i + 1) as f64 + 0.414 * point as f64) % 1.0;
            let by = if point == 0 {
                0.0
            } else {
                AROUND * (2.0 * part - 1.0)
            };
            start[i] + T::from_f64(by)
        });
        let closed = project(moved, tolerance, &evaluate);
        if !closed.converged {
            continue;
        }
        closed_around |= point > 0;
        let square = gram(&balanced(evaluate(&closed.point).1));
        for (found, group) in found.iter_mut().zip(groups) {
            *found = found.max(rank(among(&square, group)));
        }
        let missing = full.iter().zip(&found).map(|(full, found)| *full - *found);
        if missing
            .into_iter()
            .all(|it| everywhere(it, |lane| lane <= 0.0))
        {
            return full;
        }
    }
    if closed_around { found } else { full }
}

/// A matrix of which every column and then every row has been divided by its largest element, so that units do not decide on
/// the rank.
fn balanced<T: Real, const M: usize, const N: usize>(
    mut matrix: SMatrix<T, M, N>,
) -> SMatrix<T, M, N> {
    let zero = T::from_f64(0.0);
    let scale = |size: T| zero.select_less(size, size, T::from_f64(1.0));
    for mut column in matrix.column_iter_mut() {
        let size = scale(largest(column.iter().copied()));
        column.apply(|element| *element = *element / size);
    }
    for mut row in matrix.row_iter_mut() {
        let size = scale(largest(row.iter().copied()));
        row.apply(|element| *element = *element / size);
    }
    matrix
}

/// A matrix without the rows and columns that are not in the group.
fn among<T: Real, const M: usize>(matrix: &SMatrix<T, M, M>, group: &[usize]) -> SMatrix<T, M, M> {
    SMatrix::from_fn(|i, j| {
        if group.contains(&i) && group.contains(&j) {
            matrix[(i, j)]
        } else {
            T::from_f64(0.0)
        }
    })
}

/// Constraints divided by the largest number of their rows.
fn in_proportion<T: Real, const M: usize, const N: usize>(
    jacobian: &SMatrix<T, M, N>,
    residual: &SVector<T, M>,
) -> (SMatrix<T, M, N>, SVector<T, M>) {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let by = SVector::<T, M>::from_fn(|i, _| {
        let size = largest((0..N).map(|j| jacobian[(i, j)]));
        one / zero.select_less(size, size, one)
    });
    (
        SMatrix::from_fn(|i, j| by[i] * jacobian[(i, j)]),
        by.zip_map(residual, |by, residual| by * residual),
    )
}

/// The next point and what is left there: the longest damped step that lowers `|g|` in every lane that is still out of
/// tolerance, if there is one.
fn descend<T: Real, const M: usize, const N: usize>(
    point: &SVector<T, N>,
    residual: &SVector<T, M>,
    step: &SVector<T, N>,
    (tolerance, dampings): (f64, usize),
    residual_at: &impl Fn(&SVector<T, N>) -> SVector<T, M>,
) -> Option<(SVector<T, N>, SVector<T, M>)> {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let open = largest(residual.data.0[0]);
    // Squares of what is left of a mechanism that comes to rest would be too small for numbers.
    let unit = one / zero.select_less(open, open, one);
    let square = |residual: &SVector<T, M>| square(&residual.map(|it| unit * it));
    let here = square(residual);
    let mut damping = one;
    for _ in 0..dampings {
        let next = point.zip_map(step, |q, step| q - damping * step);
        let left = residual_at(&next);
        let lower = square(&left).select_less(here, one, zero);
        let accepted = T::from_f64(tolerance).select_less(open, lower, one);
        if everywhere(accepted, |lane| lane == 1.0) {
            return Some((next, left));
        }
        damping = T::from_f64(0.5).select_less(accepted, damping, T::from_f64(0.5) * damping);
    }
    None
}

fn holds<T: Real, const M: usize>(residual: &SVector<T, M>, tolerance: f64) -> bool {
    residual
        .as_slice()
        .iter()
        .all(|g| everywhere(*g, |lane| lane.abs() <= tolerance))
}

impl<T: Real, const N: usize> Projected<T, N> {
    fn new<const M: usize>(
        point: SVector<T, N>,
        residual: &SVector<T, M>,
        tolerance: f64,
        iterations: usize,
    ) -> Self {
        let size = largest(residual.data.0[0]);
        let worst = residual
            .iter()
            .position(|g| !everywhere(g.abs() - size, |difference| difference < 0.0));
        Self {
            point,
            residual: size,
            worst: worst.unwrap_or(0),
            iterations,
            converged: holds(residual, tolerance),
        }
    }
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;
    use crate::Dual;
    use crate::solve::lanes::Pair;

    fn circle<T: Real>(q: &SVector<T, 2>) -> (SVector<T, 1>, SMatrix<T, 1, 2>) {
        let two = T::from_f64(2.0);
        let g = q[0] * q[0] + q[1] * q[1] - T::from_f64(1.0);
        (
            SVector::from([g]),
            SMatrix::from([[two * q[0]], [two * q[1]]]),
        )
    }

    /// A momentum of 1e-20 kg m²/s and a rate that move a slide by micrometres: rows that are 26 powers of ten apart.
    #[test]
    fn constraints_of_other_sizes_are_met() {
        let rows = SMatrix::<f64, 2, 3>::new(1e20, -1.0, 0.0, 0.0, 1e-6, 2e-6);
        let found = project(SVector::from([3e-20, 2.0, -5.0]), 1e-14, |x| {
            (rows * x, rows)
        });
        assert!(found.converged, "{found:?}");
        assert!((found.point[1] + 2.0 * found.point[2]).abs() < 1e-8);
    }

    /// The velocity of a pin, which a light rod by its momentum, a crank by its rate and a slide by its speed give.
    #[test]
    fn rates_beside_the_momentum_of_a_light_rod_are_corrected() {
        let closed = |start: f64, tolerance: f64, inertia: f64| {
            let [tilted, upright] = [0.3 / inertia, 0.8 / inertia];
            let rows = SMatrix::<f64, 2, 3>::new(tilted, -0.1, -1.0, upright, 0.2, 0.0);
            let found = project(SVector::from([start * inertia, 1.0, 0.5]), tolerance, |x| {
                (rows * x, rows)
            });
            assert!(found.converged, "{inertia:e} {found:?}");
            rows * found.point
        };
        for inertia in [1.0, 1e-4, 1e-9, 1e-18, 1e-24] {
            assert!(closed(-0.7, 1e-14, inertia).norm() < 1e-13);
        }
    }

    #[test]
    fn what_passes_zero_has_its_slope_in_products_of_rows() {
        let rows = SMatrix::<_, 2, 1>::new(Dual::variable(0.0), Dual::constant(2.0));
        let expected = [
            Dual {
                value: 0.0,
                slope: 2.0,
            },
            Dual::constant(4.0),
        ];
        assert_eq!(gram(&rows).data.0[1], expected);
        assert_eq!(gram(&rows).transpose().data.0[1], expected);
    }

    /// The nearest point is on the line to the centre.
    #[test]
    fn slopes_go_with_the_point() {
        // The first needs no correction, and the second a softened one.
        for size in [1.0, 1.0 + 1e-15, 1.0 + 1e-9, 1.01, 1.2, 5.0] {
            let start = SVector::from([Dual::variable(0.6 * size), Dual::constant(0.8 * size)]);
            let slopes = project(start, 1e-14, circle).point.map(|it| it.slope);
            let expected = SVector::from([0.64, -0.48]) / size;
            assert!((slopes - expected).norm() < 4e-15, "{size} {slopes}");
        }
    }

    #[test]
    fn point_on_a_circle() {
        for start in [[1e-3, 0.0], [0.6, 0.8], [100.0, 1.0], [-0.7, 0.9]] {
            let found = project(SVector::from(start), 1e-14, circle);
            assert!(found.converged, "{found:?}");
            // The correction of least norm points at the centre.
            let start: SVector<f64, 2> = SVector::from(start);
            assert!(
                (found.point - start / start.norm()).norm() < 1e-12,
                "{found:?}"
            );
        }
        assert_eq!(
            project(SVector::from([0.6, 0.8]), 1e-14, circle).iterations,
            0
        );
    }

    #[test]
    fn within_the_tolerance_it_is_corrected_once() {
        let found = project(SVector::from([0.6 + 1e-7, 0.8]), 1e-3, circle);
        assert_eq!(found.iterations, 1);
        assert!(found.residual < 1e-10, "{found:?}");
    }

    #[test]
    fn single_precision_and_lanes() {
        let found = project(SVector::from([3.0_f32, 4.0]), 1e-6, circle);
        assert!(found.converged && (found.point - SVector::from([0.6, 0.8])).norm() < 1e-6);
        let both = project(
            SVector::from([Pair([3.0, 0.6]), Pair([4.0, 0.8])]),
            1e-14,
            circle,
        );
        assert!(both.converged);
        assert_eq!(both.point.map(|q| q.0[1]), SVector::from([0.6, 0.8]));
    }

    #[test]
    fn where_nothing_helps_it_says_which_constraint() {
        // The circle, and a line that misses it.
        let found = project(SVector::from([0.5, 0.5]), 1e-12, |q| {
            let (g, jacobian) = circle(q);
            (
                SVector::from([g[0], q[1] - 3.0]),
                SMatrix::from([[jacobian[0], 0.0], [jacobian[1], 1.0]]),
            )
        });
        assert!(!found.converged, "{found:?}");
        assert!(found.residual > 0.1, "{found:?}");
        // At the centre no direction is better than another.
        let stuck = project(SVector::from([0.0, 0.0]), 1e-12, circle);
        assert_eq!(
            (stuck.converged, stuck.worst, stuck.residual),
            (false, 0, 1.0)
        );
    }

    /// Closing of a parallelogram of crank, coupler and rocker with absolute angles, all lengths 1, `copies` times.
    fn four_bar<const M: usize>(q: &SVector<f64, 3>) -> (SVector<f64, M>, SMatrix<f64, M, 3>) {
        let (sine, cosine) = (q.map(f64::sin), q.map(f64::cos));
        let g = [
            cosine[0] + cosine[1] - cosine[2] - 1.0,
            sine[0] + sine[1] - sine[2],
        ];
        let rows = [
            [-sine[0], -sine[1], sine[2]],
            [cosine[0], cosine[1], -cosine[2]],
        ];
        (
            SVector::from_fn(|i, _| g[i % 2]),
            SMatrix::from_fn(|i, j| rows[i % 2][j]),
        )
    }

    #[test]
    fn four_bar_through_its_singular_position() {
        // All links on one line: both rows of G are then (0, 0, 0) and (1, 1, −1).
        for angle in [0.3, 1e-3, 1e-6, 1e-9, 0.0] {
            let closed = SVector::from([angle, 0.0, angle]);
            let disturbed = closed + SVector::from([1e-7, -2e-7, 1e-7]);
            let found = project(disturbed, 1e-13, four_bar::<2>);
            assert!(found.converged, "{angle} {found:?}");
            assert!((found.point - closed).norm() < 1e-6, "{angle} {found:?}");
        }
    }

    #[test]
    fn there_are_as_many_jacobians_as_corrections() {
        let closed = SVector::from([0.8, 0.0, 0.8]);
        for aside in [1e-8, 0.3] {
            let start = closed + SVector::from([aside, -2.0 * aside, aside]);
            let count = Cell::new(1);
            let evaluate = |q: &SVector<f64, 3>| {
                count.set(count.get() + 1);
                four_bar::<2>(q)
            };
            let residual = |q: &SVector<f64, 3>| four_bar::<2>(q).0;
            let found = project_from(start, four_bar(&start), (1e-14, 2.0), (evaluate, residual));
            assert!(found.converged && found.iterations > 1, "{found:?}");
            assert_eq!(count.get(), found.iterations);
        }
    }

    #[test]
    fn redundant_closing() {
        let disturbed = SVector::from([0.8, 0.01, 0.79]);
        let once = project(disturbed, 1e-13, four_bar::<2>);
        let thrice = project(disturbed, 1e-13, four_bar::<6>);
        assert!(once.converged && thrice.converged);
        assert!((once.point - thrice.point).norm() < 1e-13);
    }

    #[test]
    fn ranks_are_those_of_closed_points() {
        let ranks = |start: [f64; 3]| {
            ranks(
                &start.into(),
                1e-12,
                [&[0, 1, 2, 3][..], &[1, 3]],
                four_bar::<4>,
            )
        };
        assert_eq!(ranks([0.8, 0.01, 0.79]), [2.0, 1.0]);
        // On one line one row is zero, but not beside.
        assert_eq!(ranks([0.0, 0.0, 0.0]), [2.0, 1.0]);
        // The third row is the first one and a square, zero where the second holds: a plane of rank 2.
        let squared = |q: &SVector<f64, 3>| {
            let g = SVector::from([q[0], q[1], q[0] + q[1] * q[1]]);
            let rows = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 2.0 * q[1], 0.0];
            (g, SMatrix::from_row_slice(&rows))
        };
        let all = [&[0, 1, 2][..]];
        assert_eq!(
            super::ranks(&SVector::from([0.1, 0.2, 0.3]), 1e-12, all, squared),
            [2.0]
        );
        // Two hinges and a slide of a machine of a hundredth of a millimetre, whose units do not make it redundant.
        let small = |q: &SVector<f32, 3>| {
            let arms = [1e-5, 0.0, 1.0, 0.0, 2e-5, 1.0, 1e-5, 1e-5, 1.0];
            let jacobian = SMatrix::<f32, 3, 3>::from_row_slice(&arms);
            (jacobian * q, jacobian)
        };
        assert_eq!(
            super::ranks(&SVector::zeros(), 1e-6, [&[0, 1][..]], small),
            [2.0]
        );
        // What cannot be closed may be regular.
        let open = |q: &SVector<f64, 1>| {
            (
                SVector::from([q[0], q[0] - 1.0]),
                SMatrix::from([[1.0, 1.0]]),
            )
        };
        assert_eq!(
            super::ranks(&SVector::from([0.0]), 1e-12, [&[0, 1][..]], open),
            [2.0]
        );
    }

    #[test]
    fn a_column_of_zeros_holds_a_coordinate() {
        let found = project(SVector::from([0.8, 0.4, 0.2]), 1e-13, |q| {
            let (g, mut jacobian) = four_bar::<2>(q);
            jacobian.set_column(0, &SVector::zeros());
            (g, jacobian)
        });
        assert!(found.converged);
        assert!(
            (found.point - SVector::from([0.8, 0.0, 0.8])).norm() < 1e-12,
            "{found:?}"
        );
    }

    #[test]
    fn velocities() {
        let closed = SVector::from([0.8, 0.0, 0.8]);
        let (_, jacobian) = four_bar::<6>(&closed);
        let found = project_velocity(
            SVector::from([1.0, 0.3, 0.5]),
            1e-14,
            &jacobian,
            &SVector::zeros(),
        );
        assert!(found.converged, "{found:?}");
        assert!(
            (found.point - SVector::from([0.75, 0.0, 0.75])).norm() < 1e-14,
            "{found:?}"
        );
        // What is along the constraint already has the slopes of what stays so: those of `v ⊥ (3, 4)` that turns.
        let turned = SVector::from([Dual::variable(0.8), Dual::constant(-0.6)]);
        let row = SMatrix::from([[Dual::constant(3.0)], [Dual::constant(4.0)]]);
        let slopes = project_velocity(turned, 1e-14, &row, &SVector::zeros()).point;
        let slopes = slopes.map(|it| it.slope);
        assert!(
            (slopes - SVector::from([0.64, -0.48])).norm() < 1e-14,
            "{slopes:?}"
        );
        let driven = jacobian * SVector::from([1.0, 2.0, 3.0]);
        let found = project_velocity(SVector::zeros(), 1e-14, &jacobian, &driven);
        assert!(found.converged, "{found:?}");
        let right = SVector::from([1.0, 1.0, 1.0, 1.0, 4.0, 1.0]);
        let impossible = project_velocity(SVector::zeros(), 1e-14, &jacobian, &right);
        assert_eq!((impossible.converged, impossible.worst), (false, 4));
    }
}
