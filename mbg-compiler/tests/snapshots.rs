//! What each stage makes of small models, and expansions, as snapshots.

use mbg_compiler::inclusion::no_file;
use mbg_compiler::{expand, explain::explain};
use quote::quote;

const OSCILLATOR: &str = include_str!("syntax/oscillator.mbg");
const ROTOR: &str = include_str!("stages/rotor.mbg");
const RECTIFIER: &str = include_str!("stages/rectifier.mbg");
const CARRIAGE: &str = include_str!("stages/slide.mbg");

/// A line of forty cells, each with a capacity of its own, and a current into each.
const LINE: &str = "model Line {
    input current[40];
    wires: for k in 0..41 { 1 wire; }
    Se supply { effort: 12.0 } -> wires[0].wire;
    cells: for k in 0..40 {
        0 node {
            C store { compliance: 1.0 + 0.5 * k }
            Sf drive { flow: current[k] }
        }
        wires[k].wire -> I coil { inertia: 1.0 };
        wires[k].wire -> R loss { effort: 1.0 * f * abs(f) };
        wires[k].wire -> node;
        node -> wires[k+1].wire;
    }
    wires[40].wire -> R load { resistance: 50.0 };
    output last = wires[40].wire.f;
}";

/// The expansion as a person would have written it.
fn formatted(text: &str) -> String {
    let expansion = expand(
        text.parse().expect("tokens"),
        &quote!(::mbg_runtime),
        &no_file,
    );
    prettyplease::unparse(&syn::parse2(expansion).expect("the expansion is Rust"))
}

fn stages(text: &str) -> String {
    explain(text.parse().expect("tokens"), &no_file, &|_| String::new()).expect("a sound model")
}

#[test]
fn stages_of_the_oscillator() {
    insta::assert_snapshot!("stages_oscillator", stages(OSCILLATOR));
}

#[test]
fn stages_of_a_gyroscopic_body_behind_a_rotation() {
    insta::assert_snapshot!("stages_rotor", stages(ROTOR));
}

#[test]
fn stages_of_a_component_with_a_direct_sum() {
    insta::assert_snapshot!("stages_carriage", stages(CARRIAGE));
}

#[test]
fn stages_of_a_nonlinear_loop() {
    insta::assert_snapshot!("stages_rectifier", stages(RECTIFIER));
}

#[test]
fn expansion_of_the_oscillator() {
    insta::assert_snapshot!("expansion_oscillator", formatted(OSCILLATOR));
}

#[test]
fn derivative_of_a_line_of_cells() {
    let expansion = formatted(LINE);
    let begin = expansion.find("fn derivative_into").expect("it is there");
    let (body, _) = expansion[begin..]
        .split_once("\n        }")
        .expect("it ends");
    insta::assert_snapshot!("derivative_line", body);
}
