//! More thresholds at once than most machines have.

use mbg_runtime::{Adaptive, Constant, Radau9, mbg};
use nalgebra::SVector;

use super::{NINE, last};

/// So many clutches.
const CLUTCHES: f64 = 36.0;

mbg! {
    /// Shafts in a row with a clutch between each two, driven at the first.
    model Row {
        input drive: N*m;
        shafts: for k in 0..37 {
            1 shaft {
                I disk { inertia: 1.0 + 0.1 * k }
                R bearing { resistance: 0.05 }
            }
        }
        clutches: for k in 0..36 {
            clutch: Clutch { capacity: 5.0 + 0.2 * k } (shafts[k].shaft, shafts[k + 1].shaft);
        }
        Se engine { effort: drive } -> shafts[0].shaft;
        output first: rad/s = shafts[0].shaft.f;
        output second: rad/s = shafts[1].shaft.f;
        output last: rad/s = shafts[36].shaft.f;
    }
}

/// The speed after 2 s of shafts that turn together, so many from the last one, driven by a torque.
fn speed(shafts: f64, torque: f64) -> f64 {
    let left = CLUTCHES + 1.0 - shafts;
    let inertia = shafts * (1.0 + 0.05 * (left + CLUTCHES));
    let damping = 0.05 * shafts;
    torque / damping * (1.0 - (-2.0 * damping / inertia).exp())
}

/// The outputs after 2 s, by a method of two kinds.
fn turned(drive: f64) -> [SVector<f64, 3>; 2] {
    let model = Row::<f64>::new(RowParameters::default()).unwrap();
    let input = Constant([drive].into());
    let implicit = Adaptive::new(Radau9, 1e-9, 1e-11);
    [
        last(&model, &input, 2.0, &NINE).1,
        last(&model, &input, 2.0, &implicit).1,
    ]
}

#[test]
fn thirty_six_clutches_hold_at_once() {
    let speed = speed(37.0, 4.0);
    for outputs in turned(4.0) {
        assert!(
            outputs.iter().all(|it| (it - speed).abs() < 1e-8),
            "{outputs} {speed}"
        );
    }
}

/// The first one slips, and drags the others with what it takes at most.
#[test]
fn all_but_one_of_thirty_six_clutches_hold() {
    let first = 15.0 / 0.05 * (1.0 - (-2.0_f64 * 0.05).exp());
    let expected = SVector::from([first, speed(36.0, 5.0), speed(36.0, 5.0)]);
    for outputs in turned(20.0) {
        assert!((outputs - expected).amax() < 1e-7, "{outputs} {expected}");
    }
}
