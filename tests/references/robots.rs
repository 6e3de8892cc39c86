//! Robots of the tests, in the numbers of their URDF files.

use std::f64::consts::{FRAC_PI_2, PI};

use super::tree::{Kind, Link};

/// The published inertial data of the Franka Emika Panda, its hand with locked fingers in the last link: place of the
/// joint in the link before and its turn about x, mass, centre of mass, and `ixx, ixy, ixz, iyy, iyz, izz` about it.
pub(crate) fn panda() -> Vec<Link> {
    let rows = [
        (
            [0.0, 0.0, 0.333],
            0.0,
            4.970684,
            [0.003875, 0.002081, -0.04762],
            [0.70337, -0.000139, 0.006772, 0.70661, 0.019169, 0.009117],
        ),
        (
            [0.0, 0.0, 0.0],
            -FRAC_PI_2,
            0.646926,
            [-0.003141, -0.02872, 0.003495],
            [0.007962, -0.003925, 0.010254, 0.02811, 0.000704, 0.025995],
        ),
        (
            [0.0, -0.316, 0.0],
            FRAC_PI_2,
            3.228604,
            [0.027518, 0.039252, -0.066502],
            [0.037242, -0.004761, -0.011396, 0.036155, -0.012805, 0.01083],
        ),
        (
            [0.0825, 0.0, 0.0],
            FRAC_PI_2,
            3.587895,
            [-0.05317, 0.104419, 0.027454],
            [0.025853, 0.007796, -0.001332, 0.019552, 0.008641, 0.028323],
        ),
        (
            [-0.0825, 0.384, 0.0],
            -FRAC_PI_2,
            1.225946,
            [-0.011953, 0.041065, -0.038437],
            [0.035549, -0.002117, -0.004037, 0.029474, 0.000229, 0.008627],
        ),
        (
            [0.0, 0.0, 0.0],
            FRAC_PI_2,
            1.666555,
            [0.060149, -0.014117, -0.010517],
            [0.001964, 0.000109, -0.001158, 0.004354, 0.000341, 0.005433],
        ),
        (
            [0.088, 0.0, 0.0],
            FRAC_PI_2,
            1.495522,
            [0.0017208743, 0.00136035442, 0.100485281],
            [
                0.0165298537,
                0.000394892297,
                -0.000706695711,
                0.0141072486,
                -0.00105110533,
                0.00667695556,
            ],
        ),
    ];
    let link = |(number, (place, turn, mass, centre, inertia)): (usize, _)| Link {
        parent: usize::checked_sub(number, 1),
        kind: Kind::Revolute,
        place,
        angles: [turn, 0.0, 0.0],
        axis: [0.0, 0.0, 1.0],
        damping: 0.003,
        mass,
        centre,
        inertia,
        ..Link::PLAIN
    };
    rows.into_iter().enumerate().map(link).collect()
}

/// What a file that was written by hand gives for π/2.
#[allow(clippy::approx_constant, reason = "it is meant to be near")]
const NEARLY_RIGHT: f64 = 1.5708;

/// The robot of `crane.urdf`, with the links in the order in which its component lists the joints.
pub(crate) fn crane() -> Vec<Link> {
    let cart = Link {
        kind: Kind::Prismatic,
        place: [0.0, 0.3, 0.0],
        angles: [0.0, 0.0, 0.2],
        axis: [1.0, 0.0, 0.2],
        damping: 0.6,
        mass: 4.0,
        centre: [0.1, 0.0, 0.2],
        centre_angles: [0.1, 0.2, 0.3],
        inertia: [0.5, 0.02, -0.03, 0.6, 0.04, 0.7],
        ..Link::PLAIN
    };
    let tower = Link {
        parent: Some(0),
        place: [0.0, 0.0, 0.4],
        angles: [FRAC_PI_2, 0.0, 0.0],
        axis: [0.0, -1.0, 0.0],
        damping: 0.2,
        friction: 0.3,
        mass: 3.0,
        centre: [0.0, 0.0, 0.5],
        inertia: [0.4, 0.0, 0.0, 0.4, 0.0, 0.1],
        ..Link::PLAIN
    };
    let boom = Link {
        parent: Some(1),
        place: [0.1, 0.2, 0.3],
        angles: [0.3, -0.2, 0.5],
        axis: [0.3, -0.4, 1.2],
        damping: 0.05,
        mass: 2.0,
        centre: [0.6, -0.02, 0.03],
        centre_angles: [0.0, FRAC_PI_2, 0.4],
        inertia: [0.03, 0.001, 0.002, 0.2, -0.003, 0.21],
        ..Link::PLAIN
    };
    let lamp = Link {
        parent: Some(1),
        place: [0.5, 0.0, 0.0],
        angles: [0.0, NEARLY_RIGHT, 0.0],
        mass: 0.2,
        centre: [0.0, 0.0, -0.3],
        inertia: [0.002, 0.0, 0.0, 0.002, 0.0, 0.0005],
        ..Link::PLAIN
    };
    let counterweight = Link {
        parent: Some(2),
        kind: Kind::Fixed,
        place: [-0.4, 0.0, 0.0],
        angles: [0.1, 0.7, 0.0],
        mass: 1.5,
        centre: [-0.1, 0.0, 0.0],
        centre_angles: [0.2, 0.0, 0.0],
        inertia: [0.01, 0.0, 0.001, 0.02, 0.0, 0.015],
        ..Link::PLAIN
    };
    let hook = Link {
        parent: Some(2),
        kind: Kind::Prismatic,
        place: [1.2, 0.0, 0.0],
        axis: [0.0, 0.0, -1.0],
        mass: 0.8,
        inertia: [0.001, 0.0, 0.0, 0.002, 0.0, 0.003],
        ..Link::PLAIN
    };
    let tip = Link {
        parent: Some(5),
        kind: Kind::Fixed,
        place: [0.2, 0.0, 0.0],
        angles: [0.0, 0.0, PI],
        ..Link::PLAIN
    };
    vec![cart, tower, boom, lamp, counterweight, hook, tip]
}

/// The robot of `winder.urdf`, with the links in the order in which its component lists the joints.
pub(crate) fn winder() -> Vec<Link> {
    let arm = Link {
        place: [0.0, 0.0, 0.5],
        axis: [0.0, 1.0, 0.0],
        mass: 2.0,
        centre: [0.2, 0.0, 0.1],
        inertia: [0.1, 0.0, 0.0, 0.3, 0.0, 0.2],
        ..Link::PLAIN
    };
    let armature = Link {
        parent: Some(0),
        kind: Kind::Fixed,
        place: [0.1, 0.0, 0.0],
        angles: [0.0, 0.4, 0.0],
        centre: [0.0, 5.0, 0.0],
        centre_angles: [0.3, 0.2, 0.1],
        inertia: [0.5, 0.0, 0.0, 0.0, 0.0, 0.0],
        ..Link::PLAIN
    };
    let wheel = Link {
        parent: Some(0),
        place: [0.3, 0.0, 0.0],
        axis: [0.0, 0.0, 1.0],
        centre: [0.0, 0.0, 0.4],
        inertia: [0.02, 0.0, 0.0, 0.03, 0.0, 0.04],
        ..Link::PLAIN
    };
    let shaft = Link {
        parent: Some(0),
        place: [0.4, 0.0, 0.0],
        angles: [0.1, 0.0, 0.0],
        axis: [0.3, 0.8, 0.1],
        centre_angles: [0.5, 0.6, 0.7],
        inertia: [0.0, 0.0, 0.0, 0.06, 0.0, 0.0],
        ..Link::PLAIN
    };
    let bob = Link {
        parent: Some(0),
        place: [0.5, 0.0, 0.0],
        mass: 0.7,
        centre: [0.1, -0.2, 0.3],
        ..Link::PLAIN
    };
    let carriage = Link {
        parent: Some(2),
        kind: Kind::Prismatic,
        place: [0.0, 0.1, 0.0],
        mass: 0.4,
        ..Link::PLAIN
    };
    let hook = Link {
        parent: Some(5),
        kind: Kind::Fixed,
        place: [0.0, 0.1, -0.3],
        mass: 0.2,
        ..Link::PLAIN
    };
    let rod = Link {
        parent: Some(4),
        place: [0.0, 0.2, 0.0],
        axis: [0.0, 0.0, 1.0],
        mass: 0.9,
        centre: [0.3, 0.0, 0.0],
        centre_angles: [0.2, 0.4, 0.0],
        inertia: [0.0, 0.0, 0.0, 0.05, 0.0, 0.05],
        ..Link::PLAIN
    };
    vec![arm, armature, wheel, shaft, bob, carriage, hook, rod]
}

/// The robot of `gripper.urdf`, with the links in the order in which its component lists the joints.
pub(crate) fn gripper() -> Vec<Link> {
    let palm = Link {
        place: [0.0, 0.0, 0.1],
        angles: [0.4, 0.0, 0.0],
        axis: [0.0, 0.6, 0.8],
        damping: 0.02,
        mass: 0.8,
        centre: [0.0, 0.01, 0.05],
        inertia: [0.003, 0.0, 0.0, 0.002, 0.0, 0.001],
        ..Link::PLAIN
    };
    let right = Link {
        parent: Some(0),
        kind: Kind::Prismatic,
        place: [0.0, 0.0, 0.08],
        angles: [0.0, 0.0, PI],
        axis: [0.0, 1.0, 0.0],
        mass: 0.2,
        centre: [0.0, 0.02, 0.03],
        inertia: [0.0003, 0.0, 0.0, 0.0002, 0.0, 0.0001],
        ..Link::PLAIN
    };
    let left = Link {
        parent: Some(0),
        kind: Kind::Prismatic,
        place: [0.0, 0.0, 0.08],
        axis: [0.0, 1.0, 0.0],
        damping: 0.5,
        friction: 0.3,
        mass: 0.25,
        centre: [0.01, 0.02, 0.03],
        inertia: [0.0003, 0.00005, 0.0, 0.0002, 0.0, 0.00015],
        ..Link::PLAIN
    };
    let thumb = Link {
        parent: Some(0),
        place: [0.03, 0.0, 0.06],
        angles: [0.0, 0.2, 0.0],
        axis: [0.0, 1.0, 0.0],
        damping: 0.001,
        friction: 0.002,
        mass: 0.15,
        centre: [0.04, 0.0, 0.0],
        centre_angles: [0.1, 0.2, 0.3],
        inertia: [0.0001, 0.0, 0.0, 0.0002, 0.0, 0.0003],
        ..Link::PLAIN
    };
    let cover = Link {
        parent: Some(0),
        place: [-0.03, 0.0, 0.06],
        axis: [0.48, 0.6, 0.64],
        mass: 0.1,
        centre: [0.03, 0.0, 0.0],
        inertia: [0.0001, 0.0, 0.0, 0.0001, 0.0, 0.0001],
        ..Link::PLAIN
    };
    let plug = Link {
        parent: Some(0),
        kind: Kind::Prismatic,
        place: [0.0, 0.03, 0.06],
        axis: [0.0, -2.0, 0.0],
        mass: 0.03,
        centre: [0.0, 0.0, 0.02],
        inertia: [0.00001, 0.0, 0.0, 0.00001, 0.0, 0.00001],
        ..Link::PLAIN
    };
    let nail = Link {
        parent: Some(3),
        place: [0.08, 0.0, 0.0],
        axis: [0.0, 1.0, 0.0],
        mass: 0.05,
        centre: [0.02, 0.0, 0.01],
        inertia: [0.00002, 0.0, 0.0, 0.00003, 0.0, 0.00004],
        ..Link::PLAIN
    };
    vec![palm, right, left, thumb, cover, plug, nail]
}

/// The robot of `rover.urdf`: its floating joint as slides along x, y and z and hinges about x, y and z, its planar one as two
/// slides and a hinge.
pub(crate) fn rover() -> Vec<Link> {
    let step = |parent: Option<usize>, kind: Kind, axis: [f64; 3]| Link {
        parent,
        kind,
        axis,
        ..Link::PLAIN
    };
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let first = Link {
        place: [0.0, 0.0, 1.0],
        angles: [0.2, 0.0, 0.0],
        ..step(None, Kind::Prismatic, x)
    };
    let hull = Link {
        mass: 5.0,
        centre: [0.1, 0.02, 0.03],
        centre_angles: [0.1, 0.2, 0.3],
        inertia: [0.4, 0.01, 0.0, 0.5, 0.0, 0.6],
        ..step(Some(4), Kind::Revolute, z)
    };
    let arm = Link {
        place: [0.4, 0.0, 0.1],
        angles: [0.3, 0.0, 0.0],
        mass: 1.0,
        centre: [0.3, 0.0, 0.0],
        inertia: [0.01, 0.0, 0.0, 0.03, 0.0, 0.03],
        ..step(Some(5), Kind::Revolute, y)
    };
    // The plane's axes are the shortest turn from z to its normal away from those of the joint.
    let along = Link {
        place: [-0.2, 0.0, 0.2],
        angles: [0.0, 0.4, 0.0],
        ..step(Some(5), Kind::Prismatic, [0.8, 0.0, -0.6])
    };
    let plate = Link {
        mass: 0.7,
        centre: [0.05, 0.06, 0.01],
        inertia: [0.01, 0.0, 0.0, 0.02, 0.0, 0.03],
        ..step(Some(8), Kind::Revolute, [0.6, 0.0, 0.8])
    };
    vec![
        first,
        step(Some(0), Kind::Prismatic, y),
        step(Some(1), Kind::Prismatic, z),
        step(Some(2), Kind::Revolute, x),
        step(Some(3), Kind::Revolute, y),
        hull,
        arm,
        along,
        step(Some(7), Kind::Prismatic, y),
        plate,
    ]
}
