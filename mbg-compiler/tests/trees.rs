//! Random trees of rigid bodies on hinges and slides, of components of the library, against Kane's equations in the
//! axes of the world, and the efforts in them against Newton's and Euler's. Joints at right angles and at zero are as
//! frequent as any: nothing that is divided by may vanish. Masses and lengths are often round numbers: what is equal by
//! chance must not be taken for the same.

#[path = "../../tests/references/dense.rs"]
#[allow(clippy::unwrap_used)]
mod dense;
mod models;

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::ops::Range;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{Arguments, evaluate};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use proptest::prelude::*;

const DAMPING: f64 = 0.1;
const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -9.81);

/// A body on its joint.
#[derive(Clone, Debug)]
struct Body {
    /// The body that holds it; none for the ground.
    parent: Option<usize>,
    slides: bool,
    axis: usize,
    /// From the frame of the parent to the joint.
    by: Vector3<f64>,
    mass: f64,
    inertia: Matrix3<f64>,
    centre: Vector3<f64>,
    position: f64,
    rate: f64,
    /// What a servo changes the rate by; none where the joint moves freely.
    servo: Option<f64>,
}

fn vector(of: &Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", of.x, of.y, of.z)
}

fn matrix(of: &Matrix3<f64>) -> String {
    let rows = [0, 1, 2].map(|row| vector(&of.row(row).transpose()));
    format!("[{}]", rows.join(", "))
}

/// The tree in the language.
fn text(tree: &[Body]) -> String {
    let mut text = String::from(
        "#[derivative]\nmodel Tree {\n    gravity [0.0, 0.0, -9.81];\n    1 ground[6] { Sf fixed { flow: 0.0 } }\n",
    );
    for (k, body) in tree.iter().enumerate() {
        let frame = match body.parent {
            Some(parent) => format!("frame{parent}"),
            None => "ground".to_owned(),
        };
        let word = if body.slides { "Prismatic" } else { "Revolute" };
        let axis = body.axis;
        let inertia = matrix(&body.inertia);
        let (by, centre, mass) = (vector(&body.by), vector(&body.centre), body.mass);
        write!(
            text,
            "    1 base{k}[6];
    1 frame{k}[6];
    offset{k}: Offset {{ by: {by} }} ({frame}, base{k});
    joint{k}: {word} {{ axis: {axis}, damping: {DAMPING:?} }} (base{k}, frame{k});
    body{k}: Body {{ mass: {mass:?}, inertia: {inertia}, centre: {centre} }} (frame{k});
    output force{k}[3] = body{k}.force.e;
    output turning{k}[3] = body{k}.spin.e;
"
        )
        .expect("a string grows");
        if let Some(acceleration) = body.servo {
            let rate = body.rate;
            writeln!(
                text,
                "    Sf servo{k} {{ flow: {rate:?} + {acceleration:?} * t }} -> joint{k}.rate;\n    output drive{k} = servo{k}.e;"
            )
            .expect("a string grows");
        }
    }
    text.push_str("    output held[6] = fixed.e;\n}\n");
    text
}

/// A joint in the axes of the world.
struct Joint {
    axis: Vector3<f64>,
    place: Vector3<f64>,
}

/// A frame in the axes of the world.
#[derive(Clone)]
struct Frame {
    axes: Matrix3<f64>,
    place: Vector3<f64>,
    omega: Vector3<f64>,
    alpha: Vector3<f64>,
    acceleration: Vector3<f64>,
}

impl Frame {
    fn ground() -> Self {
        Self {
            axes: Matrix3::identity(),
            place: Vector3::zeros(),
            omega: Vector3::zeros(),
            alpha: Vector3::zeros(),
            acceleration: Vector3::zeros(),
        }
    }

    /// The same body, at another point.
    fn at(&self, arm: &Vector3<f64>) -> Self {
        let centripetal = self.omega.cross(&self.omega.cross(arm));
        Self {
            place: self.place + arm,
            acceleration: self.acceleration + self.alpha.cross(arm) + centripetal,
            ..self.clone()
        }
    }

    /// The frame behind a joint whose own rate changes by `acceleration`.
    fn behind(&self, body: &Body, acceleration: f64) -> (Self, Joint) {
        let base = self.at(&(self.axes * body.by));
        let unit = Vector3::from_fn(|row, _| f64::from(u8::from(row == body.axis)));
        let axis = base.axes * unit;
        let place = base.place;
        let moved = axis * body.rate;
        let frame = if body.slides {
            let slid = base.at(&(axis * body.position));
            let own = axis * acceleration + 2.0 * slid.omega.cross(&moved);
            Self {
                acceleration: slid.acceleration + own,
                ..slid
            }
        } else {
            let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(unit), body.position);
            Self {
                axes: base.axes * turn.matrix(),
                omega: base.omega + moved,
                alpha: base.alpha + axis * acceleration + base.omega.cross(&moved),
                ..base
            }
        };
        (frame, Joint { axis, place })
    }
}

/// What moves a body, in the axes of the world.
struct Load {
    centre: Frame,
    inertia: Matrix3<f64>,
    force: Vector3<f64>,
    torque: Vector3<f64>,
}

impl Load {
    fn of(body: &Body, frame: &Frame) -> Self {
        let centre = frame.at(&(frame.axes * body.centre));
        let inertia = frame.axes * body.inertia * frame.axes.transpose();
        Self {
            force: body.mass * (centre.acceleration - GRAVITY),
            torque: inertia * centre.alpha + centre.omega.cross(&(inertia * centre.omega)),
            centre,
            inertia,
        }
    }
}

/// The frame that holds a body.
fn above(body: &Body, frames: &[Frame]) -> Frame {
    body.parent
        .map_or_else(Frame::ground, |parent| frames[parent].clone())
}

/// `M q̈ = τ − b` (Kane), with the partial velocities of the joints above each body: the accelerations of the joints, and
/// what servos add to `τ`.
fn motion(tree: &[Body]) -> (Vec<f64>, Vec<f64>) {
    let size = tree.len();
    let (mut frames, mut joints): (Vec<Frame>, Vec<Joint>) = (Vec::new(), Vec::new());
    let mut matrix = vec![vec![0.0; size]; size];
    let mut right: Vec<f64> = tree.iter().map(|body| -DAMPING * body.rate).collect();
    for (k, body) in tree.iter().enumerate() {
        let (frame, joint) = above(body, &frames).behind(body, 0.0);
        joints.push(joint);
        let Load {
            centre,
            inertia,
            force,
            torque,
        } = Load::of(body, &frame);
        let mut partials = Vec::new();
        let mut next = Some(k);
        while let Some(j) = next {
            let Joint { axis, place } = &joints[j];
            partials.push(if tree[j].slides {
                (j, *axis, Vector3::zeros())
            } else {
                (j, axis.cross(&(centre.place - place)), *axis)
            });
            next = tree[j].parent;
        }
        for (i, velocity, omega) in &partials {
            right[*i] -= velocity.dot(&force) + omega.dot(&torque);
            for (j, other, turned) in &partials {
                matrix[*i][*j] += body.mass * velocity.dot(other) + omega.dot(&(inertia * turned));
            }
        }
        frames.push(frame);
    }
    let free: Vec<usize> = (0..size).filter(|k| tree[*k].servo.is_none()).collect();
    let mut accelerations: Vec<f64> = tree.iter().map(|body| body.servo.unwrap_or(0.0)).collect();
    let needed = |accelerations: &[f64], k: usize| {
        let inertial = matrix[k].iter().zip(accelerations).map(|(m, a)| m * a);
        inertial.sum::<f64>() - right[k]
    };
    let rows = |k: &usize| free.iter().map(|j| matrix[*k][*j]).collect();
    let lacking = free.iter().map(|k| -needed(&accelerations, *k)).collect();
    let found = dense::solve(free.iter().map(rows).collect(), lacking);
    for (k, acceleration) in free.iter().zip(found) {
        accelerations[*k] = acceleration;
    }
    let drives = (0..size).map(|k| needed(&accelerations, k)).collect();
    (accelerations, drives)
}

/// The outputs of the tree, from the accelerations of its joints (Newton and Euler) and what servos add.
fn efforts(tree: &[Body], accelerations: &[f64], drives: &[f64]) -> Vec<f64> {
    let mut frames: Vec<Frame> = Vec::new();
    let mut outputs = Vec::new();
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for ((body, acceleration), drive) in tree.iter().zip(accelerations).zip(drives) {
        let (frame, _) = above(body, &frames).behind(body, *acceleration);
        let load = Load::of(body, &frame);
        force += load.force;
        moment += load.torque + load.centre.place.cross(&load.force);
        let inward = frame.axes.transpose();
        outputs.extend((inward * load.force).iter());
        outputs.extend((inward * (load.inertia * load.centre.alpha)).iter());
        outputs.extend(body.servo.map(|_| *drive));
        frames.push(frame);
    }
    outputs.extend(moment.iter());
    outputs.extend(force.iter());
    outputs
}

/// Accelerations and outputs by the program.
fn compiled(tree: &[Body], model: &Compiled) -> (Vec<f64>, Vec<f64>) {
    let names: Vec<&str> = model
        .states
        .iter()
        .map(|state| model.model.states[*state].variable.name.as_str())
        .collect();
    let mut state = vec![0.0; names.len()];
    let mut places = Vec::new();
    for (k, body) in tree.iter().enumerate() {
        let word = if body.slides { "travel" } else { "angle" };
        let find = |name: String| names.iter().position(|known| *known == name);
        // A position that nothing depends on is no state.
        if let Some(place) = find(format!("joint{k}.{word}")) {
            state[place] = body.position;
        }
        if body.servo.is_none() {
            let place = find(format!("joint{k}.rate.f")).expect("the rates are states");
            state[place] = body.rate;
            places.push(place);
        }
    }
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    let rates = evaluate(&model.program, Routines::DERIVATIVE, &arguments);
    let outputs = evaluate(&model.program, Routines::OUTPUT, &arguments);
    (
        places.into_iter().map(|place| rates[place]).collect(),
        outputs,
    )
}

/// So many bodies, with these shares of slides and of servos.
fn tree(sizes: Range<usize>, slides: f64, servos: f64) -> impl Strategy<Value = Vec<Body>> {
    let special = prop_oneof![Just(0.0), Just(FRAC_PI_2), Just(-FRAC_PI_2), -2.0..2.0_f64];
    let round = || prop::sample::select(&[0.0, 0.0, 1.0, -1.0, 0.5][..]);
    let place =
        || prop::array::uniform3(prop_oneof![round(), -1.0..1.0_f64]).prop_map(Vector3::from);
    let joint = (
        any::<usize>(),
        prop::bool::weighted(slides),
        0..3_usize,
        place(),
    );
    let positive = || prop_oneof![prop::sample::select(&[1.0, 2.0, 0.5][..]), 0.2..2.0_f64];
    let moments = prop_oneof![
        positive().prop_map(|equal| [equal; 3]),
        prop::array::uniform3(positive()),
    ];
    // Small beside the moments, so that the inertia is positive.
    let products = prop_oneof![
        Just([0.0; 3]),
        prop::array::uniform3(prop_oneof![Just(0.0), -0.08..0.08_f64]),
    ];
    let inertia = (moments, products)
        .prop_map(|([xx, yy, zz], [xy, yz, zx])| Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz));
    let centre = prop_oneof![4 => place(), 1 => Just(Vector3::zeros())];
    let body = (positive(), inertia, centre);
    let servo = prop::option::weighted(servos, -1.0..1.0_f64);
    let motion = (special, -1.0..1.0_f64, servo);
    prop::collection::vec((joint, body, motion), sizes).prop_map(|all| {
        let bodies = all.into_iter().enumerate();
        bodies
            .map(
                |(
                    k,
                    ((parent, slides, axis, by), (mass, inertia, centre), (position, rate, servo)),
                )| {
                    Body {
                        // Chains are more frequent than stars.
                        parent: [k.checked_sub(1), k.checked_sub(1), k.checked_sub(2)][parent % 3],
                        slides,
                        axis,
                        by,
                        mass,
                        inertia,
                        centre,
                        position,
                        rate,
                        servo,
                    }
                },
            )
            .collect()
    })
}

/// What a tree says of itself is what the equations of mechanics say.
fn assert_moves(tree: &[Body]) -> Result<(), TestCaseError> {
    let text = text(tree);
    let (rates, outputs) = compiled(tree, &models::compiled(&text));
    let (accelerations, drives) = motion(tree);
    let efforts = efforts(tree, &accelerations, &drives);
    let both = tree.iter().zip(accelerations);
    let free = both.filter_map(|(body, it)| body.servo.is_none().then_some(it));
    for (found, expected) in [(rates, free.collect()), (outputs, efforts)] {
        prop_assert_eq!(found.len(), expected.len());
        let size = expected.iter().fold(1.0_f64, |size, a| size.max(a.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            let error = (found - expected).abs() / size;
            prop_assert!(
                error < 1e-11,
                "{} {} {:e}\n{}",
                found,
                expected,
                error,
                text
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn trees_move_as_kane_says(tree in tree(1..7, 0.3, 0.1)) {
        assert_moves(&tree)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn servos_are_given_what_they_take(tree in tree(1..4, 0.5, 0.4)) {
        assert_moves(&tree)?;
    }
}
