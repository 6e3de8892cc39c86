//! The Jacobians of a model and the derivative beside them.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{Place, Writer, written_lines};
use super::sweeps;
use super::tokens::block;
use crate::compile::{Compiled, Routines};
use crate::program::Source;

/// The methods of `System`, whose first arguments and type of memory are given.
pub(super) fn methods(
    compiled: &Compiled,
    arguments: &TokenStream,
    memory: &TokenStream,
) -> TokenStream {
    let [states, inputs] = [compiled.states.len(), compiled.model.inputs.len()];
    let derivative_and_jacobian =
        block(written(compiled, Routines::DERIVATIVE_AND_JACOBIAN, states));
    let jacobian_input = written(compiled, Routines::JACOBIAN_INPUT, inputs);
    let [n, m] = [states, inputs].map(Literal::usize_suffixed);
    quote! {
        #[inline]
        fn jacobian_state(&self, #arguments, memory: &mut #memory) -> mbg_runtime::__private::SMatrix<T, #n, #n> {
            mbg_runtime::System::derivative_and_jacobian(self, t, x, u, memory).1
        }
        #[inline]
        fn derivative_and_jacobian(
            &self, #arguments, memory: &mut #memory,
        ) -> (mbg_runtime::__private::SVector<T, #n>, mbg_runtime::__private::SMatrix<T, #n, #n>) {
            let mut both = (
                mbg_runtime::__private::SVector::<T, #n>::from_element(T::from_f64(0.0)),
                mbg_runtime::__private::SMatrix::<T, #n, #n>::from_element(T::from_f64(0.0)),
            );
            mbg_runtime::System::derivative_and_jacobian_into(self, t, x, u, memory, &mut both.0, &mut both.1);
            both
        }
        #[inline]
        fn derivative_and_jacobian_into(
            &self, #arguments, memory: &mut #memory,
            derivative: &mut mbg_runtime::__private::SVector<T, #n>,
            jacobian: &mut mbg_runtime::__private::SMatrix<T, #n, #n>,
        ) #derivative_and_jacobian
        #[inline]
        fn jacobian_input(&self, #arguments, memory: &mut #memory) -> mbg_runtime::__private::SMatrix<T, #n, #m> {
            let mut input = mbg_runtime::__private::SMatrix::<T, #n, #m>::from_element(T::from_f64(0.0));
            let jacobian = &mut input;
            #jacobian_input
            input
        }
    }
}

/// Writes the results of a routine: the derivative, if it is one of both, and a Jacobian with so many columns.
fn written(compiled: &Compiled, routine: usize, columns: usize) -> TokenStream {
    let routine = &compiled.program.routines[routine];
    let is_written_out = routine.sweeps.is_empty();
    let entries = if is_written_out {
        columns * compiled.states.len()
    } else {
        0
    };
    let rates = 0..routine.results.len() - entries;
    let rates = rates.map(|row| Some(Place::Derivative(row)));
    let entries = routine.results[rates.len()..].iter().enumerate();
    let entries = entries.map(|(entry, result)| {
        let place = Place::Jacobian(entry / columns, entry % columns);
        (result.source != Source::Constant(0.0)).then_some(place)
    });
    let places: Vec<_> = rates.chain(entries).collect();
    let writer = Writer::of(compiled, routine);
    let mut lines = written_lines(&writer, routine, &places);
    lines.extend(sweeps::write(&writer, routine));
    lines
}
