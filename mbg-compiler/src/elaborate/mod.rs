//! Stage 2, elaboration: the tree to a flat graph.
//!
//! Input: [`ast::Source`]. Output: one [`Elaborated`] per model: components are put in place, names resolved, laws
//! evaluated into the pool. Afterwards all dimensions agree and every port has one bond. Errors: `MBG02xx`,
//! `MBG0601`.

mod check;
pub mod expressions;
mod finish;
mod laws;
mod model;
mod quadrature;
mod scope;
mod size;

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::{Ident, Span};

pub use finish::component_table;
pub use model::{
    Assumption, Condition, Elaborated, Output, Parameter, Place, Quantity, Signal, Signals, State,
    StateRate, Variable,
};
pub use size::LIMIT;

use self::scope::{Entity, Scope};
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::graph::{
    Bond, BondGraph, Causality, Element, ElementId, ElementKind, End, Junction, JunctionId, Law,
    Origins, Rule,
};
use crate::symbolic::{Expression, Pool};
use crate::syntax::ast::{self, ChainNode, Reference, Statement};

/// Elaborates one model; none if anything was reported.
#[must_use]
pub fn elaborate(
    model: &ast::Model,
    components: &BTreeMap<String, &ast::Component>,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Elaborated> {
    let before = diagnostics.list().len();
    if !size::check(model, components, diagnostics) {
        return None;
    }
    let mut builder = Builder::new(model, components, pool, diagnostics);
    builder.declare(0, &model.statements);
    builder.declare_integrals();
    builder.resolve_laws();
    builder.check(model.name.span());
    (builder.diagnostics.list().len() == before).then(|| builder.finish(model))
}

/// How many scalars a model has for its surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sizes {
    /// States declared.
    pub states: usize,
    /// Inputs.
    pub inputs: usize,
    /// Outputs.
    pub outputs: usize,
}

/// The sizes of a model that may be broken, as far as it declares them.
#[must_use]
pub fn sizes(model: &ast::Model, components: &BTreeMap<String, &ast::Component>) -> Sizes {
    let (mut pool, mut unheard) = (Pool::new(), Diagnostics::new());
    if !size::check(model, components, &mut unheard) {
        return Sizes::default();
    }
    let mut builder = Builder::new(model, components, &mut pool, &mut unheard);
    builder.declare(0, &model.statements);
    builder.declare_integrals();
    let outputs = builder.pending.iter().map(|pending| match pending {
        Pending::Output { output, .. } => output.dimension,
        _ => 0,
    });
    Sizes {
        states: builder.states.len(),
        inputs: builder.inputs.len(),
        outputs: outputs.sum(),
    }
}

/// A law or value that is read once all names are known.
enum Pending<'a> {
    Law {
        scope: usize,
        element: &'a ast::Element,
        id: ElementId,
    },
    Gyroscopic {
        storage: ElementId,
        id: ElementId,
    },
    Argument {
        caller: usize,
        scope: usize,
        name: &'a Ident,
        value: &'a syn::Expr,
    },
    Integral {
        scope: usize,
        integral: &'a ast::Integral,
        states: Range<usize>,
    },
    Attitude {
        scope: usize,
        attitude: &'a ast::Attitude,
        states: Range<usize>,
    },
    Output {
        scope: usize,
        output: &'a ast::Output,
    },
}

/// The graph while it is being built.
struct Builder<'a> {
    components: &'a BTreeMap<String, &'a ast::Component>,
    pool: &'a mut Pool,
    diagnostics: &'a mut Diagnostics,
    scopes: Vec<Scope>,
    graph: BondGraph,
    /// States and dimension by element.
    ports: Vec<(Range<usize>, usize)>,
    states: Vec<State>,
    parameters: Vec<Parameter>,
    inputs: Vec<Variable>,
    outputs: Vec<Output>,
    signals: Signals,
    assumptions: Vec<Assumption>,
    pending: Vec<Pending<'a>>,
    integrals: Vec<(usize, &'a Statement)>,
}

impl<'a> Builder<'a> {
    fn new(
        model: &ast::Model,
        components: &'a BTreeMap<String, &'a ast::Component>,
        pool: &'a mut Pool,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        let root = Scope {
            prefix: String::new(),
            derivative: model.derivative.is_some(),
            names: BTreeMap::new(),
        };
        Self {
            components,
            pool,
            diagnostics,
            scopes: vec![root],
            graph: BondGraph {
                junctions: Vec::new(),
                elements: Vec::new(),
                bonds: Vec::new(),
                causality: Causality::Uniform,
                origins: Origins::default(),
            },
            ports: Vec::new(),
            states: Vec::new(),
            parameters: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            signals: Signals::default(),
            assumptions: Vec::new(),
            pending: Vec::new(),
            integrals: Vec::new(),
        }
    }

    /// Declares everything in a scope: first what chains may refer to from anywhere, then the rest in order.
    fn declare(&mut self, scope: usize, statements: &'a [Statement]) {
        for statement in statements {
            self.declare_name(scope, statement);
        }
        for statement in statements {
            match statement {
                Statement::Junction(junction) => self.fill_junction(scope, junction),
                Statement::Chain(chain) => self.chain(scope, chain),
                Statement::Instance(instance) => self.instance(scope, instance),
                Statement::Integral(_) | Statement::Attitude(_) => {
                    self.integrals.push((scope, statement))
                }
                Statement::Output(output) => self.pending.push(Pending::Output { scope, output }),
                _ => {}
            }
        }
    }

    fn declare_name(&mut self, scope: usize, statement: &'a Statement) {
        match statement {
            Statement::Junction(junction) => {
                let path = self.path(scope, &junction.name);
                let origin = self.graph.origins.add(path.clone(), junction.name.span());
                let id = JunctionId(self.graph.junctions.len());
                self.graph.junctions.push(Junction {
                    kind: junction.kind,
                    name: path,
                    dimension: junction.dimension,
                    coordinate: junction.coordinate,
                    origin,
                });
                self.name(
                    scope,
                    &junction.name,
                    Entity::Junction(id, 0..junction.dimension),
                );
            }
            Statement::Parameter(parameter) => self.parameter(scope, parameter),
            Statement::Input(input) => self.input(scope, input),
            Statement::Causality(causality, _) => self.graph.causality = *causality,
            Statement::Broken(Some(name)) => {
                self.scopes[scope]
                    .names
                    .insert(name.to_string(), Entity::Opaque);
            }
            _ => {}
        }
    }

    fn path(&self, scope: usize, name: &Ident) -> String {
        format!("{}{name}", self.scopes[scope].prefix)
    }

    /// Gives a name its meaning; a second meaning is an error.
    fn name(&mut self, scope: usize, name: &Ident, entity: Entity) {
        if self.scopes[scope]
            .names
            .insert(name.to_string(), entity)
            .is_some()
        {
            let message = format!("`{name}` is declared twice");
            self.diagnostics
                .error(codes::DUPLICATE_NAME, name.span(), message);
        }
    }

    fn parameter(&mut self, scope: usize, parameter: &'a ast::Parameter) {
        if scope != 0 {
            // The call has named it already; a default stands in for a missing argument.
            if self.scopes[scope]
                .names
                .contains_key(&parameter.name.to_string())
            {
                return;
            }
            match &parameter.default {
                Some(value) => {
                    self.name(scope, &parameter.name, Entity::Value(None));
                    let name = &parameter.name;
                    self.pending.push(Pending::Argument {
                        caller: scope,
                        scope,
                        name,
                        value,
                    });
                }
                None => self.name(scope, &parameter.name, Entity::Opaque),
            }
            return;
        }
        let default = self.default_value(parameter);
        let symbol = self
            .pool
            .symbol(crate::symbolic::Symbol::Parameter(self.parameters.len()));
        self.name(
            scope,
            &parameter.name,
            Entity::Value(Some(expressions::Value::Scalar(symbol))),
        );
        self.parameters.push(Parameter {
            name: parameter.name.clone(),
            documentation: parameter.documentation.clone(),
            unit: parameter
                .unit
                .as_ref()
                .map_or_else(String::new, |unit| unit.text.clone()),
            default,
        });
    }

    fn input(&mut self, scope: usize, input: &ast::Input) {
        if scope != 0 {
            let message = "an input belongs to a model; give a component a parameter or a port";
            self.diagnostics
                .error(codes::EXPRESSION, input.name.span(), message);
            return;
        }
        let start = self.inputs.len();
        let unit = input
            .unit
            .as_ref()
            .map_or_else(String::new, |unit| unit.text.clone());
        self.inputs.extend(component_names(
            &input.name.to_string(),
            input.dimension,
            &unit,
        ));
        self.name(
            scope,
            &input.name,
            Entity::Input(start..start + input.dimension),
        );
    }

    fn fill_junction(&mut self, scope: usize, junction: &'a ast::Junction) {
        let Some(Entity::Junction(id, range)) = self.scopes[scope]
            .names
            .get(&junction.name.to_string())
            .cloned()
        else {
            return;
        };
        for element in &junction.elements {
            if is_two_port(element.kind) {
                let message = format!(
                    "a {:?} has two ports; put it between two arrows",
                    element.kind
                );
                self.diagnostics
                    .error(codes::UNCONNECTED, element.span, message);
                continue;
            }
            let end = End::Junction(id, range.clone());
            self.one_port_at(scope, element, end, range.len(), element.name.span());
        }
    }

    fn one_port_at(
        &mut self,
        scope: usize,
        element: &'a ast::Element,
        end: End,
        dimension: usize,
        span: Span,
    ) {
        if let Some(own) = element.dimension.filter(|own| *own != dimension) {
            let message = format!(
                "`{}` has dimension {own}, its junction {dimension}",
                element.name
            );
            self.diagnostics
                .error(codes::WRONG_DIMENSION, element.name.span(), message);
            return;
        }
        let id = self.element(scope, element, dimension);
        let source = matches!(element.kind, ElementKind::Se | ElementKind::Sf);
        let (from, to) = if source {
            (End::OnePort(id), end.clone())
        } else {
            (end.clone(), End::OnePort(id))
        };
        self.bond(from, to, dimension, span);
        self.gyroscopic(element, id, &end, dimension);
    }

    /// `gyroscopic` puts the Euler junction structure at the same junction.
    fn gyroscopic(
        &mut self,
        element: &ast::Element,
        storage: ElementId,
        end: &End,
        dimension: usize,
    ) {
        let Some(mark) = element
            .fields
            .iter()
            .find(|field| field.name == "gyroscopic")
        else {
            return;
        };
        if dimension != 3 || !matches!(end, End::Junction(..)) {
            let message = "`gyroscopic` needs an inertia of dimension 3 at a junction";
            self.diagnostics
                .error(codes::WRONG_DIMENSION, mark.name.span(), message);
            return;
        }
        let name = format!("{}.gyroscopic", self.graph.elements[storage.0].name);
        let origin = self.graph.origins.add(name.clone(), mark.name.span());
        let id = ElementId(self.graph.elements.len());
        self.graph.elements.push(Element {
            kind: ElementKind::EJS,
            name,
            law: Law::EulerJunction(Vec::new()),
            rule: Rule::Gyroscopic,
            derivative: false,
            origin,
        });
        self.ports.push((0..0, 3));
        self.bond(end.clone(), End::OnePort(id), 3, mark.name.span());
        self.pending.push(Pending::Gyroscopic { storage, id });
    }

    /// Adds an element with a law to be read later, and its states.
    fn element(&mut self, scope: usize, element: &'a ast::Element, dimension: usize) -> ElementId {
        let path = self.path(scope, &element.name);
        let origin = self.graph.origins.add(path.clone(), element.name.span());
        let id = ElementId(self.graph.elements.len());
        let start = self.states.len();
        if let Some(letter) = state_letter(element.kind) {
            for (component, variable) in component_names(&format!("{path}.{letter}"), dimension, "")
                .into_iter()
                .enumerate()
            {
                let rate = StateRate::Storage(id, component);
                self.states.push(State {
                    variable,
                    initial: Expression::ZERO,
                    rate,
                    span: element.name.span(),
                });
            }
        }
        self.graph.elements.push(Element {
            kind: element.kind,
            name: path,
            law: Law::Source(Vec::new()),
            rule: Rule::Either,
            derivative: element.derivative.is_some() || self.scopes[scope].derivative,
            origin,
        });
        self.ports.push((start..self.states.len(), dimension));
        self.name(scope, &element.name, Entity::Element(id));
        self.pending.push(Pending::Law { scope, element, id });
        id
    }

    fn bond(&mut self, from: End, to: End, dimension: usize, span: Span) {
        let path = format!(
            "{} -> {}",
            self.graph.end_name(&from),
            self.graph.end_name(&to)
        );
        let origin = self.graph.origins.add(path, span);
        self.graph.bonds.push(Bond {
            from,
            to,
            dimension,
            origin,
        });
    }

    fn chain(&mut self, scope: usize, chain: &'a ast::Chain) {
        let known: Vec<Option<(End, usize)>> = chain
            .nodes
            .iter()
            .map(|node| match node {
                ChainNode::Reference(reference) => self.resolve(scope, reference),
                ChainNode::Element(_) => None,
            })
            .collect();
        let ends: Vec<Option<(End, End, usize)>> = (0..chain.nodes.len())
            .map(|position| match &chain.nodes[position] {
                ChainNode::Reference(_) => known[position]
                    .clone()
                    .map(|(end, size)| self.both_sides(end, size)),
                ChainNode::Element(element) => {
                    let neighbour = [position.wrapping_sub(1), position + 1]
                        .into_iter()
                        .find_map(|side| known.get(side).cloned().flatten());
                    self.chain_element(scope, element, neighbour)
                }
            })
            .collect();
        for (position, arrow) in chain.arrows.iter().enumerate() {
            if let (Some((_, from, size)), Some((to, _, other))) =
                (&ends[position], &ends[position + 1])
            {
                let size = if *size == 0 { *other } else { *size };
                self.bond(from.clone(), to.clone(), size, *arrow);
            }
        }
    }

    /// The ends that an arrow arriving and an arrow leaving see, and the dimension (0 while unknown).
    fn both_sides(&self, end: End, size: usize) -> (End, End, usize) {
        match end {
            End::OnePort(id) if is_two_port(self.graph.elements[id.0].kind) => {
                (End::In(id), End::Out(id), 0)
            }
            end => (end.clone(), end, size),
        }
    }

    fn chain_element(
        &mut self,
        scope: usize,
        element: &'a ast::Element,
        neighbour: Option<(End, usize)>,
    ) -> Option<(End, End, usize)> {
        let size = neighbour.as_ref().map_or(1, |(_, size)| *size);
        if is_two_port(element.kind) {
            let id = self.element(scope, element, size);
            return Some((End::In(id), End::Out(id), 0));
        }
        let size = element.dimension.unwrap_or(size.max(1));
        let id = self.element(scope, element, size);
        if let Some((end, _)) = neighbour {
            self.gyroscopic(element, id, &end, size);
        }
        Some((End::OnePort(id), End::OnePort(id), size))
    }

    /// What a reference in a chain or call stands for.
    fn resolve(&mut self, scope: usize, reference: &Reference) -> Option<(End, usize)> {
        let mut current = scope;
        let mut found: Option<Entity> = None;
        let mut component = None;
        for (position, name) in reference.path.iter().enumerate() {
            let last = position + 1 == reference.path.len();
            match &found {
                None => {}
                Some(Entity::Instance(inner)) => current = *inner,
                Some(Entity::Junction(..))
                    if last && expressions::component_index(name).is_some() =>
                {
                    component = expressions::component_index(name);
                    continue;
                }
                Some(_) => return self.unknown(current, reference),
            }
            found = self.scopes[current].names.get(&name.to_string()).cloned();
            if found.is_none() {
                return self.unknown(current, reference);
            }
        }
        match found? {
            Entity::Junction(id, range) => self.select(reference, id, &range, component),
            Entity::Element(id) => Some((End::OnePort(id), self.ports[id.0].1)),
            Entity::Opaque => None,
            _ => {
                let message = format!(
                    "expected a junction or an element, found `{}`",
                    text(reference)
                );
                self.diagnostics
                    .error(codes::UNKNOWN_NAME, reference.span, message);
                None
            }
        }
    }

    fn select(
        &mut self,
        reference: &Reference,
        id: JunctionId,
        range: &Range<usize>,
        component: Option<usize>,
    ) -> Option<(End, usize)> {
        let picked = match (&reference.selection, component) {
            (Some(selection), _) => selection.start..selection.end,
            (None, Some(component)) => component..component + 1,
            (None, None) => 0..range.len(),
        };
        if picked.end > range.len() {
            let message = format!(
                "`{}` has {} components, `{}` asks for more",
                reference.path[0],
                range.len(),
                text(reference)
            );
            self.diagnostics
                .error(codes::WRONG_DIMENSION, reference.span, message);
            return None;
        }
        let shifted = range.start + picked.start..range.start + picked.end;
        let size = shifted.len();
        Some((End::Junction(id, shifted), size))
    }

    /// Reports a name that this scope does not know.
    fn unknown<T>(&mut self, scope: usize, reference: &Reference) -> Option<T> {
        let message = format!("`{}` is not declared", text(reference));
        let names = &self.scopes[scope].names;
        let junctions: Vec<String> = names
            .iter()
            .filter(|(_, entity)| matches!(entity, Entity::Junction(..)))
            .map(|(name, _)| name.clone())
            .collect();
        let known: Vec<&str> = names.keys().map(String::as_str).collect();
        let last = reference.path.last().map(ToString::to_string);
        let mut report = error(codes::UNKNOWN_NAME, reference.span, message)
            .did_you_mean(&last.unwrap_or_default(), &known);
        if report.helps.is_empty() && !junctions.is_empty() {
            report = report.help(format!(
                "junctions here are {}",
                crate::diagnostics::listing(junctions)
            ));
        }
        self.diagnostics.report(report);
        None
    }

    fn instance(&mut self, scope: usize, instance: &'a ast::Instance) {
        let components = self.components;
        let Some(component) = components.get(&instance.component.to_string()) else {
            let message = format!("component `{}` is not declared", instance.component);
            let known: Vec<&str> = components.keys().map(String::as_str).collect();
            let report = error(codes::UNKNOWN_NAME, instance.component.span(), message);
            self.diagnostics
                .report(report.did_you_mean(&instance.component.to_string(), &known));
            self.name(scope, &instance.name, Entity::Opaque);
            return;
        };
        let inner = self.scopes.len();
        let derivative = self.scopes[scope].derivative
            || instance.derivative.is_some()
            || component.derivative.is_some();
        let prefix = format!("{}.", self.path(scope, &instance.name));
        self.scopes.push(Scope {
            prefix,
            derivative,
            names: BTreeMap::new(),
        });
        self.name(scope, &instance.name, Entity::Instance(inner));
        self.ports_of(scope, inner, instance, component);
        self.arguments_of(scope, inner, instance, component);
        self.declare(inner, &component.statements);
    }

    fn ports_of(
        &mut self,
        scope: usize,
        inner: usize,
        instance: &ast::Instance,
        component: &ast::Component,
    ) {
        if instance.connections.len() != component.ports.len() {
            let message = format!(
                "`{}` has {} ports, found {} junctions",
                component.name,
                component.ports.len(),
                instance.connections.len()
            );
            self.diagnostics
                .error(codes::UNCONNECTED, instance.name.span(), message);
        }
        for (position, port) in component.ports.iter().enumerate() {
            let given = instance
                .connections
                .get(position)
                .and_then(|reference| self.resolve(scope, reference));
            let entity = match given {
                Some((End::Junction(id, range), size)) if size == port.dimension => {
                    Entity::Junction(id, range)
                }
                Some((_, size)) => {
                    let message = format!(
                        "port `{}` has dimension {}, found {size}",
                        port.name, port.dimension
                    );
                    let span = instance.connections[position].span;
                    self.diagnostics
                        .error(codes::WRONG_DIMENSION, span, message);
                    Entity::Opaque
                }
                None => Entity::Opaque,
            };
            self.name(inner, &port.name, entity);
        }
    }

    fn arguments_of(
        &mut self,
        scope: usize,
        inner: usize,
        instance: &'a ast::Instance,
        component: &'a ast::Component,
    ) {
        let parameters: Vec<&ast::Parameter> = component
            .statements
            .iter()
            .filter_map(|statement| {
                if let Statement::Parameter(parameter) = statement {
                    Some(parameter)
                } else {
                    None
                }
            })
            .collect();
        for argument in &instance.arguments {
            if !parameters
                .iter()
                .any(|parameter| parameter.name == argument.name)
            {
                let message = format!("`{}` has no parameter `{}`", component.name, argument.name);
                self.diagnostics
                    .error(codes::UNKNOWN_FIELD, argument.name.span(), message);
            } else if let Some(value) = &argument.value {
                self.name(inner, &argument.name, Entity::Value(None));
                let name = &argument.name;
                self.pending.push(Pending::Argument {
                    caller: scope,
                    scope: inner,
                    name,
                    value,
                });
            }
        }
        for parameter in parameters {
            let given = instance
                .arguments
                .iter()
                .any(|argument| argument.name == parameter.name);
            if !given && parameter.default.is_none() {
                let message = format!(
                    "`{}` needs a value for `{}`",
                    component.name, parameter.name
                );
                let report = error(codes::MISSING_DEFAULT, instance.name.span(), message);
                self.diagnostics
                    .report(report.help(format!("write `{{ {}: … }}`", parameter.name)));
            }
        }
    }
}

fn is_two_port(kind: ElementKind) -> bool {
    matches!(
        kind,
        ElementKind::TF | ElementKind::GY | ElementKind::MTF | ElementKind::MGY
    )
}

fn state_letter(kind: ElementKind) -> Option<char> {
    match kind {
        ElementKind::I => Some('p'),
        ElementKind::C => Some('q'),
        _ => None,
    }
}

/// `name`, or `name.x`, `name.y`, … for more than one component.
fn component_names(name: &str, dimension: usize, unit: &str) -> Vec<Variable> {
    let scalar = |name: String| Variable {
        name,
        unit: unit.to_owned(),
    };
    if dimension == 1 {
        return vec![scalar(name.to_owned())];
    }
    (0..dimension)
        .map(|index| {
            scalar(format!(
                "{name}.{}",
                crate::graph::component_name(index, dimension)
            ))
        })
        .collect()
}

fn text(reference: &Reference) -> String {
    let path = reference
        .path
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join(".");
    match &reference.selection {
        Some(selection) if selection.end == selection.start + 1 => {
            format!("{path}[{}]", selection.start)
        }
        Some(selection) => format!("{path}[{}..{}]", selection.start, selection.end),
        None => path,
    }
}
