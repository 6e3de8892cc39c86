//! Elements and the words in their braces.

use proc_macro2::{Delimiter, Group, Ident, Span};

use super::ast::{Element, ElementKind, Field};
use super::attributes::Attributes;
use super::cursor::{Cursor, Parsed};
use super::expressions::expression;
use super::recovery::Sink;
use super::{elsewhere, equations, slips, words};
use crate::codes;
use crate::diagnostics::Diagnostic;

/// Words whose values read the variables of their element.
const LAWS: [&str; 4] = ["effort", "flow", "energy", "momentum"];

/// The element whose kind stands `offset` places ahead.
pub(super) fn kind(cursor: &Cursor, offset: usize) -> Option<ElementKind> {
    words::element(&cursor.ident(offset)?.to_string())
}

/// Reads `R name[n] { … }`, given that a kind stands here.
pub(super) fn element(
    cursor: &mut Cursor,
    kind: ElementKind,
    derivative: Option<Span>,
    sink: &mut Sink<'_>,
) -> Parsed<Element> {
    let spelling = words::element_name(kind);
    let span = cursor.span();
    cursor.advance(1);
    let name = cursor.name(&format!("the name of the element after `{spelling}`"));
    let name = name.map_err(|report| {
        let help = slips::without_colon(cursor, spelling);
        let help = help.or_else(|| slips::size_first(cursor, spelling));
        with_help(report, help.or_else(|| slips::unnamed(cursor, spelling)))
    })?;
    let dimension = cursor.dimension()?;
    let Some(group) = cursor.take_group(Delimiter::Brace) else {
        let brackets = if dimension.is_none() { "`[` or " } else { "" };
        let error = *cursor.expected(&format!("{brackets}`{{` after `{spelling} {name}`"));
        let size = dimension.map_or_else(String::new, |dimension| format!("[{dimension}]"));
        let law = words::law_words(kind)[0];
        return Err(Box::new(error.help(format!(
            "the law of an element stands in braces: `{spelling} {name}{size} {{ {law}: … }}`"
        ))));
    };
    let fields = fields(&group, &format!("{spelling} {name}"), sink);
    let fields = fields.map_err(|mut report| {
        if let Some(help) = equations::law(&group, kind) {
            report.helps = vec![help];
            return report;
        }
        let help = slips::without_word(&group, words::law_words(kind)[0]);
        with_help(report, help)
    })?;
    Ok(Element {
        derivative,
        kind,
        span,
        name,
        dimension,
        fields,
    })
}

/// Reads `word: value, word`; `owner` is whose words they are.
///
/// A missing comma and a repeated word are reported, and reading goes on.
pub(super) fn fields(group: &Group, owner: &str, sink: &mut Sink<'_>) -> Parsed<Vec<Field>> {
    let mut cursor = Cursor::inside(group);
    let mut fields: Vec<Field> = Vec::new();
    loop {
        Attributes::read(&mut cursor, sink)?.unmarked("a word of an element", sink);
        if cursor.ended() {
            return Ok(fields);
        }
        let name = cursor.name(&format!("a word of `{owner}`"))?;
        let value = if cursor.take_punct(':') {
            Some(expression(&mut cursor, &format!("the value of `{name}`"))?)
        } else {
            None
        };
        let bare = value.is_none();
        let is_law = LAWS.iter().any(|law| name == law);
        if fields.iter().any(|field| field.name == name) {
            sink.error(
                codes::FIELD_REPEATED,
                name.span(),
                format!("`{name}` is given twice in `{owner}`"),
            );
        } else {
            fields.push(Field { name, value });
        }
        if !cursor.ended() && !cursor.take_punct(',') {
            let error = unseparated(&cursor, bare, is_law);
            if cursor.take_punct(';') {
                sink.report(error);
                continue;
            }
            if bare || cursor.ident(0).is_none() {
                return Err(error);
            }
            sink.report(error);
            // What belongs to the value is no word.
            if !slips::behind_value(&cursor).is_empty() {
                cursor.advance(cursor.length_until(|it, at| it.punct(at, ',')));
                cursor.take_punct(',');
            }
        }
    }
}

/// Neither the end nor a comma follows a word or its value.
fn unseparated(cursor: &Cursor, bare: bool, is_law: bool) -> Box<Diagnostic> {
    let wanted = if bare {
        "`:`, `,` or `}`"
    } else {
        "`,` or `}`"
    };
    let mut error = *cursor.expected(&format!("{wanted} after {}", cursor.previous()));
    if bare && cursor.punct(0, '=') {
        error = error.help("a value follows a colon: `word: value`");
    }
    if cursor.punct(0, ';') {
        error = error.help("commas stand between the words of an element");
    }
    if !bare {
        error.helps.extend(match is_law {
            true => slips::behind_law(cursor),
            false => slips::behind_value(cursor),
        });
    }
    Box::new(error)
}

/// Reads the one-ports in a junction's braces.
///
/// One that cannot be read is reported and its name remembered; the others are kept.
pub(super) fn one_ports(group: &Group, junction: &Ident, sink: &mut Sink<'_>) -> Vec<Element> {
    let mut cursor = Cursor::inside(group);
    let mut elements = Vec::new();
    loop {
        while cursor.take_punct(',') || cursor.take_punct(';') {}
        if cursor.ended() {
            return elements;
        }
        let start = cursor.position();
        match one_port(&mut cursor, junction, sink) {
            Ok(element) => elements.push(element),
            Err(error) => {
                sink.report(error);
                next_element(&mut cursor, start);
                sink.lose(cursor.since(start));
            }
        }
    }
}

/// Reads one element of a junction's braces.
fn one_port(cursor: &mut Cursor, junction: &Ident, sink: &mut Sink<'_>) -> Parsed<Element> {
    let attributes = Attributes::read(cursor, sink)?;
    if let Some(kind) = kind(cursor, 0) {
        return element(cursor, kind, attributes.derivative, sink);
    }
    if let Some(help) = slips::no_element(cursor, junction) {
        return Err(Box::new((*cursor.expected("an element")).help(help)));
    }
    let mut error = no_element(cursor, "an element");
    if cursor.arrow(1) {
        error = error.help(
            "a chain of bonds stands outside the junction's braces, as a statement of its own",
        );
    }
    Err(Box::new(error))
}

fn with_help(mut report: Box<Diagnostic>, help: Option<String>) -> Box<Diagnostic> {
    report.helps.extend(help);
    report
}

/// What stands here is the name of no element.
pub(super) fn no_element(cursor: &Cursor, what: &str) -> Diagnostic {
    let mut error = *cursor.expected(what);
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    if let Some(help) = elsewhere::element(&word) {
        return error.help(help);
    }
    match words::nearest(&word, &words::element_names()) {
        Some(near) => error = error.help(format!("did you mean `{near}`?")),
        None => {
            error = error.note(format!(
                "the elements are {}",
                words::element_listing().replace(" or ", " and ")
            ))
        }
    }
    error
}

/// Steps to the next element after the one from `start` failed.
fn next_element(cursor: &mut Cursor, start: usize) {
    while !cursor.ended() {
        let opens = kind(cursor, 0).is_some() && cursor.ident(1).is_some();
        if cursor.position() > start && (opens || cursor.punct(0, ';')) {
            return;
        }
        let brace = cursor.group(0, Delimiter::Brace).is_some();
        cursor.advance(1);
        // The junctions of an instance belong to it.
        if brace && cursor.group(0, Delimiter::Parenthesis).is_none() {
            return;
        }
    }
}
