//! What generated code refers to by whole paths. No part of the public interface.

pub mod locals;
mod sweeps;

use ::core::cell::Cell;

pub use core;
#[cfg(feature = "macros")]
pub use mbg_macros::expand;
pub use nalgebra::{SMatrix, SVector};

pub use crate::solve::ITERATIONS;
use crate::solve::project_from;
pub use crate::step::{Complex, Element, Shifted, holds, largest};
pub use crate::{
    Bond, Columns, Meta, Operations, ParameterError, Power, Real, Stroke, System, Trouble, Variable,
};
pub use sweeps::{columns, rows};

/// What the chosen causality relies on; each condition implies that the value is finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Neither infinite nor NaN.
    Finite,
    /// Finite and not zero, where the value is divided by; so is the reciprocal.
    NonZero,
    /// Finite and larger than zero; so is the reciprocal.
    Positive,
    /// Finite and not below zero.
    NotNegative,
}

/// Why a value is refused that is infinite or NaN, whatever else is asked of it.
const FINITE: &str = "it must be a finite number";
/// Why one is refused that is so small that what is divided by it is infinite.
const RECIPROCAL: &str = "its reciprocal must be a finite number";

/// Checks a parameter, or an expression of parameters, in every lane.
pub fn check<T: Real>(
    name: &'static str,
    value: T,
    condition: Condition,
    reason: &'static str,
) -> Result<(), ParameterError> {
    // In the precision of the scalar.
    let has_reciprocal = |lane: f64| {
        let reciprocal = T::from_f64(1.0) / T::from_f64(lane);
        reciprocal.magnitude().is_finite()
    };
    let broken = |lane: f64| match condition {
        _ if !lane.is_finite() => Some(FINITE),
        Condition::NonZero if lane == 0.0 => Some(reason),
        Condition::Positive if lane <= 0.0 => Some(reason),
        Condition::NotNegative if lane < 0.0 => Some(reason),
        Condition::NonZero | Condition::Positive if !has_reciprocal(lane) => Some(RECIPROCAL),
        _ => None,
    };
    match value.find(|lane| broken(lane).is_some()) {
        Some(value) => Err(ParameterError {
            name,
            value,
            reason: broken(value).unwrap_or(reason),
        }),
        None => Ok(()),
    }
}

/// How states change, and how inputs do.
#[inline]
pub fn joined<T: Real, const N: usize, const M: usize, const B: usize>(
    states: &SVector<T, N>,
    inputs: &SVector<T, M>,
) -> [T; B] {
    let mut both = [T::from_f64(0.0); B];
    for (place, change) in both.iter_mut().zip(states.iter().chain(inputs)) {
        *place = *change;
    }
    both
}

/// The first of these times, of all lanes, that is later than `t`, which is the same in all; with its slope. Those of `again`
/// come back, each after its period.
#[cold]
pub fn next_of<T: Real>(t: T, once: &[T], again: &[[T; 2]]) -> Option<T> {
    let now = crate::step::seen(t);
    let next = Cell::new(f64::INFINITY);
    let times = || {
        let again = again.iter().map(|repeated| next_again(t, *repeated));
        once.iter().copied().chain(again)
    };
    for time in times() {
        // None passes, so that each lane is looked at.
        let _ = time.find(|lane| {
            if lane > now && lane < next.get() {
                next.set(lane);
            }
            false
        });
    }
    let [whole, zero, tiny] = [next.get(), 0.0, f64::from(f32::MIN_POSITIVE)].map(T::from_f64);
    // What is left of that time itself is its slope alone.
    let slope = times().fold(zero, |slope, time| {
        let left = time - whole;
        left.abs().select_less(tiny, left, slope)
    });
    next.get().is_finite().then(|| whole + slope)
}

/// When what comes at a time, and again after each period, comes next; there is no first time of it.
fn next_again<T: Real>(t: T, [time, period]: [T; 2]) -> T {
    if crate::step::seen(t) == f64::NEG_INFINITY {
        return time;
    }
    let turns = (t - time) / period;
    let whole = turns - turns.fraction();
    let [next, after] = [1.0, 2.0].map(|more| time + (whole + T::from_f64(more)) * period);
    // Where it comes at `t` itself, the quotient may be rounded down.
    t.select_less(next, next, after)
}

/// How far beside a change the sides are looked at, in parts of the way to the next one.
const BESIDE: f64 = 1e-9;
/// The same in units of the last place.
const PLACES: f64 = 4.0;
/// So often a time is halved until no other number is left.
const HALVINGS: usize = 64;

/// The first time between two, in any lane, at which one of the differences has changed its sign or some turns have gone over a
/// whole number; with its slope.
#[cold]
pub fn change_between<T: Real, const G: usize, const H: usize>(
    from: T,
    to: T,
    at: impl Fn(T) -> ([T; G], [T; H]),
) -> Option<T> {
    let [from, to] = [from, to].map(crate::step::seen);
    let places = PLACES * T::EPSILON * from.abs().max(to.abs());
    let beside = places.max(BESIDE * (to - from));
    let (mut before, mut behind) = (from + beside, to - beside);
    let first = at(T::from_f64(before));
    let has_changed = |time: f64| {
        let (differences, turns) = at(T::from_f64(time));
        let mut products = first.0.iter().zip(differences).map(|(a, b)| *a * b);
        products.any(|product| product.find(|lane| lane < 0.0).is_some())
            || are_other_turns(&first.1, &turns)
    };
    if before >= behind || !has_changed(behind) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + behind);
        if !(before < middle && middle < behind) {
            break;
        }
        if has_changed(middle) {
            behind = middle;
        } else {
            before = middle;
        }
    }
    let (whole, zero) = (T::from_f64(behind), T::from_f64(0.0));
    let (differences, turns) = at(whole);
    let mut slope = zero;
    for (place, difference) in differences.into_iter().enumerate() {
        let own = whole.root_of(|t| at(t).0[place]) - whole;
        slope = (first.0[place] * difference).select_less(zero, own, slope);
    }
    for (place, turns) in turns.into_iter().enumerate() {
        let [low, high] = [first.1[place], turns].map(whole_turns);
        let level = low.max(high);
        let own = whole.root_of(|t| at(t).1[place] - level) - whole;
        slope = T::from_f64(0.5).select_less((high - low).abs(), own, slope);
    }
    Some(whole + slope)
}

/// Whether one of what laws compare is the smaller of two at one time and not at another, in any lane, or some turns have another
/// whole number below them.
#[cold]
pub fn has_changed<T: Real, const G: usize, const H: usize>(
    from: T,
    to: T,
    at: impl Fn(T) -> ([[T; 2]; G], [T; H]),
) -> bool {
    let [(compared, turns), (compared_then, turns_then)] = [from, to].map(at);
    let mut pairs = compared.iter().zip(&compared_then);
    let side = |pair: &[T; 2]| {
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        pair[0].select_less(pair[1], one, zero)
    };
    let differs = |a: T, b: T| (a - b).find(|it| it != 0.0).is_some();
    pairs.any(|(now, then)| differs(side(now), side(then))) || are_other_turns(&turns, &turns_then)
}

/// Whether other whole numbers are below some turns, in any lane.
fn are_other_turns<T: Real, const H: usize>(turns: &[T; H], then: &[T; H]) -> bool {
    let mut pairs = turns.iter().zip(then);
    pairs.any(|(now, then)| {
        let more = whole_turns(*then) - whole_turns(*now);
        more.find(|it| it.abs() > 0.5).is_some()
    })
}

/// The whole number below some turns, which has no slope.
fn whole_turns<T: Real>(turns: T) -> T {
    turns - turns.fraction()
}

/// Makes the states of an attitude, numbered by row, orthonormal again; one of which a state is fixed stays as it is.
#[inline]
pub fn orthonormal<T: Real, const N: usize, const R: usize, const C: usize>(
    mut x: SVector<T, N>,
    places: &[[usize; C]; R],
    fixed: &[usize],
) -> SVector<T, N> {
    if places.iter().flatten().any(|place| fixed.contains(place)) {
        return x;
    }
    let state = |place: usize| x.get(place).copied().unwrap_or(T::from_f64(f64::NAN));
    let rows: SMatrix<T, R, C> = SMatrix::from_fn(|row, column| state(places[row][column]));
    let rows = crate::attitude::orthonormal(&rows);
    for (row, places) in places.iter().enumerate() {
        for (column, place) in places.iter().enumerate() {
            if let Some(state) = x.get_mut(*place) {
                *state = rows[(row, column)];
            }
        }
    }
    x
}

/// How far a projection goes: in units of precision and of what the states contribute to a residual.
const CLOSED: f64 = 16.0;
/// By how much more it may stay open where constraints are redundant: what is left of them by rounding of the positions has
/// no correction. States that are only looked at may, too.
const NEARLY: f64 = 64.0;

/// What a displacement counts at least: residuals of positions turn with angles that may be zero, and are as long as links
/// are then.
const DISPLACEMENT: f64 = 1.0;

/// The size that rounding has in residuals with this Jacobian, in units of precision, where states count so much at least.
fn size<T: Real, const M: usize, const N: usize>(
    x: &SVector<T, N>,
    jacobian: &SMatrix<T, M, N>,
    least: f64,
) -> f64 {
    let mut sums = [0.0; M];
    for (column, state) in jacobian.data.0.iter().zip(x.as_slice()) {
        let least = T::from_f64(least);
        let state = state.abs().max(least);
        for (sum, slope) in sums.iter_mut().zip(column) {
            *sum += (*slope * state).magnitude();
        }
    }
    sums.into_iter().fold(0.0, f64::max)
}

/// At how many parts of the flows their rounding is looked at.
const PARTS: usize = 12;

/// What rounding leaves of residuals that are linear in the flows: the largest distance from a line between no flows and these.
/// Near a dead centre flows of metres per second cancel in a residual on which neither the crank nor the slide, which is almost
/// at rest, has an influence that would tell of it.
#[cold]
fn rounding_of_flows<T: Real, const M: usize, const N: usize>(
    x: &SVector<T, N>,
    jacobian: &SMatrix<T, M, N>,
    residuals: &impl Fn(&SVector<T, N>) -> SVector<T, M>,
) -> f64 {
    let with = |part: T| {
        let of_state = |state: usize| {
            let is_flow = jacobian.column(state).iter().any(|it| it.magnitude() > 0.0);
            let part = if is_flow { part } else { T::from_f64(1.0) };
            part * x[state]
        };
        residuals(&SVector::from_fn(|state, _| of_state(state)))
    };
    let [none, all] = [0.0, 1.0].map(|part| with(T::from_f64(part)));
    let distance = |number: usize| {
        // Not of few digits, or nothing would be rounded.
        let part = T::from_f64(0.618 * number as f64).fraction() + T::from_f64(0.5);
        let here = with(part);
        let rows = 0..M;
        let aside = rows.map(|row| here[row] - (none[row] + part * (all[row] - none[row])));
        aside.map(T::magnitude).fold(0.0, f64::max)
    };
    (1..=PARTS).map(distance).fold(0.0, f64::max)
}

/// Ranks of the Jacobian of residuals where they are zero, near `start`: of groups of them.
pub fn ranks<T: Real, const M: usize, const N: usize, const B: usize>(
    start: SVector<T, N>,
    groups: [&[usize]; B],
    evaluate: impl Fn(&SVector<T, N>) -> (SVector<T, M>, SMatrix<T, M, N>),
) -> [T; B] {
    let tolerance = NEARLY * CLOSED * T::EPSILON * size(&start, &evaluate(&start).1, DISPLACEMENT);
    crate::solve::ranks(&start, tolerance, groups, evaluate)
}

/// Residuals of positions or of flows.
#[derive(Clone, Copy, PartialEq)]
pub enum Level {
    /// Of displacements.
    Positions,
    /// Of rates and momenta, in which they are linear.
    Flows,
}

/// What a generated model gives for [`System::examined`]: its determinants are worked out once.
#[inline]
pub fn examined<T, S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    t: T,
    x: &SVector<T, N>,
    u: &SVector<T, M>,
    memory: &S::Memory,
) -> Result<S::Conditioning, Trouble>
where
    T: Real,
    S: System<T, N, M, P>,
{
    if let Some(trouble) = S::stopped_at(x, u, memory) {
        return Err(trouble);
    }
    let conditioning = system.conditioning(t, x, u);
    match Trouble::of_conditioning(S::META, conditioning.as_ref()) {
        None => Ok(conditioning),
        Some(trouble) => Err(trouble),
    }
}

/// Projects a state onto residuals, whose closures are numbered in `closures`, with a Jacobian of this rank at most. The last
/// function gives the residuals alone.
pub fn close<T: Real, const M: usize, const N: usize>(
    meta: &Meta,
    closures: &[usize; M],
    x: SVector<T, N>,
    fixed: &[usize],
    (level, rank): (Level, T),
    evaluate: impl Fn(&SVector<T, N>) -> (SVector<T, M>, SMatrix<T, M, N>),
    residuals: impl Fn(&SVector<T, N>) -> SVector<T, M>,
) -> Result<SVector<T, N>, Trouble> {
    let hold = |(residuals, mut jacobian): (SVector<T, M>, SMatrix<T, M, N>)| {
        for state in fixed.iter().filter(|state| **state < N) {
            jacobian.column_mut(*state).fill(T::from_f64(0.0));
        }
        (residuals, jacobian)
    };
    let start = evaluate(&x);
    let rounding = T::EPSILON
        * match level {
            Level::Positions => size(&x, &start.1, DISPLACEMENT),
            // What drives a loop is no state, and is all there is where rates are zero before.
            Level::Flows => start
                .0
                .as_slice()
                .iter()
                .fold(size(&x, &start.1, 0.0), |size, it| size + it.magnitude()),
        };
    let tolerance = (CLOSED * rounding).max(least::<T>());
    let held = |x: &SVector<T, N>| hold(evaluate(x));
    let found = project_from(x, hold(start), (tolerance, rank), (held, &residuals));
    let nearly = T::from_f64(NEARLY * tolerance);
    let missing = T::from_f64(M as f64) - rank;
    let zero = T::from_f64(0.0);
    let redundant = found.residual.select_less(nearly, missing, zero);
    if found.converged || redundant.find(|lane| lane <= 0.0).is_none() {
        return Ok(found.point);
    }
    let closure = closures.get(found.worst).copied().unwrap_or(0);
    let residual = found.residual.magnitude();
    let positions = level == Level::Positions;
    let jacobians = [x, found.point].map(|x| evaluate(&x).1);
    if !positions && residual <= CLOSED * rounding_of_flows(&found.point, &jacobians[1], &residuals)
    {
        return Ok(found.point);
    }
    let (constraints, coordinates) = together(&jacobians, found.worst);
    Err(Trouble::Open {
        name: meta.closures.get(closure).copied().unwrap_or(""),
        residual,
        // From so near, corrections end in rounding but where the Jacobian has lost its rank.
        singular: positions && residual < rounding / T::EPSILON * T::SINGULAR,
        locked: (positions && constraints >= coordinates).then_some((constraints, coordinates)),
    })
}

/// A number that is smaller may lack digits.
fn least<T: Real>() -> f64 {
    let least = match T::EPSILON > 1e-10 {
        true => f64::from(f32::MIN_POSITIVE),
        false => f64::MIN_POSITIVE,
    };
    least / T::EPSILON
}

/// How many constraints there are with the coordinates that this one holds, with those that these hold, and so on, and how
/// many coordinates that are. An entry of either Jacobian tells.
#[cold]
fn together<T: Real, const M: usize, const N: usize>(
    jacobians: &[SMatrix<T, M, N>; 2],
    first: usize,
) -> (usize, usize) {
    let mut constraints = [false; M];
    let mut coordinates = [false; N];
    if let Some(first) = constraints.get_mut(first) {
        *first = true;
    }
    let holds = |row, column| {
        let is_not_zero = |jacobian: &SMatrix<T, M, N>| jacobian[(row, column)].magnitude() > 0.0;
        jacobians.iter().any(is_not_zero)
    };
    for _ in 0..M {
        for (row, constraint) in constraints.iter_mut().enumerate() {
            let mut held = coordinates.iter().enumerate();
            *constraint |= held.any(|(column, is_held)| *is_held && holds(row, column));
            for (column, is_held) in coordinates.iter_mut().enumerate() {
                *is_held |= *constraint && holds(row, column);
            }
        }
    }
    let count = |found: &[bool]| found.iter().filter(|it| **it).count();
    (count(&constraints), count(&coordinates))
}

/// A symmetric matrix from row, column and value of the elements below and on its diagonal that are not zero.
pub fn symmetric<T: Real, const K: usize>(elements: &[(usize, usize, T)]) -> SMatrix<T, K, K> {
    let mut matrix = SMatrix::<T, K, K>::from_element(T::from_f64(0.0));
    for (row, column, value) in elements {
        for place in [(*row, *column), (*column, *row)] {
            if let Some(element) = matrix.get_mut(place) {
                *element = *value;
            }
        }
    }
    matrix
}

/// A matrix from row, column and value of the elements that are not zero.
pub fn sparse<T: Real, const K: usize>(elements: &[(usize, usize, T)]) -> SMatrix<T, K, K> {
    let mut matrix = SMatrix::<T, K, K>::from_element(T::from_f64(0.0));
    for (row, column, value) in elements {
        if let Some(element) = matrix.get_mut((*row, *column)) {
            *element = *value;
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions() {
        let passes = |value: f64| {
            [Condition::Finite, Condition::NonZero, Condition::Positive]
                .map(|it| check("r", value, it, "").is_ok())
        };
        assert_eq!(passes(1.0), [true, true, true]);
        assert_eq!(passes(-1.0), [true, true, false]);
        assert_eq!(passes(0.0), [true, false, false]);
        assert_eq!(passes(1e-308), [true, true, true]);
        assert_eq!(passes(1e-309), [true, false, false]);
        assert_eq!(passes(-1e-309), [true, false, false]);
        let tiny = check(
            "mass",
            1e-39_f32,
            Condition::Positive,
            "it must be positive",
        );
        assert_eq!(tiny.unwrap_err().reason, RECIPROCAL);
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(passes(value), [false, false, false]);
            let error = check("1/arm", value, Condition::NonZero, "it must not be zero");
            assert_eq!(error.unwrap_err().reason, FINITE);
        }
    }

    #[test]
    fn constraints_are_counted_that_share_coordinates_with_others() {
        // A chain of three constraints on two coordinates, and one beside it on two of its own.
        let rows = SMatrix::<f64, 4, 4>::from_row_slice(&[
            2.0, 0.0, 0.0, 0.0, //
            0.0, 0.0, 1.0, 1.0, //
            0.0, 3.0, 0.0, 0.0, //
            1.0, 1.0, 0.0, 0.0,
        ]);
        let none = SMatrix::zeros();
        let counts = [0, 1, 2, 3].map(|first| together(&[none, rows], first));
        assert_eq!(counts, [(3, 2), (1, 2), (3, 2), (3, 2)]);
    }

    #[test]
    fn error_names_the_parameter_its_value_and_the_reason() {
        let error = check(
            "mass",
            -2.0_f32,
            Condition::Positive,
            "an inertia must be positive",
        )
        .unwrap_err();
        assert_eq!(
            std::format!("{error}"),
            "`mass` is -2e0: an inertia must be positive"
        );
    }
}
