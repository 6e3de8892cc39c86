//! Instances and entries of matrices in the order and spelling of other languages, and what to type instead.

use proc_macro2::{Delimiter, Group, TokenTree};

use super::ast::{Reference, Segment};
use super::cursor::Cursor;
use super::{dump, elements};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};

/// The instance that was probably meant, whose parameters and junctions stand `offset` places ahead.
pub(super) fn ahead(cursor: &Cursor, offset: usize, name: &str, component: &str) -> Option<String> {
    let [braces, parentheses] = [Delimiter::Brace, Delimiter::Parenthesis].map(|delimiter| {
        let mut places = [offset, offset + 1].into_iter();
        places.find_map(|place| cursor.group(place, delimiter))
    });
    Some(written(name, component, braces, parentheses?))
}

/// What to type for the elements of a junction that stand apart from its declaration.
pub(super) fn apart(cursor: &Cursor, junction: &Reference, braces: &Group) -> Option<String> {
    let [
        Segment {
            name,
            selection: None,
        },
    ] = &junction.path[..]
    else {
        return None;
    };
    let inside = Cursor::inside(braces);
    let first = if inside.punct(0, '#') { 2 } else { 0 };
    let has_elements =
        elements::kind(&inside, first).is_some() && inside.ident(first + 1).is_some();
    let elements = dump::tokens(braces.stream());
    match cursor.declaration(name) {
        Some(declaration) if has_elements => Some(format!(
            "the elements of a junction stand in the braces of its declaration: `{declaration} {{ {elements} }}`"
        )),
        Some(_) => Some(format!(
            "`{name}` is a junction; an element there has a kind and a name of its own: `R name {{ {elements} }} -> {name};`"
        )),
        None if has_elements => Some(format!(
            "a junction has its digit before its name: `1 {name} {{ {elements} }}`"
        )),
        None => None,
    }
}

/// How an instance with these parameters and junctions is written.
pub(super) fn written(
    name: &str,
    component: &str,
    braces: Option<&Group>,
    parentheses: &Group,
) -> String {
    let ports = dump::tokens(parentheses.stream());
    let parameters = match braces.map(|group| dump::tokens(group.stream())) {
        Some(words) if !words.is_empty() => format!(" {{ {words} }}"),
        _ => String::new(),
    };
    format!("an instance is written `{name}: {component}{parameters} ({ports});`")
}

/// How many rows and columns of a matrix are written out.
const WRITTEN_OUT: usize = 4;

/// What declares the rows of a matrix as vectors, and the matrix of them for laws.
pub(super) fn by_rows(word: &str, name: &str, [rows, columns]: [usize; 2]) -> String {
    let end = if word == "input" { "" } else { " = …" };
    let row = |row: usize| format!("{word} {name}_{row}[{columns}]{end};");
    let entries = |row: usize| {
        let entry = |column: usize| format!("{name}_{row}[{column}]");
        format!("[{}]", listed(columns, entry, ", "))
    };
    let declared = listed(rows, row, " ");
    match word {
        "output" => declared,
        _ => format!("{declared} let {name} = [{}];", listed(rows, entries, ", ")),
    }
}

/// So many texts, of which the last stand for themselves where there are many.
fn listed(count: usize, text: impl Fn(usize) -> String, between: &str) -> String {
    let mut texts: Vec<String> = (0..count.min(WRITTEN_OUT)).map(text).collect();
    if count > WRITTEN_OUT {
        texts.push("…".to_owned());
    }
    texts.join(between)
}

/// What to type for an entry `m[0, 1]` among these tokens or in a group of theirs.
pub(super) fn entry(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    tokens.iter().enumerate().find_map(|(at, token)| {
        let TokenTree::Group(group) = token else {
            return None;
        };
        let inside: Vec<TokenTree> = group.stream().into_iter().collect();
        let before = at.checked_sub(1).map(|before| &tokens[before]);
        let indexes = matches!(before, Some(TokenTree::Ident(_) | TokenTree::Group(_)));
        let is_comma =
            |token: &TokenTree| matches!(token, TokenTree::Punct(mark) if mark.as_char() == ',');
        let comma = inside.iter().position(is_comma);
        match comma.filter(|_| indexes && group.delimiter() == Delimiter::Bracket) {
            Some(comma) => {
                let places: Vec<String> = inside
                    .split(is_comma)
                    .map(|place| format!("[{}]", dump::tokens(place.iter().cloned().collect())))
                    .collect();
                let report = error(
                    codes::SYNTAX,
                    inside[comma].span(),
                    "expected `]`, found `,`",
                );
                let help = format!(
                    "an entry of a matrix is taken from a row: `{}`",
                    places.concat()
                );
                Some(Box::new(report.help(help)))
            }
            None => entry(&inside),
        }
    })
}
