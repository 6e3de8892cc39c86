//! A robot out of its URDF file that floats, with a plate on a plane of it, against recursive Newton-Euler with a slide or a
//! hinge for each coordinate.

use mbg_runtime::{System, mbg};
use nalgebra::{Rotation3, SVector, UnitQuaternion, Vector3};

use crate::references::errors::larger;
use crate::references::noise::noise;
use crate::references::robots::rover;
use crate::references::tree;

mbg! {
    include "tests/robots/rover.mbg";
}

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// The angular velocity in axes of a body that turned about x, then about its y, then about its z, and the rate of that.
fn turning(angles: &[f64], rates: &[f64], changes: &[f64]) -> [Vector3<f64>; 2] {
    let ([(sb, cb), (sc, cc)], [u, v, w], [du, dv, dw]) = (
        [angles[1].sin_cos(), angles[2].sin_cos()],
        [rates[0], rates[1], rates[2]],
        [changes[0], changes[1], changes[2]],
    );
    let velocity = Vector3::new(u * cb * cc + v * sc, -u * cb * sc + v * cc, u * sb + w);
    let change = Vector3::new(
        du * cb * cc + dv * sc - u * (sb * v * cc + cb * sc * w) + v * cc * w,
        -du * cb * sc + dv * cc + u * (sb * v * sc - cb * cc * w) - v * sc * w,
        du * sb + dw + u * cb * v,
    );
    [velocity, change]
}

/// The states in order, with what the hull's place and velocity are in angles about x, y and z.
fn state(q: &[f64], v: &[f64]) -> SVector<f64, 18> {
    let about = |axis: Vector3<f64>, angle: f64| Rotation3::new(axis * angle);
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let turned = about(x, q[3]) * about(y, q[4]) * about(z, q[5]);
    let turned = UnitQuaternion::from_rotation_matrix(&turned);
    let mut state = SVector::<f64, 18>::zeros();
    state[0] = turned.w;
    state.fixed_rows_mut::<3>(1).copy_from(&turned.imag());
    state.as_mut_slice()[4..8].copy_from_slice(&[q[6], q[9], q[7], q[8]]);
    state.as_mut_slice()[8..].copy_from_slice(&rates(q, v, &[0.0; 10])[0]);
    state
}

/// The rates in order of the states, and how they change.
fn rates(q: &[f64], v: &[f64], changes: &[f64]) -> [[f64; 10]; 2] {
    let turning = turning(&q[3..6], &v[3..6], &changes[3..6]);
    let ordered = |own: &[f64], turning: Vector3<f64>| {
        let [x, y, z] = turning.into();
        [
            own[0], own[1], own[2], x, y, z, own[6], own[9], own[7], own[8],
        ]
    };
    [ordered(v, turning[0]), ordered(changes, turning[1])]
}

#[test]
fn rover_that_floats_equals_the_recursion() {
    let (model, links) = (Rover::new(RoverParameters::default()).unwrap(), rover());
    let mut next = noise(1);
    let mut worst = [0.0_f64; 2];
    for _ in 0..1000 {
        let [q, v] = [(); 2].map(|()| SVector::<f64, 10>::from_fn(|_, _| next()));
        let (q, v) = (q.as_slice(), v.as_slice());
        let mut effort = [0.0; 10];
        effort[6] = next();
        let (found, matrix) = tree::accelerations(&links, q, v, &effort, GRAVITY);
        let (x, u) = (state(q, v), SVector::from([effort[6]]));
        let slope = model.derivative(0.0, &x, &u, &mut Default::default());
        let [_, expected] = rates(q, v, &found).map(SVector::<f64, 10>::from);
        let error = slope.fixed_rows::<10>(8) - expected;
        worst[0] = larger(worst[0], error.amax() / expected.amax());
        let row = |row: &Vec<f64>| row.iter().zip(v).map(|(m, v)| m * v).sum::<f64>();
        let kinetic: f64 = 0.5 * matrix.iter().zip(v).map(|(it, v)| row(it) * v).sum::<f64>();
        worst[1] = larger(worst[1], (model.energy(0.0, &x) - kinetic).abs() / kinetic);
    }
    println!(
        "rover: accelerations {:.1e}, energy {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst[0] < 1e-12, "{:e}", worst[0]);
    assert!(worst[1] < 1e-13, "{:e}", worst[1]);
}
