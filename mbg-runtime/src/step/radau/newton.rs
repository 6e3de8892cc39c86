//! Newton's method for the stages of a step.

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use super::{FAST, Factors, Tabulated, transformed};
use crate::step::linear::{Complex, Element};
use crate::step::method::{Start, combination, combined, larger, relative, settles};
use crate::step::problem::Problem;
use crate::step::rounding::Floor;
use crate::step::tolerance::{NOISE, ROUNDING, Sizes, Tolerance};
use crate::{Input, Real, System};

/// Most sweeps in a step that is controlled by its error.
const SWEEPS: i32 = 10;
/// Sweeps may leave this part of the tolerance, and less where the tolerance is strict: then the error is far below it.
const ENOUGH: f64 = 3e-3;
/// Changes by rounding may be this part of the tolerance.
const ROUNDED: f64 = 0.1;
/// Most sweeps to rounding.
const MOST: u32 = 20;
/// Changes that become smaller by no more than this are looked at: they may stay.
const STAYS: f64 = 0.5;
/// So few sweeps to rounding keep the Jacobian.
const FEW: u32 = 2;
/// After so many sweeps to rounding it is looked for states that are rounding alone.
const MANY: u32 = 4;
/// However far sweeps are from what is enough, no more is believed: over many sweeps a rate tells little.
pub(super) const FAR: f64 = 20.0;

/// The search for the stages of one step.
pub(super) struct Newton<
    'a,
    'b,
    A,
    T,
    Y,
    I,
    const N: usize,
    const M: usize,
    const P: usize,
    const S: usize,
    const PAIRS: usize,
> where
    T: Real,
    Y: System<T, N, M, P>,
    I: ?Sized,
{
    problem: &'a mut Problem<'b, T, Y, I, N, M, P>,
    start: &'a Start<T, N>,
    factors: &'a Factors<T, N, PAIRS>,
    /// Of loops in the model, at the start of the step and at each stage in the last sweep.
    memory: Y::Memory,
    memories: [Option<Y::Memory>; S],
    method: PhantomData<[A; S]>,
}

impl<
    'a,
    'b,
    A,
    T,
    Y,
    I,
    const N: usize,
    const M: usize,
    const P: usize,
    const S: usize,
    const PAIRS: usize,
> Newton<'a, 'b, A, T, Y, I, N, M, P, S, PAIRS>
where
    A: Tabulated<S, PAIRS>,
    T: Real,
    Y: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    pub(super) fn new(
        problem: &'a mut Problem<'b, T, Y, I, N, M, P>,
        start: &'a Start<T, N>,
        factors: &'a Factors<T, N, PAIRS>,
    ) -> Self {
        Self {
            memory: problem.memory,
            memories: [None; S],
            problem,
            start,
            factors,
            method: PhantomData,
        }
    }

    /// One sweep; gives what it changed in the transformed stages.
    // As a function, which compilers make of what is called in several places, it takes much of a small model's step.
    #[inline(always)]
    fn sweep(
        &mut self,
        stages: &mut [SVector<T, N>; S],
        inner: &mut [SVector<T, N>; S],
    ) -> [SVector<T, N>; S] {
        let Start { span, x, .. } = self.start;
        let mut slopes = *stages;
        let known = A::TABLEAU.nodes.iter().zip(&mut self.memories);
        for (slope, (node, memory)) in slopes.iter_mut().zip(known) {
            let t = span.at(T::from_f64(*node));
            *slope = self.problem.slope_of_stage(t, &(x + *slope), memory);
        }
        let changes = self.changes(inner, &slopes);
        for (inner, change) in inner.iter_mut().zip(&changes) {
            *inner += change;
        }
        *stages = transformed(const { &A::TABLEAU.vectors }, inner);
        changes
    }

    /// What `λ/h I − ∂f/∂x` takes to the transformed slopes less `λ/h` times the transformed stages.
    #[inline(always)]
    fn changes(
        &self,
        inner: &[SVector<T, N>; S],
        slopes: &[SVector<T, N>; S],
    ) -> [SVector<T, N>; S] {
        let weights = const { &A::TABLEAU.inverse };
        let mut changes = *inner;
        let (shift, factors) = &self.factors.real;
        let right = combined([(-*shift, &inner[0])], &weights[0], slopes);
        changes[0] = factors.solved::<Y, M, P>(&right);
        let known = pairs(inner).iter().zip(pairs(weights));
        let known = self.factors.pairs.iter().zip(known);
        for (change, ((shift, factors), ([b, c], [of_real, of_imaginary]))) in
            pairs_mut(&mut changes).iter_mut().zip(known)
        {
            let Complex { real, imaginary } = *shift;
            let reals = combined([(-real, b), (imaginary, c)], of_real, slopes);
            let imaginaries = combined([(-imaginary, b), (-real, c)], of_imaginary, slopes);
            let mut right = [Complex::zero(); N];
            for (row, right) in right.iter_mut().enumerate() {
                (right.real, right.imaginary) = (reals[row], imaginaries[row]);
            }
            let [first, second] = change;
            for (row, both) in factors.solve::<Y, M, P>(right).iter().enumerate() {
                (first[row], second[row]) = (both.real, both.imaginary);
            }
        }
        changes
    }

    /// Sweeps until what is left is small beside the tolerance; gives the last rate of convergence, or how many times
    /// what is enough would be left when the bound on sweeps is not going to suffice.
    pub(super) fn controlled(
        &mut self,
        stages: &mut [SVector<T, N>; S],
        (tolerance, jacobian): (&Tolerance<N>, &SMatrix<T, N, N>),
        rate: &mut f64,
    ) -> Result<f64, f64> {
        let relative = tolerance.relative.max(1e-300);
        let enough = (10.0 * T::EPSILON / relative).max(Real::sqrt(relative).min(ENOUGH));
        let measure = tolerance.around(&self.start.x);
        let mut inner = transformed(const { &A::TABLEAU.inverse }, stages);
        let root = Real::sqrt(rate.max(T::EPSILON));
        *rate = root * Real::sqrt(root);
        // Reciprocals of the squares of the last two changes, so that nothing waits for a division.
        let (mut before, mut last) = (0.0, 0.0);
        for sweep in 1..=SWEEPS {
            let changes = self.sweep(stages, &mut inner);
            let square = measure.squares(&changes);
            let size = Real::sqrt(square);
            if !size.is_finite() {
                break;
            }
            if sweep == 1 {
                if *rate * size <= enough {
                    return Ok(FAST);
                }
            } else {
                // By how much a sweep reduces the change, in the mean of the last two.
                let theta = Real::sqrt(if sweep == 2 {
                    square * last
                } else {
                    Real::sqrt(square * before)
                });
                let rest = (1.0 - theta).max(0.01);
                if theta < 0.99 && theta * size <= enough * rest {
                    *rate = theta / rest;
                    return Ok(theta);
                }
                let left = theta * size / (enough * rest);
                let ahead = (sweep..SWEEPS).fold(left, |left, _| left * theta);
                if theta >= 0.99 || ahead > 1.0 {
                    let known = (&stages[S - 1], jacobian);
                    return if size <= ROUNDED && self.are_rounded(&changes, known) {
                        Ok(FAST)
                    } else if theta >= 0.99 {
                        Err(FAR)
                    } else {
                        Err(ahead.min(FAR))
                    };
                }
            }
            (before, last) = (last, 1.0 / square);
        }
        Err(f64::INFINITY)
    }

    /// Whether changes are no more than what rounding of the states does to the slopes: then no sweep makes them smaller.
    #[cold]
    #[inline(never)]
    fn are_rounded(
        &self,
        changes: &[SVector<T, N>; S],
        (end, jacobian): (&SVector<T, N>, &SMatrix<T, N, N>),
    ) -> bool {
        let (shift, _) = &self.factors.real;
        let x = self.start.x + end;
        let rounding = rounding(jacobian, &x);
        changes.iter().all(|change| {
            let mut found = change.map(|it| *shift * it);
            for (column, change) in jacobian.column_iter().zip(change) {
                found.zip_apply(&column, |sum, entry| *sum -= entry * *change);
            }
            let mut rows = found.iter().zip(x.iter().zip(&rounding));
            rows.all(|(found, (x, rounding))| {
                let size = (*shift * *x).abs() + *rounding;
                found.magnitude() <= ROUNDING * T::EPSILON * size.magnitude()
            })
        })
    }

    /// Sweeps to rounding; gives what a step leaves for the next like [`Newton::controlled`], or a failure where it does
    /// not come to that.
    ///
    /// Changes are measured relative to the stages, so that small states are as exact as large ones; whether it is
    /// going to come to rounding, or has and stays there, is told by what states have been, `sizes`: beside a state that is near
    /// zero all changes are large.
    pub(super) fn settled(
        &mut self,
        stages: &mut [SVector<T, N>; S],
        sizes: &Sizes<N>,
    ) -> Result<f64, f64> {
        let x = &self.start.x;
        let mut inner = transformed(const { &A::TABLEAU.inverse }, stages);
        let before = sizes.before::<T>();
        let mut convergence = Convergence::new();
        let mut floor = Floor::new();
        let settles = settles::<T>(MOST, is_rounding::<T>, || {
            let old = *stages;
            let changes = floor.beyond(self.sweep(stages, &mut inner));
            let of_stages: [SVector<T, N>; S] = core::array::from_fn(|it| stages[it] - old[it]);
            convergence.note(Real::sqrt(before.squares(&changes)));
            let is_late = convergence.sweeps >= MANY || convergence.is_hopeless::<T>();
            let known = (x, &*stages, sizes);
            if is_late && floor.look(&of_stages, known, |way| self.beside(stages, way)) {
                convergence = Convergence::new();
            }
            let of_stages = floor.beyond(of_stages);
            if convergence.is_hopeless::<T>() {
                return f64::NAN;
            }
            // Of states that have been nothing yet the sizes tell nothing: they count by what they become.
            let between = || sizes.between(&self.start.x, &stages[S - 1]);
            if convergence.stays::<T>() && is_small::<T>(between().squares(&changes)) {
                return 0.0;
            }
            let changes = of_stages.iter().zip(&*stages);
            let sizes = changes.map(|(change, new)| relative(change, x, new));
            sizes.fold(0.0, larger)
        });
        if !settles {
            Err(f64::INFINITY)
        } else if convergence.sweeps <= FEW {
            Ok(0.0)
        } else {
            Ok(f64::INFINITY)
        }
    }

    /// The stages behind a sweep from those to which something is added; nothing is kept of it.
    #[inline(never)]
    fn beside(&mut self, stages: &[SVector<T, N>; S], way: &SVector<T, N>) -> [SVector<T, N>; S] {
        let kept = (self.memories, self.problem.memory);
        let mut stages = stages.each_ref().map(|stage| stage + way);
        let mut inner = transformed(const { &A::TABLEAU.inverse }, &stages);
        self.sweep(&mut stages, &mut inner);
        (self.memories, self.problem.memory) = kept;
        stages
    }

    /// Whether the step begins beside a threshold.
    pub(super) fn begins_beside(&self) -> bool {
        self.problem.begins_beside(self.start)
    }

    /// The slope of the model where the step ends.
    pub(super) fn slope_at_end(&mut self, stages: &[SVector<T, N>; S]) -> SVector<T, N> {
        let Start { span, x, .. } = self.start;
        self.problem.slope(span.end, &(x + stages[S - 1]))
    }

    /// Whether sweeps lead nowhere: the end is not where the slope of the model there leads to, by more than the tolerance, and
    /// another sweep would leave as much. A Jacobian that is far steeper than what follows, such as that of before a kink or of a root
    /// next to zero, makes all changes small, and the estimate of the error as well.
    pub(super) fn gets_nowhere(
        &mut self,
        stages: &[SVector<T, N>; S],
        (slope, jacobian): (&SVector<T, N>, &SMatrix<T, N, N>),
        tolerance: &Tolerance<N>,
    ) -> bool {
        let Start { span, x, .. } = self.start;
        let end = &stages[S - 1];
        let measure = tolerance.between(x, end);
        let way = combination(const { &A::TABLEAU.slope_at_end() }, stages);
        let left = slope.map(|slope| span.length * slope) - way;
        let found = measure.norm(&left);
        if found <= 1.0 {
            return false;
        }
        // What rounding of the states does to the slope.
        let rounding = rounding(jacobian, &(x + end)).map(|it| span.length * it);
        if found <= NOISE * T::EPSILON * measure.norm(&rounding) {
            return false;
        }
        let (shift, factors) = &self.factors.real;
        let inverse = T::from_f64(1.0) / span.length;
        let ahead = factors.solved::<Y, M, P>(&left.map(|left| inverse * left));
        let memory = self.problem.memory;
        let beside = self.problem.slope(span.end, &(x + end + ahead));
        self.problem.memory = memory;
        let moved = (beside - slope).zip_map(&ahead, |beside, ahead| beside - *shift * ahead);
        measure.norm(&(left + moved.map(|moved| span.length * moved))) > STAYS * found
    }

    /// The filtered estimate; a second filter takes care of large ones where `doubtful`.
    pub(super) fn error(
        &mut self,
        stages: &[SVector<T, N>; S],
        tolerance: &Tolerance<N>,
        doubtful: bool,
    ) -> f64 {
        let Start { span, x, slope, .. } = self.start;
        let (_, real) = &self.factors.real;
        let inverse = T::from_f64(1.0) / span.length;
        let sum = combination(const { &A::TABLEAU.error }, stages).map(|sum| inverse * sum);
        let estimate = real.solved::<Y, M, P>(&(sum + slope));
        let measure = tolerance.between(x, &stages[S - 1]);
        let size = measure.norm(&estimate);
        if size <= 1.0 || !doubtful || size.is_nan() {
            return size;
        }
        let last = core::mem::replace(&mut self.problem.memory, self.memory);
        let slope = self.problem.slope(span.start, &(x + estimate));
        self.problem.memory = last;
        measure.norm(&real.solved::<Y, M, P>(&(sum + slope)))
    }
}

/// The sizes of what makes up the slopes: rounding of the states changes them by so many units of the precision.
fn rounding<T: Real, const N: usize>(
    jacobian: &SMatrix<T, N, N>,
    x: &SVector<T, N>,
) -> SVector<T, N> {
    let mut rounding = SVector::<T, N>::from_element(T::from_f64(0.0));
    for (column, x) in jacobian.column_iter().zip(x) {
        rounding.zip_apply(&column, |sum, entry| *sum += (entry * *x).abs());
    }
    rounding
}

/// Whether the change after the last of two would be less than rounding.
fn is_rounding<T: Real>(before: f64, last: f64) -> bool {
    let rate = last / before;
    // Of a change that is large itself, or the first, a rate tells nothing.
    let is_known = last * last < T::EPSILON * Real::sqrt(T::EPSILON) && rate > 0.0;
    is_known && last * rate <= T::EPSILON * (1.0 - rate)
}

/// Whether a change with this square may be rounding.
fn is_small<T: Real>(square: f64) -> bool {
    let rounding = ROUNDING * T::EPSILON;
    square <= rounding * rounding
}

/// How sweeps to rounding converge.
struct Convergence {
    sweeps: u32,
    /// The last change and by how much the last sweep reduced it, and the slower one of the last two.
    last: f64,
    rate: f64,
    slower: f64,
}

impl Convergence {
    fn new() -> Self {
        Self {
            sweeps: 0,
            last: f64::INFINITY,
            rate: 0.0,
            slower: 0.0,
        }
    }

    /// Notes a change, in units of what states have been.
    fn note(&mut self, change: f64) {
        let rate = (change / self.last).min(1.0);
        (self.slower, self.rate) = (rate.max(self.rate), rate);
        self.last = change;
        self.sweeps += 1;
    }

    /// Whether the sweeps that may follow are not going to make a change small. Then a shorter step costs less.
    fn is_hopeless<T: Real>(&self) -> bool {
        let ahead = (self.sweeps..MOST).fold(self.last, |change, _| change * self.slower);
        self.sweeps > 2 && ahead > T::SINGULAR
    }

    /// Whether changes stay about as they are, and are what rounding does, with all that may follow: those of a state next to zero
    /// may be as large as itself.
    fn stays<T: Real>(&self) -> bool {
        let left = self.last * self.rate / (1.0 - self.rate).max(0.1);
        is_small::<T>(left * left) && self.rate >= STAYS
    }
}

/// All but the first, two by two: what belongs to pairs of eigenvalues.
#[inline(always)]
fn pairs<E>(of_all: &[E]) -> &[[E; 2]] {
    of_all.get(1..).unwrap_or_default().as_chunks().0
}

/// The same to write to.
#[inline(always)]
fn pairs_mut<E>(of_all: &mut [E]) -> &mut [[E; 2]] {
    of_all.get_mut(1..).unwrap_or_default().as_chunks_mut().0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_changes_tell_whether_another_would_be_rounding() {
        // The next would be 1e-18.
        assert!(is_rounding::<f64>(1e-8, 1e-13));
        // 1e-15, and more of them.
        assert!(!is_rounding::<f64>(1e-11, 1e-13));
        assert!(!is_rounding::<f64>(1.01e-13, 1e-13));
        // Nothing is known of the first, of one that grows, and of one that is large.
        assert!(!is_rounding::<f64>(f64::INFINITY, 1e-13));
        assert!(!is_rounding::<f64>(1e-14, 1e-13));
        assert!(!is_rounding::<f64>(1e30, 1e-10));
        assert!(!is_rounding::<f64>(f64::NAN, 1e-13) && !is_rounding::<f64>(1e-8, f64::NAN));
        assert!(is_rounding::<f32>(1e-3, 1e-6) && !is_rounding::<f64>(1e-3, 1e-6));
    }

    #[test]
    fn changes_that_stay_are_rounding_where_they_are_small() {
        let stays = |changes: [f64; 2]| {
            let mut convergence = Convergence::new();
            for change in changes {
                convergence.note(change);
            }
            [convergence.stays::<f64>(), convergence.stays::<f32>()]
        };
        assert_eq!(stays([5e-14, 4.6e-14]), [true, true]);
        assert_eq!(stays([4e-14, 5e-14]), [true, true]);
        assert_eq!(stays([2e-5, 2e-5]), [false, true]);
        assert_eq!(stays([1e-4, 1e-4]), [false, false]);
        // These still become smaller, and of the first nothing is known.
        assert_eq!(stays([1e-13, 4e-14]), [false, false]);
        assert_eq!(stays([f64::INFINITY, 4e-14]), [false, false]);
    }

    /// After how many of these changes it is.
    fn hopeless(changes: &[f64]) -> Option<usize> {
        let mut convergence = Convergence::new();
        let is_hopeless = |change: &f64| {
            convergence.note(*change);
            convergence.is_hopeless::<f64>()
        };
        changes.iter().position(is_hopeless).map(|place| place + 1)
    }

    #[test]
    fn sweeps_are_given_up_where_all_that_may_follow_come_to_nothing() {
        assert_eq!(hopeless(&[1.0, 0.99, 0.98]), Some(3));
        assert_eq!(hopeless(&[1.0, 3.0, 9.0]), Some(3));
        // 0.25 · 0.5¹⁷ is too much, 0.3³ · 0.3¹⁷ is not.
        assert_eq!(hopeless(&[1.0, 0.5, 0.25]), Some(3));
        assert_eq!(hopeless(&[1.0, 0.3, 0.09, 0.027]), None);
        // One that stayed is small already, or is made up for by the next.
        assert_eq!(hopeless(&[1e-3, 1e-9, 1e-9, 1e-13]), None);
        assert_eq!(hopeless(&[1e-3, 1e-3, 1e-9]), None);
    }
}
