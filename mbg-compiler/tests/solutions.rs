//! Random mechanisms of the library: their efforts, flows and rates fulfil the equations that they are solved from.
//!
//! How these are solved counts rates from a motion, hands on inertia and divides by what is proven; the equations are those
//! of junctions, joints and laws, one by one.

mod models;

use std::fmt::Write;

use mbg_compiler::elaborate::Elaborated;
use mbg_compiler::structure::Solved;
use mbg_compiler::symbolic::{Evaluation, Pool, Symbol};
use proptest::prelude::*;

/// A residual may be so large beside the terms of its equation and the largest value.
const ROUNDING: f64 = 1e-10;

/// What is between a frame and the one that carries it.
const JOINTS: [&str; 9] = [
    "Revolute { axis: 0, damping: 0.1 }",
    "Revolute { axis: 1, initial: 0.3, stiffness: 2.0 }",
    "Revolute { axis: 2 }",
    "Prismatic { axis: 0, stiffness: 3.0 }",
    "Prismatic { axis: 2, initial: 0.4, damping: 0.2 }",
    "Cylindrical { axis: 1, slide_stiffness: 2.0 }",
    "Universal { initial: [0.2, 0.4] }",
    "Spherical { initial: [0.2, 0.3, 0.1], orientation: quaternion }",
    "Free { orientation: quaternion }",
];

/// What a frame is moved by, and what it carries besides a body.
const LOADS: [&str; 7] = [
    "",
    "",
    "load#: Load { force: [1.0, 0.0, -2.0] } (frame#);",
    "load#: Load { axes: world, moment: [0.3, 0.0, 0.0], orientation_at: joint#.orientation_b } (frame#);",
    "Se push# { effort: [1.0, 0.0, 0.5] } -> body#.velocity;",
    "more#: Body { mass: 0.6, inertia: diag(0.1, 0.2, 0.25), centre: [0.3, 0.0, 0.2], gravity_at: joint#.gravity_b } (frame#);",
    "point#: PointMass { mass: 0.7, gravity_at: joint#.gravity_b } (frame#);",
];

/// A frame with its body.
#[derive(Clone, Debug)]
struct Part {
    parent: usize,
    joint: &'static str,
    offset: [f64; 3],
    turn: &'static str,
    mass: f64,
    moments: [f64; 3],
    product: f64,
    centre: [f64; 3],
    load: &'static str,
}

/// What joins the last frame to another besides.
const LINES: [&str; 3] = [
    "",
    "line: LineForce { stiffness: 3.0, rest: 0.5, damping: 0.1, orientation_a: joint#.orientation_b,
        position_a: joint#.position_b + joint#.orientation_b * [0.1, 0.2, 0.3], position_b: [3.0, 2.0, 1.0] } (frame#, far);",
    "cut: Cut { orientation_a: joint#.orientation_b, position_a: joint#.position_b } (frame#, ground);",
];

fn text(parts: &[Part], line: &str, gravity: bool) -> String {
    let gravity = if gravity {
        "gravity [0.0, 0.0, -9.81];"
    } else {
        ""
    };
    let mut text = format!(
        "#[derivative] model Mechanism {{ {gravity} causality componentwise;
        1 ground[6] {{ Sf fixed {{ flow: 0.0 }} }} 1 far[6] {{ Sf held {{ flow: 0.0 }} }}\n"
    );
    for (k, part) in parts.iter().enumerate() {
        let Part { offset, turn, .. } = part;
        let (base, passed) = match part.parent.checked_sub(1) {
            None => ("ground".to_owned(), String::new()),
            Some(parent) => {
                let motion = ["gravity", "orientation", "position"];
                let passed = motion.map(|it| format!(", {it}_a: joint{parent}.{it}_b"));
                (format!("frame{parent}"), passed.concat())
            }
        };
        let joint = part.joint.trim_end_matches(" }");
        let [x, y, z] = part.moments;
        let product = part.product;
        let inertia = format!(
            "[[{x:?}, {product:?}, 0.0], [{product:?}, {y:?}, {product:?}], [0.0, {product:?}, {z:?}]]"
        );
        let (mass, centre) = (part.mass, part.centre);
        let number = k.to_string();
        write!(
            text,
            "1 frame{k}[6];
            joint{k}: {joint}, offset: {offset:?}, tilt: {turn}{passed} }} ({base}, frame{k});
            body{k}: Body {{ mass: {mass:?}, inertia: {inertia}, centre: {centre:?}, gravity_at: joint{k}.gravity_b }} (frame{k});
            {}\n",
            part.load.replace('#', &number)
        )
        .expect("a text");
    }
    text += &line.replace('#', &(parts.len() - 1).to_string());
    text + "}"
}

fn part(number: usize) -> impl Strategy<Value = Part> {
    let round = || prop::sample::select(&[0.0, 0.0, 1.0, -1.0, 0.5][..]);
    let place = move || prop::array::uniform3(prop_oneof![round(), -1.0..1.0_f64]);
    let positive = || prop_oneof![prop::sample::select(&[1.0, 2.0, 0.5][..]), 0.5..2.0_f64];
    let turns = [
        "1.0",
        "1.0",
        "rot_x(0.3)",
        "rot_y(1.5707963267948966)",
        "rot_z(-0.7)",
    ];
    // Chains are more frequent than stars.
    let parent = prop_oneof![3 => Just(number), 1 => 0..=number];
    let moments = prop_oneof![
        positive().prop_map(|it| [it; 3]),
        prop::array::uniform3(1.0..1.6_f64)
    ];
    let body = (positive(), moments, prop_oneof![Just(0.0), -0.1..0.1_f64]);
    let joint = (prop::sample::select(&JOINTS[..]), place());
    let turn = prop::sample::select(turns.to_vec());
    let load = prop::sample::select(&LOADS[..]);
    (parent, joint, turn, body, place(), load).prop_map(
        |(parent, (joint, offset), turn, (mass, moments, product), centre, load)| Part {
            parent,
            joint,
            offset,
            turn,
            mass,
            moments,
            product,
            centre,
            load,
        },
    )
}

fn mechanism() -> impl Strategy<Value = String> {
    let parts = (1..5_usize).prop_flat_map(|count| (0..count).map(part).collect::<Vec<_>>());
    let line = prop::sample::select(&LINES[..]);
    (parts, line, any::<bool>()).prop_map(|(parts, line, gravity)| text(&parts, line, gravity))
}

/// Numbers between -1 and 1, in the order in which they are asked for.
fn wave(seed: u64) -> impl FnMut() -> f64 {
    let mut phase = seed as f64;
    move || {
        phase += 1.3;
        (phase * phase).sin()
    }
}

/// The states near the start, with attitudes as they are there.
fn states(model: &Elaborated, pool: &Pool, parameters: &[f64], seed: u64) -> Vec<f64> {
    let symbol = |symbol| match symbol {
        Symbol::Parameter(number) => parameters[number],
        _ => f64::NAN,
    };
    let mut start = Evaluation::new(&symbol);
    let mut next = wave(seed);
    let attitudes = model.attitudes.iter().flat_map(|it| it.rows.concat());
    let attitudes: Vec<usize> = attitudes.collect();
    let states = model.states.iter().enumerate();
    states
        .map(|(number, state)| {
            let initial = start.value(pool, state.initial);
            match attitudes.contains(&number) {
                true => initial,
                false => initial + 0.7 * next(),
            }
        })
        .collect()
}

/// The equation that is fulfilled worst, with what is left of it; none if values are not finite.
fn residual(model: &Elaborated, solved: &Solved, pool: &Pool, seed: u64) -> Option<f64> {
    let parameters: Vec<f64> = model.parameters.iter().map(|it| it.default).collect();
    let states = states(model, pool, &parameters, seed);
    let value = |symbol: Symbol, signals: &[f64]| match symbol {
        Symbol::Parameter(number) => parameters[number],
        Symbol::State(number) => states[number],
        Symbol::Input(number) => 0.3 + number as f64,
        Symbol::Time => 0.4,
        Symbol::Signal(number) => signals.get(number).copied().unwrap_or(f64::NAN),
        Symbol::Slope(_) | Symbol::Unknown(_) => f64::NAN,
    };
    let bare = |symbol| value(symbol, &[]);
    let mut evaluation = Evaluation::new(&bare);
    let values = solved.solution.values.iter();
    let values: Vec<f64> = values.map(|it| evaluation.value(pool, *it)).collect();
    let signals = solved.scalars.signals.iter();
    let signals: Vec<f64> = signals
        .map(|(unknown, reversed)| values[*unknown] * if *reversed { -1.0 } else { 1.0 })
        .collect();
    let with_signals = |symbol| value(symbol, &signals);
    let mut evaluation = Evaluation::new(&with_signals);
    let largest = values.iter().fold(1.0_f64, |size, it| size.max(it.abs()));
    let mut worst = 0.0_f64;
    for equation in &solved.scalars.equations {
        let mut sum = evaluation.value(pool, equation.constant);
        let mut size = largest;
        for (unknown, coefficient) in &equation.terms {
            let term = evaluation.value(pool, *coefficient) * values[*unknown];
            sum += term;
            size = size.max(term.abs());
        }
        if !sum.is_finite() {
            return None;
        }
        worst = worst.max(sum.abs() / size);
    }
    Some(worst)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn solutions_fulfil_their_equations(text in mechanism(), seed in 0..1000_u64) {
        // What closes a loop may hold a motion twice, which is refused.
        if let Ok((model, solved, pool)) = models::solved(&text) {
            let residual = residual(&model, &solved, &pool, seed);
            let holds = residual.map_or(text.contains("cut:"), |it| it < ROUNDING);
            prop_assert!(holds, "{residual:?}\n{text}");
        } else {
            prop_assert!(text.contains("cut:"), "{:?}\n{text}", models::solved(&text).err());
        }
    }
}
