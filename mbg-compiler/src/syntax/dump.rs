//! The syntax tree as text, one statement a line.

use std::fmt::Write;

use quote::ToTokens;

use super::ast::{ChainNode, Element, Item, JunctionKind, Reference, Source, Statement, Unit};

/// The tree as text.
#[must_use]
pub fn dump(source: &Source) -> String {
    let mut text = String::new();
    for item in &source.items {
        let (head, statements) = match item {
            Item::Model(model) => (format!("model {}", model.name), &model.statements),
            Item::Component(component) => {
                let ports: Vec<_> = component
                    .ports
                    .iter()
                    .map(|port| format!("{}[{}]", port.name, port.dimension))
                    .collect();
                (
                    format!("component {}({})", component.name, ports.join(", ")),
                    &component.statements,
                )
            }
        };
        let _ = writeln!(text, "{head}");
        for line in statements.iter().flat_map(lines) {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

fn lines(statement: &Statement) -> Vec<String> {
    vec![match statement {
        Statement::Parameter(parameter) => {
            let default = parameter
                .default
                .as_ref()
                .map_or_else(String::new, |value| format!(" = {}", code(value)));
            format!(
                "param {}{}{default}",
                parameter.name,
                unit(parameter.unit.as_ref())
            )
        }
        Statement::Input(input) => format!(
            "input {}[{}]{}",
            input.name,
            input.dimension,
            unit(input.unit.as_ref())
        ),
        Statement::Output(output) => {
            let unit = unit(output.unit.as_ref());
            format!(
                "output {}[{}]{unit} = {}",
                output.name,
                output.dimension,
                code(&output.value)
            )
        }
        Statement::Integral(integral) => {
            format!(
                "integral {}[{}] = {}",
                integral.name,
                integral.dimension,
                code(&integral.rate)
            )
        }
        Statement::Attitude(attitude) => {
            format!(
                "attitude {} = quaternion({})",
                attitude.name,
                code(&attitude.angular_velocity)
            )
        }
        Statement::Junction(junction) => {
            let digit = if junction.kind == JunctionKind::Zero {
                0
            } else {
                1
            };
            let mark = if junction.coordinate {
                " coordinate"
            } else {
                ""
            };
            let mut all = vec![format!(
                "{digit} {}[{}]{mark}",
                junction.name, junction.dimension
            )];
            all.extend(
                junction
                    .elements
                    .iter()
                    .map(|inner| format!("  {}", element(inner))),
            );
            return all;
        }
        Statement::Chain(chain) => chain
            .nodes
            .iter()
            .map(node)
            .collect::<Vec<_>>()
            .join(" -> "),
        Statement::Instance(instance) => {
            let connections: Vec<_> = instance.connections.iter().map(reference).collect();
            format!(
                "{}: {} ({})",
                instance.name,
                instance.component,
                connections.join(", ")
            )
        }
        Statement::Causality(causality, _) => format!("causality {causality:?}"),
        Statement::Broken(name) => format!(
            "broken {}",
            name.as_ref().map_or_else(String::new, ToString::to_string)
        ),
    }]
}

fn node(node: &ChainNode) -> String {
    match node {
        ChainNode::Reference(inner) => reference(inner),
        ChainNode::Element(inner) => element(inner),
    }
}

fn reference(reference: &Reference) -> String {
    let path: Vec<_> = reference.path.iter().map(ToString::to_string).collect();
    let selection = reference
        .selection
        .as_ref()
        .map_or_else(String::new, |selection| {
            format!("[{}..{}]", selection.start, selection.end)
        });
    path.join(".") + &selection
}

fn element(element: &Element) -> String {
    let fields: Vec<_> = element
        .fields
        .iter()
        .map(|field| match &field.value {
            Some(value) => format!("{}: {}", field.name, code(value)),
            None => field.name.to_string(),
        })
        .collect();
    let mark = if element.derivative.is_some() {
        "#[derivative] "
    } else {
        ""
    };
    let dimension = element
        .dimension
        .map_or_else(String::new, |size| format!("[{size}]"));
    format!(
        "{mark}{:?} {}{dimension} {{ {} }}",
        element.kind,
        element.name,
        fields.join(", ")
    )
}

fn unit(unit: Option<&Unit>) -> String {
    unit.map_or_else(String::new, |unit| format!(": {}", unit.text))
}

/// An expression without the spaces that token printing leaves.
fn code(tokens: &impl ToTokens) -> String {
    tokens
        .to_token_stream()
        .to_string()
        .replace(" . ", ".")
        .replace(" (", "(")
        .replace("( ", "(")
        .replace(" )", ")")
        .replace(" ,", ",")
}
