//! The words of the language, and the nearest one to what was typed.

use proc_macro2::Ident;

use super::ast::ElementKind;

/// Words that begin a statement.
pub(super) const STATEMENTS: &[&str] = &[
    "param",
    "input",
    "output",
    "integral",
    "attitude",
    "let",
    "gravity",
    "for",
    "close",
    "assert",
    "causality",
];

/// The word that takes a file into the macro call, before anything else.
pub(super) const INCLUDE: &str = "include";

/// The word that begins an event in other languages.
pub(super) const EVENT: &str = "when";

/// The word before a chosen value in other languages.
pub(super) const THEN: &str = "then";

/// Words that begin an item.
pub(super) const ITEMS: &[&str] = &["model", "component"];

/// The elements by name.
pub(crate) const ELEMENTS: &[(&str, ElementKind)] = &[
    ("Se", ElementKind::Se),
    ("Sf", ElementKind::Sf),
    ("I", ElementKind::I),
    ("C", ElementKind::C),
    ("R", ElementKind::R),
    ("TF", ElementKind::TF),
    ("GY", ElementKind::GY),
    ("MTF", ElementKind::MTF),
    ("MGY", ElementKind::MGY),
    ("EJS", ElementKind::EJS),
];

/// Functions, as messages list them.
pub(crate) const FUNCTIONS: [&str; 34] = [
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "exp",
    "ln",
    "sqrt",
    "abs",
    "sign",
    "tanh",
    "mod",
    "floor",
    "fraction",
    "min",
    "max",
    "pow",
    "powi",
    "interpolate",
    "diag",
    "transpose",
    "skew",
    "rot_x",
    "rot_y",
    "rot_z",
    "rot",
    "jacobian_xyz",
    "jacobian",
    "matrix_of",
    "quaternion_of",
    "angles_of",
    "rotation",
];

/// What cannot be a name, because the generated code could not spell it.
const RESERVED: &[&str] = &[
    "_", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "self", "Self", "static", "struct", "super", "trait", "true", "try", "type",
    "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Whether this is a keyword of Rust.
pub(super) fn is_reserved(word: &str) -> bool {
    RESERVED.contains(&word)
}

/// What to type for a keyword that was meant as a name.
pub(super) fn another_name(keyword: &str) -> String {
    format!("write another name, such as `{keyword}_`")
}

/// The words that carry a law, by element.
pub(crate) fn law_words(kind: ElementKind) -> &'static [&'static str] {
    match kind {
        ElementKind::Se | ElementKind::GY | ElementKind::MGY => &["effort"],
        ElementKind::Sf | ElementKind::TF | ElementKind::MTF => &["flow"],
        ElementKind::I => &["inertia", "flow", "energy"],
        ElementKind::C => &["stiffness", "compliance", "effort", "energy"],
        ElementKind::R => &["resistance", "conductance", "effort", "flow"],
        ElementKind::EJS => &["momentum"],
    }
}

/// The element of this name.
pub(super) fn element(word: &str) -> Option<ElementKind> {
    ELEMENTS
        .iter()
        .find(|(name, _)| *name == word)
        .map(|(_, kind)| *kind)
}

/// The name of this element.
pub(crate) fn element_name(kind: ElementKind) -> &'static str {
    ELEMENTS
        .iter()
        .find(|(_, other)| *other == kind)
        .map_or("", |(name, _)| name)
}

/// The names of the elements.
pub(super) fn element_names() -> Vec<&'static str> {
    ELEMENTS.iter().map(|(name, _)| *name).collect()
}

/// Whether an element has two ports.
pub(crate) fn is_two_port(kind: ElementKind) -> bool {
    matches!(
        kind,
        ElementKind::TF | ElementKind::GY | ElementKind::MTF | ElementKind::MGY
    )
}

/// The digit of a junction by its name in words, as in `One v { … }` or `J1 v { … }`.
pub(crate) fn digit_in_words(word: &str) -> Option<char> {
    let word = word.to_lowercase().replace('_', "");
    match word.as_str() {
        "one" | "onejunction" | "junction1" | "j1" | "spliteffort" => Some('1'),
        "zero" | "zerojunction" | "junction0" | "j0" | "splitflow" => Some('0'),
        _ => None,
    }
}

/// The elements as errors list them.
pub(super) fn element_listing() -> String {
    alternatives(&element_names())
}

/// The article before the name of an element, which is read by its letters, or before a number.
pub(crate) fn article(read: &str) -> &'static str {
    let begins_with_vowel = match read {
        "11" | "18" => true,
        _ => read.starts_with(['E', 'I', 'M', 'R', 'S', '8']),
    };
    if begins_with_vowel { "an" } else { "a" }
}

/// `` `a`, `b` or `c` ``.
pub(crate) fn alternatives(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// The word that was probably meant: two slips at most, fewer where either word is short, since every word of two
/// letters is two slips from every other, and many of four share two of them.
pub(crate) fn nearest<'a>(found: &str, words: &[&'a str]) -> Option<&'a str> {
    // A word far longer than any of ours is none of ours, and measuring it would cost its length squared.
    if found.chars().count() > 16 {
        return None;
    }
    let lower = found.to_lowercase();
    words
        .iter()
        .filter(|word| **word != found)
        .map(|word| (distance(&lower, &word.to_lowercase()), *word))
        .filter(|(distance, word)| *distance <= ((word.len().min(found.len()) + 1) / 3).min(2))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, word)| word)
}

/// The only word that begins with what was typed, as far as that is more than half of it.
pub(crate) fn shortened<'a>(found: &str, words: &[&'a str]) -> Option<&'a str> {
    let begins = |word: &&&str| word.starts_with(found) && 2 * found.len() > word.len();
    let mut words = words.iter().filter(begins);
    let word = words.next().filter(|word| **word != found)?;
    words.next().is_none().then_some(*word)
}

/// Words that share most of their letters with what was typed, in order, those first that are spelled most like it.
pub(crate) fn near<'a>(found: &str, words: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    // What makes a word longer than ours makes it no nearer to any of them.
    let found: String = found.to_lowercase().chars().take(16).collect();
    let words = words.map(|word| (distance(&found, &word.to_lowercase()), word));
    let mut words: Vec<(usize, &str)> = words
        .filter(|(distance, _)| 5 * distance <= 2 * found.chars().count())
        .collect();
    words.sort_by_key(|(distance, _)| *distance);
    words.into_iter().map(|(_, word)| word).collect()
}

/// Whether one of these words, of which some are unknown, was probably meant to be `word`.
pub(crate) fn is_misspelt<'a>(
    word: &str,
    found: impl IntoIterator<Item = &'a Ident>,
    known: &[&str],
) -> bool {
    let mut found = found.into_iter().map(ToString::to_string);
    found.any(|it| !known.contains(&it.as_str()) && nearest(&it, known) == Some(word))
}

/// Edit distance in which a swap of neighbours counts as one slip (optimal string alignment).
fn distance(left: &str, right: &str) -> usize {
    let left: Vec<char> = left.chars().collect();
    let right: Vec<char> = right.chars().collect();
    let mut rows: Vec<Vec<usize>> = vec![(0..=right.len()).collect()];
    for i in 1..=left.len() {
        let mut row = vec![i];
        for j in 1..=right.len() {
            let differ = usize::from(left[i - 1] != right[j - 1]);
            let mut best = (rows[i - 1][j] + 1)
                .min(row[j - 1] + 1)
                .min(rows[i - 1][j - 1] + differ);
            if i > 1 && j > 1 && left[i - 1] == right[j - 2] && left[i - 2] == right[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[left.len()][right.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_found() {
        assert_eq!(nearest("parm", STATEMENTS), Some("param"));
        assert_eq!(nearest("ouptut", STATEMENTS), Some("output"));
        assert_eq!(nearest("parameter", STATEMENTS), None);
        assert_eq!(nearest("Model", ITEMS), Some("model"));
        assert_eq!(nearest("mtf", &element_names()), Some("MTF"));
        assert_eq!(nearest("r", &element_names()), Some("R"));
        assert_eq!(nearest("x", &element_names()), None);
        assert_eq!(nearest("s", &element_names()), None);
    }

    #[test]
    fn alternatives_read_as_a_sentence() {
        assert_eq!(alternatives(&["a"]), "`a`");
        assert_eq!(alternatives(&["a", "b", "c"]), "`a`, `b` or `c`");
    }
}
