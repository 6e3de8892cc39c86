//! Bodies that turn, with angles, quaternions and rotation matrices as states, against references.
#![allow(clippy::unwrap_used)]

#[path = "references/errors.rs"]
mod errors;
#[path = "orientation/models.rs"]
mod models;
#[path = "orientation/reference.rs"]
mod reference;

use std::f64::consts::{FRAC_PI_2, PI};

use mbg_runtime::{
    Adaptive, Cause, Dop853, Dual, Input, Integrator, Pulse, Rk4, Smooth, System, Trouble,
};
use nalgebra::{SVector, Vector3};

use errors::{apart, larger, turned};
use models::*;
use reference::Row;

/// Accurate to rounding, even for rates that begin at 1e-4 rad/s.
const FINE: Adaptive<'static, Dop853> = Adaptive::new(Dop853, 1e-13, 1e-18);

macro_rules! build {
    ($($model:ident, $parameters:ident;)*) => {
        ($($model::<f64>::new($parameters::default()).unwrap()),*)
    };
}

/// What a run shows.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    /// Largest error of a rate.
    rates: f64,
    /// Largest error of a part of the quaternion.
    quaternion: f64,
    /// Largest change of what is kept.
    kept: f64,
}

impl Found {
    fn assert_within(self, rates: f64, quaternion: f64, kept: f64) {
        assert!(
            self.rates < rates && self.quaternion < quaternion && self.kept < kept,
            "{self:?}"
        );
    }
}

/// Runs over the rows of a reference. The outputs are rates and quaternion, and `kept` tells from time, state and
/// outputs what should not change.
fn run<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    x0: SVector<f64, N>,
    rows: &[Row],
    kept: impl Fn(f64, &SVector<f64, N>, &SVector<f64, P>) -> Vec<f64>,
) -> Found
where
    S: System<f64, N, M, P, Memory = ()>,
{
    let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let at_start = kept(0.0, &x0, &model.output(0.0, &x0, &input.at(0.0), &mut ()));
    let (mut rows, mut found) = (rows.iter(), Found::default());
    FINE.sample(model, input, 0.0, x0, &times, |t, x| {
        let output = model.output(t, x, &input.at(t), &mut ());
        let (_, rates, quaternion) = rows.next().unwrap();
        found.rates = larger(found.rates, apart(&output.as_slice()[..3], rates));
        let quaternion = turned(&output.as_slice()[3..7], quaternion);
        found.quaternion = larger(found.quaternion, quaternion);
        for (now, then) in kept(t, x, &output).iter().zip(&at_start) {
            found.kept = larger(found.kept, (now - then).abs());
        }
    })
    .unwrap();
    found
}

/// The state at the start with some states of the same stem given.
fn started<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    stem: &str,
    values: [f64; 3],
) -> SVector<f64, N>
where
    S: System<f64, N, M, P>,
{
    let mut x = model.initial_state();
    for (axis, value) in ["x", "y", "z"].into_iter().zip(values) {
        let place = S::META.state(&format!("{stem}.{axis}")).unwrap();
        x[place] = value;
    }
    x
}

/// A body with the inertias 1, 2, 3 from the rates of a reference: it keeps its energy and its angular momentum.
fn fly<S, const N: usize>(model: &S, rows: &[Row]) -> Found
where
    S: System<f64, N, 0, 10, Memory = ()>,
{
    let [x, y, z] = rows[0].1;
    let start = started(model, "flying.body.spin.p", [x, 2.0 * y, 3.0 * z]);
    run(model, &(), start, rows, |t, x, output| {
        vec![model.energy(t, x), output[7], output[8], output[9]]
    })
}

#[test]
fn free_bodies_meet_elliptic_functions() {
    let (quaternion, matrix) = build! {
        FlyingQuaternion, FlyingQuaternionParameters;
        FlyingMatrix, FlyingMatrixParameters;
    };
    // What counts is how far its energy is from that of the way onto the unstable axis: 3e-8 J of 25 J. Rounding is
    // felt by as much more: an energy that is kept to 1e-12 J brings each turn 1e-5 of an e-folding early or late.
    for found in [
        fly(&quaternion, reference::DZHANIBEKOV),
        fly(&matrix, reference::DZHANIBEKOV),
    ] {
        found.assert_within(1e-5, 1e-6, 1e-11);
    }
    for found in [
        fly(&quaternion, reference::GENERIC),
        fly(&matrix, reference::GENERIC),
    ] {
        found.assert_within(1e-11, 1e-11, 1e-11);
    }
}

/// A top from the rates of a reference: it keeps energy and both momenta.
fn spin<S, const N: usize>(model: &S, rows: &[Row]) -> Found
where
    S: System<f64, N, 0, 10, Memory = ()>,
{
    run(model, &(), model.initial_state(), rows, |t, x, output| {
        vec![model.energy(t, x) + output[9], output[7], output[8]]
    })
}

#[test]
fn tops_meet_elliptic_functions_in_every_orientation() {
    // The second one falls slowly from where it is unstable, so that what is wrong grows.
    for (rows, tilt, rate, bound) in [
        (reference::TOP, 0.6, 25.0, 1e-11),
        (reference::SLEEPING, 0.01, 13.2, 2e-10),
    ] {
        let angles = TopAngles::new(TopAnglesParameters { tilt, rate }).unwrap();
        let quaternion = TopQuaternion::new(TopQuaternionParameters { tilt, rate }).unwrap();
        let matrix = TopMatrix::new(TopMatrixParameters { tilt, rate }).unwrap();
        spin(&angles, rows).assert_within(bound, bound, 1e-11);
        spin(&quaternion, rows).assert_within(bound, bound, 1e-11);
        spin(&matrix, rows).assert_within(bound, bound, 1e-11);
        assert_eq!(TopQuaternion::<f64>::META.conditioning.len(), 0);
        assert_eq!(TopMatrix::<f64>::META.conditioning.len(), 0);
    }
}

/// A body that is pulled through gimbal lock, and one that passes near it.
fn pull<S, const N: usize>(model: &S) -> [Found; 2]
where
    S: System<f64, N, 3, 7, Memory = ()>,
{
    let near = Smooth(|t: f64| {
        Vector3::new(
            0.3 * (2.0 * t).sin(),
            (0.5 * t).cos(),
            0.2 * (3.0 * t).cos(),
        )
    });
    let (x, through) = (model.initial_state(), reference::through_lock());
    [
        run(
            model,
            &through,
            x,
            reference::THROUGH_LOCK,
            |_, _, _| vec![],
        ),
        run(model, &near, x, reference::NEAR_LOCK, |_, _, _| vec![]),
    ]
}

#[test]
fn a_body_is_pulled_through_gimbal_lock() {
    let (quaternion, matrix) = build! {
        PulledQuaternion, PulledQuaternionParameters;
        PulledMatrix, PulledMatrixParameters;
    };
    for found in [pull(&quaternion), pull(&matrix)].as_flattened() {
        found.assert_within(1e-12, 1e-12, 1e-12);
    }
}

#[test]
fn navigation_in_all_orientations_is_one_system_away_from_gimbal_lock() {
    let (angles, quaternion, matrix) = build! {
        NavigationAngles, NavigationAnglesParameters;
        NavigationQuaternion, NavigationQuaternionParameters;
        NavigationMatrix, NavigationMatrixParameters;
    };
    let gust = Pulse {
        amplitude: Vector3::new(5000.0, 1000.0, 10000.0),
        start: 1.0,
        end: 1.1,
    };
    let times: Vec<f64> = (1..=20).map(f64::from).collect();
    fn outputs<S, const N: usize>(
        model: &S,
        gust: &Pulse<f64, 3>,
        times: &[f64],
    ) -> Vec<SVector<f64, 7>>
    where
        S: System<f64, N, 3, 7, Memory = ()>,
    {
        let mut outputs = Vec::new();
        FINE.sample(model, gust, 0.0, model.initial_state(), times, |t, x| {
            outputs.push(model.output(t, x, &gust.at(t), &mut ()));
        })
        .unwrap();
        outputs
    }
    let expected = outputs(&angles, &gust, &times);
    assert!(expected.last().unwrap().fixed_rows::<3>(0).norm() > 0.5);
    for found in [
        outputs(&quaternion, &gust, &times),
        outputs(&matrix, &gust, &times),
    ] {
        let differences = found
            .iter()
            .zip(&expected)
            .map(|(a, b)| apart(a.as_slice(), b.as_slice()));
        let worst = differences.fold(0.0, larger);
        assert!(worst < 1e-11, "{worst:e}");
    }
}

/// By how much a fuselage at rest has pitched under 10 kN m from 1 s to 2 s.
fn pitch(t: f64) -> f64 {
    let (torque, drag, delay) = (1e4, 1e3, 10.0);
    let pulled = |t: f64| torque / drag * (t - delay * (1.0 - (-t / delay).exp()));
    let rate = torque / drag * (1.0 - (-1.0 / delay).exp());
    match t {
        t if t < 1.0 => 0.0,
        t if t < 2.0 => pulled(t - 1.0),
        t => pulled(1.0) + rate * delay * (1.0 - (-(t - 2.0) / delay).exp()),
    }
}

/// Largest error of the quaternion over 20 s.
fn pitched<S, const N: usize>(model: &S, gust: &Pulse<f64, 3>) -> f64
where
    S: System<f64, N, 3, 7, Memory = ()>,
{
    let times: Vec<f64> = (0..=200).map(|k| 0.1 * f64::from(k)).collect();
    let mut worst = 0.0_f64;
    FINE.sample(model, gust, 0.0, model.initial_state(), &times, |t, x| {
        let output = model.output(t, x, &gust.at(t), &mut ());
        let expected = [(0.5 * pitch(t)).cos(), 0.0, -(0.5 * pitch(t)).sin(), 0.0];
        worst = larger(worst, turned(&output.as_slice()[3..], &expected));
    })
    .unwrap();
    worst
}

#[test]
fn navigation_with_quaternions_goes_where_gimbals_lock() {
    let (angles, quaternion, matrix) = build! {
        NavigationAngles, NavigationAnglesParameters;
        NavigationQuaternion, NavigationQuaternionParameters;
        NavigationMatrix, NavigationMatrixParameters;
    };
    let gust = Pulse {
        amplitude: Vector3::new(0.0, 1e4, 0.0),
        start: 1.0,
        end: 2.0,
    };
    // The gimbals come to 90 degrees when the fuselage has pitched by as much, and no further.
    let (mut locked, mut late) = (2.0, 20.0);
    for _ in 0..100 {
        let middle = 0.5 * (locked + late);
        let end = if pitch(middle) < FRAC_PI_2 {
            &mut locked
        } else {
            &mut late
        };
        *end = middle;
    }
    let mut x = angles.initial_state();
    Rk4::fixed(&angles, &gust, 0.0, locked, 1e-3, x, |_, next| x = *next).unwrap();
    let stopped = Rk4::fixed(&angles, &gust, locked, 20.0, 1e-3, x, |_, _| {}).unwrap_err();
    assert!(
        matches!(stopped.cause, Cause::Trouble(Trouble::Singular { name, .. })
            if name == "cos(ins.joint.gimbal.angle.y)"),
        "{stopped}"
    );
    assert!(pitch(20.0) > 2.0 * FRAC_PI_2);
    for worst in [pitched(&quaternion, &gust), pitched(&matrix, &gust)] {
        assert!(worst < 1e-12, "{worst:e}");
    }
}

/// Error of the quaternion of `GENERIC` at 5 s, and how far its length is from one, after steps of length `h`.
fn stepped(h: f64, closing: bool) -> [f64; 2] {
    let model = FlyingQuaternion::new(FlyingQuaternionParameters::default()).unwrap();
    let row = reference::GENERIC.iter().find(|row| row.0 == 5.0).unwrap();
    let u = SVector::from([]);
    let mut x = started(&model, "flying.body.spin.p", [1.0, 1.0, 6.0]);
    for step in 0..(5.0 / h).round() as u32 {
        let t = f64::from(step) * h;
        x = Rk4::step(&model, t, &x, &u, h, &mut ());
        if closing {
            x = model.close(t + h, x, &u, &[]).unwrap();
        }
    }
    let q = x.fixed_rows::<4>(6);
    [turned(q.as_slice(), &row.2), (q.norm() - 1.0).abs()]
}

#[test]
fn keeping_a_quaternion_at_length_one_costs_no_order() {
    for closing in [false, true] {
        let errors = [0.04, 0.02, 0.01].map(|h| stepped(h, closing));
        let order = |place: usize| (errors[place][0] / errors[place + 1][0]).log2();
        assert!((order(1) - 4.0).abs() < 0.2, "{errors:?}");
        let drift = errors[2][1];
        assert_eq!(drift < 1e-15, closing, "{drift:e}");
    }
}

#[test]
fn closing_a_loop_leaves_a_quaternion_at_length_one() {
    let model = build! { HungQuaternion, HungQuaternionParameters; };
    let u = SVector::from([]);
    let mut x = model.initial_state();
    let places: Vec<usize> = (0..4)
        .map(|part| {
            let name = format!("plate.ball.rotation.quaternion.{part}");
            HungQuaternion::<f64>::META.state(&name).unwrap()
        })
        .collect();
    for (part, place) in places.iter().enumerate() {
        x[*place] = 1.2 * x[*place] + [0.1, -0.05, 0.2, 0.15][part];
    }
    let found = model.close(0.0, x, &u, &[]).unwrap();
    let length: f64 = places
        .iter()
        .map(|place| found[*place] * found[*place])
        .sum();
    let gap = model
        .output(0.0, &found, &u, &mut Default::default())
        .fixed_rows::<3>(0)
        .amax();
    assert!(
        (length - 1.0).abs() < 1e-15 && gap < 1e-14,
        "{length} {gap:e}"
    );
    // What is held stays, and with it the whole quaternion.
    let held = model.close(0.0, x, &u, &places).unwrap_err();
    assert!(matches!(held, Trouble::Open { .. }), "{held}");
}

/// Largest gap, change of energy, and angle off that of the hinge in turns, over 5 s.
fn hang<S, const N: usize>(model: &S) -> [f64; 3]
where
    S: System<f64, N, 0, 5>,
{
    let hinged = build! { Hinged, HingedParameters; };
    let (u, times) = (SVector::from([]), [0.0, 0.5, 1.0, 2.0, 5.0]);
    let solver = Adaptive::new(Dop853, 1e-12, 1e-12);
    let mut angles = Vec::new();
    solver
        .sample(&hinged, &(), 0.0, hinged.initial_state(), &times, |t, x| {
            angles.push(hinged.output(t, x, &u, &mut ())[0]);
        })
        .unwrap();
    let (mut angles, mut start, mut worst) = (angles.into_iter(), None, [0.0_f64; 3]);
    let x0 = model.initial_state();
    solver
        .integrate(model, &(), 0.0, 5.0, x0, |step| {
            let (t, x) = (step.end(), step.state());
            let output = model.output(t, x, &u, &mut S::Memory::default());
            let energy = model.energy(t, x) + output[4];
            worst[0] = larger(worst[0], apart(&output.as_slice()[..3], &[0.0; 3]));
            worst[1] = larger(worst[1], (energy - *start.get_or_insert(energy)).abs());
        })
        .unwrap();
    solver
        .sample(model, &(), 0.0, x0, &times, |t, x| {
            let angle = model.output(t, x, &u, &mut S::Memory::default())[3];
            let turns = (angle - angles.next().unwrap()) / (2.0 * PI);
            worst[2] = larger(worst[2], (turns - turns.round()).abs());
        })
        .unwrap();
    worst
}

#[test]
fn loops_through_attitudes_stay_closed() {
    let (quaternion, matrix) = build! {
        HungQuaternion, HungQuaternionParameters;
        HungMatrix, HungMatrixParameters;
    };
    for [gap, energy, angle] in [hang(&quaternion), hang(&matrix)] {
        assert!(
            gap < 1e-14 && energy < 1e-9 && angle < 1e-9,
            "{gap:e} {energy:e} {angle:e}"
        );
    }
}

#[test]
fn jacobians_are_exact_along_rotations() {
    let model = build! { TopQuaternion, TopQuaternionParameters; };
    let (tilt, rate) = (Dual::constant(0.6), Dual::constant(25.0));
    let dual = TopQuaternion::new(TopQuaternionParameters { tilt, rate }).unwrap();
    let u = SVector::from([]);
    for seed in 0..20 {
        let wave = |place: usize| (f64::from(seed) + 1.7 * place as f64 + 0.3).sin();
        let mut x = SVector::<f64, 7>::from_fn(|place, _| wave(place));
        let q = x.fixed_rows::<4>(0).normalize();
        x.fixed_rows_mut::<4>(0).copy_from(&q);
        let mut along = SVector::<f64, 7>::from_fn(|place, _| wave(place + 7));
        let across = along.fixed_rows::<4>(0) - q * q.dot(&along.fixed_rows::<4>(0));
        along.fixed_rows_mut::<4>(0).copy_from(&across);
        let jacobian: nalgebra::SMatrix<f64, 7, 7> = model.jacobian_state(0.0, &x, &u, &mut ());
        let moved = SVector::<Dual<f64>, 7>::from_fn(|place, _| Dual {
            value: x[place],
            slope: along[place],
        });
        let nothing = SVector::from([]);
        let slopes = dual.derivative(Dual::constant(0.0), &moved, &nothing, &mut ());
        let expected = slopes.map(|rate| rate.slope);
        let off = apart((jacobian * along).as_slice(), expected.as_slice());
        assert!(off < 1e-13, "{off:e}");
    }
}
