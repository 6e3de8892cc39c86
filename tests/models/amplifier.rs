//! The transistor amplifier as a bond graph: two transistors, five capacitors, and a nonlinear algebraic loop around
//! the base of each transistor, against the published reference.

use mbg_runtime::{Adaptive, Dop853, Integrator, Smooth, Solver, System, mbg};
use nalgebra::SVector;

use crate::references::transistor_amplifier as reference;

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
    let voltage = |t: f64| SVector::from([reference::input(t)]);
    let mut memory = Default::default();
    let mut nodes = |t: f64, x: &SVector<f64, 5>| model.output(t, x, &voltage(t), &mut memory);
    let start = nodes(0.0, &model.initial_state());
    assert!(
        (start - SVector::from(reference::START)).amax() < 1e-14,
        "{start}"
    );
    let times = reference::REFERENCE.map(|(time, _)| time);
    let mut found = Vec::new();
    let solver = Adaptive::new(Dop853, 1e-11, 1e-17);
    let x = model.initial_state();
    solver
        .sample(&model, &Smooth(voltage), 0.0, x, &times, |t, x| {
            found.push(nodes(t, x))
        })
        .unwrap();
    for (found, (time, expected)) in found.iter().zip(reference::REFERENCE) {
        let error = (found - SVector::from(expected)).amax();
        assert!(error < 1.5e-8, "{time}: {error:e}");
    }
    let error = (found[6] - SVector::from(reference::PUBLISHED)).amax();
    assert!(error < 5e-10, "{error:e}");
}
