//! Random trees of rigid bodies on hinges and slides, of components of the library, against Kane's equations in the
//! axes of the world. Joints at right angles and at zero are as frequent as any: nothing that is divided by may vanish.

#[path = "../../tests/references/dense.rs"]
#[allow(clippy::unwrap_used)]
mod dense;
mod models;

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

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
    inertia: Vector3<f64>,
    centre: Vector3<f64>,
    position: f64,
    rate: f64,
}

fn vector(of: &Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", of.x, of.y, of.z)
}

/// The tree in the language.
fn text(tree: &[Body]) -> String {
    let mut text = String::from(
        "#[derivative]\nmodel Tree {\n    gravity [0.0, 0.0, -9.81];\n    1 ground[6] { Sf fixed { flow: 0.0 } }\n",
    );
    // Gravity in the axes of each frame.
    let mut down: Vec<String> = Vec::new();
    for (k, body) in tree.iter().enumerate() {
        let (frame, above) = match body.parent {
            Some(parent) => (format!("frame{parent}"), down[parent].clone()),
            None => ("ground".to_owned(), "gravity".to_owned()),
        };
        let (word, axis, own) = match body.slides {
            true => ("Prismatic", format!("axis: {}", body.axis), above),
            false => (
                "Revolute",
                format!("axis: {}, gravity_a: {above}", body.axis),
                format!("joint{k}.gravity_b"),
            ),
        };
        let inertia = vector(&body.inertia)
            .replace('[', "diag(")
            .replace(']', ")");
        let (by, centre, mass) = (vector(&body.by), vector(&body.centre), body.mass);
        write!(
            text,
            "    1 base{k}[6];
    1 frame{k}[6];
    offset{k}: Offset {{ by: {by} }} ({frame}, base{k});
    joint{k}: {word} {{ {axis}, damping: {DAMPING:?} }} (base{k}, frame{k});
    body{k}: Body {{ mass: {mass:?}, inertia: {inertia}, centre: {centre}, gravity_at: {own} }} (frame{k});
"
        )
        .expect("a string grows");
        down.push(own);
    }
    text.push_str("}\n");
    text
}

/// A joint in the axes of the world.
struct Joint {
    axis: Vector3<f64>,
    place: Vector3<f64>,
}

/// A frame in the axes of the world, with the accelerations at `q̈ = 0`.
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

    /// The frame behind a joint.
    fn behind(&self, body: &Body) -> (Self, Joint) {
        let base = self.at(&(self.axes * body.by));
        let unit = Vector3::from_fn(|row, _| f64::from(u8::from(row == body.axis)));
        let axis = base.axes * unit;
        let place = base.place;
        let moved = axis * body.rate;
        let frame = if body.slides {
            let slid = base.at(&(axis * body.position));
            let acceleration = slid.acceleration + 2.0 * slid.omega.cross(&moved);
            Self {
                acceleration,
                ..slid
            }
        } else {
            let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(unit), body.position);
            Self {
                axes: base.axes * turn.matrix(),
                omega: base.omega + moved,
                alpha: base.alpha + base.omega.cross(&moved),
                ..base
            }
        };
        (frame, Joint { axis, place })
    }
}

/// `M q̈ = τ − b` (Kane), with the partial velocities of the joints above each body.
fn accelerations(tree: &[Body]) -> Vec<f64> {
    let size = tree.len();
    let (mut frames, mut joints): (Vec<Frame>, Vec<Joint>) = (Vec::new(), Vec::new());
    let mut matrix = vec![vec![0.0; size]; size];
    let mut right: Vec<f64> = tree.iter().map(|body| -DAMPING * body.rate).collect();
    for (k, body) in tree.iter().enumerate() {
        let above = body
            .parent
            .map_or_else(Frame::ground, |parent| frames[parent].clone());
        let (frame, joint) = above.behind(body);
        joints.push(joint);
        let centre = frame.at(&(frame.axes * body.centre));
        let inertia = frame.axes * Matrix3::from_diagonal(&body.inertia) * frame.axes.transpose();
        let force = body.mass * (centre.acceleration - GRAVITY);
        let torque = inertia * centre.alpha + centre.omega.cross(&(inertia * centre.omega));
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
    dense::solve(matrix, right)
}

/// Accelerations by the program.
fn compiled(tree: &[Body], model: &Compiled) -> Vec<f64> {
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
        let place = find(format!("joint{k}.rate.f")).expect("the rates are states");
        state[place] = body.rate;
        places.push(place);
    }
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    let rates = evaluate(&model.program, Routines::DERIVATIVE, &arguments);
    places.into_iter().map(|place| rates[place]).collect()
}

fn tree() -> impl Strategy<Value = Vec<Body>> {
    let special = prop_oneof![Just(0.0), Just(FRAC_PI_2), Just(-FRAC_PI_2), -2.0..2.0_f64];
    let place = || {
        prop::array::uniform3(prop_oneof![Just(0.0), Just(0.0), -1.0..1.0_f64])
            .prop_map(Vector3::from)
    };
    let joint = (
        any::<usize>(),
        prop::bool::weighted(0.3),
        0..3_usize,
        place(),
    );
    let body = (
        0.5..2.0_f64,
        prop::array::uniform3(0.2..1.0_f64).prop_map(Vector3::from),
        place(),
    );
    let motion = (special, -1.0..1.0_f64);
    prop::collection::vec((joint, body, motion), 1..7).prop_map(|all| {
        let bodies = all.into_iter().enumerate();
        bodies
            .map(
                |(k, ((parent, slides, axis, by), (mass, inertia, centre), (position, rate)))| {
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
                    }
                },
            )
            .collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn trees_move_as_kane_says(tree in tree()) {
        let model = models::compiled(&text(&tree));
        let (found, expected) = (compiled(&tree, &model), accelerations(&tree));
        let size = expected.iter().fold(1.0_f64, |size, a| size.max(a.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            let error = (found - expected).abs() / size;
            prop_assert!(error < 1e-11, "{} {} {:e}\n{}", found, expected, error, text(&tree));
        }
    }
}
