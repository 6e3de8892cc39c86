//! Tokens one after the other.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use quote::quote;
use syn::Visibility;

/// Tokens that more are added to. `quote!` makes a stream of each piece and copies it into the next, which in thousands
/// of lines is most of the work of an unoptimised macro.
#[derive(Default)]
pub(super) struct Tokens(Vec<TokenTree>);

impl Tokens {
    /// Adds a name.
    pub(super) fn name(&mut self, name: &Ident) {
        self.0.push(TokenTree::Ident(name.clone()));
    }

    /// Adds a sign that stands alone.
    pub(super) fn sign(&mut self, sign: char) {
        self.0
            .push(TokenTree::Punct(Punct::new(sign, Spacing::Alone)));
    }

    /// Adds `::`.
    pub(super) fn colons(&mut self) {
        let first = Punct::new(':', Spacing::Joint);
        self.0.push(TokenTree::Punct(first));
        self.sign(':');
    }

    /// Adds a literal.
    pub(super) fn literal(&mut self, literal: Literal) {
        self.0.push(TokenTree::Literal(literal));
    }

    /// Adds a group of tokens.
    pub(super) fn group(&mut self, delimiter: Delimiter, inner: Self) {
        let group = Group::new(delimiter, inner.stream());
        self.0.push(TokenTree::Group(group));
    }

    /// Adds all tokens of a stream.
    pub(super) fn extend(&mut self, stream: TokenStream) {
        self.0.extend(stream);
    }

    /// All of them.
    pub(super) fn stream(self) -> TokenStream {
        self.0.into_iter().collect()
    }
}

/// A local name with a number.
pub(super) fn numbered(word: &str, number: usize) -> Ident {
    Ident::new(&format!("{word}{number}_"), Span::mixed_site())
}

/// Adds an element of an array.
pub(super) fn element(tokens: &mut Tokens, array: &Ident, index: usize) {
    tokens.name(array);
    let mut place = Tokens::default();
    place.literal(Literal::usize_suffixed(index));
    tokens.group(Delimiter::Bracket, place);
}

/// `{ tokens }`.
pub(super) fn block(tokens: TokenStream) -> Group {
    Group::new(Delimiter::Brace, tokens)
}

/// A number. What is next to a constant of Rust, by whose name clippy would have it called, is written as a quotient.
pub(super) fn number(value: f64) -> TokenStream {
    use std::f64::consts::*;
    const NAMED: [f64; 19] = [
        E,
        PI,
        TAU,
        SQRT_2,
        LN_2,
        LN_10,
        LOG2_10,
        LOG2_E,
        LOG10_2,
        LOG10_E,
        FRAC_1_PI,
        FRAC_1_SQRT_2,
        FRAC_2_PI,
        FRAC_PI_2,
        FRAC_PI_3,
        FRAC_PI_4,
        FRAC_PI_6,
        FRAC_PI_8,
        FRAC_2_SQRT_PI,
    ];
    // Clippy takes 3.14 and 6.28, the shortest that it knows, for constants.
    const NEAR: f64 = 1e-3;
    // A power of two, by which nothing is rounded, and above those that lead from one constant to another.
    const SCALE: f64 = 32.0;
    if NAMED
        .iter()
        .any(|named| (value.abs() - named).abs() < NEAR * named)
    {
        let [scaled, scale] = [SCALE * value, SCALE].map(Literal::f64_suffixed);
        quote!(#scaled / #scale)
    } else {
        TokenTree::from(Literal::f64_suffixed(value)).into()
    }
}

/// `pub struct Name<T = f64> { fields }`. What Rust has to tell of the type, such as another one of its name, it tells at the
/// name that the user has written.
pub(super) fn structure(visibility: &Visibility, name: &Ident, fields: TokenStream) -> TokenStream {
    let span = Span::call_site().located_at(name.span());
    let word = Ident::new("struct", span);
    let mut fields = block(fields);
    fields.set_span(span);
    quote!(#visibility #word #name<T = ::core::primitive::f64> #fields)
}

/// The words of which most lines are made.
#[derive(Clone)]
pub(super) struct Words {
    pub(super) bind: Ident,
    pub(super) scalar: Ident,
    pub(super) multiply_add: Ident,
    pub(super) whole: Ident,
    pub(super) from_f64: Ident,
    pub(super) model: Ident,
    pub(super) folded: Ident,
    pub(super) state: Ident,
    pub(super) input: Ident,
    pub(super) slopes: Ident,
    pub(super) time: Ident,
    pub(super) kept: Ident,
}

impl Words {
    pub(super) fn new() -> Self {
        let word = |text| Ident::new(text, Span::call_site());
        Self {
            bind: word("let"),
            scalar: word("T"),
            multiply_add: word("multiply_add"),
            whole: word("whole"),
            from_f64: word("from_f64"),
            model: word("self"),
            folded: word("folded"),
            state: word("x"),
            input: word("u"),
            slopes: word("slopes"),
            time: word("t"),
            kept: word("kept"),
        }
    }
}
