//! How large a model is, before anything is built.

use std::collections::BTreeMap;

use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::syntax::ast::{Component, Element, Model, Statement};

/// The most vector bonds that a model may have.
pub const LIMIT: usize = 4096;

/// Reports a model that is too large or a component that contains itself; false if it did.
pub(super) fn check(
    model: &Model,
    components: &BTreeMap<String, &Component>,
    diagnostics: &mut Diagnostics,
) -> bool {
    let mut counter = Counter {
        components,
        known: BTreeMap::new(),
        open: Vec::new(),
    };
    match counter.count(&model.statements) {
        Ok(count) if count <= LIMIT => true,
        Ok(count) => {
            let message = format!(
                "`{}` has {count} vector bonds, the limit is {LIMIT}",
                model.name
            );
            let report = error(codes::TOO_LARGE, model.name.span(), message);
            diagnostics.report(
                report.help("split the scene into models that exchange inputs and outputs"),
            );
            false
        }
        Err(name) => {
            let message = format!("component `{name}` contains itself");
            diagnostics.error(codes::RECURSION, name.span(), message);
            false
        }
    }
}

struct Counter<'a> {
    components: &'a BTreeMap<String, &'a Component>,
    known: BTreeMap<String, usize>,
    open: Vec<String>,
}

impl Counter<'_> {
    fn count(&mut self, statements: &[Statement]) -> Result<usize, proc_macro2::Ident> {
        let mut total = 0usize;
        for statement in statements {
            total = total.saturating_add(match statement {
                Statement::Junction(junction) => junction.elements.iter().map(bonds).sum(),
                Statement::Chain(chain) => chain.arrows.len(),
                Statement::Instance(instance) => self.instance(&instance.component)?,
                _ => 0,
            });
        }
        Ok(total)
    }

    fn instance(&mut self, name: &proc_macro2::Ident) -> Result<usize, proc_macro2::Ident> {
        let text = name.to_string();
        if let Some(known) = self.known.get(&text) {
            return Ok(*known);
        }
        if self.open.contains(&text) {
            return Err(name.clone());
        }
        let Some(component) = self.components.get(&text) else {
            return Ok(0);
        };
        self.open.push(text.clone());
        let count = self.count(&component.statements)?;
        self.open.pop();
        self.known.insert(text, count);
        Ok(count)
    }
}

fn bonds(element: &Element) -> usize {
    1 + usize::from(
        element
            .fields
            .iter()
            .any(|field| field.name == "gyroscopic"),
    )
}
