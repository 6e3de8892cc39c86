//! Collocation by sweeps that evaluate all stages at once.

use nalgebra::SVector;

use super::dense::Polynomial;
use super::method::{
    Estimating, Family, Method, Start, Stepper, Trial, combination, lagrange, leading,
};
use super::problem::Problem;
use super::tolerance::{Measure, Tolerance};
use crate::{Columns, Input, Real, System};

/// The parallel iteration of Lobatto's method with five stages.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 8 | 5, error of power 6, free of charge | 8 | four sweeps of four at once, at times one more | −1.69 | 1.70, but up to 1.0 it grows by as much as 1e-6 a step |
///
/// For smooth problems to tight tolerances whose derivative is not cheap, in programs that are compiled for registers of four
/// numbers (`-C target-cpu=x86-64-v3` or `native`) with the feature `lanes`: a sweep evaluates all stages in little more
/// time than one ([`System::derivatives`]). Without lanes, in `f32`, on dual numbers and for models with nonlinear loops it
/// gives the same, and [`Dop853`](super::Dop853) is faster. So it is for a handful of products per state.
///
/// Sweeps begin with the polynomial of the step before. At the start and behind a jump there is none, and three more are
/// taken. The limits of stability are those of steps of one length.
///
/// Source: P. J. van der Houwen and B. P. Sommeijer, *Journal of Computational and Applied Mathematics* 29 (1990),
/// 111–127; the method that is iterated is Lobatto IIIA in Hairer and Wanner, *Solving Ordinary Differential Equations II*,
/// 2nd ed. (1996), IV.5.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pirk8;

impl Method for Pirk8 {
    const NAME: &'static str = "PIRK 8";
    const ORDER: u32 = 8;
    const DENSE_ORDER: u32 = 6;
}

impl Estimating for Pirk8 {
    const ESTIMATE_ORDER: u32 = 9;
}

impl Family for Pirk8 {
    type Work<T: Real, const N: usize> = Stages<T, N>;

    const IMPLICIT: bool = false;
}

/// The nodes; the first is the start.
const NODES: [f64; 5] = [
    0.0,
    0.172_673_164_646_011_43,
    0.5,
    0.827_326_835_353_988_6,
    1.0,
];

/// Weights of the slope at each node in the states at all nodes but the first.
const WEIGHTS: [[f64; 4]; 5] = [
    [
        0.067_728_432_186_156_9,
        0.040_625,
        0.053_700_139_242_414_534,
        0.05,
    ],
    [
        0.119_744_769_343_411_69,
        0.303_184_183_323_042_76,
        0.261_586_397_996_806_7,
        49.0 / 180.0,
    ],
    [
        -0.021_735_721_866_558_113,
        8.0 / 45.0,
        0.377_291_277_422_113_66,
        16.0 / 45.0,
    ],
    [
        0.010_635_824_225_415_492,
        -0.030_961_961_100_820_556,
        0.152_477_452_878_810_54,
        49.0 / 180.0,
    ],
    [
        -0.003_700_139_242_414_530_6,
        0.009_375,
        -0.017_728_432_186_156_898,
        0.05,
    ],
];

/// Weights of the coefficients of the polynomial behind those of the cubic.
const DENSE: [[f64; 5]; 2] = [
    [
        -3.15,
        5.939_835_822_057_573_5,
        -56.0 / 15.0,
        0.593_497_511_275_76,
        0.35,
    ],
    [2.8, -98.0 / 15.0, 112.0 / 15.0, -98.0 / 15.0, 2.8],
];

/// Weights of the slope at each node in the second and in the fourth of Legendre's coefficients.
const LEGENDRE: [[f64; 2]; 5] = [
    [0.25, 0.2],
    [7.0 / 36.0, -7.0 / 15.0],
    [-8.0 / 9.0, 8.0 / 15.0],
    [7.0 / 36.0, -7.0 / 15.0],
    [0.25, 0.2],
];

/// Sweeps of a step.
const SWEEPS: u32 = 4;
/// Further sweeps where there is no step before.
const FIRST: u32 = 3;
/// An error of up to so many tolerances is worth one more sweep.
const WORTH: f64 = 30.0;

/// Slopes at the nodes of a step.
#[derive(Clone, Copy)]
struct Slopes<T: Real, const N: usize> {
    length: T,
    first: SVector<T, N>,
    others: SVector<T::Stages, N>,
}

/// The last step that was taken, and the one that was tried last.
pub struct Stages<T: Real, const N: usize> {
    before: Option<Slopes<T, N>>,
    tried: Option<Slopes<T, N>>,
}

#[allow(private_interfaces, reason = "no method is written outside")]
impl<T: Real, const N: usize> Stepper<Pirk8, T, N> for Stages<T, N> {
    fn new(_method: &Pirk8) -> Self {
        Self {
            before: None,
            tried: None,
        }
    }

    fn attempt<S, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: Option<&Tolerance<N>>,
    ) -> Trial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        if !start.again {
            self.before = self.tried;
        }
        let length = start.span.length;
        let weights = WEIGHTS.map(|row| scaled::<T>(length, row));
        let base = SVector::from_fn(|state, _| {
            let slope = T::Stages::whole(start.slope[state]);
            weights[0].multiply_add(slope, T::Stages::whole(start.x[state]))
        });
        let times = T::Stages::from_columns(|stage| start.span.at(T::from_f64(NODES[stage + 1])));
        let sweeps = match self.before {
            Some(_) => SWEEPS,
            None => SWEEPS + FIRST,
        };

        let mut stages = advanced::<T, N>(&base, &weights, &self.predicted(start));
        let measure = tolerance.map(|it| it.between(&start.x, &(at::<T, N>(3, &stages) - start.x)));
        let (mut sweep, mut missed) = (0, 0.0);
        let (slopes, mut error) = loop {
            let slopes = problem.slopes(times, &stages);
            let next = advanced::<T, N>(&base, &weights, &slopes);
            let change = at::<T, N>(3, &(next - stages));
            stages = next;
            sweep += 1;
            if let Some(measure) = &measure
                && sweep == 1
            {
                missed = truncation::<T, N>(measure, start, &slopes);
            }
            if sweep < sweeps {
                continue;
            }
            let square = measure.as_ref().map_or(0.0, |it| it.square(&change));
            let error = Real::sqrt(square + missed);
            if sweep > sweeps || !(1.0..WORTH).contains(&error) {
                break (slopes, error);
            }
        };
        if sweep > sweeps {
            // Good enough or not, the next step shall be shorter.
            error = error.max(1.0);
        }
        self.tried = Some(Slopes {
            length,
            first: start.slope,
            others: slopes,
        });
        Trial {
            change: at::<T, N>(3, &stages) - start.x,
            slope: Some(at::<T, N>(3, &slopes)),
            error,
        }
    }

    fn polynomial<S, I, const M: usize, const P: usize>(
        &mut self,
        _problem: &mut Problem<'_, T, S, I, N, M, P>,
        start: &Start<T, N>,
        (end, _): (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        S: System<T, N, M, P>,
        I: Input<T, M>,
    {
        self.between(start, end)
    }
}

impl<T: Real, const N: usize> Stages<T, N> {
    /// The polynomial over the step that was tried last.
    fn between(&self, start: &Start<T, N>, end: &SVector<T, N>) -> Polynomial<T, N> {
        let Some(tried) = &self.tried else {
            return Polynomial::line(&start.x, end);
        };
        let slopes: [SVector<T, N>; 5] = core::array::from_fn(|node| match node {
            0 => tried.first,
            _ => tried.others.map(|it| it.as_columns()[node - 1]),
        });
        let scaled = |slope: SVector<T, N>| slope.map(|slope| tried.length * slope);
        let mut polynomial =
            Polynomial::cubic((&start.x, scaled(slopes[0])), (end, scaled(slopes[4])));
        let higher = polynomial.coefficients.iter_mut().skip(3);
        for (coefficient, weights) in higher.zip(DENSE) {
            *coefficient = scaled(combination(&weights, &slopes));
        }
        polynomial
    }

    /// The slopes as the last step continues; without one, those at the start.
    fn predicted(&self, start: &Start<T, N>) -> SVector<T::Stages, N> {
        let Some(before) = &self.before else {
            return start.slope.map(T::Stages::whole);
        };
        let ratio = start.span.length / before.length;
        let places = scaled::<T>(ratio, [NODES[1], NODES[2], NODES[3], NODES[4]]);
        let distances = NODES.map(|node| places + T::Stages::from_f64(1.0 - node));
        let weights = lagrange(const { &leading(&NODES) }, &distances);
        SVector::from_fn(|state, _| {
            let first = weights[0] * T::Stages::whole(before.first[state]);
            summed::<T>(first, &weights, &before.others[state])
        })
    }
}

/// Numbers of the stages times one of all.
#[inline]
fn scaled<T: Real>(by: T, numbers: [f64; 4]) -> T::Stages {
    T::Stages::from_columns(|stage| by * T::from_f64(numbers[stage]))
}

/// The states at the stages, from slopes there.
#[inline(always)]
fn advanced<T: Real, const N: usize>(
    base: &SVector<T::Stages, N>,
    weights: &[T::Stages; 5],
    slopes: &SVector<T::Stages, N>,
) -> SVector<T::Stages, N> {
    SVector::from_fn(|state, _| summed::<T>(base[state], weights, &slopes[state]))
}

/// `sum` and the slopes at all nodes but the first, weighted.
#[inline(always)]
fn summed<T: Real>(sum: T::Stages, weights: &[T::Stages; 5], slopes: &T::Stages) -> T::Stages {
    let slopes = slopes.as_columns();
    let [a, b, c, d] = [0, 1, 2, 3].map(|stage| T::Stages::whole(slopes[stage]));
    let early = weights[2].multiply_add(b, weights[1].multiply_add(a, sum));
    early + weights[4].multiply_add(d, weights[3] * c)
}

/// What the method misses even where the sweeps come to their end: the mean square in units of the tolerance.
///
/// Legendre's coefficients of smooth slopes fall by much the same ratio r from the second to the fourth and from there to
/// the eighth, which is the first that the method takes for another: of a sine it is the fourth times r² / 16, and a
/// quarter of it counts. Where slopes jump r is near one, and all of the fourth counts.
#[inline(never)]
fn truncation<T: Real, const N: usize>(
    measure: &Measure<N>,
    start: &Start<T, N>,
    slopes: &SVector<T::Stages, N>,
) -> f64 {
    let length = start.span.length;
    let weights = LEGENDRE.map(|[second, fourth]| scaled::<T>(length, [second, fourth, 0.0, 0.0]));
    let both = SVector::from_fn(|state, _| {
        let first = weights[0] * T::Stages::whole(start.slope[state]);
        summed::<T>(first, &weights, &slopes[state])
    });
    let [second, fourth] = [0, 1].map(|place| measure.square(&at::<T, N>(place, &both)));
    let ratio = fourth / (fourth + second).max(f64::MIN_POSITIVE);
    fourth * ratio * ratio * (ratio + 1.0 / 4096.0)
}

/// One of the stages.
#[inline(always)]
fn at<T: Real, const N: usize>(stage: usize, stages: &SVector<T::Stages, N>) -> SVector<T, N> {
    stages.map(|it| it.as_columns()[stage])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::method::Span;
    use crate::step::trees::Scheme;
    use std::vec::Vec;

    const OVER_ONE: Span<f64> = Span {
        start: 0.0,
        end: 1.0,
        length: 1.0,
    };

    /// A step of length 1 from zero of a state per node, of which each has a slope at its own node alone.
    fn apart() -> (Start<f64, 5>, SVector<<f64 as Real>::Stages, 5>) {
        let unit = |node: usize| SVector::<f64, 5>::from_fn(|row, _| f64::from(row == node));
        let start = Start {
            span: OVER_ONE,
            x: SVector::zeros(),
            slope: unit(0),
            again: false,
        };
        let others = SVector::from_fn(|state, _| {
            <f64 as Real>::Stages::from_columns(|stage| unit(stage + 1)[state])
        });
        (start, others)
    }

    #[test]
    fn conditions_of_order_hold() {
        let row = |stage: usize| -> Vec<f64> { WEIGHTS.map(|weights| weights[stage]).to_vec() };
        let mut rows = std::vec![std::vec![0.0; 5]];
        rows.extend((0..4).map(row));
        for (row, node) in rows.iter().zip(NODES) {
            assert!((row.iter().sum::<f64>() - node).abs() < 1e-15);
        }
        let scheme = Scheme {
            several: rows.clone(),
            single: rows,
        };
        scheme.assert_order("PIRK 8", &row(3), 8, 1.0, 1e-15);
        let (start, others) = apart();
        let work = Stages {
            before: None,
            tried: Some(Slopes {
                length: 1.0,
                first: start.slope,
                others,
            }),
        };
        for s in [0.1, 0.35, 0.8] {
            let weights = work
                .between(&start, &SVector::from_row_slice(&row(3)))
                .at(s);
            scheme.assert_order("PIRK 8", weights.as_slice(), 5, s, 1e-14);
        }
    }

    #[test]
    fn a_quartic_is_continued_whatever_the_lengths_are() {
        let slope = |t: f64| 1.0 + t * (2.0 - t * (1.0 + t * (0.5 - 0.25 * t)));
        let (before, length) = (0.8, 1.3);
        let work = Stages {
            before: Some(Slopes {
                length: before,
                first: SVector::from([slope(0.0)]),
                others: SVector::from([<f64 as Real>::Stages::from_columns(|stage| {
                    slope(before * NODES[stage + 1])
                })]),
            }),
            tried: None,
        };
        let start = Start {
            span: Span {
                start: before,
                end: before + length,
                length,
            },
            x: SVector::from([0.0]),
            slope: SVector::from([slope(before)]),
            again: false,
        };
        let predicted = work.predicted(&start)[0];
        let predicted: &[f64] = predicted.as_columns();
        for (stage, predicted) in predicted.iter().enumerate() {
            let expected = slope(before + length * NODES[stage + 1]);
            assert!(
                (predicted - expected).abs() < 1e-12,
                "{predicted} {expected}"
            );
        }
    }

    /// Legendre's polynomials over the step: the second and the fourth are told apart from all others.
    #[test]
    fn the_truncation_sees_smooth_slopes_less_than_jumps() {
        let measure = Tolerance::<1>::new(0.0, 1.0, &[]).around(&SVector::from([0.0]));
        let missed = |slope: &dyn Fn(f64) -> f64| -> f64 {
            let start = Start {
                span: OVER_ONE,
                x: SVector::from([0.0]),
                slope: SVector::from([slope(0.0)]),
                again: false,
            };
            let others = <f64 as Real>::Stages::from_columns(|stage| slope(NODES[stage + 1]));
            Real::sqrt(truncation(&measure, &start, &SVector::from([others])))
        };
        assert!(missed(&|t| 1.0 + t * (3.0 - t * (2.0 - t))) < 1e-30);
        let fourth = |t: f64| 1.0 + t * (-20.0 + t * (90.0 + t * (-140.0 + t * 70.0)));
        assert!((missed(&fourth) - 1.0).abs() < 1e-3);
        // What the method misses of a sine, and of a jump.
        for angle in [1.0, 2.0, 4.0, 8.0] {
            let slope = |t: f64| Real::sin(angle * t + 0.4);
            let exact = (0.4_f64.cos() - (angle + 0.4).cos()) / angle;
            let found: f64 = (0..5).map(|node| ends(node) * slope(NODES[node])).sum();
            let ratio = missed(&slope) / (found - exact).abs();
            assert!(ratio > 0.5 && ratio < 50.0, "{angle} {ratio}");
        }
        for jump in [0.1, 0.3, 0.6, 0.9] {
            let slope = |t: f64| f64::from(t > jump);
            let found: f64 = (0..5).map(|node| ends(node) * slope(NODES[node])).sum();
            let ratio = missed(&slope) / (found - (1.0 - jump)).abs();
            assert!(ratio > 0.1, "{jump} {ratio}");
        }
    }

    /// The weight of a slope at the end of the step.
    fn ends(node: usize) -> f64 {
        WEIGHTS[node][3]
    }
}
