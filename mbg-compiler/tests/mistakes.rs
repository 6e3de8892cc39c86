//! Mistakes in models: each is answered with its code at a token.
#![allow(clippy::unwrap_used)]

mod told;

use mbg_compiler::codes::{self, ALL};
use mbg_compiler::diagnostics::{Code, Diagnostics};
use mbg_compiler::items;
use told::{diagnose, told};

fn found(text: &str) -> Vec<&'static str> {
    let diagnostics = diagnose(text);
    let list = diagnostics.list().iter().chain(diagnostics.warnings());
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
        codes::JUNCTION_KIND,
        beside_a_mass!(
            "0 b { C c { compliance: 1.0 } } brake: Brake (b); }
             component Brake(port 1 at) { at -> R r { resistance: 1.0 };"
        ),
    ),
    (codes::UNREAD, beside_a_mass!("input u;")),
    (
        codes::NO_EFFECT,
        beside_a_mass!(
            "1 b { #[derivative] I n { inertia: 1.0 } } gear: Rack { radius: 0.1, blocked_stiffness: 1e5 } (a, b);"
        ),
    ),
    (
        codes::LOOSE_END,
        beside_a_mass!("0 b { R r { resistance: 1.0 } } 1 c; 0 d; b -> c; c -> d;"),
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
        codes::UNUSED_START,
        beside_a_mass!("a -> #[derivative] I n { inertia: 2.0, initial: 1.0 };"),
    ),
    (
        codes::OPEN_RING,
        "#[derivative] model M { causality componentwise; 1 ground[3]; 1 pin[3]; 1 end[3]; 1 block[3];
             Sf fixed[3] { flow: 0.0 } -> ground;
             crank: PlanarLink { mass: 1.0, inertia: 0.1, centre: 0.0, end: [1.0, 0.0], initial: 1.0 } (ground, pin);
             rod: PlanarLink { mass: 1.0, inertia: 0.1, centre: 0.0, end: [2.0, 0.0] } (pin, end);
             slide: PlanarPrismatic {} (ground, block); wrist: PlanarRevolute {} (block, end); }",
    ),
    (
        codes::MISSING_PORT,
        beside_a_mass!(
            "1 wire { I coil { inertia: 2.0 + gap.q } } 1 way { C gap { stiffness: 1.0 } I plunger { inertia: 1.0 } }"
        ),
    ),
    (
        codes::NO_BODY,
        beside_a_mass!("1 b[3] { I hull { inertia: diag(0.1, 0.1, 0.9), gyroscopic } }"),
    ),
    (
        codes::LOST_IMPULSE,
        "#[derivative] model M { 1 a { I m { inertia: 1.0 } } 1 b { I n { inertia: 2.0 } C c { stiffness: 1.0 } }
             Sf drive { flow: if t < 1.0 { 0.0 } else { 2.0 } } -> a; a -> TF lever { flow: 2.0 } -> b; }",
    ),
    (
        codes::UNKNOWN_MOTION,
        "#[derivative] model M { causality componentwise; 1 g[3]; 1 b[3]; 1 c[3]; Sf still[3] { flow: 0.0 } -> g;
             hinge: PlanarRevolute {} (g, b); arm: PlanarOffset { y: 0.1 * t } (b, c); bob: PlanarPointMass { mass: 1.0 } (c); }",
    ),
    (
        codes::GROUND_ABOVE,
        "model M { gravity [0.0, 0.0, 9.81]; 1 g[6]; 1 a[6]; Sf still[6] { flow: 0.0 } -> g; free: Free (g, a);
             body: Body { mass: 1.0, inertia: 1.0 } (a); foot: Contact { stiffness: 1e4 } (a); }",
    ),
    (
        codes::TURNING_AXES,
        "model M { 1 g[6] { Sf still { flow: 0.0 } } 1 a[6] { I m { inertia: diag(1.0, 1.0, 1.0, 2.0, 2.0, 2.0) } } free: Free (g, a); }",
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
        "output y[3] = angles_of(diag(1.0, 1.0, 2.0), 0, 1, 2);",
        &["MBG0221"],
    ),
    (
        "output y[3] = rotation(0.5) * [1.0, 0.0, 0.0];",
        &["MBG0204"],
    ),
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

/// Names of the types that a text becomes. Each is declared at that of its model, where Rust tells of another one.
fn types(text: &str) -> Vec<String> {
    let expansion = items(text.parse().unwrap(), &mut Diagnostics::new());
    let file: syn::File = syn::parse2(expansion.types).unwrap();
    let names = file.items.iter().filter_map(|item| match item {
        syn::Item::Struct(it) => {
            let places = [it.struct_token.span, it.ident.span()].map(|span| span.start());
            assert_eq!(places[0], places[1]);
            Some(it.ident.to_string())
        }
        _ => None,
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[test]
fn names_are_taken_once_and_leave_no_types_that_rust_refuses() {
    let model = |name: &str| format!("model {name} {{ 1 a {{ I m {{ inertia: 1.0 }} }} }}\n");
    let two = [model("M"), model("M")].concat();
    insta::assert_snapshot!(told(&two), @"2:7 model `M` is declared twice [MBG0202]");
    assert_eq!(types(&two), ["M", "MParameters"]);
    let beside = [model("M"), model("MParameters")].concat();
    insta::assert_snapshot!(told(&beside), @"2:7 model `MParameters` and the parameters of model `M` have one name [MBG0202]");
    assert_eq!(types(&beside), ["M", "MParameters"]);
    let behind = [model("MParameters"), model("M")].concat();
    insta::assert_snapshot!(told(&behind), @"2:7 the parameters of model `M` and model `MParameters` have one name [MBG0202]");
    assert_eq!(types(&behind), ["MParameters", "MParametersParameters"]);
    // A component is no type.
    let component = ["component M(port a) { }\n", &model("M")].concat();
    assert_eq!(told(&component), "");
    assert_eq!(types(&component), ["M", "MParameters"]);
    for taken in ["T", "f64", "usize", "bool"] {
        insta::allow_duplicates! {
            insta::assert_snapshot!(told(&model(taken)).replace(taken, "…"), @"
            1:7 a model cannot be called `…`: the code made of it calls another type so [MBG0202]
              help: give it another name
            ");
        }
    }
    // The type of the parameters has each name once.
    let twice = beside_a_mass("param mass = 1.0; param mass = 2.0;");
    assert_eq!(found(&twice), ["MBG0202"]);
    let expansion = items(twice.parse().unwrap(), &mut Diagnostics::new());
    let types = expansion.types.to_string();
    assert_eq!(types.matches("pub mass :").count(), 1);
}

#[test]
fn starts_at_the_pole_of_a_law_are_told() {
    let told = |law: &str| {
        told(&format!(
            "model M {{ 1 v {{ C c {{ {law} }} I m {{ inertia: 1.0 }} }} }}"
        ))
    };
    insta::assert_snapshot!(told("effort: 1.0 / q"), @"
    1:19 the law of `c` is not finite at the start [MBG0404]
      help: give `c.q` another start, such as `initial: 0.5`
    ");
    insta::assert_snapshot!(told("effort: powi(2.0 / (q - 1.0), 2), initial: 1.0"), @"
    1:19 the law of `c` is not finite at the start [MBG0404]
      help: give `c.q` another start, such as `initial: 1.5`
    ");
}

#[test]
fn mistakes_in_parameters_and_inputs_are_told() {
    let told = |body: &str| told(&beside_a_mass(body));
    insta::assert_snapshot!(told("param k: N/m;"), @"
    1:46 parameter `k` has no value [MBG0214]
      help: write `param k: N/m = 1.0;`
    ");
    insta::assert_snapshot!(told("param r[3]: m; output y: m = r.x;"), @"
    1:46 parameter `r` has no value [MBG0214]
      help: write `param r[3]: m = [1.0, 1.0, 1.0];`
    ");
    insta::assert_snapshot!(told("param r[3]: m = 1.0; output y: m = r.x;"), @"
    1:46 `r` has dimension 3, found a number [MBG0204]
      help: write each component, such as `[1.0, 1.0, 1.0]`
    ");
    insta::assert_snapshot!(told("param r[3]: m = [1.0, 2.0]; output y: m = r.x;"), @"1:46 `r` has dimension 3, found a vector of 2 [MBG0204]");
    insta::assert_snapshot!(told("param l = 1.0; param r[2]: m = [l, 2.0]; output y: m = r.x;"), @"
    1:71 expected numbers as the default of `r`, found `[l, 2.0]` [MBG0213]
      help: write `let r[2]: m = [l, 2.0];` for what follows from other values
    ");
    insta::assert_snapshot!(told("param k = [1.0, 2.0]; output y = k.x;"), @"
    1:50 expected a number as the default of `k`, found `[1.0, 2.0]` [MBG0213]
      help: write `param k[2] = [1.0, 2.0];`
    ");
    insta::assert_snapshot!(told("param k: N/m = 2.0 * l; param l = 1.0;"), @"
    1:55 expected a number as the default of `k`, found `2.0 * l` [MBG0213]
      help: write `let k: N/m = 2.0 * l;` for what follows from other values
    ");
    insta::assert_snapshot!(told("param k = a.f;"), @"
    1:50 expected a number as the default of `k`, found `a.f` [MBG0213]
      help: write `let k = a.f;` for what follows from other values
    ");
    insta::assert_snapshot!(told("param k = l;"), @"1:50 `l` is not declared [MBG0203]");
    insta::assert_snapshot!(told("input u: N = 2.0; output y: N = u;"), @"
    1:51 `u` is an input: its value comes from outside, and it has no default [MBG0101]
      help: write `input u: N;`
      help: write `param u: N = 2.0;` for a value that stays
    ");
    insta::assert_snapshot!(told("input u[2] = 2.0; output y = u.x;"), @"
    1:51 `u` is an input: its value comes from outside, and it has no default [MBG0101]
      help: write `input u[2];`
      help: write `let u[2] = [2.0, 2.0];` for a value that stays
    ");
    insta::assert_snapshot!(told("input u[2] = [2.0, 1.0]; output y = u.x;"), @"
    1:51 `u` is an input: its value comes from outside, and it has no default [MBG0101]
      help: write `input u[2];`
      help: write `let u[2] = [2.0, 1.0];` for a value that stays
    ");
    for mended in [
        "param k: N/m = 1.0;",
        "param r_x: m = 1.0; param r_y: m = 1.0; param r_z: m = 1.0; let r[3]: m = [r_x, r_y, r_z]; output y: m = r.x;",
        "let r[3]: m = [1.0, 2.0, 3.0]; output y: m = r.x;",
        "let k: N/m = 2.0 * l; param l: N/m = 1.0;",
        "input u: N; output y: N = u;",
        "param u: N = 2.0; output y: N = u;",
        "let u[2] = [2.0, 1.0]; output y = u.x;",
    ] {
        assert_eq!(told(mended), "", "{mended}");
    }
}

/// Through the library, whose calls have no place in the text.
#[test]
fn a_component_that_the_library_calls_from_inside_it_is_told_at_its_call() {
    let text =
        "component Bearing(port at) { rack: Rack { radius: 0.1, blocked: compliant } (at, at); }
model M { 1 a { I m { inertia: 1.0 } } seat: Bearing (a); }";
    insta::assert_snapshot!(told(text), @"
    1:30 component `Bearing` contains itself [MBG0215]
      this is inside `Rack`, a component of the library
    ");
}

#[test]
fn an_angular_velocity_has_three_components() {
    let told = |body: &str| {
        told(&beside_a_mass(&format!(
            "1 f[6] {{ I n {{ inertia: 1.0 }} }} {body}"
        )))
    };
    insta::assert_snapshot!(told("attitude q = quaternion(a.f);"), @"1:96 an angular velocity has three components, found a number [MBG0204]");
    insta::assert_snapshot!(told("attitude q = quaternion(f.f);"), @"
    1:96 an angular velocity has three components, found a vector of 6 [MBG0204]
      help: write `f.f[0..3]` for that of a frame
    ");
    insta::assert_snapshot!(told("attitude q = quaternion(f.f[0..3]), initial: [1.0, 0.0];"), @"1:117 a quaternion has four components, found a vector of 2 [MBG0204]");
    assert_eq!(told("attitude q = quaternion(f.f[0..3]);"), "");
}

/// `x` of a quaternion would be its first component, which is that of no axis.
#[test]
fn components_of_a_quaternion_have_no_letters() {
    let read = |value: &str| {
        told(&format!(
            "model M {{ 1 w[3] {{ I b {{ inertia: 1.0, gyroscopic }} }} attitude turn = quaternion(w.f);
1 four[4] {{ I n {{ inertia: 1.0 }} }} output y = {value}; }}"
        ))
    };
    insta::assert_snapshot!(read("turn.x"), @"
    2:52 `turn` is `[w, x, y, z]`, whose components have numbers and no letters [MBG0204]
      help: write `turn[1]` for its x
    ");
    insta::assert_snapshot!(read("2.0 * turn.w"), @"
    2:58 `turn` is `[w, x, y, z]`, whose components have numbers and no letters [MBG0204]
      help: write `turn[0]` for its w
    ");
    for value in ["turn[1]", "four.f.x", "n.p.z", "w.f.x"] {
        assert_eq!(read(value), "", "{value}");
    }
}

/// A body on a hinge, with the hinge's arguments and more statements.
fn hinged(arguments: &str, statements: &str) -> String {
    format!(
        "#[derivative] model M {{ 1 floor[6]; Sf still {{ flow: 0.0 }} -> floor; 1 frame[6];
hinge: Revolute {{ {arguments} }} (floor, frame);
{statements} }}"
    )
}

/// The component is not the user's, and what fails inside has a name of its own.
#[test]
fn a_mistake_inside_a_component_is_told_at_the_argument_behind_it() {
    let body = "body: Body { mass: 1.0, inertia: 1.0, gravity_at: hinge.gravity_b } (frame);";
    let hinge = |arguments: &str| told(&hinged(arguments, body));
    let body = |arguments: &str| {
        told(&hinged(
            "axis: 1",
            &format!("body: Body {{ {arguments} }} (frame);"),
        ))
    };
    insta::assert_snapshot!(hinge("axis: [0.0, 0.0, 1.0]"), @"
    2:25 `axis` does not fit in `Revolute`: expected a whole number that is known while the model is compiled, found `[0.0, 0.0, 1.0]` [MBG0217]
      `axis`: 0, 1 or 2 for x, y or z
      help: `[0.0, 0.0, 1.0]` is 2: write `axis: 2`
      help: it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers
      help: a `param` of a model is no such number, because it can change after the model is compiled
    ");
    insta::assert_snapshot!(hinge("axis: y"), @"
    2:25 `axis` does not fit in `Revolute`: expected a whole number that is known while the model is compiled, found `y` [MBG0217]
      `axis`: 0, 1 or 2 for x, y or z
      help: `y` is 1: write `axis: 1`
      help: it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers
      help: a `param` of a model is no such number, because it can change after the model is compiled
    ");
    insta::assert_snapshot!(hinge("axis: 3"), @"
    2:25 `axis` does not fit in `Revolute`: found `3` [MBG0204]
      `axis`: 0, 1 or 2 for x, y or z
      inside it, `moment` has 3 components, `moment[axis]` asks for more
    ");
    insta::assert_snapshot!(hinge("axis: 1, torque: [0.0, 1.0, 0.0]"), @"
    2:36 `torque` does not fit in `Revolute`: expected a number, found a vector of 3 [MBG0204]
      `torque`: Of the motor
    ");
    insta::assert_snapshot!(hinge("axis: 1, tilt: [0.0, 1.0, 0.0]"), @"
    2:34 `tilt` does not fit in `Revolute`: expected a 3×3 matrix, found a vector of 3 [MBG0204]
      `tilt`: Takes axes of the joint to axes of a, such as `rot_x(0.5)`
      help: for roll, pitch and yaw write `tilt: rot_y(1.0)`
    ");
    insta::assert_snapshot!(hinge("axis: 1, initial: hinge.angle"), @"
    2:37 `initial` does not fit in `Revolute`: expected numbers and parameters alone, from which a state starts [MBG0213]
      `initial`: Angle at the start
    ");
    insta::assert_snapshot!(body("mass: [1.0, 2.0], inertia: 1.0"), @"3:20 `mass` does not fit in `Body`: expected a number or a 3×3 matrix, found a vector of 2 [MBG0204]");
    insta::assert_snapshot!(body("mass: 1.0, inertia: [1.0, 2.0, 3.0]"), @"
    3:34 `inertia` does not fit in `Body`: expected a number or a 3×3 matrix, found a vector of 3 [MBG0204]
      `inertia`: About the centre of mass: a 3×3 matrix, or a number for a ball
      help: write `diag(…)` for a matrix with these on its diagonal
    ");
    insta::assert_snapshot!(body("mass: 1.0, inertia: -1.0"), @"
    3:34 `inertia` does not fit in `Body`: the inertia of `spin` is -1, not positive [MBG0216]
      `inertia`: About the centre of mass: a 3×3 matrix, or a number for a ball
    ");
    let planar = "gravity [0.0, -9.81]; weight: Body { mass: 1.0, inertia: 1.0 } (floor);";
    insta::assert_snapshot!(told(&hinged("axis: 1, gravity_a: [0.0, 0.0, 0.0]", planar)), @"
    3:9 `gravity` does not fit in `Body`: `gravity_at` has dimension 3, found a vector of 2 [MBG0204]
      help: write `gravity [0.0, 0.0, -9.81];` in the model
    ");
    assert_eq!(
        hinge("axis: 1, torque: 2.0, tilt: rot_x(0.5), initial: 0.1"),
        ""
    );
}

#[test]
fn paths_that_lead_nowhere_are_answered_with_what_can_be_read() {
    let read = |path: &str| {
        let hub = "1 hub[3] { I m { inertia: 1.0 } C spring { stiffness: 1.0 } C wire { stiffness: 2.0 } }";
        let body = "body: Body { mass: 1.0, inertia: 1.0 } (frame);";
        told(&hinged(
            "axis: 1",
            &format!("{hub} {body}\noutput y = {path};"),
        ))
    };
    insta::assert_snapshot!(read("hub.x.f"), @"
    4:18 `hub.x.f` is not declared [MBG0203]
      help: write `hub.f.x`
    ");
    insta::assert_snapshot!(read("hub[1].f"), @"
    4:19 `hub[1].f` is not declared [MBG0203]
      help: write `hub.f[1]`
    ");
    insta::assert_snapshot!(read("hub.spring.q.x"), @"
    4:25 `hub.spring.q.x` is not declared [MBG0203]
      help: write `spring.q.x`: an element at a junction has a name of its own
    ");
    insta::assert_snapshot!(read("hub.q"), @"
    4:16 `hub` has no `q`, it has `f` [MBG0203]
      help: its elements have one: `spring.q`, `wire.q`
    ");
    insta::assert_snapshot!(read("hub.p"), @"
    4:16 `hub` has no `p`, it has `f` [MBG0203]
      help: its element has one: `m.p`
    ");
    insta::assert_snapshot!(read("hinge.theta"), @"
    4:18 `hinge.theta` is not declared [MBG0203]
      help: write `hinge.angle`
    ");
    insta::assert_snapshot!(read("hinge.angel"), @"
    4:18 `hinge.angel` is not declared [MBG0203]
      help: did you mean `hinge.angle`?
    ");
    for mended in [
        "hub.f.x",
        "hub.f[1]",
        "spring.q.x",
        "m.p.x",
        "hinge.angle",
        "hinge.rate.f",
    ] {
        assert_eq!(read(mended), "", "{mended}");
    }
}

/// Where no element fixes what a source imposes, the message does not end in an empty list.
#[test]
fn a_hinge_that_carries_nothing_is_told_so() {
    let text = "#[derivative] model M { 1 ground[6] { Sf fixed { flow: 0.0 } } 1 arm[6]; 1 tip[6];
        hinge: Revolute { axis: 1 } (ground, arm);
        body: Body { mass: 1.0, inertia: 1.0 } (arm);
        flap: Revolute { axis: 1, offset: [0.3, 0.0, 0.0] } (arm, tip); }";
    let reported = diagnose(text);
    let texts: Vec<String> = reported.list().iter().map(|it| it.text()).collect();
    insta::assert_snapshot!(texts.join("\n"), @"
    nothing holds `tip`: its flow and that of `flap.rate` can change together without any effect [MBG0401]
      help: hold it, if it is at rest: `Sf wall[6] { flow: 0.0 } -> tip;`
      help: or give it an inertia, such as a body, if it moves by itself
    ");
    let with_body = text.replace(
        "(arm, tip);",
        "(arm, tip); blade: Body { mass: 1.0, inertia: 1.0 } (tip);",
    );
    assert!(!diagnose(&with_body).any(), "the help works");
}

#[test]
fn what_a_loop_makes_is_told_once() {
    let text = "model M { cells: for k in 0..20 { 0 x; 0 m { C c { compliance: 1.0 } } } }";
    let diagnostics = diagnose(text);
    let list = diagnostics.list();
    assert_eq!(list.len(), 1, "{list:#?}");
    let told = list[0].text();
    assert!(
        told.starts_with("junction `cells[0].x` has no bond")
            && told.contains("and 19 more, which differ in their numbers"),
        "{told}"
    );
}
