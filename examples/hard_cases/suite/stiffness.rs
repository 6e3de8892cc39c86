//! Constants that are far apart.

use mbg_runtime::{
    Adaptive, Auto, Dop853, Fixed, Integrator, Method, Radau5, Rk4, Rodas5P, Ros2, Stopped, System,
};

use super::ins::{Ins, InsParameters, gust};
use super::ins_reference::PULSE;
use super::problems::{StiffPin, Written};
use super::{Expected, Found, Line, apart, larger};

const PINS: [&str; 2] = ["pin of 1e6 N/m", "pin of 1e12 N/m"];

/// Pendulums on pins that hardly give.
pub(crate) fn pins() -> Vec<Line> {
    let mut lines = Vec::new();
    for (case, (pin, expected)) in PINS.into_iter().zip(StiffPin::AFTER_5_S) {
        let nominal = pin.nominal();
        fn run(
            pin: StiffPin,
            expected: [f64; 2],
            solver: &impl Integrator<6>,
        ) -> Result<Found, Stopped> {
            let mut last = StiffPin::level();
            let keep = |step: &mut mbg_runtime::Step<'_, f64, 6>| last = *step.state();
            let statistics =
                solver.integrate(&Written(pin), &(), 0.0, 5.0, StiffPin::level(), keep)?;
            Ok(Found::new(
                apart(&[last[2], last[5]], &expected),
                statistics,
            ))
        }
        let reference = "more digits";
        let auto = Auto {
            nominal: &nominal,
            ..Auto::new(1e-6, 1e-6)
        };
        let radau = Adaptive {
            nominal: &nominal,
            ..Adaptive::new(Radau5, 1e-6, 1e-6)
        };
        let rodas = Adaptive {
            nominal: &nominal,
            ..Adaptive::new(Rodas5P, 1e-6, 1e-6)
        };
        lines.push(Line::run(
            (case, Radau5::NAME, reference),
            Expected::Within(2e-5),
            || run(pin, expected, &radau),
        ));
        lines.push(Line::run(
            (case, Rodas5P::NAME, reference),
            Expected::Within(1e-5),
            || run(pin, expected, &rodas),
        ));
        lines.push(Line::run(
            (case, "auto", reference),
            Expected::Within(2e-5),
            || run(pin, expected, &auto),
        ));
        let fixed = Fixed::new(Ros2, 1e-2);
        lines.push(Line::run(
            (case, "ROS2, h = 10 ms", reference),
            Expected::Within(0.1),
            || run(pin, expected, &fixed),
        ));
        let explicit = Fixed::new(Rk4, 1e-2);
        lines.push(Line::run(
            (case, "RK4, h = 10 ms", "refusal"),
            Expected::Refused("not finite"),
            || run(pin, expected, &explicit),
        ));
    }
    lines
}

/// Largest error of a gimbal angle over the instants of the reference.
pub(crate) fn angles_of_ins(solver: &impl Integrator<9>) -> Result<Found, Stopped> {
    let model = ins_model();
    let times: Vec<f64> = PULSE.iter().map(|instant| instant.time).collect();
    let (mut error, mut rows) = (0.0_f64, PULSE.iter());
    let start = model.initial_state();
    let statistics = solver.sample(&model, &gust(0.1), 0.0, start, &times, |_t, x| {
        if let Some(row) = rows.next() {
            error = larger(error, apart(&x.as_slice()[6..9], &row.alpha));
        }
    })?;
    Ok(Found::new(error, statistics))
}

/// The inertial navigation system with the constants of the paper.
#[allow(clippy::expect_used, reason = "its own constants suit it")]
pub(crate) fn ins_model() -> Ins<f64> {
    Ins::new(InsParameters::default()).expect("constants of the paper")
}

/// Springs of 1e-5 N m/rad beside inertias of 1e4 kg m².
pub(crate) fn navigation() -> Vec<Line> {
    let (case, reference) = ("INS, constants from 1e-5 to 1e4", "multiple precision");
    let dop853 = Adaptive::new(Dop853, 1e-10, 1e-14);
    let radau5 = Adaptive::new(Radau5, 1e-8, 1e-12);
    vec![
        Line::run((case, "auto", reference), Expected::Within(1e-6), || {
            angles_of_ins(&Auto::new(1e-8, 1e-12))
        }),
        Line::run(
            (case, Dop853::NAME, reference),
            Expected::Within(1e-9),
            || angles_of_ins(&dop853),
        ),
        Line::run(
            (case, Radau5::NAME, reference),
            Expected::Within(1e-6),
            || angles_of_ins(&radau5),
        ),
        Line::run(
            (case, "RK4, h = 10 ms", reference),
            Expected::Within(1e-8),
            || angles_of_ins(&Fixed::new(Rk4, 1e-2)),
        ),
    ]
}
