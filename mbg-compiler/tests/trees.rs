//! Random trees of rigid bodies on hinges and slides, of components of the library, against Kane's equations in the
//! axes of the world, and the efforts in them against Newton's and Euler's: on the ground, or on a body that flies. Joints
//! at right angles and at zero are as frequent as any: nothing that is divided by may vanish. Masses and lengths are often
//! round numbers: what is equal by chance must not be taken for the same.

#[path = "../../tests/references/dense.rs"]
#[allow(clippy::unwrap_used)]
mod dense;
mod models;

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::ops::Range;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{Arguments, evaluate};
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};
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
    /// Its axes, in numbers that are rounded.
    turn: Matrix3<f64>,
    /// A force on the frame's origin, in its axes.
    push: Vector3<f64>,
    /// Whether it is on the centre of mass instead.
    is_central: bool,
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

/// What holds the ground of a tree, or moves it.
const GROUND: &str = "    1 ground[6] { Sf fixed { flow: 0.0 } }\n";
const FLIGHT: &str = "    1 world[6] { Sf fixed { flow: 0.0 } }
    1 ground[6];
    float: Free { orientation: quaternion } (world, ground);
    hull: Body { mass: 1.3, inertia: [[0.9, 0.05, -0.02], [0.05, 0.7, 0.0], [-0.02, 0.0, 1.1]], centre: [0.1, 0.0, -0.2] } (ground);
    output pushed[3] = hull.force.e;
    output turned[3] = hull.spin.e;
";

/// The tree in the language.
fn text(base: &str, tree: &[Body]) -> String {
    let mut text = format!("#[derivative]\nmodel Tree {{\n    gravity [0.0, 0.0, -9.81];\n{base}");
    for (k, body) in tree.iter().enumerate() {
        let frame = match body.parent {
            Some(parent) => format!("frame{parent}"),
            None => "ground".to_owned(),
        };
        let word = if body.slides { "Prismatic" } else { "Revolute" };
        let axis = body.axis;
        let inertia = matrix(&body.inertia);
        let (by, centre, mass) = (vector(&body.by), vector(&body.centre), body.mass);
        let (turn, push) = (matrix(&body.turn), vector(&body.push));
        write!(
            text,
            "    1 base{k}[6];
    1 seat{k}[6];
    1 frame{k}[6];
    offset{k}: Offset {{ by: {by} }} ({frame}, base{k});
    turn{k}: Turn {{ by: {turn} }} (base{k}, seat{k});
    joint{k}: {word} {{ axis: {axis}, damping: {DAMPING:?} }} (seat{k}, frame{k});
    body{k}: Body {{ mass: {mass:?}, inertia: {inertia}, centre: {centre} }} (frame{k});
    output force{k}[3] = body{k}.force.e;
    output turning{k}[3] = body{k}.spin.e;
"
        )
        .expect("a string grows");
        if body.push != Vector3::zeros() {
            let place = if body.is_central {
                format!("body{k}.velocity")
            } else {
                format!("frame{k}[3..6]")
            };
            writeln!(text, "    Se push{k} {{ effort: {push} }} -> {place};")
                .expect("a string grows");
        }
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
        let mut base = self.at(&(self.axes * body.by));
        base.axes *= body.turn;
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
    /// On its centre from the frame, and what of it comes from the joint.
    force: Vector3<f64>,
    held: Vector3<f64>,
    /// About the centre, from the joint.
    held_torque: Vector3<f64>,
}

impl Body {
    /// The base in [`FLIGHT`].
    fn hull() -> Self {
        Self {
            parent: None,
            slides: false,
            axis: 0,
            by: Vector3::zeros(),
            turn: Matrix3::identity(),
            push: Vector3::zeros(),
            is_central: false,
            mass: 1.3,
            inertia: Matrix3::new(0.9, 0.05, -0.02, 0.05, 0.7, 0.0, -0.02, 0.0, 1.1),
            centre: Vector3::new(0.1, 0.0, -0.2),
            position: 0.0,
            rate: 0.0,
            servo: None,
        }
    }
}

impl Load {
    fn of(body: &Body, frame: &Frame) -> Self {
        let centre = frame.at(&(frame.axes * body.centre));
        let inertia = frame.axes * body.inertia * frame.axes.transpose();
        let push = frame.axes * body.push;
        let force = body.mass * (centre.acceleration - GRAVITY);
        let torque = inertia * centre.alpha + centre.omega.cross(&(inertia * centre.omega));
        let held = force - push;
        let (force, arm) = match body.is_central {
            true => (held, Vector3::zeros()),
            false => (force, frame.place - centre.place),
        };
        Self {
            held,
            held_torque: torque - arm.cross(&push),
            force,
            centre,
            inertia,
        }
    }
}

/// The frame that holds a body.
fn above(body: &Body, ground: &Frame, frames: &[Frame]) -> Frame {
    body.parent
        .map_or_else(|| ground.clone(), |parent| frames[parent].clone())
}

/// `M q̈ = τ − b` (Kane), with the partial velocities of the joints above each body: the accelerations of the joints, and
/// what servos add to `τ`.
fn motion(tree: &[Body]) -> (Vec<f64>, Vec<f64>) {
    let size = tree.len();
    let (mut frames, mut joints): (Vec<Frame>, Vec<Joint>) = (Vec::new(), Vec::new());
    let mut matrix = vec![vec![0.0; size]; size];
    let mut right: Vec<f64> = tree.iter().map(|body| -DAMPING * body.rate).collect();
    for (k, body) in tree.iter().enumerate() {
        let (frame, joint) = above(body, &Frame::ground(), &frames).behind(body, 0.0);
        joints.push(joint);
        let Load {
            centre,
            inertia,
            held,
            held_torque,
            ..
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
            right[*i] -= velocity.dot(&held) + omega.dot(&held_torque);
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
fn efforts(tree: &[Body], ground: &Frame, accelerations: &[f64], drives: &[f64]) -> Vec<f64> {
    let mut frames: Vec<Frame> = Vec::new();
    let mut outputs = Vec::new();
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for ((body, acceleration), drive) in tree.iter().zip(accelerations).zip(drives) {
        let (frame, _) = above(body, ground, &frames).behind(body, *acceleration);
        let load = Load::of(body, &frame);
        force += load.held;
        moment += load.held_torque + load.centre.place.cross(&load.held);
        outputs.extend(own_efforts(&frame, &load));
        outputs.extend(body.servo.map(|_| *drive));
        frames.push(frame);
    }
    outputs.extend(moment.iter());
    outputs.extend(force.iter());
    outputs
}

/// The efforts of a body in its axes: on its centre, and what changes its rate of turning.
fn own_efforts(frame: &Frame, load: &Load) -> Vec<f64> {
    let inward = frame.axes.transpose();
    let mut outputs: Vec<f64> = (inward * load.force).iter().copied().collect();
    outputs.extend((inward * (load.inertia * load.centre.alpha)).iter());
    outputs
}

/// A model at a state of a tree.
struct Compared {
    model: Compiled,
    state: Vec<f64>,
    /// Where the rates of joints without servos are.
    places: Vec<usize>,
}

impl Compared {
    fn of(text: &str, tree: &[Body]) -> Self {
        let model = models::compiled(text);
        let state = vec![0.0; model.states.len()];
        let mut compared = Self {
            model,
            state,
            places: Vec::new(),
        };
        for (k, body) in tree.iter().enumerate() {
            let word = if body.slides { "travel" } else { "angle" };
            compared.set(&format!("joint{k}.{word}"), body.position);
            if body.servo.is_none() {
                let place = compared.set(&format!("joint{k}.rate.f"), body.rate);
                compared.places.push(place.expect("the rates are states"));
            }
        }
        compared
    }

    /// Sets a state, if there is one: a position that nothing depends on is none.
    fn set(&mut self, name: &str, value: f64) -> Option<usize> {
        let mut states = self.model.states.iter();
        let place =
            states.position(|state| self.model.model.states[*state].variable.name == name)?;
        self.state[place] = value;
        Some(place)
    }

    fn evaluated(&self, routine: usize) -> Vec<f64> {
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &self.state,
            input: &[],
        };
        evaluate(&self.model.program, routine, &arguments)
    }
}

/// Axes in numbers that are rounded; mostly none.
fn axes() -> impl Strategy<Value = Matrix3<f64>> {
    let angle = || prop_oneof![Just(0.0), Just(1.5709), -3.0..3.0_f64];
    let turned = (angle(), angle(), angle())
        .prop_map(|(x, y, z)| Rotation3::from_euler_angles(x, y, z).into_inner());
    prop_oneof![2 => Just(Matrix3::identity()), 1 => turned]
}

fn flight() -> impl Strategy<Value = Flight> {
    let vector = || prop::array::uniform3(-1.0..1.0_f64).prop_map(Vector3::from);
    let quaternion = prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(|[x, y, z]| UnitQuaternion::from_quaternion(Quaternion::new(0.3, x, y, z)));
    (quaternion, vector(), vector()).prop_map(|(quaternion, velocity, spin)| Flight {
        quaternion,
        velocity,
        spin,
    })
}

/// So many bodies, with these shares of slides and of servos.
fn tree(sizes: Range<usize>, slides: f64, servos: f64) -> impl Strategy<Value = Vec<Body>> {
    let special = prop_oneof![Just(0.0), Just(FRAC_PI_2), Just(-FRAC_PI_2), -2.0..2.0_f64];
    let round = || prop::sample::select(&[0.0, 0.0, 1.0, -1.0, 0.5][..]);
    let place =
        || prop::array::uniform3(prop_oneof![round(), -1.0..1.0_f64]).prop_map(Vector3::from);
    let force = prop_oneof![2 => Just(Vector3::zeros()), 1 => place()];
    let joint = (
        any::<usize>(),
        prop::bool::weighted(slides),
        0..3_usize,
        (place(), axes(), force, any::<bool>()),
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
                    (
                        (parent, slides, axis, (by, turn, push, is_central)),
                        (mass, inertia, centre),
                        (position, rate, servo),
                    ),
                )| {
                    Body {
                        // Chains are more frequent than stars.
                        parent: [k.checked_sub(1), k.checked_sub(1), k.checked_sub(2)][parent % 3],
                        slides,
                        axis,
                        by,
                        turn,
                        push,
                        is_central,
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
    let text = text(GROUND, tree);
    let compared = Compared::of(&text, tree);
    let rates = compared.evaluated(Routines::DERIVATIVE);
    let rates: Vec<f64> = compared.places.iter().map(|place| rates[*place]).collect();
    let outputs = compared.evaluated(Routines::OUTPUT);
    let (accelerations, drives) = motion(tree);
    let efforts = efforts(tree, &Frame::ground(), &accelerations, &drives);
    let both = tree.iter().zip(accelerations);
    let free = both.filter_map(|(body, it)| body.servo.is_none().then_some(it));
    assert_same(&text, &rates, &free.collect::<Vec<_>>())?;
    assert_same(&text, &outputs, &efforts)
}

fn assert_same(text: &str, found: &[f64], expected: &[f64]) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.len(), expected.len());
    let error = largest_error(found, expected);
    prop_assert!(
        error < 1e-11,
        "{:?} {:?} {:e}\n{}",
        found,
        expected,
        error,
        text
    );
    Ok(())
}

/// Beside the largest value, or one.
fn largest_error(found: &[f64], expected: &[f64]) -> f64 {
    let size = expected.iter().fold(1.0_f64, |size, a| size.max(a.abs()));
    let errors = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    // Unlike `max`, this keeps what is not a number.
    errors.fold(0.0, |worst, it| if it <= worst { worst } else { it }) / size
}

/// Where a base that flies is turned to, its velocity in axes of the world, and its rate of turning in its own.
#[derive(Clone, Debug)]
struct Flight {
    quaternion: UnitQuaternion<f64>,
    velocity: Vector3<f64>,
    spin: Vector3<f64>,
}

impl Flight {
    /// The base, with the rates of both.
    fn frame(&self, velocity: Vector3<f64>, spin: Vector3<f64>) -> Frame {
        let axes = self.quaternion.to_rotation_matrix().into_inner();
        Frame {
            axes,
            place: Vector3::zeros(),
            omega: axes * self.spin,
            alpha: axes * spin,
            acceleration: velocity,
        }
    }
}

/// With the accelerations of the model, a tree and its base are held by nothing, and what a joint puts on the bodies behind
/// it along its axis is its damping.
fn assert_flies(flight: &Flight, tree: &[Body]) -> Result<(), TestCaseError> {
    let text = text(FLIGHT, tree);
    let mut compared = Compared::of(&text, tree);
    let [x, y, z, w]: [f64; 4] = flight.quaternion.coords.into();
    for (part, value) in [w, x, y, z].into_iter().enumerate() {
        compared.set(&format!("float.rotation.quaternion.{part}"), value);
    }
    let mut places = Vec::new();
    for (name, values) in [
        ("velocity.f", flight.velocity),
        ("rotation.rate.f", flight.spin),
    ] {
        for (axis, value) in ["x", "y", "z"].into_iter().zip(values.iter()) {
            let place = compared.set(&format!("float.{name}.{axis}"), *value);
            places.push(place.expect("the base moves"));
        }
    }
    let rates = compared.evaluated(Routines::DERIVATIVE);
    let part = |from: usize| Vector3::from_fn(|row, _| rates[places[from + row]]);
    let ground = flight.frame(part(0), part(3));
    let accelerations: Vec<f64> = compared.places.iter().map(|place| rates[*place]).collect();
    let mut expected = efforts(tree, &ground, &accelerations, &vec![0.0; tree.len()]);
    let held = expected.split_off(expected.len() - 6);
    let hull = Load::of(&Body::hull(), &ground);
    expected.splice(0..0, own_efforts(&ground, &hull));
    expected.extend([0.0; 6]);
    assert_same(&text, &compared.evaluated(Routines::OUTPUT), &expected)?;
    let moment = hull.held_torque + hull.centre.place.cross(&hull.held);
    let pushed: Vec<f64> = moment
        .iter()
        .chain(hull.held.iter())
        .map(|it| -it)
        .collect();
    assert_same(&text, &held, &pushed)?;
    let damping: Vec<f64> = tree.iter().map(|body| -DAMPING * body.rate).collect();
    assert_same(
        &text,
        &along_joints(tree, &ground, &accelerations),
        &damping,
    )
}

/// What the joints put on the bodies behind them along their axes.
fn along_joints(tree: &[Body], ground: &Frame, accelerations: &[f64]) -> Vec<f64> {
    let mut frames: Vec<Frame> = Vec::new();
    let mut joints: Vec<Joint> = Vec::new();
    let mut along = vec![0.0; tree.len()];
    for (k, (body, acceleration)) in tree.iter().zip(accelerations).enumerate() {
        let (frame, joint) = above(body, ground, &frames).behind(body, *acceleration);
        let load = Load::of(body, &frame);
        frames.push(frame);
        joints.push(joint);
        let mut next = Some(k);
        while let Some(j) = next {
            let Joint { axis, place } = &joints[j];
            let arm = load.centre.place - place;
            along[j] += match tree[j].slides {
                true => axis.dot(&load.held),
                false => axis.dot(&(load.held_torque + arm.cross(&load.held))),
            };
            next = tree[j].parent;
        }
    }
    along
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn trees_move_as_kane_says(tree in tree(1..7, 0.3, 0.1)) {
        assert_moves(&tree)?;
    }
}

/// A slide at such a place that a product of inertia is 0.006 of what is beside it, which nothing may be divided by.
#[test]
fn small_products_of_inertia_cost_no_digits() {
    let slide = Body {
        slides: true,
        axis: 1,
        by: Vector3::new(-0.291_453_309_329_025_5, 1.0, 0.0),
        mass: 1.757_479_001_670_863,
        inertia: Matrix3::identity(),
        centre: Vector3::zeros(),
        position: FRAC_PI_2,
        ..Body::hull()
    };
    let text = text(FLIGHT, std::slice::from_ref(&slide));
    let compared = Compared::of(&text, &[slide]);
    // All of it falls alike, and nothing is held.
    let forces = compared.evaluated(Routines::OUTPUT);
    let error = largest_error(&forces, &vec![0.0; forces.len()]);
    println!("largest force where there is none: {error:.1e}");
    assert!(error < 1e-12, "{error:e}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// What its mass is pushed by is no part of how a carrier moves, whose frame's origin is at rest.
    #[test]
    fn pushed_carriers_move_as_kane_says(mut tree in tree(2..4, 0.1, 0.1), push in 0..3_usize) {
        tree[0].push = Vector3::ith(push, 1.0);
        tree[0].is_central = true;
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn trees_that_fly_are_held_by_nothing(flight in flight(), mut tree in tree(1..5, 0.3, 0.1)) {
        for body in &mut tree {
            body.servo = None;
        }
        assert_flies(&flight, &tree)?;
    }
}
