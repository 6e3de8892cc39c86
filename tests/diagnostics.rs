//! Mistakes as the user sees them: every text, at its token.

#[test]
fn mistakes_are_explained_at_their_tokens() {
    trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
}
