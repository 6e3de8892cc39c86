//! What stands in for a model with a mistake.
//!
//! Its types and methods exist, so that the code around the model compiles and the user sees the mistake and nothing
//! else. None of it ever runs: the error stops the build. Nothing is known of its sizes. All of them are the constant in
//! which the mistakes are told: it has no value, and to Rust it is whatever size the code around asks for.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use super::Items;
use super::tokens::structure;
use crate::syntax::ast::{self, Statement};

/// The constant in which mistakes are told, by the first model that has one.
pub(super) fn constant(model: &ast::Model) -> Ident {
    format_ident!("{}Mistakes", model.name, span = Span::call_site())
}

pub(super) fn items(model: &ast::Model, size: &Ident) -> Items {
    let (visibility, name) = (&model.visibility, &model.name);
    let names = format_ident!("{}Parameters", name);
    let mut items = parameters(model, &names, size);
    items.types.extend(aliases(model));
    let behaviour = behaviour(name, size);
    let scalar = quote!(scalar: ::core::marker::PhantomData<T>);
    let declared = structure(visibility, name, scalar);
    items.types.extend(quote! {
        /// Stands in for a model with a mistake.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #declared
    });
    items.behaviour.extend(quote! {
        impl<T: mbg_runtime::Real> #name<T> {
            /// As that of the model.
            pub fn new(_: #names<T>) -> ::core::result::Result<Self, mbg_runtime::ParameterError> {
                loop {}
            }
            /// As those of the model.
            pub fn parameters(&self) -> &#names<T> { loop {} }
        }
        impl<T: mbg_runtime::Real> mbg_runtime::System<T, #size, #size, #size> for #name<T> { #behaviour }
        impl<T: mbg_runtime::Real> mbg_runtime::Convertible<T, #size, #size, #size> for #name<T> {
            type With<L: mbg_runtime::Real> = #name<L>;
            const STRAIGHT: ::core::primitive::bool = true;
            fn converted<L: mbg_runtime::Real>(&self, _: impl ::core::ops::Fn(T) -> L) -> #name<L> { loop {} }
        }
    });
    items
}

/// The names that the code around uses of a model which is called as a parameter of the types here: those of Rust's own types
/// mean these there, too.
fn aliases(model: &ast::Model) -> TokenStream {
    let written = model.written.as_ref();
    let Some(written) = written.filter(|it| it.to_string().starts_with(char::is_uppercase)) else {
        return TokenStream::new();
    };
    let visibility = &model.visibility;
    let aliases = ["", "Parameters"].map(|end| {
        let [alias, name] = [written, &model.name].map(|name| format_ident!("{name}{end}"));
        quote! {
            #[doc(hidden)]
            #visibility type #alias<Scalar = ::core::primitive::f64> = #name<Scalar>;
        }
    });
    aliases.into_iter().collect()
}

/// The type of the parameters. An array of no known size is no iterator, and what it would iterate over is to Rust whatever
/// type is asked for: that of each field, and that of all parameters where a statement that was not read may have been one.
fn parameters(model: &ast::Model, name: &Ident, size: &Ident) -> Items {
    let visibility = &model.visibility;
    let whatever = quote!(<[T; #size] as ::core::iter::Iterator>::Item);
    let statements = || model.statements.iter();
    if statements().any(|statement| matches!(statement, Statement::Broken(_))) {
        let types = quote! {
            /// Stands in for the parameters of a model with a mistake.
            #visibility type #name<T = ::core::primitive::f64> = #whatever;
        };
        return Items {
            types,
            ..Items::default()
        };
    }
    // A name given twice is the mistake that has been told.
    let fields: BTreeSet<&Ident> = statements()
        .filter_map(|statement| match statement {
            Statement::Parameter(parameter) => Some(&parameter.name),
            _ => None,
        })
        .collect();
    let scalar = fields
        .is_empty()
        .then(|| quote!(#[doc(hidden)] pub scalar: ::core::marker::PhantomData<T>));
    let fields = fields.into_iter().map(|field| {
        quote! {
            /// As that of the model.
            pub #field: #whatever,
        }
    });
    let declared = structure(visibility, name, quote!(#(#fields)* #scalar));
    let types = quote! {
        /// Stands in for the parameters of a model with a mistake.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #declared
    };
    let behaviour = quote! {
        impl<T> ::core::default::Default for #name<T> {
            fn default() -> Self { loop {} }
        }
    };
    Items { types, behaviour }
}

/// The methods of `System`, as they are declared.
fn behaviour(name: &Ident, size: &Ident) -> TokenStream {
    let vector = quote!(mbg_runtime::__private::SVector<T, #size>);
    let matrix = quote!(mbg_runtime::__private::SMatrix<T, #size, #size>);
    let memory = quote!([(); #size]);
    let name = name.to_string();
    quote! {
        const META: &'static mbg_runtime::Meta = &mbg_runtime::Meta {
            name: #name, parameters: &[], states: &[], inputs: &[], outputs: &[], bonds: &[], dependent: &[],
            conditioning: &[], eliminated: &[], closures: &[], loops: &[], assumptions: &[], notes: &[], diagram: "",
            operations: mbg_runtime::Operations {
                derivative: 0, output: 0, derivative_and_jacobian: 0, jacobian_input: 0, energy: 0, power: 0, angles: 0,
            },
        };
        type Memory = #memory;
        type Conditioning = [T; #size];
        type Room = mbg_runtime::Room<0>;
        fn initial_state(&self) -> #vector { loop {} }
        fn derivative(&self, _: T, _: &#vector, _: &#vector, _: &mut #memory) -> #vector { loop {} }
        fn output(&self, _: T, _: &#vector, _: &#vector, _: &mut #memory) -> #vector { loop {} }
        fn jacobian_state(&self, _: T, _: &#vector, _: &#vector, _: &mut #memory) -> #matrix { loop {} }
        fn jacobian_input(&self, _: T, _: &#vector, _: &#vector, _: &mut #memory) -> #matrix { loop {} }
        fn energy(&self, _: T, _: &#vector) -> T { loop {} }
        fn power(&self, _: T, _: &#vector, _: &#vector, _: &mut #memory) -> mbg_runtime::Power<T> { loop {} }
        fn conditioning(&self, _: T, _: &#vector, _: &#vector) -> [T; #size] { loop {} }
    }
}
