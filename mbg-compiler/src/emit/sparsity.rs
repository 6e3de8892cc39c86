//! The constant `SPARSITY`.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use crate::sparsity::{Elimination, Pattern};

/// Elements visited by a plan cost so many times what they do in a dense factorisation, whose loops run over rows.
const COST: usize = 2;

/// Pattern and plan; no plan where a dense factorisation is as fast, and nothing where the states have no numbers.
pub(super) fn constant(pattern: &Pattern) -> TokenStream {
    let size = pattern.len();
    if u16::try_from(size).is_err() {
        return quote!(::core::option::Option::None);
    }
    let plan = Elimination::of(pattern);
    let elimination = if COST * plan.operations() < dense(size) {
        let [lower, upper] = [&plan.lower, &plan.upper].map(|rows| nested(rows));
        let order = numbers(&plan.order);
        quote! {
            ::core::option::Option::Some(::mbg_runtime::Elimination {
                order: #order, lower: #lower, upper: #upper,
            })
        }
    } else {
        quote!(::core::option::Option::None)
    };
    let rows = nested(pattern);
    quote! {
        ::core::option::Option::Some(&::mbg_runtime::Sparsity { rows: #rows, elimination: #elimination })
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
