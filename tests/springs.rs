//! Springs of joints with several axes: quaternions and rotation matrices with a stiffness in three axes, and bearings that
//! couple theirs.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
use nalgebra::{Matrix3, Rotation3, SVector, UnitQuaternion, Vector3};

mbg! {
    component Held() {
        param orientation: quaternion | matrix;
        param stiffness: N*m/rad;
        1 hub[6];
        1 blade[6];
        Sf fixed[6] { flow: 0.0 } -> hub;
        joint: Spherical {
            orientation: orientation, stiffness: stiffness, rest: [0.3, -0.2, 0.1], initial: [0.5, 1.6, -0.4],
            initial_rate: [4.0, -7.0, 9.0]
        } (hub, blade);
        body: Body { mass: 2.0, inertia: diag(1.0, 2.0, 2.5) } (blade);
    }

    #[derivative]
    pub model ByQuaternion {
        causality componentwise;
        let rigid = [[100.0, 30.0, -20.0], [30.0, 400.0, 50.0], [-20.0, 50.0, 900.0]];
        bearing: Held { orientation: quaternion, stiffness: rigid } ();
        output torque[3]: N*m = bearing.joint.rotation.spring.e;
        output quaternion[4] = bearing.joint.quaternion;
    }

    #[derivative]
    pub model ByMatrix {
        causality componentwise;
        let rigid = [[100.0, 30.0, -20.0], [30.0, 400.0, 50.0], [-20.0, 50.0, 900.0]];
        bearing: Held { orientation: matrix, stiffness: rigid } ();
    }

    #[derivative]
    pub model ByNumber {
        causality componentwise;
        bearing: Held { orientation: quaternion, stiffness: 400.0 } ();
        output torque[3]: N*m = bearing.joint.rotation.spring.e;
    }
}

mbg! {
    /// What couples the axes of bearings.
    #[derivative]
    pub model Coupled {
        1 hub[6]; 1 plate[6]; 1 wheel[6];
        Sf fixed[6] { flow: 0.0 } -> hub;
        mount: Fixed {
            blocked: compliant,
            blocked_stiffness: [[1e6, 2e5, 0.0], [2e5, 1e6, 0.0], [0.0, 0.0, 3e6]],
            blocked_torsional_stiffness: diag(1e3, 2e3, 3e3)
        } (hub, plate);
        base: Body { mass: 2.0, inertia: 1.0 } (plate);
        hinge: Revolute {
            axis: 1, blocked: compliant,
            blocked_torsional_stiffness: [[1e3, 7.0, 2e2], [7.0, 5.0, 9.0], [2e2, 9.0, 4e3]]
        } (plate, wheel);
        rim: Body { mass: 1.0, inertia: 0.1 } (wheel);
        output force[3]: N = mount.force.e;
        output moment[3]: N*m = hinge.moment.e;
    }

    /// Blades that the motors of their hinges hold away from where the springs are at rest.
    #[derivative]
    pub model Motored {
        causality componentwise;
        1 mast[6];
        Sf fixed[6] { flow: 0.0 } -> mast;
        rotor: Rotor {
            count: 3, drive: driven, speed: 0.0, offset: 0.3, mass: 20.0, inertia: diag(0.3, 36.8, 37.1),
            centre: [2.35, 0.0, 0.0], stiffness: [100.0, 200.0, 400.0], blade_initial: [0.1, -0.2, 0.3],
            rest: [0.05, -0.1, 0.2], blade_torque: [5.0, -20.0, 40.0], blade_initial_rate: [0.0, 0.0, start]
        } (mast);
        param start: rad/s = 0.0;
        output flap: rad = rotor.blades[2].blade.flap;
        output lagging: rad/s = rotor.blades[2].blade.about_z.rate.f;
    }
}

const INERTIA: [f64; 3] = [1.0, 2.0, 2.5];

fn stiffness() -> Matrix3<f64> {
    Matrix3::new(100.0, 30.0, -20.0, 30.0, 400.0, 50.0, -20.0, 50.0, 900.0)
}

/// From axes of b to those in which it rests.
fn from_rest(turn: &UnitQuaternion<f64>) -> Rotation3<f64> {
    let about = |axis: Vector3<f64>, angle: f64| Rotation3::new(axis * angle);
    let rest = about(Vector3::x(), 0.3) * about(Vector3::y(), -0.2) * about(Vector3::z(), 0.1);
    rest.inverse() * turn.to_rotation_matrix()
}

/// tr(G (1 - R)).
fn potential(turn: &UnitQuaternion<f64>) -> f64 {
    let stiffness = stiffness();
    let weights = Matrix3::from_diagonal_element(0.5 * stiffness.trace()) - stiffness;
    (weights * (Matrix3::identity() - from_rest(turn).matrix())).trace()
}

/// What the potential falls by about each axis of the body.
fn torque(turn: &UnitQuaternion<f64>) -> Vector3<f64> {
    let step = 1e-4;
    let along = |axis: usize| {
        let change = Vector3::ith(axis, step);
        let ahead = potential(&(turn * UnitQuaternion::new(change)));
        (potential(&(turn * UnitQuaternion::new(-change))) - ahead) / (2.0 * step)
    };
    Vector3::new(along(0), along(1), along(2))
}

/// The state with this orientation and angular velocity.
fn state<S, const N: usize, const P: usize>(
    model: &S,
    turn: &UnitQuaternion<f64>,
    rate: &Vector3<f64>,
) -> SVector<f64, N>
where
    S: System<f64, N, 0, P>,
{
    let parts = [turn.w, turn.i, turn.j, turn.k];
    let matrix = turn.to_rotation_matrix();
    let mut x = model.initial_state();
    let (mut spin, mut part) = (0, 0);
    for (place, known) in S::META.states.iter().enumerate() {
        if known.name.contains("spin.p") {
            x[place] = INERTIA[spin] * rate[spin];
            spin += 1;
        } else if known.name.contains("quaternion") {
            x[place] = parts[part];
            part += 1;
        } else {
            x[place] = matrix[(part / 3, part % 3)];
            part += 1;
        }
    }
    assert_eq!((spin, spin + part), (3, N), "all states are known");
    x
}

/// The work of the spring on a closed path of orientations.
fn work<S, const N: usize, const P: usize>(model: &S) -> f64
where
    S: System<f64, N, 0, P>,
{
    let turn = |s: f64| {
        let (sine, cosine) = s.sin_cos();
        UnitQuaternion::from_euler_angles(1.6 * cosine, 0.9 * sine, 0.8 * (s + 0.7).cos())
    };
    let count = 4000;
    let each = (0..count).map(|k| {
        let (s, step) = (TAU * f64::from(k) / f64::from(count), 1e-4);
        let across =
            |step: f64| (turn(s - step).inverse() * turn(s + step)).scaled_axis() / (2.0 * step);
        let rate = (4.0 * across(0.5 * step) - across(step)) / 3.0;
        let x = state(model, &turn(s), &rate);
        model
            .power(0.0, &x, &SVector::zeros(), &mut Default::default())
            .supplied
    });
    each.sum::<f64>() * TAU / f64::from(count)
}

#[test]
fn a_stiffness_in_three_axes_creates_no_energy() {
    let quaternion = ByQuaternion::new(ByQuaternionParameters::default()).unwrap();
    let matrix = ByMatrix::new(ByMatrixParameters::default()).unwrap();
    let found = [work(&quaternion), work(&matrix)];
    assert!(found.iter().all(|it| it.abs() < 1e-7), "{found:?}");
}

#[test]
fn a_small_rotation_is_met_by_the_stiffness() {
    let model = ByQuaternion::new(ByQuaternionParameters::default()).unwrap();
    let rest = from_rest(&UnitQuaternion::identity()).inverse();
    let small = Vector3::new(1e-5, -2e-5, 1.5e-5);
    let turn = UnitQuaternion::from_rotation_matrix(&(rest * Rotation3::new(small)));
    let x = state(&model, &turn, &Vector3::zeros());
    let found = model.output(0.0, &x, &SVector::zeros(), &mut ());
    let found = Vector3::new(found[0], found[1], found[2]);
    assert!(
        (found + stiffness() * small).norm() < 1e-4 * found.norm(),
        "{found}"
    );
}

#[test]
fn one_stiffness_gives_the_sine_of_the_angle() {
    let model = ByNumber::new(ByNumberParameters::default()).unwrap();
    let turn = UnitQuaternion::from_euler_angles(0.4, 1.9, -0.8);
    let x = state(&model, &turn, &Vector3::zeros());
    let found = model.output(0.0, &x, &SVector::zeros(), &mut ());
    let (axis, angle) = from_rest(&turn).axis_angle().unwrap();
    let expected = -400.0 * angle.sin() * axis.into_inner();
    assert!((found - expected).norm() < 1e-11, "{found}");
}

/// Euler's equations with the torque by differences of the potential, by the rule of Runge and Kutta.
fn reference(turn: UnitQuaternion<f64>, rate: Vector3<f64>, end: f64) -> UnitQuaternion<f64> {
    let inertia = Vector3::from(INERTIA);
    let slope = |turn: &UnitQuaternion<f64>, rate: &Vector3<f64>| {
        let momentum = inertia.component_mul(rate);
        (momentum.cross(rate) + torque(turn)).component_div(&inertia)
    };
    let spin = |parts: &nalgebra::Quaternion<f64>, rate: &Vector3<f64>| {
        parts * nalgebra::Quaternion::from_imag(*rate) * 0.5
    };
    let (count, mut parts, mut rate) = (2000, *turn.quaternion(), rate);
    let step = end / f64::from(count);
    for _ in 0..count {
        let at = |parts: nalgebra::Quaternion<f64>, rate: Vector3<f64>| {
            (
                spin(&parts, &rate),
                slope(&UnitQuaternion::new_normalize(parts), &rate),
            )
        };
        let first = at(parts, rate);
        let second = at(parts + first.0 * (0.5 * step), rate + 0.5 * step * first.1);
        let third = at(
            parts + second.0 * (0.5 * step),
            rate + 0.5 * step * second.1,
        );
        let last = at(parts + third.0 * step, rate + step * third.1);
        parts += (first.0 + (second.0 + third.0) * 2.0 + last.0) * (step / 6.0);
        rate += step / 6.0 * (first.1 + 2.0 * (second.1 + third.1) + last.1);
    }
    UnitQuaternion::new_normalize(parts)
}

#[test]
fn large_motions_keep_the_energy_and_are_those_of_the_potential() {
    let model = ByQuaternion::new(ByQuaternionParameters::default()).unwrap();
    let attitude = |x: &SVector<f64, 7>| {
        let found = model.output(0.0, x, &SVector::zeros(), &mut ());
        let parts = nalgebra::Quaternion::new(found[3], found[4], found[5], found[6]);
        UnitQuaternion::new_normalize(parts)
    };
    let start = model.initial_state();
    let energy = |x: &SVector<f64, 7>| model.energy(0.0, x) + potential(&attitude(x));
    let (first, mut end, mut worst) = (energy(&start), start, 0.0_f64);
    Adaptive::new(Dop853, 1e-12, 1e-12)
        .integrate(&model, &(), 0.0, 2.0, start, |step| {
            end = *step.state();
            worst = worst.max((energy(&end) / first - 1.0).abs());
        })
        .unwrap();
    assert!(worst < 1e-9, "{worst:e}");
    let rate = Vector3::new(4.0, -7.0, 9.0);
    let expected = reference(attitude(&start), rate, 2.0);
    let apart = attitude(&end).angle_to(&expected);
    assert!(apart < 1e-5, "{apart:e}");
}

#[test]
fn bearings_couple_their_axes_by_a_matrix() {
    let model = Coupled::new(CoupledParameters::default()).unwrap();
    let mut x = model.initial_state();
    for (place, state) in Coupled::<f64>::META.states.iter().enumerate() {
        let bent = state.name.contains("mount.slipping") || state.name.contains("hinge.tilting");
        if bent && state.name.ends_with(".x") {
            x[place] = 1e-3;
        }
    }
    let found = model.output(0.0, &x, &SVector::zeros(), &mut ());
    let expected = SVector::from([1e3, 2e2, 0.0, 1.0, 0.0, 0.2]);
    assert!((found.abs() - expected).amax() < 1e-9, "{found}");
}

#[test]
fn a_rotor_hands_on_angles_and_torques_of_its_blades() {
    let model = Motored::new(MotoredParameters::default()).unwrap();
    let start = model.initial_state();
    let rates = model.derivative(0.0, &start, &SVector::zeros(), &mut ());
    assert!(rates.amax() < 1e-12, "{rates}");
    let model = Motored::new(MotoredParameters { start: 0.7 });
    let model = model.unwrap();
    let found = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ());
    assert!(
        (found - SVector::from([0.2, 0.7])).amax() < 1e-12,
        "{found}"
    );
}
