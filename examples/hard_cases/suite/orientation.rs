//! Bodies that turn all the way round.

use std::f64::consts::{PI, SQRT_2};

use mbg_runtime::{Adaptive, Dop853, Fixed, Gauss6, Input, Integrator, Step, Stopped, System};
use nalgebra::{SVector, Vector3};

use super::errors::turned;
use super::models::{
    PulledAngles, PulledAnglesParameters, PulledQuaternion, PulledQuaternionParameters,
    TopQuaternion, TopQuaternionParameters,
};
use super::problems::{RigidBody, Written};
use super::rotations::{self, Row};
use super::{Expected, Found, Line, apart, larger};

/// Runs over the rows of a reference; the outputs are rates and the parts of a quaternion, of either sign.
fn flown<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    rows: &[Row],
) -> Result<Found, Stopped>
where
    S: System<f64, N, M, P, Memory = ()>,
{
    let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let mut error = 0.0_f64;
    let mut rows = rows.iter();
    let solver = Adaptive::new(Dop853, 1e-13, 1e-18);
    let statistics = solver.sample(model, input, 0.0, model.initial_state(), &times, |t, x| {
        let found = model.output(t, x, &input.at(t), &mut ());
        if let Some((_, _, expected)) = rows.next() {
            error = larger(error, turned(&found.as_slice()[3..7], expected));
        }
    })?;
    Ok(Found::new(error, statistics))
}

/// Angles are refused where they lock, a quaternion passes.
pub(crate) fn gimbal_lock() -> Vec<Line> {
    let case = "through gimbal lock";
    let rows = rotations::THROUGH_LOCK;
    // It turns round when the second angle is a right one.
    let at_lock = rotations::pulled(SQRT_2, Vector3::new(0.0, -PI, 0.0));
    vec![
        Line::run(
            (case, "angles, Dop853", "refusal"),
            Expected::Refused(
                "stopped at t = 1.4142135623730951: cos(flying.joint.rotation.gimbal.angle.y)",
            ),
            || match PulledAngles::new(PulledAnglesParameters::default()) {
                Ok(model) => flown(&model, &at_lock, rows),
                Err(_) => Ok(Found::NONE),
            },
        ),
        Line::run(
            (case, "quaternion, Dop853", "elliptic functions"),
            Expected::Within(1e-12),
            || match PulledQuaternion::new(PulledQuaternionParameters::default()) {
                Ok(model) => flown(&model, &rotations::through_lock(), rows),
                Err(_) => Ok(Found::NONE),
            },
        ),
    ]
}

/// A top that falls from where it nearly sleeps, and rises again.
pub(crate) fn sleeping_top() -> Vec<Line> {
    vec![Line::run(
        ("sleeping top", "quaternion, Dop853", "elliptic functions"),
        Expected::Within(2e-10),
        || match TopQuaternion::new(TopQuaternionParameters {
            tilt: 0.01,
            rate: 13.2,
        }) {
            Ok(model) => flown(&model, &(), rotations::SLEEPING),
            Err(_) => Ok(Found::NONE),
        },
    )]
}

/// How often the free body turns over.
const PERIODS: f64 = TUMBLING.0;
const TUMBLING: (f64, &str) = if cfg!(feature = "long") {
    (1e6, "1e6 periods of tumbling")
} else if cfg!(debug_assertions) {
    (1e3, "1e3 periods of tumbling")
} else {
    (1e4, "1e4 periods of tumbling")
};

/// The period of the momentum of a free body with the inertias 1, 2 and 3 (Landau and Lifshitz, *Mechanics*, §37).
fn period(momentum: [f64; 3]) -> f64 {
    let [energy, norm] = RigidBody::invariants(&SVector::from([
        momentum[0],
        momentum[1],
        momentum[2],
        1.0,
        0.0,
        0.0,
        0.0,
    ]));
    let (twice, square) = (2.0 * energy, norm * norm);
    let [i1, i2, i3] = if square > 2.0 * twice {
        [1.0, 2.0, 3.0]
    } else {
        [3.0, 2.0, 1.0]
    };
    let fast = (i3 - i2) * (square - twice * i1) / (i1 * i2 * i3);
    let modulus = (i2 - i1) * (twice * i3 - square) / ((i3 - i2) * (square - twice * i1));
    // The complete elliptic integral by the arithmetic and geometric mean.
    let (mut a, mut b) = (1.0, (1.0 - modulus).sqrt());
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    4.0 * (0.5 * PI / a) / fast.sqrt()
}

/// After whole periods the momentum is back where it was; energy, momentum and the length of the quaternion stay.
pub(crate) fn tumbling() -> Vec<Line> {
    let momentum = [1.0, 10.0, 0.5];
    let start = SVector::from([1.0, 10.0, 0.5, 1.0, 0.0, 0.0, 0.0]);
    let end = PERIODS * period(momentum);
    let kept = |x: &SVector<f64, 7>| {
        let [energy, norm] = RigidBody::invariants(x);
        [energy, norm, x.fixed_rows::<4>(3).norm()]
    };
    let solver = Fixed::new(Gauss6::default(), 0.05).compensated();
    let (case, method) = (TUMBLING.1, "Gauss 6, h = 0.05 s");
    let (mut last, mut statistics) = (start, None);
    // The error of the method in the length of a period.
    let late = Expected::Within(1e-7 * PERIODS);
    let returns = Line::run((case, method, "elliptic functions"), late, || {
        let keep = |step: &mut Step<'_, f64, 7>| last = *step.state();
        let taken = solver.integrate(&Written(RigidBody), &(), 0.0, end, start, keep)?;
        statistics = Some(taken);
        Ok(Found::new(apart(&last.as_slice()[..3], &momentum), taken))
    });
    // Rounding alone: of either sign, which adds up like the steps of a drunkard, or in long runs of one.
    let rounding = Expected::Within(larger(1e-14 * PERIODS.sqrt(), 1e-16 * PERIODS));
    let ways = kept(&last).into_iter().zip(kept(&start));
    let ways = ["energy", "momentum", "length of the quaternion"]
        .into_iter()
        .zip(ways);
    let keeps = ways.map(|(what, (now, then))| {
        let drift = (now / then - 1.0).abs();
        Line::run((case, "the same run", what), rounding, || {
            Ok(statistics.map_or(Found::NONE, |taken| Found::new(drift, taken)))
        })
    });
    core::iter::once(returns).chain(keeps).collect()
}
