//! Orientations: every Euler sequence in both architectures, quaternions and rotation matrices.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::program::{self, Arguments};
use models::{attempted, compiled};
use nalgebra::{Matrix3, Vector3};

/// Results of a routine at a state, at time zero and without inputs.
fn run(model: &Compiled, routine: usize, state: &[f64]) -> Vec<f64> {
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state,
        input: &[],
    };
    program::evaluate(&model.program, routine, &arguments)
}

/// A pseudo-random sequence in [-1, 1), the same every time.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Three axes, no neighbours equal.
fn sequences() -> impl Iterator<Item = [usize; 3]> {
    (0..27)
        .map(|number| [number / 9, number / 3 % 3, number % 3])
        .filter(|[first, second, third]| first != second && second != third)
}

/// Two bodies that only turn, with a joint between them.
fn two_bodies(joint: &str) -> Compiled {
    compiled(&text(joint))
}

fn text(joint: &str) -> String {
    format!(
        "model M {{
            1 a[3] {{
                I hull {{ inertia: [[1.0, 0.1, 0.0], [0.1, 2.0, -0.2], [0.0, -0.2, 3.0]], gyroscopic }}
                R air {{ resistance: 0.3 }}
            }}
            1 b[3] {{ #[derivative] I body {{ inertia: diag(2.0, 0.5, 1.0), gyroscopic }} }}
            {joint} (a, b);
            output angles[3] = joint.angle;
        }}"
    )
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let largest = |values: &[f64]| values.iter().fold(1.0_f64, |a, b| a.max(b.abs()));
    let scale = largest(expected);
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance * scale, "{found:?} {expected:?}");
    }
}

fn about(axis: usize, angle: f64) -> Matrix3<f64> {
    let mut unit = Vector3::zeros();
    unit[axis] = angle;
    nalgebra::Rotation3::new(unit).into_inner()
}

/// Newton, Euler and the gimbals of `two_bodies` in matrices.
fn by_hand(axes: [usize; 3], state: &[f64]) -> Vec<f64> {
    let part = |first: usize| Vector3::new(state[first], state[first + 1], state[first + 2]);
    let (hull, body, angles) = (part(0), part(3), part(6));
    let inertia = Matrix3::new(1.0, 0.1, 0.0, 0.1, 2.0, -0.2, 0.0, -0.2, 3.0);
    let (spin_a, spin_b) = (
        inertia.try_inverse().unwrap() * hull,
        body.component_div(&Vector3::new(2.0, 0.5, 1.0)),
    );
    let turns = [0, 1, 2].map(|gimbal| about(axes[gimbal], angles[gimbal]));
    let unit = |gimbal: usize| Matrix3::identity().column(axes[gimbal]).into_owned();
    let columns = [unit(0), turns[0] * unit(1), turns[0] * (turns[1] * unit(2))];
    let jacobian = Matrix3::from_columns(&columns);
    let turn = turns[0] * turns[1] * turns[2];
    let rates = jacobian.try_inverse().unwrap() * (turn * spin_b - spin_a);
    let springs = Vector3::new(5.0, 7.0, 3.0).component_mul(&angles);
    let dampers = Vector3::new(0.4, 0.2, 0.6).component_mul(&rates);
    let efforts = dampers + springs - Vector3::new(0.1, -0.2, 0.3);
    let moment = jacobian.transpose().try_inverse().unwrap() * efforts;
    let hull = hull.cross(&spin_a) - 0.3 * spin_a + moment;
    let body = body.cross(&spin_b) - turn.transpose() * moment;
    [hull, body, rates]
        .iter()
        .flat_map(|it| it.iter().copied())
        .collect()
}

#[test]
fn three_hinges_are_the_gimbals_for_every_sequence() {
    let mut next = noise(1);
    for [first, second, third] in sequences() {
        let arguments = format!(
            "first: {first}, second: {second}, third: {third}, initial: [0.2, 0.7, 0.1],
             torque: [0.1, -0.2, 0.3]"
        );
        let gimbals = two_bodies(&format!(
            "joint: Gimbal {{ {arguments}, damping: diag(0.4, 0.2, 0.6), stiffness: diag(5.0, 7.0, 3.0) }}"
        ));
        let series = two_bodies(&format!(
            "joint: GimbalSeries {{ {arguments}, damping: [0.4, 0.2, 0.6], stiffness: [5.0, 7.0, 3.0] }}"
        ));
        let word = if first == third { "sin" } else { "cos" };
        assert_eq!(gimbals.conditioning, [format!("{word}(joint.spring.q.y)")]);
        assert_eq!(series.conditioning, [format!("{word}(joint.y.spring.q)")]);
        assert_eq!((gimbals.states.len(), series.states.len()), (9, 9));
        for _ in 0..100 {
            let state: Vec<f64> = (0..9).map(|_| 3.0 * next()).collect();
            let middle = if first == third {
                state[7].sin()
            } else {
                state[7].cos()
            };
            let [a, b] = [&gimbals, &series].map(|it| run(it, Routines::DERIVATIVE, &state));
            assert_close(&a, &b, 1e-13);
            assert_close(
                &run(&gimbals, Routines::CONDITIONING, &state),
                &[middle],
                1e-15,
            );
            // Rounding grows by what is divided by, twice: in the rates, and in the torques.
            let tolerance = 1e-14 / (middle * middle);
            assert_close(&a, &by_hand([first, second, third], &state), tolerance);
        }
    }
}

#[test]
fn a_proper_sequence_needs_a_start() {
    for [first, second, third] in sequences() {
        let axes = format!("first: {first}, second: {second}, third: {third}");
        let told = attempted(&text(&format!("joint: Gimbal {{ {axes} }}")));
        let started = text(&format!(
            "joint: Gimbal {{ {axes}, initial: [0.0, 0.5, 0.0] }}"
        ));
        assert!(attempted(&started).is_ok());
        match told {
            Ok(_) => assert_ne!(first, third),
            Err(codes) => {
                assert_eq!(first, third);
                assert_eq!(codes, ["MBG0404"]);
            }
        }
    }
    let mut diagnostics = Diagnostics::new();
    let text = text("joint: Gimbal { first: 2, second: 0, third: 2 }");
    let _ = mbg_compiler::items(text.parse().unwrap(), &mut diagnostics);
    let [report] = diagnostics.list() else {
        panic!("one mistake, found {:?}", diagnostics.list())
    };
    assert_eq!(
        report.message,
        "the model starts where sin(joint.angle.y) is zero, which it divides by"
    );
    assert_eq!(
        report.helps,
        ["give `joint.angle` another start, such as `initial: [0.0, 0.5, 0.0]`"]
    );
    assert_eq!(report.span.start().line, 7);
}

/// A determinant is compared with what it is at other angles, also where these are displacements of springs.
#[test]
fn a_start_that_is_all_but_singular_is_told() {
    for spring in ["", ", stiffness: 3.0"] {
        for (middle, is_told) in [(1e-9, true), (1e-4, false)] {
            let axes = "first: 2, second: 0, third: 2";
            let start = format!("initial: [0.0, {middle:?}, 0.0]");
            let told = attempted(&text(&format!(
                "joint: Gimbal {{ {axes}, {start}{spring} }}"
            )));
            assert_eq!(told.is_err(), is_told, "{middle}{spring}");
        }
    }
}

/// Two bodies with a joint between them, none of which is held.
fn floating(joint: &str) -> Compiled {
    compiled(&format!(
        "#[derivative] model M {{
            gravity [0.5, 1.0, -9.81];
            1 a[6];
            1 b[6] {{ R air {{ resistance: 0.7 }} }}
            first: Body {{ mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, -0.3], gravity_at: gravity }} (a);
            joint: {joint} (a, b);
            last: Body {{
                mass: 1.0, inertia: diag(0.3, 0.2, 0.4), centre: [0.0, 0.1, 0.5]
            }} (b);
            output a[6] = a.f;
            output b[6] = b.f;
            output quaternion[4] = joint.quaternion;
            output angles[3] = joint.angle;
            output down[3] = joint.gravity_b;
        }}"
    ))
}

/// What the sources supply goes into the storages and the resistors, and nowhere else.
fn assert_lossless(model: &Compiled, state: &[f64]) {
    let step = 1e-5;
    let rates = run(model, Routines::DERIVATIVE, state);
    let energy = |along: f64| {
        let moved: Vec<f64> = state
            .iter()
            .zip(&rates)
            .map(|(x, rate)| x + along * rate)
            .collect();
        run(model, Routines::ENERGY, &moved)[0]
    };
    let power = run(model, Routines::POWER, state);
    let stored = (energy(step) - energy(-step)) / (2.0 * step);
    assert_close(&[stored], &[power[0] - power[1]], 1e-6);
}

const START: &str = "first: 2, second: 0, third: 2, initial: [0.3, 0.8, -0.4]";

/// The orientation of `START` at other angles: the matrix, and the quaternion and the nine entries of it.
fn oriented(angles: Vector3<f64>) -> (Matrix3<f64>, Vec<f64>, Vec<f64>) {
    let turn = about(2, angles.x) * about(0, angles.y) * about(2, angles.z);
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(turn);
    let found = nalgebra::UnitQuaternion::from_rotation_matrix(&rotation);
    let quaternion = vec![found.w, found.i, found.j, found.k];
    (turn, quaternion, turn.transpose().iter().copied().collect())
}

#[test]
fn a_ball_joint_is_one_joint_however_its_orientation_is_held() {
    let [angles, quaternion, matrix] = ["angles", "quaternion", "matrix"].map(|word| {
        floating(&format!(
            "Spherical {{ orientation: {word}, {START}, gravity_a: gravity }}"
        ))
    });
    let mut next = noise(2);
    for _ in 0..20 {
        let (alpha, rates) = (
            Vector3::from_fn(|_, _| 2.0 * next()),
            Vector3::from_fn(|_, _| next()),
        );
        let (turn, q, r) = oriented(alpha);
        let columns = [
            Vector3::z(),
            about(2, alpha.x) * Vector3::x(),
            about(2, alpha.x) * (about(0, alpha.y) * Vector3::z()),
        ];
        let omega = turn.transpose() * Matrix3::from_columns(&columns) * rates;
        let momenta: Vec<f64> = (0..6).map(|_| 2.0 * next()).collect();
        let state = |attitude: &[f64], rates: &Vector3<f64>| {
            [&momenta[..], attitude, rates.as_slice()].concat()
        };
        let states = [
            (&angles, state(alpha.as_slice(), &rates)),
            (&quaternion, state(&q, &omega)),
            (&matrix, state(&r, &omega)),
        ];
        let found = states.map(|(model, state)| {
            assert_lossless(model, &state);
            let forces = run(model, Routines::DERIVATIVE, &state)[..6].to_vec();
            let mut output = run(model, Routines::OUTPUT, &state);
            // A quaternion may have either sign, and angles are told apart by whole turns.
            let sign = output[12].signum();
            output[12..16].iter_mut().for_each(|part| *part *= sign);
            output[16..19]
                .iter_mut()
                .for_each(|angle| *angle = angle.sin().abs());
            [forces, output].concat()
        });
        assert_close(&found[1], &found[0], 1e-11);
        assert_close(&found[2], &found[0], 1e-11);
    }
}

#[test]
fn a_free_joint_is_one_joint_and_has_no_singular_set_but_that_of_angles() {
    let arguments = format!(
        "{START}, damping: 0.3, torque: [0.1, 0.2, 0.3], force: [1.0, 2.0, -1.0], gravity_a: gravity"
    );
    let [angles, quaternion, matrix] = ["angles", "quaternion", "matrix"]
        .map(|word| floating(&format!("Free {{ orientation: {word}, {arguments} }}")));
    assert_eq!(angles.conditioning, ["sin(joint.rotation.gimbal.angle.y)"]);
    assert!(quaternion.conditioning.is_empty() && matrix.conditioning.is_empty());
    let mut next = noise(3);
    for _ in 0..20 {
        let (_, q, r) = oriented(Vector3::from_fn(|_, _| 2.0 * next()));
        let others: Vec<f64> = (0..15).map(|_| 2.0 * next()).collect();
        let found = [(&quaternion, q), (&matrix, r)].map(|(model, attitude)| {
            let state = [&others[..], &attitude].concat();
            assert_lossless(model, &state);
            run(model, Routines::DERIVATIVE, &state)[..15].to_vec()
        });
        assert_close(&found[0], &found[1], 1e-13);
    }
    let state = [vec![0.5; 15], vec![0.4, 1.1, -0.2]].concat();
    assert_lossless(&angles, &state);
}

#[test]
fn a_spring_of_a_quaternion_pulls_by_the_sine_of_the_angle() {
    for word in ["quaternion", "matrix"] {
        let model = compiled(&format!(
            "#[derivative] model M {{
                1 a[6] {{ Sf held {{ flow: 0.0 }} }}
                1 b[6];
                joint: Spherical {{ orientation: {word}, initial: [0.0, 0.7, 0.0], stiffness: 2.0 }} (a, b);
                body: Body {{ mass: 1.0, inertia: 4.0 }} (b);
                output angles[3] = joint.angle;
            }}"
        ));
        // From a held point on nothing is divided by.
        assert!(model.conditioning.is_empty(), "{:?}", model.conditioning);
        let initial = run(&model, Routines::INITIAL, &[]);
        assert_close(
            &run(&model, Routines::OUTPUT, &initial),
            &[0.0, 0.7, 0.0],
            1e-15,
        );
        let rates = run(&model, Routines::DERIVATIVE, &initial);
        let names = model
            .states
            .iter()
            .map(|state| model.model.states[*state].variable.name.as_str());
        let place = names
            .clone()
            .position(|name| name == "body.spin.p.x")
            .unwrap();
        assert_close(
            &rates[place..place + 3],
            &[0.0, -2.0 * f64::sin(0.7), 0.0],
            1e-15,
        );
    }
}

#[test]
fn only_the_rows_of_a_rotation_that_are_read_are_states() {
    let model = |output: &str| {
        compiled(&format!(
            "model M {{
                1 a[3] {{ I body {{ inertia: diag(1.0, 2.0, 3.0), gyroscopic }} }}
                attitude r = matrix(a.f);
                {output}
            }}"
        ))
    };
    assert_eq!(model("").states.len(), 3);
    let down = model("output down[3] = transpose(r) * [0.0, 0.0, 9.81];");
    assert_eq!(
        (down.states.len(), &down.attitudes),
        (6, &vec![vec![vec![3, 4, 5]]])
    );
    assert_eq!(
        model("output angles[3] = angles_of(r, 0, 1, 2);")
            .states
            .len(),
        12
    );
}

#[test]
fn an_attitude_starts_as_a_rotation() {
    let start = |attitude: &str| {
        let model = compiled(&format!(
            "model M {{
                1 a {{ I body {{ inertia: 1.0 }} }}
                attitude r = {attitude};
                output down[3] = {} * [0.0, 0.0, 1.0];
            }}",
            if attitude.starts_with('m') {
                "transpose(r)"
            } else {
                "transpose(matrix_of(r))"
            }
        ));
        run(&model, Routines::INITIAL, &[])[1..].to_vec()
    };
    let flow = "([0.0, 0.0, a.f])";
    assert_close(
        &start(&format!("quaternion{flow}")),
        &[1.0, 0.0, 0.0, 0.0],
        0.0,
    );
    let given = format!("quaternion{flow}, initial: [3.0, 0.0, -4.0, 0.0]");
    assert_close(&start(&given), &[0.6, 0.0, -0.8, 0.0], 1e-15);
    let given = format!("quaternion{flow}, initial: quaternion_of(rot_x(2.0))");
    assert_close(
        &start(&given),
        &[f64::cos(1.0), f64::sin(1.0), 0.0, 0.0],
        1e-15,
    );
    // Only the last row is read.
    let given = format!("matrix{flow}, initial: rot_x(0.5)");
    assert_close(&start(&given), &[0.0, f64::sin(0.5), f64::cos(0.5)], 1e-15);
    assert_close(
        &start(&format!("matrix{flow}, initial: 1.0")),
        &[0.0, 0.0, 1.0],
        0.0,
    );
}

/// Three hinges in a row, each tilted against the one before, whose end is held.
fn ring(tilts: [&str; 3], closure: &str) -> String {
    let [first, second, third] = tilts;
    format!(
        "#[derivative]
        model M {{
            causality componentwise;
            gravity [0.0, 0.0, -9.81];
            1 base[6]; 1 a[6]; 1 b[6]; 1 c[6]; 1 end[6];
            Sf ground[6] {{ flow: 0.0 }} -> base;
            one: Revolute {{ axis: 2, tilt: {first}, initial: 1.0, initial_rate: 0.4 }} (base, a);
            two: Revolute {{ axis: 2, offset: [1.0, 0.0, 0.0], tilt: {second}, initial: 0.9 }} (a, b);
            three: Revolute {{ axis: 2, offset: [1.5, 0.0, 0.0], tilt: {third}, initial: -1.0 }} (b, c);
            far: Offset {{ by: [1.0, 0.2, 0.0] }} (c, end);
            upper: Body {{ mass: 1.0, inertia: 0.1, centre: [0.5, 0.0, 0.0] }} (a);
            middle: Body {{ mass: 2.0, inertia: 0.2 }} (b);
            lower: Body {{ mass: 1.0, inertia: 0.1 }} (c);
            {closure}
        }}"
    )
}

#[test]
fn a_loop_is_closed_whose_turns_are_written_as_numbers() {
    let cut = "cut: Cut (end, base);";
    let named = ["rot_y(0.3) * rot_x(0.7)", "rot_x(0.7)", "rot_z(0.2)"];
    let turns = [about(1, 0.3) * about(0, 0.7), about(0, 0.7), about(2, 0.2)];
    let numbers = turns.map(|turn| {
        let rows = turn.row_iter();
        let rows = rows.map(|row| format!("[{:?}, {:?}, {:?}]", row[0], row[1], row[2]));
        format!("[{}]", rows.collect::<Vec<_>>().join(", "))
    });
    let numbers = numbers.each_ref().map(String::as_str);
    let [expected, found] = [named, numbers].map(|tilts| {
        let model = compiled(&ring(tilts, cut));
        let start = run(&model, Routines::INITIAL, &[]);
        run(&model, Routines::DERIVATIVE, &start)
    });
    assert_close(&found, &expected, 1e-12);
}

#[test]
fn a_wrong_displacement_is_told_whose_turns_are_written_as_numbers() {
    let turn = "[[1.0, 0.0, 0.0], [0.0, 0.7648421872844885, -0.644217687237691], [0.0, 0.644217687237691, 0.7648421872844885]]";
    for wrong in [
        "1.001 * far.position_b",
        "far.position_b + play * [one.angle, 0.0, 0.0]",
        "far.position_b + play * [t, 0.0, 0.0]",
    ] {
        let closure = format!(
            "param play = 0.0;
            1 point[3]; 1 rest[3];
            base[3..6] -> rest;
            end[3..6] -> MTF place {{ flow: far.orientation_b }} -> point;
            close point -> rest by multipliers, displacement: {wrong};"
        );
        let told = attempted(&ring([turn; 3], &closure)).map(|_| ());
        assert_eq!(told, Err(vec!["MBG0309"]), "{wrong}");
    }
}
