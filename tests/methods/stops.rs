//! What runs tell that cannot go on.

use mbg_runtime::{
    Adaptive, Auto, Cause, Constant, Dop853, Fixed, Gauss6, ImplicitMidpoint, Integrator, Picked,
    Pirk8, Pirk16, Radau5, Radau9, Real, Rk4, Rodas4, Rodas5P, Ros2, Smooth, Stopped, System,
    Trouble, Tsit5, Variable, mbg,
};
use nalgebra::SVector;

use crate::problems::{Law, Written, state};

mbg! {
    /// Friction by a root, which is infinitely steep at rest.
    model Throttled {
        1 v { I b { inertia: 2.0 } R r { effort: sign(f) * sqrt(abs(f)) } Se s { effort: 1.0 } }
        output y = v.f;
    }
}

mbg! {
    /// The same without a force, and without a threshold at which it may rest.
    model Still {
        1 v { I b { inertia: 2.0 } R r { effort: sqrt(f) } }
        output y = v.f;
    }
}

mbg! {
    /// A flux of a magnet, whose current a diode blocks at the start.
    model Blocked {
        param blocking = 1e9;
        input voltage: V;
        1 wire {
            Se source { effort: voltage }
            I coil { flow: (p - 1.0) / 1.0, initial: 1.0 - 1.0 / blocking }
            R diode { effort: if f < 0.0 { blocking * f } else { 1.0 * f } }
        }
        output flux: Wb = coil.p;
    }
}

mbg! {
    /// What comes over a weir from one second on, of which s have gone by, runs through a tank that was empty, and holds s⁴ then.
    model Weir {
        integral level = 1.0;
        let over = max(level - 1.0, 0.0);
        0 below {
            C tank { stiffness: 1.0 }
            Sf inlet { flow: 4.0 * powi(over, 3) + powi(over, 2) }
            R drain { flow: sqrt(max(e, 0.0)) }
        }
    }
}

mbg! {
    /// A skate at a speed of 10 m/s along itself. Where it has turned by a right angle its states say no more how it slides.
    #[derivative]
    model Skate {
        causality componentwise;
        1 skate[3]; 1 along; 1 across;
        body: PlanarBody { mass: 2.0, inertia: 0.1 } (skate);
        integral heading: rad = skate.f[0];
        skate[1..3] -> MTF ahead { flow: [[cos(heading), sin(heading)]] } -> along;
        skate[1..3] -> MTF beside { flow: [[-sin(heading), cos(heading)]] } -> across;
        across -> R edge { resistance: 50.0 };
        Se turn { effort: 0.02 } -> skate[0];
        Sf drive { flow: 10.0 } -> along;
        output sliding = across.f;
    }
}

mbg! {
    /// A mass that is pushed, and one behind a spring.
    model Pushed {
        input push: N;
        input pull: N;
        1 first { I a { inertia: 2.0 } Se left { effort: push } }
        1 second { I b { inertia: 1.0 } Se right { effort: pull } }
        0 between { C spring { stiffness: 50.0 } }
        first -> between;
        between -> second;
        output y = first.f;
    }
}

/// A level that rises from zero, and a pipe whose rate depends on it by a power of 3/2.
#[derive(Clone, Copy)]
struct Filling;

impl Law<2, 0> for Filling {
    const STATES: &'static [Variable] = &[state("level"), state("pipe")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let power = x[0] * x[0].abs().sqrt();
        SVector::from([T::from_f64(1.0), power - x[1]])
    }
}

/// The same where the level stays.
#[derive(Clone, Copy)]
struct Resting;

impl Law<2, 0> for Resting {
    const STATES: &'static [Variable] = Filling::STATES;

    fn slope<T: Real>(&self, x: &SVector<T, 2>, none: &SVector<T, 0>) -> SVector<T, 2> {
        let slope = Filling.slope(x, none);
        SVector::from([T::from_f64(0.0), slope[1]])
    }
}

/// A level that falls below zero, of which there is no root.
#[derive(Clone, Copy)]
struct Emptying;

impl Law<2, 0> for Emptying {
    const STATES: &'static [Variable] = &[state("level"), state("pipe")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        SVector::from([T::from_f64(-1.0), x[0].sqrt()])
    }
}

/// A stiff state, and a level that falls below zero, where its outflow is zero by an angle that is none, whose slope is no number.
#[derive(Clone, Copy)]
struct Drained;

impl Law<2, 0> for Drained {
    const STATES: &'static [Variable] = &[state("level"), state("fast")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let above = x[0].max(T::from_f64(0.0));
        let outflow = above * above.atan2(above);
        SVector::from([T::from_f64(-1.0) - outflow, T::from_f64(-1e6) * x[1]])
    }
}

/// Levels that each rise from zero and drain by a square root.
#[derive(Clone, Copy)]
struct Rising;

impl<const N: usize> Law<N, 0> for Rising {
    const STATES: &'static [Variable] = &[state("level"), state("other")];

    fn slope<T: Real>(&self, x: &SVector<T, N>, _: &SVector<T, 0>) -> SVector<T, N> {
        x.map(|level| T::from_f64(1.0) - level.sqrt())
    }
}

/// The state after a second by each implicit method, at steps of 0.2 s and, where it estimates errors, to a tolerance, or what it tells.
fn ends<S, const N: usize, const P: usize>(
    system: &S,
    start: [f64; N],
) -> Vec<(&'static str, Result<SVector<f64, N>, Stopped>)>
where
    S: System<f64, N, 0, P>,
{
    fn run<S, const N: usize, const P: usize>(
        system: &S,
        start: [f64; N],
        solver: impl Integrator<N>,
    ) -> Result<SVector<f64, N>, Stopped>
    where
        S: System<f64, N, 0, P>,
    {
        let mut last = SVector::from(start);
        let run = solver.integrate(system, &(), 0.0, 1.0, last, |step| last = *step.state());
        run.map(|_| last)
    }
    macro_rules! each {
        ($($solver:expr),*) => {
            vec![$((stringify!($solver), run(system, start, $solver))),*]
        };
    }
    each!(
        Fixed::new(Ros2, 0.2),
        Fixed::new(Rodas4, 0.2),
        Fixed::new(Rodas5P, 0.2),
        Fixed::new(Radau5, 0.2),
        Fixed::new(Radau9, 0.2),
        Fixed::new(ImplicitMidpoint::default(), 0.2),
        Fixed::new(Ros2, 0.2).compensated(),
        Adaptive::new(Ros2, 1e-6, 1e-6),
        Adaptive::new(Rodas4, 1e-6, 1e-6),
        Adaptive::new(Rodas5P, 1e-6, 1e-6),
        Adaptive::new(Radau5, 1e-6, 1e-6),
        Adaptive::new(Radau9, 1e-6, 1e-6)
    )
}

/// What stays where a law has no slope gives no Jacobian at any time.
#[test]
fn a_jacobian_that_is_not_finite_is_told_as_such() {
    let model = Still::new(StillParameters::default()).unwrap();
    for (solver, end) in ends(&model, [0.0]) {
        assert_eq!(
            end.unwrap_err().to_string(),
            "stopped at t = 0: the Jacobian is not finite: the derivative of `b.p` by `b.p`",
            "{solver}"
        );
    }
    // By the names of row and column.
    for (solver, end) in ends(&Written(Resting), [0.0, 0.0]) {
        let (of, by) = ("pipe", "level");
        let cause = Cause::Trouble(Trouble::JacobianNotFinite { of, by });
        let stopped = end.unwrap_err();
        assert_eq!((stopped.time, stopped.cause), (0.0, cause), "{solver}");
    }
}

/// Where a law has no slope at the start alone, it is that of a little later, or of where a step ends.
#[test]
fn steps_go_on_where_a_jacobian_is_infinite() {
    fn check<const N: usize, const P: usize>(
        system: &impl System<f64, N, 0, P>,
        start: [f64; N],
        error: impl Fn(SVector<f64, N>) -> f64,
    ) {
        for (solver, end) in ends(system, start) {
            let most = match solver {
                _ if solver.starts_with("Adaptive") => 1e-5,
                _ if solver.contains("Ros2") || solver.contains("Midpoint") => 5e-3,
                _ => 5e-4,
            };
            let error = error(end.unwrap());
            assert!(error.abs() < most, "{solver}: {error:e}");
        }
    }
    // With the root s of a level: t = -2 s - 2 ln(1 - s); the speed is half the momentum.
    let time = |level: f64| -2.0 * level.sqrt() - 2.0 * f64::ln_1p(-level.sqrt());
    let model = Throttled::new(ThrottledParameters::default()).unwrap();
    check(&model, [0.0], |end| 2.0 * time(end[0] / 2.0) - 1.0);
    check(&Written(Rising), [0.0], |end| time(end[0]) - 1.0);
    check(&Written(Rising), [0.0, 0.5], |end| {
        let second = time(end[1]) - time(0.5) - 1.0;
        (time(end[0]) - 1.0).abs().max(second.abs())
    });
    // The level is the time, and the pipe p by its rate t^(3/2) - p.
    let pipe = (1..=2000).fold(0.0, |sum: f64, part| {
        let time = (f64::from(part) - 0.5) / 2000.0;
        sum + time * time.sqrt() * (time - 1.0).exp() / 2000.0
    });
    check(&Written(Filling), [0.0, 0.0], |end| {
        (end[0] - 1.0).abs().max((end[1] - pipe).abs())
    });
}

#[test]
fn methods_without_a_jacobian_go_on_where_it_is_not_finite() {
    fn end(solver: impl Integrator<1>) -> f64 {
        let model = Throttled::new(ThrottledParameters::default()).unwrap();
        let mut last = model.initial_state();
        let run = solver.integrate(&model, &(), 0.0, 1.0, last, |step| last = *step.state());
        run.unwrap();
        last[0]
    }
    let expected = end(Adaptive::new(Tsit5, 1e-10, 1e-10));
    assert!((end(Fixed::new(Gauss6::default(), 1e-2)) - expected).abs() < 1e-6);
    assert!((end(Auto::new(1e-6, 1e-6)) - expected).abs() < 1e-6);
}

/// Not the state that it makes so.
#[test]
fn an_input_that_is_no_number_is_told() {
    let model = Pushed::<f64>::new(PushedParameters::default()).unwrap();
    let start = model.initial_state();
    for value in [f64::NAN, f64::INFINITY] {
        let input = Constant(SVector::from([1.0, value]));
        let stops = [
            Fixed::new(Rk4, 0.1).integrate(&model, &input, 0.0, 1.0, start, |_| ()),
            Fixed::new(Gauss6::default(), 0.1).integrate(&model, &input, 0.0, 1.0, start, |_| ()),
            Adaptive::new(Tsit5, 1e-6, 1e-6).integrate(&model, &input, 0.0, 1.0, start, |_| ()),
            Adaptive::new(Radau5, 1e-6, 1e-6).integrate(&model, &input, 0.0, 1.0, start, |_| ()),
            Auto::new(1e-6, 1e-6).integrate(&model, &input, 0.0, 1.0, start, |_| ()),
        ];
        for stopped in stops.map(Result::unwrap_err) {
            assert_eq!(
                stopped.to_string(),
                "stopped at t = 0: input `pull` is not finite"
            );
        }
        let next = Rk4::step(&model, 0.0, &start, &input.0, 0.1, &mut ());
        let trouble = System::trouble(&model, 0.1, &next, &input.0, &());
        assert_eq!(trouble, Some(Trouble::InputNotFinite { input: "pull" }));
    }
}

/// Adaptive steps come up to that time, those of Rosenbrock's methods too, which look ahead for the rate of the input.
#[test]
fn an_input_that_becomes_no_number_is_told() {
    let model = Pushed::<f64>::new(PushedParameters::default()).unwrap();
    let start = model.initial_state();
    let told = |solver: &str, stopped: Stopped, within: f64| {
        let trouble = Trouble::InputNotFinite { input: "pull" };
        assert_eq!(stopped.cause, Cause::Trouble(trouble), "{solver}");
        let early = (stopped.time - 0.503).abs();
        assert!(early < within, "{solver}: {stopped}");
    };
    for no_number in [f64::NAN, f64::INFINITY] {
        let pull = |t: f64| if t < 0.503 { t.sin() } else { no_number };
        let input = Smooth(|t: f64| SVector::from([1.0, pull(t)]));
        macro_rules! fixed {
            ($($method:expr),*) => { $(
                let solver = Fixed::new($method, 1e-2);
                let run = solver.integrate(&model, &input, 0.0, 1.0, start, |_| ());
                told(stringify!($method), run.unwrap_err(), 1e-2);
            )* };
        }
        macro_rules! adaptive {
            ($($solver:expr),*) => { $(
                let run = $solver.integrate(&model, &input, 0.0, 1.0, start, |_| ());
                told(stringify!($solver), run.unwrap_err(), 1e-12);
            )* };
            (of $($method:ident),*) => { adaptive!($(Adaptive::new($method, 1e-6, 1e-6)),*) };
        }
        fixed!(
            Rk4,
            Tsit5,
            Dop853,
            Pirk8,
            Pirk16,
            Gauss6::default(),
            ImplicitMidpoint::default()
        );
        fixed!(Radau5, Radau9, Ros2, Rodas4, Rodas5P);
        adaptive!(of Tsit5, Dop853, Pirk8, Pirk16, Radau5, Radau9, Ros2, Rodas4, Rodas5P);
        adaptive!(Auto::new(1e-6, 1e-6));
    }
}

#[test]
fn a_derivative_that_is_not_finite_is_told_before_its_jacobian() {
    for (solver, end) in ends(&Written(Emptying), [-1.0, 0.0]) {
        let stopped = end.unwrap_err();
        assert_eq!(
            stopped.to_string(),
            "stopped at t = 0: state `pipe` or its derivative is not finite",
            "{solver}"
        );
    }
    // At 0.4 s the level is still above zero, at a stage of the step from there it is below. The stages of Rosenbrock's
    // methods share what is not finite; those of Radau's take their Jacobian there, in halves of the step up to 0.45 s.
    for (solver, end) in ends(&Written(Emptying), [0.45, 0.0]) {
        let stopped = end.unwrap_err();
        if solver.contains("Radau") && solver.starts_with("Fixed") {
            let cause = Cause::Trouble(Trouble::NotFinite { state: "pipe" });
            assert_eq!(stopped.cause, cause, "{solver}");
            assert!((stopped.time - 0.45).abs() < 1e-6, "{solver}: {stopped}");
        } else if solver.starts_with("Fixed") {
            assert!(
                matches!(stopped.cause, Cause::Trouble(Trouble::NotFinite { .. })),
                "{solver}"
            );
        }
    }
}

/// Methods of Radau take it at a stage ahead of where the step starts.
#[test]
fn a_jacobian_counts_where_the_method_takes_it() {
    let (of, by) = ("level", "level");
    for (solver, end) in ends(&Written(Drained), [0.5, 0.0]) {
        let stopped = end.unwrap_err();
        let cause = Cause::Trouble(Trouble::JacobianNotFinite { of, by });
        assert_eq!(stopped.cause, cause, "{solver}");
        assert!(stopped.time > 0.3, "{solver}: {stopped}");
    }
}

#[test]
fn what_auto_picks_tells_the_same() {
    let system = Written(Drained);
    let start = SVector::from([0.5, 0.0]);
    for (relative, picked) in [(1e-4, Picked::Rodas5P), (1e-6, Picked::Radau9)] {
        let auto = Auto::new(relative, 1e-6);
        let choice = auto.choose(&system, &(), 0.0, 1.0, start).unwrap();
        assert_eq!(choice.method, picked);
        let run = auto.integrate(&system, &(), 0.0, 1.0, start, |_| ());
        let stopped = run.unwrap_err();
        let (of, by) = ("level", "level");
        assert_eq!(
            stopped.cause,
            Cause::Trouble(Trouble::JacobianNotFinite { of, by })
        );
        assert!(stopped.time > 0.3 && stopped.time < 0.6, "{stopped}");
    }
}

/// No step ends near where the states fail, and what comes behind it would be 2 % to a quarter off.
#[test]
fn a_step_over_a_singular_set_is_told() {
    let model = Skate::<f64>::new(SkateParameters::default()).unwrap();
    for step in [1e-2, 1e-3] {
        let start = model.initial_state();
        let stopped = Fixed::new(Rk4, step)
            .integrate(&model, &(), 0.0, 4.0, start, |_| ())
            .unwrap_err();
        // It turns by half of 0.2 rad/s² t².
        let right_angle = std::f64::consts::PI.sqrt() * f64::sqrt(5.0);
        assert!((stopped.time - right_angle).abs() < 2.0 * step, "{stopped}");
        let Cause::Trouble(Trouble::SteppedOver { values, .. }) = stopped.cause else {
            panic!("{stopped}")
        };
        assert!(values[0] * values[1] < 0.0);
        assert!(
            stopped.to_string().contains("over its singular set"),
            "{stopped}"
        );
    }
}

/// By the slope at the start each sweep is 2e-9 long, of 0.1: what it leaves tells so, and a shorter step is asked for.
#[test]
fn sweeps_that_get_nowhere_find_no_stage() {
    let model = Blocked::new(BlockedParameters::default()).unwrap();
    let voltage = Constant(SVector::from([1.0]));
    for sweeps in [2, 3, 10] {
        let mut end = model.initial_state();
        let method = ImplicitMidpoint { sweeps };
        let run = Fixed::new(method, 0.1).integrate(&model, &voltage, 0.0, 1.0, end, |step| {
            end = *step.state();
        });
        assert!(run.unwrap().steps > 10, "{sweeps}");
        let error = end[0] - 1.0 - (1.0 - f64::exp(-1.0));
        assert!(error.abs() < 1e-2, "{sweeps}: {error}");
    }
}

/// The same with a Jacobian that is kept from step to step: of before the kink it makes changes small, and estimates.
#[test]
fn a_jacobian_of_before_a_kink_is_not_kept() {
    fn error(blocking: f64, solver: impl Integrator<1>) -> f64 {
        let model = Blocked::new(BlockedParameters { blocking }).unwrap();
        let voltage = Constant(SVector::from([1.0]));
        let mut end = model.initial_state();
        let run = solver.integrate(&model, &voltage, 0.0, 1.0, end, |step| end = *step.state());
        run.unwrap();
        (end[0] - 1.0 - (1.0 - f64::exp(-1.0))).abs()
    }
    for blocking in [1e6, 1e9, 1e12] {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let errors = [
                error(blocking, Adaptive::new(Radau5, tolerance, tolerance)),
                error(blocking, Adaptive::new(Radau9, tolerance, tolerance)),
                error(blocking, Auto::new(tolerance, tolerance)),
            ];
            // How far the current is blocked at the start is in the result, too.
            let most = 20.0 * tolerance + 1.0 / blocking;
            let small = errors.iter().all(|error| *error < most);
            assert!(small, "{blocking:e} at {tolerance:e}: {errors:?}");
        }
    }
}

/// Next to the bottom of a tank the slope of the root is of any size: it makes changes small, and estimates, with each new Jacobian.
#[test]
fn a_tank_fills_from_its_bottom_on() {
    fn error(solver: impl Integrator<2>) -> f64 {
        let model = Weir::new(WeirParameters::default()).unwrap();
        let mut end = model.initial_state();
        let run = solver.integrate(&model, &(), 0.0, 2.0, end, |step| end = *step.state());
        run.unwrap();
        (end[0] - 1.0).abs()
    }
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let absolute = 0.01 * tolerance;
        let errors = [
            error(Adaptive::new(Radau5, tolerance, absolute)),
            error(Adaptive::new(Radau9, tolerance, absolute)),
        ];
        // The time of the threshold is told to 1e-12.
        let most = tolerance + 1e-11;
        let small = errors.iter().all(|error| *error < most);
        assert!(small, "{tolerance:e}: {errors:?}");
    }
}
