//! Iterations of loops in paths: those that do not exist, and names that stand only inside.

use std::ops::Range;

use syn::{BinOp, Expr};

use super::advice::{self, text};
use super::constants::plain_name;
use super::elsewhere;
use super::expressions::{Index, Result, Step};
use super::mentions::mentioned;
use super::scope::{Entity, Scopes};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::syntax::dump;
use crate::syntax::words::nearest;

/// A loop, as its names are looked for from outside.
#[derive(Debug)]
pub(super) struct Turns {
    /// Its label, if it has one.
    pub(super) label: Option<String>,
    /// `for k in 0..n`
    pub(super) head: String,
    /// The first value of its variable.
    pub(super) start: i64,
    /// The scopes of its iterations.
    pub(super) iterations: Vec<usize>,
}

/// Names for loops without a label, the outermost first.
const LABELS: [&str; 3] = ["cells", "inner", "innermost"];

impl Scopes {
    /// The name in an iteration of a loop, or the loop, that was probably meant in a path.
    pub(super) fn meant_inside(&self, scope: usize, path: &[Step]) -> Option<String> {
        let (first, behind) = path.split_first()?;
        let next = behind.first()?;
        let found = first.name.to_string();
        match self.find(scope, &found) {
            Some(Entity::Loop(start, scopes)) => {
                let inside = nth(*start, scopes, first.index.as_ref()?.number)?;
                let names: Vec<&str> = self[inside].names.keys().map(String::as_str).collect();
                let near = nearest(&next.name.to_string(), &names)?;
                Some(format!("did you mean `{}.{near}`?", text(&path[..1])))
            }
            Some(_) => None,
            None => {
                let near = nearest(&found, &self.visible(scope))?;
                Some(format!("did you mean `{near}`?"))
            }
        }
    }

    /// What to write for a path whose first name is declared in a component in use alone.
    pub(super) fn in_component(&self, scope: usize, path: &[Step]) -> Option<String> {
        let first = path.first()?.name.to_string();
        if self.find(scope, &first).is_some() {
            return None;
        }
        let mut instances = self[scope].names.iter();
        let (name, _) = instances.find(|(_, entity)| match entity {
            Entity::Instance(inner) => {
                let found = self[*inner].names.get(&first);
                self[*inner].library.is_none() && found.is_some()
            }
            _ => false,
        })?;
        Some(format!(
            "it is declared in a component: write `{name}.{}`",
            text(path)
        ))
    }

    /// The scope of one iteration of a loop, which is read from another scope.
    pub(super) fn iteration(
        &self,
        scope: usize,
        [step, next]: [&Step; 2],
        start: i64,
        scopes: &[usize],
    ) -> Result<usize> {
        let name = &step.name;
        let Some(index) = &step.index else {
            let constants = &self[scope].constants;
            let message = match constants.named(&next.name) {
                Some(_) => format!("`{name}` is a loop; write `{name}[{}]`", next.name),
                None => {
                    format!("`{name}` is a loop; write `{name}[{start}]` for its first iteration")
                }
            };
            return Err(Box::new(error(codes::UNKNOWN_NAME, name.span(), message)));
        };
        if let Some(scope) = nth(start, scopes, index.number) {
            return Ok(scope);
        }
        let end = start.saturating_add_unsigned(scopes.len() as u64);
        let message = format!(
            "`{name}` runs over {start}..{end}, there is no `{name}[{}]`",
            index.number
        );
        let report = error(codes::UNKNOWN_NAME, index.span, message);
        Err(Box::new(match self.varying(scope, index) {
            true => beyond(report, &name.to_string(), index, start..end),
            false => report,
        }))
    }

    /// Whether an index holds the variable of a loop around the place where it stands.
    fn varying(&self, scope: usize, index: &Index) -> bool {
        let around = |scope: &usize| self[*scope].around;
        let scopes = std::iter::successors(Some(scope), around);
        let mut variables = scopes.filter_map(|scope| self[scope].variable.as_deref());
        let names = mentioned(&index.written);
        variables.any(|variable| names.iter().any(|path| path[0].name == variable))
    }

    /// What to type for a path whose first unknown name stands inside a loop.
    pub(super) fn in_loop(&self, scope: usize, path: &[Step]) -> Option<String> {
        let (outer, count) = (0..path.len()).rev().find_map(|count| {
            let outer = self.reached(scope, &path[..count])?;
            Some((outer, count))
        })?;
        let (name, behind) = path[count..].split_first()?;
        let known = match count {
            0 => self.find(outer, &name.name.to_string()),
            _ => self[outer].names.get(&name.name.to_string()),
        };
        if known.is_some() {
            return None;
        }
        let (outer, mut route) = match count {
            0 => self.seen_from(outer).find_map(|outer| {
                let route = self.route(outer, &name.name.to_string())?;
                Some((outer, route))
            })?,
            _ => (outer, self.route(outer, &name.name.to_string())?),
        };
        let mut name = name.clone();
        // Whoever writes `v[2]` for a name of a loop means the iteration.
        if let ([(turns, number)], Some(index)) = (&mut route[..], &name.index)
            && nth(turns.start, &turns.iterations, index.number).is_some()
        {
            *number = index.number;
            name.index = None;
        }
        let depth = usize::from(count > 0);
        let labels: Vec<String> = route
            .iter()
            .enumerate()
            .map(|(place, (turns, _))| self.label(outer, turns, place + depth))
            .collect();
        let prefix = path[..count]
            .iter()
            .map(|step| advice::text(std::slice::from_ref(step)));
        let turns = labels.iter().zip(&route);
        let turns = turns.map(|(label, (_, number))| format!("{label}[{number}]"));
        let rest = [&[name], behind].concat();
        let read: Vec<String> = prefix.chain(turns).chain([advice::text(&rest)]).collect();
        Some(to_name(&route, &labels, depth, &read.join(".")))
    }

    /// The scope to which a path of instances and iterations leads.
    fn reached(&self, scope: usize, path: &[Step]) -> Option<usize> {
        let Some(last) = path.last() else {
            return Some(scope);
        };
        match (self.follow(scope, path).ok()??, &last.index) {
            ((Entity::Instance(inner), count), None) if count == path.len() => Some(*inner),
            ((Entity::Loop(start, scopes), count), Some(index)) if count == path.len() => {
                nth(*start, scopes, index.number)
            }
            _ => None,
        }
    }

    /// A scope and those around it.
    pub(super) fn seen_from(&self, scope: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(scope), |scope| self[*scope].around)
    }

    /// The loops that lead from a scope to a name, each with the number of an iteration.
    fn route(&self, scope: usize, name: &str) -> Option<Vec<(&Turns, i64)>> {
        let deeper = |inner: usize| -> Option<Vec<(&Turns, i64)>> {
            let inside = &self[inner];
            match inside.names.contains_key(name) && inside.variable.as_deref() != Some(name) {
                true => Some(Vec::new()),
                false => self.route(inner, name),
            }
        };
        self[scope].turns.iter().find_map(|turns| {
            let mut iterations = (turns.start..).zip(&turns.iterations);
            let (number, rest) =
                iterations.find_map(|(number, inner)| Some((number, deeper(*inner)?)))?;
            Some([vec![(turns, number)], rest].concat())
        })
    }

    /// The label of a loop, or one that it may be given.
    fn label(&self, scope: usize, turns: &Turns, depth: usize) -> String {
        if let Some(label) = &turns.label {
            return label.clone();
        }
        let mut label = LABELS[depth.min(LABELS.len() - 1)].to_owned();
        while self.find(scope, &label).is_some() {
            label.push('s');
        }
        label
    }
}

/// The scope of the iteration with this number.
fn nth(start: i64, scopes: &[usize], number: i64) -> Option<usize> {
    let place = usize::try_from(number.checked_sub(start)?).ok()?;
    scopes.get(place).copied()
}

/// What to type for loops of which some have no label, and to read what is inside.
fn to_name(route: &[(&Turns, i64)], labels: &[String], depth: usize, read: &str) -> String {
    let unnamed = route.iter().zip(labels).enumerate();
    let unnamed = unnamed.filter(|(_, ((turns, _), _))| turns.label.is_none());
    let unnamed: Vec<(usize, String)> = unnamed
        .map(|(place, ((turns, _), label))| (place, format!("`{label}: {} {{ … }}`", turns.head)))
        .collect();
    match &unnamed[..] {
        [] => format!("it is declared in a loop: write `{read}`"),
        [(place, declared)] => {
            let inner = if place + depth > 0 { "inner " } else { "" };
            format!("give the {inner}loop a name, {declared}, and write `{read}`")
        }
        _ => {
            let declared: Vec<&str> = unnamed.iter().map(|(_, it)| it.as_str()).collect();
            let declared = declared.join(" and ");
            format!("give the loops names, {declared}, and write `{read}`")
        }
    }
}

/// An iteration that a loop reads before the first or behind the last one of another.
fn beyond(report: Diagnostic, name: &str, index: &Index, range: Range<i64>) -> Diagnostic {
    let Range { start, end } = range;
    let condition = if index.number < start {
        compared(&index.written, ">", start.saturating_sub(1))
    } else {
        compared(&index.written, "<", end)
    };
    let report = report.help(format!(
        "where there is none, nothing is written: `if {condition} {{ … }}` around the statement"
    ));
    if index.number != end {
        return report;
    }
    report.help(format!(
        "or let `{name}` run to {}: a row has one junction more than elements between them",
        end.saturating_add(1)
    ))
}

/// `k < 2` for `k + 1 < 3`.
fn compared(written: &Expr, sign: &str, bound: i64) -> String {
    if let Expr::Binary(binary) = written
        && let (Some(variable), Some(offset)) = (
            plain_name(&binary.left),
            elsewhere::number(&binary.right).filter(|it| it.fract() == 0.0),
        )
    {
        let offset = offset as i64;
        let moved = match binary.op {
            BinOp::Add(_) => bound.checked_sub(offset),
            BinOp::Sub(_) => bound.checked_add(offset),
            _ => None,
        };
        if let Some(bound) = moved {
            return format!("{variable} {sign} {bound}");
        }
    }
    format!("{} {sign} {bound}", dump::expression(written))
}
