//! A line beside a state that crosses each surface once.

use nalgebra::SVector;

use super::sides::Factors;
use super::{Each, Moment, Sliding};
use crate::lane::{is_finite, lane, larger, length, smaller};
use crate::{Real, System};

/// How far beside a threshold laws are asked, in units of the rounding of its argument.
pub(super) const ASIDE: f64 = 64.0;
/// Surfaces are gone across at paces of their own, so that those that depend on them are not met where they are.
const PACE: f64 = 0.618_033_988_749_894_9;
/// So many times as long a line may be, for surfaces that it meets next to each other.
const LONGEST: f64 = 1024.0;

/// States on a line that crosses surfaces.
pub(super) struct Line<T: Real, const N: usize, const K: usize> {
    /// That before all of them.
    pub(super) start: SVector<T, N>,
    /// Those behind each, in the order in which it meets these.
    pub(super) behind: Each<SVector<T, N>, K>,
    /// The place of the surface that is met so.
    pub(super) order: Each<usize, K>,
    /// In which direction each is crossed.
    pub(super) forward: Each<T::Lane, K>,
    /// How far it goes, in units of what is surely beside a surface.
    pub(super) reach: T::Lane,
}

/// Where a state is beyond surfaces.
pub(super) struct Beyond<T, const K: usize> {
    pub(super) distances: Each<T, K>,
    /// How fast it goes across each free surface that is moved across another.
    pub(super) rates: Factors<T, K>,
}

impl<T: Real, S, I: ?Sized, const N: usize, const K: usize> Sliding<'_, T, S, I, N, K> {
    /// How far from each surface its argument is surely beyond it.
    pub(super) fn aside(&self, x: &SVector<T, N>) -> Each<T, K> {
        let mut aside = Each::all(T::from_f64(T::EPSILON * T::EPSILON));
        let places = self.surfaces.iter().zip(&self.gradients);
        for (aside, (surface, gradient)) in aside.iter_mut().zip(places) {
            let gradient = gradient.get();
            let terms = gradient
                .iter()
                .zip(x)
                .map(|(by, state)| lane(*by * *state).abs());
            let size = terms.fold(lane(surface.level).abs(), |size, term| size + term);
            *aside += T::from_lane(T::Lane::from_f64(ASIDE * T::EPSILON) * size);
        }
        aside
    }

    /// The same of a state that is moved by such distances first, as far as numbers tell of these.
    pub(super) fn aside_behind(&self, x: &SVector<T, N>, distances: &Each<T, K>) -> Each<T, K> {
        let [zero, one] = [0.0, 1.0].map(T::Lane::from_f64);
        let mut sizes = Each::<T::Lane, K>::all(zero);
        for (size, gradient) in sizes
            .iter_mut()
            .zip(self.gradients.iter())
            .take(self.surfaces.count())
        {
            *size = length(&gradient.get());
        }
        let ways = (0..self.free).map(|place| lane(distances[place]).abs() / sizes[place]);
        let way = T::Lane::from_f64(ASIDE * T::EPSILON) * ways.fold(zero, larger);
        let aside = self.aside(x);
        // What is at it by others is to be crossed with it.
        let (twins, likes) = &self.twins;
        let mut farther = Each::<T::Lane, K>::all(zero);
        for like in likes.iter().take(twins.count()) {
            let apart = T::Lane::from_f64(like.apart);
            farther[like.leader] = larger(farther[like.leader], apart);
        }
        Each::of(|place| {
            aside[place] * T::from_lane(one + farther[place]) + T::from_lane(way * sizes[place])
        })
    }

    /// How far a state is from all surfaces, and how it is moved across those that are free.
    pub(super) fn beyond<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) -> Beyond<T, K>
    where
        S: System<T, N, M, P>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut distances = Each::all(T::from_f64(0.0));
        let rates = Factors::of(self.free, |own| {
            let across = self.across[own].get();
            let [[_, at_rest], [there, faster]] = self.told(at, [(x, &rest), (x, &across)], memory);
            distances = there;
            Each::of(|other| faster[other] - at_rest[other])
        });
        Beyond { distances, rates }
    }

    /// A state moved across the free surfaces.
    pub(super) fn moved(&self, x: &SVector<T, N>, ways: Each<T, K>) -> SVector<T, N> {
        let mut moved = *x;
        for (across, way) in self.across.iter().zip(&ways).take(self.free) {
            moved += across.get().map(|across| *way * across);
        }
        moved
    }

    /// The state on the surfaces next to one.
    pub(super) fn onto<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
    {
        let Beyond { distances, rates } = &self.beyond(at, x, memory);
        self.moved(x, rates.solve(distances.map(|it| -it)))
    }

    /// The line that is so many times as far from the surfaces as need be.
    pub(super) fn line<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        (x, factor): (&SVector<T, N>, f64),
        memory: &S::Memory,
    ) -> Line<T, N, K>
    where
        S: System<T, N, M, P>,
    {
        let (count, free) = (self.surfaces.count(), self.free);
        let Beyond { distances, rates } = &self.beyond(at, x, memory);
        let (aside, factor) = (self.aside_behind(x, distances), T::from_f64(factor));
        let aside = aside.map(|aside| factor * aside);
        // Where none depends on others it goes across one after another: beside a surface a law may be a root, which would differ
        // by how far that is when another is crossed.
        let half = T::Lane::from_f64(0.5);
        let beyond = |along: T::Lane, place: usize| {
            let beyond = along - nth(place);
            match count > free {
                true => beyond,
                false => smaller(larger(beyond, -half), half),
            }
        };
        let state = |paces: &Each<T::Lane, K>, along: T::Lane| {
            let mut ways = distances.map(|it| -it);
            for (place, way) in ways.iter_mut().enumerate().take(free) {
                *way += T::from_lane(paces[place] * beyond(along, place)) * aside[place];
            }
            self.moved(x, rates.solve(ways))
        };
        let mut way = Way::across();
        if count > free {
            let ends = [-half, nth::<T::Lane>(free) - half];
            way = self.met(way, ends, (at, &aside), state, memory);
            let longer = smaller(T::Lane::from_f64(LONGEST), way.longer);
            way.paces = way.paces.map(|pace| longer * pace);
            // Far from where others are met rounding leads astray. What is not met yet is by the longer way.
            let crossings = way.crossings.iter().take(count);
            let met = crossings.filter(|along| is_finite(**along));
            let first = met.clone().copied().fold(ends[0], smaller);
            let last = met.copied().fold(ends[1], larger);
            way = self.met(way, [first, last], (at, &aside), state, memory);
        }
        let crossings = way.crossings;
        let order = Each::by(count, |place| crossings[place].into());
        let mut reach = T::Lane::from_f64(0.0);
        let mut before = |place: usize| {
            let crossing = |place: usize| crossings[order[place]];
            let along = match (place > 0, place < count) {
                (true, true) => half * (crossing(place - 1) + crossing(place)),
                (true, false) => crossing(place - 1) + half,
                (false, true) => crossing(place) - half,
                (false, false) => T::Lane::from_f64(0.0),
            };
            for (place, pace) in way.paces.iter().enumerate().take(free) {
                reach = larger(reach, *pace * beyond(along, place).abs());
            }
            state(&way.paces, along)
        };
        let start = before(0);
        let mut behind = Each::all(start);
        for (place, behind) in behind.iter_mut().enumerate().take(count) {
            *behind = before(1 + place);
        }
        Line {
            start,
            behind,
            order,
            forward: way.forward,
            reach,
        }
    }

    /// A way with where it meets the surfaces that are not free, by its ends, and how much longer it is to be, so that it is between
    /// each two as far away as need be.
    fn met<const M: usize, const P: usize>(
        &self,
        mut way: Way<T::Lane, K>,
        ends: [T::Lane; 2],
        (at, aside): (&Moment<T, M>, &Each<T, K>),
        state: impl Fn(&Each<T::Lane, K>, T::Lane) -> SVector<T, N>,
        memory: &S::Memory,
    ) -> Way<T::Lane, K>
    where
        S: System<T, N, M, P>,
    {
        let (count, free) = (self.surfaces.count(), self.free);
        let rest = SVector::from_element(T::from_f64(0.0));
        let [first, last] = ends.map(|along| state(&way.paces, along));
        let told = self.told(at, [(&first, &rest), (&last, &rest)], memory);
        let one = T::Lane::from_f64(1.0);
        let mut rates: Each<T::Lane, K> = Each::of(|place| way.paces[place] * lane(aside[place]));
        for place in free..count {
            let [from, to] = told.map(|it| lane(it[0][place]));
            rates[place] = (to - from) / (ends[1] - ends[0]);
            way.crossings[place] = ends[0] - from / rates[place];
            way.forward[place] = if to < from { -one } else { one };
        }
        let longer = (0..count).map(|place| {
            let here = way.crossings[place];
            let others = (0..count).filter(|other| *other != place);
            let apart = others.map(|other| (way.crossings[other] - here).abs());
            let gap = apart.fold(one, smaller);
            lane(aside[place]) / (T::Lane::from_f64(0.5) * gap * rates[place].abs())
        });
        way.longer = longer.fold(one, larger);
        way
    }
}

/// How a line goes across surfaces.
struct Way<L, const K: usize> {
    /// How fast across each free surface.
    paces: Each<L, K>,
    /// Where it meets each: a free one at the number of its place.
    crossings: Each<L, K>,
    forward: Each<L, K>,
    longer: L,
}

impl<L: Real + PartialOrd, const K: usize> Way<L, K> {
    /// By the golden ratio.
    fn across() -> Self {
        let [mut along, one, two, golden] = [0.0, 1.0, 2.0, PACE].map(L::from_f64);
        let pace = |_| {
            let pace = two + two * along;
            let is_within = along + golden < one;
            along += if is_within { golden } else { golden - one };
            pace
        };
        Self {
            paces: Each::of(pace),
            crossings: Each::of(nth),
            forward: Each::all(one),
            longer: one,
        }
    }
}

/// A place as a number. There are few.
fn nth<L: Real>(place: usize) -> L {
    let one = L::from_f64(1.0);
    (0..place).fold(L::from_f64(0.0), |number, _| number + one)
}
