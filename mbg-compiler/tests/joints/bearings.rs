//! Bodies that hang on a base whose joint gives way, and are regular at every angle.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{Arguments, evaluate};

use super::models::compiled;

/// Two of the joints on the base are ideal, and one that gives way carries a body with another one.
const BASE: &str = "#[derivative] model M { causality componentwise; gravity [0.0, 3.7, 0.0];
    1 slide[6]; 1 ball[6]; 1 end[6]; 1 base[6]; 1 ground[6]; 1 cross[6];
    Sf fixed[6] { flow: 0.0 } -> ground;
    fourth: Body { mass: 1.0, inertia: 1.0, centre: [0.0, 0.5, 0.0] } (end);
    last: Spherical { first: 2, second: 0, initial: [-0.353, 1.2, 0.087] } (ball, end);
    third: Body { mass: 1.0, inertia: 1.0 } (ball);
    soft: Spherical { blocked: compliant } (base, ball);
    second: Body { mass: 1.0, inertia: 1.0, centre: [-0.039, 0.755, -0.328] } (slide);
    rail: Prismatic { axis: 0 } (base, slide);
    first: Body { mass: 1.0, inertia: 1.0, centre: [0.488, -0.614, -0.13] } (cross);
    universal: Universal { first: 1, second: 0, initial: [0.0, 0.788] } (base, cross);
    hub: Body { mass: 1.0, inertia: 1.0, centre: [-0.929, 0.996, -0.901] } (base);
    plate: Planar { axis: 0, blocked: compliant } (ground, base); }";

/// A routine at the start, but with another angle of the cross.
fn at(model: &Compiled, angle: f64, routine: usize) -> Vec<f64> {
    let states = model.states.iter();
    let names = states.map(|it| model.model.states[*it].variable.name.as_str());
    let place = names.into_iter().position(|it| it == "universal.angle.x");
    let run = |routine, state: &[f64]| {
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state,
            input: &[],
        };
        evaluate(&model.program, routine, &arguments)
    };
    let mut state = run(Routines::INITIAL, &vec![0.0; model.states.len()]);
    state[place.unwrap()] = angle;
    run(routine, &state)
}

#[test]
fn a_body_on_a_joint_that_gives_way_may_start_at_zero() {
    let model = compiled(BASE);
    let [here, beside] = [0.0, 1e-7].map(|angle| at(&model, angle, Routines::DERIVATIVE));
    for (here, beside) in here.iter().zip(&beside) {
        assert!((here - beside).abs() < 1e-5, "{here} and {beside}");
    }
}

#[test]
fn bodies_on_a_base_that_gives_way_are_singular_at_no_angle() {
    let model = compiled(BASE);
    for number in -10..=10 {
        for value in at(&model, 0.3 * f64::from(number), Routines::CONDITIONING) {
            assert!(value.abs() > 1e-2, "{value}");
        }
    }
}
