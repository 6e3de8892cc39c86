//! Loops.

use proc_macro2::{Delimiter, Ident};

use super::ast::Loop;
use super::cursor::{Cursor, Parsed};
use super::expressions::range;
use super::recovery::{DEEPEST_BLOCK, Sink};
use super::statements::body;
use crate::codes;

/// Reads `k in 0..n { … }`, what follows the `for` that was just read.
pub(super) fn repetition(
    cursor: &mut Cursor,
    label: Option<Ident>,
    sink: &mut Sink<'_>,
) -> Parsed<Loop> {
    let variable = cursor.name("the variable of the loop after `for`")?;
    if cursor.ident(0).is_none_or(|word| word != "in") {
        return Err(cursor.expected(&format!("`in` after `for {variable}`")));
    }
    cursor.advance(1);
    let (start, end) = range(cursor, "a range such as `0..4`")?;
    let Some(group) = cursor.take_group(Delimiter::Brace) else {
        return Err(cursor.expected(&format!("`{{` after {}", cursor.previous())));
    };
    let Some(statements) = sink.nested(|sink| body(&group, sink)) else {
        let message = format!("blocks nest deeper than {DEEPEST_BLOCK}");
        return Err(Box::new(crate::diagnostics::error(
            codes::SYNTAX,
            variable.span(),
            message,
        )));
    };
    Ok(Loop {
        label,
        variable,
        start,
        end,
        statements,
    })
}
