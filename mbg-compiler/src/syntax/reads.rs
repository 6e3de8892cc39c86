//! What statements read: their expressions, and the statements in their braces.

use syn::Expr;

use super::ast::{ChainNode, Element, Reference, Statement};

impl Statement {
    /// All expressions in it, but for those of the statements in its braces.
    #[must_use]
    pub fn expressions(&self) -> Vec<&Expr> {
        match self {
            Self::Parameter(it) => it.default.iter().collect(),
            Self::Output(it) => vec![&it.value],
            Self::Let(it) => vec![&it.value],
            Self::Gravity(it) => vec![&it.value],
            Self::Assertion(it) => vec![&it.condition],
            Self::Integral(it) => it.initial.iter().chain([&it.rate]).collect(),
            Self::Attitude(it) => it.initial.iter().chain([&it.angular_velocity]).collect(),
            Self::Junction(it) => {
                let elements = it.elements.iter().flat_map(Element::values);
                it.initial_flow.iter().chain(elements).collect()
            }
            Self::Chain(it) => it.nodes.iter().flat_map(of_node).collect(),
            Self::Closure(it) => {
                let ends = [&it.from, &it.to].into_iter().flat_map(selections);
                it.displacement.iter().chain(ends).collect()
            }
            Self::Instance(it) => {
                let ends = it.connections.iter().flat_map(selections);
                let arguments = it.arguments.iter();
                let arguments = arguments.filter_map(|it| it.value.as_ref());
                arguments.chain(ends).collect()
            }
            Self::Loop(it) => vec![&it.start, &it.end],
            Self::Conditional(it) => {
                let branches = it.branches.iter();
                branches
                    .filter_map(|branch| branch.condition.as_ref())
                    .collect()
            }
            Self::Choice(_) | Self::Input(_) | Self::Causality(..) | Self::Broken(_) => Vec::new(),
        }
    }

    /// The junctions and elements that it bonds.
    #[must_use]
    pub fn references(&self) -> Vec<&Reference> {
        match self {
            Self::Chain(it) => {
                let nodes = it.nodes.iter().filter_map(|node| match node {
                    ChainNode::Reference(reference) => Some(reference),
                    ChainNode::Element(_) => None,
                });
                nodes.collect()
            }
            Self::Closure(it) => vec![&it.from, &it.to],
            Self::Instance(it) => it.connections.iter().collect(),
            _ => Vec::new(),
        }
    }

    /// The statements in its braces.
    #[must_use]
    pub fn inside(&self) -> Vec<&Self> {
        match self {
            Self::Loop(it) => it.statements.iter().collect(),
            Self::Conditional(it) => {
                let branches = it.branches.iter();
                branches.flat_map(|branch| &branch.statements).collect()
            }
            _ => Vec::new(),
        }
    }
}

fn of_node(node: &ChainNode) -> Vec<&Expr> {
    match node {
        ChainNode::Reference(reference) => selections(reference),
        ChainNode::Element(element) => element.values().collect(),
    }
}

/// What stands in the brackets of a reference.
fn selections(reference: &Reference) -> Vec<&Expr> {
    let selections = reference
        .path
        .iter()
        .filter_map(|segment| segment.selection.as_ref());
    selections
        .flat_map(|it| it.end.iter().chain([&it.start]))
        .collect()
}
