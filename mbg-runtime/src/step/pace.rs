//! How a run with steps of changing length goes on.

use super::approach::{Approach, Come};
use super::control::Control;
use super::crossing::{Crossing, Taken};
use super::method::{Family, Start, Trial};
use super::problem::Problem;
use super::seen;
use crate::{Input, Real, System};
use nalgebra::SVector;

/// So many steps are tried before it is asked again whether the motion comes to rest.
const LOOKS: u32 = 8;

/// How a run goes on.
pub(super) struct Pace {
    pub(super) control: Control,
    pub(super) approach: Approach,
    /// How often a step from the same place was refused, but for those that went over a threshold.
    pub(super) refused: u32,
    /// Whether one was.
    pub(super) again: bool,
    /// How many steps were tried since it was last asked whether the motion comes to rest.
    tries: u32,
}

impl Pace {
    pub(super) const fn new(control: Control) -> Self {
        Self {
            control,
            approach: Approach::new(),
            refused: 0,
            again: false,
            tries: 0,
        }
    }

    /// Goes on anew, where thresholds are met from a time on.
    pub(super) fn begin(&mut self, control: Control, watched: f64) {
        self.control = control;
        self.approach.watched = watched;
        (self.refused, self.again) = (0, false);
    }

    /// Whether it is time to ask whether the motion comes to rest at a threshold: steps that are held up there go on without end.
    pub(super) fn is_to_look(&mut self) -> bool {
        self.tries += 1;
        let looks = self.tries >= LOOKS;
        self.tries %= LOOKS;
        looks
    }

    /// Behind a step that was taken: where the run stands beside a threshold.
    #[inline]
    pub(super) fn accept<F: Family, T: Real, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        steps: &mut Crossing<'_, F, T, N>,
        (start, trial): (&Start<T, N>, &Trial<T, N>),
        end: (&SVector<T, N>, &SVector<T, N>),
    ) -> Come<T>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let (time, length) = (seen(start.span.start), seen(start.span.length));
        let come = self.approach.take(problem, start, end);
        match come {
            Come::Away => {
                problem.probes.heed(time, length, trial.coarse);
                steps.accept::<S, M, P>(&mut self.control, start, trial.error);
            }
            Come::Lost(length) => self.control.shorten(length),
            _ => {}
        }
        (self.refused, self.again) = (0, false);
        come
    }

    /// What is taken of a step: nothing of one that has met a threshold, where all count, as far as one can be come nearer to.
    pub(super) fn met<T: Real, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        taken: Taken<T, N>,
        counts: bool,
    ) -> Taken<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        match taken {
            Taken::Whole(end, _)
                if S::HAS_COURSES && counts && self.approach.meets(problem, start, &end) =>
            {
                Taken::Nothing
            }
            taken => taken,
        }
    }

    /// Behind one of which something is not taken.
    pub(super) fn refuse<F: Family, T: Real, S, I, const N: usize, const M: usize, const P: usize>(
        &mut self,
        problem: &Problem<'_, T, S, I, N, M, P>,
        steps: &Crossing<'_, F, T, N>,
        (start, trial): (&Start<T, N>, &Trial<T, N>),
        taken: &Taken<T, N>,
    ) -> Come<T>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.again = true;
        let come = self.approach.refuse(problem, start, trial, taken);
        if matches!(come, Come::Away) {
            self.refused += 1;
            let length = seen(start.span.length);
            match taken {
                Taken::Until(clear) => self.control.shorten(*clear),
                _ => steps.reject::<S, M, P>(&mut self.control, length, trial.error),
            }
        }
        come
    }
}
