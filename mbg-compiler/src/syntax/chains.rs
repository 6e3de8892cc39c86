//! Chains of bonds, references to junctions, and instances of components.

use proc_macro2::{Delimiter, Group, Ident, Span, TokenTree};
use syn::Expr;

use super::alone::alone;
use super::ast::{Chain, ChainNode, Instance, Reference, Segment, Selection};
use super::attributes::Attributes;
use super::cursor::{Cursor, Parsed};
use super::elements::{element, fields, kind, no_element};
use super::expressions::{bounds, expression};
use super::recovery::{Sink, finish};
use super::{dump, elsewhere, library, signals, slips, words};
use crate::codes;
use crate::diagnostics::Diagnostic;

/// What may stand at either end of an arrow.
const NODE: &str = "a junction, a port or an element";

/// What to type for `a ->| b`, with the bar of a causal stroke.
const STROKES: &str = "strokes are found while compiling: a bond is written `a -> b`";

/// Reads `a -> R x { … } -> b;`, given the attributes before it.
pub(super) fn chain(
    cursor: &mut Cursor,
    derivative: Option<Span>,
    sink: &mut Sink<'_>,
) -> Parsed<Chain> {
    let start = cursor.position();
    let mut nodes = vec![node(cursor, derivative, NODE, sink)?];
    let mut arrows = Vec::new();
    while let Some(arrow) = cursor.take_arrow() {
        arrows.push(arrow);
        if cursor.punct(0, '|') {
            return Err(Box::new((*cursor.expected(NODE)).help(STROKES)));
        }
        let derivative = Attributes::read(cursor, sink)?.derivative;
        if let Some(help) = component_between(cursor, nodes.last()) {
            let wanted = format!("{NODE} after `->`");
            return Err(Box::new((*cursor.expected(&wanted)).help(help)));
        }
        nodes.push(node(
            cursor,
            derivative,
            &format!("{NODE} after `->`"),
            sink,
        )?);
    }
    if arrows.is_empty() {
        return Err(unbonded(cursor, &nodes[0], start));
    }
    if !cursor.punct(0, ';')
        && let Some(error) = slipped(cursor, nodes.last())
    {
        return Err(error);
    }
    finish(
        cursor,
        sink,
        &format!("`->` or `;` after {}", cursor.previous()),
    )?;
    Ok(Chain { nodes, arrows })
}

/// Reads a reference, or an element declared in place.
fn node(
    cursor: &mut Cursor,
    derivative: Option<Span>,
    what: &str,
    sink: &mut Sink<'_>,
) -> Parsed<ChainNode> {
    let behind = usize::from(cursor.punct(1, ':'));
    let named = cursor.ident(1 + behind).is_some() || cursor.group(1, Delimiter::Brace).is_some();
    if let Some(kind) = kind(cursor, 0)
        && named
    {
        return element(cursor, kind, derivative, sink).map(ChainNode::Element);
    }
    if let Some(span) = derivative {
        let message = format!(
            "expected an element after `#[derivative]`, found {}",
            cursor.found()
        );
        sink.error(codes::SYNTAX, span, message);
    }
    if cursor.junction_digit(0) && cursor.ident(1).is_some() {
        let help =
            "a junction is declared in a statement of its own, and its name stands in the chain";
        return Err(Box::new((*cursor.expected(what)).help(help)));
    }
    let is_element = |word: &Ident| elsewhere::element(&word.to_string()).is_some();
    let misspelt = cursor.ident(1).is_some()
        && (cursor.group(2, Delimiter::Brace).is_some()
            || cursor.group(3, Delimiter::Brace).is_some()
            || cursor.ident(0).is_some_and(is_element));
    if misspelt {
        return Err(Box::new(no_element(cursor, what)));
    }
    reference(cursor, what).map(ChainNode::Reference)
}

/// What to type for `a -> Component name { … } -> b;`, with a component of the library between bonds.
fn component_between(cursor: &Cursor, before: Option<&ChainNode>) -> Option<String> {
    let (component, name) = (cursor.ident(0)?, cursor.ident(1)?);
    if !library::names().any(|known| component == known) {
        return None;
    }
    let braces = cursor.group(2, Delimiter::Brace);
    let behind = 2 + usize::from(braces.is_some());
    let is_end = |it: &Cursor, at: usize| at > behind && it.arrow(at) || it.punct(at, ';');
    let length = cursor.length_until(is_end);
    let next = cursor.ahead(length).get(behind + 2..).unwrap_or_default();
    let next = cursor
        .arrow(behind)
        .then(|| dump::tokens(next.iter().cloned().collect()));
    let before = match before? {
        ChainNode::Reference(reference) => Some(dump::reference(reference)),
        ChainNode::Element(_) => None,
    };
    let ports: Vec<String> = [before, next].into_iter().flatten().collect();
    let (name, component) = (name.to_string(), component.to_string());
    let written = slips::statement(&name, &component, braces, &ports.join(", "));
    Some(format!(
        "a component takes its junctions in parentheses, in a statement of its own: `{written}`"
    ))
}

/// Nothing follows the first node of a chain, which begins at a place, but something that is no arrow.
fn unbonded(cursor: &Cursor, node: &ChainNode, start: usize) -> Box<Diagnostic> {
    if let Some(error) = slipped(cursor, Some(node)) {
        return error;
    }
    let wanted = match node {
        ChainNode::Reference(reference)
            if reference
                .path
                .iter()
                .all(|segment| segment.selection.is_none()) =>
        {
            match reference.path.len() {
                1 => "`->`, `.`, `[` or `:`",
                _ => "`->`, `.` or `[`",
            }
        }
        ChainNode::Reference(_) => "`->` or `.`",
        ChainNode::Element(_) => "`->`",
    };
    let mut error = cursor.expected(&format!("{wanted} after {}", cursor.previous()));
    if let ChainNode::Element(element) = node {
        error.helps = alone(cursor, element, start);
    }
    error
}

/// The usual slips where an arrow should stand, with what to type.
fn slipped(cursor: &Cursor, node: Option<&ChainNode>) -> Option<Box<Diagnostic>> {
    let wanted = format!("`->` after {}", cursor.previous());
    let found = cursor.found();
    let error = match found.as_str() {
        "`|`" => (*cursor.expected(&wanted)).help(STROKES),
        "`=>`" | "`-`" => (*cursor.expected(&wanted)).help("a bond is written `a -> b`"),
        "`<-`" | "`<`" => (*cursor.expected(&wanted))
            .help("a bond points where its power is positive: write `b -> a`"),
        "`=`" => match named(cursor, node) {
            Some(help) => (*cursor.expected("`:` after the name of the instance")).help(help),
            None => (*cursor.expected(&wanted)).help(assigned(node)),
        },
        "`{`" | "`(`" => match node {
            Some(ChainNode::Reference(reference)) => {
                let name = &reference.path.last()?.name;
                let law = cursor.group(0, Delimiter::Parenthesis);
                if let Some(help) = law.and_then(|law| slips::nameless(&name.to_string(), law)) {
                    return Some(Box::new((*cursor.expected(&wanted)).help(help)));
                }
                if let Some(help) = slips::ahead(cursor, 0, "name", &name.to_string()) {
                    return Some(Box::new((*cursor.expected(&wanted)).help(help)));
                }
                let braces = cursor.group(0, Delimiter::Brace);
                let help = braces.and_then(|braces| slips::apart(cursor, reference, braces));
                let element = || {
                    format!(
                        "an element is written `R {name} {{ … }}`, with its kind before its name"
                    )
                };
                (*cursor.expected(&wanted)).help(help.unwrap_or_else(element))
            }
            _ => return None,
        },
        _ => return None,
    };
    Some(Box::new(error))
}

/// What to type for a value that is given to what stands here.
fn assigned(node: Option<&ChainNode>) -> String {
    match node {
        Some(ChainNode::Reference(reference)) if reference.path.len() > 1 => {
            let last = &reference.path[reference.path.len() - 1].name;
            format!(
                "what is given to an element or an instance stands in its braces: `{{ …, {last}: … }}`"
            )
        }
        _ => "a value has a word before its name: `param x = …;` or `output x = …;`".to_owned(),
    }
}

/// What to type for `name = Component { … } (a, b);`; a component differs from a function by its capital.
fn named(cursor: &Cursor, node: Option<&ChainNode>) -> Option<String> {
    let (Some(ChainNode::Reference(reference)), Some(component)) = (node, cursor.ident(1)) else {
        return None;
    };
    let component = component.to_string();
    if !component.starts_with(char::is_uppercase) {
        return None;
    }
    slips::ahead(cursor, 2, &dump::reference(reference), &component)
}

/// Reads `links[k-1].rel[1..3]`.
pub(super) fn reference(cursor: &mut Cursor, what: &str) -> Parsed<Reference> {
    let start = cursor.span();
    let mut path = vec![segment(cursor, what)?];
    while cursor.take_punct('.') {
        let before = format!("a name after `{}.`", path[path.len() - 1].name);
        match segment(cursor, &before) {
            Ok(next) => path.push(next),
            Err(error)
                if cursor.ident(0).is_none()
                    && cursor
                        .peek(0)
                        .is_some_and(|token| matches!(token, TokenTree::Literal(_))) =>
            {
                return Err(Box::new(
                    (*error).help("a component by number stands in brackets: `name[0]`"),
                ));
            }
            Err(error) => return Err(error),
        }
    }
    let span = start.join(cursor.last_span()).unwrap_or(start);
    Ok(Reference { path, span })
}

/// Reads a name and what stands in brackets after it.
fn segment(cursor: &mut Cursor, what: &str) -> Parsed<Segment> {
    let name = cursor.name(what)?;
    let selection = cursor
        .take_group(Delimiter::Bracket)
        .map(|group| selection(&group))
        .transpose()?;
    Ok(Segment { name, selection })
}

/// Reads `0` or `1..3`, between brackets.
fn selection(group: &Group) -> Parsed<Selection> {
    let mut cursor = Cursor::inside(group);
    let value = expression(
        &mut cursor,
        "a component such as `0` or a range such as `1..3`",
    )?;
    if !cursor.ended() {
        let report = *cursor.expected(&format!("`]` after {}", cursor.previous()));
        let inside: Vec<TokenTree> = group.stream().into_iter().collect();
        return Err(Box::new(match slips::with_dots(&inside) {
            Some(help) => report.help(help),
            None => report,
        }));
    }
    let (start, end) = match value {
        Expr::Range(range) => {
            let (start, end) = bounds(range)?;
            (start, Some(end))
        }
        start => (start, None),
    };
    Ok(Selection { start, end })
}

/// Reads `name: Component { … } (a, b);`, given the mark before it.
pub(super) fn instance(
    cursor: &mut Cursor,
    derivative: Option<Span>,
    sink: &mut Sink<'_>,
) -> Parsed<Instance> {
    let name = cursor.name("the name of an instance")?;
    cursor.take_punct(':');
    let component = cursor.name(&format!("the name of a component after `{name}:`"))?;
    let braces = cursor.take_group(Delimiter::Brace);
    let arguments = match &braces {
        Some(group) => fields(group, &format!("{name}: {component}"), sink)?,
        None => Vec::new(),
    };
    if let Some(braces) = &braces
        && let Some(help) = elsewhere::ports(cursor, &name, &component, braces)
    {
        return Err(Box::new(cursor.expected("junctions alone").help(help)));
    }
    if let Some(help) = elsewhere::parameters(cursor, 0, &name, &component) {
        return Err(Box::new(
            (*cursor.expected(&format!("`{{` after `{component}`"))).help(help),
        ));
    }
    let Some(group) = cursor.take_group(Delimiter::Parenthesis) else {
        let wanted = if arguments.is_empty() {
            "`{` or `(`"
        } else {
            "`(`"
        };
        let mut error = *cursor.expected(&format!("{wanted} after {}", cursor.previous()));
        let block = signals::block(&component.to_string(), &name.to_string());
        let told = slips::setting(&name, &component).filter(|_| braces.is_none());
        error = if let Some(block) = told.or(block) {
            error.help(block)
        } else if words::element(&component.to_string()).is_some() {
            error.help(format!(
                "an element is written `{component} {name} {{ … }}`, without a colon"
            ))
        } else {
            let (name, component) = (name.to_string(), component.to_string());
            let written = slips::statement(&name, &component, braces.as_ref(), "a, b");
            error.help(format!(
                "the junctions for its ports stand in parentheses: `{written}`"
            ))
        };
        return Err(Box::new(error));
    };
    let connections = connections(&group)?;
    if arguments.is_empty() && cursor.group(0, Delimiter::Brace).is_some() {
        let error = *cursor.expected("`;` after the instance");
        let (name, component) = (name.to_string(), component.to_string());
        let braces = cursor.group(0, Delimiter::Brace);
        let help = slips::written(&name, &component, braces, &group);
        return Err(Box::new(error.help(help)));
    }
    finish(cursor, sink, "`;` after the instance")?;
    Ok(Instance {
        name,
        derivative,
        component,
        arguments,
        connections,
    })
}

/// Reads the junctions given for the ports.
fn connections(group: &Group) -> Parsed<Vec<Reference>> {
    let mut cursor = Cursor::inside(group);
    let mut connections = Vec::new();
    while !cursor.ended() {
        connections.push(reference(&mut cursor, "a junction for a port")?);
        if !cursor.ended() && !cursor.take_punct(',') {
            return Err(cursor.expected(&format!("`,` or `)` after {}", cursor.previous())));
        }
    }
    Ok(connections)
}
