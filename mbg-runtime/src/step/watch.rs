//! What the input does between the ends of a step.

use nalgebra::SVector;

use super::method::Span;
use super::problem::Problem;
use super::seen;
use crate::{Input, Real, System};

/// Looks into steps for what the stages of a method may miss: a gust nobody has told of, within a step over rest.
///
/// A step counts as blind when the input leaves the range of its values at both ends by more than half its size. Every
/// step is looked into at seven times, one that is much longer than all before at 63, and so is each where something has
/// been found already.
pub(super) struct Watch {
    /// The longest step that was looked into closely.
    longest: f64,
    /// No shorter step is refused.
    shortest: f64,
    alert: bool,
}

const FEW: u32 = 8;
const MANY: u32 = 64;

impl Watch {
    /// For a piece of the input of this length.
    pub(super) const fn new(piece: f64) -> Self {
        Self {
            longest: 0.0,
            shortest: 1e-6 * piece,
            alert: false,
        }
    }

    /// Whether a step would not see what the input does.
    pub(super) fn is_blind<T, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        span: &Span<T>,
    ) -> bool
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let length = seen(span.length);
        if problem.input.is_constant_between_jumps() || length < self.shortest {
            return false;
        }
        let close = self.alert || length > 1.5 * self.longest;
        let parts = if close { MANY } else { FEW };
        let value = |t: T| problem.input.value(t, problem.since);
        let ends = [value(span.start), value(span.end)];
        let by = T::from_f64(1.0 / f64::from(parts));
        let blind = (1..parts).any(|part| {
            let fraction = T::from_f64(f64::from(part)) * by;
            stands_out(&value(span.at(fraction)), &ends)
        });
        self.alert |= blind;
        if close && !blind {
            self.longest = self.longest.max(length);
        }
        blind
    }
}

/// Whether a value is farther from both others than half its size, on the same side of them.
fn stands_out<T: Real, const M: usize>(
    value: &SVector<T, M>,
    [first, last]: &[SVector<T, M>; 2],
) -> bool {
    let half = T::from_f64(0.5);
    value
        .iter()
        .zip(first.iter().zip(last.iter()))
        .any(|(value, (first, last))| {
            let size = half * value.abs().max(first.abs()).max(last.abs());
            let [above, below] = [*value - first.max(*last), first.min(*last) - *value];
            size.magnitude() > 0.0
                && (above - size)
                    .max(below - size)
                    .find(|lane| lane > 0.0)
                    .is_some()
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::method::Estimating;
    use crate::step::models::Oscillator;
    use crate::{Adaptive, Dop853, Integrator, Pirk8, Pirk16, Smooth, Tsit5};

    /// Three pushes on an oscillator at rest, this long and each of momentum 1; nobody tells of their jumps.
    fn pushed(method: impl Estimating, length: f64) -> f64 {
        let pushes = [2.0, 7.3, 7.9];
        let within = |t: f64| {
            pushes
                .iter()
                .any(|start| (*start..start + length).contains(&t))
        };
        let force = 1.0 / length;
        let input = Smooth(|t: f64| SVector::from([if within(t) { force } else { 0.0 }]));
        let exact: f64 = pushes
            .iter()
            .map(|start| force * ((10.0 - start - length).cos() - (10.0 - start).cos()))
            .sum();
        let mut last = SVector::from([0.0, 0.0]);
        Adaptive::new(method, 1e-7, 1e-9)
            .integrate(&Oscillator, &input, 0.0, 10.0, last, |step| {
                last = *step.state()
            })
            .unwrap();
        (last[0] - exact).abs()
    }

    #[test]
    fn jumps_that_are_not_declared_are_not_stepped_over() {
        let errors = [0.1, 0.02].map(|length| {
            [
                pushed(Tsit5, length),
                pushed(Dop853, length),
                pushed(Pirk8, length),
            ]
        });
        // Its steps become so long that shorter ones are beyond what the watch promises.
        let of_longer_steps = pushed(Pirk16, 0.1);
        assert!(of_longer_steps < 1e-4, "{of_longer_steps}");
        // Stepped over, they would be missing altogether: an error of order one.
        assert!(
            errors.iter().flatten().all(|error| *error < 1e-4),
            "{errors:?}"
        );
    }

    #[test]
    fn smooth_inputs_stand_out_nowhere() {
        let at = |t: f64| SVector::from([t.sin(), 1.0, 0.0]);
        for start in 0..100 {
            let start = 0.1 * f64::from(start);
            let ends = [at(start), at(start + 0.5)];
            assert!((1..64).all(|part| !stands_out(&at(start + f64::from(part) / 128.0), &ends)));
        }
        let gust = SVector::from([0.0, 1.0, -2.0]);
        assert!(stands_out(&gust, &[at(0.0), at(0.1)]));
    }
}
