//! Elements, references and chains.

use proc_macro2::Span;
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::{Attribute, Expr, Ident, LitInt, Token, token};

use super::ast::{Chain, ChainNode, Element, ElementKind, Field, Reference, Selection};

/// The largest dimension that is read; far beyond the size limit of a model.
const LARGEST: usize = 100_000;

/// `[n]`, if it stands here.
pub(super) fn dimension(input: ParseStream) -> syn::Result<Option<usize>> {
    if !input.peek(token::Bracket) {
        return Ok(None);
    }
    let content;
    syn::bracketed!(content in input);
    let size = integer(&content)?;
    if !content.is_empty() || size == 0 || size > LARGEST {
        return Err(syn::Error::new(
            content.span(),
            "expected a dimension, a positive integer",
        ));
    }
    Ok(Some(size))
}

fn integer(input: ParseStream) -> syn::Result<usize> {
    let literal: LitInt = input.parse().map_err(|error| {
        syn::Error::new(error.span(), "expected a dimension, a positive integer")
    })?;
    literal.base10_parse()
}

/// The element that a word names.
pub(super) fn kind(word: &Ident) -> Option<ElementKind> {
    Some(match word.to_string().as_str() {
        "Se" => ElementKind::Se,
        "Sf" => ElementKind::Sf,
        "I" => ElementKind::I,
        "C" => ElementKind::C,
        "R" => ElementKind::R,
        "TF" => ElementKind::TF,
        "GY" => ElementKind::GY,
        "MTF" => ElementKind::MTF,
        "MGY" => ElementKind::MGY,
        "EJS" => ElementKind::EJS,
        _ => return None,
    })
}

/// Whether `derivative` is among the attributes; any other attribute but documentation is refused.
pub(super) fn derivative(attributes: &[Attribute]) -> syn::Result<Option<Span>> {
    let mut found = None;
    for attribute in attributes {
        if attribute.path().is_ident("derivative") {
            found = Some(attribute.path().span());
        } else if !attribute.path().is_ident("doc") {
            return Err(syn::Error::new(
                attribute.path().span(),
                "expected `#[derivative]`, found another attribute",
            ));
        }
    }
    Ok(found)
}

/// Elements in a junction's braces.
pub(super) fn elements(input: ParseStream) -> syn::Result<Vec<Element>> {
    let mut all = Vec::new();
    while !input.is_empty() {
        let attributes = input.call(Attribute::parse_outer)?;
        all.push(element(input, &attributes)?);
        while input.peek(Token![,]) || input.peek(Token![;]) {
            input.parse::<proc_macro2::TokenTree>()?;
        }
    }
    Ok(all)
}

fn element(input: ParseStream, attributes: &[Attribute]) -> syn::Result<Element> {
    let word: Ident = input.parse()?;
    let Some(kind) = kind(&word) else {
        let text = format!(
            "expected an element (Se, Sf, I, C, R, TF, GY, MTF, MGY or EJS), found `{word}`"
        );
        return Err(syn::Error::new(word.span(), text));
    };
    let name: Ident = input.parse().map_err(|error| {
        syn::Error::new(error.span(), format!("expected a name for this `{word}`"))
    })?;
    let dimension = dimension(input)?;
    if !input.peek(token::Brace) {
        return Err(input.error(format!("expected `{{` and the law of `{name}`")));
    }
    let content;
    syn::braced!(content in input);
    let fields = fields(&content)?;
    Ok(Element {
        derivative: derivative(attributes)?,
        kind,
        span: word.span(),
        name,
        dimension,
        fields,
    })
}

/// `word: value, word`.
pub(super) fn fields(input: ParseStream) -> syn::Result<Vec<Field>> {
    let mut all: Vec<Field> = Vec::new();
    while !input.is_empty() {
        let name: Ident = input.parse()?;
        if all.iter().any(|field| field.name == name) {
            return Err(syn::Error::new(
                name.span(),
                format!("`{name}` is given twice"),
            ));
        }
        let value = if input.peek(Token![:]) {
            input.parse::<Token![:]>()?;
            Some(input.parse::<Expr>()?)
        } else {
            None
        };
        all.push(Field { name, value });
        if !input.is_empty() {
            input.parse::<Token![,]>()?;
        }
    }
    Ok(all)
}

/// A name with an optional selection of components.
pub(super) fn reference(input: ParseStream) -> syn::Result<Reference> {
    let first: Ident = input.parse()?;
    let span = first.span();
    let mut path = vec![first];
    while input.peek(Token![.]) {
        input.parse::<Token![.]>()?;
        path.push(input.parse()?);
    }
    let selection = if input.peek(token::Bracket) {
        Some(selection(input)?)
    } else {
        None
    };
    Ok(Reference {
        path,
        selection,
        span,
    })
}

fn selection(input: ParseStream) -> syn::Result<Selection> {
    let content;
    syn::bracketed!(content in input);
    let start = integer(&content)?;
    let end = if content.peek(Token![..]) {
        content.parse::<Token![..]>()?;
        integer(&content)?
    } else {
        start + 1
    };
    if !content.is_empty() || end <= start {
        return Err(syn::Error::new(
            content.span(),
            "expected one component `[0]` or a range `[1..3]`",
        ));
    }
    Ok(Selection { start, end })
}

/// `A -> B -> C;`
pub(super) fn chain(input: ParseStream) -> syn::Result<Chain> {
    let mut chain = Chain {
        nodes: vec![node(input)?],
        arrows: Vec::new(),
    };
    while !input.is_empty() && !input.peek(Token![;]) {
        if !input.peek(Token![->]) {
            return Err(input.error("expected `->` or `;`"));
        }
        let arrow: Token![->] = input.parse()?;
        chain.arrows.push(arrow.spans[0]);
        chain.nodes.push(node(input)?);
    }
    if chain.arrows.is_empty() {
        return Err(input.error("expected `->`"));
    }
    input.parse::<Token![;]>()?;
    Ok(chain)
}

fn node(input: ParseStream) -> syn::Result<ChainNode> {
    let attributes = input.call(Attribute::parse_outer)?;
    let ahead = input.fork();
    let word: Option<Ident> = ahead.parse().ok();
    if word.as_ref().and_then(kind).is_some() && ahead.peek(Ident) {
        return Ok(ChainNode::Element(element(input, &attributes)?));
    }
    Ok(ChainNode::Reference(reference(input)?))
}

/// References in parentheses.
pub(super) fn connections(input: ParseStream) -> syn::Result<Vec<Reference>> {
    let content;
    syn::parenthesized!(content in input);
    let all: Punctuated<Reference, Token![,]> = content.parse_terminated(reference, Token![,])?;
    Ok(all.into_iter().collect())
}
