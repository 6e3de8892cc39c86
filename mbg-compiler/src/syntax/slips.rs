//! Instances and entries of matrices in the order and spelling of other languages, and what to type instead.

use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree};
use syn::ExprArray;

use super::ast::{Reference, Segment};
use super::cursor::Cursor;
use super::{dump, elements, elsewhere, library, units, words};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::units::{without_unit, without_units};

/// The instance that was probably meant, whose parameters and junctions stand `offset` places ahead.
pub(super) fn ahead(cursor: &Cursor, offset: usize, name: &str, component: &str) -> Option<String> {
    let [braces, parentheses] = [Delimiter::Brace, Delimiter::Parenthesis].map(|delimiter| {
        let mut places = [offset, offset + 1].into_iter();
        places.find_map(|place| cursor.group(place, delimiter))
    });
    Some(written(name, component, braces, parentheses?))
}

/// The axes that `zyx`, `"ZYX"` or `[3, 2, 1]` names, by their numbers here; counted from one where there is a third.
pub(crate) fn axes_of(text: &str) -> Option<[usize; 3]> {
    let marks = text.to_lowercase();
    let marks: Vec<char> = marks.chars().filter(|it| it.is_alphanumeric()).collect();
    let first = usize::from(marks.contains(&'3'));
    let axes = marks.into_iter().map(|mark| match mark {
        'x' | 'y' | 'z' => Some(mark as usize - 'x' as usize),
        _ => (mark.to_digit(10)? as usize).checked_sub(first),
    });
    let axes: Option<Vec<usize>> = axes.collect();
    let axes: [usize; 3] = axes?.try_into().ok()?;
    axes.iter().all(|axis| *axis < 3).then_some(axes)
}

/// What to type for `sequence: zyx;`, which is no instance.
pub(super) fn setting(name: &Ident, value: &Ident) -> Option<String> {
    let axes = axes_of(&value.to_string());
    Some(match (name.to_string().as_str(), axes) {
        ("sequence" | "rotation_sequence" | "rotation_order", Some([first, second, third])) => {
            format!(
                "the axes of a rotation stand in the braces of its joint: `free: Free {{ first: {first}, second: {second}, third: {third} }} (a, b);`"
            )
        }
        ("orientation", None) => {
            "how an orientation is represented stands in the braces of its joint: \
             `free: Free { orientation: quaternion } (a, b);`"
                .to_owned()
        }
        _ => return None,
    })
}

/// What to type for the elements of a junction that stand apart from its declaration.
pub(super) fn apart(cursor: &Cursor, junction: &Reference, braces: &Group) -> Option<String> {
    let [
        Segment {
            name,
            selection: None,
        },
    ] = &junction.path[..]
    else {
        return None;
    };
    let inside = Cursor::inside(braces);
    let first = if inside.punct(0, '#') { 2 } else { 0 };
    let has_elements =
        elements::kind(&inside, first).is_some() && inside.ident(first + 1).is_some();
    let elements = dump::tokens(braces.stream());
    match cursor.declaration(name) {
        Some(declaration) if has_elements => Some(format!(
            "the elements of a junction stand in the braces of its declaration: `{declaration} {{ {elements} }}`"
        )),
        Some(_) => Some(format!(
            "`{name}` is a junction; an element there has a kind and a name of its own: `{} name {{ {elements} }} -> {name};`",
            kind_with(&inside)
        )),
        None if has_elements => Some(format!(
            "a junction has its digit before its name: `1 {name} {{ {elements} }}`"
        )),
        None => None,
    }
}

/// What to type for `I: m { … }`, with a colon behind the kind.
pub(super) fn without_colon(cursor: &Cursor, kind: &str) -> Option<String> {
    let name = cursor.ident(1).filter(|_| cursor.punct(0, ':'))?;
    Some(format!("write `{kind} {name}`, without the colon"))
}

/// What to type for `R { … }`, which lacks a name.
pub(super) fn unnamed(cursor: &Cursor, kind: &str) -> Option<String> {
    cursor.group(0, Delimiter::Brace)?;
    Some(format!(
        "each element has a name: write `{kind} name {{ … }}`"
    ))
}

/// What to type for `R[2] valve { … }`, with the size behind the kind.
pub(super) fn size_first(cursor: &Cursor, kind: &str) -> Option<String> {
    cursor.group(0, Delimiter::Bracket)?;
    let name = cursor.ident(1)?;
    Some(format!(
        "an element has the size of its junction: write `{kind} {name}`"
    ))
}

/// What to type for a value in the braces of an element that has no word before it.
pub(super) fn without_word(fields: &Group, law: &str) -> Option<String> {
    let inside = Cursor::inside(fields);
    let is_value = matches!(
        inside.peek(0)?,
        TokenTree::Literal(_) | TokenTree::Group(_) | TokenTree::Punct(_)
    );
    is_value.then(|| {
        format!(
            "a value has a word before it: write `{law}: {}`",
            dump::tokens(fields.stream())
        )
    })
}

/// What to type for `GY(0.1)`, an element without a name and without a word before its value.
pub(super) fn nameless(kind: &str, law: &Group) -> Option<String> {
    let [first, ..] = words::law_words(words::element(kind)?) else {
        return None;
    };
    let value = dump::tokens(law.stream());
    let value = if value.is_empty() { "…" } else { &value };
    Some(format!(
        "an element has a name, and its law stands in braces behind a word: `{kind} name {{ {first}: {value} }}`"
    ))
}

/// What to type in a junction for `mass: I { … }`, and for choices and loops of elements.
pub(super) fn no_element(cursor: &Cursor, junction: &Ident) -> Option<String> {
    let word = cursor.ident(0)?;
    if word == "if" || word == "for" {
        return Some(format!(
            "the elements in a junction's braces are always there; others hang by a bond in a statement of their own: `{word} … \
             {{ junction -> R name {{ … }}; }}`"
        ));
    }
    let has_junctions = (2..4).any(|at| cursor.group(at, Delimiter::Parenthesis).is_some());
    let is_part = cursor.ident(1).is_some() && !has_junctions;
    if let Some(help) = elsewhere::element(&word.to_string()).filter(|_| is_part) {
        return Some(help);
    }
    if let Some(written) = instance(cursor, junction) {
        return Some(format!(
            "instances stand outside the junction's braces, each in a statement of its own: `{written}`"
        ));
    }
    let kind = cursor.punct(1, ':') && elements::kind(cursor, 2).is_some();
    kind.then(|| {
        format!(
            "the kind of an element stands before its name: `{} {word} {{ … }}`",
            dump::tokens(cursor.peek(2).cloned().into_iter().collect())
        )
    })
}

/// The instance that stands here, as it is written.
fn instance(cursor: &Cursor, junction: &Ident) -> Option<String> {
    let (name, component, behind) = match cursor.punct(1, ':') {
        true => (cursor.ident(0)?, cursor.ident(2)?, 3),
        false => (cursor.ident(1)?, cursor.ident(0)?, 2),
    };
    let groups = [behind, behind + 1].map(|at| cursor.group(at, Delimiter::Parenthesis));
    let parameters = cursor.group(behind, Delimiter::Brace);
    let name = name.to_string();
    let ports = match groups.into_iter().flatten().next() {
        Some(ports) => dump::tokens(ports.stream()),
        // In the braces of its junction it seems to need none.
        None if parameters.is_some() && is_component(cursor, component) => junction.to_string(),
        None => return None,
    };
    let component = component.to_string();
    Some(statement(&name, &component, parameters, &ports))
}

/// Whether a word that is written as the component of an instance can be one.
fn is_component(cursor: &Cursor, word: &Ident) -> bool {
    match cursor.punct(1, ':') {
        true => words::element(&word.to_string()).is_none(),
        false => library::names().any(|known| word == known),
    }
}

/// The kind of element whose law the first word here tells.
fn kind_with(fields: &Cursor) -> &'static str {
    let first = fields.ident(0).map(ToString::to_string).unwrap_or_default();
    let mut kinds = words::ELEMENTS.iter();
    let kind = kinds.find(|(_, kind)| words::law_words(*kind).contains(&first.as_str()));
    kind.map_or("R", |(name, _)| name)
}

/// How an instance with these parameters and junctions is written.
pub(super) fn written(
    name: &str,
    component: &str,
    braces: Option<&Group>,
    parentheses: &Group,
) -> String {
    format!(
        "an instance is written `{}`",
        statement(name, component, braces, &dump::tokens(parentheses.stream()))
    )
}

/// The statement of an instance.
pub(super) fn statement(
    name: &str,
    component: &str,
    braces: Option<&Group>,
    ports: &str,
) -> String {
    let parameters = match braces.map(|group| dump::tokens(group.stream())) {
        Some(words) if !words.is_empty() => format!(" {{ {words} }}"),
        _ => String::new(),
    };
    format!("{name}: {component}{parameters} ({ports});")
}

/// Words that stand between values in other languages.
const BETWEEN: &[&str] = &[
    "then", "and", "or", "not", "elif", "elsif", "xor", "div", "is", "end",
];

/// What to type for a word that stands behind a value, or for a number with a unit.
pub(super) fn behind_value(cursor: &Cursor) -> Vec<String> {
    between(cursor, false)
}

/// The same in a law, whose own variables are read more often than a prefix is written.
pub(super) fn behind_law(cursor: &Cursor) -> Vec<String> {
    between(cursor, true)
}

fn between(cursor: &Cursor, is_law: bool) -> Vec<String> {
    let (Some(before), Some(word)) = (cursor.last(), cursor.ident(0)) else {
        return Vec::new();
    };
    // A word of the element, or a name before a value, lacks its comma.
    let call = cursor.group(1, Delimiter::Parenthesis);
    let is_followed = call.is_none() && cursor.peek(1).is_some_and(is_operand);
    let is_field = is_field(word) || cursor.punct(1, ':') || is_followed;
    if is_field || is_between(word) || !is_operand(before) {
        return Vec::new();
    }
    let before = before.to_string();
    match call {
        Some(call) => vec![format!("for a product write `{before} * {word}{call}`")],
        None => {
            let mut helps = multiplied(&before, &word.to_string());
            if cursor.punct(1, '/') || cursor.punct(1, '*') || cursor.punct(1, '^') {
                // What the first unit alone would scale by is wrong.
                let units = units::ahead(cursor);
                let whole = units.and_then(|units| without_units(&before, &units));
                helps = whole.into_iter().collect();
            }
            if is_law && ["e", "f", "p", "q"].iter().any(|own| word == own) {
                helps.reverse();
            }
            helps
        }
    }
}

/// What to type for two values side by side.
fn multiplied(first: &str, second: &str) -> Vec<String> {
    if words::FUNCTIONS.contains(&first) {
        return vec![format!(
            "the arguments of a function stand in parentheses: `{first}({second})`"
        )];
    }
    let is_number = first.starts_with(|digit: char| digit.is_ascii_digit());
    // Time is told more often than a tonne.
    let unit = without_unit(first, second).filter(|_| is_number && second != "t");
    let is_name = unit.is_none() || second.len() == 1;
    let product = is_name.then(|| format!("for a product write `{first} * {second}`"));
    unit.into_iter().chain(product).collect()
}

/// Whether this is a word of an element.
fn is_field(word: &Ident) -> bool {
    let mut laws = words::ELEMENTS
        .iter()
        .flat_map(|(_, kind)| words::law_words(*kind));
    let is_law = laws.any(|law| word == law);
    is_law
        || [
            "initial",
            "initial_flow",
            "initial_effort",
            "gyroscopic",
            "displacement",
        ]
        .iter()
        .any(|known| word == known)
}

fn is_between(word: &Ident) -> bool {
    let others = words::STATEMENTS.iter().chain(BETWEEN);
    words::is_reserved(&word.to_string()) || others.into_iter().any(|known| word == known)
}

/// Whether a value can end or begin with this token.
pub(super) fn is_operand(token: &TokenTree) -> bool {
    match token {
        TokenTree::Ident(word) => !is_between(word),
        TokenTree::Literal(_) => true,
        TokenTree::Group(group) => group.delimiter() == Delimiter::Parenthesis,
        TokenTree::Punct(_) => false,
    }
}

/// What to type for two values without an operator between them, among these tokens or in a group of theirs.
pub(super) fn side_by_side(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let is_dot = |at: usize| tokens.get(at).is_some_and(|token| is_mark(token, '.'));
    let is_name = |at: usize| matches!(tokens.get(at), Some(TokenTree::Ident(_)));
    let joint = (1..tokens.len()).find(|at| {
        let begins = !matches!(tokens[*at], TokenTree::Group(_));
        begins && is_operand(&tokens[at - 1]) && is_operand(&tokens[*at])
    });
    let Some(at) = joint else {
        return tokens.iter().find_map(|token| match token {
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                side_by_side(&inside)
            }
            _ => None,
        });
    };
    let (mut start, mut end) = (at - 1, at);
    let is_call = matches!(tokens[start], TokenTree::Group(_));
    if is_call && start > 0 && is_operand(&tokens[start - 1]) {
        start -= 1;
    }
    while start >= 2 && is_dot(start - 1) && is_name(start - 2) {
        start -= 2;
    }
    while is_dot(end + 1) && is_name(end + 2) {
        end += 2;
    }
    if matches!(tokens.get(end + 1), Some(TokenTree::Group(_))) {
        end += 1;
    }
    let (first, second) = (text(&tokens[start..at]), text(&tokens[at..=end]));
    let message = format!("expected an operator between `{first}` and `{second}`");
    let mut report = error(codes::SYNTAX, tokens[at].span(), message);
    report.helps = multiplied(&first, &second);
    Some(Box::new(report))
}

/// `.5`, which begins with its point, among these tokens or in a group of theirs.
pub(super) fn without_zero(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    tokens.iter().enumerate().find_map(|(at, token)| {
        let before = at.checked_sub(1).map(|before| &tokens[before]);
        match (token, tokens.get(at + 1)) {
            (TokenTree::Group(group), _) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                without_zero(&inside)
            }
            (_, Some(TokenTree::Literal(digits)))
                if is_mark(token, '.') && !before.is_some_and(is_operand) =>
            {
                let report = error(
                    codes::SYNTAX,
                    token.span(),
                    "expected a digit before the point",
                );
                Some(Box::new(report.help(format!("write `0.{digits}`"))))
            }
            _ => None,
        }
    })
}

/// Words that join conditions in other languages, and what does it here.
const CONNECTIVES: &[(&str, &str)] = &[("and", "&&"), ("or", "||"), ("not", "!")];

/// What to type for a word that joins conditions or turns one round, among these tokens or in a group of theirs.
pub(super) fn connective(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    tokens.iter().enumerate().find_map(|(at, token)| {
        let (word, mark) = match token {
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                return connective(&inside);
            }
            TokenTree::Ident(name) => CONNECTIVES.iter().find(|(word, _)| name == word)?,
            _ => return None,
        };
        let is_before = at > 0 && is_operand(&tokens[at - 1]);
        let is_behind = tokens.get(at + 1).is_some_and(is_operand);
        let is_joining = is_behind && is_before != (*word == "not");
        let message = format!("`{word}` is no operator");
        let report = || error(codes::SYNTAX, token.span(), message);
        is_joining.then(|| Box::new(report().help(format!("write `{mark}`"))))
    })
}

/// How many rows and columns of a matrix are written out.
const WRITTEN_OUT: usize = 4;

/// What declares the rows of a matrix as vectors, and the matrix of them for laws.
pub(super) fn by_rows(word: &str, name: &str, [rows, columns]: [usize; 2]) -> String {
    let end = if word == "input" { "" } else { " = …" };
    let row = |row: usize| format!("{word} {name}_{row}[{columns}]{end};");
    let entries = |row: usize| {
        let entry = |column: usize| format!("{name}_{row}[{column}]");
        format!("[{}]", listed(columns, entry, ", "))
    };
    let declared = listed(rows, row, " ");
    match word {
        "output" => declared,
        _ => format!("{declared} let {name} = [{}];", listed(rows, entries, ", ")),
    }
}

/// So many texts, of which the last stand for themselves where there are many.
fn listed(count: usize, text: impl Fn(usize) -> String, between: &str) -> String {
    let mut texts: Vec<String> = (0..count.min(WRITTEN_OUT)).map(text).collect();
    if count > WRITTEN_OUT {
        texts.push("…".to_owned());
    }
    texts.join(between)
}

/// What to type for an entry `m[0, 1]`, for a range `v[1:3]` or for rows between semicolons, among these tokens or in a
/// group of theirs.
pub(super) fn entry(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    tokens.iter().enumerate().find_map(|(at, token)| {
        let TokenTree::Group(group) = token else {
            return None;
        };
        let inside: Vec<TokenTree> = group.stream().into_iter().collect();
        let before = at.checked_sub(1).map(|before| &tokens[before]);
        let indexes = matches!(before, Some(TokenTree::Ident(_) | TokenTree::Group(_)));
        let told = match (group.delimiter(), indexes) {
            (Delimiter::Bracket, true) => by_rows_first(&inside).or_else(|| range(&inside)),
            (Delimiter::Bracket, false) => rows(&inside),
            _ => None,
        };
        told.or_else(|| entry(&inside))
    })
}

/// `[0, 1]` behind a matrix.
fn by_rows_first(inside: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let comma = inside.iter().find(|token| is_mark(token, ','))?;
    let places = inside.split(|token| is_mark(token, ','));
    let places: Vec<String> = places.map(|place| format!("[{}]", text(place))).collect();
    let report = error(codes::SYNTAX, comma.span(), "expected `]`, found `,`");
    let help = format!(
        "an entry of a matrix is taken from a row: `{}`",
        places.concat()
    );
    Some(Box::new(report.help(help)))
}

/// `[1:3]` behind a vector.
fn range(inside: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let help = with_dots(inside)?;
    let colon = inside.iter().find(|token| is_mark(token, ':'))?;
    let report = error(codes::SYNTAX, colon.span(), "expected `]`, found `:`");
    Some(Box::new(report.help(help)))
}

/// What to type for a range of components with a colon between its bounds.
pub(super) fn with_dots(inside: &[TokenTree]) -> Option<String> {
    let parts: Vec<&[TokenTree]> = inside.split(|token| is_mark(token, ':')).collect();
    let [start, end] = parts[..] else { return None };
    let is_plain = !start.is_empty() && !end.is_empty();
    let (start, end) = (text(start), text(end));
    is_plain.then(|| format!("a range is written `[{start}..{end}]`"))
}

/// Rows of a matrix, or entries of a vector, between semicolons.
fn rows(inside: &[TokenTree]) -> Option<Box<Diagnostic>> {
    let mark = inside.iter().find(|token| is_mark(token, ';'))?;
    let rows: Vec<&[TokenTree]> = inside.split(|token| is_mark(token, ';')).collect();
    let is_matrix = inside.iter().any(|token| is_mark(token, ','));
    let rows = rows.into_iter().map(|row| match is_matrix {
        true => format!("[{}]", text(row)),
        false => text(row),
    });
    let written = format!("[{}]", rows.collect::<Vec<_>>().join(", "));
    // What stands between the marks may be no value.
    syn::parse_str::<ExprArray>(&written).ok()?;
    let report = error(codes::SYNTAX, mark.span(), "expected `,` or `]`, found `;`");
    let help = format!("commas stand between entries and between rows: write `{written}`");
    Some(Box::new(report.help(help)))
}

/// `{a, b}`, a vector or a matrix in the braces of other languages, among these tokens or in a group of theirs.
pub(super) fn in_braces(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    tokens.iter().enumerate().find_map(|(at, token)| {
        let TokenTree::Group(group) = token else {
            return None;
        };
        let inside: Vec<TokenTree> = group.stream().into_iter().collect();
        let before = at.checked_sub(1).map(|before| &tokens[before]);
        // Behind the condition of a choice, or its `else`, stands no mark.
        let is_value = before.is_none_or(|before| matches!(before, TokenTree::Punct(_)));
        if !is_value || !is_list(group) {
            return in_braces(&inside);
        }
        let report = error(
            codes::SYNTAX,
            group.span_open(),
            "expected an expression, found `{`",
        );
        let help = format!("vectors stand in brackets: write `{}`", in_brackets(group));
        Some(Box::new(report.help(help)))
    })
}

/// Whether commas stand between what is in these braces.
fn is_list(group: &Group) -> bool {
    let inside = group.stream();
    group.delimiter() == Delimiter::Brace && inside.into_iter().any(|token| is_mark(&token, ','))
}

/// A list with those inside it, each in brackets.
fn in_brackets(group: &Group) -> String {
    let tokens = group.stream().into_iter().map(|token| match token {
        TokenTree::Group(inner) if is_list(&inner) => {
            in_brackets(&inner).parse().unwrap_or_default()
        }
        token => TokenStream::from(token),
    });
    format!("[{}]", dump::tokens(tokens.collect()))
}

pub(super) fn is_mark(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(it) if it.as_char() == mark)
}

/// `|v|`, the magnitude of what stands between the bars: the first of them has no operand before it.
pub(super) fn bars(tokens: &[TokenTree]) -> Option<Box<Diagnostic>> {
    tokens.iter().enumerate().find_map(|(at, token)| {
        if let TokenTree::Group(group) = token {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            return bars(&inside);
        }
        let opens = is_mark(token, '|') && (at == 0 || !is_operand(&tokens[at - 1]));
        let behind = &tokens[at + 1..];
        let length = behind.iter().position(|it| is_mark(it, '|'))?;
        if !opens || length == 0 || !is_operand(&behind[length - 1]) {
            return None;
        }
        let report = error(
            codes::SYNTAX,
            token.span(),
            "expected an expression, found `|`",
        );
        let help = format!("write `abs({})`", text(&behind[..length]));
        Some(Box::new(report.help(help)))
    })
}

fn text(part: &[TokenTree]) -> String {
    dump::tokens(part.iter().cloned().collect())
}
