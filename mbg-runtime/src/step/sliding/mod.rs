//! The laws of a motion that stays where others jump.

mod sides;
mod system;

use core::cell::Cell;

use nalgebra::SVector;

use super::seen;
use super::surfaces::{MOST, Surfaces};
use crate::{Course, Input, Real, System};
use sides::shortest;

/// The part of a run, and of a step, over which an input is taken to be smooth.
const SHORT: f64 = 1.0 / 4096.0;
const PART: f64 = 0.25;

/// What does not stay is put so many times as far beside a surface as those that do are asked.
const BESIDE: f64 = 4.0;
/// So many times as far beside a surface a law is asked whether it jumps there.
const WIDE: f64 = 1024.0;

/// Gradients depend on each other if no more of one is beside the others than so many units of its last place.
const DEPENDENT: f64 = 4096.0;

/// One for each surface.
type Each<V> = [V; MOST];
/// Surfaces on which a motion is by others, and how far from each it may be by rounding.
type Along<T> = (Surfaces<T>, Each<T>);

/// The laws of a model whose motion stays at thresholds of them: friction that holds, a relay that goes on and off without end.
///
/// On both sides the motion leads to the threshold. Along it goes that mean of both which does not leave it (Filippov,
/// *Differential Equations with Discontinuous Righthand Sides*, Kluwer 1988, §4); along several at once the mean whose parts are
/// found from what each alone makes different (Utkin, *Sliding Modes in Control and Optimization*, Springer 1992, §2).
pub(super) struct Sliding<'a, T, S, I: ?Sized, const N: usize> {
    system: &'a S,
    input: &'a I,
    since: T,
    /// Between which times laws are those of the present piece.
    inside: (T, T),
    /// For how long the input is smooth, about.
    ahead: Cell<f64>,
    pub(super) surfaces: Surfaces<T>,
    /// Others on which the motion is wherever it is on these.
    along: Along<T>,
    /// How states change that go across each surface, at a rate of one, and along the others.
    across: Each<SVector<T, N>>,
    /// How the argument of each changes with the states, where the motion has come to.
    gradients: Cell<Each<SVector<T, N>>>,
    /// How often the model was evaluated, but for once in each evaluation of these laws.
    pub(super) evaluations: Cell<u64>,
}

/// On which side of a surface a motion goes on.
#[derive(Clone, Copy)]
enum Aside {
    /// It stays on it.
    On,
    /// On the side on which it is.
    Passed,
    Below,
    Above,
}

/// A time with the input, and how fast that changes.
struct Moment<T, const M: usize> {
    time: T,
    input: SVector<T, M>,
    rate: SVector<T, M>,
}

impl<'a, T: Real, S, I: ?Sized, const N: usize> Sliding<'a, T, S, I, N> {
    /// The laws along those of some surfaces, next to a state, which the motion does not leave; with the state put on these and
    /// beside the others, on the side to which it goes. None where it leaves all. Counts evaluations of the model.
    pub(super) fn settled<const M: usize, const P: usize>(
        model: (&'a S, &'a I),
        times: (T, (T, T), f64),
        (t, x): (T, &mut SVector<T, N>),
        surfaces: Surfaces<T>,
        (memory, evaluations): (&mut S::Memory, &mut u64),
    ) -> Option<Self>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let mut settled = |x: &mut SVector<T, N>, surfaces| {
            let known = (&mut *memory, &mut *evaluations);
            Self::settled_among(model, times, (t, x), surfaces, known)
        };
        let start = *x;
        let among_all = settled(x, surfaces);
        if among_all.is_some() || surfaces.count() < 2 {
            return among_all;
        }
        // What surfaces make different that are almost along each other cannot be told apart, and which of those that depend on each
        // other hold is not known: each of them may be the one that is left first, or does not count.
        let count = surfaces.count();
        let turned = (1..count).map(|by| surfaces.turned(by));
        let mut others = turned.chain(surfaces.iter().map(|surface| Surfaces::one(*surface)));
        others.find_map(|surfaces| {
            let mut there = start;
            settled(&mut there, surfaces).inspect(|_| *x = there)
        })
    }

    /// The same where the surface is left first along which the motion would be farthest beyond the means of both sides.
    fn settled_among<const M: usize, const P: usize>(
        (system, input): (&'a S, &'a I),
        (since, inside, whole): (T, (T, T), f64),
        (t, x): (T, &mut SVector<T, N>),
        surfaces: Surfaces<T>,
        (memory, evaluations): (&mut S::Memory, &mut u64),
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
            inside,
            ahead: Cell::new(whole * SHORT),
            surfaces,
            along: (Surfaces::NONE, [T::from_f64(0.0); MOST]),
            across: none,
            gradients: Cell::new(none),
            evaluations: Cell::new(0),
        };
        let at = sliding.on_piece(t);
        sliding.look(&at, x, memory);
        if let Some((surfaces, along)) = sliding.dependent(x) {
            let known = (memory, evaluations);
            let model = (system, input);
            let times = (since, inside, whole);
            let settled = Self::settled_among(model, times, (t, x), surfaces, known);
            // Others are as these are only where it stays on all of these.
            let settled = settled.filter(|settled| settled.surfaces == surfaces);
            return settled.map(|settled| Self { along, ..settled });
        }
        let gradients = sliding.gradients.get();
        // To each surface and along all others.
        let ways = shortest(&gradients, surfaces.count());
        let mut asides = [Aside::On; MOST];
        while sliding.surfaces.count() > 0 {
            let count = sliding.surfaces.count();
            sliding.look(&at, x, memory);
            sliding.across = shortest(&sliding.gradients.get(), count);
            let sides = sliding.sides(&at, (x, 1.0), memory);
            let wide = sliding.sides(&at, (x, WIDE), memory);
            *evaluations += sliding.evaluations.take();
            // Where a law bends and does not jump, parts of a mean have no meaning, nor have those of others beside it. At rest all
            // that it makes different is as small as how far beside it is.
            let jumps =
                |place: &usize| sides.leads_back[*place] && !wide.bends(&sides, *place, WIDE);
            for place in (0..count).rev().filter(|place| !jumps(place)) {
                sliding.leave(place, (&surfaces, &mut asides), Aside::Passed);
            }
            if sliding.surfaces.count() < count {
                continue;
            }
            let distances = (0..count).map(|place| (place, sides.beyond(place)));
            let farthest = distances.reduce(|a, b| if b.1 > a.1 { b } else { a });
            let (place, distance) = farthest.unwrap_or((0, 0.0));
            if distance == 0.0 {
                // As a motion comes there: what it would be late by changes its slopes along this way.
                sliding.across = sides.across(count);
                *x = sliding.onto(&at, x, memory);
                break;
            }
            let aside = match distance == -seen(sides.parts[place]) {
                true => Aside::Below,
                false => Aside::Above,
            };
            sliding.leave(place, (&surfaces, &mut asides), aside);
        }
        let stays = sliding.surfaces.count() > 0;
        let left = Self {
            surfaces,
            along: sliding.along,
            across: ways,
            gradients: Cell::new(gradients),
            ahead: Cell::new(sliding.ahead.get()),
            evaluations: Cell::new(0),
            ..sliding
        };
        *x = left.put_aside((&at, x), (&asides, stays), memory);
        stays.then_some(sliding)
    }

    /// Surfaces that do not depend on each other, and those on which the motion is wherever it is on these; if there are such.
    fn dependent(&self, x: &SVector<T, N>) -> Option<(Surfaces<T>, Along<T>)> {
        let gradients = self.gradients.get();
        let aside = self.aside(x);
        let mut basis = [SVector::<f64, N>::zeros(); MOST];
        let (mut own, mut along) = (Surfaces::NONE, Surfaces::NONE);
        let mut apart = [T::from_f64(0.0); MOST];
        for (place, surface) in self.surfaces.iter().enumerate() {
            let gradient = gradients[place].map(seen);
            let mut rest = gradient / gradient.norm();
            for known in basis.iter().take(own.count()) {
                rest -= known * known.dot(&rest);
            }
            let left = rest.norm();
            if left < DEPENDENT * T::EPSILON {
                apart[along.count()] = T::from_f64(BESIDE) * aside[place];
                along.add(*surface);
            } else {
                basis[own.count()] = rest / left;
                own.add(*surface);
            }
        }
        (along.count() > 0).then_some((own, (along, apart)))
    }

    /// Whether an argument is at its threshold because others are.
    fn is_along(&self, number: usize, course: &Course<'_, T>) -> bool {
        let (along, apart) = &self.along;
        along.of(number).is_some_and(|(place, level)| {
            let mut values = [course.from[0], course.to[0]].into_iter();
            values.all(|it| (it - level).magnitude() <= seen(apart[place]))
        })
    }

    /// Leaves a surface, which is one of all.
    fn leave(
        &mut self,
        place: usize,
        (all, asides): (&Surfaces<T>, &mut Each<Aside>),
        aside: Aside,
    ) {
        let left = self.surfaces.leave(place);
        if let Some((own, _)) = left.and_then(|left| all.of(left.course)) {
            asides[own] = aside;
        }
    }

    /// The state surely beside what the motion does not stay at, if it is not farther away: that it has yet to come to. What is
    /// passed is in the way where the motion stays at another one, as laws are asked a little off it.
    fn put_aside<const M: usize, const P: usize>(
        &self,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        (asides, stays): (&Each<Aside>, bool),
        memory: &S::Memory,
    ) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let distances = self.distances(at, x, memory).0;
        let mut ways = self.aside(x);
        for (way, (aside, distance)) in ways.iter_mut().zip(asides.iter().zip(distances)) {
            let side = match aside {
                Aside::Below => -1.0,
                Aside::Above => 1.0,
                Aside::Passed if stays && seen(distance) != 0.0 => seen(distance).signum(),
                _ => 0.0,
            };
            let side = T::from_f64(side);
            let beyond = side * distance;
            let least = T::from_f64(BESIDE) * *way;
            let is_near = beyond.magnitude() < least.magnitude();
            *way = side
                * (if is_near {
                    least - beyond
                } else {
                    T::from_f64(0.0)
                });
        }
        // Surfaces along each other have no ways of their own.
        let moved = self.moved(x, ways);
        match moved.iter().all(|it| it.magnitude().is_finite()) {
            true => moved,
            false => *x,
        }
    }

    /// The state on the surfaces next to one.
    pub(super) fn landed<const M: usize, const P: usize>(
        &self,
        t: T,
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.onto(&self.on_piece(t), x, memory)
    }

    /// The nearest time on the present piece.
    fn on_piece<const M: usize>(&self, t: T) -> Moment<T, M>
    where
        I: Input<T, M>,
    {
        let time = t.max(self.inside.0).min(self.inside.1);
        self.moment(time, self.input.value(time, self.since))
    }

    /// A time with this input.
    fn moment<const M: usize>(&self, time: T, input: SVector<T, M>) -> Moment<T, M>
    where
        I: Input<T, M>,
    {
        let rate = if self.input.is_constant_between_jumps() {
            SVector::from_element(T::from_f64(0.0))
        } else {
            let ahead = T::from_f64(self.ahead.get());
            self.input.rate(time, self.since, ahead)
        };
        Moment { time, input, rate }
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
        let sides = self.sides(&self.on_piece(t), (x, 1.0), memory);
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
    let times = (t, (t, t), whole);
    let known = (&mut *memory, &mut 0);
    match Sliding::settled((system, input), times, (t, &mut x), surfaces, known) {
        Some(sliding) => sliding.output(t, &x, &u, memory),
        None => system.output(t, &x, &u, memory),
    }
}
