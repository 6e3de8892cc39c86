//! What the methods of integration have in common.

use nalgebra::{SMatrix, SVector};

use super::control::Rule;
use super::dense::{Part, Polynomial};
use super::problem::Problem;
use super::tolerance::Tolerance;
use crate::{Columns, Input, Real, System};

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

    /// Its first and its second half.
    pub(super) fn halves(&self) -> [Self; 2] {
        let half = T::from_f64(0.5);
        let (middle, length) = (self.at(half), half * self.length);
        [(self.start, middle), (middle, self.end)].map(|(start, end)| Self { start, end, length })
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
    /// Whether it is a part of a step of constant length that was lost.
    pub(super) is_part: bool,
}

impl<T, const N: usize> Start<T, N> {
    /// Of a whole step that has not been tried.
    pub(super) fn of(span: Span<T>, x: SVector<T, N>, slope: SVector<T, N>) -> Self {
        Self {
            span,
            x,
            slope,
            again: false,
            is_part: false,
        }
    }
}

/// A step that has been tried.
pub struct Trial<T, const N: usize> {
    /// What is added to the state.
    pub(super) change: SVector<T, N>,
    /// The derivative at the end, where the method knows it.
    pub(super) slope: Option<SVector<T, N>>,
    /// Error in units of the tolerance; not finite when the step failed, zero when the method has no estimate.
    pub(super) error: f64,
    /// The square of the coarsest estimate of the error in the same units, of the error itself where there is no other.
    pub(super) coarse: f64,
}

/// What the implementation of a method works with.
pub trait Family: Copy {
    /// The implementation that all methods of the family share.
    type Work<T: Real, const N: usize>: Stepper<Self, T, N>;

    /// How the length of steps follows the error.
    #[allow(private_interfaces, reason = "no method is written outside")]
    const RULE: Rule = Rule::Proportional;

    /// Whether it takes Jacobians.
    const IMPLICIT: bool = true;

    /// The largest relative tolerance that its steps are controlled by. To larger ones the steps of an explicit method come to
    /// lengths at which it is not stable, and its estimate does not tell.
    const LOOSEST: f64 = f64::INFINITY;
}

/// Steps of a method, with the stages of the last one and what else is used again.
#[allow(private_interfaces, reason = "no method is written outside")]
pub trait Stepper<A, T: Real, const N: usize> {
    /// Everything before the first step, and before the first behind a jump.
    fn new(method: &A) -> Self;

    /// Tries a step; without a tolerance no error is estimated, and what is iterated is iterated as far as it goes.
    fn attempt<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: Option<&Tolerance<N>>,
    ) -> Trial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized;

    /// What the method knows between the ends of the step that it has tried last, from the states and derivatives at
    /// both.
    fn polynomial<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized;

    /// The same for what is read at a place of it, within a tolerance as the ends of the step are.
    fn samples<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        end: (&SVector<T, N>, Option<SVector<T, N>>),
        _tolerance: &Tolerance<N>,
        _place: f64,
    ) -> Part<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        Part::whole(self.polynomial(problem, start, end))
    }

    /// Where and when the step that has been tried last takes its Jacobian, if the method takes one.
    fn place_of_jacobian(&self, _start: &Start<T, N>) -> Option<(T, SVector<T, N>)> {
        None
    }

    /// How many times longer the next step may be, whatever the error allows.
    fn growth(&self) -> f64 {
        f64::INFINITY
    }
}

/// A call with the number of a stage as a constant, so that the stage's row of weights is written out.
macro_rules! of_stage {
    ($stage:expr, $work:ident.$method:ident($($argument:expr),*)) => {
        match $stage {
            0 => $work.$method::<0>($($argument),*),
            1 => $work.$method::<1>($($argument),*),
            2 => $work.$method::<2>($($argument),*),
            3 => $work.$method::<3>($($argument),*),
            4 => $work.$method::<4>($($argument),*),
            5 => $work.$method::<5>($($argument),*),
            6 => $work.$method::<6>($($argument),*),
            7 => $work.$method::<7>($($argument),*),
            8 => $work.$method::<8>($($argument),*),
            9 => $work.$method::<9>($($argument),*),
            10 => $work.$method::<10>($($argument),*),
            11 => $work.$method::<11>($($argument),*),
            12 => $work.$method::<12>($($argument),*),
            13 => $work.$method::<13>($($argument),*),
            14 => $work.$method::<14>($($argument),*),
            15 => $work.$method::<15>($($argument),*),
            16 => $work.$method::<16>($($argument),*),
            17 => $work.$method::<17>($($argument),*),
            18 => $work.$method::<18>($($argument),*),
            19 => $work.$method::<19>($($argument),*),
            _ => $work.$method::<20>($($argument),*),
        }
    };
}
pub(super) use of_stage;

/// A loop over stages that is written out, with the number of each as a constant.
macro_rules! each_stage {
    ($stage:ident in $stages:expr => $body:block) => {
        each_stage!($stage, $stages, $body, 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20)
    };
    ($stage:ident, $stages:expr, $body:block, $($number:literal)*) => {
        $(
            if $stages.contains(&$number) {
                const $stage: usize = $number;
                $body
            }
        )*
    };
}
pub(super) use each_stage;

/// The row of a table, empty behind the last.
pub(super) const fn row<const K: usize>(
    rows: &[&'static [f64]; K],
    number: usize,
) -> &'static [f64] {
    if number < K { rows[number] } else { &[] }
}

/// Reciprocals of `Π (cⱼ − cᵢ)`, for each node the product over all others.
pub(super) const fn leading<const S: usize>(nodes: &[f64; S]) -> [f64; S] {
    let mut reciprocals = [1.0; S];
    let mut own = 0;
    while own < S {
        let mut other = 0;
        while other < S {
            if other != own {
                reciprocals[own] /= nodes[own] - nodes[other];
            }
            other += 1;
        }
        own += 1;
    }
    reciprocals
}

/// Weights of the values at nodes in the polynomial through them, from the distances to the nodes and what [`leading`] gives.
#[inline]
pub(super) fn lagrange<T: Real, const S: usize>(leading: &[f64; S], distances: &[T; S]) -> [T; S] {
    let mut weights = leading.map(T::from_f64);
    let mut before = T::from_f64(1.0);
    let mut behind = T::from_f64(1.0);
    for node in 0..S {
        let last = S - 1 - node;
        weights[node] = weights[node] * before;
        before = before * distances[node];
        weights[last] = weights[last] * behind;
        behind = behind * distances[last];
    }
    weights
}

/// `Σ weight · vector`; vectors of weight zero are left out. Weights that are constants are written out.
#[inline(always)]
pub(super) fn combination<T: Real, const N: usize>(
    weights: &[f64],
    vectors: &[SVector<T, N>],
) -> SVector<T, N> {
    combined([], weights, vectors)
}

/// The same with terms in front whose weights are no constants.
///
/// Left to itself a compiler may gather the components of several vectors from all over the memory.
#[inline(always)]
pub(super) fn combined<T: Real, const N: usize, const K: usize>(
    front: [(T, &SVector<T, N>); K],
    weights: &[f64],
    vectors: &[SVector<T, N>],
) -> SVector<T, N> {
    let mut sum = SVector::<T, N>::from_element(T::from_f64(0.0));
    if N >= 4 && <T::Columns as Columns<T>>::COUNT > 1 {
        for block in 0..N.div_ceil(4) {
            // The last four overlap with those before where states are left over.
            let first = (4 * block).min(N - 4);
            let four = four_of(front, weights, vectors, first);
            for (place, component) in four.as_columns().iter().enumerate() {
                sum[first + place] = *component;
            }
        }
        return sum;
    }
    for (weight, vector) in front {
        sum.zip_apply(vector, |sum, component| {
            *sum = weight.multiply_add(component, *sum);
        });
    }
    for (weight, vector) in weights.iter().zip(vectors) {
        if *weight != 0.0 {
            let weight = T::from_f64(*weight);
            sum.zip_apply(vector, |sum, component| {
                *sum = weight.multiply_add(component, *sum);
            });
        }
    }
    sum
}

/// Four components of [`combined`], from this one on.
#[inline(always)]
fn four_of<T: Real, const N: usize, const K: usize>(
    front: [(T, &SVector<T, N>); K],
    weights: &[f64],
    vectors: &[SVector<T, N>],
    first: usize,
) -> T::Stages {
    let four = |vector: &SVector<T, N>| T::Stages::from_columns(|place| vector[first + place]);
    let mut sum = T::Stages::from_f64(0.0);
    for (weight, vector) in front {
        sum = T::Stages::whole(weight).multiply_add(four(vector), sum);
    }
    for (weight, vector) in weights.iter().zip(vectors) {
        if *weight != 0.0 {
            sum = T::Stages::from_f64(*weight).multiply_add(four(vector), sum);
        }
    }
    sum
}

/// `Σ weight · vector`, the last of the vectors apart: it may still be on its way to memory.
#[inline(always)]
pub(super) fn continued<T: Real, const N: usize>(
    weights: &[f64],
    vectors: &[SVector<T, N>],
    last: &SVector<T, N>,
) -> SVector<T, N> {
    match weights {
        [earlier @ .., weight] => along(&combination(earlier, vectors), T::from_f64(*weight), last),
        [] => combination(weights, vectors),
    }
}

/// `x + factor · direction`, rounded once where [`FUSED`](crate::FUSED) holds.
#[inline(always)]
pub(super) fn ahead<T: Real, const N: usize>(
    x: &SVector<T, N>,
    factor: T,
    direction: &SVector<T, N>,
) -> SVector<T, N> {
    x.zip_map(direction, |x, direction| factor.multiply_add(direction, x))
}

/// `x + factor · direction`, rounded twice.
#[inline]
pub(super) fn along<T: Real, const N: usize, const C: usize>(
    x: &SMatrix<T, N, C>,
    factor: T,
    direction: &SMatrix<T, N, C>,
) -> SMatrix<T, N, C> {
    x.zip_map(direction, |x, direction| x + factor * direction)
}

/// Repeats what gives the size of a change, relative to what is changed, until nothing but rounding is left, at most so
/// many times; whether it came to that.
///
/// It has when nothing changes, when the last two changes are said to be enough, or when a small change no longer becomes
/// smaller (Hairer, McLachlan and Razakarivony, *BIT Numerical Mathematics* 48 (2008), 231–243). Where the iteration turns
/// while it converges, a change is larger than the one before now and then, and in a component near zero all of it may be
/// rounding: so the longer none has been the smallest, the larger one is taken for rounding. Where the iteration is cut off,
/// the last change must be small.
pub(super) fn settles<T: Real>(
    most: u32,
    is_enough: impl Fn(f64, f64) -> bool,
    mut change: impl FnMut() -> f64,
) -> bool {
    const FIRST: f64 = 64.0;
    const FACTOR: f64 = 16.0;
    const LARGEST: f64 = 1e-2;
    let mut least = f64::INFINITY;
    let (mut rounding, mut last) = (0.0, f64::INFINITY);
    for _ in 0..most {
        let before = core::mem::replace(&mut last, change());
        if is_enough(before, last) {
            return true;
        }
        if last < least {
            (least, rounding) = (last, 0.0);
        } else {
            rounding = (FACTOR * rounding).clamp(FIRST * T::EPSILON, LARGEST);
        }
        if last <= rounding {
            return true;
        }
        if last.is_nan() {
            return false;
        }
    }
    last < T::SINGULAR
}

/// The larger of two sizes, or NaN where one is.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Largest component of a change relative to those of what it changes, `x` and `y` together.
pub(super) fn relative<T: Real, const N: usize>(
    change: &SVector<T, N>,
    x: &SVector<T, N>,
    y: &SVector<T, N>,
) -> f64 {
    let [[change], [x], [y]] = [&change.data.0, &x.data.0, &y.data.0];
    largest_of::<N>(|place| {
        let change = change[place].magnitude();
        let quotient = change / (x[place].magnitude() + y[place].magnitude());
        if change == 0.0 { 0.0 } else { quotient }
    })
}

/// The largest of `N` sizes, or NaN where one is. Bits of numbers that are not negative have the order of the numbers, and those of
/// NaN are behind all: so no comparison waits for the one before.
#[inline]
fn largest_of<const N: usize>(size: impl Fn(usize) -> f64) -> f64 {
    let bits = (0..N).map(|place| size(place).abs().to_bits());
    f64::from_bits(bits.fold(0, u64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a sum has the bits of the sums of its components.
    fn assert_by_components<const N: usize>() {
        let weights = [0.3, 0.0, -1.7, 1.0 / 3.0];
        let vectors: [SVector<f64, N>; 5] = core::array::from_fn(|vector| {
            SVector::from_fn(|state, _| 1.0 / (1.0 + (7 * vector + 3 * state) as f64))
        });
        let sum = combination(&weights, &vectors);
        for state in 0..N {
            let component = weights.iter().zip(&vectors);
            let component = component.fold(0.0, |sum: f64, (weight, vector)| {
                weight.multiply_add(vector[state], sum)
            });
            assert_eq!(sum[state].to_bits(), component.to_bits(), "{state} of {N}");
        }
    }

    #[test]
    fn the_largest_part_of_a_change_counts_and_what_is_no_number_shows() {
        let x = SVector::<f64, 11>::from_fn(|place, _| place as f64 - 4.0);
        let mut change = SVector::zeros();
        assert_eq!(relative(&change, &x, &x), 0.0);
        // Where nothing changes the size may be zero.
        change[9] = -1.0;
        change[1] = 1e-3;
        assert_eq!(relative(&change, &x, &x), 0.1);
        change[4] = 1e-300;
        assert_eq!(relative(&change, &x, &x), f64::INFINITY);
        for place in [0, 7, 10] {
            let mut change = change;
            change[place] = -f64::NAN;
            assert!(relative(&change, &x, &x).is_nan(), "{place}");
        }
    }

    #[test]
    fn a_sum_is_that_of_the_components_whatever_their_number() {
        assert_eq!(combination(&[1.0], &[SVector::<f64, 0>::zeros()]).len(), 0);
        assert_by_components::<1>();
        assert_by_components::<3>();
        assert_by_components::<4>();
        assert_by_components::<5>();
        assert_by_components::<7>();
        assert_by_components::<8>();
        assert_by_components::<13>();
    }
}
