//! Radau's method IIA with three stages.

use nalgebra::{SMatrix, SVector};

use super::control::Rule;
use super::dense::Polynomial;
use super::elimination::Shifted;
use super::linear::{Complex, Element};
use super::method::{
    Estimating, Family, Method, Start, Stepper, Trial, combination, larger, relative, settles,
};
use super::problem::Problem;
use super::tolerance::Tolerance;
use crate::scalar::power;
use crate::{Input, Real, System};

/// Radau's method IIA of order 5.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 5 | 3, error of power 4 | 3 | three evaluations, a real and a complex solve a sweep, 2 to 4 sweeps; Jacobian and factorisations when needed | A and L, stiffly accurate |
///
/// For stiff mechanics, above all where fast modes are lightly damped.
///
/// The stages are found by Newton's method in the coordinates in which the tableau is diagonal; the estimate is
/// filtered. Coefficients and decisions follow `radau5`. At a fixed step the sweeps go to rounding.
///
/// Source: Hairer and Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996), IV.8.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Radau5;

/// √6.
const Q: f64 = 2.449_489_742_783_178;
const NODES: [f64; 2] = [(4.0 - Q) / 10.0, (4.0 + Q) / 10.0];

/// Eigenvectors of the inverse of the tableau's matrix, the last of which is `[0.966…, 1, 0]`.
const VECTORS: [[f64; 3]; 3] = [
    [
        0.091_232_394_870_892_94,
        -0.141_255_295_020_954_2,
        -0.030_029_194_105_147_424,
    ],
    [
        0.241_717_932_707_107,
        0.204_129_352_293_799_94,
        0.382_942_112_757_261_9,
    ],
    [0.966_048_182_615_093, 1.0, 0.0],
];
/// The inverse of the matrix of them.
const INVERSE: [[f64; 3]; 3] = [
    [
        4.325_579_890_063_155,
        0.339_199_251_815_809_84,
        0.541_770_539_935_874_9,
    ],
    [
        -4.178_718_591_551_905,
        -0.327_682_820_761_062_4,
        0.476_623_554_500_550_44,
    ],
    [
        -0.502_872_634_945_786_9,
        2.571_926_949_855_605,
        -0.596_039_204_828_224_9,
    ],
];
/// The real eigenvalue.
const REAL: f64 = 3.637_834_252_744_496;
/// Real and imaginary part of the others.
const PAIR: [f64; 2] = [2.681_082_873_627_752_3, 3.050_430_199_247_411];
/// Weights of the stages in the estimate of the error.
const ERROR: [f64; 3] = [-(13.0 + 7.0 * Q) / 3.0, (-13.0 + 7.0 * Q) / 3.0, -1.0 / 3.0];
/// Most sweeps in a step that is controlled by its error.
const SWEEPS: i32 = 10;
/// Most sweeps to rounding.
const MOST: u32 = 20;
/// A sweep that reduces the error so much keeps the Jacobian.
const FAST: f64 = 1e-3;

/// What a step leaves for the next.
pub struct Stages<T, const N: usize> {
    jacobian: SMatrix<T, N, N>,
    /// Whether the Jacobian may serve for another step.
    keeps: bool,
    factors: Option<(T, Shifted<T, N>, Shifted<Complex<T>, N>)>,
    /// Last step: its length and the coefficients of its polynomial; none at the start and behind a jump.
    last: Option<(T, [SVector<T, N>; 3])>,
    tried: (T, [SVector<T, N>; 3]),
    /// How fast sweeps converge, from step to step.
    rate: f64,
    rejected: bool,
}

type Three<T, const N: usize> = [SVector<T, N>; 3];

#[allow(private_interfaces, reason = "no method is written outside")]
impl<T: Real, const N: usize> Stepper<Radau5, T, N> for Stages<T, N> {
    fn new(_method: &Radau5) -> Self {
        let zero = T::from_f64(0.0);
        Self {
            jacobian: SMatrix::from_element(zero),
            keeps: false,
            factors: None,
            last: None,
            tried: (zero, [SVector::from_element(zero); 3]),
            rate: 1.0,
            rejected: false,
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
        I: Input<T, M>,
    {
        let length = start.span.length;
        if !start.again {
            self.last = (self.tried.0 != T::from_f64(0.0)).then_some(self.tried);
        }
        let mut stages = self.predict(length);
        self.factorise(problem, start, &stages);
        let Some((_, real, pair)) = &self.factors else {
            return failed(&stages, f64::INFINITY);
        };
        let mut newton = Newton {
            problem,
            start,
            real,
            pair,
        };
        let found = match tolerance {
            Some(tolerance) => newton.controlled(&mut stages, tolerance, &mut self.rate),
            None => newton.settled(&mut stages),
        };
        let theta = match found {
            Ok(theta) => theta,
            Err(left) => {
                (self.keeps, self.rejected, self.rate) = (false, true, 1.0);
                return failed(&stages, left);
            }
        };
        self.keeps = theta <= FAST;
        let error = tolerance.map_or(0.0, |tolerance| {
            newton.error(&stages, tolerance, self.rejected || self.last.is_none())
        });
        self.rejected = error.is_nan() || error > 1.0;
        self.tried = (length, coefficients(&stages));
        Trial {
            change: stages[2],
            slope: None,
            error,
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
        I: Input<T, M>,
    {
        let mut polynomial = Polynomial::line(&start.x, end);
        let [_, bend, twist, ..] = &mut polynomial.coefficients;
        [*bend, *twist] = [self.tried.1[1], self.tried.1[2]];
        polynomial
    }
}

impl<T: Real, const N: usize> Stages<T, N> {
    /// A Jacobian and factors that serve for this step.
    ///
    /// The Jacobian is taken at the predicted second stage, a little behind the middle: over the step it is wrong by
    /// half of what one at the start would be, and sweeps converge faster.
    fn factorise<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        [_, middle, _]: &Three<T, N>,
    ) where
        Y: System<T, N, M, P>,
        I: Input<T, M>,
    {
        let Start { span, x, .. } = start;
        if !self.keeps {
            let t = span.at(T::from_f64(NODES[1]));
            self.jacobian = problem.jacobian(t, &(x + middle));
            self.factors = None;
        }
        let length = span.length;
        if self
            .factors
            .as_ref()
            .is_some_and(|(known, ..)| *known == length)
        {
            return;
        }
        problem.statistics.factorisations += 2;
        let by = |number: f64| T::from_f64(number) / length;
        let one = T::from_f64(1.0);
        let [real, imaginary] = PAIR.map(by);
        let pair = Complex { real, imaginary };
        let pair = Shifted::new::<Y, M, P>(pair, one, &self.jacobian);
        let real = Shifted::new::<Y, M, P>(by(REAL), one, &self.jacobian);
        self.factors = Some((length, real, pair));
    }

    /// The stages as the last step continues.
    fn predict(&self, length: T) -> Three<T, N> {
        let Some((before, [change, bend, twist])) = &self.last else {
            return [SVector::from_element(T::from_f64(0.0)); 3];
        };
        let one = T::from_f64(1.0);
        let ratio = length / *before;
        [NODES[0], NODES[1], 1.0].map(|node| {
            let s = one + ratio * T::from_f64(node);
            let ahead = ratio * T::from_f64(node);
            bend.zip_zip_map(twist, change, |bend, twist, change| {
                ahead * (change - s * (bend + s * twist))
            })
        })
    }
}

/// A step whose sweeps would leave so many times what is enough.
fn failed<T: Real, const N: usize>(stages: &Three<T, N>, left: f64) -> Trial<T, N> {
    Trial {
        change: stages[2],
        slope: None,
        error: left,
    }
}

/// Coefficients of the polynomial through the stages.
fn coefficients<T: Real, const N: usize>([first, second, third]: &Three<T, N>) -> Three<T, N> {
    let [c1, c2] = NODES;
    let slope = |stage: &SVector<T, N>, c: f64| {
        let (by, rest) = (T::from_f64(1.0 / c), T::from_f64(1.0 / (1.0 - c)));
        stage.zip_map(third, |stage, third| (stage * by - third) * rest)
    };
    let (low, high) = (slope(first, c1), slope(second, c2));
    let by = T::from_f64(1.0 / (c2 - c1));
    let twist = high.zip_map(&low, |high, low| (high - low) * by);
    let bend = low.zip_map(&twist, |low, twist| low - T::from_f64(c1) * twist);
    [*third, bend, twist]
}

/// A matrix of numbers times three vectors.
#[inline(always)]
fn transformed<T: Real, const N: usize>(
    [first, second, third]: &[[f64; 3]; 3],
    vectors: &Three<T, N>,
) -> Three<T, N> {
    [
        combination(first, vectors),
        combination(second, vectors),
        combination(third, vectors),
    ]
}

/// The search for the stages of one step.
struct Newton<'a, 'b, T, Y, I, const N: usize, const M: usize, const P: usize>
where
    T: Real,
    Y: System<T, N, M, P>,
{
    problem: &'a mut Problem<'b, T, Y, I, N, M, P>,
    start: &'a Start<T, N>,
    real: &'a Shifted<T, N>,
    pair: &'a Shifted<Complex<T>, N>,
}

impl<T, Y, I, const N: usize, const M: usize, const P: usize> Newton<'_, '_, T, Y, I, N, M, P>
where
    T: Real,
    Y: System<T, N, M, P>,
    I: Input<T, M>,
{
    /// One sweep; gives what it changed in the transformed stages.
    fn sweep(&mut self, stages: &mut Three<T, N>, inner: &mut Three<T, N>) -> Three<T, N> {
        let Start { span, x, .. } = self.start;
        let nodes = [NODES[0], NODES[1], 1.0];
        let mut slopes = *stages;
        for (slope, node) in slopes.iter_mut().zip(nodes) {
            *slope = self
                .problem
                .slope(span.at(T::from_f64(node)), &(x + *slope));
        }
        let [first, second, third] = transformed(&INVERSE, &slopes);
        let by = |number: f64| T::from_f64(number) / span.length;
        let (real, alpha, beta) = (by(REAL), by(PAIR[0]), by(PAIR[1]));
        let [a, b, c] = &*inner;
        let one = self
            .real
            .solved::<Y, M, P>(&first.zip_map(a, |slope, a| slope - real * a));
        let mut rights = [Complex::zero(); N];
        for (row, right) in rights.iter_mut().enumerate() {
            right.real = second[row] - (alpha * b[row] - beta * c[row]);
            right.imaginary = third[row] - (alpha * c[row] + beta * b[row]);
        }
        let mut changes = [one; 3];
        let both = self.pair.solve::<Y, M, P>(rights);
        for (row, both) in both.iter().enumerate() {
            (changes[1][row], changes[2][row]) = (both.real, both.imaginary);
        }
        for (inner, change) in inner.iter_mut().zip(&changes) {
            *inner += change;
        }
        *stages = transformed(&VECTORS, inner);
        changes
    }

    /// Sweeps until what is left is small beside the tolerance; gives the last rate of convergence, or how many times
    /// what is enough would be left when the bound on sweeps is not going to suffice.
    fn controlled(
        &mut self,
        stages: &mut Three<T, N>,
        tolerance: &Tolerance<N>,
        rate: &mut f64,
    ) -> Result<f64, f64> {
        let relative = tolerance.relative.max(1e-300);
        let enough = (10.0 * T::EPSILON / relative).max(Real::sqrt(relative).min(0.03));
        let measure = tolerance.around(&self.start.x);
        let mut inner = transformed(&INVERSE, stages);
        let (mut before, mut quotient, mut theta) = (0.0, 0.0, FAST);
        *rate = power(rate.max(T::EPSILON), 0.8);
        for sweep in 1..=SWEEPS {
            let changes = self.sweep(stages, &mut inner);
            let squares = changes.iter().map(|change| measure.square(change));
            let size = Real::sqrt(squares.sum::<f64>() / 3.0);
            if !size.is_finite() {
                break;
            }
            if sweep > 1 {
                let next = size / before;
                theta = if sweep == 2 {
                    next
                } else {
                    Real::sqrt(next * quotient)
                };
                quotient = next;
                if theta >= 0.99 && size > 0.0 {
                    break;
                }
                *rate = theta / (1.0 - theta).max(0.01);
                let ahead = (sweep..SWEEPS).fold(1.0, |ahead, _| ahead * theta);
                let left = *rate * size * ahead / enough;
                if left > 1.0 {
                    return Err(left);
                }
            }
            before = size.max(f64::MIN_POSITIVE);
            if *rate * size <= enough {
                return Ok(theta);
            }
        }
        Err(f64::INFINITY)
    }

    /// Sweeps to rounding, or a failure where it does not come to that.
    fn settled(&mut self, stages: &mut Three<T, N>) -> Result<f64, f64> {
        let mut inner = transformed(&INVERSE, stages);
        let settles = settles::<T>(MOST, || {
            let old = *stages;
            self.sweep(stages, &mut inner);
            let changes = old.iter().zip(&*stages);
            let sizes = changes.map(|(old, new)| relative(&(new - old), &self.start.x, new));
            sizes.fold(0.0, larger)
        });
        if settles {
            Ok(f64::INFINITY)
        } else {
            Err(f64::INFINITY)
        }
    }

    /// The filtered estimate; a second filter takes care of large ones where `doubtful`.
    fn error(&mut self, stages: &Three<T, N>, tolerance: &Tolerance<N>, doubtful: bool) -> f64 {
        let Start { span, x, slope, .. } = self.start;
        let [a, b, c] = ERROR.map(|weight| T::from_f64(weight) / span.length);
        let [first, second, third] = stages;
        let sum = first.zip_zip_map(second, third, |x, y, z| a * x + b * y + c * z);
        let estimate = self.real.solved::<Y, M, P>(&(sum + slope));
        let measure = tolerance.between(x, third);
        let size = measure.norm(&estimate);
        if size <= 1.0 || !doubtful || size.is_nan() {
            return size;
        }
        let slope = self.problem.slope(span.start, &(x + estimate));
        measure.norm(&self.real.solved::<Y, M, P>(&(sum + slope)))
    }
}

impl Method for Radau5 {
    const NAME: &'static str = "Radau IIA 5";
    const ORDER: u32 = 5;
    const DENSE_ORDER: u32 = 4;
}

impl Estimating for Radau5 {
    const ESTIMATE_ORDER: u32 = 4;
}

impl Family for Radau5 {
    type Work<T: Real, const N: usize> = Stages<T, N>;

    #[allow(private_interfaces, reason = "no method is written outside")]
    const RULE: Rule = Rule::Steady;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::trees::Scheme;

    /// The tableau's matrix `T Λ⁻¹ T⁻¹` meets the conditions of order 5 with its last row as result.
    #[test]
    fn conditions_of_order_hold() {
        let [alpha, beta] = PAIR;
        let blocks = SMatrix::from([[REAL, 0.0, 0.0], [0.0, alpha, beta], [0.0, -beta, alpha]]);
        let [vectors, inverse] =
            [VECTORS, INVERSE].map(|rows| SMatrix::<f64, 3, 3>::from(rows).transpose());
        let identity: SMatrix<f64, 3, 3> = vectors * inverse;
        assert!((identity - SMatrix::identity()).norm() < 1e-14);
        let slopes: SMatrix<f64, 3, 3> = vectors * blocks * inverse;
        let matrix = slopes.try_inverse().unwrap();
        let rows: std::vec::Vec<std::vec::Vec<f64>> = matrix
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        for (row, node) in rows.iter().zip([NODES[0], NODES[1], 1.0]) {
            assert!((row.iter().sum::<f64>() - node).abs() < 1e-14);
        }
        let scheme = Scheme {
            several: rows.clone(),
            single: rows.clone(),
        };
        scheme.assert_order("Radau IIA 5", &rows[2], 5, 1.0, 1e-14);
        // The interpolation as weights of the stages' slopes.
        let stages = [0, 1, 2].map(|stage| SVector::<f64, 3>::from_row_slice(&rows[stage]));
        let [change, bend, twist] = coefficients(&stages);
        for s in [0.1, 0.35, 0.8] {
            let weights = s * (change + (1.0 - s) * (bend + s * twist));
            scheme.assert_order("Radau IIA 5", weights.as_slice(), 3, s, 1e-13);
        }
        // An L-stable method with this estimate is at least of order 3: e = b̂ − b with a slope at the start.
        let estimate = SVector::from(ERROR).transpose() * matrix;
        assert!((estimate.sum() + 1.0).abs() < 1e-13, "{}", estimate.sum());
    }
}
