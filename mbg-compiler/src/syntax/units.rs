//! Units: products of powers.
//!
//! They have a grammar of their own because `N*m*s/rad = 1e3` is an assignment to a quotient in Rust, and
//! `s^-1` an exclusive or.

use proc_macro2::{Delimiter, TokenTree};
use syn::LitInt;

use super::ast::Unit;
use super::cursor::{Cursor, Parsed};
use super::recovery::{Sink, opens};
use crate::codes;

/// How deep parentheses may nest.
const DEPTH: usize = 8;

/// The largest exponent either way, far above any quantity of physics.
const LARGEST_EXPONENT: i32 = 99;

/// Reads `: unit`, when a colon stands here, up to `=`, `,` or `;`.
///
/// A unit that cannot be read is reported and left out: units are optional, and what carries them is still good.
pub(super) fn unit(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Option<Unit> {
    let colon = cursor.position();
    if !cursor.take_punct(':') {
        return None;
    }
    // A `$u:expr` stays together below a power.
    if !cursor.punct(1, '^') {
        cursor.open();
    }
    let length = cursor.length_until(|cursor, offset| {
        ['=', ',', ';'].iter().any(|&end| cursor.punct(offset, end))
            || opens(cursor, offset)
            || cursor.punct(offset, '#')
    });
    let start = cursor.position();
    let end = start + length;
    let mut unit = Unit {
        text: String::new(),
        factors: Vec::new(),
    };
    let parsed = product(cursor, &mut unit, 1, DEPTH).and_then(|()| {
        if let Some(size) = size(cursor) {
            let report = *cursor.expected_with(codes::UNIT, "the end of the unit");
            let help = match cursor.since(colon.saturating_sub(1)).first() {
                Some(TokenTree::Ident(name)) => {
                    let text = &unit.text;
                    format!("a size stands behind the name: write `{name}[{size}]: {text}`")
                }
                _ => format!("leave `[{size}]` out: a size stands behind the name"),
            };
            return Err(Box::new(report.help(help)));
        }
        if cursor.position() < end && !value_follows(cursor) {
            return Err(cursor.expected_with(codes::UNIT, "`*`, `/`, `^` or the end of the unit"));
        }
        Ok(())
    });
    match parsed {
        Ok(()) => Some(unit),
        Err(mut error) => {
            cursor.advance(end.saturating_sub(cursor.position()));
            if error.helps.is_empty() {
                error.helps.extend(mended(cursor.since(start)));
            }
            sink.report(error);
            None
        }
    }
}

/// Names and exponents of the unit that stands here, if it ends as a value does.
pub(super) fn ahead(cursor: &Cursor) -> Option<Vec<(String, i32)>> {
    let ends = |cursor: &Cursor, offset| [',', ';'].iter().any(|&end| cursor.punct(offset, end));
    let length = cursor.length_until(ends);
    let mut inside = Cursor::new(cursor.ahead(length).iter().cloned().collect());
    let mut unit = Unit {
        text: String::new(),
        factors: Vec::new(),
    };
    product(&mut inside, &mut unit, 1, DEPTH).ok()?;
    let factors = unit.factors.into_iter();
    let spelt = factors.map(|(name, exponent)| (name.to_string(), exponent));
    inside.ended().then(|| spelt.collect())
}

/// The size that stands here, `[3]`, and no value.
fn size(cursor: &Cursor) -> Option<LitInt> {
    let size = syn::parse2(cursor.group(0, Delimiter::Bracket)?.stream()).ok()?;
    let ends = cursor.peek(1).is_none() || ['=', ',', ';'].iter().any(|&end| cursor.punct(1, end));
    ends.then_some(size)
}

/// Whether a value stands here, for which the `=` is missing.
fn value_follows(cursor: &Cursor) -> bool {
    let is_number = matches!(cursor.peek(0), Some(TokenTree::Literal(_)));
    is_number || cursor.group(0, Delimiter::Bracket).is_some()
}

/// What to type for a unit with dots or nothing between its factors, or with `**` before its exponents.
fn mended(tokens: &[TokenTree]) -> Option<String> {
    let text = multiplied(tokens, DEPTH)?
        .replace("**", "^")
        .replace('.', "*");
    let mut cursor = Cursor::new(text.parse().ok()?);
    let mut unit = Unit {
        text: String::new(),
        factors: Vec::new(),
    };
    product(&mut cursor, &mut unit, 1, DEPTH).ok()?;
    cursor.ended().then(|| format!("write `{text}`"))
}

/// The text of these tokens, with `*` where factors stand side by side.
fn multiplied(tokens: &[TokenTree], depth: usize) -> Option<String> {
    let mut text = String::new();
    for token in tokens {
        let next = match token {
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                format!("({})", multiplied(&inside, depth.checked_sub(1)?)?)
            }
            other => other.to_string(),
        };
        let ends = |letter: char| letter.is_alphanumeric() || letter == ')';
        let begins = |letter: char| letter.is_alphanumeric() || letter == '(';
        if text.ends_with(ends) && next.starts_with(begins) {
            text.push('*');
        }
        text.push_str(&next);
    }
    Some(text)
}

/// Reads factors between `*` and `/`; `sign` is -1 in a denominator.
fn product(cursor: &mut Cursor, unit: &mut Unit, sign: i32, depth: usize) -> Parsed<()> {
    factor(cursor, unit, sign, depth)?;
    loop {
        if cursor.take_punct('*') {
            unit.text.push('*');
            factor(cursor, unit, sign, depth)?;
        } else if cursor.take_punct('/') {
            unit.text.push('/');
            factor(cursor, unit, -sign, depth)?;
        } else {
            return Ok(());
        }
    }
}

/// Reads a name, `1` or parentheses, with an exponent.
fn factor(cursor: &mut Cursor, unit: &mut Unit, sign: i32, depth: usize) -> Parsed<()> {
    if let Some(name) = cursor.ident(0).cloned() {
        let spelling = name.to_string();
        if spelling.contains('·') {
            let error = *cursor.failure(
                codes::UNIT,
                format!("expected the name of a unit, found `{name}`"),
            );
            return Err(Box::new(
                error.help(format!("write `{}`", spelling.replace('·', "*"))),
            ));
        }
        cursor.advance(1);
        unit.text.push_str(&spelling);
        let exponent = exponent(cursor, unit, sign)?;
        unit.factors.push((name, sign * exponent));
        return Ok(());
    }
    if matches!(cursor.peek(0), Some(TokenTree::Literal(literal)) if literal.to_string() == "1") {
        cursor.advance(1);
        unit.text.push('1');
        return Ok(());
    }
    let mut brackets = [Delimiter::Parenthesis, Delimiter::None].into_iter();
    let group = brackets.find_map(|brackets| cursor.group(0, brackets).cloned());
    let Some(group) = group else {
        let report = *cursor.expected_with(codes::UNIT, "the name of a unit");
        return Err(Box::new(match cursor.peek(0) {
            _ if cursor.punct(0, '%') => report.help("write `1`, and each value times 0.01"),
            _ if cursor.group(0, Delimiter::Bracket).is_some() => report.help(
                "a colon is before a unit, and a size stands behind the name, as in `gains[3] = …`",
            ),
            Some(TokenTree::Literal(value)) if unit.text.is_empty() && ends(cursor) => report.help(
                format!("a colon is before a unit; a value follows `=`: write `= {value}`"),
            ),
            _ => report,
        }));
    };
    if depth == 0 {
        return Err(cursor.failure(
            codes::UNIT,
            format!("parentheses nest deeper than {DEPTH} in a unit"),
        ));
    }
    cursor.advance(1);
    let mut inner = Cursor::inside(&group);
    let first = unit.factors.len();
    unit.text.push('(');
    product(&mut inner, unit, sign, depth - 1)?;
    if !inner.ended() {
        return Err(inner.expected_with(codes::UNIT, "`*`, `/`, `^` or `)`"));
    }
    unit.text.push(')');
    let place = cursor.position();
    let exponent = exponent(cursor, unit, sign)?;
    for (_, power) in &mut unit.factors[first..] {
        *power *= exponent;
        if power.abs() > LARGEST_EXPONENT {
            return Err(large(cursor, place));
        }
    }
    Ok(())
}

/// Whether a statement or an argument ends behind the next token.
fn ends(cursor: &Cursor) -> bool {
    cursor.peek(1).is_none() || [',', ';'].iter().any(|&end| cursor.punct(1, end))
}

/// Reads `^n`, 1 when it is not there, of a factor above or below a stroke.
fn exponent(cursor: &mut Cursor, unit: &mut Unit, stroke: i32) -> Parsed<i32> {
    if !cursor.take_punct('^') {
        return Ok(1);
    }
    unit.text.push('^');
    let place = cursor.position();
    let sign = if cursor.take_punct('-') { -1 } else { 1 };
    if sign < 0 {
        unit.text.push('-');
    }
    let number = match cursor.peek(0) {
        Some(TokenTree::Literal(literal)) => syn::parse_str::<LitInt>(&literal.to_string()).ok(),
        _ => None,
    };
    let Some(number) = number else {
        let report = *cursor.expected_with(codes::UNIT, "an integer exponent");
        let help = "a quantity whose unit has a root, such as the coefficient of an orifice, is declared without a unit";
        return Err(Box::new(report.help(help)));
    };
    if !number.suffix().is_empty() {
        // A digit and the next unit, as in `W/m^2K`, are one token.
        let mark = if stroke < 0 { '/' } else { '*' };
        let (digits, next) = (number.base10_digits(), number.suffix());
        let help = format!("write `{}{digits}{mark}{next}`", unit.text);
        let report = *cursor.expected_with(codes::UNIT, "an integer exponent");
        return Err(Box::new(report.help(help)));
    }
    cursor.advance(1);
    match number.base10_parse::<i32>() {
        Ok(value) if value <= LARGEST_EXPONENT => {
            unit.text.push_str(&value.to_string());
            Ok(sign * value)
        }
        _ => Err(large(cursor, place)),
    }
}

/// The exponent at `place` is too large.
fn large(cursor: &Cursor, place: usize) -> Box<crate::diagnostics::Diagnostic> {
    let span = cursor
        .since(place)
        .last()
        .map_or_else(|| cursor.last_span(), TokenTree::span);
    let message = format!("expected an exponent from -{LARGEST_EXPONENT} to {LARGEST_EXPONENT}");
    Box::new(crate::diagnostics::error(codes::UNIT, span, message))
}
