//! What a model says on both sides of thresholds at which its motion stays.

use nalgebra::{SMatrix, SVector};

use super::super::seen;
use super::super::surfaces::MOST;
use super::{Each, Moment, Sliding};
use crate::solve::Regular;
use crate::{Real, System};

/// So many surfaces are few.
const FEW: usize = 3;
/// How far beside a threshold laws are asked, in units of the rounding of its argument.
const ASIDE: f64 = 64.0;
/// What a law that bends differs by on both sides grows with their distance, by this part at least.
const BENT: f64 = 0.125;
/// A sum is zero but for rounding within so many units of the last place of its terms.
const PLACES: f64 = 8.0;
/// A rate jumps if it differs by more than this part of what it is made of, or so many units of the last place.
const JUMP: f64 = 1e-7;
const JUMP_PLACES: f64 = 64.0;

/// What a model says on the sides of surfaces.
pub(super) struct Sides<T, const N: usize> {
    /// A state below all surfaces, and for each one that is above it alone.
    states: [SVector<T, N>; 1 + MOST],
    /// The derivative below all, and how much more it is above each.
    base: SVector<T, N>,
    pub(super) jumps: Each<SVector<T, N>>,
    /// How much faster the argument of each surface goes above each.
    pub(super) rates: Factors<T>,
    /// Whether its own argument goes slower above each, and by how much.
    pub(super) leads_back: Each<bool>,
    slower: Each<f64>,
    /// Which part of the mean is above each.
    pub(super) parts: Each<T>,
}

impl<T: Real, const N: usize> Sides<T, N> {
    /// What is left of a state by rounding alone, which the motion does not leave, is nothing: methods that iterate go by how large a
    /// state is.
    pub(super) fn derivative(&self) -> SVector<T, N> {
        let (mut derivative, mut sizes) = (self.base, self.base.map(Real::magnitude));
        for (jump, part) in self.jumps.iter().zip(&self.parts) {
            let shares = jump.map(|jump| *part * jump);
            derivative += shares;
            sizes += shares.map(Real::magnitude);
        }
        derivative.zip_map(&sizes, |sum, size| {
            let is_rounding = sum.magnitude() <= PLACES * T::EPSILON * size;
            let left = if is_rounding { seen(sum) } else { 0.0 };
            sum - T::from_f64(left)
        })
    }

    /// The mean of what there is on the sides of so many surfaces.
    pub(super) fn mean<const R: usize, const C: usize>(
        &self,
        count: usize,
        mut of: impl FnMut(&SVector<T, N>) -> SMatrix<T, R, C>,
    ) -> SMatrix<T, R, C> {
        let [below, above @ ..] = &self.states;
        let base = of(below);
        let mut mean = base;
        for (state, part) in above.iter().zip(&self.parts).take(count) {
            mean += (of(state) - base).map(|jump| *part * jump);
        }
        mean
    }

    /// Whether a law bends at a surface and does not jump, as these sides show, which are farther from it than others by a factor.
    pub(super) fn bends(&self, nearer: &Self, place: usize, factor: f64) -> bool {
        self.slower[place] > BENT * factor * nearer.slower[place]
    }

    /// How far beyond all means of both sides the motion along a surface would be.
    pub(super) fn beyond(&self, place: usize) -> f64 {
        let part = seen(self.parts[place]);
        match part.is_nan() {
            true => f64::INFINITY,
            false => (-part).max(part - 1.0).max(0.0),
        }
    }

    /// How states change that go across each surface alone.
    pub(super) fn across(&self, count: usize) -> Each<SVector<T, N>> {
        let zero = T::from_f64(0.0);
        core::array::from_fn(|own| {
            let mut right = [zero; MOST];
            right[own] = T::from_f64(if own < count { 1.0 } else { 0.0 });
            let parts = self.rates.solve(right);
            let mut across = SVector::from_element(zero);
            for (jump, part) in self.jumps.iter().zip(&parts) {
                across += jump.map(|jump| *part * jump);
            }
            across
        })
    }
}

impl<T: Real, S, I: ?Sized, const N: usize> Sliding<'_, T, S, I, N> {
    /// The arguments of all surfaces, beyond these, and how fast they change, at two states that change so.
    fn told<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        places: [(&SVector<T, N>, &SVector<T, N>); 2],
        memory: &S::Memory,
    ) -> [[Each<T>; 2]; 2]
    where
        S: System<T, N, M, P>,
    {
        let mut told = [[[T::from_f64(0.0); MOST]; 2]; 2];
        let (mut number, mut memory) = (0, *memory);
        let [from, to] = places.map(|(x, slope)| (at.time, [x, slope], [&at.input, &at.rate]));
        self.system.courses(from, to, &mut memory, |course| {
            if let Some((place, level)) = self.surfaces.of(number) {
                for (told, [value, rate]) in told.iter_mut().zip([course.from, course.to]) {
                    (told[0][place], told[1][place]) = (value - level, rate);
                }
            }
            number += 1;
        });
        told
    }

    /// How the argument of each surface changes with each state here.
    pub(super) fn look<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) where
        S: System<T, N, M, P>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut gradients = self.gradients.get();
        for state in 0..N {
            let mut unit = rest;
            unit[state] = T::from_f64(1.0);
            let [[_, at_rest], [_, rates]] = self.told(at, [(x, &rest), (x, &unit)], memory);
            for (gradient, (rate, own)) in gradients.iter_mut().zip(rates.iter().zip(&at_rest)) {
                gradient[state] = *rate - *own;
            }
        }
        self.gradients.set(gradients);
    }

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

    /// How arguments go across surfaces, with their distances from these.
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
        let count = self.surfaces.count();
        for (own, across) in self.across.iter().take(count).enumerate() {
            let [[_, at_rest], [there, faster]] = self.told(at, [(x, &rest), (x, across)], memory);
            distances = there;
            for other in 0..count {
                rates[(other, own)] = faster[other] - at_rest[other];
            }
        }
        (distances, Factors::of(&rates, count))
    }

    /// A state moved across the surfaces.
    pub(super) fn moved(&self, x: &SVector<T, N>, ways: Each<T>) -> SVector<T, N> {
        let mut moved = *x;
        for (across, way) in self.across.iter().zip(&ways) {
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

    /// What the model says on the sides of the surfaces, so many times as far from these as need be.
    // Of all that asks for it there is one copy: it is much code, and none that a run waits for.
    #[inline(never)]
    pub(super) fn sides<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        (x, factor): (&SVector<T, N>, f64),
        memory: &mut S::Memory,
    ) -> Sides<T, N>
    where
        S: System<T, N, M, P>,
    {
        let [zero, two] = [0.0, 2.0].map(T::from_f64);
        let count = self.surfaces.count();
        let (distances, moves) = self.distances(at, x, memory);
        let aside = self.aside(x).map(|aside| T::from_f64(factor) * aside);
        let mut states = [*x; 1 + MOST];
        let down = core::array::from_fn(|place| match place < count {
            true => -(aside[place] + distances[place]),
            false => zero,
        });
        states[0] = self.moved(x, moves.solve(down));
        let base = (self.system).derivative(at.time, &states[0], &at.input, memory);
        let mut jumps = [SVector::from_element(zero); MOST];
        let mut rates = SMatrix::from_element(zero);
        let mut right = [zero; MOST];
        let (mut leads_back, mut slower) = ([false; MOST], [0.0; MOST]);
        let jump = JUMP.max(JUMP_PLACES * T::EPSILON);
        let gradients = self.gradients.get();
        for own in 0..count {
            let mut up = [zero; MOST];
            up[own] = two * aside[own];
            let above = self.moved(&states[0], moves.solve(up));
            let slope = (self.system).derivative(at.time, &above, &at.input, memory);
            let [[_, below], [_, faster]] =
                self.told(at, [(&states[0], &base), (&above, &slope)], memory);
            jumps[own] = slope - base;
            for other in 0..count {
                rates[(other, own)] = faster[other] - below[other];
                right[other] = -below[other];
            }
            let terms = gradients[own].iter().zip(base.iter().zip(&slope));
            let size = terms.fold(0.0, |size, (by, (a, b))| {
                size + by.magnitude() * (a.magnitude() + b.magnitude())
            });
            slower[own] = -seen(rates[(own, own)]);
            leads_back[own] = slower[own] > jump * size;
            states[1 + own] = above;
        }
        self.evaluations
            .set(self.evaluations.get() + 1 + count as u64);
        let rates = Factors::of(&rates, count);
        let parts = rates.solve(right);
        Sides {
            states,
            base,
            jumps,
            rates,
            leads_back,
            slower,
            parts,
        }
    }
}

/// The shortest ways across surfaces of these gradients, each along the others.
pub(super) fn shortest<T: Real, const N: usize>(
    gradients: &Each<SVector<T, N>>,
    count: usize,
) -> Each<SVector<T, N>> {
    let zero = T::from_f64(0.0);
    let products = SMatrix::from_fn(|row: usize, column: usize| {
        let pairs = gradients[row].iter().zip(&gradients[column]);
        pairs.fold(zero, |sum, (a, b)| a.multiply_add(*b, sum))
    });
    let products = Factors::of(&products, count);
    core::array::from_fn(|own| {
        let mut right = [zero; MOST];
        right[own] = T::from_f64(if own < count { 1.0 } else { 0.0 });
        let parts = products.solve(right);
        let mut way = SVector::from_element(zero);
        for (gradient, part) in gradients.iter().zip(&parts) {
            way += gradient.map(|by| *part * by);
        }
        way
    })
}

/// Factors of a matrix with a row for each surface, which are few most of the time.
pub(super) enum Factors<T> {
    One(T),
    Few(Regular<T, FEW>),
    All(Regular<T, MOST>),
}

impl<T: Real> Factors<T> {
    /// Of the first rows and columns.
    fn of(matrix: &SMatrix<T, MOST, MOST>, count: usize) -> Self {
        match count {
            1 => Self::One(match matrix[(0, 0)].magnitude() {
                // Where nothing jumps any more there is no mean.
                0.0 => T::from_f64(0.0),
                _ => T::from_f64(1.0) / matrix[(0, 0)],
            }),
            ..=FEW => Self::Few(Regular::new(part(matrix, count))),
            _ => Self::All(Regular::new(part(matrix, count))),
        }
    }

    pub(super) fn solve(&self, mut right: Each<T>) -> Each<T> {
        match self {
            Self::One(reciprocal) => {
                right[0] = *reciprocal * right[0];
                right
            }
            Self::Few(factors) => {
                let few = factors.solution(&SVector::from_fn(|row, _| right[row]));
                right[..FEW].copy_from_slice(few.as_slice());
                right
            }
            Self::All(factors) => factors.solution(&SVector::from(right)).into(),
        }
    }
}

/// The first rows and columns of a matrix, in one that leaves all others as they are.
fn part<T: Real, const K: usize>(
    matrix: &SMatrix<T, MOST, MOST>,
    count: usize,
) -> SMatrix<T, K, K> {
    SMatrix::from_fn(|row, column| match row.max(column) < count {
        true => matrix[(row, column)],
        false => T::from_f64(if row == column { 1.0 } else { 0.0 }),
    })
}
