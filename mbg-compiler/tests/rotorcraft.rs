//! Rotors of the library: frequencies against linear theory, what is kept, and what each blade costs.
#![allow(clippy::unwrap_used)]
#![allow(clippy::excessive_precision, reason = "numbers as they were computed")]

mod models;
#[path = "../../tests/references/rotor.rs"]
mod reference;
#[path = "joints/scene.rs"]
#[allow(dead_code)]
mod scene;

use std::time::Instant;

use mbg_compiler::compile::Routines;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix};
use reference::{Rotor, in_axes_of_the_mast, matched, modulus};
use scene::Scene;

/// Blades of 20 kg, uniform from their hinges to a radius of 5 m.
fn rotor(blades: usize, offset: f64, stiffness: [f64; 3]) -> Rotor {
    let (mass, length) = (20.0, 5.0 - offset);
    let flat = mass * length * length / 12.0;
    Rotor {
        blades,
        speed: 30.0,
        offset,
        mass,
        centre: length / 2.0,
        inertia: [0.3, flat, flat + 0.3],
        stiffness,
        mast_mass: 420.0,
        mast_stiffness: 2e5,
    }
}

/// A call of the component.
fn call(rotor: &Rotor, arguments: &str) -> String {
    let Rotor {
        blades,
        speed,
        offset,
        mass,
        centre,
        inertia,
        stiffness,
        ..
    } = rotor;
    let [x, y, z] = inertia;
    format!(
        "rotor: Rotor {{
            count: {blades}, speed: {speed:?}, offset: {offset:?}, mass: {mass:?}, inertia: diag({x:?}, {y:?}, {z:?}),
            centre: [{centre:?}, 0.0, 0.0], stiffness: {stiffness:?}, {arguments}
        }} (mast);"
    )
}

/// A rotor on a mast that cannot move, and what else is on it.
fn fixed(rotor: &Rotor, arguments: &str, statements: &str) -> Scene {
    let call = call(rotor, arguments);
    Scene::of(&format!(
        "#[derivative] model Fixed {{
            causality componentwise;
            1 mast[6];
            Sf ground[6] {{ flow: 0.0 }} -> mast;
            {call}
            {statements}
            output angles[3]: rad = [rotor.blades[0].blade.feather, rotor.blades[0].blade.flap, rotor.blades[0].blade.lag];
        }}"
    ))
}

/// A driven rotor on a mast that slides in the plane of the hub.
fn sliding(rotor: &Rotor) -> Scene {
    let call = call(rotor, "drive: driven");
    let (mass, stiffness) = (rotor.mast_mass, rotor.mast_stiffness);
    Scene::of(&format!(
        "#[derivative] model Sliding {{
            causality componentwise;
            1 ground[6]; 1 between[6]; 1 mast[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            along: Prismatic {{ axis: 0, stiffness: {stiffness:?} }} (ground, between);
            across: Prismatic {{ axis: 1, stiffness: {stiffness:?} }} (between, mast);
            body: PointMass {{ mass: {mass:?} }} (mast);
            {call}
        }}"
    ))
}

/// The places of the same state of all blades: displacements about x, y and z, then rates.
fn families(scene: &Scene, blades: usize) -> Vec<Vec<usize>> {
    let place = |blade: usize, axis: &str, state: &str| {
        scene.place(&format!("rotor.blades[{blade}].blade.about_{axis}.{state}"))
    };
    let mut families = Vec::new();
    for state in ["spring.q", "rate.f"] {
        for axis in ["x", "y", "z"] {
            families.push((0..blades).map(|blade| place(blade, axis, state)).collect());
        }
    }
    families
}

/// The place of the azimuth, which is a state where anything depends on it.
fn azimuth(scene: &Scene) -> Option<usize> {
    let mut names = scene.names().into_iter();
    names.position(|name| name == "rotor.shaft.angle")
}

/// The exact Jacobian at the steady rotation, at an azimuth.
fn jacobian(scene: &Scene, at: f64) -> DMatrix<f64> {
    let (mut state, shaft) = (scene.start(), azimuth(scene));
    if let Some(shaft) = shaft {
        state[shaft] = at;
    }
    let both = scene.run(Routines::DERIVATIVE_AND_JACOBIAN, &state);
    let (rates, entries) = both.split_at(state.len());
    for (place, rate) in rates.iter().enumerate() {
        let steady = Some(place) == shaft || rate.abs() < 1e-9;
        assert!(steady, "the rotation is not steady: {rate:e}");
    }
    DMatrix::from_row_slice(state.len(), state.len(), entries)
}

/// How far eigenvalues are from those that are expected, relative to the largest one.
fn distance(matrix: &DMatrix<f64>, expected: &[Complex<f64>]) -> f64 {
    // Momenta are larger than angles by powers of ten.
    let mut balanced = matrix.clone();
    balance_parlett_reinsch(&mut balanced);
    let found = balanced.complex_eigenvalues();
    let scale = expected
        .iter()
        .fold(0.0, |most, value| f64::max(most, modulus(*value)));
    let pairs = matched(expected, found.as_slice());
    pairs.iter().fold(0.0, |worst, (a, b)| {
        f64::max(worst, modulus(*a - *b) / scale)
    })
}

fn oscillations(frequencies: &[f64]) -> Vec<Complex<f64>> {
    let both = |frequency: &f64| [Complex::new(0.0, *frequency), Complex::new(0.0, -frequency)];
    frequencies.iter().flat_map(both).collect()
}

/// Offset over radius, stiffness of flap, and flap and lag in rad/s, of closed forms to 17 digits. Feather is the same.
const TABLE: [(f64, f64, f64, f64); 12] = [
    (0.0, 0.0, 30.0, 6.9219762525283904),
    (0.0, 2000.0, 30.199337741082999, 6.9219762525283904),
    (0.0, 20000.0, 31.937438845342624, 6.9219762525283904),
    (0.02, 0.0, 30.45572229332549, 8.7968834828364475),
    (0.02, 2000.0, 30.66016657234701, 8.7968834828364475),
    (0.02, 20000.0, 32.442240347534267, 8.7968834828364475),
    (0.06, 0.0, 31.40334715863832, 11.840938124850175),
    (0.06, 2000.0, 31.618839614388675, 11.840938124850175),
    (0.06, 20000.0, 33.495944093438072, 11.840938124850175),
    (0.1, 0.0, 32.403703492039301, 14.449749816895777),
    (0.1, 2000.0, 32.631500345752029, 14.449749816895777),
    (0.1, 20000.0, 34.614276652100476, 14.449749816895777),
];
const FEATHER: f64 = 144.5683229480096;

#[test]
fn a_blade_flaps_lags_and_feathers_as_closed_forms_say() {
    println!("offset / m  stiffness / N m/rad   flap / rad/s    lag / rad/s   distance");
    for (offset, stiffness, flap, lag) in TABLE {
        let rotor = rotor(1, 5.0 * offset, [6000.0, stiffness, 8000.0]);
        for (theory, known) in rotor.rotating().iter().zip([FEATHER, flap, lag]) {
            assert!((theory / known - 1.0).abs() < 1e-14, "{theory} {known}");
        }
        let scene = fixed(&rotor, "drive: driven", "");
        let matrix = jacobian(&scene, 0.0);
        let distance = distance(&matrix, &oscillations(&[FEATHER, flap, lag]));
        println!(
            "{:>10}{stiffness:>21}{flap:>15.6}{lag:>15.6}{distance:>11.1e}",
            5.0 * offset
        );
        assert!(distance < 1e-12, "{distance:e}");
    }
}

#[test]
fn dampers_of_the_hinges_damp() {
    let rotor = rotor(1, 0.3, [6000.0, 2000.0, 8000.0]);
    let scene = fixed(&rotor, "drive: driven, damping: [20.0, 50.0, 800.0]", "");
    let matrix = jacobian(&scene, 0.0);
    // By multiple precision.
    let above = [
        Complex::new(-33.333333333333333, 140.67298564006129),
        Complex::new(-2.7106392590919358, 11.526502092291482),
        Complex::new(-0.16976007243096424, 31.618383894156305),
    ];
    let expected: Vec<_> = above
        .iter()
        .flat_map(|value| [*value, value.conj()])
        .collect();
    let distance = distance(&matrix, &expected);
    assert!(distance < 1e-12, "{distance:e}");
}

#[test]
fn angles_are_upwards_and_against_the_rotation() {
    let scene = fixed(
        &rotor(1, 0.3, [6000.0, 2000.0, 8000.0]),
        "drive: driven",
        "",
    );
    let mut state = scene.start();
    for (axis, value) in ["x", "y", "z"].iter().zip([0.1, -0.2, -0.3]) {
        let name = format!("rotor.blades[0].blade.about_{axis}.spring.q");
        state[scene.place(&name)] = value;
    }
    assert_eq!(scene.run(Routines::OUTPUT, &state), [0.1, 0.2, 0.3]);
}

/// Of three blades or more, whatever their azimuth, at speeds around that of ground resonance.
#[test]
fn a_mast_and_all_blades_whirl_as_coleman_and_feingold_say() {
    println!("blades  speed / rad/s  growth / 1/s   distance  turning");
    for blades in 3..=6 {
        for speed in [10.0, 30.0, 34.0, 45.0] {
            let rotor = Rotor {
                speed,
                ..rotor(blades, 0.3, [6000.0, 2000.0, 8000.0])
            };
            let scene = sliding(&rotor);
            let (families, shaft) = (families(&scene, blades), azimuth(&scene).unwrap());
            let still = |azimuth: f64| {
                let jacobian = jacobian(&scene, azimuth);
                let matrix = in_axes_of_the_mast(&jacobian, &families, azimuth, speed);
                let (row, column) = (matrix.row(shaft).amax(), matrix.column(shaft).amax());
                assert!(
                    row < 1e-9 && column < 1e-9,
                    "the azimuth matters: {row:e} {column:e}"
                );
                matrix.remove_row(shaft).remove_column(shaft)
            };
            let (matrix, other) = (still(0.0), still(0.7));
            let turning = (&matrix - other).amax() / matrix.amax();
            assert!(turning < 1e-12, "{turning:e}");
            let expected: Vec<_> = rotor
                .eigenvalues()
                .iter()
                .map(|(_, value)| *value)
                .collect();
            let growth = expected
                .iter()
                .fold(0.0, |most, value| f64::max(most, value.re));
            let distance = distance(&matrix, &expected);
            println!("{blades:>6}{speed:>15}{growth:>14.6}{distance:>11.1e}{turning:>9.1e}");
            assert!(distance < 1e-12, "{distance:e}");
        }
    }
}

#[test]
fn a_free_hub_swings_against_its_blades() {
    let (hub, rotor) = (500.0, rotor(4, 0.3, [6000.0, 2000.0, 8000.0]));
    let disk = format!("disk: Body {{ mass: 1.0, inertia: {hub:?} }} (rotor.hub);");
    let scene = fixed(&rotor, "", &disk);
    // In axes of the hub: three modes of lag that leave the hub alone, one that does not, and any other speed.
    let [feather, flap, lag] = rotor.rotating();
    let collective = rotor.collective_lag_of_a_free_hub(hub);
    assert!(collective > 1.5 * lag);
    let mut frequencies = [feather, flap].map(|frequency| [frequency; 4]).concat();
    frequencies.extend([lag, lag, lag, collective]);
    let mut expected = oscillations(&frequencies);
    expected.push(Complex::new(0.0, 0.0));
    let distance = distance(&jacobian(&scene, 0.0), &expected);
    println!(
        "collective lag {collective:.6} rad/s, of a driven hub {lag:.6} rad/s, distance {distance:.1e}"
    );
    assert!(distance < 1e-12, "{distance:e}");
}

/// A fuselage that flies, with a rotor, and momenta about the origin of the world as outputs: linear and angular.
fn flying(blades: usize, drive: &str) -> String {
    let rotor = call(
        &rotor(blades, 0.3, [6000.0, 2000.0, 8000.0]),
        &format!("{drive}, orientation_a: free.orientation_b, position_a: free.position_b"),
    );
    format!(
        "#[derivative] model Flying {{
            causality componentwise;
            1 ground[6]; 1 mast[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            free: Free {{ orientation: quaternion }} (ground, mast);
            fuselage: Body {{
                mass: 2000.0, inertia: diag(1000.0, 3000.0, 3500.0), centre: [0.1, 0.0, -1.5]
            }} (mast);
            {rotor}
            disk: Body {{ mass: 10.0, inertia: diag(3.0, 3.0, 5.0) }} (rotor.hub);
            let hull = free.orientation_b * fuselage.body.p;
            let plate = rotor.shaft.orientation_b * disk.body.p;
            let linear = hull + plate;
            let angular = free.orientation_b * fuselage.spin.p + rotor.shaft.orientation_b * disk.spin.p
                + skew(free.position_b + free.orientation_b * [0.1, 0.0, -1.5]) * hull + skew(free.position_b) * plate;
            sums: for k in 0..{blades} {{
                let turn = rotor.blades[k].blade.orientation_b;
                let momentum = turn * rotor.blades[k].blade.body.body.p;
                let before = if k == 0 {{ linear }} else {{ sums[k-1].total }};
                let total = before + momentum;
                let at = rotor.blades[k].blade.position_b + turn * [2.35, 0.0, 0.0];
                let around = turn * rotor.blades[k].blade.body.spin.p + skew(at) * momentum;
                let earlier = if k == 0 {{ angular }} else {{ sums[k-1].whole }};
                let whole = earlier + around;
            }}
            output linear[3]: N*s = sums[{blades} - 1].total;
            output angular[3]: N*m*s = sums[{blades} - 1].whole;
        }}"
    )
}

/// Largest change of a momentum, and the balance of energy, relative to what makes them up, over some states.
fn kept(scene: &Scene) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for seed in 0..5 {
        let state = scene.state(seed);
        let rates = scene.run(Routines::DERIVATIVE, &state);
        // Momenta change by nothing, of the rates' shares in them.
        let shares: Vec<Vec<f64>> = (0..state.len())
            .map(|place| {
                let mut along = vec![0.0; state.len()];
                along[place] = rates[place];
                scene.along(Routines::OUTPUT, &state, &along)
            })
            .collect();
        for (place, worst) in [(0..3), (3..6)].into_iter().zip(&mut worst) {
            let changes = place.map(|row| shares.iter().map(|share| share[row]).sum::<f64>().abs());
            let scale: f64 = shares.iter().flatten().map(|share| share.abs()).sum();
            *worst = changes.fold(*worst, |most, change| most.max(change / scale));
        }
        let powers = scene.powers(&state, &rates);
        let power = scene.run(Routines::POWER, &state);
        let balance = powers.iter().sum::<f64>() - power[0] + power[1];
        let scale: f64 = powers.iter().chain(&power).map(|share| share.abs()).sum();
        worst[2] = worst[2].max(balance.abs() / scale);
    }
    worst
}

#[test]
fn rotors_in_flight_keep_momenta_and_energy() {
    println!("drive           linear  angular   energy");
    for drive in ["drive: free", "drive: driven", "torque: 300.0"] {
        let scene = Scene::of(&flying(4, drive));
        let [linear, angular, energy] = kept(&scene);
        println!("{drive:<13}{linear:>9.1e}{angular:>9.1e}{energy:>9.1e}");
        // What drives the hub is held by the mast, so that it changes no momentum.
        assert!(linear < 1e-13 && angular < 1e-13 && energy < 1e-13);
        let power = scene.run(Routines::POWER, &scene.state(1))[0];
        assert_eq!(power != 0.0, drive != "drive: free", "{power}");
    }
}

#[test]
fn each_blade_costs_the_same() {
    println!("blades  states  derivative  Jacobian  energy  expansion / s");
    let mut counts = Vec::new();
    for blades in 2..=6 {
        let start = Instant::now();
        let scene = Scene::of(&flying(blades, "drive: free"));
        let items = mbg_compiler::emit::model(&scene.model);
        let seconds = start.elapsed().as_secs_f64();
        assert!(!items.behaviour.is_empty());
        let count = |routine: usize| scene.model.program.routines[routine].operations();
        let [derivative, both, energy] = [
            Routines::DERIVATIVE,
            Routines::DERIVATIVE_AND_JACOBIAN,
            Routines::ENERGY,
        ]
        .map(count);
        let states = scene.names().len();
        println!("{blades:>6}{states:>8}{derivative:>12}{both:>10}{energy:>8}{seconds:>15.2}");
        counts.push([derivative, energy]);
    }
    // What two blades cost, and each more. Opposite ones have some products in common, so that an even number costs less.
    let bounds = [[1321, 461], [288, 96]];
    for (more, count) in counts.iter().enumerate() {
        for (count, [two, each]) in count.iter().zip(bounds) {
            assert!(*count <= two + more * each, "{counts:?}");
        }
    }
}
