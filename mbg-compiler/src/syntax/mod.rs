//! Stage 1, syntax: tokens to a tree.
//!
//! - Input: the tokens between the braces of `mbg! { … }`, any tokens at all.
//! - Output: an [`ast::Source`]. A statement that could not be read is an [`ast::Statement::Broken`] for each name that
//!   it declares, and its error is reported; what stands around it is kept.
//! - Errors: `MBG0101` to `MBG0105`, each at a token that the user wrote.
//!
//! The structure is read from token trees by hand, and only laws are handed to `syn`: a failed `syn` parse inside
//! braces spoils the parse of everything around them, which would cost every error but the first.

mod alone;
pub mod ast;
mod attributes;
mod chains;
mod choices;
mod comparisons;
pub(crate) mod cursor;
mod depth;
pub mod dump;
mod elements;
mod elsewhere;
mod equations;
mod expressions;
mod inclusions;
mod items;
pub mod library;
mod loops;
mod raw;
mod reads;
mod recovery;
pub(crate) mod signals;
pub(crate) mod slips;
mod statements;
mod ternaries;
mod units;
pub(crate) mod words;

pub use dump::dump;

use std::collections::BTreeMap;

use proc_macro2::{Ident, TokenStream};
use syn::ext::IdentExt;

use crate::codes;
use crate::diagnostics::Diagnostics;

/// The largest dimension: above any model, and below what matrices of that many rows and columns can be held for.
pub const LARGEST_DIMENSION: usize = 4096;

/// Reads the tokens between the braces of `mbg! { … }`.
///
/// It never panics, and reports every mistake that it can tell apart.
///
/// ```
/// use mbg_compiler::{diagnostics::Diagnostics, syntax};
///
/// let tokens = "model Mass { 1 body { I mass { inertia: 2.0 } } }".parse().unwrap();
/// let mut diagnostics = Diagnostics::new();
/// let source = syntax::parse(tokens, &mut diagnostics);
/// assert!(!diagnostics.any());
/// assert_eq!(source.items.len(), 1);
/// ```
#[must_use]
pub fn parse(tokens: TokenStream, diagnostics: &mut Diagnostics) -> ast::Source {
    let mut source = items::source(tokens, &mut recovery::Sink::new(diagnostics));
    refuse_namesakes(&mut source, diagnostics);
    library::complete(&mut source);
    source
}

/// Reports items that bear the name of an earlier one, and leaves out models whose types Rust would refuse for it. A
/// component is no type: a model may be called as the component that it uses.
fn refuse_namesakes(source: &mut ast::Source, diagnostics: &mut Diagnostics) {
    let mut known: BTreeMap<(bool, String), String> = BTreeMap::new();
    source.items.retain(|item| {
        let (name, is_type) = match item {
            ast::Item::Component(component) => (&component.name, false),
            ast::Item::Model(model) => (&model.name, true),
        };
        let own = names_of(name, is_type).into_iter();
        let own: Vec<_> = own.map(|(name, what)| ((is_type, name), what)).collect();
        let taken = own
            .iter()
            .find_map(|(name, what)| Some((what, known.get(name)?)));
        let Some((what, other)) = taken else {
            known.extend(own);
            return true;
        };
        let message = if what == other {
            format!("{what} is declared twice")
        } else {
            format!("{what} and {other} have one name")
        };
        diagnostics.error(codes::DUPLICATE_NAME, name.span(), message);
        !is_type
    });
}

/// The names that an item takes, and what bears them: the parameters of a model are a type of their own.
fn names_of(name: &Ident, is_model: bool) -> Vec<(String, String)> {
    if !is_model {
        return vec![(name.to_string(), format!("component `{name}`"))];
    }
    let parameters = format!("the parameters of model `{name}`");
    vec![
        (name.to_string(), format!("model `{name}`")),
        (format!("{}Parameters", name.unraw()), parameters),
    ]
}
