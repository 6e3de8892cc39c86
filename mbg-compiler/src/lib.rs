//! The compiler behind `mbg!`, as an ordinary library.
//!
//! The stages, in order of execution; each takes one form and returns the next:
//!
//! | stage | module | result |
//! |---|---|---|
//! | inclusion | [`inclusion`] | tokens, those of included files in place |
//! | syntax | [`syntax`] | a tree |
//! | elaboration | [`elaborate`] | a flat [`graph::BondGraph`] with laws |
//! | units | [`units`] | the verdict on units |
//! | causality | [`drawing`], [`causality`] | the verdict on the drawing |
//! | network, equations | [`network`], [`equations`] | one linear equation per unknown |
//! | structure | [`structure`] | every unknown as an expression |
//! | answers | [`answers`], [`closures`], [`checks`], [`start`] | what functions return, projection makes zero, `new` asks |
//! | Jacobians | [`jacobians`], [`sweeps`] | their entries, or what columns or rows are worked out from |
//! | program | [`program`], [`sparsity`] | straight-line arithmetic, the pattern of the Jacobian |
//! | emission | [`emit`] | Rust |
//!
//! [`compile`] runs them for one model, [`expand`] for everything inside one `mbg! { … }`; [`explain`] prints them.

pub mod answers;
mod bits;
pub mod causality;
pub mod changes;
pub mod checks;
pub mod closures;
pub mod codes;
pub mod compile;
pub mod diagnostics;
pub mod displacements;
mod divisors;
pub mod drawing;
pub mod elaborate;
pub mod emit;
mod entries;
pub mod equations;
pub mod explain;
pub mod graph;
pub mod inclusion;
pub mod jacobians;
mod locked;
mod loose;
pub mod network;
mod notes;
mod operands;
pub mod program;
mod scaling;
pub mod sparsity;
pub mod start;
pub mod structure;
pub mod sweeps;
pub mod symbolic;
pub mod syntax;
pub mod units;

use proc_macro2::TokenStream;

use diagnostics::Diagnostics;
use emit::Items;
use inclusion::{Inclusion, Read};
use syntax::ast::Item;

/// Compiles the tokens between the braces of `mbg! { … }`: items, or located errors and the shells of the models.
/// What they include is read by `read`, such as [`inclusion::crate_file`]; `runtime` is the path of the crate `mbg_runtime`.
#[must_use]
pub fn expand(tokens: TokenStream, runtime: &TokenStream, read: &Read<'_>) -> TokenStream {
    let mut diagnostics = Diagnostics::new();
    let mut output = expansion(tokens, runtime, read, &mut diagnostics);
    output.extend(diagnostics.to_tokens());
    output
}

/// As [`expand`], with the errors apart.
pub fn expansion(
    tokens: TokenStream,
    runtime: &TokenStream,
    read: &Read<'_>,
    diagnostics: &mut Diagnostics,
) -> TokenStream {
    let (items, inclusion) = located(tokens, read, diagnostics, &items);
    let mut output = items.stream(runtime);
    output.extend(inclusion.dependencies());
    output
}

/// What `run` makes of tokens and of the files that they include; its errors and warnings in a file are told with their place
/// there.
fn located<R>(
    tokens: TokenStream,
    read: &Read<'_>,
    diagnostics: &mut Diagnostics,
    run: &dyn Fn(TokenStream, &mut Diagnostics) -> R,
) -> (R, Inclusion) {
    let inclusion = Inclusion::of(tokens, read, diagnostics);
    let before = diagnostics.clone();
    let output = run(inclusion.tokens(), diagnostics);
    let again = |tokens| {
        let mut again = before.clone();
        let _ = run(tokens, &mut again);
        again
    };
    inclusion.locate(before.list().len(), diagnostics, &again);
    if !diagnostics.any() {
        let mut warnings = diagnostics.take_warnings();
        inclusion.locate(0, &mut warnings, &|tokens| again(tokens).take_warnings());
        diagnostics.put_warnings(warnings);
    }
    (output, inclusion)
}

/// As [`expansion`], of tokens that include nothing.
pub fn items(tokens: TokenStream, diagnostics: &mut Diagnostics) -> Items {
    let source = syntax::parse(tokens, diagnostics);
    let sound = !diagnostics.any();
    let components = elaborate::component_table(&source);
    elaborate::warn(&source, diagnostics);
    let (mut items, mut mistakes) = (Items::default(), None);
    for item in &source.items {
        let Item::Model(model) = item else { continue };
        let compiled = if sound {
            compile::compile(model, &components, diagnostics)
        } else {
            None
        };
        items.extend(match &compiled {
            Some(compiled) => emit::model(compiled),
            None => {
                let mistakes = mistakes.get_or_insert_with(|| emit::mistakes(model));
                emit::shell(model, mistakes)
            }
        });
        // A shell without an error would build, and never return.
        if compiled.is_none() && !diagnostics.any() {
            let message =
                "the equations of the model could not be brought into an order of solution";
            diagnostics.error(codes::SINGULAR_JUNCTIONS, model.name.span(), message);
        }
    }
    diagnostics.tell_in(mistakes);
    items
}
