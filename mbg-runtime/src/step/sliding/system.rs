//! The mean along thresholds as a system of its own.

use nalgebra::{SMatrix, SVector};

use super::super::method::along;
use super::sides::summed;
use super::{Each, Moment, Sliding};
use crate::input::quotient;
use crate::{Course, Input, Meta, Power, Real, System, Trouble};

impl<T, S, I, const N: usize, const M: usize, const P: usize, const K: usize> System<T, N, M, P>
    for Sliding<'_, T, S, I, N, K>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    const META: &'static Meta = S::META;
    const AUTONOMOUS: bool = S::AUTONOMOUS;
    const SEEKS_CHANGES: bool = S::SEEKS_CHANGES;
    const COURSES_FOLLOW_INPUTS: bool = S::COURSES_FOLLOW_INPUTS;
    const HAS_ATTITUDES: bool = S::HAS_ATTITUDES;

    type Memory = S::Memory;
    type Conditioning = S::Conditioning;
    type Room = S::Room;

    fn initial_state(&self) -> SVector<T, N> {
        self.system.initial_state()
    }

    fn upright(x: SVector<T, N>) -> SVector<T, N> {
        S::upright(x)
    }

    fn derivative(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SVector<T, N> {
        let derivative = self
            .sides(&self.moment(t, *u), (x, 1.0), memory)
            .derivative();
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
        let at = self.moment(t, *u);
        let mut beside = |factor| {
            let sides = self.sides(&at, (x, factor), memory);
            sides.mean(|x| self.system.output(t, x, u, memory))
        };
        // What goes on steadily over a threshold is off by how far beside it is asked, twice as far by twice as much.
        let [near, far] = [1.0, 2.0].map(&mut beside);
        near.zip_map(&far, |near, far| summed([near, near - far].into_iter()))
    }

    fn jacobian_state(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SMatrix<T, N, N> {
        let mut jacobian = self.along(
            (t, x, u),
            memory,
            |x, memory| self.system.jacobian_state(t, x, u, memory),
            |slope, memory| self.turning(t, (x, slope), memory),
        );
        // The model is asked on the surfaces, wherever beside them the state is.
        let surfaces = self.across.iter().zip(&self.gradients).take(self.free);
        for (across, gradient) in surfaces.map(|(across, by)| (across.get(), by.get())) {
            let zero = SVector::from_element(T::from_f64(0.0));
            let columns = jacobian.column_iter().zip(&across);
            let change = columns.fold(zero, |sum: SVector<T, N>, (column, way)| {
                sum.zip_map(&column, |sum, column| way.multiply_add(column, sum))
            });
            for (mut column, by) in jacobian.column_iter_mut().zip(&gradient) {
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
        self.along(
            (t, x, u),
            memory,
            |x, memory| self.system.jacobian_input(t, x, u, memory),
            |_, _| Each::all(SVector::from_element(T::from_f64(0.0))),
        )
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
            return quotient(t, ahead, |t| {
                self.sides(&self.moment(t, *u), (x, 1.0), memory)
                    .derivative()
            });
        }
        let mut change = quotient(t, ahead, |t| {
            let u = self.input.value(t, self.since);
            self.sides(&self.moment(t, u), (x, 1.0), memory)
                .derivative()
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

    fn has_changed(&self, from: T, to: T, input: impl Fn(T) -> SVector<T, M>) -> bool {
        self.system.has_changed(from, to, input)
    }

    /// As the laws see it, on the surfaces; of an argument that stays no more is told than that there is one.
    fn courses(
        &self,
        (from, [x, slope], [u, rate]): (T, [&SVector<T, N>; 2], [&SVector<T, M>; 2]),
        (to, [ahead, slope_ahead], [u_ahead, rate_ahead]): (
            T,
            [&SVector<T, N>; 2],
            [&SVector<T, M>; 2],
        ),
        memory: &mut S::Memory,
        mut each: impl FnMut(Course<'_, T>),
    ) {
        let on = |time: T, x: &SVector<T, N>, input: &SVector<T, M>, rate: &SVector<T, M>| {
            let (input, rate) = (*input, *rate);
            self.onto(&Moment { time, input, rate }, x, memory)
        };
        let (x, ahead) = (on(from, x, u, rate), on(to, ahead, u_ahead, rate_ahead));
        let asides = [self.aside(&x), self.aside(&ahead)];
        let mut number = 0;
        let from = (from, [&x, slope], [u, rate]);
        let to = (to, [&ahead, slope_ahead], [u_ahead, rate_ahead]);
        self.system.courses(from, to, memory, |course| {
            let stays =
                self.surfaces.of(number).is_some() || self.is_twin(number, &course, &asides);
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
        let at = self.moment(t, *u);
        self.look(&at, &closed, &memory);
        Ok(self.onto(&at, &closed, &memory))
    }
}

impl<T: Real, S, I: ?Sized, const N: usize, const K: usize> Sliding<'_, T, S, I, N, K> {
    /// A Jacobian along the surfaces, from those on their sides: what would lead away from a surface, which turns so under a motion with
    /// this slope, is taken up by its part of the mean.
    fn along<const M: usize, const P: usize, const C: usize>(
        &self,
        (t, x, u): (T, &SVector<T, N>, &SVector<T, M>),
        memory: &mut S::Memory,
        mut of: impl FnMut(&SVector<T, N>, &mut S::Memory) -> SMatrix<T, N, C>,
        turning: impl FnOnce(&SVector<T, N>, &S::Memory) -> Each<SVector<T, C>, K>,
    ) -> SMatrix<T, N, C>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let sides = self.sides(&self.moment(t, *u), (x, 1.0), memory);
        let mut jacobian = sides.mean(|x| of(x, memory));
        let (gradients, turning) = (self.gradients(), turning(&sides.derivative(), memory));
        for (place, mut column) in jacobian.column_iter_mut().enumerate() {
            let mut away = Each::all(T::from_f64(0.0));
            let turning = gradients.iter().zip(&turning).take(self.free);
            for (away, (gradient, turning)) in away.iter_mut().zip(turning) {
                let pairs = gradient.iter().zip(column.iter());
                *away = pairs.fold(turning[place], |sum, (by, change)| {
                    by.multiply_add(*change, sum)
                });
            }
            for (jump, part) in sides.jumps.iter().zip(&sides.rates.solve(away)) {
                column -= jump.map(|jump| *part * jump);
            }
        }
        jacobian
    }

    /// How fast the gradient of each surface changes under a motion.
    fn turning<const M: usize, const P: usize>(
        &self,
        t: T,
        (x, slope): (&SVector<T, N>, &SVector<T, N>),
        memory: &S::Memory,
    ) -> Each<SVector<T, N>, K>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let mut turning = Each::all(SVector::from_element(T::from_f64(0.0)));
        let by_state = |state: usize, time: T| {
            let (way, at) = (
                time - t,
                self.moment(time, self.input.value(time, self.since)),
            );
            self.by_state(state, (&at, &along(x, way, slope)), memory)
        };
        let ahead = T::from_f64(self.ahead.get());
        for state in 0..N {
            // Most arguments are sums of states.
            if by_state(state, t) == by_state(state, t + ahead) {
                continue;
            }
            let rates = quotient(t, ahead, |time| by_state(state, time));
            for (turning, rate) in turning.iter_mut().zip(&rates) {
                turning[state] = *rate;
            }
        }
        turning
    }
}
