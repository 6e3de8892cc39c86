//! Texts as flat lists of tokens, so that tests can change them at random.

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};

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

/// All tokens of a text with their brackets flat; signs that stand together are one word.
pub(crate) fn flat(tokens: TokenStream, into: &mut Vec<String>) {
    let mut joint = false;
    for token in tokens {
        let continues = std::mem::replace(
            &mut joint,
            matches!(&token, TokenTree::Punct(sign) if sign.spacing() == Spacing::Joint),
        );
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
            other => {
                let word = other.to_string();
                match into.last_mut().filter(|_| continues) {
                    Some(sign) => sign.push_str(&word),
                    None => into.push(word),
                }
            }
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
        text.push_str(word);
        text.push(' ');
    }
    open.iter().rev().for_each(|close| text.push_str(close));
    text
}
