//! What every state that a program may choose is, and how it changes.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::parts::{Drive, Family, Mass, Mechanism, Motion, attitude};
use super::pose::{Polynomial, Pose};

/// Values and rates by name.
pub(crate) type States = BTreeMap<String, [f64; 2]>;

pub(crate) fn states(mechanism: &Mechanism, coordinates: &[Polynomial<f64>]) -> States {
    let mut states = States::new();
    let poses = mechanism.poses(coordinates);
    let mut rest = coordinates;
    for (k, part) in mechanism.parts.iter().enumerate() {
        if let Drive::Wheel(inertia) = part.drive {
            let [_, rate, change] = rest[0];
            states.insert(
                format!("wheel{k}.p"),
                [rate, 2.0 * change].map(|it| it * inertia),
            );
        }
        for family in &part.joint.families {
            let (own, behind) = rest.split_at(family.size());
            family.states(&format!("joint{k}"), own, &mut states);
            rest = behind;
        }
        momenta(mechanism.is_planar, k, &part.mass, &poses[k], &mut states);
    }
    states
}

/// Names of components: of a single one, of a vector.
pub(crate) fn components(name: &str, count: usize) -> Vec<String> {
    match count {
        1 => vec![name.to_owned()],
        _ => ["x", "y", "z"][..count]
            .iter()
            .map(|axis| format!("{name}.{axis}"))
            .collect(),
    }
}

impl Family {
    fn states(&self, joint: &str, coordinates: &[Polynomial<f64>], states: &mut States) {
        let words = self.words;
        let names = |word: &str| components(&format!("{joint}.{word}"), coordinates.len());
        for (name, [_, rate, change]) in names(words.rate).into_iter().zip(coordinates) {
            states.insert(name, [*rate, 2.0 * change]);
        }
        if let Motion::Attitude(order) = self.motion {
            return self.attitudes(joint, order, coordinates, states);
        }
        let (word, rest) = match &self.spring {
            Some((_, rest)) => (words.spring, rest.clone()),
            None => (words.position, vec![0.0; coordinates.len()]),
        };
        let all = names(word).into_iter().zip(coordinates).zip(rest);
        for ((name, [position, rate, _]), rest) in all {
            states.insert(name, [position - rest, *rate]);
        }
    }

    /// As a quaternion and as a matrix.
    fn attitudes(
        &self,
        joint: &str,
        order: [usize; 3],
        coordinates: &[Polynomial<f64>],
        states: &mut States,
    ) {
        let [angles, rate] = [0, 1].map(|k| [0, 1, 2].map(|axis| coordinates[axis][k]));
        let turn = attitude(order, &angles);
        let rate = Vector3::from(rate);
        let change = turn * rate.cross_matrix();
        for entry in 0..9 {
            let at = (entry / 3, entry % 3);
            let name = format!("{joint}.rotation.turn.{entry}");
            states.insert(name, [turn[at], change[at]]);
        }
        let own = quaternion(&turn);
        let change = own * Quaternion::from_imag(rate) * 0.5;
        let (own, change) = (parts(&own), parts(&change));
        for part in 0..4 {
            let name = format!("{joint}.rotation.quaternion.{part}");
            states.insert(name, [own[part], change[part]]);
        }
    }
}

fn quaternion(turn: &Matrix3<f64>) -> Quaternion<f64> {
    let turn = Rotation3::from_matrix_unchecked(*turn);
    UnitQuaternion::from_rotation_matrix(&turn).into_inner()
}

/// The scalar first.
fn parts(of: &Quaternion<f64>) -> [f64; 4] {
    [of.w, of.i, of.j, of.k]
}

/// Momenta in axes of the body; of planar bodies in those of the world.
fn momenta(is_planar: bool, number: usize, mass: &Mass, pose: &Pose, states: &mut States) {
    let (word, mass, centre, inertia) = match mass {
        Mass::None => return,
        Mass::Point(mass) => ("point", *mass, Vector3::zeros(), None),
        Mass::Body {
            mass,
            inertia,
            centre,
        } => ("body", *mass, *centre, Some(inertia)),
    };
    let centre = pose.at(centre);
    let (velocity, acceleration) = (centre.velocity(), centre.acceleration());
    let [omega, alpha] = pose.spin();
    let inward = pose.axes[0].transpose();
    let own = inward * velocity;
    let linear = match is_planar {
        true => [velocity, acceleration],
        false => [own, inward * acceleration - omega.cross(&own)],
    };
    let mut put = |name: &str, [value, change]: [Vector3<f64>; 2], axes: &[usize]| {
        let names = components(&format!("{word}{number}.{name}.p"), axes.len());
        for (name, axis) in names.into_iter().zip(axes) {
            states.insert(name, [value[*axis], change[*axis]]);
        }
    };
    let (linear_axes, angular_axes): (&[usize], &[usize]) = match is_planar {
        true => (&[0, 1], &[2]),
        false => (&[0, 1, 2], &[0, 1, 2]),
    };
    put("body", linear.map(|it| it * mass), linear_axes);
    if let Some(inertia) = inertia {
        put("spin", [omega, alpha].map(|it| inertia * it), angular_axes);
    }
}
