//! Circuits and a motor.

use mbg_runtime::{
    Adaptive, Auto, Cause, Constant, Dop853, Estimating, Input, Integrator, Pulse, Radau5, Radau9,
    Real, Rk4, Rodas4, Rodas5P, Smooth, Statistics, Step, Stopped, System, Tsit5, mbg,
};
use nalgebra::SVector;

use super::balance;
use crate::references::errors::larger;
use crate::references::rectifier;

mbg! {
    include "examples/gallery/rectifier.mbg";

    /// A battery that is switched onto one of two coils, and a diode at the other that charges a capacitor.
    model Coupled {
        param leak: S = 0.0;
        input closed;
        let inductances = [[1e-3, 0.495e-3], [0.495e-3, 0.25e-3]];
        causality componentwise;
        0 supply { Se battery { effort: 24.0 } }
        0 ground { Se earth { effort: 0.0 } }
        0 drain;
        0 anode;
        0 out;
        1 coils[2] { I core { inertia: inductances } }
        supply -> coils[0]; coils[0] -> drain;
        anode -> coils[1]; coils[1] -> ground;
        1 channel { R switch { conductance: if closed > 0.5 { 20.0 } else { 1e-5 } } }
        drain -> channel; channel -> ground;
        1 snub { R snubber { resistance: 1e3 } }
        drain -> snub; snub -> supply;
        1 across { R winding { conductance: leak } }
        anode -> across; across -> ground;
        diode: Diode (anode, out);
        smooth: Capacitor { capacitance: 1e-4, initial: 5.0 } (out, ground);
        resistor: Resistor { resistance: 10.0 } (out, ground);
        output voltage: V = smooth.voltage;
    }

    /// A DC motor that turns a load through a rigid gear.
    #[derivative]
    pub(crate) model GearedMotor {
        param ratio = 20.0;
        input brake: N*m;
        0 plus;
        0 minus;
        Se supply { effort: 24.0 } -> plus;
        Se earth { effort: 0.0 } -> minus;
        1 shaft coordinate;
        motor: DcMotor {
            resistance: 0.8, inductance: 0.5e-3, constant: 0.05, inertia: 2e-4, friction: 1e-4
        } (plus, minus, shaft);
        1 load {
            I flywheel { inertia: 0.15 }
            R bearing { resistance: 0.02 }
            Se brakes { effort: -brake }
        }
        shaft -> TF gear { flow: 1 / ratio } -> load;
        integral angle: rad = shaft.f;
        output current: A = motor.current;
        output speed: rad/s = shaft.f;
        output turned: rad = angle;
    }

    /// Four diodes rectify for a capacitor and a load. Nothing else holds both ends of the source.
    pub(crate) model Bridge {
        causality componentwise;
        input voltage: V;
        0 a; 0 b; 0 plus; 0 minus;
        Se earth { effort: 0.0 } -> minus;
        1 source { R wire { resistance: 0.1 } Se supply { effort: voltage } }
        b -> source;
        source -> a;
        first: Diode { } (a, plus);
        second: Diode { } (b, plus);
        third: Diode { } (minus, a);
        fourth: Diode { } (minus, b);
        store: Capacitor { capacitance: 1e-3 } (plus, minus);
        load: Resistor { resistance: 10.0 } (plus, minus);
        output ends[2]: V = [a.e, b.e];
    }

    /// Two diodes in series across a capacitor.
    pub(crate) model InSeries {
        causality componentwise;
        0 supply; 0 middle; 0 ground;
        store: Capacitor { capacitance: 1.0 } (supply, ground);
        Se earth { effort: 0.0 } -> ground;
        first: Diode { } (supply, middle);
        second: Diode { } (middle, ground);
        output between: V = middle.e;
        output current: A = second.current;
    }

    /// A bridge behind a coil, whose current it blocks while the source is low; a resistor lies beside it.
    #[derivative]
    pub(crate) model Choked {
        causality componentwise;
        param beside: ohm = 1e6;
        0 source; 0 a; 0 b; 0 plus; 0 minus;
        Se supply { effort: 10.0 * sin(314.0 * t) } -> source;
        Se earth { effort: 0.0 } -> b;
        coil: Inductor { inductance: 1e-3 } (source, a);
        first: Diode { } (a, plus);
        second: Diode { } (b, plus);
        third: Diode { } (minus, a);
        fourth: Diode { } (minus, b);
        snubber: Resistor { resistance: beside } (a, b);
        store: Capacitor { capacitance: 1e-4 } (plus, minus);
        load: Resistor { resistance: 100.0 } (plus, minus);
        output voltage: V = store.voltage;
    }

    /// A charged capacitor swings with a coil on the other side of a transformer.
    pub(crate) model Swing {
        0 left; 0 left_ground; 0 right; 0 right_ground;
        Se left_earth { effort: 0.0 } -> left_ground;
        Se right_earth { effort: 0.0 } -> right_ground;
        store: Capacitor { capacitance: 2e-6, initial: 5.0 } (left, left_ground);
        wound: Transformer { ratio: 3.0 } (left, left_ground, right, right_ground);
        coil: Inductor { inductance: 1e-3 } (right, right_ground);
        output voltage: V = store.voltage;
        output current: A = coil.current;
    }

    /// A resonant circuit with its source.
    pub(crate) model Driven {
        1 mesh {
            Se source { effort: sin(300.0 * t) }
            R loss { resistance: 3.0 }
            I coil { inertia: 0.01 }
            C store { compliance: 1e-4 }
        }
        output current = mesh.f;
    }

    /// The same, with the source outside.
    pub(crate) model Open {
        input voltage;
        1 mesh {
            Se source { effort: voltage }
            R loss { resistance: 3.0 }
            I coil { inertia: 0.01 }
            C store { compliance: 1e-4 }
        }
        output current = mesh.f;
    }

    /// A capacitor that follows its source within 0.1 ms.
    pub(crate) model Lag {
        input voltage;
        1 mesh {
            Se source { effort: voltage }
            R wire { resistance: 1.0 }
            C store { compliance: 1e-4 }
        }
        output moved = store.q;
    }
}

/// Time in s; current in A, speed in rad/s and angle in rad of the motor: by the matrix exponential, to 17 digits.
const GEARED: [(f64, [f64; 3]); 10] = [
    (
        0.0005,
        [
            16.514_209_259_379_597,
            0.406_426_334_585_014_7,
            7.200_557_496_309_726e-5,
        ],
    ),
    (
        0.001,
        [
            23.909_816_762_655_27,
            1.306_475_423_346_043,
            4.869_794_635_261_165_6e-4,
        ],
    ),
    (
        0.005,
        [
            29.383_311_906_290_6,
            11.302_330_052_865_859,
            0.025_322_663_368_106_86,
        ],
    ),
    (
        0.01,
        [
            28.604_372_046_443_137,
            23.886_240_014_293_91,
            0.113_442_859_642_642_03,
        ],
    ),
    (
        0.05,
        [
            23.039_652_016_497_82,
            112.603_786_290_000_85,
            2.910_788_933_659_222,
        ],
    ),
    (
        0.1,
        [
            17.654_565_894_820_898,
            198.457_399_317_428_72,
            10.789_401_590_310_025,
        ],
    ),
    (
        0.2,
        [
            10.567_170_122_870_3,
            311.450_677_461_659_1,
            36.820_041_646_780_56,
        ],
    ),
    (
        0.3,
        [
            7.805_487_774_539_693,
            355.316_159_991_030_93,
            70.366_194_354_871_1,
        ],
    ),
    (
        0.5,
        [
            5.374_576_580_730_386,
            394.071_809_245_597_9,
            146.027_711_195_613_25,
        ],
    ),
    (
        1.0,
        [
            4.301_968_096_679_727,
            411.172_243_971_968_65,
            349.142_449_836_060_1,
        ],
    ),
];

#[test]
fn a_motor_of_the_library_starts_a_load_through_a_rigid_gear() {
    let model = GearedMotor::<f64>::new(GearedMotorParameters::default()).unwrap();
    let brake = Pulse {
        amplitude: SVector::from([3.0]),
        start: 0.2,
        end: f64::INFINITY,
    };
    let times = GEARED.map(|(time, _)| time);
    let mut expected = GEARED.iter();
    let mut worst = 0.0_f64;
    Adaptive::new(Dop853, 1e-11, 1e-14)
        .sample(
            &model,
            &brake,
            0.0,
            model.initial_state(),
            &times,
            |t, x| {
                let found = model.output(t, x, &SVector::zeros(), &mut Default::default());
                let (_, expected) = expected.next().unwrap();
                for (found, expected) in found.iter().zip(expected) {
                    worst = larger(worst, ((found - expected) / expected).abs());
                }
            },
        )
        .unwrap();
    assert!(expected.next().is_none() && worst < 1e-9, "{worst:e}");
}

#[test]
fn a_motor_of_the_library_balances() {
    let model = GearedMotor::<f64>::new(GearedMotorParameters::default()).unwrap();
    let (_, imbalance) = balance::run(&model, &Constant(SVector::from([1.0])), 2.5e-6, 40_000);
    assert!(imbalance < 1e-12, "{imbalance:e}");
}

#[test]
fn a_diode_of_the_library_rectifies() {
    let model = Rectifier::<f64>::new(RectifierParameters::default()).unwrap();
    let times = rectifier::REFERENCE.map(|(time, _)| time);
    let mut expected = rectifier::REFERENCE.iter();
    let mut worst = 0.0_f64;
    Adaptive::new(Dop853, 1e-12, 1e-14)
        .sample(
            &model,
            &Constant(SVector::zeros()),
            0.0,
            model.initial_state(),
            &times,
            |t, x| {
                let found = model.output(t, x, &SVector::zeros(), &mut Default::default())[0];
                worst = larger(worst, (found - expected.next().unwrap().1).abs());
            },
        )
        .unwrap();
    assert!(expected.next().is_none() && worst < 1e-9, "{worst:e}");
}

/// Voltages after each half of six periods of the source; no step is longer than so many periods.
fn rectified(method: impl Estimating, tolerance: f64, frequency: f64, longest: f64) -> Vec<f64> {
    let model = Rectifier::<f64>::new(RectifierParameters {
        frequency: std::f64::consts::TAU * frequency,
        ..Default::default()
    })
    .unwrap();
    let halves = (1..=12).map(|half| 0.5 * f64::from(half) / frequency);
    let times: Vec<f64> = halves.collect();
    let solver = Adaptive {
        nominal: &[1e-3],
        longest: longest / frequency,
        ..Adaptive::new(method, tolerance, 0.1 * tolerance)
    };
    let (input, start) = (Constant(SVector::zeros()), model.initial_state());
    let mut voltages = Vec::new();
    solver
        .sample(&model, &input, 0.0, start, &times, |t, x| {
            let found = model.output(t, x, &SVector::zeros(), &mut Default::default());
            voltages.push(found[0]);
        })
        .unwrap();
    voltages
}

/// While its diode blocks nothing changes and steps become long; each pulse must be found all the same.
#[test]
fn no_pulse_of_a_rectifier_is_stepped_over() {
    let tolerances = [
        1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 1e-9, 1e-10, 1e-12,
    ];
    let all = f64::INFINITY;
    for frequency in [10.0, 50.0, 173.0, 1000.0, 5000.0] {
        let exact = rectified(Dop853, 1e-13, frequency, 0.01);
        for tolerance in tolerances {
            let runs = [
                rectified(Tsit5, tolerance, frequency, all),
                rectified(Dop853, tolerance, frequency, all),
                rectified(Rodas4, tolerance, frequency, all),
                rectified(Rodas5P, tolerance, frequency, all),
                rectified(Radau5, tolerance, frequency, all),
            ];
            let errors = runs.map(|found| {
                let pairs = found.iter().zip(&exact);
                let error = pairs.fold(0.0, |worst, (found, exact)| {
                    larger(worst, (found - exact).abs())
                });
                error / (10.0 * tolerance)
            });
            // The worst error is 39 tolerances; a missed pulse, of about a volt, costs from a hundred to 1e11.
            assert!(
                errors.iter().all(|error| *error < 60.0),
                "{frequency} Hz, {tolerance:e}: {errors:.1?}"
            );
        }
    }
}

/// How many times the evaluations are taken that a run's steps need, `each` for one.
fn excess<const M: usize>(
    method: impl Estimating,
    each: u64,
    model: &impl System<f64, 2, M, 1>,
    input: &impl Input<f64, M>,
) -> f64 {
    let start = model.initial_state();
    let solver = Adaptive::new(method, 1e-7, 1e-10);
    let statistics = solver.integrate(model, input, 0.0, 1.0, start, |_| ());
    let Statistics {
        steps,
        rejected,
        evaluations,
        ..
    } = statistics.unwrap();
    evaluations as f64 / (each * (steps + rejected)) as f64
}

/// Wherever it is.
#[test]
fn a_smooth_source_is_hardly_probed() {
    let within = Driven::<f64>::new(DrivenParameters::default()).unwrap();
    let outside = Open::<f64>::new(OpenParameters::default()).unwrap();
    let source = Smooth(|t: f64| SVector::from([f64::sin(300.0 * t)]));
    let none = Constant(SVector::zeros());
    let pairs = [
        [
            excess(Tsit5, 6, &within, &none),
            excess(Tsit5, 6, &outside, &source),
        ],
        [
            excess(Dop853, 12, &within, &none),
            excess(Dop853, 12, &outside, &source),
        ],
    ];
    println!(
        "evaluations by those of the steps alone, with the source within and outside: {pairs:.3?}"
    );
    for [within, outside] in pairs {
        assert!(
            (1.0..1.2).contains(&within) && (1.0..1.2).contains(&outside),
            "{pairs:?}"
        );
    }
}

/// A capacitor that follows a slow source: for explicit methods the fast mode limits the step, and what they differ by there
/// moves nothing.
#[test]
fn a_fast_mode_is_no_pulse() {
    let source = Smooth(|t: f64| SVector::from([f64::sin(2.0 * t)]));
    let model = Lag::<f64>::new(LagParameters::default()).unwrap();
    let start = model.initial_state();
    let solver = Adaptive {
        nominal: &[1e-4],
        ..Adaptive::new(Dop853, 1e-3, 1e-3)
    };
    let found = solver.integrate(&model, &source, 0.0, 1.0, start, |_| ());
    let Statistics {
        steps, rejected, ..
    } = found.unwrap();
    // Of 0.64 ms, a tenth more than where the method is stable by real hλ.
    assert!(steps + rejected < 1800, "{steps} {rejected}");
}

/// Times have seven digits there, and so few must be enough for the rate of the input.
#[test]
fn a_fast_mode_is_followed_in_single_precision() {
    let source = Smooth(|t: f32| SVector::from([(2.0 * t).sin()]));
    let model = Lag::<f32>::new(LagParameters::default()).unwrap();
    for step in 0..8 {
        let solver = Adaptive {
            nominal: &[1e-4],
            ..Adaptive::new(Rodas4, 1e-4 * f64::powi(0.6, step), 1e-5)
        };
        let start = model.initial_state();
        let found = solver.integrate(&model, &source, 0.0, 10.0, start, |_| ());
        let evaluations = found.unwrap().evaluations;
        assert!(evaluations < 5000, "{evaluations}");
    }
}

/// A run in many parts, as a simulation that exchanges inputs with another one makes it, pays little for each.
#[test]
fn many_short_runs_are_hardly_probed() {
    let source = Smooth(|t: f64| SVector::from([f64::sin(300.0 * t)]));
    let model = Open::<f64>::new(OpenParameters::default()).unwrap();
    let solver = Adaptive::new(Tsit5, 1e-7, 1e-10);
    let (mut x, mut attempts, mut evaluations) = (model.initial_state(), 0, 0);
    for part in 0..100 {
        let ends = [part, part + 1].map(|end| 1e-3 * f64::from(end));
        let found = solver.integrate(&model, &source, ends[0], ends[1], x, |step| {
            x = *step.state();
        });
        let found = found.unwrap();
        attempts += found.steps + found.rejected;
        evaluations += found.evaluations;
    }
    // The starting step of each takes two more; a fifth may be probes.
    let needed = 6 * attempts + 200;
    assert!(5 * evaluations < 6 * needed, "{needed} {evaluations}");
}

#[test]
fn a_diode_of_the_library_takes_any_voltage() {
    // At its crest, 300 kV over 10 ohm: the trial of the first step is far beyond what an exponential bears.
    let model = Rectifier::<f64>::new(RectifierParameters {
        amplitude: 3e5,
        ..Default::default()
    })
    .unwrap();
    let crest = 0.005;
    let mut memory = Default::default();
    let x = model.initial_state();
    let current = model.output(crest, &x, &SVector::zeros(), &mut memory)[1];
    assert!(
        model
            .trouble(crest, &x, &SVector::zeros(), &memory)
            .is_none()
    );
    let voltage = 0.025852 * (current / 1e-12).ln_1p();
    assert!((current * 10.0 + voltage - 3e5).abs() < 1e-6, "{current}");
}

#[test]
fn a_rectifier_balances() {
    let model = Rectifier::<f64>::new(RectifierParameters::default()).unwrap();
    let (_, imbalance) = balance::run(&model, &Constant(SVector::zeros()), 1e-6, 5_000);
    assert!(imbalance < 1e-9, "{imbalance:e}");
}

#[test]
fn a_transformer_carries_a_swing() {
    // Seen from the capacitor the coil is 3² times as large: ω = 1/√(C n² L).
    let model = Swing::<f64>::new(SwingParameters::default()).unwrap();
    let omega = 1.0 / f64::sqrt(2e-6 * 9.0 * 1e-3);
    let end = 5e-4;
    let mut last = model.initial_state();
    Rk4::fixed(
        &model,
        &Constant(SVector::zeros()),
        0.0,
        end,
        1e-7,
        last,
        |_, x| last = *x,
    )
    .unwrap();
    let found = model.output(end, &last, &SVector::zeros(), &mut Default::default());
    let voltage = 5.0 * f64::cos(omega * end);
    let current = 3.0 * 5.0 * 2e-6 * omega * f64::sin(omega * end);
    assert!((found[0] - voltage).abs() < 1e-11, "{} {voltage}", found[0]);
    assert!((found[1] - current).abs() < 1e-12, "{} {current}", found[1]);
    let (_, imbalance) = balance::run(&model, &Constant(SVector::zeros()), 1e-7, 5_000);
    assert!(imbalance < 1e-12, "{imbalance:e}");
}

/// How high both ends of a source are follows from picoamperes beside ten siemens: rounding leaves it unsharp.
#[test]
fn a_bridge_of_diodes_is_solved_at_any_voltage() {
    let model = Bridge::<f64>::new(BridgeParameters::default()).unwrap();
    let current = |voltage: f64| 1e-12 * f64::exp_m1(voltage / 0.02585);
    for number in -60..=60 {
        for (sign, charge) in [(1.0, 0.0), (-1.0, 1e-6), (1.0, -1e-6), (-1.0, 1e-2)] {
            let voltage = sign * f64::powf(10.0, 0.1 * f64::from(number) - 3.0);
            let (x, u) = (SVector::from([charge]), SVector::from([voltage]));
            let mut memory = Default::default();
            let [a, b] = model.output(0.0, &x, &u, &mut memory).into();
            assert_eq!(
                model.trouble(0.0, &x, &u, &memory),
                None,
                "{voltage} {charge}"
            );
            if voltage.abs() < 1.0 {
                let held = 1e3 * charge;
                let balance = current(-a) - current(a - held) + current(-b) - current(b - held);
                let most = 1e-15 * voltage.abs() + 1e-12 * current(voltage.abs());
                assert!(
                    balance.abs() < 10.0 * most,
                    "{voltage} {charge} {balance:e}"
                );
            }
        }
    }
}

/// Where both block, the exponentials are gone, and the little that they leak shares the voltage out.
#[test]
fn diodes_in_series_share_any_voltage() {
    fn found<T: Real>(voltage: f64) -> [f64; 2] {
        let model = InSeries::<T>::new(InSeriesParameters::default()).expect("regular");
        let (x, u) = (SVector::from([T::from_f64(voltage)]), SVector::from([]));
        let mut memory = Default::default();
        let found = model.output(T::from_f64(0.0), &x, &u, &mut memory);
        let trouble = model.trouble(T::from_f64(0.0), &x, &u, &memory);
        assert_eq!(trouble, None, "{voltage}");
        found.map(|it| it.magnitude().copysign(voltage)).into()
    }
    for number in -60..=60 {
        for sign in [1.0, -1.0] {
            let voltage = sign * f64::powf(10.0, 0.1 * f64::from(number) - 3.0);
            let half = 0.5 * voltage;
            let most = f64::min(half, 40.0 * 0.02585);
            let current =
                1e-12 * (f64::exp(most / 0.02585) * (1.0 + (half - most) / 0.02585) - 1.0 + half);
            for ([between, through], precision) in [
                (found::<f64>(voltage), f64::EPSILON),
                (found::<f32>(voltage), f64::from(f32::EPSILON)),
            ] {
                let rounding = 100.0 * precision;
                let error = between - half;
                assert!(
                    error.abs() < rounding * (0.02585 + half.abs()),
                    "{voltage} {error:e}"
                );
                let error = through - current;
                assert!(
                    error.abs() < rounding * (1e-12 + current.abs()),
                    "{voltage} {error:e}"
                );
            }
        }
    }
}

/// A coil that a bridge blocks is held at no current within the saturation of the diodes, until a resistor lies beside them.
#[test]
fn a_bridge_behind_a_coil_wants_a_snubber() {
    fn voltage<I: Integrator<2>>(integrator: I, beside: f64) -> Result<f64, Stopped> {
        let model = Choked::<f64>::new(ChokedParameters { beside }).expect("regular");
        let start = model.initial_state();
        let mut last = start;
        let observe = |step: &mut Step<'_, f64, 2, _>| last = *step.state();
        integrator.integrate(&model, &(), 0.0, 0.05, start, observe)?;
        Ok(model.output(0.05, &last, &SVector::zeros(), &mut Default::default())[0])
    }
    // By Kirchhoff's laws: current = voltage / beside + 2 saturation exp(-stored / 2 thermal) sinh(voltage / 2 thermal).
    let known = 5.808_932_941;
    for (found, error) in [
        (voltage(Adaptive::new(Radau5, 1e-8, 1e-13), 1e6), 2e-9),
        (voltage(Adaptive::new(Radau5, 1e-6, 1e-11), 1e6), 1e-6),
        (voltage(Adaptive::new(Rodas5P, 1e-6, 1e-11), 1e6), 1e-6),
    ] {
        let found = found.expect("the snubber helps");
        assert!((found - known).abs() < error, "{found}");
    }
    let few = Adaptive {
        most: 3_000,
        ..Adaptive::new(Radau5, 1e-6, 1e-9)
    };
    let stopped = voltage(few, 1e12).expect_err("held too sharply");
    assert!(
        matches!(stopped.cause, Cause::TooManySteps { next } if next < 1e-9),
        "{stopped}"
    );
}

/// While the diode blocks, a change of its current by 1e-12 A is one of a volt, and makes all others small. Behind the jump it
/// is to carry 10 A.
#[test]
fn a_diode_behind_coupled_coils_begins_to_conduct() {
    fn voltage(leak: f64, solver: impl Integrator<3>) -> f64 {
        let model = Coupled::new(CoupledParameters { leak }).unwrap();
        let closed = Pulse {
            amplitude: SVector::from([1.0]),
            start: 2e-5,
            end: 1.0,
        };
        let mut end = model.initial_state();
        let run = solver.integrate(&model, &closed, 0.0, 2.8e-5, end, |step| {
            end = *step.state()
        });
        run.unwrap();
        model.output(2.8e-5, &end, &SVector::zeros(), &mut Default::default())[0]
    }
    let expected = voltage(1e-7, Adaptive::new(Radau5, 1e-9, 1e-12));
    for tolerance in [1e-6, 1e-8] {
        let absolute = 1e-3 * tolerance;
        let found = [
            voltage(0.0, Adaptive::new(Radau5, tolerance, absolute)),
            voltage(0.0, Adaptive::new(Radau9, tolerance, absolute)),
            voltage(0.0, Auto::new(tolerance, absolute)),
        ];
        println!("{tolerance:e}: {found:?}, {expected}");
        assert!(
            found
                .iter()
                .all(|it| (it - expected).abs() < 100.0 * tolerance),
            "{found:?}"
        );
    }
}
