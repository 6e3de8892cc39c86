//! Thresholds that are along each other, or are met one after the other.

use mbg_runtime::{
    Adaptive, Auto, Constant, Dop853, Fixed, Gauss6, ImplicitMidpoint, Radau5, Radau9, Rk4,
    Rodas5P, System, Tsit5, mbg,
};
use nalgebra::SVector;

use super::last;

mbg! {
    /// A box on two feet on a slope; at rest they hold, or creep.
    component Chest(port 1 case[3]) {
        param at_rest: creeps | holds = creeps;
        integral angle: rad = case.f.x;
        integral x: m = case.f.y;
        integral y: m = case.f.z, initial: 0.1;
        let rubs: N = rear.rubbing.contact.e + fore.rubbing.contact.e;

        1 left[3]; 1 right[3];
        body: PlanarBody { mass: 3.0, inertia: 0.05 } (case);
        back: PlanarOffset { x: -0.2, y: -0.1, angle_a: angle, position_a: [x, y] } (case, left);
        front: PlanarOffset { x: 0.2, y: -0.1, angle_a: angle, position_a: [x, y] } (case, right);
        rear: PlanarContact {
            stiffness: 1e5, dissipation: 0.5, friction: 0.3, at_rest: at_rest, friction_speed: 1e-6,
            position_at: back.position_b
        } (left);
        fore: PlanarContact {
            stiffness: 1e5, dissipation: 0.5, friction: 0.3, at_rest: at_rest, friction_speed: 1e-6,
            position_at: front.position_b
        } (right);
    }

    /// It slides down, and stops.
    model Feet {
        gravity [9.81 * sin(0.1), -9.81 * cos(0.1)];
        1 case[3] coordinate, initial_flow: [0.0, 2.0, 0.0];
        chest: Chest { at_rest: holds } (case);
        output place: m = chest.x;
        output rubs: N = chest.rubs;
    }

    /// The same, whose feet creep.
    model Creeping {
        gravity [9.81 * sin(0.1), -9.81 * cos(0.1)];
        1 case[3] coordinate, initial_flow: [0.0, 2.0, 0.0];
        chest: Chest (case);
        output place: m = chest.x;
        output rubs: N = chest.rubs;
    }

    /// A ball slides on an alley until it rolls.
    model Alley {
        gravity [0.0, -9.81];
        1 ball[3] coordinate, initial_flow: [0.0, 5.0, 0.0];
        body: PlanarBody { mass: 6.0, inertia: 0.4 * 6.0 * 0.11 * 0.11 } (ball);
        integral x: m = ball.f.y;
        integral y: m = ball.f.z, initial: 0.11 - 6.0 * 9.81 / 1e6;
        boards: PlanarContact {
            stiffness: 1e6, dissipation: 0.1, friction: 0.15, at_rest: holds, radius: 0.11, position_at: [x, y]
        } (ball);
        output speed: m/s = ball.f.y;
        output rub: N = boards.rubbing.contact.e;
    }

    /// A body pushes another one until a force takes that away, and catches up.
    model Pusher {
        param freed: s = 1.0037;
        1 a { I behind { inertia: 1.0, initial_flow: 1.0 } Se drive { effort: 3.0 } }
        1 c {
            I ahead { inertia: 1.0, initial_flow: 1.0 }
            Se pull { effort: if t < freed { 0.0 } else { 8.0 } }
            R air { resistance: 1.0 }
        }
        wheel: Freewheel { capacity: 50.0 } (a, c);
        output speeds[2]: m/s = [a.f, c.f];
    }

    /// Two bodies that push a third one.
    model Pushers {
        param second: N = 15.0;
        1 a { I first { inertia: 1.0, initial_flow: 1.0 } Se drive { effort: 3.0 } }
        1 b { I other { inertia: 1.0 } Se help { effort: second } }
        1 c { I ahead { inertia: 1.0, initial_flow: 1.0 } R air { resistance: 1.0 } }
        near: Freewheel { capacity: 50.0 } (a, c);
        far: Freewheel { capacity: 50.0 } (b, c);
        output speeds[3]: m/s = [a.f, b.f, c.f];
    }

    /// Two engines on one gearbox, of which one stands still for a while.
    model Engines {
        param on: s = 4.0;
        1 left { I turbine { inertia: 1.0, initial_flow: 100.0 } Se gas { effort: 300.0 } R wind { resistance: 0.4 } }
        1 right {
            I other { inertia: 1.5, initial_flow: 100.0 }
            Se fuel { effort: if t < on { 0.0 } else { 350.0 } }
            R gale { resistance: 0.5 }
        }
        1 shaft { I wheels { inertia: 6.0, initial_flow: 100.0 } R air { effort: 0.03 * f * abs(f) } }
        port: Freewheel { capacity: 2000.0 } (left, shaft);
        starboard: Freewheel { capacity: 2000.0 } (right, shaft);
        output efforts[2]: N*m = [port.effort, starboard.effort];
        output speed: rad/s = shaft.f;
        output slips[2]: rad/s = [port.slip, starboard.slip];
    }

    /// Brakes on two shafts, and a clutch between them: where two of them hold, the third one does.
    model Braked {
        param torque: N*m = 0.5;
        param speed: rad/s = 0.0;
        1 a { I motor { inertia: 1.0, initial_flow: speed } Se drive { effort: torque } }
        1 b { I load { inertia: 1.0 } }
        near: Brake { capacity: 1.0 } (a);
        far: Brake { capacity: 1.0 } (b);
        between: Clutch { capacity: 1.0 } (a, b);
        output speeds[2]: rad/s = [a.f, b.f];
        output efforts[3]: N*m = [near.effort, far.effort, between.effort];
    }

    /// The same on three shafts in a ring.
    model Ring {
        1 a { I first { inertia: 1.0 } Se drive { effort: 0.5 } }
        1 b { I second { inertia: 1.0 } }
        1 c { I third { inertia: 1.0 } }
        x: Clutch { capacity: 1.0 } (a, b);
        y: Clutch { capacity: 1.0 } (b, c);
        z: Clutch { capacity: 1.0 } (c, a);
        output speeds[3]: rad/s = [a.f, b.f, c.f];
    }

    /// A pump through a check valve into a chamber with a relief valve, and a rod whose seal rubs.
    model Relieved {
        input flow;
        0 a { C inlet { stiffness: 1.0, initial: 3.2 } Sf pump { flow: flow } }
        0 b { C chamber { stiffness: 1.0, initial: 2.9 } R relief { flow: if e > 3.0 { 1.0 } else { 0.0 } } }
        1 check { R seat { conductance: 1.0 } }
        a -> check -> b;
        1 rod { I mass { inertia: 1.0 } R seal { effort: 1.0 * sign(f) } Se load { effort: -2.5 } }
        b -> rod;
    }
}

/// What a run by each method comes to at an end, with the names; fixed steps are so long.
pub(super) fn by_all<const N: usize, const P: usize>(
    model: &impl System<f64, N, 0, P>,
    end: f64,
    tolerance: f64,
    step: f64,
) -> Vec<(&'static str, SVector<f64, N>, SVector<f64, P>)> {
    macro_rules! by {
        ($($name:literal: $solver:expr),*) => {
            vec![$({
                let (state, outputs, statistics) = last(model, &(), end, &$solver);
                assert!(statistics.steps + statistics.rejected < 9000, "{}: {statistics:?}", $name);
                ($name, state, outputs)
            },)*]
        };
    }
    by!(
        "Tsit5": Adaptive::new(Tsit5, tolerance, tolerance),
        "Dop853": Adaptive::new(Dop853, tolerance, tolerance),
        "Rodas5P": Adaptive::new(Rodas5P, tolerance, tolerance),
        "Radau9": Adaptive::new(Radau9, tolerance, tolerance),
        "Auto": Auto::new(tolerance, tolerance),
        "RK4": Fixed::new(Rk4, step),
        "fixed Tsit5": Fixed::new(Tsit5, step),
        "fixed Dop853": Fixed::new(Dop853, step),
        "Gauss6": Fixed::new(Gauss6::default(), step),
        "fixed Radau5": Fixed::new(Radau5, step)
    )
}

/// Both feet slip alike but for what the box turns; while it rocks one of them holds, now this one and now that one.
#[test]
fn a_box_stands_on_two_feet_that_rub() {
    let model = Feet::<f64>::new(FeetParameters::default()).unwrap();
    // Friction is the same up to the slip of 1e-6 m/s.
    let creeping = Creeping::<f64>::new(CreepingParameters::default()).unwrap();
    let (_, expected, _) = last(&creeping, &(), 2.0, &Adaptive::new(Radau9, 1e-9, 1e-9));
    for (name, _, outputs) in by_all(&model, 2.0, 1e-8, 1e-3) {
        let error = outputs[0] - expected[0];
        assert!(error.abs() < 2e-6, "{name}: {error:e}");
        // It holds the weight along the slope, but for what rocks.
        let weight = 3.0 * 9.81 * f64::sin(0.1);
        assert!((outputs[1] - weight).abs() < 0.1, "{name}: {outputs}");
    }
    let midpoint = Fixed::new(ImplicitMidpoint::default(), 1e-3);
    let (_, outputs, _) = last(&model, &(), 2.0, &midpoint);
    assert!((outputs[0] - expected[0]).abs() < 1e-5, "{outputs}");
}

#[test]
fn a_ball_slides_until_it_rolls() {
    let model = Alley::<f64>::new(AlleyParameters::default()).unwrap();
    for (name, _, outputs) in by_all(&model, 2.0, 1e-9, 1e-3) {
        let error = outputs[0] - 5.0 * 5.0 / 7.0;
        assert!(error.abs() < 1e-8, "{name}: {error:e}");
        assert!(outputs[1].abs() < 1e-6, "{name}: {outputs}");
    }
}

/// The speed of both at 3 s: both as one, each alone, and both again.
fn caught_again(freed: f64) -> f64 {
    let drag = |speed: f64, force: f64, mass: f64, time: f64| {
        force - (force - speed) * f64::exp(-time / mass)
    };
    let at_once = drag(1.0, 3.0, 2.0, freed);
    let (mut early, mut late) = (0.1, 3.0);
    for _ in 0..60 {
        let time = 0.5 * (early + late);
        match at_once + 3.0 * time > drag(at_once, 8.0, 1.0, time) {
            true => late = time,
            false => early = time,
        }
    }
    drag(at_once + 3.0 * late, 11.0, 2.0, 3.0 - freed - late)
}

#[test]
fn what_is_let_go_is_caught_again() {
    // Wherever within a step that is.
    for part in 0..40 {
        let freed = 0.9 + 0.1 * f64::from(part) / 40.0;
        let model = Pusher::<f64>::new(PusherParameters { freed }).unwrap();
        for (name, _, outputs) in by_all(&model, 3.0, 1e-9, 0.1) {
            let errors = outputs.map(|speed| speed - caught_again(freed));
            assert!(errors.amax() < 2e-6, "{name} from {freed}: {errors}");
        }
    }
    let model = Pusher::<f64>::new(PusherParameters::default()).unwrap();
    for step in [0.03, 0.01, 0.003] {
        for (name, _, outputs) in by_all(&model, 3.0, 1e-10, step) {
            let errors = outputs.map(|speed| speed - caught_again(1.0037));
            assert!(errors.amax() < 1e-8, "{name} by {step}: {errors}");
        }
    }
}

#[test]
fn one_is_met_while_another_holds() {
    for second in [2.0, 4.0, 10.0, 15.0, 20.0] {
        let model = Pushers::<f64>::new(PushersParameters { second }).unwrap();
        let (_, expected, _) = last(&model, &(), 3.0, &Adaptive::new(Dop853, 1e-12, 1e-13));
        if second == 20.0 {
            let by_hand =
                SVector::from([9.894_123_456_179, 15.659_450_789_415, 15.659_450_789_415]);
            assert!((expected - by_hand).amax() < 1e-9, "{expected}");
        }
        for (name, _, outputs) in by_all(&model, 3.0, 1e-9, 0.01) {
            let errors = outputs - expected;
            assert!(errors.amax() < 1e-7, "{name} with {second}: {errors}");
        }
    }
}

#[test]
fn two_engines_drive_one_gearbox() {
    for tenths in 10..70 {
        let on = 0.1 * f64::from(tenths);
        let model = Engines::<f64>::new(EnginesParameters { on }).unwrap();
        for solver in [1e-7, 1e-9].map(|tolerance| Adaptive::new(Dop853, tolerance, tolerance)) {
            let (_, outputs, statistics) = last(&model, &(), 9.0, &solver);
            assert!(statistics.steps < 60, "{on}: {statistics:?}");
            let [left, right, speed] = [outputs[0], outputs[1], outputs[2]];
            let rate = (650.0 - 0.9 * speed - 0.03 * speed * speed) / 8.5;
            let errors = [
                left - (300.0 - 0.4 * speed - rate),
                right - (350.0 - 0.5 * speed - 1.5 * rate),
                outputs[3],
                outputs[4],
            ];
            assert!(
                errors.iter().all(|error| error.abs() < 1e-6),
                "{on}: {errors:?}"
            );
        }
    }
}

/// Stages of a step for its dense output alone, beyond the threshold at which it is at rest, tell of no place where it is torn loose.
#[test]
fn what_rests_beside_a_threshold_stays_there() {
    let model = Relieved::<f64>::new(RelievedParameters::default()).unwrap();
    for tolerance in [1e-6, 1e-7, 1e-8, 1e-9] {
        let solver = Adaptive::new(Dop853, tolerance, tolerance);
        let (state, _, _) = last(&model, &Constant(SVector::from([1.0])), 500.0, &solver);
        let errors = state - SVector::from([4.0, 3.0, 0.0]);
        assert!(errors.amax() < 1e-6, "{tolerance:e}: {errors}");
    }
}

#[test]
fn what_holds_by_others_holds_too() {
    for (torque, speed) in [(0.5, 0.0), (1.5, 0.0), (0.0, 1.0), (0.5, 1.0)] {
        let model = Braked::<f64>::new(BrakedParameters { torque, speed }).unwrap();
        for (name, _, outputs) in by_all(&model, 4.0, 1e-9, 0.01) {
            let [a, b, near, far, between] = outputs.into();
            // All that holds is in balance, each within its capacity.
            let errors = [a, b, near + between - torque, far - between];
            assert!(errors.iter().all(|it| it.abs() < 1e-9), "{name}: {outputs}");
            let efforts = [near, far, between];
            assert!(
                efforts.iter().all(|it| it.abs() <= 1.0 + 1e-9),
                "{name}: {outputs}"
            );
        }
    }
    let model = Braked::<f32>::new(BrakedParameters {
        torque: 1.5,
        speed: 1.0,
    })
    .unwrap();
    let (state, _, _) = last(&model, &(), 4.0, &Fixed::new(Rk4, 0.01));
    assert!(state.amax() < 1e-6, "{state}");
    let model = Ring::<f64>::new(RingParameters::default()).unwrap();
    for (name, _, outputs) in by_all(&model, 4.0, 1e-9, 0.01) {
        let errors = outputs.map(|speed| speed - 0.5 * 4.0 / 3.0);
        assert!(errors.amax() < 1e-9, "{name}: {outputs}");
    }
}

mbg! {
    /// A box on two corners that both hold, and slip alike but for what it turns.
    #[derivative]
    model Standing {
        causality componentwise;
        param friction = 0.5;
        param stiffness: N/m = 1e5;
        param dissipation: s/m = 1.0;
        param depth: m = 0.0;
        param push: N = 0.0;
        gravity [0.0, -9.81];
        1 ground[3]; 1 rail[3]; 1 axle[3]; 1 block[3]; 1 left[3]; 1 right[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        along: PlanarPrismatic { force: push } (ground, rail);
        up: PlanarPrismatic { direction: 1.5707963267948966, initial: 0.2 - depth } (rail, axle);
        turn: PlanarRevolute (axle, block);
        body: PlanarBody { mass: 2.0, inertia: 0.1 / 3.0 } (block);
        to_left: PlanarOffset { x: -0.1, y: -0.2 } (block, left);
        to_right: PlanarOffset { x: 0.1, y: -0.2 } (block, right);
        one: PlanarContact {
            stiffness: stiffness, dissipation: dissipation, friction: friction, at_rest: holds
        } (left);
        other: PlanarContact {
            stiffness: stiffness, dissipation: dissipation, friction: friction, at_rest: holds
        } (right);
        output travel: m = along.travel;
        output forces[2]: N = [one.force, other.force];
    }
}

/// Released just above the ground it comes to stand; pushed harder than it holds it slides, once the corners no longer hold it up.
#[test]
fn a_box_on_two_corners_stands_and_slides() {
    let soft = StandingParameters {
        stiffness: 1e4,
        dissipation: 20.0,
        ..Default::default()
    };
    let rest = 2.0 * 9.81 / 2e5;
    let pushed = StandingParameters {
        friction: 0.3,
        depth: rest,
        push: 12.0,
        ..Default::default()
    };
    macro_rules! by {
        ($($name:literal: $solver:expr),*) => {
            $({
                let found = |parameters, end| {
                    let model = Standing::new(parameters).unwrap();
                    let (_, outputs, statistics) = last(&model, &(), end, &$solver);
                    let tried = statistics.steps + statistics.rejected;
                    assert!(tried < 12_000, "{}: {tried}", $name);
                    <[f64; 3]>::from(outputs)
                };
                let [travel, one, other] = found(soft.clone(), 1.0);
                assert!(travel.abs() < 1e-9, "{}: {travel:e}", $name);
                for force in [one, other] {
                    assert!((force - 9.81).abs() < 1e-6, "{}: {force}", $name);
                }
                found(StandingParameters::default(), 0.3);
                // By four methods that agree to nine digits, at a tolerance of 1e-7 and less.
                let [travel, ..] = found(pushed.clone(), 1.0);
                assert!((travel - 1.532_878_452).abs() < 1e-8, "{}: {travel}", $name);
            })*
        };
    }
    by!(
        "Dop853": Adaptive::new(Dop853, 1e-8, 1e-10),
        "Rodas5P": Adaptive::new(Rodas5P, 1e-8, 1e-10),
        "Radau9": Adaptive::new(Radau9, 1e-8, 1e-10),
        "RK4": Fixed::new(Rk4, 1e-4)
    );
}
