//! Stage 1, syntax, from the outside: trees, errors with their places, recovery, and any tokens at all.

mod tokens;

use std::fmt::Write;

use mbg_compiler::diagnostics::{Diagnostic, Diagnostics};
use mbg_compiler::syntax::ast::{Item, Source, Statement};
use mbg_compiler::syntax::{dump, parse};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use proptest::prelude::*;

use tokens::{SOUP, flat, matched};

const OSCILLATOR: &str = include_str!("syntax/oscillator.mbg");
const INS: &str = include_str!("syntax/ins.mbg");
const REVOLUTE: &str = include_str!("syntax/revolute.mbg");
const EVERYTHING: &str = include_str!("syntax/everything.mbg");
const MISTAKES: &str = include_str!("syntax/mistakes.mbg");

/// Parses text that has matching brackets.
fn read(text: &str) -> (Source, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let source = parse(
        text.parse().expect("the text consists of tokens"),
        &mut diagnostics,
    );
    (source, diagnostics)
}

/// An error under the line that it is about.
fn rendered(text: &str, diagnostic: &Diagnostic) -> String {
    let start = diagnostic.span.start();
    let line = text.lines().nth(start.line - 1).unwrap_or_default();
    let caret = " ".repeat(start.column) + "^";
    format!(
        "{line}\n{caret} {}:{}: {}\n",
        start.line,
        start.column + 1,
        diagnostic.text()
    )
}

/// Errors as `line:column: first line of the text`.
fn errors(text: &str) -> Vec<String> {
    read(text)
        .1
        .list()
        .iter()
        .map(|diagnostic| {
            let start = diagnostic.span.start();
            format!(
                "{}:{}: {}",
                start.line,
                start.column + 1,
                diagnostic.message
            )
        })
        .collect()
}

/// The tree of a text without mistakes.
fn tree(text: &str) -> String {
    let (source, diagnostics) = read(text);
    let errors: String = diagnostics
        .list()
        .iter()
        .map(|diagnostic| rendered(text, diagnostic))
        .collect();
    assert!(errors.is_empty(), "{errors}");
    dump(&source)
}

#[test]
fn the_oscillator_is_read() {
    insta::assert_snapshot!("syntax_oscillator", tree(OSCILLATOR));
}

#[test]
fn the_inertial_platform_is_read() {
    insta::assert_snapshot!("syntax_ins", tree(INS));
}

#[test]
fn the_revolute_joint_is_read() {
    insta::assert_snapshot!("syntax_revolute", tree(REVOLUTE));
}

#[test]
fn every_form_is_read() {
    insta::assert_snapshot!("syntax_everything", tree(EVERYTHING));
}

#[test]
fn mistakes_are_told_where_they_are() {
    let mut told = String::new();
    for section in MISTAKES.split("==== ").skip(1) {
        let (title, text) = section.split_once('\n').expect("a title and a text");
        let (source, diagnostics) = read(text);
        writeln!(told, "==== {title}").unwrap();
        for diagnostic in diagnostics.list() {
            told += &rendered(text, diagnostic);
        }
        writeln!(told, "\n{}", dump(&source)).unwrap();
    }
    insta::assert_snapshot!("syntax_mistakes", told);
}

#[test]
fn errors_keep_the_house_style() {
    for section in MISTAKES.split("==== ").skip(1) {
        let (title, text) = section.split_once('\n').expect("a title and a text");
        let (_, diagnostics) = read(text);
        assert!(diagnostics.any(), "no error for {title}");
        for diagnostic in diagnostics.list() {
            let message = &diagnostic.message;
            assert!(
                !message.ends_with('.') && !message.contains('\n'),
                "{message}"
            );
            assert!(
                message.starts_with(|first: char| first.is_lowercase() || first == '`'),
                "{message}"
            );
        }
    }
}

#[test]
fn four_broken_statements_of_seven_give_four_errors() {
    let text = "model M {
        param a = 1.0;
        parm b = 2.0;
        1 body[0] { I mass { inertia: a } }
        0 joint;
        body => joint;
        output y = mass.p / ;
        input push: N;
    }";
    assert_eq!(
        errors(text),
        [
            "3:9: expected a statement, found `parm`",
            "4:16: expected a dimension, which is an integer from 1 up, found `0`",
            "6:14: expected `->` after `body`, found `=>`",
            "7:27: expected an expression after `/`, found `;`",
        ]
    );
    insta::assert_snapshot!(dump(&read(text).0), @"
    model M
      param a = 1.0
      broken b
      broken body
      broken mass
      0 joint[1]
      broken
      broken y
      input push[1]: N <N^1>
    ");
}

#[test]
fn broken_elements_leave_their_junction_and_their_neighbours() {
    let text = "model M { 1 body {
        I mass { inertia 2.0 }
        C spring { stiffness: }
        R damper { resistance: 1.0 }
    } 0 joint; }";
    assert_eq!(
        errors(text),
        [
            "2:26: expected `:`, `,` or `}` after `inertia`, found `2.0`",
            "3:29: expected the value of `stiffness`, found the end of the braces",
        ]
    );
    insta::assert_snapshot!(dump(&read(text).0), @"
    model M
      1 body[1]
        R damper { resistance: 1.0 }
      broken mass
      broken spring
      0 joint[1]
    ");
}

#[test]
fn no_model_is_called_as_a_scalar_of_the_code() {
    insta::assert_snapshot!(errors("model T { 1 v { I b { inertia: 1.0 } } }").join(""), @"1:7: a model cannot be called `T`: the code made of it calls another type so");
    // The code around finds what stands in for it all the same.
    for (name, aliases) in [("T", 2), ("E", 2), ("f64", 0)] {
        let text = format!("model {name} {{ 1 v {{ I b {{ inertia: 1.0 }} }} }}");
        let types = mbg_compiler::items(text.parse().unwrap(), &mut Diagnostics::new()).types;
        let declared = [name.to_owned(), format!("{name}Parameters")];
        let declared = declared.map(|name| types.to_string().contains(&format!("type {name} <")));
        assert_eq!(declared.iter().filter(|it| **it).count(), aliases);
    }
}

#[test]
fn an_item_cut_off_is_told_at_its_last_token() {
    assert_eq!(
        errors("pub model Cut"),
        ["1:11: expected `{` after `model Cut`, found the end of the macro call"]
    );
    assert_eq!(
        errors("pub model"),
        ["1:5: expected the name of the model after `model`, found the end of the macro call"]
    );
    assert_eq!(
        errors("component Cut(port a)"),
        ["1:21: expected `{` after the ports, found the end of the macro call"]
    );
}

#[test]
fn the_name_of_every_model_survives_its_body() {
    let (source, diagnostics) = read("model A { ) -> }".replace(')', "%").as_str());
    assert!(diagnostics.any());
    let [Item::Model(model)] = &source.items[..] else {
        panic!("one model")
    };
    assert_eq!(model.name, "A");
    assert!(matches!(model.statements[..], [Statement::Broken(None)]));
}

#[test]
fn nothing_is_no_mistake() {
    assert_eq!(tree(""), "");
    assert_eq!(tree("model Empty { }"), "model Empty\n");
}

/// Puts every literal and name into an invisible group, as `macro_rules!` does with its fragments.
fn grouped(tokens: TokenStream) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Group(group) => {
                Group::new(group.delimiter(), grouped(group.stream())).into()
            }
            TokenTree::Literal(_) | TokenTree::Ident(_) => {
                TokenTree::from(Group::new(Delimiter::None, TokenStream::from(token)))
            }
            punct @ TokenTree::Punct(_) => punct,
        })
        .collect()
}

#[test]
fn fragments_of_other_macros_are_read() {
    let mut diagnostics = Diagnostics::new();
    let source = parse(grouped(INS.parse().expect("tokens")), &mut diagnostics);
    assert!(!diagnostics.any(), "{:?}", diagnostics.list());
    assert_eq!(dump(&source), tree(INS));
}

/// A visibility, documentation and a unit that are handed on are several tokens in one group.
#[test]
fn fragments_of_several_tokens_are_read() {
    let group = |text: &str| {
        let inside: TokenStream = text.parse().expect("tokens");
        TokenTree::from(Group::new(Delimiter::None, inside))
    };
    let (documentation, public) = (group("doc = \"M.\""), group("pub(crate)"));
    let (quotient, product) = (group("N/m"), group("N*m"));
    let tokens = quote::quote! {
        #[#documentation] #public model M {
            param a: #quotient = 1.0;
            param b: 1/#product = 1.0;
            #[#documentation] param c: #product^2 = 1.0;
        }
        #public model N { }
    };
    let mut diagnostics = Diagnostics::new();
    let source = parse(tokens, &mut diagnostics);
    assert!(!diagnostics.any(), "{:?}", diagnostics.list());
    let written = "/**M.*/ pub(crate) model M {
            param a: N/m = 1.0; param b: 1/(N*m) = 1.0; /**M.*/ param c: (N*m)^2 = 1.0;
        }
        pub(crate) model N { }";
    assert_eq!(dump(&source), tree(written));
}

#[test]
fn a_model_of_five_thousand_bonds_is_read() {
    let mut text = String::from("model Large {\n");
    for k in 0..5_000 {
        writeln!(
            text,
            "1 rate{k}[3] {{ I mass{k} {{ inertia: diag(1.0, 2.0, {k}.0), gyroscopic }} }}"
        )
        .unwrap();
        writeln!(
            text,
            "rate{k} -> MTF turn{k} {{ flow: rot_x(mass{k}.p) }} -> rate{};",
            k + 1
        )
        .unwrap();
    }
    text.push_str("1 rate5000[3];\n}");
    let (source, diagnostics) = read(&text);
    assert!(!diagnostics.any());
    let [Item::Model(model)] = &source.items[..] else {
        panic!("one model")
    };
    assert_eq!(model.statements.len(), 10_001);
}

#[test]
fn a_model_of_five_thousand_mistakes_is_read() {
    let (_, diagnostics) = read(&format!(
        "model Large {{ {} }}",
        "parm x = 1; 1 a { Rr b { } } ".repeat(5_000)
    ));
    assert_eq!(diagnostics.list().len(), 10_000);
    // No statement ends anywhere: nothing may look ahead to the end again and again.
    let (_, diagnostics) = read(&format!(
        "model Large {{ {} }}",
        "param x: N = 1 ".repeat(5_000)
    ));
    assert_eq!(diagnostics.list().len(), 5_000);
}

/// Laws that recurse in the reader of expressions, each in its own way.
fn deep(levels: usize) -> Vec<String> {
    vec![
        format!("{}1.0{}", "(".repeat(levels), ")".repeat(levels)),
        format!("{}1.0{}", "f([".repeat(levels), "])".repeat(levels)),
        format!("{}1.0", "-".repeat(levels)),
        format!("{}1.0", "a = ".repeat(levels)),
        format!("{}1.0", "1.0 + ".repeat(levels)),
        format!("{}x", "return ".repeat(levels)),
        format!("a{}", "[0]".repeat(levels)),
        format!("a{}", ".x".repeat(levels)),
        format!(
            "{} 1.0 {}",
            "if a {".repeat(levels),
            "} else { 2.0 }".repeat(levels)
        ),
        format!(
            "if a {{ 1.0 }} {} else {{ 3.0 }}",
            "else if b { 2.0 }".repeat(levels)
        ),
        format!("{}x", "|a| ".repeat(levels)),
        format!("a as {}f64", "&".repeat(levels)),
    ]
}

#[test]
fn deep_laws_do_not_exhaust_the_stack() {
    // Test threads have two megabytes, a quarter of what the compiler has.
    for levels in [10, 60, 300, 600, 1_000, 2_000, 5_000, 20_000] {
        for law in deep(levels) {
            let text = format!("model M {{ param x = {law}; 0 joint; }}");
            let (source, diagnostics) = read(&text);
            let told = diagnostics
                .list()
                .iter()
                .all(|diagnostic| diagnostic.message.contains("nests or runs on"));
            assert!(told || levels < 5_000, "{:?}", &law[..20]);
            assert!(
                levels > 10 || !diagnostics.any(),
                "{law}: {:?}",
                diagnostics.list()
            );
            assert!(dump(&source).contains("0 joint[1]"));
        }
    }
    let (_, diagnostics) = read(&format!(
        "model M {{ param x: {}m{} = 1; }}",
        "(".repeat(10_000),
        ")".repeat(10_000)
    ));
    assert_eq!(diagnostics.list().len(), 1);
    read(&format!("{}x{}", "{".repeat(10_000), "}".repeat(10_000)));
}

/// Random tokens in random brackets.
fn soup() -> impl Strategy<Value = String> {
    let word = prop::sample::select(SOUP).prop_map(str::to_owned);
    word.prop_recursive(5, 200, 12, |inner| {
        let brackets = prop::sample::select(&[("{", "}"), ("(", ")"), ("[", "]"), ("", "")][..]);
        (prop::collection::vec(inner, 0..12), brackets)
            .prop_map(|(words, (open, close))| format!("{open} {} {close}", words.join(" ")))
    })
}

/// Parses if the text consists of tokens, and prints the tree: neither may panic.
fn survives(text: &str) -> Option<(Source, Diagnostics)> {
    let tokens: TokenStream = text.parse().ok()?;
    let mut diagnostics = Diagnostics::new();
    let source = parse(tokens, &mut diagnostics);
    let _ = (dump(&source), diagnostics.to_tokens());
    Some((source, diagnostics))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_tokens_are_survived(words in prop::collection::vec(soup(), 0..20)) {
        let inner = words.join(" ");
        survives(&inner);
        survives(&format!("model M {{ {inner} }}"));
        survives(&format!("model M {{ 1 a {{ {inner} }} }}"));
        survives(&format!("model M {{ a -> R x {{ {inner} }}; output y: {inner} }}"));
        survives(&format!("component C({inner}) {{ x: C {{ {inner} }} ({inner}); }}"));
    }

    #[test]
    fn any_truncation_is_survived(cut in 0..EVERYTHING.len() + INS.len()) {
        let whole = format!("{EVERYTHING}{INS}");
        let mut words = Vec::new();
        flat(whole.parse().expect("tokens"), &mut words);
        let cut = cut * words.len() / (EVERYTHING.len() + INS.len());
        survives(&matched(words[..cut].iter().map(String::as_str)));
        survives(&matched(words[cut..].iter().map(String::as_str)));
    }

    #[test]
    fn any_mutation_is_survived_and_told_at_a_token(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..3_usize, prop::sample::select(SOUP)), 1..8),
    ) {
        let mut words = Vec::new();
        flat(EVERYTHING.parse().expect("tokens"), &mut words);
        for (index, change, word) in changes {
            let at = index.index(words.len());
            match change {
                0 => words[at] = word.to_owned(),
                1 => words.insert(at, word.to_owned()),
                _ => drop(words.remove(at)),
            }
        }
        let text = matched(words.iter().map(String::as_str));
        if let Some((source, diagnostics)) = survives(&text) {
            // The whole macro call has no place of its own: it ends where it starts.
            for diagnostic in diagnostics.list() {
                let (start, end) = (diagnostic.span.start(), diagnostic.span.end());
                prop_assert!(start != end, "{} has no place in {text}", diagnostic.text());
            }
            let broken = |statements: &[Statement]| statements.iter().any(|it| matches!(it, Statement::Broken(_)));
            let any = source.items.iter().any(|item| match item {
                Item::Model(model) => broken(&model.statements),
                Item::Component(component) => broken(&component.statements),
            });
            prop_assert!(!any || diagnostics.any(), "broken without an error: {text}");
        }
    }
}
