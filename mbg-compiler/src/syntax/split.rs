//! Cutting a body into statements before any of them is read, so that one mistake costs one statement.

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use syn::parse::{ParseStream, Parser};

use crate::codes;
use crate::diagnostics::Diagnostics;

/// Statements of a body. One ends at `;`, or at a brace that closes it: a brace followed by `->`, `(`, `;` or `,`
/// goes on.
pub(super) fn statements(tokens: TokenStream) -> Vec<Vec<TokenTree>> {
    let mut all = Vec::new();
    let mut current: Vec<TokenTree> = Vec::new();
    let mut rest = tokens.into_iter().peekable();
    while let Some(token) = rest.next() {
        let semicolon = is_punct(&token, ';');
        let brace =
            matches!(&token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
        if semicolon && current.is_empty() {
            continue;
        }
        let initialiser = current.iter().any(|token| is_punct(token, '='));
        current.push(token);
        let goes_on = rest.peek().is_some_and(|next| {
            is_punct(next, '-')
                || is_punct(next, ';')
                || is_punct(next, ',')
                || matches!(next, TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis)
                || is_word(next, "else")
        });
        if semicolon || (brace && !goes_on && !initialiser) {
            all.push(std::mem::take(&mut current));
        }
    }
    if !current.is_empty() {
        all.push(current);
    }
    all
}

/// Whether a token is this punctuation.
pub(super) fn is_punct(token: &TokenTree, character: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == character)
}

/// Whether a token is this word.
pub(super) fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == word)
}

/// Reads one statement whole; a failure is reported at a token of the statement, never at the whole macro.
pub(super) fn read<T>(
    tokens: &[TokenTree],
    parser: impl FnOnce(ParseStream) -> syn::Result<T>,
    diagnostics: &mut Diagnostics,
) -> Option<T> {
    let last = tokens.last().map_or_else(Span::call_site, TokenTree::span);
    let stream: TokenStream = tokens.iter().cloned().collect();
    match parser.parse2(stream) {
        Ok(value) => Some(value),
        Err(error) => {
            let text = error.to_string();
            let (span, text) = match text.strip_prefix("unexpected end of input, ") {
                Some(expected) => (last, format!("{expected}, found the end of the statement")),
                None => (error.span(), text),
            };
            diagnostics.error(codes::SYNTAX, span, text.trim_end_matches('.'));
            None
        }
    }
}
