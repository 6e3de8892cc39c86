//! Methods of a model that tell where choices in its laws change.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{Setting, lines};
use super::system::{body, memory};
use crate::changes::Kind;
use crate::compile::{Compiled, Routines};
use crate::symbolic::Symbol;

/// All of them that a model has.
pub(super) fn changes(compiled: &Compiled) -> TokenStream {
    let methods = [next_change, change_between, has_changed, courses];
    methods.iter().filter_map(|told| told(compiled)).collect()
}

/// Where choices by time alone change; none where there are none.
fn next_change(compiled: &Compiled) -> Option<TokenStream> {
    let is_empty = compiled.program.routines[Routines::CHANGES]
        .results
        .is_empty();
    let body = body(compiled, Routines::CHANGES, &|times| {
        let (once, again) = times.split_at(compiled.changes.once);
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
fn courses(compiled: &Compiled) -> Option<TokenStream> {
    let [states, inputs] = [compiled.states.len(), compiled.model.inputs.len()];
    let [n, m, both] = [states, inputs, states + inputs].map(Literal::usize_suffixed);
    let routine = &compiled.program.routines[Routines::THRESHOLDS];
    let mut rates = (states..states + inputs).map(Symbol::Slope);
    let (follow, joined) = match rates.any(|rate| routine.reads(rate)) {
        true => (
            None,
            Some(quote!(let slopes: [T; #both] = mbg_runtime::__private::joined(slopes, rates);)),
        ),
        false => (
            Some(quote!(
                const COURSES_FOLLOW_INPUTS: ::core::primitive::bool = false;
            )),
            None,
        ),
    };
    let memory = memory(compiled);
    let groups = Literal::usize_suffixed(compiled.thresholds.len());
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
            #follow
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
fn change_between(compiled: &Compiled) -> Option<TokenStream> {
    let (asked, told) = by_time(compiled, Routines::SOUGHT)?;
    let (signs, turns) = told.split_at(compiled.changes.sought);
    let counts = [signs, turns].map(|told| Literal::usize_suffixed(told.len()));
    let [of_signs, of_turns] = counts;
    let input = input(compiled);
    Some(quote! {
        const SEEKS_CHANGES: ::core::primitive::bool = true;
        fn change_between(&self, from: T, to: T, input: #input) -> ::core::option::Option<T> {
            mbg_runtime::__private::change_between(from, to, |t: T| -> ([T; #of_signs], [T; #of_turns]) {
                #asked
                ([#(#signs),*], [#(#turns),*])
            })
        }
    })
}

/// Whether choices by time and inputs differ between two times; none where there are none.
fn has_changed(compiled: &Compiled) -> Option<TokenStream> {
    let (asked, told) = by_time(compiled, Routines::SIDES)?;
    let (compared, turns) = told.split_at(2 * compiled.changes.compared);
    let pairs = compared.chunks(2).map(|pair| quote!([#(#pair),*]));
    let counts = [pairs.len(), turns.len()].map(Literal::usize_suffixed);
    let [of_pairs, of_turns] = counts;
    let input = input(compiled);
    Some(quote! {
        fn has_changed(&self, from: T, to: T, input: #input) -> ::core::primitive::bool {
            mbg_runtime::__private::has_changed(from, to, |t: T| -> ([[T; 2]; #of_pairs], [T; #of_turns]) {
                #asked
                ([#(#pairs),*], [#(#turns),*])
            })
        }
    })
}

/// What works out a routine at a time and an input, and its results, if it has any.
fn by_time(compiled: &Compiled, routine: usize) -> Option<(TokenStream, Vec<TokenStream>)> {
    let routine = &compiled.program.routines[routine];
    let (steps, results) = lines(compiled, routine, Setting::Method);
    let asked = quote! {
        let u = &input(t);
        let _ = u;
        #steps
    };
    (!results.is_empty()).then_some((asked, results))
}

/// The type of an input over time.
fn input(compiled: &Compiled) -> TokenStream {
    let m = Literal::usize_suffixed(compiled.model.inputs.len());
    quote!(impl ::core::ops::Fn(T) -> mbg_runtime::__private::SVector<T, #m>)
}
