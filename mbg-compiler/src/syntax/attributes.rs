//! `#[derivative]` and documentation comments.

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use syn::Attribute;
use syn::parse::Parser;

use super::cursor::{Cursor, Parsed};
use super::recovery::Sink;
use super::{dump, words};
use crate::codes;

/// What stands before an item, a statement or an element.
#[derive(Default)]
pub(super) struct Attributes {
    /// Documentation comments.
    pub(super) documentation: Vec<Attribute>,
    /// The mark and its place.
    pub(super) derivative: Option<Span>,
}

impl Attributes {
    /// Reads all attributes that stand here.
    ///
    /// One that is not understood is reported and left out: what it stands before is still good.
    pub(super) fn read(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Parsed<Self> {
        let mut attributes = Self::default();
        while cursor.punct(0, '#') {
            if cursor.punct(1, '!') {
                let error = cursor.failure(
                    codes::SYNTAX,
                    "expected an attribute or comment for what follows, found an inner one",
                );
                return Err(Box::new(
                    (*error).help("a documentation comment begins with `///`"),
                ));
            }
            if cursor.group(1, Delimiter::Bracket).is_none() {
                cursor.advance(1);
                let error = *cursor.expected("`[` after `#`");
                return Err(Box::new(error.help("a comment begins with `//`")));
            }
            cursor.advance(2);
            attributes.add(cursor.since(cursor.position() - 2), sink);
        }
        Ok(attributes)
    }

    /// Reports a mark where nothing can be in derivative causality.
    pub(super) fn unmarked(&self, what: &str, sink: &mut Sink<'_>) {
        if let Some(span) = self.derivative {
            let message = format!(
                "expected `#[derivative]` before an element, an instance, a component or a model, found it before {what}"
            );
            sink.error(codes::SYNTAX, span, message);
        }
    }

    /// Takes in `#[…]`, given its two tokens.
    fn add(&mut self, tokens: &[TokenTree], sink: &mut Sink<'_>) {
        let [_, TokenTree::Group(group)] = tokens else {
            return;
        };
        let mut inner = Cursor::inside(group);
        // What a `$d:meta` stands for.
        inner.open();
        let word = inner.ident(0).map(ToString::to_string).unwrap_or_default();
        match word.as_str() {
            "doc" => {
                let stream: TokenStream = tokens.iter().cloned().collect();
                match Attribute::parse_outer.parse2(stream) {
                    Ok(documentation) => self.documentation.extend(documentation),
                    Err(_) => sink.report(inner.expected("a documentation comment")),
                }
            }
            "derivative" => {
                let span = inner.span();
                if self.derivative.replace(span).is_some() {
                    sink.error(
                        codes::FIELD_REPEATED,
                        span,
                        "`#[derivative]` is given twice",
                    );
                }
                inner.advance(1);
                if !inner.ended() {
                    sink.report(inner.expected("`]` after `derivative`"));
                }
            }
            _ => {
                let mut error = *inner.expected("`derivative` or a documentation comment");
                error = match words::nearest(&word, &["derivative"]) {
                    Some(near) => error.help(format!("did you mean `{near}`?")),
                    None => error.help(of_rust(&word, group)),
                };
                sink.report(Box::new(error));
            }
        }
    }
}

/// What to type instead of an attribute of Rust.
fn of_rust(word: &str, group: &Group) -> String {
    let attribute = format!("#[{}]", dump::tokens(group.stream()));
    match word {
        "cfg" => format!("a whole call alone can be left out so, and not a part of a model: `{attribute} mbg! {{ … }}`"),
        "allow" | "expect" | "warn" | "deny" | "forbid" | "cfg_attr" | "deprecated" => {
            format!("it stands on a module around the call: `{attribute} mod models {{ … mbg! {{ … }} }}`")
        }
        "derive" => "the types of a model are `Clone`, `Copy`, `Debug` and `PartialEq`; other traits are written behind the call: \
                     `impl Trait for Model { … }`"
            .to_owned(),
        _ => "attributes of Rust are not handed on; what a type is to have besides is written behind the call: \
              `impl Trait for Model { … }`"
            .to_owned(),
    }
}
