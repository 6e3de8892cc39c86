//! Stage 2, elaboration: the tree to a flat graph.
//!
//! Input: [`ast::Source`]. Output: one [`Elaborated`] per model: components are put in place, loops written out, names
//! resolved, laws evaluated into the pool. Afterwards all dimensions agree and every port has one bond. Errors: `MBG02xx`,
//! `MBG0601`.

mod advice;
mod assertions;
mod attitude;
mod beside;
mod blame;
mod bonds;
mod branches;
mod calls;
mod check;
pub mod claims;
mod conditions;
mod constants;
mod curves;
mod declare;
mod defaults;
mod definitions;
mod driven;
mod elsewhere;
mod energies;
pub mod expressions;
mod finish;
mod frames;
mod functions;
mod idle;
mod indices;
mod instances;
mod kinds;
mod laws;
mod laws_elsewhere;
mod loops;
mod mentions;
mod model;
mod moving;
mod orientation;
mod own;
mod parts_elsewhere;
mod quantities;
mod rays;
mod references;
mod rings;
mod scope;
mod size;
mod slopes;
mod spread;
mod tools;
mod turning;
mod turns;
mod unused;

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::{Ident, Span};
use syn::Expr;
use syn::ext::IdentExt;

pub use finish::component_table;
pub use model::{
    Assumption, Attitude, Condition, Elaborated, Output, Parameter, Place, Quantity, Signal,
    Signals, State, StateRate, Variable,
};
pub use rings::Ring;
pub use size::LIMIT;
pub use unused::warn;

use self::claims::Claims;
use self::constants::Constants;
use self::defaults::DefaultRead;
use self::definitions::{Definitions, Missing};
use self::expressions::Value;
use self::frames::{Frame, LeftOut, Unknown};
use self::mentions::mentioned;
use self::rings::Meeting;
use self::scope::{Entity, GRAVITY, Scope, Scopes};
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::displacements;
use crate::graph::{BondGraph, Causality, ElementId, JunctionId, Origins};
use crate::symbolic::{Expression, Pool};
use crate::syntax::ast::{self, Statement};
use crate::syntax::dump;

/// Elaborates one model; none if anything was reported.
#[must_use]
pub fn elaborate(
    model: &ast::Model,
    components: &BTreeMap<String, &ast::Component>,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Elaborated> {
    if !size::check(model, components, diagnostics) {
        return None;
    }
    let mut builder = Builder::new(model, components, pool, diagnostics);
    builder.declare_all(&model.statements);
    builder.read_defaults(&model.statements);
    builder.resolve_laws();
    builder.check(model.name.span());
    let calls = builder.calls;
    let sound = |diagnostics: &Diagnostics| diagnostics.calls() == calls;
    let mut elaborated = sound(builder.diagnostics).then(|| builder.finish(model))?;
    displacements::express(&mut elaborated, pool, diagnostics);
    sound(diagnostics).then_some(elaborated)
}

/// A law or value that is read once all names are known.
#[derive(Clone)]
enum Pending<'a> {
    Law {
        scope: usize,
        element: &'a ast::Element,
        id: ElementId,
    },
    Gyroscopic {
        scope: usize,
        storage: ElementId,
        id: ElementId,
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
    Coordinate {
        scope: usize,
        junction: &'a ast::Junction,
        value: &'a Expr,
        id: JunctionId,
    },
    Output {
        scope: usize,
        output: &'a ast::Output,
    },
    Displacement {
        scope: usize,
        closure: &'a ast::Closure,
        number: usize,
    },
    Assertion {
        scope: usize,
        assertion: &'a ast::Assertion,
    },
}

impl Pending<'_> {
    fn scope(&self) -> usize {
        match self {
            Self::Law { scope, .. }
            | Self::Gyroscopic { scope, .. }
            | Self::Integral { scope, .. }
            | Self::Attitude { scope, .. }
            | Self::Coordinate { scope, .. }
            | Self::Output { scope, .. }
            | Self::Displacement { scope, .. }
            | Self::Assertion { scope, .. } => *scope,
        }
    }

    /// What is read for it.
    fn expressions(&self) -> Vec<&Expr> {
        match self {
            Self::Law { element, .. } => element.values().collect(),
            Self::Gyroscopic { .. } => Vec::new(),
            Self::Integral { integral, .. } => {
                let initial = integral.initial.as_ref();
                initial.into_iter().chain([&integral.rate]).collect()
            }
            Self::Attitude { attitude, .. } => {
                let initial = attitude.initial.as_ref();
                initial
                    .into_iter()
                    .chain([&attitude.angular_velocity])
                    .collect()
            }
            Self::Coordinate { value, .. } => vec![value],
            Self::Output { output, .. } => vec![&output.value],
            Self::Displacement { closure, .. } => closure.displacement.iter().collect(),
            Self::Assertion { assertion, .. } => vec![&assertion.condition],
        }
    }
}

/// The graph while it is being built.
struct Builder<'a> {
    components: &'a BTreeMap<String, &'a ast::Component>,
    pool: &'a mut Pool,
    diagnostics: &'a mut Diagnostics,
    /// How many mistakes were reported before this model's.
    before: usize,
    /// The same, with those that told what was told already.
    calls: usize,
    scopes: Scopes,
    definitions: Definitions<'a>,
    /// What the law just read could not be read without.
    missing: Option<Missing>,
    graph: BondGraph,
    /// States and dimension by element.
    ports: Vec<(Range<usize>, usize)>,
    /// Elements as they are written, with their scopes.
    written: BTreeMap<ElementId, (usize, &'a ast::Element)>,
    states: Vec<State>,
    attitudes: Vec<Attitude>,
    parameters: Vec<Parameter>,
    inputs: Vec<Variable>,
    outputs: Vec<Output>,
    signals: Signals,
    /// Ports of components in use by their scopes.
    frames: BTreeMap<usize, Vec<Frame<'a>>>,
    /// Components in use by their scopes, with the scopes that use them.
    called: BTreeMap<usize, (usize, &'a ast::Instance)>,
    left_out: Vec<LeftOut<'a>>,
    /// Whether a component is called wrongly, so that it is not known what it tells of frames.
    is_misled: bool,
    /// Parameters that must be given where they are needed.
    unknown: BTreeMap<usize, Unknown<'a>>,
    /// Where two ways lead to one frame.
    meetings: Vec<Meeting>,
    /// What is told of geometry that inputs move, by input.
    moving_inputs: BTreeMap<usize, Diagnostic>,
    assumptions: Vec<Assumption>,
    pending: Vec<Pending<'a>>,
    integrals: Vec<(usize, &'a Statement)>,
    /// What the checker of units is told, while it is asked for.
    claims: Option<Claims>,
    /// Parameters at their defaults that are read from outside.
    defaults: Vec<DefaultRead<'a>>,
}

impl<'a> Builder<'a> {
    fn new(
        model: &ast::Model,
        components: &'a BTreeMap<String, &'a ast::Component>,
        pool: &'a mut Pool,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        // Without the statement nothing falls, in any number of dimensions.
        let weightless = Entity::Value(Value::Scalar(Expression::ZERO));
        let root = Scope {
            derivative: model.derivative.is_some(),
            constants: Constants::of_model(&model.statements),
            names: BTreeMap::from([(GRAVITY.to_owned(), weightless)]),
            ..Scope::default()
        };
        Self {
            components,
            pool,
            before: diagnostics.list().len(),
            calls: diagnostics.calls(),
            diagnostics,
            scopes: Scopes(vec![root]),
            definitions: Vec::new(),
            missing: None,
            graph: BondGraph {
                junctions: Vec::new(),
                elements: Vec::new(),
                bonds: Vec::new(),
                causality: Causality::Uniform,
                closures: Vec::new(),
                origins: Origins::default(),
            },
            ports: Vec::new(),
            written: BTreeMap::new(),
            states: Vec::new(),
            attitudes: Vec::new(),
            parameters: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            signals: Signals::default(),
            frames: BTreeMap::new(),
            called: BTreeMap::new(),
            left_out: Vec::new(),
            is_misled: false,
            unknown: BTreeMap::new(),
            meetings: Vec::new(),
            moving_inputs: BTreeMap::new(),
            assumptions: Vec::new(),
            pending: Vec::new(),
            integrals: Vec::new(),
            claims: None,
            defaults: Vec::new(),
        }
    }

    /// Declares everything in the model, so that all names are known.
    fn declare_all(&mut self, statements: &'a [Statement]) {
        self.declare(0, statements);
        self.declare_integrals();
        self.hand_on();
    }

    /// Declares everything in a scope: first what may be referred to from anywhere, then the rest in order.
    fn declare(&mut self, scope: usize, statements: &'a [Statement]) {
        self.declare_names(scope, statements);
        self.connect(scope, statements);
    }

    fn connect(&mut self, scope: usize, statements: &'a [Statement]) {
        let mut loops = std::mem::take(&mut self.scopes[scope].loops).into_iter();
        let chosen = self.scopes[scope].constants.chosen(statements);
        let instances = chosen.iter().rev().filter_map(|it| match it {
            Statement::Instance(instance) => Some(instance.name.to_string()),
            _ => None,
        });
        self.scopes[scope].later = instances.collect();
        for statement in chosen {
            match statement {
                Statement::Junction(junction) => self.fill_junction(scope, junction),
                Statement::Chain(chain) => self.chain(scope, chain),
                Statement::Closure(closure) => self.closure(scope, closure),
                Statement::Assertion(assertion) => {
                    self.pending.push(Pending::Assertion { scope, assertion });
                }
                Statement::Instance(instance) => {
                    self.scopes[scope].later.pop();
                    self.instance(scope, instance);
                }
                Statement::Loop(repeated) => {
                    let (_, iterations) = loops.next().unwrap_or_default();
                    for iteration in iterations {
                        self.connect(iteration, &repeated.statements);
                    }
                }
                Statement::Integral(_) | Statement::Attitude(_) => {
                    self.integrals.push((scope, statement))
                }
                Statement::Output(output) => {
                    if let Some(value) = as_value(output) {
                        let outputs = &mut self.scopes[scope].outputs;
                        outputs.insert(output.name.to_string(), value);
                    }
                    self.pending.push(Pending::Output { scope, output });
                }
                _ => {}
            }
        }
    }

    fn path(&self, scope: usize, name: &Ident) -> String {
        format!("{}{}", self.scopes[scope].prefix, name.unraw())
    }

    /// Gives a name its meaning; a second meaning is an error.
    fn name(&mut self, scope: usize, name: &Ident, entity: Entity) {
        if name == GRAVITY {
            let message = "`gravity` is the acceleration of free fall and names nothing else";
            let report = error(codes::DUPLICATE_NAME, name.span(), message);
            return self.tell(
                scope,
                report.help("`gravity [0.0, 0.0, -9.81];` gives it its value"),
            );
        }
        if name == "t" && entity.is_value() {
            let message = "`t` is time, and no other value is called so";
            let report = error(codes::DUPLICATE_NAME, name.span(), message);
            self.tell(scope, report.help("give it a longer name"));
        }
        let is_element = matches!(entity, Entity::Element(_));
        let names = &mut self.scopes[scope].names;
        if let Some(known) = names.insert(name.to_string(), entity) {
            let is_value = known.is_value();
            // Which of them is meant elsewhere is not known.
            names.insert(name.to_string(), Entity::Opaque);
            let message = format!("`{name}` is declared twice");
            let mut report = error(codes::DUPLICATE_NAME, name.span(), message);
            if is_element && is_value {
                report = report.help(format!(
                    "an element and a value have different names: call the element something else, such as `{name}_`"
                ));
            } else if is_element {
                report = report.note("elements of different junctions have different names, too");
            }
            self.tell(scope, report);
        }
    }

    /// Reports a mistake: one inside a component of the library at the instance, which is what the user wrote, and none
    /// inside a component that is called wrongly.
    fn tell(&mut self, scope: usize, mut report: Diagnostic) {
        if self.scopes[scope].is_broken {
            return;
        }
        if let Some((component, instance)) = &self.scopes[scope].library {
            report = report.inside(component, *instance);
        }
        // Each iteration of a loop makes the same mistake.
        self.diagnostics.report_once(report, self.before);
    }

    /// Where something in a scope stands in the user's text.
    fn place(&self, scope: usize, span: Span) -> Span {
        let library = self.scopes[scope].library.as_ref();
        library.map_or(span, |(_, instance)| *instance)
    }
}

/// What declares the value of an output for laws as well, and that value; none of one that reads its own name.
fn as_value(output: &ast::Output) -> Option<[String; 2]> {
    let paths = mentioned(&output.value);
    if paths.iter().any(|path| path[0].name == output.name) {
        return None;
    }
    let size = match output.dimension {
        1 => String::new(),
        size => format!("[{size}]"),
    };
    let unit = output.unit.as_ref();
    let unit = unit.map_or_else(String::new, |unit| format!(": {}", unit.text));
    let (name, value) = (&output.name, dump::expression(&output.value));
    Some([format!("let {name}{size}{unit} = {value};"), value])
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
