//! What mechanisms are made of.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::pose::{Polynomial, Pose, turning};

/// Bodies on joints, and what else joins and moves them.
#[derive(Clone)]
pub(crate) struct Mechanism {
    pub(crate) is_planar: bool,
    pub(crate) gravity: Option<Vector3<f64>>,
    pub(crate) parts: Vec<Part>,
    pub(crate) closings: Vec<Closing>,
    pub(crate) line: Option<Line>,
    pub(crate) ratio: Option<Ratio>,
    pub(crate) style: Style,
}

/// What is accepted of causality, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    /// Whether strokes are chosen for each component of a bond.
    pub(crate) is_componentwise: bool,
    /// Whether derivative causality is accepted by each instance, and not of the model as a whole.
    pub(crate) is_by_instance: bool,
}

/// A joint, and the frame and body behind it.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// The part that holds it; none for the ground.
    pub(crate) parent: Option<usize>,
    pub(crate) offset: Vector3<f64>,
    pub(crate) tilt: Matrix3<f64>,
    pub(crate) joint: Joint,
    pub(crate) mass: Mass,
    pub(crate) load: Option<Load>,
    pub(crate) drive: Drive,
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) word: &'static str,
    pub(crate) arguments: String,
    pub(crate) families: Vec<Family>,
}

/// Coordinates of a joint that share their arguments.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    pub(crate) words: &'static Words,
    pub(crate) motion: Motion,
    /// At the start.
    pub(crate) initial: Vec<f64>,
    /// From there, where the mechanism is moved.
    pub(crate) moved: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    /// Stiffnesses and where springs are at rest.
    pub(crate) spring: Option<(Vec<f64>, Vec<f64>)>,
    pub(crate) damping: Vec<f64>,
    pub(crate) motor: Vec<f64>,
}

/// How a family is called: its arguments, and its states.
#[derive(Debug)]
pub(crate) struct Words {
    pub(crate) initial: &'static str,
    pub(crate) stiffness: &'static str,
    pub(crate) rest: &'static str,
    pub(crate) damping: &'static str,
    pub(crate) motor: &'static str,
    pub(crate) rate: &'static str,
    pub(crate) position: &'static str,
    pub(crate) spring: &'static str,
    /// Whether all coordinates have one stiffness, and one damping.
    pub(crate) is_even: bool,
}

/// Coordinates in the order in which they move.
#[derive(Clone, Debug)]
pub(crate) enum Motion {
    Turns(Vec<Vector3<f64>>),
    Slides(Vec<Vector3<f64>>),
    /// Free rotation, held as three angles about these axes; the coordinates change as the angular velocity in own axes.
    Attitude([usize; 3]),
}

#[derive(Clone, Debug)]
pub(crate) enum Mass {
    None,
    Point(f64),
    Body {
        mass: f64,
        inertia: Matrix3<f64>,
        centre: Vector3<f64>,
    },
}

/// A force on the origin of a frame, and a moment.
#[derive(Clone, Debug)]
pub(crate) struct Load {
    pub(crate) is_of_world: bool,
    pub(crate) force: Vector3<f64>,
    pub(crate) moment: Vector3<f64>,
}

/// What is at the rate of a hinge or slide.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Drive {
    None,
    /// Keeps the rate that it has, which changes by so much.
    Servo(f64),
    /// Has so much inertia of its own.
    Wheel(f64),
}

/// A frame that is held to another one, which has been fixed to a part where both met.
#[derive(Clone, Debug)]
pub(crate) struct Closing {
    pub(crate) word: Closed,
    pub(crate) from: usize,
    /// The part to which the other frame is fixed; none for the ground.
    pub(crate) to: Option<usize>,
    pub(crate) offset: Vector3<f64>,
    pub(crate) tilt: Matrix3<f64>,
    /// Of planar frames, and of a line.
    pub(crate) zero: f64,
    pub(crate) direction: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Closed {
    /// By its last joint.
    Ring,
    Spherical,
    Universal,
    Revolute,
    Fixed,
    Prismatic,
    Slot,
}

/// A spring, damper and actuator between a frame and a point of another part.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) from: usize,
    pub(crate) to: Option<usize>,
    pub(crate) offset: Vector3<f64>,
    pub(crate) stiffness: f64,
    pub(crate) rest: f64,
    pub(crate) damping: f64,
    pub(crate) force: f64,
}

/// `rate of to = ratio rate of from`, between first coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Ratio {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) ratio: f64,
}

impl Part {
    /// How many coordinates it has.
    pub(crate) fn size(&self) -> usize {
        self.joint.families.iter().map(|it| it.size()).sum()
    }

    /// The frame behind the joint, from that before it.
    fn behind(&self, before: &Pose, coordinates: &[Polynomial<f64>]) -> Pose {
        let mut pose = before.mounted(self.offset, self.tilt);
        let mut rest = coordinates;
        for family in &self.joint.families {
            let (own, behind) = rest.split_at(family.size());
            pose = family.behind(&pose, own);
            rest = behind;
        }
        pose
    }
}

impl Family {
    pub(crate) fn size(&self) -> usize {
        self.initial.len()
    }

    fn behind(&self, before: &Pose, coordinates: &[Polynomial<f64>]) -> Pose {
        let mut pose = before.clone();
        match &self.motion {
            Motion::Turns(axes) => {
                for (axis, [angle, rate, change]) in axes.iter().zip(coordinates) {
                    let start = Rotation3::new(axis * *angle).into_inner();
                    pose = pose.turned(&turning(start, axis * *rate, axis * *change));
                }
            }
            Motion::Slides(axes) => {
                for (axis, travel) in axes.iter().zip(coordinates) {
                    pose = pose.moved(&travel.map(|it| axis * it));
                }
            }
            Motion::Attitude(order) => {
                let [_, rate, change] =
                    [0, 1, 2].map(|k| Vector3::from_fn(|axis, _| coordinates[axis][k]));
                let angles = [0, 1, 2].map(|k| coordinates[k][0]);
                pose = pose.turned(&turning(attitude(*order, &angles), rate, change));
            }
        }
        pose
    }
}

/// The rotation by angles about axes that turn along.
pub(crate) fn attitude(order: [usize; 3], angles: &[f64]) -> Matrix3<f64> {
    let turns = order.iter().zip(angles);
    turns.fold(Matrix3::identity(), |turn, (axis, angle)| {
        turn * Rotation3::new(unit(*axis) * *angle).into_inner()
    })
}

pub(crate) fn unit(axis: usize) -> Vector3<f64> {
    Vector3::ith(axis, 1.0)
}

impl Mechanism {
    /// Where the coordinates of each part begin, and how many there are.
    pub(crate) fn places(&self) -> (Vec<usize>, usize) {
        let (mut places, mut count) = (Vec::new(), 0);
        for part in &self.parts {
            places.push(count);
            count += part.size();
        }
        (places, count)
    }

    pub(crate) fn families(&self) -> impl Iterator<Item = &Family> {
        self.parts.iter().flat_map(|part| &part.joint.families)
    }

    /// Positions at the start.
    pub(crate) fn start(&self) -> Vec<f64> {
        self.families().flat_map(|it| it.initial.clone()).collect()
    }

    /// Positions away from there.
    pub(crate) fn moved(&self) -> Vec<f64> {
        let moved = self.families().flat_map(|it| &it.moved);
        let both = self.start().into_iter().zip(moved);
        both.map(|(start, moved)| start + moved).collect()
    }

    /// The frames of all parts.
    pub(crate) fn poses(&self, coordinates: &[Polynomial<f64>]) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::new();
        let mut rest = coordinates;
        for part in &self.parts {
            let (own, behind) = rest.split_at(part.size());
            let before = part_or_ground(&poses, part.parent);
            poses.push(part.behind(&before, own));
            rest = behind;
        }
        poses
    }

    /// The acceleration of free fall.
    pub(crate) fn fall(&self) -> Vector3<f64> {
        self.gravity.unwrap_or_default()
    }

    /// Fixes the other frame of each closing, and says what is at its end, where both meet at the start.
    pub(crate) fn close(&mut self) {
        let start: Vec<Polynomial<f64>> = self.start().iter().map(|it| [*it, 0.0, 0.0]).collect();
        let poses = self.poses(&start);
        for closing in &mut self.closings {
            let (a, b) = (&poses[closing.from], part_or_ground(&poses, closing.to));
            let inward = b.axes[0].transpose();
            closing.offset = inward * (a.place[0] - b.place[0]);
            closing.tilt = inward * a.axes[0];
            closing.zero = closing.tilt[(1, 0)].atan2(closing.tilt[(0, 0)]);
            if self.is_planar {
                closing.tilt = Matrix3::identity();
                closing.zero = -closing.zero;
            }
        }
    }
}

/// The frame of a part, or the ground.
pub(crate) fn part_or_ground(poses: &[Pose], part: Option<usize>) -> Pose {
    part.map_or_else(Pose::ground, |part| poses[part].clone())
}

impl Closing {
    /// The other frame.
    pub(crate) fn other(&self, poses: &[Pose]) -> Pose {
        part_or_ground(poses, self.to).mounted(self.offset, self.tilt)
    }
}
