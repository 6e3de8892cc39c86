//! Nonlinear loops of any size, interpreted: ladders of diodes against their own equations, and the exact Jacobian
//! against differences.

use mbg_compiler::compile::{Compiled, Routines, compile};
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::program::{Arguments, evaluate};
use mbg_compiler::syntax::ast::Item;
use mbg_compiler::{elaborate, syntax};

/// A source of 3 V, `rungs` resistors of 10 Ω in a row, a diode to ground behind each, and a coil with a load of 5 Ω
/// at the end.
fn ladder(rungs: usize) -> String {
    let mut body = String::from("0 n0 { Se supply { effort: 3.0 } }");
    for k in 1..=rungs {
        let before = k - 1;
        body += &format!(
            "1 w{k} {{ R r{k} {{ resistance: 10.0 }} }}
             0 n{k} {{ R d{k} {{ flow: 1e-4 * (exp(e / 0.026) - 1.0) }} }}
             n{before} -> w{k}; w{k} -> n{k};"
        );
    }
    format!(
        "model Ladder {{ {body}
             1 choke {{ I coil {{ inertia: 0.01 }} R load {{ resistance: 5.0 }} }} n{rungs} -> choke; }}"
    )
}

fn compiled(text: &str) -> Compiled {
    let mut diagnostics = Diagnostics::new();
    let source = syntax::parse(text.parse().expect("tokens"), &mut diagnostics);
    let components = elaborate::component_table(&source);
    let Some(Item::Model(model)) = source.items.last() else {
        panic!("a model stands last")
    };
    let compiled = compile(model, &components, &mut diagnostics);
    compiled.unwrap_or_else(|| panic!("{:?}", diagnostics.list()))
}

fn run(compiled: &Compiled, routine: usize, momentum: f64) -> f64 {
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &[momentum],
        input: &[],
    };
    let results = evaluate(&compiled.program, routine, &arguments);
    // A Jacobian follows the derivative.
    results[results.len() - 1]
}

/// Voltage of the source that has this voltage at the last node while this current flows on.
fn voltage_before(rungs: usize, last: f64, current: f64) -> f64 {
    let (mut voltage, mut current) = (last, current);
    for _ in 0..rungs {
        current += 1e-4 * (f64::exp(voltage / 0.026) - 1.0);
        voltage += 10.0 * current;
    }
    voltage
}

#[test]
fn ladders_of_any_length_fulfil_their_equations() {
    for rungs in 1..=6 {
        let compiled = compiled(&ladder(rungs));
        assert!(compiled.iterations().eq([rungs]), "one unknown per diode");
        for momentum in [-2e-3, -1e-4, 0.0, 3e-4, 1e-3] {
            let current = momentum / 0.01;
            let rate = run(&compiled, Routines::DERIVATIVE, momentum);
            let supply = voltage_before(rungs, rate + 5.0 * current, current);
            assert!((supply - 3.0).abs() < 1e-9, "{rungs}: {supply}");
            let step = 1e-7;
            let [upper, lower] =
                [step, -step].map(|step| run(&compiled, Routines::DERIVATIVE, momentum + step));
            let difference = (upper - lower) / (2.0 * step);
            let exact = run(&compiled, Routines::DERIVATIVE_AND_JACOBIAN, momentum);
            let error = (difference - exact).abs() / exact.abs();
            assert!(error < 1e-6, "{rungs}: {exact} {difference}");
        }
    }
}
