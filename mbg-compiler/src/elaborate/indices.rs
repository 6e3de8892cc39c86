//! Components of vectors, rows of matrices and parts of either in laws.

use proc_macro2::{Ident, Span};
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::{Expr, RangeLimits, Token};

use super::advice;
use super::expressions::{Evaluator, Index, Names, Result, Step, Value, fail};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::Product;
use crate::syntax::dump;
use crate::units::without_unit;

impl<N: Names> Evaluator<'_, N> {
    /// The component by the letter that comes last in a path; none where there is no such letter, or no value before it.
    pub(super) fn by_letter(&mut self, path: &Expr, steps: &[Step]) -> Option<Result<Value>> {
        let (Step { name, index: None }, front) = steps.split_last()? else {
            return None;
        };
        let place = QUATERNION.iter().position(|letter| name == letter)?;
        if let [own] = front
            && let Err(report) = self.check_whole(&own.name)
        {
            return Some(Err(report));
        }
        let value = self.names.value(self.pool, front)?;
        let is_own = matches!(front, [own] if self.names.is_own(&own.name));
        let is_quaternion = |value: &Value| value.is_vector_of(4) && !is_own && !is_of_bond(front);
        match value {
            Ok(value) if is_quaternion(&value) => Some(Err(no_letter(path, name, place))),
            _ if component_index(name).is_none() => None,
            value => Some(value.and_then(|value| self.component(value, name))),
        }
    }

    /// What to write for a path without a value.
    pub(super) fn advice(&mut self, steps: &[Step]) -> Option<String> {
        let of_row = self.entry_by_letter(steps);
        of_row.or_else(|| self.names.advice(self.pool, steps))
    }

    /// Where a variable of an element is read of a value.
    pub(super) fn of_value(&mut self, steps: &[Step]) -> Option<String> {
        let (last, front) = steps.split_last()?;
        let value = self.names.value(self.pool, front)?;
        let owner = advice::text(front);
        (value.is_ok() && is_of_bond(steps)).then(|| {
            format!(
                "`{owner}` is a value, and `{}` is read of an element: write the name of that before it",
                last.name
            )
        })
    }

    /// `a[1][0]` for `a[1].x`, where `a` is a matrix: a row of it is a vector, but no name.
    fn entry_by_letter(&mut self, steps: &[Step]) -> Option<String> {
        let (last, front) = steps.split_last()?;
        let column = component_index(&last.name)?;
        let mut matrix = front.to_vec();
        let row = matrix.last_mut()?.index.take()?.number;
        let value = self.names.value(self.pool, &matrix)?.ok()?;
        let is_matrix = matches!(&value, Value::Matrix(it) if it.columns() > column.max(1));
        let matrix = advice::text(&matrix);
        is_matrix.then(|| format!("write `{matrix}[{row}][{column}]`"))
    }

    /// A mistake in `c[1][2].v`, where an iteration of `c` has a loop inside; none where that is not so.
    pub(super) fn twice_indexed(&mut self, path: &Expr) -> Option<Box<Diagnostic>> {
        let Twice {
            once,
            iteration,
            second,
            behind,
        } = twice(path)?;
        let mut steps = self.steps(&once).ok()??;
        let place = steps.len().checked_sub(behind)?;
        steps.get_mut(place)?.index.get_or_insert(Index {
            number: self.names.whole(second).ok()?,
            span: second.span(),
            written: second.clone(),
        });
        let help = self.names.advice(self.pool, &steps)?;
        let text = dump::expression(iteration);
        let message = format!("`{text}` is one iteration, which has no index of its own");
        let report = error(codes::UNKNOWN_NAME, second.span(), message);
        Some(Box::new(report.help(help)))
    }

    /// Refuses a vector where its components are wanted one by one, with the text for them.
    pub(super) fn check_entries(&mut self, vector: &Expr) -> Result<()> {
        let Value::Matrix(product) = self.evaluate(vector)? else {
            return Ok(());
        };
        let text = dump::expression(vector);
        let entries: Vec<String> = match (vector, product.rows()) {
            (Expr::Array(entries), _) => entries.elems.iter().map(dump::expression).collect(),
            (_, 3) => ["x", "y", "z"].map(|it| format!("{text}.{it}")).into(),
            (_, size) => (0..size).map(|it| format!("{text}[{it}]")).collect(),
        };
        let shape = Value::Matrix(product).shape();
        let message = format!("expected numbers, found {shape}");
        let report = error(codes::WRONG_DIMENSION, vector.span(), message);
        Err(Box::new(
            report.help(format!("write `diag({})`", entries.join(", "))),
        ))
    }

    /// The component `x`, `y` or `z`.
    pub(super) fn component(&mut self, value: Value, name: &Ident) -> Result<Value> {
        let Some(index) = component_index(name) else {
            return fail(
                name.span(),
                format!("expected `x`, `y` or `z`, found `{name}`"),
            );
        };
        self.pick(value, index as i64, name.span())
    }

    /// A mistake in what looks like the call of a function; what is called may be a value.
    pub(super) fn called(
        &mut self,
        report: Box<Diagnostic>,
        called: &Expr,
        arguments: &Punctuated<Expr, Token![,]>,
    ) -> Box<Diagnostic> {
        let (true, Some(first), 1) = (
            report.code == codes::UNKNOWN_NAME,
            arguments.first(),
            arguments.len(),
        ) else {
            return report;
        };
        let Ok(Some(steps)) = self.steps(called) else {
            return report;
        };
        let Some(Ok(value)) = self.names.value(self.pool, &steps) else {
            return report;
        };
        let [text, first] = [called, first].map(dump::expression);
        let help = match value {
            Value::Scalar(_) => format!("for a product write `{text} * ({first})`"),
            Value::Matrix(_) => format!("a component stands in brackets: write `{text}[{first}]`"),
        };
        let message = format!("`{text}` is a value, and it is called as a function");
        Box::new(error(report.code, report.span, message).help(help))
    }

    fn pick(&mut self, value: Value, index: i64, span: Span) -> Result<Value> {
        let shape = value.shape();
        let entries = value.entries(self.pool).unwrap_or_default();
        match usize::try_from(index)
            .ok()
            .and_then(|index| entries.get(index))
        {
            Some(entry) => Ok(Value::Scalar(*entry)),
            None => {
                let message = format!("component {index} of {shape} does not exist");
                Err(from_zero(span, message, index, entries.len()))
            }
        }
    }

    /// A row of a matrix, as a vector.
    fn row(&mut self, product: &Product, index: i64, span: Span) -> Result<Value> {
        let matrix = product.to_matrix(self.pool);
        match usize::try_from(index) {
            Ok(row) if row < matrix.rows => {
                let entries = (0..matrix.columns).map(|column| matrix.at(row, column));
                Ok(Value::column(entries.collect()))
            }
            _ => {
                let shape = Value::Matrix(product.clone()).shape();
                let message = format!("row {index} of {shape} does not exist");
                Err(from_zero(span, message, index, matrix.rows))
            }
        }
    }

    /// What brackets take out of a value.
    pub(super) fn index(&mut self, index: &syn::ExprIndex) -> Result<Value> {
        if let Expr::Path(base) = &*index.expr
            && let Some(name) = base.path.get_ident()
        {
            self.check_whole(name)?;
        }
        if matches!(*index.expr, Expr::Lit(_)) {
            let [number, unit] = [&*index.expr, &*index.index].map(dump::expression);
            let report = error(
                codes::EXPRESSION,
                index.index.span(),
                format!("`{number}` has no components"),
            );
            let help = without_unit(&number, &unit);
            return Err(Box::new(help.into_iter().fold(report, Diagnostic::help)));
        }
        let value = self.evaluate(&index.expr)?;
        let span = index.index.span();
        let Expr::Range(range) = &*index.index else {
            let number = self.names.whole(&index.index);
            let number = number.map_err(|report| picked(report, index, &value))?;
            return match value {
                Value::Matrix(product) if product.columns() > 1 => self.row(&product, number, span),
                value => self.pick(value, number, span),
            };
        };
        let (Some(start), Some(end), RangeLimits::HalfOpen(_)) =
            (&range.start, &range.end, &range.limits)
        else {
            let report = error(
                codes::EXPRESSION,
                span,
                "expected a range such as `1..3`, which excludes its end",
            );
            let help = self.with_both_ends(range);
            return Err(Box::new(help.into_iter().fold(report, Diagnostic::help)));
        };
        let (start, end) = (self.names.whole(start)?, self.names.whole(end)?);
        let shape = value.shape();
        let entries = value.entries(self.pool).unwrap_or_default();
        match (usize::try_from(start), usize::try_from(end)) {
            (Ok(first), Ok(last)) if first < last && last <= entries.len() => {
                Ok(Value::column(entries[first..last].to_vec()))
            }
            _ => {
                let message = format!("components {start}..{end} of {shape} do not exist");
                let last = end.saturating_sub(1);
                Err(from_zero(span, message, last, entries.len()))
            }
        }
    }

    /// `[1..4]` for `[1..=3]`.
    fn with_both_ends(&self, range: &syn::ExprRange) -> Option<String> {
        let start = self.names.whole(range.start.as_deref()?).ok()?;
        let end = self.names.whole(range.end.as_deref()?).ok()?;
        Some(format!("write `[{start}..{}]`", end.checked_add(1)?))
    }
}

/// What is picked out of so many by a number that none of them has: the last is often asked for by how many there are.
fn from_zero(span: Span, message: String, index: i64, count: usize) -> Box<Diagnostic> {
    let report = error(codes::WRONG_DIMENSION, span, message);
    let is_counted_from_one = count > 1 && usize::try_from(index) == Ok(count);
    Box::new(match is_counted_from_one {
        true => report.help(format!(
            "they are counted from 0: the last is `[{}]`",
            count - 1
        )),
        false => report,
    })
}

/// A path with two indices behind one name, `c[1][2].v`.
struct Twice<'a> {
    /// `c[1].v`
    once: Expr,
    /// `c[1]`
    iteration: &'a Expr,
    /// `2`
    second: &'a Expr,
    /// How many names stand behind.
    behind: usize,
}

fn twice(path: &Expr) -> Option<Twice<'_>> {
    match path {
        Expr::Field(field) => {
            let base = twice(&field.base)?;
            let once = Expr::Field(syn::ExprField {
                base: Box::new(base.once),
                ..field.clone()
            });
            let behind = base.behind + 1;
            Some(Twice {
                once,
                behind,
                ..base
            })
        }
        Expr::Index(outer) if matches!(&*outer.expr, Expr::Index(_)) => Some(Twice {
            once: (*outer.expr).clone(),
            iteration: &outer.expr,
            second: &outer.index,
            behind: 0,
        }),
        _ => None,
    }
}

/// The components of a quaternion in order.
const QUATERNION: [&str; 4] = ["w", "x", "y", "z"];

/// Whether they lead to efforts, flows, momenta or displacements of something: four of these are no quaternion.
fn is_of_bond(steps: &[Step]) -> bool {
    let is_known = |step: &Step| ["e", "f", "p", "q"].iter().any(|known| step.name == known);
    steps.len() > 1 && steps.last().is_some_and(is_known)
}

/// Of a quaternion, whose first component is that of no axis.
fn no_letter(path: &Expr, name: &Ident, place: usize) -> Box<Diagnostic> {
    let path = dump::expression(path);
    let base = path.strip_suffix(&format!(".{name}")).unwrap_or(&path);
    let message =
        format!("`{base}` is `[w, x, y, z]`, whose components have numbers and no letters");
    let report = error(codes::WRONG_DIMENSION, name.span(), message);
    Box::new(report.help(format!("write `{base}[{place}]` for its {name}")))
}

/// 0, 1, 2 for `x`, `y`, `z`.
pub(super) fn component_index(name: &Ident) -> Option<usize> {
    ["x", "y", "z"].iter().position(|known| name == known)
}

/// What to type where an entry of a vector is picked while the model runs: a curve has the values of the entries at their numbers.
fn picked(report: Box<Diagnostic>, index: &syn::ExprIndex, value: &Value) -> Box<Diagnostic> {
    let entries = match value {
        Value::Matrix(product) if product.columns() == 1 => product.rows(),
        _ => return report,
    };
    if !matches!(*index.index, Expr::Path(_)) {
        return report;
    }
    let [of, by] = [&*index.expr, &*index.index].map(dump::expression);
    let places: Vec<String> = (0..entries).map(|it| format!("{it}.0")).collect();
    Box::new(report.help(format!(
        "what is picked while the model runs is a curve: `interpolate({by}, [{}], {of})`",
        places.join(", ")
    )))
}
