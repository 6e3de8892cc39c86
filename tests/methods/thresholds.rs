//! Laws that pulse over a state, or by a wave, while nothing else moves: no step goes over all of it.

use mbg_runtime::{
    Adaptive, Auto, Dop853, Integrator, Pirk8, Pirk16, Radau5, Radau9, Real, Rodas4, Rodas5P, Ros2,
    System, Tsit5, Verner9, mbg,
};
use nalgebra::SVector;

mbg! {
    include "tests/models/pulses.mbg";
}

fn at_end<T: Real, const N: usize>(
    model: &impl System<T, N, 0, 1>,
    end: f64,
    solver: &impl Integrator<N>,
) -> SVector<T, N> {
    let mut last = model.initial_state();
    let (begin, end) = (T::from_f64(0.0), T::from_f64(end));
    solver
        .integrate(model, &(), begin, end, last, |step| {
            last = *step.state();
        })
        .unwrap();
    last
}

/// The last state by all methods, with their names.
fn by_all<const N: usize>(
    model: &impl System<f64, N, 0, 1>,
    end: f64,
    tolerance: f64,
) -> Vec<(&'static str, SVector<f64, N>)> {
    macro_rules! by {
        ($($method:ident),*) => {
            vec![
                $((stringify!($method), at_end(model, end, &Adaptive::new($method, tolerance, tolerance))),)*
                ("Auto", at_end(model, end, &Auto::new(tolerance, tolerance))),
            ]
        };
    }
    by!(
        Tsit5, Dop853, Verner9, Pirk8, Pirk16, Ros2, Rodas4, Rodas5P, Radau5, Radau9
    )
}

#[test]
fn ranges_hats_and_curves_over_a_state_are_met() {
    let model = Slide::new(SlideParameters::default()).unwrap();
    // Half of the square of the speed is lost by the work: a range, a triangle and another one.
    let expected = (16.0_f64 - 2.0 * (10.0 * 0.2 + 20.0 * 0.1 + 10.0 * 0.15)).sqrt();
    // Stepped over, one alone would leave 0.6 m/s more.
    for (tolerance, error) in [(1e-3, 0.3), (1e-6, 1e-3), (1e-9, 1e-6)] {
        for (method, last) in by_all(&model, 30.0, tolerance) {
            assert!(
                (last[0] - expected).abs() < error,
                "{method} to {tolerance:e}: {} instead of {expected}",
                last[0]
            );
        }
    }
    let model = Slide::new(SlideParameters::default()).unwrap();
    let last = at_end::<f32, 2>(&model, 30.0, &Adaptive::new(Dop853, 1e-5, 1e-5));
    assert!((f64::from(last[0]) - expected).abs() < 1e-2, "{}", last[0]);
}

#[test]
fn a_cam_is_met_in_each_round() {
    let model = Cam::new(CamParameters::default()).unwrap();
    for (method, last) in by_all(&model, 10.0, 1e-9) {
        let [rate, angle] = [last[0], last[1]];
        let half = f64::acos(0.999);
        let rounds = (angle / std::f64::consts::TAU).floor();
        // It starts on the cam's top, and ends between two of them.
        let way = half * (1.0 + 2.0 * rounds);
        let expected = (20.0_f64.powi(2) - 2.0 * way).sqrt();
        assert!(
            rounds > 20.0
                && (half..std::f64::consts::TAU - half).contains(&(angle % std::f64::consts::TAU)),
            "{angle}"
        );
        assert!(
            (rate - expected).abs() < 1e-4,
            "{method}: {rate} instead of {expected}"
        );
    }
}

#[test]
fn what_lies_between_thresholds_of_two_states_is_met() {
    let model = Gates::new(GatesParameters::default()).unwrap();
    // For as long as the twin takes for 0.1 m, at 4 m/s.
    let expected = 4.0 - 10.0 * 0.1 / 4.0;
    for (tolerance, error) in [(1e-3, 0.1), (1e-6, 1e-3), (1e-9, 1e-6)] {
        for (method, last) in by_all(&model, 10.0, tolerance) {
            assert!(
                (last[0] - expected).abs() < error,
                "{method} to {tolerance:e}: {} instead of {expected}",
                last[0]
            );
        }
    }
}

#[test]
fn what_comes_again_with_the_angle_is_met() {
    let model = Teeth::new(TeethParameters::default()).unwrap();
    for (method, last) in by_all(&model, 10.0, 1e-8) {
        let [rate, angle] = [last[0], last[1]];
        let rounds = (angle / std::f64::consts::TAU).floor();
        let left = angle - rounds * std::f64::consts::TAU;
        let pitches = (angle / 0.5).floor();
        let rubbed = 0.3 * pitches + (angle - 0.5 * pitches - 0.2).max(0.0);
        assert!(
            rounds > 20.0 && left > 0.04 && (left - 2.5).abs() > 0.02,
            "{angle}"
        );
        let caught = 0.08 * rounds + 0.04 + if left > 2.5 { 0.04 } else { 0.0 };
        let expected = (20.0_f64.powi(2) - 2.0 * (2.0 * caught + 0.1 * rubbed)).sqrt();
        assert!(
            (rate - expected).abs() < 1e-4,
            "{method}: {rate} instead of {expected}"
        );
    }
}

#[test]
fn a_wave_of_time_is_met_at_each_top() {
    let model = Pushed::new(PushedParameters::default()).unwrap();
    let lasting = 2.0 * f64::acos(0.9984) / (4.0 * std::f64::consts::PI);
    for (method, last) in by_all(&model, 10.0, 1e-7) {
        let expected = 20.0 * lasting;
        assert!(
            (last[0] - expected).abs() < 1e-5,
            "{method}: {} instead of {expected}",
            last[0]
        );
    }
}

#[test]
fn places_passed_by_are_met() {
    let model = Sledge::new(SledgeParameters::default()).unwrap();
    // The chords of two circles.
    let expected = (16.0_f64 - 2.0 * (5.0 * 0.8 + 8.0 * 0.3)).sqrt();
    for (tolerance, error) in [(1e-3, 0.3), (1e-6, 1e-3), (1e-9, 1e-6)] {
        for (method, last) in by_all(&model, 30.0, tolerance) {
            assert!(
                (last[0] - expected).abs() < error,
                "{method} to {tolerance:e}: {} instead of {expected}",
                last[0]
            );
        }
    }
}

#[test]
fn what_is_touched_at_the_top_of_the_way_is_met() {
    let model = Swing::new(SwingParameters::default()).unwrap();
    let reference = Adaptive {
        longest: 1e-3,
        ..Adaptive::new(Dop853, 1e-12, 1e-12)
    };
    let expected: SVector<f64, 2> = at_end(&model, 60.0, &reference);
    for (tolerance, error) in [(1e-3, 0.1), (1e-6, 2e-4), (1e-9, 3e-7)] {
        for (method, last) in by_all(&model, 60.0, tolerance) {
            assert!(
                (last - expected).norm() < error,
                "{method} to {tolerance:e}: {last} instead of {expected}"
            );
        }
    }
}

type Point<'a> = (f64, [&'a SVector<f64, 2>; 2], [&'a SVector<f64, 0>; 2]);

/// How many thresholds all arguments of a model pass between two points.
fn passed_over<const P: usize>(
    model: &impl System<f64, 2, 0, P, Memory = ()>,
    from: Point<'_>,
    to: Point<'_>,
) -> u32 {
    let mut count = 0;
    model.courses(from, to, &mut (), |course| {
        count += course.passed(to.0 - from.0)
    });
    count
}

#[test]
fn thresholds_between_two_points_are_counted() {
    let model = Slide::<f64>::new(SlideParameters::default()).unwrap();
    let none = SVector::from([]);
    let passed = |from: f64, to: f64| {
        let [from, to] = [from, to].map(|gone| SVector::from([4.0, gone]));
        let slope = SVector::from([0.0, to[1] - from[1]]);
        let points = [&from, &to].map(|x| (x[1], [x, &slope], [&none; 2]));
        passed_over(&model, points[0], points[1])
    };
    // Two of the range, three of the hat and of the curve.
    assert_eq!(passed(0.0, 100.0), 8);
    assert_eq!(passed(21.0, 39.0), 0);
    assert_eq!(passed(39.95, 20.1), 2);
    let model = Cam::<f64>::new(CamParameters::default()).unwrap();
    let passed = |from: f64, to: f64| {
        let [from, to] = [from, to].map(|angle| SVector::from([20.0, angle]));
        let slope = SVector::from([0.0, 20.0]);
        passed_over(
            &model,
            (0.0, [&from, &slope], [&none; 2]),
            (1.0, [&to, &slope], [&none; 2]),
        )
    };
    // Half turns count twice.
    assert_eq!(
        [passed(0.5, 3.0), passed(0.5, 4.0), passed(0.5, 7.0)],
        [0, 2, 4]
    );
}

/// Between turns the block swings about a place beside the middle, so that each half swing is 0.2 m shorter.
#[test]
fn refused_steps_end_where_they_went_over_a_threshold() {
    let model = Rubbed::new(RubbedParameters::default()).unwrap();
    let (start, turns) = (model.initial_state(), 50.0);
    let end = (turns + 1.0 / 3.0) * std::f64::consts::PI;
    let expected = 0.1 + (10.3 - 0.2 * turns - 0.1) * 0.5;
    macro_rules! by {
        ($($method:ident $most:literal),*) => {
            $(
                let mut place = 0.0;
                let statistics = Adaptive::new($method, 1e-9, 1e-9)
                    .integrate(&model, &(), 0.0, end, start, |step| place = step.state()[1])
                    .unwrap();
                let (refused, error) = (statistics.rejected as f64 / turns, place - expected);
                assert!(
                    refused < $most && error.abs() < 1e-7,
                    "{}: {error:e}, {refused} refused at each turn",
                    stringify!($method),
                );
            )*
        };
    }
    // Twenty and more of each before.
    by!(Tsit5 2.0, Dop853 2.0, Pirk8 2.0, Rodas4 2.0, Rodas5P 2.0, Radau5 2.0, Radau9 2.0);
}

mbg! {
    /// What a state and the time pass together.
    model Together {
        param rate = 0.5;
        integral way = 2.0;
        integral left = mod(way - rate * t, 1.0);
        integral counted = floor(t * way);
        integral early = if mod(t, 0.5 + 0.0025 * way * way) < 0.2 { 1.0 } else { 0.0 };
        integral wave = if sin(3.0 * t + way) > 0.2 { 1.0 } else { 0.0 };
        output all = left + counted + early + wave;
    }

    /// Thresholds that are numbers on one side of another threshold alone.
    model Sided {
        integral way = 1.0;
        let side = sign(way + 1.0);
        integral root = if way > sqrt(side) { 1.0 } else { 0.0 };
        integral both = if way > sqrt(max(side, 0.0)) + sqrt(abs(side)) { 1.0 } else { 0.0 };
        integral power = if way > pow(side, 0.5) { 1.0 } else { 0.0 };
        integral logarithm = if way > 0.5 + ln(side) { 1.0 } else { 0.0 };
        integral angle = if way > asin(1.5 * side - 0.5) { 1.0 } else { 0.0 };
        output all = root + both + power + logarithm + angle;
    }
}

/// They were taken for times, which no state has a part in.
#[test]
fn what_a_state_and_the_time_pass_together_is_met() {
    let model = Together::new(TogetherParameters::default()).unwrap();
    // Four whole turns of 1.5 t, and the roots of k / 2 below 3.
    let left = (2.0 + 0.5 * 0.5 * 0.5) / 1.5;
    let counted = (1..18).map(|k| 3.0 - f64::sqrt(0.5 * f64::from(k))).sum();
    // From each t = k (0.5 + t² / 100) on, for 0.2 s.
    let root =
        |k: f64, more: f64| (1.0 - f64::sqrt(1.0 - 0.04 * k * (0.5 * k + more))) / (0.02 * k);
    let early = (1..6).map(|k| root(f64::from(k), 0.2).min(3.0) - root(f64::from(k), 0.0));
    let early = 0.2 + early.sum::<f64>();
    // The angle is 5 t.
    let reach = std::f64::consts::PI - 2.0 * f64::asin(0.2);
    let rest = 15.0 - 4.0 * std::f64::consts::PI - f64::asin(0.2);
    let wave = (2.0 * reach + rest.min(reach)) / 5.0;
    let expected = SVector::from([6.0, left, counted, early, wave]);
    for (name, found) in by_all(&model, 3.0, 1e-10) {
        let error = (found - expected).amax();
        assert!(error < 1e-7, "{name}: {error:e}, {found} {expected}");
    }
}

#[test]
fn thresholds_that_are_no_numbers_are_none() {
    let model = Sided::new(SidedParameters::default()).unwrap();
    let angle = 3.0 - std::f64::consts::FRAC_PI_2;
    let expected = SVector::from([3.0, 2.0, 1.0, 2.0, 2.5, angle]);
    for (name, found) in by_all(&model, 3.0, 1e-10) {
        let error = (found - expected).amax();
        assert!(error < 1e-8, "{name}: {error:e}, {found}");
    }
}
