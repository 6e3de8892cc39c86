//! Periodic motions: rotors in forward flight, converters that switch, what swings by itself.

mod rounding;

use core::cmp::Ordering;

use nalgebra::{Complex, SMatrix, SVector};

use crate::convertible::{Together, along, keep_slopes};
use crate::poles::eigenvalues;
use crate::search::{Asked, Search};
use crate::selection::Selection;
use crate::solve::{Row, Rows, Sizes};
use crate::{
    Cause, Columns, Constant, Convertible, Direction, Dual, Integrator, Real, Stopped, System,
    Trimmed, Untrimmed,
};

/// Corrections at most.
const CORRECTIONS: usize = 40;
/// Dampings of one correction at most.
const DAMPINGS: usize = 10;
/// What is left out of a correction, in units of what matters most: first what may be the rounding of a run.
const PARTS: [f64; 3] = [1e-10, 1e-6, 1e-3];
/// What may be left of a condition beside its terms.
const LEFT: f64 = 1e-6;
/// What has less influence on a state than this part of it may be the rounding of a run.
const NOISE: f64 = 1e-9;
/// A start that is nearer to a threshold, in periods, is on it, and later by such a part.
const BESIDE: f64 = 1e-9;
const LATER: f64 = 1e-6;
/// States change alike if their slopes differ by no more than this part.
const ALIKE: f64 = 1e-7;
/// At so many times of each step laws are compared with those a period later.
const COMPARED: u32 = 16;
/// By how much slopes along a motion may miss it, beside what they are made of: they are less exact than states where lines of a
/// curve meet.
const ASIDE: f64 = 1e-2;
/// Nothing counts as smaller, beside what would be as much as all else of a condition: terms may be zero.
const TINY: f64 = 1e-9;

/// Finds a periodic motion: a rotor in forward flight, a converter that switches, an engine, a balance wheel.
///
/// Every state is to come back after a period, unless told otherwise: the angle of a shaft [`grows`](PeriodicTrim::grows) by a
/// turn, a position may be [`free`](PeriodicTrim::free). Each state at the start, and each input, which is constant, may be chosen
/// unless it is [fixed](PeriodicTrim::fix). To ask for a mean, ask for the growth of an integral: `integral lifted = rotor.lift;`
/// in the model grows by the mean of the lift times the period. States and inputs go by their names, and several at once by what
/// their names begin with.
///
/// Where nothing drives the motion, its period can be found, too; the motion then begins where one state [is as in the
/// guess](PeriodicTrim::find_period).
///
/// The motion is found by shooting: the given integrator follows it from a start for a period, and Newton's method corrects the
/// start with the derivatives of the end, which are those of the steps on [`Dual`] numbers, also through jumps of laws by time and
/// inputs. Corrections are damped until the residual falls; of corrections that are as good, the one of least norm is taken, in
/// units of what states and inputs do. States that change alike differ as in the guess, as with [`Trim`](crate::Trim). The motion
/// need not be a stable one. It is as exact as the integrator.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Adaptive, Dop853, PeriodicTrim, System, mbg};
///
/// mbg! {
///     /// A blade that flaps in forward flight: the air is faster on the side on which it goes ahead.
///     model Flapping {
///         input pitch: rad;
///         let air = 1.0 + 0.3 * sin(30.0 * t);
///         let lift = 1e5 * pitch * air * air;
///         1 flap {
///             I blade { inertia: 500.0 }
///             C centrifugal { stiffness: 5e5 }
///             R damping { resistance: 8e3 * air }
///             Se push { effort: lift }
///         }
///         integral lifted: N*m*s = lift;
///         output lifted: N*m*s = lifted;
///     }
/// }
///
/// let model = Flapping::<f64>::new(FlappingParameters::default())?;
/// let turn = 2.0 * std::f64::consts::PI / 30.0;
/// let solver = Adaptive::new(Dop853, 1e-10, 1e-10);
/// // The pitch at which the mean of the lift is 2e4 N m, and how the blade then flaps.
/// let cycle = PeriodicTrim::new(&model, &solver, turn).grows("lifted", 2e4 * turn).solve()?;
/// assert!((cycle.input[0] - 0.2 / (1.0 + 0.3 * 0.3 / 2.0)).abs() < 1e-9);
/// // Disturbances decay: every multiplier but that of the integral is below one.
/// let multipliers = cycle.multipliers().unwrap().map(|it| it.re.hypot(it.im));
/// assert_eq!(multipliers.iter().filter(|size| **size < 1.0).count(), 2);
/// // By Liouville, their product is exp(−∫ 8e3 air / 500 dt).
/// assert!((multipliers.iter().product::<f64>() - f64::exp(-16.0 * turn)).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// What swings by itself is found with its period:
///
/// ```
/// use mbg_runtime::{Adaptive, Dop853, PeriodicTrim, System, mbg};
/// use nalgebra::SVector;
///
/// mbg! {
///     /// The oscillator of van der Pol.
///     model Valve {
///         1 circuit {
///             I coil { inertia: 1.0 }
///             C capacitor { compliance: 1.0 }
///             R valve { effort: (capacitor.q * capacitor.q - 1.0) * f }
///         }
///     }
/// }
///
/// let model = Valve::<f64>::new(ValveParameters::default())?;
/// let solver = Adaptive::new(Dop853, 1e-11, 1e-11);
/// let cycle = PeriodicTrim::new(&model, &solver, 6.0)
///     .state(&SVector::from([0.5, 2.0]))
///     .find_period("coil.p")
///     .solve()?;
/// assert!((cycle.period - 6.663_286_859_323_13).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A law may jump at a state, as dry friction and a relay do, and the motion may stay there for a while, as a body does that
/// friction holds. Then nothing is left of how it came there, so that a motion which sticks and slips has a multiplier of zero.
///
/// Newton's method may end between two motions. Where the wanted motion is stable, begin at the state to which a run of some
/// periods comes.
///
/// Where a motion goes through an event, such as the step of a walker, follow it by
/// [`Integrator::until`](crate::Integrator::until) on [`Dual`] numbers, and solve for the start by its slopes.
#[derive(Clone, Copy, Debug)]
pub struct PeriodicTrim<'a, S, A, const N: usize, const M: usize, const P: usize> {
    system: &'a S,
    solver: &'a A,
    time: f64,
    period: f64,
    start: Trimmed<N, M>,
    /// With what each state grows by as its change.
    selection: Selection<N, M>,
    /// The state that tells when the motion is to have come back.
    section: Option<usize>,
}

/// A periodic motion: see [`PeriodicTrim`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle<const N: usize, const M: usize> {
    /// The state at its start.
    pub state: SVector<f64, N>,
    /// The input.
    pub input: SVector<f64, M>,
    /// The period, s.
    pub period: f64,
    /// The monodromy matrix: how the state after a period changes with that at the start, or with that right after it if a law
    /// jumps there. NaN for a motion that swings by itself and along which it does not lead.
    pub monodromy: SMatrix<f64, N, N>,
}

impl<const N: usize, const M: usize> Cycle<N, M> {
    /// Floquet's multipliers, the eigenvalues of the monodromy matrix: those below one in size decay with each period. What swings by
    /// itself has one that is one, along its motion; so has what only integrates. None where they are not finite, or not found in a
    /// bounded number of sweeps.
    #[must_use]
    pub fn multipliers(&self) -> Option<[Complex<f64>; N]> {
        eigenvalues(self.monodromy)
    }
}

/// A number with several slopes, as many as are worked out together.
type Several = Dual<f64, Together<f64>>;
const TOGETHER: usize = <Together<f64> as Columns<f64>>::COUNT;

/// A motion from a start on.
struct Run<const N: usize, const M: usize> {
    start: Trimmed<N, M>,
    period: f64,
    /// What is left of the conditions.
    left: SVector<f64, N>,
    /// How large states and inputs become.
    sizes: Sizes<N, M>,
    /// How far states go from where they are at the start.
    strokes: SVector<f64, N>,
}

/// How its end changes with state and input at the start.
type Slopes<const N: usize, const M: usize> = (SMatrix<f64, N, N>, SMatrix<f64, N, M>);

impl<'a, S, A, const N: usize, const M: usize, const P: usize> PeriodicTrim<'a, S, A, N, M, P>
where
    S: Convertible<f64, N, M, P>,
    A: Integrator<N>,
{
    /// A motion of this period in s, followed by this integrator, from the model's initial state with inputs of zero, at time zero:
    /// every state is to come back, and everything may be chosen.
    #[must_use]
    pub fn new(system: &'a S, solver: &'a A, period: f64) -> Self {
        Self {
            system,
            solver,
            time: 0.0,
            period,
            start: Trimmed {
                state: system.initial_state(),
                input: SVector::zeros(),
            },
            selection: Selection::new(),
            section: None,
        }
    }

    /// From another time on.
    #[must_use]
    pub const fn time(mut self, time: f64) -> Self {
        self.time = time;
        self
    }

    /// From another state.
    #[must_use]
    pub fn state(mut self, state: &SVector<f64, N>) -> Self {
        self.start.state = *state;
        self
    }

    /// From another input.
    #[must_use]
    pub fn input(mut self, input: &[f64; M]) -> Self {
        self.start.input = SVector::from(*input);
        self
    }

    /// States or inputs that stay as they are in the guess.
    #[must_use]
    pub fn fix(mut self, name: &'static str) -> Self {
        self.selection.fix(S::META, name);
        self
    }

    /// States that need not come back, such as positions in flight.
    #[must_use]
    pub fn free(mut self, name: &'static str) -> Self {
        self.selection.change(S::META, name, None);
        self
    }

    /// States that do not come back but are larger by this after a period, such as an angle by a turn, or an integral.
    #[must_use]
    pub fn grows(mut self, name: &'static str, by: f64) -> Self {
        self.selection.change(S::META, name, Some(by));
        self
    }

    /// The period is found, too: after half to twice the one that was given, this state is for the first time what it is in the guess,
    /// going the same way. A motion that nothing drives may begin at any time, of which this is one; choose a state that the motion
    /// goes through.
    #[must_use]
    pub fn find_period(mut self, state: &'static str) -> Self {
        self.section = S::META.states.iter().position(|it| it.name == state);
        self.selection.know(self.section.is_some(), "state", state);
        if self.section.is_some() {
            self.selection.fix(S::META, state);
        }
        self
    }

    /// Finds the motion.
    ///
    /// # Errors
    ///
    /// A name that the model has not, a motion from the guess that cannot go on, one on which the state that tells the period is not
    /// met again, one that does not come back: some state differs by more than a millionth of the terms it is made of, and by more
    /// than what rounding of the laws makes of it, or does not unless states that change alike differ otherwise, and one whose laws do
    /// not come back with it, since what drives it has another period.
    pub fn solve(&self) -> Result<Cycle<N, M>, Untrimmed> {
        self.search()
    }

    /// The condition that is farthest from being met, if it is not met.
    fn missed(
        &self,
        run: &Run<N, M>,
        slopes: &Slopes<N, M>,
        sizes: &Sizes<N, M>,
    ) -> Option<Untrimmed> {
        if let Some(place) = self.section
            && matches!(
                run.strokes[place].partial_cmp(&(LEFT * sizes.0[place])),
                None | Some(Ordering::Less)
            )
        {
            return Some(self.away(place));
        }
        let mut rows = self.rows(run, slopes);
        let seen = rows.seen(sizes, TINY, &SMatrix::identity());
        // NaN is the worst, whatever its sign. What nothing has an influence on is compared with the state itself.
        let parts = rows
            .iter()
            .zip(&run.left)
            .zip(&sizes.0)
            .map(|((row, left), size)| {
                if row.is_empty() && *left != 0.0 {
                    left.abs() / size
                } else {
                    row.part_left(&seen).abs()
                }
            });
        let (row, left) = parts.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        if matches!(left.partial_cmp(&LEFT), Some(Ordering::Less)) {
            return None;
        }
        rows.fix(&self.selection.fixed);
        let wanted = self.wanted(row).unwrap_or(0.0);
        Some(Untrimmed::Open {
            name: S::META.states.get(row).map_or("", |it| it.name),
            wanted,
            reached: wanted + run.left.get(row).unwrap_or(&0.0),
            is_fixed: rows.iter().nth(row).is_some_and(Row::is_empty),
        })
    }

    /// Whether the laws are others a period later, at states that are larger by their growth: then the next period is another one.
    fn driven_otherwise(&self, run: &Run<N, M>) -> Result<Option<Untrimmed>, Untrimmed> {
        let grown = SVector::from(self.selection.changes.map(|by| by.unwrap_or(0.0)));
        if S::AUTONOMOUS && grown.iter().all(|by| *by == 0.0) {
            return Ok(None);
        }
        let Trimmed { state, input } = run.start;
        // By how much each state would change otherwise within a period: laws need not jump at the same times to a rounding.
        let mut changes = SVector::<f64, N>::zeros();
        let mut rounded = changes;
        let add = |[start, end]: [f64; 2], state: &SVector<f64, N>| {
            let point = Trimmed {
                state: state + grown,
                input,
            };
            rounded += self.rounded([start, end].map(|time| time + run.period), &point);
            let part = (end - start) / f64::from(COMPARED);
            for number in 0..COMPARED {
                let time = start + (f64::from(number) + 0.5) * part;
                let [now, later] = [(time, *state), (time + run.period, point.state)]
                    .map(|(time, state)| self.derivative(time, &state, &input));
                changes += part * (later - now).abs();
            }
        };
        self.follow(self.system, &state, &Constant(input), self.section, add)?;
        let changes = changes.zip_map(&rounded, rounding::beyond);
        let parts = changes.zip_map(&run.sizes.0, |change, size| change / size);
        let worst = parts.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        Ok(worst.and_then(|(place, part)| {
            (*part > LEFT).then(|| Untrimmed::Driven {
                name: S::META.states.get(place).map_or("", |it| it.name),
                period: run.period,
                change: changes[place],
            })
        }))
    }

    fn derivative(
        &self,
        time: f64,
        state: &SVector<f64, N>,
        input: &SVector<f64, M>,
    ) -> SVector<f64, N> {
        self.system
            .derivative(time, state, input, &mut Default::default())
    }

    /// By how much a state is to grow, unless it need not, or does where the motion ends.
    fn wanted(&self, state: usize) -> Option<f64> {
        let wanted = self.selection.changes.get(state).copied().flatten();
        wanted.filter(|_| self.section != Some(state))
    }

    /// Follows the motion until it is to come back: when that is, and the state.
    fn follow<T: Real>(
        &self,
        system: &impl System<T, N, M, P>,
        start: &SVector<T, N>,
        input: &Constant<T, M>,
        section: Option<usize>,
        mut observer: impl FnMut([T; 2], &SVector<T, N>),
    ) -> Result<(T, SVector<T, N>), Untrimmed> {
        let begin = T::from_f64(self.time);
        let [half, whole, twice] =
            [0.5, 1.0, 2.0].map(|periods| T::from_f64(self.time + periods * self.period));
        let mut state = *start;
        let until = if section.is_some() { half } else { whole };
        let done = self
            .solver
            .integrate(system, input, begin, until, state, |step| {
                state = *step.state();
                observer([step.start(), step.end()], &state);
            });
        done.map_err(Untrimmed::Stopped)?;
        let Some(place) = section else {
            return Ok((whole, state));
        };
        let slope = system.derivative(begin, start, &input.0, &mut Default::default())[place];
        let direction = match slope.find(|slope| slope < 0.0) {
            Some(_) => Direction::Falling,
            None => Direction::Rising,
        };
        let grown = T::from_f64(self.selection.changes[place].unwrap_or(0.0));
        let guard = |_, state: &SVector<T, N>| state[place] - (start[place] + grown);
        let arrival = self.solver.until(
            system,
            input,
            half,
            twice,
            state,
            (direction, guard),
            |step| observer([step.start(), step.end()], step.state()),
        );
        let arrival = arrival.map_err(Untrimmed::Stopped)?;
        match arrival.found {
            true => Ok((arrival.time, arrival.state)),
            false => Err(self.away(place)),
        }
    }

    /// Of a state that is not met again.
    fn away(&self, place: usize) -> Untrimmed {
        Untrimmed::Away {
            name: S::META.states.get(place).map_or("", |it| it.name),
            value: self.start.state[place],
        }
    }

    /// Follows the motion once, from a start on closed loops and attitudes.
    fn run(&self, start: Trimmed<N, M>) -> Result<Run<N, M>, Untrimmed> {
        let start = self.selection.closed(self.system, self.time, start)?;
        let mut largest = start.state.abs();
        let mut strokes = SVector::<f64, N>::zeros();
        let input = Constant(start.input);
        let larger = |_, state: &SVector<f64, N>| {
            largest = largest.sup(&state.abs());
            strokes = strokes.sup(&(state - start.state).abs());
        };
        let (until, end) = self.follow(self.system, &start.state, &input, self.section, larger)?;
        let mut left = end - start.state;
        for (row, left) in left.iter_mut().enumerate() {
            *left = self.wanted(row).map_or(0.0, |wanted| *left - wanted);
        }
        Ok(Run {
            start,
            period: until - self.time,
            left,
            sizes: (largest, start.input.abs()),
            strokes,
        })
    }

    /// How the end of a motion changes with state and input at its start, by steps on dual numbers.
    fn slopes(
        &self,
        start: &Trimmed<N, M>,
        section: Option<usize>,
    ) -> Result<Slopes<N, M>, Untrimmed> {
        let (by_state, _) = self.slopes_by_state(start, section)?;
        let mut by_input = SMatrix::zeros();
        let state = start.state.map(Dual::unchanging);
        for first in (0..M).step_by(TOGETHER) {
            let end = self.end_with_slopes(&state, along(&start.input, first), section)?;
            keep_slopes(&mut by_input, first, &end);
        }
        Ok((by_state, by_input))
    }

    /// How it changes with the state alone, and the end itself.
    fn slopes_by_state(
        &self,
        start: &Trimmed<N, M>,
        section: Option<usize>,
    ) -> Result<(SMatrix<f64, N, N>, SVector<f64, N>), Untrimmed> {
        let (mut by_state, mut last) = (SMatrix::zeros(), start.state);
        let input = start.input.map(Dual::unchanging);
        for first in (0..N).step_by(TOGETHER) {
            let end = self.end_with_slopes(&along(&start.state, first), input, section)?;
            keep_slopes(&mut by_state, first, &end);
            last = end.map(|it| it.value);
        }
        Ok((by_state, last))
    }

    fn end_with_slopes(
        &self,
        state: &SVector<Several, N>,
        input: SVector<Several, M>,
        section: Option<usize>,
    ) -> Result<SVector<Several, N>, Untrimmed> {
        let system = self.system.converted(Several::unchanging);
        let (_, end) = self.follow(&system, state, &Constant(input), section, |_, _| ())?;
        Ok(end)
    }

    /// The start, or where it is a little later if it is on a threshold of a law: that is then met at the end, and only there.
    fn off_thresholds(&self, run: &Run<N, M>) -> Result<(f64, Trimmed<N, M>), Untrimmed> {
        let Trimmed { state, input } = run.start;
        let slope = self.derivative(self.time, &state, &input);
        let [before, behind] = [-1.0, 1.0].map(|sign| {
            let way = sign * BESIDE * run.period;
            (self.time + way, state + way * slope)
        });
        let (mut is_on, rest) = (false, SVector::zeros());
        self.system.courses(
            (before.0, [&before.1, &slope], [&input, &rest]),
            (behind.0, [&behind.1, &slope], [&input, &rest]),
            &mut Default::default(),
            |course| is_on |= course.reached(behind.0 - before.0).is_some(),
        );
        if !is_on {
            return Ok((self.time, run.start));
        }
        let begin = Self {
            period: LATER * run.period,
            ..*self
        };
        let (time, state) = begin.follow(self.system, &state, &Constant(input), None, |_, _| ())?;
        Ok((time, Trimmed { state, input }))
    }

    /// Whether slopes take how a motion that swings by itself begins to how it goes on, as they do unless it stays where a law jumps.
    fn leads_along(
        &self,
        (start, end): (&Trimmed<N, M>, &SVector<f64, N>),
        strokes: &SVector<f64, N>,
        monodromy: &SMatrix<f64, N, N>,
    ) -> bool {
        let first = self.derivative(self.time, &start.state, &start.input);
        let last = self.derivative(self.time + self.period, end, &start.input);
        let terms = monodromy.abs() * first.abs() + last.abs() + strokes / self.period;
        let aside = (monodromy * first - last).abs();
        let is_known = S::AUTONOMOUS && self.section.is_some();
        !is_known
            || aside
                .iter()
                .zip(&terms)
                .all(|(aside, terms)| *aside <= ASIDE * terms)
    }

    /// The conditions next to a motion.
    fn rows(&self, run: &Run<N, M>, slopes: &Slopes<N, M>) -> Rows<N, M, 0> {
        let mut by_state = slopes.0 - SMatrix::identity();
        let sizes = &run.sizes.0;
        for (column, mut slopes) in by_state.column_iter_mut().enumerate() {
            slopes.zip_apply(sizes, |slope, size| {
                let influence = slope.abs() * sizes[column];
                if influence > 0.0 && influence <= NOISE * size {
                    *slope = 0.0;
                }
            });
        }
        let rows = core::array::from_fn(|row| match self.wanted(row) {
            Some(_) => Row::new(
                by_state.row(row).transpose(),
                slopes.1.row(row).transpose(),
                run.left[row],
            ),
            None => Row::empty(),
        });
        let mut rows = Rows::new(rows, []);
        let states = (&run.start.state, &self.start.state);
        rows.keep_differences(&self.selection.kept, states, ALIKE);
        rows
    }

    /// A motion that comes back better, if there is one.
    fn descend(
        &self,
        run: &Run<N, M>,
        slopes: &Slopes<N, M>,
        units: &mut Sizes<N, M>,
        dampings: usize,
    ) -> Option<Run<N, M>> {
        let identity = SMatrix::identity();
        let mut rows = self.rows(run, slopes);
        rows.fix(&self.selection.fixed);
        rows.balance(&identity);
        rows.limit(units);
        let (weights, _) = rows.weights();
        let size = |run: &Run<N, M>| run.left.component_mul(&weights).norm_squared();
        let before = size(run);
        if before == 0.0 {
            return None;
        }
        rows.straighten(&identity);
        let halves = core::iter::successors(Some(1.0), |damping| Some(0.5 * damping));
        let mut tried = halves
            .take(dampings)
            .flat_map(|damping| PARTS.map(|part| (damping, part)));
        tried.find_map(|(damping, part)| {
            let (by_state, by_input) = rows.solution(part);
            let next = self.run(Trimmed {
                state: run.start.state - damping * by_state,
                input: run.start.input - damping * by_input,
            });
            let next = next.ok()?;
            (size(&next) < (1.0 - 0.5 * damping) * before).then_some(next)
        })
    }
}

impl<S, A, const N: usize, const M: usize, const P: usize> Search<S, N, M, P>
    for PeriodicTrim<'_, S, A, N, M, P>
where
    S: Convertible<f64, N, M, P>,
    A: Integrator<N>,
{
    type Found = Cycle<N, M>;
    const APART: f64 = LEFT;

    fn asked(&self) -> Asked<'_, S, N, M> {
        Asked {
            system: self.system,
            time: self.time,
            start: self.start,
            selection: self.selection,
        }
    }

    fn choosing(&self, selection: Selection<N, M>) -> Self {
        Self { selection, ..*self }
    }

    fn without_targets(&self) -> Self {
        self.choosing(self.selection.without_targets(self.section))
    }

    fn point(&Cycle { state, input, .. }: &Cycle<N, M>) -> Trimmed<N, M> {
        Trimmed { state, input }
    }

    fn found(&self, from: Trimmed<N, M>) -> Result<Cycle<N, M>, Untrimmed> {
        if self.period <= 0.0 {
            return Err(Untrimmed::Stopped(Stopped {
                time: self.time,
                cause: Cause::Argument("the period must be larger than zero"),
            }));
        }
        let infinite = f64::INFINITY;
        let mut units: Sizes<N, M> = (SVector::repeat(infinite), SVector::repeat(infinite));
        let mut run = self.run(from)?;
        let mut sizes = run.sizes;
        let mut slopes = self.slopes(&run.start, self.section)?;
        for number in 0..CORRECTIONS {
            // What comes back already is left by whole corrections, which square what is left, or not at all: the rest is rounding.
            let dampings = match self.missed(&run, &slopes, &sizes) {
                Some(_) => DAMPINGS,
                None => 1,
            };
            if (number == 0 || dampings == 1)
                && self.beyond_rounding(&run) == SVector::<f64, N>::zeros()
            {
                break;
            }
            let Some(next) = self.descend(&run, &slopes, &mut units, dampings) else {
                break;
            };
            run = next;
            sizes.0 = sizes.0.sup(&run.sizes.0);
            sizes.1 = sizes.1.sup(&run.sizes.1);
            slopes = self.slopes(&run.start, self.section)?;
        }
        if self.missed(&run, &slopes, &sizes).is_some() {
            // Only then, for it takes as long as a correction.
            run.left = self.beyond_rounding(&run);
            if let Some(untrimmed) = self.missed(&run, &slopes, &sizes) {
                return Err(untrimmed);
            }
        }
        if let Some(untrimmed) = self.driven_otherwise(&run)? {
            return Err(untrimmed);
        }
        let (time, start) = self.off_thresholds(&run)?;
        let from = Self {
            time,
            period: run.period,
            ..*self
        };
        let (mut monodromy, end) = from.slopes_by_state(&start, None)?;
        if !from.leads_along((&start, &end), &run.strokes, &monodromy) {
            monodromy.fill(f64::NAN);
        }
        Ok(Cycle {
            state: run.start.state,
            input: run.start.input,
            period: run.period,
            monodromy,
        })
    }
}
