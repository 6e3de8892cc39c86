//! Why a storage is in derivative causality.
//!
//! Input: the [`Verdict`], whose record replays SCAP. Output: a [`Chain`] that keeps only the steps from which the
//! stroke at the storage follows, in order: fixed causalities and integral storages first, then junctions and
//! two-ports, the storage last. A junction that lost its last free bond needs all its other strokes; elsewhere one
//! stroke suffices, so no step of the chain can be left out of it. Where the stroke follows from no chain but from a
//! search, the steps are the rules that contradict integral causality, or there are none and integral causality would
//! cost other storages theirs.

use std::collections::{BTreeMap, BTreeSet};

use super::conflict;
use super::search::{self, BUDGET, Best, Found, Goal};
use super::strokes::{Plan, Problem, Site};
use super::uniform::{self, Cause, Step, Verdict};
use super::words::{self, ChainStep};
use crate::graph::{BondGraph, BondId, ElementId, End, JunctionKind, Rule};

/// At most so many alternatives are asked for.
const ALTERNATIVES: usize = 8;

/// Why one storage is in derivative causality.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The storage.
    pub storage: ElementId,
    /// From the causalities that began it to the storage.
    pub steps: Vec<ChainStep>,
    /// `I <- 1 <- MTF <- 0 <- 1 <- I`: from the storage back to what imposes its variable. Empty when the stroke
    /// follows from a search.
    pub path: String,
    /// Sources and other fixed elements in the chain, in order of declaration.
    pub fixed: Vec<ElementId>,
    /// Storages in integral causality in the chain, in order of declaration.
    pub integral: Vec<ElementId>,
    /// Storages that would be dependent if this one were not, when nothing but their number speaks against it.
    pub spared: Vec<ElementId>,
}

/// Explains a dependent storage; `None` for an element that is not one.
#[must_use]
pub fn explain(graph: &BondGraph, verdict: &Verdict, storage: ElementId) -> Option<Chain> {
    if !verdict.dependent.contains(&storage) {
        return None;
    }
    let plan = Plan::new(graph);
    let integral = plan
        .storages
        .iter()
        .find(|candidate| candidate.element == storage)?
        .integral;
    let last = verdict
        .record
        .iter()
        .find(|step| step.bond == integral.bond)?;
    Some(match last.cause {
        Cause::Yielded(_) => by_search(graph, verdict, &plan, storage),
        _ => by_propagation(graph, verdict, storage, integral.bond),
    })
}

/// The steps of the record from which a bond's stroke follows, in its order.
fn needed(verdict: &Verdict, bond: BondId) -> Vec<&Step> {
    let by_bond: BTreeMap<BondId, &Step> = verdict
        .record
        .iter()
        .map(|step| (step.bond, step))
        .collect();
    let mut seen = BTreeSet::new();
    let mut open = vec![bond];
    while let Some(bond) = open.pop() {
        if seen.insert(bond)
            && let Some(step) = by_bond.get(&bond)
        {
            open.extend(&step.because);
        }
    }
    verdict
        .record
        .iter()
        .filter(|step| seen.contains(&step.bond))
        .collect()
}

fn by_propagation(graph: &BondGraph, verdict: &Verdict, storage: ElementId, bond: BondId) -> Chain {
    let needed = needed(verdict, bond);
    let mut fixed = BTreeSet::new();
    let mut integral = BTreeSet::new();
    for step in &needed {
        match step.cause {
            Cause::Fixed(id) => _ = fixed.insert(id),
            Cause::Integral(id) => _ = integral.insert(id),
            _ => {}
        }
    }
    Chain {
        storage,
        steps: needed.iter().map(|step| words::step(graph, step)).collect(),
        path: path(graph, storage, bond, &needed),
        fixed: fixed.into_iter().collect(),
        integral: integral.into_iter().collect(),
        spared: Vec::new(),
    }
}

/// Follows the causes back from the storage: towards an integral storage where there is one, and else as far as the
/// chain goes.
fn path(graph: &BondGraph, storage: ElementId, bond: BondId, needed: &[&Step]) -> String {
    let by_bond: BTreeMap<BondId, &Step> = needed.iter().map(|step| (step.bond, *step)).collect();
    // Whether a stroke follows from a storage, and how many steps stand behind it.
    let mut reach: BTreeMap<BondId, (bool, usize)> = BTreeMap::new();
    for step in needed {
        let behind = step.because.iter().filter_map(|bond| reach.get(bond)).max();
        let (from_storage, length) = behind.copied().unwrap_or_default();
        let own = matches!(step.cause, Cause::Integral(_));
        reach.insert(step.bond, (from_storage || own, length + 1));
    }
    let element = |id: ElementId| words::symbol(graph.elements[id.0].kind);
    let mut stops = vec![element(storage)];
    let (mut bond, mut last) = (Some(bond), storage);
    while let Some(step) = bond.and_then(|bond| by_bond.get(&bond)) {
        match &step.cause {
            Cause::Junction(id, _) => stops.push(match graph.junctions[id.0].kind {
                JunctionKind::Zero => "0",
                JunctionKind::One => "1",
            }),
            Cause::Fixed(id)
            | Cause::Integral(id)
            | Cause::Supposed(id)
            | Cause::Yielded(id)
            | Cause::TwoPort(id) => {
                // What a transformer passes on may be what it demands itself.
                if std::mem::replace(&mut last, *id) != *id {
                    stops.push(element(*id));
                }
            }
            Cause::Free => {}
        }
        bond = step
            .because
            .iter()
            .max_by_key(|bond| reach.get(bond))
            .copied();
    }
    stops.join(" <- ")
}

/// Integral causality of this storage beside what the verdict decided before it: the rules that exclude it, or what
/// it costs.
fn by_search(graph: &BondGraph, verdict: &Verdict, plan: &Plan, storage: ElementId) -> Chain {
    let mut problem = Problem::new(graph);
    for candidate in &plan.storages {
        let integral = candidate.integral;
        if candidate.element == storage {
            problem.add(vec![integral], Site::Supposed(storage));
            break;
        }
        if verdict.strokes[integral.bond.0] == integral.stroke {
            problem.add(vec![integral], Site::Assumed(candidate.element));
        }
    }
    let none = Chain {
        storage,
        steps: vec![],
        path: String::new(),
        fixed: vec![],
        integral: vec![],
        spared: vec![],
    };
    match search::search(&problem, plan, Goal::Fewest, BUDGET) {
        Found::Best(best) => Chain {
            spared: newly(plan, verdict, &best),
            ..none
        },
        Found::Exhausted => none,
        Found::Nothing => {
            let part = problem.restricted(&conflict::core(graph, &problem, plan));
            let mut chain = Chain {
                steps: conflict::chain(graph, &part).0,
                ..none
            };
            for constraint in &part.constraints {
                match constraint.site {
                    Site::Fixed(id) => chain.fixed.push(id),
                    Site::Assumed(id) => chain.integral.push(id),
                    _ => {}
                }
            }
            chain.fixed.sort_unstable();
            chain.fixed.dedup();
            chain
        }
    }
}

/// Storages that are dependent in one assignment and not in the verdict.
fn newly(plan: &Plan, verdict: &Verdict, best: &Best) -> Vec<ElementId> {
    let dependent = uniform::dependent(plan, &best.strokes);
    dependent
        .into_iter()
        .filter(|id| !verdict.dependent.contains(id))
        .collect()
}

/// Storages that could be dependent in the place of this one, at the same number: the search is asked for an
/// assignment in which the one is integral and the other is not. Of the candidates, the integral storages of the
/// chain, the first eight are asked for.
#[must_use]
pub fn alternatives(graph: &BondGraph, verdict: &Verdict, chain: &Chain) -> Vec<ElementId> {
    let plan = Plan::new(graph);
    let integral = |id: ElementId| {
        plan.storages
            .iter()
            .find(|storage| storage.element == id)
            .map(|s| s.integral)
    };
    let Some(own) = integral(chain.storage) else {
        return Vec::new();
    };
    let would_do = |other: &ElementId| {
        let Some(literal) = integral(*other) else {
            return false;
        };
        let mut problem = Problem::new(graph);
        problem.add(vec![own], Site::Assumed(chain.storage));
        problem.add(vec![literal.negated()], Site::Assumed(*other));
        match search::search(&problem, &plan, Goal::Fewest, BUDGET / ALTERNATIVES) {
            Found::Best(best) => best.cost.total <= verdict.dependent.len(),
            Found::Nothing | Found::Exhausted => false,
        }
    };
    let candidates = chain
        .integral
        .iter()
        .chain(&chain.spared)
        .take(ALTERNATIVES);
    candidates.copied().filter(would_do).collect()
}

/// Whether the chain holds a source that blocks some axes of a joint in space, or a transformer that spans some.
#[must_use]
pub fn blocks_axes(graph: &BondGraph, fixed: &[ElementId]) -> bool {
    let blocks = |id: &ElementId| {
        let element = &graph.elements[id.0];
        match element.rule {
            Rule::FlowOut => graph
                .bonds
                .iter()
                .any(|bond| bond.from == End::OnePort(*id) && is_part_of_three(graph, &bond.to)),
            Rule::Transformer { rows, columns, .. } => rows == 3 && columns < 3,
            _ => false,
        }
    };
    fixed.iter().any(blocks)
}

fn is_part_of_three(graph: &BondGraph, end: &End) -> bool {
    matches!(end, End::Junction(id, range) if graph.junctions[id.0].dimension == 3 && range.len() < 3)
}
