//! Words of the laws of elements in other tools and parts of physics, and what is written here instead.

use proc_macro2::Ident;
use syn::Expr;

use super::elsewhere::{filled, value_text};
use crate::graph::ElementKind;
use crate::syntax::ast::Element;
use crate::syntax::words::{ELEMENTS, law_words};

/// What the coefficients of elements are called in the parts of physics, and the words of their laws.
const COEFFICIENTS: &[(ElementKind, &[&str], &str)] = &[
    (
        ElementKind::I,
        &[
            "inductance",
            "mass",
            "moment",
            "moment_of_inertia",
            "inertance",
        ],
        "inertia",
    ),
    // A capacity is flow gathered by effort: the inverse of what a spring is known by.
    (
        ElementKind::C,
        &[
            "capacitance",
            "capacity",
            "heat_capacity",
            "thermal_capacity",
            "permeance",
        ],
        "compliance",
    ),
    (
        ElementKind::C,
        &[
            "spring_constant",
            "spring_rate",
            "k",
            "elastance",
            "reluctance",
        ],
        "stiffness",
    ),
    (
        ElementKind::R,
        &[
            "damping",
            "friction",
            "viscosity",
            "drag",
            "impedance",
            "r",
            "b",
            "d",
        ],
        "resistance",
    ),
    (ElementKind::R, &["admittance", "mobility"], "conductance"),
    // The variable that a law gives in the place of its word.
    (ElementKind::R, &["e"], "effort"),
    (ElementKind::R, &["f"], "flow"),
    (ElementKind::C, &["e"], "effort"),
    (ElementKind::I, &["f"], "flow"),
    (
        ElementKind::Se,
        &[
            "voltage", "force", "torque", "moment", "pressure", "value", "e",
        ],
        "effort",
    ),
    (
        ElementKind::Sf,
        &[
            "current", "velocity", "speed", "rate", "power", "value", "f",
        ],
        "flow",
    ),
];

/// What the states of storages at the start are called, and the words for them.
const STARTS: &[(ElementKind, &[&str], &str)] = &[
    (
        ElementKind::I,
        &[
            "initial_velocity",
            "initial_speed",
            "initial_rate",
            "initial_current",
            "v0",
            "omega0",
            "w0",
            "i0",
        ],
        "initial_flow",
    ),
    (ElementKind::I, &["initial_momentum", "p0"], "initial"),
    (
        ElementKind::C,
        &[
            "initial_displacement",
            "initial_position",
            "initial_angle",
            "initial_charge",
            "q0",
            "x0",
            "s0",
        ],
        "initial",
    ),
    (
        ElementKind::C,
        &[
            "initial_voltage",
            "initial_force",
            "initial_pressure",
            "initial_temperature",
        ],
        "initial_effort",
    ),
];

/// What the number of a transformer or gyrator is called.
const RATIOS: &[&str] = &["ratio", "modulus", "gain", "turns", "n", "m", "r"];

/// What to type for a word that an element does not have.
pub(super) fn told(element: &Element, word: &Ident, value: Option<&Expr>) -> Option<String> {
    law(element.kind, word, value)
        .or_else(|| start(element.kind, word, value))
        .or_else(|| other_source(element, word, value))
        .or_else(|| of_way(element.kind, word, value))
        .or_else(|| turned_round(element.kind, word))
        .or_else(|| stroke(word))
        .or_else(|| preloaded(element, word, value))
}

/// What to type for the law of an element that stands behind a word of another name.
pub(super) fn law(kind: ElementKind, word: &Ident, value: Option<&Expr>) -> Option<String> {
    if let Some(law) = converter_law(kind) {
        return by_converter(law, &word.to_string(), value);
    }
    here(COEFFICIENTS, kind, word, value)
}

/// Whether some element has a law behind this word.
pub(super) fn is_law(word: &Ident) -> bool {
    let mut laws = ELEMENTS.iter().flat_map(|(_, kind)| law_words(*kind));
    laws.any(|law| word == law)
}

/// What to type for a source that is given what the other kind gives.
fn other_source(element: &Element, word: &Ident, value: Option<&Expr>) -> Option<String> {
    let (other, what) = match element.kind {
        ElementKind::Se if word == "flow" => ("Sf", "flow"),
        ElementKind::Sf if word == "effort" => ("Se", "effort"),
        _ => return None,
    };
    let (name, value) = (&element.name, value_text(value));
    Some(format!(
        "a source of {what} is written `{other} {name} {{ {what}: {value} }}`"
    ))
}

/// What to type for a source of flow that is given what has this flow as its rate.
fn of_way(kind: ElementKind, word: &Ident, value: Option<&Expr>) -> Option<String> {
    let is_way = ["position", "displacement", "travel", "angle", "phi"]
        .iter()
        .any(|way| word == way);
    if kind != ElementKind::Sf || !is_way {
        return None;
    }
    let value = value_text(value);
    Some(format!(
        "a source of flow gives the rate: write `flow: …` with the rate of `{value}`; of an input that is \
         `input rate; integral {word} = rate;` and `flow: rate`"
    ))
}

/// What to type for the law of a storage that gives its state by its flow or its effort.
fn turned_round(kind: ElementKind, word: &Ident) -> Option<String> {
    let (words, law, state, number): (&[&str], _, _, _) = match kind {
        ElementKind::I => (
            &["momentum", "flux", "linkage", "flux_linkage", "psi", "p"],
            "flow",
            "p",
            "inertia",
        ),
        ElementKind::C => (&["charge", "volume", "q"], "effort", "q", "compliance"),
        _ => return None,
    };
    words.iter().any(|known| word == known).then(|| {
        format!(
            "the law stands the other way round, by the state: write `{number}: …` of a number, `{law}: …` in `{state}`, or of \
             points `{law}: interpolate({state}, [{word}, …], [{law}, …])`"
        )
    })
}

/// What to type for the causality of an element, which is not chosen here.
fn stroke(word: &Ident) -> Option<String> {
    (word == "causality").then(|| {
        "strokes are found while compiling; `#[derivative]` before a storage lets it follow from others".to_owned()
    })
}

/// What to type for the start of a storage that stands behind a word of another name.
fn start(kind: ElementKind, word: &Ident, value: Option<&Expr>) -> Option<String> {
    here(STARTS, kind, word, value)
}

/// What to type for a word of an element that has another name in a table.
fn here(
    table: &[(ElementKind, &[&str], &str)],
    kind: ElementKind,
    word: &Ident,
    value: Option<&Expr>,
) -> Option<String> {
    let mut own = table.iter().filter(|(owner, ..)| *owner == kind);
    let (.., here) = own.find(|(_, words, _)| words.iter().any(|known| word == known))?;
    Some(format!("write `{here}: {}`", value_text(value)))
}

/// Where a spring without load is, as its length or its angle is told elsewhere.
const RESTS: &[&str] = &[
    "rest",
    "rest_length",
    "free_length",
    "natural_length",
    "length",
    "l0",
];

/// What to type for a spring that is given where it is without load, or its load at zero.
fn preloaded(element: &Element, word: &Ident, value: Option<&Expr>) -> Option<String> {
    let text = match word {
        _ if RESTS.iter().any(|rest| word == rest) => "k * (q - x)",
        _ if word == "preload" => "x + k * q",
        _ => return None,
    };
    let mut laws = element.fields.iter().filter(|it| it.name == "stiffness");
    let stiffness = laws.next()?.value.as_ref()?;
    let value = value.filter(|_| element.kind == ElementKind::C)?;
    let effort = filled(text, &[("k", stiffness), ("x", value)]);
    Some(format!("write `effort: {effort}` in the place of both"))
}

/// What the law of an element with two ports gives behind it.
fn converter_law(kind: ElementKind) -> Option<&'static str> {
    match kind {
        ElementKind::TF | ElementKind::MTF => Some("flow"),
        ElementKind::GY | ElementKind::MGY => Some("effort"),
        _ => None,
    }
}

/// What to type for the number of a transformer or gyrator: its law multiplies the flow before it.
fn by_converter(law: &str, word: &str, value: Option<&Expr>) -> Option<String> {
    let text = value_text(value);
    let number = value.filter(|value| !matches!(value, Expr::Array(_)));
    let inverse = number.map(|value| filled("1 / x", &[("x", value)]));
    let rule = format!("the {law} behind it is that times the flow before it");
    let turned = value.filter(|it| law == "flow" && !matches!(it, Expr::Lit(_) | Expr::Unary(_)));
    let turned = turned.map(|value| {
        let transposed = filled("transpose(x)", &[("x", value)]);
        format!("`{law}: {transposed}` with the bonds turned round")
    });
    match (word, inverse) {
        // What one variable is multiplied by, the other is divided by, as power stays.
        ("effort" | "flow", inverse) => Some(match (inverse, turned) {
            (Some(inverse), Some(turned)) => {
                format!("write `{law}: {inverse}`: {rule}; of a vector or a matrix write {turned}")
            }
            (Some(inverse), None) => format!("write `{law}: {inverse}`: {rule}"),
            (None, Some(turned)) => format!("write {turned}: {rule}"),
            (None, None) => format!("write `{law}: …` with the inverse of it: {rule}"),
        }),
        _ if !RATIOS.contains(&word) => None,
        // The ratio of a gear is told either way.
        (_, Some(inverse)) if law == "flow" => Some(format!(
            "write `flow: {text}`: {rule}; write `flow: {inverse}` if the flow is divided by it"
        )),
        _ => Some(format!("write `{law}: {text}`: {rule}")),
    }
}
