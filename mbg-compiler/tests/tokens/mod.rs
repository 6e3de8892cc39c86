//! Texts as flat lists of tokens, so that tests can change them at random.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Words that tend to meet the grammar half way.
pub(crate) const SOUP: &[&str] = &[
    "model",
    "component",
    "pub",
    "port",
    "param",
    "input",
    "output",
    "integral",
    "attitude",
    "causality",
    "uniform",
    "quaternion",
    "initial",
    "coordinate",
    "for",
    "in",
    "let",
    "gravity",
    "close",
    "R",
    "Se",
    "MTF",
    "I",
    "a",
    "b",
    "q",
    "x",
    "0",
    "1",
    "2",
    "3.5",
    "1.",
    "\"s\"",
    "->",
    "-",
    ">",
    ":",
    "::",
    ";",
    ",",
    "=",
    "^",
    "*",
    "/",
    ".",
    "..",
    "..=",
    "#",
    "!",
    "'a",
    "#[derivative]",
    "/// d\n",
    "if",
    "else",
    "_",
    "r#type",
    "m2",
    "99999999999999999999",
];

/// All tokens of the valid models with their brackets flat.
pub(crate) fn flat(tokens: TokenStream, into: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                into.push(open.to_owned());
                flat(group.stream(), into);
                into.push(close.to_owned());
            }
            other => into.push(other.to_string()),
        }
    }
}

/// The text with brackets made to match: what closes nothing goes, what stays open is closed.
pub(crate) fn matched<'a>(words: impl Iterator<Item = &'a str>) -> String {
    let (mut text, mut open) = (String::new(), Vec::new());
    for word in words {
        let close = match word {
            "{" => Some("}"),
            "(" => Some(")"),
            "[" => Some("]"),
            _ => None,
        };
        if let Some(close) = close {
            open.push(close);
        } else if matches!(word, "}" | ")" | "]") && open.pop_if(|last| *last == word).is_none() {
            continue;
        }
        // A minus and a bracket stand together as they stood, and an arrow is two characters.
        text.push_str(word);
        if !matches!(word, "-" | "." | "=") {
            text.push(' ');
        }
    }
    open.iter().rev().for_each(|close| text.push_str(close));
    text
}
