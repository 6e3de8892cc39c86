//! Where a new statement begins, and how to get there after a mistake.

use proc_macro2::{Delimiter, Ident, Span, TokenTree};

use super::cursor::{Cursor, Parsed};
use super::{slips, words};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, error};

/// How deep the names of a broken statement are looked for: a loop, a junction, an element.
const DEPTH: usize = 3;

/// How deep loops and `if`s may nest, far above any scene, far below where reading them could exhaust the stack.
pub(super) const DEEPEST_BLOCK: usize = 8;

/// Where mistakes go, and the names that were lost to them.
pub(super) struct Sink<'a> {
    diagnostics: &'a mut Diagnostics,
    lost: Vec<Ident>,
    /// How many loops and `if`s are open.
    blocks: usize,
}

impl<'a> Sink<'a> {
    /// An empty sink in front of the stage's.
    pub(super) fn new(diagnostics: &'a mut Diagnostics) -> Self {
        Self {
            diagnostics,
            lost: Vec::new(),
            blocks: 0,
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

    /// Reads the inside of a loop or an `if`; none if it lies deeper than they may nest.
    pub(super) fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.blocks == DEEPEST_BLOCK {
            return None;
        }
        self.blocks += 1;
        let inside = read(self);
        self.blocks -= 1;
        Some(inside)
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
    if cursor.ident(offset).is_some() {
        return begins(cursor, offset);
    }
    // In `1 param x` the digit ends a statement, and the word begins the next; in `1 then x` it ends a condition.
    cursor.junction_digit(offset)
        && next != words::THEN
        && !words::is_reserved(&next.to_string())
        && !begins(cursor, offset + 1)
}

/// Whether one of the words that begin a statement, and a name, stand at this offset.
fn begins(cursor: &Cursor, offset: usize) -> bool {
    let word = cursor
        .ident(offset)
        .map(ToString::to_string)
        .unwrap_or_default();
    let known = words::STATEMENTS.contains(&word.as_str()) || word == words::INCLUDE;
    known && cursor.ident(offset + 1).is_some()
}

/// Whether a statement may begin here, given that the last one was complete.
pub(super) fn may_open(cursor: &Cursor) -> bool {
    if opens(cursor, 0) || cursor.punct(0, '#') {
        return true;
    }
    let Some(word) = cursor.ident(0) else {
        return false;
    };
    // The statements whose first word stands in expressions too, or is followed by one.
    if word == "gravity" || word == "if" {
        return true;
    }
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
        let mut error = *cursor.expected(expected);
        if matches!(cursor.last(), Some(TokenTree::Literal(_))) {
            error.helps.extend(slips::behind_value(cursor));
        }
        return Err(Box::new(error));
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
    let attributes = 2 * tokens
        .iter()
        .step_by(2)
        .take_while(|token| is_hash(token))
        .count();
    let outermost = depth == DEPTH;
    let nameless = outermost
        && matches!(tokens.get(attributes), Some(TokenTree::Ident(word)) if is_nameless(word));
    for (at, token) in tokens.iter().enumerate() {
        if !nameless && let Some(name) = name_at(&tokens[at..], outermost && at == attributes) {
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

/// The name that the first of these tokens declares; the first word of a statement may be misspelt.
fn name_at(tokens: &[TokenTree], first: bool) -> Option<&Ident> {
    let name = match tokens {
        [TokenTree::Ident(word), TokenTree::Ident(name), ..] => {
            let word = word.to_string();
            let known =
                words::STATEMENTS.contains(&word.as_str()) || words::element(&word).is_some();
            let near = || words::nearest(&word, &words::element_names()).is_some();
            (first || known || near()).then_some(name)
        }
        [TokenTree::Literal(digit), TokenTree::Ident(name), ..] => {
            matches!(digit.to_string().as_str(), "0" | "1").then_some(name)
        }
        [
            TokenTree::Ident(name),
            TokenTree::Punct(colon),
            TokenTree::Ident(_),
            ..,
            // Even a keyword, which is told for that.
        ] if first && colon.as_char() == ':' => return Some(name),
        _ => None,
    };
    name.filter(|name| !words::is_reserved(&name.to_string()))
}

/// Whether a statement that begins with this word declares no name of its own.
fn is_nameless(word: &Ident) -> bool {
    ["causality", "gravity", "for", "if", "close", "assert"]
        .iter()
        .any(|nameless| word == nameless)
        || word == words::INCLUDE
}

fn is_hash(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == '#')
}
