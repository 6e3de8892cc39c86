//! Random mechanisms of the library, with and without loops, move as Gauss's principle says, and their energy changes by
//! the power that they tell.
//!
//! The other derivation knows where frames are as functions of the coordinates, and nothing else of the library: their
//! derivatives are those of polynomials of time, which are exact. All states that a program may choose are told by it with
//! their rates, whatever is chosen.
//!
//! `PROPTEST_CASES=20000 PROPTEST_RNG_SEED=7 cargo test --release -p mbg-compiler --test mechanisms` tries many others.
//! Of thousands, a loop may be refused with `MBG0404` though no motion is singular where it starts: if nothing is fixed to one of
//! its frames, elimination may divide by more than the inertia of the mechanism.
#![allow(clippy::unwrap_used)]

mod models;
mod mechanisms {
    pub(crate) mod parts;
    pub(crate) mod pose;
    pub(crate) mod random;
    pub(crate) mod reference;
    pub(crate) mod states;
    pub(crate) mod text;
}

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{self, Arguments};
use mechanisms::parts::Mechanism;
use mechanisms::random::{mechanism, ring};
use mechanisms::reference::Reference;
use mechanisms::states::{States, states};
use mechanisms::text::text;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Rates may differ by so much of the largest of them.
const TOLERANCE: f64 = 1e-9;

/// A program at a state that is told by name.
struct Run<'a> {
    model: &'a Compiled,
    state: Vec<f64>,
    expected: Vec<f64>,
}

impl<'a> Run<'a> {
    fn of(model: &'a Compiled, states: &States) -> Result<Self, String> {
        let names = model.states.iter();
        let names = names.map(|state| &model.model.states[*state].variable.name);
        let told = names.map(|name| {
            states
                .get(name)
                .ok_or(format!("nothing is told of `{name}`"))
        });
        let told: Vec<[f64; 2]> = told.map(|it| it.copied()).collect::<Result<_, _>>()?;
        Ok(Self {
            model,
            state: told.iter().map(|it| it[0]).collect(),
            expected: told.iter().map(|it| it[1]).collect(),
        })
    }

    fn evaluated(&self, routine: usize) -> Vec<f64> {
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &self.state,
            input: &[],
        };
        program::evaluate(&self.model.program, routine, &arguments)
    }
}

/// The largest difference, beside the largest value or one; what is no number is kept.
fn apart(found: &[f64], expected: &[f64]) -> f64 {
    let size = expected.iter().fold(1.0_f64, |size, it| size.max(it.abs()));
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let lengths = if found.len() == expected.len() {
        0.0
    } else {
        f64::NAN
    };
    differences.fold(lengths, |worst, it| if it <= worst { worst } else { it }) / size
}

/// Where a mechanism is compared, and at its start; none where either is nearly singular.
fn references(mechanism: &Mechanism, is_moved: bool) -> Option<Reference<'_>> {
    let start = Reference::of(mechanism, mechanism.start(), true)?;
    start.motion()?;
    match is_moved {
        true => Reference::of(mechanism, mechanism.moved(), false),
        false => Some(start),
    }
}

fn assert_moves(mechanism: &Mechanism, is_moved: bool) -> Result<(), TestCaseError> {
    let text = text(mechanism);
    let Some(reference) = references(mechanism, is_moved) else {
        return Err(TestCaseError::reject("nearly singular"));
    };
    let Some(motion) = reference.motion() else {
        return Err(TestCaseError::reject("nearly singular"));
    };
    let model = models::completed(&text).map_err(TestCaseError::fail)?;
    let run = Run::of(&model, &states(mechanism, &motion)).map_err(TestCaseError::fail)?;
    let rates = run.evaluated(Routines::DERIVATIVE);
    let same = |what: &str, found: &[f64], expected: &[f64]| {
        let apart = apart(found, expected);
        match apart < TOLERANCE {
            true => Ok(()),
            false => Err(TestCaseError::fail(format!(
                "{what}: {found:?}, not {expected:?}: {apart:e}"
            ))),
        }
    };
    same("rates", &rates, &run.expected)?;
    let open = reference.open();
    let flows = run.evaluated(Routines::CLOSED_FLOWS);
    same("flows of ends", &flows[..model.closed[1].len()], &open)?;
    let [energy, change] = reference.energy(&motion);
    let power = run.evaluated(Routines::POWER);
    same("energy", &run.evaluated(Routines::ENERGY), &[energy])?;
    same("dissipated", &power[1..], &[reference.dissipated()])?;
    if is_moved {
        // Multipliers do work where ends move apart.
        return Ok(());
    }
    same(
        "power",
        &[power[0] - power[1], power[1]],
        &[change, power[1]],
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        max_global_rejects: 100_000,
        ..ProptestConfig::default()
    })]

    #[test]
    fn mechanisms_move_as_gauss_says((mechanism, is_moved) in mechanism()) {
        assert_moves(&mechanism, is_moved)?;
    }

    /// Whose rates follow from those that are no states, and do not at a dead centre.
    #[test]
    fn rings_move_as_gauss_says(mechanism in ring()) {
        assert_moves(&mechanism, false)?;
    }
}

/// The length of the line says nothing of the angle of the first hinge, whose axis it begins on.
#[test]
fn a_line_that_only_seems_to_grow_with_an_angle_starts() {
    let model = models::compiled(
        "#[derivative] model Mechanism {
            1 ground[6] { Sf fixed { flow: 0.0 } } 1 first[6]; 1 second[6]; 1 far[6];
            post: Revolute { axis: 2 } (ground, first);
            one: Body { mass: 1.0, inertia: 1.0 } (first);
            arm: Revolute { axis: 0, offset: [-0.4, 1.0, 0.0] } (first, second);
            other: Body { mass: 1.0, inertia: 1.0 } (second);
            mount: Offset { by: [0.0, 0.0, 0.5] } (ground, far);
            line: LineForce { stiffness: 2.0, rest: 0.5 } (second, far);
        }",
    );
    let evaluated = |routine: usize, state: &[f64]| {
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state,
            input: &[],
        };
        program::evaluate(&model.program, routine, &arguments)
    };
    let start = evaluated(Routines::INITIAL, &[]);
    let stretch = 0.4_f64.hypot(1.0).hypot(0.5) - 0.5;
    let stored = evaluated(Routines::ENERGY, &start)[0];
    assert!((stored - stretch * stretch).abs() < 1e-15, "{stored}");
}

/// An angle of the cut stays a right one whatever the hinge does, but for rounding.
#[test]
fn axes_in_numbers_that_are_rounded_close_a_loop() {
    let tilt = "[[6.1e-17, -6.1e-17, 1.0], [1.0, 3.7e-33, -6.1e-17], [0.0, 1.0, 6.1e-17]]";
    let model = models::compiled(&format!(
        "#[derivative] model Mechanism {{
            1 ground[6] {{ Sf fixed {{ flow: 0.0 }} }} 1 frame[6]; 1 eye[6];
            hinge: Revolute {{ axis: 1, tilt: {tilt} }} (ground, frame);
            body: Body {{ mass: 1.0, inertia: 1.0 }} (frame);
            mount: Mount {{ tilt: {tilt} }} (ground, eye);
            cut: Cut {{ joint: universal }} (frame, eye);
        }}"
    ));
    assert_eq!(model.closed[0].len(), 4);
}

/// The slides are along one axis, but for what is rounded of the tilt; the cut leaves the pendulum and a wheel.
#[test]
fn what_is_rounded_of_a_right_angle_is_not_divided_by() {
    let tilt = "[[0.0, -1.0, 6.123e-17], [6.123e-17, 6.123e-17, 1.0], [-1.0, 0.0, 6.123e-17]]";
    let model = models::compiled(&format!(
        "#[derivative] model Mechanism {{
            gravity [0.0, 0.0, -9.81];
            1 ground[6] {{ Sf fixed {{ flow: 0.0 }} }} 1 first[6]; 1 second[6]; 1 third[6]; 1 eye[6];
            hinge: Revolute {{ axis: 0 }} (ground, first);
            body: Body {{ mass: 1.0, inertia: 1.0 }} (first);
            slide: Prismatic {{ axis: 1 }} (first, second);
            sleeve: Cylindrical {{ axis: 2, tilt: {tilt} }} (second, third);
            swinging: Body {{ mass: 1.0, inertia: 1.0, centre: [1.0, 0.0, 0.0] }} (third);
            I wheel {{ inertia: 0.2 }} -> sleeve.sliding;
            mount: Mount {{ tilt: {tilt} }} (first, eye);
            cut: Cut {{ joint: revolute }} (third, eye);
        }}"
    ));
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &vec![0.0; model.states.len()],
        input: &[],
    };
    let rates = program::evaluate(&model.program, Routines::DERIVATIVE, &arguments);
    assert!(rates.iter().all(|rate| rate.abs() < 1e-12), "{rates:?}");
}
