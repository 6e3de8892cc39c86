//! Stage 7, emission: programs to Rust.
//!
//! Input: a [`Compiled`] model. Output: tokens: the type of the parameters, the model's type, and its `System`. The
//! code is flat, generic over the scalar, refers to everything by whole paths, and is the same for the same input.
//!
//! It stands among items of the user, where a constant `t` would be what each binding `t` is compared with. Words that it
//! binds are therefore in the list of `mbg_runtime::__private::locals`, and names with numbers end in `_`.

mod changes;
mod close;
mod jacobians;
mod meta;
mod parameters;
mod repeats;
mod routine;
mod shell;
mod sparsity;
mod sweeps;
mod system;
mod tokens;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use tokens::block;

use crate::compile::Compiled;
use crate::syntax::ast;

/// What models become.
#[derive(Default)]
pub struct Items {
    /// Types, which users name.
    pub types: TokenStream,
    /// What these do.
    pub behaviour: TokenStream,
}

impl Items {
    /// Adds other items.
    pub fn extend(&mut self, other: Self) {
        self.types.extend(other.types);
        self.behaviour.extend(other.behaviour);
    }

    /// All items as they stand in the scope of the user, where `runtime` is the path of the crate `mbg_runtime`. A block keeps
    /// what only generated code is to see.
    #[must_use]
    pub fn stream(self, runtime: &TokenStream) -> TokenStream {
        let Self { types, behaviour } = self;
        if behaviour.is_empty() {
            return types;
        }
        let mut inner = quote!(
            use #runtime::{self as mbg_runtime, __private::locals::*};
        );
        inner.extend(behaviour);
        let block = block(inner);
        quote!(#types const _: () = #block;)
    }
}

/// All items of a model.
#[must_use]
pub fn model(compiled: &Compiled) -> Items {
    let mut items = parameters::items(compiled);
    items.extend(system::items(compiled));
    items
}

/// What is left of a model with a mistake: its types and their methods, so that whatever uses them still resolves. Its sizes
/// are the constant in which the mistakes are told, see [`mistakes`].
#[must_use]
pub fn shell(model: &ast::Model, mistakes: &Ident) -> Items {
    shell::items(model, mistakes)
}

/// The constant in which the mistakes of all models are told, by the first that has one.
#[must_use]
pub fn mistakes(model: &ast::Model) -> Ident {
    shell::constant(model)
}
