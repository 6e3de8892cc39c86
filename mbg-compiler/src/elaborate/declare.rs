//! What statements declare before anything is connected: junctions, parameters, inputs and named values.

use proc_macro2::Ident;

use super::expressions::Value;
use super::model::Parameter;
use super::scope::{Entity, GRAVITY};
use super::{Builder, component_names};
use crate::codes;
use crate::diagnostics::error;
use crate::graph::{Junction, JunctionId, component_name};
use crate::symbolic::Symbol;
use crate::syntax::ast::{self, Statement};
use crate::syntax::dump::{self, MOST_PARTS};

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
        if let Some(dimension) = parameter.dimension {
            return self.vector_parameter(parameter, dimension);
        }
        let symbol = self.pool.symbol(Symbol::Parameter(self.parameters.len()));
        let value = Entity::Value(Value::Scalar(symbol));
        let number = self.parameters.len();
        self.claim_unit(0, [Symbol::Parameter(number)], parameter.unit.as_ref());
        self.name(0, &parameter.name, value);
        self.parameters.push(Parameter {
            name: parameter.name.clone(),
            documentation: parameter.documentation.clone(),
            unit: parameter
                .unit
                .as_ref()
                .map_or_else(String::new, |unit| unit.text.clone()),
            default: 0.0,
        });
    }

    fn vector_parameter(&mut self, parameter: &ast::Parameter, dimension: usize) {
        let name = &parameter.name;
        let unit = parameter.unit_text();
        let parts =
            (0..dimension).map(|part| format!("{name}_{}", component_name(part, dimension)));
        let parts: Vec<String> = parts.take(MOST_PARTS).collect();
        let message = format!("`{name}` is a parameter of a model, which is a number");
        let mut report = error(codes::WRONG_DIMENSION, name.span(), message);
        if dimension <= MOST_PARTS {
            let all = parts.join(", ");
            report = report.help(format!(
                "give each component a parameter of its own, `param {}{unit} = 1.0;`, and write `let {name}[{dimension}]{unit} = [{all}];`",
                parts[0]
            ));
        }
        let value = parameter.default.as_ref();
        if let Some(value) = value.and_then(|value| dump::column(value, dimension)) {
            report = report.help(format!(
                "write `let {name}[{dimension}]{unit} = {value};` for a value that never changes"
            ));
        }
        self.diagnostics.report(report);
        self.name(0, name, Entity::Opaque);
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
