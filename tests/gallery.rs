//! The page of the gallery shows every picture, and names models and commands that exist.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs::read_to_string;
use std::path::Path;

/// What stands in a text between two marks.
fn between<'a>(text: &'a str, open: &'a str, close: &'a str) -> impl Iterator<Item = &'a str> {
    let parts = text.split(open).skip(1);
    parts.map(move |part| part.split(close).next().unwrap())
}

#[test]
fn the_gallery_is_whole() {
    let page = read_to_string("docs/gallery.md").unwrap();
    for model in between(&page, "Model: `", "`") {
        assert!(Path::new(model).is_file(), "{model}");
    }
    let pictures: BTreeSet<&str> = between(&page, "(gallery/", ".svg)").collect();
    let commands: BTreeSet<&str> = between(
        &page,
        "Command: `cargo run --release --example gallery -- ",
        "`",
    )
    .collect();
    let example = read_to_string("examples/gallery/main.rs").unwrap();
    let scenes: BTreeSet<&str> = between(&example, "    (\"", "\"").collect();
    let drawn: Vec<String> = std::fs::read_dir("docs/gallery")
        .unwrap()
        .map(|file| file.unwrap().path())
        .map(|file| file.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(pictures, drawn.iter().map(String::as_str).collect());
    assert_eq!(pictures, scenes);
    assert_eq!(pictures, commands);
    assert!(scenes.len() > 1);
}
