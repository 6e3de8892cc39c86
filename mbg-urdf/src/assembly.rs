//! Links put together to rigid bodies, and how the joints between them stand.
//!
//! A hinge leaves open where along its axis its body's frame is, where that is turned to about it, and at which angle. They
//! are chosen so that from one hinge to the next it is one turn about a line across both axes, as Denavit and Hartenberg
//! (1955) have it, instead of three, and no way along the first where fewer lengths are left so.

use crate::geometry::{
    Body, IDENTITY, LENGTH, Matrix, Pose, Vector, about, across, aligned, between, is_permutation,
    measured, plus, product, transposed,
};
use crate::robot::{Joint, Motion, Robot};

/// A link, as part of the rigid body to which fixed joints make it.
pub(crate) struct Part {
    /// The number of that body.
    pub(crate) rigid: usize,
    /// The link's frame in that of the body.
    pub(crate) pose: Pose,
}

/// A joint that moves, as it stands on a rigid body. The joint with number k carries the body with number k + 1; the base
/// is number 0.
#[derive(Clone, Copy)]
pub(crate) struct Seat<'a> {
    pub(crate) joint: &'a Joint,
    /// The rigid body that it stands on.
    pub(crate) above: usize,
    /// Its frame in that of the body.
    pub(crate) pose: Pose,
    /// The number of the coordinate axis about or along which it moves.
    pub(crate) axis: usize,
    /// The angle at which the frame that it carries is its own.
    pub(crate) zero: f64,
}

/// A robot of rigid bodies.
pub(crate) struct Assembly<'a> {
    /// Of each link; none of a link that nothing holds.
    pub(crate) parts: Vec<Option<Part>>,
    /// Of each rigid body; none that has neither mass nor inertia.
    pub(crate) bodies: Vec<Option<Body>>,
    pub(crate) seats: Vec<Seat<'a>>,
}

impl<'a> Assembly<'a> {
    pub(crate) fn new(robot: &'a Robot) -> Self {
        let mut assembly = Self {
            parts: robot.links.iter().map(|_| None).collect(),
            bodies: vec![None],
            seats: Vec::new(),
        };
        assembly.hold(robot, robot.root, 0, Pose::NONE);
        for joint in &robot.joints {
            assembly.add(robot, joint);
        }
        for rigid in 0..assembly.bodies.len() {
            assembly.turn(rigid);
        }
        for rigid in (0..assembly.bodies.len()).rev() {
            assembly.shift(rigid);
        }
        for seat in &mut assembly.seats {
            seat.pose.place = measured(&seat.pose.place);
        }
        for body in assembly.bodies.iter_mut().flatten() {
            body.centre = measured(&body.centre);
        }
        assembly
    }

    fn add(&mut self, robot: &Robot, joint: &'a Joint) {
        // A joint comes after the one that holds its parent.
        let Some(parent) = &self.parts[joint.parent] else {
            return;
        };
        let (above, at) = (parent.rigid, parent.pose.of(&joint.origin));
        if joint.motion == Motion::Fixed {
            self.hold(robot, joint.child, above, at);
            return;
        }
        let (axis, turn) = aligned(&joint.axis);
        self.seats.push(Seat {
            joint,
            above,
            pose: at.of(&turned(turn)),
            axis,
            zero: 0.0,
        });
        let rigid = self.bodies.len();
        self.bodies.push(None);
        self.hold(robot, joint.child, rigid, turned(transposed(&turn)));
    }

    /// Makes a link part of a rigid body.
    fn hold(&mut self, robot: &Robot, link: usize, rigid: usize, pose: Pose) {
        if let Some(body) = robot.links[link].body {
            let body = body.seen(&pose);
            let whole = &mut self.bodies[rigid];
            *whole = Some(whole.map_or(body, |whole| whole.with(&body)));
        }
        self.parts[link] = Some(Part { rigid, pose });
    }

    /// The number of the axis of the hinge that carries a body, if it is one that does.
    fn hinge(&self, rigid: usize) -> Option<usize> {
        let seat = &self.seats[rigid.checked_sub(1)?];
        (seat.joint.motion == Motion::Turn).then_some(seat.axis)
    }

    fn on(&self, rigid: usize) -> impl Iterator<Item = &Seat<'a>> + Clone {
        self.seats.iter().filter(move |it| it.above == rigid)
    }

    /// Turns the frame of a body that a hinge carries so that the first joint on it needs no turn about the hinge's axis, and
    /// counts the angles of hinges so that they need none about their own. What stands aligned stays so.
    fn turn(&mut self, rigid: usize) {
        let axis = self.hinge(rigid);
        if let Some((axis, angle)) = axis.and_then(|it| Some((it, self.before_first(rigid, it)?))) {
            self.seats[rigid - 1].zero -= angle;
            self.see_from(rigid, &turned(about(axis, -angle)));
        }
        for seat in self.seats.iter_mut().filter(|it| it.above == rigid) {
            seat.count_from_zero(axis);
        }
    }

    /// The angle about an axis by which the first joint on a body is turned, unless one stands aligned there.
    fn before_first(&self, rigid: usize, axis: usize) -> Option<f64> {
        let first = self.on(rigid).next()?;
        let aligned = self.on(rigid).any(|it| is_permutation(&it.pose.turn));
        let [angle, ..] = between(&first.pose.turn, axis, first.axis);
        (!aligned).then_some(angle)
    }

    /// Moves the frame of a body that a hinge carries along the hinge's axis to where most components of places are zero.
    fn shift(&mut self, rigid: usize) {
        let Some(axis) = self.hinge(rigid) else {
            return;
        };
        let Pose { place, turn } = self.seats[rigid - 1].pose;
        let along = [0, 1, 2].map(|it| turn[it][axis]);
        let moved = |by: f64| plus(&place, &along.map(|it| it * by));
        let components = |place: &Vector| place.iter().filter(|it| it.abs() >= LENGTH).count();
        let left = |by: f64| {
            let others = self.on(rigid).map(|it| {
                let mut place = it.pose.place;
                place[axis] -= by;
                components(&place)
            });
            components(&moved(by)) + others.sum::<usize>()
        };
        let others = self.on(rigid).map(|it| it.pose.place[axis]);
        let Some(by) = others.min_by_key(|by| left(*by)) else {
            return;
        };
        if left(by) < left(0.0) {
            let mut back = [0.0; 3];
            back[axis] = -by;
            self.seats[rigid - 1].pose.place = moved(by);
            self.see_from(rigid, &placed(back));
        }
    }

    /// Gives a body another frame, in which its present one has this pose.
    fn see_from(&mut self, rigid: usize, pose: &Pose) {
        let body = &mut self.bodies[rigid];
        *body = body.map(|it| it.seen(pose));
        for part in self
            .parts
            .iter_mut()
            .flatten()
            .filter(|it| it.rigid == rigid)
        {
            part.pose = pose.of(&part.pose);
        }
        for seat in self.seats.iter_mut().filter(|it| it.above == rigid) {
            seat.pose = pose.of(&seat.pose);
        }
    }
}

impl Seat<'_> {
    /// Takes what turns about the own axis of a hinge out of its pose into its angle. `axis` is that of the hinge above.
    fn count_from_zero(&mut self, axis: Option<usize>) {
        if self.joint.motion != Motion::Turn || is_permutation(&self.pose.turn) {
            return;
        }
        let axis = axis.unwrap_or((self.axis + 1) % 3);
        let across = across(axis, self.axis);
        let [first, second, own] = between(&self.pose.turn, axis, self.axis);
        // A right angle costs nothing where it is, but would cost an addition in the angle.
        let right = about(self.axis, own);
        let (kept, zero) = if is_permutation(&right) {
            (right, 0.0)
        } else {
            (IDENTITY, -own)
        };
        self.pose.turn = product(&product(&about(axis, first), &about(across, second)), &kept);
        self.zero += zero;
    }
}

fn turned(turn: Matrix) -> Pose {
    Pose { turn, ..Pose::NONE }
}

fn placed(place: Vector) -> Pose {
    Pose {
        place,
        ..Pose::NONE
    }
}
