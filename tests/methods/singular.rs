//! Steps across singular positions of closed loops, where branches of their motion meet.

use mbg_runtime::{
    Adaptive, Auto, Constant, Dop853, Estimating, Fixed, Gauss6, Integrator, Picked, Radau5,
    Radau9, Rk4, Rodas4, Rodas5P, System, Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    include "tests/models/mechanisms/parallelogram.mbg";
    include "tests/models/mechanisms/excavator.mbg";
}

/// The angle of both cranks at 20 s, by a Taylor series in multiple precision: they stay parallel, and move as one pendulum.
const EXPECTED: f64 = -2.840_397_499_998_357;

/// They leave for the motion in which they turn in opposite directions at none of the passages.
#[test]
fn a_parallelogram_stays_on_its_branch() {
    for (tolerance, allowed) in [
        (1e-6, 5e-3),
        (1e-8, 1e-4),
        (1e-9, 1e-5),
        (1e-10, 1e-5),
        (1e-11, 1e-5),
    ] {
        for [first, second] in [
            at_end(Tsit5, tolerance),
            at_end(Dop853, tolerance),
            at_end(Rodas4, tolerance),
            at_end(Rodas5P, tolerance),
            at_end(Radau5, tolerance),
            at_end(Radau9, tolerance),
            arrived(&Auto::new(tolerance, tolerance)),
        ] {
            let error = first - EXPECTED;
            assert!(error.abs() < allowed, "{tolerance:e} {error:e}");
            assert!(
                (second - first).abs() < 1e-9,
                "{tolerance:e} {first} {second}"
            );
        }
    }
}

#[test]
fn auto_takes_the_order_that_a_tolerance_asks_for() {
    let model = Parallelogram::<f64>::new(ParallelogramParameters::default()).unwrap();
    let picked = |tolerance: f64| {
        let auto = Auto::new(tolerance, tolerance);
        let choice = auto.choose(&model, &(), 0.0, 20.0, model.initial_state());
        choice.unwrap().method
    };
    assert_eq!(
        [picked(1e-3), picked(1e-8)],
        [Picked::Tsit5, Picked::Dop853]
    );
}

#[test]
fn steps_of_constant_length_stay_on_their_branch() {
    for step in [1e-2, 5e-3, 2e-3, 1e-3, 5e-4] {
        for [first, second] in [
            arrived(&Fixed::new(Rk4, step)),
            arrived(&Fixed::new(Gauss6::default(), step)),
            arrived(&Fixed::new(Radau5, step)),
            arrived(&Fixed::new(Radau9, step)),
        ] {
            let error = first - EXPECTED;
            // What leaves its branch is off by some rad.
            assert!(error.abs() < 2e-2, "{step:e} {error:e}");
            assert!((second - first).abs() < 1e-9, "{step:e} {first} {second}");
        }
    }
}

/// Next to the position rounding of the stages is large: parts of a step that is halved for it lead onto the other branch.
#[test]
fn steps_of_radau_of_any_length_stay_on_their_branch() {
    for part in 0..12 {
        let step = 2.5e-3 * f64::powf(1.133_7, f64::from(part));
        for [angle, _] in [
            arrived(&Fixed::new(Radau5, step)),
            arrived(&Fixed::new(Radau9, step)),
        ] {
            let error = angle - EXPECTED;
            assert!(error.abs() < 2e-2, "{step:e} {error:e}");
        }
    }
}

fn at_end<M: Estimating>(method: M, tolerance: f64) -> [f64; 2] {
    arrived(&Adaptive::new(method, tolerance, tolerance))
}

fn arrived(solver: &impl Integrator<6>) -> [f64; 2] {
    let model = Parallelogram::<f64>::new(ParallelogramParameters::default()).unwrap();
    let mut last = model.initial_state();
    solver
        .integrate(&model, &(), 0.0, 20.0, last, |step| last = *step.state())
        .unwrap();
    let none = SVector::zeros();
    model.output(20.0, &last, &none, &mut ()).into()
}

/// Where the pressure at an orifice goes through zero steps are short, and their errors as small as elsewhere.
#[test]
fn valves_are_no_singular_positions() {
    let model = Excavator::<f64>::new(ExcavatorParameters::default()).unwrap();
    let states = <Excavator<f64> as System<f64, 12, 2, 1>>::META.states;
    let nominal: Vec<f64> = states
        .iter()
        .map(|it| {
            if it.name.contains("ring") || it.name.contains("volume") {
                1e-3
            } else {
                0.05
            }
        })
        .collect();
    let flows = Constant(SVector::from([1e-4, 1e-4]));
    for tolerance in [1e-7, 1e-8, 1e-9, 1e-10, 3e-11, 1e-11, 3e-12] {
        macro_rules! angle {
            ($method:expr) => {{
                let solver = Adaptive {
                    nominal: &nominal,
                    ..Adaptive::new($method, tolerance, tolerance)
                };
                let mut last = model.initial_state();
                let run =
                    solver.integrate(&model, &flows, 0.0, 0.3, last, |step| last = *step.state());
                run.unwrap();
                model.output(0.3, &last, &flows.0, &mut Default::default())[0]
            }};
        }
        for angle in [
            angle!(Tsit5),
            angle!(Dop853),
            angle!(Rodas5P),
            angle!(Radau9),
        ] {
            // To rounding by the equations of Lagrange, by hand, and by all of these methods.
            let error = angle - 1.459_065_618_345;
            assert!(
                error.abs() < 20.0 * tolerance + 1e-11,
                "{tolerance:e}: {error:e}"
            );
        }
    }
}
