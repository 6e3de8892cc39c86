//! The parameters' type, and the shell of a broken model.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use crate::compile::Compiled;
use crate::syntax::ast::{self, Statement};

/// `NameParameters` with its `Default`.
pub(super) fn items(compiled: &Compiled) -> TokenStream {
    let model = &compiled.model;
    let (visibility, name) = (&model.visibility, format_ident!("{}Parameters", model.name));
    let fields = model.parameters.iter().map(|parameter| {
        let (name, documentation) = (&parameter.name, &parameter.documentation);
        let unit = if parameter.unit.is_empty() {
            "no unit".to_owned()
        } else {
            format!("in {}", parameter.unit)
        };
        let line = format!(
            "{unit}, {} by default.",
            crate::symbolic::print::number(parameter.default)
        );
        quote!(#(#documentation)* #[doc = #line] pub #name: T)
    });
    let defaults = model.parameters.iter().map(|parameter| {
        let (name, value) = (&parameter.name, number(parameter.default));
        quote!(#name: #value)
    });
    let documentation = format!("Parameters of [`{}`].", model.name);
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
    let positive = quote!(<T as ::mbg_runtime::Real>::from_f64(#literal));
    if value < 0.0 {
        quote!(-#positive)
    } else {
        positive
    }
}

/// Types without behaviour.
pub(super) fn shell(model: &ast::Model) -> TokenStream {
    let (visibility, name, documentation) = (&model.visibility, &model.name, &model.documentation);
    let parameters = format_ident!("{}Parameters", name);
    let fields: Vec<_> = model
        .statements
        .iter()
        .filter_map(|statement| {
            if let Statement::Parameter(parameter) = statement {
                Some(&parameter.name)
            } else {
                None
            }
        })
        .collect();
    quote! {
        #(#documentation)*
        #visibility struct #name<T = f64> { scalar: ::core::marker::PhantomData<T> }
        #[allow(missing_docs)]
        #visibility struct #parameters<T = f64> {
            #(pub #fields: T,)*
            #[doc(hidden)] pub scalar: ::core::marker::PhantomData<T>,
        }
        impl<T> ::core::default::Default for #parameters<T> {
            fn default() -> Self { loop {} }
        }
        #[allow(missing_docs)]
        impl<T> #name<T> {
            pub fn new(_: #parameters<T>) -> ::core::result::Result<Self, ::mbg_runtime::ParameterError> { loop {} }
        }
    }
}
