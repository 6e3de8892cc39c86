//! The statements of a model or component.

use proc_macro2::{Delimiter, Group, Ident, TokenTree};
use syn::Expr;

use super::ast::{
    Assertion, Attitude, Causality, Closure, Gravity, Input, Integral, Junction, JunctionKind, Let,
    Orientation, Output, Parameter, Statement, Unit,
};
use super::attributes::Attributes;
use super::chains::{chain, instance, reference};
use super::choices::{choice, choice_follows, conditional};
use super::cursor::{Cursor, Parsed};
use super::dump;
use super::elements::one_ports;
use super::expressions::{condition, expression};
use super::loops::repetition;
use super::recovery::{Sink, finish, synchronize};
use super::units::unit;
use super::{elsewhere, inclusions, library, signals, slips, words};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};

/// Reads the statements between braces.
pub(super) fn body(group: &Group, sink: &mut Sink<'_>) -> Vec<Statement> {
    let mut cursor = Cursor::inside(group);
    let mut statements = Vec::new();
    while !cursor.ended() {
        if cursor.take_punct(';') {
            continue;
        }
        let start = cursor.position();
        match statement(&mut cursor, sink) {
            Ok(statement) => statements.push(statement),
            Err(error) => {
                sink.report(error);
                synchronize(&mut cursor, start);
                // The names inside were perhaps lost one by one already; this finds them all.
                sink.lost();
                statements.extend(broken(cursor.since(start), sink));
            }
        }
        statements.extend(
            sink.lost()
                .into_iter()
                .map(|name| Statement::Broken(Some(name))),
        );
    }
    statements
}

/// One broken statement for each name that the tokens would have declared, or one without a name.
fn broken(tokens: &[TokenTree], sink: &mut Sink<'_>) -> Vec<Statement> {
    sink.lose(tokens);
    let names = sink.lost();
    if names.is_empty() {
        return vec![Statement::Broken(None)];
    }
    names
        .into_iter()
        .map(|name| Statement::Broken(Some(name)))
        .collect()
}

/// Reads one statement.
fn statement(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Parsed<Statement> {
    let attributes = Attributes::read(cursor, sink)?;
    if cursor.junction_digit(0) {
        attributes.unmarked("a junction", sink);
        return junction(cursor, sink).map(Statement::Junction);
    }
    let Some(first) = cursor.ident(0).cloned() else {
        return Err(no_statement(cursor));
    };
    let word = first.to_string();
    if let Some(error) = keyword(cursor, &word) {
        return Err(error);
    }
    // A junction may bear one of the words as its name, and then an arrow, a dot or a bracket follows.
    let referred =
        cursor.arrow(1) || cursor.punct(1, '.') || cursor.group(1, Delimiter::Bracket).is_some();
    // Gravity has no name, and its value may begin with any of these.
    if !referred || word == "gravity" {
        if words::STATEMENTS.contains(&word.as_str()) {
            attributes.unmarked(&format!("`{word}`"), sink);
            return declaration(cursor, first, attributes, sink);
        }
        if word == words::INCLUDE {
            return Err(inclusions::misplaced(cursor));
        }
    }
    if word == "if" {
        attributes.unmarked("`if`", sink);
        cursor.advance(1);
        return conditional(cursor, first, sink).map(Statement::Conditional);
    }
    let misspelt = cursor.ident(1).is_some() && words::element(&word).is_none();
    let is_event = word == words::EVENT && cursor.group(1, Delimiter::Parenthesis).is_some();
    let is_foreign = || elsewhere::statement(cursor).is_some();
    if misspelt || is_event || words::is_reserved(&word) || is_foreign() {
        return Err(no_statement(cursor));
    }
    if cursor.punct(1, ':') && cursor.ident(2).is_some_and(|word| word == "for") {
        attributes.unmarked("a loop", sink);
        let label = cursor.name("the label of a loop")?;
        cursor.advance(2);
        return repetition(cursor, Some(label), sink).map(Statement::Loop);
    }
    if cursor.punct(1, ':') {
        return instance(cursor, attributes.derivative, sink).map(Statement::Instance);
    }
    chain(cursor, attributes.derivative, sink).map(Statement::Chain)
}

/// A keyword as the name of an instance or as the label of a loop.
fn keyword(cursor: &Cursor, word: &str) -> Option<Box<Diagnostic>> {
    let is_declaration = words::STATEMENTS.contains(&word);
    let is_keyword = words::is_reserved(word) || is_declaration || word == words::INCLUDE;
    let is_named = matches!(cursor.peek(3), Some(TokenTree::Group(_)))
        || cursor.ident(2).is_some_and(|word| word == "for");
    if !is_keyword || !cursor.punct(1, ':') || is_declaration && !is_named {
        return None;
    }
    let what = match cursor.ident(2)?.to_string().as_str() {
        "for" => "the label of a loop",
        _ => "the name of an instance",
    };
    let message = format!("expected {what}, found the keyword `{word}`");
    let error = *cursor.failure(codes::SYNTAX, message);
    Some(Box::new(match word {
        "_" => error,
        _ => error.help(words::another_name(word)),
    }))
}

/// What stands here begins no statement.
fn no_statement(cursor: &Cursor) -> Box<Diagnostic> {
    let error = *cursor.expected("a statement");
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    if words::ITEMS.contains(&word.as_str()) {
        return Box::new(
            error.note("models and components stand side by side, not inside each other"),
        );
    }
    if let Some(help) = elsewhere::statement(cursor) {
        return Box::new(error.help(help));
    }
    if word == words::EVENT {
        return Box::new(error.help(elsewhere::EVENTS));
    }
    let digit = words::digit_in_words(&word);
    if digit.is_none()
        && let Some(help) = part(cursor, &word)
    {
        return Box::new(error.help(help));
    }
    if let Some(near) = words::nearest(
        &word,
        &[words::STATEMENTS, &words::element_names()].concat(),
    ) {
        return Box::new(error.help(format!("did you mean `{near}`?")));
    }
    if let (Some(component), Some(name)) = (cursor.ident(0), cursor.ident(1)) {
        let given = elsewhere::parameters(cursor, 2, name, component);
        let ahead = || slips::ahead(cursor, 2, &name.to_string(), &component.to_string());
        if let Some(help) = given.or_else(ahead) {
            return Box::new(error.help(help));
        }
    }
    if let (Some(digit), Some(name)) = (digit, cursor.ident(1)) {
        return Box::new(error.help(format!(
            "a junction begins with its digit: `{digit} {name}`"
        )));
    }
    if let Some(digit) = glued(cursor) {
        return Box::new(error.help(format!(
            "a junction is written `{digit} name`, with a space after the `{digit}`"
        )));
    }
    Box::new(
        error
            .note(format!("a statement begins with {},", words::alternatives(words::STATEMENTS)))
            .note("or is a junction `1 name[3] { … }`, a chain `a -> b;`, an instance `name: Component (a, b);`")
            .note("or a choice `if a == b { … } else { … }`"),
    )
}

/// What to type for `MSe push { … };`, an element of another name, for `Gain g { … };`, a block of a diagram, and for
/// `Body arm { … };`, a component of the library, which stand as statements without a bond, a name before them or junctions.
fn part(cursor: &Cursor, word: &str) -> Option<String> {
    let name = cursor.ident(1)?.to_string();
    let behind = cursor.group(2, Delimiter::Brace);
    let behind = behind.or_else(|| cursor.group(2, Delimiter::Parenthesis));
    if behind.is_none() && !cursor.punct(2, ';') {
        return None;
    }
    let lower = word.to_lowercase();
    if words::ELEMENTS
        .iter()
        .any(|(kind, _)| kind.to_lowercase() == lower)
    {
        return None;
    }
    let has_junctions = (2..4).any(|at| cursor.group(at, Delimiter::Parenthesis).is_some());
    if library::names().any(|known| known == word) {
        let braces = cursor.group(2, Delimiter::Brace);
        let written = || slips::statement(&name, word, braces, "…");
        return (!has_junctions).then(|| format!("an instance is written `{}`", written()));
    }
    let element = elsewhere::element(word).filter(|_| !has_junctions);
    element.or_else(|| signals::block(word, &name))
}

/// The digit of a junction that has grown together with its name, as in `1body`.
fn glued(cursor: &Cursor) -> Option<char> {
    let Some(TokenTree::Literal(literal)) = cursor.peek(0) else {
        return None;
    };
    literal
        .to_string()
        .chars()
        .next()
        .filter(|digit| matches!(digit, '0' | '1'))
}

/// Reads a statement that begins with one of [`words::STATEMENTS`].
fn declaration(
    cursor: &mut Cursor,
    word: Ident,
    attributes: Attributes,
    sink: &mut Sink<'_>,
) -> Parsed<Statement> {
    cursor.advance(1);
    if let Some(help) = elsewhere::unnamed(cursor, &word) {
        return Err(Box::new(
            (*cursor.expected(&format!("a name after `{word}`"))).help(help),
        ));
    }
    match word.to_string().as_str() {
        "param" if choice_follows(cursor) => {
            choice(cursor, attributes, sink).map(Statement::Choice)
        }
        "param" => parameter(cursor, attributes, sink).map(Statement::Parameter),
        "input" => input(cursor, attributes, sink).map(Statement::Input),
        "output" => output(cursor, attributes, sink).map(Statement::Output),
        "integral" => integral(cursor, attributes, sink).map(Statement::Integral),
        "attitude" => attitude(cursor, attributes, sink).map(Statement::Attitude),
        "let" => named_value(cursor, attributes, "let", sink).map(Statement::Let),
        "gravity" => gravity(cursor, word, sink).map(Statement::Gravity),
        "for" => repetition(cursor, None, sink).map(Statement::Loop),
        "close" => closure(cursor, word, sink).map(Statement::Closure),
        "assert" => assertion(cursor, word, sink).map(Statement::Assertion),
        _ => causality(cursor, sink),
    }
}

/// Reads what follows `close`.
fn closure(cursor: &mut Cursor, name: Ident, sink: &mut Sink<'_>) -> Parsed<Closure> {
    let from = reference(cursor, "a junction after `close`")?;
    if cursor.take_arrow().is_none() {
        return Err(cursor.expected(&format!("`->` after {}", cursor.previous())));
    }
    let to = reference(cursor, "a junction after `->`")?;
    for word in ["by", "multipliers"] {
        if cursor.ident(0).is_none_or(|found| found != word) {
            let error = *cursor.expected(&format!("`{word}` after {}", cursor.previous()));
            let help = "a loop is closed by `close a -> b by multipliers;`";
            return Err(Box::new(error.help(help)));
        }
        cursor.advance(1);
    }
    let displacement = trailing(cursor, "displacement", expression, sink)?;
    finish(cursor, sink, &format!("`;` after {}", cursor.previous()))?;
    Ok(Closure {
        name,
        from,
        to,
        displacement,
    })
}

fn parameter(
    cursor: &mut Cursor,
    attributes: Attributes,
    sink: &mut Sink<'_>,
) -> Parsed<Parameter> {
    let name = cursor.name("the name of the parameter after `param`")?;
    let dimension = vector_size(cursor, "param", &name)?;
    let unit = unit(cursor, sink);
    let equals = cursor.take_punct('=');
    let default = if equals {
        Some(expression(
            cursor,
            &format!("the value of `{name}` after `=`"),
        )?)
    } else {
        None
    };
    let wanted = match (dimension, &unit, equals) {
        (_, _, true) => "`;`",
        (_, Some(_), false) => "`=` or `;`",
        (Some(_), None, false) => "`:`, `=` or `;`",
        (None, None, false) => "`[`, `:`, `=` or `;`",
    };
    finish(
        cursor,
        sink,
        &format!("{wanted} after {}", cursor.previous()),
    )?;
    Ok(Parameter {
        documentation: attributes.documentation,
        name,
        dimension,
        unit,
        default,
    })
}

fn input(cursor: &mut Cursor, attributes: Attributes, sink: &mut Sink<'_>) -> Parsed<Input> {
    let name = cursor.name("the name of the input after `input`")?;
    let dimension = vector_size(cursor, "input", &name)?;
    let unit = unit(cursor, sink);
    if cursor.punct(0, '=') {
        no_default(cursor, &name, dimension, unit.as_ref(), sink)?;
    }
    let wanted = match (dimension, &unit) {
        (_, Some(_)) => "`;`",
        (Some(_), None) => "`:` or `;`",
        (None, None) => "`[`, `:` or `;`",
    };
    finish(
        cursor,
        sink,
        &format!("{wanted} after {}", cursor.previous()),
    )?;
    Ok(Input {
        documentation: attributes.documentation,
        name,
        dimension: dimension.unwrap_or(1),
        unit,
    })
}

/// Reports a value behind an input, and reads past it.
fn no_default(
    cursor: &mut Cursor,
    name: &Ident,
    dimension: Option<usize>,
    unit: Option<&Unit>,
    sink: &mut Sink<'_>,
) -> Parsed<()> {
    let message =
        format!("`{name}` is an input: its value comes from outside, and it has no default");
    let report = *cursor.failure(codes::SYNTAX, message);
    cursor.advance(1);
    let value = expression(cursor, "a value after `=`")?;
    let unit = unit.map_or_else(String::new, |unit| format!(": {}", unit.text));
    let size = dimension.map_or_else(String::new, |size| format!("[{size}]"));
    let (word, value) = match dimension {
        None => ("param", Some(dump::expression(&value))),
        Some(size) => ("let", dump::column(&value, size)),
    };
    let mut report = report.help(format!("write `input {name}{size}{unit};`"));
    if let Some(value) = value {
        let text = format!("{word} {name}{size}{unit} = {value};");
        report = report.help(format!("write `{text}` for a value that stays"));
    }
    sink.report(Box::new(report));
    Ok(())
}

fn output(cursor: &mut Cursor, attributes: Attributes, sink: &mut Sink<'_>) -> Parsed<Output> {
    let named = named_value(cursor, attributes, "output", sink)?;
    Ok(Output {
        documentation: named.documentation,
        name: named.name,
        dimension: named.dimension.unwrap_or(1),
        unit: named.unit,
        value: named.value,
    })
}

/// Reads `name[n]: unit = value;`, which stands after `let` and after `output`.
fn named_value(
    cursor: &mut Cursor,
    attributes: Attributes,
    word: &str,
    sink: &mut Sink<'_>,
) -> Parsed<Let> {
    let owner = if word == "let" { "value" } else { word };
    let name = cursor.name(&format!("the name of the {owner} after `{word}`"))?;
    let dimension = vector_size(cursor, word, &name)?;
    let unit = unit(cursor, sink);
    equals(cursor, dimension.is_some(), unit.is_some()).map_err(|mut report| {
        report.helps.extend(nameless(cursor, word, &name));
        report
    })?;
    let value = expression(cursor, &format!("the value of `{name}` after `=`"))?;
    finish(cursor, sink, &format!("`;` after {}", cursor.previous()))?;
    Ok(Let {
        documentation: attributes.documentation,
        name,
        dimension,
        unit,
        value,
    })
}

/// What to type for `output mass.p;`, which lacks a name; what stands before the dot was read as one.
fn nameless(cursor: &Cursor, word: &str, first: &Ident) -> Option<String> {
    let length = cursor.length_until(|it, at| it.punct(at, ';'));
    let ahead = cursor.ahead(length);
    let values = ahead.split(|token| slips::is_mark(token, ','));
    let values = values.map(|value| dump::tokens(value.iter().cloned().collect()));
    let declared = values.enumerate().map(|(place, value)| match place {
        0 => format!("{word} name = {first}{value};"),
        _ => format!("{word} name_{place} = {value};"),
    });
    let declared: Vec<String> = declared.collect();
    let is_read = cursor.punct(0, '.');
    is_read.then(|| format!("a value has a name: `{}`", declared.join(" ")))
}

/// Reads the value of gravity and its `;`.
fn gravity(cursor: &mut Cursor, name: Ident, sink: &mut Sink<'_>) -> Parsed<Gravity> {
    let what = "the acceleration of free fall after `gravity`";
    if cursor.punct(0, ':') || cursor.punct(0, '=') {
        let report = *cursor.expected(what);
        cursor.advance(1);
        let value = dump::expression(&expression(cursor, what)?);
        return Err(Box::new(report.help(format!("write `gravity {value};`"))));
    }
    let value = expression(cursor, what)?;
    finish(cursor, sink, &format!("`;` after {}", cursor.previous()))?;
    Ok(Gravity { name, value })
}

fn assertion(cursor: &mut Cursor, name: Ident, sink: &mut Sink<'_>) -> Parsed<Assertion> {
    let condition = expression(cursor, "a comparison after `assert`")?;
    finish(cursor, sink, &format!("`;` after {}", cursor.previous()))?;
    Ok(Assertion { name, condition })
}

fn integral(cursor: &mut Cursor, attributes: Attributes, sink: &mut Sink<'_>) -> Parsed<Integral> {
    let name = cursor.name("the name of the integral after `integral`")?;
    let dimension = vector_size(cursor, "integral", &name)?;
    let unit = unit(cursor, sink);
    equals(cursor, dimension.is_some(), unit.is_some())?;
    let rate = expression(cursor, &format!("the rate of `{name}` after `=`"))?;
    let initial = trailing(cursor, "initial", expression, sink)?;
    finish(cursor, sink, &ending(cursor, initial.is_some()))?;
    let dimension = dimension.unwrap_or(1);
    Ok(Integral {
        documentation: attributes.documentation,
        name,
        dimension,
        unit,
        rate,
        initial,
    })
}

fn attitude(cursor: &mut Cursor, attributes: Attributes, sink: &mut Sink<'_>) -> Parsed<Attitude> {
    let name = cursor.name("the name of the attitude after `attitude`")?;
    if !cursor.take_punct('=') {
        let report = cursor.expected(&format!("`=` after {}", cursor.previous()));
        let help = elsewhere::attitude_in_braces(cursor, &name);
        return Err(Box::new(help.into_iter().fold(*report, Diagnostic::help)));
    }
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    let known = Orientation::ALL.into_iter().find(|it| it.word() == word);
    let Some(orientation) = known else {
        let help = match words::nearest(&word, &Orientation::ALL.map(Orientation::word)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "an attitude is the integral of an angular velocity in body axes".to_owned(),
        };
        let wanted = "`quaternion(…)` or `matrix(…)` after `=`";
        return Err(Box::new((*cursor.expected(wanted)).help(help)));
    };
    cursor.advance(1);
    let Some(group) = cursor.take_group(Delimiter::Parenthesis) else {
        return Err(cursor.expected(&format!("`(` after `{word}`")));
    };
    let mut inner = Cursor::inside(&group);
    let angular_velocity = expression(&mut inner, "the angular velocity")?;
    if !inner.ended() {
        return Err(inner.expected("`)` after the angular velocity"));
    }
    let initial = trailing(cursor, "initial", expression, sink)?;
    finish(cursor, sink, &ending(cursor, initial.is_some()))?;
    Ok(Attitude {
        documentation: attributes.documentation,
        name,
        orientation,
        angular_velocity,
        initial,
    })
}

/// Reads the dimension of what a word declares, which is a vector at most.
fn vector_size(cursor: &mut Cursor, word: &str, name: &Ident) -> Parsed<Option<usize>> {
    if let Some(help) = elsewhere::without_type(cursor, word, name) {
        let message = format!("expected the name of what is declared, found the type `{name}`");
        let report = error(codes::SYNTAX, name.span(), message);
        return Err(Box::new(report.help(help)));
    }
    let mut help = elsewhere::unit_in_brackets(cursor, word, name);
    if cursor.group(0, Delimiter::Parenthesis).is_some()
        && let Some(help) = help.take()
    {
        let report = *cursor.expected(&format!("`:` after `{name}`"));
        return Err(Box::new(report.help(help)));
    }
    let by_comma = rows_and_columns(cursor).map(|sizes| of_matrix(word, name, sizes));
    let rows = cursor.dimension().map_err(|mut report| {
        match by_comma {
            Some(help) => report.helps = vec![help],
            None => drop(report.helps.splice(0..0, help)),
        }
        report
    })?;
    let (Some(count), Some(_)) = (rows, cursor.group(0, Delimiter::Bracket)) else {
        return Ok(rows);
    };
    let report = *cursor.expected(&format!("one dimension of `{name}`"));
    let Some(columns) = cursor.dimension()? else {
        return Ok(rows);
    };
    Err(Box::new(report.help(of_matrix(
        word,
        name,
        [count, columns],
    ))))
}

/// What to type for a matrix that is declared by its sizes.
fn of_matrix(word: &str, name: &Ident, sizes: [usize; 2]) -> String {
    match word {
        "let" => format!("a matrix is a value without a dimension: write `let {name} = [[…], …];`"),
        _ => format!(
            "`{word}` declares a number or a vector: write `{}`",
            slips::by_rows(word, &name.to_string(), sizes)
        ),
    }
}

/// The sizes in `[3, 3]`.
fn rows_and_columns(cursor: &Cursor) -> Option<[usize; 2]> {
    let group = cursor.group(0, Delimiter::Bracket)?;
    let tokens: Vec<TokenTree> = group.stream().into_iter().collect();
    let [rows, comma, columns] = &tokens[..] else {
        return None;
    };
    let size = |token: &TokenTree| token.to_string().parse().ok();
    slips::is_mark(comma, ',').then_some([size(rows)?, size(columns)?])
}

/// Reads the `=` before a value.
fn equals(cursor: &mut Cursor, dimension: bool, unit: bool) -> Parsed<()> {
    if cursor.take_punct('=') {
        return Ok(());
    }
    let wanted = match (dimension, unit) {
        (_, true) => "`=`",
        (true, false) => "`:` or `=`",
        (false, false) => "`[`, `:` or `=`",
    };
    let mut report = cursor.expected(&format!("{wanted} after {}", cursor.previous()));
    let value = cursor.group(0, Delimiter::Bracket);
    let help = value.map(|value| format!("write `= [{}]`", dump::tokens(value.stream())));
    report.helps.extend(help);
    Err(report)
}

/// Reads `, initial: value` or its like, the value by `read`.
fn trailing(
    cursor: &mut Cursor,
    wanted: &str,
    read: fn(&mut Cursor, &str) -> Parsed<Expr>,
    sink: &mut Sink<'_>,
) -> Parsed<Option<Expr>> {
    let word = |cursor: &Cursor| cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    if !cursor.take_punct(',') {
        if word(cursor) != wanted {
            return Ok(None);
        }
        let report = *cursor.expected(&format!("`,` after {}", cursor.previous()));
        if !cursor.punct(1, ':') && !cursor.punct(1, '=') {
            return Err(Box::new(report.help(format!("write `, {wanted}: …`"))));
        }
        sink.report(Box::new(report.help(format!("write `, {wanted}: …`"))));
    }
    let word = word(cursor);
    if word != wanted {
        let mut error = *cursor.expected(&format!("`{wanted}: value` after `,`"));
        if words::nearest(&word, &[wanted]).is_some() {
            error = error.help(format!("did you mean `{wanted}`?"));
        } else if wanted == "initial" && elsewhere::is_limit(&word) {
            error = error.help(elsewhere::LIMITED);
        } else if word == "start" || word == "init" {
            error = error.help(format!("write `{wanted}: …`"));
        }
        return Err(Box::new(error));
    }
    cursor.advance(1);
    if !cursor.take_punct(':') {
        let report = *cursor.expected(&format!("`:` after `{wanted}`"));
        if !cursor.take_punct('=') {
            return Err(Box::new(report));
        }
        sink.report(Box::new(report.help(format!("write `{wanted}: …`"))));
    }
    read(cursor, &format!("the value of `{wanted}`")).map(Some)
}

/// What may end a statement that may have an initial value.
fn ending(cursor: &Cursor, started: bool) -> String {
    let wanted = if started {
        "`;`"
    } else {
        "`, initial: value` or `;`"
    };
    format!("{wanted} after {}", cursor.previous())
}

fn causality(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Parsed<Statement> {
    const WORDS: &[&str] = &["uniform", "componentwise"];
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    let causality = match word.as_str() {
        "uniform" => Causality::Uniform,
        "componentwise" => Causality::Componentwise,
        _ => {
            let error = *cursor.expected("`uniform` or `componentwise` after `causality`");
            return Err(Box::new(error.did_you_mean(&word, WORDS)));
        }
    };
    let span = cursor.span();
    cursor.advance(1);
    finish(cursor, sink, &format!("`;` after `{word}`"))?;
    Ok(Statement::Causality(causality, span))
}

/// Reads `1 name[n] coordinate { … }` or `0 name;`, given that the digit stands here.
fn junction(cursor: &mut Cursor, sink: &mut Sink<'_>) -> Parsed<Junction> {
    let span = cursor.span();
    let kind = cursor.take_junction_kind().unwrap_or(JunctionKind::One);
    let name = cursor.name(&format!(
        "the name of the junction after `{}`",
        kind.digit()
    ));
    let name = name.map_err(|mut report| {
        // `1-junction v`
        let hyphened = cursor.ident(2).filter(|_| cursor.punct(0, '-'));
        report
            .helps
            .extend(hyphened.map(|name| format!("write `{} {name}`", kind.digit())));
        report
    })?;
    let (mut dimension, mut coordinate, mut pseudo) = (None, false, false);
    loop {
        if dimension.is_none() && cursor.group(0, Delimiter::Bracket).is_some() {
            dimension = cursor.dimension()?;
        } else if !coordinate && cursor.ident(0).is_some_and(|word| word == "coordinate") {
            coordinate = true;
            cursor.advance(1);
        } else if !pseudo && cursor.ident(0).is_some_and(|word| word == "pseudo") {
            pseudo = true;
            cursor.advance(1);
        } else {
            break;
        }
    }
    let initial_flow = if coordinate {
        trailing(cursor, "initial_flow", condition, sink)?
    } else {
        None
    };
    let elements = match cursor.take_group(Delimiter::Brace) {
        Some(group) => {
            let elements = one_ports(&group, &name, sink);
            if cursor.arrow(0) {
                let error = *cursor.expected("the next statement after the junction's braces");
                return Err(Box::new(error.help(format!(
                    "bonds stand in a statement of their own: `{name} -> …;`"
                ))));
            }
            elements
        }
        None => {
            if let Some(help) = several(cursor, kind.digit(), &name) {
                return Err(Box::new(
                    (*cursor.expected("`;` after the junction")).help(help),
                ));
            }
            let started = initial_flow.is_some();
            let words = [
                ("[", dimension.is_some() || started),
                ("coordinate", coordinate),
                ("pseudo", pseudo || started),
                (", initial_flow: value", !coordinate || started),
            ];
            undelimited(cursor, &words, sink)?;
            Vec::new()
        }
    };
    Ok(Junction {
        kind,
        span,
        name,
        dimension: dimension.unwrap_or(1),
        coordinate,
        pseudo,
        initial_flow,
        elements,
    })
}

/// What to type for `1 a, b;`.
fn several(cursor: &Cursor, digit: char, first: &Ident) -> Option<String> {
    let length = cursor.length_until(|it, at| it.punct(at, ';'));
    let mut names = cursor
        .ahead(length)
        .split(|token| slips::is_mark(token, ','));
    let is_empty = names.next()?.is_empty();
    let names = names.map(|name| match name {
        [TokenTree::Ident(name)] => Some(format!(" {digit} {name};")),
        _ => None,
    });
    let names = names.collect::<Option<Vec<_>>>()?.concat();
    (is_empty && !names.is_empty())
        .then(|| format!("each junction has a statement of its own: `{digit} {first};{names}`"))
}

/// Ends a junction without braces; with each word that may stand before the end comes whether it was read.
fn undelimited(cursor: &mut Cursor, words: &[(&str, bool)], sink: &mut Sink<'_>) -> Parsed<()> {
    let missing = words.iter().filter(|(_, read)| !read);
    let missing: Vec<&str> = missing.map(|(word, _)| *word).collect();
    let wanted = format!(
        "{} after {}",
        words::alternatives(&[missing.as_slice(), &["{", ";"]].concat()),
        cursor.previous()
    );
    let word = cursor.ident(0).map(ToString::to_string).unwrap_or_default();
    if word.starts_with("initial") && cursor.punct(1, ':') {
        let report = *cursor.expected(&wanted);
        cursor.advance(2);
        let value = condition(cursor, &format!("the value of `{word}`"))?;
        let help = format!(
            "a flow at the start is given with the inertia, `I … {{ inertia: …, initial_flow: {0} }}`, or with a coordinate, \
             `1 … coordinate, initial_flow: {0} {{ … }}`",
            dump::expression(&value)
        );
        return Err(Box::new(report.help(help)));
    }
    if let Some(near) = words::nearest(&word, &missing) {
        return Err(Box::new(
            (*cursor.expected(&wanted)).help(format!("did you mean `{near}`?")),
        ));
    }
    finish(cursor, sink, &wanted)
}
