//! The order in which a reduced system is eliminated: from the leaves of its tree to the base.
//!
//! Every rate depends on some independent rates: those of coordinates and of the storages that are states. It belongs
//! to the deepest of them, the one that moves nothing but in company; an effort belongs where the flow of its wire does, and
//! an equation where the unknown that it is about does. Eliminating what belongs to one independent rate after
//! another, deepest first, is what recursive algorithms for multibody systems do (Featherstone 1983), and costs as
//! much for each body however long the chain.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use super::blocks;
use crate::bits::Bits;
use crate::equations::{Owner, Scalars, Turn};

/// The turn of every unknown; none for those that belong to the base. And the most independent rates from which one rate
/// follows. `moved` are the co-energy variables of the lost states.
#[must_use]
pub(super) fn assign(
    scalars: &Scalars,
    matched: &BTreeMap<usize, usize>,
    rate_of: &BTreeMap<usize, usize>,
    moved: &[usize],
    is_state: &dyn Fn(Owner) -> bool,
) -> (Vec<Option<Turn>>, usize) {
    let dependence = Dependence::of(scalars, matched, rate_of, moved, is_state);
    let mut turns = vec![None; scalars.unknowns];
    for (unknown, rate) in rate_of {
        turns[*rate] = dependence.turn(*unknown);
    }
    let multipliers: BTreeSet<usize> = scalars
        .closures
        .iter()
        .flat_map(|closure| closure.multipliers.iter().copied())
        .collect();
    // The components of a vector stay together, so that no more of a frame is left than it has.
    for wire in &scalars.wires {
        for side in [0, 1] {
            let rates = wire.iter().filter_map(|pair| rate_of.get(&pair[side]));
            let mut common = None;
            for rate in rates.clone() {
                join_turns(&mut common, turns[*rate]);
            }
            for rate in rates {
                join_turns(&mut turns[*rate], common);
            }
            for pair in wire
                .iter()
                .filter(|pair| !rate_of.contains_key(&pair[1 - side]))
                .filter(|pair| !multipliers.contains(&pair[0]))
            {
                join_turns(&mut turns[pair[1 - side]], common);
            }
        }
    }
    (turns, dependence.deepest())
}

/// The lower level and the greater depth of both.
fn join_turns(place: &mut Option<Turn>, other: Option<Turn>) {
    *place = match (*place, other) {
        (Some(a), Some(b)) => Some(Turn {
            level: a.level.min(b.level),
            depth: a.depth.max(b.depth),
        }),
        (a, b) => a.or(b),
    };
}

/// The sets of unknowns, where a frame in space follows from a rate as a whole: of a trunk that flies, the velocity carries a
/// hinge, though no spin about the hinge's axis follows from it. In a plane, nothing tells a frame from another vector.
fn wholes(scalars: &Scalars, place: &BTreeMap<usize, usize>, sets: &[(Bits, usize)]) -> Vec<Bits> {
    let mut wholes: Vec<Bits> = sets.iter().map(|(set, _)| set.clone()).collect();
    for frame in scalars.common.iter().filter(|flows| flows.len() == 6) {
        let places = || frame.iter().filter_map(|unknown| place.get(unknown));
        let mut whole = Bits::default();
        places().for_each(|place| whole.join(&sets[*place].0));
        places().for_each(|place| wholes[*place].join(&whole));
    }
    wholes
}

/// For each independent rate, those that the storage follows from that it moves with the fewest others: all are nearer to the
/// base.
fn company<'a>(
    storages: impl Iterator<Item = &'a Bits>,
    independent: usize,
) -> Vec<BTreeSet<usize>> {
    let mut company: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); independent];
    for storage in storages {
        let together: BTreeSet<usize> = storage.iter().collect();
        for k in &together {
            let fewest = &mut company[*k];
            if fewest.is_empty() || together.len() < fewest.len() {
                fewest.clone_from(&together);
            }
        }
    }
    company
}

/// Independent rates from the leaves to the base: each before those of its company, unless they are of each other's, and of
/// the others that which moves least.
fn farthest_first(company: &[BTreeSet<usize>], weight: &[usize]) -> Vec<usize> {
    let nearer = |k: usize| {
        let others = company[k].iter().copied();
        others.filter(move |other| !company[*other].contains(&k))
    };
    let mut farther = vec![0_usize; weight.len()];
    for k in 0..weight.len() {
        nearer(k).for_each(|other| farther[other] += 1);
    }
    let mut open: Vec<usize> = (0..weight.len()).collect();
    open.sort_by_key(|k| (weight[*k], Reverse(*k)));
    let mut order = Vec::with_capacity(open.len());
    while !open.is_empty() {
        let leaf = open.iter().position(|k| farther[*k] == 0);
        let next = open.remove(leaf.unwrap_or(0));
        nearer(next).for_each(|other| farther[other] -= 1);
        order.push(next);
    }
    order
}

/// Which independent rates each unknown's rate depends on, as sets of bits.
struct Dependence {
    /// Set and depth of each unknown.
    sets: BTreeMap<usize, (Bits, usize)>,
    /// Level of each independent rate.
    rank: Vec<usize>,
}

impl Dependence {
    fn of(
        scalars: &Scalars,
        matched: &BTreeMap<usize, usize>,
        rate_of: &BTreeMap<usize, usize>,
        moved: &[usize],
        is_state: &dyn Fn(Owner) -> bool,
    ) -> Self {
        let unknowns: Vec<usize> = rate_of.keys().copied().collect();
        let place: BTreeMap<usize, usize> =
            unknowns.iter().enumerate().map(|(k, u)| (*u, k)).collect();
        let incidence: Vec<Vec<usize>> = unknowns
            .iter()
            .map(|unknown| {
                let terms = scalars.equations[matched[unknown]].terms.keys();
                terms.filter_map(|term| place.get(term).copied()).collect()
            })
            .collect();
        let own: Vec<usize> = (0..unknowns.len()).collect();
        let mut sets: Vec<(Bits, usize)> = vec![Default::default(); unknowns.len()];
        let mut independent = 0;
        for block in blocks::ordered(&incidence, &own) {
            let (mut set, mut depth) = (Bits::default(), 0);
            for member in &block {
                for other in incidence[*member].iter().filter(|k| !block.contains(k)) {
                    set.join(&sets[*other].0);
                    depth = depth.max(sets[*other].1 + 1);
                }
            }
            let equation = &scalars.equations[matched[&unknowns[block[0]]]];
            if is_state(equation.owner) {
                set.insert(independent);
                independent += 1;
            }
            for member in block {
                sets[member] = (set.clone(), depth);
            }
        }
        let mut weight = vec![0usize; independent];
        for (set, _) in &sets {
            set.iter().for_each(|k| weight[k] += 1);
        }
        let wholes = wholes(scalars, &place, &sets);
        let storages = moved.iter().filter_map(|unknown| place.get(unknown));
        let company = company(storages.map(|place| &wholes[*place]), independent);
        let order = farthest_first(&company, &weight);
        let mut rank = vec![0; independent];
        for (level, k) in order.into_iter().enumerate() {
            rank[k] = level;
        }
        Self {
            sets: unknowns.into_iter().zip(sets).collect(),
            rank,
        }
    }

    fn deepest(&self) -> usize {
        let sizes = self.sets.values().map(|(set, _)| set.len());
        sizes.max().unwrap_or(0)
    }

    fn turn(&self, unknown: usize) -> Option<Turn> {
        let (set, depth) = &self.sets[&unknown];
        let level = set.iter().map(|k| self.rank[k]).min()?;
        Some(Turn {
            level,
            depth: *depth,
        })
    }
}
