//! What of a motion that comes back is rounding.

use nalgebra::{SMatrix, SVector};

use super::{PeriodicTrim, Run};
use crate::beside::{BESIDE, ROUNDING, aside};
use crate::{Constant, Convertible, Integrator, Real, Trimmed, Untrimmed};

/// Into so many parts a period is divided: what rounding has made of a part goes on by the slopes of the next ones.
const PARTED: u32 = 16;

impl<S, A, const N: usize, const M: usize, const P: usize> PeriodicTrim<'_, S, A, N, M, P>
where
    S: Convertible<f64, N, M, P>,
    A: Integrator<N>,
{
    /// What is left of the conditions beyond what may be rounding.
    pub(super) fn beyond_rounding(&self, run: &Run<N, M>) -> SVector<f64, N> {
        let none = |_| SVector::zeros();
        run.left
            .zip_map(&self.rounding(run).unwrap_or_else(none), beyond)
    }

    /// What of the end of a motion may be rounding: of rates, where summands cancel out wherever the motion is, as the forces of the
    /// blades of a rotor do, and of states. What comes of one part is taken for independent of what comes of others.
    #[inline(never)]
    fn rounding(&self, run: &Run<N, M>) -> Result<SVector<f64, N>, Untrimmed> {
        let mut squares = SMatrix::<f64, N, N>::zeros();
        let mut start = run.start;
        let period = run.period / f64::from(PARTED);
        for number in 0..PARTED {
            let time = self.time + f64::from(number) * period;
            let part = Self {
                time,
                period,
                ..*self
            };
            let mut added = SVector::<f64, N>::zeros();
            let add = |span: [f64; 2], state: &SVector<f64, N>| {
                let point = Trimmed {
                    state: *state,
                    ..start
                };
                added += self.rounded(span, &point) + ROUNDING * f64::EPSILON * state.abs();
            };
            part.follow(self.system, &start.state, &Constant(start.input), None, add)?;
            let (slopes, end) = part.slopes_by_state(&start, None)?;
            added.component_mul_assign(&added.clone_owned());
            squares = slopes * squares * slopes.transpose() + SMatrix::from_diagonal(&added);
            start.state = end;
        }
        Ok(squares.diagonal().map(Real::sqrt))
    }

    /// What rounding of rates may change within a step: as much as they are apart at points beside the one where it ends, and nothing
    /// where a law jumps between those.
    pub(super) fn rounded(&self, [start, end]: [f64; 2], point: &Trimmed<N, M>) -> SVector<f64, N> {
        // Laws that jump by time do so where steps end.
        let middle = start + 0.5 * (end - start);
        let at = |beside| {
            let state = point.state;
            let input = point.input;
            (
                aside(beside, N + M, middle),
                state.map_with_location(|number, _, x| aside(beside, number, x)),
                input.map_with_location(|number, _, u| aside(beside, N + number, u)),
            )
        };
        let (still, rest) = (SVector::<f64, N>::zeros(), SVector::<f64, M>::zeros());
        let mut memory = S::Memory::default();
        let mut last = at(0);
        let mut least = self.derivative(last.0, &last.1, &last.2);
        let mut most = least;
        let mut is_over = false;
        for next in (1..BESIDE).map(at) {
            self.system.courses(
                (last.0, [&last.1, &still], [&last.2, &rest]),
                (next.0, [&next.1, &still], [&next.2, &rest]),
                &mut memory,
                |course| is_over |= course.reached(1.0).is_some(),
            );
            let rates = self.derivative(next.0, &next.1, &next.2);
            (least, most) = (least.inf(&rates), most.sup(&rates));
            last = next;
        }
        match is_over {
            true => SVector::zeros(),
            false => ROUNDING * (end - start) * (most - least),
        }
    }
}

/// What is left beyond rounding, written so that NaN is left, and what has no bound hides nothing.
pub(super) fn beyond(left: f64, rounding: f64) -> f64 {
    match rounding.is_finite() && left.abs() <= rounding {
        true => 0.0,
        false => left,
    }
}
