//! Systems of nonlinear equations.

use core::ops::ControlFlow;

use nalgebra::{SMatrix, SVector};

use super::dense::Regular;
use super::flags::Flags;
use super::{dot, largest};
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
/// Points of all lanes at most, of which those of sixteen may go aside one after the other.
const PASSES: usize = ITERATIONS + 16 * ASIDE;
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
/// three linearisations. There are never more than 50, with at most 48 evaluations each.
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
    let mut found = Found::nothing(start);
    found.attempt(start, Flags::all(), evaluate);
    Solved {
        solution: found.solution,
        residual: found.residual,
        iterations: found.iterations,
        converged: found.converged.everywhere(),
    }
}

/// What attempts have found, each lane for itself.
pub(super) struct Found<T, const K: usize> {
    pub(super) solution: SVector<T, K>,
    pub(super) residual: T,
    pub(super) iterations: usize,
    pub(super) converged: Flags<T>,
    /// Whether all unknowns of the solution have settled, or may be zero. Beside the large values that an unknown took on the
    /// way, far from the solution, what is left of it to correct may seem to be none.
    pub(super) settled: Flags<T>,
    /// Lanes whose attempt has not ended.
    open: Flags<T>,
}

impl<T: Real, const K: usize> Found<T, K> {
    pub(super) fn nothing(start: SVector<T, K>) -> Self {
        Self {
            solution: start,
            residual: T::from_f64(0.0),
            iterations: 0,
            converged: Flags::none(),
            settled: Flags::none(),
            open: Flags::none(),
        }
    }

    /// As [`newton`] in some lanes; what has been found in the others stays. A lane that has ended waits for the last one, so that
    /// none has an influence on another.
    pub(super) fn attempt(
        &mut self,
        start: SVector<T, K>,
        lanes: Flags<T>,
        evaluate: impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) {
        let start = start.zip_map(&self.solution, |start, found| lanes.choose(start, found));
        let mut point = Point::new(start, &evaluate);
        let mut size = start.map(Real::abs);
        let mut way = Way::begins();
        self.open = lanes;
        // A scalar whose comparisons are not decided, such as an interval, ends in no lane by itself.
        while way.passes < PASSES {
            self.iterations += 1;
            way.passes += 1;
            let factors = Regular::new(point.jacobian);
            let correction = factors.solution(&point.residual);
            let end = Ending {
                point: &point,
                correction: &correction,
                size: &size,
            };
            let finite = |all: Flags<T>, step: &T| all.and(Flags::finite(*step));
            let finite = correction.as_slice().iter().fold(Flags::all(), finite);
            if !finite.or(self.open.not()).everywhere() {
                match self.aside(&mut way, &end, finite, &evaluate) {
                    ControlFlow::Break(()) => break,
                    ControlFlow::Continue(None) => {}
                    ControlFlow::Continue(Some(beside)) => {
                        point = beside;
                        continue;
                    }
                }
            }
            let Some((settled, small, length)) = self.seen(&mut way, &end) else {
                break;
            };
            let lanes = (self.open, settled);
            let next = point.descend(&factors, &correction, lanes, &size, &evaluate);
            if next.lost && self.end(&end, next.found.not(), end.rounding()) {
                break;
            }
            point = next.point;
            size.zip_apply(&point.x, |size, x| *size = size.max(x.abs()));
            way = Way {
                was_settled: settled,
                was_small: small,
                tells: next.tells,
                last: length,
                ..way
            };
        }
    }

    /// The point beside one from which open lanes cannot go on whose correction is not finite, because the Jacobian is singular
    /// there; the others stay where they are. Those that solve the equations exactly end, and so do those that have gone aside too
    /// often; it breaks off where these were the last ones.
    #[cold]
    #[inline(never)]
    fn aside(
        &mut self,
        way: &mut Way<T>,
        end: &Ending<'_, T, K>,
        finite: Flags<T>,
        evaluate: &impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) -> ControlFlow<(), Option<Point<T, K>>> {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let beside = end.point.aside(end.correction, end.size, evaluate);
        let (none, solves) = end.point.none_left(&beside);
        let exact = Ending {
            correction: &none,
            ..*end
        };
        self.end(&exact, finite.not().and(solves), Flags::all());
        let may = Flags::less(way.asides, T::from_f64(ASIDE as f64));
        let may = may.and(Flags::less(way.taken + one, T::from_f64(ITERATIONS as f64)));
        // From what is not finite nothing leads on.
        self.end(end, finite.or(may).not(), Flags::none());
        let went = self.open.and(finite.not());
        way.taken += went.choose(one, zero);
        way.asides += went.choose(one, zero);
        if self.open.nowhere() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue((!went.nowhere()).then_some(beside))
    }

    /// Ends the lanes whose solution can be trusted, and those that have taken all iterations. Where others are left, whether their
    /// corrections have settled, which are small, and how long they are.
    fn seen(
        &mut self,
        way: &mut Way<T>,
        end: &Ending<'_, T, K>,
    ) -> Option<(Flags<T>, Flags<T>, T)> {
        way.taken += T::from_f64(1.0);
        let settled = below(end.correction, &end.point.x.map(Real::abs), None);
        if self.end(end, settled.and(way.was_settled), Flags::all()) {
            return None;
        }
        let small = settled.or(below(end.correction, end.size, None));
        let length = Point::relative(end.correction, end.size);
        let stays = |by| Flags::less(length, T::from_f64(by) * way.last).not();
        // A damped correction shrinks little wherever it leads.
        let comes_no_nearer = small.and(way.was_small).and(way.tells).and(stays(SHRINKS));
        let sharp = self.open.and(stays(0.5)).and(Flags::finite(length));
        let mut ended = comes_no_nearer;
        if !sharp.nowhere() {
            ended = ended.or(end.point.rounding_of(sharp));
        }
        if self.end(end, ended, Flags::all()) {
            return None;
        }
        if way.passes >= ITERATIONS {
            let is_last = Flags::less(way.taken, T::from_f64(ITERATIONS as f64)).not();
            let converged = end.rounding().and(way.tells).and(stays(SHRINKS));
            if self.end(end, is_last, converged) {
                return None;
            }
        }
        Some((settled, small, length))
    }

    /// Ends open lanes among these: with the last correction, where the solution can be trusted. Whether these were the last ones.
    fn end(&mut self, end: &Ending<'_, T, K>, lanes: Flags<T>, converged: Flags<T>) -> bool {
        let lanes = lanes.and(self.open);
        if lanes.nowhere() {
            return false;
        }
        self.open = self.open.and(lanes.not());
        let Ending {
            point,
            correction,
            size,
        } = end;
        let corrected = point
            .x
            .zip_zip_map(correction, &self.solution, |x, step, found| {
                lanes.choose(converged.choose(x - step, x), found)
            });
        self.solution = corrected;
        self.residual = lanes.choose(point.scaled_residual(size), self.residual);
        let settled = below(correction, &point.x.map(Real::abs), Some(&point.x));
        self.settled = lanes.and(settled).or(lanes.not().and(self.settled));
        self.converged = lanes.and(converged).or(lanes.not().and(self.converged));
        self.open.nowhere()
    }
}

/// Where an attempt ends: a point, the correction there, and the largest value that each unknown took on the way.
#[derive(Clone, Copy)]
struct Ending<'a, T, const K: usize> {
    point: &'a Point<T, K>,
    correction: &'a SVector<T, K>,
    size: &'a SVector<T, K>,
}

impl<T: Real, const K: usize> Ending<'_, T, K> {
    /// Where the correction is as good as settled, since an unknown may be zero, or rounding.
    fn rounding(&self) -> Flags<T> {
        below(self.correction, self.size, Some(&self.point.x))
    }
}

/// What an attempt has seen on its way.
struct Way<T> {
    was_settled: Flags<T>,
    was_small: Flags<T>,
    /// Whether the length of a correction tells how near the solution is.
    tells: Flags<T>,
    /// Length of the last correction.
    last: T,
    /// Points at which the system was linearised.
    passes: usize,
    /// Those of each lane, and how many of these were left for one beside.
    taken: T,
    asides: T,
}

impl<T: Real> Way<T> {
    fn begins() -> Self {
        Self {
            was_settled: Flags::none(),
            was_small: Flags::none(),
            tells: Flags::none(),
            last: T::from_f64(f64::INFINITY),
            passes: 0,
            taken: T::from_f64(0.0),
            asides: T::from_f64(0.0),
        }
    }
}

/// The lanes where a correction is below the square root of the precision of sizes. Of unknowns given that may be zero it may be
/// rounding, too.
fn below<T: Real, const K: usize>(
    correction: &SVector<T, K>,
    sizes: &SVector<T, K>,
    unknowns: Option<&SVector<T, K>>,
) -> Flags<T> {
    let zero = T::from_f64(0.0);
    let rounding = T::from_f64(ROUNDING * T::EPSILON);
    let mut all = Flags::all();
    let pairs = correction.as_slice().iter().zip(sizes.as_slice());
    for (place, (step, size)) in pairs.enumerate() {
        let unseen = unknowns.map_or(zero, |x| {
            x[place].abs().select_less(rounding, rounding, zero)
        });
        // Zero is small enough for the bound zero; NaN is for none.
        let bound = T::from_f64(T::SINGULAR) * *size + unseen;
        all = all.and(Flags::at_most(step.abs(), bound));
    }
    all
}

/// The equations at a point.
struct Point<T, const K: usize> {
    x: SVector<T, K>,
    residual: SVector<T, K>,
    jacobian: SMatrix<T, K, K>,
}

/// The next point.
struct Next<T, const K: usize> {
    point: Point<T, K>,
    /// The lanes where it is one, and whether there are others.
    found: Flags<T>,
    lost: bool,
    /// Whether the length of the correction behind it tells how near the solution is: it does not where a damped correction was
    /// the longest.
    tells: Flags<T>,
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

    /// The next point in open lanes: behind the longest damped correction that is monotonic, if there is one.
    ///
    /// At the level of rounding nothing is monotonic: in settled lanes it is enough that the next correction is not ten
    /// times longer, and a point at which nothing but rounding is left is taken as it is.
    fn descend(
        &self,
        factors: &Regular<T, K>,
        correction: &SVector<T, K>,
        (open, settled): (Flags<T>, Flags<T>),
        size: &SVector<T, K>,
        evaluate: &impl Fn(&SVector<T, K>) -> (SVector<T, K>, SMatrix<T, K, K>),
    ) -> Next<T, K> {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let quarter = T::from_f64(0.25);
        let inverse = size.zip_map(correction, |size, step| {
            one / (size.max(step.abs()) + T::from_f64(ROUNDING * T::EPSILON))
        });
        let square = |step: &SVector<T, K>| {
            let [relative] = step
                .zip_map(&inverse, |step, inverse| step * inverse)
                .data
                .0;
            dot(&relative, &relative)
        };
        let here = square(correction);
        let step = correction.map(|step| open.choose(step, zero));
        let mut damping = one;
        let mut number = 0;
        loop {
            number += 1;
            let next = Self::new(
                self.x.zip_map(&step, |x, step| x - damping * step),
                evaluate,
            );
            let shrunk = one - quarter * damping + T::from_f64(ROUNDING * T::EPSILON);
            let factor = settled.choose(T::from_f64(100.0), shrunk * shrunk);
            let there = square(&factors.solution(&next.residual));
            let monotonic = Flags::less(factor * here, there).not();
            let mut found = open.not().or(monotonic.and(Flags::finite(there)));
            let mut lost = !found.everywhere();
            if lost {
                found = found.or(next.rounding_of(found.not().and(Flags::finite(there))));
                lost = !found.everywhere();
            }
            if !lost || number == 2 * DAMPINGS {
                // So short a one was accepted for rounding alone.
                let stays = T::from_f64(4.0 * ROUNDING * T::EPSILON);
                let tells = Flags::less(damping, one)
                    .not()
                    .or(Flags::at_most(damping, stays));
                return Next {
                    point: next,
                    found,
                    lost,
                    tells,
                };
            }
            let mut less = quarter * damping;
            if number == DAMPINGS {
                less = less.min(one / Self::relative(correction, size));
            }
            damping = found.choose(damping, less);
        }
    }

    /// The correction at a point that solves the equations exactly, though the Jacobian is singular there: none, but for slopes,
    /// which are those beside it. And the lanes where that is so.
    fn none_left(&self, beside: &Self) -> (SVector<T, K>, Flags<T>) {
        let zero = T::from_f64(0.0);
        let correction = Regular::new(beside.jacobian).solution(&self.residual);
        let solves = self.residual.iter().chain(&correction);
        let solves = solves.fold(Flags::all(), |all, number| {
            all.and(Flags::at_most(number.abs(), zero))
        });
        (correction, solves)
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

    /// The lanes among these where nothing but rounding is left of every equation.
    fn rounding_of(&self, lanes: Flags<T>) -> Flags<T> {
        let rows = self.jacobian.transpose().data.0;
        let sizes = self.x.map(Real::abs).data.0[0];
        let mut all = lanes;
        for (residual, row) in self.residual.as_slice().iter().zip(rows) {
            if all.nowhere() {
                break;
            }
            let terms = T::from_f64(LEFT * T::EPSILON) * dot(&row.map(Real::abs), &sizes);
            all = all.and(Flags::at_most(residual.abs(), terms));
        }
        all
    }

    fn scaled_residual(&self, size: &SVector<T, K>) -> T {
        let zero = T::from_f64(0.0);
        let rows = self.jacobian.transpose().data.0;
        let pairs = self.residual.as_slice().iter().zip(rows);
        let relative = pairs.map(|(residual, row)| {
            let scale = dot(&row.map(Real::abs), &size.data.0[0]);
            residual.abs() / zero.select_less(scale, scale, T::from_f64(1.0))
        });
        largest(relative)
    }
}

#[cfg(test)]
mod tests;
