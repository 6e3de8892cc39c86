//! Changes to lists of tokens.

use std::ops::Range;

use proptest::prelude::*;
use proptest::sample::{Index, select};

use crate::tokens::SOUP;

/// Numbers at which laws and sizes are special, and some that are very large or small.
const NUMBERS: &[&str] = &[
    "0", "1", "2", "7", "0.0", "1.0", "2.0", "0.5", "-1.0", "1e-300", "1e300",
];

/// Words of laws, which the grammar alone does not know.
const LAWS: &[&str] = &[
    "sin",
    "cos",
    "exp",
    "ln",
    "sqrt",
    "abs",
    "sign",
    "tanh",
    "powi",
    "min",
    "atan",
    "atan2",
    "pow",
    "skew",
    "diag",
    "transpose",
    "rot_x",
    "matrix_of",
    "p",
    "e",
    "f",
    "t",
    "y",
    "z",
    "C",
    "Sf",
    "TF",
    "GY",
    "MGY",
    "EJS",
    "effort",
    "flow",
    "energy",
    "inertia",
    "stiffness",
    "compliance",
    "resistance",
    "conductance",
    "momentum",
    "gyroscopic",
    "componentwise",
    "multipliers",
];

/// What is done at a token; the word is another of the text, or one of the language.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Change {
    Remove,
    Repeat,
    Replace(Word),
    Insert(Word),
    Swap,
    /// The next name becomes another of the text.
    Rename,
    /// The next number becomes another.
    Renumber(&'static str),
    RemoveStatement,
    RepeatStatement,
    MoveStatement,
}

/// Where a word comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Word {
    Text,
    Language(&'static str),
}

/// A change, where, and from or to where.
#[derive(Clone, Debug)]
pub(crate) struct Mutation {
    change: Change,
    at: Index,
    other: Index,
}

pub(crate) fn mutation() -> impl Strategy<Value = Mutation> {
    let word = || {
        prop_oneof![
            Just(Word::Text),
            select(SOUP).prop_map(Word::Language),
            select(LAWS).prop_map(Word::Language),
        ]
    };
    // Of other numbers and names more is accepted than of other tokens.
    let change = prop_oneof![
        1 => Just(Change::Remove),
        1 => Just(Change::Repeat),
        1 => word().prop_map(Change::Replace),
        1 => word().prop_map(Change::Insert),
        1 => Just(Change::Swap),
        3 => Just(Change::Rename),
        8 => select(NUMBERS).prop_map(Change::Renumber),
        2 => Just(Change::RemoveStatement),
        2 => Just(Change::RepeatStatement),
        2 => Just(Change::MoveStatement),
    ];
    (change, any::<Index>(), any::<Index>()).prop_map(|(change, at, other)| Mutation {
        change,
        at,
        other,
    })
}

/// A text after all mutations.
pub(crate) fn mutated(mut words: Vec<String>, mutations: &[Mutation]) -> Vec<String> {
    for mutation in mutations.iter() {
        if !words.is_empty() {
            mutate(&mut words, mutation);
        }
    }
    words
}

fn mutate(words: &mut Vec<String>, mutation: &Mutation) {
    let (at, other) = (
        mutation.at.index(words.len()),
        mutation.other.index(words.len()),
    );
    let taken = |word: Word| match word {
        Word::Text => words[other].clone(),
        Word::Language(word) => word.to_owned(),
    };
    match mutation.change {
        Change::Remove => drop(words.remove(at)),
        Change::Repeat => words.insert(at, words[at].clone()),
        Change::Replace(word) => words[at] = taken(word),
        Change::Insert(word) => words.insert(at, taken(word)),
        Change::Swap => words.swap(at, other),
        Change::Rename => {
            let is_name = |word: &str| word.starts_with(|it: char| it.is_alphabetic());
            if let (Some(at), Some(other)) = (next(words, at, is_name), next(words, other, is_name))
            {
                words[at] = words[other].clone();
            }
        }
        Change::Renumber(number) => {
            let is_number = |word: &str| word.starts_with(|it: char| it.is_ascii_digit());
            if let Some(at) = next(words, at, is_number) {
                words[at] = number.to_owned();
            }
        }
        Change::RemoveStatement => drop(words.drain(statement(words, at))),
        Change::RepeatStatement => {
            let statement = words[statement(words, at)].to_vec();
            let to = self::statement(words, other).start;
            words.splice(to..to, statement);
        }
        Change::MoveStatement => {
            let statement: Vec<String> = words.drain(statement(words, at)).collect();
            let to = self::statement(words, other.min(words.len())).start;
            words.splice(to..to, statement);
        }
    }
}

/// The first such word from a place on.
fn next(words: &[String], from: usize, is_such: impl Fn(&str) -> bool) -> Option<usize> {
    let rest = words[from..].iter().position(|word| is_such(word));
    rest.map(|behind| from + behind)
}

/// The statement, or the fields in braces, around a place.
fn statement(words: &[String], at: usize) -> Range<usize> {
    let ends = |word: &String| matches!(word.as_str(), ";" | "{" | "}");
    let start = words[..at].iter().rposition(ends).map_or(0, |end| end + 1);
    let mut depth = 0;
    for (place, word) in words.iter().enumerate().skip(start) {
        match word.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" if depth == 0 => return start..place,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        // What stands behind the braces of an element or a call belongs to it.
        let goes_on = words
            .get(place + 1)
            .is_some_and(|word| matches!(word.as_str(), "(" | "->" | ";"));
        if depth == 0 && (word == ";" || word == "}" && !goes_on) {
            return start..place + 1;
        }
    }
    start..words.len()
}
