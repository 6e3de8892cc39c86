//! Small models against closed forms.

use mbg_runtime::{Adaptive, Constant, Dop853, Integrator, Radau5, System, mbg};
use nalgebra::{SMatrix, SVector};

use crate::dc_motor::{Motor, MotorParameters, REFERENCE, brake, error};

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
    let solver = Adaptive::new(Dop853, 1e-11, 1e-13);
    let mut last = model.initial_state();
    solver
        .sample(
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
    let solver = Adaptive::new(Dop853, 1e-11, 1e-14);
    let mut reference = REFERENCE.iter();
    solver
        .sample(
            &model,
            &brake(),
            0.0,
            model.initial_state(),
            &REFERENCE.map(|instant| instant.time),
            |time, x| {
                let output = model.output(time, x, &SVector::zeros(), &mut ());
                let error = error(&output, reference.next().unwrap());
                assert!(error < 1e-9, "{error:e} at {time}");
            },
        )
        .unwrap();
    assert!(reference.next().is_none());
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

mbg! {
    /// Two flywheels on one gearbox: one state.
    pub(crate) model Gearbox {
        param ratio = 4.0;
        param motor: kg*m^2 = 2.0;
        param load: kg*m^2 = 3.0;
        input torque: N*m;
        1 fast { I rotor { inertia: motor } Se drive { effort: torque } }
        1 slow { #[derivative] I drum { inertia: load, initial_flow: 1.0 } }
        fast -> TF gear { flow: ratio } -> slow;
        output momentum = drum.p;
        output effort = drum.e;
    }
}

#[test]
fn a_storage_that_follows_from_another_is_told() {
    let model = Gearbox::<f64>::new(GearboxParameters::default()).unwrap();
    let meta = Gearbox::<f64>::META;
    assert_eq!(meta.states.len(), 1);
    assert_eq!(meta.eliminated[0].state, "drum.p");
    assert_eq!(meta.eliminated[0].relation, "load ratio 1/motor rotor.p");
    assert_eq!(
        meta.notes[0],
        "`drum.p` is not 3.0 at the start but 0.0: it follows from other states"
    );
    // Seen from the rotor the drum weighs load ratio².
    let (x, u) = (SVector::from([5.0]), SVector::from([7.0]));
    let acceleration = 7.0 / (2.0 + 3.0 * 16.0);
    let rate = model.derivative(0.0, &x, &u, &mut ());
    assert!(f64::abs(rate[0] - 2.0 * acceleration) < 1e-15);
    let output = model.output(0.0, &x, &u, &mut ());
    assert!(f64::abs(output[0] - 3.0 * 4.0 * 2.5) < 1e-13);
    assert!(f64::abs(output[1] - 3.0 * 4.0 * acceleration) < 1e-14);
}

mbg! {
    /// A ball over a floor after Hertz, with the damping of Tsuji, Tanaka and Ishida, Powder Technology 71 (1992), whose
    /// slope is infinite where the contact begins.
    pub(crate) model Dropped {
        1 upwards {
            I ball { inertia: 0.5, initial_flow: -1.0 }
            C floor { effort: -1e5 * pow(max(-q, 0.0), 1.5), initial: 0.05 }
            R loss { effort: 3.0 * pow(max(-floor.q, 0.0), 0.25) * f }
            Se weight { effort: -4.905 }
        }
    }
}

/// Above the floor nothing depends on the height, whatever slope the laws have at the contact.
#[test]
fn a_ball_falls_on_a_floor() {
    let model = Dropped::new(DroppedParameters::default()).unwrap();
    let start = model.initial_state();
    let nothing = SVector::zeros();
    let falling = model.jacobian_state(0.0, &start, &nothing, &mut ());
    assert_eq!(falling, SMatrix::from([[0.0, 2.0], [0.0, 0.0]]));
    let mut ends = [start; 2];
    Adaptive::new(Dop853, 1e-10, 1e-12)
        .integrate(&model, &(), 0.0, 0.5, start, |step| ends[0] = *step.state())
        .unwrap();
    Adaptive::new(Radau5, 1e-10, 1e-12)
        .integrate(&model, &(), 0.0, 0.5, start, |step| ends[1] = *step.state())
        .unwrap();
    assert!((ends[0] - ends[1]).norm() < 1e-8, "{ends:?}");
    assert!(model.energy(0.0, &ends[0]) < model.energy(0.0, &start));
}
