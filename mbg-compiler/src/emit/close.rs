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
    let memory = quote!(Self::Memory);
    let body = |routine: usize| residuals(compiled, &attitudes, routine, &memory);
    let positions = (!compiled.closed[0].is_empty()).then(|| {
        let rank = rank(compiled, 0);
        let body = body(Routines::RESIDUALS_OF_POSITIONS);
        let evaluated = quote! {
            |x: &mbg_runtime::__private::SVector<T, #n>| self.closed_positions(t, x, u, fixed),
            |x: &mbg_runtime::__private::SVector<T, #n>| { #body }
        };
        projection(&compiled.closed[0], &quote!(Positions), &rank, &evaluated)
    });
    let flows = (!compiled.closed[1].is_empty()).then(|| {
        let [both, alone] = [Routines::CLOSED_FLOWS, Routines::RESIDUALS_OF_FLOWS].map(&body);
        let rank = rank_of_flows(compiled);
        let evaluated = quote! {
            |x: &mbg_runtime::__private::SVector<T, #n>| { #both },
            |x: &mbg_runtime::__private::SVector<T, #n>| { #alone }
        };
        projection(&compiled.closed[1], &quote!(Flows), &rank, &evaluated)
    });
    Some(quote! {
        fn close(
            &self,
            t: T,
            x: mbg_runtime::__private::SVector<T, #n>,
            u: &mbg_runtime::__private::SVector<T, #m>,
            fixed: &[::core::primitive::usize],
        ) -> ::core::result::Result<mbg_runtime::__private::SVector<T, #n>, mbg_runtime::Trouble> {
            #positions
            #flows
            #(#attitudes)*
            ::core::result::Result::Ok(x)
        }
    })
}

/// Flows are as dependent as positions are.
fn rank_of_flows(compiled: &Compiled) -> TokenStream {
    if compiled.closed[0] == compiled.closed[1] {
        rank(compiled, 0)
    } else {
        full(compiled.closed[1].len())
    }
}

/// The state at the start, of which `initial` is what was given: where loops are closed, so that rates that were given stay and
/// the others follow. Where these cannot, nothing is changed.
pub(super) fn started(compiled: &Compiled, initial: &TokenStream) -> TokenStream {
    if compiled.started.is_empty() && !compiled.driven {
        return initial.clone();
    }
    let m = Literal::usize_suffixed(compiled.model.inputs.len());
    let given = (!compiled.started.is_empty()).then(|| projection_of_start(compiled));
    let close = match given {
        Some(given) => quote! {
            let close = |x| {
                let x = mbg_runtime::System::close(self, t, x, u, fixed)?;
                #given
                ::core::result::Result::<_, mbg_runtime::Trouble>::Ok(x)
            };
        },
        None => quote!(let close = |x| mbg_runtime::System::close(self, t, x, u, fixed);),
    };
    quote! {
        let start = { #initial };
        let t = T::from_f64(0.0);
        let u = &mbg_runtime::__private::SVector::<T, #m>::from_element(t);
        let fixed: &[::core::primitive::usize] = &[];
        #close
        close(start).unwrap_or(start)
    }
}

/// Onto the flows together with what is given.
fn projection_of_start(compiled: &Compiled) -> TokenStream {
    let [n, m, p] = [
        compiled.states.len(),
        compiled.model.inputs.len(),
        compiled.model.outputs.len(),
    ]
    .map(Literal::usize_suffixed);
    let attitudes: Vec<TokenStream> = compiled.attitudes.iter().map(|it| attitude(it)).collect();
    let memory = quote!(<Self as mbg_runtime::System<T, #n, #m, #p>>::Memory);
    let [both, alone] = [Routines::STARTED_FLOWS, Routines::RESIDUALS_OF_START]
        .map(|routine| residuals(compiled, &attitudes, routine, &memory));
    let given = compiled.started.len() - compiled.closed[1].len();
    let (flows, given) = (rank_of_flows(compiled), full(given));
    let rank = quote!(#flows + #given);
    let evaluated = quote! {
        |x: &mbg_runtime::__private::SVector<T, #n>| { #both },
        |x: &mbg_runtime::__private::SVector<T, #n>| { #alone }
    };
    projection(&compiled.started, &quote!(Flows), &rank, &evaluated)
}

/// The attitudes alone, for methods that linearise at the start of a step.
pub(super) fn upright(compiled: &Compiled) -> Option<TokenStream> {
    if compiled.attitudes.is_empty() {
        return None;
    }
    let n = Literal::usize_suffixed(compiled.states.len());
    let attitudes = compiled.attitudes.iter().map(|it| attitude(it));
    Some(quote! {
        const HAS_ATTITUDES: ::core::primitive::bool = true;
        fn upright(x: mbg_runtime::__private::SVector<T, #n>) -> mbg_runtime::__private::SVector<T, #n> {
            let fixed: &[::core::primitive::usize] = &[];
            #(#attitudes)*
            x
        }
    })
}

/// Makes the states of an attitude a rotation.
fn attitude(rows: &[Vec<usize>]) -> TokenStream {
    let rows = rows.iter().map(|row| {
        let places = row.iter().copied().map(Literal::usize_suffixed);
        quote!([#(#places),*])
    });
    quote!(let x = mbg_runtime::__private::orthonormal(x, &[#(#rows),*], fixed);)
}

/// Projects onto residuals, which are those of the closures given.
fn projection(
    closed: &[usize],
    level: &TokenStream,
    rank: &TokenStream,
    evaluated: &TokenStream,
) -> TokenStream {
    let closures = closed.iter().copied().map(Literal::usize_suffixed);
    quote! {
        let x = mbg_runtime::__private::close(
            Self::META, &[#(#closures),*], x, fixed, (mbg_runtime::__private::Level::#level, #rank), #evaluated,
        )?;
    }
}

/// What a routine's residuals are, with their derivatives if it has these. They are looked at where every attitude is a
/// rotation, so that what makes it one in the end opens no loop.
fn residuals(
    compiled: &Compiled,
    attitudes: &[TokenStream],
    routine: usize,
    memory: &TokenStream,
) -> TokenStream {
    let program = &compiled.program.routines[routine];
    let (steps, results) = lines(compiled, program, Setting::Method);
    let states = compiled.states.len();
    let closed = match routine {
        Routines::CLOSED_POSITIONS | Routines::RESIDUALS_OF_POSITIONS => &compiled.closed[0],
        Routines::STARTED_FLOWS | Routines::RESIDUALS_OF_START => &compiled.started,
        _ => &compiled.closed[1],
    };
    let (values, jacobian) = results.split_at(closed.len());
    let [size, n] = [closed.len(), states].map(Literal::usize_suffixed);
    let memory = cold_memory(compiled, routine, memory);
    let rotations = (!attitudes.is_empty()).then(|| quote!(let x = *x; #(#attitudes)* let x = &x;));
    let values = quote!(mbg_runtime::__private::SVector::<T, #size>::from([#(#values),*]));
    let columns = (0..states).map(|state| jacobian.iter().skip(state).step_by(states));
    let columns = columns.map(|column| quote!([#(#column),*]));
    let found = if jacobian.is_empty() {
        values
    } else {
        let jacobian =
            quote!(mbg_runtime::__private::SMatrix::<T, #size, #n>::from([#(#columns),*]));
        quote!((#values, #jacobian))
    };
    quote! {
        #rotations
        #memory
        #steps
        #found
    }
}

/// The positions' residuals as a method of the type.
pub(super) fn positions(compiled: &Compiled) -> Option<TokenStream> {
    let count = compiled.closed[0].len();
    if count == 0 {
        return None;
    }
    let [n, m, p, size] = [
        compiled.states.len(),
        compiled.model.inputs.len(),
        compiled.model.outputs.len(),
        count,
    ]
    .map(Literal::usize_suffixed);
    let attitudes: Vec<TokenStream> = compiled.attitudes.iter().map(|it| attitude(it)).collect();
    let memory = quote!(<Self as mbg_runtime::System<T, #n, #m, #p>>::Memory);
    let body = residuals(compiled, &attitudes, Routines::CLOSED_POSITIONS, &memory);
    Some(quote! {
        #[inline]
        fn closed_positions(
            &self,
            t: T,
            x: &mbg_runtime::__private::SVector<T, #n>,
            u: &mbg_runtime::__private::SVector<T, #m>,
            fixed: &[::core::primitive::usize],
        ) -> (
            mbg_runtime::__private::SVector<T, #size>,
            mbg_runtime::__private::SMatrix<T, #size, #n>,
        ) {
            #body
        }
    })
}

/// What `new` finds of the ranks, once all else of the model is there.
pub(super) fn ranks(compiled: &Compiled) -> Option<TokenStream> {
    let groups = &compiled.ranks.groups;
    if groups.is_empty() {
        return None;
    }
    let [n, m, p] = [
        compiled.states.len(),
        compiled.model.inputs.len(),
        compiled.model.outputs.len(),
    ]
    .map(Literal::usize_suffixed);
    let places = (0..groups.len()).map(|group| place(compiled, group));
    let found = (0..groups.len()).map(Literal::usize_suffixed);
    let groups = groups.iter().map(|group| {
        let rows = group.iter().copied().map(Literal::usize_suffixed);
        quote!(&[#(#rows),*][..])
    });
    Some(quote! {
        let u = mbg_runtime::__private::SVector::<T, #m>::from_element(T::from_f64(0.0));
        let ranks = mbg_runtime::__private::ranks(
            <Self as mbg_runtime::System<T, #n, #m, #p>>::initial_state(&model),
            [#(#groups),*],
            |x| model.closed_positions(T::from_f64(0.0), x, &u, &[]),
        );
        #(model.folded[#places] = ranks[#found];)*
    })
}

/// Ranks before `new` has found them: full ones.
pub(super) fn unknown_ranks(compiled: &Compiled) -> impl Iterator<Item = TokenStream> {
    compiled.ranks.groups.iter().map(|group| full(group.len()))
}

fn full(rank: usize) -> TokenStream {
    let rank = Literal::f64_suffixed(rank as f64);
    quote!(T::from_f64(#rank))
}

/// The rank of a group, where a method reads it: behind all that is folded.
pub(super) fn rank(compiled: &Compiled, group: usize) -> TokenStream {
    let place = place(compiled, group);
    quote!(self.folded[#place])
}

fn place(compiled: &Compiled, group: usize) -> Literal {
    Literal::usize_suffixed(compiled.program.folded.results.len() + group)
}
