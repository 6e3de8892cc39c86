//! Jacobians of models that are too large to write them out: one column after the other, from dual numbers.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::compile::Compiled;

/// The bodies of `derivative_and_jacobian` and of `jacobian_input`. Iterations begin where the last one ended, and how they
/// end is remembered.
pub(super) fn jacobians(compiled: &Compiled) -> (TokenStream, TokenStream) {
    let lifted = lifted(compiled);
    let dual = quote!(::mbg_runtime::Dual);
    let iterates = compiled.iterations().next().is_some();
    let begin = iterates.then(|| quote!(.map(#dual::constant)));
    let end = iterates.then(|| quote!(*memory = remembered.map(|it| it.value);));
    let by_state = quote! {
        let derivative = ::mbg_runtime::System::derivative(self, t, x, u, memory);
        #lifted
        let mut remembered = (*memory) #begin;
        let (t, u) = (#dual::constant(t), u.map(#dual::constant));
        let jacobian = ::mbg_runtime::__private::by_columns(x, |x| {
            ::mbg_runtime::System::derivative(&lifted, t, x, &u, &mut remembered)
        });
        (derivative, jacobian)
    };
    let by_input = quote! {
        #lifted
        let mut remembered = (*memory) #begin;
        let (t, x) = (#dual::constant(t), x.map(#dual::constant));
        let jacobian = ::mbg_runtime::__private::by_columns(u, |u| {
            ::mbg_runtime::System::derivative(&lifted, t, &x, u, &mut remembered)
        });
        #end
        jacobian
    };
    (by_state, by_input)
}

/// The model itself in dual numbers.
fn lifted(compiled: &Compiled) -> TokenStream {
    let model = &compiled.model;
    let (name, parameters) = (&model.name, format_ident!("{}Parameters", model.name));
    let fields: Vec<_> = model.parameters.iter().map(|it| &it.name).collect();
    let phantom = fields
        .is_empty()
        .then(|| quote!(scalar: ::core::marker::PhantomData));
    quote! {
        let lifted = #name {
            parameters: #parameters {
                #(#fields: ::mbg_runtime::Dual::constant(self.parameters.#fields),)*
                #phantom
            },
            folded: self.folded.map(::mbg_runtime::Dual::constant),
        };
    }
}
