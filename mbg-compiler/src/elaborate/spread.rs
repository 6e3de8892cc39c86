//! How what is known of one frame spreads over those that components lead to.

use std::collections::{BTreeMap, BTreeSet};

use crate::graph::JunctionId;

/// A junction, or some of its components: the first of them, and how many.
pub(super) type Place = (JunctionId, usize, usize);

/// A component that tells a quantity at one of its ports.
pub(super) struct Teller {
    /// Scope of the component.
    pub(super) scope: usize,
    /// What it tells.
    pub(super) definition: usize,
    pub(super) at: Place,
    /// Where it asks for the quantity.
    pub(super) asks: Vec<Place>,
    /// Whether it has no other port.
    pub(super) is_alone: bool,
    /// Whether all that it asks for is given.
    pub(super) is_given: bool,
}

/// How a quantity is known at a place.
#[derive(Clone, Copy)]
struct Known {
    /// Number of the teller; none where the world's holds.
    by: Option<usize>,
    /// Whether the way to it begins at a place that a source holds.
    is_held: bool,
}

/// A quantity at all places.
pub(super) struct Spread {
    pub(super) tellers: Vec<Teller>,
    known: BTreeMap<Place, Known>,
}

impl Spread {
    /// Follows tellers that stand alone; then from the places that sources hold, by the shortest way, so that no loop is
    /// defined by itself; then those that are given what they ask for; then from where nobody leads to.
    pub(super) fn new(tellers: Vec<Teller>, held: &BTreeSet<Place>) -> Self {
        let told: BTreeSet<Place> = tellers.iter().map(|teller| teller.at).collect();
        let asked = tellers.iter().flat_map(|teller| teller.asks.clone());
        let (loops, ends): (Vec<Place>, Vec<Place>) = asked.partition(|place| told.contains(place));
        let free = ends.into_iter().chain(loops).map(|place| (place, None));
        let number = |sound: fn(&Teller) -> bool| -> Vec<(Place, Option<usize>)> {
            let numbered = tellers.iter().enumerate();
            let sound = numbered.filter(|(_, teller)| sound(teller));
            sound
                .map(|(number, teller)| (teller.at, Some(number)))
                .collect()
        };
        let (alone, given) = (number(|it| it.is_alone), number(|it| it.is_given));
        let held = held.iter().map(|place| (*place, None));
        let mut spread = Self {
            tellers,
            known: BTreeMap::new(),
        };
        spread.follow(alone.into_iter().chain(held).collect(), true);
        for start in given.into_iter().chain(free) {
            spread.follow(vec![start], false);
        }
        spread
    }

    /// Adds places with their tellers, and all that follows from them.
    fn follow(&mut self, mut reached: Vec<(Place, Option<usize>)>, is_held: bool) {
        while !reached.is_empty() {
            for (place, by) in std::mem::take(&mut reached) {
                if self.known.contains_key(&place) {
                    continue;
                }
                self.known.insert(place, Known { by, is_held });
                let next = self.tellers.iter().enumerate();
                let next = next.filter(|(_, teller)| teller.asks.contains(&place));
                reached.extend(next.map(|(number, teller)| (teller.at, Some(number))));
            }
        }
    }

    /// The definition that tells it at a place.
    pub(super) fn told(&self, place: Place) -> Option<usize> {
        let by = self.known.get(&place)?.by?;
        Some(self.tellers[by].definition)
    }

    /// Places to which two ways lead from places that sources hold, with the tellers at both ends: scope and definition.
    pub(super) fn meetings(&self) -> impl Iterator<Item = (Place, [(usize, usize); 2])> {
        let leads = |teller: &&Teller| {
            let mut asks = teller.asks.iter();
            !teller.asks.is_empty() && asks.all(|place| self.is_held(*place))
        };
        let ends = |teller: &Teller| (teller.scope, teller.definition);
        self.tellers.iter().filter(leads).filter_map(move |teller| {
            let first = &self.tellers[self.known.get(&teller.at)?.by?];
            let is_other = first.definition != teller.definition;
            (is_other && leads(&first)).then(|| (teller.at, [ends(first), ends(teller)]))
        })
    }

    /// Whether the way to it begins at a place that a source holds.
    pub(super) fn is_held(&self, place: Place) -> bool {
        self.known.get(&place).is_some_and(|known| known.is_held)
    }

    /// Scope of a component that leads from a place to one that is known without it.
    pub(super) fn backwards(&self, place: Place) -> Option<usize> {
        let mut leading = self.tellers.iter().filter(|it| it.asks.contains(&place));
        let back = leading.find(|it| !it.is_given && self.is_held(it.at))?;
        Some(back.scope)
    }
}
