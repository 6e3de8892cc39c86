//! Motions that come back, against closed forms, numbers of other programs, and runs that begin there.

use std::f64::consts::{PI, TAU};

use mbg_runtime::{
    Adaptive, Constant, Cycle, Direction, Dop853, Fixed, Gauss6, Integrator, PeriodicTrim, Radau5,
    Radau9, Rk4, System, Untrimmed, mbg,
};
use nalgebra::SVector;

mbg! {
    /// The equation of Mathieu: a swing whose spring is stronger and weaker by turns.
    model Mathieu {
        param stiff = 2.0;
        param swing = 0.7;
        1 way {
            I mass { inertia: 1.0 }
            C spring { effort: (stiff - 2.0 * swing * cos(2.0 * t)) * q }
        }
    }

    /// The oscillator of van der Pol; with a negative sign it falls into rest, or out of its cycle.
    model Valve {
        param sign = 1.0;
        1 circuit {
            I coil { inertia: 1.0 }
            C capacitor { compliance: 1.0 }
            R valve { effort: sign * (capacitor.q * capacitor.q - 1.0) * f }
        }
    }

    /// A pendulum, which swings the longer the farther.
    model Pendulum {
        param friction: N*m*s = 0.0;
        1 joint { I rod { inertia: 1.0 } C weight { effort: 1.0 * sin(q), initial: 2.0 } R bearing { resistance: friction } }
    }

    /// A winding behind a switch.
    model Chopper {
        input supply: V;
        input duty;
        1 coil {
            I winding { inertia: 1e-2 }
            R copper { resistance: 2.0 }
            Se switch { effort: if mod(t, 1e-3) < 1e-3 * duty { supply } else { 0.0 } }
        }
        integral charge: C = coil.f;
        output charge: C = charge;
    }

    /// A blade of a rotor in forward flight, with the pitch that a swash plate gives it, and what its lift and its flapping are on
    /// the mean and to either side.
    model Blade {
        param advance = 0.3;
        param speed: rad/s = 30.0;
        input collective: rad;
        input lateral: rad;
        input longitudinal: rad;
        let air = 1.0 + advance * sin(speed * t);
        let pitch = collective + lateral * cos(speed * t) + longitudinal * sin(speed * t);
        let lift = 1e5 * air * (air * pitch - 0.9 * flap.f / speed);
        1 flap {
            I blade { inertia: 500.0 }
            C centrifugal { stiffness: 5e5 }
            Se push { effort: lift }
        }
        integral lifted: N*m*s = lift;
        integral back: rad*s = centrifugal.q * cos(speed * t);
        integral aside: rad*s = centrifugal.q * sin(speed * t);
        output sums[3] = [lifted / 1.0, back / 1.0, aside / 1.0];
    }

    /// A clock, whose escapement pushes the way that it goes.
    model Clock {
        param push = 0.1;
        1 balance {
            I wheel { inertia: 1.0 }
            C spring { stiffness: 1.0 }
            R bearing { resistance: 0.2 }
            R escapement { effort: -push * sign(f) }
        }
    }

    /// A block that a spring holds on a belt, whose friction is less the faster it slips.
    model Belt {
        1 moving; 0 contact; 1 slip; 1 motion { I block { inertia: 1.0 } C spring { stiffness: 2.0 } }
        Sf belt { flow: 0.2 } -> moving;
        moving -> contact; contact -> motion; contact -> slip;
        rubs: Friction { sliding: 1.0, breakaway: 1.5, at_rest: holds, stribeck_speed: 0.3 } (slip);
    }

    /// A hub on a mount, with two blades whose forces cancel out, but for what the phase between them is not half a turn.
    model Balanced {
        param thrust: N = 1e4;
        param phase: rad = 0.0;
        integral psi: rad = 20.0;
        1 hub {
            I mass { inertia: 1.0 }
            C mount { stiffness: 100.0 }
            R damper { resistance: 1.0 }
            Se blades { effort: thrust * (cos(psi) + cos(psi + 3.141592653589793 + phase)) }
        }
    }

    /// A blade that a damper of dry friction holds at its hinge.
    model Held {
        param air: N*m = 50.0;
        param friction: N*m = 60.0;
        1 lag {
            I blade { inertia: 150.0 }
            C spring { stiffness: 5400.0 }
            R damper { effort: friction * sign(f) }
            Se push { effort: air * sin(20.0 * t) }
        }
    }

    /// What a wheel pushes one way, through air if there is any; the wheel turns as fast as it is told.
    model Pushed {
        param air: N*s/m = 1e-3;
        param push: N = 1.0;
        input faster: rad/s;
        integral psi: rad = 20.0 + faster;
        1 way {
            I mass { inertia: 1.0 }
            R drag { resistance: air }
            Se wheel { effort: push * (1.0 + cos(psi)) }
        }
    }

    /// A top without weight.
    model Top {
        1 turning[3] { I body { inertia: diag(1.0, 2.0, 3.0), gyroscopic, initial_flow: [0.1, 5.0, 0.2] } }
        attitude q = quaternion(turning.f);
        output up[3] = matrix_of(q) * [0.0, 0.0, 1.0];
    }

    /// A crank that a torque turns, with a flywheel, and the coupler and the rocker that it drives.
    #[derivative]
    model Engine {
        causality componentwise;
        gravity [0.0, -9.81];
        input torque: N*m;
        1 ground[3]; 1 crank[3]; 1 crank_tip[3]; 1 coupler[3]; 1 coupler_middle[3]; 1 coupler_tip[3];
        1 post[3]; 1 rocker[3]; 1 rocker_tip[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 1.0, initial_rate: 6.0, torque: torque - 0.5 * first.rate.f } (ground, crank);
        flywheel: PlanarBody { mass: 3.0, inertia: 2.0 } (crank);
        along_crank: PlanarOffset { x: 1.0 } (crank, crank_tip);
        second: PlanarRevolute { initial: -0.41435822693569047 } (crank_tip, coupler);
        half_coupler: PlanarOffset { x: 1.5 } (coupler, coupler_middle);
        coupler_body: PlanarBody { mass: 0.5, inertia: 0.01 } (coupler_middle);
        along_coupler: PlanarOffset { x: 3.0 } (coupler, coupler_tip);
        base: PlanarOffset { x: 3.0 } (ground, post);
        third: PlanarRevolute { initial: 1.5546456692877555 } (post, rocker);
        rocker_body: PlanarBody { mass: 0.5, inertia: 0.5 } (rocker);
        along_rocker: PlanarOffset { x: 2.5 } (rocker, rocker_tip);
        cut: PlanarCut (coupler_tip, rocker_tip);
        output angles[2]: rad = [first.angle, third.angle];
    }
}

fn exact() -> Adaptive<'static, Dop853> {
    Adaptive::new(Dop853, 1e-12, 1e-12)
}

/// The state after some periods of a motion.
fn after<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    (state, input): (SVector<f64, N>, SVector<f64, M>),
    until: f64,
) -> SVector<f64, N>
where
    S: System<f64, N, M, P>,
{
    let mut last = state;
    exact()
        .integrate(model, &Constant(input), 0.0, until, state, |step| {
            last = *step.state()
        })
        .unwrap();
    last
}

/// Multipliers by size, the largest first.
fn sizes<const N: usize, const M: usize>(cycle: &Cycle<N, M>) -> [f64; N] {
    let mut sizes = cycle.multipliers().unwrap().map(|it| it.re.hypot(it.im));
    sizes.sort_by(|a, b| b.total_cmp(a));
    sizes
}

/// Traces of the monodromy matrix by Taylor series of 30 digits.
#[test]
fn rest_between_waves_has_the_multipliers_of_mathieu() {
    for (stiff, swing, trace) in [
        (2.0, 0.7, -1.045_454_340_592_592),
        (1.0, 0.5, -2.612_418_906_624_66),
    ] {
        let model = Mathieu::<f64>::new(MathieuParameters { stiff, swing }).unwrap();
        let cycle = PeriodicTrim::new(&model, &exact(), PI)
            .state(&SVector::from([0.3, -0.2]))
            .solve()
            .unwrap();
        assert!(cycle.state.norm() < 1e-11 && cycle.period == PI);
        let [one, other] = cycle.multipliers().unwrap();
        assert!((one.re + other.re - trace).abs() < 1e-9, "{one} {other}");
        assert!((cycle.monodromy.determinant() - 1.0).abs() < 1e-9);
        // Inside a tongue it does not stay at rest.
        assert_eq!(sizes(&cycle)[0] > 1.0 + 1e-6, trace < -2.0);
    }
}

/// Period, amplitude and multiplier by Taylor series of 30 digits; whether it attracts or repels, and by whichever method.
#[test]
fn what_swings_by_itself_is_found_with_its_period() {
    const MULTIPLIER: f64 = 0.000_859_695_063_603_805_2;
    macro_rules! by {
        ($($solver:expr, $error:expr;)*) => { $(
            for (sign, start, multiplier) in [(1.0, 1.8, MULTIPLIER), (-1.0, 2.0085, 1.0 / MULTIPLIER)] {
                let model = Valve::<f64>::new(ValveParameters { sign }).unwrap();
                let cycle = PeriodicTrim::new(&model, &$solver, 6.0)
                    .state(&SVector::from([0.0, start]))
                    .find_period("coil.p")
                    .solve()
                    .unwrap();
                let near = |found: f64, expected: f64, factor: f64| {
                    let error = (found / expected - 1.0).abs();
                    assert!(error < factor * $error, "{} {sign}: {found}, {error:e}", stringify!($solver));
                };
                near(cycle.period, 6.663_286_859_323_13, 1.0);
                near(cycle.state[1], 2.008_619_860_874_843, 1.0);
                let mut found = sizes(&cycle);
                found.sort_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs()));
                near(found[0], 1.0, 1e3);
                near(found[1], multiplier, 1e3);
            }
        )* };
    }
    by! {
        exact(), 1e-10;
        Adaptive::new(Dop853, 1e-7, 1e-7), 1e-6;
        Adaptive::new(Radau5, 1e-9, 1e-9), 1e-7;
        Adaptive::new(Radau9, 1e-11, 1e-11), 1e-9;
        Fixed::new(Gauss6::default(), 0.05), 1e-6;
        Fixed::new(Rk4, 0.01), 1e-6;
    }
}

/// A family of cycles, each with its period: the complete elliptic integral K(sin 1) by 4 K.
#[test]
fn a_pendulum_swings_as_far_as_it_is_told() {
    let model = Pendulum::<f64>::new(PendulumParameters::default()).unwrap();
    let exact = exact();
    let swing = PeriodicTrim::new(&model, &exact, 8.0).find_period("rod.p");
    for swing in [swing.fix("weight.q"), swing] {
        let cycle = swing.solve().unwrap();
        let (mut a, mut b) = (1.0, 1.0_f64.cos());
        for _ in 0..6 {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        assert!((cycle.state[1] - 2.0).abs() < 1e-9, "{cycle:?}");
        assert!((cycle.period - TAU / a).abs() < 1e-9, "{cycle:?}");
        // The period changes with the amplitude, so that two multipliers are one and do not part.
        assert!(sizes(&cycle).iter().all(|it| (it - 1.0).abs() < 1e-4));
    }
    // With friction none comes back.
    let friction = 0.1;
    let model = Pendulum::<f64>::new(PendulumParameters { friction }).unwrap();
    let swing = PeriodicTrim::new(&model, &exact, 8.0).find_period("rod.p");
    let open = swing.fix("weight.q").solve();
    let Err(Untrimmed::Open {
        name: "weight.q",
        is_fixed: true,
        ..
    }) = open
    else {
        panic!("{open:?}")
    };
    // Nor does it ever hang aside.
    let away = swing.state(&SVector::from([2.5, 0.0])).solve();
    assert!(
        matches!(
            away,
            Err(Untrimmed::Away {
                name: "rod.p",
                value: 2.5
            })
        ),
        "{away:?}"
    );
}

#[test]
fn a_converter_is_found_as_it_runs_for_ever() {
    let model = Chopper::<f64>::new(ChopperParameters::default()).unwrap();
    let (exact, mean) = (exact(), 4.0);
    for duty in [0.1, 0.5, 0.93] {
        // The mean current is the mean voltage over the resistance.
        let supply = 2.0 * mean / duty;
        let decay = |part: f64| f64::exp(-200.0 * 1e-3 * part);
        let least = 0.5 * supply * (1.0 - decay(duty)) * decay(1.0 - duty) / (1.0 - decay(1.0));
        let carried = PeriodicTrim::new(&model, &exact, 1e-3).grows("charge", 1e-3 * mean);
        for trim in [
            carried.input(&[0.0, duty]).fix("duty"),
            carried.input(&[supply, 0.4]).fix("supply"),
        ] {
            let cycle = trim.solve().unwrap();
            let [found_supply, found_duty] = cycle.input.into();
            assert!((found_supply / supply - 1.0).abs() < 1e-9, "{duty}");
            assert!((found_duty - duty).abs() < 1e-9, "{duty}");
            assert!(
                (100.0 * cycle.state[0] / least - 1.0).abs() < 1e-9,
                "{duty}"
            );
            assert!((sizes(&cycle)[1] - decay(1.0)).abs() < 1e-9, "{duty}");
        }
    }
}

#[test]
fn a_rotor_is_trimmed_to_lift_without_leaning() {
    let model = Blade::<f64>::new(BladeParameters::default()).unwrap();
    let turn = TAU / 30.0;
    let wanted = 3e4;
    let exact = exact();
    let level = PeriodicTrim::new(&model, &exact, turn).grows("lifted", wanted * turn);
    let cycle = level.solve().unwrap();
    // From rest it settles to that.
    let mut rest = SVector::zeros();
    for _ in 0..80 {
        rest = after(&model, (rest, cycle.input), turn);
    }
    let next = after(&model, (rest, cycle.input), turn);
    let index = |name| {
        Blade::<f64>::META
            .states
            .iter()
            .position(|it| it.name == name)
            .unwrap()
    };
    let gained = |name| next[index(name)] - rest[index(name)];
    assert!((gained("lifted") / (wanted * turn) - 1.0).abs() < 1e-9);
    assert!(gained("back").abs() < 1e-10 && gained("aside").abs() < 1e-10);
    for name in ["blade.p", "centrifugal.q"] {
        let error = next[index(name)] - cycle.state[index(name)];
        assert!(
            error.abs() < 1e-8 * (1.0 + next[index(name)].abs()),
            "{name}: {error:e}"
        );
    }
    // Air that is faster on one side asks for less pitch there.
    assert!(
        cycle.input[0] > 0.2 && cycle.input[2] < -0.1,
        "{}",
        cycle.input
    );
    // With one control alone it leans.
    let leaning = level.fix("lateral").fix("longitudinal");
    let open = leaning.solve();
    assert!(
        matches!(
            open,
            Err(Untrimmed::Open {
                is_fixed: false,
                ..
            })
        ),
        "{open:?}"
    );
    let free = leaning.free("back").free("aside").solve().unwrap();
    let end = after(&model, (free.state, free.input), turn);
    assert!(end[index("aside")].abs() > 1e-3, "{end}");
}

/// Through closed loops: at the speed to which a run settles, with the work of a turn lost in the bearing.
#[test]
fn a_crank_turns_as_fast_as_its_torque_drives_it() {
    let model = Engine::<f64>::new(EngineParameters::default()).unwrap();
    let exact = exact();
    let turning = PeriodicTrim::new(&model, &exact, 1.0)
        .input(&[3.0])
        .grows("first.angle", TAU)
        .grows("second.angle", -TAU)
        .find_period("first.angle");
    let cycle = turning.fix("torque").solve().unwrap();
    let input = Constant(cycle.input);
    let settled = after(&model, (model.initial_state(), cycle.input), 100.0);
    let whole_turns = |_, state: &SVector<f64, 6>| f64::sin(state[1] - 1.0);
    let turning = (Direction::Rising, whole_turns);
    let arrival = exact.until(&model, &input, 0.0, 5.0, settled, turning, |_| ());
    let found = arrival.unwrap().state;
    for rate in [0, 4, 5] {
        let error = found[rate] - cycle.state[rate];
        assert!(error.abs() < 1e-8, "{found} {}", cycle.state);
    }
    // A mean over a whole turn: the rule of rectangles has no error that falls more slowly than any power.
    let times: Vec<f64> = (0..400)
        .map(|k| f64::from(k) / 400.0 * cycle.period)
        .collect();
    let mut lost = 0.0;
    let lose =
        |_, state: &SVector<f64, 6>| lost += 0.5 * state[4] * state[4] * cycle.period / 400.0;
    exact
        .sample(&model, &input, 0.0, cycle.state, &times, lose)
        .unwrap();
    assert!((lost - 3.0 * TAU).abs() < 1e-8, "{lost}");
    // And the torque at which a turn takes a second.
    let driven = PeriodicTrim::new(&model, &exact, 1.0)
        .grows("first.angle", TAU)
        .grows("second.angle", -TAU);
    let cycle = driven.fix("first.angle").solve().unwrap();
    assert!((3.0..3.4).contains(&cycle.input[0]), "{cycle:?}");
    let end = after(&model, (cycle.state, cycle.input), 1.0);
    assert!((end[1] - cycle.state[1] - TAU).abs() < 1e-9, "{end}");
}

/// What is the same again after some time, while its laws are not, is no motion that comes back.
#[test]
fn laws_come_back_with_the_motion() {
    let exact = exact();
    let model = Chopper::<f64>::new(ChopperParameters::default()).unwrap();
    for (period, is_whole) in [(1e-3, true), (3e-3, true), (1.5e-3, false), (0.9e-3, false)] {
        let chopper = PeriodicTrim::new(&model, &exact, period).input(&[24.0, 0.3]);
        let found = chopper.fix("supply").fix("duty").free("charge").solve();
        match found {
            Ok(_) => assert!(is_whole, "{period}"),
            Err(Untrimmed::Driven { name, .. }) => {
                assert!(!is_whole && name == "winding.p", "{period} {name}");
            }
            Err(other) => panic!("{other}"),
        }
    }
    // A pendulum that goes over its lowest place is as fast on the other side, but does not go on as it has come.
    let model = Pendulum::<f64>::new(PendulumParameters::default()).unwrap();
    let over = |by| {
        PeriodicTrim::new(&model, &exact, 0.35 * by)
            .state(&SVector::from([3.0, -1.0]))
            .grows("weight.q", by)
            .find_period("weight.q")
            .solve()
    };
    assert!(matches!(over(2.0), Err(Untrimmed::Driven { .. })));
    over(TAU).unwrap();
}

/// Half a swing takes an amplitude a to (a + push) e + push with e = exp(−0.1 π / ω).
#[test]
fn what_friction_and_an_escapement_do_at_rest_is_in_the_multipliers() {
    let model = Clock::<f64>::new(ClockParameters::default()).unwrap();
    let omega = 0.99_f64.sqrt();
    let decay = f64::exp(-0.1 * PI / omega);
    let amplitude = 0.1 * (1.0 + decay) / (1.0 - decay);
    for (start, section) in [([0.0, 0.5], "wheel.p"), ([0.7, 0.0], "spring.q")] {
        let cycle = PeriodicTrim::new(&model, &exact(), 6.0)
            .state(&SVector::from(start))
            .find_period(section)
            .solve()
            .unwrap();
        assert!((cycle.period - TAU / omega).abs() < 1e-9, "{cycle:?}");
        let is_aside = section == "wheel.p" && (cycle.state[1] - amplitude).abs() > 1e-9;
        assert!(!is_aside, "{cycle:?}");
        // Along the motion, and how an amplitude beside it comes nearer in two halves.
        let mut multipliers = cycle.multipliers().unwrap().map(|it| it.re);
        multipliers.sort_by(f64::total_cmp);
        let errors = [multipliers[0] - decay * decay, multipliers[1] - 1.0];
        assert!(errors.iter().all(|it| it.abs() < 1e-9), "{errors:?}");
    }
}

/// The multipliers are those of q'' + q' + 100 q over a turn, whose roots are −1/2 ± i √99.75.
#[test]
fn forces_that_cancel_out_leave_a_hub_at_rest() {
    let turn = TAU / 20.0;
    let decay = f64::exp(-turn);
    let trace = 2.0 * f64::exp(-0.5 * turn) * f64::cos(99.75_f64.sqrt() * turn);
    macro_rules! by {
        ($($solver:expr, $error:expr;)*) => { $(
            for (thrust, start) in [(1e4, 0.0), (1e4, 0.1), (1.0, 0.0), (1.0, 0.1), (1e-6, 0.0)] {
                let model = Balanced::<f64>::new(BalancedParameters { thrust, phase: 0.0 }).unwrap();
                let cycle = PeriodicTrim::new(&model, &$solver, turn)
                    .state(&SVector::from([0.0, start, 0.0]))
                    .grows("psi", TAU)
                    .solve()
                    .unwrap();
                let rest = cycle.state.fixed_rows::<2>(0).norm();
                assert!(rest < 1e-15 * (thrust + 100.0), "{thrust} {start}: {rest:e}");
                let hub = cycle.monodromy.fixed_view::<2, 2>(0, 0);
                let errors = [hub.trace() - trace, hub.determinant() - decay];
                assert!(errors.iter().all(|it| it.abs() < $error), "{errors:?}");
            }
        )* };
    }
    by! {
        Adaptive::new(Dop853, 1e-11, 1e-11), 1e-8;
        Adaptive::new(Dop853, 1e-13, 1e-13), 1e-8;
        Adaptive::new(Dop853, 1e-6, 1e-6), 1e-5;
        Fixed::new(Rk4, 1e-3), 1e-8;
    }
}

/// What is a billionth of the terms is no rounding: it swings as q'' + q' + 100 q = thrust · phase · sin(20 t).
#[test]
fn what_hardly_cancels_out_moves_a_hub() {
    let (thrust, phase) = (1e4, 1e-9);
    let model = Balanced::<f64>::new(BalancedParameters { thrust, phase }).unwrap();
    let exact = exact();
    let turning = PeriodicTrim::new(&model, &exact, TAU / 20.0).grows("psi", TAU);
    let found = turning.fix("psi").solve().unwrap().state;
    let expected = [-300.0 * 20.0, -20.0].map(|it| thrust * phase * it / (300.0 * 300.0 + 400.0));
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{found:e} {expected:e}"
        );
    }
}

#[test]
fn what_friction_holds_all_the_time_comes_back() {
    let exact = exact();
    for (air, friction, start) in [
        (50.0, 60.0, 1e-3),
        (1e-9, 1.2e-9, 1e-14),
        (1e6, 1.2e6, 1e-3),
    ] {
        let model = Held::<f64>::new(HeldParameters { air, friction }).unwrap();
        let over = |period| {
            PeriodicTrim::new(&model, &exact, period)
                .state(&SVector::from([0.0, start]))
                .solve()
        };
        let cycle = over(TAU / 20.0).unwrap();
        assert_eq!(cycle.state, SVector::from([0.0, start]));
        assert_eq!(sizes(&cycle), [1.0, 0.0]);
        // That of the laws is another one by a millionth.
        let driven = over((1.0 + 1e-6) * TAU / 20.0);
        assert!(
            matches!(
                driven,
                Err(Untrimmed::Driven {
                    name: "blade.p",
                    ..
                })
            ),
            "{driven:?}"
        );
    }
}

/// Its speed is push / air on the mean, and with a wave beside it. The angle of the wheel is as large as it grows but for its last digits,
/// whatever has an influence on it.
#[test]
fn an_angle_that_grows_as_it_is_to_is_not_missed() {
    let model = Pushed::<f64>::new(PushedParameters::default()).unwrap();
    let exact = exact();
    let turning = PeriodicTrim::new(&model, &exact, TAU / 20.0).grows("psi", TAU);
    let cycle = turning.solve().unwrap();
    let [speed, psi] = cycle.state.into();
    let expected = 1e3 + (1e-3 * psi.cos() + 20.0 * psi.sin()) / (400.0 + 1e-6);
    assert!((speed - expected).abs() < 1e-5, "{speed} {expected}");
    // Without air it is faster after every turn, however small all is.
    for push in [1.0, 1e-9, 1e-20] {
        let model = Pushed::<f64>::new(PushedParameters { push, air: 0.0 }).unwrap();
        let open = PeriodicTrim::new(&model, &exact, TAU / 20.0)
            .grows("psi", TAU)
            .solve();
        let Err(Untrimmed::Open {
            name: "mass.p",
            reached,
            ..
        }) = open
        else {
            panic!("{open:?}")
        };
        assert!((0.2..0.4).contains(&(reached / push)), "{reached:e}");
    }
}

/// While it sticks its speed is that of the belt, wherever it has begun.
#[test]
fn what_sticks_and_slips_forgets_where_it_began() {
    let model = Belt::<f64>::new(BeltParameters::default()).unwrap();
    let cycle = PeriodicTrim::new(&model, &exact(), 5.0)
        .state(&SVector::from([0.0, 0.6]))
        .find_period("block.p")
        .solve()
        .unwrap();
    let last = after(&model, (cycle.state, cycle.input), 3.0 * cycle.period);
    assert!((last - cycle.state).amax() < 1e-9, "{last} {cycle:?}");
    let mut multipliers = cycle.multipliers().unwrap().map(|it| it.re.hypot(it.im));
    multipliers.sort_by(f64::total_cmp);
    let errors = [multipliers[0], multipliers[1] - 1.0];
    assert!(errors.iter().all(|it| it.abs() < 1e-9), "{errors:?}");
}

#[test]
fn a_motion_begins_on_its_attitude() {
    let model = Top::<f64>::new(TopParameters::default()).unwrap();
    let cycle = PeriodicTrim::new(&model, &exact(), 6.0)
        .state(&SVector::from([0.1, 9.0, 0.6, 2.0, 1.0, 0.0, 0.0]))
        .find_period("body.p.x")
        .free("q")
        .solve()
        .unwrap();
    let quaternion = cycle.state.fixed_rows::<4>(3);
    assert!((quaternion.norm() - 1.0).abs() < 1e-15, "{quaternion}");
}

#[test]
fn what_cannot_be_is_told() {
    let model = Chopper::<f64>::new(ChopperParameters::default()).unwrap();
    let exact = exact();
    let chopper = PeriodicTrim::new(&model, &exact, 1e-3);
    let told = |trim: PeriodicTrim<'_, _, _, 2, 2, 1>| trim.solve().unwrap_err().to_string();
    assert_eq!(
        told(chopper.fix("voltage")),
        "the model has no state or input `voltage`: a position or an angle that nothing reads is none"
    );
    assert!(told(chopper.grows("current", 1.0)).starts_with("the model has no state `current`"));
    assert!(told(chopper.find_period("supply")).starts_with("the model has no state `supply`"));
    let still = chopper
        .input(&[24.0, 0.3])
        .fix("supply")
        .fix("duty")
        .fix("winding");
    let open = told(still);
    assert!(
        open.starts_with("`winding.p` grows by 6") && open.ends_with("where it need not come back"),
        "{open}"
    );
    assert_eq!(
        told(PeriodicTrim::new(&model, &exact, 0.0)),
        "stopped at t = 0: the period must be larger than zero"
    );
    // Nothing says what gathers in the charge, but that the current comes back does not hang on it.
    let stopped = told(PeriodicTrim::new(&model, &exact, f64::NAN));
    assert!(stopped.starts_with("stopped at t = 0"), "{stopped}");
}
