//! The rules of causality as constraints on strokes.
//!
//! Input: a [`BondGraph`]. Output: a [`Problem`], in which every rule reads "exactly one of these literals holds".
//! Afterwards nothing needs to know what an element is: a stroke is a boolean of its bond, a literal says at which
//! end of a bond effort enters, and
//!
//! * a scalar 0-junction takes its effort from exactly one bond, a scalar 1-junction its flow from exactly one
//!   (Karnopp & Rosenberg 1968); an array of junctions obeys component by component (Breedveld 1985), where equal
//!   components share one constraint;
//! * a transformer takes effort at exactly one of its ports, a gyrator takes effort at both or flow at both;
//! * a fixed port is a constraint with one literal. Fixed ports stand first, in the order in which SCAP assigns them.
//!
//! No errors are reported here; a junction without a bond becomes a constraint that nothing satisfies.

use std::ops::Range;

use crate::graph::{
    BondGraph, BondId, Element, ElementId, End, JunctionId, JunctionKind, Law, Rule,
};

/// The end of a bond that receives effort, where the causal stroke is drawn; that end imposes the flow on the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stroke {
    /// Effort enters at [`Bond::from`](crate::graph::Bond::from).
    From,
    /// Effort enters at [`Bond::to`](crate::graph::Bond::to).
    To,
}

impl Stroke {
    /// The other end.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::From => Self::To,
            Self::To => Self::From,
        }
    }
}

/// "The stroke of this bond stands at this end."
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Literal {
    /// Which bond.
    pub bond: BondId,
    /// Where effort enters.
    pub stroke: Stroke,
}

impl Literal {
    /// The opposite statement.
    #[must_use]
    pub fn negated(self) -> Self {
        Self {
            bond: self.bond,
            stroke: self.stroke.opposite(),
        }
    }
}

/// Which rule a constraint states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Site {
    /// The law of this element allows one causality only.
    Fixed(ElementId),
    /// Components of a junction that see the same bonds.
    Junction(JunctionId, Range<usize>),
    /// A transformer or gyrator, which ties the strokes of its two bonds.
    TwoPort(ElementId),
    /// This storage's causality is taken as decided, or admitted only so.
    Assumed(ElementId),
    /// This storage is supposed to be integral, to see what follows.
    Supposed(ElementId),
}

/// Exactly one of the literals holds.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// One literal per bond that takes part.
    pub literals: Vec<Literal>,
    /// Whose rule this is.
    pub site: Site,
}

/// All constraints on the strokes of a graph.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Fixed ports first, then junctions, then two-ports.
    pub constraints: Vec<Constraint>,
    /// For each bond, the constraints and literals in which it takes part.
    pub occurrences: Vec<Vec<(usize, Stroke)>>,
}

impl Problem {
    /// The rules of a graph.
    #[must_use]
    pub fn new(graph: &BondGraph) -> Self {
        let ports = Ports::new(graph);
        let mut problem = Self::empty(graph.bonds.len());
        for (element, literal) in fixed_ports(graph, &ports) {
            problem.add(vec![literal], Site::Fixed(element));
        }
        add_junctions(graph, &mut problem);
        for (index, element) in graph.elements.iter().enumerate() {
            let gyrator = matches!(element.rule, Rule::Gyrator { .. });
            if !gyrator && !matches!(element.rule, Rule::Transformer { .. }) {
                continue;
            }
            for (&input, &output) in ports.input[index].iter().zip(&ports.output[index]) {
                let output = if gyrator { output.negated() } else { output };
                problem.add(vec![input, output], Site::TwoPort(ElementId(index)));
            }
        }
        problem
    }

    /// No rules.
    #[must_use]
    pub fn empty(bonds: usize) -> Self {
        Self {
            constraints: Vec::new(),
            occurrences: vec![Vec::new(); bonds],
        }
    }

    /// Some of the rules.
    #[must_use]
    pub fn restricted(&self, constraints: &[usize]) -> Self {
        let mut part = Self::empty(self.occurrences.len());
        for &index in constraints {
            part.add(
                self.constraints[index].literals.clone(),
                self.constraints[index].site.clone(),
            );
        }
        part
    }

    /// Adds a rule.
    pub fn add(&mut self, literals: Vec<Literal>, site: Site) {
        let index = self.constraints.len();
        for literal in &literals {
            self.occurrences[literal.bond.0].push((index, literal.stroke));
        }
        self.constraints.push(Constraint { literals, site });
    }
}

/// The bonds at each element's ports, as the literal "effort enters the element here".
struct Ports {
    input: Vec<Vec<Literal>>,
    output: Vec<Vec<Literal>>,
}

impl Ports {
    /// A one-port's bond counts as its input.
    fn new(graph: &BondGraph) -> Self {
        let none = vec![Vec::new(); graph.elements.len()];
        let mut ports = Self {
            input: none.clone(),
            output: none,
        };
        for (bond, end, literal) in ends(graph) {
            debug_assert_eq!(bond, literal.bond);
            match end {
                End::OnePort(id) | End::In(id) => ports.input[id.0].push(literal),
                End::Out(id) => ports.output[id.0].push(literal),
                End::Junction(..) | End::Border => {}
            }
        }
        ports
    }
}

/// Both ends of every bond, with the literal "effort enters here".
fn ends(graph: &BondGraph) -> impl Iterator<Item = (BondId, &End, Literal)> {
    graph.bonds.iter().enumerate().flat_map(|(index, bond)| {
        let bond_id = BondId(index);
        [(&bond.from, Stroke::From), (&bond.to, Stroke::To)].map(|(end, stroke)| {
            (
                bond_id,
                end,
                Literal {
                    bond: bond_id,
                    stroke,
                },
            )
        })
    })
}

/// The classes of fixed ports in the order in which they are assigned, so that a contradiction is blamed on the
/// earliest class that suffices for it.
fn fixed_class(rule: Rule) -> Option<u8> {
    match rule {
        Rule::EffortOut | Rule::FlowOut => Some(0),
        Rule::Gyroscopic => Some(1),
        Rule::Transformer {
            invertible: false, ..
        }
        | Rule::Gyrator {
            invertible: false, ..
        } => Some(2),
        Rule::ResistanceOnly | Rule::ConductanceOnly => Some(3),
        _ => None,
    }
}

/// What fixed ports demand. That a transformer or gyrator runs forward is demanded at its input only.
fn fixed_ports(graph: &BondGraph, ports: &Ports) -> Vec<(ElementId, Literal)> {
    let mut fixed = Vec::new();
    for class in 0..4 {
        for (index, element) in graph.elements.iter().enumerate() {
            if fixed_class(element.rule) != Some(class) {
                continue;
            }
            let takes_effort = matches!(element.rule, Rule::FlowOut | Rule::ConductanceOnly);
            for &port in &ports.input[index] {
                fixed.push((
                    ElementId(index),
                    if takes_effort { port } else { port.negated() },
                ));
            }
        }
    }
    fixed
}

/// One constraint per run of components that see the same bonds.
fn add_junctions(graph: &BondGraph, problem: &mut Problem) {
    let mut seen: Vec<Vec<(Range<usize>, Literal)>> = vec![Vec::new(); graph.junctions.len()];
    for (_, end, literal) in ends(graph) {
        if let End::Junction(id, range) = end {
            let literal = match graph.junctions[id.0].kind {
                JunctionKind::Zero => literal,
                JunctionKind::One => literal.negated(),
            };
            seen[id.0].push((range.clone(), literal));
        }
    }
    for (index, (junction, bonds)) in graph.junctions.iter().zip(seen).enumerate() {
        let mut cuts = vec![0, junction.dimension];
        cuts.extend(bonds.iter().flat_map(|(range, _)| [range.start, range.end]));
        cuts.retain(|cut| *cut <= junction.dimension);
        cuts.sort_unstable();
        cuts.dedup();
        let mut runs: Vec<Vec<Literal>> = vec![Vec::new(); cuts.len().saturating_sub(1)];
        for (range, literal) in bonds {
            let first = cuts.partition_point(|cut| *cut < range.start);
            for (run, _) in runs
                .iter_mut()
                .zip(&cuts)
                .skip(first)
                .take_while(|(_, cut)| **cut < range.end)
            {
                run.push(literal);
            }
        }
        for (run, cut) in runs.into_iter().zip(cuts.windows(2)) {
            problem.add(run, Site::Junction(JunctionId(index), cut[0]..cut[1]));
        }
    }
}

/// A storage and the stroke of its integral causality.
#[derive(Clone, Debug)]
pub struct Storage {
    /// Which storage.
    pub element: ElementId,
    /// Holds in integral causality: effort enters an `I` and leaves a `C`.
    pub integral: Literal,
    /// Whether `#[derivative]` stands on it.
    pub marked: bool,
}

/// The order of SCAP (Karnopp, Margolis & Rosenberg), after the fixed ports.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Storages in order of declaration, those under `#[derivative]` last.
    pub storages: Vec<Storage>,
    /// What to try first: storages in integral causality, then resistors as their law is written, then two-ports
    /// forward, then the remaining bonds with the stroke at the arrow's head.
    pub wishes: Vec<Literal>,
}

impl Plan {
    /// The order for a graph.
    #[must_use]
    pub fn new(graph: &BondGraph) -> Self {
        let ports = Ports::new(graph);
        let storages = storages(graph, &ports);
        let mut wishes: Vec<Literal> = storages.iter().map(|storage| storage.integral).collect();
        for two_port in [false, true] {
            for (index, element) in graph.elements.iter().enumerate() {
                if two_port
                    == matches!(
                        element.rule,
                        Rule::Transformer { .. } | Rule::Gyrator { .. }
                    )
                {
                    wishes.extend(ports.input[index].iter().map(|port| wish(element, *port)));
                }
            }
        }
        wishes.extend((0..graph.bonds.len()).map(|bond| Literal {
            bond: BondId(bond),
            stroke: Stroke::To,
        }));
        let mut first = vec![true; graph.bonds.len()];
        wishes.retain(|wish| std::mem::take(&mut first[wish.bond.0]));
        Self { storages, wishes }
    }
}

fn storages(graph: &BondGraph, ports: &Ports) -> Vec<Storage> {
    let mut storages = Vec::new();
    for marked in [false, true] {
        for (index, element) in graph.elements.iter().enumerate() {
            let takes_effort = match element.rule {
                Rule::PreferFlowOut => true,
                Rule::PreferEffortOut => false,
                _ => continue,
            };
            // A storage with two bonds has been reported by an earlier stage; its first bond stands for it.
            if let (Some(&port), true) = (ports.input[index].first(), element.derivative == marked)
            {
                let integral = if takes_effort { port } else { port.negated() };
                storages.push(Storage {
                    element: ElementId(index),
                    integral,
                    marked,
                });
            }
        }
    }
    storages
}

/// A resistor's law as it is written, and two-ports forward, need no inverse.
fn wish(element: &Element, port: Literal) -> Literal {
    match element.law {
        Law::Conductance(_) | Law::FlowLaw(_) => port,
        _ => port.negated(),
    }
}
