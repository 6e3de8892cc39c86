//! What counts as a small error.

use nalgebra::SVector;

use crate::Real;

/// Directions of slopes that are measured: as many as the widest scalar has columns.
const DIRECTIONS: usize = 16;

/// A part of a run in which slopes may be in error as they like, in units of the part of themselves by which they may elsewhere: of
/// those that begin where a law jumps, any error is as large as they are.
const PASSING: f64 = 0.01;

/// Tolerances of each state.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance<const N: usize> {
    pub(super) relative: f64,
    absolute: [f64; N],
    /// The part of themselves by which slopes may be in error.
    of_slopes: f64,
}

impl<const N: usize> Tolerance<N> {
    /// The absolute tolerance is in units of the nominal sizes; a state without one has size 1.
    pub(super) fn new(relative: f64, absolute: f64, nominal: &[f64]) -> Self {
        let size = |state: usize| nominal.get(state).copied().unwrap_or(1.0);
        Self {
            relative,
            absolute: core::array::from_fn(|state| absolute * size(state)),
            of_slopes: relative.max(absolute),
        }
    }

    /// The same for a step over such a part of a run.
    #[inline]
    pub(super) fn over(&self, part: f64) -> Self {
        let of_slopes = if part < PASSING * self.of_slopes {
            f64::INFINITY
        } else {
            self.of_slopes
        };
        Self { of_slopes, ..*self }
    }

    /// Errors in units of the tolerance at a state.
    #[inline]
    pub(super) fn around<T: Real>(&self, x: &SVector<T, N>) -> Measure<N> {
        self.of(|state| x[state].magnitude(), [x])
    }

    /// Errors in units of the tolerance on a step: each component of the larger of two states counts.
    #[inline]
    pub(super) fn between<T: Real>(&self, x: &SVector<T, N>, change: &SVector<T, N>) -> Measure<N> {
        let end = x + change;
        let size = |state: usize| x[state].abs().max(end[state].abs()).magnitude();
        self.of(size, [x, &end])
    }

    #[inline]
    fn of<T: Real, const K: usize>(
        &self,
        size: impl Fn(usize) -> f64,
        ends: [&SVector<T, N>; K],
    ) -> Measure<N> {
        let Self {
            relative, absolute, ..
        } = self;
        let factors =
            core::array::from_fn(|state| 1.0 / (absolute[state] + relative * size(state)));
        let mut measure = Measure::of_values(factors);
        if T::HAS_SLOPES {
            measure.weigh_slopes(self.of_slopes, ends);
        }
        measure
    }
}

/// In units of the precision: a state that has been no larger may be rounding.
pub(super) const ROUNDING: f64 = 4096.0;
/// In the same units: a change that is no larger beside the state may be rounding alone.
pub(super) const NOISE: f64 = 64.0;

/// The largest values that states had: what errors are large beside where there is no tolerance.
pub(super) struct Sizes<const N: usize>([f64; N]);

impl<const N: usize> Sizes<N> {
    pub(super) fn new() -> Self {
        Self([0.0; N])
    }

    /// Notes where a step begins.
    pub(super) fn note<T: Real>(&mut self, x: &SVector<T, N>) {
        for (size, x) in self.0.iter_mut().zip(x.as_slice()) {
            *size = size.max(x.magnitude());
        }
    }

    /// Errors in units of what states have been; those of states that may have been rounding alone do not count.
    pub(super) fn before<T: Real>(&self) -> Measure<N> {
        let factor = |size: f64| {
            if size > ROUNDING * T::EPSILON {
                1.0 / size
            } else {
                0.0
            }
        };
        Measure::of_values(self.0.map(factor))
    }

    /// Changes of states that may be rounding of other ones are no larger: of a state that has been nothing but rounding its own
    /// size tells nothing.
    pub(super) fn most<T: Real>(&self) -> [f64; N] {
        self.0.map(|size| T::SINGULAR * size.max(1.0))
    }

    /// A tolerance of so large a part of what states have been and are.
    pub(super) fn tolerance(&self, part: f64) -> Tolerance<N> {
        Tolerance::new(part, part, &self.0.map(|size| size.max(f64::MIN_POSITIVE)))
    }

    /// Errors of a step in units of what states have been and become.
    pub(super) fn between<T: Real>(&self, x: &SVector<T, N>, change: &SVector<T, N>) -> Measure<N> {
        let sizes = self.0.map(|size| size.max(ROUNDING * T::EPSILON));
        let measure = Tolerance::new(1.0, 1.0, &sizes).between(x, change);
        Measure::of_values(measure.factors)
    }
}

/// What makes errors of each state comparable: the reciprocals of their tolerances.
pub(super) struct Measure<const N: usize> {
    factors: [f64; N],
    /// What makes slopes along each direction comparable with their states, in units of the tolerances; zero where they do not
    /// count.
    slopes: [f64; DIRECTIONS],
}

impl<const N: usize> Measure<N> {
    /// One for which slopes do not count.
    #[inline]
    const fn of_values(factors: [f64; N]) -> Self {
        Self {
            factors,
            slopes: [0.0; DIRECTIONS],
        }
    }

    /// Lets so large a part of the slopes at the ends of a step be as large an error as a tolerance.
    ///
    /// They belong to one motion beside the other, of which the size is the largest of its components, both in units of the
    /// tolerances: one that goes through zero need not be more exact there. Slopes that are not finite do not count, nor those
    /// that are next to none beside the values, such as what asking beside a threshold leaves of what stays there.
    fn weigh_slopes<T: Real, const K: usize>(&mut self, part: f64, ends: [&SVector<T, N>; K]) {
        let Self { factors, slopes } = self;
        let states = || ends.iter().flat_map(|end| end.iter().zip(&*factors));
        let values = states().fold(0.0, |most: f64, (x, factor)| {
            most.max(factor * x.magnitude())
        });
        // Small enough for parameters that are larger than states by all that precision tells apart, and large enough for what
        // is left of states that stay.
        let none = T::EPSILON * Real::sqrt(T::EPSILON) * values;
        for (direction, weight) in slopes.iter_mut().enumerate() {
            let mut largest = 0.0;
            for (x, factor) in states() {
                let slope = factor * x.slope_along(direction).unwrap_or(0.0);
                // A NaN stays.
                if slope > largest || slope.is_nan() {
                    largest = slope;
                }
            }
            let error = part * largest;
            let is_some = largest > none && error > f64::MIN_POSITIVE / f64::EPSILON;
            *weight = if is_some { 1.0 / error } else { 0.0 };
        }
    }

    /// The size of an error of one state in units of its tolerance.
    #[inline]
    fn size<T: Real>(&self, error: T, factor: f64) -> f64 {
        let mut size = error.magnitude() * factor;
        if T::HAS_SLOPES {
            for (direction, weight) in self.slopes.iter().enumerate() {
                let slope = error.slope_along(direction).unwrap_or(0.0) * factor * weight;
                // So that a NaN of the value stays, and one of the slope does not count.
                if slope > size {
                    size = slope;
                }
            }
        }
        size
    }

    /// Root of the mean square of an error in units of the tolerances.
    #[inline]
    pub(super) fn norm<T: Real>(&self, error: &SVector<T, N>) -> f64 {
        Real::sqrt(self.square(error))
    }

    /// The mean square of an error in units of the tolerances.
    #[inline]
    pub(super) fn square<T: Real>(&self, error: &SVector<T, N>) -> f64 {
        let [error] = &error.data.0;
        let sum = sum_of::<N>(|place| {
            let quotient = self.size(error[place], self.factors[place]);
            quotient * quotient
        });
        sum * (1.0 / N.max(1) as f64)
    }

    /// The mean square of several errors in units of the tolerances.
    #[inline]
    pub(super) fn squares<T: Real, const S: usize>(&self, errors: &[SVector<T, N>; S]) -> f64 {
        let mut sums = [0.0; N];
        for error in errors {
            let components = error.as_slice().iter().zip(&self.factors);
            for (sum, (component, factor)) in sums.iter_mut().zip(components) {
                let quotient = self.size(*component, *factor);
                *sum = quotient.multiply_add(quotient, *sum);
            }
        }
        sum_of::<N>(|place| sums[place])
            * const { 1.0 / (if N * S > 0 { N * S } else { 1 }) as f64 }
    }
}

/// The sum of `N` terms; of many, several sums side by side, so that no addition waits for the one before.
#[inline]
fn sum_of<const N: usize>(term: impl Fn(usize) -> f64) -> f64 {
    const WIDTH: usize = 8;
    const MANY: usize = 4 * WIDTH;
    if N < MANY {
        return (0..N).map(term).sum();
    }
    let mut sums = [0.0; WIDTH];
    let rest = N - N % WIDTH;
    for first in (0..rest).step_by(WIDTH) {
        for (lane, sum) in sums.iter_mut().enumerate() {
            *sum += term(first + lane);
        }
    }
    sums.into_iter().chain((rest..N).map(term)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::models::Oscillator;
    use crate::{Adaptive, Dop853, Dual, Estimating, Four, Integrator, Pirk8, Step, Tsit5};

    #[test]
    fn many_terms_have_the_sum_of_few() {
        let all: f64 = (0..70).map(f64::from).sum();
        assert_eq!(sum_of::<70>(|place| place as f64), all);
        assert_eq!(sum_of::<3>(|place| place as f64), 3.0);
        assert_eq!(sum_of::<0>(|place| place as f64), 0.0);
        assert!(sum_of::<40>(|place| if place == 39 { f64::NAN } else { 1.0 }).is_nan());
    }

    /// At rest every step is exact for the values. Along two directions at once, one of which is tiny beside the other; what is no
    /// number does not count.
    #[test]
    fn slopes_of_what_rests_are_as_exact_as_those_of_what_moves() {
        type Both = Dual<f64, Four<f64>>;
        fn assert_exact<M: Estimating>(method: M, aside: f64) {
            let along = |slopes| Both {
                value: 0.0,
                slope: Four(slopes),
            };
            let rest = along([0.0; 4]);
            let start = [[1.0, 0.0, 0.0, 0.0], [0.0, 1e-9, 0.0, aside]];
            let start = SVector::from(start.map(along));
            let mut last = start;
            let end = Both {
                value: 20.0,
                ..rest
            };
            let solver = Adaptive::new(method, 1e-10, 1e-12);
            let observer = |step: &mut Step<'_, Both, 2, ()>| last = *step.state();
            solver
                .integrate(&Oscillator, &(), rest, end, start, observer)
                .unwrap();
            let (sine, cosine) = 20.0_f64.sin_cos();
            let found = last.map(|it| [it.slope.0[0], 1e9 * it.slope.0[1]]);
            for (found, expected) in found.iter().zip([[cosine, sine], [-sine, cosine]]) {
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-7, "{found} {expected}");
                }
            }
        }
        assert_exact(Tsit5, f64::NAN);
        assert_exact(Dop853, f64::INFINITY);
        assert_exact(Pirk8, 0.0);
    }
}
