//! The model's type, `new`, and its `System`.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::changes::changes;
use super::close::{self, close};
use super::routine::{Place, Setting, Writer, lines, written_lines};
use super::tokens::block;
use super::{Items, jacobians, meta, parameters, sparsity, tokens};
use crate::compile::{Compiled, Routines};
use crate::elaborate::Condition;
use crate::program::Step;
use crate::symbolic::Symbol;

/// A run has room for so many thresholds at which a motion stays, at most.
const MOST: usize = 64;

/// The type, its constructor and its behaviour.
pub(super) fn items(compiled: &Compiled) -> Items {
    let constructor = constructor(compiled);
    let system = system(compiled);
    let convertible = convertible(compiled);
    Items {
        types: structure(compiled),
        behaviour: quote!(#constructor #system #convertible),
    }
}

fn structure(compiled: &Compiled) -> TokenStream {
    let model = &compiled.model;
    let (visibility, name, documentation) = (&model.visibility, &model.name, &model.documentation);
    let parameters = format_ident!("{}Parameters", name);
    let folded = compiled.program.folded.results.len() + compiled.ranks.groups.len();
    let folded = Literal::usize_suffixed(folded);
    let summary = meta::documentation(compiled);
    let fields = quote!(folded: [T; #folded], parameters: #parameters<T>);
    let declared = tokens::structure(visibility, name, fields);
    quote! {
        #(#documentation)*
        #(#[doc = #summary])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #declared
    }
}

fn constructor(compiled: &Compiled) -> TokenStream {
    let model = &compiled.model;
    let name = &model.name;
    let parameters = format_ident!("{}Parameters", name);
    let finite = model.parameters.iter().map(|parameter| {
        let value = parameters::read(parameter);
        let text = &parameter.variable.name;
        quote! {
            mbg_runtime::__private::check(
                #text, #value, mbg_runtime::__private::Condition::Finite, "it must be a finite number",
            )?;
        }
    });
    let (folding, folded) = lines(compiled, &compiled.program.folded, Setting::Constructor);
    let (_, checked) = lines(
        compiled,
        &compiled.program.routines[Routines::CHECKS],
        Setting::Folded,
    );
    let checks = compiled.checks.iter().zip(checked).map(|(check, value)| {
        let (condition, must) = match check.condition {
            Condition::NonZero => (quote!(NonZero), "not be zero"),
            Condition::Positive => (quote!(Positive), "be positive"),
            Condition::NotNegative => (quote!(NotNegative), "not be negative"),
        };
        let (text, reason) = (&check.name, format!("it must {must}: {}", check.reason));
        quote! {
            mbg_runtime::__private::check(
                #text, #value, mbg_runtime::__private::Condition::#condition, #reason,
            )?;
        }
    });
    let folded = folded.into_iter().chain(close::unknown_ranks(compiled));
    let positions = close::positions(compiled);
    let built = match close::ranks(compiled) {
        Some(ranks) => quote! {
            let mut model = Self { parameters, folded };
            #ranks
            ::core::result::Result::Ok(model)
        },
        None => quote!(::core::result::Result::Ok(Self { parameters, folded })),
    };
    quote! {
        #[automatically_derived]
        impl<T: mbg_runtime::Real> #name<T> {
            /// Checks the parameters and works out whatever depends on them alone.
            ///
            /// # Errors
            /// A parameter that is no finite number, or that breaks an assumption listed above.
            pub fn new(
                parameters: #parameters<T>,
            ) -> ::core::result::Result<Self, mbg_runtime::ParameterError> {
                #(#finite)*
                #folding
                let folded = [#(#folded),*];
                #(#checks)*
                #built
            }

            /// The parameters it was built with.
            #[must_use]
            pub fn parameters(&self) -> &#parameters<T> {
                &self.parameters
            }

            #positions
        }
    }
}

fn system(compiled: &Compiled) -> TokenStream {
    let name = &compiled.model.name;
    let (close, upright) = (close(compiled), close::upright(compiled));
    let [n, m, p, k] = [
        compiled.states.len(),
        compiled.model.inputs.len(),
        compiled.model.outputs.len(),
        compiled.conditioning.len(),
    ]
    .map(Literal::usize_suffixed);
    let meta = meta::constant(compiled);
    let sparsity = sparsity::items(&compiled.pattern);
    let body = |routine: usize, build: Build| body(compiled, routine, build);
    let initial = close::started(compiled, &body(Routines::INITIAL, &vector));
    let derivative = block(derivative(compiled));
    let derivative_time = body(Routines::DERIVATIVE_TIME, &vector);
    let output = body(Routines::OUTPUT, &vector);
    let energy = body(Routines::ENERGY, &|results| quote!(#(#results)*));
    let power = body(Routines::POWER, &|results| {
        let (supplied, dissipated) = (&results[0], &results[1]);
        quote!(mbg_runtime::Power { supplied: #supplied, dissipated: #dissipated })
    });
    let conditioning = body(Routines::CONDITIONING, &|results| quote!([#(#results),*]));
    let [cold_energy, cold_conditioning] = [Routines::ENERGY, Routines::CONDITIONING]
        .map(|routine| cold_memory(compiled, routine, &quote!(Self::Memory)));
    let changes = changes(compiled);
    let memory = memory(compiled);
    let derivatives = derivatives(compiled);
    let room = Literal::usize_suffixed(compiled.thresholds.len().min(MOST));
    let autonomous = !compiled.program.routines[Routines::DERIVATIVE].reads(Symbol::Time);
    let arguments = quote! {
        t: T,
        x: &mbg_runtime::__private::SVector<T, #n>,
        u: &mbg_runtime::__private::SVector<T, #m>
    };
    let jacobians = jacobians::methods(compiled, &arguments, &memory);
    let examined = examined(compiled, &arguments, &memory);
    quote! {
        #[automatically_derived]
        impl<T: mbg_runtime::Real> mbg_runtime::System<T, #n, #m, #p> for #name<T> {
            const META: &'static mbg_runtime::Meta = #meta;
            const AUTONOMOUS: ::core::primitive::bool = #autonomous;
            type Memory = #memory;
            type Conditioning = [T; #k];
            type Room = mbg_runtime::Room<#room>;

            #[inline]
            fn initial_state(&self) -> mbg_runtime::__private::SVector<T, #n> { #initial }
            #[inline]
            fn derivative(&self, #arguments, memory: &mut #memory) -> mbg_runtime::__private::SVector<T, #n> {
                let mut derivative = mbg_runtime::__private::SVector::<T, #n>::from_element(T::from_f64(0.0));
                mbg_runtime::System::derivative_into(self, t, x, u, memory, &mut derivative);
                derivative
            }
            #[inline(always)]
            fn derivative_into(
                &self, #arguments, memory: &mut #memory,
                derivative: &mut mbg_runtime::__private::SVector<T, #n>,
            ) #derivative
            #derivatives
            #[inline]
            fn output(&self, #arguments, memory: &mut #memory) -> mbg_runtime::__private::SVector<T, #p> { #output }
            #jacobians
            #[inline]
            fn derivative_time(&self, #arguments, memory: &mut #memory, ahead: T) -> mbg_runtime::__private::SVector<T, #n> {
                #derivative_time
            }
            #[inline]
            fn energy(&self, t: T, x: &mbg_runtime::__private::SVector<T, #n>) -> T { #cold_energy #energy }
            #[inline]
            fn power(&self, #arguments, memory: &mut #memory) -> mbg_runtime::Power<T> { #power }
            #[inline]
            fn conditioning(&self, #arguments) -> [T; #k] { #cold_conditioning #conditioning }
            #examined
            #changes
            #close
            #upright
            #sparsity
        }
    }
}

/// What takes the determinants both for trouble and for changes of their signs; without any nothing is worked out twice.
fn examined(
    compiled: &Compiled,
    arguments: &TokenStream,
    memory: &TokenStream,
) -> Option<TokenStream> {
    let count = Literal::usize_suffixed(compiled.conditioning.len());
    (!compiled.conditioning.is_empty()).then(|| {
        quote! {
            #[inline]
            fn examined(
                &self, #arguments, memory: &#memory,
            ) -> ::core::result::Result<[T; #count], mbg_runtime::Trouble> {
                mbg_runtime::__private::examined(self, t, x, u, memory)
            }
        }
    })
}

/// The derivative at four stages at once, by the model with its numbers four times side by side; none where it remembers.
fn derivatives(compiled: &Compiled) -> Option<TokenStream> {
    let [n, m] = [compiled.states.len(), compiled.model.inputs.len()].map(Literal::usize_suffixed);
    compiled.iterations().next().is_none().then(|| {
        quote! {
            #[inline]
            fn derivatives(
                &self,
                t: T::Stages,
                x: &mbg_runtime::__private::SVector<T::Stages, #n>,
                u: &mbg_runtime::__private::SVector<T::Stages, #m>,
                memory: &mut (),
            ) -> mbg_runtime::__private::SVector<T::Stages, #n> {
                let whole = |value: T| <T::Stages as mbg_runtime::Columns<T>>::whole(value);
                let stages = mbg_runtime::Convertible::converted(self, whole);
                mbg_runtime::System::derivative(&stages, t, x, u, memory)
            }
        }
    })
}

/// The model with its numbers in another scalar.
fn convertible(compiled: &Compiled) -> TokenStream {
    let name = &compiled.model.name;
    let parameters = format_ident!("{}Parameters", name);
    let declared = &compiled.model.parameters;
    let fields = parameters::fields(declared).map(|field| {
        let name = &field[0].declared;
        match field[0].component {
            None => quote!(#name: convert(self.parameters.#name)),
            Some(_) => quote!(#name: self.parameters.#name.map(&convert)),
        }
    });
    let fields: Vec<_> = fields.collect();
    let [n, m, p] = [
        compiled.states.len(),
        compiled.model.inputs.len(),
        compiled.model.outputs.len(),
    ]
    .map(Literal::usize_suffixed);
    let phantom = quote!(scalar: ::core::marker::PhantomData);
    let phantom = declared.is_empty().then_some(phantom);
    let steps = &compiled.program.routines[Routines::DERIVATIVE].steps;
    let straight = !steps.iter().any(|step| matches!(step, Step::Solve(_)));
    quote! {
        #[automatically_derived]
        impl<T: mbg_runtime::Real> mbg_runtime::Convertible<T, #n, #m, #p> for #name<T> {
            type With<L: mbg_runtime::Real> = #name<L>;
            const STRAIGHT: ::core::primitive::bool = #straight;
            #[inline]
            fn converted<L: mbg_runtime::Real>(
                &self,
                convert: impl ::core::ops::Fn(T) -> L,
            ) -> #name<L> {
                #name {
                    parameters: #parameters { #(#fields,)* #phantom },
                    folded: self.folded.map(convert),
                }
            }
        }
    }
}

/// Makes what a function returns of the results of its routine.
type Build<'a> = &'a dyn Fn(&[TokenStream]) -> TokenStream;

/// Steps and result of a function.
pub(super) fn body(compiled: &Compiled, routine: usize, build: Build) -> TokenStream {
    let routine = &compiled.program.routines[routine];
    let (steps, results) = lines(compiled, routine, Setting::Method);
    let result = build(&results);
    let mut body = steps;
    body.extend(result);
    body
}

/// A vector of results.
fn vector(results: &[TokenStream]) -> TokenStream {
    let size = Literal::usize_suffixed(results.len());
    quote!(mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#results),*]))
}

/// The lines that write each entry of the derivative.
fn derivative(compiled: &Compiled) -> TokenStream {
    let routine = &compiled.program.routines[Routines::DERIVATIVE];
    let rows = 0..routine.results.len();
    let places: Vec<_> = rows.map(|row| Some(Place::Derivative(row))).collect();
    written_lines(&Writer::of(compiled, routine), routine, &places)
}

/// The type of what is remembered: nothing, or the unknowns of all iterations.
pub(super) fn memory(compiled: &Compiled) -> TokenStream {
    let sizes: Vec<usize> = compiled.iterations().collect();
    if sizes.is_empty() {
        return quote!(());
    }
    let [loops, unknowns] = [sizes.len(), sizes.iter().sum()].map(Literal::usize_suffixed);
    quote!(mbg_runtime::LoopMemory<T, #loops, #unknowns>)
}

/// What is asked without a memory begins at zero, if it needs an iteration at all.
pub(super) fn cold_memory(
    compiled: &Compiled,
    routine: usize,
    memory: &TokenStream,
) -> Option<TokenStream> {
    compiled.program.routines[routine]
        .iterates()
        .then(|| quote!(let memory = &mut <#memory as ::core::default::Default>::default();))
}
