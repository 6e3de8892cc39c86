//! How the arguments of choices go from one point to another.

use crate::Real;
use crate::lane::{are_alike, is_finite, lane, or_nan};
use crate::step::seen;

/// How much farther than a step the way from its start is looked at.
pub(crate) const FARTHER: f64 = 1.25;
/// What begins beside a threshold is nearer to it than this part of its way.
const BESIDE: f64 = 1e-2;
/// What hardly moves goes no more than this part of its way, and on by more than this part of its rate.
const HELD: f64 = 0.25;
const FAST: f64 = 0.5;

/// How an argument of choices in the laws goes between two points, as [`System::courses`](crate::System::courses) tells it.
#[derive(Clone, Copy, Debug)]
pub struct Course<'a, T> {
    /// The argument at the first point, and how fast it changes there; zero where that is long to work out.
    pub from: [T; 2],
    /// The same at the second one.
    pub to: [T; 2],
    /// The values of it at which choices change.
    pub thresholds: &'a [T],
    /// Whether they come again with every whole number.
    pub repeats: bool,
    /// Whether choices change there, or a wave may turn.
    pub is_choice: bool,
}

impl<T: Real> Course<'_, T> {
    /// How many thresholds the argument goes over in so much time, those twice that it may go over and back: where it turns, those on
    /// this side of where its tangents at both points meet. Of several lanes what it is in that which goes over most.
    #[must_use]
    #[inline]
    pub fn passed(&self, lasting: T) -> u32 {
        let counts = self.lanes().map(|it| {
            let farthest = farthest(lane(lasting), it.from, it.to);
            let counts = self.thresholds_in(it.number).map(|threshold| {
                let places = [it.from[0], farthest, it.to[0]];
                let [first, turning, last] = places.map(|place| self.below(place, threshold));
                let both = first
                    .abs_diff(turning)
                    .saturating_add(turning.abs_diff(last));
                u32::try_from(both).unwrap_or(u32::MAX)
            });
            counts.fold(0, u32::saturating_add)
        });
        counts.fold(0, u32::max)
    }

    /// How long behind the first point the first threshold is that lies between the values at both, or at the first, if any does, in
    /// any lane: by the rate there, or by that between the points where it is not known or leads away. On [`Dual`](crate::Dual)
    /// numbers with its slopes.
    #[must_use]
    pub fn reached(&self, lasting: T) -> Option<T> {
        if !self.is_choice {
            return None;
        }
        let [from, to] = [self.from[0], self.to[0]];
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        // Where the argument turns before it goes to a threshold, it is as if the way was straight; and a lane may be at rest.
        let mean = (to - from) / lasting;
        let rate = zero.select_less(mean * self.from[1], self.from[1], mean);
        let rate = zero.select_less(rate.abs(), rate, one);
        let mut soonest: Option<(T::Lane, T)> = None;
        for threshold in self.thresholds {
            let numbers = [from - *threshold, to - *threshold, rate];
            // Lanes share their time.
            for number in 0.. {
                let [Some(first), Some(last), Some(rate)] = numbers.map(|it| it.in_lane(number))
                else {
                    break;
                };
                if let Some(whole) = self.between(first, last) {
                    let time = (whole - first) / rate;
                    if soonest.is_none_or(|(before, _)| time < before) {
                        soonest = Some((time, *threshold - from));
                    }
                }
            }
        }
        // Whole turns of the way have no slope.
        soonest.map(|(time, way)| T::from_lane(time).root_of(|time| way - rate * time))
    }

    /// Whether the argument stays on its sides of all thresholds at which choices change, at the second point and for so much time on its
    /// way from the first as its rates tell, which leads somewhat farther; and begins no nearer beside one than it goes, where stages
    /// between both points may be astray; in all lanes.
    #[inline]
    pub(crate) fn is_clear(&self, lasting: T) -> bool {
        let [farther, half] = [FARTHER, 0.5].map(T::Lane::from_f64);
        let lasting = farther * lane(lasting);
        let is_clear = |it: Lane<T::Lane>| {
            let ([from, rate], [to, later]) = (it.from, it.to);
            let ends = [
                to,
                from + rate * lasting,
                from + half * (rate + later) * lasting,
                // The same way back.
                from - (to - from),
            ];
            self.thresholds_in(it.number).all(|threshold| {
                let side = self.below(from, threshold);
                let beyond = from - threshold;
                // Written so that what is no number is not clear.
                let is_beside = match self.repeats {
                    true => side as f64 != beyond.into(),
                    false => beyond != T::Lane::from_f64(0.0),
                };
                is_beside
                    && is_finite(beyond)
                    && ends.iter().all(|end| self.below(*end, threshold) == side)
            })
        };
        !self.is_choice || self.lanes().all(is_clear)
    }

    /// Whether the first point is beside a threshold at which choices change, nearer than a part of the way that the argument goes, or
    /// was to go in so much time; in any lane.
    pub(crate) fn begins_beside(&self, lasting: T) -> bool {
        self.lanes().any(|it| self.is_beside(&it, lane(lasting)))
    }

    fn is_beside(&self, it: &Lane<T::Lane>, lasting: T::Lane) -> bool {
        let ([from, rate], [to, _]) = (it.from, it.to);
        let near = [rate * lasting, to - from].map(|way| T::Lane::from_f64(BESIDE) * way.abs());
        let is_beside = |threshold: T::Lane| {
            let beyond = from - threshold;
            let apart = match self.repeats {
                true => beyond - whole(nearest(beyond)),
                false => beyond,
            };
            near.iter().any(|near| apart.abs() <= *near)
        };
        self.is_choice && self.thresholds_in(it.number).any(is_beside)
    }

    /// Whether the argument hardly moves from beside a threshold in so much time, though it was to, and goes on to; in any lane.
    pub(crate) fn is_held(&self, lasting: T) -> bool {
        let lasting = lane(lasting);
        let [held, fast] = [HELD, FAST].map(T::Lane::from_f64);
        self.lanes().any(|it| {
            let ([from, rate], [to, later]) = (it.from, it.to);
            let moved = (to - from) / lasting;
            moved.abs() < held * rate.abs() && later / rate > fast && self.is_beside(&it, lasting)
        })
    }

    /// Whether the argument has gone to a threshold, or over it, in any lane, behind which it does not go on as its rate tells.
    pub(crate) fn is_led_back(&self) -> bool {
        let is_led_back = |it: Lane<T::Lane>| {
            let [from, to] = [it.from[0], it.to[0]];
            let goes_on = are_alike(to - from, it.to[1]);
            self.thresholds_in(it.number)
                .any(|threshold| self.between(from - threshold, to - threshold).is_some())
                && !goes_on
        };
        self.is_choice && self.lanes().any(is_led_back)
    }

    /// Whether the argument misses more than a part of the way that it should have gone in so much time by its rates at both points, in
    /// any lane.
    pub(crate) fn is_astray(&self, lasting: T, least: f64) -> bool {
        let [half, least] = [0.5, least].map(T::Lane::from_f64);
        self.lanes().any(|it| {
            let ([from, rate], [to, later]) = (it.from, it.to);
            let way = half * (rate + later) * lane(lasting);
            ((to - from) - way).abs() > least * way.abs()
        })
    }

    /// At how many whole turns behind a threshold an argument meets it that goes from one place to another, both beyond it.
    fn between(&self, first: T::Lane, last: T::Lane) -> Option<T::Lane> {
        let whole = match self.repeats {
            true if first < last => whole(whole_below((-first).into()).saturating_neg()),
            true => whole(whole_below(first.into())),
            false => T::Lane::from_f64(0.0),
        };
        let is_between = (first <= whole && whole < last) || (first >= whole && whole > last);
        is_between.then_some(whole)
    }

    /// About how long behind the first point a threshold is, if what leads to the second one bends evenly, within the time between both;
    /// in any lane.
    pub(crate) fn within(&self, lasting: T) -> Option<f64> {
        let soonest = self.soonest(lasting, |[[from, rate], [to, _]], lasting| {
            [
                from,
                rate,
                (to - from - rate * lasting) / (lasting * lasting),
            ]
        });
        let within = soonest.filter(|time| *time <= lane(lasting));
        within.map(Into::into)
    }

    /// About how long behind the second point the next threshold is, if the argument goes on to bend as it does between both.
    pub(crate) fn behind(&self, lasting: T) -> Option<f64> {
        let half = T::Lane::from_f64(0.5);
        let soonest = self.soonest(lasting, |[[_, before], [to, rate]], lasting| {
            [to, rate, half * (rate - before) / lasting]
        });
        soonest.map(Into::into)
    }

    /// How long it is to the first threshold at which choices change from a value with a rate and half its change, by the values and
    /// rates at both points, of which those that are not known are as if the way was straight.
    fn soonest(
        &self,
        lasting: T,
        way: impl Fn([[T::Lane; 2]; 2], T::Lane) -> [T::Lane; 3],
    ) -> Option<T::Lane> {
        if !self.is_choice {
            return None;
        }
        let [zero, two, four] = [0.0, 2.0, 4.0].map(T::Lane::from_f64);
        let mut soonest = T::Lane::from_f64(f64::INFINITY);
        for it in self.lanes() {
            let lasting = lasting.in_lane(it.number)?;
            let mean = (it.to[0] - it.from[0]) / lasting;
            let known =
                |[value, rate]: [T::Lane; 2]| [value, if rate == zero { mean } else { rate }];
            let [value, rate, bend] = way([it.from, it.to].map(known), lasting);
            for threshold in self.thresholds_in(it.number) {
                let beyond = value - threshold;
                let ways = match self.repeats {
                    true => [
                        whole_below(beyond.into()),
                        whole_below((-beyond).into()).saturating_neg(),
                    ]
                    .map(|turns| whole::<T::Lane>(turns) - beyond),
                    false => [-beyond; 2],
                };
                let time = |way: T::Lane| {
                    let root = (rate * rate + four * bend * way).sqrt();
                    two * way / (rate + if way < zero { -root } else { root })
                };
                for time in ways
                    .into_iter()
                    .take(1 + usize::from(self.repeats))
                    .map(time)
                {
                    if zero < time && time < soonest {
                        soonest = time;
                    }
                }
            }
        }
        Some(soonest).filter(|time| is_finite(*time))
    }

    /// What the argument is at a threshold, with the whole turns that it has made at the second point.
    pub(crate) fn level(&self, threshold: T) -> T {
        if !self.repeats {
            return threshold;
        }
        threshold + whole(nearest(lane(self.to[0] - threshold)))
    }

    /// How it goes in each lane.
    #[inline]
    fn lanes(&self) -> impl Iterator<Item = Lane<T::Lane>> {
        let ends = [self.from, self.to];
        (0..).map_while(move |number| {
            ends[0][0].in_lane(number)?;
            let [from, to] = ends.map(|end| end.map(|it| or_nan(it.in_lane(number))));
            Some(Lane { number, from, to })
        })
    }

    #[inline]
    fn thresholds_in(&self, number: usize) -> impl Iterator<Item = T::Lane> {
        let thresholds = self.thresholds.iter();
        thresholds.map(move |it| or_nan(it.in_lane(number)))
    }

    /// How often a threshold lies below an argument.
    #[inline]
    fn below(&self, argument: T::Lane, threshold: T::Lane) -> i64 {
        match self.repeats {
            true => whole_below((argument - threshold).into()),
            false => i64::from(threshold < argument),
        }
    }
}

/// One lane of an argument: its value and rate at both points.
struct Lane<L> {
    number: usize,
    from: [L; 2],
    to: [L; 2],
}

/// The smaller of two times.
pub(crate) fn sooner<T: Real>(a: T, b: T) -> T {
    if seen(b) < seen(a) { b } else { a }
}

/// What an argument does not go beyond between two points, given with their rates: where it turns, the place at which the
/// tangents meet, else an end. It holds for what is convex, as a distance from a place is along a line.
fn farthest<L: Real + PartialOrd>(lasting: L, [a, rate_a]: [L; 2], [b, rate_b]: [L; 2]) -> L {
    let zero = L::from_f64(0.0);
    if are_alike(rate_a, -rate_b) {
        let time = (b - a - rate_b * lasting) / (rate_a - rate_b);
        a + rate_a * if time > zero { time.min(lasting) } else { zero }
    } else {
        b
    }
}

/// The whole number next to a number.
fn nearest(number: impl Into<f64>) -> i64 {
    whole_below(number.into() + 0.5)
}

fn whole<T: Real>(number: i64) -> T {
    T::from_f64(number as f64)
}

/// The largest whole number that is not above a number.
pub(crate) fn whole_below(number: f64) -> i64 {
    let whole = number as i64;
    whole.saturating_sub(i64::from(whole as f64 > number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    fn course(from: [f64; 2], to: [f64; 2], repeats: bool) -> Course<'static, f64> {
        let thresholds = if repeats { &[0.25] } else { &[1.0, 2.0][..] };
        Course {
            from,
            to,
            thresholds,
            repeats,
            is_choice: true,
        }
    }

    #[test]
    fn the_first_threshold_between_two_values_is_reached() {
        let reached = |from, to, repeats| course(from, to, repeats).reached(2.0);
        assert_eq!(reached([0.5, 1.0], [0.75, 0.0], false), None);
        assert_eq!(reached([0.5, 1.0], [3.0, 0.0], false), Some(0.5));
        assert_eq!(reached([3.5, -1.0], [0.5, 0.0], false), Some(1.5));
        // By the rate between both.
        assert_eq!(reached([0.5, 0.0], [1.5, 0.0], false), Some(1.0));
        assert_eq!(reached([5.0, 0.5], [6.0, 0.0], true), Some(0.5));
        assert_eq!(reached([6.0, -0.5], [4.0, 0.0], true), Some(1.5));
        assert_eq!(reached([-0.5, -1.0], [-1.0, 0.0], true), Some(0.25));
        assert_eq!(reached([-0.5, 1.0], [-0.625, 0.0], true), None);
        // What is at a threshold is met behind it, and by what begins there.
        for repeats in [false, true] {
            let place = if repeats { 5.25 } else { 2.0 };
            assert_eq!(reached([place - 0.5, 1.0], [place, 1.0], repeats), None);
            assert_eq!(reached([place + 0.5, -1.0], [place, -1.0], repeats), None);
            assert_eq!(
                reached([place, 1.0], [place + 0.5, 1.0], repeats),
                Some(0.0)
            );
            assert_eq!(
                reached([place, -1.0], [place - 0.5, -1.0], repeats),
                Some(0.0)
            );
            assert_eq!(reached([place, 1.0], [place, 1.0], repeats), None);
        }
    }

    #[test]
    fn what_stays_on_its_side_is_clear() {
        let clear = |from, to, repeats| course(from, to, repeats).is_clear(2.0);
        assert!(clear([0.5, 0.1], [0.75, 0.0], false));
        assert!(clear([1.5, 0.1], [1.25, 0.0], false));
        assert!(!clear([0.5, 0.1], [1.5, 0.0], false));
        // By the line, though it comes back.
        assert!(!clear([0.5, 0.5], [0.75, 0.0], false));
        assert!(!clear([1.0, -0.1], [0.5, 0.0], false));
        assert!(clear([5.75, 0.1], [6.0, 0.0], true));
        // Nearer beside one than it goes.
        assert!(!clear([5.5, 0.1], [6.0, 0.0], true));
        assert!(!clear([1.125, 0.1], [1.375, 0.0], false));
        assert!(!clear([5.5, 0.1], [6.5, 0.0], true));
        assert!(!clear([5.25, -0.1], [5.0, 0.0], true));
        assert!(!clear([f64::NAN, 0.0], [5.0, 0.0], false));
    }

    /// Along a fall of 5 m from a rate of 3 m/s upwards, with what is 1 and 2 m below the top at these times.
    #[test]
    fn a_way_that_bends_evenly_is_followed_to_the_next_threshold() {
        let at = |time: f64| [3.0 * time - 5.0 * time * time, 3.0 - 10.0 * time];
        let course = |from: f64, to: f64, thresholds| Course {
            from: at(from),
            to: at(to),
            thresholds,
            repeats: false,
            is_choice: true,
        };
        let close = |found: Option<f64>, expected: f64| {
            let found = found.unwrap();
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        };
        let low = 0.3 + f64::sqrt(0.09 + 0.2);
        close(course(0.1, 0.9, &[-1.0]).within(0.8), low - 0.1);
        close(course(0.1, 0.5, &[-1.0, -2.0]).behind(0.4), low - 0.5);
        // It turns below this one, and comes to the other later.
        assert_eq!(course(0.1, 0.2, &[0.5]).behind(0.1), None);
        assert_eq!(course(0.1, 0.5, &[-1.0]).within(0.4), None);
        let unknown = Course {
            from: [1.0, 0.0],
            to: [2.0, 0.0],
            thresholds: &[0.25],
            repeats: true,
            is_choice: true,
        };
        close(unknown.within(4.0), 1.0);
        close(unknown.behind(4.0), 1.0);
        // A wave turns where nothing else changes.
        let turning = Course {
            is_choice: false,
            ..unknown
        };
        assert_eq!([turning.within(4.0), turning.behind(4.0)], [None; 2]);
    }

    #[test]
    fn when_a_threshold_is_reached_has_slopes() {
        let threshold = Dual {
            value: 1.0,
            slope: 3.0,
        };
        let from = [
            Dual {
                value: 0.0,
                slope: 1.0,
            },
            Dual::constant(0.5),
        ];
        let course = Course {
            from,
            to: [Dual::constant(2.0); 2],
            thresholds: &[threshold],
            repeats: false,
            is_choice: true,
        };
        assert_eq!(
            course.reached(Dual::constant(1.0)),
            Some(Dual {
                value: 2.0,
                slope: 4.0
            })
        );
    }

    /// The last lane goes over the threshold, begins beside it, or is led back.
    #[cfg(feature = "lanes")]
    #[test]
    fn all_lanes_are_looked_at() {
        use crate::lanes::f64x4;

        let last = |usual: f64, last| f64x4::from([usual, usual, usual, last]);
        let thresholds = [f64x4::from_f64(1.0)];
        let course = |from: [f64; 2], to: [f64; 2]| Course {
            from: [last(0.5, from[0]), last(0.125, from[1])],
            to: [last(0.625, to[0]), last(0.125, to[1])],
            thresholds: &thresholds,
            repeats: false,
            is_choice: true,
        };
        let lasting = f64x4::from_f64(1.0);
        let away = course([0.5, 0.125], [0.625, 0.125]);
        assert!(away.is_clear(lasting) && away.passed(lasting) == 0);
        assert!(!away.begins_beside(lasting) && !away.is_astray(lasting, 0.1));
        assert!(!away.is_led_back());
        let over = course([0.75, 0.5], [1.25, 0.5]);
        assert!(!over.is_clear(lasting) && over.passed(lasting) == 1);
        assert!(!over.is_astray(lasting, 0.1) && !over.is_led_back());
        let back = course([0.75, 0.5], [1.25, -0.5]);
        assert!(back.is_astray(lasting, 0.1) && back.is_led_back());
        assert!(course([1.0, 0.5], [1.25, 0.5]).begins_beside(lasting));
        assert!(course([1.0, 0.5], [1.0, 0.5]).is_held(lasting));
    }
}
