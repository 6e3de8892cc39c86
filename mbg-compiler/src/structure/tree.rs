//! The rates of a reduced system, as the tree in which each follows from others.
//!
//! A joint is released, that is its rate eliminated, before the frame that it carries is turned into that of its
//! parent: the row and the column of its axis are zero by then, and are not turned.

use std::collections::{BTreeMap, BTreeSet};

use super::eliminate::System;
use super::shift::Given;
use crate::equations::{Owner, Scalars, Turn};
use crate::symbolic::{Pool, Rate};

pub(super) type Columns = BTreeSet<usize>;

/// The rates of a block.
pub(super) struct Tree {
    /// What belongs to the column of every rate that is given by a row.
    pub(super) conjugates: BTreeMap<usize, Conjugate>,
    /// The rate that each of these rows gives.
    given: BTreeMap<usize, usize>,
    /// The rate with which each effort comes.
    coming: BTreeMap<usize, usize>,
    /// Rates of velocities.
    rates: Columns,
    /// Rates that no row gives.
    independent: Columns,
    turns: BTreeMap<usize, Turn>,
    /// Rates that rows give, by their turn.
    together: BTreeMap<Option<Turn>, Vec<usize>>,
    /// Rows that balance efforts at a junction, and the effort that each gives, if it is not known.
    balances: BTreeMap<usize, Option<usize>>,
    /// Efforts that these rows give.
    balanced: Columns,
    /// Rows in which junctions and two-ports pass efforts on.
    structure: BTreeSet<usize>,
    /// Efforts that close loops.
    multipliers: Columns,
}

/// What belongs to the column of a rate.
pub(super) struct Conjugate {
    /// The row that gives the rate.
    pub(super) row: usize,
    /// The column of the effort that comes with it.
    pub(super) effort: Option<usize>,
}

impl Tree {
    /// Of a block's equations; `place` gives the column of each unknown.
    pub(super) fn of(
        scalars: &Scalars,
        equations: &[usize],
        place: &BTreeMap<usize, usize>,
    ) -> Self {
        let unknown_of: BTreeMap<usize, usize> = scalars
            .rate_of
            .iter()
            .map(|(unknown, rate)| (*rate, *unknown))
            .collect();
        let mut conjugates = BTreeMap::new();
        let mut efforts = BTreeMap::new();
        for (row, equation) in equations.iter().enumerate() {
            let equation = &scalars.equations[*equation];
            let Some(rate) = equation.rate.filter(|rate| place.contains_key(rate)) else {
                continue;
            };
            let unknown = unknown_of[&rate];
            let effort = equation.about.into_iter().find(|about| *about != unknown);
            let column = effort.and_then(|effort| place.get(&effort).copied());
            conjugates.insert(
                place[&rate],
                Conjugate {
                    row,
                    effort: column,
                },
            );
            efforts.extend(effort.map(|effort| (unknown, effort)));
        }
        let mut balances = BTreeMap::new();
        for (row, equation) in equations.iter().enumerate() {
            let equation = &scalars.equations[*equation];
            let [about, same] = equation.about;
            if let Some(effort) = efforts.get(&about)
                && about == same
                && equation.terms.contains_key(effort)
            {
                balances.insert(row, place.get(effort).copied());
            }
        }
        let structure = equations.iter().enumerate();
        let structure = structure.filter_map(|(row, equation)| {
            let equation = &scalars.equations[*equation];
            (equation.owner == Owner::Structure && equation.rate.is_none()).then_some(row)
        });
        let structure: BTreeSet<usize> = structure.collect();
        let closures = scalars.closures.iter();
        let multipliers = closures
            .flat_map(|closure| &closure.multipliers)
            .filter_map(|multiplier| place.get(multiplier).copied())
            .collect();
        let independent = scalars.independent.values();
        let turns = place.iter();
        let turns = turns.filter_map(|(unknown, column)| Some((*column, scalars.turns[*unknown]?)));
        let turns: BTreeMap<usize, Turn> = turns.collect();
        let mut together: BTreeMap<Option<Turn>, Vec<usize>> = BTreeMap::new();
        for rate in conjugates.keys() {
            let turn = turns.get(rate).copied();
            together.entry(turn).or_default().push(*rate);
        }
        Self {
            given: conjugates
                .iter()
                .map(|(rate, of)| (of.row, *rate))
                .collect(),
            coming: conjugates
                .iter()
                .filter_map(|(rate, of)| Some((of.effort?, *rate)))
                .collect(),
            independent: independent
                .filter_map(|rate| place.get(&rate.unknown).copied())
                .collect(),
            rates: unknown_of
                .keys()
                .filter_map(|rate| place.get(rate).copied())
                .collect(),
            balanced: balances.values().flatten().copied().collect(),
            turns,
            together,
            conjugates,
            balances,
            structure,
            multipliers,
        }
    }

    /// Whether a column is the rate of a velocity.
    pub(super) fn is_rate(&self, column: usize) -> bool {
        self.rates.contains(&column)
    }

    /// Whether a row gives this rate.
    pub(super) fn is_given(&self, rate: usize) -> bool {
        self.conjugates.contains_key(&rate)
    }

    /// The rate that a row gives.
    pub(super) fn given_by(&self, row: usize) -> Option<usize> {
        self.given.get(&row).copied()
    }

    /// Whether a junction or a two-port passes efforts on in a row.
    pub(super) fn passes_on(&self, row: usize) -> bool {
        self.structure.contains(&row)
    }

    /// Whether a column is an effort that rows give: neither a rate nor what closes a loop.
    pub(super) fn is_effort(&self, column: usize) -> bool {
        let is_rate = self.is_given(column) || self.independent.contains(&column);
        !is_rate && !self.multipliers.contains(&column)
    }

    /// The rows that give rates, each after those of the rates from which its own follows. None if there is no such
    /// order, or a rate has another coefficient than one.
    pub(super) fn base_to_leaves(&self, system: &System) -> Option<Vec<Given>> {
        let mut rows = Vec::with_capacity(self.conjugates.len());
        let mut open: BTreeMap<usize, Given> = BTreeMap::new();
        for (rate, conjugate) in &self.conjugates {
            open.insert(*rate, Given::of(system, conjugate.row, *rate)?);
        }
        while !open.is_empty() {
            let is_ready = |given: &Given| {
                given
                    .terms
                    .iter()
                    .all(|(other, _)| !open.contains_key(other))
            };
            let ready: Vec<usize> = open
                .iter()
                .filter(|(_, given)| is_ready(given))
                .map(|(rate, _)| *rate)
                .collect();
            if ready.is_empty() {
                return None;
            }
            rows.extend(ready.iter().filter_map(|rate| open.remove(rate)));
        }
        Some(rows)
    }

    /// Whether a column may be eliminated by a row at all: a rate is eliminated by the equation that gives it.
    pub(super) fn allows(&self, row: usize, column: usize) -> bool {
        match self.given.get(&row) {
            Some(rate) => *rate == column,
            None => !self.conjugates.contains_key(&column),
        }
    }

    /// Whether a column is eliminated by a row, so that rates run down the tree and efforts up: the balance at a
    /// junction gives the effort that comes from the base, and nothing else.
    pub(super) fn admits(&self, row: usize, column: usize) -> bool {
        let is_balance = match self.balances.get(&row) {
            Some(effort) => *effort == Some(column),
            None => !self.balanced.contains(&column),
        };
        is_balance && self.allows(row, column)
    }

    /// The rate itself, or that with which an effort comes.
    pub(super) fn rate_of(&self, column: usize) -> Option<usize> {
        if self.conjugates.contains_key(&column) {
            return Some(column);
        }
        self.coming.get(&column).copied()
    }

    /// Efforts that meet at a junction first, then the rates of the junction, then the effort that comes with them: so
    /// the inertia of all that hangs on the junction is turned as a whole.
    pub(super) fn in_order(&self, columns: Columns) -> [Columns; 3] {
        let is_rate = |column: &usize| self.conjugates.contains_key(column);
        let (turned, efforts): (Columns, Columns) = columns.into_iter().partition(is_rate);
        let is_coming = |column: &usize| self.coming.contains_key(column);
        let (last, first) = efforts.into_iter().partition(is_coming);
        [first, turned, last]
    }

    /// Rates that open rows give by a column.
    fn followers<'a>(
        &'a self,
        system: &'a System,
        column: usize,
    ) -> impl Iterator<Item = usize> + 'a {
        let rates = system
            .rows_with(column)
            .filter_map(|row| self.given.get(&row));
        rates.copied().filter(move |rate| *rate != column)
    }

    /// Whether nothing is left that follows from a rate.
    fn is_leaf(&self, system: &System, rate: usize) -> bool {
        self.followers(system, rate).next().is_none()
    }

    /// All open rates that follow from a rate.
    pub(super) fn moved(&self, system: &System, rate: usize) -> Columns {
        let mut found = Columns::new();
        let mut pending = vec![rate];
        while let Some(current) = pending.pop() {
            let new = self
                .followers(system, current)
                .filter(|rate| found.insert(*rate));
            pending.extend(new.collect::<Vec<_>>());
        }
        found
    }

    /// Whether a rate is that of a frame that turns: its coefficients vary.
    pub(super) fn is_turned(&self, pool: &Pool, system: &System, rate: usize) -> bool {
        let mut entries = system.row(self.conjugates[&rate].row);
        entries.any(|(_, value)| pool.rate(value) == Rate::Varying)
    }

    /// The one row, among those given, that balances the efforts on an independent rate and holds no effort any more,
    /// when nothing is left that follows from the rate.
    pub(super) fn balance(
        &self,
        system: &System,
        rows: &BTreeSet<usize>,
        rate: usize,
    ) -> Option<usize> {
        // A multiplier belongs to no level.
        let is_rate = |column: usize| {
            self.conjugates.contains_key(&column)
                || self.independent.contains(&column)
                || !self.turns.contains_key(&column)
        };
        let mut balances = system
            .rows_with(rate)
            .filter(|row| rows.contains(row))
            .filter(|row| system.row(*row).all(|(column, _)| is_rate(column)));
        let row = balances.next()?;
        let is_only = balances.next().is_none() && self.is_leaf(system, rate);
        is_only.then_some(row)
    }

    /// Whether a row holds the independent rate of a level before this one.
    pub(super) fn holds_level_before(&self, system: &System, row: usize, level: usize) -> bool {
        let is_before = |column: usize| {
            let turn = self.turns.get(&column);
            self.independent.contains(&column) && turn.is_some_and(|turn| turn.level < level)
        };
        system.row(row).any(|(column, _)| is_before(column))
    }

    /// Efforts that keep a row of a closed loop from being the balance on an independent rate. They are across its axis, and are
    /// there since what turns the frame is written as numbers, in which their coefficients do not cancel.
    pub(super) fn hindering(
        &self,
        system: &System,
        rows: &BTreeSet<usize>,
        rate: usize,
    ) -> Columns {
        if self.multipliers.is_empty() || self.balance(system, rows, rate).is_some() {
            return Columns::new();
        }
        let rows = system.rows_with(rate).filter(|row| rows.contains(row));
        let columns = rows.flat_map(|row| system.row(row));
        let columns = columns.map(|(column, _)| column);
        columns.filter(|column| self.is_effort(*column)).collect()
    }

    /// Turned rates in a row, and those that are turned together with them, from which nothing follows any more; and
    /// the efforts that come with them.
    pub(super) fn frame(&self, pool: &Pool, system: &System, row: usize) -> Columns {
        let together = |rate: usize| {
            let turn = self.turns.get(&rate).copied();
            let open = |other: &usize| system.rows_with(*other).next().is_some();
            let group = self.together.get(&turn).into_iter().flatten().copied();
            group.filter(open)
        };
        let mut frame = Columns::new();
        for (rate, _) in system.row(row) {
            let turns = self.conjugates.contains_key(&rate) && self.is_turned(pool, system, rate);
            if !turns || !together(rate).all(|other| self.is_leaf(system, other)) {
                continue;
            }
            let causes = self.causes(system, rate);
            frame.extend(together(rate).filter(|other| self.causes(system, *other) == causes));
        }
        self.with_efforts(frame)
    }

    /// Rates in the balance on an independent rate that are fixed to others, that is, follow from them by what does not vary,
    /// and from which nothing follows any more; and the efforts that come with them. They go before the independent rate,
    /// which fills in an entry for every two rates in its balance. None if the others, which take their place, are more than
    /// half as many.
    pub(super) fn fixed(
        &self,
        pool: &Pool,
        system: &System,
        rows: &BTreeSet<usize>,
        rate: usize,
    ) -> Option<Columns> {
        let row = self.balance(system, rows, rate)?;
        let is_fixed = |rate: &usize| {
            self.is_given(*rate)
                && !self.is_turned(pool, system, *rate)
                && self.is_leaf(system, *rate)
        };
        let columns = system.row(row).map(|(column, _)| column);
        let fixed: Columns = columns.filter(is_fixed).collect();
        let causes = fixed.iter().flat_map(|rate| self.causes(system, *rate));
        let causes: Columns = causes.collect();
        let is_worth = !fixed.is_empty() && 2 * causes.len() <= fixed.len();
        is_worth.then(|| self.with_efforts(fixed))
    }

    /// Rates, and the efforts that come with them.
    fn with_efforts(&self, mut rates: Columns) -> Columns {
        let efforts = rates.iter().filter_map(|rate| self.conjugates[rate].effort);
        let efforts: Vec<usize> = efforts.collect();
        rates.extend(efforts);
        rates
    }

    /// The rates from which a rate follows.
    fn causes(&self, system: &System, rate: usize) -> Vec<usize> {
        let row = system.row(self.conjugates[&rate].row);
        row.map(|(column, _)| column)
            .filter(|column| *column != rate)
            .collect()
    }
}
