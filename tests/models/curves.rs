//! Curves in laws of storages, resistors and sources: energy, derivatives, lanes.

use mbg_runtime::lanes::{Lanes, f64x4};
use mbg_runtime::{
    Adaptive, Constant, Dop853, Dual, Integrator, ParameterError, Real, System, mbg,
};
use nalgebra::SVector;

use super::energy::imbalance;

mbg! {
    /// A motor turns a fan by a shaft that gets stiffer as it twists.
    model Drive {
        param knee: rad/s = 60.0;
        param drag: N*m = 9.0;
        input throttle;

        let speeds = [0.0, knee, 150.0];
        1 rotor {
            I armature { inertia: 0.02, initial: 0.4 }
            Se motor { effort: throttle * interpolate(rotor.f, speeds, [12.0, 10.0, 0.0]) }
        }
        1 wheel {
            I fan { inertia: 0.05, initial: 6.0 }
            R air { effort: interpolate(f, [-100.0, 0.0, 50.0, 100.0], [-drag, 0.0, 0.3 * drag, drag]) }
        }
        0 twist { C shaft { effort: interpolate(q, [-0.003, -0.001, 0.001, 0.003], [-0.8, -0.2, 0.2, 0.8]) } }
        1 slip { R rubber { resistance: 0.02 } }
        rotor -> twist -> wheel;
        twist -> slip;
        output speed: rad/s = rotor.f;
    }
}

fn drive<T: Real>(parameters: DriveParameters<T>) -> Drive<T> {
    Drive::new(parameters).unwrap()
}

fn thrown() -> Vec<SVector<f64, 3>> {
    let model = drive(DriveParameters::default());
    let mut states = vec![model.initial_state()];
    let throttle = Constant(SVector::from([1.0]));
    Adaptive::new(Dop853, 1e-9, 1e-9)
        .integrate(&model, &throttle, 0.0, 2.0, states[0], |step| {
            states.push(*step.state())
        })
        .unwrap();
    states
}

/// At every state the energy changes by what is supplied less what is dissipated.
#[test]
fn curves_balance() {
    let states = thrown();
    let model = drive(DriveParameters::default());
    let moving = drive(DriveParameters {
        knee: Dual::constant(60.0),
        drag: Dual::constant(9.0),
    });
    let throttle = SVector::from([1.0]);
    let (mut most, mut twisted) = (0.0_f64, [0.0_f64; 2]);
    for x in &states {
        let rate = model.derivative(0.0, x, &throttle, &mut Default::default());
        let along = x.zip_map(&rate, |value, slope| Dual { value, slope });
        let change = moving.energy(Dual::constant(0.0), &along).slope;
        let power = model.power(0.0, x, &throttle, &mut Default::default());
        let left = change - power.supplied + power.dissipated;
        most = most.max(left.abs() / (power.supplied + power.dissipated));
        twisted = [twisted[0].min(x[2]), twisted[1].max(x[2])];
    }
    assert!(most < 1e-13, "{most:e}");
    assert!(
        states.len() > 100 && twisted[0] < -0.003 && twisted[1] > 0.003,
        "{twisted:?}"
    );
    let left = imbalance(&model, &Constant(throttle), 1e-6, 100_000);
    assert!(left < 1e-10, "{left:e}");
}

/// Jacobians are the slopes on dual numbers, and lanes are the numbers alone.
#[test]
fn curves_have_jacobians_and_lanes() {
    let states = thrown();
    let model = drive(DriveParameters::default());
    let throttle = SVector::from([1.0]);
    let wide = drive(DriveParameters {
        knee: f64x4::from_f64(60.0),
        drag: f64x4::from_f64(9.0),
    });
    let moving = drive(DriveParameters {
        knee: Dual::constant(60.0),
        drag: Dual::constant(9.0),
    });
    for four in states.chunks_exact(4) {
        let x = SVector::from_fn(|state, _| f64x4::from_lanes(|lane| four[lane][state]));
        let none = &mut Default::default();
        let found = wide.derivative(
            f64x4::from_f64(0.0),
            &x,
            &SVector::from([f64x4::from_f64(1.0)]),
            none,
        );
        for (lane, x) in four.iter().enumerate() {
            let alone = model.derivative(0.0, x, &throttle, &mut Default::default());
            let error = found.map(|it| it.lane(lane)) - alone;
            assert!(error.norm() <= 1e-13 * alone.norm(), "{error}");
            let jacobian = model.jacobian_state(0.0, x, &throttle, &mut Default::default());
            for state in 0..3 {
                let mut along = x.map(Dual::constant);
                along[state] = Dual::variable(x[state]);
                let input = throttle.map(Dual::constant);
                let zero = Dual::constant(0.0);
                let slopes = moving.derivative(zero, &along, &input, &mut Default::default());
                let error = slopes.map(|it| it.slope) - jacobian.column(state);
                assert!(error.norm() <= 1e-12 * jacobian.norm(), "{error}");
            }
        }
    }
}

#[test]
fn places_that_do_not_rise_are_refused() {
    let refused: Result<_, ParameterError> = Drive::new(DriveParameters {
        knee: 150.0,
        ..DriveParameters::default()
    });
    let text = refused.err().unwrap().to_string();
    assert_eq!(
        text,
        "`150 - knee` is 0e0: it must be positive: the places of a curve rise by it"
    );
}
