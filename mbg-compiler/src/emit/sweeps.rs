//! Jacobians by sweeps, several directions at once.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::routine::{Writer, sweep_lines};
use super::tokens::block;
use crate::program::{Line, Mode, Operand, Routine, Source, Sweep, Unit};

/// Writes `jacobian`, sweep by sweep; the steps of the routine stand before it.
pub(super) fn write(writer: &Writer, routine: &Routine) -> TokenStream {
    routine.sweeps.iter().map(|it| sweep(writer, it)).collect()
}

fn sweep(writer: &Writer, sweep: &Sweep) -> TokenStream {
    let units = sweep.coverage.units.iter().map(unit);
    let worked_out: Vec<usize> = (0..sweep.results.len())
        .filter(|result| !is_zero(sweep.results[*result]))
        .collect();
    let (lines, slopes) = sweep_lines(writer, sweep, &worked_out);
    let directions = sweep.coverage.directions.iter();
    let directions = directions.filter_map(|it| direction(it));
    let worked_out = worked_out.into_iter().map(Literal::usize_suffixed);
    let mut body = quote! {
        use mbg_runtime::Real as _;
        let whole = |value: T| <T::Columns as mbg_runtime::Columns<T>>::whole(value);
    };
    body.extend([lines, quote!([#(#slopes),*])]);
    let body = block(body);
    let filled = match sweep.coverage.mode {
        Mode::Forward => format_ident!("columns"),
        Mode::Reverse => format_ident!("rows"),
    };
    quote! {
        #(#units)*
        mbg_runtime::__private::#filled(
            jacobian, &[#(#directions),*], &[#(#worked_out),*], &|changing, slopes| #body,
        );
    }
}

/// A line, and those that go with it, with their entries.
fn direction(direction: &[Line]) -> Option<TokenStream> {
    let (first, others) = direction.split_first()?;
    let others = others.iter().map(|line| {
        let entries = line.entries.iter().copied().map(Literal::usize_unsuffixed);
        let number = Literal::usize_unsuffixed(line.number);
        quote!((#number, &[#(#entries),*]))
    });
    let first = Literal::usize_unsuffixed(first.number);
    Some(quote!((#first, &[#(#others),*])))
}

fn is_zero(result: Operand) -> bool {
    result.source == Source::Constant(0.0)
}

fn unit(unit: &Unit) -> TokenStream {
    let one = Literal::f64_suffixed(if unit.negative { -1.0 } else { 1.0 });
    let [row, column] = [unit.row, unit.column].map(Literal::usize_suffixed);
    quote!(jacobian[(#row, #column)] = T::from_f64(#one);)
}
