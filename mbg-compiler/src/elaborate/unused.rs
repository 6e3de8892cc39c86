//! Warnings of what is written and changes nothing: names that nothing reads, arguments that have no effect.
//!
//! Only what stands in the text counts, so that a name is not told which another choice of words would read.

use std::collections::BTreeSet;

use proc_macro2::Ident;

use super::constants::Constants;
use super::mentions::mentioned;
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::syntax::ast::{Branch, Component, Conditional, Instance, Item, Source, Statement};
use crate::syntax::dump;

/// Warns of the names in models and components that nothing there reads.
pub fn warn(source: &Source, diagnostics: &mut Diagnostics) {
    for item in &source.items {
        let (owner, statements, is_model) = match item {
            Item::Model(model) => (&model.name, &model.statements, true),
            Item::Component(component) => (&component.name, &component.statements, false),
        };
        let read = names(statements);
        for statement in statements {
            if let Some((name, what)) = own(statement, is_model)
                && !read.contains(&name.to_string())
                && !name.to_string().starts_with('_')
            {
                let message = format!("`{owner}` does not read its {what} `{name}`");
                let report = error(codes::UNREAD, name.span(), message);
                let report = match statement {
                    Statement::Integral(_) | Statement::Attitude(_) => {
                        report.note("so it is no state; an `output` that reads it makes it one")
                    }
                    _ => report,
                };
                diagnostics.warn(report.help(format!("remove it, or call it `_{name}`")));
            }
        }
    }
}

/// A name that only its model or component can read, and what it is. Values of a component are read by those who call it.
fn own(statement: &Statement, is_model: bool) -> Option<(&Ident, &'static str)> {
    match statement {
        Statement::Parameter(it) => Some((&it.name, "parameter")),
        Statement::Choice(it) => Some((&it.name, "parameter")),
        Statement::Input(it) => Some((&it.name, "input")),
        Statement::Let(it) if is_model => Some((&it.name, "value")),
        Statement::Integral(it) if is_model => Some((&it.name, "integral")),
        Statement::Attitude(it) if is_model => Some((&it.name, "attitude")),
        _ => None,
    }
}

/// The names that statements mention.
fn names(statements: &[Statement]) -> BTreeSet<String> {
    gathered(statements, &|_| None)
}

/// The names that statements mention, of an `if` only those of its conditions and of the branch that is known.
fn gathered<'s>(
    statements: &'s [Statement],
    branch: &dyn Fn(&'s Conditional) -> Option<&'s [Statement]>,
) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut open: Vec<&Statement> = statements.iter().collect();
    while let Some(statement) = open.pop() {
        for expression in statement.expressions() {
            let paths = mentioned(expression);
            names.extend(paths.iter().map(|path| path[0].name.to_string()));
        }
        let known = match statement {
            Statement::Conditional(conditional) => branch(conditional),
            _ => None,
        };
        match known {
            Some(chosen) => open.extend(chosen),
            None => open.extend(statement.inside()),
        }
    }
    names
}

/// A warning for each argument of an instance that nothing mentions of what the component's `if`s choose. What a
/// component hands on has an effect in other uses of it, perhaps.
pub(super) fn without_effect(
    instance: &Instance,
    component: &Component,
    around: &Constants,
    inner: &Constants,
) -> Vec<Diagnostic> {
    if !around.given.is_empty() || !around.chosen.is_empty() {
        return Vec::new();
    }
    let statements = &component.statements;
    let (all, read) = (
        names(statements),
        gathered(statements, &|it| inner.branch(it).ok()),
    );
    let idle = instance.arguments.iter().filter(|argument| {
        let name = argument.name.to_string();
        all.contains(&name) && !read.contains(&name)
    });
    let warning = |name: &Ident| {
        let message = format!("`{name}` has no effect on `{}`", instance.name);
        let report = error(codes::NO_EFFECT, name.span(), message);
        match condition(statements, name) {
            Some(condition) => report.help(format!("it counts where `{condition}`")),
            None => report,
        }
    };
    idle.map(|argument| warning(&argument.name)).collect()
}

/// Under which condition the statements read a name.
fn condition(statements: &[Statement], name: &Ident) -> Option<String> {
    let branches = statements.iter().filter_map(|statement| match statement {
        Statement::Conditional(it) => Some(&it.branches),
        _ => None,
    });
    let reads = |branch: &&Branch| names(&branch.statements).contains(&name.to_string());
    let branch = branches.flatten().find(reads)?;
    let inner = condition(&branch.statements, name);
    inner.or_else(|| branch.condition.as_ref().map(dump::expression))
}
