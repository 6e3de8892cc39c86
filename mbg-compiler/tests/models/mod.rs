//! Models from texts, as far as a stage, or everything that was reported with its place.
#![allow(dead_code, clippy::unwrap_used)]

pub(crate) mod dual;

use mbg_compiler::compile::{Compiled, compile};
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::elaborate::{self, Elaborated};
use mbg_compiler::symbolic::Pool;
use mbg_compiler::syntax::ast::{Item, Model, Source};
use mbg_compiler::syntax::parse;

/// The last model of a text after elaboration, and the pool of its expressions.
pub(crate) fn elaborated(text: &str) -> Result<(Elaborated, Pool), String> {
    let mut pool = Pool::new();
    let model = stage(text, |model, source, diagnostics| {
        let components = elaborate::component_table(source);
        elaborate::elaborate(model, &components, &mut pool, diagnostics)
    })?;
    Ok((model, pool))
}

/// The last model of a text after all stages; it has no mistakes.
pub(crate) fn compiled(text: &str) -> Compiled {
    let model = stage(text, |model, source, diagnostics| {
        compile(model, &elaborate::component_table(source), diagnostics)
    });
    model.unwrap_or_else(|reported| panic!("{reported}"))
}

/// The last model of a text after all stages, or the codes of what was reported.
#[allow(dead_code, reason = "not every test file tries what may fail")]
pub(crate) fn attempted(text: &str) -> Result<Compiled, Vec<&'static str>> {
    let (model, diagnostics) = run(text, |model, source, diagnostics| {
        compile(model, &elaborate::component_table(source), diagnostics)
    });
    model.ok_or_else(|| diagnostics.list().iter().map(|it| it.code.text).collect())
}

fn stage<T>(
    text: &str,
    stages: impl FnOnce(&Model, &Source, &mut Diagnostics) -> Option<T>,
) -> Result<T, String> {
    let (result, diagnostics) = run(text, stages);
    let reported = diagnostics.list().iter().map(|diagnostic| {
        let start = diagnostic.span.start();
        format!("{}:{} {}", start.line, start.column + 1, diagnostic.text())
    });
    result.ok_or_else(|| reported.collect::<Vec<_>>().join("\n"))
}

fn run<T>(
    text: &str,
    stages: impl FnOnce(&Model, &Source, &mut Diagnostics) -> Option<T>,
) -> (Option<T>, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let source = parse(text.parse().unwrap(), &mut diagnostics);
    let Some(Item::Model(model)) = source.items.last() else {
        panic!("a model was written")
    };
    let result = stages(model, &source, &mut diagnostics);
    (result, diagnostics)
}
