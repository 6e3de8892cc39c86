//! Models in files, for the tools beside the compiler.

use std::error::Error;

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::inclusion::Inclusion;
use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// What a file says, with what it includes in place. It holds what stands between the braces of `mbg! { … }`, or Rust
/// source with one such call in it; included files are looked for from the current directory.
pub(crate) fn read(path: &str) -> Result<TokenStream, Box<dyn Error>> {
    let tokens: TokenStream = std::fs::read_to_string(path)?.parse()?;
    let inner = between_braces(tokens.clone()).unwrap_or(tokens);
    let mut diagnostics = Diagnostics::new();
    let included = |path: &str| std::fs::read_to_string(path);
    let inclusion = Inclusion::of(inner, &included, &mut diagnostics);
    for diagnostic in diagnostics.list() {
        eprintln!("{}", diagnostic.text());
    }
    Ok(inclusion.tokens())
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
