//! The joints of the library: what they let move, that blocked axes do no work, and that stiff joints become ideal ones.
#![allow(clippy::unwrap_used)]

#[path = "joints/convergence.rs"]
mod convergence;
#[path = "joints/gears.rs"]
mod gears;
#[path = "joints/loops.rs"]
mod loops;
mod models;
#[path = "joints/reactions.rs"]
mod reactions;
#[path = "joints/regular.rs"]
mod regular;
#[path = "joints/scene.rs"]
mod scene;
#[path = "joints/scenes.rs"]
mod scenes;

use mbg_compiler::compile::Routines;
use scene::{Scene, cross, dot, is_planar, sum};

/// The documentation of the joints, whose tables are held true here.
const DOCUMENTATION: &str = include_str!("../../mbg-runtime/src/joints.md");

/// A joint, how it is called, what else it may be given, and its coordinates.
const JOINTS: &[(&str, &str, &str, &[&str])] = &[
    ("Fixed", "", "", &[]),
    (
        "Revolute",
        "axis: 1",
        "initial: 0.3, stiffness: 5.0, rest: 0.1, damping: 0.2, friction: 0.4, torque: 1.5",
        &["angle"],
    ),
    (
        "Prismatic",
        "axis: 2",
        "initial: 0.3, stiffness: 5.0, rest: 0.1, damping: 0.2, friction: 0.4, force: 1.5",
        &["travel"],
    ),
    (
        "Cylindrical",
        "axis: 0",
        "initial_angle: 0.3, initial_travel: 0.2, turn_stiffness: 5.0, slide_stiffness: 6.0, rest_angle: 0.1,
         rest_travel: 0.2, turn_damping: 0.3, slide_damping: 0.2, turn_friction: 0.4, slide_friction: 0.3,
         torque: 1.5, force: 1.2",
        &["angle", "travel"],
    ),
    (
        "Universal",
        "first: 2, second: 0",
        "initial: [0.3, 0.2], stiffness: [5.0, 6.0], rest: [0.1, 0.1], damping: [0.2, 0.3], friction: [0.4, 0.3], torque: [1.5, 0.2]",
        &["angle.x", "angle.y"],
    ),
    (
        "Planar",
        "axis: 1",
        "initial_angle: 0.3, initial_travel: [0.2, 0.1], turn_stiffness: 5.0, slide_stiffness: [6.0, 7.0], rest_angle: 0.1,
         rest_travel: [0.2, 0.2], turn_damping: 0.3, slide_damping: [0.2, 0.4], turn_friction: 0.4,
         slide_friction: [0.3, 0.2], torque: 1.5, force: [1.2, 0.3]",
        &["angle", "travel.x", "travel.y"],
    ),
    (
        "Spherical",
        "",
        "first: 2, third: 0, initial: [0.3, 0.2, -0.1], stiffness: 5.0, damping: 0.2, friction: 0.4,
         torque: [1.5, 0.2, -0.3]",
        &["angle.x", "angle.y", "angle.z"],
    ),
    (
        "Free",
        "",
        "initial: [0.3, 0.2, 0.1], initial_position: [0.1, 0.2, 0.3], stiffness: 5.0, damping: 0.2, friction: 0.4,
         torque: [1.5, 0.2, 0.3], force: [0.1, 0.2, 0.4]",
        &[
            "angle.x",
            "angle.y",
            "angle.z",
            "position.x",
            "position.y",
            "position.z",
        ],
    ),
    (
        "PlanarRevolute",
        "",
        "initial: 0.3, stiffness: 5.0, rest: 0.1, damping: 0.2, friction: 0.4, torque: 1.5",
        &["angle"],
    ),
    (
        "PlanarPrismatic",
        "direction: 0.4",
        "initial: 0.3, stiffness: 5.0, rest: 0.1, damping: 0.2, friction: 0.4, force: 1.5",
        &["travel"],
    ),
    (
        "PlanarFree",
        "",
        "initial: 0.3, initial_position: [0.1, 0.2], stiffness: 5.0, rest: 0.1, damping: 0.2, friction: 0.4, torque: 1.5,
         force: [0.1, 0.2]",
        &["angle", "position.x", "position.y"],
    ),
];

/// The same joints with their orientation held otherwise.
const OTHERWISE: &[(&str, &str, &str, &[&str])] = &[
    (
        "Spherical",
        "orientation: quaternion, initial: [0.3, 0.2, 0.1]",
        TURNED,
        &[],
    ),
    (
        "Spherical",
        "orientation: matrix, initial: [0.3, 0.2, 0.1]",
        TURNED,
        &[],
    ),
    (
        "Free",
        "orientation: quaternion, initial: [0.3, 0.2, 0.1]",
        TURNED,
        &[],
    ),
    (
        "Free",
        "orientation: matrix, initial: [0.3, 0.2, 0.1]",
        TURNED,
        &[],
    ),
];

const TURNED: &str = "stiffness: 5.0, damping: 0.2, friction: 0.4, torque: [1.5, 0.2, 0.3]";
const MOUNTED: &str = "offset: [0.1, -0.2, 0.3], tilt: rot_x(0.4) * rot_z(-0.3)";
const COMPLIANT: &str = "blocked: compliant, blocked_stiffness: 700.0, blocked_damping: 3.0";

/// The rows of a table of the documentation whose first cells are code.
fn rows(columns: usize) -> Vec<Vec<&'static str>> {
    let cells = |line: &'static str| -> Vec<&str> {
        line.trim_matches('|')
            .split('|')
            .map(|cell| cell.trim().trim_matches('`'))
            .collect()
    };
    let rows = DOCUMENTATION.lines().filter(|line| line.starts_with("| `"));
    rows.map(cells).filter(|row| row.len() == columns).collect()
}

/// How many axes a cell of the table counts in words.
fn axes(cell: &str) -> usize {
    let count = |word: &str| match word {
        "one" => 1,
        "two" => 2,
        "three" => 3,
        _ => 0,
    };
    cell.split_whitespace().map(count).sum()
}

#[test]
fn degrees_of_freedom_are_those_of_the_table() {
    let table = rows(5);
    let names: Vec<&str> = JOINTS.iter().map(|joint| joint.0).collect();
    assert_eq!(table.iter().map(|row| row[0]).collect::<Vec<_>>(), names);
    for (row, (name, least, _, coordinates)) in table.iter().zip(JOINTS) {
        let scene = Scene::grounded(name, &[least], coordinates);
        let freedom: usize = row[2].parse().unwrap();
        assert_eq!(scene.velocities(), freedom, "{name}");
        let all = if row[1] == "space" { 6 } else { 3 };
        assert_eq!(axes(row[4]), all - freedom, "{name}");
        assert_eq!(scene.displacements(), freedom, "{name}");
        if freedom == all {
            continue;
        }
        // A compliant joint leaves the body all its freedom, and has a spring on each blocked axis.
        let compliant = Scene::grounded(name, &[least, COMPLIANT], coordinates);
        assert_eq!(compliant.velocities(), all, "{name}");
        assert_eq!(compliant.displacements(), all, "{name}");
    }
}

#[test]
fn a_spring_stores_the_coordinate_and_no_second_state_does() {
    for (name, least, full, coordinates) in JOINTS {
        let (bare, full) = (
            Scene::grounded(name, &[least], coordinates),
            Scene::grounded(name, &[least, full], coordinates),
        );
        assert_eq!(bare.displacements(), full.displacements(), "{name}");
    }
}

#[test]
fn constraint_forces_do_no_work() {
    for (name, least, ..) in JOINTS.iter().chain(OTHERWISE) {
        for mount in ["", MOUNTED] {
            if is_planar(name) && !mount.is_empty() {
                continue;
            }
            let scene = Scene::carried(name, &[least, mount]);
            for seed in 0..10 {
                let output = scene.run(Routines::OUTPUT, &scene.state(seed));
                let size = scene.size;
                let [into, at_a, out, at_b] =
                    [0, 1, 2, 3].map(|part| &output[part * size..(part + 1) * size]);
                let (given, taken) = (dot(into, at_a), dot(out, at_b));
                let scale: f64 = into.iter().zip(at_a).map(|(e, f)| (e * f).abs()).sum();
                assert!(scale > 0.1 || name.ends_with("Free"), "{name}: no forces");
                assert!(
                    (given - taken).abs() <= 1e-12 * scale,
                    "{name}: {given} {taken}"
                );
            }
        }
    }
}

#[test]
fn energy_is_supplied_stored_or_dissipated() {
    for (name, least, full, _) in JOINTS.iter().chain(OTHERWISE) {
        let planar = is_planar(name);
        let mount = if planar { "" } else { MOUNTED };
        let freest = if name.ends_with("Free") {
            ""
        } else {
            COMPLIANT
        };
        for blocked in ["", freest] {
            let scene = Scene::carried(name, &[least, full, mount, blocked]);
            for seed in 0..5 {
                let state = scene.state(seed);
                let rates = scene.run(Routines::DERIVATIVE, &state);
                // The power into each storage, among which much cancels where joints are stiff.
                let stored = scene.powers(&state, &rates);
                let power = scene.run(Routines::POWER, &state);
                let balance = stored.iter().sum::<f64>() - power[0] + power[1];
                let scale: f64 = stored.iter().chain(&power).map(|it| it.abs()).sum();
                assert!(
                    balance.abs() < 1e-13 * scale,
                    "{name} {blocked}: {balance:e} of {scale:e}"
                );
            }
        }
    }
}

/// Where a frame is said to be changes at the velocity that it has.
#[test]
fn positions_and_orientations_follow_the_flows() {
    for (name, least, ..) in JOINTS.iter().filter(|joint| !is_planar(joint.0)) {
        for mount in ["", MOUNTED] {
            let scene = Scene::carried(name, &[least, mount]);
            let state = scene.state(3);
            let output = scene.run(Routines::OUTPUT, &state);
            let rates = scene.run(Routines::DERIVATIVE, &state);
            let slope = scene.along(Routines::OUTPUT, &state, &rates);
            let triple = |list: &[f64], at: usize| [list[at], list[at + 1], list[at + 2]];
            let (omega, velocity) = (triple(&output, 18), triple(&output, 21));
            let columns = [0, 1, 2].map(|axis| triple(&output, 27 + 3 * axis));
            let in_world = |vector: [f64; 3]| {
                sum(&[0, 1, 2].map(|axis| columns[axis].map(|entry| entry * vector[axis])))
            };
            near(name, &triple(&slope, 24), &in_world(velocity));
            for (axis, column) in columns.iter().enumerate() {
                near(
                    name,
                    &triple(&slope, 27 + 3 * axis),
                    &cross(&in_world(omega), column),
                );
            }
            // Gravity in axes of b.
            near(name, &in_world(triple(&output, 36)), &[0.5, 1.0, -9.81]);
        }
    }
}

#[track_caller]
fn near(name: &str, found: &[f64], expected: &[f64]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-12,
            "{name}: found {found}, expected {expected}"
        );
    }
}
