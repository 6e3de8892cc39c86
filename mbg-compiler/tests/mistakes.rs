//! Mistakes in models: each is answered with its code, and the macro never panics.
#![allow(clippy::unwrap_used)]

use mbg_compiler::compile::compile;
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::syntax::ast::Item;
use mbg_compiler::{elaborate, expand, syntax};

/// Codes reported for the text between the braces.
fn codes(text: &str) -> Vec<&'static str> {
    let mut diagnostics = Diagnostics::new();
    let source = syntax::parse(text.parse().unwrap(), &mut diagnostics);
    let components = elaborate::component_table(&source);
    for item in &source.items {
        if let Item::Model(model) = item
            && !diagnostics.any()
        {
            let _ = compile(model, &components, &mut diagnostics);
        }
    }
    diagnostics
        .list()
        .iter()
        .map(|diagnostic| diagnostic.code.text)
        .collect()
}

fn model(body: &str) -> String {
    format!("model M {{ {body} }}")
}

#[test]
fn each_mistake_has_its_code() {
    let mass = "1 a { I m { inertia: 1.0 } }";
    let cases = [
        ("MBG0203", format!("{mass} a -> b;")),
        (
            "MBG0204",
            format!("{mass} 1 w[2] {{ I n {{ inertia: 1.0 }} }} a -> w;"),
        ),
        ("MBG0205", "1 a { I m { } }".to_owned()),
        (
            "MBG0208",
            format!("{mass} a -> TF t {{ flow: 2.0 }};")
                .replace("a -> TF t { flow: 2.0 };", "TF t { flow: 2.0 } -> a;"),
        ),
        (
            "MBG0206",
            "1 a { R r { resistance: 1.0, conductance: 1.0 } I m { inertia: 1.0 } }".to_owned(),
        ),
        (
            "MBG0213",
            "1 a { R r { resistance: \"x\" } I m { inertia: 1.0 } }".to_owned(),
        ),
        (
            "MBG0211",
            "1 a { R r { resistance: 1e999 } I m { inertia: 1.0 } }".to_owned(),
        ),
        (
            "MBG0212",
            "1 a { R r { effort: f ^ 2 } I m { inertia: 1.0 } }".to_owned(),
        ),
        ("MBG0202", format!("{mass} 1 a {{ }}")),
        ("MBG0201", String::new()),
        ("MBG0216", "1 a { I m { inertia: -1.0 } }".to_owned()),
        (
            "MBG0306",
            "causality componentwise; 1 a { I m { inertia: 1.0 } I n { inertia: 2.0 } }".to_owned(),
        ),
        (
            "MBG0301",
            "1 a { I m { inertia: 1.0 } I n { inertia: 2.0 } }".to_owned(),
        ),
        (
            "MBG0403",
            "1 a { I m { inertia: 1.0 } #[derivative] I n { inertia: 2.0 } }".to_owned(),
        ),
        (
            "MBG0402",
            "1 a { Se s { effort: 1.0 } R r { effort: powi(f, 3) } R l { resistance: 1.0 } } integral x = a.f; output y = x;".to_owned(),
        ),
    ];
    for (code, body) in cases {
        let found = codes(&model(&body));
        assert!(
            found.contains(&code),
            "{code} expected for `{body}`, found {found:?}"
        );
    }
    assert_eq!(
        codes("component C() { c: C (); } model M { c: C (); }"),
        ["MBG0215"]
    );
}

#[test]
fn a_model_over_the_limit_is_answered_with_limit_and_count() {
    let mut body = String::from("1 a { I m { inertia: 1.0 } } 0 b;");
    for _ in 0..5000 {
        body.push_str("a -> b;");
    }
    let mut diagnostics = Diagnostics::new();
    let source = syntax::parse(model(&body).parse().unwrap(), &mut diagnostics);
    let Item::Model(model) = &source.items[0] else {
        panic!("a model was written")
    };
    assert!(
        compile(
            model,
            &elaborate::component_table(&source),
            &mut diagnostics
        )
        .is_none()
    );
    assert!(
        diagnostics.list()[0]
            .message
            .contains("5001 vector bonds, the limit is 4096")
    );
}

#[test]
fn expansion_is_the_same_every_time() {
    let text = model("1 a { I m { inertia: 2.0 } C c { stiffness: 3.0 } R r { resistance: 0.1 } }");
    let once = expand(text.parse().unwrap()).to_string();
    assert_eq!(once, expand(text.parse().unwrap()).to_string());
    assert!(syn::parse_str::<syn::File>(&once).is_ok());
}
