//! The tree as plain text, for tests and for people.

use std::fmt::{self, Write};

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::{Attribute, Expr, ExprLit, Lit, Meta, MetaNameValue, Visibility};

use super::ast::{
    Chain, ChainNode, Choice, Closure, Component, Conditional, Element, Field, Instance, Item,
    Junction, Loop, Model, Reference, Segment, Selection, Source, Statement, Unit,
};
use super::words;

/// The whole tree, one statement or element a line.
///
/// Equal trees give equal text, whichever compiler they came through.
#[must_use]
pub fn dump(source: &Source) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = source.items.iter().try_for_each(|item| match item {
        Item::Model(model) => write_model(&mut text, model),
        Item::Component(component) => write_component(&mut text, component),
    });
    text
}

/// An expression as a person would type it.
#[must_use]
pub fn expression(expression: &Expr) -> String {
    tokens(expression.to_token_stream())
}

/// More components than these are not written out in a message.
const MOST_PARTS: usize = 6;

/// The list of a vector's components, each the same if only one is given; none where it would be long.
#[must_use]
pub fn column(value: &Expr, size: usize) -> Option<String> {
    let text = expression(value);
    if matches!(value, Expr::Array(_)) {
        return Some(text);
    }
    let parts = vec![text; size.min(MOST_PARTS)];
    (size <= MOST_PARTS).then(|| format!("[{}]", parts.join(", ")))
}

/// Tokens as a person would write them.
#[must_use]
pub fn tokens(tokens: TokenStream) -> String {
    let mut text = String::new();
    spell(tokens, &mut text);
    text
}

fn write_model(text: &mut String, model: &Model) -> fmt::Result {
    let mut visibility = String::new();
    spell(model.visibility.to_token_stream(), &mut visibility);
    if !matches!(model.visibility, Visibility::Inherited) {
        visibility.push(' ');
    }
    write_documentation(text, "", &model.documentation)?;
    writeln!(
        text,
        "{visibility}model {}{}",
        model.name,
        mark(model.derivative.is_some())
    )?;
    write_statements(text, &model.statements)
}

fn write_component(text: &mut String, component: &Component) -> fmt::Result {
    write_documentation(text, "", &component.documentation)?;
    writeln!(
        text,
        "component {}{}",
        component.name,
        mark(component.derivative.is_some())
    )?;
    for port in &component.ports {
        let kind = port
            .kind
            .map_or(String::new(), |kind| format!("{} ", kind.digit()));
        writeln!(text, "  port {kind}{}[{}]", port.name, port.dimension)?;
    }
    write_statements(text, &component.statements)
}

fn write_statements(text: &mut String, statements: &[Statement]) -> fmt::Result {
    statements
        .iter()
        .try_for_each(|statement| write_statement(text, statement))
}

fn write_statement(text: &mut String, statement: &Statement) -> fmt::Result {
    match statement {
        Statement::Parameter(it) => {
            write_documentation(text, "  ", &it.documentation)?;
            writeln!(
                text,
                "  param {}{}{}{}",
                it.name,
                dimension(it.dimension),
                unit(it.unit.as_ref()),
                assigned(it.default.as_ref())
            )
        }
        Statement::Choice(it) => write_choice(text, it),
        Statement::Input(it) => {
            write_documentation(text, "  ", &it.documentation)?;
            writeln!(
                text,
                "  input {}[{}]{}",
                it.name,
                it.dimension,
                unit(it.unit.as_ref())
            )
        }
        Statement::Output(it) => {
            write_documentation(text, "  ", &it.documentation)?;
            let value = assigned(Some(&it.value));
            writeln!(
                text,
                "  output {}[{}]{}{value}",
                it.name,
                it.dimension,
                unit(it.unit.as_ref())
            )
        }
        Statement::Integral(it) => {
            write_documentation(text, "  ", &it.documentation)?;
            let (unit, rate, initial) = (
                unit(it.unit.as_ref()),
                assigned(Some(&it.rate)),
                initial(it.initial.as_ref()),
            );
            writeln!(
                text,
                "  integral {}[{}]{unit}{rate}{initial}",
                it.name, it.dimension
            )
        }
        Statement::Attitude(it) => {
            write_documentation(text, "  ", &it.documentation)?;
            let (name, word) = (&it.name, it.orientation.word());
            let velocity = expression(&it.angular_velocity);
            let initial = initial(it.initial.as_ref());
            writeln!(text, "  attitude {name} = {word}({velocity}){initial}")
        }
        Statement::Junction(junction) => write_junction(text, junction),
        Statement::Chain(chain) => writeln!(text, "  chain {}", chain_text(chain)),
        Statement::Instance(instance) => writeln!(text, "  {}", instance_text(instance)),
        Statement::Let(it) => {
            write_documentation(text, "  ", &it.documentation)?;
            let (dimension, value) = (dimension(it.dimension), assigned(Some(&it.value)));
            writeln!(
                text,
                "  let {}{dimension}{}{value}",
                it.name,
                unit(it.unit.as_ref())
            )
        }
        Statement::Gravity(gravity) => writeln!(text, "  gravity {}", expression(&gravity.value)),
        Statement::Loop(it) => write_loop(text, it),
        Statement::Conditional(it) => write_conditional(text, it),
        Statement::Closure(it) => write_closure(text, it),
        Statement::Assertion(it) => writeln!(text, "  assert {}", expression(&it.condition)),
        Statement::Causality(it, _) => {
            writeln!(text, "  causality {}", format!("{it:?}").to_lowercase())
        }
        Statement::Broken(Some(name)) => writeln!(text, "  broken {name}"),
        Statement::Broken(None) => writeln!(text, "  broken"),
    }
}

fn write_documentation(
    text: &mut String,
    indent: &str,
    documentation: &[Attribute],
) -> fmt::Result {
    for attribute in documentation {
        match &attribute.meta {
            Meta::NameValue(MetaNameValue {
                value:
                    Expr::Lit(ExprLit {
                        lit: Lit::Str(line),
                        ..
                    }),
                ..
            }) => {
                writeln!(text, "{indent}///{}", line.value().escape_debug())?;
            }
            other => {
                let mut line = String::new();
                spell(other.to_token_stream(), &mut line);
                writeln!(text, "{indent}#[{line}]")?;
            }
        }
    }
    Ok(())
}

fn write_junction(text: &mut String, junction: &Junction) -> fmt::Result {
    let digit = junction.kind.digit();
    let pseudo = if junction.pseudo { " pseudo" } else { "" };
    let coordinate = if junction.coordinate {
        " coordinate"
    } else {
        ""
    };
    let initial = match &junction.initial_flow {
        Some(value) => format!(", initial_flow: {}", expression(value)),
        None => String::new(),
    };
    writeln!(
        text,
        "  {digit} {}[{}]{pseudo}{coordinate}{initial}",
        junction.name, junction.dimension
    )?;
    junction
        .elements
        .iter()
        .try_for_each(|element| writeln!(text, "    {}", element_text(element)))
}

fn write_loop(text: &mut String, it: &Loop) -> fmt::Result {
    let label = it
        .label
        .as_ref()
        .map(|label| format!("{label}: "))
        .unwrap_or_default();
    let (start, end) = (expression(&it.start), expression(&it.end));
    writeln!(text, "  {label}for {} in {start}..{end}", it.variable)?;
    write_inside(text, &it.statements)
}

/// Statements in braces, set in by one step more.
fn write_inside(text: &mut String, statements: &[Statement]) -> fmt::Result {
    let mut inside = String::new();
    write_statements(&mut inside, statements)?;
    inside
        .lines()
        .try_for_each(|line| writeln!(text, "  {line}"))
}

fn write_choice(text: &mut String, it: &Choice) -> fmt::Result {
    write_documentation(text, "  ", &it.documentation)?;
    let words: Vec<String> = it.words.iter().map(ToString::to_string).collect();
    let default = it.default.as_ref();
    let default = default.map_or_else(String::new, |word| format!(" = {word}"));
    writeln!(text, "  param {}: {}{default}", it.name, words.join(" | "))
}

fn write_conditional(text: &mut String, it: &Conditional) -> fmt::Result {
    for (place, branch) in it.branches.iter().enumerate() {
        let condition = branch.condition.as_ref();
        let condition = condition.map_or_else(String::new, |it| format!(" if {}", expression(it)));
        let opening = format!("{}{condition}", if place == 0 { "" } else { "else" });
        writeln!(text, "  {}", opening.trim_start())?;
        write_inside(text, &branch.statements)?;
    }
    Ok(())
}

/// An element as it is written.
pub(crate) fn element_text(element: &Element) -> String {
    let mark = if element.derivative.is_some() {
        "#[derivative] "
    } else {
        ""
    };
    let dimension = dimension(element.dimension);
    let kind = words::element_name(element.kind);
    format!(
        "{mark}{kind} {}{dimension} {}",
        element.name,
        fields_text(&element.fields)
    )
}

fn fields_text(fields: &[Field]) -> String {
    if fields.is_empty() {
        return "{}".to_owned();
    }
    let fields: Vec<String> = fields
        .iter()
        .map(|field| match &field.value {
            Some(value) => format!("{}: {}", field.name, expression(value)),
            None => field.name.to_string(),
        })
        .collect();
    format!("{{ {} }}", fields.join(", "))
}

fn write_closure(text: &mut String, closure: &Closure) -> fmt::Result {
    let displacement = closure
        .displacement
        .as_ref()
        .map_or_else(String::new, |value| {
            format!(", displacement: {}", expression(value))
        });
    let (from, to) = (reference(&closure.from), reference(&closure.to));
    writeln!(text, "  close {from} -> {to} by multipliers{displacement}")
}

fn chain_text(chain: &Chain) -> String {
    let nodes: Vec<String> = chain
        .nodes
        .iter()
        .map(|node| match node {
            ChainNode::Reference(it) => reference(it),
            ChainNode::Element(element) => element_text(element),
        })
        .collect();
    nodes.join(" -> ")
}

/// A reference as a person would type it.
#[must_use]
pub fn reference(reference: &Reference) -> String {
    let segments: Vec<String> = reference.path.iter().map(segment_text).collect();
    segments.join(".")
}

fn segment_text(segment: &Segment) -> String {
    let Segment { name, selection } = segment;
    match selection {
        None => name.to_string(),
        Some(Selection { start, end: None }) => format!("{name}[{}]", expression(start)),
        Some(Selection {
            start,
            end: Some(end),
        }) => format!("{name}[{}..{}]", expression(start), expression(end)),
    }
}

fn instance_text(instance: &Instance) -> String {
    let mark = if instance.derivative.is_some() {
        "#[derivative] "
    } else {
        ""
    };
    let connections: Vec<String> = instance.connections.iter().map(reference).collect();
    let arguments = fields_text(&instance.arguments);
    format!(
        "{mark}instance {}: {} {arguments} ({})",
        instance.name,
        instance.component,
        connections.join(", ")
    )
}

fn mark(derivative: bool) -> &'static str {
    if derivative { " #[derivative]" } else { "" }
}

fn dimension(dimension: Option<usize>) -> String {
    dimension
        .map(|dimension| format!("[{dimension}]"))
        .unwrap_or_default()
}

fn unit(unit: Option<&Unit>) -> String {
    let Some(unit) = unit else {
        return String::new();
    };
    let factors: Vec<String> = unit
        .factors
        .iter()
        .map(|(name, power)| format!("{name}^{power}"))
        .collect();
    format!(": {} <{}>", unit.text, factors.join(" "))
}

fn assigned(value: Option<&Expr>) -> String {
    value
        .map(|value| format!(" = {}", expression(value)))
        .unwrap_or_default()
}

fn initial(value: Option<&Expr>) -> String {
    value
        .map(|value| format!(", initial: {}", expression(value)))
        .unwrap_or_default()
}

/// What was printed last, as far as the next space depends on it.
#[derive(Clone, Copy, PartialEq)]
enum Last {
    /// Nothing, or an operator that holds on to what follows.
    Open,
    /// A word of Rust such as `if`.
    Keyword,
    /// A name, a literal or a bracket: an operator after it is a binary one.
    Operand,
    /// A binary operator, a comma or a colon.
    Operator,
}

/// Prints tokens. The spaces of `TokenStream::to_string` differ from compiler to compiler; these do not.
fn spell(tokens: TokenStream, text: &mut String) {
    let mut last = Last::Open;
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let (word, kind) = match token {
            TokenTree::Group(group) => {
                let brace = group.delimiter() == Delimiter::Brace;
                if matches!(last, Last::Keyword | Last::Operator) || (brace && last != Last::Open) {
                    text.push(' ');
                }
                spell_group(&group, text);
                last = if brace { Last::Keyword } else { Last::Operand };
                continue;
            }
            TokenTree::Ident(ident) => {
                let word = ident.to_string();
                let kind = if words::is_reserved(&word) && !["pub", "mod"].contains(&word.as_str())
                {
                    Last::Keyword
                } else {
                    Last::Operand
                };
                (ident.unraw().to_string(), kind)
            }
            TokenTree::Literal(literal) => (literal.to_string(), Last::Operand),
            TokenTree::Punct(punct) => {
                let mut operator = String::from(punct.as_char());
                let mut joint = punct.spacing() == Spacing::Joint;
                while joint && let Some(TokenTree::Punct(next)) = tokens.peek() {
                    operator.push(next.as_char());
                    joint = next.spacing() == Spacing::Joint;
                    tokens.next();
                }
                last = spell_operator(&operator, last, text);
                continue;
            }
        };
        if last != Last::Open {
            text.push(' ');
        }
        text.push_str(&word);
        last = kind;
    }
}

fn spell_group(group: &proc_macro2::Group, text: &mut String) {
    let (open, close) = match group.delimiter() {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::Brace => ("{ ", " }"),
        Delimiter::None => ("", ""),
    };
    text.push_str(open);
    spell(group.stream(), text);
    text.push_str(close);
}

fn spell_operator(operator: &str, last: Last, text: &mut String) -> Last {
    match operator {
        "," | ";" | ":" => {
            text.push_str(operator);
            Last::Operator
        }
        "." | ".." | "..=" | "::" | "?" | "#" => {
            text.push_str(operator);
            if operator == "?" {
                Last::Operand
            } else {
                Last::Open
            }
        }
        _ if last == Last::Operand => {
            let _ = write!(text, " {operator}");
            Last::Operator
        }
        _ => {
            if last != Last::Open {
                text.push(' ');
            }
            text.push_str(operator);
            if operator == "=" {
                Last::Operator
            } else {
                Last::Open
            }
        }
    }
}
