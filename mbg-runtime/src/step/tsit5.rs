//! The pair of Tsitouras, orders 5 and 4.
//!
//! Ch. Tsitouras, Runge–Kutta pairs of order 5(4) satisfying only the first column simplifying assumption,
//! Computers & Mathematics with Applications 62 (2011) 770–775.

use nalgebra::SVector;

use super::fixed::FixedStep;
use super::{advance, blend};
use crate::{Real, System};

/// The method of order 5 in the pair of Tsitouras, with steps given in advance: six evaluations a step.
///
/// [`Adaptive`](crate::Adaptive) steps with the same method and chooses the steps itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tsit5;

const C2: f64 = 0.161;
const C3: f64 = 0.327;
const C4: f64 = 0.9;
const C5: f64 = 0.980_025_540_904_509_7;

const A21: f64 = 0.161;
const A31: f64 = -0.008_480_655_492_356_989;
const A32: f64 = 0.335_480_655_492_357;
const A41: f64 = 2.897_153_057_105_493_5;
const A42: f64 = -6.359_448_489_975_075;
const A43: f64 = 4.362_295_432_869_581_5;
const A51: f64 = 5.325_864_828_439_257;
const A52: f64 = -11.748_883_564_062_828;
const A53: f64 = 7.495_539_342_889_836_5;
const A54: f64 = -0.092_495_066_361_755_25;
const A61: f64 = 5.861_455_442_946_42;
const A62: f64 = -12.920_969_317_847_11;
const A63: f64 = 8.159_367_898_576_159;
const A64: f64 = -0.071_584_973_281_401;
const A65: f64 = -0.028_269_050_394_068_383;

/// Weights of order 5; the seventh stage is at the end of the step, and the first of the next one.
const B: [f64; 6] = [
    0.096_460_766_818_065_23,
    0.01,
    0.479_889_650_414_499_6,
    1.379_008_574_103_742,
    -3.290_069_515_436_081,
    2.324_710_524_099_774,
];

/// Weights of the difference between the results of order 4 and 5.
const ERROR: [f64; 7] = [
    -0.001_780_011_052_225_777_1,
    -0.000_816_434_459_656_746_9,
    0.007_880_878_010_261_995,
    -0.144_711_007_173_262_9,
    0.582_357_165_452_555_2,
    -0.458_082_105_929_186_97,
    1.0 / 66.0,
];

/// Weights inside a step, of order 4: `θ (r₀ + θ (r₁ + θ (r₂ + θ r₃)))` at the part `θ` of the step.
const INSIDE: [[f64; 4]; 7] = [
    [1.0, -2.763_706_197_274_826, 2.913_255_461_821_912_6, -1.053_088_497_729_021_6],
    [0.0, 0.131_7, -0.223_4, 0.101_7],
    [0.0, 3.930_296_236_894_751_6, -5.941_033_872_131_505, 2.490_627_285_651_253],
    [0.0, -12.411_077_166_933_676, 30.338_188_630_282_32, -16.548_102_889_244_902],
    [0.0, 37.509_313_416_511_04, -88.178_904_894_766_4, 47.379_521_962_819_28],
    [0.0, -27.896_526_289_197_286, 65.091_894_674_793_66, -34.870_657_861_496_61],
    [0.0, 1.5, -4.0, 2.5],
];

/// A step: the slopes of its seven stages and the state at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stages<T, const N: usize> {
    pub(super) slopes: [SVector<T, N>; 7],
    pub(super) end: SVector<T, N>,
}

impl<T: Real, const N: usize> Stages<T, N> {
    /// Makes a step from `x` at `t`, where the slope is `k1`: six evaluations.
    pub(super) fn new(
        mut derivative: impl FnMut(T, &SVector<T, N>) -> SVector<T, N>,
        t: T,
        x: &SVector<T, N>,
        h: T,
        k1: SVector<T, N>,
    ) -> Self {
        let [k2, k3, k4, k5, k6] = inner(&mut derivative, t, x, h, &k1);
        let sum = result([&k1, &k2, &k3, &k4, &k5, &k6]);
        let end = x.zip_map(&sum, |x, slope| x + h * slope);
        let k7 = derivative(t + h, &end);
        Self { slopes: [k1, k2, k3, k4, k5, k6, k7], end }
    }

    /// The estimated error of `end`, per unit of `h`.
    pub(super) fn error(&self) -> SVector<T, N> {
        weighted(ERROR, &self.slopes)
    }
}

/// The mean slope from the start to the part `part` of the step, times `part`.
pub(super) fn inside<T: Real, const N: usize>(slopes: &[SVector<T, N>; 7], part: f64) -> SVector<T, N> {
    weighted(weights_inside(part), slopes)
}

fn weights_inside(part: f64) -> [f64; 7] {
    INSIDE.map(|[r0, r1, r2, r3]| part * (r0 + part * (r1 + part * (r2 + part * r3))))
}

fn weighted<T: Real, const N: usize>(weights: [f64; 7], slopes: &[SVector<T, N>; 7]) -> SVector<T, N> {
    let [w1, w2, w3, w4, w5, w6, w7] = weights;
    let [k1, k2, k3, k4, k5, k6, k7] = slopes;
    blend((w1, k1), [(w2, k2), (w3, k3), (w4, k4), (w5, k5), (w6, k6), (w7, k7)])
}

/// The mean slope of the step, of order 5.
fn result<T: Real, const N: usize>([k1, k2, k3, k4, k5, k6]: [&SVector<T, N>; 6]) -> SVector<T, N> {
    let [b1, b2, b3, b4, b5, b6] = B;
    blend((b1, k1), [(b2, k2), (b3, k3), (b4, k4), (b5, k5), (b6, k6)])
}

/// Slopes of the stages 2 to 6.
#[inline]
fn inner<T: Real, const N: usize>(
    derivative: &mut impl FnMut(T, &SVector<T, N>) -> SVector<T, N>,
    t: T,
    x: &SVector<T, N>,
    h: T,
    k1: &SVector<T, N>,
) -> [SVector<T, N>; 5] {
    let at = |part: f64| t + T::from_f64(part) * h;
    let k2 = derivative(at(C2), &advance(x, h, (A21, k1), []));
    let k3 = derivative(at(C3), &advance(x, h, (A31, k1), [(A32, &k2)]));
    let k4 = derivative(at(C4), &advance(x, h, (A41, k1), [(A42, &k2), (A43, &k3)]));
    let k5 = derivative(at(C5), &advance(x, h, (A51, k1), [(A52, &k2), (A53, &k3), (A54, &k4)]));
    let before_k6 = [(A62, &k2), (A63, &k3), (A64, &k4), (A65, &k5)];
    let k6 = derivative(t + h, &advance(x, h, (A61, k1), before_k6));
    [k2, k3, k4, k5, k6]
}

impl FixedStep for Tsit5 {
    const ORDER: u32 = 5;
    const EVALUATIONS: u64 = 6;

    fn increment<T, const N: usize, const M: usize, const P: usize, S>(
        &self,
        system: &S,
        t: T,
        x: &SVector<T, N>,
        input: impl Fn(T) -> SVector<T, M>,
        h: T,
        memory: &mut S::Memory,
    ) -> SVector<T, N>
    where
        T: Real,
        S: System<T, N, M, P>,
    {
        let mut derivative = |t: T, x: &SVector<T, N>| system.derivative(t, x, &input(t), memory);
        let k1 = derivative(t, x);
        let [k2, k3, k4, k5, k6] = inner(&mut derivative, t, x, h, &k1);
        result([&k1, &k2, &k3, &k4, &k5, &k6]).map(|slope| h * slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Stage = [f64; 7];

    const C: Stage = [0.0, C2, C3, C4, C5, 1.0, 1.0];
    const A: [Stage; 7] = [
        [0.0; 7],
        [A21, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [A31, A32, 0.0, 0.0, 0.0, 0.0, 0.0],
        [A41, A42, A43, 0.0, 0.0, 0.0, 0.0],
        [A51, A52, A53, A54, 0.0, 0.0, 0.0],
        [A61, A62, A63, A64, A65, 0.0, 0.0],
        [B[0], B[1], B[2], B[3], B[4], B[5], 0.0],
    ];

    fn dot(a: &Stage, b: &Stage) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    fn times(a: &Stage, b: &Stage) -> Stage {
        core::array::from_fn(|i| a[i] * b[i])
    }

    fn through(b: &Stage) -> Stage {
        A.map(|row| dot(&row, b))
    }

    /// The seventeen rooted trees up to order 5: order, stage vector, and what the weights must sum it to.
    fn conditions() -> [(i32, Stage, f64); 17] {
        let one = [1.0; 7];
        let c2 = times(&C, &C);
        let c3 = times(&C, &c2);
        let ac = through(&C);
        let ac2 = through(&c2);
        let aac = through(&ac);
        [
            (1, one, 1.0),
            (2, C, 1.0 / 2.0),
            (3, c2, 1.0 / 3.0),
            (3, ac, 1.0 / 6.0),
            (4, c3, 1.0 / 4.0),
            (4, times(&C, &ac), 1.0 / 8.0),
            (4, ac2, 1.0 / 12.0),
            (4, aac, 1.0 / 24.0),
            (5, times(&C, &c3), 1.0 / 5.0),
            (5, times(&c2, &ac), 1.0 / 10.0),
            (5, times(&ac, &ac), 1.0 / 20.0),
            (5, times(&C, &ac2), 1.0 / 15.0),
            (5, times(&C, &aac), 1.0 / 30.0),
            (5, through(&c3), 1.0 / 20.0),
            (5, through(&times(&C, &ac)), 1.0 / 40.0),
            (5, through(&ac2), 1.0 / 60.0),
            (5, through(&aac), 1.0 / 120.0),
        ]
    }

    #[test]
    fn times_of_the_stages_are_the_row_sums() {
        for (row, c) in A.iter().zip(C) {
            assert!((row.iter().sum::<f64>() - c).abs() < 1e-14);
        }
    }

    #[test]
    fn weights_are_of_order_5_and_the_embedded_ones_of_order_4() {
        for (index, (order, stage, target)) in conditions().into_iter().enumerate() {
            assert!((dot(&A[6], &stage) - target).abs() < 1e-14, "condition {index}");
            if order <= 4 {
                assert!(dot(&ERROR, &stage).abs() < 1e-14, "embedded condition {index}");
            } else {
                assert!(dot(&ERROR, &stage).abs() > 1e-4, "the estimate would miss tree {index}");
            }
        }
    }

    #[test]
    fn weights_inside_a_step_are_of_order_4() {
        for tenth in 0..=10 {
            let part = f64::from(tenth) / 10.0;
            let weights = weights_inside(part);
            for (order, stage, target) in conditions().into_iter().filter(|condition| condition.0 <= 4) {
                assert!((dot(&weights, &stage) - target * part.powi(order)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn inside_meets_the_end_with_its_slope() {
        for (weight, expected) in weights_inside(1.0).into_iter().zip(A[6]) {
            assert!((weight - expected).abs() < 1e-14);
        }
        for (index, [r0, r1, r2, r3]) in INSIDE.into_iter().enumerate() {
            let slope = r0 + 2.0 * r1 + 3.0 * r2 + 4.0 * r3;
            assert!((slope - if index == 6 { 1.0 } else { 0.0 }).abs() < 1e-13);
        }
    }
}
