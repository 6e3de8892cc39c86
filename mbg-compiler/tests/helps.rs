//! Helps of messages are followed to the letter, and lead to models that compile.
#![allow(clippy::unwrap_used)]

use mbg_compiler::codes;
use mbg_compiler::diagnostics::{Code, Diagnostics};
use mbg_compiler::items;

fn diagnose(text: &str) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    let _ = items(text.parse().unwrap(), &mut diagnostics);
    diagnostics
}

/// The helps of the only code of a model, without the `or` between them.
fn helps(text: &str, code: Code) -> Vec<String> {
    let diagnostics = diagnose(text);
    let list = diagnostics.list();
    assert!(!list.is_empty(), "{text}");
    assert!(list.iter().all(|it| it.code == code), "{}", list[0].text());
    let helps = list[0].helps.iter();
    helps
        .map(|help| help.trim_start_matches("or ").to_owned())
        .collect()
}

/// A model with what a help says to type: statements at its end, and words before the element that they name.
fn followed(text: &str, help: &str) -> String {
    let mut followed = text.trim_end().trim_end_matches('}').to_owned();
    for typed in help.split('`').skip(1).step_by(2) {
        if typed.ends_with(';') {
            followed += &typed.replace('…', "1.0");
        } else if let Some(element) = typed.strip_prefix("#[derivative] ") {
            let element = element.trim_end_matches("{ … }");
            followed = followed.replacen(element, &format!("#[derivative] {element}"), 1);
        }
    }
    followed + " }"
}

fn compiles(text: &str) {
    let diagnostics = diagnose(text);
    let told: Vec<String> = diagnostics.list().iter().map(|it| it.text()).collect();
    assert!(told.is_empty(), "{text}\n{}", told.join("\n"));
}

#[test]
fn what_floats_is_held_at_one_junction() {
    let circuit = "0 plus; 0 minus; r: Resistor { resistance: 2.0 } (plus, minus);
                   c: Capacitor { capacitance: 1.0 } (plus, minus);";
    let cases = [
        (circuit, "`plus`, `minus`: their efforts", "`Se earth { effort: 0.0 } -> minus;`"),
        (
            "0 a; 0 b; l: Inductor { inductance: 2.0 } (a, b); c: Capacitor { capacitance: 1.0 } (a, b);",
            "`a`, `b`: their efforts",
            "`Se earth { effort: 0.0 } -> b;`",
        ),
        (
            "causality componentwise; 0 a[2]; 0 b[2]; 1 c[2] { R r { resistance: 1.0 } } a -> c; c -> b;
             1 d[2] { C s { stiffness: 1.0 } } a -> d; d -> b; 0 earth { C k { stiffness: 1.0 } R l { resistance: 1.0 } }",
            "`a`, `b`: their efforts",
            "`Se earth2[2] { effort: 0.0 } -> b;`",
        ),
        (
            "1 x; 1 y; 0 p { C q { stiffness: 1.0 } } 0 r { R d { resistance: 1.0 } } x -> p; p -> y; x -> r; r -> y;",
            "`x`, `y`: their flows",
            "`Sf wall { flow: 0.0 } -> y;`",
        ),
    ];
    for (body, floating, typed) in cases {
        let text = format!("model M {{ {body} }}");
        let report = diagnose(&text).list()[0].message.clone();
        assert!(
            report.starts_with(&format!("nothing holds {floating}")),
            "{report}"
        );
        let helps = helps(&text, codes::SINGULAR_JUNCTIONS);
        assert_eq!(helps[0], format!("hold one of them: {typed}"));
        compiles(&followed(&text, &helps[0]));
    }
}

#[test]
fn a_ring_of_junctions_is_opened() {
    let ring = "model M { 1 a { I m { inertia: 1.0 } } 1 b; 0 c; b -> c; c -> b; }";
    let helps = helps(ring, codes::SINGULAR_JUNCTIONS);
    let help = "take one bond of the mesh away: what it says follows from the others";
    assert_eq!(helps, [help]);
}

#[test]
fn of_storages_that_depend_on_each_other_a_linear_one_is_eliminated() {
    let text = |law: &str| {
        let first = "C first { effort: q + powi(q, 3) }";
        format!(
            "model M {{ 0 node {{ {first} #[derivative] C last {{ {law} }} R r {{ resistance: 1.0 }} }} }}"
        )
    };
    compiles(&text("stiffness: 2.0"));
    let nonlinear = text("effort: 2.0 * q + powi(q, 3)");
    let helps = helps(&nonlinear, codes::ORDER_LOST_UNSUPPORTED);
    assert_eq!(helps[1], "put a resistor between them");
    let (node, last) = ("0 node {", "#[derivative] C last");
    let between =
        "0 other { C last { effort: 2.0 * q + powi(q, 3) } } 1 path { R s { resistance: 1.0 } }
                   node -> path; path -> other; 0 node {";
    let apart = nonlinear.replace(&format!("{last} {{ effort: 2.0 * q + powi(q, 3) }}"), "");
    compiles(&apart.replace(node, between));
}

/// A body that spins about the one axis that a source leaves, the source, and where it acts.
const HELD: [(&str, &str, &str); 2] = [
    (
        "1 body[3] { I rotor { inertia: diag(1.0, 2.0, 3.0), gyroscopic } }",
        "Sf held[2] { flow: 0.0 }",
        "body[0..2]",
    ),
    (
        "1 body[3] { EJS wheel { momentum: [0.0, 0.0, 1.0] } I rotor { inertia: 1.0 } }
         1 shaft[2]; shaft -> body[0..2];",
        "Sf held[2] { flow: 0.0 }",
        "shaft",
    ),
];

#[test]
fn a_body_held_about_two_axes_keeps_the_third() {
    for (body, source, place) in HELD {
        let text = format!("model M {{ {body} {source} -> {place}; }}");
        let helps = helps(&text, codes::NO_ASSIGNMENT);
        assert_eq!(helps.len(), 2, "{helps:?}");
        compiles(&followed(&text, &helps[0]));
        let driven = text.replace(&format!("-> {place}"), "-> driven");
        assert!(helps[1].starts_with(
            "remove `held`, or let it act through a spring: bond it to `1 driven[2];`"
        ));
        compiles(&followed(&driven, &helps[1]));
    }
}

#[test]
fn a_flow_that_nothing_gives_is_given() {
    let text = "model M { 1 a { I m { inertia: 1.0 } } 1 b { Se s { effort: 1.0 } } }";
    for help in helps(text, codes::NO_ASSIGNMENT) {
        compiles(&followed(text, &help));
    }
}

#[test]
fn what_a_loop_makes_is_marked_where_it_is_written() {
    let element = "model M { Se air { effort: 1.0 } -> cells[0].node;
                   cells: for k in 0..1 { 0 node { C heat { compliance: 1.0 } } } }";
    let help = helps(element, codes::STORAGE_DERIVATIVE).remove(0);
    assert!(
        help.contains("before `C heat` to accept it: `#[derivative] C heat { … }`"),
        "{help}"
    );
    compiles(&followed(element, &help));

    let component =
        "component Cell(port p) { 0 node { C heat { compliance: 1.0 } } p -> node; }
                     model M { 0 air { Se s { effort: 1.0 } } cells: for k in 0..1 { cell: Cell (air); } }";
    let help = helps(component, codes::STORAGE_DERIVATIVE).remove(0);
    assert!(
        help.contains("before `cell: …`, which makes `cells[0].cell`"),
        "{help}"
    );
    compiles(&component.replace("cell: Cell", "#[derivative] cell: Cell"));
}
