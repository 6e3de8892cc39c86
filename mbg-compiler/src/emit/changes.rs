//! Methods of a model that tell where choices in its laws change.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{Setting, lines};
use super::system::{body, memory};
use crate::changes::Kind;
use crate::compile::{Compiled, Routines};

/// Where choices by time alone change; none where there are none.
pub(super) fn next_change(compiled: &Compiled) -> Option<TokenStream> {
    let is_empty = compiled.program.routines[Routines::CHANGES]
        .results
        .is_empty();
    let body = body(compiled, Routines::CHANGES, &|times| {
        let (once, again) = times.split_at(compiled.changes_once);
        let again = again.chunks(2).map(|repeated| quote!([#(#repeated),*]));
        quote!(mbg_runtime::__private::next_of(t, &[#(#once),*], &[#(#again),*]))
    });
    (!is_empty).then(|| {
        quote! {
            fn next_change(&self, t: T) -> ::core::option::Option<T> { #body }
        }
    })
}

/// How the arguments of choices go between two points; none where no step can pass more than it finds.
pub(super) fn courses(compiled: &Compiled) -> Option<TokenStream> {
    let [states, inputs] = [compiled.states.len(), compiled.model.inputs.len()];
    let [n, m, both] = [states, inputs, states + inputs].map(Literal::usize_suffixed);
    let joined = (inputs > 0)
        .then(|| quote!(let slopes: [T; #both] = mbg_runtime::__private::joined(slopes, rates);));
    let memory = memory(compiled);
    let groups = Literal::usize_suffixed(compiled.thresholds.len());
    let routine = &compiled.program.routines[Routines::THRESHOLDS];
    let (steps, results) = lines(compiled, routine, Setting::Method);
    let mut rest = &results[..];
    let mut arguments = Vec::new();
    let mut calls = Vec::new();
    for (group, kind) in compiled.thresholds.iter().enumerate() {
        let Kind {
            thresholds,
            repeats,
            is_choice,
        } = *kind;
        let (own, others) = rest.split_at(2 + thresholds);
        rest = others;
        let (argument, thresholds) = own.split_at(2);
        let group = Literal::usize_suffixed(group);
        arguments.push(quote!([#(#argument),*]));
        calls.push(quote! {
            each(mbg_runtime::Course {
                from: from[#group], to: to[#group], thresholds: &[#(#thresholds),*],
                repeats: #repeats, is_choice: #is_choice,
            });
        });
    }
    let vector = |size| quote!(&mbg_runtime::__private::SVector<T, #size>);
    let [state, input] = [&n, &m].map(vector);
    let point = quote!((T, [#state; 2], [#input; 2]));
    (!compiled.thresholds.is_empty()).then(|| {
        quote! {
            const HAS_COURSES: ::core::primitive::bool = true;
            fn courses(
                &self, from: #point, to: #point, memory: &mut #memory,
                mut each: impl ::core::ops::FnMut(mbg_runtime::Course<'_, T>),
            ) {
                let mut arguments = |(t, [x, slopes], [u, rates]): #point| -> [[T; 2]; #groups] {
                    #joined
                    #steps
                    [#(#arguments),*]
                };
                let (from, to) = (arguments(from), arguments(to));
                #(#calls)*
            }
        }
    })
}

/// Where choices by time and inputs change that have no times of their own; none where there are none.
pub(super) fn change_between(compiled: &Compiled) -> Option<TokenStream> {
    let m = Literal::usize_suffixed(compiled.model.inputs.len());
    let routine = &compiled.program.routines[Routines::SOUGHT];
    let (steps, results) = lines(compiled, routine, Setting::Method);
    let count = Literal::usize_suffixed(results.len());
    (!results.is_empty()).then(|| {
        quote! {
            const SEEKS_CHANGES: ::core::primitive::bool = true;
            fn change_between(
                &self, from: T, to: T, input: impl ::core::ops::Fn(T) -> mbg_runtime::__private::SVector<T, #m>,
            ) -> ::core::option::Option<T> {
                mbg_runtime::__private::change_between(from, to, |t: T| -> [T; #count] {
                    let u = &input(t);
                    let _ = u;
                    #steps
                    [#(#results),*]
                })
            }
        }
    })
}
