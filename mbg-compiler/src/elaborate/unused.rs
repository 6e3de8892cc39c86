//! Warnings of what is written and changes nothing: names that nothing reads, arguments that have no effect.
//!
//! Only what stands in the text counts, so that a name is not told which another choice of words would read.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::spanned::Spanned;
use syn::{Expr, ExprLit, Lit};

use super::constants::{Constants, plain_name};
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
        if let Item::Component(component) = item {
            unbonded_ports(component, diagnostics);
        }
        empty_ranges(statements, diagnostics);
        let (read, words) = (names(statements), words(statements));
        let within = if is_model {
            in_loops(statements)
        } else {
            Vec::new()
        };
        let outside = statements.iter().map(|it| (it, &read));
        // What a loop declares is read as `label[k].name`, too.
        for (statement, read) in outside.chain(within.into_iter().map(|it| (it, &words))) {
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
                diagnostics.warn(report.help(format!("remove it, or call it `_{}`", name.unraw())));
            }
        }
    }
}

/// The statements of all loops.
fn in_loops(statements: &[Statement]) -> Vec<&Statement> {
    let mut open: Vec<&Statement> = statements.iter().collect();
    let mut found = Vec::new();
    while let Some(statement) = open.pop() {
        let inside = statement.inside();
        if matches!(statement, Statement::Loop(_)) {
            found.extend(&inside);
        }
        open.extend(inside);
    }
    found
}

/// All words in the expressions of statements, wherever they stand.
fn words(statements: &[Statement]) -> BTreeSet<String> {
    let mut open: Vec<&Statement> = statements.iter().collect();
    let mut words = BTreeSet::new();
    while let Some(statement) = open.pop() {
        let expressions = statement.expressions().into_iter();
        let mut tokens: Vec<TokenTree> = expressions.flat_map(Expr::to_token_stream).collect();
        while let Some(token) = tokens.pop() {
            match token {
                TokenTree::Ident(word) => _ = words.insert(word.to_string()),
                TokenTree::Group(group) => tokens.extend(group.stream()),
                _ => {}
            }
        }
        open.extend(statement.inside());
    }
    words
}

/// Warns of loops whose bounds are written the wrong way round.
fn empty_ranges(statements: &[Statement], diagnostics: &mut Diagnostics) {
    let mut open: Vec<&Statement> = statements.iter().collect();
    while let Some(statement) = open.pop() {
        open.extend(statement.inside());
        let Statement::Loop(repeated) = statement else {
            continue;
        };
        if let (Some(start), Some(end)) = (literal(&repeated.start), literal(&repeated.end))
            && start > end
        {
            let message = format!("`{start}..{end}` is empty: nothing is repeated");
            let report = error(codes::NO_EFFECT, repeated.start.span(), message);
            diagnostics.warn(report.help(format!("write `{end}..{start}`")));
        }
    }
}

/// A whole number that is written as one.
fn literal(expression: &Expr) -> Option<i64> {
    match expression {
        Expr::Lit(ExprLit {
            lit: Lit::Int(number),
            ..
        }) => number.base10_parse().ok(),
        _ => None,
    }
}

/// Warns of ports to which a component bonds nothing, and of which it reads nothing.
fn unbonded_ports(component: &Component, diagnostics: &mut Diagnostics) {
    let (read, bonded) = (words(&component.statements), bonded(&component.statements));
    for port in &component.ports {
        let name = port.name.to_string();
        if !read.contains(&name) && !bonded.contains(&name) && !name.starts_with('_') {
            let message = format!("`{}` bonds nothing to its port `{name}`", component.name);
            let report = error(codes::UNREAD, port.name.span(), message);
            let help = format!("remove it, or call it `_{}`", port.name.unraw());
            diagnostics.warn(report.help(help));
        }
    }
}

/// The first names of all references to junctions and elements.
fn bonded(statements: &[Statement]) -> BTreeSet<String> {
    let mut open: Vec<&Statement> = statements.iter().collect();
    let mut names = BTreeSet::new();
    while let Some(statement) = open.pop() {
        let references = statement.references().into_iter();
        names.extend(references.map(|it| it.path[0].name.to_string()));
        open.extend(statement.inside());
    }
    names
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
    gathered(statements, &|_| None, &|_| BTreeSet::new())
}

/// The names that statements mention, of an `if` only those of its conditions and of the branch that is known, and of an
/// instance not those of arguments that are idle.
fn gathered<'s>(
    statements: &'s [Statement],
    branch: &dyn Fn(&'s Conditional) -> Option<&'s [Statement]>,
    idle: &dyn Fn(&'s Instance) -> BTreeSet<String>,
) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut open: Vec<&Statement> = statements.iter().collect();
    while let Some(statement) = open.pop() {
        let mut expressions = statement.expressions();
        if let Statement::Instance(instance) = statement {
            let idle = idle(instance);
            let arguments = instance.arguments.iter();
            let unheard = arguments.filter(|it| idle.contains(&it.name.to_string()));
            for value in unheard.filter_map(|it| it.value.as_ref()) {
                expressions.retain(|it| !std::ptr::eq(*it, value));
            }
        }
        for expression in expressions {
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

/// The arguments of an instance that nothing mentions of what the component's `if`s choose, nor those of what it calls.
fn idle<'s>(
    instance: &'s Instance,
    component: &Component,
    components: &BTreeMap<String, &Component>,
    inner: &Constants,
) -> Vec<&'s Ident> {
    let statements = &component.statements;
    let called = |inside: &Instance| {
        let Some(component) = components.get(&inside.component.to_string()) else {
            return BTreeSet::new();
        };
        let constants = inner.of_instance(inside, component);
        let idle = idle(inside, component, components, &constants).into_iter();
        idle.map(ToString::to_string).collect()
    };
    let (all, read) = (
        names(statements),
        gathered(statements, &|it| inner.branch(it).ok(), &called),
    );
    let given = instance.arguments.iter().map(|argument| &argument.name);
    let is_idle = |name: &&Ident| {
        let name = name.to_string();
        all.contains(&name) && !read.contains(&name)
    };
    given.filter(is_idle).collect()
}

/// A warning for each argument of an instance that is idle.
pub(super) fn without_effect(
    instance: &Instance,
    component: &Component,
    components: &BTreeMap<String, &Component>,
    inner: &Constants,
) -> Vec<Diagnostic> {
    let warning = |name: &Ident| {
        let message = format!("`{name}` has no effect on `{}`", instance.name);
        let report = error(codes::NO_EFFECT, name.span(), message);
        match condition(component, components, name) {
            Some(condition) => report.help(format!("it counts where `{condition}`")),
            None => report,
        }
    };
    let idle = idle(instance, component, components, inner);
    idle.into_iter().map(warning).collect()
}

/// Under which condition a component reads a parameter, or what it hands it to.
fn condition(
    component: &Component,
    components: &BTreeMap<String, &Component>,
    name: &Ident,
) -> Option<String> {
    let mut open: Vec<&Statement> = component.statements.iter().collect();
    while let Some(statement) = open.pop() {
        open.extend(statement.inside());
        let Statement::Instance(called) = statement else {
            continue;
        };
        let is_it = |value: &Expr| plain_name(value).is_some_and(|value| name == &value);
        let mut handed = called.arguments.iter();
        let handed = handed.find(|it| it.value.as_ref().is_some_and(is_it));
        if let (Some(handed), Some(inner)) = (handed, components.get(&called.component.to_string()))
            && let Some(condition) = condition(inner, components, &handed.name)
        {
            return Some(condition);
        }
    }
    condition_among(&component.statements, name)
}

/// Under which condition the statements read a name.
fn condition_among(statements: &[Statement], name: &Ident) -> Option<String> {
    let branches = statements.iter().filter_map(|statement| match statement {
        Statement::Conditional(it) => Some(&it.branches),
        _ => None,
    });
    let reads = |branch: &&Branch| names(&branch.statements).contains(&name.to_string());
    let branch = branches.flatten().find(reads)?;
    let inner = condition_among(&branch.statements, name);
    inner.or_else(|| branch.condition.as_ref().map(dump::expression))
}
