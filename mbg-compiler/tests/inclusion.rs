//! Files that a macro call includes: what they declare is known, and mistakes in them are told at their place.
#![allow(clippy::unwrap_used)]

use std::io;

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::explain::explain;
use mbg_compiler::inclusion::{Inclusion, no_file};
use mbg_compiler::syntax::library;
use mbg_compiler::{expand, expansion};
use proc_macro2::{Delimiter, Group, Literal, Span, TokenStream, TokenTree};
use proptest::prelude::*;
use quote::quote;

/// A damper of its own.
const BRAKE: &str = "/// A damper.\ncomponent Brake(port a) {\n    param strength;\n    a -> R shoe { resistance: strength };\n}\n";

/// A model that has the brake.
const CART: &str = "include \"brake.mbg\";
    model Cart { 1 rolling { I mass { inertia: 2.0 } } brake: Brake { strength: 3.0 } (rolling); }";

/// What is reported when `files` can be read.
fn reported(text: &str, files: &[(&str, &str)]) -> Vec<String> {
    let read = |path: &str| match files.iter().find(|(name, _)| *name == path) {
        Some((_, text)) => Ok((*text).to_owned()),
        None => Err(io::Error::from(io::ErrorKind::NotFound)),
    };
    let mut diagnostics = Diagnostics::new();
    let expansion = expansion(
        text.parse().unwrap(),
        &quote!(::mbg_runtime),
        &read,
        &mut diagnostics,
    );
    syn::parse2::<syn::File>(expansion).unwrap();
    for report in diagnostics.list() {
        assert!(
            report.span.start() != report.span.end(),
            "{}",
            report.text()
        );
    }
    diagnostics.list().iter().map(|it| it.text()).collect()
}

/// The cart with a brake of this text has one mistake.
fn reported_in_brake(brake: &str) -> String {
    let reports = reported(CART, &[("brake.mbg", brake)]);
    let [report] = &reports[..] else {
        panic!("one mistake in {brake}, found {reports:?}")
    };
    report.clone()
}

#[test]
fn an_included_component_is_as_one_that_is_written_out() {
    let read = |path: &str| {
        assert_eq!(path, "brake.mbg");
        Ok(BRAKE.to_owned())
    };
    let found = expand(CART.parse().unwrap(), &quote!(::mbg_runtime), &read).to_string();
    let written = CART.replace("include \"brake.mbg\";", BRAKE);
    let written = expand(written.parse().unwrap(), &quote!(::mbg_runtime), &no_file).to_string();
    let dependency = "const _ : & [:: core :: primitive :: u8] = :: core :: include_bytes ! (:: core :: concat ! (:: core :: env ! (\"CARGO_MANIFEST_DIR\") , \"/brake.mbg\")) ;";
    assert_eq!(found, format!("{written} {dependency}"));
}

/// The path is an argument of a `macro_rules!`.
#[test]
fn a_path_in_a_group_that_nobody_wrote_is_taken() {
    let path = TokenTree::from(Literal::string("brake.mbg"));
    let path = Group::new(Delimiter::None, TokenStream::from(path));
    let path = TokenStream::from(TokenTree::from(path));
    let read = |_: &str| Ok(BRAKE.to_owned());
    let mut diagnostics = Diagnostics::new();
    let inclusion = Inclusion::of(quote!(include #path;), &read, &mut diagnostics);
    assert!(!diagnostics.any());
    let written: TokenStream = BRAKE.parse().unwrap();
    assert_eq!(inclusion.tokens().to_string(), written.to_string());
}

#[test]
fn files_include_files_and_each_is_taken_once() {
    let files = [
        ("all.mbg", "include \"brake.mbg\"; include \"./pair.mbg\";"),
        (
            "pair.mbg",
            "include \"brake.mbg\"; component Pair(port a) { x: Brake { strength: 1.0 } (a); }",
        ),
        ("brake.mbg", BRAKE),
    ];
    let text = "include \"all.mbg\"; include \"brake.mbg\";
        model Cart { 1 rolling { I mass { inertia: 2.0 } } brakes: Pair (rolling); }";
    assert_eq!(reported(text, &files), [""; 0]);
}

#[test]
fn a_file_may_hold_the_model() {
    let model = CART.replace("include \"brake.mbg\";", BRAKE);
    assert_eq!(
        reported("include \"cart.mbg\";", &[("cart.mbg", &model)]),
        [""; 0]
    );
}

#[test]
fn mistakes_in_files_are_told_at_their_place() {
    let cases = [
        (
            BRAKE.replace("resistance: strength", "resistance: 2.0 * strenght"),
            "`strenght` is not declared [MBG0203]
  in brake.mbg:4:37
        a -> R shoe { resistance: 2.0 * strenght };
                                        ^^^^^^^^
  help: did you mean `strength`?",
        ),
        (
            BRAKE.replace("a ->", "a =>"),
            "expected `->` after `a`, found `=>` [MBG0101]
  in brake.mbg:4:7
        a => R shoe { resistance: strength };
          ^
  help: a bond is written `a -> b`",
        ),
        (
            BRAKE.replace("resistance: strength", "resistance: (strength + 1.0 / 0.0)"),
            "this divides by zero, whatever the state [MBG0216]
  in brake.mbg:4:47
        a -> R shoe { resistance: (strength + 1.0 / 0.0) };
                                                  ^",
        ),
    ];
    for (brake, expected) in cases {
        assert_eq!(reported_in_brake(&brake), expected);
    }
}

#[test]
fn warnings_in_files_are_told_at_their_place() {
    let brake = BRAKE.replace("a ->", "param grip = 1.0;\n    param wear = 2.0; a ->");
    let mut diagnostics = Diagnostics::new();
    let read = |_: &str| Ok(brake.clone());
    expansion(
        CART.parse().unwrap(),
        &quote!(::mbg_runtime),
        &read,
        &mut diagnostics,
    );
    assert!(!diagnostics.any(), "{:?}", diagnostics.list());
    let texts = diagnostics.warnings().iter().map(|it| it.text());
    insta::assert_snapshot!(texts.collect::<Vec<_>>().join("\n"), @"
    `Brake` does not read its parameter `grip` [MBG0223]
      in brake.mbg:4:11
            param grip = 1.0;
                  ^^^^
      help: remove it, or call it `_grip`
    `Brake` does not read its parameter `wear` [MBG0223]
      in brake.mbg:5:11
            param wear = 2.0; a -> R shoe { resistance: strength };
                  ^^^^
      help: remove it, or call it `_wear`
    ");
}

#[test]
fn the_stages_are_told_with_the_place_in_the_file() {
    let brake = BRAKE.replace("strength }", "strenght }");
    let read = |_: &str| Ok(brake.clone());
    let place = |span: Span| format!("cart.mbg:{}", span.start().line);
    let text = explain(CART.parse().unwrap(), &read, &place).unwrap_err();
    let (_, mistake) = text.split_once("==== error\n").unwrap();
    let lines: Vec<&str> = mistake.lines().take(2).collect();
    assert_eq!(
        lines,
        [
            "cart.mbg:1: `strenght` is not declared [MBG0203]",
            "  in brake.mbg:4:31"
        ]
    );
}

#[test]
fn a_mistake_in_a_long_file_is_found_with_few_marks() {
    let mut files = String::from("include \"brake.mbg\";\n");
    for number in 0..300 {
        files += &BRAKE.replace("Brake", &format!("Brake{number}"));
    }
    files += "model Cart { 1 rolling { I mass { inertia: 2.0 } } 1 rolling; Se push { effort: wind } -> rolling; }";
    let brake = BRAKE.replace("port a)", "port a, port)");
    let places = |brake: &str| -> Vec<String> {
        let files = [("carts.mbg", files.as_str()), ("brake.mbg", brake)];
        let found = reported("include \"carts.mbg\";", &files);
        let place = |report: &String| report.lines().nth(1).unwrap().trim().to_owned();
        found.iter().map(place).collect()
    };
    assert_eq!(places(&brake), ["in brake.mbg:2:25"]);
    assert_eq!(
        places(BRAKE),
        ["in carts.mbg:1502:54", "in carts.mbg:1502:81"]
    );
}

#[test]
fn files_that_cannot_be_included_are_refused() {
    type Case = (
        &'static str,
        &'static [(&'static str, &'static str)],
        &'static str,
    );
    let cases: [Case; 9] = [
        (
            "include \"nowhere.mbg\";",
            &[],
            "`nowhere.mbg` cannot be read: entity not found [MBG0105]",
        ),
        (
            "include \"/etc/brake.mbg\";",
            &[],
            "`/etc/brake.mbg` is no path from the root of the crate [MBG0105]",
        ),
        (
            "include \"a.mbg\";",
            &[
                ("a.mbg", "include \"b.mbg\";\n include \"c.mbg\";"),
                ("b.mbg", ""),
            ],
            "`c.mbg` cannot be read: entity not found [MBG0105]\n  in a.mbg:2:10\n     include \"c.mbg\";\n             ^^^^^^^",
        ),
        (
            "include \"a.mbg\";",
            &[
                ("a.mbg", "include \"b.mbg\";"),
                ("b.mbg", "include \"a.mbg\";"),
            ],
            "`a.mbg` includes itself [MBG0105]\n  in a.mbg:1:9\n    include \"b.mbg\";\n            ^^^^^^^\n  in b.mbg:1:9\n    include \"a.mbg\";\n            ^^^^^^^\n  each includes the next: `a.mbg`, `b.mbg`, `a.mbg`",
        ),
        (
            "include \"a.mbg\";",
            &[("a.mbg", "component A(port a) {\n  1 x[2;\n}")],
            "this bracket is closed by one of another kind [MBG0105]\n  in a.mbg:2:6\n      1 x[2;\n         ^",
        ),
        (
            "include \"a.mbg\";",
            &[("a.mbg", "component Größe(port ä) { param µ = 2.0µ; }")],
            "`2.0µ` is no number [MBG0105]\n  in a.mbg:1:37\n    component Größe(port ä) { param µ = 2.0µ; }\n                                        ^^^^",
        ),
        (
            "include \"a.mbg\";",
            &[("a.mbg", "component A(port a) { } 'a'")],
            "`'` means nothing in the language [MBG0105]\n  in a.mbg:1:25\n    component A(port a) { } 'a'\n                            ^",
        ),
        (
            "model M { } include \"a.mbg\";",
            &[],
            "a file is included before the first model and component [MBG0105]\n  help: write `include \"joints/mine.mbg\";` at the top, with the path from the root of the crate",
        ),
        (
            "include \"a/..\";",
            &[],
            "expected the path of a file between the quotes [MBG0105]",
        ),
    ];
    for (text, files, expected) in cases {
        assert_eq!(reported(text, files), [expected], "{text} {files:?}");
    }
}

#[test]
fn a_statement_that_is_written_otherwise_is_told_as_it_is_written() {
    let path = "expected the path of a file between quotes after `include`, found";
    let cases = [
        (
            "include \"m/x.mbg\"",
            "expected `;` after `\"m/x.mbg\"`, found `model`".to_owned(),
        ),
        ("include!(\"m/x.mbg\");", format!("{path} `!`")),
        ("include b\"m/x.mbg\";", format!("{path} `b\"m/x.mbg\"`")),
        ("include m/x.mbg;", format!("{path} `m`")),
        (
            "pub include \"m/x.mbg\";",
            "expected `include` alone, found `pub` before it".to_owned(),
        ),
        (
            "/// Parts.\n include \"m/x.mbg\";",
            "expected `include` alone, found an attribute or a documentation comment before it"
                .to_owned(),
        ),
    ];
    for (statement, message) in cases {
        let expected = format!("{message} [MBG0105]\n  help: write `include \"m/x.mbg\";`");
        assert_eq!(
            reported(&format!("{statement} model M {{ }}"), &[]),
            [expected]
        );
    }
    assert_eq!(
        reported("include concat!(\"m/\", \"x.mbg\");", &[]),
        [format!(
            "{path} `concat` [MBG0105]\n  help: write `include \"joints/mine.mbg\";`"
        )]
    );
}

#[test]
fn a_file_counts_once_however_its_path_is_written() {
    let paths = [
        "m/x.mbg",
        "./m/x.mbg",
        "m//x.mbg",
        "m/../m/x.mbg",
        "m/./x.mbg",
    ];
    let text: String = paths.map(|path| format!("include {path:?}; ")).concat();
    assert_eq!(reported(&text, &[("m/x.mbg", BRAKE)]), [""; 0]);
    assert_eq!(
        reported("include \"../../x.mbg\";", &[("../../x.mbg", BRAKE)]),
        [""; 0]
    );
}

#[test]
fn brackets_nest_only_so_deep() {
    let deep = format!("component A(port a) {}", "{ ".repeat(100_000));
    let found = reported_in_brake(&deep);
    assert!(
        found.starts_with("brackets nest deeper than 256 [MBG0105]\n  in brake.mbg:1:533\n"),
        "{found:.200}"
    );
}

#[test]
fn a_name_declared_twice_is_told_in_the_later_file() {
    let brake = format!("{BRAKE}{BRAKE}");
    assert_eq!(
        reported_in_brake(&brake),
        "component `Brake` is declared twice [MBG0202]\n  in brake.mbg:7:11\n    component Brake(port a) {\n              ^^^^^"
    );
}

#[test]
fn a_file_that_is_missing_is_the_only_mistake() {
    assert_eq!(
        reported(CART, &[]),
        ["`brake.mbg` cannot be read: entity not found [MBG0105]"]
    );
}

#[test]
fn included_text_is_cut_as_the_compiler_cuts_it() {
    let own = "/* a /* b */ c */ component C(port a[3]) { //! said\n let x = 1..2 + 1. + 1.e + a.x - 2e-3 * 1_000 -> ..= ; r#type + r#c } //// d";
    for text in library::names().filter_map(library::text).chain([own]) {
        let read = |_: &str| Ok(text.to_owned());
        let found = Inclusion::of(
            "include \"x\";".parse().unwrap(),
            &read,
            &mut Diagnostics::new(),
        );
        let expected = text.replace("//!", "//");
        let expected: proc_macro2::TokenStream = expected.parse().unwrap();
        assert_eq!(found.tokens().to_string(), expected.to_string());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_changed_file_never_panics_and_its_errors_have_places(
        at in any::<prop::sample::Index>(),
        length in 0..4_usize,
        by in "(\\PC{0,3}|[-(){}\\[\\]/*\"'0-9.eE_]{1,3}|\n|//|/\\*|///|include \"x\";)",
    ) {
        let start = at.index(BRAKE.len());
        let end = (start + length).min(BRAKE.len());
        let brake = format!("{}{by}{}", &BRAKE[..start], &BRAKE[end..]);
        for report in reported(CART, &[("brake.mbg", &brake)]) {
            let known = report.contains("\n  in brake.mbg:") || report.contains("`Brake`");
            prop_assert!(known, "{brake}\n{report}");
        }
    }
}
