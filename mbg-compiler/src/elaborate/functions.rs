//! Functions in laws, by their names.

use proc_macro2::Ident;
use syn::Expr;
use syn::ext::IdentExt;
use syn::spanned::Spanned;

use super::elsewhere;
use super::expressions::{
    Evaluator, Names, Result, Value, fail, mismatch, no_plain_name, number, whole_vector,
};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::{Expression, Factor, Function, LARGEST_POWER, Matrix, Product};
use crate::syntax::words::FUNCTIONS;
use crate::syntax::{dump, signals};

impl<N: Names> Evaluator<'_, N> {
    pub(super) fn call(&mut self, call: &syn::ExprCall) -> Result<Value> {
        let Expr::Path(path) = &*call.func else {
            return fail(call.func.span(), "expected the name of a function");
        };
        let arguments: Vec<Expr> = call.args.iter().cloned().collect();
        let Some(name) = path.path.get_ident() else {
            let mut report = no_plain_name(&path.path, &arguments);
            let last = path.path.segments.last().map(|last| &last.ident);
            // `f64::sin(t)`
            if let Some(last) = last.filter(|last| self.function(last, &arguments).is_ok()) {
                let arguments = arguments.iter().map(dump::expression);
                let arguments = arguments.collect::<Vec<_>>().join(", ");
                report.helps.push(format!("write `{last}({arguments})`"));
            }
            return Err(report);
        };
        self.function(name, &arguments)
    }

    /// A mistake in `Math.sin(u)`, whose function is called as one of a module.
    pub(super) fn of_module(
        &mut self,
        report: Box<Diagnostic>,
        call: &syn::ExprMethodCall,
    ) -> Box<Diagnostic> {
        let arguments: Vec<Expr> = call.args.iter().cloned().collect();
        let is_module = matches!(&*call.receiver, Expr::Path(_) | Expr::Field(_))
            && self.evaluate(&call.receiver).is_err();
        if !is_module || self.function(&call.method, &arguments).is_err() {
            return report;
        }
        let module = dump::expression(&call.receiver);
        let message = format!("`{module}` is not declared");
        let report = error(codes::UNKNOWN_NAME, call.receiver.span(), message);
        let arguments: Vec<String> = arguments.iter().map(dump::expression).collect();
        Box::new(report.help(format!(
            "functions belong to no module: write `{}({})`",
            call.method,
            arguments.join(", ")
        )))
    }

    pub(super) fn function(&mut self, name: &Ident, arguments: &[Expr]) -> Result<Value> {
        let text = name.unraw().to_string();
        let count = |expected: usize| check_count(name, expected, arguments);
        match text.as_str() {
            "interpolate" => match arguments {
                [x, places, values] => self.curve(x, places, values),
                _ => Err(Box::new(no_curve(name, arguments))),
            },
            "transpose" => {
                count(1)?;
                match self.evaluate(&arguments[0])? {
                    Value::Matrix(product) => Ok(Value::Matrix(product.transpose())),
                    Value::Scalar(_) if self.names.is_by_component() => whole_vector(name.span()),
                    scalar @ Value::Scalar(_) => Ok(scalar),
                }
            }
            "diag" => {
                if let [vector] = arguments {
                    self.check_entries(vector)?;
                }
                let entries: Result<Vec<_>> = arguments
                    .iter()
                    .map(|argument| self.scalar(argument))
                    .collect();
                Ok(Value::Matrix(Product::of(Factor::Dense(Matrix::diagonal(
                    &entries?,
                )))))
            }
            "skew" => {
                count(1)?;
                let [x, y, z] = self.column(&arguments[0])?;
                let zero = Expression::ZERO;
                let rows = [
                    zero,
                    z.negated(),
                    y,
                    z,
                    zero,
                    x.negated(),
                    y.negated(),
                    x,
                    zero,
                ];
                let matrix = Matrix::new(3, 3, rows.to_vec());
                Ok(Value::Matrix(Product::of(Factor::Dense(matrix))))
            }
            _ => match self.orientation(name, arguments) {
                Some(value) => value,
                None => self.of_numbers(name, arguments),
            },
        }
    }

    /// A function of numbers; one of vectors is worked out for each component, and a number beside them counts for all.
    fn of_numbers(&mut self, name: &Ident, arguments: &[Expr]) -> Result<Value> {
        let Some(arity) = arity(name) else {
            return Err(Box::new(no_function(name, arguments)));
        };
        check_count(name, arity, arguments)?;
        let values: Result<Vec<Value>> = arguments
            .iter()
            .enumerate()
            .map(|(place, argument)| match is_power(name) && place == 1 {
                true => self.exponent(argument),
                false => self.evaluate(argument),
            })
            .collect();
        let values = values?;
        let mut columns = Vec::new();
        for (value, argument) in values.iter().zip(arguments) {
            columns.push(match value.entries(self.pool) {
                Some(entries) => entries,
                None => vec![number(value, argument.span())?],
            });
        }
        let size = columns.iter().map(Vec::len).max().unwrap_or(1);
        if let Some(odd) = columns.iter().position(|it| ![1, size].contains(&it.len())) {
            let message = format!(
                "expected a number or a vector of {size}, as the other argument is, found {}",
                values[odd].shape()
            );
            return mismatch(arguments[odd].span(), message);
        }
        let component = |row: usize| {
            let numbers = columns.iter().map(|it| it[row % it.len()]);
            self.of_components(name, arguments, &numbers.collect::<Vec<_>>())
        };
        let entries: Result<Vec<Expression>> = (0..size).map(component).collect();
        Ok(Value::column(entries?))
    }

    /// A function of one component of each argument.
    fn of_components(
        &mut self,
        name: &Ident,
        written: &[Expr],
        numbers: &[Expression],
    ) -> Result<Expression> {
        match (name.unraw().to_string().as_str(), numbers) {
            ("sin", [angle]) => Ok(self.pool.sine(*angle)),
            ("cos", [angle]) => Ok(self.pool.cosine(*angle)),
            // The angle of a slope is that of a point above one; a point may have a unit, and a slope has none.
            ("atan", [slope]) => {
                self.names.takes_pure(name.span(), "atan", *slope);
                Ok(self.pool.call(Function::Atan2, &[*slope, Expression::ONE]))
            }
            ("mod", [value, period]) => self.remainder(*value, (*period, &written[1])),
            ("floor", [value]) => {
                let fraction = self.pool.call(Function::Fraction, &[*value]);
                Ok(self.pool.subtract(*value, fraction))
            }
            ("pow" | "powi", [base, exponent]) => self.power(name, written, [*base, *exponent]),
            (_, numbers) => match elementary(name) {
                Some(function) => Ok(self.pool.call(function, numbers)),
                None => Err(Box::new(no_function(name, written))),
            },
        }
    }

    /// What is left of a value beyond whole periods of it.
    fn remainder(
        &mut self,
        value: Expression,
        (period, written): (Expression, &Expr),
    ) -> Result<Expression> {
        let Some(turns) = self.pool.divide(value, period) else {
            let message = "there is nothing between periods that last for zero";
            return Err(Box::new(error(codes::NOT_FINITE, written.span(), message)));
        };
        let fraction = self.pool.call(Function::Fraction, &[turns]);
        Ok(self.pool.multiply(period, fraction))
    }

    /// `pow`, and `powi`, which takes whole exponents only.
    fn power(
        &mut self,
        name: &Ident,
        written: &[Expr],
        [base, exponent]: [Expression; 2],
    ) -> Result<Expression> {
        let value = self.pool.constant_value(exponent);
        let is_whole = value.is_some_and(|it| it.fract() == 0.0 && it.abs() <= LARGEST_POWER);
        if name == "powi" && !is_whole {
            let message = "expected an integer exponent between -64 and 64";
            let report = error(codes::EXPRESSION, written[1].span(), message);
            let help = elsewhere::power(&written[0], &written[1]);
            return Err(Box::new(report.help(help)));
        }
        self.pool.real_power(base, exponent).ok_or_else(|| {
            let message = "this divides by zero, whatever the state";
            Box::new(error(codes::NOT_FINITE, written[0].span(), message))
        })
    }

    /// The exponent of a power. One that is written as a number has no unit, whatever other numbers may carry.
    fn exponent(&mut self, exponent: &Expr) -> Result<Value> {
        let number = elsewhere::number(exponent);
        let literal = number.and_then(|it| self.pool.literal(&format!("{:?}", it.abs())));
        match (number, literal) {
            (Some(number), Some(literal)) => Ok(Value::Scalar(literal.flipped(number < 0.0))),
            _ => self.evaluate(exponent),
        }
    }
}

/// How many arguments a function of numbers takes, if that is one.
fn arity(name: &Ident) -> Option<usize> {
    match name.unraw().to_string().as_str() {
        "sin" | "cos" | "atan" | "floor" => Some(1),
        "mod" | "pow" | "powi" => Some(2),
        _ => elementary(name).map(Function::arity),
    }
}

fn is_power(name: &Ident) -> bool {
    name == "pow" || name == "powi"
}

/// A function that processors or their libraries work out by itself.
fn elementary(name: &Ident) -> Option<Function> {
    let mut functions = Function::ALL.into_iter();
    let found = functions.find(|function| name == function.name());
    found.filter(|function| *function != Function::SelectLess)
}

/// A name that is no function, with what to write in its place.
fn no_function(name: &Ident, arguments: &[Expr]) -> Diagnostic {
    let message = format!("`{name}` is not a function of the language");
    let report = error(codes::UNKNOWN_NAME, name.span(), message);
    let text = name.to_string();
    let instead = elsewhere::instead(&text, arguments);
    match instead.or_else(|| signals::block(&text, "y")) {
        Some(help) => report.help(help),
        None => {
            let known = format!("functions are {}", FUNCTIONS.join(", "));
            report.did_you_mean(&text, &FUNCTIONS).help(known)
        }
    }
}

/// A curve takes a value, places and values.
fn no_curve(name: &Ident, arguments: &[Expr]) -> Diagnostic {
    let message = "expected `interpolate(x, places, values)`";
    let report = error(codes::EXPRESSION, name.span(), message);
    let points = elsewhere::curve_of_points(arguments).map(|it| format!("write `{it}`"));
    match points.or_else(|| elsewhere::map(arguments)) {
        Some(help) => report.help(help),
        None => report,
    }
}

/// A function takes so many arguments.
fn check_count(name: &Ident, expected: usize, arguments: &[Expr]) -> Result<()> {
    let found = arguments.len();
    if expected == found {
        return Ok(());
    }
    let noun = if expected == 1 {
        "argument"
    } else {
        "arguments"
    };
    let message = format!("`{name}` takes {expected} {noun}, found {found}");
    let report = error(codes::EXPRESSION, name.span(), message);
    Err(Box::new(match of_several(name, arguments) {
        Some(written) => report.help(format!("write `{written}`")),
        None => report,
    }))
}

/// The least or the greatest of more than two values.
fn of_several(name: &Ident, arguments: &[Expr]) -> Option<String> {
    let (last, others) = arguments.split_last()?;
    let nested = others
        .iter()
        .rev()
        .fold(dump::expression(last), |inner, outer| {
            format!("{name}({}, {inner})", dump::expression(outer))
        });
    (["min", "max"].iter().any(|it| name == it) && others.len() > 1).then_some(nested)
}
