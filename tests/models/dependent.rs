//! Storages that depend on each other, in models small enough for a closed form.

use mbg_runtime::{Adaptive, Constant, Dop853, Dual, Integrator, System, mbg};
use nalgebra::{Matrix2, Matrix3, SVector, Vector2, Vector3};

use super::audit::{Probe, audit, near};
use super::energy::imbalance;
use crate::references::flywheels;

const EXACT: f64 = 1e-12;

mbg! {
    /// Two flywheels on one gearbox.
    #[derivative]
    pub(crate) model Flywheels {
        param first: kg*m^2 = 2.0;
        param second: kg*m^2 = 0.3;
        param damping: N*m*s/rad = 0.4;
        param other_damping: N*m*s/rad = 0.1;
        param ratio = -3.0;
        input torque[2]: N*m;
        1 motor {
            I wheel { inertia: first, initial_flow: 1.5 }
            R bearing { resistance: damping }
            Se drive { effort: torque.x }
        }
        1 load {
            I drum { inertia: second }
            R journal { resistance: other_damping }
            Se brake { effort: torque.y }
        }
        motor -> TF gearbox { flow: ratio } -> load;
        output rates[2]: rad/s = [motor.f, load.f];
        output momenta[2]: N*m*s = [wheel.p, drum.p];
    }

    /// Two capacitors in parallel, which discharge through a resistor.
    #[derivative]
    pub(crate) model Capacitors {
        param left: F = 0.5;
        param right: F = 1.5;
        param resistance: ohm = 2.0;
        0 node {
            C one { compliance: left, initial: 1.0 }
            C other { compliance: right }
            R leak { resistance: resistance }
        }
        output voltage: V = node.e;
        output charges[2]: C = [one.q, other.q];
    }

    /// A mass behind a gyrator is a compliance, which depends on the mass before it.
    #[derivative]
    pub(crate) model Gyrated {
        param mass: kg = 2.0;
        param compliance: F = 0.7;
        param ratio = 1.3;
        input force: N;
        1 body { I inertia { inertia: mass } R drag { resistance: 0.4 } Se push { effort: force } }
        0 node { C store { compliance: compliance } R leak { conductance: 0.2 } }
        body -> GY motor { effort: ratio } -> node;
        output speed: m/s = body.f;
        output charge: C = store.q;
    }

    /// A wheel drives another through a transmission whose ratio follows its angle.
    #[derivative]
    pub(crate) model Modulated {
        param first: kg*m^2 = 1.1;
        param second: kg*m^2 = 0.6;
        input torque: N*m;
        1 wheel {
            I own { inertia: first }
            C spring { stiffness: 4.0 }
            Se drive { effort: torque }
        }
        1 follower { I other { inertia: second } }
        wheel -> MTF gear { flow: 0.5 + 0.8 * sin(spring.q) } -> follower;
        output rate: rad/s = wheel.f;
        output angle: rad = spring.q;
    }

    /// The same through one whose ratio is a law of time.
    #[derivative]
    pub(crate) model Timed {
        param first: kg*m^2 = 1.1;
        param second: kg*m^2 = 0.6;
        input torque: N*m;
        1 wheel { I own { inertia: first } Se drive { effort: torque } }
        1 follower { I other { inertia: second } }
        wheel -> MTF gear { flow: 1.0 + 0.5 * sin(2.0 * t) } -> follower;
        output rate: rad/s = wheel.f;
    }

    /// A body with a full inertia matrix, turned about z by a law of time.
    #[derivative]
    pub(crate) model Driven {
        causality componentwise;
        input torque[3]: N*m;
        1 body[3] {
            I inertia { inertia: [[3.0, 0.4, 0.7], [0.4, 2.0, -0.3], [0.7, -0.3, 1.5]] }
            R air { resistance: 0.5 }
            Se drive { effort: torque }
        }
        Sf spindle { flow: 1.0 * sin(1.7 * t) } -> body.z;
        output rates[3]: rad/s = body.f;
        output momentum[3]: N*m*s = inertia.p;
    }

    /// A capacitor of three electrodes, one of which is at a voltage that is a law of time.
    #[derivative]
    pub(crate) model Electrodes {
        causality componentwise;
        0 node[3] {
            C field { stiffness: [[3.0, 0.4, 0.7], [0.4, 2.0, -0.3], [0.7, -0.3, 1.5]] }
            R leak { resistance: 0.5 }
        }
        Se supply { effort: 1.0 * cos(1.7 * t) } -> node.y;
        output voltages[3]: V = node.e;
        output charges[3]: C = field.q;
    }

    /// Two spinning bodies, the axes of one turned against those of the other, that share their angular velocity.
    #[derivative]
    pub(crate) model Joined {
        causality componentwise;
        input torque[3]: N*m;
        1 hull[3] coordinate {
            I own { inertia: diag(3.0, 2.0, 1.0), gyroscopic }
            Se drive { effort: torque }
        }
        1 pod[3] { I other { inertia: diag(0.5, 1.0, 0.7), gyroscopic } }
        hull -> MTF turn { flow: transpose(rot_x(0.4) * rot_y(-0.9)) } -> pod;
        output rates[3]: rad/s = hull.f;
    }

    /// Two mechanisms that have nothing to do with each other, with bonds drawn out of the storages.
    #[derivative]
    pub(crate) model Apart {
        1 first coordinate { Se push { effort: 2.0 } }
        1 second { R drag { resistance: 0.3 } }
        I heavy { inertia: 3.0 } -> first;
        I light { inertia: 0.5 } -> first;
        I left { inertia: 1.0 } -> second;
        second -> TF lever { flow: -2.0 } -> third;
        1 third;
        I right { inertia: 0.25 } -> third;
        output rates[2] = [first.f, second.f];
        output momenta[4] = [heavy.p, light.p, left.p, right.p];
    }

    /// A coupling whose law gives its flow by its torque joins an engine to a shaft with a gear. A measurement of the
    /// torque charges a capacitor, so that its rate is needed.
    #[derivative]
    pub(crate) model Slipping {
        causality componentwise;
        1 engine { I flywheel { inertia: 1.5, initial_flow: 3.0 } }
        0 coupling { R slip { flow: (exp(e) - exp(-e)) / 2 } }
        1 shaft { I rotor { inertia: 2.0 } R bearing { resistance: 0.4 } }
        engine -> coupling -> shaft;
        1 load { I drum { inertia: 0.5 } }
        shaft -> TF gear { flow: 3.0 } -> load;
        0 measured { Se sensor { effort: coupling.e } C store { compliance: 0.3 } }
        output rates[3] = [engine.f, shaft.f, load.f];
        output current = store.f;
    }

    /// A condenser microphone at a voltage: its charge follows from that, and the way of its plate is a state.
    #[derivative]
    pub(crate) model Microphone {
        param field = 0.4;
        param gap = 3.0;
        1 plate {
            I membrane { inertia: 2.0 }
            R air { resistance: 0.5 }
        }
        0 condenser[2] { C plates { energy: powi(q[0], 2) * (gap + q[1] * q[1]) / (2 * field) } }
        Se supply { effort: 4.0 + sin(2.0 * t) } -> condenser[0];
        plate -> condenser[1];
        output speed = plate.f;
        output charge = plates.q[0];
        output way = plates.q[1];
        output current = supply.f;
    }
}

/// An audit of a model, with what else is to hold at each state.
macro_rules! audited {
    ($model:ident, $parameters:ident, $inspect:expr) => {
        audit(
            &$model::<f64>::new($parameters::default()).unwrap(),
            &$model::new($parameters::default()).unwrap(),
            $inspect,
        )
    };
}

#[test]
fn flywheels_turn_as_one() {
    let closed = flywheels::Flywheels {
        inertia: [2.0, 0.3],
        damping: [0.4, 0.1],
        ratio: -3.0,
    };
    audited!(Flywheels, FlywheelsParameters, |probe: &Probe<_, 1, 2>| {
        let [omega, other, momentum, other_momentum] = probe.outputs().into();
        let torque = [probe.input[0], probe.input[1]];
        near(omega.slope, closed.acceleration(omega.value, torque), EXACT);
        near(other.value, -3.0 * omega.value, EXACT);
        near(momentum.value, 2.0 * omega.value, EXACT);
        near(other_momentum.value, 0.3 * other.value, EXACT);
    });
    let model = Flywheels::new(FlywheelsParameters::default()).unwrap();
    let mut state = model.initial_state();
    let start = model.output(0.0, &state, &SVector::zeros(), &mut ())[0];
    let torque = Constant(SVector::from([5.0, -1.0]));
    let solver = Adaptive::new(Dop853, 1e-12, 1e-14);
    solver
        .sample(&model, &torque, 0.0, state, &[2.0], |_, x| state = *x)
        .unwrap();
    let end = model.output(2.0, &state, &SVector::zeros(), &mut ())[0];
    near(end, closed.omega(start, [5.0, -1.0], 2.0), 1e-10);
    assert!(imbalance(&model, &torque, 1e-3, 2000) < 1e-12);
}

#[test]
fn capacitors_in_parallel_are_one() {
    audited!(Capacitors, CapacitorsParameters, |probe: &Probe<
        _,
        1,
        0,
    >| {
        let [voltage, one, other] = probe.outputs().into();
        near(voltage.slope, -voltage.value / (2.0 * 2.0), EXACT);
        near(one.value, 0.5 * voltage.value, EXACT);
        near(other.value, 1.5 * voltage.value, EXACT);
    });
    let model = Capacitors::new(CapacitorsParameters::default()).unwrap();
    let voltage = |x| model.output(0.0, &x, &SVector::zeros(), &mut ())[0];
    let start = model.initial_state();
    let mut end = start;
    Adaptive::new(Dop853, 1e-12, 1e-14)
        .sample(&model, &(), 0.0, start, &[3.0], |_, x| end = *x)
        .unwrap();
    near(voltage(end), voltage(start) * f64::exp(-3.0 / 4.0), 1e-10);
    assert!(voltage(start) != 0.0);
}

#[test]
fn a_compliance_behind_a_gyrator_adds_to_the_mass() {
    audited!(Gyrated, GyratedParameters, |probe: &Probe<_, 1, 1>| {
        let [speed, charge] = probe.outputs().into();
        let square = 1.3 * 1.3;
        let force = probe.input[0] - (0.4 + square * 0.2) * speed.value;
        near(speed.slope, force / (2.0 + square * 0.7), EXACT);
        near(charge.value, 0.7 * 1.3 * speed.value, EXACT);
    });
}

#[test]
fn an_inertia_behind_a_modulated_transformer_needs_the_rate_of_the_modulus() {
    audited!(Modulated, ModulatedParameters, |probe: &Probe<_, 2, 1>| {
        let [rate, angle] = probe.outputs().into();
        let (sine, cosine) = angle.value.sin_cos();
        let (ratio, slope) = (0.5 + 0.8 * sine, 0.8 * cosine);
        let torque = probe.input[0] - 4.0 * angle.value - ratio * slope * 0.6 * rate.value.powi(2);
        near(rate.slope, torque / (1.1 + ratio * ratio * 0.6), EXACT);
        near(angle.slope, rate.value, EXACT);
    });
    let model = Modulated::new(ModulatedParameters::default()).unwrap();
    assert!(imbalance(&model, &Constant(SVector::from([2.0])), 1e-3, 5000) < 1e-11);
}

#[test]
fn a_modulus_of_time_has_a_rate_too() {
    audited!(Timed, TimedParameters, |probe: &Probe<_, 1, 1>| {
        let [rate]: [Dual<f64>; 1] = probe.outputs().into();
        let (sine, cosine) = (2.0 * probe.time).sin_cos();
        let (ratio, change) = (1.0 + 0.5 * sine, cosine);
        let torque = probe.input[0] - ratio * change * 0.6 * rate.value;
        near(rate.slope, torque / (1.1 + ratio * ratio * 0.6), EXACT);
    });
}

#[test]
fn what_a_law_gives_by_iteration_is_imposed_on_no_storage() {
    audited!(Slipping, SlippingParameters, |probe: &Probe<_, 2, 0>| {
        let [engine, shaft, load, current] = probe.outputs().into();
        let slip = engine.value - shaft.value;
        let torque = slip.asinh();
        let changes = [
            -torque / 1.5,
            (torque - 0.4 * shaft.value) / (2.0 + 9.0 * 0.5),
        ];
        near(engine.slope, changes[0], EXACT);
        near(shaft.slope, changes[1], EXACT);
        near(load.value, 3.0 * shaft.value, EXACT);
        let change = (changes[0] - changes[1]) / (1.0 + slip * slip).sqrt();
        near(current.value, 0.3 * change, EXACT);
    });
    let model = Slipping::new(SlippingParameters::default()).unwrap();
    assert!(imbalance(&model, &Constant(SVector::zeros()), 1e-3, 2000) < 1e-11);
}

#[test]
fn of_a_law_that_is_linear_in_what_is_lost_alone_the_rest_stays_a_state() {
    audited!(Microphone, MicrophoneParameters, |probe: &Probe<
        _,
        2,
        0,
    >| {
        let [speed, charge, way, current] = probe.outputs().into();
        let (sine, cosine) = (2.0 * probe.time).sin_cos();
        let (voltage, change) = (4.0 + sine, 2.0 * cosine);
        let gap = 3.0 + way.value * way.value;
        near(charge.value, 0.4 * voltage / gap, EXACT);
        near(way.slope, speed.value, EXACT);
        let force = charge.value * charge.value * way.value / 0.4;
        near(speed.slope, (-force - 0.5 * speed.value) / 2.0, EXACT);
        let opening = 2.0 * way.value * speed.value;
        let expected = 0.4 * (change / gap - voltage * opening / (gap * gap));
        near(current.value, expected, EXACT);
        near(charge.slope, expected, EXACT);
    });
}

/// The matrix of the multiports, and the part of it that belongs to x and y, or x and z.
const FIELD: Matrix3<f64> = Matrix3::new(3.0, 0.4, 0.7, 0.4, 2.0, -0.3, 0.7, -0.3, 1.5);

#[test]
fn a_multiport_inertia_may_depend_in_part() {
    audited!(Driven, DrivenParameters, |probe: &Probe<_, 2, 3>| {
        let outputs = probe.outputs();
        let rates = Vector3::from_fn(|row, _| outputs[row].value);
        let changes = Vector3::from_fn(|row, _| outputs[row].slope);
        near(rates.z, (1.7 * probe.time).sin(), EXACT);
        near(changes.z, 1.7 * (1.7 * probe.time).cos(), EXACT);
        let torque = probe.input.fixed_rows::<2>(0) - rates.fixed_rows::<2>(0) * 0.5;
        let coupling = Vector2::new(FIELD[(0, 2)], FIELD[(1, 2)]) * changes.z;
        let own: Matrix2<f64> = FIELD.fixed_view::<2, 2>(0, 0).into_owned();
        let expected = own.try_inverse().unwrap() * (torque - coupling);
        let momentum = FIELD * rates;
        for row in 0..2 {
            near(changes[row], expected[row], EXACT);
        }
        for row in 0..3 {
            near(outputs[3 + row].value, momentum[row], EXACT);
        }
    });
}

#[test]
fn a_multiport_compliance_may_depend_in_part() {
    audited!(Electrodes, ElectrodesParameters, |probe: &Probe<
        _,
        2,
        0,
    >| {
        let outputs = probe.outputs();
        let voltages = Vector3::from_fn(|row, _| outputs[row].value);
        let charges = Vector3::from_fn(|row, _| outputs[3 + row].value);
        let expected = FIELD * charges;
        near(voltages.y, (1.7 * probe.time).cos(), EXACT);
        for row in 0..3 {
            near(voltages[row], expected[row], EXACT);
        }
        for row in [0, 2] {
            near(outputs[3 + row].slope, -voltages[row] / 0.5, EXACT);
        }
    });
}

#[test]
fn a_coordinate_of_three_components_turns_two_bodies() {
    let turn = (mbg_runtime::attitude::rotation_xyz(&Vector3::new(0.4, -0.9, 0.0))).transpose();
    let own = Matrix3::from_diagonal(&Vector3::new(3.0, 2.0, 1.0));
    let other = Matrix3::from_diagonal(&Vector3::new(0.5, 1.0, 0.7));
    let inertia: Matrix3<f64> = own + turn.transpose() * other * turn;
    audited!(Joined, JoinedParameters, |probe: &Probe<_, 3, 3>| {
        let outputs = probe.outputs();
        let omega = Vector3::from_fn(|row, _| outputs[row].value);
        let torque = probe.input - omega.cross(&(inertia * omega));
        let expected = inertia.try_inverse().unwrap() * torque;
        for row in 0..3 {
            near(outputs[row].slope, expected[row], EXACT);
        }
    });
}

#[test]
fn mechanisms_apart_do_not_mix_and_reversed_bonds_do_not_matter() {
    audited!(Apart, ApartParameters, |probe: &Probe<_, 2, 0>| {
        let outputs = probe.outputs();
        let [first, second] = [outputs[0], outputs[1]];
        near(first.slope, 2.0 / 3.5, EXACT);
        near(second.slope, -0.3 * second.value / 2.0, EXACT);
        let momenta = [
            3.0 * first.value,
            0.5 * first.value,
            second.value,
            -0.5 * second.value,
        ];
        for (row, momentum) in momenta.into_iter().enumerate() {
            near(outputs[2 + row].value, momentum, EXACT);
        }
    });
}
