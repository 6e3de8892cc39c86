//! Motions that stay where laws jump: friction that holds, relays that go on and off without end.

use mbg_runtime::{
    Adaptive, Auto, Constant, Direction, Dop853, Dual, Fixed, Gauss6, Input, Integrator, Pirk8,
    Pulse, Radau9, Real, Rk4, Rodas5P, Ros2, Sampled, Smooth, Statistics, System, Tsit5, mbg,
};
use nalgebra::SVector;

#[path = "sliding/constant_steps.rs"]
mod constant_steps;
#[path = "sliding/falling.rs"]
mod falling;
#[path = "sliding/moving.rs"]
mod moving;
#[path = "sliding/networks.rs"]
mod networks;
#[path = "sliding/row.rs"]
mod row;
#[path = "sliding/several.rs"]
mod several;
#[path = "sliding/turning.rs"]
mod turning;
#[path = "sliding/yielding.rs"]
mod yielding;

mbg! {
    /// A block on a floor that a spring pulls.
    model Block {
        param friction = 1.0;
        input force: N;
        1 motion {
            I block { inertia: 1.0 }
            C spring { stiffness: 4.0, initial: 3.3 }
            R floor { effort: friction * sign(f) }
            Se push { effort: force }
        }
        output friction: N = floor.e;
    }

    /// A block on another one, which is pushed along a floor.
    model Stacked {
        input force: N;
        1 upper { I load { inertia: 1.0 } }
        1 lower { I sledge { inertia: 3.0 } R floor { effort: 1.0 * sign(f) } Se push { effort: force } }
        0 between; 1 slip { R contact { effort: 2.0 * sign(f) } }
        lower -> between; between -> upper; between -> slip;
        output contact: N = contact.e;
        output floor: N = floor.e;
    }

    /// A load that a brake holds.
    model Braked {
        input force: N;
        1 motion {
            I load { inertia: 2.0 }
            R brake { effort: 5.0 * sign(f) }
            Se push { effort: force }
        }
        output speed: m/s = motion.f;
        output brake: N = brake.e;
    }

    /// A mass that a switched force takes along a reference, against a spring that is not linear.
    model Follower {
        input place: m;
        input speed: m/s;
        1 motion {
            I mass { inertia: 1.0 }
            C spring { effort: 0.5 * q * q, initial: 0.4 }
        }
        let error = place - spring.q;
        Se actuator { effort: if speed - motion.f + 2.0 * error > 0.0 { 6.0 } else { -6.0 } } -> motion;
        output error: m = error;
        output force: N = actuator.e;
    }

    /// A block that a spring holds on a belt, whose friction is less the faster it slips.
    model Belt {
        param speed = 0.2;
        1 moving; 0 contact; 1 slip; 1 motion { I block { inertia: 1.0 } C spring { stiffness: 2.0 } }
        Sf belt { flow: speed } -> moving;
        moving -> contact; contact -> motion; contact -> slip;
        slip -> R rubs { effort: sign(f) * (1.0 + 0.5 * exp(-f * f / 0.09)) };
        output friction: N = rubs.e;
    }

    /// A ball that a field slows down, which is stronger from a place on.
    model Thrown {
        1 motion {
            I ball { inertia: 1.0, initial: 1.0 }
            C field { effort: if q < 0.5 { 1.0 } else { 3.0 } }
        }
        output place: m = field.q;
    }

    /// Two rods on hinges, of which the second rubs.
    #[derivative]
    model Rubbing {
        param friction: N*m = 50.0;
        causality componentwise;
        gravity [0.0, -9.81];
        1 ground[3]; 1 upper[3]; 1 heavy[3]; 1 elbow[3]; 1 lower[3]; 1 light[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        shoulder: PlanarRevolute { initial: -0.5 } (ground, upper);
        to_first: PlanarOffset { x: 0.5, y: 0.0 } (upper, heavy);
        first: PlanarBody { mass: 2.0, inertia: 0.1 } (heavy);
        to: PlanarOffset { x: 1.0, y: 0.0 } (upper, elbow);
        hinge: PlanarRevolute { initial: 0.7 } (elbow, lower);
        to_second: PlanarOffset { x: 0.4, y: 0.0 } (lower, light);
        second: PlanarBody { mass: 1.0, inertia: 0.05 } (light);
        hinge.rate -> R dry { effort: friction * sign(f) };
        output angles[2]: rad = [shoulder.angle, hinge.angle];
        output friction: N*m = dry.e;
    }

    /// Two blocks that are pulled, and let go after a second.
    model Released {
        let grip = if t > 1.0 { 0.0 } else { 2.0 };
        1 motion { I block { inertia: 1.0 } R brake { effort: grip * sign(f) } Se pull { effort: 1.0 } }
        1 other { I light { inertia: 0.5 } R second { effort: grip * sign(f) } Se push { effort: -1.0 } }
        output brakes[2]: N = [brake.e, second.e];
    }

    /// A block at rest on a floor, beside a bumper.
    model Beside {
        1 motion {
            I block { inertia: 1.0 }
            R floor { effort: 1.0 * sign(f) }
            C bumper { effort: max(5.0 * q, 0.0) }
            Se pull { effort: 0.5 }
        }
        output friction: N = floor.e;
    }

    /// A load on a sledge on a table that is shaken, and wind on the load.
    model Shaken {
        1 table { Sf shake { flow: 0.35 * sin(12.0 * t) } }
        1 lower { I sledge { inertia: 3.0 } }
        1 upper { I load { inertia: 2.0, initial_flow: 0.3 } Se wind { effort: 1.5 * sin(5.0 * t) } }
        below: Clutch { capacity: 14.715 } (table, lower);
        above: Clutch { capacity: 3.924 } (lower, upper);
    }

    /// A load that slides on a sledge, which a table takes along faster and faster.
    model Rising {
        1 table { Sf rise { flow: 0.5 * t } }
        1 lower { I sledge { inertia: 3.0 } }
        1 upper { I load { inertia: 2.0, initial_flow: 0.3 } }
        below: Clutch { capacity: 14.0 } (table, lower);
        above: Clutch { capacity: 4.0 } (lower, upper);
    }

    /// A body from rest whose damper is stiffer one way than the other.
    model Absorber {
        1 motion {
            I body { inertia: 1.0 }
            C spring { stiffness: 1.0 }
            R damper { effort: if f > 0.0 { 1.1 * f } else { 0.9 * f } }
            Se push { effort: 1.0 * t }
        }
    }

    /// Two cars with a spring between, of which the one behind has the drag.
    model Towed {
        1 first { I car { inertia: 1.0 } Se pull { effort: 1.0 } }
        1 second { I trailer { inertia: 1.0 } R air { effort: f * abs(f) } }
        0 between; first -> between -> second;
        between -> C spring { stiffness: 1.0 };
    }

    /// A motor whose bearing rubs, from rest.
    model Motor {
        param coulomb = 0.1;
        param constant = 0.05;
        1 wire { Se supply { effort: 6.0 } R winding { resistance: 1.2 } I coil { inertia: 2e-3 } }
        1 shaft { I rotor { inertia: 1e-4 } R bearing { effort: 1e-5 * f + coulomb * sign(f) } }
        wire -> GY machine { effort: constant } -> shaft;
        integral angle = shaft.f;
        output turned = angle;
    }

    /// Blocks, each on a floor of its own.
    model Row {
        blocks: for k in 0..12 {
            1 motion { I block { inertia: 1.0 } R floor { effort: sign(f) } }
        }
    }
}

/// The last of the states and outputs of a run.
fn last<T: Real, const N: usize, const M: usize, const P: usize>(
    model: &impl System<T, N, M, P>,
    input: &dyn Input<T, M>,
    end: f64,
    solver: &impl Integrator<N>,
) -> (SVector<T, N>, SVector<T, P>, Statistics) {
    let (mut state, mut outputs) = (
        model.initial_state(),
        SVector::from_element(T::from_f64(0.0)),
    );
    let [start, end] = [0.0, end].map(T::from_f64);
    let statistics = solver
        .sample_outputs(model, input, start, state, &[end], |_t, x, y| {
            (state, outputs) = (*x, *y)
        })
        .unwrap();
    (state, outputs, statistics)
}

/// The same to nine digits by a method of each kind, with their names.
fn by_each<const N: usize, const M: usize, const P: usize>(
    model: &impl System<f64, N, M, P>,
    input: &dyn Input<f64, M>,
    end: f64,
) -> Vec<(&'static str, SVector<f64, N>, SVector<f64, P>)> {
    macro_rules! by {
        ($($method:ident),*) => {
            vec![
                $({
                    let found = last(model, input, end, &Adaptive::new($method, 1e-9, 1e-11));
                    (stringify!($method), found.0, found.1)
                },)*
            ]
        };
    }
    by!(Tsit5, Dop853, Pirk8, Rodas5P, Radau9)
}

const NINE: Adaptive<'_, Dop853> = Adaptive::new(Dop853, 1e-9, 1e-11);

fn push(amplitude: f64, start: f64, end: f64) -> Pulse<f64, 1> {
    Pulse {
        amplitude: SVector::from([amplitude]),
        start,
        end,
    }
}

/// Each half swing is about a place 0.25 m beside the middle: the last is from 0.3 m to 0.2 m, where the spring is too weak.
#[test]
fn friction_holds_what_a_spring_is_too_weak_for() {
    let model = Block::new(BlockParameters::default()).unwrap();
    for (method, state, outputs) in by_each(&model, &(), 30.0) {
        let errors = [state[0], state[1] - 0.2, outputs[0] + 0.8];
        assert!(
            errors.iter().all(|error| error.abs() < 2e-7),
            "{method}: {errors:?}"
        );
    }
    // What holds takes few steps, for as long as it lasts.
    let [before, behind] = [30.0, 3000.0].map(|end| last(&model, &(), end, &NINE).2);
    assert!(behind.steps - before.steps <= 10, "{before:?} {behind:?}");
    let single = Block::<f32>::new(BlockParameters::default()).unwrap();
    let (state, outputs, _) = last(&single, &(), 30.0, &Adaptive::new(Tsit5, 1e-5, 1e-6));
    assert!(
        (state[1] - 0.2).abs() < 1e-4 && (outputs[0] + 0.8).abs() < 4e-4,
        "{state} {outputs}"
    );
}

/// A force that grows tears it loose where both are more than the friction, at 3.5 m/s² per s; without a spring it then has half of the
/// square of the time, and behind a pulse it stays.
#[test]
fn a_force_that_grows_tears_loose_what_friction_holds() {
    let model = Stacked::new(StackedParameters::default()).unwrap();
    // Both begin to slide at 1 N, the upper one to slip at 9 N.
    let growing = Smooth(|t: f64| SVector::from([t]));
    for (end, speeds, forces) in [
        (0.5, [0.0, 0.0], [0.0, 0.5]),
        (5.0, [2.0, 6.0], [1.0, 1.0]),
        (
            11.0,
            [8.0 + 2.0 * 2.0, 24.0 + 0.5 * (121.0 - 81.0) - 3.0 * 2.0],
            [2.0, 1.0],
        ),
    ] {
        for (method, state, outputs) in by_each(&model, &growing, end) {
            let errors = [
                state - SVector::from(speeds),
                outputs - SVector::from(forces),
            ];
            assert!(
                errors.iter().all(|it| it.amax() < 1e-8),
                "{method} until {end}: {errors:?}"
            );
        }
    }
}

/// The law of the bumper only bends where the block rests.
#[test]
fn what_bends_where_a_motion_stays_changes_nothing() {
    let model = Beside::<f64>::new(BesideParameters::default()).unwrap();
    let (state, outputs, statistics) = last(&model, &(), 5.0, &NINE);
    assert!(
        state.amax() < 1e-15 && (outputs[0] - 0.5).abs() < 1e-12 && statistics.steps < 20,
        "{state} {outputs} {statistics:?}"
    );
}

/// Where it stands on a bend of a law all that it feels is as small as how far beside it the law is asked.
#[test]
fn what_rests_on_a_bend_sets_off() {
    let model = Absorber::<f64>::new(AbsorberParameters::default()).unwrap();
    // By `ẍ + 1.1 ẋ + x = t`, as long as it does not go back.
    let (half, turn) = (0.55, f64::sqrt(1.0 - 0.55 * 0.55));
    let at = |t: f64| {
        let (decay, (sin, cos)) = (f64::exp(-half * t), (turn * t).sin_cos());
        t - 1.1 + decay * (1.1 * cos + (1.1 * half - 1.0) / turn * sin)
    };
    for (method, state, _) in by_each(&model, &(), 2.0) {
        assert!((state[1] - at(2.0)).abs() < 1e-8, "{method}: {state}");
    }
    let model = Towed::<f64>::new(TowedParameters::default()).unwrap();
    let reference = Fixed::new(Gauss6::default(), 1e-3);
    let reference = last(&model, &(), 5.0, &reference).0;
    for (method, state, _) in by_each(&model, &(), 5.0) {
        assert!((state - reference).amax() < 1e-8, "{method}: {state}");
    }
}

/// The sledge goes with the table, and when it is as fast as the load, so does that.
#[test]
fn what_comes_to_rest_on_what_is_held_stays_there() {
    let model = Rising::<f64>::new(RisingParameters::default()).unwrap();
    for (method, state, _) in by_each(&model, &(), 1.0) {
        let errors = state - SVector::from([1.5, 1.0]);
        assert!(errors.amax() < 1e-9, "{method}: {errors}");
    }
    let model = Shaken::<f64>::new(ShakenParameters::default()).unwrap();
    // By the impulses of a million short steps, each of which is the least that the clutches let slip.
    let (end, statistics) = {
        let (state, _, statistics) = last(&model, &(), 3.0, &NINE);
        (state, statistics)
    };
    let errors = end - SVector::from([-1.041_367_796, 0.081_716_9]);
    assert!(errors.amax() < 2e-7, "{errors}");
    assert!(statistics.evaluations < 20_000, "{statistics:?}");
}

/// Also at the start, where no step has been.
#[test]
fn outputs_have_what_holds_from_the_start() {
    let model = Block::new(BlockParameters { friction: 20.0 }).unwrap();
    let (start, times) = (model.initial_state(), [0.0, 0.0, 1.0]);
    let mut seen = Vec::new();
    NINE.sample_outputs(&model, &(), 0.0, start, &times, |_t, _x, y| seen.push(y[0]))
        .unwrap();
    assert!(
        seen.len() == 3 && seen.iter().all(|it| (it + 13.2).abs() < 1e-12),
        "{seen:?}"
    );
}

/// Momenta and friction of both blocks at some times, when 12 N act from 1 s to 2 s: until then they come to 2 m/s and 3 m/s; a third of
/// a second later both have 8/3 m/s, and from there lose a quarter of 1 m/s².
const CAUGHT: [(f64, [f64; 2], [f64; 2]); 4] = [
    (0.7, [0.0, 0.0], [0.0, 0.0]),
    (2.0, [2.0, 9.0], [2.0, 1.0]),
    (3.0, [2.5, 7.5], [-0.25, 1.0]),
    (14.0, [0.0, 0.0], [0.0, 0.0]),
];

/// One slips behind the other, both go on together, and stop at once.
#[test]
fn several_hold_at_once_and_one_after_the_other() {
    let model = Stacked::new(StackedParameters::default()).unwrap();
    let pulse = push(12.0, 1.0, 2.0);
    for (end, speeds, forces) in CAUGHT {
        for (method, state, outputs) in by_each(&model, &pulse, end) {
            let errors = [
                state - SVector::from(speeds),
                outputs - SVector::from(forces),
            ];
            assert!(
                errors.iter().all(|it| it.amax() < 1e-8),
                "{method} until {end}: {errors:?}"
            );
        }
    }
    // At steps of the input it begins anew.
    let times: [f64; 5] = [0.0, 1.0, 2.0, 3.0, 4.0];
    let values = [0.4, 0.8, -0.9, 5.0, -0.3].map(|force| SVector::from([force]));
    let held = Sampled::held(&times, &values).unwrap();
    let (state, outputs, statistics) = last(&model, &held, 30.0, &NINE);
    assert!(
        state.amax() < 1e-12 && (outputs - SVector::from([0.0, -0.3])).amax() < 1e-12,
        "{state} {outputs}"
    );
    assert!(statistics.evaluations < 6000, "{statistics:?}");
}

#[test]
fn what_lets_go_at_a_time_holds_until_then() {
    let model = Released::<f64>::new(ReleasedParameters::default()).unwrap();
    for (end, momentum, force) in [(0.9, 0.0, 1.0), (2.5, 1.5, 0.0)] {
        for (method, state, outputs) in by_each(&model, &(), end) {
            let signs = SVector::from([1.0, -1.0]);
            let errors = [state - signs * momentum, outputs - signs * force];
            assert!(
                errors.iter().all(|it| it.amax() < 1e-12),
                "{method} until {end}: {errors:?}"
            );
        }
    }
}

/// Along the surface on which the force is switched, what is off decays by `exp(-2 t)`, whatever the spring and the reference do, and
/// the mean of the force is what takes the mass there.
#[test]
fn a_switched_force_takes_a_mass_along_a_reference() {
    let model = Follower::<f64>::new(FollowerParameters::default()).unwrap();
    let reference = Smooth(|t: f64| SVector::from([t.sin(), t.cos()]));
    let start = last(
        &model,
        &reference,
        1.0,
        &Adaptive::new(Dop853, 1e-12, 1e-12),
    )
    .1[0];
    for (method, state, outputs) in by_each(&model, &reference, 4.0) {
        let off = start * f64::exp(-6.0);
        let acceleration = -f64::sin(4.0) - 4.0 * off;
        let force = acceleration + 0.5 * state[1] * state[1];
        let errors = [outputs[0] - off, outputs[1] - force];
        assert!(
            errors[0].abs() < 2e-9 && errors[1].abs() < 2e-7,
            "{method}: {errors:?}"
        );
    }
}

/// The block goes with the belt until the spring is as strong as the friction at rest, slips back, and is caught.
#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let model = Belt::<f64>::new(BeltParameters::default()).unwrap();
    // Phases of their own, one after the other: the slip by an independent method of small steps.
    let (speed, stiffness, catch) = (0.2, 2.0, 0.75);
    let slides = |x: [f64; 2]| {
        let slip: f64 = speed - x[0];
        [
            1.0 + 0.5 * f64::exp(-slip * slip / 0.09) - stiffness * x[1],
            x[0],
        ]
    };
    let step = |x: [f64; 2], h: f64| {
        let moved = |by: f64, slope: [f64; 2]| [x[0] + by * slope[0], x[1] + by * slope[1]];
        let a = slides(x);
        let b = slides(moved(0.5 * h, a));
        let c = slides(moved(0.5 * h, b));
        let d = slides(moved(h, c));
        moved(
            h / 6.0,
            [0, 1].map(|i| a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]),
        )
    };
    // From rest it is slower than the belt, and is pulled up to its speed.
    let mut known = Vec::new();
    let (mut time, mut x) = (0.0, [0.0, 0.0]);
    for _ in 0..3 {
        let h = 1e-4;
        loop {
            let next = step(x, h);
            if next[0] >= speed && x[0] < speed {
                let part = (speed - x[0]) / (next[0] - x[0]);
                let (mut low, mut high) = (0.0, h);
                let mut middle = part * h;
                for _ in 0..60 {
                    if step(x, middle)[0] < speed {
                        low = middle
                    } else {
                        high = middle
                    }
                    middle = 0.5 * (low + high);
                }
                (time, x) = (time + middle, step(x, middle));
                break;
            }
            (time, x) = (time + h, next);
        }
        known.push(time);
        // The friction at rest is 1.5 N.
        time += (catch - x[1]) / speed;
        x = [speed, catch];
        known.push(time);
        // It leaves by the first step: a speed just below that of the belt.
        x[0] -= 1e-13;
    }
    // The friction by the spring while it sticks, and less while it slips.
    let times: Vec<f64> = known
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect();
    let solver = Adaptive::new(Radau9, 1e-10, 1e-12);
    let mut found = Vec::new();
    solver
        .sample_outputs(
            &model,
            &(),
            0.0,
            model.initial_state(),
            &times,
            |t, x, y| found.push((t, *x, y[0])),
        )
        .unwrap();
    for (phase, (t, x, friction)) in found.iter().enumerate() {
        if phase % 2 == 0 {
            let place = catch - speed * (known[phase + 1] - t);
            let errors = [x[0] - speed, x[1] - place, friction - stiffness * place];
            assert!(
                errors.iter().all(|it| it.abs() < 2e-6),
                "phase {phase}: {errors:?}"
            );
        } else {
            assert!(
                x[0] < speed && *friction < 1.5,
                "phase {phase}: {x} {friction}"
            );
        }
    }
}

/// Outputs are asked on both sides of rest, and are those at rest.
#[test]
fn what_holds_has_no_speed_at_all() {
    fn assert_held<T: Real>(solver: &impl Integrator<1>) {
        let model = Braked::<T>::new(BrakedParameters::default()).unwrap();
        let force = |t: T| T::from_f64(4.0) * (t + T::from_f64(0.3)).sin();
        let input = Smooth(|t: T| SVector::from([force(t)]));
        let times = [0.0, 0.4, 1.0, 1.7, 3.0].map(T::from_f64);
        let (start, rest) = (times[0], model.initial_state());
        let mut count = 0;
        let note = |t: T, x: &SVector<T, 1>, y: &SVector<T, 2>| {
            count += 1;
            let speeds = [x[0], y[0]].map(|it| it.magnitude());
            assert_eq!(speeds, [0.0; 2], "{t:?}");
            let apart = (y[1] - force(t)).magnitude();
            assert!(apart < 16.0 * T::EPSILON, "{t:?}: {apart:e}");
        };
        solver
            .sample_outputs(&model, &input, start, rest, &times, note)
            .unwrap();
        assert_eq!(count, times.len());
    }
    assert_held::<f64>(&NINE);
    assert_held::<f32>(&Adaptive::new(Dop853, 1e-4, 1e-5));
    assert_held::<f64>(&Fixed::new(Rk4, 0.01));
    assert_held::<Dual<f64>>(&Fixed::new(Radau9, 0.01));
}

/// The knee holds: the whole is one pendulum, whose motion has an integral.
#[test]
fn a_hinge_that_rubs_enough_is_none() {
    let model = Rubbing::<f64>::new(RubbingParameters::default()).unwrap();
    // By the parallel axes: of the second rod about the shoulder, with the knee at 0.7 rad.
    let (knee, shoulder) = (0.7_f64, -0.5_f64);
    let inertia = 0.1 + 2.0 * 0.25 + 0.05 + 1.0 * (1.0 + 0.16 + 2.0 * 0.4 * knee.cos());
    let height =
        |angle: f64| 2.0 * 0.5 * angle.sin() + 1.0 * (angle.sin() + 0.4 * (angle + knee).sin());
    let rate = |angle: f64| f64::sqrt(2.0 * 9.81 * (height(shoulder) - height(angle)) / inertia);
    let force = |angle: f64| {
        let lever = |a: f64| 2.0 * 0.5 * a.cos() + a.cos() + 0.4 * (a + knee).cos();
        let turning = -9.81 * lever(angle) / inertia;
        // What the second rod needs about the knee.
        let moment = (0.05 + 0.16) * turning
            + 0.4 * turning * knee.cos()
            + 0.4 * rate(angle).powi(2) * knee.sin();
        moment + 9.81 * 0.4 * (angle + knee).cos()
    };
    let mut turned = Vec::new();
    let times = [0.2, 0.4, 0.6];
    let mut note = |_t: f64, x: &SVector<f64, 4>, y: &SVector<f64, 3>| turned.push((*x, *y));
    NINE.sample_outputs(&model, &(), 0.0, model.initial_state(), &times, &mut note)
        .unwrap();
    for (x, y) in turned {
        let speed = x
            .iter()
            .map(|it| it.abs())
            .find(|it| (it - rate(y[0])).abs() < 1e-7);
        assert!(speed.is_some(), "{x} instead of {}", rate(y[0]));
        assert!((y[1] - knee).abs() < 1e-12, "{}", y[1]);
        assert!(
            (y[2] + force(y[0])).abs() < 1e-6,
            "{} instead of {}",
            y[2],
            force(y[0])
        );
    }
    // By implicit methods, whose Jacobian knows of what holds, and where it slips now and then.
    let model = Rubbing::<f64>::new(RubbingParameters { friction: 3.0 }).unwrap();
    let expected = last(&model, &(), 3.0, &Adaptive::new(Dop853, 1e-11, 1e-12)).0;
    for (method, state, _) in by_each(&model, &(), 3.0) {
        assert!(
            (state - expected).amax() < 1e-7,
            "{method}: {state} instead of {expected}"
        );
    }
}

#[test]
fn what_comes_to_a_threshold_and_goes_back_does_not_stay() {
    let model = Thrown::new(ThrownParameters::default()).unwrap();
    // At 1 s it is at the threshold, at rest.
    for (method, state, _) in by_each(&model, &(), 3.0) {
        let error = (state - SVector::from([-2.0, -1.5])).amax();
        assert!(error < 1e-6, "{method}: {error:e}");
    }
}

/// Where runs of two kinds of methods end that begin at a state, with slopes.
fn ends<const M: usize, const P: usize>(
    model: &impl System<Dual<f64>, 2, M, P>,
    start: SVector<Dual<f64>, 2>,
    end: f64,
) -> [SVector<Dual<f64>, 2>; 2] {
    fn run<const M: usize, const P: usize>(
        solver: &impl Integrator<2>,
        model: &impl System<Dual<f64>, 2, M, P>,
        start: SVector<Dual<f64>, 2>,
        end: f64,
    ) -> SVector<Dual<f64>, 2> {
        let input = Constant(SVector::from_element(Dual::constant(0.0)));
        let [begin, end] = [0.0, end].map(Dual::constant);
        let mut state = start;
        solver
            .integrate(model, &input, begin, end, start, |step| {
                state = *step.state()
            })
            .unwrap();
        state
    }
    let linear = Adaptive::new(Rodas5P, 1e-9, 1e-11);
    [
        run(&NINE, model, start, end),
        run(&linear, model, start, end),
    ]
}

/// What slips until it is caught, or does not even begin to, loses what it had: both together have the momentum of both.
#[test]
fn slopes_of_what_is_caught_are_those_of_both_together() {
    let model = Stacked::<Dual<f64>>::new(StackedParameters::default()).unwrap();
    for momenta in [[1.0, 12.0], [2.0, 6.0]] {
        for by in 0..2 {
            let mut start = SVector::from(momenta.map(Dual::constant));
            start[by].slope = 1.0;
            // The floor takes 1 N all the time; a quarter of the momentum is with each kilogram.
            let whole = momenta[0] + momenta[1] - 2.0;
            for state in ends(&model, start, 2.0) {
                for (state, part) in state.iter().zip([0.25, 0.75]) {
                    let errors = [state.value - part * whole, state.slope - part];
                    assert!(
                        errors.iter().all(|it| it.abs() < 1e-8),
                        "by {by} from {momenta:?}: {errors:?}"
                    );
                }
            }
        }
    }
}

/// What the push tears loose from the floor takes along what holds on it.
#[test]
fn slopes_of_what_is_torn_loose_together_are_those_of_both() {
    let model = Stacked::<Dual<f64>>::new(StackedParameters::default()).unwrap();
    let push = Constant(SVector::from([Dual::constant(4.0)]));
    let [begin, end] = [0.0, 1.0].map(Dual::constant);
    for by in 0..2 {
        let mut state = SVector::from([begin; 2]);
        state[by].slope = 1.0;
        NINE.integrate(&model, &push, begin, end, state, |step| {
            state = *step.state()
        })
        .unwrap();
        for (state, part) in state.iter().zip([0.25, 0.75]) {
            let errors = [state.value - 3.0 * part, state.slope - part];
            let worst = errors.iter().fold(0.0, |worst, it| it.abs().max(worst));
            assert!(worst < 1e-8, "by {by}: {errors:?}");
        }
    }
}

/// By the friction, the place and the speed at the start: half swings turn the slope by the place about, and each is longer by half of
/// the friction.
#[test]
fn slopes_are_those_of_where_it_holds() {
    for (by, expected) in [3.5, -1.0, 0.0].into_iter().enumerate() {
        let mut numbers = [1.0, 3.3, 0.0].map(Dual::constant);
        numbers[by].slope = 1.0;
        let [friction, place, speed] = numbers;
        let model = Block::new(BlockParameters { friction }).unwrap();
        for state in ends(&model, SVector::from([speed, place]), 30.0) {
            let slopes = [state[0].slope, state[1].slope - expected];
            assert!(
                slopes.iter().all(|it| it.abs() < 1e-7),
                "by {by}: {slopes:?}"
            );
        }
    }
}

/// An event at the time at which the mass is torn loose, as the friction is at its bound.
/// What rounding leaves of slopes of what holds is none by which steps are measured.
#[test]
fn slopes_of_a_motor_that_is_held_at_first_take_few_steps() {
    fn angle<T: Real>(coulomb: T, end: f64) -> (T, u64) {
        let parameters = MotorParameters {
            coulomb,
            ..Default::default()
        };
        let model = Motor::new(parameters).unwrap();
        let solver = Adaptive::new(Dop853, 1e-10, 1e-12);
        let (_, outputs, statistics) = last(&model, &Constant(SVector::from([])), end, &solver);
        (outputs[0], statistics.steps + statistics.rejected)
    }
    for (coulomb, end) in [(0.3, 0.1), (0.1, 0.02)] {
        let (found, tried) = angle(Dual::variable(coulomb), end);
        let apart = 1e-5;
        let [less, more] = [coulomb - apart, coulomb + apart].map(|it| angle(it, end).0);
        let expected = (more - less) / (2.0 * apart);
        let error = (found.slope - expected).abs();
        assert!(
            error < 1e-6 * expected.abs() + 1e-12,
            "{coulomb}: {error:e} of {expected:e}"
        );
        assert!(tried < 300, "{coulomb}: {tried}");
    }
}

#[test]
fn events_are_found_where_a_motion_stays() {
    let model = Block::new(BlockParameters { friction: 2.0 }).unwrap();
    let still = SVector::from([0.0, 0.25]);
    let growing = Smooth(|t: f64| SVector::from([t]));
    let guard = (Direction::Rising, |_t: f64, x: &SVector<f64, 2>| {
        x[1] - 0.25 - 1e-9
    });
    let arrival = NINE
        .until(&model, &growing, 0.0, 10.0, still, guard, |_step| ())
        .unwrap();
    // From 3 s on: x'' = τ − 4 x, so that x = (τ − sin(2 τ) / 2) / 4, about τ³ / 6.
    let after = f64::cbrt(6e-9);
    assert!(
        arrival.found && (arrival.time - 3.0 - after).abs() < 1e-6,
        "{}",
        arrival.time - 3.0
    );
    // Steps end where it is torn loose.
    let mut ends = Vec::new();
    NINE.integrate(&model, &growing, 0.0, 4.0, still, |step| {
        ends.push(step.end())
    })
    .unwrap();
    assert!(ends.iter().any(|end| (end - 3.0).abs() < 1e-7), "{ends:?}");
}

#[test]
fn many_hold_at_once() {
    let model = Row::new(RowParameters::default()).unwrap();
    let mut state = SVector::<f64, 12>::from_fn(|place, _| 0.1 * place as f64 - 0.3);
    let statistics = NINE
        .integrate(&model, &(), 0.0, 5.0, state, |step| state = *step.state())
        .unwrap();
    assert!(
        state.amax() < 1e-12 && statistics.steps < 200,
        "{state} {statistics:?}"
    );
}

#[test]
fn what_holds_is_found_by_methods_of_low_order_and_those_picked() {
    let model = Block::<f64>::new(BlockParameters::default()).unwrap();
    let solver = Adaptive {
        most: 200_000,
        ..Adaptive::new(Ros2, 1e-6, 1e-8)
    };
    let (state, outputs, _) = last(&model, &(), 30.0, &solver);
    assert!(
        (state[1] - 0.2).abs() < 1e-3 && (outputs[0] + 0.8).abs() < 4e-3,
        "{state} {outputs}"
    );
    let (state, outputs, _) = last(&model, &(), 30.0, &Auto::new(1e-9, 1e-11));
    assert!(
        (state[1] - 0.2).abs() < 1e-8 && (outputs[0] + 0.8).abs() < 4e-8,
        "{state} {outputs}"
    );
}
