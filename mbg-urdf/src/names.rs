//! Names of a file as names of the language, no two alike.

use std::collections::BTreeSet;

use mbg_compiler::syntax::library;

/// Words of the language and of Rust, and the names that every printed component has.
const TAKEN: &[&str] = &[
    "abstract",
    "as",
    "async",
    "attitude",
    "await",
    "base",
    "become",
    "box",
    "break",
    "causality",
    "close",
    "const",
    "continue",
    "coordinates",
    "crate",
    "do",
    "dyn",
    "e",
    "effort",
    "else",
    "enum",
    "extern",
    "f",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "gravity",
    "gravity_base",
    "if",
    "impl",
    "in",
    "include",
    "initial",
    "initial_rate",
    "input",
    "integral",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "orientation_base",
    "output",
    "override",
    "p",
    "param",
    "position_base",
    "priv",
    "pub",
    "q",
    "rates",
    "ref",
    "return",
    "Self",
    "self",
    "slide_slip",
    "slip",
    "static",
    "struct",
    "super",
    "t",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
];

/// The names given so far.
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    pub(crate) fn new() -> Self {
        Self(TAKEN.iter().map(|word| (*word).to_owned()).collect())
    }

    /// The name itself where it can be one, or the nearest that is free.
    pub(crate) fn take(&mut self, wanted: &str) -> String {
        let plain = identifier(wanted);
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let free = std::iter::once(plain.clone())
            .chain(numbered)
            .find(|name| !self.0.contains(name))
            .unwrap_or(plain);
        self.0.insert(free.clone());
        free
    }
}

/// Letters, digits and underscores, and no digit first.
fn identifier(text: &str) -> String {
    let plain = |it: char| if it.is_ascii_alphanumeric() { it } else { '_' };
    let name: String = text.chars().map(plain).collect();
    match name.chars().next() {
        Some(first) if !first.is_ascii_digit() && name != "_" => name,
        _ => format!("a{name}"),
    }
}

/// `UpperCamelCase`, as components are named, and no name that is in use already.
pub(crate) fn component(text: &str) -> String {
    let words = text.split(|it: char| !it.is_ascii_alphanumeric());
    let name: String = words
        .filter_map(|word| Some((word.chars().next()?.to_ascii_uppercase(), &word[1..])))
        .map(|(first, rest)| format!("{first}{rest}"))
        .collect();
    // One with the name of a component of the library would hide that.
    let free = name != "Self" && library::names().all(|it| it != name);
    match name.chars().next() {
        Some(first) if first.is_ascii_alphabetic() && free => name,
        _ => format!("Robot{name}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_can_be_written_and_differ() {
        let mut names = Names::new();
        let given = ["arm", "arm", "l-arm.1", "1", "type", "größe", ""].map(|it| names.take(it));
        assert_eq!(
            given,
            ["arm", "arm_2", "l_arm_1", "a1", "type_2", "gr__e", "a"]
        );
    }

    #[test]
    fn components_are_in_camel_case() {
        let given = ["panda", "my_robot-2", "", "6r", "self", "body"].map(component);
        let expected = [
            "Panda",
            "MyRobot2",
            "Robot",
            "Robot6r",
            "RobotSelf",
            "RobotBody",
        ];
        assert_eq!(given, expected);
    }
}
