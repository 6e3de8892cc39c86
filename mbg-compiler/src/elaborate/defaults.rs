//! Warnings of parameters of the library's components that are read from outside, were not given and are zero then: the name reads
//! like what the component works out.

use super::Builder;
use super::advice::text;
use super::elsewhere::number;
use super::expressions::Step;
use super::scope::{Entity, Lookup};
use crate::codes;
use crate::diagnostics::{Diagnostic, error, listing};
use crate::syntax::ast::{Parameter, Statement};

/// A path from outside to a parameter that is zero, as it was not given.
pub(super) struct DefaultRead<'a> {
    path: Vec<Step>,
    /// The scope of the component in use.
    within: usize,
    parameter: &'a Parameter,
}

impl<'a> Lookup<'_, 'a> {
    /// Remembers a path that leads to such a parameter, once.
    pub(super) fn note_default(&mut self, path: &[Step], definition: usize) {
        let (Some(parameter), Some((_, front))) =
            (self.definitions[definition].parameter, path.split_last())
        else {
            return;
        };
        let Ok(Some((Entity::Instance(within), _))) = self.scopes.follow(self.scope, front) else {
            return;
        };
        let name = parameter.name.to_string();
        let within_library = self.scopes[*within].library.is_some();
        let is_default = self.scopes[*within].constants.given.get(&name) == Some(&false);
        let is_zero = parameter.default.as_ref().and_then(number) == Some(0.0);
        let is_told = self.definitions[definition].told.is_some();
        let is_known = (self.defaults.iter())
            .any(|it| (it.within, &it.parameter.name) == (*within, &parameter.name));
        let is_inside = self.scopes[self.scope].library.is_some();
        if within_library && is_default && is_zero && !is_told && !is_known && !is_inside {
            self.defaults.push(DefaultRead {
                path: path.to_vec(),
                within: *within,
                parameter,
            });
        }
    }
}

impl Builder<'_> {
    /// A warning for each of them, with what the component works out in its unit.
    pub(super) fn warn_of_defaults(&mut self) {
        let warnings: Vec<Diagnostic> =
            self.defaults.iter().map(|it| self.at_default(it)).collect();
        warnings
            .into_iter()
            .for_each(|it| self.diagnostics.warn(it));
    }

    fn at_default(&self, read: &DefaultRead<'_>) -> Diagnostic {
        let DefaultRead {
            path,
            within,
            parameter,
        } = read;
        let (path, instance) = (text(path), text(&path[..path.len() - 1]));
        let message = format!("`{path}` is a parameter that `{instance}` is not given: it is zero");
        let report = error(codes::NO_EFFECT, read.path[0].name.span(), message);
        let (_, called) = self.called[within];
        let component = self.components.get(&called.component.to_string());
        let statements = component.into_iter().flat_map(|it| &it.statements);
        let unit = parameter.unit.as_ref().map(|it| &it.text);
        let worked_out = statements.filter_map(|it| match it {
            Statement::Let(it) if it.unit.as_ref().map(|it| &it.text) == unit => {
                Some(format!("{instance}.{}", it.name))
            }
            _ => None,
        });
        let worked_out: Vec<String> = worked_out.collect();
        match (unit, worked_out.is_empty()) {
            (Some(unit), false) => report.help(format!(
                "what `{instance}` works out in {unit}: {}",
                listing(worked_out)
            )),
            _ => report,
        }
    }
}
