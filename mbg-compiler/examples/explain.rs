//! Prints every stage of the models in a file: `cargo run -p mbg-compiler --example explain -- FILE`.
//!
//! The file holds what stands between the braces of `mbg! { … }`, or Rust source with one such call in it. Files that it
//! includes are looked for from the current directory.

use std::error::Error;

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::inclusion::Inclusion;
use proc_macro2::{Delimiter, TokenStream, TokenTree};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: explain FILE")?;
    let tokens: TokenStream = std::fs::read_to_string(path)?.parse()?;
    let inner = between_braces(tokens.clone()).unwrap_or(tokens);
    let mut diagnostics = Diagnostics::new();
    let read = |path: &str| std::fs::read_to_string(path);
    let inclusion = Inclusion::of(inner, &read, &mut diagnostics);
    for diagnostic in diagnostics.list() {
        eprintln!("{}", diagnostic.text());
    }
    print!("{}", mbg_compiler::explain::explain(inclusion.tokens()));
    Ok(())
}

/// What stands in the first `mbg! { … }` outside other brackets.
fn between_braces(tokens: TokenStream) -> Option<TokenStream> {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    trees.windows(3).find_map(|window| match window {
        [
            TokenTree::Ident(name),
            TokenTree::Punct(mark),
            TokenTree::Group(group),
        ] if name == "mbg" && mark.as_char() == '!' && group.delimiter() == Delimiter::Brace => {
            Some(group.stream())
        }
        _ => None,
    })
}
