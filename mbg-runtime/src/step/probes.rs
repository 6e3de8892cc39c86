//! What a model that depends on time does between the stages of a step.

use nalgebra::SVector;

use super::dense::Polynomial;
use super::elimination::Shifted;
use super::method::{Family, Span, Start, Trial};
use super::problem::Problem;
use super::seen;
use super::tolerance::{Measure, Tolerance};
use crate::{Input, Real, System};

/// Looks into steps for what their stages may miss: a pulse of a source, within a step over rest.
///
/// At a probe the model's derivative is compared to that of the dense output; where they differ by far more than the
/// tolerance allows, the step is refused. Steps become short where something happens; probes are half that length apart
/// and a part of the time since. So a run at steps of much the same length needs none after a while, and what comes again
/// is seen again.
#[derive(Clone, Copy)]
pub(super) struct Probes {
    /// Since when steps have not become short.
    since: f64,
    /// How short they then were.
    shortest: f64,
    /// The longest step since then.
    longest: f64,
}

/// The part of the time since that probes may be apart.
const PARTS: f64 = 32.0;
/// A difference of slopes over a whole step counts from so many times the tolerance on.
const LARGE: f64 = 30.0;

/// At least so many parts has a step behind a refused one: what was refused may begin within it, and an estimate of its
/// error that falls from above may be small by chance.
const AGAIN: u32 = 4;

/// A difference of so many roundings is none.
const ROUNDING: f64 = 64.0;

impl Probes {
    /// For a run from this time on; its first step is looked into most closely.
    pub(super) const fn new(start: f64) -> Self {
        Self {
            since: start,
            shortest: 0.0,
            longest: 0.0,
        }
    }

    /// Takes note of a step that has been taken, unless it had to end where it does.
    pub(super) fn heed(&mut self, time: f64, length: f64) {
        if length < 0.5 * self.longest {
            *self = Self {
                since: time,
                shortest: length,
                longest: length,
            };
        }
        self.longest = self.longest.max(length);
    }

    /// In how many parts probes are to divide a step.
    fn parts(&self, start: f64, length: f64) -> u32 {
        let spacing = 0.5 * self.shortest + (start + length - self.since) / PARTS;
        // Rounding alone asks for no probe.
        1 + ((length / spacing).min(PARTS) - 1e-6) as u32
    }

    /// Takes note that probes this far apart have found something behind a step that is `clear` long: what follows is
    /// looked into twice as closely.
    fn found(&mut self, time: f64, apart: f64, clear: f64) {
        *self = Self {
            since: time,
            shortest: apart,
            longest: clear,
        };
    }
}

impl<T, S, I, const N: usize, const M: usize, const P: usize> Problem<'_, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M>,
{
    /// Where a step has missed something: the length up to which it has not. `polynomial` is its dense output.
    pub(super) fn clear_length<A: Family>(
        &mut self,
        start: &Start<T, N>,
        trial: &Trial<T, N>,
        tolerance: &Tolerance<N>,
        polynomial: impl FnOnce(&mut Self) -> Polynomial<T, N>,
    ) -> Option<f64> {
        if S::AUTONOMOUS {
            return None;
        }
        let (time, length) = (seen(start.span.start), seen(start.span.length));
        let mut parts = self.probes.parts(time, length);
        if start.again {
            parts = parts.max(AGAIN);
        }
        if parts == 1 {
            return None;
        }
        let memory = self.memory;
        let polynomial = polynomial(self);
        let measure = tolerance.between(&start.x, &trial.change);
        let part = length / f64::from(parts);
        let missed = (1..parts).find(|probe| {
            let fraction = T::from_f64(f64::from(*probe) / f64::from(parts));
            self.misses::<A>(&start.span, &measure, &polynomial, fraction)
        });
        self.memory = memory;
        missed.map(|probe| {
            let clear = part * f64::from(probe.max(2) - 1);
            self.probes.found(time, part, clear);
            clear
        })
    }

    /// Whether the slopes of model and dense output differ by much after a fraction of a step.
    fn misses<A: Family>(
        &mut self,
        span: &Span<T>,
        measure: &Measure<N>,
        polynomial: &Polynomial<T, N>,
        fraction: T,
    ) -> bool {
        let t = span.at(fraction);
        let (x, change) = polynomial.with_slope(fraction);
        let slope = self.slope(t, &x);
        let defect = slope.zip_zip_map(&change, &x, |slope, change, x| {
            let expected = span.length * slope;
            let rounding = ROUNDING * T::EPSILON * (x.magnitude() + expected.magnitude());
            let defect = expected - change;
            if defect.magnitude() <= rounding {
                T::from_f64(0.0)
            } else {
                defect
            }
        });
        // Written so that NaN counts as much.
        let small = |defect: &SVector<T, N>| measure.norm(defect) <= LARGE;
        if small(&defect) || !A::IMPLICIT {
            return !small(&defect);
        }
        // In stiff components slopes differ by much where states do not: what counts is how far those would move.
        self.statistics.factorisations += 1;
        let jacobian = self.jacobian(t, &x);
        let factors = Shifted::new::<S, M, P>(T::from_f64(1.0), span.length, &jacobian);
        !small(&factors.solved::<S, M, P>(&defect))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probes_are_a_part_of_the_past_apart() {
        let mut probes = Probes::new(0.0);
        probes.heed(0.0, 1.0);
        assert_eq!(probes.parts(0.0, 1.0), 32);
        assert_eq!(probes.parts(1.0, 1.0), 16);
        assert_eq!(probes.parts(31.0, 1.0), 1);
        // A step less than half as long begins anew, and its like need hardly any.
        probes.heed(100.0, 0.1);
        assert_eq!(probes.parts(100.1, 0.1), 2);
        assert_eq!(probes.parts(102.0, 0.1), 1);
        assert_eq!(probes.parts(100.1, 1.0), 12);
    }
}
