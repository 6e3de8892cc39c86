//! A platform that flies, on rods without mass.

use mbg_runtime::{Dual, System, mbg};
use nalgebra::{Matrix3, Quaternion, SMatrix, SVector, UnitQuaternion, Vector3};

use super::audit::assert_sound_about_the_start;
use crate::references::noise::noise;

mbg! {
    include "tests/models/platform.mbg";
}

/// A state of the platform and of its arms.
struct Pose {
    turn: Matrix3<f64>,
    place: Vector3<f64>,
    /// In space.
    velocity: Vector3<f64>,
    /// In axes of the platform.
    omega: Vector3<f64>,
    angles: [f64; 3],
    rates: [f64; 3],
}

/// Accelerations of the platform in space, of its turning in its axes, and of the arms, by multipliers of Lagrange.
fn lagrange(pose: &Pose, torque: [f64; 3]) -> SVector<f64, 9> {
    let mut matrix = SMatrix::<f64, 15, 15>::zeros();
    let mut right = SVector::<f64, 15>::zeros();
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.01, 0.012, 0.02));
    let Pose { turn, omega, .. } = pose;
    matrix.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
    matrix.fixed_view_mut::<3, 3>(0, 0).scale_mut(1.2);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
    right[2] = -1.2 * 9.81;
    right
        .fixed_rows_mut::<3>(3)
        .copy_from(&-omega.cross(&(inertia * omega)));
    for arm in 0..3 {
        let about = std::f64::consts::TAU * arm as f64 / 3.0;
        let outwards = Vector3::new(about.cos(), about.sin(), 0.0);
        let sideways = Vector3::z().cross(&outwards);
        let (sine, cosine) = pose.angles[arm].sin_cos();
        let along = outwards * cosine - Vector3::z() * sine;
        let lever = -outwards * sine - Vector3::z() * cosine;
        matrix[(6 + arm, 6 + arm)] = 0.004 + 0.5 * 0.15 * 0.15;
        right[6 + arm] = torque[arm] + 0.5 * 9.81 * 0.15 * cosine;
        for (rod, beside) in [-0.05, 0.05].into_iter().enumerate() {
            let wrist = 0.05 * outwards + beside * sideways;
            let elbow = 0.2 * outwards + 0.3 * along + beside * sideways;
            let span = pose.place + turn * wrist - elbow;
            let turning = turn * omega.cross(&wrist);
            let relative = pose.velocity + turning - 0.3 * lever * pose.rates[arm];
            let (length, unit) = (span.norm(), span.normalize());
            let row = 9 + 2 * arm + rod;
            let moment = wrist.cross(&(turn.transpose() * unit));
            let by_platform = unit.iter().chain(&moment).copied();
            let by_arm = [(6 + arm, -0.3 * unit.dot(&lever))];
            for (place, entry) in by_platform.enumerate().chain(by_arm) {
                matrix[(row, place)] = entry;
                matrix[(place, row)] = entry;
            }
            let drawn =
                turn * omega.cross(&omega.cross(&wrist)) + 0.3 * along * pose.rates[arm].powi(2);
            let swung = relative.norm_squared() - unit.dot(&relative).powi(2);
            right[row] = -swung / length - unit.dot(&drawn);
        }
    }
    matrix.lu().solve(&right).unwrap().fixed_rows::<9>(0).into()
}

#[test]
fn a_platform_on_six_rods_moves_as_by_multipliers_of_lagrange() {
    let model = Platform::new(PlatformParameters::default()).unwrap();
    let place = |name: &str| Platform::<f64>::META.state(name).unwrap();
    let three = |x: &SVector<f64, 19>, name: &dyn Fn(usize) -> String| {
        Vector3::from_fn(|k, _| x[place(&name(k))])
    };
    let axis = |name: &'static str| move |k: usize| format!("{name}.{}", ["x", "y", "z"][k]);
    let arm = |name: &'static str| move |k: usize| format!("arms[{k}].hinge.{name}");
    let mut next = noise(7);
    for _ in 0..20 {
        let torque = SVector::<f64, 3>::from_fn(|_, _| next());
        let moved = model.initial_state().map(|it| it + 0.2 * next());
        let x = model.close(0.0, moved, &torque, &[]).unwrap();
        let quaternion = [0, 1, 2, 3].map(|k| x[place(&format!("free.rotation.quaternion.{k}"))]);
        let [w, i, j, k] = quaternion;
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
        let turn = turn.to_rotation_matrix().into_inner();
        let (linear, spin) = (
            three(&x, &axis("load.body.p")),
            three(&x, &axis("load.spin.p")),
        );
        let inertia = Vector3::new(0.01, 0.012, 0.02);
        let pose = Pose {
            turn,
            place: three(&x, &axis("free.position")),
            velocity: turn * linear / 1.2,
            omega: spin.component_div(&inertia),
            angles: three(&x, &arm("angle")).into(),
            rates: three(&x, &arm("rate.f")).into(),
        };
        let expected = lagrange(&pose, torque.into());
        let slopes = model.derivative(0.0, &x, &torque, &mut ());
        // Momenta are in axes that turn with the platform.
        let force = three(&slopes, &axis("load.body.p")) + pose.omega.cross(&linear);
        let found = [
            turn * force / 1.2,
            three(&slopes, &axis("load.spin.p")).component_div(&inertia),
            three(&slopes, &arm("rate.f")),
        ];
        let size = expected.amax();
        for (found, expected) in found.iter().flatten().zip(&expected) {
            let error = (found - expected).abs();
            assert!(error < 1e-10 * size, "{found} {expected}");
        }
    }
}

#[test]
fn a_platform_is_in_the_balance() {
    assert_sound_about_the_start((
        &Platform::<f64>::new(PlatformParameters::default()).unwrap(),
        &Platform::<Dual<f64>>::new(PlatformParameters::default()).unwrap(),
    ));
}
