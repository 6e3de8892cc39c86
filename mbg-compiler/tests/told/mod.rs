//! What is told of a text.
#![allow(clippy::unwrap_used, dead_code)]

use mbg_compiler::diagnostics::{Diagnostic, Diagnostics};
use mbg_compiler::items;

/// What is reported for the text between the braces.
pub(crate) fn diagnose(text: &str) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    let _ = items(text.parse().unwrap(), &mut diagnostics);
    diagnostics
}

/// All mistakes in a text, with the places.
pub(crate) fn told(text: &str) -> String {
    listed(diagnose(text).list())
}

/// Everything that is warned of in a text without mistakes, with the places.
pub(crate) fn warned(text: &str) -> String {
    let diagnostics = diagnose(text);
    assert!(!diagnostics.any(), "{:?}", diagnostics.list());
    listed(diagnostics.warnings())
}

fn listed(list: &[Diagnostic]) -> String {
    let list = list.iter().map(|it| {
        let start = it.span.start();
        format!("{}:{} {}", start.line, start.column + 1, it.text())
    });
    list.collect::<Vec<_>>().join("\n")
}
