//! Named values: `let`s, the arguments of instances and gravity.
//!
//! Each is worked out when it is first needed, so that the order of declaration does not matter. What a value needs is
//! worked out before it, from a list rather than by recursion: chains of bodies refer to each other link by link, and
//! the stack must not grow with them.

use proc_macro2::Ident;
use syn::Expr;

use super::Builder;
use super::blame::unit_vector;
use super::elsewhere;
use super::expressions::{Result, Value};
use super::frames::IN_SPACE;
use super::scope::{Entity, GRAVITY};
use super::tools;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::Expression;
use crate::syntax::ast::{Parameter, Unit};
use crate::syntax::dump;

/// Why a range has one component less than was meant.
pub(super) const END_EXCLUDED: &str = "the end of a range is excluded: ";

/// A named value.
pub(super) struct Definition<'a> {
    /// Where the names in its expression get their meaning.
    pub(super) scope: usize,
    /// Its name, where it is given.
    pub(super) name: &'a Ident,
    /// Its path.
    pub(super) path: String,
    /// Dimension, when declared.
    pub(super) dimension: Option<usize>,
    /// Unit, when declared.
    pub(super) unit: Option<&'a Unit>,
    /// What it stands for.
    pub(super) value: &'a Expr,
    /// The parameter whose argument or default it is.
    pub(super) parameter: Option<&'a Parameter>,
    /// The definition that another component tells in place of a default.
    pub(super) told: Option<usize>,
    /// How far it is.
    pub(super) progress: Progress,
}

/// How far a definition is.
pub(super) enum Progress {
    /// Nothing has needed it yet.
    Unread,
    /// Worked out.
    Known(Value),
    /// It has no value, which has been told.
    Failed,
}

/// Why an expression has no value yet.
#[derive(Clone, Copy, Debug)]
pub(super) enum Missing {
    /// It needs a definition that has not been read.
    Definition(usize),
    /// It needs something that is broken, which has been told.
    Broken,
}

/// All of them by number.
pub(super) type Definitions<'a> = Vec<Definition<'a>>;

impl<'a> Builder<'a> {
    /// A value called `name` in a scope, whose expression has its names from the scope given with it.
    pub(super) fn definition(
        &mut self,
        scope: usize,
        name: &'a Ident,
        (dimension, unit): (Option<usize>, Option<&'a Unit>),
        (names, value): (usize, &'a Expr),
    ) -> Entity {
        self.definitions.push(Definition {
            scope: names,
            name,
            path: self.path(scope, name),
            dimension,
            unit,
            value,
            parameter: None,
            told: None,
            progress: Progress::Unread,
        });
        Entity::Definition(self.definitions.len() - 1)
    }

    /// Tries again and again to read some expressions, each time with one more definition known, until it works or fails
    /// for its own reason.
    pub(super) fn settle(
        &mut self,
        scope: usize,
        read: &[&Expr],
        mut attempt: impl FnMut(&mut Self) -> Result<()>,
    ) {
        loop {
            let result = attempt(self);
            match self.missing.take() {
                Some(Missing::Definition(missing)) if self.define(missing) => {}
                // The reason has been told where it lies.
                Some(_) => return,
                None => {
                    if let Err(report) = result {
                        self.tell_of(scope, *report, read);
                    }
                    return;
                }
            }
        }
    }

    /// Works out a definition and all that it needs; false if it has no value.
    pub(super) fn define(&mut self, wanted: usize) -> bool {
        let mut open = vec![wanted];
        while let Some(&current) = open.last() {
            match self.definitions[current].progress {
                Progress::Known(_) => {
                    open.pop();
                    continue;
                }
                Progress::Failed => break,
                Progress::Unread => {}
            }
            let result = self.read(current);
            match (self.missing.take(), result) {
                (Some(Missing::Definition(needed)), _) if open.contains(&needed) => {
                    self.report_cycle(&open, needed);
                    break;
                }
                (Some(Missing::Definition(needed)), _) => open.push(needed),
                (Some(Missing::Broken), _) => break,
                (None, Ok(value)) => self.definitions[current].progress = Progress::Known(value),
                (None, Err(report)) => {
                    let Definition {
                        scope, value, told, ..
                    } = self.definitions[current];
                    let own: &[&Expr] = if told.is_none() { &[value] } else { &[] };
                    self.tell_of(scope, *report, own);
                    break;
                }
            }
        }
        for failed in &open {
            self.definitions[*failed].progress = Progress::Failed;
        }
        open.is_empty()
    }

    /// Reports mistakes in what the user has defined and nothing needs.
    pub(super) fn define_unread(&mut self) {
        // A value that nothing needs must not make anything measure an effort or a flow.
        let signals = self.signals.clone();
        for definition in 0..self.definitions.len() {
            let names = self.definitions[definition].scope;
            // What a frame is asked for is asked where it is needed.
            let is_own = self.definitions[definition].told.is_none()
                && !self.unknown.contains_key(&definition);
            if is_own && self.scopes[names].library.is_none() {
                self.define(definition);
            }
        }
        self.signals = signals;
    }

    fn read(&mut self, definition: usize) -> Result<Value> {
        let Definition {
            scope,
            name,
            dimension,
            value: expression,
            told,
            ..
        } = self.definitions[definition];
        self.check_known(definition)?;
        let value = match told {
            Some(told) => self.value_of(scope, told, name)?,
            None => self
                .evaluate(scope, expression)
                .map_err(|report| of_axis(report, (name, dimension), expression))?,
        };
        let value = match dimension {
            None => value,
            Some(size) => {
                let column = match told {
                    Some(_) => self.column(value, size, name),
                    None => self.column_of(value, size, name, expression),
                };
                column.map_err(|report| match told {
                    Some(told) => Box::new(report.note(format!(
                        "it is what `{}` tells",
                        self.definitions[told].path
                    ))),
                    None => report,
                })?
            }
        };
        Ok(self.claim_definition(definition, value))
    }

    /// A value as a vector of some size, called `name`. Nothing has the same components along all axes, but for zero.
    fn column(&mut self, value: Value, size: usize, name: &Ident) -> Result<Value> {
        Ok(Value::column(match value {
            Value::Scalar(number) if number == Expression::ZERO => vec![number; size],
            _ => self.entries(&value, size, name)?,
        }))
    }

    /// The same of the value of an expression, with what to type where that has another shape.
    pub(super) fn column_of(
        &mut self,
        value: Value,
        size: usize,
        name: &Ident,
        expression: &Expr,
    ) -> Result<Value> {
        let is_number = matches!(value, Value::Scalar(_));
        let is_quaternion = value.is_vector_of(4) && size == 3 && tools::is_of_angles(name);
        let along = unit_vector(&name.to_string(), expression);
        let along = along.filter(|_| is_number && size == IN_SPACE / 2);
        let column = self.column(value, size, name);
        column.map_err(|report| match is_number {
            _ if along.is_some() => Box::new(along.into_iter().fold(*report, Diagnostic::help)),
            _ if is_gravity(expression) => about_gravity(report, size),
            _ if is_quaternion => Box::new(report.help(tools::as_angles(name, expression))),
            true if tools::is_way(name) && size == IN_SPACE / 2 => {
                Box::new(report.help(tools::along_an_axis(expression)))
            }
            true => by_component(report, expression, size),
            false => of_entries(report, expression, size),
        })
    }

    fn report_cycle(&mut self, open: &[usize], needed: usize) {
        let path = |definition: &usize| format!("`{}`", self.definitions[*definition].path);
        let cycle = open.iter().skip_while(|definition| **definition != needed);
        let through: Vec<String> = cycle.chain([&needed]).map(path).collect();
        let Definition { scope, name, .. } = self.definitions[needed];
        let message = format!("{} is defined by itself", path(&needed));
        let report = error(codes::CYCLE, name.span(), message);
        self.tell(
            scope,
            report.note(format!("each needs the next: {}", through.join(", "))),
        );
    }
}

/// What to type where the letter of an axis, which is no name, stands for a vector.
fn of_axis(
    report: Box<Diagnostic>,
    (name, dimension): (&Ident, Option<usize>),
    expression: &Expr,
) -> Box<Diagnostic> {
    let is_letter = report.code == codes::UNKNOWN_NAME && dimension == Some(IN_SPACE / 2);
    match unit_vector(&name.to_string(), expression).filter(|_| is_letter) {
        Some(help) => Box::new(report.help(help)),
        None => report,
    }
}

fn is_gravity(expression: &Expr) -> bool {
    matches!(expression, Expr::Path(path) if path.path.is_ident(GRAVITY))
}

/// What to type where gravity itself has the wrong dimension.
fn about_gravity(report: Box<Diagnostic>, dimension: usize) -> Box<Diagnostic> {
    if !(2..=3).contains(&dimension) {
        return report;
    }
    let level = "0.0, ".repeat(dimension - 1);
    Box::new(report.help(format!("write `gravity [{level}-9.81];` in the model")))
}

/// What to type where a number stands for a vector.
pub(super) fn by_component(
    report: Box<Diagnostic>,
    number: &Expr,
    dimension: usize,
) -> Box<Diagnostic> {
    if let Some(help) = longer_range(number, dimension) {
        return Box::new(report.help(help));
    }
    match dump::column(elsewhere::bare(number), dimension) {
        Some(all) => Box::new(report.help(format!("write each component, such as `{all}`"))),
        None => report,
    }
}

/// What to type where a range is one component short, or a diagonal matrix stands for a vector.
pub(super) fn of_entries(
    report: Box<Diagnostic>,
    found: &Expr,
    dimension: usize,
) -> Box<Diagnostic> {
    match longer_range(found, dimension).or_else(|| off_diagonal(found, dimension)) {
        Some(help) => Box::new(report.help(help)),
        None => report,
    }
}

/// `[a, b, c]` for `diag(a, b, c)` where a vector of three is wanted.
pub(super) fn off_diagonal(matrix: &Expr, dimension: usize) -> Option<String> {
    let Expr::Call(call) = elsewhere::bare(matrix) else {
        return None;
    };
    let is_diagonal = matches!(&*call.func, Expr::Path(name) if name.path.is_ident("diag"));
    let entries: Vec<String> = call.args.iter().map(dump::expression).collect();
    (is_diagonal && entries.len() == dimension)
        .then(|| format!("`diag` is a matrix: write `[{}]`", entries.join(", ")))
}

/// What to type where a matrix of so many rows is wanted: with these entries on its diagonal, or with all of them by rows.
pub(super) fn as_matrix(vector: &Expr, size: usize) -> Option<String> {
    let Expr::Array(vector) = elsewhere::bare(vector) else {
        return None;
    };
    let entries: Vec<String> = vector.elems.iter().map(dump::expression).collect();
    if size < 2 || entries.len() != size * size {
        return None;
    }
    let rows = entries
        .chunks(size)
        .map(|row| format!("[{}]", row.join(", ")));
    let rows: Vec<String> = rows.collect();
    Some(format!(
        "a matrix is written by rows: `[{}]`",
        rows.join(", ")
    ))
}

/// `w.f[1..3]` for `w.f[1..2]` where two components are wanted.
fn longer_range(vector: &Expr, dimension: usize) -> Option<String> {
    let Expr::Index(picked) = vector else {
        return None;
    };
    let Expr::Range(range) = &*picked.index else {
        return None;
    };
    let [start, end] = [range.start.as_deref()?, range.end.as_deref()?]
        .map(|bound| elsewhere::number(bound).filter(|it| *it >= 0.0));
    let (start, end) = (start? as usize, end? as usize);
    (end.checked_sub(start)? + 1 == dimension).then(|| {
        let vector = dump::expression(&picked.expr);
        format!("{END_EXCLUDED}write `{vector}[{start}..{}]`", end + 1)
    })
}
