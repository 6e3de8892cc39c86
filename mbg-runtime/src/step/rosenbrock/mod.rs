//! Methods of Rosenbrock: implicit by one linear system per step.

mod kink;
mod rodas4;
mod rodas5p;

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use super::control::Rule;
use super::dense::Polynomial;
use super::elimination::Shifted;
use super::method::{
    Estimating, Family, Method, Start, Stepper, Trial, along, combination, continued, of_stage, row,
};
use super::problem::Problem;
use super::tolerance::{Sizes, Tolerance};
use crate::{Input, Real, System, Trouble};
use rodas4::RODAS4;
use rodas5p::RODAS5P;

/// The method of Verwer with two stages.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 2 | 2 | 1 | 2 evaluations, a Jacobian, a factorisation, 2 solves | A and L |
///
/// For stiff problems at a fixed step on a microcontroller: the work per step is known in advance where laws have no kinks, see
/// [`Fixed`](crate::Fixed).
///
/// Source: J. G. Verwer, E. J. Spee, J. G. Blom and W. Hundsdorfer, *SIAM Journal on Scientific Computing* 20 (1999),
/// 1456–1480, with γ = 1 − 1/√2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ros2;

/// The method `rodas` of Hairer and Wanner.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 4 | 3, error of power 4 | 3 | 6 evaluations, a Jacobian, a factorisation, 6 solves | A and L, stiffly accurate |
///
/// For stiff electrical and chemical problems to errors of about 1e-4. Where a fast mode follows what varies with time, states
/// in between, samples and events among them, are far less exact than those at the ends of steps:
/// [`Rodas5P`] does not lose it.
///
/// Source: Hairer and Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996), IV.7.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rodas4;

/// The method Rodas5P of Steinebach.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 5 | 4, error of power 5 | 4 | 8 evaluations, a Jacobian, a factorisation, 8 solves | A and L, stiffly accurate |
///
/// For stiff electrical and chemical problems, and for problems that are stiff at times only. What it takes of the stack,
/// [`Auto`](crate::Auto#stack) tells. In `f32` its large
/// coefficients magnify rounding; [`Rodas4`] is better there.
///
/// Source: G. Steinebach, *BIT Numerical Mathematics* 63:27 (2023).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rodas5P;

/// Coefficients in the form that needs no product with the Jacobian (Hairer and Wanner, IV.7, equation 7.25).
///
/// Stage `i` solves `(I/(hγ) − J) Uᵢ = f(t + αᵢh, x + Σ aᵢⱼUⱼ) + Σ cᵢⱼUⱼ/h + γᵢh ∂f/∂t`.
struct Tableau<const S: usize> {
    /// γ.
    diagonal: f64,
    /// αᵢ.
    nodes: [f64; S],
    /// γᵢ.
    times: [f64; S],
    /// aᵢⱼ.
    points: [&'static [f64]; S],
    /// cᵢⱼ.
    slopes: [&'static [f64]; S],
    result: [f64; S],
    error: [f64; S],
    /// Weights of `d₁, d₂, d₃` in `x + s (Δ + (1 − s) (d₁ + s (d₂ + s d₃)))`.
    dense: [&'static [f64]; 3],
}

/// 1/γ for γ = 1 − 1/√2.
const G: f64 = 2.0 + core::f64::consts::SQRT_2;

const ROS2: Tableau<2> = Tableau {
    diagonal: 1.0 / G,
    nodes: [0.0, 1.0],
    times: [1.0 / G, -1.0 / G],
    points: [&[], &[G]],
    slopes: [&[], &[-2.0 * G]],
    result: [1.5 * G, 0.5 * G],
    error: [0.5 * G, 0.5 * G],
    dense: [&[], &[], &[]],
};

/// A method of this family.
pub trait Tabulated<const S: usize>: Copy {
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no method is written outside")]
    const TABLEAU: Tableau<S>;
}

/// A step without a tolerance is lost when its error is larger than this part of what states have been.
const LOST: f64 = 0.25;
/// The same for the parts of a step that was lost, which are to lead across the kink that is there.
const NEAR: f64 = 0.03;
/// So small a part of the way is a law asked about that the Jacobian says to lead to where nothing goes on.
const BESIDE: f64 = 1e-3;

/// What is known where the step starts, and the stages of the last step.
pub struct Stages<A, T, const N: usize, const S: usize> {
    jacobian: SMatrix<T, N, N>,
    factors: Shifted<T, N>,
    by_time: SVector<T, N>,
    stages: [SVector<T, N>; S],
    /// Of steps without a tolerance.
    sizes: Sizes<N>,
    /// Whether the last step was one across a kink, of which the stages tell nothing.
    is_across: bool,
    method: PhantomData<A>,
}

impl<A: Tabulated<S>, T: Real, const N: usize, const S: usize> Stages<A, T, N, S> {
    /// Whether a step is lost, as where it crosses a kink of a stiff law and its stages are those of the law before the kink.
    fn is_lost(&mut self, start: &Start<T, N>) -> bool {
        self.sizes.note(&start.x);
        let error = combination(const { &A::TABLEAU.error }, &self.stages);
        let error = self.sizes.before::<T>().norm(&error);
        error.is_nan() || error > if start.is_part { NEAR } else { LOST }
    }

    /// The slope where a state is led to that goes so fast, by what it is a little ahead.
    fn slope_ahead<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (time, x): (T, &SVector<T, N>),
        slope: &SVector<T, N>,
    ) -> SVector<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let part = T::from_f64(BESIDE);
        let way = self.factors.solved::<Y, M, P>(slope);
        let change = problem.slope(time, &along(x, part, &way)) - slope;
        slope.zip_map(&change, |slope, change| slope + change / part)
    }

    /// Whether an argument gets nowhere from beside a threshold, where a law may be a root.
    fn is_held<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        change: &SVector<T, N>,
    ) -> bool
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if !Y::HAS_COURSES || !problem.begins_beside(start) {
            return false;
        }
        let memory = problem.memory;
        let (time, end) = (start.span.end, start.x + change);
        let slope = problem.slope(time, &end);
        let is_held = problem.is_held(start, (&end, &slope)) && {
            let left = self.slope_ahead(problem, (time, &end), &slope);
            problem.is_held(start, (&end, &left))
        };
        problem.memory = memory;
        is_held
    }

    /// What earlier stages add to the state and to the slope of a stage.
    #[inline(always)]
    fn ahead<const STAGE: usize>(&self, last: &SVector<T, N>) -> [SVector<T, N>; 2] {
        let points = const { row(&A::TABLEAU.points, STAGE) };
        let slopes = const { row(&A::TABLEAU.slopes, STAGE) };
        [
            continued(points, &self.stages, last),
            continued(slopes, &self.stages, last),
        ]
    }
}

impl<A, T: Real, const N: usize, const S: usize> Stages<A, T, N, S> {
    /// The derivative at a stage. Jacobians of attitudes are exact along rotations alone, and stages are beside these: there the
    /// model is asked at the rotation next to the stage, and what the Jacobian says of the way from it is added. That has the
    /// Jacobian at the start of the step in every direction, as the order asks for, and is the derivative at all rotations.
    #[inline(always)]
    fn slope_of_stage<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        t: T,
        x: &SVector<T, N>,
    ) -> SVector<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if !Y::HAS_ATTITUDES {
            return problem.slope(t, x);
        }
        let zero = T::from_f64(0.0);
        let near = Y::upright(*x);
        let mut slope = problem.slope(t, &near);
        for (column, aside) in self.jacobian.column_iter().zip(&(x - near)) {
            if *aside != zero {
                slope.zip_apply(&column, |slope, by| *slope += by * *aside);
            }
        }
        slope
    }
}

#[allow(private_interfaces, reason = "no method is written outside")]
impl<A, T, const N: usize, const S: usize> Stepper<A, T, N> for Stages<A, T, N, S>
where
    A: Tabulated<S>,
    T: Real,
{
    fn new(_method: &A) -> Self {
        let zero = T::from_f64(0.0);
        Self {
            jacobian: SMatrix::from_element(zero),
            factors: Shifted::empty(),
            by_time: SVector::from_element(zero),
            stages: [SVector::from_element(zero); S],
            sizes: Sizes::new(),
            is_across: false,
            method: PhantomData,
        }
    }

    fn attempt<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: Option<&Tolerance<N>>,
    ) -> Trial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let Start { span, x, .. } = start;
        let length = span.length;
        self.is_across = false;
        // Of a part that is tried again the Jacobian is where a step across came to.
        let is_new = !start.again || start.is_part;
        if is_new {
            let ahead = tolerance.map(|_| length);
            problem.jacobian((span.start, x), ahead, &mut self.jacobian);
        }
        // A longer step may have looked ahead to where the input is no number.
        if is_new || Trouble::of_state(Y::META, &self.by_time).is_some() {
            self.by_time = problem.slope_by_time(span.start, x, length);
        }
        let one = T::from_f64(1.0);
        let inverse = one / length;
        problem.statistics.factorisations += 1;
        let diagonal = inverse / T::from_f64(A::TABLEAU.diagonal);
        self.factors
            .factorise::<Y, M, P>(diagonal, one, &self.jacobian);
        let mut last = SVector::from_element(T::from_f64(0.0));
        for stage in 0..S {
            let [ahead, coupling] = of_stage!(stage, self.ahead(&last));
            let slope = if stage == 0 {
                start.slope
            } else {
                let t = span.at(T::from_f64(A::TABLEAU.nodes[stage]));
                self.slope_of_stage(problem, t, &(x + ahead))
            };
            let by_time = T::from_f64(A::TABLEAU.times[stage]) * length;
            let known = coupling.zip_map(&self.by_time, |coupling, change| {
                inverse * coupling + by_time * change
            });
            last = self.factors.solved::<Y, M, P>(&(slope + known));
            self.stages[stage] = last;
        }
        let mut change = combination(const { &A::TABLEAU.result }, &self.stages);
        let error = match tolerance {
            Some(tolerance) => {
                let error = combination(const { &A::TABLEAU.error }, &self.stages);
                let measure = tolerance.between(x, &change);
                let error = measure.norm(&error);
                match error <= 1.0 && self.is_held(problem, start, &change) {
                    true => f64::INFINITY,
                    false => error,
                }
            }
            None => match self.is_lost(start) || self.is_held(problem, start, &change) {
                true => {
                    let across = self.across(problem, start);
                    change = across.unwrap_or(change);
                    across.map_or(f64::INFINITY, |_| 0.0)
                }
                false => 0.0,
            },
        };
        Trial {
            change,
            slope: None,
            error,
            coarse: error * error,
        }
    }

    fn polynomial<Y, I, const M: usize, const P: usize>(
        &mut self,
        _problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        (end, _): (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        if self.is_across {
            return Polynomial::line(&start.x, end);
        }
        between(&A::TABLEAU, &self.stages, &start.x, end)
    }

    fn place_of_jacobian(&self, start: &Start<T, N>) -> Option<(T, SVector<T, N>)> {
        Some((start.span.start, start.x))
    }
}

/// The polynomial over a step.
fn between<T: Real, const N: usize, const S: usize>(
    tableau: &Tableau<S>,
    stages: &[SVector<T, N>; S],
    start: &SVector<T, N>,
    end: &SVector<T, N>,
) -> Polynomial<T, N> {
    let [first, second, third] = tableau.dense.map(|weights| combination(weights, stages));
    let mut polynomial = Polynomial::line(start, end);
    let [_, bend, twist, turn, ..] = &mut polynomial.coefficients;
    *bend = first;
    *twist = second + third;
    *turn = -third;
    polynomial
}

/// A method of this family.
macro_rules! rosenbrock {
    ($name:ident, $tableau:ident: $stages:literal, $text:literal, order $order:literal, $dense:literal, $estimate:literal) => {
        impl Method for $name {
            const NAME: &'static str = $text;
            const ORDER: u32 = $order;
            const DENSE_ORDER: u32 = $dense;
        }

        impl Estimating for $name {
            const ESTIMATE_ORDER: u32 = $estimate;
        }

        impl Tabulated<$stages> for $name {
            #[allow(private_interfaces, reason = "no method is written outside")]
            const TABLEAU: Tableau<$stages> = $tableau;
        }

        impl Family for $name {
            type Work<T: Real, const N: usize> = Stages<Self, T, N, $stages>;

            #[allow(private_interfaces, reason = "no method is written outside")]
            const RULE: Rule = Rule::Trend;
        }
    };
}

rosenbrock!(Ros2, ROS2: 2, "ROS2", order 2, 2, 2);
rosenbrock!(Rodas4, RODAS4: 6, "Rodas4", order 4, 4, 4);
rosenbrock!(Rodas5P, RODAS5P: 8, "Rodas5P", order 5, 5, 5);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::trees::Scheme;
    use std::vec::Vec;

    fn matrix<const S: usize>(rows: &[&[f64]; S]) -> SMatrix<f64, S, S> {
        SMatrix::from_fn(|row, column| rows[row].get(column).copied().unwrap_or(0.0))
    }

    /// Back from the form without products to `α`, `γ` and weights of the stages `kᵢ`.
    fn scheme<const S: usize>(tableau: &Tableau<S>) -> (Scheme, SMatrix<f64, S, S>) {
        let inverse = SMatrix::<f64, S, S>::identity() / tableau.diagonal - matrix(&tableau.slopes);
        let gamma = inverse.try_inverse().unwrap();
        let alpha = matrix(&tableau.points) * gamma;
        for row in 0..S {
            assert!(
                (alpha.row(row).sum() - tableau.nodes[row]).abs() < 1e-12,
                "row {row}"
            );
            assert!(
                (gamma.row(row).sum() - tableau.times[row]).abs() < 1e-12,
                "row {row}"
            );
        }
        let rows = |matrix: SMatrix<f64, S, S>| -> Vec<Vec<f64>> {
            matrix
                .row_iter()
                .map(|row| row.iter().copied().collect())
                .collect()
        };
        let scheme = Scheme {
            several: rows(alpha),
            single: rows(alpha + gamma),
        };
        (scheme, gamma)
    }

    fn assert_orders<const S: usize>(
        name: &str,
        tableau: &Tableau<S>,
        [order, estimate, dense]: [usize; 3],
    ) {
        let (scheme, gamma) = scheme(tableau);
        let weights = |stages: SVector<f64, S>| -> Vec<f64> {
            (gamma.transpose() * stages).iter().copied().collect()
        };
        let (result, error) = (SVector::from(tableau.result), SVector::from(tableau.error));
        scheme.assert_order(name, &weights(result), order, 1.0, 1e-11);
        scheme.assert_order(name, &weights(result - error), estimate, 1.0, 1e-11);
        let stages = core::array::from_fn(|stage| {
            SVector::<f64, S>::from_fn(|row, _| f64::from(row == stage))
        });
        let between = between(tableau, &stages, &SVector::zeros(), &result);
        for s in [0.1, 0.35, 0.8] {
            scheme.assert_order(name, &weights(between.at(s)), dense, s, 1e-11);
        }
    }

    #[test]
    fn conditions_of_order_hold() {
        assert_orders("ROS2", &ROS2, [2, 1, 1]);
        assert_orders("Rodas4", &RODAS4, [4, 3, 3]);
        assert_orders("Rodas5P", &RODAS5P, [5, 4, 4]);
    }
}
