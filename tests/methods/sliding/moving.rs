//! Thresholds that bend and jump on their way, with motions that stay at them.

use mbg_runtime::{System, mbg};

use super::several::by_all;

mbg! {
    /// A block on a table whose speed rises and falls evenly.
    model Swung {
        param period: s = 0.5;
        1 block { I mass { inertia: 1.0 } }
        0 contact; Sf table { flow: 0.3 * abs(mod(t, period) / period - 0.5) } -> contact;
        1 slip; contact -> slip; contact -> block;
        rub: Brake { capacity: 1.1 } (slip);
        output speed: m/s = block.f;
    }

    /// The same by the angle of a shaft.
    model SwungByShaft {
        1 shaft { I rotor { inertia: 1.0, initial_flow: 1.0 } }
        integral angle = shaft.f;
        1 block { I mass { inertia: 1.0 } }
        0 contact; Sf table { flow: 0.3 * abs(mod(angle, 0.5) / 0.5 - 0.5) } -> contact;
        1 slip; contact -> slip; contact -> block;
        rub: Brake { capacity: 1.1 } (slip);
        output speed = block.f;
    }

    /// One whose speed goes up in steps.
    model Stepped {
        param period: s = 0.5;
        1 block { I mass { inertia: 1.0 } }
        0 contact; Sf table { flow: 0.1 * floor(t / period) } -> contact;
        1 slip; contact -> slip; contact -> block;
        rub: Brake { capacity: 1.1 } (slip);
        output speed: m/s = block.f;
    }

    /// The same by the angle of a shaft.
    model SteppedByShaft {
        1 shaft { I rotor { inertia: 1.0, initial_flow: 1.0 } }
        integral angle = shaft.f;
        1 block { I mass { inertia: 1.0 } }
        0 contact; Sf table { flow: 0.1 * floor(angle / 0.5) } -> contact;
        1 slip; contact -> slip; contact -> block;
        rub: Brake { capacity: 1.1 } (slip);
        output speed = block.f;
    }

    /// A current that is switched along a sawtooth.
    model Sawtooth {
        param period: s = 0.03;
        1 coil {
            I inductance { inertia: 1.0 }
            Se switched { effort: if f < 0.05 - 0.03 * mod(t, period) / period { 1.0 } else { -1.2 } }
        }
        output current: A = coil.f;
    }

    /// The same by the angle of a shaft.
    model SawtoothByShaft {
        1 shaft { I rotor { inertia: 1.0, initial_flow: 1.0 } }
        integral angle = shaft.f;
        1 coil {
            I inductance { inertia: 1.0 }
            Se switched { effort: if f < 0.05 - mod(angle, 0.03) { 1.0 } else { -1.2 } }
        }
        output current = coil.f;
    }

    /// Brakes on two shafts that a torque tears loose at one time, and a clutch between these.
    model Together {
        1 motor { I rotor { inertia: 0.02 } Se torque { effort: 3.0 * t } }
        1 load { I wheel { inertia: 0.05 } Se pull { effort: 1.0 } }
        near: Brake { capacity: 0.5 } (motor);
        far: Brake { capacity: 0.8 } (load);
        between: Clutch { capacity: 1.0 } (motor, load);
        output speeds[2]: rad/s = [motor.f, load.f];
    }
}

/// The output of a model by each method at a time.
fn check<const N: usize>(model: &impl System<f64, N, 0, 1>, cases: &[(f64, f64)], step: f64) {
    for (time, expected) in cases {
        for (name, _, outputs) in by_all(model, *time, 1e-10, step) {
            let error = outputs[0] - expected;
            assert!(error.abs() < 1e-9, "{name} at {time}: {error:e}");
        }
    }
}

/// Friction takes it along as fast as the table, once it has caught up.
#[test]
fn a_block_follows_a_table_around_corners() {
    let speed = |t: f64| 0.3 * (2.0 * (t % 0.5) - 0.5).abs();
    let cases = [0.3, 0.49, 0.55, 1.26, 1.73].map(|t| (t, speed(t)));
    check(
        &Swung::new(SwungParameters::default()).unwrap(),
        &cases,
        0.017,
    );
    check(
        &SwungByShaft::new(SwungByShaftParameters::default()).unwrap(),
        &cases,
        0.017,
    );
}

/// Behind a jump of the table's speed friction is 1.1 N until it has caught up.
#[test]
fn a_block_catches_up_behind_each_step_of_a_table() {
    let cases = [
        (0.49, 0.0),
        (0.55, 0.055),
        (0.6, 0.1),
        (1.52, 0.222),
        (1.73, 0.3),
    ];
    check(
        &Stepped::new(SteppedParameters::default()).unwrap(),
        &cases,
        0.017,
    );
    check(
        &SteppedByShaft::new(SteppedByShaftParameters::default()).unwrap(),
        &cases,
        0.017,
    );
}

/// It falls along the sawtooth, and rises at its own rate behind each tooth.
#[test]
fn a_current_follows_a_sawtooth() {
    let cases = [
        (0.028, 0.022),
        (0.04, 0.03),
        (0.05, 0.03),
        (0.301, 0.021),
        (0.315, 0.035),
    ];
    check(
        &Sawtooth::new(SawtoothParameters::default()).unwrap(),
        &cases,
        1.7e-3,
    );
    check(
        &SawtoothByShaft::new(SawtoothByShaftParameters::default()).unwrap(),
        &cases,
        1.7e-3,
    );
}

/// The brakes take no more at 0.1 s; from 0.66 s on the clutch slips, too.
#[test]
fn brakes_let_go_at_one_time() {
    let model = Together::new(TogetherParameters::default()).unwrap();
    for (name, _, speeds) in by_all(&model, 1.0, 1e-10, 0.01) {
        let together = 1.5 * 0.56 * 0.56 / 0.07;
        let motor = together + (1.5 * (1.0 - 0.66 * 0.66) - 1.5 * 0.34) / 0.02;
        let load = together + (1.0 - 0.8 + 1.0) * 0.34 / 0.05;
        let errors = [speeds[0] - motor, speeds[1] - load];
        assert!(
            errors.iter().all(|error| error.abs() < 1e-9),
            "{name}: {errors:?}"
        );
    }
}
