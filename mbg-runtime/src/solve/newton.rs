//! Systems of nonlinear equations.

use nalgebra::{SMatrix, SVector};

use super::dense::Regular;
use super::{dot, everywhere, largest};
use crate::Real;

/// Points at which a system is linearised at most.
pub const ITERATIONS: usize = 50;
/// Dampings of one step tried at one point at most; the last one is below 1e-14.
const DAMPINGS: usize = 24;
/// In units of the precision: changes below it may be rounding of an unknown that is zero.
const ROUNDING: f64 = 64.0;
/// A correction that is longer than this part of the one before comes no nearer.
const SHRINKS: f64 = 0.9;
/// How often an iteration that came to a point where the Jacobian is singular goes on from beside it.
const ASIDE: usize = 4;
/// In units of the precision: what an evaluation leaves of equations, beside their terms, when nothing but rounding is left.
const LEFT: f64 = 4.0;

/// What [`newton`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved<T, const K: usize> {
    /// The unknowns; the last that were tried when the iteration did not converge.
    pub solution: SVector<T, K>,
    /// `max |fᵢ| / Σⱼ |Jᵢⱼ| sⱼ` where the equations were evaluated last, with `sⱼ` the largest value that unknown `j`
    /// took on the way: free of units, and of the order of the precision after convergence.
    pub residual: T,
    /// How often the system was linearised.
    pub iterations: usize,
    /// Whether the solution can be trusted, in every lane.
    pub converged: bool,
}

/// Solves `f(x) = 0` of `K` equations for `K` unknowns.
///
/// `evaluate` gives `f` and its Jacobian `∂f/∂x`. From the solution of the last time a smooth loop takes two or
/// three linearisations. There are never more than 50, with at most 48 evaluations each, or 96 where lanes differ.
///
/// The iteration is Newton's, damped until the next correction with the *old* Jacobian would be shorter than this one
/// (natural monotonicity; Deuflhard, *Newton Methods for Nonlinear Problems*, 2004, 3.3.1, with the bound 1 − λ/4).
/// Unlike the residual, that length does not depend on how the equations are scaled, so that exponential laws with
/// conductances from 1e-12 to 1e2 do no harm. What is not finite counts as too long. Lengths are relative to the
/// largest value that each unknown took on the way. Where a law is flat, as that of a diode that blocks, a correction may be
/// longer by hundreds of powers of ten: where no damping of the whole helps, that begins again with what doubles an unknown
/// at most.
///
/// Converged means that two corrections in a row were below the square root of the precision of each unknown; of the largest
/// value that it took on the way, where corrections shrink no more, as of an unknown that is zero. The first of them leaves
/// an error of the order of the precision, the second one, at a converged point, gives [`Dual`](crate::Dual) numbers
/// the slope of the implicit function theorem, `−J⁻¹ ∂f/∂p`. Where the equations leave an unknown less sharp than that, it
/// is what they leave of it: corrections go no further when each equation is zero but for the rounding of its terms. Of an
/// unknown below 64 ε they need not settle, since it may be zero, with terms beside it that cancel: it converges where it can.
///
/// Where the Jacobian is singular, as that of `f |f|` at rest, a point that solves the equations exactly is the solution, with
/// the slopes of [`Dual`](crate::Dual) numbers beside it, and from any other the iteration goes on beside it.
///
/// It does not converge where there is no solution, where the Jacobian is singular next to it, or from too far away.
///
/// # Example
///
/// A lamp of 100 ohm behind a diode at 5 V:
///
/// ```
/// use mbg_runtime::solve::newton;
/// use nalgebra::{SMatrix, SVector};
///
/// let solved = newton(SVector::from([0.0]), |x: &SVector<f64, 1>| {
///     let current = 1e-12 * (x[0] / 0.026).exp();
///     let residual = SVector::from([(5.0 - x[0]) / 100.0 - (current - 1e-12)]);
///     (residual, SMatrix::from([[-0.01 - current / 0.026]]))
/// });
/// assert!(solved.converged);
/// assert!((solved.solution[0] - 0.636).abs() < 1e-3);
/// ```
#[must_use]
pub fn newton<T: Real, const K: usize>(
    start: SVector<T, K>,
    evaluate: impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
) -> Solved<T, K> {
    attempt(start, evaluate).0
}

/// As [`newton`], and whether all unknowns of the solution have settled, or may be zero. Beside the large values that an
/// unknown took on the way, far from the solution, what is left of it to correct may seem to be none.
pub(super) fn attempt<T: Real, const K: usize>(
    start: SVector<T, K>,
    evaluate: impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
) -> (Solved<T, K>, bool) {
    let mut point = Point::new(start, &evaluate);
    let mut size = start.map(Real::abs);
    let (mut was_settled, mut was_small, mut tells) = (false, false, false);
    let mut last = T::from_f64(f64::INFINITY);
    let (mut iterations, mut asides) = (0, 0);
    loop {
        iterations += 1;
        let factors = Regular::new(point.jacobian);
        let correction = factors.solution(&point.residual);
        if correction.iter().any(|step| !step.magnitude().is_finite()) {
            let beside = point.aside(&correction, &size, &evaluate);
            if let Some(none) = point.none_left(&beside) {
                return point.ended(&none, &size, iterations, true);
            }
            if asides < ASIDE && iterations < ITERATIONS {
                (asides, point) = (asides + 1, beside);
                continue;
            }
        }
        let settled = below(&correction, &point.x.map(Real::abs), None);
        let is_settled = in_all(settled);
        if is_settled && was_settled {
            return point.ended(&correction, &size, iterations, true);
        }
        let is_small = is_settled || in_all(below(&correction, &size, None));
        let length = Point::relative(&correction, &size);
        let shrinks = |by| everywhere(length - T::from_f64(by) * last, |lane| lane < 0.0);
        // A damped correction shrinks little wherever it leads.
        let comes_no_nearer = is_small && was_small && tells && !shrinks(SHRINKS);
        let sharpest = || !shrinks(0.5) && length.magnitude().is_finite() && point.is_rounding();
        if comes_no_nearer || sharpest() {
            return point.ended(&correction, &size, iterations, true);
        }
        // What is as good as settled where an unknown may be zero, and rounding.
        let rounding = || below(&correction, &size, Some(&point.x));
        if iterations == ITERATIONS {
            let converged = in_all(rounding()) && tells && !shrinks(SHRINKS);
            return point.ended(&correction, &size, iterations, converged);
        }
        let next = point.descend(
            &factors,
            &correction,
            (settled, &rounding),
            &size,
            &evaluate,
        );
        let Some((next, tells_next)) = next else {
            return point.ended(&correction, &size, iterations, in_all(rounding()));
        };
        point = next;
        size.zip_apply(&point.x, |size, x| *size = size.max(x.abs()));
        (was_settled, was_small, tells) = (is_settled, is_small, tells_next);
        last = length;
    }
}

/// Whether a flag of lanes is set in every one.
fn in_all<T: Real>(flag: T) -> bool {
    everywhere(flag, |lane| lane == 1.0)
}

/// 1 in the lanes where a correction is below the square root of the precision of sizes, else 0. Of unknowns given that may be
/// zero it may be rounding, too.
fn below<T: Real, const K: usize>(
    correction: &SVector<T, K>,
    sizes: &SVector<T, K>,
    unknowns: Option<&SVector<T, K>>,
) -> T {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let rounding = T::from_f64(ROUNDING * T::EPSILON);
    let mut all = one;
    for (place, (step, size)) in correction.iter().zip(sizes.iter()).enumerate() {
        let unseen = unknowns.map_or(zero, |x| {
            x[place].abs().select_less(rounding, rounding, zero)
        });
        let bound = T::from_f64(T::SINGULAR) * *size + unseen;
        // Zero is small enough for the bound zero; NaN is for none.
        let is_small = (step.abs() - bound).select_less(one, one, zero);
        all = bound.select_less(step.abs(), zero, is_small * all);
    }
    all
}

/// The equations at a point.
struct Point<T, const K: usize> {
    x: SVector<T, K>,
    residual: SVector<T, K>,
    jacobian: SMatrix<T, K, K>,
}

impl<T: Real, const K: usize> Point<T, K> {
    fn new(
        x: SVector<T, K>,
        evaluate: &impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) -> Self {
        let (residual, jacobian) = evaluate(&x);
        Self {
            x,
            residual,
            jacobian,
        }
    }

    /// The next point: the longest damped correction that is monotonic in every lane, if there is one, and whether the length of
    /// the one behind it tells how near the solution is: it does not where a damped correction was the longest.
    ///
    /// At the level of rounding nothing is monotonic: in settled lanes it is enough that the next correction is not ten
    /// times longer, and a point at which nothing but rounding is left is taken as it is. Where some lanes find nothing
    /// better and may be at that level, the others go on.
    fn descend(
        &self,
        factors: &Regular<T, K>,
        correction: &SVector<T, K>,
        (settled, rounding): (T, &impl Fn() -> T),
        size: &SVector<T, K>,
        evaluate: &impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) -> Option<(Self, bool)> {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let quarter = T::from_f64(0.25);
        let unit = size.zip_map(correction, |size, step| {
            size.max(step.abs()) + T::from_f64(ROUNDING * T::EPSILON)
        });
        let square = |step: &SVector<T, K>| {
            let [relative] = step.zip_map(&unit, |step, unit| step / unit).data.0;
            dot(&relative, &relative)
        };
        let here = square(correction);
        let mut damping = one;
        let mut lenient = settled;
        for number in 1..=4 * DAMPINGS {
            if number == 2 * DAMPINGS + 1 {
                (damping, lenient) = (one, rounding());
                if in_all(lenient) || everywhere(lenient - settled, |more| more == 0.0) {
                    break;
                }
            }
            let next = Self::new(
                self.x.zip_map(correction, |x, step| x - damping * step),
                evaluate,
            );
            let shrunk = one - quarter * damping + T::from_f64(ROUNDING * T::EPSILON);
            let factor = zero.select_less(lenient, T::from_f64(100.0), shrunk * shrunk);
            let there = square(&factors.solution(&next.residual));
            let monotonic = (factor * here).select_less(there, zero, one);
            let accepted = there.select_less(T::from_f64(f64::INFINITY), monotonic, zero);
            let solved = || there.magnitude().is_finite() && next.is_rounding();
            if everywhere(accepted, |lane| lane == 1.0) || solved() {
                // So short a one was accepted for rounding alone.
                let stays = 4.0 * ROUNDING * T::EPSILON;
                let tells = everywhere(damping, |lane| lane == 1.0 || lane <= stays);
                return Some((next, tells));
            }
            let mut less = quarter * damping;
            if number % (2 * DAMPINGS) == DAMPINGS {
                less = less.min(one / Self::relative(correction, size));
            }
            damping = T::from_f64(0.5).select_less(accepted, damping, less);
        }
        None
    }

    /// The correction at a point that solves the equations exactly, though the Jacobian is singular there: none, but for slopes,
    /// which are those beside it.
    fn none_left(&self, beside: &Self) -> Option<SVector<T, K>> {
        let is_zero = |residual: &T| residual.magnitude() == 0.0;
        let correction = Regular::new(beside.jacobian).solution(&self.residual);
        let solves = self.residual.iter().all(is_zero) && correction.iter().all(is_zero);
        solves.then_some(correction)
    }

    /// The point next to one of which a correction is not finite.
    fn aside(
        &self,
        correction: &SVector<T, K>,
        size: &SVector<T, K>,
        evaluate: &impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) -> Self {
        let zero = T::from_f64(0.0);
        let rounding = T::from_f64(ROUNDING * T::EPSILON);
        let x = self.x.zip_zip_map(correction, size, |x, step, size| {
            let aside = T::from_f64(T::SINGULAR) * size + rounding;
            x + step
                .abs()
                .select_less(T::from_f64(f64::INFINITY), zero, aside)
        });
        Self::new(x, evaluate)
    }

    /// The length of a correction, beside the largest value that each unknown took on the way.
    fn relative(correction: &SVector<T, K>, size: &SVector<T, K>) -> T {
        let unseen = T::from_f64(ROUNDING * T::EPSILON);
        largest(
            correction
                .zip_map(size, |step, size| step / size.max(unseen))
                .data
                .0[0],
        )
    }

    /// Whether nothing but rounding is left of every equation, in every lane.
    fn is_rounding(&self) -> bool {
        let rows = self.jacobian.transpose().data.0;
        let sizes = self.x.map(Real::abs).data.0[0];
        self.residual.iter().zip(rows).all(|(residual, row)| {
            let terms = T::from_f64(LEFT * T::EPSILON) * dot(&row.map(Real::abs), &sizes);
            everywhere(residual.abs() - terms, |over| over <= 0.0)
        })
    }

    fn scaled_residual(&self, size: &SVector<T, K>) -> T {
        let zero = T::from_f64(0.0);
        let rows = self.jacobian.transpose().data.0;
        let relative = self.residual.iter().zip(rows).map(|(residual, row)| {
            let scale = dot(&row.map(Real::abs), &size.data.0[0]);
            residual.abs() / zero.select_less(scale, scale, T::from_f64(1.0))
        });
        largest(relative)
    }

    /// What is found here: with the last correction, where that can be trusted.
    fn ended(
        &self,
        correction: &SVector<T, K>,
        size: &SVector<T, K>,
        iterations: usize,
        converged: bool,
    ) -> (Solved<T, K>, bool) {
        let corrected = self.x.zip_map(correction, |x, step| x - step);
        let settled = below(correction, &self.x.map(Real::abs), Some(&self.x));
        let solved = Solved {
            solution: if converged { corrected } else { self.x },
            residual: self.scaled_residual(size),
            iterations,
            converged,
        };
        (solved, in_all(settled))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;
    use crate::solve::lanes::Pair;

    /// Kepler's equation `E − e sin E = M`.
    fn kepler<T: Real>(eccentricity: T, mean: T, start: T) -> Solved<T, 1> {
        newton(SVector::from([start]), |x| {
            let (sine, cosine) = x[0].sin_cos();
            (
                SVector::from([x[0] - eccentricity * sine - mean]),
                SMatrix::from([[T::from_f64(1.0) - eccentricity * cosine]]),
            )
        })
    }

    #[test]
    fn kepler_also_for_comets() {
        for eccentricity in [0.0, 0.3, 0.9, 0.999] {
            for k in -30..=30 {
                let mean = 0.1 * f64::from(k);
                let solved = kepler(eccentricity, mean, mean);
                let x = solved.solution[0];
                assert!(solved.converged, "{eccentricity} {mean} {solved:?}");
                // The error of the root is that of rounding divided by the slope there.
                let error = x - eccentricity * x.sin() - mean;
                assert!(error.abs() < 1e-15 * (1.0 + mean.abs()), "{error:e}");
                assert!(solved.residual < 1e-14, "{solved:?}");
            }
        }
    }

    /// Two turbulent losses in a row and a drop of pressure, `p = f |f| + 0.2 f |f|`.
    fn turbulent<T: Real>(drop: T, start: T) -> Solved<T, 1> {
        newton(SVector::from([start]), |x| {
            let size = x[0].abs();
            let losses = T::from_f64(1.2);
            (
                SVector::from([drop - losses * x[0] * size]),
                SMatrix::from([[-losses * T::from_f64(2.0) * size]]),
            )
        })
    }

    #[test]
    fn rest_is_a_solution_where_slopes_are_zero() {
        let solved = turbulent(0.0, 0.0);
        assert!(solved.converged && solved.solution[0] == 0.0, "{solved:?}");
        let solved = turbulent(0.0_f32, 0.0);
        assert!(solved.converged && solved.solution[0] == 0.0, "{solved:?}");
        // There the flow changes infinitely faster than the pressure.
        let solved = turbulent(Dual::variable(0.0), Dual::constant(0.0));
        assert!(solved.converged && solved.solution[0].value == 0.0);
        assert!(solved.solution[0].slope > 1e12, "{solved:?}");
    }

    #[test]
    fn a_step_onto_a_singular_point_goes_on() {
        // Newton's first step leads to rest from one, with these drops of pressure exactly.
        for drop in [-1.2, 1.2, -4.8, -1.3, 1e-9, -1e9] {
            for start in [1.0, -1.0, 2.0] {
                let solved = turbulent(drop, start);
                let exact = f64::signum(drop) * f64::sqrt(f64::abs(drop) / 1.2);
                assert!(solved.converged, "{drop} {start} {solved:?}");
                assert!(
                    (solved.solution[0] / exact - 1.0).abs() < 1e-14,
                    "{solved:?}"
                );
            }
        }
    }

    #[test]
    fn a_warm_start_takes_two_linearisations() {
        let solved = kepler(0.3, 1.0, kepler(0.3, 1.0, 1.0).solution[0]);
        assert_eq!((solved.iterations, solved.converged), (2, true));
    }

    #[test]
    fn slopes_are_those_of_the_implicit_function_theorem() {
        // dE/de = sin E / (1 − e cos E), from a start that is not converged and from one that is.
        for start in [0.2, kepler(0.6, 0.7, 0.7).solution[0]] {
            let x = kepler(
                Dual::variable(0.6),
                Dual::constant(0.7),
                Dual::constant(start),
            )
            .solution[0];
            let expected = x.value.sin() / (1.0 - 0.6 * x.value.cos());
            assert!((x.slope - expected).abs() < 1e-14, "{x:?} {expected}");
        }
    }

    #[test]
    fn second_derivatives_by_nesting() {
        let constant = |value| Dual::constant(Dual::constant(value));
        let eccentricity = Dual {
            value: Dual::variable(0.6),
            slope: Dual::constant(1.0),
        };
        let x = kepler(eccentricity, constant(0.7), constant(0.7)).solution[0];
        let (sine, cosine) = x.value.value.sin_cos();
        let first = sine / (1.0 - 0.6 * cosine);
        let second = first * (2.0 * cosine - 0.6 * sine * first) / (1.0 - 0.6 * cosine);
        assert!((x.slope.slope - second).abs() < 1e-13, "{x:?} {second}");
    }

    #[test]
    fn single_precision() {
        let solved = kepler(0.9_f32, 0.5, 0.5);
        assert!(solved.converged, "{solved:?}");
        let x = f64::from(solved.solution[0]);
        assert!((x - 0.9 * x.sin() - 0.5).abs() < 2e-7);
    }

    /// `v − u = R i + V ln(1 + i / I)`, a diode with a series resistor, for the current.
    fn rectifier<T: Real>(difference: T, start: T) -> Solved<T, 1> {
        let [resistance, thermal, saturation] = [10.0, 0.025852, 1e-12].map(T::from_f64);
        newton(SVector::from([start]), |i| {
            let one = T::from_f64(1.0);
            let law = resistance * i[0] + thermal * (one + i[0] / saturation).ln();
            let slope = resistance + thermal / (saturation + i[0]);
            (SVector::from([difference - law]), SMatrix::from([[-slope]]))
        })
    }

    #[test]
    fn rectifier_in_both_directions() {
        for difference in [5.0, 0.7, 0.1, 1e-3, 0.0, -0.1, -0.2] {
            let solved = rectifier(difference, 0.0);
            let current: f64 = solved.solution[0];
            let law = 10.0 * current + 0.025852 * (current / 1e-12).ln_1p();
            assert!(solved.converged, "{difference} {solved:?}");
            assert!((law - difference).abs() < 1e-12, "{difference} {solved:?}");
        }
        // The current is that of saturation up to 4e-9 of it; the law is not defined beyond.
        let blocked = rectifier(-0.5, 0.0);
        assert!(
            blocked.converged && (blocked.solution[0] + 1e-12).abs() < 1e-20,
            "{blocked:?}"
        );
    }

    /// Current and slope of a diode.
    fn diode(voltage: f64) -> (f64, f64) {
        let conducted = 1e-12 * (voltage / 0.025).exp();
        (conducted - 1e-12, conducted / 0.025)
    }

    /// Two diodes in series block 12 V, and some current goes to the node between them: each law is flat to 1e-200.
    #[test]
    fn what_blocks_lets_hardly_any_current_in() {
        for current in [1e-20, 1e-16, -1e-16, 1e-12, 1e-9, -1e-3] {
            let solved = newton(SVector::from([0.0; 2]), |x: &SVector<f64, 2>| {
                let [first, second] = [diode(x[0]), diode(x[1])];
                (
                    SVector::from([first.0 - second.0 - current, x[0] + x[1] + 12.0]),
                    SMatrix::from([[first.1, 1.0], [-second.1, 1.0]]),
                )
            });
            let expected = 0.025 * (current.abs() * 1e12).ln();
            let found = solved.solution.max();
            assert!(solved.converged, "{current} {solved:?}");
            assert!((found - expected).abs() < 1e-9, "{current} {solved:?}");
        }
    }

    #[test]
    fn lanes_are_solved_each_for_itself() {
        let both = rectifier(Pair([5.0, -0.1]), Pair([0.0; 2]));
        let alone = [5.0, -0.1].map(|difference| rectifier(difference, 0.0).solution[0]);
        assert!(both.converged);
        for (lane, alone) in both.solution[0].0.iter().zip(alone) {
            assert!((lane / alone - 1.0).abs() < 1e-12, "{lane} {alone}");
        }
    }

    #[test]
    fn rosenbrock_from_the_usual_start() {
        let solved = newton(SVector::from([-1.2, 1.0]), |x: &SVector<f64, 2>| {
            (
                SVector::from([10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]),
                SMatrix::from([[-20.0 * x[0], -1.0], [10.0, 0.0]]),
            )
        });
        assert!(solved.converged);
        assert!((solved.solution - SVector::from([1.0, 1.0])).norm() < 1e-15);
    }

    /// Broyden's tridiagonal function `(3 − 2xᵢ) xᵢ − xᵢ₋₁ − 2xᵢ₊₁ + 1`, rows scaled by 10³ⁱ.
    fn broyden<const K: usize>() {
        let solved = newton(SVector::from([-1.0; K]), |x: &SVector<f64, K>| {
            let weight = |i: usize| 1e3_f64.powi(i as i32);
            let at = |i: Option<usize>| i.and_then(|i| x.get(i)).copied().unwrap_or(0.0);
            let residual = SVector::from_fn(|i, _| {
                let row = (3.0 - 2.0 * x[i]) * x[i] - at(i.checked_sub(1)) - 2.0 * at(Some(i + 1));
                weight(i) * (row + 1.0)
            });
            let jacobian = SMatrix::from_fn(|i, j| {
                weight(i)
                    * match (i + 1).cmp(&(j + 1)) {
                        core::cmp::Ordering::Equal => 3.0 - 4.0 * x[i],
                        core::cmp::Ordering::Greater if i == j + 1 => -1.0,
                        core::cmp::Ordering::Less if j == i + 1 => -2.0,
                        _ => 0.0,
                    }
            });
            (residual, jacobian)
        });
        assert!(solved.converged, "{solved:?}");
        assert!(
            solved.residual < 1e-14 && solved.iterations < 9,
            "{solved:?}"
        );
    }

    #[test]
    fn one_to_six_unknowns() {
        broyden::<1>();
        broyden::<2>();
        broyden::<3>();
        broyden::<4>();
        broyden::<5>();
        broyden::<6>();
    }

    #[test]
    fn nothing_to_solve() {
        let solved = newton(SVector::<f64, 0>::from([]), |x| {
            (*x, SMatrix::from_element(0.0))
        });
        assert!(solved.converged);
    }

    #[test]
    fn zero_is_a_solution_too() {
        for start in [0.0, 1e-12, 3.0] {
            let solved = newton(SVector::from([start]), |x: &SVector<f64, 1>| {
                // The rounding of 7 that remains at the solution.
                let residual = (x[0] + 7.1) * (x[0] + 7.1) - 7.1 * 7.1 + 1e-16;
                (
                    SVector::from([residual]),
                    SMatrix::from([[2.0 * (x[0] + 7.1)]]),
                )
            });
            assert!(
                solved.converged && solved.solution[0].abs() < 1e-15,
                "{solved:?}"
            );
        }
    }

    /// A flow of some 1e-6 m³/s through a pipe, in single precision, or of a picolitre in double.
    #[test]
    fn small_unknowns_are_solved_as_large_ones_are() {
        fn flow<T: Real>(scale: f64) -> f64 {
            let [drop, smooth, rough] = [5e5, 1e2 / scale, 4e5 / (scale * scale)].map(T::from_f64);
            let solved = newton(SVector::from([T::from_f64(0.0)]), |x| {
                let size = x[0].abs();
                (
                    SVector::from([drop - smooth * x[0] - rough * x[0] * size]),
                    SMatrix::from([[-smooth - (rough + rough) * size]]),
                )
            });
            assert!(solved.converged, "{solved:?}");
            solved.solution[0].magnitude() / scale
        }
        let expected = flow::<f64>(1.0);
        for power in -18..=3 {
            let scale = 10.0_f64.powi(power);
            assert!(
                (flow::<f64>(scale) / expected - 1.0).abs() < 1e-14,
                "{scale:e}"
            );
            if power > -15 {
                assert!(
                    (flow::<f32>(scale) / expected - 1.0).abs() < 1e-6,
                    "{scale:e}"
                );
            }
        }
    }

    /// `f |f| = drop` and `√f = drop` from one, as after a jump of the drop.
    #[test]
    fn small_unknowns_are_solved_from_large_starts() {
        fn squared<T: Real>(flow: f64) -> Solved<T, 1> {
            let drop = T::from_f64(flow * flow);
            newton(SVector::from([T::from_f64(1.0)]), |x| {
                let size = x[0].abs();
                (
                    SVector::from([x[0] * size - drop]),
                    SMatrix::from([[size + size]]),
                )
            })
        }
        fn root<T: Real>(flow: f64) -> Solved<T, 1> {
            let drop = T::from_f64(flow.sqrt());
            newton(SVector::from([T::from_f64(1.0)]), |x| {
                let root = x[0].abs().sqrt();
                let signed = root * x[0].sign();
                (
                    SVector::from([signed - drop]),
                    SMatrix::from([[T::from_f64(0.5) / root]]),
                )
            })
        }
        fn error<T: Real>(solved: Solved<T, 1>, flow: f64) -> f64 {
            assert!(solved.converged, "{solved:?}");
            (solved.solution[0].find(|_| true).unwrap() / flow - 1.0).abs()
        }
        for power in -12..=0 {
            let flow = 10.0_f64.powi(power);
            let errors = [
                error(squared::<f64>(flow), flow),
                error(root::<f64>(flow), flow),
            ];
            assert!(
                errors.iter().all(|error| *error < 1e-14),
                "{flow:e} {errors:?}"
            );
            let errors = [
                error(squared::<f32>(flow), flow),
                error(root::<f32>(flow), flow),
            ];
            assert!(
                errors.iter().all(|error| *error < 1e-6),
                "{flow:e} {errors:?}"
            );
        }
    }

    #[test]
    fn without_a_solution_it_says_so() {
        let parabola = |offset: f64| {
            newton(SVector::from([0.7]), move |x: &SVector<f64, 1>| {
                (
                    SVector::from([x[0] * x[0] + offset]),
                    SMatrix::from([[2.0 * x[0]]]),
                )
            })
        };
        assert!(parabola(-1.0).converged);
        let solved = parabola(1.0);
        assert!(!solved.converged && solved.residual > 0.1, "{solved:?}");
        let singular = newton(SVector::from([0.0]), |_: &SVector<f64, 1>| {
            (SVector::from([1.0]), SMatrix::from([[0.0]]))
        });
        assert!(!singular.converged, "{singular:?}");
        let nan = newton(SVector::from([0.0]), |_: &SVector<f64, 1>| {
            (SVector::from([f64::NAN]), SMatrix::from([[1.0]]))
        });
        assert!(!nan.converged, "{nan:?}");
    }
}
