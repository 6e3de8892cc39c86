//! Energies of storages whose law is given as effort or flow.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::compile::Routines;
use mbg_compiler::explain::explain;
use mbg_compiler::inclusion::no_file;
use mbg_compiler::program::{self, Arguments};
use models::{compiled, mistake};

/// A stiffness that changes with the displacement it multiplies is a law `k(q) q`, whose energy is its integral.
#[test]
fn coefficients_may_change_with_the_state_they_multiply() {
    let energy = |storage: &str, state: f64| {
        let text = format!("model M {{ 1 v {{ {storage} R r {{ resistance: 1.0 }} }} }}");
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &[state],
            input: &[],
        };
        program::evaluate(&compiled(&text).program, Routines::ENERGY, &arguments)[0]
    };
    let cases = [
        // ½ · 50 q² + ¼ · 400 q⁴
        ("C c { stiffness: 50.0 + 400.0 * q * q }", 3.06),
        // ∫ p / (2 + p) dp = p − 2 ln(1 + p / 2)
        ("I m { inertia: 2.0 + p }", 0.3 - 2.0 * 1.15_f64.ln()),
        // ∫ q √(1 + q) dq, with s = √(1 + q): 2 (s⁵ / 5 − s³ / 3)
        (
            "C c { compliance: 1.0 / sqrt(1.0 + q) }",
            2.0 * (1.3_f64.powf(2.5) / 5.0 - 1.3_f64.powf(1.5) / 3.0 + 2.0 / 15.0),
        ),
        // A contact of Hertz: ⅖ · 3 q^(5/2)
        (
            "C c { effort: 3.0 * pow(max(q, 0.0), 1.5) }",
            1.2 * 0.3_f64.powf(2.5),
        ),
        (
            "C c { effort: pow(1.0 - q, -1.4) }",
            2.5 * (0.7_f64.powf(-0.4) - 1.0),
        ),
        // Gas, a chemical potential, play
        (
            "C c { effort: 2.0 * exp(1.4 * ln(1.0 / (1.0 - q))) }",
            5.0 * (0.7_f64.powf(-0.4) - 1.0),
        ),
        (
            "C c { effort: 2.0 * ln(q), initial: 0.5 }",
            0.6 * (0.3_f64.ln() - 1.0),
        ),
        ("C c { effort: 3.0 / q, initial: 0.5 }", 3.0 * 0.3_f64.ln()),
        (
            "C c { effort: if q > 0.1 { 100.0 * (q - 0.1) } else { 0.0 } }",
            2.0,
        ),
        (
            "C c { effort: tanh(50.0 * q) }",
            15.0_f64.cosh().ln() / 50.0,
        ),
        // Saw teeth and a staircase.
        ("C c { effort: mod(q, 0.2) }", 0.5 * (0.04 + 0.01)),
        (
            "C c { effort: floor(q / 0.1 + 0.5) }",
            0.1 + 0.2 + 3.0 * 0.05,
        ),
        (
            "C c { effort: 4.0 - 20.0 * fraction(1.0 - 10.0 * q) }",
            0.3 * (4.0 - 10.0),
        ),
    ];
    for (storage, expected) in cases {
        let found = energy(storage, 0.3);
        assert!(
            (found - expected).abs() < 1e-13,
            "{storage}: {found}, not {expected}"
        );
    }
}

/// `∫ ln q` is `q ln q − q`, which is zero where nothing is left, and no number below.
#[test]
fn energies_of_logarithms_end_at_zero() {
    for law in ["ln(q)", "2.0 * ln(q / 3.0)", "ln(q / (1.0 - q))"] {
        let text = format!(
            "model M {{ 1 v {{ C c {{ effort: {law}, initial: 0.5 }} R r {{ resistance: 1.0 }} }} }}"
        );
        let model = compiled(&text);
        let energy = |amount: f64| {
            let arguments = Arguments {
                parameters: &[],
                time: 0.0,
                state: &[amount],
                input: &[],
            };
            program::evaluate(&model.program, Routines::ENERGY, &arguments)[0]
        };
        assert!((energy(0.0) - energy(1e-18)).abs() < 1e-15, "{law}");
    }
}

/// Slow and fast changes of the gas, of which slow ones have a logarithm for their energy.
#[test]
fn an_accumulator_stores_the_work_of_its_gas() {
    for (exponent, work) in [
        ("1.0", -0.7_f64.ln()),
        ("1.4", 2.5 * (0.7_f64.powf(-0.4) - 1.0)),
    ] {
        let text = format!(
            "model M {{ 0 line {{ R leak {{ resistance: 1.0 }} }}
             gas: Accumulator {{ volume: 2.0, precharge: 3.0, exponent: {exponent}, initial: 0.6 }} (line); }}"
        );
        let model = compiled(&text);
        assert!(model.notes.is_empty());
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &[0.6],
            input: &[],
        };
        let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
        assert!((found - 6.0 * work).abs() < 1e-14, "{exponent}: {found}");
        // A parameter that is 1.4 by default may be 1.
        let text = text.replace(&format!("exponent: {exponent}"), "exponent: n");
        let model = compiled(&text.replace("model M {", "model M { param n = 1.4;"));
        let parameters = [exponent.parse().unwrap()];
        let arguments = Arguments {
            parameters: &parameters,
            ..arguments
        };
        let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
        assert!((found - 6.0 * work).abs() < 1e-14, "{exponent}: {found}");
    }
}

/// From zero, where most are infinite, no quadrature gives them.
#[test]
fn energies_of_powers_of_quotients_are_exact() {
    let wells = |q: f64| (0.34 / q).powi(12) - (0.34 / q).powi(6);
    type Law = (&'static str, fn(f64) -> f64);
    let laws: [Law; 8] = [
        ("-3.0 * powi(1 / q, 2)", |q| 3.0 / q),
        ("-3.0 * powi(a / q, 2)", |q| 3.0 * 0.34 * 0.34 / q),
        ("powi(a / q, 13)", |q| -0.34 / 12.0 * (0.34 / q).powi(12)),
        ("pow(a / abs(q), 2.5)", |q| {
            -q / 1.5 * (0.34 / q.abs()).powf(2.5)
        }),
        ("powi(a / (2 * q - a), 3)", |q| {
            0.34 / 4.0 * (1.0 - (0.34 / (2.0 * q - 0.34)).powi(2))
        }),
        ("-3.0 / (q * sqrt(abs(q)))", |q| 6.0 / q.abs().sqrt()),
        ("1.0 / powi(2 * q, 3)", |q| -1.0 / (16.0 * q * q)),
        ("powi(1 - a / q, 2)", |q| {
            q - 0.68 * q.abs().ln() - 0.1156 / q
        }),
    ];
    for (law, expected) in laws {
        for q in [-2.0, -0.3, 0.39, 2.0] {
            assert_energy(law, q, expected(q));
        }
    }
    for law in [
        "-(24.0 / 0.34) * (2 * powi(0.34 / q, 13) - powi(0.34 / q, 7))",
        "-(24.0 / a) * (2 * powi(a / q, 13) - powi(a / q, 7))",
        "-(24.0 / a) * (2 * pow(a / q, 13.0) - pow(a / q, 7.0))",
        "-24.0 * (2 * powi(0.34, 12) / powi(q, 13) - powi(0.34, 6) / powi(q, 7))",
    ] {
        for q in [-2.0, -0.3, 0.39, 2.0] {
            assert_energy(law, q, 4.0 * wells(q));
        }
    }
}

/// Of gases, plates, fibres and the like, counted from zero.
#[test]
fn energies_of_polynomials_beside_other_functions_are_exact() {
    type Law = (&'static str, fn(f64) -> f64);
    let laws: [Law; 8] = [
        ("a * sin(12 * q) * (1.0 + 0.1 * cos(q))", |q| {
            let fall = |times: f64| (1.0 - f64::cos(times * q)) / times;
            0.34 * (fall(12.0) + 0.05 * (fall(13.0) + fall(11.0)))
        }),
        ("pow(2.0 / (2.0 - q), 1.4)", |q| {
            5.0 * ((1.0 - q / 2.0).powf(-0.4) - 1.0)
        }),
        ("q / (1 + abs(q))", |q| q.abs() - q.abs().ln_1p()),
        ("powi(sin(q), 2)", |q| (q - q.sin() * q.cos()) / 2.0),
        ("q * exp(-q)", |q| 1.0 - (1.0 + q) * (-q).exp()),
        ("0.5 * ln((1 + q) / (1 - q))", |q| {
            ((1.0 + q) * q.ln_1p() + (1.0 - q) * (-q).ln_1p()) / 2.0
        }),
        ("q / powi(1 + q, 2)", |q| q.ln_1p() + 1.0 / (1.0 + q) - 1.0),
        ("q * sin(q / a)", |q| {
            0.34 * (0.34 * (q / 0.34).sin() - q * (q / 0.34).cos())
        }),
    ];
    for (law, expected) in laws {
        for q in [-0.8, 0.0, 0.3, 0.9] {
            assert_energy(law, q, expected(q));
        }
    }
}

/// A quadrature across the kink would be a thousandth off.
#[test]
fn summands_with_a_closed_form_keep_it_beside_others() {
    for law in [
        "a * max(q - a, 0.0) + exp(sin(q))",
        "2.0 * (a * max(q - a, 0.0) + exp(sin(q))) / 2.0",
        "exp(sin(q)) - a * min(a - q, 0.0)",
    ] {
        let text = format!(
            "model M {{ param a = 0.34; 1 v {{ C c {{ effort: {law} }} I m {{ inertia: a }} }} }}"
        );
        let model = compiled(&text);
        assert!(model.notes[0].contains("quadrature"), "{:?}", model.notes);
        for state in [-1.0_f64, 0.2, 0.35, 1.0] {
            let arguments = Arguments {
                parameters: &[0.34],
                time: 0.0,
                state: &[state, 0.0],
                input: &[],
            };
            let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
            let kinked = 0.17 * (state - 0.34).max(0.0).powi(2);
            let expected = kinked + integral(|q| q.sin().exp(), 0.0, state);
            assert!(
                (found - expected).abs() < 1e-12,
                "{law} at {state}: {found}, not {expected}"
            );
        }
    }
}
/// It is that of the law at a displacement, and no quadrature.
fn assert_energy(law: &str, state: f64, expected: f64) {
    let text = format!(
        "model M {{ param a = 0.34; 1 v {{ C c {{ effort: {law}, initial: 0.5 }} I m {{ inertia: a }} }} }}"
    );
    let model = compiled(&text);
    assert!(model.notes.is_empty(), "{law}: {:?}", model.notes);
    let arguments = Arguments {
        parameters: &[0.34],
        time: 0.0,
        state: &[state, 0.0],
        input: &[],
    };
    let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
    assert!(
        (found - expected).abs() < 1e-13 * (1.0 + expected.abs()),
        "{law} at {state}: {found}, not {expected}"
    );
}

/// Where a quadrature between zero and the state would not see what happens near zero.
#[test]
fn energies_of_laws_of_inner_functions_are_exact() {
    let cases = [
        ("q * exp(-q * q)", 40.0, 0.5),
        ("q / (1 + powi(q, 2))", 1000.0, 0.5 * 1_000_001_f64.ln()),
        (
            "1e5 * q / sqrt(1 + powi(q / 0.001, 2))",
            0.1,
            0.1 * (10_001_f64.sqrt() - 1.0),
        ),
        (
            "k * q / sqrt(1 + powi(q / a, 2))",
            0.1,
            0.1 * (10_001_f64.sqrt() - 1.0),
        ),
        (
            "q * exp(-q * q) + tanh(q) - 2.0 * q / (1 + powi(q, 2))",
            40.0,
            0.5 + (40.0 - 2.0_f64.ln()) - 1601_f64.ln(),
        ),
    ];
    for (law, place, expected) in cases {
        let text = format!(
            "model M {{ param k = 1e5; param a = 0.001; 1 v {{ C c {{ effort: {law} }} I m {{ inertia: k * a }} }} }}"
        );
        let model = compiled(&text);
        assert!(model.notes.is_empty(), "{law}: {:?}", model.notes);
        for (state, expected) in [(place, expected), (-place, expected), (0.0, 0.0)] {
            let arguments = Arguments {
                parameters: &[1e5, 0.001],
                time: 0.0,
                state: &[state, 0.0],
                input: &[],
            };
            let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
            assert!(
                (found - expected).abs() < 1e-13 * (1.0 + expected),
                "{law} at {state}: {found}, not {expected}"
            );
        }
    }
}

/// Where an integral from zero would cross a pole, or places where the law has no value.
#[test]
fn energies_without_an_integral_from_zero_are_counted_from_the_start() {
    type Law = (&'static str, [f64; 2], fn(f64) -> f64);
    let laws: [Law; 5] = [
        ("exp(-q) / (q * q)", [0.5, 0.8], |q| (-q).exp() / (q * q)),
        ("exp(-q) / (q * q)", [-0.5, -0.8], |q| (-q).exp() / (q * q)),
        ("cos(q) / q", [0.5, 0.4], |q| q.cos() / q),
        ("exp(-q) / powi(q - 1, 2)", [2.0, 1.8], |q| {
            (-q).exp() / (q - 1.0).powi(2)
        }),
        ("ln(q - 1) / q", [2.0, 2.2], |q| (q - 1.0).ln() / q),
    ];
    for (law, [start, end], value) in laws {
        let text = format!(
            "model M {{ param start = {start:?};
             1 v {{ I m {{ inertia: 1.0 }} C c {{ effort: {law}, initial: start }} }} }}"
        );
        let model = compiled(&text);
        assert!(model.notes[0].contains("from its state at the start"));
        let energy = |start: f64, state: f64| {
            let arguments = Arguments {
                parameters: &[start],
                time: 0.0,
                state: &[0.0, state],
                input: &[],
            };
            program::evaluate(&model.program, Routines::ENERGY, &arguments)[0]
        };
        assert_eq!(energy(start, start), 0.0, "{law}");
        // Another value of the parameter is another start.
        let near = 0.9 * start + 0.1 * end;
        for start in [start, near] {
            let expected = integral(value, start, end);
            let found = energy(start, end);
            assert!(
                (found - expected).abs() < 1e-10,
                "{law}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn energies_with_an_integral_from_zero_are_counted_from_there() {
    // Such as Langevin's, whose terms are infinite at zero and their difference is not.
    for (law, initial) in [
        ("exp(-powi(q, 3))", "0.3"),
        ("1.0 / tanh(q) - 1.0 / q", "0.3"),
        ("1.0 / tanh(q) - 1.0 / q", "-0.3"),
        ("exp(-q) * ln(abs(q))", "0.3"),
        ("sqrt(q) * cos(q)", "0.0"),
        ("exp(-q) / powi(q - 1, 2)", "0.0"),
        ("exp(-q) / powi(q - 1, 2)", "0.5"),
    ] {
        let text = format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0 }} C c {{ effort: {law}, initial: {initial} }} }} }}"
        );
        let [note] = &compiled(&text).notes[..] else {
            panic!("{law} has one note")
        };
        assert!(!note.contains("from its state at the start"), "{note}");
    }
}

#[test]
fn energies_that_have_no_start_are_told() {
    let told = |law: &str| mistake(&format!("1 b {{ C c {{ {law} }} }}"));
    insta::assert_snapshot!(told("effort: exp(-q) / (q * q)"), @r"
    2:21 the energy of `c` is not known: its law has no integral from zero, and no finite value at the start [MBG0216]
      help: give an `initial: …` where the law is finite, from which its energy is counted then, or write `energy: …`; sums of powers of a distance, such as `powi(a / q, 2)` or `pow(q - a, -1.5)`, are integrated from anywhere
    
");
    insta::assert_snapshot!(told("effort: cos(q) / q, initial: 0.0"), @r"
    2:21 the energy of `c` is not known: its law has no integral from zero, and no finite value at the start [MBG0216]
      help: give an `initial: …` where the law is finite, from which its energy is counted then, or write `energy: …`; sums of powers of a distance, such as `powi(a / q, 2)` or `pow(q - a, -1.5)`, are integrated from anywhere
    
");
    insta::assert_snapshot!(told("effort: exp(-q) / (q - 1.0), initial: 1.0"), @r"
    2:21 the energy of `c` is not known: its law has no integral from zero, and no finite value at the start [MBG0216]
      help: give an `initial: …` where the law is finite, from which its energy is counted then, or write `energy: …`; sums of powers of a distance, such as `powi(a / q, 2)` or `pow(q - a, -1.5)`, are integrated from anywhere
    
");
}

/// What its energy is changed by besides its own state is no port, so that the balance lacks that power.
#[test]
fn energies_that_are_modulated_are_noted() {
    let notes = |stiffness: &str| {
        let model = format!(
            "model M {{ param k = 5.0; 1 v {{ I m {{ inertia: 1.0 }} C c {{ stiffness: {stiffness} }} }} output y = c.q; }}"
        );
        compiled(&model).notes.join("\n")
    };
    assert_eq!(notes("k"), "");
    insta::assert_snapshot!(notes("k * (2.0 + cos(t))"), @"the energy of `c` changes with more than its own state: the power of that is not in the balance");
    insta::assert_snapshot!(notes("exp(-powi(q, 3))"), @"the energy of `c` is a quadrature of its law at sixteen points, good to rounding only where the law is that smooth");
    let text = "model M { 1 v { C c { effort: exp(-powi(q, 3)) } I m { inertia: 1.0 } } }";
    let explained = explain(text.parse().unwrap(), &no_file, &|_| String::new()).unwrap();
    assert!(
        explained.contains("==== notes\nthe energy of `c` is a quadrature"),
        "{explained}"
    );
}

/// A law that reads a parameter, its value there, and where it has a kink.
struct Weak {
    text: &'static str,
    value: fn(f64, f64) -> f64,
    kink: fn(f64) -> f64,
}

/// A law without a kink.
fn smooth(text: &'static str, value: fn(f64, f64) -> f64) -> Weak {
    let kink = |_| f64::INFINITY;
    Weak { text, value, kink }
}

fn weak_functions() -> Vec<Weak> {
    vec![
        smooth("q + sin(a * q)", |a, q| q + (a * q).sin()),
        smooth("exp(a * q)", |a, q| (a * q).exp()),
        smooth("exp(a * q - 3.0)", |a, q| (a * q - 3.0).exp()),
        smooth("cos(a * q + 20.0)", |a, q| (a * q + 20.0).cos()),
        smooth("tanh(a * q)", |a, q| (a * q).tanh()),
        smooth("2.0 * a * tanh(a * q) / 3.0", |a, q| {
            2.0 * a * (a * q).tanh() / 3.0
        }),
        smooth("atan(a * q)", |a, q| (a * q).atan()),
        smooth("atan2(a * q - 1.0, 0.5)", |a, q| (a * q - 1.0).atan2(0.5)),
        smooth("q + ln(2 + a * q)", |a, q| q + (2.0 + a * q).ln()),
        smooth("ln(2 - a * q)", |a, q| (2.0 - a * q).ln()),
        smooth("3 * q + ln((2 + a * q) / (2 - a * q))", |a, q| {
            3.0 * q + ((2.0 + a * q) / (2.0 - a * q)).ln()
        }),
        smooth("sqrt(1.5 + a * q)", |a, q| (1.5 + a * q).sqrt()),
        smooth("asin(0.8 * a * q)", |a, q| (0.8 * a * q).asin()),
        smooth("acos(0.8 * a * q)", |a, q| (0.8 * a * q).acos()),
        smooth("tan(a * q)", |a, q| (a * q).tan()),
        smooth(
            "sin(interpolate(q, [-2.0, 0.0, 2.0], [0.0, 0.0, 2.0 * a]))",
            |a, q| (a * q.max(0.0)).sin(),
        ),
    ]
}

fn weak_products() -> Vec<Weak> {
    vec![
        smooth("q * cos(a * q)", |a, q| q * (a * q).cos()),
        smooth("q * sin(a * q)", |a, q| q * (a * q).sin()),
        smooth("q * exp(-a * q)", |a, q| q * (-a * q).exp()),
        smooth("q * q * exp(a * q)", |a, q| q * q * (a * q).exp()),
        smooth("powi(q, 4) * cos(a * q)", |a, q| q.powi(4) * (a * q).cos()),
        smooth("powi(sin(a * q), 2)", |a, q| (a * q).sin().powi(2)),
        smooth("powi(sin(a * q), 3)", |a, q| (a * q).sin().powi(3)),
        smooth("sin(a * q) * cos(2 * a * q)", |a, q| {
            (a * q).sin() * (2.0 * a * q).cos()
        }),
        smooth("q * (cos(a * q) + sin(30 * q))", |a, q| {
            q * ((a * q).cos() + (30.0 * q).sin())
        }),
        smooth("q / (1.5 + a * q)", |a, q| q / (1.5 + a * q)),
        smooth("(1 + q * q) / (1.5 + a * q)", |a, q| {
            (1.0 + q * q) / (1.5 + a * q)
        }),
        smooth("powi(q, 3) / (1.5 + a * q)", |a, q| {
            q.powi(3) / (1.5 + a * q)
        }),
        smooth("1 / (1.5 + a * q)", |a, q| 1.0 / (1.5 + a * q)),
        smooth("powi(1.5 + a * q, -2)", |a, q| (1.5 + a * q).powi(-2)),
        smooth("q * powi(1.5 + a * q, -2)", |a, q| {
            q * (1.5 + a * q).powi(-2)
        }),
        smooth("q * pow(1.5 + a * q, 0.4)", |a, q| {
            q * (1.5 + a * q).powf(0.4)
        }),
        smooth("pow(1.5 + a * q, -1.4)", |a, q| (1.5 + a * q).powf(-1.4)),
        smooth("powi(1 + a * q, 3) + cos(q)", |a, q| {
            (1.0 + a * q).powi(3) + q.cos()
        }),
        smooth("q / (2 + a * q * q)", |a, q| q / (2.0 + a * q * q)),
        smooth("q * exp(a * q * q)", |a, q| q * (a * q * q).exp()),
        smooth("q * sin(a * q * q)", |a, q| q * (a * q * q).sin()),
        smooth("q * sqrt(2 + a * q * q)", |a, q| {
            q * (2.0 + a * q * q).sqrt()
        }),
        smooth("q / sqrt(1 + powi(a * q, 2))", |a, q| {
            q / (1.0 + (a * q).powi(2)).sqrt()
        }),
    ]
}

/// With kinks that go to infinity with the parameter, or stay where they are.
fn weak_choices() -> Vec<Weak> {
    let weak = |text, value, kink| Weak { text, value, kink };
    vec![
        weak("abs(a * q)", |a, q| (a * q).abs(), |_| 0.0),
        weak("abs(a * q + 0.2)", |a, q| (a * q + 0.2).abs(), |a| -0.2 / a),
        weak(
            "sign(a * q + 0.2) * q",
            |a, q| (a * q + 0.2).signum() * q,
            |a| -0.2 / a,
        ),
        weak(
            "if a * q > 0.3 { q * q } else { 0.5 * q }",
            |a, q| if a * q > 0.3 { q * q } else { 0.5 * q },
            |a| 0.3 / a,
        ),
        weak(
            "if a * q > 0.3 { exp(a * q) } else { q / (2 + a * q) }",
            |a, q| {
                if a * q > 0.3 {
                    (a * q).exp()
                } else {
                    q / (2.0 + a * q)
                }
            },
            |a| 0.3 / a,
        ),
        weak(
            "pow(max(a * q - 0.3, 0.0), 1.5)",
            |a, q| (a * q - 0.3).max(0.0).powf(1.5),
            |a| 0.3 / a,
        ),
        weak(
            "pow(max(a * q + 0.3, 0.0), 1.5)",
            |a, q| (a * q + 0.3).max(0.0).powf(1.5),
            |a| -0.3 / a,
        ),
        weak("exp(-a * abs(q))", |a, q| (-a * q.abs()).exp(), |_| 0.0),
        weak(
            "max(q - 0.25, 0.0) * exp(a * q)",
            |a, q| (q - 0.25).max(0.0) * (a * q).exp(),
            |_| 0.25,
        ),
        weak(
            "q / (2 + a * abs(q - 0.2))",
            |a, q| q / (2.0 + a * (q - 0.2).abs()),
            |_| 0.2,
        ),
    ]
}

/// With kinks inside other functions, or several.
fn weak_choices_inside() -> Vec<Weak> {
    let weak = |text, value, kink| Weak { text, value, kink };
    vec![
        weak(
            "ln((2 + a * q) * abs(q - 0.3))",
            |a, q| ((2.0 + a * q) * (q - 0.3).abs()).ln(),
            |_| 0.3,
        ),
        weak(
            "q * abs(a * q * q - 0.3)",
            |a, q| q * (a * q * q - 0.3).abs(),
            |a| (0.3 / a).max(0.0).sqrt(),
        ),
        weak(
            "q * max(a * q * q - 0.3, 0.0)",
            |a, q| q * (a * q * q - 0.3).max(0.0),
            |a| (0.3 / a).max(0.0).sqrt(),
        ),
        weak(
            "q * (if a * q * q > 0.3 { exp(a * q * q) } else { 2.0 })",
            |a, q| {
                q * if a * q * q > 0.3 {
                    (a * q * q).exp()
                } else {
                    2.0
                }
            },
            |a| (0.3 / a).max(0.0).sqrt(),
        ),
        weak(
            "if a * q > 0.3 { min(max(a * q, -0.3), 0.3) } else { 1.0 }",
            |a, q| if a * q > 0.3 { 0.3 } else { 1.0 },
            |a| 0.3 / a,
        ),
        smooth("exp((a - 0.01) * q)", |a, q| ((a - 0.01) * q).exp()),
        weak(
            "interpolate(a * q, [-0.5, 0.0, 0.2, 0.5], [-2.0, 0.0, 1.0, 1.5])",
            |a, q| {
                let u = a * q;
                if u < 0.0 {
                    4.0 * u
                } else if u < 0.2 {
                    5.0 * u
                } else {
                    1.0 + (u - 0.2) / 0.6
                }
            },
            |a| 0.2 / a,
        ),
        weak(
            "min(max(a * q, -0.25), 0.25) * q",
            |a, q| (a * q).clamp(-0.25, 0.25) * q,
            |a| (0.25 / a).abs(),
        ),
    ]
}

/// A parameter with states, and their negatives.
fn both_signs(size: f64, states: &[f64]) -> Vec<[f64; 2]> {
    let turned = |state: &f64| {
        [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[a, q]| [a * size, q * state])
    };
    states.iter().flat_map(turned).collect()
}

/// The integral of a law from zero, with a kink on one of two places.
fn reference(value: impl Fn(f64) -> f64, kink: f64, state: f64) -> f64 {
    let mut places = [-kink, kink].map(|place| (place / state).clamp(0.0, 1.0));
    places.sort_by(f64::total_cmp);
    let [low, high] = places.map(|part| part * state);
    let parts = [[0.0, low], [low, high], [high, state]];
    parts.map(|ends| between(&value, ends)).iter().sum()
}

/// By Gauss' rule with three points on each of many stretches, which are short at the ends, where roots begin.
fn between(value: impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> f64 {
    let count = 3000;
    let at = |part: f64| {
        let place = from + (to - from) * part.powi(3) * (10.0 + part * (6.0 * part - 15.0));
        value(place) * 30.0 * (part * (1.0 - part)).powi(2)
    };
    let step = 1.0 / f64::from(count);
    let parts = (0..count).map(|k| {
        let middle = step * (f64::from(k) + 0.5);
        let way = step / 2.0 * 0.6_f64.sqrt();
        5.0 * (at(middle - way) + at(middle + way)) + 8.0 * at(middle)
    });
    (to - from) * step / 18.0 * parts.sum::<f64>()
}

/// Where the closed form divides by what is zero, or nearly so.
#[test]
fn energies_are_exact_where_a_slope_vanishes() {
    let smooth = weak_functions().into_iter().chain(weak_products());
    for law in smooth.chain(weak_choices()).chain(weak_choices_inside()) {
        let text = format!(
            "model M {{ param a = 0.0; 1 v {{ C c {{ effort: {} }} I m {{ inertia: 1.0 + a * a }} }} }}",
            law.text
        );
        let model = compiled(&text);
        assert!(model.notes.is_empty(), "{}: {:?}", law.text, model.notes);
        for size in [0.0, 1e-300, 1e-12, 1e-9, 1e-6, 1e-4, 0.01, 0.1, 0.5, 1.0] {
            for [a, state] in both_signs(size, &[0.0, 0.05, 0.4, 1.1]) {
                let arguments = Arguments {
                    parameters: &[a],
                    time: 0.0,
                    state: &[state, 0.0],
                    input: &[],
                };
                let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
                if state == 0.0 {
                    assert!(found.abs() < 1e-15, "{} with {a}: {found}", law.text);
                    continue;
                }
                let expected = reference(|q| (law.value)(a, q), (law.kink)(a), state);
                assert!(
                    (found - expected).abs() <= 1e-11 * expected.abs(),
                    "{} at {state} with {a:e}: {found:e}, not {expected:e}",
                    law.text
                );
            }
        }
    }
}

/// The logarithm among the powers is no place of its own.
#[test]
fn energies_are_exact_where_a_degree_vanishes() {
    type Law = (&'static str, fn(f64, f64) -> f64);
    let laws: [Law; 5] = [
        ("pow(abs(q - 0.5), n)", |n, q| (q - 0.5).abs().powf(n)),
        ("3.0 * pow(1 - q / 2.0, -n)", |n, q| {
            3.0 * (1.0 - q / 2.0).powf(-n)
        }),
        ("exp(-n * ln(2 + q))", |n, q| (2.0 + q).powf(-n)),
        ("q * pow(2 + q, -n)", |n, q| q * (2.0 + q).powf(-n)),
        ("pow(3 + (n - 1) * q, -n)", |n, q| {
            (3.0 + (n - 1.0) * q).powf(-n)
        }),
    ];
    for (law, value) in laws {
        let text = format!(
            "model M {{ param n = 1.0; 1 v {{ C c {{ effort: {law} }} I m {{ inertia: n }} }} }}"
        );
        let model = compiled(&text);
        for part in [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.03, 0.4] {
            for n in [1.0 + part, 1.0 - part, 2.0 + part, 2.0 - part] {
                for state in [-1.9, -0.3, -1e-3, 1e-3, 0.3, 1.0, 1.9, 1.99] {
                    let expected = reference(|q| value(n, q), 0.5, state);
                    if !expected.is_finite() {
                        continue;
                    }
                    let arguments = Arguments {
                        parameters: &[n],
                        time: 0.0,
                        state: &[state, 0.0],
                        input: &[],
                    };
                    let found = program::evaluate(&model.program, Routines::ENERGY, &arguments)[0];
                    assert!(
                        (found - expected).abs() <= 1e-10 * expected.abs(),
                        "{law} at {state} with {n}: {found}, not {expected}"
                    );
                }
            }
        }
    }
}

/// By Simpson's rule.
fn integral(value: fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let count = 4096;
    let step = (to - from) / f64::from(count);
    let parts = (0..count).map(|k| {
        let left = from + step * f64::from(k);
        value(left) + 4.0 * value(left + step / 2.0) + value(left + step)
    });
    step / 6.0 * parts.sum::<f64>()
}
