//! Names that generated code binds: constants of the user may have them.

use std::collections::BTreeSet;

use mbg_compiler::expand;
use mbg_compiler::inclusion::no_file;
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;
use syn::visit::Visit;

/// Files with models in which all that is generated occurs.
const FILES: [&str; 2] = [
    include_str!("../../tests/surroundings.rs"),
    include_str!("../../tests/models/pivots.rs"),
];

/// What hides constants.
const LOCALS: &str = include_str!("../../mbg-runtime/src/__private/locals.rs");

/// What stands between the braces of each `mbg! { … }`.
fn models(tokens: TokenStream) -> Vec<TokenStream> {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    let groups = trees.iter().enumerate().filter_map(|(place, tree)| {
        let TokenTree::Group(group) = tree else {
            return None;
        };
        let inner = group.stream();
        let named = place.checked_sub(2).map(|name| trees[name].to_string());
        let is_call = named.as_deref() == Some("mbg");
        Some(if is_call { vec![inner] } else { models(inner) })
    });
    groups.flatten().collect()
}

/// Names that patterns bind.
#[derive(Default)]
struct Bound(BTreeSet<String>);

impl Visit<'_> for Bound {
    fn visit_pat_ident(&mut self, it: &syn::PatIdent) {
        self.0.insert(it.ident.to_string());
    }
}

#[test]
fn constants_of_the_names_that_are_bound_are_hidden() {
    let mut bound = Bound::default();
    for tokens in FILES.iter().flat_map(|file| models(file.parse().unwrap())) {
        let expansion = expand(tokens, &quote!(::mbg_runtime), &no_file);
        bound.visit_file(&syn::parse2(expansion).unwrap());
    }
    bound.0.retain(|name| !name.ends_with('_'));
    let (_, words) = LOCALS.split_once("functions! {").unwrap();
    let words = words.trim_end().trim_end_matches('}').split_whitespace();
    let hidden: BTreeSet<String> = words.map(str::to_owned).collect();
    assert_eq!(bound.0, hidden);
}
