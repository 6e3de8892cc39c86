//! Laws that have no slope at zero: tanks that level out and run empty by roots, in a time that is not without end.

use mbg_runtime::{
    Adaptive, Auto, Constant, Dop853, Fixed, Gauss6, ImplicitMidpoint, Input, Integrator, Radau5,
    Radau9, Rk4, Rodas4, Rodas5P, Ros2, Statistics, System, Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    /// Two tanks that level out, and what they differ by.
    model Level {
        0 left { C tank_a { compliance: 1.0, initial: 2.0 } }
        0 right { C tank_b { compliance: 2.0, initial: 0.5 } }
        1 pipe { R orifice { flow: 0.4 * sign(e) * sqrt(abs(e)) } }
        left -> pipe -> right;
        output head = left.e - right.e;
    }
}

mbg! {
    /// A tank that is filled and runs empty.
    model Tank {
        param content = 0.0;
        input inflow;
        0 bottom {
            C tank { compliance: 1.0, initial: content }
            R drain { flow: 0.4 * sign(e) * sqrt(abs(e)) }
        }
        Sf pump { flow: inflow } -> bottom;
        output head = bottom.e;
    }
}

mbg! {
    /// Four tanks in a row, of which one levels out with the next while others flow.
    model Row {
        0 a { C tank_a { compliance: 1.0, initial: 2.0 } }
        0 b { C tank_b { compliance: 1.5, initial: 1.0 } }
        0 c { C tank_c { compliance: 0.7, initial: 0.2 } }
        0 d { C tank_d { compliance: 0.9, initial: 0.1 } }
        1 ab { R pipe_ab { flow: 0.4 * sign(e) * sqrt(abs(e)) } }
        1 bc { R pipe_bc { flow: 0.3 * sign(e) * sqrt(abs(e)) } }
        1 cd { R pipe_cd { flow: 0.7 * sign(e) * sqrt(abs(e)) } }
        a -> ab -> b; b -> bc -> c; c -> cd -> d;
        output heads[4] = [a.e, b.e, c.e, d.e];
    }
}

mbg! {
    /// Two tanks, of which the lower one drains.
    model Pair {
        param upper = 1.0;
        param lower = 0.5;
        0 above { C tank_a { compliance: 1.0, initial: upper } }
        0 below {
            C tank_b { compliance: 1.0, initial: lower }
            R drain { flow: 0.4 * sign(e) * sqrt(abs(e)) }
        }
        1 pipe { R orifice { flow: 0.4 * sign(e) * sqrt(abs(e)) } }
        above -> pipe -> below;
        output heads[2] = [above.e, below.e];
    }
}

mbg! {
    /// Two tanks that run empty at once, in pascals and cubic metres.
    model Cascade {
        0 above { C upper { compliance: 1.6e-5, initial: 0.098 } }
        0 below {
            C lower { compliance: 2e-5, initial: 0.098 }
            R drain { flow: 2e-5 * sign(e) * sqrt(abs(e)) }
        }
        1 pipe { R orifice { flow: 2e-5 * sign(e) * sqrt(abs(e)) } }
        above -> pipe -> below;
        output contents[2] = [upper.q, lower.q];
    }
}

mbg! {
    /// A mass on a spring, and a damper whose force is a root of its speed, from rest.
    model Swing {
        1 body {
            I mass { inertia: 1.0 }
            C spring { stiffness: 9.0, initial: 1.0 }
            R damper { effort: 0.5 * sign(f) * sqrt(abs(f)) }
        }
        output place = spring.q;
    }
}

/// The outputs at times, one after another.
fn samples<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    times: &[f64],
    solver: &impl Integrator<N>,
) -> (Vec<SVector<f64, P>>, Statistics)
where
    S: System<f64, N, M, P>,
{
    let mut found = Vec::new();
    let start = model.initial_state();
    let run = solver.sample_outputs(model, input, 0.0, start, times, |_, _, outputs| {
        found.push(*outputs);
    });
    (found, run.unwrap())
}

/// By adaptive methods at several tolerances: the name with the tolerance, the outputs and how many steps were tried.
fn adaptive<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    times: &[f64],
    mut each: impl FnMut((&str, f64), &[SVector<f64, P>], u64),
) where
    S: System<f64, N, M, P>,
{
    for tolerance in [1e-6, 1e-9, 1e-12] {
        macro_rules! by {
            ($($name:literal: $solver:expr),*) => {
                $({
                    let (found, statistics) = samples(model, input, times, &$solver);
                    each(($name, tolerance), &found, statistics.steps + statistics.rejected);
                })*
            };
        }
        by!(
            "Tsit5": Adaptive::new(Tsit5, tolerance, tolerance),
            "Dop853": Adaptive::new(Dop853, tolerance, tolerance),
            "Rodas4": Adaptive::new(Rodas4, tolerance, tolerance),
            "Rodas5P": Adaptive::new(Rodas5P, tolerance, tolerance),
            "Radau5": Adaptive::new(Radau5, tolerance, tolerance),
            "Radau9": Adaptive::new(Radau9, tolerance, tolerance),
            "Auto": Auto::new(tolerance, tolerance)
        );
    }
}

/// The same by methods at steps of constant length.
fn fixed<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    input: &impl Input<f64, M>,
    times: &[f64],
    step: f64,
    mut each: impl FnMut(&str, &[SVector<f64, P>], u64),
) where
    S: System<f64, N, M, P>,
{
    macro_rules! by {
        ($($name:literal: $method:expr),*) => {
            $({
                let (found, statistics) = samples(model, input, times, &Fixed::new($method, step));
                each($name, &found, statistics.steps + statistics.rejected);
            })*
        };
    }
    by!(
        "RK4": Rk4,
        "Tsit5": Tsit5,
        "Gauss6": Gauss6::default(),
        "Radau5": Radau5,
        "ROS2": Ros2,
        "Rodas4": Rodas4,
        "Rodas5P": Rodas5P,
        "midpoint": ImplicitMidpoint { sweeps: 3 }
    );
}

/// Methods that are less exact.
const ORDER_TWO: [&str; 2] = ["midpoint", "ROS2"];

fn largest_error<const P: usize>(
    found: &[SVector<f64, P>],
    times: &[f64],
    exact: impl Fn(f64) -> SVector<f64, P>,
) -> f64 {
    let errors = found.iter().zip(times);
    errors.fold(0.0, |most: f64, (found, time)| {
        most.max((found - exact(*time)).amax())
    })
}

fn times(end: f64) -> Vec<f64> {
    (0..=200)
        .map(|part| end * f64::from(part) / 200.0)
        .collect()
}

/// The root of what they differ by falls by 0.3 a second, until it is zero.
#[test]
fn tanks_level_out_and_stay_level() {
    let model = Level::<f64>::new(LevelParameters::default()).unwrap();
    let exact = |t: f64| SVector::from([(f64::sqrt(1.75) - 0.3 * t).max(0.0).powi(2)]);
    let times = times(10.0);
    adaptive(&model, &(), &times, |(name, tolerance), found, tried| {
        let error = largest_error(found, &times, exact);
        assert!(
            error < 20.0 * tolerance,
            "{name} at {tolerance:e}: {error:e}"
        );
        assert!(tried < 800, "{name} at {tolerance:e}: {tried}");
    });
    fixed(&model, &(), &times, 0.1, |name, found, tried| {
        let error = largest_error(found, &times, exact);
        let most = if ORDER_TWO.contains(&name) {
            1e-3
        } else {
            1e-5
        };
        assert!(error < most, "{name}: {error:e}");
        assert!(tried < 150, "{name}: {tried}");
    });
}

#[test]
fn a_tank_runs_empty_and_stays_so() {
    let model = Tank::<f64>::new(TankParameters { content: 2.0 }).unwrap();
    let none = Constant(SVector::from([0.0]));
    let exact = |t: f64| SVector::from([(f64::sqrt(2.0) - 0.2 * t).max(0.0).powi(2)]);
    let times = times(10.0);
    adaptive(&model, &none, &times, |(name, tolerance), found, tried| {
        let error = largest_error(found, &times, exact);
        assert!(
            error < 20.0 * tolerance,
            "{name} at {tolerance:e}: {error:e}"
        );
        assert!(tried < 1100, "{name} at {tolerance:e}: {tried}");
    });
    fixed(&model, &none, &times, 0.1, |name, found, tried| {
        let error = largest_error(found, &times, exact);
        let most = if ORDER_TWO.contains(&name) {
            1e-3
        } else {
            1e-5
        };
        assert!(error < most, "{name}: {error:e}");
        assert!(tried < 150, "{name}: {tried}");
    });
}

/// For a second of every twenty.
struct Pulses;

impl Input<f64, 1> for Pulses {
    fn value(&self, _t: f64, since: f64) -> SVector<f64, 1> {
        SVector::from([if since % 20.0 < 1.0 { 1.0 } else { 0.0 }])
    }

    fn next_jump(&self, t: f64) -> Option<f64> {
        [1.0, 20.0, 21.0].into_iter().find(|jump| *jump > t)
    }
}

/// From empty on, where the law has no slope; and from where it has come to rest.
#[test]
fn an_empty_tank_is_filled_again_and_again() {
    let model = Tank::<f64>::new(TankParameters::default()).unwrap();
    let times = times(40.0);
    let (exact, _) = samples(
        &model,
        &Pulses,
        &times,
        &Adaptive::new(Radau9, 1e-13, 1e-13),
    );
    // With the root s of the content: ds/dt = 1 / (2 s) - 0.2, so t = -5 s - 12.5 ln(1 - 0.4 s) while it is filled.
    let full = exact[5][0].sqrt();
    assert!((-5.0 * full - 12.5 * f64::ln_1p(-0.4 * full) - 1.0).abs() < 1e-11);
    let error = |found: &[SVector<f64, 1>]| {
        let pairs = found.iter().zip(&exact);
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).amax()))
    };
    adaptive(
        &model,
        &Pulses,
        &times,
        |(name, tolerance), found, tried| {
            let error = error(found);
            assert!(
                error < 20.0 * tolerance,
                "{name} at {tolerance:e}: {error:e}"
            );
            assert!(tried < 3000, "{name} at {tolerance:e}: {tried}");
        },
    );
    // Also from next to empty, where slopes are so steep that a step by them goes nowhere.
    for content in [0.0, 1e-300, 1e-20, 1e-6] {
        let model = Tank::<f64>::new(TankParameters { content }).unwrap();
        fixed(&model, &Pulses, &times, 0.1, |name, found, tried| {
            let error = error(found);
            let most = match name {
                "midpoint" => 3e-4,
                "ROS2" => 5e-4,
                _ => 1e-4,
            };
            assert!(error < most, "{name} from {content:e}: {error:e}");
            assert!(tried < 800, "{name} from {content:e}: {tried}");
        });
    }
}

/// The lower one flows back into the upper one first, and drains it then.
#[test]
fn what_flows_between_tanks_turns() {
    let times = times(20.0);
    for (upper, lower) in [(1.0, 0.5), (1.0, 0.0), (0.0, 1.0), (2.0, 2.0), (0.3, 0.7)] {
        let model = Pair::<f64>::new(PairParameters { upper, lower }).unwrap();
        let (exact, _) = samples(&model, &(), &times, &Adaptive::new(Radau9, 1e-13, 1e-13));
        let error = |found: &[SVector<f64, 2>]| {
            let pairs = found.iter().zip(&exact);
            pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).amax()))
        };
        adaptive(&model, &(), &times, |(name, tolerance), found, tried| {
            let error = error(found);
            let from = format!("{name} at {tolerance:e} from {upper} and {lower}");
            assert!(error < 300.0 * tolerance, "{from}: {error:e}");
            assert!(tried < 2000, "{from}: {tried}");
        });
        fixed(&model, &(), &times, 0.05, |name, found, tried| {
            let error = error(found);
            let most = if ORDER_TWO.contains(&name) {
                3e-4
            } else {
                1e-5
            };
            assert!(error < most, "{name} from {upper} and {lower}: {error:e}");
            assert!(tried < 600, "{name} from {upper} and {lower}: {tried}");
        });
    }
}

/// The root of the lower pressure falls by 0.25 a second, and that of the difference is half of it: both are zero at 280 s.
#[test]
fn two_tanks_run_empty_at_once() {
    let model = Cascade::<f64>::new(CascadeParameters::default()).unwrap();
    let exact = |t: f64| SVector::from([2e-5 * (70.0 - 0.25 * t).max(0.0).powi(2); 2]);
    let times = times(400.0);
    adaptive(&model, &(), &times, |(name, tolerance), found, tried| {
        let error = largest_error(found, &times, exact);
        assert!(
            error < 20.0 * tolerance,
            "{name} at {tolerance:e}: {error:e}"
        );
        assert!(tried < 600, "{name} at {tolerance:e}: {tried}");
    });
    fixed(&model, &(), &times, 1.0, |name, found, tried| {
        let error = largest_error(found, &times, exact);
        assert!(error < 1e-5, "{name}: {error:e}");
        assert!(tried < 1000, "{name}: {tried}");
    });
}

/// One after another they are level, and hold all that was in them.
#[test]
fn tanks_in_a_row_level_out() {
    let model = Row::<f64>::new(RowParameters::default()).unwrap();
    let level = (2.0 + 1.0 + 0.2 + 0.1) / (1.0 + 1.5 + 0.7 + 0.9);
    let times = times(30.0);
    let (exact, _) = samples(&model, &(), &times, &Adaptive::new(Radau9, 1e-13, 1e-13));
    adaptive(&model, &(), &times, |(name, tolerance), found, tried| {
        let pairs = found.iter().zip(&exact);
        let error = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).amax()));
        assert!(
            error < 300.0 * tolerance,
            "{name} at {tolerance:e}: {error:e}"
        );
        assert!(tried < 1500, "{name} at {tolerance:e}: {tried}");
        let last = found[found.len() - 1].add_scalar(-level).amax();
        assert!(last < 1e-12, "{name} at {tolerance:e}: {last:e}");
    });
}

/// What turns at rest has no slope for an instant alone.
#[test]
fn a_root_of_a_speed_damps_to_the_end() {
    let model = Swing::<f64>::new(SwingParameters::default()).unwrap();
    let times = times(30.0);
    let (exact, _) = samples(&model, &(), &times, &Adaptive::new(Radau9, 1e-13, 1e-13));
    adaptive(&model, &(), &times, |(name, tolerance), found, _| {
        let pairs = found.iter().zip(&exact);
        let error = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).amax()));
        assert!(
            error < 300.0 * tolerance,
            "{name} at {tolerance:e}: {error:e}"
        );
    });
}
