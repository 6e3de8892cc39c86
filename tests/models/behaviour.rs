//! Small models against closed forms.

use mbg_runtime::{Constant, DormandPrince, System, mbg};
use nalgebra::SVector;

mbg! {
    /// Mass, spring and damper.
    pub(crate) model Oscillator {
        param mass: kg = 2.0;
        param stiffness: N/m = 50.0;
        param damping: N*s/m = 1.5;
        input force: N;
        1 velocity {
            I body { inertia: mass, initial_flow: 0.5 }
            C spring { stiffness: stiffness, initial: 0.1 }
            R damper { resistance: damping }
            Se drive { effort: force }
        }
        output position: m = spring.q;
    }

    /// Armature, gyrator, rotor, flexible shaft with gear, load.
    pub(crate) model Motor {
        param voltage: V = 24.0;
        1 armature {
            Se supply { effort: voltage }
            R winding { resistance: 0.8 }
            I inductance { inertia: 0.5e-3 }
        }
        1 rotor { I inertia { inertia: 2e-4 } R friction { resistance: 1e-4 } }
        0 twist;
        1 shaft { C spring { stiffness: 500.0 } R damper { resistance: 0.5 } }
        1 load { I flywheel { inertia: 0.15 } R bearing { resistance: 0.02 } }
        armature -> GY motor { effort: 0.05 } -> rotor;
        rotor -> TF gear { flow: 0.05 } -> twist;
        twist -> shaft;
        twist -> load;
        output current: A = armature.f;
        output motor_speed: rad/s = rotor.f;
        output load_speed: rad/s = load.f;
    }

    /// Two resistors between two capacitors and a source: a linear algebraic loop.
    pub(crate) model Ladder {
        param r1: ohm = 2.0;
        param r2: ohm = 3.0;
        1 first { Se supply { effort: 10.0 } R left { resistance: r1 } }
        0 middle { R right { resistance: r2 } }
        1 last { R series { resistance: 1.0 } C store { compliance: 0.5 } }
        first -> middle;
        middle -> last;
        output current = first.f;
    }
}

#[test]
fn oscillator_equals_its_closed_form() {
    let model = Oscillator::new(OscillatorParameters::default()).unwrap();
    let pair = DormandPrince::new(1e-11, 1e-13);
    let mut last = model.initial_state();
    pair.sample(
        &model,
        &Constant(SVector::from([0.0])),
        0.0,
        last,
        &[3.0],
        |_, x| last = *x,
    )
    .unwrap();
    let (decay, frequency) = (1.5_f64 / 4.0, (25.0_f64 - (1.5_f64 / 4.0).powi(2)).sqrt());
    let (sine, cosine) = (3.0 * frequency).sin_cos();
    let expected = f64::exp(-3.0 * decay) * (0.1 * cosine + (0.5 + decay * 0.1) / frequency * sine);
    assert!(
        f64::abs(last[1] - expected) < 1e-10,
        "{} {expected}",
        last[1]
    );
}

#[test]
fn motor_with_flexible_shaft_meets_the_reference() {
    let model = Motor::new(MotorParameters::default()).unwrap();
    let pair = DormandPrince::new(1e-10, 1e-13);
    let mut found = Vec::new();
    let times = [0.0005, 0.01, 0.1];
    pair.sample(
        &model,
        &Constant(SVector::from([])),
        0.0,
        model.initial_state(),
        &times,
        |t, x| {
            found.push(model.output(t, x, &SVector::from([]), &mut ()));
        },
    )
    .unwrap();
    let expected = [
        [
            16.503_125_703_450_607,
            1.166_592_822_375_093_3,
            3.891_588_616_484_076e-5,
        ],
        [
            26.539_311_929_863_478,
            58.334_720_812_006_22,
            0.205_776_942_216_468_13,
        ],
        [
            18.157_631_066_242,
            189.367_287_593_489_84,
            10.027_997_416_225_45,
        ],
    ];
    for (found, expected) in found.iter().zip(expected) {
        for k in 0..3 {
            assert!(
                f64::abs(found[k] - expected[k]) <= 1e-7 * f64::abs(expected[k]),
                "{found} {expected:?}"
            );
        }
    }
}

#[test]
fn ladder_solves_its_loop() {
    let model = Ladder::new(LadderParameters::default()).unwrap();
    let charge = SVector::from([1.0]);
    // Node voltage by superposition: (10/2 + 2/1) / (1/2 + 1/3 + 1).
    let node = (10.0 / 2.0 + 2.0) / (1.0 / 2.0 + 1.0 / 3.0 + 1.0);
    let rate = model.derivative(0.0, &charge, &SVector::from([]), &mut ());
    assert!(f64::abs(rate[0] - (node - 2.0)) < 1e-14);
}

mbg! {
    /// The oscillator with every bond drawn away from its element.
    pub(crate) model Outward {
        1 velocity;
        I body { inertia: 2.0, initial_flow: 0.5 } -> velocity;
        C spring { stiffness: 50.0, initial: 0.1 } -> velocity;
        R damper { resistance: 1.5 } -> velocity;
        output speed = velocity.f;
    }
}

#[test]
fn bonds_out_of_elements_conserve_energy_too() {
    let model = Outward::new(OutwardParameters::default()).unwrap();
    let (x, u) = (SVector::from([1.2, -0.07]), SVector::from([]));
    let rate = model.derivative(0.0, &x, &u, &mut ());
    let power = model.power(0.0, &x, &u, &mut ());
    // The common flow is that of the inertia; the spring, which sends power along its bond, is wound backwards.
    assert_eq!(model.output(0.0, &x, &u, &mut ())[0], 0.6);
    assert_eq!(rate[1], -0.6);
    let change = rate[0] * x[0] / 2.0 + rate[1] * x[1] * 50.0;
    assert!(f64::abs(change + power.dissipated) < 1e-14);
    assert!(f64::abs(power.dissipated - 1.5 * 0.36) < 1e-15);
}
