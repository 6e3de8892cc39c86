//! Mistakes in models: each is answered with its code at a token, and the macro never panics.
#![allow(clippy::unwrap_used)]

mod tokens;

use mbg_compiler::codes::{self, ALL};
use mbg_compiler::diagnostics::{Code, Diagnostics};
use mbg_compiler::items;
use proptest::prelude::*;
use tokens::{SOUP, flat, matched};

/// What is reported for the text between the braces.
fn diagnose(text: &str) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    let _ = items(text.parse().unwrap(), &mut diagnostics);
    diagnostics
}

fn found(text: &str) -> Vec<&'static str> {
    let diagnostics = diagnose(text);
    let list = diagnostics.list().iter();
    list.map(|diagnostic| diagnostic.code.text).collect()
}

/// A model with one inertia beside the mistake.
macro_rules! beside_a_mass {
    ($body:literal) => {
        concat!("model M { 1 a { I m { inertia: 1.0 } } ", $body, " }")
    };
}

fn beside_a_mass(body: &str) -> String {
    beside_a_mass!("BODY").replace("BODY", body)
}

/// The smallest text for each code, in order of the codes; the last is [`too_large`].
const FIXTURES: &[(Code, &str)] = &[
    (codes::SYNTAX, beside_a_mass!("a => a;")),
    (codes::UNIT, beside_a_mass!("param x: N^x = 1.0;")),
    (codes::DIMENSION_LITERAL, beside_a_mass!("1 b[0];")),
    (
        codes::FIELD_REPEATED,
        "model M { 1 a { I m { inertia: 1.0, inertia: 1.0 } } }",
    ),
    (codes::INCLUDE, beside_a_mass!("include \"mine.mbg\";")),
    (
        codes::EMPTY_MODEL,
        "model M { 1 a { R r { resistance: 1.0 } } }",
    ),
    (codes::DUPLICATE_NAME, beside_a_mass!("1 a { }")),
    (codes::UNKNOWN_NAME, beside_a_mass!("a -> b;")),
    (
        codes::WRONG_DIMENSION,
        beside_a_mass!("1 b[2] { I n { inertia: 1.0 } } a -> b;"),
    ),
    (codes::MISSING_LAW, "model M { 1 a { I m { } } }"),
    (
        codes::TWO_LAWS,
        beside_a_mass!("a -> R r { resistance: 1.0, conductance: 1.0 };"),
    ),
    (
        codes::UNKNOWN_FIELD,
        beside_a_mass!("a -> R r { resistance: 1.0, stiffness: 1.0 };"),
    ),
    (
        codes::UNCONNECTED,
        beside_a_mass!("a -> TF t { flow: 2.0 };"),
    ),
    (codes::TOO_MANY_BONDS, beside_a_mass!("a -> m;")),
    (
        codes::EQUAL_ONE_PORTS,
        beside_a_mass!("Se s { effort: 1.0 } -> Se t { effort: 2.0 };"),
    ),
    (
        codes::LITERAL,
        beside_a_mass!("a -> R r { resistance: 1e999 };"),
    ),
    (
        codes::POWER_OPERATOR,
        beside_a_mass!("a -> R r { effort: f ^ 2 };"),
    ),
    (
        codes::EXPRESSION,
        beside_a_mass!("a -> R r { resistance: \"x\" };"),
    ),
    (codes::MISSING_DEFAULT, beside_a_mass!("param x: N;")),
    (
        codes::RECURSION,
        "component C() { c: C (); } model M { c: C (); }",
    ),
    (
        codes::NOT_FINITE,
        "model M { 1 a { I m { inertia: -1.0 } } }",
    ),
    (
        codes::WHOLE_NUMBER,
        beside_a_mass!("for k in 0..2.5 { 1 b; }"),
    ),
    (codes::CYCLE, beside_a_mass!("let x = y; let y = x;")),
    (
        codes::WORD,
        "component C(port a) { param b: x | y = x; a -> I m { inertia: 1.0 }; }
         model M { 1 a; c: C { b: z } (a); }",
    ),
    (
        codes::CONDITION,
        beside_a_mass!("param x = 1.0; if x > 0 { 1 b; }"),
    ),
    (
        codes::NO_ROTATION,
        beside_a_mass!(
            "1 b[3] { I n { inertia: 1.0 } } attitude r = matrix(b.f), initial: diag(1.0, 1.0, -1.0);"
        ),
    ),
    (
        codes::STORAGE_DERIVATIVE,
        beside_a_mass!("a -> I n { inertia: 2.0 };"),
    ),
    (
        codes::SOURCES_CONFLICT,
        beside_a_mass!("Sf s { flow: 1.0 } -> a; Sf t { flow: 2.0 } -> a;"),
    ),
    (
        codes::NO_ASSIGNMENT,
        beside_a_mass!("1 b { Se s { effort: 1.0 } }"),
    ),
    (
        codes::GYROSCOPIC_INVERSE,
        beside_a_mass!("1 b[3] { EJS g { momentum: [0.0, 0.0, 1.0] } Se s { effort: 0.0 } }"),
    ),
    (
        codes::RECTANGULAR_INVERSE,
        "model M { 1 w[3] { I m { inertia: 1.0 } } 1 r { Se s { effort: 1.0 } }
                 r -> MTF t { flow: [[1.0], [0.0], [0.0]] } -> w; }",
    ),
    (
        codes::ORDER_LOST,
        beside_a_mass!("causality componentwise; a -> I n { inertia: 2.0 };"),
    ),
    (
        codes::FIXED_RESISTOR,
        beside_a_mass!("1 b { Se s { effort: 1.0 } R r { effort: abs(f) * f } }"),
    ),
    (
        codes::DISPLACEMENT,
        beside_a_mass!(
            "1 b { I n { inertia: 2.0 } } integral x = a.f; integral y = b.f;
                 close a -> b by multipliers, displacement: x + y;"
        ),
    ),
    (
        codes::SINGULAR_JUNCTIONS,
        beside_a_mass!("1 b; 0 c; b -> c; c -> b;"),
    ),
    (
        codes::NONLINEAR_LOOP,
        beside_a_mass!(
            "1 b { Se s { effort: 1.0 } R r { effort: powi(f, 3) } R l { resistance: 1.0 }
                 R n { effort: -powi(f, 3) - f } }"
        ),
    ),
    (
        codes::ORDER_LOST_UNSUPPORTED,
        beside_a_mass!("input u; 1 b { Sf s { flow: u } #[derivative] I n { inertia: 2.0 } }"),
    ),
    (
        codes::SINGULAR_START,
        beside_a_mass!(
            "1 b[3] { I n { inertia: 1.0 } } 1 c[3] { I o { inertia: 1.0 } }
             joint: Gimbal { first: 2, second: 0, third: 2 } (b, c);"
        ),
    ),
    (
        codes::UNIT_MISMATCH,
        beside_a_mass!("param x: m = 1.0; param y: s = 1.0; output z = x + y;"),
    ),
    (codes::UNIT_NAME, beside_a_mass!("param x: furlong = 1.0;")),
    (codes::UNIT_SCALE, beside_a_mass!("param x: N/mm = 1.0;")),
];

/// More bonds than a model may have.
fn too_large() -> String {
    beside_a_mass(&format!("0 b; {}", "a -> b;".repeat(5000)))
}

fn fixtures() -> impl Iterator<Item = (Code, String)> {
    let short = FIXTURES
        .iter()
        .map(|(code, text)| (*code, (*text).to_owned()));
    short.chain([(codes::TOO_LARGE, too_large())])
}

#[test]
fn every_code_has_a_fixture_that_produces_it() {
    let covered: Vec<Code> = fixtures().map(|(code, _)| code).collect();
    assert_eq!(covered, ALL);
    for (code, text) in fixtures() {
        let found = found(&text);
        assert!(
            found.contains(&code.text),
            "{code:?} for `{text:.200}`, found {found:?}"
        );
    }
}

#[test]
fn a_model_without_a_state_is_answered_so() {
    let cases = [
        ("", vec![]),
        ("model M { }", vec!["MBG0201"]),
        ("model M { 1 a; }", vec!["MBG0208", "MBG0201"]),
    ];
    for (text, codes) in cases {
        assert_eq!(found(text), codes, "{text}");
    }
}

/// Other ways into a mistake, each with all codes that it is answered with.
const BESIDE_A_MASS: &[(&str, &[&str])] = &[
    ("1 b;", &["MBG0208"]),
    (
        "causality componentwise; 1 b; output y = b.f;",
        &["MBG0208"],
    ),
    ("1 b[2]; Se s { effort: 1.0 } -> b.y;", &["MBG0208"]),
    ("Sf s { flow: 1.0 } -> Sf t { flow: 2.0 };", &["MBG0210"]),
    (
        "I n { inertia: 1.0 } -> I o { inertia: 2.0 };",
        &["MBG0210"],
    ),
    (
        "C c { stiffness: 1.0 } -> C d { stiffness: 2.0 };",
        &["MBG0210"],
    ),
    (
        "R r { resistance: 1.0 } -> R s { resistance: 2.0 };",
        &["MBG0210"],
    ),
    ("I n { inertia: 1.0 } -> a; a -> n;", &["MBG0209"]),
    ("x: Nothing (a);", &["MBG0203"]),
    ("output y = a;", &["MBG0213"]),
    ("output y = b.f;", &["MBG0203"]),
    ("output y = a.f.y;", &["MBG0204"]),
    ("output y = 1.0 / 0.0;", &["MBG0216"]),
    ("output y = sin();", &["MBG0213"]),
    ("output y = sine(1.0);", &["MBG0203"]),
    ("output y = [];", &["MBG0204"]),
    ("output y = a.f ^ 2;", &["MBG0212"]),
    ("output y = 1e400;", &["MBG0211"]),
    ("output y = powi(0.0, -1);", &["MBG0216"]),
    ("param x = y;", &["MBG0203"]),
    ("param x = 1.0; param x = 1.0;", &["MBG0202"]),
    ("input u; input u;", &["MBG0202"]),
    ("output y = 1.0; output y = 2.0;", &["MBG0202"]),
    ("a[1] -> R r { resistance: 1.0 };", &["MBG0204"]),
    ("MTF t { flow: [[1.0, 2.0]] } -> a;", &["MBG0208"]),
    ("a -> EJS g { momentum: [1.0, 2.0, 3.0] };", &["MBG0204"]),
    ("a -> I n { inertia: 1.0, gyroscopic };", &["MBG0204"]),
    ("a -> R r { resistance: diag(1.0, 2.0) };", &["MBG0204"]),
    (
        "a -> GY g { effort: e } -> b; 0 b { C c { stiffness: 1.0 } }",
        &["MBG0213"],
    ),
    ("a -> C c { stiffness: 0.0 };", &[]),
    ("a -> C c { compliance: 0.0 };", &["MBG0216"]),
    (
        "1 b[2] { I n { inertia: [[1.0, 2.0], [3.0, 4.0]] } }",
        &["MBG0213"],
    ),
    (
        "1 b[2] { I n { inertia: [[1.0, 1.0], [1.0, 1.0]] } }",
        &["MBG0216"],
    ),
    ("a -> R r { effort: q };", &["MBG0213"]),
    ("a -> C c { stiffness: 1.0, initial: a.f };", &["MBG0213"]),
    ("integral x = x, initial: x;", &["MBG0213"]),
    ("attitude q = quaternion(a.f);", &["MBG0204"]),
    (
        "attitude r = matrix([a.f, 0.0, 0.0]), initial: [1.0, 0.0, 0.0, 0.0];",
        &["MBG0204"],
    ),
    (
        "attitude r = matrix([a.f, 0.0, 0.0]), initial: diag(1.0, 1.0, 0.9);",
        &["MBG0221"],
    ),
    (
        "attitude q = quaternion([a.f, 0.0, 0.0]), initial: [0.0, 0.0, 0.0, 0.0];",
        &["MBG0221"],
    ),
    ("output y[3] = angles_of(1.0, 0, 0, 1);", &["MBG0213"]),
    ("output y[3] = angles_of(1.0, 0, 1, 3);", &["MBG0213"]),
    ("output y[3] = angles_of(2.0, 0, 1, 2);", &["MBG0204"]),
    ("output y[3] = angles_of(1.0);", &["MBG0213"]),
    (
        "output y[4] = quaternion_of(matrix_of([1.0, 0.0]));",
        &["MBG0204"],
    ),
    ("output y = rot(a.f, 0.0) * [1.0, 0.0, 0.0];", &["MBG0217"]),
];

#[test]
fn mistakes_are_answered_with_their_codes_alone() {
    for (body, codes) in BESIDE_A_MASS {
        assert_eq!(found(&beside_a_mass(body)), *codes, "{body}");
    }
}

#[test]
fn every_error_of_a_fixture_is_at_a_token() {
    for (_, text) in fixtures() {
        for diagnostic in diagnose(&text).list() {
            assert_ne!(
                diagnostic.span.start(),
                diagnostic.span.end(),
                "{}",
                diagnostic.text()
            );
        }
    }
}

#[test]
fn a_model_over_the_limit_is_answered_with_limit_and_count() {
    let diagnostics = diagnose(&too_large());
    assert_eq!(
        diagnostics.list()[0].message,
        "`M` has 5001 vector bonds, the limit is 4096"
    );
}

/// Models without a mistake.
const SOUND: [&str; 6] = [
    include_str!("syntax/oscillator.mbg"),
    include_str!("syntax/ins.mbg"),
    include_str!("stages/rotor.mbg"),
    include_str!("stages/slide.mbg"),
    include_str!("stages/classic_joints.mbg"),
    "component Slope(port a) { a -> R r { flow: abs(e) * e }; }
     model Small {
        causality componentwise; param k = 2.0; input u[2];
        1 a[2] { C c { stiffness: [[k, 0.0], [0.0, 1.0]] } R l { resistance: k } }
        Se push { effort: u } -> a;
        a.x -> GY g { effort: k } -> b;
        0 b { C d { effort: tanh(q) } I m { energy: if p < 0.0 { p * p } else { powi(p, 4) } } }
        s: Slope (b);
        integral x = m.f, initial: 1.0;
        output y = x * c.q.y;
     }",
];

#[test]
fn sound_models_have_no_errors() {
    for text in SOUND {
        assert_eq!(found(text), [""; 0], "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_changed_model_never_panics_and_its_errors_are_at_tokens(
        text in prop::sample::select(&SOUND[..]),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..5_usize), 1..4),
    ) {
        let mut words = Vec::new();
        flat(text.parse().expect("tokens"), &mut words);
        for (at, other, change) in changes {
            let (at, word) = (at.index(words.len()), words[other.index(words.len())].clone());
            match change {
                0 => drop(words.remove(at)),
                1 => words.insert(at, words[at].clone()),
                2 => words[at] = word,
                3 => words[at] = other.get(SOUP).to_string(),
                _ => {
                    let other = other.index(words.len());
                    words.swap(at, other);
                }
            }
        }
        let text = matched(words.iter().map(String::as_str));
        if let Ok(tokens) = text.parse() {
            let mut diagnostics = Diagnostics::new();
            let expansion = items(tokens, &mut diagnostics);
            for diagnostic in diagnostics.list() {
                let (start, end) = (diagnostic.span.start(), diagnostic.span.end());
                prop_assert!(start != end, "{} has no place in {text}", diagnostic.text());
            }
            prop_assert!(syn::parse2::<syn::File>(expansion).is_ok(), "the expansion is no Rust: {text}");
        }
    }
}

#[test]
fn a_mesh_of_gain_one_is_shown() {
    let text = beside_a_mass(
        "causality componentwise; param n = 2.0; 0 j0; 0 j1; 0 j2; j0 -> R r { resistance: 1.0 };
         j0 -> TF up { flow: n } -> j1; j1 -> TF down { flow: 0.5 } -> j2; j2 -> TF back { flow: 2.0 / n } -> j0;",
    );
    let mut diagnostics = Diagnostics::new();
    let _ = mbg_compiler::items(text.parse().unwrap(), &mut diagnostics);
    let [report] = diagnostics.list() else {
        panic!("one mistake, found {:?}", diagnostics.list())
    };
    assert_eq!(
        report.notes[1],
        "they form a mesh whose gain is one: 1 / (n) · 1 / (0.5) · 1 / (2/n)"
    );
}

/// A source that imposes what a transformer gives, and the same source where the help has it.
#[test]
fn a_source_that_asks_for_an_inverse_can_act_through_a_storage() {
    let column = "MTF axis { flow: [[1.0], [0.0], [0.0]] }";
    let flow =
        format!("1 rate {{ I rotor {{ inertia: 1.0 }} }} 1 wide[3]; rate -> {column} -> wide;");
    let effort = format!(
        "1 wide[3] {{ #[derivative] I rotor {{ inertia: 1.0 }} }} 0 rate; rate -> {column} -> wide;"
    );
    let cases = [
        (
            &flow,
            "Sf drive { flow: [0.0, 0.0, 0.0] }",
            "wide",
            "1 driven[3];",
            "0 between[3] { C spring { stiffness: … } } driven -> between; between -> wide;",
        ),
        (
            &effort,
            "Se push { effort: 1.0 }",
            "rate",
            "0 driven;",
            "1 between { I mass { inertia: … } } driven -> between; between -> rate;",
        ),
    ];
    for (model, source, place, driven, between) in cases {
        let imposed = diagnose(&format!("model M {{ {model} {source} -> {place}; }}"));
        let report = &imposed.list()[0];
        assert_eq!(report.code, codes::RECTANGULAR_INVERSE);
        assert!(report.helps[0].contains(&format!("bond it to `{driven}` and write `{between}`")));
        let mended = format!(
            "{driven} {} {source} -> driven;",
            between.replace('…', "1.0")
        );
        let codes = found(&format!("model M {{ {model} {mended} }}"));
        assert!(codes.is_empty(), "{codes:?}");
    }
}
