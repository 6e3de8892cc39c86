//! Second half of elaboration: laws, integrals and outputs, once all names are known.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Span};
use syn::spanned::Spanned;

use super::claims::Subject;
use super::definitions::{Missing, by_component, of_entries};
use super::expressions::{Evaluator, Result, Step, Value};
use super::laws::{Reader, words_of};
use super::mentions::mentioned;
use super::model::{Elaborated, Output, State, StateRate};
use super::own::Own;
use super::scope::{Entity, Lookup};
use super::{Builder, Pending, component_names};
use super::{elsewhere, laws_elsewhere};
use crate::codes;
use crate::diagnostics::{Diagnostic, error, listing};
use crate::graph::{ElementId, JunctionId, Law};
use crate::symbolic::{Expression, Pool, Rate, Symbol};
use crate::syntax::ast::{self, Orientation, Statement};
use crate::syntax::dump;
use crate::syntax::words::{is_misspelt, law_words};

impl<'a> Builder<'a> {
    /// Reads the defaults of a model's parameters, once it is known what the model declares.
    pub(super) fn read_defaults(&mut self, statements: &[Statement]) {
        let chosen = self.scopes[0].constants.chosen(statements);
        let mut number = 0;
        for statement in chosen {
            let Statement::Parameter(parameter) = statement else {
                continue;
            };
            for (component, value) in self.default_values(parameter).into_iter().enumerate() {
                self.parameters[number + component].default = value;
            }
            number += parameter.dimension.unwrap_or(1);
        }
    }

    /// A model parameter's default, by component, which must be numbers; nothing if it was told that it is not.
    fn default_values(&mut self, parameter: &ast::Parameter) -> Vec<f64> {
        let Some(expression) = &parameter.default else {
            self.diagnostics.report(without_default(parameter));
            return Vec::new();
        };
        let value = self.evaluate(0, expression);
        let value = match parameter.dimension {
            Some(size) => {
                value.and_then(|it| self.column_of(it, size, &parameter.name, expression))
            }
            None => value,
        };
        // A default is a number and waits for no other value.
        self.missing = None;
        let entries = value.as_ref().ok().and_then(|it| it.entries(self.pool));
        let numbers = entries.iter().flatten();
        let numbers = numbers.map(|it| self.pool.constant_value(*it));
        let numbers: Option<Vec<f64>> = numbers.collect();
        let is_scalar = matches!(value, Ok(Value::Scalar(_)));
        match (value, numbers) {
            (Ok(_), Some(numbers)) if is_scalar || parameter.dimension.is_some() => return numbers,
            // What reads a value that exists is no number, whatever else may be wrong with it.
            (Err(report), _) if !self.reads_what_exists(expression) => {
                self.diagnostics.report(*report);
            }
            _ => {
                let entries = entries.map_or(1, |entries| entries.len());
                let report = no_default(parameter, expression, entries);
                self.diagnostics.report(report);
            }
        }
        Vec::new()
    }

    /// Whether an expression of the model mentions names, all of them declared.
    fn reads_what_exists(&self, expression: &syn::Expr) -> bool {
        let paths = mentioned(expression);
        let exists = |path: &Vec<Step>| {
            let name = path[0].name.to_string();
            name == "t" || self.scopes.find(0, &name).is_some()
        };
        !paths.is_empty() && paths.iter().all(exists)
    }

    /// Gives integrals and attitudes their states, after those of the storages.
    pub(super) fn declare_integrals(&mut self) {
        for (scope, statement) in std::mem::take(&mut self.integrals) {
            let (name, unit, dimension) = match statement {
                Statement::Integral(integral) => {
                    (&integral.name, integral.unit.as_ref(), integral.dimension)
                }
                Statement::Attitude(attitude) => {
                    let dimension = match attitude.orientation {
                        Orientation::Quaternion => 4,
                        Orientation::Matrix => 9,
                    };
                    (&attitude.name, None, dimension)
                }
                _ => continue,
            };
            let start = self.states.len();
            self.claim_unit(scope, (start..start + dimension).map(Symbol::State), unit);
            let unit = unit.map_or("", |unit| unit.text.as_str());
            let path = self.path(scope, name);
            let span = self.place(scope, name.span());
            for variable in component_names(&path, dimension, unit) {
                let rate = StateRate::Expression(Expression::ZERO);
                self.states.push(State {
                    variable,
                    initial: Expression::ZERO,
                    is_given: false,
                    rate,
                    span,
                });
            }
            let states = start..self.states.len();
            let entity = match statement {
                Statement::Attitude(attitude) => {
                    self.place_attitude(attitude.orientation, states.clone())
                }
                _ => Entity::States(states.clone()),
            };
            self.name(scope, name, entity);
            // Before the outputs, which may read them; they are read after all laws anyway.
            self.pending.push(match statement {
                Statement::Integral(integral) => Pending::Integral {
                    scope,
                    integral,
                    states,
                },
                Statement::Attitude(attitude) => Pending::Attitude {
                    scope,
                    attitude,
                    states,
                },
                _ => continue,
            });
        }
    }

    /// Reads everything that was put off.
    pub(super) fn resolve_laws(&mut self) {
        for pending in std::mem::take(&mut self.pending) {
            if let Pending::Law { scope, element, .. } = pending {
                self.check_words(scope, element);
            }
            self.settle(pending.scope(), &pending.expressions(), |builder| {
                builder.resolve_law(pending.clone())
            });
        }
        self.check_springs();
        self.check_turning();
        self.warn_of_idle();
        self.warn_of_moving();
        self.define_unread();
        self.warn_of_defaults();
    }

    fn resolve_law(&mut self, pending: Pending<'a>) -> Result<()> {
        match pending {
            Pending::Law { scope, element, id } => self.law(scope, element, id),
            Pending::Gyroscopic { storage, id, .. } => {
                let states = self.ports[storage.0].0.clone();
                let momentum = states
                    .map(|state| self.pool.symbol(Symbol::State(state)))
                    .collect();
                self.graph.elements[id.0].law = Law::EulerJunction(momentum);
                Ok(())
            }
            Pending::Integral {
                scope,
                integral,
                states,
            } => self.integral(scope, integral, states),
            Pending::Attitude {
                scope,
                attitude,
                states,
            } => self.attitude(scope, attitude, states),
            Pending::Coordinate {
                scope,
                junction,
                value,
                id,
            } => {
                let initial = self.start(scope, (junction, id), value)?;
                self.graph.junctions[id.0].initial_flow = initial;
                Ok(())
            }
            Pending::Output { scope, output } => self.output(scope, output),
            Pending::Assertion { scope, assertion } => {
                self.assertion(scope, &assertion.name, &assertion.condition)
            }
            Pending::Displacement {
                scope,
                closure,
                number,
            } => self.displacement(scope, closure, number),
        }
    }

    fn displacement(&mut self, scope: usize, closure: &ast::Closure, number: usize) -> Result<()> {
        let Some(value) = &closure.displacement else {
            return Ok(());
        };
        let [bond, _] = self.graph.closures[number].bonds;
        let dimension = self.graph.bonds[bond.0].dimension;
        let entries = self.vector(scope, value, dimension, &closure.name)?;
        self.claim(scope, Subject::Displacement(number), &entries, value.span());
        self.graph.closures[number].displacement = Some(entries);
        Ok(())
    }

    pub(super) fn lookup(&mut self, scope: usize) -> (&mut Pool, Lookup<'_, 'a>) {
        let lookup = Lookup {
            scopes: &self.scopes,
            scope,
            graph: &self.graph,
            ports: &self.ports,
            definitions: &self.definitions,
            missing: &mut self.missing,
            signals: &mut self.signals,
            own: None,
            claims: self.claims.as_mut(),
            defaults: &mut self.defaults,
            assumptions: &mut self.assumptions,
            parameters: &self.parameters,
        };
        (self.pool, lookup)
    }

    /// The value of an expression with names from a scope.
    pub(super) fn evaluate(&mut self, scope: usize, expression: &syn::Expr) -> Result<Value> {
        let (pool, mut lookup) = self.lookup(scope);
        Evaluator {
            pool,
            names: &mut lookup,
        }
        .evaluate(expression)
    }

    /// The value of a definition, for what is called `name` in a scope.
    pub(super) fn value_of(
        &mut self,
        scope: usize,
        definition: usize,
        name: &Ident,
    ) -> Result<Value> {
        let (pool, mut lookup) = self.lookup(scope);
        lookup.plain(pool, &Entity::Definition(definition), name)
    }

    pub(super) fn vector(
        &mut self,
        scope: usize,
        expression: &syn::Expr,
        dimension: usize,
        name: &Ident,
    ) -> Result<Vec<Expression>> {
        let value = self.evaluate(scope, expression)?;
        let entries = self.entries(&value, dimension, name);
        entries.map_err(|report| match value {
            Value::Scalar(_) => by_component(report, expression, dimension),
            Value::Matrix(_) => of_entries(report, expression, dimension),
        })
    }

    /// The entries of a vector of the given dimension.
    pub(super) fn entries(
        &mut self,
        value: &Value,
        dimension: usize,
        name: &Ident,
    ) -> Result<Vec<Expression>> {
        match value.entries(self.pool) {
            Some(entries) if entries.len() == dimension => Ok(entries),
            _ => {
                let shape = value.shape();
                let message = format!("`{name}` has dimension {dimension}, found {shape}");
                Err(Box::new(error(
                    codes::WRONG_DIMENSION,
                    name.span(),
                    message,
                )))
            }
        }
    }

    /// Reports the words that an element does not know.
    pub(super) fn check_words(&mut self, scope: usize, element: &ast::Element) {
        let words = words_of(element.kind);
        for field in &element.fields {
            if words.iter().any(|word| field.name == word) {
                continue;
            }
            let message = format!("`{:?}` does not know `{}`", element.kind, field.name);
            let known = words.iter().map(|word| (*word).to_owned());
            let report = error(codes::UNKNOWN_FIELD, field.name.span(), message);
            let (word, value) = (&field.name, field.value.as_ref());
            let report = match laws_elsewhere::told(element, word, value) {
                Some(help) => report.help(help),
                None => report.did_you_mean(&word.to_string(), &words),
            };
            self.tell(
                scope,
                report.help(format!("its words are {}", listing(known))),
            );
        }
    }

    fn law(&mut self, scope: usize, element: &ast::Element, id: ElementId) -> Result<()> {
        let field = law_field(element).inspect_err(|_| {
            let words = words_of(element.kind);
            let found = || element.fields.iter().map(|field| &field.name);
            let mut laws = law_words(element.kind).iter();
            let is_other = found().any(|it| laws_elsewhere::law(element.kind, it, None).is_some());
            let is_other = is_other
                || found()
                    .any(|it| laws_elsewhere::is_law(it) && !words.iter().any(|word| it == word));
            if is_other || laws.any(|law| is_misspelt(law, found(), &words)) {
                self.missing = Some(Missing::Broken);
            }
        })?;
        if self.claims.is_some() {
            return self.claim_words(scope, element, id);
        }
        let (states, dimension) = self.ports[id.0].clone();
        let own = Own {
            element: id,
            states: states.clone(),
            dimension,
            component: None,
        };
        let (pool, mut lookup) = self.lookup(scope);
        let reading = Reader {
            pool,
            lookup: &mut lookup,
            element,
            own,
        }
        .read(field)?;
        let starts = |field: &&ast::Field| field.name.to_string().starts_with("initial");
        let start = element.fields.iter().find(starts);
        let place = start.and_then(|field| field.value.as_ref());
        let place = place.map_or(element.name.span(), |value| value.span());
        for (state, initial) in states.zip(reading.initial.into_iter().flatten()) {
            self.initial_value(state, initial, place)?;
        }
        self.graph.elements[id.0].law = reading.law;
        self.graph.elements[id.0].rule = reading.rule;
        self.assumptions.extend(reading.assumptions);
        Ok(())
    }

    /// The flow of a coordinate at the start.
    fn start(
        &mut self,
        scope: usize,
        (junction, id): (&ast::Junction, JunctionId),
        value: &syn::Expr,
    ) -> Result<Vec<Expression>> {
        let initial = self.vector(scope, value, junction.dimension, &junction.name)?;
        let flow = Subject::Flow(id);
        self.claim(scope, flow, &initial, value.span());
        let varies = |initial: &Expression| self.pool.rate(*initial) == Rate::Varying;
        if self.claims.is_none() && initial.iter().any(varies) {
            let message = "expected numbers and parameters alone, from which a state starts";
            return Err(Box::new(error(codes::EXPRESSION, value.span(), message)));
        }
        Ok(initial)
    }

    pub(super) fn initial_value(
        &mut self,
        state: usize,
        initial: Expression,
        place: Span,
    ) -> Result<()> {
        if self.claims.is_none() && self.pool.rate(initial) == Rate::Varying {
            let message = "expected numbers and parameters alone, from which a state starts";
            return Err(Box::new(error(codes::EXPRESSION, place, message)));
        }
        self.states[state].initial = initial;
        self.states[state].is_given = true;
        Ok(())
    }

    fn integral(
        &mut self,
        scope: usize,
        integral: &ast::Integral,
        states: std::ops::Range<usize>,
    ) -> Result<()> {
        let rates = self.vector(scope, &integral.rate, integral.dimension, &integral.name);
        let rates = rates.map_err(|report| {
            let start = integral.initial.as_ref().map(dump::expression);
            let start = start.map_or_else(String::new, |start| format!(", initial: {start}"));
            let (unit, value) = (integral.unit.as_ref(), &integral.rate);
            let declared = ("integral", &integral.name, integral.dimension);
            self.of_its_size(scope, declared, (unit, value, start), report)
        })?;
        let initial = match &integral.initial {
            Some(value) => self.vector(scope, value, integral.dimension, &integral.name)?,
            None => vec![Expression::ZERO; integral.dimension],
        };
        self.claim(
            scope,
            Subject::Rate(states.clone()),
            &rates,
            integral.rate.span(),
        );
        if let Some(value) = &integral.initial {
            self.claim(
                scope,
                Subject::Start(states.clone()),
                &initial,
                value.span(),
            );
        }
        let place = integral.initial.as_ref();
        let place = place.map_or(integral.name.span(), |value| value.span());
        for ((state, rate), initial) in states.zip(rates).zip(initial) {
            self.states[state].rate = StateRate::Expression(rate);
            self.initial_value(state, initial, place)?;
        }
        Ok(())
    }

    /// What to write for what is declared with another dimension than its value, which something may follow.
    fn of_its_size(
        &mut self,
        scope: usize,
        (word, name, dimension): (&str, &Ident, usize),
        (unit, value, rest): (Option<&ast::Unit>, &syn::Expr, String),
        report: Box<Diagnostic>,
    ) -> Box<Diagnostic> {
        let text = dump::expression(value);
        let is_part = matches!(value, syn::Expr::Path(_) | syn::Expr::Field(_));
        let value = self.evaluate(scope, value).ok();
        let entries = value.and_then(|value| value.entries(self.pool));
        let size = entries.map_or(0, |entries| entries.len());
        if report.code != codes::WRONG_DIMENSION || size < 2 {
            return report;
        }
        let unit = unit.map_or_else(String::new, |unit| format!(": {}", unit.text));
        let report = report.help(format!(
            "write `{word} {name}[{size}]{unit} = {text}{rest};`"
        ));
        Box::new(match (is_part, dimension) {
            (true, 1) if rest.is_empty() => report.help(format!(
                "or `{word} {name}{unit} = {text}[0];` for its first component"
            )),
            _ => report,
        })
    }

    fn output(&mut self, scope: usize, output: &ast::Output) -> Result<()> {
        let values = self.vector(scope, &output.value, output.dimension, &output.name);
        let values = values.map_err(|report| {
            let declared = ("output", &output.name, output.dimension);
            let value = (output.unit.as_ref(), &output.value, String::new());
            self.of_its_size(scope, declared, value, report)
        })?;
        self.claim_value(
            scope,
            &output.name,
            output.unit.as_ref(),
            &values,
            output.value.span(),
        );
        let unit = output.unit.as_ref().map_or("", |unit| unit.text.as_str());
        let path = self.path(scope, &output.name);
        let variables = component_names(&path, output.dimension, unit);
        let mut known = self.outputs.iter().map(|known| &known.variable.name);
        if known.any(|known| variables.iter().any(|variable| variable.name == *known)) {
            let message = format!("output `{}` is declared twice", output.name);
            return Err(Box::new(error(
                codes::DUPLICATE_NAME,
                output.name.span(),
                message,
            )));
        }
        let span = self.place(scope, output.name.span());
        self.outputs.extend(
            variables
                .into_iter()
                .zip(values)
                .map(|(variable, value)| Output {
                    variable,
                    value,
                    span,
                }),
        );
        Ok(())
    }

    /// Hands over.
    pub(super) fn finish(mut self, model: &ast::Model) -> Elaborated {
        let rings = self.rings();
        let moved = self.moved();
        Elaborated {
            documentation: model.documentation.clone(),
            visibility: model.visibility.clone(),
            name: model.name.clone(),
            graph: self.graph,
            parameters: self.parameters,
            inputs: self.inputs,
            outputs: self.outputs,
            states: self.states,
            attitudes: self.attitudes,
            signals: self.signals,
            assumptions: self.assumptions,
            rings,
            moving_inputs: self.moving_inputs,
            moved,
        }
    }
}

/// The one field that carries the law.
fn law_field(element: &ast::Element) -> Result<&ast::Field> {
    let words = law_words(element.kind);
    let mut laws = element
        .fields
        .iter()
        .filter(|field| words.iter().any(|word| field.name == word));
    let Some(first) = laws.next() else {
        let message = format!("`{}` has no law", element.name);
        let help = format!(
            "write `{:?} {} {{ {}: … }}`",
            element.kind, element.name, words[0]
        );
        return Err(Box::new(
            error(codes::MISSING_LAW, element.name.span(), message).help(help),
        ));
    };
    match laws.next() {
        None => Ok(first),
        Some(second) => {
            let message = format!(
                "`{}` has two laws, `{}` and `{}`",
                element.name, first.name, second.name
            );
            let report = error(codes::TWO_LAWS, second.name.span(), message);
            Err(Box::new(report.help(format!(
                "remove `{}` or `{}`",
                first.name, second.name
            ))))
        }
    }
}

/// The components by name, those of the library included, for the driver.
pub fn component_table(source: &ast::Source) -> BTreeMap<String, &ast::Component> {
    source
        .items
        .iter()
        .filter_map(|item| match item {
            ast::Item::Component(component) => Some(component),
            ast::Item::Model(_) => None,
        })
        .chain(&source.library)
        .map(|component| (component.name.to_string(), component))
        .collect()
}

/// `[3]`, or nothing, behind the name of a parameter.
fn size_text(size: Option<usize>) -> String {
    size.map_or_else(String::new, |size| format!("[{size}]"))
}

/// A parameter of a model without a default.
fn without_default(parameter: &ast::Parameter) -> Diagnostic {
    let (name, unit) = (&parameter.name, parameter.unit_text());
    let size = parameter.dimension;
    let value = match size {
        None => "1.0".to_owned(),
        Some(size) => dump::column(&syn::parse_quote!(1.0), size).unwrap_or("0.0".to_owned()),
    };
    let message = format!("parameter `{name}` has no value");
    let report = error(codes::MISSING_DEFAULT, name.span(), message);
    report.help(format!(
        "write `param {name}{}{unit} = {value};`",
        size_text(size)
    ))
}

/// A default that is not made of numbers, or is a vector of so many entries where a number is declared.
fn no_default(parameter: &ast::Parameter, expression: &syn::Expr, entries: usize) -> Diagnostic {
    let (name, unit) = (&parameter.name, parameter.unit_text());
    let size = parameter.dimension;
    let numbers = if size.is_some() {
        "numbers"
    } else {
        "a number"
    };
    let text = dump::expression(expression);
    let message = format!("expected {numbers} as the default of `{name}`, found `{text}`");
    let report = error(codes::EXPRESSION, expression.span(), message);
    if let Some(help) = elsewhere::without_units_behind(expression) {
        return report.help(help);
    }
    report.help(match size {
        None if entries > 1 => format!("write `param {name}[{entries}]{unit} = {text};`"),
        _ => format!(
            "write `let {name}{}{unit} = {text};` for what follows from other values",
            size_text(size)
        ),
    })
}
