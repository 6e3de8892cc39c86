//! Elements and junctions that are called as components are.

use crate::graph::ElementKind;
use crate::syntax::words::{ELEMENTS, digit_in_words, is_two_port};
use crate::syntax::{ast, dump};

/// What to type for a junction that is called as a component is.
pub(super) fn as_junction(instance: &ast::Instance) -> Option<String> {
    let digit = digit_in_words(&instance.component.to_string())?;
    let name = &instance.name;
    let ends = instance.connections.iter().map(dump::reference);
    let bonds: Vec<String> = ends.map(|end| format!(" {end} -> {name};")).collect();
    let bonds = bonds.concat();
    Some(format!(
        "a junction is declared by its digit: write `{digit} {name};{bonds}`"
    ))
}

/// Whether an instance is called as an element is: with other capitals, or as a modulated one, if it has as many junctions.
fn is_called(instance: &ast::Instance, (spelling, kind): (&str, ElementKind)) -> bool {
    let component = instance.component.to_string();
    let ports = if is_two_port(kind) { 2 } else { 1 };
    let lower = component.to_lowercase();
    let modulated = format!("m{}", spelling.to_lowercase());
    component == spelling
        || instance.connections.len() == ports
            && (lower == spelling.to_lowercase() || lower == modulated)
}

/// What to type for an element that is called as a component is.
pub(super) fn as_element(instance: &ast::Instance) -> Option<String> {
    let mut kinds = ELEMENTS.iter();
    let (spelling, kind) = kinds.find(|it| is_called(instance, **it))?;
    let words = instance.arguments.iter().map(|it| match &it.value {
        Some(value) => format!("{}: {}", it.name, dump::expression(value)),
        None => it.name.to_string(),
    });
    let words = words.collect::<Vec<_>>().join(", ");
    let words = if words.is_empty() { "…" } else { &words };
    let element = format!("{spelling} {} {{ {words} }}", instance.name);
    let ends: Vec<String> = instance.connections.iter().map(dump::reference).collect();
    let written = match (&ends[..], kind) {
        ([from, to], _) if is_two_port(*kind) => format!("{from} -> {element} -> {to};"),
        _ if is_two_port(*kind) => format!("… -> {element} -> …;"),
        ([at], ElementKind::Se | ElementKind::Sf) => format!("{element} -> {at};"),
        ([at], _) => format!("{at} -> {element};"),
        _ => format!("… -> {element};"),
    };
    Some(format!("`{spelling}` is an element: write `{written}`"))
}
