//! What a model asserts of its parameters.

use proc_macro2::Ident;
use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprBinary};

use super::Builder;
use super::expressions::Result;
use super::model::{Assumption, Condition};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::{Expression, Function, Rate};
use crate::syntax::dump;

impl Builder<'_> {
    /// Checks a comparison, or several joined by `&&`: of numbers now, of parameters when a model is made.
    pub(super) fn assertion(&mut self, scope: usize, word: &Ident, condition: &Expr) -> Result<()> {
        match condition {
            Expr::Paren(inner) => self.assertion(scope, word, &inner.expr),
            Expr::Group(inner) => self.assertion(scope, word, &inner.expr),
            Expr::Binary(both) if matches!(both.op, BinOp::And(_)) => {
                self.assertion(scope, word, &both.left)?;
                self.assertion(scope, word, &both.right)
            }
            Expr::Binary(comparison) => self.comparison(scope, word, comparison),
            _ => Err(no_comparison(condition)),
        }
    }

    fn comparison(&mut self, scope: usize, word: &Ident, comparison: &ExprBinary) -> Result<()> {
        let whole = Expr::Binary(comparison.clone());
        let [left, right] = [
            self.vector(scope, &comparison.left, 1, word)?[0],
            self.vector(scope, &comparison.right, 1, word)?[0],
        ];
        let (smaller, larger, condition) = match comparison.op {
            BinOp::Lt(_) => (left, right, Condition::Positive),
            BinOp::Gt(_) => (right, left, Condition::Positive),
            BinOp::Le(_) => (left, right, Condition::NotNegative),
            BinOp::Ge(_) => (right, left, Condition::NotNegative),
            BinOp::Ne(_) => (right, left, Condition::NonZero),
            _ => return Err(no_comparison(&whole)),
        };
        let difference = self.pool.subtract(larger, smaller);
        let text = dump::expression(&whole);
        let compared = [left, right, Expression::ONE, Expression::ZERO];
        let compared = self.pool.call(Function::SelectLess, &compared);
        self.claim_value(scope, word, None, &[compared], whole.span());
        match (
            self.pool.rate(difference),
            self.pool.constant_value(difference),
        ) {
            (_, Some(difference)) => {
                let holds = match condition {
                    Condition::Positive => difference > 0.0,
                    Condition::NotNegative => difference >= 0.0,
                    Condition::NonZero => difference != 0.0,
                };
                match holds {
                    true => Ok(()),
                    false => {
                        let values = [left, right].map(|it| self.pool.constant_value(it));
                        let instance = self.scopes[scope].prefix.trim_end_matches('.');
                        Err(Box::new(broken(&whole, &text, instance, values)))
                    }
                }
            }
            // What a component is given may be a signal, which nothing but a run of it can tell to be within its bounds.
            (Rate::Varying, None) if self.scopes[scope].library.is_some() => Ok(()),
            (Rate::Varying, None) => {
                let message = format!("`{text}` may change while the model runs");
                let report = error(codes::EXPRESSION, whole.span(), message);
                Err(Box::new(report.help(margin(comparison))))
            }
            _ => {
                let assumption = Assumption {
                    expression: difference,
                    condition,
                    reason: format!("`{text}` is asserted"),
                };
                if !self.assumptions.contains(&assumption) {
                    self.assumptions.push(assumption);
                }
                Ok(())
            }
        }
    }
}

/// An assertion of numbers that does not hold.
fn broken(whole: &Expr, text: &str, instance: &str, values: [Option<f64>; 2]) -> Diagnostic {
    let of = match instance {
        "" => String::new(),
        _ => format!(" of `{instance}`"),
    };
    let message = match values {
        [Some(left), Some(right)] => {
            format!("`{text}` is asserted{of}, and these are {left:?} and {right:?}")
        }
        _ => format!("`{text}` is asserted{of}, and does not hold"),
    };
    error(codes::EXPRESSION, whole.span(), message)
}

/// What to type where states or inputs are compared.
fn margin(comparison: &ExprBinary) -> String {
    let (left, right) = (&comparison.left, &comparison.right);
    let (large, small) = match comparison.op {
        BinOp::Gt(_) | BinOp::Ge(_) => (left, right),
        _ => (right, left),
    };
    let small = match **small {
        Expr::Binary(_) | Expr::If(_) => format!("({})", dump::expression(small)),
        _ => dump::expression(small),
    };
    let large = dump::expression(large);
    format!(
        "an assertion is of numbers and parameters: what runs the model checks an output that is positive while all is well, \
         `output margin = {large} - {small};`"
    )
}

fn no_comparison(found: &Expr) -> Box<Diagnostic> {
    let message = format!("expected a comparison, found `{}`", dump::expression(found));
    let report = error(codes::EXPRESSION, found.span(), message);
    Box::new(report.help("an assertion is `assert a < b;`, with `<`, `<=`, `>`, `>=` or `!=`, several of them joined by `&&`"))
}
