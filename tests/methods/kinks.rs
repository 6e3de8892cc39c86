//! Steps of constant length across kinks of stiff laws.

use mbg_runtime::{
    Adaptive, Dop853, Dual, Fixed, Gauss6, ImplicitMidpoint, Integrator, Method, Pirk8, Radau5,
    Radau9, Rk4, Rodas4, Rodas5P, Ros2, Statistics, System, Tsit5, mbg,
};

mbg! {
    /// A coil whose current falls to zero, where it is blocked: there its rate falls by 1 GHz, and 0.1 MHz before.
    model Blocking {
        1 a {
            I coil { inertia: 1e-5, initial_flow: 0.5 }
            Se supply { effort: -20.0 }
            R valve { effort: if f > 0.0 { 0.01 * f } else { 1e4 * f } }
        }
        output current = a.f;
    }

    /// A half wave: coil, diode and load, and a resistor beside them.
    model HalfWave {
        causality componentwise;
        0 ground; 0 source; 0 anode; 0 cathode;
        Se earth { effort: 0.0 } -> ground;
        Se supply { effort: 325.0 * sin(314.0 * t) } -> source;
        coil: Inductor { inductance: 2e-3 } (source, anode);
        snubber: Resistor { resistance: 1e6 } (anode, ground);
        diode: Diode {} (anode, cathode);
        load: Resistor { resistance: 10.0 } (cathode, ground);
        output current: A = coil.current;
    }
}

mbg! {
    /// A block on a belt, held by a spring: it sticks, and slips when the spring is strong enough.
    model Slipping {
        1 block {
            I mass { inertia: 1.0 }
            C spring { stiffness: 100.0 }
        }
        1 slip { R friction { effort: (8.0 + 4.0 * exp(-abs(f) / 0.05)) * tanh(f / 1e-5) } }
        0 contact;
        block -> contact -> slip;
        Sf belt { flow: -0.1 } -> contact;
    }

    /// The same with friction that has no kink.
    model Gliding {
        1 block {
            I mass { inertia: 1.0 }
            C spring { stiffness: 100.0 }
        }
        1 slip { R friction { effort: (8.0 + 4.0 * exp(-f * f / 0.0025)) * tanh(f / 1e-5) } }
        0 contact;
        block -> contact -> slip;
        Sf belt { flow: -0.1 } -> contact;
    }
}

mbg! {
    /// A ball on a spring swings against a wall that gives way.
    model Wall {
        param gap = 0.4;
        param stiffness = 1000.0;
        param speed = 3.0;
        1 way {
            I ball { inertia: 1.0, initial: speed }
            C wall { effort: 5.0 * q + if q > gap { stiffness * (q - gap) } else { 0.0 } }
        }
    }
}

/// Currents of a run.
struct Found {
    /// At the ends of steps.
    least: f64,
    largest: f64,
    last: f64,
    /// The least in the middle of steps.
    between: f64,
    steps: u64,
}

/// Of a run from a time on.
fn currents<S, const N: usize>(
    model: &S,
    solver: &impl Integrator<N>,
    (from, to): (f64, f64),
) -> Found
where
    S: System<f64, N, 0, 1>,
{
    let mut memory = S::Memory::default();
    let mut current = |t: f64, x| {
        let none = nalgebra::SVector::zeros();
        model.output(t, &x, &none, &mut memory)[0]
    };
    let mut found = Found {
        least: f64::INFINITY,
        largest: f64::NEG_INFINITY,
        last: 0.0,
        between: f64::INFINITY,
        steps: 0,
    };
    let statistics = solver
        .integrate(model, &(), 0.0, to, model.initial_state(), |step| {
            if step.end() < from {
                return;
            }
            let middle = (step.start() + step.end()) / 2.0;
            found.between = found.between.min(current(middle, step.at(middle)));
            found.last = current(step.end(), *step.state());
            found.least = found.least.min(found.last);
            found.largest = found.largest.max(found.last);
        })
        .unwrap();
    found.steps = statistics.steps;
    found
}

/// The current comes to -20 V / 10 kΩ, on the way and at the end within so much of it.
fn assert_blocked(name: &str, solver: &impl Integrator<1>, within: f64) {
    let model = Blocking::<f64>::new(BlockingParameters::default()).unwrap();
    let found = currents(&model, solver, (0.0, 2e-6));
    let (least, last) = (found.least, found.last);
    println!(
        "{name:<18}from {least:.2e} to {:.3} A, {last:.6} A at the end",
        found.largest
    );
    assert!(
        least > -2e-3 - within && found.largest < 0.5,
        "{name}: {least}"
    );
    assert!((last + 2e-3).abs() < within, "{name}: {last}");
    assert!(found.between > -0.05, "{name}: {}", found.between);
}

#[test]
fn a_coil_is_blocked_at_any_length_of_step() {
    // The longest steps are a hundred times as long as the blocked current takes to settle.
    for step in [0.101e-6, 0.0307e-6, 0.0071e-6] {
        println!("steps of {step:e} s");
        assert_blocked(Radau5::NAME, &Fixed::new(Radau5, step), 1e-4);
        assert_blocked(Radau9::NAME, &Fixed::new(Radau9, step), 1e-4);
        // The others are as exact beside the kink as a few hundredths of what the current has been.
        assert_blocked(Ros2::NAME, &Fixed::new(Ros2, step), 0.02);
        assert_blocked(Rodas4::NAME, &Fixed::new(Rodas4, step), 0.02);
        assert_blocked(Rodas5P::NAME, &Fixed::new(Rodas5P, step), 0.02);
        let midpoint = Fixed::new(ImplicitMidpoint::default(), step);
        assert_blocked(ImplicitMidpoint::NAME, &midpoint, 0.02);
    }
}

#[test]
fn a_diode_beside_a_coil_blocks_at_fixed_steps() {
    let model = HalfWave::<f64>::new(HalfWaveParameters::default()).unwrap();
    let period = (0.02, 0.0395);
    let adaptive = Adaptive::new(Rodas5P, 1e-8, 1e-10);
    let peak = currents(&model, &adaptive, period).largest;
    assert!((peak - 32.35).abs() < 0.02, "{peak}");
    for step in [50e-6, 20e-6, 5e-6] {
        println!("steps of {step:e} s");
        let assert_rectified = |name: &str, found: Found, overshoot: f64, most: f64| {
            let Found { least, largest, .. } = found;
            let steps = found.steps as f64 * step / period.1;
            println!("{name:<18}from {least:.4} to {largest:.4} A, {steps:.2} of the steps");
            assert!((largest - peak).abs() < 0.03, "{name}: {largest}");
            assert!(least > -overshoot, "{name}: {least}");
            assert!(found.between > -0.1 * peak, "{name}: {}", found.between);
            assert!(steps < most, "{name}: {steps}");
        };
        let radau5 = currents(&model, &Fixed::new(Radau5, step), period);
        assert_rectified(Radau5::NAME, radau5, 4e-4, 1.1);
        let radau9 = currents(&model, &Fixed::new(Radau9, step), period);
        assert_rectified(Radau9::NAME, radau9, 4e-4, 1.1);
        let ros2 = currents(&model, &Fixed::new(Ros2, step), period);
        assert_rectified(Ros2::NAME, ros2, 4e-4, 1.1);
        let rodas4 = currents(&model, &Fixed::new(Rodas4, step), period);
        assert_rectified(Rodas4::NAME, rodas4, 4e-4, 1.1);
        let rodas5p = currents(&model, &Fixed::new(Rodas5P, step), period);
        assert_rectified(Rodas5P::NAME, rodas5p, 4e-4, 1.1);
        // The rule does not damp: it overshoots by less than a tenth of what the current has been.
        let midpoint = Fixed::new(ImplicitMidpoint::default(), step);
        let midpoint = currents(&model, &midpoint, period);
        assert_rectified(ImplicitMidpoint::NAME, midpoint, 0.1 * peak, 2.0);
    }
}

/// The compression of the spring after each hundredth of a second.
fn compressions(
    model: &impl System<f64, 2, 0, 0>,
    solver: &impl Integrator<2>,
) -> (Vec<f64>, Statistics) {
    let times: Vec<f64> = (1..=400).map(|k| 0.01 * f64::from(k)).collect();
    let mut found = Vec::new();
    let statistics = solver
        .sample(model, &(), 0.0, model.initial_state(), &times, |_, x| {
            found.push(x[1]);
        })
        .unwrap();
    (found, statistics)
}

/// While the block sticks its friction is a damper of 1.2 MN s/m, and slips begin and end within microseconds.
#[test]
fn sticking_and_slipping_is_followed_at_fixed_steps_of_radau() {
    fn largest(sizes: impl Iterator<Item = f64>) -> f64 {
        sizes.fold(0.0, |largest, size| largest.max(size.abs()))
    }
    fn errors(
        model: &impl System<f64, 2, 0, 0>,
    ) -> impl Fn(&str, f64, (Vec<f64>, Statistics)) -> f64 {
        let (expected, _) = compressions(model, &Adaptive::new(Radau9, 1e-11, 1e-13));
        move |name, step, (found, statistics)| {
            let differences = found.iter().zip(&expected).map(|(a, b)| a - b);
            let error = largest(differences) / largest(expected.iter().copied());
            println!("{name:<17} at {step:e} s: {error:.1e}, {statistics:?}");
            error
        }
    }
    let model = Slipping::<f64>::new(SlippingParameters::default()).unwrap();
    let error = errors(&model);
    for step in [1e-3, 1e-4] {
        let radau5 = compressions(&model, &Fixed::new(Radau5, step));
        let radau9 = compressions(&model, &Fixed::new(Radau9, step));
        for (name, found) in [(Radau5::NAME, radau5), (Radau9::NAME, radau9)] {
            let statistics = found.1;
            let error = error(name, step, found);
            assert!(error < 1e-6, "{name} at {step:e} s: {error:e}");
            assert!(statistics.jacobians < statistics.steps / 5, "{name}");
        }
    }
    let midpoint = Fixed::new(ImplicitMidpoint::default(), 1e-3);
    let midpoint = compressions(&model, &midpoint);
    assert!(error(ImplicitMidpoint::NAME, 1e-3, midpoint) < 1e-2);
    // Steps come to where the law has its kink.
    let rodas5p = Fixed::new(Rodas5P, 1e-3);
    assert!(error(Rodas5P::NAME, 1e-3, compressions(&model, &rodas5p)) < 1e-4);
    // As the documentation of fixed steps says.
    let model = Gliding::<f64>::new(GlidingParameters::default()).unwrap();
    let error = errors(&model);
    let radau5 = compressions(&model, &Fixed::new(Radau5, 1e-3));
    assert!(error(Radau5::NAME, 1e-3, radau5) < 1e-6);
    assert!(error(Rodas5P::NAME, 1e-3, compressions(&model, &rodas5p)) > 0.1);
}

/// Steps by which stages run away meet thresholds that are not there, at last one that would be behind the end: there is no way left to
/// look for it on.
#[test]
fn runs_end_whose_steps_are_far_too_long_for_the_law_behind_a_kink() {
    let model = Slipping::<f64>::new(SlippingParameters::default()).unwrap();
    let mut last = 0.0;
    Fixed::new(Rk4, 1e-2)
        .integrate(&model, &(), 0.0, 2.0, model.initial_state(), |step| {
            last = step.end();
        })
        .unwrap();
    assert!(last == 2.0, "{last}");
}

/// Where rounding is a tenth of what a step across a kink is to be found to.
#[test]
fn a_diode_blocks_in_single_precision() {
    let model = HalfWave::<f32>::new(HalfWaveParameters::default()).unwrap();
    let (inductance, step, end) = (2e-3, 20e-6, 0.0395);
    let mut least = 0.0_f32;
    let statistics = Fixed::new(Ros2, step)
        .integrate(&model, &(), 0.0, end, model.initial_state(), |step| {
            least = least.min(step.state()[0] / inductance);
        })
        .unwrap();
    assert!(least > -4e-4, "{least}");
    let whole = f64::from(end) / step;
    assert!((statistics.steps as f64) < 1.1 * whole, "{statistics:?}");
}

/// Along one direction at a time, beside steps that follow the error, whose slopes do not depend on where they end. The spring has a
/// force where the wall begins: beside none at all any force would count as a jump.
#[test]
fn slopes_over_a_kink_are_as_exact_as_the_method() {
    fn end(solver: &impl Integrator<2>, along: usize) -> [Dual<f64>; 2] {
        let [gap, stiffness, speed] =
            [(0, 0.4), (1, 1000.0), (2, 3.0)].map(|(number, value)| Dual {
                value,
                slope: f64::from(u8::from(number == along)),
            });
        let parameters = WallParameters {
            gap,
            stiffness,
            speed,
        };
        let model = Wall::<Dual<f64>>::new(parameters).unwrap();
        let mut last = model.initial_state();
        solver
            .integrate(
                &model,
                &(),
                Dual::constant(0.0),
                Dual::constant(1.0),
                last,
                |step| {
                    last = *step.state();
                },
            )
            .unwrap();
        last.into()
    }
    fn check<M: Method>(method: M, step: f64, within: f64) {
        let solver = Fixed::new(method, step);
        for along in 0..3 {
            let exact = end(&Adaptive::new(Dop853, 1e-13, 1e-13), along);
            for (found, exact) in end(&solver, along).iter().zip(exact) {
                let error = (found.slope - exact.slope).abs();
                assert!(error < within, "{}, {along}: {error:e}", M::NAME);
            }
        }
    }
    check(Rk4, 1e-3, 1e-5);
    check(Tsit5, 1e-3, 1e-7);
    check(Pirk8, 1e-3, 1e-7);
    check(Gauss6::default(), 1e-3, 1e-7);
    check(Radau5, 1e-3, 1e-7);
    check(Rodas5P, 1e-3, 1e-7);
    check(ImplicitMidpoint::default(), 1e-4, 1e-4);
}
