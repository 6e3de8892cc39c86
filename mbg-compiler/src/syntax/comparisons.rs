//! Comparisons in a chain, `a < x < b`, and what to type instead.

use proc_macro2::{Delimiter, TokenTree};

use super::dump;
use super::slips::is_mark;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};

/// What to type for three values with two comparisons between them, among these tokens or in a group of theirs.
pub(super) fn chained(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let conditions = tokens.split(ends);
    conditions.into_iter().find_map(between).or_else(|| {
        tokens.iter().find_map(|token| match token {
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                chained(&inside)
            }
            _ => None,
        })
    })
}

/// Whether a comparison cannot go past this token.
fn ends(token: &TokenTree) -> bool {
    match token {
        TokenTree::Ident(word) => word == "if" || word == "else",
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Punct(_) => [',', ';', '&', '|', '!']
            .iter()
            .any(|mark| is_mark(token, *mark)),
        TokenTree::Literal(_) => false,
    }
}

/// `a < x < b`, where nothing else is compared.
fn between(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let compares = |at: &usize| is_mark(&tokens[*at], '<') || is_mark(&tokens[*at], '>');
    let places: Vec<usize> = (0..tokens.len()).filter(compares).collect();
    let [first, second] = places[..] else {
        return None;
    };
    // The sign `<=` is two tokens.
    let length = |at: usize| 1 + usize::from(tokens.get(at + 1).is_some_and(|it| is_mark(it, '=')));
    let middle = tokens.get(first + length(first)..second)?;
    let last = tokens.get(second + length(second)..)?;
    if first == 0 || middle.is_empty() || last.is_empty() {
        return None;
    }
    let text = |part: &[TokenTree]| dump::tokens(part.iter().cloned().collect());
    let report = error(
        codes::SYNTAX,
        tokens[second].span(),
        "comparison operators cannot be chained",
    );
    Some(Box::new(report.help(format!(
        "write `{} && {}`",
        text(&tokens[..second]),
        text(&tokens[first + length(first)..])
    ))))
}
