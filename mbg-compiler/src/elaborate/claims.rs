//! What a text says of the units of values, for their checker.
//!
//! The laws themselves cannot be asked: `mass: 2.0` is a plain number by the time a law uses it. So the model is read a
//! second time, and a name with a declared unit stays a symbol of that unit, whatever its value, as does a number with a
//! decimal point. Each operator, each word of an element and each declared name becomes a [`Claim`] with its place.

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::{Ident, Span};
use syn::spanned::Spanned;

use super::Builder;
use super::expressions::{Result, Value};
use super::laws::Reader;
use super::model::Signals;
use super::own::Own;
use super::scope::GRAVITY;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::graph::{ElementId, JunctionId};
use crate::symbolic::{Expression, Factor, Matrix, Pool, Product, Symbol};
use crate::syntax::ast::{self, Unit};
use crate::units;

/// What a text says of units.
#[derive(Clone, Default)]
pub struct Claims {
    /// In order of reading: what an expression is made of stands before it.
    pub list: Vec<Claim>,
    /// Symbols with declared units.
    pub units: Vec<(Symbol, Unit, Site)>,
    /// The values that are hidden here, by number of `Symbol::Unknown`.
    pub hidden: Vec<Hidden>,
    /// Arguments of components without a unit of their own.
    pub arguments: Vec<Argument>,
    /// Efforts and flows that the entries read.
    pub signals: Signals,
}

/// A number that a component is given, of which the laws inside say the unit.
#[derive(Clone)]
pub struct Argument {
    /// The path of the parameter.
    pub path: String,
    /// The number.
    pub value: Expression,
    /// Where it is written.
    pub place: Site,
}

/// A value behind a symbol.
#[derive(Clone)]
pub struct Hidden {
    /// Its name, or the number itself.
    pub text: String,
    /// Whether it is a number without a name.
    pub number: bool,
}

impl Claims {
    /// A symbol for a value.
    pub(super) fn hide(&mut self, text: &str, number: bool) -> Symbol {
        self.hidden.push(Hidden {
            text: text.to_owned(),
            number,
        });
        Symbol::Unknown(self.hidden.len() - 1)
    }
}

impl Claim {
    /// Whether it belongs to what is said next.
    pub(crate) fn is_part(&self) -> bool {
        matches!(self.subject, Subject::Part | Subject::Argument(_))
    }
}

/// One thing that is said.
#[derive(Clone)]
pub struct Claim {
    /// What the entries stand for.
    pub subject: Subject,
    /// By rows.
    pub entries: Vec<Expression>,
    /// How many stand in a row.
    pub columns: usize,
    /// Where it is written.
    pub place: Site,
}

/// What entries stand for.
#[derive(Clone)]
pub enum Subject {
    /// The value of an operator or a function.
    Part,
    /// The argument of a function that takes a pure number, which its value does not show.
    Argument(&'static str),
    /// The value of a name with a declared unit.
    Declared(String, Unit),
    /// What stands after a word of an element.
    Word(ElementId, String),
    /// The rates of states.
    Rate(Range<usize>),
    /// States at the start.
    Start(Range<usize>),
    /// The flow of a junction at the start.
    Flow(JunctionId),
    /// An angular velocity.
    Turning,
    /// What a closure makes zero.
    Displacement(usize),
}

/// A place in the user's text.
#[derive(Clone)]
pub struct Site {
    /// The token.
    pub span: Span,
    /// The component of the library that it calls, when the place itself lies inside.
    pub library: Option<String>,
}

impl Site {
    /// Adds where the place is.
    #[must_use]
    pub fn locate(&self, report: Diagnostic) -> Diagnostic {
        match &self.library {
            Some(component) => report.inside(component, self.span),
            None => report,
        }
    }
}

/// The claims of a sound model.
#[must_use]
pub fn claims(
    model: &ast::Model,
    components: &BTreeMap<String, &ast::Component>,
    pool: &mut Pool,
) -> Claims {
    // The first reading has told all mistakes but those of units.
    let mut unheard = Diagnostics::new();
    let mut builder = Builder::new(model, components, pool, &mut unheard);
    builder.claims = Some(Claims::default());
    builder.declare_all(&model.statements);
    builder.resolve_laws();
    let signals = builder.signals;
    Claims {
        signals,
        ..builder.claims.unwrap_or_default()
    }
}

impl Builder<'_> {
    /// Remembers the unit of symbols.
    pub(super) fn claim_unit(
        &mut self,
        scope: usize,
        symbols: impl IntoIterator<Item = Symbol>,
        unit: Option<&Unit>,
    ) {
        let (Some(claims), Some(unit)) = (&mut self.claims, unit) else {
            return;
        };
        let place = self
            .scopes
            .place(scope, unit.span().unwrap_or_else(Span::call_site));
        let known = symbols
            .into_iter()
            .map(|symbol| (symbol, unit.clone(), place.clone()));
        claims.units.extend(known);
    }

    /// Remembers what is said of entries.
    pub(super) fn claim(
        &mut self,
        scope: usize,
        subject: Subject,
        entries: &[Expression],
        span: Span,
    ) {
        if let Some(claims) = &mut self.claims {
            claims.list.push(Claim {
                subject,
                entries: entries.to_vec(),
                columns: 1,
                place: self.scopes.place(scope, span),
            });
        }
    }

    /// Remembers the value of a name that may have a unit.
    pub(super) fn claim_value(
        &mut self,
        scope: usize,
        name: &Ident,
        unit: Option<&Unit>,
        entries: &[Expression],
        span: Span,
    ) {
        let subject = match unit {
            Some(unit) => Subject::Declared(name.to_string(), unit.clone()),
            None => Subject::Part,
        };
        self.claim(scope, subject, entries, span);
    }

    /// Remembers a definition; where it has a unit, its entries become symbols of that unit.
    pub(super) fn claim_definition(&mut self, definition: usize, value: Value) -> Value {
        let known = &self.definitions[definition];
        let unit = match known.unit {
            Some(unit) => unit.clone(),
            None if known.name == GRAVITY => units::acceleration(),
            None => {
                self.claim_argument(definition, &value);
                return value;
            }
        };
        let (scope, name, path, span) = (
            known.scope,
            known.name,
            known.path.clone(),
            known.value.span(),
        );
        let matrix = match (&self.claims, &value) {
            (None, _) => return value,
            (_, Value::Scalar(entry)) => Matrix::column(vec![*entry]),
            (_, Value::Matrix(product)) => product.to_matrix(self.pool),
        };
        self.claim_value(scope, name, Some(&unit), &matrix.entries, span);
        // A pure number may count or be an exponent, and says as much by its value.
        if units::is_pure(&unit) {
            return value;
        }
        let mut symbols: BTreeMap<Expression, Expression> = BTreeMap::new();
        let hidden = matrix.map(|entry| {
            let known = symbols.entry(entry.magnitude());
            let symbol = *known.or_insert_with(|| self.hide(scope, &path, &unit));
            symbol.flipped(entry.is_negative())
        });
        match value {
            Value::Scalar(_) => Value::Scalar(hidden.entries[0]),
            Value::Matrix(_) => Value::Matrix(Product::of(Factor::Dense(hidden))),
        }
    }

    /// Remembers a number that a component is given.
    fn claim_argument(&mut self, definition: usize, value: &Value) {
        let known = &self.definitions[definition];
        if let (Some(claims), Some(_), Value::Scalar(value)) =
            (&mut self.claims, known.parameter, value)
        {
            claims.arguments.push(Argument {
                path: known.path.clone(),
                value: *value,
                place: self.scopes.place(known.scope, known.value.span()),
            });
        }
    }

    /// A symbol of a unit for a value.
    fn hide(&mut self, scope: usize, path: &str, unit: &Unit) -> Expression {
        let symbol = match &mut self.claims {
            Some(claims) => claims.hide(path, false),
            None => Symbol::Time,
        };
        self.claim_unit(scope, [symbol], Some(unit));
        self.pool.symbol(symbol)
    }

    /// Remembers what stands after the words of an element.
    pub(super) fn claim_words(
        &mut self,
        scope: usize,
        element: &ast::Element,
        id: ElementId,
    ) -> Result<()> {
        let (states, dimension) = self.ports[id.0].clone();
        let own = Own {
            element: id,
            states,
            dimension,
            component: None,
        };
        let mut found = Vec::new();
        for field in &element.fields {
            let Some(value) = &field.value else {
                continue;
            };
            let (pool, mut lookup) = self.lookup(scope);
            let matrix = Reader {
                pool,
                lookup: &mut lookup,
                element,
                own: own.clone(),
            }
            .entries(&field.name.to_string(), value)?;
            found.push(Claim {
                subject: Subject::Word(id, field.name.to_string()),
                entries: matrix.entries,
                columns: matrix.columns,
                place: self.scopes.place(scope, value.span()),
            });
        }
        if let Some(claims) = &mut self.claims {
            claims.list.extend(found);
        }
        Ok(())
    }
}
