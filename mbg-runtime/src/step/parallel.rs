//! Collocation by sweeps that evaluate all stages at once.

use nalgebra::SVector;

use super::dense::Polynomial;
use super::method::{Estimating, Family, Method, Start, Stepper, Trial, combination};
use super::problem::Problem;
use super::tolerance::{Measure, Tolerance};
use crate::{Columns, Input, Real, System};

/// Lobatto's method with five stages, iterated in parallel.
///
/// | order | in between | estimate | evaluations a step | stability |
/// |---|---|---|---|---|
/// | 8 | 5, error of power 6, free of charge | 7 | three sweeps of four stages, rarely one more | |
///
/// For smooth problems to tight tolerances.
///
/// Source: P. J. van der Houwen and B. P. Sommeijer, *Journal of Computational and Applied Mathematics* 29 (1990),
/// 111–127; the collocation method in Hairer and Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996), IV.5.
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
        0.261_586_397_996_806_72,
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

/// Reciprocals of `Π (cⱼ − cᵢ)` over all other nodes.
const LEADING: [f64; 5] = [14.0, -98.0 / 3.0, 112.0 / 3.0, -98.0 / 3.0, 14.0];

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

/// Sweeps of a step.
const SWEEPS: u32 = 4;
/// Further sweeps where there is no step before.
const FIRST: u32 = 3;
/// An error of up to so many tolerances is worth one more sweep.
const WORTH: f64 = 30.0;
/// Weights of the slope at each node in the second and in the fourth of Legendre's coefficients.
const LEGENDRE: [[f64; 2]; 5] = [
    [0.25, 0.2],
    [7.0 / 36.0, -7.0 / 15.0],
    [-8.0 / 9.0, 8.0 / 15.0],
    [7.0 / 36.0, -7.0 / 15.0],
    [0.25, 0.2],
];

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
}

impl<T: Real, const N: usize> Stages<T, N> {
    /// The slopes as the last step continues; without one, those at the start.
    fn predicted(&self, start: &Start<T, N>) -> SVector<T::Stages, N> {
        let Some(before) = &self.before else {
            return start.slope.map(T::Stages::whole);
        };
        let ratio = start.span.length / before.length;
        let places = scaled::<T>(ratio, [NODES[1], NODES[2], NODES[3], NODES[4]]);
        let weights = continued::<T>(places);
        SVector::from_fn(|state, _| {
            let first = weights[0] * T::Stages::whole(before.first[state]);
            summed::<T>(first, &weights, &before.others[state])
        })
    }
}

/// Weights of the slopes of a step in the polynomial through them, at places behind its end in units of its length.
fn continued<T: Real>(places: T::Stages) -> [T::Stages; 5] {
    let number = T::Stages::from_f64;
    let from = NODES.map(|node| places + number(1.0 - node));
    let mut weights = LEADING.map(number);
    let mut before = number(1.0);
    let mut behind = number(1.0);
    for node in 0..5 {
        weights[node] = weights[node] * before;
        before = before * from[node];
        weights[4 - node] = weights[4 - node] * behind;
        behind = behind * from[4 - node];
    }
    weights
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
