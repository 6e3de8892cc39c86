//! Why no assignment exists, and whose fault it is.
//!
//! Input: a [`Problem`] without solution. Output: a [`Conflict`] with a minimal set of rules that contradict each
//! other: none of them can be left out. Where propagation of the fixed causalities finds the contradiction, the rules
//! on the way to it are the start; where only the search finds it, the classes of fixed ports are added one after the
//! other (sources, gyroscopic multiports, two-ports without inverse, resistors) until they suffice.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use super::propagation::{Clash, Propagation};
use super::search::{self, Found, Goal};
use super::strokes::{Plan, Problem, Site};
use super::uniform::{Step, cause_of};
use super::words::{self, ChainStep};
use crate::codes;
use crate::diagnostics::Code;
use crate::graph::{BondGraph, BondId, ElementId, End, Rule};

/// Searches while a set of rules is made smaller; then it is left as it is.
const TRIALS: usize = 400;

/// Assignments of a stroke in one of these searches.
const TRIAL_BUDGET: usize = 50_000;

/// Rules that contradict each other.
#[derive(Clone, Debug)]
pub struct Conflict {
    /// What kind of contradiction.
    pub code: Code,
    /// A minimal set of rules in conflict: fixed elements first, the one to blame foremost, then junctions, the one
    /// that fails foremost, then two-ports.
    pub sites: Vec<Site>,
    /// A minimal set of bonds in conflict, in order of declaration.
    pub bonds: Vec<BondId>,
    /// From the first fixed causality to the contradiction.
    pub chain: Vec<ChainStep>,
}

impl Conflict {
    /// The search ended without an answer.
    #[must_use]
    pub fn unproven() -> Self {
        Self {
            code: codes::NO_ASSIGNMENT,
            sites: Vec::new(),
            bonds: Vec::new(),
            chain: Vec::new(),
        }
    }

    /// Fixed elements without which there would be no contradiction; the one to blame foremost.
    #[must_use]
    pub fn elements(&self) -> Vec<ElementId> {
        fixed_elements(&self.sites)
    }

    /// The components of a junction at which the rules fail.
    #[must_use]
    pub fn place(&self) -> Option<End> {
        self.sites.iter().find_map(|site| match site {
            Site::Junction(id, components) => Some(End::Junction(*id, components.clone())),
            _ => None,
        })
    }

    /// Whether the contradiction is certain; `false` only when the search ran out of its budget.
    #[must_use]
    pub fn proven(&self) -> bool {
        !self.chain.is_empty()
    }
}

/// Explains why a problem has no solution.
#[must_use]
pub fn explain(graph: &BondGraph, problem: &Problem, plan: &Plan) -> Conflict {
    let core = core(graph, problem, plan);
    let part = problem.restricted(&core);
    let (chain, failing) = chain(graph, &part);
    let mut sites: Vec<(Reverse<usize>, Site)> = Vec::new();
    let mut bonds = BTreeSet::new();
    for (index, constraint) in part.constraints.iter().enumerate() {
        let rank = match &constraint.site {
            Site::Fixed(id) => 3 + class(graph.elements[id.0].rule),
            Site::Junction(..) if failing == Some(index) => 2,
            Site::Junction(..) => 1,
            Site::TwoPort(_) | Site::Assumed(_) | Site::Supposed(_) => 0,
        };
        sites.push((Reverse(rank), constraint.site.clone()));
        bonds.extend(constraint.literals.iter().map(|literal| literal.bond));
    }
    sites.sort_by_key(|(rank, _)| *rank);
    let sites: Vec<Site> = sites.into_iter().map(|(_, site)| site).collect();
    let code = code(graph, &fixed_elements(&sites));
    Conflict {
        code,
        sites,
        bonds: bonds.into_iter().collect(),
        chain,
    }
}

/// Each fixed element once, in the order given.
fn fixed_elements(sites: &[Site]) -> Vec<ElementId> {
    let mut elements = Vec::new();
    for site in sites {
        if let Site::Fixed(id) = site
            && !elements.contains(id)
        {
            elements.push(*id);
        }
    }
    elements
}

/// The order in which classes of fixed ports are assigned; the last one in a contradiction is to blame.
fn class(rule: Rule) -> usize {
    match rule {
        Rule::EffortOut | Rule::FlowOut => 0,
        Rule::Gyroscopic => 1,
        Rule::Transformer { .. } | Rule::Gyrator { .. } => 2,
        _ => 3,
    }
}

fn code(graph: &BondGraph, elements: &[ElementId]) -> Code {
    match elements.first().map(|id| class(graph.elements[id.0].rule)) {
        Some(3) => codes::FIXED_RESISTOR,
        Some(2) => codes::RECTANGULAR_INVERSE,
        Some(1) => codes::GYROSCOPIC_INVERSE,
        Some(_) if elements.len() > 1 => codes::SOURCES_CONFLICT,
        _ => codes::NO_ASSIGNMENT,
    }
}

/// A minimal set of constraints without solution, in ascending order.
#[must_use]
pub fn core(graph: &BondGraph, problem: &Problem, plan: &Plan) -> Vec<usize> {
    let mut engine = Propagation::new(problem);
    let start = match engine.start() {
        Err(clash) => {
            let closure = engine.closure(engine.clashing(&clash));
            let mut start: Vec<usize> = closure
                .iter()
                .filter_map(|bond| engine.constraint_of(*bond))
                .collect();
            start.extend(clash.constraint());
            start.sort_unstable();
            start.dedup();
            start
        }
        Ok(()) => (0..4)
            .map(|last| with_classes_up_to(graph, problem, last))
            .find(|part| unsolvable(problem, plan, part))
            .unwrap_or_else(|| (0..problem.constraints.len()).collect()),
    };
    minimal(problem, plan, start)
}

fn with_classes_up_to(graph: &BondGraph, problem: &Problem, last: usize) -> Vec<usize> {
    let admitted = |index: &usize| match &problem.constraints[*index].site {
        Site::Fixed(id) => class(graph.elements[id.0].rule) <= last,
        _ => true,
    };
    (0..problem.constraints.len()).filter(admitted).collect()
}

/// Leaves out ever smaller groups of constraints as long as the rest has no solution.
fn minimal(problem: &Problem, plan: &Plan, start: Vec<usize>) -> Vec<usize> {
    let mut kept = start;
    let mut group = kept.len().div_ceil(2).max(1);
    let mut trials = 0;
    loop {
        // From the end, so that storages and junctions go before sources.
        let mut end = kept.len();
        while end > 0 && trials < TRIALS {
            let begin = end.saturating_sub(group);
            let rest: Vec<usize> = [&kept[..begin], &kept[end..]].concat();
            trials += 1;
            if unsolvable(problem, plan, &rest) {
                kept = rest;
            }
            end = begin;
        }
        if group == 1 || trials >= TRIALS {
            return kept;
        }
        group = group.div_ceil(2);
    }
}

fn unsolvable(problem: &Problem, plan: &Plan, constraints: &[usize]) -> bool {
    let part = problem.restricted(constraints);
    matches!(
        search::search(&part, plan, Goal::First, TRIAL_BUDGET),
        Found::Nothing
    )
}

/// The contradiction as sentences, and the constraint that fails in the end. If propagation does not see it, the
/// rules themselves are listed.
#[must_use]
pub fn chain(graph: &BondGraph, part: &Problem) -> (Vec<ChainStep>, Option<usize>) {
    let mut engine = Propagation::new(part);
    let clash = match engine.start() {
        Err(clash @ Clash::Constraint(_)) => clash,
        _ => {
            let rules = part.constraints.iter();
            return (
                rules
                    .map(|constraint| words::rule(graph, constraint))
                    .collect(),
                None,
            );
        }
    };
    let mut steps = Vec::new();
    for bond in engine.closure(engine.clashing(&clash)) {
        if let (Some(constraint), Some(stroke)) = (engine.constraint_of(bond), engine.stroke(bond))
        {
            let cause = cause_of(&part.constraints[constraint].site);
            let because = engine.causes(bond);
            steps.push(words::step(
                graph,
                &Step {
                    bond,
                    stroke,
                    cause,
                    because,
                },
            ));
        }
    }
    let failing = clash.constraint();
    steps.extend(failing.map(|index| words::clash(graph, &engine, &part.constraints[index])));
    (steps, failing)
}
