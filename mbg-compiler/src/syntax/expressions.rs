//! Laws: Rust expressions, read by `syn`.

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use syn::parse::{ParseStream, Parser};
use syn::spanned::Spanned;
use syn::{Expr, ExprRange, RangeLimits};

use super::comparisons::chained;
use super::cursor::{Cursor, Parsed};
use super::depth::too_deep;
use super::recovery::opens;
use super::ternaries::{ternary, without_braces};
use super::{dump, raw, slips, words};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};

/// Reads an expression up to `,`, `;`, the end, or the first token that cannot continue it; `what` names it in errors.
pub(super) fn expression(cursor: &mut Cursor, what: &str) -> Parsed<Expr> {
    let length = cursor.length_until(ends);
    read(cursor, length, what)
}

/// Reads `start..end` up to an opening brace or the end.
///
/// `syn` would take `0..n { … }` for a range that ends in a structure.
pub(super) fn range(cursor: &mut Cursor, what: &str) -> Parsed<(Expr, Expr)> {
    let length = cursor.length_until(before_brace);
    match read(cursor, length, what)? {
        Expr::Range(range) => bounds(range),
        other => {
            let found = dump::expression(&other);
            let message = format!("expected {what}, found `{found}`");
            let report = error(codes::SYNTAX, other.span(), message);
            // `1:4`, whose end is within it.
            let end = match cursor.punct(0, ':') && !cursor.punct(1, ':') {
                true => cursor.length_until(before_brace),
                false => 0,
            };
            let behind = cursor.ahead(end).get(1..).unwrap_or_default();
            // `1:10 loop`, as Modelica has it.
            let is_loop = |token: &TokenTree| token.to_string() == "loop";
            let behind = behind.split(is_loop).next().unwrap_or_default();
            // With a step, as in `1:2:9`, there is no such range.
            if behind.is_empty() || behind.iter().any(|it| slips::is_mark(it, ':')) {
                return Err(Box::new(report));
            }
            let last = behind.iter().cloned().collect();
            let last = dump::tokens(last);
            let beyond = match last.parse::<i64>().ok().and_then(|it| it.checked_add(1)) {
                Some(beyond) => beyond.to_string(),
                None => format!("{last} + 1"),
            };
            let help = format!("a range excludes its end: write `{found}..{beyond}`");
            Err(Box::new(report.help(help)))
        }
    }
}

/// Reads a condition up to an opening brace.
///
/// `syn` would take `a == b { … }` for a comparison with a structure.
pub(super) fn condition(cursor: &mut Cursor, what: &str) -> Parsed<Expr> {
    let length = cursor.length_until(before_brace);
    read(cursor, length, what)
}

/// Whether what stands before a brace cannot go past this offset.
fn before_brace(cursor: &Cursor, offset: usize) -> bool {
    cursor.group(offset, Delimiter::Brace).is_some() || ends(cursor, offset)
}

/// The bounds of a range, both of which must be written.
pub(super) fn bounds(range: ExprRange) -> Parsed<(Expr, Expr)> {
    let span = range.limits.span();
    if matches!(range.limits, RangeLimits::Closed(_)) {
        let report = error(codes::SYNTAX, span, "expected `..`, found `..=`");
        return Err(Box::new(
            report.help("a range excludes its end: `1..3` holds 1 and 2"),
        ));
    }
    match (range.start, range.end) {
        (Some(start), Some(end)) => Ok((*start, *end)),
        (None, _) => Err(Box::new(error(
            codes::SYNTAX,
            span,
            "expected the start of the range before `..`",
        ))),
        (_, None) => Err(Box::new(error(
            codes::SYNTAX,
            span,
            "expected the end of the range after `..`",
        ))),
    }
}

/// Reads an expression from at most the next `length` tokens.
fn read(cursor: &mut Cursor, length: usize, what: &str) -> Parsed<Expr> {
    if length == 0 {
        return Err(cursor.expected(what));
    }
    if too_deep(cursor.ahead(length)) {
        let limit = format!("{what} nests or runs on too far to be read");
        return Err(Box::new(
            (*cursor.failure(codes::SYNTAX, limit)).help("give its parts in several statements"),
        ));
    }
    let whole = || cursor.length_until(|it, at| it.punct(at, ',') || it.punct(at, ';'));
    if let Some(report) = ternary(cursor.ahead(length), &|| cursor.ahead(whole())) {
        cursor.advance(whole());
        return Err(report);
    }
    let slip = slips::entry(cursor.ahead(length));
    if let Some(report) = slip.or_else(|| slips::connective(cursor.ahead(length))) {
        cursor.advance(length);
        return Err(report);
    }
    let law = raw::functions(raw::plain_within(cursor.ahead(length).to_vec()));
    let tokens: TokenStream = law.iter().cloned().collect();
    let mut unread = 0;
    let parser = |input: ParseStream<'_>| {
        let parsed = input.parse::<Expr>();
        // Read to the end even after a failure: tokens left unread would replace the error by a vaguer one.
        unread = input.parse::<TokenStream>()?.into_iter().count();
        parsed
    };
    let parsed = parser.parse2(tokens);
    cursor.advance(length - unread.min(length));
    parsed.map_err(|failure| {
        if let Some(report) = slips::without_zero(&law) {
            return report;
        }
        let slip = without_braces(&law).or_else(|| slips::side_by_side(&law));
        let slip = slip.or_else(|| keyword(&law)).or_else(|| slips::bars(&law));
        let slip = slip
            .or_else(|| chained(&law))
            .or_else(|| slips::in_braces(&law));
        slip.unwrap_or_else(|| translated(cursor, &failure, unread == 0))
    })
}

/// Whether an expression cannot go past this offset.
///
/// Without the words that begin a statement or a field, each law of a body without separators would be handed the
/// rest of the body.
fn ends(cursor: &Cursor, offset: usize) -> bool {
    let colon = |offset| cursor.punct(offset, ':');
    let field =
        offset > 0 && cursor.ident(offset).is_some() && colon(offset + 1) && !colon(offset + 2);
    // A digit in the first place is the value, whatever follows it.
    let statement = (offset > 0 || cursor.ident(0).is_some()) && opens(cursor, offset);
    cursor.punct(offset, ',') || cursor.punct(offset, ';') || field || statement
}

/// A keyword of Rust in a law that cannot be read, where a name was probably meant.
fn keyword(law: &[TokenTree]) -> Option<Box<Diagnostic>> {
    law.iter().find_map(|token| match token {
        TokenTree::Group(group) => {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            keyword(&inside)
        }
        TokenTree::Ident(word) => {
            let text = word.to_string();
            let is_known = ["_", "if", "else", "true", "false"].contains(&text.as_str());
            let message = format!("expected an expression, found the keyword `{text}`");
            let report = || error(codes::SYNTAX, word.span(), message);
            (words::is_reserved(&text) && !is_known)
                .then(|| Box::new(report().help(words::another_name(&text))))
        }
        _ => None,
    })
}

/// Tells in our words, and at a token of the law, what `syn` could not read.
fn translated(cursor: &Cursor, failure: &syn::Error, ended: bool) -> Box<Diagnostic> {
    const END: &str = "unexpected end of input";
    let text = failure.to_string();
    let text = text
        .lines()
        .next()
        .unwrap_or_default()
        .trim_end_matches('.');
    let cut = text.starts_with(END);
    let wanted = text.trim_start_matches(END).trim_start_matches(", ");
    let wanted = if wanted.is_empty() || wanted.starts_with("expected one of") {
        "expected an expression"
    } else {
        wanted
    };
    // Past its last token `syn` marks the whole macro call, and only the text of a span tells that from a token.
    if format!("{:?}", failure.span()) == format!("{:?}", Span::call_site()) {
        let message = format!(
            "{wanted} after {}, found {}",
            cursor.previous(),
            cursor.found()
        );
        return Box::new(error(codes::SYNTAX, cursor.last_span(), message));
    }
    if cut {
        let message = format!("{wanted} before the closing bracket");
        return Box::new(error(codes::SYNTAX, failure.span(), message));
    }
    // After a group the mistake may lie inside it, and only `syn` knows where.
    let inside = matches!(cursor.since(0).last(), Some(TokenTree::Group(_)));
    if ended || inside || !wanted.starts_with("expected") {
        return Box::new(error(codes::SYNTAX, failure.span(), wanted));
    }
    cursor.failure(codes::SYNTAX, format!("{wanted}, found {}", cursor.found()))
}
