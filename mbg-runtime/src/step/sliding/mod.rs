//! The laws of a motion that stays where others jump.

mod choice;
mod each;
mod line;
mod room;
mod settle;
mod sides;
mod system;

use core::cell::Cell;

use nalgebra::SVector;

use each::Each;
pub use room::{Room, Rooms};

use super::seen;
use super::surfaces::{AnySurfaces, Surfaces};
use crate::{Course, Input, Real, System};

/// The part of a run, and of a step, over which an input is taken to be smooth.
const SHORT: f64 = 1.0 / 4096.0;
const PART: f64 = 0.25;

/// Surfaces on which a motion is by others, and how each is like another one.
type Along<T, const K: usize> = (Surfaces<T, K>, Each<Like, K>);

/// How a surface is another one, but for a factor.
#[derive(Clone, Copy)]
struct Like {
    /// The place of the other one.
    leader: usize,
    /// How many times as fast its argument changes.
    size: f64,
    /// How far from it the motion may be, in units of what is surely beside the other.
    apart: f64,
}

impl Like {
    const NOTHING: Self = Self {
        leader: 0,
        size: 0.0,
        apart: 0.0,
    };
}

/// The laws of a model whose motion stays at thresholds of them: friction that holds, a relay that goes on and off without end.
///
/// On both sides the motion leads to the threshold. Along it goes that mean of both which does not leave it (Filippov,
/// *Differential Equations with Discontinuous Righthand Sides*, Kluwer 1988, §4); along several at once the mean whose parts are
/// found from what each alone makes different (Utkin, *Sliding Modes in Control and Optimization*, Springer 1992, §2). What each makes
/// different is asked along a line beside the state that crosses one after the other, at which of them the motion stays is
/// chosen of all at once, and settling there puts the state on these and beside the others.
pub(super) struct Sliding<'a, T, S, I: ?Sized, const N: usize, const K: usize> {
    system: &'a S,
    input: &'a I,
    since: T,
    /// Between which times laws are those of the present piece.
    inside: (T, T),
    /// For how long the input is smooth, about.
    ahead: Cell<f64>,
    /// First those that are free: no argument of these is told by others. Behind them those whose arguments are, at places of their own.
    pub(super) surfaces: Surfaces<T, K>,
    free: usize,
    /// Which part of the mean is above each of the latter: what others have goes by that.
    shares: Each<T, K>,
    /// Others whose argument is one of these but for a factor, and how far from each it may be by rounding.
    twins: Along<T, K>,
    /// How states change that go across each free surface, at a rate of one, and along the others, where the motion has come to.
    across: Each<Cell<SVector<T, N>>, K>,
    /// The same where it was last asked whether the motion stays.
    beyond: Each<Cell<SVector<T, N>>, K>,
    /// How the argument of each changes with the states, where the motion has come to.
    gradients: Each<Cell<SVector<T, N>>, K>,
    /// How often the model was evaluated, but for once in each evaluation of these laws.
    pub(super) evaluations: Cell<u64>,
}

/// A time with the input, and how fast that changes, if arguments go by that.
struct Moment<T, const M: usize> {
    time: T,
    input: SVector<T, M>,
    rate: SVector<T, M>,
}

impl<'a, T: Real, S, I: ?Sized, const N: usize, const K: usize> Sliding<'a, T, S, I, N, K> {
    /// Of laws of a piece between such times, in a run so long.
    fn of(
        (system, input): (&'a S, &'a I),
        (since, inside, whole): (T, (T, T), f64),
        surfaces: Surfaces<T, K>,
    ) -> Self {
        let zero = T::from_f64(0.0);
        let none = || Each::of(|_| Cell::new(SVector::from_element(zero)));
        Self {
            system,
            input,
            since,
            inside,
            ahead: Cell::new(whole * SHORT),
            surfaces,
            free: 0,
            shares: Each::all(zero),
            twins: (Surfaces::none(), Each::all(Like::NOTHING)),
            across: none(),
            beyond: none(),
            gradients: none(),
            evaluations: Cell::new(0),
        }
    }

    /// Whether an argument is at its threshold because it is one of the others, next to such states.
    fn is_twin(&self, number: usize, course: &Course<'_, T>, asides: &[Each<T, K>; 2]) -> bool {
        let (twins, likes) = &self.twins;
        twins.of(number).is_some_and(|(place, level)| {
            let Like {
                leader,
                size,
                apart,
            } = likes[place];
            let values = [course.from[0], course.to[0]].into_iter();
            values
                .zip(asides)
                .all(|(it, aside)| (it - level).magnitude() <= apart * size * seen(aside[leader]))
        })
    }

    /// All at which the motion stays.
    pub(super) fn all(&self) -> Surfaces<T, K> {
        self.surfaces.with(self.twins.0.as_slice())
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
    fn on_piece<const M: usize, const P: usize>(&self, t: T) -> Moment<T, M>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let time = t.max(self.inside.0).min(self.inside.1);
        self.moment(time, self.input.value(time, self.since))
    }

    /// A time with this input.
    fn moment<const M: usize, const P: usize>(&self, time: T, input: SVector<T, M>) -> Moment<T, M>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let rate = if !S::COURSES_FOLLOW_INPUTS || self.input.is_constant_between_jumps() {
            SVector::from_element(T::from_f64(0.0))
        } else {
            let ahead = T::from_f64(self.ahead.get());
            self.input.rate(time, self.since, ahead)
        };
        Moment { time, input, rate }
    }

    /// Minds how long a step was that is over, and how surfaces are gone across at its end: on the way they may turn along that.
    pub(super) fn heed(&self, length: f64) {
        self.ahead.set(PART * length);
        self.go_across(self.beyond.iter().take(self.free).map(Cell::get));
    }

    /// Minds how free surfaces are gone across.
    fn go_across(&self, ways: impl Iterator<Item = SVector<T, N>>) {
        for (across, way) in self.across.iter().zip(ways) {
            across.set(way);
        }
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
        let [zero, most] = [0.0, 0.5].map(T::from_f64);
        let least = (0..self.free).fold(most, |least, place| least.min(sides.held(place)));
        // What is left on purpose a little late is left for good.
        let late = T::from_f64(T::SINGULAR);
        if !sides.leads_back.iter().take(self.free).all(|it| *it) {
            return zero;
        }
        for (beyond, way) in self.beyond.iter().zip(sides.across(self.free)) {
            beyond.set(way);
        }
        least + late
    }
}
