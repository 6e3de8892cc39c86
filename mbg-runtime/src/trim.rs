//! States and inputs at which a model does what is wanted of it: rests, hovers, turns steadily.

use core::cmp::Ordering;

use nalgebra::{SMatrix, SVector};

use crate::beside::{BESIDE, ROUNDING, aside};
use crate::meta::is_named;
use crate::search::{Asked, Search};
use crate::selection::Selection;
use crate::solve::{Row, Rows, Sizes};
use crate::{Convertible, Linearised, Trouble, Untrimmed};

/// Points at which the model is linearised at most.
const ITERATIONS: usize = 60;
/// Dampings of one correction at most; the last one is below 1e-7.
const DAMPINGS: usize = 24;
/// Where no longer part of a correction does, two are tried.
const SLOW: f64 = 0.1;
/// Dampings of the first of them.
const BENDS: [f64; 3] = [0.5, 0.25, 0.125];
/// What is left out of a correction, in units of what matters most: first what may be an error of tangents.
const PARTS: [f64; 4] = [1e-4, 1e-6, 1e-9, 1e-12];
/// How far beside a state its neighbours are closed, in units of the state: the cube root of the precision.
const ASIDE: f64 = 6e-6;
/// What may be left of a condition beside its terms.
const LEFT: f64 = 1e-11;
/// Nothing counts as smaller, beside what would be as much as all else of a condition: terms may be zero.
const TINY: f64 = 1e-9;
/// Guesses at most that begin elsewhere, where what is to be chosen has an influence.
const ELSEWHERE: usize = 4;
/// The first place that is tried is nearer than that by this part of itself or of its unit, and all others twice as far each.
const NEAREST: f64 = 1e-6;
const DOUBLINGS: usize = 40;
/// How often a way from where there is none is halved.
const HALVINGS: usize = 60;
/// How far beside a state is what tells how exactly it is closed, in units of the state.
const LITTLE: f64 = 1e-8;
/// A state is closed to this where constraints do not depend on each other, in its unit.
const OPEN: f64 = 1e-12;
/// By what part of itself an input may be in error by what is left open.
const TORN: f64 = 1e-3;
/// Slopes of states that change alike differ by no more than this part: by rounding.
const SAME: f64 = 8.0 * f64::EPSILON;
/// What such states differ by may change by this part of them: by rounding, too.
const APART: f64 = 1e-9;

/// Finds an operating point: a state and an input at which rates and outputs have wanted values, to rest at, to start from, and to
/// linearise at.
///
/// All rates are wanted to be zero, unless told otherwise: a position in flight is [`free`](Trim::free) to change, and in a
/// steady turn a rate has a [value](Trim::rate). Every state and input may be chosen unless it is [fixed](Trim::fix). Each
/// [`output`](Trim::output) with a wanted value decides one of them. States, inputs and outputs go by their names, and several at
/// once by what their names begin with: `"free.position"` is all of `free.position.x` to `.z`.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Linearised, System, Trim, mbg};
///
/// mbg! {
///     /// A pendulum pushed by a torque.
///     model Pendulum {
///         input torque: N*m;
///         1 joint {
///             I rod { inertia: 0.5 }
///             C weight { effort: 20.0 * sin(q), initial: 0.5 }
///             R bearing { resistance: 0.2 }
///             Se push { effort: torque }
///         }
///         output angle: rad = weight.q;
///     }
/// }
///
/// let pendulum = Pendulum::<f64>::new(PendulumParameters::default())?;
/// // The torque that holds it where it starts.
/// let still = Trim::new(&pendulum).fix("weight.q").solve()?;
/// assert!((still.input[0] - 20.0 * f64::sin(0.5)).abs() < 1e-12);
/// // The angle at which 10 N*m hold it.
/// let pushed = Trim::new(&pendulum).input(&[10.0]).fix("torque").solve()?;
/// assert!((pushed.state[1] - f64::asin(0.5)).abs() < 1e-12);
/// // What its weight does for a small angle more, next to that.
/// let linear = Linearised::of(&pendulum, 0.0, &pushed.state, &pushed.input)?;
/// assert!((linear.state[(0, 1)] + 20.0 * f64::cos(pushed.state[1])).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Which point is found
///
/// The point is found by the method of Gauss and Newton with the model's own Jacobians, damped until the residual of the conditions
/// falls.
///
/// - Of several points, the guess decides which is found: a pendulum may hang or stand.
/// - Where more may be chosen than is asked for, as with an elevator and a canard for one moment, each correction is the one of
///   least norm, in units of what states and inputs do.
/// - Corrections follow closed loops and attitudes ([`System::close`](crate::System::close)). A ring of joints without a `Cut` is
///   no such loop: each of its coordinates is moved by itself, and the ring may be open at the point that is found. Put a `Cut` in
///   the place of one of its joints, or make the distance of its ends an output that is wanted to be zero.
/// - Where two states change alike whatever is done, such as the displacements of two springs at one junction, their difference
///   stays as it is in the guess, unless one of them is fixed, free or given a rate. No motion reaches a point with another
///   difference, such as one beyond the voltage at which a plate is pulled in: [`Untrimmed::Apart`]. It is taken only if outputs,
///   rates or fixed states ask for it, while without them there is a point with the differences of the guess.
/// - An input beyond a limiter has no influence, nor has the height of what does not touch the ground. Where conditions are not met
///   and so it is, the search begins again, with that at the nearest place where it has one.
/// - Dry friction by `sign(f)` counts as zero at rest, so that no point is found that friction alone holds. A run finds where it
///   comes to rest, and a law that rises over a width, such as `tanh(f / width)`, has such points.
///
/// # Motions that are periodic
///
/// The conditions hold at one time. What is free to change, or has a rate, may influence them, and a moment later they hold no
/// more: blades of a rotor swing in forward flight, and with the angle of its shaft [`free`](Trim::free) a point is found at which
/// they stand still, which is no flight. [`PeriodicTrim`](crate::PeriodicTrim) finds a motion that comes back after a turn.
#[derive(Clone, Copy, Debug)]
pub struct Trim<'a, S, const N: usize, const M: usize, const P: usize> {
    system: &'a S,
    time: f64,
    start: Trimmed<N, M>,
    /// With the rate of each state as its change.
    selection: Selection<N, M>,
    outputs: [Option<f64>; P],
}

/// An operating point: see [`Trim`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trimmed<const N: usize, const M: usize> {
    /// The state.
    pub state: SVector<f64, N>,
    /// The input.
    pub input: SVector<f64, M>,
}

impl<const N: usize, const M: usize> Trimmed<N, M> {
    /// A state or, behind these, an input.
    fn unknown(&self, number: usize) -> f64 {
        let mut unknowns = self.state.iter().chain(&self.input);
        unknowns.nth(number).copied().unwrap_or(f64::NAN)
    }

    /// The point with another one.
    fn with(mut self, number: usize, unknown: f64) -> Self {
        let mut unknowns = self.state.iter_mut().chain(&mut self.input);
        if let Some(place) = unknowns.nth(number) {
            *place = unknown;
        }
        self
    }
}

/// What is left of rates and of outputs.
type Left<const N: usize, const P: usize> = (SVector<f64, N>, SVector<f64, P>);

impl<'a, S, const N: usize, const M: usize, const P: usize> Trim<'a, S, N, M, P>
where
    S: Convertible<f64, N, M, P>,
{
    /// Guesses the model's initial state with inputs of zero, at time zero. Every rate is to be zero, and everything may be chosen.
    #[must_use]
    pub fn new(system: &'a S) -> Self {
        Self {
            system,
            time: 0.0,
            start: Trimmed {
                state: system.initial_state(),
                input: SVector::zeros(),
            },
            selection: Selection::new(),
            outputs: [None; P],
        }
    }

    /// Takes another time.
    #[must_use]
    pub const fn time(mut self, time: f64) -> Self {
        self.time = time;
        self
    }

    /// Guesses another state.
    #[must_use]
    pub fn state(mut self, state: &SVector<f64, N>) -> Self {
        self.start.state = *state;
        self
    }

    /// Guesses another input.
    #[must_use]
    pub fn input(mut self, input: &[f64; M]) -> Self {
        self.start.input = SVector::from(*input);
        self
    }

    /// Fixes states or inputs: they stay as they are in the guess.
    #[must_use]
    pub fn fix(mut self, name: &'static str) -> Self {
        self.selection.fix(S::META, name);
        self
    }

    /// Frees states: their rates do not matter, such as those of positions in flight.
    #[must_use]
    pub fn free(mut self, name: &'static str) -> Self {
        self.selection.change(S::META, name, None);
        self
    }

    /// Wants another rate than zero of states, in units of the state per second.
    #[must_use]
    pub fn rate(mut self, name: &'static str, rate: f64) -> Self {
        self.selection.change(S::META, name, Some(rate));
        self
    }

    /// Wants a value of outputs.
    #[must_use]
    pub fn output(mut self, name: &'static str, value: f64) -> Self {
        let mut found = false;
        for (output, variable) in self.outputs.iter_mut().zip(S::META.outputs) {
            if is_named(variable.name, name) {
                (*output, found) = (Some(value), true);
            }
        }
        self.selection.know(found, "output", name);
        self
    }

    /// Finds the point.
    ///
    /// # Errors
    ///
    /// A name that the model does not have, conditions that cannot be met from the guess, or only with other differences between
    /// states that change alike, a point where constraints depend on each other, and what [`System::close`](crate::System::close)
    /// and [`System::trouble`](crate::System::trouble) say of a state.
    pub fn solve(&self) -> Result<Trimmed<N, M>, Untrimmed> {
        // From there no way leads back.
        match Trouble::of_input(S::META, &self.start.input) {
            Some(trouble) => Err(Untrimmed::Trouble(trouble)),
            None => self.search(),
        }
    }

    /// An input that is as arbitrary as forces are where constraints depend on each other: closing leaves states open by more than
    /// their last digits, and so much of a condition that no other input can be told from it.
    fn singular(
        &self,
        point: &Trimmed<N, M>,
        (rows, rounding): (&Rows<N, M, P>, &Left<N, P>),
    ) -> Option<Untrimmed> {
        if S::META.closures.is_empty() {
            return None;
        }
        let tangents = self.tangents(point);
        let mut open = SVector::<f64, N>::zeros();
        for number in (0..N).filter(|number| !self.selection.fixed.0[*number]) {
            let aside = LITTLE * point.state[number].abs().max(1.0);
            let mut moved = *point;
            moved.state[number] += aside;
            // What cannot be closed is open by that.
            let expected = point.state + aside * tangents.column(number);
            let left = match self.closed(moved) {
                Ok(closed) => closed.state - expected,
                Err(_) => moved.state - point.state,
            };
            open.zip_apply(&left, |open: &mut f64, left: f64| {
                *open = open.max(left.abs())
            });
        }
        open.zip_apply(&point.state, |open, state| {
            if *open < OPEN * state.abs().max(1.0) {
                *open = 0.0;
            }
        });
        let sizes = (open, SVector::zeros());
        let mut inputs = (0..M).filter(|input| !self.selection.fixed.1[*input]);
        inputs.find_map(|input| {
            let rounding = rounding.0.iter().chain(&rounding.1);
            let errors = rows.iter().zip(rounding);
            let errors = errors.filter_map(|(row, rounding)| row.error(input, &sizes, *rounding));
            let error = errors.min_by(f64::total_cmp)?;
            let here = point.input[input];
            (error > TORN * here.abs()).then(|| Untrimmed::Singular {
                input: S::META.inputs.get(input).map_or("", |it| it.name),
                here,
                error,
            })
        })
    }

    /// Why a condition cannot be met.
    fn missed(&self, point: &Trimmed<N, M>, row: usize, rows: &mut Rows<N, M, P>) -> Untrimmed {
        let (rates, outputs) = self.left(point);
        rows.fix(&self.selection.fixed);
        let is_output = row >= N;
        let (variables, lefts, wanted, place) = if is_output {
            (
                S::META.outputs,
                outputs.as_slice(),
                &self.outputs[..],
                row - N,
            )
        } else {
            (
                S::META.states,
                rates.as_slice(),
                &self.selection.changes[..],
                row,
            )
        };
        let wanted = wanted.get(place).copied().flatten().unwrap_or(0.0);
        Untrimmed::Missed {
            name: variables.get(place).map_or("", |it| it.name),
            is_output,
            wanted,
            reached: wanted + lefts.get(place).unwrap_or(&0.0),
            is_fixed: rows.iter().nth(row).is_some_and(Row::is_empty),
            idle: None,
        }
    }

    /// The point with its state on closed loops and attitudes.
    #[inline(never)]
    fn closed(&self, point: Trimmed<N, M>) -> Result<Trimmed<N, M>, Untrimmed> {
        self.selection.closed(self.system, self.time, point)
    }

    /// How the conditions change beside a point, and by how much they fail there.
    #[inline(never)]
    fn rows(
        &self,
        point: &Trimmed<N, M>,
        rounding: &Left<N, P>,
    ) -> Result<Rows<N, M, P>, Untrimmed> {
        // A slope that is not finite matters where it belongs to what is wanted.
        let linear = Linearised::unchecked(self.system, self.time, &point.state, &point.input)
            .map_err(Untrimmed::Trouble)?;
        let (rates, outputs) = beyond(rounding, self.left(point));
        let wanted = |wanted: Option<f64>, row| match wanted {
            Some(_) => row,
            None => Row::empty(),
        };
        let rates = core::array::from_fn(|row| {
            let by_state = linear.state.row(row).transpose();
            let by_input = linear.input.row(row).transpose();
            wanted(
                self.selection.changes[row],
                Row::new(by_state, by_input, rates[row]),
            )
        });
        let outputs = core::array::from_fn(|row| {
            let by_state = linear.output.row(row).transpose();
            let by_input = linear.feedthrough.row(row).transpose();
            wanted(
                self.outputs[row],
                Row::new(by_state, by_input, outputs[row]),
            )
        });
        let mut rows = Rows::new(rates, outputs);
        let states = (&point.state, &self.start.state);
        rows.keep_differences(&self.selection.kept, states, SAME);
        Ok(rows)
    }

    /// What is left of the conditions.
    #[inline(never)]
    fn left(&self, point: &Trimmed<N, M>) -> Left<N, P> {
        let Trimmed { state, input } = point;
        let mut memory = S::Memory::default();
        let rates = self.system.derivative(self.time, state, input, &mut memory);
        let outputs = self.system.output(self.time, state, input, &mut memory);
        let left = |value, wanted: Option<f64>| wanted.map_or(0.0, |wanted| value - wanted);
        (
            rates.zip_map(&SVector::from(self.selection.changes), left),
            outputs.zip_map(&SVector::from(self.outputs), left),
        )
    }

    /// What of that may be rounding: how far apart values are next to each other.
    ///
    /// Slopes do not tell where summands cancel out whatever the point is, as in the moment on a platform that rods keep level.
    /// Points beside this one are compared with each other, and not with it, where a law may jump: of each number they lie on
    /// one side.
    #[inline(never)]
    fn rounding(&self, point: &Trimmed<N, M>) -> Left<N, P> {
        let at = |beside| {
            self.left(&Trimmed {
                state: (point.state).map_with_location(|number, _, x| aside(beside, number, x)),
                input: (point.input).map_with_location(|number, _, u| aside(beside, N + number, u)),
            })
        };
        let mut least = at(0);
        let mut most = least;
        for (rates, outputs) in (1..BESIDE).map(at) {
            least = (least.0.inf(&rates), least.1.inf(&outputs));
            most = (most.0.sup(&rates), most.1.sup(&outputs));
        }
        (ROUNDING * (most.0 - least.0), ROUNDING * (most.1 - least.1))
    }

    /// Where corrections lead to from a point, and what is missed there.
    fn descended(
        &self,
        from: Trimmed<N, M>,
    ) -> Result<(Trimmed<N, M>, Option<Untrimmed>), Untrimmed> {
        let mut point = self.closed(from)?;
        let mut sizes: Sizes<N, M> = (SVector::zeros(), SVector::zeros());
        let larger = |size: &mut f64, number: f64| *size = size.max(number.abs());
        let infinite = f64::INFINITY;
        let mut units: Sizes<N, M> = (SVector::repeat(infinite), SVector::repeat(infinite));
        for _ in 0..ITERATIONS {
            sizes.0.zip_apply(&point.state, larger);
            sizes.1.zip_apply(&point.input, larger);
            let rounding = self.rounding(&point);
            let mut rows = self.rows(&point, &rounding)?;
            match self.descend(&point, &mut rows, &rounding, &mut units) {
                Some(next) => point = next,
                None => break,
            }
        }
        let rounding = self.rounding(&point);
        let mut rows = self.rows(&point, &rounding)?;
        let seen = rows.seen(&sizes, TINY, &self.tangents(&point));
        // NaN is the worst, whatever its sign.
        let parts = rows.iter().map(|row| row.part_left(&seen).abs());
        let worst = parts.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            // NaN is not small.
            Some((row, left)) if !matches!(left.partial_cmp(&LEFT), Some(Ordering::Less)) => {
                Ok((point, Some(self.missed(&point, row, &mut rows))))
            }
            _ => self
                .singular(&point, (&rows, &rounding))
                .map_or(Ok((point, None)), Err),
        }
    }

    /// The point with what has no influence there moved to the nearest place where it has: into the range of a limiter, or into a
    /// contact. With the name of the first of it.
    #[inline(never)]
    fn elsewhere(&self, point: &Trimmed<N, M>) -> Option<(Trimmed<N, M>, &'static str)> {
        let (states, inputs) = self.selection.fixed;
        let fixed = states.into_iter().chain(inputs);
        let idle = fixed
            .enumerate()
            .filter(|(number, is_fixed)| !is_fixed && !self.has_influence(point, *number));
        let mut elsewhere = *point;
        let mut first = None;
        for (number, _) in idle {
            if let Some(place) = self.influential(point, number) {
                elsewhere = elsewhere.with(number, place);
                first = first.or(S::META.states.iter().chain(S::META.inputs).nth(number));
            }
        }
        Some((self.closed(elsewhere).ok()?, first?.name))
    }

    /// The place nearest to a point at which a state or an input has an influence, if there is one where the range of a law begins.
    fn influential(&self, point: &Trimmed<N, M>, number: usize) -> Option<f64> {
        let (here, left) = (point.unknown(number), self.left(point));
        let is_same = |place| self.left(&point.with(number, place)) == left;
        let nearest = NEAREST * here.abs().max(1.0);
        let distances = core::iter::successors(Some(nearest), |distance| Some(2.0 * distance));
        let mut ways = distances
            .take(DOUBLINGS)
            .flat_map(|distance| [-distance, distance]);
        let way = ways.find(|way| !is_same(here + way))?;
        // The range may be narrow, and lie in between.
        let (mut near, mut far) = (here + 0.5 * way, here + way);
        for _ in 0..HALVINGS {
            if self.has_influence(&point.with(number, far), number) {
                return Some(far);
            }
            let between = 0.5 * (near + far);
            match is_same(between) {
                true => near = between,
                false => far = between,
            }
        }
        None
    }

    /// Whether conditions change with a state or an input there.
    fn has_influence(&self, point: &Trimmed<N, M>, number: usize) -> bool {
        let rounding = (SVector::zeros(), SVector::zeros());
        let rows = self.rows(point, &rounding);
        rows.is_ok_and(|rows| rows.iter().any(|row| row.entry(number) != 0.0))
    }

    /// A point at which less is left of the conditions, if there is one.
    fn descend(
        &self,
        point: &Trimmed<N, M>,
        rows: &mut Rows<N, M, P>,
        rounding: &Left<N, P>,
        units: &mut Sizes<N, M>,
    ) -> Option<Trimmed<N, M>> {
        let tangents = self.tangents(point);
        rows.fix(&self.selection.fixed);
        rows.balance(&tangents);
        rows.limit(units);
        let weights = rows.weights();
        let size = |point: &Trimmed<N, M>| {
            // Rounding of one condition must not hide what is left of another one.
            let (rates, outputs) = beyond(rounding, self.left(point));
            rates.component_mul(&weights.0).norm_squared()
                + outputs.component_mul(&weights.1).norm_squared()
        };
        let before = size(point);
        if before == 0.0 {
            return None;
        }
        rows.straighten(&tangents);
        let dampings = core::iter::successors(Some(1.0), |damping| Some(0.5 * damping));
        let mut tried = dampings
            .take(DAMPINGS)
            .flat_map(|damping| PARTS.map(|part| (damping, part)));
        let damped = tried.find_map(|(damping, part)| {
            let next = self.corrected(point, rows, damping, part).ok()?;
            let left = size(&next);
            (left < (1.0 - 0.5 * damping) * before).then_some((next, damping, left))
        });
        match damped {
            Some((next, damping, _)) if damping > SLOW => Some(next),
            _ => {
                let most = damped.map_or(before, |(.., left)| left);
                let whole = PARTS.map(|part| (1.0, part));
                let mut tried = whole
                    .into_iter()
                    .chain(BENDS.map(|damping| (damping, PARTS[3])));
                let ahead = tried.find_map(|(damping, part)| {
                    let next = self.twice(point, rows, (rounding, *units), (damping, part))?;
                    let left = size(&next);
                    (left < most && left < (1.0 - 0.5 * damping) * before).then_some(next)
                });
                ahead.or(damped.map(|(next, ..)| next))
            }
        }
    }

    /// The point behind a part of a correction by equations at right angles.
    fn corrected(
        &self,
        point: &Trimmed<N, M>,
        rows: &Rows<N, M, P>,
        damping: f64,
        part: f64,
    ) -> Result<Trimmed<N, M>, Untrimmed> {
        let (by_state, by_input) = rows.solution(part);
        // Where a step too long leads to what the model does not reach a shorter one may do.
        self.closed(Trimmed {
            state: point.state - damping * by_state,
            input: point.input - damping * by_input,
        })
    }

    /// The point behind two corrections, of which the first may be damped and the second then leads back alone.
    ///
    /// Where one condition hardly changes with what is chosen, such as the moment about the vertical with the heading of a craft
    /// that leans, a correction of it bends away from all others by more than it gains, and the next one leads back.
    #[inline(never)]
    fn twice(
        &self,
        point: &Trimmed<N, M>,
        rows: &Rows<N, M, P>,
        (rounding, mut units): (&Left<N, P>, Sizes<N, M>),
        (damping, part): (f64, f64),
    ) -> Option<Trimmed<N, M>> {
        let ahead = self.corrected(point, rows, damping, part).ok()?;
        let mut rows = self.rows(&ahead, rounding).ok()?;
        let tangents = self.tangents(&ahead);
        rows.fix(&self.selection.fixed);
        rows.balance(&tangents);
        rows.limit(&mut units);
        rows.straighten(&tangents);
        let back = if damping < 1.0 { PARTS[0] } else { part };
        self.corrected(&ahead, &rows, 1.0, back).ok()
    }

    /// How a state that is closed again changes with each of its numbers.
    #[inline(never)]
    fn tangents(&self, point: &Trimmed<N, M>) -> SMatrix<f64, N, N> {
        let mut tangents = SMatrix::<f64, N, N>::identity();
        for (number, mut tangent) in tangents.column_iter_mut().enumerate() {
            if self.selection.fixed.0[number] {
                tangent.fill(0.0);
                continue;
            }
            let aside = ASIDE * point.state[number].abs().max(1.0);
            let beside = |aside: f64| {
                let mut moved = *point;
                moved.state[number] += aside;
                let closed = self.closed(moved).ok()?.state;
                Some((closed, closed == moved.state))
            };
            if let (Some((ahead, stays)), Some((behind, stayed))) = (beside(aside), beside(-aside))
                && !(stays && stayed)
            {
                tangent.copy_from(&((ahead - behind) / (2.0 * aside)));
            }
        }
        tangents
    }
}

impl<S, const N: usize, const M: usize, const P: usize> Search<S, N, M, P> for Trim<'_, S, N, M, P>
where
    S: Convertible<f64, N, M, P>,
{
    type Found = Trimmed<N, M>;
    const APART: f64 = APART;

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
        Self {
            selection: self.selection.without_targets(None),
            outputs: [None; P],
            ..*self
        }
    }

    fn point(found: &Trimmed<N, M>) -> Trimmed<N, M> {
        *found
    }

    fn found(&self, from: Trimmed<N, M>) -> Result<Trimmed<N, M>, Untrimmed> {
        let (mut point, mut missed) = self.descended(from)?;
        for _ in 0..ELSEWHERE {
            let Some((elsewhere, name)) = missed.and_then(|_| self.elsewhere(&point)) else {
                break;
            };
            // What is told is why the guess leads nowhere.
            if let Some(Untrimmed::Missed { idle, .. }) = &mut missed {
                idle.get_or_insert(name);
            }
            match self.descended(elsewhere) {
                Ok((next, None)) => return Ok(next),
                Ok((next, _)) => point = next,
                Err(_) => break,
            }
        }
        missed.map_or(Ok(point), Err)
    }
}

/// What is left beyond rounding.
fn beyond<const N: usize, const P: usize>(
    rounding: &Left<N, P>,
    (rates, outputs): Left<N, P>,
) -> Left<N, P> {
    // Written so that NaN is left.
    let beyond = |left: f64, rounding: f64| match left.abs() <= rounding {
        true => 0.0,
        false => left,
    };
    (
        rates.zip_map(&rounding.0, beyond),
        outputs.zip_map(&rounding.1, beyond),
    )
}

#[cfg(all(test, feature = "macros"))]
mod tests {
    use std::format;
    use std::string::ToString;

    use super::*;

    crate::mbg! {
        /// A small capacitor behind a resistor.
        model Charged {
            param small: F = 1e-15;
            param bias: V = 1e-6;
            input voltage: V;
            1 wire {
                Se source { effort: voltage + bias }
                R resistor { resistance: 1e3 }
                C capacitor { compliance: small }
            }
            output charge: C = capacitor.q;
        }
        /// Two conditions along a bend that hardly differ.
        model Bend {
            input across;
            input along;
            let bend = along - across * across;
            integral first = bend;
            integral second = bend + 1e-6 * (across - 1.0);
            output sums[2] = [first, second];
        }
        /// A mass on a spring that hardens within a length.
        model Pushed {
            param length: m = 1.0;
            input force: N;
            1 velocity {
                I body { inertia: 1.0 }
                C spring { effort: 2.0 * q + 3.0 / (length * length) * powi(q, 3) }
                R damper { resistance: 1.0 }
                Se push { effort: force }
            }
            output way: m = spring.q;
        }
    }

    #[test]
    fn small_states_meet_their_conditions_too() {
        for [small, bias] in [[1e-9, 1e-3], [1e-12, 1e-9], [1e-15, 1e-6], [1e-18, 1e-9]] {
            let model = Charged::<f64>::new(ChargedParameters { small, bias }).unwrap();
            let trim = Trim::new(&model).fix("voltage");
            let charge = trim.solve().unwrap().state[0];
            assert!((charge / (small * bias) - 1.0).abs() < 1e-12, "{charge:e}");
            // At rest it has no other charge.
            for other in [
                trim.fix("capacitor.q"),
                trim.output("charge", 0.3 * small * bias),
            ] {
                let missed = other.solve();
                assert!(matches!(missed, Err(Untrimmed::Missed { .. })), "{small:e}");
            }
        }
    }

    #[test]
    fn conditions_that_hardly_differ_along_a_bend_are_met() {
        let model = Bend::<f64>::new(BendParameters::default()).unwrap();
        for start in [[-1.0, 1.0], [3.0, 9.0], [3.0, 0.0], [100.0, 3.0]] {
            let met = Trim::new(&model).input(&start).solve().unwrap().input;
            // What is left of the difference is rounding of the bend.
            assert!((met - SVector::from([1.0, 1.0])).amax() < 1e-6, "{met}");
        }
    }

    #[test]
    fn rounding_of_a_force_hides_no_momentum() {
        for length in [1e-60, 1e-9, 1.0, 3.0, 1e9, 1e20, 1e40] {
            for part in [0.3, 0.5, 0.7, 0.9, 1.1] {
                let model = Pushed::<f64>::new(PushedParameters { length }).unwrap();
                let held = Trim::new(&model).output("way", part * length).solve();
                let force = held.unwrap().input[0] / length;
                let expected = 2.0 * part + 3.0 * part * part * part;
                assert!((force / expected - 1.0).abs() < 1e-12, "{length:e} {part}");
            }
        }
    }

    #[test]
    fn a_force_that_is_infinite_is_no_rest() {
        let model = Pushed::<f64>::new(PushedParameters::default()).unwrap();
        for force in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let trimmed = Trim::new(&model).input(&[force]).fix("force").solve();
            assert_eq!(
                trimmed.unwrap_err().to_string(),
                "input `force` is not finite"
            );
            let wanted = Trim::new(&model).output("way", force).solve();
            let told = wanted.unwrap_err().to_string();
            assert_eq!(told, format!("`way` is to be {force:e}, which nothing is"));
        }
    }
}
