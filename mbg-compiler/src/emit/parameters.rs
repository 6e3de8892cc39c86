//! The parameters' type.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::meta::spaced;
use crate::compile::Compiled;

/// `NameParameters` with its `Default`.
pub(super) fn items(compiled: &Compiled) -> TokenStream {
    let model = &compiled.model;
    let (visibility, name) = (&model.visibility, format_ident!("{}Parameters", model.name));
    let fields = model.parameters.iter().map(|parameter| {
        let (name, documentation) = (&parameter.name, &parameter.documentation);
        let unit = if parameter.unit.is_empty() {
            "Without unit".to_owned()
        } else {
            format!("In {}", parameter.unit)
        };
        let line = spaced(format!(
            "{unit}; {} by default.",
            crate::symbolic::print::number(parameter.default)
        ));
        quote!(#(#documentation)* #[doc = #line] pub #name: T)
    });
    let defaults = model.parameters.iter().map(|parameter| {
        let (name, value) = (&parameter.name, number(parameter.default));
        quote!(#name: #value)
    });
    let documentation = spaced(format!("Parameters of [`{}`].", model.name));
    let phantom = model.parameters.is_empty();
    let (field, default) = if phantom {
        (
            quote!(#[doc(hidden)] pub scalar: ::core::marker::PhantomData<T>),
            quote!(scalar: ::core::marker::PhantomData),
        )
    } else {
        (TokenStream::new(), TokenStream::new())
    };
    quote! {
        #[doc = #documentation]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #visibility struct #name<T = f64> { #(#fields,)* #field }

        #[automatically_derived]
        impl<T: ::mbg_runtime::Real> ::core::default::Default for #name<T> {
            fn default() -> Self { Self { #(#defaults,)* #default } }
        }
    }
}

/// A number of the scalar's type.
fn number(value: f64) -> TokenStream {
    let literal = Literal::f64_suffixed(value.abs());
    let positive = quote!(T::from_f64(#literal));
    if value < 0.0 {
        quote!(-#positive)
    } else {
        positive
    }
}
