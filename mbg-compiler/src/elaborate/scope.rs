//! Names: which word stands for what, at which level of composition.

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::{Ident, Span};
use syn::Expr;

use super::claims::{Claim, Claims, Site, Subject};
use super::constants::Constants;
use super::defaults::DefaultRead;
use super::definitions::{Definitions, Missing, Progress};
use super::expressions::{Names, Result, Step, Value, fail};
use super::model::{Assumption, Parameter, Place, Quantity, Signals};
use super::own::{OWN, Own, OwnPath, compared};
use super::turns::Turns;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{BondGraph, ElementId, ElementKind, JunctionId, JunctionKind};
use crate::symbolic::{Expression, Factor, Matrix, Pool, Product, Rate, Symbol};
use crate::syntax::words::is_two_port;

/// The acceleration of free fall: a name of the model that every component sees.
pub(super) const GRAVITY: &str = "gravity";

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum Entity {
    /// A value.
    Value(Value),
    /// A value that is worked out when it is first needed.
    Definition(usize),
    /// Inputs by number.
    Input(Range<usize>),
    /// Components of a junction.
    Junction(JunctionId, Range<usize>),
    /// An element.
    Element(ElementId),
    /// States of an integral, or of a quaternion.
    States(Range<usize>),
    /// States of a rotation matrix, by rows.
    Rotation(Range<usize>),
    /// A component in use: its scope.
    Instance(usize),
    /// A loop with a label: the first value of its variable, and the scopes of its iterations.
    Loop(i64, Vec<usize>),
    /// A parameter whose value is a word.
    Choice,
    /// Declared, but broken or without a value.
    Opaque,
}

impl Entity {
    /// Whether it has a value.
    pub(super) fn is_value(&self) -> bool {
        matches!(
            self,
            Self::Value(_)
                | Self::Definition(_)
                | Self::Input(_)
                | Self::States(_)
                | Self::Rotation(_)
        )
    }
}

/// The names of a model, of one component in use, or of one iteration of a loop.
#[derive(Debug, Default)]
pub(super) struct Scope {
    /// `arm.` inside the instance `arm`.
    pub(super) prefix: String,
    /// Whether `#[derivative]` covers everything inside.
    pub(super) derivative: bool,
    /// Whether it is a component that is called wrongly, or inside one: what goes wrong there follows from that.
    pub(super) is_broken: bool,
    /// The scope whose names an iteration of a loop sees as well.
    pub(super) around: Option<usize>,
    /// Inside a component of the library: its name, and the instance in the user's text.
    pub(super) library: Option<(String, Span)>,
    /// Names that stand for whole numbers.
    pub(super) constants: Constants,
    /// Names.
    pub(super) names: BTreeMap<String, Entity>,
    /// Outputs, which no law reads, by name: what declares a value for laws, and the value itself.
    pub(super) outputs: BTreeMap<String, [String; 2]>,
    /// In an iteration of a loop: its variable.
    pub(super) variable: Option<String>,
    /// Components that are used further down, of which nothing is known yet.
    pub(super) later: Vec<String>,
    /// Loops, for what is said of names inside them.
    pub(super) turns: Vec<Turns>,
    /// Loops in order of declaration: their paths, and the scopes of their iterations.
    pub(super) loops: Vec<(String, Vec<usize>)>,
}

/// All scopes of a model; the first is its own.
#[derive(Debug, Default)]
pub(super) struct Scopes(pub(super) Vec<Scope>);

impl std::ops::Index<usize> for Scopes {
    type Output = Scope;

    fn index(&self, scope: usize) -> &Scope {
        &self.0[scope]
    }
}

impl std::ops::IndexMut<usize> for Scopes {
    fn index_mut(&mut self, scope: usize) -> &mut Scope {
        &mut self.0[scope]
    }
}

impl Scopes {
    /// What to do about a path into a component that is used further down.
    pub(super) fn later(&self, scope: usize, path: &[Step]) -> Option<String> {
        let [first, _, ..] = path else { return None };
        let name = first.name.to_string();
        let is_later = |scope: usize| self[scope].later.contains(&name);
        let help = || {
            format!(
                "`{name}` stands further down: write this behind it, where its junctions are known"
            )
        };
        self.seen_from(scope).any(is_later).then(help)
    }

    /// Adds a scope.
    pub(super) fn add(&mut self, scope: Scope) -> usize {
        self.0.push(scope);
        self.0.len() - 1
    }

    /// What a plain name stands for in a scope.
    pub(super) fn find(&self, scope: usize, name: &str) -> Option<&Entity> {
        if name == GRAVITY {
            return self.0[0].names.get(name);
        }
        let mut current = Some(scope);
        while let Some(scope) = current {
            if let Some(entity) = self.0[scope].names.get(name) {
                return Some(entity);
            }
            current = self.0[scope].around;
        }
        None
    }

    /// What laws may read in place of an output of this name, if a scope sees one.
    pub(super) fn output(&self, scope: usize, name: &str) -> Option<&[String; 2]> {
        let around = |scope: &usize| self.0[*scope].around;
        let mut seen = std::iter::successors(Some(scope), around);
        seen.find_map(|scope| self.0[scope].outputs.get(name))
    }

    /// Where something in a scope stands in the user's text, and in which component of the library if in one.
    pub(super) fn place(&self, scope: usize, span: Span) -> Site {
        match &self.0[scope].library {
            Some((component, instance)) => Site {
                span: *instance,
                library: Some(component.clone()),
            },
            None => Site {
                span,
                library: None,
            },
        }
    }

    /// Every plain name that a scope sees.
    pub(super) fn visible(&self, scope: usize) -> Vec<&str> {
        let mut names = Vec::new();
        let mut current = Some(scope);
        while let Some(scope) = current {
            names.extend(self.0[scope].names.keys().map(String::as_str));
            current = self.0[scope].around;
        }
        names
    }

    /// Follows instances and iterations as far as the path leads through them: what is found there, and the number of
    /// steps that led to it. A selection on the last of these steps is left to the caller.
    pub(super) fn follow(&self, scope: usize, path: &[Step]) -> Result<Option<(&Entity, usize)>> {
        let Some(mut entity) = path
            .first()
            .and_then(|step| self.find(scope, &step.name.to_string()))
        else {
            return Ok(None);
        };
        for (position, pair) in path.windows(2).enumerate() {
            let inner = match (entity, &pair[0].index) {
                (Entity::Instance(inner), None) => *inner,
                (Entity::Loop(start, scopes), _) => {
                    self.iteration(scope, [&pair[0], &pair[1]], *start, scopes)?
                }
                _ => return Ok(Some((entity, position + 1))),
            };
            let Some(next) = self.0[inner].names.get(&pair[1].name.to_string()) else {
                return Ok(None);
            };
            entity = next;
        }
        Ok(Some((entity, path.len())))
    }
}

/// Names as one law sees them.
pub(super) struct Lookup<'a, 'm> {
    pub(super) scopes: &'a Scopes,
    pub(super) scope: usize,
    pub(super) graph: &'a BondGraph,
    /// States and dimension of one-ports by element.
    pub(super) ports: &'a [(Range<usize>, usize)],
    pub(super) definitions: &'a Definitions<'m>,
    /// Set where the law cannot be read, at least not yet.
    pub(super) missing: &'a mut Option<Missing>,
    pub(super) signals: &'a mut Signals,
    pub(super) own: Option<Own>,
    /// What the checker of units is told, while it is asked for.
    pub(super) claims: Option<&'a mut Claims>,
    /// Parameters at their defaults that are read from outside.
    pub(super) defaults: &'a mut Vec<DefaultRead<'m>>,
    /// What `new` checks of parameters.
    pub(super) assumptions: &'a mut Vec<Assumption>,
    /// Parameters of the model.
    pub(super) parameters: &'a [Parameter],
}

impl Names for Lookup<'_, '_> {
    fn value(&mut self, pool: &mut Pool, path: &[Step]) -> Option<Result<Value>> {
        if let [Step { name, index: None }] = path {
            // An element may bear the name of time, since it has no value that could be meant.
            if name == "t" && !self.is_value("t") {
                return Some(Ok(Value::Scalar(pool.symbol(Symbol::Time))));
            }
        }
        match self.own_path(path) {
            Some(OwnPath::Whole) => return Some(self.own_value(pool, &path[0].name)),
            Some(OwnPath::Component) => return None,
            Some(OwnPath::Behind(index)) => return Some(self.behind_own(path, index)),
            None => {}
        }
        let (entity, steps) = match self.scopes.follow(self.scope, path) {
            Ok(found) => found?,
            Err(report) => return Some(Err(report)),
        };
        let (last, rest) = (&path[steps - 1], &path[steps..]);
        if matches!(entity, Entity::Opaque) {
            *self.missing = Some(Missing::Broken);
            return Some(fail(last.name.span(), "this is broken"));
        }
        // Whatever has an index here is no loop.
        if path[steps - 1..].iter().any(|step| step.index.is_some()) {
            return None;
        }
        match (entity, rest) {
            (Entity::Element(id), [variable]) => self.element_variable(pool, *id, &variable.name),
            (Entity::Junction(id, range), [variable]) => {
                self.junction_variable(pool, *id, range.clone(), &variable.name)
            }
            (Entity::Junction(id, _), []) => {
                let (text, kind) = (written(path), self.graph.junctions[id.0].kind);
                let variable = match kind {
                    JunctionKind::Zero => "e",
                    JunctionKind::One => "f",
                };
                let digit = kind.digit();
                let message = format!("`{text}` is a {digit}-junction; write `{text}.{variable}`");
                Some(fail(last.name.span(), message))
            }
            (Entity::Instance(inner), []) => Some(self.no_value_of(*inner, path)),
            (entity, []) => {
                if let Entity::Definition(id) = entity {
                    self.note_default(path, *id);
                }
                Some(self.plain(pool, entity, &last.name))
            }
            _ => None,
        }
    }

    fn whole(&self, expression: &Expr) -> Result<i64> {
        self.scopes[self.scope].constants.evaluate(expression)
    }

    fn decide(&self, condition: &Expr) -> Result<bool> {
        for compared in compared(condition) {
            self.check_meanings(compared)?;
        }
        self.scopes[self.scope].constants.decide(condition)
    }

    fn all(&self) -> Vec<&str> {
        self.scopes.visible(self.scope)
    }

    fn advice(&mut self, pool: &mut Pool, path: &[Step]) -> Option<String> {
        self.advice_on(pool, path)
    }

    fn is_own(&self, name: &Ident) -> bool {
        self.own.is_some() && OWN.iter().any(|own| name == own)
    }

    fn is_by_component(&self) -> bool {
        let own = self.own.as_ref();
        own.is_some_and(|own| own.component.is_some() && own.dimension > 1)
    }

    fn assume(&mut self, pool: &Pool, assumption: Assumption) -> bool {
        let is_known = pool.rate(assumption.expression) == Rate::Parameter;
        if is_known && !self.assumptions.contains(&assumption) {
            self.assumptions.push(assumption);
        }
        is_known
    }

    fn reads_units(&self) -> bool {
        self.claims.is_some()
    }

    fn seen(&mut self, pool: &mut Pool, place: Span, value: &Value) {
        let Some(claims) = &mut self.claims else {
            return;
        };
        // A product of matrices is looked at where it meets a vector or a law.
        let Some(entries) = value.entries(pool) else {
            return;
        };
        claims.list.push(Claim {
            subject: Subject::Part,
            entries,
            columns: 1,
            place: self.scopes.place(self.scope, place),
        });
    }

    fn takes_pure(&mut self, place: Span, function: &'static str, argument: Expression) {
        if let Some(claims) = &mut self.claims {
            claims.list.push(Claim {
                subject: Subject::Argument(function),
                entries: vec![argument],
                columns: 1,
                place: self.scopes.place(self.scope, place),
            });
        }
    }

    fn measured(&mut self, pool: &mut Pool, value: Expression, text: &str) -> Expression {
        match &mut self.claims {
            Some(claims) => pool.symbol(claims.hide(text, true)),
            None => value,
        }
    }
}

/// A path as it is written.
fn written(path: &[Step]) -> String {
    let step = |Step { name, index }: &Step| match index {
        Some(index) => format!("{name}[{}]", index.number),
        None => name.to_string(),
    };
    path.iter().map(step).collect::<Vec<_>>().join(".")
}

/// Why `e` and `f` of a two-port mean nothing.
pub(super) const TWO_PORT_VARIABLE: &str =
    "a two-port has two efforts and two flows; read them at a junction";

impl Lookup<'_, '_> {
    /// The value of what one name stands for.
    pub(super) fn plain(
        &mut self,
        pool: &mut Pool,
        entity: &Entity,
        name: &Ident,
    ) -> Result<Value> {
        match entity {
            Entity::Value(value) => Ok(value.clone()),
            Entity::Definition(id) => match &self.definitions[*id].progress {
                Progress::Known(value) => Ok(value.clone()),
                _ => {
                    *self.missing = Some(Missing::Definition(*id));
                    fail(name.span(), format!("`{name}` has no value here"))
                }
            },
            Entity::Input(range) => Ok(symbols(pool, range.clone().map(Symbol::Input))),
            Entity::States(range) => Ok(symbols(pool, range.clone().map(Symbol::State))),
            Entity::Choice => fail(
                name.span(),
                format!("`{name}` is a word and no number; ask `if {name} == …`"),
            ),
            Entity::Rotation(range) => {
                let entries = range.clone().map(|state| pool.symbol(Symbol::State(state)));
                let matrix = Matrix::new(3, 3, entries.collect());
                Ok(Value::Matrix(Product::of(Factor::Dense(matrix))))
            }
            Entity::Loop(start, _) => fail(
                name.span(),
                format!(
                    "`{name}` is a loop; read what is inside an iteration, `{name}[{start}].…`"
                ),
            ),
            Entity::Element(id) => Err(self.is_element(*id, name)),
            _ => fail(name.span(), format!("`{name}` has no value here")),
        }
    }

    /// What to write where an element stands in the place of a value.
    fn is_element(&self, id: ElementId, name: &Ident) -> Box<Diagnostic> {
        let (known, coefficient) = match self.graph.elements[id.0].kind {
            ElementKind::I => (format!("write `{name}.p`, `.e` or `.f`"), Some("inertia")),
            ElementKind::C => (format!("write `{name}.q`, `.e` or `.f`"), Some("stiffness")),
            ElementKind::R => (format!("write `{name}.e` or `.f`"), Some("resistance")),
            kind if is_two_port(kind) => (TWO_PORT_VARIABLE.to_owned(), None),
            _ => (format!("write `{name}.e` or `.f`"), None),
        };
        let message = format!("`{name}` is an element; {known}");
        let report = error(codes::EXPRESSION, name.span(), message);
        let help = coefficient.map(|word| {
            format!(
                "for its {word} give that a name: `param {name}_{word} = …;` and `{word}: {name}_{word}`"
            )
        });
        Box::new(help.into_iter().fold(report, Diagnostic::help))
    }

    /// Whether a name is declared as something with a value.
    pub(super) fn is_value(&self, name: &str) -> bool {
        let entity = self.scopes.find(self.scope, name);
        entity.is_some_and(Entity::is_value)
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

    /// What differs from bond to bond of a junction.
    fn not_common<T>(
        &self,
        id: JunctionId,
        name: &Ident,
        junction: &str,
        variable: &str,
    ) -> Result<T> {
        let message = format!("{junction} has no common {variable}; read it at an element");
        let report = error(codes::EXPRESSION, name.span(), message);
        let help = self.of_elements(id, name);
        Err(Box::new(help.into_iter().fold(report, Diagnostic::help)))
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
            ("e", JunctionKind::One) => Some(self.not_common(id, name, "a 1-junction", "effort")),
            ("f", JunctionKind::Zero) => Some(self.not_common(id, name, "a 0-junction", "flow")),
            (_, kind) => {
                let known = match kind {
                    JunctionKind::Zero => "`e`",
                    JunctionKind::One => "`f`",
                };
                Some(no_variable(&self.graph.junctions[id.0].name, name, known))
            }
        }
    }

    pub(super) fn signals(
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

pub(super) fn states(pool: &mut Pool, range: &Range<usize>, components: Range<usize>) -> Value {
    symbols(
        pool,
        components.map(|component| Symbol::State(range.start + component)),
    )
}

fn symbols(pool: &mut Pool, symbols: impl Iterator<Item = Symbol>) -> Value {
    let entries: Vec<Expression> = symbols.map(|symbol| pool.symbol(symbol)).collect();
    Value::column(entries)
}
