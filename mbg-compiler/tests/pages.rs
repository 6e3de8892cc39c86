//! What pages tell that is written elsewhere.
#![allow(clippy::unwrap_used)]

use mbg_compiler::codes::ALL;

/// A file of the workspace.
fn file(path: &str) -> String {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../");
    std::fs::read_to_string(format!("{root}{path}")).unwrap()
}

#[test]
fn the_page_of_the_language_tells_all_codes() {
    let page = file("mbg-runtime/src/language.md");
    let (_, found) = page.split_once("| code | is |\n|---|---|\n").unwrap();
    let rows = ALL
        .iter()
        .map(|code| format!("| {} | {} |\n", code.text, code.meaning));
    assert_eq!(found, rows.collect::<String>());
}

#[test]
fn the_version_of_nalgebra_that_users_are_told_is_that_of_the_runtime() {
    let version = |text: &str| {
        let (_, version) = text.split_once("\nnalgebra = ")?;
        version.split('"').nth(1).map(str::to_owned)
    };
    let ours = version(&file("Cargo.toml"));
    assert!(ours.is_some());
    assert_eq!(version(&file("README.md")), ours);
    let page = file("mbg-runtime/src/lib.rs").replace("//! ", "");
    assert_eq!(version(&page), ours);
}

#[test]
fn every_package_holds_the_licences() {
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        for package in ["compare", "compiler", "macros", "runtime", "urdf"] {
            let held = file(&format!("mbg-{package}/{licence}"));
            assert_eq!(held, file(licence), "{package}");
        }
    }
}
