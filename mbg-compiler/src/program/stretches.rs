//! Sweeps of a Jacobian in stretches: steps that only some of the directions change.
//!
//! What moves with the last joints of an arm does not move with the first. Steps come in the order of the last direction in
//! which something changes them; operands stay before what reads them, since a step changes wherever its operands do.
//! Where none of the directions that are worked out together changes a stretch, all of it is zero. What changes in none at all
//! would not be: [`super::hoist`] has taken it away.

use std::collections::BTreeMap;

use super::{Direction, Operand, Routine, Source, Step, Sweep};
use crate::bits::Bits;
use crate::symbolic::Symbol;

/// Fewest steps that are left out together: each stretch costs a jump, and zeros for what is read behind it.
const FEWEST: usize = 24;

/// Consecutive steps, and the places of the directions in which any of them changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// How many steps.
    pub steps: usize,
    /// The directions.
    pub(crate) directions: Bits,
}

impl Stretch {
    /// Whether any of it changes in the direction in a place.
    #[must_use]
    pub fn changes_in(&self, place: usize) -> bool {
        self.directions.contains(place)
    }

    /// The directions as bits: that of a place is its rest by 64.
    #[must_use]
    pub fn mask(&self) -> u64 {
        let bits = self.directions.iter().map(|place| 1 << (place % 64));
        bits.fold(0, |mask, bit: u64| mask | bit)
    }
}

impl Sweep {
    /// The stretches of the steps.
    #[must_use]
    pub fn stretches(&self) -> Vec<Stretch> {
        let mut stretches: Vec<Stretch> = Vec::new();
        let mut last = None;
        for changes in self.changes() {
            let end = changes.last();
            match stretches.last_mut() {
                Some(stretch) if end == last || stretch.steps < FEWEST => {
                    stretch.steps += 1;
                    stretch.directions.join(&changes);
                }
                _ => stretches.push(Stretch {
                    steps: 1,
                    directions: changes,
                }),
            }
            last = end;
        }
        stretches
    }

    /// The places of the directions in which each step changes. What is solved for counts as changing in all of them.
    pub(super) fn changes(&self) -> Vec<Bits> {
        let changing = places(&self.coverage.directions);
        let everywhere: Bits = (0..self.coverage.directions.len()).collect();
        let mut values: Vec<Bits> = Vec::new();
        let mut solved = Vec::new();
        let changes = self.steps.iter().map(|step| {
            let mut changes = Bits::default();
            if let Step::Solve(solve) = step {
                solved.push(solve.number);
                changes.join(&everywhere);
            }
            for operand in &*step.operands() {
                match operand.source {
                    Source::Symbol(Symbol::Slope(variable)) => {
                        if let Some(place) = changing.get(&variable) {
                            changes.insert(*place);
                        }
                    }
                    Source::Value(value) if value >= self.first => {
                        changes.join(&values[value - self.first]);
                    }
                    Source::Solved(place) if solved.contains(&place.number) => {
                        changes.join(&everywhere);
                    }
                    _ => {}
                }
            }
            values.extend(std::iter::repeat_n(changes.clone(), step.results()));
            changes
        });
        changes.collect()
    }
}

/// The place of the direction in which each variable changes, or each rate has a weight.
fn places(directions: &[Direction]) -> BTreeMap<usize, usize> {
    let directions = directions.iter().enumerate();
    let lines = directions
        .flat_map(|(place, direction)| direction.iter().map(move |it| (it.number, place)));
    lines.collect()
}

/// The routine with the steps of its sweeps in order of their stretches.
pub(super) fn by_stretches(routine: &Routine) -> Routine {
    let mut numbers: Vec<usize> = (0..routine.names.len()).collect();
    let orders: Vec<Vec<usize>> = routine.sweeps.iter().map(order).collect();
    for (sweep, order) in routine.sweeps.iter().zip(&orders) {
        let starts = super::starts(&sweep.steps);
        let mut new = sweep.first;
        for step in order {
            for old in starts[*step]..starts[step + 1] {
                numbers[sweep.first + old] = new;
                new += 1;
            }
        }
    }
    let renumbered = |operand: Operand| operand.renumbered(&numbers);
    let with_numbers = |step: &Step| step.with(&renumbered);
    let mut names = routine.names.clone();
    for (name, number) in routine.names.iter().zip(&numbers) {
        names[*number].clone_from(name);
    }
    let sweeps = routine.sweeps.iter().zip(orders).map(|(sweep, order)| {
        let steps = order.iter().map(|step| with_numbers(&sweep.steps[*step]));
        Sweep {
            coverage: sweep.coverage.clone(),
            first: sweep.first,
            steps: steps.collect(),
            results: sweep.results.iter().copied().map(renumbered).collect(),
        }
    });
    Routine {
        sweeps: sweeps.collect(),
        names,
        ..routine.clone()
    }
}

/// The steps by the last direction in which they change.
fn order(sweep: &Sweep) -> Vec<usize> {
    let changes = sweep.changes();
    let mut order: Vec<usize> = (0..changes.len()).collect();
    order.sort_by_key(|step| changes[*step].last());
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::fixtures::{coverage, slope, state, value};

    /// A sweep of steps that begin with value 0, in directions of one variable each.
    fn sweep(steps: Vec<Step>, directions: usize, results: Vec<Operand>) -> Sweep {
        Sweep {
            coverage: coverage(directions),
            first: 0,
            steps,
            results,
        }
    }

    fn places(stretch: &Stretch) -> Vec<usize> {
        stretch.directions.iter().collect()
    }

    #[test]
    fn steps_come_by_the_last_direction_that_changes_them() {
        let steps = vec![
            Step::Multiply(slope(1), state(0)),
            Step::Multiply(slope(0), state(0)),
            Step::Add(value(0), value(1)),
            Step::Multiply(value(1), state(1)),
        ];
        let routine = Routine {
            names: ["b", "a", "sum", "turned"].map(str::to_owned).to_vec(),
            sweeps: vec![sweep(steps, 2, vec![value(2), value(3)])],
            ..Routine::default()
        };
        let found = by_stretches(&routine);
        assert_eq!(found.names, ["a", "turned", "b", "sum"]);
        assert_eq!(found.sweeps[0].steps[3], Step::Add(value(2), value(0)));
        assert_eq!(found.sweeps[0].results, [value(3), value(1)]);
    }

    #[test]
    fn a_stretch_is_as_long_as_the_directions_that_change_its_steps_are_the_same() {
        let mut steps: Vec<Step> = (0..FEWEST)
            .map(|_| Step::Multiply(slope(0), state(0)))
            .collect();
        steps.extend((0..FEWEST).map(|it| Step::Multiply(slope(1), value(it))));
        steps.push(Step::Multiply(slope(2), state(0)));
        steps.push(Step::Multiply(slope(3), state(0)));
        let stretches = sweep(steps, 4, Vec::new()).stretches();
        let lengths: Vec<usize> = stretches.iter().map(|it| it.steps).collect();
        assert_eq!(lengths, [FEWEST, FEWEST, 2]);
        let directions: Vec<_> = stretches.iter().map(places).collect();
        assert_eq!(directions, [vec![0], vec![0, 1], vec![2, 3]]);
        assert_eq!(stretches[2].mask(), 0b1100);
        assert!(stretches[1].changes_in(0) && !stretches[1].changes_in(2));
    }

    #[test]
    fn places_beyond_the_bits_of_a_mask_share_them() {
        let steps = vec![Step::Multiply(slope(65), state(0))];
        let stretches = sweep(steps, 70, Vec::new()).stretches();
        assert_eq!(stretches[0].mask(), 0b10);
    }
}
