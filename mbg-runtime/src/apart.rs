//! States that change alike whatever is done, so that no motion changes what they differ by.

use nalgebra::{SMatrix, SVector};

use crate::solve::{Row, Sizes};
use crate::{Convertible, Linearised, Trimmed, Untrimmed};

/// At how many points states must change alike: the one that was found, the guess, and others about both.
const POINTS: usize = 8;
/// By what part of themselves slopes of states that change alike may differ.
const ALIKE: f64 = 1e-12;
/// By how much one of the points is later than the one before it, s.
const LATER: f64 = 0.37;

/// Where a point was found that no motion from the guess reaches: two states of those that are asked for differ otherwise there, by
/// more than such a part of them, though they change alike whatever is done. Those that move farthest apart beside their own sizes
/// are told, with all states that change alike whatever is done: slopes at one point may be alike by chance, as of both places of
/// what rolls, at rest.
#[inline(never)]
pub(crate) fn apart<S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    time: f64,
    among: &[bool; N],
    (guess, found): (&Trimmed<N, M>, &Trimmed<N, M>),
    least: f64,
) -> Option<(Untrimmed, [bool; N])>
where
    S: Convertible<f64, N, M, P>,
{
    let is_pair =
        |number: usize, earlier: usize| earlier < number && among[number] && among[earlier];
    // By what number one state changes as an earlier one does, as far as is known.
    let mut times =
        SMatrix::<f64, N, N>::from_fn(|number, earlier| match is_pair(number, earlier) {
            true => f64::INFINITY,
            false => f64::NAN,
        });
    if times.iter().all(|times| times.is_nan()) {
        return None;
    }
    for point in 0..POINTS {
        match slopes(system, time + LATER * point as f64, point, (guess, found)) {
            Some((rows, sizes)) => refute(&mut times, &rows, &sizes, point == 0),
            // Nothing is known of a point that laws do not reach.
            None if point > 0 => {}
            None => return None,
        }
    }
    let mut worst = least;
    let mut apart = None;
    let mut alike = [false; N];
    for number in 0..N {
        for earlier in 0..number {
            let times = times[(number, earlier)];
            // Written so that NaN is not alike.
            if !times.is_finite() {
                continue;
            }
            (alike[number], alike[earlier]) = (true, true);
            let difference = |state: &SVector<f64, N>| state[number] - times * state[earlier];
            let terms =
                |state: &SVector<f64, N>| state[number].abs() + (times * state[earlier]).abs();
            let (kept, needed) = (difference(&guess.state), difference(&found.state));
            let part = (needed - kept).abs() / terms(&guess.state).max(terms(&found.state));
            // NaN is no difference: both are zero.
            if part > worst {
                worst = part;
                let name = |state: usize| S::META.states.get(state).map_or("", |it| it.name);
                apart = Some(Untrimmed::Apart {
                    name: name(number),
                    other: name(earlier),
                    times,
                    kept,
                    needed,
                });
            }
        }
    }
    apart.map(|apart| (apart, alike))
}

/// How rates change beside one of the points, with the rates, and how large states and inputs are there.
#[inline(never)]
fn slopes<S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    time: f64,
    point: usize,
    (guess, found): (&Trimmed<N, M>, &Trimmed<N, M>),
) -> Option<([Row<N, M>; N], Sizes<N, M>)>
where
    S: Convertible<f64, N, M, P>,
{
    // From 0 to 1, for each number at each point another one.
    let drawn = |number: usize| ((41 * (number + 1) * (2 * point + 3)) % 101) as f64 / 101.0;
    let aside = |number: usize, guess: f64, found: f64| match point {
        0 => found,
        1 => guess,
        _ => {
            // What is zero in both may be small or large by nature.
            let size = match guess.abs().max(found.abs()) {
                0.0 => 1.0 / (1 << (4 * (point - 2))) as f64,
                size => size,
            };
            found + drawn(2 * number) * (guess - found) + (drawn(2 * number + 1) - 0.5) * size
        }
    };
    let state = (guess.state).zip_map(&found.state, |guess, found| (guess, found));
    let state = state.map_with_location(|number, _, (guess, found)| aside(number, guess, found));
    let input = (guess.input).zip_map(&found.input, |guess, found| (guess, found));
    let input =
        input.map_with_location(|number, _, (guess, found)| aside(N + number, guess, found));
    let linear = Linearised::unchecked(system, time, &state, &input).ok()?;
    let rates = system.derivative(time, &state, &input, &mut S::Memory::default());
    let rows = core::array::from_fn(|row| {
        let by_state = linear.state.row(row).transpose();
        let by_input = linear.input.row(row).transpose();
        Row::new(by_state, by_input, rates[row])
    });
    Some((rows, (state.abs(), input.abs())))
}

/// Takes away by what number one state changes as another one does where that is not so at one more point.
fn refute<const N: usize, const M: usize>(
    times: &mut SMatrix<f64, N, N>,
    rows: &[Row<N, M>; N],
    sizes: &Sizes<N, M>,
    is_first: bool,
) {
    for number in 0..N {
        for earlier in 0..number {
            let times = &mut times[(number, earlier)];
            let (own, other) = (&rows[number], &rows[earlier]);
            if times.is_nan() || !own.is_finite() || !other.is_finite() {
                continue;
            }
            if is_first {
                *times = own.in_units_of(other, ALIKE).unwrap_or(f64::NAN);
            }
            if !own.is_multiple((other, *times), sizes, ALIKE) {
                *times = f64::NAN;
            }
        }
    }
}
