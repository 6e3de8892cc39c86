//! Explicit methods of Runge and Kutta.

mod dop853;
mod tsit5;
#[cfg(feature = "numeris")]
mod verner;

use core::marker::PhantomData;
use core::ops::Range;

use nalgebra::SVector;

use super::dense::{Part, Polynomial};
use super::method::{
    Estimating, Family, Method, Span, Start, Stepper, Trial, ahead, combination, each_stage, row,
};
use super::problem::Problem;
use super::seen;
use super::tolerance::Tolerance;
use crate::{Input, Real, System};
use dop853::DOP853;
use tsit5::TSIT5;
#[cfg(feature = "numeris")]
use verner::VERNER9;

/// The classical method of Runge and Kutta.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 4 | 4 | none | 4 | −2.79 | 2.83 |
///
/// For smooth problems at a fixed step, above all on a microcontroller: the cost per step is known in advance. Rounding
/// in `f32` is kept out by [`Fixed::compensated`](super::Fixed::compensated).
///
/// Source: W. Kutta, *Zeitschrift für Mathematik und Physik* 46 (1901), 435–453; dense output by Hermite's cubic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4;

/// The pair of Tsitouras.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 5 | 4 free of charge, error of power 5 | 4 | 6, the last being the first of the next step | −3.51 | 0 |
///
/// For smooth problems to relative errors of about 1e-5, between jumps that are close together, and for closed loops.
///
/// Source: Ch. Tsitouras, *Computers and Mathematics with Applications* 62 (2011), 770–775.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tsit5;

/// The method of Dormand and Prince of order 8 with estimates of orders 5 and 3.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 8 | 7, error of power 8; 4 more evaluations, 30 where stability limits steps | 7 | 12 | −6.39 | 5.96 |
///
/// For smooth problems to tight tolerances, from about 1e-6 on. Where closed loops pass positions in which their
/// equations become dependent, its long steps end too near them at times and the run stops; [`Tsit5`] passes them.
///
/// Source: `dop853` in Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dop853;

/// The pair of Verner of order 9(8), of the crate `numeris`; only with the feature of that name.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 9 | 8, error of power 9; 5 more evaluations | 8 | 16 | −4.47 | 2.75 |
///
/// For smooth problems to errors of about 1e-5 and less, where jumps are rare. `numeris` gives the coefficients; the steps
/// are those of [`Adaptive`](super::Adaptive) or [`Fixed`](super::Fixed), with all that they look after.
///
/// Source: J. H. Verner, *Numerical Algorithms* 53 (2010), 383–396; the "most efficient" pair with an interpolant of
/// order 8, <https://www.sfu.ca/~jverner/>.
///
/// # Example
///
/// ```
/// use mbg_runtime::{Adaptive, Integrator, Stopped, System, Verner9};
///
/// /// The first state at two times.
/// fn swing<const P: usize>(model: &impl System<f64, 4, 0, P>) -> Result<[f64; 2], Stopped> {
///     let solver = Adaptive::new(Verner9, 1e-10, 1e-12);
///     let mut samples = [0.0; 2];
///     let mut slots = samples.iter_mut();
///     solver.sample(model, &(), 0.0, model.initial_state(), &[1.0, 5.0], |_t, x| {
///         if let Some(slot) = slots.next() {
///             *slot = x[0];
///         }
///     })?;
///     Ok(samples)
/// }
/// ```
#[cfg(feature = "numeris")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verner9;

/// What a polynomial misses in the middle of a step that the derivative tells there, in units of the tolerances, where it is as exact
/// as steps.
const MISSED: f64 = 10.0;

/// Coefficients of a method with `S` stages; `F` counts the slope at the end and stages for the dense output too.
struct Tableau<const S: usize, const F: usize> {
    nodes: [f64; F],
    /// Weights of the slopes before it: of each stage, then of the result, then of each further stage.
    rows: [&'static [f64]; F],
    /// Weights of the error; where there are two, the second keeps the first from being too good by chance.
    errors: [&'static [f64]; 2],
    /// Weights of the coefficients of the polynomial behind those of the cubic.
    dense: [&'static [f64]; 5],
}

const RK4: Tableau<4, 5> = Tableau {
    nodes: [0.0, 0.5, 0.5, 1.0, 1.0],
    rows: [
        &[],
        &[0.5],
        &[0.0, 0.5],
        &[0.0, 0.0, 1.0],
        &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
    ],
    errors: [&[], &[]],
    dense: [&[], &[], &[], &[], &[]],
};

impl<const S: usize, const F: usize> Tableau<S, F> {
    /// The weights of the result.
    const fn result(&self) -> &'static [f64] {
        self.rows[S]
    }
}

/// A method of this family.
pub trait Tabulated<const S: usize, const F: usize>: Copy {
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no method is written outside")]
    const TABLEAU: Tableau<S, F>;
}

/// The slopes of the last step.
pub struct Slopes<A, T, const N: usize, const S: usize, const F: usize> {
    slopes: [SVector<T, N>; F],
    method: PhantomData<A>,
}

impl<A, T, const N: usize, const S: usize, const F: usize> Slopes<A, T, N, S, F>
where
    A: Tabulated<S, F>,
    T: Real,
{
    /// The state of a stage but for the slope before it, and how far that one leads.
    #[inline(always)]
    fn base<const STAGE: usize>(&self, start: &Start<T, N>) -> (SVector<T, N>, T) {
        let length = start.span.length;
        match const { row(&A::TABLEAU.rows, STAGE) } {
            [earlier @ .., weight] => (
                ahead(&start.x, length, &combination(earlier, &self.slopes)),
                length * T::from_f64(*weight),
            ),
            [] => (start.x, T::from_f64(0.0)),
        }
    }

    /// Evaluates stages.
    ///
    /// The slope before a stage is added last and by one operation: while it is evaluated, all others are summed.
    #[inline(always)]
    fn evaluate<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        stages: Range<usize>,
    ) where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let mut last = self.slopes[stages.start - 1];
        each_stage!(STAGE in stages => {
            let (base, factor) = self.base::<STAGE>(start);
            let x = ahead(&base, factor, &last);
            let t = start.span.at(T::from_f64(A::TABLEAU.nodes[STAGE]));
            last = problem.slope(t, &x);
            self.slopes[STAGE] = last;
        });
    }

    /// The polynomial of degree 7 through the ends of a step, and those of steps to a third and to two thirds of it.
    ///
    /// What decays fast is small at the end of a step that is as long as stability allows, and not in between, where stages for
    /// dense output weigh what they take from it by hundreds.
    #[cold]
    fn between<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        end: &SVector<T, N>,
    ) -> Polynomial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let length = start.span.length;
        let scaled = |slope: SVector<T, N>| slope.map(|slope| length * slope);
        let mut part_way = Self {
            slopes: self.slopes,
            method: PhantomData,
        };
        part_way.slopes[0] = start.slope;
        let there = [1.0, 2.0].map(|thirds| {
            let part = T::from_f64(thirds / 3.0);
            let span = Span {
                end: start.span.at(part),
                length: part * length,
                ..start.span
            };
            let from = Start { span, ..*start };
            part_way.evaluate(problem, &from, 1..S);
            let mean = combination(const { A::TABLEAU.result() }, &part_way.slopes);
            let x = ahead(&start.x, span.length, &mean);
            let slope = problem.slope(span.end, &x);
            (x, scaled(slope))
        });
        let first = (&start.x, scaled(start.slope));
        let last = (end, scaled(self.slopes[S]));
        Polynomial::cubic(first, last).through_thirds(there)
    }

    /// Whether a stage for the dense output alone was beyond a threshold that the step is not, which no error tells.
    fn is_astray<Y, I, const M: usize, const P: usize>(
        &self,
        problem: &Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        end: &SVector<T, N>,
    ) -> bool
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let ends = [(start.span.start, start.x), (start.span.end, *end)];
        let mut is_astray = false;
        each_stage!(STAGE in S + 1..F => {
            let (base, factor) = self.base::<STAGE>(start);
            let x = ahead(&base, factor, &self.slopes[STAGE - 1]);
            let stage = (start.span.at(T::from_f64(A::TABLEAU.nodes[STAGE])), x);
            let [before, behind] = ends.each_ref().map(|end| problem.met(end, &stage));
            is_astray |= before.meets(&behind);
        });
        is_astray
    }
}

#[allow(private_interfaces, reason = "no method is written outside")]
impl<A, T, const N: usize, const S: usize, const F: usize> Stepper<A, T, N>
    for Slopes<A, T, N, S, F>
where
    A: Tabulated<S, F>,
    T: Real,
{
    fn new(_method: &A) -> Self {
        Self {
            slopes: [SVector::from_element(T::from_f64(0.0)); F],
            method: PhantomData,
        }
    }

    // A call would pass state and slopes through memory, which takes longer than a stage.
    #[inline(always)]
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
        self.slopes[0] = start.slope;
        self.evaluate(problem, start, 1..S);
        let result = const { A::TABLEAU.result() };
        let change = combination(result, &self.slopes).map(|sum| length * sum);
        let [fine, coarse] = const { A::TABLEAU.errors };
        // An estimate that weighs the slope at the end makes it the first of the next step.
        let slope = (tolerance.is_some() && fine.len() > S).then(|| {
            self.slopes[S] = problem.slope(start.span.end, &(start.x + change));
            self.slopes[S]
        });
        let (error, coarse) = match tolerance {
            Some(tolerance) if !fine.is_empty() => {
                let measure = tolerance.between(&start.x, &change);
                let square = |weights| measure.square(&combination(weights, &self.slopes));
                let fine = square(fine);
                let (error, coarse) = if coarse.is_empty() {
                    (Real::sqrt(fine), fine)
                } else {
                    let coarse = square(coarse);
                    (both(fine, coarse), coarse)
                };
                let length = seen(length);
                (length * error, length * length * coarse)
            }
            _ => (0.0, 0.0),
        };
        Trial {
            change,
            slope,
            error,
            coarse,
        }
    }

    fn polynomial<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        (end, slope): (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let length = start.span.length;
        let last = slope.unwrap_or_else(|| problem.slope(start.span.end, end));
        self.slopes[S] = last;
        self.evaluate(problem, start, S + 1..F);
        let scaled = |slope: SVector<T, N>| slope.map(|slope| length * slope);
        let mut polynomial =
            Polynomial::cubic((&start.x, scaled(start.slope)), (end, scaled(last)));
        if Y::HAS_COURSES && self.is_astray(problem, start, end) {
            return polynomial;
        }
        let higher = polynomial.coefficients.iter_mut().skip(3);
        for (coefficient, weights) in higher.zip(A::TABLEAU.dense) {
            *coefficient = scaled(combination(weights, &self.slopes));
        }
        polynomial
    }

    fn samples<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        (end, slope): (&SVector<T, N>, Option<SVector<T, N>>),
        tolerance: &Tolerance<N>,
        _place: f64,
    ) -> Part<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let polynomial = self.polynomial(problem, start, (end, slope));
        if const { F == S + 1 } {
            return Part::whole(polynomial);
        }
        let half = T::from_f64(0.5);
        let missed = problem.missed(start, &polynomial, half);
        let measure = tolerance.between(&start.x, &(end - start.x));
        Part::whole(match measure.norm(&missed) > MISSED {
            true => self.between(problem, start, end),
            false => polynomial,
        })
    }
}

/// One error from the squares of a fine and a coarse estimate, as `dop853` does it.
fn both(fine: f64, coarse: f64) -> f64 {
    if fine == 0.0 {
        return 0.0;
    }
    fine / Real::sqrt(fine + 0.01 * coarse)
}

/// A method of this family.
macro_rules! explicit {
    ($name:ident, $tableau:ident: $stages:literal of $all:literal, $text:literal, order $order:literal, $dense:literal) => {
        impl Method for $name {
            const NAME: &'static str = $text;
            const ORDER: u32 = $order;
            const DENSE_ORDER: u32 = $dense;
        }

        impl Tabulated<$stages, $all> for $name {
            #[allow(private_interfaces, reason = "no method is written outside")]
            const TABLEAU: Tableau<$stages, $all> = $tableau;
        }

        impl Family for $name {
            type Work<T: Real, const N: usize> = Slopes<Self, T, N, $stages, $all>;

            const IMPLICIT: bool = false;

            const LOOSEST: f64 = 1e-2;
        }
    };
}

explicit!(Rk4, RK4: 4 of 5, "RK4", order 4, 4);
explicit!(Tsit5, TSIT5: 6 of 7, "Tsit5", order 5, 5);
explicit!(Dop853, DOP853: 12 of 16, "Dop853", order 8, 8);
#[cfg(feature = "numeris")]
explicit!(Verner9, VERNER9: 16 of 21, "Verner 9(8)", order 9, 9);

impl Estimating for Tsit5 {
    const ESTIMATE_ORDER: u32 = 5;
}

impl Estimating for Dop853 {
    const ESTIMATE_ORDER: u32 = 8;
}

#[cfg(feature = "numeris")]
impl Estimating for Verner9 {
    const ESTIMATE_ORDER: u32 = 9;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::trees::Scheme;
    use std::vec::Vec;

    fn padded(row: &[f64], length: usize) -> Vec<f64> {
        let zeros = core::iter::repeat(&0.0);
        row.iter().chain(zeros).take(length).copied().collect()
    }

    fn scheme<const S: usize, const F: usize>(tableau: &Tableau<S, F>) -> Scheme {
        let rows: Vec<Vec<f64>> = tableau.rows.iter().map(|row| padded(row, F)).collect();
        for (row, node) in rows.iter().zip(tableau.nodes) {
            let sum: f64 = row.iter().sum();
            assert!((sum - node).abs() < 1e-13, "{sum} {node}");
        }
        Scheme {
            several: rows.clone(),
            single: rows,
        }
    }

    /// Weights of all slopes in the state after the fraction `s` of a step.
    fn between<const S: usize, const F: usize>(tableau: &Tableau<S, F>, s: f64) -> Vec<f64> {
        let unit = |place: usize| SVector::<f64, F>::from_fn(|row, _| f64::from(row == place));
        let end = SVector::from_row_slice(&padded(tableau.rows[S], F));
        let zero = SVector::zeros();
        let mut polynomial = Polynomial::cubic((&zero, unit(0)), (&end, unit(S)));
        for (coefficient, weights) in polynomial
            .coefficients
            .iter_mut()
            .skip(3)
            .zip(tableau.dense)
        {
            *coefficient = SVector::from_row_slice(&padded(weights, F));
        }
        polynomial.at(s).iter().copied().collect()
    }

    fn assert_orders<const S: usize, const F: usize>(
        name: &str,
        tableau: &Tableau<S, F>,
        [order, dense]: [usize; 2],
    ) {
        let scheme = scheme(tableau);
        let result = padded(tableau.rows[S], F);
        scheme.assert_order(name, &result, order, 1.0, 1e-13);
        for s in [0.1, 0.35, 0.8] {
            scheme.assert_order(name, &between(tableau, s), dense, s, 1e-12);
        }
    }

    #[test]
    fn conditions_of_order_hold() {
        assert_orders("RK4", &RK4, [4, 3]);
        assert_orders("Tsit5", &TSIT5, [5, 4]);
        assert_orders("Dop853", &DOP853, [8, 7]);
        #[cfg(feature = "numeris")]
        assert_orders("Verner 9(8)", &VERNER9, [9, 8]);
    }

    #[test]
    fn estimates_have_their_orders() {
        let embedded = |result: &[f64], error: &[f64], all: usize| -> Vec<f64> {
            let pairs = padded(result, all).into_iter().zip(padded(error, all));
            pairs.map(|(result, error)| result - error).collect()
        };
        let result = embedded(TSIT5.rows[6], TSIT5.errors[0], 7);
        scheme(&TSIT5).assert_order("Tsit5", &result, 4, 1.0, 1e-12);
        let scheme = scheme(&DOP853);
        for (error, order) in DOP853.errors.iter().zip([5, 3]) {
            let result = embedded(DOP853.rows[12], error, 16);
            scheme.assert_order("Dop853", &result, order, 1.0, 1e-12);
        }
        #[cfg(feature = "numeris")]
        {
            let result = embedded(VERNER9.rows[16], VERNER9.errors[0], 21);
            self::scheme(&VERNER9).assert_order("Verner 9(8)", &result, 8, 1.0, 1e-12);
        }
    }
}
