//! Models and components.

use proc_macro2::{Delimiter, Group, Ident, TokenStream};
use syn::Visibility;
use syn::parse::Parser;

use super::ast::{Component, Item, Model, Port, Source, Statement};
use super::attributes::Attributes;
use super::cursor::{Cursor, Parsed};
use super::elsewhere::imported;
use super::recovery::Sink;
use super::statements::body;
use super::{inclusions, words};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};

/// Reads everything.
pub(super) fn source(tokens: TokenStream, sink: &mut Sink<'_>) -> Source {
    let mut cursor = Cursor::new(tokens);
    let mut items = Vec::new();
    loop {
        while cursor.take_punct(';') {}
        if cursor.ended() {
            return Source {
                items,
                library: Vec::new(),
            };
        }
        let start = cursor.position();
        match item(&mut cursor, sink) {
            Ok(item) => items.push(item),
            Err(error) => {
                sink.report(error);
                next_item(&mut cursor, start);
            }
        }
    }
}

/// Reads one model or component. It fails only before its name is known: from there on, what uses the name is
/// spared a second error.
fn item(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Parsed<Item> {
    let start = cursor.position();
    let attributes = Attributes::read(cursor, sink)?;
    let place = cursor.span();
    let visibility = visibility(cursor)?;
    if cursor.ident(0).is_some_and(|word| word == words::INCLUDE) {
        return Err(inclusions::refused(cursor, start));
    }
    let public = !matches!(visibility, Visibility::Inherited);
    match keyword(cursor, public, sink)? {
        "component" => {
            if public {
                let message = "expected `component` without a visibility: it is known in this macro call only";
                sink.error(codes::SYNTAX, place, message);
            }
            let name = cursor.name("the name of the component after `component`")?;
            Ok(Item::Component(component(cursor, attributes, name, sink)))
        }
        _ => {
            let name = cursor.name("the name of the model after `model`")?;
            Ok(Item::Model(model(
                cursor, attributes, visibility, name, sink,
            )))
        }
    }
}

/// Reads `pub` and the like, when it stands here.
fn visibility(cursor: &mut Cursor) -> Parsed<Visibility> {
    if cursor.ident(0).is_none_or(|word| word != "pub") {
        return Ok(Visibility::Inherited);
    }
    let start = cursor.position();
    cursor.advance(1);
    cursor.take_group(Delimiter::Parenthesis);
    let tokens: TokenStream = cursor.since(start).iter().cloned().collect();
    <Visibility as syn::parse::Parse>::parse
        .parse2(tokens)
        .map_err(|_| {
            Box::new(error(
                codes::SYNTAX,
                cursor.last_span(),
                "expected `pub`, `pub(crate)` or `pub(super)`",
            ))
        })
}

/// Reads `model` or `component`, or what is near enough to one of them.
fn keyword(cursor: &mut Cursor, public: bool, sink: &mut Sink<'_>) -> Parsed<&'static str> {
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    let exact = words::ITEMS.iter().find(|item| **item == word).copied();
    if let Some(item) = exact {
        cursor.advance(1);
        return Ok(item);
    }
    let error = *cursor.expected(if public {
        "`model` after `pub`"
    } else {
        "`model` or `component`"
    });
    // A word, a name and a group is an item whatever the word: its name must not be lost to a slip of the finger.
    let shaped = cursor.ident(1).is_some()
        && matches!(cursor.peek(2), Some(proc_macro2::TokenTree::Group(_)));
    match words::ITEMS
        .iter()
        .copied()
        .find(|item| words::nearest(&word, &[item]).is_some())
    {
        Some(near) if shaped => {
            sink.report(Box::new(error.help(format!("did you mean `{near}`?"))));
            cursor.advance(1);
            Ok(near)
        }
        Some(near) => Err(Box::new(error.help(format!("did you mean `{near}`?")))),
        None => Err(elsewhere(cursor, error, &word)),
    }
}

/// What stands here is no item; perhaps it is a statement.
fn elsewhere(cursor: &Cursor, error: Diagnostic, word: &str) -> Box<Diagnostic> {
    if let Some(help) = imported(cursor) {
        return Box::new(error.help(help));
    }
    let statement = words::STATEMENTS.contains(&word)
        || words::element(word).is_some()
        || cursor.junction_digit(0)
        || cursor.arrow(1)
        || cursor.punct(1, ':');
    Box::new(if statement {
        error.help("statements stand inside braces: `model Name { … }`")
    } else {
        error
    })
}

/// Types that the generated code calls by these names: its own parameters, and those of Rust.
const TAKEN: [&str; 20] = [
    "T", "L", "E", "f64", "f32", "usize", "isize", "u8", "u16", "u32", "u64", "u128", "i8", "i16",
    "i32", "i64", "i128", "bool", "char", "str",
];

fn model(
    cursor: &mut Cursor,
    attributes: Attributes,
    visibility: Visibility,
    mut name: Ident,
    sink: &mut Sink<'_>,
) -> Model {
    let mut written = None;
    if TAKEN.iter().any(|taken| name == taken) {
        let message =
            format!("a model cannot be called `{name}`: the code made of it calls another type so");
        let report = error(codes::DUPLICATE_NAME, name.span(), message);
        sink.report(Box::new(report.help("give it another name")));
        // What stands in for it must not have that name either.
        let other = Ident::new(&format!("Model{name}"), name.span());
        written = Some(std::mem::replace(&mut name, other));
    }
    let statements = braces(cursor, &format!("`{{` after `model {name}`"), sink);
    let Attributes {
        documentation,
        derivative,
    } = attributes;
    Model {
        documentation,
        derivative,
        visibility,
        name,
        written,
        statements,
    }
}

fn component(
    cursor: &mut Cursor,
    attributes: Attributes,
    name: Ident,
    sink: &mut Sink<'_>,
) -> Component {
    let mut ports = Some(Vec::new());
    let mut wanted = format!("`(` after `component {name}`");
    if let Some(group) = cursor.take_group(Delimiter::Parenthesis) {
        ports = ports_in(&group, sink);
        wanted = "`{` after the ports".to_owned();
    } else if cursor.group(0, Delimiter::Brace).is_some() {
        let error = *cursor.expected(&wanted);
        sink.report(Box::new(error.help(format!(
            "the ports stand in parentheses: `component {name}(port a[3], port b[3]) {{ … }}`"
        ))));
        ports = None;
    }
    let mut statements = braces(cursor, &wanted, sink);
    if ports.is_none() {
        statements.push(Statement::Broken(None));
    }
    let ports = ports.unwrap_or_default();
    let Attributes {
        documentation,
        derivative,
    } = attributes;
    Component {
        documentation,
        derivative,
        library: false,
        name,
        ports,
        statements,
    }
}

/// Reads the statements in braces, stepping over what wrongly stands before them.
fn braces(cursor: &mut Cursor, wanted: &str, sink: &mut Sink<'_>) -> Vec<Statement> {
    if let Some(group) = cursor.take_group(Delimiter::Brace) {
        return body(&group, sink);
    }
    sink.report(cursor.expected(wanted));
    let start = cursor.position();
    while !cursor.ended() && !item_opens(cursor) && cursor.group(0, Delimiter::Brace).is_none() {
        cursor.advance(1);
    }
    let mut statements = match cursor.take_group(Delimiter::Brace) {
        Some(group) => body(&group, sink),
        None => Vec::new(),
    };
    debug_assert!(cursor.position() >= start);
    statements.push(Statement::Broken(None));
    statements
}

/// Reads `port a[3], port b`; nothing when one of them cannot be read, since an instance's junctions could not be
/// told apart then.
fn ports_in(group: &Group, sink: &mut Sink<'_>) -> Option<Vec<Port>> {
    let mut cursor = Cursor::inside(group);
    let (mut ports, mut whole) = (Vec::new(), true);
    while !cursor.ended() {
        match port(&mut cursor, sink) {
            Ok(port) => ports.push(port),
            Err(error) => {
                sink.report(error);
                whole = false;
                let length = cursor.length_until(|cursor, offset| cursor.punct(offset, ','));
                cursor.advance(length + 1);
            }
        }
    }
    whole.then_some(ports)
}

/// Reads `port a[3]` or `port 1 a[3]`, and the comma after it.
fn port(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Parsed<Port> {
    Attributes::read(cursor, sink)?.unmarked("a port", sink);
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    if word != "port" {
        let mut error = *cursor.expected("`port`");
        if words::nearest(&word, &["port"]).is_some() {
            error = error.help("did you mean `port`?");
        } else if !word.is_empty() {
            error = error.help(format!("a port is written `port {word}`"));
        }
        return Err(Box::new(error));
    }
    cursor.advance(1);
    let kind = cursor.take_junction_kind();
    let name = cursor.name(&format!("the name of the port after {}", cursor.previous()))?;
    let dimension = cursor.dimension()?.unwrap_or(1);
    if !cursor.ended() && !cursor.take_punct(',') {
        return Err(cursor.expected(&format!("`,` or `)` after {}", cursor.previous())));
    }
    Ok(Port {
        kind,
        name,
        dimension,
    })
}

/// Whether an item begins here.
fn item_opens(cursor: &Cursor) -> bool {
    let Some(word) = cursor.ident(0) else {
        return cursor.punct(0, '#');
    };
    word == "pub" || (cursor.ident(1).is_some() && words::ITEMS.iter().any(|item| word == item))
}

/// Steps to the next item after the one from `start` failed, however many statements lie between: they all have the
/// same mistake.
fn next_item(cursor: &mut Cursor, start: usize) {
    if cursor.position() == start {
        cursor.advance(1);
    }
    while !cursor.ended() && !item_opens(cursor) {
        cursor.advance(1);
    }
}
