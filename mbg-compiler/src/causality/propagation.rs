//! Propagation of strokes, with the reason of each.
//!
//! Holds a partial assignment that satisfies every constraint it has looked at. Strokes are decided level by level;
//! each decision is followed by all its local consequences (a worklist, no recursion). The trail remembers the order,
//! so that a level is undone by popping and a stroke's causes always stand before it. Local propagation is sound but
//! not complete: what it cannot see is found by the search that drives it.

use super::strokes::{Literal, Problem, Stroke};
use crate::graph::BondId;

/// Why a bond has its stroke.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// It was chosen.
    Decision,
    /// This constraint left no other stroke.
    Constraint(usize),
    /// A search found that these bonds' strokes leave no other.
    Search(Vec<BondId>),
}

/// What cannot hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Clash {
    /// A constraint with no literal left or with two that hold.
    Constraint(usize),
    /// The strokes of these bonds together.
    Strokes(Vec<BondId>),
}

impl Clash {
    /// The constraint that cannot hold.
    #[must_use]
    pub fn constraint(&self) -> Option<usize> {
        match self {
            Self::Constraint(index) => Some(*index),
            Self::Strokes(_) => None,
        }
    }
}

/// A stroke that has been assigned.
#[derive(Clone, Debug)]
struct Assigned {
    stroke: Stroke,
    level: usize,
    position: usize,
    reason: Reason,
}

/// How the literals of a constraint stand.
#[derive(Clone, Copy, Debug)]
struct Count {
    holding: usize,
    open: usize,
}

/// A partial assignment of strokes.
#[derive(Clone, Debug)]
pub struct Propagation<'a> {
    problem: &'a Problem,
    assigned: Vec<Option<Assigned>>,
    counts: Vec<Count>,
    trail: Vec<BondId>,
    /// Length of the trail where each level begins; level 0 has no entry.
    levels: Vec<usize>,
    head: usize,
    work: usize,
}

impl<'a> Propagation<'a> {
    /// No stroke assigned.
    #[must_use]
    pub fn new(problem: &'a Problem) -> Self {
        Self {
            problem,
            assigned: vec![None; problem.occurrences.len()],
            counts: problem
                .constraints
                .iter()
                .map(|constraint| Count {
                    holding: 0,
                    open: constraint.literals.len(),
                })
                .collect(),
            trail: Vec::new(),
            levels: Vec::new(),
            head: 0,
            work: 0,
        }
    }

    /// Assigns what the constraints fix by themselves, one after the other, each with its consequences.
    ///
    /// # Errors
    /// The constraint at which the fixed causalities contradict each other.
    pub fn start(&mut self) -> Result<(), Clash> {
        for constraint in 0..self.problem.constraints.len() {
            self.check(constraint)?;
            self.propagate()?;
        }
        Ok(())
    }

    /// Opens a level with this stroke.
    pub fn decide(&mut self, literal: Literal) {
        self.levels.push(self.trail.len());
        self.assign(literal, Reason::Decision);
    }

    /// Draws all local consequences.
    ///
    /// # Errors
    /// The first constraint that cannot hold any more.
    pub fn propagate(&mut self) -> Result<(), Clash> {
        let problem = self.problem;
        while let Some(&bond) = self.trail.get(self.head) {
            self.head += 1;
            for &(constraint, _) in &problem.occurrences[bond.0] {
                self.check(constraint)?;
            }
        }
        Ok(())
    }

    /// Forces what one constraint forces now.
    fn check(&mut self, constraint: usize) -> Result<(), Clash> {
        let Count { holding, open } = self.counts[constraint];
        if holding > 1 || holding + open == 0 {
            return Err(Clash::Constraint(constraint));
        }
        if open > 0 && (holding == 1 || open == 1) {
            let problem = self.problem;
            for &literal in &problem.constraints[constraint].literals {
                if self.stroke(literal.bond).is_none() {
                    let forced = if holding == 1 {
                        literal.negated()
                    } else {
                        literal
                    };
                    self.assign(forced, Reason::Constraint(constraint));
                }
            }
        }
        Ok(())
    }

    fn assign(&mut self, literal: Literal, reason: Reason) {
        let Literal { bond, stroke } = literal;
        debug_assert!(self.assigned[bond.0].is_none(), "a stroke is assigned once");
        let (level, position) = (self.levels.len(), self.trail.len());
        self.assigned[bond.0] = Some(Assigned {
            stroke,
            level,
            position,
            reason,
        });
        self.trail.push(bond);
        self.work += 1;
        for &(constraint, holds) in &self.problem.occurrences[bond.0] {
            let count = &mut self.counts[constraint];
            count.open -= 1;
            count.holding += usize::from(holds == stroke);
        }
    }

    /// Takes back all levels above this one.
    pub fn undo_to(&mut self, level: usize) {
        let Some(&length) = self.levels.get(level) else {
            return;
        };
        self.levels.truncate(level);
        for bond in self.trail.drain(length..).rev() {
            let Some(assigned) = self.assigned[bond.0].take() else {
                continue;
            };
            for &(constraint, holds) in &self.problem.occurrences[bond.0] {
                let count = &mut self.counts[constraint];
                count.open += 1;
                count.holding -= usize::from(holds == assigned.stroke);
            }
        }
        self.head = length;
    }

    /// The stroke of a bond.
    #[must_use]
    pub fn stroke(&self, bond: BondId) -> Option<Stroke> {
        self.assigned[bond.0]
            .as_ref()
            .map(|assigned| assigned.stroke)
    }

    /// Whether a literal holds.
    #[must_use]
    pub fn holds(&self, literal: Literal) -> Option<bool> {
        self.stroke(literal.bond)
            .map(|stroke| stroke == literal.stroke)
    }

    /// Number of levels above level 0.
    #[must_use]
    pub fn level(&self) -> usize {
        self.levels.len()
    }

    /// Strokes assigned since the beginning, those taken back included.
    #[must_use]
    pub fn work(&self) -> usize {
        self.work
    }

    /// Bonds in the order in which they were assigned.
    #[must_use]
    pub fn trail(&self) -> &[BondId] {
        &self.trail
    }

    /// Why a bond has its stroke.
    #[must_use]
    pub fn reason(&self, bond: BondId) -> Option<&Reason> {
        self.assigned[bond.0]
            .as_ref()
            .map(|assigned| &assigned.reason)
    }

    /// The constraint that forced a bond's stroke.
    #[must_use]
    pub fn constraint_of(&self, bond: BondId) -> Option<usize> {
        match self.reason(bond) {
            Some(Reason::Constraint(index)) => Some(*index),
            _ => None,
        }
    }

    /// The level at which a bond was assigned; 0 for one that is not.
    #[must_use]
    pub fn level_of(&self, bond: BondId) -> usize {
        self.assigned[bond.0]
            .as_ref()
            .map_or(0, |assigned| assigned.level)
    }

    fn position(&self, bond: BondId) -> usize {
        self.assigned[bond.0]
            .as_ref()
            .map_or(usize::MAX, |assigned| assigned.position)
    }

    /// The bonds whose strokes forced this bond's.
    #[must_use]
    pub fn causes(&self, bond: BondId) -> Vec<BondId> {
        match self.reason(bond) {
            None | Some(Reason::Decision) => Vec::new(),
            Some(Reason::Search(bonds)) => bonds.clone(),
            Some(Reason::Constraint(constraint)) => {
                let literals = &self.problem.constraints[*constraint].literals;
                let position = self.position(bond);
                let before = |literal: &&Literal| {
                    literal.bond != bond && self.position(literal.bond) < position
                };
                match literals
                    .iter()
                    .filter(before)
                    .find(|literal| self.holds(**literal) == Some(true))
                {
                    Some(holding) => vec![holding.bond],
                    None => literals
                        .iter()
                        .filter(before)
                        .map(|literal| literal.bond)
                        .collect(),
                }
            }
        }
    }

    /// The bonds whose strokes cannot hold together.
    #[must_use]
    pub fn clashing(&self, clash: &Clash) -> Vec<BondId> {
        match clash {
            Clash::Strokes(bonds) => bonds.clone(),
            Clash::Constraint(constraint) => {
                let literals = &self.problem.constraints[*constraint].literals;
                let mut holding: Vec<BondId> = literals
                    .iter()
                    .filter(|literal| self.holds(**literal) == Some(true))
                    .map(|literal| literal.bond)
                    .collect();
                if holding.is_empty() {
                    return literals.iter().map(|literal| literal.bond).collect();
                }
                holding.sort_by_key(|bond| self.position(*bond));
                holding.truncate(2);
                holding
            }
        }
    }

    /// These bonds and all causes of their strokes, in order of assignment.
    #[must_use]
    pub fn closure(&self, bonds: Vec<BondId>) -> Vec<BondId> {
        let mut seen = vec![false; self.assigned.len()];
        let mut open = bonds;
        let mut closure = Vec::new();
        while let Some(bond) = open.pop() {
            if !std::mem::replace(&mut seen[bond.0], true) {
                closure.push(bond);
                open.extend(self.causes(bond));
            }
        }
        closure.sort_by_key(|bond| self.position(*bond));
        closure
    }

    /// Learns from a clash: undoes the levels that do not matter and turns over the one stroke of the last level that
    /// does, with the others as its reason (first unique implication point; Marques-Silva & Sakallah 1999).
    ///
    /// # Errors
    /// The clash depends on no decision.
    pub fn turn(&mut self, clash: &Clash) -> Result<(), Clash> {
        let bonds = self.clashing(clash);
        let level = bonds
            .iter()
            .map(|bond| self.level_of(*bond))
            .max()
            .unwrap_or(0);
        if level == 0 {
            return Err(clash.clone());
        }
        self.undo_to(level);
        let (last, others) = self.implication_point(bonds, level);
        let Some(stroke) = self.stroke(last) else {
            return Err(clash.clone());
        };
        let target = others
            .iter()
            .map(|bond| self.level_of(*bond))
            .max()
            .unwrap_or(0);
        self.undo_to(target);
        self.assign(
            Literal {
                bond: last,
                stroke: stroke.opposite(),
            },
            Reason::Search(others),
        );
        Ok(())
    }

    /// Replaces strokes of this level by their causes until one is left.
    fn implication_point(&self, bonds: Vec<BondId>, level: usize) -> (BondId, Vec<BondId>) {
        let mut seen = std::collections::BTreeSet::new();
        let mut here = std::collections::BTreeSet::new();
        let mut others = Vec::new();
        let mut open = bonds;
        loop {
            for bond in open.drain(..) {
                if seen.insert(bond) {
                    match self.level_of(bond) {
                        0 => {}
                        at if at == level => _ = here.insert((self.position(bond), bond)),
                        _ => others.push(bond),
                    }
                }
            }
            match here.pop_last() {
                Some((_, bond)) if here.is_empty() => return (bond, others),
                Some((_, bond)) => open = self.causes(bond),
                // Unreachable: `level` is the level of one of the bonds.
                None => return (BondId(0), others),
            }
        }
    }
}
