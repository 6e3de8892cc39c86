//! The transistor amplifier of the Test Set for IVP Solvers (Mazzia and Magherini 2008): two transistors, five
//! capacitors, and a nonlinear algebraic loop around the base of each transistor.

use mbg_runtime::{DormandPrince, Smooth, Solver, System, mbg};
use nalgebra::SVector;

mbg! {
    /// A resistor between two nodes.
    component Resistor(port a, port b) {
        param resistance: ohm = 9000.0;
        1 wire { R resistor { resistance: resistance } }
        a -> wire;
        wire -> b;
    }

    /// A capacitor between two nodes.
    component Capacitor(port a, port b) {
        param compliance: F = 1e-6;
        param initial: C = 0.0;
        1 wire { C capacitor { compliance: compliance, initial: initial } }
        a -> wire;
        wire -> b;
    }

    /// The current `g` into the base goes out at the emitter; the share 0.99 of it comes from the collector.
    component Transistor(port base, port emitter, port collector) {
        1 diode { R law { flow: 1e-6 * (exp(e / 0.026) - 1.0) } }
        1 gain { Sf share { flow: 0.99 * diode.f } }
        base -> diode;
        diode -> emitter;
        collector -> gain;
        gain -> base;
    }

    /// Voltages of the eight nodes are the outputs.
    pub(crate) model Amplifier {
        input voltage: V;
        0 rail { Se supply { effort: 6.0 } }
        1 source {
            Se signal { effort: voltage }
            R r0 { resistance: 1000.0 }
            C c1 { compliance: 1e-6, initial: -3e-6 }
        }
        0 base1 { R r1 { resistance: 9000.0 } }
        0 emitter1 { R r3 { resistance: 9000.0 } C c2 { compliance: 2e-6, initial: 6e-6 } }
        0 collector1;
        0 base2 { R r5 { resistance: 9000.0 } }
        0 emitter2 { R r7 { resistance: 9000.0 } C c4 { compliance: 4e-6, initial: 12e-6 } }
        0 collector2;
        0 load { R r9 { resistance: 9000.0 } }
        source -> base1;
        r2: Resistor (rail, base1);
        r4: Resistor (rail, collector1);
        r6: Resistor (rail, base2);
        r8: Resistor (rail, collector2);
        c3: Capacitor { compliance: 3e-6, initial: 9e-6 } (collector1, base2);
        c5: Capacitor { compliance: 5e-6, initial: 30e-6 } (collector2, load);
        first: Transistor (base1, emitter1, collector1);
        second: Transistor (base2, emitter2, collector2);
        output y1: V = base1.e + c1.e;
        output y2: V = base1.e;
        output y3: V = emitter1.e;
        output y4: V = collector1.e;
        output y5: V = base2.e;
        output y6: V = emitter2.e;
        output y7: V = collector2.e;
        output y8: V = load.e;
    }
}

/// Voltages of the nodes at 0.2 s, published with 1e-13.
const REFERENCE: [f64; 8] = [
    -0.5562145012262709e-2,
    3.006522471903042,
    2.849958788608128,
    2.926422536206241,
    2.704617865010554,
    2.761837778393145,
    4.770927631616772,
    1.236995868091548,
];

#[test]
fn amplifier_meets_the_published_reference() {
    let solvers = Amplifier::<f64>::META
        .loops
        .iter()
        .map(|found| found.solver);
    let unknowns = solvers.map(|solver| match solver {
        Solver::Newton { unknowns, .. } => unknowns,
        Solver::Linear => 0,
    });
    assert!(
        unknowns.eq([1, 1, 0]),
        "one unknown per transistor, and the load"
    );
    let model = Amplifier::new(AmplifierParameters::default()).unwrap();
    let voltage = |t: f64| SVector::from([0.1 * f64::sin(200.0 * std::f64::consts::PI * t)]);
    let mut memory = Default::default();
    let start = model.output(0.0, &model.initial_state(), &voltage(0.0), &mut memory);
    let expected = [0.0, 3.0, 3.0, 6.0, 3.0, 3.0, 6.0, 0.0];
    assert!((start - SVector::from(expected)).amax() < 1e-14, "{start}");
    let mut last = model.initial_state();
    let pair = DormandPrince::new(1e-11, 1e-17);
    let input = Smooth(voltage);
    pair.sample(&model, &input, 0.0, last, &[0.2], |_, x| last = *x)
        .unwrap();
    let found = model.output(0.2, &last, &voltage(0.2), &mut memory);
    for (found, expected) in found.iter().zip(REFERENCE) {
        assert!(f64::abs(found - expected) < 5e-10, "{found} {expected}");
    }
}
