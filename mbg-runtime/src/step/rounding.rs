//! States that are rounding alone.

use nalgebra::SVector;

use super::tolerance::Sizes;
use crate::Real;

/// A state that changes by more than this part of it is looked at: other ones settle by themselves.
const PART: f64 = 1e-4;
/// So many times its size a state is moved, and this part of the way sweeps may leave.
const FAR: f64 = 1024.0;
const LEFT: f64 = 1.0 / 64.0;
/// How often they are moved for that.
const TURNS: usize = 4;
/// How often it is looked for such states in one step at most.
const LOOKS: u32 = 4;

/// Up to which changes states are rounding alone.
///
/// The rates of joints of what falls freely are zero because large terms cancel out, and what a sweep finds is what rounding
/// leaves of these: no sweep makes its change small beside the state. Sweeps that bring back a state from far away have brought
/// it to where it is as well, so that what it still changes by is rounding.
pub(super) struct Floor<const N: usize> {
    changes: [f64; N],
    looks: u32,
}

impl<const N: usize> Floor<N> {
    pub(super) fn new() -> Self {
        Self {
            changes: [0.0; N],
            looks: 0,
        }
    }

    /// Looks for states whose changes are large beside them and small beside what states are; whether some were found. `sweep`
    /// gives the stages behind sweeps from those to which something is added, a quarter of as many as there have been at most.
    pub(super) fn look<T: Real, const S: usize>(
        &mut self,
        changes: &[SVector<T, N>; S],
        (x, stages, sizes): (&SVector<T, N>, &[SVector<T, N>; S], &Sizes<N>),
        mut sweep: impl FnMut(&SVector<T, N>) -> [SVector<T, N>; S],
    ) -> bool {
        let most = sizes.most::<T>();
        let (changes, stages) = (largest(changes), largest(stages));
        let mut size: [f64; N] = core::array::from_fn(|it| x[it].magnitude() + stages[it]);
        let small: [bool; N] = core::array::from_fn(|state| FAR * size[state] <= most[state]);
        let is_new = |state: usize| {
            small[state] && changes[state] > self.changes[state].max(PART * size[state])
        };
        if self.looks == LOOKS || !(0..N).any(is_new) {
            return false;
        }
        self.looks += 1;
        let here = sweep(&SVector::from_element(T::from_f64(0.0)));
        for turn in 0..TURNS {
            let mut apart = sweep(&SVector::from_fn(|state, _| {
                let sign = if (turn * state).is_multiple_of(2) {
                    FAR
                } else {
                    -FAR
                };
                T::from_f64(if small[state] {
                    sign * size[state]
                } else {
                    0.0
                })
            }));
            for (there, here) in apart.iter_mut().zip(&here) {
                *there -= here;
            }
            let apart = largest(&apart);
            let is_back = |state: usize| apart[state] <= LEFT * FAR * size[state];
            if (0..N).all(|state| !small[state] || is_back(state)) {
                let floor = |state: usize| LEFT * FAR * size[state];
                let floor = |state: usize| if small[state] { floor(state) } else { 0.0 };
                self.changes = core::array::from_fn(floor);
                return true;
            }
            // One that happens to be nearer to zero than rounding leads is as large as that.
            for (size, apart) in size.iter_mut().zip(apart) {
                *size = apart.max(*size);
            }
        }
        false
    }

    /// The changes without those of states that are rounding alone.
    pub(super) fn beyond<T: Real, const S: usize>(
        &self,
        mut changes: [SVector<T, N>; S],
    ) -> [SVector<T, N>; S] {
        if self.looks > 0 {
            for change in &mut changes {
                for (change, floor) in change.iter_mut().zip(&self.changes) {
                    if change.magnitude() <= *floor {
                        *change = T::from_f64(0.0);
                    }
                }
            }
        }
        changes
    }
}

/// The largest of each component.
fn largest<T: Real, const N: usize, const S: usize>(vectors: &[SVector<T, N>; S]) -> [f64; N] {
    let of = |state: usize| vectors.iter().map(move |it| it[state].magnitude());
    core::array::from_fn(|state| of(state).fold(0.0, f64::max))
}
