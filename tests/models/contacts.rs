//! Stops of joints and contacts with the ground.

use std::f64::consts::PI;

use mbg_runtime::{
    Adaptive, Direction, Dop853, Dual, Fixed, Integrator, Radau5, Radau9, Rk4, Rodas4, Rodas5P,
    System, Tsit5, Verner9, mbg,
};
use nalgebra::SVector;

use super::audit::{assert_sound_about_the_start, near};
use super::energy::imbalance;

mbg! {
    include "tests/models/contacts.mbg";
}

const STIFFNESS: f64 = 1e4;
const MASS: f64 = 2.0;

/// The state at the end, and the outputs after each step.
fn run<S, const N: usize, const P: usize>(
    model: &S,
    end: f64,
) -> (SVector<f64, N>, Vec<SVector<f64, P>>)
where
    S: System<f64, N, 0, P>,
{
    let (mut last, mut shown) = (model.initial_state(), Vec::new());
    Adaptive::new(Dop853, 1e-10, 1e-12)
        .integrate(model, &(), 0.0, end, last, |step| {
            last = *step.state();
            shown.push(shot(model, &last));
        })
        .unwrap();
    (last, shown)
}

fn shot<S, const N: usize, const P: usize>(model: &S, x: &SVector<f64, N>) -> SVector<f64, P>
where
    S: System<f64, N, 0, P>,
{
    model.output(0.0, x, &SVector::zeros(), &mut Default::default())
}

fn dropped(falling: f64, dissipation: f64, [height, speed]: [f64; 2]) -> Dropped<f64> {
    Dropped::new(DroppedParameters {
        falling,
        dissipation,
        height,
        speed,
    })
    .unwrap()
}

#[test]
fn what_is_dropped_rests_where_the_floor_carries_it() {
    let model = dropped(9.81, 3.0, [0.01, 0.0]);
    let (_, shown) = run(&model, 60.0);
    let [force, depth] = shown[shown.len() - 1].into();
    near(force, MASS * 9.81, 1e-4);
    assert!((depth - MASS * 9.81 / STIFFNESS).abs() < 1e-7, "{depth}");
    // There it is in balance.
    let rest = SVector::from([-MASS * 9.81 / STIFFNESS, 0.0]);
    let place = Dropped::<f64>::META.state("fall.travel").unwrap();
    let rest = if place == 0 {
        rest
    } else {
        SVector::from([rest[1], rest[0]])
    };
    let rates = model.derivative(0.0, &rest, &SVector::zeros(), &mut Default::default());
    assert!(rates.norm() < 1e-12, "{rates}");
}

/// Half an oscillation: as long as π √(m / k), with the most force v √(k m), and back at the same speed.
#[test]
fn a_bounce_without_loss_is_half_an_oscillation() {
    let model = dropped(0.0, 0.0, [0.0, 3.0]);
    let lasting = PI * f64::sqrt(MASS / STIFFNESS);
    let place = Dropped::<f64>::META.state("fall.travel").unwrap();
    let solver = Adaptive::new(Dop853, 1e-11, 1e-13);
    let start = model.initial_state();
    let mut most = 0.0_f64;
    let leaving = |_t, x: &SVector<f64, 2>| x[place];
    let end = solver
        .until(
            &model,
            &(),
            0.0,
            1.0,
            start,
            (Direction::Rising, leaving),
            |step| {
                for part in 0..=20 {
                    let time = step.start() + (step.end() - step.start()) * f64::from(part) / 20.0;
                    most = most.max(shot(&model, &step.at(time))[0]);
                }
            },
        )
        .unwrap();
    assert!(end.found);
    near(end.time, lasting, 1e-9);
    near(end.state[1 - place], 3.0, 1e-9);
    near(most, 3.0 * f64::sqrt(STIFFNESS * MASS), 1e-3);
}

/// Of `m v dv/dx = -k x (1 + a v)` the function `a v - ln(1 + a v)` is the same before and after.
#[test]
fn dissipation_takes_from_the_rebound() {
    for (dissipation, speed) in [(0.02, 1.0), (0.3, 1.0), (2.0, 3.0)] {
        let model = dropped(0.0, dissipation, [0.0, speed]);
        let place = Dropped::<f64>::META.state("fall.travel").unwrap();
        let (last, shown) = run(&model, 1.0);
        let gone = last[1 - place];
        let held = |speed: f64| dissipation * speed - f64::ln_1p(dissipation * speed);
        near(held(-gone), held(speed), 1e-7);
        if dissipation * speed < 0.1 {
            assert!((gone / speed - (1.0 - dissipation * speed / 1.5)).abs() < 1e-3);
        }
        // It never pulls.
        assert!(shown.iter().all(|it| it[0] >= 0.0));
    }
}

/// Also where it is pulled out fast, and nothing is lost or won where it touches.
#[test]
fn forces_push_and_are_numbers() {
    let model = dropped(9.81, 0.7, [0.0, 0.0]);
    let place = Dropped::<f64>::META.state("fall.travel").unwrap();
    for depth in [-0.1, -1e-9, 0.0, 1e-9, 0.1] {
        for speed in [-30.0, -1.0, 0.0, 1.0, 30.0] {
            let mut x = SVector::from([speed; 2]);
            x[place] = -depth;
            let force = shot(&model, &x)[0];
            let expected = STIFFNESS * f64::max(depth, 0.0) * f64::max(1.0 - 0.7 * speed, 0.0);
            assert!(force >= 0.0);
            near(force, expected, 1e-13);
            let rates = model.derivative(0.0, &x, &SVector::zeros(), &mut Default::default());
            near(MASS * (rates[1 - place] + 9.81), expected, 1e-12);
            let power = model.power(0.0, &x, &SVector::zeros(), &mut Default::default());
            assert!(power.dissipated >= 0.0);
            let slopes = model.jacobian_state(0.0, &x, &SVector::zeros(), &mut Default::default());
            assert!(slopes.iter().all(|it| it.is_finite()));
        }
    }
    // At rest on the ground nothing is divided by the slip.
    let block = Block::new(BlockParameters::default()).unwrap();
    let start = block.initial_state();
    let rates = block.derivative(0.0, &start, &SVector::zeros(), &mut Default::default());
    assert!(rates.norm() < 1e-12, "{rates}");
    let slopes = block.jacobian_state(0.0, &start, &SVector::zeros(), &mut Default::default());
    // Friction at rest is a damper of μ m g / (friction_speed m).
    let place = Block::<f64>::META.state("mass.body.p.x").unwrap();
    near(slopes[(place, place)], -0.5 * 9.81 / 1e-2, 1e-9);
    assert!(slopes.iter().all(|it| it.is_finite()));
}

/// The way is `∫ v / (μ g tanh(v / s)) dv = (v² / 2 + π² s² / 12) / (μ g)`, straight on.
#[test]
fn a_block_slides_to_rest() {
    for friction_speed in [1e-2, 1e-3] {
        let model = Block::new(BlockParameters {
            speeds: [1.2, -1.6],
            friction_speed,
            ..Default::default()
        })
        .unwrap();
        let (_, shown) = run(&model, 2.0);
        let last = shown[shown.len() - 1];
        let way = (2.0 * 2.0 / 2.0 + f64::powi(PI * friction_speed, 2) / 12.0) / (0.5 * 9.81);
        near(last[0], 0.6 * way, 1e-7);
        near(last[1], -0.8 * way, 1e-7);
        let rubbing = shown[0].fixed_rows::<3>(3).norm();
        near(rubbing, 0.5 * MASS * 9.81, 1e-7);
    }
}

#[test]
fn a_block_slides_down_a_steep_slope_and_creeps_on_another() {
    let model = |slope: f64| {
        Block::new(BlockParameters {
            slope,
            ..Default::default()
        })
        .unwrap()
    };
    let (_, shown) = run(&model(0.6), 1.0);
    let down = |shown: &[SVector<f64, 6>]| -shown[shown.len() - 1][1];
    // It begins at rest, where friction is that of a damper: later by less than friction_speed over the acceleration.
    let slope = 9.81 * (f64::sin(0.6) - 0.5 * f64::cos(0.6));
    assert!((down(&shown) - 0.5 * slope).abs() < 1.5e-2);
    let (_, before) = run(&model(0.3), 1.0);
    let (_, after) = run(&model(0.3), 2.0);
    let creep = 1e-2 * f64::atanh(f64::tan(0.3) / 0.5);
    near((down(&after) - down(&before)) / creep, 1.0, 1e-8);
}

/// A ball that begins to slide rolls with 5/7 of its speed, whose slip is zero; backspin turns it round.
#[test]
fn a_ball_begins_to_roll() {
    for (spin, rolling) in [(0.0, 5.0 / 7.0 * 2.0), (-70.0, (2.0 - 0.4 * 7.0) / 1.4)] {
        let model = Ball::new(BallParameters {
            stiffness: 1e4,
            friction_speed: 1e-3,
            speeds: [2.0, 0.0, 0.0],
            spin: [0.0, spin, 0.0],
        })
        .unwrap();
        let mut start = model.initial_state();
        let place = Ball::<f64>::META.state("free.position.z").unwrap();
        start[place] -= 0.5 * 9.81 / 1e4;
        // Its axes are those of the world.
        let quaternion = Ball::<f64>::META
            .state("free.rotation.quaternion.0")
            .unwrap();
        start
            .rows_mut(quaternion, 4)
            .copy_from(&SVector::from([1.0, 0.0, 0.0, 0.0]));
        let momentum = Ball::<f64>::META.state("body.body.p.x").unwrap();
        start
            .rows_mut(momentum, 3)
            .copy_from(&SVector::from([1.0, 0.0, 0.0]));
        let mut last = start;
        Adaptive::new(Radau5, 1e-9, 1e-11)
            .integrate(&model, &(), 0.0, 3.0, start, |step| last = *step.state())
            .unwrap();
        let shown = shot(&model, &last);
        near(shown[0], 0.5 * 9.81, 1e-6);
        near(shown[1], rolling, 1e-6);
        near(shown[8], rolling / 0.1, 1e-5);
        assert!(shown.fixed_rows::<3>(4).norm() < 1e-6);
    }
}

/// By the rolling resistance, at `0.02 g / (1 + 0.24 / (4 0.3²))` on the level; on a slope below it it stays where it stops.
#[test]
fn a_wheel_rolls_to_rest() {
    let wheel = |slope, speed| Wheel::new(WheelParameters { slope, speed }).unwrap();
    let by_all = |model: &Wheel<f64>, end, expected: [f64; 2]| {
        macro_rules! ends {
            ($($method:expr),*) => {[$({
                let mut last = model.initial_state();
                $method.integrate(model, &(), 0.0, end, last, |step| last = *step.state()).unwrap();
                shot(model, &last)
            }),*]};
        }
        for shown in ends!(
            Adaptive::new(Dop853, 1e-9, 1e-11),
            Adaptive::new(Radau9, 1e-9, 1e-11),
            Adaptive::new(Rodas5P, 1e-9, 1e-11),
            Fixed::new(Radau5, 1e-2),
            Fixed::new(Rk4, 5e-4)
        ) {
            let error = (shown - SVector::from(expected)).norm();
            assert!(error < 1e-7, "{shown} instead of {expected:?}");
        }
    };
    let (speed, taken) = (1.5, 0.02 * 9.81 * 0.6);
    let [before, behind] = [10.0, 15.0];
    assert!(before < speed / taken && speed / taken < behind);
    let (level, way) = (
        wheel(0.0, speed),
        speed * before - 0.5 * taken * before * before,
    );
    by_all(&level, before, [way, speed - taken * before]);
    by_all(&level, behind, [0.5 * speed * speed / taken, 0.0]);
    by_all(&wheel(0.019, 0.0), 2.0, [0.0, 0.0]);
    let down = 9.81 * 0.6 * (f64::sin(0.03) - 0.02 * f64::cos(0.03));
    by_all(&wheel(0.03, 0.0), 2.0, [2.0 * down, 2.0 * down]);
}

/// Straight on, wherever it rolls to, but for what it creeps.
#[test]
fn a_ball_rolls_to_rest() {
    let friction_speed = 1e-4;
    let model = Bowl::new(BowlParameters {
        friction_speed,
        ..Default::default()
    })
    .unwrap();
    let mut last = model.initial_state();
    Adaptive::new(Radau5, 1e-9, 1e-11)
        .integrate(&model, &(), 0.0, 8.0, last, |step| last = *step.state())
        .unwrap();
    let shown = shot(&model, &last);
    let way = 0.5 * 1.5 * 1.5 / (0.05 * 9.81 / 1.4);
    near(shown[0], 0.8 * way, 1e-3);
    near(shown[1], 0.6 * way, 1e-3);
    assert!(shown.fixed_rows::<3>(3).norm() < 1e-6, "{shown}");
}

#[test]
fn a_plane_has_the_contact_of_space() {
    let flat = Disc::new(DiscParameters::default()).unwrap();
    let space = DiscInSpace::new(DiscInSpaceParameters::default()).unwrap();
    let [flat, space] = [run(&flat, 1.0).1, run(&space, 1.0).1].map(|it| it[it.len() - 1]);
    assert!((flat - space).norm() < 1e-7, "{flat} {space}");
    assert!(flat[0] > 1.0);
}

#[test]
fn energies_balance_and_jacobians_are_right() {
    macro_rules! sound {
        ($($model:ident, $parameters:ident;)*) => {$(
            assert_sound_about_the_start((
                &$model::<f64>::new($parameters::default()).unwrap(),
                &$model::<Dual<f64>>::new($parameters::default()).unwrap(),
            ));
        )*};
    }
    sound! {
        Dropped, DroppedParameters;
        Block, BlockParameters;
        Ball, BallParameters;
        Bowl, BowlParameters;
        Disc, DiscParameters;
        DiscInSpace, DiscInSpaceParameters;
        Leg, LegParameters;
        Pendulum, PendulumParameters;
    }
}

/// Over bounces that lose and slip.
#[test]
fn energies_balance_through_contacts() {
    let ball = Ball::new(BallParameters::default()).unwrap();
    let ball = imbalance(&ball, &(), 5e-5, 20_000);
    assert!(ball < 1e-9, "{ball:e}");
    let leg = Leg::new(LegParameters::default()).unwrap();
    let leg = imbalance(&leg, &(), 5e-5, 30_000);
    assert!(leg < 1e-9, "{leg:e}");
}

#[test]
fn steps_of_one_length_and_adaptive_ones_agree() {
    let model = Leg::new(LegParameters::default()).unwrap();
    let start = model.initial_state();
    let mut fixed = start;
    Rk4::fixed(&model, &(), 0.0, 1.0, 1e-5, start, |_, x| fixed = *x).unwrap();
    let (adaptive, shown) = run(&model, 1.0);
    assert!(shown.iter().any(|it| it[0] > 1.0) && shown.iter().any(|it| it[1].abs() > 0.1));
    assert!(shown.iter().all(|it| it[0] >= 0.0));
    let mut stiff = start;
    Adaptive::new(Radau5, 1e-8, 1e-10)
        .integrate(&model, &(), 0.0, 1.0, start, |step| stiff = *step.state())
        .unwrap();
    for (found, name) in [(fixed, "fixed"), (stiff, "stiff")] {
        let error = (found - adaptive).norm();
        assert!(error < 1e-6, "{name}: {error:e}");
    }
}

#[test]
fn a_pendulum_leaves_its_stop_as_fast_as_it_came() {
    let turning = |dissipation: f64, upper: f64| {
        let model = Pendulum::new(PendulumParameters { dissipation, upper }).unwrap();
        let place = Pendulum::<f64>::META.state("hinge.angle").unwrap();
        let solver = Adaptive::new(Dop853, 1e-11, 1e-13);
        let guard = |_t, x: &SVector<f64, 2>| x[place] - upper;
        let start = model.initial_state();
        let to = |direction, start, time| {
            let way = solver.until(
                &model,
                &(),
                time,
                time + 5.0,
                start,
                (direction, guard),
                |_step| (),
            );
            let way = way.unwrap();
            assert!(way.found);
            (way.state, way.time)
        };
        let (hit, time) = to(Direction::Rising, start, 0.0);
        let (left, _) = to(Direction::Falling, hit, time);
        [shot(&model, &hit)[1], shot(&model, &left)[1]]
    };
    // 0.6 kg m² about the hinge, and 2 g 0.5 of weight.
    let fall = f64::sqrt(2.0 * 9.81 * (f64::cos(0.1) - f64::cos(1.0)) / 0.6);
    let [came, left] = turning(0.0, 0.1);
    near(came, fall, 1e-9);
    near(left, -fall, 1e-9);
    // At the bottom the weight does not turn it, but a little beyond.
    let [came, left] = turning(0.2, 0.0);
    let held = |speed: f64| 0.2 * speed - f64::ln_1p(0.2 * speed);
    near(held(left) / held(came), 1.0, 2e-3);
}

/// A stop pushes back from both ends, and not between them.
#[test]
fn stops_act_on_both_sides() {
    let model = Pendulum::new(PendulumParameters {
        dissipation: 0.2,
        ..Default::default()
    })
    .unwrap();
    let place = Pendulum::<f64>::META.state("hinge.angle").unwrap();
    for (angle, rate, expected) in [
        (-1.4, 3.0, 0.0),
        (0.1, 3.0, 0.0),
        (0.11, 3.0, 200.0 * 1.6),
        (0.11, -3.0, 200.0 * 0.4),
        (0.11, -6.0, 0.0),
        (-1.51, -3.0, -200.0 * 1.6),
        (-1.51, 3.0, -200.0 * 0.4),
        (-1.51, 6.0, 0.0),
    ] {
        let mut x = SVector::from([rate; 2]);
        x[place] = angle;
        let effort = shot(&model, &x)[2];
        assert!(
            (effort - expected).abs() < 1e-9,
            "{effort} is not {expected}"
        );
        // And so it acts: on 0.6 kg m² about the hinge, beside 9.81 N m for the sine.
        let rates = model.derivative(0.0, &x, &SVector::zeros(), &mut Default::default());
        near(
            0.6 * rates[1 - place],
            -9.81 * f64::sin(angle) - expected,
            1e-11,
        );
        let power = model.power(0.0, &x, &SVector::zeros(), &mut Default::default());
        let stored = 2e4 * (f64::max(angle - 0.1, 0.0) + f64::min(angle + 1.5, 0.0)) * rate;
        near(power.dissipated, expected * rate - stored, 1e-11);
        assert!(power.dissipated >= 0.0);
    }
}

/// Thresholds that may be ahead of what bounces are no reason for short steps where they are not.
#[test]
fn a_leg_sinks_to_its_stop_in_few_steps() {
    let model = Sinking::new(SinkingParameters::default()).unwrap();
    macro_rules! by {
        ($($method:ident),*) => {
            $({
                let mut last = model.initial_state();
                let solver = Adaptive { most: 5_000, ..Adaptive::new($method, 1e-7, 1e-9) };
                let run = solver.integrate(&model, &(), 0.0, 3.0, last, |step| last = *step.state());
                run.unwrap();
                let [force, angle] = shot(&model, &last).into();
                near(force, 3.0 * 9.81, 1e-8);
                // The stop of the hip carries what the ground and the weight of the bone turn.
                near(2e3 * (angle - 1.2), 9.81 * (3.0 * 0.4 - 0.2) * angle.sin(), 1e-7);
            })*
        };
    }
    by![Tsit5, Dop853, Verner9, Rodas4, Rodas5P, Radau5, Radau9];
}
