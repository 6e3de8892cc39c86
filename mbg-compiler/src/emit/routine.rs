//! Steps as `let` bindings.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use crate::compile::Compiled;
use crate::program::{Operand, Routine, Solve, Solver, Source, Step};
use crate::symbolic::Symbol;

/// Steps in one block at most. Each `let` opens a scope in those before it, and describing many thousands of nested
/// scopes to a debugger takes more stack than rustc has.
const SECTION: usize = 256;

/// Where a routine finds what it reads.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Setting {
    /// A method of the model.
    Method,
    /// `new`, where parameters are at hand and nothing is folded yet.
    Constructor,
    /// `new`, after folding.
    Folded,
}

/// The bindings of a routine, and its results.
pub(super) fn lines(
    compiled: &Compiled,
    routine: &Routine,
    setting: Setting,
) -> (TokenStream, Vec<TokenStream>) {
    let writer = Writer {
        compiled,
        names: names(routine),
        setting,
    };
    let body = if routine.steps.len() > SECTION {
        writer.sections(routine)
    } else {
        writer.lines(&routine.steps, 0)
    };
    let results = routine
        .results
        .iter()
        .map(|result| writer.operand(*result))
        .collect();
    (body, results)
}

/// A local name for each value: its variable's, where it has one that no other value has.
fn names(routine: &Routine) -> Vec<Ident> {
    let mut taken = BTreeSet::new();
    routine
        .names
        .iter()
        .enumerate()
        .map(|(value, name)| {
            let word: String = name
                .chars()
                .map(|c| {
                    if c.is_ascii_alphanumeric() {
                        c.to_ascii_lowercase()
                    } else {
                        '_'
                    }
                })
                .collect();
            let word = format!("v_{word}");
            let name = if name.is_empty() || !taken.insert(word.clone()) {
                format!("v{value}")
            } else {
                word
            };
            Ident::new(&name, Span::mixed_site())
        })
        .collect()
}

struct Writer<'a> {
    compiled: &'a Compiled,
    names: Vec<Ident>,
    setting: Setting,
}

impl Writer<'_> {
    /// The steps of a routine in blocks, each of which gives what is read after it.
    fn sections(&self, routine: &Routine) -> TokenStream {
        let mut read: BTreeSet<Ident> = self.locals(&routine.results).collect();
        let mut end = routine.steps.iter().map(Step::results).sum();
        let mut sections = Vec::new();
        for steps in routine.steps.rchunks(SECTION) {
            let start = end - steps.iter().map(Step::results).sum::<usize>();
            let solved = steps.iter().filter_map(|step| match step {
                Step::Solve(solve) => Some(unknowns(solve.number)),
                _ => None,
            });
            let made = self.names[start..end].iter().cloned().chain(solved);
            let given: Vec<Ident> = made.filter(|name| read.contains(name)).collect();
            let body = self.lines(steps, start);
            sections.push(quote!(let (#(#given,)*) = { #body (#(#given,)*) };));
            let operands = steps.iter().flat_map(Step::operands).collect::<Vec<_>>();
            read.extend(self.locals(&operands));
            end = start;
        }
        sections.into_iter().rev().collect()
    }

    /// The names of those operands that a routine makes itself.
    fn locals(&self, operands: &[Operand]) -> impl Iterator<Item = Ident> {
        operands.iter().filter_map(|operand| match operand.source {
            Source::Value(value) => Some(self.names[value].clone()),
            Source::Solved(place) => Some(unknowns(place.number)),
            _ => None,
        })
    }

    /// Steps whose values begin with number `value`.
    fn lines(&self, steps: &[Step], mut value: usize) -> TokenStream {
        let mut body = TokenStream::new();
        for step in steps {
            body.extend(self.line(step, value));
            value += step.results();
        }
        body
    }

    fn line(&self, step: &Step, value: usize) -> TokenStream {
        let expression = match step {
            Step::Add(a, b) => {
                let (first, second) = (self.operand(*a), self.operand(Operand::plain(b.source)));
                if b.negative {
                    quote!(#first - #second)
                } else {
                    quote!(#first + #second)
                }
            }
            Step::Multiply(a, b) => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                quote!(#a * #b)
            }
            Step::Divide(a, b) => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                quote!(#a / #b)
            }
            Step::SineCosine(a) => {
                let (sine, cosine) = (&self.names[value], &self.names[value + 1]);
                let a = self.operand(*a);
                return quote!(let (#sine, #cosine) = ::mbg_runtime::Real::sin_cos(#a););
            }
            Step::Sine(a) => self.call("sin", &[*a]),
            Step::Cosine(a) => self.call("cos", &[*a]),
            Step::Call(function, arguments) => self.call(function.name(), arguments),
            Step::Solve(solve) => return self.solve(solve, value),
        };
        let name = &self.names[value];
        quote!(let #name = #expression;)
    }

    /// The runtime's iteration, with residuals and Jacobian as a closure over what comes before.
    fn solve(&self, solve: &Solve, value: usize) -> TokenStream {
        let unknowns = unknowns(solve.number);
        let number = match solve.solver {
            Solver::Newton(number) => number,
            Solver::LeastNorm => return self.least_norm(solve),
        };
        let [number, first, size] =
            [number, self.compiled.first(number), solve.size].map(Literal::usize_suffixed);
        let body = self.lines(&solve.steps, value);
        let operands = |list: &[Operand]| -> Vec<TokenStream> {
            list.iter().map(|operand| self.operand(*operand)).collect()
        };
        let (residuals, jacobian) = solve.results.split_at(solve.size);
        let (residuals, jacobian) = (operands(residuals), operands(jacobian));
        quote! {
            let #unknowns = ::mbg_runtime::LoopMemory::solve(
                memory, #number, #first,
                |#unknowns: &::mbg_runtime::__private::SVector<T, #size>| {
                    #body
                    (
                        ::mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#residuals),*]),
                        ::mbg_runtime::__private::SMatrix::<T, #size, #size>::from_row_slice(&[#(#jacobian),*]),
                    )
                },
            );
        }
    }

    /// The runtime's solution of least norm.
    fn least_norm(&self, solve: &Solve) -> TokenStream {
        let (unknowns, size) = (unknowns(solve.number), Literal::usize_suffixed(solve.size));
        let operands: Vec<TokenStream> = solve
            .results
            .iter()
            .map(|operand| self.operand(*operand))
            .collect();
        let (right, matrix) = operands.split_at(solve.size);
        quote! {
            let #unknowns = ::mbg_runtime::solve::least_norm(
                &::mbg_runtime::__private::SMatrix::<T, #size, #size>::from_row_slice(&[#(#matrix),*]),
                &::mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#right),*]),
            ).solution;
        }
    }

    fn call(&self, function: &str, arguments: &[Operand]) -> TokenStream {
        let function = format_ident!("{}", function);
        let arguments = arguments.iter().map(|argument| self.operand(*argument));
        quote!(::mbg_runtime::Real::#function(#(#arguments),*))
    }

    fn operand(&self, operand: Operand) -> TokenStream {
        let value = match operand.source {
            Source::Constant(value) => {
                let literal = Literal::f64_suffixed(value);
                quote!(<T as ::mbg_runtime::Real>::from_f64(#literal))
            }
            Source::Symbol(Symbol::Parameter(index)) => {
                let name = &self.compiled.model.parameters[index].name;
                if self.setting == Setting::Method {
                    quote!(self.parameters.#name)
                } else {
                    quote!(parameters.#name)
                }
            }
            Source::Symbol(Symbol::State(index)) => element(&format_ident!("x"), index),
            Source::Symbol(Symbol::Input(index)) => element(&format_ident!("u"), index),
            Source::Solved(place) => element(&unknowns(place.number), place.row),
            Source::Symbol(Symbol::Time | Symbol::Signal(_) | Symbol::Unknown(_)) => quote!(t),
            Source::Folded(index) => {
                let index = Literal::usize_suffixed(index);
                if self.setting == Setting::Method {
                    quote!(self.folded[#index])
                } else {
                    quote!(folded[#index])
                }
            }
            Source::Value(index) => {
                let name = &self.names[index];
                quote!(#name)
            }
        };
        if operand.negative {
            quote!((-#value))
        } else {
            value
        }
    }
}

/// What holds the unknowns of an iteration.
fn unknowns(number: usize) -> Ident {
    format_ident!("z{}", number, span = Span::mixed_site())
}

fn element(array: &Ident, index: usize) -> TokenStream {
    let index = Literal::usize_suffixed(index);
    quote!(#array[#index])
}
