//! One stroke per multibond: the verdict on the drawing.
//!
//! Input: a [`BondGraph`]. Output: a [`Verdict`], the uniform assignment with the fewest storages in derivative
//! causality, or a [`Conflict`] when no assignment satisfies the rules. Greedy assignment is not optimal for uniform
//! vectors (the exchange argument needs scalar bonds), hence the search. Nothing is reported here; see
//! [`report`](super::report).

use std::ops::Range;

use super::conflict::{self, Conflict};
use super::propagation::{Propagation, Reason};
use super::search::{self, Found, Goal};
use super::strokes::{Literal, Plan, Problem, Site, Stroke};
use crate::graph::{BondGraph, BondId, ElementId, JunctionId};

/// Why a bond has its stroke.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The element allows no other.
    Fixed(ElementId),
    /// The storage was given its integral causality.
    Integral(ElementId),
    /// The storage is supposed to be integral, to see what follows; never in a verdict.
    Supposed(ElementId),
    /// The storage was put into derivative causality by choice: the search found that integral causality is either
    /// impossible or costs other storages theirs.
    Yielded(ElementId),
    /// Free, and assigned as the order of SCAP prefers.
    Free,
    /// These components of a junction left no other.
    Junction(JunctionId, Range<usize>),
    /// The transformer or gyrator left no other.
    TwoPort(ElementId),
}

/// One assignment of a stroke.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// Which bond.
    pub bond: BondId,
    /// Where effort enters.
    pub stroke: Stroke,
    /// Why.
    pub cause: Cause,
    /// The bonds whose strokes forced this one.
    pub because: Vec<BondId>,
}

/// The best uniform assignment.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// One stroke per bond.
    pub strokes: Vec<Stroke>,
    /// Storages in derivative causality, in order of declaration. Their number is minimal; among equal numbers, as
    /// few as possible are without `#[derivative]`; among those, SCAP's order decides: what is declared earlier
    /// stays integral, and marked storages come last.
    pub dependent: Vec<ElementId>,
    /// Whether the number is proven minimal; `false` only when the search ran out of its
    /// [budget](super::search::BUDGET).
    pub proven_optimal: bool,
    /// How the assignment follows, in the order of SCAP, each stroke after those that forced it.
    pub record: Vec<Step>,
}

impl Verdict {
    /// Whether effort enters the end at [`Bond::to`](crate::graph::Bond::to).
    #[must_use]
    pub fn stroke_at_to(&self, bond: BondId) -> bool {
        self.strokes[bond.0] == Stroke::To
    }
}

/// Finds the uniform assignment with the fewest dependent storages.
///
/// # Errors
/// No assignment satisfies the rules, or none was found within the budget.
pub fn verdict(graph: &BondGraph) -> Result<Verdict, Conflict> {
    let problem = Problem::new(graph);
    let plan = Plan::new(graph);
    match search::search(&problem, &plan, Goal::Fewest, search::BUDGET) {
        Found::Best(best) => Ok(Verdict {
            dependent: dependent(&plan, &best.strokes),
            proven_optimal: best.proven,
            record: replay(&problem, &plan, &best.strokes),
            strokes: best.strokes,
        }),
        Found::Nothing => Err(conflict::explain(graph, &problem, &plan)),
        Found::Exhausted => Err(Conflict::unproven()),
    }
}

/// Storages in derivative causality, in order of declaration.
#[must_use]
pub fn dependent(plan: &Plan, strokes: &[Stroke]) -> Vec<ElementId> {
    let derivative = |integral: Literal| strokes[integral.bond.0] != integral.stroke;
    let storages = plan
        .storages
        .iter()
        .filter(|storage| derivative(storage.integral));
    let mut dependent: Vec<ElementId> = storages.map(|storage| storage.element).collect();
    dependent.sort_unstable();
    dependent
}

/// The assignment again, in the order of SCAP, with local propagation alone: every stroke that can be forced is.
fn replay(problem: &Problem, plan: &Plan, strokes: &[Stroke]) -> Vec<Step> {
    let mut engine = Propagation::new(problem);
    let consistent = "an assignment that satisfies every constraint is propagated without a clash";
    let mut sound = engine.start().is_ok();
    for wish in &plan.wishes {
        if engine.stroke(wish.bond).is_none() {
            engine.decide(Literal {
                bond: wish.bond,
                stroke: strokes[wish.bond.0],
            });
            sound &= engine.propagate().is_ok();
        }
    }
    debug_assert!(sound, "{consistent}");
    let mut decided = vec![None; strokes.len()];
    for storage in &plan.storages {
        let integral = strokes[storage.integral.bond.0] == storage.integral.stroke;
        let cause = if integral {
            Cause::Integral
        } else {
            Cause::Yielded
        };
        decided[storage.integral.bond.0] = Some(cause(storage.element));
    }
    let step = |bond: &BondId| Step {
        bond: *bond,
        stroke: strokes[bond.0],
        cause: match engine.reason(*bond) {
            Some(Reason::Constraint(index)) => cause_of(&problem.constraints[*index].site),
            _ => decided[bond.0].clone().unwrap_or(Cause::Free),
        },
        because: engine.causes(*bond),
    };
    engine.trail().iter().map(step).collect()
}

/// The cause that a constraint stands for.
#[must_use]
pub fn cause_of(site: &Site) -> Cause {
    match site {
        Site::Fixed(element) => Cause::Fixed(*element),
        Site::Junction(junction, components) => Cause::Junction(*junction, components.clone()),
        Site::TwoPort(element) => Cause::TwoPort(*element),
        Site::Assumed(element) => Cause::Integral(*element),
        Site::Supposed(element) => Cause::Supposed(*element),
    }
}
