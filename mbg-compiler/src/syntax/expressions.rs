//! Laws: Rust expressions, read by `syn`.

use proc_macro2::{TokenStream, TokenTree};
use syn::Expr;
use syn::parse::{ParseStream, Parser};

use super::cursor::{Cursor, Parsed};
use crate::codes;

/// Reads an expression up to `,`, `;`, the end, or the first token that cannot continue it; `what` names it in errors.
pub(super) fn expression(cursor: &mut Cursor, what: &str) -> Parsed<Expr> {
    let length = cursor
        .length_until(|cursor, offset| cursor.punct(offset, ',') || cursor.punct(offset, ';'));
    if length == 0 {
        return Err(cursor.expected(what));
    }
    if too_deep(cursor.ahead(length)) {
        let limit = format!("{what} nests or runs on too far to be read");
        return Err(Box::new(
            (*cursor.failure(codes::SYNTAX, limit)).help("give its parts in several statements"),
        ));
    }
    let tokens: TokenStream = cursor.ahead(length).iter().cloned().collect();
    let mut unread = 0;
    let parser = |input: ParseStream<'_>| {
        let parsed = input.parse::<Expr>();
        // Read to the end even after a failure: tokens left unread would replace the error by a vaguer one.
        unread = input.parse::<TokenStream>()?.into_iter().count();
        parsed
    };
    let parsed = parser.parse2(tokens);
    cursor.advance(length - unread.min(length));
    parsed.map_err(|error| translated(cursor, &error, unread == 0))
}

/// Tells in our words, and at a token of the law, what `syn` could not read.
fn translated(
    cursor: &Cursor,
    error: &syn::Error,
    ended: bool,
) -> Box<crate::diagnostics::Diagnostic> {
    const END: &str = "unexpected end of input";
    let text = error.to_string();
    let text = text
        .lines()
        .next()
        .unwrap_or_default()
        .trim_end_matches('.');
    let cut = text.starts_with(END);
    let wanted = text.trim_start_matches(END).trim_start_matches(", ");
    let wanted = if wanted.is_empty() {
        "expected an expression"
    } else {
        wanted
    };
    if cut && ended {
        // `syn` would mark the whole macro call here.
        let message = format!(
            "{wanted} after {}, found {}",
            cursor.previous(),
            cursor.found()
        );
        return Box::new(crate::diagnostics::error(
            codes::SYNTAX,
            cursor.last_span(),
            message,
        ));
    }
    if cut {
        return Box::new(crate::diagnostics::error(
            codes::SYNTAX,
            error.span(),
            format!("{wanted} before the closing bracket"),
        ));
    }
    // After a group the mistake may lie inside it, and only `syn` knows where.
    let inside = matches!(cursor.since(0).last(), Some(TokenTree::Group(_)));
    if ended || inside || !wanted.starts_with("expected") {
        return Box::new(crate::diagnostics::error(
            codes::SYNTAX,
            error.span(),
            wanted,
        ));
    }
    cursor.failure(codes::SYNTAX, format!("{wanted}, found {}", cursor.found()))
}

/// Whether the tokens nest or run so far that the reader of laws, which recurses, could exhaust the stack.
///
/// A token weighs one and a nested group [`NESTING`]; a comma or a semicolon starts again.
fn too_deep(tokens: &[TokenTree]) -> bool {
    weight(tokens.iter().cloned(), HEAVIEST).is_none()
}

/// What may weigh on the stack.
const HEAVIEST: usize = 4_000;

/// What one more level of brackets weighs, in tokens.
const NESTING: usize = 60;

fn weight(tokens: impl Iterator<Item = TokenTree>, budget: usize) -> Option<usize> {
    let (mut heaviest, mut run, mut nested) = (0, 0, 0);
    for token in tokens {
        match token {
            TokenTree::Punct(punct) if matches!(punct.as_char(), ',' | ';') => {
                (run, nested) = (0, 0)
            }
            TokenTree::Group(group) => {
                run += 1;
                let left = budget.checked_sub(NESTING)?;
                nested =
                    nested.max(NESTING + weight(TokenStream::into_iter(group.stream()), left)?);
            }
            _ => run += 1,
        }
        heaviest = heaviest.max(run + nested);
        if heaviest > budget {
            return None;
        }
    }
    Some(heaviest)
}
