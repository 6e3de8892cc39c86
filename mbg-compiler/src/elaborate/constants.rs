//! What is known while a model is compiled: whole numbers, the words of choices, and which parameters a call gives.
//!
//! Bounds of loops, indices and the conditions of `if`s are made of it.

use std::collections::BTreeMap;
use std::ops::Range;

use proc_macro2::Ident;
use syn::spanned::Spanned;
use syn::{BinOp, Block, Expr, Lit, Stmt, UnOp};

use super::elsewhere;
use super::expressions::{Result, Step};
use super::mentions::mentioned;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::syntax::ast::{Choice, Component, Conditional, Instance, Loop, Statement};
use crate::syntax::dump;

/// What is known in one scope.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Constants {
    /// Names that stand for whole numbers.
    numbers: BTreeMap<String, i64>,
    /// Parameters whose values are words.
    pub(super) chosen: BTreeMap<String, Chosen>,
    /// The other parameters of a component, and whether the call gives them.
    pub(super) given: BTreeMap<String, bool>,
    /// Parameters of the model that are a whole number unless a run changes them.
    changing: BTreeMap<String, i64>,
}

/// The value of a parameter that is a word.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Chosen {
    /// The word.
    pub(super) word: String,
    /// All from which it was chosen.
    pub(super) words: Vec<String>,
}

impl Constants {
    /// Those of a model.
    pub(super) fn of_model(statements: &[Statement]) -> Self {
        let mut constants = Self::default();
        // A model has no choices; that is told once, rather than wherever one is asked for.
        for statement in statements {
            if let Statement::Choice(choice) = statement {
                let name = choice.name.to_string();
                constants.chosen.insert(name, chosen(choice, None));
            }
        }
        constants.changing = statements.iter().filter_map(changing).collect();
        constants.add(Vec::new(), statements);
        constants
    }

    /// Those of a component, called from a scope with these.
    pub(super) fn of_instance(&self, instance: &Instance, component: &Component) -> Self {
        let mut inner = Self::default();
        for choice in component.choices() {
            let name = choice.name.to_string();
            let given = instance.argument(&choice.name);
            let given = given.and_then(|(_, argument)| self.word(argument));
            inner.chosen.insert(name, chosen(choice, given));
        }
        let mut own: Vec<(&Ident, &Expr)> = Vec::new();
        for parameter in component.parameters() {
            let name = parameter.name.to_string();
            let argument = instance.argument(&parameter.name);
            match (argument, &parameter.default) {
                (Some((_, argument)), _) => {
                    if let Some(number) = self.number(argument) {
                        inner.numbers.insert(name.clone(), number);
                    }
                }
                (None, Some(default)) => own.push((&parameter.name, default)),
                (None, None) => {}
            }
            let given = argument.is_some_and(|(_, argument)| self.gives(argument));
            inner.given.insert(name, given);
        }
        inner.add(own, &component.statements);
        inner
    }

    /// The word that an argument stands for: itself, unless it names a choice of the calling component.
    pub(super) fn word(&self, argument: &Expr) -> Option<String> {
        let name = plain_name(argument)?;
        let handed_on = self.chosen.get(&name).map(|chosen| chosen.word.clone());
        Some(handed_on.unwrap_or(name))
    }

    /// Whether an argument gives a value: it does not where it hands on a parameter that was not given itself.
    fn gives(&self, argument: &Expr) -> bool {
        plain_name(argument)
            .and_then(|name| self.given.get(&name).copied())
            .unwrap_or(true)
    }

    /// Those of one iteration of a loop in a scope with these; without the number, what holds for every iteration.
    pub(super) fn of_iteration(&self, repeated: &Loop, number: Option<i64>) -> Self {
        let mut inner = self.clone();
        inner.hide(&repeated.statements);
        let variable = repeated.variable.to_string();
        match number {
            Some(number) => inner.numbers.insert(variable, number),
            None => inner.numbers.remove(&variable),
        };
        inner.add(Vec::new(), &repeated.statements);
        inner
    }

    /// Forgets the names that statements may give another meaning.
    fn hide(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Let(named) => {
                    self.numbers.remove(&named.name.to_string());
                }
                Statement::Conditional(conditional) => conditional
                    .branches
                    .iter()
                    .for_each(|branch| self.hide(&branch.statements)),
                _ => {}
            }
        }
    }

    /// Adds what turns out to be whole, whatever the order of declaration.
    fn add<'s>(&mut self, mut values: Vec<(&'s Ident, &'s Expr)>, statements: &'s [Statement]) {
        let mut conditionals = Vec::new();
        sort(statements, &mut values, &mut conditionals);
        let mut progress = true;
        while progress {
            progress = false;
            for (name, value) in std::mem::take(&mut values) {
                match self.number(value) {
                    Some(number) => {
                        self.numbers.insert(name.to_string(), number);
                        progress = true;
                    }
                    None => values.push((name, value)),
                }
            }
            // A value may decide an `if`, which brings more values.
            for conditional in std::mem::take(&mut conditionals) {
                match self.branch(conditional) {
                    Ok(chosen) => {
                        sort(chosen, &mut values, &mut conditionals);
                        progress = true;
                    }
                    Err(_) => conditionals.push(conditional),
                }
            }
        }
    }

    /// The numbers that a loop's variable takes.
    pub(super) fn range(&self, repeated: &Loop) -> Result<Range<i64>> {
        Ok(self.evaluate(&repeated.start)?..self.evaluate(&repeated.end)?)
    }

    /// The number that a name stands for.
    pub(super) fn named(&self, name: &Ident) -> Option<i64> {
        self.numbers.get(&name.to_string()).copied()
    }

    /// The number that an expression stands for.
    pub(super) fn evaluate(&self, expression: &Expr) -> Result<i64> {
        self.number(expression)
            .ok_or_else(|| match self.broken(expression) {
                Some(report) => report,
                None => self.unknown(expression),
            })
    }

    /// What is wrong with a number that is known and no whole number, or a larger one than can be held.
    fn broken(&self, expression: &Expr) -> Option<Box<Diagnostic>> {
        // Beside what is wrong with it a part may be right.
        if self.number(expression).is_some() {
            return None;
        }
        let refused = |which: String| {
            let text = dump::expression(expression);
            let message = format!("expected a whole number, found `{text}`, which {which}");
            error(codes::WHOLE_NUMBER, expression.span(), message)
        };
        let large = || Box::new(refused(format!("is beyond the largest, {}", i64::MAX)));
        let binary = match expression {
            Expr::Paren(inner) => return self.broken(&inner.expr),
            Expr::Group(inner) => return self.broken(&inner.expr),
            Expr::Unary(unary) => return self.broken(&unary.expr),
            Expr::Lit(literal) => {
                let is_whole = matches!(&literal.lit, Lit::Int(it) if it.suffix().is_empty());
                return is_whole.then(large);
            }
            Expr::Binary(binary) => binary,
            _ => return None,
        };
        let (left, right) = (self.number(&binary.left), self.number(&binary.right));
        let (Some(left), Some(right)) = (left, right) else {
            let mut parts = [&binary.left, &binary.right].into_iter();
            return parts.find_map(|part| self.broken(part));
        };
        match binary.op {
            BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) => Some(large()),
            BinOp::Div(_) | BinOp::Rem(_) if right == 0 => {
                Some(Box::new(refused("divides by zero".to_owned())))
            }
            BinOp::Div(_) => {
                let report = refused(format!("is {}", left as f64 / right as f64));
                let whole_part = elsewhere::whole_part(binary);
                Some(Box::new(
                    report.help(format!("its whole part is `{whole_part}`")),
                ))
            }
            _ => None,
        }
    }

    /// Refuses what is not known while the model is compiled, with what makes it known.
    fn unknown(&self, expression: &Expr) -> Box<Diagnostic> {
        let message = format!(
            "expected a whole number that is known while the model is compiled, found `{}`",
            dump::expression(expression)
        );
        let report = error(codes::WHOLE_NUMBER, expression.span(), message);
        if let Some(help) = without_point(expression).or_else(|| elsewhere::whole_call(expression))
        {
            return Box::new(report.help(help));
        }
        let mut named = mentioned(expression).into_iter();
        let parameter = named.find_map(|path| {
            let [Step { name, .. }] = &path[..] else {
                return None;
            };
            let number = self.changing.get(&name.to_string())?;
            Some((name.to_string(), number))
        });
        if let Some((name, number)) = parameter {
            return Box::new(report.help(format!(
                "a `param` of a model can change after the model is compiled: declare `let {name} = {number};` in its place"
            )));
        }
        Box::new(
            report
                .help("it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers")
                .help("a `param` of a model is no such number, because it can change after the model is compiled"),
        )
    }

    fn number(&self, expression: &Expr) -> Option<i64> {
        match expression {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Int(number) if number.suffix().is_empty() => number.base10_parse().ok(),
                _ => None,
            },
            Expr::Path(path) => self
                .numbers
                .get(&path.path.get_ident()?.to_string())
                .copied(),
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
            Expr::If(choice) => {
                if self.decide(&choice.cond).ok()? {
                    self.in_block(&choice.then_branch)
                } else {
                    self.number(&choice.else_branch.as_ref()?.1)
                }
            }
            Expr::Block(block) => self.in_block(&block.block),
            _ => None,
        }
    }

    fn in_block(&self, block: &Block) -> Option<i64> {
        match block.stmts.as_slice() {
            [Stmt::Expr(value, None)] => self.number(value),
            _ => None,
        }
    }
}

/// Picks out the named values, among which a vector is no whole number, and the `if`s.
fn sort<'s>(
    statements: &'s [Statement],
    values: &mut Vec<(&'s Ident, &'s Expr)>,
    conditionals: &mut Vec<&'s Conditional>,
) {
    for statement in statements {
        match statement {
            Statement::Let(named) if named.dimension.is_none() => {
                values.push((&named.name, &named.value));
            }
            Statement::Conditional(conditional) => conditionals.push(conditional),
            _ => {}
        }
    }
}

/// The word given, or else the default; a word that is not listed is told elsewhere.
fn chosen(choice: &Choice, given: Option<String>) -> Chosen {
    let words: Vec<String> = choice.words.iter().map(ToString::to_string).collect();
    let default = choice.default.as_ref().map(ToString::to_string);
    let word = given
        .filter(|word| words.contains(word))
        .or(default)
        .unwrap_or_else(|| words[0].clone());
    Chosen { word, words }
}

/// The name that an expression consists of.
pub(super) fn plain_name(expression: &Expr) -> Option<String> {
    match expression {
        Expr::Path(path) => Some(path.path.get_ident()?.to_string()),
        Expr::Paren(inner) => plain_name(&inner.expr),
        Expr::Group(inner) => plain_name(&inner.expr),
        _ => None,
    }
}

/// What to type for a whole number with a decimal point.
pub(super) fn without_point(expression: &Expr) -> Option<String> {
    let number = elsewhere::number(expression).filter(|it| it.fract() == 0.0 && it.abs() < 1e15)?;
    Some(format!(
        "a whole number has no decimal point: write `{number}`"
    ))
}

/// A parameter of a model whose default is whole.
fn changing(statement: &Statement) -> Option<(String, i64)> {
    let Statement::Parameter(parameter) = statement else {
        return None;
    };
    let default = elsewhere::number(parameter.default.as_ref()?)?;
    let is_whole = default.fract() == 0.0 && default.abs() < 1e15;
    is_whole.then_some((parameter.name.to_string(), default as i64))
}
