//! A line beside a state that crosses each surface once.

use nalgebra::SVector;

use super::super::seen;
use super::sides::Factors;
use super::{Each, Moment, Sliding};
use crate::course::whole_below;
use crate::{Real, System};

/// How far beside a threshold laws are asked, in units of the rounding of its argument.
pub(super) const ASIDE: f64 = 64.0;
/// Surfaces are gone across at paces of their own, so that those that depend on them are not met where they are.
const PACE: f64 = 0.618_033_988_749_894_9;
/// So many times as long a line may be, for surfaces that it meets next to each other.
const LONGEST: f64 = 1024.0;

/// States on a line that crosses surfaces.
pub(super) struct Line<T, const N: usize, const K: usize> {
    /// That before all of them.
    pub(super) start: SVector<T, N>,
    /// Those behind each, in the order in which it meets these.
    pub(super) behind: Each<SVector<T, N>, K>,
    /// The place of the surface that is met so.
    pub(super) order: Each<usize, K>,
    /// In which direction each is crossed.
    pub(super) forward: Each<f64, K>,
    /// How far it goes, in units of what is surely beside a surface.
    pub(super) reach: f64,
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
                .map(|(by, state)| (*by * *state).magnitude());
            let size = terms.fold(surface.level.magnitude(), |size, term| size + term);
            *aside += T::from_f64(ASIDE * T::EPSILON * size);
        }
        aside
    }

    /// The same of a state that is moved by such distances first, as far as numbers tell of these.
    pub(super) fn aside_behind(&self, x: &SVector<T, N>, distances: &Each<T, K>) -> Each<T, K> {
        let mut sizes = Each::<f64, K>::all(0.0);
        for (size, gradient) in sizes
            .iter_mut()
            .zip(self.gradients.iter())
            .take(self.surfaces.count())
        {
            *size = gradient.get().map(|by| by.magnitude()).norm();
        }
        let ways = (0..self.free).map(|place| seen(distances[place]).abs() / sizes[place]);
        let way = ASIDE * T::EPSILON * ways.fold(0.0, f64::max);
        let aside = self.aside(x);
        // What is at it by others is to be crossed with it.
        let (twins, likes) = &self.twins;
        let mut farther = Each::<f64, K>::all(0.0);
        for like in likes.iter().take(twins.count()) {
            farther[like.leader] = farther[like.leader].max(like.apart);
        }
        Each::of(|place| {
            aside[place] * T::from_f64(1.0 + farther[place]) + T::from_f64(way * sizes[place])
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
        let aside = self.aside_behind(x, distances);
        let aside = aside.map(|aside| T::from_f64(factor) * aside);
        // Where none depends on others it goes across one after another: beside a surface a law may be a root, which would differ
        // by how far that is when another is crossed.
        let farthest = if count > free { f64::INFINITY } else { 0.5 };
        let beyond = |along: f64, place: usize| (along - place as f64).max(-farthest).min(farthest);
        let state = |paces: &Each<f64, K>, along: f64| {
            let ways = Each::of(|place| {
                let beyond = T::from_f64(paces[place] * beyond(along, place)) * aside[place];
                beyond - distances[place]
            });
            self.moved(x, rates.solve(ways))
        };
        let mut way = Way::across();
        if count > free {
            let ends = [-0.5, free as f64 - 0.5];
            way = self.met(way, ends, (at, &aside), state, memory);
            let longer = way.longer.min(LONGEST);
            way.paces = way.paces.map(|pace| longer * pace);
            // Far from where others are met rounding leads astray. What is not met yet is by the longer way.
            let crossings = way.crossings.iter().take(count);
            let met = crossings.filter(|along| along.is_finite());
            let first = met.clone().copied().fold(ends[0], f64::min);
            let last = met.copied().fold(ends[1], f64::max);
            way = self.met(way, [first, last], (at, &aside), state, memory);
        }
        let crossings = way.crossings;
        let order = Each::by(count, |place| crossings[place]);
        let mut reach = 0.0_f64;
        let mut before = |place: usize| {
            let crossing = |place: usize| crossings[order[place]];
            let along = match (place > 0, place < count) {
                (true, true) => 0.5 * (crossing(place - 1) + crossing(place)),
                (true, false) => crossing(place - 1) + 0.5,
                (false, true) => crossing(place) - 0.5,
                (false, false) => 0.0,
            };
            for (place, pace) in way.paces.iter().enumerate().take(free) {
                reach = reach.max(pace * beyond(along, place).abs());
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
        mut way: Way<K>,
        ends: [f64; 2],
        (at, aside): (&Moment<T, M>, &Each<T, K>),
        state: impl Fn(&Each<f64, K>, f64) -> SVector<T, N>,
        memory: &S::Memory,
    ) -> Way<K>
    where
        S: System<T, N, M, P>,
    {
        let (count, free) = (self.surfaces.count(), self.free);
        let rest = SVector::from_element(T::from_f64(0.0));
        let [first, last] = ends.map(|along| state(&way.paces, along));
        let told = self.told(at, [(&first, &rest), (&last, &rest)], memory);
        let mut rates: Each<f64, K> = Each::of(|place| way.paces[place] * seen(aside[place]));
        for place in free..count {
            let [from, to] = told.map(|it| seen(it[0][place]));
            rates[place] = (to - from) / (ends[1] - ends[0]);
            way.crossings[place] = ends[0] - from / rates[place];
            way.forward[place] = f64::signum(to - from);
        }
        let longer = (0..count).map(|place| {
            let here = way.crossings[place];
            let others = (0..count).filter(|other| *other != place);
            let apart = others.map(|other| (way.crossings[other] - here).abs());
            let gap = apart.fold(1.0, f64::min);
            seen(aside[place]) / (0.5 * gap * rates[place].abs())
        });
        way.longer = longer.fold(1.0, f64::max);
        way
    }
}

/// How a line goes across surfaces.
struct Way<const K: usize> {
    /// How fast across each free surface.
    paces: Each<f64, K>,
    /// Where it meets each: a free one at the number of its place.
    crossings: Each<f64, K>,
    forward: Each<f64, K>,
    longer: f64,
}

impl<const K: usize> Way<K> {
    /// By the golden ratio.
    fn across() -> Self {
        let place = |place: usize| place as f64;
        let pace = |place: usize| {
            let along = PACE * place as f64;
            2.0 + 2.0 * (along - whole_below(along) as f64)
        };
        Self {
            paces: Each::of(pace),
            crossings: Each::of(place),
            forward: Each::all(1.0),
            longer: 1.0,
        }
    }
}
