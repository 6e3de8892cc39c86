//! First steps: short runs, and runs that begin next to rest.

use mbg_runtime::{
    Adaptive, Auto, Dop853, Fixed, Gauss6, Integrator, Method, Radau5, Radau9, Real, Rk4, Rodas4,
    Rodas5P, Ros2, System, Tsit5, Variable, mbg,
};
use nalgebra::SVector;

use crate::problems::{Law, Written, state};

mbg! {
    /// A wheel that a smooth pulse drives, the same at any scale of time.
    pub(crate) model Pushed {
        param scale: s = 1.0;
        param initial: kg*m/s = 0.0;
        param constant: N*s = 0.0;
        param place = 7.0;
        param width = 0.5;
        1 velocity {
            I body { inertia: 1.0, initial: initial }
            R damper { resistance: 1.0 / scale }
            Se push { effort: (constant + 1.0 * exp(-powi((t / scale - place) / width, 2))) / scale }
        }
        output velocity = velocity.f;
    }
}

/// The momentum after some of ten units of time.
fn after(time: f64, parameters: PushedParameters, solver: impl Integrator<1>) -> f64 {
    let scale = parameters.scale;
    let model = Pushed::<f64>::new(parameters).unwrap();
    let times = [time * scale, 10.0 * scale];
    let mut samples = Vec::new();
    solver
        .sample(&model, &(), 0.0, model.initial_state(), &times, |_, x| {
            samples.push(x[0])
        })
        .unwrap();
    samples[0]
}

#[test]
fn a_pulse_is_met_at_any_scale_of_time() {
    for scale in [1e3, 1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
        let parameters = PushedParameters {
            scale,
            ..Default::default()
        };
        for found in [
            after(7.3, parameters, Auto::new(1e-6, 1e-6)),
            after(7.3, parameters, Adaptive::new(Tsit5, 1e-6, 1e-6)),
            after(7.3, parameters, Adaptive::new(Dop853, 1e-6, 1e-6)),
            after(7.3, parameters, Adaptive::new(Rodas4, 1e-6, 1e-6)),
            after(7.3, parameters, Adaptive::new(Rodas5P, 1e-6, 1e-6)),
            after(7.3, parameters, Adaptive::new(Radau5, 1e-6, 1e-6)),
        ] {
            assert!((found - 0.482_008_37).abs() < 5e-6, "{scale:e}: {found}");
        }
    }
}

#[test]
fn a_pulse_behind_a_start_next_to_rest_is_met() {
    let parameters = PushedParameters {
        initial: 1.000_000_014,
        constant: 1.0,
        place: 7.2,
        width: 0.15,
        ..Default::default()
    };
    let exact = after(7.3, parameters, Adaptive::new(Dop853, 1e-12, 1e-12));
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        // A missed pulse costs 0.19.
        for found in [
            after(7.3, parameters, Auto::new(tolerance, tolerance)),
            after(7.3, parameters, Adaptive::new(Tsit5, tolerance, tolerance)),
            after(7.3, parameters, Adaptive::new(Ros2, tolerance, tolerance)),
            after(7.3, parameters, Adaptive::new(Rodas4, tolerance, tolerance)),
            after(7.3, parameters, Adaptive::new(Radau5, tolerance, tolerance)),
        ] {
            assert!(
                (found - exact).abs() < 30.0 * tolerance,
                "{tolerance:e}: {found} {exact}"
            );
        }
    }
}

/// `x = tan t` beside a state that stays at zero, or at one.
#[derive(Clone, Copy)]
struct Tangent;

impl Law<2, 0> for Tangent {
    const STATES: &'static [Variable] = &[state("resting"), state("rising")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        SVector::from([zero, one + x[1] * x[1]])
    }
}

/// What states have been tells nothing in the first step from zero.
#[test]
fn sweeps_of_radau_settle_from_zero() {
    fn end<M: Method>(method: M, resting: f64, step: f64) -> f64 {
        let mut last = SVector::from([resting, 0.0]);
        Fixed::new(method, step)
            .integrate(&Written(Tangent), &(), 0.0, 1.0, last, |step| {
                last = *step.state()
            })
            .unwrap();
        (last[1] - f64::tan(1.0)).abs()
    }
    for resting in [0.0, 1.0] {
        assert!(end(Radau5, resting, 1.0) < 2e-3);
        assert!(end(Radau5, resting, 0.1) < 4e-7);
        assert!(end(Radau9, resting, 1.0) < 1e-4);
        assert!(end(Radau9, resting, 0.25) < 4e-10);
    }
}

mbg! {
    /// A body with two legs that springs and dampers hold bent falls freely: its joints have nothing to do.
    #[derivative]
    pub(crate) model Dropped {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 world[6]; 1 hull[6];
        Sf fixed[6] { flow: 0.0 } -> world;
        free: Free { orientation: quaternion } (world, hull);
        body: Body { mass: 6.1, inertia: diag(0.016, 0.038, 0.046), centre: [0.01, 0.004, -0.003] } (hull);
        legs: for k in 0..2 {
            1 thigh[6]; 1 calf[6];
            hip: Revolute {
                axis: 1, offset: [0.0, 0.13 * (1 - 2 * k), 0.0], initial: 0.8, stiffness: 300.0, rest: 0.8, damping: 3.0
            } (hull, thigh);
            upper: Body { mass: 1.01, inertia: diag(0.0055, 0.0051, 0.0014), centre: [-0.003, 0.02, -0.027] } (thigh);
            knee: Revolute {
                axis: 1, offset: [0.0, 0.0, -0.2], initial: -1.6, stiffness: 300.0, rest: -1.6, damping: 3.0
            } (thigh, calf);
            lower: Body { mass: 0.23, inertia: diag(0.0034, 0.0034, 0.00004), centre: [0.005, 0.0, -0.13] } (calf);
        }
        output height: m = free.position.z;
        output knees[2]: rad = [legs[0].knee.angle, legs[1].knee.angle];
    }
}

/// Rates of joints are what rounding leaves of weights there, and no sweep makes their changes small beside them.
#[test]
fn sweeps_settle_where_states_are_rounding_alone() {
    fn assert_falls<M: Method>(method: M, step: f64) {
        let model = Dropped::<f64>::new(DroppedParameters::default()).unwrap();
        let mut last = model.initial_state();
        let statistics = Fixed::new(method, step)
            .integrate(&model, &(), 0.0, 0.3, last, |step| last = *step.state())
            .unwrap();
        println!("{} {step}: {statistics:?}", M::NAME);
        let found = model.output(0.3, &last, &SVector::zeros(), &mut ());
        let expected = SVector::from([-0.5 * 9.81 * 0.09, -1.6, -1.6]);
        assert!((found - expected).amax() < 1e-13, "{found}");
    }
    for step in [1e-2, 1e-3] {
        assert_falls(Radau5, step);
        assert_falls(Radau9, step);
    }
    assert_falls(Gauss6::default(), 1e-3);
}

mbg! {
    /// A bob on a rope that is just taut swings away from rest along it.
    pub(crate) model Taut {
        1 ground[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        1 bob[3] { I mass { inertia: 2.0, initial_flow: [0.0, 0.0, 0.5] } }
        integral x: m = bob.f.y, initial: 1.0;
        integral y: m = bob.f.z;
        rope: PlanarLineForce { kind: rope, stiffness: 100.0, rest: 1.0, damping: 20.0, position_b: [x, y] } (ground, bob);
        output length: m = rope.length;
    }
}

/// The damper of a slack rope is led by no state, and the run begins where it is beside one that is.
#[test]
fn a_rope_that_is_just_taut_tightens() {
    fn length(solver: impl Integrator<5>) -> f64 {
        let model = Taut::<f64>::new(TautParameters::default()).unwrap();
        let mut last = model.initial_state();
        solver
            .integrate(&model, &(), 0.0, 1.0, last, |step| last = *step.state())
            .unwrap();
        model.output(1.0, &last, &SVector::zeros(), &mut ())[0]
    }
    // Along the rope, with the moment of momentum that stays.
    let along = |[stretch, rate]: [f64; 2]| {
        let tension = 100.0 * stretch + f64::max(20.0 * rate, -100.0 * stretch);
        [rate, 0.25 / f64::powi(1.0 + stretch, 3) - tension / 2.0]
    };
    let mut rope = [0.0, 0.0];
    let step = 1e-4;
    for _ in 0..10_000 {
        let beside = |slope: [f64; 2], part| [0, 1].map(|k| rope[k] + part * step * slope[k]);
        let first = along(rope);
        let second = along(beside(first, 0.5));
        let third = along(beside(second, 0.5));
        let fourth = along(beside(third, 1.0));
        rope = [0, 1]
            .map(|k| rope[k] + step / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]));
    }
    let expected = 1.0 + rope[0];
    for found in [
        length(Fixed::new(Rk4, 1e-3)),
        length(Adaptive::new(Dop853, 1e-10, 1e-10)),
        length(Adaptive::new(Radau5, 1e-10, 1e-10)),
    ] {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}
