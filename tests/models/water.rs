//! A body in an ideal fluid against Kirchhoff's equations.

use mbg_runtime::{Adaptive, Constant, Dop853, Integrator, System, mbg};
use nalgebra::{Matrix3, Matrix6, SVector, Vector3, Vector6};

mbg! {
    /// A boat under water, with what it takes along of that.
    model Boat {
        input push: N;
        1 ground[6];
        1 hull[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        free: Free {
            orientation: quaternion,
            initial_velocity: [1.0, 0.2, -0.1],
            initial_rate: [0.3, -0.2, 0.4]
        } (ground, hull);
        body: Body { mass: 100.0, inertia: diag(12.0, 15.0, 14.0), centre: [0.0, 0.02, 0.05] } (hull);
        #[derivative]
        water: AddedMass {
            mass: diag(40.0, 80.0, 90.0),
            inertia: diag(5.0, 8.0, 9.0),
            centre: [0.1, 0.0, -0.03]
        } (hull);
        Se thrust { effort: push } -> hull[3];
        output velocity[6] = hull.f;
    }
}

const PUSH: f64 = 30.0;

/// The moment and the force of inertia of a mass with its centre, by (ω, v).
fn inertia(mass: [f64; 3], about: [f64; 3], centre: [f64; 3]) -> Matrix6<f64> {
    let [mass, about] = [mass, about].map(|it| Matrix3::from_diagonal(&Vector3::from(it)));
    let lever = Vector3::from(centre).cross_matrix();
    let mut whole = Matrix6::zeros();
    whole
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&(about - lever * mass * lever));
    whole
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&(lever * mass));
    whole
        .fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&-(mass * lever));
    whole.fixed_view_mut::<3, 3>(3, 3).copy_from(&mass);
    whole
}

/// How (ω, v) changes (Lamb, *Hydrodynamics*, Cambridge 1932, §124).
fn kirchhoff(inertia: &Matrix6<f64>, flow: &Vector6<f64>) -> Vector6<f64> {
    let momenta = inertia * flow;
    let part = |of: &Vector6<f64>, first: usize| of.fixed_rows::<3>(first).into_owned();
    let [turning, moving] = [part(flow, 0), part(flow, 3)];
    let [angular, linear] = [part(&momenta, 0), part(&momenta, 3)];
    let moment = -turning.cross(&angular) - moving.cross(&linear);
    let force = Vector3::new(PUSH, 0.0, 0.0) - turning.cross(&linear);
    let mut right = Vector6::zeros();
    right.fixed_rows_mut::<3>(0).copy_from(&moment);
    right.fixed_rows_mut::<3>(3).copy_from(&force);
    inertia.cholesky().unwrap().solve(&right)
}

#[test]
fn a_boat_turns_as_kirchhoff_says() {
    let body = inertia([100.0; 3], [12.0, 15.0, 14.0], [0.0, 0.02, 0.05]);
    let whole = body + inertia([40.0, 80.0, 90.0], [5.0, 8.0, 9.0], [0.1, 0.0, -0.03]);
    let mut expected = Vector6::new(0.3, -0.2, 0.4, 1.0, 0.2, -0.1);
    let (parts, times) = (400, [0.0, 1.0, 2.0, 5.0, 10.0]);
    let mut last = 0.0;
    let model = Boat::<f64>::new(BoatParameters::default()).unwrap();
    let input = Constant(SVector::from([PUSH]));
    let mut worst = 0.0_f64;
    Adaptive::new(Dop853, 1e-11, 1e-12)
        .sample_outputs(
            &model,
            &input,
            0.0,
            model.initial_state(),
            &times,
            |t, _, y| {
                let step = (t - last) / f64::from(parts);
                for _ in 0..parts {
                    let rate = |flow: Vector6<f64>| kirchhoff(&whole, &flow);
                    let first = rate(expected);
                    let second = rate(expected + 0.5 * step * first);
                    let third = rate(expected + 0.5 * step * second);
                    let fourth = rate(expected + step * third);
                    expected += step / 6.0 * (first + 2.0 * (second + third) + fourth);
                }
                last = t;
                worst = worst.max((y - expected).amax());
            },
        )
        .unwrap();
    assert!(worst < 1e-8, "{worst:e}");
}
