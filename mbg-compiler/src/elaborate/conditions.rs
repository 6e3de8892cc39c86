//! Conditions that are decided while a model is compiled, and the statements that they choose.

use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprBinary, ExprCall, UnOp};

use super::constants::{Chosen, Constants, plain_name};
use super::elsewhere;
use super::expressions::Result;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::syntax::ast::{Conditional, Statement};
use crate::syntax::dump;
use crate::syntax::words::alternatives;

impl Constants {
    /// The statements with those in place that their `if`s choose; an `if` that is not decided chooses none.
    pub(super) fn chosen<'s>(&self, statements: &'s [Statement]) -> Vec<&'s Statement> {
        let mut chosen = Vec::new();
        for statement in statements {
            match statement {
                Statement::Conditional(conditional) => {
                    let branch = self.branch(conditional).unwrap_or_default();
                    chosen.extend(self.chosen(branch));
                }
                other => chosen.push(other),
            }
        }
        chosen
    }

    /// The statements of the first branch whose condition holds; none where there is no such branch.
    pub(super) fn branch<'s>(&self, conditional: &'s Conditional) -> Result<&'s [Statement]> {
        for branch in &conditional.branches {
            let holds = match &branch.condition {
                Some(condition) => self.decide(condition)?,
                None => true,
            };
            if holds {
                return Ok(&branch.statements);
            }
        }
        Ok(&[])
    }

    /// Whether a condition holds.
    pub(super) fn decide(&self, condition: &Expr) -> Result<bool> {
        match condition {
            Expr::Paren(inner) => self.decide(&inner.expr),
            Expr::Group(inner) => self.decide(&inner.expr),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                Ok(!self.decide(&unary.expr)?)
            }
            Expr::Binary(binary) => match binary.op {
                BinOp::And(_) => Ok(self.decide(&binary.left)? && self.decide(&binary.right)?),
                BinOp::Or(_) => Ok(self.decide(&binary.left)? || self.decide(&binary.right)?),
                _ => self.compare(binary),
            },
            Expr::Call(call) => self.is_given(call),
            _ => Err(undecided(condition)),
        }
    }

    fn compare(&self, binary: &ExprBinary) -> Result<bool> {
        for (choice, word) in [(&binary.left, &binary.right), (&binary.right, &binary.left)] {
            if let Some(chosen) = plain_name(choice).and_then(|name| self.chosen.get(&name)) {
                return match binary.op {
                    BinOp::Eq(_) => is_chosen(chosen, word),
                    BinOp::Ne(_) => Ok(!is_chosen(chosen, word)?),
                    _ => Err(undecided(&Expr::Binary(binary.clone()))),
                };
            }
        }
        let unknown = |_| undecided(&Expr::Binary(binary.clone()));
        let left = self.evaluate(&binary.left).map_err(unknown)?;
        let right = self.evaluate(&binary.right).map_err(unknown)?;
        match binary.op {
            BinOp::Lt(_) => Ok(left < right),
            BinOp::Gt(_) => Ok(left > right),
            BinOp::Le(_) => Ok(left <= right),
            BinOp::Ge(_) => Ok(left >= right),
            BinOp::Eq(_) => Ok(left == right),
            BinOp::Ne(_) => Ok(left != right),
            _ => Err(undecided(&Expr::Binary(binary.clone()))),
        }
    }

    /// `given(parameter)`: whether the call gives the parameter a value.
    fn is_given(&self, call: &ExprCall) -> Result<bool> {
        let parameter = call.args.first().and_then(plain_name);
        match parameter {
            Some(parameter)
                if call.args.len() == 1 && plain_name(&call.func).as_deref() == Some("given") =>
            {
                self.given.get(&parameter).copied().ok_or_else(|| {
                    let message = format!("`{parameter}` is no parameter of this component");
                    let report = error(codes::UNKNOWN_NAME, call.args.span(), message);
                    let known: Vec<&str> = self.given.keys().map(String::as_str).collect();
                    Box::new(report.did_you_mean(&parameter, &known))
                })
            }
            _ => Err(undecided(&Expr::Call(call.clone()))),
        }
    }
}

/// Whether this word was chosen; one that could never be is a mistake.
fn is_chosen(chosen: &Chosen, word: &Expr) -> Result<bool> {
    match plain_name(word) {
        Some(word) if chosen.words.contains(&word) => Ok(word == chosen.word),
        _ => Err(no_word(word, &chosen.words)),
    }
}

/// An expression that is none of the words of a choice.
pub(super) fn no_word(found: &Expr, words: &[String]) -> Box<Diagnostic> {
    let text = dump::expression(found);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let message = format!("expected {}, found `{text}`", alternatives(&words));
    let report = error(codes::WORD, found.span(), message);
    Box::new(
        match elsewhere::choice(&text).filter(|word| words.contains(word)) {
            Some(word) => report.help(format!("write `{word}`")),
            None => report.did_you_mean(&text, &words),
        },
    )
}

fn undecided(condition: &Expr) -> Box<Diagnostic> {
    let message = format!(
        "expected a condition that is decided while the model is compiled, found `{}`",
        dump::expression(condition)
    );
    let report = error(codes::CONDITION, condition.span(), message);
    Box::new(
        report
            .help("it compares whole numbers that are known then, or a parameter with one of its words, as in `blocked == ideal`")
            .help("it may ask `given(parameter)`, and join conditions by `&&`, `||` and `!`"),
    )
}
