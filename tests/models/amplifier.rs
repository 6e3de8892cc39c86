//! The transistor amplifier as a bond graph: two transistors, five capacitors, and a nonlinear algebraic loop around
//! the base of each transistor, against the published reference.

use mbg_runtime::{Adaptive, Dop853, Integrator, Smooth, Solver, System, mbg};
use nalgebra::SVector;

use crate::references::errors::apart;
use crate::references::transistor_amplifier as reference;

mbg! {
    include "examples/gallery/amplifier.mbg";
}

#[test]
fn amplifier_meets_the_published_reference() {
    let solvers = Amplifier::<f64>::META
        .loops
        .iter()
        .map(|found| found.solver);
    let unknowns = solvers.map(|solver| match solver {
        Solver::Newton { unknowns, .. } => unknowns,
        _ => 0,
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
        apart(start.as_slice(), &reference::START) < 1e-14,
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
        let error = apart(found.as_slice(), &expected);
        assert!(error < 1.5e-8, "{time}: {error:e}");
    }
    let error = apart(found[6].as_slice(), &reference::PUBLISHED);
    assert!(error < 5e-10, "{error:e}");
}
