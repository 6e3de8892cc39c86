//! Trees whose equations are left whole in part, and that are regular wherever their joints stand.

use std::collections::BTreeSet;

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

/// Bodies that fly one beside the other, counted from a body that slides on a rail.
const FLYING: &str = "#[derivative] model M { causality componentwise; gravity [0.0, 0.0, -9.81];
    1 ground[6]; 1 second[6]; 1 fourth[6]; 1 first[6]; 1 third[6]; 1 fifth[6];
    fifth_body: Body { mass: 1.0, inertia: 1.0 } (fifth);
    sleeve: Cylindrical { axis: 0 } (first, fifth);
    fourth_body: Body { mass: 1.0, inertia: 1.0 } (fourth);
    far: Free { first: 0, second: 2, third: 0, initial: [-0.1, 1.2, -0.5] } (third, fourth);
    third_body: Body { mass: 1.0, inertia: 1.0 } (third);
    near: Free (second, third);
    second_body: Body { mass: 1.0, inertia: 1.0 } (second);
    ball: Spherical {
        first: 2, second: 0, third: 2, initial: [-0.6, 1.2, -0.5], offset: [0.4, 0.2, 0.0]
    } (first, second);
    first_body: Body { mass: 1.0, inertia: 1.0 } (first);
    rail: Cylindrical { axis: 0 } (ground, first);
    Sf fixed[6] { flow: 0.0 } -> ground; }";

/// A ball on a hinge that is declared after it.
const BALL: &str = "#[derivative] model M {
    1 ground[6]; 1 arm[6]; 1 ball[6];
    Sf fixed[6] { flow: 0.0 } -> ground;
    joint: Spherical { initial: [0.3, 0.4, 0.5] } (arm, ball);
    hinge: Revolute { axis: 2 } (ground, arm);
    rod: Body { mass: 1.0, inertia: 0.1 } (arm);
    mass: Body { mass: 1.0, inertia: 0.1 } (ball);
    output angles[3] = joint.angle; }";

/// A body that flies, counted from an arm that is declared after it.
const RELEASED: &str = "#[derivative] model M {
    1 ground[6]; 1 arm[6]; 1 loose[6];
    Sf fixed[6] { flow: 0.0 } -> ground;
    free: Free { orientation: quaternion, initial_position: [0.3, 0.2, 0.5] } (arm, loose);
    hinge: Revolute { axis: 1 } (ground, arm);
    rod: Body { mass: 1.0, inertia: 0.1 } (arm);
    mass: Body { mass: 1.0, inertia: 0.1 } (loose);
    output place[3] = free.position; }";

/// A routine at the start, but with another value of a state.
fn at(model: &Compiled, state: &str, value: f64, routine: usize) -> Vec<f64> {
    let states = model.states.iter();
    let names = states.map(|it| model.model.states[*it].variable.name.as_str());
    let place = names.into_iter().position(|it| it == state);
    let run = |routine, state: &[f64]| {
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state,
            input: &[],
        };
        evaluate(&model.program, routine, &arguments)
    };
    let mut start = run(Routines::INITIAL, &vec![0.0; model.states.len()]);
    start[place.unwrap()] = value;
    run(routine, &start)
}

#[test]
fn a_body_on_a_joint_that_gives_way_may_start_at_zero() {
    let model = compiled(BASE);
    let [here, beside] =
        [0.0, 1e-7].map(|angle| at(&model, "universal.angle.x", angle, Routines::DERIVATIVE));
    for (here, beside) in here.iter().zip(&beside) {
        assert!((here - beside).abs() < 1e-5, "{here} and {beside}");
    }
}

/// What a model divides by is far from zero wherever an angle stands.
fn regular(text: &str, angle: &str) {
    let model = compiled(text);
    for number in -10..=10 {
        for value in at(
            &model,
            angle,
            0.3 * f64::from(number),
            Routines::CONDITIONING,
        ) {
            assert!(value.abs() > 1e-2, "{value}");
        }
    }
}

#[test]
fn bodies_on_a_base_that_gives_way_are_singular_at_no_angle() {
    regular(BASE, "universal.angle.x");
}

#[test]
fn what_is_solved_with_numbers_alone_says_whether_it_is_singular() {
    regular(FLYING, "rail.angle");
}

#[test]
fn what_carries_a_free_body_may_be_declared_after_it() {
    regular(BALL, "joint.rotation.gimbal.angle.x");
    regular(RELEASED, "free.position.z");
}

/// A link without mass between a hinge and a joint that gives way, and one between two bodies, in any order.
const BARE: [&str; 7] = [
    "k2: PlanarPrismatic { direction: -0.1, stiffness: 9.7, rest: 0.1 } (crank, slide);",
    "gap: PlanarOffset { x: -0.5 } (bare, bar);",
    "b5: PlanarBody { mass: 1.9, inertia: 0.16 } (lower); k5: PlanarRevolute (bar, lower);",
    "b3: PlanarBody { mass: 0.5, inertia: 0.12 } (upper);",
    "line: PlanarLineForce { stiffness: 12.0, rest: 0.5, damping: 0.4 } (crank, slide);",
    "k3: PlanarRevolute { blocked: compliant, blocked_stiffness: 2e3, blocked_damping: 40.0 } (slide, upper);",
    "k4: PlanarRevolute (upper, bare);",
];

#[test]
fn what_depends_on_each_other_is_the_same_in_any_order() {
    // Which of the hinges of a link counts its motion goes by the order, and makes no difference.
    let states = |statements: &[&str]| {
        let model = compiled(&format!(
            "#[derivative] model M {{ causality componentwise; Sf fixed[3] {{ flow: 0.0 }} -> ground;
            1 ground[3]; 1 crank[3]; 1 slide[3]; 1 upper[3]; 1 bare[3]; 1 bar[3]; 1 lower[3];
            k1: PlanarRevolute (ground, crank); {} }}",
            statements.join(" ")
        ));
        let states = model.states.iter();
        let names = states.map(|it| model.model.states[*it].variable.name.clone());
        let rate = |name: String| match name.as_str() {
            "k4.rate.f" | "k5.rate.f" => "the rate of the link".to_owned(),
            _ => name,
        };
        names.map(rate).collect::<BTreeSet<String>>()
    };
    let expected = states(&BARE);
    assert!(expected.contains("k2.spring.q"), "{expected:?}");
    for turn in 0..BARE.len() {
        let mut statements = BARE;
        statements.rotate_left(turn);
        assert_eq!(states(&statements), expected, "{turn}");
        statements.reverse();
        assert_eq!(states(&statements), expected, "{turn} in reverse");
    }
}
