//! What is known at a frame, and must be handed on.
//!
//! A component tells what holds at its port `b` by a value whose name ends so, such as `gravity_b`, and asks what holds
//! at its port `a` by a parameter such as `gravity_a`. Its default holds in the world. Where another component at the
//! same frame tells otherwise, a parameter that is needed must be given.

use std::ops::Range;

use quote::ToTokens;

use super::Builder;
use super::definitions::{Missing, Progress};
use super::expressions::{Result, Value};
use super::scope::{Entity, GRAVITY};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{ElementKind, End, JunctionId};
use crate::symbolic::{Matrix, Pool};
use crate::syntax::ast;

/// A port of a component in use, and what it is connected to.
pub(super) struct Frame<'a> {
    /// The component's scope.
    scope: usize,
    component: &'a ast::Component,
    /// Name of the port.
    port: String,
    junction: (JunctionId, Range<usize>),
}

/// A parameter that is left to its default.
pub(super) struct LeftOut<'a> {
    /// Number of its definition.
    pub(super) definition: usize,
    /// Scope of its component.
    pub(super) scope: usize,
    pub(super) parameter: &'a ast::Parameter,
}

/// A parameter that is left to its default, and what another component tells that it is.
pub(super) struct Told<'a> {
    definition: usize,
    /// Scope of the component that tells it.
    teller: usize,
    /// Scope of the one with the parameter.
    scope: usize,
    parameter: &'a ast::Parameter,
}

impl<'a> Builder<'a> {
    /// Notes what a port of a component is connected to.
    pub(super) fn at_frame(
        &mut self,
        scope: usize,
        component: &'a ast::Component,
        port: &ast::Port,
        junction: (JunctionId, Range<usize>),
    ) {
        self.frames.push(Frame {
            scope,
            component,
            port: port.name.to_string(),
            junction,
        });
    }

    /// Reports a parameter that is left to its default where another component tells something else.
    pub(super) fn check_default(&mut self, definition: usize, value: &Value) -> Result<()> {
        let Some(told) = self.told(definition) else {
            return Ok(());
        };
        match &self.definitions[told.definition].progress {
            Progress::Known(other) if is_same(self.pool, value, other) => return Ok(()),
            Progress::Known(_) => {}
            Progress::Unread => self.missing = Some(Missing::Definition(told.definition)),
            Progress::Failed => self.missing = Some(Missing::Broken),
        }
        Err(self.not_given(&told))
    }

    /// What another component tells of a parameter that is left to its default.
    pub(super) fn told(&self, definition: usize) -> Option<Told<'a>> {
        let defaults = &self.defaults;
        let number = defaults.binary_search_by_key(&definition, |it| it.definition);
        let left = &defaults[number.ok()?];
        let name = left.parameter.name.to_string();
        let mut own = self.frames.iter().filter(|it| it.scope == left.scope);
        let (frame, quantity) = own.find_map(|frame| {
            let quantity = name.strip_suffix(&frame.port)?.strip_suffix('_')?;
            Some((frame, quantity))
        })?;
        let tells = |other: &Frame| Some((self.tells(other, frame, quantity)?, other.scope));
        let (definition, teller) = self.frames.iter().find_map(tells)?;
        let is_given = self.is_moved_by_source(frame.junction.0) || self.is_weightless(quantity);
        (!is_given).then_some(Told {
            definition,
            teller,
            scope: left.scope,
            parameter: left.parameter,
        })
    }

    fn not_given(&self, told: &Told) -> Box<Diagnostic> {
        let [own, whole] = [told.scope, told.teller].map(|scope| self.name_of(scope));
        let near = match (whole.rsplit_once('.'), own.rsplit_once('.')) {
            (Some((around, name)), Some((same, _))) if around == same => name,
            _ => whole,
        };
        let name = &told.parameter.name;
        let message = format!("`{own}` is at a frame of `{near}` and is not given `{name}`");
        let default = told.parameter.default.to_token_stream();
        let value = self.definitions[told.definition].name;
        let report = error(codes::MISSING_DEFAULT, name.span(), message)
            .help(format!("write `{name}: {near}.{value}`"))
            .help(format!(
                "write `{name}: {default}` where that of the world is meant"
            ));
        Box::new(report)
    }

    /// The definition by which another component at the same frame tells a quantity there.
    fn tells(&self, teller: &Frame, frame: &Frame, quantity: &str) -> Option<usize> {
        let [own, other] = [frame, teller].map(|it| self.scopes[it.scope].prefix.as_str());
        if teller.junction != frame.junction || own.starts_with(other) || other.starts_with(own) {
            return None;
        }
        let told = format!("{quantity}_{}", teller.port);
        if teller.component.parameters().any(|it| it.name == told) {
            return None;
        }
        match self.scopes[teller.scope].names.get(&told) {
            Some(Entity::Definition(definition)) => Some(*definition),
            _ => None,
        }
    }

    /// A source that moves a frame knows how.
    fn is_moved_by_source(&self, junction: JunctionId) -> bool {
        let is_source = |end: &End| match end {
            End::OnePort(id) => self.graph.elements[id.0].kind == ElementKind::Sf,
            _ => false,
        };
        let is_here = |end: &End| matches!(end, End::Junction(id, _) if *id == junction);
        self.graph.bonds.iter().any(|bond| {
            (is_source(&bond.from) && is_here(&bond.to))
                || (is_here(&bond.from) && is_source(&bond.to))
        })
    }

    /// Without gravity there is none at any frame.
    fn is_weightless(&self, quantity: &str) -> bool {
        quantity == GRAVITY && matches!(self.scopes[0].names.get(GRAVITY), Some(Entity::Value(_)))
    }

    /// Path of the component in use with this scope.
    fn name_of(&self, scope: usize) -> &str {
        self.scopes[scope].prefix.trim_end_matches('.')
    }
}

/// Whether two values are the same function; a number stands for its multiple of a unit matrix.
fn is_same(pool: &mut Pool, a: &Value, b: &Value) -> bool {
    let mut matrix = |value: &Value, other: &Value| match (value, other) {
        (Value::Matrix(product), _) => product.to_matrix(pool),
        (Value::Scalar(number), Value::Matrix(other)) => {
            Matrix::diagonal(&vec![*number; other.rows()])
        }
        (Value::Scalar(number), Value::Scalar(_)) => Matrix::diagonal(&[*number]),
    };
    let (a, b) = (matrix(a, b), matrix(b, a));
    a == b
}
