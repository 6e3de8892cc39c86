//! A line beside a state that crosses each surface once.

use nalgebra::{SMatrix, SVector};

use super::super::seen;
use super::super::surfaces::MOST;
use super::sides::Factors;
use super::{Each, Moment, Sliding};
use crate::{Real, System};

/// How far beside a threshold laws are asked, in units of the rounding of its argument.
pub(super) const ASIDE: f64 = 64.0;
/// Surfaces are gone across at paces of their own, so that those that depend on them are not met where they are.
const PACE: f64 = 0.618_033_988_749_894_9;
/// So many times as long a line may be, for surfaces that it meets next to each other; where it is longer than so, others are tried.
const LONGEST: f64 = 1024.0;
const LONG: f64 = 8.0;
/// So many lines are tried.
const LINES: usize = 8;

/// States before and behind each surface, in the order in which a line meets these.
pub(super) struct Line<T, const N: usize> {
    pub(super) states: [SVector<T, N>; 1 + MOST],
    /// The place of the surface behind each state but the last.
    pub(super) order: [usize; MOST],
    /// In which direction each is crossed.
    pub(super) forward: Each<f64>,
    /// How far it goes, in units of what is surely beside a surface.
    pub(super) reach: f64,
}

impl<T: Real, S, I: ?Sized, const N: usize> Sliding<'_, T, S, I, N> {
    /// How far from each surface its argument is surely beyond it.
    pub(super) fn aside(&self, x: &SVector<T, N>) -> Each<T> {
        let mut aside = [T::from_f64(T::EPSILON * T::EPSILON); MOST];
        let gradients = self.gradients.get();
        for ((aside, surface), gradient) in
            aside.iter_mut().zip(self.surfaces.iter()).zip(&gradients)
        {
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
    pub(super) fn aside_behind(&self, x: &SVector<T, N>, distances: &Each<T>) -> Each<T> {
        let gradients = self.gradients.get();
        let sizes: Each<f64> =
            core::array::from_fn(|place| gradients[place].map(|by| by.magnitude()).norm());
        let ways = (0..self.free).map(|place| seen(distances[place]).abs() / sizes[place]);
        let way = ASIDE * T::EPSILON * ways.fold(0.0, f64::max);
        let aside = self.aside(x);
        // What is at it by others is to be crossed with it.
        let (twins, likes) = &self.twins;
        let mut farther = [0.0_f64; MOST];
        for like in likes.iter().take(twins.count()) {
            farther[like.leader] = farther[like.leader].max(like.apart);
        }
        core::array::from_fn(|place| {
            aside[place] * T::from_f64(1.0 + farther[place]) + T::from_f64(way * sizes[place])
        })
    }

    /// How arguments of the free surfaces go across these, with the distances from all.
    pub(super) fn distances<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) -> (Each<T>, Factors<T>)
    where
        S: System<T, N, M, P>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut distances = [T::from_f64(0.0); MOST];
        let mut rates = SMatrix::from_element(T::from_f64(0.0));
        for (own, across) in self.across.get().iter().take(self.free).enumerate() {
            let [[_, at_rest], [there, faster]] = self.told(at, [(x, &rest), (x, across)], memory);
            distances = there;
            for other in 0..self.free {
                rates[(other, own)] = faster[other] - at_rest[other];
            }
        }
        (distances, Factors::of(&rates, self.free))
    }

    /// A state moved across the free surfaces.
    pub(super) fn moved(&self, x: &SVector<T, N>, ways: Each<T>) -> SVector<T, N> {
        let mut moved = *x;
        for (across, way) in self.across.get().iter().zip(&ways).take(self.free) {
            moved += across.map(|across| *way * across);
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
        let (distances, rates) = self.distances(at, x, memory);
        self.moved(x, rates.solve(distances.map(|it| -it)))
    }

    /// The line that is so many times as far from the surfaces as need be.
    pub(super) fn line<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        (x, factor): (&SVector<T, N>, f64),
        memory: &S::Memory,
    ) -> Line<T, N>
    where
        S: System<T, N, M, P>,
    {
        let (count, free) = (self.surfaces.count(), self.free);
        let (distances, moves) = self.distances(at, x, memory);
        let aside = self.aside_behind(x, &distances);
        let aside = aside.map(|aside| T::from_f64(factor) * aside);
        let state = |paces: &Each<f64>, along: f64| {
            let ways = core::array::from_fn(|place| {
                let beyond = T::from_f64(paces[place] * (along - place as f64)) * aside[place];
                beyond - distances[place]
            });
            self.moved(x, moves.solve(ways))
        };
        let mut way = Way::along(1);
        if count > free {
            let ends = [-0.5, free as f64 - 0.5];
            let met = |way| self.met(way, ends, (at, &aside), state, memory);
            way = met(way);
            for turns in 2..=LINES {
                if way.longer < LONG {
                    break;
                }
                let other = met(Way::along(turns));
                way = if other.longer < way.longer {
                    other
                } else {
                    way
                };
            }
            let longer = way.longer.min(LONGEST);
            way.paces = way.paces.map(|pace| longer * pace);
            // Far from where others are met rounding leads astray.
            let met = way.crossings[..count].iter();
            let first = met.clone().copied().fold(ends[0], f64::min);
            let last = met.copied().fold(ends[1], f64::max);
            way = self.met(way, [first, last], (at, &aside), state, memory);
        }
        let crossings = way.crossings;
        let mut order: [usize; MOST] = core::array::from_fn(|place| place);
        order[..count].sort_unstable_by(|a, b| crossings[*a].total_cmp(&crossings[*b]));
        let (mut states, mut reach) = ([*x; 1 + MOST], 0.0_f64);
        for (place, there) in states.iter_mut().take(1 + count).enumerate() {
            let before = place.checked_sub(1).map(|before| crossings[order[before]]);
            let behind = (place < count).then(|| crossings[order[place]]);
            let along = match (before, behind) {
                (Some(before), Some(behind)) => 0.5 * (before + behind),
                (Some(before), None) => before + 0.5,
                (None, Some(behind)) => behind - 0.5,
                (None, None) => 0.0,
            };
            *there = state(&way.paces, along);
            for (place, pace) in way.paces.iter().enumerate().take(free) {
                reach = reach.max(pace * (along - place as f64).abs());
            }
        }
        Line {
            states,
            order,
            forward: way.forward,
            reach,
        }
    }

    /// A way with where it meets the surfaces that are not free, by its ends, and how much longer it is to be, so that it is between
    /// each two as far away as need be.
    fn met<const M: usize, const P: usize>(
        &self,
        mut way: Way,
        ends: [f64; 2],
        (at, aside): (&Moment<T, M>, &Each<T>),
        state: impl Fn(&Each<f64>, f64) -> SVector<T, N>,
        memory: &S::Memory,
    ) -> Way
    where
        S: System<T, N, M, P>,
    {
        let (count, free) = (self.surfaces.count(), self.free);
        let rest = SVector::from_element(T::from_f64(0.0));
        let [first, last] = ends.map(|along| state(&way.paces, along));
        let told = self.told(at, [(&first, &rest), (&last, &rest)], memory);
        let mut rates: Each<f64> =
            core::array::from_fn(|place| way.paces[place] * seen(aside[place]));
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
struct Way {
    /// How fast across each free surface.
    paces: Each<f64>,
    /// Where it meets each: a free one at the number of its place.
    crossings: Each<f64>,
    forward: Each<f64>,
    longer: f64,
}

impl Way {
    /// One of several, by the golden ratio so many times.
    fn along(turns: usize) -> Self {
        let place = |place: usize| place as f64;
        let pace = |place: usize| 2.0 + 2.0 * ((PACE * (turns * place) as f64) % 1.0);
        Self {
            paces: core::array::from_fn(pace),
            crossings: core::array::from_fn(place),
            forward: [1.0; MOST],
            longer: 1.0,
        }
    }
}
