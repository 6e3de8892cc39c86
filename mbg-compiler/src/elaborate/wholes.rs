//! Whole numbers that are known while a model is compiled: the bounds of loops, indices, and what they are made of.

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::Ident;
use syn::spanned::Spanned;
use syn::{BinOp, Expr, Lit, UnOp};

use super::expressions::Result;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::syntax::ast::{Component, Instance, Loop, Statement};
use crate::syntax::dump;

/// The names in one scope that stand for whole numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Wholes(BTreeMap<String, i64>);

impl Wholes {
    /// Those of a model.
    pub(super) fn of_model(statements: &[Statement]) -> Self {
        let mut wholes = Self::default();
        wholes.add(values(statements).collect());
        wholes
    }

    /// Those of a component, called from a scope with these.
    pub(super) fn of_instance(&self, instance: &Instance, component: &Component) -> Self {
        let mut inner = Self::default();
        let mut own: Vec<(&Ident, &Expr)> = values(&component.statements).collect();
        for parameter in component.parameters() {
            match (instance.argument(&parameter.name), &parameter.default) {
                (Some((_, argument)), _) => {
                    if let Ok(number) = self.evaluate(argument) {
                        inner.0.insert(parameter.name.to_string(), number);
                    }
                }
                (None, Some(default)) => own.push((&parameter.name, default)),
                (None, None) => {}
            }
        }
        inner.add(own);
        inner
    }

    /// Those of one iteration of a loop in a scope with these; without the number, what holds for every iteration.
    pub(super) fn of_iteration(&self, repeated: &Loop, number: Option<i64>) -> Self {
        let mut inner = self.clone();
        for (name, _) in values(&repeated.statements) {
            inner.0.remove(&name.to_string());
        }
        let variable = repeated.variable.to_string();
        match number {
            Some(number) => inner.0.insert(variable, number),
            None => inner.0.remove(&variable),
        };
        inner.add(values(&repeated.statements).collect());
        inner
    }

    /// Adds what turns out to be whole, whatever the order of declaration.
    fn add(&mut self, mut values: Vec<(&Ident, &Expr)>) {
        loop {
            let before = values.len();
            values.retain(|(name, value)| match self.evaluate(value) {
                Ok(number) => {
                    self.0.insert(name.to_string(), number);
                    false
                }
                Err(_) => true,
            });
            if values.len() == before {
                return;
            }
        }
    }

    /// The numbers that a loop's variable takes.
    pub(super) fn range(&self, repeated: &Loop) -> Result<Range<i64>> {
        Ok(self.evaluate(&repeated.start)?..self.evaluate(&repeated.end)?)
    }

    /// The number that an expression stands for.
    pub(super) fn evaluate(&self, expression: &Expr) -> Result<i64> {
        self.number(expression).ok_or_else(|| unknown(expression))
    }

    fn number(&self, expression: &Expr) -> Option<i64> {
        match expression {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Int(number) if number.suffix().is_empty() => number.base10_parse().ok(),
                _ => None,
            },
            Expr::Path(path) => self.0.get(&path.path.get_ident()?.to_string()).copied(),
            Expr::Paren(inner) => self.number(&inner.expr),
            Expr::Group(inner) => self.number(&inner.expr),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
                self.number(&unary.expr)?.checked_neg()
            }
            Expr::Binary(binary) => {
                let (left, right) = (self.number(&binary.left)?, self.number(&binary.right)?);
                match binary.op {
                    BinOp::Add(_) => left.checked_add(right),
                    BinOp::Sub(_) => left.checked_sub(right),
                    BinOp::Mul(_) => left.checked_mul(right),
                    // A quotient that is not whole is no whole number, rather than a rounded one.
                    BinOp::Div(_) if left.checked_rem(right)? == 0 => left.checked_div(right),
                    BinOp::Rem(_) => left.checked_rem_euclid(right),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// The named values among statements; a vector is no whole number.
fn values(statements: &[Statement]) -> impl Iterator<Item = (&Ident, &Expr)> {
    statements.iter().filter_map(|statement| match statement {
        Statement::Let(named) if named.dimension.is_none() => Some((&named.name, &named.value)),
        _ => None,
    })
}

fn unknown(expression: &Expr) -> Box<Diagnostic> {
    let message = format!(
        "expected a whole number that is known while the model is compiled, found `{}`",
        dump::expression(expression)
    );
    let report = error(codes::WHOLE_NUMBER, expression.span(), message);
    Box::new(
        report
            .help("it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers")
            .help("a `param` of a model is no such number, because it can change after the model is compiled"),
    )
}
