//! A rectifier: source, resistor and diode in series with a capacitor, a load across the capacitor.
//!
//! ```text
//! C v̇ = i − v / R_L
//! u(t) − v = R i + V ln(1 + i / I)
//! ```
//! The current is an algebraic loop. Its law is solved for the voltage `w` of the diode, `i = I (exp(w/V) − 1)`, which
//! is defined for blocking, too: there `1 + i/I` is zero in double precision.

/// Resistance in series in ohm.
pub(crate) const RESISTANCE: f64 = 10.0;
/// Saturation current in A.
pub(crate) const SATURATION: f64 = 1e-12;
/// Thermal voltage in V.
pub(crate) const THERMAL: f64 = 0.025852;
/// Capacitance in F.
pub(crate) const CAPACITANCE: f64 = 1e-4;
/// Load in ohm.
pub(crate) const LOAD: f64 = 1000.0;
/// Amplitude of the source in V.
pub(crate) const AMPLITUDE: f64 = 10.0;
/// Frequency of the source in Hz.
pub(crate) const FREQUENCY: f64 = 50.0;
/// Time in s and voltage of the capacitor in V, from 0 V: good to 3e-12 V.
pub(crate) const REFERENCE: [(f64, f64); 10] = [
    (0.001, 0.7581878278652029),
    (0.002, 2.842683131613024),
    (0.005, 8.391529860370925),
    (0.0075, 8.70073949333563),
    (0.01, 8.485917469801924),
    (0.015, 8.072054391111468),
    (0.02, 7.678375652946653),
    (0.025, 8.710784124275207),
    (0.04, 7.783400907765845),
    (0.06, 7.788622254195778),
];

/// Voltage of the source in V.
pub(crate) fn source(t: f64) -> f64 {
    AMPLITUDE * (std::f64::consts::TAU * FREQUENCY * t).sin()
}

/// `R i − (u − v − w)` and its derivative by the voltage `w` of the diode.
pub(crate) fn law(w: f64, difference: f64) -> (f64, f64) {
    let current = SATURATION * (w / THERMAL).exp_m1();
    (
        RESISTANCE * current - (difference - w),
        RESISTANCE * (current + SATURATION) / THERMAL + 1.0,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::integrate::runge_kutta;
    use mbg_runtime::solve::newton;
    use nalgebra::{SMatrix, SVector};

    #[test]
    fn newton_and_runge_kutta_give_the_reference() {
        let (mut time, mut x, mut w) = (0.0, [0.0], 0.0);
        for (next, expected) in REFERENCE {
            let steps = ((next - time) * 1e5).round() as usize;
            x = runge_kutta(
                |t, [v]| {
                    let difference = source(t) - v;
                    let solved = newton(SVector::from([w]), |w: &SVector<f64, 1>| {
                        let (residual, slope) = law(w[0], difference);
                        (SVector::from([residual]), SMatrix::from([[slope]]))
                    });
                    assert!(solved.converged, "{t} {v} {solved:?}");
                    w = solved.solution[0];
                    [((difference - w) / RESISTANCE - v / LOAD) / CAPACITANCE]
                },
                (time, next),
                steps,
                x,
            );
            time = next;
            assert!((x[0] - expected).abs() < 1e-5, "{time} {} {expected}", x[0]);
        }
    }
}
