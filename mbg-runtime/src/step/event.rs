//! Where a guard goes through zero within a step.

use nalgebra::SVector;

use super::dense::Step;
use super::{less, seen};
use crate::Real;

/// Equal parts of a step at whose ends a guard is asked.
const PARTS: usize = 8;
/// So often a guard is asked besides in a step: where it may come to zero and go back, or back to where it starts.
const BESIDES: u32 = 24;
/// A guard beside zero by less, in units of what it is behind the first part, is at zero but for rounding.
const ROUNDING: f64 = 1e-9;

/// A time, and what the guard is there.
type Asked<T> = (T, f64);

impl<T: Real, const N: usize, Memory: Copy> Step<'_, T, N, Memory> {
    /// The first time in the step, not counting its start, at which `guard` goes through zero in this direction.
    ///
    /// `guard` is evaluated at the ends of eight equal parts of the step. A part in which it may come to zero and go back, by the
    /// parabola through three of these, is narrowed to where it turns. If the guard is zero at the start, the first part is
    /// halved to where it may have come back. Both take at most 24 more evaluations. Crossings are missed that are closer to each
    /// other than some hundred thousandth of the step, and so are those of a guard that turns more than once in a part.
    ///
    /// The time is found to the last bits by the Illinois method, and by bisection where that is slow or the guard stays zero, in
    /// at most [`Step::SEARCH`] evaluations. Lanes share their time: the first decides. On [`Dual`](crate::Dual) numbers the time
    /// has the slope of the zero, and so has the state there.
    ///
    /// Nothing is found if the guard is not a number before it goes through zero.
    #[must_use]
    pub fn crossing(
        &mut self,
        direction: Direction,
        guard: impl FnMut(T, &SVector<T, N>) -> T,
    ) -> Option<T> {
        self.search(direction, guard).ok().flatten()
    }

    /// As [`crossing`](Self::crossing), or the first time at which the guard was evaluated and was not a number.
    pub(super) fn search(
        &mut self,
        direction: Direction,
        mut guard: impl FnMut(T, &SVector<T, N>) -> T,
    ) -> Result<Option<T>, T> {
        let (start, end) = (self.span.start, self.span.end);
        let first = (start, number(start, guard(start, &self.first))?);
        let mut asked = [first; 1 + PARTS];
        let (mut before, mut known) = (first, 1);
        for (part, place) in asked.iter_mut().enumerate().skip(1) {
            *place = if part == PARTS {
                (end, number(end, guard(end, &self.state))?)
            } else {
                let fraction = part as f64 / PARTS as f64;
                self.ask(start + T::from_f64(fraction) * (end - start), &mut guard)?
            };
            known += 1;
            if direction.between(before, *place) {
                break;
            }
            before = *place;
        }
        let asked = asked.get(..known).unwrap_or(&asked);
        let mut left = BESIDES;
        for (part, pair) in asked.windows(2).enumerate() {
            let &[before, after] = pair else { continue };
            let found = if direction.between(before, after) {
                Some([before, after])
            } else if part == 0 && direction.may_be_back(before.1, after.1) {
                self.back(direction, [before, after], &mut left, &mut guard)?
            } else if may_touch(asked, part, before.1, after.1) {
                self.touch(direction, [before, after], &mut left, &mut guard)?
            } else {
                None
            };
            if let Some([before, after]) = found {
                return self.locate(before, after, guard).map(Some);
            }
        }
        Ok(None)
    }

    fn ask(&mut self, t: T, guard: &mut impl FnMut(T, &SVector<T, N>) -> T) -> Result<Asked<T>, T> {
        let x = self.at(t);
        Ok((t, number(t, guard(t, &x))?))
    }

    /// Where a guard that is zero at the start comes back before the end of the first part.
    fn back(
        &mut self,
        direction: Direction,
        [start, mut after]: [Asked<T>; 2],
        left: &mut u32,
        guard: &mut impl FnMut(T, &SVector<T, N>) -> T,
    ) -> Result<Option<[Asked<T>; 2]>, T> {
        let least = ROUNDING * after.1.abs();
        while *left > 0 {
            *left -= 1;
            let before = self.ask(start.0 + T::from_f64(0.5) * (after.0 - start.0), guard)?;
            if before.1.abs() > least && direction.between(before, after) {
                return Ok(Some([before, after]));
            }
            after = before;
        }
        Ok(None)
    }

    /// A crossing between two times at which the guard has the same sign: the golden section leads to where it is nearest to
    /// zero or beyond.
    fn touch(
        &mut self,
        direction: Direction,
        [mut before, mut after]: [Asked<T>; 2],
        left: &mut u32,
        guard: &mut impl FnMut(T, &SVector<T, N>) -> T,
    ) -> Result<Option<[Asked<T>; 2]>, T> {
        const GOLDEN: f64 = 0.381_966_011_250_105_1;
        let within = |before: Asked<T>, after: Asked<T>| {
            before.0 + T::from_f64(GOLDEN) * (after.0 - before.0)
        };
        let mut inner = self.ask(within(before, after), guard)?;
        while *left > 0 {
            *left -= 1;
            if let Some(found) = [[before, inner], [inner, after]]
                .into_iter()
                .find(|[a, b]| direction.between(*a, *b))
            {
                return Ok(Some(found));
            }
            // Beyond zero, but not in this direction at either side of it.
            if inner.1 == 0.0 || (inner.1 > 0.0) != (before.1 > 0.0) {
                return Ok(None);
            }
            let is_early = seen(inner.0 - before.0) < seen(after.0 - inner.0);
            let other = if is_early {
                within(inner, after)
            } else {
                within(before, inner)
            };
            let other = self.ask(other, guard)?;
            let [early, late] = if is_early {
                [inner, other]
            } else {
                [other, inner]
            };
            if early.1.abs() < late.1.abs() {
                (inner, after) = (early, late);
            } else {
                (before, inner) = (early, late);
            }
        }
        Ok(None)
    }

    /// Most evaluations of a guard in the search for its zero.
    pub const SEARCH: usize = 64;

    /// The time behind a change of sign; at it, the guard has the sign of the far side or is zero, and before it neither.
    fn locate(
        &mut self,
        (mut before, mut low): (T, f64),
        (mut after, mut high): (T, f64),
        mut guard: impl FnMut(T, &SVector<T, N>) -> T,
    ) -> Result<T, T> {
        let positive = low > 0.0;
        let mut advanced = None;
        // Next to a zero the guard is asked once more: a limiter, or a number of whole steps, stays at it.
        let mut stays = false;
        for round in 0..Self::SEARCH {
            let width = seen(after - before);
            let resolution = 2.0 * T::EPSILON * seen(after.abs()).max(seen(before.abs()));
            if width <= resolution {
                break;
            }
            let secant = low / (low - high);
            let halves = stays || round % 3 == 2 && high != 0.0;
            let fraction = if halves { 0.5 } else { secant };
            let inner = (fraction * width).max(0.5 * resolution);
            let t = before + T::from_f64(inner.min(width - 0.5 * resolution));
            if !less(before, t) || !less(t, after) {
                break;
            }
            let x = self.at(t);
            let value = number(t, guard(t, &x))?;
            let advances = value != 0.0 && (value > 0.0) == positive;
            stays |= value == 0.0 && high == 0.0;
            // The end that stays for the second time counts half.
            let half = if advanced == Some(advances) { 0.5 } else { 1.0 };
            advanced = Some(advances);
            if advances {
                (before, low, high) = (t, value, half * high);
            } else {
                (after, high, low) = (t, value, half * low);
            }
        }
        Ok(after.root_of(|t| {
            let x = self.at(t);
            guard(t, &x)
        }))
    }
}

/// Whether a guard may come to zero and go back in a part: by twice the way that the parabola through three times goes on from
/// the nearer end.
fn may_touch<T>(asked: &[Asked<T>], part: usize, before: f64, after: f64) -> bool {
    let first = part.saturating_sub(1).min(asked.len().saturating_sub(3));
    let Some([(_, a), (_, b), (_, c), ..]) = asked.get(first..) else {
        return false;
    };
    let sign = if *b < 0.0 { -1.0 } else { 1.0 };
    let [a, b, c] = [a, b, c].map(|value| sign * value);
    // From the middle one, in parts.
    let (slope, bend) = (0.5 * (c - a), 0.5 * (a + c) - b);
    let turns = -slope / (2.0 * bend);
    let own = part as f64 - (first as f64 + 1.0);
    let nearer = (sign * before).min(sign * after);
    let least = b - slope * slope / (4.0 * bend);
    bend > 0.0
        && (own - 0.25..=own + 1.25).contains(&turns)
        && nearer - 2.0 * (nearer - least) <= 0.0
}

/// What a guard is at a time, or that time where it is not a number.
fn number<T: Real>(t: T, guard: T) -> Result<f64, T> {
    Some(seen(guard)).filter(|it| !it.is_nan()).ok_or(t)
}

/// How a guard goes through zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From positive to zero or negative.
    Falling,
    /// From negative to zero or positive.
    Rising,
    /// Either.
    Either,
}

impl Direction {
    fn between<T>(self, before: Asked<T>, after: Asked<T>) -> bool {
        self.crosses(before.1, after.1)
    }

    /// Whether a guard is zero at the start but for rounding, and where it is if it has gone away and come back.
    fn may_be_back(self, start: f64, after: f64) -> bool {
        start.abs() <= ROUNDING * after.abs() && self.crosses(-after, after)
    }

    fn crosses(self, before: f64, after: f64) -> bool {
        let falls = before > 0.0 && after <= 0.0;
        let rises = before < 0.0 && after >= 0.0;
        match self {
            Self::Falling => falls,
            Self::Rising => rises,
            Self::Either => falls || rises,
        }
    }
}
