//! Statements of other languages, and what is written here instead.

use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree};

use super::cursor::Cursor;
use super::dump;
use super::slips::is_mark;
use super::words;
use crate::units::is_name_of_unit;

/// Words that declare a value in other languages, and the words that do so here.
const DECLARING: &[(&str, &str)] = &[
    ("parameter", "param"),
    ("constant", "let"),
    ("const", "let"),
    ("var", "let"),
    ("signal", "let"),
    ("Real", "let"),
];

/// Words for types, which declarations do not name here.
const TYPES: &[&str] = &["Real", "Integer", "float", "double", "f64"];

/// What elements are called in the parts of physics, and the kind that they are here.
const PARTS: &[(&[&str], &str)] = &[
    (
        &["mass", "inertia", "inductor", "inductance", "coil", "l"],
        "I",
    ),
    (
        &["spring", "capacitor", "capacitance", "compliance", "tank"],
        "C",
    ),
    (&["damper", "dashpot", "resistor", "resistance", "d"], "R"),
    (
        &[
            "f",
            "force",
            "torque",
            "voltage",
            "pressure",
            "battery",
            "effortsource",
        ],
        "Se",
    ),
    (&["velocity", "speed", "current", "flowsource"], "Sf"),
    (&["transformer", "lever", "gear"], "TF"),
    (&["gyrator"], "GY"),
];

/// What bond graphs call `R` and its like where another value tells the law.
const MODULATED: &[(&str, &str)] = &[
    ("mse", "Se"),
    ("msf", "Sf"),
    ("mi", "I"),
    ("mc", "C"),
    ("mr", "R"),
];

/// Elements of bond graphs that have no name here, and what is written for them.
const WITHOUT_NAME: &[(&str, &str)] = &[
    (
        "de",
        "what is measured is read, and needs no detector: `output name = node.e;` of a 0-junction `node`",
    ),
    (
        "df",
        "what is measured is read, and needs no detector: `output name = rod.f;` of a 1-junction `rod`",
    ),
    (
        "ss",
        "a source and what it measures are written apart: `Se name { effort: … }` and `output measured = name.f;`, or `Sf` and \
         `name.e`",
    ),
    (
        "rs",
        "write `R name { … }`, and the entropy that it generates as a source of flow where the temperature `node.e` is: \
         `Sf entropy { flow: name.e * name.f / node.e }`",
    ),
    (
        "ce",
        "write `C name { effort: rt * ln(k * q), initial: … }`: the chemical potential of the amount `q`, with `rt` in `J/mol`",
    ),
    (
        "re",
        "a reaction takes both affinities: `forward -> name[0]; name[1] -> reverse;` of a junction `0 name[2]`, and \
         `name -> R reaction[2] { flow: [rate, -rate] }` with `let rate = kappa * (exp(name.e[0] / rt) - exp(name.e[1] / rt));`",
    ),
    (
        "ic",
        "write `C name { energy: … }` on a junction with a component for each port; a port of a momentum lies behind a `GY` with \
         `effort: 1.0`",
    ),
    (
        "sw",
        "a switch is `R name { conductance: if … { … } else { … } }`, or on the average an `MTF`",
    ),
];

/// What to type for an element of bond graphs that has another name here, or none, without regard to capitals.
pub(super) fn element(word: &str) -> Option<String> {
    let plain = word.to_lowercase().replace('_', "");
    let mut modulated = MODULATED.iter();
    if let Some((_, kind)) = modulated.find(|(other, _)| *other == plain) {
        return Some(format!(
            "write `{kind}`: any law may be modulated by what it reads"
        ));
    }
    let mut without_name = WITHOUT_NAME.iter();
    if let Some((_, help)) = without_name.find(|(other, _)| *other == plain) {
        return Some((*help).to_owned());
    }
    if let Some(digit) = words::digit_in_words(word) {
        return Some(format!(
            "a junction is declared by its digit, in a statement of its own, `{digit} name;`, and its name stands in bonds"
        ));
    }
    let mut parts = PARTS.iter();
    let (_, kind) = parts.find(|(others, _)| others.contains(&plain.as_str()))?;
    let law = words::law_words(words::element(kind)?).first()?;
    Some(format!("write `{kind} name {{ {law}: … }}`"))
}

/// What to type for the statement that begins here, if another language has it.
pub(super) fn statement(cursor: &Cursor) -> Option<String> {
    let word = cursor.ident(0)?.to_string();
    if let Some(help) = rate(cursor) {
        return Some(help);
    }
    let arguments = || cursor.group(1, Delimiter::Parenthesis);
    match word.as_str() {
        "connect" => {
            let ends = divided(arguments()?.stream(), ',');
            let [from, to] = &ends[..] else { return None };
            Some(format!(
                "a bond is written with an arrow: `{from} -> {to};`"
            ))
        }
        "fn" | "function" | "def" => function(cursor),
        "pub" => {
            let behind = 1 + usize::from(arguments().is_some());
            cursor.ident(behind)?;
            Some(format!(
                "what is declared is as visible as its model: write `{};`",
                dump::tokens(until_end(cursor, behind))
            ))
        }
        "bond" if cursor.arrow(2) => Some(format!(
            "a bond is written without a word before it: `{};`",
            dump::tokens(until_end(cursor, 1))
        )),
        "pseudo" | "coordinate" if cursor.junction_digit(1) => {
            let (digit, name) = (cursor.peek(1)?, cursor.ident(2)?);
            let size = cursor.group(3, Delimiter::Bracket);
            let behind = 3 + usize::from(size.is_some());
            let size = size.map_or_else(String::new, ToString::to_string);
            let end = match cursor.group(behind, Delimiter::Brace) {
                Some(_) => " { … }",
                None => ";",
            };
            Some(format!(
                "it stands behind the name of the junction: `{digit} {name}{size} {word}{end}`"
            ))
        }
        "state" if cursor.ident(1).is_some() => state(cursor),
        "initial" | "init" | "start" if cursor.ident(1).is_some() => Some(start(cursor)),
        "import" => imported(cursor),
        "annotation" => {
            arguments()?;
            Some("what is drawn or told of a model stands in comments, `//` and `///`: leave `annotation(…)` out".to_owned())
        }
        "reinit" if cursor.group(1, Delimiter::Parenthesis).is_some() => Some(EVENTS.to_owned()),
        "end" if cursor.ident(1).is_some() => Some(format!(
            "braces close what they open: leave `{};` out",
            dump::tokens(until_end(cursor, 0))
        )),
        _ if SECTIONS.contains(&word.as_str()) && cursor.ident(1).is_some() => Some(format!(
            "statements stand side by side, in no sections: leave `{word}` out"
        )),
        _ => {
            let (_, here) = DECLARING.iter().find(|(other, _)| *other == word)?;
            declaration(cursor, here)
        }
    }
}

/// What to type for `import Modelica.Constants.pi;`.
pub(super) fn imported(cursor: &Cursor) -> Option<String> {
    let is_import = cursor.ident(0).is_some_and(|word| word == "import");
    cursor.ident(1).filter(|_| is_import)?;
    let path = dump::tokens(until_end(cursor, 1));
    Some(match path.ends_with(".pi") {
        true => "nothing is imported: write `let pi = 3.141592653589793;` in the model".to_owned(),
        false => format!(
            "nothing is imported, and the library and the units are there without it: leave `import {path};` out"
        ),
    })
}

/// What finds events.
pub(super) const EVENTS: &str = "events are found while a model runs: `Integrator::until` stops where a guard goes through zero, and \
                                 the next run starts from there";

/// Words that begin sections of models in other languages.
const SECTIONS: &[&str] = &[
    "equation",
    "equations",
    "algorithm",
    "variables",
    "parameters",
    "constants",
    "code",
    "dynamics",
    "protected",
    "public",
    "begin",
];

/// What to type for an equation of a rate: `der(x) = v;`, `der x = v;`, `dx/dt = v;`, `d(x)/dt = v;` or `x_dot = v;`.
fn rate(cursor: &Cursor) -> Option<String> {
    let word = cursor.ident(0)?.to_string();
    let of = cursor.group(1, Delimiter::Parenthesis);
    let is_by_time = |at: usize| {
        cursor.punct(at, '/')
            && cursor.ident(at + 1).is_some_and(|it| it == "dt")
            && cursor.punct(at + 2, '=')
    };
    if DERIVATIVES.contains(&word.as_str()) && cursor.ident(1).is_some() && cursor.punct(2, '=') {
        return Some(integral(&dump::tokens(until_end(cursor, 1))));
    }
    let (name, behind) = match (of, word.strip_prefix('d'), word.strip_suffix("_dot")) {
        (Some(of), _, _) if DERIVATIVES.contains(&word.as_str()) && cursor.punct(2, '=') => {
            (dump::tokens(of.stream()), 3)
        }
        (Some(of), Some(""), _) if is_by_time(2) => (dump::tokens(of.stream()), 5),
        (None, Some(name), _) if is_by_time(1) => (name.to_owned(), 4),
        (None, _, Some(name)) if cursor.punct(1, '=') => (name.to_owned(), 2),
        _ => return None,
    };
    let name = match syn::parse_str::<Ident>(&name) {
        Ok(_) => name,
        Err(_) => "name".to_owned(),
    };
    let rate = dump::tokens(until_end(cursor, behind));
    Some(integral(&format!("{name} = {rate}")))
}

/// Words for a derivative by time.
const DERIVATIVES: &[&str] = &["der", "derivative", "ddt", "dot", "D"];

fn integral(declared: &str) -> String {
    format!("what has a rate is declared with it: `integral {declared};`")
}

/// What to type for `initial x = 1.0;`.
fn start(cursor: &Cursor) -> String {
    let storages = "what storages begin with stands in their braces: `I body { inertia: …, initial_flow: … }`, `C spring { stiffness: …, \
                    initial: … }`";
    match cursor.ident(1) {
        Some(name) if cursor.punct(2, '=') => {
            let value = dump::tokens(until_end(cursor, 3));
            format!(
                "{storages}; an integral is declared with it: `integral {name} = …, initial: {value};`"
            )
        }
        _ => storages.to_owned(),
    }
}

/// What to type for `attitude q { rate: body.f }`.
pub(super) fn attitude_in_braces(cursor: &Cursor, name: &Ident) -> Option<String> {
    let inner = Cursor::inside(cursor.group(0, Delimiter::Brace)?);
    let rate = until_end(&inner, 2).into_iter();
    let rate = match inner.punct(1, ':') {
        true => dump::tokens(rate.take_while(|token| !is_mark(token, ',')).collect()),
        false => "…".to_owned(),
    };
    Some(format!(
        "an attitude follows from an angular velocity in body axes: write `attitude {name} = quaternion({rate});`"
    ))
}

/// `state charge: C = 1.0;`
fn state(cursor: &Cursor) -> Option<String> {
    let tokens: Vec<TokenTree> = until_end(cursor, 1).into_iter().collect();
    let mut parts = tokens.splitn(2, |token| is_mark(token, '='));
    let [declared, value] = [parts.next(), parts.next()]
        .map(|part| part.map(|part| dump::tokens(part.iter().cloned().collect())));
    let initial = value.unwrap_or_else(|| "…".to_owned());
    Some(format!(
        "storages have states of their own, which begin with `initial: {initial}` in their braces; another is an integral: \
         `integral {} = …, initial: {initial};`",
        declared?
    ))
}

/// `fn square(x) = x * x;`
fn function(cursor: &Cursor) -> Option<String> {
    let name = cursor.ident(1)?;
    let parameters = cursor.group(2, Delimiter::Parenthesis)?;
    let value = match cursor.punct(3, '=') {
        true => dump::tokens(until_end(cursor, 4)),
        false => "…".to_owned(),
    };
    Some(format!(
        "functions are not declared: write `let {name} = {value};` with what is read in the place of `{}`, or give elements \
         with one law to a `component`",
        dump::tokens(parameters.stream())
    ))
}

/// `parameter Real mass(min = 0) = 1.0 "of it";` as it is declared here, without its type, its attributes and its comment.
fn declaration(cursor: &Cursor, word: &str) -> Option<String> {
    let mut places = (1..).take_while(|at| cursor.peek(*at).is_some());
    let at = places.find(|at| cursor.ident(*at).is_some() && ends_name(cursor, at + 1))?;
    let mut behind = at + 1;
    if cursor.group(behind, Delimiter::Parenthesis).is_some() {
        behind += 1;
    }
    let is_comment = |token: &TokenTree| token.to_string().starts_with('"');
    let rest = until_end(cursor, behind).into_iter();
    let rest = dump::tokens(rest.filter(|token| !is_comment(token)).collect());
    let name = cursor.ident(at)?;
    let rest = match rest.as_str() {
        "" if word == "let" => "= …",
        rest => rest,
    };
    let space = if rest.starts_with('=') { " " } else { "" };
    Some(format!("write `{word} {name}{space}{rest};`"))
}

/// Whether what stands here can follow the name in a declaration.
fn ends_name(cursor: &Cursor, at: usize) -> bool {
    let ends = [':', '=', ';'].iter().any(|end| cursor.punct(at, *end));
    ends || matches!(cursor.peek(at), None | Some(TokenTree::Group(_)))
}

/// The tokens from an offset up to the end of the statement.
fn until_end(cursor: &Cursor, offset: usize) -> TokenStream {
    let length = cursor.length_until(|it, at| it.punct(at, ';'));
    let ahead = cursor.ahead(length);
    ahead
        .get(offset..)
        .unwrap_or_default()
        .iter()
        .cloned()
        .collect()
}

/// The texts between marks of this kind.
fn divided(tokens: TokenStream, mark: char) -> Vec<String> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let parts = tokens.split(|token| is_mark(token, mark));
    parts
        .map(|part| dump::tokens(part.iter().cloned().collect()))
        .collect()
}

/// What to type for an integral with limits.
pub(super) const LIMITED: &str = "it is its rate that ends at limits: `integral x = if x > upper { min(rate, 0.0) } else if x < lower \
                                  { max(rate, 0.0) } else { rate };`";

/// Whether a limit of an integrator has this name elsewhere.
pub(super) fn is_limit(word: &str) -> bool {
    let limits = [
        "min", "max", "limit", "limits", "lower", "upper", "outmin", "outmax",
    ];
    limits.contains(&word.to_lowercase().replace('_', "").as_str())
}

/// What to type for `force[N]` or `force(N)`, with the unit in brackets behind the name, and for `force(t)`.
pub(super) fn unit_in_brackets(cursor: &Cursor, word: &str, name: &Ident) -> Option<String> {
    let mut brackets = [Delimiter::Bracket, Delimiter::Parenthesis].into_iter();
    let group = brackets.find_map(|delimiter| cursor.group(0, delimiter))?;
    let tokens: Vec<TokenTree> = group.stream().into_iter().collect();
    let is_of_unit = |token: &TokenTree| match token {
        TokenTree::Ident(name) => is_name_of_unit(&name.to_string()),
        TokenTree::Group(_) => false,
        TokenTree::Punct(_) | TokenTree::Literal(_) => true,
    };
    let begins = matches!(tokens.first(), Some(TokenTree::Ident(_)));
    if !begins || !tokens.iter().all(is_of_unit) {
        return None;
    }
    let unit: String = tokens.iter().map(ToString::to_string).collect();
    let rest = dump::tokens(until_end(cursor, 1));
    if unit == "t" || unit == "time" {
        let unit = if rest.starts_with(':') { "" } else { " " };
        return Some(format!(
            "all values may change with time: write `{word} {name}{unit}{rest};`"
        ));
    }
    let space = if rest.is_empty() { "" } else { " " };
    Some(format!(
        "a unit stands behind a colon: `{word} {name}: {unit}{space}{rest};`"
    ))
}

/// What to type for `input: N;`, which lacks a name.
pub(super) fn unnamed(cursor: &Cursor, word: &Ident) -> Option<String> {
    let mut named = ["param", "input", "output", "integral", "let"].iter();
    let is_unnamed = cursor.punct(0, ':') && named.any(|named| word == named);
    let rest = || dump::tokens(until_end(cursor, 0));
    is_unnamed.then(|| format!("write `{word} name{};`", rest()))
}

/// What to type for a declaration with a type, which was read as its name.
pub(super) fn without_type(cursor: &Cursor, word: &str, name: &Ident) -> Option<String> {
    let is_type = TYPES.iter().any(|known| name == known) && cursor.ident(0).is_some();
    let declared = || dump::tokens(until_end(cursor, 0));
    is_type.then(|| format!("write `{word} {};`", declared()))
}

/// What to type for parameters in parentheses, as in `joint: Revolute(axis: 2) (a, b);`.
pub(super) fn parameters(
    cursor: &Cursor,
    offset: usize,
    name: &Ident,
    component: &Ident,
) -> Option<String> {
    let group = cursor.group(offset, Delimiter::Parenthesis)?;
    let inside = Cursor::inside(group);
    let is_given = |mark| inside.ident(0).is_some() && inside.punct(1, mark);
    let parameters = match (is_given(':'), is_given('=')) {
        (true, _) => dump::tokens(group.stream()),
        (_, true) => with_colons(group),
        _ => return None,
    };
    let ports = cursor.group(offset + 1, Delimiter::Parenthesis);
    let ports = ports.map_or_else(|| "…".to_owned(), |ports| dump::tokens(ports.stream()));
    Some(format!(
        "parameters stand in braces: `{name}: {component} {{ {parameters} }} ({ports});`"
    ))
}

/// What to type for `piston: Piston { … } (p: line, x: rod);`, with the names of the ports.
pub(super) fn ports(
    cursor: &Cursor,
    name: &Ident,
    component: &Ident,
    braces: &Group,
) -> Option<String> {
    let given = cursor.group(0, Delimiter::Parenthesis)?;
    let given = divided(given.stream(), ',');
    let junctions = given.iter().map(|it| {
        let (port, junction) = it.split_once([':', '='])?;
        let is_name = syn::parse_str::<Ident>(port.trim()).is_ok();
        is_name.then(|| junction.trim().to_owned())
    });
    let junctions: Option<Vec<_>> = junctions.collect();
    let parameters = dump::tokens(braces.stream());
    Some(format!(
        "junctions are given in the order of the ports: `{name}: {component} {{ {parameters} }} ({});`",
        junctions?.join(", ")
    ))
}

/// Each `word = value` as `word: value`.
fn with_colons(group: &Group) -> String {
    let given = divided(group.stream(), ',');
    let given = given.iter().map(|given| given.replacen(" =", ":", 1));
    given.collect::<Vec<_>>().join(", ")
}
