//! The parameters' type.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Items;
use super::meta::spaced;
use super::tokens::{self, structure};
use crate::compile::Compiled;
use crate::elaborate::Parameter;
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
    let phantom = model.parameters.is_empty();
    let (field, default) = if phantom {
        (
            quote!(#[doc(hidden)] pub scalar: ::core::marker::PhantomData<T>),
            quote!(scalar: ::core::marker::PhantomData),
        )
    } else {
        (TokenStream::new(), TokenStream::new())
    };
    let (derived, written) = if phantom {
        (TokenStream::new(), Some(bare_traits(&name)))
    } else {
        (quote!(Debug, PartialEq), None)
    };
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

/// Traits of parameters without any, whose only field is nobody's business. Derived, clippy would have `Eq` beside them.
fn bare_traits(name: &Ident) -> TokenStream {
    let text = name.to_string();
    quote! {
        impl<T> ::core::fmt::Debug for #name<T> {
            fn fmt(&self, formatter: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                formatter.write_str(#text)
            }
        }

        impl<T> ::core::cmp::PartialEq for #name<T> {
            fn eq(&self, _: &Self) -> ::core::primitive::bool { true }
        }
    }
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
