//! Causal steps as sentences.

use std::ops::Range;

use super::propagation::Propagation;
use super::strokes::{Constraint, Site, Stroke};
use super::uniform::{Cause, Step};
use crate::graph::{
    BondGraph, BondId, ElementId, ElementKind, End, JunctionId, JunctionKind, OriginId, Rule,
};

/// One step of a causal chain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChainStep {
    /// Where what the step speaks of was written.
    pub origin: OriginId,
    /// One sentence, in lower case, without a full stop.
    pub text: String,
}

/// Elements by the name that people give them.
#[must_use]
pub fn kind_name(graph: &BondGraph, id: ElementId) -> &'static str {
    let element = &graph.elements[id.0];
    match element.kind {
        ElementKind::Se => "effort source",
        ElementKind::Sf => "flow source",
        ElementKind::I => "inertia",
        ElementKind::C => "compliance",
        ElementKind::R => "resistor",
        ElementKind::TF | ElementKind::MTF => "transformer",
        ElementKind::GY | ElementKind::MGY => "gyrator",
        ElementKind::EJS => "gyroscopic multiport",
    }
}

/// `I`, `MTF`, …
#[must_use]
pub fn symbol(kind: ElementKind) -> &'static str {
    match kind {
        ElementKind::Se => "Se",
        ElementKind::Sf => "Sf",
        ElementKind::I => "I",
        ElementKind::C => "C",
        ElementKind::R => "R",
        ElementKind::TF => "TF",
        ElementKind::GY => "GY",
        ElementKind::MTF => "MTF",
        ElementKind::MGY => "MGY",
        ElementKind::EJS => "EJS",
    }
}

/// `M has 3 rows and 1 column`.
#[must_use]
pub fn dimensions(rule: Rule) -> String {
    let (letter, rows, columns) = match rule {
        Rule::Transformer { rows, columns, .. } => ('M', rows, columns),
        Rule::Gyrator { rows, columns, .. } => ('G', rows, columns),
        _ => return String::new(),
    };
    if rows == columns {
        return format!("{letter} has no inverse");
    }
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    format!(
        "{letter} has {rows} row{} and {columns} column{}",
        plural(rows),
        plural(columns)
    )
}

/// The sentence for one stroke and its cause.
#[must_use]
pub fn step(graph: &BondGraph, step: &Step) -> ChainStep {
    let (bond, stroke) = (step.bond, step.stroke);
    let origin = graph.bonds[bond.0].origin;
    match &step.cause {
        Cause::Fixed(id) => at(graph, *id, fixed(graph, *id, bond)),
        Cause::Integral(id) => at(graph, *id, integral(graph, *id, bond)),
        Cause::Supposed(id) => at(
            graph,
            *id,
            format!("in integral causality {}", assumed(graph, *id, bond)),
        ),
        Cause::Yielded(id) => at(
            graph,
            *id,
            format!("`{}` is in derivative causality", graph.elements[id.0].name),
        ),
        Cause::Free => {
            let text = format!(
                "`{}` is free, and effort is taken to enter `{}`",
                graph.bond_name(bond),
                receiver(graph, bond, stroke)
            );
            ChainStep { origin, text }
        }
        Cause::Junction(id, components) => ChainStep {
            origin,
            text: junction_step(graph, (*id, components), step),
        },
        Cause::TwoPort(id) => at(graph, *id, two_port_step(graph, *id, bond, stroke)),
    }
}

fn at(graph: &BondGraph, id: ElementId, text: String) -> ChainStep {
    ChainStep {
        origin: graph.elements[id.0].origin,
        text,
    }
}

/// The end that effort enters.
fn receiver(graph: &BondGraph, bond: BondId, stroke: Stroke) -> String {
    let bond = &graph.bonds[bond.0];
    graph.end_name(if stroke == Stroke::From {
        &bond.from
    } else {
        &bond.to
    })
}

/// The end of a bond that is not this element's.
fn far(graph: &BondGraph, id: ElementId, bond: BondId) -> String {
    let bond = &graph.bonds[bond.0];
    let own = matches!(bond.from, End::OnePort(e) | End::In(e) | End::Out(e) if e == id);
    graph.end_name(if own { &bond.to } else { &bond.from })
}

/// What a fixed element demands.
fn fixed(graph: &BondGraph, id: ElementId, bond: BondId) -> String {
    let element = &graph.elements[id.0];
    let (name, other) = (&element.name, far(graph, id, bond));
    match element.rule {
        Rule::EffortOut => format!("`{name}` fixes the effort of `{other}`"),
        Rule::FlowOut => format!("`{name}` fixes the flow of `{other}`"),
        Rule::Gyroscopic => {
            format!(
                "`{name}` takes the flow of `{other}` and cannot give it: its skew 3x3 matrix has rank 2"
            )
        }
        Rule::ResistanceOnly => {
            format!("the law of `{name}` gives the effort, so it takes the flow of `{other}`")
        }
        Rule::ConductanceOnly => {
            format!("the law of `{name}` gives the flow, so it takes the effort of `{other}`")
        }
        rule => format!(
            "`{name}` runs forward only ({}), so it takes the flow of `{other}`",
            dimensions(rule)
        ),
    }
}

/// What a storage in integral causality does.
fn integral(graph: &BondGraph, id: ElementId, bond: BondId) -> String {
    let element = &graph.elements[id.0];
    let variable = if element.rule == Rule::PreferFlowOut {
        "flow"
    } else {
        "effort"
    };
    format!(
        "`{}` has its {variable} from `{}`, which is in integral causality",
        far(graph, id, bond),
        element.name
    )
}

/// What a junction shares: its name, the shared variable and the one that it sums.
fn shared(
    graph: &BondGraph,
    id: JunctionId,
    components: &Range<usize>,
) -> (String, &'static str, &'static str) {
    let name = graph.end_name(&End::Junction(id, components.clone()));
    match graph.junctions[id.0].kind {
        JunctionKind::Zero => (name, "effort", "flow"),
        JunctionKind::One => (name, "flow", "effort"),
    }
}

fn junction_step(graph: &BondGraph, junction: (JunctionId, &Range<usize>), step: &Step) -> String {
    let (id, components) = junction;
    let (name, variable, other_variable) = shared(graph, id, components);
    let ends = &graph.bonds[step.bond.0];
    let here = |end: &End| matches!(end, End::Junction(other, range) if *other == id && range.contains(&components.start));
    let (own, far) = if here(&ends.from) {
        (Stroke::From, &ends.to)
    } else {
        (Stroke::To, &ends.from)
    };
    let bond_name = graph.bond_name(step.bond);
    let brings = (own == step.stroke) == (variable == "effort");
    if brings && step.because.is_empty() {
        format!("`{bond_name}` is the only bond of `{name}`, so it must bring its {variable}")
    } else if brings {
        format!(
            "every other bond brings {other_variable} to `{name}`, so `{bond_name}` must bring its {variable}"
        )
    } else {
        format!(
            "so `{bond_name}` carries the {variable} of `{name}` to `{}`",
            graph.end_name(far)
        )
    }
}

fn two_port_step(graph: &BondGraph, id: ElementId, bond: BondId, stroke: Stroke) -> String {
    let (name, other) = (&graph.elements[id.0].name, far(graph, id, bond));
    let ends = &graph.bonds[bond.0];
    let own = if matches!(ends.from, End::In(e) | End::Out(e) if e == id) {
        Stroke::From
    } else {
        Stroke::To
    };
    let (given, taken) = if own == stroke {
        ("flow", "effort")
    } else {
        ("effort", "flow")
    };
    match graph.elements[id.0].rule {
        Rule::Gyrator { .. } => {
            format!("so `{name}` turns {taken} into {given} and gives it to `{other}`")
        }
        _ => format!("so `{name}` passes the {given} on to `{other}`"),
    }
}

/// The sentence for a constraint that cannot hold.
#[must_use]
pub fn clash(graph: &BondGraph, engine: &Propagation<'_>, constraint: &Constraint) -> ChainStep {
    let holding: Vec<BondId> = constraint
        .literals
        .iter()
        .filter(|literal| engine.holds(**literal) == Some(true))
        .map(|literal| literal.bond)
        .collect();
    match (&constraint.site, constraint.literals.first()) {
        (Site::Junction(id, components), first) => {
            let (name, variable, _) = shared(graph, *id, components);
            let text = match (holding.as_slice(), first) {
                (_, None) => format!("`{name}` has no bond that could give its {variable}"),
                ([], _) => format!("but then no bond gives `{name}` its {variable}"),
                (bonds, _) => {
                    let names: Vec<String> = bonds
                        .iter()
                        .map(|bond| format!("`{}`", graph.bond_name(*bond)))
                        .collect();
                    format!(
                        "but then `{name}` has its {variable} from more than one bond: {}",
                        names.join(", ")
                    )
                }
            };
            ChainStep {
                origin: graph.junctions[id.0].origin,
                text,
            }
        }
        (Site::TwoPort(id), _) => at(graph, *id, two_port_clash(graph, *id, holding.len())),
        (Site::Fixed(id), Some(literal)) => at(
            graph,
            *id,
            format!("but {}", fixed(graph, *id, literal.bond)),
        ),
        (Site::Assumed(id) | Site::Supposed(id), Some(literal)) => at(
            graph,
            *id,
            format!(
                "but in integral causality {}",
                assumed(graph, *id, literal.bond)
            ),
        ),
        (Site::Fixed(id) | Site::Assumed(id) | Site::Supposed(id), None) => {
            at(graph, *id, rule(graph, constraint).text)
        }
    }
}

fn assumed(graph: &BondGraph, id: ElementId, bond: BondId) -> String {
    let element = &graph.elements[id.0];
    let variable = if element.rule == Rule::PreferFlowOut {
        "flow"
    } else {
        "effort"
    };
    format!(
        "`{}` would give the {variable} of `{}`",
        element.name,
        far(graph, id, bond)
    )
}

fn two_port_clash(graph: &BondGraph, id: ElementId, holding: usize) -> String {
    let name = &graph.elements[id.0].name;
    match (graph.elements[id.0].rule, holding) {
        (Rule::Gyrator { .. }, _) => {
            format!("but `{name}` cannot take effort at one port and flow at the other")
        }
        (_, 0) => format!("but `{name}` cannot take flow at both ports"),
        _ => format!("but `{name}` cannot take effort at both ports"),
    }
}

/// What a constraint says, by itself.
#[must_use]
pub fn rule(graph: &BondGraph, constraint: &Constraint) -> ChainStep {
    let bonds = constraint
        .literals
        .iter()
        .map(|literal| graph.bond_name(literal.bond));
    match &constraint.site {
        Site::Junction(id, components) => {
            let (name, variable, _) = shared(graph, *id, components);
            let bonds = crate::diagnostics::listing(bonds);
            let text = format!("`{name}` takes its {variable} from exactly one of {bonds}");
            ChainStep {
                origin: graph.junctions[id.0].origin,
                text,
            }
        }
        Site::TwoPort(id) => {
            let name = &graph.elements[id.0].name;
            let text = match graph.elements[id.0].rule {
                Rule::Gyrator { .. } => {
                    format!("`{name}` takes effort at both ports or flow at both")
                }
                _ => format!("`{name}` takes effort at exactly one of its ports"),
            };
            at(graph, *id, text)
        }
        Site::Fixed(id) | Site::Assumed(id) | Site::Supposed(id) => {
            let bond = constraint
                .literals
                .first()
                .map_or(BondId(0), |literal| literal.bond);
            let is_fixed = matches!(constraint.site, Site::Fixed(_));
            at(
                graph,
                *id,
                if is_fixed {
                    fixed(graph, *id, bond)
                } else {
                    assumed(graph, *id, bond)
                },
            )
        }
    }
}
