//! Rods without mass, and ropes that winches reel in.

use mbg_runtime::{Adaptive, Constant, Dop853, Dual, Integrator, System, Trim, mbg};
use nalgebra::{SMatrix, SVector, Vector3};

use super::audit::assert_sound_about_the_start;
use crate::references::noise::noise;

mbg! {
    include "tests/models/rods.mbg";
}

/// Accelerations of the platform and of the arms, then tensions, by multipliers of Lagrange.
fn lagrange(
    [place, velocity]: [Vector3<f64>; 2],
    [angles, rates]: [[f64; 3]; 2],
    torque: [f64; 3],
) -> SVector<f64, 9> {
    let mut matrix = SMatrix::<f64, 9, 9>::zeros();
    let mut right = SVector::<f64, 9>::zeros();
    for axis in 0..3 {
        matrix[(axis, axis)] = 1.2;
    }
    right[2] = -1.2 * 9.81;
    for arm in 0..3 {
        let turn = std::f64::consts::TAU * arm as f64 / 3.0;
        let outwards = Vector3::new(turn.cos(), turn.sin(), 0.0);
        let (sine, cosine) = angles[arm].sin_cos();
        let along = outwards * cosine - Vector3::z() * sine;
        let lever = -outwards * sine - Vector3::z() * cosine;
        let span = place + 0.05 * outwards - (0.2 * outwards + 0.3 * along);
        let relative = velocity - 0.3 * lever * rates[arm];
        let (length, unit) = (span.norm(), span.normalize());
        let row = 6 + arm;
        matrix[(3 + arm, 3 + arm)] = 0.004 + 0.5 * 0.15 * 0.15;
        right[3 + arm] = torque[arm] + 0.5 * 9.81 * 0.15 * cosine;
        for axis in 0..3 {
            matrix[(row, axis)] = unit[axis];
            matrix[(axis, row)] = unit[axis];
        }
        matrix[(row, 3 + arm)] = -0.3 * unit.dot(&lever);
        matrix[(3 + arm, row)] = matrix[(row, 3 + arm)];
        // The rod turns, and the elbow is drawn inwards.
        let turning = relative.norm_squared() - unit.dot(&relative).powi(2);
        right[row] = -turning / length - 0.3 * unit.dot(&along) * rates[arm].powi(2);
    }
    matrix.lu().solve(&right).unwrap()
}

#[test]
fn a_delta_robot_moves_as_by_multipliers_of_lagrange() {
    let model = Delta::new(DeltaParameters::default()).unwrap();
    let place = |name: &str| Delta::<f64>::META.state(name).unwrap();
    let vector = |x: &SVector<f64, 12>, names: [&str; 3]| names.map(|name| x[place(name)]);
    let travels = ["x.travel", "y.travel", "z.travel"];
    let momenta = ["load.body.p.x", "load.body.p.y", "load.body.p.z"];
    let angles = [0, 1, 2].map(|k| format!("arms[{k}].hinge.angle"));
    let angles = [0, 1, 2].map(|k| angles[k].as_str());
    let rates = [0, 1, 2].map(|k| format!("arms[{k}].hinge.rate.f"));
    let rates = [0, 1, 2].map(|k| rates[k].as_str());
    let mut next = noise(3);
    for _ in 0..20 {
        let torque = SVector::<f64, 3>::from_fn(|_, _| next());
        let moved = model.initial_state().map(|it| it + 0.2 * next());
        let x = model.close(0.0, moved, &torque, &[]).unwrap();
        let slopes = model.derivative(0.0, &x, &torque, &mut ());
        let outputs = model.output(0.0, &x, &torque, &mut ());
        let expected = lagrange(
            [
                vector(&x, travels).into(),
                Vector3::from(vector(&x, momenta)) / 1.2,
            ],
            [vector(&x, angles), vector(&x, rates)],
            torque.into(),
        );
        let size = expected.amax();
        let force = Vector3::from(vector(&slopes, momenta)) / 1.2;
        let turning = vector(&slopes, rates);
        let found = force
            .iter()
            .chain(&turning)
            .chain(&outputs.as_slice()[3..6]);
        for (found, expected) in found.zip(&expected) {
            let error = (found - expected).abs();
            assert!(error < 1e-10 * size, "{found} {expected}");
        }
    }
}

#[test]
fn a_delta_robot_is_trimmed_and_its_rods_keep_their_length() {
    let model = Delta::new(DeltaParameters::default()).unwrap();
    let wanted = [("place.x", 0.05), ("place.y", -0.02), ("place.z", -0.6)];
    let trim = wanted
        .iter()
        .fold(Trim::new(&model), |trim, (name, value)| {
            trim.output(name, *value)
        });
    let rest = trim.solve().unwrap();
    let torque = Constant(rest.input + Vector3::new(0.3, -0.2, 0.1));
    let mut apart = 0.0_f64;
    Adaptive::new(Dop853, 1e-9, 1e-9)
        .integrate(&model, &torque, 0.0, 0.5, rest.state, |step| {
            let outputs = model.output(step.end(), step.state(), &torque.0, &mut ());
            let lengths = outputs.rows(6, 3).map(|length| (length - 0.8).abs());
            apart = apart.max(lengths.max());
        })
        .unwrap();
    assert!(apart < 1e-14, "{apart:e}");
}

#[test]
fn a_rod_pulls_against_weight_and_swing() {
    let model = Bob::new(BobParameters::default()).unwrap();
    let mut x = model.initial_state();
    // Along the circle at 2 m/s, at the sine 0.6 and the cosine 0.8 from below.
    for (name, speed) in [("across.rate.f", 1.6), ("up.rate.f", 1.2)] {
        if let Some(place) = Bob::<f64>::META.state(name) {
            x[place] = speed;
        }
    }
    for (name, speed) in [("mass.body.p.x", 1.6), ("mass.body.p.y", 1.2)] {
        if let Some(place) = Bob::<f64>::META.state(name) {
            x[place] = 1.5 * speed;
        }
    }
    let tension: f64 = model.output(0.0, &x, &SVector::zeros(), &mut ())[0];
    let expected = 1.5 * (9.81 * 0.8 + 2.0 * 2.0 / 0.5);
    assert!((tension - expected).abs() < 1e-12, "{tension} {expected}");
}

#[test]
fn a_winch_pulls_by_stretch_and_by_its_rate() {
    let winch = SVector::from([-0.3]);
    let hoist = Hoist::new(HoistParameters::default()).unwrap();
    let found = hoist.output(0.0, &hoist.initial_state(), &winch, &mut ())[0];
    assert!((found - 1e3 * (f64::hypot(0.1, 1.3) - 1.2) - 20.0 * 0.3).abs() < 1e-11);
    let dragged = Dragged::new(DraggedParameters::default()).unwrap();
    let found = dragged.output(0.0, &dragged.initial_state(), &winch, &mut ())[0];
    assert!((found - 500.0 * (1.25 - 1.2) - 10.0 * 0.3).abs() < 1e-11);
}

#[test]
fn rods_and_winches_are_in_the_balance() {
    macro_rules! sound {
        ($model:ident, $parameters:ident) => {
            assert_sound_about_the_start((
                &$model::<f64>::new($parameters::default()).unwrap(),
                &$model::<Dual<f64>>::new($parameters::default()).unwrap(),
            ))
        };
    }
    sound!(Delta, DeltaParameters);
    sound!(Bob, BobParameters);
    sound!(Hoist, HoistParameters);
    sound!(Dragged, DraggedParameters);
}
