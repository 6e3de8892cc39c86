//! Where a new statement begins, and how to get there after a mistake.

use proc_macro2::{Delimiter, Ident, Span, TokenTree};

use super::cursor::{Cursor, Parsed};
use super::words;
use crate::diagnostics::{Code, Diagnostic, Diagnostics, error};

/// How deep the names of a broken statement are looked for: a loop, a junction, an element.
const DEPTH: usize = 3;

/// Where mistakes go, and the names that were lost to them.
pub(super) struct Sink<'a> {
    diagnostics: &'a mut Diagnostics,
    lost: Vec<Ident>,
}

impl<'a> Sink<'a> {
    /// An empty sink in front of the stage's.
    pub(super) fn new(diagnostics: &'a mut Diagnostics) -> Self {
        Self {
            diagnostics,
            lost: Vec::new(),
        }
    }

    /// Reports a mistake after which reading goes on.
    #[allow(clippy::boxed_local, reason = "rules return their mistake in a box")]
    pub(super) fn report(&mut self, mistake: Box<Diagnostic>) {
        self.diagnostics.report(*mistake);
    }

    /// Reports a mistake that needs no more than its message.
    pub(super) fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.diagnostics.report(error(code, span, message));
    }

    /// Remembers the names that these tokens would have declared.
    pub(super) fn lose(&mut self, tokens: &[TokenTree]) {
        declared(tokens, DEPTH, &mut self.lost);
    }

    /// Hands over the names lost so far.
    pub(super) fn lost(&mut self) -> Vec<Ident> {
        std::mem::take(&mut self.lost)
    }
}

/// Whether a statement begins at this offset, whatever came before it.
///
/// A word followed by a word, or a digit followed by a word, stands in no expression.
pub(super) fn opens(cursor: &Cursor, offset: usize) -> bool {
    let Some(next) = cursor.ident(offset + 1) else {
        return false;
    };
    match cursor.ident(offset) {
        Some(word) => {
            let word = word.to_string();
            words::STATEMENTS.contains(&word.as_str()) || words::LATER.contains(&word.as_str())
        }
        None => cursor.junction_digit(offset) && !words::is_reserved(&next.to_string()),
    }
}

/// Whether a statement may begin here, given that the last one was complete.
pub(super) fn may_open(cursor: &Cursor) -> bool {
    if opens(cursor, 0) || cursor.punct(0, '#') {
        return true;
    }
    let Some(word) = cursor.ident(0) else {
        return false;
    };
    let element = cursor.ident(1).is_some() && words::element(&word.to_string()).is_some();
    element || cursor.arrow(1) || cursor.punct(1, ':')
}

/// Ends a statement at its `;`.
///
/// A `;` that is only forgotten costs nothing but its error: the statement is kept, and the next one is read.
pub(super) fn finish(cursor: &mut Cursor, sink: &mut Sink<'_>, expected: &str) -> Parsed<()> {
    if cursor.take_punct(';') {
        return Ok(());
    }
    if !cursor.ended() && !may_open(cursor) {
        return Err(cursor.expected(expected));
    }
    let message = format!(
        "expected `;` after {}, found {}",
        cursor.previous(),
        cursor.found()
    );
    sink.error(crate::codes::SYNTAX, cursor.last_span(), message);
    Ok(())
}

/// Steps to where the next statement begins, after the one from `start` failed.
pub(super) fn synchronize(cursor: &mut Cursor, start: usize) {
    while let Some(token) = cursor.peek(0) {
        if cursor.position() > start && opens(cursor, 0) {
            return;
        }
        let brace =
            matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
        if cursor.take_punct(';') {
            return;
        }
        cursor.advance(1);
        if brace && !continues(cursor) {
            return;
        }
    }
}

/// Whether the token after a brace belongs to the same statement.
fn continues(cursor: &Cursor) -> bool {
    match cursor.peek(0) {
        Some(TokenTree::Punct(punct)) => punct.as_char() != '#',
        Some(TokenTree::Group(group)) => group.delimiter() == Delimiter::Parenthesis,
        Some(TokenTree::Ident(word)) => word == "else",
        Some(TokenTree::Literal(_)) | None => false,
    }
}

/// Collects the names that tokens declare, as far as can be told without understanding them.
fn declared(tokens: &[TokenTree], depth: usize, names: &mut Vec<Ident>) {
    let outermost = depth == DEPTH;
    let attributes = tokens
        .iter()
        .step_by(2)
        .take_while(|token| is_hash(token))
        .count()
        * 2;
    for (at, token) in tokens.iter().enumerate() {
        let first = outermost && at == attributes;
        let name = match (token, tokens.get(at + 1), tokens.get(at + 2)) {
            (TokenTree::Ident(word), Some(TokenTree::Ident(name)), _) => {
                declares(&word.to_string(), first).then_some(name)
            }
            (TokenTree::Literal(literal), Some(TokenTree::Ident(name)), _) => {
                matches!(literal.to_string().as_str(), "0" | "1").then_some(name)
            }
            (TokenTree::Ident(name), Some(TokenTree::Punct(colon)), Some(TokenTree::Ident(_))) => {
                (first && colon.as_char() == ':').then_some(name)
            }
            _ => None,
        };
        if let Some(name) = name.filter(|name| !words::is_reserved(&name.to_string())) {
            names.push(name.clone());
        }
        let TokenTree::Group(group) = token else {
            continue;
        };
        if depth > 0 && group.delimiter() == Delimiter::Brace {
            let inner: Vec<TokenTree> = group.stream().into_iter().collect();
            declared(&inner, depth - 1, names);
        }
    }
}

/// Whether the word after this one is a name that a statement declares; the first word may be misspelt.
fn declares(word: &str, first: bool) -> bool {
    let nameless = word == "causality" || words::LATER.contains(&word);
    let known = words::STATEMENTS.contains(&word) || words::element(word).is_some();
    let near = || words::nearest(word, &words::element_names()).is_some();
    !nameless && (first || known || near())
}

fn is_hash(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == '#')
}
