//! `r#c` is the name `c`.
//!
//! Keywords stay as they are, since the generated code cannot spell `r#type` otherwise; texts show them without `r#`. A function
//! that has a keyword's name, `mod(x, y)`, goes through `syn` as `r#mod`.

use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use syn::ext::IdentExt;

use super::words;

/// A token with the name that it stands for; what a group holds stays as it is.
pub(super) fn plain(token: TokenTree) -> TokenTree {
    match token {
        TokenTree::Ident(word) => TokenTree::Ident(name(word)),
        token => token,
    }
}

/// Tokens with the names that they stand for, those in groups, too.
pub(super) fn plain_within(tokens: Vec<TokenTree>) -> Vec<TokenTree> {
    let plain_within = |token| match token {
        TokenTree::Group(group) if has(group.stream(), &|word| *word != word.unraw()) => {
            within(&group, plain_within)
        }
        token => plain(token),
    };
    tokens.into_iter().map(plain_within).collect()
}

/// Tokens with the function `mod` as a name.
pub(super) fn functions(tokens: Vec<TokenTree>) -> Vec<TokenTree> {
    let is_called = |next: Option<&TokenTree>| matches!(next, Some(TokenTree::Group(_)));
    let mut named = Vec::with_capacity(tokens.len());
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        named.push(match token {
            TokenTree::Ident(word) if word == "mod" && is_called(tokens.peek()) => {
                Ident::new_raw("mod", word.span()).into()
            }
            TokenTree::Group(group) if has(group.stream(), &|word| word == "mod") => {
                within(&group, functions)
            }
            token => token,
        });
    }
    named
}

/// Whether a word is among the tokens, or in a group of them, for which a test holds.
fn has(tokens: TokenStream, test: &dyn Fn(&Ident) -> bool) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(word) => test(&word),
        TokenTree::Group(group) => has(group.stream(), test),
        _ => false,
    })
}

/// A group with other tokens in it.
fn within(group: &Group, change: fn(Vec<TokenTree>) -> Vec<TokenTree>) -> TokenTree {
    let inside = change(group.stream().into_iter().collect());
    let mut changed = Group::new(group.delimiter(), inside.into_iter().collect());
    changed.set_span(group.span());
    changed.into()
}

fn name(word: Ident) -> Ident {
    let plain = word.unraw();
    if words::is_reserved(&plain.to_string()) {
        word
    } else {
        plain
    }
}
