//! Steps as `let` bindings.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use crate::compile::Compiled;
use crate::program::{Operand, Routine, Source, Step};
use crate::symbolic::Symbol;

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
    let mut body = TokenStream::new();
    let mut value = 0;
    for step in &routine.steps {
        body.extend(writer.line(step, value));
        value += step.results();
    }
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
    fn line(&self, step: &Step, value: usize) -> TokenStream {
        let name = &self.names[value];
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
                let (a, cosine) = (self.operand(*a), &self.names[value + 1]);
                return quote!(let (#name, #cosine) = ::mbg_runtime::Real::sin_cos(#a););
            }
            Step::Sine(a) => self.call("sin", &[*a]),
            Step::Cosine(a) => self.call("cos", &[*a]),
            Step::Call(function, arguments) => self.call(function.name(), arguments),
        };
        quote!(let #name = #expression;)
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
            Source::Symbol(Symbol::State(index)) => element("x", index),
            Source::Symbol(Symbol::Input(index)) => element("u", index),
            Source::Symbol(Symbol::Time | Symbol::Signal(_)) => quote!(t),
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

fn element(array: &str, index: usize) -> TokenStream {
    let (array, index) = (format_ident!("{}", array), Literal::usize_suffixed(index));
    quote!(#array[#index])
}
