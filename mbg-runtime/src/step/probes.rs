//! What a model does between the stages of a step.

use nalgebra::{SMatrix, SVector};

use super::dense::Polynomial;
use super::elimination::Shifted;
use super::method::{Family, Start, Trial};
use super::problem::Problem;
use super::seen;
use super::thresholds::{Known, Point, SEVERAL};
use super::tolerance::{NOISE, Tolerance};
use crate::{Input, Real, System};

/// Looks into steps for what their stages may miss: a pulse of a source, within a step over rest.
///
/// At a probe the model's derivative is compared to that of the dense output; where they differ by far more than the
/// tolerance allows, the step is refused.
///
/// Steps become short where something happens; probes are half that length apart and a part of the time since. So a run at
/// steps of much the same length needs none after a while, and what comes again is seen again. Estimates of the error
/// presume that the solution is smooth: where something begins within a step they may be small by chance, so such steps are
/// looked into as well: behind a refused step, and where an estimate grows suddenly. The latter is all that is looked into where
/// nothing but its state drives a model, which may meet a stiff wall behind free flight.
#[derive(Clone, Copy)]
pub(super) struct Probes {
    /// Since when steps have not become short.
    since: f64,
    /// How short they then were.
    shortest: f64,
    /// The longest step since then.
    longest: f64,
    /// The length of the last step and the square of its coarsest estimate.
    last: [f64; 2],
}

/// The part of the time since that probes may be apart.
pub(super) const PARTS: f64 = 24.0;
/// A difference of slopes over a whole step counts from so many times the tolerance on.
const LARGE: f64 = 30.0;

/// At least so many parts has a step in which something may begin that the estimate of its error shows too small by
/// chance: one behind a refused step, and one whose coarsest estimate has grown out of the order of its method.
const FEW: u32 = 4;
/// The coarsest estimate grows by the fourth power of the length or more; out of that order if its square by so much.
const SUDDEN: f64 = 25.0;

impl Probes {
    /// For a run from this time on.
    pub(super) const fn new(start: f64) -> Self {
        Self {
            since: start,
            shortest: 0.0,
            longest: 0.0,
            last: [0.0; 2],
        }
    }

    /// Takes note of the first step of a piece of the input, which is short because nothing is known yet.
    pub(super) fn enter(&mut self, time: f64, length: f64) {
        if self.shortest == 0.0 {
            self.begin(time, length, length);
        }
        self.longest = length;
    }

    /// Takes note of a step that has been taken, unless it had to end where it does.
    pub(super) fn heed(&mut self, time: f64, length: f64, coarse: f64) {
        if length < 0.5 * self.longest {
            self.begin(time, length, length);
        }
        self.longest = self.longest.max(length);
        self.last = [length, coarse];
    }

    /// In how many parts probes are to divide a step.
    fn parts(&self, start: f64, length: f64) -> u32 {
        let spacing = 0.5 * self.shortest + (start + length - self.since) / PARTS;
        // Rounding alone asks for no probe.
        1 + ((length / spacing).min(PARTS) - 1e-6) as u32
    }

    /// Begins anew at a step so short, `longest` being the longest since.
    fn begin(&mut self, time: f64, shortest: f64, longest: f64) {
        (self.since, self.shortest, self.longest) = (time, shortest, longest);
    }

    /// Whether the coarsest estimate of a step has grown by more than its length explains.
    fn is_sudden(&self, length: f64, coarse: f64) -> bool {
        let [last, before] = self.last;
        let longer = length / last;
        let by_length = longer * longer * longer * longer;
        coarse > SUDDEN * before * (by_length * by_length).max(1.0)
    }
}

impl<T, S, I, const N: usize, const M: usize, const P: usize> Problem<'_, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    /// Where a step has missed something: the length up to which it has not. `ahead` is the derivative at its end, and
    /// `polynomial` its dense output.
    #[inline]
    pub(super) fn clear_length<A: Family>(
        &mut self,
        start: &Start<T, N>,
        (trial, ahead): (&Trial<T, N>, &SVector<T, N>),
        tolerance: &Tolerance<N>,
        polynomial: impl FnOnce(&mut Self) -> Polynomial<T, N>,
    ) -> Option<f64> {
        let (time, length) = (seen(start.span.start), seen(start.span.length));
        // What nothing drives does not pulse by itself.
        let is_driven = !self.is_left_alone();
        let mut parts = if is_driven {
            self.probes.parts(time, length)
        } else {
            1
        };
        if (is_driven && start.again) || self.probes.is_sudden(length, trial.coarse) {
            parts = parts.max(FEW);
        }
        let from = Point {
            time: start.span.start,
            state: start.x,
            slope: start.slope,
        };
        let to = Point {
            time: start.span.end,
            state: start.x + trial.change,
            slope: *ahead,
        };
        let passed = self.passed(&from, &to);
        if passed > 0 {
            parts = parts.max(FEW);
        }
        if parts == 1 {
            None
        } else {
            self.clear_parts::<A>(
                start,
                trial,
                tolerance,
                polynomial,
                (parts, passed >= SEVERAL),
            )
        }
    }

    /// The same of a step that is looked into between so many parts, and between thresholds if it passes several, apart from a
    /// loop that seldom comes here.
    #[inline(never)]
    fn clear_parts<A: Family>(
        &mut self,
        start: &Start<T, N>,
        trial: &Trial<T, N>,
        tolerance: &Tolerance<N>,
        polynomial: impl FnOnce(&mut Self) -> Polynomial<T, N>,
        (parts, passes_several): (u32, bool),
    ) -> Option<f64> {
        let (time, length) = (seen(start.span.start), seen(start.span.length));
        let memory = self.memory;
        let polynomial = polynomial(self);
        let known = Known {
            span: &start.span,
            measure: &tolerance.between(&start.x, &trial.change),
            polynomial: &polynomial,
        };
        let part = length / f64::from(parts);
        let missed = (1..parts).find(|probe| {
            let fraction = T::from_f64(f64::from(*probe) / f64::from(parts));
            let ((t, x), defect) = self.defect(&known, fraction);
            self.is_large::<A>(&known, &defect, (t, &x))
        });
        let mut clear = missed.map(|probe| part * f64::from(probe.max(2) - 1));
        if let Some(clear) = clear {
            // What follows is looked into twice as closely.
            self.probes.begin(time, part, clear);
        } else if passes_several {
            clear = self
                .clear_fraction::<A>(&known)
                .map(|fraction| fraction * length);
        }
        self.memory = memory;
        clear
    }

    /// The point after a fraction of a step, and by what the slopes of model and dense output differ there, over a whole step.
    pub(super) fn defect(
        &mut self,
        known: &Known<'_, T, N>,
        fraction: T,
    ) -> ((T, SVector<T, N>), SVector<T, N>) {
        let t = known.span.at(fraction);
        let (x, change) = known.polynomial.with_slope(fraction);
        let slope = self.slope(t, &x);
        let defect = slope.zip_zip_map(&change, &x, |slope, change, x| {
            let expected = known.span.length * slope;
            let rounding = NOISE * T::EPSILON * (x.magnitude() + expected.magnitude());
            let defect = expected - change;
            if defect.magnitude() <= rounding {
                T::from_f64(0.0)
            } else {
                defect
            }
        });
        ((t, x), defect)
    }

    /// Whether such a difference is large, in a model that is as stiff as at a point.
    pub(super) fn is_large<A: Family>(
        &mut self,
        known: &Known<'_, T, N>,
        defect: &SVector<T, N>,
        (t, x): (T, &SVector<T, N>),
    ) -> bool {
        let (measure, length) = (known.measure, known.span.length);
        // NaN is not small.
        let is_small = |size: f64, most: f64| size <= most;
        let size = measure.norm(defect);
        if is_small(size, LARGE) {
            return false;
        }
        // In stiff components slopes differ by much where states do not: what counts is how far those would move.
        if !A::IMPLICIT {
            // By the derivative along the defect, which leads to a state as far away as the tolerance.
            let by = T::from_f64(1.0 / size);
            let slope = self.slope(t, x);
            let beside = self.slope(t, &x.zip_map(defect, |x, defect| x + by * defect));
            let moved = beside.zip_map(&slope, |beside, slope| length * (beside - slope));
            return !is_small(size, LARGE * (1.0 + measure.norm(&moved)));
        }
        let mut jacobian = SMatrix::from_element(T::from_f64(0.0));
        let mut factors = Shifted::empty();
        self.factorise(((t, x), None), length, (&mut jacobian, &mut factors));
        !is_small(measure.norm(&factors.solved::<S, M, P>(defect)), LARGE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probes_are_a_part_of_the_past_apart() {
        let mut probes = Probes::new(0.0);
        probes.heed(0.0, 1.0, 0.0);
        assert_eq!(probes.parts(0.0, 1.0), 24);
        assert_eq!(probes.parts(1.0, 1.0), 12);
        assert_eq!(probes.parts(23.0, 1.0), 1);
        // A step less than half as long begins anew, and its like need hardly any.
        probes.heed(100.0, 0.1, 0.0);
        assert_eq!(probes.parts(100.1, 0.1), 2);
        assert_eq!(probes.parts(102.0, 0.1), 1);
        assert_eq!(probes.parts(100.1, 1.0), 11);
    }

    #[test]
    fn an_estimate_is_sudden_where_its_length_does_not_explain_it() {
        let mut probes = Probes::new(0.0);
        probes.heed(0.0, 1.0, 1e-4);
        assert!(!probes.is_sudden(1.0, 24e-4));
        assert!(probes.is_sudden(1.0, 26e-4));
        // Squared errors of order three grow by the eighth power of the length.
        assert!(!probes.is_sudden(2.0, 256.0 * 24e-4));
        assert!(probes.is_sudden(2.0, 256.0 * 26e-4));
        assert!(probes.is_sudden(0.5, 26e-4));
    }
}
