//! Jacobians of several columns at once.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{Writer, column_lines};
use super::tokens::block;
use crate::program::{Column, Columns, Operand, Routine, Source};
use crate::symbolic::Symbol;

/// Writes `jacobian`, column by column; the steps of the routine stand before it.
pub(super) fn write(writer: &Writer, routine: &Routine) -> TokenStream {
    routine.columns.iter().map(|it| group(writer, it)).collect()
}

/// Some columns. Rows that hold one constant need no steps.
fn group(writer: &Writer, columns: &Columns) -> TokenStream {
    let constant = columns.results.iter().enumerate();
    let constant = constant.filter_map(|(row, result)| only_entry(row, *result));
    let steps: Vec<usize> = (0..columns.results.len())
        .filter(|row| is_worked_out(columns.results[*row]))
        .collect();
    let (lines, slopes) = column_lines(writer, columns, &steps);
    let directions = columns.directions.iter();
    let directions = directions.filter_map(|it| direction(it, &steps));
    let directions: Vec<_> = directions.collect();
    let steps = steps.into_iter().map(Literal::usize_suffixed);
    let mut body = quote! {
        use mbg_runtime::Real as _;
        let whole = |value: T| <T::Columns as mbg_runtime::Columns<T>>::whole(value);
    };
    body.extend([lines, quote!([#(#slopes),*])]);
    let body = block(body);
    quote! {
        #(#constant)*
        mbg_runtime::__private::columns(jacobian, &[#(#directions),*], &[#(#steps),*], &|changing, slopes| #body);
    }
}

/// A variable, and those that change with it, with the rows that are worked out and depend on them.
fn direction(direction: &[Column], steps: &[usize]) -> Option<TokenStream> {
    let (first, others) = direction.split_first()?;
    let others = others.iter().map(|column| {
        let rows = column.rows.iter().filter(|row| steps.contains(row));
        let rows = rows.map(|row| Literal::usize_unsuffixed(*row));
        let variable = Literal::usize_unsuffixed(column.variable);
        quote!((#variable, &[#(#rows),*]))
    });
    let first = Literal::usize_unsuffixed(first.variable);
    Some(quote!((#first, &[#(#others),*])))
}

fn is_worked_out(result: Operand) -> bool {
    !matches!(
        result.source,
        Source::Constant(_) | Source::Symbol(Symbol::Slope(_))
    )
}

/// The entry of a rate that is one of the variables.
fn only_entry(row: usize, result: Operand) -> Option<TokenStream> {
    let Source::Symbol(Symbol::Slope(column)) = result.source else {
        return None;
    };
    let one = Literal::f64_suffixed(if result.negative { -1.0 } else { 1.0 });
    let [row, column] = [row, column].map(Literal::usize_suffixed);
    Some(quote!(jacobian[(#row, #column)] = T::from_f64(#one);))
}
