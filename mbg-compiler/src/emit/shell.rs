//! What stands in for a model with a mistake.
//!
//! Its types and methods exist, so that the code around the model compiles and the user sees the mistake and nothing
//! else. None of it ever runs: the error stops the build.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::elaborate::Sizes;
use crate::syntax::ast::{self, Statement};

pub(super) fn items(model: &ast::Model, sizes: Sizes) -> TokenStream {
    let (visibility, name) = (&model.visibility, &model.name);
    let parameters = format_ident!("{}Parameters", name);
    // A name given twice is the mistake that has been told.
    let fields: BTreeMap<&Ident, Option<usize>> = model
        .statements
        .iter()
        .filter_map(|statement| match statement {
            Statement::Parameter(parameter) => Some((&parameter.name, parameter.dimension)),
            _ => None,
        })
        .collect();
    let scalar = fields
        .is_empty()
        .then(|| quote!(#[doc(hidden)] pub scalar: ::core::marker::PhantomData<T>));
    let fields =
        fields.into_iter().map(
            |(name, dimension)| match dimension.map(Literal::usize_suffixed) {
                None => quote!(#name: T),
                Some(size) => quote!(#name: [T; #size]),
            },
        );
    let behaviour = behaviour(name, sizes);
    let [n, m, p] = [sizes.states, sizes.inputs, sizes.outputs].map(Literal::usize_suffixed);
    quote! {
        #[allow(missing_docs)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #visibility struct #name<T = f64> { scalar: ::core::marker::PhantomData<T> }
        #[allow(missing_docs)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #visibility struct #parameters<T = f64> {
            #(pub #fields,)*
            #scalar
        }
        impl<T> ::core::default::Default for #parameters<T> {
            fn default() -> Self { loop {} }
        }
        #[allow(missing_docs)]
        impl<T: ::mbg_runtime::Real> #name<T> {
            pub fn new(_: #parameters<T>) -> ::core::result::Result<Self, ::mbg_runtime::ParameterError> {
                loop {}
            }
            pub fn parameters(&self) -> &#parameters<T> { loop {} }
        }
        impl<T: ::mbg_runtime::Real> ::mbg_runtime::System<T, #n, #m, #p> for #name<T> { #behaviour }
        impl<T: ::mbg_runtime::Real> ::mbg_runtime::Convertible<T, #n, #m, #p> for #name<T> {
            type With<L: ::mbg_runtime::Real> = #name<L>;
            const STRAIGHT: bool = true;
            fn converted<L: ::mbg_runtime::Real>(&self, _: impl ::core::ops::Fn(T) -> L) -> #name<L> { loop {} }
        }
    }
}

/// The methods of `System`, as they are declared.
fn behaviour(name: &Ident, sizes: Sizes) -> TokenStream {
    let [n, m, p] = [sizes.states, sizes.inputs, sizes.outputs].map(Literal::usize_suffixed);
    let vector = |size: &Literal| quote!(::mbg_runtime::__private::SVector<T, #size>);
    let matrix = |columns: &Literal| quote!(::mbg_runtime::__private::SMatrix<T, #n, #columns>);
    let (x, u, y) = (vector(&n), vector(&m), vector(&p));
    let (by_state, by_input) = (matrix(&n), matrix(&m));
    let name = name.to_string();
    quote! {
        const META: &'static ::mbg_runtime::Meta = &::mbg_runtime::Meta {
            name: #name, parameters: &[], states: &[], inputs: &[], outputs: &[], bonds: &[], dependent: &[],
            conditioning: &[], eliminated: &[], closures: &[], loops: &[], assumptions: &[], notes: &[], diagram: "",
            operations: ::mbg_runtime::Operations {
                derivative: 0, output: 0, derivative_and_jacobian: 0, jacobian_input: 0, energy: 0, power: 0, angles: 0,
            },
        };
        type Memory = ();
        type Conditioning = [T; 0];
        fn initial_state(&self) -> #x { loop {} }
        fn derivative(&self, _: T, _: &#x, _: &#u, _: &mut ()) -> #x { loop {} }
        fn output(&self, _: T, _: &#x, _: &#u, _: &mut ()) -> #y { loop {} }
        fn jacobian_state(&self, _: T, _: &#x, _: &#u, _: &mut ()) -> #by_state { loop {} }
        fn jacobian_input(&self, _: T, _: &#x, _: &#u, _: &mut ()) -> #by_input { loop {} }
        fn energy(&self, _: T, _: &#x) -> T { loop {} }
        fn power(&self, _: T, _: &#x, _: &#u, _: &mut ()) -> ::mbg_runtime::Power<T> { loop {} }
        fn conditioning(&self, _: T, _: &#x, _: &#u) -> [T; 0] { loop {} }
    }
}
