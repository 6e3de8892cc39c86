//! The amplifier with two transistors: problem `transamp` of the *Test Set for Initial Value Problem Solvers*
//! (Mazzia, Magherini, University of Bari); Hairer, Lubich, Roche 1989.
//!
//! Node voltages `y₁ … y₈`, capacitors `Cₖ = k` µF, `g(x) = β (exp(x / U_F) − 1)`, `U_e = 0.1 sin(200 π t)`:
//!
//! ```text
//! f₁ = (y₁ − U_e)/R₀                              −C₁ (ẏ₁ − ẏ₂) = f₁ = −f₂
//! f₂ = y₂/R₁ + (y₂ − U_b)/R₂ + (1 − α) g(y₂ − y₃)
//! f₃ = y₃/R₃ − g(y₂ − y₃)                         −C₂ ẏ₃ = f₃
//! f₄ = (y₄ − U_b)/R₄ + α g(y₂ − y₃)               −C₃ (ẏ₄ − ẏ₅) = f₄ = −f₅
//! f₅ = y₅/R₅ + (y₅ − U_b)/R₆ + (1 − α) g(y₅ − y₆)
//! f₆ = y₆/R₇ − g(y₅ − y₆)                         −C₄ ẏ₆ = f₆
//! f₇ = (y₇ − U_b)/R₈ + α g(y₅ − y₆)               −C₅ (ẏ₇ − ẏ₈) = f₇ = −f₈
//! f₈ = y₈/R₉
//! ```
//! An index of one: with the voltages of the capacitors as states, `f₁ + f₂ = f₄ + f₅ = f₇ + f₈ = 0` is an algebraic
//! loop through both transistors.

use nalgebra::{SMatrix, SVector};

/// Supply in V.
pub(crate) const SUPPLY: f64 = 6.0;
/// Thermal voltage in V.
pub(crate) const THERMAL: f64 = 0.026;
/// Current amplification `α`.
pub(crate) const ALPHA: f64 = 0.99;
/// Saturation current `β` in A.
pub(crate) const SATURATION: f64 = 1e-6;
/// R₀ in ohm; R₁ … R₉ are [`RESISTANCE`].
pub(crate) const SOURCE_RESISTANCE: f64 = 1000.0;
/// R₁ … R₉ in ohm.
pub(crate) const RESISTANCE: f64 = 9000.0;
/// C₁ … C₅ in F.
pub(crate) const CAPACITANCE: [f64; 5] = [1e-6, 2e-6, 3e-6, 4e-6, 5e-6];
/// Node voltages at the start, consistent.
pub(crate) const START: [f64; 8] = [0.0, 3.0, 3.0, 6.0, 3.0, 3.0, 6.0, 0.0];
/// Duration in s.
pub(crate) const DURATION: f64 = 0.2;
/// Published node voltages at 0.2 s, good to about 1e-13.
pub(crate) const PUBLISHED: [f64; 8] = [
    -0.005562145012262709,
    3.006522471903042,
    2.849958788608128,
    2.926422536206241,
    2.704617865010554,
    2.761837778393145,
    4.770927631616772,
    1.236995868091548,
];
/// Time in s and node voltages of a run that is good to 1.5e-8 V (9.5e-11 V against the published values at 0.2 s).
pub(crate) const REFERENCE: [(f64, [f64; 8]); 7] = [
    (
        0.005,
        [
            0.006247198353479089,
            2.9619725953396068,
            2.821581147451266,
            5.172634174999814,
            2.4321416692754405,
            2.609892132555486,
            6.004672722397991,
            0.004227710089550599,
        ],
    ),
    (
        0.01,
        [
            -0.005283769299954333,
            3.0052553527722967,
            2.8486714565835376,
            4.401927969857754,
            1.9654417160348914,
            2.270287433820002,
            6.004906014559184,
            0.004003913355561902,
        ],
    ),
    (
        0.02,
        [
            -0.005516180590106057,
            3.006313249599103,
            2.849746227692172,
            4.075913974783115,
            2.1296375215033807,
            2.194255329721194,
            5.900322288730472,
            0.10784550350921611,
        ],
    ),
    (
        0.05,
        [
            -0.005561938092318641,
            3.0065215300374746,
            2.849957831710833,
            3.4672884626812515,
            2.4341844774117307,
            2.494964052549287,
            5.535355377806947,
            0.4726943459473215,
        ],
    ),
    (
        0.1,
        [
            -0.005562144970546967,
            3.006522471714643,
            2.8499587884187707,
            3.0740785428360464,
            2.63079004430042,
            2.688981138796,
            5.136152192344466,
            0.871807476506863,
        ],
    ),
    (
        0.15,
        [
            -0.005562144999818663,
            3.006522471847928,
            2.8499587885542486,
            2.959695828888632,
            2.6879812605078524,
            2.745419968807041,
            4.904552097310605,
            1.1033796691522808,
        ],
    ),
    (
        0.2,
        [
            -0.0055621450011784646,
            3.006522471853634,
            2.8499587885593685,
            2.926422536246156,
            2.704617865036402,
            2.7618377782983043,
            4.770927631651953,
            1.2369958680517872,
        ],
    ),
];

/// Input in V.
pub(crate) fn input(t: f64) -> f64 {
    0.1 * (200.0 * std::f64::consts::PI * t).sin()
}

/// The currents `f` out of the capacitors, and their derivatives by the node voltages.
pub(crate) fn currents(y: &SVector<f64, 8>, input: f64) -> (SVector<f64, 8>, SMatrix<f64, 8, 8>) {
    let law = |x: f64| {
        let power = SATURATION * (x / THERMAL).exp();
        (power - SATURATION, power / THERMAL)
    };
    let ((first, first_slope), (second, second_slope)) = (law(y[1] - y[2]), law(y[4] - y[5]));
    let g = 1.0 / RESISTANCE;
    let f = SVector::from([
        (y[0] - input) / SOURCE_RESISTANCE,
        g * y[1] + g * (y[1] - SUPPLY) + (1.0 - ALPHA) * first,
        g * y[2] - first,
        g * (y[3] - SUPPLY) + ALPHA * first,
        g * y[4] + g * (y[4] - SUPPLY) + (1.0 - ALPHA) * second,
        g * y[5] - second,
        g * (y[6] - SUPPLY) + ALPHA * second,
        g * y[7],
    ]);
    let diagonal = [1.0 / SOURCE_RESISTANCE, 2.0 * g, g, g, 2.0 * g, g, g, g];
    let mut jacobian = SMatrix::from_diagonal(&SVector::from(diagonal));
    for (base, slope) in [(1, first_slope), (4, second_slope)] {
        for (row, share) in [(base, 1.0 - ALPHA), (base + 1, -1.0), (base + 2, ALPHA)] {
            jacobian[(row, base)] += share * slope;
            jacobian[(row, base + 1)] -= share * slope;
        }
    }
    (f, jacobian)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::integrate::runge_kutta;
    use mbg_runtime::solve::newton;

    #[test]
    fn operating_point_from_a_cold_start() {
        for start in [
            SVector::zeros(),
            SVector::from(START),
            SVector::from_element(1.0),
        ] {
            let solved = newton(start, |y| currents(y, 0.0));
            assert!(solved.converged, "{solved:?}");
            let (f, _) = currents(&solved.solution, 0.0);
            assert!(f.amax() < 1e-15, "{f}");
        }
    }

    /// Node voltages for given voltages of the capacitors.
    fn nodes(capacitors: &[f64; 5], input: f64, start: SVector<f64, 8>) -> SVector<f64, 8> {
        let [c1, c2, c3, c4, c5] = *capacitors;
        let solved = newton(start, |y| {
            let (f, slopes) = currents(y, input);
            let residual = [
                f[0] + f[1],
                y[0] - y[1] - c1,
                y[2] - c2,
                f[3] + f[4],
                y[3] - y[4] - c3,
                y[5] - c4,
                f[6] + f[7],
                y[6] - y[7] - c5,
            ];
            let mut jacobian = SMatrix::<f64, 8, 8>::zeros();
            for (row, (a, b)) in [(0, (0, 1)), (3, (3, 4)), (6, (6, 7))] {
                jacobian.set_row(row, &(slopes.row(a) + slopes.row(b)));
                (jacobian[(row + 1, a)], jacobian[(row + 1, b)]) = (1.0, -1.0);
            }
            (jacobian[(2, 2)], jacobian[(5, 5)]) = (1.0, 1.0);
            (SVector::from(residual), jacobian)
        });
        assert!(solved.converged, "{solved:?}");
        solved.solution
    }

    #[test]
    fn newton_and_runge_kutta_give_the_published_voltages() {
        let mut y = SVector::from(START);
        let start = [-3.0, 3.0, 3.0, 3.0, 6.0];
        let end = runge_kutta(
            |t, capacitors| {
                y = nodes(capacitors, input(t), y);
                let (f, _) = currents(&y, input(t));
                let flows = [f[0], f[2], f[3], f[5], f[6]];
                std::array::from_fn(|i| -flows[i] / CAPACITANCE[i])
            },
            (0.0, DURATION),
            6000,
            start,
        );
        let y = nodes(&end, input(DURATION), y);
        for (y, expected) in y.iter().zip(PUBLISHED) {
            assert!((y - expected).abs() < 5e-7, "{y} {expected}");
        }
    }
}
