//! Robots out of their URDF files some of whose joints mimic others, against recursive Newton-Euler without mimics: its
//! mass matrix and forces are reduced to the joints that are free.

use mbg_runtime::{System, mbg};
use nalgebra::{DMatrix, DVector, SVector};

use crate::references::errors::larger;
use crate::references::noise::noise;
use crate::references::robots::{crane, gripper};
use crate::references::tree::{self, Link};

mbg! {
    include "tests/robots/crane.mbg";
    include "tests/robots/gripper.mbg";

    /// The gripper of `gripper.urdf`, its fingers on the way.
    pub(crate) model Grip {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        input effort[2];
        1 base[6];
        Sf ground[6] { flow: 0.0 } -> base;
        robot: Gripper { effort: effort, initial: [0.3, 0.02], initial_rate: [0.7, -0.05] } (base);
        output coordinates[2] = robot.coordinates;
    }
}

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// A joint that moves: it is `multiplier × coordinate + offset` of a free one.
struct Joint {
    name: &'static str,
    /// The number of the free one.
    free: usize,
    multiplier: f64,
    offset: f64,
}

/// A joint that is free or mimics one that is.
fn joint(name: &'static str, free: usize, multiplier: f64, offset: f64) -> Joint {
    Joint {
        name,
        free,
        multiplier,
        offset,
    }
}

/// A joint that stays where it is.
fn held(offset: f64) -> Joint {
    Joint {
        name: "",
        free: 0,
        multiplier: 0.0,
        offset,
    }
}

/// A robot as the reference has it.
struct Robot {
    links: Vec<Link>,
    /// In order of the links that move.
    joints: Vec<Joint>,
    /// By number of the free joint, the link's place among those.
    driven: Vec<usize>,
}

impl Robot {
    /// What each joint has of values of the free ones.
    fn spread(&self, free: &[f64]) -> Vec<f64> {
        let own = |it: &Joint| it.multiplier * free[it.free];
        self.joints.iter().map(own).collect()
    }

    fn coordinates(&self, free: &[f64]) -> Vec<f64> {
        let offsets = self.joints.iter().map(|it| it.offset);
        let spread = self.spread(free).into_iter();
        spread
            .zip(offsets)
            .map(|(own, offset)| own + offset)
            .collect()
    }

    /// Accelerations of the free joints, and the kinetic energy.
    fn reduced(&self, q: &[f64], v: &[f64], effort: &[f64]) -> (Vec<f64>, f64) {
        let rates = self.spread(v);
        let mut efforts = vec![0.0; self.joints.len()];
        for (link, effort) in self.driven.iter().zip(effort) {
            efforts[*link] = *effort;
        }
        let (free, matrix) =
            tree::accelerations(&self.links, &self.coordinates(q), &rates, &efforts, GRAVITY);
        let size = self.joints.len();
        let mass = DMatrix::from_fn(size, size, |i, j| matrix[j][i]);
        let ties = DMatrix::from_fn(size, v.len(), |i, j| {
            let joint = &self.joints[i];
            if joint.free == j {
                joint.multiplier
            } else {
                0.0
            }
        });
        let right = ties.transpose() * (&mass * DVector::from_vec(free));
        let small = ties.transpose() * &mass * &ties;
        let rates = DVector::from_vec(rates);
        let kinetic = 0.5 * rates.dot(&(&mass * &rates));
        (
            small.lu().solve(&right).unwrap().as_slice().to_vec(),
            kinetic,
        )
    }

    /// The joint whose angle, travel or rate is the state `name`.
    fn joint(&self, name: &str) -> &Joint {
        let inner = name.strip_prefix("robot.").unwrap();
        let (name, _) = inner.split_once('.').unwrap();
        self.joints.iter().find(|it| it.name == name).unwrap()
    }

    /// The state of a model at coordinates and rates of the free joints, by the names of its states.
    fn state<const N: usize>(&self, names: &[&str], q: &[f64], v: &[f64]) -> SVector<f64, N> {
        let value = |name: &&str| {
            let joint = self.joint(name);
            match name.ends_with(".rate.f") {
                true => joint.multiplier * v[joint.free],
                false => joint.multiplier * q[joint.free] + joint.offset,
            }
        };
        SVector::from_iterator(names.iter().map(value))
    }
}

fn crane_with_mimic() -> Robot {
    Robot {
        links: crane(),
        joints: vec![
            joint("rail", 0, 1.0, 0.0),
            joint("slew", 1, 1.0, 0.0),
            joint("boom_joint", 2, 1.0, 0.0),
            joint("cable", 1, 2.0, 0.0),
            joint("lift", 3, 1.0, 0.0),
        ],
        driven: vec![0, 1, 2, 4],
    }
}

fn gripper_with_mimics() -> Robot {
    Robot {
        links: gripper(),
        joints: vec![
            joint("wrist", 0, 1.0, 0.0),
            joint("right_slide", 1, 1.0, 0.0),
            joint("left_slide", 1, 1.0, 0.0),
            joint("thumb_hinge", 1, 12.5, -0.1),
            held(0.3),
            held(0.01),
            joint("nail_hinge", 1, -0.5 * 12.5, -0.5 * -0.1 + 0.2),
        ],
        driven: vec![0, 2],
    }
}

/// The largest errors of the derivatives at 1,000 random states, relative to the largest derivative at that state, and of the
/// energy.
fn compared<const N: usize, const M: usize, const P: usize, S: System<f64, N, M, P>>(
    model: &S,
    robot: &Robot,
) -> [f64; 2] {
    let names: Vec<&str> = S::META.states.iter().map(|it| it.name).collect();
    let mut next = noise(1);
    let mut worst = [0.0_f64; 2];
    for _ in 0..1000 {
        let [q, v, effort] = [(); 3].map(|()| SVector::<f64, M>::from_fn(|_, _| next()));
        let [q, v, effort] = [q.as_slice(), v.as_slice(), effort.as_slice()];
        let (acceleration, kinetic) = robot.reduced(q, v, effort);
        let x = robot.state(&names, q, v);
        let u = SVector::from_column_slice(effort);
        let found = model.derivative(0.0, &x, &u, &mut Default::default());
        // The offsets of coordinates are in their rates, too.
        let still = robot.state::<N>(&names, &[0.0; M], &[0.0; M]);
        let expected = robot.state::<N>(&names, v, &acceleration) - still;
        worst[0] = larger(worst[0], (found - expected).amax() / expected.amax());
        worst[1] = larger(worst[1], (model.energy(0.0, &x) - kinetic).abs() / kinetic);
    }
    worst
}

#[test]
fn crane_with_everything_a_file_may_say_equals_the_recursion() {
    let model = Crane::new(CraneParameters::default()).unwrap();
    let [acceleration, energy] = compared(&model, &crane_with_mimic());
    println!("crane: accelerations {acceleration:.1e}, energy {energy:.1e}");
    assert!(acceleration < 1e-13, "{acceleration:e}");
    assert!(energy < 1e-14, "{energy:e}");
}

#[test]
fn gripper_whose_fingers_follow_one_drive_equals_the_recursion() {
    let model = Grip::new(GripParameters::default()).unwrap();
    let [acceleration, energy] = compared(&model, &gripper_with_mimics());
    println!("gripper: accelerations {acceleration:.1e}, energy {energy:.1e}");
    assert!(acceleration < 1e-13, "{acceleration:e}");
    assert!(energy < 1e-14, "{energy:e}");
}

#[test]
fn joints_start_where_and_as_fast_as_they_are_told() {
    let model = Grip::new(GripParameters::default()).unwrap();
    let names = <Grip as System<f64, 7, 2, 2>>::META.states.iter();
    let names: Vec<&str> = names.map(|it| it.name).collect();
    let expected = gripper_with_mimics().state(&names, &[0.3, 0.02], &[0.7, -0.05]);
    assert!((model.initial_state() - expected).amax() < 1e-15);
}
