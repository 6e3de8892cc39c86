//! The times at which steps of constant length end.

use super::less;
use super::method::Span;
use crate::Real;
use crate::lane::{lane, larger};

/// The steps over a piece, of which one may be begun anew from within.
pub(super) struct Grid<T> {
    start: T,
    end: T,
    division: Division<T>,
    /// Which step is at hand, and from when to when it is.
    index: u64,
    first: T,
    last: T,
}

impl<T: Real> Grid<T> {
    /// From one time to another, by steps of length `h` or next to it.
    pub(super) fn new(start: T, end: T, h: T) -> Self {
        Self {
            start,
            end,
            division: divide(start, end, h),
            index: 0,
            first: start,
            last: start,
        }
    }

    /// Goes on to the step that a time is in, but for its end; none at the end of all.
    #[inline(always)]
    fn find(&mut self, t: T) -> Option<()> {
        while !less(t, self.last) {
            if self.index >= self.division.count {
                return None;
            }
            self.index += 1;
            self.first = self.last;
            self.last = if self.index == self.division.count {
                self.end
            } else {
                self.start + T::from_f64(self.index as f64) * self.division.step
            };
        }
        Some(())
    }

    /// When the step of the grid ends that a time is in.
    pub(super) fn end_of_step(&mut self, t: T) -> T {
        self.find(t);
        self.last
    }

    /// The step from a time on, to the end of that of the grid or to a time before that; none at the end.
    #[inline(always)]
    pub(super) fn step_between(&mut self, start: T, until: T) -> Option<Span<T>> {
        self.find(start)?;
        if !less(start, until) {
            return None;
        }
        let is_cut = less(until, self.last);
        let end = if is_cut { until } else { self.last };
        let length = if is_cut || less(self.first, start) {
            end - start
        } else if self.index == self.division.count {
            self.division.last
        } else {
            self.division.step
        };
        Some(Span { start, end, length })
    }
}

/// Steps of constant length.
struct Division<T> {
    count: u64,
    /// The length of all but the last.
    step: T,
    /// The length of the last.
    last: T,
}

/// The steps from `start` to `end`: of length `h`, or what is next to it when `h` divides the way up to rounding; else
/// the last one is shorter.
fn divide<T: Real>(start: T, end: T, h: T) -> Division<T> {
    let way = end - start;
    let number = |count: u64| T::from_f64(count as f64);
    let ratio = lane(way / h);
    let whole = Into::<f64>::into(ratio) as u64;
    let rest = ratio - T::Lane::from_f64(whole as f64);
    let [start, end, step] = [start, end, h].map(|it| lane(it).abs());
    let times = larger(start, end) / step;
    let [one, most, unit] = [1.0, 0.25, 8.0 * T::EPSILON].map(T::Lane::from_f64);
    let rounding = (unit * (times + ratio)).min(most);
    let even = |count: u64| {
        let steps = number(count);
        let step = if way == steps * h { h } else { way / steps };
        Division {
            count,
            step,
            last: step,
        }
    };
    if whole > 0 && rest <= rounding {
        even(whole)
    } else if rest >= one - rounding {
        even(whole.saturating_add(1))
    } else {
        Division {
            count: whole.saturating_add(1),
            step: h,
            last: way - number(whole) * h,
        }
    }
}

/// In how many parts a step of the grid is taken at most.
pub(super) const FINEST: u32 = 1 << 20;
/// How often a step of the grid is halved at most.
const HALVINGS: u32 = 1000;

/// A step of the grid, in halves of halves where its stages are not found.
pub(super) struct Parts<T> {
    whole: Span<T>,
    /// How much of it is done, and the size of the next part, in the finest ones.
    done: u32,
    pub(super) size: u32,
    halvings: u32,
    /// Whether a longer part was tried from where it stands.
    pub(super) again: bool,
}

impl<T: Real> Parts<T> {
    pub(super) fn of(whole: Span<T>) -> Self {
        Self {
            whole,
            done: 0,
            size: FINEST,
            halvings: 0,
            again: false,
        }
    }

    /// The next part.
    pub(super) fn next(&self) -> Option<Span<T>> {
        let fraction = |parts| T::from_f64(f64::from(parts) / f64::from(FINEST));
        (self.done < FINEST).then(|| Span {
            start: self.whole.at(fraction(self.done)),
            end: self.whole.at(fraction(self.done + self.size)),
            length: fraction(self.size) * self.whole.length,
        })
    }

    pub(super) fn take(&mut self) {
        self.done += self.size;
        self.again = false;
        if self.size < FINEST && self.done.is_multiple_of(2 * self.size) {
            self.size *= 2;
        }
    }

    /// Whether there is a shorter part.
    pub(super) fn halve(&mut self) -> bool {
        self.size /= 2;
        self.halvings += 1;
        self.again = true;
        self.size > 0 && self.halvings <= HALVINGS
    }
}
