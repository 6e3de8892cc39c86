//! What is chosen while a model is compiled: parameters whose values are words, and statements under an `if`.

use proc_macro2::{Delimiter, Ident};

use super::ast::{Branch, Choice, Conditional, Statement};
use super::attributes::Attributes;
use super::cursor::{Cursor, Parsed};
use super::expressions::condition;
use super::recovery::{DEEPEST_BLOCK, Sink, finish};
use super::statements::body;
use super::ternaries::other_choice;
use super::words;
use crate::codes;
use crate::diagnostics::error;

/// Whether the words of a choice stand behind `param`: no unit has a `|` after its first name.
pub(super) fn choice_follows(cursor: &Cursor) -> bool {
    cursor.ident(0).is_some()
        && cursor.punct(1, ':')
        && cursor.ident(2).is_some()
        && cursor.punct(3, '|')
}

/// Reads `blocked: ideal | compliant = ideal;`, what follows `param`.
pub(super) fn choice(
    cursor: &mut Cursor,
    attributes: Attributes,
    sink: &mut Sink<'_>,
) -> Parsed<Choice> {
    let name = cursor.name("the name of the parameter after `param`")?;
    cursor.take_punct(':');
    let mut listed = vec![cursor.name("a word to choose")?];
    while cursor.take_punct('|') {
        listed.push(cursor.name("a word to choose after `|`")?);
    }
    let equals = cursor.take_punct('=');
    let default = if equals {
        Some(default(cursor, &name, &listed)?)
    } else {
        None
    };
    let wanted = if equals { "`;`" } else { "`|`, `=` or `;`" };
    let wanted = format!("{wanted} after {}", cursor.previous());
    finish(cursor, sink, &wanted)?;
    Ok(Choice {
        documentation: attributes.documentation,
        name,
        words: listed,
        default,
    })
}

/// Reads the default, which is one of the words.
fn default(cursor: &mut Cursor, name: &Ident, listed: &[Ident]) -> Parsed<Ident> {
    let listed: Vec<String> = listed.iter().map(ToString::to_string).collect();
    let listed: Vec<&str> = listed.iter().map(String::as_str).collect();
    let found = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    if !listed.contains(&found.as_str()) {
        let wanted = words::alternatives(&listed);
        return Err(cursor.expected(&format!("{wanted} as the value of `{name}`")));
    }
    cursor.name("a word")
}

/// Reads `a == b { … } else if … { … } else { … }`, what follows the `if` that was just read.
pub(super) fn conditional(
    cursor: &mut Cursor,
    word: Ident,
    sink: &mut Sink<'_>,
) -> Parsed<Conditional> {
    let mut branches = vec![branch(cursor, true, sink)?];
    while cursor.ident(0).is_some_and(|word| word == "else") {
        cursor.advance(1);
        let conditional = cursor.ident(0).is_some_and(|word| word == "if");
        if conditional {
            cursor.advance(1);
        }
        branches.push(branch(cursor, conditional, sink)?);
        if !conditional {
            break;
        }
    }
    if let Some(report) = cursor.peek(0).and_then(other_choice) {
        return Err(report);
    }
    Ok(Conditional { word, branches })
}

/// Reads a condition, if there is one, and the statements that it chooses.
fn branch(cursor: &mut Cursor, conditional: bool, sink: &mut Sink<'_>) -> Parsed<Branch> {
    let condition = if conditional {
        Some(condition(
            cursor,
            "a condition such as `a == b` after `if`",
        )?)
    } else {
        None
    };
    let Some(group) = cursor.take_group(Delimiter::Brace) else {
        return Err(cursor.expected(&format!("`{{` after {}", cursor.previous())));
    };
    let Some(statements) = sink.nested(|sink| body(&group, sink)) else {
        let message = format!("blocks nest deeper than {DEEPEST_BLOCK}");
        let report = error(codes::SYNTAX, group.span_open(), message);
        return Err(Box::new(report));
    };
    for statement in &statements {
        let name = match statement {
            Statement::Parameter(parameter) => &parameter.name,
            Statement::Choice(choice) => &choice.name,
            _ => continue,
        };
        let message = format!("`{name}` is a parameter, which stands outside of an `if`");
        sink.error(codes::SYNTAX, name.span(), message);
    }
    Ok(Branch {
        condition,
        statements,
    })
}
