//! References to junctions and elements, in chains and in instances.

use std::ops::Range;

use super::Builder;
use super::expressions::{Result, Step, component_index};
use super::scope::Entity;
use crate::codes;
use crate::diagnostics::{Diagnostic, error, listing};
use crate::graph::End;
use crate::syntax::ast::{Reference, Segment, Selection};
use crate::syntax::dump;

impl Builder<'_> {
    /// What a reference stands for, and its dimension; none if that is broken, which is told.
    pub(super) fn resolve(&mut self, scope: usize, reference: &Reference) -> Option<(End, usize)> {
        self.end_of(scope, reference).unwrap_or_else(|report| {
            self.tell(scope, *report);
            None
        })
    }

    fn end_of(&self, scope: usize, reference: &Reference) -> Result<Option<(End, usize)>> {
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
                let picked = self.select(scope, reference, selection, range)?;
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
                let picked = self.pick(reference, index as i64..index as i64 + 1, range)?;
                Ok(Some((End::Junction(*id, picked), 1)))
            }
            (Entity::Element(id), None, []) => Ok(Some((End::OnePort(*id), self.ports[id.0].1))),
            (_, _, [_, ..]) => Err(self.undeclared(scope, reference)),
            _ => {
                let text = dump::reference(reference);
                let message = format!("expected a junction or an element, found `{text}`");
                Err(Box::new(error(
                    codes::UNKNOWN_NAME,
                    reference.span,
                    message,
                )))
            }
        }
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
                let number = self.scopes[scope].wholes.evaluate(&selection.start)?;
                Some((number, name.span()))
            }
            _ => None,
        };
        Ok(Step { name, index })
    }

    /// The components that a selection picks out of those in `range`.
    fn select(
        &self,
        scope: usize,
        reference: &Reference,
        selection: &Selection,
        range: &Range<usize>,
    ) -> Result<Range<usize>> {
        let wholes = &self.scopes[scope].wholes;
        let start = wholes.evaluate(&selection.start)?;
        let end = match &selection.end {
            Some(end) => wholes.evaluate(end)?,
            None => start.saturating_add(1),
        };
        self.pick(reference, start..end, range)
    }

    fn pick(
        &self,
        reference: &Reference,
        picked: Range<i64>,
        range: &Range<usize>,
    ) -> Result<Range<usize>> {
        let text = dump::reference(reference);
        let message = match (usize::try_from(picked.start), usize::try_from(picked.end)) {
            (Ok(start), Ok(end)) if start < end && end <= range.len() => {
                return Ok(range.start + start..range.start + end);
            }
            _ if picked.is_empty() => format!("`{text}` selects no component"),
            _ => format!(
                "`{text}` is outside of the junction, which has {} components",
                range.len()
            ),
        };
        Err(Box::new(error(
            codes::WRONG_DIMENSION,
            reference.span,
            message,
        )))
    }

    fn undeclared(&self, scope: usize, reference: &Reference) -> Box<Diagnostic> {
        let message = format!("`{}` is not declared", dump::reference(reference));
        let names: Vec<String> = self.scopes[scope]
            .names
            .iter()
            .filter(|(_, entity)| matches!(entity, Entity::Junction(..)))
            .map(|(name, _)| name.clone())
            .collect();
        let report = error(codes::UNKNOWN_NAME, reference.span, message);
        Box::new(match names.is_empty() {
            true => report,
            false => report.help(format!("junctions here are {}", listing(names))),
        })
    }
}
