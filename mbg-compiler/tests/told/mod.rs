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

/// The texts in backticks of the helps of the only mistake.
pub(crate) fn typed(text: &str) -> Vec<String> {
    let diagnostics = diagnose(text);
    let [report] = diagnostics.list() else {
        panic!("one mistake in {text}, found:\n{}", told(text))
    };
    let helps = report.helps.iter();
    let typed = helps.flat_map(|help| help.split('`').skip(1).step_by(2));
    typed.map(str::to_owned).collect()
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
