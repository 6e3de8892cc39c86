//! All admissible uniform assignments of a graph.
//!
//! Input: a [`BondGraph`], which may be part of a model with [`End::Border`] where it was
//! cut, and what is admitted. Output: every assignment that satisfies the rules, in the order in which SCAP prefers
//! them. Counts of causal patterns, such as "two patterns at the relative bond, three at the 0-junction", come from
//! here.

use std::collections::BTreeSet;

use super::propagation::Propagation;
use super::search::BUDGET;
use super::strokes::{Literal, Plan, Problem, Site, Stroke};
use super::uniform;
use crate::graph::{BondGraph, BondId, ElementId, ElementKind, End};

/// What is admitted for storages of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storages {
    /// Integral causality only.
    Integral,
    /// Both.
    Free,
}

/// What to enumerate.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// What is admitted for every `I`.
    pub inertias: Storages,
    /// What is admitted for every `C`.
    pub compliances: Storages,
    /// At most so many assignments.
    pub limit: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            inertias: Storages::Free,
            compliances: Storages::Free,
            limit: 10_000,
        }
    }
}

/// One stroke per bond.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Assignment {
    /// In the order of the bonds.
    pub strokes: Vec<Stroke>,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Enumeration {
    /// All different.
    pub assignments: Vec<Assignment>,
    /// Whether these are all; `false` when the limit or the search's budget was reached.
    pub complete: bool,
}

impl Enumeration {
    /// Number of different patterns on these bonds.
    #[must_use]
    pub fn patterns(&self, bonds: &[BondId]) -> usize {
        let pattern = |assignment: &Assignment| -> Vec<Stroke> {
            bonds
                .iter()
                .map(|bond| assignment.strokes[bond.0])
                .collect()
        };
        self.assignments
            .iter()
            .map(pattern)
            .collect::<BTreeSet<_>>()
            .len()
    }

    /// The assignments with the fewest dependent storages.
    #[must_use]
    pub fn optimal(&self, graph: &BondGraph) -> Vec<&Assignment> {
        let plan = Plan::new(graph);
        let cost = |assignment: &&Assignment| uniform::dependent(&plan, &assignment.strokes).len();
        let least = self
            .assignments
            .iter()
            .map(|assignment| cost(&assignment))
            .min();
        self.assignments
            .iter()
            .filter(|assignment| Some(cost(assignment)) == least)
            .collect()
    }
}

impl Assignment {
    /// Storages in derivative causality, in order of declaration.
    #[must_use]
    pub fn dependent(&self, graph: &BondGraph) -> Vec<ElementId> {
        uniform::dependent(&Plan::new(graph), &self.strokes)
    }

    /// Resistors that take the flow and give the effort.
    #[must_use]
    pub fn resistances(&self, graph: &BondGraph) -> Vec<ElementId> {
        self.resistors(graph, false)
    }

    /// Resistors that take the effort and give the flow.
    #[must_use]
    pub fn conductances(&self, graph: &BondGraph) -> Vec<ElementId> {
        self.resistors(graph, true)
    }

    fn resistors(&self, graph: &BondGraph, takes_effort: bool) -> Vec<ElementId> {
        let mut found = BTreeSet::new();
        for (bond, stroke) in graph.bonds.iter().zip(&self.strokes) {
            for (end, side) in [(&bond.from, Stroke::From), (&bond.to, Stroke::To)] {
                if let End::OnePort(id) = end
                    && graph.elements[id.0].kind == ElementKind::R
                    && (side == *stroke) == takes_effort
                {
                    found.insert(*id);
                }
            }
        }
        found.into_iter().collect()
    }
}

/// Enumerates; no assignment at all is an empty list.
#[must_use]
pub fn enumerate(graph: &BondGraph, options: &Options) -> Enumeration {
    let mut problem = Problem::new(graph);
    let plan = Plan::new(graph);
    for storage in &plan.storages {
        let admitted = match graph.elements[storage.element.0].kind {
            ElementKind::C => options.compliances,
            _ => options.inertias,
        };
        if admitted == Storages::Integral {
            problem.add(vec![storage.integral], Site::Assumed(storage.element));
        }
    }
    let mut engine = Propagation::new(&problem);
    if engine.start().is_err() {
        return Enumeration {
            assignments: Vec::new(),
            complete: true,
        };
    }
    all(&mut engine, &plan, options.limit)
}

/// A decision that can still be turned over, or whose other side has been searched.
struct Decision {
    literal: Literal,
    /// Wishes before this one are assigned.
    cursor: usize,
    last: bool,
}

fn all(engine: &mut Propagation<'_>, plan: &Plan, limit: usize) -> Enumeration {
    let mut assignments = Vec::new();
    let mut decisions: Vec<Decision> = Vec::new();
    loop {
        if engine.propagate().is_ok() {
            let cursor = decisions.last().map_or(0, |decision| decision.cursor);
            let open = |index: &usize| engine.stroke(plan.wishes[*index].bond).is_none();
            if let Some(next) = (cursor..plan.wishes.len()).find(open) {
                let literal = plan.wishes[next];
                engine.decide(literal);
                decisions.push(Decision {
                    literal,
                    cursor: next + 1,
                    last: false,
                });
                continue;
            }
            if assignments.len() == limit || engine.work() > BUDGET {
                return Enumeration {
                    assignments,
                    complete: false,
                };
            }
            let strokes = (0..plan.wishes.len())
                .map(|bond| engine.stroke(BondId(bond)).unwrap_or(Stroke::To));
            assignments.push(Assignment {
                strokes: strokes.collect(),
            });
        }
        if engine.work() > BUDGET {
            return Enumeration {
                assignments,
                complete: false,
            };
        }
        while decisions.pop_if(|decision| decision.last).is_some() {}
        engine.undo_to(decisions.len().saturating_sub(1));
        let Some(decision) = decisions.last_mut() else {
            return Enumeration {
                assignments,
                complete: true,
            };
        };
        decision.last = true;
        decision.literal = decision.literal.negated();
        engine.decide(decision.literal);
    }
}
