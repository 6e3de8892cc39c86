//! What the methods of integration have in common.

use nalgebra::SVector;

use super::dense::Polynomial;
use super::magnitude;
use super::problem::Problem;
use super::tolerance::Tolerance;
use crate::{Input, Real, System};

/// A method that computes one step from the state alone.
///
/// Each method's page states its order, stability, cost per step and source, and when to use it.
/// [`Fixed`](super::Fixed) runs any method at steps of constant length, [`Adaptive`](super::Adaptive) those with an
/// error estimate.
pub trait Method: Family {
    /// Name in the literature.
    const NAME: &'static str;
    /// Order of the states at the ends of steps.
    const ORDER: u32;
    /// Order of the states in between: the error of the interpolation falls with this power of the step.
    const DENSE_ORDER: u32;
}

/// A method that estimates the error of its steps.
pub trait Estimating: Method {
    /// The power of the step with which the estimate falls.
    const ESTIMATE_ORDER: u32;
}

/// From where to where a step goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span<T> {
    pub(super) start: T,
    pub(super) end: T,
    /// The length, which `end - start` gives only up to the rounding of both.
    pub(super) length: T,
}

impl<T: Real> Span<T> {
    /// The time after a part of the step.
    pub(super) fn at(&self, fraction: T) -> T {
        if fraction == T::from_f64(1.0) {
            self.end
        } else {
            self.start + fraction * self.length
        }
    }
}

/// Where a step starts.
pub struct Start<T, const N: usize> {
    pub(super) span: Span<T>,
    pub(super) x: SVector<T, N>,
    /// The derivative there.
    pub(super) slope: SVector<T, N>,
    /// Whether a step from the same point has been tried before.
    pub(super) again: bool,
}

/// A step that has been tried.
pub struct Trial<T, const N: usize> {
    /// What is added to the state.
    pub(super) change: SVector<T, N>,
    /// The derivative at the end, where the method knows it.
    pub(super) slope: Option<SVector<T, N>>,
    /// Error in units of the tolerance; not finite when the step failed, zero when the method has no estimate.
    pub(super) error: f64,
}

/// One implementation for all methods of a family.
#[allow(private_interfaces, reason = "no method is written outside")]
pub trait Family: Copy {
    /// Coefficients in the scalar of the run, stages of the last step, and what else is used again.
    type Work<T: Real, const N: usize>;

    /// Everything before the first step, and before the first behind a jump.
    fn prepare<T: Real, const N: usize>(&self) -> Self::Work<T, N>;

    /// Whether a step up to a fifth longer is not worth the work.
    const STEADY: bool = false;

    /// Tries a step; without a tolerance no error is estimated, and what is iterated is iterated as far as it goes.
    fn attempt<T, S, I, const N: usize, const M: usize, const P: usize>(
        &self,
        work: &mut Self::Work<T, N>,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: Option<&Tolerance<N>>,
    ) -> Trial<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>;

    /// What the method knows between the ends of the step that it has tried last, from the states and derivatives at
    /// both.
    fn polynomial<T, S, I, const N: usize, const M: usize, const P: usize>(
        work: &mut Self::Work<T, N>,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
        I: Input<T, M>;
}

/// Numbers of a table in the scalar of the run.
pub(super) fn converted<T: Real, const K: usize>(numbers: &[f64]) -> [T; K] {
    core::array::from_fn(|place| T::from_f64(numbers.get(place).copied().unwrap_or(0.0)))
}

/// `Σ weight · vector`; vectors of weight zero are left out.
#[inline]
pub(super) fn combination<T: Real, const N: usize>(
    weights: &[T],
    vectors: &[SVector<T, N>],
) -> SVector<T, N> {
    let zero = T::from_f64(0.0);
    let mut sum = SVector::<T, N>::from_element(zero);
    for (weight, vector) in weights.iter().zip(vectors) {
        if *weight != zero {
            sum.zip_apply(vector, |sum, component| *sum += *weight * component);
        }
    }
    sum
}

/// `x + factor · direction`.
#[inline]
pub(super) fn along<T: Real, const N: usize>(
    x: &SVector<T, N>,
    factor: T,
    direction: &SVector<T, N>,
) -> SVector<T, N> {
    x.zip_map(direction, |x, direction| x + factor * direction)
}

/// An iteration that goes on until nothing but rounding is left.
pub(super) struct Settling {
    before: f64,
    stalls: u32,
}

/// How far an iteration has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Progress {
    Going,
    Settled,
    Lost,
}

impl Settling {
    pub(super) const fn new() -> Self {
        Self {
            before: f64::INFINITY,
            stalls: 0,
        }
    }

    /// Takes the size of a change, relative to what is changed. It has settled when nothing changes, or when a small
    /// change no longer becomes smaller (Hairer, McLachlan and Razakarivony, *BIT Numerical Mathematics* 48 (2008),
    /// 231–243). A component near zero may be all rounding: then a change of a hundredth that stalls twice counts.
    pub(super) fn after<T: Real>(&mut self, change: f64) -> Progress {
        if change >= self.before {
            self.stalls += 1;
        }
        self.before = change;
        let small = match self.stalls {
            0 => 0.0,
            1 => T::SINGULAR,
            _ => 1e-2,
        };
        if change <= small {
            Progress::Settled
        } else if change.is_nan() {
            Progress::Lost
        } else {
            Progress::Going
        }
    }

    /// Whether the last change was small enough to go on with where the iteration was cut off.
    pub(super) fn suffices<T: Real>(&self) -> bool {
        self.before < T::SINGULAR
    }
}

/// Largest component of a change relative to those of what it changes, `x` and `y` together.
pub(super) fn relative<T: Real, const N: usize>(
    change: &SVector<T, N>,
    x: &SVector<T, N>,
    y: &SVector<T, N>,
) -> f64 {
    let pairs = change.iter().zip(x.iter().zip(y.iter()));
    pairs.fold(0.0, |largest: f64, (change, (x, y))| {
        let change = magnitude(*change);
        if change == 0.0 {
            return largest;
        }
        let quotient = change / (magnitude(*x) + magnitude(*y));
        if quotient > largest || quotient.is_nan() {
            quotient
        } else {
            largest
        }
    })
}
