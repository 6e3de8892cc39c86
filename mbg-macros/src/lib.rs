//! What the macro `mbg!` of `mbg-runtime` calls. Everything it does is in the crate `mbg-compiler`.

use mbg_compiler::inclusion::crate_file;
use proc_macro::TokenStream;

/// Compiles multibond graphs into flat, allocation-free state-space code: first `$crate`, then what stands in the macro.
#[proc_macro]
pub fn expand(input: TokenStream) -> TokenStream {
    let mut tokens = input.into_iter();
    let runtime: TokenStream = tokens.next().into_iter().collect();
    let written: TokenStream = tokens.collect();
    mbg_compiler::expand(written.into(), &runtime.into(), &crate_file).into()
}
