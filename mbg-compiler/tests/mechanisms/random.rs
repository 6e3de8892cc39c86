//! Random mechanisms: chains more often than stars, in a plane and in space, with round numbers as often as any.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;

use super::parts::{
    Closed, Closing, Drive, Family, Joint, Line, Load, Mass, Mechanism, Motion, Part, Ratio, Style,
    Words, unit,
};
use super::reference::Reference;

const HINGE: Words = Words {
    initial: "initial",
    stiffness: "stiffness",
    rest: "rest",
    damping: "damping",
    motor: "torque",
    rate: "rate.f",
    position: "angle",
    spring: "spring.q",
    is_even: false,
};

static TURN: Words = HINGE;

static SLIDE: Words = Words {
    motor: "force",
    position: "travel",
    ..HINGE
};

static TURNING: Words = Words {
    initial: "initial_angle",
    stiffness: "turn_stiffness",
    rest: "rest_angle",
    damping: "turn_damping",
    rate: "turning.f",
    spring: "turn_spring.q",
    ..HINGE
};

static SLIDING: Words = Words {
    initial: "initial_travel",
    stiffness: "slide_stiffness",
    rest: "rest_travel",
    damping: "slide_damping",
    motor: "force",
    rate: "sliding.f",
    position: "travel",
    spring: "slide_spring.q",
    ..HINGE
};

static GIMBAL: Words = Words {
    rate: "rotation.gimbal.rate.f",
    position: "rotation.gimbal.angle",
    spring: "rotation.gimbal.spring.q",
    is_even: true,
    ..HINGE
};

static ATTITUDE: Words = Words {
    rate: "rotation.rate.f",
    is_even: true,
    ..HINGE
};

static FLIGHT: Words = Words {
    initial: "initial_position",
    stiffness: "",
    rest: "",
    damping: "",
    motor: "force",
    rate: "velocity.f",
    position: "position",
    spring: "",
    is_even: false,
};

/// Numbers for what a joint has, in order.
#[derive(Clone, Debug)]
struct Numbers {
    kind: usize,
    /// Axes in an order; the third of angles may be the first.
    axes: [usize; 3],
    is_proper: bool,
    direction: f64,
    initial: [f64; 6],
    moved: [f64; 6],
    rate: [f64; 6],
    rest: [f64; 6],
    springs: [bool; 2],
    damping: f64,
    motor: f64,
}

impl Numbers {
    fn joint(&self, is_planar: bool) -> Joint {
        let [first, second, third] = self.axes;
        if is_planar {
            let direction = self.direction;
            let (sine, cosine) = direction.sin_cos();
            let along = Vector3::new(cosine, sine, 0.0);
            return match self.kind % 3 {
                0 => Joint {
                    word: "PlanarPrismatic",
                    arguments: format!("direction: {direction:?}"),
                    families: vec![self.family(0, &SLIDE, Motion::Slides(vec![along]))],
                },
                _ => Joint {
                    word: "PlanarRevolute",
                    arguments: String::new(),
                    families: vec![self.family(0, &TURN, Motion::Turns(vec![unit(2)]))],
                },
            };
        }
        let axis = format!("axis: {first}");
        let turns = |of: &[usize]| Motion::Turns(of.iter().map(|it| unit(*it)).collect());
        let slides = |of: &[usize]| Motion::Slides(of.iter().map(|it| unit(*it)).collect());
        let (word, arguments, families) = match self.kind {
            0..4 => (
                "Revolute",
                axis,
                vec![self.family(0, &TURN, turns(&[first]))],
            ),
            4..6 => (
                "Prismatic",
                axis,
                vec![self.family(0, &SLIDE, slides(&[first]))],
            ),
            6 => {
                let slide = self.family(0, &SLIDING, slides(&[first]));
                let turn = self.family(1, &TURNING, turns(&[first]));
                ("Cylindrical", axis, vec![slide, turn])
            }
            7 => {
                let turn = self.family(0, &TURN, turns(&[first, second]));
                let axes = format!("first: {first}, second: {second}");
                ("Universal", axes, vec![turn])
            }
            8 => {
                let slide = [(first + 1) % 3, (first + 2) % 3];
                let slide = self.family(0, &SLIDING, slides(&slide));
                let turn = self.family(2, &TURNING, turns(&[first]));
                ("Planar", axis, vec![slide, turn])
            }
            kind => {
                let third = if self.is_proper { first } else { third };
                let order = [first, second, third];
                let word = ["angles", "quaternion", "matrix"][kind % 3];
                let arguments = format!(
                    "orientation: {word}, first: {first}, second: {second}, third: {third}"
                );
                let is_free = kind % 2 == 0;
                let begin = if is_free { 3 } else { 0 };
                let turn = match word {
                    "angles" => self.family(begin, &GIMBAL, turns(&order)),
                    _ => self.family(begin, &ATTITUDE, Motion::Attitude(order)),
                };
                match is_free {
                    true => {
                        let flight = self.family(0, &FLIGHT, slides(&[0, 1, 2]));
                        ("Free", arguments, vec![flight, turn])
                    }
                    false => ("Spherical", arguments, vec![turn]),
                }
            }
        };
        Joint {
            word,
            arguments,
            families,
        }
    }

    fn family(&self, begin: usize, words: &'static Words, motion: Motion) -> Family {
        let count = match &motion {
            Motion::Turns(axes) | Motion::Slides(axes) => axes.len(),
            Motion::Attitude(_) => 3,
        };
        let own = begin..begin + count;
        let is_sprung = self.springs[usize::from(begin > 0)] && !words.stiffness.is_empty();
        let different = |from: f64, k: usize| match words.is_even {
            true => from,
            false => from + k as f64,
        };
        let damping = |k| {
            if words.damping.is_empty() {
                0.0
            } else {
                different(self.damping, k)
            }
        };
        Family {
            words,
            initial: self.initial[own.clone()].to_vec(),
            moved: self.moved[own.clone()].iter().map(|it| 0.4 * it).collect(),
            rate: self.rate[own.clone()].to_vec(),
            spring: is_sprung.then(|| {
                let stiffness = (0..count).map(|k| different(2.0, k)).collect();
                (stiffness, self.rest[own.clone()].to_vec())
            }),
            damping: (0..count).map(damping).collect(),
            motor: (0..count).map(|k| self.motor * (k + 1) as f64).collect(),
            motion,
        }
    }
}

/// What closings, a line and a ratio are made of.
#[derive(Clone, Debug)]
struct Links {
    words: Vec<(usize, usize, usize)>,
    direction: f64,
    last: Numbers,
    line: Option<(usize, usize, Vector3<f64>, [f64; 4])>,
    ratio: Option<(usize, usize, f64)>,
}

fn round() -> impl Strategy<Value = f64> {
    let round = prop::sample::select(&[0.0, 0.0, 1.0, -1.0, 0.5][..]);
    prop_oneof![round, -1.0..1.0_f64]
}

fn place() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(round()).prop_map(Vector3::from)
}

fn tilt() -> impl Strategy<Value = Matrix3<f64>> {
    let angle = || prop_oneof![Just(0.0), Just(FRAC_PI_2), -3.0..3.0_f64];
    let turned = (angle(), angle(), angle())
        .prop_map(|(x, y, z)| Rotation3::from_euler_angles(x, y, z).into_inner());
    prop_oneof![2 => Just(Matrix3::identity()), 1 => turned]
}

fn numbers() -> impl Strategy<Value = Numbers> {
    let angle = prop_oneof![1 => Just(0.0), 1 => prop::sample::select(&[FRAC_PI_2, -FRAC_PI_2][..]), 4 => -2.0..2.0_f64];
    let six = || prop::array::uniform6(-1.0..1.0_f64);
    let axes = (0..6_usize).prop_map(|it| {
        let (first, step) = (it % 3, 1 + it / 3);
        [first, (first + step) % 3, (first + 2 * step) % 3]
    });
    let flags = (
        any::<bool>(),
        prop::array::uniform2(prop::bool::weighted(0.3)),
    );
    (
        (0..15_usize, axes, flags),
        (prop::array::uniform6(angle), six(), six(), six()),
        (-3.0..3.0_f64, prop_oneof![Just(0.0), Just(0.3)], round()),
    )
        .prop_map(
            |(
                (kind, axes, (is_proper, springs)),
                (initial, moved, rate, rest),
                (direction, damping, motor),
            )| {
                Numbers {
                    kind,
                    axes,
                    is_proper,
                    direction,
                    initial,
                    moved,
                    rate,
                    rest,
                    springs,
                    damping,
                    motor,
                }
            },
        )
}

fn mass() -> impl Strategy<Value = Mass> {
    let positive = || prop_oneof![prop::sample::select(&[1.0, 2.0, 0.5][..]), 0.5..2.0_f64];
    let moments = prop_oneof![
        positive().prop_map(|equal| [equal; 3]),
        prop::array::uniform3(1.0..1.6_f64),
    ];
    let products = prop_oneof![Just([0.0; 3]), prop::array::uniform3(-0.1..0.1_f64)];
    let inertia = (moments, products)
        .prop_map(|([xx, yy, zz], [xy, yz, zx])| Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz));
    let body = (positive(), inertia, place()).prop_map(|(mass, inertia, centre)| Mass::Body {
        mass,
        inertia,
        centre,
    });
    prop_oneof![5 => body, 1 => positive().prop_map(Mass::Point), 1 => Just(Mass::None)]
}

/// The part with this number, but for its joint, and one more than the number of its parent.
fn part(number: usize) -> impl Strategy<Value = (usize, Numbers, Part)> {
    let parent = prop_oneof![3 => Just(number), 1 => 0..=number];
    let load = (any::<bool>(), place(), place()).prop_map(|(is_of_world, force, moment)| Load {
        is_of_world,
        force,
        moment,
    });
    let drive = prop_oneof![
        6 => Just(Drive::None),
        1 => (-1.0..1.0_f64).prop_map(Drive::Servo),
        1 => (0.2..1.0_f64).prop_map(Drive::Wheel),
    ];
    let load = prop::option::weighted(0.2, load);
    (parent, numbers(), place(), tilt(), mass(), load, drive).prop_map(
        |(parent, numbers, offset, tilt, mass, load, drive)| {
            let part = Part {
                parent: None,
                offset,
                tilt,
                joint: numbers.joint(false),
                mass,
                load,
                drive,
            };
            (parent, numbers, part)
        },
    )
}

fn links() -> impl Strategy<Value = Links> {
    let word = (0..6_usize, 0..6_usize, 0..6_usize);
    let words = prop_oneof![
        2 => Just(Vec::new()),
        3 => prop::collection::vec(word.clone(), 1),
        1 => prop::collection::vec(word, 2),
    ];
    let values = [0.5..3.0_f64, 0.2..1.0_f64, 0.1..0.5_f64, -1.0..1.0_f64];
    let line = (0..6_usize, 0..6_usize, place(), values);
    let ratio = (
        0..6_usize,
        0..6_usize,
        prop_oneof![Just(-1.0), 0.5..2.0_f64],
    );
    (
        words,
        -3.0..3.0_f64,
        numbers(),
        prop::option::weighted(0.2, line),
        prop::option::weighted(0.15, ratio),
    )
        .prop_map(|(words, direction, last, line, ratio)| Links {
            words,
            direction,
            last,
            line,
            ratio,
        })
}

/// Mechanisms, and whether they are moved away from where they start, which opens loops.
pub(crate) fn mechanism() -> impl Strategy<Value = (Mechanism, bool)> {
    (raw(), any::<bool>()).prop_map(|(raw, is_moved)| raw.mechanism(is_moved))
}

/// Mechanisms with a ring of joints at right angles, where some of its rates are often at a dead centre.
pub(crate) fn ring() -> impl Strategy<Value = Mechanism> {
    raw().prop_map(|raw| raw.at_right_angles().mechanism(false).0)
}

/// What a mechanism is made of.
#[derive(Clone, Debug)]
struct Raw {
    parts: Vec<(usize, Numbers, Part)>,
    links: Links,
    gravity: Option<Vector3<f64>>,
    is_planar: bool,
    style: Style,
}

fn raw() -> impl Strategy<Value = Raw> {
    let parts = (1..5_usize).prop_flat_map(|count| (0..count).map(part).collect::<Vec<_>>());
    let gravity = prop_oneof![
        Just(None),
        Just(Some(Vector3::new(0.0, 0.0, -9.81))),
        Just(Some(Vector3::new(1.0, -9.0, 2.0))),
    ];
    let style =
        (any::<bool>(), any::<bool>()).prop_map(|(is_componentwise, is_by_instance)| Style {
            is_componentwise,
            is_by_instance,
        });
    let is_planar = prop::bool::weighted(0.3);
    (parts, links(), gravity, is_planar, style).prop_map(
        |(parts, links, gravity, is_planar, style)| Raw {
            parts,
            links,
            gravity,
            is_planar,
            style,
        },
    )
}

impl Raw {
    fn mechanism(self, is_moved: bool) -> (Mechanism, bool) {
        let mut mechanism = Mechanism {
            is_planar: self.is_planar,
            gravity: self.gravity,
            parts: Vec::new(),
            closings: Vec::new(),
            line: None,
            ratio: None,
            style: self.style,
        };
        for (parent, numbers, part) in self.parts {
            mechanism.add(parent.checked_sub(1), &numbers, part);
        }
        mechanism.link(&self.links);
        let is_moved = mechanism.settle(is_moved);
        (mechanism, is_moved)
    }

    fn at_right_angles(mut self) -> Self {
        for (_, numbers, part) in &mut self.parts {
            numbers.turn_to_right_angles();
            part.offset = part.offset.map(|it| (2.0 * it).round() / 2.0);
            part.drive = Drive::None;
        }
        self.links.last.turn_to_right_angles();
        let (_, from, to) = self.links.words.pop().unwrap_or_default();
        self.links.words = vec![(0, from, to)];
        self
    }
}

impl Numbers {
    fn turn_to_right_angles(&mut self) {
        let whole = |angle: f64| (angle / FRAC_PI_2).round() * FRAC_PI_2;
        self.initial = self.initial.map(whole);
        self.direction = whole(self.direction);
    }
}

fn flat(of: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(of.x, of.y, 0.0)
}

impl Mechanism {
    fn add(&mut self, parent: Option<usize>, numbers: &Numbers, mut part: Part) {
        part.parent = parent;
        part.joint = numbers.joint(self.is_planar);
        if part.joint.families[0].size() > 1 {
            part.drive = Drive::None;
        }
        if self.is_planar {
            part.offset = flat(part.offset);
            part.tilt = Matrix3::identity();
            if let Mass::Body {
                inertia, centre, ..
            } = &mut part.mass
            {
                *inertia = Matrix3::from_diagonal_element(inertia[(2, 2)]);
                *centre = flat(*centre);
            }
            if let Some(load) = &mut part.load {
                load.force = flat(load.force);
                load.moment = Vector3::new(0.0, 0.0, load.moment.z);
            }
        }
        self.parts.push(part);
    }

    fn link(&mut self, links: &Links) {
        if self.is_planar {
            self.gravity = self.gravity.map(flat);
        }
        let count = self.parts.len();
        let other =
            |from: usize, to: usize| Some(to % (count + 1)).filter(|it| *it != from && *it < count);
        for (word, from, to) in &links.words {
            let from = (count - 1) - from % 2 % count;
            self.closings.push(Closing {
                word: self.word(*word),
                from,
                to: other(from, *to),
                offset: Vector3::zeros(),
                tilt: Matrix3::identity(),
                zero: 0.0,
                direction: links.direction,
            });
        }
        let rings = self
            .closings
            .iter_mut()
            .filter(|it| it.word == Closed::Ring);
        for (number, ring) in rings.enumerate() {
            let part = Part {
                parent: Some(ring.from),
                offset: Vector3::zeros(),
                tilt: Matrix3::identity(),
                joint: links.last.joint(self.is_planar),
                mass: Mass::None,
                load: None,
                drive: Drive::None,
            };
            self.parts.push(part);
            ring.from = count + number;
        }
        if let Some((from, to, offset, [stiffness, rest, damping, force])) = links.line {
            let from = from % count;
            let offset = if self.is_planar { flat(offset) } else { offset };
            self.line = Some(Line {
                from,
                to: other(from, to),
                offset,
                stiffness,
                rest,
                damping,
                force,
            });
        }
        if let Some((from, to, ratio)) = links.ratio {
            let (from, to) = (from % count, to % count);
            let is_single = |part: usize| {
                let part = &self.parts[part];
                part.joint.families[0].size() == 1 && !matches!(part.drive, Drive::Servo(_))
            };
            if from != to && is_single(from) && is_single(to) {
                self.ratio = Some(Ratio { from, to, ratio });
            }
        }
        self.close();
    }

    fn word(&self, number: usize) -> Closed {
        let words = match self.is_planar {
            true => [
                Closed::Ring,
                Closed::Revolute,
                Closed::Fixed,
                Closed::Prismatic,
                Closed::Slot,
            ],
            false => [
                Closed::Ring,
                Closed::Spherical,
                Closed::Universal,
                Closed::Revolute,
                Closed::Fixed,
            ],
        };
        words[number % words.len()]
    }

    /// Closes loops by cuts where no rates follow from others, as where all hinges are in one plane. Whether it may be moved,
    /// which opens a ring.
    fn settle(&mut self, is_moved: bool) -> bool {
        let has_ring = |closings: &[Closing]| closings.iter().any(|it| it.word == Closed::Ring);
        if has_ring(&self.closings) && !Reference::is_reducible(self) {
            self.cut();
        }
        is_moved && !has_ring(&self.closings)
    }

    /// Leaves the last joint of rings away: their frames are held by cuts.
    fn cut(&mut self) {
        let rings = self
            .closings
            .iter_mut()
            .filter(|it| it.word == Closed::Ring);
        let mut count = self.parts.len();
        for ring in rings {
            ring.word = Closed::Revolute;
            ring.from = self.parts[ring.from].parent.unwrap_or(0);
            count -= 1;
        }
        self.parts.truncate(count);
        self.close();
    }
}
