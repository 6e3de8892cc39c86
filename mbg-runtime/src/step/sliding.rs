//! The laws of a motion that stays where others jump.

use core::cell::Cell;

use nalgebra::{SMatrix, SVector};

use super::seen;
use super::surfaces::{MOST, Surfaces};
use crate::input::quotient;
use crate::solve::Regular;
use crate::{Course, Input, Meta, Power, Real, System, Trouble};

/// So many surfaces are few.
const FEW: usize = 3;
/// How far beside a threshold laws are asked, in units of the rounding of its argument.
const ASIDE: f64 = 64.0;
/// A rate jumps if it differs by more than this part of what it is made of, or so many units of the last place.
const JUMP: f64 = 1e-7;
const JUMP_PLACES: f64 = 64.0;

/// The part of a run, and of a step, over which an input is taken to be smooth.
const SHORT: f64 = 1.0 / 4096.0;
const PART: f64 = 0.25;

/// One for each surface.
type Each<V> = [V; MOST];

/// The laws of a model whose motion stays at thresholds of them: friction that holds, a relay that goes on and off without end.
///
/// On both sides the motion leads to the threshold. Along it goes that mean of both which does not leave it (Filippov,
/// *Differential Equations with Discontinuous Righthand Sides*, Kluwer 1988, §4); along several at once the mean whose parts are
/// found from what each alone makes different (Utkin, *Sliding Modes in Control and Optimization*, Springer 1992, §2).
pub(super) struct Sliding<'a, T, S, I: ?Sized, const N: usize> {
    system: &'a S,
    input: &'a I,
    since: T,
    /// For how long the input is smooth, about.
    ahead: Cell<f64>,
    pub(super) surfaces: Surfaces<T>,
    /// How states change that go across each surface, at a rate of one, and along the others.
    across: Each<SVector<T, N>>,
    /// How the argument of each changes with the states, where the motion has come to.
    gradients: Cell<Each<SVector<T, N>>>,
    /// How often the model was evaluated, but for once in each evaluation of these laws.
    pub(super) evaluations: Cell<u64>,
}

/// What a model says on the sides of surfaces.
pub(super) struct Sides<T, const N: usize> {
    /// A state below all surfaces, and for each one that is above it alone.
    states: [SVector<T, N>; 1 + MOST],
    /// The derivative below all, and how much more it is above each.
    base: SVector<T, N>,
    jumps: Each<SVector<T, N>>,
    /// How much faster the argument of each surface goes above each.
    rates: Factors<T>,
    /// Whether its own argument goes slower above each.
    leads_back: Each<bool>,
    /// Which part of the mean is above each.
    parts: Each<T>,
}

/// Factors of a matrix with a row for each surface, which are few most of the time.
enum Factors<T> {
    One(T),
    Few(Regular<T, FEW>),
    All(Regular<T, MOST>),
}

impl<T: Real> Factors<T> {
    /// Of the first rows and columns.
    fn of(matrix: &SMatrix<T, MOST, MOST>, count: usize) -> Self {
        match count {
            1 => Self::One(T::from_f64(1.0) / matrix[(0, 0)]),
            ..=FEW => Self::Few(Regular::new(part(matrix, count))),
            _ => Self::All(Regular::new(part(matrix, count))),
        }
    }

    fn solve(&self, mut right: Each<T>) -> Each<T> {
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

impl<T: Real, const N: usize> Sides<T, N> {
    fn derivative(&self) -> SVector<T, N> {
        let mut derivative = self.base;
        for (jump, part) in self.jumps.iter().zip(&self.parts) {
            derivative += jump.map(|jump| *part * jump);
        }
        derivative
    }

    /// The mean of what there is on the sides of so many surfaces.
    fn mean<const R: usize, const C: usize>(
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

    /// How far beyond all means of both sides the motion along a surface would be.
    fn beyond(&self, place: usize) -> f64 {
        let part = seen(self.parts[place]);
        if self.leads_back[place] {
            (-part).max(part - 1.0).max(0.0)
        } else {
            f64::INFINITY
        }
    }

    /// How states change that go across each surface alone.
    fn across(&self, count: usize) -> Each<SVector<T, N>> {
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

impl<'a, T: Real, S, I: ?Sized, const N: usize> Sliding<'a, T, S, I, N> {
    /// The laws along those of some surfaces, next to a state, which the motion does not leave; with the state put on these and
    /// beside the others, on the side to which it goes. None where it leaves all.
    pub(super) fn settled<const M: usize, const P: usize>(
        (system, input): (&'a S, &'a I),
        (since, whole): (T, f64),
        (t, x): (T, &mut SVector<T, N>),
        surfaces: Surfaces<T>,
        memory: &mut S::Memory,
    ) -> Option<Self>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let none = [SVector::from_element(T::from_f64(0.0)); MOST];
        let mut sliding = Self {
            system,
            input,
            since,
            ahead: Cell::new(whole * SHORT),
            surfaces,
            across: none,
            gradients: Cell::new(none),
            evaluations: Cell::new(0),
        };
        let u = input.value(t, since);
        while sliding.surfaces.count() > 0 {
            let count = sliding.surfaces.count();
            sliding.look(t, x, &u, memory);
            sliding.across = shortest(&sliding.gradients.get(), count);
            let sides = sliding.sides((t, x, &u), memory);
            let distances = (0..count).map(|place| (place, sides.beyond(place)));
            let farthest = distances.reduce(|a, b| if b.1 > a.1 { b } else { a });
            let (place, distance) = farthest.unwrap_or((0, 0.0));
            if distance == 0.0 {
                // As a motion comes there: what it would be late by changes its slopes along this way.
                sliding.across = sides.across(count);
                *x = sliding.onto(t, *x, &u, memory);
                return Some(sliding);
            }
            if distance.is_finite() {
                let is_below = distance == -seen(sides.parts[place]);
                let side = T::from_f64(if is_below { -1.0 } else { 1.0 });
                let aside = sliding.aside(x)[place];
                let beyond = side * sliding.distances((t, x, &u), memory).0[place];
                // What is farther away has yet to come there.
                if beyond.magnitude() < aside.magnitude() {
                    let way = side * (aside - beyond);
                    *x += sliding.across[place].map(|across| way * across);
                }
            }
            sliding.surfaces.leave(place);
        }
        None
    }

    /// The state on the surfaces next to one.
    pub(super) fn landed<const M: usize, const P: usize>(
        &self,
        t: T,
        x: SVector<T, N>,
        memory: &S::Memory,
    ) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.onto(t, x, &self.input.value(t, self.since), memory)
    }

    /// Minds how long a step was.
    pub(super) fn heed(&self, length: f64) {
        self.ahead.set(PART * length);
    }

    /// How far the motion is from leaving a surface, as a part of what the laws differ by there; not positive where it leaves one.
    pub(super) fn hold<const M: usize, const P: usize>(
        &self,
        t: T,
        x: &SVector<T, N>,
        memory: &mut S::Memory,
    ) -> T
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let u = self.input.value(t, self.since);
        let sides = self.sides((t, x, &u), memory);
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        let parts = sides.parts.iter().take(self.surfaces.count());
        let least = parts.fold(one, |least, part| least.min(*part).min(one - *part));
        // What is left on purpose a little late is left for good.
        let late = T::from_f64(T::SINGULAR);
        match sides
            .leads_back
            .iter()
            .take(self.surfaces.count())
            .all(|it| *it)
        {
            true => least + late,
            false => zero,
        }
    }

    /// The arguments of all surfaces, beyond these, and how fast they change, at two states that change so.
    fn told<const M: usize, const P: usize>(
        &self,
        (t, u): (T, &SVector<T, M>),
        places: [(&SVector<T, N>, &SVector<T, N>); 2],
        memory: &S::Memory,
    ) -> [[Each<T>; 2]; 2]
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let mut told = [[[T::from_f64(0.0); MOST]; 2]; 2];
        let (mut number, mut memory) = (0, *memory);
        let rates = self.input_rate(t);
        let [from, to] = places.map(|(x, slope)| (t, [x, slope], [u, &rates]));
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

    /// How fast the input changes.
    fn input_rate<const M: usize>(&self, t: T) -> SVector<T, M>
    where
        I: Input<T, M>,
    {
        if self.input.is_constant_between_jumps() {
            return SVector::from_element(T::from_f64(0.0));
        }
        let ahead = T::from_f64(self.ahead.get());
        self.input.rate(t, self.since, ahead)
    }

    /// How the argument of each surface changes with each state here.
    fn look<const M: usize, const P: usize>(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &S::Memory,
    ) where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut gradients = self.gradients.get();
        for state in 0..N {
            let mut unit = rest;
            unit[state] = T::from_f64(1.0);
            let [[_, at_rest], [_, rates]] = self.told((t, u), [(x, &rest), (x, &unit)], memory);
            for (gradient, (rate, own)) in gradients.iter_mut().zip(rates.iter().zip(&at_rest)) {
                gradient[state] = *rate - *own;
            }
        }
        self.gradients.set(gradients);
    }

    /// How far from each surface its argument is surely beyond it.
    fn aside(&self, x: &SVector<T, N>) -> Each<T> {
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
    fn distances<const M: usize, const P: usize>(
        &self,
        (t, x, u): (T, &SVector<T, N>, &SVector<T, M>),
        memory: &S::Memory,
    ) -> (Each<T>, Factors<T>)
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let rest = SVector::from_element(T::from_f64(0.0));
        let mut distances = [T::from_f64(0.0); MOST];
        let mut rates = SMatrix::from_element(T::from_f64(0.0));
        let count = self.surfaces.count();
        for (own, across) in self.across.iter().take(count).enumerate() {
            let [[_, at_rest], [there, faster]] =
                self.told((t, u), [(x, &rest), (x, across)], memory);
            distances = there;
            for other in 0..count {
                rates[(other, own)] = faster[other] - at_rest[other];
            }
        }
        (distances, Factors::of(&rates, count))
    }

    /// A state moved across the surfaces.
    fn moved(&self, x: &SVector<T, N>, ways: Each<T>) -> SVector<T, N> {
        let mut moved = *x;
        for (across, way) in self.across.iter().zip(&ways) {
            moved += across.map(|across| *way * across);
        }
        moved
    }

    /// The state on the surfaces next to one.
    fn onto<const M: usize, const P: usize>(
        &self,
        t: T,
        x: SVector<T, N>,
        u: &SVector<T, M>,
        memory: &S::Memory,
    ) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let (distances, rates) = self.distances((t, &x, u), memory);
        self.moved(&x, rates.solve(distances.map(|it| -it)))
    }

    /// What the model says on the sides of the surfaces.
    fn sides<const M: usize, const P: usize>(
        &self,
        (t, x, u): (T, &SVector<T, N>, &SVector<T, M>),
        memory: &mut S::Memory,
    ) -> Sides<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let [zero, two] = [0.0, 2.0].map(T::from_f64);
        let count = self.surfaces.count();
        let (distances, moves) = self.distances((t, x, u), memory);
        let aside = self.aside(x);
        let mut states = [*x; 1 + MOST];
        let down = core::array::from_fn(|place| match place < count {
            true => -(aside[place] + distances[place]),
            false => zero,
        });
        states[0] = self.moved(x, moves.solve(down));
        let base = self.system.derivative(t, &states[0], u, memory);
        let mut jumps = [SVector::from_element(zero); MOST];
        let mut rates = SMatrix::from_element(zero);
        let mut right = [zero; MOST];
        let mut leads_back = [false; MOST];
        let jump = JUMP.max(JUMP_PLACES * T::EPSILON);
        let gradients = self.gradients.get();
        for own in 0..count {
            let mut up = [zero; MOST];
            up[own] = two * aside[own];
            let above = self.moved(&states[0], moves.solve(up));
            let slope = self.system.derivative(t, &above, u, memory);
            let [[_, below], [_, faster]] =
                self.told((t, u), [(&states[0], &base), (&above, &slope)], memory);
            jumps[own] = slope - base;
            for other in 0..count {
                rates[(other, own)] = faster[other] - below[other];
                right[other] = -below[other];
            }
            let terms = gradients[own].iter().zip(base.iter().zip(&slope));
            let size = terms.fold(0.0, |size, (by, (a, b))| {
                size + by.magnitude() * (a.magnitude() + b.magnitude())
            });
            leads_back[own] = seen(rates[(own, own)]) < -jump * size;
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
            parts,
        }
    }
}

/// The outputs of a model next to thresholds at which its motion stays.
pub(super) fn output_along<T, S, I, const N: usize, const M: usize, const P: usize>(
    (system, input): (&S, &I),
    (t, whole): (T, f64),
    x: &SVector<T, N>,
    (surfaces, memory): (Surfaces<T>, &mut S::Memory),
) -> SVector<T, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    let (mut x, u) = (*x, input.at(t));
    match Sliding::settled((system, input), (t, whole), (t, &mut x), surfaces, memory) {
        Some(sliding) => sliding.output(t, &x, &u, memory),
        None => system.output(t, &x, &u, memory),
    }
}

/// The shortest ways across surfaces of these gradients, each along the others.
fn shortest<T: Real, const N: usize>(
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

impl<T, S, I, const N: usize, const M: usize, const P: usize> System<T, N, M, P>
    for Sliding<'_, T, S, I, N>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    const META: &'static Meta = S::META;
    const AUTONOMOUS: bool = S::AUTONOMOUS;
    const SEEKS_CHANGES: bool = S::SEEKS_CHANGES;
    const HAS_COURSES: bool = true;

    type Memory = S::Memory;
    type Conditioning = S::Conditioning;

    fn initial_state(&self) -> SVector<T, N> {
        self.system.initial_state()
    }

    fn derivative(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SVector<T, N> {
        let derivative = self.sides((t, x, u), memory).derivative();
        self.evaluations.set(self.evaluations.get() - 1);
        derivative
    }

    fn output(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SVector<T, P> {
        let sides = self.sides((t, x, u), memory);
        sides.mean(self.surfaces.count(), |x| {
            self.system.output(t, x, u, memory)
        })
    }

    fn jacobian_state(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SMatrix<T, N, N> {
        let mut jacobian = self.along((t, x, u), memory, |x, memory| {
            self.system.jacobian_state(t, x, u, memory)
        });
        // The model is asked on the surfaces, wherever beside them the state is.
        for (across, gradient) in self.across.iter().zip(&self.gradients.get()) {
            let zero = SVector::from_element(T::from_f64(0.0));
            let columns = jacobian.column_iter().zip(across);
            let change = columns.fold(zero, |sum: SVector<T, N>, (column, way)| {
                sum.zip_map(&column, |sum, column| way.multiply_add(column, sum))
            });
            for (mut column, by) in jacobian.column_iter_mut().zip(gradient) {
                column.zip_apply(&change, |column, change| *column -= *by * change);
            }
        }
        jacobian
    }

    fn jacobian_input(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SMatrix<T, N, M> {
        self.along((t, x, u), memory, |x, memory| {
            self.system.jacobian_input(t, x, u, memory)
        })
    }

    /// With how fast the input goes, which the mean follows.
    fn derivative_time(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
        ahead: T,
    ) -> SVector<T, N> {
        if self.input.is_constant_between_jumps() {
            if S::AUTONOMOUS {
                return SVector::from_element(T::from_f64(0.0));
            }
            return quotient(t, ahead, |t| self.sides((t, x, u), memory).derivative());
        }
        let mut change = quotient(t, ahead, |t| {
            let u = self.input.value(t, self.since);
            self.sides((t, x, &u), memory).derivative()
        });
        // What the input itself changes is added to it.
        let rate = self.input.rate(t, self.since, ahead);
        let by_input = System::jacobian_input(self, t, x, u, memory);
        for (rate, column) in rate.iter().zip(by_input.column_iter()) {
            change.zip_apply(&column, |change, by| *change -= by * *rate);
        }
        change
    }

    fn energy(&self, t: T, x: &SVector<T, N>) -> T {
        self.system.energy(t, x)
    }

    fn power(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> Power<T> {
        self.system.power(t, x, u, memory)
    }

    fn next_change(&self, t: T) -> Option<T> {
        self.system.next_change(t)
    }

    fn change_between(&self, from: T, to: T, input: impl Fn(T) -> SVector<T, M>) -> Option<T> {
        self.system.change_between(from, to, input)
    }

    /// Of an argument that stays no more is told than that there is one.
    fn courses(
        &self,
        from: (T, [&SVector<T, N>; 2], [&SVector<T, M>; 2]),
        to: (T, [&SVector<T, N>; 2], [&SVector<T, M>; 2]),
        memory: &mut S::Memory,
        mut each: impl FnMut(Course<'_, T>),
    ) {
        let mut number = 0;
        self.system.courses(from, to, memory, |course| {
            let stays = self.surfaces.of(number).is_some();
            let thresholds = if stays { &[] } else { course.thresholds };
            each(Course {
                thresholds,
                ..course
            });
            number += 1;
        });
    }

    fn conditioning(&self, t: T, x: &SVector<T, N>, u: &SVector<T, M>) -> S::Conditioning {
        self.system.conditioning(t, x, u)
    }

    fn trouble(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &S::Memory,
    ) -> Option<Trouble> {
        self.system.trouble(t, x, u, memory)
    }

    fn close(
        &self,
        t: T,
        x: SVector<T, N>,
        u: &SVector<T, M>,
        fixed: &[usize],
    ) -> Result<SVector<T, N>, Trouble> {
        let closed = self.system.close(t, x, u, fixed)?;
        let memory = S::Memory::default();
        self.look(t, &closed, u, &memory);
        Ok(self.onto(t, closed, u, &memory))
    }
}

impl<T: Real, S, I: ?Sized, const N: usize> Sliding<'_, T, S, I, N> {
    /// A Jacobian along the surfaces, from those on their sides: what would lead away from a surface is taken up by its part of the
    /// mean. How arguments bend is left out.
    fn along<const M: usize, const P: usize, const C: usize>(
        &self,
        (t, x, u): (T, &SVector<T, N>, &SVector<T, M>),
        memory: &mut S::Memory,
        mut of: impl FnMut(&SVector<T, N>, &mut S::Memory) -> SMatrix<T, N, C>,
    ) -> SMatrix<T, N, C>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let count = self.surfaces.count();
        let sides = self.sides((t, x, u), memory);
        let mut jacobian = sides.mean(count, |x| of(x, memory));
        let gradients = self.gradients.get();
        for mut column in jacobian.column_iter_mut() {
            let zero = T::from_f64(0.0);
            let mut away = [zero; MOST];
            for (away, gradient) in away.iter_mut().zip(&gradients).take(count) {
                let pairs = gradient.iter().zip(column.iter());
                *away = pairs.fold(zero, |sum, (by, change)| by.multiply_add(*change, sum));
            }
            for (jump, part) in sides.jumps.iter().zip(&sides.rates.solve(away)) {
                column -= jump.map(|jump| *part * jump);
            }
        }
        jacobian
    }
}
