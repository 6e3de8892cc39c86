//! Drivelines.

use mbg_runtime::{Adaptive, Dop853, Fixed, Integrator, Pulse, Rk4, Rodas5P, Smooth, System, mbg};
use nalgebra::SVector;

use super::balance;
use crate::references::errors::larger;
use crate::references::integrate::integrate;

mbg! {
    /// An engine, a clutch that slips, a gear and a differential drive two wheels, which the road holds back differently.
    #[derivative]
    pub(crate) model Driveline {
        param ratio = 3.5;
        param final_ratio = 4.1;
        input torque: N*m;
        input pedal;
        1 engine {
            I flywheel { inertia: 0.25, initial_flow: 200.0 }
            Se gas { effort: torque }
            R pumping { resistance: 0.05 }
        }
        1 plate { I gears { inertia: 0.02 } }
        1 shaft { I tube { inertia: 0.03 } }
        1 left { I left_wheel { inertia: 60.0 } R grass { effort: 0.4 * f * abs(f) } }
        1 right { I right_wheel { inertia: 60.0 } R asphalt { resistance: 3.0 } }
        clutch: Clutch { capacity: 250.0, engagement: pedal } (engine, plate);
        plate -> TF gear { flow: 1 / ratio } -> shaft;
        axle: Differential { ratio: final_ratio } (shaft, left, right);
        output engine_speed: rad/s = engine.f;
        output left_speed: rad/s = left.f;
        output right_speed: rad/s = right.f;
        output plate_speed: rad/s = plate.f;
        output slip: rad/s = clutch.slip;
        output effort: N*m = clutch.effort;
    }
}

/// Torque of the engine, and the pedal that is let go within two seconds.
fn driver(t: f64) -> SVector<f64, 2> {
    SVector::from([60.0 + 20.0 * f64::sin(3.0 * t), t / 2.0])
}

/// What the road takes from the left and the right wheel.
fn road([left, right]: [f64; 2]) -> [f64; 2] {
    [0.4 * left * left.abs(), 3.0 * right]
}

/// Speeds of engine, left and right wheel by hand, while the engine is ahead: one inertia on the side of the shaft, which the mean
/// of both wheels turns.
fn by_hand(t: f64, [engine, left, right]: &[f64; 3]) -> [f64; 3] {
    let input = driver(t);
    let passed = 250.0 * input[1];
    let half = 4.1 / 2.0;
    let turned = half * half * (0.03 + 3.5 * 3.5 * 0.02);
    let [lost_left, lost_right] = road([*left, *right]);
    // Of the sum of both wheels' rates and of their difference.
    let sum = (2.0 * half * 3.5 * passed - lost_left - lost_right) / (60.0 + 2.0 * turned);
    let difference = (lost_right - lost_left) / 60.0;
    [
        (input[0] - 0.05 * engine - passed) / 0.25,
        (sum + difference) / 2.0,
        (sum - difference) / 2.0,
    ]
}

#[test]
fn a_slipping_clutch_starts_two_wheels_as_derived_by_hand() {
    let model = Driveline::<f64>::new(DrivelineParameters::default()).unwrap();
    let (mut time, mut expected, mut worst) = (0.0, [200.0, 0.0, 0.0], 0.0_f64);
    for end in [0.2, 0.5, 0.8] {
        let steps = (end * 1e4_f64).round() as u32;
        let (x, imbalance) = balance::run(&model, &Smooth(driver), 1e-4, steps);
        assert!(imbalance < 1e-12, "{imbalance:e}");
        let substeps = ((end - time) * 1e3_f64).round() as usize;
        expected = integrate(by_hand, (time, end), substeps, expected);
        time = end;
        let input = driver(end);
        let found = model.output(end, &x, &input, &mut Default::default());
        let [engine, left, right] = expected;
        let plate = 3.5 * 4.1 * (left + right) / 2.0;
        let passed = 250.0 * input[1];
        let all = [engine, left, right, plate, engine - plate, passed];
        assert!(engine > plate + 50.0);
        for (found, expected) in found.iter().zip(all) {
            worst = larger(worst, ((found - expected) / expected).abs());
        }
        // Power of the engine is that of masses, of the road and of the slip.
        let power = model.power(end, &x, &input, &mut Default::default());
        let [lost_left, lost_right] = road([left, right]);
        let heat = passed * (engine - plate);
        let lost = heat + lost_left * left + lost_right * right + 0.05 * engine * engine;
        worst = larger(worst, (power.dissipated / lost - 1.0).abs());
        worst = larger(worst, (power.supplied / (input[0] * engine) - 1.0).abs());
    }
    assert!(worst < 1e-9, "{worst:e}");
}

mbg! {
    /// A flywheel takes a load along, and is driven on.
    pub(crate) model Coupled {
        param torque: N*m = 5.0;
        1 engine { I flywheel { inertia: 0.25, initial_flow: 200.0 } Se drive { effort: torque } }
        1 machine { I load { inertia: 1.5 } }
        clutch: Clutch { capacity: 30.0 } (engine, machine);
        output engine_speed: rad/s = engine.f;
        output machine_speed: rad/s = machine.f;
    }
}

#[test]
fn a_clutch_locks_and_both_shafts_turn_as_one() {
    let model = Coupled::<f64>::new(CoupledParameters::default()).unwrap();
    // The slip falls by what slows the one and hastens the other.
    let locked = 200.0 / ((30.0 - 5.0) / 0.25 + 30.0 / 1.5);
    let (mut last, mut steps) = (model.initial_state(), 0);
    let run = Adaptive::new(Dop853, 1e-10, 1e-10).integrate(&model, &(), 0.0, 5.0, last, |step| {
        last = *step.state();
        let speeds = model.output(
            step.end(),
            &last,
            &Default::default(),
            &mut Default::default(),
        );
        let slip = 200.0 * (1.0 - step.end() / locked).max(0.0);
        assert!((speeds[0] - speeds[1] - slip).abs() < 1e-6, "{speeds}");
        steps += 1;
    });
    assert!(run.is_ok() && steps < 100, "{run:?}");
    let speeds = model.output(5.0, &last, &Default::default(), &mut Default::default());
    let common = (0.25 * 200.0 + 5.0 * 5.0) / 1.75;
    for speed in speeds.iter() {
        assert!((speed - common).abs() < 1e-7, "{speeds}");
    }
}

mbg! {
    /// An engine takes a rotor along through a freewheel, fails and stops, while the rotor runs free.
    pub(crate) model Autorotation {
        input torque: N*m;
        1 engine {
            I turbine { inertia: 0.5, initial_flow: 20.0 }
            Se drive { effort: torque }
            R pumping { effort: 4.0 * sign(f) }
        }
        1 rotor { I blades { inertia: 2.5, initial_flow: 50.0 } R air { effort: 6.0 * sign(f) } }
        freewheel: Freewheel { capacity: 200.0 } (engine, rotor);
        output engine_speed: rad/s = engine.f;
        output rotor_speed: rad/s = rotor.f;
        output effort: N*m = freewheel.effort;
    }
}

/// Speeds of engine and rotor, and the effort between them: the engine, which 25 N·m drive for 6 s, catches up, takes the rotor along,
/// fails, and stands when the rotor still turns.
fn autorotation(t: f64) -> [f64; 3] {
    let met = (50.0 - 20.0) / (21.0 / 0.5 + 6.0 / 2.5);
    let (speed, gain) = (50.0 - 6.0 / 2.5 * met, (25.0 - 4.0 - 6.0) / 3.0);
    let left = |loss: f64| (speed + gain * (6.0 - met) - loss * (t - 6.0)).max(0.0);
    if t < met {
        [20.0 + 42.0 * t, 50.0 - 2.4 * t, 0.0]
    } else if t < 6.0 {
        let both = speed + gain * (t - met);
        [both, both, 6.0 + 2.5 * gain]
    } else {
        [left(4.0 / 0.5), left(6.0 / 2.5), 0.0]
    }
}

/// The largest error of what an integrator finds of that while the rotor turns.
fn worst_of_autorotation(solver: &impl Integrator<2>) -> f64 {
    let model = Autorotation::<f64>::new(AutorotationParameters::default()).unwrap();
    let drive = Pulse {
        amplitude: SVector::from([25.0]),
        start: 0.0,
        end: 6.0,
    };
    let times: Vec<f64> = (1..=370)
        .map(|place| 0.1 * f64::from(place) - 0.013)
        .collect();
    let mut worst = 0.0_f64;
    let start = model.initial_state();
    let run = solver.sample_outputs(&model, &drive, 0.0, start, &times, |t, _, y| {
        for (found, expected) in y.iter().zip(autorotation(t)) {
            worst = larger(worst, (found - expected).abs());
        }
    });
    assert!(run.is_ok_and(|run| run.steps < 5000), "{run:?}");
    worst
}

#[test]
fn a_rotor_runs_free_of_an_engine_that_fails() {
    let worst = [
        worst_of_autorotation(&Adaptive::new(Dop853, 1e-9, 1e-9)),
        worst_of_autorotation(&Adaptive::new(Rodas5P, 1e-9, 1e-9)),
        worst_of_autorotation(&Fixed::new(Rk4, 0.01)),
    ];
    assert!(worst.iter().all(|worst| *worst < 1e-6), "{worst:?}");
}
