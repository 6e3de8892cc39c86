//! Events, and jumps of inputs.

use mbg_runtime::{
    Adaptive, Cause, Constant, Direction, Dop853, Dual, Estimating, Fixed, Gauss6, Integrator,
    Pirk8, Pirk16, Pulse, Radau5, Radau9, Real, Rk4, Rodas4, Rodas5P, Ros2, Step, System, Tsit5,
    Variable, Verner9, mbg,
};
use nalgebra::SVector;

use crate::problems::{Law, Oscillator, Written};

/// A height and its rate, pushed up by an input.
#[derive(Clone, Copy)]
struct Falling;

impl Law<2, 1> for Falling {
    const STATES: &'static [Variable] = &[
        Variable {
            name: "height",
            unit: "",
        },
        Variable {
            name: "rate",
            unit: "",
        },
    ];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

type State = SVector<f64, 2>;

/// `x = cos t` comes down to 0 at π/2, and to 0.5 at π/3.
fn first_time(solver: impl Integrator<2>, level: f64, direction: Direction) -> f64 {
    let guard = |_t: f64, x: &State| x[0] - level;
    let start = SVector::from([1.0, 0.0]);
    let arrival = solver
        .until(
            &Written(Oscillator),
            &(),
            0.0,
            10.0,
            start,
            (direction, guard),
            |_| (),
        )
        .unwrap();
    assert!(arrival.found);
    assert!((arrival.state[0] - level).abs() < 1e-12);
    arrival.time
}

#[test]
fn events_are_found_where_they_are() {
    let (third, half) = (std::f64::consts::FRAC_PI_3, std::f64::consts::FRAC_PI_2);
    let solver = Adaptive::new(Dop853, 1e-12, 1e-12);
    assert!((first_time(solver, 0.5, Direction::Falling) - third).abs() < 1e-10);
    assert!((first_time(solver, 0.5, Direction::Rising) - 5.0 * third).abs() < 1e-10);
    assert!((first_time(solver, 0.0, Direction::Either) - half).abs() < 1e-10);
    let solver = Adaptive::new(Verner9, 1e-12, 1e-12);
    assert!((first_time(solver, 0.5, Direction::Falling) - third).abs() < 1e-10);
    let fixed = Fixed::new(Rk4, 1e-3);
    assert!((first_time(fixed, 0.5, Direction::Falling) - third).abs() < 1e-10);
    let fixed = Fixed::new(Gauss6::default(), 1e-3);
    assert!((first_time(fixed, 0.5, Direction::Falling) - third).abs() < 1e-10);
    let solver = Adaptive::new(Radau5, 1e-10, 1e-10);
    assert!((first_time(solver, 0.5, Direction::Falling) - third).abs() < 1e-6);
}

/// The search asks no more often than it promises, whatever the guard.
#[test]
fn the_search_is_bounded() {
    let solver = Adaptive::new(Tsit5, 1e-8, 1e-8);
    let start = SVector::from([1.0, 0.0]);
    for power in [1, 9, 31] {
        let mut asked = 0;
        let mut steps = 0;
        let guard = |_t: f64, x: &State| {
            asked += 1;
            (x[0] - 0.5).powi(power)
        };
        let event = (Direction::Falling, guard);
        let arrival = solver
            .until(&Written(Oscillator), &(), 0.0, 10.0, start, event, |_| {
                steps += 1
            })
            .unwrap();
        assert!((arrival.time - std::f64::consts::FRAC_PI_3).abs() < 1e-6);
        assert!(
            asked <= (9 + 24) * (steps + 1) + 64,
            "{asked} in {steps} steps"
        );
    }
    // A guard of signs alone leaves bisection.
    let sign = |_t: f64, x: &State| if x[0] > 0.5 { 1.0 } else { -1.0 };
    let event = (Direction::Falling, sign);
    let arrival = solver
        .until(&Written(Oscillator), &(), 0.0, 10.0, start, event, |_| ())
        .unwrap();
    assert!((arrival.time - std::f64::consts::FRAC_PI_3).abs() < 1e-7);
}

/// A limiter and a counter of whole steps stay at zero behind the event, or for a while.
#[test]
fn a_guard_that_stays_zero_is_met_where_it_becomes_zero() {
    let times = |guard: fn(f64) -> f64| {
        [0.1, 0.4].map(|step| {
            let solver = Fixed::new(Rk4, step);
            let mut asked = 0;
            let event = (Direction::Falling, |_t: f64, x: &State| {
                asked += 1;
                guard(x[0])
            });
            let input = Constant(SVector::from([-9.81]));
            let start = SVector::from([1.0, 0.0]);
            let arrival = solver
                .until(&Written(Falling), &input, 0.0, 0.7, start, event, |_| ())
                .unwrap();
            assert!(arrival.found && asked <= 9 * 7 + 64, "{asked}");
            arrival.time
        })
    };
    let fallen = |way: f64| f64::sqrt(2.0 * way / 9.81);
    for (guard, way) in [
        ((|height| height - 0.5) as fn(f64) -> f64, 0.5),
        (|height| (height - 0.5).max(0.0), 0.5),
        (|height| (20.0 * height).floor() - 10.0, 0.45),
    ] {
        for time in times(guard) {
            assert!((time - fallen(way)).abs() < 1e-14, "{time} {way}");
        }
    }
}

#[test]
fn the_observer_is_given_all_steps_up_to_the_event() {
    let guard = |_t: f64, x: &State| x[0] - 0.5;
    let start = SVector::from([1.0, 0.0]);
    let mut before = (0.0, start);
    let observer = |step: &mut Step<'_, f64, 2>| {
        assert_eq!((step.start(), *step.first()), before);
        let middle = 0.5 * (step.start() + step.end());
        assert!((step.at(middle)[0] - middle.cos()).abs() < 1e-8);
        assert_eq!(step.at(step.end()), *step.state());
        before = (step.end(), *step.state());
    };
    let event = (Direction::Falling, guard);
    let arrival = Adaptive::new(Dop853, 1e-10, 1e-10)
        .until(&Written(Oscillator), &(), 0.0, 10.0, start, event, observer)
        .unwrap();
    assert!(arrival.found);
    assert_eq!(before, (arrival.time, arrival.state));
}

#[test]
fn a_guard_that_is_not_a_number_stops_the_run() {
    let start = SVector::from([1.0, 0.0]);
    let solver = Adaptive::new(Tsit5, 1e-8, 1e-8);
    let stopped = |guard: &dyn Fn(f64, &State) -> f64| {
        let event = (Direction::Either, guard);
        let run = solver.until(&Written(Oscillator), &(), 0.0, 10.0, start, event, |_| ());
        run.unwrap_err()
    };
    let never = stopped(&|_, _| f64::NAN);
    assert_eq!((never.cause, never.time), (Cause::Guard, 0.0));
    let later = stopped(&|_, x| (x[0] + 0.5).sqrt() + 0.1);
    assert_eq!(later.cause, Cause::Guard);
    // The root is real up to 2π/3.
    assert!(later.time > 2.0 && later.time < 3.0, "{later}");
}

/// Falls from a height that varies: √(2 h / g) after 1 / √(2 g h), with √(2 g h).
#[test]
fn events_have_the_slopes_of_the_solution() {
    fn fall(solver: impl Integrator<2>) {
        let number = Dual::<f64>::constant;
        let (height, gravity) = (1.0, 9.81);
        let start = SVector::from([Dual::variable(height), number(0.0)]);
        let push = Constant(SVector::from([number(-gravity)]));
        let ground = |_t, x: &SVector<Dual<f64>, 2>| x[0];
        let event = (Direction::Falling, ground);
        let (begin, end) = (number(0.0), number(10.0));
        let falling = &Written(Falling);
        let arrival = solver
            .until(falling, &push, begin, end, start, event, |_| ())
            .unwrap();
        let time = f64::sqrt(2.0 * height / gravity);
        let close = |found: f64, exact: f64| (found - exact).abs() < 1e-8;
        assert!(close(arrival.time.value, time), "{arrival:?}");
        assert!(
            close(arrival.time.slope, 1.0 / (gravity * time)),
            "{arrival:?}"
        );
        assert!(close(arrival.state[0].slope, 0.0), "{arrival:?}");
        assert!(close(arrival.state[1].slope, -1.0 / time), "{arrival:?}");
        // Back up without a loss, and down to the same place.
        let bounced = SVector::from([arrival.state[0], -arrival.state[1]]);
        let mut last = bounced;
        let end = arrival.time + number(time);
        solver
            .integrate(falling, &push, arrival.time, end, bounced, |step| {
                last = *step.state()
            })
            .unwrap();
        // A fixed time behind the bounce: the height is v t − g t² / 2.
        assert!(close(last[0].value, height), "{last:?}");
        assert!(close(last[0].slope, 1.0), "{last:?}");
    }
    fall(Adaptive::new(Tsit5, 1e-10, 1e-12));
    fall(Adaptive::new(Dop853, 1e-10, 1e-12));
    fall(Adaptive::new(Pirk8, 1e-10, 1e-12));
    fall(Adaptive::new(Rodas5P, 1e-10, 1e-12));
    fall(Adaptive::new(Radau5, 1e-10, 1e-12));
    fall(Fixed::new(Rk4, 0.01));
    fall(Fixed::new(Gauss6::default(), 0.01));
}

#[test]
fn no_event_runs_to_the_end() {
    let event = (Direction::Falling, |_t: f64, x: &State| x[0] + 2.0);
    let solver = Adaptive::new(Tsit5, 1e-10, 1e-12);
    let start = SVector::from([1.0, 0.0]);
    let arrival = solver
        .until(&Written(Oscillator), &(), 0.0, 3.0, start, event, |_| ())
        .unwrap();
    assert!(!arrival.found && arrival.time == 3.0);
    assert!((arrival.state[0] - 3.0_f64.cos()).abs() < 1e-8);
}

/// Every adaptive method ends a step on the jumps, and none is stepped over from rest.
#[test]
fn jumps_are_met_by_every_method() {
    fn push<S: Estimating>(method: S) {
        let (start, end, t1) = (100.123_4, 101.037_7, 102.0);
        let input = Pulse {
            amplitude: SVector::from([3.0]),
            start,
            end,
        };
        let exact = 3.0 * (f64::cos(t1 - end) - f64::cos(t1 - start));
        let mut ends = Vec::new();
        let mut last = SVector::from([0.0, 0.0]);
        let statistics = Adaptive::new(method, 1e-7, 1e-9)
            .integrate(&Written(Oscillator), &input, 0.0, t1, last, |step| {
                ends.push(step.end());
                last = *step.state();
            })
            .unwrap();
        let error = (last[0] - exact).abs();
        println!("{:<12}{error:.1e} in {} steps", S::NAME, statistics.steps);
        assert!(error < 1e-5, "{} {error:e}", S::NAME);
        assert!(ends.contains(&start) && ends.contains(&end));
    }
    push(Tsit5);
    push(Dop853);
    push(Verner9);
    push(Pirk8);
    push(Pirk16);
    push(Ros2);
    push(Rodas4);
    push(Rodas5P);
    push(Radau5);
}

mbg! {
    /// A top on a ball joint, of which the quaternion is closed after each step.
    #[derivative]
    pub(crate) model Top {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 ground[6]; 1 frame[6]; 1 centre[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        tip: Spherical {
            orientation: quaternion, initial: [0.1, 0.5, 0.2], initial_rate: [0.3, 0.0, 5.0]
        } (ground, frame);
        arm: Offset { by: [0.0, 0.0, 0.4] } (frame, centre);
        body: Body { mass: 1.0, inertia: diag(0.02, 0.02, 0.01) } (centre);
        output spin: rad/s = frame.f[2];
    }
}

/// An event is interpolated, and the next run begins beside it, where the quaternion has length one.
#[test]
fn an_event_of_a_closed_model_is_found_once() {
    let model = Top::<f64>::new(TopParameters::default()).unwrap();
    let guard = |_t: f64, x: &SVector<f64, 7>| x[1] - 0.1;
    let events = |tolerance: f64| {
        let solver = Adaptive::new(Dop853, tolerance, tolerance);
        let (mut time, mut state) = (0.0, model.initial_state());
        let mut found = Vec::new();
        loop {
            let event = (Direction::Either, guard);
            let arrival = solver
                .until(&model, &(), time, 10.0, state, event, |_| ())
                .unwrap();
            if !arrival.found {
                return found;
            }
            (time, state) = (arrival.time, arrival.state);
            found.push(time);
        }
    };
    let strict = events(1e-12);
    assert!(strict.windows(2).all(|pair| pair[1] - pair[0] > 0.1));
    for tolerance in [1e-8, 1e-6, 1e-4] {
        let found = events(tolerance);
        assert_eq!(found.len(), strict.len(), "{tolerance:e}: {found:?}");
        let pairs = found.iter().zip(&strict);
        assert!(
            pairs
                .map(|(a, b)| (a - b).abs())
                .all(|error| error < 300.0 * tolerance)
        );
    }
}

/// The top of the way is 1 at 2π k: a level just below it is passed upwards and downwards within a small part of a step.
#[test]
fn crossings_that_are_close_to_each_other_are_found() {
    fn tops(solver: impl Integrator<2>) {
        for below in [1e-2, 1e-4, 1e-6] {
            let apart = f64::acos(1.0 - below);
            for (direction, expected) in [(Direction::Rising, -apart), (Direction::Falling, apart)]
            {
                let guard = |_t: f64, x: &State| x[0] - (1.0 - below);
                let start = SVector::from([0.0, -1.0]);
                let event = (direction, guard);
                let arrival = solver
                    .until(&Written(Oscillator), &(), 0.0, 6.0, start, event, |_| ())
                    .unwrap();
                // It starts a quarter of a period before the bottom.
                let expected = 1.5 * std::f64::consts::PI + expected;
                assert!(arrival.found, "{below:e} {direction:?}");
                assert!(
                    (arrival.time - expected).abs() < 1e-8 / apart,
                    "{below:e} {direction:?}: {} instead of {expected}",
                    arrival.time
                );
            }
        }
    }
    tops(Adaptive::new(Tsit5, 1e-12, 1e-12));
    tops(Adaptive::new(Dop853, 1e-12, 1e-12));
    tops(Adaptive::new(Pirk16, 1e-12, 1e-12));
    tops(Adaptive::new(Radau9, 1e-12, 1e-12));
    tops(Fixed::new(Gauss6::default(), 0.05));
}

/// Each flight is 0.9 times as long as the one before; the last ones are a small part of the first step.
#[test]
fn flights_may_be_far_shorter_than_a_step() {
    let input = Constant(SVector::from([-9.81]));
    let floor = |_t: f64, x: &State| x[0];
    let solver = Adaptive {
        first: Some(0.1),
        ..Adaptive::new(Dop853, 1e-9, 1e-9)
    };
    let (mut time, mut state) = (0.0, SVector::from([0.0, 5.0]));
    let mut expected = 0.0;
    for bounce in 0..100 {
        let speed = 5.0 * f64::powi(0.9, bounce);
        let event = (Direction::Falling, floor);
        let arrival = solver
            .until(
                &Written(Falling),
                &input,
                time,
                time + 2.0,
                state,
                event,
                |_| (),
            )
            .unwrap();
        expected += 2.0 * speed / 9.81;
        assert!(arrival.found, "after {bounce} bounces");
        assert!(
            (arrival.time - expected).abs() < 1e-9,
            "{} instead of {expected} after {bounce} bounces",
            arrival.time
        );
        (time, state) = (arrival.time, arrival.state);
        state[1] *= -0.9;
    }
}
