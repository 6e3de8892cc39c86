//! A rotor of four blades over many turns: what it keeps, and what it takes to drive it.
#![allow(clippy::unwrap_used)]

#[path = "references/errors.rs"]
#[allow(dead_code)]
mod errors;
#[path = "../examples/rotor/model.rs"]
#[allow(unreachable_pub)]
mod model;

use errors::larger;
use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
use model::{Coasting, CoastingParameters, Sliding, SlidingParameters};
use nalgebra::SVector;

const FINE: Adaptive<'static, Dop853> = Adaptive::new(Dop853, 1e-13, 1e-13);

/// The start with all blades away from where they rest, each otherwise.
fn disturbed<S, const N: usize, const P: usize>(model: &S) -> SVector<f64, N>
where
    S: System<f64, N, 0, P>,
{
    let mut x = model.initial_state();
    for (place, state) in S::META.states.iter().enumerate() {
        if state.name.contains("about_") && state.name.ends_with("spring.q") {
            x[place] = 0.2 * (1.7 * place as f64).sin();
        }
    }
    x
}

#[test]
fn a_free_hub_keeps_energy_and_momentum_about_its_axis() {
    let model = Coasting::new(CoastingParameters::default()).unwrap();
    let (x0, u) = (disturbed(&model), SVector::from([]));
    let start = (model.energy(0.0, &x0), model.output(0.0, &x0, &u, &mut ()));
    let (mut worst, mut speeds) = ([0.0_f64; 2], [f64::INFINITY, 0.0_f64]);
    FINE.integrate(&model, &(), 0.0, 5.0, x0, |step| {
        let (t, x) = (step.end(), step.state());
        let output = model.output(t, x, &u, &mut ());
        worst[0] = larger(worst[0], (model.energy(t, x) / start.0 - 1.0).abs());
        worst[1] = larger(worst[1], (output[0] / start.1[0] - 1.0).abs());
        speeds = [speeds[0].min(output[1]), speeds[1].max(output[1])];
    })
    .unwrap();
    println!(
        "energy {:.1e}, momentum {:.1e}, speed {speeds:.3?}",
        worst[0], worst[1]
    );
    // The hub swings against its blades all the while.
    assert!(speeds[1] - speeds[0] > 1.0, "{speeds:?}");
    assert!(worst[0] < 1e-11 && worst[1] < 1e-11, "{worst:?}");
}

#[test]
fn a_driven_hub_takes_what_its_blades_gain() {
    let model = Sliding::new(SlidingParameters::default()).unwrap();
    let (x0, u) = (disturbed(&model), SVector::from([]));
    let start = model.energy(0.0, &x0);
    let (mut work, mut worst, mut most) = (0.0, 0.0_f64, 0.0_f64);
    // Gauss and Legendre's rule of three points, in quarters of steps.
    let rule = [
        (-0.6_f64.sqrt(), 5.0 / 18.0),
        (0.0, 8.0 / 18.0),
        (0.6_f64.sqrt(), 5.0 / 18.0),
    ];
    FINE.integrate(&model, &(), 0.0, 2.0, x0, |step| {
        let (from, to) = (step.start(), step.end());
        let panel = (to - from) / 4.0;
        for middle in [0.5, 1.5, 2.5, 3.5] {
            for (point, weight) in rule {
                let t = from + panel * (middle + 0.5 * point);
                let power = model.power(t, &step.at(t), &u, &mut ());
                assert_eq!(power.dissipated, 0.0);
                work += weight * panel * power.supplied;
            }
        }
        let gained = model.energy(to, step.state()) - start;
        most = most.max(gained.abs());
        worst = larger(worst, (gained - work).abs());
    })
    .unwrap();
    println!("gained up to {most:.1} J of {start:.1} J, off by {worst:.1e} J");
    assert!(most > 0.01 * start, "{most}");
    assert!(worst < 1e-10 * start, "{worst:e}");
}

mbg! {
    /// A blade that flaps freely, whose pitch is given.
    component Pitched(port 1 hub[6]) {
        1 pitched[6];
        1 root[6];
        pitch: Revolute { axis: 0, initial: 0.1 } (hub, pitched);
        flap: Revolute { axis: 1, initial: -0.05 } (pitched, root);
        blade: Body { mass: 40.0, inertia: diag(0.3, 80.0, 80.3), centre: [2.6, 0.0, 0.0] } (root);
    }

    /// Collective and cyclic pitch, by a source and by a cam on the shaft.
    #[derivative]
    pub model Swashplate {
        causality componentwise;
        param cyclic: rad = 0.05;
        1 ground[6]; 1 hub[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        shaft: Revolute { axis: 2 } (ground, hub);
        Sf drive { flow: 27.0 } -> shaft.rate;
        led: Pitched (hub);
        Sf actuator { flow: cyclic * cos(shaft.angle) * shaft.rate.f } -> led.pitch.rate;
        geared: Pitched (hub);
        shaft.rate -> TF cam { flow: cyclic * cos(shaft.angle) } -> geared.pitch.rate;
        output flap[2]: rad = [led.flap.angle, geared.flap.angle];
    }
}

/// Lagrange's equation of the flap angle β under the pitch θ: Iy β'' = (Iz - Ix) ωx ωz - Iy Ω θ' cos θ.
fn flap_under_pitch(end: f64) -> f64 {
    let (about_x, about_y, about_z) = (0.3, 80.0 + 40.0 * 2.6 * 2.6, 80.3 + 40.0 * 2.6 * 2.6);
    let speed = 27.0_f64;
    let rate = |t: f64, [flap, flapping]: [f64; 2]| {
        let (pitch, pitching) = (
            0.1 + 0.05 * (speed * t).sin(),
            0.05 * speed * (speed * t).cos(),
        );
        let along = speed * pitch.cos();
        let spin_x = flap.cos() * pitching - flap.sin() * along;
        let spin_z = flap.sin() * pitching + flap.cos() * along;
        let coupling = (about_z - about_x) / about_y * spin_x * spin_z;
        [flapping, coupling - along * pitching]
    };
    let (count, mut state) = (20_000, [-0.05, 0.0]);
    let step = end / f64::from(count);
    for k in 0..count {
        let t = f64::from(k) * step;
        let ahead = |by: f64, rate: [f64; 2]| [state[0] + by * rate[0], state[1] + by * rate[1]];
        let first = rate(t, state);
        let second = rate(t + 0.5 * step, ahead(0.5 * step, first));
        let third = rate(t + 0.5 * step, ahead(0.5 * step, second));
        let last = rate(t + step, ahead(step, third));
        for place in 0..2 {
            let sum = first[place] + 2.0 * (second[place] + third[place]) + last[place];
            state[place] += step / 6.0 * sum;
        }
    }
    state[0]
}

#[test]
fn pitch_that_a_swashplate_gives_is_a_joint_with_a_given_rate() {
    let model = Swashplate::new(SwashplateParameters::default()).unwrap();
    let start = model.initial_state();
    let mut end = start;
    FINE.integrate(&model, &(), 0.0, 1.0, start, |step| end = *step.state())
        .unwrap();
    let found = model.output(1.0, &end, &SVector::zeros(), &mut ());
    let expected = flap_under_pitch(1.0);
    assert!((expected - 0.002_801_19).abs() < 1e-8, "{expected}");
    assert!((found.add_scalar(-expected)).amax() < 1e-9, "{found}");
}
