//! Nonlinear algebraic loops against closed forms, bisection, references and identities.

use mbg_runtime::{
    Adaptive, Cause, Constant, Dop853, Dual, Estimating, Integrator, Loop, Pulse, Radau5, Real,
    Rk4, Rodas5P, Smooth, Solver, System, Trouble, Tsit5, mbg,
};
use nalgebra::{SMatrix, SVector};

use crate::references::errors::larger;
use crate::references::rectifier;

mbg! {
    /// Source, resistor and diode in series with a capacitor and its load: the diode's law gives the flow.
    pub(crate) model Rectifier {
        param series: ohm = 10.0;
        param saturation: A = 1e-12;
        param thermal: V = 0.025852;
        input voltage: V;
        1 mesh {
            Se supply { effort: voltage }
            R wire { resistance: series }
            R diode { flow: saturation * (exp(e / thermal) - 1.0) }
        }
        0 node { C store { compliance: 1e-4 } R load { resistance: 1000.0 } }
        mesh -> node;
        integral charge = mesh.f;
        output smoothed: V = store.e;
        output current: A = mesh.f;
        output moved = charge;
    }

    /// A tank drained through two pipes with an orifice between them: the law gives the effort.
    pub(crate) model Tank {
        param drag = 3.0;
        0 level { C tank { compliance: 2.0, initial: 4.0 } }
        1 drain {
            R inlet { resistance: 0.5 }
            R orifice { effort: drag * f * abs(f) }
            R outlet { resistance: 0.25 }
        }
        level -> drain;
        output flow = drain.f;
    }

    /// The same, with the square root of the pressure, smooth at zero.
    pub(crate) model RootTank {
        param drag = 3.0;
        param smooth = 1e-6;
        0 level { C tank { compliance: 2.0, initial: 4.0 } }
        1 drain {
            R inlet { resistance: 0.5 }
            R orifice { flow: e / sqrt(drag * sqrt(e * e + smooth * smooth)) }
            R outlet { resistance: 0.25 }
        }
        level -> drain;
        output flow = drain.f;
    }

    /// The same without smoothing: the slope is infinite at zero.
    pub(crate) model SharpTank {
        0 level { C tank { compliance: 2.0, initial: 4.0 } }
        1 drain {
            R inlet { resistance: 0.5 }
            R orifice { flow: sign(e) * sqrt(abs(e) / 3.0) }
            R outlet { resistance: 0.25 }
        }
        level -> drain;
        output flow = drain.f;
    }

    /// A sharp root and a pipe with turbulent and laminar loss in series: both laws give what the other reads.
    pub(crate) model LongPipe {
        param rough = 1e13;
        param laminar = 1e6;
        param opening = 1e-6;
        input head: Pa;
        1 line {
            Se pump { effort: head }
            R orifice { flow: opening * sign(e) * sqrt(abs(e)) }
            R pipe { effort: rough * f * abs(f) + laminar * f }
        }
        integral volume = line.f;
        output flow: m^3/s = line.f;
        output moved = volume;
    }

    /// Two tanks, a pump between them, and two turbulent losses in a row, whose slopes are zero at rest.
    pub(crate) model Tanks {
        causality componentwise;
        param left = 0.5;
        param loss = 1.0;
        input head;
        0 from { C first { compliance: 1.0, initial: left } }
        0 to { C second { compliance: 1.0, initial: 0.5 } }
        1 pipe {
            Se pump { effort: head }
            R length { effort: loss * f * abs(f) }
            R bend { effort: 0.25 * loss * f * abs(f) }
        }
        from -> pipe;
        pipe -> to;
        output flow = pipe.f;
    }

    /// A massless slider with friction that falls with speed, pulled through a damper.
    pub(crate) model Slider {
        param coulomb: N = 1.0;
        param breakaway: N = 1.5;
        param stribeck: m/s = 0.1;
        param smooth: m/s = 0.01;
        input force: N;
        1 slide {
            Se pull { effort: force }
            R damper { resistance: 12.0 }
            R friction {
                effort: (coulomb + (breakaway - coulomb) * exp(-powi(f / stribeck, 2))) * tanh(f / smooth)
            }
        }
        integral travel = slide.f;
        output position = travel;
    }

    /// Two diodes that see different voltages, between two capacitors and a choke.
    pub(crate) model TwoDiodes {
        param saturation: A = 1e-4;
        param thermal: V = 0.026;
        param leakage: ohm = 50.0;
        input voltage: V;
        1 first {
            Se supply { effort: voltage }
            C input { compliance: 1e-4, initial: 1e-5 }
            R wire { resistance: 20.0 }
            R left { flow: saturation * (exp(e / thermal) - 1.0) }
        }
        0 middle {
            R right { flow: saturation * (exp(e / thermal) - 1.0) }
            R leak { resistance: leakage }
        }
        1 choke { I coil { inertia: 0.01, initial_flow: 0.002 } C store { compliance: 2e-4 } }
        first -> middle;
        middle -> choke;
        output node = middle.e;
        output current = first.f;
    }

    /// A resistor to the next node, and a diode to ground there.
    component Rung(port from, port to) {
        1 wire { R resistor { resistance: 10.0 } }
        from -> wire;
        wire -> to;
        to -> R diode { flow: 1e-4 * (exp(e / 0.026) - 1.0) };
    }

    /// Four diodes in a ladder: too many unknowns for an adjugate.
    pub(crate) model DiodeLadder {
        input voltage: V;
        0 start { Se supply { effort: voltage } }
        0 first;
        0 second;
        0 third;
        0 fourth;
        1 choke { I coil { inertia: 0.01 } R load { resistance: 5.0 } }
        a: Rung (start, first);
        b: Rung (first, second);
        c: Rung (second, third);
        d: Rung (third, fourth);
        fourth -> choke;
        output last: V = fourth.e;
    }

    /// Resistors that are coupled by what varies: each element of the matrix vanishes somewhere, and on the diagonal
    /// all of them where the coupling is zero.
    pub(crate) model Coupled {
        input drive[4];
        input coupling;
        1 mesh[4] {
            Se push { effort: drive }
            R loss { resistance: [
                [2.0 * coupling, 2.0 + coupling, 1.0 + 3.0 * coupling, 1.0 - coupling],
                [1.0 + coupling, 3.0 * coupling, 3.0 + coupling, 1.0 + 2.0 * coupling],
                [1.0 - 2.0 * coupling, 1.0 + coupling, -coupling, 2.0 + coupling],
                [2.0 + coupling, 1.0 + coupling, 1.0 + coupling, 5.0 * coupling],
            ] }
        }
        integral travel[4] = mesh.f;
        output position[4] = travel;
    }

    /// A friction that has no force for a strong push backwards.
    pub(crate) model Parabola {
        input force: N;
        1 slide {
            Se push { effort: force }
            R linear { resistance: 1.0 }
            R parabola { effort: 1.0 * powi(f, 2) }
        }
        integral travel = slide.f;
        output position = travel;
    }

    /// A law that gives the effort, where the effort is what is known.
    pub(crate) model TurnedRound {
        causality componentwise;
        input force: N;
        1 slide { Se push { effort: force } R friction { effort: 1.0 * f + 1.0 * powi(f, 3) } }
        integral travel = slide.f;
        output position = travel;
    }

    /// A resistance that a flow elsewhere sets: no loop at all, though two unknowns are multiplied.
    pub(crate) model Modulated {
        input force: N;
        1 valve { Sf pilot { flow: 3.0 } R back { resistance: 1.0 } }
        1 slide {
            Se push { effort: force }
            R linear { resistance: 1.0 }
            R throttle { effort: valve.f * f }
        }
        integral travel = slide.f;
        output position = travel;
    }
}

type None0 = SVector<f64, 0>;

/// The root of an increasing function.
fn bisect(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

fn newton(unknowns: usize) -> impl Fn(&Loop) -> bool {
    move |found| matches!(found.solver, Solver::Newton { unknowns: count, .. } if count == unknowns)
}

/// Both Jacobians against dual numbers and against central differences, and the balance of power, at one point.
fn check<S, D, const N: usize, const M: usize, const P: usize>(
    (model, dual): (&S, &D),
    x: &SVector<f64, N>,
    u: &SVector<f64, M>,
) where
    S: System<f64, N, M, P>,
    D: System<Dual<f64>, N, M, P>,
{
    let memory = &mut S::Memory::default();
    let by_state = model.jacobian_state(0.0, x, u, memory);
    let by_input = model.jacobian_input(0.0, x, u, memory);
    let rate = model.derivative(0.0, x, u, memory);
    assert_eq!(model.trouble(0.0, x, u, memory), None);
    let column = |state: Option<usize>, input: Option<usize>| {
        let (mut x, mut u) = (x.map(Dual::constant), u.map(Dual::constant));
        state.into_iter().for_each(|state| x[state].slope = 1.0);
        input.into_iter().for_each(|input| u[input].slope = 1.0);
        let slopes = dual.derivative(Dual::constant(0.0), &x, &u, &mut D::Memory::default());
        slopes.map(|value| value.slope)
    };
    let difference = |state: Option<usize>, input: Option<usize>, memory: &mut S::Memory| {
        let step = |sign: f64, memory: &mut S::Memory| {
            let (mut x, mut u) = (*x, *u);
            let width = |value: f64| sign * 1e-6 * value.abs().max(1e-3);
            state.into_iter().for_each(|k| x[k] += width(x[k]));
            input.into_iter().for_each(|k| u[k] += width(u[k]));
            let moved: f64 = state.map_or(0.0, |k| x[k]) + input.map_or(0.0, |k| u[k]);
            (model.derivative(0.0, &x, &u, memory), moved)
        };
        let (upper, lower) = (step(1.0, memory), step(-1.0, memory));
        (upper.0 - lower.0) / (upper.1 - lower.1)
    };
    // What a difference loses by rounding.
    let rounding = 3e-14 * rate.amax().max(1e-3) / 1e-9;
    let near = |a: SVector<f64, N>, b: SVector<f64, N>, relative: f64, absolute: f64| {
        for row in 0..N {
            let scale = a[row].abs().max(b[row].abs());
            let error = (a[row] - b[row]).abs();
            let allowed = relative * scale + absolute;
            assert!(error <= allowed, "row {row}: {} {}", a[row], b[row]);
        }
    };
    for state in 0..N {
        let exact = by_state.column(state).into_owned();
        near(
            exact,
            column(Some(state), None),
            1e-10,
            1e-14 * exact.amax() + 1e-20,
        );
        near(exact, difference(Some(state), None, memory), 1e-5, rounding);
    }
    for input in 0..M {
        let exact = by_input.column(input).into_owned();
        near(
            exact,
            column(None, Some(input)),
            1e-10,
            1e-14 * exact.amax() + 1e-20,
        );
        near(exact, difference(None, Some(input), memory), 1e-5, rounding);
    }
    let along = x.zip_map(&rate, |value, slope| Dual { value, slope });
    let stored = dual.energy(Dual::constant(0.0), &along).slope;
    let power = model.power(0.0, x, u, memory);
    let scale = power.supplied.abs() + power.dissipated.abs() + stored.abs();
    let error = (stored - power.supplied + power.dissipated).abs();
    assert!(error < 1e-11 * scale, "{stored} {power:?}");
}

/// Models for numbers and for dual numbers, with their default parameters.
macro_rules! both {
    ($model:ident, $parameters:ident) => {
        (
            &$model::<f64>::new($parameters::default()).unwrap(),
            &$model::<Dual<f64>>::new($parameters::default()).unwrap(),
        )
    };
}

/// Heads of fifteen powers of ten, each for itself. The flow is far below one, from which the iteration begins: beside that all
/// that is left of it seems to be rounding.
#[test]
fn flows_far_below_one_are_found_from_a_cold_start() {
    fn worst<T: Real>([rough, laminar, opening]: [f64; 3]) -> f64 {
        let number = T::from_f64;
        let parameters = LongPipeParameters {
            rough: number(rough),
            laminar: number(laminar),
            opening: number(opening),
        };
        let pipe = LongPipe::<T>::new(parameters).unwrap();
        let mut worst = 0.0;
        for place in 0..300 {
            let head = 10_f64.powf(9.0 - 0.05 * f64::from(place));
            let [x, u] = [0.0, head].map(|it| SVector::from([number(it)]));
            let mut memory = Default::default();
            let flow = pipe.output(number(0.0), &x, &u, &mut memory)[0];
            let trouble = pipe.trouble(number(0.0), &x, &u, &memory);
            assert!(trouble.is_none(), "{head:e} Pa: {trouble:?}");
            let sharp = rough + 1.0 / (opening * opening);
            let exact = 2.0 * head / (laminar + f64::sqrt(laminar * laminar + 4.0 * sharp * head));
            worst = larger(worst, (flow.find(|_| true).unwrap() / exact - 1.0).abs());
        }
        worst
    }
    for laws in [
        [1e13, 1e6, 1e-6],
        [1e6, 1e3, 1e-3],
        [1e10, 1e6, 1e-6],
        [1e8, 1e6, 1e-6],
    ] {
        assert!(worst::<f64>(laws) < 1e-9, "{laws:?}");
        assert!(worst::<f32>(laws) < 1e-2, "{laws:?}");
    }
    assert!(worst::<f64>([1e13, 1e9, 1e-6]) < 1e-9);
}

#[test]
fn diode_current_equals_bisection_from_either_side() {
    let (model, _) = both!(Rectifier, RectifierParameters);
    for step in -40..=40 {
        let voltage = 0.25 * f64::from(step);
        let mut memory = Default::default();
        let u = SVector::from([voltage]);
        let current = model.output(0.0, &SVector::zeros(), &u, &mut memory)[1];
        assert_eq!(model.trouble(0.0, &SVector::zeros(), &u, &memory), None);
        let diode = |e: f64| 1e-12 * f64::exp_m1(e / 0.025852);
        let drop = bisect(-11.0, 1.0, |e| diode(e) - (voltage - e) / 10.0);
        let expected = diode(drop);
        let error = f64::abs(current - expected);
        assert!(
            error <= 1e-11 * f64::abs(expected) + 1e-16,
            "{voltage}: {current} {expected}"
        );
    }
}

#[test]
fn rectifier_meets_the_reference() {
    let (model, _) = both!(Rectifier, RectifierParameters);
    let supply = Smooth(|t: f64| SVector::from([rectifier::source(t)]));
    let solver = Adaptive::new(Dop853, 1e-11, 1e-15);
    let times = rectifier::REFERENCE.map(|(time, _)| time);
    let mut found = Vec::new();
    let mut memory = Default::default();
    let x = model.initial_state();
    solver
        .sample(model, &supply, 0.0, x, &times, |t, x| {
            let u = SVector::from([rectifier::source(t)]);
            found.push(model.output(t, x, &u, &mut memory));
        })
        .unwrap();
    for (found, (time, voltage)) in found.iter().zip(rectifier::REFERENCE) {
        let error = f64::abs(found[0] - voltage);
        assert!(error < 1e-10, "{time}: {error:e}");
        let drop = rectifier::source(time) - found[0] - rectifier::RESISTANCE * found[1];
        let current = rectifier::SATURATION * f64::exp_m1(drop / rectifier::THERMAL);
        assert!(
            f64::abs(found[1] - current) < 1e-10 * f64::abs(current),
            "{time}: {current}"
        );
    }
    // Charge until 0.06 s, from the same multi-precision run as the voltages.
    let charge = found[9][2];
    assert!(
        f64::abs(charge - 0.001_252_489_466_232_834_8) < 1e-14,
        "{charge}"
    );
}

/// Error of the voltage of a rectifier with its source outside, in tolerances.
fn rectified(method: impl Estimating, tolerance: f64) -> f64 {
    let model = Rectifier::<f64>::new(RectifierParameters::default()).unwrap();
    let supply = Smooth(|t: f64| SVector::from([rectifier::source(t)]));
    let solver = Adaptive {
        nominal: &[1e-3],
        ..Adaptive::new(method, tolerance, 0.1 * tolerance)
    };
    let times = rectifier::REFERENCE.map(|(time, _)| time);
    let mut expected = rectifier::REFERENCE.iter();
    let mut worst = 0.0;
    let start = model.initial_state();
    solver
        .sample(&model, &supply, 0.0, start, &times, |t, x| {
            let u = SVector::from([rectifier::source(t)]);
            let found = model.output(t, x, &u, &mut Default::default())[0];
            worst = larger(worst, (found - expected.next().unwrap().1).abs());
        })
        .unwrap();
    worst / (10.0 * tolerance)
}

/// While its diode blocks nothing changes, however smooth the source is; each pulse must be found all the same.
#[test]
fn no_pulse_of_a_driven_rectifier_is_stepped_over() {
    for step in 0..28 {
        let tolerance = 1e-3 * f64::powf(10.0, -0.25 * f64::from(step));
        let errors = [
            rectified(Tsit5, tolerance),
            rectified(Dop853, tolerance),
            rectified(Rodas5P, tolerance),
            rectified(Radau5, tolerance),
        ];
        // A missed pulse costs from a hundred to 1e10.
        assert!(
            errors.iter().all(|error| *error < 60.0),
            "{tolerance:e}: {errors:.1?}"
        );
    }
}

#[test]
fn orifice_equals_its_closed_form() {
    let (model, _) = both!(Tank, TankParameters);
    let (rooted, _) = both!(RootTank, RootTankParameters);
    let (sharp, _) = both!(SharpTank, SharpTankParameters);
    for volume in [-8.0, -0.5, -1e-3, 1e-3, 0.5, 4.0, 20.0] {
        let (x, u) = (SVector::from([volume]), None0::zeros());
        let pressure = f64::abs(volume) / 2.0;
        let flow = 2.0 * pressure / (0.75 + f64::sqrt(0.75 * 0.75 + 12.0 * pressure));
        let expected = flow * f64::signum(volume);
        let found = model.output(0.0, &x, &u, &mut Default::default())[0];
        assert!(
            f64::abs(found - expected) <= 1e-14 * flow,
            "{found} {expected}"
        );
        let found = sharp.output(0.0, &x, &u, &mut Default::default())[0];
        assert!(
            f64::abs(found - expected) <= 1e-11 * flow,
            "{found} {expected}"
        );
        if f64::abs(volume) > 0.1 {
            let mut memory = Default::default();
            let found = rooted.output(0.0, &x, &u, &mut memory)[0];
            assert!(
                f64::abs(found - expected) < 1e-10 * flow,
                "{found} {expected} {memory:?}"
            );
        }
    }
}

#[test]
fn friction_that_falls_with_speed_equals_bisection() {
    let (model, _) = both!(Slider, SliderParameters);
    let mut memory = Default::default();
    for step in -60..=60 {
        let force = 0.05 * f64::from(step);
        let u = SVector::from([force]);
        let speed = model.derivative(0.0, &SVector::zeros(), &u, &mut memory)[0];
        assert!(memory.outcomes()[0].converged, "{force}: {memory:?}");
        let friction =
            |f: f64| (1.0 + 0.5 * f64::exp(-f64::powi(f / 0.1, 2))) * f64::tanh(f / 0.01);
        let expected = bisect(-1.0, 1.0, |f| 12.0 * f + friction(f) - force);
        assert!(
            f64::abs(speed - expected) < 1e-14,
            "{force}: {speed} {expected}"
        );
    }
}

#[test]
fn jacobians_and_power_are_exact() {
    let mut random = crate::references::noise::noise(3);
    for _ in 0..200 {
        let mut next = |scale: f64| SVector::from([scale * random()]);
        let (store, voltage) = (next(5e-4)[0], next(8.0));
        check(
            both!(Rectifier, RectifierParameters),
            &SVector::from([store, 0.0]),
            &voltage,
        );
        check(both!(Tank, TankParameters), &next(10.0), &SVector::zeros());
        check(
            both!(RootTank, RootTankParameters),
            &next(10.0),
            &SVector::zeros(),
        );
        check(
            both!(Slider, SliderParameters),
            &SVector::zeros(),
            &next(3.0),
        );
        check(
            both!(TurnedRound, TurnedRoundParameters),
            &SVector::zeros(),
            &next(30.0),
        );
        check(
            both!(Modulated, ModulatedParameters),
            &SVector::zeros(),
            &next(30.0),
        );
        check(
            both!(DiodeLadder, DiodeLadderParameters),
            &next(1e-4),
            &next(3.0),
        );
        let x = SVector::from([next(1e-4)[0], next(1e-4)[0], next(1e-4)[0]]);
        check(both!(TwoDiodes, TwoDiodesParameters), &x, &next(3.0));
    }
}

#[test]
fn a_linear_loop_is_solved_where_its_diagonal_vanishes() {
    let (model, dual) = both!(Coupled, CoupledParameters);
    let (x, u) = (SVector::zeros(), SVector::from([1.0, -2.0, 0.5, 3.0, 0.0]));
    let matrix = SMatrix::<f64, 4, 4>::from_row_slice(&[
        0.0, 2.0, 1.0, 1.0, 1.0, 0.0, 3.0, 1.0, 1.0, 1.0, 0.0, 2.0, 2.0, 1.0, 1.0, 0.0,
    ]);
    let expected = matrix
        .lu()
        .solve(&u.fixed_rows::<4>(0).into_owned())
        .unwrap();
    let found = model.derivative(0.0, &x, &u, &mut ());
    assert!((found - expected).amax() < 1e-14, "{found} {expected}");
    check((model, dual), &x, &u);
    let [conditioning] = model.conditioning(0.0, &x, &u);
    assert!(conditioning.abs() > 0.1, "{conditioning}");
}

#[test]
fn metadata_tells_how_each_loop_is_solved() {
    let loops = Rectifier::<f64>::META.loops;
    assert_eq!(loops.len(), 1);
    assert!(newton(1)(&loops[0]));
    assert_eq!(loops[0].through, ["wire", "diode"]);
    assert_eq!(
        loops[0].solver.to_string(),
        "Newton, 1 unknown, at most 50 iterations"
    );
    assert!(newton(2)(&TwoDiodes::<f64>::META.loops[0]));
    assert!(newton(4)(&DiodeLadder::<f64>::META.loops[0]));
    assert!(newton(1)(&TurnedRound::<f64>::META.loops[0]));
    assert!(
        Modulated::<f64>::META
            .loops
            .iter()
            .all(|found| found.solver == Solver::Linear)
    );
    let linear = super::behaviour::Ladder::<f64>::META.loops[0];
    assert_eq!(linear.through, ["left", "right", "series"]);
    assert_eq!(linear.solver.to_string(), "linear");
}

#[test]
fn turbulent_losses_are_solved_at_rest() {
    let model = Tanks::<f64>::new(TanksParameters::default()).unwrap();
    let rest = model.initial_state();
    for head in [0.0, 1e-9, -1e-3, -1.25, 1.25, -5.0, 3.0] {
        // With 1.25 Newton's first step from one leads to rest.
        let mut memory = Default::default();
        let rate = model.derivative(0.0, &rest, &SVector::from([head]), &mut memory);
        let flow = f64::signum(head) * f64::sqrt(f64::abs(head) / 1.25);
        assert!(
            f64::abs(rate[1] - flow) <= 1e-14 * f64::abs(flow),
            "{head}: {rate}"
        );
        assert_eq!(
            model.trouble(0.0, &rest, &SVector::from([head]), &memory),
            None
        );
    }
    // At rest until the pump starts: then the difference rises by d' = 2 sqrt((h - d) / 1.25), and stays at h.
    let pump = Pulse {
        amplitude: SVector::from([0.8]),
        start: 1.0,
        end: 1e3,
    };
    let mut samples = Vec::new();
    Adaptive::new(Tsit5, 1e-8, 1e-8)
        .sample(&model, &pump, 0.0, rest, &[0.5, 1.5], |_, x| {
            samples.push(x[1] - x[0])
        })
        .unwrap();
    let gone = f64::sqrt(0.8) - 0.5 / f64::sqrt(1.25);
    assert_eq!(samples[0], 0.0);
    assert!(
        (samples[1] - (0.8 - gone * gone)).abs() < 1e-6,
        "{samples:?} {gone}"
    );
}

#[test]
fn next_solve_begins_where_the_last_one_ended() {
    let (model, _) = both!(TwoDiodes, TwoDiodesParameters);
    let (mut memory, x) = (Default::default(), model.initial_state());
    let _ = model.derivative(0.0, &x, &SVector::from([2.0]), &mut memory);
    let cold = memory.outcomes()[0].iterations;
    let _ = model.derivative(0.0, &x, &SVector::from([2.001]), &mut memory);
    let warm = memory.outcomes()[0].iterations;
    assert!(warm <= 4 && cold > 2 * warm, "{cold} {warm}");
}

#[test]
fn loop_without_solution_is_in_trouble_by_name() {
    let (model, _) = both!(Parabola, ParabolaParameters);
    let (x, mut memory) = (SVector::zeros(), Default::default());
    let possible = SVector::from([2.0]);
    assert!(f64::abs(model.derivative(0.0, &x, &possible, &mut memory)[0] - 1.0) < 1e-15);
    assert_eq!(model.trouble(0.0, &x, &possible, &memory), None);
    let impossible = SVector::from([-1.0]);
    assert!(model.derivative(0.0, &x, &impossible, &mut memory)[0].is_nan());
    let trouble = model.trouble(0.0, &x, &impossible, &memory).unwrap();
    let Trouble::Unsolved { through, .. } = trouble else {
        panic!("{trouble}")
    };
    assert_eq!(through, ["linear", "parabola"]);
    assert!(
        trouble
            .to_string()
            .starts_with("the algebraic loop through `linear`, `parabola`")
    );
    assert!(model.derivative(0.0, &x, &possible, &mut memory)[0] == 1.0);
    assert_eq!(model.trouble(0.0, &x, &possible, &memory), None);
}

#[test]
fn integrators_stop_where_a_loop_has_no_solution() {
    let (model, _) = both!(Parabola, ParabolaParameters);
    let falling = Smooth(|t: f64| SVector::from([1.0 - t]));
    let runs = [
        Rk4::fixed(model, &falling, 0.0, 2.0, 0.03, SVector::zeros(), |_, _| {}),
        Adaptive::new(Tsit5, 1e-6, 1e-9).integrate(
            model,
            &falling,
            0.0,
            2.0,
            SVector::zeros(),
            |_| {},
        ),
    ];
    for run in runs {
        let stopped = run.unwrap_err();
        assert!(
            matches!(stopped.cause, Cause::Trouble(Trouble::Unsolved { through, .. }) if through == ["linear", "parabola"]),
            "{stopped}"
        );
        assert!(f64::abs(stopped.time - 1.25) < 0.06, "{stopped}");
    }
    let steady = Constant(SVector::from([1.0]));
    assert!(Rk4::fixed(model, &steady, 0.0, 2.0, 0.03, SVector::zeros(), |_, _| {}).is_ok());
}
