//! Rows of equations in echelon form: over the prime field, where what vanishes vanishes for almost every state, and in
//! numbers at the nominal state.

use std::collections::{BTreeMap, BTreeSet};

use crate::entries::merged;
use crate::equations::Owner;
use crate::symbolic::field;

/// Coefficients by unknown, which ascend.
pub(super) type Row<T> = Vec<(usize, T)>;

/// Rows in echelon form over the field, without zeros, each with the rows it came from.
#[derive(Clone, Default)]
pub(super) struct Echelon {
    /// By the unknown that leads, with coefficient one.
    rows: Vec<Option<(Row<u64>, Origin)>>,
    /// How many there are.
    size: usize,
}

/// Leads of rows, and how many times each.
type Multiples = Vec<(usize, u64)>;

/// What a row was made of: a multiple of an equation less multiples of rows before it.
#[derive(Clone)]
struct Origin {
    /// What the equation belongs to, if that is a cause.
    owner: Option<Owner>,
    /// The rows that were taken from it.
    taken: Multiples,
    /// By what all of that was multiplied.
    scale: u64,
    /// How many rows are before it.
    before: usize,
}

impl Echelon {
    /// Adds a row; if it vanishes, gives the rows it is a combination of.
    pub(super) fn reduce(
        &mut self,
        row: Row<u64>,
        owner: Option<Owner>,
    ) -> Option<BTreeSet<Owner>> {
        let (mut rest, taken) = self.rest(row);
        let Some(&(lead, value)) = rest.first() else {
            return Some(self.causes(owner, &taken));
        };
        let scale = field::invert(value).unwrap_or(0);
        for (_, entry) in &mut rest {
            *entry = field::multiply(*entry, scale);
        }
        let origin = Origin {
            owner,
            taken,
            scale,
            before: self.size,
        };
        self.size += 1;
        let known = self.rows.len().max(lead + 1);
        self.rows.resize(known, None);
        self.rows[lead] = Some((rest, origin));
        None
    }

    /// Whether a row vanishes.
    pub(super) fn vanishes(&self, row: Row<u64>) -> bool {
        self.rest(row).0.is_empty()
    }

    /// The owners of the equations that a row is a combination of, without those that cancel out.
    fn causes(&self, owner: Option<Owner>, taken: &Multiples) -> BTreeSet<Owner> {
        let mut causes = BTreeSet::from_iter(owner);
        // How many times each row counts, the last one first: none behind it takes it any more.
        let mut pending: BTreeMap<usize, (&Origin, u64)> = BTreeMap::new();
        self.count(&mut pending, taken, 1);
        while let Some((_, (origin, times))) = pending.pop_last() {
            if times != 0 {
                causes.extend(origin.owner);
                let times = field::multiply(times, origin.scale);
                self.count(&mut pending, &origin.taken, field::negate(times));
            }
        }
        causes
    }

    /// Counts rows so many times more.
    fn count<'a>(
        &'a self,
        pending: &mut BTreeMap<usize, (&'a Origin, u64)>,
        taken: &Multiples,
        times: u64,
    ) {
        for (lead, factor) in taken {
            if let Some(Some((_, origin))) = self.rows.get(*lead) {
                let (_, count) = pending.entry(origin.before).or_insert((origin, 0));
                let less = field::multiply(field::negate(times), *factor);
                *count = field::subtract(*count, less);
            }
        }
    }

    /// What remains of a row up to the first unknown that no earlier row leads with, and the leads of those that were taken
    /// from it.
    fn rest(&self, mut row: Row<u64>) -> (Row<u64>, Multiples) {
        let mut taken = Vec::new();
        while let Some(&(lead, value)) = row.first() {
            let Some(Some((pivot, _))) = self.rows.get(lead) else {
                break;
            };
            row = merged(&row, pivot, |own, entry| {
                let rest = field::subtract(own.unwrap_or(0), field::multiply(value, entry));
                (rest != 0).then_some(rest)
            });
            taken.push((lead, value));
        }
        (row, taken)
    }
}

/// Rows at the nominal state, each reduced by those before it, with its largest entry as the lead.
#[derive(Clone, Default)]
pub(super) struct NominalEchelon {
    /// The lead, its coefficient, and the others.
    rows: Vec<(usize, f64, Row<f64>)>,
    /// The row that each unknown leads.
    leads: Vec<Option<usize>>,
}

impl NominalEchelon {
    /// A row is taken to vanish when it has become this much smaller.
    const VANISHED: f64 = 1e-9;

    /// The row reduced by all others; none if it vanishes. A coefficient without a value counts as one.
    pub(super) fn reduced(&self, mut row: Row<f64>) -> Option<Row<f64>> {
        let mut size = 0.0_f64;
        for (_, value) in &mut row {
            if !value.is_finite() {
                *value = 1.0;
            }
            size = size.max(value.abs());
        }
        let position = |(unknown, _): &(usize, f64)| self.leads.get(*unknown).copied().flatten();
        let mut pending: BTreeSet<usize> = row.iter().filter_map(position).collect();
        while let Some(next) = pending.pop_first() {
            let (lead, pivot, others) = &self.rows[next];
            let Ok(place) = row.binary_search_by_key(lead, |(unknown, _)| *unknown) else {
                continue;
            };
            let factor = row.remove(place).1 / pivot;
            if factor == 0.0 {
                continue;
            }
            row = merged(&row, others, |own, entry| {
                Some(own.unwrap_or(0.0) - factor * entry)
            });
            let later = others.iter().filter_map(position);
            pending.extend(later.filter(|position| *position > next));
        }
        row.retain(|(_, value)| value.abs() > Self::VANISHED * size);
        (!row.is_empty()).then_some(row)
    }

    pub(super) fn insert(&mut self, mut row: Row<f64>) {
        let size = |place: usize| row[place].1.abs();
        let larger = |best, place| {
            if size(place) > size(best) {
                place
            } else {
                best
            }
        };
        let largest = (1..row.len()).fold(0, larger);
        let (lead, pivot) = row.remove(largest);
        let known = self.leads.len().max(lead + 1);
        self.leads.resize(known, None);
        self.leads[lead] = Some(self.rows.len());
        self.rows.push((lead, pivot, row));
    }
}

#[cfg(test)]
mod tests {
    use super::{BTreeSet, Echelon, Owner};
    use crate::graph::ElementId;

    fn owner(number: usize) -> Owner {
        Owner::Element(ElementId(number), 0)
    }

    /// x + y, x + 2 y, and the second one again: what was taken from that on the way is no cause.
    #[test]
    fn what_cancels_out_is_no_cause() {
        let mut echelon = Echelon::default();
        let rows = [vec![(0, 1), (1, 1)], vec![(0, 1), (1, 2)]];
        for (number, row) in rows.iter().enumerate() {
            assert_eq!(echelon.reduce(row.clone(), Some(owner(number))), None);
        }
        let [_, second] = rows;
        let causes = echelon.reduce(second, Some(owner(2)));
        assert_eq!(causes, Some(BTreeSet::from([owner(1), owner(2)])));
        let x = echelon.reduce(vec![(0, 1)], Some(owner(3)));
        assert_eq!(x, Some(BTreeSet::from([owner(0), owner(1), owner(3)])));
    }
}
