//! Rates that joints are given for the start, where the momenta of bodies are the states.

use mbg_runtime::{Convertible, System, mbg};
use nalgebra::{Rotation3, SVector, Vector3};

use crate::references::errors::apart;

mbg! {
    /// A body that is thrown, and turns about a point beside its centre.
    pub model Thrown {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        param spin: rad/s = 0.7;
        param mass: kg = 2.0;
        1 ground[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        1 frame[6];
        flight: Free {
            orientation: quaternion, initial: [0.3, -0.2, 0.4], initial_rate: [spin, 0.2, -0.5],
            initial_position: [1.0, 0.0, 2.0], initial_velocity: [1.0, -2.0, 3.0]
        } (ground, frame);
        body: Body { mass: mass, inertia: diag(1.0, 2.0, 2.5), centre: [0.1, 0.0, -0.2] } (frame);
        output rate[3]: rad/s = flight.rotation.rate.f;
        output velocity[3]: m/s = flight.velocity.f;
    }

    /// A top on its tip, by gimbal angles, on a table that turns.
    #[derivative]
    pub model TopOnTable {
        causality componentwise;
        param table: rad/s = 0.4;
        1 ground[6];
        Sf turning[6] { flow: [0.0, 0.0, table, 0.0, 0.0, 0.0] } -> ground;
        1 frame[6];
        tip: Spherical { first: 2, second: 0, third: 2, initial: [0.1, 0.5, 0.2], initial_rate: [0.3, 0.0, 30.0] } (ground, frame);
        body: Body { mass: 1.0, inertia: diag(0.2, 0.2, 0.1) } (frame);
        output rate[3] = tip.rotation.gimbal.rate.f;
    }

    /// A tug and what floats behind it: two bodies, of which only the first is given a rate.
    pub model Tug {
        causality componentwise;
        1 space[6];
        Sf fixed[6] { flow: 0.0 } -> space;
        1 tug[6];
        flight: Free { orientation: matrix, initial_rate: [0.0, 0.0, 0.5], initial_velocity: [7.0, 0.0, 0.0] } (space, tug);
        hull: Body { mass: 3.0, inertia: diag(1.0, 2.0, 3.0) } (tug);
        1 load[6];
        behind: Free { orientation: quaternion, initial_position: [-4.0, 0.0, 0.0], stiffness: 2.0 } (tug, load);
        cargo: Body { mass: 1.0, inertia: diag(0.3, 0.2, 0.1) } (load);
        output rate[3] = behind.rotation.rate.f;
        output velocity[3] = behind.velocity.f;
        output own[6] = tug.f;
    }

    /// Momenta that are given themselves stay what they are, even zero.
    pub model Given {
        1 rate coordinate, initial_flow: 3.0 { I wheel { inertia: 2.0, initial: 1.0 } }
        1 other coordinate, initial_flow: 3.0 { I rotor { inertia: 2.0, initial: 0.0 } }
        output turning[2] = [rate.f, other.f];
    }

    /// Storages that are given their efforts, which their laws begin with in one unit or two, as numbers or matrices.
    pub model Loaded {
        param voltage: V = 9.0;
        param capacitance: F = 2e-3;
        0 wire { C capacitor { compliance: capacitance, initial_effort: voltage } R leak { resistance: 50.0 } }
        1 slide { C spring { effort: 2.0 + 4.0 * q, initial_effort: 5.0 } R damper { resistance: 1.0 } }
        1 plane[2] {
            C seat { stiffness: [[2.0, 1.0], [1.0, 3.0]], initial_effort: [7.0, 0.5 * voltage] }
            R mount { resistance: 1.0 }
        }
        output voltage_begun: V = wire.e;
        output force = spring.e;
        output forces[2] = seat.e;
        output charge: C = capacitor.q;
    }

    /// Orientations that are parameters, at which single entries of rotations may vanish.
    pub model Turned {
        causality componentwise;
        param yaw: rad = 0.0;
        1 ground[6];
        1 frame[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        one: Free {
            orientation: quaternion, initial: [yaw, 0.0, yaw], initial_rate: [0.1, 0.2, 0.3], initial_velocity: [1.0, -2.0, 3.0]
        } (ground, frame);
        body: Body { mass: 2.0, inertia: 1.0, centre: [0.1, 0.2, 0.3] } (frame);
        1 follower[6];
        two: Free { initial: [0.0, 0.3, yaw], initial_rate: [0.4, 0.5, 0.6], initial_velocity: [4.0, 5.0, 6.0] } (frame, follower);
        load: Body { mass: 2.0, inertia: 1.0, centre: [0.1, 0.2, 0.3] } (follower);
        output found[12] = [
            one.rotation.rate.f.x, one.rotation.rate.f.y, one.rotation.rate.f.z,
            one.velocity.f.x, one.velocity.f.y, one.velocity.f.z,
            two.rotation.gimbal.rate.f.x, two.rotation.gimbal.rate.f.y, two.rotation.gimbal.rate.f.z,
            two.velocity.f.x, two.velocity.f.y, two.velocity.f.z
        ];
    }

    /// What hangs on a hinge that gives way a little, on a body that is thrown.
    pub model Towed {
        causality componentwise;
        1 ground[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        1 frame[6];
        1 arm[6];
        flight: Free { orientation: quaternion, initial_rate: [0.1, 0.2, 0.3], initial_velocity: [1.0, -2.0, 3.0] } (ground, frame);
        hull: Body { mass: 2.0, inertia: 1.0 } (frame);
        hinge: Revolute { axis: 2, initial: 0.4, initial_rate: 0.5, blocked: compliant } (frame, arm);
        load: Body { mass: 1.0, inertia: 1.0 } (arm);
        output relative[6] = [
            arm.f.x - cos(0.4) * frame.f.x - sin(0.4) * frame.f.y,
            arm.f.y + sin(0.4) * frame.f.x - cos(0.4) * frame.f.y,
            arm.f.z - frame.f.z,
            arm.f[3] - cos(0.4) * frame.f[3] - sin(0.4) * frame.f[4],
            arm.f[4] + sin(0.4) * frame.f[3] - cos(0.4) * frame.f[4],
            arm.f[5] - frame.f[5]
        ];
    }

    /// A table that does not turn unless a parameter says so.
    pub model Table {
        causality componentwise;
        param table: rad/s = 0.0;
        1 ground[6];
        Sf turning[6] { flow: [0.0, 0.0, table, 0.0, 0.0, 0.0] } -> ground;
        1 frame[6];
        tip: Free { orientation: quaternion, initial_position: [1.0, 0.0, 0.0] } (ground, frame);
        body: Body { mass: 1.0, inertia: diag(0.2, 0.2, 0.1) } (frame);
        output rates[6] = [
            tip.rotation.rate.f.x, tip.rotation.rate.f.y, tip.rotation.rate.f.z,
            tip.velocity.f.x, tip.velocity.f.y, tip.velocity.f.z
        ];
    }
}

/// States by the beginning of their names.
fn named<const N: usize>(meta: &mbg_runtime::Meta, state: &[f64], name: &str) -> [f64; N] {
    let first = meta.states.iter().position(|it| it.name.starts_with(name));
    state[first.unwrap()..][..N].try_into().unwrap()
}

#[test]
fn storages_start_with_the_efforts_they_are_given() {
    for voltage in [9.0, -0.3] {
        let parameters = LoadedParameters {
            voltage,
            ..Default::default()
        };
        let model = Loaded::<f64>::new(parameters).unwrap();
        let found = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
        let expected = [voltage, 5.0, 7.0, 0.5 * voltage, 2e-3 * voltage];
        assert!(apart(found.as_slice(), &expected) < 4e-15, "{found}");
    }
}

#[test]
fn a_thrown_body_starts_with_the_momenta_of_its_rates() {
    for (spin, mass) in [(0.7, 2.0), (-3.0, 5.0)] {
        let model = Thrown::new(ThrownParameters { spin, mass }).unwrap();
        let start = model.initial_state();
        let output = model.output(0.0, &start, &SVector::zeros(), &mut ());
        let (rate, velocity) = (Vector3::new(spin, 0.2, -0.5), Vector3::new(1.0, -2.0, 3.0));
        assert!(apart(&output.as_slice()[..3], rate.as_slice()) < 1e-15);
        assert!(apart(&output.as_slice()[3..], velocity.as_slice()) < 4e-15);
        let about = |axis: Vector3<f64>, angle: f64| Rotation3::new(axis * angle);
        let turn = about(Vector3::x(), 0.3) * about(Vector3::y(), -0.2) * about(Vector3::z(), 0.4);
        let inertia = Vector3::new(1.0, 2.0, 2.5);
        let spinning = inertia.component_mul(&rate);
        let at_centre = turn.inverse() * velocity + rate.cross(&Vector3::new(0.1, 0.0, -0.2));
        let states = start.as_slice();
        let found = named::<3>(Thrown::<f64>::META, states, "body.spin");
        assert!(apart(&found, spinning.as_slice()) < 1e-14);
        let found = named::<3>(Thrown::<f64>::META, states, "body.body");
        assert!(apart(&found, (mass * at_centre).as_slice()) < 4e-14);
    }
}

#[test]
fn a_top_on_a_table_starts_with_its_rates_against_the_table() {
    for table in [0.4, -2.0] {
        let model = TopOnTable::new(TopOnTableParameters { table }).unwrap();
        let output = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
        assert!(apart(output.as_slice(), &[0.3, 0.0, 30.0]) < 1e-13);
    }
}

/// What is given no rate has none against what it hangs on, rather than none in space.
#[test]
fn what_floats_behind_starts_with_what_it_floats_behind() {
    let model = Tug::new(TugParameters::default()).unwrap();
    let output = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
    let expected = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 7.0, 0.0, 0.0];
    assert!(apart(output.as_slice(), &expected) < 1e-14);
    let momentum = named::<3>(
        Tug::<f64>::META,
        model.initial_state().as_slice(),
        "cargo.body",
    );
    assert!(apart(&momentum, &[7.0, -2.0, 0.0]) < 1e-14);
}

#[test]
fn a_momentum_that_is_given_is_kept() {
    let model = Given::new(GivenParameters::default()).unwrap();
    assert_eq!(model.initial_state(), SVector::from([1.0, 0.0]));
}

#[test]
fn rates_are_kept_at_every_orientation() {
    use std::f64::consts::FRAC_PI_2;
    let expected = [0.1, 0.2, 0.3, 1.0, -2.0, 3.0, 0.4, 0.5, 0.6, 4.0, 5.0, 6.0];
    for yaw in [0.0, 1.0, FRAC_PI_2, -FRAC_PI_2, 2.0 * FRAC_PI_2, 1.57] {
        let model = Turned::new(TurnedParameters { yaw }).unwrap();
        let output = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
        assert!(apart(output.as_slice(), &expected) < 1e-13, "{yaw}");
        let single = model.converted(|it| it as f32);
        let output = single.output(0.0, &single.initial_state(), &SVector::zeros(), &mut ());
        let output = output.map(f64::from);
        assert!(apart(output.as_slice(), &expected) < 1e-5, "{yaw}");
    }
}

#[test]
fn rates_are_kept_whatever_a_parameter_is_by_default() {
    let model = Table::new(TableParameters { table: 0.5 }).unwrap();
    let output = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
    assert!(apart(output.as_slice(), &[0.0; 6]) < 1e-15);
}

/// Bearings of a compliant joint do not move at the start.
#[test]
fn what_hangs_on_a_compliant_joint_starts_with_what_it_hangs_on() {
    let model = Towed::new(TowedParameters::default()).unwrap();
    let output = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
    assert!(apart(output.as_slice(), &[0.0, 0.0, 0.5, 0.0, 0.0, 0.0]) < 1e-14);
}
