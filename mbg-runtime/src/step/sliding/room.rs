//! Room for the thresholds at which a motion stays.

use core::ops::ControlFlow;

use nalgebra::SVector;

use super::super::dense::Step;
use super::super::over::Place;
use super::super::problem::Problem;
use super::super::slide::{Settled, Walk};
use super::super::surfaces::{AnySurfaces, Surface, Surfaces};
use super::super::thresholds::Point;
use super::super::tolerance::Measure;
use super::Sliding;
use super::settle::Rest;
use crate::step::Stopped;
use crate::{Input, Real, System};

/// Room for `K` thresholds at which a motion stays at once, as [`System::Room`].
#[derive(Clone, Copy, Debug)]
pub struct Room<const K: usize>;

/// What [`Room`] is; there are no others.
///
/// What a run does along thresholds is told here by how much room there is: where that is a number of the system's, all that is built is
/// for that number.
#[allow(
    private_bounds,
    private_interfaces,
    reason = "it is not written outside"
)]
pub trait Rooms: Sized {
    /// For so many.
    const COUNT: usize;

    /// Those thresholds.
    #[doc(hidden)]
    type Surfaces<T: Real>: AnySurfaces<T>;

    /// Goes on along thresholds.
    #[doc(hidden)]
    fn slide<W, T, S, I, const N: usize, const M: usize, const P: usize>(
        walk: &mut W,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        place_and_end: (Place<T, N>, T),
        known: (Self::Surfaces<T>, &mut Settled<T>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Place<T, N>>, Stopped>
    where
        W: Walk<T, N> + ?Sized,
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized;

    /// Whether a motion stays at some of these.
    #[doc(hidden)]
    fn stays<T, S, I, const N: usize, const M: usize, const P: usize>(
        model: (&S, &I),
        times: (T, (T, T), f64),
        place: (T, &mut SVector<T, N>),
        surfaces: Self::Surfaces<T>,
        known: (&mut S::Memory, &mut u64),
    ) -> bool
    where
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized;

    /// Where it comes to rest at some of these.
    #[doc(hidden)]
    fn rest<T, S, I, const N: usize, const M: usize, const P: usize>(
        model: (&S, &I),
        times: (T, (T, T), f64),
        here: &Point<T, N>,
        near: (&[Surface<T>], &Measure<N>),
        known: (&mut S::Memory, &mut u64),
    ) -> Option<Rest<T, Self::Surfaces<T>, N>>
    where
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized;

    /// The outputs next to some at which it stays.
    #[doc(hidden)]
    fn output<T, S, I, const N: usize, const M: usize, const P: usize>(
        model: (&S, &I),
        times: (T, f64),
        x: &SVector<T, N>,
        known: (&[Surface<T>], &mut S::Memory),
    ) -> SVector<T, P>
    where
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized;
}

#[allow(
    private_bounds,
    private_interfaces,
    reason = "it is not written outside"
)]
impl<const K: usize> Rooms for Room<K> {
    const COUNT: usize = K;

    type Surfaces<T: Real> = Surfaces<T, K>;

    fn slide<W, T, S, I, const N: usize, const M: usize, const P: usize>(
        walk: &mut W,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        place_and_end: (Place<T, N>, T),
        known: (Self::Surfaces<T>, &mut Settled<T>),
        observer: &mut impl FnMut(&mut Step<'_, T, N, S::Memory>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Place<T, N>>, Stopped>
    where
        W: Walk<T, N> + ?Sized,
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized,
    {
        walk.slide::<S, I, M, P, K>(problem, place_and_end, known, observer)
    }

    fn stays<T, S, I, const N: usize, const M: usize, const P: usize>(
        model: (&S, &I),
        times: (T, (T, T), f64),
        place: (T, &mut SVector<T, N>),
        surfaces: Self::Surfaces<T>,
        known: (&mut S::Memory, &mut u64),
    ) -> bool
    where
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized,
    {
        Sliding::settled(model, times, place, surfaces, known).is_some()
    }

    fn rest<T, S, I, const N: usize, const M: usize, const P: usize>(
        model: (&S, &I),
        times: (T, (T, T), f64),
        here: &Point<T, N>,
        near: (&[Surface<T>], &Measure<N>),
        known: (&mut S::Memory, &mut u64),
    ) -> Option<Rest<T, Self::Surfaces<T>, N>>
    where
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized,
    {
        Sliding::<_, _, _, N, K>::rest(model, times, here, near, known)
    }

    fn output<T, S, I, const N: usize, const M: usize, const P: usize>(
        (system, input): (&S, &I),
        (t, whole): (T, f64),
        x: &SVector<T, N>,
        (surfaces, memory): (&[Surface<T>], &mut S::Memory),
    ) -> SVector<T, P>
    where
        T: Real,
        S: System<T, N, M, P, Room = Self>,
        I: Input<T, M> + ?Sized,
    {
        let (mut x, u) = (*x, input.at(t));
        let times = (t, (t, t), whole);
        let known = (&mut *memory, &mut 0);
        let surfaces = Surfaces::<T, K>::none().with(surfaces);
        match Sliding::settled((system, input), times, (t, &mut x), surfaces, known) {
            Some(sliding) => sliding.output(t, &x, &u, memory),
            None => system.output(t, &x, &u, memory),
        }
    }
}
