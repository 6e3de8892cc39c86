//! Models, components and their statements.

use proc_macro2::{Span, TokenStream, TokenTree};
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, Ident, LitInt, Token, Visibility, token};

use super::ast::{
    Attitude, Causality, Component, Input, Instance, Integral, Item, Junction, JunctionKind, Model,
    Output, Parameter, Port, Source, Statement, Unit,
};
use super::elements::{chain, connections, derivative, dimension, elements, fields, kind};
use super::split::{is_punct, read, statements};
use super::units::unit;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};

/// All models and components.
pub(super) fn source(tokens: TokenStream, diagnostics: &mut Diagnostics) -> Source {
    let mut items = Vec::new();
    for piece in statements(tokens) {
        if let Some((head, body)) = read(&piece, header, diagnostics) {
            let statements = statements(body)
                .iter()
                .map(|piece| statement(piece, diagnostics))
                .collect();
            items.push(head.with(statements));
        }
    }
    Source { items }
}

/// What stands before a body.
struct Header {
    documentation: Vec<Attribute>,
    derivative: Option<Span>,
    visibility: Visibility,
    name: Ident,
    /// Ports of a component; none for a model.
    ports: Option<Vec<Port>>,
}

impl Header {
    fn with(self, statements: Vec<Statement>) -> Item {
        let Self {
            documentation,
            derivative,
            visibility,
            name,
            ports,
        } = self;
        match ports {
            Some(ports) => Item::Component(Component {
                documentation,
                derivative,
                name,
                ports,
                statements,
            }),
            None => Item::Model(Model {
                documentation,
                derivative,
                visibility,
                name,
                statements,
            }),
        }
    }
}

fn header(input: ParseStream) -> syn::Result<(Header, TokenStream)> {
    let attributes = input.call(Attribute::parse_outer)?;
    let derivative = derivative(&attributes)?;
    let documentation = documentation(attributes);
    let visibility: Visibility = input.parse()?;
    let word: Ident = input
        .parse()
        .map_err(|error| syn::Error::new(error.span(), "expected `model` or `component`"))?;
    if word != "model" && word != "component" {
        return Err(syn::Error::new(
            word.span(),
            format!("expected `model` or `component`, found `{word}`"),
        ));
    }
    let name: Ident = input.parse()?;
    let ports = if word == "component" {
        Some(ports(input)?)
    } else {
        None
    };
    if !input.peek(token::Brace) {
        return Err(input.error(format!("expected `{{` and the body of `{name}`")));
    }
    let content;
    syn::braced!(content in input);
    let body = content.parse()?;
    Ok((
        Header {
            documentation,
            derivative,
            visibility,
            name,
            ports,
        },
        body,
    ))
}

fn documentation(attributes: Vec<Attribute>) -> Vec<Attribute> {
    attributes
        .into_iter()
        .filter(|attribute| attribute.path().is_ident("doc"))
        .collect()
}

fn ports(input: ParseStream) -> syn::Result<Vec<Port>> {
    let content;
    syn::parenthesized!(content in input);
    let port = |input: ParseStream| {
        let word: Ident = input.parse()?;
        if word != "port" {
            return Err(syn::Error::new(
                word.span(),
                format!("expected `port`, found `{word}`"),
            ));
        }
        Ok(Port {
            name: input.parse()?,
            dimension: dimension(input)?.unwrap_or(1),
        })
    };
    let all: Punctuated<Port, Token![,]> = content.parse_terminated(port, Token![,])?;
    Ok(all.into_iter().collect())
}

/// The words that may begin a statement.
const WORDS: [&str; 7] = [
    "param",
    "input",
    "output",
    "integral",
    "attitude",
    "causality",
    "component",
];

fn statement(tokens: &[TokenTree], diagnostics: &mut Diagnostics) -> Statement {
    let name = name_of(tokens);
    if let Some(word) = misspelt(tokens) {
        let found = tokens[0].to_string();
        let text = format!("expected a statement, found `{found}`");
        diagnostics
            .report(error(codes::SYNTAX, tokens[0].span(), text).help(format!("write `{word}`")));
        return Statement::Broken(name);
    }
    read(tokens, any_statement, diagnostics).unwrap_or(Statement::Broken(name))
}

/// The name that a statement declares, as far as one can see.
fn name_of(tokens: &[TokenTree]) -> Option<Ident> {
    let ident = |token: Option<&TokenTree>| match token {
        Some(TokenTree::Ident(ident)) => Some(ident.clone()),
        _ => None,
    };
    if tokens.get(1).is_some_and(|token| is_punct(token, ':')) {
        ident(tokens.first())
    } else {
        ident(tokens.get(1))
    }
}

/// The word that was meant, where two identifiers stand side by side and the first is none of ours.
fn misspelt(tokens: &[TokenTree]) -> Option<&'static str> {
    let (Some(TokenTree::Ident(first)), Some(TokenTree::Ident(_))) =
        (tokens.first(), tokens.get(1))
    else {
        return None;
    };
    let first = first.to_string();
    if WORDS.contains(&first.as_str()) || kind(&Ident::new(&first, Span::call_site())).is_some() {
        return None;
    }
    WORDS.into_iter().find(|word| distance(&first, word) <= 2)
}

/// Edit distance of two short words.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

fn any_statement(input: ParseStream) -> syn::Result<Statement> {
    let attributes = input.fork().call(Attribute::parse_outer)?;
    let ahead = input.fork();
    ahead.call(Attribute::parse_outer)?;
    if ahead.peek(LitInt) {
        input.call(Attribute::parse_outer)?;
        return junction(input);
    }
    let word: Ident = ahead.fork().parse()?;
    let starts_declaration = ahead.peek2(Ident);
    match word.to_string().as_str() {
        "param" if starts_declaration => after_word(input, attributes, parameter),
        "input" if starts_declaration => after_word(input, attributes, self::input),
        "output" if starts_declaration => after_word(input, attributes, output),
        "integral" if starts_declaration => after_word(input, attributes, integral),
        "attitude" if starts_declaration => after_word(input, attributes, attitude),
        "causality" if starts_declaration => after_word(input, attributes, causality),
        "close" | "include" if starts_declaration => Err(syn::Error::new(
            word.span(),
            format!("`{word}` is not supported yet"),
        )),
        _ if ahead.peek2(Token![:]) => instance(input),
        _ => chain(input).map(Statement::Chain),
    }
}

fn after_word(
    input: ParseStream,
    attributes: Vec<Attribute>,
    parser: fn(ParseStream, Vec<Attribute>) -> syn::Result<Statement>,
) -> syn::Result<Statement> {
    input.call(Attribute::parse_outer)?;
    input.parse::<Ident>()?;
    let statement = parser(input, documentation(attributes))?;
    if !input.peek(Token![;]) {
        return Err(input.error("expected `;`"));
    }
    input.parse::<Token![;]>()?;
    Ok(statement)
}

fn optional_unit(input: ParseStream) -> syn::Result<Option<Unit>> {
    if !input.peek(Token![:]) {
        return Ok(None);
    }
    input.parse::<Token![:]>()?;
    unit(input).map(Some)
}

fn parameter(input: ParseStream, documentation: Vec<Attribute>) -> syn::Result<Statement> {
    let name = input.parse()?;
    let unit = optional_unit(input)?;
    let default = if input.parse::<Option<Token![=]>>()?.is_some() {
        Some(input.parse::<Expr>()?)
    } else {
        None
    };
    Ok(Statement::Parameter(Parameter {
        documentation,
        name,
        unit,
        default,
    }))
}

fn input(input: ParseStream, documentation: Vec<Attribute>) -> syn::Result<Statement> {
    let name = input.parse()?;
    let dimension = dimension(input)?.unwrap_or(1);
    Ok(Statement::Input(Input {
        documentation,
        name,
        dimension,
        unit: optional_unit(input)?,
    }))
}

fn output(input: ParseStream, documentation: Vec<Attribute>) -> syn::Result<Statement> {
    let name = input.parse()?;
    let dimension = dimension(input)?.unwrap_or(1);
    let unit = optional_unit(input)?;
    input.parse::<Token![=]>()?;
    Ok(Statement::Output(Output {
        documentation,
        name,
        dimension,
        unit,
        value: input.parse()?,
    }))
}

fn integral(input: ParseStream, documentation: Vec<Attribute>) -> syn::Result<Statement> {
    let name = input.parse()?;
    let dimension = dimension(input)?.unwrap_or(1);
    let unit = optional_unit(input)?;
    input.parse::<Token![=]>()?;
    let rate = input.parse()?;
    Ok(Statement::Integral(Integral {
        documentation,
        name,
        dimension,
        unit,
        rate,
        initial: initial(input)?,
    }))
}

fn attitude(input: ParseStream, documentation: Vec<Attribute>) -> syn::Result<Statement> {
    let name = input.parse()?;
    input.parse::<Token![=]>()?;
    let word: Ident = input.parse()?;
    if word != "quaternion" {
        return Err(syn::Error::new(
            word.span(),
            format!("expected `quaternion(…)`, found `{word}`"),
        ));
    }
    let content;
    syn::parenthesized!(content in input);
    let angular_velocity = content.parse()?;
    if !content.is_empty() {
        return Err(content.error("expected one argument, the angular velocity in body axes"));
    }
    Ok(Statement::Attitude(Attitude {
        documentation,
        name,
        angular_velocity,
        initial: initial(input)?,
    }))
}

fn initial(input: ParseStream) -> syn::Result<Option<Expr>> {
    if input.parse::<Option<Token![,]>>()?.is_none() {
        return Ok(None);
    }
    let word: Ident = input.parse()?;
    if word != "initial" {
        return Err(syn::Error::new(
            word.span(),
            format!("expected `initial`, found `{word}`"),
        ));
    }
    input.parse::<Token![:]>()?;
    input.parse().map(Some)
}

fn causality(input: ParseStream, _: Vec<Attribute>) -> syn::Result<Statement> {
    let word: Ident = input.parse()?;
    let causality = match word.to_string().as_str() {
        "uniform" => Causality::Uniform,
        "componentwise" => Causality::Componentwise,
        _ => {
            let text = format!("expected `uniform` or `componentwise`, found `{word}`");
            return Err(syn::Error::new(word.span(), text));
        }
    };
    Ok(Statement::Causality(causality, word.span()))
}

fn junction(input: ParseStream) -> syn::Result<Statement> {
    let literal: LitInt = input.parse()?;
    let kind = match literal.to_string().as_str() {
        "0" => JunctionKind::Zero,
        "1" => JunctionKind::One,
        other => {
            let text = format!("expected a junction, `0` or `1`, found `{other}`");
            return Err(syn::Error::new(literal.span(), text));
        }
    };
    let name: Ident = input.parse()?;
    let mut coordinate = coordinate_mark(input)?;
    let dimension = dimension(input)?.unwrap_or(1);
    coordinate |= coordinate_mark(input)?;
    let elements = if input.peek(token::Brace) {
        let content;
        syn::braced!(content in input);
        input.parse::<Option<Token![;]>>()?;
        elements(&content)?
    } else if input.peek(Token![;]) {
        input.parse::<Token![;]>()?;
        Vec::new()
    } else {
        return Err(input.error(format!(
            "expected `;` or the elements of `{name}` in braces"
        )));
    };
    Ok(Statement::Junction(Junction {
        kind,
        span: literal.span(),
        name,
        dimension,
        coordinate,
        elements,
    }))
}

fn coordinate_mark(input: ParseStream) -> syn::Result<bool> {
    let marked = input
        .fork()
        .parse::<Ident>()
        .is_ok_and(|word| word == "coordinate");
    if marked {
        input.parse::<Ident>()?;
    }
    Ok(marked)
}

fn instance(input: ParseStream) -> syn::Result<Statement> {
    let attributes = input.call(Attribute::parse_outer)?;
    let name: Ident = input.parse()?;
    input.parse::<Token![:]>()?;
    let component: Ident = input.parse()?;
    let arguments = if input.peek(token::Brace) {
        let content;
        syn::braced!(content in input);
        fields(&content)?
    } else {
        Vec::new()
    };
    if !input.peek(token::Paren) {
        return Err(input.error(format!(
            "expected `(` and the junctions that the ports of `{component}` stand for"
        )));
    }
    let connections = connections(input)?;
    input.parse::<Token![;]>()?;
    let derivative = derivative(&attributes)?;
    Ok(Statement::Instance(Instance {
        name,
        derivative,
        component,
        arguments,
        connections,
    }))
}
