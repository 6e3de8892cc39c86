//! `r#c` is the name `c`.
//!
//! Keywords stay as they are, since the generated code cannot spell `r#type` otherwise; texts show them without `r#`.

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
        TokenTree::Group(group) if has_raw(group.stream()) => {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            let inside: TokenStream = plain_within(inside).into_iter().collect();
            let mut plain = Group::new(group.delimiter(), inside);
            plain.set_span(group.span());
            plain.into()
        }
        token => plain(token),
    };
    tokens.into_iter().map(plain_within).collect()
}

/// Whether a name among the tokens is written with `r#`.
fn has_raw(tokens: TokenStream) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(word) => word != word.unraw(),
        TokenTree::Group(group) => has_raw(group.stream()),
        _ => false,
    })
}

fn name(word: Ident) -> Ident {
    let plain = word.unraw();
    if words::is_reserved(&plain.to_string()) {
        word
    } else {
        plain
    }
}
