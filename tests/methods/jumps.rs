//! Slopes of runs over thresholds at which a law jumps.

use mbg_runtime::lanes::{Lanes, f32x8, f64x4};
use mbg_runtime::{
    Adaptive, Auto, Direction, Dop853, Dual, Fixed, Gauss6, ImplicitMidpoint, Integrator, Pirk8,
    Radau5, Radau9, Real, Rk4, Rodas4, Rodas5P, Ros2, System, Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    /// A mass between two fields that push it to a place between them.
    model Valley {
        param below = 2.0;
        param place = 0.0;
        1 motion {
            I body { inertia: 1.0 }
            C field { effort: if q < place { -below } else { 1.0 }, initial: 1.0 }
        }
        output speed = body.p;
    }

    /// A wheel whose teeth push it, each for the first quarter of its way.
    model Teeth {
        param part = 0.25;
        1 axis {
            I wheel { inertia: 1.0, initial: 1.0 }
            C teeth { effort: if fraction(q) < part { -2.0 } else { 0.5 } }
        }
        output angle = teeth.q;
    }

    /// A mass that a spring holds, on a floor, and a force.
    model Rubbing {
        param friction = 0.2;
        input force: N;
        1 motion {
            I block { inertia: 1.0, initial: 0.5 }
            C spring { stiffness: 3.0, initial: 0.1 }
            R floor { effort: 0.3 * f + friction * sign(f) }
            Se push { effort: force }
        }
        output speed = block.f;
    }
}

type Slope = Dual<f64>;

/// The parameters of [`Valley`]: where the mass starts, the place between the fields, and the field below it.
const VALLEY: [f64; 3] = [1.0, 0.0, 2.0];

/// Momentum and place after a time, the slopes by one of these.
fn valley(solver: &impl Integrator<2>, by: usize, end: f64) -> SVector<Slope, 2> {
    let (model, start) = variable_valley(by);
    last(solver, &model, &(), start, (Dual::constant(0.0), end))
}

fn variable_valley(by: usize) -> (Valley<Slope>, SVector<Slope, 2>) {
    let mut numbers = VALLEY.map(Dual::constant);
    numbers[by] = Dual::variable(VALLEY[by]);
    let [start, place, below] = numbers;
    let model = Valley::new(ValleyParameters { below, place }).unwrap();
    (model, SVector::from([Dual::constant(0.0), start]))
}

fn last<T: Real, const N: usize, const M: usize, const P: usize>(
    solver: &impl Integrator<N>,
    model: &impl System<T, N, M, P>,
    input: &impl mbg_runtime::Input<T, M>,
    start: SVector<T, N>,
    (begin, end): (T, f64),
) -> SVector<T, N> {
    let mut last = start;
    solver
        .integrate(model, input, begin, T::from_f64(end), start, |step| {
            last = *step.state()
        })
        .unwrap();
    last
}

/// The same in closed form, before the mass comes back to where it began: the slopes by all three.
fn exact(end: f64) -> ([f64; 2], [[f64; 3]; 2]) {
    let [start, place, below] = VALLEY;
    let fallen = f64::sqrt(2.0 * (start - place));
    let lasting = 2.0 * fallen / below;
    // How the time of the fall changes, and how long the mass stays below.
    let fall = [1.0 / fallen, -1.0 / fallen, 0.0];
    let stay = [
        2.0 / (below * fallen),
        -2.0 / (below * fallen),
        -lasting / below,
    ];
    let since = end - fallen;
    if since < lasting {
        let speed = below * since - fallen;
        let moved = core::array::from_fn(|by| {
            let own = if by == 2 { since } else { 0.0 };
            own - below * fall[by] - fall[by]
        });
        let place_moved = core::array::from_fn(|by| {
            let own = [0.0, 1.0, 0.5 * since * since][by];
            own - fall[by] * since - speed * fall[by]
        });
        let at = place - fallen * since + 0.5 * below * since * since;
        ([speed, at], [moved, place_moved])
    } else {
        let since = since - lasting;
        let left = |by: usize| fall[by] + stay[by];
        let speed = fallen - since;
        let moved = core::array::from_fn(|by| fall[by] + left(by));
        let place_moved = core::array::from_fn(|by| {
            let own = if by == 1 { 1.0 } else { 0.0 };
            own + fall[by] * since - speed * left(by)
        });
        (
            [speed, place + fallen * since - 0.5 * since * since],
            [moved, place_moved],
        )
    }
}

/// By how much values or slopes are wrong at most.
fn worst(found: &SVector<Slope, 2>, states: &[f64; 2], slopes: &[f64; 2]) -> f64 {
    let values = found.map(|it| it.value) - SVector::from(*states);
    let slopes = found.map(|it| it.slope) - SVector::from(*slopes);
    values.amax().max(slopes.amax())
}

fn assert_valley(name: &str, error: f64, found: impl Fn(usize, f64) -> SVector<Slope, 2>) {
    for end in [1.0, 2.0, 4.0] {
        let (states, slopes) = if end > 1.5 {
            exact(end)
        } else {
            ([-1.0, 0.5], [[0.0; 3], [1.0, 0.0, 0.0]])
        };
        for by in 0..3 {
            let worst = worst(&found(by, end), &states, &slopes.map(|slopes| slopes[by]));
            assert!(worst < error, "{name}, by {by} at {end}: {worst:e}");
        }
    }
}

#[test]
fn all_methods_know_when_a_law_jumps() {
    macro_rules! adaptive {
        ($($method:ident $tolerance:literal),*) => {
            $(
                let solver = Adaptive::new($method, $tolerance, $tolerance);
                assert_valley(stringify!($method), 1e-9, |by, end| valley(&solver, by, end));
            )*
        };
    }
    adaptive!(Tsit5 1e-8, Dop853 1e-10, Pirk8 1e-9, Ros2 1e-5, Rodas4 1e-8, Rodas5P 1e-8, Radau5 1e-8, Radau9 1e-9);
    assert_valley("Auto", 1e-9, |by, end| {
        valley(&Auto::new(1e-8, 1e-8), by, end)
    });
}

/// Within the fields a step of any length is exact, so that what is left is how exactly the jumps are met.
#[test]
fn so_do_steps_of_constant_length() {
    for step in [0.3, 0.1, 0.07] {
        assert_valley("Rk4", 1e-8, |by, end| {
            valley(&Fixed::new(Rk4, step), by, end)
        });
        assert_valley("Gauss6", 1e-8, |by, end| {
            valley(&Fixed::new(Gauss6::default(), step), by, end)
        });
        assert_valley("ImplicitMidpoint", 1e-8, |by, end| {
            valley(&Fixed::new(ImplicitMidpoint::default(), step), by, end)
        });
    }
}

/// A run may end where the law jumps, by an event, and the next begin there.
#[test]
fn a_run_that_ends_at_the_jump_has_its_slopes_once() {
    for tolerance in [1e-7, 1e-10] {
        let solver = Adaptive::new(Dop853, tolerance, tolerance);
        assert_valley("in two runs", 1e-8, |by, end| {
            let (model, start) = variable_valley(by);
            let place = model.parameters().place;
            let arrival = solver
                .until(
                    &model,
                    &(),
                    Dual::constant(0.0),
                    Dual::constant(end),
                    start,
                    (Direction::Falling, |_, x: &SVector<Slope, 2>| x[1] - place),
                    |_| (),
                )
                .unwrap();
            last(&solver, &model, &(), arrival.state, (arrival.time, end))
        });
    }
}

/// Pieces of a run may end at the jump to a rounding, at either side of it.
#[test]
fn a_run_that_ends_beside_the_jump_has_its_slopes_once() {
    let solver = Adaptive::new(Dop853, 1e-10, 1e-10);
    let meets = 2.0_f64.sqrt();
    for units in -20..=20 {
        let middle = meets + f64::from(units) * f64::EPSILON;
        let at_middle = |by| valley(&solver, by, middle);
        let (states, slopes) = exact(4.0);
        for by in 0..3 {
            let (model, _) = variable_valley(by);
            let end = last(
                &solver,
                &model,
                &(),
                at_middle(by),
                (Dual::constant(middle), 4.0),
            );
            let worst = worst(&end, &states, &slopes.map(|slopes| slopes[by]));
            assert!(worst < 1e-9, "{units} {by}: {worst:e}");
        }
    }
}

/// Each tooth adds to the square of the speed, the gap behind it takes from it.
#[test]
fn teeth_that_come_again_are_met_each_time() {
    let part = Dual::variable(0.25);
    let model = Teeth::new(TeethParameters { part }).unwrap();
    let solver = Adaptive::new(Dop853, 1e-10, 1e-10);
    let end = last(
        &solver,
        &model,
        &(),
        model.initial_state(),
        (Dual::constant(0.0), 6.0),
    );
    let [speed, angle] = [end[0], end[1]];
    let rounds = f64::floor(angle.value);
    let beyond = angle.value - rounds;
    assert!(rounds > 3.0 && beyond > 0.3, "{angle:?}");
    // 0.5 v² = 0.5 + 2.5 part (rounds + 1) − 0.5 angle, whatever the time.
    let left =
        speed * speed - Dual::constant(1.0) - Dual::constant(5.0 * (rounds + 1.0)) * part + angle;
    assert!(
        left.value.abs() < 1e-8 && left.slope.abs() < 1e-8,
        "{left:?}"
    );
    let h = 1e-5;
    let ends = [-h, h].map(|more| {
        let model = Teeth::<f64>::new(TeethParameters { part: 0.25 + more }).unwrap();
        last(
            &Adaptive::new(Dop853, 1e-12, 1e-12),
            &model,
            &(),
            model.initial_state(),
            (0.0, 6.0),
        )
    });
    let slope = (ends[1] - ends[0]) / (2.0 * h);
    for row in 0..2 {
        assert!(
            (slope[row] - end[row].slope).abs() < 1e-5,
            "{slope} {end:?}"
        );
    }
}

/// Slopes by friction, an initial state and the force against quotients of runs, in double and with some digits in single precision.
#[test]
fn friction_has_its_slopes_at_every_turn() {
    let solver = Adaptive::new(Dop853, 1e-11, 1e-11);
    let run = |numbers: [f64; 3]| {
        let model = Rubbing::<f64>::new(RubbingParameters {
            friction: numbers[0],
        })
        .unwrap();
        let input = mbg_runtime::Smooth(move |t: f64| SVector::from([numbers[2] * t.sin()]));
        last(
            &solver,
            &model,
            &input,
            SVector::from([0.5, numbers[1]]),
            (0.0, 9.0),
        )
    };
    let numbers = [0.2, 0.1, 3.0];
    for by in 0..3 {
        let (mut less, mut more) = (numbers, numbers);
        (less[by], more[by]) = (less[by] - 1e-5, more[by] + 1e-5);
        let expected = (run(more) - run(less)) / 2e-5;
        let found = rubbing::<f64>(&solver, numbers, by);
        assert!((found - expected).amax() < 1e-5, "{by}: {found} {expected}");
        let single = rubbing::<f32>(&Adaptive::new(Dop853, 1e-5, 1e-5), numbers, by);
        assert!(
            (single - expected).amax() < 1e-2,
            "{by}: {single} {expected}"
        );
    }
}

/// At rest, and torn loose at once: one that begins with some momentum the same way has it, too, as the linear law of the slip has it.
#[test]
fn what_leaves_the_threshold_at_which_it_begins_keeps_its_slopes() {
    let model = Rubbing::<Slope>::new(RubbingParameters::default()).unwrap();
    let start = SVector::from([Dual::variable(0.0), Dual::constant(0.1)]);
    let end = 1.0;
    let (decay, turn) = (0.15, f64::sqrt(3.0 - 0.15 * 0.15));
    let way = f64::exp(-decay * end) * f64::sin(turn * end) / turn;
    let speed = f64::exp(-decay * end) * f64::cos(turn * end) - decay * way;
    let expected = SVector::from([speed, way]);
    for force in [2.0, -2.0] {
        let input = mbg_runtime::Constant(SVector::from([Dual::constant(force)]));
        let span = (Dual::constant(0.0), end);
        let found = [
            last(
                &Adaptive::new(Dop853, 1e-11, 1e-11),
                &model,
                &input,
                start,
                span,
            ),
            last(&Fixed::new(Rk4, 1e-2), &model, &input, start, span),
        ];
        for found in found {
            let slopes = found.map(|it| it.slope);
            assert!((slopes - expected).amax() < 1e-8, "{force}: {slopes}");
        }
    }
}

/// The slopes of the end by one of the numbers.
fn rubbing<T: Real>(solver: &impl Integrator<2>, numbers: [f64; 3], by: usize) -> SVector<f64, 2> {
    let mut variable = numbers.map(Dual::<T>::from_f64);
    variable[by].slope = T::from_f64(1.0);
    let [friction, stretched, force] = variable;
    let model = Rubbing::new(RubbingParameters { friction }).unwrap();
    let input = mbg_runtime::Smooth(move |t: Dual<T>| SVector::from([force * t.sin()]));
    let start = SVector::from([Dual::from_f64(0.5), stretched]);
    let end = last(solver, &model, &input, start, (Dual::from_f64(0.0), 9.0));
    end.map(|it| it.slope.find(|_| true).unwrap())
}

/// Lanes meet the jump at times of their own, the last of them never.
#[test]
fn lanes_have_the_slopes_of_each_alone() {
    let starts = [1.0, 0.8, 1.3, 7.0];
    let end = 2.0;
    let solver = Adaptive::new(Dop853, 1e-9, 1e-9);
    let model = Valley::new(ValleyParameters::default()).unwrap();
    let rest = Dual::from_f64(0.0);
    let lanes = SVector::from([rest, Dual::variable(f64x4::from(starts))]);
    let lanes = last(&solver, &model, &(), lanes, (rest, end));
    for (lane, start) in starts.into_iter().enumerate() {
        let model = Valley::new(ValleyParameters::default()).unwrap();
        let alone = SVector::from([Dual::constant(0.0), Dual::variable(start)]);
        let alone = last(&solver, &model, &(), alone, (Dual::constant(0.0), end));
        for (state, alone) in lanes.iter().zip(&alone) {
            let [value, slope] = [state.value, state.slope].map(|it| it.to_array()[lane]);
            let error = (value - alone.value).abs().max((slope - alone.slope).abs());
            assert!(error < 1e-6, "{lane}: {value} {slope} {alone:?}");
        }
    }
}

/// The end of falls from different places in lanes, at constant steps: each ends its own one at the jump, the last never comes there.
fn assert_falls_in_lanes<L: Lanes>(solver: &impl Integrator<2>, bound: f64) {
    let (starts, end) = ([1.0, 0.8, 1.3, 7.0], 2.0);
    let model = Valley::new(ValleyParameters::default()).unwrap();
    let start = |lane: usize| starts[lane % starts.len()];
    let falls = L::from_lanes(|lane| L::Lane::from_f64(start(lane)));
    let zero = L::from_f64(0.0);
    let found = last(
        solver,
        &model,
        &(),
        SVector::from([zero, falls]),
        (zero, end),
    );
    for lane in 0..L::COUNT {
        let fallen = f64::min(f64::sqrt(2.0 * start(lane)), end);
        let since = end - fallen;
        let way = start(lane) - 0.5 * fallen * fallen;
        let expected = [2.0 * since - fallen, way - fallen * since + since * since];
        for (found, expected) in found.iter().zip(expected) {
            let error = (found.lane(lane) - L::Lane::from_f64(expected)).magnitude();
            assert!(error < bound, "{lane}: {found:?} {expected}");
        }
    }
}

#[test]
fn lanes_end_their_constant_steps_at_all_jumps() {
    macro_rules! all {
        ($($method:expr),*) => {
            $(
                assert_falls_in_lanes::<f64x4>(&Fixed::new($method, 0.07), 1e-12);
                assert_falls_in_lanes::<f32x8>(&Fixed::new($method, 0.07), 1e-5);
            )*
        };
    }
    all!(
        Rk4,
        Tsit5,
        Dop853,
        Pirk8,
        Gauss6::default(),
        ImplicitMidpoint::default(),
        Radau5,
        Radau9,
        Rodas4,
        Rodas5P
    );
}

/// Friction holds in some lanes and slips in others: those go to and fro, by the impulse of a step, in a few parts of it.
#[test]
fn lanes_that_hold_do_not_hold_up_others() {
    let (step, end) = (1e-3, 9.0);
    let frictions = [0.9, 0.2, 0.5, 0.05];
    let solver = Fixed::new(Rk4, step);
    let friction = f64x4::from(frictions);
    let model = Rubbing::new(RubbingParameters { friction }).unwrap();
    let input = mbg_runtime::Smooth(|t: f64x4| SVector::from([Real::sin(t)]));
    let [zero, end_in_lanes] = [0.0, end].map(f64x4::from_f64);
    let (start, mut lanes) = (model.initial_state(), model.initial_state());
    let statistics = solver
        .integrate(&model, &input, zero, end_in_lanes, start, |step| {
            lanes = *step.state()
        })
        .unwrap();
    assert!(
        statistics.steps as f64 <= 10.0 * end / step,
        "{statistics:?}"
    );
    for (lane, friction) in frictions.into_iter().enumerate() {
        let model = Rubbing::new(RubbingParameters { friction }).unwrap();
        let input = mbg_runtime::Smooth(|t: f64| SVector::from([t.sin()]));
        let alone = last(&solver, &model, &input, model.initial_state(), (0.0, end));
        let apart = (lanes.map(|it| it.lane(lane)) - alone).amax();
        assert!(apart < 2.0 * friction * step, "{lane}: {apart}");
    }
}
