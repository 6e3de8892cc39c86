//! The constant `SPARSITY`, and its plan of elimination as straight-line code.
//!
//! Products of a factorisation, by plan and dense: 192 of 240 in the inertial navigation system, 196 of 910 in an arm of
//! seven axes, 1872 of 10912 in a plane chain of sixteen rods, 84 of 1120 in the ring modulator. Whether a plan pays is
//! decided by that count; the constants are measured by `cargo bench --bench elimination`.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::tokens::numbered;
use crate::sparsity::{Elimination, Pattern};

/// Products of a factorisation up to which it is written out; beyond, a loop runs over the plan, so that code stays small.
const UNROLLED: usize = 3000;

/// A dense factorisation takes so many halves of a written-out product for each element of the matrix: its loops over
/// rows work on several elements at once, the search for pivots does not.
const HALVES: usize = 7;

/// A product of the loop takes so many times as long as one of a dense factorisation in a large model.
const LOOP: usize = 7;

/// Pattern and plan, and the plan written out where it is short enough. There is no plan where a dense factorisation is
/// as fast, and nothing where the states have no numbers.
pub(super) fn items(pattern: &Pattern) -> TokenStream {
    let plan = Elimination::of(pattern);
    let plan = pays(&plan).then_some(plan);
    let constant = constant(pattern, plan.as_ref());
    let short = plan.filter(|plan| plan.operations() <= UNROLLED);
    let unrolled = short.map(|plan| unrolled(pattern, &plan));
    quote! {
        const SPARSITY: ::core::option::Option<&'static mbg_runtime::Sparsity> = #constant;
        #unrolled
    }
}

fn constant(pattern: &Pattern, plan: Option<&Elimination>) -> TokenStream {
    if u16::try_from(pattern.len()).is_err() {
        return quote!(::core::option::Option::None);
    }
    let elimination = if let Some(plan) = plan {
        let [lower, upper] = [&plan.lower, &plan.upper].map(|rows| nested(rows));
        let order = numbers(&plan.order);
        quote! {
            ::core::option::Option::Some(mbg_runtime::Elimination {
                order: #order, lower: #lower, upper: #upper,
            })
        }
    } else {
        quote!(::core::option::Option::None)
    };
    let rows = nested(pattern);
    quote! {
        ::core::option::Option::Some(&mbg_runtime::Sparsity { rows: #rows, elimination: #elimination })
    }
}

/// Whether a plan is faster than a dense factorisation.
fn pays(plan: &Elimination) -> bool {
    let (products, size) = (plan.operations(), plan.order.len());
    if products > UNROLLED {
        LOOP * products < dense(size)
    } else {
        2 * products < HALVES * size * size
    }
}

/// Products of a dense factorisation: one per multiplier and per element behind it.
fn dense(size: usize) -> usize {
    (0..size).map(|rest| rest * (rest + 1)).sum()
}

/// Rows of numbers.
fn nested<'a, R>(rows: &'a [R]) -> TokenStream
where
    &'a R: IntoIterator<Item = &'a usize>,
{
    let rows = rows.iter().map(numbers);
    quote!(&[#(#rows),*])
}

fn numbers<'a>(numbers: impl IntoIterator<Item = &'a usize>) -> TokenStream {
    let numbers = numbers.into_iter().map(|it| Literal::usize_unsuffixed(*it));
    quote!(&[#(#numbers),*])
}

/// The plan written out.
fn unrolled(pattern: &Pattern, plan: &Elimination) -> TokenStream {
    let [eliminated, substituted] = [eliminated(pattern, plan), substituted(plan)];
    let size = Literal::usize_suffixed(pattern.len());
    quote! {
        const UNROLLED: ::core::primitive::bool = true;
        #[inline]
        fn eliminate<E: mbg_runtime::__private::Element>(
            entry: impl ::core::ops::Fn(::core::primitive::usize, ::core::primitive::usize) -> E,
            rows: &mut [[E; #size]; #size],
        ) -> ::core::primitive::bool {
            let mut holds = true;
            #eliminated
            holds
        }
        #[inline]
        fn substitute<E: mbg_runtime::__private::Element>(rows: &[[E; #size]; #size], x: &mut [E; #size]) {
            #substituted
        }
    }
}

/// Row by row: what the matrix holds there, less what the rows above contribute.
fn eliminated(pattern: &Pattern, plan: &Elimination) -> TokenStream {
    let element = |row: usize, column: usize| format_ident!("a{}_{}_", row, column);
    let size = |row: usize| numbered("size", row);
    let mut code = TokenStream::new();
    for row in plan.order.iter().copied() {
        let filled = || plan.lower[row].iter().chain([&row]).chain(&plan.upper[row]);
        let own = size(row);
        let mut entries = Vec::new();
        for column in filled() {
            let name = element(row, *column);
            let place = [row, *column].map(Literal::usize_suffixed);
            let [i, j] = &place;
            if *column == row || pattern[row].contains(column) {
                code.extend(quote!(let #name = entry(#i, #j);));
                entries.push(name);
            } else {
                code.extend(quote!(let #name = E::zero();));
            }
        }
        code.extend(quote!(let #own = mbg_runtime::__private::largest([#(#entries),*]);));
        for pivot in plan.lower[row].iter().copied() {
            let (factor, above) = (element(row, pivot), element(pivot, pivot));
            let scale = size(pivot);
            code.extend(quote! {
                let #factor = #factor * #above;
                holds &= mbg_runtime::__private::holds(#factor, #scale, #own);
            });
            for column in plan.upper[pivot].iter().copied() {
                let (value, above) = (element(row, column), element(pivot, column));
                code.extend(quote!(let #value = #value.less(#factor, #above);));
            }
        }
        let diagonal = element(row, row);
        code.extend(quote!(let #diagonal = #diagonal.reciprocal();));
        for column in filled() {
            let name = element(row, *column);
            let [i, j] = [row, *column].map(Literal::usize_suffixed);
            code.extend(quote!(rows[#i][#j] = #name;));
        }
    }
    code
}

/// Forward and backward substitution.
fn substituted(plan: &Elimination) -> TokenStream {
    let name = |row: usize| numbered("x", row);
    let mut code = TokenStream::new();
    let less = |row: usize, columns: &[usize]| {
        let x = name(row);
        let terms = columns.iter().map(|column| {
            let (i, j) = (
                Literal::usize_suffixed(row),
                Literal::usize_suffixed(*column),
            );
            let known = name(*column);
            quote!(let #x = #x.less(rows[#i][#j], #known);)
        });
        terms.collect::<TokenStream>()
    };
    for row in plan.order.iter().copied() {
        let (x, i) = (name(row), Literal::usize_suffixed(row));
        let terms = less(row, &plan.lower[row]);
        code.extend(quote!(let #x = x[#i]; #terms));
    }
    for row in plan.order.iter().rev().copied() {
        let (x, i) = (name(row), Literal::usize_suffixed(row));
        let terms = less(row, &plan.upper[row]);
        code.extend(quote!(#terms let #x = #x * rows[#i][#i]; x[#i] = #x;));
    }
    code
}
