//! Choices between values: `if` in an expression.

use syn::spanned::Spanned;
use syn::{BinOp, Expr, UnOp};

use super::expressions::{Evaluator, Names, Result, Value, fail, number};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::{Expression, Function};
use crate::syntax::dump;

/// What a choice between values depends on.
enum Test {
    /// It is decided while the model is compiled.
    Known(bool),
    /// Whether the first is less than the second.
    Less(Expression, Expression),
    Not(Box<Self>),
    Both(Box<Self>, Box<Self>),
    Either(Box<Self>, Box<Self>),
}

const NO_TEST: &str = "expected a comparison with < <= > or >=";

impl<N: Names> Evaluator<'_, N> {
    pub(super) fn choice(&mut self, choice: &syn::ExprIf) -> Result<Value> {
        let Some((_, otherwise)) = &choice.else_branch else {
            let message = "expected an `else`: an `if` has a value on both sides";
            let report = error(codes::EXPRESSION, choice.span(), message);
            return Err(Box::new(report.help(
                "where it adds nothing otherwise, write `else { 0.0 }` behind it",
            )));
        };
        let test = self.test(&choice.cond)?;
        // What is known chooses while the model is compiled: the other branch need not even exist.
        if let Test::Known(holds) = test {
            return if holds {
                self.branch(&choice.then_branch)
            } else {
                self.evaluate(otherwise)
            };
        }
        let yes = number(
            &self.branch(&choice.then_branch)?,
            choice.then_branch.span(),
        )?;
        let no = self.scalar(otherwise)?;
        Ok(Value::Scalar(self.select(&test, yes, no)))
    }

    fn test(&mut self, condition: &Expr) -> Result<Test> {
        match self.names.decide(condition) {
            Ok(known) => return Ok(Test::Known(known)),
            Err(report) if report.code != codes::CONDITION => return Err(report),
            Err(_) => {}
        }
        match condition {
            Expr::Paren(inner) => self.test(&inner.expr),
            Expr::Group(inner) => self.test(&inner.expr),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                Ok(Test::Not(Box::new(self.test(&unary.expr)?)))
            }
            Expr::Binary(binary) => self.comparison(binary),
            _ => {
                let report = error(codes::EXPRESSION, condition.span(), NO_TEST);
                Err(Box::new(report.help(of_zero_or_one(condition, true))))
            }
        }
    }

    fn comparison(&mut self, binary: &syn::ExprBinary) -> Result<Test> {
        let join = match binary.op {
            BinOp::And(_) => Test::Both,
            BinOp::Or(_) => Test::Either,
            BinOp::Lt(_) | BinOp::Gt(_) | BinOp::Le(_) | BinOp::Ge(_) => {
                let (a, b) = (self.scalar(&binary.left)?, self.scalar(&binary.right)?);
                return Ok(match binary.op {
                    BinOp::Lt(_) => Test::Less(a, b),
                    BinOp::Gt(_) => Test::Less(b, a),
                    BinOp::Le(_) => Test::Not(Box::new(Test::Less(b, a))),
                    _ => Test::Not(Box::new(Test::Less(a, b))),
                });
            }
            BinOp::Eq(_) | BinOp::Ne(_) => {
                if let Some(report) = self.of_whole_numbers(binary) {
                    return Err(report);
                }
                let report = error(codes::EXPRESSION, binary.op.span(), NO_TEST);
                let is_one = match dump::expression(&binary.right).as_str() {
                    "1" | "1.0" => true,
                    "0" | "0.0" => false,
                    _ => return Err(Box::new(report)),
                };
                let is_set = is_one == matches!(binary.op, BinOp::Eq(_));
                return Err(Box::new(report.help(of_zero_or_one(&binary.left, is_set))));
            }
            _ => return fail(binary.op.span(), NO_TEST),
        };
        let (left, right) = (self.test(&binary.left)?, self.test(&binary.right)?);
        Ok(join(Box::new(left), Box::new(right)))
    }

    /// What to type where a whole number, such as that of a loop, is compared with `2.0`.
    fn of_whole_numbers(&self, binary: &syn::ExprBinary) -> Option<Box<Diagnostic>> {
        let mut meant = binary.clone();
        let (side, other) = match (whole(&binary.left), whole(&binary.right)) {
            (Some(left), None) => {
                *meant.left = left;
                (&*binary.left, &*binary.right)
            }
            (None, Some(right)) => {
                *meant.right = right;
                (&*binary.right, &*binary.left)
            }
            _ => return None,
        };
        let meant = Expr::Binary(meant);
        self.names.decide(&meant).ok()?;
        let [side, other, meant] = [side, other, &meant].map(dump::expression);
        let message = format!("`{other}` is a whole number here, and `{side}` is none");
        let report = error(codes::EXPRESSION, binary.op.span(), message);
        Some(Box::new(report.help(format!("write `{meant}`"))))
    }

    /// One of two values, by selections inside each other.
    fn select(&mut self, test: &Test, yes: Expression, no: Expression) -> Expression {
        match test {
            _ if yes == no => yes,
            Test::Known(true) => yes,
            Test::Known(false) => no,
            Test::Less(a, b) => self.pool.call(Function::SelectLess, &[*a, *b, yes, no]),
            Test::Not(test) => self.select(test, no, yes),
            Test::Both(first, second) => {
                let yes = self.select(second, yes, no);
                self.select(first, yes, no)
            }
            Test::Either(first, second) => {
                let no = self.select(second, yes, no);
                self.select(first, yes, no)
            }
        }
    }

    pub(super) fn branch(&mut self, block: &syn::Block) -> Result<Value> {
        match block.stmts.as_slice() {
            [syn::Stmt::Expr(expression, None)] => self.evaluate(expression),
            _ => fail(block.span(), "expected one expression"),
        }
    }
}

/// A number without the point behind which nothing stands.
fn whole(number: &Expr) -> Option<Expr> {
    let text = dump::expression(number);
    let (digits, fraction) = text.split_once('.')?;
    let is_whole = fraction.chars().all(|digit| digit == '0');
    let number: u64 = digits.parse().ok().filter(|_| is_whole)?;
    syn::parse_str(&number.to_string()).ok()
}

/// How to ask whether a value that is 0 or 1 is 1.
fn of_zero_or_one(value: &Expr, is_one: bool) -> String {
    let sign = if is_one { '>' } else { '<' };
    let value = dump::expression(value);
    format!("of a value that is 0 or 1 write `{value} {sign} 0.5`")
}
