//! Laws: from Rust expressions to the pool.

use proc_macro2::{Ident, Span};
use syn::spanned::Spanned;
use syn::{BinOp, Expr, Lit, Member, UnOp, parse_quote};

use super::elsewhere;
use super::model::Assumption;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::{Expression, Factor, Matrix, Pool, Product, Rate};
use crate::syntax::dump;
use crate::syntax::words::article;
use crate::units::without_unit;

/// What an expression stands for.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number.
    Scalar(Expression),
    /// A matrix; a vector is a matrix with one column.
    Matrix(Product),
}

/// A failed evaluation.
pub type Result<T> = std::result::Result<T, Box<Diagnostic>>;

/// What stands in brackets after a name.
#[derive(Clone)]
pub struct Index {
    /// Its value.
    pub number: i64,
    /// Where messages about it point.
    pub span: Span,
    /// As it is written.
    pub written: Expr,
}

/// A name in a dotted path, with the index in brackets after it.
#[derive(Clone)]
pub struct Step {
    /// The name.
    pub name: Ident,
    /// `2` in `links[2]`.
    pub index: Option<Index>,
}

/// Where names get their meaning.
pub trait Names {
    /// The value of a dotted path such as `spring.q` or `links[2].spring.q`; none if the name is unknown.
    fn value(&mut self, pool: &mut Pool, path: &[Step]) -> Option<Result<Value>>;

    /// The number that an expression stands for while the model is compiled.
    fn whole(&self, expression: &Expr) -> Result<i64>;

    /// Whether a condition holds, if that is known while the model is compiled.
    fn decide(&self, condition: &Expr) -> Result<bool>;

    /// Every plain name.
    fn all(&self) -> Vec<&str>;

    /// What to write for a path without a value, where that can be told.
    fn advice(&mut self, _pool: &mut Pool, _path: &[Step]) -> Option<String> {
        None
    }

    /// Whether a name is a variable of the element whose law is read.
    fn is_own(&self, _name: &Ident) -> bool {
        false
    }

    /// Whether a law is read for one component of a vector: its own variables stand for that one.
    fn is_by_component(&self) -> bool {
        false
    }

    /// Is told the value of each operator, function and `if`, with the place of its sign or name.
    fn seen(&mut self, _pool: &mut Pool, _place: Span, _value: &Value) {}

    /// Remembers what must hold of parameters; false if it is not of parameters alone.
    fn assume(&mut self, pool: &Pool, assumption: Assumption) -> bool;

    /// Whether the value is asked for its unit alone.
    fn reads_units(&self) -> bool {
        false
    }

    /// Remembers that a function takes a pure number, which its value does not show.
    fn takes_pure(&mut self, _place: Span, _function: &'static str, _argument: Expression) {}

    /// What a number with a decimal point stands for, which may carry a unit.
    fn measured(&mut self, _pool: &mut Pool, value: Expression, _text: &str) -> Expression {
        value
    }
}

impl Value {
    /// Whether it is a vector of this dimension.
    pub(super) fn is_vector_of(&self, dimension: usize) -> bool {
        matches!(self, Self::Matrix(it) if (it.rows(), it.columns()) == (dimension, 1))
    }

    /// A column.
    #[must_use]
    pub fn column(entries: Vec<Expression>) -> Self {
        match entries[..] {
            [only] => Self::Scalar(only),
            _ => Self::Matrix(Product::of(Factor::Dense(Matrix::column(entries)))),
        }
    }

    /// Entries of a scalar or a vector.
    #[must_use]
    pub fn entries(&self, pool: &mut Pool) -> Option<Vec<Expression>> {
        match self {
            Self::Scalar(value) => Some(vec![*value]),
            Self::Matrix(product) if product.columns() == 1 => {
                Some(product.to_matrix(pool).entries)
            }
            Self::Matrix(_) => None,
        }
    }

    /// `3`, `3×3`, or nothing for a number, as messages show it.
    #[must_use]
    pub fn shape(&self) -> String {
        match self {
            Self::Scalar(_) => "a number".to_owned(),
            Self::Matrix(product) if product.columns() == 1 => {
                format!("a vector of {}", product.rows())
            }
            Self::Matrix(product) => {
                let (rows, columns) = (product.rows().to_string(), product.columns());
                format!("{} {rows}×{columns} matrix", article(&rows))
            }
        }
    }
}

/// A failure at a place.
pub fn fail<T>(span: Span, message: impl Into<String>) -> Result<T> {
    Err(Box::new(error(codes::EXPRESSION, span, message)))
}

pub(super) fn mismatch<T>(span: Span, message: String) -> Result<T> {
    Err(Box::new(error(codes::WRONG_DIMENSION, span, message)))
}

/// Evaluates expressions with names from `names`.
pub struct Evaluator<'a, N: Names> {
    /// Where nodes go.
    pub pool: &'a mut Pool,
    /// Where names come from.
    pub names: &'a mut N,
}

impl<N: Names> Evaluator<'_, N> {
    /// The value of an expression.
    pub fn evaluate(&mut self, expression: &Expr) -> Result<Value> {
        let value = self.any_value(expression)?;
        if let Some(place) = sign(expression) {
            self.names.seen(self.pool, place, &value);
        }
        match &value {
            Value::Scalar(scalar)
                if self.pool.rate(*scalar) == Rate::Constant
                    && !self
                        .pool
                        .constant_value(*scalar)
                        .is_some_and(f64::is_finite) =>
            {
                let message = "the value of this is not a finite number";
                Err(Box::new(error(
                    codes::NOT_FINITE,
                    expression.span(),
                    message,
                )))
            }
            _ => Ok(value),
        }
    }

    fn any_value(&mut self, expression: &Expr) -> Result<Value> {
        match expression {
            Expr::Lit(literal) => self.literal(&literal.lit),
            Expr::Paren(inner) => self.evaluate(&inner.expr),
            Expr::Group(inner) => self.evaluate(&inner.expr),
            Expr::Path(_) | Expr::Field(_) => self.path(expression),
            Expr::Index(index) => self.index(index),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
                let value = self.evaluate(&unary.expr)?;
                Ok(self.scale(Expression::ONE.negated(), value))
            }
            Expr::Binary(binary) => self.binary(binary),
            Expr::Call(call) => self
                .call(call)
                .map_err(|report| self.called(report, &call.func, &call.args)),
            Expr::MethodCall(call) => {
                let mut arguments = vec![(*call.receiver).clone()];
                arguments.extend(call.args.iter().cloned());
                let (receiver, method) = (&call.receiver, &call.method);
                self.function(method, &arguments).map_err(|report| {
                    let report = self.of_module(report, call);
                    self.called(report, &parse_quote!(#receiver.#method), &call.args)
                })
            }
            Expr::Array(array) => self.array(array),
            Expr::If(choice) => self.choice(choice),
            Expr::Block(block) => self.branch(&block.block),
            Expr::Cast(cast) => {
                let message = "`as` changes a type, and every value is a number";
                let report = error(codes::EXPRESSION, cast.as_token.span, message);
                let value = dump::expression(&cast.expr);
                Err(Box::new(report.help(format!("write `{value}`"))))
            }
            _ => {
                let message = "expected a law: numbers, names, + - * /, functions, vectors or `if`";
                let report = error(codes::EXPRESSION, expression.span(), message);
                Err(Box::new(match elsewhere::of_rust(expression) {
                    Some(help) => report.help(help),
                    None => report,
                }))
            }
        }
    }

    /// The value, which must be a number.
    pub fn scalar(&mut self, expression: &Expr) -> Result<Expression> {
        let value = self.evaluate(expression)?;
        let number = number(&value, expression.span());
        let is_named = matches!(expression, Expr::Path(_) | Expr::Field(_));
        number.map_err(|report| match &value {
            Value::Matrix(vector) if is_named && vector.columns() == 1 => {
                let name = dump::expression(expression);
                Box::new(report.help(format!("write one component, such as `{name}[0]`")))
            }
            _ => report,
        })
    }

    fn literal(&mut self, literal: &Lit) -> Result<Value> {
        let (text, suffix) = match literal {
            Lit::Float(float) => (float.base10_digits().to_owned(), float.suffix().to_owned()),
            Lit::Int(integer) => (
                integer.base10_digits().to_owned(),
                integer.suffix().to_owned(),
            ),
            _ => {
                let report = error(codes::EXPRESSION, literal.span(), "expected a number");
                let help = no_number(literal);
                return Err(Box::new(help.into_iter().fold(report, Diagnostic::help)));
            }
        };
        match self.pool.literal(&text) {
            Some(value) if suffix.is_empty() || suffix == "f64" => {
                let measured = matches!(literal, Lit::Float(_)) && value != Expression::ZERO;
                Ok(Value::Scalar(if measured {
                    self.names.measured(self.pool, value, &text)
                } else {
                    value
                }))
            }
            Some(_) => {
                let message = format!("expected a number without suffix, found `{suffix}`");
                let report = error(codes::EXPRESSION, literal.span(), message);
                Err(Box::new(match without_unit(&text, &suffix) {
                    Some(help) => report.help(help),
                    None => report,
                }))
            }
            None => Err(Box::new(error(
                codes::LITERAL,
                literal.span(),
                format!("expected a finite number, found `{text}`"),
            ))),
        }
    }

    fn path(&mut self, expression: &Expr) -> Result<Value> {
        let Some(steps) = self.steps(expression)? else {
            return match expression {
                Expr::Path(path) => Err(no_plain_name(&path.path, &[])),
                Expr::Field(field) => {
                    let name = member(field)?;
                    match self.evaluate(&field.base) {
                        Ok(value) => self.component(value, &name),
                        Err(report) => Err(self.twice_indexed(expression).unwrap_or(report)),
                    }
                }
                _ => fail(expression.span(), "expected a plain name"),
            };
        };
        match self.names.value(self.pool, &steps) {
            Some(Err(report)) if report.code == codes::UNKNOWN_NAME => {
                return Err(match self.advice(&steps) {
                    Some(help) => Box::new(report.help(help)),
                    None => report,
                });
            }
            Some(value) => return value,
            None => {}
        }
        if let Some(component) = self.by_letter(expression, &steps) {
            return component;
        }
        let name = steps
            .last()
            .map_or_else(|| expression.span(), |step| step.name.span());
        let text = dump::expression(expression);
        let report = error(
            codes::UNKNOWN_NAME,
            name,
            format!("`{text}` is not declared"),
        );
        if let [first, _, ..] = &steps[..] {
            let first = &first.name;
            if !self.names.all().iter().any(|name| first == name) {
                let message = format!("`{first}` is not declared");
                let report = error(codes::UNKNOWN_NAME, first.span(), message);
                let is_module = first.to_string().starts_with(char::is_uppercase);
                let constant = steps.last().filter(|_| is_module);
                let constant =
                    constant.and_then(|it| elsewhere::instead(&it.name.to_string(), &[]));
                return Err(Box::new(match self.advice(&steps).or(constant) {
                    Some(help) => report.help(help),
                    None => report.did_you_mean(&first.to_string(), &self.names.all()),
                }));
            }
        }
        let help = elsewhere::instead(&text, &[]);
        let help = help.or_else(|| self.advice(&steps));
        Err(Box::new(match help.or_else(|| self.of_value(&steps)) {
            Some(help) => report.help(help),
            None => report.did_you_mean(&text, &self.names.all()),
        }))
    }

    /// The steps of a dotted path; none if it does not begin with a name.
    pub(super) fn steps(&self, expression: &Expr) -> Result<Option<Vec<Step>>> {
        let mut steps = Vec::new();
        let (mut rest, mut index) = (expression, None);
        loop {
            let name = match rest {
                Expr::Index(indexed) if index.is_none() => {
                    index = Some(Index {
                        number: self.names.whole(&indexed.index)?,
                        span: indexed.index.span(),
                        written: (*indexed.index).clone(),
                    });
                    rest = &indexed.expr;
                    continue;
                }
                Expr::Field(field) => {
                    rest = &field.base;
                    member(field)?
                }
                Expr::Path(base) => match base.path.get_ident() {
                    Some(name) => {
                        let name = name.clone();
                        steps.push(Step { name, index });
                        steps.reverse();
                        return Ok(Some(steps));
                    }
                    None => return Ok(None),
                },
                _ => return Ok(None),
            };
            steps.push(Step {
                name,
                index: index.take(),
            });
        }
    }

    /// A component of an element's own variable is one of the whole vector.
    pub(super) fn check_whole(&self, name: &Ident) -> Result<()> {
        if self.names.is_own(name) && self.names.is_by_component() {
            return whole_vector(name.span());
        }
        Ok(())
    }

    fn binary(&mut self, binary: &syn::ExprBinary) -> Result<Value> {
        let span = binary.op.span();
        let no_power = match binary.op {
            BinOp::BitXor(_) => Some("`^` is not a power; in Rust it is the exclusive or"),
            _ if elsewhere::is_double_star(binary) => {
                Some("`**` is not a power; Rust has no sign for it")
            }
            _ => None,
        };
        if let Some(message) = no_power {
            let report = error(codes::POWER_OPERATOR, span, message);
            let help = elsewhere::power_operator(&binary.left, &binary.right);
            return Err(Box::new(report.help(help)));
        }
        if matches!(binary.op, BinOp::Rem(_)) {
            return self.whole_remainder(binary);
        }
        let no_condition =
            "expected +, -, * or /; comparisons, `&&` and `||` stand between `if` and `{`";
        if let Some((place, choice)) = elsewhere::as_choice(binary) {
            let report = error(codes::EXPRESSION, place, no_condition);
            return Err(Box::new(report.help(format!("write `{choice}`"))));
        }
        if !matches!(
            binary.op,
            BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) | BinOp::Div(_)
        ) {
            return fail(span, no_condition);
        }
        let left = self.evaluate(&binary.left)?;
        let right = self.evaluate(&binary.right)?;
        match binary.op {
            BinOp::Add(_) => self.sum(left, right, false, span),
            BinOp::Sub(_) => self.sum(left, right, true, span),
            BinOp::Mul(_) => {
                let help = instead_of_product(&left, &right);
                let product = self.product(left, right, span);
                product.map_err(|report| match help {
                    Some(help) => Box::new(report.help(help(binary))),
                    None => report,
                })
            }
            _ => {
                let Value::Scalar(divisor) = right else {
                    return mismatch(
                        span,
                        format!("expected a number as divisor, found {}", right.shape()),
                    );
                };
                let quotient = match left {
                    Value::Scalar(dividend) => {
                        self.quotient(dividend, divisor, span).map(Value::Scalar)
                    }
                    matrix @ Value::Matrix(_) => {
                        let reciprocal = self.quotient(Expression::ONE, divisor, span);
                        reciprocal.map(|reciprocal| self.scale(reciprocal, matrix))
                    }
                };
                quotient.map_err(|report| {
                    let zero = match &*binary.right {
                        Expr::Lit(_) => return report,
                        Expr::Paren(inner) => dump::expression(&inner.expr),
                        other => dump::expression(other),
                    };
                    Box::new(report.note(format!("`{zero}` is zero")))
                })
            }
        }
    }

    /// `%` stands between whole numbers; of values that vary it is a `mod`.
    fn whole_remainder(&mut self, binary: &syn::ExprBinary) -> Result<Value> {
        let known = self.names.whole(&Expr::Binary(binary.clone()));
        // A name may have two meanings in a law, of which a whole number is one.
        if known.is_ok() {
            self.evaluate(&binary.left)?;
            self.evaluate(&binary.right)?;
        }
        let varying = match known {
            Err(_) => self.varying(&[&binary.left, &binary.right]),
            Ok(_) => None,
        };
        match (known, varying) {
            (Err(_), Some(varying)) => {
                let message = format!(
                    "`%` stands between whole numbers, and `{varying}` changes while the model runs"
                );
                let report = error(codes::WHOLE_NUMBER, binary.op.span(), message);
                Err(Box::new(report.help(elsewhere::remainder(binary))))
            }
            (known, _) => Ok(Value::Scalar(self.pool.integer(known?))),
        }
    }

    /// The first of these whose value changes while the model runs.
    fn varying(&mut self, expressions: &[&Expr]) -> Option<String> {
        let is_varying = |expression: &&&Expr| {
            let value = self.evaluate(expression);
            let entries = value.ok().and_then(|value| value.entries(self.pool));
            let mut entries = entries.into_iter().flatten();
            entries.any(|entry| self.pool.rate(entry) == Rate::Varying)
        };
        let varying = expressions.iter().find(is_varying)?;
        Some(dump::expression(varying))
    }

    fn quotient(
        &mut self,
        dividend: Expression,
        divisor: Expression,
        span: Span,
    ) -> Result<Expression> {
        self.pool.divide(dividend, divisor).ok_or_else(|| {
            Box::new(error(
                codes::NOT_FINITE,
                span,
                "this divides by zero, whatever the state",
            ))
        })
    }

    fn sum(&mut self, left: Value, right: Value, minus: bool, span: Span) -> Result<Value> {
        match (&left, &right) {
            (Value::Scalar(a), Value::Scalar(b)) => {
                Ok(Value::Scalar(self.pool.add(*a, b.flipped(minus))))
            }
            (Value::Matrix(a), Value::Matrix(b))
                if (a.rows(), a.columns()) == (b.rows(), b.columns()) =>
            {
                let (a, b) = (a.to_matrix(self.pool), b.to_matrix(self.pool));
                let entries = a
                    .entries
                    .iter()
                    .zip(&b.entries)
                    .map(|(a, b)| self.pool.add(*a, b.flipped(minus)))
                    .collect();
                Ok(Value::Matrix(Product::of(Factor::Dense(Matrix::new(
                    a.rows, a.columns, entries,
                )))))
            }
            _ => mismatch(
                span,
                format!(
                    "expected equal dimensions, found {} and {}",
                    left.shape(),
                    right.shape()
                ),
            ),
        }
    }

    fn product(&mut self, left: Value, right: Value, span: Span) -> Result<Value> {
        match (left, right) {
            (Value::Scalar(a), Value::Scalar(b)) => Ok(Value::Scalar(self.pool.multiply(a, b))),
            (Value::Scalar(a), matrix) | (matrix, Value::Scalar(a)) => Ok(self.scale(a, matrix)),
            (Value::Matrix(a), Value::Matrix(b)) if a.columns() != b.rows() => {
                let (a, b) = (Value::Matrix(a).shape(), Value::Matrix(b).shape());
                mismatch(span, format!("a product of {a} with {b} does not exist"))
            }
            (Value::Matrix(a), Value::Matrix(b)) if b.columns() == 1 => {
                let vector = b.to_matrix(self.pool);
                Ok(Value::column(a.apply(self.pool, &vector).entries))
            }
            (Value::Matrix(a), Value::Matrix(b)) => Ok(Value::Matrix(a.then(b))),
        }
    }

    fn scale(&mut self, factor: Expression, value: Value) -> Value {
        match value {
            // A rotation stays known as one.
            value if factor == Expression::ONE => value,
            Value::Scalar(value) => Value::Scalar(self.pool.multiply(factor, value)),
            Value::Matrix(product) => {
                let matrix = product
                    .to_matrix(self.pool)
                    .map(|entry| self.pool.multiply(factor, entry));
                Value::Matrix(Product::of(Factor::Dense(matrix)))
            }
        }
    }

    fn array(&mut self, array: &syn::ExprArray) -> Result<Value> {
        if array.elems.is_empty() {
            return mismatch(array.span(), "expected at least one entry".to_owned());
        }
        let rows = self
            .rows(array)
            .map_err(|report| of_one_row(array, report))?;
        let columns = rows[0].len();
        if columns == 0 || rows.iter().any(|row| row.len() != columns) {
            return mismatch(array.span(), "expected rows of equal length".to_owned());
        }
        let matrix = Matrix::new(rows.len(), columns, rows.concat());
        Ok(Value::Matrix(Product::of(Factor::Dense(matrix))))
    }

    /// The entries of an array by rows, of one entry each where they are no arrays themselves.
    fn rows(&mut self, array: &syn::ExprArray) -> Result<Vec<Vec<Expression>>> {
        let entries = array.elems.iter();
        entries
            .map(|entry| match entry {
                Expr::Array(row) => row.elems.iter().map(|entry| self.scalar(entry)).collect(),
                _ => Ok(vec![self.scalar(entry)?]),
            })
            .collect()
    }
}

/// What to type for `[w]` with a vector `w`, which is meant as the row of a matrix.
fn of_one_row(array: &syn::ExprArray, report: Box<Diagnostic>) -> Box<Diagnostic> {
    match (array.elems.len(), array.elems.first()) {
        (1, Some(name @ Expr::Path(_))) if report.code == codes::WRONG_DIMENSION => {
            let row = format!("transpose({})", dump::expression(name));
            Box::new(report.help(format!(
                "or `{row}` in the place of the brackets, for a matrix of one row"
            )))
        }
        _ => report,
    }
}

/// A path where a name should stand; of another language's constant or function it says what is written here.
pub(super) fn no_plain_name(path: &syn::Path, arguments: &[Expr]) -> Box<Diagnostic> {
    let report = error(codes::EXPRESSION, path.span(), "expected a plain name");
    let last = path.segments.last().map(|last| last.ident.to_string());
    Box::new(
        match last.and_then(|last| elsewhere::instead(&last, arguments)) {
            Some(help) => report.help(help),
            None => report,
        },
    )
}

/// A law that takes the whole vector is read as a law of the vector, whatever this says.
pub(super) fn whole_vector<T>(span: Span) -> Result<T> {
    mismatch(
        span,
        "expected a vector, found one component of it".to_owned(),
    )
}

/// The value, which must be a number.
pub(super) fn number(value: &Value, span: Span) -> Result<Expression> {
    match value {
        Value::Scalar(value) => Ok(*value),
        other => mismatch(span, format!("expected a number, found {}", other.shape())),
    }
}

/// What tells how a product of two vectors is written.
fn instead_of_product(left: &Value, right: &Value) -> Option<fn(&syn::ExprBinary) -> String> {
    let (Value::Matrix(a), Value::Matrix(b)) = (left, right) else {
        return None;
    };
    if left.is_vector_of(4) && right.is_vector_of(3) {
        return Some(elsewhere::by_quaternion);
    }
    let are_vectors = a.columns() == 1 && b.columns() == 1;
    (are_vectors && a.rows() == b.rows()).then_some(elsewhere::by_scalar_product)
}

/// Where the sign of an operator or the name of a function stands.
fn sign(expression: &Expr) -> Option<Span> {
    match expression {
        Expr::Binary(binary) => Some(binary.op.span()),
        Expr::Call(call) => Some(call.func.span()),
        Expr::MethodCall(call) => Some(call.method.span()),
        Expr::If(choice) => Some(choice.if_token.span),
        _ => None,
    }
}

/// The name after a dot.
fn member(field: &syn::ExprField) -> Result<Ident> {
    match &field.member {
        Member::Named(name) => Ok(name.clone()),
        Member::Unnamed(number) => {
            let message = "expected a name after `.`; a component is `[0]` or `.x`";
            let report = error(codes::EXPRESSION, field.member.span(), message);
            let base = dump::expression(&field.base);
            Err(Box::new(
                report.help(format!("write `{base}[{}]`", number.index)),
            ))
        }
    }
}

/// What to type for a literal that is no number.
fn no_number(literal: &Lit) -> Option<String> {
    match literal {
        Lit::Bool(truth) => {
            let number = if truth.value { "1.0" } else { "0.0" };
            Some(format!(
                "a value is a number: write `{number}`, and ask `> 0.5`"
            ))
        }
        Lit::Str(_) => Some(
            "a choice of words is a parameter of a component: `param kind: linear | cubic = linear;`"
                .to_owned(),
        ),
        _ => None,
    }
}
