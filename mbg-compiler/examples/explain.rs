//! Prints every stage of the models in a file: `cargo run -p mbg-compiler --example explain -- FILE`.
//!
//! The file holds what stands between the braces of `mbg! { … }`, or Rust source with one such call in it.

use std::error::Error;

use mbg_compiler::compile::compile;
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::syntax::ast::Item;
use mbg_compiler::{elaborate, program, syntax};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: explain FILE")?;
    let text = std::fs::read_to_string(path)?;
    let inner = match text.find("mbg! {") {
        Some(start) => &text[start + 6..text.rfind('}').ok_or("no closing brace")?],
        None => &text,
    };
    // With a `main` behind the call, only the part up to the call's own brace counts.
    let tokens = inner.parse()?;
    let mut diagnostics = Diagnostics::new();
    let source = syntax::parse(tokens, &mut diagnostics);
    println!("{}", syntax::dump(&source));
    let components = elaborate::component_table(&source);
    for item in &source.items {
        let Item::Model(model) = item else { continue };
        let Some(compiled) = compile(model, &components, &mut diagnostics) else {
            continue;
        };
        println!("model {}", model.name);
        println!("folded\n{}", program::dump(&compiled.program.folded));
        println!(
            "derivative\n{}",
            program::dump(&compiled.program.routines[0])
        );
        println!("conditioning {:?}\n", compiled.conditioning);
    }
    for diagnostic in diagnostics.list() {
        println!("{}", diagnostic.text());
    }
    Ok(())
}
