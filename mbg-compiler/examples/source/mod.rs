//! Models in files, for the tools beside the compiler.

use std::error::Error;
use std::io;

use proc_macro2::{Delimiter, LexError, Span, TokenStream, TokenTree};

/// What a file says: what stands between the braces of `mbg! { … }`, or Rust source with one such call in it.
pub(crate) fn tokens(path: &str) -> Result<TokenStream, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let tokens = text.parse::<TokenStream>();
    let tokens = tokens.map_err(|mistake: LexError| {
        let place = place(path, mistake.span());
        format!(
            "{place}: this is no token of Rust, or a bracket or a quotation mark has no partner"
        )
    })?;
    Ok(between_braces(tokens.clone()).unwrap_or(tokens))
}

/// A file that is included, by its path from the current directory.
pub(crate) fn included(path: &str) -> io::Result<String> {
    std::fs::read_to_string(path)
}

/// `file:line:column`, as editors and terminals follow it.
pub(crate) fn place(path: &str, span: Span) -> String {
    let start = span.start();
    format!("{path}:{}:{}", start.line, start.column + 1)
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
