//! What statements declare before anything is connected: junctions, parameters, inputs and named values.

use proc_macro2::Ident;

use super::expressions::Value;
use super::model::Parameter;
use super::scope::{Entity, GRAVITY};
use super::{Builder, component_names};
use crate::codes;
use crate::diagnostics::error;
use crate::graph::{Junction, JunctionId};
use crate::symbolic::Symbol;
use crate::syntax::ast::{self, Statement};

impl<'a> Builder<'a> {
    /// Declares the names of junctions, parameters, inputs, values and loops.
    pub(super) fn declare_names(&mut self, scope: usize, statements: &'a [Statement]) {
        for statement in self.scopes[scope].constants.chosen(statements) {
            self.declare_name(scope, statement);
        }
    }

    fn declare_name(&mut self, scope: usize, statement: &'a Statement) {
        match statement {
            Statement::Junction(junction) => {
                let path = self.path(scope, &junction.name);
                let origin = self
                    .graph
                    .origins
                    .add(path.clone(), self.place(scope, junction.name.span()));
                let id = JunctionId(self.graph.junctions.len());
                self.graph.junctions.push(Junction {
                    kind: junction.kind,
                    name: path,
                    dimension: junction.dimension,
                    coordinate: junction.coordinate,
                    pseudo: junction.pseudo,
                    initial_flow: Vec::new(),
                    origin,
                });
                self.name(
                    scope,
                    &junction.name,
                    Entity::Junction(id, 0..junction.dimension),
                );
            }
            Statement::Parameter(parameter) if scope == 0 => self.parameter(parameter),
            Statement::Parameter(parameter) if self.scopes[scope].around.is_some() => {
                let message = "a parameter belongs to a model or a component; in a loop, use `let`";
                self.misplaced(scope, &parameter.name, message);
            }
            Statement::Choice(choice) if scope == 0 || self.scopes[scope].around.is_some() => {
                let message = "a choice of words belongs to a component, whose instances choose";
                self.misplaced(scope, &choice.name, message);
            }
            Statement::Input(input) => self.input(scope, input),
            Statement::Let(named) => {
                let value = (scope, &named.value);
                let shape = (named.dimension, named.unit.as_ref());
                let value = self.definition(scope, &named.name, shape, value);
                self.name(scope, &named.name, value);
            }
            Statement::Gravity(gravity) => self.gravity(scope, gravity),
            Statement::Loop(repeated) => self.declare_loop(scope, repeated),
            Statement::Causality(causality, _) => self.graph.causality = *causality,
            Statement::Broken(Some(name)) => {
                self.scopes[scope]
                    .names
                    .insert(name.to_string(), Entity::Opaque);
            }
            _ => {}
        }
    }

    fn misplaced(&mut self, scope: usize, name: &Ident, message: &str) {
        self.tell(scope, error(codes::EXPRESSION, name.span(), message));
        self.name(scope, name, Entity::Opaque);
    }

    fn parameter(&mut self, parameter: &'a ast::Parameter) {
        let name = &parameter.name;
        let (start, unit) = (self.parameters.len(), parameter.unit.as_ref());
        let unit_text = unit.map_or_else(String::new, |unit| unit.text.clone());
        let size = parameter.dimension.unwrap_or(1);
        let variables = component_names(&name.to_string(), size, &unit_text);
        let parameters = variables.into_iter().enumerate();
        self.parameters
            .extend(parameters.map(|(component, variable)| Parameter {
                declared: name.clone(),
                component: parameter.dimension.map(|_| component),
                variable,
                documentation: parameter.documentation.clone(),
                default: 0.0,
            }));
        let symbols = (start..start + size).map(Symbol::Parameter);
        self.claim_unit(0, symbols.clone(), unit);
        let values: Vec<_> = symbols.map(|symbol| self.pool.symbol(symbol)).collect();
        let value = match parameter.dimension {
            None => Value::Scalar(values[0]),
            Some(_) => Value::column(values),
        };
        self.name(0, name, Entity::Value(value));
    }

    fn input(&mut self, scope: usize, input: &ast::Input) {
        if scope != 0 {
            let message = "an input belongs to a model; give a component a parameter or a port";
            return self.tell(scope, error(codes::EXPRESSION, input.name.span(), message));
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
        let range = start..start + input.dimension;
        self.claim_unit(scope, range.clone().map(Symbol::Input), input.unit.as_ref());
        self.name(scope, &input.name, Entity::Input(range));
    }

    fn gravity(&mut self, scope: usize, gravity: &'a ast::Gravity) {
        let span = gravity.name.span();
        if scope != 0 {
            let message = "`gravity` belongs to a model, all of whose components see it";
            return self.tell(scope, error(codes::EXPRESSION, span, message));
        }
        let value = self.definition(scope, &gravity.name, (None, None), (scope, &gravity.value));
        let before = self.scopes[0].names.insert(GRAVITY.to_owned(), value);
        if matches!(before, Some(Entity::Definition(_))) {
            self.diagnostics
                .error(codes::DUPLICATE_NAME, span, "`gravity` is given twice");
        }
    }
}
