//! Choices between two values as other languages write them, and what to type instead.

use proc_macro2::{Delimiter, TokenTree};
use quote::ToTokens;
use syn::Expr;

use super::slips::is_mark;
use super::words::THEN;
use super::{dump, slips};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};

/// What begins another choice where the one before it was not made.
const ELSE_IF: &[&str] = &["elseif", "elsif", "elif"];

/// What to write for `a ? b : c`, `if a then b else c` or `b if a else c` among these tokens or in a group of theirs. What
/// stands behind the `:` may look like the next field, so that the `whole` is looked at for it.
pub(super) fn ternary<'t>(
    tokens: &[TokenTree],
    whole: &dyn Fn() -> &'t [TokenTree],
) -> Option<Box<Diagnostic>> {
    let is_word = |word| move |token: &TokenTree| is_word(token, word);
    if let Some(asked) = tokens.iter().position(|token| is_mark(token, '?')) {
        let choice = by_marks(whole(), asked)?;
        let message = "`?` is no operator: a choice is written with `if`";
        return Some(told(&tokens[asked], message, &choice));
    }
    if let Some(begin) = tokens.iter().position(is_word("if")) {
        if let Some(then) = tokens.iter().position(is_word(THEN)) {
            let message = "`then` is no word here: the values of a choice stand in braces";
            let choice = by_words(&whole()[begin..])?;
            return Some(told(&tokens[then], message, &choice));
        }
        if let Some(choice) = behind_its_value(whole(), begin) {
            let message = "a choice begins with its `if`";
            return Some(told(&tokens[begin], message, &choice));
        }
    }
    if let Some(report) = tokens.iter().find_map(other_choice) {
        return Some(report);
    }
    tokens.iter().find_map(|token| match token {
        TokenTree::Group(group) => {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            ternary(&inside, &|| &inside)
        }
        _ => None,
    })
}

/// What to write for `elif`, which no name can be beside values.
pub(super) fn other_choice(token: &TokenTree) -> Option<Box<Diagnostic>> {
    let word = ELSE_IF.iter().find(|word| is_word(token, word))?;
    let message = format!("`{word}` is no word here: another choice begins with two");
    Some(told(token, &message, "else if"))
}

/// What to write for `if a b else c`, whose values lack their braces, among these tokens or in a group of theirs.
pub(super) fn without_braces(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let begin = tokens.iter().position(|token| is_word(token, "if"));
    if let Some((choice, Some(at))) = begin.and_then(|begin| braced(&tokens[begin..])) {
        let message = "the values of a choice stand in braces";
        return Some(told(at, message, &choice));
    }
    tokens.iter().find_map(|token| match token {
        TokenTree::Group(group) => {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            without_braces(&inside)
        }
        _ => None,
    })
}

/// A choice with its braces, and where the first of its values begins that lacks them.
fn braced(choice: &[TokenTree]) -> Option<(String, Option<&TokenTree>)> {
    let rest = &choice[1..];
    let is_else = |token: &TokenTree| is_word(token, "else");
    let other = rest.iter().position(is_else).unwrap_or(rest.len());
    let (condition, first, lacks_first) = split(&rest[..other])?;
    let behind = rest.get(other + 1..).unwrap_or_default();
    let (second, lacks_second) = match behind {
        [] => ("{ … }".to_owned(), None),
        [TokenTree::Group(group)] if group.delimiter() == Delimiter::Brace => {
            (dump::tokens(group.to_token_stream()), None)
        }
        [word, ..] if is_word(word, "if") => braced(behind)?,
        [begin, ..] => (format!("{{ {} }}", value(behind)), Some(begin)),
    };
    let lacking = lacks_first.or(lacks_second);
    Some((written(condition, &first, &second), lacking))
}

/// The condition and the first value of a choice, and where that begins if it lacks its braces.
fn split(head: &[TokenTree]) -> Option<(&[TokenTree], String, Option<&TokenTree>)> {
    let (last, before) = head.split_last()?;
    if let TokenTree::Group(group) = last
        && group.delimiter() == Delimiter::Brace
    {
        let inside: Vec<TokenTree> = group.stream().into_iter().collect();
        return Some((before, value(&inside), None));
    }
    let is_comparison =
        |part: &[TokenTree]| part.len() == 1 && matches!(read(part), Some(Expr::Paren(_)));
    let reads = |at: &usize| {
        let (condition, behind) = head.split_at(*at);
        let is_joint = slips::is_operand(&head[at - 1]) && slips::is_operand(&head[*at]);
        (is_joint || is_comparison(condition))
            && read(condition).is_some()
            && read(behind).is_some()
    };
    let at = (1..head.len()).find(reads)?;
    let (condition, behind) = head.split_at(at);
    Some((condition, value(behind), Some(&head[at])))
}

fn told(at: &TokenTree, message: &str, choice: &str) -> Box<Diagnostic> {
    let report = error(codes::SYNTAX, at.span(), message);
    Box::new(report.help(format!("write `{choice}`")))
}

/// `a ? b : c`, whose `?` stands at this place.
fn by_marks(whole: &[TokenTree], asked: usize) -> Option<String> {
    let (condition, rest) = (&whole[..asked], &whole[asked + 1..]);
    // A path has two colons.
    let alone = |at: &usize| {
        let neighbours = [at.wrapping_sub(1), at + 1];
        let neighbours = neighbours.map(|at| rest.get(at));
        let mut neighbours = neighbours.into_iter().flatten();
        is_mark(&rest[*at], ':') && !neighbours.any(|token| is_mark(token, ':'))
    };
    let colon = (0..rest.len()).find(alone)?;
    let [first, second] = [&rest[..colon], &rest[colon + 1..]].map(value);
    Some(written(condition, &first, &format!("{{ {second} }}")))
}

/// `if a then b else c`, or the same with more choices behind it.
fn by_words(choice: &[TokenTree]) -> Option<String> {
    let then = choice.iter().position(|token| is_word(token, THEN))?;
    let (condition, rest) = (&choice[1..then], &choice[then + 1..]);
    let begins_other = |token: &TokenTree| {
        is_word(token, "else") || ELSE_IF.iter().any(|word| is_word(token, word))
    };
    let Some(other) = rest.iter().position(begins_other) else {
        return Some(written(condition, &value(rest), "{ … }"));
    };
    let behind = &rest[other + 1..];
    let second = if !is_word(&rest[other], "else") {
        by_words(&rest[other..])?
    } else if behind.first().is_some_and(|token| is_word(token, "if")) {
        by_words(behind)?
    } else {
        format!("{{ {} }}", value(behind))
    };
    Some(written(condition, &value(&rest[..other]), &second))
}

/// `b if a else c`, whose `if` stands at this place.
fn behind_its_value(whole: &[TokenTree], begin: usize) -> Option<String> {
    let (first, rest) = (&whole[..begin], &whole[begin + 1..]);
    let other = rest.iter().position(|token| is_word(token, "else"))?;
    let [first, second] = [first, &rest[other + 1..]].map(read);
    let [first, second] = [first?, second?].map(|it| dump::expression(&it));
    Some(written(&rest[..other], &first, &format!("{{ {second} }}")))
}

/// The choice as it is written here; `second` has its own braces.
fn written(condition: &[TokenTree], first: &str, second: &str) -> String {
    format!("if {} {{ {first} }} else {second}", compared(condition))
}

/// A condition, which is a comparison here: a value alone is 0 or 1 elsewhere.
fn compared(condition: &[TokenTree]) -> String {
    let is_value = matches!(
        read(condition),
        Some(Expr::Path(_) | Expr::Field(_) | Expr::Index(_))
    );
    value(condition) + if is_value { " > 0.5" } else { "" }
}

/// What these tokens say, or a place for it.
fn value(part: &[TokenTree]) -> String {
    read(part).map_or_else(|| "…".to_owned(), |part| dump::expression(&part))
}

fn read(part: &[TokenTree]) -> Option<Expr> {
    syn::parse2(part.iter().cloned().collect()).ok()
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(it) if it == word)
}
