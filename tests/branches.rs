//! Nonlinear algebraic loops with several solutions: runs stay on their branch up to its fold, and so do outputs.

#![allow(unreachable_pub, clippy::unwrap_used)]

use mbg_runtime::{
    Adaptive, Auto, Dop853, Fixed, Gauss6, Integrator, Pirk8, Radau5, Radau9, Rodas5P, System,
    Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    /// A comparator without states of its own charges a capacitor until this reaches half of its output, then the other way.
    model Astable {
        0 out;
        0 minus;
        0 plus;
        0 ground { Se earth { effort: 0.0 } }
        Se comparator { effort: 10.0 * tanh(1000.0 * (plus.e - minus.e)) } -> out;
        feedback: Resistor { resistance: 1e4 } (out, minus);
        store: Capacitor { capacitance: 1e-7, initial: 0.1 } (minus, ground);
        above: Resistor { resistance: 1e4 } (out, plus);
        below: Resistor { resistance: 1e4 } (plus, ground);
        output switched: V = out.e;
    }

    /// A tunnel diode behind a resistor under a voltage that rises: its current falls from one branch to another.
    model Tunnel {
        0 node { R diode { flow: e * (e - 1.0) * (e - 1.0) * 4.0 + 0.1 * e } }
        1 wire { R series { resistance: 2.0 } Se drive { effort: 3.0 * t } }
        wire -> node;
        integral charge = wire.f;
        output passed = charge;
    }
}

/// Steps whose end has an output of the other sign than the charge moves before it and behind, without and with the memory
/// of the run, and the jumps.
fn wrong(solver: impl Integrator<1>) -> [u32; 3] {
    let model = Astable::<f64>::new(AstableParameters::default()).unwrap();
    let u = SVector::zeros();
    let [mut without, mut with, mut jumps] = [0; 3];
    let mut last: Option<[f64; 3]> = None;
    let start = model.initial_state();
    let run = solver.integrate(&model, &(), 0.0, 1e-2, start, |step| {
        let (t, x, before) = (step.end(), *step.state(), *step.first());
        if let Some([fresh, kept, rise]) = last {
            let rises = x[0] > before[0];
            if (rise > 0.0) == rises {
                without += u32::from((fresh > 0.0) != rises);
                with += u32::from((kept > 0.0) != rises);
            } else {
                jumps += 1;
            }
        }
        let close = step.at(t - 0.01 * (t - step.start()));
        let output = |mut memory| model.output(t, &x, &u, &mut memory)[0];
        last = Some([
            output(Default::default()),
            output(step.memory()),
            x[0] - close[0],
        ]);
    });
    run.unwrap();
    [without, with, jumps]
}

#[test]
fn outputs_from_the_memory_of_a_run_are_those_of_its_branch() {
    let found = [
        wrong(Adaptive::new(Dop853, 1e-10, 1e-18)),
        wrong(Adaptive::new(Tsit5, 1e-6, 1e-12)),
        wrong(Adaptive::new(Radau5, 1e-10, 1e-18)),
        wrong(Adaptive::new(Radau9, 1e-10, 1e-18)),
        wrong(Adaptive::new(Rodas5P, 1e-6, 1e-12)),
        wrong(Auto::new(1e-8, 1e-16)),
        wrong(Fixed::new(Gauss6::default(), 1e-6)),
    ];
    for [without, with, jumps] in found {
        assert!(without > 50, "{found:?}");
        assert_eq!(with, 0, "{found:?}");
        assert!(jumps <= 9, "{found:?}");
    }
}

#[test]
fn outputs_at_given_times_are_those_of_the_branch_of_the_run() {
    let model = Astable::<f64>::new(AstableParameters::default()).unwrap();
    let times: Vec<f64> = (0..=1000).map(|k| f64::from(k) * 1e-5).collect();
    let mut samples = Vec::new();
    let solver = Adaptive::new(Dop853, 1e-10, 1e-18);
    let start = model.initial_state();
    let run = solver.sample_outputs(&model, &(), 0.0, start, &times, |t, x, y| {
        samples.push((t, x[0], y[0]));
    });
    run.unwrap();
    assert_eq!(samples.len(), times.len());
    for triple in samples.windows(3) {
        let [(_, before, _), (t, at, output), (_, behind, _)] = triple else {
            unreachable!("windows of three");
        };
        if (at > before) == (behind > at) {
            assert_eq!(*output > 0.0, at > before, "at {t}");
        }
    }
}

/// By quadrature of the current over the voltages of both branches.
const CHARGE: f64 = 1.008_108_852_606_5;

fn missed(solver: impl Integrator<1>) -> f64 {
    let model = Tunnel::<f64>::new(TunnelParameters::default()).unwrap();
    let mut charge = model.initial_state();
    let run = solver.integrate(&model, &(), 0.0, 1.5, charge, |step| charge = *step.state());
    run.unwrap();
    (charge[0] - CHARGE).abs()
}

#[test]
fn stages_before_a_fold_are_on_the_near_branch() {
    let errors = [
        missed(Adaptive::new(Radau5, 1e-7, 1e-7)),
        missed(Adaptive::new(Radau9, 1e-7, 1e-7)),
        missed(Adaptive::new(Rodas5P, 1e-7, 1e-7)),
        missed(Adaptive::new(Dop853, 1e-7, 1e-7)),
        missed(Adaptive::new(Pirk8, 1e-7, 1e-7)),
        1e-2 * missed(Fixed::new(Gauss6::default(), 1e-3)),
    ];
    assert!(errors.iter().all(|error| *error < 5e-7), "{errors:?}");
}
