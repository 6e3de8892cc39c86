//! What elaboration hands on: the graph and everything around it, in scalars.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Span};
use syn::{Attribute, Visibility};

use super::rings::Ring;
use crate::diagnostics::Diagnostic;
use crate::graph::{BondGraph, ElementId, JunctionId};
use crate::symbolic::{Expression, Symbol};

/// A model in which every name is resolved.
#[derive(Clone)]
pub struct Elaborated {
    /// Documentation comments of the model.
    pub documentation: Vec<Attribute>,
    /// Visibility of the type.
    pub visibility: Visibility,
    /// Name of the type.
    pub name: Ident,
    /// The graph.
    pub graph: BondGraph,
    /// Parameters in order of declaration.
    pub parameters: Vec<Parameter>,
    /// Scalar inputs in order of declaration.
    pub inputs: Vec<Variable>,
    /// Scalar outputs in order of declaration.
    pub outputs: Vec<Output>,
    /// Candidate states in order of declaration: storages, then integrals and attitudes.
    pub states: Vec<State>,
    /// Candidate states of attitudes.
    pub attitudes: Vec<Attitude>,
    /// Efforts and flows that laws and outputs read.
    pub signals: Signals,
    /// What parameters must fulfil.
    pub assumptions: Vec<Assumption>,
    /// Rings of joints that no cut closes.
    pub rings: Vec<Ring>,
    /// What is told of geometry that inputs move, by input.
    pub moving_inputs: BTreeMap<usize, Diagnostic>,
    /// What is said of components in use that are given what moves where something that stays is wanted, by their paths: notes and
    /// a help.
    pub moved: BTreeMap<String, (Vec<String>, String)>,
}

impl Elaborated {
    /// A symbol for people: the name of what was declared, or a number.
    #[must_use]
    pub fn symbol_text(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Parameter(index) => self.parameters[index].variable.name.clone(),
            Symbol::State(index) => self.states[index].variable.name.clone(),
            Symbol::Input(index) => self.inputs[index].name.clone(),
            Symbol::Time => "t".to_owned(),
            Symbol::Signal(index) => format!("signal {index}"),
            Symbol::Unknown(index) => format!("unknown {index}"),
            Symbol::Slope(index) => format!("slope {index}"),
        }
    }

    /// Notes and a help for a displacement in a component that is given what moves.
    #[must_use]
    pub fn given_what_moves(&self, displacement: &str) -> Option<&(Vec<String>, String)> {
        let is_around = |component: &str| {
            let inside = displacement.strip_prefix(component);
            inside.is_some_and(|inside| inside.starts_with('.'))
        };
        let mut moved = self.moved.iter();
        let (_, told) = moved.find(|(component, _)| is_around(component))?;
        Some(told)
    }
}

/// A scalar parameter.
#[derive(Clone)]
pub struct Parameter {
    /// The name that was declared.
    pub declared: Ident,
    /// Its place, if that is a vector.
    pub component: Option<usize>,
    /// Its own name, and its unit.
    pub variable: Variable,
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Default value.
    pub default: f64,
}

/// A name with a unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Such as `hull.p.x`.
    pub name: String,
    /// Unit as written, or empty.
    pub unit: String,
}

/// A scalar output.
#[derive(Clone)]
pub struct Output {
    /// Name and unit.
    pub variable: Variable,
    /// What it shows.
    pub value: Expression,
    /// Where it was written.
    pub span: Span,
}

/// A candidate state.
#[derive(Clone)]
pub struct State {
    /// Name and unit.
    pub variable: Variable,
    /// Value at the start, of parameters alone.
    pub initial: Expression,
    /// Whether that was written.
    pub is_given: bool,
    /// Where its time derivative comes from.
    pub rate: StateRate,
    /// Where it was written.
    pub span: Span,
}

/// Candidate states that are the entries of a matrix with orthonormal rows: a quaternion in one row of four, or a
/// rotation matrix in three rows of three.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attitude {
    /// Candidate states by row.
    pub rows: Vec<Vec<usize>>,
}

/// Where a state's time derivative comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateRate {
    /// Effort of an `I` or flow of a `C`, by component.
    Storage(ElementId, usize),
    /// An expression: an integral or an attitude.
    Expression(Expression),
    /// An unknown of the reduced equations: the rate of a coordinate's flow.
    Unknown(usize),
}

/// What an assumption says of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Not zero.
    NonZero,
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NotNegative,
}

/// An inequality that the equations rely on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumption {
    /// Of parameters alone.
    pub expression: Expression,
    /// What must hold of it.
    pub condition: Condition,
    /// What relies on it.
    pub reason: String,
}

/// Effort or flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Effort.
    Effort,
    /// Flow.
    Flow,
}

/// Whose effort or flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// The common variable of a junction.
    Junction(JunctionId),
    /// The port of a one-port.
    Port(ElementId),
}

/// An effort or flow by component.
pub type Signal = (Quantity, Place, usize);

/// Numbered signals, each once.
#[derive(Clone, Default)]
pub struct Signals {
    list: Vec<Signal>,
    numbers: BTreeMap<Signal, usize>,
}

impl Signals {
    /// The number of a signal, new or known.
    pub fn number(&mut self, signal: Signal) -> usize {
        *self.numbers.entry(signal).or_insert_with(|| {
            self.list.push(signal);
            self.list.len() - 1
        })
    }

    /// The symbol of a signal that something reads.
    #[must_use]
    pub fn symbol(&self, signal: Signal) -> Option<Symbol> {
        self.numbers.get(&signal).copied().map(Symbol::Signal)
    }

    /// All of them by number.
    #[must_use]
    pub fn list(&self) -> &[Signal] {
        &self.list
    }
}
