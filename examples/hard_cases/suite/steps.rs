//! Single precision, and steps that are far too long and far too short.

use mbg_runtime::{
    Adaptive, Dop853, Fixed, Gauss6, ImplicitMidpoint, Input, Integrator, Method, Radau5, Real,
    Rk4, Ros2, Stopped, System, Tsit5,
};
use nalgebra::{SVector, Vector3};

use super::ins::{Ins, InsParameters};
use super::ins_reference::PULSE;
use super::problems::{Pendulum, StiffPin, Written};
use super::stiffness::angles_of_ins;
use super::{Expected, Found, Line, apart, larger};

const PIN: StiffPin = StiffPin {
    stiffness: 1e8,
    damping: 1e3,
};

/// The gust of the paper in single precision.
struct Gust;

impl Input<f32, 3> for Gust {
    fn value(&self, _t: f32, since: f32) -> Vector3<f32> {
        if (1.0..1.1).contains(&since) {
            Vector3::new(5000.0, 1000.0, 10000.0)
        } else {
            Vector3::zeros()
        }
    }

    fn next_jump(&self, t: f32) -> Option<f32> {
        [1.0, 1.1].into_iter().find(|jump| t < *jump)
    }
}

fn ins(solver: &impl Integrator<9>) -> Result<Found, Stopped> {
    let Ok(model) = Ins::<f32>::new(InsParameters::default()) else {
        return Ok(Found::NONE);
    };
    let times: Vec<f32> = PULSE.iter().map(|instant| instant.time as f32).collect();
    let (mut error, mut rows) = (0.0_f64, PULSE.iter());
    let statistics = solver.sample(
        &model,
        &Gust,
        0.0,
        model.initial_state(),
        &times,
        |_t, x| {
            if let Some(row) = rows.next() {
                let found = [x[6], x[7], x[8]].map(f64::from);
                error = larger(error, apart(&found, &row.alpha));
            }
        },
    )?;
    Ok(Found::new(error, statistics))
}

/// The angle of a pendulum on a stiff pin after so many seconds, against short steps in double precision.
fn pin<T: Real>(solver: &impl Integrator<6>, duration: f64) -> Result<Found, Stopped> {
    let mut reference = StiffPin::level();
    let keep = |step: &mut mbg_runtime::Step<'_, f64, 6>| reference = *step.state();
    let level = StiffPin::level();
    Fixed::new(Radau5, 1e-4).integrate(&Written(PIN), &(), 0.0, duration, level, keep)?;
    let [start, end] = [0.0, duration].map(T::from_f64);
    let level = level.map(T::from_f64);
    let mut last = level;
    let keep = |step: &mut mbg_runtime::Step<'_, T, 6>| last = *step.state();
    let statistics = solver.integrate(&Written(PIN), &(), start, end, level, keep)?;
    let error = (last[2] - T::from_f64(reference[2])).magnitude();
    Ok(Found::new(error, statistics))
}

/// Everything in `f32`.
pub(crate) fn single_precision() -> Vec<Line> {
    let (case, reference) = ("INS in f32", "multiple precision");
    let compensated = Fixed::new(Rk4, 0.01).compensated();
    let ros2 = Fixed::new(Ros2, 1e-3).compensated();
    let midpoint = Fixed::new(ImplicitMidpoint { sweeps: 2 }, 1e-3).compensated();
    vec![
        Line::run(
            (case, "RK4, compensated", reference),
            Expected::Within(1e-6),
            || ins(&compensated),
        ),
        Line::run(
            (case, "Tsit5 at 1e-5", reference),
            Expected::Within(1e-4),
            || ins(&Adaptive::new(Tsit5, 1e-5, 1e-7)),
        ),
        Line::run(
            (
                "pin of 1e8 N/m in f32",
                "ROS2, h = 1 ms",
                "Radau IIA 5 in f64",
            ),
            Expected::Within(1e-4),
            || pin::<f32>(&ros2, 2.0),
        ),
        Line::run(
            (
                "pin of 1e8 N/m in f32",
                "midpoint, h = 1 ms",
                "Radau IIA 5 in f64",
            ),
            Expected::Within(1e-4),
            || pin::<f32>(&midpoint, 2.0),
        ),
    ]
}

/// Steps of seconds where milliseconds are needed.
pub(crate) fn too_long() -> Vec<Line> {
    fn end(solver: &impl Integrator<6>) -> Result<Found, Stopped> {
        let statistics =
            solver.integrate(&Written(PIN), &(), 0.0, 100.0, StiffPin::level(), |_| ())?;
        Ok(Found::new(f64::INFINITY, statistics))
    }
    let first = Adaptive {
        first: Some(100.0),
        ..Adaptive::new(Dop853, 1e-10, 1e-14)
    };
    vec![
        Line::run(
            ("step of 1 s on a pin of 1e8 N/m", Rk4::NAME, "refusal"),
            Expected::Refused("not finite"),
            || end(&Fixed::new(Rk4, 1.0)),
        ),
        Line::run(
            // It is halved until stages are found.
            (
                "step of 1 s on a pin of 1e8 N/m",
                Radau5::NAME,
                "steps of 0.1 ms",
            ),
            Expected::Within(5e-3),
            || pin::<f64>(&Fixed::new(Radau5, 1.0), 10.0),
        ),
        Line::run(
            (
                "first step of 100 s on the INS",
                Dop853::NAME,
                "multiple precision",
            ),
            Expected::Within(1e-9),
            || angles_of_ins(&first),
        ),
    ]
}

/// Steps that time does not feel, and tolerances below rounding.
pub(crate) fn too_short() -> Vec<Line> {
    fn end(solver: &impl Integrator<2>) -> Result<Found, Stopped> {
        let start = SVector::from([2.0, 1.0]);
        let mut ends = [start; 2];
        let strict = Fixed::new(Gauss6::default(), 1e-3).compensated();
        let keep = |step: &mut mbg_runtime::Step<'_, f64, 2>| ends[0] = *step.state();
        strict.integrate(&Written(Pendulum), &(), 0.0, 10.0, start, keep)?;
        let keep = |step: &mut mbg_runtime::Step<'_, f64, 2>| ends[1] = *step.state();
        let statistics = solver.integrate(&Written(Pendulum), &(), 0.0, 10.0, start, keep)?;
        Ok(Found::new((ends[1] - ends[0]).norm(), statistics))
    }
    let small = "the step is lost in the rounding";
    vec![
        Line::run(
            ("step of 1e-16 s over 10 s", Rk4::NAME, "refusal"),
            Expected::Refused(small),
            || end(&Fixed::new(Rk4, 1e-16)),
        ),
        Line::run(
            ("tolerance of 1e-20", Tsit5::NAME, "Gauss 6, compensated"),
            Expected::Within(1e-11),
            || end(&Adaptive::new(Tsit5, 1e-20, 1e-20)),
        ),
        Line::run(
            ("tolerance of 0", Tsit5::NAME, "refusal"),
            Expected::Refused("tolerance must be"),
            || end(&Adaptive::new(Tsit5, 0.0, 0.0)),
        ),
    ]
}
