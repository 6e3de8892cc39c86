//! What a model does between the thresholds of a choice that a step passes.

use nalgebra::SVector;

use super::dense::Polynomial;
use super::method::{Family, Span};
use super::over::Place;
use super::problem::Problem;
use super::seen;
use super::tolerance::Measure;
use crate::{Course, Input, Real, System};

/// So many thresholds have something between them; what is behind a single one is at the end of the step, too.
pub(super) const SEVERAL: u32 = 2;

/// What lasts a smaller part of a step is not found.
const SMALLEST: f64 = 1e-7;
/// So often a step is divided to parts that small.
const DIVISIONS: usize = 25;
/// Where a part of it is: thresholds may be at halves.
const DIVIDED: f64 = 0.487;

/// An input is taken to be smooth over this part of a run.
const SHORT: f64 = 1e-6;

/// A state on its way.
#[derive(Clone, Copy)]
pub(super) struct Point<T, const N: usize> {
    pub(super) time: T,
    pub(super) state: SVector<T, N>,
    /// The derivative of the state there.
    pub(super) slope: SVector<T, N>,
}

/// Numbers of arguments, but for very large ones.
pub(super) struct Numbers(u128);

impl Numbers {
    fn add(&mut self, number: usize) {
        self.0 |= Self::bit(number);
    }

    pub(super) const fn contains(&self, number: usize) -> bool {
        self.0 & Self::bit(number) != 0
    }

    /// Whether any number is in both.
    pub(super) const fn meets(&self, others: &Self) -> bool {
        self.0 & others.0 != 0
    }

    const fn bit(number: usize) -> u128 {
        if number < 128 { 1 << number } else { 0 }
    }
}

/// A step with what is known of it: its dense output, and how its errors are measured.
pub(super) struct Known<'a, T: Real, const N: usize> {
    pub(super) span: &'a Span<T>,
    pub(super) measure: &'a Measure<N>,
    pub(super) polynomial: &'a Polynomial<T, N>,
}

impl<T: Real, const N: usize> Known<'_, T, N> {
    fn point(&self, fraction: f64) -> Point<T, N> {
        let fraction = T::from_f64(fraction);
        let (state, change) = self.polynomial.with_slope(fraction);
        Point {
            time: self.span.at(fraction),
            state,
            slope: change.map(|change| change / self.span.length),
        }
    }
}

impl<T, S, I, const N: usize, const M: usize, const P: usize> Problem<'_, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    /// Tells of the arguments of all choices how they go between two points, and for how long.
    #[inline]
    pub(super) fn courses(
        &self,
        from: &Point<T, N>,
        to: &Point<T, N>,
        each: impl FnMut(&Course<'_, T>, T),
    ) {
        if S::HAS_COURSES {
            let rate = |at: T| self.input_rate(at, to.time - from.time);
            let rates = [rate(from.time), rate(to.time)];
            self.tell([from, to], self.inputs_at([from, to]), rates, each);
        }
    }

    /// How many thresholds are passed between two points, by how the input changes from one to the other.
    #[inline]
    pub(super) fn passed(&self, from: &Point<T, N>, to: &Point<T, N>) -> u32 {
        let mut count = 0_u32;
        if S::HAS_COURSES {
            let inputs = self.inputs_at([from, to]);
            let lasting = to.time - from.time;
            let rate = (inputs[1] - inputs[0]).map(|change| change / lasting);
            self.tell([from, to], inputs, [rate; 2], |course, lasting| {
                count = count.saturating_add(course.passed(lasting));
            });
        }
        count
    }

    /// The arguments of choices that go over a threshold from one place to another.
    pub(super) fn met(&self, from: &Place<T, N>, to: &Place<T, N>) -> Numbers {
        let [from, to] = [from, to].map(|place| Point {
            time: place.0,
            state: place.1,
            slope: SVector::from_element(T::from_f64(0.0)),
        });
        let (mut met, mut number) = (Numbers(0), 0);
        self.courses(&from, &to, |course, lasting| {
            if course.reached(lasting).is_some() {
                met.add(number);
            }
            number += 1;
        });
        met
    }

    fn inputs_at(&self, points: [&Point<T, N>; 2]) -> [SVector<T, M>; 2] {
        points.map(|it| self.input.value(it.time, self.since))
    }

    /// Tells of the arguments between two points, with inputs there and how fast these change.
    #[inline]
    fn tell(
        &self,
        [from, to]: [&Point<T, N>; 2],
        inputs: [SVector<T, M>; 2],
        rates: [SVector<T, M>; 2],
        mut each: impl FnMut(&Course<'_, T>, T),
    ) {
        let mut memory = self.memory;
        let lasting = to.time - from.time;
        let [start, end] = [from, to].map(|it| self.on_piece(it.time));
        self.system.courses(
            (start, [&from.state, &from.slope], [&inputs[0], &rates[0]]),
            (end, [&to.state, &to.slope], [&inputs[1], &rates[1]]),
            &mut memory,
            |course| each(&course, lasting),
        );
    }

    /// How fast the input changes, which is smooth over so much time, or a small part of the run; if any argument goes by that.
    fn input_rate(&self, time: T, lasting: T) -> SVector<T, M> {
        if M == 0 || !S::COURSES_FOLLOW_INPUTS || self.input.is_constant_between_jumps() {
            return SVector::from_element(T::from_f64(0.0));
        }
        let ahead = seen(lasting).max(SHORT * self.whole);
        self.input.rate(time, self.since, T::from_f64(ahead))
    }

    /// The soonest of what is told of the courses of all arguments between two points.
    pub(super) fn soonest(
        &self,
        from: &Point<T, N>,
        to: &Point<T, N>,
        mut time: impl FnMut(&Course<'_, T>, T) -> Option<f64>,
    ) -> Option<f64> {
        let mut soonest: Option<f64> = None;
        self.courses(from, to, |course, lasting| {
            let times = [soonest, time(course, lasting)].into_iter().flatten();
            soonest = times.reduce(f64::min);
        });
        soonest
    }

    /// Up to which fraction of a step nothing is missed, where something is.
    ///
    /// Parts that pass several thresholds are divided, the first first, and the model is looked at behind each that passes one.
    pub(super) fn clear_fraction<A: Family>(&mut self, known: &Known<'_, T, N>) -> Option<f64> {
        let mut ends = [1.0; 1 + DIVISIONS];
        let (mut open, mut a) = (1, 0.0);
        let start = known.point(a);
        let mut from = start;
        while let Some(b) = ends[..open].last().copied() {
            let to = known.point(b);
            let passed = self.passed(&from, &to);
            if passed >= SEVERAL && b - a > SMALLEST && open < ends.len() {
                ends[open] = a + DIVIDED * (b - a);
                open += 1;
                continue;
            }
            open -= 1;
            let is_between = passed > 0
                && ends[..open]
                    .last()
                    .is_some_and(|end| self.passed(&to, &known.point(*end)) > 0);
            if is_between {
                let (_, defect) = self.defect(known, T::from_f64(b));
                // What is stiff between thresholds alone moves the state all the same.
                if self.is_large::<A>(known, &defect, (start.time, &start.state)) {
                    return Some(if a > 0.0 { a } else { b });
                }
            }
            (a, from) = (b, to);
        }
        None
    }
}
