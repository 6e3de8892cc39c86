//! Random mechanisms of the library: their efforts, flows and rates fulfil the equations that they are solved from.
//!
//! How these are solved counts rates from a motion, hands on inertia and divides by what is proven; the equations are those
//! of junctions, joints and laws, one by one.
//!
//! `PROPTEST_CASES=20000 PROPTEST_RNG_SEED=7 cargo test --release -p mbg-compiler --test solutions` tries many others. Of
//! thousands a loop may come so near to where its divisors vanish that its rounding shows.

mod models;

use std::collections::BTreeMap;
use std::fmt::Write;

use mbg_compiler::elaborate::Elaborated;
use mbg_compiler::structure::Solved;
use mbg_compiler::symbolic::{Evaluation, Expression, Kind, Method, Pool, Symbol};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// A residual may be so large beside the terms of its equation and the largest value.
const ROUNDING: f64 = 1e-10;

/// Normalised determinants that are smaller are nearly zero.
const NEAR: f64 = 1e-3;

/// A divisor that is no larger is zero but for rounding.
const ZERO: f64 = 1e-8;

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
    /// One more than the number of the frame that carries it; zero where that is the ground.
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

/// The joint of the last frame where a cut ties it to the ground.
const FLYING: &str = "Free { orientation: quaternion }";

/// What joins the last frame to something besides: it always leaves a motion, so that no cut holds one twice.
const LINES: [&str; 4] = [
    "",
    "line: LineForce { stiffness: 3.0, rest: 0.5, damping: 0.1, orientation_a: joint#.orientation_b,
        position_a: joint#.position_b + joint#.orientation_b * [0.1, 0.2, 0.3], position_b: [3.0, 2.0, 1.0] } (frame#, far);",
    "1 stone[6]; float: Free { orientation: quaternion, initial_position: [0.5, 0.2, 0.1], tilt: @ } (ground, stone);
        rock: Body { mass: 0.8, inertia: diag(0.1, 0.2, 0.25), gravity_at: float.gravity_b } (stone); %
        1 eye[6]; arm: Offset { by: [0.3, 0.1, 0.2] } (stone, eye);
        cut: Cut { orientation_a: joint#.orientation_b, position_a: joint#.position_b, orientation_b: float.orientation_b,
            position_b: float.position_b + float.orientation_b * [0.3, 0.1, 0.2] } (frame#, eye);",
    TIED,
];

/// A cut between the last frame, which flies, and the ground.
const TIED: &str = "cut: Cut { orientation_a: joint#.orientation_b, position_a: joint#.position_b } (frame#, ground);";

/// What else is fixed to the stone.
const MORE: [&str; 2] = [
    "",
    "more: Body { mass: 0.6, inertia: diag(0.1, 0.2, 0.25), centre: [0.3, 0.0, 0.2], gravity_at: float.gravity_b } (stone);",
];

/// How a frame is turned from the one that carries its joint.
const TURNS: [&str; 6] = [
    "1.0",
    "1.0",
    "rot_x(0.3)",
    "rot_y(1.5707963267948966)",
    "rot_z(-0.7)",
    "rot_x(0.3) * rot_z(-0.7)",
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
    // Chains are more frequent than stars.
    let parent = prop_oneof![3 => Just(number), 1 => 0..=number];
    let moments = prop_oneof![
        positive().prop_map(|it| [it; 3]),
        prop::array::uniform3(1.0..1.6_f64)
    ];
    let body = (positive(), moments, prop_oneof![Just(0.0), -0.1..0.1_f64]);
    let joint = (prop::sample::select(&JOINTS[..]), place());
    let turn = prop::sample::select(&TURNS[..]);
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
    let select = |of: &'static [&'static str]| prop::sample::select(of);
    let line = (select(&LINES), select(&TURNS), select(&MORE), any::<bool>());
    (parts, line).prop_map(|(mut parts, (line, turn, more, gravity))| {
        if let Some(last) = parts.last_mut().filter(|_| line == TIED) {
            last.joint = FLYING;
        }
        let line = line.replace('@', turn).replace('%', more);
        text(&parts, &line, gravity)
    })
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

/// The divisor that is smallest at the start, where no joint of these is singular.
fn smallest(model: &Elaborated, solved: &Solved, pool: &Pool) -> f64 {
    let parameter = |symbol| match symbol {
        Symbol::Parameter(number) => model.parameters[number].default,
        _ => f64::NAN,
    };
    let mut initial = Evaluation::new(&parameter);
    let states = model.states.iter();
    let states: Vec<f64> = states.map(|it| initial.value(pool, it.initial)).collect();
    let symbol = |symbol| match symbol {
        Symbol::State(number) => states[number],
        other => parameter(other),
    };
    let mut start = Evaluation::new(&symbol);
    let divisors = solved.solution.conditioning.iter();
    let sizes = divisors.map(|it| start.value(pool, it.normalised).abs());
    sizes.fold(1.0, |least, it| if it >= least { least } else { it })
}

/// What is left of the equation that is fulfilled worst, beside its terms and the largest value; not a number where a value
/// is none. Nothing near a zero of a divisor, which is told.
fn residual(model: &Elaborated, solved: &Solved, pool: &Pool, seed: u64) -> Option<f64> {
    let parameters: Vec<f64> = model.parameters.iter().map(|it| it.default).collect();
    let states = states(model, pool, &parameters, seed);
    let symbol = |symbol: Symbol, multipliers: &BTreeMap<usize, f64>, signals: &[f64]| match symbol
    {
        Symbol::Parameter(number) => parameters[number],
        Symbol::State(number) => states[number],
        Symbol::Unknown(number) => multipliers.get(&number).copied().unwrap_or(f64::NAN),
        Symbol::Signal(number) => signals.get(number).copied().unwrap_or(f64::NAN),
        Symbol::Input(_) | Symbol::Time | Symbol::Slope(_) => f64::NAN,
    };
    let multipliers = multipliers(pool, &|it| symbol(it, &BTreeMap::new(), &[]));
    let before = |it| symbol(it, &multipliers, &[]);
    let mut evaluation = Evaluation::new(&before);
    let mut divisors = solved.solution.conditioning.iter();
    let is_near = |divisor: f64| divisor.abs() < NEAR;
    if divisors.any(|it| is_near(evaluation.value(pool, it.normalised))) {
        return None;
    }
    let values = solved.solution.values.iter();
    let values: Vec<f64> = values.map(|it| evaluation.value(pool, *it)).collect();
    let signals = solved.scalars.signals.iter();
    let signals: Vec<f64> = signals
        .map(|(unknown, reversed)| values[*unknown] * if *reversed { -1.0 } else { 1.0 })
        .collect();
    let after = |it| symbol(it, &multipliers, &signals);
    let mut evaluation = Evaluation::new(&after);
    let largest = values.iter().fold(1.0_f64, |size, it| size.max(it.abs()));
    let residuals = solved.scalars.equations.iter().map(|equation| {
        let terms = equation.terms.iter();
        let terms = terms
            .map(|(unknown, coefficient)| evaluation.value(pool, *coefficient) * values[*unknown]);
        let terms: Vec<f64> = terms.collect();
        let sum = terms.iter().sum::<f64>() + evaluation.value(pool, equation.constant);
        sum.abs() / terms.iter().fold(largest, |size, it| size.max(it.abs()))
    });
    // Unlike `max`, this keeps what is not a number.
    Some(residuals.fold(0.0, |worst, it| if it <= worst { worst } else { it }))
}

/// The multipliers of loops, by the numbers of their symbols.
fn multipliers(pool: &Pool, symbol: &dyn Fn(Symbol) -> f64) -> BTreeMap<usize, f64> {
    let mut evaluation = Evaluation::new(symbol);
    let mut found = BTreeMap::new();
    for implicit in pool.implicit() {
        let Method::Linear {
            matrix,
            right,
            kind: Kind::Semidefinite,
        } = &implicit.method
        else {
            continue;
        };
        let mut values = |of: &[Expression]| {
            let values = of.iter().map(|it| evaluation.value(pool, *it));
            values.collect::<Vec<f64>>()
        };
        let count = right.len();
        let matrix = DMatrix::from_row_slice(count, count, &values(&matrix.entries));
        let right = DVector::from_vec(values(right));
        let solved = matrix.lu().solve(&right);
        let solved = solved.unwrap_or_else(|| DVector::from_element(count, f64::NAN));
        found.extend(
            implicit
                .unknowns
                .iter()
                .copied()
                .zip(solved.iter().copied()),
        );
    }
    found
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn solutions_fulfil_their_equations(text in mechanism(), seed in 0..1000_u64) {
        let (model, solved, pool) = models::solved(&text).unwrap_or_else(|told| panic!("{told}\n{text}"));
        let smallest = smallest(&model, &solved, &pool);
        prop_assert!(smallest > ZERO, "{smallest} at the start\n{text}");
        let residual = residual(&model, &solved, &pool, seed);
        prop_assume!(residual.is_some());
        prop_assert!(residual.is_some_and(|it| it < ROUNDING), "{residual:?}\n{text}");
    }
}
