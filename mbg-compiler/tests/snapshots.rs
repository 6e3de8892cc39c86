//! What each stage makes of three small models, and their expansions, as snapshots.

use mbg_compiler::inclusion::no_file;
use mbg_compiler::{expand, explain::explain};
use quote::quote;

const OSCILLATOR: &str = include_str!("syntax/oscillator.mbg");
const ROTOR: &str = include_str!("stages/rotor.mbg");
const RECTIFIER: &str = include_str!("stages/rectifier.mbg");
const CARRIAGE: &str = include_str!("stages/slide.mbg");

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
