//! Steps with what lies between their ends.

use nalgebra::SVector;

use super::method::Span;
use super::seen;
use super::surfaces::Surface;
use crate::Real;

/// The highest degree of a polynomial over a step.
pub(super) const DEGREE: usize = 9;

/// A polynomial over a step, in the form of Hairer's codes: with `s` from 0 to 1 and `r = 1 - s`,
/// `x + s (c₀ + r (c₁ + s (c₂ + r (c₃ + s (c₄ + r (c₅ + s (c₆ + r (c₇ + s c₈))))))))`.
///
/// It gives the states at both ends exactly, whatever its degree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial<T, const N: usize> {
    pub(super) start: SVector<T, N>,
    pub(super) coefficients: [SVector<T, N>; DEGREE],
}

impl<T: Real, const N: usize> Polynomial<T, N> {
    /// The straight line between two states.
    pub(super) fn line(start: &SVector<T, N>, end: &SVector<T, N>) -> Self {
        Self::straight(start, end.zip_map(start, |end, start| end - start))
    }

    /// The straight line over a change of a state.
    pub(super) fn straight(start: &SVector<T, N>, change: SVector<T, N>) -> Self {
        let zero = SVector::from_element(T::from_f64(0.0));
        let mut coefficients = [zero; DEGREE];
        coefficients[0] = change;
        Self {
            start: *start,
            coefficients,
        }
    }

    /// The cubic with these states and, times the length of the step, derivatives at its ends.
    pub(super) fn cubic(
        (start, first): (&SVector<T, N>, SVector<T, N>),
        (end, last): (&SVector<T, N>, SVector<T, N>),
    ) -> Self {
        let mut cubic = Self::line(start, end);
        let [change, bend, twist, ..] = &mut cubic.coefficients;
        *bend = first.zip_map(change, |first, change| first - change);
        *twist = change.zip_zip_map(&last, bend, |change, last, bend| change - last - bend);
        cubic
    }

    /// This cubic made to go through these states at a third and at two thirds, with these derivatives by `s`.
    pub(super) fn through_thirds(mut self, there: [(SVector<T, N>, SVector<T, N>); 2]) -> Self {
        let number = T::from_f64;
        // What is missed is `s² r²` times a cubic, of which values and derivatives are known.
        let [near, far] = there;
        let [(a, a_slope), (b, b_slope)] = [(1.0, near), (2.0, far)].map(|(thirds, there)| {
            let (here, ahead) = self.with_slope(number(thirds / 3.0));
            let (weight, change) = (4.0 / 81.0, (12.0 - 8.0 * thirds) / 27.0);
            let value = (there.0 - here).map(|missed| missed / number(weight));
            let missed = there.1 - ahead;
            let slope = missed.zip_map(&value, |missed, value| {
                (missed - number(change) * value) / number(weight)
            });
            (value, slope)
        });
        let zero = SVector::<T, N>::from_element(number(0.0));
        let sum = |factors: [f64; 4]| {
            let terms = [a, b, a_slope, b_slope].into_iter().zip(factors);
            terms.fold(zero, |sum, (term, factor)| {
                sum.zip_map(&term, |sum, term| sum + number(factor) * term)
            })
        };
        // At both ends, then what is left of the cubic in between.
        let first = sum([-4.0, 5.0, -4.0 / 3.0, -2.0 / 3.0]);
        let change = sum([9.0, -9.0, 2.0, 2.0]);
        let left = |value: SVector<T, N>, part: f64| {
            let line = first.zip_map(&change, |first, change| first + number(part) * change);
            value.zip_map(&line, |value, line| number(4.5) * (value - line))
        };
        let (near, far) = (left(a, 1.0 / 3.0), left(b, 2.0 / 3.0));
        let twist = far.zip_map(&near, |far, near| number(3.0) * (far - near));
        let bend = near.zip_map(&twist, |near, twist| near - twist / number(3.0));
        let higher = self.coefficients.iter_mut().skip(3);
        for (place, coefficient) in higher.zip([first, change, bend, twist]) {
            *place = coefficient;
        }
        self
    }

    pub(super) fn at(&self, s: T) -> SVector<T, N> {
        let rest = T::from_f64(1.0) - s;
        let mut sum = SVector::<T, N>::from_element(T::from_f64(0.0));
        for (place, coefficient) in self.coefficients.iter().enumerate().rev() {
            let factor = if place % 2 == 0 { s } else { rest };
            sum.zip_apply(coefficient, |sum, coefficient| {
                *sum = factor * (coefficient + *sum);
            });
        }
        self.start.zip_map(&sum, |start, sum| start + sum)
    }

    /// The value, and the derivative by `s`.
    pub(super) fn with_slope(&self, s: T) -> (SVector<T, N>, SVector<T, N>) {
        let one = T::from_f64(1.0);
        let zero = SVector::<T, N>::from_element(T::from_f64(0.0));
        let (mut sum, mut slope) = (zero, zero);
        for (place, coefficient) in self.coefficients.iter().enumerate().rev() {
            let (factor, change) = if place % 2 == 0 {
                (s, one)
            } else {
                (one - s, -one)
            };
            sum += coefficient;
            slope.zip_apply(&sum, |slope, sum| *slope = factor * *slope + change * sum);
            sum.apply(|sum| *sum = factor * *sum);
        }
        (self.start + sum, slope)
    }
}

/// A polynomial over a step, or over a part of it.
pub struct Part<T, const N: usize> {
    polynomial: Polynomial<T, N>,
    /// Where the part begins, and its length, by those of the step.
    within: Option<(f64, f64)>,
}

impl<T: Real, const N: usize> Part<T, N> {
    pub(super) fn whole(polynomial: Polynomial<T, N>) -> Self {
        Self {
            polynomial,
            within: None,
        }
    }

    pub(super) fn of(polynomial: Polynomial<T, N>, start: f64, length: f64) -> Self {
        Self {
            polynomial,
            within: Some((start, length)),
        }
    }

    /// Whether a place is in this part, or outside of the step and next to it.
    fn holds(&self, place: T) -> bool {
        self.within.is_none_or(|(start, length)| {
            let (place, end) = (seen(place), start + length);
            (start == 0.0 || place >= start) && (end >= 1.0 || place <= end)
        })
    }

    fn at(&self, place: T) -> SVector<T, N> {
        match self.within {
            None => self.polynomial.at(place),
            Some((start, length)) => {
                let ahead = place - T::from_f64(start);
                self.polynomial.at(ahead / T::from_f64(length))
            }
        }
    }
}

/// A polynomial without a constant part, from powers of `s` into the form of [`Polynomial`]: the remainders of divisions by
/// `s` and by `1 - s` in turns.
pub(super) const fn in_turns(powers: [f64; DEGREE]) -> [f64; DEGREE] {
    // The powers begin with the first: one division by `s` is done.
    let mut rest = powers;
    let mut coefficients = [0.0; DEGREE];
    let mut place = 0;
    while place < DEGREE {
        let left = DEGREE - place;
        coefficients[place] = if place % 2 == 0 {
            remainder_at_end(&mut rest, left)
        } else {
            remainder_at_start(&mut rest, left)
        };
        place += 1;
    }
    coefficients
}

/// Divides a polynomial of so many coefficients by `1 - s`; gives the remainder, its value at 1.
const fn remainder_at_end(polynomial: &mut [f64; DEGREE], count: usize) -> f64 {
    let mut value = 0.0;
    let mut power = count;
    while power > 0 {
        power -= 1;
        // The quotient's coefficient of this power is minus the sum of those above it.
        let above = value;
        value += polynomial[power];
        polynomial[power] = -above;
    }
    value
}

/// Divides a polynomial of so many coefficients by `s`; gives the remainder, its value at 0.
const fn remainder_at_start(polynomial: &mut [f64; DEGREE], count: usize) -> f64 {
    let value = polynomial[0];
    let mut power = 1;
    while power < count {
        polynomial[power - 1] = polynomial[power];
        power += 1;
    }
    value
}

/// A step with its dense output, and with the memory of a model that has nonlinear loops.
pub struct Step<'a, T, const N: usize, Memory = ()> {
    pub(super) span: Span<T>,
    pub(super) first: SVector<T, N>,
    pub(super) state: SVector<T, N>,
    memory: Memory,
    /// The thresholds at which the motion stays.
    pub(super) surfaces: Option<&'a [Surface<T>]>,
    /// Whether it is known to go over none.
    pub(super) is_clear: bool,
    /// Whether it is a straight line over a threshold, behind which the motion may stay at others.
    pub(super) is_over: bool,
    part: Option<Part<T, N>>,
    source: &'a mut dyn FnMut(f64) -> Part<T, N>,
}

impl<'a, T: Real, const N: usize, Memory: Copy> Step<'a, T, N, Memory> {
    pub(super) fn new(
        span: Span<T>,
        (first, state): (SVector<T, N>, SVector<T, N>),
        memory: Memory,
        source: &'a mut dyn FnMut(f64) -> Part<T, N>,
    ) -> Self {
        Self {
            span,
            first,
            state,
            memory,
            surfaces: None,
            is_clear: false,
            is_over: false,
            part: None,
            source,
        }
    }

    /// The time at which the step starts.
    #[must_use]
    pub fn start(&self) -> T {
        self.span.start
    }

    /// The time at which the step ends; of the last one before an event, the time of that.
    #[must_use]
    pub fn end(&self) -> T {
        self.span.end
    }

    /// The state at the end, not interpolated but at an event.
    #[must_use]
    pub fn state(&self) -> &SVector<T, N> {
        &self.state
    }

    /// The state at the start.
    #[must_use]
    pub fn first(&self) -> &SVector<T, N> {
        &self.first
    }

    /// What the run remembers of nonlinear loops at the end of the step: outputs and powers that begin with it are those of the
    /// branch on which the run is, where a loop has several solutions.
    ///
    /// ```
    /// use mbg_runtime::{Adaptive, Constant, Input, Integrator, Stopped, System, Tsit5};
    ///
    /// /// The largest dissipated power at the end of a step.
    /// fn hottest<S, const P: usize>(model: &S) -> Result<f64, Stopped>
    /// where
    ///     S: System<f64, 2, 1, P>,
    /// {
    ///     let input = Constant([1.0].into());
    ///     let mut hottest = 0.0_f64;
    ///     Adaptive::new(Tsit5, 1e-8, 1e-10).integrate(model, &input, 0.0, 1.0, model.initial_state(), |step| {
    ///         let (t, mut memory) = (step.end(), step.memory());
    ///         let power = model.power(t, step.state(), &input.at(t), &mut memory);
    ///         hottest = hottest.max(power.dissipated);
    ///     })?;
    ///     Ok(hottest)
    /// }
    /// ```
    #[must_use]
    pub fn memory(&self) -> Memory {
        self.memory
    }

    /// The state at a time that is the end of the step, but for its slopes: the end of a step follows a jump up to which it goes, and
    /// the time need not.
    pub(super) fn at_end(&mut self, time: T) -> SVector<T, N> {
        let end = self.span.end;
        if !T::HAS_SLOPES || time == end {
            return self.state;
        }
        let apart = self.at(time) - self.at(end);
        self.state + apart
    }

    /// The state at a time of the step, interpolated with [`Method::DENSE_ORDER`](super::Method::DENSE_ORDER); outside
    /// of the step an extrapolation.
    ///
    /// The first call may evaluate the derivative, up to five times. It is some thirty times where stability limits the steps of
    /// [`Dop853`](crate::Dop853), so that what settles fast is as exact as at their ends. [`Pirk8`](crate::Pirk8) and
    /// [`Pirk16`](crate::Pirk16) evaluate it up to 150 times for each part of a long step, which may be a sixteenth.
    #[must_use]
    pub fn at(&mut self, t: T) -> SVector<T, N> {
        let place = (t - self.span.start) / self.span.length;
        let source = &mut self.source;
        let part = self.part.get_or_insert_with(|| source(seen(place)));
        if !part.holds(place) {
            *part = source(seen(place));
        }
        part.at(place)
    }

    /// Shows an observer that the motion stays at some thresholds over it.
    pub(super) fn along<Seen>(
        &mut self,
        surfaces: &[Surface<T>],
        observer: impl FnOnce(&mut Step<'_, T, N, Memory>) -> Seen,
    ) -> Seen {
        observer(&mut Step {
            surfaces: Some(surfaces),
            part: self.part.take(),
            source: &mut *self.source,
            ..*self
        })
    }

    /// Leaves the part of the step up to a time in it, with the state there. Its length stays that of the polynomial, which is
    /// over the whole step.
    pub(super) fn cut(&mut self, end: T, state: SVector<T, N>) {
        self.state = state;
        self.span.end = end;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;

    use super::Polynomial;

    #[test]
    fn a_polynomial_through_thirds_has_degree_seven() {
        for power in 0..8 {
            let value = |s: f64| SVector::from([s.powi(power)]);
            let slope = |s: f64| SVector::from([f64::from(power) * s.powi((power - 1).max(0))]);
            let there = [1.0, 2.0].map(|thirds| (value(thirds / 3.0), slope(thirds / 3.0)));
            let cubic = Polynomial::cubic((&value(0.0), slope(0.0)), (&value(1.0), slope(1.0)));
            let found = cubic.through_thirds(there);
            for s in [0.0, 0.1, 1.0 / 3.0, 0.5, 0.7, 1.0] {
                assert!((found.at(s) - value(s)).amax() < 1e-14, "{power} {s}");
            }
        }
    }
}
