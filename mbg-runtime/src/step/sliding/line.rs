//! A line beside a state that crosses each surface once.

use nalgebra::{SMatrix, SVector};

use super::super::seen;
use super::super::surfaces::MOST;
use super::sides::Factors;
use super::{Each, Moment, Sliding};
use crate::{Real, System};

/// How far beside a threshold laws are asked, in units of the rounding of its argument.
const ASIDE: f64 = 64.0;
/// Surfaces are gone across at paces of their own, so that those that depend on them are not met where they are.
const PACE: f64 = 0.618_033_988_749_894_9;
/// So many times as long a line may be, for surfaces that it meets next to each other.
const LONGEST: f64 = 1024.0;

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
        core::array::from_fn(|place| aside[place] + T::from_f64(way * sizes[place]))
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
        for (own, across) in self.across.iter().take(self.free).enumerate() {
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
        for (across, way) in self.across.iter().zip(&ways).take(self.free) {
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
        // Each free surface is met at the number of its place.
        let mut crossings: [f64; MOST] = core::array::from_fn(|place| place as f64);
        let mut forward = [1.0; MOST];
        let mut paces: [f64; MOST] =
            core::array::from_fn(|place| 2.0 + 2.0 * ((PACE * place as f64) % 1.0));
        let state = |paces: &[f64; MOST], along: f64| {
            let ways = core::array::from_fn(|place| {
                let beyond = T::from_f64(paces[place] * (along - place as f64)) * aside[place];
                beyond - distances[place]
            });
            self.moved(x, moves.solve(ways))
        };
        if count > free {
            let ends = [-0.5, free as f64 - 0.5];
            let rest = SVector::from_element(T::from_f64(0.0));
            let [first, last] = ends.map(|along| state(&paces, along));
            let told = self.told(at, [(&first, &rest), (&last, &rest)], memory);
            let mut rates: [f64; MOST] =
                core::array::from_fn(|place| paces[place] * seen(aside[place]));
            for place in free..count {
                let [from, to] = told.map(|it| seen(it[0][place]));
                rates[place] = (to - from) / free as f64;
                crossings[place] = ends[0] - from / rates[place];
                forward[place] = f64::signum(to - from);
            }
            // Between two each is as far away as need be.
            let longer = (0..count).map(|place| {
                let others = (0..count).filter(|other| *other != place);
                let gap = others.fold(1.0, |gap: f64, other| {
                    gap.min((crossings[other] - crossings[place]).abs())
                });
                seen(aside[place]) / (0.5 * gap * rates[place].abs())
            });
            let longer = longer.fold(1.0, f64::max).min(LONGEST);
            paces = paces.map(|pace| longer * pace);
        }
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
            *there = state(&paces, along);
            for (place, pace) in paces.iter().enumerate().take(free) {
                reach = reach.max(pace * (along - place as f64).abs());
            }
        }
        Line {
            states,
            order,
            forward,
            reach,
        }
    }
}
