//! What the macro `mbg!` of `mbg-runtime` calls. Everything it does is in the crate `mbg-compiler`.

use proc_macro::{Group, TokenStream, TokenTree};

/// Compiles multibond graphs into flat, allocation-free state-space code: first `$crate`, then what stands in the macro.
#[proc_macro]
pub fn expand(input: TokenStream) -> TokenStream {
    let mut tokens = input.into_iter();
    let Some(runtime) = tokens.next() else {
        return TokenStream::new();
    };
    let written: TokenStream = tokens.collect();
    let expansion =
        mbg_compiler::expand(written.into(), &mbg_compiler::inclusion::crate_file).into();
    called(expansion, &runtime)
}

/// The tokens with `$crate` for `::mbg_runtime`, by which name not everybody knows the crate who calls the macro.
fn called(tokens: TokenStream, runtime: &TokenTree) -> TokenStream {
    let mut called: Vec<TokenTree> = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(name) if is_path(&called) && name.to_string() == "mbg_runtime" => {
                called.truncate(called.len() - COLONS);
                called.push(runtime.clone());
            }
            TokenTree::Group(group) => {
                let inner = self::called(group.stream(), runtime);
                let mut inner = Group::new(group.delimiter(), inner);
                inner.set_span(group.span());
                called.push(inner.into());
            }
            _ => called.push(token),
        }
    }
    called.into_iter().collect()
}

/// The length of `::`.
const COLONS: usize = 2;

/// Whether the tokens end with `::`.
fn is_path(tokens: &[TokenTree]) -> bool {
    let is_colon = |token: &TokenTree| matches!(token, TokenTree::Punct(it) if it.as_char() == ':');
    tokens.len() >= COLONS && tokens.iter().rev().take(COLONS).all(is_colon)
}
