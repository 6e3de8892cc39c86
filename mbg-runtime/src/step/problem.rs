//! The problem as a method of integration sees it: a system with its input on one piece, counted calls.

use nalgebra::{SMatrix, SVector};

use super::dense::Polynomial;
use super::elimination::Shifted;
use super::method::{Span, Start, along};
use super::probes::Probes;
use super::{Cause, Statistics, Stopped, check_result, seen};
use crate::{Columns, Input, Real, System, Trouble};

/// Parts of a failed step at whose ends the input is looked at.
const LOOKS: u32 = 64;

/// In units of the last place of a time, laws are at least so far from where they change.
const PLACES: f64 = 4.0;
/// So much farther than where they are found to be others: what is rounded otherwise may change there again.
const SURELY: f64 = 4.0;
/// That is looked for no farther than within this part of a piece, and than so many roots of the precision of it, about which a
/// wave is flat.
const LONGEST: f64 = 0.01;
const SEVERAL: f64 = 64.0;

/// What a run carries from step to step besides the state.
pub struct Problem<'a, T, S, I, const N: usize, const M: usize, const P: usize>
where
    T: Real,
    S: System<T, N, M, P>,
    I: ?Sized,
{
    pub(super) system: &'a S,
    pub(super) input: &'a I,
    pub(super) statistics: Statistics,
    pub(super) memory: S::Memory,
    /// How long the run may be.
    pub(super) whole: f64,
    /// Where the present piece begins.
    pub(super) since: T,
    /// The first and the last time at which laws of time are those of the present piece.
    pub(super) inside: (T, T),
    pub(super) probes: Probes,
    /// The determinants where the last step began, on this piece of the input.
    pub(super) conditioning: Option<S::Conditioning>,
    /// Whether slopes are those on the closed loops next to a state.
    pub(super) closes_stages: bool,
}

impl<'a, T, S, I, const N: usize, const M: usize, const P: usize> Problem<'a, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    pub(super) fn new(system: &'a S, input: &'a I, (start, end): (T, T)) -> Self {
        Self {
            system,
            input,
            statistics: Statistics::default(),
            memory: S::Memory::default(),
            whole: seen(end - start),
            since: start,
            inside: (start, T::from_f64(f64::INFINITY)),
            probes: Probes::new(seen(start)),
            conditioning: None,
            closes_stages: false,
        }
    }

    /// Goes on to the next piece, between two jumps of the input or changes of the laws.
    pub(super) fn enter(&mut self, (since, end): (T, T)) {
        self.since = since;
        self.conditioning = None;
        self.closes_stages = false;
        self.inside = (since, T::from_f64(f64::INFINITY));
        let changes = !S::AUTONOMOUS
            && (S::SEEKS_CHANGES
                || (self.system)
                    .next_change(T::from_f64(f64::NEG_INFINITY))
                    .is_some());
        if changes {
            let [first, last] = [1.0, -1.0].map(|way| self.within((since, end), way));
            self.inside = (since + first, end + last);
        }
    }

    /// How far from the start of a piece on, or from its end back, laws of time are those of the piece: a law says for one side
    /// alone what it is where it changes, and what it adds up there may round more than the time does, or hardly change.
    fn within(&self, (since, end): (T, T), way: f64) -> T {
        let place = if way > 0.0 { since } else { end };
        let least = T::EPSILON * (PLACES * place.magnitude()).max(T::EPSILON);
        let length = (end - since).magnitude();
        let most = (SEVERAL * T::SINGULAR).min(LONGEST) * length;
        let middle = since + T::from_f64(0.5) * (end - since);
        let mut aside = least;
        while aside <= most {
            let beside = place + T::from_f64(way * aside);
            let input = |t: T| self.input.value(t, since);
            if !self.system.has_changed(beside, middle, input) {
                let surely = if aside > least { SURELY * aside } else { aside };
                return T::from_f64(way * surely);
            }
            aside *= 2.0;
        }
        T::from_f64(way * least)
    }

    /// The same problem, to be asked what the run itself is not to remember.
    pub(super) fn beside(&self) -> Self {
        Self {
            probes: self.probes,
            conditioning: None,
            ..*self
        }
    }

    /// The same of other laws of the same model.
    pub(super) fn of<'b, R>(&self, system: &'b R) -> Problem<'b, T, R, I, N, M, P>
    where
        'a: 'b,
        R: System<T, N, M, P, Memory = S::Memory, Conditioning = S::Conditioning>,
    {
        Problem {
            system,
            input: self.input,
            statistics: self.statistics,
            memory: self.memory,
            whole: self.whole,
            since: self.since,
            inside: self.inside,
            probes: self.probes,
            conditioning: self.conditioning,
            closes_stages: false,
        }
    }

    /// The nearest time on the present piece.
    pub(super) fn on_piece(&self, t: T) -> T {
        if S::AUTONOMOUS {
            return t;
        }
        let (first, last) = self.inside;
        t.max(first).min(last)
    }

    /// The derivative, of which that of a small model is inlined.
    #[inline(always)]
    pub(super) fn slope(&mut self, t: T, x: &SVector<T, N>) -> SVector<T, N> {
        if !S::META.closures.is_empty() && self.closes_stages {
            return self.slope_where_closed(t, x);
        }
        self.slope_as_it_is(t, x)
    }

    /// What the polynomial over a step misses of the derivative at a place in it, times the length of the step.
    pub(super) fn missed(
        &mut self,
        start: &Start<T, N>,
        polynomial: &Polynomial<T, N>,
        place: T,
    ) -> SVector<T, N> {
        let (x, change) = polynomial.with_slope(place);
        let slope = self.slope(start.span.at(place), &x);
        slope.zip_map(&change, |slope, change| start.span.length * slope - change)
    }

    /// The same as [`Self::slope`] where loops are closed.
    #[cold]
    #[inline(never)]
    fn slope_where_closed(&mut self, t: T, x: &SVector<T, N>) -> SVector<T, N> {
        let closed = self.close(self.on_piece(t), *x);
        self.slope_as_it_is(t, &closed.unwrap_or(*x))
    }

    #[inline(always)]
    fn slope_as_it_is(&mut self, t: T, x: &SVector<T, N>) -> SVector<T, N> {
        self.statistics.evaluations += 1;
        let t = self.on_piece(t);
        let u = self.input.value(t, self.since);
        self.system.derivative(t, x, &u, &mut self.memory)
    }

    /// The derivative at a stage of a method that sweeps over its stages, with what its loops remember from the sweep before; in
    /// the first sweep they go on from the stage before.
    ///
    /// So a stage before a fold of a loop does not find the far branch from a stage behind it, and one that is there stays.
    pub(super) fn slope_of_stage(
        &mut self,
        t: T,
        x: &SVector<T, N>,
        memory: &mut Option<S::Memory>,
    ) -> SVector<T, N> {
        self.memory = memory.unwrap_or(self.memory);
        let slope = self.slope(t, x);
        *memory = Some(self.memory);
        slope
    }

    /// The inputs at four stages.
    #[inline]
    pub(super) fn inputs(&self, times: T::Stages) -> SVector<T::Stages, M> {
        let times = times.as_columns();
        let inputs: [SVector<T, M>; 4] =
            core::array::from_fn(|stage| self.input.value(times[stage], self.since));
        SVector::from_fn(|input, _| T::Stages::from_columns(|stage| inputs[stage][input]))
    }

    /// Writes the derivatives at four stages.
    #[inline]
    pub(super) fn slopes(
        &mut self,
        times: T::Stages,
        x: &SVector<T::Stages, N>,
        u: &SVector<T::Stages, M>,
        slopes: &mut SVector<T::Stages, N>,
    ) {
        self.statistics.evaluations += 4;
        let times = if S::AUTONOMOUS {
            times
        } else {
            let columns = times.as_columns();
            T::Stages::from_columns(|stage| self.on_piece(columns[stage]))
        };
        *slopes = self.system.derivatives(times, x, u, &mut self.memory);
    }

    /// Writes `∂f/∂x` over a matrix that began with zeros: those that it has in every state stay. It may be asked for
    /// ahead: the memory stays as it is.
    ///
    /// A law may have no slope at a state, as a root has none at zero: then it is that of where the motion is after so much time, if a
    /// method goes by it to find its stages alone, or knows by its errors how good that is.
    pub(super) fn jacobian(
        &mut self,
        (t, x): (T, &SVector<T, N>),
        ahead: Option<T>,
        jacobian: &mut SMatrix<T, N, N>,
    ) {
        self.jacobian_at(t, x, jacobian);
        if let Some(ahead) = ahead
            && !jacobian.iter().all(|it| it.magnitude().is_finite())
        {
            let memory = self.memory;
            let slope = self.slope(t, x);
            self.memory = memory;
            self.jacobian_at(t, &along(x, ahead, &slope), jacobian);
        }
    }

    /// The same at a state.
    ///
    /// A matrix on its way is on the stack no longer than the call.
    #[inline(never)]
    fn jacobian_at(&mut self, t: T, x: &SVector<T, N>, jacobian: &mut SMatrix<T, N, N>) {
        self.statistics.jacobians += 1;
        let t = self.on_piece(t);
        let u = self.input.value(t, self.since);
        let mut memory = self.memory;
        let mut derivative = SVector::from_element(T::from_f64(0.0));
        self.system
            .derivative_and_jacobian_into(t, x, &u, &mut memory, &mut derivative, jacobian);
    }

    /// Writes the Jacobian at a place, or ahead of it, and factors of `I − scale ∂f/∂x`.
    #[inline(never)]
    pub(super) fn factorise(
        &mut self,
        (place, ahead): ((T, &SVector<T, N>), Option<T>),
        scale: T,
        (jacobian, factors): (&mut SMatrix<T, N, N>, &mut Shifted<T, N>),
    ) {
        self.statistics.factorisations += 1;
        self.jacobian(place, ahead, jacobian);
        factors.factorise::<S, M, P>(T::from_f64(1.0), scale, jacobian);
    }

    /// The derivative of `f(t, x, u(t))` by time at a fixed state, for a step of this length.
    pub(super) fn slope_by_time(&mut self, t: T, x: &SVector<T, N>, length: T) -> SVector<T, N> {
        let t = self.on_piece(t);
        let u = self.input.value(t, self.since);
        let mut change = self
            .system
            .derivative_time(t, x, &u, &mut self.memory, length);
        let rate = self.input.rate(t, self.since, length);
        if rate.iter().any(|rate| *rate != T::from_f64(0.0)) {
            let by_input = self.system.jacobian_input(t, x, &u, &mut self.memory);
            for (rate, column) in rate.iter().zip(by_input.column_iter()) {
                change.zip_apply(&column, |change, by| *change += by * *rate);
            }
        }
        change
    }

    /// Refuses a point where the state, the derivative or the model is in trouble, or which lies behind a singular set.
    #[inline(always)]
    pub(super) fn check(
        &mut self,
        t: T,
        x: &SVector<T, N>,
        slope: &SVector<T, N>,
    ) -> Result<(), Stopped> {
        let here = self.on_piece(t);
        let u = self.input.value(here, self.since);
        let stopped = |trouble| Stopped::new(t, Cause::Trouble(trouble));
        if S::META.conditioning.is_empty() {
            let trouble = self.system.trouble(here, x, &u, &self.memory);
            trouble.map_or(Ok(()), |trouble| Err(stopped(trouble)))?;
        } else {
            let examined = self.system.examined(here, x, &u, &self.memory);
            let conditioning = examined.map_err(stopped)?;
            if let Some(before) = self.conditioning.replace(conditioning) {
                stepped_over::<T, S, N, M, P>(&before, &conditioning).map_err(stopped)?;
            }
        }
        check_result(self.system, t, slope, &self.memory)
    }

    /// Of the input, where that is what is not finite.
    #[cold]
    #[inline(never)]
    pub(super) fn of_input(&self, stopped: Stopped) -> Stopped {
        let Cause::Trouble(trouble) = stopped.cause else {
            return stopped;
        };
        let u = (self.input).value(self.on_piece(T::from_f64(stopped.time)), self.since);
        let cause = Cause::Trouble(trouble.traced(S::META, &u));
        Stopped { cause, ..stopped }
    }

    /// What of the input is not finite within a step, of which stages see no more than a few times, or of its rate at the start.
    #[cold]
    #[inline(never)]
    fn trouble_of_input(&self, span: &Span<T>) -> Option<Trouble> {
        let times =
            (0..=LOOKS).map(|look| span.at(T::from_f64(f64::from(look) / f64::from(LOOKS))));
        let mut values = times.map(|t| self.input.value(self.on_piece(t), self.since));
        values
            .find_map(|u| Trouble::of_input(S::META, &u))
            .or_else(|| {
                let rate = (self.input).rate(self.on_piece(span.start), self.since, span.length);
                Trouble::of_input(S::META, &rate)
            })
    }

    /// Why this step failed, which took its Jacobian at `place`: of what is not finite, that which made the rest so.
    #[cold]
    #[inline(never)]
    pub(super) fn traced(
        &mut self,
        stopped: Stopped,
        start: &Start<T, N>,
        place: Option<(T, SVector<T, N>)>,
    ) -> Stopped {
        if !matches!(stopped.cause, Cause::Trouble(Trouble::NotFinite { .. })) {
            return stopped;
        }
        let Span {
            start: time,
            end,
            length,
        } = start.span;
        if let Some(trouble) = self.trouble_of_input(&start.span) {
            let cause = Cause::Trouble(trouble);
            return Stopped { cause, ..stopped };
        }
        let Some((t, x)) = place else {
            return stopped;
        };
        let slope_at = |problem: &mut Self, t: T, x: &SVector<T, N>| {
            let slope = problem.slope(t, x);
            check_result(problem.system, time, &slope, &problem.memory)
        };
        // Where the derivative is not finite, the Jacobian is not either.
        if let Err(stopped) = slope_at(self, t, &x) {
            return stopped;
        }
        let mut jacobian = SMatrix::from_element(T::from_f64(0.0));
        self.jacobian((t, &x), None, &mut jacobian);
        if let Some(trouble) = Trouble::of_jacobian(&jacobian, [S::META.states; 2]) {
            return Stopped::new(time, Cause::Trouble(trouble));
        }
        let ahead = along(&start.x, length, &start.slope);
        slope_at(self, end, &ahead).err().unwrap_or(stopped)
    }

    /// Why a step that is as short as time resolves failed: what is not finite in its change, if anything is.
    #[cold]
    pub(super) fn too_small(
        &mut self,
        (start, change, tried): (&Start<T, N>, &SVector<T, N>, &S::Memory),
        place: Option<(T, SVector<T, N>)>,
    ) -> Stopped {
        match check_result(self.system, start.span.start, change, tried) {
            Ok(()) => Stopped::new(start.span.start, Cause::StepTooSmall),
            Err(stopped) => self.traced(stopped, start, place),
        }
    }

    /// Goes on from the end of a step, onto the closed loops next to it.
    #[inline(always)]
    pub(super) fn arrive(
        &mut self,
        t: T,
        x: SVector<T, N>,
        slope: &SVector<T, N>,
    ) -> Result<SVector<T, N>, Stopped> {
        self.statistics.steps += 1;
        self.check(t, &x, slope)?;
        self.close(t, x)
    }

    /// Whether nothing but its state drives the model, until the input jumps.
    pub(super) fn is_left_alone(&self) -> bool {
        self.input.is_constant_between_jumps() && S::AUTONOMOUS
    }

    /// The state on the closed loops next to `x`.
    pub(super) fn close(&self, t: T, x: SVector<T, N>) -> Result<SVector<T, N>, Stopped> {
        let u = self.input.value(t, self.since);
        self.system
            .close(self.on_piece(t), x, &u, &[])
            .map_err(|trouble| Stopped::new(t, Cause::Trouble(trouble)))
    }
}

/// Whether no determinant has changed its sign.
fn stepped_over<T, S, const N: usize, const M: usize, const P: usize>(
    before: &S::Conditioning,
    behind: &S::Conditioning,
) -> Result<(), Trouble>
where
    T: Real,
    S: System<T, N, M, P>,
{
    let pairs = before.as_ref().iter().zip(behind.as_ref());
    for (name, (before, behind)) in S::META.conditioning.iter().zip(pairs) {
        if (*before * *behind).find(|product| product < 0.0).is_some() {
            let values = [before, behind].map(|it| it.find(|_| true).unwrap_or(f64::NAN));
            return Err(Trouble::SteppedOver { name, values });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::models::Oscillator;

    #[test]
    fn an_autonomous_model_is_not_asked_what_time_changes() {
        let mut problem = Problem::<f64, _, _, 2, 1, 0>::new(&Oscillator, &(), (0.0, 1.0));
        // Any evaluation there would give what is no number.
        let nowhere = SVector::from([f64::NAN; 2]);
        let change = problem.slope_by_time(0.0, &nowhere, 0.1);
        assert_eq!(change, SVector::from([0.0; 2]));
    }
}
