//! Units of efforts and flows: one pair for each component of a junction and of a port.

use super::dimension::{Dimension, Unknowns};
use super::report::Reporter;
use super::{second, watt};
use crate::elaborate::Place;
use crate::graph::{Bond, BondGraph, ElementId, ElementKind, End, Rule};

/// The units of an effort and a flow.
pub(super) type Pair = [Dimension; 2];

/// Efforts and flows of a graph. All bonds of a junction share both units: the common variable is one, and the others
/// are added.
pub(super) struct Ports {
    /// By junction and component.
    pub(super) junctions: Vec<Vec<Pair>>,
    /// By element and component: the only port, or the one before a two-port.
    pub(super) inner: Vec<Vec<Pair>>,
    /// By element and component: the port after a two-port.
    pub(super) outer: Vec<Vec<Pair>>,
}

/// Two units that a bond makes one and that are not.
pub(super) struct Mistake {
    /// Whether they are flows.
    pub(super) flow: bool,
    /// Both.
    pub(super) units: [Dimension; 2],
}

impl Ports {
    /// Unknown units all over, but for what bonds of one-ports and the rule of power say.
    pub(super) fn of(
        graph: &BondGraph,
        unknowns: &mut Unknowns,
        reporter: &mut Reporter<'_>,
    ) -> Self {
        let mut pairs = |count: usize| -> Vec<Pair> {
            (0..count)
                .map(|_| [unknowns.fresh(), unknowns.fresh()])
                .collect()
        };
        let mut ports = Self {
            junctions: Vec::new(),
            inner: Vec::new(),
            outer: Vec::new(),
        };
        for junction in &graph.junctions {
            ports.junctions.push(pairs(junction.dimension));
        }
        for (element, size) in graph.elements.iter().zip(sizes(graph)) {
            let (inner, outer) = match element.rule {
                Rule::Transformer { rows, columns, .. } | Rule::Gyrator { rows, columns, .. } => {
                    (columns, rows)
                }
                _ => (size, 0),
            };
            ports.inner.push(pairs(inner));
            ports.outer.push(pairs(outer));
        }
        for (junction, pairs) in graph.junctions.iter().zip(&ports.junctions) {
            if !junction.pseudo {
                pairs.iter().for_each(|pair| power(pair, unknowns));
            }
        }
        for bond in &graph.bonds {
            if let (Some(from), Some(to)) =
                (is_pseudo(graph, &bond.from), is_pseudo(graph, &bond.to))
                && from != to
            {
                reporter.pseudo(bond.origin);
            }
            if !joins_junctions(bond) {
                let pairs = ports.pairs(graph, &bond.from, &bond.to);
                // Nothing is known of the element yet.
                let _ = join(&pairs, unknowns);
                if matches!((&bond.from, &bond.to), (End::OnePort(_), End::OnePort(_))) {
                    pairs.iter().for_each(|pair| power(&pair[0], unknowns));
                }
            }
        }
        ports
    }

    /// The effort and the flow at a place.
    pub(super) fn variables(&self, place: Place, component: usize) -> &Pair {
        match place {
            Place::Junction(id) => &self.junctions[id.0][component],
            Place::Port(id) => &self.inner[id.0][component],
        }
    }

    /// What a bond makes equal, by component.
    pub(super) fn pairs(&self, graph: &BondGraph, from: &End, to: &End) -> Vec<[Pair; 2]> {
        let side = |end: &End| -> Vec<Pair> {
            match end {
                End::Junction(id, range) => {
                    debug_assert!(range.end <= graph.junctions[id.0].dimension);
                    self.junctions[id.0][range.clone()].to_vec()
                }
                End::OnePort(id) | End::In(id) => self.inner[id.0].clone(),
                End::Out(id) => self.outer[id.0].clone(),
                End::Border => Vec::new(),
            }
        };
        let both = side(from).into_iter().zip(side(to));
        both.map(|(from, to)| [from, to]).collect()
    }

    /// What the entry at a place after a word must be; a two-port says it twice.
    pub(super) fn wanted(
        &self,
        graph: &BondGraph,
        id: ElementId,
        word: &str,
        (row, column): (usize, usize),
        count: usize,
    ) -> Vec<Dimension> {
        let (inner, outer) = (&self.inner[id.0], &self.outer[id.0]);
        let kind = graph.elements[id.0].kind;
        if kind == ElementKind::EJS {
            // e = ω × h: each component of h stands beside the other two of ω.
            let others = (0..3).filter(|axis| *axis != row);
            return others
                .map(|axis| inner[3 - row - axis][0].over(&inner[axis][1]))
                .collect();
        }
        if !outer.is_empty() {
            let ([effort, flow], [effort_out, flow_out]) = (&inner[column], &outer[row]);
            return match kind {
                ElementKind::TF | ElementKind::MTF => {
                    vec![flow_out.over(flow), effort.over(effort_out)]
                }
                _ => vec![effort_out.over(flow), effort.over(flow_out)],
            };
        }
        let [effort, flow] = &inner[row];
        let (momentum, displacement) = (effort.times(&second()), flow.times(&second()));
        let stored = |pair: &Pair| pair[0].times(&pair[1]).times(&second());
        vec![match word {
            "inertia" => momentum.over(&inner[column][1]),
            "compliance" => displacement.over(&inner[column][0]),
            "stiffness" => effort.over(&inner[column][1]).over(&second()),
            "resistance" => effort.over(&inner[column][1]),
            "conductance" => flow.over(&inner[column][0]),
            "energy" if count == 1 => return inner.iter().map(stored).collect(),
            "energy" => stored(&inner[row]),
            "initial" if kind == ElementKind::I => momentum,
            "initial" | "displacement" => displacement,
            "effort" | "initial_effort" => effort.clone(),
            _ => flow.clone(),
        }]
    }
}

/// Makes both ends of a bond equal.
pub(super) fn join(pairs: &[[Pair; 2]], unknowns: &mut Unknowns) -> Option<Mistake> {
    let mut mistake = None;
    for [from, to] in pairs {
        for variable in 0..2 {
            if !unknowns.equate(&from[variable], &to[variable]) {
                let units = [from, to].map(|pair| unknowns.reduce(&pair[variable]));
                mistake = mistake.or(Some(Mistake {
                    flow: variable == 1,
                    units,
                }));
            }
        }
    }
    mistake
}

/// Effort times flow is power.
fn power(pair: &Pair, unknowns: &mut Unknowns) {
    // Both are unknown so far, so that this can always be had.
    let _ = unknowns.equate(&pair[0].times(&pair[1]), &watt());
}

/// Whether a bond has no element at its ends.
pub(super) fn joins_junctions(bond: &Bond) -> bool {
    matches!(
        (&bond.from, &bond.to),
        (End::Junction(..), End::Junction(..))
    )
}

/// Whether a junction is one of pseudo bonds.
fn is_pseudo(graph: &BondGraph, end: &End) -> Option<bool> {
    match end {
        End::Junction(id, _) => Some(graph.junctions[id.0].pseudo),
        _ => None,
    }
}

/// The dimension of each one-port, which is that of its bond.
fn sizes(graph: &BondGraph) -> Vec<usize> {
    let mut sizes = vec![0; graph.elements.len()];
    for bond in &graph.bonds {
        for end in [&bond.from, &bond.to] {
            if let End::OnePort(id) = end {
                sizes[id.0] = bond.dimension;
            }
        }
    }
    sizes
}
