//! Names: which word stands for what, at which level of composition.

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::Ident;

use super::expressions::{Names, Result, Value, fail};
use super::is_two_port;
use super::model::{Place, Quantity, Signals};
use crate::codes;
use crate::diagnostics::error;
use crate::graph::{BondGraph, ElementId, ElementKind, JunctionId, JunctionKind};
use crate::symbolic::{Expression, Pool, Symbol};

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum Entity {
    /// A value, once it is known.
    Value(Option<Value>),
    /// Inputs by number.
    Input(Range<usize>),
    /// Components of a junction.
    Junction(JunctionId, Range<usize>),
    /// An element.
    Element(ElementId),
    /// States of an integral or attitude.
    States(Range<usize>),
    /// A component in use: its scope.
    Instance(usize),
    /// Declared, but broken or without a value.
    Opaque,
}

/// The names of a model or of one component in use.
#[derive(Debug)]
pub(super) struct Scope {
    /// `arm.` inside the instance `arm`.
    pub(super) prefix: String,
    /// Whether `#[derivative]` covers everything inside.
    pub(super) derivative: bool,
    /// Names.
    pub(super) names: BTreeMap<String, Entity>,
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

/// Names as one law sees them.
pub(super) struct Lookup<'a> {
    pub(super) scopes: &'a [Scope],
    pub(super) scope: usize,
    pub(super) graph: &'a BondGraph,
    /// States and dimension of one-ports by element.
    pub(super) ports: &'a [(Range<usize>, usize)],
    pub(super) signals: &'a mut Signals,
    pub(super) own: Option<Own>,
}

impl Names for Lookup<'_> {
    fn value(&mut self, pool: &mut Pool, path: &[Ident]) -> Option<Result<Value>> {
        if let [only] = path {
            if only == "t" {
                return Some(Ok(Value::Scalar(pool.symbol(Symbol::Time))));
            }
            if let Some(own) = self.own.clone()
                && ["q", "p", "e", "f"].iter().any(|word| only == word)
            {
                return Some(self.own_variable(pool, &own, only));
            }
        }
        let mut scope = self.scope;
        for (position, name) in path.iter().enumerate() {
            let entity = self.scopes[scope].names.get(&name.to_string())?;
            let rest = &path[position + 1..];
            match (entity, rest) {
                (Entity::Instance(inner), [_, ..]) => scope = *inner,
                (Entity::Element(id), [variable]) => {
                    return self.element_variable(pool, *id, variable);
                }
                (Entity::Junction(id, range), [variable]) => {
                    return self.junction_variable(pool, *id, range.clone(), variable);
                }
                (entity, []) => return Some(self.plain(pool, entity, name)),
                _ => return None,
            }
        }
        None
    }

    fn all(&self) -> Vec<&str> {
        let names = &self.scopes[self.scope].names;
        names.keys().map(String::as_str).collect()
    }
}

/// Why `e` and `f` of a two-port mean nothing.
const TWO_PORT_VARIABLE: &str = "a two-port has two efforts and two flows; read them at a junction";

impl Lookup<'_> {
    fn plain(&self, pool: &mut Pool, entity: &Entity, name: &Ident) -> Result<Value> {
        match entity {
            Entity::Value(Some(value)) => Ok(value.clone()),
            Entity::Input(range) => Ok(symbols(pool, range.clone().map(Symbol::Input))),
            Entity::States(range) => Ok(symbols(pool, range.clone().map(Symbol::State))),
            Entity::Junction(..) => fail(
                name.span(),
                format!("`{name}` is a junction; write `{name}.f` or `{name}.e`"),
            ),
            Entity::Element(_) => fail(
                name.span(),
                format!("`{name}` is an element; write `{name}.q`, `.p`, `.e` or `.f`"),
            ),
            _ => fail(name.span(), format!("`{name}` has no value here")),
        }
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
            "e" => Ok(self.signals(pool, Quantity::Effort, Place::Port(own.element), components)),
            "f" => Ok(self.signals(pool, Quantity::Flow, Place::Port(own.element), components)),
            _ => fail(name.span(), format!("a {kind:?} has no `{name}`")),
        }
    }

    fn element_variable(
        &mut self,
        pool: &mut Pool,
        id: ElementId,
        name: &Ident,
    ) -> Option<Result<Value>> {
        let kind = self.graph.elements[id.0].kind;
        let (range, dimension) = self.ports[id.0].clone();
        match (name.to_string().as_str(), kind) {
            ("q", ElementKind::C) | ("p", ElementKind::I) => {
                Some(Ok(states(pool, &range, 0..dimension)))
            }
            ("e" | "f", kind) if is_two_port(kind) => Some(fail(name.span(), TWO_PORT_VARIABLE)),
            ("e", _) => Some(Ok(self.signals(
                pool,
                Quantity::Effort,
                Place::Port(id),
                0..dimension,
            ))),
            ("f", _) => Some(Ok(self.signals(
                pool,
                Quantity::Flow,
                Place::Port(id),
                0..dimension,
            ))),
            _ => {
                let known = match kind {
                    ElementKind::I => "`p`, `e` and `f`",
                    ElementKind::C => "`q`, `e` and `f`",
                    _ => "`e` and `f`",
                };
                Some(no_variable(&self.graph.elements[id.0].name, name, known))
            }
        }
    }

    fn junction_variable(
        &mut self,
        pool: &mut Pool,
        id: JunctionId,
        range: Range<usize>,
        name: &Ident,
    ) -> Option<Result<Value>> {
        match (name.to_string().as_str(), self.graph.junctions[id.0].kind) {
            ("f", JunctionKind::One) => Some(Ok(self.signals(
                pool,
                Quantity::Flow,
                Place::Junction(id),
                range,
            ))),
            ("e", JunctionKind::Zero) => Some(Ok(self.signals(
                pool,
                Quantity::Effort,
                Place::Junction(id),
                range,
            ))),
            ("e", JunctionKind::One) => Some(fail(
                name.span(),
                "a 1-junction has no common effort; read it at an element",
            )),
            ("f", JunctionKind::Zero) => Some(fail(
                name.span(),
                "a 0-junction has no common flow; read it at an element",
            )),
            (_, kind) => {
                let known = match kind {
                    JunctionKind::Zero => "`e`",
                    JunctionKind::One => "`f`",
                };
                Some(no_variable(&self.graph.junctions[id.0].name, name, known))
            }
        }
    }

    fn signals(
        &mut self,
        pool: &mut Pool,
        quantity: Quantity,
        place: Place,
        components: Range<usize>,
    ) -> Value {
        let numbers: Vec<usize> = components
            .map(|index| self.signals.number((quantity, place, index)))
            .collect();
        symbols(pool, numbers.into_iter().map(Symbol::Signal))
    }
}

/// A variable that the element or junction does not have.
fn no_variable<T>(owner: &str, name: &Ident, known: &str) -> Result<T> {
    let message = format!("`{owner}` has no `{name}`, it has {known}");
    Err(Box::new(error(codes::UNKNOWN_NAME, name.span(), message)))
}

fn states(pool: &mut Pool, range: &Range<usize>, components: Range<usize>) -> Value {
    symbols(
        pool,
        components.map(|component| Symbol::State(range.start + component)),
    )
}

fn symbols(pool: &mut Pool, symbols: impl Iterator<Item = Symbol>) -> Value {
    let entries: Vec<Expression> = symbols.map(|symbol| pool.symbol(symbol)).collect();
    Value::column(entries)
}
