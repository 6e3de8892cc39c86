//! Variables of an element in its own law, and what else has their names.

use std::ops::Range;

use proc_macro2::Ident;
use syn::{BinOp, Expr};

use super::expressions::{Result, Step, Value, fail};
use super::indices::component_index;
use super::mentions::mentioned;
use super::model::{Place, Quantity};
use super::scope::{Lookup, TWO_PORT_VARIABLE, states};
use crate::codes;
use crate::diagnostics::error;
use crate::graph::{ElementId, ElementKind};
use crate::symbolic::Pool;
use crate::syntax::words::{article, element_name, is_two_port};

/// Their names: displacement, momentum, effort and flow.
pub(super) const OWN: [&str; 4] = ["q", "p", "e", "f"];

/// What of an element's own variable a path reads.
pub(super) enum OwnPath {
    /// `f`
    Whole,
    /// `f.x`, which is taken from `f`.
    Component,
    /// `f[0].x`, with the index.
    Behind(i64),
}

/// The variables of the element whose law is being read.
#[derive(Clone, Debug)]
pub(super) struct Own {
    pub(super) element: ElementId,
    pub(super) states: Range<usize>,
    pub(super) dimension: usize,
    /// Set while a scalar law is read for one component.
    pub(super) component: Option<usize>,
}

/// What stands at the signs of a condition: what is given by a call is no value of a law.
pub(super) fn compared(condition: &Expr) -> Vec<&Expr> {
    match condition {
        Expr::Paren(inner) => compared(&inner.expr),
        Expr::Group(inner) => compared(&inner.expr),
        Expr::Unary(unary) => compared(&unary.expr),
        Expr::Binary(binary) => match binary.op {
            BinOp::And(_) | BinOp::Or(_) => [&binary.left, &binary.right]
                .into_iter()
                .flat_map(|side| compared(side))
                .collect(),
            _ => vec![&binary.left, &binary.right],
        },
        _ => Vec::new(),
    }
}

impl Lookup<'_, '_> {
    /// How a path reads a variable of the element whose law it stands in; none where it leads elsewhere, as `q.f` does
    /// where a junction is called `q`.
    pub(super) fn own_path(&self, path: &[Step]) -> Option<OwnPath> {
        self.own.as_ref()?;
        let (first, rest) = path.split_first()?;
        if !OWN.iter().any(|own| first.name == own) {
            return None;
        }
        match (&first.index, rest) {
            (Some(index), _) => Some(OwnPath::Behind(index.number)),
            (None, []) => Some(OwnPath::Whole),
            (None, [Step { name, index: None }]) => {
                component_index(name).map(|_| OwnPath::Component)
            }
            _ => None,
        }
    }

    /// The value of an own variable, unless the name is declared for another value.
    pub(super) fn own_value(&mut self, pool: &mut Pool, name: &Ident) -> Result<Value> {
        match self.own.clone() {
            Some(own) if self.is_value(&name.to_string()) => self.two_meanings(&own, name),
            Some(own) => self.own_variable(pool, &own, name),
            None => fail(name.span(), format!("`{name}` has no value here")),
        }
    }

    /// A component of an own variable is a number, behind which nothing can be read.
    pub(super) fn behind_own<T>(&self, path: &[Step], index: i64) -> Result<T> {
        let name = &path[0].name;
        let message = format!(
            "`{name}[{index}]` is a component of the element's own `{name}`, and nothing is read behind it"
        );
        let report = error(codes::EXPRESSION, name.span(), message);
        let other = self.scopes.find(self.scope, &name.to_string());
        Err(Box::new(match other {
            Some(_) => report.help(format!(
                "declare what else has this name by a longer one than `{name}`"
            )),
            None => report,
        }))
    }

    /// Refuses an own name in what is compared while compiling, where it stands for a number that is declared.
    pub(super) fn check_meanings(&self, expression: &Expr) -> Result<()> {
        let Some(own) = &self.own else { return Ok(()) };
        for path in mentioned(expression) {
            if let [Step { name, .. }] = &path[..]
                && OWN.iter().any(|own| name == own)
                && self.is_value(&name.to_string())
            {
                return self.two_meanings(own, name);
            }
        }
        Ok(())
    }

    fn two_meanings<T>(&self, own: &Own, name: &Ident) -> Result<T> {
        let element = &self.graph.elements[own.element.0].name;
        let message = format!(
            "`{name}` is a variable of `{element}` in its law, and declared as another value"
        );
        let report = error(codes::DUPLICATE_NAME, name.span(), message);
        Err(Box::new(report.help(format!(
            "declare the other value by a longer name than `{name}`"
        ))))
    }

    fn own_variable(&mut self, pool: &mut Pool, own: &Own, name: &Ident) -> Result<Value> {
        let kind = self.graph.elements[own.element.0].kind;
        let components = own
            .component
            .map_or(0..own.dimension, |component| component..component + 1);
        match name.to_string().as_str() {
            "q" if kind == ElementKind::C => Ok(states(pool, &own.states, components)),
            "p" if kind == ElementKind::I => Ok(states(pool, &own.states, components)),
            "e" | "f" if is_two_port(kind) => fail(name.span(), TWO_PORT_VARIABLE),
            "e" | "f" if kind == ElementKind::C => self.no_energy(own, name, ("q", "effort")),
            "e" | "f" if kind == ElementKind::I => self.no_energy(own, name, ("p", "flow")),
            "e" => Ok(self.signals(pool, Quantity::Effort, Place::Port(own.element), components)),
            "f" => Ok(self.signals(pool, Quantity::Flow, Place::Port(own.element), components)),
            _ => {
                let kind = element_name(kind);
                let message = format!("{} `{kind}` has no `{name}`", article(kind));
                fail(name.span(), message)
            }
        }
    }

    /// What a storage holds is a function of its state; read with an effort or a flow, a law stores no energy.
    fn no_energy<T>(&self, own: &Own, name: &Ident, (state, law): (&str, &str)) -> Result<T> {
        let element = &self.graph.elements[own.element.0].name;
        let message = format!(
            "`{element}` stores energy by its own `{state}` alone, and its law reads `{name}`"
        );
        let report = error(codes::EXPRESSION, name.span(), message);
        Err(Box::new(report.help(format!(
            "write `{law}: …` or `energy: …` as a function of `{state}`"
        ))))
    }
}
