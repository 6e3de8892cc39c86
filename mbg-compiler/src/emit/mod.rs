//! Stage 7, emission: programs to Rust.
//!
//! Input: a [`Compiled`] model. Output: tokens: the type of the parameters, the model's type, and its `System`. The
//! code is flat, generic over the scalar, refers to everything by absolute path, and is the same for the same input.

mod close;
mod columns;
mod jacobians;
mod meta;
mod parameters;
mod routine;
mod shell;
mod sparsity;
mod system;
mod tokens;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::compile::Compiled;
use crate::syntax::ast;

/// All items of a model.
#[must_use]
pub fn model(compiled: &Compiled) -> TokenStream {
    let parameters = parameters::items(compiled);
    let system = system::items(compiled);
    quote!(#parameters #system)
}

/// What is left of a model with a mistake: its types and their methods, so that whatever uses them still resolves. Its sizes
/// are the constant in which the mistakes are told, see [`mistakes`].
#[must_use]
pub fn shell(model: &ast::Model, mistakes: &Ident) -> TokenStream {
    shell::items(model, mistakes)
}

/// The constant in which the mistakes of all models are told, by the first that has one.
#[must_use]
pub fn mistakes(model: &ast::Model) -> Ident {
    shell::constant(model)
}
