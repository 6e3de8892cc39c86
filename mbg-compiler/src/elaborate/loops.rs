//! Loops: each iteration is a scope of its own.

use std::collections::BTreeMap;

use super::Builder;
use super::expressions::Value;
use super::scope::{Entity, Scope};
use super::turns::Turns;
use crate::syntax::ast::Loop;
use crate::syntax::dump;

impl<'a> Builder<'a> {
    /// Declares the iterations of a loop and the names inside.
    pub(super) fn declare_loop(&mut self, scope: usize, repeated: &'a Loop) {
        let around = &self.scopes[scope];
        let (start, numbers) = match around.constants.range(repeated) {
            Ok(range) => (range.start, range),
            Err(report) => {
                self.tell_of(scope, *report, &[&repeated.start, &repeated.end]);
                self.scopes[scope].loops.push((String::new(), Vec::new()));
                if let Some(label) = &repeated.label {
                    self.name(scope, label, Entity::Opaque);
                }
                return;
            }
        };
        let path = self.loop_path(scope, repeated);
        let iterations: Vec<usize> = numbers
            .map(|number| {
                let around = &self.scopes[scope];
                let variable = self.pool.integer(number);
                let iteration = Scope {
                    prefix: format!("{}{path}[{number}].", around.prefix),
                    derivative: around.derivative,
                    is_broken: around.is_broken,
                    around: Some(scope),
                    library: around.library.clone(),
                    constants: around.constants.of_iteration(repeated, Some(number)),
                    names: BTreeMap::from([(
                        repeated.variable.to_string(),
                        Entity::Value(Value::Scalar(variable)),
                    )]),
                    variable: Some(repeated.variable.to_string()),
                    ..Scope::default()
                };
                let inner = self.scopes.add(iteration);
                self.declare_names(inner, &repeated.statements);
                inner
            })
            .collect();
        self.scopes[scope].turns.push(Turns {
            label: repeated.label.as_ref().map(ToString::to_string),
            head: head(repeated),
            start,
            iterations: iterations.clone(),
        });
        self.scopes[scope].loops.push((path, iterations.clone()));
        if let Some(label) = &repeated.label {
            self.name(scope, label, Entity::Loop(start, iterations));
        }
    }

    /// What its iterations are called in paths: its label, or else its variable, set apart from loops before it.
    fn loop_path(&self, scope: usize, repeated: &Loop) -> String {
        let mut path = repeated
            .label
            .as_ref()
            .unwrap_or(&repeated.variable)
            .to_string();
        while self.scopes[scope]
            .loops
            .iter()
            .any(|(known, _)| *known == path)
        {
            path.push('\'');
        }
        path
    }
}

/// `for k in 0..n`
fn head(repeated: &Loop) -> String {
    let [start, end] = [&repeated.start, &repeated.end].map(dump::expression);
    format!("for {} in {start}..{end}", repeated.variable)
}
