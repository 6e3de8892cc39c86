//! What a model says on both sides of thresholds at which its motion stays.

use nalgebra::{SMatrix, SVector};

use super::super::jumps::least_jump;
use super::super::seen;
use super::choice::{Choice, chosen};
use super::line::Line;
use super::{Each, Moment, Sliding};
use crate::lane::lane;
use crate::solve::Regular;
use crate::{Real, System};

/// So many surfaces are few.
const FEW: usize = 3;
/// What a law that bends differs by on both sides grows with their distance, by this part at least.
const BENT: f64 = 0.125;
/// A sum is zero but for rounding within so many units of the last place of its terms.
const PLACES: f64 = 8.0;

/// What a model says on the sides of surfaces, along a line that crosses each.
pub(super) struct Sides<T: Real, const N: usize, const K: usize> {
    /// How many surfaces there are.
    count: usize,
    line: Line<T, N, K>,
    /// The derivative before all, and how much more it is behind each.
    base: SVector<T, N>,
    pub(super) jumps: Each<SVector<T, N>, K>,
    /// How fast the argument of each goes before all, and how much faster behind each.
    first: Each<T, K>,
    faster: Each<Each<T, K>, K>,
    /// The same of those that are free.
    pub(super) rates: Factors<T, K>,
    /// Whether its own argument goes slower ahead of each, and by how much.
    pub(super) leads_back: Each<bool, K>,
    slower: Each<T::Lane, K>,
    /// Which part of the mean is behind each.
    pub(super) parts: Each<T, K>,
}

impl<T: Real, const N: usize, const K: usize> Sides<T, N, K> {
    /// That of the mean.
    pub(super) fn derivative(&self) -> SVector<T, N> {
        SVector::from_fn(|row, _| {
            let shares = self.jumps.iter().zip(&self.parts).take(self.count);
            let shares = shares.map(|(jump, part)| *part * jump[row]);
            summed(core::iter::once(self.base[row]).chain(shares))
        })
    }

    /// The mean of what there is on the sides.
    pub(super) fn mean<const R: usize, const C: usize>(
        &self,
        mut of: impl FnMut(&SVector<T, N>) -> SMatrix<T, R, C>,
    ) -> SMatrix<T, R, C> {
        let Line {
            start,
            behind,
            order,
            ..
        } = &self.line;
        let mut before = of(start);
        let mut mean = before;
        for (state, place) in behind.iter().zip(order).take(self.count) {
            let there = of(state);
            mean += (there - before).map(|jump| self.parts[*place] * jump);
            before = there;
        }
        mean
    }

    /// Whether a law bends at a surface and does not jump, as these sides show, which are farther from it than others by a factor.
    pub(super) fn bends(&self, nearer: &Self, place: usize, factor: f64) -> bool {
        self.slower[place] > T::Lane::from_f64(BENT * factor) * nearer.slower[place]
    }

    /// How far the mean is from leaving a surface, as a part of what the laws differ by there.
    pub(super) fn held(&self, place: usize) -> T {
        let part = self.parts[place];
        part.min(T::from_f64(1.0) - part)
    }

    /// How the motion is at each of so many surfaces, where some are not open.
    pub(super) fn chosen(&self, known: &Each<Option<Choice>, K>) -> Option<Each<Choice, K>> {
        let forward = &self.line.forward;
        let forward = forward.map(Into::<f64>::into);
        let first = Each::of(|row| forward[row] * seen(self.first[row]));
        let faster =
            Each::of(|column| Each::of(|row| forward[row] * seen(self.faster[column][row])));
        chosen((&first, &faster), self.count, known)
    }

    /// How far beside surfaces others are to be, in units of what is surely beside one.
    pub(super) fn reach(&self) -> T::Lane {
        self.line.reach
    }

    /// The part of the mean that is above a surface.
    pub(super) fn above(&self, place: usize, choice: Choice) -> f64 {
        let part = choice.part();
        match self.forward(place) > 0.0 {
            true => part,
            false => 1.0 - part,
        }
    }

    /// The side of a surface on which what goes so is, below or above.
    pub(super) fn side(&self, place: usize, choice: Choice) -> f64 {
        match choice {
            Choice::Stays(_) => 0.0,
            Choice::Before => -self.forward(place),
            Choice::Ahead => self.forward(place),
        }
    }

    /// In which direction a surface is crossed.
    fn forward(&self, place: usize) -> f64 {
        self.line.forward[place].into()
    }

    /// What goes to a side is as if it did by this choice.
    pub(super) fn to_side(&self, place: usize, side: f64) -> Choice {
        match side * self.forward(place) > 0.0 {
            true => Choice::Ahead,
            false => Choice::Before,
        }
    }

    /// How fast the argument of a surface goes in the mean of these.
    pub(super) fn rate(&self, place: usize, choices: &Each<Choice, K>) -> f64 {
        let parts = choices.iter().enumerate().take(self.count);
        let faster = parts.map(|(other, choice)| seen(self.faster[other][place]) * choice.part());
        seen(self.first[place]) + faster.sum::<f64>()
    }

    /// How states change that go across each of the first surfaces, which are free, alone.
    pub(super) fn across(&self, free: usize) -> impl Iterator<Item = SVector<T, N>> {
        (0..free).map(move |own| self.rates.dual(own, &self.jumps, free))
    }
}

impl<T: Real, S, I: ?Sized, const N: usize, const K: usize> Sliding<'_, T, S, I, N, K> {
    /// The arguments of all surfaces, beyond these, and how fast they change, at two states that change so.
    pub(super) fn told<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        places: [(&SVector<T, N>, &SVector<T, N>); 2],
        memory: &S::Memory,
    ) -> [[Each<T, K>; 2]; 2]
    where
        S: System<T, N, M, P>,
    {
        let mut told = [[Each::all(T::from_f64(0.0)); 2]; 2];
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

    /// How the argument of each surface changes with each state, where the motion has come to.
    pub(super) fn gradients(&self) -> Each<SVector<T, N>, K> {
        Each::of(|place| self.gradients[place].get())
    }

    /// Asks that here.
    pub(super) fn look<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) where
        S: System<T, N, M, P>,
    {
        let mut gradients = self.gradients();
        for state in 0..N {
            let rates = self.by_state(state, (at, x), memory);
            for (gradient, rate) in gradients.iter_mut().zip(&rates) {
                gradient[state] = *rate;
            }
        }
        for (known, gradient) in self.gradients.iter().zip(&gradients) {
            known.set(*gradient);
        }
    }

    /// How the argument of each surface changes with a state.
    pub(super) fn by_state<const M: usize, const P: usize>(
        &self,
        state: usize,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        memory: &S::Memory,
    ) -> SVector<T, K>
    where
        S: System<T, N, M, P>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut unit = rest;
        unit[state] = T::from_f64(1.0);
        let [[_, at_rest], [_, rates]] = self.told(at, [(x, &rest), (x, &unit)], memory);
        SVector::from_fn(|place, _| rates[place] - at_rest[place])
    }

    /// What the model says on the sides of the surfaces, so many times as far from these as need be.
    // Of all that asks for it there is one copy: it is much code.
    #[inline(never)]
    pub(super) fn sides<const M: usize, const P: usize>(
        &self,
        at: &Moment<T, M>,
        place: (&SVector<T, N>, f64),
        memory: &mut S::Memory,
    ) -> Sides<T, N, K>
    where
        S: System<T, N, M, P>,
    {
        let zero = T::from_f64(0.0);
        let (count, free) = (self.surfaces.count(), self.free);
        let line = self.line(at, place, memory);
        let base = (self.system).derivative(at.time, &line.start, &at.input, memory);
        let mut sides = Sides {
            count,
            line,
            base,
            jumps: Each::all(SVector::from_element(zero)),
            first: Each::all(zero),
            faster: Each::all(Each::all(zero)),
            rates: Factors::One(zero),
            leads_back: Each::all(false),
            slower: Each::all(T::Lane::from_f64(0.0)),
            parts: self.shares,
        };
        let (mut before, mut slope) = (&sides.line.start, base);
        let jump = T::Lane::from_f64(least_jump::<T>());
        let way = sides.line.order.iter().zip(&sides.line.behind);
        for (number, (own, behind)) in way.enumerate().take(count) {
            let own = *own;
            let next = (self.system).derivative(at.time, behind, &at.input, memory);
            let places = [(before, &slope), (behind, &next)];
            let [[_, rates], [_, rates_behind]] = self.told(at, places, memory);
            if number == 0 {
                sides.first = rates;
            }
            sides.jumps[own] = next - slope;
            let faster: Each<T, K> = Each::of(|other| rates_behind[other] - rates[other]);
            sides.slower[own] = -sides.line.forward[own] * lane(faster[own]);
            sides.faster[own] = faster;
            let gradient = self.gradients[own].get();
            let terms = gradient.iter().zip(slope.iter().zip(&next));
            let size = terms.fold(T::Lane::from_f64(0.0), |size, (by, (a, b))| {
                size + lane(*by).abs() * (lane(*a).abs() + lane(*b).abs())
            });
            sides.leads_back[own] = sides.slower[own] > jump * size;
            (before, slope) = (behind, next);
        }
        self.evaluations
            .set(self.evaluations.get() + 1 + count as u64);
        sides.rates = Factors::of(free, |own| sides.faster[own]);
        for place in free..count {
            if sides.forward(place) < 0.0 {
                sides.parts[place] = T::from_f64(1.0) - sides.parts[place];
            }
        }
        let right = Each::of(|row| {
            let bound = (free..count).map(|place| sides.parts[place] * sides.faster[place][row]);
            bound.fold(-sides.first[row], |rate, by| rate - by)
        });
        let parts = sides.rates.solve(right);
        for (part, free) in sides.parts.iter_mut().zip(&parts).take(free) {
            *part = *free;
        }
        sides
    }
}

/// A sum of terms. What rounding alone has left of it is nothing, since the motion does not leave that: methods that iterate go by how
/// large a state is, and those that control their steps by how large its slopes are.
pub(super) fn summed<T: Real>(terms: impl Iterator<Item = T> + Clone) -> T {
    let zero = T::from_f64(0.0);
    let sum = terms.clone().fold(zero, |sum, term| sum + term);
    let values = terms.clone().map(|term| lane(term).abs());
    if !is_rounding::<T, _>(lane(sum).abs(), values) {
        return sum;
    }
    let mut directions =
        (0..).map_while(|direction| Some((direction, sum.slope_along(direction)?)));
    let is_nothing = directions.all(|(direction, of_sum)| {
        let slopes = terms.clone();
        let slopes = slopes.map(|term| term.slope_along(direction).unwrap_or(0.0));
        is_rounding::<T, _>(of_sum, slopes)
    });
    match is_nothing {
        true => zero,
        false => sum - T::from_lane(lane(sum)),
    }
}

/// Whether of terms so large rounding alone may have left so much.
fn is_rounding<T: Real, L: Real + PartialOrd>(left: L, terms: impl Iterator<Item = L>) -> bool {
    let size = terms.fold(L::from_f64(0.0), |size, term| size + term);
    left <= L::from_f64(PLACES * T::EPSILON) * size
}

/// The shortest ways across surfaces of these gradients, each along the others.
pub(super) fn shortest<T: Real, const N: usize, const K: usize>(
    gradients: &Each<SVector<T, N>, K>,
    count: usize,
) -> impl Iterator<Item = SVector<T, N>> {
    let zero = T::from_f64(0.0);
    let factors = Factors::of(count, |column| {
        let mut products = Each::all(zero);
        for (product, gradient) in products.iter_mut().zip(gradients).take(count) {
            let pairs = gradient.iter().zip(&gradients[column]);
            *product = pairs.fold(zero, |sum, (a, b)| a.multiply_add(*b, sum));
        }
        products
    });
    (0..count).map(move |own| factors.dual(own, gradients, count))
}

/// Factors of a matrix with a row for each surface, which are few most of the time.
pub(super) enum Factors<T, const K: usize> {
    One(T),
    Few(Regular<T, FEW>),
    All(Regular<T, K>),
}

impl<T: Real, const K: usize> Factors<T, K> {
    /// Of so many rows and columns.
    pub(super) fn of(count: usize, mut column: impl FnMut(usize) -> Each<T, K>) -> Self {
        match count {
            1 => {
                let alone = column(0)[0];
                Self::One(match alone.magnitude() {
                    // Where nothing jumps any more there is no mean.
                    0.0 => T::from_f64(0.0),
                    _ => T::from_f64(1.0) / alone,
                })
            }
            ..=FEW => Self::Few(Regular::new(square(count, column))),
            _ => Self::All(Regular::new(square(count, column))),
        }
    }

    /// The sum of so many vectors, one for each row, by a column of the inverse.
    fn dual<const N: usize>(
        &self,
        column: usize,
        vectors: &Each<SVector<T, N>, K>,
        count: usize,
    ) -> SVector<T, N> {
        let zero = T::from_f64(0.0);
        let mut right = Each::all(zero);
        right[column] = T::from_f64(1.0);
        let parts = self.solve(right);
        let terms = vectors.iter().zip(&parts).take(count);
        terms.fold(SVector::from_element(zero), |sum, (vector, part)| {
            sum + vector.map(|it| *part * it)
        })
    }

    pub(super) fn solve(&self, mut right: Each<T, K>) -> Each<T, K> {
        match self {
            Self::One(reciprocal) => {
                right[0] = *reciprocal * right[0];
                right
            }
            Self::Few(factors) => {
                let mut few = SVector::<T, FEW>::from_element(T::from_f64(0.0));
                for (few, right) in few.iter_mut().zip(&right) {
                    *few = *right;
                }
                for (right, few) in right.iter_mut().zip(&factors.solution(&few)) {
                    *right = *few;
                }
                right
            }
            Self::All(factors) => {
                let all = factors.solution(&SVector::from_fn(|row, _| right[row]));
                Each::of(|row| all[row])
            }
        }
    }
}

/// A matrix of so many rows and columns, in one that leaves all others as they are.
fn square<T: Real, const K: usize, const R: usize>(
    count: usize,
    mut column: impl FnMut(usize) -> Each<T, K>,
) -> SMatrix<T, R, R> {
    let mut matrix =
        SMatrix::<T, R, R>::from_fn(|row, own| T::from_f64(if row == own { 1.0 } else { 0.0 }));
    for (own, mut all) in matrix.column_iter_mut().enumerate().take(count) {
        for (known, by) in all.iter_mut().zip(&column(own)).take(count) {
            *known = *by;
        }
    }
    matrix
}
