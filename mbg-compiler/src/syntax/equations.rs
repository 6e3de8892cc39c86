//! Equations and states in the braces of an element, as other languages write laws, and the words for them here.

use proc_macro2::{Group, TokenStream, TokenTree};
use quote::ToTokens;
use syn::{BinOp, Expr, UnOp};

use super::ast::ElementKind;
use super::slips::is_mark;
use super::{dump, words};

/// What to type for the first equation in the braces of an element.
pub(super) fn law(fields: &Group, kind: ElementKind) -> Option<String> {
    let tokens: Vec<TokenTree> = fields.stream().into_iter().collect();
    let mut parts = tokens.split(|token| is_mark(token, ',') || is_mark(token, ';'));
    let [left, right] = parts.find_map(sides)?;
    match left {
        [TokenTree::Ident(rate), TokenTree::Group(state)] if rate == "der" => {
            let state = dump::tokens(state.stream());
            Some(format!(
                "how `{state}` changes is known of the element: leave this out"
            ))
        }
        [TokenTree::Ident(word), TokenTree::Ident(_)] if word == "state" => {
            let value = dump::tokens(right.iter().cloned().collect());
            start(kind, &value)
        }
        [TokenTree::Ident(word)] if words::law_words(kind).iter().any(|law| word == law) => {
            let value = dump::tokens(right.iter().cloned().collect());
            Some(format!("a value follows a colon: write `{word}: {value}`"))
        }
        _ => {
            let mut ways = ways(kind).iter();
            let solved = ways.find_map(|(word, variable, _)| {
                let value = solved(left, right, variable)?;
                Some(format!("a law gives the {word}: write `{word}: {value}`"))
            });
            solved.or_else(|| unsolved(kind))
        }
    }
}

/// The laws of an element in its own variables: the word, the variable that it gives, and what it reads.
const fn ways(kind: ElementKind) -> &'static [(&'static str, &'static str, &'static str)] {
    match kind {
        ElementKind::R => &[("effort", "e", " in `f`"), ("flow", "f", " in `e`")],
        ElementKind::C => &[("effort", "e", " in `q`")],
        ElementKind::I => &[("flow", "f", " in `p`")],
        ElementKind::Se => &[("effort", "e", "")],
        ElementKind::Sf => &[("flow", "f", "")],
        _ => &[],
    }
}

fn unsolved(kind: ElementKind) -> Option<String> {
    let ways = ways(kind).iter();
    let ways: Vec<String> = ways
        .map(|(word, _, reads)| format!("`{word}: …`{reads}"))
        .collect();
    (!ways.is_empty()).then(|| {
        format!(
            "a law is no equation, but gives one variable: write {}",
            ways.join(" or ")
        )
    })
}

/// What to type for `state q = 1.0` in the braces of an element.
fn start(kind: ElementKind, value: &str) -> Option<String> {
    let state = match kind {
        ElementKind::C => "q",
        ElementKind::I => "p",
        _ => return None,
    };
    Some(format!(
        "its state is `{state}` without being declared: write `initial: {value}` for the start"
    ))
}

/// Both sides of the only sign of equality in these tokens.
fn sides(tokens: &[TokenTree]) -> Option<[&[TokenTree]; 2]> {
    let is_sign = |at: usize| tokens.get(at).is_some_and(|token| is_mark(token, '='));
    let first = (0..tokens.len()).find(|at| is_sign(*at))?;
    let behind = first + 1 + usize::from(is_sign(first + 1));
    let is_compared = first.checked_sub(1).is_some_and(|at| {
        ['<', '>', '!']
            .iter()
            .any(|mark| is_mark(&tokens[at], *mark))
    });
    let (left, right) = (&tokens[..first], &tokens[behind..]);
    let is_alone = !left.is_empty() && !right.is_empty() && !is_compared;
    (is_alone && (behind..tokens.len()).all(|at| !is_sign(at))).then_some([left, right])
}

/// What a variable is by an equation in which it is one of the summands; none where it is read elsewhere, too.
fn solved(left: &[TokenTree], right: &[TokenTree], variable: &str) -> Option<String> {
    let parsed = |side: &[TokenTree]| syn::parse2::<Expr>(side.iter().cloned().collect()).ok();
    let mut terms = Vec::new();
    summands(&parsed(left)?, false, &mut terms);
    summands(&parsed(right)?, true, &mut terms);
    let is_variable =
        |term: &Expr| matches!(term, Expr::Path(path) if path.path.is_ident(variable));
    let place = terms.iter().position(|(_, term)| is_variable(term))?;
    let (is_negative, _) = terms.remove(place);
    let is_read = |(_, term): &(bool, Expr)| mentions(term.to_token_stream(), variable);
    if terms.iter().any(is_read) {
        return None;
    }
    let mut text = String::new();
    // What is left stands on the other side, where a positive one comes first.
    let mut moved: Vec<(bool, Expr)> = terms
        .into_iter()
        .map(|(sign, term)| (sign == is_negative, term))
        .collect();
    moved.sort_by_key(|(is_negative, _)| *is_negative);
    for (is_negative, term) in moved {
        text += match (text.is_empty(), is_negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += &dump::expression(&term);
    }
    Some(if text.is_empty() {
        "0.0".to_owned()
    } else {
        text
    })
}

/// The summands of an expression but for zeros, and whether each is subtracted.
fn summands(expression: &Expr, is_negative: bool, terms: &mut Vec<(bool, Expr)>) {
    match expression {
        Expr::Paren(inner) => summands(&inner.expr, is_negative, terms),
        Expr::Group(inner) => summands(&inner.expr, is_negative, terms),
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
            summands(&unary.expr, !is_negative, terms);
        }
        Expr::Binary(binary) => match binary.op {
            BinOp::Add(_) | BinOp::Sub(_) => {
                let is_subtracted = matches!(binary.op, BinOp::Sub(_));
                summands(&binary.left, is_negative, terms);
                summands(&binary.right, is_negative != is_subtracted, terms);
            }
            _ => terms.push((is_negative, expression.clone())),
        },
        Expr::Lit(literal) if is_zero(&literal.lit) => {}
        _ => terms.push((is_negative, expression.clone())),
    }
}

fn is_zero(literal: &syn::Lit) -> bool {
    let text = literal.to_token_stream().to_string();
    text.parse::<f64>() == Ok(0.0)
}

/// Whether tokens hold this name.
fn mentions(tokens: TokenStream, name: &str) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(word) => word == name,
        TokenTree::Group(group) => mentions(group.stream(), name),
        _ => false,
    })
}
