//! Steps of constant length across kinks of stiff laws.

use mbg_runtime::{
    Adaptive, Fixed, ImplicitMidpoint, Integrator, Method, Radau5, Radau9, Rodas4, Rodas5P, Ros2,
    System, mbg,
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

/// The least and the largest current, and the one at the end, from a time on; and how many steps there are.
fn currents<S, const N: usize>(
    model: &S,
    solver: &impl Integrator<N>,
    (from, to): (f64, f64),
) -> ([f64; 3], u64)
where
    S: System<f64, N, 0, 1>,
{
    let mut memory = S::Memory::default();
    let mut found = [f64::INFINITY, f64::NEG_INFINITY, 0.0];
    let statistics = solver
        .integrate(model, &(), 0.0, to, model.initial_state(), |step| {
            if step.end() >= from {
                let none = nalgebra::SVector::zeros();
                let current = model.output(step.end(), step.state(), &none, &mut memory)[0];
                found = [found[0].min(current), found[1].max(current), current];
            }
        })
        .unwrap();
    (found, statistics.steps)
}

/// The current comes to -20 V / 10 kΩ, on the way and at the end within so much of it.
fn assert_blocked(name: &str, solver: &impl Integrator<1>, within: f64) {
    let model = Blocking::<f64>::new(BlockingParameters::default()).unwrap();
    let ([least, largest, last], _) = currents(&model, solver, (0.0, 2e-6));
    println!("{name:<18}from {least:.2e} to {largest:.3} A, {last:.6} A at the end");
    assert!(least > -2e-3 - within && largest < 0.5, "{name}: {least}");
    assert!((last + 2e-3).abs() < within, "{name}: {last}");
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
    let ([_, peak, _], _) = currents(&model, &adaptive, period);
    assert!((peak - 32.35).abs() < 0.02, "{peak}");
    for step in [50e-6, 20e-6, 5e-6] {
        println!("steps of {step:e} s");
        let assert_rectified = |name: &str,
                                ([least, largest, _], steps): ([f64; 3], u64),
                                overshoot: f64,
                                most: f64| {
            let steps = steps as f64 * step / period.1;
            println!("{name:<18}from {least:.4} to {largest:.4} A, {steps:.2} of the steps");
            assert!((largest - peak).abs() < 0.03, "{name}: {largest}");
            assert!(least > -overshoot, "{name}: {least}");
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
