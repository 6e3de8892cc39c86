//! The names that an expression mentions, whatever becomes of it.

use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use quote::ToTokens;

use super::expressions::Step;

/// All dotted paths, in order; what stands in brackets ends a path.
pub(super) fn mentioned(expression: &impl ToTokens) -> Vec<Vec<Step>> {
    let mut paths = Vec::new();
    gather(expression.to_token_stream(), &mut paths);
    paths
}

fn gather(tokens: TokenStream, paths: &mut Vec<Vec<Step>>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is_dot = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(mark)) if mark.as_char() == '.');
    let is_call = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis);
    // Whether the token before ends a path that a dot carries on.
    let mut open = false;
    for (at, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Ident(name) if !is_call(tokens.get(at + 1)) && !is_word(name) => {
                let step = Step {
                    name: name.clone(),
                    index: None,
                };
                let dotted = is_dot(at.checked_sub(1).and_then(|before| tokens.get(before)));
                match paths.last_mut() {
                    Some(path) if dotted && open => path.push(step),
                    // A component of what is no path.
                    _ if dotted => {}
                    _ => paths.push(vec![step]),
                }
                open = open || !dotted;
            }
            TokenTree::Group(group) => {
                gather(group.stream(), paths);
                open = false;
            }
            token => open = open && is_dot(Some(token)),
        }
    }
}

/// Whether a word is no name.
fn is_word(name: &Ident) -> bool {
    name == "if" || name == "else"
}
