//! Files that are included where they cannot be, or not as it is written.

use proc_macro2::{Delimiter, TokenTree};
use syn::LitStr;

use super::cursor::Cursor;
use crate::codes;
use crate::diagnostics::Diagnostic;

/// A path as an example.
const EXAMPLE: &str = "joints/mine.mbg";

/// A file is included behind an item, or in one.
pub(super) fn misplaced(cursor: &Cursor) -> Box<Diagnostic> {
    let message = "a file is included before the first model and component";
    let help = format!(
        "{} at the top, with the path from the root of the crate",
        written(EXAMPLE)
    );
    Box::new((*cursor.failure(codes::INCLUDE, message)).help(help))
}

/// Why `include`, which stands here, is none of the statements at the top, given where what belongs to it starts.
pub(super) fn refused(cursor: &mut Cursor, start: usize) -> Box<Diagnostic> {
    let marked = cursor.since(start).first().cloned();
    let include = cursor.position();
    cursor.advance(1);
    let path = path(cursor);
    let help = written(path.as_deref().unwrap_or(EXAMPLE));
    if let Some(mark) = marked {
        let found = match mark {
            TokenTree::Punct(_) => "an attribute or a documentation comment".to_owned(),
            word => format!("`{word}`"),
        };
        cursor.step_back(include);
        let message = format!("expected `include` alone, found {found} before it");
        return Box::new((*cursor.failure(codes::INCLUDE, message)).help(help));
    }
    let string = cursor.peek(0).is_some_and(|token| string(token).is_some());
    if !string {
        let wanted = "the path of a file between quotes after `include`";
        return Box::new((*cursor.expected_with(codes::INCLUDE, wanted)).help(help));
    }
    cursor.advance(1);
    if cursor.punct(0, ';') {
        cursor.step_back(include);
        return misplaced(cursor);
    }
    let message = format!(
        "expected `;` after {}, found {}",
        cursor.previous(),
        cursor.found()
    );
    let report = crate::diagnostics::error(codes::INCLUDE, cursor.last_span(), message);
    Box::new(report.help(help))
}

fn written(path: &str) -> String {
    format!("write `include {path:?};`")
}

/// The path that was meant, in a string of another kind, in parentheses, or without quotes.
fn path(cursor: &Cursor) -> Option<String> {
    if let Some(path) = cursor.peek(0).and_then(string) {
        return Some(path);
    }
    if cursor.punct(0, '!') {
        let inside = Cursor::inside(cursor.group(1, Delimiter::Parenthesis)?);
        return inside.peek(0).and_then(string);
    }
    if let Some(TokenTree::Literal(literal)) = cursor.peek(0) {
        let text = literal.to_string();
        let (_, text) = text.split_once('"')?;
        return Some(text.trim_end_matches(['"', '#']).to_owned());
    }
    let is_word = cursor.ident(0).is_some() && !cursor.punct(1, '!');
    let length = cursor.length_until(|it, at| it.punct(at, ';'));
    let steps: String = cursor
        .ahead(length)
        .iter()
        .map(ToString::to_string)
        .collect();
    let is_path = steps
        .chars()
        .all(|it| it.is_alphanumeric() || "/._-".contains(it));
    (is_word && is_path).then_some(steps)
}

/// The value of a string.
fn string(token: &TokenTree) -> Option<String> {
    let path: LitStr = syn::parse2(token.clone().into()).ok()?;
    Some(path.value())
}
