//! Elements that stand alone, without an arrow, and what to type instead.

use proc_macro2::{Delimiter, TokenTree};

use super::ast::{Element, ElementKind};
use super::cursor::Cursor;
use super::dump;
use super::slips::is_mark;
use super::words::is_two_port;

/// Components of the library with one element between two nodes: its law, and what their parameter is called.
const COMPONENTS: [(ElementKind, &str, &str, &str); 3] = [
    (ElementKind::R, "resistance", "Resistor", "resistance"),
    (ElementKind::C, "compliance", "Capacitor", "capacitance"),
    (ElementKind::I, "inertia", "Inductor", "inductance"),
];

/// What to type for an element that was just read as a whole statement from a place on.
pub(super) fn alone(cursor: &Cursor, element: &Element, start: usize) -> Vec<String> {
    let text = dump::tokens(cursor.since(start).iter().cloned().collect());
    let Some(ports) = cursor.group(0, Delimiter::Parenthesis) else {
        let bonded = bonded(element.kind, &text, &neighbours(cursor, element));
        let place = match is_two_port(element.kind) {
            true => "an element with two ports stands between two arrows",
            false => "an element stands in a bond or in the braces of a junction",
        };
        return vec![format!("{place}: `{bonded};`")];
    };
    let ports: Vec<TokenTree> = ports.stream().into_iter().collect();
    let ports = ports.split(|token| is_mark(token, ','));
    let ports = ports.map(|port| dump::tokens(port.iter().cloned().collect()));
    let ports: Vec<String> = ports.filter(|port| !port.is_empty()).collect();
    let (false, [a, b]) = (is_two_port(element.kind), &ports[..]) else {
        let bonded = bonded(element.kind, &text, &ports);
        return vec![format!(
            "what an element is bonded to stands at an arrow: `{bonded};`"
        )];
    };
    let mut helps = vec![format!(
        "an element between two nodes stands at a junction of its own: `1 branch {{ {text} }} {a} -> branch; branch -> {b};`"
    )];
    helps.extend(component(element).map(|component| {
        format!("components of the library take nodes in parentheses: `{component} ({a}, {b});`")
    }));
    helps
}

/// The junctions that the bond behind the element leads from or to, as in `C c { … } v -> c;`.
fn neighbours(cursor: &Cursor, element: &Element) -> Vec<String> {
    let length = cursor.length_until(|it, at| it.punct(at, ';'));
    let arrow = cursor.length_until(|it, at| it.arrow(at));
    if arrow >= length {
        return Vec::new();
    }
    let ahead = cursor.ahead(length);
    let ends = [&ahead[..arrow], &ahead[(arrow + 2).min(length)..]];
    let ends = ends.map(|end| dump::tokens(end.iter().cloned().collect()));
    let others = ends.iter().filter(|end| element.name != end.as_str());
    // A longer chain, or one that the element is not part of, says nothing of it.
    match others.cloned().collect::<Vec<_>>() {
        others if others.len() == 1 && !others[0].contains("->") => others,
        _ => Vec::new(),
    }
}

/// A bond of an element with junctions, which may not be known.
fn bonded(kind: ElementKind, element: &str, junctions: &[String]) -> String {
    let junction = |place: usize| junctions.get(place).map_or("…", String::as_str);
    match kind {
        ElementKind::Se | ElementKind::Sf => format!("{element} -> {}", junction(0)),
        _ if is_two_port(kind) => format!("{} -> {element} -> {}", junction(0), junction(1)),
        _ => format!("{} -> {element}", junction(0)),
    }
}

/// `r: Resistor { resistance: 1.0 }`, for an element with one word of which there is a component.
fn component(element: &Element) -> Option<String> {
    let [law] = &element.fields[..] else {
        return None;
    };
    let mut known = COMPONENTS.iter();
    let (.., component, parameter) =
        known.find(|(kind, word, ..)| *kind == element.kind && law.name == word)?;
    let (name, value) = (&element.name, dump::expression(law.value.as_ref()?));
    Some(format!("{name}: {component} {{ {parameter}: {value} }}"))
}
