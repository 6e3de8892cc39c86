//! References to junctions and elements, in chains and in instances.

use std::ops::Range;

use syn::Expr;

use super::Builder;
use super::advice::text;
use super::expressions::{Index, Result, Step};
use super::indices::component_index;
use super::scope::Entity;
use crate::codes;
use crate::diagnostics::{Diagnostic, error, listing};
use crate::graph::{End, JunctionKind, declaration};
use crate::syntax::ast::{Reference, Segment, Selection};
use crate::syntax::dump;
use crate::syntax::words::nearest;

/// What other tools call a frame that stands still, or a node without potential.
const GROUNDS: [&str; 9] = [
    "world", "ground", "earth", "base", "fixed", "origin", "inertial", "gnd", "wall",
];

impl Builder<'_> {
    /// What a reference stands for, and its dimension; none if that is broken, which is told.
    pub(super) fn resolve(&mut self, scope: usize, reference: &Reference) -> Option<(End, usize)> {
        self.end_of(scope, reference).unwrap_or_else(|report| {
            let selections = reference.path.iter().filter_map(|it| it.selection.as_ref());
            let numbers = selections.flat_map(|it| [Some(&it.start), it.end.as_ref()]);
            let numbers: Vec<&Expr> = numbers.flatten().collect();
            self.tell_of(scope, *report, &numbers);
            None
        })
    }

    /// The same without telling what is broken.
    pub(super) fn end_of(
        &self,
        scope: usize,
        reference: &Reference,
    ) -> Result<Option<(End, usize)>> {
        let steps: Result<Vec<Step>> = reference
            .path
            .iter()
            .enumerate()
            .map(|(place, segment)| {
                let last = place + 1 == reference.path.len();
                self.step(scope, segment, last)
            })
            .collect();
        let Some((entity, count)) = self.scopes.follow(scope, &steps?)? else {
            return Err(self.undeclared(scope, reference));
        };
        let (selection, rest) = (
            &reference.path[count - 1].selection,
            &reference.path[count..],
        );
        match (entity, selection, rest) {
            (Entity::Opaque, _, _) => Ok(None),
            (Entity::Junction(id, range), None, []) => {
                Ok(Some((End::Junction(*id, range.clone()), range.len())))
            }
            (Entity::Junction(id, range), Some(selection), []) => {
                let picked = self.range(scope, selection)?;
                let picked = pick(reference, count, picked, range)?;
                let size = picked.len();
                Ok(Some((End::Junction(*id, picked), size)))
            }
            (
                Entity::Junction(id, range),
                None,
                [
                    Segment {
                        name,
                        selection: None,
                    },
                ],
            ) => {
                let index =
                    component_index(name).ok_or_else(|| self.undeclared(scope, reference))?;
                let index = index as i64;
                let picked = pick(reference, count, index..index + 1, range)?;
                Ok(Some((End::Junction(*id, picked), 1)))
            }
            (Entity::Element(id), None, []) => Ok(Some((End::OnePort(*id), self.ports[id.0].1))),
            (_, _, [_, ..]) => Err(self.undeclared(scope, reference)),
            _ => {
                let text = dump::reference(reference);
                let message = format!("expected a junction or an element, found `{text}`");
                let report = error(codes::UNKNOWN_NAME, reference.span, message);
                let junctions = match entity {
                    Entity::Instance(inner) => self.junctions_in(*inner),
                    _ => Vec::new(),
                };
                if entity.is_value() {
                    return Err(Box::new(report.help(format!(
                        "a value is no bond, and comes from a source: `Se {0}_source {{ effort: {text} }}` or \
                         `Sf {0}_source {{ flow: {text} }}` in its place",
                        reference.path[0].name
                    ))));
                }
                if junctions.is_empty() {
                    return Err(Box::new(report));
                }
                let junctions = junctions.iter().map(|name| format!("{text}.{name}"));
                let help = format!("junctions of `{text}` are {}", listing(junctions));
                Err(Box::new(report.help(help)))
            }
        }
    }

    /// The junctions of a component in use, without those that it was given: first those of a shaft or a node.
    fn junctions_in(&self, scope: usize) -> Vec<&str> {
        let within = &self.scopes[scope];
        let own = within.names.iter().filter_map(|(name, entity)| {
            let Entity::Junction(id, _) = entity else {
                return None;
            };
            let junction = &self.graph.junctions[id.0];
            let is_own = junction.name == format!("{}{name}", within.prefix);
            is_own.then_some((
                junction.dimension,
                junction.kind == JunctionKind::Zero,
                name.as_str(),
            ))
        });
        let mut own: Vec<_> = own.collect();
        own.sort_unstable();
        own.into_iter().map(|(.., name)| name).collect()
    }

    /// One step of a path; what stands in brackets after the last one selects components.
    fn step(&self, scope: usize, segment: &Segment, last: bool) -> Result<Step> {
        let name = segment.name.clone();
        let index = match &segment.selection {
            Some(selection) if !last => {
                if selection.end.is_some() {
                    let message = format!("a range of `{name}` has no names; give one iteration");
                    return Err(Box::new(error(codes::UNKNOWN_NAME, name.span(), message)));
                }
                let number = self.scopes[scope].constants.evaluate(&selection.start)?;
                Some(Index {
                    number,
                    span: name.span(),
                    written: selection.start.clone(),
                })
            }
            _ => None,
        };
        Ok(Step { name, index })
    }

    /// The numbers that a selection gives.
    fn range(&self, scope: usize, selection: &Selection) -> Result<Range<i64>> {
        let constants = &self.scopes[scope].constants;
        let start = constants.evaluate(&selection.start)?;
        let end = match &selection.end {
            Some(end) => constants.evaluate(end)?,
            None => start.saturating_add(1),
        };
        Ok(start..end)
    }

    fn undeclared(&self, scope: usize, reference: &Reference) -> Box<Diagnostic> {
        let message = format!("`{}` is not declared", dump::reference(reference));
        let known = self.scopes.visible(scope);
        let report = error(codes::UNKNOWN_NAME, reference.span, message);
        let segments = reference.path.iter().enumerate();
        let steps = segments.map(|(place, segment)| {
            let last = place + 1 == reference.path.len();
            self.step(scope, segment, last)
        });
        let steps: Vec<Step> = steps.collect::<Result<_>>().unwrap_or_default();
        if let Some(help) = self.by_number(scope, &steps) {
            return Box::new(report.help(help));
        }
        let help = self.scopes.later(scope, &steps);
        let help = help.or_else(|| self.scopes.in_loop(scope, &steps));
        let help = help.or_else(|| self.scopes.meant_inside(scope, &steps));
        let help = help.or_else(|| self.scopes.in_component(scope, &steps));
        if let Some(help) = help.or_else(|| self.junctions_inside(scope, &steps)) {
            return Box::new(report.help(help));
        }
        let last = reference.path.last().map(|last| last.name.to_string());
        let last = last.unwrap_or_default();
        if let Some(help) = self.standing(scope, &last, &known) {
            return Box::new(report.help(help));
        }
        let report = report.did_you_mean(&last, &known);
        let junctions: Vec<String> = known
            .iter()
            .filter(|name| matches!(self.scopes.find(scope, name), Some(Entity::Junction(..))))
            .map(|name| (*name).to_owned())
            .collect();
        Box::new(if report.helps.is_empty() && !junctions.is_empty() {
            report.help(format!("junctions here are {}", listing(junctions)))
        } else {
            report
        })
    }

    /// What to declare for a ground that other tools have without being told, as large as the other junctions are.
    fn standing(&self, scope: usize, name: &str, known: &[&str]) -> Option<String> {
        let is_ground = GROUNDS.contains(&name.to_lowercase().as_str());
        let junctions = known
            .iter()
            .filter_map(|it| match self.scopes.find(scope, it) {
                Some(Entity::Junction(id, _)) => Some(&self.graph.junctions[id.0]),
                _ => None,
            });
        let largest = junctions.max_by_key(|it| it.dimension);
        let largest = largest.filter(|_| is_ground)?;
        let (source, law) = match largest.kind {
            JunctionKind::One => ("Sf", "flow"),
            JunctionKind::Zero => ("Se", "effort"),
        };
        let junction = declaration(largest.kind, name, largest.dimension);
        let fixed = declaration(largest.kind, &format!("{name}_fixed"), largest.dimension);
        let (_, fixed) = fixed.split_once(' ')?;
        Some(format!(
            "what stands still is declared: `{junction}; {source} {fixed} {{ {law}: 0.0 }} -> {name};`"
        ))
    }

    /// `hub[k]` for `hub.k`, where `k` is a whole number.
    fn by_number(&self, scope: usize, path: &[Step]) -> Option<String> {
        let (last, front) = path.split_last()?;
        self.scopes[scope].constants.named(&last.name)?;
        match self.scopes.follow(scope, front) {
            Ok(Some((Entity::Junction(..), count))) if count == front.len() => {
                Some(format!("write `{}[{}]`", text(front), last.name))
            }
            _ => None,
        }
    }

    /// The junctions of the instance in which a path ends, but for its ports, which are the caller's.
    fn junctions_inside(&self, scope: usize, path: &[Step]) -> Option<String> {
        let (name, front) = path.split_last()?;
        let Ok(Some((Entity::Instance(inner), _))) = self.scopes.follow(scope, front) else {
            return None;
        };
        let inner = &self.scopes[*inner];
        let junctions = inner.names.iter().filter(|(name, entity)| {
            matches!(entity, Entity::Junction(id, _)
                if self.graph.junctions[id.0].name == format!("{}{name}", inner.prefix))
        });
        let junctions: Vec<&str> = junctions.map(|(name, _)| name.as_str()).collect();
        let front = text(front);
        if let Some(near) = nearest(&name.name.to_string(), &junctions) {
            return Some(format!("did you mean `{front}.{near}`?"));
        }
        let junctions = junctions.into_iter().map(str::to_owned);
        (junctions.len() > 0).then(|| format!("junctions of `{front}` are {}", listing(junctions)))
    }
}

/// The components picked out of those in `range`, the junction having been found after `count` steps.
fn pick(
    reference: &Reference,
    count: usize,
    picked: Range<i64>,
    range: &Range<usize>,
) -> Result<Range<usize>> {
    let (text, junction) = (dump::reference(reference), &reference.path[count - 1].name);
    let message = match (usize::try_from(picked.start), usize::try_from(picked.end)) {
        (Ok(start), Ok(end)) if start < end && end <= range.len() => {
            return Ok(range.start + start..range.start + end);
        }
        _ if picked.is_empty() => format!("`{text}` selects no component"),
        _ => format!(
            "`{junction}` has {} components, `{text}` asks for more",
            range.len()
        ),
    };
    let report = error(codes::WRONG_DIMENSION, reference.span, message);
    let end = i64::try_from(range.len()).unwrap_or(i64::MAX);
    let is_counted_from_one = range.len() > 1 && picked.contains(&end);
    Err(Box::new(match is_counted_from_one {
        true => report.help(format!(
            "they are counted from 0: the last is `{junction}[{}]`",
            range.len() - 1
        )),
        false => report,
    }))
}
