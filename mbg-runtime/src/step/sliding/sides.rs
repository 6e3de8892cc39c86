//! What a model says on both sides of thresholds at which its motion stays.

use nalgebra::{SMatrix, SVector};

use super::super::jumps::least_jump;
use super::super::seen;
use super::super::surfaces::MOST;
use super::choice::{Choice, chosen};
use super::line::Line;
use super::{Each, Moment, Sliding};
use crate::solve::Regular;
use crate::{Real, System};

/// So many surfaces are few.
const FEW: usize = 3;
/// What a law that bends differs by on both sides grows with their distance, by this part at least.
const BENT: f64 = 0.125;
/// A sum is zero but for rounding within so many units of the last place of its terms.
const PLACES: f64 = 8.0;

/// What a model says on the sides of surfaces, along a line that crosses each.
pub(super) struct Sides<T, const N: usize> {
    line: Line<T, N>,
    /// The derivative before all, and how much more it is behind each.
    base: SVector<T, N>,
    pub(super) jumps: Each<SVector<T, N>>,
    /// How fast the argument of each goes before all, and how much faster behind each.
    first: Each<T>,
    faster: SMatrix<T, MOST, MOST>,
    /// The same of those that are free.
    pub(super) rates: Factors<T>,
    /// Whether its own argument goes slower ahead of each, and by how much.
    pub(super) leads_back: Each<bool>,
    slower: Each<f64>,
    /// Which part of the mean is behind each.
    pub(super) parts: Each<T>,
}

impl<T: Real, const N: usize> Sides<T, N> {
    /// That of the mean.
    pub(super) fn derivative(&self) -> SVector<T, N> {
        SVector::from_fn(|row, _| {
            let shares = self.jumps.iter().zip(&self.parts);
            let shares = shares.map(|(jump, part)| *part * jump[row]);
            summed(core::iter::once(self.base[row]).chain(shares))
        })
    }

    /// The mean of what there is on the sides of so many surfaces.
    pub(super) fn mean<const R: usize, const C: usize>(
        &self,
        count: usize,
        mut of: impl FnMut(&SVector<T, N>) -> SMatrix<T, R, C>,
    ) -> SMatrix<T, R, C> {
        let [start, behind @ ..] = &self.line.states;
        let mut before = of(start);
        let mut mean = before;
        for (state, place) in behind.iter().zip(&self.line.order).take(count) {
            let there = of(state);
            mean += (there - before).map(|jump| self.parts[*place] * jump);
            before = there;
        }
        mean
    }

    /// Whether a law bends at a surface and does not jump, as these sides show, which are farther from it than others by a factor.
    pub(super) fn bends(&self, nearer: &Self, place: usize, factor: f64) -> bool {
        self.slower[place] > BENT * factor * nearer.slower[place]
    }

    /// How far the mean is from leaving a surface, as a part of what the laws differ by there.
    pub(super) fn held(&self, place: usize) -> T {
        let part = self.parts[place];
        part.min(T::from_f64(1.0) - part)
    }

    /// How the motion is at each of so many surfaces, where some are not open.
    pub(super) fn chosen(&self, known: &[Option<Choice>]) -> Option<Each<Choice>> {
        let forward = &self.line.forward;
        let first = core::array::from_fn(|row| forward[row] * seen(self.first[row]));
        let faster =
            SMatrix::from_fn(|row, column| forward[row] * seen(self.faster[(row, column)]));
        chosen((&first, &faster), known)
    }

    /// How far beside surfaces others are to be, in units of what is surely beside one.
    pub(super) fn reach(&self) -> f64 {
        self.line.reach
    }

    /// The part of the mean that is above a surface.
    pub(super) fn above(&self, place: usize, choice: Choice) -> f64 {
        let part = choice.part();
        match self.line.forward[place] > 0.0 {
            true => part,
            false => 1.0 - part,
        }
    }

    /// The side of a surface on which what goes so is, below or above.
    pub(super) fn side(&self, place: usize, choice: Choice) -> f64 {
        match choice {
            Choice::Stays(_) => 0.0,
            Choice::Before => -self.line.forward[place],
            Choice::Ahead => self.line.forward[place],
        }
    }

    /// What goes to a side is as if it did by this choice.
    pub(super) fn to_side(&self, place: usize, side: f64) -> Choice {
        match side * self.line.forward[place] > 0.0 {
            true => Choice::Ahead,
            false => Choice::Before,
        }
    }

    /// How fast the argument of a surface goes in the mean of these.
    pub(super) fn rate(&self, place: usize, choices: &[Choice]) -> f64 {
        let parts = choices.iter().enumerate();
        let faster = parts.map(|(other, choice)| seen(self.faster[(place, other)]) * choice.part());
        seen(self.first[place]) + faster.sum::<f64>()
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
    pub(super) fn told<const M: usize, const P: usize>(
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
        let mut gradients = self.gradients.get();
        for state in 0..N {
            let rates = self.by_state(state, (at, x), memory);
            for (gradient, rate) in gradients.iter_mut().zip(&rates) {
                gradient[state] = *rate;
            }
        }
        self.gradients.set(gradients);
    }

    /// How the argument of each surface changes with a state.
    pub(super) fn by_state<const M: usize, const P: usize>(
        &self,
        state: usize,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        memory: &S::Memory,
    ) -> SVector<T, MOST>
    where
        S: System<T, N, M, P>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut unit = rest;
        unit[state] = T::from_f64(1.0);
        let [[_, at_rest], [_, rates]] = self.told(at, [(x, &rest), (x, &unit)], memory);
        SVector::from(rates) - SVector::from(at_rest)
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
        let zero = T::from_f64(0.0);
        let (count, free) = (self.surfaces.count(), self.free);
        let line = self.line(at, (x, factor), memory);
        let base = (self.system).derivative(at.time, &line.states[0], &at.input, memory);
        let mut slope = base;
        let mut jumps = [SVector::from_element(zero); MOST];
        let mut first = [zero; MOST];
        let mut faster = SMatrix::from_element(zero);
        let (mut leads_back, mut slower) = ([false; MOST], [0.0; MOST]);
        let jump = least_jump::<T>();
        let gradients = self.gradients.get();
        for (number, own) in line.order.iter().copied().enumerate().take(count) {
            let [before, behind] = [&line.states[number], &line.states[1 + number]];
            let next = (self.system).derivative(at.time, behind, &at.input, memory);
            let [[_, rates], [_, rates_behind]] =
                self.told(at, [(before, &slope), (behind, &next)], memory);
            if number == 0 {
                first = rates;
            }
            jumps[own] = next - slope;
            for other in 0..count {
                faster[(other, own)] = rates_behind[other] - rates[other];
            }
            let terms = gradients[own].iter().zip(slope.iter().zip(&next));
            let size = terms.fold(0.0, |size, (by, (a, b))| {
                size + by.magnitude() * (a.magnitude() + b.magnitude())
            });
            slower[own] = -line.forward[own] * seen(faster[(own, own)]);
            leads_back[own] = slower[own] > jump * size;
            slope = next;
        }
        self.evaluations
            .set(self.evaluations.get() + 1 + count as u64);
        let rates = Factors::of(&faster, free);
        let mut shares = self.shares;
        for place in (free..count).filter(|place| line.forward[*place] < 0.0) {
            shares[place] = T::from_f64(1.0) - shares[place];
        }
        let right = core::array::from_fn(|row| {
            let bound = (free..count).map(|place| shares[place] * faster[(row, place)]);
            bound.fold(-first[row], |rate, by| rate - by)
        });
        let mut parts = rates.solve(right);
        parts[free..].copy_from_slice(&shares[free..]);
        Sides {
            line,
            base,
            jumps,
            first,
            faster,
            rates,
            leads_back,
            slower,
            parts,
        }
    }
}

/// A sum of terms. What rounding alone has left of it is nothing, since the motion does not leave that: methods that iterate go by how
/// large a state is, and those that control their steps by how large its slopes are.
pub(super) fn summed<T: Real>(terms: impl Iterator<Item = T> + Clone) -> T {
    let zero = T::from_f64(0.0);
    let sum = terms.clone().fold(zero, |sum, term| sum + term);
    let is_rounding = |of: &dyn Fn(T) -> f64| {
        let size = terms.clone().fold(0.0, |size, term| size + of(term).abs());
        of(sum).abs() <= PLACES * T::EPSILON * size
    };
    if !is_rounding(&|number| number.magnitude()) {
        return sum;
    }
    let mut directions = (0..).take_while(|direction| sum.slope_along(*direction).is_some());
    match directions.all(|it| is_rounding(&|number| number.slope_along(it).unwrap_or(0.0))) {
        true => zero,
        false => sum - T::from_f64(seen(sum)),
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
    pub(super) fn of(matrix: &SMatrix<T, MOST, MOST>, count: usize) -> Self {
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
