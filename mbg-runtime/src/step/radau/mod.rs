//! Radau's methods IIA.

mod newton;
mod tableaux;

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use super::control::Rule;
use super::dense::Polynomial;
use super::elimination::Shifted;
use super::linear::{Complex, Element};
use super::method::{Estimating, Family, Method, Start, Stepper, Trial, along, combination};
use super::problem::Problem;
use super::seen;
use super::tolerance::{Sizes, Tolerance};
use crate::{Input, Real, System};
use newton::{FAR, Newton};
use tableaux::{RADAU5, RADAU9};

/// Radau's method IIA of order 5.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 5 | 3, error of power 4 | 3 | three evaluations, a real and a complex solve a sweep, 2 to 4 sweeps; Jacobian and factorisations when needed | A and L, stiffly accurate |
///
/// For stiff mechanics, above all where fast modes are lightly damped.
///
/// The stages are found by Newton's method in the coordinates in which the tableau is diagonal; the estimate is
/// filtered. Coefficients and most decisions follow `radau5`; other than there, the Jacobian is taken at the predicted
/// middle of the step, and a step with a kept one is refused whose end is not where the slope leads to. At a fixed step the
/// sweeps go to rounding, and the next step keeps a Jacobian with which two came to it. What it takes of the stack,
/// [`Auto`](crate::Auto#stack) tells.
///
/// Source: Hairer and Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996), IV.8.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Radau5;

/// Radau's method IIA of order 9.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 9 | 5, error of power 6 | 5 | five evaluations, a real and two complex solves a sweep, 3 to 5 sweeps; Jacobian and factorisations when needed | A and L, stiffly accurate |
///
/// For stiff problems to errors of 1e-6 and less, where it is faster than [`Radau5`]. Errors are far below the
/// tolerance, which follows the estimate: 1e-4 is enough for errors of about 1e-6.
///
/// Works like [`Radau5`].
///
/// Source: E. Hairer and G. Wanner, *Journal of Computational and Applied Mathematics* 111 (1999), 93–111.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Radau9;

/// Coefficients of a method.
struct Tableau<const S: usize, const PAIRS: usize> {
    /// Nodes, the last of which is 1.
    nodes: [f64; S],
    /// Eigenvectors of the inverse of the tableau's matrix in its columns: the real one, then real and imaginary part of
    /// one of each pair.
    vectors: [[f64; S]; S],
    /// The inverse of the matrix of them.
    inverse: [[f64; S]; S],
    /// The real eigenvalue.
    real: f64,
    /// Real and imaginary part of one of each pair of others.
    pairs: [[f64; 2]; PAIRS],
    /// Weights of the stages in the estimate of the error.
    error: [f64; S],
    /// Weights of the stages in the coefficients of the [`Polynomial`] through them.
    dense: [[f64; S]; S],
}

impl<const S: usize, const PAIRS: usize> Tableau<S, PAIRS> {
    /// Weights of the stages in the slope of the polynomial through them at its end: the last row of the inverse of the matrix.
    const fn slope_at_end(&self) -> [f64; S] {
        let mut weights = [0.0; S];
        let mut stage = 0;
        while stage < S {
            weights[stage] = self.real * self.inverse[0][stage];
            let mut pair = 0;
            while pair < PAIRS {
                // The last row of the vectors has ones at real parts and zeros at imaginary ones.
                let [real, imaginary] = self.pairs[pair];
                weights[stage] += real * self.inverse[1 + 2 * pair][stage]
                    - imaginary * self.inverse[2 + 2 * pair][stage];
                pair += 1;
            }
            stage += 1;
        }
        weights
    }
}

/// A method of this family.
pub trait Tabulated<const S: usize, const PAIRS: usize>: Copy {
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no method is written outside")]
    const TABLEAU: Tableau<S, PAIRS>;
}

/// A sweep that reduces the error so much keeps the Jacobian.
const FAST: f64 = 1e-3;
/// Steps may become so long that a sweep reduces the error by this; the factor is about in proportion to the length.
const SLOW: f64 = 0.2;
/// Of a step that is so many times as long as the last one, that one tells nothing: its polynomial would be continued by rounding
/// alone, and the factor by which sweeps reduced the error is about in proportion to the length. The control lets steps become ten
/// times as long, but goes on with long ones behind one that ended early, as before a threshold.
const LONGER: f64 = 16.0;
/// A step without a tolerance ends where the slope there leads to, but for such a part of what states have been.
const ASTRAY: f64 = 1e-3;

/// The length of a step and the coefficients of its polynomial.
type Taken<T, const N: usize, const S: usize> = (T, [SVector<T, N>; S]);

/// What a step leaves for the next.
pub struct Stages<A, T, const N: usize, const S: usize, const PAIRS: usize> {
    jacobian: SMatrix<T, N, N>,
    /// By how much the last sweeps reduced the error; infinite where that is not known.
    theta: f64,
    factors: Factors<T, N, PAIRS>,
    /// Lengths of two steps and the coefficients of their polynomials, in turns the last one and that which is tried; no
    /// length at the start and behind a jump.
    steps: [Taken<T, N, S>; 2],
    /// Whether the second of them is tried.
    is_second: bool,
    /// How fast sweeps converge, from step to step.
    rate: f64,
    rejected: bool,
    /// Of the states, at fixed steps.
    sizes: Sizes<N>,
    method: PhantomData<A>,
}

/// Factors of `λ/h I − ∂f/∂x` for the eigenvalues, at a length `h`.
struct Factors<T, const N: usize, const PAIRS: usize> {
    /// None where there are no factors of the present Jacobian.
    length: Option<T>,
    /// The real `λ/h` with its factors.
    real: (T, Shifted<T, N>),
    /// One of each pair of others.
    pairs: [(Complex<T>, Shifted<Complex<T>, N>); PAIRS],
}

impl<T: Real, const N: usize, const PAIRS: usize> Factors<T, N, PAIRS> {
    fn empty() -> Self {
        Self {
            length: None,
            real: (T::from_f64(0.0), Shifted::empty()),
            pairs: [(Complex::zero(), Shifted::empty()); PAIRS],
        }
    }

    /// Sets `λ/h` of a step of this length.
    fn shift<const S: usize>(&mut self, length: T, tableau: &Tableau<S, PAIRS>) {
        let inverse = T::from_f64(1.0) / length;
        let by = |number: f64| inverse * T::from_f64(number);
        for ((shift, _), pair) in self.pairs.iter_mut().zip(&tableau.pairs) {
            let [real, imaginary] = pair.map(by);
            *shift = Complex { real, imaginary };
        }
        self.real.0 = by(tableau.real);
    }
}

#[allow(private_interfaces, reason = "no method is written outside")]
impl<A, T, const N: usize, const S: usize, const PAIRS: usize> Stepper<A, T, N>
    for Stages<A, T, N, S, PAIRS>
where
    A: Tabulated<S, PAIRS>,
    T: Real,
{
    fn new(_method: &A) -> Self {
        let zero = T::from_f64(0.0);
        Self {
            jacobian: SMatrix::from_element(zero),
            theta: f64::INFINITY,
            factors: Factors::empty(),
            steps: [(zero, [SVector::from_element(zero); S]); 2],
            is_second: false,
            rate: 1.0,
            rejected: false,
            sizes: Sizes::new(),
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
        let length = start.span.length;
        if !start.again {
            self.is_second = !self.is_second;
        }
        self.forget_shorter(length);
        let mut stages = self.predict(length);
        self.factorise(problem, (start, &stages));
        let mut newton =
            Newton::<A, _, _, _, N, M, P, S, PAIRS>::new(problem, start, &self.factors);
        let found = match tolerance {
            Some(tolerance) => {
                newton.controlled(&mut stages, (tolerance, &self.jacobian), &mut self.rate)
            }
            None => {
                self.sizes.note(&start.x);
                newton.settled(&mut stages, &self.sizes)
            }
        };
        match found {
            Ok(theta) => self.theta = theta,
            Err(left) => return self.refuse(&stages, left),
        }
        let error = tolerance.map_or(0.0, |tolerance| {
            newton.error(&stages, tolerance, self.rejected || self.last().is_none())
        });
        let mut slope = None;
        if error <= 1.0 && (tolerance.is_some() || newton.begins_beside()) {
            let end = newton.slope_at_end(&stages);
            let by_size = (self.sizes.tolerance(ASTRAY), f64::INFINITY);
            let (tolerance, left) = tolerance.map_or(by_size, |given| (*given, FAR));
            if newton.gets_nowhere(&stages, (&end, &self.jacobian), &tolerance) {
                return self.refuse(&stages, left);
            }
            slope = Some(end);
        }
        self.rejected = error.is_nan() || error > 1.0;
        *self.tried() = (length, transformed(const { &A::TABLEAU.dense }, &stages));
        Trial {
            change: stages[S - 1],
            slope,
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
        let mut polynomial = Polynomial::line(&start.x, end);
        let found = self.tried().1.iter().skip(1);
        for (coefficient, found) in polynomial.coefficients.iter_mut().skip(1).zip(found) {
            *coefficient = *found;
        }
        polynomial
    }

    fn place_of_jacobian(&self, start: &Start<T, N>) -> Option<(T, SVector<T, N>)> {
        Some(middle::<A, _, _, _, _>(
            start,
            &self.predict(start.span.length),
        ))
    }

    fn growth(&self) -> f64 {
        SLOW / self.theta
    }
}

impl<A, T, const N: usize, const S: usize, const PAIRS: usize> Stages<A, T, N, S, PAIRS>
where
    A: Tabulated<S, PAIRS>,
    T: Real,
{
    /// A Jacobian and factors that serve for this step.
    ///
    /// The Jacobian is taken at the middle one of the predicted stages: over the step it is wrong by half of what one at
    /// the start would be, and sweeps converge faster.
    fn factorise<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (start, stages): (&Start<T, N>, &[SVector<T, N>; S]),
    ) where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let span = &start.span;
        if self.theta > FAST {
            let (t, mut x) = middle::<A, _, _, _, _>(start, stages);
            if start.is_part && start.again && problem.begins_beside(start) {
                // A root next to zero is far steeper there than anywhere on the way.
                x = along(&start.x, t - span.start, &start.slope);
            }
            problem.jacobian((t, &x), Some(span.length), &mut self.jacobian);
            self.factors.length = None;
        }
        if self.factors.length == Some(span.length) {
            return;
        }
        self.factors.length = Some(span.length);
        self.factors.shift(span.length, &A::TABLEAU);
        problem.statistics.factorisations += 1 + PAIRS as u64;
        let one = T::from_f64(1.0);
        for (shift, factors) in &mut self.factors.pairs {
            factors.factorise::<Y, M, P>(*shift, one, &self.jacobian);
        }
        let (shift, factors) = &mut self.factors.real;
        factors.factorise::<Y, M, P>(*shift, one, &self.jacobian);
    }

    /// Gives up a step whose sweeps would leave so many times what is enough, and with it the Jacobian.
    fn refuse(&mut self, stages: &[SVector<T, N>; S], left: f64) -> Trial<T, N> {
        (self.theta, self.rejected, self.rate) = (f64::INFINITY, true, 1.0);
        Trial {
            change: stages[S - 1],
            slope: None,
            error: left,
            coarse: left * left,
        }
    }

    /// Forgets the last step where this one is far longer. Without one the first sweep does not see where stages lead, and is none that
    /// could be enough.
    fn forget_shorter(&mut self, length: T) {
        let last = self.last();
        if last.is_some_and(|(before, _)| seen(length / *before) <= LONGER) {
            return;
        }
        let [first, second] = &mut self.steps;
        let last = if self.is_second { first } else { second };
        last.0 = T::from_f64(0.0);
        self.rate = 1.0;
    }

    /// The last step.
    fn last(&self) -> Option<&Taken<T, N, S>> {
        let [first, second] = &self.steps;
        let last = if self.is_second { first } else { second };
        Some(last).filter(|(length, _)| *length != T::from_f64(0.0))
    }

    /// The one that is tried.
    fn tried(&mut self) -> &mut Taken<T, N, S> {
        let [first, second] = &mut self.steps;
        if self.is_second { second } else { first }
    }

    /// The stages as the last step continues.
    fn predict(&self, length: T) -> [SVector<T, N>; S] {
        let Some((before, coefficients)) = self.last() else {
            return [SVector::from_element(T::from_f64(0.0)); S];
        };
        let ratio = length / *before;
        let mut stages = *coefficients;
        for (stage, node) in stages.iter_mut().zip(A::TABLEAU.nodes) {
            *stage = beyond(coefficients, ratio * T::from_f64(node));
        }
        stages
    }
}

/// Time and state of the middle one of these stages.
#[inline]
fn middle<A, T, const N: usize, const S: usize, const PAIRS: usize>(
    start: &Start<T, N>,
    stages: &[SVector<T, N>; S],
) -> (T, SVector<T, N>)
where
    A: Tabulated<S, PAIRS>,
    T: Real,
{
    let node = T::from_f64(A::TABLEAU.nodes[S / 2]);
    (start.span.at(node), start.x + stages[S / 2])
}

/// What a polynomial adds to its end a part of its step behind it.
#[inline]
fn beyond<T: Real, const N: usize, const S: usize>(
    coefficients: &[SVector<T, N>; S],
    ahead: T,
) -> SVector<T, N> {
    let s = T::from_f64(1.0) + ahead;
    let mut sum = SVector::<T, N>::from_element(T::from_f64(0.0));
    for (place, coefficient) in coefficients.iter().enumerate().skip(1).rev() {
        let factor = if place > 1 && place % 2 == 1 {
            -ahead
        } else {
            s
        };
        sum.zip_apply(coefficient, |sum, coefficient| {
            *sum = factor * (coefficient + *sum);
        });
    }
    coefficients[0].zip_map(&sum, |change, sum| ahead * (change - sum))
}

/// A matrix of numbers times vectors.
#[inline(always)]
fn transformed<T: Real, const N: usize, const S: usize>(
    matrix: &[[f64; S]; S],
    vectors: &[SVector<T, N>; S],
) -> [SVector<T, N>; S] {
    let mut products = [SVector::from_element(T::from_f64(0.0)); S];
    for (product, row) in products.iter_mut().zip(matrix) {
        *product = combination(row, vectors);
    }
    products
}

/// A method of this family.
macro_rules! radau {
    ($name:ident, $tableau:ident: $stages:literal, $pairs:literal, $text:literal, order $order:literal, $dense:literal, $estimate:literal) => {
        impl Method for $name {
            const NAME: &'static str = $text;
            const ORDER: u32 = $order;
            const DENSE_ORDER: u32 = $dense;
        }

        impl Estimating for $name {
            const ESTIMATE_ORDER: u32 = $estimate;
        }

        impl Tabulated<$stages, $pairs> for $name {
            #[allow(private_interfaces, reason = "no method is written outside")]
            const TABLEAU: Tableau<$stages, $pairs> = $tableau;
        }

        impl Family for $name {
            type Work<T: Real, const N: usize> = Stages<Self, T, N, $stages, $pairs>;

            #[allow(private_interfaces, reason = "no method is written outside")]
            const RULE: Rule = Rule::Steady;
        }
    };
}

radau!(Radau5, RADAU5: 3, 1, "Radau IIA 5", order 5, 4, 4);
radau!(Radau9, RADAU9: 5, 2, "Radau IIA 9", order 9, 6, 6);

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::step::trees::Scheme;

    /// The tableau's matrix `T Λ⁻¹ T⁻¹` meets the conditions of the order with its last row as result.
    fn assert_orders<const S: usize, const PAIRS: usize>(
        name: &str,
        tableau: &Tableau<S, PAIRS>,
        order: usize,
        within: f64,
    ) {
        let mut blocks = SMatrix::<f64, S, S>::zeros();
        blocks[(0, 0)] = tableau.real;
        for (pair, [alpha, beta]) in tableau.pairs.iter().enumerate() {
            let place = 1 + 2 * pair;
            blocks[(place, place)] = *alpha;
            blocks[(place, place + 1)] = -beta;
            blocks[(place + 1, place)] = *beta;
            blocks[(place + 1, place + 1)] = *alpha;
        }
        let [vectors, inverse] = [tableau.vectors, tableau.inverse]
            .map(|rows| SMatrix::<f64, S, S>::from_fn(|row, column| rows[row][column]));
        let identity: SMatrix<f64, S, S> = vectors * inverse;
        assert!((identity - SMatrix::identity()).norm() < within);
        let slopes: SMatrix<f64, S, S> = vectors * blocks * inverse;
        let matrix = slopes.try_inverse().unwrap();
        let rows: Vec<Vec<f64>> = matrix
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        for (row, node) in rows.iter().zip(tableau.nodes) {
            assert!((row.iter().sum::<f64>() - node).abs() < within);
        }
        let scheme = Scheme {
            several: rows.clone(),
            single: rows.clone(),
        };
        scheme.assert_order(name, &rows[S - 1], order, 1.0, within);
        // The interpolation as weights of the stages' slopes.
        let stages: [SVector<f64, S>; S] =
            core::array::from_fn(|stage| SVector::from_row_slice(&rows[stage]));
        let found = transformed(&tableau.dense, &stages);
        let mut between = Polynomial::line(&SVector::zeros(), &found[0]);
        for (place, coefficient) in found.iter().enumerate() {
            between.coefficients[place] = *coefficient;
        }
        for s in [0.1, 0.35, 0.8] {
            scheme.assert_order(name, between.at(s).as_slice(), S, s, 10.0 * within);
        }
        for ahead in [0.3, 1.0] {
            let expected = between.at(1.0 + ahead) - stages[S - 1];
            assert!((beyond(&found, ahead) - expected).norm() < 1e3 * within);
        }
        // The slope at the end, of powers of the part of the step.
        for power in 1..=S as i32 {
            let terms = tableau.slope_at_end().into_iter().zip(tableau.nodes);
            let slope: f64 = terms.map(|(weight, node)| weight * node.powi(power)).sum();
            assert!(
                (slope - f64::from(power)).abs() < 100.0 * within,
                "{name}: {slope}"
            );
        }
        // The estimate is the difference to a quadrature of order S, e = b̂ − b, with a slope at the start.
        let estimate = SVector::from(tableau.error).transpose() * matrix;
        for power in 0..S as i32 {
            let terms = estimate.iter().zip(tableau.nodes);
            let sum: f64 = terms.map(|(weight, node)| weight * node.powi(power)).sum();
            let expected = if power == 0 { -1.0 } else { 0.0 };
            assert!((sum - expected).abs() < 10.0 * within, "{name}: {sum}");
        }
    }

    #[test]
    fn conditions_of_order_hold() {
        assert_orders("Radau IIA 5", &RADAU5, 5, 1e-14);
        assert_orders("Radau IIA 9", &RADAU9, 9, 1e-13);
    }
}
