//! The search for the assignment with the fewest storages in derivative causality.
//!
//! Input: a [`Problem`] and the [`Plan`] of SCAP. Decisions follow the plan and its wishes; a clash is analysed, the
//! search jumps back to the decisions that caused it and turns over the last one. As the order and the first choices
//! never change, the first assignment found is the one that SCAP prefers among those that satisfy the bound, and so
//! the last one found is SCAP's choice among the optimal ones.
//!
//! The bound is a set of disjoint *cores*: groups of storages of which local propagation shows that they cannot all
//! be integral. Every assignment has at least one dependent storage per core. Where SCAP's descent meets that number,
//! as it does on most graphs, there is nothing to search.

use super::propagation::{Clash, Propagation};
use super::strokes::{Plan, Problem, Stroke};
use crate::graph::BondId;

/// The search gives up after this many assignments of a stroke, those taken back included: about a second without
/// the optimiser. The first descent, one per bond, is not counted.
pub const BUDGET: usize = 250_000;

/// How many storages are dependent: all of them, then those without `#[derivative]`. Compared in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cost {
    /// All dependent storages.
    pub total: usize,
    /// Those that are not marked `derivative`.
    pub unmarked: usize,
}

/// An assignment of all strokes.
#[derive(Clone, Debug)]
pub struct Best {
    /// One stroke per bond.
    pub strokes: Vec<Stroke>,
    /// Its dependent storages.
    pub cost: Cost,
    /// Whether no assignment costs less.
    pub proven: bool,
}

/// What a search found.
#[derive(Clone, Debug)]
pub enum Found {
    /// An assignment.
    Best(Best),
    /// There is none.
    Nothing,
    /// The budget ended before the first one.
    Exhausted,
}

/// What to look for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Any assignment.
    First,
    /// The fewest dependent storages.
    Fewest,
}

/// Searches.
#[must_use]
pub fn search(problem: &Problem, plan: &Plan, goal: Goal, budget: usize) -> Found {
    let mut engine = Propagation::new(problem);
    if engine.start().is_err() {
        return Found::Nothing;
    }
    let bound = match goal {
        Goal::First => Bound::none(plan),
        Goal::Fewest => Bound::new(&engine, plan),
    };
    Search {
        engine,
        plan,
        bound,
        cursors: vec![0],
    }
    .run(goal, budget)
}

struct Search<'a> {
    engine: Propagation<'a>,
    plan: &'a Plan,
    bound: Bound,
    /// For each level, the wishes before this one are assigned.
    cursors: Vec<usize>,
}

impl Search<'_> {
    fn run(mut self, goal: Goal, budget: usize) -> Found {
        let mut best: Option<Best> = None;
        loop {
            let clash = match self.step(&mut best) {
                Ok(Progress::Decided) => None,
                Ok(Progress::Complete) if goal == Goal::First => break,
                Ok(Progress::Complete) => {
                    let cost = best.as_ref().map(|best| best.cost).unwrap_or_default();
                    Some(Clash::Strokes(self.bound.blame(
                        &self.engine,
                        self.plan,
                        cost,
                    )))
                }
                Err(clash) => Some(clash),
            };
            if let Some(clash) = clash
                && self.engine.turn(&clash).is_err()
            {
                best = best.map(|best| Best {
                    proven: true,
                    ..best
                });
                return best.map_or(Found::Nothing, Found::Best);
            }
            if self.engine.work() > budget + self.plan.wishes.len() {
                break;
            }
        }
        best.map_or(Found::Exhausted, Found::Best)
    }

    /// Propagates and decides once.
    fn step(&mut self, best: &mut Option<Best>) -> Result<Progress, Clash> {
        self.engine.propagate()?;
        self.cursors.truncate(self.engine.level() + 1);
        let mut cursor = self.cursors.last().copied().unwrap_or(0);
        if let Some(best) = best
            && cursor <= self.plan.storages.len()
            && self.bound.least(&self.engine, self.plan) >= best.cost
        {
            return Err(Clash::Strokes(self.bound.blame(
                &self.engine,
                self.plan,
                best.cost,
            )));
        }
        let wishes = &self.plan.wishes;
        while let Some(wish) = wishes.get(cursor)
            && self.engine.stroke(wish.bond).is_some()
        {
            cursor += 1;
        }
        if let Some(level) = self.cursors.last_mut() {
            *level = cursor;
        }
        let Some(wish) = wishes.get(cursor) else {
            let complete = self.complete();
            if best.as_ref().is_none_or(|best| complete.cost < best.cost) {
                *best = Some(complete);
            }
            return Ok(Progress::Complete);
        };
        self.engine.decide(*wish);
        self.cursors.push(cursor + 1);
        Ok(Progress::Decided)
    }

    fn complete(&self) -> Best {
        let bonds = 0..self.plan.wishes.len();
        let strokes = bonds
            .map(|bond| self.engine.stroke(BondId(bond)).unwrap_or(Stroke::To))
            .collect();
        Best {
            strokes,
            cost: self.bound.least(&self.engine, self.plan),
            proven: false,
        }
    }
}

enum Progress {
    Decided,
    Complete,
}

/// Disjoint groups of storages that cannot all be integral.
struct Bound {
    /// For each storage of the plan, its core.
    core_of: Vec<Option<usize>>,
    /// For each core, whether none of its members is marked.
    unmarked: Vec<bool>,
}

impl Bound {
    fn none(plan: &Plan) -> Self {
        Self {
            core_of: vec![None; plan.storages.len()],
            unmarked: Vec::new(),
        }
    }

    /// Assumes all storages integral in the order of the plan; where that clashes, the assumptions involved are a
    /// core and are dropped.
    fn new(start: &Propagation<'_>, plan: &Plan) -> Self {
        let mut bound = Self::none(plan);
        let mut engine = start.clone();
        let mut assumed: Vec<usize> = Vec::new();
        let mut next = 0;
        while let Some(storage) = plan.storages.get(next) {
            let blamed = match engine.holds(storage.integral) {
                _ if bound.core_of[next].is_some() => None,
                Some(true) => None,
                Some(false) => Some(vec![storage.integral.bond]),
                None => {
                    assumed.push(next);
                    engine.decide(storage.integral);
                    engine
                        .propagate()
                        .err()
                        .map(|clash| engine.clashing(&clash))
                }
            };
            let Some(blamed) = blamed else {
                next += 1;
                continue;
            };
            let mut members: Vec<usize> = involved(&engine, &assumed, blamed);
            let keep = members.first().map_or(assumed.len(), |level| *level);
            members
                .iter_mut()
                .for_each(|level| *level = assumed[*level]);
            if assumed.last() != Some(&next) {
                members.push(next);
            }
            bound.add(plan, &members);
            engine.undo_to(keep);
            assumed.truncate(keep);
            next = assumed.last().map_or(0, |last| last + 1);
        }
        bound
    }

    fn add(&mut self, plan: &Plan, members: &[usize]) {
        for &member in members {
            self.core_of[member] = Some(self.unmarked.len());
        }
        self.unmarked
            .push(members.iter().all(|member| !plan.storages[*member].marked));
    }

    /// The least cost of any assignment that extends this one.
    fn least(&self, engine: &Propagation<'_>, plan: &Plan) -> Cost {
        let (members, counts) = self.dependent(engine, plan);
        let mut cost = Cost {
            total: members.len() + counts.iter().filter(|count| **count == 0).count(),
            unmarked: members
                .iter()
                .filter(|storage| !plan.storages[**storage].marked)
                .count(),
        };
        cost.unmarked += counts
            .iter()
            .zip(&self.unmarked)
            .filter(|(count, unmarked)| **count == 0 && **unmarked)
            .count();
        cost
    }

    /// Storages that are derivative, and how many of them each core has.
    fn dependent(&self, engine: &Propagation<'_>, plan: &Plan) -> (Vec<usize>, Vec<usize>) {
        let mut counts = vec![0; self.unmarked.len()];
        let derivative =
            |index: &usize| engine.holds(plan.storages[*index].integral) == Some(false);
        let members: Vec<usize> = (0..plan.storages.len()).filter(derivative).collect();
        for member in &members {
            if let Some(core) = self.core_of[*member] {
                counts[core] += 1;
            }
        }
        (members, counts)
    }

    /// The strokes that keep every extension from costing less than this. The only dependent storage of a core is
    /// not to blame: some storage of that core is dependent anyway.
    fn blame(&self, engine: &Propagation<'_>, plan: &Plan, cost: Cost) -> Vec<BondId> {
        let (members, counts) = self.dependent(engine, plan);
        let enough = self.least(engine, plan).total > cost.total;
        let blamed = |index: &usize| {
            let storage = &plan.storages[*index];
            self.core_of[*index].is_none_or(|core| {
                counts[core] > 1 || (!enough && !storage.marked && !self.unmarked[core])
            })
        };
        members
            .into_iter()
            .filter(blamed)
            .map(|member| plan.storages[member].integral.bond)
            .collect()
    }
}

/// The levels of the assumptions from which these strokes follow, in ascending order.
fn involved(engine: &Propagation<'_>, assumed: &[usize], bonds: Vec<BondId>) -> Vec<usize> {
    let mut hit = vec![false; assumed.len()];
    for bond in engine.closure(bonds) {
        if engine.reason(bond) == Some(&super::propagation::Reason::Decision)
            && let Some(level) = hit.get_mut(engine.level_of(bond).wrapping_sub(1))
        {
            *level = true;
        }
    }
    (0..hit.len()).filter(|level| hit[*level]).collect()
}
