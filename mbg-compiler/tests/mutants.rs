//! Mutants of the models of the repository: the compiler never panics, what it refuses it refuses at a token, and what it
//! accepts is Rust whose energy and Jacobian agree with its rates.
//!
//! `PROPTEST_CASES=20000 cargo test --release -p mbg-compiler --test mutants` tries many. They are the same each time, so
//! that a build does not fail by chance; `PROPTEST_RNG_SEED=7` tries others.

#[path = "mutants/corpus.rs"]
mod corpus;
#[path = "mutants/mutation.rs"]
mod mutation;
#[path = "mutants/slopes.rs"]
mod slopes;
mod tokens;

use std::sync::LazyLock;

use mbg_compiler::compile::{Compiled, compile};
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::syntax::ast::Item;
use mbg_compiler::{elaborate, items, syntax};
use proc_macro2::TokenStream;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use quote::quote;

use corpus::{Text, corpus};
use mutation::{mutated, mutation};
use tokens::matched;

static CORPUS: LazyLock<Vec<Text>> = LazyLock::new(corpus);

/// All models of a text without errors.
fn compiled(tokens: TokenStream) -> Vec<Compiled> {
    let mut diagnostics = Diagnostics::new();
    let source = syntax::parse(tokens, &mut diagnostics);
    let components = elaborate::component_table(&source);
    let models = source.items.iter().filter_map(|item| match item {
        Item::Model(model) => compile(model, &components, &mut diagnostics),
        Item::Component(_) => None,
    });
    models.collect()
}

/// Whether all numbers are of a size with which sums keep some digits.
fn is_moderate(words: &[String]) -> bool {
    let numbers = words.iter().filter_map(|word| word.parse::<f64>().ok());
    let mut sizes = numbers.filter(|number| *number != 0.0);
    sizes.all(|number| (1e-7..1e7).contains(&number.abs()))
}

/// The errors of a text, or what is wrong with the answer to it.
fn answered(words: &[String]) -> Result<Vec<String>, String> {
    let text = matched(words.iter().map(String::as_str));
    let Ok(tokens) = text.parse::<TokenStream>() else {
        return Ok(vec!["no tokens".to_owned()]);
    };
    let mut diagnostics = Diagnostics::new();
    let expansion = items(tokens.clone(), &mut diagnostics);
    if let Err(error) = syn::parse2::<syn::File>(expansion.stream(&quote!(::mbg_runtime))) {
        return Err(format!("the expansion is no Rust, {error}: {text}"));
    }
    let mut list = diagnostics.list().iter();
    if let Some(report) = list.find(|it| it.span.start() == it.span.end()) {
        return Err(format!("{} has no place in {text}", report.text()));
    }
    if !diagnostics.any() && is_moderate(words) {
        let wrong = compiled(tokens).iter().find_map(slopes::contradiction);
        wrong.map_or(Ok(()), |wrong| Err(format!("{wrong}: {text}")))?;
    }
    Ok(diagnostics.list().iter().map(|it| it.text()).collect())
}

#[test]
fn models_are_accepted() {
    for text in CORPUS.iter() {
        assert_eq!(answered(&text.words), Ok(Vec::new()), "{text:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        max_shrink_iters: 200,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_mutant_is_refused_at_a_token_or_agrees_with_itself(
        text in prop::sample::select(&CORPUS[..]),
        mutations in prop::collection::vec(mutation(), 1..4),
    ) {
        let words = mutated(text.words, &mutations);
        answered(&words).map_err(TestCaseError::fail)?;
    }
}
