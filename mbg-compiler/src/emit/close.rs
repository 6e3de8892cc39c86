//! `System::close`: attitudes made rotations again, and the projection onto closed loops.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{Setting, lines};
use super::system::cold_memory;
use crate::compile::{Compiled, Routines};

/// The method; nothing for a model that has neither attitudes nor loops.
pub(super) fn close(compiled: &Compiled) -> Option<TokenStream> {
    if compiled.attitudes.is_empty() && compiled.model.graph.closures.is_empty() {
        return None;
    }
    let [n, m] = [compiled.states.len(), compiled.model.inputs.len()].map(Literal::usize_suffixed);
    let attitudes: Vec<TokenStream> = compiled.attitudes.iter().map(|it| attitude(it)).collect();
    let projections = [Routines::CLOSED_POSITIONS, Routines::CLOSED_FLOWS]
        .into_iter()
        .zip(&compiled.closed)
        .filter(|(_, closed)| !closed.is_empty())
        .map(|(routine, closed)| projection(compiled, &attitudes, routine, closed));
    Some(quote! {
        fn close(
            &self,
            t: T,
            x: ::mbg_runtime::__private::SVector<T, #n>,
            u: &::mbg_runtime::__private::SVector<T, #m>,
            held: &[usize],
        ) -> ::core::result::Result<::mbg_runtime::__private::SVector<T, #n>, ::mbg_runtime::Trouble> {
            #(#projections)*
            #(#attitudes)*
            ::core::result::Result::Ok(x)
        }
    })
}

/// Makes the states of an attitude a rotation.
fn attitude(rows: &[Vec<usize>]) -> TokenStream {
    let rows = rows.iter().map(|row| {
        let places = row.iter().copied().map(Literal::usize_suffixed);
        quote!([#(#places),*])
    });
    quote!(let x = ::mbg_runtime::__private::orthonormal(x, &[#(#rows),*], held);)
}

/// Projects onto the residuals of a routine, which are those of the closures given. They are looked at where every
/// attitude is a rotation, so that what makes it one in the end opens no loop.
fn projection(
    compiled: &Compiled,
    attitudes: &[TokenStream],
    routine: usize,
    closed: &[usize],
) -> TokenStream {
    let n = Literal::usize_suffixed(compiled.states.len());
    let program = &compiled.program.routines[routine];
    let (steps, results) = lines(compiled, program, Setting::Method);
    let (values, jacobian) = results.split_at(closed.len());
    let size = Literal::usize_suffixed(closed.len());
    let closures = closed.iter().copied().map(Literal::usize_suffixed);
    let memory = cold_memory(compiled, routine);
    let rotations = (!attitudes.is_empty()).then(|| quote!(let x = *x; #(#attitudes)* let x = &x;));
    quote! {
        let x = ::mbg_runtime::__private::close(
            Self::META, &[#(#closures),*], x, held,
            |x: &::mbg_runtime::__private::SVector<T, #n>| {
                #rotations
                #memory
                #steps
                (
                    ::mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#values),*]),
                    ::mbg_runtime::__private::SMatrix::<T, #size, #n>::from_row_slice(&[#(#jacobian),*]),
                )
            },
        )?;
    }
}
