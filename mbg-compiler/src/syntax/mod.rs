//! Stage 1, syntax: tokens to a tree.
//!
//! - Input: the tokens between the braces of `mbg! { … }`, any tokens at all.
//! - Output: an [`ast::Source`]. A statement that could not be read is an [`ast::Statement::Broken`] for each name that
//!   it declares, and its error is reported; what stands around it is kept.
//! - Errors: `MBG0101` to `MBG0105`, each at a token that the user wrote.
//!
//! The structure is read from token trees by hand, and only laws are handed to `syn`: a failed `syn` parse inside
//! braces spoils the parse of everything around them, which would cost every error but the first.

pub mod ast;
mod attributes;
mod chains;
mod choices;
mod cursor;
mod depth;
pub mod dump;
mod elements;
mod expressions;
mod items;
pub mod library;
mod loops;
mod recovery;
mod statements;
mod units;
pub(crate) mod words;

pub use dump::dump;

use std::collections::BTreeSet;

use proc_macro2::TokenStream;

use crate::codes;
use crate::diagnostics::Diagnostics;

/// The largest dimension and index: far above any model, far below where sizes overflow.
pub const LARGEST_DIMENSION: usize = 1_000_000;

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
    refuse_namesakes(&source, diagnostics);
    library::complete(&mut source);
    source
}

/// Reports components that bear the name of an earlier one.
fn refuse_namesakes(source: &ast::Source, diagnostics: &mut Diagnostics) {
    let mut known = BTreeSet::new();
    for item in &source.items {
        let ast::Item::Component(component) = item else {
            continue;
        };
        let name = component.name.to_string();
        if !known.insert(name.clone()) {
            let message = format!("component `{name}` is declared twice");
            diagnostics.error(codes::DUPLICATE_NAME, component.name.span(), message);
        }
    }
}
