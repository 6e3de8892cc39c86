//! Warnings of what moves by time alone and should not: the flow of a frame behind an offset that a law of time changes does
//! not know of it.

use super::Builder;
use super::definitions::Progress;
use super::expressions::Value;
use super::scope::Entity;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::Symbol;
use crate::symbolic::substitute::symbols;

/// Parameters of the library that tell where something is fixed to a frame, and how it is turned there.
const GEOMETRY: &[&str] = &["by", "x", "y", "centre", "end", "offset", "tilt", "zero"];

impl Builder<'_> {
    /// Warns of geometry that reads the time. What reads states may be a point at which something rolls.
    pub(super) fn warn_of_moving(&mut self) {
        let mut warnings: Vec<Diagnostic> = Vec::new();
        for (inner, (scope, instance)) in &self.called {
            // What a component of the library hands on is told where it got it.
            if self.scopes[*inner].library.is_none() || self.scopes[*scope].library.is_some() {
                continue;
            }
            for argument in &instance.arguments {
                let name = argument.name.to_string();
                if !GEOMETRY.contains(&name.as_str()) {
                    continue;
                }
                let Some(Entity::Definition(id)) = self.scopes[*inner].names.get(&name) else {
                    continue;
                };
                let Progress::Known(value) = &self.definitions[*id].progress else {
                    continue;
                };
                let entries = match value {
                    Value::Scalar(value) => vec![*value],
                    Value::Matrix(product) => product.to_matrix(self.pool).entries,
                };
                if symbols(self.pool, &entries).contains(&Symbol::Time) {
                    let message = format!(
                        "`{name}` of `{}` changes with time, and the flow of what is fixed there does not know of it",
                        instance.name
                    );
                    let report = error(codes::UNKNOWN_MOTION, argument.name.span(), message);
                    let turns = instance.component == "Turn" || name == "tilt" || name == "zero";
                    let joint = match (instance.component.to_string().starts_with("Planar"), turns)
                    {
                        (true, true) => "PlanarRevolute {}",
                        (true, false) => "PlanarPrismatic {}",
                        (false, true) => "Revolute { axis: 2 }",
                        (false, false) => "Prismatic { axis: 2 }",
                    };
                    warnings.push(report.help(format!(
                        "move it by a joint whose rate is given: `guide: {joint} (a, b);` and `Sf drive {{ flow: … }} -> guide.rate;`"
                    )));
                }
            }
        }
        warnings
            .into_iter()
            .for_each(|it| self.diagnostics.warn(it));
    }
}
