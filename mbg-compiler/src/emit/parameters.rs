//! The parameters' type.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Items;
use super::meta::spaced;
use super::tokens::{self, structure};
use crate::compile::Compiled;
use crate::elaborate::{Elaborated, Parameter};
use crate::symbolic::print;

/// `NameParameters` with its `Default`.
pub(super) fn items(compiled: &Compiled) -> Items {
    let model = &compiled.model;
    let (visibility, name) = (&model.visibility, format_ident!("{}Parameters", model.name));
    let declared = fields(&model.parameters).map(|field| {
        let Parameter {
            declared,
            documentation,
            variable,
            ..
        } = &field[0];
        let unit = match variable.unit.as_str() {
            "" => "Without unit".to_owned(),
            unit => format!("In {unit}"),
        };
        let defaults = field.iter().map(|it| print::number(it.default));
        let defaults = defaults.collect::<Vec<_>>().join(", ");
        let (defaults, scalars) = match field[0].component {
            None => (defaults, quote!(T)),
            Some(_) => {
                let size = Literal::usize_suffixed(field.len());
                (format!("[{defaults}]"), quote!([T; #size]))
            }
        };
        let line = spaced(format!("{unit}; {defaults} by default."));
        quote!(#(#documentation)* #[doc = #line] pub #declared: #scalars)
    });
    let defaults = fields(&model.parameters).map(|field| {
        let name = &field[0].declared;
        let values = field.iter().map(|it| number(it.default));
        match field[0].component {
            None => quote!(#name: #(#values)*),
            Some(_) => quote!(#name: [#(#values),*]),
        }
    });
    let documentation = spaced(format!("Parameters of [`{}`].", model.name));
    let (field, default) = if model.parameters.is_empty() {
        (
            quote!(#[doc(hidden)] pub scalar: ::core::marker::PhantomData<T>),
            quote!(scalar: ::core::marker::PhantomData),
        )
    } else {
        (TokenStream::new(), TokenStream::new())
    };
    let (derived, written) = traits(model, &name);
    let declared = structure(visibility, &name, quote!(#(#declared,)* #field));
    let types = quote! {
        #[doc = #documentation]
        #[derive(Clone, Copy, #derived)]
        #declared
    };
    let behaviour = quote! {
        #written

        #[automatically_derived]
        impl<T: mbg_runtime::Real> ::core::default::Default for #name<T> {
            fn default() -> Self { Self { #(#defaults,)* #default } }
        }
    };
    Items { types, behaviour }
}

/// Traits of parameters: those that are derived, and those that are written. Derived, clippy would have `Eq` beside `PartialEq`; and
/// the only field of parameters without any is nobody's business.
fn traits(model: &Elaborated, name: &Ident) -> (TokenStream, TokenStream) {
    if model.parameters.is_empty() {
        let text = name.to_string();
        let written = quote! {
            impl<T> ::core::fmt::Debug for #name<T> {
                fn fmt(&self, formatter: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                    formatter.write_str(#text)
                }
            }

            impl<T> ::core::cmp::PartialEq for #name<T> {
                fn eq(&self, _: &Self) -> ::core::primitive::bool { true }
            }
        };
        return (TokenStream::new(), written);
    }
    let equal = fields(&model.parameters).map(|field| {
        let name = &field[0].declared;
        quote!(self.#name == other.#name)
    });
    let written = quote! {
        impl<T: ::core::cmp::PartialEq> ::core::cmp::PartialEq for #name<T> {
            fn eq(&self, other: &Self) -> ::core::primitive::bool { #(#equal)&&* }
        }
    };
    (quote!(Debug), written)
}

/// The parameters by field of their type: those of a vector are declared one behind the other.
pub(super) fn fields(parameters: &[Parameter]) -> impl Iterator<Item = &[Parameter]> {
    parameters.chunk_by(|one, next| one.declared == next.declared)
}

/// What reads a parameter.
pub(super) fn read(parameter: &Parameter) -> TokenStream {
    let name = &parameter.declared;
    match parameter.component.map(Literal::usize_suffixed) {
        None => quote!(parameters.#name),
        Some(component) => quote!(parameters.#name[#component]),
    }
}

/// A number of the scalar's type.
fn number(value: f64) -> TokenStream {
    let literal = tokens::number(value.abs());
    let positive = quote!(T::from_f64(#literal));
    if value < 0.0 {
        quote!(-#positive)
    } else {
        positive
    }
}
