//! The same tokens give the same bytes: in one process, and in every process, whatever seeds its hash maps have.

use std::path::Path;
use std::process::Command;

use mbg_compiler::inclusion::no_file;
use mbg_compiler::{expand, explain::explain};
use quote::quote;

/// Names the file that a process started by the test writes.
const TARGET: &str = "MBG_WRITE_EXPANSIONS_TO";

/// Sound models, and one whose errors tell long chains.
const TEXTS: [&str; 5] = [
    include_str!("syntax/oscillator.mbg"),
    include_str!("syntax/ins.mbg"),
    include_str!("stages/rotor.mbg"),
    include_str!("stages/slide.mbg"),
    include_str!("stages/classic_joints.mbg"),
];

fn expansions() -> String {
    let rejected = TEXTS[4].replace("#[derivative]", "");
    let texts = TEXTS.into_iter().chain([rejected.as_str()]);
    let both = texts.map(|text| {
        let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
        let expanded = expand(tokens.clone(), &quote!(::mbg_runtime), &no_file);
        let explained = explain(tokens, &no_file, &|_| String::new());
        format!("{expanded}\n{}\n", explained.unwrap_or_else(|text| text))
    });
    both.collect()
}

#[test]
fn expansion_is_the_same_every_time() {
    assert!(expansions() == expansions());
}

#[test]
fn expansion_is_the_same_in_every_process() {
    let own = expansions();
    if let Ok(path) = std::env::var(TARGET) {
        std::fs::write(path, own).expect("the directory of the tests exists");
        return;
    }
    for process in ["first", "second"] {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("expansions_{process}"));
        let program = std::env::current_exe().expect("tests run from a file");
        let output = Command::new(program)
            .args(["--exact", "expansion_is_the_same_in_every_process"])
            .env(TARGET, &path)
            .output()
            .expect("the test runs again");
        assert!(output.status.success());
        let other = std::fs::read_to_string(path).expect("the process has written");
        assert!(other == own, "the {process} process expands differently");
    }
}
