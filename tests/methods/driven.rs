//! Laws that jump where an input goes through a threshold, alone or beside the time.

use mbg_runtime::{
    Adaptive, Auto, Constant, Dop853, Dual, Fixed, Gauss6, Input, Integrator, Pulse, Radau9, Real,
    Rk4, Smooth, System, Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    /// What an input switches.
    model Switched {
        param level = 0.5;
        param gain = 1.0;
        input way;
        integral above = if way > level { 3.0 } else { 0.0 };
        integral side = sign(way - level);
        integral counted = floor(3.0 * way * gain);
        integral wave = if sin(7.0 * way) > 0.2 { 1.0 } else { 0.0 };
        output all = above + side + counted + wave;
    }

    /// What an input switches beside the time.
    model Beside {
        input way;
        integral late = if t > way { 3.0 } else { 0.0 };
        integral left = mod(t + way, 1.0);
        integral counted = floor(t * (1.0 + way));
        integral early = if mod(t, 1.0 + 0.3 * way) < 0.2 { 1.0 } else { 0.0 };
        integral wave = if sin(3.0 * t + way) > 0.2 { 1.0 } else { 0.0 };
        output all = late + left + counted + early + wave;
    }
}

mbg! {
    /// A mass that is pushed, and drags.
    model Pushed {
        input push;
        1 way { I mass { inertia: 2.0 } R drag { resistance: 1.0 } Se force { effort: push } }
        output speed = way.f;
    }
}

/// What is left at 3 s by all kinds of methods.
fn by_all<T: Real, const N: usize>(
    model: &impl System<T, N, 1, 1>,
    input: &impl Input<T, 1>,
    mut each: impl FnMut(SVector<T, N>, &str),
) {
    macro_rules! by {
        ($($solver:expr),*) => { $({
            let mut last = model.initial_state();
            let (begin, end) = (T::from_f64(0.0), T::from_f64(3.0));
            $solver
                .integrate(model, input, begin, end, last, |step| last = *step.state())
                .unwrap();
            each(last, stringify!($solver));
        })* };
    }
    by!(
        Fixed::new(Rk4, 0.03),
        Fixed::new(Gauss6::default(), 0.03),
        Adaptive::new(Tsit5, 1e-9, 1e-9),
        Adaptive::new(Dop853, 1e-9, 1e-9),
        Adaptive::new(Radau9, 1e-9, 1e-9),
        Auto::new(1e-9, 1e-9)
    );
}

/// For how much of 3 s something is above zero.
fn lasting(value: impl Fn(f64) -> f64) -> f64 {
    const PARTS: i32 = 30_000;
    let at = |place: i32| 3.0 * f64::from(place) / f64::from(PARTS);
    let part = |place: i32| {
        let (start, end) = (at(place), at(place + 1));
        let is_above = value(start) > 0.0;
        let (mut low, mut high) = (start, end);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (value(middle) > 0.0) == is_above {
                low = middle;
            } else {
                high = middle;
            }
        }
        if is_above { low - start } else { end - low }
    };
    (0..PARTS).map(part).sum()
}

/// What is below a value, of whole numbers above zero, summed up over 3 s.
fn counted(value: impl Fn(f64) -> f64) -> f64 {
    let numbers = (1..12).map(f64::from);
    numbers.map(|number| lasting(|t| value(t) - number)).sum()
}

#[test]
fn what_an_input_alone_switches_is_met() {
    let model = Switched::<f64>::new(SwitchedParameters::default()).unwrap();
    let line: fn(f64) -> f64 = |t| 0.4 * t;
    let wave: fn(f64) -> f64 = |t| 1.0 + f64::sin(4.0 * t);
    for (way, name) in [(line, "a line"), (wave, "a wave")] {
        let above = lasting(|t| way(t) - 0.5);
        let wave = lasting(|t| f64::sin(7.0 * way(t)) - 0.2);
        let expected = [
            3.0 * above,
            2.0 * above - 3.0,
            counted(|t| 3.0 * way(t)),
            wave,
        ];
        let input = Smooth(|t| SVector::from([way(t)]));
        by_all(&model, &input, |found, solver| {
            let error = (found - SVector::from(expected)).amax();
            assert!(error < 1e-7, "{name} {solver}: {error:e}");
        });
    }
}

/// By the level, and by how fast the input rises.
#[test]
fn times_at_which_an_input_switches_have_their_slopes() {
    let close = |found: Dual<f64>, slope: f64, solver: &str| {
        let error = found.slope - slope;
        assert!(error.abs() < 1e-6, "{solver}: {error:e} of {slope}");
    };
    let model = Switched::new(SwitchedParameters {
        level: Dual::variable(0.5),
        ..Default::default()
    });
    let rising = Smooth(|t: Dual<f64>| SVector::from([Dual::constant(0.4) * t]));
    by_all(&model.unwrap(), &rising, |found, solver| {
        close(found[0], -3.0 / 0.4, solver);
        close(found[1], -2.0 / 0.4, solver);
    });
    let model = Switched::<Dual<f64>>::new(SwitchedParameters::default()).unwrap();
    let rising = Smooth(|t: Dual<f64>| SVector::from([Dual::variable(0.4) * t]));
    by_all(&model, &rising, |found, solver| {
        close(found[0], 3.0 * 0.5 / 0.16, solver);
        // One, two and three thirds are passed, each at its third by the rate.
        close(found[2], 2.0 / 0.16, solver);
    });
}

/// The slopes of what is pushed, in runs from a time by methods of all kinds.
fn assert_slopes<const K: usize>(
    push: &impl Input<Dual<f64>, 1>,
    begin: Dual<f64>,
    times: [f64; K],
    expected: [f64; K],
) {
    let model = Pushed::<Dual<f64>>::new(PushedParameters::default()).unwrap();
    let times = times.map(Dual::constant);
    macro_rules! by {
        ($($solver:expr),*) => { $({
            let (mut slopes, start) = (Vec::new(), model.initial_state());
            $solver
                .sample(&model, push, begin, start, &times, |_, x| slopes.push(x[0].slope))
                .unwrap();
            assert_eq!(slopes.len(), K);
            for (slope, expected) in slopes.iter().zip(expected) {
                let error = slope - expected;
                assert!(error.abs() < 1e-7, "{}: {error:e}", stringify!($solver));
            }
        })* };
    }
    by!(
        Fixed::new(Rk4, 0.01),
        Fixed::new(Gauss6::default(), 0.01),
        Adaptive::new(Tsit5, 1e-9, 1e-9),
        Adaptive::new(Dop853, 1e-9, 1e-9),
        Adaptive::new(Radau9, 1e-9, 1e-9),
        Auto::new(1e-9, 1e-9)
    );
}

/// Steps of a grid that ends at a jump move with it, and times at which they end do not.
#[test]
fn what_comes_before_a_jump_has_no_slope_of_its_time() {
    let push = Pulse {
        amplitude: SVector::from([Dual::constant(3.0)]),
        start: Dual::constant(0.0),
        end: Dual::variable(1.0),
    };
    // Behind it the force of 3 N lasts as much longer.
    let expected = [0.0, 0.0, 3.0 * f64::exp(-0.25)];
    assert_slopes(&push, Dual::constant(0.0), [0.5, 1.0, 1.5], expected);
}

/// At the time at which a run starts that begins later there is less than there was at its start.
#[test]
fn samples_at_a_start_that_moves_have_its_slope() {
    let push = Constant(SVector::from([Dual::constant(3.0)]));
    let expected = [0.0, 0.0, 0.5].map(|t: f64| -3.0 * f64::exp(-0.5 * t));
    assert_slopes(&push, Dual::variable(0.0), [0.0, 0.0, 0.5], expected);
}

#[test]
fn what_an_input_switches_beside_the_time_is_met() {
    let model = Beside::<f64>::new(BesideParameters::default()).unwrap();
    let way = |t: f64| 0.5 + 0.4 * f64::sin(4.0 * t);
    let sum = 4.5 + 1.5 + 0.1 * (1.0 - f64::cos(12.0));
    let expected = [
        3.0 * lasting(|t| t - way(t)),
        sum - counted(|t| t + way(t)),
        counted(|t| t * (1.0 + way(t))),
        lasting(|t| 0.2 - t.rem_euclid(1.0 + 0.3 * way(t))),
        lasting(|t| f64::sin(3.0 * t + way(t)) - 0.2),
    ];
    let input = Smooth(|t| SVector::from([way(t)]));
    by_all(&model, &input, |found, solver| {
        let error = (found - SVector::from(expected)).amax();
        assert!(error < 1e-7, "{solver}: {error:e}");
    });
}

/// What the input goes through three times at once.
#[test]
fn several_times_at_which_an_input_switches_are_met() {
    let model = Beside::<f64>::new(BesideParameters::default()).unwrap();
    let way = |t: f64| 0.5 + 0.4 * f64::sin(12.0 * t);
    let expected = 3.0 * lasting(|t| t - way(t));
    let input = Smooth(|t| SVector::from([way(t)]));
    by_all(&model, &input, |found, solver| {
        let error = found[0] - expected;
        assert!(error.abs() < 1e-7, "{solver}: {error:e}");
    });
}
