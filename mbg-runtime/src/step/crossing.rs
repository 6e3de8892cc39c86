//! Steps across singular positions of closed loops.

use super::explicit::Dop853;
use super::method::{Family, Start, Stepper, Trial};
use super::problem::Problem;
use super::tolerance::Tolerance;
use crate::{Input, Real, System};

/// A step that was refused so often may be one that meets a singular position.
const REFUSED: u32 = 2;
/// So may be one that is shorter than the steps before it by this factor.
const SHORT: f64 = 0.1;
/// How much of the length of steps is remembered from step to step.
const REMEMBERED: f64 = 0.9;
/// What is tried, in lengths of the steps before: what a stage is off by depends on how near it comes.
const LENGTHS: [f64; 8] = [1.0, 1.5, 0.7, 2.2, 0.5, 3.0, 0.35, 4.0];
/// The least tolerances for which these are tried one after the other, in units of the root of the precision.
const DIGITS: [f64; 3] = [0.1, 1.0, 10.0];

/// Takes a step across a singular position of a closed loop, such as that of a parallelogram whose bars are in line.
///
/// Two branches of the motion meet there. Forces in the loop are those of an error of the state divided by the distance from
/// the position, so that stages of a step near it, which are off the loop by their own error, have large ones. The control of
/// the error answers with steps in proportion to the distance, which never cross; at the end rounding alone takes the loop from
/// its branch onto the other one. A step across is one of an explicit method whose stages are closed, about as long as the
/// steps before. Its error has rounding divided by the square of the distance in it, which the next closing takes away, so that
/// it is not asked for many more digits than half of those of the scalar.
///
/// Steps that are short for another reason are short in this way, too, and the method goes on by itself.
pub(super) struct Crossing<T: Real, const N: usize> {
    pub(super) explicit: <Dop853 as Family>::Work<T, N>,
    tolerances: [Tolerance<N>; DIGITS.len()],
    /// The length of the longest of the last steps.
    usual: f64,
    /// How many steps across have been tried; none while the method itself steps.
    tried: Option<usize>,
}

impl<T: Real, const N: usize> Crossing<T, N> {
    pub(super) fn new(relative: f64, absolute: f64, nominal: &[f64]) -> Self {
        let tolerance = |part: f64| {
            let least = part * Real::sqrt(T::EPSILON);
            Tolerance::new(relative.max(least), absolute.max(least), nominal)
        };
        Self {
            explicit: Stepper::new(&Dop853),
            tolerances: DIGITS.map(tolerance),
            usual: 0.0,
            tried: None,
        }
    }

    /// The length of the step across to try where one of this length, which was refused so often, may meet a singular
    /// position.
    pub(super) fn length(&mut self, length: f64, refused: u32) -> Option<f64> {
        let is_short = refused >= REFUSED || length < SHORT * self.usual;
        let place = match self.tried {
            None if is_short && self.usual > 0.0 => 0,
            None => return None,
            Some(tried) => tried,
        };
        self.tried = Some(place + 1);
        let is_known = place < LENGTHS.len() * DIGITS.len();
        is_known.then(|| LENGTHS[place % LENGTHS.len()] * self.usual)
    }

    /// The tolerance of the step across that is tried.
    pub(super) fn tolerance(&self) -> Tolerance<N> {
        let place = self.tried.map_or(0, |tried| tried - 1) / LENGTHS.len();
        self.tolerances[place.min(DIGITS.len() - 1)]
    }

    /// Tries a step; `problem` closes its stages.
    pub(super) fn attempt<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: &Tolerance<N>,
    ) -> Trial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.explicit.attempt(problem, start, Some(tolerance))
    }

    /// Goes on behind a step of this length, across or not.
    pub(super) fn accept(&mut self, length: f64) {
        // Where no step across was found the method's own is what is usual.
        let fails = self
            .tried
            .is_some_and(|tried| tried > LENGTHS.len() * DIGITS.len());
        self.usual = if fails {
            length
        } else {
            length.max(REMEMBERED * self.usual)
        };
        self.tried = None;
    }
}
