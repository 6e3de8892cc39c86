//! Which laws hold next to thresholds.

use nalgebra::SVector;

use super::super::seen;
use super::super::surfaces::{AnySurfaces, Surface, Surfaces};
use super::super::thresholds::Point;
use super::super::tolerance::Measure;
use super::choice::Choice;
use super::line::{ASIDE, Beyond};
use super::sides::{Sides, shortest};
use super::{Along, Each, Like, Moment, Sliding};
use crate::lane::{dot, is_finite, lane, larger, length, smaller};
use crate::{Input, Real, System};

/// Times are apart by so many units of the last place.
const PLACES: f64 = 8.0;
/// What does not stay is put so many times as far beside a surface as those that do are asked.
const BESIDE: f64 = 4.0;
/// So many times as much as they are unlike twins may become so.
const GROWS: f64 = 4.0;
/// A state is next to a surface where digits beyond half of those that numbers have are surely beside it, but for this part.
const NEAR: f64 = 1e-3;
/// So it is where it comes there within so many units of the last place of the time.
const MOMENT: f64 = 1024.0;
/// So many times as far beside a surface a law is asked whether it jumps there.
const WIDE: f64 = 1024.0;
/// Gradients depend on each other if no more of one is beside the others than so many units of its last place.
const DEPENDENT: f64 = 1_048_576.0;

/// Steps that are held up beside a threshold are no farther from it than so many times the tolerance: as far as errors make up for
/// what is not stable any more.
const HELD_UP: f64 = 16.0;
/// What a law differs by on both sides of a threshold grows so with their distance where it is a root of that at least, in units of
/// what tells that it bends.
const ROOT: f64 = 16.0;
/// What comes to rest as roots do takes so much longer as it would at the rate that it has.
const SLOWER: f64 = 2.0;

/// Where a motion comes to rest.
pub(in super::super) struct Rest<T, Surfaces, const N: usize> {
    pub(in super::super) state: SVector<T, N>,
    pub(in super::super) surfaces: Surfaces,
    /// How long it takes until then.
    pub(in super::super) ahead: f64,
}

/// How a motion goes on at each of some surfaces.
#[derive(Clone, Copy)]
enum Aside {
    /// It stays on it.
    On,
    /// Nothing leads back to it: it goes on over it, at this rate.
    Passed(f64),
    /// To this side, below or above, at this rate.
    Left(f64, f64),
}

/// Surfaces of which a motion has left some, and the state there before it was put aside, so far.
struct Left<T: Real, const N: usize, const K: usize> {
    from: SVector<T, N>,
    all: (Surfaces<T, K>, Along<T, K>),
    asides: Each<Aside, K>,
    reach: T::Lane,
}

/// What is found of a motion next to surfaces.
#[derive(Clone, Copy, PartialEq)]
enum Found {
    Stays,
    /// It goes away from all.
    Leaves,
    Nothing,
}

impl<'a, T: Real, S, I: ?Sized, const N: usize, const K: usize> Sliding<'a, T, S, I, N, K> {
    /// The laws along those of some surfaces, next to a state, which the motion does not leave; with the state put on these and
    /// beside the others, on the side to which it goes. None where it leaves all. Counts evaluations of the model.
    pub(in super::super) fn settled<const M: usize, const P: usize>(
        (system, input): (&'a S, &'a I),
        (since, inside, whole): (T, (T, T), f64),
        (t, x): (T, &mut SVector<T, N>),
        surfaces: Surfaces<T, K>,
        (memory, evaluations): (&mut S::Memory, &mut u64),
    ) -> Option<Self>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let mut sliding = Self::of((system, input), (since, inside, whole), surfaces);
        let at = sliding.on_piece(t);
        let start = *x;
        let near = sliding.near((&at, whole), x, memory);
        sliding.arrange(near, (&at, x), memory);
        let all = sliding.all();
        match sliding.search((&at, x), (&mut *memory, &mut *evaluations)) {
            Found::Stays => return Some(sliding),
            Found::Leaves => {
                // What is led almost alike may be met as soon as these are left.
                let others = surfaces.without(all.as_slice());
                let model = (system, input);
                let (times, known) = ((since, inside, whole), (memory, evaluations));
                return match others.count() < surfaces.count() && others.count() > 0 {
                    true => Self::settled(model, times, (t, x), others, known),
                    false => None,
                };
            }
            Found::Nothing => {}
        }
        // A law that jumps on one side of a threshold alone, which is passed, does so where that is beside the others.
        let mut others = all.iter().filter(|_| all.count() > 1);
        let stays = others.any(|passed| {
            let mut there = start;
            sliding.arrange(all, (&at, &there), memory);
            sliding.pass(passed, (&at, &mut there), memory);
            let found = sliding.search((&at, &mut there), (&mut *memory, &mut *evaluations));
            let stays = found == Found::Stays;
            *x = if stays { there } else { *x };
            stays
        });
        stays.then_some(sliding)
    }

    /// Those of some surfaces that are no farther from a state than errors may be, if the motion stays at them and laws do not
    /// jump there.
    pub(in super::super) fn rest<const M: usize, const P: usize>(
        model: (&'a S, &'a I),
        times: (T, (T, T), f64),
        here: &Point<T, N>,
        (surfaces, measure): (&[Surface<T>], &Measure<N>),
        (memory, evaluations): (&mut S::Memory, &mut u64),
    ) -> Option<Rest<T, Surfaces<T, K>, N>>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let x = &here.state;
        let is_near = |there: &SVector<T, N>| measure.norm(&(there - x)) <= HELD_UP;
        let mut sliding = Self::of(model, times, Surfaces::none());
        let at = sliding.on_piece(here.time);
        let mut near = Surfaces::none();
        let mut ahead = 0.0_f64;
        for surface in surfaces {
            sliding.arrange(Surfaces::one(*surface), (&at, x), memory);
            if is_near(&sliding.onto(&at, x, memory)) {
                near.add(*surface);
                let [[distances, rates], _] = sliding.told(&at, [(x, &here.slope); 2], memory);
                let time = seen(distances[0] / rates[0]).abs();
                ahead = ahead.max(if time.is_finite() { time } else { 0.0 });
            }
        }
        sliding.arrange(near, (&at, x), memory);
        // Twice: rounding is as large as the way is long, and beside what a law is a root of numbers tell far less.
        let mut there = sliding.onto(&at, &sliding.onto(&at, x, memory), memory);
        let place = (here.time, &mut there);
        let sliding = Self::settled(model, times, place, near, (&mut *memory, evaluations))?;
        // Where a law jumps steps end without this.
        let [near, wide] = [1.0, WIDE].map(|factor| sliding.sides(&at, (&there, factor), memory));
        let is_root = (0..sliding.free).all(|place| wide.bends(&near, place, ROOT));
        // As the motion itself comes there.
        let state = sliding.landed(here.time, &sliding.landed(here.time, x, memory), memory);
        (is_root && is_near(&state)).then(|| Rest {
            state,
            surfaces: sliding.all(),
            ahead: SLOWER * ahead,
        })
    }

    /// Whether the motion stays at some of the surfaces, which are then these, with the state put on them, or else beside all that it
    /// leaves.
    fn search<const M: usize, const P: usize>(
        &mut self,
        (at, x): (&Moment<T, M>, &mut SVector<T, N>),
        (memory, evaluations): (&mut S::Memory, &mut u64),
    ) -> Found
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let mut before: Option<Left<T, N, K>> = None;
        // What is left is put aside, and laws there are asked again: they need not be sums of what each makes different.
        while self.surfaces.count() > 0 {
            let sides = self.sides(at, (x, 1.0), memory);
            let wide = self.sides(at, (x, WIDE), memory);
            *evaluations += self.evaluations.take();
            let Some((choices, asides)) = self.choices((&sides, &wide), (at, x), memory) else {
                return Found::Nothing;
            };
            let count = self.surfaces.count();
            let stays = |place: &usize| matches!(asides[*place], Aside::On);
            if (0..count).all(|place| stays(&place)) {
                let above = |place: usize| sides.above(place, choices[place]);
                let sides = match count > self.free {
                    true => {
                        self.free_first(&Each::of(above), (at, x), memory);
                        if let Some(left) = before.take() {
                            self.farther_aside(left, (at, x), memory);
                        }
                        self.sides(at, (x, 1.0), memory)
                    }
                    false => sides,
                };
                *evaluations += self.evaluations.take();
                // As a motion comes there: what it would be late by changes its slopes along this way.
                self.go_across(sides.across(self.free));
                *x = self.onto(at, x, memory);
                return Found::Stays;
            }
            let on = self.only(stays);
            let left = Left {
                from: *x,
                all: (self.surfaces, self.twins),
                asides,
                reach: sides.reach(),
            };
            *x = self.put_aside((at, &left.from), (&left.asides, left.reach), memory);
            if on.count() == 0 {
                self.surfaces = left.all.0;
                let found = self.left((at, x), &left.asides, memory);
                *evaluations += self.evaluations.take();
                return found;
            }
            self.arrange(on, (at, x), memory);
            before = Some(self.farther_aside(left, (at, x), memory));
        }
        Found::Nothing
    }

    /// Puts the state farther beside what was left, if the line along which laws are asked is longer than it was then.
    fn farther_aside<const M: usize, const P: usize>(
        &mut self,
        left: Left<T, N, K>,
        (at, x): (&Moment<T, M>, &mut SVector<T, N>),
        memory: &S::Memory,
    ) -> Left<T, N, K>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let reach = self.line(at, (x, 1.0), memory).reach;
        if reach <= left.reach {
            return left;
        }
        let on = self.all();
        (self.surfaces, self.twins) = left.all;
        *x = self.put_aside((at, &left.from), (&left.asides, reach), memory);
        self.arrange(on, (at, x), memory);
        Left { reach, ..left }
    }

    /// Whether the motion leaves the surfaces to the sides on which it has been put, and goes on over those that it passes.
    fn left<const M: usize, const P: usize>(
        &self,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        asides: &Each<Aside, K>,
        memory: &S::Memory,
    ) -> Found
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let slope = (self.system).derivative(at.time, x, &at.input, &mut { *memory });
        self.evaluations.set(self.evaluations.get() + 1);
        let [[_, rates], _] = self.told(at, [(x, &slope); 2], memory);
        let mut ways = asides.iter().zip(&rates).take(self.surfaces.count());
        match ways.all(|(aside, rate)| match aside {
            Aside::On => false,
            Aside::Left(way, _) | Aside::Passed(way) => way * seen(*rate) >= 0.0,
        }) {
            true => Found::Leaves,
            false => Found::Nothing,
        }
    }

    /// Puts a state beside one of the surfaces, where it is, and goes on without that.
    fn pass<const M: usize, const P: usize>(
        &mut self,
        passed: Surface<T>,
        (at, x): (&Moment<T, M>, &mut SVector<T, N>),
        memory: &S::Memory,
    ) where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let reach = self.line(at, (x, 1.0), memory).reach;
        let rest = self.all().without(&[passed]);
        let mut asides = Each::all(Aside::On);
        if let Some((place, _)) = self.surfaces.of(passed.course) {
            asides[place] = Aside::Passed(0.0);
        }
        *x = self.put_aside((at, x), (&asides, reach), memory);
        self.arrange(rest, (at, x), memory);
    }

    /// Those next to which the state is, as far as numbers tell of it and of the time: what an argument jumps over it is not at, and a
    /// threshold may have jumped away.
    fn near<const M: usize, const P: usize>(
        &self,
        (at, whole): (&Moment<T, M>, f64),
        x: &SVector<T, N>,
        memory: &S::Memory,
    ) -> Surfaces<T, K>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.look(at, x, memory);
        let slope = (self.system).derivative(at.time, x, &at.input, &mut { *memory });
        self.evaluations.set(self.evaluations.get() + 1);
        let aside = self.aside(x);
        let moment = MOMENT * T::EPSILON * at.time.magnitude().max(whole);
        let [one, two, moment] = [1.0, 2.0, moment].map(T::Lane::from_f64);
        let [[distances, rates], _] = self.told(at, [(x, &slope); 2], memory);
        let gradients = self.gradients();
        let (mut span, mut is_near) = (Span::<_, N, K>::of_nothing(), Each::<_, K>::all(false));
        for (place, is_near) in is_near.iter_mut().enumerate().take(self.surfaces.count()) {
            let (mut alone, mut beside) = (one, SVector::from_element(T::Lane::from_f64(0.0)));
            let (unit, distance) = (unit(&gradients[place]), lane(distances[place]));
            let size = length(&gradients[place]);
            if let Some(unit) = unit
                && let Some(rest) = span.add(&unit)
            {
                // What is almost led along others moves states far where it is moved a little.
                alone = length(&rest);
                beside = (unit - rest).map(|it| size * it);
            }
            let near = T::Lane::from_f64(NEAR / T::SINGULAR) * alone;
            let near = larger(near, one) * lane(aside[place]);
            let reaches = |rate: T, slope: &SVector<T, N>| {
                let rate = lane(rate) - dot(&beside, &slope.map(lane));
                distance.abs() < near + moment * rate.abs()
            };
            *is_near = reaches(rates[place], &slope)
                || unit.is_some_and(|unit| {
                    // As fast as on the other side: what comes there fast may be almost held on this one.
                    let way = two * distance / size;
                    let there = x - unit.map(|by| T::from_lane(way * by));
                    let slope =
                        (self.system).derivative(at.time, &there, &at.input, &mut { *memory });
                    self.evaluations.set(self.evaluations.get() + 1);
                    let [[_, rates], _] = self.told(at, [(&there, &slope); 2], memory);
                    reaches(rates[place], &slope)
                });
        }
        self.only(|place| is_near[*place])
    }

    /// Puts surfaces in the order in which they are minded: those that are free first, the first of them first.
    fn arrange<const M: usize, const P: usize>(
        &mut self,
        surfaces: Surfaces<T, K>,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        memory: &S::Memory,
    ) where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.surfaces = surfaces;
        self.look(at, x, memory);
        let gradients = self.gradients();
        let nothing = SVector::from_element(T::Lane::from_f64(0.0));
        let (mut span, mut units) = (Span::<_, N, K>::of_nothing(), Each::<_, K>::all(nothing));
        let [mut free, mut bound, mut twins] = [Surfaces::none(); 3];
        let mut likes = Each::all(Like::NOTHING);
        for (place, surface) in surfaces.iter().enumerate() {
            let Some(unit) = unit(&gradients[place]) else {
                // No state leads there.
                continue;
            };
            let differs = |other: &SVector<T::Lane, N>| {
                smaller(length(&(other - unit)), length(&(other + unit)))
            };
            let leads = |other: &SVector<T::Lane, N>| is_dependent::<T>(differs(other));
            if let Some(leader) = units.iter().take(place).position(leads) {
                let size = |place: usize| length(&gradients[place]).into();
                let unlike: f64 = differs(&units[leader]).into();
                likes[twins.count()] = Like {
                    leader,
                    size: size(place) / size(leader),
                    apart: BESIDE * (1.0 + GROWS * unlike / (ASIDE * T::EPSILON)),
                };
                twins.add(surface);
            } else if span.add(&unit).is_some() {
                free.add(surface);
            } else {
                bound.add(surface);
            }
            units[place] = unit;
        }
        self.free = free.count();
        self.surfaces = free.with(bound.as_slice());
        for like in likes.iter_mut().take(twins.count()) {
            let leader = surfaces.iter().nth(like.leader);
            let place = leader.and_then(|leader| self.surfaces.of(leader.course));
            like.leader = place.map_or(0, |(place, _)| place);
        }
        self.twins = (twins, likes);
        self.look(at, x, memory);
        self.go_across(shortest(&self.gradients(), self.free));
    }

    /// How the motion is at each surface, and how it goes on there.
    fn choices<const M: usize, const P: usize>(
        &self,
        (sides, wide): (&Sides<T, N, K>, &Sides<T, N, K>),
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        memory: &S::Memory,
    ) -> Option<(Each<Choice, K>, Each<Aside, K>)>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let count = self.surfaces.count();
        let distances = self.beyond(at, x, memory).distances;
        // Where a law bends and does not jump, parts of a mean have no meaning, nor have those of others beside it. At rest all
        // that it makes different is as small as how far beside it is.
        let mut known = Each::all(None);
        for place in 0..count {
            let jumps = sides.leads_back[place] && !wide.bends(sides, place, WIDE);
            known[place] = (!jumps).then(|| sides.to_side(place, seen(distances[place])));
        }
        let choices = sides.chosen(&known)?;
        let units = self.gradients().map(|gradient| unit(&gradient));
        let mut span = Span::<_, N, K>::of_nothing();
        for (unit, choice) in units.iter().zip(&choices).take(count) {
            if let (Some(unit), Choice::Stays(_)) = (unit, choice) {
                span.add(unit);
            }
        }
        let asides = Each::of(|place| {
            let stays = matches!(choices[place], Choice::Stays(_))
                || units[place].is_some_and(|unit| span.has(&unit));
            let rate = sides.rate(place, &choices);
            match known.get(place) {
                _ if stays => Aside::On,
                Some(Some(_)) => Aside::Passed(rate),
                _ => Aside::Left(sides.side(place, choices[place]), rate),
            }
        });
        Some((choices, asides))
    }

    /// With those alone at which the motion stays.
    fn only(&self, stays: impl Fn(&usize) -> bool) -> Surfaces<T, K> {
        let mut only = self.twins.0;
        let staying = self.surfaces.iter().enumerate();
        for (_, surface) in staying.filter(|(place, _)| stays(place)) {
            only.add(surface);
        }
        only
    }

    /// The same order but that those are free whose parts are farthest from having been used up.
    fn free_first<const M: usize, const P: usize>(
        &mut self,
        above: &Each<f64, K>,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        memory: &S::Memory,
    ) where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let before = self.surfaces;
        let count = before.count();
        let order = Each::<usize, K>::by(count, |place| -above[place].min(1.0 - above[place]));
        let mut sorted = Surfaces::none();
        for place in order.iter().take(count) {
            if let Some(surface) = before.iter().nth(*place) {
                sorted.add(surface);
            }
        }
        self.arrange(sorted.with(self.twins.0.as_slice()), (at, x), memory);
        for (share, surface) in self.shares.iter_mut().zip(self.surfaces.iter()) {
            if let Some((place, _)) = before.of(surface.course) {
                *share = T::from_f64(above[place]);
            }
        }
    }

    /// The state surely beside what the motion does not stay at, if it is not farther away: that it has yet to come to. What is
    /// passed is in the way where the motion stays at another one, as laws are asked a little off it.
    fn put_aside<const M: usize, const P: usize>(
        &mut self,
        (at, x): (&Moment<T, M>, &SVector<T, N>),
        (asides, reach): (&Each<Aside, K>, T::Lane),
        memory: &S::Memory,
    ) -> SVector<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        // Those at which it stays are to be free of the others, and those that it leaves of what it passes.
        let before = self.surfaces;
        let on = self.only(|place| matches!(asides[*place], Aside::On));
        let left = self.only(|place| matches!(asides[*place], Aside::Left(..)));
        self.arrange(
            on.with(left.as_slice()).with(before.as_slice()),
            (at, x),
            memory,
        );
        let mut sorted = Each::<_, K>::all(Aside::On);
        for (aside, surface) in sorted.iter_mut().zip(self.surfaces.iter()) {
            if let Some((place, _)) = before.of(surface.course) {
                *aside = asides[place];
            }
        }
        let Beyond { distances, rates } = &self.beyond(at, x, memory);
        let aside = self.aside_behind(x, distances);
        let (gradients, mut span) = (self.gradients(), Span::<_, N, K>::of_nothing());
        let [one, beside] = [1.0, BESIDE].map(T::Lane::from_f64);
        let least: Each<T, K> = Each::of(|place| {
            let unit = unit(&gradients[place]).filter(|_| place < self.free);
            let rest = unit.and_then(|unit| span.add(&unit));
            let alone = rest.map_or(one, |rest| length(&rest));
            T::from_lane(beside * reach * alone) * aside[place]
        });
        let mut all = sorted.iter().take(self.free);
        let stays = all.any(|aside| matches!(aside, Aside::On));
        let soon = PLACES * T::EPSILON * at.time.magnitude();
        let ways: Each<T, K> = Each::of(|place| match sorted[place] {
            // What is put on it later is not to move the others any more.
            Aside::On => -distances[place],
            Aside::Left(side, rate) => {
                let (beyond, near) = (side * seen(distances[place]), seen(least[place]));
                // It is not farther away than numbers tell, or times.
                let is_near = match beyond < 0.0 {
                    true => -beyond < near.max(soon * rate.abs()),
                    false => beyond < near,
                };
                match is_near {
                    true => T::from_f64(side) * least[place] - distances[place],
                    false => T::from_f64(0.0),
                }
            }
            // Where it goes it does not come to it at once again.
            Aside::Passed(rate) if stays => {
                let mut sides = [rate, seen(distances[place])].into_iter();
                let side = sides.find(|side| *side != 0.0).map_or(0.0, f64::signum);
                match seen(distances[place]).abs() < seen(least[place]) {
                    true => T::from_f64(side) * least[place] - distances[place],
                    false => T::from_f64(0.0),
                }
            }
            Aside::Passed(_) => T::from_f64(0.0),
        });
        let mut moved = self.moved(x, rates.solve(ways));
        if self.free < self.surfaces.count() {
            let rest = SVector::from_element(T::from_f64(0.0));
            let [[there, _], _] = self.told(at, [(&moved, &rest); 2], memory);
            let is_there = |place: usize| match sorted[place] {
                Aside::Left(side, _) => 2.0 * side * seen(there[place]) > seen(least[place]),
                _ => true,
            };
            if !(self.free..self.surfaces.count()).all(is_there) {
                // As far as the motion itself leads.
                let times = (0..self.surfaces.count()).map(|place| match sorted[place] {
                    Aside::Left(_, rate) if rate != 0.0 => seen(least[place]) / rate.abs(),
                    _ => 0.0,
                });
                let time = times.fold(0.0, f64::max);
                let ways = Each::of(|place| match sorted[place] {
                    Aside::Left(_, rate) => T::from_f64(time * rate) - distances[place],
                    _ => ways[place],
                });
                moved = self.moved(x, rates.solve(ways));
            }
        }
        // By the value alone: a motion that begins next to it leaves from where it is.
        match moved.iter().all(|it| it.magnitude().is_finite()) {
            true => moved.zip_map(x, T::with_slopes_of),
            false => *x,
        }
    }
}

/// What gradients make together.
struct Span<L, const N: usize, const K: usize> {
    basis: Each<SVector<L, N>, K>,
    count: usize,
}

impl<L: Real<Lane = L> + PartialOrd, const N: usize, const K: usize> Span<L, N, K> {
    fn of_nothing() -> Self {
        Self {
            basis: Each::<_, K>::all(SVector::from_element(L::from_f64(0.0))),
            count: 0,
        }
    }

    /// What is beside it of a unit.
    fn beside(&self, unit: &SVector<L, N>) -> SVector<L, N> {
        let known = self.basis.iter().take(self.count);
        known.fold(*unit, |rest, known| {
            let along = dot(known, &rest);
            rest - known.map(|it| it * along)
        })
    }

    fn has(&self, unit: &SVector<L, N>) -> bool {
        is_dependent::<L>(length(&self.beside(unit)))
    }

    /// Adds a unit, with what of it was beside it, if anything was.
    fn add(&mut self, unit: &SVector<L, N>) -> Option<SVector<L, N>> {
        let rest = self.beside(unit);
        let size = length(&rest);
        if is_dependent::<L>(size) {
            return None;
        }
        if let Some(next) = self.basis.get_mut(self.count) {
            *next = rest.map(|it| it / size);
            self.count += 1;
        }
        Some(rest)
    }
}

/// Whether so much of a unit beside others may be rounding.
fn is_dependent<T: Real>(beside: T::Lane) -> bool {
    beside < T::Lane::from_f64(DEPENDENT * T::EPSILON)
}

/// The direction of a gradient, if it has one.
fn unit<T: Real, const N: usize>(gradient: &SVector<T, N>) -> Option<SVector<T::Lane, N>> {
    let size = length(gradient);
    let has_direction = size > T::Lane::from_f64(0.0) && is_finite(size);
    has_direction.then(|| gradient.map(|it| lane(it) / size))
}
