//! Laws that change by time alone: steps end where they do.

use mbg_runtime::lanes::f64x4;
use mbg_runtime::{
    Adaptive, Auto, Constant, Dop853, Dual, Fixed, Gauss6, Input, Integrator, Pirk8, Radau5,
    Radau9, Real, Rk4, Rodas5P, Sampled, Smooth, System, Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    /// A wheel that a short torque drives, from some time on, and one that rises for a while.
    pub(crate) model Kicked {
        param start: s = 5.0;
        param rise: N*m/s = 0.5;
        1 shaft {
            I wheel { inertia: 1.0, initial: 1.0 }
            R bearing { resistance: 0.1 }
            Se kick { effort: if t > start && t < start + 0.05 { 20.0 } else { 0.0 } }
            Se ramp { effort: min(max(rise * (t - 7.0), 0.0), 1.0) }
        }
        output rate: rad/s = shaft.f;
    }
}

/// What a torque that lasts for a while leaves at 10 s.
fn left(torque: f64, from: f64, to: f64) -> f64 {
    10.0 * torque * (f64::exp(0.1 * (to - 10.0)) - f64::exp(0.1 * (from - 10.0)))
}

/// The rate at 10 s.
fn expected(start: f64) -> f64 {
    // ∫ (s − 7) / 2 exp((s − 10) / 10) ds has the antiderivative 5 (s − 17) exp((s − 10) / 10).
    let ramp = |s: f64| 5.0 * (s - 17.0) * f64::exp(0.1 * (s - 10.0));
    f64::exp(-1.0) + left(20.0, start, start + 0.05) + ramp(9.0) - ramp(7.0) + left(1.0, 9.0, 10.0)
}

fn at_end<T: Real>(start: T, solver: &impl Integrator<1>) -> T {
    let parameters = KickedParameters {
        start,
        ..Default::default()
    };
    let model = Kicked::new(parameters).unwrap();
    let mut last = model.initial_state();
    let (begin, end) = (T::from_f64(0.0), T::from_f64(10.0));
    solver
        .integrate(&model, &(), begin, end, last, |step| last = *step.state())
        .unwrap();
    last[0]
}

#[test]
fn a_short_pulse_of_a_law_is_met_by_all_methods() {
    for start in [5.0, 0.0, 1.0 / 3.0, 9.9] {
        for found in [
            at_end(start, &Adaptive::new(Tsit5, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Dop853, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Rodas5P, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Radau5, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Radau9, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Pirk8, 1e-9, 1e-9)),
            at_end(start, &Auto::new(1e-9, 1e-9)),
            at_end(start, &Fixed::new(Rk4, 0.05)),
            at_end(start, &Fixed::new(Gauss6::default(), 0.5)),
        ] {
            let error = found - expected(start);
            assert!(error.abs() < 3e-8, "{start}: {error:e}");
        }
    }
}

/// Four wheels in lanes that are kicked at different times.
#[test]
fn changes_of_all_lanes_are_met() {
    let starts = [5.0, 0.5, 2.0 / 3.0, 8.0];
    let found = at_end(f64x4::from(starts), &Adaptive::new(Dop853, 1e-9, 1e-9));
    for (start, found) in starts.into_iter().zip(<[f64; 4]>::from(found)) {
        assert!((found - expected(start)).abs() < 1e-8, "{start}: {found}");
    }
    let found = at_end(5.0_f32, &Fixed::new(Rk4, 0.1));
    assert!((f64::from(found) - expected(5.0)).abs() < 1e-5, "{found}");
}

/// How much sooner or later the torque comes.
#[test]
fn times_of_changes_have_their_slopes() {
    let slope = |start: f64| {
        20.0 * (f64::exp(0.1 * (start + 0.05 - 10.0)) - f64::exp(0.1 * (start - 10.0)))
    };
    let close = |found: f64, start: f64| {
        let error = found - slope(start);
        assert!(error.abs() < 1e-8, "{start}: {error:e}");
    };
    for start in [5.0, 1.0 / 3.0, 9.9] {
        let varied = Dual::variable(start);
        close(
            at_end(varied, &Adaptive::new(Tsit5, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Dop853, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Rodas5P, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Radau9, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Pirk8, 1e-9, 1e-9)).slope,
            start,
        );
        close(at_end(varied, &Auto::new(1e-9, 1e-9)).slope, start);
        close(at_end(varied, &Fixed::new(Rk4, 0.05)).slope, start);
    }
    let starts = [5.0, 0.5, 2.0 / 3.0, 8.0];
    let varied = Dual::variable(f64x4::from(starts));
    let found = at_end(varied, &Adaptive::new(Dop853, 1e-9, 1e-9));
    for (start, found) in starts.into_iter().zip(<[f64; 4]>::from(found.slope)) {
        close(found, start);
    }
}

#[test]
fn a_model_tells_its_changes() {
    let model = Kicked::<f64>::new(KickedParameters::default()).unwrap();
    let mut times = Vec::new();
    let mut time = f64::NEG_INFINITY;
    while let Some(next) = model.next_change(time) {
        times.push(next);
        time = next;
    }
    assert_eq!(times, [5.0, 5.05, 7.0, 9.0]);
}

mbg! {
    /// A winding whose supply is on for a part of each period, early or in the middle of it, and what follows waves likewise.
    pub(crate) model Chopped {
        param period: s = 1e-3;
        param duty = 0.3;
        param level = 0.25;
        let turn = 6.283185307179586 / period;
        let early = if mod(t, period) < duty * period { 12.0 } else { 0.0 };
        let middling = if abs(mod(t, period) / period - 0.5) < 0.5 * duty { 12.0 } else { 0.0 };
        let waving = if 3.0 * sin(turn * t) > 3.0 * level { 12.0 } else { 0.0 };
        let late = if cos(1.0 - turn * t) > level { 12.0 } else { 0.0 };
        1 coil {
            I winding { inertia: 1e-2 }
            R copper { resistance: 2.0 }
            Se supply { effort: 2.0 * early }
        }
        integral middle = 200.0 * (middling - middle);
        integral wave = 200.0 * (waving - wave);
        integral turned = 200.0 * (late - turned);
        output current: A = coil.f;
        output in_the_middle: A = middle;
        output by_wave: A = wave;
        output by_turned_wave: A = turned;
    }
}

const PERIODS: i32 = 20;

/// What is left at the end of [`PERIODS`] pulses of 12, from one part of each period to another.
fn chopped(period: f64, [from, to]: [f64; 2]) -> f64 {
    let end = f64::from(PERIODS);
    let left = |turns: f64| f64::exp(200.0 * period * (turns.clamp(0.0, end) - end));
    let pulses = (-1..=PERIODS).map(f64::from);
    pulses.map(|k| 12.0 * (left(k + to) - left(k + from))).sum()
}

/// The same for each output of the model.
fn all_chopped(period: f64, duty: f64, level: f64) -> [f64; 4] {
    let turns = |angle: f64| angle / std::f64::consts::TAU;
    let (rise, reach) = (turns(level.asin()), turns(level.acos()));
    let pulses = [
        [0.0, duty],
        [0.5 - 0.5 * duty, 0.5 + 0.5 * duty],
        [rise, 0.5 - rise],
        [turns(1.0) - reach, turns(1.0) + reach],
    ];
    pulses.map(|pulse| chopped(period, pulse))
}

/// The outputs behind [`PERIODS`], and how many steps that took and were refused.
fn chopping<T: Real>(
    [period, duty, level]: [T; 3],
    solver: &impl Integrator<4>,
) -> ([T; 4], [u64; 2]) {
    let model = Chopped::new(ChoppedParameters {
        period,
        duty,
        level,
    })
    .unwrap();
    let (mut last, mut steps) = (model.initial_state(), 0);
    let end = T::from_f64(f64::from(PERIODS)) * period;
    let statistics = solver.integrate(&model, &(), T::from_f64(0.0), end, last, |step| {
        last = *step.state();
        steps += 1;
    });
    let none = SVector::from([]);
    let outputs = model.output(end, &last, &none, &mut ());
    (outputs.into(), [steps, statistics.unwrap().rejected])
}

#[test]
fn what_comes_again_is_met_by_all_methods() {
    for [period, duty, level] in [[1e-3, 0.3, 0.25], [0.7e-3, 0.85, -0.6]] {
        let expected = all_chopped(period, duty, level);
        let met = |solver: &dyn Fn([f64; 3]) -> ([f64; 4], [u64; 2])| {
            let (found, counts) = solver([period, duty, level]);
            for (found, expected) in found.into_iter().zip(expected) {
                let error = found - expected;
                assert!(error.abs() < 3e-9, "{error:e} of {expected}");
            }
            counts
        };
        // Nine changes in a period.
        for [steps, refused] in [
            met(&|it| chopping(it, &Adaptive::new(Tsit5, 1e-9, 1e-9))),
            met(&|it| chopping(it, &Adaptive::new(Dop853, 1e-9, 1e-9))),
            met(&|it| chopping(it, &Adaptive::new(Pirk8, 1e-9, 1e-9))),
            met(&|it| chopping(it, &Auto::new(1e-9, 1e-9))),
            met(&|it| chopping(it, &Fixed::new(Gauss6::default(), 1e-3))),
        ] {
            assert!(
                steps <= 10 * PERIODS as u64 && refused < 3,
                "{steps} {refused}"
            );
        }
        met(&|it| chopping(it, &Adaptive::new(Rodas5P, 1e-9, 1e-9)));
        met(&|it| chopping(it, &Adaptive::new(Radau5, 1e-9, 1e-9)));
        met(&|it| chopping(it, &Adaptive::new(Radau9, 1e-9, 1e-9)));
        met(&|it| chopping(it, &Fixed::new(Rk4, 1e-4)));
    }
    let duties = [0.1, 0.3, 0.5, 0.99];
    let lanes = [1e-3, 0.0, 0.25].map(f64x4::from_f64);
    let lanes = [lanes[0], f64x4::from(duties), lanes[2]];
    let (found, _) = chopping(lanes, &Adaptive::new(Dop853, 1e-9, 1e-9));
    for (output, found) in found.into_iter().enumerate() {
        for (duty, found) in duties.into_iter().zip(<[f64; 4]>::from(found)) {
            let error = found - all_chopped(1e-3, duty, 0.25)[output];
            assert!(error.abs() < 3e-9, "{duty}: {error:e}");
        }
    }
}

/// By the period, by the part of it for which the supply is on, and by the level of the waves.
#[test]
fn what_comes_again_has_its_slopes() {
    let parameters = [1e-3, 0.3, 0.25];
    for (varied, wide) in [1e-8, 1e-4, 1e-4].into_iter().enumerate() {
        let mut dual = parameters.map(Dual::from_f64);
        dual[varied] = Dual::variable(parameters[varied]);
        let expected = |more: f64| {
            let mut parameters = parameters;
            parameters[varied] += more;
            all_chopped(parameters[0], parameters[1], parameters[2])
        };
        let (above, below) = (expected(wide), expected(-wide));
        for (found, solver) in [
            (
                chopping(dual, &Adaptive::new(Dop853, 1e-10, 1e-10)).0,
                "Dop853",
            ),
            (
                chopping(dual, &Adaptive::new(Radau9, 1e-10, 1e-10)).0,
                "Radau9",
            ),
            (chopping(dual, &Fixed::new(Rk4, 2e-5)).0, "Rk4"),
        ] {
            for output in 0..4 {
                let slope = (above[output] - below[output]) / (2.0 * wide);
                let error = (found[output].slope - slope) / (1.0 + slope.abs());
                assert!(
                    error.abs() < 1e-6,
                    "{solver} {varied} {output}: {error:e} of {slope}"
                );
            }
        }
    }
}

mbg! {
    /// What a wave would switch if it came so far.
    model Unmoved {
        1 way {
            I mass { inertia: 1.0 }
            R friction { resistance: 1.0 }
            Se push { effort: if sin(3.0 * t) > 1.5 { 1.0 } else { 0.5 } }
        }
    }
}

#[test]
fn a_wave_that_never_comes_so_far_ends_no_step() {
    let model = Unmoved::<f64>::new(UnmovedParameters::default()).unwrap();
    assert_eq!(model.next_change(0.0), None);
    assert_eq!(model.change_between(0.0, 10.0, |_| SVector::from([])), None);
}

#[test]
fn there_is_a_next_change_from_anywhere() {
    let model = Chopped::<f64>::new(ChoppedParameters::default()).unwrap();
    assert!(model.next_change(f64::NEG_INFINITY).is_some());
    assert_eq!(model.next_change(f64::INFINITY), None);
    for start in [-1.0, 0.0, 1e3] {
        let mut time = start;
        for _ in 0..1000 {
            let next = model.next_change(time).unwrap();
            assert!(next > time && next - time < 0.5e-3, "{time}");
            time = next;
        }
        // Two of each, and where the middle of the middling one is.
        let periods = (time - start) / 1e-3;
        assert!((periods - 1000.0 / 9.0).abs() < 1.0, "{periods}");
    }
}

mbg! {
    /// A winding that is switched where a sine is above a triangle, and one whose supply is on for the part of each period that an
    /// input tells.
    pub(crate) model Driven {
        param period: s = 1e-4;
        param depth = 0.8;
        input duty;
        let triangle = 4.0 * abs(mod(t, period) / period - 0.5) - 1.0;
        integral phase = 200.0 * ((if depth * sin(314.1592653589793 * t) > triangle { 1.0 } else { -1.0 }) - phase);
        integral current = 200.0 * ((if mod(t, period) < duty * period { 1.0 } else { 0.0 }) - current);
        output both[2] = [phase, current];
    }
}

/// What follows `u` with a time constant of 5 ms, from one switching to the next.
fn followed(x: f64, u: f64, lasting: f64) -> f64 {
    u + (x - u) * f64::exp(-200.0 * lasting)
}

/// The phase at 20 ms, switched at the zeros of a difference between two corners of the triangle.
fn phase(depth: f64) -> f64 {
    let (half, end) = (0.5e-4, 0.02);
    let (mut x, mut since) = (0.0, 0.0);
    for k in 0..400 {
        // The triangle falls from 1 in the first half of each period, and rises in the second.
        let start = half * f64::from(k);
        let falling = if k % 2 == 0 { 1.0 } else { -1.0 };
        let difference = |t: f64| {
            depth * f64::sin(100.0 * std::f64::consts::PI * t)
                - falling * (1.0 - 2.0 * (t - start) / half)
        };
        let (mut low, mut high) = (start, start + half);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if (difference(middle) > 0.0) == (falling < 0.0) {
                low = middle
            } else {
                high = middle
            }
        }
        x = followed(x, -falling, low - since);
        since = low;
    }
    followed(x, -1.0, end - since)
}

/// The current behind periods with these duties.
fn current(duties: impl IntoIterator<Item = f64>) -> f64 {
    let period =
        |x: f64, duty: f64| followed(followed(x, 1.0, 1e-4 * duty), 0.0, 1e-4 * (1.0 - duty));
    duties.into_iter().fold(0.0, period)
}

fn driven<T: Real>(depth: T, input: &impl Input<T, 1>, solver: &impl Integrator<2>) -> [T; 2] {
    let model = Driven::new(DrivenParameters {
        depth,
        period: T::from_f64(1e-4),
    })
    .unwrap();
    let mut last = model.initial_state();
    let (begin, end) = (T::from_f64(0.0), T::from_f64(0.02));
    solver
        .integrate(&model, input, begin, end, last, |step| last = *step.state())
        .unwrap();
    last.into()
}

#[test]
fn what_two_waves_or_an_input_switch_is_met() {
    let near = |found: f64, expected: f64| {
        let error = found - expected;
        assert!(error.abs() < 1e-10, "{error:e} of {expected}");
    };
    let times: Vec<f64> = (0..200).map(|k| 1e-4 * f64::from(k)).collect();
    let duties: Vec<f64> = (0..200)
        .map(|k| 0.5 + 0.4 * f64::sin(0.1 * f64::from(k)))
        .collect();
    let values: Vec<_> = duties.iter().map(|it| SVector::from([*it])).collect();
    let sampled = Sampled::held(&times, &values).unwrap();
    // A duty that rises while a pulse lasts, which ends at t where (t − start) = 1e-4 (0.1 + 30 t).
    let rising = Smooth(|t: f64| SVector::from([0.1 + 30.0 * t]));
    let risen = (0..200).map(|k| (0.1 + 30.0 * 1e-4 * f64::from(k)) / (1.0 - 3e-3));
    let risen = current(risen);
    macro_rules! by {
        ($($solver:expr),*) => { $({
            let solver = $solver;
            let [phase_found, held] = driven(0.8, &Constant(SVector::from([0.3])), &solver);
            near(phase_found, phase(0.8));
            near(held, current([0.3; 200]));
            near(driven(0.3, &sampled, &solver)[0], phase(0.3));
            near(driven(0.3, &sampled, &solver)[1], current(duties.clone()));
            near(driven(0.8, &rising, &solver)[1], risen);
        })* };
    }
    by!(
        Adaptive::new(Tsit5, 1e-10, 1e-10),
        Adaptive::new(Dop853, 1e-10, 1e-10),
        Adaptive::new(Radau9, 1e-10, 1e-10),
        Auto::new(1e-10, 1e-10),
        Fixed::new(Rk4, 1e-5),
        Fixed::new(Gauss6::default(), 1e-3)
    );
    let duties = [0.2, 0.3, 0.999, 0.0];
    let lanes = Constant(SVector::from([f64x4::from(duties)]));
    let found = driven(f64x4::from_f64(0.8), &lanes, &Fixed::new(Rk4, 1e-5))[1];
    for (duty, found) in duties.into_iter().zip(<[f64; 4]>::from(found)) {
        near(found, current([duty; 200]));
    }
    // With slopes by the depth of the sine and by the duty.
    let dual = |depth, duty| {
        driven(
            depth,
            &Constant(SVector::from([duty])),
            &Fixed::new(Rk4, 1e-5),
        )
    };
    let by_depth = dual(Dual::variable(0.8), Dual::constant(0.3))[0].slope;
    near(
        1e-4 * by_depth,
        1e-4 * (phase(0.80001) - phase(0.79999)) / 2e-5,
    );
    let by_duty = dual(Dual::constant(0.8), Dual::variable(0.3))[1].slope;
    near(
        1e-4 * by_duty,
        1e-4 * (current([0.30001; 200]) - current([0.29999; 200])) / 2e-5,
    );
}

mbg! {
    /// A winding between the two legs of a bridge, each of which compares a sine with the same carrier.
    model Bridge {
        param depth = 0.1;
        let ramp = mod(1000.0 * t, 1.0);
        let carrier = if ramp < 0.5 { 4.0 * ramp - 1.0 } else { 3.0 - 4.0 * ramp };
        let reference = depth * sin(314.1592653589793 * t);
        let first = if reference > carrier { 1.0 } else { 0.0 };
        let second = if -reference > carrier { 1.0 } else { 0.0 };
        1 coil {
            I winding { inertia: 1e-2 }
            Se bridge { effort: 100.0 * (first - second) }
        }
    }

    /// A narrow pulse at the top of a product of two waves.
    model Product {
        1 way {
            I mass { inertia: 1.0 }
            Se push { effort: if sin(7.0 * t) * cos(7.0 * t) > 0.49 { 1.0 } else { 0.0 } }
        }
    }
}

/// By the rule of rectangles, whose error is that of as many jumps as there are.
fn summed(law: impl Fn(f64) -> f64, end: f64) -> f64 {
    const COUNT: i32 = 4_000_000;
    let part = end / f64::from(COUNT);
    let middles = (0..COUNT).map(|place| (f64::from(place) + 0.5) * part);
    middles.map(law).sum::<f64>() * part
}

fn pushed(model: &impl System<f64, 1, 0, 0>, end: f64) -> f64 {
    let mut last = model.initial_state();
    Adaptive::new(Dop853, 1e-9, 1e-11)
        .integrate(model, &(), 0.0, end, last, |step| last = *step.state())
        .unwrap();
    last[0]
}

/// What one argument begins another ends.
#[test]
fn pulses_between_the_legs_of_a_bridge_are_met() {
    for depth in [0.8, 0.1, 0.01] {
        let model = Bridge::<f64>::new(BridgeParameters { depth }).unwrap();
        let law = |t: f64| {
            let ramp = (1000.0 * t).rem_euclid(1.0);
            let carrier = (4.0 * ramp - 1.0).min(3.0 - 4.0 * ramp);
            let reference = depth * f64::sin(314.159_265_358_979_3 * t);
            100.0 * (f64::from(reference > carrier) - f64::from(-reference > carrier))
        };
        let error = pushed(&model, 0.0154) - summed(law, 0.0154);
        assert!(error.abs() < 2e-5, "{depth}: {error:e}");
    }
}

#[test]
fn pulses_at_the_top_of_a_product_of_waves_are_met() {
    let model = Product::<f64>::new(ProductParameters::default()).unwrap();
    let law = |t: f64| f64::from(f64::sin(7.0 * t) * f64::cos(7.0 * t) > 0.49);
    let error = pushed(&model, 10.0) - summed(law, 10.0);
    assert!(error.abs() < 2e-5, "{error:e}");
}

mbg! {
    /// Laws that add more to the time than there is of it, so that they round more than it does.
    model Ahead {
        param shift = 0.97;
        param ahead = 0.97;
        param offset = 1000.0;
        param phase = 100.3;
        integral counted = floor(3.0 * t + shift);
        integral early = if mod(t + ahead, 0.4) < 0.2 { 1.0 } else { 0.0 };
        integral late = if t + offset > offset + 0.5 { 1.0 } else { 0.0 };
        integral wave = if sin(5.0 * t + phase) > 0.5 { 1.0 } else { 0.0 };
        output all = counted + early + late + wave;
    }

    /// What is on next to the crests of a wave.
    model Crest {
        param level = 0.999;
        integral lasting = if sin(100.0 * t) > level { 1.0 } else { 0.0 };
        output all = lasting;
    }

    /// What counts a wave that goes just beyond whole numbers.
    model Floor {
        param height = 1.0005;
        integral counted = floor(height * sin(100.0 * t));
        output all = counted;
    }

    /// What the time or a state begins, whichever is first.
    model Either {
        param level = 0.5;
        integral way = 0.2;
        integral lasting = if max(t, way) > level { 1.0 } else { 0.0 };
        output all = lasting;
    }
}

/// What is left at the end by all kinds of methods.
fn by_all<T: Real, const N: usize>(
    model: &impl System<T, N, 0, 1>,
    end: f64,
    mut each: impl FnMut(SVector<T, N>),
) {
    let mut by = |solver: &dyn Fn() -> SVector<T, N>| each(solver());
    macro_rules! by {
        ($($solver:expr),*) => { $(by(&|| {
            let mut last = model.initial_state();
            let (begin, end) = (T::from_f64(0.0), T::from_f64(end));
            $solver
                .integrate(model, &(), begin, end, last, |step| last = *step.state())
                .unwrap();
            last
        });)* };
    }
    by!(
        Fixed::new(Rk4, 0.01),
        Fixed::new(Gauss6::default(), 0.03),
        Adaptive::new(Tsit5, 1e-9, 1e-9),
        Adaptive::new(Dop853, 1e-9, 1e-9),
        Adaptive::new(Radau9, 1e-9, 1e-9)
    );
}

#[test]
fn laws_that_round_more_than_the_time_change_on_their_own_side() {
    // Three times are counted; of those that come again, what is left of one, and two more.
    let expected = [
        3.0 - (6.0 - 3.0 * 0.97) / 3.0,
        0.43,
        0.5,
        std::f64::consts::PI / 7.5,
    ];
    let model = Ahead::<f64>::new(AheadParameters::default()).unwrap();
    by_all(&model, 1.0, |found| {
        let error = (found - SVector::from(expected)).amax();
        assert!(error < 1e-12, "{error:e}");
    });
    let model = Ahead::<Dual<f64>>::new(AheadParameters {
        shift: Dual::variable(0.97),
        ahead: Dual::variable(0.97),
        ..Default::default()
    });
    let model = model.unwrap();
    by_all(&model, 1.0, |found| {
        let error = (found.map(|it| it.slope) - SVector::from([1.0, -1.0, 0.0, 0.0])).amax();
        assert!(error < 1e-12, "{error:e}");
    });
    let model = Ahead::<f32>::new(AheadParameters::default()).unwrap();
    by_all(&model, 1.0, |found| {
        let error = (found.map(f64::from) - SVector::from(expected)).amax();
        assert!(error < 3e-4, "{error:e}");
    });
}

/// Where a wave is almost flat a little of it is a long time.
#[test]
fn changes_next_to_crests_are_met() {
    for part in 0..100 {
        let level = 1.0 - f64::powf(10.0, -0.1 - 0.05 * f64::from(part));
        let model = Crest::new(CrestParameters { level }).unwrap();
        let expected = 16.0 * 2.0 * level.acos() / 100.0;
        by_all(&model, 1.0, |found| {
            let error = found[0] - expected;
            assert!(error.abs() < 1e-12, "{level}: {error:e}");
        });
    }
}

#[test]
fn whole_numbers_below_a_wave_are_met() {
    // Eight times above one, and seven times below minus one.
    let expected = (2.0 * f64::acos(1.0 / 1.0005) + 8.0 * std::f64::consts::PI - 48.0) / 100.0;
    let slope = 0.02 / (1.0005 * f64::sqrt(1.0005 * 1.0005 - 1.0));
    let height = Dual::variable(1.0005);
    let model = Floor::new(FloorParameters { height }).unwrap();
    by_all(&model, 0.48, |found| {
        let error = found[0].value - expected;
        assert!(error.abs() < 1e-12, "{error:e}");
        let error = found[0].slope / slope - 1.0;
        assert!(error.abs() < 1e-9, "slope {error:e}");
    });
    // As many whole numbers as it goes over on its way.
    let model = Floor::new(FloorParameters { height: 3.5 }).unwrap();
    let above = |level: f64| 2.0 * f64::acos(level / 3.5);
    // It ends in the eighth valley, below minus two.
    let rest = 48.0 - 15.0 * std::f64::consts::PI;
    let valley = 2.0 * rest - f64::asin(1.0 / 3.5) - f64::asin(2.0 / 3.5);
    let expected =
        above(1.0) + above(2.0) + above(3.0) - valley + 8.0 * std::f64::consts::PI - 48.0;
    by_all(&model, 0.48, |found| {
        let error = found[0] - expected / 100.0;
        assert!(error.abs() < 1e-12, "{error:e}");
    });
}

#[test]
fn what_the_time_or_a_state_begins_is_met() {
    let level = Dual::variable(0.5);
    let model = Either::new(EitherParameters { level }).unwrap();
    by_all(&model, 1.0, |found| {
        let error = (found[1].value - 0.5).abs() + (found[1].slope + 1.0).abs();
        assert!(error < 1e-12, "{error:e}");
    });
}
