//! The macro `mbg!`. Everything it does is in the crate `mbg-compiler`.

use proc_macro::TokenStream;

/// Compiles multibond graphs into flat, allocation-free state-space code.
#[proc_macro]
pub fn mbg(input: TokenStream) -> TokenStream {
    mbg_compiler::expand(input.into(), &mbg_compiler::inclusion::crate_file).into()
}
